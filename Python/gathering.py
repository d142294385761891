# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Brings what is spread over ranks (processes) to one of them, for each surface of an input.

The filters do it: a vtkTrimOutwardTriangles without triangles gathers the points of all ranks on the
rank with most of them, and passes them. So the rules are those of the filters. Grids and tables
travel as points.
"""

import dataclasses

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdTypeArray
from vtkmodules.vtkCommonDataModel import (
    vtkDataSetAttributes,
    vtkImageData,
    vtkPartitionedDataSet,
    vtkPointSet,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkTable,
)

from .blocks import number_of_points
from .clouds import make_points
from .messages import ElevationSurfaceError, Messages
from .ranks import number_of, together
from .vtkElevationSurface import vtkTrimOutwardTriangles

IDS = "GatheringIds"  # made for the way, where points have no global ids
ROW, BASE = 1 << 31, 1 << 30  # the number of a node is BASE + column + ROW * (BASE + row)
KINDS = ((vtkTable, "tables"), (vtkImageData, "images"), (vtkRectilinearGrid, "grids"))


def gathered(controller, parts, warn):
    """The Parts, in which each surface has its points on one rank.

    warn  takes the words of each warning

    Where it fails, it raises on all ranks.
    """
    full = [part for part in parts if number_of_points(part.data) > 0]
    own = controller.GetLocalProcessId()
    found = together(controller, lambda: [[number_of(part.surface), own] for part in full])
    ranks = {}
    for number, rank in found:
        ranks.setdefault(number, set()).add(rank)
    for number in sorted(number for number, having in ranks.items() if len(having) > 1):
        mine = [part for part in full if number_of(part.surface) == number]
        whole = gathered_parts(controller, mine, warn)
        changed = {part.place: part.data.NewInstance() for part in mine}
        parts = [dataclasses.replace(p, data=changed.get(p.place, p.data)) for p in parts]
        if whole is not None:
            at = [part.place for part in parts].index(mine[0].place)
            parts[at] = dataclasses.replace(parts[at], data=whole, name=mine[0].block)
    return parts


def gathered_parts(controller, mine, warn):
    """The data of all ranks' parts of one surface, on the rank with most; None on the others."""
    own = controller.GetLocalProcessId()

    def describe():
        return [
            [kind_of(part.data), number_of_points(part.data), needs_ids(part.data), own]
            for part in mine
        ]

    rows = together(controller, describe)
    kinds = {kind for kind, *_ in rows}
    if len(kinds) > 1:
        raise ElevationSurfaceError(
            f"{mine[0].block + ': ' if mine and mine[0].block else ''}different ranks (processes) "
            f"have different kinds of it: {' and '.join(sorted(kinds))}"
        )
    first = sum(count for _, count, _, rank in rows if rank < own)
    are_to_be_numbered = all(needs for _, _, needs, _ in rows)
    pieces = vtkPartitionedDataSet()

    def make_pieces():
        begin = first
        for i, part in enumerate(mine):
            pieces.SetPartition(i, on_the_way(part.data, begin if are_to_be_numbered else None))
            begin += number_of_points(part.data)
        return []

    together(controller, make_pieces)
    made = run_gathering(controller, pieces, warn)
    arrived = None

    def unpack():
        nonlocal arrived
        for i in range(made.GetNumberOfPartitions()):
            if made.GetPartition(i).GetNumberOfPoints() > 0:
                arrived = as_it_was(made.GetPartition(i), mine[0].data)
        return []

    together(controller, unpack)
    return arrived


def run_gathering(controller, pieces, warn):
    """The output of the filter, to which all ranks have brought their pieces."""
    gatherer = vtkTrimOutwardTriangles()
    gatherer.SetInputDataObject(0, pieces)
    with Messages(gatherer, gatherer.GetExecutive()) as messages:
        gatherer.UpdatePiece(controller.GetLocalProcessId(), controller.GetNumberOfProcesses(), 0)

    def check():
        if messages.errors:  # of all ranks, on the first
            raise ElevationSurfaceError(messages.errors[0])
        return []

    together(controller, check)
    for words in messages.warnings:
        warn(words)
    return gatherer.GetOutputDataObject(0)


def kind_of(data):
    return next((name for kind, name in KINDS if isinstance(data, kind)), "points")


