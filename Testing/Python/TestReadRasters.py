# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rasters of every kind: nodes where the files say, no-data, scale, bands, damage."""

import base64
import os
import struct
import sys
import unittest
import zlib
from unittest import mock

import numpy
from in_folder import InFolder, coordinates
from osgeo import gdal, osr
from vtkelevationsurface import reading
from vtkelevationsurface.reading import rasters

gdal.UseExceptions()
Z = numpy.array([[1.0, 2.0, -9999.0], [4.0, 5.0, 6.0]])
PLACE = (500000.0, 30.0, 0.0, 5000000.0, 0.0, -20.0)
# Of all pixels but the third, at their centres.
CENTRES = [
    (500015, 4999990, 1),
    (500045, 4999990, 2),
    (500015, 4999970, 4),
    (500045, 4999970, 5),
    (500075, 4999970, 6),
]
NODES = [(x, y, 10 * j + i) for j, y in enumerate((40, 35, 30)) for i, x in enumerate((10, 12))]
ROWS = [(0, 1), (10, 11), (20, 21)]


def raster(path, z=Z, place=PLACE, no_data=-9999.0, driver="GTiff", kind=None, **more):
    """Writes arrays of one shape as bands. more: options of creation, and those below."""
    bands = z if isinstance(z, list) else [z]
    settings = {name: more.pop(name) for name in ("scale", "offset", "epsg") if name in more}
    metadata = more.pop("metadata", {})
    shape = bands[0].shape
    kind = kind or gdal.GDT_Float64
    data = gdal.GetDriverByName("MEM").Create("", shape[1], shape[0], len(bands), kind)
    if place:
        data.SetGeoTransform(place)
    data.SetMetadata(metadata)
    if "epsg" in settings:
        reference = osr.SpatialReference()
        reference.ImportFromEPSG(settings["epsg"])
        data.SetProjection(reference.ExportToWkt())
    for number, values in enumerate(bands, 1):
        band = data.GetRasterBand(number)
        band.WriteArray(values)
        if no_data is not None:
            band.SetNoDataValue(no_data)
        if "scale" in settings:
            band.SetScale(settings["scale"])
            band.SetOffset(settings["offset"])
    options = [f"{name}={value}" for name, value in more.items()]
    gdal.GetDriverByName(driver).CreateCopy(path, data, options=options).FlushCache()
    return path


def surfer7(columns, rows, values):
    """A Surfer 7 grid with its nodes at x = 10, 12, ... and y = 30, 35, ..., the south first."""
    head = struct.pack("<4sii", b"DSRB", 4, 2) + struct.pack("<4si", b"GRID", 72)
    head += struct.pack("<ii8d", rows, columns, 10.0, 30.0, 2.0, 5.0, 0.0, 21.0, 0.0, 1.70141e38)
    data = numpy.array(values, "<f8").tobytes()
    return head + struct.pack("<4si", b"DATA", len(data)) + data


def surfer6(columns, rows, values):
    head = struct.pack("<4shh6d", b"DSBB", columns, rows, 10.0, 12.0, 30.0, 40.0, 0.0, 21.0)
    return head + numpy.array(values, "<f4").tobytes()


TEXT = "".join(f"{a} {b}\n" for a, b in ROWS)
UPWARDS = "".join(f"{a} {b}\n" for a, b in reversed(ROWS))
# By hand, each with its nodes at NODES.
BY_HAND = {
    "corner.asc": "ncols 2\nnrows 3\nxllcorner 9\nyllcorner 27.5\ndx 2\ndy 5\n" + TEXT,
    "centre.asc": "ncols 2\nnrows 3\nxllcenter 10\nyllcenter 30\ndx 2\ndy 5\n" + TEXT,
    "surfer6.grd": "DSAA\n2 3\n10 12\n30 40\n0 21\n" + UPWARDS,
    "binary6.grd": surfer6(2, 3, [v for row in reversed(ROWS) for v in row]),
    "surfer7.grd": surfer7(2, 3, [v for row in reversed(ROWS) for v in row]),
    "grass.txt": "north: 42.5\nsouth: 27.5\neast: 13\nwest: 9\nrows: 3\ncols: 2\n" + TEXT,
}


