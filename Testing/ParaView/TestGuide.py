# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Documentation/ParaView.md is true: its messages are those that one gets, and its code runs.

Each message is a block of text under a heading of "What can go wrong"; "…" is what differs.
Each heading has a function here that provokes the message.
"""
import os
import re
import runpy
import sys

from paraview import simple

from guide import guide_messages, guide_text, is_message
from plugin_testing import check, check_equal, fetch, finish, messages_of, start

data_folder, temporary_folder = start()
repository = os.path.dirname(data_folder)
guide = guide_text()

CASES = {}


def provokes(heading):
    """Notes that a function returns the messages that stand under a heading of the guide."""
    def note(function):
        CASES[heading] = function
        return function
    return note


def data(name):
    return os.path.join(data_folder, name)


def written(name, text):
    path = os.path.join(os.path.abspath(temporary_folder), name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def reader_messages(path, **properties):
    return messages_of(simple.ElevationPoints(FileName=path, **properties))


@provokes("The file has no numbers")
def no_numbers():
    return reader_messages(written("words.txt", "no points here\n"))


@provokes("A column has another name")
def no_column():
    return reader_messages(data("olinda_land.xyz"), Columns="Easting,Northing,Top")


@provokes("A column holds words")
def words_in_column():
    rows = "".join("W%d,%d,%d,%d\n" % (i, 100 + 7 * i, 200 + 3 * i, -1500 - i) for i in range(20))
    table = written("wells.csv", "Well,Easting,Northing,Top\n" + rows)
    return reader_messages(table, Columns="Easting,Northing,Well")


def surface_messages(points, event="ErrorEvent", **properties):
    return messages_of(simple.ReconstructElevationSurface(Input=points, **properties), event)


def olinda():
    return simple.ElevationPoints(FileName=data("olinda_land.xyz"))


@provokes("All triangles are too long")
def too_long():
    return surface_messages(olinda(), MaximumEdgeLength=50)


@provokes("The points are on a line")
def on_a_line():
    return surface_messages(simple.Line(Resolution=20))


@provokes("The boundary is not closed")
def open_boundary():
    line = simple.Line(Point1=[288900, 9111000, 0], Point2=[298000, 9120000, 0])
    return surface_messages(olinda(), Boundary=line)


@provokes("The boundary is elsewhere")
def boundary_elsewhere():
    return surface_messages(olinda(), Boundary=simple.Disk())


@provokes("The faults are elsewhere")
def faults_elsewhere():
    return surface_messages(olinda(), Faults=simple.Disk())


@provokes("The faults are points")
def faults_are_points():
    return surface_messages(olinda(), Faults=olinda())


@provokes("The table has too few columns")
def two_columns():
    table = simple.ProgrammableSource(OutputDataSetType="vtkTable", Script="""
import numpy
output.RowData.append(numpy.arange(5.0), "Easting")
output.RowData.append(numpy.arange(5.0), "Northing")
""")
    return surface_messages(table)


@provokes("The image has layers")
def layers():
    return surface_messages(simple.Wavelet())


@provokes("Much is left out")
def left_out():
    ground = simple.OpenDataFile(data("b9_ground.vtp"))
    return surface_messages(ground, "WarningEvent", GapTolerance=1)


@provokes("Grid Delaunay 2D leaves nothing")
def nothing_left():
    return messages_of(simple.GridDelaunay2D(Input=olinda(), MaximumEdgeLength=50), "WarningEvent")


@provokes("The cells are not triangles")
def quadrilaterals():
    return messages_of(simple.FillElevationHoles(Input=simple.Plane()))


# ---- the messages ------------------------------------------------------------------------------
in_guide = guide_messages("What can go wrong")
check_equal(sorted(in_guide), sorted(CASES), "headings with a message, and cases of this test")
for heading, case in CASES.items():
    messages = case()
    check_equal(len(messages), 1, "%s: number of messages %s" % (heading, messages))
    expected = in_guide.get(heading, "")
    check(messages and is_message(messages[0], expected),
          "%s: %s, not %s" % (heading, messages, expected))

# ---- the code and the example ------------------------------------------------------------------
os.chdir(temporary_folder)
if not os.path.exists("Data"):
    os.symlink(data_folder, "Data")
for number, code in enumerate(re.findall(r"```python\n(.*?)```", guide, re.DOTALL), 1):
    exec(compile(code, "code %d of the guide" % number, "exec"), {})

results = ["example_surface.vtp", "example_surface.png"]
sys.argv = ["", "Data/olinda_land.xyz", *results]
example = os.path.join(repository, "Examples", "ParaView", "text_to_surface.py")
runpy.run_path(example, None, "__main__")
surface = fetch(simple.XMLPolyDataReader(FileName=[os.path.abspath(results[0])]))
check(surface.GetNumberOfPoints() > 10266, "the example writes the surface")
check(os.path.getsize(results[1]) > 50000, "the example writes the picture")

finish()
