# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The scripts that repeat the paper's experiments make whole tables, and leave prose alone."""

import csv
import importlib.util
import json
import os
import re
import subprocess
import sys
import unittest

import numpy
from in_folder import InFolder

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BENCHMARKS = os.path.join(ROOT, "Utilities", "Benchmarks")
sys.dont_write_bytecode = True  # nothing is to be left next to the scripts
sys.path.append(BENCHMARKS)

import PaperClouds  # noqa: E402
import PaperMeasures  # noqa: E402
import PaperTables  # noqa: E402

SCRIPT = os.path.join(BENCHMARKS, "reproduce-paper")
BENCHMARK = os.path.join(ROOT, "build", "bench", "bin", "BenchmarkDelaunay")
SIZES = (150, 400)
HAS_MATPLOTLIB = importlib.util.find_spec("matplotlib") is not None
# What BenchmarkDelaunay --json writes, of a set of 100 points.
BENCHMARK_FIGURES = """{"benchmark": "BenchmarkDelaunay", "vtk": "9.1.0", "threads": 1, "seed": 1, "repeats": 2,
  "sets": [{"set": "cloud", "points": 100, "codes": [
    {"code": "vtkGridDelaunay2D", "ns_per_point": {"median": 150, "least": 100, "greatest": 200,
      "runs": [100, 200]}, "processor_ns_per_point": 120, "trial_ns_per_point": 300,
      "bytes_per_point_above_input_and_output": 30, "output_bytes_per_point": 64, "triangles": 180,
      "right": true, "result": "valid, 3 ties"},
    {"code": "CGAL 5.5.1", "not_run": "crashed (signal 11)"},
    {"code": "vtkDelaunay2D 9.1.0", "not_run": "more than 7 s"}]}]}"""


def environment():
    """Without extra data: the clouds are those of Data/."""
    return {name: value for name, value in os.environ.items() if name != PaperClouds.EXTRA}


