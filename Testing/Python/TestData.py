# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The files of Data/ are what Data/README.md says of them.

Needs VTK's Python modules and NumPy, not the filters of this project. The table "Files" of the
README is read by the test, so that text and data cannot drift apart.
"""

import os
import re
import sys
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersGeneral import vtkTableToPolyData
from vtkmodules.vtkIOInfovis import vtkDelimitedTextReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(HERE, os.pardir, os.pardir, "Data")
LARGEST_FILE = 2 * 1000 * 1000

# In b9_ground: the middle of the courtyard, and a closed walk over the roof around it.
COURTYARD = (596699.0, 243683.0)
ROOF = [(596690.8, 243713.7), (596725.2, 243696.2), (596709.3, 243661.3), (596676.0, 243676.5)]

# file of lines: the surface it belongs to
OWNERS = {
    "aegean_sea_boundary.vtp": "aegean_sea.csv",
    "horizon_synthetic_boundary.vtp": "horizon_synthetic.vtp",
    "horizon_synthetic_faults.vtp": "horizon_synthetic.vtp",
}


def read_readme():
    with open(os.path.join(DATA, "README.md"), encoding="utf-8") as stream:
        return stream.read()


def read_table():
    """The README's table "Files": {file: (points, [xmin, xmax, ..., zmax], reader)}."""
    section = read_readme().split("## Files")[1].split("\n## ")[0]
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in section.splitlines()
        if re.match(r"\|\s*\w+\.\w+", line)
    ]
    return {row[0]: (int(row[1]), [float(c) for c in row[2:8]], row[8]) for row in rows}


def read(name):
    """Read a file of Data/ with the reader that the README names; returns vtkPolyData."""
    reader_name = read_table()[name][2]
    path = os.path.join(DATA, name)
    if reader_name == "vtkXMLPolyDataReader":
        last = vtkXMLPolyDataReader()
        last.SetFileName(path)
    elif reader_name == "vtkDelimitedTextReader":
        reader = vtkDelimitedTextReader()
        reader.SetFileName(path)
        reader.SetHaveHeaders(True)
        reader.SetDetectNumericColumns(True)
        reader.SetFieldDelimiterCharacters("," if name.endswith(".csv") else " ")
        last = vtkTableToPolyData()
        last.SetInputConnection(reader.GetOutputPort())
        last.SetXColumn("x")
        last.SetYColumn("y")
        last.SetZColumn("z")
    else:
        raise AssertionError("README names an unknown reader for %s: %s" % (name, reader_name))
    last.Update()
    return last.GetOutput()


def coordinates(mesh):
    return vtk_to_numpy(mesh.GetPoints().GetData())


def lines(mesh):
    """Every line as an array of point ids."""
    cells = mesh.GetLines()
    offsets = vtk_to_numpy(cells.GetOffsetsArray())
    ids = vtk_to_numpy(cells.GetConnectivityArray())
    return [ids[a:b] for a, b in zip(offsets[:-1], offsets[1:])]


def is_delaunay_edge(points, a, b):
    """Whether some circle through a and b holds no point inside (points: n x 2).

    A centre is the middle of ab plus s times its left normal. Every other point bounds s: from
    above when it lies to the left, from below when to the right.
    """
    # The ends lie on every such circle; left in, rounding would put them inside or outside.
    x, y = points.T
    points = points[((x != a[0]) | (y != a[1])) & ((x != b[0]) | (y != b[1]))]
    middle = 0.5 * (a + b)
    normal = np.array([a[1] - b[1], b[0] - a[0]])
    d = points - middle
    height = 2 * d.dot(normal)
    power = np.einsum("ij,ij->i", d, d) - 0.25 * normal.dot(normal)
    on_line = height == 0
    if np.any(power[on_line] < 0):
        return False  # a point on the edge itself
    with np.errstate(divide="ignore", invalid="ignore"):
        s = power / height
    upper = np.min(s[height > 0], initial=np.inf)
    lower = np.max(s[height < 0], initial=-np.inf)
    return lower < upper


