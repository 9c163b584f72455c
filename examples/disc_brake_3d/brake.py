"""Writes brake.inp: half the thickness of a disc, 60 to 110 mm in radius, and a pad on it, of hex8.

python examples/disc_brake_3d/brake.py
"""

from math import cos, radians, sin
from pathlib import Path

# name: radii, angles in degrees, heights; cells along each
PARTS = {
    "disc": ((60.0, 110.0), (0.0, 360.0), (-6.0, 0.0), (4, 36, 2)),
    "pad": ((70.0, 105.0), (65.0, 115.0), (0.0, 10.0), (3, 6, 3)),
}

at: list[str] = []
elements: list[tuple[str, list[int]]] = []
sides: dict[str, list[str]] = {}
nodes: dict[tuple[str, int, int, int], int] = {}


def node(part: str, i: int, j: int, k: int) -> int:
    """The number of the node at this place of the grid of a part."""
    *ends, cells = PARTS[part]
    if part == "disc":
        j %= cells[1]
    if (part, i, j, k) not in nodes:
        nodes[part, i, j, k] = len(nodes) + 1
        r, angle, z = (a + (b - a) * m / n for (a, b), m, n in zip(ends, (i, j, k), cells))
        x, y = r * cos(radians(angle)), r * sin(radians(angle))
        at.append(f"{len(nodes)}, {x:.9g}, {y:.9g}, {z:.9g}")
    return nodes[part, i, j, k]


for part, (_, _, _, (nr, na, nz)) in PARTS.items():
    for k in range(nz):
        for j in range(na):
            for i in range(nr):
                ring = [(0, 0), (1, 0), (1, 1), (0, 1)]
                corners = [node(part, i + a, j + b, k + c) for c in (0, 1) for a, b in ring]
                elements.append((part, corners))
                for side, name, there in (("S1", "bottom", part == "pad" and k == 0), ("S2", "top", k == nz - 1), ("S6", "inner", i == 0)):
                    if there:
                        sides.setdefault(f"{part}_{name}", []).append(f"{len(elements)}, {side}")

lines = ["*NODE", *at]
for part in PARTS:
    lines.append(f"*ELEMENT, TYPE=C3D8, ELSET={part}")
    lines += [f"{n}, " + ", ".join(map(str, of)) for n, (name, of) in enumerate(elements, 1) if name == part]
for name, faces in sides.items():
    lines += [f"*SURFACE, NAME={name}", *faces]
# the plane of symmetry, but what the shaft holds
middle = [n for (part, i, _, k), n in nodes.items() if part == "disc" and k == 0 and i > 0]
lines += ["*NSET, NSET=middle", *map(str, middle)]
(Path(__file__).parent / "brake.inp").write_text("\n".join(lines) + "\n")
