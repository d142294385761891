#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Finds the outline of what a ship has surveyed, and takes away the triangles outside it.

survey_swath.py [PICTURE.png]

The ship sounds a strip of the sea floor, with a loop in it. The points alone show where it went,
although they lie eight times denser across the course than along it. Their triangulation also covers
what is within the loop, and between its arms.
"""

import sys

import numpy
from vtkelevationsurface import vtkGridDelaunay2D, vtkTrimOutwardTriangles
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData


def soundings():
    """A line of 81 soundings across the course every 40 m, 400 m wide; positions in metres."""
    random = numpy.random.RandomState(11)
    t = numpy.linspace(0.4, 12.2, 4000)
    course = numpy.column_stack([750 * t - 1900 * numpy.sin(t), -1500 * numpy.cos(t)])
    along = numpy.append(0.0, numpy.cumsum(numpy.hypot(*numpy.diff(course, axis=0).T)))
    stations = numpy.arange(0.0, along[-1], 40.0)
    ship = numpy.column_stack([numpy.interp(stations, along, c) for c in course.T])
    heading = numpy.gradient(ship, axis=0)
    across = numpy.column_stack([-heading[:, 1], heading[:, 0]])
    across /= numpy.hypot(*across.T)[:, None]
    beams = numpy.linspace(-200.0, 200.0, 81)
    xy = (ship[:, None, :] + beams[None, :, None] * across[:, None, :]).reshape(-1, 2)
    xy += random.normal(0.0, 0.4, xy.shape)
    x, y = xy.T / 1000.0
    shoal = 30 * numpy.exp(-((x - 4.7) ** 2 + (y + 0.9) ** 2) / 4.0)
    z = -120 + shoal + 7 * numpy.sin(2.1 * x) * numpy.cos(1.7 * y) + random.normal(0, 0.1, len(xy))
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.column_stack([xy, z]), deep=True))
    cloud = vtkPolyData()
    cloud.SetPoints(points)
    return cloud


def main(picture=None):
    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputData(soundings())

    trim = vtkTrimOutwardTriangles()
    trim.SetInputConnection(delaunay.GetOutputPort())
    trim.Update()
    print(f"{trim.GetNumberOfOutwardTriangles()} outward triangles removed")
    print(f"{trim.GetOutput(2).GetNumberOfLines()} rings at a gap tolerance of "
          f"{trim.GetEffectiveGapTolerance():.1f} spacings")

    if picture:
        from vtkelevationsurface.picture import draw

        draw(trim.GetOutput(), picture, "A survey swath",
             "outlined from the soundings alone", view=(180.0, 90.0))


if __name__ == "__main__":
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        sys.exit(__doc__)
    main(*sys.argv[1:])
