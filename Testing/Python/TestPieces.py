# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces in pieces: together they have the triangles of all points at once."""

import gzip
import json
import os
import re
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import numpy
from in_folder import InFolder, Program
from meshes import GHOSTS, by_places, ghosts_of, sorted_rows, sorted_triangles, triangles_of
from vtkelevationsurface import (
    pieces,
    reading,
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)
from vtkelevationsurface.clouds import Cloud, add_array, make_lines, make_points
from vtkelevationsurface.messages import FileError, Messages
from vtkelevationsurface.reading import text
from vtkelevationsurface.reading.slicing import read_files
from vtkelevationsurface.vtkElevationSurfacePieces import vtkReconstructPieces
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes
from vtkmodules.vtkIOXML import vtkXMLPartitionedDataSetReader, vtkXMLPolyDataReader

TRIANGULATION_ONLY = ("--no-trim", "--no-fill")
COUNTS = ("DuplicatePoints", "NonFinitePoints")
ARRAYS = ("Velocity", "Depth", "RGB", "FilledPoint", "FilledError")  # of a surface that is filled


def ids_of(data):
    return vtk_to_numpy(data.GetPointData().GetGlobalIds())


def all_triangles(parts):
    """The triangles of pieces, by global ids."""
    return sorted_triangles(numpy.concatenate([ids_of(part)[triangles_of(part)] for part in parts]))


def clouds():
    """{name: (n, 3)} of every kind, in no order, with duplicates and what is not finite."""
    rng = numpy.random.default_rng(7)
    node = numpy.stack(numpy.meshgrid(numpy.arange(60.0), numpy.arange(50.0)), -1).reshape(-1, 2)
    node = node[rng.permutation(len(node))[:2400]]
    along = rng.random(2000) * 900.0
    tracks = numpy.column_stack((numpy.repeat(numpy.arange(20) * 50.0, 100), along))
    found = {
        "random": rng.random((3000, 2)) * 1000.0 + 4e5,
        "lattice": node @ numpy.array([[3.0, 0.5], [-0.25, 2.0]]) + (4e5, 5e6),
        "clustered": rng.normal(size=(3000, 2)) ** 5,
        "tracks": tracks,
        "few": rng.random((5, 2)),
        "almost a lattice": numpy.vstack((node, node + (0.3, 0.2))) * 25.0,
    }
    for name, xy in found.items():
        if len(xy) > 5:
            xy[-40:] = xy[:40]
        found[name] = numpy.column_stack((xy, rng.integers(0, 100, len(xy)) * 0.5))
        if len(xy) > 5:
            found[name][rng.integers(0, len(xy), 30), rng.integers(0, 3, 30)] = numpy.nan
    return found


