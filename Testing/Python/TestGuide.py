# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Documentation/Guide.md is true: its code runs and prints what stands there, and so are its figures."""

import os
import re
import tempfile
import unittest

import numpy
from documented import PICTURE, ROOT, examples_of, make_folder, run, run_commands, text_of
from vtkelevationsurface import read, reconstruct
from vtkelevationsurface.writing.grids import grid_of
from vtkmodules.util.numpy_support import vtk_to_numpy

GUIDE = text_of("Guide.md")


def flat_share(surface):
    """The share of the area, on the map, of triangles with one z."""
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype("f8")
    a, b, c = points[vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)].swapaxes(0, 1)
    (ux, uy, uz), (vx, vy, vz) = (b - a).T, (c - a).T
    areas = abs(ux * vy - uy * vx)
    return areas[(uz == 0) & (vz == 0)].sum() / areas.sum()


class Guide(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        make_folder(cls.folder)
        cls.printed = [(run(language, code, cls.folder), code, told)
                       for language, code, told in examples_of(GUIDE)]

    def test_each_example_prints_the_lines_below_it(self):
        self.assertGreaterEqual(len(self.printed), 6)
        for printed, code, told in self.printed:
            self.assertTrue(told, code)
            for line in told:
                self.assertIn(line, printed, code)

    def test_each_picture_is_made_by_an_example_and_is_small(self):
        names = PICTURE.findall(GUIDE)
        self.assertEqual(len(names), 6)
        for name in names:
            self.assertTrue(os.path.exists(os.path.join(self.folder, name + ".png")), name)
            kept = os.path.join(ROOT, "Documentation", "figures", f"guide-{name}.png")
            self.assertLess(os.path.getsize(kept), 150_000, name)

    def test_links_lead_to_files_and_headings(self):
        for name in ("Guide.md", "Migration.md"):
            text = text_of(name)
            headings = {re.sub(r"[^\w -]", "", line[3:].lower()).replace(" ", "-")
                        for line in text.splitlines() if line.startswith("## ")}
            for target in re.findall(r"\]\(([^)]+)\)", text):
                if target.startswith("#"):
                    self.assertIn(target[1:], headings)
                elif not target.startswith("https:"):
                    path = os.path.join(ROOT, "Documentation", target)
                    self.assertTrue(os.path.exists(path), target)

    def test_contour_lines_that_are_opened_make_few_flat_triangles(self):
        told = re.search(r"(\d+) % of this map are flat triangles; with it, (\d+) %.*?"
                         r"from (\S+) to (\S+) m", GUIDE, re.S).groups()
        run_commands("Utilities/reconstruct lines.gpkg --faults lines.gpkg --no-trim --open-edge-length 0 "
                     "--no-picture -o flat.vtp", self.folder)
        true = reconstruct(read(os.path.join(ROOT, "Data", "jacksboro_fault.vtp"))).to_grid(100)
        shares, errors = [], []
        for name in ("flat.vtp", "lines_surface.vtp"):
            surface = read(os.path.join(self.folder, name)).points
            shares.append(f"{100 * flat_share(surface):.0f}")
            grid = grid_of(surface, 100)
            same = true.z[numpy.isin(true.y, grid.y)][:, numpy.isin(true.x, grid.x)]
            errors.append(f"{numpy.sqrt(numpy.nanmean((grid.z - same) ** 2)):.1f}")
        self.assertEqual((*shares, *errors), told)


if __name__ == "__main__":
    unittest.main(argv=["TestGuide"])
