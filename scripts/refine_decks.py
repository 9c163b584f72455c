#!/usr/bin/env python3
"""Solve refinements of a deck with CalculiX and with signorini, and tell which coarse result is nearer to their limit.

    python scripts/refine_decks.py DECK.inp ... [--levels 1 2 4 8] [--ccx CCX] [--signorini SIGNORINI]

A deck of C3D20 or CPS8 (with R or without) is read, and every element cut into n × n (× n) by its own shape functions,
for each level n. Nodes of the deck keep their numbers. A set of nodes becomes all nodes of those sides of elements whose
nodes it holds, surfaces and pressures become those of the parts of a side, forces at the three nodes of an edge that are in
the ratio 1 : 4 : 1 those of its parts. Everything else is copied.

Both programs solve every level, ccx with tight tolerances. Compared are displacements of the nodes of the deck, which are
at the same places on every level. The limit is what both programs find on the finest level: the mean of both. Printed is the
distance from it, in parts of its largest displacement, of each program on each level; of the finest, half of what the two
differ. Displacements at corners where two bodies meet converge slowly: the limit is as good as the last row says.

Where a reference lies beside the deck, DECK.dat.ref or DECK.frd.ref, the displacement in which it and signorini differ most
on the mesh of the deck is told: that of the reference, of both programs, and on the finest level.

Of plane stress, the largest stresses that the printed table has and the idealisation has not, szz, sxz, syz, are told in
parts of the largest one, too; and, as CalculiX makes a sheet of solid elements, the same for a sheet a tenth and a hundredth
as thick under forces per thickness that are the same: they vanish with the thickness.

Only what comes with Python is used. Exit code: 0; 1 where a program did not solve a level; 2 wrong command line.
"""

import argparse
import itertools
import os
import pathlib
import shutil
import sys
import tempfile

from compare_ccx import CONVERGED
from jobs import cards, fields, keywords, parameter, run

# corners and middles of edges in the order of the deck, on [-1, 1]
HEX20 = [
    *[(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)],
    *[(0, -1, -1), (1, 0, -1), (0, 1, -1), (-1, 0, -1), (0, -1, 1), (1, 0, 1), (0, 1, 1), (-1, 0, 1)],
    *[(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)],
]
QUAD8 = [(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0)]
# the coordinate, and its value, that sides S1, S2, … have
SIDES = {
    20: [(2, -1), (2, 1), (1, -1), (0, 1), (1, 1), (0, -1)],
    8: [(1, -1), (0, 1), (1, 1), (0, -1)],
}
NODES = {"C3D20": HEX20, "C3D20R": HEX20, "CPS8": QUAD8, "CPS8R": QUAD8}
NEAR = 1e-8


def shape(kind, at):
    """Serendipity shape functions of degree two."""
    values = []
    for node in kind:
        flat = [axis for axis, x in enumerate(node) if x == 0]
        product = 1.0
        for axis, x in enumerate(node):
            product *= 1 - at[axis] ** 2 if axis in flat else 1 + x * at[axis]
        if flat:
            values.append(product / 2 ** (len(node) - 1))
        else:
            corner = sum(x * at[axis] for axis, x in enumerate(node)) - (len(node) - 1)
            values.append(product * corner / 2 ** len(node))
    return values


