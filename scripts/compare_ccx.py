#!/usr/bin/env python3
"""Run decks through CalculiX and through signorini, and compare what both print.

    python scripts/compare_ccx.py [DECKS] [--contact] [--heat] [--least-contact N] [--least N] [--markdown FILE]

DECKS is a folder with decks, .inp or .inp.gz; without it, that of Debian's package calculix-ccx-test. Taken are the
decks whose procedures are all *STATIC, or of these, with --contact, those with *CONTACT PAIR or *GAP; with --heat those that
solve for temperatures, too. Each runs in a
temporary folder, with one thread, once by ccx and once by `signorini run --compat ccx`. Compared are the tables of
their .dat files by `signorini diff`: a difference counts in parts of the largest value of its table; where the deck
prints no table, displacements and stresses of their .frd files. Tables of numbers below 1e-9 alone are zero. Where
increments differ, times that only one of both has do not count, but the last time of every table of ccx does.

Gaps and tractions at integration points of faces in contact do not count: the programs have other points. Of a deck
that leaves nothing else, ccx runs once more with displacements and stresses at nodes asked for in its last step, and
these are compared; the table says so by `asked`.

A submodel gets the results of its global model from ccx, which runs that first.

What differs is compared once more with ccx iterating to the end: with the residual that ends its iterations ten thousand
times smaller, and with its direct solver. Its default, half a percent of the mean force, is larger than the tolerance.

A line for each deck: `agrees`; `converged`, which agrees with the second run of ccx; `differs`, with the table that differs most; `refused`, with the first reason of
signorini; `fails`, where signorini did not solve it; `no reference`, where ccx did not, or left nothing to compare. Behind it the
largest difference, iterations of signorini and of ccx, seconds of both. Then the counts, and the reasons by how often
they occur.

Only what comes with Python is used. Exit code: 0; 1 where fewer agree than asked for; 2 wrong command line or missing
programs.
"""

import argparse
import collections
import gzip
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile
from dataclasses import dataclass, field

from jobs import events, iterations_of_ccx, iterations_of_ours, keywords, run

DEBIAN = "/usr/share/doc/calculix-ccx-test/examples/test"
# blank-free beginnings of the keywords of procedures, as CalculiX knows them
PROCEDURES = [
    "BUCKLE",
    "CFD",
    "COMPLEXFREQUENCY",
    "COUPLEDTEMPERATURE-DISPLACEMENT",
    "CRACKPROPAGATION",
    "DYNAMIC",
    "ELECTROMAGNETICS",
    "FEASIBLEDIRECTION",
    "FREQUENCY",
    "GREEN",
    "HEATTRANSFER",
    "MODALDYNAMIC",
    "ROBUSTDESIGN",
    "SENSITIVITY",
    "STATIC",
    "STEADYSTATEDYNAMICS",
    "SUBSTRUCTUREGENERATE",
    "UNCOUPLEDTEMPERATURE-DISPLACEMENT",
    "VISCO",
]
OF_HEAT = ["COUPLEDTEMPERATURE-DISPLACEMENT", "HEATTRANSFER", "UNCOUPLEDTEMPERATURE-DISPLACEMENT"]
# residual and correction, in parts of the mean force and the largest increment
CONVERGED = "*CONTROLS, PARAMETERS=FIELD\n5.E-7, 1.E-5\n"
CONTACT = ["CONTACTPAIR", "GAP"]
# not *CONTACT PAIR's: *GAP CONDUCTANCE and *GAP HEAT GENERATION are no gaps
NO_CONTACT = ["GAPCONDUCTANCE", "GAPHEATGENERATION"]
IN_FRD = ["DISP", "STRESS"]
# tables of contact at integration points, but for their energies, which add up over a face
AT_POINTS = re.compile(r"(displacement|stress) \(slave element\+face")
ASKED = "*NODE FILE\nU\n*EL FILE\nS\n"
TOLERANCE = 1e-3
# what is smaller is zero but for rounding, in the units of any deck
ZERO = 1e-9
REFUSED = 3
# the results of a global model that a submodel takes its displacements from
GLOBAL = re.compile(r"^\*\s*SUBMODEL\b.*\bINPUT\s*=\s*\"?([^\",\s]+)", re.IGNORECASE | re.MULTILINE)


@dataclass
class Outcome:
    """What became of a deck."""

    deck: str
    has_contact: bool
    status: str
    reason: str = ""
    largest: float | None = None
    iterations: tuple[int | None, int | None] = (None, None)
    seconds: tuple[float, float] = (0.0, 0.0)
    # whether ccx was asked for results that the deck does not ask for
    asked: bool = False


@dataclass
class Blocks:
    """What a comparison of two files found."""

    compared: int = 0
    largest: float = 0.0
    # name, or name and time, of what differs most; tables of the reference that are not there at their last time
    worst: str = ""
    lacking: list[str] = field(default_factory=list)


