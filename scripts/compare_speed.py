#!/usr/bin/env python3
"""Time signorini beside CalculiX on the same decks, and tell how accurate both are.

    python scripts/compare_speed.py --generator make_benchmark_deck.py [--rows NAME ...] [--repeat N]
        [--threads N] [--markdown docs/speed.md] [--json FILE]

The generator writes the decks, two blocks that are pressed together: `hertz`, a quarter of a cap on a block, and
`slide`, a block that is pressed on another one and slides on it with friction. It is a program of its own, which takes
kind, file, --dof, --elem and options; without it nothing is compared. --list names the rows; --rows takes some, by
names or patterns.

Each deck runs as it is through `ccx`, once for each of its solvers that there is, and through `signorini run`, with
defaults but for what --compat and --set change. Of ccx the fastest solver counts, and one that takes longer than a
faster one before it is stopped. Each runs --repeat times, and the fastest run counts. Both write an .frd file. Told
are, of whole processes, seconds by the clock and of processors, which other work on the machine lengthens less, and the
most memory; iterations of Newton's method; the part of the mean force at which these end; ratios, of ccx to signorini;
their geometric means; and the exponent with which the cost of one increment grows with the unknowns, from 50,000 on.

The accuracy of `hertz` is that of the pressures at the nodes of the slave surface in the last CONTACT table of the .frd
files, in parts of p0 of Hertz: the p0 whose p0 sqrt(1 - (r/a)^2) fits those with r < 0.8 a best, by least squares, the
largest one and that of the node on the axis, beside p0, and the root mean square of the differences from that pressure,
over the nodes with r < a or with pressure. p0 and a are those at the force that the run itself found, four times the
last printed reaction, for a ball of the radius in the heading of the deck and the moduli of its sections (Johnson 1985,
(4.22) to (4.24)). Of `slide` it is the part of the last printed reaction along the slave surface over that across it,
beside the deck's coefficient of friction: across the mean of its normals at the end, weighted with the pressures there.
The ratio of the reactions along x and z is told, too; it differs as the surface tilts.

Needs: numpy. Exit code: 0, also where nothing is compared; 1 where signorini did not solve a deck; 2 wrong command line
or missing program.
"""

import argparse
import datetime
import fnmatch
import json
import math
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass, field

import numpy as np

from accuracy import Deck, errors
from jobs import Cost, iterations_of_ccx, iterations_of_ours, keywords, measured, run, version

# as *STATIC names them
SOLVERS = ["ITERATIVECHOLESKY", "ITERATIVESCALING", "SPOOLES", "PARDISO", "PASTIX"]
# what ccx says of a solver that it has not
NOT_LINKED = "library is not linked"
# ccx's residual that ends its iterations, by default, in parts of the mean force
TOLERANCE_OF_CCX = 5e-3
# the exponent is that of decks from so many unknowns on, which take one increment
LARGE = 50_000
ONE_INCREMENT = ("--dt", "1.0")
NOTHING = "–"
BEGIN, END = "<!-- compare_speed begins -->", "<!-- compare_speed ends -->"
@dataclass(frozen=True)
class Row:
    """A deck, and how it is solved."""

    kind: str
    element: str
    dof: int
    options: tuple[str, ...] = ()
    with_ccx: bool = True
    # what --set changes of the deck for signorini
    changes: tuple[str, ...] = ()

    @property
    def name(self):
        once = "-once" if self.is_one_increment else ""
        return f"{self.kind}-{self.element}-{self.dof}{once}"

    @property
    def is_one_increment(self):
        return self.options[: len(ONE_INCREMENT)] == ONE_INCREMENT


