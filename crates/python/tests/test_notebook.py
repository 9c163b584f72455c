"""What notebooks and terminals show."""

from __future__ import annotations

import sys
from typing import Any

import pytest

from signorini import notebook

from .conftest import box, pressed

EVENTS: list[dict[str, Any]] = [
    {"ev": "start", "nodes": 27},
    {"ev": "iteration", "step": "press", "inc": 1, "iter": 1, "residual": 0.1},
    {"ev": "iteration", "step": "press", "inc": 1, "iter": 2, "residual": 0.0},
    {"ev": "increment", "step": "press", "inc": 1, "time": 0.5, "contact": {"floor": {"force": [0.0, 3.0, 4.0]}}},
    {"ev": "end", "status": "solved"},
]


def test_nothing_is_shown_where_nobody_looks() -> None:
    assert notebook.listener(pressed(), False) is None
    if not sys.stderr.isatty():
        assert notebook.listener(pressed(), None) is None


def test_a_log_has_a_line_for_each_step(capsys: pytest.CaptureFixture[str]) -> None:
    shown = notebook.listener(pressed(), True)
    assert isinstance(shown, notebook.Text)
    for event in EVENTS:
        shown.hear(event)
    shown.close()
    assert capsys.readouterr().err.splitlines() == [" press ━━━━━━━━━━            50%  inc 1  time 0.5"]


def test_a_notebook_gets_a_plot(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("ipywidgets")
    pytest.importorskip("matplotlib")
    monkeypatch.setattr(notebook, "in_notebook", lambda: True)
    shown = notebook.listener(pressed(), None)
    assert isinstance(shown, notebook.LivePlot)
    for event in EVENTS:
        shown.hear(event)
    shown.close()
    assert bytes(shown._image.value).startswith(b"\x89PNG")
    assert shown._bar.value == 0.5 and shown._forces == {"floor": [5.0]}


def test_a_picture_of_nothing_is_empty() -> None:
    assert notebook.thumbnail(None) == ""


def test_pictures_follow_displacements() -> None:
    mesh = box()
    moved = mesh.points * 0.0
    moved[:, 2] = mesh.points[:, 2]
    assert notebook.thumbnail(mesh, moved) != notebook.thumbnail(mesh)
