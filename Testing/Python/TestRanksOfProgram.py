# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The program does on several ranks what it does on one: the same surface and report, written once.

The last option is --mpirun, with what starts a program on several ranks, up to their number.
"""

import json
import os
import random
import re
import signal
import struct
import subprocess
import sys
import time
import unittest

import numpy
from in_folder import Program, draws
from many_programs import ManyPrograms
from meshes import by_places as triangles, sorted_rows, sorted_triangles, triangles_of
from on_sheet import CROSSING, text_of
from vtkelevationsurface.reading import vtk_files
from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

HERE = sys.argv.index("--mpirun")
MPIRUN = sys.argv[HERE + 1 :]
DATA = sys.argv[sys.argv.index("-D") + 1]
VARY = ("times", "written", "command", "options")  # what two runs differ in


def cloud(count):
    """Rows of x, y, z and a value, with a hole, duplicates, a comment and what is not a point."""
    numbers = numpy.random.RandomState(3)
    rows = numbers.rand(count, 4) * (100, 80, 5, 9)
    rows = numpy.vstack((rows, rows[:50] + (0, 0, 1, 1)))
    rows = rows[numpy.hypot(rows[:, 0] - 50, rows[:, 1] - 40) > 9]
    numbers.shuffle(rows)
    lines = ["%.3f %.3f %.3f %.1f" % tuple(row) for row in rows]
    lines[100], lines[200], lines[300] = "nan 3 4 1", "5 6 -9999 2", "# comment"
    return "x y z v\n" + "\n".join(lines) + "\n"


def grid():
    """A turned grid with nodes that are missing, one by one and together."""
    x, y = numpy.meshgrid(numpy.arange(60) * 10.0, numpy.arange(50) * 10.0)
    z = numpy.sin(x / 100) * 9 + y / 50
    known = numpy.random.RandomState(4).rand(*x.shape) > 0.05
    known[20:26, 20:30] = False
    rows = numpy.column_stack([a[known] for a in (0.96 * x - 0.28 * y, 0.28 * x + 0.96 * y, z)])
    return "\n".join("%.4f %.4f %.4f" % tuple(row) for row in rows)


def arrays(data):
    """{name: values in the order of their size} of arrays of numbers."""
    return {data.GetArrayName(i): numpy.sort(vtk_to_numpy(data.GetArray(i)), axis=0).tolist()
            for i in range(data.GetNumberOfArrays())}


STARTED = {}  # ManyPrograms by the number of ranks


def tearDownModule():
    ends = [programs.end() for programs in STARTED.values()]
    if any(ends):
        raise AssertionError(f"mpirun ended with {ends}")


def plain(output):
    """The lines without those of libraries of MPI, which report on their surroundings in brackets."""
    return [line for line in output.splitlines() if not line.startswith("[")]


class OnRanks(Program):
    def on(self, ranks, *arguments):
        """Of no rank: the program as it is without mpirun."""
        if ranks == 0:
            return self.call(*arguments)
        return self.execute(*MPIRUN, str(ranks), *self.PROGRAM, *arguments)

    def again_on(self, ranks, *arguments, full_disk=None):
        """As on(), on ranks that are started once for all."""
        if ranks == 0:
            return self.call(*arguments)
        if ranks not in STARTED:
            STARTED[ranks] = ManyPrograms([*MPIRUN, str(ranks)])
        return STARTED[ranks].run(self.folder, *arguments, full_disk=full_disk)

    def report_of(self, ranks, arguments):
        """(the report's lines, the JSON)"""
        done = self.again_on(ranks, *arguments, "--report", "s.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = [line for line in plain(done.stdout) if not line.startswith("  time")]
        report = self.json("s.json")
        report = {name: value for name, value in report.items() if name not in VARY}
        for hole in report.get("holes", {}).get("list", ()):
            del hole["hole"]  # numbers depend on the order of triangles
        if "holes" in report:
            report["holes"]["list"].sort(key=json.dumps)
        os.remove(self.path("s.json"))
        return lines, report

    def results(self, ranks, arguments):
        """(the report's lines, the JSON, the surface)"""
        lines_and_report = self.report_of(ranks, [*arguments, "--no-picture", "-o", "s.vtp"])
        surface = vtk_files.run_vtk_reader(self.path("s.vtp"))
        os.remove(self.path("s.vtp"))
        return (*lines_and_report, surface)

    def result(self, name):
        """What a table holds, or a mesh by places."""
        if name.endswith(".csv"):
            with open(self.path(name), encoding="utf-8") as stream:
                return stream.read()
        return triangles(vtk_files.run_vtk_reader(self.path(name)))

    def in_pieces(self, ranks, arguments):
        """(the report's lines, the JSON, the names of pieces, their triangles by places and by ids)"""
        lines_and_report = self.report_of(ranks, [*arguments, "--pieces", "6", "-o", "s.vtpd"])
        with open(self.path("s.vtpd"), encoding="utf-8") as stream:
            names = re.findall('file="(.*?)"', stream.read())
        parts = [vtk_files.run_vtk_reader(self.path(name)) for name in names]
        self.assertEqual(sorted(names), sorted(f"s/{name}" for name in os.listdir(self.path("s"))))
        for name in (*names, "s.vtpd"):
            os.remove(self.path(name))
        by_ids = [vtk_to_numpy(part.GetPointData().GetGlobalIds())[triangles_of(part)] for part in parts]
        by_place = sorted_rows(numpy.concatenate([triangles(part) for part in parts]))
        return (*lines_and_report, names, by_place, sorted_triangles(numpy.concatenate(by_ids)))

    def check_pieces(self, *arguments):
        """Returns the report."""
        *words, places, ids = self.in_pieces(0, arguments)
        *rank_words, rank_places, rank_ids = self.in_pieces(3, arguments)
        self.assertEqual(rank_words, words)
        numpy.testing.assert_array_equal(rank_places, places)
        numpy.testing.assert_array_equal(rank_ids, ids)
        return words[1]

    def check_same(self, ranks, *arguments):
        lines, report, surface = self.results(0, arguments)
        rank_lines, rank_report, rank_surface = self.results(ranks, arguments)
        self.assertEqual(rank_lines, lines)
        self.assertEqual(rank_report, report)
        numpy.testing.assert_array_equal(triangles(rank_surface), triangles(surface))
        self.assertEqual(rank_surface.GetPoints().GetDataType(), surface.GetPoints().GetDataType())
        for name in ("GetPointData", "GetCellData", "GetFieldData"):
            mine, expected = (arrays(getattr(data, name)()) for data in (rank_surface, surface))
            mine.pop("HoleId", None), expected.pop("HoleId", None)
            self.assertEqual(mine.keys(), expected.keys(), name)
            for array, values in expected.items():
                numpy.testing.assert_array_equal(mine[array], values, array)
        first = report["points"]  # the input's points come first, in their order
        mine, expected = (vtk_to_numpy(d.GetPoints().GetData())[:first] for d in (rank_surface, surface))
        numpy.testing.assert_array_equal(mine, expected)

    def test_a_table_with_duplicates_and_nulls(self):
        self.file("a.txt", cloud(1500))
        self.check_same(3, "a.txt", "--duplicates", "keep-highest")

    def test_several_surfaces_in_a_table(self):
        rows = "".join(f"\"{name}\",{x},{y},{z + x * y}\n"
                       for name, z in (("Top, a", 0), ("Base", -900))
                       for x in range(30) for y in range(20))
        self.file("h.csv", "name,x,y,z\n" + rows)
        alone, together = (self.on(ranks, "h.csv", "--no-picture") for ranks in (0, 3))
        self.assertIn("600 of 600 places have several heights, up to 900 apart", alone.stderr)
        self.assertEqual(together.returncode, 1)
        self.assertIn(alone.stderr.strip(), together.stderr)
        self.check_same(3, "h.csv", "--where", "name=Base")
        self.check_same(3, "h.csv", "--duplicates", "keep-lowest")
        done = self.again_on(3, "h.csv", "--no-picture", "--each-value", "name")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)),
                         ["h.csv", "h_Base_surface.vtp", "h_Top_a_surface.vtp"])
        for arguments, code, expected in (
            (("--each-value", "horizon"), 1, "there is no column horizon"),
            (("--each-value", "y", "--report", "a.json"), 2, "--each-value names the results"),
        ):
            done = self.again_on(3, "h.csv", "--no-picture", *arguments)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(expected, done.stderr)

    def test_a_grid_with_missing_nodes(self):
        self.file("a.txt", grid())
        self.check_same(2, "a.txt")

    def test_few_points_within_an_elevation_error(self):
        self.file("a.txt", grid())
        self.check_same(2, "a.txt", "--maximum-elevation-error", "0.5")
        self.check_same(2, "a.txt", "--maximum-number-of-points", "100")

    def test_ids_of_64_bits(self):
        points = vtk_files.run_vtk_reader(os.path.join(DATA, "b9_ground.vtp"))
        ids = numpy_to_vtkIdTypeArray(2**35 + numpy.arange(points.GetNumberOfPoints()), deep=True)
        ids.SetName("well")
        points.GetPointData().AddArray(ids)
        writer = vtkXMLPolyDataWriter()
        writer.SetFileName(self.path("a.vtp"))
        writer.SetInputData(points)
        writer.Write()
        self.check_same(2, "a.vtp")

    def test_few_lines_that_cross(self):
        self.file("a.txt", text_of(CROSSING))
        self.check_same(2, "a.txt")

    def test_points_all_of_whose_triangles_are_on_other_ranks(self):
        self.file("a.txt", "0 0 1\n9 0 2\n4 7 3\n5 2 4\n3 3 5\n")
        self.check_same(3, "a.txt", "--no-trim", "--no-fill")

    def test_heights_and_volumes_are_those_of_one_rank(self):
        self.file("a.txt", cloud(1500))
        self.file("b.txt", cloud(900))
        self.file("p.csv", "x,y\n50,40\n10,10\n500,1\n51.3,38.2\n70,20.5\n")
        self.file("far.txt", "0 300 1\n9 300 2\n4 307 3\n")
        for name in ("b", "far"):
            self.assertEqual(self.call(f"{name}.txt", "--no-picture", "-o", f"{name}.vtp").returncode, 0)
        given = set(os.listdir(self.folder))
        for options in (
            ("--at", "p.csv", "--volume", "b.vtp"),
            ("--at", "p.csv", "--method", "natural-neighbor", "--volume", "2.5"),
        ):
            made = {}
            for ranks in (0, 2, 4):
                words = self.report_of(ranks, ["a.txt", "--no-picture", *options])
                names = sorted(set(os.listdir(self.folder)) - given - {"a_surface.vtp"})
                made[ranks] = (*words, names, [self.result(name) for name in names])
                for name in names:
                    os.remove(self.path(name))
            lines, report, names, results = made.pop(0)
            with self.subTest(options=options):
                self.assertEqual(len(names), options.count("--at") + options.count("--volume"))
                for other_lines, other_report, *others in made.values():
                    self.assertEqual(other_lines, lines)
                    self.assertEqual(other_report, report)
                    self.assertEqual(others[0], names)
                    for mine, expected in zip(others[1], results):
                        numpy.testing.assert_array_equal(mine, expected)
        os.remove(self.path("a_surface.vtp"))
        refused = self.again_on(2, "a.txt", "--no-picture", "--volume", "far.vtp")
        said = [line for line in refused.stderr.splitlines() if "reconstruct:" in line]
        self.assertEqual((refused.returncode, len(said), plain(refused.stdout)), (1, 1, []), refused.stderr)
        self.assertIn("--volume: far.vtp and the surface do not overlap", said[0])
        self.assertEqual(set(os.listdir(self.folder)), given)

    def test_mpirun_with_one_rank(self):
        self.file("a.txt", cloud(300))
        self.check_same(1, "a.txt")

    def test_what_stays_spread_until_the_end(self):
        self.check_same(3, os.path.join(DATA, "b9_ground.vtp"), "--no-trim", "--no-fill")

    def test_faults_and_a_boundary(self):
        horizon, faults, boundary = (
            os.path.join(DATA, f"horizon_synthetic{part}.vtp") for part in ("", "_faults", "_boundary"))
        self.check_same(2, horizon, "--faults", faults, "--boundary", boundary, "--depth")

    def test_faults_that_are_lost_as_gaps(self):
        self.file("a.txt", grid())
        self.file("f.txt", "x y z\n100 151 7\n400 352 7\n\n200 150 5\n200.5 160 5\n203 400 5\n")
        arguments = "a.txt", "--faults", "f.txt"
        self.check_same(3, *arguments)
        self.assertIn("1 of 3 edges of the faults is not in the surface", "".join(self.results(3, arguments)[0]))

    def test_faults_that_follow_the_surface(self):
        horizon, faults = (os.path.join(DATA, f"horizon_synthetic{part}.vtp") for part in ("", "_faults"))
        self.check_same(3, horizon, "--faults", faults, "--faults-z", "drape", "--depth")

    def test_pieces_of_shares_of_an_array(self):
        rows = numpy.genfromtxt(cloud(3000).replace("-9999", "9").splitlines()[1:], comments="#")[:, :3]
        numpy.save(self.path("a.npy"), rows)
        report = self.check_pieces("a.npy", "--open-edge-length", "0")
        self.assertEqual(report["unused_reasons"], {"same x,y as another point": 50, "not finite": 1})
        self.assertEqual((report["several_heights"]["places"], report["holes"]["filled"]), (50, 1))
        self.assertEqual(report["trim"]["boundary"], "found from the points")
        self.check_pieces("a.npy", "--no-trim", "--no-fill", "--maximum-edge-length", "3")
        report = self.check_pieces("a.npy", "--open-edge-length", "6", "--maximum-hole-size", "12")
        self.assertGreater(report["holes"]["bridged_left"], 0)

    def test_pieces_of_a_text_that_one_rank_reads_along_a_boundary_and_faults(self):
        self.file("a.txt", cloud(1500))
        self.file("f.txt", "20 30 3\n35 60 3\n")
        self.file("b.txt", "5 5\n90 8\n80 70\n10 60\n5 5\n")
        report = self.check_pieces("a.txt", "--boundary", "b.txt", "--faults", "f.txt", "--depth",
                                   "--no-data", "-9999")
        self.assertGreater(report["faults"]["added_points"], 0)
        self.assertGreater(report["unused_reasons"]["outside the boundary"], 10)

    def test_pieces_of_a_lattice_in_several_files(self):
        rows = numpy.array([[float(word) for word in line.split()] for line in grid().splitlines()])
        head = b"LASF" + bytes(20) + bytes((1, 2)) + bytes(68)
        head += struct.pack("<HIIBH", 227, 227, 0, 0, 20) + struct.pack("<I5I", len(rows), *[0] * 5)
        head += struct.pack("<6d", 1e-4, 1e-4, 1e-4, 5e5, 6e6, 0.0) + bytes(48)
        whole = numpy.rint(1e4 * rows).astype("i4").tolist()
        self.file("a.las", head + b"".join(struct.pack("<iiiHBBbBH", *row, 7, 1, 2, 0, 0, 0) for row in whole))
        numpy.save(self.path("b.npy"), rows + (5e5 + 900.0, 6e6, 0.0))
        report = self.check_pieces("a.las", "b.npy", "--no-fill", "--crs", "EPSG:32632")
        self.assertTrue(report["lattice"])
        self.assertIn("in 3 pieces", self.again_on(3, "a.las", "--no-fill", "--memory", "2G").stdout)

    def test_what_one_rank_cannot_do_ends_pieces_of_all(self):
        self.file("few.txt", "1 2 3\n4 5 6\n")
        numpy.save(self.path("a.npy"), numpy.random.default_rng(5).random((9000, 3)) * 100.0)
        self.file("a.txt", cloud(1500))
        self.file("flat.txt", "1 1\n2 2\n3 1\n4 4\n")
        given = set(os.listdir(self.folder))
        for full_disk, arguments, code, words in (
            ((1, 5_000), ["a.npy"], 1, "triangulating: The temporary file .*/1/.* cannot be written: File too"),
            ((0, 5_000), ["a.npy"], 1, "triangulating: The temporary file .*/0/.* cannot be written: File too"),
            ((1, 9_000), ["a.txt", "--keep-nulls"], 1, "s/s_2.vtp: cannot be written: File too large"),
            ((2, "write_vtp"), ["a.npy"], 1, "s/s_4.vtp: cannot be written: No space left"),
            ((0, "write_vtpd"), ["a.npy"], 1, "s.vtpd: cannot be written: No space left"),
            ((1, "mkdir"), ["a.npy"], 1, "/1: process 1 cannot make this folder: No space left"),
            (None, ["a.npy", "-o", "none/s.vtpd"], 1, "there is no folder .*/none"),
            (None, ["a.npy", "--pieces", "4"], 2, "--pieces: 4 cannot be made by 3 .*, such as 6; see --help"),
            (None, ["few.txt"], 1, "few.txt: no surface"),
            (None, ["a.npy", "--boundary", "flat.txt"], 1, "flat.txt: the part from line 1 to 4 is not closed"),
        ):
            with self.subTest(full_disk=full_disk, arguments=arguments):
                done = self.again_on(3, "--pieces=6", "-o", "s.vtpd", "--open-edge-length=0",
                                     "--report", "s.json", *arguments, full_disk=full_disk)
                said = [line for line in done.stderr.splitlines() if "reconstruct:" in line]
                self.assertEqual((done.returncode, len(said), plain(done.stdout)), (code, 1, []), done.stderr)
                self.assertRegex(said[0], words)
                self.assertEqual(set(os.listdir(self.folder)), given)

    @draws
    def test_a_surface_for_each_file_with_its_picture(self):
        self.file("a.txt", cloud(1200))
        self.file("b.txt", grid())
        done = self.on(2, "a.txt", "b.txt", "--each")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("Warning", done.stderr)
        self.assertEqual(done.stdout.count("triangulation"), 2)
        made = sorted(set(os.listdir(self.folder)) - {"a.txt", "b.txt"})
        self.assertEqual(made, ["a_surface.png", "a_surface.vtp", "b_surface.png", "b_surface.vtp"])

    def test_errors_are_reported_once_and_leave_nothing(self):
        self.file("a.txt", cloud(1200))
        self.file("two.txt", "1 2 3\n4 5 6\n")
        for arguments in (
            ["two.txt"],
            ["nowhere.txt"],
            ["a.txt", "--foo"],
            ["a.txt", "--boundary", os.path.join(DATA, "aegean_sea_boundary.vtp")],
            ["a.txt", "--at", "nowhere.csv"],
            ["a.txt", "--volume", "a.txt"],
        ):
            with self.subTest(arguments=arguments):
                alone, together = (self.again_on(ranks, *arguments) for ranks in (0, 2))
                self.assertEqual(together.returncode, alone.returncode)
                mine = [line for line in together.stderr.splitlines() if "reconstruct:" in line]
                self.assertEqual(mine, alone.stderr.splitlines())
                self.assertEqual(plain(together.stdout), [])
                self.assertEqual(sorted(os.listdir(self.folder)), ["a.txt", "two.txt"])

    @draws
    def test_a_stop_ends_all_ranks_and_leaves_nothing(self):
        self.file("a.txt", cloud(12000))
        moments = random.Random(7)
        began = time.monotonic()
        self.assertEqual(self.on(3, "a.txt", "--report").returncode, 0)
        whole = time.monotonic() - began
        results = {"a_surface.json", "a_surface.png", "a_surface.vtp"}
        # That of Open MPI 6 ends all ranks by force before the first has removed what is not finished.
        version = subprocess.run([MPIRUN[0], "--version"], capture_output=True, text=True, check=False)
        gives_time = not re.search(r"Open MPI\) [6-9]", version.stdout)
        stopped = 0
        for run in range(20):
            if stopped == 2:
                break
            for name in results & set(os.listdir(self.folder)):
                os.remove(self.path(name))
            program = subprocess.Popen(
                [*MPIRUN, "3", *self.PROGRAM, "a.txt", "--report"], cwd=self.folder, text=True,
                stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            time.sleep(moments.uniform(0.3, 0.9) * whole)
            program.send_signal(signal.SIGINT)
            _, errors = program.communicate(timeout=300)
            made = set(os.listdir(self.folder)) - {"a.txt"}
            if not gives_time:
                made = {name for name in made if ".partial" not in name}
            with self.subTest(run=run):
                self.assertIn(made, (set(), results))
                self.assertLessEqual(errors.count("reconstruct:"), 1)
                if made:
                    whole *= 0.8  # it runs faster than before, when the machine was busier
                else:
                    stopped += 1
                    self.assertNotEqual(program.returncode, 0)
        self.assertEqual(stopped, 2)


class Example(Program):
    def test_all_ranks_have_the_triangles_of_one(self):
        alone = (sys.executable, os.path.join(DATA, "..", "Examples", "Python", "many_ranks.py"))
        expected = plain(self.execute(*alone).stdout)
        self.assertRegex(expected[0], "^[0-9,]+ triangles, 211.885 square kilometres$")
        lines = plain(self.execute(*MPIRUN, "3", *alone, "s.pvtp").stdout)
        self.assertEqual(lines[:2], expected[:2])
        self.assertEqual(lines[2].count(", "), 2)
        parts = sorted(set(os.listdir(self.folder)) - {"s.pvtp"})
        self.assertLess(len(parts), len(os.listdir(self.folder)))
        counts = [vtk_files.run_vtk_reader(self.path(part)).GetNumberOfPolys() for part in parts]
        self.assertEqual(f"{sum(counts):,} triangles", expected[0].split(" tri")[0] + " triangles")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