def begins(keyword, names):
    return any(keyword.startswith(name) for name in names)


def is_static(found):
    """Whether all procedures among these keywords are *STATIC, and there is one."""
    procedures = [keyword for keyword in found if begins(keyword, PROCEDURES)]
    return bool(procedures) and all(keyword.startswith("STATIC") for keyword in procedures)


def is_of_heat(found):
    """Whether some of these procedures solve for temperatures, and all others are *STATIC."""
    procedures = [keyword for keyword in found if begins(keyword, PROCEDURES)]
    some = any(begins(keyword, OF_HEAT) for keyword in procedures)
    return some and all(begins(keyword, ["STATIC", *OF_HEAT]) for keyword in procedures)


def has_contact(found):
    return any(begins(keyword, CONTACT) and not begins(keyword, NO_CONTACT) for keyword in found)


def converged(text):
    """The deck with tight tolerances and a direct solver."""
    lines = []
    for line in text.splitlines():
        card = keywords(line)[:1]
        if card == ["ENDSTEP"]:
            lines.append(CONVERGED.rstrip())
        if card == ["STATIC"]:
            line = re.sub(r",\s*SOLVER\s*=[^,]*", "", line, flags=re.IGNORECASE)
        lines.append(line)
    return "\n".join(lines) + "\n"


def asked(text):
    """The deck with displacements and stresses asked for in its last step."""
    lines = text.splitlines()
    ends = [k for k, line in enumerate(lines) if keywords(line)[:1] == ["ENDSTEP"]]
    if ends:
        lines.insert(ends[-1], ASKED.rstrip())
    return "\n".join(lines) + "\n"


def unpack(source, target):
    """Copies the files of a folder into another one; those that end in .gz are unpacked."""
    os.makedirs(target)
    for entry in sorted(os.scandir(source), key=lambda entry: entry.name):
        if not entry.is_file():
            continue
        to = os.path.join(target, entry.name)
        if entry.name.endswith(".gz"):
            with gzip.open(entry.path, "rb") as packed, open(to[: -len(".gz")], "wb") as file:
                shutil.copyfileobj(packed, file)
        else:
            shutil.copyfile(entry.path, to)


def chosen(folder, only_contact, of_heat=False):
    """Static decks of a folder by name, or those of heat: their paths, and whether they have contact."""
    is_meant = is_of_heat if of_heat else is_static
    decks = []
    for path in sorted(pathlib.Path(folder).glob("*.inp")):
        found = keywords(path.read_text(encoding="utf-8", errors="replace"))
        contact = has_contact(found)
        if is_meant(found) and (contact or not only_contact):
            decks.append((path.stem, contact))
    return decks


def first_error(said):
    """The message of the first error in a run's events."""
    of_errors = (e for e in events(said) if e.get("ev") == "diagnostic" and e.get("severity") == "error")
    return next((str(e.get("message", "")) for e in of_errors), "")


def feature(reason):
    """A reason without names and numbers of its deck: what is counted."""
    text = re.sub(r"^.*\.inp(, line \d+)?: ", "", reason)
    text = re.sub(r"\"[^\"]*\"|`[^`]*`", "…", text)
    text = re.sub(r"(?<![A-Z0-9_*-])\d+(?![A-Z0-9])", "n", text)
    return " ".join(text.split())


def judge(said, names=None):
    """What `signorini diff --json` found, of the tables of these names, or of all."""
    blocks = Blocks()
    last = {}
    for event in events(said):
        name = event.get("name", "")
        if event.get("ev") != "block" or AT_POINTS.search(name) or names is not None and name not in names:
            continue
        outcome, at = event.get("outcome"), event.get("time")
        if outcome == "compared":
            numbers = event["numbers"]
            # rows that only one of both has differ, whatever their values are
            ratio = 1.0 if numbers.get("mismatch") else numbers["ratio"]
            # no part of zero
            ratio = 1.0 if ratio is None else ratio
            if numbers.get("norm", 1.0) < ZERO and numbers.get("difference", 1.0) < ZERO:
                ratio = 0.0
            blocks.compared += 1
            if ratio > blocks.largest:
                blocks.largest = ratio
                blocks.worst = name if at is None else f"{name} at {at:g}"
        if outcome != "not in the reference" and at is not None and at >= last.get(name, (at,))[0]:
            last[name] = (at, outcome)
    blocks.lacking = [name for name, (_, outcome) in last.items() if outcome != "compared"]
    return blocks


def holds_something(path):
    try:
        return bool(pathlib.Path(path).read_text(encoding="ascii", errors="replace").strip())
    except OSError:
        return False


