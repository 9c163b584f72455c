"""The mesh of a bolt through two plates, as a body of revolution: quad4 in Gmsh 2.2. Writes joint.msh."""

nodes, index, cells, lines = [], {}, [], []


def node(r, z, body):
    key = (body, round(r, 9), round(z, 9))
    if key not in index:
        nodes.append((r, z))
        index[key] = len(nodes)
    return index[key]


def even(a, b, n):
    return [a + (b - a) * k / n for k in range(n + 1)]


def grid(rs, zs, body, tag):
    for r, r2 in zip(rs, rs[1:]):
        for z, z2 in zip(zs, zs[1:]):
            corners = [(r, z), (r2, z), (r2, z2), (r, z2)]
            cells.append((3, tag, [node(*corner, body) for corner in corners]))


def edge(places, body, tag):
    for a, b in zip(places, places[1:]):
        lines.append((1, tag, [node(*a, body), node(*b, body)]))


shank, long = even(0, 5, 5), even(0, 16, 14)
head = shank + even(5, 8, 3)[1:]
low, high = even(0, 8, 7), even(8, 16, 6)
grid(head, even(-5, 0, 4), "bolt", 1)
grid(shank, long, "bolt", 1)
grid(head, even(16, 21, 4), "bolt", 1)
grid(even(5.25, 8, 4) + even(8, 20, 9)[1:], low, "lower", 2)
grid(even(5.25, 8.25, 4) + even(8.25, 20, 8)[1:], high, "upper", 3)
edge([(r, long[7]) for r in shank], "bolt", 4)
edge([(20, z) for z in low], "lower", 5)
edge([(20, z) for z in high], "upper", 6)

names = [(2, "bolt"), (2, "lower"), (2, "upper"), (1, "section"), (1, "clamp"), (1, "rim")]
out = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
out += [f'{dim} {tag + 1} "{name}"' for tag, (dim, name) in enumerate(names)]
out += ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
out += [f"{k + 1} {r:.10g} {z:.10g} 0" for k, (r, z) in enumerate(nodes)]
out += ["$EndNodes", "$Elements", str(len(cells) + len(lines))]
for k, (kind, tag, of) in enumerate(lines + cells):
    out.append(f"{k + 1} {kind} 2 {tag} {tag} " + " ".join(map(str, of)))
out.append("$EndElements")
with open("joint.msh", "w") as file:
    file.write("\n".join(out) + "\n")
