# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The ranks (processes) on which an algorithm runs at the same time."""

from vtkmodules.vtkCommonCore import vtkIntArray
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from .messages import ElevationSurfaceError


def fewest_ranks(outputs, count):
    """Whether this rank has the points. Raises ElevationSurfaceError on all where several have.

    outputs  the information of the outputs: with one piece asked for, no other rank is waited for
    count    the number of points here
    """
    pieces = max(
        outputs.GetInformationObject(port).Get(
            vtkStreamingDemandDrivenPipeline.UPDATE_NUMBER_OF_PIECES()
        )
        for port in range(outputs.GetNumberOfInformationObjects())
    )
    controller = controller_of(pieces)
    if controller is None:
        return True
    from vtkmodules.vtkParallelCore import vtkCommunicator

    here, everywhere = vtkIntArray(), vtkIntArray()
    here.InsertNextValue(int(count > 0))
    everywhere.SetNumberOfValues(1)
    controller.AllReduce(here, everywhere, vtkCommunicator.SUM_OP)
    ranks = everywhere.GetValue(0)
    if ranks > 1:
        raise ElevationSurfaceError(
            f"there are points on {ranks} ranks, and this filter needs all of them on one: apply "
            'D3 or "Redistribute DataSet" with one partition first, or use one rank'
        )
    return count > 0 or ranks == 0 and controller.GetLocalProcessId() == 0


def controller_of(pieces):
    """The global controller where several processes make several pieces, else None."""
    if pieces < 2:
        return None
    try:
        from vtkmodules.vtkParallelCore import vtkMultiProcessController
    except ImportError:
        return None
    controller = vtkMultiProcessController.GetGlobalController()
    if controller is None or controller.GetNumberOfProcesses() < 2:
        return None
    return controller
