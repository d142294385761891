# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elevation Grid and Elevation Profile have the elevations that elevation_at() has."""
import os

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSetAttributes, vtkPolyData

from plugin_testing import (
    array, check, check_equal, data_source, fetch, finish, lines, messages_of,
    points, screenshot, start,
)

data_folder, temporary_folder = start()

from vtkelevationsurface import read, reconstruct  # noqa: E402  (the plugin brings it)

result = reconstruct(read(os.path.join(data_folder, "b9_ground.vtp")), fill=False, duplicates="keep-lowest")
filled = reconstruct(read(os.path.join(data_folder, "b9_ground.vtp")), duplicates="keep-lowest")
surface, with_errors = data_source(result.surface), data_source(filled.surface)
west, east, south, north = result.surface.GetBounds()[:4]


def polyline(*places, closed=False):
    """vtkPolyData with a line, or a polygon, through places."""
    data, cells, corners = vtkPolyData(), vtkCellArray(), vtkPoints()
    for place in places:
        corners.InsertNextPoint(*place)
    data.SetPoints(corners)
    cells.InsertNextCell(len(places), list(range(len(places))))
    (data.SetPolys if closed else data.SetLines)(cells)
    return data


def check_same(found, expected, claim):
    """Elevations, NaN in the same places."""
    check_equal(numpy.isnan(found).tolist(), numpy.isnan(expected).tolist(), claim + ": where it is")
    known = ~numpy.isnan(expected)
    check(numpy.allclose(found[known], expected[known], rtol=0, atol=1e-9), claim + ": elevations")


# ---- the grid ------------------------------------------------------------------------------------

grid = simple.ElevationGrid(Input=surface, Dimensions=[80, 60])
grid.UpdatePipeline()
image = servermanager.Fetch(grid)
check_equal(image.GetDimensions(), (80, 60, 1), "dimensions")
x, y = (numpy.linspace(*ends) for ends in ((west, east, 80), (south, north, 60)))
numpy.testing.assert_allclose(image.GetBounds()[:4], (west, east, south, north), rtol=1e-12)
places = numpy.column_stack([axis.ravel() for axis in numpy.meshgrid(x, y)])
expected = result.elevation_at(places)
check_same(array(image.GetPointData(), "Elevation"), expected, "grid")
check(0.3 < numpy.isnan(expected).mean() < 0.9 or numpy.isnan(expected).any(), "some nodes are outside")
hidden = array(image.GetPointData(), "vtkGhostType")
check_equal((hidden != 0).tolist(), numpy.isnan(expected).tolist(), "nodes that are hidden")
outside = numpy.isnan(expected).reshape(60, 80)
touched = outside[:-1, :-1] | outside[1:, :-1] | outside[:-1, 1:] | outside[1:, 1:]
check_equal((array(image.GetCellData(), "vtkGhostType") != 0).tolist(), touched.ravel().tolist(), "cells that are hidden")
check(not image.GetPointData().HasArray("FilledError"), "without holes there is no error")

grid = simple.ElevationGrid(Input=with_errors, Dimensions=[70, 50])
image = servermanager.Fetch(grid)
x, y = (numpy.linspace(*ends) for ends in zip(filled.surface.GetBounds()[:4:2], filled.surface.GetBounds()[1:4:2], (70, 50)))
heights, errors = filled.elevation_at(
    numpy.column_stack([axis.ravel() for axis in numpy.meshgrid(x, y)]), return_errors=True)
check_same(array(image.GetPointData(), "Elevation"), heights, "grid of a filled surface")
check_same(array(image.GetPointData(), "FilledError"), errors, "errors in the grid")
low, high = (array(image.GetPointData(), "Filled" + end) for end in ("Low", "High"))
known = ~numpy.isnan(heights) & (errors > 0)
check(known.any() and (low[known] < heights[known]).all() and (high[known] > heights[known]).all(), "interval in the grid")

check_equal(servermanager.Fetch(simple.ElevationGrid(Input=surface)).GetDimensions(), (500, 500, 1), "default")
contours = simple.Contour(Input=grid, ContourBy=["POINTS", "Elevation"], Isosurfaces=[75.0])
check(fetch(contours).GetNumberOfPoints() > 10, "contour lines of the grid")

