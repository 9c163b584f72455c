"""Meshes from arrays, and their sets."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import signorini as sg
from signorini._elements import ELEMENTS, GMSH_ORDERS, VTK_ORDERS

from .conftest import box, native

TET = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)


def test_points_and_cells_are_borrowed() -> None:
    cells = np.array([[0, 1, 2, 3]], dtype=np.int64)
    mesh = sg.Mesh(TET, {"tet4": cells})
    assert np.shares_memory(mesh.points, TET)
    assert np.shares_memory(mesh.cells["tet4"], cells)
    assert np.shares_memory(sg.Mesh(TET, {"tet4": cells.astype(np.int32)}).points, TET)


def test_writing_to_a_view_raises() -> None:
    mesh = sg.Mesh(TET, {"tet4": [[0, 1, 2, 3]]}, node_sets={"a": [0]})
    for array in (mesh.points, mesh.cells["tet4"], mesh.node_sets["a"], mesh.node_labels):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    TET[0, 0] = 0.0


def test_other_arrays_are_converted() -> None:
    for points in (TET.astype(np.float32), np.asfortranarray(TET), TET.tolist()):
        mesh = sg.Mesh(points, [("tetra", [[0, 1, 2, 3]])])
        assert mesh.points.flags.c_contiguous and mesh.points.dtype == np.float64
        assert list(mesh.cells) == ["tet4"]


def test_points_of_the_plane_get_z() -> None:
    mesh = sg.Mesh(TET[:3, :2], {"triangle": [[0, 1, 2]]})
    assert mesh.points.shape == (3, 3) and not mesh.points[:, 2].any()
    assert mesh.dim == 2


@pytest.mark.parametrize(
    ("points", "cells", "message"),
    [
        (TET, {"tet4": [[0, 1, 2, 4]]}, "cell 0 of tet4"),
        (TET, {"tet4": [[0, 1, 2]]}, r"\(m, 4\)"),
        (TET, {"tet5": [[0, 1, 2, 3]]}, "no element is called 'tet5'"),
        (TET, {"tet4": [[0.0, 1.0, 2.0, 3.0]]}, "indices"),
        (TET[:, :1], {"tet4": [[0, 1, 2, 3]]}, r"\(n, 3\)"),
        (np.where(TET == 1, np.nan, TET), {"tet4": [[0, 1, 2, 3]]}, "point 1 is not finite"),
    ],
)
def test_bad_arrays_are_named(points: Any, cells: Any, message: str) -> None:
    with pytest.raises((ValueError, IndexError), match=message):
        sg.Mesh(points, cells)


def test_sets_take_indices_and_masks() -> None:
    mesh = box()
    mesh.node_sets["mask"] = mesh.points[:, 0] < 0.1
    mesh.node_sets["indices"] = np.flatnonzero(mesh.points[:, 0] < 0.1)
    assert np.array_equal(mesh.node_sets["mask"], mesh.node_sets["indices"])
    assert mesh.node_sets["mask"].dtype == np.int64
    mesh.cell_sets["half"] = np.arange(8) < 4
    assert mesh.cell_sets["half"].tolist() == [0, 1, 2, 3]


def test_the_order_of_a_set_is_kept() -> None:
    mesh = box()
    mesh.node_sets["pairs"] = [5, 2, 9]
    assert mesh.node_sets["pairs"].tolist() == [5, 2, 9]


def test_bad_sets_are_refused() -> None:
    mesh = box()
    with pytest.raises(IndexError, match="'far': index 27"):
        mesh.node_sets["far"] = [27]
    with pytest.raises(ValueError, match="mask"):
        mesh.node_sets["mask"] = np.ones(3, dtype=bool)
    with pytest.raises(TypeError, match="indices"):
        mesh.node_sets["real"] = np.array([0.5])
    with pytest.raises(IndexError, match="no face"):
        mesh.surfaces["side"] = [[0, 0, 6]]
    with pytest.raises(KeyError, match="did you mean 'head'"):
        _ = mesh.node_sets["haed"]
    with pytest.raises(TypeError, match="text"):
        mesh.node_sets[3] = [0]  # type: ignore[index]  # pyright: ignore[reportArgumentType]


def test_cell_sets_of_several_blocks() -> None:
    mesh = sg.Mesh(TET, [("tet4", [[0, 1, 2, 3]]), ("tri3", [[0, 1, 2], [0, 1, 3]])])
    mesh.cell_sets["faces"] = [np.empty(0, int), np.array([0, 1])]
    assert mesh.cell_sets["faces"].tolist() == [1, 2]
    sets = mesh._all_sets()
    assert sets["faces"][1].tolist() == [[1, 0], [1, 1]]
    assert [labels.tolist() for labels in mesh.cell_labels] == [[1], [2, 3]]


def test_nodes_by_predicate() -> None:
    mesh = box()
    assert len(mesh.node_sets["head"]) == 9
    with pytest.raises(ValueError, match="27 booleans"):
        mesh.nodes_where(lambda p: p[0, 2] < 1)


def test_thumbnails_draw_the_outer_faces() -> None:
    picture = box()._repr_html_()
    assert picture.count("<polygon") == 6 * 4
    plane = sg.Mesh(TET[:3, :2], {"tri3": [[0, 1, 2]]})._repr_html_()
    assert plane.count("<polygon") == 1


def test_node_orders_hold_each_node_once() -> None:
    for name, order in GMSH_ORDERS.items():
        assert sorted(order) == list(range(ELEMENTS[name].nnode))
    for kind, order in VTK_ORDERS.items():
        assert sorted(order) == list(range(len(order))), kind


def test_pyvista_there_and_back() -> None:
    pv = pytest.importorskip("pyvista")
    grid = pv.ImageData(dimensions=(3, 3, 3), spacing=(0.5, 0.5, 0.5)).cast_to_unstructured_grid()
    grid.point_data["top"] = np.asarray(grid.points)[:, 2] > 0.9
    grid.cell_data["low"] = np.arange(8) < 4
    mesh = sg.Mesh.from_pyvista(grid)
    assert mesh.cells["hex8"].shape == (8, 8)
    assert len(mesh.node_sets["top"]) == 9 and len(mesh.cell_sets["low"]) == 4
    back = mesh.to_pyvista()
    assert back.volume == pytest.approx(1.0)
    assert (back.compute_cell_sizes().cell_data["Volume"] > 0).all()


def test_quadratic_cells_of_pyvista_keep_their_volume() -> None:
    pv = pytest.importorskip("pyvista")
    for name in ("hex8", "tet4", "wedge6", "tri3", "quad4"):
        assert ELEMENTS[name].vtk in {int(one) for one in pv.CellType}


def test_meshio_there_and_back() -> None:
    meshio = pytest.importorskip("meshio")
    cells = [("tetra", np.array([[0, 1, 2, 3]])), ("triangle", np.array([[0, 2, 1]])), ("vertex", np.array([[0]]))]
    given = meshio.Mesh(
        TET,
        cells,
        point_sets={"base": np.array([0, 1, 2])},
        cell_sets={"bottom": [np.array([], dtype=int), np.array([0]), np.array([], dtype=int)]},
    )
    mesh = sg.Mesh.from_meshio(given)
    assert [name for name, _ in mesh.blocks] == ["tet4", "tri3"]
    assert mesh.node_sets["base"].tolist() == [0, 1, 2]
    assert mesh.cell_sets["bottom"].tolist() == [1]
    back = mesh.to_meshio()
    assert [block.type for block in back.cells] == ["tetra", "triangle"]
    assert back.cell_sets["bottom"][1].tolist() == [0]


@pytest.fixture
def gmsh() -> Any:
    gmsh: Any = pytest.importorskip("gmsh")
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    yield gmsh
    gmsh.finalize()


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("kind", ["tet", "hex"])
def test_gmsh_in_memory(gmsh: Any, order: int, kind: str) -> None:
    gmsh.model.add("box")
    gmsh.model.occ.addBox(0, 0, 0, 1, 2, 3)
    gmsh.model.occ.synchronize()
    if kind == "hex":
        gmsh.model.mesh.setTransfiniteAutomatic()
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 1.0)
    gmsh.model.addPhysicalGroup(3, [1], name="solid")
    faces = gmsh.model.getEntitiesInBoundingBox(-0.1, -0.1, -0.1, 1.1, 2.1, 0.1, 2)
    gmsh.model.addPhysicalGroup(2, [tag for _, tag in faces], name="bottom")
    gmsh.model.addPhysicalGroup(0, [1], 7)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(order)
    mesh = sg.Mesh.from_gmsh()
    names = {("tet", 1): "tet4", ("tet", 2): "tet10", ("hex", 1): "hex8", ("hex", 2): "hex20"}
    solid = names[kind, order]
    assert solid in mesh.cells
    assert len(mesh.cell_sets["solid"]) == len(mesh.cells[solid])
    blocks = np.concatenate([np.full(len(block), k) for k, (_, block) in enumerate(mesh.blocks)])
    bottom = mesh.cell_sets["bottom"]
    assert (blocks[bottom] > 0).all()
    assert len(mesh.node_sets["point_7"]) == 1
    if order == 2:
        # nodes inside of edges lie halfway between the corners that the order here gives them
        cells, points = mesh.cells[solid], mesh.points
        edges = {
            "tet10": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
            "hex20": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
        }[solid]
        for k, (a, b) in enumerate(edges):
            middle = 0.5 * (points[cells[:, a]] + points[cells[:, b]])
            assert np.allclose(points[cells[:, ELEMENTS[solid].nnode - len(edges) + k]], middle)


def test_gmsh_without_a_mesh_says_so(gmsh: Any) -> None:
    gmsh.model.add("empty")
    with pytest.raises(ValueError, match="has no mesh"):
        sg.Mesh.from_gmsh()


def test_gmsh_before_its_start_says_so() -> None:
    pytest.importorskip("gmsh")
    with pytest.raises(ValueError, match="gmsh.initialize"):
        sg.Mesh.from_gmsh()


@native
def test_a_missing_file_is_named() -> None:
    with pytest.raises(FileNotFoundError, match="nothing.msh"):
        sg.Mesh.read("nothing.msh")


@native
def test_a_grid_has_its_outer_faces_as_surfaces() -> None:
    x, y, z = [0.0, 1.0, 3.0], [0.0, 2.0], [-1.0, 0.0, 0.5, 1.0]
    for lines in ((x, y), (x, y, z)):
        mesh = sg.Mesh.grid(*lines)
        assert len(mesh.points) == np.prod([len(line) for line in lines])
        faces, centers, normals = mesh.boundary()
        found = {tuple(face): (center, normal) for face, center, normal in zip(faces, centers, normals, strict=True)}
        assert sum(len(mesh.surfaces[name]) for name in mesh.surfaces) == len(faces)
        for axis, line in enumerate(lines):
            for name, at, sign in (("min", line[0], -1.0), ("max", line[-1], 1.0)):
                for face in mesh.surfaces["xyz"[axis] + name]:
                    center, normal = found[tuple(face)]
                    assert center[axis] == at and normal[axis] == sign


def test_lines_of_a_grid_increase() -> None:
    with pytest.raises(ValueError, match="y has to be at least two increasing"):
        sg.Mesh.grid([0.0, 1.0], [0.0, 0.0])
