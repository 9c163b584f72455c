# Writes the .vtu files in this folder, those here with PyVista 0.49.1 on VTK 9.7.2 and meshio 5.3.5:
# pip install pyvista meshio && python make_vtu.py
import meshio
import numpy as np
import pyvista as pv
import vtk

# Two bricks on each other, two wedges beside them, a tetrahedron of ten nodes on top; materials 1, 1, 2, 2, 5.
box = np.array([[x, y, z] for z in range(3) for y in range(2) for x in range(3)], float)
tip = np.array([0.5, 0.5, 3.0])
corners = [12, 13, 15]
pairs = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
ends = [box[i] for i in corners] + [tip]
middles = [(ends[a] + ends[b]) / 2 for a, b in pairs]
points = np.vstack([box, [tip], middles])
hexes = [[0, 1, 4, 3, 6, 7, 10, 9], [6, 7, 10, 9, 12, 13, 16, 15]]
wedges = [[1, 2, 4, 7, 8, 10], [2, 5, 4, 8, 11, 10]]
tet = corners + list(range(18, 25))
material = np.array([1, 1, 2, 2, 5], np.int32)
foot = (points[:, 2] == 0).astype(np.int8)
temperature = points[:, 0].astype(np.float32)

cells = np.hstack([[len(c), *c] for c in [*hexes, *wedges, tet]])
grid = pv.UnstructuredGrid(cells, np.array([12, 12, 13, 13, 24]), points)
grid.cell_data["MaterialIDs"] = material
grid.point_data["foot"] = foot
grid.point_data["temperature"] = temperature
grid.field_data["made by"] = ["PyVista"]
writer = vtk.vtkXMLUnstructuredGridWriter()
writer.SetInputData(grid)
for mode, set_mode in [("ascii", "SetDataModeToAscii"), ("inline", "SetDataModeToBinary"), ("appended", "SetDataModeToAppended")]:
    getattr(writer, set_mode)()
    for encode in ([0, 1] if mode == "appended" else [1]):
        for compress in ([False] if mode == "ascii" else [False, True]):
            for wide in ([64] if mode == "ascii" else [32, 64]):
                for big in [False, True] if mode == "inline" else [False]:
                    if mode == "appended":
                        writer.SetEncodeAppendedData(encode)
                    (writer.SetCompressorTypeToZLib if compress else writer.SetCompressorTypeToNone)()
                    (writer.SetHeaderTypeToUInt32 if wide == 32 else writer.SetHeaderTypeToUInt64)()
                    (writer.SetByteOrderToBigEndian if big else writer.SetByteOrderToLittleEndian)()
                    words = ["vtk", mode, *(["base64" if encode else "raw"] if mode == "appended" else []),
                             *(["zlib"] if compress else []), str(wide), *(["big"] if big else [])]
                    writer.SetFileName("_".join(words) + ".vtu")
                    writer.Write()

mesh = meshio.Mesh(points, [("hexahedron", hexes), ("wedge", wedges), ("tetra10", [tet])],
                   point_data={"foot": foot, "temperature": temperature},
                   cell_data={"MaterialIDs": [material[:2], material[2:4], material[4:]]})
meshio.vtu.write("meshio_ascii.vtu", mesh, binary=False)
meshio.vtu.write("meshio_plain.vtu", mesh, compression=None)
meshio.vtu.write("meshio_zlib.vtu", mesh, compression="zlib")
