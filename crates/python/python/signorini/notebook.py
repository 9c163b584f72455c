"""What notebooks and terminals show: progress of runs, and thumbnails."""

from __future__ import annotations

import base64
import sys
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol, cast

from ._optional import has

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from .case import Case
    from .mesh import Mesh

PERIOD = 0.1
"""Seconds between two drawings."""

MOST_FACES = 4000
"""Larger surfaces are drawn by every n-th of their faces."""


class Listener(Protocol):
    """Shows the events of a run."""

    def hear(self, event: Mapping[str, Any]) -> None:
        """Something happened: kinds are those of events.jsonl."""
        ...

    def close(self) -> None:
        """The run is over."""
        ...


def listener(case: Case, progress: bool | None) -> Listener | None:
    """What shows the progress of a run: a plot in notebooks with ipywidgets, lines of text elsewhere."""
    if progress is False:
        return None
    if in_notebook():
        if has("ipywidgets") and has("matplotlib"):
            return LivePlot(case)
        return Text(case)
    if progress or sys.stderr.isatty():
        return Text(case)
    return None


def in_notebook() -> bool:
    """Whether this is a kernel of Jupyter."""
    shell = sys.modules.get("IPython")
    current = None if shell is None else shell.get_ipython()
    return current is not None and type(current).__name__ == "ZMQInteractiveShell"


def _duration(case: Case) -> float:
    return sum(float(step.duration) for step in case.steps) or 1.0


