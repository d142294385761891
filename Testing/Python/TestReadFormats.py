# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""IESX, LandXML, PCD, ADCIRC's meshes and binary IRAP grids: points where the files say, damage reported."""

import struct
import sys
import unittest
import warnings

import numpy
from in_folder import InFolder, coordinates
from vtkelevationsurface import reading
from vtkelevationsurface.reading.formats import is_table
from vtkelevationsurface.reading.pcd import unpacked
from vtkmodules.util.numpy_support import vtk_to_numpy

Z = numpy.array([[1.0, 2.0, 3.0], [4.0, 1e30, 6.0]])  # the south first


def record(kind, *values):
    body = struct.pack(">" + kind, *values)
    return struct.pack(">i", len(body)) + body + struct.pack(">i", len(body))


def irap(turned=0.0, z=Z):
    rows, columns = z.shape
    head = record("2i6f", -996, rows, 500.0, 500.0 + 10 * (columns - 1), 900.0, 900.0 + 20 * (rows - 1), 10.0, 20.0)
    head += record("i3f", columns, turned, 500.0, 900.0) + record("7i", *[0] * 7)
    return head + b"".join(record(f"{columns}f", *row) for row in z)


def iesx_row(x, y, z, segment=1, code=" 14", trace=7):
    return f"{x:16.8E}{y:16.8E}{segment:3d}{code}{z:9.2f}{trace:10.2f}{trace:10.2f}{trace:5d} 1.0E+00XXI{trace:7d}\n"


IESX = (
    "PROFILE Top_Sand         TYPE 1  4 exported                      3d_ci7m.ifdf     m  ms\n"
    "SNAPPING PARAMETERS 5     0 1\n"
    + iesx_row(605835.5, 6073657.0, 1850.55) + iesx_row(605860.5, 6073657.0, -1851.25)
    + iesx_row(605835.5, 6073682.0, 3.4028235e38) + "EOD\n"
    + "PROFILE Base             TYPE 1  4\n" + iesx_row(1.5, 2.5, -99999.25, 2) + "EOD\n"
)
LANDXML = """<?xml version="1.0"?>
<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2" version="1.2">
 <Units><Metric linearUnit="meter"/></Units><CoordinateSystem epsgCode="25832"/>
 <Surfaces><Surface name="ground"><SourceData>
  <Breaklines><Breakline><PntList3D>5 1 7 6 2 8</PntList3D></Breakline></Breaklines>
  <Boundaries><Boundary><PntList2D>0 0 0 9 9 9 0 0</PntList2D></Boundary></Boundaries></SourceData>
  <Definition surfType="TIN"><Pnts>
   <P id="1">20 10 5.5</P><P id="7">20 30 6</P><P id="3">40 10 7</P></Pnts>
   <Faces><F>1 7 3</F></Faces></Definition></Surface>%s</Surfaces>
</LandXML>
"""
DESIGN = '<Surface name="design"><Definition><Pnts><P id="1">1 2 3</P></Pnts></Definition></Surface>'
NODES = "1 0 0 -1.5 1\n2 10 0 -2.5 1\n3 10 10 -4.5 1\n4 0 10 -3.5 0\n"
MESH = "a bay\n2 4\n1 0.0 0.0 5.0\n2 10.0 0.0 6.0\n3 10.0 10.0 -1.5\n4 0.0 10.0 2.0\n1 3 1 2 3\n2 3 1 3 4\n0\n0\n0\n0\n"
FLOATS = [(1.5, 2.5, 3.5, 255 << 16 | 7), (4.0, 5.0, 6.0, 9 << 8), (numpy.nan, numpy.nan, numpy.nan, 0)]


def pcd(way, rows=FLOATS):
    head = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 8 8 8 4\nTYPE F F F U\n"
    head += f"COUNT 1 1 1 1\nWIDTH {len(rows)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(rows)}\nDATA {way}\n"
    if way == "ascii":
        return (head + "".join(" ".join(map(str, row)) + "\n" for row in rows)).encode()
    if way == "binary":
        return head.encode() + b"".join(struct.pack("<3dI", *row) for row in rows)
    body = b"".join(struct.pack(f"<{len(rows)}{kind}", *column) for kind, column in zip("dddI", zip(*rows)))
    packed = b"".join(bytes([len(body[i : i + 32]) - 1]) + body[i : i + 32] for i in range(0, len(body), 32))
    return head.encode() + struct.pack("<II", len(packed), len(body)) + packed


