# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Heights of a surface at places, and volumes between surfaces."""

import json
import math
import os
import sys
import unittest

import numpy
from in_folder import Program
from vtkelevationsurface import ElevationSurfaceError, read, reconstruct
from vtkelevationsurface.clouds import cells_of
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData


def square(count=3000, low=0.0, high=10.0, seed=1, height=None):
    """Random points of a square with its corners; z is height(x, y)."""
    random = numpy.random.default_rng(seed)
    xy = random.uniform(low, high, (count, 2))
    xy = numpy.concatenate((xy, [(low, low), (high, low), (high, high), (low, high)]))
    height = height or (lambda x, y: 100.0 + numpy.sin(x) * numpy.cos(y))
    return numpy.column_stack((xy, height(*xy.T)))


def surface_of(points):
    return reconstruct(points, trim=False, fill=False)


class Elevations(unittest.TestCase):
    def test_at_points_are_their_z(self):
        points = square()
        for method in ("linear", "natural-neighbor"):
            z = surface_of(points).elevation_at(points[:, :2], method)
            self.assertTrue((z == points[:, 2]).all())

    def test_outside_are_none(self):
        result = surface_of(square())
        for method in ("linear", "natural-neighbor"):
            z = result.elevation_at([(5.0, 5.0), (11.0, 5.0), (math.nan, 1.0), (math.inf, 2.0)], method)
            self.assertEqual(numpy.isnan(z).tolist(), [False, True, True, True])

    def test_in_open_holes_are_none(self):
        points = square()
        points = points[numpy.hypot(points[:, 0] - 5, points[:, 1] - 5) > 2]
        for method in ("linear", "natural-neighbor"):
            result = reconstruct(points, trim=False, maximum_edge_length=1.0, maximum_hole_size=0.5)
            self.assertTrue(numpy.isnan(result.elevation_at((5.0, 5.0), method)[0]))

    def test_of_natural_neighbors_have_no_kink_at_edges(self):
        result = surface_of(square(300))
        xyz, triangles = result.to_numpy()
        xyz = xyz[:, :2]
        ends = numpy.unique(numpy.sort(triangles[:, (0, 1, 1, 2, 2, 0)].reshape(-1, 2), axis=1), axis=0)
        middle, along = xyz[ends].mean(axis=1), xyz[ends[:, 1]] - xyz[ends[:, 0]]
        across = 1e-5 * numpy.column_stack((-along[:, 1], along[:, 0]))
        inside = (abs(middle - 5) < 3.5).all(axis=1)
        kinks = []
        for method in ("linear", "natural-neighbor"):
            at = [result.elevation_at(middle[inside] + step * across[inside], method) for step in (-1, 0, 1)]
            kinks.append(numpy.median(abs(at[0] - 2 * at[1] + at[2])))
        self.assertLess(kinks[1], 1e-3 * kinks[0])

    def test_are_those_of_a_grid(self):
        result = surface_of(square())
        for method in ("linear", "natural-neighbor"):
            grid = result.to_grid(0.25, method=method)
            x, y = numpy.meshgrid(grid.x, grid.y)
            z = result.elevation_at(numpy.column_stack((x.ravel(), y.ravel())), method)
            numpy.testing.assert_allclose(grid.z.ravel(), z, rtol=0, atol=1e-11)

    def test_come_with_errors_where_a_hole_was_filled(self):
        points = square()
        points = points[numpy.hypot(points[:, 0] - 5, points[:, 1] - 5) > 2]
        result = reconstruct(points, trim=False, open_edge_length=1.0)
        z, errors = result.elevation_at([(5.0, 5.0), (1.0, 1.0)], return_errors=True)
        self.assertTrue(numpy.isfinite(z).all())
        self.assertGreater(errors[0], 0.0)
        self.assertEqual(errors[1], 0.0)
        self.assertIsNone(surface_of(square(50)).elevation_at((5.0, 5.0), return_errors=True)[1])

    def test_wrong_arguments_are_named(self):
        result = surface_of(square(50))
        with self.assertRaisesRegex(ValueError, "xy: rows of x and y are needed; the shape is 4 x 1"):
            result.elevation_at(numpy.zeros((4, 1)))
        with self.assertRaisesRegex(ValueError, "method takes linear or natural-neighbor, not 'cubic'"):
            result.elevation_at((1.0, 1.0), "cubic")
        for wrong in ("here", [["a", "b"]], [[True, False]], [[1j, 2]]):
            with self.assertRaisesRegex(ValueError, "xy: rows of x and y are needed, as numbers"):
                result.elevation_at(wrong)
        self.assertEqual(len(result.elevation_at([])), 0)
        masked = numpy.ma.array([[5.0, 5.0], [5.0, 5.0]], mask=[[True, False], [False, False]])
        self.assertEqual(numpy.isnan(result.elevation_at(masked)).tolist(), [True, False])
        steep = reconstruct(square(200)[:, (0, 2, 1)], plane="best")
        with self.assertRaisesRegex(ElevationSurfaceError, "plane=best has no elevation"):
            steep.elevation_at((1.0, 1.0))


