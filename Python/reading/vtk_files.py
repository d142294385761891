# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points, lines and polygons of files that VTK reads."""

import os
import re
import warnings

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import (
    vtkDataSetAttributes,
    vtkImageData,
    vtkPointSet,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkStructuredGrid,
)

from ..clouds import Cloud, crs_of, make_points, marked_points, rounding_note
from .formats import FORMATS, HEAD
from ..messages import FileError, Messages
from ..paths import suffix_of
from ..progress import no_progress, share, lines_with_progress
from .facing import check_faces, make_faces
from .rasters import raster_cloud
from .vtk_checks import check, survives


def file_kind(path):
    """The suffix that the file's content ought to have."""
    with open(path, "rb") as stream:
        head = stream.read(HEAD)
    found = re.search(rb"<VTKFile[^>]*\btype\s*=\s*[\"'](\w+)", head)
    if found and found.group(1) not in XML_KINDS:
        kind = found.group(1).decode()
        raise FileError(f"{path}: holds a {kind}, which is not read; save its parts")
    if found:
        return XML_KINDS[found.group(1)]
    for kind in FORMATS:
        if kind.module == "vtk_files" and kind.is_it(head, path):
            return kind.suffixes.split()[0]
    return suffix_of(path)


XML_KINDS = {
    b"PolyData": ".vtp",
    b"UnstructuredGrid": ".vtu",
    b"StructuredGrid": ".vts",
    b"RectilinearGrid": ".vtr",
    b"ImageData": ".vti",
}


def vtk_reader(suffix):
    """A fresh VTK reader for the suffix. Imported late: each of these modules takes time."""
    if suffix == ".vtk":
        from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader as reader
    elif suffix == ".stl":
        from vtkmodules.vtkIOGeometry import vtkSTLReader as reader
    elif suffix == ".obj":
        from vtkmodules.vtkIOGeometry import vtkOBJReader as reader
    else:
        from vtkmodules import vtkIOXML

        reader = {
            ".vtp": vtkIOXML.vtkXMLPolyDataReader,
            ".vtu": vtkIOXML.vtkXMLUnstructuredGridReader,
            ".vts": vtkIOXML.vtkXMLStructuredGridReader,
            ".vtr": vtkIOXML.vtkXMLRectilinearGridReader,
            ".vti": vtkIOXML.vtkXMLImageDataReader,
        }.get(suffix, vtkIOXML.vtkXMLPolyDataReader)
    return reader()


def run_vtk_reader(path, progress=no_progress):
    """The data object of a file in one of VTK's formats."""
    suffix = file_kind(path)
    check(path, suffix, progress)
    reader = vtk_reader(suffix)
    reader.SetFileName(path)
    with Messages() as messages:
        # Those of XML notice by themselves what is wrong.
        if not suffix.startswith(".vt") or suffix == ".vtk":
            if not survives(reader.Update, lambda: progress(0.0)):
                raise FileError(f"{path}: is damaged: VTK's reader crashes on it")
            progress = share(progress, 0.5, 1.0)
        update(reader, progress)
    # What VTK's legacy readers could not read, they leave as it was, with a warning only.
    short = [words for words in messages.warnings if words.startswith("Error reading")]
    if messages.errors or short:
        raise FileError(f"{path}: cannot be read: {(messages.errors + short)[0]}")
    data = reader.GetOutputDataObject(0)
    if data is None or messages.warnings and data.GetNumberOfElements(0) == 0:
        reason = messages.warnings[0] if messages.warnings else "VTK found no data in it"
        raise FileError(f"{path}: cannot be read: {reason}")
    if isinstance(data, vtkPolyData):
        check_point_ids(path, data)
    return data


def update(reader, progress):
    """Runs a reader of VTK. What progress() raises is raised when the reader has stopped."""
    raised, done = [], 0.0

    def show(caller, _event):
        nonlocal done
        if raised:
            return
        done = max(done, min(caller.GetProgress(), 1.0))  # some begin anew with each array
        try:
            progress(done)
        except BaseException as error:  # pylint: disable=broad-except
            raised.append(error)
            caller.SetAbortExecute(1)

    tag = reader.AddObserver("ProgressEvent", show)
    reader.Update()
    reader.RemoveObserver(tag)
    if raised:
        raise raised[0]


