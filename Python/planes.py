# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Clouds that lie in a plane other than x,y, on a wall say: how they are turned."""

import numpy
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes

from .clouds import bare_lines, coordinates_of, heights_of, marked_points, moved
from .messages import ElevationSurfaceError
from .names import argument
from .ranks import all_values

MOST_SAMPLES = 20_000  # points of each rank
OUTLYING = 3.0  # spans of the middle 80 % of x, y or z away from it: nulls and blunders


class Plane:
    """A plane through a point, and the turn around it that makes it level.

    axes  rows of three directions: two in the plane, the first of them level, and the normal, upwards
    """

    def __init__(self, middle, normal):
        normal = normal * (-1.0 if tuple(normal[::-1]) < (0.0, 0.0, 0.0) else 1.0)
        first = numpy.cross((0.0, 0.0, 1.0), normal)
        length = numpy.linalg.norm(first)
        first = first / length if length > 1e-12 else numpy.array((1.0, 0.0, 0.0))
        self.middle, self.axes = middle, numpy.array([first, numpy.cross(normal, first), normal])

    def levelled(self, data):
        """Data with x and y along the plane, y upwards, and z off it."""
        return moved(data, (coordinates_of(data) - self.middle) @ self.axes.T)

    def back(self, data):
        """What levelled() has turned, in its old place."""
        return moved(data, coordinates_of(data) @ self.axes + self.middle)


def sample_of(points, ranks=None):
    """(n, 3), some finite points of all ranks, without hidden ones, nulls and blunders."""
    xyz = coordinates_of(points)
    hidden = marked_points(points, vtkDataSetAttributes.HIDDENPOINT)
    xyz = xyz[~hidden] if hidden.any() else xyz
    xyz = xyz[:: max(1, len(xyz) // MOST_SAMPLES)].astype("f8")
    xyz = xyz[numpy.isfinite(xyz).all(axis=1)]
    xyz = all_values(ranks, xyz.ravel(), "f8").reshape(-1, 3)
    if not len(xyz):
        return xyz
    low, high = numpy.quantile(xyz, (0.1, 0.9), axis=0)
    reach = OUTLYING * (high - low)
    return xyz[((xyz >= low - reach) & (xyz <= high + reach)).all(axis=1)]


def best_plane(points, ranks=None):
    """(the Plane that fits best, (3,) scatter off it, across and along it) of the points of all ranks."""
    xyz = sample_of(points, ranks)
    if len(xyz) < 3:
        raise ElevationSurfaceError(f"{argument('plane')}: there are fewer than three finite points that are shown")
    unit = numpy.abs(xyz).max() or 1.0  # squares of large ones would be infinite
    middle = (xyz / unit).mean(axis=0)
    squares, directions = numpy.linalg.eigh(numpy.cov((xyz / unit - middle).T))
    return Plane(unit * middle, directions[:, 0]), unit * numpy.sqrt(numpy.maximum(squares, 0.0))


def in_plane(cloud, lines, given, ranks=None):
    """(Cloud, lines) as they are reconstructed, with plane=best turned into their best plane."""
    if not given.get("plane"):
        return cloud, lines
    low, high = heights_of(cloud.points, ranks) or (0.0, 0.0)
    for name, data in lines.items():
        is_zero = not coordinates_of(data)[:, 2].any() and (low > 0.0 or high < 0.0)
        lacks_z = bare_lines(data).any() or numpy.isnan(coordinates_of(data)[:, 2]).any()
        if lacks_z or is_zero and not given.get("faults_z"):
            raise ElevationSurfaceError(
                f"{argument('plane')} best needs lines with z, which the {name} lacks"
                if name != "faults" else
                f"{argument('plane')} best needs lines with z, which the {name} lack", name)
    turned = cloud.copy()
    turned.grid = turned.pixels = None
    turned.plane, (_, across, along) = best_plane(cloud.points, ranks)
    if not across > 1e-6 * along:
        raise ElevationSurfaceError(f"{argument('plane')}: all finite points lie on one line")
    turned.points = turned.plane.levelled(cloud.points)
    return turned, {name: turned.plane.levelled(data) for name, data in lines.items()}


def turn_back(result):
    """Brings what a Reconstruction has made in the plane of its Cloud to where the points were."""
    for name in ("surface", "complete", "points", "boundary", "holes"):
        data = getattr(result, name)
        if data is not None:
            setattr(result, name, result.cloud.plane.back(data))
    if result.lattice:
        plane, lattice = result.cloud.plane, result.lattice
        steps = numpy.array(lattice["steps"]) @ plane.axes[:2]
        origin = lattice["origin"] @ plane.axes[:2] + plane.middle
        result.lattice = {**lattice, "origin": origin.tolist(), "steps": steps.tolist()}
