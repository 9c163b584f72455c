"""Writes arms.inp: two arms of 100 × 3 mm, one on the other, of quad8 that are 1 mm long along the face between them.

python examples/dcb_2d/arms.py
"""

from pathlib import Path

LENGTH, ROWS, HEIGHT, CRACK = 100, 2, 3.0, 30.0

nodes: dict[tuple[str, int, int], int] = {}
elements: list[tuple[str, list[int]]] = []
faces: dict[str, list[tuple[int, str]]] = {"lower": [], "upper": []}


def node(arm: str, i: int, j: int) -> int:
    """The number of the node at half-steps along and across an arm."""
    return nodes.setdefault((arm, i, j), len(nodes) + 1)


for arm in ("lower", "upper"):
    for j in range(0, 2 * ROWS, 2):
        for i in range(0, 2 * LENGTH, 2):
            corners = [(i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2)]
            middles = [(i + 1, j), (i + 2, j + 1), (i + 1, j + 2), (i, j + 1)]
            elements.append((arm, [node(arm, *at) for at in corners + middles]))
            inner = j + 2 == 2 * ROWS if arm == "lower" else j == 0
            if inner and i / 2 >= CRACK:
                faces[arm].append((len(elements), "S3" if arm == "lower" else "S1"))

lines = ["*NODE"]
for (arm, i, j), number in nodes.items():
    y = j * HEIGHT / (2 * ROWS) - (HEIGHT if arm == "lower" else 0.0)
    lines.append(f"{number}, {i / 2:g}, {y:g}")
for arm in ("lower", "upper"):
    lines.append(f"*ELEMENT, TYPE=CPE8, ELSET={arm}")
    lines += [f"{k}, " + ", ".join(map(str, of)) for k, (name, of) in enumerate(elements, 1) if name == arm]
    lines.append(f"*SURFACE, NAME={arm}_face")
    lines += [f"{element}, {side}" for element, side in faces[arm]]
    lines += [f"*NSET, NSET={arm}_pin", str(nodes[arm, 0, ROWS])]
ends = [str(number) for (_, i, _), number in nodes.items() if i == 2 * LENGTH]
lines += ["*NSET, NSET=clamped", ", ".join(ends)]
(Path(__file__).parent / "arms.inp").write_text("\n".join(lines) + "\n")
