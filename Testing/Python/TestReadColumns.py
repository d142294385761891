# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Which columns of a text table are x, y and z, where that is in doubt; and which texts are refused."""

import math
import sys
import unittest
import unittest.mock

import numpy
from text_tables import LAT, LON, NEAR_X, NEAR_Y, Tables, X, Y, Z, columns_of
from vtkelevationsurface.messages import FileError
from vtkelevationsurface.progress import no_progress
from vtkelevationsurface.reading.text import read_line_table, read_table

# Headerless rows that must keep their first three columns: (what, a row's numbers).
NODES = [(x, y) for x in range(12) for y in range(12)]
FIRST_THREE = (
    ("a small grid of whole numbers", [(x, y, x + y, x * y % 7) for x, y in NODES]),
    ("a grid row by row", [(y, x, x + y / 3, 1.75 * x + y) for x, y in NODES]),
    ("a grid of map coordinates", [(500000 + 25 * x, 4000000 + 25 * y, x * y % 5, x * 1.5)
                                   for x, y in NODES]),
    ("a flat surface", [(500.5 + 25 * x, 400.5 + 25 * y, 0, x * 1.5 + y * y) for x, y in NODES]),
    ("planes", [(x, y, x + y, 2 * x - y, 1.75 * x + y) for x, y in NODES]),
    ("a grid column by column", [(100 + 10 * x, 12 * y, x * y % 7, x / 7 + y) for x, y in NODES]),
    ("normals", [(x * 1.25, y * 1.25, x % 5 / 8, 0.0, 0.6, 0.8) for x, y in NODES]),
)