def run(*arguments):
    return subprocess.run(
        [sys.executable, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        timeout=300, check=False, env={**environment(), "PYTHONDONTWRITEBYTECODE": "1"})


def tables_of(text):
    """{name: rows of cells}"""
    parts = re.findall(r"<!-- table: (\w+) -->\n(.*?)<!-- end of table -->", text, re.DOTALL)
    return {
        name: [[cell.strip() for cell in line.strip("|").split("|")]
               for line in table.strip().splitlines()]
        for name, table in parts
    }


class Script(InFolder):
    @classmethod
    def setUpClass(cls):
        cls.peers = [] if os.path.exists(BENCHMARK) else ["--without-benchmark"]

    def reproduce(self, *options):
        done = run(SCRIPT, self.folder, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.path("Paper.md"), encoding="utf-8") as stream:
            return stream.read()

    def test_tables_are_whole_and_prose_stays(self):
        text = self.reproduce(
            "--sizes", ",".join(map(str, SIZES)), "--surfaces", "olinda_land,no_such_surface",
            "--repeats", "1", "--time-limit", "20", *self.peers)
        tables = tables_of(text)
        self.assertEqual(set(tables), set(PaperTables.TABLES))
        for name, rows in tables.items():
            with self.subTest(table=name):
                self.assertEqual({len(row) for row in rows}, {len(rows[0])})
                self.assertNotRegex(" ".join(sum(rows, [])), r"\b(nan|inf|None)\b")
                sized = [row[0] for row in rows[2:] if row[0] in map(str, SIZES)]
                if name not in ("machine", "accuracy") and not (name == "threads" and self.peers):
                    self.assertEqual(sized, [str(size) for size in SIZES])
        asked = [row for row in tables["accuracy"] if row[0] == "olinda_land"]
        self.assertEqual(len(asked), 5)
        self.check_figures()
        # A second run replaces tables alone.
        prose = text.replace("# The paper's", "# Words of my own: the paper's")
        with open(self.path("Paper.md"), "w", encoding="utf-8") as stream:
            stream.write(prose.replace("| 150 |", "| 151 |"))
        stored = os.path.join(self.folder, "figures", "paper_measured.json")
        self.assertEqual(self.reproduce("--from", stored), prose)

    def check_figures(self):
        """The files next to the document, and whether the whole chain did what it should."""
        folder = os.path.join(self.folder, "figures")
        with open(os.path.join(folder, "paper_times.csv"), encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        chains = [row for row in rows if row["code"] == "whole chain"]
        self.assertEqual([int(row["points"]) for row in chains], list(SIZES))
        with open(os.path.join(folder, "paper_measured.json"), encoding="utf-8") as stream:
            measured = json.load(stream)
        for cloud in measured["clouds"]:
            triangles = cloud["chain"]["triangles"]
            self.assertEqual(triangles["trimmed"], triangles["delaunay"] - cloud["chain"]["outward"])
            for key, one in cloud["codes"].items():
                if "not_run" not in one and key not in ("meshlab", "vtk"):
                    self.assertEqual(one["faces"], triangles["delaunay"], key)
        with open(os.path.join(folder, "paper_accuracy.csv"), encoding="utf-8") as stream:
            for row in csv.DictReader(stream):
                if row["error"]:
                    # No point is farther from the surface than above or below it.
                    error = float(row["largest_elevation_error"])
                    self.assertLessEqual(error, float(row["error"]))
                    self.assertLessEqual(float(row["largest"]), error)
        if HAS_MATPLOTLIB:
            for name in ["times", "memory"] + ([] if self.peers else ["threads"]):
                self.assertGreater(os.path.getsize(os.path.join(folder, f"paper_{name}.png")), 5000)

    def test_a_document_without_a_mark_is_refused(self):
        text = "\n<!-- table: times -->\n<!-- end of table -->\n"
        with self.assertRaisesRegex(ValueError, "must have each of these tables once"):
            PaperTables.with_tables(text, {})

    @unittest.skipUnless(HAS_MATPLOTLIB, "matplotlib is missing")
    def test_pictures_of_the_steps_are_drawn(self):
        done = run(os.path.join(ROOT, "Utilities", "step-pictures"), self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(
            sorted(os.listdir(self.folder)), ["steps_distance.png", "steps_fill.png", "steps_trim.png"])
        for name in os.listdir(self.folder):
            self.assertTrue(20_000 < os.path.getsize(self.path(name)) < 200_000, name)


class Parts(InFolder):
    def test_clouds_have_so_many_points(self):
        for count in (150, 5000):
            for points in (PaperClouds.make_horizon(count), PaperClouds.cut(PaperClouds.points_of("b9_ground"), count)):
                self.assertEqual(len(numpy.unique(points[:, :2], axis=0)), count)
        numpy.testing.assert_array_equal(PaperClouds.make_horizon(150), PaperClouds.make_horizon(150))

    def test_a_window_keeps_the_middle_and_the_order(self):
        points = numpy.array([[x, y, 10.0 * x + y] for x in range(5) for y in range(5)], dtype="f8")
        kept = PaperClouds.cut(points, 9)
        self.assertEqual(kept[:, 2].tolist(), [11, 12, 13, 21, 22, 23, 31, 32, 33])

    def test_a_slope_is_the_exponent(self):
        self.assertAlmostEqual(PaperTables.slope([(x, 3 * x**1.5) for x in (10, 70, 900)]), 1.5)
        self.assertIsNone(PaperTables.slope([(10, 3.0)]))

    def test_figures_of_the_benchmark_are_taken(self):
        codes = PaperMeasures.codes_of(json.loads(BENCHMARK_FIGURES))
        ours = codes["default"]
        self.assertAlmostEqual(ours["seconds"], 1.5e-5)
        self.assertAlmostEqual(ours["processor_seconds"], 1.2e-5)
        self.assertEqual((ours["bytes"], ours["faces"], ours["right"]), (9400, 180, True))
        self.assertEqual(PaperTables.cell(codes, "default", "faces"), "180")
        self.assertEqual(PaperTables.cell(codes, "vtk", "seconds"), "more than 7 s")
        self.assertEqual(PaperTables.cell(codes, "cgal", "faces"), "crashed (signal 11)")

    def test_a_time_limit_ends_a_program_and_is_reported(self):
        limited = os.path.join(BENCHMARKS, "RunLimited.py")
        figures = PaperMeasures.called([limited, "1", sys.executable, "-c", "while True: pass"])
        self.assertTrue(figures["out_of_time"])
        self.assertGreater(figures["processor_seconds"], 0.5)
        figures = PaperMeasures.called([limited, "9", sys.executable, "-c", "b'x' * 200_000_000; exit(3)"])
        self.assertEqual((figures["out_of_time"], figures["code"]), (False, 3))
        self.assertGreater(figures["peak_bytes"], 200_000_000)

    def test_faces_and_used_points_of_a_ply_file(self):
        head = (
            "ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty float x\n"
            "property float y\nproperty float z\nproperty uchar flags\nelement face 2\n"
            "property list uchar int vertex_indices\nend_header\n"
        )
        faces = numpy.array([(3, (0, 1, 2)), (3, (2, 1, 4))], dtype=[("n", "u1"), ("ids", "<i4", 3)])
        path = self.file("a.ply", head.encode() + bytes(5 * 13) + faces.tobytes())
        self.assertEqual(PaperClouds.ply_used_points(path), (2, 4))
        path = self.file("b.ply", head.encode() + bytes(5 * 13) + faces.tobytes()[:-4])
        with self.assertRaises(ValueError):
            PaperClouds.ply_used_points(path)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
