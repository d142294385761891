# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""vtkGridDelaunay2D from Python: names, defaults, and a triangulation through NumPy."""
import os
import subprocess
import sys
import unittest

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

import vtkelevationsurface
from vtkelevationsurface import vtkGridDelaunay2D
from vtkelevationsurface.messages import Messages


def cloud(coordinates):
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(coordinates), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    return data


def triangles(data):
    return vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)


class TestPackage(unittest.TestCase):
    def test_a_python_without_vtk_names_the_one_that_has_it(self):
        folder = os.path.dirname(os.path.dirname(vtkelevationsurface.__file__))
        # Without -S, Python finds the packages that are installed.
        done = subprocess.run(
            [sys.executable, "-S", "-c", "import vtkelevationsurface"], capture_output=True,
            encoding="utf-8", env=dict(os.environ, PYTHONPATH=folder))
        self.assertNotEqual(done.returncode, 0)
        last = done.stderr.strip().splitlines()[-1]
        self.assertRegex(last, "^ImportError: .*which .* does not find .* was built for /.*: use that")


class TestGridDelaunay2D(unittest.TestCase):
    def test_defaults(self):
        delaunay = vtkGridDelaunay2D()
        self.assertEqual(delaunay.GetSearchStrategy(), vtkGridDelaunay2D.VOXEL_TRAVERSAL)
        self.assertEqual(delaunay.GetSearchStrategyAsString(), "VoxelTraversal")
        self.assertEqual(delaunay.GetMaximumEdgeLength(), 0.0)
        self.assertEqual(delaunay.GetMaximumElevationError(), 0.0)
        self.assertEqual(delaunay.GetMaximumNumberOfPoints(), 0)
        self.assertFalse(delaunay.GetSimplifyConstraints())
        self.assertFalse(delaunay.GetDataDependentEdges())
        self.assertEqual(delaunay.GetDuplicatePolicy(), vtkGridDelaunay2D.KEEP_FIRST)
        self.assertEqual(delaunay.GetDuplicatePolicyAsString(), "KeepFirst")
        self.assertEqual(delaunay.GetLatticeMode(), vtkGridDelaunay2D.AUTOMATIC)
        self.assertEqual(delaunay.GetLatticeModeAsString(), "Automatic")
        self.assertEqual(delaunay.GetLattice(), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
        self.assertEqual(delaunay.GetLatticeTolerance(), 0.01)
        self.assertEqual(delaunay.GetNumberOfThreads(), 0)

    def test_enumerations_are_clamped(self):
        delaunay = vtkGridDelaunay2D()
        delaunay.SetDuplicatePolicy(99)
        self.assertEqual(delaunay.GetDuplicatePolicy(), vtkGridDelaunay2D.KEEP_HIGHEST)
        delaunay.SetSearchStrategy(5)
        self.assertEqual(delaunay.GetSearchStrategy(), vtkGridDelaunay2D.COMPACTNESS)
        self.assertEqual(delaunay.GetSearchStrategyAsString(), "Compactness")
        delaunay.SetSearchStrategy(-1)
        self.assertEqual(delaunay.GetSearchStrategy(), vtkGridDelaunay2D.VOXEL_TRAVERSAL)
        delaunay.SetLatticeMode(7)
        self.assertEqual(delaunay.GetLatticeMode(), vtkGridDelaunay2D.OFF)

    def test_every_property_is_printed(self):
        text = str(vtkGridDelaunay2D())
        for name in ("SearchStrategy", "MaximumEdgeLength", "DuplicatePolicy", "LatticeMode",
                     "Lattice:", "LatticeTolerance", "LatticeFound", "NumberOfThreads", "Controller",
                     "NumberOfDuplicatePoints", "NumberOfNonFinitePoints",
                     "NumberOfConstraintCrossings", "NumberOfAddedPoints"):
            self.assertIn(name, text)

    def test_triangles_do_not_depend_on_the_order_of_points(self):
        random = numpy.random.RandomState(3)
        coordinates = random.rand(2000, 3)
        order = random.permutation(2000)

        def corner_sets(data):
            xy = vtk_to_numpy(data.GetPoints().GetData())[:, :2]
            return {frozenset(map(tuple, xy[t])) for t in triangles(data)}

        sets = []
        for c in (coordinates, coordinates[order]):
            delaunay = vtkGridDelaunay2D()
            delaunay.SetInputData(cloud(c))
            delaunay.Update()
            sets.append(corner_sets(delaunay.GetOutput()))
        self.assertEqual(sets[0], sets[1])

    def test_a_turned_and_rounded_grid_is_found_and_reported(self):
        j, i = numpy.mgrid[0:20, 0:30]
        u, v = numpy.array([20.0, 15.0]), numpy.array([-15.0, 20.0])
        xy = numpy.array([612000.0, 6073000.0]) + i.reshape(-1, 1) * u + j.reshape(-1, 1) * v
        xy += 0.04 * numpy.random.RandomState(4).rand(600, 2) - 0.02
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(cloud(numpy.column_stack([xy, numpy.zeros(600)])))
        delaunay.Update()
        self.assertTrue(delaunay.GetLatticeFound())
        lattice = delaunay.GetOutput().GetFieldData().GetArray("Lattice")
        self.assertEqual((lattice.GetNumberOfTuples(), lattice.GetNumberOfComponents()), (1, 6))
        expected = [612000.0, 6073000.0, 20.0, 15.0, -15.0, 20.0]
        for value, wanted in zip(lattice.GetTuple(0), expected):
            self.assertAlmostEqual(value, wanted, delta=0.02)
        self.assertEqual(len(triangles(delaunay.GetOutput())), 2 * 19 * 29)

        delaunay.SetLatticeTolerance(0.0001)
        delaunay.Update()
        self.assertFalse(delaunay.GetLatticeFound())
        self.assertIsNone(delaunay.GetOutput().GetFieldData().GetArray("Lattice"))
        self.assertGreater(len(triangles(delaunay.GetOutput())), 2 * 19 * 29)

        delaunay.SetLatticeTolerance(0.01)
        delaunay.SetLatticeModeToOff()
        delaunay.Update()
        self.assertFalse(delaunay.GetLatticeFound())

    def test_a_part_of_a_grid_takes_the_lattice_of_the_whole(self):
        j, i = numpy.mgrid[0:40, 0:40]
        u, v = numpy.array([20.0, 15.0]), numpy.array([-15.0, 20.0])
        xy = numpy.array([612000.0, 6073000.0]) + i.reshape(-1, 1) * u + j.reshape(-1, 1) * v
        xy += 0.04 * numpy.random.RandomState(6).rand(1600, 2) - 0.02
        whole = vtkGridDelaunay2D()
        whole.SetInputData(cloud(numpy.column_stack([xy, numpy.zeros(1600)])))
        whole.Update()
        found = whole.GetOutput().GetFieldData().GetArray("Lattice").GetTuple(0)
        four = numpy.column_stack([xy[[0, 1, 40, 41]], numpy.zeros(4)])
        part = vtkGridDelaunay2D()
        part.SetInputData(cloud(four))
        part.Update()
        self.assertFalse(part.GetLatticeFound())
        part.SetLattice(found)
        part.Update()
        self.assertTrue(part.GetLatticeFound())
        self.assertEqual(part.GetOutput().GetFieldData().GetArray("Lattice").GetTuple(0)[2:],
                         found[2:])

        part.SetLattice(found[0] + 8.0, *found[1:])
        messages = []
        part.AddObserver("ErrorEvent", lambda *_: messages.append(1))
        part.Update()
        self.assertEqual(len(messages), 1)
        self.assertEqual(part.GetOutput().GetNumberOfPoints(), 0)

    def test_both_searches_give_the_same_bytes(self):
        data = cloud(numpy.random.RandomState(5).rand(20000, 3))
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(data)
        delaunay.Update()
        expected = triangles(delaunay.GetOutput()).tobytes()
        time = delaunay.GetOutput().GetMTime()
        delaunay.SetSearchStrategyToCompactness()
        delaunay.Update()
        self.assertGreater(delaunay.GetOutput().GetMTime(), time)  # it ran again
        self.assertEqual(triangles(delaunay.GetOutput()).tobytes(), expected)
        delaunay.SetSearchStrategyToVoxelTraversal()
        self.assertEqual(delaunay.GetSearchStrategyAsString(), "VoxelTraversal")

    def test_the_number_of_threads_does_not_change_a_byte(self):
        data = cloud(numpy.random.RandomState(4).rand(60000, 3))
        results = []
        for threads in (1, 2, 4):
            delaunay = vtkGridDelaunay2D()
            delaunay.SetInputData(data)
            delaunay.SetNumberOfThreads(threads)
            delaunay.Update()
            results.append(triangles(delaunay.GetOutput()).tobytes())
        self.assertEqual(results[0], results[1])
        self.assertEqual(results[0], results[2])

    def test_unused_points_are_listed(self):
        coordinates = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 5], [numpy.inf, 0, 0]], float)
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(cloud(coordinates))
        delaunay.Update()
        fields = delaunay.GetOutput().GetFieldData()
        self.assertEqual(list(vtk_to_numpy(fields.GetArray("UnusedPointIds"))), [3, 4])
        self.assertEqual(list(vtk_to_numpy(fields.GetArray("UnusedPointReasons"))), [1, 2])
        self.assertEqual(delaunay.GetNumberOfDuplicatePoints(), 1)
        self.assertEqual(delaunay.GetNumberOfNonFinitePoints(), 1)
        self.assertEqual(triangles(delaunay.GetOutput()).tolist(), [[0, 1, 2]])

    def test_few_points_are_within_an_elevation_error_of_all(self):
        rng = numpy.random.default_rng(5)
        points = rng.random((20000, 3)) * (1000.0, 800.0, 1.0)
        points[:, 2] += 40.0 * numpy.sin(points[:, 0] / 90.0) * numpy.cos(points[:, 1] / 70.0)
        points[-10:] = points[:10]
        points[5000, 2] = numpy.nan
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(cloud(points))
        delaunay.SetMaximumElevationError(2.5)
        delaunay.Update()
        output = delaunay.GetOutput()
        fields = output.GetFieldData()
        ids, reasons = (
            vtk_to_numpy(fields.GetArray("UnusedPoint" + name)) for name in ("Ids", "Reasons"))
        redundant = ids[reasons == 3]
        self.assertEqual(delaunay.GetNumberOfRedundantPoints(), len(redundant))
        self.assertEqual(fields.GetArray("NumberOfRedundantPoints").GetValue(0), len(redundant))
        self.assertGreater(len(redundant), 15000)
        self.assertEqual((reasons == 1).sum(), 10)
        self.assertEqual((reasons == 2).sum(), 1)
        largest = delaunay.GetLargestElevationError()
        self.assertEqual(fields.GetArray("LargestElevationError").GetValue(0), largest)
        self.assertTrue(2.0 < largest <= 2.5)
        used = numpy.unique(triangles(output))
        numpy.testing.assert_array_equal(
            numpy.sort(numpy.concatenate((used, ids))), numpy.arange(len(points)))
        # Each triangle and the points in it.
        worst = 0.0
        for a, b, c in points[triangles(output)]:
            near = redundant[(points[redundant, :2] >= numpy.min((a, b, c), axis=0)[:2]).all(axis=1)
                             & (points[redundant, :2] <= numpy.max((a, b, c), axis=0)[:2]).all(axis=1)]
            matrix = numpy.column_stack((b - a, c - a))
            weights = numpy.linalg.solve(matrix[:2], (points[near] - a)[:, :2].T)
            inside = (weights >= 0).all(axis=0) & (weights.sum(axis=0) <= 1)
            heights = a[2] + matrix[2] @ weights[:, inside]
            worst = max(worst, numpy.abs(heights - points[near[inside], 2]).max(initial=0.0))
        self.assertAlmostEqual(worst, largest, places=9)
        delaunay.SetMaximumElevationError(0.0)
        delaunay.Update()
        self.assertIsNone(delaunay.GetOutput().GetFieldData().GetArray("LargestElevationError"))
        self.assertEqual(delaunay.GetNumberOfRedundantPoints(), 0)
        self.assertEqual(delaunay.GetLargestElevationError(), 0.0)

    def test_an_elevation_error_that_is_none_is_an_error(self):
        points = numpy.random.default_rng(6).random((50, 3))
        for error, edge, words in (
            (-1.0, 0.0, "MaximumElevationError is -1; it must be 0"),
            (numpy.nan, 0.0, "MaximumElevationError is nan"),
            (numpy.inf, 0.0, "MaximumElevationError is inf"),
            (0.1, 5.0, "are both set"),
        ):
            delaunay = vtkGridDelaunay2D()
            delaunay.SetInputData(cloud(points))
            delaunay.SetMaximumElevationError(error)
            delaunay.SetMaximumEdgeLength(edge)
            with Messages(delaunay, delaunay.GetExecutive()) as messages:
                delaunay.Update()
            self.assertEqual(len(messages.errors), 1)
            self.assertIn(words, messages.errors[0])
            self.assertEqual(delaunay.GetOutput().GetNumberOfPoints(), 0)

    def test_an_error_larger_than_the_relief_leaves_the_corners(self):
        points = numpy.random.default_rng(7).random((500, 3))
        points[:4, :2] = ((-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0))
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(cloud(points))
        delaunay.SetMaximumElevationError(5.0)
        delaunay.Update()
        self.assertEqual(delaunay.GetOutput().GetNumberOfPolys(), 2)
        self.assertEqual(delaunay.GetNumberOfRedundantPoints(), 496)

    def test_lines_keep_few_points_when_they_may(self):
        j, i = numpy.mgrid[0:40, 0:40]
        grid = numpy.column_stack([i.ravel(), j.ravel(), numpy.abs(j.ravel() - 15)]).astype(float)
        lines = cloud(numpy.array([[0, 15, 0], [39, 15, 0], [39, 30, 15.0]]))
        lines.SetLines(vtkCellArray())
        lines.GetLines().InsertNextCell(3, [0, 1, 2])
        for simplify, count in ((False, 40 + 15 + 4), (True, 2 + 1 + 4)):
            delaunay = vtkGridDelaunay2D()
            delaunay.SetInputData(cloud(grid))
            delaunay.SetSourceData(lines)
            delaunay.SetMaximumElevationError(0.1)
            delaunay.SetSimplifyConstraints(simplify)
            delaunay.Update()
            self.assertEqual(len(numpy.unique(triangles(delaunay.GetOutput()))), count)
            self.assertEqual(delaunay.GetNumberOfRedundantPoints(), 1600 - count)

    def test_constraints_are_edges_and_crossings_are_points(self):
        j, i = numpy.mgrid[0:10, 0:10]
        grid = numpy.column_stack([i.ravel(), j.ravel(), numpy.zeros(100)]).astype(float)
        lines = cloud(numpy.array([[1, 1, 5], [8, 4.5, 5], [4.5, 1.5, 9], [2, 8, 9.0]]))
        cells = vtkCellArray()
        cells.InsertNextCell(2, [0, 1])
        cells.InsertNextCell(2, [2, 3])
        lines.SetLines(cells)
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(cloud(grid))
        delaunay.SetSourceData(lines)
        self.assertIs(delaunay.GetSource(), lines)
        delaunay.Update()
        self.assertEqual(delaunay.GetNumberOfConstraintCrossings(), 1)
        self.assertEqual(delaunay.GetNumberOfAddedPoints(), 3)
        output = delaunay.GetOutput()
        points = vtk_to_numpy(output.GetPoints().GetData())
        numpy.testing.assert_array_equal(points[:100], grid)
        # (8, 4.5), (4.5, 1.5) and the crossing; (1, 1) and (2, 8) are points of the grid. The first
        # line's first end has the grid's z, 0; it passes (3, 2), which has too.
        numpy.testing.assert_array_equal(points[100:102], [[8, 4.5, 5], [4.5, 1.5, 9]])
        x, y, z = points[102]
        self.assertAlmostEqual((x - 1) / 7, (y - 1) / 3.5, places=12)
        self.assertAlmostEqual((x - 2) / 2.5, (y - 8) / -6.5, places=12)
        edges = {frozenset(e) for t in triangles(output) for e in zip(t, numpy.roll(t, 1))}
        for edge in ((11, 23), (23, 102), (101, 102)):
            self.assertIn(frozenset(edge), edges)
        fields = output.GetFieldData()
        self.assertEqual(fields.GetArray("NumberOfConstraintCrossings").GetValue(0), 1)
        self.assertEqual(fields.GetArray("NumberOfAddedPoints").GetValue(0), 3)
        self.assertIsNone(fields.GetArray("Lattice"))

    def test_a_constraint_without_z_has_that_of_the_surface(self):
        j, i = numpy.mgrid[0:10, 0:10]
        grid = numpy.column_stack([i.ravel(), j.ravel(), 0.3 * i.ravel() - 0.1 * j.ravel()]).astype(float)
        none = numpy.nan
        lines = cloud(numpy.array([[1.5, 1.25, none], [8, 4.5, 50], [4.5, 1.5, 9], [2.25, 8, none], [4.5, 1.5, none]]))
        cells = vtkCellArray()
        for ids in ([4, 0], [0, 1], [2, 3]):
            cells.InsertNextCell(len(ids), ids)
        lines.SetLines(cells)
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(cloud(grid))
        delaunay.SetSourceData(lines)
        with Messages(delaunay) as messages:
            delaunay.Update()
        self.assertEqual((messages.errors, messages.warnings), ([], []))
        self.assertEqual(delaunay.GetNumberOfPointsWithoutZ(), 3)
        fields = delaunay.GetOutput().GetFieldData()
        self.assertEqual(fields.GetArray("NumberOfPointsWithoutZ").GetValue(0), 3)
        points = {tuple(p[:2]): p[2] for p in vtk_to_numpy(delaunay.GetOutput().GetPoints().GetData())}
        self.assertAlmostEqual(points[1.5, 1.25], 0.3 * 1.5 - 0.1 * 1.25, places=12)  # of a plane
        self.assertAlmostEqual(points[2.25, 8], 0.3 * 2.25 - 0.1 * 8, places=12)
        self.assertEqual((points[8, 4.5], points[4.5, 1.5]), (50, 9))  # a z that is given counts
        # Where a line with z and one without cross, the former's z counts, whatever their order.
        lines = cloud(numpy.array([[0.5, 5.5, none], [8.5, 5.5, none], [4.5, 0.5, 70], [4.5, 8.5, 70]]))
        for order in ([0, 1], [2, 3]), ([2, 3], [0, 1]):
            cells = vtkCellArray()
            for ids in order:
                cells.InsertNextCell(2, ids)
            lines.SetLines(cells)
            delaunay.SetSourceData(lines)
            delaunay.Update()
            xyz = vtk_to_numpy(delaunay.GetOutput().GetPoints().GetData())
            self.assertEqual(xyz[(xyz[:, 0] == 4.5) & (xyz[:, 1] == 5.5), 2].tolist(), [70])
        # A given point needs none, wherever it is; draped, no line needs any.
        delaunay.DrapeConstraintsOn()
        with Messages(delaunay) as messages:
            delaunay.Update()
        self.assertEqual((messages.errors, delaunay.GetNumberOfPointsWithoutZ()), ([], 0))

    def test_draped_lines_that_are_no_lines_change_nothing_or_are_an_error(self):
        grid = numpy.random.RandomState(4).rand(200, 3)
        lines = cloud(numpy.array([[0.5, 0.5, 0], [0.5, 0.5, 0], [0.7, 0.6, 0], [numpy.nan, 0.2, 0]]))
        words_of = {(0,): None, (0, 1): None, (): None, (0, 2, 3): "Point 3 of the constraints' cell 0 is not finite"}
        for ids, words in words_of.items():
            for set_cells in (lines.SetLines, lines.SetPolys):
                lines.SetLines(vtkCellArray())
                lines.SetPolys(vtkCellArray())
                cells = vtkCellArray()
                cells.InsertNextCell(len(ids), ids)
                if words is None:
                    cells.InsertNextCell(2, [0, 2])  # a line or an edge of a polygon that counts
                set_cells(cells)
                delaunay = vtkGridDelaunay2D()
                delaunay.SetInputData(cloud(grid))
                delaunay.SetSourceData(lines)
                delaunay.DrapeConstraintsOn()
                with Messages(delaunay, delaunay.GetExecutive()) as messages:
                    delaunay.Update()
                found = " ".join(map(str, messages.errors))
                self.assertEqual(found == "", words is None, found)
                self.assertIn(words or "", found)

    def test_a_constraint_without_z_needs_a_surface(self):
        grid = numpy.random.RandomState(4).rand(200, 3)
        for xyz, points, words in (
            ([[0.5, 0.5, 1], [2, 2, numpy.nan], [0.1, 3, numpy.nan]], grid, "at 2, 2, has no z (NaN) and lies outside"),
            ([[0.5, 0.5, numpy.nan], [0, 0, 1]], grid[:, :1] * [1, 1, 1], "lies outside of the surface"),
            ([[0.5, 0.5, numpy.inf], [0.4, 0.2, numpy.nan]], grid, "has a coordinate that is not finite"),
        ):
            lines = cloud(numpy.array(xyz, dtype=float))
            cells = vtkCellArray()
            cells.InsertNextCell(len(xyz), list(range(len(xyz))))
            lines.SetLines(cells)
            delaunay = vtkGridDelaunay2D()
            delaunay.SetInputData(cloud(points))
            delaunay.SetSourceData(lines)
            with Messages(delaunay, delaunay.GetExecutive()) as messages:
                delaunay.Update()
            self.assertEqual(len(messages.errors), 1)
            self.assertIn(words, messages.errors[0])
            self.assertEqual(delaunay.GetOutput().GetNumberOfPoints(), 0)

    def test_polygons_among_constraints_are_lines_and_a_warning(self):
        lines = cloud(numpy.array([[0.2, 0.2, 0.0], [0.8, 0.2, 0.0], [0.5, 0.8, 0.0]]))
        cells = vtkCellArray()
        cells.InsertNextCell(3, [0, 1, 2])
        lines.SetPolys(cells)
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(cloud(numpy.random.RandomState(4).rand(100, 3)))
        delaunay.SetSourceData(lines)
        with Messages(delaunay) as messages:
            delaunay.Update()
        self.assertEqual([one.code for one in messages.warnings], ["PolygonsAreLines"])
        self.assertEqual(messages.warnings[0].values, {"count": "1"})
        self.assertIn("vtkTrimOutwardTriangles", messages.warnings[0])
        hull = delaunay.GetOutput().GetNumberOfCells()
        lines.SetLines(cells)
        lines.SetPolys(vtkCellArray())
        with Messages(delaunay) as messages:
            delaunay.Update()
        self.assertEqual(messages.warnings, [])
        self.assertLessEqual(delaunay.GetOutput().GetNumberOfCells(), hull)


if __name__ == "__main__":
    unittest.main(argv=["TestGridDelaunay2D"])
