# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Several heights at one place: how many, how far apart, and whether a column separates them.

An elevation surface has one height at a place. Of several, vtkGridDelaunay2D takes one and counts
the others. That is right for a few, and wrong for two horizons in one table. The second is refused,
unless the user says which height to take.

Heights are clearly apart where they differ by more than CLEAR_RANGE_SHARE of the range that holds 98 %
of all z, and by more than CLEAR_STEPS times the step that is usual from one place to the next, for
each height that the place has, up to MOST_STEPS times: noise and slopes make both about the same,
and the more heights, the farther apart noise makes the outer ones. They are many at more than MANY
of the places.

A column separates heights where, at almost all places, each of its values has one height, and
values come again from place to place. Its values are surfaces where, of two that share places, one
is almost always above the other, so crossing survey lines are not surfaces. Then the second
condition for clearly apart is dropped, and of text, which names things, MANY_BY_NAME of the
places is enough.
"""

import dataclasses
import shlex

import numpy
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes

from .clouds import coordinates_of, marked_points, slices
from .messages import ElevationSurfaceError, counted
from .names import option
from .passes import maybe_shared
from .properties import DUPLICATES
from .ranks import collected, together, total
from .reading.blunders import body
from .selecting import MOST_VALUES, Words, as_option, coded, columns_in, shown_values
from .spreading import NOT_FINITE, SAME_PLACE

MANY = 0.01  # of all places
MANY_BY_NAME = 0.001
LEAST = 3  # places; fewer are never many
CLEAR_RANGE_SHARE = 0.02
CLEAR_STEPS, MOST_STEPS = 1.5, 6.0
USUAL = 90  # per cent of steps are no larger than the usual one: a plain may have steep banks
ALMOST = 0.95  # of the places
ALWAYS = 0.9  # of pairs of heights at a place


@dataclasses.dataclass
class Several:
    """The places with several heights.

    ids      (k,) the points there, by place, each from the lowest to the highest
    starts   (p,) where in ids the points of each place begin
    spans    (p,) how far the highest is above the lowest
    places   how many distinct places all points have
    """

    ids: numpy.ndarray
    starts: numpy.ndarray
    spans: numpy.ndarray
    places: int

    def count(self):
        return len(self.starts)

    def largest(self):
        return float(self.spans.max())

    def lengths(self):
        return numpy.diff(self.starts, append=len(self.ids))


def shared_places(xyz):
    """(ids of the points that share x,y with others, by place and z; where places begin). xyz: (n, 3);
    points that are not finite share none."""
    maybe = maybe_shared(xyz)
    order = numpy.lexsort(xyz[maybe].T[::-1])
    xy = xyz[maybe[order], :2]
    differs = (xy[1:] != xy[:-1]).any(axis=1)
    begins, ends = (numpy.concatenate(sides)[: len(order)] for sides in (([True], differs), (differs, [True])))
    shared = ~(begins & ends)
    return maybe[order[shared]], numpy.flatnonzero(begins[shared])


def several_heights(xyz):
    """The Several of (n, 3) points, or None where each place has one height."""
    ids, starts = shared_places(xyz)
    if not len(ids):
        return None
    lengths, many = numpy.diff(starts, append=len(ids)), len(ids) - len(starts)
    z = xyz[ids, 2].astype("f8")
    spans = z[starts + lengths - 1] - z[starts]
    kept = spans > 0
    if not kept.any():
        return None
    points = numpy.repeat(kept, lengths)
    starts = numpy.cumsum(lengths[kept]) - lengths[kept]
    finite = sum(numpy.count_nonzero(numpy.isfinite(xyz[rows]).all(axis=1)) for rows in slices(len(xyz)))
    return Several(ids[points], starts, spans[kept], int(finite) - many)


def usual_step(xyz, several):
    """The usual difference of z between neighbouring places: those in one cell of a grid of
    some two places a cell. Of several heights at a place the lowest count, or the highest, whichever
    gives less: the ends of wells are uneven, the ground is not."""
    ends = several.starts + several.lengths() - 1
    return min(step_between(xyz, several, chosen) for chosen in (several.starts, ends))


def step_between(xyz, several, chosen):
    """That of usual_step(), of several heights those chosen."""
    alone = numpy.isfinite(xyz).all(axis=1)
    alone[several.ids] = False
    alone[several.ids[chosen]] = True
    places = xyz[alone].astype("f8")
    extent = numpy.ptp(places[:, :2], axis=0)
    side = float(numpy.sqrt(2.0 * max(extent.prod(), 0.0) / len(places)))
    side = side or 2.0 * float(extent.max()) / len(places)
    if not 0.0 < side < numpy.inf:
        return 0.0
    cell = numpy.floor((places[:, :2] - places[:, :2].min(axis=0)) / side)
    order = numpy.lexsort(cell.T)
    near = (numpy.diff(cell[order], axis=0) == 0).all(axis=1)
    steps = numpy.abs(numpy.diff(places[order, 2]))[near]
    return float(numpy.percentile(steps, USUAL)) if len(steps) else 0.0


class Column:
    """Whether a column separates the heights of Several.

    share     of the places at which each of its values has one height
    in_order  whether of two of its values that share places one is almost always above the other
    count     how many values it has there
    """

    def __init__(self, column, several, z):
        is_text = isinstance(column, Words)
        self.least = MANY_BY_NAME if is_text else MANY
        self.share, self.in_order, self.count = 0.0, False, 0
        codes, values = coded(column.some(several.ids) if is_text else column[several.ids])
        self.count = len(values)
        if not 1 < self.count <= min(MOST_VALUES, len(codes) / LEAST):
            return
        place = numpy.repeat(numpy.arange(several.count()), several.lengths())
        self.share = 1.0 - len(numpy.unique(place[self.mixed(place, codes, z)])) / several.count()
        if self.share >= ALMOST:
            self.in_order = self.are_in_order(place, codes, z)

    @staticmethod
    def mixed(place, codes, z):
        """Which points have no value, or one that has another height at the same place."""
        order = numpy.lexsort((z, codes, place))
        same = (numpy.diff(place[order]) == 0) & (numpy.diff(codes[order]) == 0)
        bad = codes < 0
        bad[order[1:]] |= same & (numpy.diff(z[order]) != 0)
        return bad

    @staticmethod
    def are_in_order(place, codes, z):
        above = (numpy.diff(place) == 0) & (numpy.diff(z) > 0)
        low, high = codes[:-1][above].astype("i8"), codes[1:][above].astype("i8")
        pairs = numpy.minimum(low, high) * (codes.max() + 1) + numpy.maximum(low, high)
        _, which = numpy.unique(pairs, return_inverse=True)
        total = numpy.bincount(which)
        rising = numpy.bincount(which, low < high)
        often = total >= LEAST
        agreed = numpy.maximum(rising, total - rising)[often].sum()
        return total[often].sum() >= ALWAYS * len(pairs) and agreed >= ALWAYS * total[often].sum()

    def rank(self):
        """The least is the best."""
        return not self.in_order, self.least, self.count


def separating_column(cloud, several, z):
    """(name, column, Column) that separates the heights best, or None. The name of the files that
    are merged is None."""
    columns = dict(columns_in(cloud))
    if cloud.files is not None:
        columns[None] = cloud.files
    found = [(name, column, Column(column, several, z)) for name, column in columns.items()]
    found = [one for one in found if one[2].share >= ALMOST]
    return min(found, key=lambda one: one[2].rank(), default=None)


def check_heights(cloud, policy=None):
    """(note, facts for the report) on places of a Cloud with several heights; (None, None) where
    there are none.

    policy  the number of the user's choice among DUPLICATES, or None: then ElevationSurfaceError is
            raised where heights are those of several surfaces
    """
    if not cloud.points.GetNumberOfPoints():
        return None, None
    xyz = coordinates_of(cloud.points)
    hidden = marked_points(cloud.points, vtkDataSetAttributes.HIDDENPOINT)
    if hidden.any():
        xyz = numpy.where(hidden[:, None], numpy.nan, xyz)
    several = several_heights(xyz)
    if several is None:
        return None, None
    if policy is None:
        refuse_surfaces(cloud, xyz, several)
    return note_on(several.count(), several.largest(), policy), facts_of(several)


def facts_of(several):
    return {"places": several.count(), "of": several.places, "largest": several.largest()}


def note_on(count, largest, policy):
    """The note on so many places with several heights."""
    taken = DUPLICATES[policy or 0].split("-")[1]
    return (
        f"{counted(count, 'place has', 'places have')} several heights, up to {largest:.7g} apart: "
        f"the {taken} is taken (see {option('duplicates')})"
    )


def refuse_surfaces(cloud, xyz, several):
    """Raises ElevationSurfaceError where heights are those of several surfaces."""
    most = max(LEAST, MANY_BY_NAME * several.places)
    if several.count() < most:
        return
    clear = several.spans > CLEAR_RANGE_SHARE * body(xyz[:, 2].astype("f8"))
    numbers = in_numbers(several.count(), several.places, several.largest())
    separating = separating_column(cloud, several, xyz[several.ids, 2].astype("f8"))
    if separating and separating[2].in_order:
        most = max(LEAST, separating[2].least * several.places)
        if numpy.count_nonzero(clear) >= most:
            raise ElevationSurfaceError(f"{numbers}; {way_out(separating)}")
    if are_many(numpy.count_nonzero(clear), several.places):
        clear &= several.spans > least_span(xyz, several)
        if are_many(numpy.count_nonzero(clear), several.places):
            raise ElevationSurfaceError(f"{numbers}; {way_out(separating)}")


def are_many(count, places):
    return count > max(LEAST - 1, MANY * places)


def least_span(xyz, several):
    """(p,) how far heights have to be apart to be more than noise and slopes."""
    steps = numpy.minimum(CLEAR_STEPS * several.lengths(), MOST_STEPS)
    return steps * usual_step(xyz, several)


def in_numbers(count, places, largest):
    return (
        f"{count:,} of {counted(places, 'place')} have several heights, up to {largest:.7g} apart, "
        "so this is not one surface"
    )


def policies():
    return f"{option('duplicates')} keep-highest (or lowest, first, last) takes one height at each place"


def way_out(separating):
    """Advice for the user, given the separating_column(), or None."""
    if separating is None:
        return (
            "no column separates them; give each surface a file, or a column with its name; "
            f"{policies()}"
        )
    name, column, _ = separating
    if name is None:
        return f"the files separate them: {option('each')} makes a surface of each; {policies()}"
    value = coded(column)[1][0]
    called = name if name.startswith("column ") else f"column {name}"
    return (
        f"{called} separates them: {shown_values(column)}; {option('each_value')} {shlex.quote(name)} "
        f"makes a surface of each value, {as_option(name, value)} one of this; {policies()}"
    )


def heights_on_ranks(ranks, result, policy):
    """As check_heights(), of a Reconstruction whose points are triangulated: then all points at a place
    are on one rank. It looks at no columns."""
    heights, xyz = PieceHeights(ranks), result.coordinates
    heights.see(xyz)
    heights.take_sample()
    heights.add(xyz)
    is_vertex = ~numpy.isin(result.reasons, (SAME_PLACE, NOT_FINITE))
    return heights.check(total(ranks, numpy.count_nonzero(is_vertex)), policy)


class PieceHeights:
    """Places with several heights of a surface that is made piece by piece, without columns. A
    place is in one piece, with all its points.

    ranks  the controller of those that have points and pieces, or None
    """

    def __init__(self, ranks):
        self.ranks = ranks
        self.count = self.clear = 0
        self.largest, self.sample, self.body = 0.0, [numpy.empty(0)], 0.0

    def see(self, xyz):
        """Takes some z of points that are read, before there are pieces."""
        self.sample.append(xyz[:: 1 + len(xyz) // 1000, 2].astype("f8"))

    def take_sample(self):
        """All ranks have to call it once the points are read."""
        sample = collected(self.ranks, numpy.concatenate(self.sample), "f8")
        self.body = body(numpy.concatenate(sample))

    def add(self, xyz):
        """Takes the points of a piece, used or not."""
        several = several_heights(xyz)
        if several is None:
            return
        self.count += several.count()
        self.largest = max(self.largest, several.largest())
        clear = several.spans > CLEAR_RANGE_SHARE * self.body
        if clear.any():
            clear &= several.spans > least_span(xyz, several)
        self.clear += int(numpy.count_nonzero(clear))

    def check(self, places, policy):
        """As check_heights(), once all pieces of all ranks are known; places: how many distinct ones
        there are. All ranks have to call it."""
        found = together(self.ranks, lambda: [[self.count, self.clear, self.largest]])
        counts, clear, largest = zip(*found)
        self.count, self.clear, self.largest = sum(counts), sum(clear), max(largest)
        if not self.count:
            return None, None
        if policy is None and are_many(self.clear, places):
            one = as_option("COLUMN", "VALUE")
            raise ElevationSurfaceError(
                f"{in_numbers(self.count, places, self.largest)}; a run in pieces looks at no "
                f"columns: if one separates the heights, {one} takes those of one value; {policies()}"
            )
        facts = {"places": self.count, "of": places, "largest": self.largest}
        return note_on(self.count, self.largest, policy), facts
