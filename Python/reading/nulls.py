# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values that stand for missing data, and single elevations that fit nothing around them.

A usual null value is taken out where it stands apart: almost no other value is near it. So -9999
goes from a terrain of 0 to 3000, and stays in a trench of -10,500 to -9,000. All costs are linear;
ten million points take some two seconds.
"""

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from ..clouds import keep_points
from ..messages import Reason, counted, of_reason
from ..names import option
from ..progress import share, told_items

FLOAT_MAX = float(numpy.finfo("f4").max)
NULLS = (
    (-9999.0, -999.25, -999.0, -9999.25, -99999.0, -999999.0, -9999999.0, -99999.99, -9999.99)
    + (9999.0, 99999.0, 999999.0, 9999900.0, 9999999.0, 999.25, 99999.99)
    + (-32768.0, -32767.0, 32767.0, -2147483648.0, 2147483647.0)
    + (1e30, -1e30, 1e20, -1e20, 1e35, 1.70141e38, FLOAT_MAX, -FLOAT_MAX, 3.4e38, -3.4e38)
)
SAMPLE = 200_000
CHUNK = 1 << 21  # points at once: arrays of a size that memory is kept for
SUSPECTS = 1000  # no more are looked at
NAMED = 5  # that many blunders are named
FAR = 1e100  # no coordinate is that large, and squares of larger ones are infinite


@numpy.errstate(all="ignore")
def take_out(cloud, options):
    """Takes usual null values out of a Cloud, and names what looks like nulls or blunders.

    options  ReadOptions; with keep_nulls all points stay
    Returns the cloud. What is taken out is counted in its left_out, what is doubtful is in its
    notes. A cloud of nothing but nulls stays as it is.
    """
    coordinates = vtk_to_numpy(cloud.points.GetPoints().GetData())
    axes, progress = [], options.progress
    for i in range(3):
        axes.append(numpy.ascontiguousarray(coordinates[:, i], dtype="f8"))
        progress(0.1 * i)
    null, counts = numpy.zeros(len(coordinates), dtype=bool), {}
    for done, (axis, name) in enumerate(((2, "z"), (0, "x"), (1, "y"))):
        values = axes[axis]
        progress(0.2 + 0.05 * done)
        for value, found in usual_nulls(values, is_place=axis < 2):
            found &= ~null
            if found.any():
                counts[Reason("null value", f"({name} = {value:.9g})")] = int(numpy.count_nonzero(found))
                null |= found
    found = zero_rows(*axes) & ~null
    if found.any():
        counts[Reason("row", "0 0 0")] = int(numpy.count_nonzero(found))
        null |= found
    progress(0.35)
    if counts and not null.all():
        if options.keep_nulls:
            words = ", ".join(of_reason(count, name) for name, count in counts.items())
            cloud.notes.append(f"kept: {words}")
        else:
            keep_points(cloud, numpy.flatnonzero(~null))
            axes = [values[~null] for values in axes]
            cloud.left_out.update(counts)
            cloud.notes.append(f"usual null values are left out; {option('keep_nulls')} keeps them")
    if not options.keep_nulls:
        cloud.notes += doubts(*axes, cloud.lines, share(progress, 0.4, 1.0))
    return cloud


def doubts(x, y, z, lines, progress):
    """Notes on values that may be nulls, and on single elevations far from all around them."""
    notes = []
    for value, count in repeated_extremes(z, share(progress, 0.0, 0.2)):
        notes.append(
            f"{count:,} points have z = {value:.9g}, far from all others; if that means no data: "
            f"{option('no_data')} {value:.9g}"
        )
        z[z == value] = numpy.nan
    where = "point" if lines is None else "line"
    number = range(len(z)) if lines is None else lines
    notes += far_off(x, y, z, where, number)
    single = blunders(x, y, z, share(progress, 0.25, 1.0))
    if single:
        words = [
            f"{where} {number[i]} has {z[i]:.7g} where others have {low:.7g} to {high:.7g}"
            for i, low, high in single[:NAMED]
        ]
        more = ", ..." if len(single) > NAMED else ""
        least = "at least " if len(single) == SUSPECTS else ""
        plural = " is" if len(single) == 1 else "s are"
        notes.append(
            f"{least}{len(single):,} single elevation{plural} far from "
            f"all around: {', '.join(words)}{more}"
        )
    return notes


def far_off(x, y, z, where, number):
    """A note on points with a coordinate of FAR or more: blunders() does not look at them."""
    far = numpy.zeros(len(z), dtype=bool)
    for values in (x, y, z):
        low, high = limits(values)
        if max(-low, high) >= FAR:
            far |= (abs(values) >= FAR) & numpy.isfinite(values)
    ids = numpy.flatnonzero(far)
    if not len(ids):
        return []
    words = []
    for i in ids[:NAMED].tolist():
        axis, value = max(zip("xyz", (x[i], y[i], z[i])), key=lambda pair: abs(pair[1]))
        words.append(f"{where} {number[i]} has {axis} = {value:.7g}")
    more = ", ..." if len(ids) > NAMED else ""
    return [
        f"{counted(len(ids), 'point')} cannot be a place on earth; take it out of the file: "
        f"{', '.join(words)}{more}"
    ]


def body(values):
    """The width of the range that holds 98 % of values, from a sample of them."""
    if len(values) > SAMPLE:
        values = values[numpy.random.default_rng(1).integers(0, len(values), SAMPLE)]
    values = values[numpy.isfinite(values)]
    if not len(values):
        return 0.0
    low, high = numpy.percentile(values, (1, 99))
    return float(high - low)


def limits(values):
    """The least and the greatest value that is finite; (inf, -inf) where none is."""
    low, high = float(numpy.fmin.reduce(values)), float(numpy.fmax.reduce(values))
    if numpy.isfinite(low) and numpy.isfinite(high):
        return low, high
    values = values[numpy.isfinite(values)]
    return values.min(initial=numpy.inf), values.max(initial=-numpy.inf)


def stands_apart(value, count, others, width):
    """Whether a value that occurs count times has almost no others near it.

    Near is half the width that most others span; a tenth where the value occurs often, as nulls do.
    """
    reach = max((0.1 if count > 2 else 0.5) * width, 0.05 * abs(value))
    near = numpy.count_nonzero((others > value - reach) & (others < value + reach))
    return near <= count // 20


def usual_nulls(values, is_place=False):
    """[(value, (n,) of bool)]: the usual null values in an array that stand apart.

    is_place  x or y: these are apart where they are twice as far as the others are wide
    """
    low, high = limits(values)
    present = []
    for value in NULLS:
        # As text or single precision wrote it.
        slack = 1e-5 * abs(value) if abs(value) >= 1e20 else 0.0
        if low - slack <= value <= high + slack:
            found = numpy.abs(values - value) <= slack if slack else values == value
            if found.any():
                present.append((value, found))
    if not present:
        return []
    others = numpy.isfinite(values)
    for _, found in present:
        others &= ~found
    others = values[others]
    if not len(others):
        return []
    width = body(others)
    if is_place:
        if width == 0:
            return []
        width *= 20.0
    return [
        (value, found)
        for value, found in present
        if stands_apart(value, int(numpy.count_nonzero(found)), others, width)
    ]


def zero_rows(x, y, z):
    """Which rows are 0 0 0, where x,y of the others are all elsewhere."""
    zero = (x == 0.0) & (y == 0.0) & (z == 0.0)
    if zero.any() and not zero.all():
        near = ~zero
        for values in (x, y):
            near &= numpy.abs(values) < max(body(values[~zero]), 1e-300)
        if near.any():
            zero[:] = False
    return zero


def repeated_extremes(z, progress):
    """[(value, count)]: the least and the greatest value, where it is repeated and stands apart."""
    result = []
    for i, value in enumerate(limits(z)):
        progress(0.5 * i)
        is_it = z == value
        count = int(numpy.count_nonzero(is_it))
        if 3 <= count < len(z) // 2:
            others = z[~is_it]
            if stands_apart(value, 1, others, body(others)):
                result.append((value, count))
    return result


class Cells:
    """A grid of some 16 points a cell over x and y. Its rim stays empty but for points far off.

    columns, count  of the cells; the last one is for points that are not finite
    """

    def __init__(self, x, y):
        step = max(1, len(x) // SAMPLE)
        sample = numpy.column_stack((x[::step], y[::step]))
        sample = sample[numpy.isfinite(sample).all(axis=1)]
        low, high = numpy.percentile(sample, (0.5, 99.5), axis=0) if len(sample) else (0.0, 0.0)
        extent = numpy.asarray(high - low)
        self.low, self.count = low, 0
        if len(x) < 20 or not (numpy.isfinite(extent).all() and extent.max() > 0):
            return
        area = max(extent[0], 1e-3 * extent[1]) * max(extent[1], 1e-3 * extent[0])
        self.side = (area / (len(x) / 16.0)) ** 0.5
        if self.side > 0 and numpy.isfinite(self.side):
            self.columns, self.rows = (int(length) + 3 for length in extent / self.side)
            self.count = self.columns * self.rows + 1

    def of(self, x, y, z):
        """The cell of each point."""
        whole = numpy.abs(x + y + z) < FAR
        parts = []
        for values, low, most in ((x, self.low[0], self.columns), (y, self.low[1], self.rows)):
            place = numpy.where(whole, (values - low) / self.side, 0.0)
            parts.append(numpy.clip(place + 1.0, 0.0, most - 1.0).astype("i4"))
        return numpy.where(whole, parts[1] * numpy.int32(self.columns) + parts[0], self.count - 1)


def blunders(x, y, z, progress):
    """Single elevations far from everything around them: [(index, low, high)], the worst first.

    low and high are what the points around have. Each point is compared with the others of its
    cell of a grid, by their mean and deviation without it. The few that differ much are compared
    with all points of the 3 x 3 cells around.
    """
    cells = Cells(x, y)
    if not cells.count:
        return []
    parts = [slice(start, start + CHUNK) for start in range(0, len(x), CHUNK)]
    told, count = share(progress, 0.0, 0.4), len(parts)
    cell = [cells.of(x[p], y[p], z[p]) for p in told_items(parts, told, count, 1)]
    cell = numpy.concatenate(cell)
    middle = z[:SAMPLE][numpy.abs(z[:SAMPLE]) < FAR]
    middle = float(numpy.median(middle)) if len(middle) else 0.0
    sums = numpy.zeros((3, cells.count))
    for part in told_items(parts, share(progress, 0.4, 0.7), count, 1):
        known = cell[part] != cells.count - 1
        height = numpy.where(known, z[part] - middle, 0.0)
        for total, weights in zip(sums, (None, height, height * height)):
            total += numpy.bincount(cell[part], weights, cells.count)
    size = numpy.maximum(sums[0], 1.0)
    mean = sums[1] / size
    variance = numpy.maximum(sums[2] / size - mean * mean, 0.0)
    # A point that lies d from the mean of n lies d n / (n - 1) from that of the others; their
    # variance is (n variance - d d n / (n - 1)) / (n - 1). Five deviations of the others are:
    n = numpy.maximum(size, 4.0)
    limit = numpy.sqrt(25.0 * n * variance / (n * n / (n - 1) + 25.0 * n / (n - 1)))
    least = 0.1 * body(z)
    limit = numpy.maximum(limit, least)
    limit[size < 4] = limit[-1] = numpy.inf
    mean += middle
    suspects = numpy.concatenate(
        [
            part.start + numpy.flatnonzero(abs(z[part] - mean[cell[part]]) > limit[cell[part]])
            for part in told_items(parts, share(progress, 0.7, 0.9), count, 1)
        ]
    )
    if not len(suspects):
        return []
    order = numpy.argsort(-abs(z[suspects] - mean[cell[suspects]]), kind="stable")
    return compared(
        suspects[order][:SUSPECTS], z, cell, cells, least, share(progress, 0.9, 1.0)
    )


def compared(suspects, z, cell, cells, least, progress):
    """Those suspects that are far from the points of the 3 x 3 cells around them.

    least  a smaller distance does not count
    Returns [(index, low, high)] as blunders().
    """
    around = numpy.add.outer(cells.columns * numpy.arange(-1, 2), numpy.arange(-1, 2)).ravel()
    wanted = numpy.zeros(cells.count, dtype=bool)
    wanted[numpy.clip(cell[suspects][:, None] + around, 0, cells.count - 1)] = True
    wanted[-1] = False
    near = numpy.flatnonzero(wanted[cell])
    near = near[numpy.argsort(cell[near], kind="stable")]
    starts = cell[near]
    result = []
    for i in told_items(suspects.tolist(), progress, len(suspects), 50):
        first = numpy.searchsorted(starts, cell[i] + around)
        last = numpy.searchsorted(starts, cell[i] + around, "right")
        ids = numpy.concatenate([near[a:b] for a, b in zip(first, last)])
        others = numpy.sort(z[ids[ids != i]])
        if len(others) < 8:
            continue
        trim = 1 + len(others) // 50
        low, high = float(others[trim]), float(others[-1 - trim])
        if max(low - z[i], z[i] - high) > max(5.0 * (high - low), least):
            result.append((i, low, high))
    return result
