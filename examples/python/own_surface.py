"""A rigid punch with the profile y = c r^4, given by a function and its gradient.

The function has to vanish on the surface and to be positive where bodies are; it need not be a true distance.
"""

from math import gamma, pi, sqrt

import numpy as np

import signorini as sg

E, nu, c, a = 1000.0, 0.3, 0.002, 1.0  # MPa, -, mm^-3, radius of contact (mm)
# Galin, Sneddon: indentation and force for a punch y = c r^n
n = 4
depth = c * a**n * sqrt(pi) * gamma(n / 2 + 1) / gamma(n / 2 + 0.5)
force = 2.0 * E / (1.0 - nu**2) * a * depth * n / (n + 1)

punch = sg.SignedDistance(
    lambda x: c * x[:, 0] ** 4 - x[:, 1],
    lambda x: np.column_stack([4.0 * c * x[:, 0] ** 3, -np.ones(len(x)), np.zeros(len(x))]),
    size=a,
)
x = np.append(np.linspace(0.0, 1.25 * a, 51), np.geomspace(1.3 * a, 1000.0 * a, 25))
y = -np.append(np.geomspace(1000.0 * a, 0.025 * a, 40), 0.0)
case = sg.Case(sg.Mesh.grid(x, y), units="mm-N-MPa")
case.model.space = "axisymmetric"
case.body("all", sg.LinearElastic(E=E, nu=nu))
case.reference("holder", at=(0.0, 0.0))
case.contact("ymax", case.surface("punch", punch, reference="holder"), name="punch-block")
press = case.step("press", increments=1, geometry="linear")
press.fix("ymin", "xy")
press.fix("xmin", "x")
press.move("holder", y=-depth)

contact = case.run(save=False)[-1].contact["punch-block"]
print(f"force  {-contact.force[1]:8.3f} N   closed form {force:8.3f} N")
print(f"radius {contact.radius:8.4f} mm  closed form {a:8.4f} mm")
assert abs(-contact.force[1] / force - 1.0) < 0.02 and abs(contact.radius / a - 1.0) < 0.03
