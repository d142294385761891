# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The program as its users run it: files in, files and a report out."""

import json
import math
import os
import re
import random
import shutil
import signal
import subprocess
import sys
import time
import unittest
from unittest import mock

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, os.pardir, os.pardir))
DATA = os.path.join(ROOT, "Data")
EXAMPLES = os.path.join(ROOT, "Examples", "Python")

import in_folder
from vtkelevationsurface import reading, writing
from vtkelevationsurface.picture import display
from vtkelevationsurface.reading import vtk_files
from vtkelevationsurface.clouds import make_points
from vtkmodules.util.numpy_support import vtk_to_numpy

SIZE = 12
# A sheet of SIZE x SIZE points, one apart; z is a plane, so that nothing depends on the triangles.
SHEET = [(x, y, 0.5 * x - 0.25 * y) for y in range(SIZE) for x in range(SIZE)]
# The same with 3 x 3 points taken out of the middle. With edges of at most 1.5 that leaves a hole of
# 4 x 4 with its corners cut: 12 edges, an area of 14.
HOLED = [p for p in SHEET if not (4 <= p[0] <= 6 and 4 <= p[1] <= 6)]


def text_of(rows):
    return "".join(f"{x:.12g} {y:.12g} {z:.12g}\n" for x, y, z in rows)


