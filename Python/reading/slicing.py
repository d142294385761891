# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads points slice by slice, where a file holds more than memory does."""

import os

import numpy

from ..clouds import Cloud, ReadOptions, system_of, with_data
from ..messages import FileError, Reason, counted
from ..progress import share
from ..selecting import NothingChosen, as_option, none_chosen
from . import NAMES_IN_COLUMNS, check_use
from .formats import FORMATS, recognise
from .nulls import usual_nulls, zero_rows
from .unpacking import unpacked
from .upwards import notes_on_range

MOST_SEEN = 20_000  # points of earlier slices that are kept, to tell nulls in later ones


def check_sliced(path, kind):
    """Refuses a kind of file that is only read as a whole."""
    if not kind.slices:
        names = sorted({other.name for other in FORMATS if other.slices})
        raise FileError(
            f"{path}: {kind.name} cannot be read in pieces; {', '.join(names)} can"
        )


def read_slices(path, cloud, **options):
    """Yields the points of a file as arrays of x, y and z, in the order of read() and without point
    arrays. The cloud gets notes, what is left out and the reference system.

    Options as of read(). Usual null values that stand apart are an error, as whether they are null
    shows in all points together. Raises FileError.
    """
    options = ReadOptions(**options)
    whole = options.progress
    with unpacked(os.fspath(path), whole) as (local, begun):
        options.progress = share(whole, begun, 1.0)
        kind, notes = recognise(local)
        check_use(local, kind, options)
        check_sliced(local, kind)
        if options.layer and kind.module in NAMES_IN_COLUMNS:
            raise FileError(
                f"{local}: --layer of {kind.name} needs all points in memory: in pieces, "
                f"{as_option('COLUMN', options.layer)} takes those of a name"
            )
        cloud.notes += notes
        count, seen, low, high = 0, numpy.empty((0, 3)), numpy.inf, -numpy.inf
        for points in kind.slice_reader()(local, options, cloud):
            if options.no_data is not None:
                points = with_data(points, options.no_data, cloud, Reason("point", "without data"))
            if len(points) and not options.keep_nulls:
                check_nulls(local, numpy.concatenate((seen, points)))
                seen = numpy.concatenate((seen, points[:: max(1, len(points) // 100)]))
                seen = seen[:: 1 + len(seen) // MOST_SEEN]
            z = points[numpy.isfinite(points[:, 2]), 2]
            low, high = z.min(initial=low), z.max(initial=high)
            if options.depth:
                points = points * (1.0, 1.0, -1.0)
            count += len(points)
            yield points
        if not count:
            raise FileError(f"{local}: all points have the elevation that marks missing data")
        if low <= high:
            cloud.notes += notes_on_range(cloud, options.depth, low, high, os.fspath(path))
        if options.depth:
            cloud.notes.append("z is turned over, as --depth says")


@numpy.errstate(all="ignore")
def check_nulls(path, points):
    """Refuses points of which some have a usual null value that stands apart from the others.

    points  of a slice, with some of those before it: a slice may have nothing but nulls
    """
    axes = [numpy.ascontiguousarray(points[:, i]) for i in range(3)]
    for axis, name in ((2, "z"), (0, "x"), (1, "y")):
        for value, found in usual_nulls(axes[axis], is_place=axis < 2):
            advice = f"--no-data {value:.9g} leaves such points out, " if axis == 2 else ""
            raise FileError(
                f"{path}: {name} = {value:.9g}, of {counted(numpy.count_nonzero(found), 'point')} or "
                f"more, looks like a null value: {advice}--keep-nulls keeps them"
            )
    if zero_rows(*axes).any():
        raise FileError(
            f"{path}: points 0 0 0 apart from all others look like null values: --keep-nulls keeps "
            "them"
        )


def read_files(paths, cloud, **options):
    """read_slices() of several files, one after another. Raises FileError where their coordinate
    reference systems differ."""
    clouds = [Cloud(None) for _ in paths]
    progress = options["progress"]
    unused = []
    for i, (path, own) in enumerate(zip(paths, clouds)):
        options["progress"] = share(progress, i / len(paths), (i + 1) / len(paths))
        try:
            yield from read_slices(path, own, **options)
        except NothingChosen as error:
            unused.append(error)
            own.notes.append(none_chosen())
            if len(unused) == len(paths):
                raise unused[0] from None
        cloud.notes += [f"{path}: {note}" for note in own.notes] if len(paths) > 1 else own.notes
        for reason, count in own.left_out.items():
            cloud.left_out[reason] = cloud.left_out.get(reason, 0) + count
        cloud.crs, notes = system_of(paths[: i + 1], clouds[: i + 1])
    cloud.notes += notes
