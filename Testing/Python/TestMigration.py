# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Each row of Documentation/Migration.md runs: our side always, the other where it is installed."""

import ast
import glob
import importlib
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

import numpy
from documented import run_commands, text_of
from migration_data import (
    CORNERS,
    XYZ,
    area,
    ring_area,
    corners,
    data,
    edges,
    faces_of,
    features_of,
    lengths,
    pixels,
    triangles,
    write_files,
)
from vtkelevationsurface import (
    read,
    reconstruct,
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import vtkDelaunay2D, vtkStaticCleanPolyData
from vtkmodules.vtkFiltersGeneral import vtkTransformFilter
from vtkmodules.vtkFiltersModeling import vtkFillHolesFilter

CHECKS = {}


def rows_of(section):
    """[(first cell, its code, code of the second cell)]"""
    text = text_of("Migration.md").split(f"\n## {section}\n")[1].split("\n## ")[0]
    rows = [re.split(r"(?<!\\) \| ", line.strip("| ")) for line in text.splitlines() if line.startswith("| `")]
    code = re.compile("`([^`]+)`")
    return [(row[0], code.search(row[0]).group(1), code.search(row[1]).group(1)) for row in rows]


def checks(section, there):
    """Notes that a function checks the row of a section that begins so."""
    def note(function):
        CHECKS[section, there] = function
        return function
    return note


HULL = area(reconstruct(XYZ, trim=False, fill=False).surface)


def clean_points():
    """A vtkStaticCleanPolyData that keeps points without cells, as that of VTK 9.1 does."""
    clean = vtkStaticCleanPolyData()
    if hasattr(clean, "RemoveUnusedPointsOff"):
        clean.RemoveUnusedPointsOff()
    return clean


def names():
    """What the code of the tables may use."""
    transform = vtkTransform()
    transform.RotateZ(30)
    return {
        "points": data(), "lines": data(Lines=CORNERS[:2]), "ring": data(Polys=CORNERS),
        "surface": reconstruct(XYZ, fill=False).surface, "transform": transform, "spacing": 2.6,
        "xi": XYZ[::50, :2] * 0.98 + 0.02 * XYZ[:, :2].mean(axis=0),
        "read": read, "reconstruct": reconstruct, "vtkTransformFilter": vtkTransformFilter,
        "vtkDelaunay2D": vtkDelaunay2D, "vtkStaticCleanPolyData": clean_points, "vtkFillHolesFilter": vtkFillHolesFilter,
        "vtkGridDelaunay2D": vtkGridDelaunay2D, "vtkFillElevationHoles": vtkFillElevationHoles,
    }


def run_code(code, known):
    """Runs statements; the value of one that is an expression is called value."""
    for statement in ast.parse(code).body:
        if isinstance(statement, ast.Expr):
            known["value"] = eval(compile(ast.Expression(statement.value), code, "eval"), known)
        else:
            exec(compile(ast.Module([statement], []), code, "exec"), known)


# ---- vtkDelaunay2D -----------------------------------------------------------------------------


def delaunay_of(code, kind):
    """The names after code ran with a filter of a kind; result is what the last filter puts out."""
    known = names()
    known["delaunay"], known["trim"] = kind(), vtkTrimOutwardTriangles()
    known["delaunay"].SetInputData(known["points"])
    known["trim"].SetInputConnection(known["delaunay"].GetOutputPort())
    run_code(code, known)
    last = known["trim" if "trim" in code else "delaunay"]
    if last.GetNumberOfInputConnections(0) == 0:
        last.SetInputData(known["points"])
    last.Update()
    return {"result": last.GetOutput(), **known}


@checks("vtkDelaunay2D", "delaunay = vtkDelaunay2D()")
def _(test, there, here):
    same = {tuple(sorted(t)) for t in triangles(there["result"])}
    own = {tuple(sorted(t)) for t in triangles(here["result"])}
    test.assertGreater(len(same & own), 0.95 * len(own))
    unused = here["result"].GetFieldData().GetArray("UnusedPointIds")
    test.assertEqual(vtk_to_numpy(unused).tolist(), [len(XYZ) - 2])


@checks("vtkDelaunay2D", "delaunay.SetTolerance(0.002)")
def _(test, there, here):
    left = len(numpy.unique(triangles(there["result"])))
    test.assertLess(abs(left - here["clean"].GetOutput().GetNumberOfPoints()), 3)
    test.assertLess(left, len(XYZ) - 1)


@checks("vtkDelaunay2D", "delaunay.SetProjectionPlaneMode(2)")
def _(test, there, here):
    test.assertLess(abs(area(there["result"]) / HULL - 1), 0.02)
    test.assertLess(abs(area(here["result"].surface) / HULL - 1), 0.01)


@checks("vtkDelaunay2D", "delaunay.SetBoundingTriangulation(True)")
def _(test, there, here):
    test.assertGreater(area(there["result"]), 1.5 * HULL)
    test.assertLess(abs(area(here["result"]) / HULL - 1), 1e-9)


@checks("vtkDelaunay2D", "delaunay.SetSourceData(lines)")
def _(test, there, here):
    for side in (there, here):
        test.assertIn(tuple(sorted(CORNERS[:2])), edges(side["result"]))
    test.assertEqual(here["delaunay"].GetNumberOfAddedPoints(), 0)
    apart = vtkPolyData()
    apart.DeepCopy(here["lines"])
    apart.GetPoints().SetPoint(CORNERS[0], 21.125, 33.5, 4.0)
    here["delaunay"].SetSourceData(apart)
    here["delaunay"].Update()
    test.assertEqual(here["delaunay"].GetNumberOfAddedPoints(), 1)


@checks("vtkDelaunay2D", "delaunay.SetSourceData(ring)")
def _(test, there, here):
    expected = ring_area(XYZ[CORNERS, :2])
    test.assertAlmostEqual(area(here["result"]), expected, 6)
    test.assertTrue(expected - 1e-6 < area(there["result"]) < 1.3 * expected)


@checks("vtkDelaunay2D", "delaunay.SetAlpha(4)")
def _(test, there, here):
    a, b, c = lengths(there["result"]).T
    xy = corners(there["result"])
    (ux, uy), (vx, vy) = (xy[:, 1] - xy[:, 0]).T, (xy[:, 2] - xy[:, 0]).T
    test.assertLess((a * b * c / abs(2 * (ux * vy - uy * vx))).max(), 4.001)
    test.assertGreater(there["result"].GetNumberOfLines(), 0)
    test.assertLessEqual(lengths(here["result"]).max(), 6)
    test.assertEqual(here["result"].GetNumberOfCells(), len(triangles(here["result"])))


@checks("vtkDelaunay2D", "delaunay.SetTolerance(0.001)")
def _(test, there, here):
    last = len(XYZ) - 1
    used = [set(triangles(side["result"]).ravel()) for side in (there, here)]
    test.assertFalse({1, last} <= used[0])
    test.assertTrue({1, last} <= used[1])
    test.assertTrue(last - 1 in used[1] and 0 not in used[1])  # the lower one


@checks("vtkDelaunay2D", "delaunay.SetOffset(10)")
def _(test, _there, here):
    test.assertAlmostEqual(area(here["result"]), HULL, 6)


@checks("vtkDelaunay2D", "delaunay.SetTransform(transform)")
def _(test, there, here):
    test.assertEqual(there["result"].GetPoint(5), tuple(XYZ[5]))
    numpy.testing.assert_allclose(here["result"].GetPoint(5), here["transform"].TransformPoint(XYZ[5]))
    test.assertGreater(len(triangles(here["result"])), 2000)


# ---- vtkFillHolesFilter ------------------------------------------------------------------------


def fill_of(code, kind):
    known = names()
    known["fill"] = kind()
    run_code(code, known)
    known["fill"].SetInputData(known["surface"])
    if "SetHoleSize" not in code and kind is vtkFillHolesFilter:
        known["fill"].SetHoleSize(20)
    known["fill"].Update()
    return {**known, "result": known["fill"].GetOutput()}


@checks("vtkFillHolesFilter", "fill = vtkFillHolesFilter()")
def _(test, there, here):
    count = there["surface"].GetNumberOfPoints()
    test.assertEqual(there["result"].GetNumberOfPoints(), count)
    test.assertGreater(here["result"].GetNumberOfPoints(), count)
    test.assertTrue(here["result"].GetPointData().HasArray("FilledError"))
    test.assertEqual(here["fill"].GetOutput(1).GetNumberOfLines(), 1)


@checks("vtkFillHolesFilter", "fill.SetHoleSize(20)")
def _(test, there, here):
    test.assertGreater(there["result"].GetNumberOfPolys(), there["surface"].GetNumberOfPolys())
    test.assertEqual(here["fill"].GetNumberOfFilledHoles(), 1)
    here["fill"].SetMaximumHoleSize(20)
    here["fill"].Update()
    test.assertEqual(here["fill"].GetNumberOfFilledHoles(), 0)


@checks("vtkFillHolesFilter", "fill.SetHoleSize(1000)")
def _(test, there, here):
    test.assertLess(area(here["result"]), HULL + 1e-6)
    test.assertGreater(area(there["result"]), 1.5 * HULL)


# ---- PyVista -----------------------------------------------------------------------------------


@checks("PyVista", "points.delaunay_2d()")
@checks("PyVista", "points.delaunay_2d(edge_source=lines)")
def _(test, there, here):
    test.assertLess(abs(area(here.surface) / HULL - 1), 0.01 if here.cloud.plane else 1e-9)
    if here.delaunay.GetSource():
        test.assertIn(tuple(sorted(CORNERS[:2])), edges(here.surface))
    if there is not None:
        test.assertGreater(area(there), 0.9 * HULL)


@checks("PyVista", "points.delaunay_2d(alpha=4)")
def _(test, _there, here):
    test.assertLessEqual(lengths(here.surface).max(), 6)


@checks("PyVista", "points.delaunay_2d().decimate(0.9)")
def _(test, there, here):
    test.assertLess(abs(area(here.surface) / HULL - 1), 1e-9)
    test.assertLessEqual(here.surface.GetNumberOfPoints(), 150)
    test.assertTrue(0 < here.report["simplified"]["largest_elevation_error"] < 1)
    if there is not None:
        test.assertLess(there.GetNumberOfPoints(), 300)


@checks("PyVista", "points.delaunay_2d(tol=0.001)")
@checks("PyVista", "points.delaunay_2d(offset=10, bound=False)")
def _(test, _there, here):
    test.assertGreater(area(here.surface), 0.8 * HULL)


# ---- CGAL's terrain tutorial, PDAL -------------------------------------------------------------


@checks("CGAL's terrain tutorial", "TIN dsm (points.points().begin(), points.points().end());")
def _(test, here, _printed):
    test.assertAlmostEqual(area(here["result"].surface), HULL, 6)


@checks("CGAL's terrain tutorial", "face_height(fh) > spacing")
def _(test, here, _printed):
    test.assertEqual(here["result"].report["points"], len(XYZ) - 100)


@checks("CGAL's terrain tutorial", "double limit = CGAL::square (5 * spacing);")
def _(test, here, _printed):
    test.assertEqual(here["result"].report["holes"]["open_edge_length"], 13)


@checks("CGAL's terrain tutorial", "extract_boundary_cycles")
def _(test, here, _printed):
    here["fill"].Update()
    test.assertEqual((here["fill"].GetNumberOfHoles(), here["fill"].GetNumberOfFilledHoles()), (1, 1))


@checks("CGAL's terrain tutorial", "isotropic_remeshing")
def _(test, here, _printed):
    report = here["result"].report
    test.assertGreater(report["unused_reasons"]["within the elevation error"], 0.8 * len(XYZ))
    test.assertLessEqual(here["result"].delaunay.GetLargestElevationError(), 0.5)


@checks("CGAL's terrain tutorial", "raster")
def _(test, here, _printed):
    test.assertEqual(here["grid"].z.shape, (100, 100))
    test.assertTrue(numpy.isnan(here["grid"].z).any())


@checks("CGAL's terrain tutorial", "isocontour_in_face")
def _(test, _here, _printed):
    test.assertGreater(features_of("survey_contours.gpkg"), 3)


@checks("PDAL", '{"type": "filters.delaunay"}')
def _(test, _here, _printed):
    test.assertAlmostEqual(area(read("survey_surface.vtp").points), HULL, 4)


@checks("PDAL", '{"type": "writers.ply", "filename": "mesh.ply", "faces": true}')
def _(test, _here, _printed):
    test.assertGreater(faces_of("mesh.ply"), 2000)


@checks("PDAL", '{"type": "filters.hexbin"}')
def _(test, _here, _printed):
    test.assertGreater(features_of("outlines.gpkg"), 0)


@checks("PDAL", '{"type": "filters.hexbin", "edge_length": 8}')
def _(test, _here, printed):
    test.assertIn("gap tolerance 6 spacings", printed)


@checks("PDAL", '{"type": "filters.hexbin", "threshold": 1}')
def _(test, _here, printed):
    test.assertIn("boundary found from the points", printed)


# ---- QGIS, GDAL --------------------------------------------------------------------------------


@checks("QGIS", "INTERPOLATION_DATA, points")
def _(test, _here, _printed):
    test.assertGreater(numpy.nanmin(pixels("points_grid.tif")[0]), 990)  # of the attribute


@checks("QGIS", "INTERPOLATION_DATA, break lines")
def _(test, _here, printed):
    test.assertIn("lines.gpkg: 2 points added", printed)


@checks("QGIS", "METHOD: Linear")
@checks("QGIS", "PIXEL_SIZE")
def _(test, _here, _printed):
    values, transform = pixels("points_grid.tif")
    test.assertEqual((transform[1], transform[5], transform[0] % 5), (5, -5, 0))
    test.assertGreater(numpy.nanmax(pixels("points_grid.tif", 2)[0]), 0)
    test.assertLess(numpy.nanmax(values), 20)


@checks("QGIS", "EXTENT")
def _(test, _here, _printed):
    test.assertEqual(pixels("points_grid.tif")[0].shape, (12, 12))


@checks("QGIS", "TRIANGULATION")
def _(test, _here, _printed):
    test.assertGreater(faces_of("surface.ply"), 2000)


@checks("CloudCompare and MetPy", "Ground: (constant) 0")
def _(test, _here, printed):
    test.assertIn("over level 0", printed)


@checks("CloudCompare and MetPy", "natural_neighbor_to_points(points, values, xi)")
def _(test, here, _printed):
    test.assertTrue(numpy.isfinite(here["value"]).all())
    test.assertLess(abs(here["value"] - XYZ[:, 2].mean()).max(), numpy.ptp(XYZ[:, 2]))


@checks("CloudCompare and MetPy", "natural_neighbor_to_grid(xp, yp, variable, hres=1.0)")
def _(test, here, _printed):
    test.assertGreater(numpy.isfinite(here["grid"].z).sum(), 100)


@checks("ParaView", "ResampleToImage(Input=surface, SamplingDimensions=[100, 100, 1])")
def _(test, here, _printed):
    test.assertEqual(here["grid"].z.shape, (100, 100))


@checks("ParaView", "PlotOverLine(Input=surface)")
def _(test, here, _printed):
    test.assertTrue(numpy.isfinite(here["value"]).any())
    test.assertEqual(here["value"].shape, here["xi"].shape[:1])


def compare_with_dem(test, here, there, band=1):
    """Known pixels stay on both sides. Returns what is missing: (theirs, ours)."""
    known = pixels("dem.tif", band)[0]
    there, here = pixels(there)[0], pixels(here)[0]
    test.assertEqual(known.shape, here.shape)
    numpy.testing.assert_allclose(numpy.where(numpy.isnan(known), numpy.nan, here), known, atol=1e-4)
    return numpy.isnan(there).sum(), numpy.isnan(here).sum()


@checks("GDAL", "gdal_fillnodata.py dem.tif filled.tif")
@checks("GDAL", "gdal_fillnodata.py -si 2 dem.tif filled.tif")
def _(test, _here, _printed):
    test.assertEqual(compare_with_dem(test, "filled.tif", "there.tif"), (0, 0))


@checks("GDAL", "gdal_fillnodata.py -md 3 dem.tif filled.tif")
def _(test, _here, _printed):
    theirs, ours = compare_with_dem(test, "filled.tif", "there.tif")
    test.assertTrue(0 < theirs < 144, theirs)
    test.assertEqual(ours, 144)


@checks("GDAL", "gdal_fillnodata.py -mask mask.tif dem.tif filled.tif")
def _(test, _here, _printed):
    test.assertEqual(compare_with_dem(test, "filled.tif", "there.tif"), (144, 144))


@checks("GDAL", "gdal_fillnodata.py -b 2 dem.tif filled.tif")
def _(test, _here, _printed):
    test.assertEqual(compare_with_dem(test, "filled.tif", "there.tif", 2), (0, 0))


def is_there(module):
    """Whether Python can import the other program; says so if not."""
    try:
        return importlib.import_module(module)
    except ImportError:
        print(f"{module} is not installed: its side of the table is not run")
        return None


class Migration(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def run_rows(self, section, run_row):
        """Calls run_row(code there, code here, check) for each row; each has a check, each check a row."""
        rows = rows_of(section)
        # A row is known by the code of its first cell; that of QGIS is a parameter, and words say which.
        named = [cell.replace("`", "") if section == "QGIS" else there for cell, there, _ in rows]
        self.assertEqual(sorted(named), sorted(name for where, name in CHECKS if where == section))
        for name, (_, there, here) in zip(named, rows):
            with self.subTest(section=section, there=name):
                run_row(there, here, CHECKS[section, name])

    def test_vtk_delaunay_2d(self):
        def run_row(there, here, check):
            check(self, delaunay_of(there, vtkDelaunay2D), delaunay_of(here, vtkGridDelaunay2D))

        self.run_rows("vtkDelaunay2D", run_row)

    def test_vtk_fill_holes_filter(self):
        def run_row(there, here, check):
            check(self, fill_of(there, vtkFillHolesFilter), fill_of(here, vtkFillElevationHoles))

        self.run_rows("vtkFillHolesFilter", run_row)

    def test_pyvista(self):
        pyvista = is_there("pyvista")

        def run_row(there, here, check):
            theirs, ours = names(), names()
            if pyvista:
                for known in (theirs, ours):
                    known.update({name: pyvista.wrap(known[name]) for name in ("points", "lines")})
                run_code(there, theirs)
            run_code(here, ours)
            check(self, theirs.get("value"), ours["value"])

        self.run_rows("PyVista", run_row)

    def run_here(self, code, check):
        for path in glob.glob("*_surface.*"):
            os.remove(path)
        known, printed = names(), ""
        if code.startswith("Utilities/reconstruct"):
            printed = run_commands(code + " --no-picture", ".")
        else:
            run_code(code, known)
        check(self, known, printed)

    def test_cgal(self):
        write_files()
        self.run_rows("CGAL's terrain tutorial", lambda _, here, check: self.run_here(here, check))

    def test_pdal(self):
        write_files()
        pdal = is_there("pdal")

        def run_row(there, here, check):
            stage = json.loads(there)
            if pdal:
                stages = ["survey.csv", {"type": "filters.delaunay"}, stage]
                pdal.Pipeline(json.dumps([s for i, s in enumerate(stages) if s not in stages[:i]])).execute()
            self.run_here(here, check)

        self.run_rows("PDAL", run_row)

    def test_qgis(self):
        write_files()
        self.run_rows("QGIS", lambda _, here, check: self.run_here(here, check))

    def test_cloud_compare_and_metpy(self):
        write_files()
        self.run_rows("CloudCompare and MetPy", lambda _, here, check: self.run_here(here, check))

    def test_paraview(self):
        self.run_rows("ParaView", lambda _, here, check: self.run_here(here, check))

    def test_gdal(self):
        write_files()

        def run_row(there, here, check):
            arguments = shlex.split(there)[1:-1]
            subprocess.run([sys.executable, "-m", "osgeo_utils.gdal_fillnodata", "-q", *arguments, "there.tif"],
                           check=True, stdout=subprocess.DEVNULL)
            self.run_here(here, check)
            os.remove("there.tif")

        self.run_rows("GDAL", run_row)


if __name__ == "__main__":
    unittest.main(argv=["TestMigration"])
