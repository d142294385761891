# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's own client, driven as by a user: the plugin is there by itself, a text file is opened, the
surface chosen in the menu, Apply pressed, a property changed. What the pipeline then has and the view
shows is checked. A LAS file, which no other reader takes, opens without a question.

    TestClient.py --client <paraview> --plugin <the built plugin> -D <Data> -T <folder>

The functions check_... are called inside the client, from its Python shell.
"""
import argparse
import json
import os
import struct
import sys

from client import Client

RESULTS = "client_results.json"


def note(folder, failures):
    """Adds what a check found wrong to the results."""
    path = os.path.join(folder, RESULTS)
    results = json.load(open(path)) if os.path.exists(path) else []
    json.dump(results + [failures], open(path, "w"))


def check_surface(folder, name, largest_hole):
    """The surface is shown, coloured by elevation, and holes up to a size are filled; 0: all."""
    from paraview import simple
    from plugin_testing import (FAILURES, array, check, check_elevation_colours, check_equal, fetch,
                                points, screenshot)
    import numpy
    source = simple.FindSource("ReconstructElevationSurface1")
    surface, holes = fetch(source), fetch(source, 1)
    check_equal(surface.GetNumberOfPoints() > 10266, not largest_hole, name + ": points are added")
    status = set(array(holes.GetCellData(), "Status"))
    check_equal(status, {1} if largest_hole else {4}, name + ": the status of holes")
    check(numpy.array_equal(array(surface.GetPointData(), "Elevation"), points(surface)[:, 2]),
          name + ": Elevation is z")
    view = simple.GetActiveView()
    shown = simple.GetRepresentation(source, view)
    check_equal((shown.Visibility, list(shown.ColorArrayName)), (1, ["POINTS", "Elevation"]),
                name + ": Apply shows the surface, coloured by elevation")
    check_equal((shown.Scale[2] > 1, view.CameraViewUp[2] > 0.5), (True, True),
                name + ": Apply shows the surface exaggerated and obliquely")
    check_elevation_colours(screenshot(os.path.join(folder, name + ".png"), view), name)
    note(folder, FAILURES)
    FAILURES.clear()


def check_plugin(folder):
    """The plugin manager has the plugin, loaded, with Auto Load on."""
    from paraview import servermanager
    from plugin_testing import FAILURES, check_equal
    manager = servermanager.vtkSMProxyManager.GetProxyManager().GetPluginManager()
    known = manager.GetLocalInformation()
    found = [(bool(known.GetPluginLoaded(i)), bool(known.GetAutoLoad(i)))
             for i in range(known.GetNumberOfPlugins())
             if known.GetPluginName(i) == "ElevationSurfacePlugin"]
    check_equal(found, [(True, True)], "the plugin is loaded, and Auto Load is on")
    note(folder, FAILURES)
    FAILURES.clear()


def check_las(folder):
    """The LAS file that was opened is read by Elevation Points."""
    from paraview import simple
    from plugin_testing import FAILURES, check_equal, points
    source = simple.GetActiveSource()
    check_equal(type(source).__name__, "ElevationPoints", "the reader of a LAS file")
    check_equal(os.path.basename(source.FileName[0]), "seven.las", "the file")
    cloud = source.SMProxy.GetClientSideObject().GetOutputDataObject(0)
    check_equal(points(cloud).tolist(), [[i, 3 * i, i * i] for i in range(7)], "points of a LAS file")
    note(folder, FAILURES)
    FAILURES.clear()


def write_las(path):
    """Seven points (i, 3 i, i i) in a LAS 1.2 file."""
    header = struct.pack("<4sHH16sBB32s32sHHHIIBHI20s12d", b"LASF", 0, 0, b"", 1, 2, b"", b"", 1, 2026,
                         227, 227, 0, 0, 20, 7, struct.pack("<5I", 7, 0, 0, 0, 0),
                         1, 1, 1, 0, 0, 0, 6, 0, 18, 0, 36, 0)
    records = [struct.pack("<iiiHBBbBH", i, 3 * i, i * i, 0, 9, 2, 0, 0, 0) for i in range(7)]
    with open(path, "wb") as file:
        file.write(header + b"".join(records))


def steps(client, data):
    """What the user does, with a check after each Apply."""
    def check(name, largest_hole):
        client.python("TestClient.check_surface(%r, %r, %r)" % (client.folder, name, largest_hole))

    here = os.path.dirname(os.path.abspath(__file__))
    client.python("import sys; sys.path.insert(0, %r); import TestClient" % here)
    client.python("TestClient.check_plugin(%r)" % client.folder)
    client.open(os.path.join(data, "olinda_land.xyz"))
    client.take_marked_reader()
    client.apply()
    client.choose("menuFilters/Elevation Surface", "ReconstructElevationSurface")
    client.apply()
    check("all holes filled", 0)
    client.set("MaximumHoleSize", "DoubleLineEdit0", 1)
    client.apply()
    check("no hole filled", 1)
    # The panel shows what was used, also when Apply is pressed again.
    used = client.field("EffectiveGapTolerance") + "/DoubleLineEdit0"
    client.expect(used, "text", "4.5")
    client.set("GapTolerance", "DoubleLineEdit0", 6)
    client.apply()
    client.expect(used, "text", "6")
    # What plays no part is greyed out.
    client.python("source = GetActiveSource(); ring = Disk(); SetActiveSource(source)")
    for name, change in (("GapTolerance", "source.Boundary = ring"), ("Spacing", "source.FillHoles = 0")):
        field = client.field(name) + "/DoubleLineEdit0"
        client.expect(field, "enabled", "true")
        client.python(change)
        client.expect(field, "enabled", "false")
    las = os.path.join(client.folder, "seven.las")
    write_las(las)
    client.open(las)
    client.apply()
    client.python("TestClient.check_las(%r)" % client.folder)


def main():
    parser = argparse.ArgumentParser()
    for option in ("--client", "--plugin", "-D", "-T"):
        parser.add_argument(option, required=True)
    options = parser.parse_args()
    folder = os.path.join(options.T, "Client")
    # Beside the plugin's folder is the file that has ParaView load it, as the package has it.
    plugins = os.path.dirname(os.path.dirname(os.path.abspath(options.plugin)))
    client = Client([options.client], os.path.join(plugins, "vtkelevationsurface.xml"), folder)
    results = os.path.join(folder, RESULTS)
    if os.path.exists(results):
        os.remove(results)
    steps(client, os.path.abspath(options.D))
    output = client.run(timeout=300)
    checks = sum("check_" in arguments for *_, arguments in client.steps)
    found = json.load(open(results)) if os.path.exists(results) else []
    failures = [failure for failures in found for failure in failures]
    if failures or len(found) != checks:
        print(output, "%d of %d checks were made" % (len(found), checks), *failures, sep="\n")
        sys.exit(1)


if __name__ == "__main__":
    main()
