# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The lines of a text table: numbers, blocks, other columns, and lines that are not rows."""

import math
import random
import sys
import unittest
import warnings

import numpy
from text_tables import KINDS, Tables, columns_of
from vtkelevationsurface import read_boundary
from vtkelevationsurface.clouds import ReadOptions, coordinates_of
from vtkelevationsurface.messages import FileError
from vtkelevationsurface.reading.nulls import take_out
from vtkelevationsurface.reading.text import read_table, read_text
from vtkelevationsurface.reading.text_blocks import BLOCK
from vtkmodules.util.numpy_support import vtk_to_numpy


class Parsing(Tables):
    def test_numbers_are_equal_to_the_last_bit(self):
        generator = numpy.random.default_rng(5)
        values = generator.uniform(-1, 1, (4000, 3)) * 10.0 ** generator.integers(-8, 8, (4000, 3))
        for text in (
            "".join(f"{a!r} {b!r} {c!r}\n" for a, b, c in values.tolist()),
            "".join(f"{a!r};{b!r};{c!r}\r\n" for a, b, c in values.tolist()).replace(".", ","),
            "x,y,z\n\n" + "".join(f"{a!r}, {b!r}, {c!r}\n" for a, b, c in values.tolist()),
            "".join(f'{a!r},"{b!r}",{c!r}\n' for a, b, c in values.tolist()),
            "".join(f"{a!r}\t{b!r}\t{c!r}\r" for a, b, c in values.tolist()),
        ):
            self.assert_rows(self.read(text), values)

    def test_fortran_exponents_are_read_and_underscores_are_not(self):
        self.assert_rows(self.read("1.5D+02 2d0 3\n4 5 6\n"), [(150, 2, 3), (4, 5, 6)])
        self.assertIn("'1_0' in column 2", self.refusal("1 2 3\n4 1_0 6\n"))

    def test_odd_signs_and_separators_are_read(self):
        for text in (
            "1 \u22122 3.5\n4 5 6\n", "1|-2|3.5\n4|5|6\n", "1 | -2 | 3.5\n4 | 5 | 6\n",
            "x   y coordinate   z\n1 -2 3.5\n4 5 6\n",
        ):
            self.assert_rows(self.read(text), [(1, -2, 3.5), (4, 5, 6)])
        self.assert_rows(self.read("1;2;3,5\n4;5;6,5\n"), [(1, 2, 3.5), (4, 5, 6.5)])
        cloud = self.read("Nr;X;Y;Z\n1;2;3;4,5\n2;4;5;6,5\n")
        self.assert_rows(cloud, [(2, 3, 4.5), (4, 5, 6.5)])
        self.assertEqual(list(self.read("1 2 3\n\n4 5 6\n").lines), [1, 3])
        # Bytes of UTF-8 that are blanks in Latin-1 part no words.
        cloud = self.read("name x y z\nvoil\u00e0x 1 -2 3.5\n\u00e0x 4 5 6\n")
        self.assert_rows(cloud, [(1, -2, 3.5), (4, 5, 6)])

    def test_garbage_is_read_or_refused_in_one_line(self):
        generator = random.Random(4)
        words = (
            "1 2 -9999 0 nan inf 1e30 3.5 1,5 x Y NULL # 1D3 1e400 - id 4000000 > // 1_0 | 1e306 "
            '"1" "a 9999'
        ).split(" ")
        read = 0
        for trial in range(400):
            separator = generator.choice([" ", ",", ";", "\t"])
            rows = [
                separator.join(
                    generator.choice(words) if generator.random() < 0.1 * (trial % 4)
                    else str(round(generator.uniform(-9, 9), 2))
                    for _ in range(generator.choice([3, 4, 4, 4, 5]))
                )
                for _ in range(generator.randint(1, 30))
            ]
            if trial % 3 == 0:
                rows.insert(0, separator.join(generator.choices("xyzXENHlr", k=4)))
            with self.subTest(trial=trial), warnings.catch_warnings():
                warnings.simplefilter("error")
                try:
                    take_out(self.read("\n".join(rows)), ReadOptions())
                    read += 1
                except FileError as error:
                    self.assert_one_line(str(error))
        self.assertGreaterEqual(read, 90)  # nearly all without garbage; few rows may be a question

    def test_blocks_are_joined_and_lines_counted_through_them(self):
        line = b"500000.25 4000000.5 1.125\n"
        count = BLOCK // len(line) + 2000
        text = line * (count - 1000) + b"# a comment\n\n" + line * 999 + b"1 2 3"
        cloud = self.read(text)
        self.assertEqual(cloud.points.GetNumberOfPoints(), count)
        self.assertEqual(cloud.points.GetPoint(count - 1), (1.0, 2.0, 3.0))
        self.assertEqual(cloud.lines[count - 1], count + 2)
        self.assertEqual(cloud.lines[count - 1001], count - 1000)
        self.assertIn("1 comment line", cloud.notes[0])
        bad = line * (count - 1000) + b"1 two 3\n"
        self.assertIn(f"line {count - 999}: 'two' in column 2 (y)", self.refusal(bad))

    def test_quotes_that_are_not_closed_lose_no_row(self):
        """Quotes around the ends of lines, as of a program that writes \\r\\n into its last column."""
        text = "".join(f'"{i}.5","{i * i % 7}.25","{i % 5}.125\r"\n' for i in range(30))
        self.assertIn("line 2: 1 column found", self.refusal(text))
        rows = read_table(self.file("a.txt", '"x","y","z\r"\n' + text), needed=2)[0]
        self.assertEqual(rows.tolist(), [[i + 0.5, i * i % 7 + 0.25] for i in range(30)])

    def test_progress_is_reported(self):
        seen = []
        path = self.file("a.txt", "1 2 3\n4 5 6\n")
        read_text(path, ReadOptions(progress=seen.append))
        self.assertEqual(seen, [1.0])

    def test_lines_with_more_words_are_noted(self):
        cloud = self.read("1 2 3\n4 5 6\n7 8 9 10\n5 5 5\n")
        self.assertIn("line 3 has 4 columns where others have 3", " ".join(cloud.notes))
        cloud = self.read("1,2,3,4\n4,5,6,4,9\n7,8,9\n5,5,5,1\n")  # as many separators as in even lines
        self.assertIn("line 2 has 5 columns where others have 4", " ".join(cloud.notes))

    def test_a_word_in_quotes_may_be_long(self):
        cloud = self.read(f'x,y,z,outline\n1,2,3,"{"5 7," * 50_000}"\n4,5,6,none\n')
        self.assert_rows(cloud, [(1, 2, 3), (4, 5, 6)])

    def test_an_error_of_lines_of_a_boundary_says_what_helps(self):
        with self.assertRaisesRegex(FileError, "line 1: 2 columns .* have 3; mark it with # if it is no row"):
            read_table(self.file("a.txt", "4,3\n1,2,3\n4,5,6\n7,8,8\n"))

    def test_a_last_line_without_an_end_is_judged_like_others(self):
        self.assert_rows(self.read("Z;X;Y\n3;1;2"), [(1, 2, 3)])

    def test_lines_that_lack_a_word_between_blanks_are_an_error(self):
        rows = [f"{i}.5 {i * i % 7}.25 {i * i % 11}.125 120.5\n" for i in range(1, 41)]
        for head in ("X Y Z Q\n", ""):
            for short in ("6.5 1.25      120.5\n", "6.5 1.25 3.125\n"):
                text = head + "".join([*rows, short, *rows, "1 2 3 4 5\n"])
                error = self.refusal(text)
                self.assertIn(f"line {41 + bool(head)}: 3 columns found where other lines have 4", error)
        error = self.refusal("x y z q c\n1 2 3 4 a\n4 5 7 b\n8 8 8 8 c\n")
        self.assertIn("line 3: 4 columns", error)
        # Text behind the numbers may have fewer words; with other separators a field is empty.
        cloud = self.read("1 2 3 a big stone\n4 5 6 tree\n7 8 8\n")
        self.assertEqual(cloud.points.GetNumberOfPoints(), 3)
        cloud = self.read("x,y,z,q\n1,2,3,4\n4,5,7\n5,5,7,3\n")
        self.assertEqual(cloud.points.GetNumberOfPoints(), 3)

    def test_blank_lines_and_marks_part_lines(self):
        rows, lines, starts, _ = read_table(
            self.file("a.txt", "> a\n0 0 1\n1 0 1\n\n# c\n2 2 1\n> b\n3 3 1\n4 4 1\n"))
        self.assertEqual((len(rows), list(starts)), (5, [0, 2, 3]))
        self.assertEqual(list(lines), [2, 3, 6, 8, 9])


