# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Packed files and standard input, and what files are by their content."""

import bz2
import gzip
import io
import lzma
import os
import sys
import tempfile
import types
import unittest
import zipfile
from unittest import mock

import numpy
from in_folder import InFolder, coordinates
from osgeo import ogr
from vtkelevationsurface import reading, writing
from vtkelevationsurface.clouds import make_points
from vtkelevationsurface.gdal_common import reference_of
from vtkelevationsurface.messages import FileError

ROWS = [(1.0, 2.0, 3.5), (4.25, 5.0, 6.0), (-7.0, 8.0, 9.0)]
TEXT = "".join(f"{x} {y} {z}\n" for x, y, z in ROWS).encode()
GRID = b"ncols 2\nnrows 1\nxllcorner 9\nyllcorner 27.5\ncellsize 2\n5 6\n"
GRID_ROWS = [(10, 28.5, 5), (12, 28.5, 6)]


class Packed(InFolder):
    def contents(self):
        """(name, content, rows) of some formats."""
        writing.write_surface(make_points(ROWS), self.path("w.vtp"))
        with open(self.path("w.vtp"), "rb") as stream:
            vtp = stream.read()
        return [("a.xyz", TEXT, ROWS), ("a.asc", GRID, GRID_ROWS), ("a.vtp", vtp, ROWS)]

    def test_packed_files_of_every_format_are_unpacked(self):
        packers = ((".gz", gzip.compress), (".bz2", bz2.compress), (".xz", lzma.compress))
        for suffix, pack in packers:
            for name, content, rows in self.contents():
                with self.subTest(name=name + suffix):
                    cloud = self.read(pack(content), name + suffix)
                    self.assert_rows(cloud, rows)
                    self.assertFalse(any("by its content" in note for note in cloud.notes))

    def test_nothing_is_left_behind(self):
        folder = self.path("temporary")
        os.mkdir(folder)
        with mock.patch.object(tempfile, "tempdir", folder):
            self.read(gzip.compress(TEXT), "a.xyz.gz")
            self.assert_refused("", gzip.compress(b"words\n"), "a.xyz.gz")
        self.assertEqual(os.listdir(folder), [])

    def test_errors_name_the_packed_file(self):
        packed = gzip.compress(TEXT * 1000)
        for words, content in (
            ("a.xyz.gz: is cut off or damaged", packed[:-20]),
            ("a.xyz.gz: is cut off or damaged", packed[:20]),
            ("a.xyz.gz: is cut off or damaged", packed[:60] + b"\0" * 40 + packed[100:]),
            ("a.xyz.gz: is empty", gzip.compress(b"")),
            ("a.xyz.gz, line 2: 'q'", gzip.compress(TEXT.replace(b"5.0", b"q"))),
            ("a.xyz.gz: no line holds 3 numbers", gzip.compress(b"1 2\n3 4\n")),
        ):
            with self.subTest(words=words):
                self.assert_refused(words, content, "a.xyz.gz")

    def test_standard_input_is_read_whatever_it_holds(self):
        for name, content, rows in self.contents():
            for packed in (content, gzip.compress(content)):
                with self.subTest(name=name):
                    stdin = types.SimpleNamespace(buffer=io.BytesIO(packed))
                    with mock.patch.object(sys, "stdin", stdin):
                        self.assert_rows(reading.read("-"), rows)
        for words, content in (("is empty", b""), ("no numbers", b"words\n")):
            stdin = types.SimpleNamespace(buffer=io.BytesIO(content))
            with mock.patch.object(sys, "stdin", stdin):
                with self.assertRaisesRegex(reading.FileError, "^standard input: .*" + words):
                    reading.read("-")

    def test_boundaries_and_faults_are_unpacked_too(self):
        ring = self.file("b.txt.gz", gzip.compress(b"0 0\n9 0\n9 9\n0 0\n"))
        self.assertEqual(reading.read_boundary(ring).GetNumberOfLines(), 1)
        line = self.file("f.txt.gz", gzip.compress(b"0 0 1\n9 0 1\n"))
        self.assertEqual(reading.read_faults(line).GetNumberOfPoints(), 2)


def zipped(**files):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return stream.getvalue()


