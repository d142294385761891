# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""PLY files: every coding and type, all digits, elements in any order, damage."""

import struct
import sys
import unittest

import numpy
from in_folder import InFolder, coordinates
from vtkmodules.util.numpy_support import vtk_to_numpy

CODINGS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
CODES = {"float": "f4", "double": "f8", "int": "i4", "uchar": "u1", "short": "i2", "ushort": "u2"}
MAP = numpy.array(
    [
        (612014.6747884353, 6073983.681666553, 633.5012316703796),
        (612015.1234567891, 6073984.987654321, -1.0 / 3.0),
        (612016.9999999999, 6073985.000000001, 1e-300),
        (612017.25, 6073986.5, 9999.125),
    ]
)


def ply(coding, *elements):
    """elements: (name, [(type, name)], rows) or (name, "list uchar int vertex_indices", lists)."""
    head, body = f"ply\nformat {coding} 1.0\ncomment made by hand\n", b""
    order = CODINGS[coding]
    for name, properties, rows in elements:
        head += f"element {name} {len(rows)}\n"
        if isinstance(properties, str):
            head += f"property {properties}\n"
            for ids in rows:
                text = " ".join(map(str, (len(ids), *ids))) + "\n"
                packed = order and struct.pack(f"{order}B{len(ids)}i", len(ids), *ids)
                body += packed or text.encode()
            continue
        head += "".join(f"property {kind} {name}\n" for kind, name in properties)
        for row in rows:
            values = [
                int(value) if CODES[kind][0] != "f" else float(value)
                for value, (kind, _) in zip(row, properties)
            ]
            if order:
                for value, (kind, _) in zip(values, properties):
                    body += numpy.array(value, order + CODES[kind]).tobytes()
            else:
                body += (" ".join(map(repr, values)) + "\n").encode()
    return head.encode() + b"end_header\n" + body


def xyz(kind):
    return [(kind, axis) for axis in "xyz"]


