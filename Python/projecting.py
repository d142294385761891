# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Degrees made metres: x and y of points, by PROJ."""

import numpy

from .clouds import PixelGrid, coordinates_of, moved
from .gdal_common import moving, name_of, one_line, reference_of
from .messages import FileError
from .names import option

LONGITUDES, LATITUDES = 360.0, 90.0
UTM_NORTH = 84.0  # degrees north, and 80 south; polar stereographic beyond
MOST_ANGLES = 720.0, 100.0  # longitudes of ocean models go on after 360; a right angle has 100 gon
WIDE = 9.0  # degrees from the middle: lengths are 1 % too long there at the equator


def looks_like_degrees(cloud):
    """Whether x and y can only be degrees: z has much the wider range."""
    west, east, south, north, low, high = cloud.points.GetBounds()
    wide = max(east - west, north - south)
    is_angle = max(abs(west), abs(east)) <= LONGITUDES and max(abs(south), abs(north)) <= LATITUDES
    is_fine = not cloud.grid or min(map(abs, cloud.grid.steps[::3])) < 1.0
    return is_angle and is_fine and 0.0 < wide < 0.1 * (high - low)


def is_geographic(crs):
    try:
        return reference_of(crs).IsGeographic()
    except (ImportError, ValueError):
        return False


def notes_on_degrees(cloud):
    """A note where x and y of a Cloud are degrees, by its system, their names or their values."""
    words = "are angles" if cloud.crs and is_geographic(cloud.crs) else cloud.angles
    if not words and not cloud.crs and looks_like_degrees(cloud):
        words = "look like degrees"
    return [note_on_degrees(words)] if words not in ("", "no") else []


def note_on_degrees(words):
    return f"x,y {words}: {option('project')} makes metres of them, which gives triangles their true shape"


def zone_of(longitude, latitude):
    """AUTHORITY:CODE of the UTM zone at a place, or of the polar system."""
    if not -80.0 <= latitude <= UTM_NORTH:
        return "EPSG:32661" if latitude > 0 else "EPSG:32761"
    zone = int((longitude + 180.0) % 360.0 // 6.0) + 1
    return f"EPSG:{326 if latitude >= 0 else 327}{zone:02d}"


def no_angles(xyz, most=(LONGITUDES, LATITUDES)):
    """x and y, in words, of the first of (n, 3) points that is finite and beyond the most angles; or ""."""
    xy = xyz[numpy.isfinite(xyz[:, :2]).all(axis=1), :2]
    bad = xy[(abs(xy) > most).any(axis=1)]
    return f"{bad[0, 0]:.10g}, {bad[0, 1]:.10g}" if len(bad) else ""


def project(path, cloud):
    """Makes x and y of a Cloud metres of the UTM zone in their middle. Returns the crs that they had, with WGS
    84 where none is known. Raises FileError for values that are not angles."""
    try:
        source = reference_of(cloud.crs or "EPSG:4326")
    except ImportError:
        raise FileError(f"{path}: {option('project')} needs GDAL; install python3-gdal") from None
    except ValueError as error:
        raise FileError(f"{path}: {error}") from None
    if not source.IsGeographic():
        raise FileError(f"{path}: is in {name_of(cloud.crs)}, so x,y are not angles: leave out {option('project')}")
    xyz = coordinates_of(cloud.points).astype("f8")
    finite = numpy.isfinite(xyz[:, :2]).all(axis=1)
    xy = xyz[finite, :2]
    if not len(xy):
        return cloud.crs
    if where := no_angles(xyz):
        raise FileError(f"{path}: {where} is not longitude and latitude, as {option('project')} needs")
    around = numpy.where(xy[:, 0] < 0, xy[:, 0] + 360.0, xy[:, 0])
    if numpy.ptp(around) < numpy.ptp(xy[:, 0]):  # on both sides of the antimeridian
        xy[:, 0] = around
    low, high = xy.min(axis=0), xy.max(axis=0)
    middle = 0.5 * (low + high)
    zone = zone_of(*middle)
    try:
        places = moving(cloud.crs or "EPSG:4326", zone)
        xyz[finite, :2] = places(xy)
        if cloud.grid:
            steps = numpy.reshape(cloud.grid.steps, (2, 2))
            at = numpy.array([middle, low, high, (low[0], high[1]), (high[0], low[1])])
            steps = [places(at + step) - places(at) for step in steps]
            cells = numpy.hypot(*(abs(steps[0]) + abs(steps[1])).T)
            cloud.grid = PixelGrid(None, tuple(float(v) for step in steps for v in step[0]))
            cloud.largest_cell = float(cells.max())
    except RuntimeError as error:
        raise FileError(f"{path}: cannot be projected to {name_of(zone)}: {one_line(error)}") from None
    before = cloud.crs or "EPSG:4326"
    known = "" if cloud.crs else ", assumed because the file names none,"
    cloud.points, cloud.crs, cloud.frame = moved(cloud.points, xyz), zone, None
    cloud.notes.append(f"x,y are projected from {name_of(before)}{known} to {name_of(zone)}")
    if high[0] - low[0] > 2.0 * WIDE:
        cloud.notes.append(
            f"the points reach over {high[0] - low[0]:.0f} degrees of longitude: lengths are more than 1 % too long "
            "at the sides"
        )
    return before
