# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The first picture of elevations: their colours and plain numbers, seen obliquely, with a vertical
exaggeration that suits the relief. What is shown with it has the same scale; what the user has chosen
stays."""
import os

import numpy
from paraview import servermanager, simple

from plugin_testing import check, check_close, check_equal, fetch, finish, information, start

data_folder, temporary_folder = start()
from vtkelevationsurface import first_view  # noqa: E402  (the plugin brings it)


def written(name, rows):
    path = os.path.join(os.path.abspath(temporary_folder), name)
    numpy.savetxt(path, rows, fmt="%.6g")
    return path


def hills(height, least=0.0, at=0.0):
    """41 by 41 points, 10 apart, of smooth hills."""
    x, y = (10.0 * one.ravel() for one in numpy.meshgrid(range(41), range(41)))
    z = least + height * (0.5 - 0.5 * numpy.cos(x / 60) * numpy.cos(y / 60))
    return numpy.column_stack((x + at, y, z))


def direction_of(view):
    """Unit vector from what is looked at to the eye."""
    eye = numpy.subtract(view.CameraPosition, view.CameraFocalPoint)
    return eye / numpy.linalg.norm(eye)


def stops_of(shown):
    """The colours of a representation as in first_view.py."""
    values = numpy.reshape(list(shown.LookupTable.RGBPoints), (-1, 4))[:, 1:]
    return ["#%02x%02x%02x" % tuple(int(round(255 * one)) for one in rgb) for rgb in values]


def forget():
    """Takes away what is shown, and its colours. The new session has the same server: else, as by
    simple.ResetSession(), paraview.simple would look for all classes of ParaView again, for a second."""
    servermanager.ProxyManager().UnRegisterProxies()
    # Where it stands differs by version.
    simple.ResetSession.__globals__["_initializeSession"](servermanager.ActiveConnection)
    return simple.CreateRenderView()


def label(text, value):
    """A number as the scalar bar shows it, by a format of C or, from ParaView 6.1 on, of C++."""
    return text.format(value) if "{" in text else text % value


OBLIQUE = [numpy.sin(numpy.radians(first_view.BEARING)) * numpy.cos(numpy.radians(first_view.HEIGHT)),
           numpy.cos(numpy.radians(first_view.BEARING)) * numpy.cos(numpy.radians(first_view.HEIGHT)),
           numpy.sin(numpy.radians(first_view.HEIGHT))]

# ---- points, then their surface ----------------------------------------------------------------
view = forget()
reader = simple.ElevationPoints(FileName=written("low.xyz", hills(4.0, 100.0)))
shown = simple.Show(reader, view)
factor = information(reader, "VerticalExaggeration")
check(8 <= factor <= 25, "relief of 4 in 400 is exaggerated by %g" % factor)
check_equal(list(shown.Scale), [1, 1, factor], "scale of points")
check(numpy.allclose(direction_of(view), OBLIQUE), "a new view looks obliquely")
check(100 * factor < view.CameraFocalPoint[2] < 104 * factor, "it looks at what is exaggerated")
check_equal(stops_of(shown), list(first_view.LAND), "colours of points above the sea")
surface = simple.ReconstructElevationSurface(Input=reader)
shown = simple.Show(surface, view)
check_equal(information(surface, "VerticalExaggeration"), factor, "the surface of all points")
check_equal((list(shown.Scale), list(shown.ColorArrayName)), ([1, 1, factor], ["POINTS", "Elevation"]),
            "look of the surface")
shown.SetScalarBarVisibility(view, True)
bar = simple.GetScalarBar(shown.LookupTable, view)
check_equal([label(bar.LabelFormat, 104.04), label(bar.RangeLabelFormat, 104.04)], ["104.0", "104.0"],
            "numbers of the scalar bar")
check_equal(bar.AutomaticLabelFormat, 0, "the format of the scalar bar is used")

# ---- what is shown with it ----------------------------------------------------------------------
shown.Scale = [1, 1, 3]
simple.Hide(reader, view)
outlines = simple.Show(simple.OutputPort(surface, 2), view)
check_equal((list(outlines.Scale), outlines.LineWidth), ([1, 1, 3], 3), "the boundary, next to the surface")
simple.Hide(simple.OutputPort(surface, 2), view)
view.CameraPosition, view.CameraViewUp = [200, 200, 900], [0, 1, 0]
view.CameraFocalPoint = [200, 200, 300]
simple.Show(simple.GridDelaunay2D(Input=reader), view)
check_equal(direction_of(view).tolist(), [0, 0, 1], "a view that shows something is not turned")

# ---- a view that the user has placed, and colours that he has chosen ---------------------------
view = forget()
view.CameraPosition, view.CameraFocalPoint = [200, 200, 9000], [200, 200, 0]
simple.GetColorTransferFunction("Elevation").ApplyPreset("Grayscale", True)
chosen = list(simple.GetColorTransferFunction("Elevation").RGBPoints)[1:4]
shown = simple.Show(reader, view)
check_equal(list(view.CameraPosition), [200, 200, 9000], "a camera that was placed")
check_equal(list(shown.LookupTable.RGBPoints)[1:4], chosen, "colours that were chosen")

# ---- the sea; steep and rough ground; nothing ---------------------------------------------------
view = forget()
reader = simple.ElevationPoints(FileName=written("sea.xyz", hills(2000.0, -2100.0)))
shown = simple.Show(reader, view)
check_equal(stops_of(shown), list(first_view.SEA), "colours of points below the sea")
check(information(reader, "VerticalExaggeration") < 1, "relief higher than the map is wide is lowered")
check_equal(label(simple.GetScalarBar(shown.LookupTable, view).RangeLabelFormat, -2100.0), "-2100",
            "numbers of a large range")
line = numpy.column_stack((numpy.arange(9.0), numpy.zeros(9), numpy.arange(9.0)))
reader = simple.ElevationPoints(FileName=written("line.xyz", line))
fetch(reader)
check_equal(information(reader, "VerticalExaggeration"), 1, "points on a line")

# ---- points of another reader, seen from above -------------------------------------------------
view = forget()
table = simple.CSVReader(FileName=[written("table.csv", hills(4.0, 100.0))], FieldDelimiterCharacters=" ",
                         HaveHeaders=0)
cloud = simple.TableToPoints(Input=table, XColumn="Field 0", YColumn="Field 1", ZColumn="Field 2")
simple.Show(cloud, view)
simple.ResetCamera(view)
surface = simple.ReconstructElevationSurface(Input=cloud)
shown = simple.Show(surface, view)
check_equal(list(shown.Scale), [1, 1, factor], "scale of the surface of such points")
check(numpy.allclose(direction_of(view), OBLIQUE), "its first picture is oblique")
check_equal(list(simple.Show(simple.GridDelaunay2D(Input=cloud), view).Scale), [1, 1, factor],
            "another surface next to it has its scale")

# ---- without an entry in Python upstream: by the bounds ----------------------------------------
view = forget()
cloud = simple.TableToPoints(Input=simple.CSVReader(
    FileName=[os.path.join(temporary_folder, "table.csv")], FieldDelimiterCharacters=" ", HaveHeaders=0),
    XColumn="Field 0", YColumn="Field 1", ZColumn="Field 2")
shown = simple.Show(simple.GridDelaunay2D(Input=cloud), view)
check_close(shown.Scale[2], 17, "scale of a surface of which its bounds are known", relative=0.1)

# ---- outlines of holes -------------------------------------------------------------------------
view = forget()
rows = hills(4.0)
holed = rows[numpy.hypot(rows[:, 0] - 200, rows[:, 1] - 200) > 45]
holed = holed[numpy.hypot(holed[:, 0] - 80, holed[:, 1] - 80) > 25]
surface = simple.ReconstructElevationSurface(
    Input=simple.ElevationPoints(FileName=written("holes.xyz", holed)), MaximumHoleSize=100,
    OpenEdgeLength=20)
simple.Show(surface, view)
shown = simple.Show(simple.OutputPort(surface, 1), view)
table = fetch(surface, 1).GetCellData()
names = [table.GetAbstractArray("StatusName").GetValue(i) for i in range(2)]
check_equal(sorted(names), ["replaced", "too large"], "the status of two holes")
check(set(names) <= set(first_view.STATUS), "each has its colour")
check_equal((list(shown.ColorArrayName), shown.LineWidth), (["CELLS", "StatusName"], 4),
            "outlines are thick and coloured by status")
check_equal(list(shown.LookupTable.Annotations), [word for one in first_view.STATUS for word in (one, one)],
            "words of the colours")
colours = numpy.reshape(list(shown.LookupTable.IndexedColors), (-1, 3))
check_equal(["#%02x%02x%02x" % tuple(int(round(255 * one)) for one in rgb) for rgb in colours],
            list(first_view.STATUS.values()), "colours of the words")

finish()