class Doubts(Tables):
    def test_attributes_behind_x_y_z_do_not_move_them(self):
        for what, rows in FIRST_THREE:
            with self.subTest(what):
                cloud = self.read("".join(" ".join(map(str, row)) + "\n" for row in rows))
                self.assert_rows(cloud, [row[:3] for row in rows])
                self.assertIn(f"the first 3 of {len(rows[0])} columns", cloud.notes[1])

    def test_what_rises_before_x_y_z_may_be_a_time_or_the_x_of_sorted_points(self):
        for kinds, step in (("x y z", 0.25), ("nx ny z", 0.25), ("nx ny z", 20.25)):
            rows, expected = columns_of(kinds)
            text = "".join(f"{5000 + step * i:.2f} {' '.join(row)}\n" for i, row in enumerate(rows))
            with self.subTest(kinds=kinds, step=step):
                if kinds == "x y z":  # no elevation is as high as its y
                    self.assert_rows(self.read(text), expected)
                else:
                    self.assertIn("or --columns 2,3,4", self.refusal(text))

    def test_what_may_be_a_line_or_a_coordinate_is_asked_about(self):
        generator = numpy.random.default_rng(3)
        near = [(i, k, f"{40 + k * math.cos(i):.2f}", f"{90 + k * math.sin(i):.2f}", 16.5 + k % 3)
                for i in range(100, 109) for k in range(20)]
        tracks = [(100 + 10 * i, 12 * k + int(generator.integers(8)), i * k % 17, k % 5)
                  for i in range(12) for k in range(30)]
        for what, rows, words in (
            ("line and trace, or nodes", near, "--columns 1,2,3"),
            ("line and trace, or nodes", near, "or --columns 3,4,5"),
            ("tracks to the north, or a line", tracks, "or --columns 2,3,4"),
        ):
            with self.subTest(what):
                text = "".join(" ".join(map(str, row)) + "\n" for row in rows)
                self.assertIn(words, self.refusal(text))

    def test_what_stands_before_whole_coordinates_is_noted(self):
        generator = numpy.random.default_rng(3)
        points = generator.integers(0, 90, (50, 3)).tolist()
        for what, first in (("an id", range(50)), ("the same in all rows", [0.5] * 50)):
            rows = [[value, *point] for value, point in zip(first, points)]
            cloud = self.read("".join(" ".join(map(str, row)) + "\n" for row in rows))
            self.assert_rows(cloud, points)
            self.assertIn(f"column 1 is {what}", cloud.notes[1])

    def test_random_tables_without_names_are_read_right_or_asked_about(self):
        generator = numpy.random.default_rng(11)
        asked = 0
        for trial in range(150):
            columns, first, z = random_table(generator)
            text = "".join(" ".join(row) + "\n" for row in zip(*columns))
            expected = numpy.array([*columns[first : first + 2], columns[z]], dtype="f8").T
            with self.subTest(trial=trial, head=text[:80]):
                try:
                    self.assert_rows(self.read(text), expected)
                except FileError as error:
                    self.assertIn("two ways", str(error))
                    asked += 1
        self.assertLess(asked, 50)  # where numbers of lines stand before z, most

    def test_hundreds_of_named_columns_are_judged_from_the_left(self):
        """Each of a thousand compared with each would have no end."""
        names = " ".join(f"v{i}" for i in range(1000)) + "\n"
        rows = [" ".join(str(i * j % 97) for i in range(1, 1001)) + "\n" for j in range(1, 51)]
        cloud = self.read(names + "".join(rows))
        self.assertEqual(cloud.points.GetNumberOfPoints(), 50)

    def test_point_names_and_a_code_leave_the_order_open(self):
        generator = numpy.random.default_rng(2)
        for names in ([f"P{i}" for i in range(40)], generator.permutation(40).tolist()):
            rows = [
                f"{name},{5000 + a:.3f},{3000 + b:.3f},{a / 50:.3f},T\n"
                for name, (a, b) in zip(names, generator.uniform(0, 90, (40, 2)))
            ]
            self.assertIn("--columns 3,2,4", self.refusal("".join(rows)))

    def test_two_readings_are_shown_with_the_options_that_decide(self):
        rows, _ = columns_of("id nx ny z code")
        text = "".join(",".join(row) + "\n" for row in rows)
        error = self.refusal(text)
        for words in ("two ways", "--columns 3,2,4", "--columns 2,3,4", "\n  1        2 ",
                      f"\n  1  {NEAR_X[0]}  {NEAR_Y[0]}  {Z[0]}"):
            self.assertIn(words, error)
        expected = numpy.column_stack((NEAR_Y, NEAR_X, Z))
        self.assert_rows(self.read(text, columns=["3", "2", "4"]), expected)

    def test_several_columns_of_one_name_are_refused_with_both(self):
        rows = "\n1 2 3 4 5\n3 4 5 6 7\n5 5 5 5 9\n"
        for head, words in (
            ("X Y Z_depth Z_time Q", "columns 3 (Z_depth) and 4 (Z_time) may all be z"),
            ("X_utm Y_utm X_local Y_local Z", "choose --columns 1,2,5 or --columns 3,4,5\n"),
            ("X Y Depth TWT Q", "may all be z"),
            ("Easting Easting Northing Z Q", "may all be x"),
        ):
            with self.subTest(head):
                self.assertIn(words, self.refusal(head + rows))

    def test_names_of_some_axes_leave_one_free_column_or_are_refused(self):
        rows, expected = columns_of("id x y z")
        text = "".join(",".join(row) + "\n" for row in rows)
        cloud = self.read("id,X,Y,Top Chalk\n" + text)
        self.assert_rows(cloud, expected)
        self.assertIn("z = 4 (Top Chalk)", cloud.notes[1])
        error = self.refusal("Hochwert,foo,bar,Hoehe\n" + text)
        self.assertIn("the names give y = 1 (Hochwert), z = 4 (Hoehe), but not x", error)
        self.assertIn("it may be columns 2 (foo) and 3 (bar)", error)
        rows, _ = columns_of("x y amp z")
        text = "".join(",".join(row) + "\n" for row in rows)
        self.assertIn("but not z", self.refusal("X,Y,top,base\n" + text))

    def test_the_better_name_is_taken_and_the_other_noted(self):
        rows, _ = columns_of("x y z amp")
        text = "X,Y,Elevation,Depth\n" + "".join(",".join(row) + "\n" for row in rows)
        cloud = self.read(text)
        self.assert_rows(cloud, numpy.column_stack((X, Y, Z)))
        self.assertTrue(any("column 4 (Depth) could be too" in note for note in cloud.notes))

    def test_depths_are_noted_unless_they_are_turned_over(self):
        text = "x,y,depth\n1,2,3\n4,5,7\n"
        self.assertIn("--depth", " ".join(self.read(text).notes))
        self.assertNotIn("--depth", " ".join(self.read(text, depth=True).notes))
        below = "x,y,depth\n1,2,-3\n4,5,-7\n"
        self.assertNotIn("--depth", " ".join(self.read(below).notes))

    def test_lines_and_rings_have_their_columns_found_too(self):
        for text, needed, expected in (
            ("1 5.5 6.5\n2 7.5 6.5\n3 8.5 9.5\n4 1.5 7.5\n", 2, (5.5, 6.5)),
            ("5.5 6.5 9.5\n7.5 6.5 9.5\n8.5 9.5 9.5\n", 2, (5.5, 6.5)),
            ("id,northing,easting\n1,6.5,5.5\n", 2, (5.5, 6.5)),
            ("x,z,y\n1,3,2\n", 3, (1, 2, 3)),
        ):
            rows = read_table(self.file("a.txt", text), needed=needed)[0]
            self.assertEqual(tuple(rows[0]), expected)
        with self.assertRaises(FileError) as caught:
            read_table(self.file("a.txt", "X,X,Y\n1,2,3\n"), needed=2)
        self.assertIn("a header line with easting, northing names the columns", str(caught.exception))
        self.assertNotIn("--columns", str(caught.exception))

    def test_northing_before_easting_without_a_header_is_noted(self):
        rows, _ = columns_of("y x z")
        feet = [f"{1.5e6 + x},{17.7e6 + y},{z}\n" for x, y, z in zip(NEAR_X, NEAR_Y, Z)]
        cloud = self.read("easting,northing,z\n" + "".join(feet))
        self.assertNotIn("as large as a northing", " ".join(cloud.notes))
        text = "".join(" ".join(row) + "\n" for row in rows)
        cloud = self.read(text)
        self.assert_rows(cloud, numpy.column_stack((Y, X, Z)))
        self.assertIn("--columns 2,1,3", cloud.notes[-1])

    def test_feet_of_kentucky_and_california_are_no_gauss_krueger(self):
        for east, north in ((5750e3, 3600e3), (5280e3, 4180e3), (5960e3, 2190e3), (5950e3, 2515e3)):
            rows = [f"{i} {east + x:.2f} {north + y:.2f} {z}" for i, (x, y, z) in enumerate(zip(NEAR_X, NEAR_Y, Z), 1)]
            for code in ("", " GR"):
                error = self.refusal("".join(f"{row}{code}\n" for row in rows))
                self.assertIn("--columns 3,2,4 or --columns 2,3,4", error)
        for east, north in ((4500e3, 5400e3), (5404e3, 5486e3), (6512e3, 5504e3)):
            rows = [(north + y, east + x, z) for x, y, z in zip(NEAR_X, NEAR_Y, Z)]
            text = "".join(f"{i} {y:.2f} {x:.2f} {z}\n" for i, (y, x, z) in enumerate(rows, 1))
            if (east, north) == (5404e3, 5486e3):
                self.assertIn("--columns 3,2,4 or --columns 2,3,4", self.refusal(text))
            else:
                self.assertIn("column 2 is taken as northing", " ".join(self.read(text).notes))

    def test_numbers_that_a_spreadsheet_shortens_may_stand_behind_z(self):
        rows = [",".join(row) + f",4.8{i % 10}E+05,1.2{i % 7}E+06\n" for i, row in enumerate(columns_of("x y z")[0])]
        for head in ("", "x,y,z,volume,area\n"):
            self.assertEqual(self.read(head + "".join(rows)).points.GetNumberOfPoints(), len(rows))
        rows = [f"{i},4.8{i % 10}E+05;1,2{i % 7}E+06;5{i}".replace(";", ",").replace("1,2", "1.2") for i in range(60)]
        self.assertIn("are shortened by a spreadsheet", self.refusal("id,x,y,z\n" + "\n".join(rows)))

    def test_sizes_prove_which_is_north_in_the_grid_of_hungary(self):
        for head, east, north in (("Pontszám;Y;X;M", 1, 2), ("Pontszám;X;Y;M", 1, 2), ("Pontszám;X;Y;M", 2, 1)):
            rows = [[str(i), "", "", str(z)] for i, z in enumerate(Z, 1)]
            for row, x, y in zip(rows, NEAR_X, NEAR_Y):
                row[east], row[north] = f"{646000 + x:.2f}", f"{204000 + y:.2f}"
            cloud = self.read("\n".join([head, *map(";".join, rows)]) + "\n")
            self.assertGreater(cloud.points.GetPoint(0)[0], 400e3)

    def test_names_on_both_sides_of_the_first_data_lose_no_row(self):
        cloud = self.read("x,y,z\n1,2,NULL\n4,5,7\n1,3,#N/A\n")
        self.assertEqual(list(cloud.lines), [2, 3, 4])
        self.assertIn("1 header line", cloud.notes[0])
        error = self.refusal("500000.25 4000000.25-9999.00\n500001.25 4000000.25 12.00\n")
        self.assertIn("line 1: numbers of fixed width touch, as 4000000.25-9999.00", error)

    def test_comments_do_not_hide_the_names_and_separators_may_end_lines(self):
        self.assert_rows(self.read("# z y x\n# made by hand\n1 2 3\n4 5 7\n"),
                                [(3, 2, 1), (7, 5, 4)])
        for head in ("", "z,x,y,\n", "z,x,y\n", "z,x,y,,,\n"):
            cloud = self.read(head + "1,2,3,\n4,5,7,\n")
            self.assertEqual(cloud.points.GetPoint(0), (2, 3, 1) if head else (1, 2, 3))
            self.assertEqual(len(cloud.notes), 2)
            cloud = self.read(head + "1,2,3,,,\n4,5,7,,,\n")
            self.assertEqual(cloud.points.GetPoint(0), (2, 3, 1) if head else (1, 2, 3))

    def test_what_is_not_a_plain_number_is_reported(self):
        for text, words in (
            ("X;Y;Z\n612.014,67;6.073.983,68;633,5\n", "marks between thousands"),
            ('"612,014.67","6,073,983.68","633.5"\n', "marks between thousands"),
            ("48\u00b012'30\" 7\u00b030'10\" 230\n", "degrees, minutes and seconds"),
            ("<html>1 2 3\n", "HTML"),
            ("7.5E 48.2N 230\n", "a letter for north"),
            ("1\u00a0000,5 2\u00a0000,5 3 4\n", "marks between thousands"),
        ):
            with self.subTest(words):
                self.assertIn(words, self.refusal(text))

    def test_more_or_fewer_names_than_columns_are_an_error(self):
        pairs = "455017,13,5623027,04,121,40\n455047,36,5623112,03,124,61\n"
        thousands = "454 017,13\t5 624 027,04\t121,40\n456 047,36\t5 625 112,03\t124,61\n"
        for text, words in (
            ("X,Y,Z\n" + pairs, "commas stand for decimals and between columns"),
            (pairs.replace(",5", ", 5").replace(",12", ", 12"), "commas stand for decimals"),
            ("X\tY\tZ\n" + thousands, "marks between thousands"),
            (thousands, "marks between thousands"),
            (thousands.replace(",", "."), "marks between thousands"),
            ("Lat Lon Depth\n50 16.1077N 9 4.6794E 121.4\n48 46.3129N 8 38.2E 124.6\n",
             "a letter for north"),
            ("Lat Lon Depth\n50 16.1 9 4.6 121\n48 46.2 8 38.2 124\n",
             "the header has 3 names, but lines have 5 columns; export degrees"),
            ("Lat Lon Depth\n48 46 18.7 8 38 12.7 124.6\n48 46 18.8 8 38 12.9 124.7\n",
             "look like degrees, minutes and seconds"),
            ("X,Y,Z\n1.5,2.5,3.5,4.5,5.5\n2.5,1.5,3.5,4.5,6.5\n", "the header has 3 names"),
            ("Code,Y,X,Z\n2.5,1.5,3.5\n2.5,1.75,4.5\n", "the header has 4 names, but lines have 3"),
        ):
            with self.subTest(text):
                self.assertIn(words, self.refusal(text))
        text = "X,Y,Z\n1.5,2.5,3.5,4.5,5.5\n2.5,1.5,3.5,4.5,6.5\n"
        cloud = self.read(text, columns=("2", "1", "3"))
        self.assertEqual(cloud.points.GetPoint(0), (2.5, 1.5, 3.5))
        for head, end in (("X,Y,Z,,", ",,"), ("X,Y,Z", ","), ("X,Y,Z,", "")):
            text = f"{head}\n1,2,3{end}\n4,5,7{end}\n"
            self.assert_rows(self.read(text), [(1, 2, 3), (4, 5, 7)])

    def test_marks_between_thousands_are_not_decimal_signs_where_the_file_proves_it(self):
        local = [(152 + 7 * i, 900 + 31 * i, 1214 + i) for i in range(40)]
        for separator, text in (
            ("\t", "455017.13\t5623027.04\t1,734\n455047.36\t5623112.03\t1,780\n"),
            (";", "455017,1;5623027,0;1.021\n455047,4;5623112,0;1.025\n"),
            ("\t", "".join("\t".join(f"{v:,}" for v in row) + "\n" for row in local)),
        ):
            for head in ("", separator.join("XYZ") + "\n"):
                self.assertIn("marks between thousands", self.refusal(head + text))
        cloud = self.read("455017,1;5623027,0;1.25\n455047,4;5623112,0;1.5\n")
        self.assertEqual(cloud.points.GetPoint(1), (455047.4, 5623112.0, 1.5))

    def test_decimal_commas_in_quotes_between_commas_are_recognised(self):
        for text in ('"600000,1","5000000,2","-999,3"\n"600001,1","5000001,2","-99,3"\n',
                     'x,y,z\n"1,5","2,5","3,5"\n"1,25","2,5",7\n'):
            self.assertIn("commas stand for decimals and between columns", self.refusal(text))

    def test_marks_of_the_end_and_headers_that_come_again_are_left_out(self):
        for end in (b"\x1a", b"\n\x1a\n", b"\r\n" + bytes(300)):
            cloud = self.read(b"x,y,z\n1,2,3\n4,5,7" + end)
            self.assert_rows(cloud, [(1, 2, 3), (4, 5, 7)])
        cloud = self.read("x y z\n1 2 3\n\x0cx y z\n4 5 7\nx y z \n8 8 9\n")
        self.assert_rows(cloud, [(1, 2, 3), (4, 5, 7), (8, 8, 9)])
        self.assertEqual(list(cloud.lines), [2, 4, 6])
        self.assertIn("header lines that come again are left out: 2", cloud.notes)

    def test_what_no_latitude_can_be_is_recognised(self):
        cloud = self.read("Lat,Lon,Height\n110.25,9.5,121.5\n108.75,8.5,124.5\n")
        self.assertIn("column 1 (Lat) is a latitude by its name, but holds 110.25",
                      " ".join(cloud.notes))
        cloud = self.read("Lat,Lon,Height\n-89.5,359.5,121.5\n88.75,8.5,124.5\n")
        self.assertNotIn("latitude", " ".join(cloud.notes))

    def test_a_z_unit_that_is_not_that_of_x_and_y_is_noted(self):
        rows = "".join(f"{x},{y},{z}\n" for x, y, z in zip(X, Y, Z))
        for head, is_noted in (
            ("X (m),Y (m),Z (ft)", True), ("x,y,z\nm,m,ft", True), ("x_m,y_m,elev_ft", True),
            ("# Unit in X and Y direction: m\n# Unit in depth: ft", True),
            ("X (ft),Y (ft),Z (ft)", False), ("x,y,z\n[m],[m],[m]", False),
            ("Easting,Northing,Height (ft)", False), ("x,y,z", False),
        ):
            with self.subTest(head=head):
                notes = " ".join(self.read(head + "\n" + rows).notes)
                self.assertEqual("in metres and z is in feet" in notes, is_noted, notes)

    def test_the_columns_are_always_noted(self):
        for head in ("x y z\n", ""):
            cloud = self.read(head + "1.5 2.5 3\n2.5 7 4\n3 1 5\n")
            self.assertEqual("x, y, z are in columns 1, 2, 3", cloud.notes[1])

    def test_names_that_say_nothing_are_noted_with_the_axes(self):
        cloud = self.read("foo;bar;baz\n1;2;3\n5;6;7\n")
        self.assertIn(
            "no column is named as x, y or z: x = 1 (foo), y = 2 (bar), z = 3 (baz) (see --columns)",
            cloud.notes,
        )
        self.assertNotIn("no column", " ".join(self.read("1;2;3\n5;6;7\n").notes))

    def test_quotes_that_belong_to_a_name_are_kept(self):
        cloud = self.read('X,Y,"Top ""A""","Top"\n1,2,3,4\n5,6,7,8\n', columns="X,Y,Top")
        self.assertEqual(cloud.points.GetPointData().GetArrayName(0), 'Top "A"')

    def test_a_column_cannot_be_two_axes(self):
        text = "Top_A,x,y\n1,2,3\n5,6,7\n"
        for columns, words in (
            ("x,x,Top_A", "takes both x and y from column 2 (x)"),
            ("2,3,y", "takes both y and z from column 3 (y)"),
        ):
            self.assertIn(words, self.refusal(text, columns=columns))

    def test_a_column_that_is_asked_for_is_one_and_has_a_name(self):
        for names, column, words in (
            ("x,y,z,z", "z", "columns 3 (z) and 4 (z) are all called z; --columns takes the number of one"),
            ("x,y,Z (m),Z (ft)", "z", "columns 3 (Z (m)) and 4 (Z (ft)) are all called z"),
            ("x,y,,z", "?", "there is no column ? for z; lines have 4"),
            ("x,y,z,q", "-1", "there is no column -1 for z; lines have 4, named x, y, z, q"),
            ("x,y,z,q", "0", "there is no column 0 for z"),
        ):
            self.assertIn(words, self.refusal(f"{names}\n1,2,3,4\n5,6,7,8\n", columns=f"x,y,{column}"))
        cloud = self.read("x,y,Z,z\n1,2,3,4\n5,6,7,8\n", columns="x,y,z")  # as it is written
        self.assert_rows(cloud, [(1, 2, 4), (5, 6, 8)])

    def test_a_line_of_the_numbers_of_columns_is_no_point(self):
        rows, expected = columns_of("nx ny z")
        for head, index in (("0,1,2\n", ""), (",0,1,2\n", "{},")):
            text = head + "".join(index.format(i) + ",".join(row) + "\n" for i, row in enumerate(rows))
            cloud = self.read(text)
            self.assert_rows(cloud, expected)
            self.assertIn("is a title, not a point", " ".join(cloud.notes))
        # Where it may be a point, it is one.
        head, among = "0,1,2\n", "-1.5,0.5,3.5\n5.5,6.5,7.5\n"
        for text in (head, 2 * head, head + "1,2,3\n5,6,7\n", head + among, "0 1 2\n5.5 6.5 7.5\n"):
            self.assertEqual(self.read(text).points.GetPoint(0), (0, 1, 2))

    def test_a_title_of_numbers_is_left_out_or_asked_about(self):
        rows = [" ".join(row) for row in columns_of("x y z")[0]]
        near = [" ".join(f"{v:.2f}" for v in row) for row in zip(NEAR_X - 2900, NEAR_Y, Z)]
        whole = [" ".join(f"{v:.0f}" for v in row) for row in zip(X, Y, Z)]
        degrees = [f"{lon} {lat} {z} 1" for lon, lat, z in zip(LON, LAT, Z)]
        for title, lines, is_sure in (
            ("1024 2048 3", rows, True), ("14 7 1", rows, True), ("60 0 0", rows, True), ("1 2 3 4", rows, True),
            ("2 7 1 60", [f"{row} {i % 4}" for i, row in enumerate(rows)], True), ("60 2 1 0", degrees, True),
            ("60 7 2", near, False), ("60 7 2", whole, False), ("60 7 0.5", rows, False),
            ("1024 2048 3", rows[:4], False), ("60 3 7", [f"{i % 70} {i % 9} {i % 11}" for i in range(60)], False),
        ):
            text = "\n".join([title, *lines]) + "\n"
            with self.subTest(text[:80]):
                if is_sure:
                    cloud = self.read(text, columns="1,2,3")
                    self.assertIn(f"line 1 is left out: {title} is a title, not a point", cloud.notes)
                else:
                    self.assertIn(f"line 1: {title} is unlike all rows below it, as a title is", self.refusal(text))
                    cloud = self.read(text, skip_bad_lines=True)
                    self.assertIn(f"lines of other kinds are left out: line 1 ({title})", cloud.notes)
                    self.assertIn("mark it with #", str(self.lines_refusal(text)))
                self.assertEqual(cloud.points.GetNumberOfPoints(), len(lines))
                self.assertEqual(self.read("\n".join(["# " + title, *lines]), columns="1,2,3").lines[0], 2)
                if is_sure:  # of another file behind it
                    cloud = self.read(text + text, columns="1,2,3")
                    self.assertIn("header lines that come again are left out: 1", cloud.notes)

    def test_a_grid_whose_first_column_rises_has_no_axes(self):
        for width in (6, 14):
            heights = [[f"{500 + 0.7 * i + 0.4 * k + i * k % 3 / 10:.2f}" for i in range(width)] for k in range(20)]
            text = "".join(" ".join(row) + "\n" for row in heights)
            self.assertIn(f"numpy.savez('a.npz', z=numpy.loadtxt('{self.path('a.txt')}'))", self.refusal(text))
            above = " ".join(["0", *(str(25 * i) for i in range(width))]) + "\n"
            before = "".join(" ".join([str(100 + 10 * k), *row]) + "\n" for k, row in enumerate(heights))
            self.assertIn("[1:, 1:], x=a[0, 1:], y=a[1:, 0]", self.refusal(above + before))
        rough = "".join(f"{10 * k},{k * 37 % 90}.5,{k * 53 % 70}.5,{k * 29 % 80}.5\n" for k in range(1, 30))
        self.assertIn("[1:, 1:], x=a[0, 1:], y=a[1:, 0]", self.refusal("y\\x,0,25,50\n" + rough))

    def test_titles_in_several_lines_are_left_out(self):
        rows = [" ".join(row) for row in columns_of("x y z")[0]]
        cloud = self.read("\n".join(["60 3 1", "1 2 3", *rows]))
        self.assertEqual(list(cloud.lines), list(range(3, 63)))
        for title in ("line 1 is left out: 60 3 1", "line 2 is left out: 1 2 3"):
            self.assertIn(title + " is a title, not a point", cloud.notes)

    def test_a_row_below_names_or_before_the_next_ids_is_no_title(self):
        rows = [",".join(row) for row in columns_of("x y z")[0]]
        ids = [f"{i + 2},{row}" for i, row in enumerate(rows)]
        for head, first, lines in (
            ("x,y,z", "100,200,50", rows), ("easting,northing,elevation", "1000.00,5000.00,100.00", rows),
            ("id,x,y,z", "7,100,200,5", ids), (None, "1,100,200,5", ids), (None, "1,700,900,100", ids),
            ("x,y,z", "60,7,2", [f"{i % 7},{i % 9},{i % 11}" for i in range(60)]),
        ):
            text = "\n".join([*filter(None, [head]), first, *lines]) + "\n"
            with self.subTest(text[:80]):
                cloud = self.read(text)
                self.assertEqual(cloud.points.GetPoint(0), tuple(map(float, first.split(",")[-3:])))
                self.assertEqual(cloud.points.GetNumberOfPoints(), len(lines) + 1)
        near = [f"{x},{y},{z}" for x, y, z in zip(NEAR_X, NEAR_Y, Z.round(1))]
        for lines in (rows, near):
            cloud = self.read("\n".join(["x,y,z", "1,2,3", *lines]))  # numbers of columns
            self.assertIn("line 2 is left out: 1 2 3 is a title, not a point", cloud.notes)

    def test_a_first_point_with_the_decimals_of_the_others_is_no_title(self):
        rows = [" ".join(f"{v:.2f}" for v in row) for row in zip(X, Y, Z)]
        self.assertEqual(self.read("\n".join(["1000.00 5000.00 100.00", *rows])).points.GetPoint(0), (1000, 5000, 100))
        error = self.refusal("\n".join(["1000.0 5000.0 100.0", *rows]))
        self.assertIn("a line of names of the columns above it", error)

    def test_a_vertex_that_closes_a_ring_is_no_title(self):
        ring = [f"{100 + 10 * math.cos(i / 3):.2f} {900 + 10 * math.sin(i / 3):.2f}" for i in range(18)]
        for end in ("", "\n\n1.5 1.5\n2.5 1.5\n2.5 2.5\n1.5 1.5\n"):
            path = self.file("a.txt", "\n".join(["500 200", *ring, "500 200"]) + end)
            rows, numbers, *_ = read_table(path, needed=2)
            self.assertEqual((tuple(rows[0]), len(rows)), ((500, 200), 20 + 4 * bool(end)))

    def test_a_doubtful_title_of_faults_without_z_is_asked_about(self):
        rows = [f"{100 + i % 5}.25 {200 + i % 7}.75" for i in range(20)]
        with self.assertRaisesRegex(FileError, "line 1: 60 7 is unlike all rows below it"):
            read_line_table(self.file("a.txt", "\n".join(["60 7", *rows])), no_progress)

    def lines_refusal(self, text):
        with self.assertRaises(FileError) as caught:
            read_table(self.file("a.txt", text), needed=2)
        return caught.exception

    def test_a_first_point_is_no_title(self):
        generator = numpy.random.default_rng(5)
        for first, low, high, decimals in (
            ((500000, 4100000, 1300), (505000, 4105000, 1310), (505300, 4105400, 1340), 2),  # a base 5 km away
            ((0, 0, 0), (452000, 5411000, 200), (453000, 5412000, 250), 2),  # a null
            ((0, 0, 5), (0, 0, 3), (100, 100, 9), 1), ((1, 1, 5), (2, 2, 3), (40, 50, 9), 0),
            ((1000, 1000, 100), (1005, 1012, 98), (1300, 1200, 105), 0), ((-3, -2, 0), (-2, -3, 1), (9, 9, 5), 0),
            ((636767, 849053, 1427), (636720, 849010, 1420), (636990, 849200, 1430), 2),
            ((7.5, 0.25, 427), (0.5, 16, 424), (3.5, 28, 425), 2),  # turns round
            ((0, 0, 0), (0, 5, 0), (90, 90, 9), 0),
            ((500000, 4000000, 0), (500001, 4000000, 1), (501000, 4000900, 9), 0),
        ):
            for count in (1, 5, 40):
                points = generator.uniform(low, high, (count, 3))
                lines = [[f"{v:.{decimals}f}" for v in point] for point in points]
                if min(first) < 1000 or count < 40:
                    lines = [[word.rstrip("0" * (decimals > 0)).rstrip(".") for word in line] for line in lines]
                text = "\n".join(map(" ".join, [map(str, first), *lines])) + "\n"
                with self.subTest(text[:80]):
                    self.assertEqual(self.read(text).points.GetPoint(0), first)
        for lines in (["0 13800 1101", "0 13830 1098", *(f"{30 * i} {i % 4} 99.5" for i in range(1, 30))],
                      ["14846.0 365.3 639.6", "14896.0 366.7 639.1", "0.4 0.4 994.2", "50.4 1.8 989.7"]):
            self.assertEqual(self.read("\n".join(lines)).lines[0], 1)

    def test_a_name_before_large_numbers_is_not_a_mark_between_thousands(self):
        with self.assertRaisesRegex(FileError, "no line holds 3 numbers; the most is 2"):
            self.read("Well,Easting,Northing\nW0,100,300\nW1,107,301\nW20,140,400\n")

    def test_two_columns_named_z_are_noted_or_refused(self):
        rows = "5.5;7.5;121.5;122.5\n6.5;7.75;123.5;124.5\n"
        self.assertIn("3 (Höhe_alt) and 4 (Höhe_neu) may all be z",
                      self.refusal("X;Y;Höhe_alt;Höhe_neu\n" + rows))
        cloud = self.read("X;Y;Depth;Corrected depth\n" + rows)
        self.assertIn("column 4 (Corrected depth) could be too", " ".join(cloud.notes))

    def test_three_columns_without_names_that_look_like_z_x_y_are_asked_about(self):
        text = "124.61;455047.36;5623112.03\n130.25;455160.25;5623112.75\n"
        self.assertIn("--columns 1,2,3 or --columns 2,3,1\n", self.refusal(text))
        self.assertEqual(self.read(text, columns="1,2,3").points.GetPoint(0)[0], 124.61)
        self.assertEqual(len(self.read("Z;X;Y\n" + text).notes), 2)
        text = "".join(f"{z},{lon},{lat}\n" for z, lon, lat in zip(Z, LON, LAT))
        self.assertIn("--columns 1,2,3 or --columns 2,3,1\n", self.refusal(text))

    def test_summary_lines_are_left_out_and_noted(self):
        for names in ("{}", "P{}"):  # numbers or text in the first column
            for end, words in (("Total;1;2;3\n", "line 42 (Total)"), ("MITTEL:;9;9;9\nMax;8;8;8\n",
                               "line 42 (MITTEL), line 43 (Max)"), ('"Std. Dev.";1;1;1\n', "Std")):
                rows = [f"{names.format(i)};{i}.5;{i * i % 7};{i}.25\n" for i in range(40)]
                cloud = self.read("ID;X;Y;Z\n" + "".join(rows) + end)
                self.assertEqual(cloud.points.GetNumberOfPoints(), 40)
                self.assertIn("summary lines are left out: ", cloud.notes[-1 - (names != "{}")]
                              + cloud.notes[-1])
                self.assertIn(words, " ".join(cloud.notes))
        cloud = self.read("ID X Y Z\n1 2 3 4\n2 5 7 8\nMean 3.5 5 6\n")
        self.assert_rows(cloud, [(2, 3, 4), (5, 7, 8)])
        words = "Promedio|Durchschnitt|Anzahl|Gesamtsumme|Ergebnis|Průměr|Celkem|Razem|Średnia|Átlag|Összesen|Ortalama|"
        for word in (words + "Toplam|Gjennomsnitt|Medelvärde|Gemiddeld|Итого|Среднее|合計|平均").split("|"):
            rows = [f"P{i};{i},5;{i * i % 7};{i},25\n" for i in range(40)]
            cloud = self.read("ID;X;Y;Z\n" + "".join(rows) + f"{word};7;7;7\n")
            self.assertIn(f"summary lines are left out: line 42 ({word})", cloud.notes)
        # Other words among numbers are kept and noted.
        rows = [f"{i},{i}.5,{i * i % 7},{i}.25\n" for i in range(40)]
        cloud = self.read("ID,X,Y,Z\n" + "".join(rows) + "BM7,1,2,3\n")
        self.assertEqual(cloud.points.GetNumberOfPoints(), 41)
        self.assertIn("column ID: 1 word is not a number (line 42: BM7)", cloud.notes)
        # Points may be named so.
        cloud = self.read("".join(f"{'max' if i % 2 else 'min'} {i} {i * i % 7} 1\n"
                                  for i in range(40)))
        self.assertEqual(cloud.points.GetNumberOfPoints(), 40)

    def test_thousands_and_degrees_that_cannot_be_proved_are_noted(self):
        for mark in ",.":
            text = f"X;Y;Z\n455017;5623027;1{mark}734\n455047;5623112;1{mark}780\n"
            self.assertIn(f"z = 1{mark}734 is read as 1.734", " ".join(self.read(text).notes))
        self.assertEqual(len(self.read("X;Y;Z\n455017;5623027;1.73\n5;7;1.780\n").notes), 2)
        text = "50 16 6.464 9 04 40.767 121.4\n48 46 18.772 8 38 12.785 124.6\n"
        self.assertIn("degrees, minutes and seconds", self.refusal(text))
        self.assertEqual(self.read(text, columns=("1", "4", "7")).points.GetPoint(0)[2], 121.4)

    def test_grids_of_other_formats_are_not_tables(self):
        for head, words in (
            ("ncols 4\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n", "ESRI"),
            ("NCOLS 4\nNROWS 2\n", "an ESRI ASCII grid"),
            ("DSAA\n4 2\n0 3\n0 1\n1 8\n", "a Surfer grid"),
        ):
            with self.subTest(head):
                self.assertIn(words, self.refusal(head + "1 2 3 4\n5 6 7 8\n"))
                with unittest.mock.patch.dict("sys.modules", osgeo=None):
                    advice = self.refusal(head + "1 2 3 4\n5 6 7 8\n")
                self.assertTrue(advice.endswith("; install python3-gdal to read it"), advice)


