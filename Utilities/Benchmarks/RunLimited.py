# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a program with a limit of processor time, and prints what it took.

    RunLimited.py SECONDS PROGRAM ARGUMENTS ...

Prints one line of JSON: seconds on the clock, processor_seconds, peak_bytes of memory, code (below 0:
the signal that ended it), out_of_time. It is a small process of its own, because a process that is
started inherits the peak of memory of the one that starts it.
"""

import json
import resource
import signal
import subprocess
import sys
import time


def main(seconds, *command):
    limit = int(seconds)
    began = time.perf_counter()
    try:
        code = subprocess.run(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=5 * limit + 60,
            check=False,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5)),
        ).returncode
    except subprocess.TimeoutExpired:
        code = -signal.SIGXCPU
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(json.dumps({
        "seconds": time.perf_counter() - began,
        "processor_seconds": used.ru_utime + used.ru_stime,
        "peak_bytes": 1024 * used.ru_maxrss,
        "code": code,
        "out_of_time": code == -signal.SIGXCPU,
    }))


if __name__ == "__main__":
    main(*sys.argv[1:])
