# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points, lines and polygons of vector files, made by OGR and by hand."""

import math
import os
import sys
import unittest

import numpy
from in_folder import InFolder, Program, coordinates
from osgeo import gdal, ogr, osr
from vtkelevationsurface import reading
from vtkelevationsurface.clouds import (
    Cloud, bare_lines, crs_of, faults_note, heights_of, make_points, merged, line_parts,
)
from vtkelevationsurface.gdal_common import check_system, reference_of, same_system
from vtkelevationsurface.messages import FileError
from vtkmodules.util.numpy_support import vtk_to_numpy

gdal.UseExceptions()
ogr.UseExceptions()
osr.UseExceptions()
MAP = [
    (612014.6747884353, 6073983.681666553, 633.5012316703796),
    (612015.125, 6073984.987654321, -1.0 / 3.0),
    (612016.5, 6073985.000000001, 9999.125),
]
FIELDS = {"name": ["a", "b", "c"], "number": [7, 8, None], "weight": [0.5, None, -1.0 / 3.0]}
RING = "(0 0 1, 10 0 2, 10 10 3, 0 10 4, 0 0 1)"
HOLE = "(2 2 5, 4 2 6, 4 4 7, 2 2 5)"


def wkt_of(rows, flat=False):
    if flat:
        return [f"POINT ({x!r} {y!r})" for x, y, _ in rows]
    return [f"POINT Z ({x!r} {y!r} {z!r})" for x, y, z in rows]


def vector(path, driver, geometries, fields=None, layer="points", epsg=25832, options=()):
    """Writes geometries (well-known text or None) with attributes; adds a layer to a dataset."""
    reference = osr.SpatialReference()
    reference.ImportFromEPSG(epsg)
    reference.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    if isinstance(path, str):
        path = ogr.GetDriverByName(driver).CreateDataSource(path)
    types = {ogr.CreateGeometryFromWkt(text).GetGeometryType() for text in geometries if text}
    kind = types.pop() if len(types) == 1 else ogr.wkbUnknown
    made = path.CreateLayer(layer, reference, kind, list(options))
    kinds = {str: ogr.OFTString, int: ogr.OFTInteger, float: ogr.OFTReal}
    for name, values in (fields or {}).items():
        made.CreateField(ogr.FieldDefn(name, kinds[type(values[0])]))
    for i, text in enumerate(geometries):
        feature = ogr.Feature(made.GetLayerDefn())
        for name, values in (fields or {}).items():
            if values[i] is not None:
                feature.SetField(name, values[i])
        if text:
            feature.SetGeometry(ogr.CreateGeometryFromWkt(text))
        made.CreateFeature(feature)
    return path


class Vectors(InFolder):
    def make(self, name, driver, geometries, *arguments, **more):
        vector(self.path(name), driver, geometries, *arguments, **more)
        return self.path(name)

    def gpkg(self, geometries, fields=None, **more):
        return self.make("a.gpkg", "GPKG", geometries, fields, **more)

    def array(self, cloud, name):
        return vtk_to_numpy(cloud.points.GetPointData().GetArray(name)).tolist()


