# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The program reconstruct, run on a file of points, and what it took."""

import json
import os
import resource
import subprocess
import sys
import time
from typing import NamedTuple


class Took(NamedTuple):
    seconds: float  # on the clock
    processor_seconds: float
    bytes: float  # of memory at most, of this run or an earlier one
    report: dict  # its report


def with_absolute_paths(environment):
    """The same environment for a process in another folder: a relative PYTHONPATH would fail there."""
    paths = filter(None, environment.get("PYTHONPATH", "").split(os.pathsep))
    absolute = os.pathsep.join(os.path.abspath(path) for path in paths)
    return {**environment, "PYTHONPATH": absolute}


def run(points, options):
    """Runs the program beside the file of points, whose name is points.SUFFIX."""
    folder, name = os.path.split(points)
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(
        [sys.executable, "-m", "vtkelevationsurface", name, "--report", "--quiet", *options],
        cwd=folder, env=with_absolute_paths(os.environ), check=True,
    )
    seconds, used = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    with open(os.path.join(folder, "points_surface.json"), encoding="utf-8") as stream:
        report = json.load(stream)
    return Took(seconds, processor, 1024.0 * used.ru_maxrss, report)
