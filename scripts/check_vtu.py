#!/usr/bin/env python3
"""Compare a .vtu file, as VTK reads it, with expected values.

    python  scripts/check_vtu.py frame.vtu expected.json      reads with pyvista, or with vtk where pyvista is missing
    pvpython scripts/check_vtu.py frame.vtu expected.json     reads with ParaView's own VTK

The expected values, every key optional, every number compared exactly unless --rtol is given:

    { "points": [[x, y, z], ...], "types": [12, ...], "cells": [[0, 1, ...], ...], "active_vectors": "displacement",
      "point_data": { name: { "values": [...], "components": ["XX", ...] } },
      "cell_data":  { ... },
      "field_data": { "TimeValue": { "values": [0.3] }, "step_name": { "text": "press" } } }

Exit code: 0 equal, 1 different, 2 wrong command line or unreadable file.
"""

import argparse
import json
import sys


def read_grid(path):
    """The grid and the name of the reader."""
    try:
        import pyvista
    except ImportError:
        pyvista = None
    if pyvista is not None:
        return pyvista.read(path), f"pyvista {pyvista.__version__}"
    try:
        from vtkmodules.vtkCommonCore import vtkVersion
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    except ImportError:
        from vtk import vtkVersion, vtkXMLUnstructuredGridReader
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    if reader.GetErrorCode() != 0:
        raise OSError(f"VTK cannot read {path}: error {reader.GetErrorCode()}")
    return reader.GetOutput(), f"vtk {vtkVersion.GetVTKVersion()}"


class Differences:
    def __init__(self, rtol):
        self.rtol = rtol
        self.found = []

    def add(self, text):
        self.found.append(text)

    def compare(self, what, got, expected):
        """Flat lists of numbers; null stands for what is not finite."""
        if len(got) != len(expected):
            self.add(f"{what}: {len(got)} values, expected {len(expected)}")
            return
        for i, (a, b) in enumerate(zip(got, expected)):
            b = float("nan") if b is None else b
            same = a == b or (a != a and b != b) or abs(a - b) <= self.rtol * abs(b)
            if not same:
                self.add(f"{what}[{i}]: {a!r}, expected {b!r}")
                return


def flatten(values):
    return [x for v in values for x in (flatten(v) if isinstance(v, list) else [v])]


def array_values(array):
    n, m = array.GetNumberOfTuples(), array.GetNumberOfComponents()
    return [array.GetComponent(i, j) for i in range(n) for j in range(m)]


def check_arrays(place, data, expected, differences):
    for name, want in expected.items():
        what = f"{place} {name!r}"
        array = data.GetAbstractArray(name)
        if array is None:
            have = [data.GetAbstractArray(i).GetName() for i in range(data.GetNumberOfArrays())]
            differences.add(f"{what}: missing, there are {have}")
            continue
        if "text" in want:
            got = array.GetValue(0)
            if got != want["text"]:
                differences.add(f"{what}: {got!r}, expected {want['text']!r}")
            continue
        differences.compare(what, array_values(array), flatten(want["values"]))
        if "type" in want and array.GetDataTypeAsString() != want["type"]:
            differences.add(f"{what}: type {array.GetDataTypeAsString()}, expected {want['type']}")
        if "components" in want:
            got = [array.GetComponentName(i) for i in range(array.GetNumberOfComponents())]
            if got != want["components"]:
                differences.add(f"{what}: components {got}, expected {want['components']}")


def check(grid, expected, differences):
    if "points" in expected:
        points = grid.GetPoints()
        got = array_values(points.GetData()) if points is not None else []
        differences.compare("points", got, flatten(expected["points"]))
    if "types" in expected:
        got = [grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]
        differences.compare("types", got, expected["types"])
    for i, cell in enumerate(expected.get("cells", [])):
        if i >= grid.GetNumberOfCells():
            differences.add(f"cell {i}: missing")
            break
        ids = grid.GetCell(i).GetPointIds()
        differences.compare(f"cell {i}", [ids.GetId(k) for k in range(ids.GetNumberOfIds())], cell)
    if "active_vectors" in expected:
        vectors = grid.GetPointData().GetVectors()
        got = vectors.GetName() if vectors is not None else None
        if got != expected["active_vectors"]:
            differences.add(f"active vectors: {got!r}, expected {expected['active_vectors']!r}")
    check_arrays("point data", grid.GetPointData(), expected.get("point_data", {}), differences)
    check_arrays("cell data", grid.GetCellData(), expected.get("cell_data", {}), differences)
    check_arrays("field data", grid.GetFieldData(), expected.get("field_data", {}), differences)


def main():
    parser = argparse.ArgumentParser(description="Compare a .vtu file, as VTK reads it, with expected values.")
    parser.add_argument("vtu")
    parser.add_argument("expected", help="JSON file, see the head of this script")
    parser.add_argument("--rtol", type=float, default=0.0, help="relative tolerance, 0 for equal bits")
    arguments = parser.parse_args()
    try:
        with open(arguments.expected, encoding="utf-8") as file:
            expected = json.load(file)
        with open(arguments.vtu, "rb"):
            pass
        grid, reader = read_grid(arguments.vtu)
    except (OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    differences = Differences(arguments.rtol)
    check(grid, expected, differences)
    for text in differences.found:
        print(f"{arguments.vtu}: {text}")
    verdict = "differs" if differences.found else "equal"
    print(f"{arguments.vtu}: {verdict} ({reader})")
    return 1 if differences.found else 0


if __name__ == "__main__":
    sys.exit(main())
