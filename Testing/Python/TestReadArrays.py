# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Arrays of numpy, of files and as reconstruct() takes them: grids, columns by name, fields."""

import io
import sys
import unittest

import numpy
from in_folder import InFolder, coordinates
from vtkelevationsurface import reconstruct
from vtkelevationsurface.messages import FileError

X, Y = numpy.arange(20) * 5.0 + 100, numpy.arange(15) * -4.0 + 900
Z = numpy.random.default_rng(1).normal(size=(15, 20))
NODES = numpy.column_stack([v.ravel() for v in (*numpy.meshgrid(X, Y), Z)])


def packed(save, *arrays, **named):
    stream = io.BytesIO()
    save(stream, *arrays, **named)
    return stream.getvalue()


class Arrays(InFolder):
    def test_a_grid_of_elevations_is_read_with_its_axes_or_by_numbers(self):
        self.assert_rows(self.read(packed(numpy.savez, x=X, y=Y, z=Z), "a.npz"), NODES)
        self.assert_rows(self.read(packed(numpy.savez_compressed, lon=X, lat=Y, elevation=Z), "a.npz"), NODES)
        x, y = numpy.meshgrid(X, Y)
        self.assert_rows(self.read(packed(numpy.savez, x=x, y=y, z=Z), "a.npz"), NODES)
        numbers = NODES.copy()
        numbers[:, 0], numbers[:, 1] = (NODES[:, 0] - 100) / 5, (NODES[:, 1] - 900) / -4
        for content, name in (
            (packed(numpy.save, Z), "a.npy"), (packed(numpy.savez, dem=Z), "a.npz"), (packed(numpy.savez, Z), "b.npz"),
        ):
            cloud = self.read(content, name)
            self.assert_rows(cloud, numbers)
            self.assertTrue(any("it has no x and y" in note for note in cloud.notes), cloud.notes)

    def test_columns_by_name_are_points(self):
        x, y, z = NODES.T
        self.assert_rows(self.read(packed(numpy.savez, y=y, x=x, z=z, q=x), "a.npz"), NODES)
        self.assert_rows(self.read(packed(numpy.savez, NODES), "a.npz"), NODES)

    def test_what_has_a_hole_has_a_hole(self):
        z = Z.copy()
        z[5:8, 5:9] = numpy.nan
        cloud = self.read(packed(numpy.savez, x=X, y=Y, z=z), "a.npz")
        self.assertEqual(cloud.left_out, {"pixels without data": 12})
        grid = reconstruct(z, x=X, y=Y).to_grid()
        numpy.testing.assert_array_equal(grid.z[numpy.isfinite(z)], z[numpy.isfinite(z)])
        self.assertTrue(numpy.isfinite(grid.z).all())

    def test_reconstruct_takes_all_of_them(self):
        x, y, z = NODES.T
        fields = numpy.zeros(len(z), [("id", "i4"), ("easting", "f8"), ("northing", "f8"), ("height", "f4")])
        fields["easting"], fields["northing"], fields["height"] = x, y, z
        expected = reconstruct(NODES).surface.GetNumberOfPolys()
        for points, more in (
            (Z, {"x": X, "y": Y}), (Z, dict(zip("xy", numpy.meshgrid(X, Y)))), ({"x": X, "y": Y, "z": Z}, {}),
            ({"Z": z.tolist(), "X": x, "Y": y, "name": ["a"] * len(z)}, {}), (fields, {}),
            (numpy.ma.masked_invalid(Z), {"x": X, "y": Y}),
        ):
            result = reconstruct(points, **more)
            self.assertEqual(result.surface.GetNumberOfPolys(), expected)
            found = coordinates(result.cloud)
            numpy.testing.assert_allclose(found, NODES, rtol=1e-6)

    def test_no_wrong_byte_makes_anything_but_one_line(self):
        random = numpy.random.default_rng(6)
        for name, content in (
            ("a.npy", packed(numpy.save, Z)), ("a.npz", packed(numpy.savez, x=X, y=Y, z=Z)),
            ("b.npz", packed(numpy.savez_compressed, z=Z)),
        ):
            for _ in range(60):
                wrong = bytearray(content)
                for at in random.integers(0, len(wrong) if random.integers(2) else 128, 2):
                    wrong[at] = random.integers(0, 256)
                try:
                    self.read(bytes(wrong), name)
                except FileError as error:
                    self.assertNotIn("\n", str(error))

    def test_what_does_not_fit_is_refused(self):
        for words, given in (
            ("x needs 20 values and y 15", {"x": X, "y": X, "z": Z}),
            ("do not fit: x 20, y 15, z 300", {"x": X, "y": Y, "z": Z.ravel()}),
            ("has no columns x, y and z, but a, b", {"a": X, "b": X}),
        ):
            self.assert_refused(words, packed(numpy.savez, **given), "a.npz")
        self.assert_refused("cut off or damaged", packed(numpy.savez, x=X, y=Y, z=Z)[:-300], "a.npz")
        self.assert_refused("a grid, are needed", packed(numpy.save, numpy.zeros(7)), "a.npy")
        with self.assertRaisesRegex(ValueError, "x= and y= of a grid; the shape is 15 x 20"):
            reconstruct(Z)
        with self.assertRaisesRegex(Exception, "x needs 20 values"):
            reconstruct(Z, x=Y, y=X)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