class OtherColumns(Tables):
    def arrays(self, cloud):
        data = cloud.points.GetPointData()
        return {
            data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
            for i in range(data.GetNumberOfArrays())
        }

    def test_other_columns_of_numbers_become_point_arrays(self):
        rows, _ = columns_of("id x y z amp class code")
        text = "Nr,X,Y,Z,Amplitude,Class,What\n" + "".join(",".join(row) + "\n" for row in rows)
        cloud = self.read(text)
        arrays = self.arrays(cloud)
        self.assertEqual(list(arrays), ["Nr", "Amplitude", "Class"])
        self.assertEqual(arrays["Nr"].dtype.kind, "i")
        self.assertEqual(arrays["Class"].tolist(), KINDS["class"].tolist())
        self.assertEqual(arrays["Amplitude"].tolist(), KINDS["amp"].tolist())
        self.assertEqual(arrays["Amplitude"].dtype, numpy.dtype("f8"))
        self.assertIn("left out: What", " ".join(cloud.notes))
        rows, _ = columns_of("x y z int")
        cloud = self.read("".join(" ".join(row) + "\n" for row in rows))
        self.assertEqual(self.arrays(cloud)["column 4"].tolist(), KINDS["int"].tolist())

    def test_colours_become_one_array_of_bytes(self):
        rows, _ = columns_of("x y z r g b")
        for head in ("//X Y Z R G B\n", "x y z red green blue\n", "X Y Z Rot Grün Blau\n"):
            with self.subTest(head):
                arrays = self.arrays(self.read(head + "".join(" ".join(r) + "\n" for r in rows)))
                self.assertEqual(list(arrays), ["RGB"])
                self.assertEqual(arrays["RGB"].dtype, numpy.dtype("u1"))
                expected = numpy.column_stack((KINDS["r"], KINDS["g"], KINDS["b"]))
                self.assertEqual(arrays["RGB"].tolist(), expected.tolist())

    def test_missing_values_and_late_words_are_noted_and_not_a_number(self):
        text = "x,y,z,q\n" + "".join(f"{i},{i * i % 7},1.5,{i}.5\n" for i in range(20000))
        text += "1,2,3,\n4,5,6,odd\n"
        cloud = self.read(text)
        values = self.arrays(cloud)["q"]
        self.assertTrue(math.isnan(values[-1]) and math.isnan(values[-2]))
        self.assertEqual(values[7], 7.5)
        self.assertIn("column q: 1 word is not a number (line 20,003: odd)", cloud.notes)

    def test_empty_rows_are_points_that_are_not_finite_wherever_they_stand(self):
        rows = [f"{i},{i * i % 7},1.5,{i}" for i in range(1, 20)]
        for empty in (",,,", "NA,NA,NA,NA", ",,,7"):
            for place in (0, 1, 9):
                table = rows[:place] + [empty] + rows[place:] + [empty]
                for head in ("x,y,z,q", "a title,,,\nx,y,z,q\nm,m,m,"):
                    cloud = self.read("\n".join([head, *table]) + "\n")
                    first = head.count("\n") + 2
                    self.assertEqual(list(cloud.lines), list(range(first, first + 21)))
                    self.assertEqual(numpy.flatnonzero(numpy.isnan(coordinates_of(cloud.points)[:, 0])).tolist(), [place, 20])
                    self.assertFalse([note for note in cloud.notes if "come again" in note])
        self.assertEqual(len(self.read("x y z\n- - -\n-- -- --\n1 2 3\n4 5 6\n").lines), 2)

    def test_comments_before_a_row_that_lacks_a_value_count_once(self):
        cloud = self.read("# one\nx,y,z\n0,0,\n# two\n1,0,5\n0,1,6\n1,1,7\n")
        self.assertIn("text: separated by commas, 1 header line, 2 comment lines", cloud.notes)

    def test_rows_without_data_take_their_values_along(self):
        cloud = self.read("x y z q\n1 2 3 10\n4 5 -9 20\n6 7 9 30\n", no_data=-9.0)
        self.assertEqual(self.arrays(cloud)["q"].tolist(), [10, 30])
        self.assertEqual(list(cloud.lines), [2, 4])


