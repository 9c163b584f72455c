# Writes the meshes in this folder, those here with Gmsh 4.15.2:  pip install gmsh && python make.py
import gmsh

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)


def save(name, version, binary, parametric=False):
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.option.setNumber("Mesh.SaveParametric", parametric)
    gmsh.write(name + ".msh")


def both(name):
    for version in (2.2, 4.1):
        for binary in (0, 1):
            save(f"{name}_{version}_{'binary' if binary else 'text'}".replace(".", ""), version, binary)


# A unit box of tetrahedra; overlapping groups, one name in two dimensions, a name with a space and an accent,
# a group without a name.
gmsh.model.add("box")
gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
gmsh.model.occ.synchronize()
gmsh.option.setNumber("Mesh.MeshSizeMin", 1)
gmsh.option.setNumber("Mesh.MeshSizeMax", 1)
gmsh.model.addPhysicalGroup(3, [1], 7)
gmsh.model.addPhysicalGroup(3, [1], 8, "whole box é")
gmsh.model.addPhysicalGroup(2, [5], 3, "bottom")
gmsh.model.addPhysicalGroup(2, [5, 6], 4, "ends")
gmsh.model.addPhysicalGroup(1, [1], 4, "edge")
gmsh.model.addPhysicalGroup(0, [1, 2], 1, "ends")
gmsh.model.mesh.generate(3)
both("box")
save("box_22_parametric_text", 2.2, 0, True)
save("box_22_parametric_binary", 2.2, 1, True)
save("box_41_parametric_binary", 4.1, 1, True)
gmsh.option.setNumber("Mesh.PartitionCreateGhostCells", 1)
gmsh.model.mesh.partition(2)
save("box_41_partitioned", 4.1, 0)
save("box_22_partitioned", 2.2, 0)

# A plane rectangle of 3 x 2 quadrilaterals.
gmsh.clear()
gmsh.model.add("plane")
gmsh.model.geo.addPoint(0, 0, 0, 1, 1)
gmsh.model.geo.addPoint(3, 0, 0, 1, 2)
gmsh.model.geo.addPoint(3, 2, 0, 1, 3)
gmsh.model.geo.addPoint(0, 2, 0, 1, 4)
for i in range(4):
    gmsh.model.geo.addLine(i + 1, (i + 1) % 4 + 1, i + 1)
gmsh.model.geo.addCurveLoop([1, 2, 3, 4], 1)
gmsh.model.geo.addPlaneSurface([1], 1)
for i, n in enumerate((4, 3, 4, 3)):
    gmsh.model.geo.mesh.setTransfiniteCurve(i + 1, n)
gmsh.model.geo.mesh.setTransfiniteSurface(1)
gmsh.model.geo.mesh.setRecombine(2, 1)
gmsh.model.geo.synchronize()
gmsh.model.addPhysicalGroup(2, [1], 1, "sheet")
gmsh.model.addPhysicalGroup(1, [4], 2, "left")
gmsh.model.mesh.generate(2)
both("plane")

# The same rectangle, one high: 3 x 2 x 2 hexahedra.
e = gmsh.model.geo.extrude([(2, 1)], 0, 0, 1, [2], recombine=True)
gmsh.model.geo.synchronize()
gmsh.model.removePhysicalGroups()
gmsh.model.addPhysicalGroup(3, [e[1][1]], 1, "brick")
gmsh.model.addPhysicalGroup(2, [e[0][1]], 2, "top")
gmsh.model.mesh.generate(3)
both("brick")


# A quarter of a ring of radii 1 and 2, of second-order cells of one kind, in space one high. The test holds the areas
# and volumes that Gmsh finds by its own shape functions and rules.
def ring(kind, dim, recombine, incomplete, layers=1):
    gmsh.clear()
    gmsh.model.add(kind)
    geo = gmsh.model.geo
    for tag, (x, y) in enumerate([(0, 0), (1, 0), (2, 0), (0, 2), (0, 1)]):
        geo.addPoint(x, y, 0, 1, tag + 1)
    geo.addLine(2, 3, 1)
    geo.addCircleArc(3, 1, 4, 2)
    geo.addLine(4, 5, 3)
    geo.addCircleArc(5, 1, 2, 4)
    geo.addCurveLoop([1, 2, 3, 4], 1)
    geo.addPlaneSurface([1], 1)
    for curve, n in ((1, 2), (2, 3), (3, 2), (4, 3)):
        geo.mesh.setTransfiniteCurve(curve, n)
    geo.mesh.setTransfiniteSurface(1)
    if recombine:
        geo.mesh.setRecombine(2, 1)
    outer = 2
    if dim == 3:
        solid = geo.extrude([(2, 1)], 0, 0, 1, [layers] if layers else [], recombine=bool(layers))
        outer = solid[3][1]
    geo.synchronize()
    gmsh.model.addPhysicalGroup(dim, [1], 1, "ring")
    gmsh.model.addPhysicalGroup(dim - 1, [outer], 2, "outer")
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", incomplete)
    gmsh.model.mesh.generate(dim)
    gmsh.model.mesh.setOrder(2)
    save(f"ring_{kind}_41_text", 4.1, 0)
    save(f"ring_{kind}_22_binary", 2.2, 1)
    sizes = []
    for d in (dim, dim - 1):
        size = count = 0
        (types, tags, _) = gmsh.model.mesh.getElements(d, 1 if d == dim else outer)
        for element, cells in zip(types, tags):
            points, weights = gmsh.model.mesh.getIntegrationPoints(element, "Gauss10")
            entity = 1 if d == dim else outer
            _, determinants, _ = gmsh.model.mesh.getJacobians(element, points, entity)
            size += sum(w * j for w, j in zip(list(weights) * len(cells), determinants))
            count += len(cells)
        sizes.append((count, size))
    print(kind, len(gmsh.model.mesh.getNodes()[0]), *sizes)


ring("tri6", 2, False, 0)
ring("quad9", 2, True, 0)
ring("quad8", 2, True, 1)
ring("tet10", 3, False, 0, layers=0)
ring("hex27", 3, True, 0)
ring("hex20", 3, True, 1)
ring("wedge15", 3, False, 1)
