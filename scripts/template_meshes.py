"""Writes the meshes of the templates of `signorini init`, in the form of Abaqus: blocks of quadrilaterals and hexahedra.

    python scripts/template_meshes.py crates/signorini-cli/src/command/templates
"""

import math
import sys
from pathlib import Path

# Corners of the sides of an element, S1, S2, ... in the order of Abaqus.
SIDES = {
    "quad4": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "hex8": [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
}


class Mesh:
    """Nodes, elements by group, sets of nodes, surfaces."""

    def __init__(self, kind, card):
        self.kind, self.card = kind, card
        self.points, self.elements, self.groups = [], [], {}
        self.node_sets, self.surfaces = {}, {}

    def grid(self, group, axes, place):
        """A block: the nodes are place(*axes) of all combinations; nodes at one place within a block are one."""
        first = len(self.points)
        known, numbers = {}, {}
        shape = [len(axis) for axis in axes]
        for index in indices(shape):
            at = place(*(axis[i] for axis, i in zip(axes, index)))
            key = tuple(round(c, 9) for c in at)
            if key not in known:
                known[key] = len(self.points)
                self.points.append(at)
            numbers[index] = known[key]
        for index in indices([n - 1 for n in shape]):
            around = [(0, 0), (1, 0), (1, 1), (0, 1)]
            if len(shape) == 3:
                around = [(*c, 0) for c in around] + [(*c, 1) for c in around]
            nodes = [numbers[tuple(i + d for i, d in zip(index, corner))] for corner in around]
            self.add(group, nodes)
        return range(first, len(self.points))

    def add(self, group, nodes):
        self.elements.append(nodes)
        self.groups.setdefault(group, []).append(len(self.elements))

    def nodes(self, name, holds, of=None):
        """A set of the nodes for which holds(point) is true, of a range of nodes or all."""
        among = range(len(self.points)) if of is None else of
        self.node_sets[name] = [n + 1 for n in among if holds(*self.points[n])]
        assert self.node_sets[name], name

    def surface(self, name, group, holds):
        """A surface of the sides of a group all of whose corners satisfy holds(point)."""
        sides = []
        for number in self.groups[group]:
            nodes = self.elements[number - 1]
            for side, corners in enumerate(SIDES[self.kind], 1):
                if all(holds(*self.points[nodes[c]]) for c in corners):
                    sides.append((number, side))
        assert sides, name
        self.surfaces[name] = sides

    def text(self, heading, model=""):
        out = [f"** {line}" for line in heading.splitlines()]
        out.append("*NODE, NSET=NALL")
        for number, point in enumerate(self.points, 1):
            out.append(f"{number}, " + ", ".join(short(c) for c in point))
        for group, numbers in self.groups.items():
            out.append(f"*ELEMENT, TYPE={self.card}, ELSET={group}")
            out += [f"{n}, " + ", ".join(str(k + 1) for k in self.elements[n - 1]) for n in numbers]
        for name, nodes in self.node_sets.items():
            out.append(f"*NSET, NSET={name}")
            out += [", ".join(map(str, nodes[i : i + 12])) for i in range(0, len(nodes), 12)]
        for name, sides in self.surfaces.items():
            out.append(f"*SURFACE, NAME={name}, TYPE=ELEMENT")
            out += [f"{number}, S{side}" for number, side in sides]
        return "\n".join(out) + "\n" + model


def indices(shape):
    if not shape:
        return [()]
    return [(*rest, i) for i in range(shape[-1]) for rest in indices(shape[:-1])]


def short(value):
    text = f"{value:.7g}"
    return "0.0" if abs(value) < 1e-12 else text if "." in text or "e" in text else text + ".0"


def even(start, end, n):
    return [start + (end - start) * i / n for i in range(n + 1)]


def graded(start, fine, end, n, growth):
    """Even up to `fine` with n parts, then growing parts up to `end`."""
    out = even(start, fine, n)
    step = out[-1] - out[-2]
    while True:
        step *= growth
        if out[-1] + 1.5 * step >= end:
            return out + [end]
        out.append(out[-1] + step)


def hertz():
    radius, fine = 10.0, 1.6
    mesh = Mesh("quad4", "CAX4")
    across = graded(0.0, fine, 9.0, 16, 1.4)
    sphere = lambda r: radius - math.sqrt(radius**2 - r**2)
    up = graded(0.0, 0.1, 1.0, 8, 1.3)
    mesh.grid("sphere", [across, up], lambda r, s: (r, sphere(r) + s * (12.0 - sphere(r))))
    wide = graded(0.0, fine, 12.0, 16, 1.4)
    deep = graded(0.0, 1.2, 12.0, 12, 1.4)
    mesh.grid("block", [wide, [-d for d in reversed(deep)]], lambda r, y: (r, y))
    mesh.nodes("axis", lambda r, y: r < 1e-9)
    mesh.nodes("base", lambda r, y: y < -12 + 1e-9)
    mesh.nodes("head", lambda r, y: y > 12 - 1e-9)
    mesh.surface("sphere_head", "sphere", lambda r, y: y > 12 - 1e-9)
    mesh.surface("sphere_surface", "sphere", lambda r, y: abs(y - sphere(r)) < 1e-9 and r < 5)
    mesh.surface("block_top", "block", lambda r, y: abs(y) < 1e-9)
    return mesh.text("A sphere of radius 10 mm on a block, axis y: half sections")


def sliding():
    mesh = Mesh("hex8", "C3D8")
    mesh.grid("block", [even(3, 9, 3), even(2, 8, 3), even(2, 8, 3)], lambda x, y, z: (x, y, z))
    mesh.grid("table", [even(0, 24, 8), even(0, 10, 3), even(0, 2, 1)], lambda x, y, z: (x, y, z))
    mesh.nodes("table_bottom", lambda x, y, z: z < 1e-9)
    mesh.nodes("block_head", lambda x, y, z: z > 8 - 1e-9)
    mesh.surface("block_foot", "block", lambda x, y, z: abs(z - 2) < 1e-9)
    mesh.surface("block_top", "block", lambda x, y, z: abs(z - 8) < 1e-9)
    mesh.surface("table_top", "table", lambda x, y, z: abs(z - 2) < 1e-9)
    return mesh.text("A block of 6 x 6 x 6 mm on a table of 24 x 10 x 2 mm")


def press_fit():
    mesh = Mesh("quad4", "CAX4")
    high = even(0.0, 2.0, 2)
    mesh.grid("shaft", [even(5.0, 10.01, 16), high], lambda r, y: (r, y))
    mesh.grid("hub", [even(10.0, 20.0, 24), high], lambda r, y: (r, y))
    mesh.nodes("ends", lambda r, y: y < 1e-9 or y > 2 - 1e-9)
    mesh.nodes("bore", lambda r, y: abs(r - 5) < 1e-9)
    mesh.nodes("rim", lambda r, y: abs(r - 20) < 1e-9)
    mesh.surface("shaft_outside", "shaft", lambda r, y: abs(r - 10.01) < 1e-9)
    mesh.surface("hub_inside", "hub", lambda r, y: abs(r - 10) < 1e-9)
    return mesh.text("A slice of a hollow shaft and of the hub on it, 0.01 mm too large: axis y")


def o_ring():
    mesh = Mesh("quad4", "CAX4")
    middle, section, n, layers = 20.0, 2.0, 10, 7
    core = 0.5 * section

    def inside(u, v):
        # a square with slightly round sides
        bulge = 1.0 + 0.15 * (1 - u * u) * (1 - v * v)
        return (middle + core * u * bulge * 0.85, core * v * bulge * 0.85)

    def ring(side):
        def place(t, s):
            u, v = [(t, -1.0), (1.0, t), (-t, 1.0), (-1.0, -t)][side]
            a = -0.75 * math.pi + 0.25 * math.pi * (t + 1) + 0.5 * math.pi * side
            x, y = inside(u, v)
            ox, oy = middle + section * math.cos(a), section * math.sin(a)
            return (x + s * (ox - x), y + s * (oy - y))

        return place

    span = even(-1.0, 1.0, n)
    first = mesh.grid("ring", [span, span], inside)
    known = {tuple(round(c, 9) for c in mesh.points[k]): k for k in first}
    for side in range(4):
        out = even(0.0, 1.0, layers)
        numbers = {}
        for i, t in enumerate(span):
            for j, s in enumerate(out):
                at = ring(side)(t, s)
                key = tuple(round(c, 9) for c in at)
                if key not in known:
                    known[key] = len(mesh.points)
                    mesh.points.append(at)
                numbers[i, j] = known[key]
        for i in range(n):
            for j in range(layers):
                corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
                mesh.add("ring", [numbers[c] for c in corners])
    on_rim = lambda r, y: abs(math.hypot(r - middle, y) - section) < 1e-6
    mesh.nodes("waist", lambda r, y: abs(y) < 1e-9)
    mesh.surface("skin", "ring", on_rim)
    return mesh.text("The section of an O-ring: a disc of diameter 4 mm at a mean radius of 20 mm, axis y")


def belt():
    mesh = Mesh("quad4", "CPS4")
    radius, thick, tail = 50.0, 1.0, 10.0
    around, ends = 40, 6

    def place(t, s):
        r = radius + s * thick
        if t < 0:
            return (-r, t)
        if t > 1:
            return (r, -(t - 1))
        a = math.pi * (1 - t)
        return (r * math.cos(a), r * math.sin(a))

    along = [-tail * (1 - i / ends) for i in range(ends)] + even(0, 1, around)
    along += [1 + tail * (i + 1) / ends for i in range(ends)]
    mesh.grid("belt", [along, even(0.0, 1.0, 2)], place)
    mesh.nodes("slack_end", lambda x, y: x < 0 and y < -tail + 1e-9)
    mesh.nodes("tight_end", lambda x, y: x > 0 and y < -tail + 1e-9)
    at_inside = lambda x, y: (math.hypot(x, y) < radius + 1e-6 and y > -1e-9) or (abs(abs(x) - radius) < 1e-6 and y < 1e-9)
    mesh.surface("inside", "belt", at_inside)
    mesh.surface("slack_face", "belt", lambda x, y: x < 0 and y < -tail + 1e-9)
    mesh.surface("tight_face", "belt", lambda x, y: x > 0 and y < -tail + 1e-9)
    return mesh.text("A belt 1 mm thick on the upper half of a drum of radius 50 mm, with straight ends")


def patch_test():
    mesh = Mesh("hex8", "C3D8")
    mesh.grid("lower", [even(0, 4, 3), even(0, 4, 3), even(-3, 0, 2)], lambda x, y, z: (x, y, z))
    skew = lambda x, y, z: (x + 0.3 * math.sin(math.pi * x / 4) * (y / 4 - 0.5), y + 0.3 * math.sin(math.pi * y / 4) * (x / 4 - 0.5), z)
    mesh.grid("upper", [even(0, 4, 4), even(0, 4, 4), even(0, 3, 2)], skew)
    mesh.nodes("base", lambda x, y, z: z < -3 + 1e-9)
    mesh.nodes("left", lambda x, y, z: abs(x) < 1e-9)
    mesh.nodes("front", lambda x, y, z: abs(y) < 1e-9)
    mesh.surface("foot", "upper", lambda x, y, z: abs(z) < 1e-9)
    mesh.surface("lower_top", "lower", lambda x, y, z: abs(z) < 1e-9)
    mesh.surface("head", "upper", lambda x, y, z: z > 3 - 1e-9)
    return mesh.text("Two blocks of 4 x 4 x 3 mm whose meshes do not match")


def slope():
    mesh = Mesh("hex8", "C3D8")
    mesh.grid("block", [even(0, 40, 4), even(0, 30, 3), even(0, 20, 2)], lambda x, y, z: (x, y, z))
    mesh.surface("foot", "block", lambda x, y, z: abs(z) < 1e-9)
    return mesh.text("A block of 40 x 30 x 20 mm")


DECK = """*MATERIAL, NAME=RUBBER
*ELASTIC
10.0, 0.3
*MATERIAL, NAME=STEEL
*ELASTIC
210000.0, 0.3
*SOLID SECTION, ELSET=upper, MATERIAL=RUBBER
*SOLID SECTION, ELSET=lower, MATERIAL=STEEL
*SURFACE INTERACTION, NAME=DRY
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1.0E5
*CONTACT PAIR, INTERACTION=DRY, TYPE=SURFACE TO SURFACE
foot, lower_top
*BOUNDARY
base, 1, 3
left, 1
front, 2
*STEP, NLGEOM
*STATIC
0.25, 1.0
*BOUNDARY
lid, 3, 3, -0.3
*NODE PRINT, NSET=lid, TOTALS=ONLY
RF
*NODE FILE
U
*EL FILE
S
*CONTACT FILE
CDIS, CSTR
*END STEP
"""


def deck():
    mesh = Mesh("hex8", "C3D8")
    mesh.grid("upper", [even(0, 2, 2), even(0, 2, 2), even(0, 3, 3)], lambda x, y, z: (x, y, z))
    mesh.grid("lower", [even(0, 4, 3), even(0, 4, 3), even(-2, 0, 2)], lambda x, y, z: (x, y, z))
    mesh.nodes("base", lambda x, y, z: z < -2 + 1e-9)
    mesh.nodes("lid", lambda x, y, z: z > 3 - 1e-9)
    mesh.nodes("left", lambda x, y, z: abs(x) < 1e-9 and z >= 0)
    mesh.nodes("front", lambda x, y, z: abs(y) < 1e-9 and z >= 0)
    mesh.surface("foot", "upper", lambda x, y, z: abs(z) < 1e-9)
    mesh.surface("lower_top", "lower", lambda x, y, z: abs(z) < 1e-9)
    heading = """A rubber block, a tenth shorter afterwards, on a steel one: a deck for CalculiX, Abaqus and signorini.
Lengths in mm, forces in N, stresses in MPa.
signorini run deck.inp
St. Venant-Kirchhoff: a stretch of 0.9 takes a force of 4 mm2 x 10 MPa x 0.9 x (0.9^2 - 1) / 2 = -3.42 N on the lid."""
    return mesh.text(heading, DECK)


MESHES = {
    "hertz.inp": hertz,
    "sliding.inp": sliding,
    "press_fit.inp": press_fit,
    "o_ring.inp": o_ring,
    "belt.inp": belt,
    "patch_test.inp": patch_test,
    "slope.inp": slope,
    "deck.inp": deck,
}

if __name__ == "__main__":
    folder = Path(sys.argv[1])
    for name, make in MESHES.items():
        (folder / name).write_text(make())
