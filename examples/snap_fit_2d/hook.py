"""The mesh of a cantilever with a hook at its end, of tri6, with Gmsh: fine where the hook slides; and of a pin. Writes hook.msh."""

import gmsh

FINE, COARSE = 0.06, 0.6

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
geo = gmsh.model.geo
# counter-clockwise from the lower end of the root; the hook begins with the face that locks
outline = ((0, 0, COARSE), (8.6, 0, 0.3), (8.6, -1.1, FINE), (8.7, -1.1, FINE), (10.6, 0, 0.2), (10.6, 1, COARSE), (0, 1, COARSE))
points = [geo.addPoint(x, y, 0, size) for x, y, size in outline]
lines = [geo.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
section = geo.addPlaneSurface([geo.addCurveLoop(lines)])
middle = geo.addPoint(9.9, -0.8, 0)
around = [geo.addPoint(9.9 + x, -0.8 + y, 0, 0.1) for x, y in ((0.2, 0), (0, 0.2), (-0.2, 0), (0, -0.2))]
arcs = [geo.addCircleArc(a, middle, b) for a, b in zip(around, around[1:] + around[:1])]
pin = geo.addPlaneSurface([geo.addCurveLoop(arcs)])
geo.synchronize()
groups = ((0, points[2:3], "tip"), (1, lines[1:4], "sliding"), (1, lines[6:], "root"), (2, [section], "hook"), (2, [pin], "pin_mesh"))
for dim, of, name in groups:
    gmsh.model.addPhysicalGroup(dim, of, name=name)
gmsh.model.mesh.generate(2)
gmsh.model.mesh.setOrder(2)
gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
gmsh.write("hook.msh")
gmsh.finalize()
