# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Horizons: IRAP, CPS-3, EarthVision, Petrel, GOCAD, lines in segments and arrays of numpy."""

import io
import math
import sys
import unittest

import numpy
from in_folder import InFolder, coordinates
from vtkelevationsurface import reading
from vtkmodules.util.numpy_support import vtk_to_numpy

# Nodes at x = 1000.5, 1010.5, 1020.5 and y = 200.25, 205.25; z encodes x and y; one is missing.
NODES = [(1000.5 + 10 * i, 200.25 + 5 * j, 100.0 * j + i) for j in range(2) for i in range(3)]
KNOWN = [node for node in NODES if node[2] != 101.0]
IRAP = "-996 2 10.0 5.0\n1000.5 1020.5 200.25 205.25\n3 0.0 1000.5 200.25\n0 0 0 0 0 0 0\n"
IRAP += "0 1 2 100\n9999900.0000 102\n"
CPS3 = 'FSASCI 0 1 "Computed" 0 0.1E+31 0\nFSATTR 0 0\nFSLIMI 1000.5 1020.5 200.25 205.25 0 102\n'
CPS3 += "FSNROW 2 3\nFSXINC 10.0 5.0\n->Depth map\n100 0\n0.1E+31 1 102\n2\n"
# Whole numbers, in rows that go on behind the end of a column.
ZMAP = "! by hand, @home\n@depth, GRID, 4\n9, 1E+30, , 7, 1\n2, 3, 1000.5, 1020.5, 200.25, 205.25\n0, 0, 0\n@\n"
ZMAP += "      100        0   1E+030        1\n      102        2\n"
ZMAP_TOUCHING = ZMAP[: ZMAP.index("      100")].replace("9, 1E", "4, 1E") + " 100   01E30   1\n 102   2\n"
GXF = "! by hand\n#POINTS\n3\n#ROWS\n2\n#PTSEPARATION\n10\n#RWSEPARATION\n5\n#XORIGIN\n1000.5\n#YORIGIN\n200.25\n"
GXF += "#DUMMY\n1e30\n##XMAX\n7\n#GRID\n0 1 2\n100 1e30\n102\n"
ZMAP_POINTS = "!\n@FREE POINT , DATA, 80, 1\nX (EASTING), 1, 1, 1, 1, 20,, 1.0E+30,,, 4, 0\nY (NORTHING), 2, 2, 1, 21, 40,, 1.0E+30\n"
ZMAP_POINTS += "Z VALUE, 3, 3, 1, 41, 60,, 1.0E+30,,, 4, 0\n@\n" + "".join(f" {x} {y} {z}\n" for x, y, z in KNOWN) + "1 2 1E+30\n"
EARTHVISION = "# Type: scattered data\n# Field: 1 x\n# Field: 2 y\n# Field: 3 z meters\n# a\n"
EARTHVISION += "# Field: 4 column integer\n# Field: 5 row integer\n# Null_value: 0.1e31\n# End:\n"
EARTHVISION += "".join(
    f"{x} {y} {z if z != 101.0 else '0.1e31'} {i % 3 + 1} {i // 3 + 1}\n"
    for i, (x, y, z) in enumerate(NODES)
)
PETREL = "# Petrel Points with attributes\n# Unit in X and Y: m\nVERSION 1\nBEGIN HEADER\n"
PETREL += "X\nY\nZ\nFLOAT,Amplitude\nEND HEADER\n"
PETREL += "".join(f"{x} {y} {z} {2 * z}\n" for x, y, z in KNOWN)
SURFACE = """GOCAD TSurf 1
HEADER {
name:top
}
GOCAD_ORIGINAL_COORDINATE_SYSTEM
NAME Default
ZPOSITIVE Depth
END_ORIGINAL_COORDINATE_SYSTEM
PROPERTIES Amplitude Twt
ESIZES 1 1
NO_DATA_VALUES -99999 -99999
TFACE
PVRTX 1 612014.6747884353 6073983.681666553 633.5012316703796 0.5 7
PVRTX 2 612015.5 6073983.5 634 -99999 8
VRTX 3 612014.5 6073984.5 635
ATOM 4 1
TRGL 1 2 3
END
"""
CORNERS = [
    (612014.6747884353, 6073983.681666553, 633.5012316703796),
    (612015.5, 6073983.5, 634),
    (612014.5, 6073984.5, 635),
    (612014.6747884353, 6073983.681666553, 633.5012316703796),
]
LINES = """GOCAD PLine 1
HEADER {
name:fault
}
ILINE
VRTX 1 0 0 1
VRTX 2 5 0 2
VRTX 3 5 5 3
SEG 1 2
SEG 2 3
ILINE
VRTX 4 8 8 4
VRTX 5 9 9 5
SEG 4 5
END
GOCAD PLine 1
ILINE
VRTX 1 1 1 1
VRTX 2 2 2 2
SEG 1 2
END
"""
GMT = "# made by hand\n> first -Z12.5\n0 0\n5 0\n5 5\n> second\n8 8 4\n9 9 5\n9 8 6\n"
IRAP_LINES = "0 0 1\n5 0 2\n5 5 3\n999.000000 999.000000 999.000000\n"
IRAP_LINES += "8 8 4\n9 9 5\n9 8 6\n999.0 999.0 999.0\n"
CPS3_LINES = "FFASCI 0 0 COMPUTED\nFFATTR 0 1\n->1\n0 0 1\n5 0 2\n5 5 3\n->2\n8 8 4\n9 9 5\n9 8 6\n"


