#!/usr/bin/env python3
"""Compare a .vtu file, as VTK reads it, with expected values.

    python  scripts/check_vtu.py frame.vtu expected.json      reads with pyvista, or with vtk where pyvista is missing
    pvpython scripts/check_vtu.py frame.vtu expected.json     reads with ParaView's own VTK

The expected values, every key optional, every number compared exactly unless --rtol is given:

    { "points": [[x, y, z], ...], "types": [12, ...], "cells": [[0, 1, ...], ...], "active_vectors": "displacement",
      "measures": [8.0, ...],
      "point_data": { name: { "values": [...], "components": ["XX", ...] } },
      "cell_data":  { ... },
      "field_data": { "TimeValue": { "values": [0.3] }, "step_name": { "text": "press" } } }

Measures are lengths, areas in the plane z = 0 or volumes of the cells, integrated with VTK's own shape functions (to
1e-9): the Jacobian must be positive, the mid node of every edge near its middle, and VTK's own cell size, which takes
curved cells for polyhedra, must agree to a fifth. A wrong order of nodes fails in one of them.

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


def gauss_points(cell):
    """Points and weights over the parameters of a cell."""
    s = [(0.5 - 0.15**0.5, 5 / 18), (0.5, 8 / 18), (0.5 + 0.15**0.5, 5 / 18)]
    dim, ncorner = cell.GetCellDimension(), cell.GetNumberOfPoints()
    line = [(x, 0.0, 0.0, w) for x, w in s]
    square = [(x, y, 0.0, v * w) for x, v in s for y, w in s]
    triangle = [(x * (1 - y), y, 0.0, w * (1 - y)) for x, y, _, w in square]
    cube = [(x, y, z, v * w) for x, y, _, v in square for z, w in s]
    if dim < 3:
        return {1: line, 2: triangle if ncorner in (3, 6) else square}[dim]
    if ncorner in (8, 20, 27):
        return cube
    if ncorner in (6, 15):
        return [(x, y, z, v * w) for x, y, _, v in triangle for z, w in s]
    return [(x * (1 - z), y * (1 - z), z, v * (1 - z) ** 2 * w) for x, y, _, v in triangle for z, w in s]


def jacobian(cell, at):
    """The determinant of a cell's map from its parameters; the cell lies along x or in the plane where it is flat."""
    n, dim = cell.GetNumberOfPoints(), cell.GetCellDimension()
    slopes = [0.0] * (dim * n)
    cell.InterpolateDerivs(at, slopes)
    points = [cell.GetPoints().GetPoint(i) for i in range(n)]
    t = [[sum(slopes[a * n + i] * points[i][c] for i in range(n)) for c in range(3)] for a in range(dim)]
    t += [[float(a == c) for c in range(3)] for a in range(dim, 3)]
    (a, b, c), (d, e, f), (g, h, i) = t
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def sizes(grid):
    """VTK's own lengths, areas and volumes, of whichever sign."""
    try:
        from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
    except ImportError:
        from vtk import vtkCellSizeFilter
    cell_size = vtkCellSizeFilter()
    cell_size.SetInputData(grid)
    cell_size.Update()
    data = cell_size.GetOutput().GetCellData()
    names = ["VertexCount", "Length", "Area", "Volume"]
    dims = [grid.GetCell(i).GetCellDimension() for i in range(grid.GetNumberOfCells())]
    return [abs(data.GetArray(names[dim]).GetValue(i)) for i, dim in enumerate(dims)]


def check_measures(grid, expected, differences):
    for k, (size, want) in enumerate(zip(sizes(grid), expected)):
        what = f"cell {k} of type {grid.GetCellType(k)}"
        cell = grid.GetCell(k)
        found = [(w, jacobian(cell, (x, y, z))) for x, y, z, w in gauss_points(cell)]
        if min(j for _, j in found) <= 0.0:
            differences.add(f"{what}: the Jacobian is not positive")
        measure = sum(w * j for w, j in found)
        if abs(measure - want) > 1e-9 * want:
            differences.add(f"{what}: measure {measure!r}, expected {want!r}")
        if size > 0.0 and abs(size - want) > 0.2 * want:  # older VTK has no size of some types
            differences.add(f"{what}: VTK's size is {size!r}, expected about {want!r}")
        edges = [cell.GetEdge(i) for i in range(cell.GetNumberOfEdges())] or [cell]
        for edge in (e.GetPoints() for e in edges if e.GetNumberOfPoints() == 3):
            a, b, mid = (edge.GetPoint(i) for i in range(3))
            off = sum((m - 0.5 * (p + q)) ** 2 for p, q, m in zip(a, b, mid)) ** 0.5
            if off > 0.25 * sum((p - q) ** 2 for p, q in zip(a, b)) ** 0.5:
                differences.add(f"{what}: the mid node of an edge is {off} off its middle")
                break


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
    if "measures" in expected:
        check_measures(grid, expected["measures"], differences)
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
