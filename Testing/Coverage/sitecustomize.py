# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Lets every Python that a test starts count the lines of the package; Utilities/test --coverage
puts this folder on PYTHONPATH.

The program's child, and others, end by os._exit(), where neither Python nor a library writes what
it has counted. So it is written before."""

import ctypes
import os

try:
    import coverage

    counting = coverage.process_startup()
except ImportError:  # a Python that is not the tests' own
    counting = None
end = os._exit


def write_and_end(code):
    """os._exit() after the counts of Python and of each library that was built to count."""
    try:
        if counting:
            counting.stop()
            counting.save()
        with open("/proc/self/maps", encoding="utf-8") as lines:
            paths = {line.split()[-1] for line in lines if "ElevationSurface" in line}
        for path in sorted(paths):
            library = ctypes.CDLL(path)
            if hasattr(library, "esDumpCounts"):
                library.esDumpCounts()
    finally:
        end(code)


os._exit = write_and_end
