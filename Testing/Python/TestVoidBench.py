# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""void-bench keeps to its protocol: what is drawn, how it is measured, and what is reported as missing."""

import csv
import os
import re
import sys
import unittest

import forked
import numpy
from in_folder import InFolder

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BENCHMARKS = os.path.join(ROOT, "Utilities", "Benchmarks")
sys.dont_write_bytecode = True  # nothing is to be left next to the scripts
sys.path.append(BENCHMARKS)

import VoidDraw  # noqa: E402
import VoidMethods  # noqa: E402
import VoidPeers  # noqa: E402
import VoidTables  # noqa: E402

SIZES = (4, 20, 100)
VoidDraw.ATTEMPTS = 20  # the rasters below have two of the kinds, and no more attempts would find others
# What a method of one's own may look like: the mean of what is known, in an interval around it; the
# voids of more than fifty nodes are too much for it in one of three ways.
MEAN = """import sys, numpy, time
print("a library's greeting"); print("ready", flush=True)
for line in sys.stdin:
    source, target = line.rstrip("\\n").split("\\t")
    values = numpy.fromfile(source)
    size = int(values[0]) * int(values[1])
    heights, lost = values[4:4 + size], values[4 + size:] > 0
    if lost.sum() > 50:
        ACTION
    mean = numpy.full(size, numpy.nanmean(heights))
    spread = numpy.nanmax(heights) - numpy.nanmin(heights)
    numpy.concatenate((mean, mean - spread, mean + spread)).tofile(target)
    print("done 0.25", flush=True)
"""


def hills(rows, columns, roughness=0.0, height=1.0, seed=1):
    random = numpy.random.RandomState(seed)
    y, x = numpy.mgrid[:rows, :columns]
    waves = numpy.sin(0.11 * x + 0.05 * y) + numpy.cos(0.09 * y - 0.07 * x)
    return height * (waves + roughness * random.standard_normal((rows, columns)))


def rasters():
    with_gap = hills(60, 70, 0.02)
    with_gap[20:30, 30:40] = numpy.nan
    return [VoidDraw.Raster("gap", with_gap, (2.0, 3.0), "lattice"),
            VoidDraw.Raster("rough", hills(80, 50, 1.0), (30.0, 30.0), "lattice")]


VOIDS = VoidDraw.draw(rasters(), 1, 1, SIZES)


class Draw(unittest.TestCase):
    VOIDS = VoidDraw.draw(rasters(), 2, 3, SIZES)

    def test_the_same_seed_gives_the_same_voids_and_another_seed_gives_others(self):
        first, again, other = map(VoidDraw.fingerprint, (
            VOIDS, *(VoidDraw.draw(rasters(), 1, seed, SIZES) for seed in (1, 2))))
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)

    def test_by_default_there_are_six_kinds_eight_sizes_and_more_than_1300_voids(self):
        self.assertEqual(len(VoidDraw.KINDS), 6)
        self.assertEqual(len(VoidDraw.SIZES), 8)
        self.assertGreaterEqual(6 * 8 * 28, 1300)
        with open(os.path.join(BENCHMARKS, "void-bench"), encoding="utf-8") as stream:
            self.assertIn('"--voids", type=positive, default=28', stream.read())

    def test_a_size_is_complete_where_a_kind_has_no_room(self):
        for size in SIZES:
            self.assertEqual(sum(void.size == size for void in self.VOIDS), 12)

    def test_voids_lie_where_heights_are_known_with_known_rows_around_them(self):
        for void in self.VOIDS:
            near = numpy.pad(void.lost, VoidDraw.RING)
            rows, columns = void.lost.shape
            around = numpy.zeros(void.lost.shape, bool)
            for i in range(2 * VoidDraw.RING + 1):
                for j in range(2 * VoidDraw.RING + 1):
                    around |= near[i : i + rows, j : j + columns]
            self.assertFalse(numpy.isnan(void.heights[around]).any())
            self.assertTrue(numpy.isnan(void.damaged()[void.lost]).all())
            self.assertGreaterEqual(void.lost.sum(), 0.9 * void.size)
            self.assertLessEqual(void.lost.sum(), 1.3 * void.size)

    def test_there_is_room_where_all_nodes_within_the_ring_are_known_and_nowhere_else(self):
        for raster in rasters():
            ring = VoidDraw.RING
            near = numpy.pad(raster.heights, ring, constant_values=numpy.nan)
            windows = numpy.lib.stride_tricks.sliding_window_view(near, (2 * ring + 1, 2 * ring + 1))
            expected = ~numpy.isnan(windows).any(axis=(2, 3))
            numpy.testing.assert_array_equal(VoidDraw.Places(raster).free, expected)

    def test_known_nodes_around_a_void_have_one_fan_of_triangles(self):
        for void in self.VOIDS:
            known = ~void.lost
            self.assertTrue((VoidDraw.fans(known) == 1).all())
            mesh = VoidPeers.triangles_of(known)
            self.assertEqual(set(mesh.ravel()), set(numpy.flatnonzero(known)))

    def test_a_pinch_is_lost_too(self):
        lost = numpy.zeros((9, 9), bool)
        lost[4, 3] = lost[4, 5] = True
        self.assertEqual(VoidDraw.fans(~lost)[3, 3], 2)
        self.assertTrue(VoidDraw.without_pinches(lost)[4, 4])

    def test_about_a_quarter_of_the_large_shapes_has_an_island_and_no_small_one(self):
        for size, least, most in ((4, 0, 0), (45, 0, 0), (400, 6, 16)):
            shapes = VoidDraw.shapes_of(size, numpy.random.RandomState(5))
            self.assertEqual(len(shapes), 48)
            islands = sum(island for _, island in shapes)
            self.assertLessEqual(islands, most)
            self.assertGreaterEqual(islands, least)


