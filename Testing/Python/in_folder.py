# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What tests share: files made in a folder that goes away, how errors must look, and runs of the
program."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import forked
import numpy
from vtkelevationsurface import reading
from vtkelevationsurface.messages import FileError
from vtkmodules.util.numpy_support import vtk_to_numpy


# The program starts Xvfb where there is no display.
draws = unittest.skipIf(
    sys.platform.startswith("linux") and not os.environ.get("DISPLAY") and not shutil.which("Xvfb"),
    "there is no display, and Xvfb is not installed")


def coordinates(cloud):
    return vtk_to_numpy(cloud.points.GetPoints().GetData())


class InFolder(unittest.TestCase):
    """Gives each test a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def file(self, name, content):
        path = self.path(name)
        with open(path, "wb") as stream:
            stream.write(content if isinstance(content, bytes) else content.encode())
        return path

    def read(self, content, name="a.txt", **options):
        return reading.read(self.file(name, content), **options)

    def assert_rows(self, cloud, rows):
        numpy.testing.assert_array_equal(coordinates(cloud), numpy.array(rows, dtype="f8"))

    def assert_refused(self, words, content, name="a.txt", **options):
        """The error is one line that begins with the file's name and holds the words."""
        with self.assertRaises(FileError) as caught:
            self.read(content, name, **options)
        text = str(caught.exception)
        self.assertTrue(text.startswith(self.path(name)), text)
        self.assertNotIn("\n", text)
        for word in [words] if isinstance(words, str) else words:
            self.assertIn(word, text)


class Program(InFolder):
    """Runs the program in the folder."""

    PROGRAM = (sys.executable, *forked.PROGRAM)

    def file(self, name, content):
        super().file(name, content)
        return name

    def json(self, name):
        """What a report holds."""
        with open(self.path(name), encoding="utf-8") as stream:
            return json.load(stream)

    def execute(self, *command, **options):
        """Any command, in the folder."""
        return subprocess.run(
            command,
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            timeout=300,
            check=False,
            **options,
        )

    def call(self, *arguments, env=None, largest_file=None):
        """As execute() of PROGRAM with the arguments, but quicker. Files can be limited, in bytes."""
        return forked.python(
            *forked.PROGRAM, *arguments, folder=self.folder, environment=env, largest_file=largest_file)
