# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""How the program behaves: options, several files, interrupts."""

import os
import random
import signal
import subprocess
import sys
import time
import unittest

import numpy
from in_folder import Program, draws
from vtkelevationsurface import clouds
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy


STOPPED = "reconstruct: stopped; nothing is written\n"


def sheet(size, x=0.0):
    """size x size points of a plane, one apart."""
    rows = [(x + i, j, 0.5 * i - 0.25 * j) for j in range(size) for i in range(size)]
    return "".join(f"{a:g} {b:g} {c:g}\n" for a, b, c in rows)


class Options(Program):
    def test_the_version_is_printed(self):
        done = self.call("--version")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, r"^reconstruct \d+\.\d+\.\d+ \(VTK 9")

    def test_a_misspelt_option_is_named_with_the_right_one(self):
        for wrong, right in (
            ("--maximum-edg-length", "--maximum-edge-length"),
            ("--breakline", "--breaklines"),
            ("--pictures=a.png", "--picture"),
            ("--zebra", None),
        ):
            with self.subTest(option=wrong):
                done = self.call("a.xyz", wrong)
                self.assertEqual(done.returncode, 2)
                self.assertEqual(len(done.stderr.splitlines()), 1)
                self.assertIn(f"unknown option {wrong}", done.stderr)
                if right:
                    self.assertIn(f"did you mean {right}?", done.stderr)
                else:
                    self.assertNotIn("did you mean", done.stderr)

    def test_properties_that_are_on_or_off_have_two_options(self):
        from vtkelevationsurface import options

        switches = [n for n, one in options.PROPERTIES.items() if one.words["takes"] == "switch"]
        self.assertIn("recover_boundary", switches)
        for name in switches:
            on = options.option(name)
            off = on.replace("--", "--no-", 1)
            for given, value in ((), None), ((on,), True), ((off,), False), ((off, on), True):
                with self.subTest(given=given):
                    parsed = options.make_parser().parse_args(["a.xyz", *given])
                    self.assertIs(getattr(parsed, name), value)
        done = self.call("a.xyz", "--recover-boundary=1")
        self.assertEqual(done.returncode, 2)
        self.assertIn("error: --recover-boundary takes no value; see --help", done.stderr)

    def test_all_of_the_program_takes_the_threads_that_are_given(self):
        self.file("a.xyz", sheet(4))
        code = (
            "import sys; from vtkmodules.vtkCommonCore import vtkSMPTools as tools; tools.Initialize(2); "
            "from vtkelevationsurface.command import main; main(sys.argv[1:]); "
            "print(tools.GetEstimatedNumberOfThreads())"
        )
        for given, expected in ((), "2"), (("--threads", "1"), "1"), (("--threads", "5"), "2"):
            command = sys.executable, "-c", code, "a.xyz", "--quiet", "--no-picture", *given
            done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
            self.assertEqual((done.stdout, done.stderr), (f"{expected}\n", ""), given)

    def test_what_follows_two_dashes_is_a_file(self):
        self.file("-a.xyz", sheet(4))
        self.assertEqual(self.call("--no-picture", "--", "-a.xyz").returncode, 0)
        self.assertTrue(os.path.exists(os.path.join(self.folder, "-a_surface.vtp")))

    def test_longitudes_around_the_antimeridian_get_a_hint(self):
        rows = "".join(
            f"{x if x <= 180 else x - 360:g} {y:g} {x + y:g}\n"
            for x in range(170, 191) for y in range(-30, -20)
        )
        self.file("fiji.xyz", rows)
        self.assertIn("add 360 to negative", self.call("fiji.xyz", "--no-picture").stdout)
        self.file("greenwich.xyz", rows.replace("-1", "1"))
        self.assertNotIn("add 360", self.call("greenwich.xyz", "--no-picture").stdout)


