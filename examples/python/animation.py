"""A rigid wheel pressed into rubber and dragged along, as an animated picture.

    python animation.py [picture.gif]
"""

import sys
import tempfile

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.collections import PolyCollection
from matplotlib.patches import Circle

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
drag = case.step("drag", increments={"fixed": 16})
drag.move("axle", x=12.0)
result = case.run(save=False)

cells = mesh.cells["quad4"]
figure, axes = plt.subplots(figsize=(7, 3.5))
shown = PolyCollection([], cmap="viridis", edgecolor="k", linewidth=0.3, clim=(0.0, 2.0))
axes.add_collection(shown)
disc = Circle((4.0, 2.0), 2.0, color="0.7")
axes.add_patch(disc)
axes.set(xlim=(-1.0, 21.0), ylim=(-6.5, 4.5), aspect="equal", xlabel="x (mm)", ylabel="y (mm)")
figure.colorbar(shown, label="von Mises stress (MPa)", shrink=0.7)


def draw(index: int) -> None:
    """One frame."""
    frame = result[index]
    shown.set_verts(list((frame.points + frame["displacement"])[cells, :2]))
    shown.set_array(frame["von_mises"][cells].mean(axis=1))
    disc.set_center((4.0 + 12.0 * max(frame.time - 1.0, 0.0), 2.0 - 0.8 * min(frame.time, 1.0)))
    axes.set_title(f"{frame.step}, time {frame.time:.2f}")


file = sys.argv[1] if sys.argv[1:] else tempfile.mkdtemp() + "/wheel.gif"
FuncAnimation(figure, draw, len(result)).save(file, PillowWriter(fps=12), dpi=80)
print(f"{len(result)} frames, drawn by {result.history.nrow} increments")
for frame in result:  # reactions balance contact
    assert np.allclose(frame["reaction_force"].sum(axis=0), -frame.contact["wheel"].force, atol=1e-5)
