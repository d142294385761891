# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Triangles as a picture needs them: their outlines, and fewer of them where there are more than a
screen can show."""

import dataclasses

import numpy

from ..clouds import slices

MOST_OUTLINE_POINTS = 300_000
MANY_POINTS_EACH = 10  # for a triangle: then points are numbered anew
RINGS = 6  # of a cell, around its middle


@dataclasses.dataclass
class ScreenMesh:
    """What is drawn of a surface.

    ids        (n,) which points of the surface are its points
    triangles  (m, 3) corners, as places in ids
    rim        (k, 2) edges along the border of the surface, as places in ids
    patches    (l, 2) edges around filled holes, as places in ids
    """

    ids: numpy.ndarray
    triangles: numpy.ndarray
    rim: numpy.ndarray
    patches: numpy.ndarray




def outline(triangles):
    """The edges that belong to one of the triangles only, as (n, 2) index pairs.

    The triangles turn the same way round. Linear in time: only edges between points of the outline
    are sorted.
    """
    if len(triangles) == 0:
        return numpy.empty((0, 2), dtype="i8")
    count = int(triangles.max()) + 1
    if count > MANY_POINTS_EACH * len(triangles):
        ids, places = numpy.unique(triangles, return_inverse=True)
        return ids[outline(places.reshape(-1, 3))]
    # Around a point inside, every neighbour is once the next corner and once the one before, so that
    # the differences of any numbers of theirs add up to 0. Sums of such numbers are exact.
    numbers = numpy.random.default_rng(0).integers(0, 2**40, count).astype("f8")
    sums = numpy.zeros(count)
    for rows in slices(len(triangles)):
        values = numbers[triangles[rows]]
        turns = values[:, (1, 2, 0)] - values[:, (2, 0, 1)]
        sums += numpy.bincount(triangles[rows].ravel(), turns.ravel(), count)
    outer = sums != 0.0
    near = []
    for rows in slices(len(triangles)):
        a, b, c = outer[triangles[rows].T]
        near.append(triangles[rows][a & b | b & c | c & a])
    near = numpy.concatenate(near)
    edges = numpy.concatenate([near[:, (0, 1)], near[:, (1, 2)], near[:, (2, 0)]])
    edges = numpy.sort(edges[outer[edges].all(axis=1)], axis=1).astype("i8")
    # One number for each edge: sorting numbers is many times faster than sorting pairs.
    keys, counts = numpy.unique(edges[:, 0] * count + edges[:, 1], return_counts=True)
    keys = keys[counts == 1]
    return numpy.column_stack((keys // count, keys % count))


class Cells:
    """Square cells over a plane, some pixels wide.

    points  (n, 3), of which x and y are used
    turn    (2, 2) matrix from x, y to the plane
    used    (n,) of bool, which points count
    across  how many cells lie side by side over the longer side
    """

    def __init__(self, points, turn, used, across):
        self.points, self.turn, self.used = points, turn, used
        lows, highs = [], []
        for rows in slices(len(points)):
            plane = points[rows][used[rows], :2] @ turn
            if len(plane):
                lows.append(plane.min(axis=0))
                highs.append(plane.max(axis=0))
        self.low = numpy.min(lows, axis=0)
        extent = numpy.max(highs, axis=0) - self.low
        self.side = float(extent.max()) / across
        self.shape = (extent / self.side).astype("i8") + 1

    def stand_ins(self):
        """(n,): for each used point, the one near the middle of its cell that stands for it."""
        cells = numpy.empty(len(self.used), dtype="i4")
        rings = numpy.empty(len(self.used), dtype="u1")
        for rows in slices(len(self.used)):
            plane = (self.points[rows, :2] @ self.turn - self.low) / self.side
            plane = numpy.where(self.used[rows, None], plane, 0.0)
            column_row = plane.astype("i4")
            away = numpy.abs(plane - column_row - 0.5).max(axis=1)
            rings[rows] = 2 * RINGS * away
            cells[rows] = column_row[:, 1] * self.shape[0] + column_row[:, 0]
        nearest = numpy.zeros(numpy.prod(self.shape), dtype="i4")
        for ring in range(RINGS, -1, -1):
            ids = numpy.flatnonzero(self.used & (rings == ring))
            nearest[cells[ids]] = ids  # those of inner rings come later, and stay
        return nearest[cells]


def collapsed(triangles, stand_ins):
    """The triangles with stand-ins for corners, without those that vanish.

    Those that fold over stay: seen from the side, there would be cracks in their places.
    """
    kept = []
    for rows in slices(len(triangles)):
        a, b, c = stand_ins[triangles[rows].T]
        keep = (a != b) & (b != c) & (c != a)
        kept.append(numpy.column_stack((a[keep], b[keep], c[keep])))
    return numpy.concatenate(kept)


def distinct(pairs):
    """Edges between different points, each once."""
    pairs = numpy.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1)
    return numpy.unique(pairs, axis=0)


def mesh_for_screen(triangles, patches, cells=None):
    """The ScreenMesh of triangles.

    triangles  (m, 3) corners, counter-clockwise
    patches    (m,) of bool, which triangles fill holes; or None
    cells      None: all triangles are drawn. Cells: each keeps the point nearest to its middle, and
               outlines keep theirs
    """
    rim = outline(triangles)
    around = outline(triangles[patches]) if patches is not None else rim[:0]
    if cells:
        stand_ins = cells.stand_ins()
        if len(rim) + len(around) <= MOST_OUTLINE_POINTS:
            for pairs in (rim, around):
                stand_ins[pairs] = pairs
        triangles = collapsed(triangles, stand_ins)
        rim, around = (distinct(stand_ins[pairs]) for pairs in (rim, around))
    count = 1 + int(max(rows.max(initial=0) for rows in (triangles, rim, around)))
    flags = numpy.zeros(count, dtype=bool)
    for rows in (triangles, rim, around):
        flags[rows.ravel()] = True
    ids = numpy.flatnonzero(flags)
    places = numpy.zeros(count, dtype="i8")
    places[ids] = numpy.arange(len(ids))
    return ScreenMesh(ids, places[triangles], places[rim], places[around])
