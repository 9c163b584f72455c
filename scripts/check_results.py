#!/usr/bin/env python3
"""Open the results of a run as a viewer does, and check every frame by value.

    python   scripts/check_results.py RESULTS_DIR [--expected FILE.json]     reads with PyVista
    pvpython scripts/check_results.py RESULTS_DIR [--expected FILE.json]     reads with ParaView

Checked are, for every frame that results.pvd and, where there is contact, contact.pvd list:
the time; the number of points; the arrays with their components and names; von Mises stress against the stress;
contact traction over area against contact force, by node or, of mortar, whose tractions are spread over facets, in all,
up to what the angles between these facets take from a sum of forces along their normals;
contact force, pressure and gap against history.csv and summary.json (where contact is in Gauss points, nodes have means
that exceed no extreme of the history; of two passes, gaps of the other side are smaller, maybe);
displacements that history.csv follows at nodes whose place case.resolved.toml gives. Numbers must agree to --rtol, relative to the largest of their kind.

The expected values, every key optional, frames counted from 0, rows from 1, nodes named by their reference position.
Numbers of the history must agree relative to "scale", which is the value itself where it is absent; displacements
relative to the largest of their frame:

    { "rtol": 1e-8, "frames": 61, "points": 12,
      "history":      [ { "row": 60, "column": "tip.force_z", "value": 68.9563910152 }, ... ],
      "displacement": [ { "frame": 60, "at": [0, 0, 1], "value": [0.0, -0.005, -0.382] }, ... ] }

The last line says how many checks passed and failed. Exit code: 0 all passed, 1 some failed, 2 wrong command line or
unreadable files.
"""

import argparse
import csv
import json
import math
import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from check_vtu import array_values  # noqa: E402

# of cells of a contact surface: lines, triangles and quadrilaterals, by the numbers of VTK
CORNERS = {3: 2, 21: 2, 5: 3, 22: 3, 9: 4, 23: 4, 28: 4}
TENSOR = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]
VOLUME_ARRAYS = {"displacement": 3, "stress": 6, "von_mises": 1, "reaction_force": 3}
WITH_CONTACT = {"contact_pressure": 1}
CONTACT_ARRAYS = {
    "contact_gap": 1,
    "contact_pressure": 1,
    "contact_pressure_max": 1,
    "contact_multiplier": 1,
    "contact_multiplier_traction": 3,
    "contact_status": 1,
    "contact_force": 3,
    "contact_traction": 3,
    "contact_area": 1,
    "contact_slip": 3,
}
ABSENT = -1
AXES = "xyz"
SHOWN = 40


class Unreadable(Exception):
    pass


class Checks:
    """Counts what holds and prints what does not."""

    def __init__(self, rtol):
        self.rtol = rtol
        self.passed = 0
        self.failed = 0

    def that(self, holds, what):
        if holds:
            self.passed += 1
        else:
            self.failed += 1
            if self.failed <= SHOWN:
                print(f"FAILED  {what}")
        return holds

    def near(self, what, got, expected, scale, rtol=None):
        """Numbers agree relative to `scale`; NaN agrees with NaN."""
        rtol = self.rtol if rtol is None else rtol
        got, expected = aslist(got), aslist(expected)
        pairs = list(zip(got, expected))
        holds = len(got) == len(expected) and all(
            (a != a and b != b) or abs(a - b) <= rtol * scale for a, b in pairs
        )
        return self.that(holds, f"{what}: {show(got)}, expected {show(expected)} to {rtol:g} of {scale:.6g}")


def aslist(x):
    return list(x) if isinstance(x, (list, tuple)) else [x]


def show(values):
    text = ", ".join(repr(v) for v in values[:6])
    return f"[{text}{', ...' if len(values) > 6 else ''}]" if len(values) != 1 else text


# ---- reading ---------------------------------------------------------------------------------------------------


