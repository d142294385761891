# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The passes in C++ over points, triangles and text find what plain loops find."""

import itertools
import sys
import unittest
from unittest import mock

import numpy
from in_folder import InFolder
from vtkelevationsurface import ElevationSurfaceError, passes, reconstruct
from vtkelevationsurface.clouds import cells_of, make_points
from vtkelevationsurface.reading import text, text_blocks
from vtkelevationsurface.several_heights import several_heights
from vtkelevationsurface.vtkElevationSurfacePieces import vtkTextRows
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkSOADataArrayTemplate, vtkStringArray


def mesh(count=3000, seed=1):
    """(points, triangles) of a surface with holes."""
    random = numpy.random.default_rng(seed)
    xyz = random.uniform(size=(count, 3))
    return reconstruct(xyz, maximum_edge_length=0.06, fill=False).to_numpy()


class Passes(unittest.TestCase):
    def setUp(self):
        self.points, self.triangles = mesh()

    def test_corners_are_flagged_for_ids_of_any_width(self):
        some = self.triangles[::7]
        expected = numpy.isin(numpy.arange(len(self.points)), some)
        for kind in ("i4", "i8"):
            numpy.testing.assert_array_equal(
                passes.corner_flags(some.astype(kind), len(self.points)), expected)
        self.assertFalse(passes.corner_flags(some[:0], 3).any())

    def test_the_outline_of_no_triangle_is_empty(self):
        self.assertEqual(passes.outline(self.triangles[:0]).shape, (0, 2))

    def test_points_with_a_flag_keep_their_arrays_of_any_kind(self):
        triangles = self.triangles[::5]
        flags = passes.corner_flags(triangles, len(self.points))
        count, kept = len(flags), numpy.flatnonzero(flags)
        ids = numpy.arange(3 * count, dtype="i2").reshape(-1, 3)
        by_component, words = vtkSOADataArrayTemplate["float64"](), vtkStringArray()
        by_component.SetNumberOfComponents(2)
        by_component.SetNumberOfTuples(count)
        for i in range(2 * count):
            by_component.SetTypedComponent(i // 2, i % 2, i)
        for i in range(count):
            words.InsertNextValue(str(i))
        for kind in ("i4", "i8"):
            surface = make_points(self.points)
            surface.SetPolys(cells_of(triangles))
            if kind == "i8":
                surface.GetPolys().ConvertTo64BitStorage()
            data = surface.GetPointData()
            for name, array in (("Ids", numpy_to_vtk(ids)), ("Pairs", by_component), ("Words", words)):
                array.SetName(name)
                data.AddArray(array)
            data.SetActiveVectors("Ids")
            passes.keep_flagged(surface, flags)
            found = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
            places = vtk_to_numpy(surface.GetPoints().GetData())
            numpy.testing.assert_array_equal(places, self.points[flags])
            numpy.testing.assert_array_equal(places[found], self.points[triangles])
            self.assertEqual([data.GetArrayName(i) for i in range(3)], ["Ids", "Pairs", "Words"])
            vectors, pairs, texts = (data.GetAbstractArray(i) for i in range(3))
            self.assertIs(data.GetVectors(), vectors)
            self.assertEqual(vectors.GetDataType(), numpy_to_vtk(ids).GetDataType())
            numpy.testing.assert_array_equal(vtk_to_numpy(vectors), ids[flags])
            found = [pairs.GetTuple2(i) for i in range(pairs.GetNumberOfTuples())]
            self.assertEqual(found, [(2.0 * i, 2.0 * i + 1) for i in kept])
            found = [texts.GetValue(i) for i in range(texts.GetNumberOfValues())]
            self.assertEqual(found, [str(i) for i in kept])

    def test_near_triangles_contain_the_nearest(self):
        random = numpy.random.default_rng(3)
        places = random.uniform(-0.2, 1.2, size=(30, 3))
        near = passes.near_triangles(self.points, self.triangles, places)
        corners = self.points[self.triangles]
        for place in places:
            # The closest corner of all is one of these triangles: no triangle is farther than it.
            distances = numpy.linalg.norm(corners - place, axis=2).min(axis=1)
            self.assertIn(distances.min(), distances[near])

    def test_points_that_share_a_place_are_all_found(self):
        xyz = numpy.random.default_rng(4).uniform(size=(5000, 3))
        xyz[:40, :2] = xyz[40:80, :2]
        xyz[80, 0] = xyz[81, 0] = numpy.nan
        xyz[82, :2], xyz[83, :2] = (0.0, 1.0), (-0.0, 1.0)
        found = set(passes.maybe_shared(xyz).tolist())
        self.assertTrue(set(range(80)) | {82, 83} <= found)
        self.assertTrue(found.isdisjoint({80, 81}))
        self.assertLess(len(found), 2000)
        several = several_heights(xyz)
        self.assertEqual((several.count(), several.places), (41, 5000 - 2 - 41))

    def test_a_sample_does_not_depend_on_the_order_of_triangles(self):
        order = numpy.random.default_rng(5).permutation(len(self.triangles))
        one = self.triangles[passes.sample(self.triangles, 4)]
        other = self.triangles[order][passes.sample(self.triangles[order], 4)]
        self.assertEqual(sorted(one.tolist()), sorted(other.tolist()))
        self.assertLess(abs(4 * len(one) - len(self.triangles)), 0.5 * len(self.triangles))
        ids = numpy.arange(len(self.points))
        numpy.testing.assert_array_equal(
            passes.sample(self.triangles, 4, ids), passes.sample(self.triangles, 4))

    def test_edges_are_found_in_their_direction(self):
        ends = self.points[self.triangles[:20, :2], :2].reshape(-1, 4)
        backwards = ends[:, (2, 3, 0, 1)]
        pairs = {tuple(pair) for t in self.triangles.tolist() for pair in zip(t, t[1:] + t[:1])}
        expected = [(b, a) in pairs for a, b in self.triangles[:20, :2].tolist()]
        found = passes.are_edges(self.points, self.triangles, numpy.vstack((ends, backwards, ends + 9)))
        self.assertEqual(found.tolist(), [True] * 20 + expected + [False] * 20)


class TextRows(InFolder):
    """Each text is read twice: by vtkTextRows, and without it."""

    NUMBERS = ("1", "-2.5", "+3", ".5", "7.", "1e3", "-4.25E-2", "0.1", "123456.789012345678", "1e-320",
               "nan", "inf", "1_0", "0x10", "1e", "-", "abc", "", "5 5", "1e400", "--1")

    def outcome(self, words):
        try:
            cloud = self.read(words)
        except ElevationSurfaceError as error:
            return str(error)
        xyz = vtk_to_numpy(cloud.points.GetPoints().GetData())
        return xyz.tobytes(), numpy.asarray(cloud.lines).tolist(), cloud.notes, cloud.left_out

    def check(self, words):
        found = self.outcome(words)
        plain = text.Parser.plain_rows
        text.Parser.plain_rows = lambda *_: None
        try:
            self.assertEqual(found, self.outcome(words), words[-300:])
        finally:
            text.Parser.plain_rows = plain

    def test_what_stands_for_a_number_means_the_same(self):
        rows = "".join(f"{x} {y} {x + y}\n" for x, y in itertools.product(range(9), range(9)))
        for word, separator in itertools.product(self.NUMBERS, " ,\t"):
            self.check(rows.replace(" ", separator) + separator.join(("3", "4", word)) + "\n")

    def test_lines_that_are_no_rows_mean_the_same(self):
        rows = "".join(f"{x} {y} {x + y}\n" for x, y in itertools.product(range(9), range(9)))
        for more in ("\n\n8 9 7\n", "# note\n8 9 7", "Total 3 4\n", "8 9\n", "8 9 7 6\n", "  8\t9 7  ",
                     "\u00a08 9 7\n", "8 9 \"7\"\n", "> 1\n8 9 7\n", "x y z\n8 9 7\n", "8 9 7\x0b\n"):
            self.check(rows + more)
            self.check("x y z\n" + rows + more)
            self.check("name,x,y,z\n" + "".join(f"p,{line}\n" for line in rows.replace(" ", ",").split("\n")[:-1]))

    def test_names_that_are_not_kept_change_no_meaning(self):
        places = [(i, i % 60, i // 60, i % 7) for i in range(2000)]
        for block, rows, last in (
            (100_000, [f"p{i},{x},{y},{z},{i}{'q' * 1500}\n" for i, x, y, z in places], "Total,3,4,5,0"),
            (10_000, [f"p{i}\tq{i}\t{x}\t{y}\t{z}\n" for i, x, y, z in places], "\t#x\t3\t4\t5"),
        ):
            with mock.patch.object(text_blocks, "BLOCK", block):
                self.check("".join((*rows[:-40], last + "\n", *rows[-40:])))

    def test_a_head_of_numbers_that_comes_again_is_no_point(self):
        rows = [f"{4e5 + x + 0.25},{5e6 + y + 0.25},{x * y % 7}\n" for x in range(110) for y in range(100)]
        words = "".join(("0,1,2\n", *rows[:5001], "0,1,2\n", *rows[5001:]))
        for block in (text_blocks.BLOCK, 100_000):
            with mock.patch.object(text_blocks, "BLOCK", block):
                self.check(words)
                self.assertIn("header lines that come again are left out: 1", self.outcome(words)[2])

    def test_lines_that_are_too_short_take_no_memory(self):
        rows = vtkDoubleArray()

        def parse(words, count):
            columns = passes.in_vtk(numpy.arange(count, dtype="i4"))
            return vtkTextRows.Parse(words, 0, ",", count, columns, "#", rows)

        self.assertFalse(parse(b"\n" * 100_000, 1000))
        self.assertEqual(rows.GetSize(), 0)
        self.assertTrue(parse(b"1,2\n3,4", 2))
        self.assertEqual(vtk_to_numpy(rows).tolist(), [[1, 2], [3, 4]])

    def test_blocks_are_read_in_stretches_of_whole_lines(self):
        random = numpy.random.default_rng(6)
        xyz = random.uniform(0, 1e6, size=(120_000, 3))
        self.check("".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in xyz.tolist()))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
