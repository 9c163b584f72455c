"""The mesh of a bar, 10 long and 1 wide, its lower end 5 above the floor: quad4 in Gmsh 2.2. Writes bar.msh."""

LENGTH, WIDTH, HEIGHT, ALONG = 10.0, 1.0, 5.0, 40

nodes = [(side * WIDTH, HEIGHT + LENGTH * k / ALONG) for k in range(ALONG + 1) for side in (0, 1)]
cells = [(2 * k + 1, 2 * k + 2, 2 * k + 4, 2 * k + 3) for k in range(ALONG)]

out = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '1 2 "foot"', '2 1 "bar"', "$EndPhysicalNames"]
out += ["$Nodes", str(len(nodes))]
out += [f"{k + 1} {x:.9g} {y:.9g} 0" for k, (x, y) in enumerate(nodes)]
out += ["$EndNodes", "$Elements", str(len(cells) + 1), "1 1 2 2 2 1 2"]
out += [f"{k + 2} 3 2 1 1 " + " ".join(map(str, of)) for k, of in enumerate(cells)]
out += ["$EndElements", ""]
with open("bar.msh", "w", encoding="ascii") as file:
    file.write("\n".join(out))
