# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What tests share: files made in a folder that goes away, how errors must look, and runs of the
program."""

import os
import subprocess
import sys
import tempfile
import unittest

import numpy
from vtkelevationsurface import reading
from vtkelevationsurface.messages import FileError
from vtkmodules.util.numpy_support import vtk_to_numpy


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

    PROGRAM = (sys.executable, "-m", "vtkelevationsurface")

    def file(self, name, content):
        super().file(name, content)
        return name

    def call(self, *arguments, **options):
        options = {"stdin": subprocess.DEVNULL, **options}
        return subprocess.run(
            [*self.PROGRAM, *arguments],
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            timeout=300,
            check=False,
            **options,
        )
