"""How compare_speed.py runs CalculiX and signorini on a deck, and what it reads of their results."""

import json
import math
import os
import pathlib
import re
import shutil
from dataclasses import dataclass, field, fields, replace

from accuracy import Deck, difference, imbalance, printed_sets
from jobs import Cost, iterations_of_ccx, iterations_of_ours, keywords, measured, version

# as *STATIC names them
SOLVERS = ["SPOOLES", "ITERATIVECHOLESKY", "ITERATIVESCALING", "PARDISO", "PASTIX"]
# what ccx says of a solver that it has not
NOT_LINKED = "library is not linked"
# ccx's residual that ends its iterations, by default, relative to the mean force
TOLERANCE_OF_CCX = 5e-3
# a solver of ccx is stopped after this many times the seconds, by the clock or of processors, of the best one so far
GIVEN_UP = 1.25
# names of builds of CalculiX: ccx, ccx_2.22, ccx_MT, ccx_2.21_MT, ccx_pastix, ccx2.22
BUILD = re.compile(r"ccx(_\w[\w.]*|-?\d+\.\d+\w*)?(\.exe)?")
# the largest sum of all forces on a model, relative to the largest of them: .dat files have seven digits
IN_BALANCE = 1e-4


@dataclass(frozen=True)
class Program:
    """A build of CalculiX."""

    path: str
    version: str


def builds(commands):
    """The builds of CalculiX that these commands start, or, without commands, those on the search path."""
    if not commands:
        folders = [folder for folder in os.get_exec_path() if os.path.isdir(folder)]
        commands = [os.path.join(folder, name) for folder in folders for name in sorted(os.listdir(folder))]
        commands = [command for command in commands if BUILD.fullmatch(os.path.basename(command))]
    found = {}
    for command in commands:
        path = shutil.which(command)
        if path is not None:
            found.setdefault(os.path.realpath(path), os.path.abspath(path))
    return [Program(path, version(path)) for path in found.values()]


@dataclass
class Solution:
    """What one program made of a deck; `failure` says why it made nothing of it."""

    failure: str = ""
    solver: str = ""
    # of ccx
    version: str = ""
    cost: Cost | None = None
    increments: int | None = None
    iterations: int | None = None
    tolerance: float | None = None
    # relative to what they are errors of, by name
    errors: dict[str, float] = field(default_factory=dict)
    # total reactions, by name of the set
    forces: dict[str, list[float]] = field(default_factory=dict)
    # seconds, by name
    phases: dict[str, float] = field(default_factory=dict)


@dataclass
class Outcome:
    """What became of a row; `ccx` is none where it has no part in it."""

    row: object
    dof: int
    ours: Solution
    ccx: Solution | None
    # what other solvers of ccx did
    others: list[str] = field(default_factory=list)
    # of the forces of both programs, and of the sum of signorini's forces, relative to the largest force
    difference: float | None = None
    imbalance: float | None = None

    def ratio(self, of):
        """Of a cost: ccx to signorini; none where one of both has none."""
        costs = [solution.cost if solution else None for solution in (self.ccx, self.ours)]
        return None if None in costs else of(costs[0]) / of(costs[1])

    @property
    def faults(self):
        """Why this row is not solved right, a sentence each."""
        found = []
        if self.ours.failure:
            found.append(f"NOT SOLVED by signorini: {self.ours.failure}")
        if self.ccx is not None and self.ccx.failure:
            found.append(f"NOT SOLVED by CalculiX: {self.ccx.failure}")
        limit = self.row.tolerance
        # also where a number is not finite
        if self.difference is not None and not self.difference <= limit:
            found.append(f"FORCES DIFFER by {self.difference:.2%} of the largest one, the tolerance is {limit:.1%}")
        if self.imbalance is not None and not self.imbalance <= IN_BALANCE:
            found.append(f"FORCES OF SIGNORINI NOT IN BALANCE: their sum is {self.imbalance:.1e} of the largest one")
        return found


def with_solver(text, solver):
    """The deck, to be solved by one of ccx's solvers."""
    lines = []
    for line in text.splitlines():
        if line.startswith("*") and keywords(line)[:1] == ["STATIC"]:
            line = re.sub(r",\s*SOLVER\s*=[^,]*", "", line, flags=re.IGNORECASE) + f",SOLVER={solver}"
        lines.append(line)
    return "\n".join(lines) + "\n"


def increments_of_ccx(folder, deck):
    """The increments that a .sta file lists."""
    lines = pathlib.Path(folder, f"{deck}.sta").read_text(encoding="ascii", errors="replace").splitlines()
    return sum(len(line.split()) == 7 for line in lines[2:])


def force_tol(results):
    """That of the resolved case."""
    text = pathlib.Path(results, "case.resolved.toml").read_text(encoding="utf-8")
    found = re.search(r"\bforce_tol\s*=\s*([-+.\deE]+)", text)
    return float(found.group(1)) if found else None