def write_dem(path, profiles, dx=30.0, dy=30.0, dz=1.0, datum=0.0):
    """A USGS ASCII DEM in UTM. profiles: [(x, y of the first elevation, elevations)]."""

    def double(value):
        return f"{value:24.15E}".replace("E", "D")

    ends = profiles[0][0], profiles[-1][0]
    low = min(y for _, y, _ in profiles)
    high = max(y + dy * (len(z) - 1) for _, y, z in profiles)
    corners = (ends[0], low, ends[0], high, ends[1], high, ends[1], low)
    head = "A TEST".ljust(144) + f"{1:6d}{1:6d}{1:6d}{10:6d}" + double(0.0) * 15
    head += f"{2:6d}{2:6d}{4:6d}" + "".join(double(value) for value in corners)
    head += double(0.0) * 3 + f"{0:6d}"
    head += "".join(f"{v:12.6E}".replace("E", "D") for v in (dx, dy, dz))
    text = (head + f"{1:6d}{len(profiles):6d}").ljust(1024)
    for i, (x, y, z) in enumerate(profiles, 1):
        record = f"{1:6d}{i:6d}{len(z):6d}{1:6d}" + double(x) + double(y) + double(datum)
        text += (record + double(0.0) * 2 + "".join(f"{v:6d}" for v in z)).ljust(1024)
    with open(path, "w", encoding="ascii") as stream:
        stream.write(text)
    return path


# A BAG of 2 x 2 cells of 10 m, refined to 2 x 2 nodes in the south-west and 4 x 4 elsewhere. GDAL writes none.
BAG = (
    "eNrtWE1sG0UUnrVjGkIoiWq1UKF2MRwCQt5dp0WVlcRuSUhySGvaquJQySz2OFnJ3jW76yRuDxRQIPyIgLhAT5XCAXGoOFYIKaS9VKiVessVzu"
    "XAJVzL7Ly3G+/GPxu3hUrJSKNv582b77198+Zn97Op8bee7TvcR5zS20t6yABpLA+wZF/0t93+dxEFxGXEHyOuXOB9z6N8EPmDeufPTkw42g8C"
    "xbXzRwywl+yV3VimJk7mHHwH224+3Y749U6dnMybhmGTQF5mu7QrkKgvfwcwf4f2QTtHwuXvMibu1N5U7ur8/Tmwb2YPP167506fGXd2YHffFK"
    "P+dTGF7bnY3hy1K+65FYxXP5Exnv0sxr3klDorXqCmpRk6lx9ggY41xFtJvpGUeTsGMsGdD9hhBAEEv/cQH0YZt4B8DsawHYlEBDgXYXxUuPe0"
    "f6Rbvnui4wt5GvP22XuD7fXdfF7c115vyH040F7vhLu/xzusY0T5hSczjiOZxUpZnIcMHE0oSTmRGRuZrWjpmen8DLXVomqrItPRrTSTjibmbL"
    "ualqSFhYWkZhl2IaUoScOclVKyfFxiGglPudhRuegpF4xOygVji7nsUzaqVJ/VrKRObcZZloaTqYTzCsW0VVVtTS2fpVWTWlS3WcvQp/WSAd0z"
    "4/lJapi0YGsljRZBqNcq71HzTGlcq1DdCYrF5AUjPa3bdJaaY6kRqbE5IrUcxOTqomZ5spzJPDVtjVqeea8PJEW3eVqt0O1KjvR8vUrfNIp0zD"
    "QWwHZLDehuwumJzmmXaIi3C+ozEYunUa7Z4DkbMENVq2ZSsWZURhMVarP+xJgiAxt2IlvjUGl7HKSOcXuMQS0wzyr6Lo1rwTB1auYMTbe5pJzm"
    "z/BYMAyzqOmqzbSPy055HUAWHVSwyV0LqIMEuaTtlqSma1HqsIClwB41RsiVNbah/cbuSKxecWrGX9nph5WQa1moIq/O0edWV8b6M06Nt+l7pU"
    "0fbrCZvo2XfwVc5bhyc5Mj+pu5Pvkhx4srH62B3sccbxxZ4lgqfcIxfv1Tjrc2lzm+P/o5x6NLX3C8e+dLjpfjX3F89eIKx43Vrzku3f+G4/Dw"
    "t2tgX1x38J8hwL/eBvzzEuDGKuDdO4C3NgFvHHlpHfwG/KEKePV7wJWbgEv3AS/HE+vgL2CpBMjORLQvo30Z7ctoX0b7MtqX0b6C9hW0r6B9Be"
    "0raF9B+ym0n0L7KbS/V5y74VP8Xih690q4AQlwTSTu53IrjLIbmKM5KB51VwE51EsOfYD9re+dV/e7X8iNpR9vTM79Ns60ZzRdq9Qq4kSZzvPV"
    "L15QyzXa0p7gMTk7QBM+tgV2ybdGmt7D/6t4/dQ0XuxG+z/nz37u70Cs23jc5l8wB9m93PllqOlFGuaNBrZ2XeKdo1aeD+3pbmw9zP/CxrFbJy"
    "7Y7e/0Tdhkzhs46s1mNwyHtZCHExXcIPGH4qj7/pfthKN9/v6C+VsNrPcTmDd9/Iu4oun5xhxojLd/PbYYry6GGj/sjc+ifNCzH8yndjyRVjzM"
    "j53w9ITzp/6I/KmH92fK44mjP8G8b5cPW/MlZkPw1R+aj71nd/5dC8NX3ymfQJ7xnRfu/+C/8T9eTmicie0lSpb50IMR2JuKtGrPhfn/1MQ/Pj"
    "Zf0wumTcLsk804Wq/v157D9xaa/3nxlwpe2902dc9jbDMv2beJyr4QIOTzqsmmIe8Nw7ZJS5pOWVrblj/+uUd2vvnPM5f/WGC+j21bd31efjfO"
    "Wee8ya435XHW7454WvuzlQGheDKt/OmG51+TaWIo"
)