class Archives(InFolder):
    ROWS = [(x, y, 10.0 * x + y) for x in range(4) for y in range(4)]
    TEXT = "".join(f"{x} {y} {z}\n" for x, y, z in ROWS)

    def vector(self, name, driver):
        """Points of ROWS in all files that a driver writes: {name in the archive: content}."""
        data = ogr.GetDriverByName(driver).CreateDataSource(self.path(name))
        layer = data.CreateLayer("points", reference_of("EPSG:25832"), ogr.wkbPoint25D)
        for row in self.ROWS:
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetGeometry(ogr.CreateGeometryFromWkt("POINT Z (%g %g %g)" % row))
            layer.CreateFeature(feature)
        layer = data = None
        files = {}
        for folder, _, names in os.walk(self.folder):
            for one in (one for one in names if "points." in os.path.join(folder, one)):
                path = os.path.join(folder, one)
                with open(path, "rb") as stream:
                    files[os.path.relpath(path, self.folder)] = stream.read()
        return files

    def test_a_zipped_file_is_read_with_what_lies_next_to_it(self):
        self.assert_rows(self.read(zipped(**{"a/b.xyz": self.TEXT, "readme.txt": "hello"}), "a.zip"), self.ROWS)
        self.assert_rows(self.read(zipped(**{"b.txt": self.TEXT}), "a.zip"), self.ROWS)
        shape = self.vector("points.shp", "ESRI Shapefile")
        self.assertIn("points.prj", shape)
        cloud = self.read(zipped(**shape), "a.zip")
        self.assert_rows(cloud, self.ROWS)
        self.assertIn("25832", cloud.crs)
        self.assertEqual(reading.read_faults(self.file("f.zip", zipped(**{"f.xyz": "0 0 1\n9 0 1\n"}))).GetNumberOfPoints(), 2)

    def test_a_zipped_hgt_knows_its_place(self):
        z = numpy.arange(1201 * 1201, dtype=">i2").reshape(1201, 1201) % 3000
        cloud = self.read(zipped(**{"N45E006.hgt": z.astype(">i2").tobytes()}), "N45E006.SRTMGL3.hgt.zip")
        numpy.testing.assert_allclose(coordinates(cloud)[0], (6, 46, z[0, 0]), atol=1e-9)

    def test_a_file_geodatabase_is_read_as_a_folder_and_zipped(self):
        files = self.vector("points.gdb", "OpenFileGDB")
        cloud = reading.read(self.path("points.gdb"))
        self.assert_rows(cloud, self.ROWS)
        self.assert_rows(self.read(zipped(**files), "points.gdb.zip"), self.ROWS)
        with self.assertRaisesRegex(FileError, "is a folder, not a file"):
            reading.read(self.folder)

    def test_what_cannot_be_decided_is_asked_and_damage_is_reported(self):
        self.assert_refused(("holds a.xyz, b.xyz: unzip ", "a.zip -d unpacked, and read unpacked/a.xyz unpacked/b.xyz"),
                            zipped(**{"a.xyz": self.TEXT, "b.xyz": self.TEXT}), "a.zip")
        self.assert_refused("holds nothing", zipped(), "a.zip")
        self.assert_refused("holds a.jpg", zipped(**{"a.jpg": "a"}), "a.zip")
        whole = zipped(**{"a.xyz": self.TEXT})
        self.assert_refused("cut off or damaged", whole[:60], "a.zip")
        self.assert_refused("cut off or damaged", whole[:40] + bytes(20) + whole[60:], "a.zip")


