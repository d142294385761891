# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Grids, contour lines and outlines, read back by GDAL and OGR."""

import os
import sys
import unittest

import numpy
from in_folder import InFolder, Program
from vtkelevationsurface import ElevationSurfaceError, read, reconstruct
from vtkelevationsurface.writing import grids, lines as line_files
from vtkelevationsurface.clouds import Cloud, make_points
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

try:
    from osgeo import gdal, ogr

    gdal.UseExceptions()
except ImportError:
    gdal = None

WEST, SOUTH = 500000.0, 5900000.0


def wavy(count=4000, seed=1, size=100.0, hole=12.0):
    """Points of a wavy surface on a map, with a hole."""
    random = numpy.random.default_rng(seed)
    x, y = random.uniform(0, size, (2, count))
    keep = numpy.hypot(x - 0.5 * size, y - 0.5 * size) > hole
    x, y = x[keep], y[keep]
    z = 5 * numpy.sin(x / 9) * numpy.cos(y / 7) + random.normal(0, 0.05, len(x))
    return numpy.column_stack((x + WEST, y + SOUTH, z))


def interpolated(surface, x, y):
    """z at (x, y) as VTK finds it on a vertical line; NaN outside."""
    flat = make_points(vtk_to_numpy(surface.GetPoints().GetData()) * (1, 1, 0))
    flat.SetPolys(surface.GetPolys())
    z = vtk_to_numpy(surface.GetPoints().GetData())[:, 2]
    locator = vtkStaticCellLocator()
    locator.SetDataSet(flat)
    locator.BuildLocator()
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    result = numpy.full(len(x), numpy.nan)
    for i, place in enumerate(zip(x, y)):
        cell = locator.FindCell((*place, 0.0))
        if cell >= 0:
            ids = corners[cell]
            a, b, c = vtk_to_numpy(flat.GetPoints().GetData())[ids, :2] - place
            areas = numpy.linalg.det([(b, c), (c, a), (a, b)])
            result[i] = areas @ z[ids] / areas.sum()
    return result


class Interpolation(unittest.TestCase):
    def test_a_plane_is_exact(self):
        xyz = wavy()
        xyz[:, 2] = 0.25 * (xyz[:, 0] - WEST) - 0.5 * (xyz[:, 1] - SOUTH) + 3
        grid = reconstruct(xyz, maximum_edge_length=10).to_grid(0.5)
        plane = 0.25 * (grid.x - WEST) - 0.5 * (grid.y[:, None] - SOUTH) + 3
        inside = numpy.isfinite(grid.z)
        self.assertGreater(inside.mean(), 0.9)
        self.assertLess(abs(grid.z - plane)[inside].max(), 1e-10)

    def test_elevations_are_those_of_the_triangles(self):
        for count, step, steps in ((60, 0.7, 143), (4000, 1.3, 78), (4000, 17.0, 7)):
            with self.subTest(count=count, step=step):
                result = reconstruct(wavy(count), maximum_edge_length=30, fill=False)
                grid = result.to_grid(step)
                self.assertLessEqual(max(grid.z.shape), steps)
                x, y = (a.ravel() for a in numpy.meshgrid(grid.x, grid.y))
                expected = interpolated(result.surface, x, y)
                numpy.testing.assert_allclose(grid.z.ravel(), expected, rtol=0, atol=1e-9)

    def test_points_at_centres_keep_their_elevation_and_no_pixel_is_missed(self):
        random = numpy.random.default_rng(4)
        z = random.uniform(size=(40, 50))
        y, x = numpy.mgrid[0:40, 0:50]
        xyz = numpy.column_stack((x.ravel() * 4 + 2 + WEST, y.ravel() * 4 + 2 + SOUTH, z.ravel()))
        grid = reconstruct(xyz).to_grid(4)
        numpy.testing.assert_array_equal(grid.z[::-1], z)
        # Centres on the edges of triangles and at crossings of the lattice's lines.
        self.assertTrue(numpy.isfinite(reconstruct(xyz).to_grid(1).z[2:-2, 2:-2]).all())

    def test_edges_of_pixels_are_multiples_of_the_step(self):
        grid = reconstruct(wavy()).to_grid(7)
        numpy.testing.assert_array_equal(grid.x / 7 - 0.5, numpy.round(grid.x / 7 - 0.5))
        self.assertTrue((numpy.diff(grid.y) == -7).all())

    def test_errors_are_given_where_holes_were_filled(self):
        grid = reconstruct(wavy(), maximum_edge_length=10, interpolation="thin-plate").to_grid(1)
        middle = numpy.hypot(grid.x - WEST - 50, grid.y[:, None] - SOUTH - 50)
        self.assertTrue((grid.error[middle < 8] > 0).all())
        self.assertEqual(numpy.nanmax(grid.error[(middle > 20) & (middle < 40)]), 0.0)

    def test_steps_that_make_no_grid_are_refused(self):
        result = reconstruct(wavy())
        for step, words in ((1e-4, "use a larger step"), (1e4, "use a smaller step")):
            with self.assertRaisesRegex(ElevationSurfaceError, words):
                result.to_grid(step)
        for step in (0, -1, float("nan"), float("inf")):
            with self.assertRaisesRegex(ValueError, "above 0"):
                result.to_grid(step)


