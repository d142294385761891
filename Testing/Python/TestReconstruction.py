# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""reconstruct() as scripts call it: arrays and VTK data in, a Reconstruction out."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy

import on_sheet
from in_folder import draws
from on_sheet import SIZE
import vtkelevationsurface
from vtkelevationsurface import (
    ElevationSurfaceError,
    ElevationSurfaceWarning,
    picture,
    read,
    reconstruct,
)
from vtkelevationsurface.clouds import add_array, make_lines
from vtkelevationsurface.inputs import nodes_of
from vtkelevationsurface.picture.signs import add_scalar_bar, round_text
from vtkelevationsurface.properties import PROPERTIES
from vtkelevationsurface.reconstruction import as_lines
from vtkelevationsurface.writing.xml_writer import named_arrays
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData, vtkRectilinearGrid
from vtkmodules.vtkRenderingCore import vtkRenderer

SHEET = numpy.array(on_sheet.SHEET, "f8")
RING = numpy.array(on_sheet.RING)


class Parts(unittest.TestCase):
    """What larger tests see only in a picture, on several ranks, or in a message."""

    def test_nodes_have_numbers_by_row_and_column_of_the_whole_grid(self):
        pieces = [5, 8, -3, 1, 0, 0], [7, 20, -9, -2, 0, 0]
        whole = numpy.arange(16 * 11).reshape(11, 16)  # columns from 5, rows from -9
        numpy.testing.assert_array_equal(nodes_of(pieces, 0), whole[6:, :4])
        there = whole[:8, 2:]
        there[-2:, :2] = -1  # those of the first
        numpy.testing.assert_array_equal(nodes_of(pieces, 1), there)

    def test_arrays_keep_their_names_in_xml(self):
        data = vtkPolyData()
        for name in ("depth", None):
            array = numpy_to_vtk(numpy.arange(3.0), deep=True)
            array.SetName(name)
            data.GetPointData().AddArray(array)
        self.assertEqual(
            [name for name, _, _ in named_arrays(data.GetPointData())], ["depth", "Array1"])

    def test_the_bar_of_colours_is_higher_than_wide(self):
        colours, renderer = vtkLookupTable(), vtkRenderer()
        colours.SetRange(0.0, 10.0)
        add_scalar_bar(renderer, colours, "z", 1200, 900)
        props = renderer.GetViewProps()
        width, height, _ = props.GetItemAsObject(0).GetPosition2Coordinate().GetValue()
        self.assertGreater(height, 2 * width)

    def test_colours_go_from_the_lowest_to_the_highest_elevation(self):
        for low, high, expected in ((2.0, 12.0, (2.0, 12.0)), (5.0, 5.0, (5.0, 6.0))):
            self.assertEqual(picture.colour_map(low, high).GetRange(), expected)

    def test_a_number_in_a_picture_has_no_more_digits_than_it_needs(self):
        for value, text in (
            (0.0, "0"), (2.5, "2.5"), (0.125, "0.125"), (1234567.0, "1,234,567"), (250.04, "250"),
            (0.000025, "2.5e-05"), (-0.0004, "-0.0004"), (2.5e7, "2.5e+07"),
        ):
            self.assertEqual(round_text(value), text)