class TestData(unittest.TestCase):
    def test_readme_lists_every_file(self):
        files = {f for f in os.listdir(DATA) if os.path.isfile(os.path.join(DATA, f))}
        self.assertEqual(files - {"README.md"}, set(read_table()))

    def test_licence_texts_are_named_and_there(self):
        named = set(re.findall(r"`LICENSES/([^`]+)`", read_readme()))
        self.assertEqual(named, set(os.listdir(os.path.join(DATA, "LICENSES"))))

    def test_files_are_small(self):
        for name in read_table():
            size = os.path.getsize(os.path.join(DATA, name))
            self.assertLessEqual(size, LARGEST_FILE, name)

    def test_counts_bounds_and_finite_values_are_as_documented(self):
        for name, (count, bounds, _) in read_table().items():
            with self.subTest(name):
                points = coordinates(read(name))
                self.assertEqual(len(points), count)
                self.assertTrue(np.isfinite(points).all())
                found = np.stack([points.min(axis=0), points.max(axis=0)], axis=1).ravel()
                self.assertEqual(found.tolist(), bounds)

    def test_map_coordinates_are_double_and_jacksboro_is_single(self):
        for name in read_table():
            expected = np.float32 if name == "jacksboro_fault.vtp" else np.float64
            self.assertEqual(coordinates(read(name)).dtype, expected, name)

    def test_no_position_is_repeated(self):
        for name in read_table():
            points = coordinates(read(name))[:, :2]
            self.assertEqual(len(np.unique(points, axis=0)), len(points), name)

    def test_surfaces_hold_points_and_others_lines(self):
        for name in read_table():
            mesh = read(name)
            self.assertEqual(mesh.GetNumberOfPolys(), 0, name)
            if name in OWNERS:
                self.assertEqual(mesh.GetNumberOfVerts(), 0, name)
                self.assertGreater(mesh.GetNumberOfLines(), 0, name)
            else:
                self.assertEqual(mesh.GetNumberOfLines(), 0, name)
                ids = vtk_to_numpy(mesh.GetVerts().GetConnectivityArray())
                self.assertEqual(ids.tolist(), list(range(mesh.GetNumberOfPoints())), name)

    def test_line_points_are_data_points(self):
        for name, owner in OWNERS.items():
            known = set(map(tuple, coordinates(read(owner)).tolist()))
            for point in coordinates(read(name)).tolist():
                self.assertIn(tuple(point), known, name)

    def test_line_edges_are_delaunay_edges(self):
        for name, owner in OWNERS.items():
            mesh = read(name)
            near = coordinates(mesh)[:, :2]
            # Near the origin nothing is lost in the squares.
            points = coordinates(read(owner))[:, :2] - near[0]
            near = near - near[0]
            for line in lines(mesh):
                for a, b in zip(line[:-1], line[1:]):
                    self.assertTrue(is_delaunay_edge(points, near[a], near[b]), (name, a, b))

    def test_boundaries_are_closed_simple_rings_with_the_surface_on_the_left(self):
        expected = {"aegean_sea_boundary.vtp": (4, 21), "horizon_synthetic_boundary.vtp": (1, 1)}
        for name, counts in expected.items():
            mesh = read(name)
            points = coordinates(mesh)[:, :2] - coordinates(mesh)[0, :2]
            areas = []
            for ring in lines(mesh):
                self.assertEqual(ring[0], ring[-1], name)
                self.assertEqual(len(set(ring[:-1].tolist())), len(ring) - 1, name)
                x, y = points[ring].T
                areas.append(0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
            self.assertEqual((sum(a > 0 for a in areas), sum(a < 0 for a in areas)), counts, name)
            self.assertGreater(max(areas, key=abs), 0, name)

    def test_fault_lines_meet_at_both_tips_and_bound_the_gap(self):
        faults = read("horizon_synthetic_faults.vtp")
        boundary = read("horizon_synthetic_boundary.vtp")
        first, second = lines(faults)
        self.assertEqual((first[0], first[-1]), (second[0], second[-1]))
        gap = {tuple(p) for p in coordinates(boundary)[lines(boundary)[1]].tolist()}
        sides = {tuple(p) for p in coordinates(faults).tolist()}
        self.assertEqual(gap, sides)

    def test_horizon_is_a_rotated_lattice_rounded_to_a_decimetre(self):
        mesh = read("horizon_synthetic.vtp")
        points = coordinates(mesh)
        inline, crossline = (
            vtk_to_numpy(mesh.GetPointData().GetArray(name)).astype(float)
            for name in ("Inline", "Crossline")
        )
        self.assertEqual((inline.min(), crossline.min()), (1100, 2400))
        design = np.column_stack([np.ones(len(points)), inline - 1100, crossline - 2400])
        origin = points[0, :2]
        fit, _, _, _ = np.linalg.lstsq(design, points[:, :2] - origin, rcond=None)
        # Half of the rounding, and a little for the fit, which follows the rounding.
        self.assertLess(np.abs(design.dot(fit) - (points[:, :2] - origin)).max(), 0.051)
        self.assertAlmostEqual(np.hypot(*fit[1]), 25.0, places=3)
        self.assertAlmostEqual(np.hypot(*fit[2]), 18.75, places=3)
        self.assertAlmostEqual(np.degrees(np.arctan2(fit[2][1], fit[2][0])), 33.7, places=3)
        np.testing.assert_array_equal(points, np.round(points, 1))

    def test_jacksboro_is_an_exact_full_lattice(self):
        points = coordinates(read("jacksboro_fault.vtp")).astype(float)
        i, j = points[:, 0] / 74.5625, points[:, 1] / 92.5
        np.testing.assert_array_equal(i, np.tile(np.arange(403), 344))
        np.testing.assert_array_equal(j, np.repeat(np.arange(344)[::-1], 403))

    def test_b9_has_points_in_the_courtyard_and_none_on_the_ring_around_it(self):
        points = coordinates(read("b9_ground.vtp"))[:, :2]
        roof = np.array(ROOF)
        self.assertGreater(np.sum(np.hypot(*(points - COURTYARD).T) < 5.0), 100)
        for a, b in zip(roof, np.roll(roof, -1, axis=0)):
            for t in np.linspace(0, 1, 50):
                nearest = np.hypot(*(points - (a + t * (b - a))).T).min()
                self.assertGreater(nearest, 2.0)


if __name__ == "__main__":
    # The test driver may pass options of its own, which this test has no use for.
    unittest.main(argv=sys.argv[:1])
