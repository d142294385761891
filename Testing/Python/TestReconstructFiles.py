# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reading and writing, without the filters."""

import math
import os
import sys
import unittest
from unittest import mock

import numpy
from in_folder import InFolder, coordinates
from vtkelevationsurface import paths, reading, writing
from vtkelevationsurface.reading import vtk_checks, vtk_files
from vtkelevationsurface.clouds import RECOGNISED, line_parts, make_points, words_in
from vtkelevationsurface.messages import FileError, Messages, plain_message
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkUnstructuredGrid

ROWS = [(1.0, 2.0, 3.5), (4.25, 5.0, 6.0), (-7.0, 8.0, 9.0)]


class Text(InFolder):
    def test_every_separator_gives_the_same_points(self):
        for separator in (",", ";", "\t", " ", "   ", ", ", " ; "):
            with self.subTest(separator=separator):
                text = "".join(separator.join(f"{v:g}" for v in row) + "\n" for row in ROWS)
                self.assert_rows(self.read(text), ROWS)

    def test_a_decimal_comma_is_found_out(self):
        for separator in (";", "\t", " "):
            with self.subTest(separator=separator):
                text = "".join(
                    separator.join(f"{v:.2f}".replace(".", ",") for v in row) + "\n" for row in ROWS
                )
                cloud = self.read(text)
                self.assert_rows(cloud, ROWS)
                self.assertIn("decimal comma", cloud.notes[0])

    def test_all_digits_of_large_coordinates_survive(self):
        cloud = self.read("612014.6747884353 6073983.681666553 633.5012316703796\n1 2 3\n")
        self.assertEqual(
            coordinates(cloud)[0].tolist(),
            [612014.6747884353, 6073983.681666553, 633.5012316703796],
        )

    def test_columns_are_found_by_their_names_in_any_order(self):
        for header in ("z,id,y,x", "Elevation,id,Northing,EASTING", "height (m),id,lat,lon"):
            with self.subTest(header=header):
                text = header + "\n" + "".join(f"{z},9,{y},{x}\n" for x, y, z in ROWS)
                self.assert_rows(self.read(text), ROWS)

    def test_columns_without_known_names_are_the_first_three_and_that_is_said(self):
        cloud = self.read("a,b,c,d\n1,2,3,4\n5,6,7,9\n")
        self.assert_rows(cloud, [(1, 2, 3), (5, 6, 7)])
        self.assertTrue(any("first 3 of 4 columns" in note for note in cloud.notes))

    def test_columns_can_be_given_by_number_and_by_name(self):
        text = "# inline crossline u v t\n10 20 1 2 3\n10 21 5 6 7\n"
        for columns in (["3", "4", "5"], ["u", "v", "t"], ["U", "4", "T"]):
            with self.subTest(columns=columns):
                self.assert_rows(self.read(text, columns=columns), [(1, 2, 3), (5, 6, 7)])

    def test_a_wrong_column_is_named(self):
        text = "a,b,c\n1,2,3\n"
        self.assert_refused("no column 4 for z; lines have 3", text, columns=["1", "2", "4"])
        self.assert_refused("no column q for z; lines have 3, named a, b, c", text, columns=["a", "b", "q"])
        self.assert_refused("the file has no header line", "1 2 3\n", columns=["a", "b", "c"])

    def test_header_comment_and_blank_lines_are_skipped_and_counted(self):
        text = "Survey of 1987\n# made by hand\nx y z\n\n1 2 3.5\n% half way\n4.25 5 6\n\n-7 8 9\n"
        cloud = self.read(text)
        self.assert_rows(cloud, ROWS)
        self.assertIn("2 header lines, 2 comment lines", cloud.notes[0])
        self.assertEqual(list(cloud.lines), [5, 7, 9])

    def test_a_word_where_a_number_is_needed_names_file_line_and_column(self):
        self.assert_refused(
            ", line 3: 'two' in column 2 (y) is not a number", "1,2,3\n4,5,6\n7,two,9\n"
        )

    def test_a_first_row_with_one_bad_word_is_not_a_header(self):
        self.assert_refused(", line 1: 'l' in column 1 (x)", "l,2,3\n4,5,6\n7,8,9\n")

    def test_words_in_other_columns_do_no_harm(self):
        self.assert_rows(self.read('1,2,3.5,"rock, hard"\n4.25,5,6,sand\n-7,8,9,\n'), ROWS)

    def test_a_short_row_names_file_line_and_column(self):
        self.assert_refused(", line 2: 2 columns found where other lines have 3", "1 2 3\n4 5\n6 7 8\n")

        self.assert_refused(
            ", line 1: 2 columns found where other lines have 3", "1 2\n3 4 5\n6 7 8\n"
        )

    def test_empty_and_comment_only_files_are_refused(self):
        self.assert_refused("is empty", "")
        self.assert_refused("only blank or comment lines", "# x y z\n\n")

    def test_a_binary_file_is_not_text(self):
        for content in (b"\x00\x01\x02" * 50, b"1 2 \0 3\n4 5 6\n", b"\1\0\2\0" * 60, bytes(range(256)) * 9):
            self.assert_refused("is not a text file; save a table as .csv, in UTF-8", content)

    def test_rows_without_a_value_stay_as_points_that_are_not_finite(self):
        for missing in ("nan", "NaN", "NA", "null", ""):
            with self.subTest(missing=missing):
                cloud = self.read(f"x,y,z\n1,2,3\n4,5,{missing}\n7,8,9\n")
                self.assertEqual(cloud.points.GetNumberOfPoints(), 3)
                self.assertTrue(math.isnan(coordinates(cloud)[1][2]))
                self.assertEqual(cloud.lines[1], 3)

    def test_rows_with_the_no_data_value_are_left_out_and_counted(self):
        cloud = self.read("1 2 3\n4 5 -999\n6 7 8\n", no_data=-999.0)
        self.assert_rows(cloud, [(1, 2, 3), (6, 7, 8)])
        self.assertEqual(cloud.left_out, {"rows without data": 1})
        self.assertEqual(list(cloud.lines), [1, 3])

    def test_other_encodings_are_read(self):
        text = "x y z\n1 2 3.5\n4.25 5 6\n-7 8 9\n"
        for encoding in ("utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-32-le", "utf-32-be"):
            self.assert_rows(self.read(text.encode(encoding)), ROWS)
            self.assert_rows(self.read(("# H\u00f6he, \u03cd\u03c8\u03bf\u03c2\n" + text).encode(encoding)), ROWS)
        self.assert_rows(self.read("# H\u00f6he\n".encode("latin-1") + text.encode()), ROWS)
        self.assert_rows(self.read(b"\xef\xbb\xbf" + text.encode()), ROWS)
        self.assert_rows(self.read(text.replace("\n", "\r\n")), ROWS)


