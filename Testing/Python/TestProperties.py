# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What properties.ini says of the properties is what the classes, the program and the table say."""

import contextlib
import io
import math
import re
import unittest

import properties_table
from documented import text_of
from vtkelevationsurface import (
    algorithms,
    read,
    reconstruct,
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)
from vtkelevationsurface.description import DESCRIBED, titled
from vtkelevationsurface.help import help_text
from vtkelevationsurface.options import OPTIONS, parse_arguments
from vtkmodules.vtkCommonExecutionModel import vtkPolyDataAlgorithm

CLASSES = {
    "delaunay": vtkGridDelaunay2D,
    "trim": vtkTrimOutwardTriangles,
    "fill": vtkFillElevationHoles,
}
# A value of each kind that takes one, other than the default.
VALUES = {
    "columns": "1,2,3",
    "no_data": "0",
    "where": "a=b",
    "classes": "2",
    "memory": "2G",
    "view": "top",
    "lattice_tolerance": "0.1",
    "confidence_level": "0.8",
}
# The second inputs and the processes, which are not numbers.
OTHERS = {
    "SourceConnection", "SourceData", "BoundaryConnection", "BoundaryData", "AreasConnection", "AreasData",
    "Controller",
}


def properties_of(step):
    """{name in the class: Property}"""
    of_step = [one for one in DESCRIBED.values() if one.setter and one.step in (step, "")]
    return {one.name_in("filter"): one for one in of_step if one.words["takes"] != "lines"}


def numbers(value):
    return list(value) if isinstance(value, tuple) else [value]


def arguments_of(one):
    """An option of the program with a value other than the default."""
    if one.kind.value_type == "bool":
        is_on = one.default_in("program") == "on" and "off" not in one.words
        return [one.options[0].replace("--", "--no-", is_on)]
    return [one.options[0], VALUES.get(one.name) or (one.choices or ("1",))[-1]]


def needs_of(one):
    """The property that it needs, or the first of several, as a list; empty: none."""
    return [DESCRIBED[other] for other in one.words.get("needs", "").split(":")[0].split()[:1]]


def needed_by(one):
    """The arguments of what it needs."""
    return [word for other in needs_of(one) for word in arguments_of(other)]


def refusal_of(*arguments):
    """What the program says before it does anything; "" where it would begin."""
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.suppress(SystemExit):
        parse_arguments(["points.xyz", *arguments])
    return said.getvalue()


class Classes(unittest.TestCase):
    def test_each_property_of_a_class_is_described_and_no_other(self):
        for step, made in CLASSES.items():
            own = set(dir(made)) - set(dir(vtkPolyDataAlgorithm))
            own = {name for name in own if "Deprecated" not in (getattr(made, name).__doc__ or "")}
            has = {name[3:] for name in own if re.match(r"Set(?!\w+To[A-Z])", name)} - OTHERS
            self.assertEqual(set(properties_of(step)), has, step)

    def test_defaults_are_those_of_the_classes(self):
        for step, made in CLASSES.items():
            for name, one in properties_of(step).items():
                with self.subTest(name=name):
                    is_text = one.kind.value_type == "string"
                    default = [None] if is_text else one.kind.numbers(one.default_in("filter"))
                    self.assertEqual(numbers(getattr(made(), f"Get{name}")()), default)

    def test_ranges_and_choices_are_those_of_the_classes(self):
        for step, made in CLASSES.items():
            for name, one in properties_of(step).items():
                with self.subTest(name=name):
                    if hasattr(made, f"Get{name}MaxValue"):
                        least = getattr(made(), f"Get{name}MinValue")()
                        most = getattr(made(), f"Get{name}MaxValue")()
                        self.assertEqual(least, 0)
                        if one.choices:
                            self.assertEqual(most, len(one.choices) - 1)
                        else:
                            self.assertEqual(most if most < 1e9 else math.inf, one.kind.most)
                    for number, choice in enumerate(one.choices):
                        if name == "OutputPointsPrecision":  # VTK numbers its choices
                            self.assertEqual(getattr(made, f"{choice.upper()}_PRECISION"), number)
                            continue
                        algorithm = made()
                        getattr(algorithm, f"Set{name}To{titled(choice).replace(' ', '')}")()
                        self.assertEqual(getattr(algorithm, f"Get{name}")(), number)


