# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A process uses no more threads than vtkSMPTools has in it: one on a rank that mpirun has bound to a processor."""

import json
import os
import subprocess
import sys
import time
import types
import unittest

from vtkelevationsurface.command import Run

# The whole chain, with holes, in a process that may use the given processors.
CHAIN = """
import json, os, sys
os.sched_setaffinity(0, json.loads(sys.argv[1]))
import numpy
from vtkelevationsurface import reconstruct
from vtkmodules.vtkCommonCore import vtkSMPTools

x, y = numpy.random.default_rng(1).uniform(0, 100, (2, 40000))
kept = numpy.hypot(x - 50, y - 50) > 5
points = numpy.column_stack((x, y, numpy.sin(x / 9)))[kept]
print(vtkSMPTools.GetEstimatedNumberOfThreads(), len(os.listdir("/proc/self/task")), flush=True)
for threads in 0, 7:
    reconstruct(points, threads=threads, maximum_edge_length=3)
"""


def threads_on(processors):
    """How many threads vtkSMPTools has, and how many the chain has added to those of Python at any time."""
    command = sys.executable, "-c", CHAIN, json.dumps(sorted(processors))
    with subprocess.Popen(command, stdout=subprocess.PIPE) as run:
        has, before = [int(word) for word in run.stdout.readline().split()]
        most = before
        while run.poll() is None:
            most = max(most, len(os.listdir("/proc/%d/task" % run.pid)))
            time.sleep(0.001)
    assert run.returncode == 0
    return has, most - before


@unittest.skipUnless(os.path.isdir("/proc/self/task"), "only Linux lists the threads of a process")
class Threads(unittest.TestCase):
    def setUp(self):
        self.processors = os.sched_getaffinity(0)
        self.addCleanup(os.sched_setaffinity, 0, self.processors)

    def test_no_more_are_made_than_vtk_has_on_one_processor_and_on_all(self):
        for processors in {min(self.processors)}, self.processors:
            has, added = threads_on(processors)
            self.assertLessEqual(added, has if has > 1 else 0, processors)

    def test_a_rank_uses_the_processors_that_it_is_bound_to(self):
        ranks = types.SimpleNamespace(GetLocalProcessId=lambda: 0)
        os.sched_setaffinity(0, {min(self.processors)})
        for controller, properties, expected in (
            (ranks, {}, {"threads": 1}),
            (ranks, {"threads": 5}, {"threads": 5}),
            (None, {}, {}),
        ):
            options = types.SimpleNamespace(properties=properties, quiet=True)
            self.assertEqual(Run(options, None, controller).options.properties, expected)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
