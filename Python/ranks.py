# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The ranks (processes) on which an algorithm runs at the same time.

They are several where the global controller has several processes and several pieces are asked for.
All of them have to call the same functions in the same order.
"""

from vtkmodules.vtkCommonCore import vtkIntArray
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from .messages import ElevationSurfaceError


def controller_of(outputs):
    """The controller of several ranks, or None. outputs: the information of the outputs."""
    pieces = max(
        outputs.GetInformationObject(port).Get(
            vtkStreamingDemandDrivenPipeline.UPDATE_NUMBER_OF_PIECES()
        )
        for port in range(outputs.GetNumberOfInformationObjects())
    )
    if pieces < 2:
        return None
    try:
        from vtkmodules.vtkParallelCore import vtkMultiProcessController
    except ImportError:
        return None
    controller = vtkMultiProcessController.GetGlobalController()
    return controller if controller and controller.GetNumberOfProcesses() > 1 else None


def collected(controller, values):
    """The whole numbers of all ranks, one list for each."""

    def all_of(numbers):
        own, everywhere = vtkIntArray(), vtkIntArray()
        for number in numbers:
            own.InsertNextValue(number)
        everywhere.SetNumberOfValues(len(numbers) * controller.GetNumberOfProcesses())
        controller.AllGather(own, everywhere)
        return [everywhere.GetValue(i) for i in range(everywhere.GetNumberOfValues())]

    lengths = all_of([len(values)])
    most = max(lengths)
    padded = all_of([*values, *[0] * (most - len(values))]) if most else []
    return [padded[i * most : i * most + length] for i, length in enumerate(lengths)]


def check_ranks(controller, places):
    """Raises ElevationSurfaceError on all ranks where the points of one surface are on several.

    places  the places in the input that hold points here, a number for each

    Returns whether this rank is to speak of the result: it has points, or is the first of those
    where none has.
    """
    ranks = collected(controller, places)
    for place in sorted(set().union(*ranks)):
        count = sum(place in here for here in ranks)
        if count > 1:
            raise ElevationSurfaceError(
                f"the points of the input are on {count} ranks (processes), but a surface can only be "
                "made on one. Bring them to one rank first, in ParaView with the filter Aggregate "
                "Dataset (1 target process), or run on one rank."
            )
    return bool(places) or not any(ranks) and controller.GetLocalProcessId() == 0


def shared(controller, work):
    """The vtkPolyData parts of all ranks, on all of them; work() gives the one of this rank.

    Where work() raises ElevationSurfaceError on a rank, all ranks raise one.
    """
    own, failure = vtkPolyData(), None
    try:
        own = work()
    except ElevationSurfaceError as error:
        failure = error
    found = collected(controller, [int(failure is not None), int(own.GetNumberOfPoints() > 0)])
    if any(failed for failed, _ in found):
        raise failure or ElevationSurfaceError("the message of another rank tells why")
    parts = []
    for rank, (_, has_points) in enumerate(found):
        if has_points:
            part = own if rank == controller.GetLocalProcessId() else vtkPolyData()
            controller.Broadcast(part, rank)
            parts.append(part)
    return parts or [own]