class Text:
    """One line that is rewritten on stderr; a line for each step where stderr is no terminal."""

    def __init__(self, case: Case) -> None:
        self._duration = _duration(case)
        self._last = 0.0
        self._line = ""
        self._step = ""
        self._rewrites = sys.stderr.isatty() or in_notebook()

    def hear(self, event: Mapping[str, Any]) -> None:
        """Draws increments, at most ten times a second."""
        if event.get("ev") not in ("iteration", "increment"):
            return
        now = time.monotonic()
        if event["ev"] == "increment":
            self._line = self.line(event)
            if not self._rewrites and event["step"] != self._step:
                print(self._line, file=sys.stderr)
            self._step = event["step"]
        if self._rewrites and now - self._last >= PERIOD:
            self._last = now
            more = f"  iter {event['iter']}" if event["ev"] == "iteration" else ""
            self._draw(self._line + more)

    def line(self, event: Mapping[str, Any]) -> str:
        """An increment in one line."""
        part = min(1.0, float(event["time"]) / self._duration)
        bar = "━" * round(20 * part)
        return f" {event['step']} {bar:<20} {part:4.0%}  inc {event['inc']}  time {event['time']:.4g}"

    def _draw(self, line: str) -> None:
        print(f"\r{line:<78}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        """Ends the line."""
        if self._rewrites and self._line:
            self._draw(self._line)
            print(file=sys.stderr)


class LivePlot:
    """Residuals of iterations and contact forces over time, redrawn while the run goes on."""

    def __init__(self, case: Case) -> None:
        from ._optional import need

        widgets = need("ipywidgets", "the live plot")
        display = need("IPython.display", "the live plot")
        self._duration = _duration(case)
        self._residuals: list[float] = []
        self._times: list[float] = []
        self._forces: dict[str, list[float]] = {}
        self._last = 0.0
        self._bar = widgets.FloatProgress(min=0.0, max=1.0, layout=widgets.Layout(width="60%"))
        self._label = widgets.Label("reading")
        self._image = widgets.Image(format="png")
        box = widgets.VBox([widgets.HBox([self._bar, self._label]), self._image])
        display.display(box)

    def hear(self, event: Mapping[str, Any]) -> None:
        """Collects, and redraws at most twice a second."""
        kind = event.get("ev")
        if kind == "iteration":
            self._residuals.append(float(event["residual"]))
        elif kind == "increment":
            self._times.append(float(event["time"]))
            for name, contact in event.get("contact", {}).items():
                force = sum(float(x) ** 2 for x in contact["force"]) ** 0.5
                self._forces.setdefault(name, []).append(force)
            self._bar.value = min(1.0, float(event["time"]) / self._duration)
            self._label.value = f"{event['step']}: increment {event['inc']}, time {event['time']:.4g}"
        if time.monotonic() - self._last > 5 * PERIOD:
            self._draw()

    def _draw(self) -> None:
        import io

        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self._last = time.monotonic()
        figure: Any = Figure(figsize=(8, 2.6), layout="constrained")
        left, right = figure.subplots(1, 2)
        shown = self._residuals[-100:]
        left.semilogy(
            range(len(self._residuals) - len(shown), len(self._residuals)), [max(r, 1e-16) for r in shown], ".-"
        )
        left.set(xlabel="iteration", ylabel="residual")
        for name, forces in self._forces.items():
            right.plot(self._times[: len(forces)], forces, ".-", label=name)
        right.set(xlabel="time", ylabel="contact force")
        if self._forces:
            right.legend()
        out = io.BytesIO()
        cast("Any", FigureCanvasAgg(figure)).print_png(out)
        self._image.value = out.getvalue()

    def close(self) -> None:
        """Draws the end."""
        self._draw()


# -- thumbnails ---------------------------------------------------------------------------------------------------


def thumbnail(mesh: Mesh | None, displacement: NDArray[np.float64] | None = None, size: int = 260) -> str:
    """A picture of the surface in HTML: by PyVista in a notebook that has it, else lines in SVG."""
    if mesh is None or len(mesh.points) == 0:
        return ""
    points = mesh.points if displacement is None else mesh.points + displacement
    if in_notebook() and has("pyvista"):
        try:
            return _png(mesh, points, size)
        except Exception:  # no display, no graphics: lines will do
            pass
    try:
        return svg(mesh, points, size)
    except Exception:  # a picture is never worth a failure
        return ""


def _png(mesh: Mesh, points: NDArray[np.float64], size: int) -> str:
    import io

    pyvista: Any = __import__("pyvista")
    grid = mesh.to_pyvista()
    grid.points = points
    plotter = pyvista.Plotter(off_screen=True, window_size=(2 * size, 2 * size))
    plotter.add_mesh(grid, color="lightsteelblue", show_edges=len(points) < 5000)
    if mesh.dim == 2:
        plotter.view_xy()
    picture = plotter.screenshot(return_img=True)
    plotter.close()
    image: Any = __import__("PIL.Image", fromlist=["Image"])
    out = io.BytesIO()
    image.fromarray(picture).save(out, format="png")
    data = base64.b64encode(out.getvalue()).decode()
    return f'<img width="{size}" src="data:image/png;base64,{data}"/>'


def svg(mesh: Mesh, points: NDArray[np.float64], size: int = 260) -> str:
    """The outer faces, seen from (1, -2, 1), as polygons in SVG: the far ones first."""
    import numpy as np

    from ._elements import ELEMENTS

    faces: dict[int, list[Any]] = {}
    for name, block in mesh.solids():
        for corners in ELEMENTS[name].corners:
            faces.setdefault(len(corners), []).append(block[:, corners])
    outer: list[NDArray[Any]] = []
    for found in faces.values():
        stacked = np.concatenate(found)
        if mesh.dim == 3:
            _, first, count = np.unique(np.sort(stacked, axis=1), axis=0, return_index=True, return_counts=True)
            stacked = stacked[first[count == 1]]
        outer.append(stacked[:: max(1, len(stacked) // MOST_FACES)])
    flat = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])
    depth = np.zeros(3)
    if mesh.dim == 3:
        view = np.array([1.0, -2.0, 1.0]) / np.sqrt(6.0)
        right = np.cross([0.0, 0.0, 1.0], view)
        right /= np.linalg.norm(right)
        flat, depth = np.column_stack([right, np.cross(view, right)]), view
    seen = points @ flat
    low, high = seen.min(axis=0), seen.max(axis=0)
    scale = (size - 8) / max(float((high - low).max()), 1e-300)
    seen = (seen - low) * scale + 4
    height = float((high - low)[1]) * scale + 8
    seen[:, 1] = height - seen[:, 1]
    polygons: list[tuple[float, str]] = []
    for stacked in outer:
        far = (points @ depth)[stacked].mean(axis=1)
        for at, nodes in zip(far, stacked, strict=True):
            path = " ".join(f"{x:.1f},{y:.1f}" for x, y in seen[nodes])
            polygons.append((float(at), f'<polygon points="{path}"/>'))
    drawn = "".join(polygon for _, polygon in sorted(polygons, key=lambda one: one[0]))
    return (
        f'<svg width="{size}" height="{height:.0f}" fill="#dfe7f2" stroke="#4a6285" stroke-width="0.5" '
        f'stroke-linejoin="round">{drawn}</svg>'
    )
