# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The reader and the whole chain as VTK algorithms, in a pipeline without ParaView."""

import os
import sys
import unittest

import numpy
from vtkelevationsurface import read, reconstruct
from vtkelevationsurface.algorithms import ElevationPoints, ReconstructElevationSurface
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_STRING, vtkOutputWindow, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkTable


def errors_of(algorithm):
    errors = []

    def note(_caller, _event, text):
        errors.append(text)

    note.CallDataType = VTK_STRING
    tag = algorithm.AddObserver("ErrorEvent", note)
    algorithm.Update()
    algorithm.RemoveObserver(tag)
    return errors


def points(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def table_of(**columns):
    table = vtkTable()
    for name, values in columns.items():
        if isinstance(values[0], str):
            array = vtkStringArray()
            for word in values:
                array.InsertNextValue(word)
        else:
            array = numpy_to_vtk(numpy.asarray(values), deep=True)
        array.SetName(name)
        table.AddColumn(array)
    return table


GRID = numpy.mgrid[0:6, 0:5].reshape(2, -1).astype(float)


class Algorithms(unittest.TestCase):
    def setUp(self):
        vtkOutputWindow.GetInstance().SetDisplayModeToNever()  # what the algorithms tell

    def test_a_pipeline_is_read_and_reconstruct(self):
        path = os.path.join(sys.argv[sys.argv.index("-D") + 1], "aegean_sea.csv")
        reader, chain = ElevationPoints(), ReconstructElevationSurface()
        reader.SetFileName(path)
        chain.SetInputConnection(0, reader.GetOutputPort())
        chain.SetInterpolation("membrane")
        self.assertEqual(errors_of(chain), [])
        expected = reconstruct(read(path), interpolation="membrane")
        surface = chain.GetOutputDataObject(0)
        xyz, triangles = expected.to_numpy()
        numpy.testing.assert_array_equal(points(surface), xyz)
        ids = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
        numpy.testing.assert_array_equal(ids.reshape(-1, 3), triangles)
        self.assertIn("4,650 read", chain.GetReport())
        self.assertGreater(chain.GetOutputDataObject(3).GetNumberOfRows(), 5)

    def test_a_table_of_words_and_numbers(self):
        x, y = GRID
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, table_of(
            Name=[f"P{i}" for i in range(x.size)], Height=x + y, Northing=[str(v) for v in y], Easting=x))
        self.assertEqual(errors_of(chain), [])
        surface = chain.GetOutputDataObject(0)
        numpy.testing.assert_array_equal(points(surface), numpy.column_stack((x, y, x + y)))
        self.assertEqual(surface.GetPointData().GetAbstractArray("Name").GetValue(3), "P3")

    def test_null_values_of_tables_are_left_out_or_kept(self):
        x, y = GRID
        z = numpy.where(numpy.arange(x.size) == 7, -9999.0, x)
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, table_of(x=x, y=y, z=z))
        chain.Update()
        self.assertEqual(points(chain.GetOutputDataObject(0))[:, 2].min(), 0)
        self.assertIn("left out", chain.GetReport())
        chain.SetKeepNulls(True)
        chain.Update()
        self.assertEqual(points(chain.GetOutputDataObject(0))[:, 2].min(), -9999)

    def test_elevations_of_an_image_are_chosen(self):
        image = vtkImageData()
        image.SetDimensions(6, 5, 1)
        for name, factor in (("Top", 1.0), ("Base", 2.0)):
            array = numpy_to_vtk(factor * numpy.arange(30.0), deep=True)
            array.SetName(name)
            image.GetPointData().AddArray(array)
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, image)
        for name, highest in (("", 29), ("Base", 58)):
            chain.SetElevationArray(name)
            chain.Update()
            elevation = chain.GetOutputDataObject(0).GetPointData().GetScalars()
            self.assertEqual((elevation.GetName(), elevation.GetRange()[1]), ("Elevation", highest))

    def test_another_array_of_the_name_elevation_is_kept(self):
        x, y = GRID
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, table_of(x=x, y=y, z=x, Elevation=y))
        chain.SetColumns("x,y,z")
        chain.Update()
        data = chain.GetOutputDataObject(0).GetPointData()
        numpy.testing.assert_array_equal(vtk_to_numpy(data.GetArray("Elevation")), x)
        numpy.testing.assert_array_equal(vtk_to_numpy(data.GetArray("Elevation of the input")), y)

    def test_errors_are_one_line(self):
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, table_of(a=["x"], b=["y"], c=["z"]))
        for wrong in (chain, ElevationPoints()):
            errors = errors_of(wrong)
            self.assertEqual(len(errors), 1, errors)
            self.assertNotIn("\n", errors[0])
            self.assertNotIn("should not happen", errors[0])
            self.assertEqual(wrong.GetOutputDataObject(0).GetNumberOfPoints(), 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
