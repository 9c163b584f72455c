"""What tests share: meshes, and cases that need the Rust module."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import signorini as sg

ROOT = Path(__file__).resolve().parents[3]
EXAMPLES = ROOT / "examples"

HAS_NATIVE = importlib.util.find_spec("signorini._native") is not None
native = pytest.mark.skipif(not HAS_NATIVE, reason="the Rust module is not built")


def box(n: int = 2, size: float = 1.0, base: float = 0.0) -> sg.Mesh:
    """A cube of n x n x n hexahedra with sets head, base and foot (its lower face)."""
    line = np.linspace(0.0, size, n + 1)
    z, y, x = np.meshgrid(line + base, line, line, indexing="ij")
    points = np.ascontiguousarray(np.column_stack([x.ravel(), y.ravel(), z.ravel()]))
    first = np.array([i + (n + 1) * (j + (n + 1) * k) for k in range(n) for j in range(n) for i in range(n)])
    up, back = n + 1, (n + 1) ** 2
    corners = np.array([0, 1, up + 1, up, back, back + 1, back + up + 1, back + up])
    mesh = sg.Mesh(points, {"hex8": first[:, None] + corners})
    mesh.node_sets["head"] = mesh.nodes_where(lambda p: p[:, 2] > base + size - 1e-9)
    mesh.node_sets["base"] = mesh.nodes_where(lambda p: p[:, 2] < base + 1e-9)
    cells = np.flatnonzero(np.arange(n**3) // n**2 == 0)
    mesh.surfaces["foot"] = np.column_stack([np.zeros_like(cells), cells, np.zeros_like(cells)])
    return mesh


def pressed(mesh: sg.Mesh | None = None, depth: float = 0.01, increments: int = 2) -> sg.Case:
    """A cube pressed on a rigid plane."""
    case = sg.Case(box() if mesh is None else mesh, title="pressed cube", units="mm-N-MPa")
    case.body("all", sg.NeoHookean(E=6.0, nu=0.3))
    case.contact("foot", sg.Plane(normal=(0, 0, 1)), name="floor", friction=0.2)
    press = case.step("press", increments={"fixed": increments}, geometry="nonlinear")
    press.fix("head", "xy")
    press.move("head", z=-depth)
    return case


@pytest.fixture
def mesh() -> sg.Mesh:
    return box()


@pytest.fixture
def case() -> sg.Case:
    return pressed()
