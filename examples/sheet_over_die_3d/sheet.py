"""Writes sheet.inp: half a sheet of 50 × 10 mm in the plane z = 0, of 24 × 4 shells.

python examples/sheet_over_die_3d/sheet.py
"""

from pathlib import Path

LENGTH, WIDTH, ALONG, ACROSS = 50.0, 10.0, 24, 4


def node(i: int, j: int) -> int:
    """The number of the node in column i and row j."""
    return 1 + i + (ALONG + 1) * j


columns, rows = range(ALONG + 1), range(ACROSS + 1)
lines = ["*NODE"]
lines += [f"{node(i, j)}, {i * LENGTH / ALONG:.10g}, {j * WIDTH / ACROSS:.10g}, 0" for j in rows for i in columns]
lines.append("*ELEMENT, TYPE=S4, ELSET=sheet")
for j in range(ACROSS):
    for i in range(ALONG):
        corners = (node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1))
        lines.append(f"{1 + i + ALONG * j}, " + ", ".join(map(str, corners)))
edges = {
    "middle": [node(0, j) for j in rows],
    "end": [node(ALONG, j) for j in rows],
    "left": [node(i, 0) for i in columns],
    "right": [node(i, ACROSS) for i in columns],
}
for name, numbers in edges.items():
    lines.append(f"*NSET, NSET={name}")
    lines += [", ".join(map(str, numbers[k : k + 12])) for k in range(0, len(numbers), 12)]
(Path(__file__).parent / "sheet.inp").write_text("\n".join(lines) + "\n")
