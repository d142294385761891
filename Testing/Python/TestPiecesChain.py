# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces in pieces with lines, trimmed and filled: together they are the surface of one run."""

import os
import re
import resource
import signal
import sys
import unittest

import numpy
from in_pieces import WithFilter, all_triangles, clouds, coast_and_lakes, ids_of, star
from meshes import by_places, ghosts_of, sorted_rows
from vtkelevationsurface import (
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)
from vtkelevationsurface.clouds import add_array, make_lines, make_points
from vtkelevationsurface.messages import Messages
from vtkelevationsurface.vtkElevationSurfacePieces import vtkReconstructPieces
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints

ARRAYS = ("Velocity", "Depth", "RGB", "FilledPoint", "FilledError", "FilledLow", "FilledHigh")  # of a surface that is filled


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
        lines, rings = self.lines(points, 5), make_lines(coast_and_lakes(points))
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
                    source, _ = self.assert_filled_as_one(points, coast_and_lakes(points), count)
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
        for rings in (None, coast_and_lakes(points)):
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
        rings = coast_and_lakes(points)
        for name, value, filled in (
            ("MaximumHoleSize", 150.0, 2),
            ("MaximumHoleEdges", 30, 3),
            ("Spacing", 40.0, 5),
            ("MatchDensity", True, 5),
            ("Interpolation", 1, 5),
            ("ConfidenceLevel", 0.7, 5),
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
        source, parts = self.assert_filled_as_one(points, coast_and_lakes(points), 6)
        new = sum(
            int(vtk_to_numpy(part.GetPointData().GetArray("FilledPoint")).sum()) for part in parts)
        self.assertGreater(new, 50)
        self.assert_one_owner(parts, len(points), source.GetNumberOfInsertedPoints() + new)

    def test_files_go_and_pieces_can_be_asked_for_again(self):
        points = clouds()["random"]
        source, parts = self.source_of(points, coast_and_lakes(points), 4)
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
            source.GetTrim().SetBoundaryData(make_lines(coast_and_lakes(points)))
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
            source.GetTrim().SetBoundaryData(make_lines(coast_and_lakes(points)))
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


if __name__ == "__main__":
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    unittest.main(argv=sys.argv[:1])