class Mesh:
    """A deck and its refinement."""

    def __init__(self, text, level):
        self.level = level
        self.cards = cards(text)
        self.points, self.elements, self.kinds = {}, {}, {}
        # of the refinement: places, nodes by place, nodes of new elements, and the new elements of an old one
        self.place, self.known, self.new, self.parts = {}, {}, {}, {}
        for card, lines in self.cards:
            key = keywords(card)[0]
            if key == "NODE":
                for line in lines:
                    label, *x = line.split(",")
                    self.points[int(label)] = tuple(float(one) for one in x)
            elif key == "ELEMENT":
                self.read_elements(parameter(card, "TYPE"), fields(lines))
        self.old = set(self.points)
        for label, x in self.points.items():
            self.place[label] = x
        self.next = max(self.points) + 1
        self.refine()

    def read_elements(self, kind, numbers):
        count = len(NODES[kind])
        for first in range(0, len(numbers), count + 1):
            label, *nodes = (int(one) for one in numbers[first : first + count + 1])
            self.elements[label], self.kinds[label] = nodes, kind

    def refine(self):
        number = itertools.count(1)
        for label, nodes in self.elements.items():
            kind = NODES[self.kinds[label]]
            here = {self.key(node): label_of for node, label_of in zip(kind, nodes)}
            self.known[label] = here
            for cell in itertools.product(range(self.level), repeat=len(kind[0])):
                at = next(number)
                self.new[at] = [self.node(label, kind, nodes, self.local(cell, node)) for node in kind]
                self.parts.setdefault(label, []).append((at, cell))

    def key(self, at):
        return tuple(round((x + 1) * self.level * 2) for x in at)

    def local(self, cell, node):
        return tuple(-1 + (2 * part + 1 + x) / self.level for part, x in zip(cell, node))

    def node(self, label, kind, nodes, at):
        here = self.known[label]
        key = self.key(at)
        if key not in here:
            weights = shape(kind, at)
            here[key] = self.at_place(
                tuple(sum(w * self.points[n][axis] for w, n in zip(weights, nodes)) for axis in range(3)), label
            )
        return here[key]

    def at_place(self, x, label):
        """A node of an element next to this one that is there already, or a new one."""
        for other, nodes in self.known.items():
            shared = set(self.elements[other]) & set(self.elements[label])
            if other == label or not shared:
                continue
            for node in nodes.values():
                if all(abs(a - b) < NEAR for a, b in zip(self.place[node], x)):
                    return node
        self.place[self.next] = x
        self.next += 1
        return self.next - 1

    def on_side(self, label, side):
        """Nodes on a side of an element, in order along it, and its parts there."""
        axis, value = SIDES[len(self.elements[label])][side]
        wanted = round((value + 1) * self.level * 2)
        nodes = [node for key, node in sorted(self.known[label].items()) if key[axis] == wanted]
        end = 0 if value < 0 else self.level - 1
        return nodes, [at for at, cell in self.parts[label] if cell[axis] == end]

    def grown(self, labels):
        """A set of nodes, with all nodes of the sides between them."""
        labels = set(labels)
        grown = set(labels)
        for element, nodes in self.elements.items():
            if set(nodes) <= labels:
                grown.update(self.known[element].values())
            kind = NODES[self.kinds[element]]
            for side, (axis, value) in enumerate(SIDES[len(nodes)]):
                if {n for n, at in zip(nodes, kind) if at[axis] == value} <= labels:
                    grown.update(self.on_side(element, side)[0])
        return sorted(grown)

    def forces(self, lines):
        """Forces at the nodes of an edge, as those of its parts; others as they are."""
        rows = [[field.strip() for field in line.split(",")] for line in lines]
        at = {(int(node), dof): float(value) for node, dof, value in rows}
        out, done = {}, set()
        for element, nodes in self.elements.items():
            for side in range(4 if len(nodes) == 8 else 0):
                ends = nodes[side], nodes[(side + 1) % 4]
                middle = nodes[4 + side]
                for dof in {dof for _, dof in at}:
                    edge = [(n, dof) for n in (*ends, middle)]
                    if not all(one in at for one in edge):
                        continue
                    total = sum(at[one] for one in edge)
                    done.update(edge)
                    along = self.on_side(element, side)[0]
                    for first in range(0, 2 * self.level, 2):
                        for node, share in zip(along[first : first + 3], (1 / 6, 4 / 6, 1 / 6)):
                            out[node, dof] = out.get((node, dof), 0.0) + total * share / self.level
        out.update({one: value for one, value in at.items() if one not in done})
        return [f"{node},{dof},{value!r}" for (node, dof), value in out.items()]

    def deck(self, thinner=1.0):
        """The refined deck; of a sheet, thinner and under as much less force."""
        out, elements_done = [], False
        for card, lines in self.cards:
            key = keywords(card)[0]
            if key == "NODE":
                lines = [f"{label},{x!r},{y!r},{z!r}" for label, (x, y, z) in sorted(self.place.items())]
            elif key == "ELEMENT":
                if elements_done:
                    continue
                elements_done = True
                lines = []
                for label, nodes in self.new.items():
                    row = [str(one) for one in (label, *nodes)]
                    lines += [",".join(row[:11]) + ("," if len(row) > 11 else "")] + ([",".join(row[11:])] if len(row) > 11 else [])
            elif key == "NSET":
                lines = [f"{node}," for node in self.grown(int(one) for one in fields(lines))]
            elif key == "ELSET":
                lines = [f"{part}," for one in fields(lines) for part, _ in self.parts[int(one)]]
            elif key == "SURFACE":
                lines = self.surface(lines)
            elif key == "DLOAD":
                lines = self.pressures(lines)
            elif key == "CLOAD":
                lines = [self.scaled(line, thinner) for line in self.forces(lines)]
            elif key == "SOLIDSECTION":
                lines = [repr(float(fields(lines)[0]) * thinner)] if lines else []
            elif key in ("NODEFILE", "ELFILE", "CONTACTFILE", "NODEPRINT", "ELPRINT"):
                continue
            elif key == "ENDSTEP":
                out.append("*NODE PRINT, NSET=ORIGINALNODES\nU\n")
                if thinner != 1.0 or any(kind.startswith("CPS") for kind in self.kinds.values()):
                    out.append("*EL PRINT, ELSET=ALLPARTS\nS\n")
                out.append(CONVERGED)
            elif key == "STEP":
                out.append("*NSET, NSET=ORIGINALNODES\n" + "".join(f"{n},\n" for n in sorted(self.old)))
                out.append("*ELSET, ELSET=ALLPARTS\n" + "".join(f"{n},\n" for n in sorted(self.new)))
            out.append("\n".join([card, *lines]) + "\n")
        return "".join(out)

    @staticmethod
    def scaled(line, factor):
        node, dof, value = line.split(",")
        return f"{node},{dof},{float(value) * factor!r}"

    def sides_of(self, name):
        """The elements that a number or a set names."""
        if name.isdigit():
            return [int(name)]
        for card, lines in self.cards:
            if keywords(card)[0] == "ELSET" and parameter(card, "ELSET") == name.upper():
                return [int(one) for one in fields(lines)]
        raise SystemExit(f"no element set {name}")

    def surface(self, lines):
        rows = [[field.strip() for field in line.split(",")] for line in lines]
        found = []
        for name, side in (row[:2] for row in rows):
            for element in self.sides_of(name):
                found += [f"{part},{side}" for part in self.on_side(element, int(side[1:]) - 1)[1]]
        return found

    def pressures(self, lines):
        found = []
        for name, side, value in ([field.strip() for field in line.split(",")] for line in lines):
            for element in self.sides_of(name):
                parts = self.on_side(element, int(side[1:]) - 1)[1]
                found += [f"{part},{side},{value}" for part in parts]
        return found


