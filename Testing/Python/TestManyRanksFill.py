# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A surface that is spread over ranks is filled as on one rank, to the last bit.

Run by mpirun, as TestManyRanks.py: each surface is also filled by rank 0 alone, and compared with what
all ranks have made: points and arrays, triangles, holes and reports, messages. With --clouds more random
ones are compared than the suite has time for.
"""

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSetAttributes

from TestManyRanks import COUNT, RANK, WORLD, check, check_stops, cloud, end, options_of, updated, values_of
from vtkelevationsurface import vtkFillElevationHoles, vtkGridDelaunay2D


def surface(coordinates, triangles, ids=None, arrays=(), ghosts=None):
    """A data set of triangles; each has a number, and points that belong to others may be marked."""
    data = cloud(coordinates, ids, arrays)
    cells = vtkCellArray()
    for corners in triangles:
        cells.InsertNextCell(3)
        for corner in corners:
            cells.InsertCellPoint(int(corner))
    data.SetPolys(cells)
    heights = numpy_to_vtk(coordinates[triangles[:, 0], 2].astype(numpy.float64), deep=True)
    heights.SetName("first height")
    data.GetCellData().AddArray(heights)
    if ghosts is not None:
        marks = vtkUnsignedCharArray()
        marks.SetName(vtkDataSetAttributes.GhostArrayName())
        for is_ghost in ghosts:
            marks.InsertNextValue(vtkDataSetAttributes.DUPLICATEPOINT if is_ghost else 0)
        data.GetPointData().AddArray(marks)
    return data


def part_of_rank(rank, coordinates, triangles, owners, ids, arrays, are_marked):
    """The triangles that a rank has, with their points; the lowest rank with a point owns it."""
    mine = triangles[owners == rank]
    used = numpy.unique(mine)
    place = numpy.full(len(coordinates), -1)
    place[used] = numpy.arange(len(used))
    first = numpy.full(len(coordinates), COUNT)
    for other in range(COUNT - 1, -1, -1):
        first[numpy.unique(triangles[owners == other])] = other
    return surface(coordinates[used], place[mine], None if ids is None else ids[used],
                   [(name, values[used]) for name, values in arrays],
                   first[used] != rank if are_marked else None)


def fill(data, alone, **properties):
    return updated(vtkFillElevationHoles(), data, alone, **properties)


def part_of(filler):
    """What a rank has made, by coordinates."""
    output, report = filler.GetOutput(0), filler.GetOutput(1)
    data, count = output.GetPointData(), output.GetNumberOfPoints()
    part = {"points": values_of(output.GetPoints().GetData()) if count else [], "triangles": [], "ids": None}
    marks = data.GetArray("vtkGhostType")
    part["ghosts"] = vtk_to_numpy(marks).tolist() if marks and count else [0] * count
    ids = data.GetGlobalIds()
    part["ids"] = vtk_to_numpy(ids).tolist() if ids and count else None
    part["arrays"] = {data.GetArrayName(i): values_of(data.GetAbstractArray(i)) for i in range(data.GetNumberOfArrays())
                      if data.GetArrayName(i) not in ("vtkGhostType", "numbers")}
    part["type"] = output.GetPoints().GetDataType() if count else None
    if output.GetNumberOfPolys():
        corners = vtk_to_numpy(output.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        cells = output.GetCellData()
        values = list(zip(*(values_of(cells.GetAbstractArray(i)) for i in sorted(
            range(cells.GetNumberOfArrays()), key=cells.GetArrayName))))
        xyz = vtk_to_numpy(output.GetPoints().GetData())
        lowest = [min(range(3), key=lambda k: tuple(xyz[c[k]])) for c in corners]
        part["triangles"] = [
            (tuple(tuple(xyz[c[(low + k) % 3]].tolist()) for k in range(3)), value)
            for c, low, value in zip(corners, lowest, values)]
    cells = report.GetCellData()
    part["report"] = {cells.GetArrayName(i): values_of(cells.GetAbstractArray(i))
                      for i in range(cells.GetNumberOfArrays())}
    points = report.GetPointData()
    part["rims"] = (values_of(report.GetPoints().GetData()) if report.GetNumberOfPoints() else [],
                    {points.GetArrayName(i): values_of(points.GetAbstractArray(i))
                     for i in range(points.GetNumberOfArrays())
                     if points.GetArrayName(i) not in ("vtkGhostType", "numbers")},
                    vtk_to_numpy(report.GetLines().GetConnectivityArray()).tolist() if report.GetNumberOfLines() else [])
    part["counts"] = (filler.GetNumberOfHoles(), filler.GetNumberOfFilledHoles())
    return part


def check_union(parts, whole, claim):
    """Compares what all ranks have made with what one has."""
    def row(part, i):
        return (part["points"][i],) + tuple(part["arrays"][name][i] for name in sorted(part["arrays"]))

    expected = sorted(row(whole, i) for i in range(len(whole["ghosts"])))
    owned, copies, count = {}, {}, 0
    for part in parts:
        for i, is_ghost in enumerate(part["ghosts"]):
            one = row(part, i)
            key = part["ids"][i] if part["ids"] else one[0]
            copies.setdefault(key, set()).add(one)
            if not is_ghost:
                owned[key] = one
                count += 1
    check(sorted(owned.values()) == expected, claim + ": points and their values are those of one rank")
    check(count == len(expected), "%s: %d points of %d have an owner" % (claim, count, len(expected)))
    check(all(len(each) == 1 for each in copies.values()), claim + ": copies of points are alike")
    triangles = [triangle for part in parts for triangle in part["triangles"]]
    check(sorted(triangles) == sorted(whole["triangles"]),
          "%s: %d triangles are the %d of one rank" % (claim, len(triangles), len(whole["triangles"])))
    told = [part for part in parts if part["report"].get("HoleId")]
    check(len(told) == (1 if whole["report"].get("HoleId") else 0), claim + ": the report is on one rank")
    for part in told:
        check(part["report"] == whole["report"], "%s: report\n%s, not\n%s" % (claim, part["report"], whole["report"]))
        check(part["rims"] == whole["rims"], claim + ": rims")
    for part in parts:
        check(part["counts"] == whole["counts"], "%s: counts %s, not %s" % (claim, part["counts"], whole["counts"]))
        check(part["type"] in (None, whole["type"]), claim + ": the type of points")


def check_ids(parts, whole, claim):
    """Global ids of new points follow the largest, in the order of one rank."""
    if not all(part["ids"] for part in parts if part["points"]) or not whole["ids"]:
        return
    made = {}
    for part in parts:
        for i, number in enumerate(part["ids"] or []):
            made[number] = part["points"][i]
    check(made == dict(zip(whole["ids"], whole["points"])), claim + ": global ids are those of one rank")


def compare(claim, coordinates, triangles, owners, ids=None, arrays=(), are_marked=False, **properties):
    """Fills a surface on all ranks, and on rank 0 alone; triangles are in the order of their ranks there."""
    data = part_of_rank(RANK, coordinates, triangles, owners, ids, arrays, are_marked)
    filler, messages = fill(data, False, **properties)
    check(RANK == 0 or not messages, "%s: rank %d is silent: %s" % (claim, RANK, messages))
    check(filler.GetOutput().GetNumberOfPolys() >= numpy.count_nonzero(owners == RANK),
          "%s: rank %d keeps its triangles" % (claim, RANK))
    parts = WORLD.gather(part_of(filler))
    if RANK == 0:
        used = numpy.unique(triangles)
        place = numpy.full(len(coordinates), -1)
        place[used] = numpy.arange(len(used))
        whole, expected = fill(surface(
            coordinates[used], place[triangles[numpy.argsort(owners, kind="stable")]],
            None if ids is None else ids[used], [(n, a[used]) for n, a in arrays]), True, **properties)
        check(messages == expected, "%s: messages %s, not %s" % (claim, messages, expected))
        check_union(parts, part_of(whole), claim)
        check_ids(parts, part_of(whole), claim)


def triangles_of(coordinates, limit=0.0):
    """The Delaunay triangles."""
    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputData(cloud(coordinates))
    delaunay.SetMaximumEdgeLength(limit)
    delaunay.Update()
    return vtk_to_numpy(delaunay.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(int)


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
    """Which rank has which triangle: strips, a chessboard, drawn, one rank for most."""
    middles = coordinates[triangles, :2].mean(axis=1)
    x, y = ((middles - middles.min(axis=0)) / numpy.maximum(numpy.ptp(middles, axis=0), 1e-9)).T
    kind = random.integers(4)
    if kind == 0:
        return numpy.minimum((x * COUNT).astype(int), COUNT - 1)
    if kind == 1:
        return ((x * 4).astype(int) + 3 * (y * 4).astype(int)) % COUNT
    if kind == 2:
        return random.integers(COUNT, size=len(triangles))
    return numpy.where(random.random(len(triangles)) < 0.02, random.integers(COUNT, size=len(triangles)),
                       random.integers(COUNT))


def compare_random(random, claim):
    """Compares one surface, drawn with what else can be drawn."""
    coordinates = clouds(random, int(random.choice([60, 400, 1000])))
    if random.random() < 0.3:
        coordinates = coordinates.astype(numpy.float32)
    triangles = with_holes(random, coordinates, triangles_of(coordinates), random.integers(6))
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


def check_errors(random):
    """What is no elevation surface is refused in the words of one rank."""
    coordinates = numpy.column_stack((random.random((300, 2)), numpy.zeros(300)))
    triangles = triangles_of(coordinates)
    twice = numpy.vstack((triangles, triangles[:1]))
    overlapping = numpy.vstack((coordinates, [[0.4, 0.4, 5.0], [0.6, 0.4, 5.0], [0.5, 0.6, 5.0]]))
    for claim, points, cells in (("a triangle twice", coordinates, twice),
                                 ("over another", overlapping, numpy.vstack((triangles, [[300, 301, 302]])))):
        owners = numpy.sort(random.integers(COUNT, size=len(cells)))
        data = part_of_rank(RANK, points, cells, owners, numpy.arange(len(points)), (), False)
        filler, messages = fill(data, False)
        check(len(messages) == (RANK == 0), "rank %d, %s: one error, not %s" % (RANK, claim, messages))
        check(filler.GetOutput().GetNumberOfPoints() == 0, "rank %d, %s: no point" % (RANK, claim))


def check_aborts(random, count):
    """An abort on one rank, at any moment, ends all of them."""
    coordinates = clouds(random, 2500)
    triangles = with_holes(random, coordinates, triangles_of(coordinates), 12)
    owners = numpy.sort(random.integers(COUNT, size=len(triangles)))

    def make(_):
        filler = vtkFillElevationHoles()
        filler.SetInputData(part_of_rank(RANK, coordinates, triangles, owners, None, (), False))
        return filler

    return check_stops(random, count, 0.8, make)


def main():
    options = options_of(8, 3)
    random = numpy.random.default_rng(options.seed)
    check_errors(random)
    for i in range(options.clouds):
        compare_random(random, "surface %d of seed %d" % (i, options.seed))
    most = check_aborts(random, options.aborts)
    end("%d surfaces, %d aborts (%d reports after one at most)" % (options.clouds, options.aborts, most))


if __name__ == "__main__":
    main()
