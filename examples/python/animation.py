"""A rigid wheel pressed into rubber and dragged along, as an animated picture.

    python animation.py [picture.gif]
"""

import sys
import tempfile

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.collections import PolyCollection

import signorini as sg

mesh = sg.Mesh.grid(np.linspace(0.0, 20.0, 33), np.linspace(-6.0, 0.0, 10))
case = sg.Case(mesh, units="mm-N-MPa")
case.model.space = "plane-strain"
case.body("all", sg.NeoHookean(E=6.0, nu=0.3))
case.reference("axle", at=(4.0, 2.0))
wheel = case.surface("wheel surface", sg.Circle(center=(4.0, 2.0), radius=2.0), reference="axle")
case.contact("ymax", wheel, name="wheel", friction=0.2)
press = case.step("press", increments={"fixed": 4}, geometry="nonlinear")
press.fix("ymin", "xy")
press.move("axle", y=-0.8)
case.step("drag", increments={"fixed": 16}).move("axle", x=12.0)
result = case.run(save=False)

figure, axes = plt.subplots(figsize=(7, 3.5))
cells = mesh.cells["quad4"]
shown = PolyCollection([], edgecolor="k", linewidth=0.3, clim=(0.0, 2.0))
axes.add_collection(shown)
axes.set(xlim=(-1.0, 21.0), ylim=(-6.5, 2.0), aspect="equal", xlabel="x (mm)", ylabel="y (mm)")
figure.colorbar(shown, label="von Mises stress (MPa)", shrink=0.7)


def draw(index: int) -> None:
    """One frame."""
    frame = result[index]
    shown.set_verts(list((frame.points + frame["displacement"])[cells, :2]))
    shown.set_array(frame["von_mises"][cells].mean(axis=1))
    axes.set_title(f"{frame.step} {frame.time:.2f}")


file = sys.argv[1] if sys.argv[1:] else tempfile.mkdtemp() + "/wheel.gif"
FuncAnimation(figure, draw, len(result)).save(file, PillowWriter(fps=8), dpi=80)
print(f"{len(result)} frames of {result.history.nrow} increments")
for frame in result:  # reactions of the supports balance the contact
    assert np.allclose(frame["reaction_force"].sum(axis=0), -frame.contact["wheel"].force, atol=1e-5)
