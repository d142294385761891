# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files that are read slice by slice have the points of those read as a whole."""

import gzip
import struct
import sys
import unittest
from unittest import mock

import numpy
from in_folder import InFolder
from vtkelevationsurface import reading
from vtkelevationsurface.clouds import Cloud
from vtkelevationsurface.messages import FileError
from vtkelevationsurface.reading import text_blocks
from vtkelevationsurface.reading.slicing import read_files
from vtkmodules.util.numpy_support import vtk_to_numpy


def slice_points(path, cloud, **options):
    taken = []
    read_files([path], cloud, taken.append, **options)
    return numpy.concatenate(taken)


class Slices(InFolder):
    """Files that are read slice by slice have the points of those read as a whole."""

    def assert_as_whole(self, path, **options):
        whole, cloud = reading.read(path, **options), Cloud(None)
        found = slice_points(path, cloud, **options)
        expected = vtk_to_numpy(whole.points.GetPoints().GetData())
        numpy.testing.assert_array_equal(found, expected)
        self.assertEqual(cloud.left_out, whole.left_out)
        self.assertEqual(cloud.crs, whole.crs)
        self.assertLessEqual(set(whole.notes), set(cloud.notes))
        return cloud

    def test_text(self):
        rows = [f"{i % 70},{i // 70},{i % 11 or 'nan'},{i}" for i in range(5000)]
        path = self.file("a.csv", "\n".join(["# made", "X,Y,Z,Depth", *rows, "", "Total,,5,"]))
        with mock.patch.object(text_blocks, "BLOCK", 3000):
            cloud = self.assert_as_whole(path)
            self.assertIn("left out: Depth", cloud.notes)
            self.assert_as_whole(path, no_data=5.0, depth=True)
            self.assert_as_whole(path, columns=("1", "2", "4"))
            self.assert_as_whole(path, where={"depth": list(range(100, 4000, 7))})
            with self.assertRaisesRegex(FileError, "no column name besides x, y and z; columns: D"):
                slice_points(path, Cloud(None), where="name=a")
        rows = [f"{i % 70},{i // 70},{i % 11},{'abc'[i % 3]}" for i in range(5000)]
        path = self.file("words.csv", "\n".join(["X,Y,Z,name", *rows]))
        with mock.patch.object(text_blocks, "BLOCK", 3000):
            self.assert_as_whole(path, where="name=b")
            with self.assertRaisesRegex(FileError, r"name = d; values: a \(1,667\), b \(1,667"):
                slice_points(path, Cloud(None), where="name=d")
        packed = self.path("b.csv.gz")
        with gzip.open(packed, "wb") as stream:
            stream.write(b"1 2 3\n4 5 6\n7 7 7\n")
        self.assert_as_whole(packed)

    def test_arrays_of_numpy(self):
        rng = numpy.random.default_rng(3)
        rows = rng.integers(0, 50, (900, 4))
        kinds = [("y", "f4"), ("x", "f8"), ("name", "i4"), ("z", ">f8")]
        fields = numpy.zeros(500, dtype=kinds)
        for name in "xyz":
            fields[name] = rng.random(500)
        for i, array in enumerate((rows, numpy.asfortranarray(rows * 0.5), fields)):
            path = self.path(f"{i}.npy")
            numpy.save(path, array)
            with mock.patch("vtkelevationsurface.clouds.AT_ONCE", 70):
                self.assert_as_whole(path)
                self.assert_as_whole(path, no_data=7.0)
        with mock.patch("vtkelevationsurface.clouds.AT_ONCE", 70):
            self.assert_as_whole(self.path("0.npy"), where={"column 4": [3, 7]})
            self.assert_as_whole(self.path("2.npy"), where="name=0")

    def test_las(self):
        rng = numpy.random.default_rng(4)
        xyz, classes = rng.integers(-9999, 9999, (500, 3)), rng.integers(0, 4, 500)
        head = b"LASF" + bytes(20) + bytes((1, 2)) + bytes(68)
        head += struct.pack("<HIIBH", 227, 227, 0, 0, 20) + struct.pack("<I5I", len(xyz), *[0] * 5)
        head += struct.pack("<6d", 0.01, 0.01, 0.001, 5e5, 6e6, 0.0) + bytes(48)
        body = b"".join(
            struct.pack("<iiiHBBbBH", *map(int, p), 7, 1, int(c) | 128 * (c == 3), 0, 0, 0)
            for p, c in zip(xyz, classes)
        )
        path = self.file("a.las", head + body)
        with mock.patch("vtkelevationsurface.reading.las.AT_ONCE", 60):
            self.assert_as_whole(path)
            self.assert_as_whole(path, classes=(1, 2))
            self.assert_as_whole(path, where={"Classification": [0, 2]})
            with self.assertRaisesRegex(FileError, "holds no point of class 9"):
                slice_points(path, Cloud(None), classes=(9,))

    def test_null_values_are_an_error_that_names_the_options(self):
        rows = "".join(f"{i % 40} {i // 40} {-9999 if i == 700 else i % 7}\n" for i in range(1000))
        path = self.file("a.xyz", rows)
        with self.assertRaisesRegex(FileError, "z = -9999, far from .*--no-data -9999.*--keep"):
            slice_points(path, Cloud(None))
        self.assert_as_whole(path, no_data=-9999.0)
        found = slice_points(path, Cloud(None), keep_nulls=True)
        self.assertEqual(len(found), 1000)

    def test_nulls_that_fill_a_slice_are_found(self):
        numbers = numpy.random.default_rng(5).random((3000, 3))
        for first in (0, 1300, 2500):
            numbers[:, 2] = 100.0 + numbers[:, 0]
            numbers[first : first + 500, 2] = -9999.0
            path = self.path("nulls.npy")
            numpy.save(path, numbers)
            with mock.patch("vtkelevationsurface.clouds.AT_ONCE", 250):
                with self.assertRaisesRegex(FileError, "z = -9999"):
                    slice_points(path, Cloud(None))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
