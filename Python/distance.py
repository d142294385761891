# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""How far points lie from a surface."""

import math

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance

from .clouds import cells_of, coordinates_of, make_points, slices, triangles_of
from .passes import near_triangles
from .ranks import all_values, collected, extremes, total

MOST_MEASURED = 1_000_000
AT_ONCE = 20_000  # points between two reports of progress
FEW = 0.01  # so many points for each triangle: then only triangles near them are searched


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
    triangles = triangles_of(surface)
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
    distance = distances(corners, used, triangles, away, progress, ranks) if others else away[:, 0]
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


def limits_of(ranks, points, used):
    """The lowest x, y and z of the points with a flag, on all ranks, and the highest."""
    ends = [numpy.zeros((0, 3), dtype=points.dtype)]
    for rows in slices(len(points)):
        some = points[rows] if used[rows].all() else points[rows][used[rows]]
        ends += [numpy.array([[find(some[:, i]) for i in range(3)]]) for find in (numpy.min, numpy.max) if len(some)]
    return tuple(zip(*(extremes(ranks, column) for column in numpy.concatenate(ends).T)))


def distances(corners, used, triangles, away, progress=None, ranks=None):
    """(n,) distances of the points `away` from the triangles of all ranks, whose corners are used."""
    low, high = numpy.array(limits_of(ranks, corners, used))
    # Near the origin, where doubles are finest; beyond 1e100 squares would be infinite.
    middle = 0.5 * low + 0.5 * high
    size = max(float(abs(low).max()), float(abs(high).max()), float(abs(away).max()))
    unit = 2.0 ** math.floor(math.log2(size)) if size > 1e100 else 1.0
    result = numpy.full(len(away), numpy.inf)
    if len(triangles):
        result = distances_here(corners, triangles, away, middle, unit, progress)
    return numpy.min(collected(ranks, result, "f8"), axis=0)


def distances_here(corners, triangles, away, middle, unit, progress):
    """(n,) distances of points from triangles of this rank, measured from the middle in units."""
    if unit == 1.0 and len(away) < FEW * len(triangles):
        triangles = triangles[near_triangles(corners, triangles, away)]
    ids, places = numpy.unique(triangles, return_inverse=True)
    bare = make_points(corners[ids] / unit - middle / unit)
    bare.SetPolys(cells_of(places.reshape(-1, 3)))
    search = vtkImplicitPolyDataDistance()
    search.SetInput(bare)
    away = away / unit - middle / unit
    result = numpy.empty(len(away))
    for i in range(0, len(away), AT_ONCE):
        if progress:
            progress(i / len(away))
        values = vtkDoubleArray()
        some = make_points(away[i : i + AT_ONCE])
        search.EvaluateFunction(some.GetPoints().GetData(), values)
        result[i : i + AT_ONCE] = vtk_to_numpy(values)
    # From so far away that triangles shrink to nothing, all of the surface is about as far.
    result = numpy.where(numpy.isnan(result), numpy.linalg.norm(away, axis=1), result)
    return unit * numpy.abs(result)
