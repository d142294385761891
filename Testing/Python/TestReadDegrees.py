# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Degrees: said of every kind of raster, and made metres."""

import json
import os
import sys
import unittest

import numpy
from in_folder import Program, coordinates
from osgeo import gdal, osr
from vtkelevationsurface import read, reconstruct
from vtkelevationsurface.messages import FileError
from vtkmodules.util.numpy_support import vtk_to_numpy

gdal.UseExceptions()
Z = numpy.random.default_rng(1).normal(500, 100, (12, 15)).astype("f4")
STEP = 1 / 1200
PLACE = (9.0, STEP, 0.0, 47.0, 0.0, -STEP)


def raster(path, driver, place=PLACE, epsg=None, metadata=()):
    data = gdal.GetDriverByName("MEM").Create("", Z.shape[1], Z.shape[0], 1, gdal.GDT_Float32)
    data.SetGeoTransform(place)
    if epsg:
        reference = osr.SpatialReference()
        reference.ImportFromEPSG(epsg)
        data.SetProjection(reference.ExportToWkt())
    data.GetRasterBand(1).WriteArray(Z)
    data.GetRasterBand(1).SetNoDataValue(-9999)
    gdal.GetDriverByName(driver).CreateCopy(path, data).FlushCache()
    for other in (path + ".aux.xml", os.path.splitext(path)[0] + ".prj"):
        if os.path.exists(other):
            os.remove(other)
    return path


def expected(x, y, zone=32632, source=4326):
    systems = []
    for code in (source, zone):
        systems.append(osr.SpatialReference())
        systems[-1].ImportFromEPSG(code)
        systems[-1].SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return numpy.array(osr.CoordinateTransformation(*systems).TransformPoint(x, y)[:2])