# ---- the profile ---------------------------------------------------------------------------------

profile = simple.ElevationProfile(Input=with_errors)
check_equal(profile.Line, None, "no line by default")
bounds = filled.surface.GetBounds()
check_equal(list(profile.Point1[:2]) + list(profile.Point2[:2]), [bounds[0], bounds[2], bounds[1], bounds[3]],
            "by default from corner to corner")
section = fetch(profile)
check_equal(section.GetNumberOfPoints(), 1001, "points of a section")
along = array(section.GetPointData(), "arc_length")
length = numpy.hypot(bounds[1] - bounds[0], bounds[3] - bounds[2])
check(numpy.allclose(along, numpy.linspace(0, length, 1001), rtol=1e-12), "distances")
heights, errors = filled.elevation_at(points(section)[:, :2], return_errors=True)
check_same(array(section.GetPointData(), "Elevation"), heights, "section")
check_same(array(section.GetPointData(), "FilledError"), errors, "errors along the section")
valid = array(section.GetPointData(), "vtkValidPointMask")
check_equal((valid == 0).tolist(), numpy.isnan(heights).tolist(), "points outside")
check(0 < valid.sum() < len(valid), "the section leaves the surface")
check(numpy.array_equal(points(section)[valid == 1, 2], array(section.GetPointData(), "Elevation")[valid == 1]),
      "the section is on the surface")
check_equal(sorted(numpy.concatenate(lines(section)).tolist()),
            [i for i in range(1001) if valid[i] and (valid[max(i - 1, 0):i + 2].sum() > 1)], "lines where the surface is")

cx, cy = 0.5 * (bounds[0] + bounds[1]), 0.5 * (bounds[2] + bounds[3])
corners = [(cx - 30, cy, -999.0), (cx, cy + 20, 50.0), (cx + 25, cy - 10, numpy.nan)]
for closed in (False, True):
    profile = simple.ElevationProfile(Input=surface, Line=data_source(polyline(*corners, closed=closed)), Resolution=100)
    section = fetch(profile)
    around = corners + corners[:1] if closed else corners
    length = sum(numpy.hypot(q[0] - p[0], q[1] - p[1]) for p, q in zip(around, around[1:]))
    along = array(section.GetPointData(), "arc_length")
    check(abs(along[-1] - length) < 1e-9 * length and (numpy.diff(along) > 0).all(), "distances along a line")
    check(100 < section.GetNumberOfPoints() <= 101 + len(around), "number of points along a line")
    has = {tuple(place) for place in points(section)[:, :2].tolist()}
    check({place[:2] for place in corners} <= has, "the corners of the line are points of the section")
    check_same(array(section.GetPointData(), "Elevation"), result.elevation_at(points(section)[:, :2]), "along a line")

# A line that is hidden or has a hidden point, and one that another rank has as its own, do not count.
several = polyline(*corners)
several.GetPoints().InsertNextPoint(cx, cy - 20, 0)
dots = vtkCellArray()
dots.InsertNextCell(1, [3])
several.SetVerts(dots)
for _ in range(2):
    several.GetLines().InsertNextCell(2, [0, 3])
several.GetLines().InsertNextCell(2, [0, 4])
several.GetPoints().InsertNextPoint(cx, cy - 30, 0)
marks = vtkDataSetAttributes
for data, values in ((several.GetCellData(), [0, 0, marks.HIDDENCELL, marks.DUPLICATECELL, 0]),
                     (several.GetPointData(), [0, 0, 0, 0, marks.HIDDENPOINT])):
    flags = numpy_to_vtk(numpy.array(values, numpy.uint8), deep=True)
    flags.SetName("vtkGhostType")
    data.AddArray(flags)
section, whole = (fetch(simple.ElevationProfile(Input=surface, Line=data_source(line), Resolution=100))
                  for line in (several, polyline(*corners)))
check_equal(points(section).tolist(), points(whole).tolist(), "hidden lines and copies are left out")

# ---- what is wrong -------------------------------------------------------------------------------

