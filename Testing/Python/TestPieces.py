# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces in pieces: together they have the triangles of all points at once."""

import os
import sys
import unittest

import numpy
from in_pieces import WithFilter, all_triangles, clouds, ids_of, star
from meshes import GHOSTS, ghosts_of, sorted_triangles, triangles_of
from vtkelevationsurface import vtkGridDelaunay2D
from vtkelevationsurface.clouds import add_array, make_lines, make_points
from vtkelevationsurface.messages import Messages
from vtkelevationsurface.vtkElevationSurfacePieces import vtkReconstructPieces
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes

COUNTS = ("DuplicatePoints", "NonFinitePoints")


class InPieces(WithFilter):
    """The filter by itself."""

    def assert_as_one(self, points, count, **properties):
        one = vtkGridDelaunay2D()
        for name, value in properties.items():
            getattr(one, "Set" + name)(value)
        one.SetInputData(make_points(points))
        one.Update()
        source = self.source(points, **properties)
        parts = self.parts(source, count)
        numpy.testing.assert_array_equal(
            all_triangles(parts), sorted_triangles(triangles_of(one.GetOutput()))
        )
        self.assertEqual(source.GetNumberOfTriangles(), one.GetOutput().GetNumberOfPolys())
        self.assertEqual(source.GetLatticeFound(), one.GetLatticeFound())
        for name in COUNTS:
            counts = [getattr(f, "GetNumberOf" + name)() for f in (source, one)]
            self.assertEqual(*counts)
        return one.GetOutput(), parts

    def test_the_triangles_are_those_of_all_points_at_once(self):
        for name, points in clouds().items():
            for count in (1, 2, 3, 7, 16):
                with self.subTest(cloud=name, pieces=count):
                    self.assert_as_one(points, count)

    def test_each_point_has_one_piece_and_others_are_ghosts(self):
        points = clouds()["random"]
        _, parts = self.assert_as_one(points, 7)
        self.assertEqual(len(parts), 7)
        own = numpy.concatenate([ids_of(part)[~ghosts_of(part)] for part in parts])
        numpy.testing.assert_array_equal(numpy.sort(own), numpy.arange(len(points)))
        for part in parts:
            here = vtk_to_numpy(part.GetPoints().GetData())
            numpy.testing.assert_array_equal(here, points[ids_of(part)])
            used = numpy.zeros(len(here), dtype=bool)
            used[triangles_of(part)] = True
            self.assertTrue(used[ghosts_of(part)].all())
            self.assertTrue((numpy.diff(ids_of(part)[~ghosts_of(part)]) > 0).all())
            y = here[:, 1][triangles_of(part)]
            lowest = triangles_of(part)[numpy.arange(len(y)), y.argmin(axis=1)]
            self.assertFalse(ghosts_of(part)[lowest].any())

    def test_duplicates_and_points_that_are_not_finite_are_those_of_one(self):
        points = clouds()["random"]
        for policy in range(4):
            one, parts = self.assert_as_one(points, 5, DuplicatePolicy=policy)
            fields = [data.GetFieldData() for data in (one, *parts)]
            ids, reasons = (
                [vtk_to_numpy(field.GetArray("UnusedPoint" + name)) for field in fields]
                for name in ("Ids", "Reasons")
            )
            own = numpy.concatenate([ids_of(part)[some] for part, some in zip(parts, ids[1:])])
            order = numpy.argsort(own)
            numpy.testing.assert_array_equal(own[order], ids[0])
            numpy.testing.assert_array_equal(numpy.concatenate(reasons[1:])[order], reasons[0])

    def test_the_lattice_is_that_of_all_points(self):
        points = clouds()["lattice"]
        one, parts = self.assert_as_one(points, 6)
        for part in parts:
            lattices = [data.GetFieldData().GetArray("Lattice") for data in (one, part)]
            self.assertEqual(*(lattice.GetTuple(0) for lattice in lattices))
        self.assert_as_one(points, 6, LatticeMode=1)

    def test_triangles_with_long_edges_are_left_out_as_of_all_points(self):
        for name, lengths in (("random", (40.0, 20.0)), ("lattice", (4.5, 3.6)), ("tracks", (60.0,))):
            points = clouds()[name]
            for length in lengths:
                for count in (1, 3, 7):
                    with self.subTest(cloud=name, limit=length, pieces=count):
                        one, _ = self.assert_as_one(points, count, MaximumEdgeLength=length)
                        self.assertLess(one.GetNumberOfPolys(), 1.9 * len(points))

    def test_a_limit_that_leaves_most_points_out_is_reported(self):
        points = clouds()["random"]
        whole = vtkGridDelaunay2D()
        whole.SetInputData(make_points(points))
        for length in (8.0, 0.001):
            warnings = []
            source = self.source(points, MaximumEdgeLength=length)
            whole.SetMaximumEdgeLength(length)
            for filter_, update in ((source, lambda: source.UpdatePiece(0, 4, 0)), (whole, whole.Update)):
                with Messages(filter_, filter_.GetExecutive()) as messages:
                    update()
                self.assertEqual((messages.errors, len(messages.warnings)), ([], 1))
                warnings.append(messages.warnings[0])
            self.assertIn("are left without a triangle", warnings[0])
            self.assertTrue(warnings[1].startswith(warnings[0]), warnings)  # with a better length

    def test_a_point_off_the_lattice_is_found_in_the_end(self):
        node = numpy.stack(numpy.meshgrid(numpy.arange(150.0), numpy.arange(140.0)), -1)
        points = numpy.column_stack((node.reshape(-1, 2) * 12.5, numpy.zeros(21000)))
        points[15000, 0] += 3.14159
        one, _ = self.assert_as_one(points, 5)
        self.assertIsNone(one.GetFieldData().GetArray("Lattice"))

    def test_slices_of_any_size_give_the_same(self):
        points = clouds()["tracks"]
        first, *others = (
            all_triangles(self.parts(self.source(points, at_once), 4))
            for at_once in (1, 333, 10**6)
        )
        for other in others:
            numpy.testing.assert_array_equal(first, other)

    def test_point_arrays_go_with_the_points(self):
        points = clouds()["random"]
        source = self.source(points[:0])
        for part in numpy.array_split(numpy.arange(len(points)), 3):
            data = make_points(points[part])
            add_array(data, "RGB", numpy.column_stack((part % 256,) * 3).astype("u1"))
            add_array(data, "Depth", part * 0.25)
            words = vtkStringArray()
            words.SetName("Name")
            for number in part.tolist():
                words.InsertNextValue(f"point {number}")
            data.GetPointData().AddArray(words)
            self.assertTrue(source.AddPoints(data))
        for part in self.parts(source, 4):
            ids, data = ids_of(part), part.GetPointData()
            numpy.testing.assert_array_equal(vtk_to_numpy(data.GetArray("Depth")), ids * 0.25)
            numpy.testing.assert_array_equal(vtk_to_numpy(data.GetArray("RGB"))[:, 1], ids % 256)
            names = data.GetAbstractArray("Name")
            words = [names.GetValue(i) for i in range(len(ids))]
            self.assertEqual(words, [f"point {i}" for i in ids])

    def test_pieces_can_be_asked_for_again_but_not_in_another_number(self):
        points = clouds()["random"]
        source = self.source(points)
        first = [all_triangles([part]) for part in self.parts(source, 3)]
        for one, other in zip(first, self.parts(source, 3)):
            numpy.testing.assert_array_equal(one, all_triangles([other]))
        errors = self.errors_of(source, lambda: source.UpdatePiece(0, 4, 0))
        self.assertIn("There are 3 pieces", errors[0])
        extra = make_points(points)
        errors = self.errors_of(source, lambda: self.assertFalse(source.AddPoints(extra)))
        self.assertIn("Points cannot be added", errors[0])

    def test_files_take_56_bytes_a_point_and_go_with_their_pieces(self):
        points = numpy.random.default_rng(8).random((60000, 3))
        expected = [all_triangles([part]) for part in self.parts(self.source(points), 5)]
        source = self.source(points, at_once=7000)
        source.KeepFilesOff()
        folder, sizes = source.GetFolder(), []

        def look(*_):
            sizes.append(sum(entry.stat().st_size for entry in os.scandir(folder)))

        tag = source.AddObserver("ProgressEvent", look)
        look()
        for i in range(5):
            source.UpdatePiece(i, 5, 0)
            numpy.testing.assert_array_equal(all_triangles([source.GetOutput()]), expected[i])
            look()
        source.RemoveObserver(tag)
        self.assertGreater(len(sizes), 20)
        self.assertGreater(sizes[0], 32 * len(points))
        self.assertLess(max(sizes), 62 * len(points))  # the rest is that of seams
        self.assertLess(sizes[-1], 0.02 * max(sizes))
        errors = self.errors_of(source, lambda: source.UpdatePiece(0, 5, 0))
        self.assertEqual(len(errors), 1)
        self.assertIn("Piece 0 has been made and its files removed", errors[0])
        source.Reset()
        self.assertEqual(os.listdir(folder), [])

    def test_reset_removes_the_files_and_begins_again(self):
        source = self.source(clouds()["random"])
        self.parts(source, 3)
        self.assertNotEqual(os.listdir(source.GetFolder()), [])
        source.Reset()
        self.assertEqual(os.listdir(source.GetFolder()), [])
        self.assertEqual(source.GetNumberOfPoints(), 0)
        self.assertEqual(source.GetNumberOfTriangles(), 0)
        few = clouds()["few"]
        self.assertTrue(source.AddPoints(make_points(few)))
        self.assertEqual(sum(part.GetNumberOfPolys() for part in self.parts(source, 2)),
                         source.GetNumberOfTriangles())

    def test_global_ids_that_are_given_are_those_of_pieces(self):
        """Slices overlap: points that come twice, with the same id or marked as others', count once."""
        points = clouds()["random"]
        points = points[numpy.isfinite(points).all(axis=1)]
        numbers = 2**40 + 7 * numpy.arange(len(points))

        def slice_of(begin, end, new, are_marked):
            data = make_points(points[begin:end])
            add_array(data, "Number", numbers[begin:end])
            data.GetPointData().SetActiveAttribute("Number", vtkDataSetAttributes.GLOBALIDS)
            if are_marked:
                add_array(data, GHOSTS, (numbers[begin:end] < numbers[new]).astype("u1"))
            return data

        whole = vtkGridDelaunay2D()
        whole.SetInputData(slice_of(0, len(points), 0, False))
        whole.Update()
        expected = sorted_triangles(numbers[triangles_of(whole.GetOutput())])
        for are_marked in (False, True):
            for count in (1, 4):
                source = self.source(())
                for new in range(0, len(points), 700):
                    data = slice_of(max(0, new - 100), new + 700, new, are_marked)
                    self.assertTrue(source.AddPoints(data))
                parts = self.parts(source, count)
                numpy.testing.assert_array_equal(all_triangles(parts), expected)
                own = numpy.concatenate([ids_of(part)[~ghosts_of(part)] for part in parts])
                numpy.testing.assert_array_equal(numpy.sort(own), numbers)
        source = self.source(points[:10])
        errors = self.errors_of(source, lambda: source.AddPoints(slice_of(0, 10, 0, False)))
        self.assertIn("same point arrays", errors[0])

    @unittest.skipUnless(os.path.isdir("/proc/self/fd"), "the system lists no open files")
    def test_no_file_stays_open(self):
        before = os.listdir("/proc/self/fd")
        source = self.source(clouds()["random"])
        self.parts(source, 3)
        self.assertEqual(len(os.listdir("/proc/self/fd")), len(before))

    def test_what_cannot_be_done_is_one_error(self):
        points = clouds()["random"]
        other = make_points(points)
        add_array(other, "Depth", points[:, 2])
        cases = (
            (None, make_points(points), "Folder is not set"),
            (self.path("nowhere"), make_points(points), "No such file or directory"),
            (self.folder, None, "no data set"),
            (os.path.dirname(self.empty_folder()), make_points(points), "is not an empty folder"),
        )
        for folder, data, words in cases:
            source = vtkReconstructPieces()
            source.SetFolder(folder or "")
            errors = self.errors_of(source, lambda: source.AddPoints(data))
            self.assertEqual(len(errors), 1)
            self.assertIn(words, errors[0])
        source = self.source(points)
        errors = self.errors_of(source, lambda: source.AddPoints(other))
        self.assertIn("same point arrays", errors[0])
        self.assertIn("Reset()", self.errors_of(source, lambda: source.UpdatePiece(0, 2, 0))[0])
        soft = make_lines([star((4e5, 4e5), 9.0)])
        soft.GetPoints().SetPoint(2, *soft.GetPoint(2)[:2], numpy.nan)
        source = self.source(points, SourceData=soft)
        self.assertIn("Constraints with points without z (NaN)",
                      self.errors_of(source, lambda: source.UpdatePiece(0, 2, 0))[0])
        for name, value, words in (
            ("MaximumEdgeLength", numpy.nan, "MaximumEdgeLength is nan"),
            ("MaximumElevationError", 1.0, "in memory, not for pieces"),
            ("MaximumNumberOfPoints", 9, "MaximumNumberOfPoints is for points in memory, not for pieces"),
            ("DrapeConstraints", True, "Constraints with DrapeConstraints are for points in memory"),
        ):
            source = self.source(points, SourceData=make_lines([star((4e5, 4e5), 9.0)]), **{name: value})
            errors = self.errors_of(source, lambda: source.UpdatePiece(0, 2, 0))
            self.assertIn(words, errors[0])
            self.assertEqual(source.GetOutput().GetNumberOfPoints(), 0)

    def test_a_lattice_that_is_given_is_that_of_all_points(self):
        points = clouds()["lattice"][::40]  # too few to find it
        given = (4e5, 5e6, 3.0, 0.5, -0.25, 2.0)
        for count in (1, 3, 6):
            one, parts = self.assert_as_one(points, count, Lattice=given)
            for part in parts:
                lattices = [data.GetFieldData().GetArray("Lattice") for data in (one, part)]
                self.assertEqual(*(lattice.GetTuple(0) for lattice in lattices))
        points[[55, 33, 44], 1] += 0.7
        whole = vtkGridDelaunay2D()
        whole.SetInputData(make_points(points))
        whole.SetLattice(given)
        source = self.source(points, at_once=20, Lattice=given)
        errors = self.errors_of(source, lambda: source.UpdatePiece(0, 3, 0))
        self.assertEqual(errors, self.errors_of(whole, whole.Update))
        self.assertRegex(errors[0], "^Point 33 at .*away from the nearest node")

    def test_what_can_be_put_right_loses_no_points(self):
        source = self.source(clouds()["random"])
        whole = self.source(clouds()["random"])
        self.parts(whole, 2)
        self.assertIn("no data set", self.errors_of(source, lambda: source.AddPoints(None))[0])
        errors = self.errors_of(source, lambda: source.SetFolder("elsewhere"))
        self.assertIn("Folder cannot be changed", errors[0])
        source.GetDelaunay().SetMaximumEdgeLength(-1.0)
        self.assertEqual(len(self.errors_of(source, lambda: source.UpdatePiece(0, 2, 0))), 1)
        source.GetDelaunay().SetMaximumEdgeLength(0.0)
        source.GetDelaunay().SetLattice(0.0, 0.0, 1.0, 1.0, 2.0, 2.0)
        errors = self.errors_of(source, lambda: source.UpdatePiece(0, 2, 0))
        self.assertIn("The given lattice has no nodes", errors[0])
        source.GetDelaunay().SetLattice([0.0] * 6)
        self.assertEqual(sum(part.GetNumberOfPolys() for part in self.parts(source, 2)),
                         whole.GetNumberOfTriangles())
        for piece in (2, -1):
            self.assertEqual(self.errors_of(source, lambda: source.UpdatePiece(piece, 2, 0)), [])
            self.assertEqual(source.GetOutput().GetNumberOfPoints(), 0)
        source.GetDelaunay().SetLatticeTolerance(0.1)
        errors = self.errors_of(source, lambda: source.UpdatePiece(0, 2, 0))
        self.assertIn("Properties were changed after the first piece", errors[0])

    def test_a_stop_leaves_empty_output(self):
        source = self.source(clouds()["random"])
        source.AddObserver("ProgressEvent", lambda caller, _: caller.SetAbortExecute(1))
        with Messages(source, source.GetExecutive()) as messages:
            source.UpdatePiece(0, 3, 0)
        self.assertEqual((messages.errors, len(messages.warnings)), ([], 1))
        self.assertEqual(source.GetOutput().GetNumberOfPoints(), 0)
        source.RemoveAllObservers()
        source.Reset()
        self.assertTrue(source.AddPoints(make_points(clouds()["random"])))
        self.assertEqual(len(self.parts(source, 3)), 3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
