# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The plugin's folder alone is enough, wherever it is copied and whatever it is called."""
import os
import shutil
import sys

from paraview import simple

from plugin_testing import check, check_equal, fetch, finish, start


def copied(plugin, folder):
    """The plugin in a copy of its folder."""
    place = os.path.join(os.path.abspath(folder), "a copied plugin")
    shutil.rmtree(place, ignore_errors=True)
    shutil.copytree(os.path.dirname(plugin), place)
    return os.path.join(place, os.path.basename(plugin))


data_folder, temporary_folder = start(copied)
place = os.path.join(os.path.abspath(temporary_folder), "a copied plugin")

check_equal(fetch(simple.GridDelaunay2D(Input=simple.Plane())).GetNumberOfPolys(), 2, "triangles")
if sys.platform.startswith("linux"):
    with open("/proc/self/maps") as maps:
        used = {line.split(None, 5)[-1].strip() for line in maps if "libvtkElevationSurface" in line}
    check_equal({os.path.dirname(file) for file in used}, {place}, "folder of the library")

import vtkelevationsurface  # noqa: E402
from vtkelevationsurface import pieces  # noqa: E402

check_equal(os.path.dirname(vtkelevationsurface.__file__), os.path.join(place, "vtkelevationsurface"),
            "folder of the Python package")
check_equal(pieces.vtkReconstructPieces().GetNumberOfPoints(), 0, "points of a surface in pieces without any")
cloud = vtkelevationsurface.read(os.path.join(data_folder, "olinda_land.xyz"))
surface = vtkelevationsurface.reconstruct(cloud).surface
check(surface.GetNumberOfPolys() > 0, "the package works on ParaView's VTK")

shutil.rmtree(place, ignore_errors=True)
finish()