class Points(Vectors):
    def test_every_format_keeps_coordinates_attributes_and_reference_system(self):
        for name, driver, options, digits, has_fields, has_crs in (
            ("a.gpkg", "GPKG", (), None, True, True),
            ("a.shp", "ESRI Shapefile", ("SHPT=POINTZ",), None, True, True),
            ("a.fgb", "FlatGeobuf", ("SPATIAL_INDEX=NO",), None, True, True),
            ("a.geojson", "GeoJSON", ("COORDINATE_PRECISION=15",), 1e-14, True, True),
            ("a.csv", "CSV", ("GEOMETRY=AS_WKT",), 1e-14, True, False),
            ("a.gml", "GML", (), 1e-8, True, True),
            ("a.gmt", "OGR_GMT", (), 1e-6, False, True),
            ("a.dxf", "DXF", (), 1e-9, False, False),
            ("a.sqlite", "SQLite", (), None, True, True),
            ("a.jml", "JML", (), 1e-14, True, True),
        ):
            fields = dict(FIELDS) if has_fields else None
            with self.subTest(driver=driver):
                path = self.make(name, driver, wkt_of(MAP), fields, options=options)
                cloud = reading.read(path, layer="points" if driver == "SQLite" else None)
                if digits is None:
                    self.assert_rows(cloud, MAP)
                else:
                    numpy.testing.assert_allclose(coordinates(cloud), MAP, rtol=digits)
                if has_fields:
                    weights = self.array(cloud, "weight")
                    numpy.testing.assert_allclose(weights, [0.5, math.nan, -1.0 / 3.0], rtol=1e-14)
                    self.assertEqual(self.array(cloud, "number")[:2], [7, 8])
                if has_crs:
                    self.assertIn("UTM zone 32N", cloud.crs)

    def test_all_digits_of_text_survive(self):
        points = ",".join(
            '{"type": "Feature", "properties": {"w": 0.1}, "geometry": '
            '{"type": "Point", "coordinates": [%r, %r, %r]}}' % row
            for row in MAP
        )
        content = '{"type": "FeatureCollection", "features": [' + points + "]}"
        self.assert_rows(self.read(content, "a.geojson"), MAP)
        content = "id;geometry\n" + "".join(f"1;{text}\n" for text in wkt_of(MAP))
        self.assert_rows(self.read(content, "a.csv"), MAP)

    def test_what_is_not_an_angle_is_in_no_system_of_angles(self):
        points = '{"type": "MultiPoint", "coordinates": [[612000, 6073000, 1], [612001, 6073000, 2]]}'
        cloud = self.read(points, "a.geojson")
        self.assertIsNone(cloud.crs)
        self.assertIn("x,y are not angles, so it is not in WGS 84; see --crs", cloud.notes)

    def test_degrees_of_kml_and_gpx_are_noted(self):
        degrees = [(7.5, 50.25, 100.5), (7.75, 50.5, 200.25), (8.0, 50.0, 300.0)]
        self.make("a.kml", "KML", wkt_of(degrees), epsg=4326)
        points = "".join(
            f'<wpt lat="{y}" lon="{x}"><ele>{z}</ele></wpt>' for x, y, z in degrees
        )
        gpx = '<gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1">' + points + "</gpx>"
        self.file("a.gpx", gpx)
        for name in ("a.kml", "a.gpx"):
            with self.subTest(name=name):
                cloud = reading.read(self.path(name))
                self.assert_rows(cloud, degrees)
                self.assertTrue(any("x,y are angles" in note for note in cloud.notes))

    def test_tracks_of_gpx_are_points_or_lines_as_is_asked(self):
        rows = [(7.5, 50.25, 100.5), (7.75, 50.5, 200.25), (8.0, 50.0, 300.0)]
        points = "".join(
            f'<trkpt lat="{y}" lon="{x}"><ele>{z}</ele><time>2026-05-0{i}T10:00:00Z</time></trkpt>' for i, (x, y, z) in enumerate(rows, 1)
        )
        gpx = f'<gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1"><trk><trkseg>{points}</trkseg></trk></gpx>'
        cloud = self.read(gpx, "a.gpx")
        self.assert_rows(cloud, rows)
        self.assertFalse([note for note in cloud.notes if "time" in note], cloud.notes)
        lines = reading.read_faults(self.path("a.gpx"))
        self.assertEqual((lines.GetNumberOfCells(), lines.GetCell(0).GetNumberOfPoints()), (1, 3))

    def test_z_comes_from_an_attribute_where_the_points_are_flat(self):
        heights = [row[2] for row in MAP]
        for name, flat in (("HOEHE", True), ("z", True), ("elevation_m", True), ("Cota", True),
                           ("grid_code", True),
                           ("z", False)):
            with self.subTest(name=name, flat=flat):
                rows = [(x, y, 0.0) for x, y, _ in MAP]
                cloud = reading.read(
                    self.gpkg(wkt_of(rows, flat), {"code": [1, 2, 3], name: heights})
                )
                self.assert_rows(cloud, MAP)
                self.assertIn(f"z from attribute {name}", cloud.notes)

    def test_z_of_the_points_is_taken_before_that_of_an_attribute(self):
        cloud = reading.read(self.gpkg(wkt_of(MAP), {"elevation": [1.0, 2.0, 3.0]}))
        self.assert_rows(cloud, MAP)
        self.assertIn("z from the geometry, not from elevation", cloud.notes)

    def test_single_flat_points_among_others_take_the_attribute(self):
        points = wkt_of(MAP[:2]) + wkt_of(MAP[2:], True)
        cloud = reading.read(self.gpkg(points, {"elevation": [1.0, 2.0, 3.0]}))
        self.assertEqual(coordinates(cloud)[:, 2].tolist(), [MAP[0][2], MAP[1][2], 3.0])
        self.assertIn("z from attribute elevation, where the geometry has none", cloud.notes)

    def test_the_attribute_of_z_can_be_named(self):
        path = self.gpkg(wkt_of(MAP, True), {"v": [1.5, 2.5, 3.5], "name": ["a", "b", "c"]})
        cloud = reading.read(path, columns=["x", "y", "v"])
        self.assertEqual(coordinates(cloud)[:, 2].tolist(), [1.5, 2.5, 3.5])
        for words, columns in (
            ("no attribute is named as an elevation.*attributes: v, name", None),
            ("has no attribute q; attributes: v, name", ["x", "y", "q"]),
            ("'a' in attribute name is not a number", ["x", "y", "name"]),
        ):
            with self.assertRaisesRegex(reading.FileError, words):
                reading.read(path, columns=columns)

    def test_two_attributes_that_could_be_z_are_asked(self):
        values = [1.0, 2.0, 3.0]
        path = self.gpkg(wkt_of(MAP, True), {"height": values, "elevation": values})
        with self.assertRaisesRegex(reading.FileError, "attributes height, elevation could be"):
            reading.read(path)

    def test_depth_by_name_is_noted(self):
        cloud = reading.read(self.gpkg(wkt_of(MAP, True), {"depth": [1.0, 2.0, 3.0]}))
        self.assertTrue(any("--depth turns it over" in note for note in cloud.notes))
        cloud = reading.read(self.gpkg(wkt_of(MAP, True), {"depth": [-1.0, -2.0, -3.0]}))
        self.assertFalse(any("--depth" in note for note in cloud.notes))

    def test_vertices_of_lines_and_polygons_are_points(self):
        path = self.gpkg(
            ["LINESTRING Z (0 0 1, 5 0 2, 5 5 3)", f"POLYGON Z ({RING}, {HOLE})",
             "MULTIPOINT Z ((7 7 7), (8 8 8))", None],
            {"code": [4, 5, 6, 7]},
        )
        cloud = reading.read(path)
        rows = [(0, 0, 1), (5, 0, 2), (5, 5, 3), (0, 0, 1), (10, 0, 2), (10, 10, 3), (0, 10, 4)]
        rows += [(2, 2, 5), (4, 2, 6), (4, 4, 7), (7, 7, 7), (8, 8, 8)]
        self.assert_rows(cloud, rows)
        self.assertEqual(self.array(cloud, "code"), [4] * 3 + [5] * 7 + [6] * 2)
        self.assertIn("the vertices of lines and polygons are taken as points", cloud.notes)
        self.assertEqual(cloud.left_out, {"features without geometry": 1})

    def test_contours_take_their_elevation_from_an_attribute(self):
        lines = ["LINESTRING (0 0, 5 0)", "LINESTRING (0 5, 5 5, 9 5)"]
        cloud = reading.read(self.gpkg(lines, {"ELEV": [100.0, 110.0]}))
        self.assertEqual(coordinates(cloud)[:, 2].tolist(), [100, 100, 110, 110, 110])

    def test_layers_are_chosen(self):
        data = vector(self.path("a.gpkg"), "GPKG", wkt_of(MAP), layer="first")
        vector(data, "GPKG", wkt_of(MAP[:1]), layer="second")
        vector(data, "GPKG", [], layer="empty")
        data = None
        path = self.path("a.gpkg")
        with self.assertRaisesRegex(reading.FileError, "with geometry first, second: choose"):
            reading.read(path)
        self.assert_rows(reading.read(path, layer="second"), MAP[:1])
        with self.assertRaisesRegex(reading.FileError, "no layer third; layers with geom.*: first"):
            reading.read(path, layer="third")
        with self.assertRaisesRegex(reading.FileError, "layer empty holds no geometry"):
            reading.read(path, layer="empty")

    def test_layers_of_a_drawing_are_chosen_and_its_texts_left_out(self):
        entities = "".join(
            f"0\nPOINT\n8\n{layer}\n10\n{x}\n20\n{y}\n30\n{z}\n"
            for layer, x, y, z in (
                ("SPOT", 1.5, 2.5, 3.5),
                ("SPOT", 2.5, 2.5, 4.5),
                ("OLD", 9, 9, 1),
            )
        )
        entities += "0\nTEXT\n8\nSPOT\n10\n7.0\n20\n7.0\n30\n0.0\n40\n1.0\n1\n12.3\n"
        content = "0\nSECTION\n2\nENTITIES\n" + entities + "0\nENDSEC\n0\nEOF\n"
        cloud = self.read(content, "a.dxf")
        self.assert_rows(cloud, [(1.5, 2.5, 3.5), (2.5, 2.5, 4.5), (9, 9, 1)])
        self.assertEqual(cloud.left_out, {"texts": 1})
        self.assert_rows(self.read(content, "a.dxf", layer="OLD"), [(9, 9, 1)])
        self.assert_refused("no layer NEW; layers: OLD, SPOT", content, "a.dxf", layer="NEW")

    def test_content_is_known_whatever_the_name(self):
        self.make("b.gpkg", "GPKG", wkt_of(MAP))
        with open(self.path("b.gpkg"), "rb") as stream:
            cloud = self.read(stream.read(), "b.tif")
        self.assert_rows(cloud, MAP)
        self.assertIn("by its content this is a vector file, not a raster", cloud.notes)

    def test_nothing_is_written_next_to_a_file(self):
        for name, driver in (("a.gml", "GML"), ("a.shp", "ESRI Shapefile"), ("a.gpkg", "GPKG")):
            path = self.make(name, driver, wkt_of(MAP))
            if driver == "GML":
                os.remove(self.path("a.xsd"))  # without it, GDAL would write what it finds out
            before = sorted(os.listdir(self.folder))
            reading.read(path)
            self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_damaged_files_are_refused_in_one_line(self):
        contents = {}
        for name, driver in (("a.gpkg", "GPKG"), ("a.fgb", "FlatGeobuf"), ("a.geojson", "GeoJSON"),
                             ("a.shp", "ESRI Shapefile"), ("a.gml", "GML")):
            with open(self.make(name, driver, wkt_of(MAP * 50)), "rb") as stream:
                contents[name] = stream.read()
        for name, content in contents.items():
            for share in (0.02, 0.3, 0.6, 0.95):
                with self.subTest(name=name, share=share):
                    self.assert_refused("", content[: int(share * len(content))], "cut-" + name)
        for words, name, content in (
            ("", "a.geojson", '{"type": "FeatureCollection", "features": "none"}'),
            (
                "holds no layers with geometry",
                "b.geojson",
                '{"type": "FeatureCollection", "features": []}',
            ),
            ("", "a.gpkg", b"SQLite format 3\0" + bytes(200)),
            ("", "a.dxf", "0\nSECTION\n2\nENTITIES\n0\nPOINT\n10\nx\n"),
            ("", "a.shp", b"\0\0\x27\x0a" + bytes(96)),
            ("", "a.csv", "WKT,name\nPOINT Z (a b c),x\nPOINT Z (d e f),y\n"),
        ):
            with self.subTest(name=name, words=words):
                self.assert_refused(words, content, name)


