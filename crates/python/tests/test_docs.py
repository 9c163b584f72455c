"""Every block of Python in docs/python.md and README.md runs."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from typing import Any

import pytest

from .conftest import EXAMPLES, ROOT, native

PAGES = {"docs/python.md": 10, "README.md": 1}
"""Pages, and how many blocks they have at least."""


def blocks(page: str) -> list[tuple[int, str]]:
    """The blocks of Python, each with the line where it begins."""
    text = (ROOT / page).read_text(encoding="utf-8")
    found = re.finditer(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    return [(text.count("\n", 0, block.start(1)) + 1, block.group(1)) for block in found]


@native
@pytest.mark.parametrize("page", PAGES)
def test_blocks_of_a_page_run_in_order(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copy(EXAMPLES / "python" / "blocks.inp", tmp_path)
    monkeypatch.chdir(tmp_path)
    namespace: dict[str, Any] = {}
    found = blocks(page)
    assert len(found) >= PAGES[page]
    for line, source in found:
        # blank lines above, so that a traceback names the line of the page
        exec(compile("\n" * (line - 1) + source, str(ROOT / page), "exec"), namespace)