def check_point_ids(path, data):
    """Refuses cells with corners that are not there: filters trust these numbers."""
    for cells in (data.GetVerts(), data.GetLines(), data.GetPolys(), data.GetStrips()):
        ids = vtk_to_numpy(cells.GetConnectivityArray())
        if len(ids) and not (0 <= ids.min() and ids.max() < data.GetNumberOfPoints()):
            bad = ids.max() if ids.min() >= 0 else ids.min()
            raise FileError(
                f"{path}: is damaged: a cell has the corner {bad}, "
                f"but there are {data.GetNumberOfPoints():,} points"
            )


def read_points(path, options):
    suffix = file_kind(path)
    if suffix in VERTEX and is_text(path):
        # VTK reads these texts in single precision.
        check(path, suffix, options.progress)
        data = make_points(text_vertices(path, VERTEX[suffix], options.progress))
        cloud = Cloud(data, ["only the points are used, not the file's cells"])
        if not options.points_only:
            cloud.notes += check_faces(path, text_faces(path, suffix), options)
    else:
        data = run_vtk_reader(path, options.progress)
        if isinstance(data, (vtkImageData, vtkRectilinearGrid)):
            return grid_points(path, data)
        if not isinstance(data, vtkPointSet):
            raise FileError(f"{path}: holds a {data.GetClassName()}, which has no points")
        data = with_hidden_nodes(data)
        cloud = Cloud(data, crs=crs_of(data))
        vertices = data.GetNumberOfVerts() if isinstance(data, vtkPolyData) else 0
        if data.GetNumberOfCells() > vertices:
            cloud.notes.append("only the points are used, not the file's cells")
            cloud.notes += check_faces(path, data, options)
    if data.GetNumberOfPoints() == 0:
        raise FileError(f"{path}: holds no points")
    if suffix in (".vtk", ".obj") and is_text(path) and not ends_with_line(path):
        cloud.notes.append("the last line has no end, so the last number may be cut off")
    if suffix == ".stl" and not is_text(path):
        note = rounding_note(vtk_to_numpy(data.GetPoints().GetData()), "the file is")
        if note:
            cloud.notes.append(note)
    return cloud


