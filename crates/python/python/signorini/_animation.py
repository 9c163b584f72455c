"""Frames as an animated picture, drawn by PyVista and written by Pillow, which comes with it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._optional import need

if TYPE_CHECKING:
    from .result import Floats, Frame

ENDINGS = (".gif", ".webp", ".png")
COLOURS = 128
"""Of a .gif, which may have 256: fewer make smaller files."""
ROOM = 0.85
"""How much of the picture the frames take, so that the bar of colours has its place."""


def write(
    path: str | os.PathLike[str],
    frames: Sequence[Frame],
    name: str,
    warp: float,
    *,
    component: int | None,
    fps: float,
    size: tuple[int, int],
    **options: Any,
) -> str:
    """Writes frames, at least one, with one view and one range of colours, and returns the path."""
    ending = os.path.splitext(path)[1].lower()
    if ending not in ENDINGS:
        raise ValueError(f"animations end in {', '.join(ENDINGS)}, found {os.fspath(path)!r}")
    need("pyvista", "Result.animate")
    image = need("PIL.Image", "Result.animate")
    box = bounds(frames, warp)
    options.setdefault("clim", limits(frames, name, component))
    pictures: list[Any] = []
    for frame in frames:
        plotter = frame.plotter(name, warp, component=component, off_screen=True, **options)
        plotter.window_size = list(size)
        plotter.reset_camera(bounds=box)
        plotter.camera.zoom(ROOM)
        pictures.append(image.fromarray(plotter.screenshot(return_img=True)))
        plotter.close()
    if ending == ".gif":
        # one palette and no dithering: nothing flickers, and files stay small
        sheet = image.new("RGB", (size[0], size[1] * len(pictures)))
        for place, picture in enumerate(pictures):
            sheet.paste(picture, (0, place * size[1]))
        palette = sheet.quantize(COLOURS, method=image.Quantize.MAXCOVERAGE)
        pictures = [picture.quantize(palette=palette, dither=0) for picture in pictures]
    pictures[0].save(path, save_all=True, append_images=pictures[1:], duration=round(1000.0 / fps), loop=0)
    return os.fspath(path)


def bounds(frames: Sequence[Frame], warp: float) -> list[float]:
    """What deformed frames take up, in the order of VTK: smallest and largest x, y and z."""
    lower, upper = np.full(3, np.inf), np.full(3, -np.inf)
    for frame in frames:
        places = frame.points + warp * frame["displacement"] if warp else frame.points
        lower, upper = np.minimum(lower, places.min(axis=0)), np.maximum(upper, places.max(axis=0))
    return [float(x) for x in np.column_stack([lower, upper]).ravel()]


def limits(frames: Sequence[Frame], name: str, component: int | None) -> tuple[float, float]:
    """The smallest and the largest value of a field, of a component or of the norm."""

    def drawn(frame: Frame) -> Floats:
        values = frame.shown(name)
        if values.ndim == 1:
            return values
        return np.linalg.norm(values, axis=1) if component is None else values[:, component]

    ends = [(float(values.min()), float(values.max())) for values in map(drawn, frames)]
    return min(low for low, _ in ends), max(high for _, high in ends)
