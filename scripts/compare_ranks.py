#!/usr/bin/env python3
"""Run models on several ranks of MPI, and compare all results with those of one process.

    python scripts/compare_ranks.py --signorini PROGRAM [--ranks 1 2 4] [--models NAME ...] [--decks DECK ...] [--list]

PROGRAM is built with the feature `mpi`. Each model runs once by itself, with `linear = "multigrid"`,
and then by `mpirun` on so many ranks each, with `linear = "petsc"`, all with `newton.force_tol = 1e-11`. On all ranks,

* every table of history.csv and every field of every frame agrees within 1e-9 of the largest value of its kind,
* there are as many increments, and iterations of Newton's method differ by no more than 2,
* linear iterations on one rank are at most twice those of the program's own multigrid, and on more ranks at most 1.3
  times those on one, and 2 more.

The last number of ranks runs twice, and leaves the same bits.

Models: contact of two boxes whose meshes do not match, by penalty, mortar and with friction, one of them rigid, tied, and with
a constraint; decks of scripts/speed_decks.py with plasticity, quadratic tetrahedra and assemblies. --decks names decks to take instead.

Only what comes with Python is used. Exit code: 0; 1 where something differs; 2 wrong command line or missing programs.
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from jobs import RANKS_ENVIRONMENT

MAKER = pathlib.Path(__file__).resolve().parent / "speed_decks.py"
PART = 1e-9
FORCE_TOL = "solver.newton.force_tol=1e-11"
MPIRUN = ["mpirun", "--oversubscribe", "-n"]

HEAD = """format = 1
[material.soft]
model = "linear-elastic"
E = 1000.0
nu = 0.3
density = 1.0
[material.stiff]
model = "linear-elastic"
E = 3000.0
nu = 0.3
density = 1.0
[[body]]
group = "lower"
material = "soft"
[[body]]
group = "upper"
material = "stiff"
rigid = {rigid}
[[contact]]
name = "joint"
secondary = "{secondary}"
primary = "{primary}"
{contact}
[[step]]
name = "press"
geometry = "nonlinear"
increments = 3
[[step.fix]]
on = "lower_bottom"
u = "all"
{step}
"""
PRESS = """[[step.move]]
on = "{top}"
ux = {across}
uy = 0.0
uz = -0.02
"""
PULL = """[[step.load]]
on = "upper_top"
pressure = -3.0
coupling = "{coupling}"
[[step.load]]
on = "upper_side"
pressure = 1.0
"""
# contact, and what the step does
BOXES = {
    "penalty": ("enforcement = { penalty = 1e5 }\nmethod = \"gauss-point\"", PRESS.format(top="upper_top", across=0.0)),
    "mortar": ('method = "mortar"', PRESS.format(top="upper_top", across=0.0)),
    "friction": ('method = "mortar"\nfriction = 0.3', PRESS.format(top="upper_top", across=0.05)),
    "nodes": ('method = "node-to-segment"\nfriction = 0.2', PRESS.format(top="upper_top", across=0.05)),
    "rigid": ('method = "mortar"\nfriction = 0.2', PRESS.format(top="upper", across=0.03)),
    "tied": ("tied = true", PULL.format(coupling="none")),
    "constraint": ("tied = true", PULL.format(coupling="rigid-z")),
}
DECKS = ["plasticity", "tet10", "assemblies", "joints"]


def box(number, group, low, high, cells):
    """Nodes, hexahedra and node sets of a box: {name: numbers} of its bottom, its top and one side."""
    nodes, elements, index = [], [], {}
    for k in range(cells[2] + 1):
        for j in range(cells[1] + 1):
            for i in range(cells[0] + 1):
                at = [a + (b - a) * n / c for a, b, n, c in zip(low, high, (i, j, k), cells)]
                index[i, j, k] = number + len(nodes)
                nodes.append([index[i, j, k], *at])
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    for k in range(cells[2]):
        for j in range(cells[1]):
            for i in range(cells[0]):
                elements.append([index[i + a, j + b, k + c] for c in (0, 1) for a, b in corners])
    level = {name: [n for at, n in index.items() if at[axis] == value] for name, axis, value in
             [("bottom", 2, 0), ("top", 2, cells[2]), ("side", 0, 0)]}
    return nodes, [(group, element) for element in elements], {f"{group}_{k}": v for k, v in level.items()}


def boxes(name, swapped):
    """A case of two boxes."""
    contact, step = BOXES[name]
    nodes, elements, sets = box(1, "lower", (0.0, 0.0, 0.0), (3.0, 2.4, 1.0), (14, 11, 6))
    more = box(len(nodes) + 1, "upper", (0.7, 0.5, 1.0), (2.2, 1.9, 1.9), (8, 7, 6))
    nodes, elements, sets = nodes + more[0], elements + more[1], {**sets, **more[2]}
    rows = [
        f'{{ id = {n}, type = "hex8", group = "{group}", nodes = {element} }}'
        for n, (group, element) in enumerate(elements, 1)
    ]
    sides = ["upper_bottom", "lower_top"][:: -1 if swapped else 1]
    text = HEAD.format(
        rigid="true" if name == "rigid" else "false",
        secondary=sides[0],
        primary=sides[1],
        contact=contact,
        step=step,
    )
    named = "\n".join(f"{name} = {{ nodes = {numbers} }}" for name, numbers in sets.items())
    mesh = f"[mesh]\nnodes = {nodes}\nelements = [\n" + ",\n".join(rows) + "\n]\n"
    return text + f'{mesh}[model]\nspace = "3d"\n[sets]\n{named}\n'


def models(folder, names, decks):
    """Files of models by name."""
    if decks:
        return {pathlib.Path(deck).stem: os.path.abspath(deck) for deck in decks}
    found = {}
    for name in BOXES:
        for swapped in (False, True):
            # a rigid secondary side has no multipliers of its own
            if swapped and name in ("rigid", "tied", "constraint"):
                continue
            path = folder / f"{name}{'_swapped' if swapped else ''}.toml"
            path.write_text(boxes(name, swapped))
            found[path.stem] = str(path)
    for family in DECKS:
        path = folder / f"{family}.inp"
        run([sys.executable, str(MAKER), family, str(path), "--dof", "3000", "--seed", "7"], folder)
        found[family] = str(path)
    return {name: path for name, path in found.items() if not names or name in names}


def run(command, folder):
    done = subprocess.run(command, cwd=folder, env={**os.environ, **RANKS_ENVIRONMENT}, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)}: exit code {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def counts(folder):
    """Increments, iterations and linear iterations of each step."""
    steps = json.loads((folder / "summary.json").read_text())["steps"]
    return [(step["increments"], step["iterations"], step["linear_iterations"]) for step in steps]


def scale(block, norms, kinds):
    """What a block is compared with: the largest value of its kind."""
    name = block["name"].split(" in step ")[0]
    if "gap" in name or ".center_" in name:
        return norms.get("nodes", 0.0)
    if "moment_" in name:
        return kinds["force"] * norms.get("nodes", 0.0)
    if "force" in name:
        return kinds["force"]
    if "shear" in name:
        return max(norms.get("contact_pressure at nodes", 0.0), block["numbers"]["norm"])
    return block["numbers"]["norm"]


def worst(program, ours, theirs, folder):
    """The largest difference between two folders of results, in parts of the largest value of its kind, and where."""
    command = [program, "diff", str(ours), str(theirs), "--rel", "1e-300", "--json"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    blocks = [json.loads(line) for line in done.stdout.splitlines()]
    unlike = [b["name"] for b in blocks if b["ev"] == "block" and b["outcome"] != "compared"]
    blocks = [b for b in blocks if b["ev"] == "block" and b["outcome"] == "compared"]
    if not blocks or unlike:
        raise SystemExit(f"{theirs}: results of another form: {unlike or done.stdout + done.stderr}")
    norms = {block["name"]: block["numbers"]["norm"] for block in blocks}
    forces = [b["numbers"]["norm"] for b in blocks if "force" in b["name"]]
    kinds = {"force": max(forces, default=0.0)}
    parts = []
    for block in blocks:
        difference = block["numbers"]["difference"]
        size = scale(block, norms, kinds)
        part = difference / size if size > 0.0 else (0.0 if difference == 0.0 else float("inf"))
        parts.append((part, f"{block['name']} ({block['file']})"))
    return max(parts)


def same_bits(one, other):
    files = sorted(path.name for path in (one / "frames").iterdir())
    pairs = [("history.csv", "history.csv")] + [(f"frames/{name}", f"frames/{name}") for name in files]
    return all((one / a).read_bytes() == (other / b).read_bytes() for a, b in pairs)


def compare(program, name, model, ranks, folder):
    """The findings of one model: (whether it holds, what)."""
    alone = folder / f"{name}_alone"
    common = [program, "run", model, "--fresh", "--threads", "1", "--set", FORCE_TOL, "-q", "-o"]
    run([*common, str(alone), "--set", "solver.linear=multigrid"], folder)
    expected = counts(alone)
    findings, on_one = [], None
    for n in ranks:
        out = folder / f"{name}_{n}"
        run([*MPIRUN, str(n), *common, str(out), "--set", "solver.linear=petsc"], folder)
        found = counts(out)
        part, where = worst(program, alone, out, folder)
        findings.append((part <= PART, f"{n} ranks: largest difference {part:.1e}, {where}"))
        increments = [step[0] for step in found] == [step[0] for step in expected]
        iterations = all(abs(a[1] - b[1]) <= 2 for a, b in zip(found, expected))
        findings.append((increments and iterations, f"{n} ranks: increments and iterations {found} for {expected}"))
        linear = sum(step[2] for step in found)
        if on_one is None:
            on_one = linear
            most = 2.0 * sum(step[2] for step in expected) + 2
        else:
            most = 1.3 * on_one + 2
        findings.append((linear <= most, f"{n} ranks: {linear} linear iterations, {most:.0f} at most"))
    again = folder / f"{name}_again"
    run([*MPIRUN, str(ranks[-1]), *common, str(again), "--set", "solver.linear=petsc"], folder)
    findings.append((same_bits(out, again), f"{ranks[-1]} ranks: the same bits again"))
    return findings


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--signorini", required=True, help="the program, built with the feature mpi")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2, 4])
    parser.add_argument("--models", nargs="+", default=[], help="names; all models without it")
    parser.add_argument("--decks", nargs="+", default=[], help="decks to take instead of models")
    parser.add_argument("--list", action="store_true", help="list the models, and stop")
    arguments = parser.parse_args()
    program = shutil.which(arguments.signorini)
    if program is None or shutil.which("mpirun") is None:
        print("compare_ranks: signorini or mpirun is missing", file=sys.stderr)
        return 2
    program = os.path.abspath(program)
    passed = failed = 0
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        found = models(folder, arguments.models, arguments.decks)
        if arguments.list:
            print("\n".join(found))
            return 0
        for name, model in found.items():
            for holds, what in compare(program, name, model, arguments.ranks, folder):
                passed, failed = passed + holds, failed + (not holds)
                print(f"{'ok  ' if holds else 'WRONG'} {name}, {what}", flush=True)
            for path in folder.glob(f"{name}_*"):
                shutil.rmtree(path, ignore_errors=True) if path.is_dir() else None
    print(f"compare_ranks: {passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
