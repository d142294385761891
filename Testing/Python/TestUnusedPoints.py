# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points that no triangle has are removed from outputs, and what is left is as it was."""

import os
import tempfile
import unittest

import numpy

import meshes
from vtkelevationsurface import (
    ElevationSurfaceError,
    read,
    reconstruct,
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)
from vtkelevationsurface.algorithms import ReconstructElevationSurface
from vtkelevationsurface.command import main
from vtkelevationsurface.messages import Messages
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdTypeArray
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet

BLUNDER, INFINITE, TWIN = 7, 9, 11
RANDOM = numpy.random.default_rng(5)
XYZ = numpy.column_stack((RANDOM.uniform(0, 20, (600, 2)), RANDOM.uniform(0, 2, 600)))
XYZ[BLUNDER] = (400.0, 400.0, 0.0)
XYZ[INFINITE, 2] = numpy.inf
XYZ[TWIN, :2] = XYZ[3, :2]
XYZ = numpy.delete(XYZ, numpy.flatnonzero(numpy.hypot(*(XYZ[:, :2] - 10).T) < 2), axis=0)
UNUSED = {BLUNDER, INFINITE, TWIN}


def original(data):
    return vtk_to_numpy(data.GetPointData().GetArray("OriginalPointIds"))


def corners(data):
    """(m, 3, 3): the places of the corners of all triangles."""
    return vtk_to_numpy(data.GetPoints().GetData()).astype("f8")[meshes.triangles_of(data)]


def chain(data, *removing):
    """The three filters on points; removing: which of them remove unused points."""
    filters = vtkGridDelaunay2D(), vtkTrimOutwardTriangles(), vtkFillElevationHoles()
    filters[0].SetInputData(data)
    filters[0].SetMaximumEdgeLength(6.0)
    filters[1].SetBoundaryData(meshes.rings([numpy.array([(2, 2), (17, 3), (16.5, 16), (3, 18.0)])]))
    for one, other in zip(filters, filters[1:]):
        other.SetInputConnection(one.GetOutputPort())
    for number in removing:
        filters[number].RemoveUnusedPointsOn()
    filters[2].SetMaximumEdgeLength(2.0)
    filters[2].Update()
    return filters


