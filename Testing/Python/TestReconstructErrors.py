# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the program refuses: one line that says what to do, and no file."""

import os
import sys
import unittest

from on_sheet import SHEET, Program, text_of
from vtkelevationsurface import writing
from vtkelevationsurface.clouds import make_points
from vtkmodules.vtkCommonDataModel import vtkCellArray


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
