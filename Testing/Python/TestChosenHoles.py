# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Areas choose which holes are filled: by the filter, in Python, by the program, in memory and pieces."""
import itertools
import sys
import unittest

import meshes
import numpy
from in_folder import Program
from mesh_rules import findings
from osgeo import osr
from vtkelevationsurface import reconstruct, vtkFillElevationHoles, vtkGridDelaunay2D
from vtkelevationsurface.algorithms import ReconstructElevationSurface
from vtkelevationsurface.messages import ElevationSurfaceError, Messages
from vtkmodules.util.numpy_support import vtk_to_numpy

osr.UseExceptions()

CENTRES = ((10.0, 10.0), (30.0, 12.0), (20.0, 30.0))
RADIUS = 3.5


def square(x, y, half):
    return numpy.array([(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)])


LAKES = [square(*CENTRES[0], 1.0), square(*CENTRES[2], 9.0)]  # in a hole, and around one
NOWHERE = [square(500.0, 500.0, 2.0)]


def survey():
    """A plane on a grid, without the points near three places."""
    xy = numpy.stack(numpy.meshgrid(numpy.arange(41.0), numpy.arange(41.0)), -1).reshape(-1, 2)
    far = numpy.min([numpy.hypot(*(xy - centre).T) for centre in CENTRES], axis=0) > RADIUS
    return numpy.column_stack((xy, 100.0 + xy @ (0.5, -0.25)))[far]


def surface(points=None):
    """The survey with its holes."""
    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputData(meshes.cloud(survey() if points is None else points))
    delaunay.SetMaximumEdgeLength(2.0)
    delaunay.Update()
    return delaunay.GetOutput()


def filling(areas, mode=vtkFillElevationHoles.FILL_ONLY, of=None):
    """(the filter, its Messages)"""
    fill = vtkFillElevationHoles()
    fill.SetInputData(surface() if of is None else of)
    fill.SetAreasData(areas)
    fill.SetAreaMode(mode)
    with Messages(fill) as messages:
        fill.Update()
    return fill, messages


def statuses(outlines):
    """{which of CENTRES: the status of the hole there}"""
    found = {}
    for hole in range(outlines.GetNumberOfCells()):
        middle = numpy.reshape(outlines.GetCell(hole).GetBounds(), (3, 2)).mean(axis=1)[:2]
        where = int(numpy.argmin(numpy.hypot(*(numpy.array(CENTRES) - middle).T)))
        found[where] = outlines.GetCellData().GetAbstractArray("StatusName").GetValue(hole)
    return found


ONLY_LAKES = {0: "filled", 1: "not chosen", 2: "filled"}
ALL_BUT_LAKES = {0: "not chosen", 1: "filled", 2: "not chosen"}


