"""Writes fit.inp: a hub with a bore of 25 mm in radius, and above it a pin of 25.025 mm, both 40 mm long, of quad8.

python examples/press_fit_by_cooling_axisymmetric/fit.py
"""

from pathlib import Path

HIGH, ABOVE = 40.0, 60.0
# name: radii, height at which it stands, cells along the radius and the axis
PARTS = {"hub": (25.0, 50.0, 0.0, 6, 6), "pin": (0.0, 25.025, ABOVE, 5, 8)}

nodes: dict[tuple[str, int, int], int] = {}
at: list[str] = []
elements: list[tuple[str, list[int]]] = []
sides: dict[str, list[str]] = {}


def node(part: str, i: int, j: int) -> int:
    """The number of the node at half-steps along the radius and the axis."""
    inner, outer, low, nr, nz = PARTS[part]
    if (part, i, j) not in nodes:
        nodes[part, i, j] = len(nodes) + 1
        r, z = inner + (outer - inner) * i / (2 * nr), low + HIGH * j / (2 * nz)
        at.append(f"{len(nodes)}, {r:.8g}, {z:.8g}")
    return nodes[part, i, j]


for part, (_, _, _, nr, nz) in PARTS.items():
    for j in range(nz):
        for i in range(nr):
            corners = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
            elements.append((part, [node(part, 2 * i + a, 2 * j + b) for a, b in corners]))
            on = {"S1": j == 0, "S2": i == nr - 1, "S3": j == nz - 1, "S4": i == 0}
            for side, name in zip(on, ("bottom", "outside", "top", "inside")):
                if on[side]:
                    sides.setdefault(f"{part}_{name}", []).append(f"{len(elements)}, {side}")

lines = ["*NODE", *at]
for part in PARTS:
    lines.append(f"*ELEMENT, TYPE=CAX8, ELSET={part}")
    lines += [f"{k}, " + ", ".join(map(str, of)) for k, (name, of) in enumerate(elements, 1) if name == part]
for name, faces in sides.items():
    lines += [f"*SURFACE, NAME={name}", *faces]
(Path(__file__).parent / "fit.inp").write_text("\n".join(lines) + "\n")