class Lines(Vectors):
    def cells(self, data):
        lines = []
        for i in range(data.GetNumberOfCells()):
            ids = data.GetCell(i).GetPointIds()
            lines.append([data.GetPoint(ids.GetId(j)) for j in range(ids.GetNumberOfIds())])
        return lines

    def test_a_boundary_is_read_with_its_holes(self):
        for name, driver in (
            ("a.gpkg", "GPKG"),
            ("a.shp", "ESRI Shapefile"),
            ("a.geojson", "GeoJSON"),
            ("a.csv", "CSV"),
        ):
            with self.subTest(driver=driver):
                options = ("GEOMETRY=AS_WKT",) if driver == "CSV" else ()
                polygon = [f"POLYGON Z ({RING}, {HOLE})"]
                path = self.make(name, driver, polygon, {"id": [1]}, options=options)
                data = reading.read_boundary(path)
                self.assertEqual(data.GetNumberOfLines(), 2)
                self.assertEqual(data.GetNumberOfPoints(), 7)
                for ring, count in zip(self.cells(data), (5, 4)):
                    self.assertEqual(len(ring), count)
                    self.assertEqual(ring[0], ring[-1])

    def test_a_flat_boundary_and_closed_lines_are_enough(self):
        path = self.gpkg(["POLYGON ((0 0, 9 0, 9 9, 0 0))", "LINESTRING (1 1, 2 1, 2 2, 1 1)"])
        data = reading.read_boundary(path)
        self.assertEqual(data.GetNumberOfLines(), 2)
        self.assertEqual(data.GetNumberOfPoints(), 6)

    def test_lines_are_named_by_their_features(self):
        polygons = "MULTIPOLYGON (((0 0, 9 0, 9 9, 0 0)), ((20 0, 29 0, 29 9, 20 0)))"
        path = self.gpkg(["LINESTRING (1 1, 2 1, 2 2)", polygons])
        names, parts = line_parts(reading.read_boundary(path))
        self.assertEqual(names, ["feature 1", "feature 2", "feature 2, part 2"])
        self.assertEqual([len(part) for part in parts], [3, 4, 4])

    def test_faults_keep_their_elevations(self):
        several = "MULTILINESTRING Z ((1 1 3, 2 2 4), (5 5 5, 6 6 6))"
        path = self.gpkg(["LINESTRING Z (0 0 1, 5 0 2)", several])
        lines = self.cells(reading.read_faults(path))
        expected = [[(0, 0, 1), (5, 0, 2)], [(1, 1, 3), (2, 2, 4)], [(5, 5, 5), (6, 6, 6)]]
        self.assertEqual(lines, expected)
        path = self.gpkg(["LINESTRING (0 0, 5 0)"], {"elevation": [7.5]}, layer="b")
        self.assertEqual(self.cells(reading.read_faults(path)), [[(0, 0, 7.5), (5, 0, 7.5)]])

    def test_what_holds_no_lines_is_refused(self):
        with self.assertRaisesRegex(reading.FileError, "no polygon that could be a fault"):
            reading.read_faults(self.gpkg(wkt_of(MAP)))

    def test_lines_without_z_are_known_and_have_0(self):
        path = self.gpkg(["LINESTRING (0 0, 5 0)", "LINESTRING Z (0 1 7, 5 1 8)"])
        faults = reading.read_faults(path)
        self.assertEqual(bare_lines(faults).tolist(), [True, False])
        self.assertEqual(self.cells(faults), [[(0, 0, 0), (5, 0, 0)], [(0, 1, 7), (5, 1, 8)]])


