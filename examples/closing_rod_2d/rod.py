"""Writes rod.inp: a rod of 100 × 10 mm, of 40 × 2 quad4.

python examples/closing_rod_2d/rod.py
"""

from pathlib import Path

NX, NY = 40, 2
LENGTH, HEIGHT = 100.0, 10.0


def node(i: int, j: int) -> int:
    """The number of the node at this place of the grid."""
    return 1 + i + (NX + 1) * j


lines = ["*NODE, NSET=all"]
for j in range(NY + 1):
    lines += [f"{node(i, j)}, {LENGTH * i / NX:g}, {HEIGHT * j / NY:g}" for i in range(NX + 1)]
lines.append("*ELEMENT, TYPE=CPE4, ELSET=rod")
for j in range(NY):
    for i in range(NX):
        corners = node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)
        lines.append(f"{1 + i + NX * j}, " + ", ".join(map(str, corners)))
lines += ["*NSET, NSET=hot", ", ".join(str(node(0, j)) for j in range(NY + 1))]
lines += ["*NSET, NSET=tip", ", ".join(str(node(NX, j)) for j in range(NY + 1))]
lines.append("*SURFACE, NAME=face")
lines += [f"{NX * (j + 1)}, S2" for j in range(NY)]
(Path(__file__).parent / "rod.inp").write_text("\n".join(lines) + "\n")
