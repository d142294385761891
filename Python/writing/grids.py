# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A surface as a grid: exact linear interpolation in its triangles, and files by GDAL."""

import dataclasses
import math

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from ..clouds import corner_flags, slices
from ..gdal_common import gdal_module, reference_of, write_through_memory
from ..messages import ElevationSurfaceError
from ..paths import plain_stem, suffix_of

MOST_PIXELS = 250_000_000
MOST_AT_ONCE = 2_000_000  # of rows or pixels of triangles; bounds the memory taken
NEAR = 1e-9  # steps: a centre so close to an edge lies on it


@dataclasses.dataclass(frozen=True)
class Grid:
    """Elevations at the centres of square pixels.

    z      (rows, columns) float64, north up; NaN outside the surface
    x, y   (columns,) and (rows,) coordinates of the centres; y falls
    error  (rows, columns) standard error of filled elevations, 0 where points are, NaN where it is
           not known; None where nothing was filled
    step   width of a pixel; the edges of pixels are multiples of it
    """

    z: numpy.ndarray
    x: numpy.ndarray
    y: numpy.ndarray
    error: object
    step: float


def grid_of(surface, step, progress=None):
    """The Grid of a surface: vtkPolyData with triangles; FilledError is its array of errors.

    Raises ElevationSurfaceError where the grid would be too large, or no pixel has its centre in
    the surface. Takes about a second for a million triangles and pixels each.
    """
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype("f8", copy=False)
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    used = corner_flags(triangles, len(points))
    (x0, x1), (y0, y1) = ((points[used, i].min(), points[used, i].max()) for i in (0, 1))
    first, last = [math.floor(v / step) for v in (x0, y0)], [math.ceil(v / step) for v in (x1, y1)]
    columns, rows = (max(1, b - a) for a, b in zip(first, last))
    if columns * rows > MOST_PIXELS:
        raise ElevationSurfaceError(
            f"a grid with a step of {step:g} would have {columns:,} x {rows:,} pixels; "
            f"at most {MOST_PIXELS:,} are made: use a larger step"
        )
    x = (first[0] + 0.5 + numpy.arange(columns)) * step
    y = (last[1] - 0.5 - numpy.arange(rows)) * step
    errors = surface.GetPointData().GetArray("FilledError")
    values = [points[:, 2]] + ([vtk_to_numpy(errors)] if errors else [])
    layers = [numpy.full(rows * columns, numpy.nan) for _ in values]
    for part in slices(len(triangles), MOST_AT_ONCE):
        if progress:
            progress(part.start / len(triangles))
        for ids, pixels, weights in covered(points, triangles[part], x, y, step):
            for layer, value in zip(layers, values):
                layer[pixels] = sum(w * value[ids[:, i]] for i, w in enumerate(weights))
    layers = [layer.reshape(rows, columns) for layer in layers]
    if not numpy.isfinite(layers[0]).any():
        raise ElevationSurfaceError(
            f"no pixel of a grid with a step of {step:g} has its centre in the surface: "
            "use a smaller step"
        )
    return Grid(layers[0], x, y, layers[1] if errors else None, step)


def covered(points, triangles, x, y, step):
    """Yields (corners, pixels, weights) of the pixels whose centres lie in triangles.

    corners  (n, 3) points; pixels (n,) places in the grid; weights three (n,) of the corners
    """

    def box(axis):
        a, b, c = (points[triangles[:, i], axis] for i in range(3))
        return (end(end(a, b), c) for end in (numpy.minimum, numpy.maximum))

    # Only triangles whose box has the centre of a pixel.
    low, high = box(0)
    reach = numpy.ceil((low - x[0]) / step - NEAR) <= numpy.floor((high - x[0]) / step + NEAR)
    triangles = triangles[reach]
    low, high = box(1)
    start = numpy.ceil((y[0] - high) / step - NEAR).astype("i8")
    stop = numpy.floor((y[0] - low) / step + NEAR).astype("i8") + 1
    start, stop = numpy.maximum(start, 0), numpy.minimum(stop, len(y))
    for owner, row in expanded(start, stop):
        corners = triangles[owner]
        left, right = crossed(points, corners, numpy.clip(y[row], low[owner], high[owner]))
        begin = numpy.ceil((left - x[0]) / step - NEAR).astype("i8")
        end = numpy.floor((right - x[0]) / step + NEAR).astype("i8") + 1
        begin, end = numpy.maximum(begin, 0), numpy.minimum(end, len(x))
        for place, column in expanded(begin, end):
            rows, ids = row[place], corners[place]
            # Twice the areas of the triangles that the centre makes with each side.
            dx = [points[ids[:, i], 0] - x[column] for i in range(3)]
            dy = [points[ids[:, i], 1] - y[rows] for i in range(3)]
            areas = [dx[i - 2] * dy[i - 1] - dx[i - 1] * dy[i - 2] for i in range(3)]
            total = areas[0] + areas[1] + areas[2]
            keep = total != 0.0
            weights = [area[keep] / total[keep] for area in areas]
            yield ids[keep], (rows * len(x) + column)[keep], weights


