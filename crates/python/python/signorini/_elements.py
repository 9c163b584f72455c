"""Element types: their names here and in other programs, and the orders of their nodes.

A row of `ORDERS` lists, for each node here, its place in the other program's element; types without a row have the
same order.
"""

from __future__ import annotations

from typing import NamedTuple


class Element(NamedTuple):
    """An element type."""

    name: str
    dim: int
    nnode: int
    sides: int
    vtk: int
    gmsh: int
    meshio: str
    corners: tuple[tuple[int, ...], ...] = ()
    """Corners of the faces of a solid, or of the element itself in the plane; the normals point out."""


_HEX = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
_TET = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
_WEDGE = ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
_QUAD = ((0, 1, 2, 3),)
_TRI = ((0, 1, 2),)
_LINE = ((0, 1),)

ELEMENTS = {
    one.name: one
    for one in (
        Element("line2", 1, 2, 2, 3, 1, "line", _LINE),
        Element("line3", 1, 3, 2, 21, 8, "line3", _LINE),
        Element("tri3", 2, 3, 3, 5, 2, "triangle", _TRI),
        Element("tri6", 2, 6, 3, 22, 9, "triangle6", _TRI),
        Element("quad4", 2, 4, 4, 9, 3, "quad", _QUAD),
        Element("quad8", 2, 8, 4, 23, 16, "quad8", _QUAD),
        Element("quad9", 2, 9, 4, 28, 10, "quad9", _QUAD),
        Element("tet4", 3, 4, 4, 10, 4, "tetra", _TET),
        Element("tet10", 3, 10, 4, 24, 11, "tetra10", _TET),
        Element("hex8", 3, 8, 6, 12, 5, "hexahedron", _HEX),
        Element("hex20", 3, 20, 6, 25, 17, "hexahedron20", _HEX),
        Element("hex27", 3, 27, 6, 29, 12, "hexahedron27", _HEX),
        Element("wedge6", 3, 6, 5, 13, 6, "wedge", _WEDGE),
        Element("wedge15", 3, 15, 5, 26, 18, "wedge15", _WEDGE),
    )
}

ALIASES = {one.meshio: one.name for one in ELEMENTS.values()} | {
    "tetrahedron": "tet4",
    "tetrahedron10": "tet10",
    "brick": "hex8",
    "prism": "wedge6",
    "prism15": "wedge15",
    "prism6": "wedge6",
    "line_2": "line2",
}

BY_VTK = {one.vtk: one for one in ELEMENTS.values()} | {8: ELEMENTS["quad4"], 11: ELEMENTS["hex8"]}
BY_GMSH = {one.gmsh: one for one in ELEMENTS.values()}

_HEX20 = (0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15)

GMSH_ORDERS = {
    "tet10": (0, 1, 2, 3, 4, 5, 6, 7, 9, 8),
    "hex20": _HEX20,
    "hex27": (*_HEX20, 20, 25, 21, 23, 24, 22, 26),
    "wedge15": (0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11),
}

# centres of sides: ours S1 to S6, VTK's -x +x -y +y -z +z
VTK_ORDERS: dict[int, tuple[int, ...]] = {
    8: (0, 1, 3, 2),
    11: (0, 1, 3, 2, 4, 5, 7, 6),
    29: (*range(20), 24, 25, 22, 21, 23, 20, 26),
}


def element(name: str) -> Element:
    """The type of a name, of ours or of meshio.

    >>> element("tetra10").name
    'tet10'
    """
    found = ELEMENTS.get(ALIASES.get(name, name))
    if found is None:
        raise ValueError(f"no element is called {name!r}; known: {', '.join(ELEMENTS)}")
    return found
