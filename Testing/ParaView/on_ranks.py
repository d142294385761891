# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests on several ranks share: all ranks run the same script, by pvbatch --symmetric."""
import numpy
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController

RANKS = vtkMultiProcessController.GetGlobalController()
RANK, COUNT = RANKS.GetLocalProcessId(), RANKS.GetNumberOfProcesses()
LAST = COUNT - 1
KEPT = []


def given(data):
    """A source of the pipeline with the data of this rank."""
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    KEPT.append(data)
    return source


def update(source):
    """Updates on all ranks. Returns the messages and outputs of this rank."""
    messages = []

    def note(_caller, event, text):
        messages.append((event, text))

    note.CallDataType = "string0"
    algorithm = source.SMProxy.GetClientSideObject()
    algorithm.AddObserver("ErrorEvent", note)
    algorithm.AddObserver("WarningEvent", note)
    source.UpdatePipeline()
    return messages, [algorithm.GetOutputDataObject(i) for i in range(algorithm.GetNumberOfOutputPorts())]


def everywhere(numbers):
    """The rows of all ranks, as one array of floats on each."""
    numbers = numpy.asarray(numbers, dtype=float)
    own = numpy_to_vtk(numbers, deep=True)
    together = own.NewInstance()
    RANKS.AllGatherV(own, together)
    return vtk_to_numpy(together).reshape((-1,) + numbers.shape[1:]).copy()


def alone(source):
    """Updates on this rank, which asks no other: a piece of 1. Returns the outputs."""
    algorithm = source.SMProxy.GetClientSideObject()
    algorithm.UpdatePiece(0, 1, 0)
    outputs = []
    for i in range(algorithm.GetNumberOfOutputPorts()):
        data = algorithm.GetOutputDataObject(i)
        outputs.append(data.NewInstance())
        outputs[-1].DeepCopy(data)
    return outputs
