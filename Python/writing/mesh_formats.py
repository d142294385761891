# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes triangles as PLY, GLB and GOCAD surface: VTK has singles there, or no writer."""

import json
import struct

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals

from ..clouds import cells_of, coordinates_of, make_points, slices, triangles_of
from ..passes import corner_flags
from ..paths import plain_stem
from .xml_writer import named_arrays

COLOURS = ("red", "green", "blue", "alpha")


class Triangles:
    """The triangles of vtkPolyData with the points and point arrays that they use.

    points     (n, 3) float64
    triangles  (m, 3) int32, places in points
    arrays     {name: (n,) or (n, k)}; colours are not among them
    colours    (n, 3) or (n, 4) uint8, the array RGB or RGBA; or None
    """

    def __init__(self, data):
        corners = triangles_of(data)
        points = coordinates_of(data)
        used = corner_flags(corners, len(points))
        arrays = {name: array for name, array, _ in named_arrays(data.GetPointData())}
        if not used.all():
            places = numpy.cumsum(used, dtype="i4") - 1
            corners, points = places[corners], points[used]
            arrays = {name: array[used] for name, array in arrays.items()}
        self.points = points.astype("f8", copy=False)
        self.triangles = corners.astype("i4", copy=False)
        self.colours = None
        for name in ("RGB", "RGBA"):
            array = arrays.get(name)
            if array is not None and array.dtype == numpy.uint8 and array.shape[1:] == (len(name),):
                self.colours = arrays.pop(name)
        self.arrays = arrays

    def columns(self):
        """{name: (n,)}: the arrays, one column for each component."""
        result = {}
        for name, array in self.arrays.items():
            plain = "_".join(name.split())
            if array.ndim == 1:
                result[plain] = array
            else:
                result.update((f"{plain}_{i}", array[:, i]) for i in range(array.shape[1]))
        return result


PLY_TYPES = {
    "i1": "char",
    "u1": "uchar",
    "i2": "short",
    "u2": "ushort",
    "i4": "int",
    "u4": "uint",
    "f4": "float",
    "f8": "double",
}


def write_ply(data, path, crs, progress):
    """Binary PLY with coordinates as doubles; colours and point arrays are properties."""
    mesh = Triangles(data)
    columns = dict(zip("xyz", mesh.points.T))
    if mesh.colours is not None:
        columns.update(zip(COLOURS, mesh.colours.T))
    columns.update((name, c) for name, c in mesh.columns().items() if name not in columns)
    # Whole numbers of 64 bits, which the format lacks, are written as doubles.
    codes = {name: column.dtype.str[1:] for name, column in columns.items()}
    codes = {name: code if code in PLY_TYPES else "f8" for name, code in codes.items()}
    head = ["ply", "format binary_little_endian 1.0"]
    if crs:
        head.append("comment crs " + " ".join(crs.split()))
    head.append(f"element vertex {len(mesh.points)}")
    head += [f"property {PLY_TYPES[code]} {name}" for name, code in codes.items()]
    head += [f"element face {len(mesh.triangles)}", "property list uchar int vertex_indices"]
    with open(path, "wb") as stream:
        stream.write(("\n".join([*head, "end_header"]) + "\n").encode())
        kind = numpy.dtype([(name, "<" + code) for name, code in codes.items()])
        for part, rows in enumerate(slices(len(mesh.points))):
            records = numpy.empty(len(mesh.points[rows]), dtype=kind)
            for name, column in columns.items():
                records[name] = column[rows]
            stream.write(records)
            progress(part / (1.0 + 3.0 * len(mesh.points) / len(records)))
        kind = numpy.dtype([("count", "u1"), ("corners", "<i4", 3)])
        for rows in slices(len(mesh.triangles)):
            records = numpy.empty(len(mesh.triangles[rows]), dtype=kind)
            records["count"] = 3
            records["corners"] = mesh.triangles[rows]
            stream.write(records)
            progress(min(1.0, rows.stop / len(mesh.triangles)))
    return []


