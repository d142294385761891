# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Holes that are filled level, as lakes: by the filter, in Python, by the program, in memory and pieces."""
import sys
import unittest

import meshes
import numpy
from in_folder import Program
from TestChosenHoles import CENTRES, LAKES, RADIUS, surface, survey
from vtkelevationsurface import reconstruct, vtkFillElevationHoles
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


class OfProgram(Program):
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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
