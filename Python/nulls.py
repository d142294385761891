# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values that stand for missing data, and single elevations that fit nothing around them.

A usual null value is taken out where it stands apart: almost no other value is near it. So -9999
goes from a terrain of 0 to 3000, and stays in a trench of -10,500 to -9,000. All costs are linear;
ten million points take some two seconds.
"""

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from .clouds import keep_points

FLOAT_MAX = float(numpy.finfo("f4").max)
NULLS = (
    (-9999.0, -999.25, -999.0, -9999.25, -99999.0, -999999.0, -9999999.0, -99999.99, -9999.99)
    + (9999.0, 99999.0, 999999.0, 9999900.0, 9999999.0, 999.25, 99999.99)
    + (-32768.0, -32767.0, 32767.0, -2147483648.0, 2147483647.0)
    + (1e30, -1e30, 1e20, -1e20, 1e35, 1.70141e38, FLOAT_MAX, -FLOAT_MAX, 3.4e38, -3.4e38)
)
SAMPLE = 200_000
NAMED = 5  # that many blunders are named


def take_out(cloud, options):
    """Takes usual null values out of a Cloud, and names what looks like nulls or blunders.

    options  ReadOptions; with keep_nulls all points stay
    Returns the cloud. What is taken out is counted in its left_out, what is doubtful is in its
    notes. A cloud of nothing but nulls stays as it is.
    """
    coordinates = vtk_to_numpy(cloud.points.GetPoints().GetData())
    null, counts = numpy.zeros(len(coordinates), dtype=bool), {}
    for axis, name in ((2, "z"), (0, "x"), (1, "y")):
        values = numpy.ascontiguousarray(coordinates[:, axis], dtype="f8")
        for value, found in usual_nulls(values, is_place=axis < 2):
            found &= ~null
            if found.any():
                counts[f"null values ({name} = {value:.9g})"] = int(numpy.count_nonzero(found))
                null |= found
    found = zero_rows(coordinates) & ~null
    if found.any():
        counts["rows 0 0 0"] = int(numpy.count_nonzero(found))
        null |= found
    if counts and not null.all():
        if options.keep_nulls:
            words = ", ".join(f"{count:,} {name}" for name, count in counts.items())
            cloud.notes.append(f"kept: {words}")
        else:
            keep_points(cloud, numpy.flatnonzero(~null))
            cloud.left_out.update(counts)
            cloud.notes.append("usual null values are left out; --keep-nulls keeps them")
    if not options.keep_nulls:
        cloud.notes += doubts(cloud)
    return cloud


def doubts(cloud):
    """Notes on values that may be nulls, and on single elevations far from all around them."""
    coordinates = vtk_to_numpy(cloud.points.GetPoints().GetData())
    x, y, z = (numpy.ascontiguousarray(coordinates[:, i], dtype="f8") for i in range(3))
    notes = []
    for value, count in repeated_extremes(z):
        notes.append(
            f"{count:,} points have z = {value:.9g}, far from all others; if that means no data: "
            f"--no-data {value:.9g}"
        )
        z[z == value] = numpy.nan
    single = blunders(x, y, z)
    if single:
        where = "point" if cloud.lines is None else "line"
        number = range(len(z)) if cloud.lines is None else cloud.lines
        words = [
            f"{where} {number[i]} has {z[i]:.7g} where others have {low:.7g} to {high:.7g}"
            for i, low, high in single[:NAMED]
        ]
        more = ", ..." if len(single) > NAMED else ""
        notes.append(
            f"{len(single):,} single elevation{'s are' if len(single) > 1 else ' is'} far from "
            f"all around: {', '.join(words)}{more}"
        )
    return notes


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


def zero_rows(coordinates):
    """Which rows are 0 0 0, where x,y of the others are all elsewhere."""
    zero = coordinates[:, 0] == 0.0
    if zero.any():
        zero &= (coordinates[:, 1:] == 0.0).all(axis=1)
    if not zero.any() or zero.all():
        return numpy.zeros(len(zero), dtype=bool)
    near = ~zero
    for axis in (0, 1):
        values = coordinates[:, axis]
        near &= numpy.abs(values) < max(body(values[~zero]), 1e-300)
    return zero if not near.any() else numpy.zeros(len(zero), dtype=bool)


def repeated_extremes(z):
    """[(value, count)]: the least and the greatest value, where it is repeated and stands apart."""
    result = []
    for value in limits(z):
        is_it = z == value
        count = int(numpy.count_nonzero(is_it))
        if 3 <= count < len(z) // 2:
            others = z[~is_it]
            if stands_apart(value, 1, others, body(others)):
                result.append((value, count))
    return result


def blunders(x, y, z):
    """Single elevations far from everything around them: [(index, low, high)], the worst first.

    low and high are what the points around have. Each point is compared with the others of its
    cell of a grid with some 16 points a cell, by their mean and deviation without it. The few
    that differ much are compared with all points of the 3 x 3 cells around.
    """
    cell, columns = cells_of(x, y, z)
    if cell is None:
        return []
    width = body(z)
    z = numpy.where(cell < 0, 0.0, z)
    cell = numpy.where(cell < 0, cell.max() + 2, cell)  # those that are not finite, on their own
    size = numpy.bincount(cell)
    shift = z - numpy.median(z[:SAMPLE])
    mean = numpy.bincount(cell, shift) / numpy.maximum(size, 1)
    shift -= mean[cell]
    variance = numpy.bincount(cell, shift * shift) / numpy.maximum(size, 1)
    # A point that lies d from the mean of n lies d n / (n - 1) from that of the others; their
    # variance is (n variance - d d n / (n - 1)) / (n - 1). Five deviations of the others are:
    n = numpy.maximum(size, 4.0)
    limit = numpy.sqrt(25.0 * n * variance / (n * n / (n - 1) + 25.0 * n / (n - 1)))
    limit = numpy.maximum(limit, 0.1 * width)
    limit[size < 4] = numpy.inf
    suspects = numpy.flatnonzero(numpy.abs(shift) > limit[cell])
    if not len(suspects):
        return []
    order = numpy.argsort(-numpy.abs(shift[suspects]), kind="stable")
    suspects = suspects[order][:200]
    around = numpy.array([[r * columns + c for c in (-1, 0, 1)] for r in (-1, 0, 1)]).ravel()
    wanted = numpy.zeros(cell.max() + columns + 2, dtype=bool)
    wanted[numpy.maximum(cell[suspects][:, None] + around, 0)] = True
    near = numpy.flatnonzero(wanted[cell])
    near = near[numpy.argsort(cell[near], kind="stable")]
    starts = cell[near]
    result = []
    for i in suspects.tolist():
        ids = numpy.concatenate(
            [
                near[numpy.searchsorted(starts, k) : numpy.searchsorted(starts, k, "right")]
                for k in (cell[i] + around).tolist()
            ]
        )
        others = numpy.sort(z[ids[ids != i]])
        trim = 1 + len(others) // 50
        if len(others) < 8:
            continue
        low, high = float(others[trim]), float(others[-1 - trim])
        gap = max(low - z[i], z[i] - high)
        if gap > max(5.0 * (high - low), 0.1 * width):
            result.append((i, low, high))
    return result


def cells_of(x, y, z):
    """(cell of each point, cells in a row); the cell is -1 where a coordinate is not finite.

    (None, 0) where there are too few points.
    """
    good = numpy.isfinite(x) & numpy.isfinite(y) & (numpy.abs(z) < 1e100)
    count = int(numpy.count_nonzero(good))
    if count < 20:
        return None, 0
    sample = numpy.flatnonzero(good)
    sample = sample[:: max(1, count // SAMPLE)]
    low = numpy.array([x[sample].min(), y[sample].min()])
    extent = numpy.array([x[sample].max(), y[sample].max()]) - low
    if not (numpy.isfinite(extent).all() and extent.max() > 0):
        return None, 0
    area = max(extent[0], 1e-3 * extent[1]) * max(extent[1], 1e-3 * extent[0])
    side = (area / (count / 16.0)) ** 0.5
    if not (side > 0 and numpy.isfinite(side)):
        return None, 0
    shape = (extent / side).astype("i8") + 3  # a rim of empty cells
    parts = []
    for values, start, most in ((x, low[0], shape[0]), (y, low[1], shape[1])):
        place = numpy.where(good, (values - start) / side, 0.0)
        parts.append(numpy.clip(place, 0, most - 3).astype("i4") + 1)
    cell = parts[1] * shape[0] + parts[0]
    return numpy.where(good, cell, -1), int(shape[0])