class Programs:
    """Both programs, and the folders in which they run."""

    def __init__(self, ccx, signorini, folder, timeout):
        self.ccx, self.signorini, self.timeout = ccx, signorini, timeout
        self.theirs, self.ours = os.path.join(folder, "theirs"), os.path.join(folder, "ours")

    def provide(self, deck):
        """Results of ccx that a submodel needs, in both folders."""
        text = pathlib.Path(self.theirs, f"{deck}.inp").read_text(encoding="utf-8", errors="replace")
        for name in set(GLOBAL.findall(text)):
            results = os.path.join(self.theirs, name)
            if not os.path.exists(results) and name.endswith(".frd"):
                run([self.ccx, "-i", name.removesuffix(".frd")], self.theirs, self.timeout)
            if os.path.exists(results):
                shutil.copyfile(results, os.path.join(self.ours, name))

    def compare(self, deck, contact):
        """Runs a deck through both."""
        self.provide(deck)
        code, said, ours = run(
            [self.signorini, "run", f"{deck}.inp", "--compat", "ccx", "--format", "frd", "--threads", "1", "--json"],
            self.ours,
            self.timeout,
        )
        results = os.path.join(self.ours, f"{deck}.out")
        outcome = Outcome(deck, contact, "", seconds=(ours, 0.0))
        if code == REFUSED:
            outcome.status, outcome.reason = "refused", first_error(said)
            return outcome
        theirs_code, _, theirs = run([self.ccx, "-i", deck], self.theirs, self.timeout)
        outcome.seconds = (ours, theirs)
        outcome.iterations = (iterations_of_ours(results), iterations_of_ccx(self.theirs, deck))
        if code != 0:
            outcome.status = "fails"
            outcome.reason = "out of time" if code is None else first_error(said) or f"exit code {code}"
        elif theirs_code != 0:
            outcome.status = "no reference"
            outcome.reason = "ccx: out of time" if theirs_code is None else f"ccx: exit code {theirs_code}"
        else:
            self.judge(outcome, results, deck)
            if outcome.status == "no reference":
                self.ask(outcome, results)
            if outcome.status == "differs":
                self.once_more(outcome, results)
        shutil.rmtree(results, ignore_errors=True)
        return outcome

    def again(self, job, deck, change):
        """Runs a deck, changed, as another job of ccx; says whether that ended well."""
        text = pathlib.Path(self.theirs, f"{deck}.inp").read_text(encoding="utf-8", errors="replace")
        pathlib.Path(self.theirs, f"{job}.inp").write_text(change(text), encoding="utf-8")
        code, _, _ = run([self.ccx, "-i", job], self.theirs, self.timeout)
        return code == 0

    def ask(self, outcome, results):
        """Compares with what ccx writes when it is asked for displacements and stresses."""
        job = f"{outcome.deck}-asked"
        if self.again(job, outcome.deck, asked):
            outcome.asked = True
            self.judge(outcome, results, job)

    def once_more(self, outcome, results):
        """Compares with ccx iterating to the end."""
        job = f"{outcome.deck}-converged"
        second = Outcome(outcome.deck, outcome.has_contact, "", asked=outcome.asked)
        if self.again(job, outcome.deck, lambda text: converged(asked(text) if outcome.asked else text)):
            self.judge(second, results, job)
        if second.status == "agrees":
            outcome.status = "converged"
            outcome.reason = f"{second.largest:.1e} where ccx iterates to the end"

    def judge(self, outcome, results, job):
        """Compares results with those of a job of ccx."""
        kind, names = "dat", None
        if outcome.asked or not holds_something(os.path.join(self.theirs, f"{job}.dat")):
            kind, names = "frd", IN_FRD
        mine, their = os.path.join(results, f"{outcome.deck}.{kind}"), os.path.join(self.theirs, f"{job}.{kind}")
        if kind == "dat" and not os.path.exists(mine):
            outcome.status, outcome.reason = "differs", "signorini prints no table"
            return
        _, said, _ = run([self.signorini, "diff", mine, their, "--common", "--json"], self.ours, self.timeout)
        blocks = judge(said, names)
        if blocks.compared == 0 and not blocks.lacking:
            outcome.status, outcome.reason = "no reference", "ccx: nothing to compare"
            return
        outcome.largest = blocks.largest
        if blocks.lacking:
            outcome.status, outcome.reason = "differs", f"only ccx prints {blocks.lacking[0]}"
        elif blocks.largest > TOLERANCE:
            outcome.status, outcome.reason = "differs", blocks.worst
        else:
            outcome.status, outcome.reason = "agrees", ""
        if outcome.asked:
            outcome.reason = ": ".join(["asked", outcome.reason]).removesuffix(": ")


def shown(value, form):
    return "" if value is None else format(value, form)


def cells(outcome):
    both = [shown(count, "d") for count in outcome.iterations]
    seconds = [shown(value or None, ".1f") for value in outcome.seconds]
    return [outcome.deck, outcome.status, shown(outcome.largest, ".1e"), *both, *seconds, outcome.reason]


