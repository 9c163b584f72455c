# Writes the meshes names_*.msh in this folder with Gmsh 4.15.2:  pip install gmsh && python make_names.py
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


# Two unit boxes that share a face, of tetrahedra; groups that overlap on points, curves, surfaces and volumes, names
# with spaces, quotes and other scripts, an element in three groups; whole, and in two partitions.
gmsh.option.setNumber("Mesh.MeshSizeMin", 1)
gmsh.option.setNumber("Mesh.MeshSizeMax", 1)
gmsh.model.add("names")
gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
gmsh.model.occ.addBox(1, 0, 0, 1, 1, 1)
gmsh.model.occ.fragment([(3, 1)], [(3, 2)])
gmsh.model.occ.synchronize()


def at(dim, *box):
    return [tag for _, tag in gmsh.model.getEntitiesInBoundingBox(*box, dim)]


e = 1e-3
gmsh.model.addPhysicalGroup(3, [1], 1, "left body")
gmsh.model.addPhysicalGroup(3, [2], 2, "Körper rechts")
gmsh.model.addPhysicalGroup(3, [1, 2], 3, "全部")
gmsh.model.addPhysicalGroup(2, at(2, -e, -e, -e, 2 + e, 1 + e, e), 1, "foot / z=0")
gmsh.model.addPhysicalGroup(2, at(2, -e, -e, -e, 1 + e, 1 + e, e), 2, "left foot")
gmsh.model.addPhysicalGroup(2, at(2, 1 - e, -e, -e, 1 + e, 1 + e, 1 + e), 3, "inside")
gmsh.model.addPhysicalGroup(1, at(1, -e, -e, -e, e, 1 + e, e), 1, "left body")
gmsh.model.addPhysicalGroup(0, at(0, -e, -e, -e, e, e, e), 1, "corner [0,0,0]")
gmsh.model.addPhysicalGroup(0, at(0, -e, -e, -e, e, 1 + e, e), 2, "x" * 100)
gmsh.option.setNumber("Mesh.PartitionCreateGhostCells", 0)
gmsh.model.mesh.generate(3)
both("names")
gmsh.model.mesh.partition(2)
save("names_41_partitioned", 4.1, 1)
save("names_22_partitioned", 2.2, 0)