class Input(unittest.TestCase):
    def test_arrays_lists_and_vtk_data_give_the_same_surface(self):
        data = vtkPolyData()
        points = vtkPoints()
        points.SetData(numpy_to_vtk(SHEET, deep=True))
        data.SetPoints(points)
        expected = reconstruct(SHEET).to_numpy()
        for given in (SHEET.tolist(), SHEET.astype("i8") * 0 + SHEET, data):
            for one, other in zip(reconstruct(given).to_numpy(), expected):
                numpy.testing.assert_array_equal(one, other)

    def test_points_of_whole_numbers_are_points(self):
        places = numpy.array([[0, 0, 5], [7, 0, 1], [0, 7, 2], [7, 8, 3], [3, 3, 9]], "i4")
        data, points = vtkPolyData(), vtkPoints()
        points.SetData(numpy_to_vtk(places, deep=True))
        data.SetPoints(points)
        result, expected = reconstruct(data), reconstruct(places)
        self.assertEqual(result.report["bounds"], expected.report["bounds"])
        for one, other in zip(result.to_numpy(), expected.to_numpy()):
            numpy.testing.assert_array_equal(one, other)

    def test_point_data_come_along(self):
        data = vtkPolyData()
        points = vtkPoints()
        points.SetData(numpy_to_vtk(SHEET, deep=True))
        data.SetPoints(points)
        array = numpy_to_vtk(SHEET[:, 2] * 2, deep=True)
        array.SetName("Amplitude")
        data.GetPointData().AddArray(array)
        kept = reconstruct(data).surface.GetPointData().GetArray("Amplitude")
        numpy.testing.assert_array_equal(vtk_to_numpy(kept), SHEET[:, 2] * 2)

    def test_a_file_that_was_read_is_taken(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.xyz")
            numpy.savetxt(path, SHEET)
            result = reconstruct(read(path))
        self.assertEqual(result.surface.GetNumberOfPolys(), 2 * (SIZE - 1) ** 2)

    def test_what_is_not_a_cloud_of_points_is_refused_in_words(self):
        for points, error, words in (
            (SHEET[:, :2], ValueError, "rows of 3 numbers are needed, or x= and y= of a grid; the shape is 144 x 2"),
            (SHEET[0], ValueError, "the shape is 3"),
            (numpy.empty((0, 3)), ValueError, "the shape is 0 x 3"),
            ([["a", "b", "c"]], TypeError, "points: not an array of numbers"),
            (None, ValueError, "points"),
            ("a.xyz", TypeError, "use reconstruct(read('a.xyz'))"),
            (vtkImageData(), TypeError, "vtkImageData has no elevations"),
            (vtkPolyData(), ElevationSurfaceError, "there are none"),
        ):
            with self.subTest(points=type(points)):
                with self.assertRaises(error) as caught:
                    reconstruct(points)
                self.assertIn(words, str(caught.exception))

    def test_a_boundary_is_an_array_a_list_or_vtk_data(self):
        closed = numpy.vstack((RING, RING[:1]))
        counts = set()
        for boundary in (RING, closed, [RING], as_lines(RING, "boundary", True)):
            result = reconstruct(SHEET, boundary=boundary)
            counts.add(result.surface.GetNumberOfPolys())
            self.assertEqual(result.boundary.GetNumberOfLines(), 1)
        self.assertEqual(len(counts), 1)
        xy = result.to_numpy()[0][numpy.unique(result.to_numpy()[1]), :2]
        self.assertEqual((xy.min(), xy.max()), (0.5, 9.5))
        hole = RING * 0.2 + 4
        result = reconstruct(SHEET, boundary=[RING, hole], fill=False)
        self.assertEqual(result.boundary.GetNumberOfLines(), 2)
        for count, words in ((2, "2 points"), (1, "1 point")):
            with self.assertRaisesRegex(ValueError, f"^boundary: a ring has {words}; 3 are needed$"):
                reconstruct(SHEET, boundary=RING[:count])
        for name in ("boundary", "faults", "fill_only", "keep_open"):
            for empty in ([], numpy.zeros((0, 2))):
                with self.assertRaisesRegex(ValueError, f"^{name}: is empty; leave it out"):
                    reconstruct(SHEET, **{name: empty})
            for other in (numpy.array(3.0), {}, 3):
                with self.assertRaisesRegex(TypeError, f"^{name}: vtkPolyData, an array, or a list of arrays"):
                    reconstruct(SHEET, **{name: other})

    def test_images_and_grids_are_rasters_of_their_scalars(self):
        image, grid = vtkImageData(), vtkRectilinearGrid()
        image.SetDimensions(SIZE, SIZE, 1)
        grid.SetDimensions(SIZE, SIZE, 1)
        for axis in "XY":
            getattr(grid, f"Set{axis}Coordinates")(numpy_to_vtk(numpy.arange(SIZE, dtype="f8"), deep=True))
        z = SHEET[:, 2].copy()
        z[[5, 5 * SIZE + 5, 5 * SIZE + 6]] = numpy.nan
        expected = None
        for data in (image, grid):
            data.GetPointData().SetScalars(numpy_to_vtk(z, deep=True))
            result = reconstruct(data)
            self.assertEqual(result.cloud.points.GetNumberOfPoints(), SIZE * SIZE - 3)
            # The missing pixel at the border is outside: one cell and a half less on each side of it.
            self.assertEqual(result.triangles["delaunay"] - result.triangles["trimmed"], 1)
            expected = expected or result.to_numpy()[1].tolist()
            self.assertEqual(result.to_numpy()[1].tolist(), expected)

    def test_masked_values_are_not_finite(self):
        masked = numpy.ma.masked_array(SHEET, SHEET[:, 2:] * [1, 1, 1] == SHEET[5, 2])
        report = reconstruct(masked).report
        self.assertEqual(list(report["unused_reasons"]), ["not finite"])

    def test_points_left_out_are_measured_but_not_those_that_are_not_finite(self):
        points = numpy.vstack((SHEET, SHEET[:3] + (0, 0, 1), [(numpy.nan, 1.0, 1.0)]))
        with warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)
            report = reconstruct(points, duplicates="keep-first").report
        self.assertGreater(report["distance"]["maximum"], 0.5)

    def test_faults_become_edges(self):
        fault = numpy.array([(2.0, 2.5, 9.0), (8.0, 2.5, 9.0)])
        result = reconstruct(SHEET, faults=fault, trim=False, fill=False)
        self.assertEqual(result.surface.GetNumberOfPoints(), len(SHEET) + 2)
        self.assertEqual(result.report["faults"]["added_points"], 2)
        with self.assertRaisesRegex(TypeError, "use read_faults"):
            reconstruct(SHEET, faults="faults.txt")

    def test_faults_through_nodes_are_not_taken_for_lost_where_these_are_rounded(self):
        x, y = (axis.ravel() for axis in numpy.meshgrid(numpy.arange(30.0), numpy.arange(30.0)))
        # A length that is rounded up reaches beyond the end of its line, and nodes near a line are aside of it.
        for step, origin, places in (
            (25.0, (0, 0), [(0, 0, 29, 29)]),
            (1e-3, (12, 47), [(1, 1, 9, 5), (7, 7, 8, 0)]),
            (1e-3, (12, 47), [(4, 11, 0, 9), (3, 11, 10, 4)]),
        ):
            grid = numpy.column_stack((x * step + origin[0], y * step + origin[1], 0 * x + 5.0))
            given = [numpy.array([(a, b), (c, d)]) * step + origin for a, b, c, d in places]
            faults = [numpy.column_stack((xy, (1.0, 1.0))) for xy in given]
            with self.subTest(step=step, places=places):
                self.assertEqual(reconstruct(grid, faults=faults).report["notes"], [])

    def test_faults_that_are_lost_as_gaps_are_noted(self):
        x, y = (axis.ravel() for axis in numpy.meshgrid(25.0 * numpy.arange(40), 25.0 * numpy.arange(40)))
        points = numpy.column_stack((x, y, numpy.where(x < 510, 0.0, -40.0)))

        def faults(count):  # one through nodes of the grid, too
            y = numpy.linspace(100, 850, count)
            places = (509.5, 0.0), (510.5, -40.0), (250.0, 0.0)
            return [numpy.column_stack((0 * y + x, y, 0 * y + z)) for x, z in places]

        def throw(result):
            return numpy.subtract(*result.elevation_at([(509, 500), (511, 500)]))

        with self.assertWarnsRegex(ElevationSurfaceWarning, "8 of 12 edges of the faults are not in the surface"):
            result = reconstruct(points, faults=faults(5))
        self.assertLess(throw(result), 10.0)
        self.assertIn("the first from (509.5, 100) to (509.5, 287.5): give the lines", result.report["notes"][0])
        with self.assertRaisesRegex(ElevationSurfaceError, "8 of 12 edges of the faults"):
            reconstruct(points, faults=faults(5), strict=True)
        there_and_back = [numpy.vstack((line, line[-2::-1])) for line in faults(5)]
        with self.assertWarnsRegex(ElevationSurfaceWarning, "8 of 12 edges of the faults"):
            reconstruct(points, faults=there_and_back)
        with self.assertWarnsRegex(ElevationSurfaceWarning, "edges of the faults are not in the surface"):
            reconstruct(points, faults=faults(20), maximum_edge_length=36)
        for count, options in ((20, {}), (5, {"trim": False}), (5, {"boundary": [[0, 0], [975, 0], [975, 975]]})):
            result = reconstruct(points, faults=faults(count), **options)
            self.assertAlmostEqual(throw(result), 40.0, delta=0.5)
            self.assertEqual(result.report["notes"], [])