FRICTION = ("--mu", "0.3", "--nlgeom")
# a stiffness of the contact that ccx takes without many more iterations
SOFT = ("--K", "1e6")
ONCE_SOFT = (*ONE_INCREMENT, *SOFT)
# signorini has no incompatible modes at finite strain, where they go unstable in compression
OTHER_MODES = ("body.0.locking=auto", "body.1.locking=auto")
# multipliers of quadratic triangles scatter, and results show them as they are unless they are asked to smooth them
SMOOTHED = ("output.contact_pressure=smoothed",)
ROWS = [
    Row("hertz", "C3D8", 10_000, SOFT),
    Row("slide", "C3D8", 10_000, FRICTION),
    Row("slide", "C3D8I", 10_000, FRICTION, changes=OTHER_MODES),
    Row("hertz", "C3D8", 50_000, SOFT),
    Row("hertz", "C3D8", 50_000, ONCE_SOFT),
    Row("slide", "C3D8", 50_000, FRICTION),
    Row("slide", "C3D8I", 50_000, FRICTION, changes=OTHER_MODES),
    Row("hertz", "C3D10", 50_000, ONCE_SOFT, changes=SMOOTHED),
    Row("hertz", "C3D8", 150_000, ONCE_SOFT),
    Row("hertz", "C3D8", 300_000, ONCE_SOFT),
    Row("hertz", "C3D8", 1_000_000, ONCE_SOFT, with_ccx=False),
]


@dataclass
class Solution:
    """What one program made of a deck; `failure` says why it made nothing of it."""

    failure: str = ""
    solver: str = ""
    cost: Cost | None = None
    increments: int | None = None
    iterations: int | None = None
    tolerance: float | None = None
    # in parts of what they are errors of, by name
    errors: dict[str, float] = field(default_factory=dict)
    # seconds, by name
    phases: dict[str, float] = field(default_factory=dict)


