# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Above which length triangles bridge what is missing, so that they are opened and filled."""

import numpy

from .clouds import coordinates_of, triangles_of
from .passes import sample
from .ranks import all_values, together, total
from .spreading import ids_of

# Above this multiple, edges bridge missing nodes of a grid, or the space between survey lines.
CELL_DIAGONALS = 1.5
STEPS_ALONG = 2.0
# Points are lines where these are so many times as far apart as their points are along them. On four
# elevation models thinned to rows, straight ones and others that wobble, new points between rows make the
# RMS error 0 to 26 % smaller at 7 steps or more, change it by 3 % at most at 5 (of one model, make it
# 26 % smaller), and make it up to 6 % larger at 4.
LEAST_STEPS_APART = 5.0
TOLERANCE_PER_STEP = 1.5  # of the gap tolerance that vtkTrimOutwardTriangles chooses for lines
MOST_SAMPLES = 1_000_000  # triangles: of more, about every k-th stands for k


def length_to_open(ranks, surface, result):
    """The length above which edges are opened, to be filled like holes, and why; (0, None): none.

    surface  of which this rank may have a part
    result   the Reconstruction so far
    """
    if result.boundary_name:
        # The edges of a boundary may be long where nothing is missing.
        return 0.0, None
    trim = result.trim
    tolerance = trim.GetEffectiveGapTolerance() if trim and not trim.GetGapTolerance() else 0.0
    length, why = length_of(*measured(ranks, surface), result.lattice, tolerance)
    cell_limit = CELL_DIAGONALS * max(together(ranks, lambda: [result.cloud.largest_cell]))
    if 0 < length < cell_limit or not length and cell_limit and result.cloud.grid:
        return cell_limit, f"{CELL_DIAGONALS:g} diagonals of the grid's largest cell"
    return length, why


def measured(ranks, surface):
    """Area, shortest and longest edge of the triangles of all ranks, or of a sample of them."""
    triangles = triangles_of(surface)
    every = 1 + total(ranks, len(triangles)) // MOST_SAMPLES
    if every > 1:
        triangles = triangles[sample(triangles, every, ids_of(ranks, surface) if ranks else None)]
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


def length_of(area, shortest, longest, lattice, tolerance):
    """length_to_open() by what was measured; tolerance: for gaps, chosen from the points, or 0."""
    if not len(area):
        return 0.0, None
    step = float(numpy.median(shortest))
    apart = tolerance / TOLERANCE_PER_STEP or elongation(area, shortest, longest)
    if apart >= LEAST_STEPS_APART and step > 0.0:
        return STEPS_ALONG * step, (
            f"survey lines found, about {apart:.0f} times as far apart as their points: {STEPS_ALONG:g} steps "
            f"of {step:.4g} along lines")
    if lattice:
        u, v = (numpy.array(step) for step in lattice["steps"])
        length = CELL_DIAGONALS * float(max(numpy.hypot(*(u + v)), numpy.hypot(*(u - v))))
        # Most triangles of a full grid have no longer edge; most of a thinned one, whose nodes are not
        # missing, have.
        if numpy.median(longest) <= length:
            return length, f"{CELL_DIAGONALS:g} diagonals of the grid's cells"
    return 0.0, None


def elongation(area, shortest, longest):
    """The longest edge over the shortest, of triangles that cover half of the surface at least so much."""
    ratios = longest / numpy.maximum(shortest, numpy.finfo("f8").tiny)
    order = numpy.argsort(ratios)
    covered = numpy.cumsum(area[order])
    return float(ratios[order[numpy.searchsorted(covered, 0.5 * covered[-1])]])