def text_faces(path, suffix):
    """The faces of an STL or OBJ file of text, as exact as they stand there; VTK rounds to floats."""
    points = text_vertices(path, VERTEX[suffix], no_progress, once=False)
    if suffix == ".stl":
        return make_faces(points, numpy.arange(len(points) // 3 * 3).reshape(-1, 3))
    data = run_vtk_reader(path)
    return make_faces(points, data.GetPolys()) if data.GetNumberOfPoints() == len(points) else data


# The word before a vertex in text.
VERTEX = {".obj": b"v", ".stl": b"vertex"}


def is_text(path):
    with open(path, "rb") as stream:
        head = stream.read(300)
    return b"\0" not in head and b"\nBINARY" not in head.upper()


def ends_with_line(path):
    with open(path, "rb") as stream:
        stream.seek(-1, os.SEEK_END)
        return stream.read().isspace()


def text_vertices(path, word, progress, once=True):
    """(n, 3) coordinates of lines that begin with a word, in the file's order."""
    number = 0

    def rows(stream):
        nonlocal number
        for number, line in enumerate(lines_with_progress(stream, progress), 1):
            words = line.split(None, 4) if line.lstrip()[:1].lower() == b"v" else ()
            if words and words[0].lower() == word:
                yield b" ".join(words[1:4])

    with open(path, "rb") as stream, warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # that there is nothing
        try:
            found = numpy.loadtxt(rows(stream), comments=None, ndmin=2)
            if len(found) and found.shape[1] != 3:
                raise ValueError
        except ValueError:
            raise FileError(f"{path}, line {number}: is not a vertex of three numbers") from None
    if not len(found):
        return numpy.empty((0, 3))
    if not once:
        return found
    _, firsts = numpy.unique(found, axis=0, return_index=True)
    return found[numpy.sort(firsts)]


def grid_dimensions(grid):
    """Columns, rows and layers of a grid of any kind and VTK."""
    extent = grid.GetExtent()
    return [last - first + 1 for first, last in zip(extent[::2], extent[1::2])]


def grid_points(path, grid, ids=None):
    """A flat grid with one elevation for each node -> its nodes as points."""
    scalars = grid.GetPointData().GetScalars()
    if scalars is None:
        for i in range(grid.GetPointData().GetNumberOfArrays()):
            candidate = grid.GetPointData().GetArray(i)
            if candidate is not None and candidate.GetNumberOfComponents() == 1:
                scalars = candidate
                break
    if scalars is None or scalars.GetNumberOfComponents() != 1:
        raise FileError(f"{path}: holds no point array with one elevation for each node")
    columns, rows, layers = grid_dimensions(grid)
    if layers != 1:
        raise FileError(f"{path}: is a grid of {layers} layers; one in the x,y plane is needed")
    x, y = image_places(path, grid) if isinstance(grid, vtkImageData) else node_places(grid)
    z = vtk_to_numpy(scalars).reshape(rows, columns)
    hidden = hidden_nodes(grid)
    if hidden.any():
        z = numpy.where(hidden, numpy.nan, z)
    cloud = raster_cloud(path, x, y, z, ids)
    cloud.z_name = scalars.GetName() or ""
    cloud.notes.insert(0, f"elevation: point array {scalars.GetName() or '(unnamed)'}")
    if isinstance(grid, vtkRectilinearGrid) and rows > 1 and columns > 1:
        cloud.largest_cell = float(numpy.hypot(*(abs(numpy.diff(v)).max() for v in (x[0], y[:, 0]))))
    return cloud


def node_places(grid):
    """x and y of the nodes of a rectilinear grid, (rows, columns) each."""
    return numpy.meshgrid(
        vtk_to_numpy(grid.GetXCoordinates()).astype("f8"),
        vtk_to_numpy(grid.GetYCoordinates()).astype("f8"),
    )


def image_places(path, grid):
    """x and y of the nodes of an image, which may be turned, (rows, columns) each."""
    matrix, spacing = grid.GetDirectionMatrix(), grid.GetSpacing()
    steps = [[matrix.GetElement(k, axis) * spacing[axis] for k in range(3)] for axis in (0, 1)]
    if steps[0][2] or steps[1][2]:
        raise FileError(f"{path}: is an image that leans; one in the x,y plane is needed")
    first, (columns, rows, _) = grid.GetPoint(0), grid_dimensions(grid)
    across, up = numpy.meshgrid(numpy.arange(columns), numpy.arange(rows))
    return [first[k] + steps[0][k] * across + steps[1][k] * up for k in (0, 1)]


def with_hidden_nodes(data):
    """A point set; of a flat structured grid, nodes of which all cells are blanked are marked, too."""
    if not isinstance(data, vtkStructuredGrid) or grid_dimensions(data)[2] != 1:
        return data
    hidden, mark = hidden_nodes(data).ravel(), vtkDataSetAttributes.HIDDENPOINT
    if (hidden == marked_points(data, mark)).all():
        return data
    given = data.GetPointData().GetArray(vtkDataSetAttributes.GhostArrayName())
    marks = numpy.where(hidden, mark, 0).astype("u1") | (0 if given is None else vtk_to_numpy(given))
    array = numpy_to_vtk(marks, deep=True)
    array.SetName(vtkDataSetAttributes.GhostArrayName())
    result = data.NewInstance()
    result.ShallowCopy(data)
    result.GetPointData().AddArray(array)
    return result


def hidden_nodes(grid):
    """(rows, columns) of bool: the nodes that are blanked, or of which all cells are."""
    columns, rows, _ = grid_dimensions(grid)
    hidden = marked_points(grid, vtkDataSetAttributes.HIDDENPOINT).reshape(rows, columns)
    ghosts = grid.GetCellData().GetArray(vtkDataSetAttributes.GhostArrayName())
    if ghosts is not None and rows > 1 and columns > 1:
        blank = vtk_to_numpy(ghosts).reshape(rows - 1, columns - 1) & vtkDataSetAttributes.HIDDENCELL
        around = numpy.pad(blank == 0, 1)
        shown = around[:-1, :-1] | around[:-1, 1:] | around[1:, :-1] | around[1:, 1:]
        hidden = hidden | ~shown
    return hidden


def read_lines(path, singular, progress):
    """The vtkPolyData of a file in one of VTK's formats, which must hold lines or polygons."""
    data = run_vtk_reader(path, share(progress, 0.0, 0.8))
    if not isinstance(data, vtkPolyData):
        raise FileError(f"{path}: holds a {data.GetClassName()}; {singular} is vtkPolyData")
    if data.GetNumberOfLines() + data.GetNumberOfPolys() == 0:
        raise FileError(f"{path}: holds no line and no polygon that could be {singular}")
    if file_kind(path) == ".obj":
        exact = text_vertices(path, b"v", share(progress, 0.8, 1.0), once=False)
        if len(exact) == data.GetNumberOfPoints():
            data.SetPoints(make_points(exact).GetPoints())
    return data
