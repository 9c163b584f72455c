#!/usr/bin/env python3
"""Run a folder of OOFEM decks and tell what became of each.

    python scripts/run_oofem.py FOLDER [--signorini PROGRAM] [--markdown FILE]

Every .in below FOLDER is run in a temporary folder. A line for each: `passed`, where all its checks hold; `solved`,
where it has none; `differs`, with how many of its checks hold and the worst; `refused`, with the first reason; `fails`,
where it was not solved. Then the counts of decks that were parsed, run, and passed their checks, and the reasons of
refusals by how often they occur.

Only what comes with Python is used. Exit code: 0; 1 where a check or a run failed; 2 wrong command line or no deck.
"""

import argparse
import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile

# exit codes of signorini: solved, a check failed, refused as input or as model
SOLVED, DIFFERS, REFUSED = 0, 1, (3, 4)
PASSED = "passed"


def first_error(said):
    """The first error in what the program said, without its code."""
    for line in said.splitlines():
        found = re.match(r"error\[S\d+\]: (.*)", line.strip())
        if found:
            return found.group(1)
    lines = said.strip().splitlines()
    return lines[-1] if lines else "no reason was given"


def judged(folder):
    """How many checks there are and hold, and the worst one that does not."""
    summary = json.loads((folder / "summary.json").read_text())
    checks = summary.get("expectations", [])
    failed = [one for one in checks if not one["ok"]]
    size = lambda one: abs((one["got"] or 0.0) - one["value"])
    return len(checks), len(checks) - len(failed), max(failed, key=size, default=None)


def run(deck, program):
    """What became of a deck, and a remark."""
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(scratch) / "out"
        command = [program, "run", str(deck), "-o", str(out), "-q", "-j", "1"]
        done = subprocess.run(command, capture_output=True, text=True, errors="replace")
        if done.returncode in REFUSED:
            return "refused", first_error(done.stderr)
        if done.returncode not in (SOLVED, DIFFERS):
            return "fails", first_error(done.stderr)
        count, good, worst = judged(out)
        if worst is None:
            return (PASSED, f"{count} checks") if count else ("solved", "no checks")
        remark = f"{good} of {count} checks; {worst['what']} is {worst['got']}, not {worst['value']}"
        return "differs", remark


def reason(remark):
    """A reason without names and numbers of one deck, to be counted."""
    return re.sub(r"\d+", "N", remark)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--signorini", default="signorini")
    parser.add_argument("--markdown", type=pathlib.Path)
    options = parser.parse_args()
    decks = sorted(options.folder.rglob("*.in"))
    if not decks:
        print(f"no decks, .in, below {options.folder}", file=sys.stderr)
        return 2
    rows = []
    for deck in decks:
        try:
            state, remark = run(deck, options.signorini)
        except FileNotFoundError:
            print(f"there is no program {options.signorini}", file=sys.stderr)
            return 2
        rows.append((str(deck.relative_to(options.folder)), state, remark))
        print(f"{rows[-1][0]:<50} {state:<8} {remark}")
    count = collections.Counter(state for _, state, _ in rows)
    parsed = len(rows) - count["refused"]
    ran = parsed - count["fails"]
    print(f"\n{len(rows)} decks: {parsed} parsed, {ran} run, {count[PASSED]} passed their checks")
    reasons = collections.Counter(reason(remark) for _, state, remark in rows if state == "refused")
    for text, times in reasons.most_common():
        print(f"{times:>5} x {text}")
    if options.markdown:
        lines = ["| deck | | |", "|---|---|---|"]
        lines += [f"| {deck} | {state} | {remark} |" for deck, state, remark in rows]
        options.markdown.write_text("\n".join(lines) + "\n")
    return 1 if count["differs"] or count["fails"] else 0


if __name__ == "__main__":
    sys.exit(main())
