"""Two programs coupled: a spring is pressed by gas in a closed chamber, whose pressure falls as it yields.

Each time step repeats the increment from a saved state until the gas and the spring agree.
"""

import numpy as np

import signorini as sg

E, height, area, chamber, start = 2.0, 10.0, 25.0, 40.0, 0.5  # MPa, mm, mm^2, mm^3, MPa


def gas(volume: float, time: float) -> float:
    """The other program: an isothermal gas that is fed over time."""
    return start * time * chamber / volume


side = area**0.5
mesh = sg.Mesh.grid(np.linspace(0.0, side, 3), np.linspace(0.0, side, 3), np.linspace(0.0, height, 5))
case = sg.Case(mesh, units="mm-N-MPa")
case.body("all", sg.LinearElastic(E=E, nu=0.0))
case.contact("zmin", sg.Plane(normal=(0, 0, 1)), name="seat")
step = case.step("feed", geometry="linear")
step.fix("xmin", "x")
step.fix("ymin", "y")
load = step.load("zmax", pressure=0.0, amplitude=[[0.0, 1.0], [1.0, 1.0]])  # the present one, not ramped

stepper = case.stepper()
pressure = 0.0
while not stepper.done:
    state, tries = stepper.save(), 0
    while True:
        frame, tries = stepper.advance(0.25), tries + 1
        sinking = -frame["displacement"][:, 2].min()
        answer = gas(chamber + area * sinking, frame.time)
        if abs(answer - pressure) < 1e-10:
            break
        load.pressure = pressure = answer  # takes effect at the next advance
        stepper.restore(state)
    force = frame.contact["seat"].force[2]
    print(f"time {frame.time:.2f}: {tries:2d} tries, pressure {pressure:.6f} MPa, force on the seat {force:.4f} N")
    # both laws hold: p V = c t, and the spring is linear
    exact = 0.5 * (np.sqrt(chamber**2 + 4.0 * start * frame.time * chamber * area * height / E) - chamber) / area
    assert np.isclose(sinking, exact, rtol=1e-8) and np.isclose(force, pressure * area, rtol=1e-8)