class Filters(unittest.TestCase):
    def test_all_points_stay_by_default(self):
        for one in chain(meshes.cloud(XYZ)):
            self.assertFalse(one.GetRemoveUnusedPoints())
            self.assertGreaterEqual(one.GetOutput().GetNumberOfPoints(), len(XYZ))
            self.assertFalse(one.GetOutput().GetPointData().HasArray("OriginalPointIds"))

    def test_outputs_have_the_points_of_their_cells_and_the_same_triangles(self):
        names = numpy.array(["p%d" % i for i in range(len(XYZ))], dtype="U")
        data = meshes.cloud(XYZ, arrays=[("Name", names)])
        whole = chain(data)
        for removing in ((0, 1, 2), (0,), (1,), (2,), (0, 2)):
            found = chain(data, *removing)
            for number, (one, other) in enumerate(zip(found, whole)):
                for port in range(2 if number == 1 else 1):
                    output, expected = one.GetOutput(port), other.GetOutput(port)
                    numpy.testing.assert_array_equal(corners(output), corners(expected))
                    if number in removing:
                        used = numpy.unique(meshes.triangles_of(output))
                        self.assertEqual(len(used), output.GetNumberOfPoints())
                    if number >= min(removing):
                        ids, words = original(output), output.GetPointData().GetAbstractArray("Name")
                        places = vtk_to_numpy(output.GetPoints().GetData())
                        # Without them in its input, a filter numbers points that others added, too.
                        known = (ids >= 0) & (ids < len(XYZ))
                        numpy.testing.assert_array_equal(places[known], XYZ[ids[known]])
                        for point in numpy.flatnonzero(known)[:20].tolist():
                            self.assertEqual(words.GetValue(point), "p%d" % ids[point])
            new = vtk_to_numpy(found[2].GetOutput().GetPointData().GetArray("FilledPoint")) == 1
            self.assertTrue((original(found[2].GetOutput())[new] == -1).all())
            self.assertGreater(new.sum(), 0)

    def test_unused_points_have_the_numbers_of_the_input(self):
        first = chain(meshes.cloud(XYZ), 0)[0].GetOutput()
        self.assertEqual(set(range(len(XYZ))) - set(original(first)), UNUSED)
        fields = first.GetFieldData()
        ids, why = (vtk_to_numpy(fields.GetArray("UnusedPoint" + name)) for name in ("Ids", "Reasons"))
        self.assertEqual(dict(zip(ids, why)), {INFINITE: 2, TWIN: 1})
        again = vtkGridDelaunay2D()
        again.RemoveUnusedPointsOn()
        again.SetMaximumElevationError(0.5)
        again.SetInputData(first)
        again.Update()
        unused = vtk_to_numpy(again.GetOutput().GetFieldData().GetArray("UnusedPointIds"))
        self.assertEqual(set(original(again.GetOutput())) | set(unused), set(original(first)))

    def test_twins_of_copies_go_where_both_are_in_one_data_set(self):
        # Parts that have been appended with their ghosts: the last two are copies, and the vertices.
        data = meshes.cloud(
            numpy.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 0), (1, 0, 0)], float),
            arrays=[(meshes.GHOSTS, numpy.array([0, 0, 0, 1, 1], "u1"))])
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(data)
        delaunay.SetDuplicatePolicyToKeepLast()
        delaunay.RemoveUnusedPointsOn()
        delaunay.Update()
        self.assertEqual(original(delaunay.GetOutput()).tolist(), [2, 3, 4])

    def test_global_ids_are_the_original_ones(self):
        ids = 1000 + RANDOM.permutation(len(XYZ))
        output = chain(meshes.cloud(XYZ, ids), 0)[0].GetOutput()
        numpy.testing.assert_array_equal(original(output), numpy.delete(ids, sorted(UNUSED)))

    def test_blocks_have_numbers_of_their_own(self):
        blocks = vtkMultiBlockDataSet()
        blocks.SetBlock(0, meshes.cloud(XYZ))
        blocks.SetBlock(1, meshes.cloud(XYZ[::-1]))
        output = chain(blocks, 0)[0].GetOutputDataObject(0)
        for i, shift in enumerate((lambda ids: ids, lambda ids: len(XYZ) - 1 - ids)):
            found = shift(original(output.GetBlock(i)))
            self.assertEqual(set(range(len(XYZ))) - set(found), UNUSED if i == 0 else {7, 9, 3})

    def test_points_of_vertices_and_lines_stay(self):
        surface = vtkGridDelaunay2D()
        surface.SetInputData(meshes.cloud(XYZ))
        surface.SetMaximumEdgeLength(6.0)
        surface.Update()
        surface.GetOutput().SetVerts(meshes.cells_of([[BLUNDER]]))
        fill = vtkFillElevationHoles()
        fill.SetInputData(surface.GetOutput())
        fill.RemoveUnusedPointsOn()
        fill.Update()
        output = fill.GetOutput()
        self.assertEqual(set(range(len(XYZ))) - set(original(output)), UNUSED - {BLUNDER})
        self.assertEqual(original(output)[output.GetCell(0).GetPointId(0)], BLUNDER)


    def test_original_ids_that_are_given_stay_as_any_kind_of_signed_integers(self):
        for kind in ("i4", "i2", "i8"):
            numbers = (3 * numpy.arange(len(XYZ)) + 7).astype(kind)
            data = meshes.cloud(XYZ, arrays=[("OriginalPointIds", numbers)])
            result = reconstruct(data, fill=False)
            self.assertEqual(result.notes, reconstruct(XYZ, fill=False).notes)
            for surface in (chain(data, 2)[2].GetOutput(), result.surface):
                self.assertIsInstance(surface.GetPointData().GetArray("OriginalPointIds"), vtkIdTypeArray)
                ids = original(surface)
                xyz = vtk_to_numpy(surface.GetPoints().GetData())[ids >= 0]
                numpy.testing.assert_array_equal(XYZ[(ids[ids >= 0] - 7) // 3], xyz)

    def test_an_array_of_this_name_that_has_no_ids_is_replaced_with_a_warning(self):
        other = numpy.linspace(0.0, 1.0, len(XYZ))
        number = numpy.arange(len(XYZ))
        for array in (other, numpy.column_stack((number, number)), number.astype("u4"), number.astype("i1")):
            data = meshes.cloud(XYZ, arrays=[("OriginalPointIds", array)])
            removing = vtkGridDelaunay2D()
            removing.SetInputData(data)
            removing.RemoveUnusedPointsOn()
            with Messages(removing, removing.GetExecutive()) as messages:
                removing.Update()
            self.assertEqual([one.code for one in messages.warnings], ["OriginalIdsReplaced"])
            result = reconstruct(data, fill=False)
            self.assertEqual(sum("OriginalPointIds" in note for note in result.notes), 1)
            with self.assertRaisesRegex(ElevationSurfaceError, "OriginalPointIds"):
                reconstruct(data, trim=False, fill=False, strict=True)
            for surface in (removing.GetOutput(), result.surface):
                xyz = vtk_to_numpy(surface.GetPoints().GetData())
                numpy.testing.assert_array_equal(XYZ[original(surface)], xyz)


class Products(unittest.TestCase):
    def test_reconstruct_removes_them_and_reports_them_by_their_numbers(self):
        result = reconstruct(XYZ, fill=False)
        whole = reconstruct(XYZ, fill=False, remove_unused_points=False)
        self.assertLess(result.surface.GetBounds()[1], 20.0)
        self.assertEqual(whole.surface.GetBounds()[1::4], (400.0, numpy.inf))
        numpy.testing.assert_array_equal(corners(result.surface), corners(whole.surface))
        self.assertEqual(result.report["unused"], whole.report["unused"])
        self.assertTrue(UNUSED <= {one["point"] for one in result.report["unused"]})
        self.assertTrue(UNUSED.isdisjoint(original(result.surface)))

    def test_the_entry_of_paraview_removes_them(self):
        entry = ReconstructElevationSurface()
        entry.SetInputDataObject(meshes.cloud(XYZ))
        for keep in (False, True):
            entry.SetRemoveUnusedPoints(not keep)
            entry.Update()
            self.assertEqual(entry.GetOutputDataObject(0).GetBounds()[1] == 400.0, keep)

    def test_the_program_writes_none_unless_asked_to(self):
        with tempfile.TemporaryDirectory() as folder:
            points, surface = (os.path.join(folder, name) for name in ("points.xyz", "surface.vtp"))
            numpy.savetxt(points, XYZ[numpy.isfinite(XYZ).all(axis=1)])
            for more in ([], ["--no-remove-unused-points"]):
                main([points, "-o", surface, "--no-picture", *more])
                self.assertEqual(read(surface).points.GetBounds()[1] == 400.0, bool(more))


if __name__ == "__main__":
    unittest.main()
