# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""OpenEdgeLength of vtkFillElevationHoles on a terrain model with small voids that the
triangulation bridges: the lost nodes come back, with about half the error of the flat bridges."""
import os
import sys
import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkGenericCell, vtkPolyData, vtkStaticCellLocator
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from vtkelevationsurface import vtkFillElevationHoles, vtkGridDelaunay2D

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from mesh_rules import findings  # noqa: E402

DATA = sys.argv[sys.argv.index("-D") + 1]


def cloud(points):
    data = vtkPolyData()
    data.SetPoints(vtkPoints())
    data.GetPoints().SetData(numpy_to_vtk(points, deep=True))
    return data


def coordinates(surface):
    return vtk_to_numpy(surface.GetPoints().GetData()).astype("f8")


def elevations(surface, places):
    """z of a surface at places (x, y)."""
    points = coordinates(surface)
    flat = cloud(np.column_stack([points[:, :2], np.zeros(len(points))]))
    flat.SetPolys(surface.GetPolys())
    locator = vtkStaticCellLocator()
    locator.SetDataSet(flat)
    locator.BuildLocator()
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    cell, place, weights = vtkGenericCell(), [0.0] * 3, [0.0] * 3
    result = []
    for x, y in places:
        found = locator.FindCell([x, y, 0.0], 1e-6, cell, place, weights)
        result.append(np.dot(points[corners[found], 2], weights) if found >= 0 else np.nan)
    return np.array(result)


class TestBridgedVoids(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(os.path.join(DATA, "jacksboro_fault.vtp"))
        reader.Update()
        points = coordinates(reader.GetOutput())
        x, y = np.unique(points[:, 0]), np.unique(points[:, 1])
        cls.steps = x[1] - x[0], y[1] - y[0]
        points = points[(points[:, 0] <= x[150]) & (points[:, 1] <= y[150])]
        random = np.random.RandomState(1)
        lost = np.zeros(len(points), dtype=bool)
        for center in points[random.randint(len(points), size=150), :2]:
            radius = random.uniform(1.6, 2.2)
            lost |= np.hypot(*((points[:, :2] - center) / cls.steps).T) < radius
        inside = (points[:, :2] > points[:, :2].min(axis=0)) & (points[:, :2] < points[:, :2].max(axis=0))
        cls.lost = points[lost & inside.all(axis=1)]
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(cloud(points[~lost]))
        delaunay.Update()
        cls.bridged = delaunay.GetOutput()

    def error(self, surface):
        return np.sqrt(np.mean((elevations(surface, self.lost[:, :2]) - self.lost[:, 2]) ** 2))

    def fill(self, length):
        fill = vtkFillElevationHoles()
        fill.SetInputData(self.bridged)
        fill.SetOpenEdgeLength(length)
        fill.Update()
        return fill

    def test_triangles_bridge_the_voids(self):
        self.assertEqual(self.fill(0.0).GetNumberOfHoles(), 0)

    def test_opened_voids_are_filled_with_the_lost_nodes(self):
        fill = self.fill(1.5 * np.hypot(*self.steps))
        surface = fill.GetOutput()
        self.assertEqual(findings(surface), [])
        self.assertGreater(fill.GetNumberOfHoles(), 80)
        status = vtk_to_numpy(fill.GetOutput(1).GetCellData().GetArray("Status"))
        self.assertTrue((status == fill.REPLACED).all())
        new = coordinates(surface)[self.bridged.GetNumberOfPoints():]
        nodes = {tuple(p) for p in np.round(self.lost[:, :2] / self.steps).astype(int).tolist()}
        found = {tuple(p) for p in np.round(new[:, :2] / self.steps).astype(int).tolist()}
        self.assertEqual(len(found), len(new))
        self.assertGreater(len(found & nodes), 0.9 * len(nodes))
        self.assertLess(len(found - nodes), 0.01 * len(nodes) + 1)

    def test_their_error_is_well_below_that_of_the_bridges(self):
        bridged = self.error(self.bridged)
        filled = self.error(self.fill(1.5 * np.hypot(*self.steps)).GetOutput())
        print(f"RMSE: {bridged:.2f} bridged, {filled:.2f} filled")
        self.assertLess(filled, 0.65 * bridged)


if __name__ == "__main__":
    unittest.main(argv=["TestBridgedVoids"])
