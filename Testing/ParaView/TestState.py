# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The state file that the build has made loads, finds its data, has all properties of the panels, and
shows a surface coloured by elevation."""
import os
import sys
import xml.etree.ElementTree

from paraview import simple

from plugin_testing import (check, check_elevation_colours, check_equal, fetch, finish, information,
                            screenshot, start)

data_folder, temporary_folder = start()
plugin = sys.argv[sys.argv.index("--plugin") + 1]
state = os.path.join(os.path.dirname(plugin), "ElevationSurface.pvsm")

from vtkelevationsurface.description import DESCRIBED  # noqa: E402  (the plugin brings it)

saved = xml.etree.ElementTree.parse(state)
ENTRIES = {"chain": "ReconstructElevationSurface", "reader": "ElevationPointsReader"}
for place, name in ENTRIES.items():
    proxies = [proxy for proxy in saved.iter("Proxy") if proxy.get("type") == name]
    check_equal(len(proxies), 1, "proxies of " + name)
    has = {one.get("name") for proxy in proxies for one in proxy.iter("Property")}
    for one in DESCRIBED.values():
        if place in one.places:
            own = one.name_in(place)
            check(own in has, "the state has no %s of %s" % (own, name))

simple.LoadState(state, data_directory=data_folder)

surface = simple.FindSource("Surface of Olinda")
check(surface is not None, "the state has the surface")
check(fetch(surface).GetNumberOfPoints() > 10266, "the state finds its data, and holes are filled")
check("10,266 read" in information(surface, "Report"), "the report")

view = simple.GetActiveViewOrCreate("RenderView")
pixels = screenshot(os.path.join(temporary_folder, "ParaViewState.png"), view)
check_elevation_colours(pixels, "the state")

finish()