def random_table(generator):
    """(columns as words, index of x, index of z): a table without names of points on a grid, on tracks or
    scattered."""
    count, side = int(generator.choice([30, 200])), 10 ** generator.uniform(1.5, 4)
    step = numpy.divmod(numpy.arange(count), 10)
    kind = generator.choice(["grid", "turned grid", "scattered", "tracks"])
    if kind == "scattered":
        x, y = generator.uniform(0, side, (2, count))
    elif kind == "tracks":
        x, y = side * (step + generator.normal(0, 0.03, (2, count))) / 10
    else:
        angle = 0.3 * (kind == "turned grid")
        x = side * (step[0] * math.cos(angle) - step[1] * math.sin(angle)) / 10
        y = side * (step[0] * math.sin(angle) + step[1] * math.cos(angle)) / 10
    place = [(0, 0), (500000, 5400000), (3400000, 5500000), (1000, 5000)][generator.integers(4)]
    decimals = int(generator.choice([0, 1, 3])) if kind == "grid" else 2
    z = 80 + side / 30 * (numpy.sin(x / side * 5) + numpy.cos(y / side * 4))
    others = {
        "id": [1 + numpy.arange(count)],
        "class": [generator.choice([1, 2, 5, 6], count)],
        "line trace": [1000 + step[0], 2000 + 2 * step[1]] if kind == "turned grid" else [],
        "lines between": [1000 + step[0], 2000 + 2 * step[1]],
        "trace between": [101 + step[1]],
        "time": [(3e5 + numpy.cumsum(generator.uniform(0, 0.01, count))).round(6)],
        "intensity": [generator.integers(0, 4000, count)],
        "colour": list(generator.integers(0, 256, (3, count))),
        "amplitude": [generator.normal(0, 1000, count).round(2)],
        "": [],
    }
    before = others[str(generator.choice(["", "", "id", "class", "time", "line trace"]))]
    after = others[str(generator.choice(["", "intensity", "colour", "amplitude", "class"]))]
    between = others[str(generator.choice(["", "", "", "lines between", "trace between"]))]
    points = [[f"{v:.{decimals}f}" for v in values] for values in (x + place[0], y + place[1])]
    finely = generator.choice([0, 1, 2])
    heights = [f"{v:.{finely}f}" for v in z]
    if generator.random() < 0.3:
        heights[int(generator.integers(count))] = "1e30"
    words = [[str(v) for v in column] for column in before + points + between + [heights] + after]
    return words, len(before), len(before) + 2 + len(between)


