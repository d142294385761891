# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Each small file of Testing/Data/Files is read as its table of readings says, or refused with its words."""

import importlib.util
import os
import sys
import unittest

from in_folder import coordinates
from vtkelevationsurface import reading
from vtkelevationsurface.messages import FileError

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "Data", "Files")
TABLE = "readings.txt"
HAS_GDAL = importlib.util.find_spec("osgeo") is not None


def table_rows():
    """[(file, {option: value}, points, first, last, words)]"""
    with open(os.path.join(FOLDER, TABLE), encoding="utf-8") as stream:
        lines = [line.rstrip("\n") for line in stream if not line.startswith("#")]
    rows = []
    for line in lines:
        name, options, *found, words = (cell.strip() for cell in line.split("|", 5))
        pairs = [option.partition("=") for option in options.split()]
        options = {option: value if is_one else True for option, is_one, value in pairs}
        rows.append((name, options, *found, [word for word in words.split(" ; ") if word]))
    return rows


def outcome(name, options):
    """(points, or "error"; the first; the last; notes, or the error)"""
    try:
        cloud = reading.read(os.path.join(FOLDER, name), **options)
    except FileError as error:
        return "error", "", "", str(error)
    points = coordinates(cloud).astype("f8")
    first, last = (" ".join(f"{value:.9g}" for value in points[i]) for i in (0, -1))
    return str(len(points)), first, last, "\n".join(cloud.notes)


class Files(unittest.TestCase):
    def test_each_is_read_as_the_table_says(self):
        for name, options, *expected, words in table_rows():
            with self.subTest(name=name, options=options):
                *found, text = outcome(name, options)
                if not HAS_GDAL and "install python3-gdal" in text:
                    continue
                self.assertEqual(found, expected, text)
                for word in words:
                    self.assertIn(word, text)

    def test_the_table_has_each_file_and_these_are_small(self):
        files = sorted(set(os.listdir(FOLDER)) - {TABLE})
        self.assertEqual(sorted({name for name, *_ in table_rows()}), files)
        for name in files:
            self.assertLess(os.path.getsize(os.path.join(FOLDER, name)), 10_000, name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
