# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The ranks (processes) on which an algorithm runs at the same time.

They are several where the global controller has several processes and several pieces are asked for;
where the controller is None, there is one. All of them have to call the same functions in the same
order. Each of these begins with an exchange. Where work raises on a rank, it takes part in the
exchange that the others come to next, with its error, and all ranks raise that.
"""

import ctypes
import json
import pickle
import time

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdTypeArray, vtkStringArray, vtkTypeInt64Array
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from .messages import Aborted, ElevationSurfaceError
from .supervisor import rank_and_size

MPI_MISSING = (
    "mpirun has started several processes, but VTK's Python has no MPI (vtkParallelMPI), so that they "
    "cannot work together; run the program without mpirun"
)
MPI_OTHER = (
    "mpirun has started several processes that do not find each other: it is of another MPI than "
    "VTK's"
)
WORK_IS_DONE = 21  # tag of a message
ID_ARRAYS = "ArraysOfIds"  # field data of packed()
IN_FIELD_DATA = 2  # place in fields_of()


def start_ranks():
    """The controller of the processes that mpirun has started. Keep it until its Finalize().

    Raises ElevationSurfaceError where VTK has no MPI.
    """
    try:
        from vtkmodules import vtkParallelMPI
        from vtkmodules.vtkParallelCore import vtkMultiProcessController
    except ImportError:
        raise ElevationSurfaceError(MPI_MISSING) from None
    # VTK starts MPI itself in programs in C++ only.
    mpi = ctypes.CDLL(vtkParallelMPI.__file__)
    is_started = ctypes.c_int()
    mpi.MPI_Initialized(ctypes.byref(is_started))
    if not is_started.value:
        mpi.MPI_Init(None, None)
    controller = vtkParallelMPI.vtkMPIController()
    controller.Initialize()
    if controller.GetNumberOfProcesses() != rank_and_size()[1]:
        raise ElevationSurfaceError(MPI_OTHER)
    vtkMultiProcessController.SetGlobalController(controller)
    return controller


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


def rank_and_count(controller):
    """The number of this rank, and how many there are."""
    if controller is None:
        return 0, 1
    return controller.GetLocalProcessId(), controller.GetNumberOfProcesses()


def collected(controller, values, kind="i8"):
    """The numbers of all ranks, a numpy array for each. kind: i8, f8 or u1, the same on all ranks.

    Where a rank has failed() meanwhile, all ranks raise its error: that of the first of these, and
    Aborted if there is no other.
    """
    values = numpy.asarray(values, dtype=kind)
    if controller is None:
        return [values]
    lengths = gather_numbers(controller, numpy.array([len(values)]))
    if lengths.min() < 0:
        raise first_error(controller, lengths, b"")
    return rows_of(controller, lengths, values)


def failed(controller, error):
    """The error that all ranks raise because of this one, which meets the others in the exchange that
    they come to next."""
    try:
        words = pickle.dumps(error)
        pickle.loads(words)
    except Exception:  # pylint: disable=broad-except
        words = pickle.dumps(ElevationSurfaceError(str(error)))
    return first_error(controller, gather_numbers(controller, numpy.array([-len(words)])), words)


def first_error(controller, lengths, words):
    """The error that all ranks raise; words: that of this rank. Lengths of errors are below 0."""
    rows = rows_of(controller, numpy.maximum(-lengths, 0), numpy.frombuffer(words, "u1"))
    errors = [pickle.loads(row.tobytes()) for row in rows if len(row)]
    error = next((one for one in errors if not isinstance(one, Aborted)), errors[0])
    error.is_reported_here = controller.GetLocalProcessId() == 0
    return error


def is_on_all_ranks(error):
    """Whether all ranks raise this error. Its is_reported_here is True on the first."""
    return hasattr(error, "is_reported_here")


def gather_numbers(controller, numbers):
    """The numbers of all ranks, as many of each, one rank after the other."""
    own = numpy_to_vtk(numbers, deep=True)
    everywhere = own.NewInstance()
    everywhere.SetNumberOfValues(len(numbers) * controller.GetNumberOfProcesses())
    controller.AllGather(own, everywhere)
    return vtk_to_numpy(everywhere).copy()


def rows_of(controller, lengths, values):
    """The values of each rank, so many as lengths says."""
    padded = numpy.zeros(max(lengths.max(), 1), dtype=values.dtype)
    padded[: len(values)] = values
    rows = gather_numbers(controller, padded).reshape(len(lengths), -1)
    return [row[:length] for row, length in zip(rows, lengths)]


def tried(controller, work):
    """What work() gives on this rank; its error goes to all ranks."""
    try:
        return work()
    except Exception as error:  # pylint: disable=broad-except
        if controller is None or is_on_all_ranks(error):
            raise
        raise failed(controller, error) from error


def agreed(controller, work):
    """What work() gives on this rank, once it is done on all."""
    made = tried(controller, work)
    collected(controller, ())
    return made


def together(controller, work):
    """The lists that work() gives on each rank, as one list on all ranks. They hold plain values."""
    if controller is None:
        return work()
    words = tried(controller, lambda: json.dumps(work()).encode())
    rows = collected(controller, numpy.frombuffer(words, "u1"), "u1")
    return [value for row in rows for value in json.loads(row.tobytes())]


def by_first(controller, work, other=None):
    """What work() gives on the first rank, other on the others, who sleep meanwhile. As agreed()."""
    if controller is None:
        return work()
    ranks = range(1, controller.GetNumberOfProcesses())
    collected(controller, ())  # nobody waits for a first rank that does not come here

    def work_and_release():
        try:
            return work()
        finally:
            for rank in ranks:
                controller.Send(numpy_to_vtk(numpy.zeros(1)), rank, WORK_IS_DONE)

    def wait_for_first():
        is_there, source = [0], [0]
        while not is_there[0]:
            time.sleep(0.01)
            controller.Iprobe(0, WORK_IS_DONE, is_there, source)
        controller.Receive(numpy_to_vtk(numpy.zeros(1)), 0, WORK_IS_DONE)
        return other

    return agreed(controller, wait_for_first if controller.GetLocalProcessId() else work_and_release)


def all_values(controller, values, kind="i8"):
    """The numbers of all ranks in one array; kind as of collected()."""
    return numpy.concatenate(collected(controller, values, kind))


def total(controller, count):
    """The sum of the counts of all ranks."""
    return int(all_values(controller, [count]).sum())


def before(controller, count):
    """The sum of the counts of the ranks before this one."""
    counts = collected(controller, [count])
    return int(numpy.sum(counts[: controller.GetLocalProcessId()])) if controller else 0


def summed(controller, numbers):
    """The sums of the numbers of all ranks, doubles at the same places of arrays as long."""
    collected(controller, ())
    if controller is None:
        return numbers
    own = numpy_to_vtk(numbers)
    result = own.NewInstance()
    result.SetNumberOfValues(len(numbers))
    controller.AllReduce(own, result, 2)  # vtkCommunicator.SUM_OP, which ParaView's Python may lack
    return vtk_to_numpy(result).copy()


def widest(controller, low, high):
    """The least low and the greatest high of all ranks."""
    low, high = numpy.min(collected(controller, [low, -high], "f8"), axis=0).tolist()
    return low, -high


def extremes(controller, values):
    """The least and the greatest value of all ranks; infinity and -infinity where there is none."""
    ends = (float(values.min()), float(values.max())) if len(values) else (numpy.inf, -numpy.inf)
    return widest(controller, *ends)


def finite_extremes(controller, values):
    """As extremes(), of the values that are finite."""
    ends = numpy.array((values.min(), values.max())) if len(values) else values
    are_finite = numpy.isfinite(ends).all()  # NaN would be both
    return extremes(controller, ends if are_finite else values[numpy.isfinite(values)])


def shared(controller, work):
    """The vtkPolyData parts of all ranks, on all of them; work() gives the one of this rank.

    What several ranks have as a whole, the same points and cells, counts once.
    """
    if controller is None:
        return [work()]
    own = []

    def size():
        own.append(work())
        own.append(packed(own[0]))
        return [own[0].GetNumberOfPoints()]

    everywhere, parts = [], []
    for rank, count in enumerate(together(controller, size)):
        if count:
            is_own = rank == controller.GetLocalProcessId()
            part = own[1] if is_own else vtkPolyData()
            controller.Broadcast(part, rank)
            everywhere.append(own[0] if is_own else unpacked(part))
    for part in everywhere:
        if not any(are_equal(part, other) for other in parts):
            parts.append(part)
    return parts or own[:1]


def packed(data):
    """A copy of a data set for another rank: on the way VTK cuts vtkIdType to 32 bits, and loses all
    field data where one array is empty."""
    copy = data.NewInstance()
    copy.ShallowCopy(data)
    known = vtkStringArray()
    known.SetName(ID_ARRAYS)
    for place, fields in enumerate(fields_of(copy)):
        for i in reversed(range(fields.GetNumberOfArrays())):
            array = fields.GetAbstractArray(i)
            if place == IN_FIELD_DATA and array.GetNumberOfTuples() == 0:
                fields.RemoveArray(i)
            elif array.IsA("vtkIdTypeArray") and array.GetName():
                attribute = -1 if place == IN_FIELD_DATA else fields.IsArrayAnAttribute(i)
                known.InsertNextValue(f"{place} {attribute} {array.GetName()}")
                if attribute >= 0:
                    fields.SetActiveAttribute(-1, attribute)
                replace(fields, array, vtkTypeInt64Array())
    if known.GetNumberOfValues():
        copy.GetFieldData().AddArray(known)
    return copy


def unpacked(data):
    """The data set itself that packed() had been given on another rank."""
    known = data.GetFieldData().GetAbstractArray(ID_ARRAYS)
    if known:
        data.GetFieldData().RemoveArray(ID_ARRAYS)
        for i in range(known.GetNumberOfValues()):
            place, attribute, name = known.GetValue(i).split(" ", 2)
            fields = fields_of(data)[int(place)]
            replace(fields, fields.GetArray(name), vtkIdTypeArray())
            if int(attribute) >= 0:
                fields.SetActiveAttribute(name, int(attribute))
    return data


def fields_of(data):
    return data.GetPointData(), data.GetCellData(), data.GetFieldData()


def replace(fields, array, other):
    """Puts an array of another type in the place of one."""
    other.DeepCopy(array)
    other.SetName(array.GetName())
    fields.AddArray(other)


def are_equal(one, other):
    """Whether two vtkPolyData have the same points and cells; both have points."""

    def numbers(data):
        yield vtk_to_numpy(data.GetPoints().GetData())
        for cells in (data.GetVerts(), data.GetLines(), data.GetPolys(), data.GetStrips()):
            ids = vtkIdTypeArray()
            cells.ExportLegacyFormat(ids)
            yield vtk_to_numpy(ids)

    # A z that is missing (NaN) in both is the same.
    return all(numpy.array_equal(a, b, equal_nan=True) for a, b in zip(numbers(one), numbers(other)))
