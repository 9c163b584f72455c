"""The programs that users start from: a mesh of Gmsh in memory, a study, a case from a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import signorini as sg

from .conftest import EXAMPLES, native

pytestmark = native


def corners(gmsh: Any, face: int) -> Any:
    """The corners of the box around a face."""
    return np.reshape(np.array(gmsh.model.getBoundingBox(2, face)), (2, 3))


def hertz(gmsh: Any) -> None:
    """A quarter of a ball of radius 10 over a quarter of a block, with named groups."""
    occ = gmsh.model.occ
    ball = occ.addSphere(0, 0, 10, 10, angle1=-np.pi / 2, angle2=0, angle3=np.pi / 2)
    block = occ.addBox(0, 0, -6, 6, 6, 6)
    occ.synchronize()

    gmsh.model.addPhysicalGroup(3, [ball], name="sphere")
    gmsh.model.addPhysicalGroup(3, [block], name="block")
    faces = {v: [tag for _, tag in gmsh.model.getBoundary([(3, v)], oriented=False)] for v in (ball, block)}
    boxes = {tag: corners(gmsh, tag) for tags in faces.values() for tag in tags}

    def group(name: str, kept: list[int]) -> None:
        assert kept, name
        gmsh.model.addPhysicalGroup(2, kept, name=name)

    group("sphere_surface", [t for t in faces[ball] if (boxes[t][1] - boxes[t][0]).min() > 1.0])
    group("sphere_top", [t for t in faces[ball] if boxes[t][0, 2] > 9.9])
    group("block_top", [t for t in faces[block] if boxes[t][0, 2] > -0.1])
    group("block_bottom", [t for t in faces[block] if boxes[t][1, 2] < -5.9])
    group("sym_x", [t for t, box in boxes.items() if box[1, 0] < 0.1])
    group("sym_y", [t for t, box in boxes.items() if box[1, 1] < 0.1])
    near = gmsh.model.mesh.field.add("Ball")
    for key, value in {"Radius": 1.3, "VIn": 0.14, "VOut": 2.5, "Thickness": 6.0}.items():
        gmsh.model.mesh.field.setNumber(near, key, value)
    gmsh.model.mesh.field.setAsBackgroundMesh(near)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)


def test_gmsh_in_memory_to_a_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    gmsh: Any = pytest.importorskip("gmsh")
    monkeypatch.chdir(tmp_path)
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        hertz(gmsh)
        gmsh.model.mesh.generate(3)
        mesh = sg.Mesh.from_gmsh()
    finally:
        gmsh.finalize()

    polymer = sg.LinearElastic(E=1000.0, nu=0.3)
    case = sg.Case(mesh, units="mm-N-MPa")
    case.body(["sphere", "block"], polymer)
    case.contact("sphere_surface", "block_top", name="ball")

    press = case.step("press", increments=10)
    press.fix("block_bottom", "z")
    press.fix("sym_x", "x")
    press.fix("sym_y", "y")
    press.load("sphere_top", force=(0, 0, -25.0), coupling="rigid-z")

    assert "ball" in str(case.check())
    res = case.run("hertz.out")

    ball = res[-1].contact["ball"]
    assert ball.force[2] == pytest.approx(25.0, rel=1e-6)
    # half-space theory: p0 = 38.80, a = 1.109; the mesh is coarse
    assert ball.pressure.max() == pytest.approx(38.80, rel=0.08)
    assert ball.radius == pytest.approx(1.109, rel=0.06)
    assert (tmp_path / "hertz.out" / "results.pvd").is_file()


def test_a_study_over_friction() -> None:
    pv: Any = pytest.importorskip("pyvista")
    block = pv.ImageData(dimensions=(9, 9, 9), spacing=(2.5, 2.5, 2.5)).cast_to_unstructured_grid()
    mesh = sg.Mesh.from_pyvista(block)
    z = mesh.points[:, 2]
    mesh.node_sets["head"] = np.flatnonzero(z > z.max() - 1e-9)
    mesh.surfaces["foot"] = mesh.faces_where(lambda c: c[:, 2] < 1e-9)

    def build(mu: float) -> sg.Case:
        c = sg.Case(mesh, units="mm-N-MPa")
        c.body("all", sg.NeoHookean(E=6.0, nu=0.45))
        c.contact("foot", sg.Plane(normal=(0, 0, 1)), friction=mu, name="floor")
        press = c.step("press", increments=5, geometry="nonlinear")
        press.fix("head", "xy")
        press.move("head", z=-0.4)
        drag = c.step("drag", increments=(0.02, 1e-6, 0.05))
        drag.move("head", x=8.0)
        return c

    mus = np.linspace(0.0, 0.6, 3)
    runs = sg.run_many([build(m) for m in mus], save=False)
    pull = np.array([r.history["floor.force_x"][-1] if r.ok else np.nan for r in runs])
    push = np.array([r.history["floor.force_z"][-1] if r.ok else np.nan for r in runs])
    assert np.isfinite(pull).all()
    assert np.allclose(np.abs(pull), mus * push, rtol=1e-2, atol=1e-6 * push.max())


def test_a_case_from_a_file_watched_and_stopped(tmp_path: Path) -> None:
    case = sg.load(EXAMPLES / "friction_loop_3d_node_to_segment" / "case.toml")
    name = case.contacts[0].name or ""
    case.contacts[name].friction = 0.5
    seen: list[float] = []

    def watch(inc: sg.Increment) -> bool:
        seen.append(float(np.abs(inc.contact[name].slip).max()))
        assert inc.step and inc.time > 0 and inc.newton_iterations >= 0 and inc.contact[name].force.shape == (3,)
        return len(seen) == 4

    res = case.run(tmp_path / "out", on_increment=watch)
    assert len(seen) == 4 and res.history.nrow == 4
    h = res.history
    assert h[f"{name}.force_x"].shape == h["time"].shape
    for frame in sg.open(tmp_path / "out"):
        assert frame["displacement"].shape == (len(frame.points), 3)