class Formats(InFolder):
    def test_all_nodes_of_a_bag_with_varying_resolution_are_read(self):
        cloud = self.read(zlib.decompress(base64.b64decode(BAG)), "a.bag")
        xyz = coordinates(cloud)
        self.assertEqual(len(xyz), 4 + 3 * 16)
        self.assertTrue(any("varies from 2.5 to 5" in note for note in cloud.notes), cloud.notes)
        self.assertEqual(round(float(xyz[:, 2].min()), 2), -11.15)

    def test_every_format_that_gdal_writes_gives_the_same_points(self):
        for name, driver, kind in (
            ("a.tif", "GTiff", gdal.GDT_Float64),
            ("a.img", "HFA", gdal.GDT_Float64),
            ("a.nc", "netCDF", gdal.GDT_Float64),
            ("a.bin", "ENVI", gdal.GDT_Float64),
            ("a.grd", "RRASTER", gdal.GDT_Float64),
            ("a.rst", "RST", gdal.GDT_Float32),
            ("a.flt", "EHdr", gdal.GDT_Float32),
            ("a.mpr", "ILWIS", gdal.GDT_Float64),
            ("a.kro", "COG", gdal.GDT_Float64),
        ):
            with self.subTest(driver=driver):
                cloud = reading.read(raster(self.path(name), driver=driver, kind=kind))
                self.assert_rows(cloud, CENTRES)
                self.assertEqual(cloud.left_out, {"pixels without data": 1})

    def test_files_by_hand_have_their_nodes_where_they_say(self):
        for name, content in BY_HAND.items():
            with self.subTest(name=name):
                self.assert_rows(self.read(content, name), NODES)

    def test_a_virtual_raster_reads_the_rasters_it_names(self):
        raster(self.path("a.tif"))
        gdal.Translate(self.path("a.vrt"), self.path("a.tif"), format="VRT").FlushCache()
        self.assert_rows(reading.read(self.path("a.vrt")), CENTRES)

    def test_a_raster_is_known_by_its_content_whatever_its_name(self):
        for name in ("a.txt", "a.csv", "a.vtp", "a.unknown", "none"):
            with self.subTest(name=name):
                cloud = self.read(BY_HAND["corner.asc"], name)
                self.assert_rows(cloud, NODES)
                is_noted = any("by its content this is a raster" in note for note in cloud.notes)
                self.assertEqual(is_noted, name in ("a.txt", "a.csv", "a.vtp"))

    def test_all_digits_of_text_survive(self):
        text = "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n633.5012316703796 0.1\n"
        points = coordinates(self.read(text, "a.asc"))
        self.assertEqual(points[:, 2].tolist(), [633.5012316703796, 0.1])


