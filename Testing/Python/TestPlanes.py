# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points on a wall or in a tilted plane: a warning reports them, and plane="best" makes their surface."""

import os
import tempfile
import unittest
import warnings

import numpy

import meshes
import outcomes
from vtkelevationsurface import ElevationSurfaceError, read, reconstruct, vtkGridDelaunay2D
from vtkelevationsurface.clouds import coordinates_of, make_points
from vtkelevationsurface.command import main
from vtkelevationsurface.planes import best_plane
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Data")
RANDOM = numpy.random.default_rng(11)


def relief(count=3000, size=100.0, rough=1.0):
    """Points over a square, with small hills."""
    x, y = RANDOM.uniform(0, size, (2, count))
    return numpy.column_stack((x, y, rough * numpy.sin(x / 9) * numpy.cos(y / 7)))


def tilted(xyz, degrees, turn=0.7):
    a = numpy.radians(degrees)
    lean = numpy.array([(1, 0, 0), (0, numpy.cos(a), -numpy.sin(a)), (0, numpy.sin(a), numpy.cos(a))])
    c, s = numpy.cos(turn), numpy.sin(turn)
    return xyz @ (numpy.array([(c, -s, 0), (s, c, 0), (0, 0, 1)]) @ lean).T + (500.0, 800.0, 30.0)


def area(surface):
    """In space."""
    a, b, c = vtk_to_numpy(surface.GetPoints().GetData())[meshes.triangles_of(surface)].swapaxes(0, 1)
    return 0.5 * float(numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1).sum())


def note(points):
    """What the filter says of walls."""
    one = vtkGridDelaunay2D()
    said = outcomes.noted(one)
    one.SetInputData(points)
    one.Update()
    return "".join(text for _, text in said if "lie on a wall" in text)


