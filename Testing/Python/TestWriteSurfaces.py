# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces in every format, read back by other readers than those of the package."""

import json
import os
import struct
import sys
import tempfile
import unittest
from unittest import mock

import numpy
from in_folder import InFolder, draws
from vtkelevationsurface import distance, reconstruct, writing
from vtkelevationsurface.picture import screen_mesh
from vtkelevationsurface.writing import xml_writer
from vtkelevationsurface.clouds import cells_of, make_points
from vtkelevationsurface.passes import corner_flags
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_ID_TYPE
from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance

MIDDLE = (612014.0, 6073983.0, 633.0)


def map_surface(count=400, seed=5):
    """A surface of map coordinates with a point in no triangle, colours and more arrays."""
    random = numpy.random.default_rng(seed)
    xyz = random.uniform(-50, 50, (count, 3)) + MIDDLE
    data = make_points(numpy.concatenate(([(numpy.nan, 0, 0)], xyz)))
    data.SetPolys(cells_of(1 + reconstruct(xyz, fill=False).to_numpy()[1]))
    for name, values in (
        ("RGB", random.integers(0, 256, (count + 1, 3)).astype("u1")),
        ("Filled Error", random.uniform(size=count + 1)),
        ("Line", numpy.arange(count + 1, dtype="i8") + 2**40),
        ("Slope", random.uniform(size=(count + 1, 2)).astype("f4")),
    ):
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    return data


def xyz_of(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def triangles_of(cells):
    return vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, 3)