class Kinds(unittest.TestCase):
    def test_slopes_make_plains_hills_and_mountains(self):
        heights = hills(50, 50)
        steep = VoidDraw.slope(heights, (1.0, 1.0))
        for slope, land in ((0.04, "plain"), (0.06, "hills"), (0.19, "hills"), (0.21, "mountains")):
            self.assertEqual(VoidDraw.kind_of(heights * slope / steep, (1.0, 1.0)), f"smooth {land}")

    def test_white_noise_has_the_roughness_of_its_formula_and_waves_have_little(self):
        noise = numpy.random.RandomState(2).standard_normal((200, 200))
        self.assertAlmostEqual(VoidDraw.roughness(noise, (1.0, 5.0)), (1.25 / 2) ** 0.5, delta=0.01)
        self.assertLess(VoidDraw.roughness(hills(80, 80), (1.0, 1.0)), 0.1)
        self.assertTrue(VoidDraw.kind_of(noise, (1.0, 1.0)).startswith("rough"))

    def test_roughness_does_not_depend_on_units_or_on_a_slope(self):
        heights = hills(60, 60, 0.1)
        tilted = 7.0 * (heights + 0.3 * numpy.arange(60))
        self.assertAlmostEqual(VoidDraw.roughness(heights, (1.0, 1.0)),
                               VoidDraw.roughness(tilted, (10.0, 10.0)))

    def test_what_is_lost_does_not_count(self):
        heights = hills(60, 60)
        heights[20:30, 20:30] += 1e6
        heights[20:30, 20:30] = numpy.nan
        self.assertTrue(VoidDraw.kind_of(heights, (50.0, 50.0)).startswith("smooth"))


class Surfaces(InFolder):
    def test_of_the_files_of_data_boundaries_and_faults_are_left_out(self):
        names = [os.path.basename(path) for path in VoidDraw.files_of([VoidDraw.DATA])]
        self.assertEqual(sorted(names), ["aegean_sea.csv", "b9_ground.vtp", "horizon_synthetic.vtp",
                                         "jacksboro_fault.vtp", "olinda_land.xyz"])

    def points(self, x, y, z):
        path = self.path("points.f64")
        numpy.column_stack((x, y, z)).astype("<f8").tofile(path)
        return VoidDraw.raster_of(path)

    def test_a_turned_lattice_becomes_its_nodes(self):
        heights = hills(12, 17)
        j, i = numpy.mgrid[:12, :17]
        x, y = 3.0 * i.ravel(), 5.0 * j.ravel()
        raster = self.points(0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y, heights.ravel())
        self.assertEqual(raster.origin, "lattice")
        self.assertEqual(sorted(numpy.round(raster.steps, 6)), [3.0, 5.0])
        numpy.testing.assert_allclose(numpy.sort(raster.heights.ravel()), numpy.sort(heights.ravel()))

    def test_scattered_points_become_squares_of_their_spacing(self):
        x, y = numpy.random.RandomState(3).random_sample((2, 2000)) * 40.0
        raster = self.points(x, y, 0.5 * x - 0.25 * y)
        self.assertEqual(raster.origin, "resampled")
        self.assertAlmostEqual(raster.steps[0], (1600.0 / 2000) ** 0.5, delta=0.05)
        found = VoidDraw.increments(raster.heights, raster.steps)
        self.assertAlmostEqual(numpy.nanmean(found[0]), 0.5)
        self.assertAlmostEqual(numpy.nanmean(found[1]), -0.25)


