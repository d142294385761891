# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points and constraints that are spread over ranks give the triangles of one rank.

Run by mpirun, as TestManyRanks.py.
"""
import numpy
from on_ranks import COUNT, RANK, check, check_refused, end, fewer, gather, options_of, owners_in_places
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

import meshes
from meshes import array_of, cloud
from TestManyRanks import (
    CLOUDS, POLICIES, check_aborts, check_part, check_union, made_by, own_and_order, random_arrays, triangulate)
from vtkelevationsurface import vtkGridDelaunay2D


def lines_of(coordinates, cells, arrays=()):
    """A data set of lines; of cells (ids of points, whether it is a polygon)."""
    lines, polygons = ([ids for ids, is_one in cells if is_one == kind] for kind in (False, True))
    return meshes.lines(coordinates, lines, polygons, arrays)


def kept(coordinates, cells, arrays, chosen):
    """The chosen cells, with the points that these have."""
    cells = [cell for cell, is_chosen in zip(cells, chosen) if is_chosen]
    used = sorted({number for ids, _ in cells for number in ids})
    place = {number: i for i, number in enumerate(used)}
    return (coordinates[used], [([place[number] for number in ids], closed) for ids, closed in cells],
            [(name, values[used]) for name, values in arrays])


def joined(parts):
    """The lines of all ranks, one after another; None if there are none."""
    first, cells = 0, []
    parts = [part for part in parts if len(part[0])]
    for coordinates, own, _ in parts:
        cells += [([first + number for number in ids], closed) for ids, closed in own]
        first += len(coordinates)
    # Lines of all ranks come before the polygons of all.
    cells.sort(key=lambda cell: cell[1])
    return (numpy.vstack([part[0] for part in parts]), cells,
            [(name, numpy.concatenate([dict(part[2])[name] for part in parts]))
             for name, _ in parts[0][2]])


def compare(claim, coordinates, owners, lines, holders, ids=None, arrays=(), **properties):
    """Triangulates a cloud with lines on all ranks, and on rank 0 alone.

    A rank has the lines whose holder it is; holder -1: all ranks have all lines.
    """
    mine, order = own_and_order(owners, ids)
    line_parts = [kept(*lines, [holder in (-1, rank) for holder in holders]) for rank in range(COUNT)]
    own = line_parts[RANK]
    part, messages = triangulate(
        cloud(coordinates[mine], None if ids is None else ids[mine], [(n, a[mine]) for n, a in arrays]), False,
        SourceData=lines_of(*own) if len(own[0]) else vtkPolyData(), **properties)
    check_part(part, claim)
    parts = gather(made_by(part, messages))
    if RANK == 0:
        whole, expected = triangulate(
            cloud(coordinates[order], None, [(n, a[order]) for n, a in arrays]), True,
            SourceData=lines_of(*(joined(line_parts) if holders[0] >= 0 else line_parts[0])), **properties)
        added = whole.GetOutput().GetNumberOfPoints() - len(order)
        numbers = numpy.arange(len(order)) if ids is None else ids[order]
        first = numbers.max(initial=-1) + 1
        numbers = numpy.concatenate((numbers, numpy.arange(first, first + added)))
        check_union(parts, made_by(whole, expected, numbers), claim)


def draw_lines(random, coordinates):
    """Lines of one kind, or of several: across, in a star, through data points, out of the points, small."""
    finite = coordinates[numpy.isfinite(coordinates).all(axis=1)]
    low, high = finite[:, :2].min(axis=0), finite[:, :2].max(axis=0)
    size = high - low + 1e-3
    places, cells = [], []

    def add(places_of_line, is_polygon=False):
        cells.append((list(range(len(places), len(places) + len(places_of_line))), is_polygon))
        places.extend(numpy.asarray(place, float) for place in places_of_line)

    def anywhere(reach=0.0):
        return numpy.append(random.uniform(low - reach * size, high + reach * size), random.random())

    for _ in range(1 + random.integers(4)):
        kind = random.integers(6)
        if kind == 0:
            add([anywhere() for _ in range(2 + random.integers(4))])
        elif kind == 1:  # a star, whose lines share a point of the data set
            add([anywhere(), anywhere()])
            for _ in range(3):
                cells.append(([cells[-1][0][0], len(places)], False))
                places.append(anywhere())
        elif kind == 2:  # along data points
            add(finite[random.integers(len(finite), size=2 + random.integers(3))])
        elif kind == 3:
            add([anywhere(0.3) for _ in range(2)])
        elif kind == 4:
            add([anywhere() for _ in range(3)], True)
        else:
            at = anywhere()
            add([at, at + [0.01 * size[0], 0.013 * size[1], 1.0]])
    return numpy.array(places), cells


def compare_random(random, claim):
    """Compares one cloud, drawn with what else can be drawn."""
    count = int(random.choice([2, 3, COUNT + 1, 30, 300, 1500]))
    coordinates = CLOUDS[random.integers(len(CLOUDS))](random, count)
    coordinates = coordinates if len(coordinates) else random.random((count, 3))
    if random.random() < 0.3:
        again = coordinates[random.integers(len(coordinates), size=1 + len(coordinates) // 3)]
        again[:, 2] = random.integers(3, size=len(again))
        coordinates = numpy.vstack((coordinates, again))
    if random.random() < 0.3:
        coordinates = coordinates.astype(numpy.float32)
    places, cells = draw_lines(random, coordinates.astype(float))
    if random.random() < 0.2:
        coordinates[random.integers(len(coordinates)), random.integers(3)] = numpy.nan
    count = len(coordinates)
    arrays, line_arrays = (), ()
    if random.random() < 0.5:
        arrays = random_arrays(random, count)
        line_arrays = (("vector", random.random((len(places), 3)).astype(numpy.float32)),
                           ("whole", random.integers(-9, 9, len(places)).astype(numpy.int16)))
    kind = random.integers(3)  # the same on all ranks, all on one, or spread
    holders = (numpy.full(len(cells), -1) if kind == 0 else numpy.full(len(cells), random.integers(COUNT))
               if kind == 1 else random.integers(COUNT, size=len(cells)))
    compare(claim, coordinates, owners_in_places(random, coordinates), (places, cells, line_arrays), holders,
            random.permutation(3 * count)[:count] if random.random() < 0.3 and COUNT > 1 else None, arrays,
            DuplicatePolicy=int(random.integers(POLICIES)),
            MaximumEdgeLength=float(random.choice([0.0, 0.0, 0.05, 30.0])))


def check_kinds():
    """What is said of constraints, one claim at a time."""
    random = numpy.random.default_rng(22)
    coordinates = random.random((1000, 3))
    owners = random.integers(COUNT, size=1000)
    diagonals = (numpy.array([[0, 0, 0], [1, 1, 1], [0, 1, 2], [1, 0, 3], [0.5, -0.1, 0], [0.5, 1.2, 0.0]]),
                 [([0, 1], False), ([2, 3], False), ([4, 5], False)], ())
    for holders in ([-1, -1, -1], [0, 0, 0], [COUNT - 1, 0, COUNT // 2]):
        compare("lines that cross all cells, on ranks %s" % holders, coordinates, owners, diagonals, holders)
    i, j = numpy.meshgrid(numpy.arange(30.0), numpy.arange(30.0))
    nodes = numpy.stack((i.ravel(), j.ravel(), (i * j).ravel()), axis=1)
    along = (numpy.array([[0, 3, 0], [29, 3, 0], [2, 0, 0], [2, 29, 9], [0, 0, 0], [29.0, 29, 0], [1.5, 20, 0],
                          [20.5, 3.5, 0]]),
             [([0, 1], False), ([2, 3], False), ([4, 5], False), ([6, 7], False), ([1, 3, 6], True)], ())
    compare("lines through nodes of a lattice", nodes, random.integers(COUNT, size=900), along, [-1] * 5)
    compare("lines on the edges of triangles", nodes, random.integers(COUNT, size=900),
            (along[0][:4], along[1][:2], ()), [0, 0])
    compare("lines around few points", coordinates[:3], numpy.arange(3) % COUNT,
            (diagonals[0], [([0, 3, 1, 2], True)], ()), [0])
    compare("points on a line, and a line across", numpy.array([[0.1 * k, 0.2 * k, k] for k in range(20)]),
            numpy.arange(20) % COUNT, diagonals, [-1] * 3)


def with_wide_ids(data, first):
    """With an array of ids that 32 bits cannot hold."""
    ids = numpy.arange(first, first + data.GetNumberOfPoints(), dtype=numpy.int64)
    data.GetPointData().AddArray(array_of(ids, "wide"))
    return data


def check_wide_ids(random):
    """Values of constraints keep their 64 bits on the way to other ranks."""
    first = 2**35
    points = with_wide_ids(cloud(random.random((100, 3))), first)
    ends = with_wide_ids(lines_of(numpy.array([[0.1, 0.2, 0.0], [0.9, 0.7, 0.0]]), [([0, 1], False)]), first)
    part, _ = triangulate(points, False, SourceData=ends if RANK == 0 else vtkPolyData())
    values = vtk_to_numpy(part.GetOutput().GetPointData().GetArray("wide"))
    check(bool((values >= first).all()), "ids of 64 bits: %s" % values[values < first])


def check_errors(random):
    """One message for all ranks, that of one rank."""
    points = random.random((COUNT, 50, 3))[RANK]
    across = numpy.array([[0.1, 0.2, 0.0], [0.9, 0.7, 0.0]])
    cell = [([0, 1], False)]
    for holder in range(min(COUNT, 3)):
        is_mine = RANK == holder
        for claim, places, cells, arrays, text in (
                ("far away", across + 50.0, cell, (), "The constraints do not overlap the points"),
                ("no line", across, [], (), "The constraints have no line"),
                ("not finite", across + [numpy.nan, 0.0, 0.0], cell, (), "not finite"),
                ("z not finite", across + [0.0, 0.0, numpy.inf], cell, (), "not finite"),
                ("a short array", across, cell, [("short", numpy.zeros(1))], '"short" has 1 tuple')):
            source = lines_of(places, cells, arrays) if is_mine else vtkPolyData()
            check_refused(vtkGridDelaunay2D(), cloud(points), text, "%s on rank %d" % (claim, holder), SourceData=source)


def main(options):
    check_kinds()
    random = numpy.random.default_rng(options.seed)
    check_errors(random)
    check_wide_ids(random)
    clouds = options.clouds or fewer(15)
    for i in range(clouds):
        compare_random(random, "cloud %d of seed %d" % (i, options.seed))
    places, cells = draw_lines(random, random.random((9, 3)))
    check_aborts(random, options.aborts or fewer(3), options.size, SourceData=lines_of(places, cells))
    return "%d clouds with constraints" % clouds


if __name__ == "__main__":
    end(main(options_of()))