def array_of(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def run(reader, path):
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


class Formats(InFolder):
    def setUp(self):
        super().setUp()
        self.data = map_surface()
        # What formats without points of no triangle hold.
        self.xyz = xyz_of(self.data)[1:]
        self.triangles = triangles_of(self.data.GetPolys()) - 1

    def written(self, suffix):
        path = self.path("s" + suffix)
        self.notes = writing.write_surface(self.data, path, crs="EPSG:25832")
        return path

    def test_vtk_formats_hold_everything(self):
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

        ids = numpy_to_vtkIdTypeArray(2**40 + numpy.arange(len(self.xyz) + 1), deep=True)
        ids.SetName("Well")
        self.data.GetPointData().AddArray(ids)
        for suffix, reader in (
            (".vtp", vtkXMLPolyDataReader()),
            (".vtu", vtkXMLUnstructuredGridReader()),
        ):
            with self.subTest(suffix=suffix):
                back = run(reader, self.written(suffix))
                numpy.testing.assert_array_equal(xyz_of(back), xyz_of(self.data))
                cells = back.GetPolys() if suffix == ".vtp" else back.GetCells()
                numpy.testing.assert_array_equal(triangles_of(cells), self.triangles + 1)
                for name in ("RGB", "Filled Error", "Line", "Slope", "Well"):
                    a, b = array_of(back, name), array_of(self.data, name)
                    self.assertEqual(a.dtype, b.dtype)
                    kind = back.GetPointData().GetArray(name).GetDataType()
                    self.assertEqual(kind == VTK_ID_TYPE, name == "Well", name)
                    numpy.testing.assert_array_equal(a, b)
                crs = back.GetFieldData().GetAbstractArray("CRS")
                self.assertEqual(crs.GetValue(0), "EPSG:25832")
                self.assertIsNone(self.data.GetFieldData().GetAbstractArray("CRS"))

    def test_arrays_of_many_blocks_are_whole(self):
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

        random = numpy.random.default_rng(0)
        for name, small in (("BLOCK", 1000), ("AT_ONCE", 2)):
            self.addCleanup(setattr, xml_writer, name, getattr(xml_writer, name))
            setattr(xml_writer, name, small)
        for count in (1, 42, 250, 3000, 20001):
            data = make_points(random.uniform(size=(count, 3)))
            data.SetPolys(cells_of(numpy.zeros((1, 3), dtype="i8")))
            path = self.path("many.vtp")
            writing.write_surface(data, path)
            back = run(vtkXMLPolyDataReader(), path)
            numpy.testing.assert_array_equal(xyz_of(back), xyz_of(data))

    def test_ply_holds_doubles_colours_and_arrays(self):
        from vtkmodules.vtkIOPLY import vtkPLYReader

        path = self.written(".ply")
        with open(path, "rb") as stream:
            head, body = stream.read().split(b"end_header\n", 1)
        self.assertIn(b"\ncomment crs EPSG:25832\n", head)
        types = {"double": "<f8", "uchar": "u1", "float": "<f4"}
        properties = [line.split() for line in head.decode().splitlines() if "property" in line][:-1]
        kind = numpy.dtype([(name, types[word]) for _, word, name in properties])
        rows = numpy.frombuffer(body, kind, len(self.xyz))
        numpy.testing.assert_array_equal(numpy.column_stack([rows[c] for c in "xyz"]), self.xyz)
        for name, expected in (
            ("green", array_of(self.data, "RGB")[1:, 1]),
            ("Filled_Error", array_of(self.data, "Filled Error")[1:]),
            ("Line", array_of(self.data, "Line")[1:]),
            ("Slope_1", array_of(self.data, "Slope")[1:, 1]),
        ):
            numpy.testing.assert_array_equal(rows[name], expected)
        back = run(vtkPLYReader(), path)
        numpy.testing.assert_array_equal(triangles_of(back.GetPolys()), self.triangles)
        numpy.testing.assert_array_equal(xyz_of(back), self.xyz.astype("f4"))

    def test_glb_holds_singles_around_an_offset(self):
        from vtkmodules.vtkIOGeometry import vtkGLTFReader

        path = self.written(".glb")
        with open(path, "rb") as stream:
            content = stream.read()
        magic, version, length, text, kind = struct.unpack("<4sIIII", content[:20])
        self.assertEqual((magic, version, length), (b"glTF", 2, len(content)))
        self.assertEqual(kind, 0x4E4F534A)
        head = json.loads(content[20 : 20 + text])
        body = content[28 + text :]
        offset = numpy.array(head["nodes"][1]["translation"])
        self.assertEqual(head["nodes"][1]["extras"]["crs"], "EPSG:25832")
        self.assertIn("written less 612", self.notes[0])
        points = numpy.frombuffer(body, "<f4", self.xyz.size).reshape(-1, 3)
        numpy.testing.assert_array_equal(points, (self.xyz - offset).astype("f4"))
        parts = run(vtkGLTFReader(), path).NewIterator()
        parts.InitTraversal()
        back = parts.GetCurrentDataObject()
        numpy.testing.assert_array_equal(triangles_of(back.GetPolys()), self.triangles)
        x, z, y = xyz_of(back).T  # y is up there
        numpy.testing.assert_allclose(numpy.column_stack((x, -y, z)), self.xyz, atol=0.5)
        light = array_of(back, "COLOR_0")[:, :3].astype("f8")
        light /= 65535 if light.max() > 1 else 1
        seen = numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
        numpy.testing.assert_array_equal(numpy.round(255 * seen), array_of(self.data, "RGB")[1:])

    def test_text_formats_hold_every_digit(self):
        for suffix, point, corner, first in (
            (".obj", "v", "f", 0),
            (".ts", "PVRTX", "TRGL", 1),
        ):
            with self.subTest(suffix=suffix):
                with open(self.written(suffix), encoding="ascii") as stream:
                    rows = [line.split() for line in stream]
                xyz = [[float(w) for w in r[1 + first : 4 + first]] for r in rows if r[:1] == [point]]
                corners = [[int(w) for w in r[1:4]] for r in rows if r[:1] == [corner]]
                numpy.testing.assert_array_equal(xyz, self.xyz)
                numpy.testing.assert_array_equal(numpy.array(corners) - 1, self.triangles)
                if suffix == ".obj":
                    continue
                head = rows[: rows.index(["TFACE"])]
                self.assertIn("PROPERTIES Filled_Error Line Slope_0 Slope_1".split(), head)
                self.assertEqual(rows[-1], ["END"])


class LargeSurfaces(unittest.TestCase):
    """What is done for surfaces of millions of triangles, on smaller ones."""

    def test_the_outline_is_that_of_counted_edges(self):
        random = numpy.random.default_rng(1)
        triangles = reconstruct(random.uniform(size=(2000, 3)), fill=False).to_numpy()[1]
        lattice = numpy.array([(0, 1, 5), (0, 5, 4), (5, 6, 10), (5, 10, 9), (5, 8, 4), (1, 2, 6)])
        for some in (triangles, triangles[random.uniform(size=len(triangles)) > 0.2], lattice):
            edges = numpy.concatenate([some[:, (0, 1)], some[:, (1, 2)], some[:, (2, 0)]])
            pairs, counts = numpy.unique(numpy.sort(edges, axis=1), axis=0, return_counts=True)
            numpy.testing.assert_array_equal(screen_mesh.outline(some), pairs[counts == 1])

    def test_a_coarser_mesh_keeps_outlines_and_area(self):
        random = numpy.random.default_rng(2)
        xyz = random.uniform(size=(30000, 3))
        xyz = xyz[numpy.hypot(xyz[:, 0] - 0.5, xyz[:, 1] - 0.5) > 0.2]
        points, triangles = reconstruct(xyz, maximum_edge_length=0.1, fill=False).to_numpy()
        used = corner_flags(triangles, len(points))
        cells = screen_mesh.Cells(points, numpy.eye(2), used, 50)
        patches = numpy.zeros(len(triangles), dtype=bool)
        patches[points[triangles[:, 0], 0] > 0.8] = True
        mesh = screen_mesh.mesh_for_screen(triangles, patches, cells)
        self.assertLess(len(mesh.triangles), 0.5 * len(triangles))
        for pairs, expected in (
            (mesh.rim, screen_mesh.outline(triangles)),
            (mesh.patches, screen_mesh.outline(triangles[patches])),
        ):
            numpy.testing.assert_array_equal(mesh.ids[pairs], expected)

        def area(corners):
            a, b, c = (points[corners[:, i], :2] for i in range(3))
            return 0.5 * float(numpy.linalg.det(numpy.stack((b - a, c - a), axis=1)).sum())

        self.assertAlmostEqual(area(mesh.ids[mesh.triangles]), area(triangles), places=9)

    def test_patches_that_are_most_of_a_surface_are_not_outlined(self):
        from vtkelevationsurface import picture
        from vtkmodules.vtkCommonDataModel import vtkPolyData

        for ids, expected in (
            ([-1, -1, 0, 3], [False, False, True, True]), ([-1, 2, 0, 3], None), ([], None)
        ):
            surface = vtkPolyData()
            if ids:
                array = numpy_to_vtk(numpy.array(ids), deep=True)
                array.SetName("HoleId")
                surface.GetCellData().AddArray(array)
            flags = picture.patches_to_outline(surface)
            self.assertEqual(flags if flags is None else flags.tolist(), expected)

    def test_distances_are_those_to_all_triangles(self):
        random = numpy.random.default_rng(3)
        xyz = random.uniform(0, 100, (30000, 3))
        xyz[:, 2] = 5 * numpy.sin(xyz[:, 0] / 9)
        result = reconstruct(xyz, fill=False)
        away = xyz[:200] + random.normal(0, 2, (200, 3))
        away[:2] = (-9, 50, 0), (50, 50, 40)
        points, triangles = result.to_numpy()
        self.assertLess(len(away), distance.FEW * len(triangles))
        found = distance.distances(points, corner_flags(triangles, len(points)), triangles, away)
        search = vtkImplicitPolyDataDistance()
        search.SetInput(result.surface)
        expected = [abs(search.EvaluateFunction(point)) for point in away.tolist()]
        numpy.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)

    def test_a_sample_of_many_points_is_measured_and_reported(self):
        xyz = numpy.array([(x, y, 0.0) for x in range(40) for y in range(40)])
        twice = numpy.concatenate((xyz, xyz + (0, 0, 3)))
        result = reconstruct(twice, duplicates="keep-first")
        chosen = numpy.ones(len(twice), dtype=bool)
        most = distance.MOST_MEASURED
        self.addCleanup(setattr, distance, "MOST_MEASURED", most)
        for distance.MOST_MEASURED, measured in ((most, 1600), (1000, 800)):
            measured_values = distance.distance_to(result.complete, result.used, twice, chosen)
            self.assertEqual((measured_values["points"], measured_values["points_not_corners"]), (3200, 1600))
            self.assertEqual((measured_values["measured"], measured_values["maximum"]), (measured, 3.0))
            self.assertAlmostEqual(measured_values["mean"], 1.5)
            self.assertAlmostEqual(measured_values["rms"], 4.5**0.5)

    @draws
    def test_the_picture_of_fewer_triangles_looks_the_same(self):
        from vtkelevationsurface import picture
        from vtkmodules.vtkIOImage import vtkPNGReader

        random = numpy.random.default_rng(6)
        x, y = random.uniform(0, 1000, (2, 60000))
        keep = numpy.hypot(x - 400, y - 500) > 90
        z = 30 * numpy.sin(x / 90) * numpy.cos(y / 120)
        xyz = numpy.column_stack((x, y, z))[keep]
        result = reconstruct(xyz, maximum_edge_length=30)
        images, drawn = [], []
        with tempfile.TemporaryDirectory() as folder:
            for most, pixels in ((10**9, 2.0), (1000, 6.0)):
                with mock.patch.multiple(picture, MOST_TRIANGLES=most, CELL_PIXELS=pixels):
                    path = os.path.join(folder, f"{most}.png")
                    drawn.append(result.plot(path, "waves"))
                    image = run(vtkPNGReader(), path).GetPointData().GetScalars()
                    images.append(vtk_to_numpy(image).astype(int))
        for name, value in drawn[0].items():
            self.assertAlmostEqual(drawn[1][name], value, delta=0.01 * value)
        self.assertEqual(images[0].shape, images[1].shape)
        apart = abs(images[0] - images[1]).max(axis=1)
        self.assertGreater(apart.max(), 0)
        self.assertLess(apart.mean(), 1.5)
        self.assertLess((apart > 60).mean(), 2e-3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