def method(name):
    return next(one for one in VoidMethods.methods_of("nowhere") if one.name == name)


class Methods(InFolder):
    def own(self, action):
        path = self.path("own.py")
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(MEAN.replace("ACTION", action))
        return VoidMethods.Method("own", (sys.executable, path), "", "")

    def test_those_of_ours_fill_every_node_and_a_plane_exactly(self):
        j, i = numpy.mgrid[:60, :50]
        plane = VoidDraw.Raster("plane", 0.3 * i - 0.2 * j + 5.0, (1.0, 1.0), "lattice")
        voids = VoidDraw.draw([plane], 1, 1, (4, 100))
        for name in ("Adaptive", "linear"):
            measured = VoidMethods.measure(method(name), voids, 60)
            self.assertLess(numpy.abs(measured.errors).max(), 1e-9, name)
            self.assertTrue((measured.seconds > 0.0).all())
            self.assertEqual(numpy.isnan(measured.inside).all(), name == "linear")

    def test_a_method_of_ones_own_takes_part_with_its_intervals(self):
        measured = VoidMethods.measure(self.own("pass"), VOIDS, 60)
        self.assertFalse(any(measured.notes))
        self.assertTrue((measured.seconds == 0.25).all())
        first = VOIDS[0]
        expected = numpy.nanmean(first.damaged()) - first.heights[first.lost]
        numpy.testing.assert_allclose(measured.errors[: first.lost.sum()], expected)
        self.assertEqual(numpy.nanmean(measured.inside), 1.0)

    def test_a_void_that_fails_ends_or_takes_too_long_is_counted_and_the_others_are_filled(self):
        voids = [VOIDS[0], VOIDS[-1], VOIDS[1]]
        large = [void.lost.sum() > 50 for void in voids]
        self.assertEqual(large, [False, True, False])
        for action, limit, words in (
            ('print("failed too large", flush=True); continue', 60, "failed too large"),
            ("sys.exit(3)", 60, "ended with code 3"), ("time.sleep(1000)", 4, "more than 4 s"),
        ):
            measured = VoidMethods.measure(self.own(action), voids, limit)
            for note, is_large, seconds in zip(measured.notes, large, measured.seconds):
                self.assertEqual(words in note, is_large, note)
                self.assertEqual(bool(numpy.isnan(seconds)), is_large)

    def test_results_are_kept_for_the_same_draw_alone(self):
        measured = VoidMethods.measure(self.own("sys.exit(3)"), VOIDS[-2:], 60)
        VoidMethods.store(self.folder, "own", "abc", measured)
        again = VoidMethods.stored(self.folder, "own", "abc")
        self.assertEqual(again.notes, measured.notes)
        numpy.testing.assert_array_equal(again.errors, measured.errors)
        self.assertIsNone(VoidMethods.stored(self.folder, "own", "abd"))


