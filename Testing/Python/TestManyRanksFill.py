# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A surface that is spread over ranks is filled as on one rank, to the last bit.

Run by mpirun, as TestManyRanks.py: each surface is also filled by rank 0 alone, and compared with what
all ranks have made: points and arrays, triangles, holes and reports, messages.
"""

import numpy
from on_ranks import (
    COUNT, RANK, check, check_equal, check_refused, check_stops, end, fewer, gather, options_of, owners_in_places,
    updated)
from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray, vtk_to_numpy

import outcomes
from meshes import DUPLICATE, GHOSTS, array_of, cloud, ghosts_of, mesh, points_of, triangles_of
from vtkelevationsurface import vtkFillElevationHoles, vtkGridDelaunay2D


def surface(coordinates, triangles, ids=None, arrays=(), holes=None):
    """A data set of triangles; each has a number, and the id of the hole that it has filled, if given."""
    heights = coordinates[triangles[:, 0], 2].astype(numpy.float64)
    data = mesh(coordinates, triangles, ids, arrays, [("first height", heights)])
    if holes is not None:
        array = numpy_to_vtkIdTypeArray(numpy.ascontiguousarray(holes), deep=True)
        array.SetName("HoleId")
        data.GetCellData().AddArray(array)
    return data


def rank_part(rank, coordinates, triangles, owners, ids, arrays, are_marked, holes=None):
    """The triangles that a rank has, with their points; the lowest rank with a point owns it."""
    mine = triangles[owners == rank]
    used = numpy.unique(mine)
    place = numpy.full(len(coordinates), -1)
    place[used] = numpy.arange(len(used))
    first = numpy.full(len(coordinates), COUNT)
    for other in range(COUNT - 1, -1, -1):
        first[numpy.unique(triangles[owners == other])] = other
    arrays = [(name, values[used]) for name, values in arrays]
    arrays += [(GHOSTS, (first[used] != rank).astype("u1"))] if are_marked else []
    return surface(coordinates[used], place[mine], None if ids is None else ids[used], arrays,
                   None if holes is None else holes[owners == rank])


def fill(data, alone, **properties):
    return updated(vtkFillElevationHoles(), data, alone, **properties)


def compare(claim, coordinates, triangles, owners, ids=None, arrays=(), are_marked=False, holes=None,
            **properties):
    """Fills a surface on all ranks, and on rank 0 alone; triangles are in the order of their ranks there."""
    data = rank_part(RANK, coordinates, triangles, owners, ids, arrays, are_marked, holes)
    filler, messages = fill(data, False, **properties)
    check(filler.GetOutput().GetNumberOfPolys() >= numpy.count_nonzero(owners == RANK),
          claim + ": it keeps its triangles")
    parts = gather(outcomes.made_by([filler], messages))
    if RANK == 0:
        used = numpy.unique(triangles)
        place = numpy.full(len(coordinates), -1)
        place[used] = numpy.arange(len(used))
        order = numpy.argsort(owners, kind="stable")
        whole, expected = fill(surface(
            coordinates[used], place[triangles[order]], None if ids is None else ids[used],
            [(n, a[used]) for n, a in arrays], None if holes is None else holes[order]), True, **properties)
        whole = outcomes.made_by([whole], expected)
        check(not any(part["messages"] for part in parts[1:]), claim + ": other ranks are silent")
        count = sum(bool(part["ports"][1][0]["report"]) for part in parts)
        check(count == bool(whole["ports"][1][0]["report"]), claim + ": the report is on one rank")
        why = outcomes.difference(outcomes.joined(parts, False, True), outcomes.joined([whole], False, True))
        check(not why, "%s: %s" % (claim, why))


def triangulated(coordinates):
    """The Delaunay triangles."""
    return triangles_of(updated(vtkGridDelaunay2D(), cloud(coordinates), True)[0].GetOutput())


def with_holes(random, coordinates, triangles, count):
    """Takes triangles away around some places, of any size; holes may touch, and have islands."""
    low, high = coordinates[:, :2].min(axis=0), coordinates[:, :2].max(axis=0)
    middles = coordinates[triangles, :2].mean(axis=1)
    kept = numpy.ones(len(triangles), bool)
    for _ in range(count):
        radius = random.choice([0.01, 0.03, 0.08, 0.2]) * (high - low).max()
        centre = random.uniform(low + 0.1 * (high - low), high - 0.1 * (high - low))
        distance = numpy.hypot(*(middles - centre).T)
        island = random.choice([0.0, 0.0, 0.4]) * radius
        kept &= (distance >= radius) | (distance < island)
    return triangles[kept]


def clouds(random, count):
    """A cloud: anywhere, on a lattice, or denser in places."""
    kind = random.integers(4)
    if kind == 0:
        places = random.random((count, 2))
    elif kind == 1:
        side = int(count ** 0.5)
        i, j = numpy.meshgrid(numpy.arange(side), numpy.arange(side))
        places = numpy.column_stack((612000 + 20.0 * i.ravel() - 9.0 * j.ravel(),
                                     6073000 + 15.0 * i.ravel() + 12.0 * j.ravel()))
    elif kind == 2:
        places = random.random((count, 2)) ** 2
    else:
        side = int(count ** 0.5)
        i, j = numpy.meshgrid(numpy.arange(side), numpy.arange(side))
        places = numpy.column_stack((25.0 * i.ravel(), 12.5 * j.ravel()))
    x, y = ((places - places.min(axis=0)) / numpy.ptp(places, axis=0)).T
    heights = numpy.sin(5 * x) * numpy.cos(4 * y) + 0.1 * x + 0.01 * random.random(len(x))
    return numpy.column_stack((places, 10.0 * heights))


def owners_of(random, coordinates, triangles):
    """Which rank has which triangle."""
    return owners_in_places(random, coordinates[triangles, :2].mean(axis=1))


def compare_random(random, claim):
    """Compares one surface, drawn with what else can be drawn."""
    coordinates = clouds(random, int(random.choice([60, 400, 1000])))
    if random.random() < 0.3:
        coordinates = coordinates.astype(numpy.float32)
    triangles = with_holes(random, coordinates, triangulated(coordinates), random.integers(6))
    if not len(triangles):
        return
    count = len(coordinates)
    arrays = ()
    if random.random() < 0.4:
        arrays = (("whole", random.integers(-9, 9, count).astype(numpy.int16)), ("vector", random.random((count, 3))),
                  ("text", numpy.array(["t" + str(i) for i in range(count)], dtype="U")))
    size = numpy.ptp(coordinates[:, 0])
    properties = {}
    kind = random.integers(6)
    if kind == 0:
        properties["Interpolation"] = int(random.integers(5))
    elif kind == 1:
        properties["MaximumHoleSize"] = 0.1 * size
    elif kind == 2:
        properties["MaximumHoleEdges"] = 20
    elif kind == 3:
        properties["Spacing"] = 0.03 * size
    elif kind == 4:
        properties["MaximumNumberOfInsertedPoints"] = 150
    if random.random() < 0.2:
        properties["InterpolatePointData"] = False
    # The whole is joined in the order of ids.
    ids = numpy.sort(random.permutation(3 * count)[:count]) if random.random() < 0.5 else None
    compare(claim, coordinates, triangles, owners_of(random, coordinates, triangles), ids, arrays,
            bool(random.random() < 0.5), **properties)


def check_filled_before(random, claim):
    """What has been filled before keeps its marks, and the numbers of holes go on."""
    filled = numpy.zeros(0)
    while not (filled >= 0).any():
        coordinates = clouds(random, 1000)
        triangles = with_holes(random, coordinates, triangulated(coordinates), 9)
        before = fill(surface(coordinates, triangles), True)[0].GetOutput()
        filled = vtk_to_numpy(before.GetCellData().GetArray("HoleId"))
    arrays = [(name, vtk_to_numpy(before.GetPointData().GetArray(name)))
              for name in ("FilledPoint", "FilledError", "FilledLow", "FilledHigh")]
    coordinates, triangles = vtk_to_numpy(before.GetPoints().GetData()), triangles_of(before)
    holes = {tuple(corners): hole for corners, hole in zip(triangles.tolist(), filled.tolist())}
    triangles = with_holes(random, coordinates, triangles, 4)
    holes = numpy.array([holes[tuple(corners)] for corners in triangles.tolist()])
    compare(claim, coordinates, triangles, owners_of(random, coordinates, triangles),
            numpy.arange(len(coordinates)), arrays, True, holes)


def check_errors(random):
    """What is not an elevation surface is refused in the words of one rank."""
    coordinates = numpy.column_stack((random.random((300, 2)), numpy.zeros(300)))
    triangles = triangulated(coordinates)
    twice = numpy.vstack((triangles, triangles[:1]))
    overlapping = numpy.vstack((coordinates, [[0.4, 0.4, 5.0], [0.6, 0.4, 5.0], [0.5, 0.6, 5.0]]))
    for claim, points, cells in (("a triangle twice", coordinates, twice),
                                 ("over another", overlapping, numpy.vstack((triangles, [[300, 301, 302]])))):
        owners = numpy.sort(random.integers(COUNT, size=len(cells)))
        data = rank_part(RANK, points, cells, owners, numpy.arange(len(points)), (), False)
        check_refused(vtkFillElevationHoles(), data, "", claim)


def check_bytes_as_ids():
    """Where new points need larger numbers than the type of global ids has, no part has global ids any more."""
    i, j = (steps.ravel() for steps in numpy.meshgrid(numpy.arange(16), numpy.arange(16), indexing="ij"))
    lattice = numpy.column_stack((i, j, 0.1 * i)).astype(float)
    coordinates = lattice[(numpy.abs(i - 4.5) > 3) | (numpy.abs(j - 7.5) > 3)]  # 36 of 256 are missing
    triangles = triangulated(coordinates)
    middles = coordinates[triangles, :2].mean(axis=1)
    triangles = triangles[(numpy.abs(middles - (4.5, 7.5)) > 3.5).any(axis=1)]
    owners = (coordinates[triangles, 0].mean(axis=1) * COUNT / 15).astype(int)
    data = rank_part(RANK, coordinates, triangles, owners, None, (), False)
    place = {tuple(xyz): i for i, xyz in enumerate(coordinates.tolist())}
    data.GetPointData().SetGlobalIds(
        array_of(numpy.array([place[tuple(xyz)] for xyz in points_of(data).tolist()], "u1"), "id"))
    points = fill(data, False)[0].GetOutput().GetPointData()
    new = vtk_to_numpy(points.GetArray("id"))[vtk_to_numpy(points.GetArray("FilledPoint")) == 1]
    check(sum(gather(len(new))) == 36, "the hole of a lattice gets its nodes back")
    check(points.GetGlobalIds() is None and (new == 255).all(), "bytes that are no global ids any more")


def check_unused():
    """Of points at one place, without ids, one stays for the triangle of another rank."""
    corners = numpy.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    other = corners + 5.0
    if RANK == 0:
        data = surface(numpy.vstack((corners, other[:1], other[:1])), numpy.array([[0, 1, 2]]),
                       arrays=[(GHOSTS, numpy.zeros(5, "u1"))])
    else:
        marks = numpy.array([DUPLICATE, 0, 0] if RANK == 1 else [DUPLICATE] * 3, "u1")
        data = surface(other, numpy.arange(3)[None, :][:RANK == 1], arrays=[(GHOSTS, marks)])
    output = fill(data, False, RemoveUnusedPoints=True)[0].GetOutput()
    own = numpy.count_nonzero(~ghosts_of(output))
    check_equal(sum(gather(own)), 6 if COUNT > 1 else 3, "points that triangles have, each on one rank")


def check_aborts(random, count):
    """An abort on one rank, at any moment, ends all of them."""
    coordinates = clouds(random, 2500)
    triangles = with_holes(random, coordinates, triangulated(coordinates), 12)
    owners = numpy.sort(random.integers(COUNT, size=len(triangles)))

    def make(_):
        filler = vtkFillElevationHoles()
        filler.SetInputData(rank_part(RANK, coordinates, triangles, owners, None, (), False))
        return filler

    check_stops(random, count, 0.8, make)


def main(options):
    random = numpy.random.default_rng(options.seed)
    check_errors(random)
    check_bytes_as_ids()
    check_unused()
    surfaces = options.clouds or fewer(8)
    for i in range(surfaces):
        compare_random(random, "surface %d of seed %d" % (i, options.seed))
    check_filled_before(random, "filled before, of seed %d" % options.seed)
    check_aborts(random, options.aborts or fewer(3))
    return "%d surfaces that are filled" % surfaces


if __name__ == "__main__":
    end(main(options_of()))
