# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What tests on several ranks share: all ranks run the same script, started by mpirun.

With python3, it starts MPI, and is imported before VTK's filters; pvbatch --symmetric has done so.
"""

import io
import pickle

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


def gather(value):
    """The values of all ranks, in their order, on each of them."""
    own = numpy_to_vtk(numpy.frombuffer(pickle.dumps(value), "u1"), deep=True)
    together = own.NewInstance()
    RANKS.AllGatherV(own, together)
    stream = io.BytesIO(vtk_to_numpy(together).tobytes())
    return [pickle.load(stream) for _ in range(COUNT)]
