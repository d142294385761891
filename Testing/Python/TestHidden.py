# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points that are marked as hidden are not used, and cells that are hidden are not cells."""

import unittest

import numpy

import meshes
from vtkelevationsurface import (
    ElevationSurfaceError,
    reconstruct,
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)
from vtkelevationsurface.messages import Messages
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkStructuredGrid

HIDDEN_POINT, HIDDEN_CELL = 2, 32
SIDE = 9
XYZ = numpy.array([(x, y, 0.1 * x * y) for y in range(SIDE) for x in range(SIDE)], "f8")
BLANK = [30, 31, 39, 40, 48]


def run_filter(kind, data, **more):
    algorithm = kind()
    algorithm.SetInputData(data)
    for name, value in more.items():
        getattr(algorithm, "Set" + name)(value)
    algorithm.Update()
    return algorithm


def marked(xyz=XYZ, kind=vtkStructuredGrid):
    """A grid with nodes of -9999 that are blanked."""
    xyz = xyz.copy()
    xyz[BLANK, 2] = -9999
    marks = numpy.zeros(len(xyz), "u1")
    marks[BLANK] = HIDDEN_POINT
    data = meshes.cloud(xyz, arrays=[(meshes.GHOSTS, marks)], kind=kind)
    if kind is vtkStructuredGrid:
        data.SetDimensions(SIDE, SIDE, 1)
    return data


def unused(output):
    fields = output.GetFieldData()
    return [vtk_to_numpy(fields.GetArray("UnusedPoint" + name)).tolist() for name in ("Ids", "Reasons")]


class Points(unittest.TestCase):
    def test_hidden_ones_are_unused_with_a_reason(self):
        delaunay = run_filter(vtkGridDelaunay2D, marked())
        output = delaunay.GetOutput()
        self.assertEqual(unused(output), [BLANK, [4] * 5])
        self.assertTrue(set(BLANK).isdisjoint(meshes.triangles_of(output).ravel()))
        self.assertEqual(delaunay.GetNumberOfNonFinitePoints(), 0)
        self.assertEqual(output.GetPoint(BLANK[0])[2], -9999)

    def test_hidden_ones_above_others_are_not_a_second_surface(self):
        marks = numpy.repeat(numpy.array((0, HIDDEN_POINT), "u1"), len(XYZ))
        above = XYZ + (0.0, 0.0, 50.0)
        both = meshes.cloud(numpy.vstack((XYZ, above)), arrays=[(meshes.GHOSTS, marks)])
        result = reconstruct(both, fill=False)
        self.assertEqual(result.surface.GetNumberOfPolys(), 2 * (SIDE - 1) ** 2)
        self.assertFalse([note for note in result.report["notes"] if "several heights" in note])

    def test_reconstruct_leaves_them_out(self):
        result = reconstruct(marked())
        self.assertGreaterEqual(result.surface.GetBounds()[4], 0.0)
        self.assertEqual(result.report["unused_reasons"], {"marked as hidden": 5})

    def test_no_triangle_is_explained_by_those_that_are_hidden(self):
        for shown, words in ((0, "no point to use"), (1, "only one point"), (2, "only two points")):
            marks = numpy.full(len(XYZ), HIDDEN_POINT, "u1")
            marks[:shown] = 0
            data = meshes.cloud(XYZ, arrays=[(meshes.GHOSTS, marks)])
            delaunay = vtkGridDelaunay2D()
            delaunay.SetInputData(data)
            with Messages(delaunay, delaunay.GetExecutive()) as messages:
                delaunay.Update()
            (warning,) = messages.warnings
            self.assertEqual(warning.code, "NoTriangleShown")
            self.assertEqual(warning.values["hidden"], str(len(XYZ) - shown))
            with self.assertRaisesRegex(
                ElevationSurfaceError, f"{words}.*; {len(XYZ) - shown} points are marked as hidden"
            ):
                reconstruct(data)

    def test_nodes_without_a_cell_that_is_shown_are_hidden(self):
        data = marked()
        data.GetPointData().RemoveArray(meshes.GHOSTS)
        marks = numpy.zeros((SIDE - 1, SIDE - 1), "u1")
        marks[3:6, 3:6] = HIDDEN_CELL  # around 4 nodes
        data.GetCellData().AddArray(meshes.array_of(marks.ravel(), meshes.GHOSTS))
        nodes = [y * SIDE + x for y in (4, 5) for x in (4, 5)]
        unused_ones = [one["point"] for one in reconstruct(data).report["unused"]]
        self.assertEqual(unused_ones, nodes)


class Cells(unittest.TestCase):
    def setUp(self):
        self.surface = run_filter(vtkGridDelaunay2D, meshes.cloud(XYZ)).GetOutput()
        count = self.surface.GetNumberOfPolys()
        middle = XYZ[meshes.triangles_of(self.surface)].mean(axis=1)[:, :2]
        self.hidden = numpy.hypot(*(middle - 4).T) < 1.5
        self.values = numpy.arange(float(count))
        self.surface.GetCellData().AddArray(meshes.array_of(self.values, "Value"))

    def hide_cells(self):
        marks = numpy.where(self.hidden, HIDDEN_CELL, 0).astype("u1")
        self.surface.GetCellData().AddArray(meshes.array_of(marks, meshes.GHOSTS))

    def test_hidden_ones_are_not_a_surface_to_trim(self):
        self.hide_cells()
        ring = meshes.rings([numpy.array([(1, 1), (7, 1), (7, 7), (1, 7.0)])])
        trim = run_filter(vtkTrimOutwardTriangles, self.surface, BoundaryData=ring)
        found = [vtk_to_numpy(trim.GetOutput(port).GetCellData().GetArray("Value")) for port in (0, 1)]
        self.assertEqual(sorted(numpy.concatenate(found)), self.values[~self.hidden].tolist())

    def test_hidden_ones_are_a_hole_to_fill(self):
        before = self.surface.GetNumberOfPolys()
        self.hide_cells()
        fill = run_filter(vtkFillElevationHoles, self.surface)
        self.assertEqual(fill.GetNumberOfFilledHoles(), 1)
        new = vtk_to_numpy(fill.GetOutput().GetCellData().GetArray("HoleId")) == 0
        self.assertEqual(numpy.count_nonzero(~new), numpy.count_nonzero(~self.hidden))
        self.assertEqual(self.surface.GetNumberOfPolys(), before)

    def test_cells_with_a_hidden_point_are_hidden(self):
        marks = numpy.zeros(len(XYZ), "u1")
        marks[40] = HIDDEN_POINT
        self.surface.GetPointData().AddArray(meshes.array_of(marks, meshes.GHOSTS))
        fill = run_filter(vtkFillElevationHoles, self.surface)
        self.assertEqual(fill.GetNumberOfFilledHoles(), 1)
        self.assertNotIn(40, meshes.triangles_of(fill.GetOutput()))

    def test_hidden_lines_are_not_constraints(self):
        xyz = numpy.array([(0.5, 0.5, 0), (7.5, 6.5, 0), (0.5, 6.5, 0), (7.5, 0.5, 0)], "f8")
        lines = meshes.lines(xyz, [[0, 1], [2, 3]])
        lines.GetCellData().AddArray(meshes.array_of(numpy.array([0, HIDDEN_CELL], "u1"), meshes.GHOSTS))
        delaunay = run_filter(vtkGridDelaunay2D, meshes.cloud(XYZ), SourceData=lines)
        self.assertEqual(delaunay.GetNumberOfConstraintCrossings(), 0)


if __name__ == "__main__":
    unittest.main()