@dataclass
class Outcome:
    """What became of a row; `ccx` is none where it has no part in it."""

    row: Row
    dof: int
    ours: Solution
    ccx: Solution | None
    # what other solvers of ccx did
    others: list[str] = field(default_factory=list)

    def ratio(self, of):
        """Of a cost: ccx to signorini; none where one of both has none."""
        costs = [solution.cost if solution else None for solution in (self.ccx, self.ours)]
        return None if None in costs else of(costs[0]) / of(costs[1])


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

    def __init__(self, args, ccx):
        self.args, self.ccx = args, ccx
        # solvers that this ccx has not
        self.missing = []

    def compare(self, row, folder):
        """Makes the deck of a row in a folder, and solves it."""
        path = os.path.join(folder, "deck.inp")
        command = [sys.executable, self.args.generator, row.kind, path, "--dof", str(row.dof), "--elem", row.element]
        made = subprocess.run([*command, *row.options], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if made.returncode != 0:
            raise SystemExit(f"error: the generator makes no deck of {row.name}:\n{made.stdout}")
        text = pathlib.Path(path).read_text(encoding="ascii")
        deck = Deck(text)
        outcome = Outcome(row, deck.dof, self.run_ours(row, deck, folder), None)
        if self.ccx and row.with_ccx:
            self.run_ccx(outcome, deck, text, folder)
        return outcome

    def lacking(self):
        """Which solvers were not there, in a sentence."""
        return [f"This ccx has no {', '.join(self.missing)}."] if self.missing else []

    def measure(self, command, folder, limit=math.inf):
        return measured(command, folder, min(limit, self.args.timeout), self.args.threads)

    def run_ours(self, row, deck, folder):
        """Solves by signorini; the fastest run counts."""
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
        return read(deck, os.path.join(results, "deck"), of_ours(results, min(costs, key=wall)))

    def run_ccx(self, outcome, deck, text, folder):
        """Solves by all solvers of ccx; the fastest one counts, and ends those that are slower."""
        best = None
        for solver in [solver for solver in self.args.ccx_solvers if solver not in self.missing]:
            job = solver.lower()
            pathlib.Path(folder, f"{job}.inp").write_text(with_solver(text, solver), encoding="ascii")
            for _ in range(self.args.repeat):
                limit = best.cost.wall if best else math.inf
                code, said, cost = self.measure([self.ccx, "-i", job], folder, limit)
                if NOT_LINKED in said:
                    self.missing.append(solver)
                    break
                if code != 0:
                    if best is None or best.solver != solver:
                        outcome.others.append(f"{solver} {why(code, said, cost)}")
                    break
                found = read(deck, os.path.join(folder, job), of_ccx(folder, job, solver, cost))
                if found.failure:
                    outcome.others.append(f"{solver} {found.failure}")
                    break
                if cost.wall < limit:
                    best = found
            for left in pathlib.Path(folder).glob(f"{job}.*"):
                left.unlink()
        outcome.ccx = best or Solution(failure="; ".join(outcome.others) or "none of its solvers is there")


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


def read(deck, results, solution):
    """The solution with the errors of the results that begin with this path; a failure where they are not there."""
    try:
        solution.errors = errors(deck, results)
    except (OSError, ValueError) as error:
        return Solution(failure=f"results are not there: {error}")
    return solution


def why(code, said, cost):
    """Why a program did not solve a deck."""
    if code is None:
        return f"stopped after {cost.wall:.0f} s"
    errors = [line.strip() for line in said.splitlines() if "error" in line.lower()]
    return f"exit code {code}" + (f", {errors[0]}" if errors else "")


def mean(values):
    """The geometric mean of those that there are."""
    some = [value for value in values if value is not None]
    return math.exp(sum(map(math.log, some)) / len(some)) if some else None


def wall(cost):
    return cost.wall


def processors(cost):
    return cost.processors


def memory(cost):
    return cost.memory


def sizes(outcomes, whose):
    """Unknowns and costs of the rows that the exponents are those of."""
    found = {}
    for outcome in outcomes:
        row, solution = outcome.row, whose(outcome)
        is_meant = row.kind == "hertz" and row.element == "C3D8" and row.dof >= LARGE and row.is_one_increment
        if is_meant and solution is not None and solution.cost is not None:
            found[outcome.dof] = solution.cost
    return found


def exponents(found):
    """How costs grow with the unknowns; none where there are not two sizes."""
    if len(found) < 2:
        return None
    slopes = {
        name: float(np.polyfit(np.log(list(found)), np.log([of(cost) for cost in found.values()]), 1)[0])
        for name, of in (("wall", wall), ("processors", processors), ("memory", memory))
    }
    return {"from": min(found), "to": max(found), **slopes}


def number(value, form):
    return NOTHING if value is None else format(value, form)


def both(outcome, of):
    """A text of ccx and of signorini, where they have one."""
    return [of(one) if one is not None and one.cost is not None else NOTHING for one in (outcome.ccx, outcome.ours)]


def counts(outcome, of):
    """A number of ccx and of signorini in one cell."""
    return " / ".join(both(outcome, lambda one: number(of(one), "d")))


def cost_cells(outcome, of, form):
    return [*both(outcome, lambda one: form(of(one.cost))), number(outcome.ratio(of), ".2f")]


def table(headings, rows):
    lines = [headings, ["---"] * len(headings), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def speeds(outcomes):
    """Seconds, memory and iterations of all rows."""
    headings = ["row", "unknowns", "increments", "iterations"]
    for what in ("seconds", "processor seconds", "MB"):
        headings += [f"{what}: ccx", "ours", "ratio"]
    rows = []
    for one in outcomes:
        cells = [one.row.name, str(one.dof), counts(one, lambda s: s.increments), counts(one, lambda s: s.iterations)]
        for of in (wall, processors):
            cells += cost_cells(one, of, lambda seconds: f"{seconds:.2f}")
        cells += cost_cells(one, memory, lambda size: f"{size / 1e6:.0f}")
        rows.append([*cells, one.ccx.solver.lower() if one.ccx and one.ccx.cost else NOTHING])
    return table([*headings, "solver of ccx"], rows)


def accuracies(outcomes):
    """Errors of all rows."""
    headings = ["row", "tolerance of forces: ccx", "ours", "p0 fitted: ccx", "ours", "largest pressure: ccx", "ours"]
    headings += ["in the centre: ccx", "ours", "rms: ccx", "ours"]
    headings += ["friction along the surface: ccx", "ours", "along the axes: ccx", "ours"]
    rows = []
    for one in outcomes:
        cells = [one.row.name, *both(one, lambda s: number(s.tolerance, ".0e"))]
        signed = ("fitted", "largest", "centre")
        forms = {**dict.fromkeys(signed, "+.2%"), "rms": ".2%", "friction": "+.4%", "axes": "+.4%"}
        for key, form in forms.items():
            cells += both(one, lambda s, key=key, form=form: number(s.errors.get(key), form))
        rows.append(cells)
    return table(headings, rows)


def phases(outcomes):
    """Where signorini's seconds go."""
    solved = [one for one in outcomes if one.ours.phases]
    sums = {}
    for one in solved:
        for name, seconds in one.ours.phases.items():
            sums[name] = sums.get(name, 0.0) + seconds
    names = sorted(sums, key=sums.get, reverse=True)
    rows = [[one.row.name, *(number(one.ours.phases.get(name), ".2f") for name in names)] for one in solved]
    return table(["row", *names], rows)


def sums(outcomes):
    """What all rows together say: means of ratios, and exponents."""
    return {
        "ratios": {
            name: mean(one.ratio(of) for one in outcomes)
            for name, of in (("wall", wall), ("processors", processors), ("memory", memory))
        },
        "exponents": {
            "ccx": exponents(sizes(outcomes, lambda one: one.ccx)),
            "signorini": exponents(sizes(outcomes, lambda one: one.ours)),
        },
    }


def in_words(found):
    """The sums, a line each."""
    lines, ratios = [], found["ratios"]
    if ratios["wall"] is not None:
        compared = "{wall:.2f} in seconds, {processors:.2f} in processor seconds, {memory:.2f} in memory".format(**ratios)
        lines.append(f"* Geometric means of the ratios, ccx to signorini: {compared}.")
    for whose, grown in found["exponents"].items():
        if grown is not None:
            powers = "n^{wall:.2f} in seconds, n^{processors:.2f} in processor seconds, n^{memory:.2f} in memory"
            between = "from {from:,} to {to:,} unknowns".format(**grown)
            lines.append(f"* One increment of hertz with C3D8 {between} in {whose}: {powers.format(**grown)}.")
    return lines


def remarks(outcomes):
    """What was not solved, and what other solvers of ccx did, a line each."""
    lines = []
    for one in outcomes:
        for whose, solution in (("signorini", one.ours), ("ccx", one.ccx)):
            if solution is not None and solution.failure:
                lines.append(f"{one.row.name}: {whose}: {solution.failure}")
        if one.others and one.ccx.cost:
            lines.append(f"{one.row.name}: ccx: {'; '.join(one.others)}")
        if one.row.changes:
            lines.append(f"{one.row.name}: signorini with {' '.join(f'--set {change}' for change in one.row.changes)}")
    return lines


def machine():
    """Processor, cores, memory and load, in words."""
    model = platform.processor() or platform.machine()
    try:
        info = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
        found = re.search(r"model name\s*:\s*(.+)", info)
        model = found.group(1).strip() if found else model
    except OSError:
        pass
    size = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    load = os.getloadavg()[0]
    return f"{model}, {os.cpu_count()} cores, {size:.0f} GiB; load before the run {load:.1f}"


def page(outcomes, about):
    """All tables, with what they are about."""
    parts = ["\n".join(about), speeds(outcomes), "\n".join(in_words(sums(outcomes))), accuracies(outcomes)]
    parts += [phases(outcomes), "\n".join(f"* {line}" for line in remarks(outcomes))]
    return "\n\n".join(part.strip() for part in parts if part.strip()) + "\n"


def between_markers(text, new):
    """A page with something new between its markers; none where it has no markers."""
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    return f"{before}{begin}\n{new}{end}{after}" if begin and end else None


def record(outcomes, about):
    rows = [{"name": one.row.name, **asdict(one)} for one in outcomes]
    return json.dumps({"about": about, "sums": sums(outcomes), "rows": rows}, indent=1) + "\n"


def said(outcome):
    """A line of a row while others still run."""
    solutions = [("ccx", outcome.ccx), ("signorini", outcome.ours)]
    parts = []
    for name, one in solutions:
        if one is not None:
            parts.append(f"{name} {one.cost.wall:.2f} s" if one.cost else f"{name} failed: {one.failure}")
    ratio = outcome.ratio(wall)
    return f"{outcome.row.name}: {', '.join(parts)}" + (f", ratio {ratio:.2f}" if ratio else "")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--generator", metavar="PATH", help="the program that writes the decks")
    parser.add_argument("--rows", nargs="+", default=["*"], metavar="NAME", help="only these: names, or patterns with *")
    parser.add_argument("--list", action="store_true", help="list the rows, and stop")
    parser.add_argument("--ccx", default="ccx", help="the command of CalculiX")
    parser.add_argument("--signorini", default="target/release/signorini", help="the command of signorini")
    parser.add_argument("--ccx-solvers", nargs="+", default=SOLVERS, metavar="NAME", help="as *STATIC, SOLVER= has them")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), metavar="N", help="of both programs")
    parser.add_argument("--repeat", type=int, default=1, metavar="N", help="runs, of which the fastest counts")
    parser.add_argument("--timeout", type=float, default=3600.0, metavar="SECONDS", help="for one run")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="for signorini, in all rows")
    parser.add_argument("--compat", default="none", choices=["none", "ccx"], help="for signorini: whose contact laws")
    parser.add_argument("--note", default="", help="a sentence about this run, for the page")
    parser.add_argument("--markdown", metavar="FILE", help="a page to write the tables into, between its markers")
    parser.add_argument("--json", metavar="FILE", help="write all numbers")
    return parser.parse_args()


