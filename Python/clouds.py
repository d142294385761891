# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points as they come from a reader."""

import dataclasses

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData


class Cloud:
    """The points that were read.

    points   vtkPointSet with point data
    notes    what was found out or assumed, one line each, for the user
    left_out {reason: count} of what the file holds but is no point, as pixels without data
    lines    for text files, the line of each point in the file, else None
    crs      the coordinate reference system as WKT or AUTHORITY:CODE, or None where it is not known
    """

    def __init__(self, points, notes=(), left_out=None, lines=None, crs=None):
        self.points = points
        self.notes = list(notes)
        self.left_out = dict(left_out or {})
        self.lines = lines
        self.crs = crs


@dataclasses.dataclass
class ReadOptions:
    """What the user said on how a file is to be read; see --help."""

    columns: object = None  # None, or three names or numbers (from 1) of the x, y and z columns
    no_data: object = None  # None, or the elevation that marks missing values


def make_points(coordinates):
    """(n, 3) float64 coordinates -> vtkPolyData with points only."""
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(coordinates, dtype="f8"), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    return data


def some_points(data, keep):
    """The points of a data set with the given ids, with their point data, as vtkPolyData."""
    result = make_points(vtk_to_numpy(data.GetPoints().GetData())[keep])
    ids = vtkIdList()
    ids.SetNumberOfIds(len(keep))
    new_ids = vtkIdList()
    new_ids.SetNumberOfIds(len(keep))
    for new, old in enumerate(keep.tolist()):
        ids.SetId(new, old)
        new_ids.SetId(new, new)
    result.GetPointData().CopyAllocate(data.GetPointData(), len(keep))
    result.GetPointData().CopyData(data.GetPointData(), ids, new_ids)
    return result
