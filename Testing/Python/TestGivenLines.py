# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Boundaries and faults as they come: with gaps, crossing themselves, without z."""

import re
import sys
import unittest
import warnings
from unittest import mock

import numpy
import meshes
from in_folder import Program
from osgeo import gdal, ogr, osr
from vtkelevationsurface import reading, reconstruct, vtkGridDelaunay2D
from vtkelevationsurface.clouds import Cloud, bare_lines, make_lines, make_points, line_parts
from vtkelevationsurface.draping import Surface, draped
from vtkelevationsurface.mending import length_of, mended
from vtkelevationsurface.algorithms import ReconstructElevationSurface
from vtkelevationsurface.messages import ElevationSurfaceError, Messages
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

gdal.UseExceptions()
ogr.UseExceptions()
osr.UseExceptions()

X, Y = (a.ravel() for a in numpy.meshgrid(*2 * [numpy.arange(0.0, 4001.0, 50.0)]))
HILLS = numpy.column_stack((X, Y, 400.0 + 50.0 * numpy.sin(X / 400.0) * numpy.cos(Y / 300.0)))
SHEET = numpy.array([(x, y, 7.0 + 0.5 * x - 0.25 * y) for y in range(12) for x in range(12)], "f8")


def flat(points):
    """x, y -> x, y, 0"""
    points = numpy.array(points, "f8")
    return numpy.column_stack((points[:, :2], numpy.zeros(len(points))))


EDGE = [(50.0, 50.0), (3900.0, 80.0), (3850.0, 3900.0), (60.0, 3950.0)]


def circle(x, y, radius, count):
    angles = numpy.arange(count + 1) % count * (2.0 * numpy.pi / count)
    across, up = radius * numpy.cos(angles), radius * numpy.sin(angles)
    return flat(numpy.column_stack((x + across, y + up)))


def area_of(surface):
    """The area of a surface in x,y."""
    points, triangles = surface.to_numpy()
    a, b, c = (points[triangles[:, i], :2] for i in range(3))
    u, v = b - a, c - a
    return 0.5 * float(abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum())


def enclosed(ring):
    x, y = ring[:, 0], ring[:, 1]
    return 0.5 * abs(float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum()))


def quietly(*arguments, **more):
    """(Reconstruction, what it warns of)"""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        result = reconstruct(*arguments, fill=False, **more)
    return result, [str(one.message) for one in caught]