class Foreign(InFolder):
    def test_what_holds_no_points_is_named(self):
        for words, name, content in (
            ("is of no kind that can be read: .vtp", "a.abc", "words\n"),
            ("is of no kind that can be read: .vtp", "none", bytes(range(256)) * 20),
            ("is a web page", "a.xyz", "<!DOCTYPE html><html>404 1 2 3</html>"),
            ("is a PDF document", "a.csv", b"%PDF-1.4\n1 0 obj\n<< /Length 44 100 200 >>\n"),
            ("cut off or damaged", "a.zip", b"PK\3\4" + bytes(200)),
            ("save the table as .csv", "a.xlsx", zipped(**{"[Content_Types].xml": "<a/>", "xl/workbook.xml": "<a/>"})),
            ("save the table as .csv", "a.ods", zipped(mimetype="application/vnd.oasis", content="<a/>")),
            ("save the table as .csv", "a.xls", b"\xd0\xcf\x11\xe0" + bytes(600)),
            ("is an archive of 7-Zip", "a.7z", b"7z\xbc\xaf\x27\x1c" + bytes(60)),
            ("is a MATLAB file", "a.mat", b"MATLAB 5.0 MAT-file" + bytes(200)),
            ("is a Parquet table", "a.parquet", b"PAR1" + bytes(60)),
            ("is a mesh of SMS", "a.2dm", "MESH2D\nND 1 0 0 1\n"),
            ("is a well log", "a.las", "~Version\nVERS. 2.0:\n~A\n100 45 3\n101 46 4\n102 47 5\n"),
            ("is an OFF file", "a.off", "OFF\n3 1 0\n0 0 1\n1 0 1\n0 1 1\n3 0 1 2\n"),
            ("is an E57 file", "a.e57", b"ASTM-E57" + bytes(100)),
            ("is a glTF file", "a.glb", b"glTF" + bytes(100)),
            ("holds a Collection", "a.pvd", '<VTKFile type="Collection"><Collection/></VTKFile>'),
            ("is not a text file", "a.xyz", bytes(1000)),
            ("is JSON, of which GDAL reads GeoJSON", "a.json", '{"a": [1, 2, 3]}'),
            ("is its .hdr next to it?", "a.flt", bytes(range(64))),
            ("its name must give its place", "a.hgt", b"\1\0" * 1201),
            ("cannot be read", "a.png", b"\x89PNG\r\n\x1a\n" + bytes(30)),
        ):
            with self.subTest(name=name, words=words):
                self.assert_refused(words, content, name)

    def test_text_is_read_as_text_whatever_its_words_look_like(self):
        commas = "X,Y,Z\n" + "".join(f'"{x}","{y}","{z}"\n' for x, y, z in ROWS)
        decimal_comma = "".join(
            f"{i};" + ";".join(f'"{v}"'.replace(".", ",") for v in row) + "\n"
            for i, row in enumerate(ROWS, 1)
        )
        plain = "".join(f"{x},{y},{z}\n" for x, y, z in ROWS)
        fortran = "".join("{:.4e} {:.4e} {:.4e}\n".format(*row) for row in ROWS).replace("e", "D")
        for content in (commas, '"ID";"X";"Y";"Z"\n' + decimal_comma, decimal_comma, fortran,
                        "X Y Z\n" + fortran, "x,y,z\n" + plain,
                        "x,y,z\n" + plain + "\0\0\x1a", ("x,y,z\n" + plain).encode("utf-16")):
            content = content if isinstance(content, bytes) else content.encode()
            columns = ["2", "3", "4"] if content.startswith(b"1;") else None
            for name in ("a.csv", "none"):
                with self.subTest(content=content[:30], name=name):
                    self.assert_rows(self.read(content, name, columns=columns), ROWS)

    def test_text_that_cannot_be_read_is_refused_as_text(self):
        degrees = "Name;Lat;Lon;H\nP1;50°12'11.7\"N;7°17'21.9\"E;121.4\n"
        for words, content in (
            ("holds text, but no numbers", "X,Y,Z\n"),
            ("degrees, minutes and seconds", degrees),
        ):
            for name in ("a.csv", "none"):
                with self.subTest(words=words, name=name):
                    self.assert_refused(words, content, name)

    def test_a_mislabelled_file_is_read_as_what_it_is_with_a_note(self):
        for name, content, note in (
            ("a.tif", TEXT, "this is a text table, not a raster"),
            ("a.las", TEXT, "this is a text table, not a LAS file"),
            ("a.vtp", GRID, "this is a raster, not VTK's XML"),
            ("a.csv", GRID, "this is a raster, not a text table"),
            ("a.ply", b"GOCAD VSet 1\nVRTX 1 1 2 3\nEND\n", "this is a GOCAD file, not a PLY file"),
            ("a.obj", b"v 1 2 3\nv 4 5 6\n", None),
            ("a.txt", b"v 1 2 3\nv 4 5 6\n", "this is an OBJ file, not a text table"),
            ("a.abc", TEXT, None),
        ):
            with self.subTest(name=name):
                notes = [n for n in self.read(content, name).notes if "by its content" in n]
                self.assertEqual(notes, [f"by its content {note}"] if note else [])

    def test_a_mesh_with_its_height_in_y_is_noted(self):
        for order, is_noted in (("xyz", False), ("xzy", True)):
            lines = [
                "v {} {} {}".format(*({"x": 3 * i, "y": 2 * j, "z": 0.3 * (i % 3)}[a] for a in order))
                for i in range(8) for j in range(8)
            ]
            with self.subTest(order=order):
                cloud = self.read(("\n".join(lines) + "\n").encode(), "a.obj")
                self.assertEqual("if y is the height" in " ".join(cloud.notes), is_noted)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
