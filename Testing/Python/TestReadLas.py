# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""LAS files of every version and point format, made by hand from the standard's tables."""

import contextlib
import struct
import sys
import types
import unittest
from unittest import mock

import numpy
from in_folder import InFolder

from vtkmodules.util.numpy_support import vtk_to_numpy

SCALE, OFFSET = (0.001, 0.01, 1e-4), (612000.0, 6073000.5, -100.0)
RNG = numpy.random.default_rng(5)
XYZ = RNG.integers(-(2**31), 2**31, (7, 3))
CLASSES = [2, 2, 1, 5, 2, 8, 6]
WITHHELD = [0, 1, 0, 0, 0, 0, 0]
SYNTHETIC = [0, 0, 1, 0, 0, 1, 0]
RETURNS = [1, 2, 1, 3, 1, 1, 2]
FLAGS = [s | w << 2 for s, w in zip(SYNTHETIC, WITHHELD)]
TIMES = [1.5e8 + i / 3.0 for i in range(7)]
COLOURS = [(i * 9000, 65535 - i, 256) for i in range(7)]


def point(kind, i):
    """One record, field by field as the standard lists them."""
    x, y, z = map(int, XYZ[i])
    if kind < 6:
        record = struct.pack("<iiiHB", x, y, z, 100 + i, RETURNS[i] | 3 << 3)
        record += struct.pack("<BbBH", CLASSES[i] | SYNTHETIC[i] << 5 | WITHHELD[i] << 7, -5, 9, 77)
    else:
        record = struct.pack("<iiiHBB", x, y, z, 100 + i, RETURNS[i] | 3 << 4, FLAGS[i])
        record += struct.pack("<BBhHd", CLASSES[i], 9, -500, 77, TIMES[i])
    if kind in (1, 3, 4, 5):
        record += struct.pack("<d", TIMES[i])
    if kind in (2, 3, 5, 7, 8, 10):
        record += struct.pack("<HHH", *COLOURS[i])
    if kind in (8, 10):
        record += struct.pack("<H", 4242)
    if kind in (4, 5, 9, 10):
        record += struct.pack("<BQIffff", 1, 2, 3, 4.0, 5.0, 6.0, 7.0)
    return record


def las(kind, version=(1, 2), extra=b"", records=(), extended=(), count=None, packed=False):
    """A whole file. records, extended: [(user, number, content)] before and behind the points."""
    size = {(1, 3): 235, (1, 4): 375}.get(version, 227)
    body = b"".join(
        struct.pack("<H16sHH32s", 0, user, number, len(content), b"") + content
        for user, number, content in records
    )
    points = b"".join(point(kind, i) + extra for i in range(len(XYZ)))
    count = len(XYZ) if count is None else count
    start = size + len(body)
    head = b"LASF" + struct.pack("<HH16sBB", 0, 0, b"", *version) + bytes(32 + 32 + 4)
    length = len(point(kind, 0) + extra)
    head += struct.pack("<HIIBH", size, start, len(records), kind | 128 * packed, length)
    old = count if version < (1, 4) else 0
    head += struct.pack("<I5I", old, old, 0, 0, 0, 0)
    head += struct.pack("<6d", *SCALE, *OFFSET) + bytes(48)
    if version >= (1, 3):
        head += struct.pack("<Q", 0)
    if version >= (1, 4):
        head += struct.pack("<QIQ15Q", start + len(points), len(extended), count, *[0] * 15)
    assert len(head) == size
    end = b"".join(
        struct.pack("<H16sHQ32s", 0, user, number, len(content), b"") + content
        for user, number, content in extended
    )
    return head + body + points + end


KEEP = [i for i in range(7) if not WITHHELD[i]]
EXPECTED = (XYZ * numpy.array(SCALE) + numpy.array(OFFSET))[KEEP]


def array(cloud, name):
    return vtk_to_numpy(cloud.points.GetPointData().GetArray(name)).tolist()


