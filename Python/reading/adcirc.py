# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Nodes of ADCIRC's meshes, fort.14. No library of Debian reads them."""

import itertools

import numpy

from ..clouds import Cloud, make_points
from ..messages import FileError
from ..progress import items_with_progress
from .facing import check_faces, make_faces


def are_numbers(words, width):
    try:
        return len([float(word) for word in words]) == width
    except ValueError:
        return False


def read_rows(path, stream, number, count, width, what):
    """(count, width) numbers of the next lines of a file, which may go on behind them."""
    try:
        lines = [line.split()[:width] for line in itertools.islice(stream, count)]
        rows = numpy.array(lines, "f8").reshape(-1, width)
    except ValueError:
        bad = next((i for i, line in enumerate(lines) if not are_numbers(line, width)), 0)
        raise FileError(f"{path}, line {number + bad}: is not a row of {width} numbers, or is cut off") from None
    if len(rows) < count:
        raise FileError(f"{path}: is cut off: {count:,} {what} are announced, {len(rows):,} found")
    return rows


def read_points(path, options):
    """The nodes. Their depth counts downwards, and is turned over."""
    with open(path, "rb") as stream:
        title, counts = stream.readline(), stream.readline().split()
        if len(counts) < 2 or not all(word.isdigit() for word in counts[:2]) or not int(counts[1]):
            raise FileError(f"{path}, line 2: does not give the number of elements and nodes, as an ADCIRC mesh does")
        elements, count = map(int, counts[:2])
        nodes = read_rows(path, items_with_progress(stream, options.progress, count), 3, count, 4, "nodes")
        faces = read_rows(path, stream, 3 + count, elements, 5, "elements")
    places = {node: place for place, node in enumerate(nodes[:, 0])}
    xyz = nodes[:, 1:] * (1.0, 1.0, 1.0 if options.depth else -1.0)
    cloud = Cloud(make_points(xyz), [f"ADCIRC mesh '{title.decode('latin-1').strip()[:40]}'"])
    cloud.z_name = "elevation"
    if not options.depth:
        cloud.notes.append("z is turned over: the depths of ADCIRC count downwards")
    cloud.notes.append("only the points are used, not the file's cells")
    try:
        corners = numpy.array([[places[node] for node in row] for row in faces[:, 2:].tolist()])
    except KeyError as error:
        node = f"{error.args[0]:g}"
        raise FileError(f"{path}: is damaged: an element has the node {node}, which is not there") from None
    if len(corners) and not options.points_only:
        cloud.notes += check_faces(path, make_faces(xyz, corners), options)
    return cloud
