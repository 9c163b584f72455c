#!/usr/bin/env python3
"""Draw pressure and shear of the example of Cattaneo and Mindlin beside theory.

    python scripts/mindlin_figure.py RESULTS.out [-o docs/figures/cattaneo_mindlin.png]

The folder holds the results of a run of examples/cattaneo_mindlin_2d_node_to_segment; the last frame is drawn. Theory
(Johnson 1985, (4.45) and (7.28) to (7.30)) is p = p0 sqrt(1 - (x/a)^2) and q = mu p - mu p0 (c/a) sqrt(1 - (x/c)^2), the
latter where |x| < c = a sqrt(1 - Q/(mu P)). x is measured from the middle of the pressure, which the shear moves. Half of
the length that sticks has to be within one element of c.

Needs: numpy, pyvista, matplotlib. Exit code: 0 drawn, 1 it is not, 2 wrong command line or unreadable results.
"""

import argparse
import sys
import xml.etree.ElementTree as tree
from pathlib import Path

import numpy as np

RADIUS, MU = 8.0, 0.3
MODULUS = 200.0 / (1.0 - 0.3**2) / 2.0
STICK, SLIP = 1, 2


class Line:
    """The contact at the end of a run, its nodes from left to right, and theory at the forces that the run has."""

    def __init__(self, folder):
        import pyvista

        entries = list(tree.parse(folder / "contact.pvd").iter("DataSet"))
        contact = pyvista.read(folder / entries[-1].get("file"))
        at = contact.points + contact["displacement"]
        order = np.argsort(at[:, 0])
        self.x = at[order, 0]
        self.p = contact["contact_pressure"][order]
        self.q = contact["contact_shear"][order]
        self.status = contact["contact_status"][order]
        area = contact["contact_area"][order]
        shear, force = np.abs(contact["contact_force"][:, :2].sum(axis=0))
        self.x = self.x - (self.x * self.p * area).sum() / (self.p * area).sum()
        self.a = np.sqrt(2 * force * RADIUS / (np.pi * MODULUS))
        self.p0 = 2 * force / (np.pi * self.a)
        self.c = self.a * np.sqrt(1 - shear / (MU * force))
        self.stick = area[self.status == STICK].sum() / 2
        self.h = area[self.status == STICK].mean()
        expected = self.theory(self.x)[1]
        self.error = np.sqrt((area * (self.q - expected) ** 2).sum() / (area * expected**2).sum())

    def theory(self, x):
        """Pressure and shear."""
        ellipse = lambda half: np.sqrt(np.maximum(1 - (x / half) ** 2, 0))  # noqa: E731
        pressure = self.p0 * ellipse(self.a)
        return pressure, MU * (pressure - self.p0 * self.c / self.a * ellipse(self.c))


def draw(line, target):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (both, shear) = plt.subplots(1, 2, figsize=(11, 4.2), dpi=110)
    x = np.linspace(-line.a, line.a, 801)
    p, q = line.theory(x)
    sticks, slips = line.status == STICK, line.status == SLIP
    both.plot(x / line.a, p / line.p0, color="black", label="theory")
    both.plot(x / line.a, q / (MU * line.p0), color="black", linestyle="--")
    both.plot(line.x / line.a, line.p / line.p0, "o", markersize=4, color="tab:blue", label="pressure, nodes: $p / p_0$")
    both.plot(line.x / line.a, line.q / (MU * line.p0), "o", markersize=4, color="tab:red", label=r"shear, nodes: $q / \mu p_0$")
    both.set(xlim=(-1.2, 1.2), ylim=(0, 1.1), xlabel="x / a")
    both.legend(loc="center", fontsize=8)
    shear.plot(x / line.a, q / (MU * line.p0), color="black", label="theory")
    shear.plot(x / line.a, p / line.p0, color="grey", linestyle=":", label=r"what friction can bear, $\mu p$")
    for where, marker, name in [(sticks, "o", "sticks"), (slips, "^", "slips")]:
        shear.plot(line.x[where] / line.a, line.q[where] / (MU * line.p0), marker, markersize=5, label=name)
    for edge in (-line.c, line.c):
        shear.axvline(edge / line.a, color="black", linewidth=0.6)
    shear.set(xlim=(-1.2, 1.2), ylim=(0, 0.75), xlabel="x / a", ylabel=r"$q / \mu p_0$")
    shear.set_title(f"sticks over {line.stick:.3f} mm, theory {line.c:.3f} mm: {(line.stick - line.c) / line.h:+.2f} elements", fontsize=10)
    shear.legend(loc="upper center", fontsize=8)
    figure.tight_layout()
    figure.savefig(target)


def main():
    parser = argparse.ArgumentParser(description="Draw the example of Cattaneo and Mindlin.")
    parser.add_argument("results", type=Path, help="results of examples/cattaneo_mindlin_2d_node_to_segment")
    parser.add_argument("-o", "--output", type=Path, default=Path("docs/figures/cattaneo_mindlin.png"))
    arguments = parser.parse_args()
    try:
        line = Line(arguments.results)
    except (OSError, KeyError, IndexError, tree.ParseError) as error:
        print(f"error: the results cannot be read: {error}", file=sys.stderr)
        return 2
    draw(line, arguments.output)
    good = abs(line.stick - line.c) < line.h
    print(
        f"mindlin: {int(good)} passed, sticks over {line.stick:.4f} of {line.c:.4f} mm, element {line.h:.4f} mm, "
        f"shear off by {100 * line.error:.1f} % in L2"
    )
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
