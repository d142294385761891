# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A mesh that is spread over ranks is trimmed where it is, and gives the surface of one rank.

Run by mpirun, as TestManyRanks.py. Each mesh is also trimmed by rank 0 alone, and what all ranks have is
compared with that. The last digits of z and of values follow the order of sums, so they are rounded.
"""
import collections
import re

import numpy
from on_ranks import (
    COUNT, RANK, check, check_refused, check_stops, end, fewer, gather, options_of, owners_in_places, updated)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

import meshes
import outcomes
from meshes import GHOSTS, array_of, cloud, triangles_of
from vtkelevationsurface import vtkGridDelaunay2D, vtkTrimOutwardTriangles

SPREAD = []  # whether surfaces without a given boundary have stayed where they were
# Names of what a case draws, for messages.
Case = collections.namedtuple("Case", "claim points triangles owners rings")


def mesh_of(xyz, triangles, points, cells, number_of_points, are_global, arrays=()):
    """A mesh with arrays by the numbers of points and triangles in the whole one."""
    arrays = [("double", points / max(1, number_of_points) + 0.25), ("whole", (points % 97).astype("i4")), *arrays]
    ids = 2**33 + 3 * points.astype(numpy.int64) if are_global else None  # 64 bits
    return meshes.mesh(xyz, triangles, ids, arrays, [("cell", cells.astype(numpy.int64))])


def part_of(case, rank, are_global, are_marked):
    """The triangles of a rank and their points; those of ranks before it are marked as theirs."""
    mine = numpy.flatnonzero(case.owners == rank)
    ids, corners = numpy.unique(case.triangles[mine], return_inverse=True)
    before = numpy.zeros(len(case.points), bool)
    before[case.triangles[case.owners < rank]] = True
    marks = [(GHOSTS, before[ids].astype("u1"))] if are_marked else []
    return mesh_of(case.points[ids], corners.reshape(-1, 3), ids, mine, len(case.points), are_global, marks)


def trim(mesh, boundary, alone, **properties):
    return updated(vtkTrimOutwardTriangles(), mesh, alone, BoundaryData=boundary, **properties)


def without_point_numbers(made, are_global):
    """Without global ids, messages number points as they are gathered: without these numbers."""
    made["messages"] = [(event, text if are_global else re.sub(r"\bpoint \d+", "point", text))
                        for event, text in made["messages"]]
    return made


def compare(case, are_global=False, are_marked=False, boundary_on=None, **properties):
    """Trims a mesh on all ranks, and on rank 0 alone. All ranks have the same arguments."""
    boundary = meshes.rings(case.rings) if case.rings else None
    mine = boundary if boundary_on in (None, RANK) or not boundary else vtkPolyData()
    part = part_of(case, RANK, are_global, are_marked)
    trimming, messages = trim(part, mine, False, **properties)
    is_gathered = any(gather(len(outcomes.take_gathering(messages))))
    kept, outward = (trimming.GetOutput(side) for side in (0, 1))
    if not gather(messages)[0]:
        stays = bool(kept.GetNumberOfPolys() + outward.GetNumberOfPolys()) == (part.GetNumberOfCells() > 0)
        if not case.rings:  # or is gathered
            SPREAD.append(all(gather(stays)))
            check(is_gathered or SPREAD[-1], case.claim + ": it is reported where triangles do not stay")
        else:
            check(stays, case.claim + ": a rank that has triangles keeps its own")
        used = numpy.append(triangles_of(kept), triangles_of(outward))
        added = numpy.arange(part.GetNumberOfPoints(), kept.GetNumberOfPoints())
        check(numpy.isin(added, used).all(), case.claim + ": added points are corners")
    parts = gather(outcomes.made_by([trimming], messages, None, ("numbers",)))
    ids = gather(own_ids(kept))
    if RANK:
        return
    # With the triangles of one rank after those of another: new triangles have cell data by their order.
    order = numpy.argsort(case.owners, kind="stable")
    numbers = numpy.arange(len(case.points))
    mesh = mesh_of(case.points, case.triangles[order], numbers, order, len(case.points), are_global)
    alone, expected = trim(mesh, boundary, True, **properties)
    check(not any(part["messages"] for part in parts[1:]), case.claim + ": other ranks are silent")
    whole = outcomes.made_by([alone], expected, None, ("numbers",))
    found, wanted = (without_point_numbers(outcomes.joined(made, digits=9), are_global) for made in (parts, [whole]))
    if expected:
        found, wanted = ({**made, "ports": []} for made in (found, wanted))
    why = outcomes.difference(found, wanted)
    check(not why, "%s: %s" % (case.claim, why))
    if are_global and not expected:
        check(sorted(sum(ids, [])) == own_ids(alone.GetOutput()), case.claim + ": global ids are those of one rank")


def own_ids(output):
    """The global ids of points of this part, in their order."""
    ids = output.GetPointData().GetGlobalIds()
    return sorted(vtk_to_numpy(ids)[~meshes.ghosts_of(output)].tolist()) if ids and output.GetNumberOfPoints() else []


def triangulated(coordinates):
    """The points that are vertices, and the triangles."""
    delaunay, _ = updated(vtkGridDelaunay2D(), cloud(coordinates), True)
    used, corners = numpy.unique(triangles_of(delaunay.GetOutput()), return_inverse=True)
    return coordinates[used], corners.reshape(-1, 3)


def owners_of(random, points, triangles):
    """Which rank has which triangle."""
    return owners_in_places(random, points[triangles, :2].mean(axis=1))


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
            RecoverBoundary=bool(random.random() < 0.8),
            BoundaryEdges=int(random.integers(3)))
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
    if random.random() < 0.3:  # a few points outside
        outside = points[random.integers(len(points), size=random.integers(1, 9))] + [2.0 * size, 0.0, 0.0]
        points, kept = numpy.vstack((points, outside)), numpy.append(kept, numpy.ones(len(outside), bool))
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
    boundary = meshes.rings(rings_for(random, coordinates))

    def chain(points, alone):
        surface = updated(vtkGridDelaunay2D(), cloud(points), alone)[0].GetOutput()
        trimming, messages = trim(surface, boundary, alone)
        return outcomes.made_by([trimming], messages)

    parts = gather(chain(coordinates[RANK::COUNT], False))
    if RANK == 0:
        have_points = [len(part["ports"][0][0]["points"]) > 0 for part in parts]
        check(parts[0]["messages"] or all(have_points), claim + ": each rank has its points")
        in_order = numpy.concatenate([coordinates[rank::COUNT] for rank in range(COUNT)])
        found, whole = (outcomes.joined(made, digits=9) for made in (parts, [chain(in_order, True)]))
        if any(kind == "ErrorEvent" for kind, _ in whole["messages"]):
            # Ranks that had given their triangles away have field data all the same.
            why = "" if found["messages"] == whole["messages"] else found["messages"]
        else:
            why = outcomes.difference(found, whole)
        check(not why, "%s: %s" % (claim, why))


def check_corners():
    """Points on the boundary have its values on their own ranks, also on those without a triangle."""
    points = numpy.array([[0.0, 0.0, 1.0], [9.0, 1.0, 2.0], [4.0, 8.0, 3.0]])
    boundary = meshes.rings([points + (0.0, 0.0, 5.0)])
    surface = updated(vtkGridDelaunay2D(), cloud(points[RANK::COUNT]), False)[0].GetOutput()
    trimmed, _ = trim(surface, boundary, False, BoundaryEdges=2)
    kept = trimmed.GetOutput()
    if kept.GetNumberOfPoints():
        marks = vtk_to_numpy(kept.GetPointData().GetArray("OnBoundary"))
        check((marks == 1).all() and (meshes.points_of(kept)[:, 2] > 5.0).all(), "corners of the boundary: %s" % marks)
    is_without = kept.GetNumberOfPoints() > 0 and kept.GetNumberOfPolys() == 0
    check(any(gather(is_without)) or COUNT == 1, "corners of the boundary are on a rank without a triangle")


def check_bytes_as_ids():
    """Where inserted points need larger numbers than the type of global ids has, no part has global ids any more."""
    points, triangles = grid(15)
    owners = (points[triangles, 0].mean(axis=1) * COUNT / 14).astype(int)
    case = Case("bytes", points, triangles, owners, [star(numpy.random.default_rng(1), (3.0, 7.0), 3.5, 40)])
    part = part_of(case, RANK, True, False)
    ids = (vtk_to_numpy(part.GetPointData().GetGlobalIds()) - 2**33) // 3
    part.GetPointData().SetGlobalIds(array_of(ids.astype("u1"), "id"))
    trimming, _ = trim(part, meshes.rings(case.rings), False)
    check(trimming.GetNumberOfInsertedPoints() > 30, "many points are inserted")
    check(trimming.GetOutput().GetPointData().GetGlobalIds() is None, "bytes that are no global ids any more")


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
        trimming.SetBoundaryData(meshes.rings(case.rings) if i % 2 else None)
        return trimming

    check_stops(random, count, 0.9, make)  # the last tenth is one rank's own


def check_errors(random):
    """What is wrong on one rank, or between them, is an error on all."""
    if COUNT == 1:
        return
    points, triangles = triangulated(uniform(random, 300))
    owners = random.integers(COUNT, size=len(triangles))
    rings = [star(random, (50.0, 50.0), 40.0, 20)]
    case = Case("errors", points, triangles, owners, rings)
    boundary = meshes.rings(rings)

    def check_case(case, text, claim, spoil=None, **properties):
        part = part_of(case, RANK, "cross" in text, "cross" in text)
        if spoil:
            spoil(part)
        check_refused(vtkTrimOutwardTriangles(), part, text, claim, **properties)

    def shorten(part):
        short = numpy.zeros(part.GetNumberOfPoints() - 1)
        part.GetPointData().AddArray(array_of(short, "short"))

    for culprit in range(min(COUNT, 3)):
        for claim, text, spoil in (
                ("a short array", 'On rank %d: Point array "short" has' % culprit, shorten),
                ("a point that is not finite", "not finite",
                 lambda part: part.GetPoints().SetPoint(0, numpy.nan, 0.0, 0.0))):
            check_case(case, text, claim, spoil if RANK == culprit else None, BoundaryData=boundary)
    twice = Case("twice", points, numpy.vstack((triangles, triangles[:1])),
                 numpy.append(owners, (owners[0] + 1) % COUNT), rings)
    check_case(twice, "shares the edge", "a triangle on two ranks", BoundaryData=boundary)
    check_case(case, "GapTolerance is -1", "a negative tolerance", GapTolerance=-1.0)
    check_case(case, "leaves out every point", "a tolerance of nearly nothing", GapTolerance=1e-9)
    crossed = meshes.rings([[(10.0, 10.0), (90.0, 90.0), (90.0, 10.0), (10.0, 80.0)]])
    check_case(case, "cross", "a ring that crosses itself", BoundaryData=crossed)


def main(options):
    random = numpy.random.default_rng(options.seed)
    check_errors(random)
    check_corners()
    check_bytes_as_ids()
    clouds = options.clouds or fewer(8)
    for i in range(clouds):
        compare_random(random, "cloud %d of seed %d" % (i, options.seed))
    for i in range(clouds):
        compare_outline(random, "cloud %d of seed %d" % (i, options.seed))
    check(sum(SPREAD) >= 0.5 * len(SPREAD) - 1, "%d of %d stay where they are" % (sum(SPREAD), len(SPREAD)))
    for i in range(max(1, clouds // 6)):
        check_chain(random, "chain %d of seed %d" % (i, options.seed))
    check_aborts(random, options.aborts or fewer(4), int(options.size**0.5))
    return "%d clouds that are trimmed" % clouds


if __name__ == "__main__":
    end(main(options_of()))