class Paths(InFolder):
    def test_what_cannot_be_opened_is_named(self):
        for name, words in (("no.csv", "no such file"), ("", "is a folder")):
            with self.assertRaises(FileError) as caught:
                reading.read(self.path(name))
            self.assertIn(words, str(caught.exception))
        os.mkdir(self.path("folder.csv"))
        with self.assertRaisesRegex(FileError, "is a folder, not a file"):
            reading.read(self.path("folder.csv"))

    @unittest.skipIf(
        not hasattr(os, "getuid") or os.getuid() == 0, "everything is readable to root"
    )
    def test_a_file_without_permission_is_named(self):
        path = self.file("secret.csv", "1 2 3\n")
        os.chmod(path, 0)
        with self.assertRaisesRegex(FileError, "cannot be read: Permission denied"):
            reading.read(path)


class VtkFormats(InFolder):
    def write(self, writer, data, name):
        writer.SetFileName(self.path(name))
        writer.SetInputData(data)
        self.assertTrue(writer.Write())
        return self.path(name)

    def test_points_of_each_format_are_read(self):
        from vtkmodules.vtkIOGeometry import vtkOBJWriter
        from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
        from vtkmodules.vtkIOPLY import vtkPLYWriter
        from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

        data = make_points(ROWS)
        grid = vtkUnstructuredGrid()
        grid.SetPoints(data.GetPoints())
        mesh = make_points(ROWS)
        cells = vtkCellArray()
        cells.InsertNextCell(3, [0, 1, 2])
        mesh.SetPolys(cells)
        for writer, source, name in (
            (vtkXMLPolyDataWriter(), data, "a.vtp"),
            (vtkXMLUnstructuredGridWriter(), grid, "a.vtu"),
            (vtkPolyDataWriter(), data, "a.vtk"),
            (vtkPLYWriter(), mesh, "a.ply"),
            (vtkOBJWriter(), mesh, "a.obj"),
        ):
            with self.subTest(name=name):
                cloud = reading.read(self.write(writer, source, name))
                self.assert_rows(cloud, ROWS)
                cells_ignored = any("not the file's cells" in note for note in cloud.notes)
                self.assertEqual(cells_ignored, source is mesh)

    def test_no_data_leaves_points_out_and_keeps_the_arrays_of_the_others(self):
        from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

        data = make_points(ROWS)
        array = numpy_to_vtk(numpy.array([10.0, 20.0, 30.0]), deep=True)
        array.SetName("Amplitude")
        data.GetPointData().AddArray(array)
        path = self.write(vtkXMLPolyDataWriter(), data, "a.vtp")
        cloud = reading.read(path, no_data=6.0)
        self.assert_rows(cloud, [ROWS[0], ROWS[2]])
        kept = vtk_to_numpy(cloud.points.GetPointData().GetArray("Amplitude"))
        self.assertEqual(kept.tolist(), [10.0, 30.0])
        self.assertEqual(cloud.left_out, {"points without data": 1})

    def test_an_image_becomes_points_with_its_values_as_elevation(self):
        from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

        image = vtkImageData()
        image.SetDimensions(3, 2, 1)
        image.SetOrigin(100.0, 200.0, 0.0)
        image.SetSpacing(10.0, 5.0, 1.0)
        values = numpy_to_vtk(numpy.array([1.0, 2.0, math.nan, 4.0, 5.0, 6.0]), deep=True)
        values.SetName("Depth")
        image.GetPointData().SetScalars(values)
        cloud = reading.read(self.write(vtkXMLImageDataWriter(), image, "a.vti"))
        self.assert_rows(
            cloud, [(100, 200, 1), (110, 200, 2), (100, 205, 4), (110, 205, 5), (120, 205, 6)]
        )
        self.assertEqual(cloud.left_out, {"pixels without data": 1})
        self.assertIn("elevation: point array Depth", cloud.notes)

    def test_a_damaged_file_gives_one_line_and_nothing_is_printed(self):
        for suffix in (".vtp", ".vtu", ".vtk", ".ply", ".stl", ".vti"):
            with self.subTest(suffix=suffix):
                self.assert_refused("", '<VTKFile type="PolyData"><bro', "a" + suffix)

    def mesh(self):
        """A strip of triangles with odd coordinates, so that a text file has long numbers."""
        data = make_points([(i / 3.0, i % 2, i / 7.0) for i in range(12)])
        cells = vtkCellArray()
        for i in range(10):
            cells.InsertNextCell(3, [i, i + 1, i + 2])
        data.SetPolys(cells)
        array = numpy_to_vtk(numpy.arange(12.0) / 9.0, deep=True)
        array.SetName("Amplitude")
        data.GetPointData().AddArray(array)
        return data

    def whole_files(self):
        """(name, bytes) of the mesh in every format whose reader trusts its header."""
        from vtkmodules.vtkIOGeometry import vtkSTLWriter
        from vtkmodules.vtkIOLegacy import vtkPolyDataWriter, vtkUnstructuredGridWriter
        from vtkmodules.vtkIOPLY import vtkPLYWriter

        mesh = self.mesh()
        grid = vtkUnstructuredGrid()
        grid.SetPoints(mesh.GetPoints())
        grid.SetCells(5, mesh.GetPolys())
        for kind in ("text", "binary"):
            for make, source, suffix in (
                (vtkPLYWriter, mesh, "ply"),
                (vtkSTLWriter, mesh, "stl"),
                (vtkPolyDataWriter, mesh, "vtk"),
                (vtkUnstructuredGridWriter, grid, "vtk"),
            ):
                for version in (42, 51) if suffix == "vtk" else (0,):
                    writer = make()
                    if kind == "binary":
                        writer.SetFileTypeToBinary()
                    else:
                        writer.SetFileTypeToASCII()
                    if version:
                        writer.SetFileVersion(version)
                    path = self.write(writer, source, f"{kind}.{suffix}")
                    with open(path, "rb") as stream:
                        yield f"{kind} {make.__name__} {version}", suffix, stream.read()

    def test_a_file_that_is_cut_off_is_refused_or_has_all_its_points(self):
        # Where nothing but what follows the points is missing, the points are all there. A cut
        # within the last number of a text cannot be distinguished from its end, so this number is not
        # compared, but there is a note.
        for what, suffix, content in self.whole_files():
            path = self.file("cut." + suffix, content)
            expected = coordinates(reading.read(path)).ravel()[:-1].tolist()
            refused = 0
            for size in range(1, len(content), 7):
                with self.subTest(what=what, size=size):
                    path = self.file("cut." + suffix, content[:size])
                    try:
                        cloud = reading.read(path)
                    except FileError:
                        refused += 1
                        continue
                    self.assertEqual(coordinates(cloud).ravel()[:-1].tolist(), expected)
                    if what.startswith("text") and suffix == "vtk":
                        may_lack = any("may be cut off" in note for note in cloud.notes)
                        self.assertEqual(may_lack, not content[size - 1 : size].isspace())
            with self.subTest(what=what):
                # The points of a .ply come before its faces.
                self.assertGreater(refused, (0.7 if suffix == "ply" else 0.9) * len(content) / 7)

    def test_a_grid_of_false_extents_is_refused(self):
        from vtkmodules.vtkCommonDataModel import vtkRectilinearGrid, vtkStructuredGrid
        from vtkmodules.vtkIOXML import (
            vtkXMLImageDataWriter,
            vtkXMLRectilinearGridWriter,
            vtkXMLStructuredGridWriter,
        )

        places = numpy.array([(i % 3, i // 3, 0.5 * i) for i in range(6)])
        image, rectilinear, structured = vtkImageData(), vtkRectilinearGrid(), vtkStructuredGrid()
        for grid in (image, rectilinear, structured):
            grid.SetDimensions(3, 2, 1)
            values = numpy_to_vtk(places[:, 2], deep=True)
            values.SetName("Depth")
            grid.GetPointData().SetScalars(values)
        for name, count in (("X", 3), ("Y", 2), ("Z", 1)):
            along = numpy_to_vtk(numpy.arange(float(count)), deep=True)
            getattr(rectilinear, f"Set{name}Coordinates")(along)
        structured.SetPoints(make_points(places).GetPoints())
        for writer, grid, suffix in (
            (vtkXMLImageDataWriter(), image, ".vti"),
            (vtkXMLRectilinearGridWriter(), rectilinear, ".vtr"),
            (vtkXMLStructuredGridWriter(), structured, ".vts"),
        ):
            for mode in (writer.SetDataModeToAscii, writer.SetDataModeToAppended):
                mode()
                with open(self.write(writer, grid, "whole" + suffix), "rb") as stream:
                    content = stream.read()
                self.assert_rows(self.read(content, "a" + suffix), places.tolist())
                whole, piece = b'WholeExtent="0 2 0 1 0 0"', b'<Piece Extent="0 2 0 1 0 0"'
                self.assertIn(whole, content)
                self.assertIn(piece, content)
                for extent, words in (
                    (b"0 5 0 4 0 0", "has 20 cells, its pieces only 2"),
                    (b"5 7 5 6 0 0", "a piece of extent 0 2 0 1 0 0 is not within"),
                    (b"0 1 0 1 0 0", "is not within the whole extent 0 1 0 1 0 0"),
                    (b"0 2000000000 0 1 0 0", "cannot hold 4,000,000,002 nodes"),
                    (b"2 0 0 1 0 0", "'2 0 0 1 0 0' is not an extent"),
                    (b"0 2 0 1 0", "'0 2 0 1 0' is not an extent"),
                ):
                    with self.subTest(suffix=suffix, mode=mode.__name__, extent=extent):
                        lie = content.replace(whole, b'WholeExtent="' + extent + b'"')
                        self.assert_refused(words, lie, "lie" + suffix)
                with self.subTest(suffix=suffix, mode=mode.__name__):
                    lie = content.replace(piece, b'<Piece Extent="0 1 0 1 0 0"')
                    self.assert_refused("has 2 cells, its pieces only 1", lie, "lie" + suffix)
                    lie = content.replace(piece, b'<Piece Extent="0 9 0 1 0 0"')
                    self.assert_refused("is not within", lie, "lie" + suffix)

    def test_a_header_that_announces_too_much_is_refused(self):
        for what, suffix, content in self.whole_files():
            for old, new in (
                (b"element vertex 12", b"element vertex 999999999999"),
                (b"POINTS 12 ", b"POINTS 999999999999 "),
                (b"POINTS 12 ", b"POINTS -1 "),
                (b"POLYGONS 1", b"POLYGONS 9999999991"),
            ):
                if old in content:
                    with self.subTest(what=what, new=new):
                        self.assert_refused("", content.replace(old, new), "lie." + suffix)

        writing.write_surface(make_points(ROWS), self.path("a.vtp"))
        with open(self.path("a.vtp"), encoding="ascii") as stream:
            text = stream.read()
        self.assertIn('NumberOfPoints="3"', text)
        text = text.replace('NumberOfPoints="3"', 'NumberOfPoints="99999999999999"')
        self.assert_refused("cannot hold 99,999,999,999,999 points", text, "lie.vtp")

    def test_text_in_the_place_of_numbers_is_refused(self):
        for what, suffix, content in self.whole_files():
            if what.startswith("text"):
                with self.subTest(what=what):
                    self.assertIn(b"3.6666", content)
                    self.assert_refused("", content.replace(b"3.6666", b"spoil"), "a." + suffix)

    def test_digits_of_obj_and_stl_text_survive(self):
        rows = [(612014.6747884353, 6073983.681666553, 1.5), (612015.1, 6073984.2, 1e-9), (1, 2, 0.1)]
        obj = "# by hand\no a\n" + "".join("v %r %r %r\n" % row for row in rows)
        self.assert_rows(self.read(obj + "vn 0 0 1\nf 1//1 2//1 3//1\n", "a.obj"), rows)
        data = reading.read_boundary(self.path("a.obj"))
        self.assertEqual(data.GetPoint(0), rows[0])
        facet = "facet normal 0 0 1\nouter loop\n%s\nendloop\nendfacet\n" % "\n".join(
            "vertex %r %r %r" % row for row in rows
        )
        stl = "solid a\n" + 2 * facet + "endsolid a\n"
        self.assert_rows(self.read(stl, "a.stl"), rows)
        for words, name, content in (
            ("line 4: is not a vertex", "b.obj", obj.replace("1e-09", "")[:-20]),
            ("line 4: is not a vertex", "b.obj", obj.replace("612015.1", "spoil")),
            ("cannot be read", "b.stl", stl.replace("612015.1", "spoil")),
            ("damaged after 1 whole facets", "b.stl", stl[:-40]),
            ("holds no points", "b.obj", "# nothing\n"),
        ):
            with self.subTest(words=words, name=name):
                self.assert_refused(words, content, name)

    def test_pieces_far_behind_in_a_grid_are_counted(self):
        piece = (
            '<Piece Extent="%d %d 0 1 0 0"><PointData Scalars="z"><DataArray type="Float64" '
            'Name="z" format="ascii">%s</DataArray></PointData></Piece>'
        )
        text = '<VTKFile type="ImageData"><ImageData WholeExtent="0 2 0 1 0 0" Origin="0 0 0" '
        text += 'Spacing="1 1 1">' + piece % (0, 1, "1 2 4 5") + "<!--" + 2**21 * " " + "-->"
        text += piece % (1, 2, "2 3 5 6") + "</ImageData></VTKFile>"
        points = coordinates(self.read(text, "a.vti"))
        self.assertEqual(points[:, 2].tolist(), [1, 2, 3, 4, 5, 6])

    def test_a_binary_stl_is_known_whatever_its_header_says(self):
        content = next(c for what, _, c in self.whole_files() if "binary vtkSTL" in what)
        content = b"solid made by hand".ljust(80) + content[80:]
        self.assertEqual(self.read(content, "a.stl").points.GetNumberOfPoints(), 12)
        self.assert_refused("10 facets are announced", content[:-50], "b.stl")

    def test_what_crashes_a_reader_is_an_error_also_in_a_program(self):
        # Made of whole files: corners that are not there, ids that are cut off, text for counts.
        for what, suffix, content in self.whole_files():
            for old, new in ((b"POLYGONS 10 ", b"POLYGONS 99 "), (b"CELLS 11 ", b"CELLS 99 ")):
                if old in content:
                    with self.subTest(what=what):
                        self.assert_refused("", content.replace(old, new), "lie." + suffix)
        with mock.patch.object(vtk_checks, "check"):
            with mock.patch.object(vtk_files, "check"):
                content = next(c for w, s, c in self.whole_files() if w.startswith("text vtkPolyData"))
                # Older VTKs crash on it.
                self.assert_refused("", content[:440], "crash.vtk")
                with mock.patch.object(vtk_files, "survives", lambda *_: False):
                    self.assert_refused("reader crashes on it", content, "crash.vtk")

    def test_cells_with_corners_that_are_not_there_are_refused(self):
        text = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
        text += "0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 77\n"
        self.assert_refused("a cell has the corner 77, but there are 3 points", text, "a.vtk")
        with self.assertRaisesRegex(FileError, "corner 77"):
            reading.read_boundary(self.path("a.vtk"))
        self.assert_refused(
            "a cell has the corner -1, but there are 3 points", text.replace("77", "-1"), "b.vtk"
        )



class Breaklines(InFolder):
    def test_text_lines_stay_open_and_apart(self):
        data = reading.read_faults(self.file("b.txt", "0 0 1\n10 0 2\n\n2 2 3\n4 2 4\n4 4 5\n"))
        self.assertEqual(data.GetNumberOfLines(), 2)
        self.assertEqual(data.GetNumberOfPoints(), 5)
        line = data.GetCell(1).GetPointIds()
        self.assertEqual([line.GetId(i) for i in range(line.GetNumberOfIds())], [2, 3, 4])
        self.assertEqual(data.GetPoint(4), (4.0, 4.0, 5.0))

    def test_what_holds_no_lines_is_refused(self):
        writing.write_surface(make_points(ROWS), self.path("b.vtp"))
        with self.assertRaisesRegex(FileError, "no line and no polygon that could be a fault"):
            reading.read_faults(self.path("b.vtp"))
        with self.assertRaisesRegex(FileError, "line 2: a point of a fault is not finite"):
            reading.read_faults(self.file("b.txt", "0 0 1\n1 nan 0\n"))


class Boundary(InFolder):
    RING = "0 0\n10 0\n10 10\n0 10\n0 0\n"

    def test_closed_text_rings_become_closed_lines(self):
        data = reading.read_boundary(self.file("b.txt", self.RING + "\n2 2\n4 2\n4 4\n2 2\n"))
        self.assertEqual(data.GetNumberOfLines(), 2)
        self.assertEqual(data.GetNumberOfPoints(), 7)
        line = data.GetCell(1).GetPointIds()
        self.assertEqual(line.GetId(0), line.GetId(line.GetNumberOfIds() - 1))

    def test_a_third_column_of_text_is_z(self):
        for rows, z in (
            ("0 0 7\n10 0 8\n10 10 9\n0 0 7\n", [7, 8, 9]),
            ("0 0 7\n10 0 nan\n10 10 9\n0 0 7\n", [7, numpy.nan, 9]),
            ("0 0 a\n10 0 b\n10 10 c\n0 0 a\n", [0, 0, 0]),
            ("0 0\n10 0\n10 10\n0 0\n", [0, 0, 0]),
        ):
            data = reading.read_boundary(self.file("b.txt", rows))
            numpy.testing.assert_array_equal([data.GetPoint(i)[2] for i in range(3)], z)

    def test_notes_say_how_it_was_read(self):
        for read in (reading.read_boundary, reading.read_faults):
            lines = read(self.file("b.gmt", "name,northing,easting\na,0,0\na,0,10\na,10,10\na,0,0\n"))
            notes = words_in(lines.GetFieldData(), RECOGNISED)
            for words in ("by its content this is a text table, not a vector file", "text: separated by commas",
                          "columns by their names: x = 3 (easting), y = 2 (northing)"):
                self.assertIn(words, " | ".join(notes))
            self.assertNotIn("--", " | ".join(notes))  # options are for points

    def test_rings_are_named_by_their_lines(self):
        data = reading.read_boundary(self.file("b.txt", self.RING + "\n2 2\n4 2\n4 4\n"))
        names, parts = line_parts(data)
        self.assertEqual(names, ["the part from line 1 to 5", "the part from line 7 to 9"])
        self.assertEqual([len(part) for part in parts], [5, 3])

    def test_a_boundary_point_that_is_not_finite_names_its_line(self):
        with self.assertRaisesRegex(FileError, "line 2: a boundary point is not finite"):
            reading.read_boundary(self.file("b.txt", "0 0\nnan 0\n10 10\n0 0\n"))

    def test_a_file_without_lines_is_refused(self):
        data = make_points(ROWS)
        writing.write_surface(data, self.path("b.vtp"))
        with self.assertRaisesRegex(FileError, "no line and no polygon"):
            reading.read_boundary(self.path("b.vtp"))


class Writing(InFolder):
    MAP = [
        (612014.25, 6073983.5, 633.5),
        (612015.25, 6073983.5, 634.0),
        (612014.75, 6073984.625, 635.0),
    ]

    def triangle(self):
        data = make_points(self.MAP)
        cells = vtkCellArray()
        cells.InsertNextCell(3, [0, 1, 2])
        data.SetPolys(cells)
        return data

    def test_large_coordinates_make_stl_text(self):
        path = self.path("s.stl")
        notes = writing.write_surface(self.triangle(), path)
        self.assertIn("written as text", notes[0])
        with open(path, encoding="ascii") as stream:
            text = stream.read()
        self.assertIn("612014.25", text)
        self.assertIn("6073984.625", text)

    def test_a_folder_that_is_not_there_is_refused_before_any_work(self):
        with self.assertRaisesRegex(FileError, "there is no folder"):
            paths.check_writable(self.path("no/s.vtp"))
        with self.assertRaisesRegex(FileError, "is a folder"):
            paths.check_writable(self.folder)


class VtkMessages(unittest.TestCase):
    def test_the_words_are_kept_and_the_rest_is_not(self):
        text = "ERROR: In ./IO/f.cxx, line 12\nvtkThing (0x1f08): It broke\nat line 3\n\n"
        self.assertEqual(plain_message(text), "It broke at line 3")

    def test_reports_are_collected_and_the_window_is_given_back(self):
        from vtkmodules.vtkCommonCore import vtkOutputWindow

        before = vtkOutputWindow.GetInstance().GetDisplayMode()
        with Messages() as messages:
            vtkOutputWindow.GetInstance().DisplayErrorText("vtkThing (0x1): wrong")
            vtkOutputWindow.GetInstance().DisplayWarningText("vtkThing (0x1): odd")
        self.assertEqual((messages.errors, messages.warnings), (["wrong"], ["odd"]))
        self.assertEqual(vtkOutputWindow.GetInstance().GetDisplayMode(), before)


if __name__ == "__main__":
    vtkObject.GlobalWarningDisplayOn()
    unittest.main(argv=sys.argv[:1])
