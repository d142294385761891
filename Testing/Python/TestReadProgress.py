# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every reader reports its progress, and stops on request."""

import gzip
import importlib
import struct
import sys
import unittest
from unittest import mock

import numpy
from in_folder import InFolder
from vtkelevationsurface import algorithms, clouds, progress, reading
from vtkelevationsurface.reading import blunders, horizons, las, nulls, rasters, text_blocks
from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

HAS_GDAL = importlib.util.find_spec("osgeo") is not None
COUNT = 5000
SIDE = 60  # of grids
# So that small files have several slices.
SLICES = (
    (progress, "BYTES", 1000), (text_blocks, "BLOCK", 10000), (las, "AT_ONCE", 500), (blunders, "CHUNK", 500),
    (rasters, "AT_ONCE", 10 * SIDE), (horizons, "AT_ONCE", 2000),
)


class Stop(Exception):
    """Nobody wants to wait."""


def points():
    x, y = numpy.random.default_rng(3).uniform(0, 1000, (2, COUNT)).round(2)
    return numpy.column_stack((x, y, (x / 7 + y / 9).round(2)))


def rows(form, values):
    return "".join(form.format(*row) + "\n" for row in values.tolist())


def las_file():
    head = bytearray(227)
    head[:4], head[24:26] = b"LASF", b"\1\2"
    struct.pack_into("<HIIBH", head, 94, 227, 227, 0, 0, 20)
    struct.pack_into("<I", head, 107, COUNT)
    struct.pack_into("<6d", head, 131, 0.01, 0.01, 0.01, 0.0, 0.0, 0.0)
    body = numpy.zeros(COUNT, numpy.dtype([("xyz", "<3i4"), ("rest", "V8")]))
    body["xyz"] = points() * 100
    return bytes(head) + body.tobytes()


def vtk_file(test, name, writer, lines=None):
    data = clouds.make_lines(lines) if lines else clouds.make_points(points())
    writer.SetFileName(test.path(name))
    writer.SetInputData(data)
    writer.Write()


def circles():
    """20 closed lines of 101 points."""
    angle = numpy.linspace(0.0, 2.0 * numpy.pi, 101)
    angle[-1] = 0.0
    ring = numpy.column_stack((numpy.cos(angle), numpy.sin(angle), 0.0 * angle))
    return [(ring + (3.0 * i, 0.0, 1.0)).round(6) for i in range(20)]


