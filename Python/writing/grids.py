# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A surface as a grid, and files by GDAL."""

import dataclasses
import math
import os

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from ..clouds import EVEN, Frame, add_array, cells_of, check_system, coordinates_of, make_points, slices, triangles_of
from ..gdal_common import gdal_module, reference_of, write_through_memory
from ..messages import ElevationSurfaceError, FileError
from ..passes import corner_flags
from ..paths import check_suffix, plain_stem, suffix_of
from ..progress import no_progress
from ..query import Heights
from ..reading import raster_frame

MOST_PIXELS = 250_000_000
MOST_AT_ONCE = 2_000_000  # pixels; bounds the memory taken
FLAT = 1e-14  # twice the area of a triangle over the products that it is the difference of: less is rounding
ON_NODE = 0.01  # steps: points so close to the nodes of a lattice are on them


@dataclasses.dataclass(frozen=True)
class Grid:
    """Elevations at the centres of pixels.

    z      (rows, columns) float64; NaN outside the surface
    error  (rows, columns) standard error of filled elevations, 0 where points are, NaN where it is
           not known; None where nothing was filled
    frame  the Frame of the pixels
    crs    the coordinate reference system as WKT or AUTHORITY:CODE, or None
    """

    z: numpy.ndarray
    error: object
    frame: Frame
    crs: object = None

    @property
    def x(self):
        """(columns,) x of the centres; (rows, columns) where the grid is turned."""
        return self.frame.centres()[0]

    @property
    def y(self):
        """(rows,) y of the centres, which falls; (rows, columns) where the grid is turned."""
        return self.frame.centres()[1]

    @property
    def step(self):
        """The width of a pixel."""
        return math.hypot(self.frame.transform[1], self.frame.transform[4])

    def __sub__(self, other):
        """The Grid of differences of two surfaces at the same pixels. Raises ValueError."""
        if not self.frame.is_same(other.frame):
            raise ValueError("the two grids have different pixels: make one by to_grid(like=the other)")
        errors = [grid.error for grid in (self, other) if grid.error is not None]
        error = numpy.sqrt(sum(error**2 for error in errors)) if errors else None
        return dataclasses.replace(self, z=self.z - other.z, error=error)

    def write(self, path):
        """Writes the grid in the format of the suffix: .tif, .asc, or .dat or .zmap for ZMAP+.

        Returns notes, one line each. Raises OSError, and FileError for another suffix.
        """
        path = os.fspath(path)
        check_suffix(path, tuple(FORMATS), "written as a grid")
        notes = write_grid(self, path)
        for other in side_files(path) if self.crs else []:
            write_prj(other, self.crs)
        return notes


def step_frame(surface, step):
    """(Frame of square pixels over a surface, 0); their edges are multiples of step."""
    (x0, x1), (y0, y1) = extent_of(coordinates_of(surface), surface)
    first, last = [math.floor(v / step) for v in (x0, y0)], [math.ceil(v / step) for v in (x1, y1)]
    columns, rows = (max(1, b - a) for a, b in zip(first, last))
    return Frame((first[0] * step, step, 0.0, last[1] * step, 0.0, -step), columns, rows), 0.0


def extent_of(points, surface):
    """(lowest, highest) of each of the first two columns of the points that triangles use."""
    used = points[corner_flags(triangles_of(surface), len(points)), :2].astype("f8")
    return list(zip(used.min(axis=0), used.max(axis=0)))


def lattice_frame(lattice, surface):
    """The Frame whose centres are the nodes of a lattice, see lattice_of(), that a surface covers."""
    steps = sorted(lattice["steps"], key=lambda step: abs(step[0]) / math.hypot(*step))
    down, across = (numpy.array(step) for step in steps)
    across = across if across[0] > 0 else -across
    down = down if across[0] * down[1] < across[1] * down[0] else -down
    x, y = lattice["origin"] - 0.5 * (across + down)
    nodes = Frame((x, across[0], down[0], y, across[1], down[1]), 1, 1)
    places = nodes.places(coordinates_of(surface)[:, :2].astype("f8"))
    (left, right), (top, bottom) = extent_of(places, surface)
    low = math.ceil(left - ON_NODE), math.ceil(top - ON_NODE)
    return nodes.part(low, (math.floor(right + ON_NODE) + 1, math.floor(bottom + ON_NODE) + 1))