HEADINGS = ["deck", "", "difference", "iterations", "of ccx", "seconds", "of ccx", "why"]


def in_columns(row):
    widths = [24, 12, 10, 10, 7, 8, 7]
    return " ".join(f"{text:<{width}}" for text, width in zip(row, widths)) + " " + row[-1]


PAGE = """# Decks next to CalculiX

Written by `python scripts/compare_ccx.py --markdown`: decks whose steps are all static, through CalculiX and through
signorini with `--compat ccx`. See [decks.md](decks.md) for what the words mean.

"""


def page(outcomes):
    """All outcomes as a page: counts, reasons, a table."""
    return PAGE + "".join(f"* {line.strip()}\n" for line in counts(outcomes)) + "\n" + table(outcomes)


def table(outcomes):
    rows = [HEADINGS, ["---"] * len(HEADINGS), *(cells(outcome) for outcome in outcomes)]
    return "".join("| " + " | ".join(text.replace("|", "\\|").replace("`", '"') for text in row) + " |\n" for row in rows)


def agreeing(outcomes):
    return sum(outcome.status == "agrees" for outcome in outcomes)


def counts(outcomes, called="static"):
    """The counts in words, and the reasons, most frequent first."""
    contact = [outcome for outcome in outcomes if outcome.has_contact]
    lines = []
    for name, some in ((f"{called} decks", outcomes), (f"{called} decks with contact", contact)):
        text = f"{agreeing(some)} of {len(some)} {name} agree"
        more = sum(outcome.status == "converged" for outcome in some)
        lines.append(f"{text}, {more} more where ccx iterates to the end")
    by_status = collections.Counter(outcome.status for outcome in outcomes)
    lines.append(", ".join(f"{number} {status}" for status, number in by_status.most_common()))
    refused = [outcome for outcome in outcomes if outcome.status == "refused"]
    reasons = collections.defaultdict(list)
    for outcome in refused:
        reasons[feature(outcome.reason)].append(outcome.deck)
    for reason, decks in sorted(reasons.items(), key=lambda item: (-len(item[1]), item[0])):
        lines.append(f"{len(decks):4} {reason}: {', '.join(decks)}")
    return lines


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("decks", nargs="?", default=DEBIAN, help=f"folder of decks, {DEBIAN} without it")
    parser.add_argument("--ccx", default="ccx", help="the command of CalculiX")
    parser.add_argument("--signorini", default="target/release/signorini", help="the command of signorini")
    parser.add_argument("--contact", action="store_true", help="only decks with contact")
    parser.add_argument("--heat", action="store_true", help="decks that solve for temperatures instead")
    parser.add_argument("--only", nargs="+", metavar="DECK", help="only these, by name")
    parser.add_argument("--timeout", type=float, default=60.0, help="seconds for one deck in one program")
    parser.add_argument("--least-contact", type=int, default=0, metavar="N", help="so many with contact must agree")
    parser.add_argument("--least", type=int, default=0, metavar="N", help="so many of all must agree")
    parser.add_argument("--markdown", metavar="FILE", help="write a page")
    return parser.parse_args()


def main():
    args = arguments()
    programs = [shutil.which(name) for name in (args.ccx, args.signorini)]
    for name, found in zip((args.ccx, args.signorini), programs):
        if found is None:
            print(f"error: there is no program {name}", file=sys.stderr)
            return 2
    if not os.path.isdir(args.decks):
        print(f"error: there is no folder {args.decks}", file=sys.stderr)
        return 2
    ccx, signorini = map(os.path.abspath, programs)
    outcomes = []
    with tempfile.TemporaryDirectory() as folder:
        both = Programs(ccx, signorini, folder, args.timeout)
        for target in (both.theirs, both.ours):
            unpack(args.decks, target)
        print(in_columns(HEADINGS))
        for deck, contact in chosen(both.ours, args.contact, args.heat):
            if args.only and deck not in args.only:
                continue
            outcomes.append(both.compare(deck, contact))
            print(in_columns(cells(outcomes[-1])), flush=True)
    print()
    print("\n".join(counts(outcomes, "heat" if args.heat else "static")))
    if args.markdown:
        pathlib.Path(args.markdown).write_text(page(outcomes), encoding="utf-8")
    asked = [
        ("", outcomes, args.least),
        ("contact", [outcome for outcome in outcomes if outcome.has_contact], args.least_contact),
    ]
    missed = [(name, least) for name, some, least in asked if agreeing(some) < least]
    for name, least in missed:
        print(" ".join(f"fewer than {least} {name} decks agree".split()))
    print(f"compare_ccx: {agreeing(outcomes)} passed, {len(outcomes) - agreeing(outcomes)} did not")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