class Degrees(Program):
    FORMATS = (
        ("a.tif", "GTiff", 4326, "are angles"), ("a.nc", "netCDF", 4326, "are angles"),
        ("a.asc", "AAIGrid", None, "look like degrees"), ("s.grd", "GSBG", None, "look like degrees"),
        ("b.grd", "GSAG", None, "look like degrees"), ("c.grd", "GMT", None, "look like degrees"),
    )

    def test_degrees_are_noted_for_every_kind_and_become_metres(self):
        for name, driver, epsg, words in self.FORMATS:
            with self.subTest(name=name):
                if not gdal.GetDriverByName(driver):
                    continue
                path = raster(self.path(name), driver, epsg=epsg)
                notes = [note for note in read(path).notes if words in note]
                self.assertEqual(len(notes), 1, read(path).notes)
                cloud = read(path, project=True)
                self.assertFalse([note for note in cloud.notes if words in note])
                self.assertTrue([note for note in cloud.notes if "WGS 84 / UTM zone 32N (EPSG:32632)" in note])
                self.assertEqual(cloud.crs, "EPSG:32632")
                place = expected(9 + 0.5 * STEP, 47 - 0.5 * STEP)
                numpy.testing.assert_allclose(coordinates(cloud)[0, :2], place, rtol=0, atol=0.01)

    def test_netcdf_axes_in_degrees_are_noted_without_a_system(self):
        data = gdal.GetDriverByName("netCDF").CreateMultiDimensional(self.path("a.nc"))
        group, double = data.GetRootGroup(), gdal.ExtendedDataType.Create(gdal.GDT_Float64)
        axes = [group.CreateDimension(name, None, None, count) for name, count in (("lat", 12), ("lon", 15))]
        for axis, first, unit in zip(axes, (47.0, 9.0), ("degrees_north", "degrees_east")):
            array = group.CreateMDArray(axis.GetName(), [axis], double)
            array.Write(first + STEP * numpy.arange(axis.GetSize()))
            array.SetUnit(unit)
        group.CreateMDArray("depth", axes, double).Write(numpy.random.default_rng(1).normal(size=(12, 15)))
        array = group = data = None
        self.assertTrue([note for note in read(self.path("a.nc")).notes if "are angles" in note])

    def test_a_mesh_of_ugrid_without_nodes_is_refused(self):
        data = gdal.GetDriverByName("netCDF").CreateMultiDimensional(self.path("m.nc"))
        group = data.GetRootGroup()
        group.CreateAttribute("Conventions", [], gdal.ExtendedDataType.CreateString()).Write("CF-1.8 UGRID-1.0")
        ends = [group.CreateDimension(name, None, None, count) for name, count in (("edges", 5), ("two", 2))]
        nodes = group.CreateMDArray("edge_nodes", ends, gdal.ExtendedDataType.Create(gdal.GDT_Int32))
        nodes.Write(numpy.arange(10, dtype="i4").reshape(5, 2))
        nodes = group = data = None
        with self.assertRaisesRegex(FileError, "is a mesh of UGRID whose nodes"):
            read(self.path("m.nc"))

    def test_metres_are_not_called_degrees(self):
        for name, driver, place in (
            ("a.asc", "AAIGrid", (30.0, 2.0, 0.0, 60.0, 0.0, -2.0)), ("b.asc", "AAIGrid", (500000.0, 0.5, 0.0, 60.0, 0.0, -0.5)),
        ):
            notes = read(raster(self.path(name), driver, place)).notes
            self.assertFalse([note for note in notes if "degrees" in note], notes)
        with self.assertRaisesRegex(FileError, "is not longitude and latitude"):
            read(self.path("b.asc"), project=True)
        path = raster(self.path("c.tif"), "GTiff", (500000.0, 30.0, 0.0, 5e6, 0.0, -30.0), 25832)
        with self.assertRaisesRegex(FileError, "UTM zone 32N.*leave out --project"):
            read(path, project=True)

    def test_the_zone_is_that_of_the_middle(self):
        for x, y, zone in ((-180.0, 10.0, 32701), (179.998, 10.0, 32701), (-70.0, -33.0, 32719), (10.0, 85.0, 32661), (10.0, -85.0, 32761)):
            text = "".join(f"{x + i * 0.0010001:.7f},{y + j * 0.0010003:.7f},{100 * i + j}\n" for i in range(4) for j in range(4))
            code = f"EPSG:{zone}" if zone != 32701 else f"EPSG:{32601 if x < 0 else 32660}"
            text = "longitude,latitude,z\n" + text
            with open(self.path("a.csv"), "w", encoding="ascii") as stream:
                stream.write(text)
            self.assertEqual(read(self.path("a.csv"), project=True).crs, code)

    def test_both_sides_of_the_antimeridian_are_next_to_each_other(self):
        text = "longitude,latitude,z\n" + "".join(
            f"{(180 + 0.001 * i + 180) % 360 - 180:.7f},{0.001 * j:.7f},{i}\n" for i in range(-3, 4) for j in range(5)
        )
        with open(self.path("a.csv"), "w", encoding="ascii") as stream:
            stream.write(text)
        self.assertLess(numpy.ptp(coordinates(read(self.path("a.csv"), project=True))[:, 0]), 1000)

    def test_voids_of_projected_degrees_are_filled(self):
        z = Z.copy()
        z[4:8, 5:9] = -9999
        path = raster(self.path("a.tif"), "GTiff", epsg=4326)
        data = gdal.Open(path, gdal.GA_Update)
        data.GetRasterBand(1).WriteArray(z)
        data = None
        result = reconstruct(read(path, project=True))
        self.assertEqual(result.hole_counts[1], 1)
        self.assertGreater(result.surface.GetNumberOfPoints(), Z.size - 16)

    def test_the_program_projects_files_together_and_lines_with_them(self):
        raster(self.path("a.tif"), "GTiff", epsg=4326)
        raster(self.path("b.tif"), "GTiff", (9.0 + 15 * STEP, *PLACE[1:]), 4326)
        west, east, south, north = 9.0 + STEP, 9.0 + 20 * STEP, 47.0 - 9 * STEP, 47.0 - STEP
        ring = [(west, south), (east, south), (east, north), (west, north), (west, south)]
        self.file("ring.txt", "".join(f"{x:.9f} {y:.9f}\n" for x, y in ring))
        done = self.call("a.tif", "b.tif", "--project", "--boundary", "ring.txt", "--no-picture")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        surface = read(self.path("a_surface.vtp")).points
        corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
        points = vtk_to_numpy(surface.GetPoints().GetData())[corners]
        place = numpy.array([expected(x, y) for x, y in ring])
        numpy.testing.assert_allclose(points[:, :2].min(axis=0), place.min(axis=0), rtol=0, atol=1)
        numpy.testing.assert_allclose(points[:, :2].max(axis=0), place.max(axis=0), rtol=0, atol=1)
        self.assertEqual(self.call("a.tif", "--project", "--pieces", "2").returncode, 2)

    def test_edges_around_the_globe_do_not_bend_among_degrees(self):
        self.file("a.csv", "longitude,latitude,z\n" + "".join(
            f"{15 * i},{10 * j},{i % 5}\n" for i in range(-11, 12) for j in range(-8, 9)))
        ring = [[-170, -85], [170, -85], [170, 85], [-170, 85], [-170, -85]]
        system = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::4258"}}
        self.file("ring.geojson", json.dumps(
            {"type": "FeatureCollection", "crs": system, "features": [
                {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [ring]}}]}))
        done = self.call("a.csv", "--crs", "EPSG:4326", "--boundary", "ring.geojson", "--no-picture")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("stay straight, up to 0 away", done.stdout)

    def test_a_boundary_across_the_antimeridian_bends_as_one_elsewhere(self):
        bends = []
        for middle in (180.0, 177.0):  # of two zones of UTM, and of one
            west, east = ((middle + side + 180) % 360 - 180 for side in (-0.05, 0.05))
            self.file("a.csv", "longitude,latitude,z\n" + "".join(
                f"{(middle + 0.01 * i + 180) % 360 - 180:.7f},{-17 + 0.01 * j:.7f},{i}\n" for i in range(-9, 10) for j in range(12)))
            self.file("ring.csv", f"lon,lat\n{west},-16.98\n{east},-16.98\n{east},-16.92\n{west},-16.92\n{west},-16.98\n")
            done = self.call("a.csv", "--project", "--boundary", "ring.csv", "--no-picture")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            bends.append(float(done.stdout.split("stay straight, up to ")[1].split()[0]))
        self.assertLess(max(bends), 5.0)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
