"""The mesh of two gears with involute flanks, module 2, 18 and 30 teeth: quad4 in Gmsh 2.2. Writes gears.msh."""

from math import acos, cos, pi, radians, sin, tan

MODULE, PRESSURE = 2.0, radians(20)
ALONG, ACROSS, GAP, RINGS = 8, 4, 3, 3  # elements: along a flank, across a tooth, between two, below them
PLAY = 0.002  # by which half a tooth is narrower (radian)

nodes, index, cells, lines = [], {}, [], []


def node(gear, x, y):
    key = (gear, round(x, 7), round(y, 7))
    if key not in index:
        nodes.append((x, y))
        index[key] = len(nodes)
    return index[key]


def involute(angle):
    return tan(angle) - angle


def gear(name, tag, teeth, centre, turn):
    pitch, base = teeth * MODULE / 2, teeth * MODULE / 2 * cos(PRESSURE)
    tip, root = pitch + MODULE, pitch - 1.25 * MODULE
    bore, step = 0.75 * root, 2 * pi / teeth

    def half(radius):  # the angle of half a tooth
        return pi / (2 * teeth) - PLAY + involute(PRESSURE) - involute(acos(base / max(radius, base)))

    def place(radius, angle):
        return node(name, centre + radius * cos(turn + angle), radius * sin(turn + angle))

    def strip(a, b, at_a, at_b):
        for k in range(len(at_a) - 1):
            corners = [(a, at_a[k]), (b, at_b[k]), (b, at_b[k + 1]), (a, at_a[k + 1])]
            cells.append((3, tag, [place(*corner) for corner in corners]))

    for tooth in range(teeth):
        middle = tooth * step

        def across(radius):
            return [middle + half(radius) * (2 * k / ACROSS - 1) for k in range(ACROSS + 1)]

        radii = [root + (tip - root) * k / ALONG for k in range(ALONG + 1)]
        for a, b in zip(radii, radii[1:]):
            strip(a, b, across(a), across(b))
        foot = across(root)
        free = middle + step - half(root) - foot[-1]
        foot += [foot[-1] + free * k / GAP for k in range(1, GAP + 1)]

        def below(radius):  # even at the bore
            part = (radius - bore) / (root - bore)
            even = [middle - half(root) + step * k / (len(foot) - 1) for k in range(len(foot))]
            return [e + (f - e) * part for e, f in zip(even, foot)]

        radii = [bore + (root - bore) * k / RINGS for k in range(RINGS + 1)]
        for a, b in zip(radii, radii[1:]):
            strip(a, b, below(a), below(b))
        at = below(bore)
        for a, b in zip(at, at[1:]):
            lines.append((1, tag + 2, [place(bore, a), place(bore, b)]))


gear("pinion", 1, 18, 0.0, 0.0)
gear("wheel", 2, 30, 48.0, pi + pi / 30)

names = [(2, "pinion"), (2, "wheel"), (1, "pinion bore"), (1, "wheel bore")]
out = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
out += [f'{dim} {tag + 1} "{name}"' for tag, (dim, name) in enumerate(names)]
out += ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
out += [f"{k + 1} {x:.9g} {y:.9g} 0" for k, (x, y) in enumerate(nodes)]
out += ["$EndNodes", "$Elements", str(len(cells) + len(lines))]
for k, (kind, tag, of) in enumerate(lines + cells):
    out.append(f"{k + 1} {kind} 2 {tag} {tag} " + " ".join(map(str, of)))
out.append("$EndElements")
with open("gears.msh", "w") as file:
    file.write("\n".join(out) + "\n")
