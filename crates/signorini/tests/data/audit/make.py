#!/usr/bin/env python3
"""Writes the cases whose wrong states are recorded here: python make.py [NAME ...]"""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).parent


class Mesh:
    """Nodes, elements and sets of a case."""

    def __init__(self):
        self.nodes, self.elements, self.faces, self.sets = [], [], {}, {}

    def node(self, *x):
        self.nodes.append(tuple(x))
        return len(self.nodes)

    def element(self, kind, group, nodes):
        self.elements.append((kind, group, tuple(nodes)))
        return len(self.elements)

    def mid(self, a, b, cache):
        key = (min(a, b), max(a, b))
        if key not in cache:
            xa, xb = self.nodes[a - 1], self.nodes[b - 1]
            cache[key] = self.node(*[(p + q) / 2 for p, q in zip(xa, xb)])
        return cache[key]

    def grid(self, group, us, vs, place, quadratic=False):
        """Quadrilaterals over us x vs; element numbers by column and row."""
        at = {(i, j): self.node(*place(u, v)) for j, v in enumerate(vs) for i, u in enumerate(us)}
        cells, cache = {}, {}
        for j in range(len(vs) - 1):
            for i in range(len(us) - 1):
                n = [at[i, j], at[i + 1, j], at[i + 1, j + 1], at[i, j + 1]]
                if quadratic:
                    n += [self.mid(n[k], n[(k + 1) % 4], cache) for k in range(4)]
                cells[i, j] = self.element("quad8" if quadratic else "quad4", group, n)
        return at, cells, cache

    def text(self):
        out = ["[mesh]", "nodes = ["]
        for k, x in enumerate(self.nodes, 1):
            out.append("  [%d, %s]," % (k, ", ".join(repr(round(c, 12)) for c in x)))
        out += ["]", "elements = ["]
        for k, (kind, group, nodes) in enumerate(self.elements, 1):
            out.append('  { id = %d, type = "%s", group = "%s", nodes = [%s] },'
                       % (k, kind, group, ", ".join(map(str, nodes))))
        out += ["]", "", "[sets]"]
        for name, nodes in self.sets.items():
            out.append("%s = { nodes = [%s] }" % (name, ", ".join(map(str, sorted(set(nodes))))))
        for name, faces in self.faces.items():
            out.append("%s = { faces = [%s] }" % (name, ", ".join('[%d, "S%d"]' % f for f in faces)))
        return "\n".join(out) + "\n"


def case(name, title, mesh, rest, space="plane-strain"):
    head = 'format = 1\ntitle = "%s"\nunits = "mm-N-MPa"\nallow = ["S0404"]\n\n' % title
    space = '\n[model]\nspace = "%s"\n\n' % space if space else "\n"
    (HERE / (name + ".toml")).write_text(head + mesh.text() + space + rest.strip() + "\n")


def steel(groups, model="linear-elastic", E=210000.0, nu=0.3):
    return ('[material.m]\nmodel = "%s"\nE = %s\nnu = %s\n\n[[body]]\ngroup = [%s]\nmaterial = "m"\n\n'
            % (model, E, nu, ", ".join('"%s"' % g for g in groups)))


def tooth():
    """A groove, 0.05 from its groove everywhere, moved sideways by 0.055; it touches at 0.05 / cos 30 = 0.0577."""
    m = Mesh()
    half, slope = 0.3, math.tan(math.radians(60))
    groove = lambda u: max(0.0, slope * (abs(u) - half))
    face = lambda u: max(0.05, slope * (abs(u) - half) + 0.1)
    us = [0.0, half, 0.5, 0.7, 0.9]
    us = [-u for u in reversed(us[1:])] + us
    below, cells, _ = m.grid("lower", us, [0, 0.5, 1], lambda u, v: (u, -0.6 + v * (0.6 + groove(u))), True)
    m.sets["base"] = [n for (i, j), n in below.items() if j == 0]
    m.faces["groove"] = [(cells[i, 1], 3) for i in range(len(us) - 1)]
    vs = [0.0, half - 0.05 / slope, 0.42, 0.56, 0.7]
    vs = [-u for u in reversed(vs[1:])] + vs
    above, upper, _ = m.grid("upper", vs, [0, 0.5, 1], lambda u, v: (u, (1 - v) * face(u) + v * 1.3), True)
    m.sets["head"] = [n for (i, j), n in above.items() if j == 2]
    m.faces["tooth"] = [(upper[i, 0], 1) for i in range(len(vs) - 1)]
    case("tooth", "A tooth that is moved sideways in its groove and does not touch", m, steel(["lower", "upper"]) + '''
[[contact]]
name = "v"
secondary = "groove"
primary = "tooth"
method = "mortar"
sliding = "finite"

[[step]]
name = "press"
geometry = "linear"
increments = 5
  [[step.fix]]
  on = "base"
  u = "all"
  [[step.move]]
  on = "head"
  ux = 0.055
  uy = 0.0
''')


