# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values that stand for missing data.

A usual null value is taken out where it stands apart: almost no other value is near it. So -9999
goes from a terrain of 0 to 3000, and stays in a trench of -10,500 to -9,000. All costs are linear.
"""

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_DOUBLE, VTK_FLOAT

from ..clouds import coordinates_of, keep_points
from .blunders import body, count_set, notes_on_blunders
from .tables import known
from ..messages import FileError, Reason, counted, counted_reason
from ..names import option
from ..progress import no_progress, share
from ..ranks import finite_extremes, total

ALL_WITHOUT_DATA = "all points have the elevation that marks missing data"


@numpy.errstate(all="ignore")
def take_out(cloud, options, ranks=None):
    """Takes usual null values out of a Cloud, and names what looks like nulls or blunders.

    options  ReadOptions; with keep_nulls all points stay
    ranks    the controller of those that have a Cloud of some of the points each, or None. Of more than
             SAMPLE points, what needs a sample takes another one than one process
    Returns the cloud. What is taken out is counted in its left_out, what is doubtful is in its
    notes. A cloud of nothing but nulls stays as it is.
    """
    axes, progress = coordinates_of(cloud.points).T.astype("f8", copy=False), options.progress
    null, counts = numpy.zeros(axes.shape[1], dtype=bool), {}
    for name, value, found in nulls_in(*axes, ranks, share(progress, 0.0, 0.35)):
        count = count_set(ranks, found & ~null)
        null |= found
        reason = Reason("row", f"{value:g} {value:g} {value:g}")
        if name:
            reason = Reason("null value", f"({name} = {value:.9g})")
        counts.update({reason: count} if count else {})
    if counts and count_set(ranks, ~null):
        if options.keep_nulls:
            words = ", ".join(counted_reason(count, name) for name, count in counts.items())
            cloud.notes.append(f"kept: {words}")
        else:
            if null.any():
                keep_points(cloud, numpy.flatnonzero(~null))
                axes = axes[:, ~null]
            cloud.left_out.update(counts)
            cloud.notes.append(f"usual null values are left out; {option('keep_nulls')} keeps them")
    if not options.keep_nulls:
        notes, z = repeated_extremes(axes[2], share(progress, 0.4, 0.52), ranks)
        cloud.notes += notes + notes_on_blunders(*axes[:2], z, cloud, ranks, share(progress, 0.55, 1.0))
    return cloud


def nulls_in(x, y, z, ranks=None, progress=no_progress):
    """Yields (name of the axis, "x = y", or "" for all of them, value, (n,) of bool) of usual null values
    that stand apart."""
    for done, (name, values) in enumerate((("z", z), ("x", x), ("y", y))):
        progress(done / 3)
        for value, found in usual_nulls(values, name != "z", ranks):
            yield name, value, found
    yield from null_rows(x, y, z, ranks)


def blank_attributes(points):
    """Puts NaN in place of usual null values in the attributes of points. Returns notes."""
    notes, data = [], points.GetPointData()
    for array in [data.GetArray(i) for i in range(data.GetNumberOfArrays())]:
        if array is None or array.GetDataType() not in (VTK_FLOAT, VTK_DOUBLE):
            continue
        values = vtk_to_numpy(array)
        for value, found in usual_nulls(values) if values.ndim == 1 else ():
            values[found] = numpy.nan
            notes.append(
                f"{array.GetName()}: {counted(numpy.count_nonzero(found), 'null value')} ({value:.9g}) "
                f"taken as NaN; {option('keep_nulls')} keeps them"
            )
    return notes


def leave_out(path, cloud, no_data, ranks=None, noun="point", none_left=ALL_WITHOUT_DATA):
    """Takes the points of this elevation out of a cloud; ranks: see take_out()."""
    keep = coordinates_of(cloud.points)[:, 2] != no_data
    lost = count_set(ranks, ~keep)
    if not count_set(ranks, keep):
        raise FileError(f"{path}: {none_left}")
    if lost:
        cloud.left_out[Reason(noun, "without data")] = lost
    if not keep.all():
        keep_points(cloud, numpy.flatnonzero(keep))


def stands_apart(value, count, values, others, width, ranks):
    """Whether a value that occurs count times has almost no others, of bool, near it.

    Near is half the width that most others span; a tenth where the value occurs often, as nulls do.
    """
    reach = max((0.1 if count > 2 else 0.5) * width, 0.05 * abs(value))
    near = count_set(ranks, others & (values > value - reach) & (values < value + reach))
    return near <= count // 20


def usual_nulls(values, is_place=False, ranks=None):
    """[(value, (n,) of bool)]: the usual null values in an array that stand apart.

    is_place  x or y: these are apart where they are twice as far as the others are wide
    """
    low, high = finite_extremes(ranks, values)
    present = {}
    for value in known().nulls["values"]:
        slack = 1e-5 * abs(value) if abs(value) >= 1e20 else 0.0  # as text or single precision wrote it
        if low - slack <= value <= high + slack:
            found = numpy.abs(values - value) <= slack if slack else values == value
            present.update({value: found} if count_set(ranks, found) else {})
    if not present:
        return []
    others = numpy.isfinite(values) & ~numpy.logical_or.reduce(list(present.values()))
    width = body(values, ranks, others) * (20.0 if is_place else 1.0)
    if not count_set(ranks, others) or is_place and width == 0:
        return []
    return [
        (value, found) for value, found in present.items()
        if stands_apart(value, count_set(ranks, found), values, others, width, ranks)
    ]


def null_rows(x, y, z, ranks=None):
    """[(name, value, (n,) of bool)]: the rows that have it thrice, as 0 0 0, or in x and y, as of receivers that have
    no place yet, where x,y of the others are all elsewhere: of the latter ten times as far as they are wide."""
    present = [(value, (x == value) & (y == value)) for value in known().nulls["rows"]]
    others, result = ~numpy.logical_or.reduce([found for _, found in present]), []
    for value, pairs in present:
        for name, found, times in (("", pairs & (z == value), 1.0), ("x = y", pairs, 10.0)):
            if not count_set(ranks, found):
                continue
            near = others.copy()
            for values in (x, y):
                near &= numpy.abs(values - value) < max(times * body(values, ranks, others), 1e-300)
            if not count_set(ranks, near):
                result.append((name, value, found))
    return result


def repeated_extremes(z, progress, ranks):
    """(notes on the least and the greatest value, where it is repeated and stands apart; z with NaN in their
    place)."""
    notes, known_z = [], z
    for i, value in enumerate(finite_extremes(ranks, z)):
        progress(0.5 * i)
        is_it = z == value
        count = count_set(ranks, is_it)
        is_repeated = 3 <= count < total(ranks, len(z)) // 2
        if is_repeated and stands_apart(value, 1, z, ~is_it, body(z, ranks, ~is_it), ranks):
            known_z = numpy.where(is_it, numpy.nan, known_z)
            notes.append(
                f"{count:,} points have z = {value:.9g}, far from all others; if that means no data: "
                f"{option('no_data')} {value:.9g}"
            )
    return notes, known_z