def chosen(patterns):
    return [row for row in ROWS if any(fnmatch.fnmatchcase(row.name, pattern) for pattern in patterns)]


def fault(args, rows):
    """What is wrong with the command line; none where nothing is."""
    if not rows:
        return f"no row is called {' or '.join(args.rows)}; there are: {', '.join(row.name for row in ROWS)}"
    if shutil.which(args.signorini) is None:
        return f"there is no program {args.signorini}"
    if args.markdown:
        path = pathlib.Path(args.markdown)
        if not path.is_file() or between_markers(path.read_text(encoding="utf-8"), "") is None:
            return f"{args.markdown} has no lines {BEGIN} and {END}"
    return None


def about(args, ccx):
    """Date, machine, programs, command line."""
    _, ours, _ = run([args.signorini, "--version"], ".", 60.0)
    threads = f"{args.threads} thread{'' if args.threads == 1 else 's'}"
    best = f"the fastest of {args.repeat} runs" if args.repeat > 1 else "one run each"
    programs = f"{ours.strip()}, " + (f"CalculiX {version(ccx)}" if ccx else "no CalculiX")
    options = [f"--compat {args.compat}", *(f"--set {change}" for change in args.set)]
    when = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC")
    lines = [f"{when}, {machine()}. {programs}; {threads}, {best}; signorini with `{' '.join(options)}`."]
    return [*lines, *([args.note] if args.note else [])]


