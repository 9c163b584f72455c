"""The mesh of a round tube, radius 10, wall 2: quad8 in Gmsh 2.2. Writes tube.msh."""

from math import cos, pi, sin

RADIUS, WALL, AROUND, ACROSS = 10.0, 2.0, 48, 2

nodes, index, cells = [], {}, []


def node(along, inwards):  # in halves of an element
    key = (along % (2 * AROUND), inwards)
    if key not in index:
        angle = pi * (key[0] / AROUND + 0.5)
        radius = RADIUS - WALL * inwards / (2 * ACROSS)
        nodes.append((radius * cos(angle), radius * sin(angle)))
        index[key] = len(nodes)
    return index[key]


RING = [(0, 2), (0, 0), (2, 0), (2, 2), (0, 1), (1, 0), (2, 1), (1, 2)]
for k in range(AROUND):
    for layer in range(ACROSS):
        cells.append([node(2 * k + a, 2 * layer + b) for a, b in RING])

out = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "1", '2 1 "tube"', "$EndPhysicalNames"]
out += ["$Nodes", str(len(nodes))]
out += [f"{k + 1} {x:.9g} {y:.9g} 0" for k, (x, y) in enumerate(nodes)]
out += ["$EndNodes", "$Elements", str(len(cells))]
for k, of in enumerate(cells):
    out.append(f"{k + 1} 16 2 1 1 " + " ".join(map(str, of)))
out.append("$EndElements")
with open("tube.msh", "w") as file:
    file.write("\n".join(out) + "\n")
