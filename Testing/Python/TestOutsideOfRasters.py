# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Missing pixels that touch the outside of a raster are outside; enclosed ones are holes that are filled."""

import os
import tempfile
import unittest

import numpy
from osgeo import gdal

from vtkelevationsurface import read, reconstruct
from vtkelevationsurface.clouds import Cloud, make_points, merged

gdal.UseExceptions()

SIZE = 60
PLACE = (500000.0, 25.0, 0.0, 6000000.0, 0.0, -25.0)


def terrain():
    rows, columns = numpy.mgrid[:SIZE, :SIZE]
    return 40.0 * numpy.sin(rows / 9.0) * numpy.cos(columns / 7.0) + rows


def country():
    """Which pixels of a raster are inside a border with bays of all widths, and which are a lake."""
    rows, columns = numpy.mgrid[:SIZE, :SIZE]
    angle = numpy.arctan2(rows - 30, columns - 30)
    radius = numpy.hypot(rows - 30, columns - 30)
    inside = radius < 24 + 3 * numpy.sin(7 * angle) + 1.5 * numpy.sin(23 * angle)
    for column, width, top in ((20, 1, 25), (30, 2, 22), (38, 3, 28)):
        inside[:top, column : column + width] = False  # fjords
    inside[30:34, 5:11] = False
    inside[31, :11] = False  # a bay behind a mouth of one pixel
    lake = (radius > 2) & (numpy.hypot(rows - 40, columns - 36) < 5.5) & inside
    return inside, lake


def with_cells(inside):
    """Without pixels that are in no triangle of a cell."""
    corners = sum(inside[i : i + SIZE - 1, k : k + SIZE - 1].astype(int) for i in (0, 1) for k in (0, 1))
    near = numpy.zeros(inside.shape, dtype=bool)
    for i in (0, 1):
        for k in (0, 1):
            near[i : i + SIZE - 1, k : k + SIZE - 1] |= corners >= 3
    return inside & near


def raster(path, z, place=PLACE):
    data = gdal.GetDriverByName("GTiff").Create(path, z.shape[1], z.shape[0], 1, gdal.GDT_Float64)
    data.SetGeoTransform(place)
    data.GetRasterBand(1).SetNoDataValue(-9999.0)
    data.GetRasterBand(1).WriteArray(numpy.where(numpy.isnan(z), -9999.0, z))
    data.FlushCache()
    return path


class TestOutsideOfRasters(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.inside, self.lake = country()
        self.z = numpy.where(self.inside & ~self.lake, terrain(), numpy.nan)

    def pixels(self, result, place=PLACE):
        """The pixels whose centres the surface covers, and those of inserted points."""
        xyz, triangles = result.to_numpy()
        matrix = numpy.array([place[1:3], place[4:6]])
        cells = numpy.linalg.solve(matrix, (xyz[:, :2] - (place[0], place[3])).T).T - 0.5
        covered = numpy.zeros(self.z.shape, dtype=bool)
        for corners in cells[triangles]:
            low = numpy.ceil(corners.min(axis=0) - 1e-6).astype(int)
            high = numpy.floor(corners.max(axis=0) + 1e-6).astype(int)
            for column in range(low[0], high[0] + 1):
                for row in range(low[1], high[1] + 1):
                    to = corners - (column, row)
                    sides = [to[i][0] * to[i - 1][1] - to[i][1] * to[i - 1][0] for i in range(3)]
                    if max(sides) < 1e-6 or min(sides) > -1e-6:
                        covered[row, column] = True
        new = numpy.rint(cells[result.cloud.points.GetNumberOfPoints() :]).astype(int)
        return covered, new

    def check(self, result, place=PLACE):
        covered, new = self.pixels(result, place)
        numpy.testing.assert_array_equal(covered, with_cells(self.inside))
        self.assertTrue(self.lake[new[:, 1], new[:, 0]].all(), "points are invented outside")
        self.assertGreater(len(new), 0.8 * self.lake.sum())

    def test_bays_are_outside_and_lakes_are_filled(self):
        self.check(reconstruct(read(raster(os.path.join(self.folder, "a.tif"), self.z))))

    def test_pixels_may_be_long_and_turned(self):
        for place in ((0.0, 1.0, 0.0, 0.0, 0.0, -2.5), (0.0, 8.0, 6.0, 0.0, 6.0, -8.0)):
            with self.subTest(place=place):
                path = raster(os.path.join(self.folder, "b.tif"), self.z, place)
                self.check(reconstruct(read(path)), place)

    def test_rasters_of_one_grid_are_one(self):
        west = raster(os.path.join(self.folder, "west.tif"), self.z[:, :31])
        place = (PLACE[0] + 31 * 25.0, *PLACE[1:])
        east = raster(os.path.join(self.folder, "east.tif"), self.z[:, 31:], place)
        cloud = merged([west, east], [read(west), read(east)])
        self.check(reconstruct(cloud))
        apart = raster(os.path.join(self.folder, "apart.tif"), self.z[:, 31:], (PLACE[0] + 780.0, *PLACE[1:]))
        self.assertIsNone(merged([west, apart], [read(west), read(apart)]).grid)
        other = Cloud(make_points(numpy.eye(3)))
        self.assertIsNone(merged([west, "other"], [read(west), other]).grid)

    def test_a_gap_tolerance_counts_instead(self):
        path = raster(os.path.join(self.folder, "c.tif"), self.z)
        covered, _ = self.pixels(reconstruct(read(path), gap_tolerance=4.5))
        self.assertTrue((covered & ~self.inside).any())

    def test_a_thinned_raster_is_not_a_grid_with_missing_pixels(self):
        random = numpy.random.default_rng(3)
        z = numpy.where(random.random(self.z.shape) < 0.1, terrain(), numpy.nan)
        cloud = read(raster(os.path.join(self.folder, "d.tif"), z))
        self.assertIsNone(cloud.grid)

    def test_the_outline_of_few_points_has_the_same_bays(self):
        path = raster(os.path.join(self.folder, "e.tif"), self.z)
        result = reconstruct(read(path), maximum_elevation_error=0.5, fill=False)
        covered, _ = self.pixels(result)
        outside = covered & ~self.inside
        # The outline is simplified within half a pixel.
        self.assertLess(outside.sum(), 10)


if __name__ == "__main__":
    unittest.main(argv=["TestOutsideOfRasters"])
