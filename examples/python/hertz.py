"""A rigid ball pressed on an elastic block: the contact pressure compared with that of Hertz.

    python hertz.py [picture.png]
"""

import sys
import tempfile

import matplotlib.pyplot as plt
import numpy as np

import signorini as sg

E, nu, radius, depth = 1000.0, 0.3, 10.0, 0.005  # MPa, -, mm, mm
modulus = E / (1.0 - nu**2)
a = np.sqrt(radius * depth)  # Hertz: radius of contact, force, largest pressure
force = 4.0 / 3.0 * modulus * np.sqrt(radius * depth**3)
peak = 1.5 * force / (np.pi * a**2)

x = np.append(np.linspace(0.0, 1.25 * a, 51), np.geomspace(1.3 * a, 1000.0 * a, 25))
y = -np.append(np.geomspace(1000.0 * a, 0.025 * a, 40), 0.0)
case = sg.Case(sg.Mesh.grid(x, y), units="mm-N-MPa")
case.model.space = "axisymmetric"
case.body("all", sg.LinearElastic(E=E, nu=nu))
case.reference("ball", at=(0.0, radius))
ball = case.surface("sphere", sg.Circle(center=(0.0, radius), radius=radius), reference="ball")
case.contact("ymax", ball, name="ball")
press = case.step("press", increments=1, geometry="linear")
press.fix("ymin", "xy")
press.fix("xmin", "x")
press.move("ball", y=-depth)

contact = case.run(save=False)[-1].contact["ball"]
print(f"force         {-contact.force[1]:7.3f} N    Hertz {force:7.3f} N")
print(f"radius        {contact.radius:7.4f} mm   Hertz {a:7.4f} mm")
print(f"peak pressure {contact.peak:7.3f} MPa  Hertz {peak:7.3f} MPa")
assert abs(-contact.force[1] / force - 1.0) < 0.02 and abs(contact.peak / peak - 1.0) < 0.02

r = np.linspace(0.0, a, 200)
figure, axes = plt.subplots(layout="constrained")
axes.plot(r, peak * np.sqrt(1.0 - (r / a) ** 2), label="Hertz")
axes.plot(contact.points[:, 0], contact.pressure, "o", label="signorini")
axes.set(xlabel="distance from the axis (mm)", ylabel="contact pressure (MPa)", xlim=(0.0, 1.25 * a))
axes.legend()
figure.savefig(sys.argv[1] if sys.argv[1:] else tempfile.mkdtemp() + "/hertz.png", dpi=150)
