# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points that are spread over ranks give the triangles of one rank, whatever the ranks have.

Run by mpirun: all ranks run this script. Each case is also made by rank 0 alone, and compared with what
all ranks have made: points, arrays, triangles, unused points, counts and messages, by global ids.
"""

import numpy
from on_ranks import (
    COUNT, RANK, check, check_refused, check_stops, end, fewer, gather, options_of, owners_in_places, updated)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

import outcomes
from meshes import GHOSTS, cloud, ghosts_of, lines as lines_of, triangles_of
from vtkelevationsurface import vtkGridDelaunay2D

POLICIES = 4


def triangulate(data, alone, **properties):
    return updated(vtkGridDelaunay2D(), data, alone, **properties)


def made_by(delaunay, messages, numbers=None):
    """What a rank has made, by global ids: those given, of the output, or places where it has all points."""
    output = delaunay.GetOutput()
    count, given = output.GetNumberOfPoints(), output.GetPointData().GetGlobalIds()
    if numbers is None:
        numbers = vtk_to_numpy(given) if given and count else numpy.arange(count)
    return outcomes.made_by([delaunay], messages, numbers[:count], ("numbers",))


def check_part(delaunay, claim):
    """A rank has its own points first, then other ranks' corners, both in the order of their ids."""
    output = delaunay.GetOutput()
    count, ids = output.GetNumberOfPoints(), output.GetPointData().GetGlobalIds()
    are_others = ghosts_of(output)
    own = count - numpy.count_nonzero(are_others)
    check(not are_others[:own].any(), claim + ": points of other ranks come last")
    if ids and count:
        ids = vtk_to_numpy(ids)
        check((numpy.diff(ids[:own]) > 0).all() and (numpy.diff(ids[own:]) > 0).all(), claim + ": the order of ids")
    check(numpy.isin(numpy.arange(own, count), triangles_of(output)).all(),
          claim + ": points of other ranks are corners")
    work = output.GetFieldData().GetArray("WorkOfRank")
    check(not work or work.GetComponent(0, 0) == own, claim + ": the number of own points is reported")


def own_and_order(owners, ids):
    """Which points this rank has, and in which order rank 0 has all of them."""
    mine = numpy.flatnonzero(owners == RANK)
    if ids is not None and len(set(owners)) == 1:
        mine = mine[numpy.argsort(ids[mine])]  # on one rank, places decide, not ids
    return mine, numpy.argsort(owners if ids is None else ids, kind="stable")


def compare(claim, coordinates, owners, ids=None, arrays=(), **properties):
    """Triangulates a cloud on all ranks, and on rank 0 alone. All ranks have the same arguments.

    Without ids, points are numbered rank by rank, and by their places on each.
    """
    mine, order = own_and_order(owners, ids)
    part, messages = triangulate(
        cloud(coordinates[mine], None if ids is None else ids[mine], [(n, a[mine]) for n, a in arrays]), False,
        **properties)
    check_part(part, claim)
    parts = gather(made_by(part, messages))
    if RANK == 0:
        numbers = numpy.arange(len(order)) if ids is None else ids[order]
        whole, expected = triangulate(
            cloud(coordinates[order], None, [(n, a[order]) for n, a in arrays]), True, **properties)
        check_union(parts, made_by(whole, expected, numbers), claim)


def check_union(parts, whole, claim):
    """Compares what all ranks have made with what one has; messages come from the first."""
    check(not any(part["messages"] for part in parts[1:]), claim + ": other ranks are silent")
    why = outcomes.difference(outcomes.joined(parts), outcomes.joined([whole]))
    check(not why, "%s: %s" % (claim, why))


def check_given_lattice(random):
    """A given lattice is that of all ranks; of the points off it, the first is named."""
    i, j = numpy.meshgrid(numpy.arange(40.0), numpy.arange(30.0))
    turned_nodes = numpy.stack((612000 + 20.0 * i.ravel() - 9.0 * j.ravel(),
                                6073000 + 15.0 * i.ravel() + 12.0 * j.ravel(), (i * j).ravel()), axis=1)
    given = (612000.0, 6073000.0, 20.0, 15.0, 11.0, 27.0)  # of the same nodes
    for part in (1.0, 0.3, 0.01):  # few points are on many lattices: one has to be given
        nodes = turned_nodes[random.random(len(turned_nodes)) < part]
        nodes = numpy.vstack((nodes, nodes[:9] + [0.0, 0.0, 1.0]))
        owners = random.integers(COUNT, size=len(nodes))
        for ids in (None, random.permutation(len(nodes))):
            compare("given lattice, part %g" % part, nodes, owners, ids, Lattice=given)
        unfit = [("off the lattice", nodes + [5.0, 0.0, 0.0], given),
                 ("two on a node", numpy.vstack((nodes, nodes[-1:] + [0.01, 0.0, 0.0])), given),
                 ("too unequal steps", nodes, (612000.0, 6073000.0, 20.0, 15.0, -9e-9, 12e-9)),
                 ("steps on a line", nodes, given[:4] + (40.0, 30.0))]
        off = nodes.copy()
        off[random.integers(len(nodes), size=3), :2] += [3.0, 1.0]
        unfit.append(("some off the lattice", off, given))
        for claim, points, lattice in unfit:
            compare(claim, points, random.integers(COUNT, size=len(points)), None, Lattice=lattice)
    nodes = turned_nodes[:40]
    compare("a line of the given lattice", nodes, numpy.arange(40) % COUNT, None, Lattice=given)
    compare("no finite point", nodes * numpy.nan, numpy.arange(40) % COUNT, None, Lattice=given)
    compare("all points of the given lattice on the last rank", nodes, numpy.full(40, COUNT - 1), None, Lattice=given)
    across = lines_of(nodes[[0, -1]], [[0, 1]]) if RANK == COUNT - 1 else None
    own, across = (nodes, across) if across else (nodes[:0], vtkPolyData())
    delaunay, _ = triangulate(cloud(own), False, Lattice=given, SourceData=across)
    check(not delaunay.GetLatticeFound(), "constraints leave the given lattice, also with points on one rank alone")


