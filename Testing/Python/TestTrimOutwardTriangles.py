# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""vtkTrimOutwardTriangles from Python: names, defaults, both kinds of boundary, through NumPy."""
import math
import os
import sys
import unittest

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersSources import vtkRegularPolygonSource

from vtkelevationsurface import vtkFillElevationHoles, vtkGridDelaunay2D, vtkTrimOutwardTriangles
from vtkelevationsurface.messages import Messages

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from mesh_rules import findings  # noqa: E402
from TestData import read  # noqa: E402  (the files of Data/)


def triangulate(xy):
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.column_stack([xy, numpy.zeros(len(xy))]), deep=True))
    cloud = vtkPolyData()
    cloud.SetPoints(points)
    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputData(cloud)
    delaunay.Update()
    return delaunay.GetOutput()


def area(mesh):
    xy = vtk_to_numpy(mesh.GetPoints().GetData())[:, :2]
    t = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    a, b, c = xy[t[:, 0]], xy[t[:, 1]], xy[t[:, 2]]
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum()


def polygons(*rings):
    data = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    cells = vtkCellArray()
    for ring in rings:
        cells.InsertNextCell(len(ring))
        for x, y in ring:
            cells.InsertCellPoint(points.InsertNextPoint(x, y, 0.0))
    data.SetPoints(points)
    data.SetPolys(cells)
    return data


def corners(mesh, origin):
    xy = vtk_to_numpy(mesh.GetPoints().GetData())[:, :2].astype(float) - origin
    t = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return xy[t]


def areas(mesh, origin):
    a, b, c = numpy.moveaxis(corners(mesh, origin), 1, 0)
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def ring_area(ring):
    x, y = ring.T
    return 0.5 * math.fsum(x * numpy.roll(y, -1) - y * numpy.roll(x, -1))


def is_inside(mesh, rings, origin):
    """Whether the middle of each triangle is inside, by the even-odd rule; slivers are left out."""
    size = areas(mesh, origin)
    x, y = corners(mesh, origin).mean(axis=1)[size > 1e-9 * size.mean()].T
    inside = numpy.zeros(len(x), dtype=bool)
    for ring in rings:
        for (ax, ay), (bx, by) in zip(ring - origin, numpy.roll(ring, -1, axis=0) - origin):
            between = (ay <= y) != (by <= y)
            inside ^= between & (x < ax + (y - ay) / (by - ay) * (bx - ax))
    return inside


