"""Arrays of results are read-only views of the memory of the Rust module."""

from __future__ import annotations

import gc
import resource
import sys
from pathlib import Path

import numpy as np
import pytest

import signorini as sg

from .conftest import box, native, pressed

pytestmark = native


@pytest.fixture(scope="module")
def result() -> sg.Result:
    return pressed().run(save=False)


def test_a_run_gives_frames_and_a_history(result: sg.Result) -> None:
    assert result.ok and result.exit_code == 0
    assert [frame.increment for frame in result] == [0, 1, 2]
    assert result[-1]["displacement"].shape == (27, 3)
    assert result[-1]["stress"].shape == (27, 6)
    assert result.history["floor.force_z"].shape == (2,)
    force = result[-1].contact["floor"].force
    assert force[2] > 0.0
    assert result.contact["floor"].force[-1] == pytest.approx(force, abs=1e-12)
    assert result[-1].contact["floor"].nodal_force.sum(axis=0) == pytest.approx(force, abs=1e-9)


def test_arrays_share_memory(result: sg.Result) -> None:
    frame = result[-1]
    for name in ("displacement", "reaction_force", "contact_pressure"):
        assert np.shares_memory(frame[name], frame[name]), name
    contact = frame.contact["floor"]
    assert np.shares_memory(contact.pressure, frame.contact["floor"].pressure)


def test_writing_raises(result: sg.Result) -> None:
    frame = result[-1]
    for name in frame.names:
        with pytest.raises(ValueError, match="read-only"):
            frame[name][0] = 0
    with pytest.raises(ValueError, match="read-only"):
        frame.contact["floor"].pressure[0] = 0.0


def test_arrays_outlive_their_frame() -> None:
    found = pressed().run(save=False)
    u = found[-1]["displacement"]
    kept = np.array(u)
    del found
    gc.collect()
    assert np.array_equal(u, kept)


def test_unknown_names_propose_the_closest(result: sg.Result) -> None:
    with pytest.raises(KeyError, match="did you mean 'displacement'"):
        _ = result[-1]["displacment"]
    with pytest.raises(KeyError, match="did you mean 'floor'"):
        _ = result[-1].contact["flor"]


def test_a_native_mesh_shares_its_points() -> None:
    native_mesh = box().native()
    mesh = sg.Mesh.from_native(native_mesh)
    assert np.shares_memory(mesh.points, native_mesh.points)
    assert np.array_equal(mesh.points, box().points)
    assert mesh.node_sets["head"].tolist() == box().node_sets["head"].tolist()
    assert mesh.surfaces["foot"].tolist() == box().surfaces["foot"].tolist()


def test_faces_by_predicate() -> None:
    mesh = box()
    foot = mesh.faces_where(lambda c: c[:, 2] < 1e-9)
    assert sorted(foot.tolist()) == sorted(mesh.surfaces["foot"].tolist())
    assert sorted(mesh.faces_where(normal=(0, 0, -1)).tolist()) == sorted(foot.tolist())
    _, _, normals = mesh.boundary()
    assert len(normals) == 24 and np.allclose(np.linalg.norm(normals, axis=1), 1.0)
    with pytest.raises(ValueError, match="24 booleans"):
        mesh.faces_where(lambda c: c[0])


def test_the_native_mesh_is_kept_until_a_set_changes() -> None:
    mesh = box()
    first = mesh.native()
    assert mesh.native() is first
    mesh.node_sets["more"] = [0]
    assert mesh.native() is not first


def test_a_folder_reads_back_as_what_was_computed(tmp_path: Path) -> None:
    case = pressed()
    result = case.run(tmp_path / "out")
    again = sg.open(tmp_path / "out")
    assert again.ok and len(again) == len(result)
    assert again.history.text == result.history.text
    for a, b in zip(result, again, strict=True):
        assert a.step == b.step or a.increment == 0
        assert np.array_equal(a["displacement"], b["displacement"])
        assert np.array_equal(a["stress"], b["stress"])
        one, other = a.contact["floor"], b.contact["floor"]
        for name in ("gap", "pressure", "slip", "area", "points", "nodes", "status", "nodal_force"):
            assert np.allclose(getattr(one, name), getattr(other, name), equal_nan=True), name
        if a.increment:
            assert np.allclose(one.force, other.force) and one.radius == pytest.approx(other.radius)
            assert np.allclose(one.center, other.center)
    assert again.summary == result.summary
    assert np.array_equal(again.mesh.points, case.mesh.points)  # type: ignore[union-attr]  # pyright: ignore


def test_a_folder_has_the_findings_of_its_run(tmp_path: Path) -> None:
    case = pressed()
    case.units = "mm"
    runs = case.run(tmp_path / "out"), sg.open(tmp_path / "out")
    found, again = ([(one.severity, one.code, one.line) for one in run.diagnostics] for run in runs)
    assert again == found and ("warning", "S0403") in [one[:2] for one in again]


def test_frames_go_to_pyvista_and_meshio(result: sg.Result) -> None:
    pytest.importorskip("pyvista")
    pytest.importorskip("meshio")
    grid = result[-1].to_pyvista(warp=1.0)
    assert np.allclose(grid.points, result[-1].points + result[-1]["displacement"])
    assert set(result[-1].names) <= set(grid.point_data.keys())
    assert result[-1].to_meshio().cell_data["von_mises"][0].shape == (8,)
    assert result[-1].contact["floor"].to_pyvista().n_points == 9
    assert result.to_pyvista().n_blocks == 3