class Properties(unittest.TestCase):
    def test_each_reaches_its_filter(self):
        given = {
            "maximum_edge_length": (30.0, "delaunay", "GetMaximumEdgeLength", 30.0),
            "maximum_elevation_error": (0.1, "delaunay", "GetMaximumElevationError", 0.1),
            "maximum_number_of_points": (9, "delaunay", "GetMaximumNumberOfPoints", 9),
            "data_dependent_edges": (True, "delaunay", "GetDataDependentEdges", 1),
            "duplicates": ("keep-lowest", "delaunay", "GetDuplicatePolicy", 2),
            "lattice_mode": ("off", "delaunay", "GetLatticeMode", 1),
            "lattice_tolerance": (0.125, "delaunay", "GetLatticeTolerance", 0.125),
            "search_strategy": ("Compactness", "delaunay", "GetSearchStrategy", 1),
            "outward_test": ("inward_normal", "trim", "GetOutwardTest", 1),
            "gap_tolerance": (6, "trim", "GetGapTolerance", 6.0),
            "recover_boundary": (False, "trim", "GetRecoverBoundary", 0),
            "boundary_edges": ("own elevations", "trim", "GetBoundaryEdges", 2),
            "fill_cut_outs": (True, "fill", "GetFillCutOuts", 1),
            "open_edge_length": (40, "fill", "GetOpenEdgeLength", 40.0),
            "maximum_hole_size": (5, "fill", "GetMaximumHoleSize", 5.0),
            "maximum_hole_edges": (7, "fill", "GetMaximumHoleEdges", 7),
            "maximum_expected_points": (900, "fill", "GetMaximumNumberOfExpectedPoints", 900),
            "spacing": (0.5, "fill", "GetSpacing", 0.5),
            "match_density": (False, "fill", "GetMatchDensity", 0),
            "interpolation": ("thin plate", "fill", "GetInterpolation", 2),
            "level_attribute": ("water", "fill", "GetLevelArrayName", "water"),
            "confidence_level": (0.8, "fill", "GetConfidenceLevel", 0.8),
            "interpolate_point_data": (False, "fill", "GetInterpolatePointData", 0),
            "threads": (1, "fill", "GetNumberOfThreads", 1),
        }
        lake = make_lines([numpy.array([(1.0, 1, 0), (2, 1, 0), (2, 2, 0), (1, 1, 0)])])
        add_array(lake, "water", [7.0], "Cell")
        needs = {"data_dependent_edges": {"maximum_elevation_error": 0.1}, "level_attribute": {"fill_only": lake}}
        described = {name for name, one in PROPERTIES.items() if one.setter}
        # Done by none of them; for areas alone, see TestLevelHoles.
        others = {"remove_unused_points", "level_attribute"}
        self.assertEqual(set(given) | others, described)
        for name, (value, step, getter, expected) in given.items():
            with self.subTest(name=name):
                result = reconstruct(SHEET, **{name: value}, **needs.get(name, {}))
                self.assertEqual(getattr(getattr(result, step), getter)(), expected)

    def test_new_points_are_as_dense_as_those_around_them(self):
        random = numpy.random.default_rng(4)
        xy = 60 * random.random((3600, 2))
        is_lost = numpy.hypot(*(xy - 30).T) < 14
        points = numpy.column_stack((xy, numpy.sin(xy[:, 0] / 7)))[~is_lost]
        counts = {}
        for name, given in (("chain", {}), ("on", {"match_density": True}), ("off", {"match_density": False})):
            result = reconstruct(points, **given)
            counts[name] = result.report["holes"]["inserted_points"]
            self.assertEqual(result.fill.GetMatchDensity(), name != "off")
        self.assertEqual(counts["chain"], counts["on"])
        self.assertGreater(counts["on"], 0.6 * is_lost.sum())
        self.assertLess(counts["on"], 1.2 * is_lost.sum())
        self.assertLess(counts["off"], 0.3 * is_lost.sum())

    def test_a_few_dense_places_do_not_multiply_new_points(self):
        random = numpy.random.default_rng(4)
        xy = 500 * random.random((2500, 2))
        dense = xy[random.choice(len(xy), 12, replace=False)]
        xy = numpy.concatenate((xy, *(place + random.normal(0, 0.005, (1000, 2)) for place in dense)))
        points = numpy.column_stack((xy, numpy.sin(xy[:, 0] / 90)))
        on, off = (
            reconstruct(points, match_density=matches, maximum_edge_length=16.0, trim=False)
            for matches in (True, False)
        )
        new = [result.report["holes"]["inserted_points"] for result in (on, off)]
        self.assertGreater(new[1], 100)
        self.assertLess(new[0], 6 * new[1])

    def test_the_density_is_left_out_where_it_takes_too_many_points(self):
        """A lake 1.4 km wide in a dense strip of soundings, with a shore of few points."""
        random = numpy.random.default_rng(6)
        angles, radii = numpy.arange(0, 2 * numpy.pi, 0.03), 700 + 2 * (0.05 + random.random(14000))
        around = 2 * numpy.pi * random.random(14000)
        xy = numpy.concatenate((
            700 * numpy.column_stack((numpy.cos(angles), numpy.sin(angles))),
            radii[:, None] * numpy.column_stack((numpy.cos(around), numpy.sin(around)))))
        points = numpy.column_stack((xy, xy[:, 0] / 100))
        given = {"maximum_edge_length": 25.0}
        with self.assertWarnsRegex(
                ElevationSurfaceWarning, "not as dense as the surface around: about [0-9,]+ would be needed; "
                "maximum_expected_points or spacing decides"):
            result = reconstruct(points, **given)
        self.assertFalse(result.fill.GetMatchDensity())
        without = reconstruct(points, match_density=False, **given)
        self.assertEqual(result.report["holes"]["inserted_points"], without.report["holes"]["inserted_points"])
        self.assertGreater(result.report["holes"]["inserted_points"], 10000)

    def test_too_many_expected_points_name_the_density(self):
        random = numpy.random.default_rng(4)
        xy = 60 * random.random((3600, 2))
        points = numpy.column_stack((xy, xy[:, 0]))[numpy.hypot(*(xy - 30).T) > 14]
        with self.assertRaisesRegex(RuntimeError, "With MatchDensity off there would be fewer"):
            reconstruct(points, maximum_expected_points=100)

    def test_misspelt_names_and_wrong_values_raise(self):
        with self.assertRaisesRegex(TypeError, "maximum_edge_lenght; did you mean maximum_edge_length"):
            reconstruct(SHEET, maximum_edge_lenght=3)
        with self.assertRaisesRegex(TypeError, "no property zebra$"):
            reconstruct(SHEET, zebra=3)
        for name, value in (
            ("gap_tolerance", -1),
            ("gap_tolerance", float("nan")),
            ("spacing", "wide"),
            ("maximum_hole_edges", 1.5),
            ("interpolation", "splines"),
            ("recover_boundary", "no"),
            ("lattice_tolerance", 0.3),
            ("threads", -1),
            ("threads", float("inf")),
        ):
            with self.subTest(name=name, value=value):
                with self.assertRaisesRegex(ValueError, f"^{name} takes .*, not "):
                    reconstruct(SHEET, **{name: value})
        with self.assertRaisesRegex(ValueError, "spacing: 1e-10 is too small"):
            reconstruct(SHEET + 1e6, spacing=1e-10)

        with self.assertRaisesRegex(TypeError, "no option colums; did you mean columns"):
            read("a.xyz", colums=(1, 2, 3))
        with self.assertRaisesRegex(ValueError, "columns takes three names"):
            read("a.xyz", columns="X,Y")

    def test_columns_are_given_as_on_the_command_line_or_as_a_list(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.txt")
            with open(path, "w", encoding="ascii") as stream:
                stream.write("A B C D\n" + "".join(f"9 {x:g} {y:g} {z:g}\n" for x, y, z in SHEET))
            for columns in ("B,C,D", ("B", "C", "D"), (2, 3, 4), "2, 3, 4"):
                points = read(path, columns=columns).points
                xyz = vtk_to_numpy(points.GetPoints().GetData())
                numpy.testing.assert_array_equal(xyz, SHEET)

    def test_errors_of_filters_raise_and_warnings_warn(self):
        with self.assertRaisesRegex(ElevationSurfaceError, "on one line"):
            reconstruct(numpy.arange(9.0).reshape(3, 3))
        with self.assertRaisesRegex(ElevationSurfaceError, "boundary") as caught:
            reconstruct(SHEET, boundary=RING + 100)
        self.assertEqual(caught.exception.about, "boundary")
        lone = [(SIZE + 60.0 + 60.0 * line, float(i), 0.0) for line in range(2) for i in range(40)]
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = reconstruct(numpy.vstack((SHEET, lone)), fill=False)
        self.assertEqual([w.category for w in caught], [ElevationSurfaceWarning])
        self.assertIn("leaves out 80 points", str(caught[0].message))
        self.assertEqual(caught[0].filename, __file__)
        self.assertEqual(len(result.notes), 1)

    def test_more_effort_than_is_expected_is_refused_with_a_way_out(self):
        sheet = SHEET[numpy.hypot(SHEET[:, 0] - 5.5, SHEET[:, 1] - 5.5) > 3.0]
        for given, limit in ({"spacing": 1e-3, "maximum_expected_points": 30_000}, 30_000), ({"maximum_expected_points": 9}, 9):
            with self.subTest(given=given):
                with self.assertRaisesRegex(ElevationSurfaceError, "would do, or a larger") as raised:
                    reconstruct(sheet, maximum_edge_length=3.0, trim=False, **given)
                spacing = float(re.search(r"A Spacing of (\S+) would", str(raised.exception)).group(1))
                result = reconstruct(
                    sheet, maximum_edge_length=3.0, trim=False, **{**given, "spacing": spacing})
                inserted = result.surface.GetNumberOfPoints() - len(sheet)
                self.assertLessEqual(inserted, limit)
                self.assertGreater(inserted, 0)

    def test_progress_is_reported_and_can_stop_the_run(self):
        steps = []
        reconstruct(SHEET, progress=lambda text, fraction: steps.append((text, fraction)))
        self.assertEqual(
            sorted({text for text, _ in steps}), ["filling holes", "triangulating", "trimming"]
        )
        self.assertTrue(all(0 <= fraction <= 1 for _, fraction in steps))

        def stop(_text, _fraction):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            reconstruct(SHEET, progress=stop)


class Result(unittest.TestCase):
    def test_the_report_covers_every_point(self):
        report = reconstruct(numpy.vstack((SHEET, SHEET[:2], [(1, 1, numpy.nan)]))).report
        self.assertEqual(report["points"], len(SHEET) + 3)
        reasons = {"same x,y as another point": 2, "not finite": 1}
        self.assertEqual(report["unused_reasons"], reasons)
        self.assertLess(report["distance"]["maximum"], 1e-12)

    def test_steps_that_are_left_out_have_no_results(self):
        result = reconstruct(SHEET, trim=False, fill=False)
        self.assertIsNone(result.boundary)
        self.assertIsNone(result.holes)
        self.assertNotIn("trim", result.report)

    @draws
    def test_it_is_written_and_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a")
            result = reconstruct(SHEET)
            result.write(path + ".vtp")
            result.plot(path + ".png", "A sheet")
            with open(path + ".png", "rb") as stream:
                self.assertEqual(stream.read(4), b"\x89PNG")
            again = read(path + ".vtp").points
            with self.assertRaisesRegex(ElevationSurfaceError, "a.xyz: .xyz cannot be written"):
                result.write(path + ".xyz")
            with self.assertRaisesRegex(ElevationSurfaceError, "a.jpg: .jpg cannot be written as"):
                result.plot(path + ".jpg")
            with self.assertRaisesRegex(ValueError, "colours takes elevation or error"):
                result.plot(path + ".png", colours="slope")
            with self.assertRaisesRegex(ValueError, "view takes"):
                result.plot(path + ".png", view=(10, 100))
        self.assertEqual(repr(result), "<Reconstruction: 144 points, 242 triangles>")
        points, triangles = result.to_numpy()
        numpy.testing.assert_array_equal(vtk_to_numpy(again.GetPoints().GetData()), points)
        self.assertEqual(triangles.shape, (2 * (SIZE - 1) ** 2, 3))


class Package(unittest.TestCase):
    def test_names_are_there_and_others_are_errors(self):
        self.assertIn("reconstruct", dir(vtkelevationsurface))
        with self.assertRaisesRegex(AttributeError, "no attribute 'reconstrct'"):
            vtkelevationsurface.reconstrct  # pylint: disable=pointless-statement

    def test_the_filters_need_no_numpy(self):
        # Where VTK has it, a newer one loads it itself.
        script = "import sys; sys.modules['numpy'] = None; import vtkelevationsurface as surface; "
        script += "surface.vtkGridDelaunay2D()"
        self.assertEqual(subprocess.run([sys.executable, "-c", script], check=False).returncode, 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