def check_elevation_error(random):
    """With an elevation error, the points are gathered on one rank, with a warning; all have the counts."""
    points = random.random((2000, 3))
    owners = owners_in_places(random, points)
    for error in (0.2, -1.0):
        spread, messages = triangulate(cloud(points[owners == RANK]), False, MaximumElevationError=error)
        parts = gather(outcomes.made_by([spread], messages))
        alone, expected = triangulate(
            cloud(numpy.concatenate([points[owners == rank] for rank in range(COUNT)])), True,
            MaximumElevationError=error)
        warnings = outcomes.take_gathering(parts[0]["messages"])
        is_warned = error > 0.0 and len(set(owners)) > 1
        check(len(warnings) == is_warned, "elevation error %s: one warning if it is right, not %s" % (error, warnings))
        check(all("MaximumElevationError chooses" in text for _, text in warnings), "why: %s" % warnings)
        check_union(parts, outcomes.made_by([alone], expected), "elevation error %s" % error)
        shares = outcomes.joined(parts)["shares"]
        check(max(shares) == sum(shares), "elevation error: %s triangles are on one rank" % shares)


def tracks(random, count):
    """Points along lines of a ship, dense along them and far between."""
    line = random.integers(6, size=count)
    along = random.uniform(0, 100, count)
    return numpy.stack((along, 20.0 * line + 0.1 * numpy.sin(along), along), axis=1)


def clusters(random, count):
    centres = random.uniform(0, 1e5, (5, 2))
    spread = 10.0 ** random.integers(-3, 4, 5)
    which = random.integers(5, size=count)
    places = centres[which] + spread[which, None] * random.standard_normal((count, 2))
    return numpy.column_stack((places, random.random(count)))


def lattice(random, count):
    """Nodes of a lattice along the axes or turned, some missing; sometimes a point off them."""
    side = max(2, int(count ** 0.5))
    i, j = numpy.meshgrid(numpy.arange(side), numpy.arange(side))
    kept = random.random(side * side) < random.choice([1.0, 0.8, 0.3])
    u, v = random.choice([((25.0, 0.0), (0.0, 12.5)), ((20.0, 15.0), (-9.0, 12.0))])
    nodes = numpy.stack((i.ravel() * u[0] + j.ravel() * v[0], i.ravel() * u[1] + j.ravel() * v[1],
                         (i * j).ravel()), axis=1)[kept]
    nodes += [612000.0, 6073000.0, 0.0]
    if random.random() < 0.3:
        nodes[:, :2] += random.uniform(-0.01, 0.01, (len(nodes), 2))
    if random.random() < 0.2 and len(nodes):
        nodes[random.integers(len(nodes)), 0] += 3.0
    return nodes


def small_lattice(random, count):
    return random.integers(2 + random.integers(9), size=(count, 3)).astype(float)


def line(random, count):
    along = random.integers(1000, size=count)
    return numpy.stack((along, 3.0 + along, random.random(count)), axis=1)


def circle(random, count):
    angles = numpy.linspace(0.0, 2.0 * numpy.pi, min(count, 200), endpoint=False)
    return numpy.stack((numpy.cos(angles), numpy.sin(angles), angles), axis=1)


CLOUDS = (lambda random, count: random.random((count, 3)), tracks, clusters, lattice, small_lattice, line, circle)


def random_arrays(random, count):
    """Arrays of points: of a whole number, of a vector and of a text."""
    return (("whole", random.integers(-9, 9, count).astype(numpy.int16)),
            ("vector", random.random((count, 3))),
            ("text", numpy.array(["t" * (i % 4) + str(i) for i in range(count)], dtype="U")))