class Las(InFolder):
    def test_every_point_format_is_read_to_the_last_bit(self):
        for kind in range(11):
            for extra in (b"", b"\1\2\3"):
                version = (1, 4) if kind > 5 else (1, 3) if kind > 3 else (1, 2 * (kind > 1))
                with self.subTest(kind=kind, extra=extra):
                    cloud = self.read(las(kind, version, extra), "a.las", keep_nulls=True)
                    self.assert_rows(cloud, EXPECTED)
                    self.assertEqual(cloud.left_out, {"points marked as withheld": 1})
                    self.assertEqual(array(cloud, "Intensity"), [100 + i for i in KEEP])
                    self.assertEqual(array(cloud, "Classification"), [CLASSES[i] for i in KEEP])
                    self.assertEqual(array(cloud, "ReturnNumber"), [RETURNS[i] for i in KEEP])
                    data = cloud.points.GetPointData()
                    self.assertEqual(bool(data.HasArray("GpsTime")), kind not in (0, 2))
                    self.assertEqual(bool(data.HasArray("RGB")), kind in (2, 3, 5, 7, 8, 10))
                    if data.HasArray("GpsTime"):
                        self.assertEqual(array(cloud, "GpsTime"), [TIMES[i] for i in KEEP])
                    if data.HasArray("RGB"):
                        expected = [[v >> 8 for v in COLOURS[i]] for i in KEEP]
                        self.assertEqual(array(cloud, "RGB"), expected)

    def test_versions_and_their_two_counts_of_points_are_known(self):
        for version in ((1, 0), (1, 1), (1, 2), (1, 3), (1, 4)):
            with self.subTest(version=version):
                cloud = self.read(las(1, version), "a.las", keep_nulls=True)
                self.assert_rows(cloud, EXPECTED)
                self.assertIn(f"LAS 1.{version[1]}, point format 1; classes", cloud.notes[0])
                self.assertIn("2 ground: 2, 5 high vegetation: 1", cloud.notes[0])
                self.assertIn("(see --classes)", cloud.notes[0])

    def test_classes_can_be_chosen(self):
        for kind in (1, 6):
            with self.subTest(kind=kind):
                content = las(kind, (1, 4))
                cloud = self.read(content, "a.las", classes=[2, 8], keep_nulls=True)
                self.assertEqual(array(cloud, "Classification"), [2, 2, 8])
                self.assertEqual(cloud.left_out["points of other classes"], 3)
                self.assert_refused(
                    "holds no point of class 9; classes: 1 unclassified: 1, 2 ground: 2",
                    content,
                    "a.las",
                    classes=[9],
                )

    def test_the_reference_system_comes_from_wkt_or_keys(self):
        keys = struct.pack("<16H", 1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, 25832, 4099, 0, 1, 9001)
        wkt = b'PROJCS["made by hand"]'
        projection = b"LASF_Projection"
        for expected, records, extended in (
            (None, (), ()),
            ("EPSG:25832", ((b"other", 34735, b"abc"), (projection, 34735, keys)), ()),
            (wkt.decode(), ((projection, 34735, keys), (projection, 2112, wkt + b"\0")), ()),
            (wkt.decode(), (), ((b"liblas", 1, b"x" * 70000), (projection, 2112, wkt))),
            (None, ((projection, 34735, keys.replace(struct.pack("<H", 25832), b"\xff\x7f")),), ()),
        ):
            with self.subTest(expected=expected, records=len(records)):
                content = las(6, (1, 4), records=records, extended=extended)
                cloud = self.read(content, "a.las", keep_nulls=True)
                self.assertEqual(cloud.crs, expected)
                self.assert_rows(cloud, EXPECTED)

    def test_no_data_and_content_in_place_of_the_name(self):
        cloud = self.read(las(0), "a.txt", no_data=float(EXPECTED[2][2]), keep_nulls=True)
        self.assert_rows(cloud, numpy.delete(EXPECTED, 2, axis=0))
        self.assertEqual(cloud.left_out["points without data"], 1)
        self.assertIn("by its content this is a LAS file, not a text table", cloud.notes)

    def test_damaged_files_are_refused_in_one_line(self):
        whole = las(3)
        for words, content in (
            ("is cut off within its header", whole[:100]),
            ("7 points are announced, 6 are there", whole[:-1]),
            ("7 points are announced, 0 are there", whole[:230]),
            ("4,000,000,000 points are announced, 7 are there", las(0, count=4 * 10**9)),
            ("holds no points", las(0, count=0)),
            ("point format 11; 0 to 10", whole[:104] + b"\x0b" + whole[105:]),
            ("20 bytes for a point of format 3", whole[:105] + b"\x14\0" + whole[107:]),
            ("its scale is [0.0", whole[:131] + bytes(8) + whole[139:]),
        ):
            with self.subTest(words=words):
                self.assert_refused(words, content, "a.las")


class Laz(InFolder):
    """laspy itself may not be there: a stand-in with its interface decodes."""

    def test_without_laspy_it_is_named(self):
        with mock.patch.dict(sys.modules, {"laspy": None}):
            words = ["python3-laspy python3-laszip (Debian 13)", "pip install laspy lazrs", "pdal translate", "a.las"]
            self.assert_refused(words, las(1, packed=True), "a.laz")

    def test_points_that_laspy_decodes_are_read(self):
        kind = numpy.dtype((numpy.void, len(point(7, 0))))
        rows = numpy.array([point(7, i) for i in range(7)], kind)

        def chunks(count):
            for i in range(0, 7, 3):
                yield types.SimpleNamespace(array=rows[i : i + 3])

        reader = types.SimpleNamespace(chunk_iterator=chunks)
        laspy = types.SimpleNamespace(open=lambda path: contextlib.nullcontext(reader))
        with mock.patch.dict(sys.modules, {"laspy": laspy}):
            content = las(7, (1, 4), packed=True)
            self.assert_rows(self.read(content, "a.laz", keep_nulls=True), EXPECTED)
            rows = rows[:5]
            reader.chunk_iterator = lambda count: iter([types.SimpleNamespace(array=rows)])
            self.assert_refused("7 points are announced, 5 are there", content, "a.laz")
            reader.chunk_iterator = mock.Mock(side_effect=RuntimeError("no LazBackend\nselected"))
            self.assert_refused("laspy cannot read it: no LazBackend selected", content, "a.laz")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
