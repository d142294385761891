# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Data sets of numpy arrays, and back again: for the tests in Python and in ParaView."""

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

GHOSTS = "vtkGhostType"
DUPLICATE = 1  # the mark of points and cells that another part owns


def array_of(values, name):
    """An array of VTK: of strings, of ids (int64), or of numbers of the same type."""
    values = numpy.asarray(values)
    if values.dtype.kind == "U":
        array = vtkStringArray()
        for value in values.tolist():
            array.InsertNextValue(value)
    elif values.dtype == numpy.int64:
        array = numpy_to_vtkIdTypeArray(numpy.ascontiguousarray(values), deep=True)
    else:
        array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName(name)
    return array


def cloud(coordinates, ids=None, arrays=(), kind=vtkPolyData):
    """A data set of points: coordinates (n, 3), float or double; arrays are pairs (name, values).

    ids  are marked as global ids
    """
    data, points = kind(), vtkPoints()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(coordinates), deep=True))
    data.SetPoints(points)
    if ids is not None:
        data.GetPointData().SetGlobalIds(array_of(numpy.asarray(ids, numpy.int64), "numbers"))
    for name, values in arrays:
        data.GetPointData().AddArray(array_of(values, name))
    return data


def cells_of(cells):
    """Cells of a list of lists of ids."""
    made = vtkCellArray()
    for ids in cells:
        made.InsertNextCell(len(ids), [int(i) for i in ids])
    return made


def mesh(coordinates, triangles, ids=None, arrays=(), cell_arrays=()):
    """A data set of triangles, (m, 3)."""
    data, cells = cloud(coordinates, ids, arrays), vtkCellArray()
    offsets = numpy.arange(0, 3 * len(triangles) + 1, 3, dtype=numpy.int64)
    corners = numpy.asarray(triangles, numpy.int64).ravel()
    cells.SetData(*(numpy_to_vtkIdTypeArray(part, deep=True) for part in (offsets, corners)))
    data.SetPolys(cells)
    for name, values in cell_arrays:
        data.GetCellData().AddArray(array_of(values, name))
    return data


def lines(coordinates, cells, polygons=(), arrays=()):
    """A data set of lines and polygons, lists of lists of ids."""
    data = cloud(coordinates, None, arrays)
    data.SetLines(cells_of(cells))
    data.SetPolys(cells_of(polygons))
    return data


def rings(parts):
    """A data set of closed lines, one for each list of x,y or x,y,z whose last is not its first."""
    coordinates, cells = [numpy.zeros((0, 3))], []
    for part in parts:
        first = sum(map(len, coordinates))
        part = numpy.asarray(part, float)
        coordinates.append(numpy.column_stack((part, numpy.zeros((len(part), 3 - part.shape[1])))))
        cells.append([*range(first, first + len(part)), first])
    return lines(numpy.vstack(coordinates), cells)


def points_of(data):
    """(n, 3), of the type of the data set's points."""
    if not data.GetNumberOfPoints():
        return numpy.zeros((0, 3))
    return vtk_to_numpy(data.GetPoints().GetData())


def triangles_of(data):
    """(m, 3) ids of points."""
    if not data.GetNumberOfPolys():
        return numpy.zeros((0, 3), int)
    return vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(int)


def ghosts_of(data):
    """Which points another part owns."""
    marks = data.GetPointData().GetArray(GHOSTS)
    if not marks or not data.GetNumberOfPoints():
        return numpy.zeros(data.GetNumberOfPoints(), bool)
    return vtk_to_numpy(marks) != 0


def turned(triangles, keys=None):
    """Triangles from their least corner on: by the id, or by the rows of numbers of each corner."""
    corners = triangles[:, :, None] if keys is None else keys[triangles]
    first = numpy.lexsort(numpy.moveaxis(corners, 2, 0)[::-1], axis=1)[:, :1]
    return numpy.take_along_axis(triangles, (first + numpy.arange(3)) % 3, axis=1)


def sorted_rows(rows):
    """Rows of numbers in one order."""
    return rows[numpy.lexsort(rows.T[::-1])] if rows.size else rows


def sorted_triangles(triangles):
    """Each from its least id on, in one order."""
    return sorted_rows(turned(triangles))


def by_places(data):
    """The triangles by the places of their corners, nine numbers each, in one order."""
    places = points_of(data)
    return sorted_rows(places[turned(triangles_of(data), places)].reshape(-1, 9))