class OthersBeside(Tables):
    """What stands besides x, y and z in tables without their names, and is taken for none of them."""

    def table(self, *columns):
        return "".join(" ".join(map(str, row)) + "\n" for row in zip(*columns))

    def test_nulls_are_left_out_before_columns_are_judged(self):
        generator = numpy.random.default_rng(8)
        count = 829
        x, y = generator.uniform(0, 4000, (2, count)).round(2)
        z = (1700 + x / 50 + y / 90).round(2)
        others = [generator.normal(0, 900, count).round(2), generator.uniform(0, 1, count).round(2)]
        z[[5, 80, 300, 828]] = 1e30
        cloud = self.read(self.table(x + 400000, y + 6500000, z, *others, numpy.arange(count) % 5))
        self.assert_rows(cloud, numpy.column_stack((x + 400000, y + 6500000, z)))

    def picks(self, shift):
        """Name, x, y, inline, crossline and z of picks along five lines; x is moved by shift(inline)."""
        inline, crossline = numpy.divmod(numpy.arange(100), 20)
        inline, crossline = 2100 + 7 * inline, 800 + 5 * crossline
        generator = numpy.random.default_rng(4)
        x = 430000 + 25.0 * inline + shift(inline) + generator.uniform(-9, 9, 100)
        y = 6780000 + 12.5 * crossline + generator.uniform(-4, 4, 100)
        z = (1900 + x / 100 - y / 900).round(2)
        return [["Top"] * 100, x.round(2), y.round(2), inline, crossline, z]

    def test_the_number_of_a_line_is_not_a_height(self):
        columns = self.picks(lambda inline: 0.0)
        for order in ([0, 1, 2, 3, 4, 5], [0, 1, 2, 4, 3, 5], [0, 3, 4, 1, 2, 5]):
            cloud = self.read(self.table(*(columns[i] for i in order)))
            self.assert_rows(cloud, numpy.column_stack((columns[1], columns[2], columns[5])))
            self.assertIn("a line, trace or place in a grid", " ".join(cloud.notes))
        columns = self.picks(lambda inline: 900.0 * (inline % 3))  # no plane of lines
        error = self.refusal(self.table(*columns))
        self.assertIn("choose --columns 2,3,4 or --columns 2,3,6\n", error)
        self.assertIn("\n    1          2  ", error)
        self.assertIn(f"\n  Top  {columns[1][0]}  {columns[2][0]}  2100  800  ", error)
        # Whole heights that rise and fall are heights.
        columns[3] = (1900 + 20 * numpy.sin(columns[1] / 30)).astype(int)
        cloud = self.read(self.table(*columns[1:]))
        self.assert_rows(cloud, numpy.column_stack(columns[1:4]))

    def test_lines_and_traces_are_x_and_y_where_no_others_are(self):
        for head in ("Inline Crossline Z", "IL XL Z", "Inline Crossline Z Correlation Tracking_Order"):
            rows, width = [], len(head.split())
            for i in range(30):
                rows.append([100 + i // 6, 200 + 2 * (i % 6), 1800.5 + i, 0.5, 7][:width])
            cloud = self.read(head + "\n" + self.table(*zip(*rows)))
            self.assert_rows(cloud, [row[:3] for row in rows])
            self.assertIn("lengths count lines and traces, not metres", " ".join(cloud.notes))
        self.assertIn("z = 5", " ".join(self.read(
            "Inline Crossline X Y Z\n1 2 3 4 5\n1 3 3 5 5\n2 2 4 4 5\n").notes))

    def test_dates_and_times_are_not_coordinates(self):
        generator = numpy.random.default_rng(6)
        second = numpy.arange(300) * 7
        lat, lon = (54.3 + second / 9e4).round(6), (10.2 + second / 7e4).round(6)
        depth = generator.uniform(8, 12, 300).round(2)
        clock = [12 + second // 3600, second // 60 % 60, second % 60]
        date = [[2019] * 300, [7] * 300, [23] * 300]
        for before in (clock, [*date, *clock], [*reversed(date), *clock], [*date, *clock[:2]]):
            n = len(before)
            error = self.refusal(self.table(*before, lat, lon, depth))
            self.assertIn(f"--columns {n + 2},{n + 1},{n + 3} or --columns {n + 1},{n + 2},{n + 3}\n",
                          error)
            self.assertIn(f"{lat[1]}  {lon[1]}", error)
            x, y = (lon * 1e4 + 400000).round(2), (lat * 1e4 + 5500000).round(2)
            cloud = self.read(self.table(*before, x, y, depth))
            self.assert_rows(cloud, numpy.column_stack((x, y, depth)))
            self.assertIn("a part of a date or time", " ".join(cloud.notes))
        head = "Year Month Day Hour Min Sec Lat Lon Signal Echo\n"
        text = head + self.table(*date, *clock, lat, lon, depth, depth + 1)
        self.assertIn("but not z; it may be columns 9 (Signal) and 10 (Echo)", self.refusal(text))
        cloud = self.read("time,easting,northing,value\n300000.5,1.5,2.5,7\n300001.5,1.5,3.5,9\n")
        self.assert_rows(cloud, [(1.5, 2.5, 7), (1.5, 3.5, 9)])
        self.assertIn("z = 4 (value); z is the only column left", " ".join(cloud.notes))

    def test_degrees_that_can_be_read_one_way_only_are_asked_about(self):
        text = self.table(LAT, LON + 100, Z)
        self.assertIn("choose --columns 2,1,3 or --columns 1,2,3\n", self.refusal(text))


class OneNameMissing(Tables):
    def test_the_only_column_left_is_taken_and_noted(self):
        rows = "".join(f"{100 + i * 1.5},{(i * 37) % 100 + 0.25},{i % 7 + 0.5}\n" for i in range(50))
        cloud = self.read("easting,foo,elev\n" + rows)
        self.assertIn("y = 2 (foo), z = 3 (elev); y is the only column left", " ".join(cloud.notes))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
