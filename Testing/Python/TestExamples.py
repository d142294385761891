# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The scripts of Examples/Python run, and make what they are to show."""

import os
import sys
import unittest

import in_folder
from on_sheet import DATA, ROOT, Program
from vtkelevationsurface.reading import vtk_files
from vtkmodules.util.numpy_support import vtk_to_numpy

EXAMPLES = os.path.join(ROOT, "Examples", "Python")


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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
