"""A press fit: two tubes drawn and meshed in gmsh, and run without a file in between.

The shaft is 0.001 mm too large in radius; the overlap of the meshes is resolved over the step.
"""

import gmsh

import signorini as sg

E, inner, middle, outer, overlap = 1000.0, 0.5, 1.0, 1.5, 0.001  # MPa, mm


def tube(name: str, low: float, high: float, size: float) -> None:
    """A quarter of a tube, with physical groups for its four edges."""
    geo = gmsh.model.geo
    center = geo.addPoint(0, 0, 0)
    a, b, c, d = (geo.addPoint(x, y, 0, size) for x, y in ((low, 0), (high, 0), (0, high), (0, low)))
    edges = [geo.addLine(a, b), geo.addCircleArc(b, center, c), geo.addLine(c, d), geo.addCircleArc(d, center, a)]
    face = geo.addPlaneSurface([geo.addCurveLoop(edges)])
    geo.synchronize()
    gmsh.model.addPhysicalGroup(2, [face], name=name)
    for edge, side in zip(edges, ("bottom", "outside", "left", "inside")):
        gmsh.model.addPhysicalGroup(1, [edge], name=f"{name}_{side}")


gmsh.initialize(interruptible=False)
gmsh.option.setNumber("General.Verbosity", 1)
tube("shaft", inner, middle + overlap, size=0.08)
tube("ring", middle, outer, size=0.1)
gmsh.model.mesh.generate(2)
gmsh.model.mesh.setOrder(2)
mesh = sg.Mesh.from_gmsh()
gmsh.finalize()

case = sg.Case(mesh, units="mm-N-MPa")
case.model.space = "plane-stress"
case.body(["shaft", "ring"], sg.LinearElastic(E=E, nu=0.3))
case.contact("shaft_outside", "ring_inside", name="fit")
fit = case.step("fit", increments=1, geometry="linear")
for part in ("shaft", "ring"):
    fit.fix(f"{part}_bottom", "y")
    fit.fix(f"{part}_left", "x")

force = case.run(save=False)[-1].contact["fit"].force[0]
a, b, c = inner**2, middle**2, outer**2  # Lamé, both tubes of one material
pressure = overlap * E / middle * (b - a) * (c - b) / (2.0 * b * (c - a))
print(f"pressure {-force / middle:.5f} MPa, Lamé {pressure:.5f} MPa")
assert abs(-force / middle / pressure - 1.0) < 0.005
