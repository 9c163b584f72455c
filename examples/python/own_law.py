"""A rough surface: a contact law in Python, p = c g^2 with the penetration g, for its asperities.

The law returns pressures and their derivatives by the gap, which is negative in penetration.
"""

import numpy as np

import signorini as sg

E, height, c, load = 200.0, 10.0, 5e4, 3.0  # MPa, mm, MPa/mm^2, MPa


def asperities(gap: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pressures and their slopes at many points at once."""
    depth = np.maximum(-gap, 0.0)
    return c * depth**2, -2.0 * c * depth


case = sg.Case(sg.Mesh.grid(*[np.linspace(0.0, height, 4)] * 3), units="mm-N-MPa")
case.body("all", sg.LinearElastic(E=E, nu=0.0))
floor = case.contact("zmin", sg.Plane(normal=(0, 0, 1)), name="floor", enforcement=sg.ContactLaw(asperities))
press = case.step("press", increments=5, geometry="linear")
press.fix("xmin", "x")
press.fix("ymin", "y")
press.load("zmax", pressure=load)

result = case.run(save=False)
contact = result[-1].contact["floor"]
top = result[-1]["displacement"][:, 2].min()
gap = -np.sqrt(load / c)
print(f"gap {contact.gap_min:.6f} mm, closed form {gap:.6f} mm")
print(f"top {top:.6f} mm, closed form {gap - load * height / E:.6f} mm")
assert np.allclose(contact.gap, gap, rtol=1e-6) and np.isclose(top, gap - load * height / E, rtol=1e-6)
