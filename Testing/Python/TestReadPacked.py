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
from unittest import mock

from in_folder import InFolder
from vtkelevationsurface import reading, writing
from vtkelevationsurface.clouds import make_points

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


class Foreign(InFolder):
    def test_what_holds_no_points_is_named(self):
        for words, name, content in (
            ("is of no kind that can be read: .vtp", "a.abc", "words\n"),
            ("is of no kind that can be read: .vtp", "none", bytes(range(256)) * 20),
            ("is a web page", "a.xyz", "<!DOCTYPE html><html>404 1 2 3</html>"),
            ("is a PDF document", "a.csv", b"%PDF-1.4\n1 0 obj\n<< /Length 44 100 200 >>\n"),
            ("is an archive: unpack it", "a.xlsx", b"PK\3\4" + bytes(200)),
            ("is a well log", "a.las", "~Version\nVERS. 2.0:\n~A\n100 45 3\n101 46 4\n102 47 5\n"),
            ("is an OFF file", "a.off", "OFF\n3 1 0\n0 0 1\n1 0 1\n0 1 1\n3 0 1 2\n"),
            ("is a PCD file", "a.pcd", "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\n1 2 3\n4 5 6\n"),
            ("is an E57 file", "a.e57", b"ASTM-E57" + bytes(100)),
            ("is a glTF file", "a.glb", b"glTF" + bytes(100)),
            ("holds a Collection", "a.pvd", '<VTKFile type="Collection"><Collection/></VTKFile>'),
            ("is not a text file", "a.xyz", bytes(1000)),
            ("GDAL knows no vector format", "a.json", '{"a": [1, 2, 3]}'),
            ("is its .hdr beside it?", "a.flt", bytes(range(64))),
            ("its name must tell its place", "a.hgt", b"\1\0" * 1201),
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

    def test_a_mesh_with_its_height_in_y_is_told(self):
        for order, told in (("xyz", False), ("xzy", True)):
            lines = [
                "v {} {} {}".format(*({"x": 3 * i, "y": 2 * j, "z": 0.3 * (i % 3)}[a] for a in order))
                for i in range(8) for j in range(8)
            ]
            with self.subTest(order=order):
                cloud = self.read(("\n".join(lines) + "\n").encode(), "a.obj")
                self.assertEqual("if y is the height" in " ".join(cloud.notes), told)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
