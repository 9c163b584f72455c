#!/usr/bin/env python3
"""Draw the seconds over the unknowns that docs/speed.md has in its table, of one increment of hertz with C3D8.

    python scripts/speed_figure.py [docs/speed.md] [-o docs/figures/speed.png]

The exponent of each program is the slope of a straight line through the logarithms.

Needs: matplotlib, numpy. Exit code: 0 drawn, 2 wrong command line or unreadable page.
"""

import argparse
import itertools
import sys
from pathlib import Path

import numpy as np

KIND = "hertz-C3D8-"
# columns of the table
NAME, UNKNOWNS, CCX, OURS = 0, 1, 4, 5


def read(page):
    """Unknowns and seconds of both programs, an array each, from the first table of the page that has them."""
    lines = [line.strip("| \n").split("|") for line in page.splitlines() if line.startswith("|")]
    lines = [[cell.strip() for cell in line] for line in lines]
    heads = [number for number, line in enumerate(lines) if len(line) > OURS and line[UNKNOWNS] == "unknowns"]
    tables = [rows_below(lines, head) for head in heads]
    rows = next(rows for rows in tables if rows)

    def of(column):
        pairs = [(float(row[UNKNOWNS]), float(row[column])) for row in rows if row[column][0].isdigit()]
        return np.array(sorted(pairs)).reshape(-1, 2)

    return {"CalculiX": of(CCX), "signorini": of(OURS)}


def rows_below(lines, head):
    """The rows of hertz in one increment of the table with this heading."""
    same = itertools.takewhile(lambda line: len(line) == len(lines[head]), lines[head + 2 :])
    return [row for row in same if row[NAME].startswith(KIND) and row[NAME].endswith("-once")]


def exponent(points):
    """The slope of the logarithms of seconds over those of unknowns."""
    return np.polyfit(np.log(points[:, 0]), np.log(points[:, 1]), 1)[0]


def draw(programs, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(5.5, 4), layout="constrained")
    for (name, points), style in zip(programs.items(), ["s-", "o-"]):
        if len(points) > 1:
            label = f"{name}, $n^{{{exponent(points):.2f}}}$"
            axes.loglog(points[:, 0], points[:, 1], style, label=label)
    axes.set(xlabel="unknowns $n$", ylabel="seconds of the whole process")
    axes.grid(True, which="both", linewidth=0.3)
    axes.legend()
    figure.savefig(path, dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("page", nargs="?", type=Path, default="docs/speed.md")
    parser.add_argument("-o", "--output", type=Path, default="docs/figures/speed.png")
    args = parser.parse_args()
    try:
        programs = read(args.page.read_text(encoding="utf-8"))
    except (OSError, StopIteration, ValueError, IndexError) as error:
        print(f"{args.page}: {error or 'no table of rows and unknowns'}", file=sys.stderr)
        return 2
    draw(programs, args.output)
    for name, points in programs.items():
        told = f"n^{exponent(points):.2f}" if len(points) > 1 else "too few rows"
        print(f"{name}: {len(points)} rows, {told}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
