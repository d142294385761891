# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Progress of work that has parts: a function that is called with the fraction done. What it raises
ends the work."""

import os

BYTES = 1 << 18  # of lines between two reports


def no_progress(fraction):
    """Nobody wants to know."""


def share(progress, first, last):
    """Progress of a part of the work that goes from one fraction of the whole to the other."""
    return lambda fraction: progress(first + fraction * (last - first))


def lines_with_progress(stream, progress):
    """Yields the lines of a file, which is read from its begin."""
    size, done, reported = os.fstat(stream.fileno()).st_size, 0, 0
    for line in stream:
        done += len(line)
        if done - reported >= BYTES:
            reported = done
            progress(min(done / size, 1.0))
        yield line


def items_with_progress(items, progress, count, step=1000):
    """Yields the items. count: how many there are, or below 1 where that is not known."""
    for number, item in enumerate(items):
        if number % step == 0:
            progress(min(number / count, 1.0) if count > 0 else number / (number + 100.0 * step))
        yield item
