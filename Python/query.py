# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a surface answers: its height at places, and the volume between it and another one."""

import dataclasses
import math
import os
from typing import Optional

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.util.vtkConstants import VTK_DOUBLE
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import vtkPolyData

from .clouds import add_array, cells_of, coordinates_of, crs_of, make_points, slices, triangles_of
from .gdal_common import check_system, is_near, moving, name_of, one_line, same_system
from .messages import ElevationSurfaceError, FileError, counted_reason
from .passes import corner_flags
from .progress import no_progress
from .properties import METHODS
from .reading import read
from .reading.formats import recognise
from .reading.text import read_table
from .reading.unpacking import unpacked
from .vtkElevationSurface import vtkGridDelaunay2D
from .vtkElevationSurfacePieces import vtkSurfaceQuery

MOST_AT_ONCE = 2_000_000  # places; bounds the memory taken
SLIVER = 1e-9  # of an area: less is rounding


def query_of(name, surface, progress=no_progress):
    """The vtkSurfaceQuery of a surface. Raises ElevationSurfaceError, with its name."""
    query = vtkSurfaceQuery()
    raise_error(name, query.SetSurface(surface))

    def show(_query, _event, fraction):
        progress(fraction)

    show.CallDataType = VTK_DOUBLE
    query.AddObserver("ProgressEvent", show)
    return query


def raise_error(name, error):
    """Raises what a vtkSurfaceQuery returns, if it is an error."""
    if error:
        raise ElevationSurfaceError(f"{name}: {error[0].lower()}{error[1:].rstrip('.')}")


def check_over_xy(result, what):
    """Refuses a Reconstruction that is not over x and y."""
    if result.cloud.plane:
        raise ElevationSurfaceError(f"a surface with plane=best has no {what} over x,y")


class Heights:
    """Interpolates the elevations of a surface, and the errors of filled ones, at places.

    method  "linear", in triangles; "natural-neighbor", by Sibson's weights of the surface's points
    """

    def __init__(self, surface, method="linear"):
        if method not in METHODS:
            raise ValueError(f"method takes {' or '.join(METHODS)}, not {method!r}")
        self.linear = query_of("the surface", surface)
        self.natural = None
        if method != "linear":
            # Patches and trimming may leave triangles that are not Delaunay.
            delaunay = vtkGridDelaunay2D()
            delaunay.SetInputData(used_alone(surface))
            delaunay.Update()
            self.natural = query_of("the surface", delaunay.GetOutput())
        filled = holes_of(surface)
        self.errors = surface.GetPointData().GetArray("FilledError") if (filled >= 0).any() else None

    def at(self, xy, progress=no_progress):
        """(elevations, errors or None) at (n, 2) places, NaN outside."""
        layers = [numpy.empty(len(xy)) for _ in range(1 if self.errors is None else 2)]
        for part in slices(len(xy), MOST_AT_ONCE):
            places = numpy.ascontiguousarray(xy[part], dtype="f8")
            found = interpolated(self.linear, False, places, self.errors)
            if self.natural:
                inside = ~numpy.isnan(found[0])
                found[0][inside] = interpolated(self.natural, True, places[inside])[0]
            for layer, values in zip(layers, found):
                layer[part] = values
            progress(part.stop / len(xy))
        return layers[0], layers[1] if len(layers) > 1 else None


def interpolated(query, are_natural, places, values=None):
    """[(n,)] elevations at places, NaN where no triangle is, and values of points, a vtkDataArray or None."""
    elevations, others = vtkDoubleArray(), vtkDoubleArray()
    raise_error("places", query.Interpolate(numpy_to_vtk(places), are_natural, values, elevations, others))
    return [vtk_to_numpy(array) for array in (elevations, others)[: 1 if values is None else 2]]


def used_alone(surface):
    """The points of a surface, where those that no triangle uses are not finite: they keep numbers."""
    xyz = coordinates_of(surface).astype("f8")
    xyz[~corner_flags(triangles_of(surface), len(xyz))] = numpy.nan
    return make_points(xyz)


