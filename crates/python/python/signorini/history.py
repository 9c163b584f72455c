"""Columns over the increments of a run, as arrays."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _html
from ._optional import need
from ._table import did_you_mean

WORDS = ("step", "worst_node")
COUNTS = ("increment", "iterations", "attempt", "iteration", "closed", "flips")


class History(Mapping[str, NDArray[Any]]):
    """Columns by name, one row for each converged increment: `history["floor.force_x"]`.

    >>> history = History("time,step,increment,iterations,floor.force_x\\n0.5,press,1,3,-1.5\\n")
    >>> history["floor.force_x"]
    array([-1.5])
    >>> history.columns
    ['time', 'step', 'increment', 'iterations', 'floor.force_x']
    """

    def __init__(self, text: str = "") -> None:
        self._text = text
        self._columns: dict[str, NDArray[Any]] | None = None

    def _read(self) -> dict[str, NDArray[Any]]:
        if self._columns is None:
            lines = (line for line in io.StringIO(self._text) if not line.startswith("#"))
            rows = list(csv.reader(lines))
            head = rows[0] if rows else []
            cells = [row for row in rows[1:] if len(row) == len(head)]
            self._columns = {name: _column(name, [row[k] for row in cells]) for k, name in enumerate(head)}
        return self._columns

    @property
    def columns(self) -> list[str]:
        """The names of the columns."""
        return list(self._read())

    @property
    def text(self) -> str:
        """The columns as comma-separated values."""
        return self._text

    def __getitem__(self, name: str) -> NDArray[Any]:
        columns = self._read()
        if name not in columns:
            raise KeyError(f"the history has no column {name!r}{did_you_mean(name, columns)}")
        return columns[name]

    def __contains__(self, name: object) -> bool:
        return name in self._read()

    def __iter__(self) -> Iterator[str]:
        return iter(self._read())

    def __len__(self) -> int:
        return len(self._read())

    @property
    def nrow(self) -> int:
        """The number of rows."""
        return len(next(iter(self._read().values()), ()))

    def to_pandas(self) -> Any:
        """A data frame of pandas."""
        return need("pandas", "History.to_pandas").DataFrame(dict(self._read()))

    def to_polars(self) -> Any:
        """A data frame of Polars."""
        return need("polars", "History.to_polars").DataFrame(
            {name: column.tolist() if name in WORDS else np.array(column) for name, column in self._read().items()}
        )

    def __repr__(self) -> str:
        return f"<History: {self.nrow} rows of {', '.join(self.columns[:8])}{', …' if len(self) > 8 else ''}>"

    def _repr_html_(self) -> str:
        rows = list(zip(*(column[-10:] for column in self._read().values()), strict=True))
        shown = [[f"{cell:.6g}" if isinstance(cell, float) else cell for cell in row] for row in rows]
        return _html.document(f"History: {self.nrow} rows", shown, self.columns)


def _column(name: str, cells: list[str]) -> NDArray[Any]:
    if name in WORDS:
        column = np.array(cells, dtype=object)
    elif name in COUNTS:
        column = np.array([int(cell or 0) for cell in cells], dtype=np.int64)
    else:
        column = np.array([float(cell) if cell else np.nan for cell in cells], dtype=np.float64)
    column.flags.writeable = False
    return column
