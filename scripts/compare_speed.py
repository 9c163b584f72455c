#!/usr/bin/env python3
"""Time signorini and CalculiX on the same decks, and compare how accurate both are.

    python scripts/compare_speed.py [--quick] [--rows NAME ...] [--ccx PROGRAM ...] [--repeat N] [--threads N]
        [--markdown docs/speed.md] [--json FILE] [--keep FOLDER]
    python scripts/compare_speed.py --generator make_benchmark_deck.py ...

Without --generator the decks are those of speed_decks.py: ten families, each in two sizes and with two seeds; --quick
takes the smaller size only. --list names the rows; --rows takes some, by names or patterns.

Each deck runs as it is through `signorini run`, with defaults except for --compat and --set, and through CalculiX: all
programs named ccx, ccx_2.22, ccx_MT and the like on the search path, or those that --ccx names, each with all solvers
that it has. Of CalculiX the least processor seconds and the least seconds count, whichever build and solver needs them;
a run that takes much longer than the best one before it is stopped. With --repeat, the least of all runs counts. The
tables have, of whole processes: processor seconds, which other work on the machine lengthens less than seconds;
seconds; the most memory; iterations of Newton's method; ratios, of CalculiX to signorini; their geometric means.

Accuracy of the ten families: the largest difference between the components of the total reactions that both programs
print, of every set of supported or moved nodes, relative to the largest component. Above the tolerance of the family
the row counts as not solved: contact is a penalty in CalculiX and exact in signorini, and CalculiX ends its iterations
at 0.5 % of the mean force. The sum of all reactions and loads of signorini has to vanish, up to the digits printed.

With --generator the decks come from that program, which takes kind, file, --dof, --elem and options, and are two blocks
that are pressed together: `hertz`, a quarter of a cap on a block, and `slide`, a block that is pressed on another one
and slides on it with friction. The tables then have the exponent with which the cost of one increment grows with the
unknowns, from 50,000 on, and the errors against exact solutions.

The accuracy of `hertz` is that of the pressures at the nodes of the slave surface in the last CONTACT table of the .frd
files, relative to p0 of Hertz: the p0 whose p0 sqrt(1 - (r/a)^2) fits those with r < 0.8 a best, by least squares, the
largest one and that of the node on the axis, and the root mean square of the differences from that pressure, over the
nodes with r < a or with pressure. p0 and a are those at the force that the run itself found, four times the last
printed reaction, for a ball of the radius in the heading of the deck and the moduli of its sections (Johnson 1985,
(4.22) to (4.24)). Of `slide` it is the last printed reaction along the slave surface over that across it, compared with
the deck's coefficient of friction: across the mean of its normals at the end, weighted with the pressures there. The
ratio of the reactions along x and z is listed, too; it differs as the surface tilts.

Needs: numpy. Exit code: 0; 1 where a row is not solved, by one of both programs or with forces that differ; 2 wrong
command line or missing program.
"""

import argparse
import fnmatch
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass

import speed_decks
from accuracy import errors, forces
from speed_runs import SOLVERS, Comparison, builds
from speed_tables import about, between_markers, family_page, in_short, page, record

ONE_INCREMENT = ("--dt", "1.0")
MARKERS = ("<!-- compare_speed begins -->", "<!-- compare_speed ends -->")
FAMILY_MARKERS = ("<!-- compare_speed families begin -->", "<!-- compare_speed families end -->")


