# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Above which length triangles bridge what is missing, so that they are opened and filled."""

import math

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from .clouds import coordinates_of
from .ranks import all_values, together, total
from .spreading import ids_of

# Above this multiple, edges bridge missing nodes of a grid, or the space between survey lines.
CELL_DIAGONALS = 1.5
SPACINGS_ALONG = 2.0
# Triangles of lines: the longest edge is this multiple of the shortest. They cover more than half of
# a survey of lines at least 10 spacings apart, also with jitter of half a spacing, and at most a
# tenth of anything else.
LEAST_LINE_RATIO = 3.0
# A full grid has triangles of half a cell; a thinned one, whose nodes are not missing, larger ones.
MOST_FULL_GRID_CELLS = 0.75
MOST_SAMPLES = 1_000_000  # triangles: of more, about every k-th stands for k


def lattice_of(ranks, surface):
    """The lattice that was found, or None: a node, two steps, their lengths and their directions.

    Directions are in degrees from x to y; with plane=best from the first axis of the plane, which is
    level, to the second, upwards, and the node and the steps have x, y and z.
    """

    def local_lattice():
        array = surface.GetFieldData().GetArray("Lattice")
        return [] if array is None else [array.GetTuple(0)]

    found = together(ranks, local_lattice)
    if not found:
        return None
    origin, *steps = numpy.reshape(found[0], (3, 2)).tolist()
    return {
        "origin": origin,
        "steps": steps,
        "lengths": [math.hypot(*step) for step in steps],
        "directions": [math.degrees(math.atan2(step[1], step[0])) for step in steps],
    }


def length_to_open(ranks, surface, result):
    """The length above which edges are opened, to be filled like holes, and why; (0, None): none.

    surface  of which this rank may have a part
    result   the Reconstruction so far
    """
    if result.boundary_name:
        # The edges of a boundary may be long where nothing is missing.
        return 0.0, None
    area, shortest, longest = measured(ranks, surface)
    length, why = length_of(area, shortest, longest, result.lattice)
    cell_limit = CELL_DIAGONALS * max(together(ranks, lambda: [result.cloud.largest_cell]))
    if 0 < length < cell_limit or not length and cell_limit and result.cloud.grid:
        return cell_limit, f"{CELL_DIAGONALS:g} diagonals of the grid's largest cell"
    return length, why


def measured(ranks, surface):
    """Area, shortest and longest edge of the triangles of all ranks, or of a sample of them."""
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    every = 1 + total(ranks, len(triangles)) // MOST_SAMPLES
    if every > 1:
        # All triangles with the same least corner: the order of triangles does not matter.
        least = ids_of(ranks, surface)[triangles].min(axis=1).astype("u8")
        triangles = triangles[(least * numpy.uint64(0x9E3779B97F4A7C15) >> numpy.uint64(32)) % every == 0]
    corners = coordinates_of(surface)[:, :2][triangles].astype("f8")
    a, b, c = (corners[:, i] for i in range(3))
    area = 0.5 * numpy.abs(
        (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    )
    lengths = lengths_of(corners)
    rows = area, lengths.min(axis=0), lengths.max(axis=0)
    return [all_values(ranks, row, "f8") for row in rows]


def lengths_of(corners):
    """(3, n) lengths of the edges of triangles, by x and y of their corners, (n, 3, 2)."""
    return numpy.array([numpy.hypot(*(corners[:, i - 2] - corners[:, i]).T) for i in range(3)])


def length_of(area, shortest, longest, lattice):
    """length_to_open() by what was measured."""
    if not len(area):
        return 0.0, None
    if lattice:
        u, v = (numpy.array(step) for step in lattice["steps"])
        cell = abs(u[0] * v[1] - u[1] * v[0])
        if numpy.median(area) <= MOST_FULL_GRID_CELLS * cell:
            diagonal = float(max(numpy.hypot(*(u + v)), numpy.hypot(*(u - v))))
            return CELL_DIAGONALS * diagonal, f"{CELL_DIAGONALS:g} diagonals of the grid's cells"
    is_between = longest > LEAST_LINE_RATIO * shortest
    if area[is_between].sum() > 0.5 * area.sum():
        along = float(numpy.median(shortest))
        why = f"survey lines found: {SPACINGS_ALONG:g} spacings of {along:.4g} along lines"
        return SPACINGS_ALONG * along, why
    return 0.0, None
