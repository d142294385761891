# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Contour lines and outlines, as GeoPackage, GeoJSON or DXF by OGR."""

import math

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkFiltersCore import vtkContourFilter, vtkStripper

from ..clouds import coordinates_of, id_lists, make_points, triangles_of
from ..gdal_common import reference_of, write_through_memory
from ..messages import ElevationSurfaceError
from ..passes import corner_flags
from ..paths import suffix_of

MOST_LEVELS = 10_000
LONGEST = 2**31 - 1  # points of a line
# OGR's driver and the options of a layer for each suffix.
DRIVERS = {
    ".gpkg": ("GPKG", []),
    ".geojson": ("GeoJSON", ["SIGNIFICANT_FIGURES=17"]),
    ".dxf": ("DXF", []),
}


def contours(surface, step, progress=None):
    """[(points, {"elevation": level})]: contour lines at the multiples of step.

    points are (n, 3); closed lines end where they begin. Raises ElevationSurfaceError where there
    would be more than MOST_LEVELS levels, or none.
    """
    triangles = triangles_of(surface)
    points = coordinates_of(surface).astype("f8", copy=False)
    used = corner_flags(triangles, len(points))
    low, high = points[used, 2].min(), points[used, 2].max()
    first, last = math.ceil(low / step), math.floor(high / step)
    if last < first:
        raise ElevationSurfaceError(
            f"no multiple of {step:g} lies between the elevations {low:g} and {high:g}: "
            "use a smaller contour step"
        )
    if last - first >= MOST_LEVELS:
        raise ElevationSurfaceError(
            f"contours every {step:g} would be {last - first + 1:,} levels; "
            f"at most {MOST_LEVELS:,} are drawn: use a larger contour step"
        )
    plain = make_points(numpy.where(used[:, None], points, points[triangles[0, 0]]))
    plain.SetPolys(surface.GetPolys())
    z = coordinates_of(plain)[:, 2]
    plain.GetPointData().SetScalars(numpy_to_vtk(z, deep=True))
    cut = vtkContourFilter()
    cut.SetInputData(plain)
    cut.SetOutputPointsPrecision(1)  # doubles
    cut.ComputeNormalsOff()
    cut.SetNumberOfContours(last - first + 1)
    for i in range(first, last + 1):
        cut.SetValue(i - first, i * step)
    join = vtkStripper()
    join.SetInputConnection(cut.GetOutputPort())
    join.SetMaximumLength(LONGEST)
    if progress:
        cut.AddObserver("ProgressEvent", lambda caller, _: progress(0.8 * caller.GetProgress()))
    join.Update()
    result = join.GetOutput()
    if not result.GetNumberOfLines():
        return []
    xyz = coordinates_of(result)
    lines = []
    for ids in id_lists(result.GetLines()):
        line = xyz[ids]
        level = step * round(line[0, 2] / step)
        line[:, 2] = level
        lines.append((line, {"elevation": level}))
    return lines


def outlines(result):
    """[(points, attributes)]: the boundary and the holes of a Reconstruction, as closed lines.

    kind is "boundary" or "hole"; holes have what the report says about them.
    """
    lines = []
    if result.boundary is not None and result.boundary.GetNumberOfLines():
        xyz = coordinates_of(result.boundary)
        lines += [(xyz[ids], {"kind": "boundary"}) for ids in id_lists(result.boundary.GetLines())]
    if result.holes is not None and result.holes.GetNumberOfLines():
        xyz = coordinates_of(result.holes)
        rows = result.report["holes"]["list"]
        for ids, hole in zip(id_lists(result.holes.GetLines()), rows):
            plain = {name: value for name, value in hole.items() if name not in ("box", "centre")}
            lines.append((xyz[ids], {"kind": "hole", **plain}))
    return lines


def write_lines(lines, path, layer, crs=None, progress=None):
    """Writes lines of contours() or outlines(). Returns notes. Raises OSError and FileError.

    layer  the layer's name
    crs    WKT or AUTHORITY:CODE, or None
    DXF has no attributes: z is the elevation there, and the layer names the kind.
    """
    from osgeo import ogr

    driver, options = DRIVERS[suffix_of(path)]
    crs = reference_of(crs)
    kinds = {}
    for _, values in lines:
        for name, value in values.items():
            if value is not None:
                kind = 0 if isinstance(value, int) else 1 if isinstance(value, float) else 2
                kinds[name] = max(kinds.get(name, 0), kind)
    types = (ogr.OFTInteger64, ogr.OFTReal, ogr.OFTString)

    def make(target):
        data = ogr.GetDriverByName(driver).CreateDataSource(target)
        table = data.CreateLayer(layer, crs, ogr.wkbLineString25D, options)
        if driver != "DXF":
            for name, kind in kinds.items():
                table.CreateField(ogr.FieldDefn(name, types[kind]))
        table.StartTransaction()
        for i, (points, values) in enumerate(lines):
            feature = ogr.Feature(table.GetLayerDefn())
            if driver == "DXF":
                values = {"Layer": values.get("kind", layer)}
            for name, value in values.items():
                if value is not None:
                    feature.SetField(name, value)
            feature.SetGeometry(ogr.CreateGeometryFromWkb(line_wkb(points)))
            table.CreateFeature(feature)
            if progress and i % 1000 == 0:
                progress(i / len(lines))
        table.CommitTransaction()

    write_through_memory(path, make)
    if driver == "GeoJSON" and not (crs is not None and crs.IsGeographic()):
        return [
            ".geojson holds x and y as they are; programs that follow RFC 7946 take them for "
            "longitude and latitude: .gpkg is safer"
        ]
    return []


def line_wkb(points):
    """(n, 3) -> a LineString Z as well-known binary."""
    head = numpy.array([1], "u1").tobytes() + numpy.array([1002, len(points)], "<u4").tobytes()
    return head + numpy.ascontiguousarray(points, "<f8").tobytes()
