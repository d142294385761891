# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""doxygen makes the pages of the classes without a warning, and no method is missing on them.

The last option is --doxygen, with the program and the Doxyfile.
"""

import inspect
import os
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

from vtkelevationsurface import vtkElevationSurface as module

HERE = sys.argv.index("--doxygen")
PROGRAM, DOXYFILE = sys.argv[HERE + 1 :]
# What vtkTypeMacro declares, and the ends of ranges, which the words on a setter give.
CLASS_METHODS = {
    "GetNumberOfGenerationsFromBase",
    "GetNumberOfGenerationsFromBaseType",
    "IsA",
    "IsTypeOf",
    "NewInstance",
    "SafeDownCast",
}
RANGE_ENDS = ("MinValue", "MaxValue")


def methods(wrapped):
    """The names of the methods that a class declares itself, as Python has them."""
    return {
        name
        for name, value in vars(wrapped).items()
        if callable(value)
        and name[0].isupper()
        and not inspect.isclass(value)
        and name not in CLASS_METHODS
        and not name.endswith(RANGE_ENDS)
    }


def pages(folder):
    """{class: names of the methods on its page}"""
    tree = xml.etree.ElementTree.parse(os.path.join(folder, "ElevationSurface.tag"))
    return {
        compound.findtext("name"): {
            member.findtext("name")
            for member in compound.iter("member")
            if member.get("kind") == "function"
        }
        for compound in tree.iter("compound")
        if compound.get("kind") == "class"
    }


class Doxygen(unittest.TestCase):
    def test_each_public_method_has_words_on_a_page_and_nothing_is_warned_of(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(DOXYFILE, encoding="utf-8") as file:
                settings = file.read().replace(os.path.dirname(DOXYFILE), folder)
            run = subprocess.run(
                [PROGRAM, "-"],
                input=settings,
                text=True,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                check=False,
            )
            self.assertEqual((run.returncode, run.stdout), (0, ""))
            shown = pages(folder)
            self.assertTrue(os.path.exists(os.path.join(folder, "html", "index.html")))
        wrapped = {name: one for name, one in vars(module).items() if inspect.isclass(one)}
        self.assertEqual(set(shown), set(wrapped))
        self.assertIn("SetNumberOfThreads", methods(module.vtkGridDelaunay2D))
        for name, one in wrapped.items():
            self.assertEqual(methods(one) - shown[name], set(), name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
