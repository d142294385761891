# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""On several ranks, points and triangles that are spread over them give the surface of one rank, and
messages come once, from rank 0. Run by mpirun with pvbatch --symmetric: all ranks run this script,
and each looks at its own outputs and messages. A rank that waits in vain ends by the time-out.
"""
import numpy
from paraview import simple
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkMultiBlockDataSet, vtkPartitionedDataSet, vtkPolyData

from plugin_testing import alone, data_source, information, start, update
import meshes
from on_ranks import COUNT, LAST, RANK, check, check_equal, end

start()
CLOUD = numpy.random.default_rng(7).uniform(0.0, 30.0, (700, 3))
CLOUD = CLOUD[numpy.hypot(CLOUD[:, 0] - 12, CLOUD[:, 1] - 14) > 4]
ANGLES = numpy.linspace(0.0, 2.0 * numpy.pi, 9)
RING = numpy.stack((15 + 11 * numpy.cos(ANGLES), 15 + 11 * numpy.sin(ANGLES), 0 * ANGLES), axis=1)
RING[-1] = RING[0]


def cloud(coordinates=CLOUD):
    return meshes.cloud(coordinates)


def line(coordinates):
    return meshes.lines(coordinates, [range(len(coordinates))])


def blocks(*parts):
    """A multiblock; the last block is called north."""
    data = vtkMultiBlockDataSet()
    data.SetNumberOfBlocks(len(parts))
    for i, part in enumerate(parts):
        data.SetBlock(i, part)
    if parts:
        data.GetMetaData(len(parts) - 1).Set(data.NAME(), "north")
    return data


def check_silent(messages, claim):
    check_equal(messages, [], "messages, " + claim)


def check_refused(source, part, claim):
    """One error, on rank 0, and empty outputs."""
    messages, outputs = update(source)
    if RANK == 0:
        check(len(messages) == 1 and messages[0][0] == "ErrorEvent" and part in messages[0][1],
              "%s, one error with %r: %s" % (claim, part, messages))
    else:
        check_silent(messages, claim)
    for output in outputs:
        cells = output.GetNumberOfElements(1)
        check_equal(cells, 0, "cells after an error, " + claim)


WHOLE = alone(simple.GridDelaunay2D(Input=data_source(cloud())))[0]  # on every rank, though each makes it for itself
check(WHOLE.GetNumberOfPolys() > 1000, "each rank for itself makes a surface")
EMPTY = vtkPolyData()
FILTERS = (
    ("reconstruct", simple.ReconstructElevationSurface, cloud()),
    ("delaunay", simple.GridDelaunay2D, cloud()),
    ("trim", simple.TrimOutwardTriangles, WHOLE),
    ("fill", simple.FillElevationHoles, WHOLE),
)

for name, make, data in FILTERS:
    for full in {0, LAST}:
        messages, outputs = update(make(Input=data_source(data if RANK == full else EMPTY)))
        check_silent(messages, "%s, points on rank %d" % (name, full))
        check_equal(outputs[0].GetNumberOfPolys() > 900, RANK == full,
                    "%s: triangles where the points are" % (name))
    messages, outputs = update(make(Input=data_source(EMPTY)))
    check_equal(len(messages), 1 if RANK == 0 and name == "reconstruct" else 0,
                "%s, messages on no points at all" % (name))

# Results are those of all ranks, on all ranks.
twice = simple.GridDelaunay2D(Input=data_source(cloud(numpy.vstack((CLOUD, CLOUD[:5]))) if RANK == LAST else EMPTY))
update(twice)
check_equal(information(twice, "NumberOfDuplicatePoints"), 5, "the count of duplicates")


def trimmed(boundary, mesh):
    return simple.TrimOutwardTriangles(Input=data_source(mesh), Boundary=data_source(boundary))


# A boundary may be on another rank than the surface, or in pieces on several.
pieces = numpy.array_split(numpy.arange(len(RING) - 1), COUNT)
PIECE = RING[numpy.append(pieces[RANK], pieces[RANK][-1] + 1)]
expected = update(trimmed(line(RING) if RANK == 0 else EMPTY, WHOLE if RANK == 0 else EMPTY))[1]
kept = (expected[0].GetNumberOfPolys(), expected[1].GetNumberOfPolys())
check(RANK > 0 or min(kept) > 100, "the ring divides the surface: %s" % (kept,))
whole_here = WHOLE if RANK == 0 else EMPTY
for claim, boundary in (("on the last rank", line(RING) if RANK == LAST else EMPTY), ("in pieces", line(PIECE)),
                        ("on each rank", line(RING))):
    messages, outputs = update(trimmed(boundary, whole_here))
    check_silent(messages, "boundary " + claim)
    check_equal((outputs[0].GetNumberOfPolys(), outputs[1].GetNumberOfPolys()), kept,
                "triangles with the boundary %s" % claim)
check_equal(update(simple.GridDelaunay2D(Input=data_source(cloud() if RANK == 0 else EMPTY),
                                         Constraints=data_source(line(PIECE))))[1][0].GetNumberOfPoints(),
            len(CLOUD) + len(RING) - 1 if RANK == 0 else 0, "points with lines in pieces")
whole_chain = [
    update(simple.ReconstructElevationSurface(Input=data_source(cloud() if RANK == 0 else EMPTY), Boundary=data_source(ring)))[1]
    for ring in (line(RING) if RANK == 0 else EMPTY, line(PIECE), line(RING))]
for claim, outputs in zip(("in pieces", "on each rank"), whole_chain[1:]):
    check_equal(outputs[0].GetNumberOfPolys(), whole_chain[0][0].GetNumberOfPolys(),
                "triangles of the whole chain with the boundary %s" % claim)
check_equal(whole_chain[1][0].GetNumberOfPolys() > 100, RANK == 0, "the whole chain has triangles")
# What is wrong with the second input of one rank is an error on all.
table = blocks(vtkImageData()) if RANK == LAST else EMPTY
check_refused(trimmed(table, whole_here), "vtkImageData", "a boundary that is an image")
check_refused(simple.ReconstructElevationSurface(Input=data_source(cloud() if RANK == 0 else EMPTY), Boundary=data_source(table)),
              "lines or polygons", "a boundary of the chain that is an image")

# Blocks may live on different ranks, which have different numbers of them; a block may not.
mine = blocks(*[cloud() if RANK == i else None for i in range(RANK + 1)])
messages, outputs = update(simple.GridDelaunay2D(Input=data_source(mine)))
check_silent(messages, "a block on each rank")
check_equal(outputs[0].GetBlock(RANK).GetNumberOfPolys(), WHOLE.GetNumberOfPolys(),
            "triangles of its block")
none = blocks(cloud()) if RANK == 0 else blocks()
check_silent(update(simple.GridDelaunay2D(Input=data_source(none)))[0], "a block on one rank, none on others")


# The report of the whole chain is that of all ranks: the text on each, rows and messages on the first.
def check_report(source, present, missing, messages, claim):
    """present, missing: lines that the report has once, or not; messages: parts of the first rank's."""
    found, outputs = update(source)
    found = [text for _, text in found]
    for part in messages if RANK == 0 else []:
        check(any(part in text for text in found), "%s: no message %r: %s" % (claim, part, found))
    check_equal(len(found), len(messages) if RANK == 0 else 0, "messages, " + claim)
    report = information(source, "Report").split("\n")
    for line in present:
        check_equal(report.count(line), 1, "%s: %r in the report %s" % (claim, line, report))
    for part in missing:
        check(part not in "".join(report), "%s: %r is in the report" % (claim, part))
    check_equal(outputs[3].GetNumberOfRows() > 8, RANK == 0 and bool(present), "rows of the report, " + claim)
    return outputs


