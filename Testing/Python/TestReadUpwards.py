# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whether z counts upwards: name, unit, sign and kind of file, together, with every reader."""

import sys
import unittest

import numpy
from in_folder import InFolder, Program, coordinates
from osgeo import gdal, ogr
from vtkelevationsurface import reading
from vtkelevationsurface.clouds import Cloud, ReadOptions, make_points
from vtkelevationsurface.inputs import cloud_of
from vtkelevationsurface.reading.slicing import read_files
from vtkelevationsurface.reading.upwards import notes_on_range
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkTable

gdal.UseExceptions()
ogr.UseExceptions()
UPSIDE_DOWN = "positive, so the surface is upside down; --depth turns it over"
BOTH = "taken as they are, upwards; if they count downwards, --depth turns it over"
DOUBTFUL = "it is not certain that it counts upwards: taken as elevations; if these are depths"
HILLS = "hollows are hills now; leave --depth out then"
COUNT = 8
STEPS = 25.0 * numpy.arange(COUNT)
X, Y = (a.ravel() for a in numpy.meshgrid(600000.0 + STEPS, 6e6 + STEPS))
HORIZON = (1558.0 + 375.0 * numpy.linspace(0.0, 1.0, len(X)) ** 2).round(2)  # no plane


def depth_notes(notes):
    """What the notes say of up and down."""
    done = "z is turned over, as --depth says"
    return [note for note in notes if "--depth" in note and note != done]


class Decision(unittest.TestCase):
    def test_name_unit_sign_and_kind_decide_together(self):
        for name, is_horizon, depth, low, high, words in (
            ("Depth (m)", False, False, 1558, 1933, UPSIDE_DOWN),
            ("Tiefe", False, False, 0, 12, UPSIDE_DOWN),
            ("Depth (m)", False, False, -45, -2, None),
            ("Depth (m)", False, False, -45, 0, None),
            ("Depth", False, False, -3, 40, BOTH),
            ("Depth", False, False, 0, 0, None),
            ("Z (ms)", False, False, 700, 900, "z are times by their name and " + UPSIDE_DOWN),
            ("TWT", True, False, 700, 900, "z are times"),
            ("Z (m)", False, False, 1558, 1933, None),
            ("Elevation", False, False, 1558, 1933, None),
            ("", False, False, -20, -3, None),
            ("Z", True, False, 1558, 1933, DOUBTFUL),
            ("", True, False, 1558, 1933, "z is from 1,558 to 1,933, and " + DOUBTFUL),
            ("Elevation", True, False, 1558, 1933, None),
            ("", True, False, -1933, -1558, None),
            ("", True, False, -10, 30, None),
            ("Depth", False, True, 1558, 1933, None),
            ("Depth", True, True, -3, 40, None),
            ("", False, True, -45, -2, HILLS),
            ("Depth", False, True, -45, 0, HILLS),
        ):
            with self.subTest(name=name, is_horizon=is_horizon, depth=depth, low=low, high=high):
                cloud = Cloud(None)
                cloud.z_name, cloud.is_horizon = name, is_horizon
                notes = notes_on_range(cloud, depth, float(low), float(high))
                self.assertEqual(len(notes), words is not None, notes)
                self.assertIn(words or "", "".join(notes))