def places_of(xy):
    """(n, 2) doubles of what a user gives. Raises ValueError that says what is needed."""
    try:
        array = numpy.ma.asarray(xy)
        if array.dtype.kind not in "fiu":
            raise TypeError
    except (TypeError, ValueError):
        raise ValueError("xy: rows of x and y are needed, as numbers") from None
    array = array.astype("f8").filled(numpy.nan)
    array = array[None] if array.shape == (2,) else array.reshape(-1, 2) if array.size == 0 else array
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        shape = " x ".join(map(str, array.shape)) or "a single number"
        raise ValueError(f"xy: rows of x and y are needed; the shape is {shape}")
    return array[:, :2]


@dataclasses.dataclass(frozen=True)
class Volume:
    """What lies between a surface and another one, or a level, over the area that both cover.

    above  volume where the surface is higher: what has to be cut to come down to the other one
    below  volume where it is lower: what has to be filled
    area   that both cover, in x,y
    left_out        area of the surface that the other one does not cover
    other_left_out  area of the other one that the surface does not cover; 0 for a level
    error  the standard error of net that follows from FilledError, of both: within a hole, errors are
           taken to be the same everywhere; those of several holes, to be independent. None where
           neither has been filled, NaN where an error is not known
    """

    above: float
    below: float
    area: float
    left_out: float
    other_left_out: float
    error: Optional[float]

    @property
    def net(self):
        """above - below: the volume of the surface over the other one."""
        return self.above - self.below


def volume_between(result, other, map_too=False, progress=no_progress):
    """(Volume, its map as vtkPolyData or None, notes) of a Reconstruction and what other_of() takes."""
    check_over_xy(result, "volume")
    other = other_of(other)
    name, surface = other.name, other.surface
    notes = check_system(name, other.crs, "the surface", result.crs) if surface else []
    own = query_of("the surface", result.surface, progress)
    theirs = surface and query_of(name, surface)
    difference = vtkPolyData() if map_too else None
    sums, error = compare(result.surface, own, theirs, other.level, difference)
    area, common, above, below = (math.fsum(column) for column in sums.T[:4])
    other_area = area_of(surface) if theirs else common
    if theirs and common <= SLIVER * min(area, other_area):
        boxes = [
            "x {:.7g} to {:.7g}, y {:.7g} to {:.7g}".format(*one.GetBounds()[:4])
            for one in (surface, result.surface)
        ]
        raise ElevationSurfaceError(
            f"{name} and the surface do not overlap: {name} is from {boxes[0]}, the surface from {boxes[1]}; "
            "are both in the same coordinates?"
        )
    for who, is_covered_twice in (
        (name, (sums[:, 1] > sums[:, 0] + SLIVER * area).any()), ("the surface", common > (1 + SLIVER) * other_area),
    ):
        if theirs and is_covered_twice:
            raise ElevationSurfaceError(f"{who} has triangles that overlap in x,y: it is no elevation surface")
    filled = theirs and filled_alone(surface)
    if filled:
        back = compare(filled, query_of(name, filled), own)[1]
        error = math.hypot(error or 0.0, back)
    if map_too:
        elevations = numpy_to_vtk(coordinates_of(difference)[:, 2], deep=True)
        elevations.SetName("Difference")
        difference.GetPointData().SetScalars(elevations)
    left_out = (max(0.0, whole - common) for whole in (area, other_area))
    return Volume(above, below, common, *left_out, error), difference, notes


def compare(surface, query, other, level=0.0, difference=None):
    """(tuples of vtkSurfaceQuery.CompareWith(), standard error of the volume by this surface's filled
    elevations; None where it has none)."""
    tuples, holes = vtkDoubleArray(), holes_of(surface)
    errors = surface.GetPointData().GetArray("FilledError") if (holes >= 0).any() else None
    raise_error("the surface", query.CompareWith(other, level, errors, tuples, difference))
    tuples = vtk_to_numpy(tuples)
    if errors is None:
        return tuples, None
    of_holes = numpy.bincount(holes[holes >= 0], tuples[holes >= 0, 4])
    return tuples, float(numpy.sqrt((of_holes**2).sum()))


def filled_alone(surface):
    """The triangles of a surface that fill holes, with what compare() needs; None where there are none."""
    errors, holes = surface.GetPointData().GetArray("FilledError"), holes_of(surface)
    if errors is None or not (holes >= 0).any():
        return None
    filled = vtkPolyData()
    filled.SetPoints(surface.GetPoints())
    filled.SetPolys(cells_of(triangles_of(surface)[holes >= 0]))
    filled.GetPointData().AddArray(errors)
    add_array(filled, "HoleId", holes[holes >= 0], "Cell")
    return filled