class WithFilter(InFolder):
    """What tests of the filter share."""

    def empty_folder(self):
        return tempfile.mkdtemp(dir=self.folder)

    def source(self, points, at_once=900, **properties):
        source = vtkReconstructPieces()
        source.SetFolder(self.empty_folder())
        for name, value in properties.items():
            getattr(source.GetDelaunay(), "Set" + name)(value)
        for first in range(0, len(points), at_once):
            self.assertTrue(source.AddPoints(make_points(points[first : first + at_once])))
        return source

    def parts(self, source, count):
        result = []
        for i in range(count):
            source.UpdatePiece(i, count, 0)
            part = source.GetOutput().NewInstance()
            part.ShallowCopy(source.GetOutput())
            if part.GetNumberOfPoints():
                result.append(part)
        return result

    def assert_one_owner(self, parts, given, new):
        """Each point is one piece's own; new ones have ids after those given, and one place each."""
        own = numpy.concatenate([ids_of(part)[~ghosts_of(part)] for part in parts])
        numpy.testing.assert_array_equal(numpy.sort(own), numpy.arange(given + new))
        places = {}
        for part in parts:
            here = vtk_to_numpy(part.GetPoints().GetData())
            for number, place in zip(ids_of(part).tolist(), here.tolist()):
                if number >= given:
                    self.assertEqual(places.setdefault(number, place), place)

    def errors_of(self, source, work):
        with Messages(source, source.GetExecutive()) as messages:
            work()
        return messages.errors


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
        for name, value, words in (
            ("MaximumEdgeLength", numpy.nan, "MaximumEdgeLength is nan"),
            ("MaximumElevationError", 1.0, "in memory, not for pieces"),
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


def star(centre, radius, points=240):
    """A closed ring with waves, as (n, 3) array."""
    turn = numpy.linspace(0.0, 2 * numpy.pi, points + 1)
    reach = radius * (1.0 + 0.2 * numpy.sin(7 * turn))
    ring = numpy.column_stack((reach * numpy.cos(turn), reach * numpy.sin(turn), 0 * turn))
    ring[-1] = ring[0]
    return ring + (*centre, 0.0)


class Constrained(WithFilter):
    """Pieces with lines that become edges."""

    def lines(self, points, count=9):
        """Long lines in all directions, which few edges follow, a ring, and a line through points."""
        points = points[numpy.isfinite(points).all(axis=1)]
        rng, low = numpy.random.default_rng(4), points.min(axis=0)
        places = low + (points.max(axis=0) - low) * (1.2 * rng.random((2 * count, 3)) - 0.1)
        middle = points.mean(axis=0)
        return make_lines([*places.reshape(count, 2, 3), star(middle[:2], 0.2 * numpy.ptp(points[:, 0]), 30),
                           points[100:103]])

    def both(self, points, lines, count, **properties):
        """(one run in memory, a source of pieces, the pieces)"""
        one = vtkGridDelaunay2D()
        for name, value in properties.items():
            getattr(one, "Set" + name)(value)
        one.SetInputData(make_points(points))
        one.SetSourceData(lines)
        one.Update()
        source = self.source(points, SourceData=lines, **properties)
        return one, source, self.parts(source, count)

    def test_the_triangles_are_those_of_all_points_at_once(self):
        for name in ("random", "lattice", "clustered", "tracks", "few"):
            points = clouds()[name]
            lines = self.lines(points) if name != "few" else make_lines([points[:2], points[:3] + 0.1])
            for limit in (0.0, 0.1 * numpy.ptp(points[:, 0][numpy.isfinite(points[:, 0])])):
                for count in (1, 2, 7, 16):
                    with self.subTest(cloud=name, pieces=count, limit=limit):
                        one, source, parts = self.both(points, lines, count, MaximumEdgeLength=limit)
                        found = sorted_rows(numpy.concatenate([by_places(part) for part in parts]))
                        numpy.testing.assert_array_equal(found, by_places(one.GetOutput()))
                        for counted in ("AddedPoints", "ConstraintCrossings", "DuplicatePoints"):
                            self.assertEqual(
                                *(getattr(f, "GetNumberOf" + counted)() for f in (source, one)))
                        fields = [part.GetFieldData().GetArray("NumberOfAddedPoints") for part in parts]
                        self.assertEqual(
                            sum(int(field.GetValue(0)) for field in fields), one.GetNumberOfAddedPoints())
                        self.assert_one_owner(parts, len(points), one.GetNumberOfAddedPoints())

    def test_a_surface_with_lines_is_trimmed_and_filled_as_in_memory(self):
        points = clouds()["random"]
        lines, rings = self.lines(points, 5), make_lines(Filled.rings(None, points))
        whole, trim, fill = vtkGridDelaunay2D(), vtkTrimOutwardTriangles(), vtkFillElevationHoles()
        whole.SetInputData(make_points(points))
        whole.SetSourceData(lines)
        trim.SetInputConnection(whole.GetOutputPort())
        trim.SetBoundaryData(rings)
        fill.SetInputConnection(trim.GetOutputPort())
        fill.FillCutOutsOn()
        fill.Update()
        for count in (1, 5):
            source = self.source(points, SourceData=lines)
            source.SetFillHoles(True)
            source.GetTrim().SetBoundaryData(rings)
            source.GetFill().FillCutOutsOn()
            parts = self.parts(source, count)
            found = sorted_rows(numpy.concatenate([by_places(part) for part in parts]))
            numpy.testing.assert_array_equal(found, by_places(fill.GetOutput()))
            self.assertGreaterEqual(source.GetNumberOfFilledHoles(), 3)
            new = sum(
                int(vtk_to_numpy(part.GetPointData().GetArray("FilledPoint")).sum()) for part in parts)
            added = source.GetNumberOfAddedPoints()
            self.assertGreater(min(new, added, source.GetNumberOfInsertedPoints()), 20)
            self.assert_one_owner(parts, len(points), added + source.GetNumberOfInsertedPoints() + new)

    def test_warnings_and_errors_on_lines_are_those_of_one_run(self):
        points = clouds()["random"]
        far = make_lines([numpy.array([(4e5, 4e5, 1.0), (400500.0, 400500.0, 2.0), *((4e5 - 9e3 * i, 4e5, 0) for i in range(1, 9))])])
        for lines, words in (
            (far, "lie far outside the points"),
            (make_lines([numpy.zeros((2, 3))]), "do not overlap the points"),
            (make_points(points), "have no line and no polygon"),
        ):
            whole = vtkGridDelaunay2D()
            whole.SetInputData(make_points(points))
            whole.SetSourceData(lines)
            source = self.source(points, SourceData=lines)
            reported = []
            for filter_, update in ((source, lambda: source.UpdatePiece(0, 4, 0)), (whole, whole.Update)):
                with Messages(filter_, filter_.GetExecutive()) as messages:
                    update()
                reported.append((messages.errors, messages.warnings))
            self.assertEqual(*reported)
            self.assertIn(words, sum(reported[0], [])[0])

    def test_progress_rises_and_a_stop_leaves_empty_output(self):
        points = clouds()["random"]
        lines = self.lines(points)
        source, fractions = self.source(points, SourceData=lines), []
        source.AddObserver("ProgressEvent", lambda *_: fractions.append(source.GetProgress()))
        source.UpdatePiece(0, 4, 0)
        self.assertEqual(fractions, sorted(fractions))
        for when in numpy.linspace(0.1, 0.89, 12):
            source = self.source(points, SourceData=lines)
            source.AddObserver(
                "ProgressEvent",
                lambda caller, _, when=when: caller.SetAbortExecute(bool(caller.GetProgress() >= when)),
            )
            with Messages(source, source.GetExecutive()) as messages:
                source.UpdatePiece(0, 4, 0)
            self.assertEqual((messages.errors, len(messages.warnings)), ([], 1))
            self.assertEqual(source.GetOutput().GetNumberOfPoints(), 0)
            source.Reset()
            self.assertEqual(os.listdir(source.GetFolder()), [])


class Trimmed(WithFilter):
    """Pieces that are trimmed along a boundary."""

    def rings(self, points):
        """A coast and a lake that cross the cells of pieces."""
        points = points[numpy.isfinite(points).all(axis=1)]
        middle, extent = points.mean(axis=0), numpy.ptp(points[:, :2], axis=0).min()
        coast = star(middle[:2], 0.38 * extent)
        return [coast, star(middle[:2] + 0.06 * extent, 0.08 * extent, 40)]

    def assert_trimmed_as_one(self, points, rings, count, **properties):
        whole, one = vtkGridDelaunay2D(), vtkTrimOutwardTriangles()
        whole.SetInputData(make_points(points))
        one.SetInputConnection(whole.GetOutputPort())
        one.SetBoundaryData(make_lines(rings))
        source = self.source(points)
        source.GetTrim().SetBoundaryData(make_lines(rings))
        for name, value in properties.items():
            getattr(one, "Set" + name)(value)
            getattr(source.GetTrim(), "Set" + name)(value)
        one.Update()
        parts = self.parts(source, count)
        found = sorted_rows(numpy.concatenate([by_places(part) for part in parts]))
        numpy.testing.assert_array_equal(found, by_places(one.GetOutput()))
        for name in ("OutwardTriangles", "RecoveredEdges", "InsertedPoints"):
            counts = [getattr(f, "GetNumberOf" + name)() for f in (source, one)]
            self.assertEqual(*counts)
        self.assertEqual(source.GetNumberOfBoundaryRings(), one.GetOutput(2).GetNumberOfLines())
        self.assertEqual(source.GetNumberOfTrimmedTriangles(), len(found))
        return source, parts

    def test_the_triangles_are_those_of_one_surface_that_is_trimmed(self):
        for name in ("random", "lattice", "tracks"):
            points = clouds()[name]
            for count in (1, 2, 7, 16):
                with self.subTest(cloud=name, pieces=count):
                    source, _ = self.assert_trimmed_as_one(points, self.rings(points), count)
                    self.assertGreater(source.GetNumberOfInsertedPoints(), 0)

    def test_inserted_points_have_ids_and_one_owner(self):
        points = clouds()["random"]
        source, parts = self.assert_trimmed_as_one(points, self.rings(points), 6)
        self.assert_one_owner(parts, len(points), source.GetNumberOfInsertedPoints())

    def test_corners_of_the_boundary_have_its_values_where_they_belong(self):
        """Also in pieces without a triangle."""
        points = numpy.array([[0.0, 0.0, 1.0], [9.0, 1.0, 2.0], [4.0, 8.0, 3.0]])
        ring = points[[0, 1, 2, 0]] + (0.0, 0.0, 5.0)
        for count in (1, 2, 3):
            source = self.source(points)
            source.GetTrim().SetBoundaryData(make_lines([ring]))
            source.GetTrim().SetBoundaryEdges(2)
            parts = self.parts(source, count)
            self.assertEqual(len(parts), count)
            for part in parts:
                self.assertEqual(set(vtk_to_numpy(part.GetPointData().GetArray("OnBoundary"))), {1})
                here = vtk_to_numpy(part.GetPoints().GetData())
                numpy.testing.assert_array_equal(here, points[ids_of(part)] + (0.0, 0.0, 5.0))

    def test_progress_rises(self):
        points = clouds()["random"]
        source = self.source(points)
        source.GetTrim().SetBoundaryData(make_lines(self.rings(points)))
        for i in range(3):
            fractions = []
            tag = source.AddObserver("ProgressEvent", lambda *_: fractions.append(source.GetProgress()))
            source.UpdatePiece(i, 3, 0)
            source.RemoveObserver(tag)
            self.assertEqual(fractions, sorted(fractions))
            along = sum(0.83 < one < 0.89 for one in fractions)  # the work along the boundary
            self.assertGreater(along, 5 if i == 0 else -1)

    def test_a_test_of_triangles_for_memory_can_be_put_right(self):
        points = clouds()["random"]
        source = self.source(points)
        source.GetTrim().SetBoundaryData(make_lines(self.rings(points)))
        source.GetTrim().SetOutwardTest(1)
        errors = self.errors_of(source, lambda: source.UpdatePiece(0, 3, 0))
        self.assertIn("InwardNormal is for a surface in memory", errors[0])
        source.GetTrim().SetOutwardTest(0)
        self.assertEqual(self.errors_of(source, lambda: source.UpdatePiece(0, 3, 0)), [])
        self.assertGreater(source.GetOutput().GetNumberOfPolys(), 0)

    def test_what_a_boundary_cannot_do_is_one_error(self):
        points = clouds()["random"]
        rings = self.rings(points)
        for ring, values, words in (
            (rings[0][:-7], {}, "closed"),
            (rings[0] + (1e6, 0.0, 0.0), {}, "encloses no triangle"),
            (rings[0], {"RecoverBoundary": False}, "RecoverBoundary"),
        ):
            source = self.source(points)
            source.GetTrim().SetBoundaryData(make_lines([ring]))
            for name, value in values.items():
                getattr(source.GetTrim(), "Set" + name)(value)
            errors = self.errors_of(source, lambda: source.UpdatePiece(0, 3, 0))
            self.assertEqual(len(errors), 1)
            self.assertIn(words, errors[0])
            self.assertEqual(source.GetOutput().GetNumberOfPoints(), 0)


class Filled(WithFilter):
    """Pieces whose holes are filled."""

    def rings(self, points):
        """A coast, and lakes of many sizes that cross the cells of pieces."""
        points = points[numpy.isfinite(points).all(axis=1)]
        middle, extent = points.mean(axis=0)[:2], numpy.ptp(points[:, :2], axis=0).min()
        lakes = ((0.0, 0.0, 0.1), (0.2, 0.05, 0.04), (-0.2, 0.1, 0.06), (0.05, -0.2, 0.02), (0.0, 0.2, 0.05))
        return [star(middle, 0.38 * extent)] + [
            star(middle + (x * extent, y * extent), radius * extent, int(20 + 200 * radius))
            for x, y, radius in lakes]

    def points_of(self, points):
        """With arrays of which two are interpolated, not in the order of their names."""
        data = make_points(points)
        if points.dtype == numpy.float32:
            places = vtkPoints()
            places.SetData(numpy_to_vtk(points, deep=True))
            data.SetPoints(places)
        add_array(data, "Velocity", numpy.cos(points[:, 1] / 40.0))
        add_array(data, "Depth", numpy.sin(points[:, 0] / 30.0))
        add_array(data, "RGB", numpy.column_stack((numpy.arange(len(points)) % 251,) * 3).astype("u1"))
        return data

    def source_of(self, points, rings, count, warnings=0, limit=0.0, edges=0, **properties):
        source = vtkReconstructPieces()
        source.SetFolder(self.empty_folder())
        source.SetFillHoles(True)
        source.GetFill().FillCutOutsOn()
        source.GetDelaunay().SetMaximumEdgeLength(limit)
        self.assertTrue(source.AddPoints(self.points_of(points)))
        if rings:
            source.GetTrim().SetBoundaryData(make_lines(rings))
            source.GetTrim().SetBoundaryEdges(edges)
        for name, value in properties.items():
            getattr(source.GetFill(), "Set" + name)(value)
        with Messages(source, source.GetExecutive()) as messages:
            parts = self.parts(source, count)
        self.assertEqual((messages.errors, len(messages.warnings)), ([], warnings))
        return source, parts

    def assert_filled_as_one(self, points, rings, count, limit=0.0, edges=0, **properties):
        whole, trim, one = vtkGridDelaunay2D(), vtkTrimOutwardTriangles(), vtkFillElevationHoles()
        whole.SetInputData(self.points_of(points))
        whole.SetMaximumEdgeLength(limit)
        trim.SetInputConnection(whole.GetOutputPort())
        if rings:
            trim.SetBoundaryData(make_lines(rings))
            trim.SetBoundaryEdges(edges)
        one.SetInputConnection((trim if rings else whole).GetOutputPort())
        one.FillCutOutsOn()
        for name, value in properties.items():
            getattr(one, "Set" + name)(value)
        with Messages(one, one.GetExecutive()) as messages:
            one.Update()
        source, parts = self.source_of(
            points, rings, count, len(messages.warnings), limit, edges, **properties)
        found = sorted_rows(numpy.concatenate([by_places(part) for part in parts]))
        numpy.testing.assert_array_equal(found, by_places(one.GetOutput()))
        self.assertEqual(source.GetNumberOfFilledTriangles(), len(found))
        for name in ("Holes", "FilledHoles"):
            counts = [getattr(f, "GetNumberOf" + name)() for f in (source, one)]
            self.assertEqual(*counts)
        numpy.testing.assert_array_equal(point_rows(parts), point_rows([one.GetOutput()]))
        self.assertEqual({part.GetPoints().GetDataType() for part in parts},
                         {one.GetOutput().GetPoints().GetDataType()})
        source.UpdatePiece(0, count, 0)
        self.assertIsNone(source.GetOutput(1).GetPointData().GetArray("vtkGhostType"))
        self.assertEqual(*(sorted(hole_rows(f.GetOutput(1))) for f in (source, one)))
        self.assertEqual(
            *(sorted(vtk_to_numpy(d.GetPointData().GetArray("Depth")).tolist())
              for d in (source.GetOutput(1), one.GetOutput(1))))
        return source, parts

    def test_the_surface_is_that_of_one_run_to_the_last_bit(self):
        for name in ("random", "lattice", "tracks"):
            points = clouds()[name]
            for count in (1, 2, 7, 16):
                with self.subTest(cloud=name, pieces=count):
                    source, _ = self.assert_filled_as_one(points, self.rings(points), count)
                    self.assertGreaterEqual(source.GetNumberOfFilledHoles(), 3)

    def test_voids_that_a_limit_of_edges_leaves_are_filled(self):
        points = clouds()["random"]
        middle = points[numpy.isfinite(points).all(axis=1)].mean(axis=0)[:2]
        for x, y, radius in ((0.0, 0.0, 80.0), (150.0, 100.0, 50.0), (-120.0, 120.0, 60.0)):
            away = numpy.hypot(*(points[:, :2] - middle - (x, y)).T) > radius
            points = points[away | ~numpy.isfinite(points).all(axis=1)]
        coast = [star(middle, 350.0)]
        for count in (1, 4, 9):
            source, _ = self.assert_filled_as_one(points, coast, count, 65.0)
            self.assertGreaterEqual(source.GetNumberOfFilledHoles(), 3)
        source, _ = self.assert_filled_as_one(points, coast, 9, 45.0)
        self.assertGreater(source.GetNumberOfFilledHoles(), 10)

    def test_tiny_holes_take_little_of_the_surface(self):
        points = numpy.random.default_rng(8).random((20000, 3)) * (1000.0, 1000.0, 9.0)
        coast = [star((500.0, 500.0), 400.0)]
        for radius in (1.0, 0.01):  # to be filled takes points that are about 7 apart
            ponds = [star((x, y), radius, 40) for x in (310.0, 520.0) for y in (420.0, 660.0)]
            self.assert_filled_as_one(points, coast + ponds, 5)
            sizes = []
            source = self.source(points)
            source.SetFillHoles(True)
            source.GetFill().FillCutOutsOn()
            source.GetTrim().SetBoundaryData(make_lines(coast + ponds))
            folder = source.GetFolder()
            source.AddObserver("ProgressEvent", lambda *_, folder=folder, sizes=sizes: sizes.append(
                sum(file.stat().st_size for file in os.scandir(folder) if "surrounding" in file.name)))
            source.UpdatePiece(0, 5, 0)
            self.assertEqual(source.GetNumberOfFilledHoles(), 4)
            self.assertGreater(max(sizes), 0)
            self.assertLess(max(sizes), 200_000)  # all triangles take 2 MB

    def test_points_of_float_stay_so(self):
        points = clouds()["random"]
        points[:, :2] -= 4e5
        points = points.astype("f4")
        for rings in (None, self.rings(points)):
            source, _ = self.assert_filled_as_one(points, rings, 5, 45.0)
            self.assertGreater(source.GetNumberOfFilledHoles(), 10)

    def test_values_are_of_the_first_of_equally_near_points(self):
        rng = numpy.random.default_rng(3)
        points = rng.integers(0, 40, (1500, 3)).astype(float)
        turn = numpy.arange(0.0, 360.0, 45.0) * numpy.pi / 180.0
        lakes = [numpy.column_stack((x + 0.5 * numpy.round(4 * numpy.cos(turn)),
                                     y + 0.5 * numpy.round(4 * numpy.sin(turn)), 0 * turn))
                 for x in range(6, 36, 7) for y in range(6, 36, 7)]
        edge = numpy.array([(-9, -9, 0), (49, -9, 0), (49, 49, 0), (-9, 49, 0)], float)
        rings = [numpy.vstack((ring, ring[:1])) for ring in (edge, *lakes)]
        for count in (2, 5, 9):
            self.assert_filled_as_one(points, rings, count, 3.5)

    def test_all_properties_of_the_filter_are_minded(self):
        points = clouds()["random"]
        rings = self.rings(points)
        for name, value, filled in (
            ("MaximumHoleSize", 150.0, 2),
            ("MaximumHoleEdges", 30, 3),
            ("Spacing", 40.0, 5),
            ("Interpolation", 1, 5),
            ("InterpolatePointData", False, 5),
            ("MaximumNumberOfInsertedPoints", 150, 3),
            ("FillCutOuts", False, 0),
            ("NumberOfThreads", 2, 5),
        ):
            with self.subTest(property=name):
                straight = vtkTrimOutwardTriangles.STRAIGHT
                source, _ = self.assert_filled_as_one(
                    points, rings, 5, edges=straight, **{name: value})
                self.assertEqual(source.GetNumberOfFilledHoles(), filled)

    def test_new_points_have_ids_and_one_owner(self):
        points = clouds()["random"]
        source, parts = self.assert_filled_as_one(points, self.rings(points), 6)
        new = sum(
            int(vtk_to_numpy(part.GetPointData().GetArray("FilledPoint")).sum()) for part in parts)
        self.assertGreater(new, 50)
        self.assert_one_owner(parts, len(points), source.GetNumberOfInsertedPoints() + new)

    def test_files_go_and_pieces_can_be_asked_for_again(self):
        points = clouds()["random"]
        source, parts = self.source_of(points, self.rings(points), 4)
        again = self.parts(source, 4)
        for one, other in zip(parts, again):
            numpy.testing.assert_array_equal(by_places(one), by_places(other))
        self.assertFalse([name for name in os.listdir(source.GetFolder()) if "surrounding" in name])
        source.Reset()
        self.assertEqual(os.listdir(source.GetFolder()), [])

    def test_a_surface_without_holes_is_as_it_was(self):
        points = clouds()["lattice"]
        source, parts = self.source_of(points, None, 3)
        self.assertEqual(source.GetNumberOfHoles(), 0)
        numpy.testing.assert_array_equal(
            all_triangles(parts), all_triangles(self.parts(self.source(points), 3)))

    def test_what_cannot_be_done_is_one_error_and_can_be_put_right(self):
        points = clouds()["random"]
        source = self.source(points)
        source.SetFillHoles(True)
        source.GetFill().FillCutOutsOn()
        source.GetFill().SetOpenEdgeLength(-1.0)
        errors = self.errors_of(source, lambda: source.UpdatePiece(0, 3, 0))
        self.assertEqual(len(errors), 1)
        self.assertIn("OpenEdgeLength is -1", errors[0])
        source.GetFill().SetOpenEdgeLength(0.0)
        self.assertEqual(self.errors_of(source, lambda: source.UpdatePiece(0, 3, 0)), [])
        source.SetFillHoles(False)
        errors = self.errors_of(source, lambda: source.UpdatePiece(0, 3, 0))
        self.assertIn("Properties were changed after the first piece", errors[0])

    def test_a_stop_at_any_time_leaves_empty_output(self):
        points = clouds()["random"]
        for when in (0.5, 0.6, 0.7, 0.75, 0.78, 0.8, 0.82, 0.84, 0.86, 0.9):
            source = self.source(points)
            source.SetFillHoles(True)
            source.GetFill().FillCutOutsOn()
            source.GetTrim().SetBoundaryData(make_lines(self.rings(points)))
            source.AddObserver(
                "ProgressEvent",
                lambda caller, _, when=when: caller.SetAbortExecute(caller.GetProgress() >= when),
            )
            with Messages(source, source.GetExecutive()) as messages:
                source.UpdatePiece(0, 4, 0)
            self.assertEqual((messages.errors, len(messages.warnings)), ([], 1))
            self.assert_empty_until_reset(source)

    def assert_empty_until_reset(self, source):
        for port in (0, 1):
            self.assertEqual(source.GetOutput(port).GetNumberOfPoints(), 0)
        source.Reset()
        self.assertEqual(os.listdir(source.GetFolder()), [])

    def test_a_full_disk_is_one_error_that_leaves_no_file(self):
        points = clouds()["random"]
        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        files = set()
        for most in (35_000, 70_000, 110_000):
            source = self.source(points)
            source.SetFillHoles(True)
            source.GetFill().FillCutOutsOn()
            source.GetTrim().SetBoundaryData(make_lines(self.rings(points)))
            try:
                resource.setrlimit(resource.RLIMIT_FSIZE, (most, before[1]))
                errors = self.errors_of(source, lambda: source.UpdatePiece(0, 4, 0))
            finally:
                resource.setrlimit(resource.RLIMIT_FSIZE, before)
            self.assertEqual(len(errors), 1)
            files.add(re.search("/([a-z]+)-[0-9]+ cannot be written: File too large", errors[0])[1])
            self.assert_empty_until_reset(source)
        self.assertIn("surrounding", files)


def point_rows(parts):
    """The owned points of pieces with their values, in one order; a single surface has no ghosts."""
    rows = []
    for part in parts:
        data = part.GetPointData()
        columns = [vtk_to_numpy(part.GetPoints().GetData())]
        columns += [vtk_to_numpy(data.GetArray(n)) for n in ARRAYS]
        rows.append(numpy.column_stack(columns)[~ghosts_of(part)])
    return sorted_rows(numpy.nan_to_num(numpy.concatenate(rows), nan=-1e99))


def hole_rows(rims):
    """The report on each hole, but its number, which follows the order of triangles."""
    cells = rims.GetCellData()
    names = ("Status", "NumberOfEdges", "Perimeter", "Area", "NumberOfInsertedPoints", "Interpolation")
    return list(zip(*(vtk_to_numpy(cells.GetArray(name)).tolist() for name in names)))


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
        with mock.patch.object(text, "BLOCK", 3000):
            cloud = self.assert_as_whole(path)
            self.assertIn("left out: Depth", cloud.notes)
            self.assert_as_whole(path, no_data=5.0, depth=True)
            self.assert_as_whole(path, columns=("1", "2", "4"))
            self.assert_as_whole(path, where={"depth": list(range(100, 4000, 7))})
            with self.assertRaisesRegex(FileError, "no column name besides x, y and z; columns: D"):
                slice_points(path, Cloud(None), where="name=a")
        rows = [f"{i % 70},{i // 70},{i % 11},{'abc'[i % 3]}" for i in range(5000)]
        path = self.file("words.csv", "\n".join(["X,Y,Z,name", *rows]))
        with mock.patch.object(text, "BLOCK", 3000):
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


class Command(Program):
    """The program with --pieces and --memory."""

    def npy(self, name, points):
        numpy.save(self.path(name), points)
        return name

    def parts(self, name):
        """The pieces of a .vtpd file, each read by itself as its global ids are known then."""
        reader = vtkXMLPartitionedDataSetReader()
        reader.SetFileName(self.path(name))
        reader.Update()
        found = [reader.GetOutput().GetPartition(i)
                 for i in range(reader.GetOutput().GetNumberOfPartitions())]
        self.assertTrue(all(part.GetPointData().GetGlobalIds() for part in found))
        return found

    def json(self, name):
        with open(self.path(name), encoding="utf-8") as stream:
            return json.load(stream)

    def test_the_pieces_have_the_surface_and_the_report_of_one_run(self):
        for kind in ("random", "lattice"):
            name = self.npy(f"{kind}.npy", clouds()[kind])
            options = (*TRIANGULATION_ONLY, "--report", "--duplicates", "keep-highest")
            all_points = "--no-remove-unused-points"  # pieces have them
            self.assertEqual(self.call(name, "--no-picture", all_points, *options).returncode, 0)
            whole = self.json(f"{kind}_surface.json")
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(self.path(f"{kind}_surface.vtp"))
            reader.Update()
            done = self.call(name, "--pieces", "5", *options)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("in 5 pieces", done.stdout)
            numpy.testing.assert_array_equal(
                all_triangles(self.parts(f"{kind}_surface.vtpd")),
                sorted_triangles(triangles_of(reader.GetOutput())),
            )
            report = self.json(f"{kind}_surface.json")
            for key in ("points", "unused_reasons", "unused", "lattice", "triangles", "left_out",
                        "bounds", "crs", "lattice_mode", "points_unused"):
                self.assertEqual(report[key], whole[key], key)

    def test_the_report_of_trimmed_pieces_is_that_of_one_run(self):
        name = self.npy("a.npy", clouds()["random"])
        ring = star((400500.0, 400500.0), 380.0)
        self.file("coast.txt", "".join(f"{x!r} {y!r}\n" for x, y, _ in ring.tolist()))
        options = ("--boundary", "coast.txt", "--no-fill", "--report", "--no-picture")
        self.assertEqual(self.call(name, *options).returncode, 0)
        whole = self.json("a_surface.json")
        done = self.call(name, "--pieces", "4", *options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        report = self.json("a_surface.json")
        for key in ("points", "unused_reasons", "unused", "points_unused", "triangles", "trim",
                    "bounds"):
            self.assertEqual(report[key], whole[key], key)
        self.assertGreater(report["unused_reasons"]["outside the boundary"], 100)
        self.file("open.txt", "1 1\n2 2\n3 1\n4 4\n")
        done = self.call(name, "--pieces", "4", "--boundary", "open.txt", "--no-fill")
        self.assertIn("open.txt: the part from line 1 to 4 is not closed", done.stderr)
        self.file("nulls.xyz", "".join(f"{i % 40} {i // 40} {-9999 if i > 700 else i % 7}\n" for i in range(1000)))
        done = self.call("nulls.xyz", "--pieces", "4", "--boundary", "open.txt")  # read first
        self.assertIn("open.txt: the part from line 1", done.stderr)
        self.file("far.txt", "1 1\n2 2\n3 1\n1 1\n")
        done = self.call(name, "--pieces", "4", "--boundary", "far.txt", "--no-fill")
        self.assertIn("far.txt: trimming: The boundary", done.stderr)

    def test_the_outline_that_is_found_is_that_of_one_run(self):
        points = clouds()["random"]
        places = points[:, :2] - (400600.0, 400500.0)
        name = self.npy("a.npy", points[~(numpy.hypot(*places.T) < 150.0)])
        for ways in (("--no-fill",), ("--open-edge-length", "0"), ("--no-fill", "--gap-tolerance", "3")):
            reported = []
            for way in (("--no-picture",), ("--pieces", "4")):
                done = self.call(name, *ways, *way, "--report")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                report = self.json("a_surface.json")
                reported.append([line for line in done.stdout.splitlines()
                             if not re.match("  (time|distance|written)|  +in 4 pieces", line)])
                reported.append({key: report[key] for key in ("unused_reasons", "unused", "triangles", "trim", "bounds")})
            self.assertEqual(reported[:2], reported[2:])
            self.assertEqual(reported[1]["trim"]["boundary"], "found from the points")
            self.assertGreater(reported[1]["trim"]["outward_triangles"], 20)
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(self.path("a_surface.vtp"))
            reader.Update()
            numpy.testing.assert_array_equal(
                sorted_rows(numpy.concatenate([by_places(part) for part in self.parts("a_surface.vtpd")])),
                by_places(reader.GetOutput()),
            )

    def test_faults_are_edges_and_reported_as_by_one_run(self):
        points = clouds()["random"]
        points[:, 2] += 100.0
        name = self.npy("a.npy", points)
        lines = [points[[5, 900]] + (3.0, 0.0, 1.0), points[[7, 60]] + (0.0, 4.0, 2.0)]
        rows = ["".join("%r %r %r\n" % tuple(place) for place in line.tolist()) for line in lines]
        self.file("f.txt", "\n".join(rows))
        self.file("bare.txt", "\n".join(re.sub(" [^ ]*\n", "\n", text) for text in rows))
        self.file("zero.txt", "\n".join(re.sub(" [^ ]*\n", " 0\n", text) for text in rows))
        self.file("high.txt", "\n".join(re.sub(" [^ ]*\n", " 9000\n", text) for text in rows))
        for faults in ("f.txt", "high.txt"):
            options = ("--faults", faults, *TRIANGULATION_ONLY, "--report")
            self.assertEqual(self.call(name, *options, "--no-picture").returncode, 0)
            whole = self.json("a_surface.json")
            done = self.call(name, "--pieces", "4", *options)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            report = self.json("a_surface.json")
            for key in ("points", "unused", "triangles", "bounds", "faults"):
                self.assertEqual(report[key], whole[key], key)
            self.assertEqual([note for note in report["notes"] if "faults" in note],
                             [note for note in whole["notes"] if "faults" in note])
            self.assertGreater(report["faults"]["added_points"], 0)
        for options, words in (
            (("--faults", "bare.txt"), "bare.txt: 2 of 2 lines without z (first: "),
            (("--faults", "zero.txt"), "zero.txt: z of its lines is 0 everywhere"),
            (("--faults", "f.txt", "--faults-z", "drape"), "f.txt: z of its lines is left aside"),
        ):
            done = self.call(name, "--pieces", "4", *TRIANGULATION_ONLY, *options)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
            self.assertIn(words, done.stderr)
            self.assertIn("takes the whole surface in memory", done.stderr)
        done = self.call(name, "--pieces", "4", *TRIANGULATION_ONLY, "--faults", "zero.txt", "--faults-z", "given")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.file("far.txt", "1 1 1\n2 2 2\n")
        done = self.call(name, "--memory", "2G", *TRIANGULATION_ONLY, "--faults", "far.txt")
        self.assertIn("far.txt: triangulating: The constraints", done.stderr)

    def cloud_with_lakes(self, count):
        """The name of a file of points; a coast and so many lakes are in lakes.txt."""
        points = clouds()["random"]
        rings = Filled.rings(None, points)[: 1 + count]
        text_of = ["".join(f"{x!r} {y!r}\n" for x, y, _ in ring.tolist()) for ring in rings]
        self.file("lakes.txt", "\n".join(text_of))
        return self.npy("a.npy", points)

    def test_the_report_of_filled_pieces_is_that_of_one_run(self):
        name = self.cloud_with_lakes(5)
        options = ("--boundary", "lakes.txt", "--fill-cut-outs", "--maximum-hole-size", "150", "--report")
        done = self.call(name, *options, "--no-picture")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        whole = self.json("a_surface.json")
        done = self.call(name, "--pieces", "4", *options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("5 found, 2 filled with", done.stdout)
        report = self.json("a_surface.json")
        for one in (report, whole):
            for hole in one["holes"]["list"]:
                del hole["hole"]  # in the order of triangles
            one["holes"]["list"].sort(key=lambda hole: hole["centre"])
        for key in ("points", "unused_reasons", "unused", "points_unused", "triangles", "trim",
                    "bounds", "holes"):
            self.assertEqual(report[key], whole[key], key)

    def test_triangles_above_a_given_length_are_filled_as_by_one_run(self):
        points = clouds()["random"]
        places = points[:, :2] - (400600.0, 400500.0)
        name = self.npy("a.npy", points[numpy.abs(numpy.hypot(*places.T) - 160.0) > 30.0])
        for options in (("--open-edge-length", "45"), ("--open-edge-length", "45", "--maximum-hole-size", "100")):
            options += ("--maximum-expected-points", "9000", "--no-trim", "--report")
            found = []
            for way in (("--no-picture",), ("--pieces", "4")):
                done = self.call(name, *options, *way)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                bridged = [line.split("  ", 2)[2] for line in done.stdout.splitlines() if "void" in line or "bridge" in line]
                report = self.json("a_surface.json")
                for hole in report["holes"]["list"]:
                    del hole["hole"]  # in the order of triangles
                report["holes"]["list"].sort(key=lambda hole: hole["centre"])
                found.append({key: report[key] for key in ("unused_reasons", "triangles", "bounds", "holes")})
                found[-1]["bridged"] = [re.sub("void .*", "", line) for line in bridged]
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(self.path("a_surface.vtp"))
            reader.Update()
            self.assertEqual(*found)
            self.assertEqual(found[0]["holes"]["open_edge_length_is"], "as given")
            self.assertGreater(found[0]["holes"]["by_status"]["replaced"], 5)
            self.assertEqual(found[0]["holes"]["bridged_left"] > 0, "--maximum-hole-size" in options)
            numpy.testing.assert_array_equal(
                sorted_rows(numpy.concatenate([by_places(part) for part in self.parts("a_surface.vtpd")])),
                by_places(reader.GetOutput()),
            )

    def test_messages_on_a_boundary_are_those_of_one_run(self):
        points = clouds()["random"]
        name = self.npy("a.npy", points)
        chosen = points[numpy.isfinite(points).all(axis=1)][[700, 800, 900, 700], :2].tolist()
        self.file("chosen.txt", "".join(f"{x!r} {y!r}\n" for x, y in chosen))
        corners = "400100 400100\n400900 400150\n400700 400800\n400100 400100\n"
        self.file("twice.txt", f"{corners}\n400500 400250\n400600 400300\n400600 400200\n400500 400250\n\n{corners}")
        self.file("thin.txt", "400100.001 400100\n400100.002 400900\n400100.003 400100\n400100.001 400100\n")
        for options, words in (
            (("--boundary", "twice.txt"), r"note +trimming: Rings .* \(1 more, the first of them the part from line "
             r"11 to 14\) count once"),
            (("--boundary", "chosen.txt", "--no-recover-boundary"), r"chosen.txt: trimming: The boundary's edge from "
             r"point \d+ .* is not an edge of the mesh"),
            (("--boundary", "thin.txt"), "boundary thin.txt, 1 ring"),
        ):
            said = []
            for way in ("--no-picture", "--pieces=4"):
                done = self.call(name, "--no-fill", *options, way)
                lines = [line for line in done.stdout.splitlines() if re.match("  (note|triangles|trimmed)", line)]
                said.append((done.returncode, done.stderr, lines))
            self.assertEqual(*said)
            self.assertRegex("\n".join([done.stderr, *lines]), words)

    def test_holes_that_fail_are_reported_as_by_one_run(self):
        name = self.cloud_with_lakes(2)
        options = (
            "--boundary", "lakes.txt", "--fill-cut-outs", "--spacing", "0.001",
            "--open-edge-length", "0",
        )
        refused = [self.call(name, *options, way).stderr for way in ("--no-picture", "--pieces=4")]
        self.assertRegex(refused[0], r"a.npy: filling holes: .* A --spacing of 0\.\d+ would do")
        self.assertEqual(*refused)
        # With as many as may be inserted, holes fail one by one.
        options += ("--maximum-expected-points", "100000000")
        reported = []
        for way in ("--no-picture", "--pieces=4"):
            done = self.call(name, *options, way, "--report")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            report = self.json("a_surface.json")
            reported.append(sorted(re.sub("Hole [01]", "Hole", note) for note in report["notes"]))
            reported.append(report["holes"]["open_edge_length_is"])
            strict = self.call(name, *options, way, "--strict")
            self.assertEqual((strict.returncode, len(strict.stderr.splitlines())), (1, 1))
            self.assertIn("a.npy: filling holes: Hole 0 (", strict.stderr)
        self.assertEqual(reported[:2], reported[2:])
        self.assertEqual(len(reported[0]), 3)  # two holes that fail, and places with several heights
        said = []
        for way in ("--no-picture", "--pieces=4"):
            done = self.call(name, "--boundary", "lakes.txt", "--fill-cut-outs", "--spacing", "1e-10", way)
            said.append((done.returncode, done.stderr))
        self.assertEqual(*said)
        self.assertIn("--spacing: 1e-10 is too small: x and y of the points are in steps of", said[0][1])

    def test_a_hole_may_not_take_more_than_the_memory(self):
        name = self.cloud_with_lakes(2)
        options = (
            "--boundary", "lakes.txt", "--fill-cut-outs", "--memory", "450M",
            "--maximum-expected-points", "99999999",
        )
        done = self.call(name, *options, "--spacing", "0.2")
        self.assertEqual(done.returncode, 1)
        found = re.search(r"more than the memory for it, 0.2 GB. A --spacing of (\S+) would do", done.stderr)
        self.assertTrue(found, done.stderr)
        self.assertGreater(float(found.group(1)), 0.2)

    def test_points_in_no_triangle_below_the_limit_are_reported(self):
        points = clouds()["random"]
        name = self.npy("a.npy", points)
        ring = star((400500.0, 400500.0), 380.0)
        self.file("coast.txt", "".join(f"{x!r} {y!r}\n" for x, y, _ in ring.tolist()))
        limit = ("--maximum-edge-length", "25", "--report")
        for options, words in (
            (("--no-trim", "--no-fill"), "in no triangle below the edge limit"),
            (("--boundary", "coast.txt"), "outside the boundary, or in no triangle below the edge limit"),
        ):
            self.assertEqual(self.call(name, *limit, *options, "--no-picture").returncode, 0)
            whole = self.json("a_surface.json")
            done = self.call(name, "--pieces", "4", *limit, *options)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            report = self.json("a_surface.json")
            for key in ("points_unused", "triangles", "bounds"):
                self.assertEqual(report[key], whole[key], key)
            self.assertGreater(report["unused_reasons"][words], 50)
            self.assertEqual([u["point"] for u in report["unused"]],
                             [u["point"] for u in whole["unused"]])

    def test_several_files_are_one_cloud(self):
        points = clouds()["random"]
        names = [self.npy("a.npy", points[:1000]), self.npy("b.npy", points[1000:])]
        for extra in (("--memory", "2G"), ("--pieces", "3", "-o", "c.vtpd")):
            done = self.call(*names, *extra, *TRIANGULATION_ONLY, "--crs", "EPSG:25832")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        one, several = self.parts("a_surface.vtpd"), self.parts("c.vtpd")
        self.assertEqual((len(one), len(several)), (1, 3))
        numpy.testing.assert_array_equal(all_triangles(one), all_triangles(several))
        crs = several[0].GetFieldData().GetAbstractArray("CRS").GetValue(0)
        self.assertEqual(crs, "EPSG:25832")

    def test_pieces_of_an_earlier_run_go(self):
        name = self.npy("a.npy", clouds()["random"])
        for count in ("5", "2"):
            done = self.call(name, "--pieces", count, *TRIANGULATION_ONLY, "-o", "c.vtpd")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.file("c/c_note.vtp", "not a piece")
        self.assertEqual(sorted(os.listdir(self.path("c"))), ["c_0.vtp", "c_1.vtp", "c_note.vtp"])

    def test_memory_sets_the_number_of_pieces(self):
        self.assertEqual(pieces.memory_size("1.5g"), 1.5e9)
        self.assertEqual(pieces.memory_size("800MB"), 8e8)
        self.assertEqual(pieces.memory_size("2GiB"), 2e9)
        self.assertEqual(pieces.pieces_within(2e9, 1000), 1)
        self.assertEqual(pieces.pieces_within(2e9, 200_000_000), 30)
        self.assertEqual(pieces.pieces_within(2e9, 200_000_000, fill=True), 42)
        self.assertEqual(pieces.pieces_within(2e9, 1000, processes=4), 4)
        self.assertEqual(pieces.pieces_within(2e9, 200_000_000, processes=4), 32)
        for wrong in ("", "2X", "10", "-2G", "100M", "nan", "1e9"):
            done = self.call("a.npy", f"--memory={wrong}", *TRIANGULATION_ONLY)
            words = f"--memory takes a size of at least 450M, such as 2G, not '{wrong}'"
            self.assertEqual(done.returncode, 2)
            self.assertIn(words, done.stderr)

    def test_what_does_not_go_with_pieces_is_refused_before_any_work(self):
        name = self.npy("a.npy", clouds()["few"])
        self.file("b.stl", "solid a\n facet normal 0 0 1\n")
        self.file("taken", "a file")
        for options, words in (
            (("--pieces", "2", "--no-trim"), "add --open-edge-length, 0 for none"),
            (("--pieces", "0"), "--pieces takes a whole number from 1, not '0'"),
            (("--pieces", "2", "--memory", "2G", *TRIANGULATION_ONLY), "leave one out"),
            (("--pieces", "2", "--grid", "5", *TRIANGULATION_ONLY), "--grid needs the whole"),
            (("--pieces", "2", "--boundary", "a.npy", "--outward-test", "inward-normal"), "--outward-test needs"),
            (("--pieces", "2", "--view", "top", *TRIANGULATION_ONLY), "--view needs the whole"),
            (("--pieces", "2", "-o", "a.vtp", *TRIANGULATION_ONLY), ".vtp cannot be written in"),
            (("b.stl", "--pieces", "2", *TRIANGULATION_ONLY), "an STL file cannot be read in pieces"),
            (("--pieces", "2", "-o", "taken.vtpd", *TRIANGULATION_ONLY), "has this name"),
            (("-o", "a.vtpd"), ".vtpd cannot be written; use one of .vtp"),
        ):
            done = self.call(name, *options)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)
            self.assertIn(words, done.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.npy", "b.stl", "taken"])

    def test_no_triangle_is_an_error_that_leaves_nothing(self):
        name = self.npy("a.npy", numpy.arange(30.0).reshape(10, 3))
        done = self.call(name, "--pieces", "3", *TRIANGULATION_ONLY)
        self.assertEqual(done.returncode, 1)
        self.assertIn("no surface", done.stderr)
        self.assertEqual(os.listdir(self.folder), ["a.npy"])

    def test_a_full_disk_is_one_message_and_leaves_nothing(self):
        name = self.npy("a.npy", clouds()["random"])
        for most in (20_000, 100_000):  # bytes of a file: of all points, of a piece
            done = self.call(name, "--pieces", "1", *TRIANGULATION_ONLY, largest_file=most)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
            self.assertIn("cannot be written: File too large", done.stderr)
            self.assertEqual(os.listdir(self.folder), ["a.npy"])

    def test_a_stop_leaves_nothing(self):
        name = self.npy("a.npy", clouds()["random"])
        for when in ("read", "update", "write_vtpd"):
            script = (
                "import os, signal, sys, time\n"
                "from vtkelevationsurface import command, pieces, supervisor\n"
                "def stopped(*_):\n"
                "    os.kill(os.getppid(), signal.SIGTERM)\n"
                "    time.sleep(300)\n"
                "    open('went-on', 'w').close()\n"
                f"home = pieces if hasattr(pieces, {when!r}) else pieces.Pieces\n"
                f"setattr(home, {when!r}, stopped)\n"
                f"options = [{name!r}, '--pieces', '3', '--no-trim', '--no-fill']\n"
                "work = lambda: command.main(options)\n"
                "sys.exit(supervisor.supervised(work))\n"
            )
            done = subprocess.run(
                [sys.executable, "-c", script], cwd=self.folder, text=True, capture_output=True,
                timeout=300, check=False,
            )
            words = "reconstruct: stopped; nothing is written\n"
            self.assertEqual((done.returncode, done.stderr), (130, words))
            self.assertEqual(os.listdir(self.folder), ["a.npy"])


if __name__ == "__main__":
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    unittest.main(argv=sys.argv[:1])