def shoreline():
    """57 lines: a shore in 24 parts of which two do not meet the next one, by 3.76 and 0.19; 32
    islands, and one that crosses itself."""
    shore = circle(2000.0, 2000.0, 1500.0, 240)
    parts = [shore[10 * i : 10 * i + 11].copy() for i in range(24)]
    for i, gap in ((4, 3.76), (17, 0.19)):
        along = parts[i][-2] - parts[i][-1]
        parts[i][-1] += gap / numpy.hypot(*along[:2]) * along
    places = [(1200.0 + 200.0 * (i % 8), 1500.0 + 250.0 * (i // 8)) for i in range(32)]
    islands = [circle(x, y, 60.0, 20) for x, y in places]
    crossing = circle(2000.0, 2750.0, 60.0, 20)
    crossing[[5, 6]] = crossing[[6, 5]]
    return shore, islands, crossing, [*parts, *islands, crossing]


class Gaps(unittest.TestCase):
    def test_a_gap_is_closed_and_noted_with_its_ring_place_and_size(self):
        ring = circle(5.5, 5.5, 4.0, 100)
        whole, notes = quietly(SHEET, boundary=make_lines([ring]))
        self.assertEqual(notes, [])
        result, notes = quietly(SHEET, boundary=make_lines([ring[:-1]]))
        self.assertEqual(len(notes), 1)
        self.assertRegex(
            notes[0],
            r"^the boundary: line \(cell 0\) is not closed: its ends are 0\.2513 apart at "
            r"\(9\.5, 5\.5\), which is 1 % of the ring's length 25\.13: closed by a straight edge$",
        )
        self.assertAlmostEqual(area_of(result), area_of(whole), delta=1e-9)
        words = "0.2513 apart.*without --strict it is mended"
        with self.assertRaisesRegex(ElevationSurfaceError, words):
            reconstruct(SHEET, boundary=make_lines([ring[:-1]]), strict=True)

    def test_a_gap_above_a_hundredth_is_an_error_with_its_size(self):
        ring = circle(5.5, 5.5, 4.0, 99)
        with self.assertRaisesRegex(
            ElevationSurfaceError,
            r"not closed.* 0\.2538 apart at .*1\.01 %.*gaps of up to 1 % are closed",
        ) as caught:
            reconstruct(SHEET, boundary=make_lines([ring[:-1]]))
        self.assertEqual(caught.exception.about, "boundary")

    def test_ends_that_nearly_meet_become_one_point(self):
        ring = circle(5.5, 5.5, 4.0, 60)
        ring[-1, :2] += 1e-9
        made, notes = mended(make_lines([ring]), "b")
        names, parts = line_parts(made)
        self.assertEqual((len(names), len(parts[0])), (1, 61))
        numpy.testing.assert_array_equal(parts[0][0], parts[0][-1])
        self.assertRegex(notes[0], "the second is moved onto the first$")

    def test_lines_from_everywhere_meet_in_any_order_and_direction(self):
        random = numpy.random.RandomState(4)
        for run in range(40):
            ring = circle(5.5, 5.5, 4.0, 120)
            cuts = random.choice(numpy.arange(1, 119), random.randint(1, 7), replace=False)
            cuts = numpy.sort(cuts)
            parts = [p.copy() for p in numpy.split(ring, cuts)]
            for i in range(len(parts) - 1):  # split() leaves the edge between two parts out
                near = parts[i + 1][:1] + random.normal(0, 0.01, 3) * (1, 1, 0)
                parts[i] = numpy.vstack((parts[i], near))
            parts = [part[:: random.choice((1, -1))] for part in parts]
            parts = [parts[i] for i in random.permutation(len(parts))]
            with self.subTest(run=run):
                made, notes = mended(make_lines(parts), "b")
                self.assertEqual(len(notes), len(cuts))
                result, _ = quietly(SHEET, boundary=made)
                self.assertEqual(result.boundary.GetNumberOfLines(), 1)
                self.assertAlmostEqual(area_of(result), enclosed(ring), delta=0.5)

    def test_notes_on_many_gaps_name_the_first_and_the_widest(self):
        rings = [circle(10.0 * i, 0.0, 4.0, 100) for i in range(30)]
        for i, ring in enumerate(rings):
            ring[-1, 1] += 0.001 + 0.001 * i
        _, notes = mended(make_lines(rings), "b")
        self.assertEqual(len(notes), 21)
        self.assertEqual(notes[-1], "b: gaps of up to 0.03, and 10 more like these")


class Crossings(unittest.TestCase):
    BOW = flat([(2, 2), (9, 9), (9, 2), (2, 9), (2, 2)])

    def test_each_lobe_stays_and_everything_is_noted(self):
        result, notes = quietly(SHEET, boundary=self.BOW)
        self.assertEqual(notes, [
            "the boundary: the line crosses itself at (5.5, 5.5): made valid by GEOS, 2 polygons, "
            "the largest with 50 % of the area"
        ])
        self.assertAlmostEqual(area_of(result), 24.5, delta=1e-9)
        self.assertEqual(result.boundary.GetNumberOfLines(), 2)
        words = r"itself at \(5\.5, 5\.5\); without --strict"
        with self.assertRaisesRegex(ElevationSurfaceError, words):
            reconstruct(SHEET, boundary=self.BOW, strict=True)

    def test_an_overshoot_does_not_open_a_hole(self):
        ring = flat([(2, 2), (9, 2), (9, 9), (2, 9), (2, 1.5), (3, 1.5), (3, 2.5), (1.5, 2.5),
                     (1.5, 2), (2, 2)])
        result, notes = quietly(SHEET, boundary=ring)
        self.assertEqual(len(notes), 1)
        self.assertRegex(notes[0], "made valid by GEOS")
        middle = numpy.array(result.surface.GetCenter())
        self.assertEqual(result.boundary.GetNumberOfLines(), 1, middle)
        self.assertGreaterEqual(area_of(result), 49.0)

    def test_what_is_valid_is_handed_on_as_it_is(self):
        polygon, cells = make_points([(2, 2, 0), (9, 2, 0), (9, 9, 0)]), vtkCellArray()
        cells.InsertNextCell(3, [0, 1, 2])
        polygon.SetPolys(cells)
        touching = flat([(2, 2), (9, 2), (9, 9), (5.5, 2), (2, 9), (2, 2)])
        for name, boundary in (
            ("a polygon", polygon),
            ("nested", make_lines([circle(5, 5, 4, 40), circle(5, 5, 2, 30)])),
            ("touching itself", make_lines([touching])),
            ("out and back", make_lines([flat([(2, 2), (9, 2), (10, 1), (9, 2), (9, 9), (2, 2)])])),
            ("sharing an edge", make_lines([
                flat([(2, 2), (5, 2), (5, 9), (2, 9), (2, 2)]),
                flat([(5, 2), (9, 2), (9, 9), (5, 9), (5, 2)])])),
            ("in parts", make_lines([
                flat([(2, 2), (9, 2)]), flat([(9, 9), (9, 2)]), flat([(9, 9), (2, 2)])])),
        ):
            with self.subTest(name=name):
                made, notes = mended(boundary, "b", strict=True)
                self.assertIs(made, boundary)
                self.assertEqual(notes, [])

    def test_rings_that_cross_each_other_stay_an_error(self):
        with self.assertRaisesRegex(ElevationSurfaceError, "rings of the boundary cross"):
            reconstruct(SHEET, boundary=[circle(4, 4, 2, 20), circle(6, 6, 2, 20)])

    def test_what_cannot_be_mended_is_reported_by_the_filter(self):
        ring = circle(5, 5, 4, 40)
        spoke, flatly = flat([(5, 5), (9, 5)]), flat([(2, 2), (9, 2), (5, 2), (7, 2), (2, 2)])
        for boundary, words in (
            (make_lines([ring[:21], ring[20:], spoke]), "where 3 lines end"),
            (make_lines([flatly]), "encloses no triangle"),
            (vtkPolyData(), "no line and no polygon"),
        ):
            with self.subTest(words=words):
                made, notes = mended(boundary, "b")
                self.assertEqual((made is boundary, notes), (True, []))
                with self.assertRaisesRegex(ElevationSurfaceError, words):
                    reconstruct(SHEET, boundary=boundary)

    def test_random_rings_become_valid_and_keep_what_they_go_around(self):
        random = numpy.random.RandomState(1)
        field = numpy.array([(x, y, 0.0) for x in range(-2, 13) for y in range(-2, 13)])
        for run in range(60):
            xy = random.rand(9, 2) * 10.0 if run % 2 else random.randint(0, 10, (9, 2)).astype("f8")
            ring = flat(numpy.vstack((xy, xy[:1])))
            with self.subTest(run=run):
                result, notes = quietly(field, boundary=make_lines([ring]))
                shape = ogr.Geometry(ogr.wkbPolygon)
                outline = ogr.Geometry(ogr.wkbLinearRing)
                for x, y, _ in ring.tolist():
                    outline.AddPoint_2D(x, y)
                shape.AddGeometry(outline)
                wanted = shape.MakeValid(["METHOD=STRUCTURE"]).GetArea()
                self.assertAlmostEqual(area_of(result), wanted, delta=1e-9)

    def test_without_gdal_the_error_says_what_to_install(self):
        with mock.patch.dict(sys.modules, {"osgeo": None}):
            words = "crosses itself: .*Install python3-gdal"
            with self.assertRaisesRegex(ElevationSurfaceError, words):
                reconstruct(SHEET, boundary=self.BOW)
            ring = circle(5.5, 5.5, 4.0, 100)[:-1]
            self.assertEqual(len(quietly(SHEET, boundary=make_lines([ring]))[1]), 1)


class OfArraysAndVTK(unittest.TestCase):
    def test_z_of_a_boundary_may_be_missing(self):
        cloud = numpy.random.RandomState(4).rand(400, 3) * (30, 30, 2)
        ring = numpy.array([(5.0, 5), (25, 5), (25, 25), (15, 18), (5, 25)])
        eight = numpy.array([(5.0, 5), (25, 25), (25, 5), (5, 25)])  # is mended
        for corners in (ring, eight):
            some = numpy.column_stack((corners, [9.0, numpy.nan, 3.0, numpy.nan, 1.0][: len(corners)]))
            for edges in ("follow-surface", "straight"):
                surfaces = []
                for rings in (corners, some, numpy.column_stack((corners, numpy.full(len(corners), numpy.nan)))):
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore")
                        surfaces.append(reconstruct(cloud, boundary=rings, boundary_edges=edges).to_numpy()[0])
                numpy.testing.assert_array_equal(surfaces[0], surfaces[1])
                numpy.testing.assert_array_equal(surfaces[0], surfaces[2])
        some = numpy.column_stack((ring, [9.0, 8.0, numpy.nan, 3.0, 1.0]))
        with self.assertRaisesRegex(ElevationSurfaceError, "Point 2 of the boundary's cell 0 has no z .*BoundaryEdges"):
            reconstruct(cloud, boundary=some, boundary_edges="own-elevations")

    def test_own_elevations_of_a_boundary_without_z_are_refused(self):
        cloud = numpy.random.RandomState(4).rand(400, 3) * (30, 30, 2)
        ring = numpy.array([(5.0, 5), (25, 5), (25, 25), (5, 25)])
        for rings in (ring, numpy.column_stack((ring, numpy.full(4, numpy.nan)))):
            with self.assertRaisesRegex(ElevationSurfaceError, r"^the boundary: 1 of 1 line have no z \(first: the line\), "
                                        "which boundary_edges own-elevations would give"):
                reconstruct(cloud, boundary=rings, boundary_edges="own-elevations")

    def test_a_point_of_a_line_that_does_not_exist_is_named_with_the_line(self):
        cloud = numpy.random.RandomState(4).rand(100, 3) * (30, 30, 2)
        for name in ("boundary", "faults", "fill_only", "keep_open"):
            for number in (8, -1, 2**31 - 1):
                lines = make_lines([numpy.array([(5.0, 5, 1), (25, 5, 1), (25, 25, 1), (5, 25, 1), (5, 5, 1)])] * 2)
                lines.GetLines().ReplaceCellAtId(1, 5, [4, 5, 6, number, 4])
                words = r"^%s: point %d of line \(cell 1\) does not exist; there are 8 points$" % (name, number)
                with self.assertRaisesRegex(ElevationSurfaceError, words):
                    reconstruct(cloud, **{name: lines})
                entry = ReconstructElevationSurface()
                entry.SetInputDataObject(0, make_points(cloud))
                entry.SetInputDataObject(("boundary", "faults", "fill_only", "keep_open").index(name) + 1, lines)
                with Messages(entry) as messages:
                    entry.Update()
                (error,) = messages.errors
                self.assertRegex(str(error), r"%s: point -?\d+ of line \(cell 1\) does not exist" % name.title().replace("_", " "))


class Shoreline(Program):
    def setUp(self):
        super().setUp()
        self.shore, self.islands, self.crossing, self.lines = shoreline()
        numpy.savetxt(self.path("hills.xyz"), HILLS, "%.3f")

    def write(self, name, driver, epsg=None):
        reference = osr.SpatialReference()
        if epsg:
            reference.ImportFromEPSG(epsg)
        data = ogr.GetDriverByName(driver).CreateDataSource(self.path(name))
        layer = data.CreateLayer("shore", reference if epsg else None, ogr.wkbLineString)
        for line in self.lines:
            feature, shape = ogr.Feature(layer.GetLayerDefn()), ogr.Geometry(ogr.wkbLineString)
            for x, y, _ in line.tolist():
                shape.AddPoint_2D(x, y)
            feature.SetGeometry(shape)
            layer.CreateFeature(feature)
        return name

    def text(self):
        parts = ["".join(f"{x!r} {y!r}\n" for x, y, _ in line.tolist()) for line in self.lines]
        return self.file("shore.txt", "\n".join(parts))

    def test_57_lines_with_two_gaps_and_a_crossing_are_a_boundary(self):
        self.assertEqual(len(self.lines), 57)
        wanted = enclosed(self.shore) - 33 * enclosed(circle(0, 0, 60, 20))
        as_read = ["shore.txt: text: separated by blanks", "shore.txt: x, y are in columns 1, 2"]
        for name, read, gaps, ring in (
            (self.write("shore.gpkg", "GPKG"), [],
             ("feature 5 and feature 6", "feature 18 and feature 19"), "feature 57"),
            (self.text(), as_read, ("the part from line 49 to 59 and the part from line 61 to 71",
                           "the part from line 205 to 215 and the part from line 217 to 227"),
             "the part from line 993 to 1013"),
        ):
            with self.subTest(name=name):
                done = self.call("hills.xyz", "--boundary", name, "--no-picture", "--no-fill")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                notes = re.findall(rf"note +({name}: .*)\n", done.stdout)
                self.assertEqual(notes[:-3], read)
                notes = notes[-3:]
                for words, lines, gap in zip(notes, gaps, ("3.76", "0.19")):
                    words, place = words.split(" apart at ")
                    self.assertEqual(words, f"{name}: {lines} do not meet: they are {gap}")
                    self.assertRegex(place, r"^\([\d.]+, [\d.]+\), which is 0\.0[\d]+ % of")
                words = f"{ring} crosses itself at (1990.962047, 2807.063391): made valid by GEOS"
                self.assertIn(words, notes[2])
                surface = reading.read(self.path("hills_surface.vtp")).points
                triangles = surface.GetPolys().GetNumberOfCells()
                self.assertGreater(triangles, 4000)
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    boundary = reading.read_boundary(self.path(name))
                    result = reconstruct(HILLS, boundary=boundary, fill=False)
                self.assertAlmostEqual(area_of(result) / wanted, 1.0, delta=1e-3)
                self.assertGreaterEqual(result.boundary.GetNumberOfLines(), 34)
                done = self.call("hills.xyz", "--boundary", name, "--no-picture", "--strict")
                self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1))
                self.assertIn("3.76 apart", done.stderr)

    def test_pieces_mend_the_same(self):
        self.text()
        counts = []
        for way in ((), ("--pieces", "3")):
            way = ("--no-fill", "--no-picture", *way)
            done = self.call("hills.xyz", "--boundary", "shore.txt", *way)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            pattern = r"surface +([\d,]+) triangles|note +(shore.txt: .*)"
            counts.append(re.findall(pattern, done.stdout))
        self.assertEqual(len(counts[0]), 6)
        self.assertEqual(counts[0], counts[1])


def height(p, corners):
    """z at a place, in the triangle of some that holds it; None where none does."""
    to = corners - p
    following = numpy.roll(to, -1, axis=1)
    edges = numpy.hypot(*(following - to)[..., :2].T).T
    areas = to[..., 0] * following[..., 1] - to[..., 1] * following[..., 0]
    deep = (areas / edges).min(axis=1)  # the least distance from an edge
    best = int(numpy.argmax(deep))
    if deep[best] < -1e-9 * edges[best].max() - 8 * numpy.spacing(abs(p[:2]).max()):
        return None
    shares = numpy.maximum(numpy.roll(areas[best], -1), 0.0)  # each of the corner opposite
    return float(shares @ corners[best, :, 2] / shares.sum())


class Draping(Program):
    def assert_on_surface(self, parts, points, tolerance):
        """Every place of the lines is at the height of the surface of the points."""
        mesh = vtkGridDelaunay2D()
        mesh.SetLatticeMode(mesh.OFF)
        mesh.SetInputData(make_points(points))
        mesh.Update()
        corners = meshes.points_of(mesh.GetOutput())[meshes.triangles_of(mesh.GetOutput())]
        for part in parts:
            for p, q in zip(part[:-1], part[1:]):
                for share in (0.0, 0.25, 0.5, 0.8, 1.0):
                    place = p + share * (q - p)
                    z = height(place, corners)
                    self.assertIsNotNone(z, place)
                    self.assertAlmostEqual(z, place[2], delta=tolerance)

    def test_a_draped_fault_has_the_height_of_the_surface_all_along(self):
        random = numpy.random.RandomState(3)
        for run in range(100):
            on_grid, count = run % 2 == 0, random.randint(4, 60)
            xy, ends = random.rand(count, 2) * (1000, 500), random.rand(4, 2) * (1200, 700) - 100
            if on_grid:
                xy, ends = random.randint(0, 8, (count, 2)), random.randint(-1, 9, (4, 2))
            xy = xy + (0.0 if on_grid else numpy.array((500000.0, 6e6)))
            points = numpy.column_stack((xy, 100 + random.rand(count) * 10))
            ends = ends + (0.0 if on_grid else numpy.array((500000.0, 6e6)))
            with self.subTest(run=run):
                line = flat(ends)
                try:
                    surface = Surface(make_points(points), [line], 0, "f")
                except ElevationSurfaceError:
                    continue  # all on one line
                if surface.is_empty:
                    continue  # the line is elsewhere
                parts, lost, _ = surface.drape(line)
                self.assert_on_surface(parts, points, 1e-6)
                whole, *some = map(length_of, [line, *parts])
                self.assertAlmostEqual(whole, sum(some) + lost, delta=1e-6 * whole)

    def test_the_surface_goes_through_the_fault_as_it_was(self):
        fault = numpy.array([(310.0, 420.0), (2715.0, 3050.0), (3500.0, 3100.0)])
        result, notes = quietly(HILLS, faults=fault)
        self.assertEqual(len(notes), 1)
        self.assertIn("the faults: 1 of 1 line without z (first: the line): they follow", notes[0])
        plain, _ = quietly(HILLS)
        added = result.to_numpy()[0][len(HILLS) :]
        self.assertGreater(len(added), 100)
        heights = [one.to_grid(7.0).z for one in (plain, result)]
        self.assertLess(numpy.nanmax(abs(heights[0] - heights[1])), 1e-9)
        self.assertGreater(result.report["faults"]["added_points"], 100)

    def test_z_of_0_counts_as_none_where_the_points_never_have_it(self):
        fault, given = flat([(310.0, 420.0), (2715.0, 3050.0)]), {"faults_z": "given", "trim": False}
        result, notes = quietly(HILLS, faults=fault)
        self.assertRegex(notes[0], "z of its lines is 0 everywhere .*--faults-z given takes the 0")
        self.assertGreater(result.to_numpy()[0][:, 2].min(), 300.0)
        result, notes = quietly(HILLS, faults=fault, **given)
        self.assertEqual((notes, result.to_numpy()[0][:, 2].min()), ([], 0.0))
        result, notes = quietly(HILLS * (1, 1, 0.01) - (0, 0, 4), faults=fault, trim=False)
        self.assertEqual(notes, [])  # the points have 0 too
        other = numpy.vstack((fault, (3000.0, 3000.0, 390.0)))
        self.assertEqual(quietly(HILLS, faults=other, trim=False)[1], [])
        _, notes = quietly(HILLS, faults=other, faults_z="drape")
        self.assertRegex(notes[0], "z of its lines is left aside, as --faults-z says")
        for more in ({"strict": True}, given):
            words = "without z.*--faults-z drape takes"
            with self.assertRaisesRegex(ElevationSurfaceError, words) as caught:
                reconstruct(HILLS, faults=fault[:, :2], **more)
            self.assertEqual(caught.exception.about, "faults")

    def test_what_lies_outside_of_the_points_is_left_out_and_noted(self):
        fault = flat([(3000, 2000), (4500, 2000), (4500, 1000), (3000, 1000)])
        given = {"faults_z": 2}
        faults, notes = draped(Cloud(make_points(HILLS)), make_lines([fault]), "f", given)
        _, parts = line_parts(faults)
        self.assertEqual(len(parts), 2)
        self.assertEqual([part[:, 0].max() for part in parts], [4000.0, 4000.0])
        words = "left out of 1 line without z, a length of 2000 of line (cell 0), at (4500, 2000)"
        self.assertIn(words, notes[1])
        with self.assertRaisesRegex(ElevationSurfaceError, "The constraints do not overlap the points"):
            reconstruct(HILLS, faults=fault[1:3])

    def test_files_without_z_are_draped(self):
        numpy.savetxt(self.path("hills.xyz"), HILLS, "%.3f")
        self.file("two.txt", "310 420\n2715 3050\n\n3000 300\n3000 2000\n")
        segments = ">\n310 420\n2715 3050\n>\n3000 300\n3000 2000\n"
        self.file("segments.gmt", segments)
        self.file("lines.gmt", "# @VGMT1.0 @GLINESTRING\n" + segments)
        lines = "[[[310, 420], [2715, 3050]], [[3000, 300], [3000, 2000]]]"
        shape = '{"type": "MultiLineString", "coordinates": ' + lines + "}"
        self.file("lines.geojson", shape)
        surfaces = set()
        for name in ("two.txt", "lines.gmt", "lines.geojson", "segments.gmt"):
            with self.subTest(name=name):
                faults = reading.read_faults(self.path(name))
                self.assertEqual(bare_lines(faults).tolist(), [True, True])
                run = ("hills.xyz", "--faults", name, "--no-picture", "-o", "s.vtp")
                done = self.call(*run)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                words = f"note +{name}: 2 of 2 lines without z .first: .*: they follow"
                self.assertRegex(done.stdout, words)
                with open(self.path("s.vtp"), "rb") as stream:
                    surfaces.add(stream.read())
                done = self.call(*run, "--faults-z", "given")
                self.assertEqual(done.returncode, 1)
                self.assertIn(f"{name}: 2 of 2 lines without z", done.stderr)
        self.assertEqual(len(surfaces), 1)
        done = self.call("hills.xyz", "--faults-z", "drape")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--faults-z is for the lines of --faults, which is missing", done.stderr)

    def test_points_without_z_of_lines_that_have_some_are_on_the_surface(self):
        plain, _ = quietly(HILLS)
        fault = numpy.array([(310.0, 420.0, 999.0), (1500.0, 1700.0, numpy.nan), (2715.0, 3050.0, numpy.nan)])
        soft = plain.elevation_at(fault[1:, :2])
        for given in ({}, {"maximum_elevation_error": 1.0}, {"maximum_number_of_points": 900}, {"boundary": EDGE}):
            result, notes = quietly(HILLS, faults=fault, **given)
            self.assertIn("the faults: 2 points without z, of lines that have some (first: the line): these take "
                          "that of the surface of the points", notes)
            self.assertEqual(result.report["faults"]["points_without_z"], 2)
            at = result.elevation_at(fault[:, :2])
            numpy.testing.assert_allclose(at, [999.0, *soft], rtol=1e-9)
        ring = numpy.vstack((fault, fault[:1]))  # its first point is not counted twice
        self.assertEqual(quietly(HILLS, faults=ring)[0].report["faults"]["points_without_z"], 2)
        for given in ({"strict": True}, {"faults_z": "given"}):
            words = "2 points without z, of lines that have some .*--faults-z drape takes"
            with self.assertRaisesRegex(ElevationSurfaceError, words):
                reconstruct(HILLS, faults=fault, **given)
        draped_too, _ = quietly(HILLS, faults=fault, faults_z="drape")
        numpy.testing.assert_allclose(
            draped_too.elevation_at(fault[:, :2]), plain.elevation_at(fault[:, :2]), rtol=1e-9)
        with self.assertRaisesRegex(ElevationSurfaceError, "plane best needs lines with z"):
            reconstruct(HILLS, faults=fault, plane="best")

    def test_a_point_without_z_outside_of_the_points_is_an_error_that_names_it(self):
        fault = numpy.array([(310.0, 420.0, 999.0), (1500.0, 1700.0, numpy.nan), (9000.0, 1.0, numpy.nan)])
        with self.assertRaisesRegex(ElevationSurfaceError, "cell 0, at 9000, 1, has no z") as caught:
            reconstruct(HILLS, faults=fault)
        self.assertEqual(caught.exception.about, "faults")
        self.assertIn("(such points: 1)", str(caught.exception))

    def test_a_line_of_vtk_with_no_z_at_all_is_draped(self):
        line = make_lines([numpy.array([(310.0, 420.0, 0.0), (2715.0, 3050.0, 0.0)])])
        for i in range(2):
            line.GetPoints().SetPoint(i, *line.GetPoint(i)[:2], numpy.nan)
        result, notes = quietly(HILLS, faults=line)
        self.assertIn("1 of 1 line without z", notes[0])
        self.assertGreater(result.report["faults"]["added_points"], 100)

    def test_files_with_some_z_are_read(self):
        numpy.savetxt(self.path("hills.xyz"), HILLS, "%.3f")
        self.file("a.gmt", ">\n310 420\n2715 3050 399\n")
        self.file("b.txt", "310 420 nan\n2715 3050 399\n")
        self.file("c.csv", "x,y,z\n310,420,\n2715,3050,399\n")
        self.file("d.geojson", '{"type": "LineString", "coordinates": [[310, 420], [2715, 3050, 399]]}')
        written = set()
        for name in ("a.gmt", "b.txt", "c.csv"):
            with self.subTest(name=name):
                done = self.call("hills.xyz", "--faults", name, "--no-picture", "-o", "s.vtp", "--report", "s.json")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertIn(f"{name}: 1 point without z, of lines that have some", done.stdout)
                self.assertRegex(done.stdout, r"\n +1 point without z, on the surface of the points\n")
                self.assertEqual(self.json("s.json")["faults"]["points_without_z"], 1)
                with open(self.path("s.vtp"), "rb") as stream:
                    written.add(stream.read())
        self.assertEqual(len(written), 1)
        done = self.call("hills.xyz", "--faults", "b.txt", "--no-picture", "--pieces", "2", "--no-trim", "--no-fill")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "b.txt: 1 point without z, .*takes the whole surface in memory")

    def test_polygons_and_empty_cells_keep_their_places(self):
        data, lines, polys = vtkPolyData(), vtkCellArray(), vtkCellArray()
        data.ShallowCopy(make_points([(0, 0, 0), (5, 0, 0), (5, 5, 0), (9, 9, 1)]))
        lines.InsertNextCell(0)
        lines.InsertNextCell(2, [2, 3])
        polys.InsertNextCell(3, [0, 1, 2])
        data.SetLines(lines)
        data.SetPolys(polys)
        names, parts = line_parts(data)
        self.assertEqual(names, ["line (cell 1)", "polygon (cell 2)"])
        self.assertEqual([len(part) for part in parts], [2, 4])
        self.assertEqual(bare_lines(data).tolist(), [False, False])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
