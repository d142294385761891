# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""IRAP (RMS, ROXAR) grids, classic ones of text and binary ones. No library of Debian reads them."""

import struct

import numpy

from ..messages import FileError
from .horizons import check_count, grid_cloud, numbers, read_bytes

NULL = 9999900.0  # and above; binary ones have 1e30
BINARY_HEADER = ">ii i6f ii i3f i i7i i".replace(" ", "")  # records with their lengths around them


def read_grid(path, options):
    """IRAP classic grid."""
    values = numbers(read_bytes(path), options.progress)
    if len(values) < 19:
        raise FileError(f"{path}: is cut off within the header of an IRAP classic grid")
    return rowwise_cloud(path, "IRAP classic grid", values[1:12], values[19:])


def read_binary_grid(path, options):
    """Binary IRAP grid: records of Fortran, the highest byte first, of single precision."""
    data = read_bytes(path)
    size = struct.calcsize(BINARY_HEADER)
    if len(data) < size:
        raise FileError(f"{path}: is cut off within the header of a binary IRAP grid")
    head = struct.unpack_from(BINARY_HEADER, data)
    rows, (x_min, x_max, y_min, y_max, dx, dy), columns = head[2], head[3:9], head[11]
    header = (rows, dx, dy, x_min, x_max, y_min, y_max, columns, *head[12:15])
    parts, at = [], size
    while at < len(data):
        length = int.from_bytes(data[at : at + 4], "big")
        part = data[at + 4 : at + 4 + length]
        if length % 4 or data[at : at + 4] != data[at + 4 + length : at + 8 + length]:
            raise FileError(f"{path}: is cut off or damaged behind byte {at:,}")
        parts.append(numpy.frombuffer(part, ">f4"))
        at += 8 + length
        options.progress(at / len(data))
    values = numpy.concatenate([numpy.empty(0), *parts])
    return rowwise_cloud(path, "binary IRAP grid", header, values)


def rowwise_cloud(path, name, header, values):
    """Rows from south to north, which may be turned about a point, as a Cloud."""
    rows, dx, dy, x_min, x_max, y_min, _, columns, turned, x0, y0 = header
    if not (rows >= 1 and columns >= 1 and dx > 0 and dy > 0 and rows * columns < 1e12):
        raise FileError(f"{path}: is not a valid {name}: {columns:g} x {rows:g} nodes")
    check_count(path, len(values), int(rows) * int(columns))
    x, y = numpy.meshgrid(x_min + dx * numpy.arange(columns), y_min + dy * numpy.arange(rows))
    note = name
    if turned:
        angle = numpy.radians(turned)
        c, s, x, y = numpy.cos(angle), numpy.sin(angle), x - x0, y - y0
        x, y = x0 + c * x - s * y, y0 + s * x + c * y
        note += f", turned by {turned:g} degrees"
    cloud = grid_cloud(path, x, y, numpy.where(values >= NULL, numpy.nan, values).reshape(x.shape), note)
    if not turned and abs(x[0, -1] - x_max) > 0.01 * dx:
        cloud.notes.append(f"its last x is {x[0, -1]:.9g} by its steps, {x_max:.9g} by its header")
    return cloud