class Systems(Vectors, Program):
    """Coordinate reference systems of several files."""

    RING = ["POLYGON ((612000 6073000, 613000 6073000, 613000 6075000, 612000 6073000))"]

    def test_lines_carry_theirs(self):
        for name, driver in (("a.gpkg", "GPKG"), ("a.shp", "ESRI Shapefile")):
            with self.subTest(driver=driver):
                crs = crs_of(reading.read_boundary(self.make(name, driver, self.RING)))
                self.assertTrue(same_system(crs, "EPSG:25832"))

    def test_systems_are_compared_by_their_places(self):
        for one, other, same in (
            ("EPSG:25832", "EPSG:25832", True),
            ("EPSG:25832", "EPSG:25832+7837", True),
            ("EPSG:4326", "OGC:CRS84", True),
            ("EPSG:25832", "EPSG:25833", False),
            ("EPSG:25832", "EPSG:4326", False),
            ("EPSG:25832", "nonsense", None),
            ("EPSG:25832", 'LOCAL_CS["site"]', None),
            ("EPSG:25832", None, None),
        ):
            with self.subTest(one=one, other=other):
                self.assertIs(same_system(one, other), same)

    def test_systems_a_few_metres_apart_are_taken_as_one_with_a_note(self):
        for one, other, near in (
            ("EPSG:25832", "EPSG:32632", True),
            ("EPSG:4258", "EPSG:4326", True),
            ("EPSG:25832", "EPSG:23032", False),
            ("EPSG:25832", "EPSG:25833", False),
            ("EPSG:25832", "EPSG:4326", False),
        ):
            with self.subTest(one=one, other=other):
                if near:
                    self.assertIn("taken as the same", check_system("a", one, "b", other)[0])
                else:
                    with self.assertRaises(FileError):
                        check_system("a", one, "b", other)

    def test_a_boundary_and_faults_in_another_system_are_reprojected_or_refused(self):
        points = wkt_of([(612000 + x, 6073000 + y, x) for x in range(9) for y in range(9)])
        self.make("p.gpkg", "GPKG", points)
        lines = ["LINESTRING Z (612001.25 6073001.4 0, 612005.1 6073004.7 5)"]
        places = "612001.3 6073001.4, 612005.2 6073001.2, 612005.3 6073005.7, 612001.3 6073001.4"
        ring = [f"POLYGON (({places}))"]
        change = osr.CoordinateTransformation(*map(reference_of, ("EPSG:25832", "EPSG:25833")))
        for option, shapes in (("--boundary", ring), ("--faults", lines)):
            plain, other, wrong = (f"{option[2:]}-{i}.gpkg" for i in range(3))
            moved = ogr.CreateGeometryFromWkt(shapes[0])
            moved.Transform(change)
            self.make(plain, "GPKG", shapes)
            self.make(other, "GPKG", [moved.ExportToWkt()], epsg=25833)
            self.make(wrong, "GPKG", shapes, epsg=25833)
            run = ("p.gpkg", "--no-fill", "--no-picture", option)
            with self.subTest(option=option):
                surfaces = []
                for name in (plain, other):
                    done = self.call(*run, name)
                    self.assertEqual((done.returncode, done.stderr), (0, ""))
                    surfaces.append(reading.read(self.path("p_surface.vtp")))
                self.assertRegex(done.stdout, f"note +{other} is in .*33N .*, p.gpkg in .*32N")
                x, y, _ = (moved if option == "--faults" else moved.GetGeometryRef(0)).GetPoint(0)
                self.assertIn(f"first point ({x:.10g}, {y:.10g}) to (612001.", done.stdout)
                # What is inserted is in an order that depends on its places.
                first, second = (
                    xyz[numpy.lexsort(xyz.round(2).T)] for xyz in map(coordinates, surfaces))
                numpy.testing.assert_allclose(first, second, rtol=0.0, atol=1e-3)
                done = self.call(*run, other, "--strict")
                self.assertEqual(done.returncode, 1)
                words = f"{other}: its coord.*33N.*, that of p.gpkg .*32N.*reproject"
                self.assertRegex(done.stderr, words)
                done = self.call(*run, wrong)
                self.assertEqual(done.returncode, 1)
                words = f"{wrong} is in .*33N.*, p.gpkg in .*32N.* away from the"
                self.assertRegex(done.stderr, words)

    def test_what_reprojecting_does_to_long_edges_is_noted(self):
        steps = range(0, 100001, 20000)
        points = [(500000 + x, 5500000 + y, x) for x in steps for y in steps]
        self.make("p.gpkg", "GPKG", wkt_of(points))
        ring = "POLYGON ((9.2 49.8, 10.2 49.8, 10.2 50.4, 9.2 49.8))"
        self.make("b.gpkg", "GPKG", [ring], epsg=4326)
        done = self.call("p.gpkg", "--boundary", "b.gpkg", "--no-fill", "--no-picture")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, r"edges between points stay straight, up to \d+ away from")

    def test_faults_far_from_the_points_are_noted(self):
        points = make_points([(0.0, 0.0, 100.0), (1.0, 0.0, 150.0), (0.0, 1.0, 400.0)])
        for z, is_noted in (
            ((0, 0), True), ((-500, -400), True), ((900, 800), True),
            ((0, 1), False), ((50, 60), False), ((500, 600), False), ((-900, 900), False),
        ):
            with self.subTest(z=z):
                note = faults_note(heights_of(points), make_points([(0.0, i, z[i]) for i in range(2)]))
                self.assertEqual(note is not None, is_noted)
        self.make("p.gpkg", "GPKG", wkt_of([(x, y, 100 + x) for x in range(9) for y in range(9)]))
        self.make("f.gpkg", "GPKG", ["LINESTRING Z (1.5 1 0, 5.5 5 0)"])
        done = self.call("p.gpkg", "--faults", "f.gpkg", "--no-picture", "--faults-z", "given")
        self.assertIn("z of the faults is 0, far from z of the points, 100 to 108", done.stdout)

    def test_points_of_several_systems_are_not_merged(self):
        crs = ("EPSG:25832", None, "EPSG:25833")
        parts = [Cloud(make_points(MAP), crs=one) for one in crs]
        with self.assertRaisesRegex(reading.FileError, "^c: .*33N.*, that of a is .*32N.*reproject"):
            merged(["a", "b", "c"], parts)
        one = merged(["a", "b"], parts[:2])
        self.assertEqual(one.crs, "EPSG:25832")
        parts[2].crs = "EPSG:25832+7837"
        self.assertEqual(merged(["a", "c"], parts[::2]).crs, "EPSG:25832")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