read = "points     %s read" % len(CLOUD)
names = ["Block %d:" % i for i in range(COUNT - 1)] + ['Block %d ("north"):' % LAST]
mine = [cloud() if RANK == i else EMPTY for i in range(COUNT)]
check_report(simple.ReconstructElevationSurface(Input=data_source(blocks(*mine))),
             ["all blocks:", "points     {:,} read".format(COUNT * len(CLOUD)), *names], [], [],
             "a block on each rank")
check_report(simple.ReconstructElevationSurface(Input=data_source(cloud() if RANK == LAST else EMPTY)),
             [read], ["Block"], [], "points on the last rank")
far = cloud(CLOUD[:2]) if RANK == LAST else mine[RANK]
outputs = check_report(
    simple.ReconstructElevationSurface(Input=data_source(blocks(*mine[:RANK], far, *mine[RANK + 1:]))),
    [names[0], names[LAST]], [], [names[LAST]], "a block of two points on the last rank")
check_equal(outputs[0].GetBlock(RANK).GetNumberOfPolys() > 900, RANK < LAST,
            "triangles besides a block of two points")
check_report(simple.ReconstructElevationSurface(Input=data_source(blocks(*mine)), Spacing=-1), [], ["Block"],
             ["Spacing takes"], "a wrong property")
check_report(simple.ReconstructElevationSurface(Input=data_source(blocks(*mine)), GapTolerance=1),
             names, [], ["leaves out"] * COUNT, "a warning for each block")
# What nobody expects on one rank does not hold up the others.
import vtkelevationsurface.algorithms as algorithms  # noqa: E402  (the plugin brings it)

cloud_of = algorithms.cloud_of
if RANK == LAST:
    algorithms.cloud_of = lambda *_: 1 // 0
check_refused(simple.ReconstructElevationSurface(Input=data_source(blocks(*mine))),
              "should not happen", "a fault of the program on one rank")
algorithms.cloud_of = cloud_of
# A stop on one rank stops all of them.
for make, data in ((simple.ReconstructElevationSurface, blocks(*mine)), (simple.GridDelaunay2D, blocks(*mine))):
    source = make(Input=data_source(data))
    if RANK == LAST:
        algorithm = source.SMProxy.GetClientSideObject()
        algorithm.AddObserver("ProgressEvent", lambda caller, _: caller.SetAbortExecute(1))
    _, outputs = update(source)
    check_equal([output.GetNumberOfElements(1) for output in outputs], [0] * len(outputs),
                "cells after a stop on the last rank")

messages, _ = update(simple.GridDelaunay2D(Input=data_source(blocks(None, None))))
check_silent(messages, "blocks without data sets")

# What is wrong on any rank is reported by the first, and does not hold up the others.
whole_there = WHOLE if RANK == LAST else EMPTY
messages, _ = update(simple.TrimOutwardTriangles(Input=data_source(whole_there), GapTolerance=-1.0))
check_equal(len(messages), 1 if RANK == 0 else 0, "errors of a wrong property")

wrong = vtkPolyData()
wrong.DeepCopy(WHOLE)
wrong.GetPolys().ReplaceCellAtId(3, 3, [0, 1, 100000])
messages, outputs = update(simple.TrimOutwardTriangles(Input=data_source(wrong if RANK == LAST else EMPTY)))
check_equal(len(messages), 1 if RANK == 0 else 0, "errors of a wrong cell")

# More of it, in the same processes: ParaView's start takes longer than most of these tests.
import ranks_samples  # noqa: E402,F401
import ranks_spread  # noqa: E402

end("; ".join(["blocks, boundaries and reports", "grids and profiles", "spread points", *ranks_spread.MORE]))
