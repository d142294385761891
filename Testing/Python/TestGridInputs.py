# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Images and grids as the input of the whole chain: where their nodes are, and which are hidden."""

import sys
import unittest

import numpy
from vtkelevationsurface import ElevationSurfaceError, reconstruct
from vtkelevationsurface.inputs import cloud_of
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import (
    vtkDataSetAttributes,
    vtkImageData,
    vtkPolyData,
    vtkRectilinearGrid,
)
from vtkelevationsurface.clouds import make_points


def named(name, values, kind="f8"):
    array = numpy_to_vtk(numpy.asarray(values, kind).ravel(), deep=True)
    array.SetName(name)
    return array


def image_of(columns, rows):
    image = vtkImageData()
    image.SetDimensions(columns, rows, 1)
    image.SetSpacing(1.0, 2.0, 1.0)
    image.GetPointData().SetScalars(named("h", numpy.arange(columns * rows)))
    return image


def xyz_of(cloud):
    return vtk_to_numpy(cloud.points.GetPoints().GetData())


GHOSTS = vtkDataSetAttributes.GhostArrayName()


class GridInputs(unittest.TestCase):
    def test_nodes_of_a_turned_image_are_where_vtk_has_them(self):
        for matrix in (
            (0, -1, 0, 1, 0, 0, 0, 0, 1),
            (0.8, -0.6, 0, 0.6, 0.8, 0, 0, 0, 1),
            (1, 0, 0, 0, 1, 0, 0, 0, 1),
        ):
            image = image_of(20, 15)
            image.SetOrigin(600000.0, 5000000.0, 0.0)
            image.SetDirectionMatrix(*matrix)
            places = numpy.array([image.GetPoint(i)[:2] for i in range(300)])
            found = xyz_of(cloud_of([image]))
            numpy.testing.assert_allclose(found[:, :2], places, rtol=0, atol=1e-9)
            numpy.testing.assert_array_equal(found[:, 2], numpy.arange(300))

    def test_an_image_that_leans_is_refused(self):
        image = image_of(4, 4)
        image.SetDirectionMatrix(1, 0, 0, 0, 0, -1, 0, 1, 0)
        with self.assertRaisesRegex(ElevationSurfaceError, "leans"):
            cloud_of([image])

    def test_hidden_points_and_cells_are_left_out_and_counted(self):
        image = image_of(6, 5)
        ghosts = numpy.zeros(30)
        ghosts[[7, 8]] = vtkDataSetAttributes.HIDDENPOINT
        image.GetPointData().AddArray(named(GHOSTS, ghosts, "u1"))
        cells = numpy.zeros((4, 5))
        cells[2:, 3:] = vtkDataSetAttributes.HIDDENCELL  # around the nodes (4, 3), (5, 3), (4, 4) ...
        image.GetCellData().AddArray(named(GHOSTS, cells, "u1"))
        cloud = cloud_of([image])
        left = set(range(30)) - {7, 8} - {22, 23, 28, 29}
        self.assertEqual(set(xyz_of(cloud)[:, 2].astype(int)), left)
        self.assertEqual(cloud.left_out, {"pixels without data": 6})

        points = vtkPolyData()
        points.SetPoints(make_points(numpy.random.default_rng(1).uniform(0, 9, (30, 3))).GetPoints())
        points.GetPointData().AddArray(named(GHOSTS, ghosts, "u1"))
        cloud = cloud_of([points])
        self.assertEqual(cloud.points.GetNumberOfPoints(), 28)
        self.assertEqual(cloud.left_out, {"points marked as hidden": 2})

    def test_a_grid_of_unequal_steps_has_no_holes_where_its_steps_are_large(self):
        x = numpy.append(numpy.arange(10.0), 9.0 + 5.0 * numpy.arange(1, 11))
        for steps in (x, numpy.arange(20.0) ** 2):
            grid = vtkRectilinearGrid()
            grid.SetDimensions(20, 15, 1)
            grid.SetXCoordinates(named("x", steps))
            grid.SetYCoordinates(named("y", numpy.arange(15.0)))
            z = numpy.add.outer(numpy.arange(15.0), steps) / 10.0
            grid.GetPointData().SetScalars(named("h", z))
            surface = reconstruct(cloud_of([grid])).surface
            self.assertEqual(surface.GetNumberOfPoints(), 300)
            self.assertEqual(surface.GetNumberOfPolys(), 532)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
