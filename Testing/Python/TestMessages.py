# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Messages are data: each of the filters' has a code and values, and its sentence is made of them, with the
names that options have where it is read. Nothing looks for words in sentences."""

import ast
import contextlib
import io
import os
import re
import string
import tempfile
import unittest

import numpy
import vtkelevationsurface
from vtkelevationsurface import (
    ElevationSurfaceError,
    reconstruct,
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)
from vtkelevationsurface.algorithms import ReconstructElevationSurface
from vtkelevationsurface.clouds import make_lines, make_points
from vtkelevationsurface.messages import Message, Messages, Reason, messages_of, counted_reason
from vtkelevationsurface.names import PANEL, PROGRAM, PYTHON, argument, option, written_for
from vtkelevationsurface.pieces import StepMessages
from vtkelevationsurface.steps import in_our_names
from vtkelevationsurface.vtkElevationSurfacePieces import vtkReconstructPieces
from vtkmodules.vtkCommonCore import VTK_STRING, vtkOutputWindow
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkPolyData

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PACKAGE = os.path.dirname(vtkelevationsurface.__file__)
HEADERS = ("Filters/vtkGridDelaunay2D.h", "Filters/vtkTrimOutwardTriangles.h", "Filters/vtkFillElevationHoles.h",
           "Python/Pieces/vtkReconstructPieces.h")


def read_source(*names):
    with open(os.path.join(ROOT, *names), encoding="utf-8") as stream:
        return stream.read()


def grid(size, step=1.0):
    x, y = numpy.meshgrid(numpy.arange(size) * step, numpy.arange(size) * step)
    return make_points(numpy.column_stack((x.ravel(), y.ravel(), 0.1 * x.ravel())))


def run(algorithm):
    """(errors, warnings) of an update, as Messages."""
    with Messages(algorithm, algorithm.GetExecutive()) as messages:
        algorithm.Update()
    return messages.errors, messages.warnings


def triangulated(points, lines=None, **properties):
    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputDataObject(0, points)
    if lines is not None:
        delaunay.SetSourceData(lines)
    for name, value in properties.items():
        getattr(delaunay, f"Set{name}")(value)
    return delaunay


def survey(gap, levels=0.0, mistie=0.0):
    """Gently waved heights on lines with levels up to some height, and a mistie of lines across them."""
    random = numpy.random.RandomState(1)
    along = numpy.arange(121.0)
    x, y = numpy.meshgrid(along, numpy.arange(0.0, 121.0, gap))
    z = 8 * numpy.sin(x / 15) * numpy.cos(y / 19) + levels * random.random_sample((len(y), 1))
    points = [numpy.column_stack([a.ravel() for a in (x + 0.1 * random.random_sample(x.shape), y, z)])]
    for at in (20.41, 50.41, 80.41) if mistie else ():
        z = 8 * numpy.sin(at / 15) * numpy.cos(along / 19) + mistie
        points.append(numpy.column_stack(
            (numpy.full(121, at), along + 0.05 + 0.1 * random.random_sample(121), z)))
    return make_points(numpy.concatenate(points))


def two_size_ring():
    """A square with a hole, in which a grid's spacing is left."""
    points = grid(12)
    x, y = numpy.array([points.GetPoint(i)[:2] for i in range(144)]).T
    keep = (abs(x - 5.5) > 3) | (abs(y - 5.5) > 3)
    return make_points(numpy.array([points.GetPoint(i) for i in numpy.flatnonzero(keep)]))