class Program(in_folder.Program):
    """Runs the program, and reads its report."""

    def report(self, *arguments):
        """The report of a run that must succeed."""
        done = self.call(*arguments, "--no-picture", "--report", "report.json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        with open(self.path("report.json"), encoding="utf-8") as stream:
            report = json.load(stream)
        self.output = done.stdout
        return report

    def assert_refused(self, words, *arguments, code=1, **options):
        """One clear line on stderr, the exit code, and no file that was not there before."""
        before = sorted(os.listdir(self.folder))
        done = self.call(*arguments, "--no-picture", **options)
        self.assertEqual(done.returncode, code, done.stderr)
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertTrue(lines[0].startswith("reconstruct: error: "), lines[0])
        for word in [words] if isinstance(words, str) else words:
            self.assertIn(word, lines[0])
        self.assertEqual(done.stdout, "")
        self.assertEqual(sorted(os.listdir(self.folder)), before)


class Report(Program):
    def test_a_full_sheet_is_counted_and_nothing_is_lost(self):
        report = self.report(self.file("sheet.xyz", text_of(SHEET)))
        self.assertEqual(report["points"], SIZE * SIZE)
        self.assertEqual(report["unused"], [])
        self.assertEqual(report["triangles"]["delaunay"], 2 * (SIZE - 1) ** 2)
        self.assertEqual(report["triangles"]["filled"], 2 * (SIZE - 1) ** 2)
        self.assertEqual(report["trim"]["outward_triangles"], 0)
        self.assertGreater(report["trim"]["effective_gap_tolerance"], 0)
        self.assertIn("points_left_out", report["trim"])
        self.assertEqual(report["holes"]["found"], 0)
        self.assertEqual(report["distance"]["points"], SIZE * SIZE)
        self.assertLess(report["distance"]["maximum"], 1e-12)
        for step in ("read", "triangulate", "trim", "fill", "measure", "write"):
            self.assertIn(step, report["times"])

    def test_the_lattice_is_reported(self):
        name = self.file("sheet.xyz", text_of((4 * x, 2 * y, z) for x, y, z in SHEET))
        report = self.report(name)
        self.assertEqual(report["lattice"]["steps"], [[4.0, 0.0], [0.0, 2.0]])
        self.assertEqual(report["lattice"]["lengths"], [4.0, 2.0])
        self.assertEqual(report["lattice"]["directions"], [0.0, 90.0])
        self.assertIn("steps of 4 towards 0 degrees and 2 towards 90 degrees", self.output)
        self.assertIsNone(self.report(name, "--lattice-mode", "off")["lattice"])
        self.assertNotIn("lattice", self.output)
        moved = [(x + (0.03 if x == y else 0.0), y, z) for x, y, z in SHEET]
        name = self.file("moved.xyz", text_of(moved))
        self.assertIsNone(self.report(name)["lattice"])
        self.assertIn("not on the nodes of a grid", self.output)
        self.assertIsNotNone(self.report(name, "--lattice-tolerance", "0.05")["lattice"])
        done = self.call(name, "--lattice-tolerance", "0.3")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--lattice-tolerance takes a number from 0 to 0.25", done.stderr)

    def test_both_searches_make_the_same_surface(self):
        # Off the lattice, where the strategy plays a part.
        name = self.file("moved.xyz", text_of((x + 0.1 * math.sin(y * y), y, z) for x, y, z in SHEET))
        surfaces = []
        for strategy in ("voxel-traversal", "compactness"):
            report = self.report(name, "--search-strategy", strategy)
            self.assertIsNone(report["lattice"])
            with open(self.path("moved_surface.vtp"), "rb") as stream:
                surfaces.append(stream.read())
        self.assertEqual(surfaces[0], surfaces[1])
        done = self.call(name, "--search-strategy", "guess")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--search-strategy takes one of voxel-traversal, compactness", done.stderr)

    def test_what_the_boundary_leaves_out_is_noted_and_strictly_an_error(self):
        lone = [(SIZE + 60.0 + 60.0 * line, float(i), 0.0) for line in range(2) for i in range(40)]
        name = self.file("lone.xyz", text_of(SHEET + lone))
        report = self.report(name, "--no-fill")
        self.assertEqual(report["trim"]["points_left_out"], len(lone))
        notes = [note for note in report["notes"] if "leaves out" in note]
        self.assertEqual(len(notes), 1, report["notes"])
        self.assertIn(f"leaves out {len(lone)} points", notes[0])
        wanted = re.search(r"A --gap-tolerance of ([0-9.]+) would keep all points", notes[0]).group(1)
        done = self.call(name, "--no-fill", "--strict")
        self.assertEqual(done.returncode, 1)
        self.assertIn("leaves out", done.stderr)
        report = self.report(name, "--no-fill", "--strict", "--gap-tolerance", wanted)
        self.assertLess(report["trim"]["points_left_out"], 4)

    def test_a_hole_is_filled_and_listed(self):
        name = self.file("holed.xyz", text_of(HOLED))
        report = self.report(name, "--maximum-edge-length", "1.5", "--gap-tolerance", "6")
        self.assertEqual(report["triangles"]["delaunay"], 2 * (SIZE - 1) ** 2 - 28)
        self.assertEqual((report["holes"]["found"], report["holes"]["filled"]), (1, 1))
        hole = report["holes"]["list"][0]
        self.assertEqual((hole["status"], hole["edges"]), ("filled", 12))
        self.assertAlmostEqual(hole["area"], 14.0)
        self.assertGreater(hole["inserted_points"], 0)
        self.assertGreater(report["triangles"]["filled"], report["triangles"]["trimmed"])

    def test_a_hole_over_a_limit_stays_open_and_the_reason_is_given(self):
        name = self.file("holed.xyz", text_of(HOLED))
        common = (name, "--maximum-edge-length", "1.5", "--gap-tolerance", "6")
        for option, value, reason, size in (
            ("--maximum-hole-size", "2", "too large", "size 5.657"),
            ("--maximum-hole-edges", "11", "too many edges", "12 edges"),
        ):
            with self.subTest(option=option):
                report = self.report(*common, option, value)
                self.assertEqual(report["holes"]["by_status"], {reason: 1})
                self.assertEqual((report["holes"]["found"], report["holes"]["bridged_left"]), (1, 0))
                self.assertEqual(report["holes"]["inserted_points"], 0)
                self.assertIn(f"1 not filled, {reason}: hole 0 ({size})", self.output)
                self.assertAlmostEqual(
                    report["holes"]["list"][0]["size"], math.sqrt(32), msg="a box of 4 x 4"
                )

    def test_missing_nodes_of_a_grid_are_filled(self):
        # Of 2 x 2 nodes, which triangles bridge.
        rows = [p for p in SHEET if not (4 <= p[0] <= 5 and 4 <= p[1] <= 5)]
        name = self.file("bridged.xyz", text_of(rows))
        holes = self.report(name)["holes"]
        self.assertAlmostEqual(holes["open_edge_length"], 1.5 * math.sqrt(2))
        self.assertEqual(holes["open_edge_length_is"], "1.5 diagonals of the grid's cells")
        self.assertEqual(holes["by_status"], {"replaced": 1})
        self.assertEqual((holes["filled"], holes["inserted_points"]), (1, 4))
        for words in ("1 found, 1 filled", "1 of them were bridged", "--open-edge-length"):
            self.assertIn(words, self.output)
        # Over a limit, the void is still bridged, so it is not a hole.
        holes = self.report(name, "--maximum-hole-size", "1")["holes"]
        self.assertEqual((holes["found"], holes["filled"], holes["bridged_left"]), (0, 0, 1))
        self.assertEqual(holes["list"][0]["bridged"], True)
        self.assertIn("1 bridged by long triangles and left as they are, too large: void 0", self.output)
        self.assertEqual(self.report(name, "--open-edge-length", "0")["holes"]["found"], 0)
        holes = self.report(name, "--open-edge-length", "2.9")["holes"]
        self.assertEqual((holes["open_edge_length_is"], holes["found"]), ("as given", 1))
        # Where a grid is thinned, nodes are not missing; with a boundary, edges may be long anyway.
        thin = random.Random(2).sample(SHEET, len(SHEET) // 3)
        report = self.report(self.file("thin.xyz", text_of(thin)))
        self.assertEqual(report["holes"]["open_edge_length"], 0)
        ring = self.file("ring.xyz", "1 1\n10 1\n10 10\n1 10\n1 1\n")
        self.assertEqual(self.report(name, "--boundary", ring)["holes"]["open_edge_length"], 0)

    def test_the_space_between_survey_lines_is_filled(self):
        rows = []
        for line in range(6):
            for k in range(80):
                x = 40 * line + 0.3 * math.sin(37 * k + line)
                y = k + 0.3 * math.cos(29 * k + 5 * line)
                rows.append((x, y, 0.1 * x - 0.2 * y))
        name = self.file("lines.xyz", text_of(rows))
        report = self.report(name, "--no-trim")
        holes = report["holes"]
        self.assertGreater(holes["open_edge_length"], 1.6)
        self.assertLess(holes["open_edge_length"], 2.6)
        self.assertIn("along lines", holes["open_edge_length_is"])
        self.assertGreater(holes["by_status"]["replaced"], 0)
        self.assertGreater(holes["inserted_points"], len(rows))
        self.assertLess(holes["inserted_points"], 15 * len(rows))
        self.assertEqual(report["points_unused"], 0)
        self.assertLess(report["distance"]["maximum"], 1e-6)
        self.assertIn("along lines); see --open-edge-length", self.output)

    def test_interpolation_is_handed_on_and_reported(self):
        name = self.file("holed.xyz", text_of(HOLED))
        common = (name, "--maximum-edge-length", "1.5", "--gap-tolerance", "6")
        for method in ("neighbor-mean", "membrane", "thin-plate", "cubic-spline"):
            with self.subTest(method=method):
                report = self.report(*common, "--interpolation", method)
                self.assertEqual(report["holes"]["list"][0]["interpolation"], method)

    def test_spacing_decides_how_many_points_are_inserted(self):
        name = self.file("holed.xyz", text_of(HOLED))
        common = (name, "--maximum-edge-length", "1.5", "--gap-tolerance", "6", "--spacing")
        coarse, fine = (self.report(*common, s)["holes"]["inserted_points"] for s in ("2", "0.5"))
        self.assertGreater(fine, 2 * coarse)

    def test_a_spacing_below_the_steps_of_the_coordinates_is_refused_at_once(self):
        rows = [(4000000.0 + x, 5000000.0 + y, z) for x, y, z in HOLED]
        name = self.file("far.xyz", text_of(rows))
        self.assert_refused(
            "far.xyz: --spacing: 1e-09 is too small: x and y of the points are in "
            "steps of 9.31e-10",
            name, "--spacing", "1e-9", code=2,
        )
        self.report(name, "--spacing", "2")

    def test_steps_can_be_left_out(self):
        name = self.file("holed.xyz", text_of(HOLED))
        report = self.report(name, "--maximum-edge-length", "1.5", "--no-trim", "--no-fill")
        self.assertNotIn("trim", report)
        self.assertNotIn("holes", report)
        self.assertEqual(list(report["triangles"]), ["delaunay"])

    def test_unused_points_are_listed_with_line_and_reason(self):
        rows = text_of(SHEET) + "3 3 99\n4 4 nan\n5 inf 1\n3 3 98\n"
        report = self.report(self.file("bad.xyz", "x y z\n" + rows))
        first = SIZE * SIZE
        same, not_finite = "same x,y as another point", "not finite"
        self.assertEqual(
            report["unused"],
            [
                {"point": first, "reason": same, "line": first + 2},
                {"point": first + 1, "reason": not_finite, "line": first + 3},
                {"point": first + 2, "reason": not_finite, "line": first + 4},
                {"point": first + 3, "reason": same, "line": first + 5},
            ],
        )
        self.assertEqual(report["unused_reasons"], {same: 2, not_finite: 2})
        self.assertIn(f"2 not finite: line {first + 3}, {first + 4}", self.output)
        # The distance is that of 99 - 0.75 and 98 - 0.75 above a plane; all other points lie in it.
        steep = math.sqrt(1 + 0.5**2 + 0.25**2)
        expected = [(99 - 0.75) / steep, (98 - 0.75) / steep]
        self.assertEqual(report["distance"]["points"], first + 2)
        # Near the rim the closest place may be an edge of the sheet, which is farther away.
        self.assertGreater(report["distance"]["maximum"], expected[0] - 1e-9)
        self.assertGreater(
            report["distance"]["rms"], math.sqrt(sum(d * d for d in expected) / (first + 2)) - 1e-9
        )

    def test_points_beyond_the_edge_limit_are_listed_and_measured(self):
        name = self.file("far.xyz", text_of(SHEET) + "30 5 13.75\n")
        report = self.report(name, "--maximum-edge-length", "1.5")
        far = {"point": SIZE * SIZE, "reason": "in no triangle below the edge limit"}
        self.assertEqual(report["unused"], [{**far, "line": SIZE * SIZE + 1}])
        # From the rim at x = 11, which rises by -0.25 for each step of y.
        squared = 19**2 + 9.5**2 - (0.25 * 9.5) ** 2 / (1 + 0.25**2)
        self.assertAlmostEqual(report["distance"]["maximum"], math.sqrt(squared))

    def test_the_duplicate_policy_chooses_the_elevation(self):
        name = self.file("twice.xyz", text_of(SHEET) + "3 3 99\n3 3 -99\n")
        for policy, z in (
            ("keep-first", 0.75),
            ("keep-last", -99.0),
            ("keep-lowest", -99.0),
            ("keep-highest", 99.0),
        ):
            with self.subTest(policy=policy):
                self.report(name, "--duplicates", policy, "-o", "s.vtp", "--no-fill")
                surface = vtk_files.run_vtk_reader(self.path("s.vtp"))
                used = {
                    surface.GetPoint(surface.GetCell(c).GetPointId(i))
                    for c in range(surface.GetNumberOfCells())
                    for i in range(3)
                }
                self.assertEqual([p[2] for p in used if p[:2] == (3.0, 3.0)], [z])

    def test_faults_become_edges_and_are_reported(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        lines = self.file("faults.txt", "x y z\n2 2.5 9\n8 2.5 9\n\n4.5 1 7\n4.5 6 7\n")
        report = self.report(name, "--faults", lines, "--no-trim", "--no-fill", "-o", "s.vtp")
        self.assertEqual(
            report["faults"], {"file": lines, "added_points": 5, "crossings": 1}
        )
        self.assertIsNone(report["lattice"])
        surface = vtk_files.run_vtk_reader(self.path("s.vtp"))
        self.assertEqual(surface.GetNumberOfPoints(), len(SHEET) + 5)
        self.assertEqual(surface.GetPoint(surface.GetNumberOfPoints() - 1), (4.5, 2.5, 9.0))
        self.assertIn("5 points added, 1 crossing", self.output)

    def test_faults_that_cannot_be_used_are_named(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        self.assert_refused("no.vtp: no such file", name, "--faults", "no.vtp")
        bad = self.file("bad.txt", "1 1 0\n2 inf 0\n")
        self.assert_refused("bad.txt, line 2: a point of a fault", name, "--faults", bad)
        from vtkmodules.vtkCommonDataModel import vtkCellArray

        data = make_points([(2, 2, 0), (8, 2, float("nan"))])
        lines = vtkCellArray()
        lines.InsertNextCell(2, [0, 1])
        data.SetLines(lines)
        writing.write_surface(data, self.path("nan.vtp"))
        self.assert_refused(["nan.vtp: ", "Point 1"], name, "--faults", "nan.vtp")

    def test_a_boundary_file_cuts_the_surface(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        ring = self.file("ring.txt", "x y\n2 2\n8 2\n8 8\n2 8\n2 2\n")
        report = self.report(name, "--boundary", ring)
        self.assertEqual(report["trim"]["boundary"], ring)
        self.assertEqual(report["triangles"]["trimmed"], 2 * 6 * 6)
        self.assertEqual(report["trim"]["outward_triangles"], 2 * (11 * 11 - 6 * 6))
        self.assertEqual(report["unused_reasons"], {"outside the boundary": 12 * 12 - 7 * 7})
        self.assertNotIn("effective_gap_tolerance", report["trim"])

    def test_a_boundary_on_the_map_needs_no_points_of_the_file(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        ring = self.file("lease.txt", "2.25 2.5\n20 2.5\n20 8\n2.25 8\n2.25 2.5\n")
        report = self.report(name, "--boundary", ring, "--boundary-edges", "straight")
        # Two corners, and where the boundary leaves the sheet at (11, 2.5).
        self.assertEqual(report["trim"]["inserted_points"], 3)
        # Else where it crosses 13 edges along the axes, and 14 diagonals.
        report = self.report(name, "--boundary", ring)
        self.assertEqual(report["trim"]["inserted_points"], 3 + 13 + 14)
        refused = self.call(name, "--boundary", ring, "--no-recover-boundary")
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("point 0 (2.25, 2.5)", refused.stderr)

    def test_the_published_test_can_be_chosen(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        ring = self.file("ring.txt", "x y\n2 2\n8 2\n8 8\n2 8\n2 2\n")
        report = self.report(name, "--boundary", ring, "--outward-test", "inward-normal")
        self.assertEqual(report["trim"]["outward_triangles"], 0)
        done = self.call(name, "--outward-test", "outward")
        self.assertIn("--outward-test takes one of exact, inward-normal", done.stderr)

    def test_rows_without_data_are_left_out_and_counted(self):
        name = self.file("sheet.xyz", text_of(SHEET) + "5.5 5.5 -999\n")
        report = self.report(name, "--no-data", "-999")
        self.assertEqual(report["points"], SIZE * SIZE)
        self.assertEqual(report["left_out"], {"rows without data": 1})

    def test_point_arrays_reach_the_surface(self):
        from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
        import numpy

        data = make_points(HOLED)
        array = numpy_to_vtk(numpy.arange(float(len(HOLED))), deep=True)
        array.SetName("Amplitude")
        data.GetPointData().AddArray(array)
        writing.write_surface(data, self.path("holed.vtp"))
        common = (
            "holed.vtp",
            "-o",
            "s.vtp",
            "--maximum-edge-length",
            "1.5",
            "--gap-tolerance",
            "6",
        )
        for option, known in ((), True), (("--no-interpolate-point-data",), False):
            with self.subTest(option=option):
                self.report(*common, *option)
                surface = vtk_files.run_vtk_reader(self.path("s.vtp"))
                values = vtk_to_numpy(surface.GetPointData().GetArray("Amplitude"))
                self.assertEqual(values[: len(HOLED)].tolist(), list(range(len(HOLED))))
                self.assertGreater(len(values), len(HOLED))
                self.assertEqual(bool(numpy.isfinite(values).all()), known)

    def test_real_data_is_reconstructed(self):
        for name, points in (("olinda_land.xyz", 10266), ("b9_ground.vtp", 13299)):
            with self.subTest(name=name):
                report = self.report(os.path.join(DATA, name))
                self.assertEqual(report["points"], points)
                self.assertEqual(report["points_unused"], len(report["unused"]))
                self.assertEqual(report["distance"]["points"], points)
                self.assertLess(report["distance"]["maximum"], 1e-6)


class Results(Program):
    def test_the_default_names_are_in_the_current_folder(self):
        os.mkdir(self.path("there"))
        self.file("there/sheet.one.csv", text_of(SHEET).replace(" ", ","))
        done = self.call(os.path.join("there", "sheet.one.csv"), "--no-picture")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), ["sheet.one_surface.vtp", "there"])

    def test_every_format_holds_the_same_triangles(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        for suffix in (".vtp", ".vtu", ".ply", ".stl", ".obj"):
            with self.subTest(suffix=suffix):
                done = self.call(name, "--no-picture", "-o", "s" + suffix)
                self.assertEqual(done.returncode, 0, done.stderr)
                read = reading.read_boundary if suffix == ".ply" else vtk_files.run_vtk_reader
                surface = read(self.path("s" + suffix))
                self.assertEqual(surface.GetNumberOfCells(), 2 * (SIZE - 1) ** 2)
                self.assertEqual(surface.GetBounds()[:4], (0.0, SIZE - 1.0, 0.0, SIZE - 1.0))

    def test_quiet_prints_nothing(self):
        done = self.call(self.file("sheet.xyz", text_of(SHEET)), "--no-picture", "--quiet")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_a_bar_is_drawn_on_a_terminal_only(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        self.assertEqual(self.call(name, "--no-picture").stderr, "")
        try:
            import pty
        except ImportError:
            self.skipTest("there are no pseudo-terminals here")
        master, terminal = pty.openpty()
        with subprocess.Popen(
            [*self.PROGRAM, name, "--no-picture"],
            cwd=self.folder,
            stdout=subprocess.DEVNULL,
            stderr=terminal,
        ) as process:
            os.close(terminal)
            shown = b""
            try:
                while chunk := os.read(master, 4096):
                    shown += chunk
            except OSError:
                pass  # how Linux reports that the other side has closed
            self.assertEqual(process.wait(timeout=300), 0)
        os.close(master)
        self.assertIn(b"triangulating", shown)
        self.assertIn(b" %", shown)

    def test_help_shows_examples(self):
        done = self.call("--help")
        self.assertEqual(done.returncode, 0)
        self.assertIn("examples:", done.stdout)
        self.assertIn("survey_surface.vtp", done.stdout)

    def test_help_names_every_option(self):
        from vtkelevationsurface import options

        shown = self.call("--help").stdout
        for action in options.make_parser()._actions:
            for option in action.option_strings:
                self.assertIn(f"  {option}", shown.replace(", -", "  -"))
                if action.nargs is None:
                    self.assertIn(option, [*options.TAKES, "-o"])

    def test_a_reader_that_goes_away_is_not_an_error(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        reading, writing = os.pipe()
        os.close(reading)
        done = subprocess.run(
            [*self.PROGRAM, name, "--no-picture"],
            cwd=self.folder,
            stdout=writing,
            stderr=subprocess.PIPE,
            text=True,
            timeout=300,
            check=False,
        )
        os.close(writing)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertTrue(os.path.exists(self.path("sheet_surface.vtp")))


@unittest.skipUnless(os.path.exists("/bin/bash"), "Utilities/reconstruct needs bash")
class Script(Program):
    SCRIPT = os.path.join(ROOT, "Utilities", "reconstruct")

    def test_help_needs_no_build_and_without_python_it_says_so(self):
        nowhere = {"ELEVATION_SURFACE_PYTHON": "/no", "ELEVATION_SURFACE_BUILD": "/no"}
        done = self.execute(self.SCRIPT, "a.csv", "--help", env={**os.environ, **nowhere})
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout, self.call("--help").stdout)
        for tool in ("bash", "dirname", "sed"):
            os.symlink(shutil.which(tool), self.path(tool))
        done = self.execute(self.SCRIPT, "--help", env={**os.environ, **nowhere, "PATH": self.folder})
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("(python3, which Utilities/setup installs, lists the other options", done.stdout)
        self.assertIn("examples:", done.stdout)

    def test_the_project_is_found_through_links(self):
        os.symlink(self.SCRIPT, self.path("direct"))
        os.mkdir(self.path("bin"))
        os.symlink(os.path.join(os.pardir, "direct"), self.path("bin/rec"))
        done = self.execute(os.path.join("bin", "rec"), "--help")
        self.assertEqual(done.returncode, 0)
        self.assertIn("examples:", done.stdout)


class ShortExample(Program):
    def test_it_makes_the_same_surface_as_the_program(self):
        data = os.path.join(DATA, "b9_ground.vtp")
        script = os.path.join(EXAMPLES, "three_filters.py")
        done = self.execute(sys.executable, script, data, "short.vtp", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("holes filled", done.stdout)
        report = self.report(data, "--maximum-edge-length", "2")
        surface = vtk_files.run_vtk_reader(self.path("short.vtp"))
        self.assertEqual(surface.GetNumberOfPolys(), report["triangles"]["filled"])


@in_folder.draws
class Examples(Program):
    def lines_of(self, name, *arguments):
        script = os.path.join(EXAMPLES, name)
        done = self.execute(sys.executable, script, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.splitlines()

    def test_the_example_adds_the_fault_and_draws_it(self):
        lines = self.lines_of("faulted_horizon.py", "fault.png", "fault.vtp")
        self.assertEqual(lines, ["290 points added, 0 crossings"])
        self.assertGreater(os.path.getsize(self.path("fault.png")), 100000)
        surface = vtk_files.run_vtk_reader(self.path("fault.vtp"))
        self.assertGreater(surface.GetNumberOfPolys(), 4000)

    def test_the_lake_is_cut_along_lines_that_are_not_points(self):
        lines = self.lines_of("lake.py", "lake.png")
        # All corners of the shores, one of the lease; where the lease leaves the survey; and where
        # they cross edges.
        self.assertEqual(lines[1], "1098 points inserted along the boundary")
        self.assertGreater(os.path.getsize(self.path("lake.png")), 50000)

    def test_the_swath_has_an_outline_and_the_inside_of_its_loop(self):
        lines = self.lines_of("survey_swath.py", "swath.png")
        self.assertTrue(lines[1].startswith("2 rings at a gap tolerance of "), lines[1])
        self.assertGreater(os.path.getsize(self.path("swath.png")), 50000)

    def test_maps_show_the_boundary_and_the_holes_before_and_after(self):
        buildings = os.path.join(DATA, "b9_ground.vtp")
        lines = self.lines_of("from_above.py", "outline", buildings, "outline.png")
        self.assertRegex(lines[0], r"^\d+ rings? at a gap tolerance of \d\.\d spacings, \d+ points outside$")
        self.assertGreater(os.path.getsize(self.path("outline.png")), 100000)
        surface = vtk_files.run_vtk_reader(buildings)
        vtk_to_numpy(surface.GetPoints().GetData()).astype("<f8").tofile(self.path("plain.f64"))
        lines = self.lines_of(
            "from_above.py", "voids", "plain.f64", "voids.png", "--maximum-edge-length", "2",
            "--interpolation", "membrane", "--window", "596650,596730,243620,243730",
            "--title", "Buildings")
        self.assertEqual(lines, ["after: 21 of 21 holes filled"])
        self.assertGreater(os.path.getsize(self.path("voids.png")), 100000)


class Pictures(Program):
    def picture(self, *arguments):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOImage import vtkPNGReader

        name = self.file("holed.xyz", text_of(HOLED))
        done = self.call(name, "--maximum-edge-length", "1.5", "--gap-tolerance", "6", *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        reader = vtkPNGReader()
        reader.SetFileName(self.path("holed_surface.png"))
        reader.Update()
        image = reader.GetOutput()
        columns, rows, _ = image.GetDimensions()
        return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(rows, columns, -1)

    @in_folder.draws
    def test_the_picture_shows_the_surface_in_colours_on_white(self):
        pixels = self.picture().astype(int)
        self.assertEqual(pixels[0, 0].tolist(), [255, 255, 255])
        coloured = (pixels.max(axis=2) - pixels.min(axis=2)) > 25
        self.assertGreater(coloured.mean(), 0.2)
        # The outline of the filled hole is the one thing that is redder than anything in the map.
        red = (pixels[:, :, 0] > 150) & (pixels[:, :, 1] < 60) & (pixels[:, :, 2] < 120)
        self.assertGreater(red.sum(), 200)

    @in_folder.draws
    def test_the_view_and_colours_can_be_chosen(self):
        usual, aside = (self.picture("--view", view).astype(int) for view in ("top", "200,30"))
        self.assertTrue(aside.shape != usual.shape or (aside != usual).any())
        # Points of the file have no errors, and are the palest colour; the filled hole is not.
        errors = self.picture("--view", "top", "--colours", "error").astype(int)
        self.assertEqual(usual.shape, errors.shape)
        pale = errors.max(axis=2) - errors.min(axis=2) < 25
        self.assertGreater(pale.mean(), 0.6)
        self.assertGreater((errors != usual).any(axis=2).mean(), 0.1)

    @in_folder.draws
    def test_outliers_strips_and_odd_names_leave_something_to_see(self):
        import numpy
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOImage import vtkPNGReader

        tilted = [(x, y, x + y) for y in range(40) for x in range(40)]
        for name, rows in (
            ("outlier.xyz", tilted + [(20.5, 20.5, 1e6)]),
            ("flat.xyz", [(x, y, 0) for x, y, _ in tilted] + [(20.5, 20.5, 1e6)]),
            ("strip.xyz", [(x, y, x / 10) for y in range(3) for x in range(1000)]),
            ("slanted.xyz", [(x - y, x + y, x / 10) for y in range(3) for x in range(1000)]),
            ("\u5730\u5f62" + "a" * 200 + ".xyz", tilted),
        ):
            with self.subTest(name=name):
                done = self.call(self.file(name, text_of(rows)), "--picture", "p.png")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                reader = vtkPNGReader()
                reader.SetFileName(self.path("p.png"))
                reader.Update()
                pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)
                coloured = numpy.ptp(pixels, axis=1) > 25
                self.assertGreater(coloured.mean(), 0.04)

    @unittest.skipUnless(
        sys.platform.startswith("linux"), "only X has displays that may be missing"
    )
    def test_without_a_display_the_surface_is_written_with_a_note(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        for display in (None, ":12345"):
            # Without programs on the PATH there is no Xvfb.
            environment = {k: v for k, v in os.environ.items() if k != "DISPLAY"}
            environment["PATH"] = self.folder
            if display:
                environment["DISPLAY"] = display
            with self.subTest(display=display):
                done = self.call(name, env=environment)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertIn("no picture: ", done.stdout)
                self.assertEqual(
                    sorted(os.listdir(self.folder)), ["sheet.xyz", "sheet_surface.vtp"]
                )
                done = self.call(name, "--picture", env=environment)
                self.assertEqual(done.returncode, 1)
                self.assertIn("sheet_surface.png: cannot be drawn", done.stderr)


@unittest.skipUnless(shutil.which("Xvfb"), "Xvfb is not installed")
class VirtualDisplay(Program):
    """Where there is no display, the program starts one of its own, and leaves nothing of it."""

    # Says that it serves a display, but does not, the first so many times.
    DEAF = """#!/bin/bash
        echo x >>"{folder}/starts"
        [ $(wc -l <"{folder}/starts") -gt {times} ] && exec {program} "$@"
        eval "echo 4242 >&$2"
        exec sleep 300
        """

    def environment(self):
        environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "XAUTHORITY")}
        environment["TMPDIR"] = self.folder
        return environment

    def with_deaf_server(self, times):
        """The environment in which Xvfb is deaf the first so many times; see take_starts()."""
        tools = self.path("tools")
        os.makedirs(tools, exist_ok=True)
        words = {"folder": tools, "times": times, "program": shutil.which("Xvfb")}
        with open(os.path.join(tools, "Xvfb"), "w", encoding="utf-8") as stream:
            stream.write(self.DEAF.format(**words))
        os.chmod(stream.name, 0o755)
        environment = self.environment()
        environment["PATH"] = tools + os.pathsep + environment["PATH"]
        return environment

    def take_starts(self):
        """How often that server was started; counting begins anew."""
        starts = os.path.join(self.path("tools"), "starts")
        with open(starts, encoding="utf-8") as stream:
            count = len(stream.readlines())
        os.remove(starts)
        return count

    def call_with_deaf_server(self, times, *arguments):
        """(the run, how often the server was started, the files that are left)"""
        done = self.call(*arguments, env=self.with_deaf_server(times))
        made = sorted(set(os.listdir(self.folder)) - {"tools", "sheet.xyz"})
        for name in made:
            os.remove(self.path(name))
        return done, self.take_starts(), made

    def test_a_server_that_does_not_answer_is_started_again(self):
        # However long a busy machine takes to start it.
        with mock.patch.dict(os.environ, self.with_deaf_server(1), clear=True), \
                mock.patch.object(display, "WAIT", None):
            with display.screen() as reason:
                self.assertIsNone(reason)
        self.assertEqual(self.take_starts(), 2)

    def test_a_picture_is_drawn_on_the_server_that_answers(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        done, count, made = self.call_with_deaf_server(1, name, "--picture")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertGreater(count, 1)
        self.assertEqual(made, ["sheet_surface.png", "sheet_surface.vtp"])

    def test_a_picture_that_fails_does_not_lose_the_surface(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        done, count, made = self.call_with_deaf_server(99, name, "--report", "r.json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("no picture: Xvfb does not answer, asked 3 times", done.stdout)
        self.assertEqual((count, made), (3, ["r.json", "sheet_surface.vtp"]))
        done, _, made = self.call_with_deaf_server(99, name, "--picture", "--report", "r.json")
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (3, 1), done.stderr)
        self.assertIn("sheet_surface.png: cannot be drawn: Xvfb does not answer", done.stderr)
        self.assertIn("everything else is written", done.stderr)
        self.assertIn("no picture: Xvfb does not answer", done.stdout)
        self.assertEqual(made, ["r.json", "sheet_surface.vtp"])

    def start(self, side=300):
        environment = self.environment()
        rows = "".join(f"{i % side} {i // side} {i % 7}\n" for i in range(side * side))
        name = self.file("sheet.xyz", rows)
        return subprocess.Popen(
            [*self.PROGRAM, name, "--picture"],
            cwd=self.folder,
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def servers(self):
        """Ids of the Xvfb that use a key in this test's folder."""
        found = []
        for entry in os.listdir("/proc"):
            try:
                with open(f"/proc/{entry}/cmdline", "rb") as stream:
                    if self.folder.encode() in stream.read() and entry.isdigit():
                        with open(f"/proc/{entry}/comm", encoding="utf-8") as stream:
                            if "Xvfb" in stream.read():
                                found.append(int(entry))
            except OSError:
                pass
        return found

    def wait_until(self, condition):
        end = time.monotonic() + 300
        while not condition():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)

    def displays(self):
        return [n for n in os.listdir(self.folder) if n.startswith("reconstruct-display-")]

    def test_a_picture_is_drawn_and_the_server_ends(self):
        process = self.start(50)
        self.wait_until(self.servers)
        self.assertEqual(process.wait(300), 0)
        self.assertIn("sheet_surface.png", os.listdir(self.folder))
        self.assertEqual((self.servers(), self.displays()), ([], []))

    def test_a_stopped_program_leaves_no_server(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL):
            with self.subTest(number=number):
                process = self.start()
                self.wait_until(self.servers)
                if number == signal.SIGKILL:
                    time.sleep(0.5)  # until the program is the server's client
                process.send_signal(number)
                process.wait(300)
                self.wait_until(lambda: not self.servers())
                if number != signal.SIGKILL:
                    self.assertEqual(self.displays(), [])
                    self.assertEqual(process.returncode, 130)


class BadInput(Program):
    def test_files_that_cannot_be_read_are_named(self):
        self.assert_refused("no.csv: no such file", "no.csv")
        os.mkdir(self.path("folder.csv"))
        self.assert_refused("folder.csv: is a folder", "folder.csv")
        self.assert_refused("a.doc: is of no kind that can be read", self.file("a.doc", "words\n"))
        self.assert_refused("empty.xyz: is empty", self.file("empty.xyz", ""))
        self.assert_refused("words.txt: holds text, but no numbers", self.file("words.txt", "no\n"))
        self.assert_refused("two.txt: no line holds 3 numbers", self.file("two.txt", "1 2\n3 4\n"))
        self.assert_refused("broken.vtp: cannot be read", self.file("broken.vtp", "<VTKFile"))
        self.assert_refused("line 2: 'b' in column 2", self.file("b.csv", "1,2,3\n4,b,6\n"))

    def test_each_reason_for_no_surface_has_its_own_message(self):
        for name, rows, words in (
            ("one", "1 2 3\n", "there is only one point"),
            ("two", "1 2 3\n4 5 6\n1 2 9\n", "only two points differ in x,y"),
            ("equal", "1 2 3\n" * 5, "all 5 finite points have the same x,y (1, 2)"),
            ("line", "0 0 1\n1 2 1\n2 4 5\n5 10 1\n", "all 4 finite points lie on one line in x,y"),
            ("nan", "1 2 nan\nnan 2 3\n", "all 2 points are not finite"),
        ):
            with self.subTest(name=name):
                self.assert_refused(
                    [name + ".xyz: no surface: ", words], self.file(name + ".xyz", rows)
                )

    def test_an_edge_limit_that_leaves_nothing_is_reported(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        self.assert_refused(
            "use a larger --maximum-edge-length", name, "--maximum-edge-length", "0.5"
        )

    def test_a_boundary_that_is_not_closed_is_named(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        ring = self.file("open.txt", "2 2\n8 2\n8 8\n2 8\n")
        self.assert_refused(["open.txt: ", "not closed"], name, "--boundary", ring)
        from vtkmodules.vtkCommonDataModel import vtkCellArray

        data = make_points([(2, 2, 0), (8, 2, 0), (8, 8, 0), (2, 8, 0)])
        lines = vtkCellArray()
        lines.InsertNextCell(4, [0, 1, 2, 3])
        data.SetLines(lines)
        writing.write_surface(data, self.path("open.vtp"))
        self.assert_refused("open.vtp", name, "--boundary", "open.vtp")
        self.assert_refused("no.vtp: no such file", name, "--boundary", "no.vtp")

    def test_a_boundary_elsewhere_leaves_nothing_and_is_an_error(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        ring = self.file("far.txt", "102 2\n108 2\n108 8\n102 2\n")
        self.assert_refused("far.txt", name, "--boundary", ring)

    def test_results_that_cannot_be_written_are_named(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        os.mkdir(self.path("folder.vtp"))
        self.assert_refused("no/s.vtp: cannot be written", name, "-o", "no/s.vtp")
        self.assert_refused("folder.vtp: is a folder", name, "-o", "folder.vtp")
        self.assert_refused("s.doc: .doc cannot be written", name, "-o", "s.doc", code=2)
        self.assert_refused("no/r.json: cannot be written", name, "--report", "no/r.json")
        self.file("p.vtp", "")
        self.assert_refused("p.vtp: would overwrite p.vtp", "p.vtp", "-o", "p.vtp", code=2)
        self.assert_refused("--columns is for text files", "p.vtp", "--columns", "1,2,3", code=2)

    def test_a_full_disk_leaves_nothing_behind(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        for suffix in writing.WRITE_SUFFIXES:
            with self.subTest(suffix=suffix):
                self.assert_refused("s" + suffix, name, "-o", "s" + suffix, largest_file=2000)

    def test_wrong_options_are_errors_of_usage(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        for words, arguments in (
            ("no file given", ()),
            ("--spacing takes a number of 0 or more, not '-1'", (name, "--spacing=-1")),
            ("--spacing takes a number of 0 or more, not 'wide'", (name, "--spacing", "wide")),
            ("--spacing takes a number of 0 or more", (name, "--spacing")),
            ("a whole number of 0 or more", (name, "--maximum-hole-edges", "1.5")),
            ("--output takes a file", (name, "-o")),
            ("--interpolation takes one of neighbor-mean,", (name, "--interpolation", "flat")),
            ("one of keep-first,", (name, "--duplicates", "keep-some")),
            ("as x,y,z or 1,2,3, not 'x,y'", (name, "--columns", "x,y")),
            ("--view takes top, or", (name, "--view", "up")),
            ("--view takes top, or", (name, "--view", "10,0")),
            ("unknown option", (name, "--fast")),
            ("trimming options have no effect with --no-trim", (name, "--no-trim", "--boundary", name)),
            ("--open-edge-length takes a number of 0 or", (name, "--open-edge-length", "nan")),
            ("filling options have no effect with --no-fill", (name, "--no-fill", "--open-edge-length", "0")),
            ("filling options have no effect with --no-fill", (name, "--no-fill", "--spacing", "3")),
            ("filling options have no effect with --no-fill", (name, "--no-fill", "--interpolation", "membrane")),
            ("picture options have no effect with --no-picture", (name, "--no-picture", "--view", "top")),
            ("picture options have no effect with --no-picture", (name, "--no-picture", "--colours", "error")),
            ("--colours error is for filled holes", (name, "--no-fill", "--colours", "error")),
            ("--colours takes one of elevation, error", (name, "--colours", "slope")),
        ):
            with self.subTest(arguments=arguments):
                done = self.call(*arguments)
                self.assertEqual(done.returncode, 2)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(words, done.stderr)
                self.assertTrue(done.stderr.endswith("; see --help\n"), done.stderr)
                self.assertEqual(os.listdir(self.folder), [name])

    def test_coordinates_near_the_end_of_their_range_give_no_noise(self):
        rows = "".join(f"{x}e306 {y}e306 {x * y}\n" for x in range(9) for y in range(9))
        name = self.file("huge.xyz", rows + "1e306 1e306 1e306\n")
        report = self.report(name)
        self.assertAlmostEqual(report["distance"]["maximum"] / 1e306, 1, delta=1e-6)
        done = self.call(name)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("no picture: ", done.stdout)

    def test_without_the_module_one_line_says_what_to_do(self):
        environment = dict(os.environ, PYTHONPATH="")
        done = self.execute(*self.PROGRAM, self.file("sheet.xyz", text_of(SHEET)), env=environment)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertIn("vtkelevationsurface", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
