#!/usr/bin/env python3
"""Compare the .frd file of a run, as an independent reader reads it, with the frames of the same run, as VTK reads them.

    python scripts/check_frd.py RESULTS_DIR

The reader is the converter ccx2paraview (pip install ccx2paraview), run as a program on a copy of the file. The run must
have written both formats: --format vtu,frd. Checked are, for every frame of results.pvd but the undeformed one: the
time; coordinates; cells with their types and nodes; displacement, reaction_force, stress, strain, temperature and plastic
strain at every node, component by component; and, of contacts that share no node, gap and pressure, at nodes within reach.
Every number must be that of the frame rounded to the six digits of the file; forces are compared where supports hold.

The converter knows no wedges of 15 nodes and numbers the sides of wedges in another way: of wedges, the corners must be
the same. Nodes within cells and sides are in no cell of the file.

The last line says how many checks passed and failed. Exit code: 0 all passed, 1 some failed, 2 wrong command line or
unreadable files.
"""

import argparse
import glob
import os
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import numpy as np
import pyvista

# half a unit in the last of six digits, in parts of the first, and round-off
DIGITS = 5e-6 * (1.0 + 1e-9)
# the converter keeps coordinates with 24 bits
SINGLE = 2.0**-24
# what two digits of exponent cannot hold
ZERO = 1e-99
SHOWN = 20
# name in the frames: name and components that the converter gives it, in the order of the frames
FIELDS = {
    "displacement": ("U", ["D1", "D2", "D3"]),
    "reaction_force": ("RF", ["F1", "F2", "F3"]),
    "stress": ("S", ["XX", "YY", "ZZ", "XY", "YZ", "ZX"]),
    "strain": ("E", ["XX", "YY", "ZZ", "XY", "YZ", "ZX"]),
    "temperature": ("NT", ["T"]),
    "plastic_strain": ("PEEQ", ["PE"]),
}
# what equilibrium may leave, in parts of the largest reaction
EQUILIBRIUM = 1e-5
# the converter writes each frame in a thread of its own, out of what they all share: here one after the other
CONVERT = """
import sys, threading
threading.Thread.start = threading.Thread.run
threading.Thread.join = lambda self, timeout=None: None
from ccx2paraview import Converter
Converter(sys.argv[1], ["vtu"]).run()
"""
CONTACT = {"contact_gap": "COPEN", "contact_pressure": "CPRESS"}
WEDGE = 13
# as the file and its converter know them: type and nodes
WRITTEN_AS = {29: (25, 20), 28: (23, 8), 26: (13, 6)}


class Unreadable(Exception):
    pass


class Checks:
    def __init__(self):
        self.passed = 0
        self.failed = []

    def check(self, what, holds, found=""):
        if holds:
            self.passed += 1
        else:
            self.failed.append(f"{what}: {found}")

    def same_numbers(self, what, found, expected, more=0.0, left=0.0):
        found, expected = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
        if found.shape != expected.shape:
            self.check(what, False, f"{found.shape} numbers for {expected.shape}")
            return
        first = 10.0 ** np.floor(np.log10(np.maximum(np.abs(expected), ZERO)))
        wrong = ~(np.abs(found - expected) <= DIGITS * first + more * np.abs(expected) + left + ZERO)
        if wrong.any():
            at = tuple(int(i) for i in np.argwhere(wrong)[0])
            self.check(what, False, f"{wrong.sum()} differ, first {found[at]!r} for {expected[at]!r} at {at}")
        else:
            self.check(what, True)


def listed(path):
    """Times and files of a .pvd file."""
    try:
        root = xml.etree.ElementTree.parse(path).getroot()
    except (OSError, xml.etree.ElementTree.ParseError) as error:
        raise Unreadable(f"{path}: {error}") from error
    folder = os.path.dirname(path)
    return [(float(d.get("timestep")), os.path.join(folder, d.get("file"))) for d in root.iter("DataSet")]


