"""The mesh of a track below z = 0 that follows the path of the ball, one layer of hex8, in Gmsh 2.2. Writes track.msh."""

from math import hypot

SLOPE, ACROSS = 2.396584, 1.0  # acceleration along x, velocity along y
SIZE, WIDE, THICK, BEFORE, AFTER = 0.025, 8, 0.05, -0.1, 1.04


def line(time):
    """A point of the path, and the velocity there."""
    after = max(time, 0.0)
    return (SLOPE * after**2 / 2, ACROSS * time), (SLOPE * after, ACROSS)


times = [BEFORE]
while times[-1] < AFTER:
    time = times[-1] + SIZE / 2 / hypot(*line(times[-1])[1])
    times.append(times[-1] + SIZE / hypot(*line(time)[1]))

nodes, ALONG = [], len(times) - 1
for k in range(2):
    for time in times:
        (x, y), (u, v) = line(time)
        for j in range(WIDE + 1):
            off = SIZE * (j - WIDE / 2) / hypot(u, v)
            nodes.append(f"{len(nodes) + 1} {x + off * v:.12g} {y - off * u:.12g} {THICK * (k - 1):.12g}")


def node(i, j, k):
    return 1 + j + (WIDE + 1) * (i + (ALONG + 1) * k)


corners = ((0, 0), (0, 1), (1, 1), (1, 0))
cells = []
for kind, group, layers in ((3, 1, (1,)), (5, 2, (0, 1))):
    for i in range(ALONG):
        for j in range(WIDE):
            own = [node(i + a, j + b, k) for k in layers for a, b in corners]
            cells.append(f"{len(cells) + 1} {kind} 2 {group} {group} " + " ".join(map(str, own)))

out = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '2 1 "top"', '3 2 "track"', "$EndPhysicalNames"]
out += ["$Nodes", str(len(nodes)), *nodes, "$EndNodes", "$Elements", str(len(cells)), *cells, "$EndElements", ""]
with open("track.msh", "w", encoding="ascii") as file:
    file.write("\n".join(out))