class Walls(unittest.TestCase):
    def test_a_note_names_walls(self):
        for degrees in (65, 75, 90):
            self.assertIn(f"{degrees} degrees", note(make_points(tilted(relief(), degrees))))
        upright = tilted(relief(), 90, 0.0)
        upright[:, 1] = 5.0  # which has no triangle
        self.assertIn("90 degrees", note(make_points(upright)))

    def test_nothing_is_said_of_the_largest_heights(self):
        xyz = relief(100)
        xyz[:, 2] = numpy.where(RANDOM.random(100) < 0.5, 1.7e308, -1.7e308)
        window, before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(window)
        try:
            self.assertEqual(note(make_points(xyz)), "")
        finally:
            vtkOutputWindow.SetInstance(before)
        self.assertEqual(window.GetOutput(), "")

    def test_no_note_names_terrain(self):
        lines = numpy.array([(x, y, 3 * numpy.sin(x / 50)) for y in range(0, 900, 300) for x in range(900)])
        along = numpy.arange(1000.0)
        cases = {
            "relief": relief(), "slope": tilted(relief(), 40), "lines": lines,
            "a line": numpy.column_stack((along, RANDOM.normal(0, 1, 1000), 30 * numpy.sin(along / 90))),
            "a corridor": relief(4000) * (100, 0.1, 40),
            "degrees": relief() * (1e-4, 1e-3, 300) + (9, 50, 0),
            "nulls": numpy.vstack((relief(900) * (100, 5, 9), relief(90) * (100, 5, 0) + (0, 0, -9999))),
            "few": tilted(relief(9), 90), "no point": numpy.zeros((0, 3)),
            "one place": numpy.ones((50, 3)),
        }
        for name, xyz in cases.items():
            self.assertEqual(note(make_points(numpy.asarray(xyz, "f8"))), "", name)
        for name in os.listdir(DATA):
            if name.endswith((".vtp", ".xyz", ".csv", ".txt", ".dat")) and "boundary" not in name:
                with self.subTest(name=name):
                    try:
                        points = read(os.path.join(DATA, name)).points
                    except ElevationSurfaceError:
                        continue  # no points
                    self.assertEqual(note(points), "")

    def test_an_upright_wall_names_the_way_out(self):
        upright = tilted(relief(), 90, 0.0)
        upright[:, 1] = 5.0
        with self.assertRaisesRegex(ElevationSurfaceError, "on one line in x,y, .* plane best makes"):
            reconstruct(upright)

    def test_reconstruct_warns(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = reconstruct(tilted(relief(), 80))
        self.assertTrue(any("lie on a wall" in note for note in result.notes))
        self.assertEqual(sum("lie on a wall" in note for note in result.report["notes"]), 1)
        del caught

    def test_the_plane_is_that_of_most_points(self):
        wall = tilted(relief(1000), 90)
        foot = wall[:300] * (1.0, 1.0, 0.0)
        far = wall + (5e5, 5e6, 0.0)
        far[7] = 0.0
        blunder = wall.copy()
        blunder[7, 0] = 1e4
        right = area(reconstruct(wall, plane="best", trim=False, fill=False).surface)
        for name, cloud in (("null", far), ("blunder", blunder), ("foot", numpy.vstack((wall, foot)))):
            with self.subTest(name=name):
                plane, _ = best_plane(make_points(cloud))
                steep = numpy.degrees(numpy.arccos(plane.axes[2][2]))
                self.assertGreater(steep, 75.0)
        self.assertGreater(right, 7000.0)

    def test_points_on_a_line_and_lines_without_heights_are_refused(self):
        line = numpy.arange(9.0)[:, None] * (1.0, 2.0, 3.0) + (5e5, 5e6, 0.0)
        with self.assertRaisesRegex(ElevationSurfaceError, "one line"):
            reconstruct(line, plane="best")
        slope = relief() + (0.0, 0.0, 200.0)
        ring = numpy.array([(20, 20, 0), (80, 25, 0), (75, 80, 0), (25, 70, 0)], "f8")
        with self.assertRaisesRegex(ElevationSurfaceError, "plane.*boundary"):
            reconstruct(slope, boundary=ring, plane="best")


class BestPlane(unittest.TestCase):
    def test_the_surface_is_that_of_the_points_before_they_were_tilted(self):
        level = relief()
        expected = reconstruct(level)
        for degrees in (0, 35, 90, 120):
            result = reconstruct(tilted(level, degrees), plane="best")
            self.assertAlmostEqual(area(result.surface) / area(expected.surface), 1.0, delta=0.002)
            places = vtk_to_numpy(result.surface.GetPoints().GetData())
            ids = vtk_to_numpy(result.surface.GetPointData().GetArray("OriginalPointIds"))
            away = places[ids >= 0] - tilted(level, degrees)[ids[ids >= 0]]
            self.assertLess(abs(away).max(), 1e-9)
            self.assertLess(result.report["distance"]["maximum"], 10.0)

    def test_lines_turn_along(self):
        level = relief()
        ring = numpy.array([(20, 20, 0), (80, 25, 0), (75, 80, 0), (25, 70, 0)], "f8")
        inside = area(reconstruct(level, boundary=ring).surface)
        result = reconstruct(tilted(level, 90), boundary=tilted(ring, 90), plane="best")
        self.assertAlmostEqual(area(result.surface) / inside, 1.0, delta=0.02)
        with self.assertRaisesRegex(ElevationSurfaceError, "plane.*boundary"):
            reconstruct(tilted(level, 90), boundary=ring[:, :2], plane="best")

    def test_the_lattice_is_reported_where_the_points_are(self):
        i, j = (axis.ravel() for axis in numpy.meshgrid(range(30), range(20)))
        level = numpy.column_stack((4.0 * i, 2.0 * j, 0.1 * numpy.sin(i) * numpy.cos(j)))
        points = tilted(level, 60)
        lattice = reconstruct(points, plane="best").report["lattice"]
        numpy.testing.assert_allclose(sorted(lattice["lengths"]), (2.0, 4.0), rtol=1e-3)
        steps, off = numpy.array(lattice["steps"]), points - lattice["origin"]
        number, *_ = numpy.linalg.lstsq(steps.T, off.T, rcond=None)
        self.assertLess(abs(number - number.round()).max(), 0.05)
        self.assertLess(abs(off - number.T @ steps).max(), 0.2)

    def test_pictures_show_how_far_off_the_plane_it_lies(self):
        level = relief(300)
        result = reconstruct(tilted(level, 90), plane="best")
        seen = coordinates_of(result.cloud.plane.levelled(result.surface))
        self.assertAlmostEqual(numpy.ptp(seen[:, 2]) / numpy.ptp(level[:, 2]), 1.0, delta=0.05)
        self.assertAlmostEqual(numpy.ptp(seen[:, 1]) / numpy.ptp(level[:, 1]), 1.0, delta=0.05)

    def test_what_needs_x_and_y_is_refused(self):
        result = reconstruct(tilted(relief(300), 90), plane="best")
        with self.assertRaisesRegex(ElevationSurfaceError, "plane=best"):
            result.to_grid(1.0)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "wall.xyz")
            numpy.savetxt(path, tilted(relief(300), 90))
            for more in (["--grid", "2"], ["--contours", "2"], ["--pieces", "2"]):
                with self.assertRaises(SystemExit):
                    main([path, "--plane", "best", *more])
            out = os.path.join(folder, "wall.vtp")
            main([path, "--plane", "best", "-o", out, "--no-picture"])
            self.assertGreater(file_area(out), 7000.0)


def file_area(path):
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    return area(reader.GetOutput())


if __name__ == "__main__":
    unittest.main()
