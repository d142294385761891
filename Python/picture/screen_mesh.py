# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Triangles as a picture needs them: their outlines, and fewer of them where there are more than a
screen can show."""

import dataclasses

import numpy

from ..clouds import slices
from ..passes import collapsed, outline, stand_ins

MOST_OUTLINE_POINTS = 300_000


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
            plane = (points[rows, :2] if used[rows].all() else points[rows][used[rows], :2]) @ turn
            if len(plane):
                lows.append([column.min() for column in plane.T])
                highs.append([column.max() for column in plane.T])
        self.low = numpy.min(lows, axis=0)
        extent = numpy.max(highs, axis=0) - self.low
        self.side = float(extent.max()) / across
        self.shape = (extent / self.side).astype("i8") + 1

    def stand_ins(self):
        """(n,): for each used point, the one near the middle of its cell that stands for it."""
        return stand_ins(self.points, self.used, self.turn, [*self.low, self.side], self.shape)


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
        instead = cells.stand_ins()
        if len(rim) + len(around) <= MOST_OUTLINE_POINTS:
            for pairs in (rim, around):
                instead[pairs] = pairs
        triangles = collapsed(triangles, instead)
        rim, around = (distinct(instead[pairs]) for pairs in (rim, around))
    count = 1 + int(max(rows.max(initial=0) for rows in (triangles, rim, around)))
    flags = numpy.zeros(count, dtype=bool)
    for rows in (triangles, rim, around):
        flags[rows.ravel()] = True
    ids = numpy.flatnonzero(flags)
    places = numpy.empty(count, dtype="i4")
    places[ids] = numpy.arange(len(ids))
    return ScreenMesh(ids, places[triangles], places[rim], places[around])