class Pixels(InFolder):
    def tif(self, **more):
        return raster(self.path("a.tif"), **more)

    def test_pixels_that_are_points_are_not_moved_by_half_a_step(self):
        path = self.tif(place=(499985.0, 30.0, 0.0, 5000010.0, 0.0, -20.0),
                        metadata={"AREA_OR_POINT": "Point"})
        self.assertEqual(coordinates(reading.read(path))[0].tolist(), [500000, 5000000, 1])

    def test_a_rotated_raster_is_placed_by_its_matrix(self):
        points = coordinates(reading.read(self.tif(place=(100.0, 0.0, 2.0, 200.0, 3.0, 0.0))))
        self.assertEqual(points[0].tolist(), [101.0, 201.5, 1.0])
        self.assertEqual(points[1].tolist(), [101.0, 204.5, 2.0])

    def test_without_georeferencing_columns_and_rows_are_used_and_that_is_said(self):
        cloud = reading.read(self.tif(place=None, no_data=None), keep_nulls=True)
        self.assertEqual(coordinates(cloud)[0].tolist(), [0.0, 1.0, 1.0])
        self.assertEqual(cloud.points.GetNumberOfPoints(), 6)
        self.assertTrue(any("no georeferencing" in note for note in cloud.notes))
        self.assertTrue(any("no no-data value" in note for note in cloud.notes))

    def test_a_world_file_next_to_it_is_used(self):
        self.file("a.tfw", "30\n0\n0\n-20\n500015\n4999990\n")
        cloud = reading.read(self.tif(place=None))
        self.assertEqual(coordinates(cloud)[0].tolist(), [500015.0, 4999990.0, 1.0])

    def test_scale_and_offset_are_applied_and_noted(self):
        z = numpy.array([[-30000, 1], [2, 30000]])
        path = self.tif(z=z, no_data=-30000, kind=gdal.GDT_Int16, scale=0.1, offset=100.0)
        cloud = reading.read(path)
        expected = (numpy.array([1.0, 2.0, 30000.0]) * 0.1 + 100.0).tolist()
        self.assertEqual(coordinates(cloud)[:, 2].tolist(), expected)
        self.assertIn("elevation = pixel * 0.1 + 100, as the file says", cloud.notes)

    def test_every_type_of_pixel_is_exact(self):
        for kind, values in (
            (gdal.GDT_Byte, (0, 255)),
            (gdal.GDT_Int16, (-32768, 32767)),
            (gdal.GDT_UInt16, (0, 65535)),
            (gdal.GDT_Int32, (-(2**31), 2**31 - 1)),
            (gdal.GDT_Float32, (float(numpy.float32(0.1)), -0.5)),
            (gdal.GDT_Float64, (0.1, 633.5012316703796)),
        ):
            with self.subTest(kind=gdal.GetDataTypeName(kind)):
                cloud = reading.read(self.tif(z=numpy.array([values]), no_data=None, kind=kind))
                self.assertEqual(tuple(coordinates(cloud)[:, 2].tolist()), values)

    def test_tiles_compression_and_large_files_are_read(self):
        z = numpy.arange(90.0 * 70.0).reshape(70, 90)
        for more in (
            {"TILED": "YES", "BLOCKXSIZE": 32, "BLOCKYSIZE": 16},
            {"COMPRESS": "DEFLATE", "PREDICTOR": 3},
            {"BIGTIFF": "YES"},
        ):
            with self.subTest(more=more), mock.patch.object(rasters, "AT_ONCE", 500):
                cloud = reading.read(self.tif(z=z, no_data=None, **more))
                self.assertEqual(coordinates(cloud)[:, 2].tolist(), z.ravel().tolist())
                self.assertEqual(coordinates(cloud)[-1].tolist(), [502685, 4998610, 6299])

    def test_a_no_data_value_can_be_given_in_addition_to_that_of_the_file(self):
        points = coordinates(reading.read(self.tif(), no_data=5.0))
        self.assertEqual(points[:, 2].tolist(), [1, 2, 4, 6])
        points = coordinates(reading.read(self.tif(no_data=None), no_data=5.0, keep_nulls=True))
        self.assertEqual(points[:, 2].tolist(), [1, 2, -9999, 4, 6])

    def test_a_no_data_value_is_found_among_pixels_of_single_precision(self):
        # As text it is a double, and not the float that stands in the pixels.
        self.assertNotEqual(float(numpy.float32(-9999.9)), -9999.9)
        z = numpy.array([[1.0, -9999.9], [2.0, 3.0]])
        for stored, given in ((-9999.9, None), (None, -9999.9)):
            with self.subTest(stored=stored):
                path = self.tif(z=z, no_data=stored, kind=gdal.GDT_Float32)
                cloud = reading.read(path, no_data=given)
                self.assertEqual(coordinates(cloud)[:, 2].tolist(), [1, 2, 3])
                self.assertEqual(cloud.left_out, {"pixels without data": 1})

    def test_pixels_that_are_not_finite_or_masked_are_left_out(self):
        z = numpy.array([[1.0, numpy.nan], [numpy.inf, 4.0]])
        cloud = reading.read(self.tif(z=z, no_data=None))
        self.assertEqual(coordinates(cloud)[:, 2].tolist(), [1, 4])
        path = self.tif(z=numpy.array([[1.0, 2.0], [3.0, 4.0]]), no_data=None)
        data = gdal.Open(path, gdal.GA_Update)
        data.CreateMaskBand(gdal.GMF_PER_DATASET)
        data.GetRasterBand(1).GetMaskBand().WriteArray(numpy.array([[255, 0], [255, 255]]))
        data = None
        cloud = reading.read(path)
        self.assertEqual(coordinates(cloud)[:, 2].tolist(), [1, 3, 4])
        self.assertIn("pixels without data from the file's mask", cloud.notes)

    def test_the_first_band_is_taken_and_others_by_their_number(self):
        path = self.tif(z=[Z, Z + 100.0])
        cloud = reading.read(path)
        self.assert_rows(cloud, CENTRES)
        self.assertTrue(any("the file has 2 bands; the first" in note for note in cloud.notes))
        cloud = reading.read(path, band=2)
        self.assertEqual(coordinates(cloud)[0].tolist(), [500015, 4999990, 101])
        self.assertFalse(any("bands" in note for note in cloud.notes))

    def test_the_reference_system_is_kept_and_angles_are_noted(self):
        cloud = reading.read(self.tif(epsg=25832))
        self.assertIn('"ETRS89 / UTM zone 32N"', cloud.crs)
        self.assertIsNone(reading.read(self.tif()).crs)
        cloud = reading.read(self.tif(epsg=4326, place=(5.0, 0.25, 0.0, 50.0, 0.0, -0.25)))
        self.assertEqual(coordinates(cloud)[0].tolist(), [5.125, 49.875, 1.0])
        self.assertTrue(any("x,y are angles" in note for note in cloud.notes))

    def test_pixels_without_opacity_are_without_data(self):
        data = gdal.GetDriverByName("GTiff").Create(
            self.path("a.tif"), 3, 2, 2, gdal.GDT_Float32, ["ALPHA=YES"]
        )
        data.SetGeoTransform(PLACE)
        data.GetRasterBand(1).WriteArray(Z)
        data.GetRasterBand(2).WriteArray(numpy.where(Z == -9999.0, 0.0, 255.0))
        data.GetRasterBand(2).SetColorInterpretation(gdal.GCI_AlphaBand)
        data = None
        cloud = reading.read(self.path("a.tif"))
        self.assert_rows(cloud, CENTRES)
        self.assertEqual(cloud.left_out, {"pixels without data": 1})
        self.assertIn("pixels whose alpha is 0 are without data", cloud.notes)

    def test_the_header_of_a_saga_grid_leads_to_its_data(self):
        place = (500000.0, 20.0, 0.0, 5000000.0, 0.0, -20.0)
        source = gdal.Open(raster(self.path("a.tif"), place=place))
        gdal.GetDriverByName("SAGA").CreateCopy(self.path("s.sdat"), source)
        source = None
        # What GDAL would take it for with such a file next to it.
        self.file(
            "s.hdr", "ENVI\nsamples = 3\nlines = 2\nbands = 1\ndata type = 4\ninterleave = bsq\n"
        )
        rows = coordinates(reading.read(self.path("a.tif")))
        self.assert_rows(reading.read(self.path("s.sgrd")), rows)
        os.remove(self.path("s.sdat"))
        with self.assertRaisesRegex(reading.FileError, "header of a SAGA grid; .*s.sdat is missing"):
            reading.read(self.path("s.sgrd"))

    def test_colours_are_noted(self):
        path = self.tif(z=[Z, Z, Z], no_data=None, kind=gdal.GDT_Byte, PHOTOMETRIC="RGB")
        self.assertTrue(any("are colours (red)" in note for note in reading.read(path).notes))


