"""The mesh of a ball, and of a track below z = 0 that follows its path, of hex8, in Gmsh 2.2. Writes ball.msh."""

from math import hypot, pi, tan

SLOPE, ACROSS = 2.396584, 1.0  # acceleration along x, velocity along y
SIZE, WIDE, THICK, BEFORE, AFTER = 0.025, 8, 0.05, -0.1, 1.04


def line(time):
    """A point of the path, and the velocity there."""
    after = max(time, 0.0)
    return (SLOPE * after**2 / 2, ACROSS * time), (SLOPE * after, ACROSS)


FINE, LOW = 6, -1e-3  # elements along the edge of a cube that is blown up, lowest point

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

# a cube whose faces have equal angles, on spheres about its centre; where it is seen: contact takes an exact sphere
first = len(nodes)
for at in ((i, j, k) for i in range(FINE + 1) for j in range(FINE + 1) for k in range(FINE + 1)):
    x, y, z = (2 * c / FINE - 1 for c in at)
    far = max(abs(x), abs(y), abs(z))
    tangents = [tan(pi / 4 * c / far) if far else 0.0 for c in (x, y, z)]
    scale = far / hypot(*tangents) if far else 0.0
    x, y, z = (scale * c for c in tangents)
    nodes.append(f"{len(nodes) + 1} {x:.12g} {y:.12g} {1 + LOW + z:.12g}")
for i, j, k in ((i, j, k) for i in range(FINE) for j in range(FINE) for k in range(FINE)):
    place = lambda a, b, c: first + 1 + k + c + (FINE + 1) * (j + b + (FINE + 1) * (i + a))  # noqa: E731
    own = [place(a, b, c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    cells.append(f"{len(cells) + 1} 5 2 3 3 " + " ".join(map(str, own)))

names = ["3", '2 1 "top"', '3 2 "track"', '3 3 "ball_mesh"']
out = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", *names, "$EndPhysicalNames"]
out += ["$Nodes", str(len(nodes)), *nodes, "$EndNodes", "$Elements", str(len(cells)), *cells, "$EndElements", ""]
with open("ball.msh", "w", encoding="ascii") as file:
    file.write("\n".join(out))
