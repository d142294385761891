# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The whole chain as an algorithm, of points that are spread over ranks, makes what it makes of all of them
in one process: triangles, points with their values, rings, report and messages. No rank holds more
points than others. Run by mpirun.
"""

import re

import numpy
import meshes
from on_ranks import COUNT, LAST, RANK, check, check_equal, end, gather
from outcomes import noted, numbers_of
from vtkelevationsurface.algorithms import ReconstructElevationSurface
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow
from vtkmodules.vtkCommonDataModel import (
    vtkImageData, vtkPartitionedDataSet, vtkPolyData, vtkRectilinearGrid, vtkTable, vtkUnstructuredGrid)

RANDOM = numpy.random.default_rng(23)
XYZ = RANDOM.uniform(0.0, 30.0, (900, 3)) * (1.0, 1.0, 0.2) + (0.0, 0.0, 40.0)
XYZ = XYZ[numpy.hypot(XYZ[:, 0] - 12, XYZ[:, 1] - 14) > 4]
ALL = numpy.arange(len(XYZ))
SLICES = numpy.array_split(ALL, COUNT)
ORDER = numpy.array_split(RANDOM.permutation(ALL), COUNT)
ANGLES = numpy.linspace(0.0, 2.0 * numpy.pi, 9, endpoint=False)
RING = meshes.rings([numpy.stack((15 + 11 * numpy.cos(ANGLES), 15 + 11 * numpy.sin(ANGLES)), axis=1)])
FAULT = numpy.array([(3.0, 4.0, 44.0), (20.0, 22.0, 41.0), (26.0, 8.0, 43.0)])
FAULTS = meshes.lines(FAULT, [range(3)])
BARE = meshes.lines(FAULT * (1, 1, 0), [range(3)])
EMPTY = vtkPolyData()
IDS = meshes.cloud(XYZ[:1], ALL[:1]).GetPointData().GetGlobalIds().GetName()  # of new points follow their order
ON_ONE_RANK = "is made on one rank (process), which needs memory for all of it"


def cloud(rows, xyz=XYZ, ids=True, kind=vtkPolyData, marks=None):
    rows = numpy.asarray(rows, dtype=int)
    arrays = [("Amplitude", 2.0 * xyz[rows, 2]), ("Name", numpy.array(["p%d" % row for row in rows], dtype="U"))]
    if marks is not None:
        arrays.append((meshes.GHOSTS, marks[rows].astype("u1")))
    return meshes.cloud(xyz[rows], rows if ids else None, arrays, kind)


def table(rows, xyz=XYZ):
    data = vtkTable()
    for name, values in (("station", rows), ("northing", xyz[rows, 1]), ("easting", xyz[rows, 0]),
                         ("z", numpy.array([str(z) for z in xyz[rows, 2]], dtype="U"))):
        data.AddColumn(meshes.array_of(values, name))
    return data


def grid(kind, first, last, columns=38, missing=True, thin=1):
    """Some rows of a grid; neighbours have a row in common. Nodes are missing, one has a null value, one
    an elevation far from all around."""
    data = kind()
    data.SetExtent(3, 2 + columns, int(first), int(last), 0, 0)
    x, y = numpy.arange(3, 3.0 + columns), numpy.arange(first, last + 1.0)
    if kind is vtkRectilinearGrid:
        data.SetXCoordinates(numpy_to_vtk(x ** 1.1, deep=True))
        data.SetYCoordinates(numpy_to_vtk(y * 2.0, deep=True))
        data.SetZCoordinates(numpy_to_vtk(numpy.zeros(1), deep=True))
    z = 50.0 + numpy.hypot(x, y[:, None])
    if missing:
        z[(numpy.hypot(x - 15, y[:, None] - 12) < 4)] = numpy.nan
        z[(x == 30) & (y[:, None] == 5)] = -9999
        z[(x == 30) & (y[:, None] == 21)] = 900.0
        z[(x < 9) & (y[:, None] < 6)] = -9999
    z[((x % thin) > 0) | ((y[:, None] % thin) > 0)] = numpy.nan
    data.GetPointData().SetScalars(meshes.array_of(z.ravel(), "Height"))
    return data


CUTS = numpy.linspace(0, 30, COUNT + 1).round()


def grids(kind, **more):
    return grid(kind, CUTS[RANK], CUTS[RANK + 1], **more), grid(kind, 0, 30, **more)


def changed(rows, values, column=2):
    xyz = XYZ.copy()
    xyz[rows, column] = values
    return xyz


TWICE = numpy.vstack((XYZ, XYZ[5:9] + (0, 0, 1), XYZ[5:9] + (0, 0, 3), XYZ[40:43], [[numpy.nan, 1, 1]]))
NULLS = changed([3, 90, 200, 333], -999.25)
WILD = changed([17, 250, 300], [900.0, 1e105, -700.0])
LINE = numpy.column_stack((ALL, 2.0 * ALL, ALL % 7))
HIDDEN = numpy.isin(ALL, (4, 100, 321)) * 2  # HIDDENPOINT
FLOATS = XYZ.astype("f4")


def spread(rows, make, *arguments, **more):
    """(the part of this rank, all) of a kind of data; rows: those of each rank."""
    return make(rows[RANK], *arguments, **more), make(numpy.sort(numpy.concatenate(rows)), *arguments, **more)


def all_but_one(rows):
    """The rows with none on the last rank."""
    return [*rows[:-2], numpy.sort(numpy.concatenate(rows[-2:])), ALL[:0]]


def partitions():
    whole, parts = vtkPolyData(), vtkPartitionedDataSet()
    whole.ShallowCopy(cloud(ALL))
    for i, rows in enumerate(numpy.array_split(ORDER[RANK], 2)):
        parts.SetPartition(i, cloud(rows))
    return parts, whole


def slices_of(xyz, make=cloud, **more):
    return spread(numpy.array_split(numpy.arange(len(xyz)), COUNT), make, xyz, **more)


# name: (this rank's input and all of it, properties, boundary, faults, warnings of one process, further
# warnings on ranks)
INPUTS = {
    "points": (spread(ORDER, cloud), {}, None, None, [], []),
    "points without ids": (spread(SLICES, cloud, ids=False), {}, None, None, [], []),
    "an unstructured grid": (spread(SLICES, cloud, kind=vtkUnstructuredGrid), {}, None, None, [], []),
    "one rank empty": (spread(all_but_one(SLICES), cloud), {}, None, None, [], []),
    "single precision": (slices_of(FLOATS), {}, None, None, [], []),
    "three points a rank": (slices_of(XYZ[: 3 * COUNT]), {"Trim": 0, "FillHoles": 0}, None, None, [], []),
    "a boundary": (spread(ORDER, cloud), {}, RING, None, [], []),
    "faults": (spread(ORDER, cloud), {}, None, FAULTS, ["1 of 2 edges of the faults is not in the surface"], []),
    "faults without elevations": (spread(ORDER, cloud), {"FaultsZ": "drape"}, None, BARE,
                                  ["z of its lines is left aside"], ["triangulating"]),
    "both": (spread(SLICES, cloud), {}, RING, FAULTS, [], []),
    "no trimming": (spread(ORDER, cloud), {"Trim": 0}, None, None, [], []),
    "no filling": (spread(ORDER, cloud), {"FillHoles": 0}, None, None, [], []),
    "an edge limit": (spread(ORDER, cloud), {"MaximumEdgeLength": 1.6}, None, None, None, []),
    "holes that stay": (spread(ORDER, cloud), {"MaximumHoleEdges": 3}, None, None, [], []),
    "opened triangles": (slices_of(TWICE), {"OpenEdgeLength": 3.0}, None, None, ["4 places have several"],
                         []),
    "long triangles that stay": (spread(ORDER, cloud), {"OpenEdgeLength": 2.0, "MaximumHoleEdges": 5}, None, None,
                                 None, []),
    "several heights": (slices_of(TWICE), {"Duplicates": "keep-highest"}, None, None, ["4 places have several"], []),
    "hidden points": (spread(ORDER, cloud, marks=HIDDEN), {}, None, None, [], []),
    "another array": (spread(ORDER, cloud), {"ElevationArray": "Amplitude", "Depth": 1}, None, None, [], []),
    "no data": (slices_of(changed([8, 400], -1.0)), {"NoData": "-1"}, None, None, [], []),
    "partitions": (partitions(), {}, None, None, [], []),
    "a table": (slices_of(XYZ, table), {}, None, None, [], []),
    "columns of a table": (slices_of(XYZ, table), {"Columns": "northing,easting,z"}, None, None, [], []),
    "nulls": (slices_of(NULLS, table), {}, None, None, [], []),
    "nulls that are kept": (slices_of(NULLS, table), {"KeepNulls": 1}, None, None, [], []),
    "a table and an empty rank": (spread(all_but_one(SLICES), table, NULLS), {"Depth": 1, "NoData": "41"}, RING,
                                  FAULTS, None, []),
    "points, upside down, and an empty rank": (spread(all_but_one(ORDER), cloud), {"Depth": 1, "NoData": "41"}, None,
                                               BARE, None, ["triangulating"]),
    "blunders": (slices_of(WILD, table), {"FillHoles": 0}, None, None, [], []),
    "an image": (grids(vtkImageData), {}, None, None, [], []),
    "a whole image": (grids(vtkImageData, missing=False), {}, None, None, [], []),
    "a thin image": (grids(vtkImageData, missing=False, thin=2), {}, None, None, [], []),
    "a grid": (grids(vtkRectilinearGrid), {}, None, None, [], []),
    "an elevation error": (spread(ORDER, cloud), {"MaximumElevationError": 2.0}, None, None, [], [""]),
    "a number of points": (spread(ORDER, cloud), {"MaximumNumberOfPoints": 200}, None, None, [], [""]),
}


def updated(data, properties, boundary, faults, alone):
    """(the algorithm, its messages)"""
    chain = ReconstructElevationSurface()
    messages = noted(chain)
    for port, one in enumerate((data, boundary, faults)):
        if one is not None:
            chain.SetInputDataObject(port, one)
    for name, value in properties.items():
        getattr(chain, "Set" + name)(value)
    chain.UpdatePiece(*(0, 1, 0) if alone else (RANK, COUNT, 0))
    return chain, [text for _, text in messages]


def surface_of(chain, port=0):
    data = chain.GetOutputDataObject(port)
    return data.GetPartition(0) if isinstance(data, vtkPartitionedDataSet) else data


def rows_of(data, names):
    """The points of this rank with the values of some arrays, in one order."""
    own, count = ~meshes.ghosts_of(data), data.GetNumberOfPoints()
    columns = [numpy.nan_to_num(meshes.points_of(data).astype("f8"), nan=-1e99)]
    for name in names:
        array = data.GetPointData().GetAbstractArray(name)
        columns.append(numbers_of(array) if count else numpy.zeros((0, 1)))
    return numpy.column_stack(columns)[own]


def edges_of(data):
    """The edges of lines by places of their ends, in one order."""
    ids, ends = (vtk_to_numpy(a) for a in (data.GetLines().GetConnectivityArray(), data.GetLines().GetOffsetsArray()))
    xyz = [tuple(place) for place in meshes.points_of(data)[ids].tolist()]
    return sorted(sorted(xyz[i : i + 2]) for begin, end in zip(ends, ends[1:]) for i in range(begin, end - 1))


def report_of(chain):
    """The report without the holes that it names: their numbers are others on ranks."""
    return re.sub(r"(hole|void) \d+ \(.*", r"\1", chain.GetReport())


def check_same(name):
    (mine, whole), properties, boundary, faults, expected_words, further = INPUTS[name]
    here, there = (one if RANK == where else EMPTY if one else None
                   for one, where in ((boundary, 0), (faults, LAST)))
    chain, found = updated(mine, properties, here, there, False)
    expected, words = updated(whole, properties, boundary, faults, True)
    if expected_words is not None:
        check(len(words) == len(expected_words) and all(a in b for a, b in zip(expected_words, words)),
              "%s, alone: %s" % (name, words))
    are_full = gather(mine.GetNumberOfElements(6 if isinstance(mine, vtkTable) else 0) > 0)
    further = further if sum(are_full) > 1 else []  # what is on one rank stays there
    gathering = [text for text in found if ON_ONE_RANK in text]
    check_equal([text for text in found if text not in gathering], words if RANK == 0 else [], "messages, " + name)
    check(len(gathering) == (len(further) if RANK == 0 else 0) and all(a in b for a, b in zip(further, gathering)),
          "%s: %s of what is made on one rank" % (name, gathering))
    check_equal(report_of(chain), report_of(expected), "the report, " + name)
    check_equal(chain.GetOutputDataObject(3).GetNumberOfRows(),
                expected.GetOutputDataObject(3).GetNumberOfRows() if RANK == 0 else 0, "rows of the report, " + name)
    surface, right = surface_of(chain), expected.GetOutputDataObject(0)
    check(right.GetNumberOfPolys() > (2 if "three" in name else 200), "%s: %d triangles" % (name, right.GetNumberOfPolys()))
    triangles = meshes.sorted_rows(numpy.vstack(gather(meshes.by_places(surface))))
    check(numpy.array_equal(triangles, meshes.by_places(right)), "the same triangles, " + name)
    attributes = right.GetPointData()
    names = [attributes.GetArrayName(i) for i in range(attributes.GetNumberOfArrays())]
    # Nodes of a grid have their numbers in it on ranks, and else their places among those with data.
    are_nodes = any(word in name for word in ("image", "grid"))
    other = (meshes.GHOSTS, IDS, *(["OriginalPointIds"] if are_nodes else []))
    names = [one for one in names if one not in other]
    lacks = [one for one in names if surface.GetNumberOfPoints() and not surface.GetPointData().HasArray(one)]
    check_equal(lacks, [], "arrays, " + name)
    if not any(gather(len(lacks))):
        points = meshes.sorted_rows(numpy.vstack(gather(rows_of(surface, names))))
        wanted = meshes.sorted_rows(rows_of(right, names))
        check(points.shape == wanted.shape and numpy.allclose(points, wanted, 1e-9, 1e-9), "the same points, " + name)
    for port in 1, 2:
        lines = sorted(sum(gather(edges_of(surface_of(chain, port))), []))
        check_equal(len(lines), len(edges_of(expected.GetOutputDataObject(port))), "edges of output %d, %s" % (port, name))
        check(numpy.allclose(lines, edges_of(expected.GetOutputDataObject(port))), "output %d, %s" % (port, name))
    counts = gather(int(numpy.count_nonzero(~meshes.ghosts_of(surface))))
    if not further and sum(are_full) > 1 and sum(counts) > 100 * COUNT and "error" not in name:
        check(max(counts) < 1.5 * sum(counts) / COUNT, "%s: points of ranks, %s" % (name, counts))


def check_refused(name, part, data, boundary=None, **properties):
    """One error, by the first rank, with a part of its words, and nothing on any rank."""
    chain, found = updated(data, properties, boundary, None, False)
    check(len(found) == (RANK == 0) and (RANK > 0 or part in found[0]), "%s: %s" % (name, found))
    for port in range(4):
        output = chain.GetOutputDataObject(port)
        check_equal(output.GetNumberOfElements(6 if port == 3 else 0), 0, "output %d, %s" % (port, name))


def main():
    vtkOutputWindow.GetInstance().SetDisplayModeToNever()
    for name in INPUTS:
        check_same(name)
    bare = cloud(SLICES[RANK])
    if RANK == LAST:
        bare.GetPointData().RemoveArray("Amplitude")
    check_refused("an array that one rank lacks", "there is no point array named Amplitude", bare,
                  ElevationArray="Amplitude")
    check_refused("points on a line", "points lie on one line in x,y, from (0, 0) to", slices_of(LINE)[0])
    check_refused("an edge limit below all edges", "no triangle has edges of at most 1e-05; use a larger Maximum Edge Length",
                  cloud(ORDER[RANK]), MaximumEdgeLength=1e-5)
    check_refused("two points", "only two points differ", cloud(ALL[:2] if RANK in (0, LAST) else ALL[:0]))
    check_refused("one place", "have the same x,y (1, 2)", slices_of(numpy.full((40, 3), (1.0, 2.0, 3.0)))[0])
    check_refused("nothing finite", "points are not finite", slices_of(numpy.full((40, 3), numpy.nan))[0])
    check_refused("nulls alone", "all points have the elevation that marks missing", slices_of(changed(ALL, 7.0))[0],
                  NoData="7")
    check_refused("a boundary elsewhere", "oundary", cloud(ORDER[RANK]), meshes.rings([numpy.array(
        [(100.0, 100), (110, 100), (105, 120)])]) if RANK == LAST else EMPTY)
    check_refused("tables and points", "different kinds of it: points and tables",
                  table(SLICES[RANK]) if RANK == LAST else cloud(SLICES[RANK]))
    wrong = table(SLICES[RANK])
    if RANK == LAST:
        wrong.GetColumn(3).SetValue(1, "sea")
    check_refused("a word in a table", "row %d of column z is not a number: sea" % (SLICES[LAST][0] + 1), wrong)
    return "%d inputs of the whole chain" % len(INPUTS)


if __name__ == "__main__":
    end(main())
