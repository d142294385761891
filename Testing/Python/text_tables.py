# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What tests of text tables share: columns of known numbers, and how a table is read or refused."""

import numpy
from in_folder import InFolder
from vtkelevationsurface.clouds import ReadOptions
from vtkelevationsurface.messages import FileError
from vtkelevationsurface.projecting import notes_on_degrees
from vtkelevationsurface.reading.text import read_text
from vtkelevationsurface.reading.upwards import notes_on_up

COUNT = 60
GENERATOR = numpy.random.default_rng(7)
X = GENERATOR.uniform(452000, 453500, COUNT).round(2)
Y = GENERATOR.uniform(5411000, 5412200, COUNT).round(2)
NEAR_X, NEAR_Y = (X - 450000).round(2), (Y - 5410000).round(2)
Z = (230 + 15 * numpy.sin(X / 200) + 9 * numpy.cos(Y / 150)).round(3)
LON, LAT = (7.5 + X / 3e7).round(7), (48.8 + Y / 9e8).round(7)
INLINE, TRACE = numpy.divmod(numpy.arange(COUNT), 12)
# What a column holds, by a short name.
KINDS = {
    "x": X, "y": Y, "z": Z, "lon": LON, "lat": LAT, "nx": NEAR_X, "ny": NEAR_Y,
    "depth": Z, "down": -Z, "time": (1800 + Z).round(2),
    "gx": (500000 + 25.0 * INLINE - 3.5 * TRACE).round(2),
    "gy": (6100000 + 3.5 * INLINE + 25.0 * TRACE).round(2),
    "il": 2100 + INLINE, "xl": 830 + 2 * TRACE, "line": 7 + INLINE, "trace": 1 + TRACE,
    "id": 1 + numpy.arange(COUNT), "code": ["GRD", "TREE", "EDGE"] * (COUNT // 3),
    "class": GENERATOR.choice([2, 5, 6], COUNT), "amp": GENERATOR.normal(0, 900, COUNT).round(1),
    "r": GENERATOR.integers(0, 256, COUNT), "g": GENERATOR.integers(0, 256, COUNT),
    "b": GENERATOR.integers(0, 256, COUNT), "int": GENERATOR.integers(0, 2000, COUNT),
    "gps": (301245.5 + numpy.cumsum(GENERATOR.uniform(0, 1, COUNT))).round(6),
    "date": ["2021-03-04"] * COUNT, "sd": GENERATOR.uniform(0, 0.02, COUNT).round(4),
}
AS_X, AS_Y = ("x", "lon", "nx", "gx"), ("y", "lat", "ny", "gy")
AS_Z = ("z", "depth", "down", "time")


def columns_of(kinds):
    """"id x y z" -> [COUNT rows of words], (COUNT, 3) of the coordinates."""
    kinds = kinds.split()
    # numpy's floats print the shortest text that gives the same value.
    rows = [[str(KINDS[kind][i]) for kind in kinds] for i in range(COUNT)]
    axes = [next(kind for kind in axis if kind in kinds) for axis in (AS_X, AS_Y, AS_Z)]
    return rows, numpy.column_stack([KINDS[kind] for kind in axes]).astype("f8")


class Tables(InFolder):
    """Reads texts, with the notes on degrees and on up and down."""

    def read(self, content, **options):
        cloud = read_text(self.file("a.txt", content), ReadOptions(**options))
        cloud.notes += notes_on_degrees(cloud)
        cloud.notes += notes_on_up(cloud, options.get("depth", False))
        return cloud

    def refusal(self, content, **options):
        with self.assertRaises(FileError) as caught:
            self.read(content, **options)
        self.assert_one_line(str(caught.exception))
        return str(caught.exception)

    def assert_one_line(self, text):
        """A question about columns has the first rows below it, under their numbers."""
        rows = text.split("\n")[1:]
        self.assertTrue(not rows or rows[0].split() == [str(i + 1) for i in range(len(rows[0].split()))])
