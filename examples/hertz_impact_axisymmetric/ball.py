"""The mesh of a ball of radius 10 that stands on the origin, half of its section, of tri6: fine where it is pressed. Writes ball.msh."""

import math

import gmsh

RADIUS, FINE, COARSE = 10.0, 0.035, 1.5

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
geo = gmsh.model.geo


def on_circle(r, size):
    return geo.addPoint(r, RADIUS - math.sqrt(RADIUS**2 - r**2), 0, size)


centre = geo.addPoint(0, RADIUS, 0, COARSE)
tip, pressed, near, side = on_circle(0, FINE), on_circle(0.3, FINE), on_circle(1.2, 0.12), on_circle(RADIUS, COARSE)
top, inside = geo.addPoint(0, 2 * RADIUS, 0, COARSE), geo.addPoint(0, 0.35, 0, 1.5 * FINE)
arcs = [geo.addCircleArc(a, centre, b) for a, b in ((tip, pressed), (pressed, near), (near, side), (side, top))]
lines = [geo.addLine(a, b) for a, b in ((top, centre), (centre, inside), (inside, tip))]
section = geo.addPlaneSurface([geo.addCurveLoop(arcs + lines)])
geo.synchronize()
for dim, of, name in ((1, arcs[:2], "foot"), (1, lines, "axis"), (2, [section], "ball")):
    gmsh.model.addPhysicalGroup(dim, of, name=name)
gmsh.model.mesh.generate(2)
gmsh.model.mesh.setOrder(2)
gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
gmsh.write("ball.msh")
gmsh.finalize()
