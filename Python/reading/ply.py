# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Vertices of PLY files, in the precision that the file has. vtkPLYReader rounds them to floats."""

import dataclasses
import itertools
import os

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkCellArray

from ..clouds import Cloud, ReadOptions, add_array, make_points, rounding_note
from ..messages import FileError, Messages
from ..progress import share, items_with_progress
from .facing import check_faces, make_faces
from .vtk_checks import survives

TYPES = {
    name: code
    for code, names in {
        "i1": "char int8",
        "u1": "uchar uint8",
        "i2": "short int16",
        "u2": "ushort uint16",
        "i4": "int int32",
        "u4": "uint uint32",
        "f4": "float float32",
        "f8": "double float64",
    }.items()
    for name in names.split()
}
FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
COLOURS = ("red", "green", "blue")


@dataclasses.dataclass
class Element:
    """One "element" of a header; properties: [(name, type, None or a list's type of count)]."""

    name: str
    count: int
    properties: list

    def has_list(self):
        return any(count for _, _, count in self.properties)

    def row_type(self, order):
        return numpy.dtype([(name, order + kind) for name, kind, _ in self.properties])

    def read_row(self, stream, order):
        """{property: number or list} of the next row, or None where it is not whole."""
        words = None if order else stream.readline().split()
        row = {}
        try:
            for name, kind, count in self.properties:
                if not order:
                    number = int(words.pop(0)) if count else 1
                    values, words = [float(word) for word in words[:number]], words[number:]
                else:
                    number = 1
                    if count:
                        number = int(numpy.frombuffer(stream.read(int(count[1])), order + count)[0])
                    size = number * int(kind[1])
                    values = numpy.frombuffer(stream.read(size), order + kind).tolist()
                if number < 0 or len(values) < number:
                    return None
                row[name] = values if count else values[0]
        except (ValueError, IndexError):
            return None
        return row

    def least_size(self):
        """Bytes of a row whose lists are empty."""
        return sum(int((count or kind)[1]) for _, kind, count in self.properties)


def read_header(path, stream):
    """(byte order or "" for text, elements, lines of the header)."""
    order, elements = None, []
    for number in itertools.count(1):
        line = stream.readline(4096)
        words = line.decode("latin-1").split()
        try:
            if not line.endswith(b"\n"):
                raise FileError(f"{path}: is cut off: its header has no end")
            if words[:1] == ["end_header"]:
                break
            if words and words[0] == "format":
                order = FORMATS[words[1]]
            elif words and words[0] == "element":
                elements.append(Element(words[1], int(words[2]), []))
            elif words and words[0] == "property":
                is_list = words[1] == "list"
                count = TYPES[words[2]] if is_list else None
                kind = TYPES[words[3 if is_list else 1]]
                elements[-1].properties.append((words[4 if is_list else 2], kind, count))
            elif words and words[0] not in ("ply", "comment", "obj_info"):
                raise KeyError
        except (KeyError, IndexError, ValueError):
            shown = line.decode("latin-1").strip()[:40]
            raise FileError(f"{path}, line {number}: '{shown}' means nothing in PLY") from None
    if order is None:
        raise FileError(f"{path}: its header names no format")
    return order, elements, number


def open_vertices(path, stream):
    """(order, elements, place of the vertices among them, lines of the header)."""
    order, elements, number = read_header(path, stream)
    names = [element.name for element in elements]
    place = names.index("vertex") if "vertex" in names else -1
    properties = [name for name, _, _ in elements[place].properties] if place >= 0 else []
    if not {"x", "y", "z"} <= set(properties):
        raise FileError(f"{path}: holds no vertices with x, y and z")
    if len(properties) > len(set(properties)):
        raise FileError(f"{path}: its vertices have a property twice")
    if elements[place].count < 1 or elements[place].has_list():
        why = "lists among its vertices" if elements[place].count else "no points"
        raise FileError(f"{path}: holds {why}")
    return order, elements, place, number


def row_coordinates(rows):
    return numpy.column_stack([rows[axis].astype("f8") for axis in "xyz"])


def read_points(path, options):
    """The vertices, wherever they stand in the file; their other numbers become point arrays."""
    with open(path, "rb") as stream:
        order, elements, place, number = open_vertices(path, stream)
        vertex, before, after = elements[place], elements[:place], elements[place + 1 :]
        read = read_binary if order else read_text
        rows, notes = read(
            path, stream, order or number, vertex, before, after, options.progress
        )
    coordinates = row_coordinates(rows)
    cloud = Cloud(make_points(coordinates, copy=False), notes)
    add_arrays(cloud.points, rows)
    if any(element.count for element in elements if element.name != "vertex"):
        cloud.notes.append("only the points are used, not the file's cells")
        if not options.points_only:
            cloud.notes += check_faces(path, read_faces(path, coordinates, options.progress), options)
    if rows["x"].dtype == "f4":
        note = rounding_note(coordinates, "the file is")
        cloud.notes += [note] if note else []
    return cloud


