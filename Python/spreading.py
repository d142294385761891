# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The chain on several ranks: points go from the first to all, a surface comes from all to the first.

Without a controller there is one rank, and all stays as it is.
"""

import numpy
from vtkmodules.util.numpy_support import (
    numpy_to_vtk,
    numpy_to_vtkIdTypeArray,
    vtk_to_numpy,
)
from vtkmodules.vtkCommonCore import vtkIdTypeArray, vtkPoints, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData

from .clouds import cells_of, corner_flags, some_points
from .inputs import joined
from .ranks import collected, packed, shared, together, unpacked

IDS = "PlaceInInput"  # the global ids that points have on the way
GHOSTS = vtkDataSetAttributes.GhostArrayName()
OF_A_RANK = ("WorkOfRank", "WorkOfTrim")  # field data
TAG = 20
# Why a point is in no triangle, by number; others are those of vtkGridDelaunay2D.
WITHIN_ERROR, OUT_OF_OUTLINE, IN_NO_TRIANGLE = 3, 4, 5


def update(algorithm, ranks):
    """Updates an algorithm, on all ranks together if there are several."""
    if ranks is None:
        algorithm.Update()
    else:
        collected(ranks, ())  # where one has failed, none waits for it in the filter
        algorithm.UpdatePiece(ranks.GetLocalProcessId(), ranks.GetNumberOfProcesses(), 0)


# ---- to all -----------------------------------------------------------------------------------


def can_be_dealt(points):
    """Whether ranks do with points what one does: these have no ids or ghosts, which ranks go by."""
    data = points.GetPointData()
    return data.GetGlobalIds() is None and not data.HasArray(GHOSTS) and not data.HasArray(IDS)


def dealt(ranks, points):
    """The points that each rank has of those of the first: one slice after the other."""
    if ranks is None:
        return points
    own, count = ranks.GetLocalProcessId(), ranks.GetNumberOfProcesses()
    if own:
        mine = vtkPolyData()
        ranks.Receive(mine, 0, TAG)
        return unpacked(mine)
    ends = points.GetNumberOfPoints() * numpy.arange(count + 1) // count
    for rank in range(1, count):
        ranks.Send(packed(slice_of(points, ends[rank], ends[rank + 1])), rank, TAG)
    mine = slice_of(points, 0, ends[1])
    mine.GetFieldData().ShallowCopy(points.GetFieldData())
    return mine


def slice_of(points, first, last):
    """Some points with their data and their places as global ids."""
    rows = numpy.arange(first, last)
    some = some_points(points, rows)
    set_places(some, vtk_to_numpy(points.GetPoints().GetData())[first:last])
    ids = numpy_to_vtkIdTypeArray(rows, deep=True)
    ids.SetName(IDS)
    some.GetPointData().SetGlobalIds(ids)
    return some


def set_places(data, coordinates):
    """Gives a data set points of the type of these."""
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(coordinates), deep=True))
    data.SetPoints(points)


# ---- to the first -----------------------------------------------------------------------------


def ids_of(output):
    """The places in the input of the points of an output, as far as they were there."""
    ids = output.GetPointData().GetArray(IDS)
    return numpy.arange(output.GetNumberOfPoints()) if ids is None else vtk_to_numpy(ids)


def own_points(output):
    """Which points are not another rank's, (n,) of bool."""
    ghosts = output.GetPointData().GetArray(GHOSTS)
    if ghosts is None:
        return numpy.ones(output.GetNumberOfPoints(), dtype=bool)
    return vtk_to_numpy(ghosts) & vtkDataSetAttributes.DUPLICATEPOINT == 0


