#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Cuts a surface along lines drawn on a map: a lease, the shore of a lake in it, an island.

lake.py [PICTURE.png]

Points were surveyed on land alone. Their triangulation spans the lake; trimming opens it along its
shore. No corner of the three rings is a surveyed point, and the lease reaches beyond the survey.
"""

import sys

import numpy
from vtkelevationsurface import vtkGridDelaunay2D, vtkTrimOutwardTriangles
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData


CENTER = numpy.array((5200.0, 4600.0))  # metres, as all lengths


def reach(angle, radius, waves):
    """How far a shore is from the center, to the north or south."""
    return radius * (1.0 + 0.17 * numpy.sin(3 * angle + 0.5) + 0.09 * numpy.sin(waves * angle))


def shore(radius, waves, count):
    """A closed curve."""
    angle = numpy.linspace(0.0, 2.0 * numpy.pi, count, endpoint=False)
    away = reach(angle, radius, waves)
    return CENTER + numpy.column_stack([1.35 * away * numpy.cos(angle), away * numpy.sin(angle)])


def is_within(xy, ring):
    """Even-odd: whether an odd number of the ring's edges lies to the right of each point."""
    inside = numpy.zeros(len(xy), dtype=bool)
    for (ax, ay), (bx, by) in zip(ring, numpy.roll(ring, -1, axis=0)):
        crosses = (ay <= xy[:, 1]) != (by <= xy[:, 1])
        with numpy.errstate(divide="ignore", invalid="ignore"):
            x = ax + (xy[:, 1] - ay) / (by - ay) * (bx - ax)
        inside ^= crosses & (xy[:, 0] < x)
    return inside


def survey(count, lake, island):
    """Points on land, where hills rise from the shore."""
    xy = numpy.random.RandomState(7).rand(count, 2) * (10000, 8500)
    xy = xy[~is_within(xy, lake) | is_within(xy, island)]
    x, y = ((xy - CENTER) / 1000.0).T
    angle = numpy.arctan2(y, x / 1.35)
    away = 1000.0 * numpy.hypot(x / 1.35, y)
    above = numpy.maximum(away / reach(angle, 1900, 7) - 1.0, 1.0 - away / reach(angle, 560, 5))
    hills = 60 * numpy.sin(1.1 * x) * numpy.cos(0.9 * y) + 20 * numpy.sin(2.3 * x - 1.7 * y)
    z = 300 + 110 * above + 0.6 * hills * numpy.minimum(1.0, above)
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.column_stack([xy, z]), deep=True))
    cloud = vtkPolyData()
    cloud.SetPoints(points)
    return cloud


def polygons(*rings):
    points = vtkPoints()
    points.SetDataTypeToDouble()
    cells = vtkCellArray()
    for ring in rings:
        cells.InsertNextCell(len(ring))
        for x, y in ring:
            cells.InsertCellPoint(points.InsertNextPoint(x, y, 0.0))  # z plays no part
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    return data


def main(picture=None):
    lease = [(600, 900), (11500, 300), (11800, 7600), (7300, 8100), (900, 7300)]
    lake, island = shore(1900, 7, 240), shore(560, 5, 90)

    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputData(survey(9000, lake, island))

    # Rings nest: land in the lease, water in the lake, land on the island.
    trim = vtkTrimOutwardTriangles()
    trim.SetInputConnection(delaunay.GetOutputPort())
    trim.SetBoundaryData(polygons(lease, lake, island))
    trim.Update()
    print(f"{trim.GetNumberOfOutwardTriangles()} outward triangles removed")
    print(f"{trim.GetNumberOfInsertedPoints()} points inserted along the boundary")

    if picture:
        from vtkelevationsurface.picture import draw

        draw(trim.GetOutput(), picture, "A lake with an island",
             "trimmed along a lease and two shores that were drawn on a map", view=(205.0, 55.0))


if __name__ == "__main__":
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        sys.exit(__doc__)
    main(*sys.argv[1:])