class Data(unittest.TestCase):
    """What GetMessages() of the filters gives."""

    def setUp(self):
        vtkOutputWindow.GetInstance().SetDisplayModeToNever()

    def check(self, message, code, **values):
        """Its code and values, and that all places of the text are filled."""
        self.assertEqual(message.code, code)
        self.assertEqual({name: message.values[name] for name in values}, values)
        places = [place for _, place, _, _ in string.Formatter().parse(message.text) if place]
        self.assertLessEqual(set(places) - {"property"}, message.values.keys())

    def test_warnings_have_their_values(self):
        few = triangulated(make_points(numpy.array([[0.0, 0, 0], [1, 0, 0]])))
        (warning,) = run(few)[1]
        self.check(warning, "NoTriangle", points="2")
        (warning,) = run(triangulated(grid(5, 10.0), MaximumEdgeLength=1.0))[1]
        self.check(warning, "FewTrianglesAdvice", what="FewTriangles", what_limit="1",
                   what_points="25", what_missing="25", shortest="10")
        self.assertGreater(float(warning.values["better"]), 10.0)
        lines = make_lines([numpy.array([[2.0, 2, 0], [90, 90, 0], [95, 95, 0]])])
        (warning,) = run(triangulated(grid(5), lines))[1]
        self.check(warning, "LinesFarOutside", outside="2", vertices="3", input="constraints")

    def test_errors_have_their_values(self):
        for message, code, values in (
            (triangulated(grid(3), MaximumEdgeLength=-1.0), "InvalidEdgeLength", {"value": "-1"}),
            (triangulated(grid(3), MaximumEdgeLength=1.0, MaximumElevationError=1.0), "TwoLimits", {}),
            (triangulated(grid(3), MaximumEdgeLength=1.0, MaximumNumberOfPoints=5), "LengthAndNumber", {}),
            (triangulated(grid(3), MaximumNumberOfPoints=3), "TooFewPointsAllowed",
             {"value": "3", "least": "4", "hull": "4", "lines": "0"}),
            (triangulated(grid(3), make_points(numpy.zeros((1, 3)))), "NoLines",
             {"input": "constraints"}),
            (triangulated(grid(3), make_lines([numpy.array([[8.0, 8, 0], [9, 9, 0]])])),
             "LinesElsewhere", {"input": "constraints"}),
            (triangulated(grid(3), make_lines([numpy.array([[0.0, 0, 0], [1, 1, numpy.inf]])])),
             "NonFinitePointOfLine", {"point": "1", "cell": "0"}),
            (triangulated(grid(3), make_lines([numpy.array([[0.0, 0, 0], [1, 7.5, numpy.nan]])])),
             "NoSurfaceForPointOfLine", {"point": "1", "cell": "0", "x": "1", "y": "7.5", "count": "1"}),
        ):
            errors, warnings = run(message)
            self.assertEqual((len(errors), warnings), (1, []), code)
            self.check(errors[0], code, **values)

    def test_what_a_property_cannot_be_is_an_error(self):
        surface = triangulated(grid(3))
        surface.Update()
        wrong = (-1.0, numpy.nan)
        for make, properties in (
            (vtkGridDelaunay2D, {"MaximumEdgeLength": wrong, "MaximumElevationError": (*wrong, numpy.inf),
                                 "MaximumNumberOfPoints": (-1,),
                                 "LatticeTolerance": (*wrong, 0.3), "NumberOfThreads": (-1, 1025)}),
            (vtkTrimOutwardTriangles, {"GapTolerance": wrong, "NumberOfThreads": (-1, 1025)}),
            (vtkFillElevationHoles, {"OpenEdgeLength": wrong, "MaximumHoleSize": wrong, "MaximumHoleEdges": (-1,),
                                     "Spacing": (*wrong, numpy.inf), "MaximumNumberOfInsertedPoints": (-7,),
                                     "MaximumNumberOfExpectedPoints": (-7,), "NumberOfThreads": (-1, 1025)}),
        ):
            for name, values in properties.items():
                for value in values:
                    with self.subTest(make.__name__, name=name, value=value):
                        algorithm = make()
                        algorithm.SetInputData(surface.GetOutput())
                        getattr(algorithm, f"Set{name}")(value)
                        (error,), warnings = run(algorithm)
                        self.assertRegex(error, f"^{name} is {value:g}.*must be")
                        self.assertTrue(error.code.startswith("Invalid"))
                        self.assertEqual((warnings, algorithm.GetOutput().GetNumberOfPoints()), ([], 0))

    def test_an_error_that_a_number_of_points_does_not_allow_is_a_warning(self):
        points = make_points(numpy.random.RandomState(1).rand(200, 3))
        errors, (warning,) = run(triangulated(points, MaximumNumberOfPoints=30, MaximumElevationError=1e-9))
        self.check(warning, "ErrorNotReached", most="30", limit="1e-09")
        self.assertEqual(errors, [])
        self.assertGreater(float(warning.values["largest"]), 1e-9)

    def test_a_lattice_with_constraints_is_reported(self):
        lattice, lines = (0.0, 0.0, 1.0, 0.0, 0.0, 1.0), make_lines([numpy.array([[0.5, 0.5, 0], [3.5, 2.5, 0]])])
        self.assertEqual(run(triangulated(grid(5), Lattice=lattice)), ([], []))
        errors, (warning,) = run(triangulated(grid(5), lines, Lattice=lattice))
        self.assertEqual((errors, warning.code), ([], "LatticeNotUsed"))
        for properties in ({"DrapeConstraints": True}, {"LatticeMode": 1}):  # where it is used, or off
            self.assertEqual(run(triangulated(grid(5), lines, Lattice=lattice, **properties)), ([], []))

    def test_the_old_name_of_open_edge_length_works_and_warns(self):
        fill = vtkFillElevationHoles()
        with Messages(fill) as messages:
            fill.SetMaximumEdgeLength(2.5)
        self.assertEqual([one.code for one in messages.warnings], ["EdgeLengthRenamed"])
        self.assertEqual((fill.GetOpenEdgeLength(), fill.GetMaximumEdgeLength()), (2.5, 2.5))

    def test_a_hole_has_the_code_of_its_reason(self):
        delaunay, fill = triangulated(two_size_ring()), vtkFillElevationHoles()
        fill.SetInputConnection(delaunay.GetOutputPort())
        fill.SetOpenEdgeLength(2.0)
        fill.SetMaximumNumberOfInsertedPoints(1)
        (warning,) = run(fill)[1]
        self.check(warning, "RegionNotFilled", hole="0", reason="MoreThanInsertedPoints",
                   reason_limit="1")
        self.assertGreater(float(warning.values["reason_points"]), 1)
        fill.SetMaximumNumberOfInsertedPoints(1000)
        self.assertEqual(run(fill), ([], []))
        self.assertEqual(messages_of(fill, "warning"), [])  # those of the last run alone

    def test_survey_lines_have_their_warnings(self):
        def warnings_of(points):
            delaunay, fill = triangulated(points), vtkFillElevationHoles()
            fill.SetInputConnection(delaunay.GetOutputPort())
            fill.SetOpenEdgeLength(2.5)
            errors, warnings = run(fill)
            self.assertEqual(errors, [])
            return warnings

        self.assertEqual(warnings_of(survey(5.0)), [])
        (warning,) = warnings_of(survey(5.0, levels=3.0))
        self.check(warning, "ErrorsOutgrowRoughness", holes="1", hole="0")
        self.assertGreater(float(warning.values["factor"]), 1.5)
        (warning,) = warnings_of(survey(10.0, mistie=5.0))
        self.check(warning, "LinesDisagree")
        self.assertGreater(int(warning.values["crossings"]), 20)
        self.assertAlmostEqual(float(warning.values["median"]), 5.0, delta=1.0)

    def test_a_block_is_a_value(self):
        blocks = vtkMultiBlockDataSet()
        blocks.SetBlock(0, grid(2))
        blocks.SetBlock(1, vtkPolyData())
        blocks.SetBlock(2, make_points(numpy.zeros((1, 3))))
        errors, warnings = run(triangulated(blocks))
        self.assertEqual(errors, [])
        self.assertEqual([(one.code, one.block, one.values["points"]) for one in warnings],
                         [("NoTriangle", "Block 2", "1")])  # an empty block passes in silence

    def test_messages_of_many_blocks_are_as_many_rows_and_five_in_the_text(self):
        for count in (5, 8):
            blocks, texts = vtkMultiBlockDataSet(), []
            for i in range(count):
                blocks.SetBlock(i, make_points(numpy.array([[0.0, 0, 0], [1, 0, 0]])))
            delaunay = triangulated(blocks)

            def show(_caller, _event, text, texts=texts):
                texts.append(text)

            show.CallDataType = VTK_STRING
            delaunay.AddObserver("WarningEvent", show)
            self.assertEqual(len(run(delaunay)[1]), count)
            (text,) = texts
            self.assertEqual(len(re.findall(r"Block \d", text)), 5, text)
            end = re.search(r"And (\d+) more like these\.", text)
            self.assertEqual(end and end[1], "3" if count == 8 else None, text)

    def test_pieces_have_data_of_each_step(self):
        with tempfile.TemporaryDirectory() as folder:
            source = vtkReconstructPieces()
            source.SetFolder(folder)
            with StepMessages(source, source.GetExecutive()) as messages:
                source.AddPoints(None)
                source.AddPoints(make_points(numpy.array([[0.0, 0, 0], [1, 0, 0]])))
                source.GetDelaunay().SetMaximumElevationError(1.0)
                source.UpdatePiece(0, 1, 0)
                source.GetDelaunay().SetMaximumElevationError(0.0)
                source.UpdatePiece(0, 1, 0)
            self.assertEqual([one.code for one in messages.errors], ["Words", "ErrorNotInPieces"])
            (warning,) = messages.warnings
            self.check(warning, "NoTriangle", points="2")
            self.assertEqual(warning.step, "delaunay")
            source.Reset()  # which removes its files

    def test_the_sentence_is_what_people_see(self):
        texts = []

        def note(_caller, _event, text):
            texts.append(text)

        note.CallDataType = VTK_STRING
        trim = vtkTrimOutwardTriangles()
        trim.SetInputData(0, grid(2))
        for algorithm, kind in ((trim, "warning"), (triangulated(grid(3), MaximumEdgeLength=-1.0), "error")):
            algorithm.AddObserver(f"{kind.title()}Event", note)
            algorithm.Update()
            (message,) = messages_of(algorithm, kind)
            self.assertIn(str(message), texts.pop())
            self.assertEqual(message, message.named(str))

    def test_what_vtk_itself_reports_is_words(self):
        errors, _ = run(vtkGridDelaunay2D())  # no input
        self.assertEqual(len(errors), 1)
        self.assertEqual((errors[0].code, errors[0].values), ("", {"words": str(errors[0])}))
        self.assertIn("0 connections", errors[0])


