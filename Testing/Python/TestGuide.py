# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Documentation/Guide.md is true: its code runs and prints what stands there, and so are its figures."""

import os
import re
import tempfile
import unittest

import numpy
from documented import PICTURE, ROOT, examples_of, make_folder, run, run_commands, text_of
from in_folder import draws
from vtkelevationsurface import read, reconstruct
from vtkelevationsurface.writing.grids import interpolated
from vtkmodules.util.numpy_support import vtk_to_numpy

GUIDE = text_of("Guide.md")


def flat_share(surface):
    """The share of the area, on the map, of triangles with one z."""
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype("f8")
    a, b, c = points[vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)].swapaxes(0, 1)
    (ux, uy, uz), (vx, vy, vz) = (b - a).T, (c - a).T
    areas = abs(ux * vy - uy * vx)
    return areas[(uz == 0) & (vz == 0)].sum() / areas.sum()


class Gaps(unittest.TestCase):
    """The table of how gaps are treated, on rough squares with two gaps inside and two at the border."""

    BOXES = {"narrow": (10, 13, 10, 25), "wide": (35, 46, 10, 25),
             "narrow bay": (10, 13, 48, 70), "wide bay": (35, 46, 48, 70)}

    def setUp(self):
        xy = numpy.stack(numpy.meshgrid(*2 * [numpy.arange(60.0)]), axis=-1).reshape(-1, 2)
        xy += numpy.random.RandomState(3).uniform(-0.2, 0.2, xy.shape)
        for left, right, low, high in self.BOXES.values():
            xy = xy[~((xy > (left, low)) & (xy < (right, high))).all(axis=1)]
        self.points = numpy.column_stack((xy, numpy.sin(xy[:, 0] / 9)))

    def fates(self, option, **properties):
        """{gap: how it was treated}, and how many points are new"""
        self.assertRegex(GUIDE, rf"\| {option} \| ")
        result = reconstruct(self.points, **properties)
        places = result.to_numpy()[0][len(self.points):, :2]
        grid, fates, counts = result.to_grid(0.5), {}, {}
        for name, (left, right, low, high) in self.BOXES.items():
            high = min(high, 58)
            inside = ((places > (left, low)) & (places < (right, high))).all(axis=1)
            counts[name] = int(inside.sum())
            row, column = abs(grid.y - (low + high) / 2).argmin(), abs(grid.x - (left + right) / 2).argmin()
            is_open = numpy.isnan(grid.z[row, column])
            fates[name] = "open" if is_open else "filled" if counts[name] else "bridged"
        return list(fates.values()), counts["wide"]

    def test_each_row_of_the_table_is_true(self):
        plain, few = self.fates("no length")
        self.assertEqual(plain, ["bridged", "filled", "bridged", "open"])
        cut, many = self.fates("`--maximum-edge-length L`", maximum_edge_length=2.3)
        self.assertEqual(cut, ["filled", "filled", "open", "open"])
        opened, _ = self.fates("`--open-edge-length L`", open_edge_length=2.3)
        self.assertEqual(opened, ["filled", "filled", "filled", "open"])
        _, coarse = self.fates("no length", match_density=False)
        self.assertGreater(many, 5 * coarse)
        self.assertGreater(few, 0.6 * many)  # as dense as around; long triangles remain along the rim


def headings_of(path):
    """The headings of a page, as links name them."""
    with open(path, encoding="utf-8") as page:
        titles = re.findall(r"(?m)^##+ (.+)$", page.read())
    return {re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles}


@draws
class Guide(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        make_folder(cls.folder)
        cls.printed = [(run(language, code, cls.folder), code, expected)
                       for language, code, expected in examples_of(GUIDE)]

    def test_each_example_prints_the_lines_below_it(self):
        self.assertGreaterEqual(len(self.printed), 6)
        for printed, code, expected in self.printed:
            self.assertTrue(expected, code)
            for line in expected:
                self.assertIn(line, printed, code)

    def test_each_picture_is_made_by_an_example_and_is_small(self):
        names = PICTURE.findall(GUIDE)
        self.assertEqual(len(names), 10)
        for name in names:
            self.assertTrue(os.path.exists(os.path.join(self.folder, name + ".png")), name)
            kept = os.path.join(ROOT, "Documentation", "figures", f"guide-{name}.png")
            self.assertLess(os.path.getsize(kept), 150_000, name)

    def test_links_lead_to_files_and_headings(self):
        for name in ("Guide.md", "Migration.md"):
            for target in re.findall(r"\]\(([^)]+)\)", text_of(name)):
                if target.startswith("https:"):
                    continue
                page, _, heading = target.partition("#")
                path = os.path.join(ROOT, "Documentation", page or name)
                self.assertTrue(os.path.exists(path), target)
                if heading:
                    self.assertIn(heading, headings_of(path), target)

    def test_contour_lines_that_are_opened_make_few_flat_triangles(self):
        figures = re.search(r"(\d+) % of this map are flat triangles; with it, (\d+) %.*?"
                         r"from (\S+) to (\S+) m", GUIDE, re.S).groups()
        run_commands("Utilities/reconstruct lines.gpkg --faults lines.gpkg --no-trim --open-edge-length 0 "
                     "--no-picture -o flat.vtp", self.folder)
        true = reconstruct(read(os.path.join(ROOT, "Data", "jacksboro_fault.vtp"))).to_grid(100)
        shares, errors = [], []
        for name in ("flat.vtp", "lines_surface.vtp"):
            surface = read(os.path.join(self.folder, name)).points
            shares.append(f"{100 * flat_share(surface):.0f}")
            z, _ = interpolated(surface, true.frame)
            errors.append(f"{numpy.sqrt(numpy.nanmean((z - true.z) ** 2)):.1f}")
        self.assertEqual((*shares, *errors), figures)


if __name__ == "__main__":
    unittest.main(argv=["TestGuide"])