def blocks(data):
    """The grids of a data object, whether it is one or holds several."""
    if data is None:
        return []
    if data.IsA("vtkMultiBlockDataSet"):
        return [grid for i in range(data.GetNumberOfBlocks()) for grid in blocks(data.GetBlock(i))]
    if data.IsA("vtkPartitionedDataSetCollection"):
        parts = range(data.GetNumberOfPartitionedDataSets())
        return [grid for i in parts for grid in blocks(data.GetPartitionedDataSet(i))]
    if data.IsA("vtkPartitionedDataSet"):
        return [grid for i in range(data.GetNumberOfPartitions()) for grid in blocks(data.GetPartition(i))]
    return [data]


def paraview_frames(path):
    from paraview import simple
    from paraview import servermanager

    reader = simple.PVDReader(FileName=path)
    reader.UpdatePipelineInformation()
    times = [float(t) for t in reader.TimestepValues] if reader.TimestepValues is not None else []
    for time in times:
        reader.UpdatePipeline(time)
        yield time, blocks(servermanager.Fetch(reader))
    simple.Delete(reader)


def pyvista_frames(path):
    import pyvista

    reader = pyvista.get_reader(path)
    for time in list(reader.time_values):
        reader.set_active_time_value(time)
        yield float(time), blocks(reader.read())


def viewer():
    """The reader of a .pvd file, and its name: ParaView where this is pvpython, else PyVista."""
    try:
        import paraview

        return paraview_frames, f"ParaView {paraview.__version__}"
    except ImportError:
        pass
    try:
        import pyvista

        return pyvista_frames, f"PyVista {pyvista.__version__}"
    except ImportError as error:
        raise Unreadable("neither ParaView's modules nor PyVista can be imported") from error


