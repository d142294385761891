# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rings of a boundary as they come: small gaps are closed, and what crosses itself is made valid.

The filters take closed rings that do not cross themselves, and nothing else. GEOS, through OGR,
makes rings valid: what a ring goes around counts as inside, also where it goes around twice.
"""

import dataclasses

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from .clouds import add_array, line_cells, line_parts, make_lines
from .gdal_common import gdal_module, quiet
from .messages import ElevationSurfaceError, counted
from .names import option
from .outline import places_of, trial

GAP = 0.01  # of the length of a ring: ends of lines no farther apart are joined
MOVED = 0.5  # of the edges next to them: ends no farther apart are made one point
MOST_NAMED = 20  # mends of a kind that get a note each
NEIGHBOURS = 8  # ends that may be the other side of a gap


@dataclasses.dataclass
class Line:
    """A line, or a part of a ring.

    points  (n, 3), the last the first of a closed one
    cells   the lines that were given which it is made of
    """

    name: str
    points: numpy.ndarray
    cells: list


def mended(boundary, name, strict=False, about="boundary"):
    """(rings, notes): a boundary whose rings are closed and do not cross themselves.

    name    how messages call it
    strict  True: what would be mended is an error
    about   the property that it is, which errors are about

    Rings that need nothing are handed on as they are. Raises ElevationSurfaceError, also for a gap
    that is too wide, and where GEOS is needed but missing.
    """
    names, parts = line_parts(boundary)
    if not parts or not all(numpy.isfinite(part[:, :2]).all() for part in parts):
        return boundary, []  # the filter says what is wrong
    lines = [Line(*one) for one in zip(names, parts, line_cells(boundary)[:, None].tolist())]
    try:
        notes = close_gaps(lines, name, strict)
        rings = made_of(lines, boundary) if notes else boundary
        if trial(rings)[0]:
            lines, valid = without_crossings(lines, name, strict)
            if valid:
                notes, rings = notes + valid, made_of(lines, boundary)
    except ElevationSurfaceError as error:
        error.about = about
        raise
    return rings, notes


def made_of(lines, given):
    """Lines as vtkPolyData with the cell arrays, of single numbers, of those that were given. A line that is
    made of several has their common number, or none (NaN)."""
    rings = make_lines([line.points for line in lines], [line.name for line in lines])
    for i in range(given.GetCellData().GetNumberOfArrays()):
        array = given.GetCellData().GetArray(i)
        if array and array.GetNumberOfComponents() == 1 and not rings.GetCellData().HasArray(array.GetName()):
            numbers = vtk_to_numpy(array).astype("f8")
            known = [numpy.unique(numbers[line.cells][~numpy.isnan(numbers[line.cells])]) for line in lines]
            add_array(rings, array.GetName(), [one[0] if len(one) == 1 else numpy.nan for one in known], "Cell")
    return rings


def refusal(words, strict):
    """The error for what would be mended, or could not be."""
    return ElevationSurfaceError(words + f"; without {option('strict')} it is mended" * strict)


def at(place):
    return f"({place.real:.10g}, {place.imag:.10g})"


def in_words(length):
    return f"{length:,.0f}" if length >= 1000.0 else f"{length:.4g}"


def first_ones(notes, more):
    """The notes, of which the last stands for all others where they are many."""
    if len(notes) <= MOST_NAMED:
        return notes
    return notes[:MOST_NAMED] + [f"{more}, and {len(notes) - MOST_NAMED:,} more like these"]


# ---- gaps -------------------------------------------------------------------------------------


def length_of(part):
    return float(numpy.hypot(*numpy.diff(part[:, :2], axis=0).T).sum())


def close_gaps(mended_lines, name, strict):
    """Joins ends of lines where no other line goes on. Changes the Lines. Returns notes."""
    names, parts = [line.name for line in mended_lines], [line.points for line in mended_lines]
    is_open = [part[0, 0] != part[-1, 0] or part[0, 1] != part[-1, 1] for part in parts]
    lines = numpy.flatnonzero(is_open)
    if not len(lines):
        return []
    ends = places_of(numpy.concatenate([parts[i][[0, -1]] for i in lines]))
    places, end_places, counts = numpy.unique(ends, return_inverse=True, return_counts=True)
    odd = numpy.flatnonzero(counts % 2)
    if not len(odd):
        return []
    first_end = numpy.unique(end_places, return_index=True)[1]
    pairs = [sorted(pair, key=first_end.__getitem__) for pair in odd[nearest_pairs(places[odd])]]
    pairs = numpy.array(sorted(pairs, key=lambda pair: first_end[pair[0]]))
    lengths = ring_lengths(parts, lines, end_places.reshape(-1, 2), pairs, places)
    gaps = [abs(places[p] - places[q]) for p, q in pairs]
    if any(g > GAP * lengths[p] and counts[[p, q]].max() > 1 for g, (p, q) in zip(gaps, pairs)):
        return []  # lines that meet in threes: the filter says where
    notes = []
    for gap, (p, q) in zip(gaps, pairs):
        end, other = first_end[p], first_end[q]
        one, two = names[lines[end // 2]], names[lines[other // 2]]
        words = f"{name}: {gap_in_words(one, two, gap, places[p], lengths[p])}"
        if gap > GAP * lengths[p]:
            raise refusal(f"{words}; gaps of up to {100 * GAP:g} % are closed", False)
        if strict:
            raise refusal(words, True)
        shortest = min(edge_at(parts[lines[e // 2]], e % 2) for e in (end, other))
        if gap <= MOVED * shortest:
            for e in numpy.flatnonzero(end_places == q):
                moved = mended_lines[lines[e // 2]]
                moved.points = parts[lines[e // 2]] = moved.points.copy()
                moved.points[-(e % 2), :2] = places[p].real, places[p].imag
            notes.append(f"{words}: the second is moved onto the first")
        else:
            edge = numpy.array([parts[lines[e // 2]][-(e % 2)] for e in (end, other)])
            mended_lines.append(Line(one, edge, mended_lines[lines[end // 2]].cells))
            notes.append(f"{words}: closed by a straight edge")
    return first_ones(notes, f"{name}: gaps of up to {in_words(max(gaps))}")


def gap_in_words(one, two, gap, place, length):
    """What is open, between lines of these names, by how much and where."""
    words = f"{one} is not closed: its ends are"
    if one != two:
        words = f"{one} and {two} do not meet: they are"
    return (
        f"{words} {in_words(gap)} apart at {at(place)}, which is {100 * gap / length:.3g} % of the "
        f"ring's length {in_words(length)}"
    )


def edge_at(part, is_last):
    """The length of the edge at an end of a line."""
    p, q = part[-2:] if is_last else part[:2]
    return float(numpy.hypot(*(p - q)[:2]))


def nearest_pairs(places):
    """(m, 2): the places in pairs, those that are nearest to each other first."""
    candidates = []
    for i, place in enumerate(places):
        away = abs(places - place)
        away[i] = numpy.inf
        for j in numpy.argsort(away, kind="stable")[: min(NEIGHBOURS, len(places) - 1)].tolist():
            candidates.append((float(away[j]), min(i, j), max(i, j)))
    partner = {}
    for _, i, j in sorted(set(candidates)):
        if i not in partner and j not in partner:
            partner[i], partner[j] = j, i
    # Where all that are near have found another, any place is the other side of a gap, too wide.
    alone = [i for i in range(len(places)) if i not in partner]
    partner.update(zip(alone[::2], alone[1::2]))
    return numpy.array([(i, j) for i, j in partner.items() if i < j])


def ring_lengths(parts, lines, ends, pairs, places):
    """(n,): for each place the length of all lines that hang together with it, gaps closed."""
    parents = list(range(len(places)))

    def root(place):
        while parents[place] != place:
            parents[place] = place = parents[parents[place]]
        return place

    for p, q in [*ends.tolist(), *pairs.tolist()]:
        parents[root(p)] = root(q)
    lengths = numpy.zeros(len(places))
    for line, (p, _) in zip(lines, ends.tolist()):
        lengths[root(p)] += length_of(parts[line])
    for p, q in pairs.tolist():
        lengths[root(p)] += abs(places[p] - places[q])
    return lengths[[root(place) for place in range(len(places))]]


# ---- crossings --------------------------------------------------------------------------------


def without_crossings(lines, name, strict):
    """(Lines, notes), each ring that crosses itself being made valid. The others stay."""
    kept, notes = [], []
    for line in chained(lines):
        title, ring = line.name, line.points
        is_ring = len(ring) > 3 and (ring[0, :2] == ring[-1, :2]).all()
        errors, _, triangles = trial(make_lines([ring])) if is_ring else ([], 0, 0)
        if not errors or not triangles:  # where it encloses none, the filter reports that
            kept.append(line)
            continue
        made = valid(ring, f"{name}: {title} crosses itself: {errors[0]}")
        if not made:
            kept.append(line)
            continue
        where = f"{name}: {title} crosses itself {places_in_words(ring, made)}"
        if strict:
            raise refusal(where, True)
        areas = sorted((area for area, _ in made), reverse=True)
        share = f", the largest with {100 * areas[0] / sum(areas):.4g} % of the area"
        notes.append(
            f"{where}: made valid by GEOS, {counted(len(areas), 'polygon')}"
            + (share if len(areas) > 1 else f" of area {areas[0]:.6g}")
        )
        kept += [Line(title, part, line.cells) for _, rings in made for part in rings]
    return kept, first_ones(notes, f"{name}: rings that cross themselves")


def chained(lines):
    """Lines, those that follow each other from end to end being one."""
    parts = [line.points for line in lines]
    ends, done, chains = {}, set(), []
    for i, part in enumerate(parts):
        for end in (0, -1):
            ends.setdefault(tuple(part[end, :2]), []).append((i, end))
    for first, part in enumerate(parts):
        if first in done:
            continue
        ring, members, here = part, [first], tuple(part[-1, :2])
        done.add(first)
        while here != tuple(ring[0, :2]) and len(ends[here]) == 2:
            i, end = next((one for one in ends[here] if one[0] not in done), (None, 0))
            if i is None:
                break
            done.add(i)
            members.append(i)
            ring = numpy.concatenate((ring, (parts[i] if end == 0 else parts[i][::-1])[1:]))
            here = tuple(ring[-1, :2])
        title = list(dict.fromkeys(lines[i].name for i in members))
        more = f" and {counted(len(title) - 1, 'more line')} of its ring" if len(title) > 1 else ""
        cells = [cell for i in members for cell in lines[i].cells]
        chains.append(Line(title[0] + more, ring, cells))
    return chains


def valid(ring, words):
    """[(area, [rings])] of the polygons that GEOS makes of a ring, if it encloses anything.

    words  of the error where GEOS is missing
    """
    try:
        gdal_module()
        from osgeo import ogr
    except ImportError:
        raise refusal(f"{words} Install python3-gdal, which makes it valid", False) from None
    outline, polygon = ogr.Geometry(ogr.wkbLinearRing), ogr.Geometry(ogr.wkbPolygon25D)
    for point in ring.tolist():
        outline.AddPoint(*point)
    polygon.AddGeometry(outline)
    try:
        with quiet():
            made = polygon.MakeValid(["METHOD=STRUCTURE"])
    except RuntimeError:
        made = None
    polygons = pieces_of(made) if made else []
    return [
        (
            one.GetArea(),
            [numpy.array(one.GetGeometryRef(i).GetPoints()) for i in range(one.GetGeometryCount())],
        )
        for one in polygons
    ]


def pieces_of(geometry):
    """The polygons that a geometry is or consists of."""
    if geometry.GetGeometryName() == "POLYGON":
        return [] if geometry.IsEmpty() else [geometry]
    return [
        piece for i in range(geometry.GetGeometryCount())
        for piece in pieces_of(geometry.GetGeometryRef(i))
    ]


def places_in_words(ring, made):
    """Where a ring crosses itself: at points that are new, or at those that it comes to again."""
    old = places_of(ring[:-1])
    new = places_of(numpy.concatenate([part for _, rings in made for part in rings]))
    found = numpy.unique(new[~numpy.isin(new, old)])
    if not len(found):
        found, counts = numpy.unique(old, return_counts=True)
        found = found[counts > 1]
    if not len(found):
        return "where it runs along itself"
    more = f" and {counted(len(found) - 1, 'more place')}" if len(found) > 1 else ""
    return f"at {at(found[0])}{more}"
