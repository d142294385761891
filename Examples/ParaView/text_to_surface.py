# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""From a file of points to a surface and a picture of it, without a window.

    PV_PLUGIN_PATH=<folder of the plugin> pvpython text_to_surface.py POINTS SURFACE.vtp PICTURE.png

What was recognised in the file and what became of every point and hole is printed. The picture
shows the relief from the south, with heights times ten.
"""
import sys

from paraview import simple


def show_relief(surface, view):
    """Heights times ten, coloured by elevation, with a legend."""
    shown = simple.Show(surface, view)
    shown.Scale = [1, 1, 10]
    simple.ColorBy(shown, ("POINTS", "Elevation"))
    shown.RescaleTransferFunctionToDataRange()
    shown.SetScalarBarVisibility(view, True)
    legend = simple.GetScalarBar(simple.GetColorTransferFunction("Elevation"), view)
    legend.Title = "Elevation in m"
    legend.RangeLabelFormat = "%.0f"


def main(points_file, surface_file, picture_file):
    points = simple.ElevationPoints(FileName=points_file)
    surface = simple.ReconstructElevationSurface(Input=points)
    # ParaView 5.11 with the newest expat of Debian 12 cannot read appended data, its default.
    simple.SaveData(surface_file, surface, DataMode="Binary")

    view = simple.CreateRenderView(ViewSize=[1200, 800], OrientationAxesVisibility=0)
    show_relief(surface, view)
    simple.ResetCamera(view)
    simple.GetActiveCamera().Elevation(-50)
    simple.ResetCamera(view)
    simple.GetActiveCamera().Zoom(1.4)
    simple.SaveScreenshot(picture_file, view)


if __name__ == "__main__":
    main(*sys.argv[1:])