def own_frame(result):
    """(Frame of the raster or lattice that the points of a Reconstruction are from, how far in steps
    they may be from centres); (None, 0) for other points."""
    if result.cloud.frame:
        return result.cloud.frame, 0.0
    return (lattice_frame(result.lattice, result.surface), ON_NODE) if result.lattice else (None, 0.0)


def frame_for(result, step, like):
    """(Frame, how far points may be from its centres) of a grid as to_grid() takes its arguments."""
    if like is not None:
        frame, crs = (like.frame, like.crs) if hasattr(like, "frame") else raster_frame(like)
        name = "like" if hasattr(like, "frame") else os.fspath(like)
        if frame is None:
            raise ElevationSurfaceError(f"{name}: has no raster with even steps")
        notes = check_system(name, crs, "the surface", result.crs)
        return frame, own_frame(result)[1], notes
    frame, near = own_frame(result)
    if step is None and frame is None:
        raise ElevationSurfaceError("a step is needed: the points are not from a raster or lattice with even steps")
    square = frame and (abs(numpy.array(frame.transform)[[1, 2, 4, 5]]) - (step, 0, 0, step) if step else 0.0)
    if step is None or frame and abs(square).max() <= EVEN * step:
        return frame, near, []
    return *step_frame(result.surface, step), []


def grid_of(result, step=None, like=None, progress=None, method="linear"):
    """(Grid of the surface of a Reconstruction, notes); arguments are those of to_grid().

    Raises ElevationSurfaceError where the grid would be too large, or no pixel has its centre in
    the surface. Takes about a second for a million triangles and pixels each.
    """
    frame, near, notes = frame_for(result, step, like)
    words = f"a grid with a step of {frame.transform[1]:g}"
    if frame.columns * frame.rows > MOST_PIXELS:
        raise ElevationSurfaceError(
            f"{words} would have {frame.columns:,} x {frame.rows:,} pixels; "
            f"at most {MOST_PIXELS:,} are made: use a larger step"
        )
    z, error = interpolated(result.surface, frame, near, progress, method)
    if not numpy.isfinite(z).any() and like is not None:
        west, east, south, north = result.surface.GetBounds()[:4]
        x, y = (ends.ravel()[[0, -1]] for ends in frame.centres())
        name = "like" if hasattr(like, "frame") else like
        raise ElevationSurfaceError(
            f"no pixel of {name} has its centre in the surface: it is from x,y {x.min():.7g}, {y.min():.7g} to "
            f"{x.max():.7g}, {y.max():.7g}, the surface from {west:.7g}, {south:.7g} to {east:.7g}, {north:.7g}"
        )
    if not numpy.isfinite(z).any():
        raise ElevationSurfaceError(
            f"no pixel of {words} has its centre in the surface: use a smaller step"
        )
    return Grid(z, error, frame, result.crs), notes


