"""Every example of the repository, built in Python from its mesh in memory, gives the same bits as by its TOML."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import signorini as sg

from .conftest import EXAMPLES, native

pytestmark = native

SLOW: set[str] = set()
"""Examples that run only with SIGNORINI_LONG_TESTS."""

CASES = sorted(EXAMPLES.glob("*/case.toml"))


def rebuilt(case: sg.Case) -> sg.Case:
    """The same case, key by key, over a mesh of arrays."""
    old = case.mesh
    mesh = sg.Mesh(
        np.array(old.points),
        [(name, np.array(block)) for name, block in old.blocks],
        dict(old.node_sets),
        dict(old.cell_sets),
        dict(old.surfaces),
        node_labels=old.node_labels,
        cell_labels=old.cell_labels,
    )
    new = sg.Case(mesh)
    new.update({key: value for key, value in case.to_dict().items()})
    assert new.mesh.file is None
    return new


def same(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether all bits agree."""
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def same_results(one: sg.Result, other: sg.Result) -> None:
    assert len(one) == len(other) > 1
    assert one.history.text == other.history.text
    for a, b in zip(one, other, strict=True):
        assert (a.time, a.increment) == (b.time, b.increment)
        assert a.names == b.names and a.cell_names == b.cell_names
        for name in a.names:
            assert same(a[name], b[name]), f"{name} at {a.time}"
        for name in a.cell_names:
            assert same(a.cell(name), b.cell(name)), f"{name} of cells at {a.time}"
        assert list(a.contact) == list(b.contact)
        for name in a.contact:
            for array in ("pressure", "gap", "slip", "traction", "status", "nodal_force"):
                assert same(np.asarray(getattr(a.contact[name], array)), np.asarray(getattr(b.contact[name], array)))


def test_all_examples_are_found() -> None:
    assert len(CASES) >= 23


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.parent.name)
def test_examples_give_the_same_bits_from_python(path: Path, tmp_path: Path) -> None:
    if path.parent.name in SLOW and not os.environ.get("SIGNORINI_LONG_TESTS"):
        pytest.skip("long: set SIGNORINI_LONG_TESTS")
    case = sg.load(path)
    by_toml = case.run(tmp_path / "toml")
    in_python = rebuilt(case).run(tmp_path / "python")
    assert by_toml.ok and in_python.ok
    same_results(by_toml, in_python)
    same_results(sg.open(tmp_path / "toml"), sg.open(tmp_path / "python"))


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.parent.name)
def test_examples_survive_toml(path: Path, tmp_path: Path) -> None:
    case = sg.load(path)
    inline = rebuilt(case)
    inline.to_toml(tmp_path / "inline.toml")
    case.to_toml(tmp_path / "file.toml")
    again, file = sg.load(tmp_path / "inline.toml"), sg.load(tmp_path / "file.toml")
    if case.mesh.file is not None:
        assert file.to_dict() == case.to_dict()
        assert file.mesh.file == case.mesh.file
    assert same(again.mesh.points, case.mesh.points)
    # sets of the mesh in place have become sets of the case
    left = {key: value for key, value in again.to_dict().items() if key != "sets"}
    assert left == {key: value for key, value in case.to_dict().items() if key != "sets"}
    assert set(case.mesh.set_names) <= {*again.mesh.set_names, *again.sets}


@pytest.mark.parametrize("name", ["paper_brick_symmetric_3d", "twisting_blocks_3d_mortar", "two_blocks_2d"])
def test_written_toml_runs_to_the_same_bits(name: str, tmp_path: Path) -> None:
    case = sg.load(EXAMPLES / name / "case.toml")
    rebuilt(case).to_toml(tmp_path / "case.toml")
    by_file = sg.load(tmp_path / "case.toml").run(save=False)
    assert by_file.history.text == case.run(save=False).history.text
