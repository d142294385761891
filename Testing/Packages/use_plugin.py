# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A file to a surface in ParaView, which loads the plugin as PV_PLUGIN_PATH says.

For pvpython or paraview --script. In the environment: POINTS, the file; SERVER, "host port", if a
server is to do it; PICTURE, a file to draw the surface into, which ends the client.
"""
import os
import sys

from paraview import simple

if "SERVER" in os.environ:
    host, port = os.environ["SERVER"].split()
    simple.Connect(host, int(port))
points = simple.OpenDataFile(os.environ["POINTS"])
if type(points).__name__ != "ElevationPoints":
    sys.exit("the file was opened by %s" % type(points).__name__)
surface = simple.ReconstructElevationSurface(Input=points)
surface.UpdatePipeline()
triangles = surface.GetDataInformation().GetNumberOfCells()
print("%d triangles in ParaView %s" % (triangles, simple.GetParaViewVersion()))
if triangles < 10000:
    sys.exit("that is too few")
if "PICTURE" in os.environ:
    view = simple.GetActiveViewOrCreate("RenderView")
    simple.Show(surface, view)
    view.ResetCamera()
    simple.SaveScreenshot(os.environ["PICTURE"], view, ImageResolution=[800, 600])
    sys.stdout.flush()
    os._exit(0)
