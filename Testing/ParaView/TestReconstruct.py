# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reconstruct Elevation Surface is the three filters in a row, for input of any kind, and reports."""
import os

import numpy
from paraview import servermanager, simple
from vtkmodules.vtkCommonCore import vtkOutputWindow

from plugin_testing import (array, check, check_equal, fetch, finish, information, lines, messages_of,
                            points, start, triangles)

data_folder, temporary_folder = start()


def data_file(name):
    return os.path.join(data_folder, name)


def same(one, other):
    return (numpy.array_equal(points(one), points(other), equal_nan=True)
            and numpy.array_equal(triangles(one), triangles(other)))


def report(source):
    """The rows of the report."""
    table = fetch(source, 3)
    return [tuple(table.GetValue(row, column).ToString() for column in range(table.GetNumberOfColumns()))
            for row in range(table.GetNumberOfRows())]


# ---- the three filters in a row ----------------------------------------------------------------
cloud = simple.XMLPolyDataReader(FileName=[data_file("b9_ground.vtp")])
whole = simple.ReconstructElevationSurface(Input=cloud, OpenEdgeLength=2.5, MaximumEdgeLength=40,
                                           GapTolerance=6, MaximumHoleSize=60,
                                           Interpolation="Membrane")
delaunay = simple.GridDelaunay2D(Input=cloud, MaximumEdgeLength=40)
trim = simple.TrimOutwardTriangles(Input=delaunay, GapTolerance=6)
fill = simple.FillElevationHoles(Input=trim, OpenEdgeLength=2.5, MaximumHoleSize=60,
                                 MatchDensity=1, Interpolation="Membrane")
surface, filled = fetch(whole), fetch(fill)
check(same(surface, filled), "the surface is that of the three filters, cell by cell")
for name in ("FilledPoint", "FilledError", "FilledLow", "FilledHigh"):
    check(numpy.array_equal(array(surface.GetPointData(), name), array(filled.GetPointData(), name),
                            equal_nan=True), "the point array %s is that of the filters" % name)
check(numpy.array_equal(array(surface.GetCellData(), "HoleId"), array(filled.GetCellData(), "HoleId")),
      "the cell array HoleId is that of the filters")
for port, other, other_port in ((1, fill, 1), (2, trim, 2)):
    one, two = fetch(whole, port), fetch(other, other_port)
    check(numpy.array_equal(points(one), points(two)) and all(
        numpy.array_equal(a, b) for a, b in zip(lines(one), lines(two))),
        "output %d is that of the filters" % port)
check(numpy.array_equal(array(surface.GetPointData(), "Elevation"), points(surface)[:, 2]),
      "the array Elevation is z")
shown = simple.Show(whole, simple.CreateRenderView())
check_equal(list(shown.ColorArrayName), ["POINTS", "Elevation"], "what the surface is coloured by")

# ---- what was used, given or chosen ------------------------------------------------------------
def used(source):
    return [information(source, "Effective" + name) for name in ("GapTolerance", "OpenEdgeLength", "Spacing")]


patches = triangles(filled)[array(filled.GetCellData(), "HoleId") >= 0]
ends = numpy.sort(patches[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2))
ends = ends[(array(filled.GetPointData(), "FilledPoint")[ends] == 1).all(axis=1)]
steps = numpy.diff(points(filled)[numpy.unique(ends, axis=0), :2], axis=1)[:, 0]
mean = numpy.linalg.norm(steps, axis=1).mean()
check_equal(used(whole)[:2], [6, 2.5], "what was given")
check(abs(used(whole)[2] / mean - 1) < 0.15, "the distance of new points: %s, %s" % (used(whole), mean))
chooses = simple.ReconstructElevationSurface(
    Input=simple.ElevationPoints(FileName=data_file("olinda_land.xyz")))
fetch(chooses)
check(numpy.allclose(used(chooses), [4.5, 1.5 * 2 ** 0.5 * 89.994, 89.994], rtol=1e-4),
      "what is chosen on a grid: %s" % used(chooses))
chooses.Spacing = 40
fetch(chooses)
check_equal(used(chooses)[2], 40, "a spacing that is given")
chooses.Trim = chooses.FillHoles = 0
fetch(chooses)
check_equal(used(chooses), [0, 0, 0], "nothing is chosen where nothing is trimmed and filled")