class LinesOfOtherKinds(Tables):
    def test_they_are_an_error_that_says_how_they_are_left_out(self):
        points = [(452000 + 13.5 * i, 5411000 + i * i % 90, 230.25 + i % 7) for i in range(40)]

        def rows(separator, form="{}"):
            return [separator.join(form.format(v) for v in point) for point in points]

        profiles = rows(" ")
        profiles[0:0], profiles[21:21], profiles[43:] = ["Profile 1"], ["EOD", "Profile 2"], ["EOD"]
        station = [f"{7 + i},{row},GRD" for i, row in enumerate(rows(","))]
        station[3:3], station[9:9], station[30:30] = ["JB,NM16"], ["BS,OP1,BP7"], ["--a word"]
        codes = [f"P{i} {row}" for i, row in enumerate(rows(" "))]
        codes[0:0], codes[12:12], codes[30:30] = ["ST 12.5 1.5"], ["ST 13.5 1.5"], ["08 1 2"]
        for lines, first, left_out in (
            (profiles, "line 22", "line 22 (EOD), line 23 (Profile 2), line 44 (EOD)"),
            (station, "line 4", "line 4 (JB,NM16), line 10 (BS,OP1,BP7), line 31 (--a word)"),
            (codes, "line 13", "line 13 (ST 13.5 1.5), line 31 (08 1 2)"),
            (profiles + ["EOD"] * 50, "line 22", "line 44 (EOD) and 50 more"),
        ):
            text = "\n".join(lines) + "\n"
            error = self.refusal(text)
            self.assertIn(f", {first}: ", error)
            self.assertTrue(error.endswith("; --skip-bad-lines leaves out such lines"), error)
            cloud = self.read(text, skip_bad_lines=True)
            self.assert_rows(cloud, points)
            notes = [note for note in cloud.notes if note.startswith("lines of other kinds are left out: ")]
            self.assertIn(left_out, notes[0])
        text = "x y z q\n" + "".join(f"{row} 1\n" for row in rows(" ")) + "1 b 3 4\n1 2 3\n1 c 3 4\n"
        cloud = self.read(text, skip_bad_lines=True)
        self.assertIn("left out: line 42 (1 b 3 4), line 43 (1 2 3), line 44 (1 c 3 4)", " ".join(cloud.notes))
        self.assertIn("no line is a row", self.refusal(
            "a 1 2 3\nb 2 3 4\n", columns="1,2,3", skip_bad_lines=True))
        with self.assertRaisesRegex(FileError, "no line is a row of x and y$"):
            read_boundary(self.file("b.csv", "x,y,z,0,1,2\n"))
        # A line with a wrong column is not a line of another kind.
        self.assertIn("--columns chooses", self.refusal("1 2 3\n4 5 6\n4 five 6 7\n"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
