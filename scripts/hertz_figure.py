#!/usr/bin/env python3
"""Draw the examples of Hertz: von Mises stress under the contact, and the pressure beside Hertz's.

    python scripts/hertz_figure.py SPHERE.out CYLINDER.out [-o docs/figures/hertz.png]

Each folder holds the results of a run of examples/hertz_sphere_3d and examples/hertz_cylinder_2d; the last frame is
drawn. The exact pressure is p0 sqrt(1 - (r/a)^2) with p0 and a at the force that the run measured (Johnson 1985, (4.24)
to (4.25) and (4.45) to (4.46)); the largest pressure has to be within 3 % of p0.

Needs: numpy, pyvista, matplotlib. Exit code: 0 drawn, 1 the pressure is off, 2 wrong command line or unreadable results.
"""

import argparse
import sys
import xml.etree.ElementTree as tree
from pathlib import Path

import numpy as np

RADIUS = 10.0
MODULUS = 1000.0 / (1.0 - 0.3**2) / 2.0
TOLERANCE = 0.03
VIEW = 3.0  # radii of contact shown to each side


def last_frame(folder, collection):
    """The last data set that a .pvd names."""
    import pyvista

    entries = tree.parse(folder / collection).iter("DataSet")
    return pyvista.read(folder / list(entries)[-1].get("file"))


def hertz(force, spatial):
    """The largest pressure and the radius of a ball (spatial), or of a cylinder of unit length, pressed by a force."""
    if spatial:
        p0 = (6 * force * MODULUS**2 / (np.pi**3 * RADIUS**2)) ** (1 / 3)
        return p0, (3 * force * RADIUS / (4 * MODULUS)) ** (1 / 3)
    return np.sqrt(force * MODULUS / (np.pi * RADIUS)), np.sqrt(4 * force * RADIUS / (np.pi * MODULUS))


class Case:
    """One example: its pressure, Hertz's, and a section through the stress."""

    def __init__(self, folder, spatial):
        contact = last_frame(folder, "contact.pvd")
        self.spatial = spatial
        self.axis = 2 if spatial else 1
        force = abs(contact["contact_force"][:, self.axis].sum()) * (4 if spatial else 2)
        self.p0, self.a = hertz(force, spatial)
        at = contact.points  # a linear step knows no other places
        self.r = np.hypot(at[:, 0], at[:, 1]) if spatial else at[:, 0]
        self.pressure = contact["contact_pressure"]
        self.ratio = self.pressure.max() / self.p0
        self.section = self.cut(last_frame(folder, "results.pvd"))

    def cut(self, grid):
        """Quadrilaterals in the plane y = 0 (in the plane: all): corners, and the stress at them."""
        at = grid.points + grid["displacement"]
        stress = grid.point_data["von_mises"]
        cells = grid.cells_dict
        if self.spatial:
            sides = [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
            faces = np.concatenate([cells[12][:, side] for side in sides])
            faces = faces[(np.abs(grid.points[faces][:, :, 1]) < 1e-9).all(axis=1)]
        else:
            faces = cells[9]
        return at[:, [0, self.axis]], faces, stress


def draw(cases, target):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.tri import Triangulation

    figure, panels = plt.subplots(2, 2, figsize=(11, 7.6), dpi=110, width_ratios=[1.25, 1])
    names = ["ball on block", "cylinder on block"]
    for row, (case, name) in enumerate(zip(cases, names)):
        at, faces, stress = case.section
        triangles = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
        panel = panels[row][0]
        for side in (1, -1):
            mesh = Triangulation(side * at[:, 0] / case.a, at[:, 1] / case.a, triangles)
            levels = np.linspace(0, 0.65, 27)
            picture = panel.tricontourf(mesh, stress / case.p0, levels, cmap="viridis", extend="max")
            for face in faces:
                loop = at[np.append(face, face[0])] / case.a
                if np.abs(loop).max() < 2 * VIEW:
                    panel.plot(side * loop[:, 0], loop[:, 1], color="white", linewidth=0.25)
        panel.set(xlim=(-VIEW, VIEW), ylim=(-0.7 * VIEW, 0.7 * VIEW), aspect="equal", xlabel="x / a", ylabel="height / a")
        panel.set_title(f"{name}: von Mises stress / p0")
        figure.colorbar(picture, ax=panel, shrink=0.85)

        panel = panels[row][1]
        r = np.linspace(0, 1, 200)
        panel.plot(r, np.sqrt(1 - r**2), color="black", label="Hertz")
        panel.plot(case.r / case.a, case.pressure / case.p0, "o", markersize=4, color="tab:red", label="Signorini, nodes")
        panel.set(xlim=(0, 1.6), ylim=(0, 1.1), xlabel="r / a", ylabel="pressure / p0")
        panel.set_title(f"p0 = {case.p0:.2f} MPa, largest pressure {100 * (case.ratio - 1):+.1f} %")
        panel.legend()
    figure.tight_layout()
    figure.savefig(target)


def main():
    parser = argparse.ArgumentParser(description="Draw the examples of Hertz.")
    parser.add_argument("sphere", type=Path, help="results of examples/hertz_sphere_3d")
    parser.add_argument("cylinder", type=Path, help="results of examples/hertz_cylinder_2d")
    parser.add_argument("-o", "--output", type=Path, default=Path("docs/figures/hertz.png"))
    arguments = parser.parse_args()
    try:
        cases = [Case(arguments.sphere, True), Case(arguments.cylinder, False)]
    except (OSError, KeyError, IndexError, tree.ParseError) as error:
        print(f"error: the results cannot be read: {error}", file=sys.stderr)
        return 2
    draw(cases, arguments.output)
    good = [abs(case.ratio - 1) < TOLERANCE for case in cases]
    for case, ok in zip(cases, good):
        print(f"hertz: {int(ok)} passed, largest pressure / p0 = {case.ratio:.4f}")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
