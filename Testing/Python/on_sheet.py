# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the program on a sheet of points: files in, files and a report out."""

import math
import os

import in_folder

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, os.pardir, os.pardir))
DATA = os.path.join(ROOT, "Data")
SIZE = 12
# A sheet of SIZE x SIZE points, one apart; z is a plane, so that nothing depends on the triangles.
SHEET = [(x, y, 0.5 * x - 0.25 * y) for y in range(SIZE) for x in range(SIZE)]
# The same with 3 x 3 points taken out of the middle. With edges of at most 1.5 that leaves a hole of
# 4 x 4 with its corners cut: 12 edges, an area of 14.
HOLED = [p for p in SHEET if not (4 <= p[0] <= 6 and 4 <= p[1] <= 6)]
# A ring around most of it, between the points.
RING = [(0.5, 0.5), (9.5, 0.5), (9.5, 9.5), (0.5, 9.5)]

# Three survey lines, 100 times as far apart as their points, and one that crosses them.
CROSSING = [(x + 0.2 * math.sin(7 * x), 100 * k + 20 * math.sin(x / 90 + k), math.sin(x / 60))
            for k in range(3) for x in range(400)] + [
    (80 + 0.4 * y, y, math.sin((80 + 0.4 * y) / 60)) for y in range(200)]


def text_of(rows):
    return "".join(f"{x:.12g} {y:.12g} {z:.12g}\n" for x, y, z in rows)


class Program(in_folder.Program):
    """Runs the program, and reads its report."""

    def report(self, *arguments):
        """The report of a run that must succeed."""
        done = self.call(*arguments, "--no-picture", "--report", "report.json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.output = done.stdout
        return self.json("report.json")

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