def convert(frd, folder):
    """Times and files that the converter makes of a file."""
    copy = os.path.join(folder, "job.frd")
    shutil.copyfile(frd, copy)
    command = [sys.executable, "-c", CONVERT, copy]
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder, check=False)
    if done.returncode != 0:
        raise Unreadable(f"{frd}: ccx2paraview failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    if os.path.exists(os.path.join(folder, "job.pvd")):
        return listed(os.path.join(folder, "job.pvd"))
    single = os.path.join(folder, "job.vtu")
    if not os.path.exists(single):
        raise Unreadable(f"{frd}: ccx2paraview made nothing of it:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return [(None, single)]


def columns(array, names):
    """The components of an array in the order of these names."""
    own = [array.GetComponentName(i) for i in range(array.GetNumberOfComponents())]
    values = np.asarray(pyvista.convert_array(array)).reshape(-1, len(own))
    if len(own) == 1:
        return values
    return values[:, [own.index(name) for name in names]]


def cells(grid):
    """Type and nodes of every cell, as the file has them: those of wedges in any order."""
    ends = np.asarray(pyvista.convert_array(grid.GetCells().GetOffsetsArray()))
    nodes = np.asarray(pyvista.convert_array(grid.GetCells().GetConnectivityArray()))
    found = []
    for kind, start, end in zip(grid.celltypes, ends[:-1], ends[1:]):
        kind = int(kind)
        kind, count = WRITTEN_AS.get(kind, (kind, end - start))
        of_cell = [int(n) for n in nodes[start : start + count]]
        found.append((kind, sorted(of_cell) if kind == WEDGE else of_cell))
    return found


def used(frame):
    """The points that cells have, which are those of the file, in their order."""
    return np.unique(frame.cell_connectivity)


def compare_volume(checks, name, converted, frame):
    kept = used(frame)
    number = {int(point): k for k, point in enumerate(kept)}
    checks.same_numbers(f"{name}: coordinates", converted.points, frame.points[kept], SINGLE)
    ours = [(kind, [number[point] for point in points]) for kind, points in cells(frame)]
    theirs = cells(converted)
    checks.check(f"{name}: cells", ours == theirs, next((f"{b} for {a}" for a, b in zip(ours, theirs) if a != b), "count"))
    for field, (theirs, names) in FIELDS.items():
        if field not in frame.point_data:
            continue
        array = converted.GetPointData().GetArray(theirs)
        if array is None:
            checks.check(f"{name}: {field}", False, f"the file has no {theirs}")
            continue
        values = np.asarray(frame.point_data[field]).reshape(frame.n_points, -1)[kept]
        found, left = columns(array, names), 0.0
        if field == "reaction_force":
            # those of the file are internal ones: at supports they are reactions, up to the tolerance of equilibrium
            held = np.any(values != 0.0, axis=1)
            found, values = np.asarray(found)[held], values[held]
            left = EQUILIBRIUM * np.max(np.abs(values), initial=0.0)
        checks.same_numbers(f"{name}: {field}", found, values, left=left)


def compare_contact(checks, name, converted, frame, contact):
    """Gap and pressure of nodes that are in one contact only."""
    ids = np.asarray(contact.point_data["node_id"])
    single = np.isin(ids, [i for i, n in zip(*np.unique(ids, return_counts=True)) if n == 1])
    near = single & (np.asarray(contact.point_data["contact_status"]) >= 0)
    if not near.any():
        return
    array = converted.GetPointData().GetArray("CONTACT")
    if array is None:
        checks.check(f"{name}: contact", False, "the file has no CONTACT")
        return
    place = {int(n): k for k, n in enumerate(frame.point_data["node_id"][used(frame)])}
    rows = [place[int(n)] for n in ids[near]]
    for field, component in CONTACT.items():
        found = columns(array, [component])[rows, 0]
        checks.same_numbers(f"{name}: {field}", found, np.asarray(contact.point_data[field])[near])


def check(folder):
    files = glob.glob(os.path.join(glob.escape(folder), "*.frd"))
    if len(files) != 1:
        raise Unreadable(f"{folder} holds {len(files)} .frd files; write one with --format vtu,frd")
    frames = listed(os.path.join(folder, "results.pvd"))[1:]
    has_contact = os.path.exists(os.path.join(folder, "contact.pvd"))
    contacts = listed(os.path.join(folder, "contact.pvd"))[1:] if has_contact else [(None, None)] * len(frames)
    checks = Checks()
    with tempfile.TemporaryDirectory() as scratch:
        converted = convert(files[0], scratch)
        checks.check("number of frames", len(converted) == len(frames), f"{len(converted)} for {len(frames)}")
        for (time, path), (ours, frame), (_, contact) in zip(converted, frames, contacts):
            name = os.path.basename(frame)
            if time is not None:
                checks.check(f"{name}: time", abs(time - ours) <= DIGITS * ours, f"{time} for {ours}")
            grid, own = pyvista.read(path), pyvista.read(frame)
            compare_volume(checks, name, grid, own)
            if contact is not None:
                compare_contact(checks, name, grid, own, pyvista.read(contact))
    return checks


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="the folder with the results")
    arguments = parser.parse_args()
    try:
        checks = check(arguments.folder)
    except Unreadable as error:
        print(f"check_frd: {error}", file=sys.stderr)
        return 2
    for line in checks.failed[:SHOWN]:
        print(f"FAILED {line}")
    print(f"check_frd: {checks.passed} passed, {len(checks.failed)} failed")
    return 1 if checks.failed or checks.passed == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