class Variables(InFolder):
    def netcdf(self, *names, x=(1.0, 3.0), y=(10.0, 20.0)):
        """One netCDF file of several variables on the same nodes."""
        folder = self.path("several.nc")
        data = gdal.GetDriverByName("netCDF").CreateMultiDimensional(folder)
        group = data.GetRootGroup()
        kind = gdal.ExtendedDataType.Create(gdal.GDT_Float64)
        axes = [group.CreateDimension(n, "", "", len(v)) for n, v in (("y", y), ("x", x))]
        for dimension, values in zip(axes, (y, x)):
            array = group.CreateMDArray(dimension.GetName(), [dimension], kind)
            array.Write(numpy.array(values))
        for i, name in enumerate(names):
            array = group.CreateMDArray(name, axes, kind)
            values = 100.0 * i + 1.0 + numpy.arange(float(len(x) * len(y)))
            array.Write(values.reshape(len(y), len(x)))
        array = group = data = axes = None
        return folder

    def test_the_variable_of_elevations_is_found_or_chosen(self):
        path = self.netcdf("quality", "elevation")
        rows = [(1, 20, 103), (3, 20, 104), (1, 10, 101), (3, 10, 102)]
        cloud = reading.read(path)
        self.assert_rows(cloud, rows)
        self.assertTrue(any("variable elevation (of quality" in note for note in cloud.notes))
        cloud = reading.read(path, layer="quality")
        self.assertEqual(coordinates(cloud)[0].tolist(), [1, 20, 3])

    def test_steps_of_x_and_y_may_differ(self):
        x = (1.0, 3.0, 4.0)
        for y in ((10.0, 20.0, 40.0), (40.0, 20.0, 10.0)):
            with self.subTest(y=y):
                cloud = reading.read(self.netcdf("z", x=x, y=y))
                rows = sorted(tuple(row) for row in coordinates(cloud).tolist())
                nodes = [(x[i], y[j], 1.0 + 3 * j + i) for j in range(3) for i in range(3)]
                self.assertEqual(rows, sorted(nodes))
                self.assertIn("the steps of x and y differ", cloud.notes)
                os.remove(self.path("several.nc"))

    def test_what_cannot_be_decided_is_asked(self):
        path = self.netcdf("a", "b")
        with self.assertRaisesRegex(reading.FileError, "variables a, b: choose one by --layer"):
            reading.read(path)
        with self.assertRaisesRegex(reading.FileError, "has no layer c; variables: a, b"):
            reading.read(path, layer="c")


