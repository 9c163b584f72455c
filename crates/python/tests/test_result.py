"""Results: the history, radii, and what failed."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import signorini as sg
from signorini.result import ContactFrame, Result

from .conftest import pressed

TEXT = """time,step,increment,iterations,a.b.force_x,a.b.force_y,a.b.force_z,a.b.pressure_max,a.b.gap_min
0.5,"press, then",1,3,1.0,0.0,-2.0,3.5,0.0
1.0,"press, then",2,4,2.0,0.0,-4.0,,1e-3
"""


def test_a_history_has_columns_of_their_type() -> None:
    history = sg.History(TEXT)
    assert history["time"].tolist() == [0.5, 1.0]
    assert history["step"].tolist() == ["press, then"] * 2
    assert history["increment"].dtype == np.int64
    assert np.isnan(history["a.b.pressure_max"][1])
    with pytest.raises(KeyError, match="did you mean"):
        _ = history["a.b.force_w"]
    with pytest.raises(ValueError, match="read-only"):
        history["time"][0] = 0.0


def test_a_row_that_is_being_written_is_left_out() -> None:
    assert sg.History(TEXT + "1.5,press,3").nrow == 2


def test_contacts_over_time() -> None:
    result = Result(history=TEXT)
    assert result.contact["a.b"].force.tolist() == [[1.0, 0.0, -2.0], [2.0, 0.0, -4.0]]
    assert result.contact["a.b"].gap_min.tolist() == [0.0, 1e-3]
    assert result.contact["a.b"]["gap_min"] is result.history["a.b.gap_min"]
    assert repr(result.contact) == "<histories of a.b>"
    with pytest.raises(KeyError):
        _ = result.contact["b"]
    with pytest.raises(AttributeError, match="did you mean 'gap_min'"):
        _ = result.contact["a.b"].gap_mim


def test_a_history_becomes_a_data_frame() -> None:
    pandas = pytest.importorskip("pandas")
    frame = sg.History(TEXT).to_pandas()
    assert isinstance(frame, pandas.DataFrame) and frame["time"].iloc[-1] == 1.0


def test_a_history_becomes_a_data_frame_of_polars() -> None:
    pytest.importorskip("polars")
    assert sg.History(TEXT).to_polars()["step"].to_list() == ["press, then"] * 2


def disc(angle: float, n: int = 400) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Midpoints, areas and pressures of a sector of a disc of radius 2 about its apex."""
    r = (np.arange(n) + 0.5) * 2.0 / n
    t = (np.arange(n) + 0.5) * angle / n
    rr, tt = np.meshgrid(r, t)
    points = np.column_stack([(rr * np.cos(tt)).ravel(), (rr * np.sin(tt)).ravel(), np.zeros(n * n)])
    area = (rr * 2.0 / n * angle / n).ravel()
    return np.vstack([[0, 0, 0], points]), np.r_[0.0, area], np.sqrt(np.maximum(0, 1 - np.r_[0.0, rr.ravel()] ** 2 / 4))


@pytest.mark.parametrize("angle", [0.5 * np.pi, np.pi, 2 * np.pi])
def test_the_radius_is_that_of_a_disc_and_of_its_sectors(angle: float) -> None:
    points, area, pressure = disc(angle)
    source = SimpleNamespace(points=points, area=area, pressure=pressure, status=np.full(len(area), 2))
    assert ContactFrame(source).radius == pytest.approx(2.0, rel=1e-5)


def test_the_radius_of_a_line_contact_is_its_half_width() -> None:
    x = np.linspace(-1.5, 1.5, 3001)
    source = SimpleNamespace(
        points=np.column_stack([x, 0 * x, 0 * x]),
        area=np.full(len(x), 1e-3),
        pressure=1 - x**2 / 2.25,
        status=np.ones(len(x)),
    )
    assert ContactFrame(source, "plane-strain").radius == pytest.approx(1.5, rel=1e-3)


def test_the_radius_of_an_open_contact_is_zero() -> None:
    source = SimpleNamespace(points=np.zeros((2, 3)), area=np.ones(2), pressure=np.zeros(2), status=np.zeros(2))
    assert ContactFrame(source).radius == 0.0


def test_a_failed_run_is_a_result() -> None:
    error = sg.InputError([{"severity": "error", "code": "S0102", "message": "unknown key"}])
    result = Result.failed(error)
    assert not result.ok and result.exit_code == 3 and result.error is error and len(result) == 0
    with pytest.raises(IndexError, match="no frames"):
        _ = result[-1]


def test_errors_print_their_diagnostics() -> None:
    found = {
        "severity": "error",
        "code": "S0102",
        "message": "unknown key `x`",
        "file": "a.toml",
        "line": 3,
        "column": 1,
    }
    error = sg.InputError.of([found])
    assert "error[S0102]: unknown key `x`" in str(error) and "a.toml:3:1" in str(error)
    assert error.diagnostics[0].line == 3 and error.diagnostics[0]["code"] == "S0102"
    assert issubclass(sg.NotConverged, sg.SignoriniError)
    model = sg.ModelError.of(
        [{"code": "S0302", "message": "m", "motions": ["slide along z"], "elements": [7]}]
    )
    assert isinstance(model, sg.ModelError)
    assert model.free_modes == ["slide along z"] and model.bad_elements == [7]


def test_the_report_is_a_page_of_the_saved_run(tmp_path: Path) -> None:
    result = pressed().run(str(tmp_path / "out"), progress=False)
    path = result.report(tmp_path / "report.html")
    page = Path(path).read_text(encoding="utf-8")
    assert page.lstrip().lower().startswith("<!doctype html>") and "pressed cube" in page
    other = pressed(depth=0.02).run(str(tmp_path / "other"), progress=False)
    compared = Path(other.report(tmp_path / "both.html", compare=tmp_path / "out")).read_text(encoding="utf-8")
    assert len(compared) > 0 and compared != page
    again = Path(other.report(tmp_path / "again.html", compare=result)).read_text(encoding="utf-8")
    assert again == compared


def test_no_report_without_a_folder(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="in memory only"):
        pressed().run(save=False).report(tmp_path / "report.html")
    assert not (tmp_path / "report.html").exists()