class Formats(InFolder):
    def array(self, cloud, name):
        return vtk_to_numpy(cloud.points.GetPointData().GetArray(name)).tolist()

    def test_a_binary_irap_grid_has_its_nodes_where_it_says(self):
        cloud = self.read(irap(), "a.gri")
        self.assert_rows(cloud, [(500, 900, 1), (510, 900, 2), (520, 900, 3), (500, 920, 4), (520, 920, 6)])
        self.assertEqual(cloud.left_out, {"pixels without data": 1})
        self.assertIn("binary IRAP grid, 3 x 2 nodes", cloud.notes)
        turned = coordinates(self.read(irap(90.0), "a.gri"))
        numpy.testing.assert_allclose(turned[1], (500, 910, 2), atol=1e-9)

    def test_horizons_of_iesx_are_read_also_where_numbers_touch(self):
        cloud = self.read(IESX)
        self.assert_rows(cloud, [(605835.5, 6073657.0, 1850.55), (605860.5, 6073657.0, -1851.25), (1.5, 2.5, -99999.25)])
        self.assertEqual(cloud.left_out, {"rows without data": 1})
        self.assertEqual(self.array(cloud, "Segment"), [1, 1, 2])
        self.assert_rows(self.read(IESX[:-4]), coordinates(cloud))  # as Petrel writes it
        self.assert_rows(self.read(IESX, layer="Base"), [(1.5, 2.5, -99999.25)])
        self.assertTrue(any("times by their name" in note for note in cloud.notes))

    def test_a_fault_boundary_of_iesx_is_lines(self):
        text = "PROFILE fb TYPE 3\n1 2 2 0.5\n9 2 2 0.5\n9 8 2 0.5\n1 2 2 0.5\n50 60 3 1\n51 62 3 2\nEOD\n"
        lines = reading.read_faults(self.file("a.dat", text))
        self.assertEqual([lines.GetCell(i).GetNumberOfPoints() for i in range(lines.GetNumberOfCells())], [4, 2])
        self.assertEqual(lines.GetPoint(3), (50, 60, 1))

    def test_surfaces_of_landxml_have_the_northing_first(self):
        cloud = self.read(LANDXML % "", "a.xml")
        self.assert_rows(cloud, [(10, 20, 5.5), (30, 20, 6), (10, 40, 7)])
        self.assertEqual(cloud.crs, "EPSG:25832")
        self.assert_rows(self.read(LANDXML % DESIGN, "a.xml", layer="design"), [(2, 1, 3)])
        self.assert_refused("surfaces ground, design: choose one", LANDXML % DESIGN, "a.xml")
        path = self.file("a.xml", LANDXML % "")
        self.assertEqual(reading.read_faults(path).GetPoint(1), (2, 6, 8))
        self.assertEqual(reading.read_boundary(path).GetPoint(1), (9, 0, 0))

    def test_points_of_pcd_are_the_same_in_each_of_its_ways(self):
        for way in ("ascii", "binary", "binary_compressed"):
            with self.subTest(way=way):
                cloud = self.read(pcd(way), "a.pcd")
                self.assert_rows(cloud, [row[:3] for row in FLOATS[:2]])
                self.assertEqual(cloud.left_out, {"points without data": 1})
                self.assertEqual(self.array(cloud, "RGB"), [[255, 0, 7], [0, 9, 0]])

    def test_bytes_that_are_packed_by_lzf_come_back(self):
        self.assertEqual(unpacked(b"\x02abc\x20\x02\xe0\x03\x02\x00z", 19), b"abc" * 6 + b"z")

    def test_depths_of_an_adcirc_mesh_are_turned_over_once(self):
        up = [(0, 0, -5), (10, 0, -6), (10, 10, 1.5), (0, 10, -2)]
        self.assert_rows(self.read(MESH, "fort.14"), up)
        self.assert_rows(self.read(MESH, "bay.grd", depth=True), up)
        self.assertIn("ADCIRC mesh 'a bay'", self.read(MESH, "fort.14").notes)

    def test_meshes_of_mike_are_their_nodes(self):
        rows = [(0, 0, -1.5), (10, 0, -2.5), (10, 10, -4.5), (0, 10, -3.5)]
        for counts, elements in (("100079 1000 4", "2 3 21\n1 1 2 3\n2 1 3 4\n"), ("4", "1 4 25\n1 1 2 3 4\n")):
            cloud = self.read(f"{counts} UTM-33\n{NODES}{elements}", "a.mesh")
            self.assert_rows(cloud, rows)
            self.assertIn("DHI mesh, UTM-33", cloud.notes)
            self.assertEqual(self.read(f"{counts} UTM-33\n{NODES}{elements}", "a.mesh", depth=True).points.GetPoint(0)[2], 1.5)

    def test_lines_of_delft3d_have_a_name_and_counts_each(self):
        text = "* dikes\nL1\n 4 3\n 0 0 1.5\n 9 0 2.5\n 9 9 4.5\n 0 0 1.5\nL 2\n 2 3\n 1 8 3.5\n 2 2 2.25\n"
        self.assertEqual(self.read(text, "a.pliz").points.GetNumberOfPoints(), 6)
        lines = reading.read_faults(self.file("a.pliz", text))
        self.assertEqual([lines.GetCell(i).GetNumberOfPoints() for i in range(lines.GetNumberOfCells())], [4, 2])
        ring = reading.read_boundary(self.file("a.pol", "ring\n3 2\n0 0\n9 0\n9 9\n"))
        self.assertEqual(ring.GetCell(0).GetNumberOfPoints(), 4)
        self.assert_refused("is damaged: 'two 3' does not count", text.replace(" 2 3", " two 3"), "a.pliz")
        for head in ("x y", "a ring"):  # a table whose first row may be such counts
            ring = reading.read_boundary(self.file("a.txt", f"{head}\n2 2\n8 2\n8 8\n2 8\n2 2\n"))
            self.assertEqual(ring.GetCell(0).GetNumberOfPoints(), 5)
        ring = reading.read_boundary(self.file("a.txt", "x y\n4 2\n8 2\n8 8\n4 8\n4 2\n"))
        self.assertEqual(ring.GetCell(0).GetNumberOfPoints(), 5)

    def test_an_obj_without_vertices_is_refused_and_numpy_does_not_warn(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assert_refused("holds no points", "# nothing\n", "a.obj")

    def test_the_first_line_of_a_table_has_at_most_1000_bytes(self):
        for size, is_so in ((999, True), (1000, True), (1001, False)):
            line = b"1 2 3".ljust(size - 1) + b"4"
            self.assertEqual(is_table(line + b"\n1 2 3 4\n", "a"), is_so)

    def test_damaged_files_are_refused_in_one_line(self):
        cases = (
            ("a.gri", irap()[:50], "cut off within the header"),
            ("a.gri", irap()[:-9], "cut off or damaged behind byte"),
            ("a.gri", irap(z=Z)[:100] + irap()[120:], "6 values are announced"),
            ("a.dat", IESX[:-20], "cut off within its last line"),
            ("a.dat", IESX.replace("E+06", "E+0x"), "line 3: '6.0583550"),
            ("a.dat", IESX.replace("TYPE 1", "TYPE 9"), "of type 9"),
            ("a.dat", "PROFILE a TYPE 1 4\nEOD\n", "holds no points"),
            ("a.mesh", f"4 UTM-33\n{NODES}two 3 21\n1 1 2 3\n", "line 6: does not give the number of elements"),
            ("a.mesh", f"4 UTM-33\n{NODES}2 3 21\n1 1 2 3\n", "2 elements are announced, 1 found"),
            ("a.mesh", f"4 UTM-33\n{NODES}1 3 21\n1 1 2 9\n", "an element has the node 9"),
            ("a.xml", (LANDXML % "")[:-20], "cut off or damaged"),
            ("a.xml", LANDXML.replace("20 30 6", "20 30 six") % "", "is damaged: P holds '20 30 six'"),
            ("a.xml", LANDXML.replace("1 7 3", "1 7 8") % "", "corner '8'"),
            ("a.xml", "<LandXML></LandXML>", "holds no surfaces"),
            ("a.pcd", pcd("binary")[:-1], "3 points are announced, 2 found"),
            ("a.pcd", pcd("ascii")[:-30], "is "),
            ("a.pcd", pcd("binary_compressed")[:-5], "cannot be unpacked"),
            ("a.pcd", pcd("zipped"), "DATA zipped"),
            ("a.pcd", pcd("ascii").replace(b"SIZE 8 8 8 4\n", b""), "within its header"),
            ("a.pcd", pcd("ascii").replace(b"FIELDS x y z", b"FIELDS x y h"), "not x, y and z"),
            ("a.14", MESH[:60], "is not a row of 4 numbers, or is cut off"), ("a.14", MESH[:71], "2 elements are announced"),
            ("a.14", MESH.replace("1 3 1 2 3", "1 3 1 2 9"), "has the node 9"),
            ("a.14", MESH.replace("3 10.0 10.0", "3 ten 10.0"), "line"),
        )
        for name, content, words in cases:
            with self.subTest(words=words, name=name):
                self.assert_refused(words, content, name)

    def test_no_byte_of_a_file_that_is_wrong_makes_anything_but_one_line(self):
        random = numpy.random.default_rng(6)
        for name, content in (
            ("a.gri", irap()), ("a.dat", IESX.encode()), ("a.xml", (LANDXML % "").encode()),
            ("a.14", MESH.encode()), *(("a.pcd", pcd(way)) for way in ("ascii", "binary", "binary_compressed")),
        ):
            for _ in range(60):
                wrong = bytearray(content)
                for at in random.integers(0, len(wrong), 2):
                    wrong[at] = random.integers(0, 256)
                wrong = bytes(wrong[: random.integers(1, len(wrong) + 1)])
                try:
                    self.read(wrong, name)
                except reading.FileError as error:
                    first, *rows = str(error).split("\n")
                    self.assertTrue(not rows or "--columns" in first, str(error))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
