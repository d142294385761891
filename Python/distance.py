# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""How far points lie from a surface."""

import math

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import vtkStaticPointLocator
from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance

from .clouds import cells_of, coordinates_of, corner_flags, make_points, slices
from .ranks import all_values, collected, extremes, total

MOST_MEASURED = 1_000_000
AT_ONCE = 20_000  # points between two reports of progress
FEW = 0.01  # so many points for each triangle: then only triangles near them are searched
BINS = 1024  # side by side, where triangles near points are looked for


def distance_to(surface, used, coordinates, chosen, progress=None, ranks=None, ids=None):
    """Distance of input points from a surface: max, mean and root mean square, as Metro gives them.

    used         (m,) of bool: which points of the surface are corners of triangles, on any rank
    coordinates  (n, 3), the input points; those that are points of the surface come first there too
    chosen       (n,) of bool: which of them are measured
    progress     None, or a function that is called with the fraction done
    ranks        the controller of those that have a part of the points and of the surface each, or None
    ids          of the points of this rank

    A point that is a corner of a triangle, with all three coordinates the same, has distance 0. For
    all others vtkImplicitPolyDataDistance finds the closest place of the surface; that takes some 10
    to 40 microseconds a point. Of more than MOST_MEASURED others, every k-th is measured and stands
    for k; "measured" is their number.
    """
    corners = coordinates_of(surface).astype("f8", copy=False)
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    away = chosen.copy()
    first, flags = corners[: len(coordinates)], used[: len(coordinates)]
    for rows in slices(len(coordinates)):
        away[rows] &= ~(flags[rows] & (first[rows] == coordinates[rows]).all(axis=1))
    away = numpy.flatnonzero(away)
    others = total(ranks, len(away))
    away = away[:: max(1, -(-others // MOST_MEASURED))]
    if ranks:
        order = numpy.argsort(all_values(ranks, ids[away]), kind="stable")
    away = all_values(ranks, coordinates[away].ravel(), "f8").reshape(-1, 3)
    away = away[order] if ranks else away
    distance = distances(corners, triangles, away, progress, ranks) if others else away[:, 0]
    count = total(ranks, numpy.count_nonzero(chosen))
    share = others / max(len(away), 1) / count
    maximum = float(distance.max(initial=0.0))
    unit = maximum if maximum > 1e100 else 1.0  # squares of larger ones would be infinite
    return {
        "points": count,
        "points_not_corners": others,
        "measured": len(away),
        "maximum": maximum,
        "mean": float(distance.sum() * share),
        "rms": float(unit * math.sqrt(((distance / unit) ** 2).sum() * share)),
    }


def distances(corners, triangles, away, progress=None, ranks=None):
    """(n,) distances of the points `away` from the triangles of all ranks."""
    is_corner = corner_flags(triangles, len(corners))
    low, high = numpy.transpose([extremes(ranks, corners[is_corner, i]) for i in range(3)])
    # Near the origin, where doubles are finest; beyond 1e100 squares would be infinite.
    middle = 0.5 * low + 0.5 * high
    size = max(float(abs(low).max()), float(abs(high).max()), float(abs(away).max()))
    unit = 2.0 ** math.floor(math.log2(size)) if size > 1e100 else 1.0
    result = numpy.full(len(away), numpy.inf)
    if len(triangles):
        result = distances_here(corners, is_corner, triangles, away, middle, unit, progress)
    return numpy.min(collected(ranks, result, "f8"), axis=0)


def distances_here(corners, is_corner, triangles, away, middle, unit, progress):
    """(n,) distances of points from triangles of this rank, measured from the middle in units."""
    if unit == 1.0 and len(away) < FEW * len(triangles):
        triangles = triangles[near(corners, is_corner, triangles, away, progress)]
        is_corner = corner_flags(triangles, len(corners))
    ids = numpy.flatnonzero(is_corner)
    places = numpy.zeros(len(corners), dtype="i8")
    places[ids] = numpy.arange(len(ids))
    bare = make_points(corners[ids] / unit - middle / unit)
    bare.SetPolys(cells_of(places[triangles]))
    search = vtkImplicitPolyDataDistance()
    search.SetInput(bare)
    away = away / unit - middle / unit
    result = numpy.empty(len(away))
    for i in range(0, len(away), AT_ONCE):
        if progress:
            progress(0.5 + 0.5 * i / len(away))
        values = vtkDoubleArray()
        some = make_points(away[i : i + AT_ONCE])
        search.EvaluateFunction(some.GetPoints().GetData(), values)
        result[i : i + AT_ONCE] = vtk_to_numpy(values)
    # From so far away that triangles shrink to nothing, all of the surface is about as far.
    result = numpy.where(numpy.isnan(result), numpy.linalg.norm(away, axis=1), result)
    return unit * numpy.abs(result)


def near(corners, is_corner, triangles, away, progress=None):
    """(m,) of bool: the triangles among which each point has its closest one, and some more.

    No triangle is closer to a point than its closest corner, but those whose box in x,y meets the
    square around the point that has that distance.
    """
    ids = numpy.flatnonzero(is_corner)
    locator = vtkStaticPointLocator()
    points = make_points(corners[ids])
    locator.SetDataSet(points)
    closest = [locator.FindClosestPoint(point) for point in away.tolist()]
    reach = 1.000001 * numpy.linalg.norm(corners[ids[closest]] - away, axis=1)[:, None]
    low = numpy.array([corners[ids, i].min() for i in (0, 1)])
    high = numpy.array([corners[ids, i].max() for i in (0, 1)])

    def bins(xy):
        places = numpy.nan_to_num((xy - low) / (high - low) * BINS)  # no corners, but in the first bin
        return numpy.clip(places, 0, BINS - 1).astype("i2").T

    # How many squares lie over each bin, and then over all bins before it: sums of differences.
    over = numpy.zeros((BINS + 1, BINS + 1), dtype="i4")
    (x0, y0), (x1, y1) = bins(away[:, :2] - reach), bins(away[:, :2] + reach) + 1
    for x, y, sign in ((x0, y0, 1), (x1, y1, 1), (x0, y1, -1), (x1, y0, -1)):
        numpy.add.at(over, (x, y), sign)
    before = numpy.zeros((BINS + 2, BINS + 2), dtype="i4")
    before[1:, 1:] = (over.cumsum(axis=0).cumsum(axis=1) > 0).cumsum(axis=0).cumsum(axis=1)
    places = numpy.empty((2, len(corners)), dtype="i2")
    for rows in slices(len(corners)):
        places[:, rows] = bins(corners[rows, :2])
    result = numpy.empty(len(triangles), dtype=bool)
    for rows in slices(len(triangles)):
        if progress:
            progress(0.5 * rows.start / len(triangles))
        (x0, x1), (y0, y1) = (
            (numpy.minimum(numpy.minimum(a, b), c), numpy.maximum(numpy.maximum(a, b), c) + 1)
            for a, b, c in ((at[corners] for corners in triangles[rows].T) for at in places)
        )
        result[rows] = before[x1, y1] - before[x0, y1] - before[x1, y0] + before[x0, y0] > 0
    return result
