#!/usr/bin/env python3
"""Count the iterations that CalculiX takes for the decks of a folder.

    python scripts/ccx_iterations.py DECKS [--ccx CCX]

Runs every .inp of the folder through ccx, each in a temporary folder and with one thread, and writes
crates/signorini-cli/tests/decks/ccx_iterations.txt: the version of ccx, and a line with name and count for each deck, the sum
over the column ITRS of its .sta file. The test of the decks puts them beside ours into the table of docs/decks.md.

Only what comes with Python is used. Exit code: 0; 1 where ccx did not solve a deck; 2 wrong command line.
"""

import argparse
import os
import pathlib
import shutil
import sys
import tempfile

from jobs import iterations_of_ccx, run, version

TABLE = pathlib.Path(__file__).resolve().parent.parent / "crates/signorini-cli/tests/decks/ccx_iterations.txt"
HEAD = "# Iterations of CalculiX {version} for the decks of its suite, by scripts/ccx_iterations.py.\n"


def count(ccx, deck, folder):
    """Iterations of one deck; none where ccx does not solve it."""
    code, _, _ = run([ccx, "-i", deck.stem], folder, 600.0)
    return iterations_of_ccx(folder, deck.stem) if code == 0 else None


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("decks", type=pathlib.Path, help="a folder with decks")
    parser.add_argument("--ccx", default="ccx", help="the command of CalculiX")
    args = parser.parse_args()
    decks = sorted(args.decks.glob("*.inp"))
    ccx = shutil.which(args.ccx)
    if ccx is None or not decks:
        print(f"error: {'there is no program ' + args.ccx if ccx is None else 'no decks there'}", file=sys.stderr)
        return 2
    ccx = os.path.abspath(ccx)
    lines, failed = [], []
    for deck in decks:
        with tempfile.TemporaryDirectory() as folder:
            shutil.copyfile(deck, os.path.join(folder, deck.name))
            found = count(ccx, deck, folder)
        print(f"{deck.stem} {found}", flush=True)
        if found is None:
            failed.append(deck.stem)
        else:
            lines.append(f"{deck.stem} {found}\n")
    if failed:
        print(f"not solved: {', '.join(failed)}", file=sys.stderr)
        return 1
    TABLE.write_text(HEAD.format(version=version(ccx)) + "".join(lines), encoding="ascii")
    return 0


if __name__ == "__main__":
    sys.exit(main())
