# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Holes that are filled level, as lakes: by the filter, in Python, by the program, in memory and pieces."""
import sys
import unittest

import json

import meshes
import numpy
from in_folder import Program
from TestChosenHoles import CENTRES, LAKES, RADIUS, square, surface, survey
from vtkelevationsurface import (
    ElevationSurfaceError, ElevationSurfaceWarning, read_boundary, reconstruct, vtkFillElevationHoles,
)
from vtkelevationsurface.clouds import add_array, add_words, make_lines
from vtkelevationsurface.given_lines import fitted
from vtkelevationsurface.mending import mended
from vtkelevationsurface.messages import Messages
from vtkmodules.util.numpy_support import vtk_to_numpy


def column(outlines, name):
    return vtk_to_numpy(outlines.GetCellData().GetArray(name))


def rim_of(outlines, hole):
    """z along the outline of a hole; the last point is the first."""
    return vtk_to_numpy(outlines.GetCell(hole).GetPoints().GetData())[:-1, 2]


class Filter(unittest.TestCase):
    def setUp(self):
        self.before = surface()
        self.fill = vtkFillElevationHoles()
        self.fill.SetInputData(self.before)
        self.fill.SetInterpolationToLevel()
        self.fill.Update()

    def test_each_hole_has_one_height_and_the_rim_stays(self):
        after, count = self.fill.GetOutput(0), self.before.GetNumberOfPoints()
        points = meshes.points_of(after)
        numpy.testing.assert_array_equal(points[:count], meshes.points_of(self.before))
        levels = column(self.fill.GetOutput(1), "Level")
        new = points[count:]
        near = numpy.argmin([numpy.hypot(*(new[:, :2] - centre).T) for centre in CENTRES], axis=0)
        heights = [set(new[near == i, 2]) for i in range(3)]
        self.assertEqual(set.union(*heights), set(levels))
        self.assertEqual([len(some) for some in heights], [1, 1, 1])
        self.assertTrue(numpy.isnan(vtk_to_numpy(after.GetPointData().GetArray("FilledError"))[count:]).all())

    def test_the_report_has_the_level_and_how_far_the_rim_is_from_it(self):
        outlines = self.fill.GetOutput(1)
        for hole, level in enumerate(column(outlines, "Level")):
            rim = numpy.sort(rim_of(outlines, hole))
            self.assertEqual(level, rim[(len(rim) - 1) // 10])
            self.assertEqual(column(outlines, "RimAboveLevel")[hole], rim[-1] - level)
            self.assertEqual(column(outlines, "RimBelowLevel")[hole], level - rim[0])
        names = outlines.GetCellData().GetAbstractArray("InterpolationName")
        self.assertEqual({names.GetValue(i) for i in range(3)}, {"level"})

    def test_other_methods_have_no_level(self):
        self.fill.SetInterpolationToAdaptive()
        self.fill.Update()
        for name in ("Level", "RimAboveLevel", "RimBelowLevel"):
            self.assertTrue(numpy.isnan(column(self.fill.GetOutput(1), name)).all())


def with_levels(rings, levels, name="water"):
    areas = meshes.rings(rings)
    add_array(areas, name, numpy.array(levels), "Cell")
    return areas


class LevelsOfAreas(unittest.TestCase):
    def fill(self, areas, name="water", **properties):
        """(the filter, {where: level}, its Messages)"""
        fill = vtkFillElevationHoles()
        fill.SetInputData(surface())
        fill.SetAreasData(areas)
        fill.SetLevelArrayName(name)
        for property_name, value in properties.items():
            getattr(fill, "Set" + property_name)(value)
        with Messages(fill) as messages:
            fill.Update()
        outlines, found = fill.GetOutput(1), {}
        for hole in range(outlines.GetNumberOfCells()):
            middle = numpy.reshape(outlines.GetCell(hole).GetBounds(), (3, 2)).mean(axis=1)[:2]
            where = int(numpy.argmin(numpy.hypot(*(numpy.array(CENTRES) - middle).T)))
            found[where] = float(column(outlines, "Level")[hole])
        return fill, found, messages

    def test_a_hole_gets_the_level_of_the_area_that_it_touches(self):
        for dtype in ("f8", "f4", "i4"):
            fill, levels, messages = self.fill(with_levels(LAKES, numpy.array([90, 130], dtype)))
            self.assertEqual((levels[0], levels[2]), (90.0, 130.0))
            self.assertTrue(numpy.isnan(levels[1]))
            self.assertEqual(messages.warnings, [])
            z = meshes.points_of(fill.GetOutput(0))[surface().GetNumberOfPoints():, 2]
            self.assertEqual(set(z), {90.0, 130.0})
            outlines = fill.GetOutput(1)
            for hole in numpy.flatnonzero(~numpy.isnan(column(outlines, "Level"))):
                level, rim = column(outlines, "Level")[hole], rim_of(outlines, hole)
                self.assertEqual(column(outlines, "RimAboveLevel")[hole], rim.max() - level)
                self.assertEqual(column(outlines, "RimBelowLevel")[hole], level - rim.min())

    def test_areas_without_a_number_are_filled_as_others_and_reported(self):
        areas = with_levels([*LAKES, square(*CENTRES[1], 1.0)], [90.0, numpy.nan, 110.0])
        for method, is_known in ((fill_method, fill_method == 5) for fill_method in (3, 5)):
            _, levels, messages = self.fill(areas, Interpolation=method)
            self.assertEqual((levels[0], levels[1]), (90.0, 110.0))
            self.assertEqual(not numpy.isnan(levels[2]), is_known)
            (warning,) = messages.warnings
            self.assertEqual((warning.code, warning.values), ("LevelsMissing", {"holes": "1", "area": "the line (cell 1)"}))

    def test_a_hole_at_areas_of_different_levels_stays_open_and_both_are_named(self):
        areas = with_levels([*LAKES, square(11.5, 11.5, 1.0)], [90.0, 130.0, 91.0])
        fill, levels, messages = self.fill(areas)
        self.assertEqual(levels[2], 130.0)
        self.assertTrue(numpy.isnan(levels[0]))
        self.assertEqual(sorted(column(fill.GetOutput(1), "Status")), [fill.FILLED, fill.FAILED, fill.NOT_CHOSEN])
        (warning,) = messages.warnings
        self.assertEqual(warning.code, "HoleNotFilled")
        self.assertIn("that of the line (cell 0) is 90, that of the line (cell 2) is 91.", str(warning))

    def test_what_cannot_be_is_an_error_that_names_it(self):
        areas = with_levels(LAKES, [90.0, numpy.inf])
        add_array(areas, "pair", numpy.zeros((2, 2)), "Cell")
        add_words(areas.GetCellData(), "shore", ["90", "130"])
        for data, name, properties, code, words in (
            (areas, "depth", {}, "NoLevelArray", '"depth", but the areas have no attribute of single numbers '
             "(cell array) with this name; there are water."),
            (areas, "shore", {}, "NoLevelArray", "with this name, which is text; there are water."),
            (areas, "pair", {}, "NoLevelArray", '"pair", but'),
            (meshes.rings(LAKES), "depth", {}, "NoLevelArray", "with this name."),
            (areas, "water", {}, "InfiniteLevel", "the line (cell 1) has an infinite level"),
            (areas, "water", {"AreaMode": 1}, "LevelsNotUsed", "and AreaMode FillOnly"),
            (None, "water", {}, "LevelsNotUsed", 'LevelArrayName is "water"'),
        ):
            with self.subTest(words=words):
                fill, _, messages = self.fill(data, name, **properties)
                (error,) = messages.errors
                self.assertEqual(error.code, code)
                self.assertIn(words, str(error))
                self.assertEqual(fill.GetOutput(0).GetNumberOfPoints(), 0)
        self.assertEqual(self.fill(areas, "")[2].errors, [])

    def test_a_level_fits_in_the_points_of_the_surface(self):
        areas = with_levels(LAKES, [90.0, -1e300])
        fill = vtkFillElevationHoles()
        fill.SetAreasData(areas)
        fill.SetLevelArrayName("water")
        double, single = surface(), meshes.cloud(meshes.points_of(surface()).astype("f4"))
        single.SetPolys(double.GetPolys())
        for data, precision, fits in ((double, 2, True), (double, 0, False), (single, 2, False), (single, 1, True)):
            fill.SetInputData(data)
            fill.SetOutputPointsPrecision(precision)
            with Messages(fill) as messages:
                fill.Update()
            if fits:
                self.assertEqual(messages.errors, [])
                self.assertIn(-1e300, meshes.points_of(fill.GetOutput(0))[:, 2])
                continue
            (error,) = messages.errors
            self.assertEqual(error.code, "InfiniteLevel")
            self.assertIn('"water", in which the line (cell 1) has an infinite level: -1e+300 is too large for the '
                          "points of the surface, which are float.", str(error))

    def test_overlapping_lakes_with_aligned_shores_keep_their_levels(self):
        boxes = [numpy.array([(x0, 3.0), (x1, 3.0), (x1, 21.0), (x0, 21.0)]) for x0, x1 in ((3.0, 25.0), (20.0, 37.0))]
        for order in (slice(None), slice(None, None, -1)):
            _, levels, messages = self.fill(with_levels(boxes[order], [90.0, 120.0][order]))
            self.assertEqual((levels[0], levels[1], messages.warnings), (90.0, 120.0, []))

    def test_a_river_that_leaves_a_lake_does_not_hide_its_level(self):
        lake, river = square(*CENTRES[0], 7.0), numpy.array([(9.0, 9.0), (11, 9), (11, 25), (9, 25)])
        pond = square(*CENTRES[0], 1.0)
        for other in (river, pond):
            for order in (slice(None), slice(None, None, -1)):
                rings = [lake, other][order]
                self.assertEqual(self.fill(with_levels(rings, [90.0, numpy.nan][order]))[1][0], 90.0)
                fill, levels, messages = self.fill(with_levels(rings, [90.0, 91.0][order]))
                self.assertTrue(numpy.isnan(levels[0]))
                (warning,) = messages.warnings
                self.assertIn("It touches areas with different levels", str(warning))
                self.assertEqual(fill.GetNumberOfFilledHoles(), 0)

    def test_levels_that_differ_are_written_with_the_digits_that_do(self):
        for one, other, words in ((0.3, 0.1 + 0.2, "is 0.29999999999999999, that of the line (cell 1) is 0.30000000000000004"),
                                  (123456789.1, 123456789.2, "is 123456789.1, that of the line (cell 1) is 123456789.2")):
            _, _, messages = self.fill(with_levels(2 * LAKES[:1], [one, other]))
            self.assertIn(words, " ".join(map(str, messages.warnings)))

    def test_a_hole_in_two_rings_is_in_no_area_and_the_warning_says_so(self):
        both = [square(*CENTRES[0], 7.0), square(12.0, 12.0, 7.0)]
        for rings, is_said in ((both, True), ([square(500.0, 500.0, 2.0)], False)):
            (warning,) = self.fill(meshes.rings(rings), "")[2].warnings
            self.assertEqual(warning.code, "AreasTouchNoHole")
            self.assertEqual("A place in two rings, as where they overlap, is in no area." in str(warning), is_said)

    def test_rings_that_are_mended_keep_their_attributes(self):
        eight = numpy.array([(0.0, 0, 0), (4, 4, 0), (4, 0, 0), (0, 4, 0), (0, 0, 0)])  # crosses itself
        open_one = numpy.array([(9.0, 0, 0), (12, 0, 0), (12, 3, 0), (9, 3, 0), (9, 0.01, 0)])
        halves = [numpy.array([(20.0, 0, 0), (25, 0, 0), (25, 5, 0)]), numpy.array([(25.0, 5, 0), (20, 5, 0), (20, 0, 0)])]
        for second, common in ((7.0, 7.0), (numpy.nan, 7.0), (8.0, numpy.nan)):
            lines = make_lines([eight, open_one, *halves], ["a", "b", "c", "d"])
            add_array(lines, "water", numpy.array([5.0, 6.0, 7.0, second]), "Cell")
            rings, notes = mended(lines, "lakes.gpkg")
            self.assertEqual(len(notes), 2)
            names = rings.GetCellData().GetAbstractArray("LineNames")
            water = dict(zip([names.GetValue(i) for i in range(4)], column(rings, "water")))
            self.assertEqual((water["a"], water["b"]), (5.0, 6.0))
            numpy.testing.assert_equal(water["c and 1 more line of its ring"], common)


class OfProgram(Program):
    def geojson(self, file, rings, **attributes):
        features = [
            {"type": "Feature", "properties": {key: values[i] for key, values in attributes.items()},
             "geometry": {"type": "Polygon", "coordinates": [[*ring.tolist(), ring[0].tolist()]]}}
            for i, ring in enumerate(rings)
        ]
        crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}}
        self.file(file, json.dumps({"type": "FeatureCollection", "crs": crs, "features": features}))

    def test_takes_levels_from_an_attribute(self):
        self.file("survey.xyz", "\n".join("%r %r %r" % tuple(row) for row in survey().tolist()))
        third = square(*CENTRES[1], 1.0)
        self.geojson("lakes.geojson", [*LAKES, third], water=[90.5, 131.0, None], depth=[1, 2, 3], name=["a", "b", "c"])
        few = ["survey.xyz", "--maximum-edge-length", "2", "--fill-only", "lakes.geojson", "--no-picture"]
        reports = []
        for more in ([], ["--pieces", "3", "--no-trim", "--open-edge-length", "0"]):
            done = self.call(*few, "--level-attribute", "water", "--report", "r.json", *more)
            self.assertEqual(done.returncode, 0, done.stderr)
            holes = sorted(self.json("r.json")["holes"]["list"], key=lambda hole: hole["centre"])
            reports.append([(h["level"], h["rim_above_level"], h["rim_below_level"]) for h in holes])
            self.assertIn("1 of the filled holes touch areas that have no number in --level-attribute (NaN), the first "
                          "being feature 2, so --interpolation decides", " ".join(done.stdout.split()))
        self.assertEqual(reports[0], reports[1])
        self.assertEqual([level for level, _, _ in reports[0]], [90.5, 131.0, None])
        self.geojson("lakes.geojson", [*LAKES, square(11.5, 11.5, 1.0)], water=[90.5, 131.0, 92.0])
        done = self.call(*few, "--level-attribute", "water")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("that of feature 0 is 90.5, that of feature 2 is 92. Give both the same in --level-attribute",
                      " ".join(done.stdout.split()))
        for arguments, code, words in (
            (["--level-attribute", "water", "--strict"], 1, "was not filled. It touches areas with different levels"),
            (["--level-attribute", "deep"], 1, "lakes.geojson: has no attribute deep of numbers, which "
             "--level-attribute names; those of numbers are water"),
            (["--level-attribute", "WATER"], 1, "are water; did you mean water?"),
        ):
            done = self.call(*few, *arguments)
            self.assertEqual((done.returncode, len(done.stderr.strip().splitlines())), (code, 1), done.stderr)
            self.assertIn(words, done.stderr)
        for arguments, words in (
            (["survey.xyz", "--level-attribute", "water"], "--level-attribute is for the areas of --fill-only"),
            ([*few, "--level-attribute", "water", "--plane", "best"], "--plane and --level-attribute cannot be used"),
        ):
            done = self.call(*arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn(words, done.stderr)

    def test_takes_levels_that_a_file_has_as_text(self):
        self.file("survey.xyz", "\n".join("%r %r %r" % tuple(row) for row in survey().tolist()))
        few = ["survey.xyz", "--maximum-edge-length", "2", "--fill-only", "lakes.geojson", "--no-picture"]
        # Words in an attribute that is called as z are none of an area.
        self.geojson("lakes.geojson", LAKES, water=["90.5", "131"], elevation=["low", "high"])
        done = self.call(*few, "--level-attribute", "water", "--report", "r.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        levels = [hole["level"] for hole in self.json("r.json")["holes"]["list"] if hole["level"]]
        self.assertEqual(sorted(levels), [90.5, 131.0])
        self.geojson("lakes.geojson", LAKES, name=["90.5", "deep"], WithoutZ=[90.5, 131], LineNames=["a", "b"])
        for name, words in (
            ("name", "attribute name, which --level-attribute names, is text: 'deep' is not a number; leave empty "
             "what has none"),
            ("WithoutZ", "has no attribute WithoutZ of numbers, which --level-attribute names; none is of numbers"),
            ("LineNames", "has no attribute LineNames of numbers, which"),
        ):
            done = self.call(*few, "--level-attribute", name)
            self.assertEqual((done.returncode, len(done.stderr.strip().splitlines())), (1, 1), done.stderr)
            self.assertIn("lakes.geojson: " + words, done.stderr)

    def test_attributes_without_any_number_are_there(self):
        self.file("survey.xyz", "\n".join("%r %r %r" % tuple(row) for row in survey().tolist()))
        few = ["survey.xyz", "--maximum-edge-length", "2", "--fill-only", "lakes.geojson", "--no-picture"]
        for values, levels in (([None, None], []), ([" ", "131"], [131.0])):
            self.geojson("lakes.geojson", LAKES, water=values)
            done = self.call(*few, "--level-attribute", "water", "--report", "r.json")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"{2 - len(levels)} of the filled holes touch areas that have no number in", done.stdout)
            found = [hole["level"] for hole in self.json("r.json")["holes"]["list"] if hole["level"]]
            self.assertEqual(found, levels)

    def test_fills_chosen_lakes_level_and_reports_by_how_much(self):
        self.file("survey.xyz", "\n".join("%r %r %r" % tuple(row) for row in survey().tolist()))
        parts = ["\n".join("%.17g %.17g" % tuple(p) for p in [*ring, ring[0]]) for ring in LAKES]
        self.file("lakes.txt", "\n\n".join(parts))
        reports = []
        for more in ([], ["--pieces", "3", "--no-trim", "--open-edge-length", "0"]):
            done = self.call("survey.xyz", "--maximum-edge-length", "2", "--fill-only", "lakes.txt",
                             "--interpolation", "level", "--no-picture", "--report", "r.json", *more)
            self.assertEqual(done.returncode, 0, done.stderr)
            holes = sorted(self.json("r.json")["holes"]["list"], key=lambda hole: hole["centre"])
            reports.append([(h["level"], h["rim_above_level"], h["rim_below_level"]) for h in holes])
            self.assertRegex(done.stdout, r"hole 0 level at \d[\d.]+: its rim lies up to [\d.]+ above and [\d.]+ below")
        self.assertEqual(reports[0], reports[1])
        self.assertEqual([level is None for level, _, _ in reports[0]], [False, False, True])
        for level, above, below in reports[0][:2]:
            self.assertGreater(above, below)
            self.assertLess(above + below, 4.0 * RADIUS)

    def test_refuses_another_word(self):
        self.file("survey.xyz", "0 0 0\n1 0 0\n0 1 0\n")
        done = self.call("survey.xyz", "--interpolation", "flat")
        self.assertEqual(done.returncode, 2)
        self.assertIn("adaptive, cubic-spline, level, not 'flat'", done.stderr)


class Python(unittest.TestCase):
    def test_reconstruct_takes_it(self):
        holes = reconstruct(survey(), maximum_edge_length=2.0, interpolation="level").report["holes"]["list"]
        self.assertEqual([hole["interpolation"] for hole in holes], 3 * ["level"])
        self.assertTrue(all(hole["level"] > 0 for hole in holes))

    def test_reconstruct_takes_the_levels_of_an_attribute(self):
        areas = with_levels(LAKES, [90.0, 130.0])
        result = reconstruct(survey(), maximum_edge_length=2.0, fill_only=areas, level_attribute="water")
        levels = sorted(hole["level"] for hole in result.report["holes"]["list"] if hole["level"])
        self.assertEqual(levels, [90.0, 130.0])
        with self.assertRaisesRegex(ValueError, "^level_attribute is for the areas of fill_only, which are missing$"):
            reconstruct(survey(), level_attribute="water")
        for ring, words in ((areas, "those of numbers are water"), (LAKES[0], "none is of numbers")):
            words = "^fill_only: has no attribute deep of numbers, which level_attribute names; " + words + "$"
            with self.assertRaisesRegex(ElevationSurfaceError, words):
                reconstruct(survey(), maximum_edge_length=2.0, fill_only=ring, level_attribute="deep")
        words = "^fill_only: attribute shore, which level_attribute names, is text; numbers are needed$"
        add_words(areas.GetCellData(), "shore", ["90", "130"])
        with self.assertRaisesRegex(ElevationSurfaceError, words):
            reconstruct(survey(), maximum_edge_length=2.0, fill_only=areas, level_attribute="shore")
        for wrong in (3, ""):
            with self.assertRaisesRegex(ValueError, f"^level_attribute takes a name, not {wrong!r}$"):
                reconstruct(survey(), fill_only=areas, level_attribute=wrong)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