class Volumes(unittest.TestCase):
    def test_above_a_shifted_surface_is_the_shift(self):
        points = square()
        lower = points - (0, 0, 0.25)
        volume = surface_of(points).volume_above(surface_of(lower))
        self.assertAlmostEqual(volume.above, 25.0, delta=1e-11)
        self.assertEqual(volume.below, 0.0)
        self.assertAlmostEqual(volume.area, 100.0, delta=1e-11)
        self.assertLess(volume.left_out + volume.other_left_out, 1e-10)
        self.assertIsNone(volume.error)
        whole = reconstruct(points)
        self.assertIsNone(whole.volume_above(whole).error)

    def test_of_other_points_over_the_common_area(self):
        result = surface_of(square(height=lambda x, y: 2 * x + y))
        other = surface_of(square(2000, 5.0, 15.0, 2, lambda x, y: x + y + 6))
        volume = result.volume_above(other)
        # x - 6 over [5, 10] x [5, 10]
        self.assertAlmostEqual(volume.above, 5 * 8.0, delta=1e-10)
        self.assertAlmostEqual(volume.below, 5 * 0.5, delta=1e-10)
        self.assertAlmostEqual(volume.net, 37.5, delta=1e-10)
        self.assertAlmostEqual(volume.area, 25.0, delta=1e-11)
        self.assertAlmostEqual(volume.left_out, 75.0, delta=1e-10)
        self.assertAlmostEqual(volume.other_left_out, 75.0, delta=1e-10)

    def test_above_a_level(self):
        volume = surface_of(square(height=lambda x, y: x - 4)).volume_above(0)
        self.assertAlmostEqual(volume.above, 180.0, delta=1e-10)
        self.assertAlmostEqual(volume.below, 80.0, delta=1e-10)
        self.assertEqual(volume.other_left_out, 0.0)

    def test_errors_of_holes_are_independent(self):
        points = square(6000)
        for x, y in ((3, 3), (7, 7)):
            points = points[numpy.hypot(points[:, 0] - x, points[:, 1] - y) > 1]
        result = reconstruct(points, trim=False, open_edge_length=0.7)
        self.assertEqual(result.hole_counts, (2, 2))
        errors = vtk_to_numpy(result.surface.GetPointData().GetArray("FilledError"))
        holes = vtk_to_numpy(result.surface.GetCellData().GetArray("HoleId"))
        xyz, triangles = result.to_numpy()
        u, v = xyz[triangles[:, 1]] - xyz[triangles[:, 0]], xyz[triangles[:, 2]] - xyz[triangles[:, 0]]
        areas = 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
        of_holes = [(areas * errors[triangles].mean(axis=1))[holes == hole].sum() for hole in range(2)]
        volume = result.volume_above(0.0)
        self.assertAlmostEqual(volume.error, math.hypot(*of_holes), delta=1e-9 * volume.error)
        # The errors of both surfaces count.
        twice = result.volume_above(result)
        self.assertAlmostEqual(twice.error, math.sqrt(2) * volume.error, delta=1e-9 * volume.error)

    def test_the_map_has_the_difference(self):
        result = surface_of(square(height=lambda x, y: 2 * x + y))
        other = surface_of(square(2000, 5.0, 15.0, 2, lambda x, y: x + y + 6))
        difference = result.difference(other)
        xyz = vtk_to_numpy(difference.GetPoints().GetData())
        numpy.testing.assert_allclose(xyz[:, 2], xyz[:, 0] - 6, atol=1e-10)
        self.assertTrue((vtk_to_numpy(difference.GetPointData().GetArray("Difference")) == xyz[:, 2]).all())

    def test_wrong_others_are_named(self):
        result = surface_of(square(50))
        with self.assertRaisesRegex(ElevationSurfaceError, "do not overlap: the other surface is from x 20 to 30.*same coord"):
            result.volume_above(surface_of(square(50, 20.0, 30.0)))
        with self.assertRaisesRegex(ElevationSurfaceError, "has no triangles"):
            result.volume_above(vtkPolyData())
        twice = surface_of(square(50)).surface
        polys, both = twice.GetPolys(), vtk_to_numpy(twice.GetPolys().GetConnectivityArray())
        polys = cells_of(numpy.concatenate((both, both)).reshape(-1, 3))
        twice.SetPolys(polys)
        with self.assertRaisesRegex(ElevationSurfaceError, "the other surface has triangles that overlap"):
            result.volume_above(twice)
        for wrong, name in (([1, 2], "list"), (True, "bool")):
            with self.assertRaisesRegex(TypeError, "a file or a level is needed, not " + name):
                result.volume_above(wrong)
        steep = reconstruct(square(200)[:, (0, 2, 1)], plane="best")
        with self.assertRaisesRegex(ElevationSurfaceError, "plane=best has no volume"):
            result.volume_above(steep)
        with self.assertRaisesRegex(ValueError, "a level is a finite number, not nan"):
            result.volume_above(math.nan)


