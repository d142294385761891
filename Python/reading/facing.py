# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whether a mesh is an elevation surface: seen from above, each place once.

Only the points of a mesh are read, and points of a folded or closed one make a woven surface. Its
faces show it: some face down where their neighbours face up, or are vertical. Which side a face turns
up depends on the order of its corners, and whole files are in the other order, or in none. So where
faces differ, VTK first makes the order of neighbours the same, and of each part of the mesh the
rarer side counts.
"""

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSet, vtkPolyData

from ..clouds import cells_of, make_points
from ..messages import ElevationSurfaceError, FileError, counted
from ..names import option

FEW = 0.01  # of the faces; more of them are not a slip of the program that wrote the mesh
FLAT_CELLS = range(10)  # VTK's numbers of cells without volume, up to VTK_QUAD


def check_faces(path, data, options):
    """Notes on the faces of a data set, of which only the points are used. Raises FileError where
    it is not an elevation surface, unless options say that the points are wanted all the same."""
    if options.points_only or data is None:
        return []
    faces = find_faces(data)
    if faces is None:
        return []
    try:
        return notes_on_faces(faces)
    except ElevationSurfaceError as error:
        raise FileError(f"{path}: {error}, or {option('points_only')} takes its points as they are") from None


def notes_on_faces(faces):
    """Notes on the faces of vtkPolyData. Raises ElevationSurfaceError where they are not an elevation
    surface."""
    areas, slopes = signed_areas(faces)
    total = numpy.count_nonzero(areas) + numpy.count_nonzero(slopes[areas == 0])
    vertical = int(numpy.count_nonzero(slopes[areas == 0]))
    down = min(numpy.count_nonzero(areas < 0), numpy.count_nonzero(areas > 0))
    if down:
        down = facing_down(faces)
    if not down + vertical:
        return []
    found = [f"{down:,} face down where others face up"] * bool(down)
    found += [f"{vertical:,} are vertical"] * bool(vertical)
    words = f"of {counted(total, 'face')}, {' and '.join(found)}"
    share = (down + vertical) / total
    if share <= FEW:
        return [f"{words}: the mesh folds there, and only its points are used"]
    raise ElevationSurfaceError(
        f"is not an elevation surface: {words} ({100 * share:.0f} %), so it is closed, or folds; "
        "split it into parts that do not"
    )


def find_faces(data):
    """vtkPolyData with the faces of a data set; None where it has none, or cells with a volume."""
    if not isinstance(data, vtkPolyData):
        if not isinstance(data, vtkDataSet) or not data.GetNumberOfCells():
            return None
        from vtkmodules.vtkCommonDataModel import vtkCellTypes
        from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

        types = vtkCellTypes()
        data.GetCellTypes(types)
        kinds = {types.GetCellType(i) for i in range(types.GetNumberOfTypes())}
        if not kinds <= set(FLAT_CELLS):
            return None
        surface = vtkDataSetSurfaceFilter()
        surface.SetInputData(data)
        surface.Update()
        data = surface.GetOutput()
    if not data.GetNumberOfPolys():
        return None
    faces = vtkPolyData()
    faces.SetPoints(data.GetPoints())
    faces.SetPolys(data.GetPolys())
    return faces


def make_faces(points, corners):
    """vtkPolyData of (n, 3) points and (m, 3) corners of triangles, or a vtkCellArray."""
    faces = make_points(points)
    faces.SetPolys(corners if isinstance(corners, vtkCellArray) else cells_of(corners))
    return faces


def signed_areas(faces):
    """(areas of the faces in x,y, below 0 where corners go clockwise; how far each is upright)."""
    points = vtk_to_numpy(faces.GetPoints().GetData()).astype("f8")
    points = points - numpy.nan_to_num(points[:1])
    begin = vtk_to_numpy(faces.GetPolys().GetConnectivityArray())
    offsets = vtk_to_numpy(faces.GetPolys().GetOffsetsArray())
    there = numpy.diff(offsets) > 0  # a file may have faces without corners
    first, last = offsets[:-1][there], offsets[1:][there] - 1
    end = numpy.roll(begin, -1)  # the second point of each edge
    end[last] = begin[first]
    sums = numpy.zeros((3, len(there)))
    x, y, z = points.T
    for total, a, b in zip(sums, (x, y, z), (y, z, x)):
        if len(first):
            total[there] = numpy.add.reduceat(a[begin] * b[end] - a[end] * b[begin], first)
    sums = numpy.nan_to_num(sums)
    return sums[0], numpy.abs(sums[1]) + numpy.abs(sums[2])


def facing_down(faces):
    """How many faces lie upside down in their part of the mesh, which has the order of corners that
    most of its faces have."""
    from vtkmodules.vtkFiltersCore import (
        vtkCleanPolyData,
        vtkConnectivityFilter,
        vtkPolyDataNormals,
    )

    clean, alike, parts = vtkCleanPolyData(), vtkPolyDataNormals(), vtkConnectivityFilter()
    clean.SetInputData(faces)
    clean.PointMergingOn()
    clean.SetTolerance(0.0)
    clean.ConvertPolysToLinesOff()
    alike.SetInputConnection(clean.GetOutputPort())
    alike.ConsistencyOn()
    alike.SplittingOff()
    alike.ComputeCellNormalsOn()
    parts.SetInputConnection(alike.GetOutputPort())
    parts.SetExtractionModeToAllRegions()
    parts.ColorRegionsOn()
    parts.Update()
    found = parts.GetOutput()
    areas, _ = signed_areas(found)
    part_of = vtk_to_numpy(found.GetPointData().GetArray("RegionId"))
    corners = vtk_to_numpy(found.GetPolys().GetConnectivityArray())
    first = vtk_to_numpy(found.GetPolys().GetOffsetsArray())[:-1]
    up, down = (
        numpy.bincount(part_of[corners[first[side]]], minlength=part_of.max() + 1)
        for side in (areas > 0, areas < 0)
    )
    return int(numpy.minimum(up, down).sum())
