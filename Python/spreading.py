# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A surface that is spread over ranks, of which each has its part: what the parts say together, and how
the program's first rank scatters points and gathers the surface.

In the output of a filter, points that belong to this rank come first, those of its input before others;
then come copies of points of other ranks. Without a controller there is one rank, and all points are
its own.
"""

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdTypeArray, vtkPoints, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData

from .clouds import add_array, cells_of, coordinates_of, joined, marked_points, some_points, triangles_of
from .messages import ElevationSurfaceError, Messages
from .passes import corner_flags, keep_flagged
from .ranks import agreed, all_values, before, collected, packed, shared, together, total, unpacked
from .vtkElevationSurface import vtkTrimOutwardTriangles

ORIGINAL_IDS = "OriginalPointIds"  # of points of the input, in a surface without unused points
IDS = "PlaceInInput"  # made for the way, where points have no global ids
GHOSTS = vtkDataSetAttributes.GhostArrayName()
RANK_FIELDS = ("WorkOfRank", "WorkOfTrim")  # field data
TAG = 20
# Why a point is in no triangle, by number; the first four are those of vtkGridDelaunay2D.
SAME_PLACE, NOT_FINITE, WITHIN_ERROR, HIDDEN, OUTSIDE_OUTLINE, IN_NO_TRIANGLE = 1, 2, 3, 4, 5, 6


def update(algorithm, ranks):
    """Updates an algorithm, on all ranks together if there are several."""
    if ranks is None:
        algorithm.Update()
    else:
        collected(ranks, ())  # where one has failed, none waits for it in the filter
        algorithm.UpdatePiece(ranks.GetLocalProcessId(), ranks.GetNumberOfProcesses(), 0)


# ---- parts ------------------------------------------------------------------------------------


def ids_of(ranks, output):
    """The places in the input of the points of an output; on ranks their global ids."""
    ids = output.GetPointData().GetGlobalIds() if ranks else None
    return numpy.arange(output.GetNumberOfPoints()) if ids is None else vtk_to_numpy(ids)


def own_points(output):
    """Which points are not another rank's, (n,) of bool."""
    return ~marked_points(output, vtkDataSetAttributes.DUPLICATEPOINT)


def last_id(ranks, points):
    """The largest of ids_of() the points that all ranks have given; points: those of this rank."""
    ids, count = points.GetPointData().GetGlobalIds(), points.GetNumberOfPoints()
    have_ids = ranks and not total(ranks, count > 0 and ids is None)
    last = vtk_to_numpy(ids).max(initial=-1) if ids and have_ids else count - 1
    last = all_values(ranks, [last])
    return last.max() if have_ids else (last + 1).sum() - 1  # the filter numbers them, rank after rank


def own_point_count(ranks, triangulation, points):
    """How many of the points that all ranks have given belong to this rank now; points: its input."""
    if ranks is None:
        return points.GetNumberOfPoints()
    last = last_id(ranks, points)
    return int(numpy.count_nonzero(own_points(triangulation) & (ids_of(ranks, triangulation) <= last)))


def used_points(ranks, surface):
    """(n,) of bool: the points that are corners of triangles, on any rank."""
    used = corner_flags(triangles_of(surface), surface.GetNumberOfPoints())
    if ranks is None:
        return used
    ids = ids_of(ranks, surface)
    return used | numpy.isin(ids, all_values(ranks, ids[used & ~own_points(surface)]))


def reasons_of(ranks, triangulation, count):
    """(count,) numbers of the first points: 0 for those in triangles, or why they are in none, see
    Reconstruction."""
    used = used_points(ranks, triangulation)[:count]
    reasons = numpy.where(used, 0, IN_NO_TRIANGLE).astype("u1")
    fields = triangulation.GetFieldData()
    unused, why = fields.GetArray("UnusedPointIds"), fields.GetArray("UnusedPointReasons")
    if unused:
        unused, why = vtk_to_numpy(unused), vtk_to_numpy(why)
        reasons[unused[unused < count]] = why[unused < count]  # lines may have added others
    return reasons


def follow_points(ranks, earlier, reasons, later, points):
    """(output, reasons_of() its first points): those of an earlier filter, or, where a later one has
    brought points to other ranks, those of that; points: as of own_point_count()."""
    if ranks is None:
        return earlier, reasons
    old = ids_of(ranks, earlier)[: len(reasons)]
    new = ids_of(ranks, later)[: own_point_count(ranks, later, points)]
    if not total(ranks, not numpy.array_equal(old, new)):
        return earlier, reasons
    unused = reasons != 0
    reasons = dict(zip(*(all_values(ranks, one[unused]).tolist() for one in (old, reasons))))
    return later, numpy.array([reasons.get(one, 0) for one in new.tolist()], dtype="u1")


def original_ids(data):
    """The array OriginalPointIds of points, (n,) of signed integers longer than a byte, as the filters take
    them, or None."""
    array = data.GetPointData().GetArray(ORIGINAL_IDS)
    if array is None or array.GetNumberOfComponents() != 1 or array.GetDataTypeSize() < 2:
        return None
    values = vtk_to_numpy(array)
    return values if values.dtype.kind == "i" else None


