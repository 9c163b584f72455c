#!/usr/bin/env python3
"""Draw the orders of convergence of contact that docs/convergence.md has in its tables.

    python scripts/convergence_figure.py [docs/convergence.md] [-o docs/figures/convergence.png]

Rows of a table are an element, the kind of contact, the errors in the energy norm (each but the first with its order
in brackets) under their size of the mesh, and the order of the last three. A table without a column for the contact is
that of rigid surfaces. Every order is computed from the errors and has to be within 0.02 of the one in the table; it has
to be 0.95 for linear and 1.4 for quadratic elements. Rows of pressures are skipped.

Needs: matplotlib. Exit code: 0 drawn, 1 an order is not what it has to be, 2 wrong command line or unreadable page.
"""

import argparse
import math
import sys
from fractions import Fraction
from pathlib import Path

LINEAR = ("tri3", "quad4", "hex8")
SPACE = ("hex8", "tet10", "hex20", "hex27")
RIGID = "rigid surface"
STYLES = {
    "tri3": ("tab:red", "^"),
    "quad4": ("tab:orange", "s"),
    "hex8": ("tab:orange", "s"),
    "tri6": ("tab:green", "^"),
    "tet10": ("tab:green", "^"),
    "quad8": ("tab:blue", "s"),
    "hex20": ("tab:blue", "s"),
    "quad9": ("tab:purple", "o"),
    "hex27": ("tab:purple", "o"),
}


class Row:
    """An element with the sizes of its meshes, its errors, and the order of the last three."""

    def __init__(self, head, cells):
        named = dict(zip(head, cells))
        self.element, self.contact = named["element"], named.get("contact", RIGID)
        first = head.index("contact" if "contact" in head else "element") + 1
        sizes = [Fraction(cell.removeprefix("h = ")) for cell in head[first:-1]]
        filled = [(h, cell) for h, cell in zip(sizes, cells[first:-1]) if cell]
        self.h = [float(h) for h, _ in filled]
        self.error = [float(cell.split()[0]) for _, cell in filled]
        self.claimed = float(cells[-1])
        # three sizes, each half the last: the line that fits best has the slope between the ends
        self.order = math.log2(self.error[-3] / self.error[-1]) / 2

    def is_optimal(self):
        least = 0.95 if self.element in LINEAR else 1.4
        return self.order >= least and abs(self.order - self.claimed) < 0.02


def read(page):
    """The rows of all tables."""
    tables = [line.strip()[1:-1] for line in page.splitlines() if line.startswith("|")]
    rows, head = [], []
    for cells in ([cell.strip() for cell in line.split("|")] for line in tables):
        if cells[0] == "element":
            head = cells
        elif cells[0] in STYLES:
            rows.append(Row(head, cells))
    return rows


def draw(rows, target):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    def panel(contact, space=False):
        return [row for row in rows if row.contact == contact and (row.element in SPACE) == space]

    panels = [
        ("plane, small sliding", panel("small sliding")),
        ("plane, small sliding, sides swapped", panel("small sliding, swapped")),
        ("plane, finite sliding", panel("finite sliding")),
        ("space, small sliding", panel("small sliding", space=True)),
        ("plane, rigid surface", panel(RIGID)),
        ("space, rigid surface", panel(RIGID, space=True)),
    ]
    figure, axes = plt.subplots(2, 3, figsize=(15, 8.4), dpi=100, sharex=True, sharey=True)
    for axis, (title, shown) in zip(axes.flat, panels):
        for row in shown:
            colour, marker = STYLES[row.element]
            label = f"{row.element}: {row.order:.2f}"
            axis.loglog(row.h, row.error, marker=marker, markersize=5, color=colour, label=label)
        for order, start in [(1.0, 0.9), (1.5, 0.007)]:
            ends = [1 / 2, 1 / 32]
            axis.loglog(ends, [start * (h / ends[0]) ** order for h in ends], color="grey", linestyle=":", linewidth=1.2)
            name = "h" if order == 1.0 else "$h^{3/2}$"
            axis.text(ends[0] * 1.05, start, name, color="grey", va="center")
        axis.set_title(title, fontsize=10)
        axis.set_xticks([1 / n for n in (2, 4, 8, 16, 32)], [f"1/{n}" for n in (2, 4, 8, 16, 32)])
        axis.minorticks_off()
        axis.legend(fontsize=8, loc="lower right", title="order, last three", title_fontsize=8)
        axis.grid(alpha=0.3)
    for axis in axes[:, 0]:
        axis.set_ylabel("error in the energy norm, relative")
    for axis in axes[1]:
        axis.set_xlabel("h")
    axes[0, 0].set_xlim(1 / 40, 0.8)
    figure.tight_layout()
    figure.savefig(target)


def main():
    parser = argparse.ArgumentParser(description="Draw the orders of convergence of mortar contact.")
    parser.add_argument("page", type=Path, nargs="?", default=Path("docs/convergence.md"))
    parser.add_argument("-o", "--output", type=Path, default=Path("docs/figures/convergence.png"))
    arguments = parser.parse_args()
    try:
        rows = read(arguments.page.read_text(encoding="utf-8"))
    except (OSError, ValueError, IndexError, KeyError) as error:
        print(f"error: the page cannot be read: {error}", file=sys.stderr)
        return 2
    draw(rows, arguments.output)
    bad = [row for row in rows if not row.is_optimal()]
    for row in bad:
        print(f"{row.element}, {row.contact}: order {row.order:.2f}, in the table {row.claimed:.2f}")
    print(f"convergence: {len(rows) - len(bad)} passed")
    return 1 if bad or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
