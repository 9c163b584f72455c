"""Docstrings that list the keys a method takes."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import TypeVar

from ._table import Table

F = TypeVar("F", bound=Callable[..., object])


def documented(table: type[Table], *skipped: str) -> Callable[[F], F]:
    """Adds the keys of a table, with what they take and their units, to the docstring of a method."""

    def add(function: F) -> F:
        lines: list[str] = []
        for name, key in table._attributes.items():
            if name in skipped:
                continue
            default = "" if key.default is None else f", default {key.default!r}"
            lines.append(f"{name}: {key.doc} ({key.values}{default})")
        function.__doc__ = "\n".join([inspect.cleandoc(function.__doc__ or ""), "", "Keys", "----", *lines])
        return function

    return add