class SeveralFiles(Program):
    def test_points_are_merged(self):
        self.file("a.xyz", sheet(5))
        self.file("b.xyz", sheet(5, 5.0))
        done = self.call("a.xyz", "b.xyz", "--no-picture", "--report")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        report = self.json("a_surface.json")
        self.assertEqual((report["file"], report["points"]), ("a.xyz + b.xyz", 50))
        self.assertEqual(report["triangles"]["filled"], 2 * 9 * 4)
        self.assertIn("b.xyz: 25 points", report["notes"])

    def test_each_has_a_surface_and_one_that_fails_does_not_stop_the_others(self):
        self.file("a.xyz", sheet(5))
        self.file("b.xyz", "1 2 3\n")
        self.file("c.xyz", sheet(4))
        done = self.call("a.xyz", "b.xyz", "c.xyz", "--each", "--no-picture")
        self.assertEqual(done.returncode, 1)
        self.assertIn("b.xyz: no surface", done.stderr)
        made = sorted(n for n in os.listdir(self.folder) if n.endswith(".vtp"))
        self.assertEqual(made, ["a_surface.vtp", "c_surface.vtp"])
        done = self.call("a.xyz", "c.xyz", "--each", "-o", "s.vtp")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--each names the results", done.stderr)

    def test_each_does_not_overwrite_its_own_results(self):
        self.file("a.xyz", sheet(5))
        self.file("a.txt", sheet(4))
        done = self.call("a.xyz", "a.txt", "--each", "--no-picture")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--each would write a_surface.vtp twice", done.stderr)

    def test_files_may_stand_between_options(self):
        self.file("a.xyz", sheet(5))
        self.file("b.xyz", sheet(4))
        self.assertEqual(self.call("--no-picture", "a.xyz", "--each", "b.xyz").returncode, 0)
        self.assertIn("b_surface.vtp", os.listdir(self.folder))

    def test_arrays_that_all_files_have_are_kept(self):
        parts = []
        for names in (("a", "b"), ("b", "c")):
            data = clouds.make_points(numpy.eye(3))
            for name in names:
                array = numpy_to_vtk(numpy.arange(3.0), deep=True)
                array.SetName(name)
                data.GetPointData().AddArray(array)
            parts.append(clouds.Cloud(data, left_out={"pixels": 1}))
        one = clouds.merged(["x", "y"], parts)
        self.assertEqual(one.points.GetNumberOfPoints(), 6)
        self.assertEqual(one.points.GetPointData().GetNumberOfArrays(), 1)
        array = one.points.GetPointData().GetArray("b")
        self.assertEqual(vtk_to_numpy(array).tolist(), [0, 1, 2, 0, 1, 2])
        self.assertEqual(one.left_out, {"pixels": 2})
        self.assertIn("point arrays that not all files have are left out", one.notes)


@draws
class Interrupts(Program):
    def start(self, *arguments):
        return subprocess.Popen(
            [*self.PROGRAM, *arguments], cwd=self.folder, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True, env={**os.environ, "TMPDIR": self.temporary},
        )

    def setUp(self):
        super().setUp()
        self.temporary = os.path.join(self.folder, "temporary")
        os.mkdir(self.temporary)
        random_numbers = numpy.random.RandomState(5)
        xyz = random_numbers.rand(30000, 3) * (1000.0, 1000.0, 1.0)
        numpy.savetxt(os.path.join(self.folder, "a.xyz"), xyz, "%.3f")

    def test_at_any_time_it_ends_cleanly(self):
        before = sorted(os.listdir(self.folder))
        began = time.monotonic()
        self.assertEqual(self.call("a.xyz", "-o", "first.ply").returncode, 0)
        whole = time.monotonic() - began
        for name in ("first.ply", "first.png"):
            os.remove(os.path.join(self.folder, name))
        moments = random.Random(7)
        stopped = 0
        for run in range(40):
            if stopped == 4:
                break
            number = moments.choice((signal.SIGINT, signal.SIGINT, signal.SIGTERM, signal.SIGHUP))
            moment = moments.uniform(0.0, 0.9) * whole
            with self.subTest(run=run, signal=number, moment=moment):
                program = self.start("a.xyz", "-o", "a.ply")
                while not os.listdir(self.temporary) and program.poll() is None:
                    time.sleep(0.001)  # before its folder is there, Python itself starts
                time.sleep(moment)
                program.send_signal(number)
                _, errors = program.communicate(timeout=300)
                made = sorted(set(os.listdir(self.folder)) - set(before))
                for name in made:
                    os.remove(os.path.join(self.folder, name))
                self.assertEqual(os.listdir(self.temporary), [])
                if program.returncode == 0:
                    self.assertEqual((errors, made), ("", ["a.ply", "a.png"]))
                    whole *= 0.8  # it runs faster than before, when the machine was busier
                else:
                    stopped += 1
                    self.assertEqual(program.returncode, 130)
                    self.assertEqual((errors, made), (STOPPED, []))
        # A program that went on until it was done would never have stopped.
        self.assertEqual(stopped, 4)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
