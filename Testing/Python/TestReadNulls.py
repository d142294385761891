# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Null values are taken out where they stand apart, doubtful ones and blunders are named."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy
from vtkelevationsurface import reconstruct
from vtkelevationsurface.clouds import Cloud, ReadOptions, make_points, turn_over
from vtkelevationsurface.reading.nulls import take_out
from vtkelevationsurface.reading import read
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

FLOAT_MAX = float(numpy.finfo("f4").max)


def terrain(count=2000, low=0.0, high=800.0, seed=1, digits=2):
    """Rows x, y, z of a smooth relief on a map of 10 km."""
    generator = numpy.random.default_rng(seed)
    x = generator.uniform(500000, 510000, count)
    y = generator.uniform(4000000, 4010000, count)
    wave = 0.5 + 0.25 * (numpy.sin(x / 2500) + numpy.cos(y / 1800))
    z = low + (high - low) * wave
    return numpy.column_stack((x, y, z)).round(digits)


def with_z(rows, value, count):
    """Every so many-th row has another z."""
    rows = rows.copy()
    rows[numpy.arange(count) * (len(rows) // count), 2] = value
    return rows


def taken(rows, lines=None, **options):
    cloud = Cloud(make_points(rows), lines=lines)
    return take_out(cloud, ReadOptions(**options))


def coordinates(cloud):
    return vtk_to_numpy(cloud.points.GetPoints().GetData())


TRENCH = terrain(low=-10900.0, high=-7000.0, digits=0)

# what, rows, value, how many of it are put in
OUT = (
    ("-9999 in hills", terrain(), -9999.0, 200),
    ("-9999, once", terrain(), -9999.0, 1),
    ("-9999, most of the rows", terrain(), -9999.0, 1990),
    ("-9999 in high mountains", terrain(high=8800.0), -9999.0, 50),
    ("-9999 below a sea", terrain(low=-6000.0, high=-100.0), -9999.0, 50),
    ("-999.25 below two-way times", terrain(low=1000.0, high=4000.0), -999.25, 30),
    ("-999.25 below times counted down", terrain(low=-900.0, high=-100.0), -999.25, 30),
    ("-999", terrain(), -999.0, 7),
    ("-99999", terrain(), -99999.0, 20),
    ("1e30", terrain(), 1e30, 200),
    ("-1e30", terrain(), -1e30, 3),
    ("float max", terrain(), FLOAT_MAX, 40),
    ("float max as text", terrain(), 3.4028235e38, 40),
    ("minus float max", terrain(), -FLOAT_MAX, 40),
    ("Surfer's 1.70141e38", terrain(), 1.70141e38, 40),
    ("-32768", terrain(digits=0), -32768.0, 40),
    ("-32767", terrain(digits=0), -32767.0, 40),
    ("99999", terrain(), 99999.0, 40),
    ("9999", terrain(), 9999.0, 40),
    ("9999900", terrain(), 9999900.0, 5),
    ("-9999 with a flat sheet", terrain(low=12.0, high=12.0), -9999.0, 5),
)
STAY = (
    ("a trench that holds -9999", TRENCH, -9999.0, 5),
    ("a trench, -9999 once", TRENCH, -9999.0, 1),
    ("feet that hold 9999", terrain(low=7000.0, high=12000.0), 9999.0, 3),
    ("the highest of all is 9999", terrain(low=2000.0, high=9900.0), 9999.0, 1),
    ("next to 9999", terrain(low=9998.0, high=9998.5), 9999.0, 1),
    ("zero at the shore", terrain(low=0.0, high=300.0), 0.0, 100),
    ("all the same", terrain(low=-9999.0, high=-9999.0), -9999.0, 10),
)


class Nulls(unittest.TestCase):
    def test_usual_null_values_that_stand_apart_are_left_out_and_counted(self):
        for what, rows, value, count in OUT:
            with self.subTest(what):
                rows = with_z(rows, value, count)
                cloud = taken(rows)
                numpy.testing.assert_array_equal(coordinates(cloud), rows[rows[:, 2] != value])
                self.assertEqual(list(cloud.left_out.values()), [count])
                self.assertTrue(list(cloud.left_out)[0].startswith("null values (z = "))
                self.assertTrue(any("--keep-nulls" in note for note in cloud.notes))

    def test_they_can_be_kept(self):
        for what, rows, value, count in OUT:
            with self.subTest(what):
                cloud = taken(with_z(rows, value, count), keep_nulls=True)
                self.assertEqual(cloud.points.GetNumberOfPoints(), len(rows))
                self.assertEqual(cloud.left_out, {})
                self.assertTrue(cloud.notes[0].startswith(f"kept: {count:,} null"), cloud.notes)

    def test_real_elevations_of_such_values_stay(self):
        for what, rows, value, count in STAY:
            with self.subTest(what):
                cloud = taken(with_z(rows, value, count))
                self.assertEqual(cloud.points.GetNumberOfPoints(), len(rows))
                self.assertEqual(cloud.left_out, {})
                self.assertFalse(any("null" in note for note in cloud.notes), cloud.notes)

    def test_rows_of_zeros_go_where_the_map_is_elsewhere(self):
        rows = terrain()
        rows[10:15] = 0.0
        cloud = taken(rows)
        self.assertEqual(cloud.left_out, {"rows 0 0 0": 5})
        self.assertEqual(cloud.points.GetNumberOfPoints(), len(rows) - 5)
        rows[20] = 999.0  # IRAP's mark at the end of a line
        self.assertEqual(taken(rows).left_out, {"rows 0 0 0": 5, "rows 999 999 999": 1})
        local = terrain() - (500000, 4000000, 0)
        local[0] = 0.0
        self.assertEqual(taken(local).left_out, {})
        grid = [(x, y, 0.0) for x in range(12) for y in range(12)]
        self.assertEqual(taken(numpy.array(grid, dtype="f8")).left_out, {})

    def test_null_coordinates_go_too(self):
        rows = terrain()
        rows[5:8, :2] = -9999.0
        rows[9] = 1e30
        cloud = taken(rows)
        self.assertEqual(sum(cloud.left_out.values()), 4)
        self.assertEqual(cloud.points.GetNumberOfPoints(), len(rows) - 4)
        # Coordinates that happen to be such numbers stay.
        steps = numpy.linspace(0, 9999, 4)
        grid = numpy.array([(x, y, x / 1000 + y) for x in steps for y in range(9)])
        self.assertEqual(taken(grid).left_out, {})

    def test_lines_and_point_arrays_follow_the_points(self):
        rows = with_z(terrain(100), -9999.0, 10)
        cloud = Cloud(make_points(rows), lines=range(3, 103))
        for name, kind in (("Amplitude", "f8"), ("Code", "i4"), ("RGB", "u1")):
            values = numpy.arange(100).astype(kind)
            if name == "RGB":
                values = numpy.column_stack((values, values, values))
            array = numpy_to_vtk(values, deep=True)
            array.SetName(name)
            cloud.points.GetPointData().AddArray(array)
        cloud.points.GetPointData().SetActiveScalars("Code")
        take_out(cloud, ReadOptions())
        kept = numpy.flatnonzero(rows[:, 2] != -9999.0)
        self.assertEqual(list(cloud.lines), (kept + 3).tolist())
        arrays = cloud.points.GetPointData()
        self.assertEqual(vtk_to_numpy(arrays.GetArray("Amplitude")).tolist(), kept.tolist())
        self.assertEqual(arrays.GetScalars().GetName(), "Code")
        self.assertEqual(vtk_to_numpy(arrays.GetArray("RGB")).shape, (90, 3))
        self.assertEqual(arrays.GetArray("RGB").GetDataTypeAsString(), "unsigned char")

    def test_null_values_of_attributes_become_nan(self):
        rows = numpy.column_stack((terrain(100), numpy.arange(200.0).reshape(100, 2)))
        rows[::7, 3], rows[5:9, 4] = 1e30, -999.25
        names = ("Amplitude", "Velocity", "Line")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "attributes.csv")
            rows = numpy.column_stack((rows, numpy.arange(100) % 4 - 9999.0))  # real: not apart
            numpy.savetxt(path, rows, "%.9g", ",", header=",".join(("x,y,z", *names)), comments="")
            for keeps in (False, True):
                cloud = read(path, keep_nulls=keeps)
                data = cloud.points.GetPointData()
                found = numpy.column_stack([vtk_to_numpy(data.GetArray(name)) for name in names])
                expected = rows[:, 3:].copy()
                if not keeps:
                    expected[::7, 0] = expected[5:9, 1] = numpy.nan
                numpy.testing.assert_array_equal(found, expected)
                notes = [note for note in cloud.notes if "NaN" in note]
                self.assertEqual([note.split(" (")[0] for note in notes], [] if keeps else [
                    "Amplitude: 15 null values", "Velocity: 4 null values"])

    def test_what_looks_like_an_unusual_null_value_is_named_and_kept(self):
        cloud = taken(with_z(terrain(low=1500.0, high=2500.0), 0.0, 40))
        self.assertEqual(cloud.left_out, {})
        self.assertEqual(
            cloud.notes,
            ["40 points have z = 0, far from all others; if that means no data: --no-data 0"],
        )

    def test_depths_are_turned_over(self):
        cloud = Cloud(make_points(terrain(50)))
        turn_over(cloud)
        numpy.testing.assert_array_equal(coordinates(cloud), terrain(50) * (1, 1, -1))


class Program(unittest.TestCase):
    def report(self, folder, *options):
        subprocess.run(
            [sys.executable, "-m", "vtkelevationsurface", "a.csv", "--no-picture", "--report",
             "r.json", *options],
            cwd=folder, check=True, stdout=subprocess.DEVNULL,
        )
        with open(os.path.join(folder, "r.json"), encoding="utf-8") as stream:
            return json.load(stream)

    def test_the_options_reach_the_reader_and_the_report_counts(self):
        rows = with_z(terrain(600), -9999.0, 60)
        with tempfile.TemporaryDirectory() as folder:
            numpy.savetxt(
                os.path.join(folder, "a.csv"), rows, "%.2f", ",", header="X,Y,Depth", comments=""
            )
            report = self.report(folder)
            self.assertEqual(report["points"], 540)
            self.assertEqual(report["left_out"], {"null values (z = -9999)": 60})
            self.assertTrue(any("--depth" in note for note in report["notes"]))
            report = self.report(folder, "--keep-nulls", "--depth")
            self.assertEqual((report["points"], report["left_out"]), (600, {}))
            self.assertIn("z is turned over, as --depth says", report["notes"])
            cloud = read(os.path.join(folder, "a.csv"), depth=True)
            self.assertEqual(coordinates(cloud)[0, 2], -rows[rows[:, 2] != -9999.0][0, 2])


class Blunders(unittest.TestCase):
    def test_single_elevations_far_from_all_around_are_named_and_kept(self):
        rows = terrain(5000)
        rows[1234, 2] += 5000.0
        rows[4000, 2] -= 3000.0
        cloud = taken(rows, lines=range(2, 5002))
        self.assertEqual(cloud.points.GetNumberOfPoints(), 5000)
        self.assertEqual(len(cloud.notes), 1)
        for words in ("2 single elevations are far", f"line 1236 has {rows[1234, 2]:.7g}",
                      f"line 4002 has {rows[4000, 2]:.7g}"):
            self.assertIn(words, cloud.notes[0])
        self.assertIn("point 1234 has", taken(rows).notes[0])

    def test_no_more_than_five_are_named(self):
        rows = terrain(5000)
        rows[::600, 2] += 4000.0
        note = taken(rows).notes[0]
        self.assertTrue(note.startswith("9 single"), note)
        self.assertEqual(note.count("point"), 5)
        self.assertTrue(note.endswith(", ..."))

    def test_points_that_are_not_places_are_named_and_measured(self):
        for axis in range(3):
            rows = terrain(500)
            rows[77, axis] = 1e300
            rows[78, axis] = numpy.nan
            cloud = taken(rows, lines=range(2, 502))
            words = "1 point cannot be a place on earth; take it out of the file: line 79 has "
            self.assertIn(f"{words}{'xyz'[axis]} = 1e+300", cloud.notes)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                distance = reconstruct(cloud).report["distance"]
            for value in distance.values():
                self.assertTrue(numpy.isfinite(value), distance)
            self.assertEqual(distance["maximum"] > 9e299, axis < 2)

    def test_cliffs_slopes_noise_and_rims_are_not_blunders(self):
        generator = numpy.random.default_rng(4)
        smooth = terrain(5000)
        cliff = smooth.copy()
        cliff[cliff[:, 0] > 505000, 2] += 3000.0
        noisy = smooth.copy()
        noisy[:, 2] = generator.normal(0, 30, 5000)
        steep = smooth.copy()
        steep[:, 2] = 4 * steep[:, 0] + 3 * steep[:, 1]
        few = terrain(25)
        rest = numpy.full((50, 3), numpy.nan)
        lines = numpy.array(
            [(500 * i, 5.0 * k, numpy.sin(i + k / 90)) for i in range(9) for k in range(400)]
        )
        for name, rows in (
            ("smooth", smooth), ("cliff", cliff), ("noise", noisy), ("steep", steep),
            ("few", few), ("nan", numpy.concatenate((smooth, rest))), ("lines", lines),
        ):
            with self.subTest(name):
                self.assertEqual(taken(rows).notes, [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