def without_unused(ranks, surface, used, last, frees=False):
    """A surface without the points that no triangle has, as the filters' RemoveUnusedPoints makes it.

    used   used_points() of it
    last   last_id() of the input
    frees  True: the surface is empty then, and memory for an array more is all that is needed
    """
    ids = ids_of(ranks, surface) if ranks else None
    given, own = surface.GetPointData().GetGlobalIds(), original_ids(surface)

    def numbers_of(places):
        """In the input, of points of the surface."""
        if own is not None:
            return own[places].astype("i8")
        number = places if ids is None else ids[places]
        return numpy.where(number <= last, number if given is None else vtk_to_numpy(given)[places], -1)

    whole = vtkPolyData()
    whole.ShallowCopy(surface)
    unused, why = (surface.GetFieldData().GetArray(f"UnusedPoint{what}") for what in ("Ids", "Reasons"))
    if unused:
        set_unused(whole, numbers_of(vtk_to_numpy(unused)), vtk_to_numpy(why))
    original = numpy_to_vtkIdTypeArray(numbers_of(numpy.flatnonzero(used)), deep=True)
    original.SetName(ORIGINAL_IDS)
    if frees:
        surface.Initialize()
    if not used.all():
        whole.SetVerts(None)
        whole.SetLines(None)
        keep_flagged(whole, used)
    whole.GetPointData().AddArray(original)
    return whole


def places_of(ranks, wanted, ids):
    """The places of points among those of all ranks by their ids; ids: those of this rank. Of one rank,
    ids are places."""
    if ranks is None:
        return numpy.asarray(wanted)
    ids = numpy.sort(ids, kind="stable")
    return numpy.sum(collected(ranks, numpy.searchsorted(ids, wanted)), axis=0)


def gather_points(ranks, points):
    """The points of all ranks on the rank with most of them, in the order of their ids, or rank after
    rank; the others have none. A filter that is given no triangle does it, by the rules of all filters."""
    gatherer, given = vtkTrimOutwardTriangles(), points.NewInstance()
    given.ShallowCopy(points)
    are_numbered = points.GetPointData().GetGlobalIds() or not points.GetNumberOfPoints()
    if total(ranks, not are_numbered):  # else points at one place would count once
        count = points.GetNumberOfPoints()
        ids = numpy_to_vtkIdTypeArray(before(ranks, count) + numpy.arange(count), deep=True)
        ids.SetName(IDS)
        given.GetPointData().SetGlobalIds(ids)
    gatherer.SetInputData(given)
    with Messages(gatherer, gatherer.GetExecutive()) as messages:
        update(gatherer, ranks)

    def check():
        if messages.errors:  # of all ranks, on the first
            raise ElevationSurfaceError(messages.errors[0])

    agreed(ranks, check)
    gatherer.GetOutput().GetPointData().RemoveArray(IDS)
    return gatherer.GetOutput()


# ---- from the first rank and to it ------------------------------------------------------------


def can_be_scattered(points):
    """Whether ranks do with points what one does: these have no ids or ghosts, which ranks go by."""
    data = points.GetPointData()
    return data.GetGlobalIds() is None and not data.HasArray(GHOSTS)


def scatter(ranks, points):
    """The points that each rank has of those of the first: one slice after the other."""
    if ranks is None:
        return points
    own, count = ranks.GetLocalProcessId(), ranks.GetNumberOfProcesses()
    for rank in range(count):
        part = agreed(ranks, lambda: None if own else packed(slice_of(points, rank, count)))
        if rank == own == 0:
            mine = unpacked(part)
            mine.GetFieldData().ShallowCopy(points.GetFieldData())
        elif own == 0:
            ranks.Send(part, rank, TAG)
        elif rank == own:
            mine = vtkPolyData()
            ranks.Receive(mine, 0, TAG)
            unpacked(mine)
    return mine


def slice_of(points, rank, ranks):
    """The points of a rank of so many, with their data."""
    first, last = (points.GetNumberOfPoints() * i // ranks for i in (rank, rank + 1))
    some = some_points(points, numpy.arange(first, last))
    set_places(some, coordinates_of(points)[first:last])
    return some


def set_places(data, coordinates):
    """Gives a data set points of the type of these."""
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(coordinates), deep=True))
    data.SetPoints(points)


