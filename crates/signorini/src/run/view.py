"""Shows these results in ParaView.

    pvpython view.py                pictures of the last time: view.png, contact.png; and the state results.pvsm
    pvpython view.py FIELD          coloured by another field
    paraview --state=results.pvsm   what the pictures show, to turn and to play

The colours reach from the smallest to the largest value of all times. Displacements are drawn as large as they are, or
enlarged where they could not be seen.
"""

import os
import sys

from paraview import simple

HERE = os.path.dirname(os.path.abspath(__file__))
FIELDS = ["von_mises", "stress", "contact_pressure", "displacement"]
CONTACT = ["contact_pressure", "contact_gap"]
# displacements are drawn at least as large as this part of the model
SEEN = 0.05


def ranges(reader, name, on):
    """Smallest and largest value of a field, over all times: its size, where it has components."""
    low, high = float("inf"), float("-inf")
    for time in reader.TimestepValues or [0.0]:
        reader.UpdatePipeline(time)
        array = (reader.PointData if on == "POINTS" else reader.CellData).GetArray(name)
        if array is None:
            continue
        first, last = array.GetRange(-1 if array.GetNumberOfComponents() > 1 else 0)
        low, high = min(low, first), max(high, last)
    return (low, high) if low <= high else (0.0, 1.0)


def place(reader, names):
    """The first of these fields that the results have, and whether it is at points or in cells."""
    for name in names:
        if reader.PointData.GetArray(name) is not None:
            return name, "POINTS"
        if reader.CellData.GetArray(name) is not None:
            return name, "CELLS"
    return None, "POINTS"


def factor(reader):
    """What displacements are multiplied with."""
    low, high = ranges(reader, "displacement", "POINTS")
    bounds = reader.GetDataInformation().GetBounds()
    size = max(bounds[2 * axis + 1] - bounds[2 * axis] for axis in range(3))
    if not high > 0.0 or high >= SEEN * size:
        return 1.0
    return float("%.1g" % (SEEN * size / high))


def draw(list_of_frames, names, picture, scale=None):
    """Draws the last time of a list of frames into a picture; returns the factor of its displacements."""
    reader = simple.PVDReader(FileName=os.path.join(HERE, list_of_frames))
    times = reader.TimestepValues or [0.0]
    reader.UpdatePipeline(times[-1])
    name, on = place(reader, names)
    view = simple.CreateView("RenderView")
    view.ViewSize = [1200, 900]
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesLabelColor = [0.0, 0.0, 0.0]
    scale = factor(reader) if scale is None else scale
    limits = ranges(reader, name, on) if name else None
    shown = reader
    if reader.PointData.GetArray("displacement") is not None:
        shown = simple.WarpByVector(Input=reader, Vectors=["POINTS", "displacement"], ScaleFactor=scale)
    display = simple.Show(shown, view)
    display.Representation = "Surface With Edges"
    display.EdgeColor = [0.3, 0.3, 0.3]
    if list_of_frames == "contact.pvd":
        # surfaces of plane models are lines
        display.Representation = "Surface"
        display.LineWidth = 6
    # quadratic faces are curved
    if hasattr(display, "NonlinearSubdivisionLevel"):
        display.NonlinearSubdivisionLevel = 2
    if name:
        simple.ColorBy(display, (on, name))
        colours = simple.GetColorTransferFunction(name)
        colours.ApplyPreset("Viridis (matplotlib)", True)
        colours.RescaleTransferFunction(*limits)
        colours.AutomaticRescaleRangeMode = "Never"
        bar = simple.GetScalarBar(colours, view)
        bar.Title = name.replace("_", " ")
        bar.ComponentTitle = ""
        bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
        display.SetScalarBarVisibility(view, True)
    look(view, reader.GetDataInformation().GetBounds())
    view.ViewTime = times[-1]
    simple.GetAnimationScene().AnimationTime = times[-1]
    simple.Render(view)
    simple.SaveScreenshot(os.path.join(HERE, picture), view, ImageResolution=[1200, 900])
    shown_range = "%.4g to %.4g" % limits if limits else "nothing"
    print("%s: %s, %s; displacements times %g" % (picture, name, shown_range, scale))
    return scale


def look(view, bounds):
    """From in front at a plane model, else from a corner."""
    flat = bounds[5] - bounds[4] <= 1e-9 * (bounds[1] - bounds[0] + bounds[3] - bounds[2])
    view.CameraViewUp = [0.0, 1.0, 0.0] if flat else [0.0, 0.0, 1.0]
    middle = [0.5 * (bounds[2 * axis] + bounds[2 * axis + 1]) for axis in range(3)]
    aside = [0.0, 0.0, 1.0] if flat else [0.6, -1.0, 0.5]
    view.CameraFocalPoint = middle
    view.CameraPosition = [m + a for m, a in zip(middle, aside)]
    view.CameraParallelProjection = 1 if flat else 0
    simple.ResetCamera(view)


def main():
    simple._DisableFirstRenderCameraReset()
    scale = draw("results.pvd", sys.argv[1:2] + FIELDS, "view.png")
    if os.path.exists(os.path.join(HERE, "contact.pvd")):
        draw("contact.pvd", CONTACT, "contact.png", scale)
    state = os.path.join(HERE, "results.pvsm")
    simple.SaveState(state)
    print("state: " + state)


main()