def kink(name, degrees, quadratic, gap=0.02, down=0.01, end=2.8):
    """A flat face with a flank rising from its end, over flat facets: all stays 0.01 apart."""
    m = Mesh()
    low, cells, _ = m.grid("lower", [0, 1, 2, 3, 4], [-1, 0], lambda u, v: (u, v), quadratic)
    m.sets["base"] = [n for (i, j), n in low.items() if j == 0]
    m.faces["flat"] = [(cells[i, 0], 3) for i in range(4)]
    top = end + 1 / math.tan(math.radians(degrees))
    edge = {0: (0, 0), 1: (end / 2, end / 2), 2: (end, top)}
    high, upper, _ = m.grid("upper", [0, 1, 2], [0, 1],
                            lambda u, v: ((1 - v) * edge[u][0] + v * edge[u][1], gap + v), quadratic)
    m.sets["head"] = [n for (i, j), n in high.items() if j == 1]
    m.faces["kinked"] = [(upper[0, 0], 1), (upper[1, 0], 1), (upper[1, 0], 2)]
    case(name, "An edge of the primary side over a facet of the secondary side; all stays apart", m,
         steel(["lower", "upper"]) + '''
[[contact]]
name = "c"
secondary = "flat"
primary = "kinked"
method = "mortar"
sliding = "finite"

[[step]]
name = "lower"
geometry = "linear"
increments = { fixed = 1 }
  [[step.fix]]
  on = "base"
  u = "all"
  [[step.move]]
  on = "head"
  ux = 0.0
  uy = %s
''' % -down)


def gear():
    """Two teeth of a pair of gears with backlash: the tip corner of one is close to the flank of the other."""
    m = Mesh()
    # the flank of the secondary tooth leans by 20 degrees; the tip of the primary one ends over the middle of a facet
    lean = math.tan(math.radians(20))
    ys = [0, 0.25, 0.5, 0.75, 1.0]
    one, cells, _ = m.grid("one", [0, 0.4, 0.8], ys, lambda u, v: (u + (1 - u / 0.8) * 0 - lean * v * u / 0.8, v))
    m.sets["root"] = [n for (i, j), n in one.items() if i == 0]
    m.faces["flank"] = [(cells[1, j], 2) for j in range(4)]
    gap = 0.004
    turned = math.radians(3)
    tip, upper, _ = m.grid("two", [0, 0.45, 0.9], [0, 0.3, 0.6, 0.9], lambda u, v: (
        0.8 + gap - lean * (0.62 + v) + u + v * math.tan(turned) * (1 - u / 0.9), 0.62 + v))
    m.sets["back"] = [n for (i, j), n in tip.items() if i == 2]
    m.faces["tip"] = [(upper[0, j], 4) for j in range(3)] + [(upper[0, 0], 1), (upper[1, 0], 1)]
    case("gear", "The tip of a tooth beside the flank of another", m, steel(["one", "two"]) + '''
[[contact]]
name = "teeth"
secondary = "flank"
primary = "tip"
method = "mortar"
sliding = "finite"

[[step]]
name = "turn"
geometry = "linear"
increments = { fixed = 1 }
  [[step.fix]]
  on = "root"
  u = "all"
  [[step.move]]
  on = "back"
  ux = -0.002
  uy = 0.0
''')


