# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""From a file of points to a surface and a picture of it, without a window.

    PV_PLUGIN_PATH=<folder of the plugin> pvpython text_to_surface.py POINTS SURFACE.vtp PICTURE.png

It prints what was recognised in the file, and how every point was used and every hole treated. The
plugin chooses the first look of the surface: colours, the view from the south, and a factor for
heights, which is the third number of shown.Scale.
"""
import sys

from paraview import simple


def show_relief(surface, view):
    """The surface with a legend."""
    shown = simple.Show(surface, view)
    shown.SetScalarBarVisibility(view, True)
    simple.GetScalarBar(shown.LookupTable, view).Title = "Elevation in m"
    simple.ResetCamera(view)
    simple.GetActiveCamera().Zoom(1.3)


def main(points_file, surface_file, picture_file):
    points = simple.ElevationPoints(FileName=points_file)
    surface = simple.ReconstructElevationSurface(Input=points)
    # ParaView 5.11 with the newest expat of Debian 12 cannot read appended data, its default.
    simple.SaveData(surface_file, surface, DataMode="Binary")

    view = simple.CreateRenderView(ViewSize=[1200, 800], OrientationAxesVisibility=0)
    show_relief(surface, view)
    simple.SaveScreenshot(picture_file, view)


if __name__ == "__main__":
    main(*sys.argv[1:])