class Waiting(unittest.TestCase):
    """A rank that waits for others is not a fault of the result."""

    def test_it_is_shown_and_is_not_a_warning(self):
        waits = Message("Rank {rank} has waited.", {"rank": "1"}, "RankWaits")
        shown, messages = io.StringIO(), Messages()
        with contextlib.redirect_stderr(shown):
            messages.take("WarningEvent", waits)
            messages.take("WarningEvent", Message("{words}", {"words": "else"}))
        self.assertEqual(shown.getvalue(), "Rank 1 has waited.\n")
        self.assertEqual(messages.warnings, ["else"])


class Names(unittest.TestCase):
    """Sentences have the names of options where the user has set them."""

    def test_an_option_is_called_as_it_is_written(self):
        for place, names in ((PYTHON, ("--no-data", "no_data")), (PROGRAM, ("--no-data", "--no-data")),
                             (PANEL, ("No Data", "No Data"))):
            with written_for(place):
                self.assertEqual((option("no_data"), argument("no_data")), names)
        self.assertEqual(argument("no_data"), "no_data")

    def test_properties_are_those_of_the_filter(self):
        (warning,) = run(triangulated(grid(5, 10.0), MaximumEdgeLength=1.0))[1]
        for place, step, name in (
            (PYTHON, "delaunay", "MaximumEdgeLength"),
            (PROGRAM, "delaunay", "--maximum-edge-length"),
            (PROGRAM, "trim", "MaximumEdgeLength"),
            (PANEL, "delaunay", "Maximum Edge Length"),
        ):
            with written_for(place):
                self.assertEqual(
                    in_our_names(warning, step), str(warning).replace("MaximumEdgeLength", name))

    def test_constraints_are_faults_in_a_panel(self):
        (error,) = run(triangulated(grid(3), make_lines([numpy.array([[8.0, 8, 0], [9, 9, 0]])])))[0]
        self.assertTrue(in_our_names(error, "delaunay").startswith("The constraints do not overlap"))
        with written_for(PANEL):
            self.assertEqual(in_our_names(error, "delaunay"), str(error).replace("constraints", "faults"))

    def test_an_error_knows_its_step_and_what_it_is_about(self):
        with self.assertRaises(ElevationSurfaceError) as raised:
            reconstruct(numpy.array([grid(3).GetPoint(i) for i in range(9)]),
                        faults=numpy.array([[8.0, 8, 0], [9, 9, 0]]))
        error = raised.exception
        self.assertEqual((error.step, error.about), ("triangulating", "faults"))
        self.assertEqual(str(error), f"triangulating: {error.message}")

    def test_a_panel_names_its_fields(self):
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, grid(4))
        chain.SetGapTolerance(-1.0)
        with Messages(chain) as messages:
            chain.Update()
        self.assertIn("Gap Tolerance takes a number of 0 or more, not -1.0", messages.errors[0])

    def test_words_of_the_user_stay(self):
        with written_for(PANEL):
            chain = ReconstructElevationSurface()
            chain.SetInputDataObject(0, grid(4))
            chain.SetElevationArray("--a maximum_edge_length")
            with Messages(chain) as messages:
                chain.Update()
        self.assertIn("--a maximum_edge_length", messages.errors[0])

    def test_one_of_what_is_left_out_is_singular(self):
        for reason, one, many in (
            (Reason("row", "without data"), "1 row without data", "2 rows without data"),
            (Reason("text"), "1 text", "2 texts"),
        ):
            self.assertEqual((counted_reason(1, reason), counted_reason(2, reason)), (one, many))


