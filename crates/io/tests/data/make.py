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
