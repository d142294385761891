# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The state file of the plugin loads, finds its data, and shows a filled surface."""
import os

from paraview import simple

from plugin_testing import check, check_equal, fetch, finish, information, screenshot, start

data_folder, temporary_folder = start()
state = os.path.join(os.path.dirname(data_folder), "Plugin", "ElevationSurface.pvsm")
simple.LoadState(state, data_directory=data_folder)

filled = simple.FindSource("FillElevationHoles")
check(filled is not None, "the state has the filter")
check(fetch(filled).GetNumberOfPoints() > 13299, "the state finds its data, and holes are filled")
check_equal(information(filled, "NumberOfFilledHoles"), information(filled, "NumberOfHoles"),
            "filled holes")
check_equal(simple.FindSource("GridDelaunay2D").MaximumEdgeLength, 2, "edge limit in the state")

view = simple.GetActiveViewOrCreate("RenderView")
pixels = screenshot(os.path.join(temporary_folder, "ParaViewState.png"), view).astype(int)
orange = (pixels[..., 0] - pixels[..., 2] > 80).mean()
check(0.01 < orange < 0.6, "filled holes are seen in their colour (%.2f)" % orange)

finish()