@dataclass(frozen=True)
class Row:
    """A deck of the program that --generator names, and how it is solved."""

    kind: str
    element: str
    dof: int
    options: tuple[str, ...] = ()
    with_ccx: bool = True
    # what --set changes of the deck for signorini
    changes: tuple[str, ...] = ()
    # of forces, which are compared with exact solutions here
    tolerance: float | None = None

    @property
    def name(self):
        once = "-once" if self.is_one_increment else ""
        return f"{self.kind}-{self.element}-{self.dof}{once}"

    @property
    def is_one_increment(self):
        return self.options[: len(ONE_INCREMENT)] == ONE_INCREMENT

    @property
    def description(self):
        return f"{self.name} {' '.join(self.options)}"

    def write(self, args, path):
        command = [sys.executable, args.generator, self.kind, str(path), "--dof", str(self.dof), "--elem", self.element]
        made = subprocess.run([*command, *self.options], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if made.returncode != 0:
            raise SystemExit(f"error: the generator makes no deck of {self.name}:\n{made.stdout}")

    def read(self, deck, results):
        return {"errors": errors(deck, results)}


@dataclass(frozen=True)
class FamilyRow:
    """A deck of speed_decks.py."""

    kind: str
    dof: int
    seed: int
    tolerance: float
    element: str = ""
    with_ccx: bool = True
    is_one_increment: bool = False
    changes: tuple[str, ...] = ()

    @property
    def name(self):
        return f"{self.kind}-{self.dof}-{self.seed}"

    @property
    def description(self):
        return f"{self.name} tolerance of forces {self.tolerance:g}"

    def write(self, _args, path):
        path.write_text(speed_decks.make(self.kind, self.dof, self.seed).text(), encoding="ascii")

    def read(self, deck, results):
        return {"forces": forces(deck, results)}


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
# unknowns of both sizes, which CalculiX solves in some seconds to half a minute, and the tolerance of forces
SIZES = {
    "assemblies": (6000, 16000, 0.05),
    "joints": (2000, 3500, 0.03),
    "slabs": (4000, 7000, 0.05),
    "plates": (3000, 6000, 0.05),
    "rubber": (1500, 3500, 0.03),
    "gears": (3000, 8000, 0.03),
    "tet10": (3000, 6000, 0.05),
    "plane": (2000, 4000, 0.03),
    "plasticity": (3000, 6000, 0.05),
    "increments": (700, 1500, 0.03),
}
SEEDS = (1, 2)
FAMILY_ROWS = [
    FamilyRow(family, size, seed, tolerance)
    for family, (*sizes, tolerance) in SIZES.items()
    for size in sizes
    for seed in SEEDS
]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--generator", metavar="PATH", help="a program that writes the decks of hertz and slide")
    parser.add_argument("--rows", nargs="+", default=["*"], metavar="NAME", help="only these: names, or patterns with *")
    parser.add_argument("--quick", action="store_true", help="only the smaller size of each family")
    parser.add_argument("--list", action="store_true", help="list the rows, and stop")
    parser.add_argument("--ccx", action="append", default=[], metavar="PROGRAM", help="a build of CalculiX; repeat it")
    parser.add_argument("--signorini", default="target/release/signorini", help="the command of signorini")
    parser.add_argument("--ccx-solvers", nargs="+", default=SOLVERS, metavar="NAME", help="as *STATIC, SOLVER= has them")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), metavar="N", help="of both programs")
    parser.add_argument("--repeat", type=int, default=1, metavar="N", help="runs, of which the least costs count")
    parser.add_argument("--timeout", type=float, default=3600.0, metavar="SECONDS", help="for one run")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="for signorini, in all rows")
    parser.add_argument("--compat", default="none", choices=["none", "ccx"], help="for signorini: whose contact laws")
    parser.add_argument("--note", default="", help="a sentence about this run, for the page")
    parser.add_argument("--markdown", metavar="FILE", help="a page to write the tables into, between its markers")
    parser.add_argument("--json", metavar="FILE", help="write all numbers")
    parser.add_argument("--keep", metavar="FOLDER", help="keep the decks of rows that are not solved")
    return parser.parse_args()


def chosen(args):
    """The rows that the command line asks for."""
    smaller = {family: sizes[0] for family, sizes in SIZES.items()}
    rows = ROWS if args.generator else FAMILY_ROWS
    if args.quick and not args.generator:
        rows = [row for row in rows if row.dof == smaller[row.kind]]
    return [row for row in rows if any(fnmatch.fnmatchcase(row.name, pattern) for pattern in args.rows)]


def fault(args, rows):
    """What is wrong with the command line; none where nothing is."""
    if not rows:
        names = ", ".join(row.name for row in (ROWS if args.generator else FAMILY_ROWS))
        return f"no row is called {' or '.join(args.rows)}; there are: {names}"
    if args.generator and not os.path.isfile(args.generator):
        return f"there is no generator {args.generator}"
    for program in [args.signorini, *args.ccx]:
        if shutil.which(program) is None:
            return f"there is no program {program}"
    if args.markdown:
        path = pathlib.Path(args.markdown)
        if not path.is_file() or between_markers(path.read_text(encoding="utf-8"), "", markers(args)) is None:
            return f"{args.markdown} has no lines {' and '.join(markers(args))}"
    return None


def markers(args):
    """Those between which the tables stand on a page."""
    return MARKERS if args.generator else FAMILY_MARKERS


def main():
    args = arguments()
    rows = chosen(args)
    if args.list and rows:
        print("\n".join(row.description for row in rows))
        return 0
    wrong = fault(args, rows)
    if wrong:
        print(f"error: {wrong}", file=sys.stderr)
        return 2
    programs = builds(args.ccx)
    if not programs:
        print("there is no CalculiX: signorini runs alone")
    args.signorini = os.path.abspath(shutil.which(args.signorini))
    args.generator = args.generator and os.path.abspath(args.generator)
    comparison = Comparison(args, programs)
    introduction, outcomes = about(args, programs), []
    for row in rows:
        with tempfile.TemporaryDirectory() as folder:
            outcomes.append(comparison.compare(row, folder))
            if args.keep and outcomes[-1].faults:
                os.makedirs(args.keep, exist_ok=True)
                shutil.copyfile(os.path.join(folder, "deck.inp"), os.path.join(args.keep, f"{row.name}.inp"))
        print(in_short(outcomes[-1]), flush=True)
        words = [*introduction, *comparison.lacking()]
        tables = (page if args.generator else family_page)(outcomes, words)
        write(args, tables, record(outcomes, words))
    print("\n" + tables)
    return report([one for one in outcomes if one.faults], len(outcomes))


def report(failed, count):
    """States which rows are not solved; the exit code."""
    if failed:
        print(f"{len(failed)} of {count} rows NOT SOLVED: {', '.join(one.row.name for one in failed)}")
    return 1 if failed else 0


def write(args, tables, numbers):
    """Writes what is known so far."""
    if args.json:
        pathlib.Path(args.json).write_text(numbers, encoding="utf-8")
    if args.markdown:
        path = pathlib.Path(args.markdown)
        new = between_markers(path.read_text(encoding="utf-8"), tables, markers(args))
        path.write_text(new, encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
