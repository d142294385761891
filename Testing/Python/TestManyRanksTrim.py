# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A mesh that is spread over ranks is trimmed where it is, and gives the surface of one rank.

Run by mpirun: all ranks run this script. Each mesh is also trimmed by rank 0 alone, and the triangles of
all ranks are compared with that, by coordinates. With --clouds more are compared than the suite has time
for, with --aborts more are stopped.
"""
import collections
import re

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

from TestManyRanks import COUNT, RANK, WORLD, check, check_stops, end, options_of, updated
from vtkelevationsurface import vtkGridDelaunay2D, vtkTrimOutwardTriangles

SPREAD = []  # whether surfaces without a given boundary have stayed where they were
COMPARED = []  # on rank 0, whether surfaces were trimmed without a message, so that their triangles are compared
DUPLICATE = 1
GHOSTS = "vtkGhostType"
# Names of what a case draws, for messages.
Case = collections.namedtuple("Case", "claim points triangles owners rings")


def mesh_of(points, triangles):
    mesh, places, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(numpy.ascontiguousarray(points), deep=True))
    mesh.SetPoints(places)
    offsets = numpy.arange(0, 3 * len(triangles) + 1, 3, dtype=numpy.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True),
                  numpy_to_vtkIdTypeArray(triangles.ravel().astype(numpy.int64), deep=True))
    mesh.SetPolys(cells)
    return mesh


def triangles_of(mesh):
    if not mesh.GetNumberOfPolys():
        return numpy.zeros((0, 3), int)
    return vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def add(data, name, values):
    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName(name)
    data.AddArray(array)


def with_arrays(mesh, points, cells, number_of_points, are_global):
    """Arrays by the numbers of points and triangles in the whole mesh."""
    add(mesh.GetPointData(), "double", points / max(1, number_of_points) + 0.25)
    add(mesh.GetPointData(), "whole", (points % 97).astype(numpy.int32))
    add(mesh.GetCellData(), "cell", cells.astype(numpy.int64))
    if are_global:
        ids = numpy_to_vtkIdTypeArray(2**33 + 3 * points.astype(numpy.int64), deep=True)  # 64 bits
        ids.SetName("numbers")
        mesh.GetPointData().SetGlobalIds(ids)
    return mesh


def part_of(case, rank, are_global, are_marked):
    """The triangles of a rank and their points; those of ranks before it are marked as theirs."""
    mine = numpy.flatnonzero(case.owners == rank)
    ids, corners = numpy.unique(case.triangles[mine], return_inverse=True)
    part = with_arrays(mesh_of(case.points[ids], corners.reshape(-1, 3)), ids, mine, len(case.points), are_global)
    if are_marked:
        before = numpy.zeros(len(case.points), bool)
        before[case.triangles[case.owners < rank]] = True
        add(part.GetPointData(), GHOSTS, before[ids].astype(numpy.uint8))
    return part


def boundary_of(rings):
    data, points, lines = vtkPolyData(), vtkPoints(), vtkCellArray()
    for ring in rings:
        first = points.GetNumberOfPoints()
        for x, y in ring:
            points.InsertNextPoint(x, y, 0.0)
        lines.InsertNextCell(len(ring) + 1)
        for i in range(len(ring) + 1):
            lines.InsertCellPoint(first + i % len(ring))
    points_of_lines = vtkPoints()
    points_of_lines.SetDataTypeToDouble()
    points_of_lines.DeepCopy(points)
    data.SetPoints(points_of_lines)
    data.SetLines(lines)
    return data


def trim(mesh, boundary, alone, **properties):
    return updated(vtkTrimOutwardTriangles(), mesh, alone, BoundaryData=boundary, **properties)


def side_of(output):
    """What a rank has on one side: points with their values, and triangles by coordinates."""
    count, data = output.GetNumberOfPoints(), output.GetPointData()
    points = vtk_to_numpy(output.GetPoints().GetData()).astype(float) if count else numpy.zeros((0, 3))
    ghosts = vtk_to_numpy(data.GetArray(GHOSTS)).tolist() if data.GetArray(GHOSTS) else [0] * count
    ids = vtk_to_numpy(data.GetGlobalIds()).tolist() if data.GetGlobalIds() else None
    values = [vtk_to_numpy(data.GetArray(name)).tolist() for name in ("double", "whole") if data.GetArray(name)]
    cells = output.GetCellData().GetArray("cell")
    triangles = triangles_of(output)
    keys = []
    for triangle in points[triangles].tolist() if len(triangles) else []:
        places = [tuple(corner) for corner in triangle]
        first = places.index(min(places))
        keys.append(tuple(places[first:] + places[:first]))
    return {"points": list(map(tuple, points.tolist())), "ghosts": ghosts, "ids": ids,
            "values": list(zip(*values)), "triangles": keys, "used": set(triangles.ravel().tolist()),
            "cells": vtk_to_numpy(cells).tolist() if cells else [],
            "type": output.GetPoints().GetDataType() if count else None}


def counts_of(trimming):
    return (trimming.GetNumberOfOutwardTriangles(), trimming.GetNumberOfRecoveredEdges(),
            trimming.GetNumberOfInsertedPoints(), trimming.GetNumberOfPointsLeftOut(),
            trimming.GetEffectiveGapTolerance())


def rings_of(output):
    lines = output.GetLines()
    places = [output.GetPoint(i)[:2] for i in range(output.GetNumberOfPoints())]
    return lines.GetNumberOfCells(), places


def area(triangles):
    corners = numpy.array(triangles).reshape(-1, 3, 3)
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return 0.5 * numpy.sum(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def rounded(triangles):
    """Without the last digits of z, which follow the order of sums."""
    return collections.Counter(tuple((x, y, round(z, 9)) for x, y, z in triangle) for triangle in triangles)


def check_points(parts, claim):
    """Each point has one owner; with global ids, one place and one value too."""
    owners, known = collections.Counter(), {}
    for part in parts:
        for i, place in enumerate(part["points"]):
            key = part["ids"][i] if part["ids"] else place
            owners[key] += part["ghosts"][i] == 0
            same = known.setdefault(key, (place, part["values"][i]))
            check(same == (place, part["values"][i]), "%s: point %s is the same on all ranks" % (claim, key))
    check(all(count == 1 for count in owners.values()), claim + ": each point has one owner")
    return known


def told(messages, are_global):
    """Messages as they are to be compared: without global ids, points are numbered as they are gathered."""
    return [(event, text if are_global else re.sub(r"\bpoint \d+", "point", text)) for event, text in messages]


def check_sides(case, parts, whole):
    """Compares outputs 0 and 1 of all ranks with those of one rank."""
    for side in (0, 1):
        claim = "%s, output %d" % (case.claim, side)
        found = [triangle for part in parts for triangle in part[side]["triangles"]]
        expected = whole[side]["triangles"]
        check(rounded(found) == rounded(expected),
              "%s: %d triangles are the %d of one rank" % (claim, len(found), len(expected)))
        check(abs(area(found) - area(expected)) <= 1e-9 * (1.0 + abs(area(expected))), claim + ": the area")
        cells = [cell for part in parts for cell in part[side]["cells"]]
        check(collections.Counter(zip(rounded_list(found), cells)) ==
              collections.Counter(zip(rounded_list(expected), whole[side]["cells"])), claim + ": the values of cells")
        types = {part[side]["type"] for part in parts} - {None}
        check(types == {whole[side]["type"]}, "%s: types %s of points" % (claim, types))


def rounded_list(triangles):
    return [tuple((x, y, round(z, 9)) for x, y, z in triangle) for triangle in triangles]


def check_values(case, parts, whole, are_global):
    """Points have the values of one rank, which may differ in the last digits."""
    known = check_points(parts, case.claim)
    if are_global and whole["ids"]:
        check(sorted(known) == sorted(whole["ids"]), case.claim + ": global ids are those of one rank")
    expected = {place[:2]: values for place, values in zip(whole["points"], whole["values"])}
    for place, values in known.values():
        near = expected.get(place[:2])
        if near is None:
            check(False, "%s: a point at %s" % (case.claim, place[:2]))
            continue
        check(abs(near[0] - values[0]) <= 1e-9, "%s: %s, not %s, at %s" % (case.claim, values, near, place[:2]))


def compare(case, are_global=False, are_marked=False, boundary_on=None, **properties):
    """Trims a mesh on all ranks, and on rank 0 alone. All ranks have the same arguments."""
    boundary = boundary_of(case.rings) if case.rings else None
    mine = boundary if boundary_on in (None, RANK) or not boundary else vtkPolyData()
    part = part_of(case, RANK, are_global, are_marked)
    trimming, messages = trim(part, mine, False, **properties)
    check(RANK == 0 or not messages, "%s: rank %d is silent: %s" % (case.claim, RANK, messages))
    outputs = [side_of(trimming.GetOutput(side)) for side in (0, 1)]
    if not WORLD.bcast(messages):
        stays = bool(outputs[0]["triangles"] or outputs[1]["triangles"]) == (part.GetNumberOfCells() > 0)
        if not case.rings:  # or is gathered
            SPREAD.append(all(WORLD.allgather(stays)))
        else:
            check(stays, case.claim + ": a rank that has triangles keeps its own")
        check(all(i in outputs[0]["used"] | outputs[1]["used"]
                  for i in range(part.GetNumberOfPoints(), len(outputs[0]["points"]))),
              case.claim + ": added points are corners")
    parts = WORLD.gather(outputs)
    counts = WORLD.gather(counts_of(trimming))
    rings = WORLD.gather(rings_of(trimming.GetOutput(2)))
    if RANK:
        return
    # With the triangles of one rank after those of another: new triangles have cell data by their order.
    order = numpy.argsort(case.owners, kind="stable")
    numbers = numpy.arange(len(case.points))
    mesh = with_arrays(mesh_of(case.points, case.triangles[order]), numbers, order, len(case.points), are_global)
    alone, expected = trim(mesh, boundary, True, **properties)
    check(told(messages, are_global) == told(expected, are_global),
          "%s: messages %s, not %s" % (case.claim, messages, expected))
    check(set(counts) == {counts_of(alone)}, "%s: counts %s, not %s" % (case.claim, counts, counts_of(alone)))
    whole = [side_of(alone.GetOutput(side)) for side in (0, 1)]
    found = [ring for ring in rings if ring[0]]
    check(found == [ring for ring in [rings_of(alone.GetOutput(2))] if ring[0]], case.claim + ": the boundary")
    COMPARED.append(not expected)
    if not expected:
        check_sides(case, parts, whole)
        check_values(case, [part[0] for part in parts], whole[0], are_global)


def triangulated(coordinates):
    """The points that are vertices, and the triangles."""
    delaunay, data, points = vtkGridDelaunay2D(), vtkPolyData(), vtkPoints()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(coordinates), deep=True))
    data.SetPoints(points)
    delaunay.SetInputData(data)
    delaunay.SetNumberOfThreads(1)
    delaunay.UpdatePiece(0, 1, 0)
    used, corners = numpy.unique(triangles_of(delaunay.GetOutput()), return_inverse=True)
    return coordinates[used], corners.reshape(-1, 3)


def owners_of(random, points, triangles):
    """Which rank has which triangle: in strips, in blocks, in stretches, drawn, on few ranks."""
    kind, count = random.integers(6), len(triangles)
    centres = points[triangles].mean(axis=1)
    if kind == 0:
        return numpy.argsort(numpy.argsort(centres[:, 0])) * COUNT // count
    if kind == 1:
        ranks = numpy.argsort(numpy.argsort(centres[:, 1])) * 2 // count
        return (2 * (numpy.argsort(numpy.argsort(centres[:, 0])) * 2 // count) + ranks) % COUNT
    if kind == 2:
        return numpy.sort(random.integers(COUNT, size=count))
    if kind == 3:
        return random.integers(COUNT, size=count)
    if kind == 4:
        few = random.integers(COUNT, size=max(1, COUNT // 2))
        return few[numpy.argsort(numpy.argsort(centres[:, 0])) * len(few) // count]
    owners = numpy.full(count, random.integers(COUNT))
    owners[random.integers(count)] = random.integers(COUNT)
    return owners


def star(random, centre, radius, corners):
    angles = 2.0 * numpy.pi * (numpy.arange(corners) + 0.3 * random.random(corners)) / corners
    radii = radius * random.uniform(0.4, 1.0, corners)
    return list(zip((centre[0] + radii * numpy.cos(angles)).tolist(), (centre[1] + radii * numpy.sin(angles)).tolist()))


def rectangle(low, high):
    return [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]


def rings_for(random, points):
    """Rings of many kinds: with a lake and an island in it, over the rim, through points, around all."""
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    middle, size = 0.5 * (low + high), 0.5 * (high - low).min()
    kind = random.integers(8)
    if kind == 0:
        return [star(random, middle, 0.9 * size, 30)]
    if kind == 1:
        return [rectangle(middle - 0.9 * size, middle + 0.85 * size), star(random, middle, 0.6 * size, 12),
                star(random, middle, 0.2 * size, 7)]
    if kind == 2:
        return [star(random, low + (high - low) * random.random(2), 1.5 * size, 9)]
    if kind == 3:  # through points of the mesh
        ring = star(random, middle, 0.9 * size, 14)
        near = [int(numpy.argmin(numpy.hypot(points[:, 0] - x, points[:, 1] - y))) for x, y in ring]
        near = list(dict.fromkeys(near))
        return [[tuple(points[i, :2].tolist()) for i in near]] if len(near) > 2 else [ring]
    if kind == 4:
        corners = numpy.sort(points[random.integers(len(points), size=2), :2], axis=0)
        return [rectangle(corners[0].tolist(), corners[1].tolist())] if (corners[0] < corners[1]).all() else \
            [star(random, middle, size, 20)]
    if kind == 5:
        return [rectangle((low - 1.0).tolist(), (high + 1.0).tolist())]
    if kind == 6:
        return [star(random, middle, 0.02 * size, 5)]
    return [rectangle((high + 1.0).tolist(), (high + 2.0).tolist())]


def uniform(random, count):
    return numpy.column_stack((100.0 * random.random((count, 2)), random.random(count)))


def lattice(random, count):
    side = max(3, int(count ** 0.5))
    i, j = numpy.meshgrid(numpy.arange(side), numpy.arange(side))
    kept = random.random(side * side) < random.choice([1.0, 0.7])
    kept[:2 * side] = True
    return numpy.column_stack((i.ravel(), j.ravel(), (i * j).ravel() % 7)).astype(float)[kept]


def clusters(random, count):
    centres = random.uniform(0, 1e5, (5, 2))
    spread = 10.0 ** random.integers(1, 5, 5)
    which = random.integers(5, size=count)
    places = centres[which] + spread[which, None] * random.standard_normal((count, 2))
    return numpy.column_stack((places, random.random(count)))


CLOUDS = (uniform, lattice, clusters)


def draw(random, claim, count, make=None, rings=None):
    make = make or CLOUDS[random.integers(len(CLOUDS))]
    coordinates = make(random, count)
    if random.random() < 0.3:
        coordinates = coordinates.astype(numpy.float32)
    points, triangles = triangulated(coordinates)
    return Case(claim, points, triangles, owners_of(random, points, triangles), rings or rings_for(random, points))


def compare_random(random, claim):
    case = draw(random, claim, int(random.choice([4, 10, 100, 1000])))
    boundary_on = None if random.random() < 0.5 else int(random.integers(COUNT))
    compare(case, random.random() < 0.5, random.random() < 0.5, boundary_on,
            RecoverBoundary=bool(random.random() < 0.8))
    if claim.startswith("cloud 0 "):
        compare(case._replace(claim=claim + ", InwardNormal", rings=None), True, True, OutwardTest=1)


def torn(random, points):
    """Points with lakes, bays and a gap all across, so that there is an outline to find."""
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    size = (high - low).max()
    kept = numpy.ones(len(points), bool)
    for _ in range(random.integers(4)):
        centre = low + (high - low) * random.random(2)
        kept &= numpy.hypot(*(points[:, :2] - centre).T) > size * random.uniform(0.05, 0.3)
    if random.random() < 0.3:
        x = low[0] + (high[0] - low[0]) * random.random()
        kept &= abs(points[:, 0] - x) > 0.1 * size
    if random.random() < 0.3:  # a few points beside
        beside = points[random.integers(len(points), size=random.integers(1, 9))] + [2.0 * size, 0.0, 0.0]
        points, kept = numpy.vstack((points, beside)), numpy.append(kept, numpy.ones(len(beside), bool))
    return points[kept] if kept.sum() > 3 else points


def tracks(random, count):
    """Dense along lines that are far apart."""
    lines = max(2, int((count / 10) ** 0.5))
    line = random.integers(lines, size=count)
    return numpy.column_stack((random.random(count), line / lines + 1e-4 * random.random(count), random.random(count)))


def compare_outline(random, claim):
    """No boundary is given: the ranks find the outline of one."""
    make = (uniform, uniform, lattice, lattice, clusters, tracks)[random.integers(6)]
    points, triangles = triangulated(torn(random, make(random, int(random.choice([30, 300, 3000, 12000])))))
    if len(triangles) < 2:
        return
    case = Case("%s, outline of %s" % (claim, make.__name__), points, triangles, owners_of(random, points, triangles), None)
    compare(case, random.random() < 0.5, random.random() < 0.5,
            GapTolerance=float(random.choice([0.0, 0.0, 0.0, 2.0, 10.0])))


def check_chain(random, claim):
    """The triangulation of all ranks is trimmed on all of them."""
    coordinates = CLOUDS[random.integers(2)](random, 900)
    points, triangles = triangulated(coordinates)
    rings = rings_for(random, points)
    mine = coordinates[RANK::COUNT]
    delaunay, data, places = vtkGridDelaunay2D(), vtkPolyData(), vtkPoints()
    places.SetData(numpy_to_vtk(numpy.ascontiguousarray(mine), deep=True))
    data.SetPoints(places)
    delaunay.SetInputData(data)
    delaunay.SetNumberOfThreads(1)
    delaunay.UpdatePiece(RANK, COUNT, 0)
    boundary = boundary_of(rings)
    trimming, messages = trim(delaunay.GetOutput(), boundary, False)
    parts = WORLD.gather([side_of(trimming.GetOutput(side)) for side in (0, 1)])
    has_points = trimming.GetOutput().GetNumberOfPoints() > 0
    check(WORLD.bcast(messages) or has_points, claim + ": each rank has its points")
    if RANK == 0:
        alone, expected = trim(mesh_of(points, triangles), boundary, True)
        check(messages == expected, "%s: messages %s, not %s" % (claim, messages, expected))
        check(counts_of(trimming) == counts_of(alone), claim + ": counts")
        for side in (0, 1):
            found = [triangle for part in parts for triangle in part[side]["triangles"]]
            check(rounded(found) == rounded(side_of(alone.GetOutput(side))["triangles"]), claim + ": triangles")
        for part in parts:
            part[0]["values"] = part[0]["values"] or [()] * len(part[0]["points"])
        check_points([part[0] for part in parts], claim)


def grid(side):
    """The points and triangles of a square grid, quickly."""
    i, j = numpy.meshgrid(numpy.arange(side), numpy.arange(side))
    points = numpy.column_stack((i.ravel(), j.ravel(), (i * j).ravel() % 7)).astype(float)
    first = (numpy.arange(side - 1)[:, None] * side + numpy.arange(side - 1)).ravel()
    lower = numpy.column_stack((first, first + 1, first + side + 1))
    upper = numpy.column_stack((first, first + side + 1, first + side))
    return points, numpy.vstack((lower, upper))


def check_aborts(random, count, side):
    points, triangles = grid(side)
    owners = numpy.argsort(numpy.argsort(points[triangles].mean(axis=1)[:, 0])) * COUNT // len(triangles)

    def make(i):
        case = Case("abort %d" % i, points, triangles, owners, [star(random, (side / 2, side / 2), side / 2, 500)])
        trimming = vtkTrimOutwardTriangles()
        trimming.SetInputData(part_of(case, RANK, False, False))
        trimming.SetBoundaryData(boundary_of(case.rings) if i % 2 else None)
        return trimming

    return check_stops(random, count, 0.9, make)  # the last tenth is one rank's own


def check_refused(mesh, boundary, part, claim, **properties):
    """One error of all ranks, by rank 0, and nothing on any."""
    trimming, messages = trim(mesh, boundary, False, **properties)
    check(len(messages) == (RANK == 0) and (RANK > 0 or part in messages[0][1]),
          "rank %d, %s: one error with %r, not %s" % (RANK, claim, part, messages))
    for side in (0, 1, 2):
        check(trimming.GetOutput(side).GetNumberOfPoints() == 0, "rank %d, %s: no point" % (RANK, claim))


def check_errors(random):
    """What is wrong on one rank, or between them, is an error on all."""
    if COUNT == 1:
        return
    points, triangles = triangulated(uniform(random, 300))
    owners = random.integers(COUNT, size=len(triangles))
    rings = [star(random, (50.0, 50.0), 40.0, 20)]
    case = Case("errors", points, triangles, owners, rings)
    boundary = boundary_of(rings)
    for culprit in range(min(COUNT, 3)):
        part = part_of(case, RANK, False, False)
        if RANK == culprit:
            add(part.GetPointData(), "short", numpy.zeros(part.GetNumberOfPoints() - 1))
        check_refused(part, boundary, 'On rank %d: Point array "short" has' % culprit, "a short array")
        part = part_of(case, RANK, False, False)
        if RANK == culprit:
            part.GetPoints().SetPoint(0, numpy.nan, 0.0, 0.0)
        check_refused(part, boundary, "not finite", "a point that is not finite")
    twice = Case("twice", points, numpy.vstack((triangles, triangles[:1])),
                 numpy.append(owners, (owners[0] + 1) % COUNT), rings)
    check_refused(part_of(twice, RANK, False, False), boundary, "shares the edge", "a triangle on two ranks")
    check_refused(part_of(case, RANK, False, False), None, "GapTolerance is -1", "a negative tolerance",
                  GapTolerance=-1.0)
    check_refused(part_of(case, RANK, False, False), None, "leaves out every point", "a tolerance of nearly nothing",
                  GapTolerance=1e-9)
    case = Case("crossed", points, triangles, owners, [[(10.0, 10.0), (90.0, 90.0), (90.0, 10.0), (10.0, 80.0)]])
    check_refused(part_of(case, RANK, True, True), boundary_of(case.rings), "cross", "a ring that crosses itself")


def main():
    options = options_of(8, 4)
    random = numpy.random.default_rng(options.seed)
    check_errors(random)
    for i in range(options.clouds):
        compare_random(random, "cloud %d of seed %d" % (i, options.seed))
    for i in range(options.clouds):
        compare_outline(random, "cloud %d of seed %d" % (i, options.seed))
    check(sum(SPREAD) >= 0.5 * len(SPREAD) - 1, "%d of %d stay where they are" % (sum(SPREAD), len(SPREAD)))
    check(sum(COMPARED) >= 0.4 * len(COMPARED), "%d of %d are compared" % (sum(COMPARED), len(COMPARED)))
    for i in range(max(1, options.clouds // 6)):
        check_chain(random, "chain %d of seed %d" % (i, options.seed))
    most = check_aborts(random, options.aborts, int(options.size**0.5))
    end("%d clouds, %d aborts (%d reports after one at most)" % (options.clouds, options.aborts, most))


main()
