"""Meshes: nodes, cells and named sets as arrays."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _html
from ._elements import BY_GMSH, BY_VTK, ELEMENTS, GMSH_ORDERS, VTK_ORDERS, element
from ._optional import need
from ._optional import off_screen as without_window
from ._sets import CellSets, Ids, NodeSets, Surfaces

if TYPE_CHECKING:
    from . import _native
    from .errors import Diagnostic

Floats: TypeAlias = NDArray[np.float64]
Integers: TypeAlias = NDArray[Any]


class Mesh:
    """Nodes, cells and sets.

    Parameters
    ----------
    points: `(n, 3)` coordinates (length); C-contiguous float64 is borrowed, anything else converted; `(n, 2)` gets z = 0
    cells: `{"hex8": (m, 8)}` or `[("hex8", cells), ...]`, node indices from 0; names of meshio are understood
    node_sets, cell_sets, surfaces: sets by name, see the attributes of the same name
    node_labels, cell_labels: numbers of nodes and cells in messages, cases and results; absent: from 1

    TOML: `[mesh]`, and `[sets]` for its sets.

    >>> import numpy as np
    >>> points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    >>> mesh = Mesh(points, {"tet4": [[0, 1, 2, 3]]}, node_sets={"base": [0, 1, 2]})
    >>> mesh
    <Mesh: 4 nodes, 1 tet4, sets base>
    >>> np.shares_memory(mesh.points, points)
    True
    """

    def __init__(
        self,
        points: ArrayLike,
        cells: Mapping[str, ArrayLike] | Iterable[tuple[str, ArrayLike]],
        node_sets: Mapping[str, ArrayLike] | None = None,
        cell_sets: Mapping[str, ArrayLike | Sequence[Any]] | None = None,
        surfaces: Mapping[str, ArrayLike] | None = None,
        *,
        node_labels: ArrayLike | None = None,
        cell_labels: Sequence[ArrayLike] | None = None,
    ) -> None:
        self._points = _points(points)
        pairs = cast("Any", cells).items() if isinstance(cells, Mapping) else cells
        pairs = cast("Iterable[tuple[str, ArrayLike]]", pairs)
        self._blocks = [(element(name).name, _cells(name, block, len(self._points))) for name, block in pairs]
        self._node_labels = _labels(node_labels, len(self._points), "node_labels")
        self._cell_labels: list[NDArray[np.uint64] | None] = [None] * len(self._blocks)
        if cell_labels is not None:
            if len(cell_labels) != len(self._blocks):
                raise ValueError(f"cell_labels has to have {len(self._blocks)} arrays, one for each block")
            pairs_of_labels = zip(cell_labels, self._blocks, strict=True)
            self._cell_labels = [_labels(one, len(block), "cell_labels") for one, (_, block) in pairs_of_labels]
        self._start()
        self._node_sets.fill(node_sets)
        self._cell_sets.fill(cell_sets)
        self._surfaces.fill(surfaces)

    def _start(self) -> None:
        """Sets without content."""
        self._native_mesh: _native.Mesh | None = None
        self._outside: tuple[Ids, Floats, Floats] | None = None
        self._file: str | None = None
        self._case_sets: dict[str, Any] = {}
        self.diagnostics: list[Diagnostic] = []
        sizes = [len(block) for _, block in self._blocks]
        sides = [ELEMENTS[name].sides for name, _ in self._blocks]
        self._node_sets = NodeSets(len(self._points), self._changed)
        self._cell_sets = CellSets(sizes, self._changed)
        self._surfaces = Surfaces(list(zip(sizes, sides, strict=True)), self._changed)

    def _changed(self) -> None:
        self._native_mesh = None
        self._file = None

    # -- what it holds ------------------------------------------------------------------------------------------

    @property
    def points(self) -> Floats:
        """Coordinates `(n, 3)` at the start (length), a read-only view."""
        return self._points

    @property
    def cells(self) -> dict[str, Integers]:
        """Node indices from 0 by element type, read-only; blocks of one type are joined."""
        out: dict[str, Integers] = {}
        for name, block in self._blocks:
            out[name] = _read_only(np.concatenate([out[name], block])) if name in out else block
        return out

    @property
    def blocks(self) -> list[tuple[str, Integers]]:
        """Element type and node indices of each block, in their order."""
        return list(self._blocks)

    @property
    def node_labels(self) -> NDArray[np.uint64]:
        """Numbers of the nodes in messages, cases and results."""
        if self._node_labels is None:
            return _read_only(np.arange(1, len(self._points) + 1, dtype=np.uint64))
        return self._node_labels

    @property
    def cell_labels(self) -> list[NDArray[np.uint64]]:
        """Numbers of the cells of each block."""
        out: list[NDArray[np.uint64]] = []
        start = 1
        for (_, block), labels in zip(self._blocks, self._cell_labels, strict=True):
            numbers = np.arange(start, start + len(block), dtype=np.uint64)
            out.append(_read_only(numbers) if labels is None else labels)
            start += len(block)
        return out

    @property
    def node_sets(self) -> NodeSets:
        """Sets of nodes by name: `mesh.node_sets["head"] = np.flatnonzero(mesh.points[:, 2] > 9.9)`."""
        return self._node_sets

    @property
    def cell_sets(self) -> CellSets:
        """Groups of cells by name, for bodies: indices over all blocks."""
        return self._cell_sets

    @property
    def surfaces(self) -> Surfaces:
        """Sets of faces by name, for contacts and loads: rows [block, cell, side]; see `faces_where`."""
        return self._surfaces

    @property
    def dim(self) -> int:
        """The highest dimension of a cell."""
        return max((ELEMENTS[name].dim for name, _ in self._blocks), default=0)

    @property
    def set_names(self) -> list[str]:
        """Names of all sets."""
        return list(dict.fromkeys([*self._node_sets, *self._cell_sets, *self._surfaces]))

    # -- selections ---------------------------------------------------------------------------------------------

    def nodes_where(self, predicate: Callable[[Floats], ArrayLike]) -> Ids:
        """Indices of the nodes where a predicate of the coordinates `(n, 3)` holds.

        >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], {"tet4": [[0, 1, 2, 3]]})
        >>> mesh.nodes_where(lambda x: x[:, 2] < 0.5)
        array([0, 1, 2])
        """
        return np.flatnonzero(_mask(predicate(self._points), len(self._points))).astype(np.int64)

    def faces_where(
        self,
        predicate: Callable[[Floats], ArrayLike] | None = None,
        *,
        normal: Callable[[Floats], ArrayLike] | ArrayLike | None = None,
        within: float = 30.0,
    ) -> Ids:
        """Outer faces where a predicate of the face centres `(n, 3)` holds: rows [block, cell, side].

        `normal`: a predicate of the outward unit normals `(n, 3)`, or a vector with which they enclose an angle of at
        most `within` (degrees).
        """
        faces, centers, normals = self.boundary()
        mask = np.ones(len(faces), dtype=bool)
        if predicate is not None:
            mask &= _mask(predicate(centers), len(faces))
        if callable(normal):
            mask &= _mask(normal(normals), len(faces))
        elif normal is not None:
            axis = np.asarray(normal, dtype=float)
            mask &= normals @ (axis / np.linalg.norm(axis)) >= np.cos(np.radians(within))
        return faces[mask]

    def boundary(self) -> tuple[Ids, Floats, Floats]:
        """All outer faces of the cells of the highest dimension: faces, centres and outward unit normals."""
        if self._outside is None:
            faces, centers, normals = self.native().boundary()
            self._outside = _read_only(faces), _read_only(centers), _read_only(normals)
        return self._outside

    # -- from and to others -------------------------------------------------------------------------------------

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Mesh:
        """Reads a mesh file: Gmsh, Abaqus and CalculiX, OOFEM, VTU."""
        from . import _native
        from .errors import Diagnostic

        native, found = _native.Mesh.read(os.fspath(path))
        mesh = cls.from_native(native, file=os.path.abspath(path))
        mesh.diagnostics = [Diagnostic(one) for one in found]
        return mesh

    @classmethod
    def from_native(cls, native: _native.Mesh, file: str | None = None) -> Mesh:
        """A mesh of the Rust module, whose arrays are shared."""
        mesh = cls.__new__(cls)
        mesh._points = _read_only(native.points)
        mesh._blocks = [(name, _read_only(cells)) for name, cells, _ in native.blocks]
        mesh._node_labels = _read_only(native.node_labels)
        mesh._cell_labels = [_read_only(labels) for _, _, labels in native.blocks]
        mesh._start()
        starts = np.cumsum([0, *(len(block) for _, block in mesh._blocks)])
        for name, (nodes, cells, faces) in native.sets.items():
            if len(nodes) or not (len(cells) or len(faces)):
                mesh._node_sets[name] = nodes
            if len(cells):
                mesh._cell_sets[name] = starts[cells[:, 0]] + cells[:, 1]
            if len(faces):
                mesh._surfaces[name] = faces
        mesh._native_mesh = native
        mesh._file = file
        return mesh

    @classmethod
    def grid(cls, x: ArrayLike, y: ArrayLike, z: ArrayLike | None = None) -> Mesh:
        """A block of quad4 between the lines `x` and `y`, or of hex8 with `z`. Lines are increasing coordinates (length).

        Its outer faces are the surfaces xmin, xmax, ymin, ymax, zmin and zmax.

        >>> Mesh.grid([0, 1, 2], [0, 1])
        <Mesh: 6 nodes, 2 quad4, sets xmin, xmax, ymin, ymax>
        """
        lines = [np.asarray(line, dtype=float) for line in (x, y, z) if line is not None]
        for letter, line in zip("xyz", lines, strict=False):
            if line.ndim != 1 or len(line) < 2 or not (np.diff(line) > 0.0).all():
                raise ValueError(f"{letter} has to be at least two increasing coordinates")
        dim, counts = len(lines), [len(line) for line in lines]
        spread: list[Floats] = list(np.meshgrid(*lines, indexing="ij"))
        points = np.column_stack([one.ravel(order="F") for one in spread])
        nodes: Ids = np.reshape(np.arange(len(points)), counts, order="F")
        first = nodes[tuple(slice(count - 1) for count in counts)].ravel(order="F")
        corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
        cells = first[:, None] + corners[: 2**dim, :dim] @ np.cumprod([1, *counts[:-1]])
        mesh = cls(points, {("quad4", "hex8")[dim - 2]: cells})
        places = np.stack(np.unravel_index(np.arange(len(cells)), [n - 1 for n in counts], order="F"), axis=-1)
        sides = ((3, 1), (0, 2)) if dim == 2 else ((5, 3), (2, 4), (0, 1))
        for axis, (low, high) in enumerate(sides):
            for name, side, at in ((f"{'xyz'[axis]}min", low, 0), (f"{'xyz'[axis]}max", high, counts[axis] - 2)):
                ids = np.flatnonzero(places[:, axis] == at)
                mesh.surfaces[name] = np.column_stack([0 * ids, ids, 0 * ids + side])
        return mesh

    @classmethod
    def from_gmsh(cls) -> Mesh:
        """The mesh of gmsh's current model. Physical groups become sets; with groups, only cells in groups are taken.

        As from a file: volumes are groups of cells, surfaces of a model in space are faces of its volumes.
        """
        gmsh: Any = need("gmsh", "Mesh.from_gmsh")
        if not gmsh.isInitialized():
            raise ValueError("gmsh has no model: call from_gmsh between gmsh.initialize() and gmsh.finalize()")
        model: Any = gmsh.model
        tags, coordinates, _ = model.mesh.getNodes()
        order = np.argsort(tags, kind="stable")
        tags = np.asarray(tags)[order]
        points = np.reshape(np.asarray(coordinates, dtype=float), (-1, 3))[order]
        if len(tags) == 0:
            raise ValueError("gmsh's current model has no mesh: call gmsh.model.mesh.generate(3)")
        groups = [(int(dim), int(tag)) for dim, tag in model.getPhysicalGroups()]
        entities = {
            (dim, int(entity)): None
            for dim, tag in sorted(groups, key=lambda group: -group[0])
            for entity in model.getEntitiesForPhysicalGroup(dim, tag)
        } or {(int(dim), int(tag)): None for dim, tag in model.getEntities() if dim > 0}
        blocks: dict[str, list[Integers]] = {}
        labels: dict[str, list[Integers]] = {}
        places: dict[tuple[int, int], list[tuple[str, int, int]]] = {}
        sizes: dict[str, int] = {}
        for dim, entity in sorted(entities, key=lambda one: -one[0]):
            if dim == 0:
                continue
            kinds, numbers, nodes = model.mesh.getElements(dim, entity)
            for kind, number, node in zip(kinds, numbers, nodes, strict=True):
                found = BY_GMSH.get(int(kind))
                if found is None:
                    name = model.mesh.getElementProperties(kind)[0]
                    raise ValueError(f"there is no element for gmsh's {name} (type {kind})")
                cells = np.reshape(np.searchsorted(tags, np.asarray(node)), (-1, found.nnode))
                if found.name in GMSH_ORDERS:
                    cells = cells[:, GMSH_ORDERS[found.name]]
                start = sizes.get(found.name, 0)
                sizes[found.name] = start + len(cells)
                blocks.setdefault(found.name, []).append(cells)
                labels.setdefault(found.name, []).append(np.asarray(number))
                places.setdefault((dim, entity), []).append((found.name, start, start + len(cells)))
        joined = {name: np.ascontiguousarray(np.concatenate(parts)) for name, parts in blocks.items()}
        mesh = cls(
            points,
            joined,
            node_labels=tags.astype(np.uint64),
            cell_labels=[np.concatenate(labels[name]).astype(np.uint64) for name in joined],
        )
        starts = dict(zip(joined, np.cumsum([0, *(len(one) for one in joined.values())]), strict=False))
        for dim, tag in groups:
            name = model.getPhysicalName(dim, tag) or f"{('point', 'line', 'surface', 'volume')[dim]}_{tag}"
            inside = [int(one) for one in model.getEntitiesForPhysicalGroup(dim, tag)]
            if dim == 0:
                nodes = [model.mesh.getNodes(0, one)[0] for one in inside]
                _extend(mesh.node_sets, name, np.searchsorted(tags, np.concatenate(nodes)))
                continue
            ranges = [place for one in inside for place in places.get((dim, one), [])]
            ids = [np.arange(a, b) + starts[kind] for kind, a, b in ranges]
            _extend(mesh.cell_sets, name, np.concatenate(ids) if ids else np.empty(0, np.int64))
        return mesh

    @classmethod
    def from_meshio(cls, mesh: Any) -> Mesh:
        """A mesh of meshio, with its point sets, cell sets and Gmsh's physical groups."""
        blocks: list[tuple[str, Integers]] = []
        kept: list[int] = []
        for index, block in enumerate(mesh.cells):
            if block.type == "vertex":
                continue
            found = element(block.type)
            order = VTK_ORDERS.get(found.vtk)
            cells = np.asarray(block.data)
            blocks.append((found.name, cells if order is None else np.ascontiguousarray(cells[:, order])))
            kept.append(index)
        out = cls(mesh.points, blocks, node_sets=getattr(mesh, "point_sets", None))
        for name, parts in getattr(mesh, "cell_sets", {}).items():
            if name.startswith("gmsh:"):
                continue
            out.cell_sets[name] = [np.asarray(() if parts[k] is None else parts[k], dtype=np.int64) for k in kept]
        numbers = getattr(mesh, "cell_data", {}).get("gmsh:physical")
        if numbers is not None:
            for name, (number, dim) in getattr(mesh, "field_data", {}).items():
                parts = [
                    np.flatnonzero(np.asarray(numbers[k]) == number)
                    if ELEMENTS[block].dim == dim
                    else np.empty(0, np.int64)
                    for k, (block, _) in zip(kept, blocks, strict=True)
                ]
                if any(len(part) for part in parts) and name not in out.cell_sets:
                    out.cell_sets[name] = parts
        return out

    @classmethod
    def from_pyvista(cls, grid: Any) -> Mesh:
        """A data set of PyVista. Boolean arrays at points and cells become node and cell sets of their name."""
        if not hasattr(grid, "cells_dict"):
            grid = grid.cast_to_unstructured_grid()
        blocks: list[tuple[str, Integers]] = []
        places: list[Integers] = []
        kinds = np.asarray(grid.celltypes)
        for kind, cells in grid.cells_dict.items():
            if int(kind) == 1:
                continue
            found = BY_VTK.get(int(kind))
            if found is None:
                raise ValueError(f"there is no element for VTK's cell type {int(kind)}")
            order = VTK_ORDERS.get(int(kind))
            cells = np.asarray(cells)
            blocks.append((found.name, cells if order is None else np.ascontiguousarray(cells[:, order])))
            places.append(np.flatnonzero(kinds == kind))
        mesh = cls(np.asarray(grid.points), blocks)
        for name in grid.point_data.keys():
            values = np.asarray(grid.point_data[name])
            if values.dtype == np.bool_:
                mesh.node_sets[name] = values
        for name in grid.cell_data.keys():
            values = np.asarray(grid.cell_data[name])
            if values.dtype == np.bool_:
                mesh.cell_sets[name] = [np.flatnonzero(values[place]) for place in places]
        return mesh

    def to_pyvista(self) -> Any:
        """The cells of the highest dimension as an unstructured grid of PyVista."""
        pv = need("pyvista", "Mesh.to_pyvista")
        cells: list[Integers] = []
        kinds: list[Integers] = []
        for name, block in self.solids():
            kind = ELEMENTS[name].vtk
            nodes = to_vtk(name, block)
            cells.append(np.column_stack([np.full(len(nodes), nodes.shape[1]), nodes]).ravel())
            kinds.append(np.full(len(nodes), kind, dtype=np.uint8))
        return pv.UnstructuredGrid(np.concatenate(cells), np.concatenate(kinds), np.array(self._points))

    def to_meshio(self) -> Any:
        """A mesh of meshio with all blocks, node sets and cell sets."""
        meshio = need("meshio", "Mesh.to_meshio")
        cells = [(ELEMENTS[name].meshio, to_vtk(name, block).astype(np.int64)) for name, block in self._blocks]
        bounds = np.cumsum([0, *(len(block) for _, block in self._blocks)])
        sets = {
            name: [ids[(ids >= a) & (ids < b)] - a for a, b in zip(bounds[:-1], bounds[1:], strict=True)]
            for name, ids in self._cell_sets.items()
        }
        return meshio.Mesh(np.array(self._points), cells, point_sets=dict(self._node_sets), cell_sets=sets)

    def solids(self) -> list[tuple[str, Integers]]:
        """The blocks of the highest dimension."""
        return [(name, block) for name, block in self._blocks if ELEMENTS[name].dim == self.dim]

    def __getstate__(self) -> dict[str, Any]:
        # the mesh in Rust is made again where it is needed
        return {**self.__dict__, "_native_mesh": None}

    def native(self) -> _native.Mesh:
        """The mesh of the Rust module, made on demand and kept until a set changes."""
        if self._native_mesh is None:
            from . import _native

            pairs = zip(self._blocks, self._cell_labels, strict=True)
            blocks = [(name, np.ascontiguousarray(block, dtype=np.int64), labels) for (name, block), labels in pairs]
            self._native_mesh = _native.Mesh(self._points, self._node_labels, blocks, self._all_sets())
        return self._native_mesh

    def _all_sets(self) -> dict[str, tuple[Ids, Ids, Ids]]:
        starts = np.cumsum([0, *(len(block) for _, block in self._blocks)])
        empty = np.empty(0, np.int64)
        out: dict[str, tuple[Ids, Ids, Ids]] = {}
        for name in self.set_names:
            cells = self._cell_sets[name] if name in self._cell_sets else empty
            block = np.searchsorted(starts, cells, side="right") - 1
            out[name] = (
                self._node_sets[name] if name in self._node_sets else empty,
                np.column_stack([block, cells - starts[block]]).astype(np.int64),
                self._surfaces[name] if name in self._surfaces else np.empty((0, 3), np.int64),
            )
        return out

    def in_place(self) -> tuple[str, dict[str, dict[str, list[str]]]]:
        """`[mesh]` and `[sets]` in TOML, and sets that are unions of those.

        A list of elements gives each element one group. Where cells of surfaces are in several sets, each combination of
        sets is a group, and the sets are unions of them.
        """
        lower = np.concatenate([np.full(len(block), ELEMENTS[name].dim < self.dim) for name, block in self._blocks])
        holders: dict[int, list[str]] = {}
        for name, ids in self._cell_sets.items():
            for cell in ids[lower[ids]].tolist():
                holders.setdefault(cell, []).append(name)
        shared = {name for names in holders.values() if len(names) > 1 for name in names}
        if not shared:
            return self.native().to_toml(), {}
        twin = Mesh(
            self._points,
            self._blocks,
            {f"{name} nodes" if name in shared else name: ids for name, ids in self._node_sets.items()},
            {name: ids for name, ids in self._cell_sets.items() if name not in shared},
            {f"{name} faces" if name in shared else name: ids for name, ids in self._surfaces.items()},
            node_labels=self._node_labels,
            cell_labels=self.cell_labels,
        )
        parts: dict[str, list[int]] = {}
        unions: dict[str, list[str]] = {name: [] for name in self._cell_sets if name in shared}
        for cell, names in sorted(holders.items()):
            if shared.isdisjoint(names):
                continue
            part = " and ".join(names) if len(names) > 1 else f"{names[0]} alone"
            parts.setdefault(part, []).append(cell)
        for part, cells in parts.items():
            twin.cell_sets[part] = cells
            for name in holders[cells[0]]:
                unions[name].append(part)
        for name, union in unions.items():
            solid = self._cell_sets[name][~lower[self._cell_sets[name]]]
            if len(solid):
                twin.cell_sets[f"{name} solids"] = solid
            kinds = {"solids": len(solid), "nodes": name in self._node_sets, "faces": name in self._surfaces}
            union += [f"{name} {kind}" for kind, is_there in kinds.items() if is_there]
        return twin.native().to_toml(), {name: {"union": union} for name, union in unions.items()}

    @property
    def file(self) -> str | None:
        """The file it was read from, while its sets are those of the file."""
        return self._file

    def plot(self, **options: Any) -> Any:
        """Shows it with PyVista."""
        need("pyvista", "Mesh.plot")
        return self.to_pyvista().plot(**{"show_edges": True, "off_screen": without_window(), **options})

    def _counts(self) -> list[str]:
        counts: dict[str, int] = {}
        for name, block in self._blocks:
            counts[name] = counts.get(name, 0) + len(block)
        return [f"{count} {name}" for name, count in counts.items()]

    def __repr__(self) -> str:
        names = self.set_names
        sets = f", sets {', '.join(names[:6])}{', …' if len(names) > 6 else ''}" if names else ""
        return f"<Mesh: {', '.join([f'{len(self._points)} nodes', *self._counts()])}{sets}>"

    def _repr_html_(self) -> str:
        from .notebook import thumbnail

        low, high = (self._points.min(axis=0), self._points.max(axis=0)) if len(self._points) else ((0,) * 3,) * 2
        rows: list[tuple[str, object]] = [
            ("nodes", len(self._points)),
            ("cells", ", ".join(self._counts())),
            ("from", "  ".join(f"{x:.4g}" for x in low)),
            ("to", "  ".join(f"{x:.4g}" for x in high)),
        ]
        for title, sets in (("nodes", self._node_sets), ("cells", self._cell_sets), ("faces", self._surfaces)):
            rows += [(name, f"{len(ids)} {title}") for name, ids in sets.items()]
        return _html.document("Mesh", rows, picture=thumbnail(self))