def test_frames_are_drawn(result: sg.Result, tmp_path: Path) -> None:
    pv = pytest.importorskip("pyvista")
    path = result[-1].screenshot(tmp_path / "p.png", "contact_pressure", warp=1.0)
    assert Path(path).read_bytes().startswith(b"\x89PNG")
    result[-1].screenshot(tmp_path / "u.png", "displacement", component=2)
    plotter = result[-1].plotter("contact_pressure", warp=2.0, off_screen=True)
    assert isinstance(plotter, pv.Plotter)
    plotter.close()


def test_frames_become_an_animation(result: sg.Result, tmp_path: Path) -> None:
    pytest.importorskip("pyvista")
    image = pytest.importorskip("PIL.Image")
    path = result.animate(tmp_path / "p.gif", "contact_pressure", size=(200, 150), fps=10.0)
    with image.open(path) as picture:
        assert (picture.n_frames, picture.size, picture.info["duration"]) == (len(result), (200, 150), 100)
    with image.open(result.animate(tmp_path / "u.png", "displacement", every=2, size=(200, 150))) as picture:
        assert picture.n_frames == len(result[::2]) > 1
    with pytest.raises(ValueError, match=r"animations end in .gif, .webp, .png, found"):
        result.animate(tmp_path / "p.mp4")
    with pytest.raises(KeyError, match="did you mean 'contact_pressure'"):
        result.animate(tmp_path / "p.gif", "pressure")


def test_an_animation_has_one_range_and_one_view(result: sg.Result) -> None:
    from signorini import _animation

    low, high = _animation.limits(result, "displacement", None)
    largest = max(np.linalg.norm(frame["displacement"], axis=1).max() for frame in result)
    assert (low, high) == (0.0, pytest.approx(largest)) and largest > 0.0
    low, high = _animation.limits(result, "displacement", 2)
    assert low == pytest.approx(min(frame["displacement"][:, 2].min() for frame in result)) and low < high
    box = _animation.bounds(result, 1.0)
    for frame in result:
        places = frame.points + frame["displacement"]
        assert (places >= np.array(box[::2]) - 1e-12).all() and (places <= np.array(box[1::2]) + 1e-12).all()


def test_contacts_are_drawn_alone(result: sg.Result, tmp_path: Path) -> None:
    pytest.importorskip("pyvista")
    contact = result[-1].contact["floor"]
    assert Path(contact.screenshot(tmp_path / "p.png")).read_bytes().startswith(b"\x89PNG")
    contact.screenshot(tmp_path / "t.png", "traction", component=2)
    plotter = contact.plotter("contact_gap", off_screen=True)
    assert plotter.mesh.n_cells == 4 and plotter.mesh.active_scalars_name == "contact_gap"
    plotter.close()


def test_unknown_fields_are_named_before_a_plot(result: sg.Result) -> None:
    pytest.importorskip("pyvista")
    with pytest.raises(KeyError, match="did you mean 'contact_pressure'"):
        result.plot("pressure")
    with pytest.raises(KeyError, match="did you mean 'pressure'"):
        result[-1].contact["floor"].plot("presure")


def test_results_show_themselves(result: sg.Result) -> None:
    assert "3 frames" in repr(result)
    assert "<svg" in result._repr_html_()
    assert "floor" in repr(result[-1].contact["floor"])
    assert "hex8" in str(pressed().check())


def test_results_show_their_warnings(result: sg.Result) -> None:
    assert repr(result).endswith(", 1 warning>")
    assert "warning S0414" in result._repr_html_()
    case = pressed()
    case.allow = ["S0414"]
    assert "warning" not in repr(case.run(save=False))


@pytest.mark.skipif(sys.platform != "linux", reason="reads the memory of the process")
def test_a_thousand_runs_leak_less_than_a_megabyte() -> None:
    mesh = box(1)
    case = pressed(mesh, increments=1)

    def memory() -> int:
        gc.collect()
        return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()

    def once() -> None:
        result = case.run(save=False, threads=1)
        assert result.ok and result[-1]["displacement"].shape == (8, 3)
        _ = result[-1].contact["floor"].pressure, result.history["floor.force_z"]

    for _ in range(200):
        once()
    before = memory()
    for _ in range(1000):
        once()
    assert memory() - before < 1 << 20


def test_without_a_display_a_plot_opens_no_window(result: sg.Result, monkeypatch: pytest.MonkeyPatch) -> None:
    pyvista = pytest.importorskip("pyvista")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    made: list[bool | None] = []
    plotter = pyvista.Plotter

    def make(*, off_screen: bool | None) -> object:
        made.append(off_screen)
        return plotter(off_screen=True)

    monkeypatch.setattr(pyvista, "Plotter", make)
    result[-1].plot("contact_pressure", warp=1.0)
    assert made == [True if sys.platform.startswith("linux") else None]
    monkeypatch.setenv("DISPLAY", ":99")
    result[-1].plot("contact_pressure")
    # PyVista's own setting decides
    assert made[-1] is None