class Comparison:
    """Both programs, and how they run."""

    def __init__(self, args, programs):
        self.args, self.programs = args, programs
        # solvers that a build does not have
        self.missing = {program: [] for program in programs}

    def compare(self, row, folder):
        """Makes the deck of a row in a folder, and solves it."""
        path = pathlib.Path(folder, "deck.inp")
        row.write(self.args, path)
        text = path.read_text(encoding="ascii")
        deck = Deck(text)
        outcome = Outcome(row, deck.dof, self.run_ours(row, deck, folder), None)
        if self.programs and row.with_ccx:
            self.run_ccx(outcome, deck, text, folder)
        if printed_sets(deck) and outcome.ours.forces:
            outcome.imbalance = imbalance(outcome.ours.forces, deck.applied)
            if outcome.ccx and outcome.ccx.forces:
                outcome.difference = difference(outcome.ours.forces, outcome.ccx.forces)
        return outcome

    def lacking(self):
        """Which solvers were not there, a sentence for each build."""
        return [
            f"CalculiX {program.version} has no {', '.join(solvers)}."
            for program, solvers in self.missing.items()
            if solvers
        ]

    def measure(self, command, folder, limit=math.inf):
        return measured(command, folder, min(limit, self.args.timeout), self.args.threads)

    def run_ours(self, row, deck, folder):
        """Solves by signorini; the least costs of all runs count."""
        changes = [word for change in [*row.changes, *self.args.set] for word in ("--set", change)]
        results = os.path.join(folder, "ours")
        command = [self.args.signorini, "run", "deck.inp", "--output", "ours", "--format", "frd", "--quiet"]
        command += ["--threads", str(self.args.threads), "--compat", self.args.compat, *changes]
        costs = []
        for _ in range(self.args.repeat):
            shutil.rmtree(results, ignore_errors=True)
            code, said, cost = self.measure(command, folder)
            if code != 0:
                return Solution(failure=why(code, said, cost))
            costs.append(cost)
        return read(row, deck, os.path.join(results, "deck"), of_ours(results, least(costs)))

    def run_ccx(self, outcome, deck, text, folder):
        """Solves by all solvers of all builds of ccx; the best one counts, and ends those that are much slower."""
        best = None
        for program in self.programs:
            for solver in self.args.ccx_solvers:
                if solver in self.missing[program]:
                    continue
                for solved in self.solve(program, solver, best, outcome, deck, text, folder):
                    best = better(best, solved)
        outcome.ccx = best or Solution(failure="; ".join(outcome.others) or "none of its solvers is there")

    def solve(self, program, solver, best, outcome, deck, text, folder):
        """The solutions of one solver of one build, one for each repetition."""
        job = solver.lower()
        pathlib.Path(folder, f"{job}.inp").write_text(with_solver(text, solver), encoding="ascii")
        name = solver if len(self.programs) == 1 else f"{solver} of {program.version}"
        found = []
        for _ in range(self.args.repeat):
            limit = GIVEN_UP * max(best.cost.wall, best.cost.processors) if best else math.inf
            code, said, cost = self.measure([program.path, "-i", job], folder, limit)
            if NOT_LINKED in said:
                self.missing[program].append(solver)
                break
            solution = Solution(failure=why(code, said, cost))
            if code == 0:
                solution = of_ccx(folder, job, solver, cost)
                solution = read(outcome.row, deck, os.path.join(folder, job), replace(solution, version=program.version))
            if solution.failure:
                outcome.others += [] if found else [f"{name} {solution.failure}"]
                break
            found.append(solution)
        for left in pathlib.Path(folder).glob(f"{job}.*"):
            left.unlink()
        return found


def better(best, solved):
    """The solution with fewer seconds of processors, with the least costs of both."""
    if best is None:
        return solved
    chosen = min(best, solved, key=lambda one: one.cost.processors)
    return replace(chosen, cost=replace(least([best.cost, solved.cost]), memory=chosen.cost.memory))


def least(costs):
    """The least of these costs, each on its own."""
    return Cost(*(min(getattr(cost, one.name) for cost in costs) for one in fields(Cost)))


def of_ours(results, cost):
    """What signorini left in a folder of results."""
    with open(os.path.join(results, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    return Solution(
        cost=cost,
        increments=sum(step["increments"] for step in summary["steps"]),
        iterations=iterations_of_ours(results),
        tolerance=force_tol(results),
        phases=summary.get("time", {}),
    )


def of_ccx(folder, job, solver, cost):
    """What ccx left of a job."""
    return Solution(
        solver=solver,
        cost=cost,
        increments=increments_of_ccx(folder, job),
        iterations=iterations_of_ccx(folder, job),
        tolerance=TOLERANCE_OF_CCX,
    )


def read(row, deck, results, solution):
    """The solution with what the row wants of results that begin with this path; a failure where they are not there."""
    try:
        return replace(solution, **row.read(deck, results))
    except (OSError, ValueError) as error:
        return Solution(failure=f"results are not there: {error}")


def why(code, said, cost):
    """Why a program did not solve a deck."""
    if code is None:
        return f"stopped after {cost.wall:.0f} s"
    errors = [line.strip() for line in said.splitlines() if "error" in line.lower()]
    return f"exit code {code}" + (f", {errors[0]}" if errors else "")
