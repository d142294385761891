# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The ranks (processes) on which an algorithm runs at the same time.

They are several where the global controller has several processes and several pieces are asked for.
All of them have to call the same functions in the same order.
"""

import hashlib

from vtkmodules.vtkCommonCore import vtkIdTypeArray
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkTable
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
        own, everywhere = vtkIdTypeArray(), vtkIdTypeArray()
        for number in numbers:
            own.InsertNextValue(number)
        everywhere.SetNumberOfValues(len(numbers) * controller.GetNumberOfProcesses())
        controller.AllGather(own, everywhere)
        return [everywhere.GetValue(i) for i in range(everywhere.GetNumberOfValues())]

    lengths = all_of([len(values)])
    most = max(lengths)
    padded = all_of([*values, *[0] * (most - len(values))]) if most else []
    return [padded[i * most : i * most + length] for i, length in enumerate(lengths)]


def number_of(place):
    """A place as a number that is the same on all ranks."""
    return int.from_bytes(hashlib.blake2b(repr(place).encode(), digest_size=7).digest(), "big")


def check_ranks(controller, parts):
    """Raises ElevationSurfaceError on all ranks where the points of one surface are on several.

    parts  those of the input (Part) that hold points here

    Returns whether this rank is to speak of the result: it has points, or is the first of those
    where none has.
    """
    own = {number_of(part.surface): part for part in parts}
    ranks = collected(controller, list(own))
    for number in sorted(set().union(*ranks)):
        count = sum(number in here for here in ranks)
        if count > 1:
            part = own.get(number)
            name = part.block if part and part.block else "the input"
            what, first = "points", ""
            if part and isinstance(part.data, vtkTable):
                what, first = "rows", "Table To Points and then "
            raise ElevationSurfaceError(
                f"the {what} of {name} are on {count} ranks (processes), but a surface can only be "
                f"made on one. Bring them to one rank first, in ParaView with the filter {first}"
                "Aggregate Dataset (1 target process), or run on one rank."
            )
    return bool(parts) or not any(ranks) and controller.GetLocalProcessId() == 0


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
