# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the report says of small surfaces, as numbers and in the lines for people."""

import unittest
import warnings

import numpy

import on_sheet
from on_sheet import SIZE
from vtkelevationsurface import ElevationSurfaceError, ElevationSurfaceWarning, reconstruct
from vtkelevationsurface.report import report_lines

SHEET = numpy.array(on_sheet.SHEET, "f8")
RING = numpy.array(on_sheet.RING)


def lines_of(report):
    return [text for _, text in report_lines({"left_out": {}, **report})]


class Lattice(unittest.TestCase):
    def test_directions_of_its_steps_go_from_x_to_y(self):
        turned = SHEET @ numpy.array([(8.0, 6.0, 0.0), (-1.2, 1.6, 0.0), (0.0, 0.0, 1.0)])
        report = reconstruct(turned).report
        found = dict(zip(numpy.round(report["lattice"]["lengths"], 6), report["lattice"]["directions"]))
        self.assertAlmostEqual(found[10.0] % 180.0, 36.8698976)
        self.assertAlmostEqual(found[2.0] % 180.0, 126.8698976)
        self.assertIn("10 towards 36.87 degrees", " ".join(lines_of(report)))


class Trimming(unittest.TestCase):
    def test_points_outside_an_outline_are_a_line_of_their_own(self):
        lone = [(SIZE + 60.0, float(y), 0.0) for y in range(40)]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ElevationSurfaceWarning)  # that the outline leaves out much
            report = reconstruct(numpy.vstack((SHEET, lone)), fill=False).report
        self.assertEqual(report["trim"]["points_left_out"], len(lone))
        self.assertIn("40 points outside the boundary", lines_of(report))
        self.assertFalse([text for text in lines_of(reconstruct(SHEET).report) if "outside" in text])


class Holes(unittest.TestCase):
    def test_a_void_that_triangles_bridge_and_that_stays_is_no_hole(self):
        holed = SHEET[numpy.hypot(SHEET[:, 0] - 5.0, SHEET[:, 1] - 4.0) > 2.5]
        for more in ({}, {"maximum_hole_edges": 3}):
            report = reconstruct(holed, open_edge_length=1.5, **more).report["holes"]
            is_left = bool(more)
            self.assertEqual((report["found"], report["bridged_left"]), (not is_left, is_left))
            self.assertTrue(report["list"][0]["bridged"])


class Errors(unittest.TestCase):
    def test_an_error_is_about_the_boundary_where_trimming_along_one_fails(self):
        for given, about in (
            ({"boundary": RING, "recover_boundary": False}, "boundary"),
            ({"gap_tolerance": 1e-9}, "points"),
        ):
            with self.subTest(about=about), self.assertRaises(ElevationSurfaceError) as caught:
                reconstruct(SHEET, **given)
            self.assertEqual((caught.exception.step, caught.exception.about), ("trimming", about))


if __name__ == "__main__":
    unittest.main()
