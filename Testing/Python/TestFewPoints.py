# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of as few points as an elevation error allows: outline, faults, bound and report."""

import os
import sys
import unittest

import numpy
from in_folder import Program
from vtkelevationsurface import ElevationSurfaceError, ElevationSurfaceWarning, read, reconstruct
from vtkelevationsurface.clouds import add_array, make_lines, make_points
from vtkelevationsurface.outline import (
    ON_OUTLINE,
    outside_of,
    rings_of,
    simplified,
    spacing_of,
)
from vtkelevationsurface.report import OUTSIDE
from vtkelevationsurface.spreading import OUTSIDE_OUTLINE, WITHIN_ERROR
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes

DATA = sys.argv[sys.argv.index("-D") + 1] if "-D" in sys.argv else "Data"
ERROR = 0.2
WITHIN = "within the elevation error"
BOUNDARY = numpy.array([(5.0, 5), (95, 5), (95, 90), (70, 90), (65, 70), (60, 95), (5, 95)])
STEPS = numpy.arange(40)
FAULT = numpy.column_stack((25 + 0.75 * STEPS, 10 + 0.02 * (STEPS % 2), 0 * STEPS + 9))  # bent


def cloud(seed=1):
    """Random points of waves, with a lake in the middle and a bay from above."""
    xy = numpy.random.RandomState(seed).rand(12000, 2) * 100
    x, y = xy.T
    xy = xy[(numpy.hypot(x - 50, y - 50) > 15) & ((y < 60) | (abs(x - 20) > 10))]
    return numpy.column_stack((xy, numpy.sin(xy[:, 0] / 15) * 5 + xy[:, 1] / 20))