class Dem(InFolder):
    def test_every_profile_begins_at_its_own_place(self):
        path = write_dem(self.path("a.dem"), [(1000, 510, [7, 8]), (1030, 480, [5, 6, 9])])
        cloud = reading.read(path)
        self.assert_rows(
            cloud, [(1000, 540, 8), (1030, 540, 9), (1000, 510, 7), (1030, 510, 6), (1030, 480, 5)]
        )
        self.assertIn("elevation in m, as the file says", cloud.notes)
        self.assertFalse(any("whole steps" in note for note in cloud.notes))

    def test_profiles_off_whole_steps_of_y_are_noted(self):
        path = write_dem(self.path("a.dem"), [(1000, 500, [7, 8]), (1030, 470, [5, 6, 9])])
        notes = reading.read(path).notes
        self.assertIn("GDAL moves y to whole steps of 30, by up to 10", notes)

    def test_voids_are_left_out_and_counted_even_where_numbers_touch(self):
        profiles = [(0, 0, [12, -32767, -32767, 40]), (30, 0, [1, 2, 3, 4])]
        cloud = reading.read(write_dem(self.path("a.dem"), profiles))
        self.assertEqual(cloud.left_out, {"pixels without data": 2})
        self.assertEqual(sorted(coordinates(cloud)[:, 2].tolist()), [1, 2, 3, 4, 12, 40])

    def test_elevations_are_steps_above_the_datum_of_their_profile(self):
        profiles = [(0, 0, [12, -32767, 20]), (30, 0, [0, 1, 2])]
        path = write_dem(self.path("a.dem"), profiles, dz=0.25, datum=100.0)
        z = sorted(coordinates(reading.read(path))[:, 2].tolist())
        self.assertEqual(z, [100, 100.25, 100.5, 103, 105])
        # What a user calls no data is an elevation.
        self.assertNotIn(105.0, coordinates(reading.read(path, no_data=105.0))[:, 2])


