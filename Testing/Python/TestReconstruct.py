# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The program as its users run it: its report, its results, and the script that starts it."""

import math
import os
import random
import re
import shutil
import subprocess
import sys
import unittest

import numpy
from on_sheet import CROSSING, DATA, HOLED, ROOT, SHEET, SIZE, Program, text_of
from vtkelevationsurface import options, reading, writing
from vtkelevationsurface.clouds import make_points
from vtkelevationsurface.reading import vtk_files
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkCellArray


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
        wanted = re.search(r"A larger --gap-tolerance keeps more: try ([0-9.]+)\. ", notes[0]).group(1)
        done = self.call(name, "--no-fill", "--strict")
        self.assertEqual(done.returncode, 1)
        self.assertIn("leaves out", done.stderr)
        report = self.report(name, "--no-fill", "--strict", "--gap-tolerance", wanted)
        self.assertLess(report["trim"]["points_left_out"], 4)

    def test_few_lines_that_cross_are_kept(self):
        name = self.file("lines.xyz", text_of(CROSSING))
        report = self.report(name, "--strict")
        self.assertEqual(report["trim"]["points_left_out"], 0)
        self.assertRegex("\n".join(report["notes"]), r"along lines: a gap tolerance of 84\.\d+ spacings leaves out "
                         r"0 points, where one of 4\.5 leaves out 94\.7 %; --gap-tolerance decides otherwise")
        self.assertIn("along lines", report["holes"]["open_edge_length_is"])
        report = self.report(name, "--gap-tolerance", "4.5", "--no-fill")
        self.assertGreater(report["trim"]["points_left_out"], 1300)

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
        for words in ("1 found, 1 filled", "1 of them were bridged", "gaps wider than 2.121 are filled "
                      "(1.5 diagonals of the grid's cells); see --open-edge-length"):
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
        self.assertRegex(self.output, r"gaps wider than [12]\.\d+ are filled \(.*along lines.*\); see")
        self.assertGreater(holes["by_status"]["replaced"], 0)
        self.assertGreater(holes["inserted_points"], len(rows))
        self.assertLess(holes["inserted_points"], 15 * len(rows))
        self.assertEqual(report["points_unused"], 0)
        self.assertLess(report["distance"]["maximum"], 1e-6)
        self.assertIn("along lines); see --open-edge-length", self.output)

    def test_lines_on_a_grid_are_filled_as_those_that_wobble(self):
        inserted = []
        for apart, amplitude in ((10, 0), (10, 0.6), (10, 1), (10, 2), (3, 0), (3, 2)):
            offset = [round(amplitude * math.sin(x / 7)) for x in range(90)]
            rows = [(x, y, math.sin(x / 9) + math.cos(y / 11))
                    for x in range(90) for y in range(91) if (y + offset[x]) % apart == 0]
            with self.subTest(apart=apart, amplitude=amplitude):
                holes = self.report(self.file("lines.xyz", text_of(rows)))["holes"]
                if apart == 10:
                    self.assertEqual(holes["open_edge_length"], 2)
                    self.assertIn("times as far apart as their points", holes["open_edge_length_is"])
                    inserted.append(holes["inserted_points"])
                else:
                    self.assertEqual(holes["inserted_points"], 0)
        self.assertGreater(min(inserted), 2000)
        self.assertLess(max(inserted), 1.4 * min(inserted))

    def test_interpolation_is_handed_on_and_reported(self):
        name = self.file("holed.xyz", text_of(HOLED))
        common = (name, "--maximum-edge-length", "1.5", "--gap-tolerance", "6")
        for method in ("neighbor-mean", "membrane", "thin-plate", "cubic-spline", "level"):
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
            report["faults"],
            {"file": lines, "added_points": 5, "points_without_z": 0, "crossings": 1},
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

    def test_points_of_faults_without_z_take_that_of_the_surface(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        data = make_points([(2, 2, 0), (8, 2, float("nan"))])
        lines = vtkCellArray()
        lines.InsertNextCell(2, [0, 1])
        data.SetLines(lines)
        writing.write_surface(data, self.path("nan.vtp"))
        report = self.report(name, "--faults", "nan.vtp", "-o", "s.vtp")
        self.assertEqual(report["faults"]["points_without_z"], 1)

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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
