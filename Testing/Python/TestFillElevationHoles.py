# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""vtkFillElevationHoles from Python: names, defaults, and a filled surface through NumPy."""
import os
import sys
import unittest

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

from vtkelevationsurface import vtkFillElevationHoles

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from mesh_rules import findings, border_edge_count  # noqa: E402


def sheet(size, is_empty, elevation):
    """A sheet of size x size unit squares cut in two, without those for which is_empty(x, y)."""
    x, y = numpy.meshgrid(numpy.arange(size + 1.0), numpy.arange(size + 1.0))
    points = vtkPoints()
    points.SetData(numpy_to_vtk(
        numpy.column_stack([x.ravel(), y.ravel(), elevation(x, y).ravel()]), deep=True))
    triangles = []
    for j in range(size):
        for i in range(size):
            if not is_empty(i, j):
                a, b = j * (size + 1) + i, (j + 1) * (size + 1) + i
                triangles += [[a, a + 1, b + 1], [a, b + 1, b]]
    cells = vtkCellArray()
    connectivity = numpy.array(triangles, dtype=numpy.int64).ravel()
    offsets = numpy.arange(0, len(connectivity) + 1, 3, dtype=numpy.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True),
                  numpy_to_vtkIdTypeArray(connectivity, deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    return data


def holes_of(data):
    return vtk_to_numpy(data.GetCellData().GetArray("HoleId"))


class TestFillElevationHoles(unittest.TestCase):
    def setUp(self):
        # A hole of 4 x 3 at the lower left, one of 2 x 2 at the upper right.
        self.surface = sheet(
            10, lambda i, j: (1 <= i < 5 and 2 <= j < 5) or (7 <= i < 9 and 6 <= j < 8),
            lambda x, y: 0.1 * x * y)

    def test_what_is_filled_in_two_steps_says_so_of_both(self):
        one = vtkFillElevationHoles()
        one.SetInputData(self.surface)
        one.SetMaximumHoleSize(3.0)
        two = vtkFillElevationHoles()
        two.SetInputConnection(one.GetOutputPort())
        two.SetMaximumEdgeLength(1.45)  # replaces no triangle
        two.Update()
        before, output = one.GetOutput(), two.GetOutput()
        (small,) = set(holes_of(before)) - {-1}
        of_cells = holes_of(output)
        count = before.GetNumberOfCells()
        numpy.testing.assert_array_equal(of_cells[:count], holes_of(before))
        self.assertEqual(set(of_cells[count:]), {small + 1})
        numpy.testing.assert_array_equal(holes_of(two.GetOutput(1)), [small + 1])
        for name, none in (("FilledPoint", 0), ("FilledError", 0.0)):
            marks, earlier = (
                vtk_to_numpy(data.GetPointData().GetArray(name)) for data in (output, before))
            self.assertTrue((earlier != none).any())
            numpy.testing.assert_array_equal(marks[: len(earlier)], earlier)
            self.assertTrue((marks[len(earlier) :] != none).all())

    def test_defaults(self):
        fill = vtkFillElevationHoles()
        self.assertEqual(fill.GetOpenEdgeLength(), 0.0)
        self.assertEqual(fill.GetMaximumHoleSize(), 0.0)
        self.assertEqual(fill.GetMaximumHoleEdges(), 0)
        self.assertEqual(fill.GetMaximumNumberOfInsertedPoints(), 100_000_000)
        self.assertEqual(fill.GetMaximumNumberOfExpectedPoints(), 0)
        self.assertEqual(fill.GetSpacing(), 0.0)
        self.assertFalse(fill.GetMatchDensity())
        self.assertEqual(fill.GetInterpolation(), fill.ADAPTIVE)
        self.assertEqual(fill.GetInterpolationAsString(), "Adaptive")
        self.assertEqual(fill.GetConfidenceLevel(), 0.9)
        self.assertTrue(fill.GetInterpolatePointData())
        self.assertEqual(fill.GetNumberOfThreads(), 0)
        self.assertEqual(
            (fill.FILLED, fill.TOO_LARGE, fill.TOO_MANY_EDGES, fill.FAILED, fill.REPLACED), (0, 1, 2, 3, 4))

    def test_every_property_is_printed(self):
        text = str(vtkFillElevationHoles())
        for name in ("MaximumHoleSize", "MaximumHoleEdges", "MaximumNumberOfInsertedPoints",
                     "MaximumNumberOfExpectedPoints", "Spacing", "MatchDensity", "Interpolation",
                     "ConfidenceLevel", "InterpolatePointData",
                     "NumberOfThreads", "Controller", "NumberOfHoles", "NumberOfFilledHoles", "OpenEdgeLength"):
            self.assertIn(name + ":", text)

    def test_cell_arrays_are_shared_with_the_input_where_nothing_is_filled(self):
        numbers = numpy_to_vtk(numpy.arange(float(self.surface.GetNumberOfCells())), deep=True)
        numbers.SetName("Number")
        self.surface.GetCellData().AddArray(numbers)
        for size, is_shared in ((1.0, True), (0.0, False)):
            fill = vtkFillElevationHoles()
            fill.SetInputData(self.surface)
            fill.SetMaximumHoleSize(size)
            fill.Update()
            self.assertEqual(fill.GetOutput().GetCellData().GetArray("Number") is numbers, is_shared)

    def test_the_number_of_threads_does_not_change_a_byte(self):
        surface = sheet(
            120, lambda i, j: (i % 12) in range(2, 9) and (j % 15) in range(3, 11) and i < 117 and j < 117,
            lambda x, y: 0.01 * x * y)
        results = []
        for threads in (1, 2, 4):
            fill = vtkFillElevationHoles()
            fill.SetInputData(surface)
            fill.SetNumberOfThreads(threads)
            fill.Update()
            self.assertGreater(fill.GetNumberOfFilledHoles(), 50)
            output = fill.GetOutput()
            results.append(vtk_to_numpy(output.GetPoints().GetData()).tobytes() +
                           vtk_to_numpy(output.GetPolys().GetConnectivityArray()).tobytes())
        self.assertEqual(results[0], results[1])
        self.assertEqual(results[0], results[2])

    def test_new_points_are_the_nodes_that_were_lost(self):
        fill = vtkFillElevationHoles()
        fill.SetInputData(self.surface)
        fill.Update()
        before = self.surface.GetNumberOfPoints()
        points = vtk_to_numpy(fill.GetOutput().GetPoints().GetData())[before:]
        lost = {(x, y) for x in range(2, 5) for y in range(3, 5)} | {(8, 7)}
        self.assertEqual({(x, y) for x, y in points[:, :2]}, lost)

    def test_fills_holes_and_reports_them(self):
        fill = vtkFillElevationHoles()
        fill.SetInputData(self.surface)
        fill.Update()
        self.assertEqual((fill.GetNumberOfHoles(), fill.GetNumberOfFilledHoles()), (2, 2))
        output, report = fill.GetOutput(0), fill.GetOutput(1)
        self.assertEqual(findings(output, convex_hull=True), [])

        before = self.surface.GetNumberOfPoints()
        numpy.testing.assert_array_equal(
            vtk_to_numpy(output.GetPoints().GetData())[:before],
            vtk_to_numpy(self.surface.GetPoints().GetData()))
        filled = vtk_to_numpy(output.GetPointData().GetArray("FilledPoint"))
        self.assertFalse(filled[:before].any())
        self.assertTrue(filled[before:].all())

        table = {name: vtk_to_numpy(report.GetCellData().GetArray(name)) for name in (
            "HoleId", "Status", "NumberOfEdges", "Perimeter", "Area", "NumberOfInsertedPoints",
            "Interpolation", "Size")}
        words = [report.GetCellData().GetAbstractArray(name) for name in ("StatusName", "InterpolationName")]
        order = numpy.argsort(table["Area"])
        numpy.testing.assert_array_equal(table["HoleId"], [0, 1])
        numpy.testing.assert_array_equal(table["Status"], [0, 0])
        numpy.testing.assert_array_equal(table["Area"][order], [4.0, 12.0])
        numpy.testing.assert_array_equal(table["Size"][order], [8.0 ** 0.5, 5.0])
        for hole in table["HoleId"]:
            way = words[1].GetValue(hole)
            self.assertEqual(words[0].GetValue(hole), "filled")
            self.assertEqual(way in ("membrane", "thin plate"), table["NumberOfInsertedPoints"][hole] > 0, way)
        numpy.testing.assert_array_equal(table["NumberOfEdges"][order], [8, 14])
        numpy.testing.assert_array_equal(table["Perimeter"][order], [8.0, 14.0])
        self.assertEqual(table["NumberOfInsertedPoints"].sum(), filled.sum())
        holes = vtk_to_numpy(output.GetCellData().GetArray("HoleId"))
        self.assertTrue((holes[:self.surface.GetNumberOfCells()] == -1).all())
        for hole in table["HoleId"]:
            self.assertEqual(
                (holes == hole).sum(),
                table["NumberOfEdges"][hole] - 2 + 2 * table["NumberOfInsertedPoints"][hole])

    def test_interpolation_is_reported(self):
        names = ("NeighborMean", "Membrane", "ThinPlate", "Adaptive", "CubicSpline", "Level")
        fill = vtkFillElevationHoles()
        fill.SetInputData(self.surface)
        for number, name in enumerate(names):
            getattr(fill, "SetInterpolationTo" + name)()
            self.assertEqual(fill.GetInterpolation(), number)
            self.assertEqual(fill.GetInterpolationAsString(), name)
            fill.Update()
            used = vtk_to_numpy(fill.GetOutput(1).GetCellData().GetArray("Interpolation"))
            if number == fill.ADAPTIVE:
                self.assertTrue(set(used) <= {fill.MEMBRANE, fill.THIN_PLATE, fill.CUBIC_SPLINE})
            else:
                self.assertEqual(set(used), {number})
        fill.SetInterpolation(-1)
        self.assertEqual(fill.GetInterpolation(), fill.NEIGHBOR_MEAN)
        fill.SetInterpolation(9)
        self.assertEqual(fill.GetInterpolation(), fill.LEVEL)

    def test_splines_continue_a_slope(self):
        tilted = sheet(10, lambda i, j: 3 <= i < 7 and 3 <= j < 7, lambda x, y: 2.0 * x - y)
        fill = vtkFillElevationHoles()
        fill.SetInputData(tilted)
        fill.Update()
        points = vtk_to_numpy(fill.GetOutput().GetPoints().GetData())
        numpy.testing.assert_allclose(points[:, 2], 2.0 * points[:, 0] - points[:, 1], atol=1e-5)

    def test_limits_leave_holes_open(self):
        fill = vtkFillElevationHoles()
        fill.SetInputData(self.surface)
        fill.SetMaximumHoleSize(4.9)  # the larger hole measures 5
        fill.Update()
        self.assertEqual((fill.GetNumberOfHoles(), fill.GetNumberOfFilledHoles()), (2, 1))
        self.assertEqual(findings(fill.GetOutput()), [])
        self.assertEqual(border_edge_count(fill.GetOutput()), 40 + 14)
        status = vtk_to_numpy(fill.GetOutput(1).GetCellData().GetArray("Status"))
        self.assertEqual(sorted(status), [fill.FILLED, fill.TOO_LARGE])
        fill.SetMaximumHoleSize(0.0)
        fill.SetMaximumHoleEdges(13)
        fill.Update()
        status = vtk_to_numpy(fill.GetOutput(1).GetCellData().GetArray("Status"))
        self.assertEqual(sorted(status), [fill.FILLED, fill.TOO_MANY_EDGES])

    def test_point_arrays_follow(self):
        values = numpy_to_vtk(numpy.full(self.surface.GetNumberOfPoints(), 2.5), deep=True)
        values.SetName("Amplitude")
        self.surface.GetPointData().AddArray(values)
        fill = vtkFillElevationHoles()
        fill.SetInputData(self.surface)
        fill.Update()
        amplitude = vtk_to_numpy(fill.GetOutput().GetPointData().GetArray("Amplitude"))
        numpy.testing.assert_allclose(amplitude, 2.5, rtol=1e-15)
        fill.InterpolatePointDataOff()
        fill.Update()
        amplitude = vtk_to_numpy(fill.GetOutput().GetPointData().GetArray("Amplitude"))
        filled = vtk_to_numpy(fill.GetOutput().GetPointData().GetArray("FilledPoint"))
        numpy.testing.assert_array_equal(numpy.isnan(amplitude), filled == 1)


if __name__ == "__main__":
    unittest.main(argv=["TestFillElevationHoles"])