# ---- the report --------------------------------------------------------------------------------
rows = report(whole)
check_equal(rows[0], ("points", "13,299 read"), "first row of the report")
check(any(item == "holes" and "found" in value for item, value in rows), "holes are in the report")
text = information(whole, "Report")
check(all(value in text for _, value in rows), "the text of the report has all rows of the table")
check("Open Edge Length" in text and "--" not in text, "the report speaks the panel's language")
whole.FillHoles = 0
check_equal(fetch(whole, 1).GetNumberOfLines(), 0, "hole outlines when nothing is filled")
check(same(fetch(whole), fetch(trim)), "without filling, the surface is the trimmed one")
whole.Trim = 0
check(same(fetch(whole), fetch(delaunay)), "without trimming, the surface is the triangulation")

# What Output Messages shows: the main counts, then the report; nothing where nothing has changed.
shown = []


def note(_caller, _event, words):
    shown.append(words)


note.CallDataType = "string0"
window = vtkOutputWindow.GetInstance()
tag = window.AddObserver("MessageEvent", note)
whole.Trim, whole.FillHoles = 1, 1
whole.UpdatePipeline()
window.RemoveObserver(tag)
lines_shown = "".join(shown).splitlines()
check(len(shown) == 1 and lines_shown[0].startswith(
    "Reconstruct Elevation Surface: 13,299 points, {:,} triangles".format(surface.GetNumberOfPolys())),
    "the text shown begins: %s" % shown)
check_equal("\n".join(lines_shown[1:]), information(whole, "Report"), "the text shown goes on with the report")
whole.Trim = whole.FillHoles = 0

# ---- warnings ----------------------------------------------------------------------------------
strict = simple.ReconstructElevationSurface(Input=cloud, GapTolerance=1)
warnings = messages_of(strict, "WarningEvent")
check(len(warnings) == 1 and "leaves out" in warnings[0], "the filters' warnings are reported: %s" % warnings)
check("leaves out" in information(strict, "Report"), "warnings are in the report too")

# ---- progress and abort ------------------------------------------------------------------------
algorithm = whole.SMProxy.GetClientSideObject()
whole.Trim, whole.FillHoles = 1, 1
seen = []
tag = algorithm.AddObserver("ProgressEvent", lambda caller, _: seen.append(caller.GetProgress()))
whole.UpdatePipeline()
algorithm.RemoveObserver(tag)
check(seen == sorted(seen) and max(numpy.diff([0] + seen)) < 0.5,
      "progress rises without a jump: %s" % seen)
# An abort asked for late leaves no surface either. In ParaView each output is updated by itself.
for each, event in ((whole, "ErrorEvent"), (delaunay, "WarningEvent"), (trim, "WarningEvent"),
                    (fill, "WarningEvent")):
    name = type(each).__name__
    check(fetch(each).GetNumberOfPolys() > 0, "%s has made triangles" % name)
    algorithm = each.SMProxy.GetClientSideObject()
    for number, share in enumerate((0.0, 0.5, 0.97)):
        def stop(caller, _event):
            if caller.GetProgress() >= share:
                caller.SetAbortExecute(1)

        tag = algorithm.AddObserver("ProgressEvent", stop)
        each.NumberOfThreads = 2 + number
        messages = messages_of(each, event)
        check_equal(len(messages), 0 if each is whole else 1, "%s: messages at an abort, %s" % (name, messages))
        check(each is whole or "Stopped" in messages[0], "%s: the message on an abort" % name)
        algorithm.RemoveObserver(tag)
        for port in range(algorithm.GetNumberOfOutputPorts()):
            check_equal(algorithm.GetOutputDataObject(port).GetNumberOfElements(0), 0,
                        "%s: points of output %d after an abort at %g" % (name, port, share))
        check(each is not whole or "stopped" in information(whole, "Report"), "the report says so")
        algorithm.SetAbortExecute(0)  # with newer VTKs, what a script has set stays
        each.NumberOfThreads = 1
        check(fetch(each).GetNumberOfPolys() > 0, "%s: the surface comes back after an abort" % name)
check(same(fetch(whole), fetch(fill)), "the surfaces after aborts are the same")

# ---- tables, images, grids ---------------------------------------------------------------------
table = simple.CSVReader(FileName=[data_file("aegean_sea.csv")])
of_table = simple.ReconstructElevationSurface(Input=table)
of_file = simple.ReconstructElevationSurface(
    Input=simple.ElevationPoints(FileName=data_file("aegean_sea.csv")))
check(same(fetch(of_table), fetch(of_file)), "a table gives the surface of its file")
check("separated by commas" in information(of_file, "Report"), "what the reader found out is in the report")
of_table.Columns = "2,1,3"
check(numpy.array_equal(points(fetch(of_table))[0, :2], points(fetch(of_file))[0, 1::-1]),
      "columns of a table can be chosen")
