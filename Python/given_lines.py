# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Boundaries and faults as they come, made fit for the filters, with a note on every change."""

import numpy

from .clouds import LINE_NAMES, WITHOUT_Z, bare_lines, coordinates_of, crs_of, line_parts, moved, set_crs, words_in
from .draping import draped
from .gdal_common import check_system, is_near, moving, name_of, reference_of, same_system
from .mending import mended
from .messages import ElevationSurfaceError, FileError, counted, did_you_mean
from .names import argument, option
from .properties import BOUNDARY_EDGES
from .ranks import extremes
from .reading.vectors import is_number

RINGS = ("boundary", "fill_only", "keep_open")  # lines that are closed


def fitted(cloud, lines, names, given, strict=False, ranks=None):
    """(lines, notes): in the coordinate reference system of the points, closed, valid, with z.

    cloud   the points
    lines   {"boundary": vtkPolyData, "faults": vtkPolyData, ...} by the name of a property, of RINGS and
            faults what there is
    names   how messages call the "points" and each of the lines
    given   properties, see checked()
    strict  True: what would be changed is an error
    ranks   the controller of those that have some of the points each, and all lines, or None

    Raises ElevationSurfaceError.
    """
    lines, notes = dict(lines), []
    check_z(lines, names, given)
    check_levels(lines, names, given)
    for name in [name for name in RINGS if name in lines]:  # while places are still those of its file
        lines[name], more = mended(lines[name], names[name], strict, name)
        notes = notes + more
    for name, data in lines.items():
        lines[name], more = in_system(data, names[name], cloud, names["points"], strict, ranks)
        notes = notes + more
    if "faults" in lines:
        lines["faults"], more = draped(cloud, lines["faults"], names["faults"], given, strict, ranks)
        notes += more
    return lines, notes


def check_z(lines, names, given):
    """Refuses a boundary without z where the surface is to have it. Arguments as of fitted()."""
    if BOUNDARY_EDGES[given.get("boundary_edges", 0)] != "own-elevations" or "boundary" not in lines:
        return
    without = bare_lines(lines["boundary"])
    if without.any():
        first = line_parts(lines["boundary"])[0][int(numpy.argmax(without))]
        raise ElevationSurfaceError(
            f"{names['boundary']}: {numpy.count_nonzero(without):,} of {counted(len(without), 'line')} have no z "
            f"(first: {first}), which {argument('boundary_edges')} own-elevations would give to the surface",
            "boundary",
        )


def check_levels(lines, names, given):
    """Refuses areas without the attribute that is to be their level. Arguments as of fitted()."""
    name = given.get("level_attribute")
    if name is None or "fill_only" not in lines:
        return
    attributes = lines["fill_only"].GetCellData()
    words = words_in(attributes, name)
    if words and name != LINE_NAMES:
        bad = next((value for value in words if value.strip() and not is_number(value)), None)
        raise ElevationSurfaceError(
            f"{names['fill_only']}: attribute {name}, which {argument('level_attribute')} names, is text"
            + (f": '{bad}' is not a number; leave empty what has none" if bad else "; numbers are needed"),
            "fill_only",
        )
    arrays = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
    known = [one.GetName() for one in arrays if one and one.GetNumberOfComponents() == 1]
    known = [one for one in known if one and one != WITHOUT_Z]
    if name not in known:
        there = f"those of numbers are {', '.join(known)}" if known else "none is of numbers"
        raise ElevationSurfaceError(
            f"{names['fill_only']}: has no attribute {name} of numbers, which {argument('level_attribute')} "
            f"names; {there}{did_you_mean(name, known)}",
            "fill_only",
        )


def in_system(data, name, cloud, points_name, strict, ranks=None):
    """(data, notes): lines with x and y in the coordinate reference system of a Cloud."""
    crs = crs_of(data)
    _, parts = line_parts(data)
    if not parts or strict or same_system(crs, cloud.crs) is not False or is_near(crs, cloud.crs):
        return data, check_system(name, crs, points_name, cloud.crs)
    xyz = coordinates_of(data).astype("f8")
    try:
        places = moving(crs, cloud.crs)
        xy = places(xyz)
        p, q = (numpy.concatenate([part[end] for part in parts]) for end in ENDS)
        middle = 0.5 * (p + q)
        if reference_of(crs).IsGeographic() and not reference_of(cloud.crs).IsGeographic():
            # Across the antimeridian the way is the shorter one.
            middle[abs(p - q)[:, 0] > 180.0, 0] += 180.0
        bend = places(middle) - 0.5 * (places(p) + places(q))
    except RuntimeError as error:
        raise FileError(
            f"{name}: cannot be reprojected from {name_of(crs)} to {name_of(cloud.crs)}: {error}"
        ) from None
    systems = f"{name} is in {name_of(crs)}, {points_name} in {name_of(cloud.crs)}: reprojected"
    check_overlap(xy, cloud, systems, ranks)
    old, new = xyz[0, :2].copy(), xy[0]
    xyz[:, :2] = xy
    projected = moved(data, xyz)
    set_crs(projected, cloud.crs)
    return projected, [
        f"{systems} by OGR, its first point ({old[0]:.10g}, {old[1]:.10g}) to ({new[0]:.10g}, "
        f"{new[1]:.10g}); edges between points stay straight, up to "
        f"{numpy.hypot(*bend.T).max(initial=0.0):.3g} away from their places"
    ]


def check_overlap(xy, cloud, words, ranks):
    """Refuses reprojected lines that are nowhere near the points: one of the systems is wrong."""
    if cloud.points is None:
        return
    places = coordinates_of(cloud.points)[:, :2].T
    (x0, x1), (y0, y1) = (extremes(ranks, axis[numpy.isfinite(axis)]) for axis in places)
    (west, south), (east, north) = xy.min(axis=0), xy.max(axis=0)
    if west > x1 or east < x0 or south > y1 or north < y0:
        raise FileError(
            f"{words}, it is at x {west:.10g} to {east:.10g}, y {south:.10g} to {north:.10g}, away "
            f"from the points at x {x0:.10g} to {x1:.10g}, y {y0:.10g} to {y1:.10g}; is one of the "
            f"systems wrong? {option('crs')} sets that of the points"
        )


ENDS = (slice(None, -1), slice(1, None))  # of the edges of a line
