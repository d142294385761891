#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""One surface, made by many ranks (processes) together, for what is too large for one of them.

    mpirun -n 4 python3 many_ranks.py [SURFACE.pvtp]
    mpirun -n 4 pvbatch --symmetric many_ranks.py [SURFACE.pvtp]

Each rank has some ship tracks of a survey, here every fourth one, and gets the surface of a part of the
area, with a part of the triangles. All ranks together have those of one rank, which python3 many_ranks.py
shows. With pvbatch, PYTHONPATH names the folder of the plugin.
"""

import sys

import numpy
from vtkelevationsurface import vtkGridDelaunay2D, vtkTrimOutwardTriangles
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkParallelCore import vtkDummyController, vtkMultiProcessController

TRACKS, SOUNDINGS = 120, 500  # soundings of each track
LENGTH, DISTANCE = 20000.0, 150.0  # metres: of a track, and from one to the next


def all_ranks():
    """The controller of all processes, which the filters ask. pvbatch has one; else it is made here."""
    controller = vtkMultiProcessController.GetGlobalController()
    if controller:
        return controller
    try:
        from mpi4py import MPI  # noqa: F401  pylint: disable=unused-import  # it starts MPI
        from vtkmodules.vtkParallelMPI import vtkMPIController

        controller = vtkMPIController()
    except ImportError:
        controller = vtkDummyController()  # of one rank
    controller.Initialize()
    vtkMultiProcessController.SetGlobalController(controller)
    return controller


def soundings(tracks):
    """The points of some tracks. A ship does not keep its course, and sounds when it can."""
    parts, ids = [numpy.zeros((0, 3))], [numpy.zeros(0, dtype="i8")]
    for track in tracks:
        numbers = numpy.random.RandomState(track)
        x = numpy.sort(numbers.rand(SOUNDINGS)) * LENGTH
        y = DISTANCE * track + 30 * numpy.sin(x / 700 + track) + numbers.rand(SOUNDINGS)
        z = -200 + 60 * numpy.sin(x / 2300) * numpy.cos(y / 1900) + 8 * numpy.sin(x / 310 + y / 450)
        parts.append(numpy.column_stack([x, y, z]))
        ids.append(SOUNDINGS * track + numpy.arange(SOUNDINGS))
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.vstack(parts), deep=True))
    cloud = vtkPolyData()
    cloud.SetPoints(points)
    # The same number for a point whatever rank has it. Without numbers, ranks count their points one
    # after the other; that decides only which of two points in the same place is taken.
    numbered = numpy_to_vtkIdTypeArray(numpy.concatenate(ids), deep=True)
    numbered.SetName("Sounding")
    cloud.GetPointData().SetGlobalIds(numbered)
    return cloud


def area_of_interest():
    """An oval on the map."""
    points, cells = vtkPoints(), vtkCellArray()
    points.SetDataTypeToDouble()
    cells.InsertNextCell(90)
    for angle in numpy.linspace(0, 2 * numpy.pi, 90, endpoint=False):
        x, y = 10000 + 9000 * numpy.cos(angle), 8900 + 7500 * numpy.sin(angle)
        cells.InsertCellPoint(points.InsertNextPoint(x, y, 0))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    return data


def area(surface):
    """The area of a rank's triangles on the map."""
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    if not len(corners):
        return 0.0
    a, b, c = numpy.moveaxis(vtk_to_numpy(surface.GetPoints().GetData())[corners, :2], 1, 0)
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    return 0.5 * float((ux * vy - uy * vx).sum())


def from_all(ranks, values):
    """A row of numbers of each rank."""
    own = numpy_to_vtk(numpy.array(values, dtype=float), deep=True)
    rows = own.NewInstance()
    rows.SetNumberOfValues(len(values) * ranks.GetNumberOfProcesses())
    ranks.AllGather(own, rows)
    return vtk_to_numpy(rows).reshape(-1, len(values))


def write(ranks, surface, path):
    """Each rank writes its part, SURFACE_0.vtp and so on; the .pvtp opens all as one surface."""
    from vtkmodules.vtkIOParallelXML import vtkXMLPPolyDataWriter

    writer = vtkXMLPPolyDataWriter()
    writer.SetController(ranks)
    writer.SetInputData(surface)
    writer.SetFileName(path)
    writer.SetNumberOfPieces(ranks.GetNumberOfProcesses())
    writer.SetStartPiece(ranks.GetLocalProcessId())
    writer.SetEndPiece(ranks.GetLocalProcessId())
    writer.Write()


def main(path=None):
    ranks = all_ranks()
    rank, count = ranks.GetLocalProcessId(), ranks.GetNumberOfProcesses()

    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputData(soundings(range(rank, TRACKS, count)))
    delaunay.SetNumberOfThreads(1)  # each rank has a core

    # A boundary may be on one rank: all get it.
    trim = vtkTrimOutwardTriangles()
    trim.SetInputConnection(delaunay.GetOutputPort())
    trim.SetBoundaryData(area_of_interest() if rank == 0 else vtkPolyData())
    trim.SetNumberOfThreads(1)

    # Work together starts where several pieces are asked for, and all ranks have to ask. Update()
    # would leave each rank to itself.
    trim.UpdatePiece(rank, count, 0)

    surface = trim.GetOutput()
    rows = from_all(ranks, [surface.GetNumberOfPolys(), area(surface)])
    if rank == 0:
        print(f"{int(rows[:, 0].sum()):,} triangles, {rows[:, 1].sum() / 1e6:.3f} square kilometres")
        print(f"{trim.GetNumberOfOutwardTriangles():,} triangles outside")  # of all ranks
        print("triangles of each rank: " + ", ".join(f"{int(n):,}" for n in rows[:, 0]))
    if path:
        write(ranks, surface, path)


if __name__ == "__main__":
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        sys.exit(__doc__)
    main(*sys.argv[1:])
