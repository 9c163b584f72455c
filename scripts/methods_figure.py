#!/usr/bin/env python3
"""Draw the pressure of Hertz on coarse meshes that do not match, by mortar and by node to segment.

    python scripts/methods_figure.py MORTAR.out NODE_TO_SEGMENT.out [-o docs/figures/hertz_methods.png]

The folders hold the results of runs of examples/hertz_cylinder_2d_mortar and examples/hertz_cylinder_2d_node_to_segment;
the last frames are drawn. The exact pressure is p0 sqrt(1 - (r/a)^2) with p0 and a at the force of each run (Johnson 1985,
(4.45) to (4.46)), at the places that the nodes have at the start, as a linear step has it. What is judged is the root
mean square of the error at the nodes that touch or should, as a part of p0: by mortar it has to be within 2 %, and less
than by node to segment.

Needs: numpy, pyvista, matplotlib. Exit code: 0 drawn, 1 a pressure is off, 2 wrong command line or unreadable results.
"""

import argparse
import sys
import xml.etree.ElementTree as tree
from pathlib import Path

import numpy as np

from hertz_figure import hertz, last_frame

TOLERANCE = 0.02


class Line:
    """The contact at the end of a run beside Hertz's: r in parts of a, pressures and errors in parts of p0."""

    def __init__(self, folder):
        contact = last_frame(folder, "contact.pvd")
        force = 2 * abs(contact["contact_force"][:, 1].sum())
        p0, a = hertz(force, spatial=False)
        order = np.argsort(contact.points[:, 0])
        self.r = contact.points[order, 0] / a
        self.pressure = contact["contact_pressure"][order] / p0
        error = self.pressure - np.sqrt(np.maximum(1 - self.r**2, 0))
        self.middle = error[0]
        self.rms = np.sqrt((error[(self.r < 1) | (self.pressure > 0)] ** 2).mean())


def draw(lines, target):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, panel = plt.subplots(figsize=(7.5, 4.2), dpi=110)
    r = np.linspace(0, 1, 400)
    panel.plot(r, np.sqrt(1 - r**2), color="black", label="Hertz")
    for (name, line), face in zip(lines.items(), ["tab:blue", "none"]):
        label = f"{name}: middle {100 * line.middle:+.1f} %, rms {100 * line.rms:.1f} %"
        panel.plot(line.r, line.pressure, "o", markersize=7, markerfacecolor=face, markeredgewidth=1.5, label=label)
    panel.set(xlim=(-0.03, 1.3), ylim=(0, 1.1), xlabel="r / a", ylabel="pressure / p0")
    panel.legend(loc="lower left")
    figure.tight_layout()
    figure.savefig(target)


def main():
    parser = argparse.ArgumentParser(description="Draw the pressure of Hertz by two methods.")
    parser.add_argument("mortar", type=Path, help="results of examples/hertz_cylinder_2d_mortar")
    parser.add_argument("segment", type=Path, help="results of examples/hertz_cylinder_2d_node_to_segment")
    parser.add_argument("-o", "--output", type=Path, default=Path("docs/figures/hertz_methods.png"))
    arguments = parser.parse_args()
    try:
        lines = {"mortar": Line(arguments.mortar), "node to segment": Line(arguments.segment)}
    except (OSError, KeyError, IndexError, tree.ParseError) as error:
        print(f"error: the results cannot be read: {error}", file=sys.stderr)
        return 2
    draw(lines, arguments.output)
    mortar, segment = (line.rms for line in lines.values())
    good = [mortar <= TOLERANCE, mortar < segment]
    print(f"methods: {sum(good)} passed, rms of the error: mortar {mortar:.4f}, node to segment {segment:.4f}")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