class Readers(InFolder):
    def xyz(self, z):
        return "".join(f"{x:.2f} {y:.2f} {v:.2f}\n" for x, y, v in zip(X, Y, z))

    def vector(self, z, attribute=None, layer="points"):
        data = ogr.GetDriverByName("GPKG").CreateDataSource(self.path("a.gpkg"))
        made = data.CreateLayer(layer, None, ogr.wkbPoint if attribute else ogr.wkbPoint25D)
        if attribute:
            made.CreateField(ogr.FieldDefn(attribute, ogr.OFTReal))
        for x, y, v in zip(X.tolist(), Y.tolist(), z.tolist()):
            feature = ogr.Feature(made.GetLayerDefn())
            shape = f"POINT ({x} {y})" if attribute else f"POINT Z ({x} {y} {v})"
            feature.SetGeometry(ogr.CreateGeometryFromWkt(shape))
            if attribute:
                feature.SetField(attribute, v)
            made.CreateFeature(feature)
        return self.path("a.gpkg")

    def raster(self, z, description="", unit="", **metadata):
        driver = gdal.GetDriverByName("GTiff")
        data = driver.Create(self.path("a.tif"), COUNT, COUNT, 1, gdal.GDT_Float64)
        band = data.GetRasterBand(1)
        band.WriteArray(z.reshape(COUNT, COUNT))
        band.SetDescription(description)
        band.SetUnitType(unit)
        band.SetMetadata(metadata)
        return self.path("a.tif")

    def irap(self, z):
        head = f"-996 {COUNT} 25 25\n0 175 0 175\n{COUNT} 0 0 0\n0 0 0 0 0 0 0\n"
        return self.file("a.irap", head + " ".join(f"{v:.2f}" for v in z) + "\n")

    def lines_and_traces(self, z, names=True):
        rows = self.xyz(z).splitlines(True)
        rows = [f"{2100 + i // COUNT} {830 + i % COUNT} {row}" for i, row in enumerate(rows)]
        return self.file("a.txt", "Inline Crossline X Y Z\n" * names + "".join(rows))

    def earthvision(self, z, field):
        head = f"# Type: scattered data\n# Field: 1 x\n# Field: 2 y\n# Field: 3 {field}\n"
        return self.file("a.ev", head + self.xyz(z))

    def test_each_reader_notes_once_what_it_knows(self):
        for what, path, positive, negative in (
            ("text", lambda z: self.file("a.csv", "X Y Depth\n" + self.xyz(z)), UPSIDE_DOWN, None),
            ("unit", lambda z: self.file("a.csv", "X Y Z_(ms)\n" + self.xyz(z)), UPSIDE_DOWN, None),
            ("text, plain", lambda z: self.file("a.csv", "X Y Z\n" + self.xyz(z)), None, None),
            ("attribute", lambda z: self.vector(z, "depth"), UPSIDE_DOWN, None),
            ("layer", lambda z: self.vector(z, layer="soundings"), UPSIDE_DOWN, None),
            ("geometry", self.vector, None, None),
            ("band", lambda z: self.raster(z, "depth"), UPSIDE_DOWN, None),
            ("band, positive down", lambda z: self.raster(z, positive="down"), UPSIDE_DOWN, None),
            ("band, plain", self.raster, None, None),
            ("IRAP", self.irap, DOUBTFUL, None),
            ("seismic", self.lines_and_traces, DOUBTFUL, None),
            ("seismic, no names", lambda z: self.lines_and_traces(z, False), DOUBTFUL, None),
            ("EarthVision", lambda z: self.earthvision(z, "z"), DOUBTFUL, None),
            ("EarthVision, named", lambda z: self.earthvision(z, "depth"), UPSIDE_DOWN, None),
        ):
            for z, words in ((HORIZON, positive), (-HORIZON, negative)):
                with self.subTest(what=what, z=z[0]):
                    name = path(z)
                    cloud = reading.read(name)
                    found = coordinates(cloud)[:, 2]
                    numpy.testing.assert_array_equal(numpy.sort(found), numpy.sort(z))
                    notes = depth_notes(cloud.notes)
                    self.assertEqual(len(notes), words is not None, notes)
                    self.assertIn(words or "", "".join(notes))
                    notes = depth_notes(reading.read(name, depth=True).notes)
                    self.assertEqual([HILLS in note for note in notes], [True] if z[0] < 0 else [])

    def test_columns_that_the_user_names_are_looked_at_too(self):
        path = self.file("a.csv", "X Y Top Depth\n" + "".join(
            f"{x} {y} 5 {z}\n" for x, y, z in zip(X, Y, HORIZON)))
        self.assertIn(UPSIDE_DOWN, "".join(reading.read(path, columns="X,Y,Depth").notes))
        self.assertEqual(depth_notes(reading.read(path, columns="X,Y,Top").notes), [])

    def test_the_name_of_a_file_is_a_hint(self):
        for name, is_hint in (
            ("Top_horizon_3.xyz", True), ("lake-depth.xyz", True), ("Seetiefen.xyz", False),
            ("bathymetry.xyz", True), ("survey.xyz", False), ("prof.xyz", False),
        ):
            with self.subTest(name=name):
                notes = depth_notes(reading.read(self.file(name, self.xyz(HORIZON))).notes)
                self.assertEqual([DOUBTFUL in note for note in notes], [True] if is_hint else [])
        head = "X Y Elevation\n"
        path = self.file("horizon.xyz", head + self.xyz(HORIZON))
        self.assertEqual(depth_notes(reading.read(path).notes), [])
        surface = "GOCAD VSet 1\nZPOSITIVE {}\n" + "".join(
            f"VRTX {i} {x} {y} {z}\n" for i, (x, y, z) in enumerate(zip(X, Y, HORIZON))) + "END\n"
        for sign in ("Elevation", "Depth"):
            path = self.file("horizon.vs", surface.format(sign))
            self.assertEqual(depth_notes(reading.read(path).notes), [])

    def test_slices_note_the_same(self):
        for head, z in (("X Y Depth\n", HORIZON), ("X Y Depth\n", -HORIZON), ("X Y Z\n", -HORIZON)):
            for depth in (False, True):
                with self.subTest(head=head, z=z[0], depth=depth):
                    path, cloud = self.file("a.csv", head + self.xyz(z)), Cloud(None)
                    read_files([path], cloud, lambda points: None, depth=depth)
                    self.assertEqual(depth_notes(cloud.notes), depth_notes(reading.read(path, depth=depth).notes))

    def test_arrays_of_data_objects_note_the_same(self):
        values = numpy_to_vtk(HORIZON, deep=True)
        values.SetName("Depth")
        image, table = vtkImageData(), vtkTable()
        points = make_points(numpy.column_stack((X, Y, 0 * X)))
        image.SetDimensions(COUNT, COUNT, 1)
        image.GetPointData().SetScalars(values)
        points.GetPointData().AddArray(values)
        for name, column in (("X", X), ("Y", Y)):
            array = numpy_to_vtk(column, deep=True)
            array.SetName(name)
            table.AddColumn(array)
        table.AddColumn(values)
        for data, array in ((image, ""), (points, "Depth"), (table, "")):
            with self.subTest(kind=data.GetClassName()):
                self.assertIn(UPSIDE_DOWN, "".join(cloud_of([data], array).notes))
                self.assertEqual(depth_notes(cloud_of([data], array, ReadOptions(depth=True)).notes), [])
        self.assertEqual(depth_notes(cloud_of([points]).notes), [])


class Report(Program):
    def test_a_lake_that_is_negative_already_stays_a_lake(self):
        z = -10.0 + 0.5 * numpy.hypot(X - X.mean(), Y - Y.mean()) / 10.0
        self.file("lake.csv", "X Y Depth\n" + "".join(f"{a} {b} {c}\n" for a, b, c in zip(X, Y, z)))
        done = self.call("lake.csv", "--no-picture")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertNotIn("--depth", done.stdout)
        done = self.call("lake.csv", "--no-picture", "--depth")
        self.assertIn("hollows are hills now", done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
