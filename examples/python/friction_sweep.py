"""A rubber block dragged over a floor, for thirteen coefficients of friction at once.

    python friction_sweep.py [pull.csv]
"""

import sys
import tempfile

import numpy as np

import signorini as sg

mesh = sg.Mesh.grid(np.linspace(0.0, 20.0, 9), np.linspace(0.0, 10.0, 5), np.linspace(0.0, 10.0, 5))


def dragged(mu: float) -> sg.Case:
    """The block, pressed by 0.4 mm and then dragged by 6 mm."""
    case = sg.Case(mesh, units="mm-N-MPa")  # all cases share one mesh
    case.body("all", sg.NeoHookean(E=6.0, nu=0.3))
    case.contact("zmin", sg.Plane(normal=(0, 0, 1)), friction=mu, name="floor")
    press = case.step("press", increments=2, geometry="nonlinear")
    press.fix("zmax", "xy")
    press.move("zmax", z=-0.4)
    drag = case.step("drag", increments=10)
    drag.move("zmax", x=6.0)
    return case


coefficients = np.linspace(0.0, 0.6, 13)
runs = sg.run_many([dragged(mu) for mu in coefficients])
ends = np.array([run[-1].contact["floor"].force for run in runs])
for mu, end in zip(coefficients, ends):
    print(f"mu = {mu:.2f}: pull {-end[0]:7.2f} N, pressed by {end[2]:7.2f} N")

# where all of the block slides, the pull is that of Coulomb
slides = np.array([run[-1].contact["floor"].area_stick == 0.0 for run in runs])
assert slides.sum() >= 5 and np.allclose(-ends[slides, 0], (coefficients * ends[:, 2])[slides], rtol=1e-6, atol=1e-9)
table = sys.argv[1] if sys.argv[1:] else tempfile.mkdtemp() + "/pull.csv"
np.savetxt(table, np.column_stack([coefficients, -ends[:, 0]]), header="mu, pull_N", delimiter=",")
