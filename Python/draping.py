# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Faults without z: they get that of the surface that the points make without faults, everywhere.

Each gets a vertex where it crosses an edge of that surface, as the surface bends there. Of a line that
has some z, the points without get it from vtkGridDelaunay2D, and the line stays straight between points.
"""

import numpy

from .clouds import bare_lines, heights_of, line_parts, make_lines, mark_bare
from .messages import ElevationSurfaceError, Messages, counted
from .names import option
from .outline import between, corners_in_order, places_of
from .properties import FAULTS_Z
from .ranks import agreed, all_values, total
from .spreading import update
from .vtkElevationSurface import vtkGridDelaunay2D

ROUNDING = 1e-9  # of an edge: vertices no farther from it are on it


def draped(cloud, faults, name, given, strict=False, ranks=None):
    """(faults, notes), those without z being draped on the surface of the points of a Cloud.

    name    how messages call the faults
    given   properties, see checked(): faults_z and duplicates count
    strict  True: faults without z are an error
    ranks   see fitted()
    """
    names, parts, bare, words, soft = without_z(faults, name, given, heights_of(cloud.points, ranks))
    wanted = FAULTS_Z[given.get("faults_z", 0)]
    if (words or soft) and (wanted == "given" or strict and wanted != "drape"):
        advice = f"; {option('faults_z')} drape takes z of the surface of the points"
        raise ElevationSurfaceError((words or soft) + advice, "faults")
    notes = [f"{soft}: these take that of the surface of the points"] if soft else []
    if not words:
        return faults, notes
    laid = [part for part, is_bare in zip(parts, bare) if is_bare]
    surface = Surface(cloud.points, laid, given.get("duplicates", 0), name, ranks)
    if surface.is_empty:
        return faults, notes
    result, outside, followed = [], [], []
    for title, part, is_bare in zip(names, parts, bare):
        found, lost, place = surface.drape(part) if is_bare else ([part], 0.0, None)
        result += [(title, one) for one in found]
        followed += [one[:, 2] for one in found] if is_bare else []
        if lost:
            outside.append((title, lost, place))
    if not result:
        return faults, notes  # the filter says where they are, and where the points
    if followed:
        z = numpy.concatenate(followed)
        notes.append(
            f"{words}: they follow the surface of the points, with {len(z):,} vertices and z from "
            f"{z.min():.6g} to {z.max():.6g}"
        )
    if outside:
        title, lost, (x, y, _) = outside[0]
        notes.append(
            f"{name}: what lies outside of the points is left out of "
            f"{counted(len(outside), 'line')} without z, a length of {lost:.4g} of {title}, at "
            f"({x:.10g}, {y:.10g})"
        )
    lines = make_lines([one for _, one in result], [title for title, _ in result])
    if bare.all():
        mark_bare(lines)  # where the filter can, it drapes them itself
    return lines, notes


def without_z(faults, name, given, heights):
    """(names, parts, which have no z, words about these, or "", words about points without z of the
    others, or ""), as draped() counts lines.

    heights  of the points, see heights_of()
    """
    wanted = FAULTS_Z[given.get("faults_z", 0)]
    names, parts = line_parts(faults)
    bare = bare_lines(faults)
    words = f"{name}: {numpy.count_nonzero(bare):,} of {counted(len(parts), 'line')} without z"
    if wanted == "drape":
        bare[:] = True
        words = f"{name}: z of its lines is left aside, as {option('faults_z')} says"
    elif wanted == "automatic" and not bare.all() and is_zero_unlike_points(parts, bare, heights):
        bare[:] = True
        words = (
            f"{name}: z of its lines is 0 everywhere and that of the points never, so that they "
            f"count as lines without z; {option('faults_z')} given takes the 0"
        )
    first = names[int(numpy.argmax(bare))] if bare.any() else ""
    return names, parts, bare, f"{words} (first: {first})" if first else "", soft_points(names, parts, bare, name)


def soft_points(names, parts, bare, name):
    """Words about points without z of lines that have some, or ""."""
    counts = []
    for part, is_bare in zip(parts, bare):
        is_closed = len(part) > 1 and (part[0, :2] == part[-1, :2]).all()
        soft = numpy.isfinite(part[:, :2]).all(axis=1) & numpy.isnan(part[:, 2])
        counts.append(0 if is_bare else int(numpy.count_nonzero(soft[: -1 if is_closed else None])))
    if not any(counts):
        return ""
    first = names[int(numpy.argmax(numpy.array(counts) > 0))]
    return f"{name}: {counted(sum(counts), 'point')} without z, of lines that have some (first: {first})"


def check_given_z(faults, name, given, heights):
    """Raises ElevationSurfaceError for faults that would have to be draped on points that are not in
    memory; see without_z()."""
    *_, words, soft = without_z(faults, name, given, heights)
    if words or soft:
        raise ElevationSurfaceError(
            f"{words or soft}: to follow the surface of the points takes the whole surface in memory", "faults"
        )


def is_zero_unlike_points(parts, bare, heights):
    """Whether z of all lines that have one is 0, and that of the points never is."""
    if any(numpy.nan_to_num(part[:, 2]).any() for part, is_bare in zip(parts, bare) if not is_bare):
        return False
    return heights is not None and (heights[0] > 0.0 or heights[1] < 0.0)


class Surface:
    """The vertices of the surface of points onto which lines are laid, to drape these."""

    def __init__(self, points, lines, duplicates, name, ranks=None):
        mesh = vtkGridDelaunay2D()
        mesh.SetLatticeMode(mesh.OFF)  # as with faults
        mesh.SetDuplicatePolicy(duplicates)
        mesh.SetInputData(points)
        mesh.SetSourceData(make_lines(lines))
        mesh.DrapeConstraintsOn()
        with Messages(mesh, mesh.GetExecutive()) as messages:
            update(mesh, ranks)
        cells = mesh.GetOutput().GetPolys()
        self.is_empty = total(ranks, cells.GetNumberOfCells()) == 0
        if self.is_empty:
            # Lines that are elsewhere are refused by the filter that is to have them.
            if not total(ranks, len(messages.errors)):
                agreed(ranks, lambda: self.refuse(name, messages))  # by the first, who has warnings
            return
        self.vertices = corners_in_order(mesh.GetOutput())
        ends = self.vertices[self.are_ends(lines)]
        if ranks:  # what is on lines is enough
            edges = [edge for line in lines for edge in edges_with_reach(line)]
            on_lines = [between(p, q, self.vertices, reach) for p, q, _, reach in edges]
            found = all_values(ranks, numpy.concatenate([ends, *on_lines]).ravel(), "f8").reshape(-1, 3)
            found = numpy.unique(found, axis=0)
            self.vertices = found[numpy.argsort(found[:, 1], kind="stable")]
            ends = self.vertices[self.are_ends(lines)]
        self.at = dict(zip(places_of(ends).tolist(), ends))

    @staticmethod
    def refuse(name, messages):
        why = messages.warnings or ["the points make no surface"]
        raise ElevationSurfaceError(f"{name}: cannot be draped: {why[0]}", "faults")

    def are_ends(self, lines):
        return numpy.isin(places_of(self.vertices), places_of(numpy.concatenate(lines)))

    def drape(self, line):
        """([(n, 3) parts of a line that lie within the points], the length of what does not, the
        first place of that)."""
        parts, lost, first = [], 0.0, None
        for p, q, length, reach in edges_with_reach(line):
            begin, end = ([self.at[place] for place in places_of(one[None]).tolist() if place in self.at]
                          for one in (p, q))
            on = [*begin, *between(p, q, self.vertices, reach), *end]
            within = float(numpy.hypot(*(on[-1] - on[0])[:2])) if on else 0.0
            if length - within > 2 * reach:
                lost += length - within
                first = first if first is not None else q if begin else p
            if parts and begin and parts[-1][-1] is begin[0]:
                parts[-1] += on[1:]
            elif on:
                parts.append(on)
        return [numpy.array(part) for part in parts if len(part) > 1], lost, first


def edges_with_reach(line):
    """Yields both ends of each edge of a line, its length, and how far from it a vertex may be to count as on it."""
    for p, q in zip(line[:-1], line[1:]):
        length = float(numpy.hypot(*(q - p)[:2]))
        if length > 0.0:
            yield p, q, length, max(ROUNDING * length, 16 * float(numpy.spacing(abs(line[:, :2]).max())))