def table(path, caption):
    """The last table of a .dat file below this caption: rows of numbers."""
    rows, inside = {}, False
    for line in pathlib.Path(path).read_text(encoding="ascii").splitlines():
        if caption in line:
            rows, inside = {}, True
        elif line.strip() and not line[:10].strip().isdigit():
            inside = False
        elif inside and line.strip():
            words = line.split()
            count = 2 if "integ.pnt" in caption else 1
            rows[tuple(words[:count])] = [float(word) for word in words[count:]]
    return rows


def solved(programs, text, name):
    """Displacements, and stresses, of both programs."""
    ccx, signorini = programs
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, f"{name}.inp").write_text(text, encoding="ascii")
        command = [signorini, "run", f"{name}.inp", "--compat", "ccx", "--quiet"]
        for program in ([ccx, "-i", name], command):
            code, _, _ = run(program, folder, 1800.0)
            if code != 0:
                raise SystemExit(f"{name}: {program[0]} ended with {code}")
        files = os.path.join(folder, f"{name}.dat"), os.path.join(folder, f"{name}.out", f"{name}.dat")
        moved = [table(file, "displacements") for file in files]
        return moved, [table(file, "stresses (elem, integ.pnt.") for file in files]


def reference(path):
    """Displacements that lie beside the deck; none where there are no such."""
    printed = path.with_suffix(".dat.ref")
    if printed.is_file() and printed.stat().st_size:
        return table(printed, "displacements")
    rows, inside = {}, False
    file = path.with_suffix(".frd.ref")
    for line in file.read_text(encoding="ascii").splitlines() if file.is_file() else []:
        if line.startswith(" -4"):
            inside = line.split()[1] == "DISP"
        elif inside and line.startswith(" -1"):
            rows[(line[3:13].strip(),)] = [float(line[13 + 12 * k : 25 + 12 * k]) for k in range(3)]
    return rows


