"""The scripts and notebooks of examples/python run, and what they assert holds."""

from __future__ import annotations

import ast
import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from .conftest import EXAMPLES, native

FOLDER = EXAMPLES / "python"
SCRIPTS = sorted(path.name for path in FOLDER.glob("*.py"))
NOTEBOOKS = sorted(path.name for path in FOLDER.glob("*.ipynb"))
ALWAYS_THERE = {"signorini", "numpy"}
SECONDS = 300


def imported(source: str) -> set[str]:
    """The top-level packages that a source imports."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module is not None:
            names.add(node.module.partition(".")[0])
    return names


def skip_without(*packages: str) -> None:
    """Skips a test where an optional package is missing, and names it."""
    missing = [name for name in packages if name not in ALWAYS_THERE and importlib.util.find_spec(name) is None]
    if missing:
        pytest.skip(f"needs {', '.join(missing)}")


def cells(name: str) -> list[dict[str, Any]]:
    """The cells of a notebook."""
    return json.loads((FOLDER / name).read_text(encoding="utf-8"))["cells"]


def code(name: str) -> str:
    """The code of a notebook."""
    return "\n".join("".join(cell["source"]) for cell in cells(name) if cell["cell_type"] == "code")


def test_there_are_ten_scripts_and_three_notebooks() -> None:
    assert len(SCRIPTS) == 10 and len(NOTEBOOKS) == 3
    readme = (FOLDER / "README.md").read_text(encoding="utf-8")
    for name in SCRIPTS + NOTEBOOKS:
        assert f"[{name}]({name})" in readme, name


@pytest.mark.parametrize("name", SCRIPTS)
def test_scripts_are_short_and_check_their_result(name: str) -> None:
    source = (FOLDER / name).read_text(encoding="utf-8")
    tree = ast.parse(source)
    assert ast.get_docstring(tree), "a script says what it shows"
    assert any(isinstance(node, ast.Assert) for node in ast.walk(tree)), "a script checks its result"
    lines = [line for line in source.splitlines() if line.strip()]
    assert 10 <= len(lines) <= 40 and max(map(len, lines)) <= 120


@native
@pytest.mark.parametrize("name", SCRIPTS)
def test_scripts_run(name: str, tmp_path: Path) -> None:
    skip_without(*imported((FOLDER / name).read_text(encoding="utf-8")))
    environment = {**os.environ, "MPLBACKEND": "Agg", "TMPDIR": str(tmp_path), "TEMP": str(tmp_path)}
    ended = subprocess.run(
        [sys.executable, str(FOLDER / name)],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=SECONDS,
    )
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert ended.stdout.strip(), "a script prints what it found"


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_notebooks_are_without_outputs(name: str) -> None:
    for cell in cells(name):
        assert not cell.get("outputs") and cell.get("execution_count") is None


@native
@pytest.mark.parametrize("name", NOTEBOOKS)
def test_notebooks_run(name: str, tmp_path: Path) -> None:
    skip_without("nbclient", "nbformat", "ipykernel", *imported(code(name)))
    client: Any = importlib.import_module("nbclient")
    formats: Any = importlib.import_module("nbformat")
    notebook = formats.read(FOLDER / name, as_version=4)
    formats.validate(notebook)
    resources = {"metadata": {"path": str(tmp_path)}}
    client.NotebookClient(notebook, timeout=SECONDS, kernel_name="python3", resources=resources).execute()