def read_faces(path, coordinates, progress):
    """The faces as vtkPolyData, as VTK reads them, with exact points; None where it cannot."""
    from vtkmodules.vtkIOPLY import vtkPLYReader

    reader = vtkPLYReader()
    reader.SetFileName(path)
    with Messages():
        if not survives(reader.Update, lambda: progress(1.0)):
            return None
        reader.Update()
    cells = reader.GetOutput().GetPolys()
    ids = vtk_to_numpy(cells.GetConnectivityArray())
    if not len(ids) or ids.min() < 0 or ids.max() >= len(coordinates):
        return None
    return make_faces(coordinates, cells)


def read_lines(path, singular, progress):
    """The faces, or edges where there are none, as vtkPolyData. Takes seconds for 100,000 faces."""
    options = ReadOptions(progress=share(progress, 0.0, 0.3), points_only=True)
    points = read_points(path, options).points
    progress = share(progress, 0.3, 1.0)
    with open(path, "rb") as stream:
        order, elements, _, number = open_vertices(path, stream)
        rows = {}
        for element in elements:
            rows[element.name] = []
            for i in items_with_progress(range(element.count), progress, element.count):
                row = element.read_row(stream, order)
                if row is None:
                    raise FileError(f"{path}: is damaged in its {element.name} {i + 1}")
                if element.name in ("face", "edge"):
                    rows[element.name].append(row)
    cells = vtkCellArray()
    faces = [row.get("vertex_indices", row.get("vertex_index")) for row in rows.get("face", ())]
    edges = [(row.get("vertex1"), row.get("vertex2")) for row in rows.get("edge", ())]
    for ids in faces or edges:
        if ids is None or None in ids:
            raise FileError(f"{path}: its faces or edges do not list their vertices")
        bad = next((i for i in ids if not 0 <= i < points.GetNumberOfPoints()), None)
        if bad is not None:
            count = points.GetNumberOfPoints()
            raise FileError(
                f"{path}: is damaged: a cell has the corner {bad}, but there are {count:,} points"
            )
        cells.InsertNextCell(len(ids), [int(i) for i in ids])
    if not cells.GetNumberOfCells():
        raise FileError(f"{path}: holds no line and no polygon that could be {singular}")
    (points.SetPolys if faces else points.SetLines)(cells)
    return points


def add_arrays(points, rows):
    """Colours as one array RGB, every other number that is not a coordinate by its name."""
    names = [name for name in rows.dtype.names if name not in ("x", "y", "z")]
    arrays = {}
    if set(COLOURS) <= set(names) and all(rows[name].dtype == numpy.uint8 for name in COLOURS):
        arrays["RGB"] = numpy.column_stack([rows[name] for name in COLOURS])
        names = [name for name in names if name not in COLOURS]
    arrays.update((name, rows[name]) for name in names)
    for name, values in arrays.items():
        add_array(points, name, values.astype(values.dtype.newbyteorder("=")))


def read_text(path, stream, number, vertex, before, after, progress):
    skip = sum(element.count for element in before)
    number += sum(1 for _ in itertools.islice(stream, skip))
    seen, last = itertools.count(number + 1), b"\n"

    def lines():
        nonlocal number, last
        for number, last in zip(seen, items_with_progress(stream, progress, vertex.count)):
            yield last

    try:
        # Its own max_rows would be allocated before anything is read.
        rows = itertools.islice(lines(), vertex.count)
        rows = numpy.loadtxt(rows, vertex.row_type(""), comments=None, ndmin=1)
    except (ValueError, OverflowError) as error:
        words = str(error).split(" at row")[0]
        raise FileError(f"{path}, line {number}: is not a vertex: {words}") from None
    check_count(path, len(rows), vertex)
    notes = []
    if not last.endswith(b"\n"):
        notes.append("the last line has no end, so the last number may be cut off")
    if sum(1 for line in stream if line.strip()) < sum(element.count for element in after):
        notes.append("the file is cut off behind its vertices")
    return rows, notes


def check_count(path, found, vertex):
    if found < vertex.count:
        raise FileError(
            f"{path}: is cut off: {vertex.count:,} vertices are announced, {found:,} found"
        )


def read_binary(path, stream, order, vertex, before, after, _progress):
    size = os.fstat(stream.fileno()).st_size
    for element in before:
        step_over(path, stream, order, element)
    kind = vertex.row_type(order)
    check_count(path, max(size - stream.tell(), 0) // kind.itemsize, vertex)
    rows = numpy.fromfile(stream, kind, vertex.count)
    rest = sum(element.count * element.least_size() for element in after)
    return rows, ["the file is cut off behind its vertices"] * (size - stream.tell() < rest)


def step_over(path, stream, order, element):
    """Moves the stream behind an element, whose lists have their lengths in each row."""
    if not element.has_list():
        stream.seek(element.count * element.least_size(), os.SEEK_CUR)
        return
    for _ in range(element.count):
        if element.read_row(stream, order) is None:
            raise FileError(f"{path}: is cut off within its {element.name}")
