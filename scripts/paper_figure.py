#!/usr/bin/env python3
"""Draw figure 2 of the paper: vertical stress on the deformed wedge and bricks at three increments.

    python scripts/paper_figure.py WEDGE.out SYMMETRIC.out ARBITRARY.out [-o docs/figures/paper_figure_2.png]

Each folder holds the results of a run of the example; its frames are read with PyVista from results.pvd. A row is an
example with a colour range of its own, over its three increments; a column is an increment. The rigid tetrahedron is
drawn transparent, the undeformed body as lines.

Bilinear faces are curved once deformed. Viewers draw them as two flat triangles each, so that the tip seems to miss
them; here every face is cut into small pieces by its own shape functions, displacement and stress included.

Panels are rendered by VTK off screen, under Xvfb where there is no display and Xvfb is installed. Where VTK cannot
render, Matplotlib draws the same pieces (--renderer matplotlib asks for that at once).

Needs: numpy, pyvista, matplotlib. Exit code: 0 drawn, 2 wrong command line or unreadable results.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile

import numpy as np

TITLES = [
    "A  wedge\ncontact at (1/3, 1/3)",
    "B  brick\ncontact at (0.5, 0.25)",
    "C  brick\ncontact at (0.3, 0.2)",
]
INCREMENTS = [0, 40, 60]
VERTICAL = "ZZ"
TENSOR = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]
COLOURS = "viridis"
PANEL = (760, 760)
PIECES = 24
EYE = np.array([-1.45, -2.3, 1.75])

# sides and edges of VTK's cells, normals pointing out
SIDES = {
    10: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
    12: [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
    13: [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]],
}
TETRA = 10


class Unreadable(Exception):
    pass


# ---- from results to pieces ------------------------------------------------------------------------------------


class Panel:
    """What one panel shows: small triangles with their stress, lines, the tool."""

    def __init__(self, grid):
        points = np.array(grid.points, dtype=float)
        moved = points + np.array(grid.point_data["displacement"])
        stress = vertical_stress(grid)
        offsets = pyvista_offsets(grid)
        cells = list(zip(grid.celltypes, np.split(grid.cell_connectivity, offsets[1:-1])))
        # the tool is the one tetrahedron beside bricks and wedges
        solids = [(t, c) for t, c in cells if t != TETRA]
        tools = [(t, c) for t, c in cells if t == TETRA]
        self.triangles, self.values = patches(outer_sides(solids), moved, stress)
        self.edges = outlines(outer_sides(solids), moved)
        still = np.array_equal(moved, points)
        self.before = outlines([] if still else outer_sides(solids), points)
        self.tool, _ = patches(outer_sides(tools), moved, stress, 1)
        self.tool_edges = outlines(outer_sides(tools), moved)
        used = np.unique(np.concatenate([c for _, c in solids]))
        self.range = (stress[used].min(), stress[used].max())


def pyvista_offsets(grid):
    """Where the nodes of every cell start; the name of the property changed in PyVista 0.49."""
    return grid.cell_offsets if hasattr(grid, "cell_offsets") else grid.offset


def vertical_stress(grid):
    stress = grid.point_data.get("stress")
    if stress is None or stress.ndim != 2 or stress.shape[1] != 6:
        raise Unreadable("a frame has no point array \"stress\" of six components")
    array = grid.GetPointData().GetArray("stress")
    names = [array.GetComponentName(i) for i in range(6)]
    order = names if set(names) == set(TENSOR) else TENSOR
    return np.array(stress[:, order.index(VERTICAL)])


def outer_sides(cells):
    """Sides that belong to one cell only."""
    sides = {}
    for kind, nodes in cells:
        if kind not in SIDES:
            raise Unreadable(f"cells of VTK type {kind} are not drawn")
        for side in SIDES[kind]:
            key = tuple(sorted(nodes[side]))
            sides[key] = None if key in sides else nodes[side]
    return [side for side in sides.values() if side is not None]


def shape(side, a, b):
    """Shape functions of a triangle or quadrilateral at (a, b) in the unit triangle or square."""
    if len(side) == 3:
        return np.stack([1 - a - b, a, b], axis=-1)
    return np.stack([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b], axis=-1)


def patches(sides, x, values, n=PIECES):
    """Every side as small triangles, and the values at their corners."""
    triangles, of_corner = [], []
    for side in sides:
        corners = []
        for i in range(n):
            for j in range(n - i if len(side) == 3 else n):
                corners.append([(i, j), (i + 1, j), (i, j + 1)])
                if len(side) == 4 or i + j < n - 1:
                    corners.append([(i + 1, j), (i + 1, j + 1), (i, j + 1)])
        at = np.array(corners, dtype=float) / n
        weights = shape(side, at[..., 0], at[..., 1])
        triangles.append(weights @ x[side])
        of_corner.append(weights @ values[side])
    if not triangles:
        return np.zeros((0, 3, 3)), np.zeros((0, 3))
    return np.concatenate(triangles), np.concatenate(of_corner)


def outlines(sides, x):
    """The edges of all sides, each once."""
    pairs = {tuple(sorted(p)) for side in sides for p in zip(side, np.roll(side, -1))}
    return np.array([[x[a], x[b]] for a, b in sorted(pairs)]).reshape(-1, 2, 3)


def read_panels(folder, increments):
    import pyvista

    path = os.path.join(folder, "results.pvd")
    if not os.path.isfile(path):
        raise Unreadable(f"{path} does not exist; run the example first")
    reader = pyvista.get_reader(path)
    panels = []
    for increment in increments:
        if increment >= len(reader.time_values):
            raise Unreadable(f"{path} lists {len(reader.time_values)} frames, increment {increment} is not among them")
        reader.set_active_time_value(reader.time_values[increment])
        panels.append(Panel(reader.read()[0]))
    return panels


# ---- from pieces to pictures -----------------------------------------------------------------------------------


def view_of(panels):
    """Middle and size of what all panels of an example show."""
    shown = np.concatenate([np.concatenate([p.triangles, p.tool]).reshape(-1, 3) for p in panels])
    lower, upper = shown.min(axis=0), shown.max(axis=0)
    return 0.5 * (lower + upper), 0.5 * np.linalg.norm(upper - lower)


def render_vtk(panel, limits, view, path):
    import pyvista

    def surface(triangles):
        faces = np.arange(triangles.size // 3).reshape(-1, 3)
        return pyvista.PolyData(triangles.reshape(-1, 3), np.insert(faces, 0, 3, axis=1).ravel())

    def lines(pairs):
        ends = np.arange(2 * len(pairs)).reshape(-1, 2)
        return pyvista.PolyData(pairs.reshape(-1, 3), lines=np.insert(ends, 0, 2, axis=1).ravel())

    plotter = pyvista.Plotter(off_screen=True, window_size=PANEL)
    plotter.set_background("white")
    body = surface(panel.triangles)
    body.point_data["stress"] = panel.values.ravel()
    plotter.add_mesh(body, scalars="stress", clim=limits, cmap=COLOURS, lighting=False, show_scalar_bar=False)
    plotter.add_mesh(lines(panel.edges), color="black", line_width=2.5)
    if len(panel.before):
        plotter.add_mesh(lines(panel.before), color="grey", line_width=1.2)
    if len(panel.tool):
        plotter.add_mesh(surface(panel.tool), color="lightgrey", opacity=0.45, lighting=False)
        plotter.add_mesh(lines(panel.tool_edges), color="dimgrey", line_width=2.0)
    middle, radius = view
    plotter.camera.position = middle + EYE / np.linalg.norm(EYE) * 4.15 * radius
    plotter.camera.focal_point = middle
    plotter.camera.up = (0.0, 0.0, 1.0)
    plotter.camera.view_angle = 28.0
    plotter.reset_camera_clipping_range()
    plotter.screenshot(path)
    plotter.close()


def draw_matplotlib(axes, panel, limits, view):
    from matplotlib import colormaps
    from matplotlib.colors import Normalize
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    colours = colormaps[COLOURS](Normalize(*limits)(panel.values.mean(axis=1)))
    axes.add_collection3d(Poly3DCollection(panel.triangles, facecolors=colours, edgecolors=colours, linewidths=0.2))
    if len(panel.before):
        axes.add_collection3d(Line3DCollection(panel.before, colors="grey", linewidths=0.6))
    axes.add_collection3d(Line3DCollection(panel.edges, colors="black", linewidths=0.9))
    if len(panel.tool):
        axes.add_collection3d(Poly3DCollection(panel.tool, facecolors=(0.8, 0.8, 0.8, 0.3), edgecolors="dimgrey"))
    middle, radius = view
    for axis, centre in zip("xyz", middle):
        getattr(axes, f"set_{axis}lim")(centre - 0.56 * radius, centre + 0.56 * radius)
    axes.set_box_aspect((1, 1, 1))
    axes.view_init(elev=np.degrees(np.arcsin(EYE[2] / np.linalg.norm(EYE))), azim=np.degrees(np.arctan2(EYE[1], EYE[0])))
    axes.set_axis_off()


def limits_of(panels):
    lower, upper = min(p.range[0] for p in panels), max(p.range[1] for p in panels)
    return (lower, upper) if upper > lower else (lower - 1.0, upper + 1.0)


def panel_path(folder, row, column):
    return os.path.join(folder, f"panel_{row}{column}.png")


def render_all(rows, folder):
    """Every panel into a file of its own, by VTK."""
    for i, panels in enumerate(rows):
        for j, panel in enumerate(panels):
            render_vtk(panel, limits_of(panels), view_of(panels), panel_path(folder, i, j))


def rendered_by_vtk(arguments, folder):
    """Whether a process of its own could render all panels: without a display VTK may end the process."""
    command = [sys.executable, os.path.abspath(__file__), *arguments.results, "--panels", folder]
    command += ["--increments", *map(str, arguments.increments)]
    if not os.environ.get("DISPLAY") and shutil.which("xvfb-run"):
        command = ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", *command]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=600)
    if done.returncode == 0:
        return True
    print(f"VTK did not render (exit code {done.returncode}): {done.stdout.strip()[-400:]}", file=sys.stderr)
    return False


def compose(rows, arguments, folder):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    nrow, ncolumn = len(rows), len(arguments.increments)
    figure = pyplot.figure(figsize=(3.0 * ncolumn + 1.0, 3.0 * nrow + 0.4))
    grid = figure.add_gridspec(
        nrow, ncolumn + 1, width_ratios=[1.0] * ncolumn + [0.05], left=0.1, right=0.92, top=0.95, bottom=0.02,
        wspace=0.0, hspace=0.0,
    )  # fmt: skip
    for i, panels in enumerate(rows):
        limits = limits_of(panels)
        for j, panel in enumerate(panels):
            axes = figure.add_subplot(grid[i, j], projection=None if folder else "3d")
            if folder:
                axes.imshow(pyplot.imread(panel_path(folder, i, j)))
                axes.set_axis_off()
            else:
                draw_matplotlib(axes, panel, limits, view_of(panels))
            if i == 0:
                axes.set_title(f"increment {arguments.increments[j]}", fontsize=11)
            if j == 0:
                title = TITLES[i] if nrow == len(TITLES) else arguments.results[i]
                place = grid[i, j].get_position(figure)
                figure.text(0.045, place.y0 + 0.5 * place.height, title, rotation=90, ha="center", va="center")
        place = grid[i, ncolumn].get_position(figure)
        bar = figure.add_axes([place.x0, place.y0 + 0.15 * place.height, place.width, 0.7 * place.height])
        figure.colorbar(ScalarMappable(Normalize(*limits), COLOURS), cax=bar, label="vertical stress σzz [MPa]")
    os.makedirs(os.path.dirname(os.path.abspath(arguments.output)), exist_ok=True)
    figure.savefig(arguments.output, dpi=150)


def main():
    parser = argparse.ArgumentParser(description="Draw figure 2 of the paper from the results of its examples.")
    parser.add_argument("results", nargs="+", help="result folders: wedge, symmetric brick, arbitrary brick")
    parser.add_argument("-o", "--output", default="docs/figures/paper_figure_2.png")
    parser.add_argument("--increments", type=int, nargs="+", default=INCREMENTS)
    parser.add_argument("--renderer", choices=["auto", "vtk", "matplotlib"], default="auto")
    parser.add_argument("--panels", metavar="FOLDER", help="only render the panels by VTK, into this folder")
    arguments = parser.parse_args()
    try:
        rows = [read_panels(folder, arguments.increments) for folder in arguments.results]
    except (Unreadable, KeyError, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    if arguments.panels:
        render_all(rows, arguments.panels)
        return 0
    with tempfile.TemporaryDirectory() as folder:
        by_vtk = arguments.renderer != "matplotlib" and rendered_by_vtk(arguments, folder)
        if arguments.renderer == "vtk" and not by_vtk:
            return 2
        compose(rows, arguments, folder if by_vtk else None)
    print(f"{arguments.output}: drawn with {'VTK' if by_vtk else 'Matplotlib'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
