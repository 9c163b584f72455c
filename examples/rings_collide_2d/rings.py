"""The mesh of two rings of quad4 side by side, with their outer faces. Writes rings.msh."""

import math

INSIDE, OUTSIDE, LAYERS, AROUND = 8.0, 10.0, 3, 72
CENTRES = {"left": (-10.1, -4.0), "right": (10.1, 4.0)}

nodes, elements = [], []
for body, (x, y) in enumerate(CENTRES.values(), 1):
    first = len(nodes) + 1

    def node(layer, k):
        return first + AROUND * layer + k % AROUND

    for layer in range(LAYERS + 1):
        radius = INSIDE + (OUTSIDE - INSIDE) * layer / LAYERS
        for k in range(AROUND):
            angle = 2.0 * math.pi * k / AROUND
            nodes.append((x + radius * math.cos(angle), y + radius * math.sin(angle)))
    for k in range(AROUND):
        # Gmsh's types: 1 for a line, 3 for a quadrangle
        elements.append((1, body + 2, [node(LAYERS, k), node(LAYERS, k + 1)]))
        for layer in range(LAYERS):
            corners = [node(layer, k), node(layer + 1, k), node(layer + 1, k + 1), node(layer, k + 1)]
            elements.append((3, body, corners))

with open("rings.msh", "w") as file:
    file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n")
    for number, name in enumerate(CENTRES, 1):
        file.write(f'2 {number} "{name}"\n1 {number + 2} "{name}_outer"\n')
    file.write(f"$EndPhysicalNames\n$Nodes\n{len(nodes)}\n")
    file.writelines(f"{number} {x:.9f} {y:.9f} 0\n" for number, (x, y) in enumerate(nodes, 1))
    file.write(f"$EndNodes\n$Elements\n{len(elements)}\n")
    for number, (kind, group, of) in enumerate(elements, 1):
        file.write(f"{number} {kind} 2 {group} {group} {' '.join(map(str, of))}\n")
    file.write("$EndElements\n")
