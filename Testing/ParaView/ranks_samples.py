# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""On several ranks Elevation Grid and Elevation Profile of a surface that is spread over them have the
elevations of one rank, and what is wrong on any rank is one error, of the first. A part of TestRanks.py.
"""
import numpy
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from plugin_testing import alone, array, data_source, lines, points, triangles, update
import meshes
from on_ranks import COUNT, LAST, RANK, check, check_equal, gather

CLOUD = numpy.random.default_rng(7).uniform(0.0, 30.0, (900, 3))
CLOUD = CLOUD[numpy.hypot(CLOUD[:, 0] - 12, CLOUD[:, 1] - 14) > 4]
EMPTY = vtkPolyData()
WHOLE = alone(simple.ReconstructElevationSurface(Input=data_source(meshes.cloud(CLOUD))))[0]
check(WHOLE.GetPointData().HasArray("FilledError"), "the surface has a hole that is filled")
NAMES = ("Elevation", "FilledError", "FilledLow", "FilledHigh")


def piece(of_rank):
    """The surface with some of its triangles, where of_rank is true of their middles' x and numbers."""
    part = vtkPolyData()
    part.ShallowCopy(WHOLE)
    corners = triangles(WHOLE)
    middles = points(WHOLE)[corners].mean(axis=1)
    part.SetPolys(meshes.cells_of(corners[of_rank(middles[:, 0], numpy.arange(len(corners)))]))
    part.GetCellData().Initialize()
    return part


