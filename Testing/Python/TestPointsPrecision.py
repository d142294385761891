# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The type of output points follows from inputs and properties, not from values."""

import unittest

import numpy

import meshes
import outcomes
from vtkelevationsurface import (
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_DOUBLE, VTK_FLOAT, vtkPoints
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

SINGLE, DOUBLE, DEFAULT = (
    vtkAlgorithm.SINGLE_PRECISION, vtkAlgorithm.DOUBLE_PRECISION, vtkAlgorithm.DEFAULT_PRECISION)
RANDOM = numpy.random.default_rng(38)
XYZ = numpy.column_stack((RANDOM.uniform(0, 20, (300, 2)), RANDOM.uniform(0, 2, 300)))
XYZ = XYZ[numpy.hypot(*(XYZ[:, :2] - 10).T) > 3].round(2)
EXACT = numpy.array([(3, 3, 0), (17, 3, 0), (17, 17, 0), (3, 17, 0.0)])  # in float, too
NAMES = {"float32": VTK_FLOAT, "float64": VTK_DOUBLE, "int32": VTK_DOUBLE}


def cloud(dtype="float64", xyz=XYZ):
    data = meshes.cloud(xyz)
    points = vtkPoints()
    points.SetDataType({"float32": VTK_FLOAT, "float64": VTK_DOUBLE, "int32": 6}[dtype])
    points.DeepCopy(data.GetPoints())
    data.SetPoints(points)
    return data


def run(kind, data, precision=DEFAULT, second=None):
    one = kind()
    if kind is vtkFillElevationHoles:
        one.SetOpenEdgeLength(2.5)
    one.SetInputData(data)
    one.SetOutputPointsPrecision(precision)
    if second is not None:
        one.SetInputData(1, second)
    one.Update()
    return one


def refused(data, precision):
    """The filter, and what it says; the request fails."""
    one = vtkGridDelaunay2D()
    said = outcomes.noted(one)
    one.SetInputData(data)
    one.SetOutputPointsPrecision(precision)
    one.Update()
    return one, "\n".join(text for event, text in said if event == "ErrorEvent")


def types(one):
    return {one.GetOutput(port).GetPoints().GetDataType() for port in range(one.GetNumberOfOutputPorts())}


def places(one, port=0):
    return vtk_to_numpy(one.GetOutput(port).GetPoints().GetData())


class Precision(unittest.TestCase):
    def test_without_lines_the_default_is_the_type_of_the_input(self):
        for dtype, expected in NAMES.items():
            mesh = run(vtkGridDelaunay2D, cloud(dtype, XYZ.round() if dtype == "int32" else XYZ))
            self.assertEqual(types(mesh), {expected}, dtype)
            for kind in (vtkTrimOutwardTriangles, vtkFillElevationHoles):
                self.assertEqual(types(run(kind, mesh.GetOutput())), {expected}, (dtype, kind))

    def test_lines_alone_are_double_whatever_type_no_points_have(self):
        lines = meshes.rings([EXACT[:, :2] + (600000.1, 6000000.3)])
        for dtype in NAMES:
            for precision in (DEFAULT, DOUBLE):
                mesh = run(vtkGridDelaunay2D, cloud(dtype, XYZ[:0]), precision, lines)
                self.assertEqual(types(mesh), {VTK_DOUBLE}, dtype)
                self.assertEqual(places(mesh).tolist(), meshes.points_of(lines).tolist(), dtype)

    def test_with_lines_it_is_double_whatever_their_values_are(self):
        without = run(vtkGridDelaunay2D, cloud("float32")).GetOutput()
        for xyz in (EXACT, EXACT + (0.1, 0.1, 0)):
            lines = meshes.rings([xyz[:, :2]])
            self.assertEqual(types(run(vtkGridDelaunay2D, cloud("float32"), second=lines)), {VTK_DOUBLE})
            self.assertEqual(types(run(vtkTrimOutwardTriangles, without, second=lines)), {VTK_DOUBLE})

    def test_double_gives_what_double_points_give(self):
        mesh = run(vtkGridDelaunay2D, cloud("float32"), DOUBLE)
        self.assertEqual(types(mesh), {VTK_DOUBLE})
        single = run(vtkGridDelaunay2D, cloud("float32")).GetOutput()
        filled = [run(vtkFillElevationHoles, one, DOUBLE) for one in (single, mesh.GetOutput())]
        self.assertGreater(filled[0].GetOutput().GetNumberOfPoints(), len(XYZ))
        self.assertTrue((places(filled[0]) != places(filled[0]).astype("f4")).any())
        numpy.testing.assert_array_equal(places(filled[0]), places(filled[1]))

    def test_single_rounds_what_double_gives(self):
        line = meshes.rings([EXACT[:, :2] + 0.1])
        mesh = run(vtkGridDelaunay2D, cloud(), second=line).GetOutput()
        for kind, data, second in (
            (vtkGridDelaunay2D, cloud(), line), (vtkTrimOutwardTriangles, mesh, line),
            (vtkFillElevationHoles, mesh, None),
        ):
            whole, single = run(kind, data, DEFAULT, second), run(kind, data, SINGLE, second)
            self.assertEqual(types(single), {VTK_FLOAT}, kind)
            for port in range(single.GetNumberOfOutputPorts()):
                numpy.testing.assert_array_equal(
                    places(single, port), places(whole, port).astype("f4"), str(kind))
            numpy.testing.assert_array_equal(
                meshes.triangles_of(single.GetOutput()), meshes.triangles_of(whole.GetOutput()))

    def test_a_triangle_that_folds_in_single_precision_is_an_error(self):
        for xyz, kind in ((XYZ + (6e6, 5e6, 0), "UTM"), (XYZ + (0, 0, 1e39), "infinite")):
            one, said = refused(cloud(xyz=numpy.vstack((xyz, xyz[:3]))), SINGLE)
            self.assertIn("In single precision cell", said, kind)
            self.assertEqual(one.GetOutput().GetNumberOfPoints(), 0)
            self.assertEqual(one.GetNumberOfDuplicatePoints(), 0)  # counts are of what is there

    def test_a_mesh_without_triangles_is_reported_once_whatever_is_converted(self):
        mesh, trim = vtkGridDelaunay2D(), vtkTrimOutwardTriangles()
        mesh.SetInputData(cloud("float32"))
        mesh.SetMaximumEdgeLength(1e-6)
        trim.SetInputConnection(mesh.GetOutputPort())
        trim.SetBoundaryData(meshes.rings([EXACT[:, :2]]))
        trim.RemoveUnusedPointsOn()
        said = outcomes.noted(mesh, trim)
        trim.Update()
        self.assertEqual(len(said), 1, said)
        self.assertIn("left without a triangle", said[0][1])

    def test_another_value_is_an_error(self):
        self.assertIn("OutputPointsPrecision is 3", refused(cloud(), 3)[1])


if __name__ == "__main__":
    unittest.main()