class Filter(unittest.TestCase):
    def test_only_holes_that_touch_areas_are_filled_or_kept_open(self):
        for mode, expected in enumerate((ONLY_LAKES, ALL_BUT_LAKES)):
            fill, messages = filling(meshes.rings(LAKES), mode)
            self.assertEqual(statuses(fill.GetOutput(1)), expected)
            self.assertEqual((fill.GetNumberOfHoles(), fill.GetNumberOfFilledHoles()), (3, 2 - mode))
            self.assertEqual(findings(fill.GetOutput(0)), [])
            self.assertEqual(messages.warnings, [])
            status = vtk_to_numpy(fill.GetOutput(1).GetCellData().GetArray("Status"))
            self.assertEqual(sorted(set(status)), [fill.FILLED, fill.NOT_CHOSEN])

    def test_patches_are_those_without_areas(self):
        fill, _ = filling(meshes.rings(LAKES))
        everything = vtkFillElevationHoles()
        everything.SetInputData(surface())
        everything.Update()
        chosen, every = (meshes.points_of(one.GetOutput(0)) for one in (fill, everything))
        self.assertTrue(set(map(tuple, chosen)) < set(map(tuple, every)))

    def test_without_areas_all_are_filled_whatever_the_mode(self):
        fill = vtkFillElevationHoles()
        self.assertEqual(fill.GetAreaMode(), fill.FILL_ONLY)
        fill.SetInputData(surface())
        fill.SetAreaModeToKeepOpen()
        fill.Update()
        self.assertEqual(set(statuses(fill.GetOutput(1)).values()), {"filled"})

    def test_the_order_of_areas_and_the_kind_of_cell_do_not_matter(self):
        for order in itertools.permutations(LAKES):
            self.assertEqual(statuses(filling(meshes.rings(order))[0].GetOutput(1)), ONLY_LAKES)
        corners = numpy.vstack(LAKES)
        polygons = meshes.lines(numpy.column_stack((corners, numpy.zeros(8))), [], [range(4), range(4, 8)])
        self.assertEqual(statuses(filling(polygons)[0].GetOutput(1)), ONLY_LAKES)

    def test_points_of_floats_stay_floats(self):
        floats = meshes.cloud(survey().astype("f4"))
        delaunay = vtkGridDelaunay2D()
        delaunay.SetInputData(floats)
        delaunay.SetMaximumEdgeLength(2.0)
        delaunay.Update()
        of = delaunay.GetOutput()
        fill, _ = filling(meshes.rings(LAKES), of=of)
        self.assertEqual(fill.GetOutput(0).GetPoints().GetDataType(), of.GetPoints().GetDataType())

    def test_areas_that_touch_no_hole_are_a_warning(self):
        for mode, outcome in enumerate(("none is filled", "none is kept open")):
            _, messages = filling(meshes.rings(NOWHERE), mode)
            self.assertEqual([one.code for one in messages.warnings], ["AreasTouchNoHole"])
            words = str(messages.warnings[0])
            self.assertIn("None of the 3 holes touches the areas, which are at x 498 to 502", words)
            self.assertIn(outcome, words)

    def test_bad_areas_are_an_error_that_names_them(self):
        three = numpy.array([(0.0, 0.0, 0.0), (5.0, 0.0, 0.0), (5.0, 5.0, 0.0)])
        infinite = meshes.rings([[(0.0, 0.0), (5.0, 0.0), (numpy.nan, 5.0)]])
        for areas, words in (
            (meshes.lines(three, []), "The area input has no line and no polygon."),
            (meshes.lines(three, [[0, 1, 2]]), "The area input is not closed: line (cell 0) ends at point 0"),
            (meshes.lines(three, [], [[0, 1]]), "The area input's polygon (cell 0) has only 2 different points"),
            (infinite, "is not finite"),
        ):
            fill, messages = filling(areas)
            self.assertEqual(len(messages.errors), 1)
            self.assertIn(words, str(messages.errors[0]))
            self.assertEqual(fill.GetOutput(0).GetNumberOfPoints(), 0)

    def test_repeated_areas_count_once_and_are_reported(self):
        fill, messages = filling(meshes.rings([LAKES[0], *LAKES]))
        self.assertEqual(statuses(fill.GetOutput(1)), ONLY_LAKES)
        self.assertEqual([one.code for one in messages.warnings], ["RingsRepeated"])
        self.assertIn("of the area input", str(messages.warnings[0]))