def read_history(path):
    """The rows of history.csv, numbers where they are numbers."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    text = ("step",)
    return [{k: v if k in text or v == "" else float(v) for k, v in row.items()} for row in rows]


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def read_case(path):
    """The resolved case; nothing where there is none."""
    if not os.path.exists(path):
        return {}
    import tomllib

    with open(path, "rb") as file:
        return tomllib.load(file)


# ---- what a frame holds ----------------------------------------------------------------------------------------


def tuples(array):
    n = array.GetNumberOfComponents()
    flat = array_values(array)
    return [flat[i : i + n] for i in range(0, len(flat), n)]


def points_of(grid):
    points = grid.GetPoints()
    return tuples(points.GetData()) if points is not None else []


def largest(values):
    return max((abs(v) for v in values if v == v), default=0.0)


def total(vectors):
    return [math.fsum(v[i] for v in vectors) for i in range(3)]


def von_mises(s):
    xx, yy, zz, xy, yz, xz = s
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return math.sqrt(0.5 * normal + 3.0 * (xy * xy + yz * yz + xz * xz))


def check_arrays(checks, what, grid, expected):
    """The arrays that a frame must hold, by name, as flat lists of numbers; nothing where one is wrong."""
    npoint = grid.GetNumberOfPoints()
    found = {}
    for name, ncomponent in expected.items():
        array = grid.GetPointData().GetArray(name)
        if not checks.that(array is not None, f"{what}: there is no point array {name!r}"):
            continue
        shape = (array.GetNumberOfTuples(), array.GetNumberOfComponents())
        if checks.that(shape == (npoint, ncomponent), f"{what}: {name} is {shape}, expected {(npoint, ncomponent)}"):
            found[name] = array
    return found if len(found) == len(expected) else None


def check_time(checks, what, grid, time):
    value = grid.GetFieldData().GetArray("TimeValue")
    if checks.that(value is not None and value.GetNumberOfTuples() == 1, f"{what}: there is no TimeValue"):
        checks.near(f"{what}: TimeValue", value.GetTuple1(0), time, 1.0, 0.0)


def check_volume(checks, what, grid, contact):
    """One frame of the volume; returns its displacements."""
    wanted = VOLUME_ARRAYS | (WITH_CONTACT if contact else {})
    arrays = check_arrays(checks, what, grid, wanted)
    if arrays is None:
        return None
    labels = [arrays["stress"].GetComponentName(i) for i in range(6)]
    # without names of its own an array of six components is labelled like this by ParaView
    checks.that(labels in (TENSOR, [None] * 6), f"{what}: stress is labelled {labels}, expected {TENSOR}")
    stress = tuples(arrays["stress"])
    mises = array_values(arrays["von_mises"])
    # where a stress is one pressure alone, it leaves nothing but rounding
    scale = largest(x for s in stress for x in s)
    checks.near(f"{what}: von_mises of the stress", mises, [von_mises(s) for s in stress], scale)
    if contact:
        pressure = array_values(arrays["contact_pressure"])
        checks.that(all(p >= 0.0 for p in pressure), f"{what}: a contact pressure pulls")
    for name in wanted:
        finite = all(map(math.isfinite, array_values(arrays[name])))
        checks.that(finite, f"{what}: {name} is not finite everywhere")
    vectors = grid.GetPointData().GetVectors()
    active = vectors.GetName() if vectors is not None else None
    checks.that(active == "displacement", f"{what}: the active vector is {active!r}, expected 'displacement'")
    return tuples(arrays["displacement"])


def bends(grid):
    """1 - cos of the largest angle between the facets that meet in each point, as deformed where that is known."""
    at = points_of(grid)
    moved = grid.GetPointData().GetArray("displacement")
    if moved is not None:
        at = [[x + u for x, u in zip(p, d)] for p, d in zip(at, tuples(moved))]
    way = lambda a, b: [y - x for x, y in zip(at[a], at[b])]  # noqa: E731
    around = [[] for _ in at]
    for i in range(grid.GetNumberOfCells()):
        ids = grid.GetCell(i).GetPointIds()
        nodes = [ids.GetId(k) for k in range(ids.GetNumberOfIds())]
        n = CORNERS.get(grid.GetCellType(i))
        if n is None:
            continue
        across = [0.0, 0.0, 1.0] if n == 2 else way(nodes[1], nodes[n - 1])
        (x, y, z), (u, v, w) = way(nodes[0], nodes[n // 2]), across
        normal = [y * w - z * v, z * u - x * w, x * v - y * u]
        size = math.hypot(*normal)
        for node in nodes if size > 0.0 else []:
            around[node].append([c / size for c in normal])
    cosine = lambda a, b: math.fsum(x * y for x, y in zip(a, b))  # noqa: E731
    return [1.0 - min((cosine(a, b) for a in normals for b in normals), default=1.0) for normals in around]


def check_contact(checks, what, grid, kinds):
    """One part of a contact frame; returns force, its scale, largest pressure and smallest gap.

    Only of points at nodes, in one pass, is the traction at a node its force over its area. Of mortar, that holds for
    the sums alone; others are means.
    """
    one_pass, mortar = not kinds["two passes"], bool(kinds["mortar"])
    arrays = check_arrays(checks, what, grid, CONTACT_ARRAYS)
    if arrays is None:
        return None
    status = array_values(arrays["contact_status"])
    gap = array_values(arrays["contact_gap"])
    pressure = array_values(arrays["contact_pressure"])
    peak = array_values(arrays["contact_pressure_max"])
    force = tuples(arrays["contact_force"])
    traction = tuples(arrays["contact_traction"])
    area = array_values(arrays["contact_area"])
    checks.that(all(s in (-1, 0, 1, 2, 3) for s in status), f"{what}: unknown status among {sorted(set(status))}")
    pairs = list(zip(status, gap))
    checks.that(all(g == g for s, g in pairs if s != ABSENT), f"{what}: a candidate has no gap")
    pulls = any(p < 0.0 for p in pressure) and not kinds["pulling"]
    checks.that(not pulls, f"{what}: a contact pressure pulls")
    slack = 1e-9 * largest(peak)
    below = all(p <= q + slack for p, q in zip(pressure, peak))
    checks.that(below, f"{what}: a mean pressure at a node is above the largest pressure around it")
    idle = [p for p, s in zip(pressure, status) if s <= 0]
    checks.that(largest(idle) == 0.0 or not one_pass, f"{what}: an open node has a pressure")
    scale = largest(x for f in force for x in f)
    spread = [[x * a for x in t] for t, a in zip(traction, area)]
    if mortar:
        # as far as the run has converged: multipliers are unknowns
        slack = 1e-6 * scale + math.fsum(b * math.hypot(*x) for b, x in zip(bends(grid), spread))
        checks.near(f"{what}: sum of traction times area", total(spread), total(force), slack, 1.0)
    elif one_pass and not kinds["in facets"]:
        for i, f in enumerate(force):
            if area[i] > 0.0:
                checks.near(f"{what}: traction times area of point {i}", spread[i], f, scale)
    gaps = [g for s, g in pairs if s != ABSENT]
    extremes = {"pressure_max": max(peak, default=0.0), "gap_min": min(gaps, default=0.0)}
    return {"force": total(force), "scale": scale, **extremes}


# ---- the whole run ---------------------------------------------------------------------------------------------


def row_at(history, time):
    """The last row of this time."""
    scale = max((abs(r["time"]) for r in history), default=1.0)
    rows = [r for r in history if abs(r["time"] - time) <= 1e-12 * scale]
    return rows[-1] if rows else None


def contact_names(history):
    return [c[: -len(".pressure_max")] for c in (history[0] if history else {}) if c.endswith(".pressure_max")]


def kinds_of_contact(case):
    """The names of contacts whose nodes do not have each its own force, gap and pressure, by what they are.

    Nodes of contacts with points inside of facets have means of what is around them; of two passes, points of the other
    side have gaps of their own; mortar spreads the traction of a node over facets.
    """
    contacts = case.get("contact", [])
    found = {"all" for c in contacts if "all" in c}
    named = lambda which: {c.get("name", "all") for c in contacts if which(c)}  # noqa: E731
    return {
        # pairs that nobody names: by mortar where the program chooses, each name for all places where two bodies meet
        "found": found,
        "in facets": named(lambda c: c["method"] == "gauss-point"),
        "two passes": named(lambda c: c.get("passes") == 2),
        "pulling": named(lambda c: c.get("tied") or "adhesion" in c),
        "mortar": named(lambda c: c["method"] == "mortar" or ("all" in c and c["method"] == "auto")),
    }


def compare_contact(checks, what, parts, row, names, kinds, scales):
    """Parts of a contact frame with the row of history.csv of their time."""
    column = lambda name, quantity: row[f"{name}.{quantity}"]  # noqa: E731
    forces = lambda name: [column(name, f"force_{a}") for a in AXES]  # noqa: E731
    if kinds["found"]:
        # forces of columns are those on the body that is named first, and nobody names roles
        return
    if len(parts) != len(names):
        force = total([p["force"] for p in parts])
        scale = max(scales["force"], *(p["scale"] for p in parts))
        checks.near(f"{what}: sum of contact_force", force, total([forces(n) for n in names]), scale)
        return
    in_facets, two_passes = kinds["in facets"], kinds["two passes"]
    for part, name in zip(parts, names):
        # where forces balance, rounding is that of single nodes
        scale = max(scales["force"], part["scale"])
        checks.near(f"{what}: sum of contact_force of {name}", part["force"], forces(name), scale)
        for quantity in ("pressure_max", "gap_min"):
            value = column(name, quantity)
            if quantity == "pressure_max" or name not in in_facets | two_passes:
                checks.near(f"{what}: {quantity} of {name}", part[quantity], value, scales[quantity])
                continue
            slack = checks.rtol * scales[quantity]
            beyond = value - part[quantity]
            checks.that(beyond <= slack, f"{what}: {quantity} of {name}: {part[quantity]!r} at nodes exceeds {value!r}")


def nearest(points, at):
    return min(range(len(points)), key=lambda i: math.dist(points[i], at)) if points else None


def followed_displacements(case, history, points):
    """Columns of history.csv that are displacements of a node of the case: (column, point, component)."""
    nodes = {int(n[0]): [float(x) for x in n[1:]] for n in case.get("mesh", {}).get("nodes", [])}
    found = []
    for entry in case.get("output", {}).get("history", []):
        node = nodes.get(entry.get("node"))
        for quantity in aslist(entry.get("quantity", [])):
            column = f"{entry.get('name')}.{quantity}"
            known = node is not None and quantity.startswith("displacement.") and column in history[0]
            if known:
                at = nearest(points, (node + [0.0, 0.0])[:3])
                found.append((column, at, AXES.index(quantity[-1])))
    return found


def require(folder, *files):
    for file in files:
        path = os.path.join(folder, file)
        if not os.path.isfile(path):
            raise Unreadable(f"{path} does not exist")


def check_run(checks, folder, expected):
    frames_of, name = viewer()
    print(f"{folder}: read with {name}")
    inside = lambda file: os.path.join(folder, file)  # noqa: E731
    require(folder, "results.pvd", "history.csv", "summary.json")
    history = read_history(inside("history.csv"))
    summary = read_json(inside("summary.json"))
    case = read_case(inside("case.resolved.toml"))
    kinds = kinds_of_contact(case)
    names = contact_names(history)
    if names:
        require(folder, "contact.pvd")
    checks.that(bool(history), "history.csv has no rows")

    # the volume
    times, displacements, reference = [], [], None
    for number, (time, grids) in enumerate(frames_of(inside("results.pvd"))):
        what = f"volume frame {number}"
        times.append(time)
        if not checks.that(len(grids) == 1, f"{what}: {len(grids)} grids, expected 1"):
            continue
        check_time(checks, what, grids[0], time)
        points = points_of(grids[0])
        checks.that(len(points) > 0, f"{what}: there are no points")
        reference = reference or points
        checks.that(points == reference, f"{what}: points differ from those of the first frame")
        displacements.append(check_volume(checks, what, grids[0], bool(names)))
    checks.that(len(times) > 0, "results.pvd lists no frames")
    checks.that(all(a < b for a, b in zip(times, times[1:])), "the times of results.pvd do not increase")
    if displacements and displacements[0] is not None:
        start = largest(x for u in displacements[0] for x in u)
        checks.that(start == 0.0, "the first frame is not undeformed")

    # the contact surfaces
    columns = {"force": [f"{n}.force_{a}" for n in names for a in AXES]}
    columns |= {q: [f"{n}.{q}" for n in names] for q in ("pressure_max", "gap_min")}
    scales = {k: largest(r[c] for r in history for c in cs) for k, cs in columns.items()}
    contact_times, parts = [], []
    for number, (time, grids) in enumerate(frames_of(inside("contact.pvd")) if names else []):
        what = f"contact frame {number}"
        contact_times.append(time)
        for grid in grids:
            check_time(checks, what, grid, time)
        parts = [check_contact(checks, what, grid, kinds) for grid in grids]
        row = row_at(history, time)
        if number > 0:
            checks.that(row is not None, f"{what}: history.csv has no row of time {time!r}")
        if row is not None and all(p is not None for p in parts):
            compare_contact(checks, what, parts, row, names, kinds, scales)
    checks.that(contact_times == times or not names, f"contact.pvd lists {len(contact_times)} other times than results.pvd")

    # displacements that the history follows
    if history and reference:
        scale = largest(x for frame in displacements for u in frame or [] for x in u)
        for column, point, axis in followed_displacements(case, history, reference):
            for time, frame in zip(times, displacements):
                row = row_at(history, time)
                if row is not None and frame is not None:
                    checks.near(f"{column} at time {time!r}", frame[point][axis], row[column], scale)

    began = began_later(inside("events.jsonl")) if kinds["found"] else set()
    check_summary(checks, summary, history, names, began - set(names), scales)
    check_expected(checks, expected, history, times, displacements, reference)


def began_later(path):
    """The names of contacts that began in the run; unless the case asks for them, they have no columns in history.csv."""
    with open(path, encoding="utf-8") as file:
        messages = [event["message"] for event in map(json.loads, file) if event.get("code") == "S0416"]
    # the second place where two bodies meet has a number, "plate-bolt#2"
    return {name for message in messages for name in re.findall(r'"([^"]+?)(?:#\d+)?"', message)}


def check_summary(checks, summary, history, names, began, scales):
    checks.that(summary.get("exit_code") == 0, f"summary.json: exit code {summary.get('exit_code')!r}, expected 0")
    increments = sum(s.get("increments", 0) for s in summary.get("steps", []))
    checks.that(increments == len(history), f"summary.json: {increments} increments, history.csv {len(history)} rows")
    contacts = summary.get("contacts", {})
    expected = sorted({*names, *began})
    checks.that(sorted(contacts) == expected, f"summary.json: contacts {sorted(contacts)}, expected {expected}")
    for name in set(names) & set(contacts):
        last = history[-1]
        force = [last[f"{name}.force_{a}"] for a in AXES]
        checks.near(f"summary.json: force of {name}", contacts[name].get("force"), force, scales["force"])
        for quantity in ("pressure_max", "gap_min"):
            value = last[f"{name}.{quantity}"]
            checks.near(f"summary.json: {quantity} of {name}", contacts[name].get(quantity), value, scales[quantity])


def check_expected(checks, expected, history, times, displacements, reference):
    rtol = expected.get("rtol", checks.rtol)
    if "frames" in expected:
        checks.that(len(times) == expected["frames"], f"{len(times)} frames, expected {expected['frames']}")
    if "points" in expected:
        npoint = len(reference or [])
        checks.that(npoint == expected["points"], f"{npoint} points, expected {expected['points']}")
    for want in expected.get("history", []):
        what = f"{want['column']} in row {want['row']} of history.csv"
        if checks.that(1 <= want["row"] <= len(history) and want["column"] in history[0], f"{what} does not exist"):
            got = history[want["row"] - 1][want["column"]]
            checks.near(what, got, want["value"], want.get("scale", abs(want["value"])), rtol)
    for want in expected.get("displacement", []):
        what = f"displacement at {want['at']} in frame {want['frame']}"
        point = nearest(reference, want["at"])
        known = point is not None and math.dist(reference[point], want["at"]) <= 1e-9
        frame = displacements[want["frame"]] if want["frame"] < len(displacements) else None
        if checks.that(known and frame is not None, f"{what} does not exist"):
            checks.near(what, frame[point], want["value"], largest(x for u in frame for x in u), rtol)


def main():
    parser = argparse.ArgumentParser(description="Open the results of a run as a viewer does and check every frame.")
    parser.add_argument("results", help="folder with results.pvd, contact.pvd, history.csv, summary.json")
    parser.add_argument("--expected", help="JSON file, see the head of this script")
    parser.add_argument("--rtol", type=float, default=1e-10, help="agreement asked for, relative to the largest value")
    arguments = parser.parse_args()
    checks = Checks(arguments.rtol)
    try:
        expected = read_json(arguments.expected) if arguments.expected else {}
        check_run(checks, arguments.results, expected)
    except (OSError, ValueError, KeyError, Unreadable) as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return 2
    if checks.failed > SHOWN:
        print(f"FAILED  and {checks.failed - SHOWN} more")
    print(f"check_results: {checks.passed} passed, {checks.failed} failed")
    return 1 if checks.failed else 0


if __name__ == "__main__":
    sys.exit(main())