class Ply(InFolder):
    def test_doubles_keep_every_digit_in_every_coding(self):
        for coding in CODINGS:
            with self.subTest(coding=coding):
                content = ply(coding, ("vertex", xyz("double"), MAP))
                self.assert_rows(self.read(content, "a.ply"), MAP)

    def test_every_type_of_number_is_read_and_others_than_coordinates_become_arrays(self):
        properties = [
            ("uchar", "red"),
            ("double", "y"),
            ("short", "class"),
            ("uchar", "green"),
            ("float", "x"),
            ("uchar", "blue"),
            ("int", "z"),
            ("float", "nx"),
        ]
        rows = [(255, 2.5, -7, 1, 0.1, 2, 30, 0.25), (0, 3.5, 300, 4, 0.2, 5, 31, -1.5)]
        for coding in CODINGS:
            with self.subTest(coding=coding):
                cloud = self.read(ply(coding, ("vertex", properties, rows)), "a.ply")
                x = numpy.float32([0.1, 0.2]).astype("f8")
                expected = numpy.column_stack((x, (2.5, 3.5), (30, 31)))
                if coding == "ascii":
                    numpy.testing.assert_allclose(coordinates(cloud), expected, rtol=1e-7)
                else:
                    self.assert_rows(cloud, expected)
                arrays = cloud.points.GetPointData()
                names = [arrays.GetArrayName(i) for i in range(arrays.GetNumberOfArrays())]
                self.assertEqual(sorted(names), ["RGB", "class", "nx"])
                colours = vtk_to_numpy(arrays.GetArray("RGB"))
                self.assertEqual(colours.tolist(), [[255, 1, 2], [0, 4, 5]])
                self.assertEqual(colours.dtype, numpy.uint8)
                self.assertEqual(vtk_to_numpy(arrays.GetArray("class")).tolist(), [-7, 300])
                self.assertEqual(vtk_to_numpy(arrays.GetArray("nx")).tolist(), [0.25, -1.5])

    def test_vertices_are_found_behind_other_elements_and_their_lists(self):
        camera = ("camera", [("float", "f"), ("uchar", "on")], [(1.5, 1), (2.5, 0)])
        faces = ("face", "list uchar int vertex_indices", [[0, 1, 2], [1, 2, 3, 0], [2], []])
        vertex = ("vertex", xyz("double"), MAP)
        for coding in CODINGS:
            for order in ([camera, faces, vertex], [vertex, faces], [faces, vertex, camera]):
                with self.subTest(coding=coding, order=[element[0] for element in order]):
                    cloud = self.read(ply(coding, *order), "a.ply")
                    self.assert_rows(cloud, MAP)
                    self.assertIn("only the points are used, not the file's cells", cloud.notes)
                    self.assertFalse(any("cut off" in note for note in cloud.notes))

    def test_vertices_are_found_behind_rows_of_numbers_and_lists(self):
        properties = "property uchar flag\nproperty list uchar int vertex_indices\nproperty float a"
        rows = [(7, (0, 1, 2), 0.5), (8, (1, 2, 3, 0), 1.5), (9, (), 2.5)]
        for coding, order in CODINGS.items():
            with self.subTest(coding=coding):
                body = b""
                for flag, ids, area in rows:
                    words = (flag, len(ids), *ids, area)
                    text = " ".join(map(str, words)) + "\n"
                    packed = order and struct.pack(f"{order}BB{len(ids)}if", *words)
                    body += packed or text.encode()
                head, points = ply(coding, ("vertex", xyz("double"), MAP)).split(b"element", 1)
                points, coordinates = points.split(b"end_header\n")
                head += f"element face {len(rows)}\n{properties}\nelement".encode() + points
                content = head + b"end_header\n" + body + coordinates
                self.assert_rows(self.read(content, "a.ply"), MAP)

    def test_a_cut_in_what_follows_the_vertices_is_noted(self):
        faces = ("face", "list uchar int vertex_indices", [[0, 1, 2], [1, 2, 3]] * 20)
        for coding in CODINGS:
            with self.subTest(coding=coding):
                content = ply(coding, ("vertex", xyz("double"), MAP), faces)
                of_faces = 40 * (8 if coding == "ascii" else 13)
                cloud = self.read(content[: 16 - of_faces], "a.ply")
                self.assert_rows(cloud, MAP)
                self.assertTrue(any("cut off behind its vertices" in note for note in cloud.notes))

    def test_floats_too_coarse_for_map_coordinates_are_noted(self):
        rows = [(612014.5 + i % 10, 6073983.5 + i // 10, 0.0) for i in range(100)]
        notes = self.read(ply("ascii", ("vertex", xyz("float"), rows)), "a.ply").notes
        self.assertTrue(any("single precision" in note for note in notes))
        notes = self.read(ply("ascii", ("vertex", xyz("double"), rows)), "a.ply").notes
        self.assertFalse(any("single precision" in note for note in notes))

    def test_damaged_files_are_refused_in_one_line(self):
        text = ply("ascii", ("vertex", xyz("double"), MAP)).decode()
        binary = ply("binary_little_endian", ("vertex", xyz("double"), MAP))
        faces = ("face", "list uchar int vertex_indices", [[0, 1, 2], [1, 2, 3]])
        behind = ply("binary_big_endian", faces, ("vertex", xyz("double"), MAP))
        for words, content in (
            ("its header has no end", text[:60]),
            ("its header has no end", text.split("end_header")[0]),
            ("line 4: 'element vertex q' means nothing", text.replace("vertex 4", "vertex q")),
            ("line 5: 'property real x' means nothing", text.replace("double x", "real x")),
            ("names no format", text.replace("format ascii 1.0", "comment")),
            ("line 2: 'format utf8 1.0' means", text.replace("format ascii", "format utf8")),
            ("no vertices with x, y and z", text.replace("double z", "double h")),
            ("no vertices with x, y and z", text.replace("element vertex", "element point")),
            ("property twice", text.replace("double z", "double z\nproperty double z")),
            ("holds no points", text.replace("vertex 4", "vertex 0")),
            ("4 vertices are announced, 2 found", "\n".join(text.split("\n")[:10]) + "\n"),
            ("999,999,999,999 vertices are", text.replace("vertex 4", "vertex 999999999999")),
            (", line 10: is not a vertex", text.replace("612015.1", "spoil")),
            (", line 9: is not a vertex", text.replace("612014.6747884353 ", "")),
            ("4 vertices are announced, 3 found", binary[:-1]),
            ("is cut off", behind[: behind.index(b"end_header\n") + 20]),
            ("lists among its vertices", text.replace("double z", "list uchar int a")[:-1]),
        ):
            with self.subTest(words=words):
                content = content if isinstance(content, bytes) else content.encode()
                if "lists among" in words:
                    content = content.replace(b"double y", b"double z\nproperty double y")
                self.assert_refused(words, content, "a.ply")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