class Python(unittest.TestCase):
    def test_reconstruct_takes_them(self):
        for name, expected in (("fill_only", ONLY_LAKES), ("keep_open", ALL_BUT_LAKES)):
            result = reconstruct(survey(), maximum_edge_length=2.0, **{name: LAKES})
            self.assertEqual(statuses(result.holes), expected)
            holes = result.report["holes"]
            self.assertEqual(holes["found"], 3)
            self.assertEqual(holes["by_status"]["not chosen"], list(expected.values()).count("not chosen"))

    def test_bad_input_is_refused_in_one_line(self):
        with self.assertRaisesRegex(ValueError, "^keep_open and fill_only|^fill_only and keep_open cannot"):
            reconstruct(survey(), fill_only=LAKES, keep_open=LAKES)
        with self.assertRaisesRegex(TypeError, r"^fill_only: a file's name; use read_boundary\('a.gpkg'\)$"):
            reconstruct(survey(), fill_only="a.gpkg")
        with self.assertRaisesRegex(ValueError, "^keep_open: a ring has 2 points"):
            reconstruct(survey(), keep_open=LAKES[0][:2])
        with self.assertRaises(ElevationSurfaceError) as caught:
            reconstruct(survey(), fill_only=meshes.lines(numpy.eye(3), [[0, 1, 2]]), strict=True)
        self.assertEqual(caught.exception.about, "fill_only")

    def test_the_entry_of_paraview_has_inputs_for_them(self):
        for port, expected in ((3, ONLY_LAKES), (4, ALL_BUT_LAKES)):
            entry = ReconstructElevationSurface()
            entry.SetInputDataObject(0, meshes.cloud(survey()))
            entry.SetInputDataObject(port, meshes.rings(LAKES))
            entry.SetMaximumEdgeLength(2.0)
            entry.Update()
            self.assertEqual(statuses(entry.GetOutputDataObject(1)), expected)
        both = ReconstructElevationSurface()
        for port, data in ((0, meshes.cloud(survey())), (3, meshes.rings(LAKES)), (4, meshes.rings(LAKES))):
            both.SetInputDataObject(port, data)
        with Messages(both) as messages:
            both.Update()
        self.assertIn("Fill Only and Keep Open cannot be used together", " ".join(map(str, messages.errors)))


class OfProgram(Program):
    def setUp(self):
        super().setUp()
        self.file("survey.xyz", "\n".join("%r %r %r" % tuple(row) for row in survey().tolist()))
        self.write("lakes.txt", LAKES)

    def write(self, name, rings):
        parts = ["\n".join("%.17g %.17g" % tuple(p) for p in [*ring, ring[0]]) for ring in rings]
        return self.file(name, "\n\n".join(parts))

    def run_it(self, *options):
        return self.call("survey.xyz", "--maximum-edge-length", "2", *options)

    def statuses(self, *options):
        done = self.run_it("--no-picture", "--report", "r.json", *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        holes = sorted(self.json("r.json")["holes"]["list"], key=lambda hole: hole["centre"])
        return {(0, 2, 1)[i]: hole["status"] for i, hole in enumerate(holes)}, done.stdout

    def test_takes_files(self):
        found, said = self.statuses("--fill-only", "lakes.txt")
        self.assertEqual(found, ONLY_LAKES)
        self.assertIn("holes      3 found, 2 filled", said)
        self.assertIn("1 not filled, not chosen: hole", said)
        self.assertEqual(self.statuses("--keep-open", "lakes.txt")[0], ALL_BUT_LAKES)

    def test_in_pieces_as_in_memory(self):
        for option, expected in (("--fill-only", ONLY_LAKES), ("--keep-open", ALL_BUT_LAKES)):
            found, _ = self.statuses(option, "lakes.txt", "--pieces", "3", "--no-trim", "--open-edge-length", "0")
            self.assertEqual(found, expected)

    def test_mends_what_is_given(self):
        self.file("open.txt", "9 9\n11 9\n11 11\n9 11\n9 9.0001\n")
        found, said = self.statuses("--fill-only", "open.txt")
        self.assertEqual(found, {0: "filled", 1: "not chosen", 2: "not chosen"})
        self.assertIn("open.txt", said)

    def test_refuses_in_one_line(self):
        self.file("flat.txt", "9 9\n11 9\n\n")
        self.file("empty.txt", "")
        for options, words in (
            (["--fill-only", "lakes.txt", "--keep-open", "lakes.txt"],
             "--fill-only and --keep-open cannot be used together"),
            (["--fill-only", "lakes.txt", "--no-fill"], "filling options have no effect with --no-fill"),
            (["--fill-only", "missing.txt"], "missing.txt"),
            (["--keep-open", "empty.txt"], "empty.txt"),
            (["--keep-open", "flat.txt"], "flat.txt"),
            (["--fill-only", "lakes.txt", "-o", "lakes.txt"], "lakes.txt"),
        ):
            with self.subTest(options=options):
                done = self.run_it(*options)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(words, done.stderr)
                self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)

    def test_notes_areas_elsewhere(self):
        self.write("far.txt", NOWHERE)
        _, said = self.statuses("--fill-only", "far.txt")
        self.assertIn("None of the 3 holes touches the areas", said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
