"""A modulus from a measured curve of force over displacement, by least squares.

The measurement is synthetic: the closed form of Hertz with 2 % noise.
"""

import numpy as np
from scipy.optimize import least_squares

import signorini as sg

radius, depth, true_E, nu = 10.0, 0.02, 1.7, 0.4  # mm, mm, MPa, -
depths = np.linspace(0.2, 1.0, 5) * depth
noise = 1.0 + 0.02 * np.random.default_rng(1).standard_normal(len(depths))
measured = 4.0 / 3.0 * true_E / (1.0 - nu**2) * np.sqrt(radius * depths**3) * noise

a = np.sqrt(radius * depth)
x = np.append(np.linspace(0.0, 1.25 * a, 26), np.geomspace(1.4 * a, 200.0 * a, 15))
y = -np.append(np.geomspace(200.0 * a, 0.05 * a, 20), 0.0)
case = sg.Case(sg.Mesh.grid(x, y), units="mm-N-MPa")
case.model.space = "axisymmetric"
gel = case.material("gel", sg.LinearElastic(E=1.0, nu=nu))
case.body("all", "gel")
case.reference("probe", at=(0.0, radius))
ball = case.surface("ball", sg.Circle(center=(0.0, radius), radius=radius), reference="probe")
case.contact("ymax", ball, name="tip")
press = case.step("press", increments={"fixed": len(depths)}, geometry="linear")
press.fix("ymin", "xy")
press.fix("xmin", "x")
press.move("probe", y=-depth)


def residual(parameters: np.ndarray) -> np.ndarray:
    """Relative differences of the forces, of a run in memory."""
    gel.E = parameters[0]
    force = -case.run(save=False).contact["tip"].force[:, 1]
    print(f"E = {gel.E:.5f} MPa: forces {np.array2string(force, precision=5)}")
    return force / measured - 1.0


fit = least_squares(residual, x0=[1.0])
error = np.sqrt(2.0 * fit.cost / (len(depths) - 1) / (fit.jac.T @ fit.jac)[0, 0])
print(f"E = {fit.x[0]:.3f} ± {error:.3f} MPa, true {true_E} MPa")
assert abs(fit.x[0] / true_E - 1.0) < 0.05