def interpolated(surface, frame, near=0.0, progress=None, method="linear"):
    """(rows, columns) elevations and their errors, or None, at the centres of a Frame.

    near  steps: points so close to a centre are on it
    """
    # Over columns and rows, where centres are whole numbers: what lies on one is exact.
    heights, rows = Heights(on_pixels(surface, frame, near)), numpy.arange(frame.rows, dtype="f8")
    smooth = None if method == "linear" else Heights(surface, method)
    layers = [numpy.empty((frame.rows, frame.columns)) for _ in range(1 if heights.errors is None else 2)]
    for part in slices(frame.rows, max(1, MOST_AT_ONCE // frame.columns)):
        column, row = (each.ravel() for each in numpy.meshgrid(numpy.arange(frame.columns, dtype="f8"), rows[part]))
        found = heights.at(numpy.column_stack((column, row)))
        if smooth:
            z, _ = smooth.at(numpy.column_stack(frame.at(column, row)))
            known = numpy.isfinite(found[0]) & numpy.isfinite(z)
            found[0][known] = z[known]
        for layer, values in zip(layers, found):
            layer[part] = values.reshape(-1, frame.columns)
        if progress:
            progress(part.stop / frame.rows)
    return layers[0], layers[1] if len(layers) > 1 else None


def on_pixels(surface, frame, near):
    """The surface over columns and rows, without triangles that have no area there."""
    points = coordinates_of(surface).astype("f8")
    points[:, :2] = on_centres(frame, points[:, :2], near)
    triangles = triangles_of(surface)
    a, b, c = (points[triangles[:, i], :2] for i in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    errors, ids = surface.GetPointData().GetArray("FilledError"), surface.GetCellData().GetArray("HoleId")
    placed = make_points(points)
    left, right = ux * vy, uy * vx
    has_area = abs(left - right) > FLAT * (abs(left) + abs(right))
    placed.SetPolys(cells_of(triangles[has_area]))
    for kind, array, rows in (("Point", errors, slice(None)), ("Cell", ids, has_area)):
        if array is not None:
            add_array(placed, array.GetName(), vtk_to_numpy(array)[rows], kind)
    return placed


def on_centres(frame, xy, near):
    """(n, 2) columns and rows of points. A point that is a centre but for rounding is one."""
    places = frame.places(xy)
    finite = abs(xy[numpy.isfinite(xy)]).max(initial=0.0)
    rounding = 8.0 * numpy.spacing(finite) / min(numpy.hypot(*numpy.reshape(frame.transform, (2, 3))[:, 1:]))
    whole = numpy.rint(places)
    is_near = abs(places - whole).max(axis=1) <= max(near, rounding)
    places[is_near] = whole[is_near]
    return places


def no_data_value(z):
    """A value for pixels outside that does not occur as an elevation."""
    return next(v for v in (-9999.0, -99999.0, -999999.0, -1e30) if not (z == v).any())


def write_grid(grid, path, progress=no_progress):
    """Writes a Grid as GeoTIFF, .asc or ZMAP+, by the suffix. Returns notes for the user.

    GeoTIFF holds errors as a second band, and the coordinate reference system. Raises OSError and
    FileError.
    """
    suffix = suffix_of(path)
    FORMATS[suffix](grid, path, progress)
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
    data.SetGeoTransform(grid.frame.transform)
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


def write_tif(grid, path, progress):
    layers = [("elevation", grid.z)]
    if grid.error is not None:
        layers.append(("FilledError", grid.error))
    options = ["COMPRESS=DEFLATE", "PREDICTOR=3", "TILED=YES", "BIGTIFF=IF_SAFER"]

    def make(name):
        data = raster("GTiff", name, grid, layers, options, progress)
        if grid.crs:
            data.SetSpatialRef(reference_of(grid.crs))
        data.FlushCache()

    write_through_memory(path, make)


def upright(grid, path):
    """The grid with columns from west to east and rows from north to south. Raises FileError where it
    is turned."""
    frame = grid.frame
    if frame.is_turned():
        raise FileError(f"{path}: {suffix_of(path)} has no turned grids; write .tif")
    (x, dx, _, y, _, dy), z = frame.transform, grid.z[:: 1 if frame.transform[5] < 0 else -1]
    x, y, z = x + min(dx, 0) * frame.columns, y + max(dy, 0) * frame.rows, z[:, :: 1 if dx > 0 else -1]
    frame = Frame((x, abs(dx), 0.0, y, 0.0, -abs(dy)), frame.columns, frame.rows)
    return dataclasses.replace(grid, z=z, frame=frame)


def write_asc(grid, path, progress):
    """ESRI's grid; 17 digits bring doubles back to the last bit."""
    grid = upright(grid, path)
    steps = grid.frame.transform[1], -grid.frame.transform[5]

    def make(name):
        data = raster("MEM", "", grid, [("", grid.z)], [], progress)
        options = ["SIGNIFICANT_DIGITS=17", f"FORCE_CELLSIZE={'YES' if steps[0] == steps[1] else 'NO'}"]
        gdal_module().GetDriverByName("AAIGrid").CreateCopy(name, data, False, options)

    write_through_memory(path, make)


def write_zmap(grid, path, progress):
    """ZMAP+ with nodes at the centres of pixels. GDAL's writer rounds the places of nodes."""
    grid = upright(grid, path)
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


def side_files(path):
    """Other files that belong to the file of a result: an .asc has its .prj."""
    return [os.path.splitext(path)[0] + ".prj"] if suffix_of(path) == ".asc" else []


def write_prj(path, crs):
    """The file next to an .asc that holds its coordinate reference system."""
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(reference_of(crs).ExportToWkt(["FORMAT=WKT1_ESRI"]) + "\n")


FORMATS = {".tif": write_tif, ".asc": write_asc, ".dat": write_zmap, ".zmap": write_zmap}
