# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points, lines and polygons of files that VTK reads."""

import math
import re

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import (
    vtkImageData,
    vtkPointSet,
    vtkPolyData,
    vtkRectilinearGrid,
)

from . import damage
from .clouds import Cloud
from .messages import FileError, Messages
from .paths import suffix_of
from .rasters import points_of_raster

def kind_of(path):
    """The suffix that the file's content ought to have."""
    with open(path, "rb") as stream:
        head = stream.read(4096)
    found = re.search(rb"<VTKFile[^>]*\btype\s*=\s*[\"'](\w+)", head)
    if found and found.group(1) in XML_KINDS:
        return XML_KINDS[found.group(1)]
    if head.startswith(b"# vtk DataFile"):
        return ".vtk"
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
    elif suffix == ".ply":
        from vtkmodules.vtkIOPLY import vtkPLYReader as reader
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
        }[suffix]
    return reader()


def run_vtk_reader(path):
    """The data object of a file in one of VTK's formats."""
    reason = damage.why_damaged(path, kind_of(path))
    if reason:
        raise FileError(f"{path}: {reason}")
    reader = vtk_reader(kind_of(path))
    with Messages() as messages:
        reader.SetFileName(path)
        reader.Update()
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
    data = run_vtk_reader(path)
    if isinstance(data, (vtkImageData, vtkRectilinearGrid)):
        return points_of_grid(path, data)
    if not isinstance(data, vtkPointSet):
        raise FileError(f"{path}: holds a {data.GetClassName()}, which has no points")
    if data.GetNumberOfPoints() == 0:
        raise FileError(f"{path}: holds no points")
    cloud = Cloud(data)
    vertices = data.GetNumberOfVerts() if isinstance(data, vtkPolyData) else 0
    if data.GetNumberOfCells() > vertices:
        cloud.notes.append("only the points are used, not the file's cells")
    if kind_of(path) == ".vtk" and damage.may_lack_digits(path):
        cloud.notes.append("the last line has no end, so the last number may be cut off")
    if kind_of(path) in (".stl", ".obj"):
        note = rounding_note(vtk_to_numpy(data.GetPoints().GetData()))
        if note:
            cloud.notes.append(note)
    return cloud


def rounding_note(coordinates, why="VTK reads this format"):
    """A line for the user when 32-bit coordinates are coarse beside the spacing, else None."""
    xy = coordinates[:, :2]
    xy = xy[numpy.isfinite(xy).all(axis=1)]
    if len(xy) < 2:
        return None
    step = float(numpy.spacing(numpy.float32(numpy.abs(xy).max())))
    extent = numpy.ptp(xy.astype("f8"), axis=0)
    spacing = math.sqrt(max(extent[0] * extent[1], 0.0) / len(xy))
    if step <= 0.01 * spacing:
        return None
    return (
        f"{why} in single precision: x and y are rounded to steps of {step:g}; "
        "use .vtp or text for large map coordinates"
    )


def points_of_grid(path, grid):
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
    columns, rows, layers = grid.GetDimensions()
    if layers != 1:
        raise FileError(f"{path}: is a grid of {layers} layers; one in the x,y plane is needed")
    if isinstance(grid, vtkImageData):
        first = grid.GetPoint(0)
        x = first[0] + grid.GetSpacing()[0] * numpy.arange(columns)
        y = first[1] + grid.GetSpacing()[1] * numpy.arange(rows)
    else:
        x = vtk_to_numpy(grid.GetXCoordinates()).astype("f8")
        y = vtk_to_numpy(grid.GetYCoordinates()).astype("f8")
    z = vtk_to_numpy(scalars).reshape(rows, columns)
    x, y = numpy.meshgrid(x, y)
    cloud = points_of_raster(path, x, y, z)
    cloud.notes.insert(0, f"elevation: point array {scalars.GetName() or '(unnamed)'}")
    return cloud


def read_lines(path, singular):
    """The vtkPolyData of a file in one of VTK's formats, which must hold lines or polygons."""
    data = run_vtk_reader(path)
    if not isinstance(data, vtkPolyData):
        raise FileError(f"{path}: holds a {data.GetClassName()}; {singular} is vtkPolyData")
    if data.GetNumberOfLines() + data.GetNumberOfPolys() == 0:
        raise FileError(f"{path}: holds no line and no polygon that could be {singular}")
    return data
