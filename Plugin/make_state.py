# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Makes ElevationSurface.pvsm, the state of ParaView that shows the three filters at work.

    pvpython Plugin/make_state.py <the built plugin>

The state names its data file without a folder. When it is loaded, ParaView is told to search the
folder Data of the repository: "Search files under specified directory" in the client,
LoadState(file, data_directory=folder) in a script.
"""
import os
import re
import sys

from paraview import simple

if len(sys.argv) != 2:
    sys.exit(__doc__)
simple.LoadPlugin(sys.argv[1], remote=False)
here = os.path.dirname(os.path.abspath(__file__))
data = os.path.join(os.path.dirname(here), "Data", "b9_ground.vtp")
state = os.path.join(here, "ElevationSurface.pvsm")

view = simple.CreateRenderView(ViewSize=[1000, 800], OrientationAxesVisibility=0)
points = simple.XMLPolyDataReader(registrationName="b9_ground.vtp", FileName=[data])
surface = simple.GridDelaunay2D(registrationName="GridDelaunay2D", Input=points, MaximumEdgeLength=2)
trimmed = simple.TrimOutwardTriangles(registrationName="TrimOutwardTriangles", Input=surface)
filled = simple.FillElevationHoles(registrationName="FillElevationHoles", Input=trimmed)

# New triangles in orange, old ones in green, the outlines of the holes in red.
shown = simple.Show(filled, view)
shown.SetRepresentationType("Surface With Edges")
shown.EdgeColor = [0.3, 0.35, 0.3]
simple.ColorBy(shown, ("CELLS", "HoleId"))
table = simple.GetColorTransferFunction("HoleId")
table.RGBPoints = [-1, 0.62, 0.74, 0.62, -0.5, 0.62, 0.74, 0.62, -0.49, 0.9, 0.6, 0.25, 0, 0.9, 0.6, 0.25]
table.ColorSpace = "RGB"
outlines = simple.Show(simple.OutputPort(filled, 1), view)
outlines.ColorArrayName = [None, ""]
outlines.AmbientColor = outlines.DiffuseColor = [0.6, 0, 0]
outlines.LineWidth = 2

simple.ResetCamera(view)
view.CameraParallelProjection = 1
camera = simple.GetActiveCamera()
camera.Elevation(-40)
simple.ResetCamera(view)
camera.Zoom(1.4)
simple.Render(view)
simple.SetActiveSource(filled)
simple.SaveState(state)

with open(state) as file:
    text = file.read().replace(data, os.path.basename(data))
with open(state, "w") as file:
    file.write(text)
for path in re.findall(r'value="(/[^"]+)"', text):
    print("the state names a file of this machine:", path)
