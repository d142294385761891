# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What Utilities/Benchmarks/run-all makes of what the benchmarks write, and how it compares two runs."""

import contextlib
import importlib.machinery
import importlib.util
import io
import json
import os
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../Utilities/Benchmarks")


def load():
    path = os.path.join(FOLDER, "run-all")
    sys.path.insert(0, FOLDER)
    sys.dont_write_bytecode = True  # next to the sources
    loader = importlib.machinery.SourceFileLoader("run_all", path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("run_all", loader))
    loader.exec_module(module)
    return module


RUN_ALL = load()
MEMORY = "bytes_per_point_above_input_and_output"


def run(figures, processor="P", commands=None):
    return {
        "processor": processor, "date": "2000-01-01", "commit": "0", "figures": figures,
        "commands": commands or {"B": "--x"},
    }


def verdicts(new, old):
    return {name: verdict for name, _, verdict in RUN_ALL.compared(run(new), run(old))}


def exit_code(new, old):
    with contextlib.redirect_stdout(io.StringIO()) as output:
        code = RUN_ALL.comparison(new, old)
    return code, output.getvalue()


class Comparison(unittest.TestCase):
    def test_worse_is_what_leaves_the_stored_range_by_more_than_five_percent(self):
        old = {name: [1.0, 1.02, 0.98, 1.1, 0.99] for name in "abcdef"}
        new = {
            "a": [1.0, 1.02, 0.98, 1.1, 0.99],  # the same
            "b": [1.5, 1.45, 1.55, 1.6, 1.5],  # clearly worse
            "c": [1.5, 1.45, 1.09, 1.6, 1.5],  # one round as good as before
            "d": [0.5, 0.52, 0.51, 0.5, 0.49],  # better
            "e": [0.5, 0.52, 0.51, 0.99, 0.49],  # perhaps better
        }
        expected = {"a": "same", "b": "worse", "c": "same", "d": "better", "e": "same"}
        self.assertEqual(verdicts(new, old), expected)

    def test_a_difference_of_a_few_percent_is_none(self):
        self.assertEqual(verdicts({"a": [1.04, 1.041]}, {"a": [1.0, 1.001]}), {"a": "same"})

    def test_memory_comes_in_pages(self):
        old = {"memory, a": [1.0, 1.01], "memory, b": [1.0, 1.01]}
        new = {"memory, a": [1.15, 1.16], "memory, b": [1.3, 1.31]}
        self.assertEqual(verdicts(new, old), {"memory, a": "same", "memory, b": "worse"})

    def test_the_longest_of_many_short_times_varies(self):
        old = {"longest of a": [1.0, 1.3], "longest of b": [1.0, 1.3]}
        new = {"longest of a": [1.8, 1.9], "longest of b": [2.5, 2.6]}
        expected = {"longest of a": "same", "longest of b": "worse"}
        self.assertEqual(verdicts(new, old), expected)

    def test_exit_codes(self):
        old = run({"a": [1.0, 1.1], "b": [1.0, 1.1]})
        self.assertEqual(exit_code(old, old)[0], 0)
        code, text = exit_code(run({"a": [1.0, 1.1], "b": [2.0, 2.1]}), old)
        self.assertEqual(code, 1)
        self.assertIn("1 of 2 figures are worse", text)

    def test_nothing_in_common_or_another_way_of_measuring_is_not_a_success(self):
        old = run({"a": [1.0]})
        self.assertEqual(exit_code(run({"b": [1.0]}), old)[0], 2)
        code, text = exit_code(run({"a": [1.0]}, commands={"B": "--y"}), old)
        self.assertEqual(code, 2)
        self.assertIn("measured in another way: B", text)

    def test_missing_figures_and_other_processors_are_reported(self):
        _, text = exit_code(run({"a": [1.0]}, "Q"), run({"a": [1.0], "gone": [1.0]}))
        self.assertIn("another processor", text)
        self.assertRegex(text, r"gone +not measured")


