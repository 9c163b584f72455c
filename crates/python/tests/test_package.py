"""The package as a whole: what importing it costs, and what it needs."""

from __future__ import annotations

import subprocess
import sys

import pytest

import signorini as sg


def run(code: str) -> str:
    return subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.strip()


def test_importing_needs_nothing() -> None:
    loaded = run("import sys, signorini; print([m for m in sys.modules if 'numpy' in m or m.startswith('signorini.')])")
    assert loaded == "[]"


def test_building_a_case_needs_no_optional_package() -> None:
    code = "import sys, signorini as sg; sg.Case(); sg.Mesh, sg.Result, sg.run_many; print(sorted(sys.modules))"
    loaded = run(code)
    for name in ("pandas", "polars", "pyvista", "vtk", "meshio", "gmsh", "matplotlib", "ipywidgets", "IPython"):
        assert f"'{name}'" not in loaded


def test_all_names_exist() -> None:
    for name in sg.__all__:
        if name != "__version__":
            assert getattr(sg, name) is not None
    assert set(sg.__all__) <= set(dir(sg))
    with pytest.raises(AttributeError, match="no attribute 'Mehs'"):
        _ = sg.Mehs  # type: ignore[attr-defined]  # pyright: ignore


def test_a_missing_package_says_how_to_install_it() -> None:
    code = """
import sys
sys.modules["pyvista"] = None
import signorini as sg
try:
    sg.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], {"tet4": [[0, 1, 2, 3]]}).to_pyvista()
except ImportError as error:
    print(error)
"""
    assert run(code) == 'Mesh.to_pyvista needs pyvista: pip install "signorini[viz]"'
