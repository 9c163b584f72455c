"""Small tables in HTML for notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

STYLE = "text-align:left;padding:2px 10px 2px 0;vertical-align:top"


def table(rows: Iterable[Sequence[object]], head: Sequence[str] = ()) -> str:
    """Rows as a table; their cells are escaped."""
    top = "".join(f'<th style="{STYLE}">{escape(name)}</th>' for name in head)
    body = "".join(
        "<tr>" + "".join(f'<td style="{STYLE}">{escape(str(cell))}</td>' for cell in row) + "</tr>" for row in rows
    )
    return f"<table>{f'<tr>{top}</tr>' if top else ''}{body}</table>"


def document(title: str, rows: Iterable[Sequence[object]], head: Sequence[str] = (), picture: str = "") -> str:
    """A title, a table and a picture next to it."""
    return (
        f"<div><b>{escape(title)}</b>"
        f'<div style="display:flex;gap:24px;align-items:flex-start">{table(rows, head)}{picture}</div></div>'
    )