def convex():
    """A convex block whose skin may touch itself, and never does."""
    m = Mesh()
    nx, ny = 4, 2
    at, cells, _ = m.grid("block", list(range(nx + 1)), list(range(ny + 1)), lambda u, v: (u / 2, v / 2))
    m.sets["bottom"] = [n for (i, j), n in at.items() if j == 0]
    m.sets["top"] = [n for (i, j), n in at.items() if j == ny]
    skin = [(cells[i, 0], 1) for i in range(nx)] + [(cells[nx - 1, j], 2) for j in range(ny)]
    skin += [(cells[i, ny - 1], 3) for i in range(nx)] + [(cells[0, j], 4) for j in range(ny)]
    m.faces["skin"] = skin
    case("convex", "A convex block whose skin may touch itself, and does not", m,
         steel(["block"], "neo-hookean", 10.0, 0.4) + '''
[[contact]]
name = "self"
secondary = "skin"
primary = "self"
reach = 2.5

[[step]]
name = "squeeze"
geometry = "nonlinear"
increments = 10
  [[step.fix]]
  on = "bottom"
  u = "all"
  [[step.move]]
  on = "top"
  ux = 0.0
  uy = -0.2
''')


def two_blocks():
    """Two blocks, one on the other, in one set that touches itself."""
    m = Mesh()
    low, cells, _ = m.grid("lower", [0, 0.5, 1, 1.5, 2], [0, 0.5, 1], lambda u, v: (u, v))
    high, upper, _ = m.grid("upper", [0.55, 0.9, 1.25], [1, 1.25, 1.5], lambda u, v: (u, v))
    m.sets["base"] = [n for (i, j), n in low.items() if j == 0]
    m.sets["head"] = [n for (i, j), n in high.items() if j == 2]
    skin = [(cells[i, 0], 1) for i in range(4)] + [(cells[3, j], 2) for j in range(2)]
    skin += [(cells[i, 1], 3) for i in range(4)] + [(cells[0, j], 4) for j in range(2)]
    skin += [(upper[i, 0], 1) for i in range(2)] + [(upper[1, j], 2) for j in range(2)]
    skin += [(upper[i, 1], 3) for i in range(2)] + [(upper[0, j], 4) for j in range(2)]
    m.faces["skin"] = skin
    case("two_blocks", "Two blocks in one set that touches itself", m,
         steel(["lower", "upper"], "neo-hookean", 1000.0) + '''
[[contact]]
name = "all"
secondary = "skin"
primary = "self"

[[step]]
name = "press"
geometry = "nonlinear"
increments = { initial = 0.04, min = 1e-6, max = 0.08 }
  [[step.fix]]
  on = "base"
  u = "all"
  [[step.move]]
  on = "head"
  ux = 0.0
  uy = -0.05
''')


def dragged():
    """A soft block, squeezed on a stiff table and dragged; its lower face and flanks touch."""
    m = Mesh()
    n = 10
    us = [k / n for k in range(n + 1)]
    at, cells, _ = m.grid("block", us, us, lambda u, v: (1 + u, v))
    m.sets["head"] = [k for (i, j), k in at.items() if j == n]
    m.faces["foot"] = ([(cells[i, 0], 1) for i in range(n)] + [(cells[n - 1, j], 2) for j in range(n)]
                       + [(cells[0, j], 4) for j in range(n)])
    table, slab, _ = m.grid("table", [0.7 * k for k in range(9)], [-1, 0], lambda u, v: (u, v))
    m.sets["base"] = [k for (i, j), k in table.items() if j == 0]
    m.faces["top"] = [(slab[i, 0], 3) for i in range(8)]
    rest = '''
[material.soft]
model = "neo-hookean"
E = 100.0
nu = 0.3

[material.hard]
model = "neo-hookean"
E = 1e5
nu = 0.3

[[body]]
group = "block"
material = "soft"

[[body]]
group = "table"
material = "hard"

[[contact]]
name = "c"
secondary = "foot"
primary = "top"
friction = 0.5
method = "mortar"

[[step]]
name = "press"
geometry = "nonlinear"
increments = 5
  [[step.fix]]
  on = "base"
  u = "all"
  [[step.move]]
  on = "head"
  ux = 0.0
  uy = -0.1

[[step]]
name = "drag"
increments = 30
  [[step.move]]
  on = "head"
  ux = 1.5
  uy = -0.1
'''
    case("dragged", "A soft block, pressed on a table and dragged", m, rest)


