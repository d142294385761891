# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The factor for z with which relief is seen."""

import math

import numpy

from .clouds import coordinates_of, make_points, triangles_of
from .messages import Messages
from .passes import corner_flags
from .ranks import all_values
from .vtkElevationSurface import vtkGridDelaunay2D

NICE = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
MOST_SAMPLES = 100_000  # points or triangles of a data set


def nice_number(value, steps=NICE):
    """The nearest round number, by ratio."""
    power = 10.0 ** math.floor(math.log10(value))
    choices = [s * p for p in (power, 10 * power) for s in steps]
    return min(choices, key=lambda c: abs(math.log(c / value)))


@numpy.errstate(all="ignore")
def choose_exaggeration(points, triangles):
    """The factor for z with which relief takes about a sixth of the surface's size.

    Less where the surface is rough: all but the steepest tenth of it stays below about 45 degrees.
    """
    used = points[corner_flags(triangles, len(points))]
    low, high = numpy.percentile(used[:, 2], (1, 99))
    extent = numpy.ptp(used[:, :2], axis=0)
    size = max(math.sqrt(extent[0] * extent[1]), 0.4 * float(extent.max()))
    if high <= low or size == 0.0:
        # Flat but for a few points: these must not be higher than the picture.
        relief = float(numpy.ptp(used[:, 2]))
        factor = 0.17 * size / relief if relief > 0.0 else 1.0
        return nice_number(factor) if 0.0 < factor < 1.0 else 1.0
    factor = 0.17 * size / (high - low)
    factor = min(factor, 1.1 / max(steepness(points, triangles), 1e-300))
    if not 0.0 < factor < math.inf or 0.8 <= factor <= 1.25:
        return 1.0
    return nice_number(factor)


def steepness(points, triangles):
    """The slope that a tenth of the surface exceeds."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    (ux, uy, uz), (vx, vy, vz) = (b - a).T, (c - a).T  # numpy.cross() takes several times as long
    area = numpy.abs(ux * vy - uy * vx)
    slope = numpy.hypot(uy * vz - uz * vy, uz * vx - ux * vz) / (area + 1e-300)
    order = numpy.argsort(slope)
    covered = numpy.cumsum(area[order])
    return slope[order[numpy.searchsorted(covered, 0.9 * covered[-1])]]


def point_exaggeration(data):
    """choose_exaggeration() of a sample of the points of a data set; 1 where there is no surface."""
    mesh = vtkGridDelaunay2D()
    mesh.SetInputData(make_points(few(coordinates_of(data)).astype("f8"), copy=False))
    with Messages(mesh, mesh.GetExecutive()):
        mesh.Update()
    return surface_exaggeration([mesh.GetOutput()])


def surface_exaggeration(surfaces, ranks=None):
    """choose_exaggeration() of a sample of the triangles of surfaces; 1 where there is none.

    ranks  the controller of those that have some of the surfaces each, or None
    """
    corners = [numpy.zeros((0, 9))]
    for surface in surfaces:
        triangles = few(triangles_of(surface))
        corners.append(coordinates_of(surface)[triangles].reshape(-1, 9).astype("f8"))
    corners = all_values(ranks, numpy.concatenate(corners).ravel(), "f8").reshape(-1, 3)
    triangles = numpy.arange(len(corners)).reshape(-1, 3)
    return choose_exaggeration(corners, triangles) if len(corners) else 1.0


def few(rows):
    """At most MOST_SAMPLES of these rows, evenly chosen."""
    return rows[:: 1 + len(rows) // MOST_SAMPLES]