def dem(path, z, turn=0.0, dy=-25.0, crs=25832):
    """A GeoTIFF of these elevations, turned by degrees, in steps of 30 and dy."""
    c, s = numpy.cos(numpy.radians(turn)), numpy.sin(numpy.radians(turn))
    data = gdal.GetDriverByName("GTiff").Create(path, z.shape[1], z.shape[0], 1, gdal.GDT_Float32)
    data.SetGeoTransform((500007.0, 30 * c, dy * -s, 5000003.0, 30 * s, dy * c))
    data.SetSpatialRef(grids.reference_of(f"EPSG:{crs}"))
    data.GetRasterBand(1).WriteArray(z)
    data.GetRasterBand(1).SetNoDataValue(-9999)
    return path


def with_voids(shape=(40, 50)):
    y, x = numpy.mgrid[: shape[0], : shape[1]]
    z = numpy.random.default_rng(2).normal(100 + 20 * numpy.sin(x / 7) * numpy.cos(y / 5), 1)
    whole, z = z.astype("f4"), z.astype("f4")
    z[10:14, 20:26] = z[30, 5] = -9999
    return whole, z


@unittest.skipUnless(gdal, "GDAL's Python module is missing")
class OnPixels(Program):
    def test_filling_voids_gives_every_pixel_back(self):
        for turn, dy in ((0.0, -30.0), (0.0, -25.0), (17.0, -25.0), (0.0, 25.0)):
            with self.subTest(turn=turn, dy=dy):
                _, z = with_voids()
                path = dem(self.path("dem.tif"), z, turn, dy)
                grid = reconstruct(read(path)).to_grid()
                self.assertEqual(grid.z.shape, z.shape)
                self.assertTrue(numpy.isfinite(grid.z).all())
                numpy.testing.assert_array_equal(grid.z[z != -9999], z[z != -9999])
                self.assertGreater(numpy.nanmax(grid.error[z == -9999]), 0)
                grid.write(self.path("back.tif"))
                back = gdal.Open(self.path("back.tif"))
                self.assertEqual(back.GetGeoTransform(), gdal.Open(path).GetGeoTransform())
                self.assertEqual(back.GetSpatialRef().GetAuthorityCode(None), "25832")

    def test_the_step_of_the_raster_means_its_pixels_and_another_does_not(self):
        _, z = with_voids()
        result = reconstruct(read(dem(self.path("dem.tif"), z, dy=-30.0)))
        numpy.testing.assert_array_equal(result.to_grid(30).x, result.to_grid().x)
        self.assertEqual(result.to_grid(15).x[0] % 15, 7.5)

    def test_points_of_a_lattice_go_back_onto_its_nodes(self):
        y, x = numpy.mgrid[:20, :30] * 25.0
        z = numpy.random.default_rng(3).normal(size=x.shape)
        for angle in (0.0, 0.3, 1.2, 2.5):
            c, s = numpy.cos(angle), numpy.sin(angle)
            places = c * x - s * y + 3.0, s * x + c * y + 8.0
            xyz = numpy.column_stack([a.ravel().round(2) for a in (*places, z)])
            grid = reconstruct(xyz).to_grid()
            self.assertEqual(sorted(grid.z.shape), [20, 30])
            self.assertEqual(sorted(grid.z.ravel()), sorted(xyz[:, 2]))
            at = numpy.argmin(abs(grid.z - xyz[40, 2]))
            found = [numpy.broadcast_to(v, grid.z.shape).ravel()[at] for v in (grid.x, grid.y[:, None] if grid.y.ndim == 1 else grid.y)]
            numpy.testing.assert_allclose(found, xyz[40, :2], rtol=0, atol=0.05)

    def test_grids_of_the_same_pixels_are_subtracted_and_others_are_refused(self):
        whole, z = with_voids()
        path = dem(self.path("dem.tif"), whole)
        filled, true = reconstruct(read(dem(self.path("voids.tif"), z))), reconstruct(read(path))
        away = filled.to_grid() - true.to_grid(like=path)
        self.assertEqual(set(zip(*numpy.nonzero(away.z))), set(zip(*numpy.nonzero(z == -9999))))
        numpy.testing.assert_array_equal(away.error, filled.to_grid(like=true.to_grid()).error)
        with self.assertRaisesRegex(ValueError, "different pixels"):
            filled.to_grid() - true.to_grid(10)
        with self.assertRaisesRegex(ValueError, "not both"):
            filled.to_grid(3, like=path)
        with self.assertRaisesRegex(ElevationSurfaceError, "a step is needed"):
            reconstruct(wavy()).to_grid()
        other = dem(self.path("other.tif"), whole, crs=25833)
        with self.assertRaisesRegex(ElevationSurfaceError, "other.tif: its coordinate reference system"):
            filled.to_grid(like=other)
        self.file("far.asc", "ncols 2\nnrows 2\nxllcorner 9\nyllcorner 47\ncellsize 0.1\n1 2\n3 4\n")
        with self.assertRaisesRegex(ElevationSurfaceError, "far.asc has its centre in the surface: it is from x,y 9.05, 47.05 to"):
            filled.to_grid(like=self.path("far.asc"))
        with self.assertRaisesRegex(ElevationSurfaceError, "is not a raster"):
            filled.to_grid(like=self.path(self.file("a.xyz", "0 0 1\n1 0 1\n0 1 2\n3 5 2\n")))

    def test_a_turned_grid_is_not_a_text_grid(self):
        _, z = with_voids()
        grid = reconstruct(read(dem(self.path("dem.tif"), z, 17.0))).to_grid()
        for name in ("a.asc", "a.dat"):
            with self.assertRaisesRegex(ElevationSurfaceError, "has no turned grids; write .tif"):
                grid.write(self.path(name))
        with self.assertRaisesRegex(ElevationSurfaceError, "one of .tif .asc .dat .zmap"):
            grid.write(self.path("a.png"))

    def test_rows_from_south_to_north_come_back_from_text(self):
        _, z = with_voids()
        grid = reconstruct(read(dem(self.path("dem.tif"), z, dy=25.0))).to_grid()
        for name in ("a.asc", "a.dat"):
            grid.write(self.path(name))
            cloud = read(self.path(name))
            self.assertTrue(cloud.frame.is_same(grids.upright(grid, "").frame))
            self.assertTrue((grid - reconstruct(read(dem(self.path("dem.tif"), z, dy=25.0))).to_grid()).z.any() == 0)
            z_of = vtk_to_numpy(cloud.points.GetPoints().GetData())[:, 2]
            numpy.testing.assert_allclose(z_of, grid.z[::-1].ravel(), rtol=1e-12)
        self.assertTrue(os.path.exists(self.path("a.prj")))

    def test_the_program_takes_the_pixels_of_a_file_or_its_own(self):
        _, z = with_voids()
        dem(self.path("dem.tif"), z)
        for given in (["--grid", "like", "dem.tif"], ["--grid"], ["--grid=like dem.tif"]):
            done = self.call("dem.tif", *given, "--no-picture", "--quiet")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            back = gdal.Open(self.path("dem_grid.tif")).ReadAsArray()[0]
            numpy.testing.assert_array_equal(back[z != -9999], z[z != -9999])
            os.remove(self.path("dem_grid.tif"))
        for given, words in (
            (["--grid", "like", "gone.tif"], "gone.tif: no such file"),
            (["--grid", "wide"], "--grid takes a number above 0, or like FILE"),
            (["--grid-output", "a.tif"], "--grid-output is for the result of --grid"),
            (["--grid", "like", "dem.tif", "--grid-output", "dem.tif"], "would overwrite dem.tif"),
        ):
            done = self.call("dem.tif", *given)
            self.assertEqual(done.returncode, 2)
            self.assertIn(words, done.stderr)