class Progress(InFolder):
    def setUp(self):
        super().setUp()
        for module, name, value in SLICES:
            patch = mock.patch.object(module, name, value)
            patch.start()
            self.addCleanup(patch.stop)

    def point_files(self):
        """{name: how many steps its reader reports at least}."""
        xyz = rows("{} {} {}", points())
        self.file("a.xyz", xyz)
        self.file("a.xyz.gz", gzip.compress(xyz.encode()))
        self.file("quoted.csv", "x,y,z\n" + rows('{},{},"{}"', points()))
        self.file("a.las", las_file())
        head = f"ply\nformat ascii 1.0\nelement vertex {COUNT}\n"
        axes = "".join(f"property double {axis}\n" for axis in "xyz")
        self.file("a.ply", f"{head}{axes}end_header\n{xyz}")
        self.file("a.vs", "GOCAD VSet 1\n" + rows("VRTX 1 {} {} {}", points()) + "END\n")
        self.file("a.obj", rows("v {} {} {}", points()))
        end = SIDE - 1
        grid = f"-996 {SIDE} 1 1\n0 {end} 0 {end}\n{SIDE} 0 0 0\n0 0 0 0 0 0 0\n"
        grid_rows = rows(" ".join(["{}"] * SIDE), numpy.arange(SIDE**2).reshape(SIDE, SIDE))
        self.file("a.irap", grid + grid_rows)
        vtk_file(self, "a.vtp", vtkXMLPolyDataWriter())
        vtk_file(self, "a.vtk", vtkPolyDataWriter())
        found = {"a.xyz": 5, "a.xyz.gz": 5, "quoted.csv": 5, "a.las": 9, "a.ply": 5, "a.vs": 50}
        found |= {"a.obj": 50, "a.irap": 4, "a.vtp": 2, "a.vtk": 2}
        if HAS_GDAL:
            head = f"ncols {SIDE}\nnrows {SIDE}\nxllcorner 0\nyllcorner 0\ncellsize 1\n"
            self.file("a.asc", head + grid_rows)
            geometry = '{{"type":"Feature","geometry":{{"type":"Point","coordinates":[{},{},{}]}}}}'
            features = ",".join(rows(geometry, points()).splitlines())
            self.file("a.geojson", f'{{"type":"FeatureCollection","features":[{features}]}}')
            found |= {"a.asc": 10, "a.geojson": 5}
        return found

    def line_files(self):
        parts = [rows("{} {} {}", part) for part in circles()]
        self.file("l.txt", "\n".join(parts))
        self.file("l.gmt", "".join(">\n" + part for part in parts))
        vtk_file(self, "l.vtp", vtkXMLPolyDataWriter(), circles())
        lines = ["GOCAD PLine 1\n"]
        for i, part in enumerate(circles()):
            vertices = enumerate(part.tolist(), 101 * i)
            lines += [f"VRTX {vertex} {x} {y} {z}\n" for vertex, (x, y, z) in vertices]
            lines += [f"SEG {101 * i + k} {101 * i + k + 1}\n" for k in range(100)]
        self.file("l.pl", "".join(lines) + "END\n")
        return {"l.txt": 3, "l.gmt": 10, "l.vtp": 1, "l.pl": 10}

    def check(self, name, read, least):
        """Reports are in order and enough; what each of some raises ends the reading."""
        with self.subTest(file=name):
            fractions = []
            read(fractions.append)
            fractions = list(dict.fromkeys(fractions))  # while another process works, the same comes again
            self.assertGreaterEqual(len(fractions), least, fractions)
            self.assertEqual(fractions, sorted(fractions))
            self.assertTrue(0.0 <= fractions[0] and fractions[-1] <= 1.0, fractions)
            for last in {fractions[0], fractions[len(fractions) // 2], fractions[-1]}:
                calls = []

                def stop(fraction, last=last, calls=calls):
                    calls.append(fraction)
                    if fraction >= last:
                        raise Stop

                with self.assertRaises(Stop):
                    read(stop)
                self.assertLess(sum(fraction >= last for fraction in calls), 3)

    def test_of_points_of_each_kind_of_file(self):
        of_nulls = []
        clouds_options = clouds.ReadOptions(progress=of_nulls.append)
        nulls.take_out(clouds.Cloud(clouds.make_points(points())), clouds_options)
        self.assertGreater(len(of_nulls), 20)
        with mock.patch.object(reading, "take_out", lambda cloud, _: cloud):
            for name, least in self.point_files().items():
                self.check(
                    name,
                    lambda progress, name=name: reading.read(self.path(name), progress=progress),
                    least,
                )

    def test_of_boundaries_and_faults(self):
        for name, least in self.line_files().items():
            for read in (reading.read_boundary, reading.read_faults):
                self.check(
                    name,
                    lambda progress, name=name, read=read: read(self.path(name), progress=progress),
                    least,
                )

    def test_the_reader_in_a_pipeline_is_aborted(self):
        self.point_files()
        self.line_files()
        for name, contents in (("a.las", 0), ("a.vtp", 0), ("l.gmt", 1), ("l.pl", 2)):
            reader = algorithms.ElevationPoints()
            reader.SetFileName(self.path(name))
            reader.SetContents(contents)
            fractions = []

            def stop(caller, _event, fractions=fractions):
                fractions.append(caller.GetProgress())
                caller.SetAbortExecute(1)

            tag = reader.AddObserver("ProgressEvent", stop)
            reader.Update()
            self.assertLess(len(fractions), 4, name)
            self.assertLess(fractions[1], 0.9, name)  # the first is of the pipeline itself
            self.assertEqual(reader.GetOutputDataObject(0).GetNumberOfPoints(), 0)
            reader.RemoveObserver(tag)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