class Files(Program):
    def setUp(self):
        super().setUp()
        numpy.savetxt(self.path("ground.csv"), square(500), "%.17g", ",", header="x,y,z", comments="")

    def run_on_ground(self, *options):
        done = self.call("ground.csv", "--no-picture", "--report", "r.json", *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout, self.json("r.json")

    def test_elevations_at_the_points_of_a_file(self):
        self.file("places.csv", "id,x,y\n1,5,5\n2,12,5\n3,1.5,2.5\n")
        for method in ("linear", "natural-neighbor"):
            output, report = self.run_on_ground("--at", "places.csv", "--method", method)
            with open(self.path("ground_at.csv"), encoding="utf-8") as stream:
                rows = [line.strip().split(",") for line in stream]
            self.assertEqual(rows[0][:3], ["x", "y", "z"])
            result = reconstruct(read(self.path("ground.csv")))
            z = result.elevation_at([(5, 5), (1.5, 2.5)], method)
            self.assertEqual([float(rows[1][2]), float(rows[3][2])], z.tolist())
            self.assertEqual(rows[2][:3], ["12.0", "5.0", ""])
            self.assertEqual(report["elevations_at"], {"file": "places.csv", "places": 3, "outside": 1})
            self.assertIn("at 3 places of places.csv, 1 outside", output)

    def test_each_row_of_the_file_has_one_in_the_table(self):
        self.file("ring.csv", "x,y\n2,2\n8,2\n8,8\n2,2\n\n3,3\n")
        self.run_on_ground("--at", "ring.csv")
        with open(self.path("ground_at.csv"), encoding="utf-8") as stream:
            rows = [line.split(",")[:2] for line in stream]
        self.assertEqual(rows[1:], [["2.0", "2.0"], ["8.0", "2.0"], ["8.0", "8.0"], ["2.0", "2.0"], ["3.0", "3.0"]])

    def test_each_point_of_a_cloud_has_a_row_whatever_its_z_is(self):
        places = numpy.array([(2, 2, 1), (8, 2, -9999), (8, 8, 1), (3, 4, numpy.nan), (0, 0, 0)], "f8")
        numpy.save(self.path("places.npy"), places)
        box = [(x, y, z) for z in (0, 1) for x, y in ((2, 2), (8, 2), (8, 8), (2, 8))]
        faces = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
        self.file("box.obj", "".join(f"v {x} {y} {z}\n" for x, y, z in box) + faces)
        for name, there in (("places.npy", places), ("box.obj", numpy.array(box))):
            self.run_on_ground("--at", name)
            table = numpy.genfromtxt(self.path("ground_at.csv"), delimiter=",", names=True)
            self.assertEqual(numpy.column_stack((table["x"], table["y"])).tolist(), there[:, :2].tolist())

    def test_pixels_without_data_are_no_places_and_a_note_counts_them(self):
        head = "ncols 3\nnrows 2\nxllcorner 2\nyllcorner 2\ncellsize 1\nNODATA_value -1\n"
        self.file("dem.asc", head + "1 2 -1\n4 5 6\n")
        output, report = self.run_on_ground("--at", "dem.asc")
        self.assertIn("dem.asc: 1 pixel without data left out", output)
        self.assertEqual(report["elevations_at"]["places"], 5)

    def test_notes_say_which_columns_are_the_places(self):
        rows = [f"{i + 1} {y} {x}" for i, (x, y) in enumerate((500000 + i * i, 5400000 + 7 * i) for i in range(20))]
        self.file("places.txt", "\n".join(rows))
        output, _ = self.run_on_ground("--at", "places.txt")
        self.assertIn("places.txt: text: separated by blanks", output)
        self.assertIn("column 1 is an id: it counts up by one; x = 2, y = 3", output)
        self.assertIn("places.txt: x is as large as a northing and y as an easting of UTM", output)

    def test_two_numbers_with_decimal_commas_are_a_place(self):
        self.file("comma.csv", "x;y\n2,5;3,25\n8,125;2,0\n")
        self.run_on_ground("--at", "comma.csv")
        with open(self.path("ground_at.csv"), encoding="utf-8") as stream:
            rows = [line.split(",")[:2] for line in stream]
        self.assertEqual(rows[1:], [["2.5", "3.25"], ["8.125", "2.0"]])

    def test_places_need_no_z_and_are_reprojected(self):
        from osgeo import ogr, osr

        random = numpy.random.RandomState(1)
        degrees = numpy.array((11.0, 48.0)) + 0.02 * random.rand(900, 2)
        rows = numpy.column_stack((degrees, 500 + 30 * numpy.sin(degrees[:, 0] * 600)))
        numpy.savetxt(self.path("degrees.csv"), rows, "%.9f", ",", header="lon,lat,z", comments="")
        inner = degrees[numpy.hypot(*(degrees - (11.01, 48.01)).T) < 0.008]
        systems = []
        for code in (4326, 32632):
            systems.append(osr.SpatialReference())
            systems[-1].ImportFromEPSG(code)
            systems[-1].SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        metres = numpy.array(osr.CoordinateTransformation(*systems).TransformPoints(inner.tolist()))[:, :2]
        for name, system, places in (("deg.gpkg", systems[0], inner), ("utm.gpkg", systems[1], metres)):
            layer_of = ogr.GetDriverByName("GPKG").CreateDataSource(self.path(name))
            layer = layer_of.CreateLayer("p", system, ogr.wkbPoint)
            for place in places.tolist():
                feature, point = ogr.Feature(layer.GetLayerDefn()), ogr.Geometry(ogr.wkbPoint)
                point.AddPoint_2D(*place)
                feature.SetGeometry(point)
                layer.CreateFeature(feature)
            del layer, layer_of
        numpy.savetxt(self.path("deg.csv"), inner, "%.9f", ",", header="x,y", comments="")
        found = {}
        for name, options, places, is_moved in (
            ("deg.gpkg", ("--project",), inner, True), ("utm.gpkg", ("--project",), metres, False),
            ("deg.csv", ("--project",), inner, True), ("utm.gpkg", ("--crs", "EPSG:4326"), metres, True),
            ("deg.gpkg", ("--crs", "EPSG:4326"), inner, False), ("deg.csv", (), inner, False),
        ):
            with self.subTest(name=name, options=options):
                done = self.call("degrees.csv", *options, "--at", name, "--no-picture")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertIn(f"at {len(inner)} places of {name}, 0 outside", done.stdout)
                self.assertEqual(f"{name} is in" in done.stdout, is_moved)
                table = numpy.genfromtxt(self.path("degrees_at.csv"), delimiter=",", names=True)
                numpy.testing.assert_allclose(numpy.column_stack((table["x"], table["y"])), places, atol=1e-7)
                found[name, options] = table["z"]
                os.remove(self.path("degrees_at.csv"))
        self.assertEqual(len(found), 6)
        for z in found.values():  # the triangles are others in degrees
            numpy.testing.assert_allclose(z, found["deg.gpkg", ("--project",)], atol=3.0)
        numpy.testing.assert_allclose(found["utm.gpkg", ("--project",)], found["deg.gpkg", ("--project",)], atol=1e-5)

    def test_places_need_no_elevation(self):
        features = [
            {"type": "Feature", "properties": {"z": "low", "elevation": 3.0, "height": 4.0},
             "geometry": {"type": "Point", "coordinates": place}} for place in ([5.0, 5.0], [2.0, 3.0])
        ]
        crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}}
        self.file("places.geojson", json.dumps({"type": "FeatureCollection", "crs": crs, "features": features}))
        output, _ = self.run_on_ground("--at", "places.geojson")
        self.assertIn("at 2 places of places.geojson, 0 outside", output)

    def test_volume_to_a_file_and_to_a_level(self):
        surface_of(square(500) - (0, 0, 1)).write(self.path("lower.vtp"))
        _, report = self.run_on_ground("--volume", "lower.vtp")
        self.assertEqual(report["volume"]["over"], "lower.vtp")
        self.assertAlmostEqual(report["volume"]["above"] / report["volume"]["area"], 1.0, delta=0.02)
        self.assertTrue(read(self.path("ground_difference.vtp")).points.GetPointData().HasArray("Difference"))
        output, report = self.run_on_ground("--volume", "-20")
        self.assertIn("over level -20: ", output)
        self.assertAlmostEqual(report["volume"]["above"] / report["volume"]["area"], 120.0, delta=0.2)

    def test_what_cannot_be_asked_is_one_line_and_nothing_is_written(self):
        self.file("words.csv", "no,numbers\n")
        self.file("one.csv", "x\n1\n")
        for options, words in (
            (("--at", "words.csv"), "words.csv: holds text, but no numbers. Rows with x and y in columns of their own are needed"),
            (("--at", "one.csv"), "one.csv: no line holds 2 numbers; the most is 1. Rows with x and y"),
            (("--volume", "nan"), "--volume takes the file of a surface, or a finite level, not 'nan'"),
            (("--volume", ""), "--volume takes the file of a surface, or a finite level, not ''"),
            (("--at", "missing.csv"), "missing.csv: no such file"),
            (("--volume", "ground.csv"), "ground.csv: has no triangles"),
            (("--volume", "missing.vtp"), "missing.vtp: no such file"),
            (("--at", "ground.csv", "--method", "cubic"), "--method takes one of linear, natural-neighbor"),
            (("--method", "linear"), "--method is for --grid and --at"),
            (("--at-output", "x.csv"), "--at, which is missing"),
            (("--at", "ground.csv", "--memory", "1G"), "--at"),
        ):
            with self.subTest(options=options):
                done = self.call("ground.csv", "--no-picture", *options)
                self.assertIn(done.returncode, (1, 2))
                self.assertIn(words, done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertEqual(sorted(os.listdir(self.folder)), ["ground.csv", "one.csv", "words.csv"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
