# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The pictures that the program draws, on a display of its own where there is none."""

import os
import shutil
import signal
import subprocess
import sys
import time
import unittest
from unittest import mock

import in_folder
import numpy
from on_sheet import HOLED, SHEET, Program, text_of
from vtkelevationsurface import picture
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader


class Pictures(Program):
    def picture(self, *arguments):
        name = self.file("holed.xyz", text_of(HOLED))
        done = self.call(name, "--maximum-edge-length", "1.5", "--gap-tolerance", "6", *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        reader = vtkPNGReader()
        reader.SetFileName(self.path("holed_surface.png"))
        reader.Update()
        image = reader.GetOutput()
        columns, rows, _ = image.GetDimensions()
        return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(rows, columns, -1)

    @in_folder.draws
    def test_the_picture_shows_the_surface_in_colours_on_white(self):
        pixels = self.picture().astype(int)
        self.assertEqual(pixels[0, 0].tolist(), [255, 255, 255])
        coloured = (pixels.max(axis=2) - pixels.min(axis=2)) > 25
        self.assertGreater(coloured.mean(), 0.2)
        # The outline of the filled hole is the one thing that is redder than anything in the map.
        red = (pixels[:, :, 0] > 150) & (pixels[:, :, 1] < 60) & (pixels[:, :, 2] < 120)
        self.assertGreater(red.sum(), 200)

    @in_folder.draws
    def test_the_view_and_colours_can_be_chosen(self):
        usual, aside = (self.picture("--view", view).astype(int) for view in ("top", "200,30"))
        self.assertTrue(aside.shape != usual.shape or (aside != usual).any())
        # Points of the file have no errors, and are the palest colour; the filled hole is not.
        errors = self.picture("--view", "top", "--colours", "error").astype(int)
        self.assertEqual(usual.shape, errors.shape)
        pale = errors.max(axis=2) - errors.min(axis=2) < 25
        self.assertGreater(pale.mean(), 0.6)
        self.assertGreater((errors != usual).any(axis=2).mean(), 0.1)

    @in_folder.draws
    def test_outliers_strips_and_odd_names_leave_something_to_see(self):
        tilted = [(x, y, x + y) for y in range(40) for x in range(40)]
        for name, rows in (
            ("outlier.xyz", tilted + [(20.5, 20.5, 1e6)]),
            ("flat.xyz", [(x, y, 0) for x, y, _ in tilted] + [(20.5, 20.5, 1e6)]),
            ("strip.xyz", [(x, y, x / 10) for y in range(3) for x in range(1000)]),
            ("slanted.xyz", [(x - y, x + y, x / 10) for y in range(3) for x in range(1000)]),
            ("\u5730\u5f62" + "a" * 200 + ".xyz", tilted),
        ):
            with self.subTest(name=name):
                done = self.call(self.file(name, text_of(rows)), "--picture", "p.png")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                reader = vtkPNGReader()
                reader.SetFileName(self.path("p.png"))
                reader.Update()
                pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)
                coloured = numpy.ptp(pixels, axis=1) > 25
                self.assertGreater(coloured.mean(), 0.04)

    @unittest.skipUnless(
        sys.platform.startswith("linux"), "only X has displays that may be missing"
    )
    def test_without_a_display_the_surface_is_written_with_a_note(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        for display in (None, ":12345"):
            # Without programs on the PATH there is no Xvfb.
            environment = {k: v for k, v in os.environ.items() if k != "DISPLAY"}
            environment["PATH"] = self.folder
            if display:
                environment["DISPLAY"] = display
            with self.subTest(display=display):
                done = self.call(name, env=environment)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertIn("no picture: ", done.stdout)
                self.assertEqual(
                    sorted(os.listdir(self.folder)), ["sheet.xyz", "sheet_surface.vtp"]
                )
                done = self.call(name, "--picture", env=environment)
                self.assertEqual(done.returncode, 1)
                self.assertIn("sheet_surface.png: cannot be drawn", done.stderr)


@unittest.skipUnless(shutil.which("Xvfb"), "Xvfb is not installed")
class VirtualDisplay(Program):
    """Where there is no display, the program starts one of its own, and leaves nothing of it."""

    # Says that it serves display 4242, 4243, ..., but does not, the first so many times.
    DEAF = """#!/bin/bash
        echo x >>"{folder}/starts"
        starts=$(wc -l <"{folder}/starts")
        [ $starts -gt {times} ] && exec {program} "$@"
        eval "echo $((4241 + starts)) >&$2"
        exec sleep 300
        """

    def environment(self):
        environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "XAUTHORITY")}
        environment["TMPDIR"] = self.folder
        return environment

    def with_deaf_server(self, times):
        """The environment in which Xvfb is deaf the first so many times; see take_starts()."""
        tools = self.path("tools")
        os.makedirs(tools, exist_ok=True)
        words = {"folder": tools, "times": times, "program": shutil.which("Xvfb")}
        with open(os.path.join(tools, "Xvfb"), "w", encoding="utf-8") as stream:
            stream.write(self.DEAF.format(**words))
        os.chmod(stream.name, 0o755)
        environment = self.environment()
        environment["PATH"] = tools + os.pathsep + environment["PATH"]
        return environment

    def take_starts(self):
        """How often that server was started; counting begins anew."""
        starts = os.path.join(self.path("tools"), "starts")
        with open(starts, encoding="utf-8") as stream:
            count = len(stream.readlines())
        os.remove(starts)
        return count

    def call_with_deaf_server(self, times, *arguments):
        """(the run, how often the server was started, the files that are left)"""
        done = self.call(*arguments, env=self.with_deaf_server(times))
        made = sorted(set(os.listdir(self.folder)) - {"tools", "sheet.xyz"})
        for name in made:
            os.remove(self.path(name))
        return done, self.take_starts(), made

    def test_a_server_that_does_not_answer_is_started_again(self):
        class Library:
            """One that reaches the second server, 4243. A real one may lose a race with others."""

            class XOpenDisplay:
                restype = None

                def __new__(cls, _):
                    return 1 if os.environ["DISPLAY"] == ":4243" else None

        libraries = mock.Mock(CDLL=lambda _: Library, c_void_p=None)
        with mock.patch.dict(os.environ, self.with_deaf_server(99), clear=True), \
                mock.patch.object(picture.display, "ctypes", libraries):
            with picture.display.screen() as reason:
                self.assertIsNone(reason)
        self.assertEqual(self.take_starts(), 2)

    def test_a_picture_is_drawn_on_the_server_that_answers(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        done, count, made = self.call_with_deaf_server(1, name, "--picture")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertGreater(count, 1)
        self.assertEqual(made, ["sheet_surface.png", "sheet_surface.vtp"])

    def test_a_picture_that_fails_does_not_lose_the_surface(self):
        name = self.file("sheet.xyz", text_of(SHEET))
        done, count, made = self.call_with_deaf_server(99, name, "--report", "r.json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("no picture: Xvfb does not answer, asked 3 times", done.stdout)
        self.assertEqual((count, made), (3, ["r.json", "sheet_surface.vtp"]))
        done, _, made = self.call_with_deaf_server(99, name, "--picture", "--report", "r.json")
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (3, 1), done.stderr)
        self.assertIn("sheet_surface.png: cannot be drawn: Xvfb does not answer", done.stderr)
        self.assertIn("everything else is written", done.stderr)
        self.assertIn("no picture: Xvfb does not answer", done.stdout)
        self.assertEqual(made, ["r.json", "sheet_surface.vtp"])

    def start(self, side=300):
        environment = self.environment()
        rows = "".join(f"{i % side} {i // side} {i % 7}\n" for i in range(side * side))
        name = self.file("sheet.xyz", rows)
        return subprocess.Popen(
            [*self.PROGRAM, name, "--picture"],
            cwd=self.folder,
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def servers(self):
        """Ids of the Xvfb that use a key in this test's folder."""
        found = []
        for entry in os.listdir("/proc"):
            try:
                with open(f"/proc/{entry}/cmdline", "rb") as stream:
                    if self.folder.encode() in stream.read() and entry.isdigit():
                        with open(f"/proc/{entry}/comm", encoding="utf-8") as stream:
                            if "Xvfb" in stream.read():
                                found.append(int(entry))
            except OSError:
                pass
        return found

    def wait_until(self, condition):
        end = time.monotonic() + 300
        while not condition():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)  # servers() looks at all processes

    def displays(self):
        return [n for n in os.listdir(self.folder) if n.startswith("reconstruct-display-")]

    def test_a_picture_is_drawn_and_the_server_ends(self):
        process = self.start(50)
        self.wait_until(self.servers)
        self.assertEqual(process.wait(300), 0)
        self.assertIn("sheet_surface.png", os.listdir(self.folder))
        self.assertEqual((self.servers(), self.displays()), ([], []))

    def test_a_stopped_program_leaves_no_server(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL):
            with self.subTest(number=number):
                process = self.start()
                self.wait_until(self.servers)
                if number == signal.SIGKILL:
                    time.sleep(0.5)  # until the program is the server's client
                process.send_signal(number)
                process.wait(300)
                self.wait_until(lambda: not self.servers())
                if number != signal.SIGKILL:
                    self.assertEqual(self.displays(), [])
                    self.assertEqual(process.returncode, 130)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
