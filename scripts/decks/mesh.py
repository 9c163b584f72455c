"""Structured meshes of hexahedra, tetrahedra and plane quadrilaterals, and what is selected of them."""

import functools
import itertools

import numpy as np

from accuracy import HEX, TET

QUAD = [(0, 1), (1, 2), (2, 3), (3, 0)]
# corners of each side, in the order in which CalculiX numbers the sides
SIDES = {"hex": HEX, "tet": TET, "quad": QUAD}
EDGES = {"tet": [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)], "quad": QUAD}
# corners of a cell of a grid, as steps along its axes
CELL = {2: [(0, 0), (1, 0), (1, 1), (0, 1)], 3: [(i, j, k) for k in (0, 1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]}
SHAPES = {"C3D8": "hex", "C3D8I": "hex", "C3D10": "tet", "CPS4": "quad", "CPE4": "quad", "CPE8": "quad"}
QUADRATIC = ("C3D10", "CPE8")
# two points that are closer than this, relative to the size of the mesh, are one
SAME, OFFSET = 1e-7, 0.377


class Mesh:
    """Points and cells. `at` has the coordinates of the points in the grid, by which parts of the mesh are selected."""

    def __init__(self, kind, at, points, cells):
        self.kind, self.at, self.points, self.cells = kind, at, points, cells
        self.shape = SHAPES[kind]

    @property
    def dof(self):
        return self.points.size

    def nodes(self, where):
        """Indices of the points whose grid coordinates satisfy a condition."""
        return np.nonzero(where(*self.at.T))[0]

    def sides(self, where):
        """Outer sides, as pairs of a cell and a side, all corners of which satisfy a condition."""
        chosen = where(*self.at.T)
        cells, sides, corners = self.outer
        return [(int(cells[i]), int(sides[i])) for i in np.nonzero(chosen[corners].all(axis=1))[0]]

    @functools.cached_property
    def outer(self):
        """Cells, sides and corners of the sides that belong to one cell only."""
        table = SIDES[self.shape]
        corners = np.concatenate([self.cells[:, list(side)] for side in table])
        _, inverse, count = np.unique(np.sort(corners, axis=1), axis=0, return_inverse=True, return_counts=True)
        alone = np.nonzero(count[inverse.ravel()] == 1)[0]
        sides, cells = np.divmod(alone, len(self.cells))
        return cells, sides, corners[alone]


def grid(kind, axes, place=None):
    """The mesh between given values along two or three axes; `place` maps an array of grid points into space."""
    counts = [len(axis) for axis in axes]
    at = np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], axis=1)
    number = np.arange(len(at)).reshape(counts)
    corners = [
        number[tuple(slice(step, count - 1 + step) for step, count in zip(steps, counts))].ravel()
        for steps in CELL[len(axes)]
    ]
    cells = np.stack(corners, axis=1)
    if SHAPES[kind] == "tet":
        cells = np.concatenate([cells[:, list(tet)] for tet in tetrahedra()])
    if kind in QUADRATIC:
        at, cells = with_middles(at, cells, EDGES[SHAPES[kind]])
    return Mesh(kind, at, at if place is None else place(at), cells)


def tetrahedra():
    """A cube cut into six tetrahedra around its diagonal: each goes from corner 0 to the opposite one along edges."""
    index = {corner: number for number, corner in enumerate(CELL[3])}
    found = []
    for order in itertools.permutations(range(3)):
        corner, path = np.zeros(3, int), [0]
        for axis in order:
            corner[axis] = 1
            path.append(index[tuple(corner)])
        edges = np.array([CELL[3][one] for one in path[1:]]) - CELL[3][path[0]]
        found.append(path if np.linalg.det(edges) > 0 else [path[0], path[2], path[1], path[3]])
    return found


def with_middles(at, cells, edges):
    """Points and cells with a further point in the middle of each edge."""
    ends = np.concatenate([np.sort(cells[:, list(edge)], axis=1) for edge in edges])
    unique, inverse = np.unique(ends, axis=0, return_inverse=True)
    middles = len(at) + inverse.ravel().reshape(len(edges), -1).T
    return np.concatenate([at, at[unique].mean(axis=1)]), np.concatenate([cells, middles], axis=1)


def join(meshes):
    """One mesh of several that share points; its grid coordinates are those in space."""
    points = np.concatenate([mesh.points for mesh in meshes])
    starts = np.cumsum([0, *(len(mesh.points) for mesh in meshes)])
    cells = np.concatenate([mesh.cells + start for mesh, start in zip(meshes, starts)])
    # an offset keeps round numbers away from the limits of the cells to which coordinates are rounded
    keys = np.floor((points - points.min(axis=0)) / (SAME * np.ptp(points, axis=0).max()) + OFFSET)
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return Mesh(meshes[0].kind, points[first], points[first], inverse.ravel()[cells])


def spaced(start, end, size):
    """Equal steps of about this size, at least two."""
    return np.linspace(start, end, max(2, round((end - start) / size)) + 1)


def broken(limits, size):
    """Steps of about this size, with points at all limits."""
    parts = [spaced(start, end, size) for start, end in zip(limits, limits[1:])]
    return np.concatenate([parts[0][:1], *(part[1:] for part in parts)])


def graded(start, end, size, coarse):
    """Steps that grow evenly from `size` at the start to about `coarse` times as much at the end."""
    count = max(2, round(2.0 * abs(end - start) / (size * (1.0 + coarse))))
    steps = np.linspace(1.0, coarse, count)
    return start + (end - start) * np.concatenate([[0.0], np.cumsum(steps) / steps.sum()])


def dense_in_the_middle(start, end, size, coarse):
    """Steps that are finest in the middle."""
    middle = 0.5 * (start + end)
    right = graded(middle, end, size, coarse)
    return np.concatenate([2.0 * middle - right[:0:-1], right])


def box(kind, low, high, sizes):
    """A block between two corners, with steps of about these sizes along its axes."""
    return grid(kind, [spaced(*one) for one in zip(low, high, np.broadcast_to(sizes, len(low)))])