def area(result):
    points, triangles = result.to_numpy()
    a, b, c = (points[triangles[:, i], :2] for i in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    return 0.5 * float(abs(ux * vy - uy * vx).sum())


def edges(result):
    triangles = result.to_numpy()[1]
    return {tuple(sorted(t[[i, i - 1]])) for t in triangles for i in range(3)}


def residuals(result, points, reach=0.0):
    """The vertical distance of each point from the triangle that it lies in, or NaN."""
    places, triangles = result.to_numpy()
    found = numpy.full(len(points), numpy.nan)
    for corners in places[triangles]:
        away = numpy.full(len(points), numpy.inf)
        for p, q in zip(corners, numpy.roll(corners, -1, axis=0)):
            (dx, dy), off = (q - p)[:2], points[:, :2] - p[:2]
            away = numpy.minimum(away, (dx * off[:, 1] - dy * off[:, 0]) / numpy.hypot(dx, dy))
        rows = numpy.flatnonzero(away >= -reach - 1e-9)
        normal = numpy.cross(corners[1] - corners[0], corners[2] - corners[0])
        distance = abs((points[rows] - corners[0]) @ normal / normal[2])
        found[rows] = numpy.fmin(found[rows], distance)
    return found


class Surface(unittest.TestCase):
    def check_bound(self, points, result, error, reach=0.0):
        """The points that are left out are near the surface, and the report counts them."""
        few, reasons = result.report["simplified"], result.reasons
        left = points[reasons == WITHIN_ERROR]
        # A point just outside of the outline may be as far above a slope as it is away from it.
        self.assertLessEqual(residuals(result, left, reach).max(), error + reach)
        self.assertLessEqual(few["largest_elevation_error"], error)
        self.assertEqual(few["points_redundant"], len(left))
        outside = result.report["unused_reasons"].get(OUTSIDE, 0)
        self.assertEqual(few["points_kept"] + len(left) + outside, len(points))
        self.assertLess(few["points_kept"], 0.25 * len(points))

    def test_the_outline_is_that_of_all_points(self):
        points = cloud()
        full = reconstruct(points, fill=False)
        result = reconstruct(points, fill=False, maximum_elevation_error=ERROR)
        self.assertEqual(result.boundary.GetNumberOfLines(), full.boundary.GetNumberOfLines())
        self.assertLess(result.boundary.GetNumberOfPoints(), full.boundary.GetNumberOfPoints() / 3)
        self.assertLess(abs(area(result) / area(full) - 1), 0.01)
        trim, of_all = result.report["trim"], full.report["trim"]
        for name in ("boundary", "effective_gap_tolerance", "points_left_out"):
            self.assertEqual(trim[name], of_all[name])
        spacing = spacing_of(full.boundary, None)
        self.check_bound(points, result, ERROR, 2 * ON_OUTLINE * spacing)
        outside = points[result.reasons == OUTSIDE_OUTLINE]
        self.assertFalse(outside_of(result.boundary, outside, 0.5 * spacing).any())
        self.assertTrue(0 < len(outside) < 0.02 * len(points))

    def test_holes_are_filled_and_no_triangles_opened(self):
        holes = reconstruct(cloud(), open_edge_length=0).report["holes"]["filled"]
        result = reconstruct(cloud(), maximum_elevation_error=ERROR)
        self.assertEqual(result.report["holes"]["filled"], holes)
        lines = [(x, y, numpy.sin(x)) for y in range(0, 101, 20) for x in range(101)]
        self.assertGreater(reconstruct(lines).fill.GetOpenEdgeLength(), 0.0)
        result = reconstruct(lines, maximum_elevation_error=ERROR)
        self.assertEqual(result.fill.GetOpenEdgeLength(), 0.0)
        given = reconstruct(cloud(), maximum_elevation_error=ERROR, open_edge_length=30)
        self.assertEqual(given.fill.GetOpenEdgeLength(), 30.0)

    def test_faults_stay_edges(self):
        points = cloud()
        for boundary in (None, BOUNDARY):
            result = reconstruct(
                points, faults=FAULT, boundary=boundary, fill=False, maximum_elevation_error=ERROR
            )
            self.assertEqual(result.report["faults"]["added_points"], len(FAULT))
            self.assertEqual(result.report["faults"]["crossings"], 0)
            places = result.to_numpy()[0]
            ids = [int(numpy.flatnonzero((places == row).all(axis=1))[0]) for row in FAULT]
            self.assertEqual(set(zip(ids[:-1], ids[1:])) - edges(result), set())

    def test_of_a_straight_fault_the_ends_stay(self):
        fault = numpy.column_stack((25 + 0.75 * STEPS, 10 + 0.25 * STEPS, 0 * STEPS + 9))
        result = reconstruct(
            cloud(), faults=fault, fill=False, maximum_elevation_error=ERROR, remove_unused_points=False
        )
        places, triangles = result.to_numpy()
        ids = [int(numpy.flatnonzero((places == row).all(axis=1))[0]) for row in fault]
        self.assertEqual([i for i in ids if i in triangles], [ids[0], ids[-1]])
        self.assertIn((ids[0], ids[-1]), edges(result))

    def test_a_fault_across_the_outline_leaves_the_triangles_as_they_are(self):
        points = cloud()[::3]
        points[:, 2] += numpy.random.RandomState(2).rand(len(points))  # steep wherever edges change
        turns = 0.7 * STEPS[:, None]
        across = numpy.hstack((50 + 60 * numpy.cos(turns), 50 + 60 * numpy.sin(turns), 0 * turns))
        for boundary in (None, BOUNDARY):
            result = reconstruct(
                points, faults=across, boundary=boundary, fill=False, maximum_elevation_error=ERROR
            )
            self.assertEqual(result.trim.GetNumberOfRecoveredEdges(), 0)
            left = points[result.reasons == WITHIN_ERROR]
            distances = residuals(result, left)
            self.assertLessEqual(numpy.nanmax(distances), ERROR + 1e-9)
            self.assertLess(numpy.count_nonzero(numpy.isnan(distances)), 0.01 * len(left))

    def test_a_boundary_that_is_given_cuts_as_it_does_all_points(self):
        points = cloud()
        full = reconstruct(points, boundary=BOUNDARY, fill=False, boundary_edges="straight")
        result = reconstruct(points, boundary=BOUNDARY, fill=False, maximum_elevation_error=ERROR)
        self.assertAlmostEqual(area(result), area(full), places=6)
        self.check_bound(points, result, ERROR)
        trim, of_all = result.report["trim"], full.report["trim"]
        for name in ("boundary", "boundary_rings", "inserted_points", "recovered_edges"):
            self.assertEqual(trim[name], of_all[name])
        self.assertEqual(result.report["distance"]["points"], full.report["distance"]["points"])
        self.assertLessEqual(result.report["distance"]["maximum"], ERROR)

    def test_without_trimming_the_hull_stays(self):
        points = cloud()
        full = reconstruct(points, trim=False, fill=False)
        result = reconstruct(points, trim=False, fill=False, maximum_elevation_error=ERROR)
        self.assertAlmostEqual(area(result), area(full), places=6)
        self.check_bound(points, result, ERROR)

    def test_grids(self):
        points = read(os.path.join(DATA, "jacksboro_fault.vtp")).points
        points = vtk_to_numpy(points.GetPoints().GetData()).astype("f8")
        steps = [numpy.unique(points[:, i], return_inverse=True)[1] for i in range(2)]
        points = points[(steps[0] % 5 == 0) & (steps[1] % 5 == 0)]
        cut = numpy.hypot(*(points[:, :2] - points[:, :2].min(axis=0)).T) > 8000  # a missing corner
        for some, is_full in ((points, True), (points[cut], False)):
            error = 0.1 * numpy.ptp(some[:, 2])
            full = reconstruct(some, fill=False)
            result = reconstruct(some, fill=False, maximum_elevation_error=error)
            self.assertEqual(result.lattice, full.lattice)
            self.assertIsNotNone(result.lattice)
            self.assertLess(abs(area(result) / area(full) - 1), 1e-9 if is_full else 0.01)
            self.check_bound(some, result, error, 0 if is_full else 5)

    def test_a_straight_outline_along_a_grid_has_few_points(self):
        sheet = numpy.array([(x, y, 0.5 * x) for y in range(60) for x in range(60)], "f8")
        x, y = sheet[:, :2].T
        sheet = sheet[(abs(x - 30) > 8) | (abs(y - 30) > 12)]
        sheet = sheet[(sheet[:, 0] < 20) | (sheet[:, 1] > 2)]
        result = reconstruct(sheet, fill=False, maximum_elevation_error=0.01)
        self.assertEqual(result.complete.GetNumberOfPoints(), len(sheet))
        corners = result.boundary.GetNumberOfPoints()
        self.assertEqual(result.report["simplified"]["points_kept"], corners)
        self.assertLess(corners, 20)
        full = reconstruct(sheet, fill=False)
        self.assertAlmostEqual(area(result), area(full))

    def test_an_error_above_the_relief_leaves_the_outline(self):
        sheet = numpy.array([(x, y, 0.5 * x) for y in range(12) for x in range(12)], "f8")
        result = reconstruct(sheet, maximum_elevation_error=100)
        self.assertEqual(result.report["simplified"]["points_kept"], 4)
        self.assertEqual(result.surface.GetNumberOfPolys(), 2)
        self.assertEqual(result.report["unused_reasons"], {WITHIN: 140})

    def test_data_dependent_edges_need_fewer_points(self):
        points = cloud()
        few = reconstruct(points, fill=False, maximum_elevation_error=ERROR)
        result = reconstruct(
            points, fill=False, maximum_elevation_error=ERROR, data_dependent_edges=True
        )
        kept, of_delaunay = (r.report["simplified"]["points_kept"] for r in (result, few))
        self.assertLess(kept, 0.97 * of_delaunay)
        spacing = spacing_of(reconstruct(points, fill=False).boundary, None)
        self.check_bound(points, result, ERROR, 2 * ON_OUTLINE * spacing)

    def test_what_cannot_be_is_refused(self):
        for value in (-1, float("nan"), float("inf"), "much"):
            with self.assertRaisesRegex(ValueError, "^maximum_elevation_error takes a number of 0"):
                reconstruct(cloud(), maximum_elevation_error=value)
        with self.assertRaisesRegex(ValueError, "^maximum_edge_length and maximum_elevation_error"):
            reconstruct(cloud(), maximum_elevation_error=1, maximum_edge_length=5)
        with self.assertRaisesRegex(ValueError, "^data_dependent_edges needs maximum_elevation_er"):
            reconstruct(cloud(), data_dependent_edges=True)
        for other in ({"maximum_elevation_error": 0}, {"maximum_edge_length": 5}):
            both = {"maximum_edge_length": 0, "maximum_elevation_error": 0, **other}
            self.assertNotIn("simplified", reconstruct(cloud(), **both).report)


class Outline(unittest.TestCase):
    def few(self, *rings, error=0.1):
        outline = make_lines([numpy.vstack((ring, ring[:1])) for ring in rings])
        return simplified(outline, 1.0, error)

    def test_points_off_a_straight_line_go_within_both_bounds(self):
        corners = numpy.array([(0.0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)])
        for point, count in (((5, 0.4, 0.05), 4), ((5, 0.6, 0), 5), ((5, 0, 0.2), 5)):
            ring = numpy.insert(corners, 1, point, axis=0)
            for turn in range(5):
                few = self.few(numpy.roll(ring, turn, axis=0))
                self.assertEqual(few.GetNumberOfPoints(), count)

    def test_small_rings_keep_three_points(self):
        angles = numpy.arange(12) * numpy.pi / 6
        ring = numpy.column_stack((0.3 * numpy.cos(angles), 0.2 * numpy.sin(angles), 0 * angles))
        (left,) = rings_of(self.few(ring))
        self.assertEqual(len(set(left)), 3)

    def test_rings_that_would_cross_stay_whole(self):
        ring = numpy.array([(0.0, 0, 0), (4, 0, 0), (5, 0.45, 0), (6, 0, 0), (10, 0, 0), (5, 9, 0)])
        near = numpy.array([(4.9, -0.05, 0), (5.1, -0.05, 0), (5, 0.1, 0)])
        self.assertEqual(self.few(ring).GetNumberOfPoints(), 3)
        self.assertEqual(self.few(ring, near).GetNumberOfPoints(), 9)

    def test_points_where_rings_touch_stay(self):
        upper = [(0.0, 0, 0), (5, 0.1, 0), (10, 0, 0), (7.5, 4.6, 0), (5, 9, 0)]
        data = make_lines([numpy.array(upper + [(0, -9, 0), (10, -9, 0)])])
        lines = data.GetLines()
        lines.Reset()
        for ids in ([0, 1, 2, 3, 4, 0], [5, 6, 1, 5]):
            lines.InsertNextCell(len(ids), ids)
        self.assertEqual([len(ring) for ring in rings_of(simplified(data, 1.0, 0.1))], [4, 3])

    def test_points_are_outside_of_rings_in_odd_numbers(self):
        rings = [numpy.array([(0.0, 0, 0), (8, 1, 0), (9, 9, 0), (1, 8, 0)]), None]
        rings[1] = rings[0] * 0.5 + (2, 2, 0)
        lines = make_lines([numpy.vstack((ring, ring[:1])) for ring in rings])
        inside = numpy.array([(1.0, 1.5), (8.05, 1), (8, 1), (4, 0.45)])
        outside = numpy.array([(4.5, 4.5), (-1, 4), (8.2, 1)])
        self.assertFalse(outside_of(lines, inside, 0.1).any())
        self.assertTrue(outside_of(lines, outside, 0.1).all())


class SoManyPoints(unittest.TestCase):
    def test_the_surface_has_at_most_so_many_points_within_the_error_that_the_report_has(self):
        points = cloud()
        errors = []
        spacing = spacing_of(reconstruct(points, fill=False).boundary, None)
        for most in (150, 600):
            for boundary in (None, BOUNDARY):
                result = reconstruct(points, boundary=boundary, fill=False, maximum_number_of_points=most)
                few = result.report["simplified"]
                self.assertLessEqual(result.surface.GetNumberOfPoints(), most)
                self.assertEqual((few["maximum_number_of_points"], few["maximum_elevation_error"]), (most, 0.0))
                left = points[result.reasons == WITHIN_ERROR]
                reach = 2 * ON_OUTLINE * spacing
                largest = few["largest_elevation_error"]
                self.assertLessEqual(residuals(result, left, reach).max(), largest + reach)
                errors.append(largest)
        self.assertLess(max(errors[2:]), 0.4 * min(errors[:2]))

    def test_what_is_outside_of_a_boundary_does_not_count(self):
        points = cloud()
        window = numpy.array([(62.0, 12), (92, 12), (92, 52), (72, 52), (72, 32), (62, 32)])
        inside = points[(points[:, 0] > 60) & (points[:, 1] < 54)]
        twins = numpy.vstack((points, points[:50] + (0, 0, 1)))
        across = numpy.column_stack((66 + 0 * STEPS, 2.0 * STEPS, 9 + 0.1 * (STEPS % 2)))  # y 0 to 78
        for faults in (None, across):
            few, cut = (
                reconstruct(some, boundary=window, faults=faults, fill=False, duplicates="keep-first",
                            maximum_number_of_points=60)
                for some in (twins, inside)
            )
            self.assertEqual(few.surface.GetNumberOfPoints(), 60)
            largest, of_cut = (one.report["simplified"]["largest_elevation_error"] for one in (few, cut))
            self.assertLess(largest, 1.05 * of_cut)
            corners, triangles = few.to_numpy()
            self.assertAlmostEqual(area(few), 30 * 40 - 10 * 20)
            self.assertEqual(len(numpy.unique(triangles)), len(corners))
        places = corners[:, :2].tolist()
        on_fault = sorted(y for x, y in places if x == 66)
        self.assertEqual(on_fault, [12.0, *[2.0 * i for i in range(7, 16)], 32.0])

    def test_points_outside_are_unused_as_they_are_without_the_number(self):
        points = numpy.vstack((cloud(), cloud()[:50] + (0, 0, 1), [(1, numpy.nan, 0)]))
        few, full = (
            reconstruct(points, boundary=BOUNDARY, fill=False, duplicates="keep-first", boundary_edges="straight",
                        remove_unused_points=False, maximum_number_of_points=most)
            for most in (100, 0)
        )
        self.assertFalse(few.surface.GetPointData().HasArray("vtkGhostType"))
        for reason in ("same x,y as another point", "not finite", OUTSIDE):
            self.assertEqual(few.report["unused_reasons"][reason], full.report["unused_reasons"][reason])
        fields, of_all = (one.surface.GetFieldData() for one in (few, full))
        name = "NumberOfDuplicatePoints"
        self.assertEqual(fields.GetArray(name).GetValue(0), of_all.GetArray(name).GetValue(0))
        ids, why = (vtk_to_numpy(fields.GetArray("UnusedPoint" + what)) for what in ("Ids", "Reasons"))
        self.assertEqual((numpy.diff(ids) > 0).all(), True)
        self.assertEqual({reason: int((why == reason).sum()) for reason in numpy.unique(why)},
                         {1: 50, 2: 1, 3: few.report["unused_reasons"][WITHIN]})

    def test_marks_of_points_stay(self):
        given = make_points(cloud())
        marks = numpy.zeros(given.GetNumberOfPoints(), "u1")
        marks[::7] = vtkDataSetAttributes.HIDDENPOINT
        add_array(given, vtkDataSetAttributes.GhostArrayName(), marks)
        result = reconstruct(given, boundary=BOUNDARY, fill=False, remove_unused_points=False,
                             maximum_number_of_points=100)
        found = vtk_to_numpy(result.surface.GetPointData().GetArray("vtkGhostType"))
        numpy.testing.assert_array_equal(found[: len(marks)], marks)
        self.assertTrue((vtk_to_numpy(given.GetPointData().GetArray("vtkGhostType")) == marks).all())
        self.assertEqual(result.report["unused_reasons"]["marked as hidden"], numpy.count_nonzero(marks))

    def test_what_an_outline_leaves_out_does_not_count(self):
        points = cloud()
        away = numpy.array([(-300.0, 20, 9), (20, 500, -9), (800, 90, 40), (60, -400, 7), (900, 900, 30)])
        with self.assertWarnsRegex(ElevationSurfaceWarning, "leaves out 5 points"):
            result = reconstruct(numpy.vstack((points, away)), fill=False, gap_tolerance=6, maximum_number_of_points=120)
        self.assertEqual(set(result.reasons[-5:]), {OUTSIDE_OUTLINE})

    def test_a_fault_keeps_the_z_that_it_has_among_all_points(self):
        points = cloud()
        soft = FAULT.copy()
        soft[1:-1, 2] = numpy.nan
        with self.assertWarnsRegex(ElevationSurfaceWarning, "38 points without z"):
            full, few = (
                reconstruct(points, faults=soft, boundary=BOUNDARY, fill=False, maximum_number_of_points=most)
                for most in (0, 120)
            )
        z = [{tuple(row[:2]): row[2] for row in one.to_numpy()[0].tolist()} for one in (full, few)]
        for x, y in FAULT[:, :2].tolist():
            self.assertEqual(z[1][x, y], z[0][x, y])

    def test_it_serves_as_well_as_the_error_that_takes_as_many(self):
        points = cloud()
        by_error = reconstruct(points, trim=False, fill=False, maximum_elevation_error=ERROR)
        most = by_error.report["simplified"]["points_kept"]
        by_number = reconstruct(points, trim=False, fill=False, maximum_number_of_points=most)
        self.assertLess(by_number.report["simplified"]["largest_elevation_error"], 1.1 * ERROR)

    def test_the_outline_of_a_grid_keeps_its_corners_and_what_is_worth_it(self):
        x, y = (axis.ravel().astype("f8") for axis in numpy.meshgrid(numpy.arange(60), numpy.arange(60)))
        grid = numpy.column_stack((x, y, 3 * numpy.sin(x / 9) * numpy.cos(y / 7)))
        # A notch makes an outline of the grid, of straight edges through hundreds of nodes.
        result = reconstruct(grid[(x < 40) | (y < 30)], fill=False, maximum_number_of_points=60)
        self.assertLessEqual(result.surface.GetNumberOfPoints(), 60)
        self.assertLess(result.report["simplified"]["largest_elevation_error"], 2.0)
        self.assertAlmostEqual(area(result), 59 * 59 - 20 * 30, delta=60)

    def test_faults_count_and_stay_edges(self):
        result = reconstruct(cloud(), faults=FAULT, fill=False, maximum_number_of_points=200)
        self.assertLessEqual(result.surface.GetNumberOfPoints(), 200)
        places = result.to_numpy()[0]
        ids = [int(numpy.flatnonzero((places == row).all(axis=1))[0]) for row in FAULT]
        self.assertEqual(set(zip(ids[:-1], ids[1:])) - edges(result), set())
        with self.assertRaisesRegex(ElevationSurfaceError, r"MaximumNumberOfPoints is 30, but the surface needs \d+ points: "
                                    r"\d+ at the corners of the convex hull, and \d+ more of lines"):
            reconstruct(cloud(), faults=FAULT, fill=False, maximum_number_of_points=30)

    def test_the_limit_that_is_reached_first_ends_it(self):
        points, few = cloud(), {"trim": False, "fill": False}
        by_error = reconstruct(points, **few, maximum_elevation_error=ERROR, maximum_number_of_points=10**6)
        self.assertLessEqual(by_error.report["simplified"]["largest_elevation_error"], ERROR)
        with self.assertWarnsRegex(ElevationSurfaceWarning, "60, is reached before .*, 0.2: points lie up to"):
            by_number = reconstruct(
                points, **few, maximum_elevation_error=ERROR, maximum_number_of_points=60)
        self.assertGreater(by_number.report["simplified"]["largest_elevation_error"], ERROR)
        with self.assertRaisesRegex(ElevationSurfaceError, "is reached before"):
            reconstruct(points, **few, maximum_elevation_error=ERROR, maximum_number_of_points=60, strict=True)

    def test_numbers_that_are_none_raise(self):
        for value in (-1, 2.5, "many", float("nan"), float("inf")):
            with self.assertRaisesRegex(ValueError, "^maximum_number_of_points takes a whole number of 0"):
                reconstruct(cloud(), maximum_number_of_points=value)
        with self.assertRaisesRegex(ValueError, "^maximum_edge_length and maximum_number_of_points"):
            reconstruct(cloud(), maximum_number_of_points=100, maximum_edge_length=5)
        with self.assertRaisesRegex(ValueError, "needs maximum_elevation_error or maximum_number_of_points"):
            reconstruct(cloud(), data_dependent_edges=True)

    def test_edges_that_follow_the_surface_serve_it_better(self):
        points, few = cloud(), {"trim": False, "fill": False, "maximum_number_of_points": 300}
        plain, follows = (
            reconstruct(points, **few, data_dependent_edges=way).report["simplified"]["largest_elevation_error"]
            for way in (False, True)
        )
        self.assertLess(follows, 1.1 * plain)


class FewPointsInProgram(Program):
    def test_a_number_of_points_is_reported(self):
        self.file("a.xyz", "".join("%.17g %.17g %.17g\n" % tuple(row) for row in cloud()))
        done = self.call("a.xyz", "--maximum-number-of-points", "500", "--no-picture", "--report", "a.json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        few = self.json("a.json")["simplified"]
        self.assertEqual(few["maximum_number_of_points"], 500)
        self.assertLessEqual(few["points_kept"], 500)
        self.assertIn(f"points kept; others of the surface are at most {few['largest_elevation_error']:.4g} above",
                      done.stdout)
        done = self.call("a.xyz", "--maximum-number-of-points", "5", "--no-picture")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1)
        self.assertRegex(done.stderr, r"--maximum-number-of-points is 5, but the surface needs \d+ points")

    def test_the_report_lists_what_is_kept(self):
        self.file("a.xyz", "".join("%.17g %.17g %.17g\n" % tuple(row) for row in cloud()))
        done = self.call(
            "a.xyz", "--maximum-elevation-error", "0.2", "--no-picture", "--report", "a.json"
        )
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        report = self.json("a.json")
        few = report["simplified"]
        self.assertEqual(few["maximum_elevation_error"], 0.2)
        self.assertEqual(few["points_redundant"], report["unused_reasons"][WITHIN])
        self.assertEqual(few["points_kept"], report["points"] - report["points_unused"])
        kept = f"  simplified {few['points_kept']:,} of {report['points']:,} points kept"
        self.assertIn(kept, done.stdout)

    def test_options_that_do_not_go_with_it_are_refused(self):
        self.file("a.xyz", "0 0 0\n1 0 0\n0 1 0\n")
        few = ("a.xyz", "--maximum-elevation-error", "1")
        for arguments, words in (
            (("--maximum-edge-length", "5"), "--maximum-edge-length and --maximum-elevation-error"),
            (("--maximum-elevation-error", "0", "--data-dependent-edges"), "edges needs --max"),
            (("--pieces", "2", "--no-trim", "--no-fill"), "--maximum-elevation-error needs"),
        ):
            done = self.call(*few, *arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn(words, done.stderr)
            self.assertEqual(os.listdir(self.folder), ["a.xyz"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