class Sources(unittest.TestCase):
    """That no message slips past."""

    def test_only_one_place_reports(self):
        for top in ("Filters", "Python/Pieces"):
            for folder, _, names in os.walk(os.path.join(ROOT, top)):
                for name in names:
                    if name == "ReportMessages.cxx":
                        continue
                    with self.subTest(name):
                        self.assertNotRegex(
                            read_source(folder, name), r"vtk(Generic)?(Error|Warning)(WithObject)?Macro\([^)]")

    def test_the_headers_list_the_codes(self):
        table = read_source("Filters", "Kernel", "Messages", "Sentences.h")
        codes = re.findall(r"^ELEVATION_SENTENCE\(\s*(\w+),", table, re.M)
        self.assertGreater(len(codes), 30)
        self.assertEqual(len(codes), len(set(codes)))
        headers = "".join(read_source(name) for name in HEADERS)
        listed = set(re.findall(r"\w+", headers))
        self.assertEqual([code for code in codes if code not in listed], [])

    def test_each_code_is_used(self):
        codes = re.findall(r"^ELEVATION_SENTENCE\(\s*(\w+),",
                           read_source("Filters", "Kernel", "Messages", "Sentences.h"), re.M)
        sources = "".join(
            read_source(folder, name)
            for folder, _, names in os.walk(os.path.join(ROOT, "Filters")) for name in names)
        self.assertEqual([code for code in codes if f"sentences::{code}" not in sources], [])

    def test_sentences_of_filters_are_for_all_who_use_them(self):
        table = read_source("Filters", "Kernel", "Messages", "Sentences.h")
        self.assertNotRegex(table, r"(?i)\bpress\b|\bclick|\bapply\b|\bpanel\b")  # as of a panel in ParaView

    def test_nothing_is_written_as_an_option_of_the_program_alone(self):
        # Those of the program's own run may: no panel sees them.
        own = ("command.py", "description.py", "help.py", "options.py", "pieces.py", "slicing.py", "names.py",
               "properties.py")
        for folder, _, names in os.walk(PACKAGE):
            for name in names:
                if not name.endswith(".py") or name in own:
                    continue
                tree = ast.parse(read_source(folder, name))
                docs = {ast.get_docstring(node, clean=False) for node in ast.walk(tree)
                        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef))}
                for node in ast.walk(tree):
                    if isinstance(node, ast.Constant) and isinstance(node.value, str):
                        with self.subTest(name, line=node.lineno):
                            self.assertTrue(
                                node.value in docs or not re.search(r"--([a-z]|$)", node.value), node.value)


if __name__ == "__main__":
    unittest.main()