def to_vtk(name: str, cells: Integers) -> Integers:
    """Node indices in VTK's order."""
    order = VTK_ORDERS.get(ELEMENTS[name].vtk)
    return cells if order is None else cells[:, np.argsort(order)]


def _read_only(array: Any) -> Any:
    view = array.view()
    view.flags.writeable = False
    return view


def _points(points: ArrayLike) -> Floats:
    array = np.asarray(points)
    if array.ndim != 2 or array.shape[1] not in (2, 3) or array.dtype.kind not in "fiu":
        raise ValueError(f"points has to be (n, 3) or (n, 2) numbers, found shape {array.shape} of {array.dtype}")
    if array.shape[1] == 2:
        array = np.column_stack([array, np.zeros(len(array))])
    array = np.ascontiguousarray(array, dtype=np.float64)
    if not np.isfinite(array).all():
        raise ValueError(f"point {int(np.flatnonzero(~np.isfinite(array).all(axis=1))[0])} is not finite")
    return _read_only(array)


def _cells(name: str, cells: ArrayLike, npoint: int) -> Integers:
    found = element(name)
    array: Integers = np.asarray(cells)
    if array.size == 0:
        array = np.empty((0, found.nnode), np.int64)
    if array.ndim != 2 or array.shape[1] != found.nnode or array.dtype.kind not in "iu":
        raise ValueError(
            f"cells of {name} have to be (m, {found.nnode}) indices, found shape {array.shape} of {array.dtype}"
        )
    if array.size and (array.min() < 0 or array.max() >= npoint):
        bad = int(np.flatnonzero((array < 0).any(axis=1) | (array >= npoint).any(axis=1))[0])
        raise IndexError(f"cell {bad} of {name} has nodes {array[bad].tolist()}, but there are {npoint} points")
    if str(array.dtype) not in ("int32", "int64", "uint32") or not array.flags.c_contiguous:
        array = np.ascontiguousarray(array, dtype=np.int64)
    return _read_only(array)


def _labels(labels: ArrayLike | None, count: int, what: str) -> Any:
    if labels is None:
        return None
    array = np.ascontiguousarray(labels, dtype=np.uint64)
    if array.shape != (count,):
        raise ValueError(f"{what} has to have shape ({count},), found {array.shape}")
    return _read_only(array)


def _mask(found: ArrayLike, count: int) -> NDArray[np.bool_]:
    mask = np.asarray(found)
    if mask.shape != (count,) or mask.dtype != np.bool_:
        raise ValueError(
            f"the predicate has to return {count} booleans, found shape {mask.shape} of {mask.dtype}; "
            "it receives an array (n, 3)"
        )
    return mask


def _extend(sets: NodeSets | CellSets, name: str, ids: Ids) -> None:
    sets[name] = np.unique(np.concatenate([sets[name], ids])) if name in sets else ids
