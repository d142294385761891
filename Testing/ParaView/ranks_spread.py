# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points and triangles that are spread over ranks give what they give on one rank: the surface, its
arrays, counts and messages. And the tests of Testing/Python, with the package that the plugin brings: ranks
exchange as those of python3 do. A part of TestRanks.py.
"""
import resource

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import (
    vtkImageData, vtkMultiBlockDataSet, vtkPartitionedDataSet, vtkPolyData, vtkRectilinearGrid, vtkTable,
    vtkUnstructuredGrid)

from plugin_testing import alone, data_source, information, update
import meshes
from meshes import array_of
from on_ranks import COUNT, LAST, RANK, check, check_equal, gather

import TestExchanges  # the plugin brings the package
import TestSpreadChain

EMPTY = vtkPolyData()
random = numpy.random.default_rng(11)
XYZ = random.uniform(0.0, 30.0, (600, 3))
XYZ = XYZ[numpy.hypot(XYZ[:, 0] - 12, XYZ[:, 1] - 14) > 4]
XYZ = numpy.vstack((XYZ, XYZ[:3] + [0, 0, 1], [[numpy.nan, 1, 1]]))  # three duplicates, one not finite
ANGLES = numpy.linspace(0.0, 2.0 * numpy.pi, 8, endpoint=False)
RING = meshes.rings([numpy.stack((15 + 11 * numpy.cos(ANGLES), 15 + 11 * numpy.sin(ANGLES)), axis=1)])


def arrays_of(rows):
    return (("Amplitude", 2.0 * XYZ[rows, 2]), ("Name", numpy.array(["p%d" % row for row in rows], dtype="U")))


def cloud(rows, ids=True, kind=vtkPolyData):
    """Some of the points, with an array of numbers and one of names."""
    rows = numpy.asarray(rows, dtype=int)
    return meshes.cloud(XYZ[rows], rows if ids else None, arrays_of(rows), kind)


def piece(mesh, triangles, ids=True, ghosts=()):
    """Some triangles of a mesh with the points that they use; ghosts: triangles of other ranks."""
    triangles = numpy.append(triangles, ghosts).astype(int)
    corners = meshes.triangles_of(mesh)[triangles]
    rows = numpy.unique(corners)
    data = meshes.mesh(XYZ[rows], numpy.searchsorted(rows, corners), rows if ids else None, arrays_of(rows),
                       [("Triangle", triangles)])
    if len(ghosts):
        own = len(triangles) - len(ghosts)
        for attributes, marks in ((data.GetCellData(), numpy.arange(len(triangles)) >= own),
                                  (data.GetPointData(), ~numpy.isin(rows, corners[:own]))):
            attributes.AddArray(array_of(marks.astype("u1") * meshes.DUPLICATE, meshes.GHOSTS))
    return data


def check_same(mesh, expected, claim):
    """The triangles of all ranks together are those of one, each once, and so are the points."""
    found = meshes.sorted_rows(numpy.vstack(gather(meshes.by_places(mesh))))
    wanted = meshes.by_places(expected)
    check_equal(found.shape, wanted.shape, "triangles, " + claim)
    check(found.shape == wanted.shape and numpy.allclose(found, wanted, 0, 1e-9), "the same triangles, " + claim)
    owned = int(numpy.count_nonzero(~meshes.ghosts_of(mesh)))
    check_equal(sum(gather(owned)), expected.GetNumberOfPoints(), "points, " + claim)


def check_points(mesh, ids, claim):
    """Values of the points stay with them; on ranks without points, arrays are empty."""
    data, names = mesh.GetPointData(), mesh.GetPointData().GetAbstractArray("Name")
    check(names and data.HasArray("Amplitude") and (not ids or data.GetGlobalIds()),
          "arrays, " + claim)
    for i in range(0, mesh.GetNumberOfPoints(), 7):
        row = int(names.GetValue(i)[1:])
        check(numpy.array_equal(mesh.GetPoint(i), XYZ[row], equal_nan=True)
              and numpy.array_equal(data.GetArray("Amplitude").GetValue(i), 2 * XYZ[row, 2])
              and (not ids or data.GetGlobalIds().GetValue(i) == row),
              "values of point %d, %s" % (i, claim))


def check_told(messages, part, claim):
    """One message of all ranks, which the first prints."""
    check_equal(len(messages), 1 if part and RANK == 0 else 0, "messages %s, %s" % (messages, claim))
    check(not messages or part in messages[0][1], "%s: %r in %s" % (claim, part, messages))


ALL = numpy.arange(len(XYZ))
WHOLE = alone(simple.GridDelaunay2D(Input=data_source(cloud(ALL))))[0]
check(WHOLE.GetNumberOfPolys() > 900 and WHOLE.GetFieldData().GetArray("UnusedPointIds").GetNumberOfTuples() == 4,
      "each rank for itself makes a surface, and leaves four points")

# Points, in any distribution. Without ids they are taken rank after rank, so that these are in order.
spreads = {
    "slices": numpy.array_split(ALL, COUNT),
    "in no order": numpy.array_split(random.permutation(ALL), COUNT),
    "two points apart from all others": [ALL[2:]] + [[]] * (COUNT - 2) + [ALL[:2]],
}
for claim, rows in spreads.items():
    for ids in (True, False) if claim == "slices" else (True,):
        kind = vtkUnstructuredGrid if claim == "slices" and ids else vtkPolyData
        source = simple.GridDelaunay2D(Input=data_source(cloud(rows[RANK], ids, kind)))
        messages, (mesh,) = update(source)
        check_told(messages, "", claim)
        check_same(mesh, WHOLE, claim)
        check_points(mesh, ids, claim)
        counts = [information(source, "NumberOf%sPoints" % kind) for kind in ("Duplicate", "NonFinite")]
        check_equal(counts, [3, 1], "counts, " + claim)
        unused = mesh.GetFieldData().GetArray("UnusedPointIds")
        unused = [int(mesh.GetPointData().GetAbstractArray("Name").GetValue(unused.GetValue(i))[1:])
                  for i in range(unused.GetNumberOfTuples())]
        check_equal(sorted(sum(gather(unused), [])), list(ALL[-4:]), "unused points, " + claim)

# Points that other ranks have, too: each counts once.
for ids in (True, False):
    rows = numpy.array_split(ALL[:-4], COUNT)
    mine = cloud(numpy.append(rows[RANK], rows[RANK - 1][:9]), ids)
    marks = numpy.arange(mine.GetNumberOfPoints()) >= len(rows[RANK])
    mine.GetPointData().AddArray(array_of(marks.astype("u1") * meshes.DUPLICATE, meshes.GHOSTS))
    source = simple.GridDelaunay2D(Input=data_source(mine))
    messages, (mesh,) = update(source)
    check_same(mesh, alone(simple.GridDelaunay2D(Input=data_source(cloud(ALL[:-4]))))[0], "points of other ranks")
    check_equal(information(source, "NumberOfDuplicatePoints"), 0, "points of other ranks are not duplicates")

# Triangles: the common points of ranks are one. Ghosts are left out.
used = numpy.unique(meshes.triangles_of(WHOLE))
BARE = piece(WHOLE, numpy.arange(WHOLE.GetNumberOfPolys()))
owner = random.integers(0, COUNT, WHOLE.GetNumberOfPolys())
owner[: len(owner) // 2] = 0  # which has most
here = numpy.flatnonzero(owner == RANK)
for ids in (True, False):
    next_rank = numpy.flatnonzero(owner == (RANK + 1) % COUNT)[:50]
    for ghosts in ((), next_rank):
        claim = "%s, %d ghosts" % ("ids" if ids else "no ids", len(ghosts))
        mine = piece(WHOLE, here, ids, ghosts)
        trim = simple.TrimOutwardTriangles(Input=data_source(mine), Boundary=data_source(RING if RANK == LAST else EMPTY))
        alike = simple.TrimOutwardTriangles(Input=data_source(BARE), Boundary=data_source(RING))
        messages, outputs = update(trim)
        expected = alone(alike)
        check_told(messages, "", "trim, " + claim)
        for port in range(3):
            check_same(outputs[port], expected[port], "trim, output %d, %s" % (port, claim))
        check_equal((information(trim, "NumberOfOutwardTriangles"), information(trim, "NumberOfInsertedPoints")),
                    (expected[1].GetNumberOfPolys(),
                     expected[0].GetFieldData().GetArray("NumberOfInsertedPoints").GetValue(0)),
                    "counts of trim, " + claim)
        long = 3.0  # of the triangles over the gap
        fill = simple.FillElevationHoles(Input=data_source(mine), OpenEdgeLength=long, Interpolation="Membrane")
        messages, outputs = update(fill)
        expected = alone(simple.FillElevationHoles(Input=data_source(BARE), OpenEdgeLength=long,
                                                   Interpolation="Membrane"))
        check_told(messages, "marked copies of triangles" if len(ghosts) else "", "fill, " + claim)
        for port in range(2):
            check_same(outputs[port], expected[port], "fill, output %d, %s" % (port, claim))
        check_equal((information(fill, "NumberOfHoles"), information(fill, "NumberOfFilledHoles")),
                    (expected[1].GetNumberOfLines(),) * 2, "counts of fill, " + claim)
        check(outputs[0].GetNumberOfPoints() == 0 or outputs[0].GetCellData().HasArray("Triangle"),
              "cell data stay, " + claim)
        if ids:
            data, own = outputs[0].GetPointData(), ~meshes.ghosts_of(outputs[0])
            found, fresh = (sum(gather(vtk_to_numpy(array)[own].tolist() if array else []), [])
                            for array in (data.GetGlobalIds(), data.GetArray("FilledPoint")))
            check(sum(fresh) > 10, "the fill adds points: %d" % sum(fresh))
            check_equal(sorted(found), [*used, *range(used[-1] + 1, used[-1] + 1 + sum(fresh))],
                        "ids of new points follow the largest")

# The three filters in a row.
mine = data_source(cloud(spreads["in no order"][RANK]))
chain = simple.FillElevationHoles(Input=simple.TrimOutwardTriangles(Input=simple.GridDelaunay2D(Input=mine)))
expected = simple.FillElevationHoles(
    Input=simple.TrimOutwardTriangles(Input=simple.GridDelaunay2D(Input=data_source(cloud(ALL)))))
messages, outputs = update(chain)
check_told(messages, "", "filters in a row")
check_same(outputs[0], alone(expected)[0], "filters in a row")

# The whole chain, of points, tables and grids: one surface, and one report, on the first rank.
def table(rows):
    data = vtkTable()
    for i, name in enumerate(("easting", "northing", "z")):
        data.AddColumn(array_of(XYZ[rows, i], name))
    return data


def grid(kind, first, last):
    """Some rows of a grid, with a gap; neighbours have a row in common."""
    data = kind()
    data.SetExtent(3, 40, int(first), int(last), 0, 0)
    x, y = numpy.arange(3, 41.0), numpy.arange(first, last + 1.0)
    if kind is vtkRectilinearGrid:
        data.SetXCoordinates(numpy_to_vtk(x ** 1.1, deep=True))
        data.SetYCoordinates(numpy_to_vtk(y * 2.0, deep=True))
        data.SetZCoordinates(numpy_to_vtk(numpy.zeros(1), deep=True))
    z = numpy.hypot(x, y[:, None])
    z[(z > 20) & (z < 24)] = -9999
    data.GetPointData().SetScalars(array_of(z.ravel(), "Depth"))
    return data


cuts = numpy.linspace(0, 30, COUNT + 1).round()
slice_of_mine, order = spreads["slices"][RANK], spreads["in no order"][RANK]
for claim, mine, whole in (
        ("points", cloud(order), cloud(ALL)),
        ("points without ids", cloud(slice_of_mine, False), cloud(ALL, False)),
        ("table", table(slice_of_mine), table(ALL)),
        ("image", grid(vtkImageData, cuts[RANK], cuts[RANK + 1]), grid(vtkImageData, 0, 30)),
        ("grid", grid(vtkRectilinearGrid, cuts[RANK], cuts[RANK + 1]), grid(vtkRectilinearGrid, 0, 30))):
    source = simple.ReconstructElevationSurface(Input=data_source(mine))
    alike = simple.ReconstructElevationSurface(Input=data_source(whole))
    messages, outputs = update(source)
    expected = alone(alike)
    twice = "3 places have several heights" if claim.startswith(("points", "table")) else ""
    check_told(messages, twice, "chain, " + claim)
    check_same(outputs[0], expected[0], "chain, " + claim)
    check_equal([outputs[0].GetPointData().HasArray(expected[0].GetPointData().GetArrayName(i))
                 for i in range(expected[0].GetPointData().GetNumberOfArrays())
                 if outputs[0].GetNumberOfPoints()].count(0), 0, "arrays, chain, " + claim)
    check_equal(information(source, "Report"), information(alike, "Report"), "report, " + claim)
    check_equal(outputs[3].GetNumberOfRows(), expected[3].GetNumberOfRows() if RANK == 0 else 0,
                "rows of the report, " + claim)
messages, outputs = update(simple.ReconstructElevationSurface(
    Input=data_source(table(slice_of_mine) if RANK == LAST else cloud(slice_of_mine))))
check_told(messages, "different kinds of it: points and tables", "kinds")
check_equal(outputs[0].GetNumberOfPoints(), 0, "points of different kinds")

# Blocks and partitions.
whole = cloud(ALL) if RANK == LAST else EMPTY
mine = vtkMultiBlockDataSet()
for i, block in enumerate((whole, cloud(spreads["slices"][RANK]))):
    mine.SetBlock(i, block)
mine.GetMetaData(1).Set(mine.NAME(), "north")
messages, (blocks,) = update(simple.GridDelaunay2D(Input=data_source(mine)))
check_told(messages, "", "blocks")
for i in range(2):
    check_same(blocks.GetBlock(i), WHOLE, "block %d" % i)
mine.SetBlock(1, cloud(ALL[:1]) if RANK in (0, LAST) else EMPTY)
messages, _ = update(simple.GridDelaunay2D(Input=data_source(mine)))
check_told(messages, 'Block 1 ("north"): No triangle was made: the 1 input points', "two ranks with one point")
parts = vtkPartitionedDataSet()
for i, rows in enumerate(numpy.array_split(spreads["in no order"][RANK], 2)):
    parts.SetPartition(i, cloud(rows))
messages, (parts,) = update(simple.GridDelaunay2D(Input=data_source(parts)))
check_told(messages, "", "partitions")
check_same(parts.GetPartition(0), WHOLE, "partitions of all ranks are one surface")
check_equal(parts.GetPartition(1).GetNumberOfPolys(), 0, "triangles of the second partition")

# What is wrong on one rank is reported by the first, and leaves nothing on any.
wrong = piece(WHOLE, here)
if RANK == LAST:
    wrong.GetPolys().ReplaceCellAtId(3, 3, [0, 1, 100000])
short = cloud(spreads["slices"][RANK])
short.GetPointData().GetArray("Amplitude").SetNumberOfTuples(5 if RANK == LAST else short.GetNumberOfPoints())
for make, data, part in (
        (simple.TrimOutwardTriangles, wrong, "On rank %d: Cell 3 names point 100000" % LAST),
        (simple.FillElevationHoles, wrong, "On rank %d: Cell 3 names point 100000" % LAST),
        (simple.GridDelaunay2D, short, 'On rank %d: Point array "Amplitude" has 5' % LAST)):
    messages, outputs = update(make(Input=data_source(data)))
    check_told(messages, part, "wrong input")
    check_equal([output.GetNumberOfPoints() for output in outputs], [0] * len(outputs),
                "points after an error")
bare = cloud(spreads["slices"][RANK])
if RANK == LAST:
    bare.GetPointData().RemoveArray("Amplitude")
messages, (mesh,) = update(simple.GridDelaunay2D(Input=data_source(bare)))
check_told(messages, 'the point array "Amplitude"', "an array that one rank lacks")
check_equal(sum(gather(mesh.GetNumberOfPolys())), WHOLE.GetNumberOfPolys(), "triangles without an array")

# A stop on one rank stops all of them.
for make, data in ((simple.GridDelaunay2D, cloud(spreads["slices"][RANK])), (simple.FillElevationHoles, piece(WHOLE, here))):
    for stopped in (0, LAST):
        source = make(Input=data_source(data))
        if RANK == stopped:
            algorithm = source.SMProxy.GetClientSideObject()
            algorithm.AddObserver("ProgressEvent", lambda caller, _: caller.SetAbortExecute(1))
        messages, outputs = update(source)
        check_told(messages, "Stopped", "a stop on rank %d of %s" % (stopped, source.SMProxy.GetXMLName()))
        check_equal([output.GetNumberOfPoints() for output in outputs], [0] * len(outputs),
                    "points after a stop")

MORE = [TestExchanges.main(), TestSpreadChain.main()]
