# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The state file of the plugin loads, finds its data, and shows a surface coloured by elevation."""
import os

from paraview import simple

from plugin_testing import check, fetch, finish, information, screenshot, start

data_folder, temporary_folder = start()
state = os.path.join(os.path.dirname(data_folder), "Plugin", "ElevationSurface.pvsm")
simple.LoadState(state, data_directory=data_folder)

surface = simple.FindSource("Surface of Olinda")
check(surface is not None, "the state has the surface")
check(fetch(surface).GetNumberOfPoints() > 10266, "the state finds its data, and holes are filled")
check("10,266 read" in information(surface, "Report"), "the report")

view = simple.GetActiveViewOrCreate("RenderView")
pixels = screenshot(os.path.join(temporary_folder, "ParaViewState.png"), view).astype(int)
red, blue = (pixels[..., i] - pixels[..., 2 - i] > 90 for i in (0, 2))
check(red.mean() > 0.01 and blue.mean() > 0.05,
      "high and low places are seen in their colours (%.3f, %.3f)" % (red.mean(), blue.mean()))

finish()