def main():
    args = arguments()
    rows = chosen(args.rows)
    if args.list:
        print("\n".join(f"{row.name} {' '.join(row.options)}" for row in rows))
        return 0
    wrong = fault(args, rows)
    if wrong:
        print(f"error: {wrong}", file=sys.stderr)
        return 2
    if args.generator is None or not os.path.isfile(args.generator):
        print("compare_speed: skipped, for there is no generator of decks: give one by --generator PATH")
        return 0
    ccx = shutil.which(args.ccx)
    if ccx is None:
        print(f"there is no program {args.ccx}: signorini runs alone")
    args.generator, args.signorini = os.path.abspath(args.generator), os.path.abspath(shutil.which(args.signorini))
    comparison = Comparison(args, ccx and os.path.abspath(ccx))
    introduction, outcomes = about(args, ccx), []
    for row in rows:
        with tempfile.TemporaryDirectory() as folder:
            outcomes.append(comparison.compare(row, folder))
        print(said(outcomes[-1]), flush=True)
        told = [*introduction, *comparison.lacking()]
        write(args, outcomes, told)
    print("\n" + page(outcomes, told))
    return 1 if any(one.ours.failure for one in outcomes) else 0


def write(args, outcomes, told):
    """Writes what is known so far."""
    if args.json:
        pathlib.Path(args.json).write_text(record(outcomes, told), encoding="utf-8")
    if args.markdown:
        path = pathlib.Path(args.markdown)
        new = between_markers(path.read_text(encoding="utf-8"), page(outcomes, told))
        path.write_text(new, encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