class TestTrimOutwardTriangles(unittest.TestCase):
    def check_parts(self, trim, convex_hull=True):
        """The triangles inside and outside are together a surface of all points, as the input was."""
        self.assertEqual(
            findings(trim.GetOutput(0), trim.GetOutput(1), convex_hull=convex_hull, all_points=True),
            [])

    def test_defaults(self):
        trim = vtkTrimOutwardTriangles()
        self.assertEqual(trim.GetGapTolerance(), 0.0)
        self.assertEqual(trim.GetGridSteps(), (0.0, 0.0, 0.0, 0.0))
        self.assertTrue(trim.GetRecoverBoundary())
        self.assertEqual(trim.GetNumberOfThreads(), 0)
        self.assertEqual(trim.GetOutwardTest(), vtkTrimOutwardTriangles.EXACT)
        self.assertEqual(trim.GetOutwardTestAsString(), "Exact")
        self.assertIsNone(trim.GetBoundary())
        self.assertEqual(trim.GetNumberOfOutputPorts(), 3)

    def test_counts_are_0_before_an_update(self):
        trim = vtkTrimOutwardTriangles()
        self.assertEqual(trim.GetNumberOfOutwardTriangles(), 0)
        self.assertEqual(trim.GetNumberOfRecoveredEdges(), 0)
        self.assertEqual(trim.GetNumberOfPointsLeftOut(), 0)
        self.assertEqual(trim.GetNumberOfInsertedPoints(), 0)
        self.assertEqual(trim.GetEffectiveGapTolerance(), 0.0)

    def test_triangles_without_their_ids_of_points_are_refused(self):
        for count, number_of_ids in ((2, 1), (2, 3), (5, 0)):
            data, cells = polygons([(0, 0), (9, 0), (0, 9)]), vtkCellArray()
            offsets, ids = (numpy_to_vtkIdTypeArray(numpy.array(values, dtype=numpy.int64), deep=True)
                            for values in (range(0, 3 * count + 1, 3), range(number_of_ids)))
            cells.SetData(offsets, ids)
            data.SetPolys(cells)
            trim = vtkTrimOutwardTriangles()
            trim.SetInputData(data)
            with Messages(trim) as messages:
                trim.Update()
            self.assertIn(f"end with the number of point ids, {number_of_ids}.", messages.errors[0])

    def test_values_are_clamped(self):
        trim = vtkTrimOutwardTriangles()
        trim.SetOutwardTest(9)
        self.assertEqual(trim.GetOutwardTest(), vtkTrimOutwardTriangles.INWARD_NORMAL)
        self.assertEqual(trim.GetOutwardTestAsString(), "InwardNormal")

    def test_every_property_is_printed(self):
        text = str(vtkTrimOutwardTriangles())
        for name in ("OutwardTest", "GapTolerance", "GridSteps", "RecoverBoundary", "NumberOfThreads", "Controller",
                     "EffectiveGapTolerance", "NumberOfOutwardTriangles", "NumberOfRecoveredEdges",
                     "NumberOfPointsLeftOut", "NumberOfInsertedPoints"):
            self.assertIn(name, text)

    def test_a_star_has_its_area(self):
        # A star through random points: its corners are points, its edges are recovered.
        angle = numpy.linspace(0.0, 2.0 * numpy.pi, 40, endpoint=False)
        radius = numpy.where(numpy.arange(40) % 2, 0.2, 0.45)
        star = 0.5 + radius[:, None] * numpy.column_stack([numpy.cos(angle), numpy.sin(angle)])
        mesh = triangulate(numpy.vstack([star, numpy.random.RandomState(1).rand(3000, 2)]))
        boundary = vtkPolyData()
        boundary.SetPoints(mesh.GetPoints())
        cells = vtkCellArray()
        cells.InsertNextCell(40)
        for i in range(40):
            cells.InsertCellPoint(i)
        boundary.SetPolys(cells)
        trim = vtkTrimOutwardTriangles()
        trim.SetInputData(mesh)
        trim.SetBoundaryData(boundary)
        trim.Update()
        x, y = star.T
        expected = 0.5 * (x * numpy.roll(y, -1) - y * numpy.roll(x, -1)).sum()
        self.assertAlmostEqual(area(trim.GetOutput(0)), expected, places=12)
        self.check_parts(trim)
        self.assertGreater(trim.GetNumberOfRecoveredEdges(), 20)

    def test_an_abort_is_reported_once_and_the_progress_text_stays_the_users(self):
        trim = vtkTrimOutwardTriangles()
        trim.SetInputData(triangulate(numpy.random.RandomState(3).rand(500, 2)))
        trim.SetProgressText("of the user")
        trim.Update()
        self.assertEqual(trim.GetProgressText(), "of the user")
        tag = trim.AddObserver("ProgressEvent", lambda caller, _: caller.SetAbortExecute(1))
        trim.Modified()
        with Messages(trim) as messages:
            for port in range(3):  # as ParaView does
                trim.Update(port)
        self.assertEqual([one.code for one in messages.warnings], ["Stopped"])
        self.assertEqual(trim.GetOutput(0).GetNumberOfCells(), 0)
        self.assertEqual(trim.GetProgressText(), "of the user")
        trim.RemoveObserver(tag)
        trim.SetAbortExecute(0)
        trim.Modified()
        trim.Update()
        self.assertGreater(trim.GetOutput(0).GetNumberOfCells(), 0)

    def test_an_abort_is_forgotten_after_it_by_the_filters_that_follow(self):
        trim, fill = vtkTrimOutwardTriangles(), vtkFillElevationHoles()
        trim.SetInputData(triangulate(numpy.random.RandomState(3).rand(500, 2)))
        fill.SetInputConnection(trim.GetOutputPort())
        tag = trim.AddObserver("ProgressEvent", lambda caller, _: caller.SetAbortExecute(1))
        with Messages(trim, fill) as messages:
            fill.Update()
        self.assertEqual([one.code for one in messages.warnings], ["Stopped"])
        self.assertEqual(fill.GetOutput().GetNumberOfCells(), 0)
        trim.RemoveObserver(tag)
        trim.SetAbortExecute(0)  # the others were never asked to stop
        trim.Modified()
        fill.Update()
        self.assertGreater(fill.GetOutput().GetNumberOfCells(), 0)

    def test_a_ring_that_is_there_as_polygon_and_as_line_counts_once(self):
        ring = vtkRegularPolygonSource()  # makes both
        ring.SetRadius(0.3)
        ring.SetCenter(0.5, 0.5, 0.0)
        trim = vtkTrimOutwardTriangles()
        trim.SetInputData(triangulate(numpy.random.RandomState(3).rand(500, 2)))
        trim.SetBoundaryConnection(ring.GetOutputPort())
        with Messages(trim) as messages:
            trim.Update()
        self.assertEqual(messages.errors, [])
        self.assertEqual([one.code for one in messages.warnings], ["RingsRepeated"])
        self.assertAlmostEqual(area(trim.GetOutput(0)), 3 * 0.3**2 * math.sin(math.pi / 3))
        ring.GeneratePolylineOff()
        with Messages(trim) as messages:
            trim.Update()
        self.assertEqual(messages.warnings, [])

    def test_a_boundary_on_a_map_cuts_the_surface_as_it_is(self):
        # A plane, so that every inserted elevation is known; the boundary reaches beyond the points.
        xy = numpy.random.RandomState(3).rand(2000, 2)
        mesh = triangulate(xy)
        vtk_to_numpy(mesh.GetPoints().GetData())[:, 2] = 2.0 * xy[:, 0] - xy[:, 1]
        square = area(mesh)
        boundary = polygons([(0.21, 0.33), (0.71, 0.33), (0.71, 2.0), (0.21, 2.0)],
                            [(0.4, 0.5), (0.6, 0.5), (0.5, 0.7)])
        trim = vtkTrimOutwardTriangles()
        trim.SetInputData(mesh)
        trim.SetBoundaryData(boundary)
        trim.SetBoundaryEdgesToStraight()
        trim.Update()
        self.assertEqual(trim.GetNumberOfInsertedPoints(), 7)  # five corners, two crossings
        trim.SetBoundaryEdgesToFollowSurface()
        trim.Update()
        points = vtk_to_numpy(trim.GetOutput().GetPoints().GetData())
        self.assertEqual(len(points), 2000 + trim.GetNumberOfInsertedPoints())
        self.assertGreater(trim.GetNumberOfInsertedPoints(), 200)
        numpy.testing.assert_allclose(points[:, 2], 2.0 * points[:, 0] - points[:, 1], atol=1e-14)
        self.assertLess(area(trim.GetOutput(0)), 0.5 * 0.67 - 0.02)
        self.assertGreater(area(trim.GetOutput(0)), 0.5 * 0.66 - 0.02)
        self.assertAlmostEqual(area(trim.GetOutput(0)) + area(trim.GetOutput(1)), square, places=14)
        self.check_parts(trim, convex_hull=False)  # crossings with the hull are rounded

    def test_polygons_over_real_points_keep_their_area(self):
        # Also what is inside is kept, and nothing else: asked for the middle of each triangle.
        random = numpy.random.RandomState(4)
        for name in ("aegean_sea.csv", "b9_ground.vtp", "horizon_synthetic.vtp",
                     "jacksboro_fault.vtp", "olinda_land.xyz"):
            delaunay = vtkGridDelaunay2D()
            delaunay.SetInputData(read(name))
            delaunay.Update()
            low_x, high_x, low_y, high_y = delaunay.GetOutput().GetBounds()[:4]
            center = numpy.array([0.5 * (low_x + high_x), 0.5 * (low_y + high_y)])
            rings = []
            for reach in (0.3, 0.15, 0.05):  # an island in a lake
                angle = 2.0 * numpy.pi * (numpy.arange(40) + 0.5 * random.rand(40)) / 40
                radius = reach * min(high_x - low_x, high_y - low_y) * (0.6 + 0.4 * random.rand(40))
                rings.append(center + radius[:, None] * numpy.column_stack(
                    [numpy.cos(angle), numpy.sin(angle)]))
            expected = sum(sign * ring_area(ring - center)
                           for sign, ring in zip((1, -1, 1), rings))
            for test in ("Exact", "InwardNormal"):
                with self.subTest(name=name, test=test):
                    trim = vtkTrimOutwardTriangles()
                    trim.SetInputData(delaunay.GetOutput())
                    trim.SetBoundaryData(polygons(*rings))
                    getattr(trim, "SetOutwardTestTo" + test)()
                    trim.SetBoundaryEdgesToStraight()
                    trim.Update()
                    self.assertEqual(trim.GetNumberOfInsertedPoints(), 120)
                    kept, outward = trim.GetOutput(0), trim.GetOutput(1)
                    self.assertEqual(kept.GetNumberOfPolys() + outward.GetNumberOfPolys(),
                                     delaunay.GetOutput().GetNumberOfPolys() + 240)
                    if test == "Exact":
                        self.assertAlmostEqual(areas(kept, center).sum() / expected, 1.0, delta=1e-12)
                        self.assertTrue(is_inside(kept, rings, center).all())
                        self.assertFalse(is_inside(outward, rings, center).any())
                    else:
                        self.assertFalse(is_inside(outward, rings, center).any())

    def test_the_published_test_leaves_what_lies_behind_points(self):
        # The corners of a hull have points on the boundary alone, but for one.
        angle = numpy.linspace(0.0, 2.0 * numpy.pi, 24, endpoint=False)
        radius = numpy.where(numpy.arange(24) % 2, 0.3, 0.5)
        star = radius[:, None] * numpy.column_stack([numpy.cos(angle), numpy.sin(angle)])
        kept = {}
        for points in (star, numpy.vstack([star, 0.45 * numpy.array([[numpy.cos(angle[1]),
                                                                      numpy.sin(angle[1])]])])):
            for test in ("Exact", "InwardNormal"):
                trim = vtkTrimOutwardTriangles()
                trim.SetInputData(triangulate(points))
                trim.SetBoundaryData(polygons(star))
                getattr(trim, "SetOutwardTestTo" + test)()
                trim.Update()
                kept[test, len(points)] = area(trim.GetOutput(0))
        self.assertAlmostEqual(kept["Exact", 24], kept["InwardNormal", 24], places=14)
        self.assertAlmostEqual(kept["Exact", 24], kept["Exact", 25], places=14)
        self.assertGreater(kept["InwardNormal", 25], kept["Exact", 25] + 0.01)

    def test_the_boundary_is_found(self):
        # A ring of points: its inside is a lake, the corners of its hull are outward.
        # The outline of points runs inside that of the ring by less than half a spacing (0.014).
        xy = numpy.random.RandomState(2).rand(20000, 2) * 2.0 - 1.0
        radius = numpy.hypot(xy[:, 0], xy[:, 1])
        trim = vtkTrimOutwardTriangles()
        trim.SetInputData(triangulate(xy[(radius > 0.4) & (radius < 0.9)]))
        trim.Update()
        self.assertEqual(trim.GetOutput(2).GetNumberOfLines(), 2)
        self.assertAlmostEqual(area(trim.GetOutput(0)), numpy.pi * (0.81 - 0.16), delta=0.06)
        field = trim.GetOutput().GetFieldData()
        self.assertEqual(field.GetArray("EffectiveGapTolerance").GetValue(0),
                         trim.GetEffectiveGapTolerance())
        self.assertGreater(trim.GetEffectiveGapTolerance(), 4.0)

    def test_every_triangle_is_on_one_side_with_its_data_on_any_number_of_threads(self):
        mesh = triangulate(numpy.random.RandomState(3).rand(20000, 2))
        cell = numpy_to_vtk(numpy.arange(mesh.GetNumberOfPolys()), deep=True)
        cell.SetName("Cell")
        mesh.GetCellData().AddArray(cell)
        angle = numpy.linspace(0.0, 2.0 * numpy.pi, 40, endpoint=False)
        wave = numpy.column_stack([(0.4 + 0.05 * numpy.sin(5.0 * angle)) * numpy.cos(angle),
                                   (0.4 + 0.05 * numpy.sin(5.0 * angle)) * numpy.sin(angle)])
        for boundary in (polygons(0.5 + wave, 0.5 + 0.2 * wave), None):
            before = None
            for threads in (1, 2, 5):
                trim = vtkTrimOutwardTriangles()
                trim.SetInputData(mesh)
                trim.SetBoundaryData(boundary)
                trim.SetNumberOfThreads(threads)
                trim.Update()
                sides = [trim.GetOutput(0), trim.GetOutput(1)]
                cells = [vtk_to_numpy(side.GetCellData().GetArray("Cell")) for side in sides]
                # All are there, most as they were: the others have been flipped.
                sums = numpy.zeros(mesh.GetNumberOfPolys())
                for side, ids in zip(sides, cells):
                    numpy.add.at(sums, ids, areas(side, 0.0))
                    self.assertTrue((ids[:100] == numpy.sort(ids[:100])).all())
                self.check_parts(trim)
                self.assertEqual(len(numpy.unique(numpy.concatenate(cells))), len(sums))
                self.assertLess((abs(sums - areas(mesh, 0.0)) > 1e-15).mean(), 0.03)
                self.assertGreater(min(len(ids) for ids in cells), 20)
                bytes_now = [vtk_to_numpy(side.GetPolys().GetConnectivityArray()).tobytes()
                             for side in sides] + [ids.tobytes() for ids in cells]
                self.assertEqual(bytes_now, before or bytes_now)
                before = bytes_now


if __name__ == "__main__":
    unittest.main(argv=["TestTrimOutwardTriangles"])