class Ratios(unittest.TestCase):
    def test_of_triangulating_are_parts_of_cgal(self):
        codes = [
            {"code": "vtkGridDelaunay2D", "processor_ns_per_point": 50.0, MEMORY: 40.0},
            {"code": "CGAL 5.5.1", "processor_ns_per_point": 200.0, MEMORY: 160.0},
            {"code": "vtkDelaunay2D", "not_run": "more than 1 s"},
        ]
        written = {"sets": [{"set": "U", "codes": codes}, {"set": "L", "codes": codes[:1]}]}
        ratios = RUN_ALL.ratios_of("BenchmarkDelaunay", written)
        self.assertEqual(ratios, {"triangulating U / CGAL": 0.25, "memory, U / CGAL": 0.25})

    def test_of_trimming_are_parts_of_triangulating_the_same_points(self):
        written = {
            "L, vtkGridDelaunay2D": 2.0, "L, trimmed": 1.0,
            "U, vtkGridDelaunay2D": 4.0, "U, trimmed": 1.0,
        }
        ratios = RUN_ALL.ratios_of("BenchmarkTrim", written)
        self.assertEqual(ratios, {"L, trimmed": 0.5, "U, trimmed": 0.25})

    def test_of_filling_are_parts_of_a_yardstick_that_comes_last(self):
        written = {"ThinPlate": 1.0, "Membrane": 3.0, "vtkFillHolesFilter": 4.0}
        ratios = RUN_ALL.ratios_of("BenchmarkFill", written)
        self.assertEqual(ratios, {"filled by ThinPlate": 0.25, "filled by Membrane": 0.75})

    def test_of_silences_and_aborts_are_parts_of_the_whole_update(self):
        written = {
            "F, whole update": 2.0, "F, silence": 0.5, "F, abort to end": 0.25,
            "G, whole update": 4.0, "G, silence": 0.5,
        }
        ratios = RUN_ALL.ratios_of("BenchmarkProgress", written)
        self.assertEqual(ratios, {
            "longest of F, silence": 0.25, "longest of F, abort to end": 0.125,
            "longest of G, silence": 0.125})

    def test_of_few_points_are_parts_of_all(self):
        written = {"random, 0 %, 1 threads": 2.0, "random, 10 %, 1 threads": 1.0}
        ratios = RUN_ALL.ratios_of("BenchmarkSimplify", written)
        self.assertEqual(ratios, {"few of random, 10 %, 1 threads": 0.5})

    def test_of_errors_are_parts_of_a_linear_patch_over_all_holes(self):
        rows = [
            {"surface": "dome", "method": method, "covered": covered, "squares": squares}
            for method, covered, squares in (
                ("linear", "1", "16"), ("linear", "3", "48"), ("Adaptive", "4", "16"), ("CGAL", "4", "4"),
                ("Membrane", "0", "0"),
            )
        ]
        ratios = RUN_ALL.ratios_of("BenchmarkFillAccuracy", rows)
        self.assertEqual(ratios, {"error, dome filled by Adaptive / linear": 0.5})

    def test_of_the_program_pieces_and_ranks_are_parts_of_the_row_for_that(self):
        for program, written, expected in (
            ("benchmark-reconstruct", {"numpy.loadtxt": 2.0, "the program": 8.0}, {"the program": 4.0}),
            ("benchmark-pieces", {"in memory": 4.0, "in pieces": 5.0}, {"in pieces": 1.25}),
            ("measure-ranks", {"of a point": 24.0, "2 ranks": 12.0}, {"bytes sent, 2 ranks": 0.5}),
        ):
            self.assertEqual(RUN_ALL.ratios_of(program, written), expected)


class Programs(unittest.TestCase):
    def test_a_script_is_left_out_where_a_module_is_missing_and_python_says_which(self):
        environment = {**os.environ, "PYTHONPATH": ""}
        with mock.patch.dict(RUN_ALL.SCRIPTS, {"benchmark-pieces": ("os", "no_such_module")}):
            why = RUN_ALL.why_left_out("benchmark-pieces", sys.executable, environment)
            self.assertIsNone(RUN_ALL.why_left_out("BenchmarkTrim", sys.executable, environment))
        self.assertIn(sys.executable, why)
        self.assertIn("No module named 'no_such_module'", why)

    def test_scripts_run_in_the_python_of_the_build_and_with_its_package(self):
        with tempfile.TemporaryDirectory() as build:
            programs = os.path.join(build, "bin")
            package = os.path.join(build, "lib", "python3", "dist-packages")
            os.mkdir(programs)
            self.assertEqual(RUN_ALL.python_of(programs), sys.executable)
            for given, taken in ("/bin/sh", "/bin/sh"), ("/no/such/python", sys.executable):
                with open(os.path.join(build, "CMakeCache.txt"), "w", encoding="utf-8") as stream:
                    stream.write(f"Python3_EXECUTABLE:FILEPATH={given}\n")
                self.assertEqual(RUN_ALL.python_of(programs), taken)
            os.makedirs(os.path.join(package, "vtkelevationsurface"))
            with mock.patch.dict(os.environ, {"PYTHONPATH": "relative"}):
                found = RUN_ALL.environment_of(os.path.relpath(programs))["PYTHONPATH"]
            self.assertEqual(found.split(os.pathsep), [package, os.path.abspath("relative")])

    def run_script(self, name, *options):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "figures.json")
            subprocess.run(
                [sys.executable, os.path.join(FOLDER, name), *options, "--json", path],
                check=True, cwd=folder, stdout=subprocess.DEVNULL,
                env=RUN_ALL.ProgramRun.with_absolute_paths(os.environ),
            )
            with open(path, encoding="utf-8") as stream:
                return json.load(stream)

    def test_pieces_and_memory_are_reported_next_to_each_other(self):
        rows = self.run_script(
            "benchmark-pieces", "random", "--points", "20000", "--pieces", "2")
        self.assertEqual(list(rows), ["in memory", "in pieces, random, 20,000 points"])
        self.assertTrue(all(seconds > 0.0 for seconds in rows.values()))

    def test_the_program_is_reported_next_to_loadtxt_with_options_of_its_own(self):
        rows = self.run_script(
            "benchmark-reconstruct", "--points", "1000", "--no-picture", "--threads", "2")
        self.assertEqual(list(rows), ["numpy.loadtxt", "the program, 1,000 points of text"])
        self.assertTrue(all(seconds > 0.0 for seconds in rows.values()))


class Stored(unittest.TestCase):
    def test_run_is_made_as_runs_are_made_now(self):
        with open(os.path.join(FOLDER, "stored.json"), encoding="utf-8") as stream:
            stored = json.load(stream)
        now = {program: " ".join(options) for program, options in RUN_ALL.COMMANDS.items()}
        self.assertEqual(stored["commands"], now)
        for name, ratios in stored["figures"].items():
            is_same = name.startswith(("error,", "bytes sent,"))
            self.assertGreaterEqual(len(ratios), 1 if is_same else 5, name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
