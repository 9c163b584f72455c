"""The mesh of a disc of radius 1 on the origin: tri3 inside, a ring of quad4 around them, in Gmsh 2.2. Writes disc.msh."""

from math import cos, pi, sin

AROUND, RINGS = 240, (0.4, 0.7, 1.0)

nodes = [(0.0, 1.0)]
for radius in RINGS:
    nodes += [(radius * sin(2 * pi * k / AROUND), 1 - radius * cos(2 * pi * k / AROUND)) for k in range(AROUND)]


def node(ring, k):
    return 2 + ring * AROUND + k % AROUND


cells = ["2 2 1 1 " + f"1 {node(0, k)} {node(0, k + 1)}" for k in range(AROUND)]
for ring in range(1, len(RINGS)):
    for k in range(AROUND):
        corners = (node(ring - 1, k), node(ring, k), node(ring, k + 1), node(ring - 1, k + 1))
        cells.append("3 2 1 1 " + " ".join(map(str, corners)))
rim = [f"1 2 2 2 {node(len(RINGS) - 1, k)} {node(len(RINGS) - 1, k + 1)}" for k in range(AROUND)]

out = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '1 2 "rim"', '2 1 "disc"', "$EndPhysicalNames"]
out += ["$Nodes", str(len(nodes))]
out += [f"{k + 1} {x:.12g} {y:.12g} 0" for k, (x, y) in enumerate(nodes)]
out += ["$EndNodes", "$Elements", str(len(rim) + len(cells))]
out += [f"{k + 1} {cell}" for k, cell in enumerate(rim + cells)]
out += ["$EndElements", ""]
with open("disc.msh", "w", encoding="ascii") as file:
    file.write("\n".join(out))
