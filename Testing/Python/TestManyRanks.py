# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points that are spread over ranks give the triangles of one rank, whatever the ranks have.

Run by mpirun: all ranks run this script. Each case is also made by rank 0 alone, and compared with what
all ranks have made: points, arrays, triangles, unused points and counts, by global ids. With --clouds
more random clouds are compared than the suite has time for, with --aborts more aborts.
"""
import argparse
import sys

from mpi4py import MPI  # before VTK: it starts MPI
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdTypeArray, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkParallelCore import vtkMultiProcessController
from vtkmodules.vtkParallelMPI import vtkMPIController

from vtkelevationsurface import vtkGridDelaunay2D

WORLD = MPI.COMM_WORLD
RANK, COUNT = WORLD.rank, WORLD.size
CONTROLLER = vtkMPIController()
CONTROLLER.Initialize()
vtkMultiProcessController.SetGlobalController(CONTROLLER)
FAILURES = []
MOST_AFTER_ABORT = 2  # reports of a rank that asked to stop
POLICIES = 4


def check(is_true, claim):
    if not is_true:
        FAILURES.append(claim)
        print("rank %d: FAILED: %s" % (RANK, claim), flush=True)


def cloud(coordinates, ids=None, arrays=()):
    """A data set; ids are marked as global ids."""
    data, points = vtkPolyData(), vtkPoints()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(coordinates), deep=True))
    data.SetPoints(points)
    if ids is not None:
        array = vtkIdTypeArray()
        array.SetName("numbers")
        array.SetNumberOfValues(len(ids))
        for i, number in enumerate(ids):
            array.SetValue(i, number)
        data.GetPointData().SetGlobalIds(array)
    for name, values in arrays:
        if values.dtype.kind == "U":
            array = vtkStringArray()
            for value in values:
                array.InsertNextValue(str(value))
        else:
            array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    return data


def updated(algorithm, data, alone, **properties):
    """A filter after its update, and its messages."""
    algorithm.SetNumberOfThreads(1)
    algorithm.SetInputData(data)
    messages = []

    def note(_caller, event, text):
        messages.append((event, text.split("): ", 1)[1].strip()))  # without the address

    note.CallDataType = "string0"
    algorithm.AddObserver("ErrorEvent", note)
    algorithm.AddObserver("WarningEvent", note)
    for name, value in properties.items():
        getattr(algorithm, "Set" + name)(value)
    algorithm.UpdatePiece(*(0, 1, 0) if alone else (RANK, COUNT, 0))
    return algorithm, messages


def triangulate(data, alone, **properties):
    return updated(vtkGridDelaunay2D(), data, alone, **properties)


def values_of(array):
    """The values of an array, as a list of what can be compared."""
    if isinstance(array, vtkStringArray):
        return [array.GetValue(i) for i in range(array.GetNumberOfValues())]
    values = vtk_to_numpy(array)
    return [repr(value) for value in values.tolist()]


def turned(triangles):
    """Triangles from their least id on, as a list."""
    first = numpy.argmin(triangles, axis=1)
    rows = numpy.arange(len(triangles))
    return list(map(tuple, numpy.stack(
        [triangles[rows, (first + i) % 3] for i in range(3)], axis=1).tolist()))


def part_of(delaunay, ids=None):
    """What a rank has made, by global ids: of the output, given, or places where all points are here."""
    output = delaunay.GetOutput()
    data, count = output.GetPointData(), output.GetNumberOfPoints()
    ghosts = numpy.zeros(count, int)
    if ids is None and data.GetGlobalIds():
        ids = vtk_to_numpy(data.GetGlobalIds())
    elif ids is None:
        ids = numpy.arange(count)
    if data.GetArray("vtkGhostType"):
        ghosts = vtk_to_numpy(data.GetArray("vtkGhostType"))
    part = {"ids": ids.tolist(), "ghosts": ghosts.tolist(), "triangles": [], "unused": []}
    if output.GetNumberOfPolys():
        corners = vtk_to_numpy(output.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        part["triangles"] = turned(ids[corners])
    unused = output.GetFieldData().GetArray("UnusedPointIds")
    reasons = output.GetFieldData().GetArray("UnusedPointReasons")
    for i in range(unused.GetNumberOfTuples() if unused else 0):
        part["unused"].append((int(ids[unused.GetValue(i)]), reasons.GetValue(i)))
    part["points"] = values_of(output.GetPoints().GetData()) if count else []
    part["type"] = output.GetPoints().GetDataType() if count else None
    part["arrays"] = {data.GetArrayName(i): values_of(data.GetAbstractArray(i))
                      for i in range(data.GetNumberOfArrays())
                      if data.GetArrayName(i) not in ("vtkGhostType", "GlobalPointIds")}
    found = output.GetFieldData().GetArray("Lattice")
    part["counts"] = (delaunay.GetNumberOfDuplicatePoints(), delaunay.GetNumberOfNonFinitePoints(),
                      delaunay.GetNumberOfConstraintCrossings(), delaunay.GetNumberOfAddedPoints(),
                      delaunay.GetLatticeFound())
    part["lattice"] = found and found.GetTuple(0)
    work = output.GetFieldData().GetArray("WorkOfRank")
    part["own"] = work and int(work.GetComponent(0, 0))
    return part


def check_union(parts, whole, claim):
    """Compares what all ranks have made with what one has."""
    owned = {}
    for part in parts:
        for i, number in enumerate(part["ids"]):
            values = [part["points"][i]] + [part["arrays"][name][i] for name in sorted(part["arrays"])]
            if not part["ghosts"][i]:
                check(number not in owned, "%s: point %d has one owner" % (claim, number))
                owned[number] = values
    expected = {number: [whole["points"][i]] + [whole["arrays"][name][i] for name in sorted(whole["arrays"])]
                for i, number in enumerate(whole["ids"])}
    check(owned == expected, claim + ": points and their values are those of one rank")
    for part in parts:
        own = [number for number, flag in zip(part["ids"], part["ghosts"]) if not flag]
        check(own == sorted(own), claim + ": points are in the order of their ids")
        check(part["own"] in (None, len(own)), claim + ": the number of own points is told")
        ghosts = [i for i, flag in enumerate(part["ghosts"]) if flag]
        check(ghosts == list(range(len(part["ids"]) - len(ghosts), len(part["ids"]))),
              claim + ": points of other ranks come last")
        for i in ghosts:
            values = [part["points"][i]] + [part["arrays"][name][i] for name in sorted(part["arrays"])]
            check(part["ghosts"][i] == 1 and values == expected[part["ids"][i]],
                  "%s: point %d is the owner's" % (claim, part["ids"][i]))
        used = {corner for triangle in part["triangles"] for corner in triangle}
        check(all(part["ids"][i] in used for i in ghosts), claim + ": points of other ranks are corners")
        check(part["counts"] == whole["counts"], "%s: counts %s, not %s" % (claim, part["counts"], whole["counts"]))
        check(not part["ids"] or part["lattice"] == whole["lattice"], claim + ": the lattice")
        check(part["type"] in (None, whole["type"]), claim + ": the type of points")
    triangles = [triangle for part in parts for triangle in part["triangles"]]
    check(len(triangles) == len(set(triangles)), claim + ": each triangle is on one rank")
    check(set(triangles) == set(whole["triangles"]),
          "%s: %d triangles are the %d of one rank" % (claim, len(triangles), len(whole["triangles"])))
    unused = [point for part in parts for point in part["unused"]]
    check(sorted(unused) == sorted(whole["unused"]), claim + ": each unused point is told once")


def compare(claim, coordinates, owners, ids=None, arrays=(), **properties):
    """Triangulates a cloud on all ranks, and on rank 0 alone. All ranks have the same arguments.

    Without ids, points are numbered rank by rank, and by their places on each.
    """
    mine = numpy.flatnonzero(owners == RANK)
    if ids is not None and len(set(owners)) == 1:
        mine = mine[numpy.argsort(ids[mine])]  # on one rank, places decide, not ids
    order = numpy.argsort(owners, kind="stable") if ids is None else numpy.argsort(ids, kind="stable")
    part, messages = triangulate(
        cloud(coordinates[mine], None if ids is None else ids[mine], [(n, a[mine]) for n, a in arrays]), False,
        **properties)
    check(RANK == 0 or not messages, "%s: rank %d is silent: %s" % (claim, RANK, messages))
    parts = WORLD.gather(part_of(part))
    if RANK == 0:
        numbers = numpy.arange(len(order)) if ids is None else ids[order]
        given = arrays if ids is None else (("numbers", ids),) + tuple(arrays)
        whole, expected = triangulate(
            cloud(coordinates[order], None, [(n, a[order]) for n, a in given]), True, **properties)
        check(messages == expected, "%s: messages %s, not %s" % (claim, messages, expected))
        check_union(parts, part_of(whole, numbers[:whole.GetOutput().GetNumberOfPoints()]), claim)


def check_given_lattice(random):
    """A given lattice is that of all ranks; of the points beside it, the first is told."""
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
        unfit = [("beside the lattice", nodes + [5.0, 0.0, 0.0], given),
                 ("two on a node", numpy.vstack((nodes, nodes[-1:] + [0.01, 0.0, 0.0])), given),
                 ("too unequal steps", nodes, (612000.0, 6073000.0, 20.0, 15.0, -9e-9, 12e-9)),
                 ("steps on a line", nodes, given[:4] + (40.0, 30.0))]
        beside = nodes.copy()
        beside[random.integers(len(nodes), size=3), :2] += [3.0, 1.0]
        unfit.append(("some beside the lattice", beside, given))
        for claim, points, lattice in unfit:
            compare(claim, points, random.integers(COUNT, size=len(points)), None, Lattice=lattice)
    nodes = turned_nodes[:40]
    compare("a line of the given lattice", nodes, numpy.arange(40) % COUNT, None, Lattice=given)
    compare("no finite point", nodes * numpy.nan, numpy.arange(40) % COUNT, None, Lattice=given)


def check_elevation_error(random):
    """With an elevation error, the points are gathered on one rank; all tell the counts."""
    points = random.random((2000, 3))
    owners = owners_of(random, len(points))
    for error in (0.2, -1.0):
        spread, messages = triangulate(cloud(points[owners == RANK]), False, MaximumElevationError=error)
        alone, expected = triangulate(
            cloud(numpy.concatenate([points[owners == rank] for rank in range(COUNT)])), True,
            MaximumElevationError=error)
        check(messages == (expected if RANK == 0 else []), "elevation error %s: %s" % (error, messages))
        triangles = WORLD.allgather(spread.GetOutput().GetNumberOfPolys())
        check(sorted(triangles)[-1] == sum(triangles) == alone.GetOutput().GetNumberOfPolys(),
              "elevation error: %s triangles are on one rank" % triangles)
        for name in ("NumberOfRedundantPoints", "LargestElevationError"):
            check(getattr(spread, "Get" + name)() == getattr(alone, "Get" + name)(), name)


def owners_of(random, count):
    """Which rank has which point: drawn, in stretches, in rows, on few ranks, on one but for a point."""
    kind = random.integers(5)
    if kind == 0 or count < COUNT:
        return random.integers(COUNT, size=count)
    if kind == 1:
        return numpy.sort(random.integers(COUNT, size=count))
    if kind == 2:
        return numpy.arange(count) % COUNT
    if kind == 3:
        return random.choice(random.integers(COUNT, size=max(1, COUNT // 2)), size=count)
    owners = numpy.full(count, random.integers(COUNT))
    owners[random.integers(count)] = random.integers(COUNT)
    return owners


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
    """Nodes of a lattice along the axes or turned, some missing; sometimes a point beside them."""
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


def compare_random(random, claim):
    """Compares one cloud, drawn with what else can be drawn."""
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
        arrays = (("whole", random.integers(-9, 9, count).astype(numpy.int16)),
                  ("vector", random.random((count, 3))),
                  ("text", numpy.array(["t" * (i % 4) + str(i) for i in range(count)], dtype="U")))
    limit = random.choice([0.0, 0.0, 0.05, 1.5, 30.0])
    compare(claim, coordinates, owners_of(random, count), ids, arrays,
            DuplicatePolicy=int(random.integers(POLICIES)), MaximumEdgeLength=float(limit),
            LatticeMode=int(random.random() < 0.3))


def check_stops(random, count, share, make):
    """Progress rises; an abort on one rank, at any moment, ends all of them, and one rank tells of it.

    share  the part of the progress in which it comes
    make   make(i) -> a filter with its input
    Returns how many reports followed at most on the rank that asked for it.
    """
    later, reached = [], 0
    for i in range(count):
        at, culprit = share * random.random(), random.integers(COUNT)
        algorithm = make(i)
        algorithm.SetNumberOfThreads(1)
        begun, told_of, progress = [], [], []

        def stop(caller, _event):
            progress.append(caller.GetProgress())
            if RANK == culprit and caller.GetProgress() >= at and not begun:
                begun.append(len(progress))
                caller.SetAbortExecute(1)

        algorithm.AddObserver("ProgressEvent", stop)
        algorithm.AddObserver("WarningEvent", lambda *_: told_of.append("warning"))
        algorithm.AddObserver("ErrorEvent", lambda *_: told_of.append("error"))
        WORLD.barrier()
        algorithm.UpdatePiece(RANK, COUNT, 0)
        check(progress == sorted(progress), "progress rises on rank %d" % RANK)
        followed = WORLD.bcast(len(progress) - begun[0] if begun else None, int(culprit))
        if followed is not None:
            reached += 1
            later.append(followed)
            check(followed <= MOST_AFTER_ABORT, "%d reports after abort %d" % (followed, i))
            check(algorithm.GetOutput().GetNumberOfPoints() == 0, "rank %d is empty after abort %d" % (RANK, i))
            check(told_of == ["warning"] * (RANK == 0), "rank %d: %s of abort %d" % (RANK, told_of, i))
    check(reached > count // 2, "%d of %d aborts have come to pass" % (reached, count))
    return max(later, default=0)


def check_aborts(random, count, size, **properties):
    def make(_):
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(cloud(random.random((size, 3))[RANK::COUNT]))
        for name, value in properties.items():
            getattr(delaunay, "Set" + name)(value)
        return delaunay

    return check_stops(random, count, 0.9, make)  # the last tenth is one rank's own


def check_refused(data, part, claim, **properties):
    """One error of all ranks, by rank 0, and nothing on any."""
    delaunay, messages = triangulate(data, False, **properties)
    check(len(messages) == (RANK == 0) and (RANK > 0 or part in messages[0][1]),
          "rank %d, %s: one error with %r, not %s" % (RANK, claim, part, messages))
    check(delaunay.GetOutput().GetNumberOfPoints() == 0, "rank %d, %s: no point" % (RANK, claim))


def check_errors(random):
    """What is wrong on one rank, or between them, is an error on all."""
    if COUNT == 1:
        return
    for culprit in range(min(COUNT, 3)):
        data = cloud(random.random((COUNT, 50, 3))[RANK], None, [("short", numpy.zeros(50 if RANK != culprit else 49))])
        check_refused(data, 'On rank %d: Point array "short" has 49 tuples' % culprit, "a short array")
    # Two points of one part of the plane have the same id.
    corner = numpy.array([[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.001, 0.0]])
    check_refused(cloud(corner + [1e-5 * RANK, 0.0, 0.0], numpy.array([7, 7 + COUNT, 8 + COUNT + RANK, 9 + 3 * COUNT + RANK])),
                  "have the same global id, 7", "ids of several points")


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
    compare("points on every other rank", coordinates, 2 * random.integers((COUNT + 1) // 2, size=1500))
    compare("a point on each rank", coordinates[:COUNT], numpy.arange(COUNT))
    compare("two points", coordinates[:2], numpy.arange(2) % COUNT)
    compare("no point", coordinates[:0], numpy.zeros(0, int))


def end(done):
    """Ends the test of all ranks."""
    failures = sum(WORLD.allgather(len(FAILURES)))
    if RANK == 0:
        print("%d ranks, %s: %d failures" % (COUNT, done, failures))
    sys.exit(1 if failures else 0)


def options_of(clouds, aborts):
    """The options of the command line, with these defaults."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--clouds", type=int, default=clouds)
    parser.add_argument("--aborts", type=int, default=aborts)
    parser.add_argument("--size", type=int, default=20000, help="points of a cloud that is aborted")
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def main():
    options = options_of(30, 4)
    check_kinds()
    random = numpy.random.default_rng(options.seed)
    check_errors(random)
    check_given_lattice(random)
    check_elevation_error(random)
    for i in range(options.clouds):
        compare_random(random, "cloud %d of seed %d" % (i, options.seed))
    most = check_aborts(random, options.aborts, options.size)
    end("%d clouds, %d aborts (%d reports after one at most)" % (options.clouds, options.aborts, most))


if __name__ == "__main__":
    main()
