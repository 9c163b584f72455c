"""Writes pin.inp: the foot of a pin with a round end, 10 mm in radius; 40 × 6 quad4, 1.6 mm wide and 2 mm high.

python examples/pin_wear_axisymmetric/pin.py
"""

from math import sqrt
from pathlib import Path

NR, NZ = 40, 6
WIDTH, HIGH, RADIUS = 1.6, 2.0, 10.0
# cells grow by this factor from the foot up
GROWTH = 1.5


def node(i: int, j: int) -> int:
    """The number of the node at this place of the grid."""
    return 1 + i + (NR + 1) * j


lines = ["*NODE, NSET=all"]
for j in range(NZ + 1):
    up = (GROWTH**j - 1) / (GROWTH**NZ - 1)
    for i in range(NR + 1):
        r = WIDTH * i / NR
        foot = RADIUS - sqrt(RADIUS**2 - r**2)
        lines.append(f"{node(i, j)}, {r:.9g}, {foot + up * (HIGH - foot):.9g}")
lines.append("*ELEMENT, TYPE=CAX4, ELSET=pin")
for j in range(NZ):
    for i in range(NR):
        corners = node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)
        lines.append(f"{1 + i + NR * j}, " + ", ".join(map(str, corners)))
lines.append("*SURFACE, NAME=foot")
lines += [f"{1 + i}, S1" for i in range(NR)]
lines.append("*SURFACE, NAME=head")
lines += [f"{1 + i + NR * (NZ - 1)}, S3" for i in range(NR)]
(Path(__file__).parent / "pin.inp").write_text("\n".join(lines) + "\n")