def expanded(start, stop):
    """Yields (places, numbers): each place with the numbers from its start to before its stop."""
    counts = numpy.maximum(stop - start, 0)
    ends = numpy.cumsum(counts)
    begin = 0
    while begin < len(counts):
        before = ends[begin - 1] if begin else 0
        end = max(begin + 1, int(numpy.searchsorted(ends, before + MOST_AT_ONCE, "right")))
        some = counts[begin:end]
        places = numpy.repeat(numpy.arange(begin, end), some)
        firsts = numpy.repeat(start[begin:end] - (ends[begin:end] - some - before), some)
        if len(places):
            yield places, firsts + numpy.arange(len(places))
        begin = end


def crossed(points, corners, y):
    """(left, right): where the horizontal lines at y, (n,), enter and leave the n triangles."""
    left, right = numpy.full(len(y), numpy.inf), numpy.full(len(y), -numpy.inf)
    for i in range(3):
        (ax, ay), (bx, by) = points[corners[:, i], :2].T, points[corners[:, i - 1], :2].T
        meets = (numpy.minimum(ay, by) <= y) & (y <= numpy.maximum(ay, by))
        share = numpy.divide(y - ay, by - ay, out=numpy.zeros(len(y)), where=ay != by)
        at = numpy.where(meets, ax + share * (bx - ax), numpy.nan)
        left, right = numpy.fmin(left, at), numpy.fmax(right, at)
    return left, right


def no_data_value(z):
    """A value for pixels outside that is no elevation."""
    return next(v for v in (-9999.0, -99999.0, -999999.0, -1e30) if not (z == v).any())


def write_grid(grid, path, crs=None, progress=None):
    """Writes a Grid as GeoTIFF, .asc or ZMAP+, told by the suffix. Returns notes for the user.

    GeoTIFF holds errors as a second band, and crs: WKT, AUTHORITY:CODE or None. Raises OSError and
    FileError.
    """
    suffix = suffix_of(path)
    progress = progress or (lambda fraction: None)
    FORMATS[suffix](grid, path, crs, progress)
    if grid.error is not None and suffix != ".tif":
        return [f"{suffix} holds one band: errors of filled elevations are left out"]
    return []


def raster(driver, path, grid, layers, options, progress):
    """A raster of GDAL that holds [(name, values)] as its bands."""
    gdal = gdal_module()
    rows, columns = grid.z.shape
    outside = no_data_value(grid.z)
    data = gdal.GetDriverByName(driver).Create(
        path, columns, rows, len(layers), gdal.GDT_Float64, options
    )
    left = math.floor(grid.x[0] / grid.step) * grid.step
    top = math.ceil(grid.y[0] / grid.step) * grid.step
    data.SetGeoTransform((left, grid.step, 0.0, top, 0.0, -grid.step))
    for number, (name, values) in enumerate(layers):
        band = data.GetRasterBand(number + 1)
        band.SetNoDataValue(outside)
        if name:
            band.SetDescription(name)
        for part in slices(rows, max(1, MOST_AT_ONCE // columns // 256 * 256)):
            some = values[part]
            band.WriteArray(numpy.where(numpy.isfinite(some), some, outside), 0, part.start)
            progress((number + part.stop / rows) / len(layers))
    return data


def write_tif(grid, path, crs, progress):
    layers = [("elevation", grid.z)]
    if grid.error is not None:
        layers.append(("FilledError", grid.error))
    options = ["COMPRESS=DEFLATE", "PREDICTOR=3", "TILED=YES", "BIGTIFF=IF_SAFER"]

    def make(name):
        data = raster("GTiff", name, grid, layers, options, progress)
        if crs:
            data.SetSpatialRef(reference_of(crs))
        data.FlushCache()

    write_through_memory(path, make)


def write_asc(grid, path, _crs, progress):
    """ESRI's grid; 17 digits bring doubles back to the last bit."""

    def make(name):
        data = raster("MEM", "", grid, [("", grid.z)], [], progress)
        options = ["SIGNIFICANT_DIGITS=17", "FORCE_CELLSIZE=TRUE"]
        gdal_module().GetDriverByName("AAIGrid").CreateCopy(name, data, False, options)

    write_through_memory(path, make)


def write_zmap(grid, path, _crs, progress):
    """ZMAP+ with nodes at the centres of pixels. GDAL's writer rounds the places of nodes."""
    rows, columns = grid.z.shape
    outside = no_data_value(grid.z)
    head = [
        "! elevations of a surface, columns from west to east, each from north to south",
        f"@{plain_stem(path)}, GRID, 5",
        f"20, {outside}, , 7, 1",
        f"{rows}, {columns}, "
        + ", ".join(repr(float(v)) for v in (grid.x[0], grid.x[-1], grid.y[-1], grid.y[0])),
        "0.0, 0.0, 0.0",
        "@",
    ]
    with open(path, "w", encoding="ascii", errors="replace", newline="\n") as stream:
        stream.write("\n".join(head) + "\n")
        for i in range(columns):
            column = grid.z[:, i]
            words = ["%#20.13g" % v for v in numpy.where(numpy.isfinite(column), column, outside)]
            lines = ("".join(words[j : j + 5]) for j in range(0, rows, 5))
            stream.write("\n".join(lines) + "\n")
            progress(i / columns)


def write_prj(path, crs):
    """The file beside an .asc that tells its coordinate reference system."""
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(reference_of(crs).ExportToWkt(["FORMAT=WKT1_ESRI"]) + "\n")


FORMATS = {".tif": write_tif, ".asc": write_asc, ".dat": write_zmap, ".zmap": write_zmap}
