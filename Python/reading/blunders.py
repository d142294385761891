# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Single elevations that fit nothing around them, and coordinates that no place has.

All costs are linear; ten million points take a second.
"""

import numpy

from ..clouds import lines_at, slices
from ..messages import counted
from ..progress import items_with_progress, share
from ..ranks import all_values, before, finite_extremes, summed, total
from ..spreading import ids_of, places_of

SAMPLE = 200_000
CHUNK = 1 << 21  # points at once: arrays of a size that memory is kept for
SUSPECTS = 1000  # no more are looked at
NAMED = 5  # that many blunders are named
FAR = 1e100  # no coordinate is that large, and squares of larger ones are infinite


class Numbers:
    """What points are called in notes: by their places among those of all ranks, or lines of the file."""

    def __init__(self, cloud, ranks):
        self.ranks, self.lines = ranks, cloud.lines
        self.noun = "point" if self.lines is None else "line"
        count = cloud.points.GetNumberOfPoints()
        self.ids = ids_of(ranks, cloud.points)
        if ranks and not cloud.points.GetPointData().GetGlobalIds():
            self.ids = self.ids + before(ranks, count)

    def named(self, ids, words, count):
        """"line 7 has z = 1, ..." of the words for the first points of so many."""
        numbers = places_of(self.ranks, ids, self.ids)
        numbers = numbers if self.lines is None else lines_at(self.lines, numbers)
        named = [f"{self.noun} {number} has {one}" for number, one in zip(numbers.tolist(), words)]
        return ", ".join(named) + ", ..." * (count > len(named))


def notes_on_blunders(x, y, z, cloud, ranks, progress):
    """Notes on coordinates that no place has, and on single elevations far from all around them.

    x, y, z  of the points of a Cloud
    ranks    the controller of those that have a Cloud of some of the points each, or None
    """
    numbers = Numbers(cloud, ranks)
    notes = far_off(x, y, z, numbers)
    single = blunders(x, y, z, numbers, progress)
    if single:
        ids = [point for point, *_ in single[:NAMED]]
        words = ["{:.7g} where others have {:.7g} to {:.7g}".format(*one) for _, *one in single[:NAMED]]
        named = numbers.named(ids, words, len(single))
        least = "at least " if len(single) == SUSPECTS else ""
        plural = " is" if len(single) == 1 else "s are"
        notes.append(f"{least}{len(single):,} single elevation{plural} far from all around: {named}")
    return notes


def far_off(x, y, z, numbers):
    """A note on points with a coordinate of FAR or more: blunders() does not look at them."""
    ranges = [finite_extremes(numbers.ranks, values) for values in (x, y, z)]
    if not any(-numpy.inf < low <= -FAR or FAR <= high < numpy.inf for low, high in ranges):
        return []
    far = numpy.zeros(len(z), dtype=bool)
    for values in (x, y, z):
        far |= (abs(values) >= FAR) & numpy.isfinite(values)
    count = count_set(numbers.ranks, far)
    if not count:
        return []
    rows = numpy.flatnonzero(far)
    rows = rows[numpy.argsort(numbers.ids[rows], kind="stable")][:NAMED]
    points = sorted(zip(*gathered(numbers.ranks, rows, numbers.ids, x, y, z)))[:NAMED]
    largest = [max(zip("xyz", xyz), key=lambda pair: abs(pair[1])) for _, *xyz in points]
    words = [f"{axis} = {value:.7g}" for axis, value in largest]
    named = numbers.named([point for point, *_ in points], words, count)
    return [f"{counted(count, 'point')} cannot be a place on earth; take it out of the file: {named}"]


def body(values, ranks=None, among=None):
    """The width of the range that holds 98 % of values, from a sample of them.

    among  None, or (n,) of bool: of these values
    """
    own = len(values) if among is None else numpy.count_nonzero(among)
    count = total(ranks, own)
    if count > SAMPLE:
        rows = numpy.random.default_rng(1).integers(0, max(own, 1), SAMPLE * own // count)
        if among is not None:
            # The places of these rows: each value that does not count moves those behind it on by one.
            others = numpy.flatnonzero(~among)
            rows += numpy.searchsorted(others - numpy.arange(len(others)), rows, "right")
        values = values[rows]
    elif among is not None:
        values = values[among]
    values = all_values(ranks, values[numpy.isfinite(values)], "f8")
    if not len(values):
        return 0.0
    low, high = numpy.percentile(values, (1, 99))
    return float(high - low)


def count_set(ranks, flags):
    """How many are set, on all ranks."""
    return total(ranks, numpy.count_nonzero(flags))


class Cells:
    """A grid of some 16 points a cell over x and y. Its rim stays empty but for points far off.

    columns, count  of the cells; the last one is for points that are not finite. No cells: too few points
    """

    def __init__(self, x, y, ranks):
        count = total(ranks, len(x))
        step = max(1, count // SAMPLE)
        sample = numpy.column_stack((x[::step], y[::step]))
        sample = sample[numpy.isfinite(sample).all(axis=1)]
        sample = all_values(ranks, sample.ravel(), "f8").reshape(-1, 2)
        self.count = 0
        if count < 20 or not len(sample):
            return
        self.low, high = numpy.percentile(sample, (0.5, 99.5), axis=0)
        extent = high - self.low
        area = max(extent[0], 1e-3 * extent[1]) * max(extent[1], 1e-3 * extent[0])
        self.side = (area / (count / 16.0)) ** 0.5
        if self.side > 0 and numpy.isfinite(self.side):
            self.columns, self.rows = (int(length) + 3 for length in extent / self.side)
            self.count = self.columns * self.rows + 1

    def holding(self, x, y, z):
        """The cell of each point."""
        whole = numpy.abs(x + y + z) < FAR
        parts = []
        for values, low, most in ((x, self.low[0], self.columns), (y, self.low[1], self.rows)):
            place = numpy.where(whole, (values - low) / self.side, 0.0)
            parts.append(numpy.clip(place + 1.0, 0.0, most - 1.0).astype("i4"))
        return numpy.where(whole, parts[1] * numpy.int32(self.columns) + parts[0], self.count - 1)


def blunders(x, y, z, numbers, progress):
    """Single elevations far from everything around them: [(id, z, low, high)], the worst first.

    numbers  of the points: their ids, and the ranks that have some each
    low and high are what the points around have. Each point is compared with the others of its
    cell of a grid, by their mean and deviation without it. The few that differ much are compared
    with all points of the 3 x 3 cells around.
    """
    ranks = numbers.ranks
    cells = Cells(x, y, ranks)
    if not cells.count:
        return []
    parts = slices(len(x), CHUNK)
    middle = all_values(ranks, z[:SAMPLE][numpy.abs(z[:SAMPLE]) < FAR], "f8")
    middle = float(numpy.median(middle)) if len(middle) else 0.0
    cell, sums = numpy.empty(len(x), "i4"), numpy.zeros((3, cells.count))
    for part in items_with_progress(parts, share(progress, 0.0, 0.7), len(parts), 1):
        cell[part] = cells.holding(x[part], y[part], z[part])
        height = numpy.where(cell[part] != cells.count - 1, z[part] - middle, 0.0)
        for row, weights in zip(sums, (None, height, height * height)):
            row += numpy.bincount(cell[part], weights, cells.count)
    size, first, second = summed(ranks, sums.ravel()).reshape(3, -1)
    # A point that lies d from the mean of n lies d n / (n - 1) from that of the others; their
    # variance is (n variance - d d n / (n - 1)) / (n - 1). Five deviations of the others are:
    n = numpy.maximum(size, 4.0)
    mean = first / numpy.maximum(size, 1.0)
    variance = numpy.maximum(second / n - mean * mean, 0.0)
    limit = numpy.sqrt(25.0 * n * variance / (n * n / (n - 1) + 25.0 * n / (n - 1)))
    least = 0.1 * body(z, ranks)
    limit = numpy.maximum(limit, least)
    limit[size < 4] = limit[-1] = numpy.inf
    mean += middle
    suspects = [numpy.zeros(0, "i8")]
    for part in items_with_progress(parts, share(progress, 0.7, 0.9), len(parts), 1):
        away = abs(z[part] - mean[cell[part]])
        suspects.append(part.start + numpy.flatnonzero(away > limit[cell[part]]))
    suspects = numpy.concatenate(suspects)
    if not total(ranks, len(suspects)):
        return []

    def worst(ids, cell, z):
        return numpy.lexsort((ids, -abs(z - mean[cell])))[:SUSPECTS]

    suspects = suspects[worst(*(one[suspects] for one in (numbers.ids, cell, z)))]
    found = gathered(ranks, suspects, numbers.ids, cell, z)
    ids, places, heights = (one[worst(*found)] for one in found)
    around = numpy.add.outer(cells.columns * numpy.arange(-1, 2), numpy.arange(-1, 2)).ravel()
    wanted = numpy.zeros(cells.count, dtype=bool)
    wanted[numpy.clip(places[:, None] + around, 0, cells.count - 1)] = True
    wanted[-1] = False
    near = gathered(ranks, numpy.flatnonzero(wanted[cell]), numbers.ids, cell, z)
    suspects = list(zip(ids.tolist(), places.tolist(), heights.tolist()))
    return compared(suspects, near, around, least, share(progress, 0.9, 1.0))


def gathered(ranks, rows, *columns):
    """Some rows of arrays of each rank, of all of them."""
    return [all_values(ranks, column[rows], "f8" if column.dtype.kind == "f" else "i8") for column in columns]


def compared(suspects, near, around, least, progress):
    """Those suspects that are far from the points of the 3 x 3 cells around them.

    suspects  [(id, cell, z)]
    near      their arrays, of all points in these cells
    around    how the numbers of these cells differ from that of the suspect
    least     a smaller distance does not count
    Returns [(id, z, low, high)] as blunders().
    """
    order = numpy.argsort(near[1], kind="stable")
    ids, starts, heights = (one[order] for one in near)
    result = []
    for point, cell, z in items_with_progress(suspects, progress, len(suspects), 50):
        first = numpy.searchsorted(starts, cell + around)
        last = numpy.searchsorted(starts, cell + around, "right")
        rows = numpy.concatenate([numpy.arange(a, b) for a, b in zip(first, last)])
        others = numpy.sort(heights[rows[ids[rows] != point]])
        if len(others) < 8:
            continue
        trim = 1 + len(others) // 50
        low, high = float(others[trim]), float(others[-1 - trim])
        if max(low - z, z - high) > max(5.0 * (high - low), least):
            result.append((point, z, low, high))
    return result