def gather_surface(ranks, result):
    """Brings the parts of a Reconstruction to the first rank, as one rank makes it; others have none."""
    if ranks is None:
        return
    for name in ("boundary", "holes"):
        lines = getattr(result, name)
        if lines is not None:
            setattr(result, name, joined(shared(ranks, lambda: lines)))
    own, part = ranks.GetLocalProcessId(), result.complete
    having = together(ranks, lambda: [own] if part.GetNumberOfPoints() else [])
    result.surface = vtkPolyData()
    if own:
        if own in having:
            ranks.Send(packed(part), 0, TAG)
        return
    parts = []
    for rank in having:
        parts.append(vtkPolyData())
        if rank:
            ranks.Receive(parts[-1], rank, TAG)
            unpacked(parts[-1])
        else:
            parts[-1].ShallowCopy(part)
    ids = parts[0].GetPointData().GetGlobalIds()  # none where a filter has made the whole on one rank
    result.surface = joined_by_ids(ranks, parts)
    for name in (ids.GetName() if ids else "", GHOSTS):
        result.surface.GetPointData().RemoveArray(name)
    for name in RANK_FIELDS:
        result.surface.GetFieldData().RemoveArray(name)
    set_counts(result.surface, (result.delaunay, result.trim, result.fill))
    if result.removes_unused:
        used = used_points(None, result.surface)
        result.surface = without_unused(None, result.surface, used, result.number_of_points - 1)


def joined_by_ids(ranks, parts):
    """Parts of a surface as one, with the points in the order of their ids."""
    append, unused = vtkAppendPolyData(), [numpy.zeros((2, 0), dtype="i8")]
    ids = numpy.concatenate([ids_of(ranks, part) for part in parts])
    for part in parts:
        rows, why = (part.GetFieldData().GetArray(f"UnusedPoint{what}") for what in ("Ids", "Reasons"))
        if rows:  # empty ones are lost on the way
            unused.append([ids_of(ranks, part)[vtk_to_numpy(rows)], vtk_to_numpy(why)])
        part.GetPointData().SetActiveAttribute(-1, vtkDataSetAttributes.GLOBALIDS)
        append.AddInputData(part)
    append.Update()
    every = append.GetOutput()
    rows = numpy.flatnonzero(own_points(every))
    rows = rows[numpy.argsort(ids[rows], kind="stable")]
    surface = some_points(every, rows)
    set_places(surface, coordinates_of(every)[rows])
    surface.SetPolys(cells_of(numpy.searchsorted(ids[rows], ids[triangles_of(every)])))
    surface.GetCellData().ShallowCopy(every.GetCellData())
    surface.GetFieldData().ShallowCopy(parts[0].GetFieldData())
    unused, why = numpy.concatenate(unused, axis=1)
    order = numpy.argsort(unused, kind="stable")
    set_unused(surface, numpy.searchsorted(ids[rows], unused[order]), why[order])
    return surface


def set_unused(surface, unused, reasons):
    """Sets the field data of vtkGridDelaunay2D on unused points."""
    for name, values, array in (
        ("UnusedPointIds", unused, vtkIdTypeArray()),
        ("UnusedPointReasons", reasons, vtkUnsignedCharArray()),
    ):
        array.SetName(name)
        array.SetNumberOfValues(len(values))
        vtk_to_numpy(array)[:] = values
        surface.GetFieldData().AddArray(array)


def with_hidden(points, hidden):
    """Points of which more are hidden, (n,) of bool, than are before."""
    marked = points.NewInstance()
    marked.ShallowCopy(points)
    set_marks(marked, numpy.where(hidden, vtkDataSetAttributes.HIDDENPOINT, 0) | marks_of(points))
    return marked


def show_hidden(surface, hidden, reasons, points):
    """Makes a triangulation of with_hidden() points one of all points, of which these are no vertices.

    reasons  (n,) numbers of why points are no vertices where none is hidden
    points   before some were hidden
    """
    marks, count = marks_of(surface), len(hidden)
    marks[:count][hidden] = marks_of(points)[hidden]
    surface.GetPointData().RemoveArray(GHOSTS)
    if points.GetPointData().HasArray(GHOSTS):
        set_marks(surface, marks)
    unused, why = (
        vtk_to_numpy(surface.GetFieldData().GetArray(f"UnusedPoint{what}")) for what in ("Ids", "Reasons")
    )
    stays = (unused >= count) | ~hidden[numpy.minimum(unused, count - 1)]
    more = numpy.flatnonzero(hidden & (reasons != 0))
    unused, why = numpy.append(unused[stays], more), numpy.append(why[stays], reasons[more])
    order = numpy.argsort(unused)
    set_unused(surface, unused[order], why[order])


def marks_of(data):
    """(n,) marks of vtkDataSetAttributes for points, which may be changed."""
    array = data.GetPointData().GetArray(GHOSTS)
    return vtk_to_numpy(array).copy() if array else numpy.zeros(data.GetNumberOfPoints(), "u1")


def set_marks(data, marks):
    add_array(data, GHOSTS, marks.astype("u1"))


def set_counts(surface, filters):
    """Sets the field data that are counts of a filter: those of a rank are of its part alone."""
    fields = surface.GetFieldData()
    for i in range(fields.GetNumberOfArrays()):
        name = fields.GetArrayName(i)
        for algorithm in filters:
            if name.startswith("NumberOf") and hasattr(algorithm, f"Get{name}"):
                fields.GetArray(i).SetTuple1(0, getattr(algorithm, f"Get{name}")())
