# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whether faults are edges of the surface: where the points of a line are far apart, the triangles at it are as long
as those over a gap, which is left out or filled anew."""

import numpy

from .clouds import bare_lines, coordinates_of, line_parts, triangles_of
from .draping import edges_with_reach
from .messages import counted
from .outline import between, places_of
from .ranks import all_values, summed


def note_on_lost_faults(ranks, surface, faults, is_turned=False):
    """[a note] where edges of faults, both ends of which are points of a surface, are no edges of it, nor a row of
    edges; [] where all are. The same on all ranks, of which each has a part of the surface.

    is_turned  whether the places are others than those of the user
    """
    parts = [part for part, is_bare in zip(line_parts(faults)[1], bare_lines(faults)) if not is_bare]
    lines = [edge for part in parts for edge in edges_with_reach(part)]
    rows = [[*p[:2], *q[:2], reach] for p, q, _, reach in lines]
    rows = all_values(ranks, numpy.array(rows, "f8").ravel(), "f8").reshape(-1, 5)
    if not len(rows):
        return []
    rows = numpy.unique(rows, axis=0)  # all ranks may have all
    mesh = Mesh(surface)
    ends = rows[:, :2], rows[:, 2:4]
    are_used = [summed(ranks, mesh.has(end).astype("f8")) > 0 for end in ends]
    is_lost = are_used[0] & are_used[1] & (summed(ranks, mesh.joins(*ends).astype("f8")) == 0)
    if is_lost.any():  # those that run through other points are rows of edges
        vertices = mesh.vertices[numpy.argsort(mesh.vertices[:, 1], kind="stable")]
        unsure = [(i, rows[i, :2], rows[i, 2:4], rows[i, 4]) for i in numpy.flatnonzero(is_lost)]
        found = [(i, between(p, q, vertices, reach)) for i, p, q, reach in unsure]
        on_lines = [numpy.column_stack((numpy.full(len(on), i), on)).ravel() for i, on in found]
        on_lines = numpy.unique(all_values(ranks, numpy.concatenate(on_lines), "f8").reshape(-1, 3), axis=0)
        begins = numpy.searchsorted(on_lines[:, 0], [i for i, *_ in unsure])
        steps, owners = [], []
        for (i, p, q, _), on in zip(unsure, numpy.split(on_lines[:, 1:], begins[1:])):
            way = numpy.vstack((p, on[numpy.argsort((on - p) @ (q - p), kind="stable")], q))
            steps.append(numpy.hstack((way[:-1], way[1:])))
            owners += [i] * (len(way) - 1)
        steps = numpy.concatenate(steps)
        missing = summed(ranks, mesh.joins(steps[:, :2], steps[:, 2:]).astype("f8")) == 0
        is_lost[:] = False
        is_lost[numpy.array(owners)[missing]] = True
    lost = numpy.flatnonzero(is_lost)
    if not len(lost):
        return []
    begin, end = rows[lost[0], :2], rows[lost[0], 2:4]
    place = "" if is_turned else "; the first from ({:.10g}, {:.10g}) to ({:.10g}, {:.10g})".format(*begin, *end)
    return [
        f"{len(lost):,} of {counted(len(rows), 'edge')} of the faults {'is' if len(lost) == 1 else 'are'} not in the "
        f"surface, as the triangles there were as long as those over a gap{place}: give the lines points as close "
        "together as those of the surface"
    ]


class Mesh:
    """The triangles of a surface, asked by places."""

    def __init__(self, surface):
        triangles = triangles_of(surface).astype("i8")
        used = numpy.unique(triangles)
        self.vertices = coordinates_of(surface)[used, :2].astype("f8")
        places = places_of(self.vertices)
        self.order = numpy.argsort(places, kind="stable")
        self.places = places[self.order]
        corners = numpy.searchsorted(used, triangles)
        pairs = numpy.sort(numpy.concatenate([corners[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
        self.edges = numpy.unique(self.key(*pairs.T))

    def key(self, a, b):
        return numpy.minimum(a, b) * len(self.vertices) + numpy.maximum(a, b)

    def ids(self, xy):
        """The numbers of the vertices at places; -1 where there is none."""
        places = places_of(xy)
        at = numpy.minimum(numpy.searchsorted(self.places, places), len(self.places) - 1)
        if not len(self.places):
            return numpy.full(len(places), -1)
        return numpy.where(self.places[at] == places, self.order[at], -1)

    def has(self, xy):
        return self.ids(xy) >= 0

    def joins(self, begins, ends):
        """Whether there are edges from places to others."""
        a, b = self.ids(begins), self.ids(ends)
        return (a >= 0) & (b >= 0) & numpy.isin(self.key(a, b), self.edges)