@unittest.skipUnless(gdal, "GDAL's Python module is missing")
class Files(InFolder):
    @classmethod
    def setUpClass(cls):
        points = Cloud(make_points(wavy()), crs="EPSG:25832")
        cls.result = reconstruct(points, maximum_edge_length=10)
        cls.grid = cls.result.to_grid(2.5)

    def test_every_grid_comes_back(self):
        gdal.SetConfigOption("ZMAP_PIXEL_IS_POINT", "YES")
        for suffix, bands, digits in ((".tif", 2, 0), (".asc", 1, 0), (".dat", 1, 1e-11)):
            with self.subTest(suffix=suffix):
                path = self.path("g" + suffix)
                notes = grids.write_grid(self.grid, path)
                self.assertEqual(len(notes), 0 if bands == 2 else 1)
                self.assertEqual(os.listdir(self.folder), ["g" + suffix])
                options = ["DATATYPE=Float64"] if suffix == ".asc" else []
                data = gdal.OpenEx(path, gdal.OF_RASTER, open_options=options)
                self.assertEqual(data.RasterCount, bands)
                x0, dx, _, y0, _, dy = data.GetGeoTransform()
                self.assertEqual((dx, dy), (2.5, -2.5))
                self.assertEqual((x0 + 1.25, y0 - 1.25), (self.grid.x[0], self.grid.y[0]))
                for number, expected in enumerate((self.grid.z, self.grid.error)[:bands], 1):
                    band = data.GetRasterBand(number)
                    values = band.ReadAsArray()
                    values[values == band.GetNoDataValue()] = numpy.nan
                    numpy.testing.assert_allclose(values, expected, rtol=digits, atol=digits)
                if bands == 2:
                    code = data.GetSpatialRef().GetAuthorityCode(None)
                    self.assertEqual((code, band.GetDescription()), ("25832", "FilledError"))
                data = band = None
                os.remove(path)

    def test_contours_lie_on_the_surface_at_their_elevation(self):
        lines = line_files.contours(self.result.surface, 2.0)
        self.assertEqual({v["elevation"] for _, v in lines}, {-4.0, -2.0, 0.0, 2.0, 4.0})
        for points, values in lines:
            self.assertTrue((points[:, 2] == values["elevation"]).all())
        every = numpy.concatenate([points for points, _ in lines])[::7]
        z = interpolated(self.result.surface, every[:, 0], every[:, 1])
        inside = numpy.isfinite(z)
        self.assertGreater(inside.mean(), 0.98)
        numpy.testing.assert_allclose(z[inside], every[inside, 2], rtol=0, atol=1e-6)

    def test_steps_that_make_no_contours_are_refused(self):
        for step, words in ((1e-6, "use a larger"), (1e4, "no multiple|0 lies")):
            if step > 1:
                surface = reconstruct(wavy() + (0, 0, 50)).surface
            else:
                surface = self.result.surface
            with self.assertRaisesRegex(ElevationSurfaceError, words):
                line_files.contours(surface, step)

    def test_lines_come_back_from_every_format(self):
        lines = line_files.contours(self.result.surface, 2.0)
        for suffix in (".gpkg", ".geojson", ".dxf"):
            with self.subTest(suffix=suffix):
                path = self.path("c" + suffix)
                line_files.write_lines(lines, path, "contours", "EPSG:25832")
                data = ogr.Open(path)
                layer = data.GetLayer(0)
                self.assertEqual(layer.GetFeatureCount(), len(lines))
                for feature, (points, values) in zip(layer, lines):
                    found = numpy.array(feature.GetGeometryRef().GetPoints())
                    if found.shape[1] == 2:  # DXF has the elevation of a flat line once
                        found = numpy.column_stack((found, points[:, 2]))
                    digits = 1e-8 if suffix == ".dxf" else 0
                    numpy.testing.assert_allclose(found, points, rtol=0, atol=digits)
                    if suffix != ".dxf":
                        self.assertEqual(feature.GetField("elevation"), values["elevation"])
                if suffix != ".dxf":
                    code = layer.GetSpatialRef().GetAuthorityCode(None)
                    self.assertEqual(code, "25832")
                layer = data = None
        self.assertEqual(sorted(os.listdir(self.folder)), ["c.dxf", "c.geojson", "c.gpkg"])

    def test_outlines_have_the_status_of_holes(self):
        lines = line_files.outlines(self.result)
        path = self.path("o.gpkg")
        line_files.write_lines(lines, path, "outlines", None)
        layer = (data := ogr.Open(path)).GetLayer(0)
        rows = [(f.GetField("kind"), f.GetField("status"), f.GetField("area")) for f in layer]
        kinds = [row[0] for row in rows]
        self.assertEqual(kinds.count("hole"), self.result.fill.GetNumberOfHoles())
        self.assertEqual(kinds.count("boundary"), self.result.boundary.GetNumberOfLines())
        largest = max(row for row in rows if row[0] == "hole" and row[2])
        self.assertEqual(largest[1], "filled")
        for points, _ in lines:
            self.assertTrue((points[0] == points[-1]).all())
        layer = data = None


