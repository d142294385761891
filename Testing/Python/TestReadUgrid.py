# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of UGRID in netCDF: which arrays are x, y and z, and what cannot be read is refused in a line."""

import sys
import unittest

import numpy
from osgeo import gdal

from in_folder import InFolder, coordinates
from vtkelevationsurface.messages import FileError
from vtkelevationsurface.reading import read

gdal.UseExceptions()
XYZ = numpy.array([(10.0, 20.0, 1.0), (11.0, 20.5, 2.0), (10.5, 21.0, -3.0), (11.5, 21.5, 4.0)])


class Meshes(InFolder):
    def mesh(self, places, at_nodes=(), name="mesh.nc", layout="NC"):
        """A file. places: {name: (values, attributes)} of the nodes; at_nodes: the same of variables."""
        data = gdal.GetDriverByName("netCDF").CreateMultiDimensional(self.path(name), [], [f"FORMAT={layout}"])
        group, double = data.GetRootGroup(), gdal.ExtendedDataType.Create(gdal.GDT_Float64)
        nodes = group.CreateDimension("nodes", None, None, len(XYZ))

        def add(array, attributes):
            for key, value in attributes.items():
                kind = gdal.ExtendedDataType.CreateString()
                array.CreateAttribute(key, [], kind).Write(value)

        add(group.CreateMDArray("mesh", [], gdal.ExtendedDataType.Create(gdal.GDT_Int32)),
            {"cf_role": "mesh_topology", "node_coordinates": " ".join(places)})
        for key, (values, attributes) in {**places, **dict(at_nodes)}.items():
            array = group.CreateMDArray(key, [nodes], double)
            array.Write(numpy.ascontiguousarray(values))
            add(array, attributes if key in places else {"mesh": "mesh", "location": "node", **attributes})
        return self.path(name)

    def check(self, path, expected=XYZ, **options):
        numpy.testing.assert_array_equal(coordinates(read(path, **options)), expected)

    def test_coordinates_may_come_in_any_order_and_with_the_height(self):
        x, y, z = XYZ.T
        longitude, latitude = {"standard_name": "longitude"}, {"standard_name": "latitude"}
        self.check(self.mesh({"b": (y, latitude), "a": (x, longitude), "c": (z, {})}))
        self.check(self.mesh({"node_y": (y, {}), "node_x": (x, {})}, {"what": (z, {})}))

    def test_a_height_among_the_coordinates_comes_before_other_variables(self):
        x, y, z = XYZ.T
        path = self.mesh({"x": (x, {}), "y": (y, {}), "node_z": (z, {})}, {"friction": (0 * z, {})})
        self.check(path)
        self.check(path, XYZ * (1, 1, 0), layer="friction")

    def test_two_heights_are_a_question(self):
        x, y, z = XYZ.T
        path = self.mesh({"x": (x, {}), "y": (y, {})}, {"bedlevel": (z, {}), "water_level": (0 * z, {})})
        with self.assertRaisesRegex(FileError, "bedlevel, water_level: choose one by"):
            read(path)
        self.check(path, layer="bedlevel")

    def test_the_content_decides_whatever_the_suffix(self):
        x, y, z = XYZ.T
        for layout in ("NC", "NC4"):
            self.check(self.mesh({"x": (x, {}), "y": (y, {})}, {"bed": (z, {})}, f"mesh{layout}", layout))

    def test_without_a_height_it_is_refused(self):
        with self.assertRaisesRegex(FileError, "without a variable that has one value for each node"):
            read(self.mesh({"x": (XYZ[:, 0], {}), "y": (XYZ[:, 1], {})}))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