def reasons_of(ranks, triangulation, count):
    """(count,) numbers: 0 for points in triangles, or why they are in none, see Reconstruction."""
    ids, is_own = ids_of(triangulation), own_points(triangulation)
    corners = vtk_to_numpy(triangulation.GetPolys().GetConnectivityArray())
    used = corner_flags(corners, len(ids))
    fields = triangulation.GetFieldData()
    unused, why = fields.GetArray("UnusedPointIds"), fields.GetArray("UnusedPointReasons")
    unused, why = (vtk_to_numpy(a) if a else numpy.zeros(0, "i8") for a in (unused, why))
    tables = (ids[is_own & ~used], ids[~is_own & used], ids[unused], why)
    here_not, elsewhere, told, why = (numpy.concatenate(collected(ranks, t)) for t in tables)
    reasons = numpy.zeros(count, dtype="u1")
    if count:
        reasons[here_not[here_not < count]] = IN_NO_TRIANGLE
        reasons[elsewhere[elsewhere < count]] = 0
        reasons[told[told < count]] = why[told < count]  # lines may have added others
    return reasons


def whole_surface(ranks, output, reasons, filters):
    """The surface of all ranks on the first of them, as one rank makes it; empty on the others.

    reasons  those of reasons_of()
    filters  those that have run, or None
    """
    if ranks is None:
        return output
    own = ranks.GetLocalProcessId()
    having = together(ranks, lambda: [own] if output.GetNumberOfPoints() else [])
    if own:
        if own in having:
            ranks.Send(packed(output), 0, TAG)
        return vtkPolyData()
    parts = []
    for rank in having:
        parts.append(vtkPolyData())
        if rank:
            ranks.Receive(parts[-1], rank, TAG)
            parts[-1] = unpacked(parts[-1])
        else:
            parts[-1].ShallowCopy(output)
    surface = parts[0] if len(parts) == 1 else joined_by_ids(parts)
    set_unused(surface, reasons)
    set_counts(surface, filters)
    for name in (IDS, GHOSTS):
        surface.GetPointData().RemoveArray(name)
    for name in OF_A_RANK:
        surface.GetFieldData().RemoveArray(name)
    return surface


def joined_by_ids(parts):
    """Parts of a surface as one, with the points in the order of their ids."""
    append = vtkAppendPolyData()
    for part in parts:
        part.GetPointData().SetActiveAttribute(-1, vtkDataSetAttributes.GLOBALIDS)
        append.AddInputData(part)
    append.Update()
    every = append.GetOutput()
    ids = ids_of(every)
    rows = numpy.flatnonzero(own_points(every))
    rows = rows[numpy.argsort(ids[rows], kind="stable")]
    surface = some_points(every, rows)
    set_places(surface, vtk_to_numpy(every.GetPoints().GetData())[rows])
    corners = vtk_to_numpy(every.GetPolys().GetConnectivityArray())
    surface.SetPolys(cells_of(numpy.searchsorted(ids[rows], ids[corners]).reshape(-1, 3)))
    surface.GetCellData().ShallowCopy(every.GetCellData())
    surface.GetFieldData().ShallowCopy(parts[0].GetFieldData())
    return surface


def set_unused(surface, reasons):
    """Sets the field data of vtkGridDelaunay2D that tell of unused points."""
    unused = numpy.flatnonzero((reasons != 0) & (reasons != IN_NO_TRIANGLE))
    for name, values, array in (
        ("UnusedPointIds", unused, vtkIdTypeArray()),
        ("UnusedPointReasons", reasons[unused], vtkUnsignedCharArray()),
    ):
        array.SetName(name)
        array.SetNumberOfValues(len(values))
        vtk_to_numpy(array)[:] = values
        surface.GetFieldData().AddArray(array)


def set_counts(surface, filters):
    """Sets the field data that are counts of a filter: those of a rank are of its part alone."""
    fields = surface.GetFieldData()
    for i in range(fields.GetNumberOfArrays()):
        name = fields.GetArrayName(i)
        for algorithm in filters:
            if name.startswith("NumberOf") and hasattr(algorithm, f"Get{name}"):
                fields.GetArray(i).SetTuple1(0, getattr(algorithm, f"Get{name}")())


def whole_lines(ranks, output):
    """The lines of all ranks, on all of them; those that are the same on several count once."""
    if ranks is None:
        return output
    return joined(shared(ranks, lambda: output))