def npy(array):
    stream = io.BytesIO()
    numpy.save(stream, array)
    return stream.getvalue()


def lines_of(data):
    lines = []
    for i in range(data.GetNumberOfCells()):
        ids = data.GetCell(i).GetPointIds()
        lines.append([data.GetPoint(ids.GetId(j)) for j in range(ids.GetNumberOfIds())])
    return lines


class Horizons(InFolder):
    def test_formats_of_horizons_are_known_by_content_and_exact(self):
        record = numpy.array(KNOWN)
        fields = [("z", "f8"), ("x", "f8"), ("y", ">f8"), ("q", "i4")]
        named = numpy.array([(z, x, y, 7) for x, y, z in KNOWN], fields)
        for name, content, rows, left_out in (
            ("irap grid", IRAP, KNOWN, 1),
            ("cps-3 grid", CPS3, KNOWN, 1),
            ("cps-3 grid", CPS3.replace("->Depth map\n", ""), KNOWN, 1),
            ("zmap+", ZMAP, KNOWN, 1),
            ("zmap+, touching", ZMAP_TOUCHING, KNOWN, 1),
            ("zmap+ with a remark", ZMAP.replace("@\n", "@\n+ Grid data starts after this line\n"), KNOWN, 1),
            ("zmap+ points", ZMAP_POINTS, KNOWN, 1),
            ("gxf", GXF, KNOWN, 1),
            ("gxf from the north", GXF.replace("0 1 2\n100 1e30\n102", "100 1e30 102 0 1 2").replace("#DUM", "#SENSE\n-2\n#DUM"), KNOWN, 1),
            ("gxf as OpenWorks writes it", "! a\n" * 2000 + GXF.replace("\n10\n", '\n"10"\n'), KNOWN, 1),
            ("earthvision", EARTHVISION, KNOWN, 1),
            ("petrel", PETREL, KNOWN, 0),
            ("gocad", SURFACE.replace("Depth", "Elevation"), CORNERS, 0),
            ("gmt", GMT, None, 0),
            ("irap lines", IRAP_LINES, None, 0),
            ("cps-3 lines", CPS3_LINES, None, 0),
            ("npy", npy(record), KNOWN, 0),
            ("npy in columns", npy(numpy.asfortranarray(record)), KNOWN, 0),
            ("npy, floats", npy(record.astype("f4")), KNOWN, 0),
            ("npy, fields", npy(named), KNOWN, 0),
        ):
            for file in ("a", "a.txt", "a.dat"):
                with self.subTest(name=name, file=file):
                    cloud = self.read(content, file, keep_nulls=True)
                    if rows is None:
                        self.assertEqual(cloud.points.GetNumberOfPoints(), 6)
                    else:
                        got = sorted(map(tuple, coordinates(cloud).tolist()))
                        self.assertEqual(got, sorted(rows))
                    self.assertEqual(sum(cloud.left_out.values()), left_out)

    def test_whole_numbers_of_a_zmap_file_are_as_they_stand(self):
        cloud = self.read(ZMAP, "a.zmap")
        self.assertTrue(any("says 7 decimals: they are read as they stand" in note for note in cloud.notes))
        self.assertEqual(cloud.points.GetPoint(0), (1000.5, 205.25, 100.0))
        decimals = self.read(ZMAP.replace("      100", "    100.5"), "a.zmap")
        self.assertFalse(any("as they stand" in note for note in decimals.notes))
        doubtful = self.read("! Created by GDAL.\n" + ZMAP, "a.zmap")
        self.assertTrue(any("half a step away" in note for note in doubtful.notes))

    def test_a_turned_gxf_grid_is_turned_as_an_irap_grid(self):
        turned = self.read(GXF.replace("#DUMMY", "#ROTATION\n30\n#DUMMY"), "a.gxf", keep_nulls=True)
        expected = self.read(IRAP.replace("3 0.0 1000.5 200.25", "3 30.0 1000.5 200.25"), "a.irap", keep_nulls=True)
        numpy.testing.assert_array_equal(coordinates(turned), coordinates(expected))

    def test_a_turned_irap_grid_is_placed_by_its_angle(self):
        text = IRAP.replace("3 0.0 1000.5 200.25", "3 30.0 1000.5 200.25")
        points = coordinates(self.read(text, "a.irap", keep_nulls=True))
        c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
        away = [(x - 1000.5, y - 200.25, z) for x, y, z in KNOWN]
        expected = [(1000.5 + c * x - s * y, 200.25 + s * x + c * y, z) for x, y, z in away]
        numpy.testing.assert_allclose(points, expected, rtol=1e-14)

    def test_columns_besides_coordinates_become_point_arrays(self):
        for content, name, values in (
            (EARTHVISION, "column", [1, 2, 3, 1, 3]),
            (PETREL, "Amplitude", [2 * z for _, _, z in KNOWN]),
            (npy(numpy.column_stack((numpy.array(KNOWN), range(5)))), "column 4", [0, 1, 2, 3, 4]),
        ):
            with self.subTest(name=name):
                data = self.read(content, "a", keep_nulls=True).points.GetPointData()
                self.assertEqual(vtk_to_numpy(data.GetArray(name)).tolist(), values)
        cloud = self.read(SURFACE, "a.ts")
        data = cloud.points.GetPointData()
        numpy.testing.assert_array_equal(
            vtk_to_numpy(data.GetArray("Amplitude")), [0.5, math.nan, math.nan, math.nan]
        )

    def test_points_of_petrel_have_the_notes_of_tables(self):
        text = PETREL.replace("in X and Y:", "in X and Y direction:").replace("VERSION 1", "# Unit in depth: ft")
        notes = self.read(text.replace("BEGIN HEADER", "Begin Header"), "a").notes
        self.assertIn("x and y are in metres and z is in feet, by the header", " ".join(notes))
        self.assertIn("columns by the header: X, Y, Z, Amplitude", notes)

    def test_depths_of_gocad_are_turned_over_once(self):
        turned = [(x, y, -z) for x, y, z in CORNERS]
        cloud = self.read(SURFACE, "a.ts")
        self.assert_rows(cloud, turned)
        self.assertTrue(any("ZPOSITIVE Depth" in note for note in cloud.notes))
        self.assert_rows(self.read(SURFACE, "a.ts", depth=True), turned)
        self.assert_rows(self.read(SURFACE, "a.ts", no_data=634), [turned[0], *turned[2:]])
        second = "GOCAD VSet 1\nVRTX 1 5 6 7\nEND\n"
        self.assert_rows(self.read(SURFACE + second, "a.ts"), [*turned, (5, 6, 7)])
        up = SURFACE.replace("Depth", "Elevation")
        self.assert_rows(self.read(up, "a.ts"), CORNERS)
        lines = reading.read_faults(self.file("a.ts", SURFACE))
        self.assertEqual(lines.GetPoint(0), turned[0])

    def test_lines_become_boundary_and_faults(self):
        first, second = [(0, 0, 1), (5, 0, 2), (5, 5, 3)], [(8, 8, 4), (9, 9, 5), (9, 8, 6)]
        for name, content in (("irap", IRAP_LINES), ("cps-3", CPS3_LINES)):
            with self.subTest(name=name):
                path = self.file("a.dat", content)
                self.assertEqual(lines_of(reading.read_faults(path)), [first, second])
        for name, content in (("irap", IRAP_LINES), ("gmt", GMT)):
            with self.subTest(name=name, what="boundary"):
                rings = lines_of(reading.read_boundary(self.file("a.dat", content)))
                self.assertEqual([len(ring) for ring in rings], [4, 4])
                self.assertEqual(rings[1][0], rings[1][-1])
        found = lines_of(reading.read_faults(self.file("a.gmt", GMT)))
        self.assertEqual(found[0], [(x, y, 12.5) for x, y, _ in first])
        found = lines_of(reading.read_faults(self.file("a.pl", LINES)))
        self.assertEqual(found, [first, [(8, 8, 4), (9, 9, 5)], [(1, 1, 1), (2, 2, 2)]])
        self.assertEqual(reading.read_faults(self.file("a.ts", SURFACE)).GetNumberOfPolys(), 1)

    def test_damaged_files_are_refused_in_one_line(self):
        array = npy(numpy.array(KNOWN))
        for words, content in (
            ("is cut off within the header", IRAP[:40]),
            ("6 values are announced, 4 found", IRAP.rsplit("9999900", 1)[0]),
            ("6 values are announced, 1 found", IRAP.replace("0 1 2 100", "0 x 2 100")),
            ("6 values are announced, 7 found", IRAP + "5\n"),
            ("is not a valid IRAP classic grid: 3 x -2", IRAP.replace("-996 2", "-996 -2")),
            ("its FSLIMI, FSNROW or FSXINC", CPS3.replace("FSNROW 2 3\n", "")),
            ("its FSLIMI, FSNROW or FSXINC", CPS3[:60]),
            ("6 values are announced, 5 found", CPS3[:-2]),
            ("6 values are announced, 2 found", CPS3.replace("0.1E+31 1 102", "spoil 1 102")),
            ("6 values are announced, 5 found", ZMAP[:-3]),
            ("does not give rows, columns and limits", ZMAP.replace("2, 3, 1000.5", "2, 1000.5")),
            ("cut off within its header", ZMAP_POINTS[:80]),
            ("6 values are announced, 5 found", GXF[:-4]),
            ("give POINTS, ROWS, XORIGIN", GXF.replace("#ROWS\n2\n", "")),
            ("SENSE is 4, which is not read: gdal_translate", GXF.replace("#DUMMY", "#SENSE\n4\n#DUMMY")),
            ("packed, which is not read: gdal_translate", GXF.replace("#DUMMY", "#GTYPE\n3\n#DUMMY")),
            ("does not name x, y and z", EARTHVISION.replace("3 z meters", "3 code")),
            (", line 11: is not a row of x, y, z", EARTHVISION.replace("1010.5", "spoil", 1)),
            ("its END HEADER is missing", PETREL[: PETREL.index("END HEADER")]),
            ("does not name x, y and z, but X, Y", PETREL.replace("\nZ\n", "\n")),
            ("holds no points", PETREL[: PETREL.index("END HEADER") + 11]),
            ("END, is missing", SURFACE[:-5]),
            ("line 13: 'PVRTX 1 spoil", SURFACE.replace("612014.67", "spoil")),
            ("line 17: 'TRGL 1 2 9' is damaged", SURFACE.replace("TRGL 1 2 3", "TRGL 1 2 9")),
            ("line 16: 'ATOM 4 7' is damaged", SURFACE.replace("ATOM 4 1", "ATOM 4 7")),
            ("holds a Voxet; TSurf, VSet", "GOCAD Voxet 1\nAXIS_O 0 0 0\nEND\n"),
            (", line 5: is not a point of a line", GMT.replace("5 5", "5 five", 1)),
            ("is not a point of a line", CPS3_LINES.replace("8 8 4", "8")),
            ("cannot be read", array[:-8]),
            ("cannot be read", array[:20]),
            ("holds 3 of float64; rows of x, y and z", npy(numpy.zeros(3))),
            ("holds 2 x 3 of complex128", npy(numpy.zeros((2, 3), complex))),
            ("holds no points", npy(numpy.zeros((0, 3)))),
            ("has no columns x, y and z, but a, b", npy(numpy.zeros(3, [("a", "f8"), ("b", "f8")]))),
        ):
            with self.subTest(words=words):
                self.assert_refused(words, content, "a.dat")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
