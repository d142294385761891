# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A boundary or constraint without heights leaves the surface as it was; what is cut out stays open."""
import os
import sys
import unittest

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator, vtkPolyData

from vtkelevationsurface import (
    reconstruct,
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)

from vtkelevationsurface.holes import hole_lines

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import meshes  # noqa: E402
from mesh_rules import findings  # noqa: E402

RECTANGLE = numpy.array([(5.2, 7.3), (44.7, 7.3), (44.7, 40.1), (5.2, 40.1)])
LAKE = numpy.array([(20.4, 20.2), (30.3, 20.2), (30.3, 28.1), (20.4, 28.1)])


def relief(xy):
    """A sine of amplitude 10."""
    return 10.0 * numpy.sin(0.7 * xy[:, 0]) * numpy.cos(0.5 * xy[:, 1])


def grid(side=50):
    xy = numpy.stack(numpy.meshgrid(numpy.arange(side), numpy.arange(side)), -1).reshape(-1, 2) * 1.0
    return numpy.column_stack((xy, relief(xy)))


def surface_of(xyz, source=None, **properties):
    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputData(meshes.cloud(xyz, arrays=[("Double", 2.0 * xyz[:, 2])]))
    if source is not None:
        delaunay.SetSourceData(source)
    for name, value in properties.items():
        getattr(delaunay, "Set" + name)(value)
    delaunay.Update()
    return delaunay


def trimmed(surface, rings, **properties):
    trim = vtkTrimOutwardTriangles()
    trim.SetInputData(surface)
    trim.SetBoundaryData(meshes.rings(rings))
    for name, value in properties.items():
        getattr(trim, "Set" + name)(value)
    trim.Update()
    return trim


def filled(surface, **properties):
    fill = vtkFillElevationHoles()
    fill.SetInputData(surface)
    for name, value in properties.items():
        getattr(fill, "Set" + name)(value)
    fill.Update()
    return fill


def heights(surface, places):
    """z of a surface at places, found by vertical lines; NaN outside of it."""
    locator = vtkStaticCellLocator()
    locator.SetDataSet(surface)
    locator.BuildLocator()
    found = numpy.full(len(places), numpy.nan)
    hit, parameters = [0.0] * 3, [0.0] * 3
    for i, (x, y) in enumerate(places):
        part, cell = mutable(0.0), mutable(0)
        if locator.IntersectWithLine((x, y, -1e3), (x, y, 1e3), 0.0, part, hit, parameters, cell):
            found[i] = hit[2]
    return found


def marks_of(surface):
    return vtk_to_numpy(surface.GetPointData().GetArray("OnBoundary"))


def deviation(before, *after):
    """The largest difference of the heights of surfaces at random places, where they are."""
    places = numpy.random.default_rng(36).uniform(0.5, 48.5, (1500, 2))
    expected, largest = heights(before, places), 0.0
    for surface in after:
        z = heights(surface, places)
        if numpy.isnan(z).all():
            raise AssertionError("the surface is at none of the places")
        largest = max(largest, float(numpy.nanmax(abs(z - expected))))
    return largest


