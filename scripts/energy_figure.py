#!/usr/bin/env python3
"""Draw where the energy of a motion is over time, from the history of a run.

    python scripts/energy_figure.py RESULTS.out [-o docs/figures/bouncing_bar.png]

The results are those of any run with dynamic steps, such as examples/bouncing_bar_2d. The energies that bodies and contacts have
are stacked, on what friction, damping and the method have taken; their sum is the work of supports and loads, and the energy at the
start. Increments of other steps, which have no energies, are left out.

Needs: numpy, matplotlib. Exit code: 0 drawn, 2 wrong command line or unreadable results.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np

STACKED = ("internal", "kinetic", "contact", "friction", "damping", "algorithmic")


def energies(folder):
    """Times, and the energies by name, of the increments that have some."""
    with open(Path(folder) / "history.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    names = (*STACKED, "external")
    table = np.array([[float(row[f"energy.{name}"]) for name in names] for row in rows])
    moves = np.abs(table).sum(axis=1) > 0.0
    if not moves.any():
        raise ValueError("no increment has an energy")
    time = np.array([float(row["time"]) for row in rows])[moves]
    return time, dict(zip(names, table[moves].T))


def draw(time, energy, target):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    largest = max(np.abs(values).max() for values in energy.values())
    shown = [name for name in STACKED if np.abs(energy[name]).max() > 1e-4 * largest]
    figure, axes = plt.subplots(figsize=(8, 4), dpi=110)
    axes.stackplot(time, [energy[name] for name in shown], labels=shown, alpha=0.8)
    total = sum(energy[name] for name in STACKED)
    axes.plot(time, total, color="black", linewidth=1.0, label="sum")
    axes.set(xlabel="time", ylabel="energy", xlim=(time[0], time[-1]))
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4, frameon=False)
    figure.tight_layout()
    figure.savefig(target)


def main():
    parser = argparse.ArgumentParser(description="Draw where the energy of a motion is over time.")
    parser.add_argument("results", metavar="RESULTS", help="results of a run with dynamic steps")
    parser.add_argument("-o", "--output", type=Path, default=Path("docs/figures/bouncing_bar.png"))
    arguments = parser.parse_args()
    try:
        time, energy = energies(arguments.results)
    except (OSError, KeyError, ValueError) as error:
        print(f"error: the results cannot be read: {error}", file=sys.stderr)
        return 2
    draw(time, energy, arguments.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