SPREADS = {
    "in strips": piece(lambda x, i: numpy.minimum((x * COUNT / 30).astype(int), LAST) == RANK),
    "in no order": piece(lambda x, i: (7 * i + i // 5) % COUNT == RANK),
    "on the last rank": WHOLE if RANK == LAST else EMPTY,
    "on each rank": WHOLE,
}


def check_values(found, expected, claim):
    for name in NAMES:
        mine, theirs = array(found, name), array(expected, name)
        check_equal(numpy.isnan(mine).tolist(), numpy.isnan(theirs).tolist(), "%s: where %s is" % (claim, name))
        known = ~numpy.isnan(theirs)
        check(numpy.allclose(mine[known], theirs[known], rtol=0, atol=1e-9), "%s: %s" % (claim, name))


def check_refused(source, part, claim):
    """One error, on rank 0, and nothing anywhere."""
    messages, (output,) = update(source)
    check(len(messages) == (RANK == 0) and (RANK > 0 or messages[0][0] == "ErrorEvent" and part in messages[0][1]),
          "%s, one error with %r: %s" % (claim, part, messages))
    check_equal(output.GetNumberOfPoints(), 0, "points after an error, " + claim)


# ---- the grid ------------------------------------------------------------------------------------

SIZE = (41, 31)
expected = alone(simple.ElevationGrid(Input=data_source(WHOLE), Dimensions=SIZE))[0]
check_equal(expected.GetDimensions(), (*SIZE, 1), "the size of the grid of one rank")
check(numpy.isnan(array(expected.GetPointData(), "Elevation")).any(), "some nodes are outside")
for spread, data in SPREADS.items():
    messages, (grid,) = update(simple.ElevationGrid(Input=data_source(data), Dimensions=SIZE))
    check_equal(messages, [], "messages, grid " + spread)
    parts = gather((grid.GetExtent(), grid.GetOrigin(), grid.GetSpacing()))
    check_equal({part[1:] for part in parts}, {(expected.GetOrigin(), expected.GetSpacing())}, "frames, grid " + spread)
    covered = numpy.zeros(SIZE, dtype=int)
    for (left, right, low, high, *_), *_ in parts:
        covered[left : right + 1, low : high + 1] += 1
    check((covered > 0).all(), "the parts of all ranks are the whole grid, " + spread)
    check(min((part[0][1] - part[0][0] + 1) * (part[0][3] - part[0][2] + 1) for part in parts) < covered.size,
          "a rank passes on its part, grid " + spread)
    here = expected.NewInstance()
    here.DeepCopy(expected)
    here.Crop(grid.GetExtent())
    check_values(grid.GetPointData(), here.GetPointData(), "grid " + spread)
    for kind in ("GetPointData", "GetCellData"):
        mine, theirs = (array(getattr(data, kind)(), "vtkGhostType") & 32 + 2 for data in (grid, here))
        check_equal((mine != 0).tolist(), (theirs != 0).tolist(), "%s hidden, grid %s" % (kind, spread))

# ---- the profile ---------------------------------------------------------------------------------

WAYS = numpy.array(((1.0, 1.0, 0.0), (12.0, 15.0, 0.0), (29.0, 8.0, 0.0)))
BACK = WAYS[::-1] + (0.0, 9.0, 0.0)


def way(*lists):
    corners = numpy.concatenate(lists) if lists else numpy.empty((0, 3))
    ends = numpy.cumsum([0] + [len(part) for part in lists])
    return meshes.lines(corners, [range(*each) for each in zip(ends[:-1], ends[1:])])


def profile(surface, line=None):
    ends = {"Point1": [2, 3, 0], "Point2": [28, 25, 0]}
    given = {"Line": data_source(line)} if line is not None else ends
    return simple.ElevationProfile(Input=data_source(surface), Resolution=50, **given)


FIRST_OF_TWO = [WAYS] if RANK == 0 else [BACK] if RANK == LAST else []
for claim, whole, line in (
        ("between two points", None, None),
        ("along a line on the last rank", way(WAYS), way(WAYS) if RANK == LAST else EMPTY),
        ("along a line on each rank", way(WAYS), way(WAYS)),
        ("along lines on two ranks", way(WAYS, BACK), way(*FIRST_OF_TWO))):
    expected = alone(profile(WHOLE, whole))[0]
    check(expected.GetNumberOfPoints() > 50, "a profile of one rank, " + claim)
    for spread, data in SPREADS.items():
        messages, (section,) = update(profile(data, line))
        where = "profile %s, %s" % (claim, spread)
        check_equal(messages, [], "messages, " + where)
        if RANK > 0:
            check_equal(section.GetNumberOfPoints(), 0, "points that the first rank has, " + where)
            continue
        check_equal(section.GetNumberOfPoints(), expected.GetNumberOfPoints(), "points, " + where)
        check_values(section.GetPointData(), expected.GetPointData(), where)
        numpy.testing.assert_allclose(points(section), points(expected), rtol=0, atol=1e-9)
        check_equal([ids.tolist() for ids in lines(section)], [ids.tolist() for ids in lines(expected)], "lines, " + where)
        along = [array(data.GetPointData(), "arc_length") for data in (section, expected)]
        check(numpy.array_equal(*along), "distances, " + where)

# ---- what is wrong on one rank -------------------------------------------------------------------

wrong = vtkPolyData()
wrong.DeepCopy(SPREADS["in strips"])
if RANK == LAST:
    wrong.GetPolys().ReplaceCellAtId(3, 3, [0, 1, 100000])
lost = way(WAYS)
lost.GetPoints().SetPoint(1, numpy.nan, 1.0, 0.0)
filters = (lambda data: simple.ElevationGrid(Input=data_source(data)), profile)
for make in filters:
    name = make(EMPTY).SMProxy.GetXMLName()
    check_refused(make(wrong), "On rank %d: Cell 3 names point 100000" % LAST, name + " of a wrong cell")
    check_refused(make(EMPTY), "no triangles", name + " of nothing on all ranks")
check_refused(profile(WHOLE, lost if RANK == LAST else EMPTY), "On rank %d: Point 1 of the line is not finite" % LAST,
              "a profile along a line that is not finite")
check_refused(profile(SPREADS["in strips"], EMPTY), "no length", "a profile along no line")
check_refused(simple.ElevationGrid(Input=data_source(WHOLE), Dimensions=[1, 9]), "Dimensions are 1 and 9", "few nodes")
# A stop on one rank stops all of them.
for make in filters:
    source = make(SPREADS["in strips"])
    if RANK == LAST:
        algorithm = source.SMProxy.GetClientSideObject()
        algorithm.AddObserver("ProgressEvent", lambda caller, _: caller.SetAbortExecute(1))
    messages, (output,) = update(source)
    check_equal(messages, [], "messages after a stop")
    check_equal(output.GetNumberOfPoints(), 0, "points after a stop")