def rotation():
    """Two blocks, pressed, sheared until they slip, then turned as a whole by 90 degrees: no force changes."""
    m = Mesh()
    low, cells, _ = m.grid("lower", [2 * k / 7 for k in range(8)], [k / 4 for k in range(5)], lambda u, v: (u, v))
    high, upper, _ = m.grid("upper", [0.4 + 0.22 * k for k in range(6)], [1 + 0.2 * k for k in range(5)],
                            lambda u, v: (u, v))
    m.sets["base"] = [n for (i, j), n in low.items() if j == 0]
    m.sets["head"] = [n for (i, j), n in high.items() if j == 4]
    m.faces["foot"] = [(upper[i, 0], 1) for i in range(5)]
    m.faces["top"] = [(cells[i, 3], 3) for i in range(7)]
    n = 18
    way = []
    for k in range(n + 1):
        a = math.pi / 2 * k / n
        way.append((k / n, 0.06 * math.cos(a) + 0.05 * math.sin(a), 0.06 * math.sin(a) - 0.05 * math.cos(a)))
    table = lambda c: "{ table = [%s] }" % ", ".join("[%.17g, %.17g]" % (w[0], w[c]) for w in way)
    case("rotation", "Two blocks, pressed, sheared and turned as a whole", m,
         steel(["lower", "upper"], "neo-hookean", 1000.0).replace("[material.m]", '''[reference.rb]
at = [0.0, 0.0]

[reference.rh]
at = [0.0, 0.0]

[[constraint]]
kind = "kinematic"
on = "base"
reference = "rb"

[[constraint]]
kind = "kinematic"
on = "head"
reference = "rh"

[material.m]''') + '''
[[contact]]
name = "c"
secondary = "foot"
primary = "top"
friction = 0.3

[[step]]
name = "press"
geometry = "nonlinear"
increments = { fixed = 5 }
  [[step.fix]]
  on = "rb"
  u = "all"
  rot = "all"
  [[step.move]]
  on = "rh"
  ux = 0.0
  uy = -0.05
  rz = 0.0

[[step]]
name = "shear"
increments = { fixed = 5 }
  [[step.move]]
  on = "rh"
  ux = 0.06

[[step]]
name = "turn"
increments = { fixed = %d }
  [[step.move]]
  on = "rb"
  rz = 1.5707963267948966
  [[step.move]]
  on = "rh"
  rz = 1.5707963267948966
  ux = %s
  uy = %s
''' % (n, table(1), table(2)))


def tie():
    """Two blocks of hexahedra, pulled apart, joined with nodes on a plane of symmetry."""
    m = Mesh()

    def block(group, n, z0, z1):
        xs = [2 * k / n for k in range(n + 1)]
        at = {(i, j, k): m.node(xs[i], xs[j], z) for k, z in enumerate([z0, z1])
              for j in range(n + 1) for i in range(n + 1)}
        cells = {}
        for j in range(n):
            for i in range(n):
                low = [at[i, j, 0], at[i + 1, j, 0], at[i + 1, j + 1, 0], at[i, j + 1, 0]]
                high = [at[i, j, 1], at[i + 1, j, 1], at[i + 1, j + 1, 1], at[i, j + 1, 1]]
                cells[i, j] = m.element("hex8", group, low + high)
        return at, cells

    a, below = block("a", 2, 0.0, 1.0)
    b, above = block("b", 3, 1.0, 2.0)
    m.sets["base"] = [n for (i, j, k), n in a.items() if k == 0]
    m.sets["plane"] = [n for (i, j, k), n in [*a.items(), *b.items()] if i == 0]
    m.sets["point"] = [a[0, 0, 0]]
    m.sets["head"] = [n for (i, j, k), n in b.items() if k == 1]
    m.faces["upper"] = [(c, 1) for c in above.values()]
    m.faces["lower"] = [(c, 2) for c in below.values()]
    case("tie", "Two blocks, joined with nodes on a plane of symmetry, pulled apart", m, steel(["a", "b"]) + '''
[[contact]]
name = "t"
secondary = "upper"
primary = "lower"
tied = true

[[step]]
name = "pull"
geometry = "linear"
increments = { initial = 0.5, min = 1e-6, max = 0.5 }
  [[step.fix]]
  on = "base"
  u = ["z"]
  [[step.fix]]
  on = "plane"
  u = ["x"]
  [[step.fix]]
  on = "point"
  u = ["y"]
  [[step.move]]
  on = "head"
  uz = 0.002
''', None)


CASES = {
    "tooth": tooth,
    "kink": lambda: kink("kink", 60, False),
    "kink_quadratic": lambda: kink("kink_quadratic", 60, True),
    "gear": gear,
    "convex": convex,
    "two_blocks": two_blocks,
    "dragged": dragged,
    "rotation": rotation,
    "tie": tie,
}

if __name__ == "__main__":
    for name in sys.argv[1:] or CASES:
        CASES[name]()