def write_ts(data, path, crs, progress):
    """GOCAD surface, z as elevation; point arrays are properties. All digits are written."""
    mesh = Triangles(data)
    names, columns = [], []
    for name, column in mesh.columns().items():
        names.append(name)
        columns.append(column)
    head = ["GOCAD TSurf 1", "HEADER {", f"name:{plain_stem(path)}", "}"]
    head += ["GOCAD_ORIGINAL_COORDINATE_SYSTEM", "NAME Default"]
    head += ['AXIS_NAME "X" "Y" "Z"', "ZPOSITIVE Elevation", "END_ORIGINAL_COORDINATE_SYSTEM"]
    if crs:
        head.append("# crs " + " ".join(crs.split()))
    if names:
        head.append("PROPERTIES " + " ".join(names))
        head.append("NO_DATA_VALUES " + " ".join("-99999" for _ in names))
        head.append("ESIZES " + " ".join("1" for _ in names))
    kind = "PVRTX" if names else "VRTX"
    total = len(mesh.points) + len(mesh.triangles)
    with open(path, "w", encoding="utf-8", newline="\n") as stream:
        stream.write("\n".join([*head, "TFACE"]) + "\n")
        for rows in slices(len(mesh.points), 100_000):
            progress(rows.start / total)
            table = [column.tolist() for column in mesh.points[rows].T]
            table += [without_nan(column[rows]).tolist() for column in columns]
            form = kind + " %d" + " %r" * len(table) + "\n"
            numbers = zip(range(rows.start + 1, rows.stop + 1), *table)
            stream.write("".join([form % row for row in numbers]))
        for rows in slices(len(mesh.triangles), 100_000):
            progress((len(mesh.points) + rows.start) / total)
            corners = (mesh.triangles[rows] + 1).tolist()
            stream.write("".join(["TRGL %d %d %d\n" % (a, b, c) for a, b, c in corners]))
        stream.write("END\n")
    return []


def without_nan(column):
    """GOCAD's value for what is not known, in place of NaN."""
    return numpy.where(numpy.isnan(column), -99999.0, column) if column.dtype.kind == "f" else column


def linear_light():
    """(256,) uint16: a colour of a screen (sRGB) as the share of light that glTF wants."""
    share = numpy.arange(256) / 255.0
    light = numpy.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return numpy.round(65535.0 * light).astype("<u2")


def write_glb(data, path, crs, progress):
    """Binary glTF: metres with y upwards there, single precision around a whole-number offset.

    The offset is the translation of the mesh's node, which programs read, and is in its "extras".
    """
    mesh = Triangles(data)
    offset = numpy.floor(0.5 * mesh.points.min(axis=0) + 0.5 * mesh.points.max(axis=0))
    points = (mesh.points - offset).astype("<f4")
    progress(0.3)
    shape = make_points(points)
    shape.SetPolys(cells_of(mesh.triangles))
    normals = vtkPolyDataNormals()
    normals.SetInputData(shape)
    normals.SplittingOff()
    normals.ConsistencyOff()
    normals.Update()
    normals = vtk_to_numpy(normals.GetOutput().GetPointData().GetNormals()).astype("<f4")
    progress(0.6)
    # (what it is, array, kind of its numbers, target of the buffer)
    parts = [
        ("POSITION", points, 5126, 34962),
        ("NORMAL", normals, 5126, 34962),
        ("indices", mesh.triangles.astype("<u4").reshape(-1, 1), 5125, 34963),
    ]
    if mesh.colours is not None:
        colours = numpy.full((len(points), 4), 65535, dtype="<u2")
        colours[:, :3] = linear_light()[mesh.colours[:, :3]]
        if mesh.colours.shape[1] == 4:
            colours[:, 3] = 257 * mesh.colours[:, 3].astype("u2")
        parts.append(("COLOR_0", colours, 5123, 34962))
    views, accessors, attributes, start = [], [], {}, 0
    for i, (name, array, kind, target) in enumerate(parts):
        views.append(
            {"buffer": 0, "byteOffset": start, "byteLength": array.nbytes, "target": target}
        )
        accessors.append(
            {
                "bufferView": i,
                "componentType": kind,
                "count": len(array),
                "type": {1: "SCALAR", 3: "VEC3", 4: "VEC4"}[array.shape[1]],
            }
        )
        start += array.nbytes
        if name != "indices":
            attributes[name] = i
        if name == "COLOR_0":
            accessors[-1]["normalized"] = True
        if name == "POSITION":
            accessors[-1]["min"] = array.min(axis=0).tolist()
            accessors[-1]["max"] = array.max(axis=0).tolist()
    extras = {"offset": offset.tolist()}
    if crs:
        extras["crs"] = crs
    head = {
        "asset": {"version": "2.0", "generator": "ElevationSurface"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [
            # z upwards here, y upwards in glTF. Columns of the matrix, one after another.
            {"children": [1], "matrix": [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]},
            {"mesh": 0, "translation": offset.tolist(), "extras": extras},
        ],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 2, "material": 0}]}],
        "materials": [
            {
                "doubleSided": True,
                "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 1.0},
            }
        ],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": start}],
    }
    text = json.dumps(head, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + start
    if total >= 2**32:
        raise OSError(None, "a .glb file holds at most 4 GB; use .ply or .vtp")
    with open(path, "wb") as stream:
        stream.write(struct.pack("<4sIIII", b"glTF", 2, total, len(text), 0x4E4F534A) + text)
        stream.write(struct.pack("<II", start, 0x004E4942))
        for _, array, _, _ in parts:
            stream.write(numpy.ascontiguousarray(array))
    x, y, z = (f"{value:.0f}" for value in offset)
    return [f".glb holds single precision: coordinates are written less {x} {y} {z}, its offset"]