@unittest.skipUnless(gdal, "GDAL's Python module is missing")
class CommandLine(Program):
    def call(self, *arguments, **options):
        return super().call(*arguments, "--no-picture", **options)

    def setUp(self):
        super().setUp()
        rows = "".join("%r %r %r\n" % tuple(row) for row in wavy(500).tolist())
        self.name = self.file("a.xyz", rows)

    def test_all_results_appear_and_know_where_they_lie(self):
        done = self.call(
            *(self.name, "--grid", "5", "--grid-output", "a.asc", "--contours", "2", "--outlines"),
            *("--crs", "EPSG:25832", "--report"),
        )
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        made = "a.asc a.prj a_contours.gpkg a_outlines.gpkg a_surface.json a_surface.vtp".split()
        self.assertEqual(sorted(os.listdir(self.folder)), sorted([*made, self.name]))
        self.assertIn("ETRS89 / UTM zone 32N (EPSG:25832)", done.stdout)
        data = gdal.Open(self.path("a.asc"))
        self.assertTrue(data.GetSpatialRef().IsProjected())
        with open(self.path("a.prj"), encoding="utf-8") as stream:
            self.assertIn('PROJCS["ETRS_1989_UTM_Zone_32N"', stream.read())
        report = self.json("a_surface.json")
        self.assertEqual(report["crs"], "EPSG:25832")
        self.assertEqual(report["options"]["grid"], 5.0)
        self.assertEqual(report["command"][:3], ["reconstruct", "a.xyz", "--grid"])
        self.assertEqual(sorted(report["written"]), made)
        self.assertTrue(report["version"])
        low, high = report["bounds"]["x"]
        self.assertTrue(WEST <= low < high <= WEST + 100)
        for hole in report["holes"]["list"]:
            (x0, y0), (x1, y1) = hole["box"]
            self.assertEqual(hole["centre"], [0.5 * (x0 + x1), 0.5 * (y0 + y1)])
            self.assertAlmostEqual(hole["size"], ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5)

    def test_a_coordinate_reference_system_is_kept_from_file_to_file(self):
        self.assertEqual(self.call(self.name, "--crs", "EPSG:25832").returncode, 0)
        done = self.call("a_surface.vtp", "--grid", "5", "-o", "b.ts")
        self.assertIn("ETRS89 / UTM zone 32N (EPSG:25832)", done.stdout)
        with open(self.path("b.ts"), encoding="utf-8") as stream:
            self.assertIn("\nname:b\n", stream.read())
        done = self.call("b_grid.tif", "--crs", "EPSG:25833", "--grid", "5", "--grid-output", "c.tif")
        self.assertIn("--crs EPSG:25833 is taken, not ETRS89 / UTM zone 32N", done.stdout)
        data = gdal.Open(self.path("c.tif"))
        self.assertEqual(data.GetSpatialRef().GetAuthorityCode(None), "25833")

    def test_latitudes_that_pass_a_pole_by_rounding_are_taken(self):
        head = "ncols 3\nnrows 3\nxllcenter 10\nyllcenter 89.9666666702\ncellsize 0.016666666667\n"
        self.file("pole.asc", head + "1 2 3\n4 5 6\n7 8 9\n")
        done = self.call("pole.asc", "--crs", "EPSG:4326", "--no-picture")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_what_could_not_be_written_is_refused_at_once(self):
        for words, arguments in (
            ("--grid takes a number above 0, or like FILE", ("--grid", "0")),
            ("--contours takes a number above 0", ("--contours", "-1")),
            ("--grid-output is for the result of --grid", ("--grid-output", "g.tif")),
            ("g.png: .png cannot be written; use one of .tif", ("--grid", "5", "--grid-output", "g.png")),
            ("c.shp: .shp cannot be", ("--contours", "5", "--contours-output", "c.shp")),
            ("--crs: EPSG:1 is not a coordinate reference system", ("--crs", "EPSG:1")),
            ("is not longitude and latitude, as EPSG:4326 has them", ("--crs", "EPSG:4326")),
            ("two results", ("--contours", "5", "--contours-output", "o.dxf", "--outlines", "o.dxf")),
            ("there are no outlines with", ("--no-trim", "--no-fill", "--outlines")),
        ):
            with self.subTest(arguments=arguments):
                done = self.call(self.name, *arguments)
                self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)
                self.assertIn(words, done.stderr)
                self.assertEqual(os.listdir(self.folder), [self.name])

    def test_a_result_that_fails_leaves_none_of_the_others(self):
        for words, arguments in (
            ("--grid: a grid with a step of 1e-05", ("--grid", "1e-5")),
            ("--grid: no pixel", ("--grid", "1e5", "--contours", "2")),
        ):
            done = self.call(self.name, *arguments)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
            self.assertIn(words, done.stderr)
            self.assertEqual(os.listdir(self.folder), [self.name])

    def test_a_full_disk_leaves_nothing_behind(self):
        for arguments in (
            ("--grid", "0.25"),
            ("--grid", "0.5", "--grid-output", "g.asc"),
            ("--grid", "0.5", "--grid-output", "g.zmap"),
            ("--contours", "0.05"),
            ("--contours", "0.05", "--contours-output", "c.geojson"),
            ("--contours", "0.05", "--contours-output", "c.dxf"),
        ):
            with self.subTest(arguments=arguments):
                done = self.call(self.name, *arguments, largest_file=100_000)
                self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
                self.assertIn("cannot be written", done.stderr)
                self.assertEqual(os.listdir(self.folder), [self.name])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