VRT = b"""<VRTDataset rasterXSize="2" rasterYSize="2"><GeoTransform>0,1,0,0,0,-1</GeoTransform>
<VRTRasterBand dataType="Byte" band="1"><SimpleSource><SourceFilename relativeToVRT="1">%s</SourceFilename>
<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>"""


class Damage(InFolder):
    def content(self, **more):
        raster(self.path("whole.tif"), z=numpy.arange(6000.0).reshape(60, 100), **more)
        with open(self.path("whole.tif"), "rb") as stream:
            return stream.read()

    def test_damaged_rasters_are_refused_in_one_line(self):
        whole = self.content(COMPRESS="DEFLATE", BLOCKYSIZE=4)
        plain = self.content()
        write_dem(self.path("b.dem"), [(0, 0, [1, 2, 3]), (30, 0, [4, 5, 6])])
        with open(self.path("b.dem"), "rb") as stream:
            dem = stream.read()
        grid = BY_HAND["corner.asc"]
        for words, name, content in (
            ("GDAL knows no raster", "a.tif", "plain words"),
            ("cannot be read", "a.tif", b"II*\0\xff\0\0\0"),
            ("band 1, rows from", "a.tif", plain[: len(plain) // 2]),
            ("cannot be read", "a.tif", whole[: len(whole) // 2]),
            ("cannot be read", "a.tif", whole[:3000] + b"\0" * 500 + whole[3500:]),
            ("band 1", "a.asc", grid[:-6]),
            ("band 1", "a.asc", grid.replace("11", "eleven")),
            ("cannot be read", "a.asc", grid.replace("ncols 2", "ncols -2")),
            ("cannot be read", "a.grd", BY_HAND["surfer7.grd"][:60]),
            ("band 1", "a.grd", BY_HAND["surfer7.grd"][:-8]),
            ("band 1", "a.grd", BY_HAND["binary6.grd"][:-4]),
            ("band 1", "b.dem", dem[:2048]),
            ("band 1", "b.dem", dem[: 2048 + 150]),
            ("", "a.nc", b"CDF\1" + b"\0" * 40),
            ("cannot be read", "a.vrt", '<VRTDataset rasterXSize="2" rasterYSize="2"></VRT'),
            # GDAL cannot quote these bytes, or gives no reason.
            ("band 1, rows from 1: cannot be read: ", "a.vrt", VRT % b"caf\xe9.tif"),
            ("cannot be read: GDAL gives no reason that can be quoted", "a.vrt",
             (VRT % b"a.tif").replace(b"Byte", b"By\xe9e")),
            ("", "a.img", b"EHFA_HEADER_TAG\0" + b"\1" * 50),
        ):
            with self.subTest(name=name, words=words, size=len(content)):
                self.assert_refused(words, content, name)

    def test_a_raster_of_no_data_alone_is_refused(self):
        path = raster(self.path("a.tif"), z=numpy.full((2, 3), -9999.0))
        with self.assertRaisesRegex(reading.FileError, "all 6 pixels are without data"):
            reading.read(path)

    def test_wrong_options_are_reported(self):
        path = raster(self.path("a.tif"))
        for words, options in (
            ("there is no band 2; it has 1", {"band": 2}),
            ("has no layers", {"layer": "z"}),
            ("--columns is for text files and vector files; this", {"columns": ["1", "2", "3"]}),
        ):
            with self.subTest(words=words):
                with self.assertRaisesRegex(reading.FileError, words):
                    reading.read(path, **options)
        with self.assertRaisesRegex(reading.FileError, "--band is for rasters; this is a text"):
            self.read("1 2 3\n", band=1)

    def test_without_gdal_it_is_named(self):
        path = raster(self.path("a.tif"))
        with mock.patch.dict(sys.modules, {"osgeo": None}):
            with self.assertRaisesRegex(reading.FileError, "install python3-gdal"):
                reading.read(path)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