alone = data_source(polyline(*corners))
wall = data_source(polyline((0, 0, 0), (1, 1, 0), (0.5, 0.5, 9), closed=True))
meridian = data_source(polyline((5, 0, 0), (5, 1, 0), (5, 2, 7), closed=True))
wrong = polyline(*corners)
wrong.GetLines().ReplaceCellAtId(0, 3, [0, 1, 7])
short = polyline(*corners)
short.GetCellData().AddArray(numpy_to_vtk(numpy.zeros(0, numpy.uint8), deep=True))
short.GetCellData().GetArray(0).SetName("vtkGhostType")
for source, words in (
    (simple.ElevationGrid(Input=alone), "The input has no triangles"),
    (simple.ElevationProfile(Input=alone), "The input has no triangles"),
    (simple.ElevationGrid(Input=meridian), "The input has no triangle with an area in x,y"),
    (simple.ElevationProfile(Input=meridian), "The input has no triangle with an area in x,y"),
    (simple.ElevationProfile(Input=wall), "Cell 0"),
    (simple.ElevationProfile(Input=surface, Line=data_source(wrong)), "Point 7 of the line does not exist; there are 3 points."),
    (simple.ElevationProfile(Input=surface, Line=data_source(short)), 'The line\'s cell array "vtkGhostType" has 0 tuples, but there are 1 cells'),
    (simple.ElevationGrid(Input=surface, Dimensions=[1, 7]), "Dimensions are 1 and 7; they must be 2 or more"),
    (simple.ElevationGrid(Input=surface, Dimensions=[2**30, 2**30]), "250000000 nodes at most"),
    (simple.ElevationProfile(Input=surface, Resolution=0), "Resolution is 0; it must be 1 to 10000000"),
    (simple.ElevationProfile(Input=surface, Point1=[1, 2, 3], Point2=[1, 2, 9]), "The line has no length in x and y"),
    (simple.ElevationProfile(Input=surface, Point1=[numpy.nan, 2, 3], Point2=[1, 2, 9]), "no length"),
    (simple.ElevationProfile(Input=surface, Line=data_source(polyline((numpy.nan, 0, 0), (1, 1, 1)))), "Point 0 of the line"),
    (simple.ElevationProfile(Input=surface, Line=data_source(vtkPolyData())), "The line has no length"),
    (simple.ElevationGrid(Input=simple.Box()), "only triangles can be handled"),
):
    messages = messages_of(source)
    check_equal(len(messages), 1, "one error: " + words)
    check(words in " ".join(messages), "error %r: %s" % (words, messages))
    output = source.GetClientSideObject().GetOutputDataObject(0)
    check_equal(output.GetNumberOfPoints(), 0, "points after an error: " + words)
away = simple.ElevationProfile(Input=surface, Point1=[1, 2, 0], Point2=[10, 5, 0])
(warning,) = messages_of(away, "WarningEvent")
check("does not meet the surface: it is at x 1 to 10, y 2 to 5" in warning, "warning: " + warning)

# ---- pictures ------------------------------------------------------------------------------------

view = simple.CreateRenderView()
view.ViewSize = [500, 400]
shown = simple.Show(grid, view)
check_equal(shown.ColorArrayName[1], "Elevation", "the grid is coloured by elevation")
simple.ResetCamera(view)
red, green, blue = numpy.moveaxis(screenshot(os.path.join(temporary_folder, "grid.png"), view).astype(int), -1, 0)
check((red - blue > 40).mean() > 0.05 and (blue - red > 60).mean() > 0.03, "high and low places of the grid are seen")
chart = simple.CreateView("XYChartView")
chart.ViewSize = [500, 300]
display = simple.Show(simple.ElevationProfile(Input=with_errors), chart)
check_equal(display.XArrayName, "arc_length", "the axis of the plot")
check("Elevation" in list(display.SeriesVisibility), "the plot has the elevation")
drawn = screenshot(os.path.join(temporary_folder, "profile.png"), chart)
check((drawn < 128).all(axis=2).mean() < 0.9 and (drawn.min(axis=2) < 200).sum() > 200, "the plot is drawn")

finish()
