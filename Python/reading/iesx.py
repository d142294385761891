# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Horizons and fault boundaries of IESX, as GeoFrame and Petrel write them. No library reads them."""

import re

import numpy

from ..clouds import Cloud, add_array, make_lines, make_points
from ..messages import FileError, Reason
from ..progress import lines_with_progress
from ..selecting import words_of
from .nulls import ALL_WITHOUT_DATA

NUMBER = rb"\s*([-+]?\d*\.?\d+(?:[eE][-+]?\d+)?|[-+]?\d+\.)"
INTEGER = rb"\s+(-?\d+)(?![\d.])"
# x, y, segment, a code and z by profile's type, 1 for a horizon; a fault boundary, 3, has no code. Numbers may
# touch where their columns are those of IESX.
IN_COLUMNS = re.compile(rb"(.{16})(.{16})(..\d)(..\d)" + NUMBER)
ROWS = {
    "1": (IN_COLUMNS, re.compile(NUMBER + NUMBER + INTEGER + INTEGER + NUMBER)),
    "3": (re.compile(NUMBER + NUMBER + INTEGER + NUMBER),),
}
PROFILE = re.compile(rb"PROFILE\s+(.*?)\s*TYPE\s+(\d+)(.*)")
NULL = 1e30  # and above


def profiles(path, progress):
    """[(name, type, unit of z, rows of x, y, segment and z)] of a file. Petrel leaves out the EOD at its end."""
    found, is_over = [], False
    with open(path, "rb") as stream:
        for number, line in enumerate(lines_with_progress(stream, progress), 1):
            head = PROFILE.match(line)
            if head:
                name, kind, rest = (part.decode("latin-1") for part in head.groups())
                if kind not in ROWS:
                    raise FileError(f"{path}, line {number}: holds an IESX profile of type {kind}; horizons (1) "
                                    "and fault boundaries (3) are read")
                found.append((name, kind, (rest.split() or [""])[-1], []))
            is_over = line.strip() == b"EOD"
            if head or is_over or not line.strip() or line.startswith((b"SNAPPING", b"#", b"!")):
                continue
            row = found and parse_row(line, ROWS[found[-1][1]])
            if not row:
                shown = line.decode("latin-1").strip()[:40]
                raise FileError(f"{path}, line {number}: '{shown}' is not a row of an IESX profile")
            found[-1][3].append(row)
    if not is_over and not line.endswith(b"\n"):
        raise FileError(f"{path}: is cut off within its last line")
    if not any(rows for *_, rows in found):
        raise FileError(f"{path}: holds no points")
    return found


def parse_row(line, patterns):
    """(x, y, segment, z), or None."""
    for pattern in patterns:
        try:
            x, y, segment, *_, z = map(float, pattern.match(line).groups())
            return x, y, segment, z
        except (AttributeError, ValueError):
            continue
    return None


def read_points(path, options):
    """The points of all horizons in a file, with the name of theirs and their segment."""
    parts = [part for part in profiles(path, options.progress) if part[3]]
    rows = numpy.concatenate([rows for *_, rows in parts])
    keep = rows[:, 3] < NULL
    if not keep.any():
        raise FileError(f"{path}: {ALL_WITHOUT_DATA}")
    names = [name for name, *_ in parts]
    counts = [len(rows) for *_, rows in parts]
    cloud = Cloud(make_points(rows[keep][:, [0, 1, 3]]), [f"IESX: {', '.join(dict.fromkeys(names))}"])
    add_array(cloud.points, "Segment", rows[keep, 2].astype("i4"))
    words = words_of(names).some(numpy.repeat(numpy.arange(len(names)), counts))
    cloud.words["name"] = words.some(numpy.flatnonzero(keep))
    cloud.is_horizon, cloud.z_name = True, "time (ms)" if parts[0][2] == "ms" else ""
    if not keep.all():
        cloud.left_out[Reason("row", "without data")] = int(numpy.count_nonzero(~keep))
    return cloud


def read_lines(path, _singular, progress):
    """The segments of all profiles as lines."""
    names, lines = [], []
    for name, _, _, rows in profiles(path, progress):
        rows = numpy.reshape(rows, (-1, 4))
        for segment in dict.fromkeys(rows[:, 2]):
            names.append(f"segment {segment:g} of {name}")
            lines.append(rows[rows[:, 2] == segment][:, [0, 1, 3]])
    return make_lines(lines, names)