def holes_of(surface):
    """(m,) of the hole that each triangle fills, -1 of other ones, as vtkFillElevationHoles numbers them."""
    ids = surface.GetCellData().GetArray("HoleId")
    if ids is None or ids.GetNumberOfTuples() != surface.GetNumberOfPolys():
        return numpy.full(surface.GetNumberOfPolys(), -1)
    return vtk_to_numpy(ids).astype("i8")


def area_of(surface):
    """The area of a surface's triangles in x,y."""
    corners = triangles_of(surface).T.astype("i8")
    xyz = coordinates_of(surface)
    # x and y apart: numpy takes numbers faster than rows.
    (xa, xb, xc), (ya, yb, yc) = (xyz[:, axis].astype("f8").take(corners) for axis in (0, 1))
    return 0.5 * math.fsum(abs((xb - xa) * (yc - ya) - (yb - ya) * (xc - xa)))


@dataclasses.dataclass(frozen=True)
class Other:
    """What a volume is measured to: a surface, vtkPolyData with triangles; or, where that is None, a level."""

    name: str
    surface: Optional[vtkPolyData] = None
    crs: Optional[str] = None
    level: float = 0.0


def other_of(other):
    """The Other of a Reconstruction, vtkPolyData, the file of a surface, or a number."""
    if isinstance(other, Other):
        return other
    if hasattr(other, "surface"):
        check_over_xy(other, "volume")
        return Other("the other surface", other.surface, other.crs)
    if isinstance(other, (str, os.PathLike)):
        return read_surface(os.fspath(other))
    if isinstance(other, vtkPolyData):
        if other.GetNumberOfPolys() == 0:
            raise ElevationSurfaceError("the other surface has no triangles")
        return Other("the other surface", other)
    try:
        if isinstance(other, bool):
            raise TypeError
        level = float(other)
    except (TypeError, ValueError):
        raise TypeError(
            "a Reconstruction, vtkPolyData with triangles, a file or a level is needed, "
            f"not {type(other).__name__}"
        ) from None
    if not math.isfinite(level):
        raise ValueError(f"a level is a finite number, not {level}")
    return Other(f"level {level:g}", level=level)


def read_surface(path):
    """The Other of a file with triangles. Raises FileError."""
    points = read(path).points if not is_text(path) else None
    if not isinstance(points, vtkPolyData) or points.GetNumberOfPolys() == 0:
        raise FileError(f"{path}: has no triangles: make a surface of it first, and give that")
    return Other(path, points, crs_of(points))


def is_text(path):
    """Whether a file is a table of text."""
    with unpacked(path) as (local, _):
        return recognise(local)[0].module == "text.read_text"


def read_places(path):
    """((n, 2) places of a file, its reference system or None, notes): of text, the columns x and y; of other
    files their points, whatever their z is. Raises FileError."""
    with unpacked(path) as (local, _):
        module = recognise(local)[0].module
        if module == "text.read_text":
            rows, _, _, notes = read_table(local, 2)
            return rows, None, [f"{path}: {note}" for note in notes]
        if module == "vectors":
            from .reading.vectors import read_flat_points

            return (*read_flat_points(local), [])
    cloud = read(path, keep_nulls=True, points_only=True)
    notes = [f"{path}: {counted_reason(count, reason)} left out" for reason, count in cloud.left_out.items()]
    return coordinates_of(cloud.points)[:, :2].astype("f8"), cloud.crs, notes


def places_in(crs, places, own, name, points_name, strict=False):
    """((n, 2) places as a surface of some reference system has them, notes): those of a file with its own
    system, or None, by read_places(). Raises FileError; with strict, where they would be reprojected."""
    if strict or same_system(own, crs) is not False or is_near(own, crs):
        return places, check_system(name, own, points_name, crs)
    try:
        moved = moving(own, crs)(places)
    except RuntimeError as error:
        raise FileError(
            f"{name}: cannot be reprojected from {name_of(own)} to {name_of(crs)}: {one_line(error)}"
        ) from None
    return moved, [
        f"{name} is in {name_of(own)}, {points_name} in {name_of(crs)}: reprojected by OGR; its table has the "
        "places of the file"
    ]