def draw_points(random):
    """A cloud, drawn with what else can be drawn: coordinates, global ids or None, arrays."""
    count = int(random.choice([0, 1, 2, 3, 5, COUNT, 30, 300, 2000]))
    coordinates = CLOUDS[random.integers(len(CLOUDS))](random, count)
    count = len(coordinates)
    if random.random() < 0.2 and count:
        wrong = random.integers(count, size=1 + count // 20)
        coordinates[wrong, random.integers(3, size=len(wrong))] = random.choice([numpy.nan, numpy.inf, -numpy.inf])
    if random.random() < 0.3 and count:
        twice = random.integers(count, size=1 + count // 3)
        again = coordinates[twice]
        again[:, 2] = random.integers(3, size=len(again))
        coordinates = numpy.vstack((coordinates, again))
        count = len(coordinates)
    if random.random() < 0.3:
        coordinates = coordinates.astype(numpy.float32)
    ids = random.permutation(3 * count)[:count] if random.random() < 0.4 else None
    arrays = ()
    if random.random() < 0.3:
        arrays = random_arrays(random, count)
    return coordinates, ids, arrays


def compare_random(random, claim):
    """Compares one cloud."""
    coordinates, ids, arrays = draw_points(random)
    limit = random.choice([0.0, 0.0, 0.05, 1.5, 30.0])
    compare(claim, coordinates, owners_in_places(random, coordinates), ids, arrays,
            DuplicatePolicy=int(random.integers(POLICIES)), MaximumEdgeLength=float(limit),
            LatticeMode=int(random.random() < 0.3))


def check_aborts(random, count, size, **properties):
    def make(_):
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(cloud(random.random((size, 3))[RANK::COUNT]))
        for name, value in properties.items():
            getattr(delaunay, "Set" + name)(value)
        return delaunay

    check_stops(random, count, 0.9, make)  # the last tenth is one rank's own


def check_errors(random):
    """What is wrong on one rank, or between them, is an error on all."""
    if COUNT == 1:
        return
    for culprit in range(min(COUNT, 3)):
        data = cloud(random.random((COUNT, 50, 3))[RANK], None, [("short", numpy.zeros(50 if RANK != culprit else 49))])
        check_refused(vtkGridDelaunay2D(), data, 'On rank %d: Point array "short" has 49 tuples' % culprit, "a short array")
    # Several points of one part of the plane have the same id, 7 or 7 + COUNT: one of them is named, which
    # of the two, depends on the rank that is first.
    corner = numpy.array([[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.001, 0.0]])
    check_refused(vtkGridDelaunay2D(), cloud(corner + [1e-5 * RANK, 0.0, 0.0], numpy.array([7, 7 + COUNT, 8 + COUNT + RANK, 9 + 3 * COUNT + RANK])),
                  "have the same global id, ", "ids of several points")


def check_kinds():
    """One cloud of each kind, with its own name."""
    random = numpy.random.default_rng(21)
    for make in CLOUDS:
        coordinates = make(random, 1500)
        compare(make.__name__, coordinates, random.integers(COUNT, size=len(coordinates)))
    coordinates = random.random((1500, 3))
    twice = numpy.vstack((coordinates, coordinates[:400], coordinates[:90])) + [0.0, 0.0, 1.0]
    twice[:, 2] = random.integers(3, size=len(twice))
    names = numpy.array(["t" * (i % 4) + str(i) for i in range(len(twice))], dtype="U")
    arrays = (("whole", random.integers(-9, 9, len(twice)).astype(numpy.int16)),
              ("single", random.random((len(twice), 2)).astype(numpy.float32)), ("text", names))
    for policy in range(POLICIES):
        owners = random.integers(COUNT, size=len(twice))
        compare("duplicates, policy %d" % policy, twice, owners, None, arrays, DuplicatePolicy=policy)
        compare("duplicates with ids, policy %d" % policy, twice, owners, random.permutation(len(twice)), arrays,
                DuplicatePolicy=policy)
    compare("an array that is named as flags are, and has none", coordinates, numpy.arange(1500) % COUNT, None,
            ((GHOSTS, numpy.zeros(1500)),))
    compare("points on every other rank", coordinates, 2 * random.integers((COUNT + 1) // 2, size=1500))
    compare("a point on each rank", coordinates[:COUNT], numpy.arange(COUNT))
    compare("two points", coordinates[:2], numpy.arange(2) % COUNT)
    compare("no point", coordinates[:0], numpy.zeros(0, int))


def main(options):
    check_kinds()
    random = numpy.random.default_rng(options.seed)
    check_errors(random)
    check_given_lattice(random)
    check_elevation_error(random)
    clouds = options.clouds or fewer(30)
    for i in range(clouds):
        compare_random(random, "cloud %d of seed %d" % (i, options.seed))
    check_aborts(random, options.aborts or fewer(4), options.size)
    return "%d clouds" % clouds


if __name__ == "__main__":
    end(main(options_of()))
