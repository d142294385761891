# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whether faults are edges of the surface: where the points of a line are far apart, the triangles at it are as long
as those over a gap, which is left out or filled anew."""

import numpy

from .clouds import bare_lines, coordinates_of, line_parts, triangles_of
from .draping import edges_with_reach
from .messages import counted
from .outline import between, corners_in_order, places_of
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
    turned = (rows[:, 0] > rows[:, 2]) | (rows[:, 0] == rows[:, 2]) & (rows[:, 1] > rows[:, 3])
    rows[turned, :4] = rows[turned][:, [2, 3, 0, 1]]
    rows = rows[numpy.unique(rows[:, :4], axis=0, return_index=True)[1]]  # all ranks, and lines, may have the same
    ends = rows[:, :2], rows[:, 2:4]
    mesh = MeshBetween(surface, numpy.concatenate(ends))
    are_used = [summed(ranks, mesh.has(end).astype("f8")) > 0 for end in ends]
    is_lost = are_used[0] & are_used[1] & (summed(ranks, mesh.joins(*ends).astype("f8")) == 0)
    if is_lost.any():  # those that run through other points are rows of edges
        unsure = [(i, rows[i, :2], rows[i, 2:4], rows[i, 4]) for i in numpy.flatnonzero(is_lost)]
        vertices = corners_in_order(surface)[:, :2]
        found = [(i, between(p, q, vertices, reach)) for i, p, q, reach in unsure]
        on_lines = [numpy.column_stack((numpy.full(len(on), i), on)).ravel() for i, on in found]
        on_lines = numpy.unique(all_values(ranks, numpy.concatenate(on_lines), "f8").reshape(-1, 3), axis=0)
        begins = numpy.searchsorted(on_lines[:, 0], [i for i, *_ in unsure])
        ways = {}
        for (i, p, q, _), on in zip(unsure, numpy.split(on_lines[:, 1:], begins[1:])):
            ways[i] = numpy.vstack((p, on[numpy.argsort((on - p) @ (q - p), kind="stable")], q))
        mesh = MeshBetween(surface, numpy.concatenate(list(ways.values())))
        pairs = mesh.pairs_on_all(ranks)
        for i, way in ways.items():
            is_lost[i] = not is_covered(mesh.numbers_of(way), pairs)
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


def is_covered(way, pairs):
    """Whether edges, pairs of numbers, lead along all of a way, the numbers of places in order. They may pass by
    some of these, which are aside of the way by less than rounding."""
    order = numpy.argsort(way)
    at = numpy.searchsorted(way[order], pairs).clip(max=len(way) - 1)
    at = order[at[(way[order[at]] == pairs).all(axis=1)]]
    steps = numpy.zeros(len(way), "i8")
    numpy.add.at(steps, at.min(axis=1), 1)
    numpy.add.at(steps, at.max(axis=1), -1)
    return bool((numpy.cumsum(steps)[:-1] > 0).all())


class MeshBetween:
    """The edges of a surface between a few places, which are found without sorting all its points."""

    def __init__(self, surface, places):
        self.places = numpy.unique(places_of(places))
        xy = numpy.ascontiguousarray(coordinates_of(surface)[:, :2], "f8") + 0.0  # no -0
        sieve = numpy.zeros(1 << SIEVE_BITS, bool)
        sieve[sieve_places(self.places.view("f8").reshape(-1, 2) + 0.0)] = True
        near = numpy.flatnonzero(sieve[sieve_places(xy)])
        numbers = numpy.full(len(xy), -1, "i4")  # of places, of each point
        numbers[near] = self.numbers_of(xy[near])
        triangles = triangles_of(surface)
        corners = numbers[triangles[(numbers >= 0)[triangles].any(axis=1)]]
        self.used = numpy.zeros(len(self.places) + 1, bool)
        self.used[corners] = True
        self.used[-1] = False
        pairs = numpy.concatenate([corners[:, [i, (i + 1) % 3]] for i in range(3)])
        self.edges = numpy.unique(self.keys(*pairs[(pairs >= 0).all(axis=1)].T))

    def numbers_of(self, xy):
        """The numbers of places; -1 for others."""
        wanted = places_of(xy)
        at = numpy.searchsorted(self.places, wanted)
        at[at == len(self.places)] = 0
        return numpy.where(self.places[at] == wanted, at, -1)

    def keys(self, a, b):
        return numpy.minimum(a, b).astype("i8") * len(self.places) + numpy.maximum(a, b)

    def pairs_on_all(self, ranks):
        """(n, 2) numbers of the ends of the edges of all ranks, of the same places."""
        edges = numpy.unique(all_values(ranks, self.edges.astype("f8"), "f8")).astype("i8")
        return numpy.column_stack(numpy.divmod(edges, len(self.places)))

    def has(self, xy):
        """Whether triangles have a corner at places."""
        return self.used[self.numbers_of(xy)]

    def joins(self, begins, ends):
        """Whether there are edges from places to others."""
        return numpy.isin(self.keys(self.numbers_of(begins), self.numbers_of(ends)), self.edges)


SIEVE_BITS = 20


def sieve_places(xy):
    """Numbers of SIEVE_BITS bits, the same for the same x,y."""
    x, y = xy.view("u8").T
    mixed = (x ^ (y << numpy.uint64(1) | y >> numpy.uint64(63))) * numpy.uint64(0x9E3779B97F4A7C15)
    return mixed >> numpy.uint64(64 - SIEVE_BITS)
