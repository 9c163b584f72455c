#!/usr/bin/env python3
"""Draw the forces of the example of shallow ironing over time, from runs on one or more meshes.

    python scripts/ironing_figure.py RESULTS.out [NAME=OTHER.out ...] [-o docs/figures/ironing.png]

Each folder holds the results of a run of examples/ironing_2d_gauss_point; a name before it becomes part of the legend.
The indenter is pressed down until time 1 and slid until time 2.

Needs: numpy, matplotlib. Exit code: 0 drawn, 2 wrong command line or unreadable results.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np

MU = 0.3


def forces(folder):
    """Times, drag and press: what the indenter is moved with, from nothing at time zero."""
    with open(Path(folder) / "history.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    column = lambda name: np.array([0.0] + [float(row[name]) for row in rows])  # noqa: E731
    return column("time"), -column("iron.force_x"), column("iron.force_y")


def draw(runs, target):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (force, ratio) = plt.subplots(1, 2, figsize=(11, 4.2), dpi=110, width_ratios=[1.4, 1])
    for number, (name, (time, fx, fy)) in enumerate(runs.items()):
        style = {"color": f"C{number}", "linewidth": 1.3}
        force.plot(time, fy / 1e8, label=f"$F_y$, {name}", **style)
        force.plot(time, fx / 1e8, linestyle="--", label=f"$F_x$, {name}", **style)
        slides = (time > 1.0) & (fy > 0.0)
        ratio.plot(time[slides], fx[slides] / fy[slides], label=name, **style)
    force.set(xlabel="time: pressed until 1, slid until 2", ylabel="force / (1e8 N/mm)", xlim=(0, 2), ylim=(0, None))
    force.legend()
    ratio.axhline(MU, color="black", linewidth=0.8, label="coefficient of friction")
    ratio.set(xlabel="time", ylabel="$F_x / F_y$", xlim=(1, 2), ylim=(0, 0.5))
    ratio.legend(loc="lower center")
    figure.tight_layout()
    figure.savefig(target)


def main():
    parser = argparse.ArgumentParser(description="Draw the forces of the example of shallow ironing.")
    parser.add_argument("results", nargs="+", metavar="[NAME=]RESULTS", help="results of examples/ironing_2d_gauss_point")
    parser.add_argument("-o", "--output", type=Path, default=Path("docs/figures/ironing.png"))
    arguments = parser.parse_args()
    runs = {}
    try:
        for entry in arguments.results:
            name, _, folder = entry.rpartition("=")
            runs[name or Path(folder).name] = forces(folder)
    except (OSError, KeyError, ValueError) as error:
        print(f"error: the results cannot be read: {error}", file=sys.stderr)
        return 2
    draw(runs, arguments.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