def beside(name, given, coarse, limit):
    """Where the reference and signorini differ most: what all say."""
    theirs, ours = coarse
    apart = {(node, k): abs(a - ours[node][k]) for node, row in given.items() for k, a in enumerate(row)}
    node, k = max(apart, key=apart.get)
    lines = [f"| {name} | {' '.join(node)} along {'xyz'[k]} |", "|---|---|"]
    for what, rows in (("reference", given), ("CalculiX", theirs), ("signorini", ours), ("finest level", limit)):
        lines.append(f"| {what} | {rows[node][k]:.3e} |")
    return "\n".join(lines)


def largest(rows):
    return max(abs(value) for row in rows.values() for value in row)


def distance(one, other):
    return max(abs(a - b) for node, row in one.items() for a, b in zip(row, other[node]))


def across(rows):
    """The largest of the stresses that plane stress does not have, over the largest stress."""
    return max(abs(row[k]) for row in rows.values() for k in (2, 4, 5)) / largest(rows)


def study(path, levels, programs):
    text = path.read_text(encoding="ascii")
    found = {level: solved(programs, Mesh(text, level).deck(), path.stem) for level in levels}
    ccx, ours = found[levels[-1]][0]
    limit = {node: [(a + b) / 2 for a, b in zip(row, ours[node])] for node, row in ccx.items()}
    size = largest(limit)
    lines = [f"| {path.stem} | cells | CalculiX | signorini |", "|---|---|---|---|"]
    for level in levels:
        (theirs, mine), stresses = found[level]
        cells = " × ".join([str(level)] * (2 if stresses[0] else 3))
        far = [distance(one, limit) / size for one in (theirs, mine)]
        lines.append(f"| displacements | {cells} | {far[0]:.1e} | {far[1]:.1e} |")
    if found[levels[0]][1][0]:
        for thinner in (1.0, 0.1, 0.01):
            _, stresses = solved(programs, Mesh(text, 1).deck(thinner), path.stem)
            far = [across(rows) for rows in stresses]
            lines.append(f"| stress across, thickness × {thinner:g} | 1 × 1 | {far[0]:.1e} | {far[1]:.1e} |")
    given = reference(path)
    coarse = [] if levels[0] != 1 or not given else [beside(path.stem, given, found[1][0], limit)]
    return "\n\n".join(["\n".join(lines), *coarse])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("decks", nargs="+", type=pathlib.Path, help="decks of one element type each")
    parser.add_argument("--levels", nargs="+", type=int, default=[1, 2, 4], help="parts of an edge, increasing")
    parser.add_argument("--ccx", default="ccx", help="the command of CalculiX")
    parser.add_argument("--signorini", default="target/release/signorini", help="the command of signorini")
    args = parser.parse_args()
    programs = [shutil.which(name) for name in (args.ccx, args.signorini)]
    if None in programs:
        print("error: a program is missing", file=sys.stderr)
        return 2
    for deck in args.decks:
        print(study(deck, args.levels, [os.path.abspath(one) for one in programs]) + "\n", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