class FollowSurface(unittest.TestCase):
    def test_is_the_default_and_keeps_the_surface(self):
        before = surface_of(grid()).GetOutput()
        trim = trimmed(before, [RECTANGLE, LAKE])
        self.assertEqual(trim.GetBoundaryEdges(), trim.FOLLOW_SURFACE)
        kept, outward = trim.GetOutput(0), trim.GetOutput(1)
        self.assertEqual(findings(kept), [])
        self.assertLess(deviation(before, kept, outward), 1e-6)
        xy = meshes.points_of(kept)[meshes.triangles_of(kept)].mean(axis=1)[:, :2]
        inside = ((xy > RECTANGLE[0]) & (xy < RECTANGLE[2])).all(axis=1)
        in_lake = ((xy > LAKE[0]) & (xy < LAKE[2])).all(axis=1)
        self.assertTrue((inside & ~in_lake).all())
        # One point for each edge that is crossed, and the corners of the rings.
        inserted = trim.GetNumberOfInsertedPoints()
        self.assertEqual(inserted, kept.GetNumberOfPoints() - before.GetNumberOfPoints())
        self.assertGreater(inserted, 8 + 4 * 30)
        self.assertEqual(trim.GetNumberOfRecoveredEdges(), 8)
        values = vtk_to_numpy(kept.GetPointData().GetArray("Double"))
        numpy.testing.assert_allclose(values, 2.0 * meshes.points_of(kept)[:, 2], atol=1e-12)

    def test_straight_edges_take_no_more_points_and_change_the_surface(self):
        before = surface_of(grid()).GetOutput()
        trim = trimmed(before, [RECTANGLE], BoundaryEdges=vtkTrimOutwardTriangles.STRAIGHT)
        self.assertEqual(trim.GetNumberOfInsertedPoints(), 4)
        self.assertGreater(deviation(before, trim.GetOutput(0)), 5.0)

    def test_a_surveyed_shore_keeps_its_heights(self):
        before = surface_of(grid()).GetOutput()
        shore = numpy.column_stack((RECTANGLE, (3.0, 4.0, 5.0, 6.0)))
        shore[0, :2] = (5.0, 7.0)  # a corner of the mesh
        trim = trimmed(before, [shore], BoundaryEdges=vtkTrimOutwardTriangles.OWN_ELEVATIONS)
        points = meshes.points_of(trim.GetOutput(0))
        for x, y, z in shore:
            at = (points[:, 0] == x) & (points[:, 1] == y)
            self.assertEqual(points[at, 2].tolist(), [z])
        elsewhere = ~numpy.isin(points[:, 0] + 1j * points[:, 1], shore[:, 0] + 1j * shore[:, 1])
        numpy.testing.assert_array_equal(
            points[elsewhere], meshes.points_of(before)[elsewhere[: before.GetNumberOfPoints()]])
        # The input is not touched.
        self.assertEqual(before.GetPoint(7 * 50 + 5)[2], relief(numpy.array([[5.0, 7.0]]))[0])

    def test_a_shore_that_meets_only_a_corner_gives_it_its_height(self):
        # Around the corner both edges of the shore are outside of the surface.
        surface = meshes.mesh(numpy.array([[0, 0, 1], [4, 0, 2], [2, 3, 3], [0, 0, 8]], float), [[0, 1, 2]])
        shore = numpy.array([[0, 0, 9], [2, -5, 9], [10, 0, 9], [10, 10, 9], [-10, 10, 9]], float)
        for recover in (True, False):
            with self.subTest(recover=recover):
                trim = vtkTrimOutwardTriangles()
                trim.SetInputData(surface)
                trim.SetBoundaryData(meshes.rings([shore]))
                trim.SetBoundaryEdges(vtkTrimOutwardTriangles.OWN_ELEVATIONS)
                trim.SetRecoverBoundary(recover)
                trim.Update()
                # A duplicate is no corner, and stays.
                for port in (0, 1):
                    z = meshes.points_of(trim.GetOutput(port))[:, 2]
                    self.assertEqual(z.tolist(), [9, 2, 3, 8])
                self.assertEqual(marks_of(trim.GetOutput(0)).tolist(), [0, 0, 0, 0])

    def test_marks_are_the_points_on_its_edges(self):
        before = surface_of(grid()).GetOutput()
        for edges in (0, 1, 2):
            with self.subTest(edges=edges):
                trim = trimmed(before, [RECTANGLE], BoundaryEdges=edges)
                x, y, _ = meshes.points_of(trim.GetOutput(0)).T
                (x0, y0), (x1, y1) = RECTANGLE[0], RECTANGLE[2]
                near = 1e-12
                on = ((abs(x - x0) < near) | (abs(x - x1) < near)) & (y > y0 - near) & (y < y1 + near)
                on |= ((abs(y - y0) < near) | (abs(y - y1) < near)) & (x > x0 - near) & (x < x1 + near)
                numpy.testing.assert_array_equal(marks_of(trim.GetOutput(0)) != 0, on)
                numpy.testing.assert_array_equal(marks_of(trim.GetOutput(1)) != 0, on)

    def test_marks_stay_when_trimmed_again(self):
        first = trimmed(surface_of(grid()).GetOutput(), [RECTANGLE, LAKE]).GetOutput(0)
        inner = 0.8 * (RECTANGLE - (25, 24)) + (25, 24)
        again = trimmed(first, [inner]).GetOutput(0)
        self.assertEqual(filled(again).GetNumberOfFilledHoles(), 0)

    def test_an_extracted_boundary_marks_nothing(self):
        trim = vtkTrimOutwardTriangles()
        trim.SetInputData(surface_of(grid()).GetOutput())
        trim.Update()
        self.assertIsNone(trim.GetOutput(0).GetPointData().GetArray("OnBoundary"))


