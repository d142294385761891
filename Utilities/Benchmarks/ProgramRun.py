# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The program reconstruct, run on a file of points, and what it took; options of such a benchmark."""

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from typing import NamedTuple

REPORT = "report.json"


def positive(text):
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"takes a whole number from 1 on, not {text!r}")
    return int(text)


def parser_of(description):
    """A parser of options of a benchmark that passes all others on to the program."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False)
    parser.add_argument("--points", type=positive, metavar="N")
    parser.add_argument("--json", type=argparse.FileType("w", encoding="utf-8"), metavar="FILE")
    return parser


def parsed(parser):
    """Its options, and those for the program: on one thread for --json, where they do not say."""
    options, of_program = parser.parse_known_args()
    if of_program and not of_program[0].startswith("-"):
        parser.error(f"what is {of_program[0]!r}?")
    return options, ["--threads", "1", *of_program] if options.json else of_program


class Took(NamedTuple):
    seconds: float  # on the clock
    processor_seconds: float
    bytes: float  # of memory at most, of this run or an earlier one
    report: dict  # its report


def with_absolute_paths(environment):
    """The same environment for a process in another folder, where a relative PYTHONPATH would fail."""
    paths = filter(None, environment.get("PYTHONPATH", "").split(os.pathsep))
    absolute = os.pathsep.join(os.path.abspath(path) for path in paths)
    return {**environment, "PYTHONPATH": absolute}


def run(points, options, program=("-m", "vtkelevationsurface")):
    """Runs the program in the folder of the file of points. Where it fails, so does this process."""
    folder, name = os.path.split(points)
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(
        [sys.executable, *program, name, "--quiet", *options, "--report", REPORT],
        cwd=folder, env=with_absolute_paths(os.environ), check=False,
    )
    if done.returncode:
        sys.exit(f"the program ended with code {done.returncode}")
    seconds, used = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    with open(os.path.join(folder, REPORT), encoding="utf-8") as stream:
        report = json.load(stream)
    return Took(seconds, processor, 1024.0 * used.ru_maxrss, report)
