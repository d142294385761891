# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's own client, driven as by a user: a file is opened, filters are chosen in the menu, Apply
is pressed, a property changed. What the pipeline browser then has and the view shows is checked.

    TestClient.py --client <paraview> --plugin <the built plugin> -D <Data> -T <folder to write into>

The functions check_... are called inside the client, from its Python shell.
"""
import argparse
import json
import os
import sys

from client import Client

RESULTS = "client_results.json"


def note(folder, failures):
    """Adds what a check found wrong to the results."""
    path = os.path.join(folder, RESULTS)
    results = json.load(open(path)) if os.path.exists(path) else []
    json.dump(results + [failures], open(path, "w"))


def check_surface(folder, name, edges_at_most):
    """The surface of a filter is shown, without triangles wider than a limit; 0: without a limit."""
    from paraview import simple
    from plugin_testing import FAILURES, check, fetch, points, screenshot, triangles
    import numpy
    source = simple.FindSource(name)
    surface = fetch(source)
    corners = points(surface)[triangles(surface)][:, :, :2]
    longest = numpy.linalg.norm(corners - numpy.roll(corners, 1, axis=1), axis=2).max()
    check(surface.GetNumberOfPolys() > 20000, "%s has triangles" % name)
    check((longest > 2) == (edges_at_most == 0), "%s: longest edge %g" % (name, longest))
    view = simple.GetActiveView()
    check(simple.GetRepresentation(source, view).Visibility == 1, "Apply shows %s" % name)
    pixels = screenshot(os.path.join(folder, "Client%s.png" % name), view).astype(int)
    background = numpy.abs(pixels - pixels[0, 0]).max(axis=2) < 8
    check(background.mean() < 0.9, "%s is seen in the view" % name)
    note(folder, FAILURES)
    FAILURES.clear()


def steps(client, data):
    """What the user does, with a check after each Apply."""
    def check(name, limit):
        client.python("TestClient.check_surface(%r, %r, %r)" % (client.folder, name, limit))

    client.python("import sys; sys.path.insert(0, %r); import TestClient" % os.path.dirname(__file__))
    client.open(os.path.join(data, "b9_ground.vtp"))
    client.apply()
    client.choose("menuFilters/Elevation Surface", "GridDelaunay2D")
    client.apply()
    check("GridDelaunay2D1", 0)
    client.set("MaximumEdgeLength", 2)
    client.apply()
    check("GridDelaunay2D1", 2)


def main():
    parser = argparse.ArgumentParser()
    for option in ("--client", "--plugin", "-D", "-T"):
        parser.add_argument(option, required=True)
    options = parser.parse_args()
    folder = os.path.join(options.T, "Client")
    client = Client([options.client], options.plugin, folder)
    results = os.path.join(folder, RESULTS)
    if os.path.exists(results):
        os.remove(results)
    steps(client, os.path.abspath(options.D))
    output = client.run(timeout=60)
    checks = sum("check_" in arguments for _, _, arguments in client.steps)
    found = json.load(open(results)) if os.path.exists(results) else []
    failures = [failure for failures in found for failure in failures]
    if failures or len(found) != checks:
        sys.exit("%s\n%d of %d checks were made\n%s" % (output, len(found), checks, "\n".join(failures)))


if __name__ == "__main__":
    main()