class Figures(unittest.TestCase):
    def results(self, measured):
        return VoidTables.Results(VOIDS * 10, measured, {}, {})

    def measured(self, error):
        """An error for each void, in parts of the relief around it."""
        voids = VOIDS * 10
        errors = numpy.concatenate([
            numpy.full(void.lost.sum(), error * void.relief()) for void in voids])
        return VoidMethods.Measured(
            errors, numpy.zeros(errors.shape), numpy.ones(len(voids)), [""] * len(voids))

    def test_errors_are_parts_of_those_of_cgal(self):
        results = self.results({"CGAL": self.measured(0.5), "Adaptive": self.measured(-0.25)})
        self.assertEqual(results.base, "CGAL")
        for chosen in (None, results.of(size=20)):
            self.assertAlmostEqual(results.ratio("Adaptive", "CGAL", chosen), 0.5)
        self.assertAlmostEqual(float(numpy.median(results.void_ratios("Adaptive", "CGAL"))), 0.5)
        self.assertEqual(results.coverage("Adaptive"), 0.0)

    def test_nodes_that_one_of_two_left_open_do_not_count(self):
        half = self.measured(0.5)
        half.errors[::2] = numpy.nan
        results = self.results({"CGAL": self.measured(0.5), "GDAL": half})
        self.assertAlmostEqual(results.ratio("GDAL", "CGAL"), 1.0)
        self.assertIn("50.", VoidTables.failure_table(results))

    def test_hindsight_takes_the_best_candidate_of_each_void(self):
        of = {"CGAL": self.measured(1.0), "Membrane": self.measured(0.3),
              "ThinPlate": self.measured(0.2), "CubicSpline": self.measured(0.4)}
        of["Membrane"].errors[: VOIDS[0].lost.sum()] = 0.0
        results = self.results({**of, "Adaptive": self.measured(0.2)})
        found = results.measured[VoidTables.HINDSIGHT].errors
        self.assertEqual(found[0], 0.0)
        numpy.testing.assert_array_equal(found[500:], of["ThinPlate"].errors[500:])
        everything = numpy.ones(len(results.voids), bool)
        self.assertEqual(VoidTables.best_candidate(results, everything, True)[0], "ThinPlate")


class Command(InFolder):
    def run_bench(self, *arguments, environment=None):
        script = os.path.join(BENCHMARKS, "void-bench")
        return forked.python(
            script, self.folder, *arguments, folder=self.folder, environment=environment)

    def test_missing_peers_are_named_with_the_reason(self):
        """On a PATH without programs, and with one method of one's own."""
        with open(self.path("own.py"), "w", encoding="utf-8") as stream:
            stream.write(MEAN.replace("ACTION", "pass"))
        with open(self.path("none"), "w", encoding="utf-8"):
            pass
        done = self.run_bench(
            "--voids", "1", "--programs", self.path("none"), "--methods", "own,CGAL,GMT,kriging,GRASS",
            "--also", f"own={sys.executable} {self.path('own.py')}",
            environment={**os.environ, "PATH": self.folder})
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.path("VoidBench.md"), encoding="utf-8") as stream:
            text = stream.read()
        for name, reason in (("CGAL", "FillVoidsCGAL is not built"), ("GMT", "gmt was not found"),
                             ("kriging", "Rscript was not found"), ("GRASS", "grass was not found"),
                             ("Adaptive", "not measured in this run")):
            self.assertRegex(text, rf"- {name}: .*{reason}")
        self.assertRegex(text, r"\| own \| [\d.]+ %")
        self.assertNotIn("of the stored run", text)
        self.assertIn("--voids 1", text)
        with open(self.path("voids.csv"), encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        self.assertEqual(len(rows), 48)
        self.assertTrue(all(row["lost"] == row["filled"] for row in rows))

    def test_what_is_unknown_is_refused_in_one_line(self):
        for arguments, words in ((["--methods", "Nobody"], "no method 'Nobody'"),
                                 (["--voids", "0"], "whole number"), (["--also", "x"], "NAME=COMMAND"),
                                 (["--data", self.path("none")], "is not a folder")):
            done = self.run_bench(*arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn(words, done.stderr)


class Document(unittest.TestCase):
    def test_stored_run_has_every_table_of_a_full_run(self):
        with open(os.path.join(ROOT, "Documentation", "VoidBench.md"), encoding="utf-8") as stream:
            text = stream.read()
        found = re.findall(r"^<!-- table: (\w+) -->\n\n.", text, re.MULTILINE)
        self.assertEqual(sorted(found), sorted(VoidTables.TABLES))
        self.assertRegex(text, r"1,3\d\d voids of")
        for name in ("Adaptive", "CGAL", "GDAL", "GMT", "kriging", "GRASS", "vtkFillHoles"):
            self.assertRegex(text, rf"\n\| {name} \|")
        for figure in re.findall(r"\]\((figures/\w+\.png)\)", text):
            path = os.path.join(ROOT, "Documentation", figure)
            self.assertLess(os.path.getsize(path), 150000, figure)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
