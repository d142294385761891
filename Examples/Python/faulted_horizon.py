#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A horizon with a fault, triangulated without and with the fault's lines as constraints.

faulted_horizon.py PICTURE.png [SURFACE.vtp]

Of Data/horizon_synthetic.vtp every fifth inline and crossline is kept, as if it had been picked on
few lines; the two sides of the fault are known better. Without them, triangles reach across the fault
anywhere and its face is ragged; with them, they are edges of the surface, and the face between them
is clean.
Needs the module on PYTHONPATH, and a display or Xvfb for the picture.
"""

import os
import sys

from vtkelevationsurface import vtkGridDelaunay2D
from vtkelevationsurface.picture import open_window, save, screen_for
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import vtkElevationFilter
from vtkmodules.vtkFiltersGeneral import vtkTransformPolyDataFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkTextActor,
)
import vtkmodules.vtkRenderingFreeType  # noqa: F401  text
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  drawing

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Data")
EXAGGERATION = 3.0


def read(name):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(os.path.join(DATA, name))
    reader.Update()
    return reader.GetOutput()


def every_fifth(horizon):
    """The points where inlines and crosslines with numbers divisible by 5 meet."""
    data = horizon.GetPointData()
    inlines, crosslines = (vtk_to_numpy(data.GetArray(n)) for n in ("Inline", "Crossline"))
    keep = (inlines % 5 == 0) & (crosslines % 5 == 0)
    points = vtkPoints()
    points.SetData(numpy_to_vtk(vtk_to_numpy(horizon.GetPoints().GetData())[keep], deep=True))
    thin = vtkPolyData()
    thin.SetPoints(points)
    return thin


def triangulate(points, faults):
    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputData(points)
    if faults is not None:
        delaunay.SetSourceData(faults)
    delaunay.Update()
    return delaunay


def actor_of(data, middle):
    """Near the origin, where the single precision of drawing is fine."""
    move = vtkTransform()
    move.Scale(1.0, 1.0, EXAGGERATION)
    move.Translate(*(-x for x in middle))
    moved = vtkTransformPolyDataFilter()
    moved.SetTransform(move)
    moved.SetInputData(data)
    actor = vtkActor()
    actor.SetMapper(vtkPolyDataMapper())
    actor.GetMapper().SetInputConnection(moved.GetOutputPort())
    actor.GetMapper().ScalarVisibilityOff()
    return actor


def panel(window, title, low, high, surface, faults):
    renderer = vtkRenderer()
    renderer.SetViewport(0.0, low, 1.0, high)
    renderer.SetBackground(1.0, 1.0, 1.0)
    window.AddRenderer(renderer)
    box = faults.GetBounds()
    middle = [0.5 * (box[2 * i] + box[2 * i + 1]) for i in range(3)]

    coloured = vtkElevationFilter()
    coloured.SetInputData(surface)
    coloured.SetLowPoint(0.0, 0.0, box[4])
    coloured.SetHighPoint(0.0, 0.0, box[5])
    coloured.Update()
    sheet = actor_of(coloured.GetOutput(), middle)
    table = vtkLookupTable()
    table.SetHueRange(0.62, 0.12)
    table.SetSaturationRange(0.55, 0.55)
    sheet.GetMapper().SetLookupTable(table)
    sheet.GetMapper().ScalarVisibilityOn()
    sheet.GetProperty().SetInterpolationToFlat()
    sheet.GetProperty().SetAmbient(0.25)
    sheet.GetProperty().EdgeVisibilityOn()
    sheet.GetProperty().SetEdgeColor(0.25, 0.25, 0.3)
    renderer.AddActor(sheet)
    lines = actor_of(faults, middle)
    lines.GetProperty().SetColor(0.8, 0.05, 0.05)
    lines.GetProperty().SetLineWidth(4.0)
    lines.GetProperty().LightingOff()
    renderer.AddActor(lines)

    text = vtkTextActor()
    text.SetInput(title)
    text.GetTextProperty().SetFontSize(26)
    text.GetTextProperty().SetColor(0.1, 0.1, 0.1)
    text.GetTextProperty().SetBackgroundColor(1.0, 1.0, 1.0)
    text.GetTextProperty().SetBackgroundOpacity(0.85)
    text.SetPosition(24, 20)
    renderer.AddViewProp(text)
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(0.0, 0.0, 0.0)
    camera.SetPosition(1.0, 0.0, 1.0)
    camera.SetViewUp(0.0, 0.0, 1.0)
    camera.ParallelProjectionOn()
    camera.SetParallelScale(0.2 * (box[3] - box[2]))
    renderer.ResetCameraClippingRange()
    camera.SetClippingRange(-1e5, 1e5)


def main(picture, surface=None):
    faults = read("horizon_synthetic_faults.vtp")
    points = every_fifth(read("horizon_synthetic.vtp"))
    plain = triangulate(points, None)
    constrained = triangulate(points, faults)
    print(
        f"{constrained.GetNumberOfAddedPoints()} points added, "
        f"{constrained.GetNumberOfConstraintCrossings()} crossings"
    )

    with screen_for(picture):
        window = open_window()
        window.SetSize(1600, 1200)
        panel(window, "points alone", 0.502, 1.0, plain.GetOutput(), faults)
        panel(window, "with the fault's lines", 0.0, 0.498, constrained.GetOutput(), faults)
        save(window, picture)
    if surface:
        writer = vtkXMLPolyDataWriter()
        writer.SetInputData(constrained.GetOutput())
        writer.SetFileName(surface)
        return 0 if writer.Write() else 1
    return 0


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
