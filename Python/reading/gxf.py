# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Grids of Geosoft's Grid Exchange Format (GXF). GDAL leaves out their rotation."""

import re

import numpy

from ..messages import FileError
from .horizons import numbers, read_bytes
from .irap import rowwise_cloud

KEYWORD = re.compile(rb"(?m)^#([A-Z]+)[ \t]*\r?\n[ \t]*([^\r\n#]*)")
GRID = re.compile(rb"(?m)^#GRID[ \t]*\r?$")


def read_grid(path, options):
    """Rows of a grid that may be turned about its first node."""
    text = read_bytes(path)
    grid = GRID.search(text)
    if not grid:
        raise FileError(f"{path}: is damaged: its line #GRID is missing")
    begin = grid.end()
    found = {key.decode(): value.replace(b'"', b"").split() for key, value in KEYWORD.findall(text[:begin])}

    def value(key, default):
        return float(found.get(key, [default])[0])

    try:
        columns, rows, x, y = (value(key, "none") for key in ("POINTS", "ROWS", "XORIGIN", "YORIGIN"))
        dx, dy = value("PTSEPARATION", 1), value("RWSEPARATION", 1)
        turned, sense = value("ROTATION", 0), value("SENSE", 1)
        dummy, is_packed = value("DUMMY", "nan"), value("GTYPE", 0) != 0
        scale, offset, *_ = map(float, found.get("TRANSFORM", ["1", "0"]))
    except (ValueError, IndexError):
        raise FileError(f"{path}: is damaged: it does not give POINTS, ROWS, XORIGIN and YORIGIN as numbers") from None
    if is_packed or sense not in (1, -2):
        what = "its numbers are packed" if is_packed else f"its SENSE is {sense:g}"
        raise FileError(f"{path}: {what}, which is not read: gdal_translate {path} grid.tif makes a raster of it")
    z = numbers(text[begin:], options.progress)
    z = numpy.where(numpy.isclose(z, dummy, 1e-6, 0.0), numpy.nan, z * scale + offset)
    if sense == -2 and len(z) == rows * columns:
        z = z.reshape(int(rows), int(columns))[::-1].ravel()
    ends = x, x + dx * (columns - 1), y, y + dy * (rows - 1)
    cloud = rowwise_cloud(path, "GXF grid", (rows, dx, dy, *ends, columns, turned, x, y), z)
    cloud.is_horizon = False
    return cloud
