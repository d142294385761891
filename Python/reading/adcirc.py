# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Nodes of the meshes of ADCIRC, fort.14, and of DHI's MIKE, .mesh. No library of Debian reads them."""

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
    notes = [f"ADCIRC mesh '{title.decode('latin-1').strip()[:40]}'"]
    if not options.depth:
        nodes[:, 3] *= -1.0
        notes.append("z is turned over: the depths of ADCIRC count downwards")
    return cloud_of(path, nodes, faces[:, 2:], notes, options)


def read_dhi(path, options):
    """The nodes of a mesh of MIKE, whose z counts upwards."""
    with open(path, "rb") as stream:
        words = stream.readline().decode("latin-1").split(maxsplit=3)
        count, projection = next((int(a), b) for a, b in zip(words, words[1:]) if not b.isdigit())
        nodes = read_rows(path, items_with_progress(stream, options.progress, count), 2, count, 4, "nodes")
        counts = [int(word) for word in stream.readline().split() if word.isdigit()]
        if len(counts) != 3:
            raise FileError(f"{path}, line {count + 2}: does not give the number of elements, as a mesh of MIKE does")
        faces = read_rows(path, stream, count + 3, counts[0], 1 + counts[1], "elements")
    if (faces[:, 4:] != 0).any():
        faces = faces[:0]  # some have four corners
    return cloud_of(path, nodes, faces[:, 1:4], [f"DHI mesh, {projection.strip()[:40]}"], options)


def cloud_of(path, nodes, faces, notes, options):
    """The Cloud of nodes, rows of a number, x, y and z, and of faces, rows of such numbers."""
    places = {node: place for place, node in enumerate(nodes[:, 0])}
    cloud = Cloud(make_points(nodes[:, 1:]), [*notes, "only the points are used, not the file's cells"])
    cloud.z_name = "elevation"
    try:
        corners = numpy.array([[places[node] for node in row] for row in faces.tolist()])
    except KeyError as error:
        node = f"{error.args[0]:g}"
        raise FileError(f"{path}: is damaged: an element has the node {node}, which is not there") from None
    if len(corners) and not options.points_only:
        cloud.notes += check_faces(path, make_faces(nodes[:, 1:], corners), options)
    return cloud
