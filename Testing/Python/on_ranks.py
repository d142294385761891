# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What tests on several ranks share: all ranks run the same script, started by mpirun.

python3 starts MPI here; pvbatch --symmetric has done so.
"""

import argparse
import io
import os
import pickle
import sys

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController


def start():
    """The controller of all ranks."""
    controller = vtkMultiProcessController.GetGlobalController()
    if not controller:
        from mpi4py import MPI  # noqa: F401  (it starts MPI)
        from vtkmodules.vtkParallelMPI import vtkMPIController

        controller = vtkMPIController()
        controller.Initialize()
        vtkMultiProcessController.SetGlobalController(controller)
    return controller


RANKS = start()
RANK, COUNT = RANKS.GetLocalProcessId(), RANKS.GetNumberOfProcesses()
LAST = COUNT - 1
FAILURES = []


def gather(value):
    """The values of all ranks, in their order, on each of them."""
    own = numpy_to_vtk(numpy.frombuffer(pickle.dumps(value), "u1"), deep=True)
    together = own.NewInstance()
    RANKS.AllGatherV(own, together)
    stream = io.BytesIO(vtk_to_numpy(together).tobytes())
    return [pickle.load(stream) for _ in range(COUNT)]


def check(is_true, claim):
    """Notes a claim that does not hold on this rank."""
    if not is_true:
        FAILURES.append(claim)
        print("rank %d: FAILED: %s" % (RANK, claim), flush=True)


def check_equal(value, expected, claim):
    check(value == expected, "%s: %r instead of %r" % (claim, value, expected))


def end(done):
    """Ends the test of all ranks."""
    failures = sum(gather(len(FAILURES)))
    if RANK == 0:
        print("%d ranks, %s: %d failures" % (COUNT, done, failures))
    if failures:
        sys.stdout.flush()
        os._exit(1)  # pvbatch would make nothing of sys.exit()


def options_of():
    """The options of the command line: more than the suite has time for."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--clouds", type=int, help="how many random ones each test compares")
    parser.add_argument("--aborts", type=int, help="how many times each filter is stopped")
    parser.add_argument("--size", type=int, default=20000, help="points of a cloud that is stopped")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="the number of the first cloud, where each has its own")
    return parser.parse_args()


def fewer(count):
    """So many on two ranks, fewer on more of them, which take longer."""
    return max(2, 2 * count // COUNT)


def updated(algorithm, data, alone, **properties):
    """A filter after its update, and its messages: of this rank alone, or of all together."""
    from outcomes import noted

    algorithm.SetNumberOfThreads(1)
    algorithm.SetInputData(data)
    messages = noted(algorithm)
    for name, value in properties.items():
        getattr(algorithm, "Set" + name)(value)
    algorithm.UpdatePiece(*(0, 1, 0) if alone else (RANK, COUNT, 0))
    return algorithm, messages


def owners_in_places(random, places):
    """Which rank has which place: drawn, in stretches, in strips, a chessboard, few ranks, all but one."""
    kind, count = random.integers(7), len(places)
    if kind == 0 or count < COUNT:
        return random.integers(COUNT, size=count)
    if kind == 1:
        return numpy.sort(random.integers(COUNT, size=count))
    if kind == 2:
        return numpy.arange(count) % COUNT
    x, y = (numpy.argsort(numpy.argsort(places[:, i])) / count for i in (0, 1))
    if kind == 3:
        return (x * COUNT).astype(int)
    if kind == 4:
        return ((x * 4).astype(int) + 3 * (y * 4).astype(int)) % COUNT
    if kind == 5:
        few = random.integers(COUNT, size=max(1, COUNT // 2))
        return few[(x * len(few)).astype(int)]
    owners = numpy.full(count, random.integers(COUNT))
    owners[random.integers(count)] = random.integers(COUNT)
    return owners


def check_refused(algorithm, data, part, claim, **properties):
    """One error of all ranks, by the first, and nothing on any."""
    refused, messages = updated(algorithm, data, False, **properties)
    check(len(messages) == (RANK == 0) and (RANK > 0 or part in messages[0][1]),
          "%s: one error with %r, not %s" % (claim, part, messages))
    rows = refused.GetMessages()
    check((rows.GetNumberOfTuples() > 0) == (RANK == 0) and (RANK > 0 or rows.GetValue(0) == "error"),
          "%s: the error is data too, on the first rank" % claim)
    check(refused.GetErrorCode() != 0, "%s: the filter has failed on all ranks" % claim)
    for port in range(refused.GetNumberOfOutputPorts()):
        check(refused.GetOutput(port).GetNumberOfPoints() == 0, "%s: no point" % claim)


def check_stops(random, count, share, make):
    """Progress rises; an abort on one rank, at any moment, ends all of them, and one rank reports it. The
    rank reports nothing more.

    share  the part of the progress in which it comes
    make   make(i) -> a filter with its input
    """
    reached = 0
    for i in range(count):
        at, culprit = share * random.random(), random.integers(COUNT)
        algorithm = make(i)
        algorithm.SetNumberOfThreads(1)
        progress, stopped, reported = [], [], []

        def stop(caller, _event):
            progress.append(caller.GetProgress())
            if RANK == culprit and caller.GetProgress() >= at:
                stopped.append(len(progress))
                caller.SetAbortExecute(1)

        algorithm.AddObserver("ProgressEvent", stop)
        algorithm.AddObserver("WarningEvent", lambda *_: reported.append("warning"))
        algorithm.AddObserver("ErrorEvent", lambda *_: reported.append("error"))
        algorithm.UpdatePiece(RANK, COUNT, 0)
        check(progress == sorted(progress), "progress rises")
        if any(gather(stopped)):
            reached += 1
            # Since VTK 9.3 the executive reports an end, 1.0, also of what has been stopped.
            check(not stopped or set(progress[stopped[0]:]) <= {1.0}, "no report follows abort %d" % i)
            check(algorithm.GetOutput().GetNumberOfPoints() == 0, "empty after abort %d" % i)
            check(reported == ["warning"] * (RANK == 0), "%s of abort %d" % (reported, i))
    check(reached > count // 2, "%d of %d aborts have come to pass" % (reached, count))