of_table.Columns = "Depth"
errors = messages_of(of_table)
check(len(errors) == 1 and "three names" in errors[0],
      "wrong columns are reported: %s" % errors)

image = simple.Wavelet(WholeExtent=[-10, 10, -8, 8, 0, 0])
of_image = simple.ReconstructElevationSurface(Input=image)
check_equal(fetch(of_image).GetNumberOfPolys(), 2 * 20 * 16, "triangles of an image")
values = array(fetch(image).GetPointData(), "RTData")
check(numpy.allclose(array(fetch(of_image).GetPointData(), "Elevation"), values),
      "elevations of an image are its array")
image.WholeExtent = [-10, 10, -8, 8, 0, 2]
errors = messages_of(of_image)
check(len(errors) == 1 and "3 layers" in errors[0], "an image of layers is refused: %s" % errors)

# ---- blocks ------------------------------------------------------------------------------------
plane = simple.Plane(XResolution=5, YResolution=4)
blocks = simple.ReconstructElevationSurface(Input=simple.GroupDatasets(Input=[cloud, plane]))
blocks.UpdatePipeline()
surfaces = servermanager.Fetch(blocks)
check_equal(surfaces.GetNumberOfBlocks(), 2, "blocks of the output")
single = fetch(simple.ReconstructElevationSurface(Input=plane))
check(same(surfaces.GetBlock(1), single), "each block is a surface for itself")
rows = report(blocks)
check(("all blocks", "points", "13,329 read") in rows, "the report has the sum of all blocks")
check(any(block.startswith("Block 1") and item == "points" and value.startswith("30 ")
          for block, item, value in rows), "the report covers each block")

# ---- time steps --------------------------------------------------------------------------------
names = [data_file("jacksboro_fault.vtp"), data_file("horizon_synthetic.vtp")]
series = simple.XMLPolyDataReader(FileName=names)
moving = simple.ReconstructElevationSurface(Input=series, FillHoles=0)
for time, name in enumerate(names):
    moving.UpdatePipeline(time)
    count = fetch(simple.XMLPolyDataReader(FileName=[name])).GetNumberOfPoints()
    check_equal(moving.GetDataInformation(0).GetNumberOfPoints(), count, "points at time %d" % time)
    check("{:,} read".format(count) in information(moving, "Report"),
          "the report is that of time %d" % time)

# ---- boundary and faults -----------------------------------------------------------------------
horizon = simple.XMLPolyDataReader(FileName=[data_file("horizon_synthetic.vtp")])
given = simple.ReconstructElevationSurface(
    Input=horizon,
    Boundary=simple.XMLPolyDataReader(FileName=[data_file("horizon_synthetic_boundary.vtp")]),
    Faults=simple.XMLPolyDataReader(FileName=[data_file("horizon_synthetic_faults.vtp")]))
check_equal(messages_of(given), [], "errors with boundary and faults")
items = dict((item, value) for item, value in report(given) if item in ("faults", "trimmed"))
check("faults" in items, "faults are in the report")

# ---- errors ------------------------------------------------------------------------------------
line = simple.Line(Point1=[-0.5, -0.5, 0], Point2=[0.5, -0.5, 0], Resolution=3)
wrong = simple.ReconstructElevationSurface(Input=plane)
for change, expected in (
    ({"Boundary": line}, "not closed"),
    ({"Boundary": simple.Disk(OuterRadius=1e4, InnerRadius=9e3)}, "The boundary encloses no triangle"),
    ({"Boundary": None, "Faults": cloud}, "The faults have no line and no polygon"),
    ({"Faults": simple.Line(Point1=[80, 80, 0], Point2=[90, 80, 0])}, "The faults do not overlap the points"),
    ({"Faults": None, "MaximumEdgeLength": 1e-9}, "A Maximum Edge Length of 0."),
    ({"MaximumEdgeLength": 0, "Spacing": -1}, "Spacing takes a number of 0 or more"),
    ({"Spacing": 0, "ElevationArray": "Depth"}, "no point array named Depth"),
    ({"ElevationArray": "", "Input": simple.Line()}, "on one line"),
):
    for name, value in change.items():
        setattr(wrong, name, value)
    errors = messages_of(wrong)
    check(len(errors) == 1 and expected in errors[0], "the error with %s: %s" % (change, errors))
    check_equal(fetch(wrong).GetNumberOfPoints(), 0, "points with %s" % change)
wrong.Input = plane
check_equal(messages_of(wrong), [], "errors after the cause is gone")
check(same(fetch(wrong), single), "the surface after the cause is gone")

finish()