def needs_ids(data):
    """Whether nothing tells which points several ranks have: no global ids, no ghosts."""
    if not isinstance(data, vtkPointSet):
        return True
    ghosts = data.GetPointData().GetArray(vtkDataSetAttributes.GhostArrayName())
    marked = ghosts and (vtk_to_numpy(ghosts) & vtkDataSetAttributes.DUPLICATEPOINT).any()
    return data.GetPointData().GetGlobalIds() is None and not marked


def on_the_way(data, first):
    """The points of a data set with their arrays.

    first  the number of the first of them, if they are to be numbered
    """
    count = number_of_points(data)
    points = vtkPolyData()
    if isinstance(data, vtkPointSet):
        points.SetPoints(data.GetPoints())
        points.GetPointData().ShallowCopy(data.GetPointData())
    else:
        points.SetPoints(make_points(places_of(data)).GetPoints())
        arrays = data.GetRowData() if isinstance(data, vtkTable) else data.GetPointData()
        points.GetPointData().ShallowCopy(arrays)
    # The filter takes it for what was triangulated, and does not tell that there are no triangles.
    told = vtkIdTypeArray()
    told.SetName("UnusedPointIds")
    points.GetFieldData().AddArray(told)
    if first is not None:
        grid = isinstance(data, (vtkImageData, vtkRectilinearGrid))
        numbers = nodes_of(data) if grid else first + numpy.arange(count)
        ids = numpy_to_vtkIdTypeArray(numbers, deep=True)
        ids.SetName(IDS)
        points.GetPointData().SetGlobalIds(ids)
    return points


def places_of(data):
    """x, y, 0 of the nodes of a rectilinear grid. Nothing else has places of its own."""
    xyz = numpy.zeros((number_of_points(data), 3))
    if isinstance(data, vtkRectilinearGrid):
        x, y = (vtk_to_numpy(a) for a in (data.GetXCoordinates(), data.GetYCoordinates()))
        xyz[:, 0], xyz[:, 1] = numpy.tile(x, len(y)), numpy.repeat(y, len(x))
    return xyz


def nodes_of(grid):
    """The numbers of the nodes, by their places in the whole grid."""
    west, east, south, north, bottom, top = grid.GetExtent()
    if bottom != top:
        raise ElevationSurfaceError(
            f"the grid has {top - bottom + 1} layers; one in the x,y plane is needed"
        )
    rows = ROW * (BASE + numpy.arange(south, north + 1)[:, None])
    return (rows + BASE + numpy.arange(west, east + 1)).ravel()


def as_it_was(points, own):
    """What on_the_way() has made of data sets like own, of all of them together."""
    data = points.GetPointData()
    ids = data.GetArray(IDS)
    numbers = vtk_to_numpy(ids).copy() if ids else None
    data.RemoveArray(IDS)
    if isinstance(own, vtkTable):
        whole = vtkTable()
        whole.GetRowData().ShallowCopy(data)
    elif isinstance(own, vtkPointSet):
        whole = vtkPolyData()
        whole.SetPoints(points.GetPoints())
        whole.GetPointData().ShallowCopy(data)
    else:
        whole = own.NewInstance()
        make_grid(whole, own, numbers, vtk_to_numpy(points.GetPoints().GetData()))
        whole.GetPointData().ShallowCopy(data)
    whole.GetFieldData().ShallowCopy(own.GetFieldData())
    return whole


def make_grid(whole, own, numbers, xyz):
    """Gives a grid like own all the nodes with these numbers, which increase."""
    rows, columns = numbers // ROW - BASE, numbers % ROW - BASE
    west, east, south, north = columns.min(), columns.max(), rows.min(), rows.max()
    if len(numbers) != (east - west + 1) * (north - south + 1):
        raise ElevationSurfaceError("the ranks' pieces of the grid do not make a rectangle")
    bottom = own.GetExtent()[4]
    if isinstance(own, vtkImageData):
        whole.SetOrigin(own.GetOrigin())
        whole.SetSpacing(own.GetSpacing())
        whole.SetDirectionMatrix(own.GetDirectionMatrix())
    else:
        for values, set_values in (
            (xyz[: east - west + 1, 0], whole.SetXCoordinates),
            (xyz[:: east - west + 1, 1], whole.SetYCoordinates),
        ):
            set_values(numpy_to_vtk(numpy.ascontiguousarray(values), deep=True))
        whole.SetZCoordinates(own.GetZCoordinates())
    whole.SetExtent(int(west), int(east), int(south), int(north), bottom, bottom)