class Texts(unittest.TestCase):
    def test_help_of_a_class_says_in_70_lines_what_the_class_is(self):
        for made in CLASSES.values():
            title, superclass, lines = made.__doc__.partition("\nSuperclass: vtkPolyDataAlgorithm\n")
            self.assertTrue(title.startswith(made.__name__) and superclass, title)
            self.assertLessEqual(len(lines.strip().splitlines()), 70, made.__name__)

    def test_the_table_of_the_documentation_is_the_description(self):
        self.assertIn(properties_table.markdown(), text_of("Properties.md"),
                      "python3 Testing/Python/properties_table.py prints what has to stand there")

    def test_each_property_has_words_wherever_it_is(self):
        for one in DESCRIBED.values():
            for place in one.places:
                with self.subTest(name=one.name, place=place):
                    words = one.help_in(place)
                    self.assertRegex(words, r"^[A-Z].+\.$")
                    self.assertNotRegex(words, r"[{}]")
            self.assertNotRegex(one.line, r"\.$|[{}|]")

    def test_docstrings_list_the_properties(self):
        for function, place, steps in (
            (reconstruct, "chain", {"faults", "delaunay", "trim", "fill", ""}),
            (read, "reader", {"read"}),
        ):
            for one in DESCRIBED.values():
                is_its = {"program", place} <= set(one.places) and one.step in steps
                if is_its and one.words["takes"] != "lines" and "off" not in one.words:
                    self.assertIn(f" {one.name}: {one.line}", function.__doc__)

    def test_words_of_the_program_name_options_and_those_of_panels_labels(self):
        one = DESCRIBED["maximum_elevation_error"]
        self.assertIn("with --maximum-edge-length", one.help_in("program"))
        self.assertIn("with Maximum Edge Length", one.help_in("chain"))
        self.assertIn("membrane makes", DESCRIBED["interpolation"].help_in("program"))
        self.assertIn("Membrane makes", DESCRIBED["interpolation"].help_in("chain"))
        self.assertIn(f"  {one.options[0]} HEIGHT\n", help_text())

    def test_descriptions_have_no_key_that_nothing_reads(self):
        known = "step in takes default filter chain program off label advanced needs excludes with"
        known = set(f"{known} without pieces scale readers contents line help".split())
        for one in DESCRIBED.values():
            rest = {key for key in one.words if key not in known}
            self.assertLessEqual({key.split(".")[0] for key in rest}, {"help", "default"}, one.name)
            wrong = {key.split(".")[1] for key in rest} - {*one.places, "panel", "chain"}
            self.assertFalse(wrong, one.name)


class Program(unittest.TestCase):
    def test_options_of_a_step_that_is_left_out_are_refused(self):
        for step in ("trim", "fill", "picture"):
            for name, one in OPTIONS.items():
                if f"--no-{step}" in one.options:
                    continue
                with self.subTest(step=step, name=name):
                    said = refusal_of(f"--no-{step}", *arguments_of(one), *(needed_by(one) if one.step == step else ()))
                    is_refused = f"options have no effect with --no-{step}" in said
                    self.assertEqual(is_refused, one.step == step, said)

    def test_options_of_the_whole_surface_are_refused_in_pieces(self):
        for way in (["--pieces", "3"], ["--memory", "2G"]):
            for name, one in OPTIONS.items():
                if one.step == "pieces" or name == "remove_unused_points":  # given here to keep them, as pieces do
                    continue
                with self.subTest(way=way, name=name):
                    said = refusal_of(*way, *arguments_of(one), *needed_by(one), "--boundary", "b.xyz")
                    needed = (needs_of(one) or [one])[0]
                    is_refused = bool(re.search("needs (the whole|all) .*in memory", said))
                    self.assertEqual(is_refused, not (one.in_pieces and needed.in_pieces), said)

    def test_unused_points_are_not_removed_in_pieces(self):
        self.assertIn("pieces keep all points", refusal_of("--pieces", "3", "--remove-unused-points"))

    def test_properties_that_need_or_exclude_another_are_refused(self):
        for name, one in OPTIONS.items():
            for needs, other, others in [(n, o, others) for n, others, _ in one.rules() for o in others]:
                with self.subTest(name=name, other=other):
                    with_other = refusal_of(*arguments_of(one), *arguments_of(DESCRIBED[other]))
                    alone = refusal_of(*arguments_of(one), "--no-trim", *["--no-fill"] * (one.step != "fill"))
                    said, not_said = (alone, with_other) if needs else (with_other, alone)
                    for name_of_one in others:
                        self.assertIn(DESCRIBED[name_of_one].options[0], said)
                    self.assertEqual(not_said, "")


class Algorithms(unittest.TestCase):
    def test_each_property_of_a_panel_has_its_method(self):
        for place, algorithm in (
            ("chain", algorithms.ReconstructElevationSurface),
            ("reader", algorithms.ElevationPoints),
        ):
            for one in DESCRIBED.values():
                method = getattr(algorithm, "Set" + one.name_in(place), None)
                is_described = place in one.places and one.words["takes"] != "lines"
                self.assertEqual(bool(method), is_described, one.name)

    def test_methods_take_what_a_panel_gives_and_what_python_gives(self):
        chain = algorithms.ReconstructElevationSurface()
        for setter, given, name, value in (
            ("SetInterpolation", 1, "interpolation", "membrane"),
            ("SetInterpolation", "adaptive", "interpolation", "adaptive"),
            ("SetOpenEdgeLength", -1.0, "open_edge_length", None),
            ("SetOpenEdgeLength", 0.0, "open_edge_length", 0.0),
            ("SetFillHoles", 0, "fill", False),
            ("SetNoData", 0, "no_data", "0"),
            ("SetColumns", " ", "columns", None),
            ("SetNumberOfThreads", 3, "threads", 3),
        ):
            with self.subTest(setter=setter, given=given):
                getattr(chain, setter)(given)
                self.assertEqual(chain._properties.get(name), value)
                time = chain.GetMTime()
                getattr(chain, setter)(given)
                self.assertEqual(chain.GetMTime(), time)


if __name__ == "__main__":
    unittest.main()