class CutOut(unittest.TestCase):
    def with_a_gap(self):
        """A grid in which points are missing around (12, 33), so that a hole is there."""
        xyz = grid()
        far = numpy.hypot(xyz[:, 0] - 12, xyz[:, 1] - 33) > 4
        return surface_of(xyz[far], MaximumEdgeLength=2.0).GetOutput()

    def test_holes_of_the_boundary_stay_open_and_others_are_filled(self):
        surface = trimmed(self.with_a_gap(), [RECTANGLE, LAKE]).GetOutput(0)
        fill = filled(surface)
        self.assertFalse(fill.GetFillCutOuts())
        status = vtk_to_numpy(fill.GetOutput(1).GetCellData().GetArray("Status"))
        self.assertEqual(sorted(status), [fill.FILLED, fill.CUT_OUT])
        self.assertEqual((fill.GetNumberOfHoles(), fill.GetNumberOfFilledHoles()), (2, 1))
        middle = numpy.array([LAKE.mean(axis=0) + (0.11, 0.07), (12.1, 33.2)])  # inside triangles
        self.assertEqual(numpy.isnan(heights(fill.GetOutput(0), middle)).tolist(), [True, False])
        everything = filled(surface, FillCutOuts=True)
        self.assertEqual(everything.GetNumberOfFilledHoles(), 2)
        self.assertFalse(numpy.isnan(heights(everything.GetOutput(0), middle)).any())
        self.assertFalse(marks_of(everything.GetOutput(0))[surface.GetNumberOfPoints():].any())

    def test_islands_and_lakes_along_edges_of_the_mesh(self):
        # A lake whose shore runs through nodes, with an island.
        lake = numpy.array([(20.0, 20.0), (30.0, 20.0), (30.0, 28.0), (20.0, 28.0)])
        island = numpy.array([(24.0, 23.0), (26.0, 23.0), (25.0, 25.0)])
        for edges in (0, 1):
            surface = trimmed(
                surface_of(grid()).GetOutput(), [RECTANGLE, lake, island], BoundaryEdges=edges)
            fill = filled(surface.GetOutput(0))
            self.assertEqual((fill.GetNumberOfHoles(), fill.GetNumberOfFilledHoles()), (1, 0))

    def test_a_lake_in_a_gap_of_the_data_leaves_the_gap_open(self):
        inner = numpy.array([(11.0, 32.0), (13.0, 32.0), (12.0, 34.0)])
        for rings, filled_holes in (([RECTANGLE], 1), ([RECTANGLE, inner], 0)):
            fill = filled(trimmed(self.with_a_gap(), rings).GetOutput(0))
            self.assertEqual((fill.GetNumberOfHoles(), fill.GetNumberOfFilledHoles()), (1, filled_holes))

    def test_other_arrays_of_that_name_mean_nothing(self):
        surface = vtkPolyData()
        surface.DeepCopy(self.with_a_gap())
        surface.GetPointData().AddArray(
            meshes.array_of(numpy.ones(surface.GetNumberOfPoints()), "OnBoundary"))
        self.assertEqual(filled(surface).GetNumberOfFilledHoles(), 1)

    def test_reconstruct_leaves_them_open_unless_asked(self):
        for fill_it in (False, True):
            result = reconstruct(grid(), boundary=[RECTANGLE, LAKE], fill_cut_outs=fill_it)
            holes = result.report["holes"]
            self.assertEqual((holes["found"], holes["filled"], holes["cut_out"]),
                             (1, 1, 0) if fill_it else (0, 0, 1))
            lines = []
            hole_lines(holes, lambda name, words: lines.append(words))
            self.assertIs("--fill-cut-outs" in " ".join(lines), not fill_it)


class Drape(unittest.TestCase):
    LINES = numpy.array([(3.3, 4.1, 0.0), (46.2, 39.7, 0.0), (4.0, 45.0, 0.0), (45.0, 5.0, 0.0), (60.0, 20.0, 0.0)])

    def test_constraints_become_edges_of_the_surface_that_was_there(self):
        before = surface_of(grid()).GetOutput()
        lines = meshes.lines(self.LINES, [[0, 1], [2, 3, 4]])
        delaunay = surface_of(grid(), lines, DrapeConstraints=True)
        after = delaunay.GetOutput()
        self.assertEqual(findings(after), [])
        self.assertLess(deviation(before, after), 1e-6)
        added = delaunay.GetNumberOfAddedPoints()
        self.assertEqual(added, after.GetNumberOfPoints() - before.GetNumberOfPoints())
        self.assertGreater(added, 60)
        # Without, the lines' z of 0 shows.
        own = surface_of(grid(), lines)
        self.assertGreater(deviation(before, own.GetOutput()), 5.0)
        # Edges along the first line, from end to end.
        xy, corners = meshes.points_of(after)[:, :2], meshes.triangles_of(after)
        a, b = self.LINES[0, :2], self.LINES[1, :2]
        way = (b - a) / numpy.hypot(*(b - a))
        along, aside = (xy - a) @ way, (xy - a) @ (-way[1], way[0])
        on = (abs(aside) < 1e-12) & (along > -1e-12) & (along < numpy.hypot(*(b - a)) + 1e-12)
        edges = numpy.vstack((corners[:, :2], corners[:, 1:], corners[:, ::2]))
        edges = numpy.unique(numpy.sort(edges[on[edges].all(axis=1)], axis=1), axis=0)
        length = abs(along[edges[:, 1]] - along[edges[:, 0]]).sum()
        self.assertAlmostEqual(length, numpy.hypot(*(b - a)), places=9)

    def test_lines_outside_the_points_are_an_error_as_others_are(self):
        lines = meshes.lines(self.LINES + 1e4, [[0, 1]])
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(meshes.cloud(grid()))
        delaunay.SetSourceData(lines)
        delaunay.DrapeConstraintsOn()
        errors = []
        delaunay.AddObserver("ErrorEvent", lambda *_: errors.append(1))
        delaunay.GetExecutive().AddObserver("ErrorEvent", lambda *_: errors.append(1))
        delaunay.Update()
        self.assertTrue(errors)
        self.assertEqual(delaunay.GetOutput().GetNumberOfPoints(), 0)


if __name__ == "__main__":
    unittest.main()
