# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Passes over millions of points or triangles, by vtkSurfacePasses: of numpy they would be many,
with as many temporary arrays."""

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray

from .vtkElevationSurfacePieces import vtkSurfacePasses


def in_vtk(array):
    """A numpy array as one of VTK, which uses its memory."""
    array = numpy.ascontiguousarray(array)
    return numpy_to_vtk(array.view("u1") if array.dtype == bool else array)


def reals(array):
    """Points as the passes take them: floats or doubles."""
    return in_vtk(array if array.dtype in ("f4", "f8") else array.astype("f8"))


def check(done):
    if not done:
        raise MemoryError


def found(method, *arguments):
    """The result of a pass that finds ids."""
    result = vtkIntArray()
    check(method(*arguments, result))
    return vtk_to_numpy(result) if result.GetNumberOfValues() else numpy.zeros(0, dtype="i4")


def corner_flags(triangles, count):
    """(count,) of bool: which points are corners of triangles."""
    flags = numpy.zeros(count, dtype=bool)
    check(vtkSurfacePasses.FlagCorners(in_vtk(triangles.ravel()), in_vtk(flags)))
    return flags


def keep_flagged(surface, flags):
    """Leaves the points with a flag, which are all that the triangles have: one array after the other."""
    check(vtkSurfacePasses.KeepFlagged(in_vtk(flags), surface))


def outline(triangles):
    """The edges that belong to one of the triangles only, as (n, 2) index pairs, in order.

    The triangles turn the same way round. Linear in time: only edges between points of the outline
    are sorted.
    """
    return found(vtkSurfacePasses.FindOutline, in_vtk(triangles.ravel())).reshape(-1, 2)


def stand_ins(points, used, turn, cells, shape):
    """(n,): for each used point, the one near the middle of its cell that stands for it.

    cells  x and y of their lowest corner in the plane that turn leads to, and how wide they are
    shape  how many columns and rows
    """
    arrays = reals(points), in_vtk(used), numpy.ravel(turn).tolist(), cells, *shape.tolist()
    return found(vtkSurfacePasses.FindStandIns, *arrays)


def collapsed(triangles, instead):
    """The triangles with stand-ins for corners, without those that vanish.

    Those that fold over stay: seen from the side, there would be cracks in their places.
    """
    arrays = in_vtk(triangles.ravel()), in_vtk(instead)
    return found(vtkSurfacePasses.Collapse, *arrays).reshape(-1, 3)


def near_triangles(points, triangles, places):
    """The ids of the triangles among which each place has its closest one, and some more."""
    arrays = reals(points), in_vtk(triangles.ravel()), in_vtk(places)
    return found(vtkSurfacePasses.FindNear, *arrays)


def maybe_shared(xyz):
    """The ids of the finite points that share x,y with others, and of a few more."""
    return found(vtkSurfacePasses.FindShared, reals(xyz))


def sample(triangles, every, ids=None):
    """The ids of about one of so many triangles, chosen by the least of the ids of their corners."""
    ids = None if ids is None else in_vtk(ids)
    return found(vtkSurfacePasses.Sample, in_vtk(triangles.ravel()), ids, every)


def are_edges(points, triangles, edges):
    """(n,) of bool: which directed edges, rows of x and y of both ends, some triangle has."""
    flags = numpy.zeros(len(edges), dtype=bool)
    if len(edges):
        arrays = reals(points), in_vtk(triangles.ravel()), in_vtk(edges), in_vtk(flags)
        check(vtkSurfacePasses.FlagEdges(*arrays))
    return flags
