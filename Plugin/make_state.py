# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Makes ElevationSurface.pvsm, the state of ParaView that shows a text file and its surface.

    pvpython Plugin/make_state.py <the built plugin> <file to write>

The build of the plugin does so, and puts the state next to it. The state names its data file without a
folder. When it is loaded, ParaView must search the folder Data of the repository: "Search files
under specified directory" in the client, LoadState(file, data_directory=folder) in a script.
"""
import os
import re
import sys

from paraview import simple

here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(here), "Examples", "ParaView"))
from text_to_surface import show_relief  # noqa: E402

if len(sys.argv) != 3:
    sys.exit(__doc__)
simple.LoadPlugin(sys.argv[1], remote=False)
data = os.path.join(os.path.dirname(here), "Data", "olinda_land.xyz")

view = simple.CreateRenderView(ViewSize=[1000, 800], OrientationAxesVisibility=0)
points = simple.ElevationPoints(registrationName="olinda_land.xyz", FileName=data)
surface = simple.ReconstructElevationSurface(registrationName="Surface of Olinda", Input=points)

surface.UpdatePipeline()
if surface.GetDataInformation().GetNumberOfCells() == 0:
    sys.exit("the surface of the state was not made")

# The relief, the outlines of the places that were filled, and of the surface.
show_relief(surface, view)
for port in (1, 2):
    simple.Show(simple.OutputPort(surface, port), view)
simple.Render(view)
simple.SetActiveSource(surface)
path = sys.argv[2]
simple.SaveState(path + ".new.pvsm")
with open(path + ".new.pvsm") as file:
    text = file.read().replace(data, os.path.basename(data))
os.remove(path + ".new.pvsm")
named = re.findall(r'value="(/[^"]+)"', text)
if named:
    sys.exit("the state names files of this machine: " + ", ".join(named))
with open(path, "w") as file:
    file.write(text)
