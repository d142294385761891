# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A client and a server of two ranks: points on both ranks give the surface, and an error on any is seen
at the client, once. The points of a file give it with a report. The script starts the server itself, by
the command after "--server", to which it adds a port.
"""
import os
import signal
import socket
import subprocess
import sys
import threading

split = sys.argv.index("--server")
SERVER = sys.argv[split + 1:]
sys.argv = sys.argv[:split]

import numpy  # noqa: E402
from paraview import simple  # noqa: E402
from vtkmodules.vtkCommonCore import vtkOutputWindow  # noqa: E402
from plugin_testing import FAILURES, array, check, check_equal, fetch, information, points, start  # noqa: E402

ATTEMPTS = 3
# pvpython has made itself a rank, which mpirun must not see.
ENVIRONMENT = {name: value for name, value in os.environ.items()
               if not name.startswith(("OMPI_", "PMIX_", "OPAL_", "ORTE_", "PMI_"))}


def launch(port):
    """Starts the server. Returns it when it waits for a client, or None."""
    server = subprocess.Popen(SERVER + ["--server-port=%d" % port], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, start_new_session=True,
                              env=ENVIRONMENT)
    said = []
    for line in server.stdout:
        said.append(line)
        if "Accepting connection" in line:
            # What it says later is read, so that it never waits for a full pipe.
            threading.Thread(target=lambda: said.extend(server.stdout), daemon=True).start()
            return server
    stop(server)
    print("no server on port %d: %s" % (port, "".join(said)))
    return None


def stop(server):
    if server.poll() is None:
        os.killpg(server.pid, signal.SIGTERM)
    try:
        server.wait(60)
    except subprocess.TimeoutExpired:
        os.killpg(server.pid, signal.SIGKILL)
        server.wait()


def free_port():
    with socket.socket() as free:
        free.bind(("localhost", 0))
        return free.getsockname()[1]


def cells(source, port=0):
    source.UpdatePipeline()
    return source.GetDataInformation(port).GetNumberOfCells()


def errors_at_client(source):
    """The errors that the client's output window gets in an update; the source is to stay empty."""
    found = []

    def note(_caller, _event, text):
        found.append(text)

    note.CallDataType = "string0"
    tag = vtkOutputWindow.GetInstance().AddObserver("ErrorEvent", note)
    check_equal(cells(source), 0, "cells of points on two ranks")
    vtkOutputWindow.GetInstance().RemoveObserver(tag)
    return found


server = None
for _ in range(ATTEMPTS):
    port = free_port()
    server = launch(port)
    if server:
        break
check(server, "a server of two ranks starts")
if server:
    try:
        simple.Connect("localhost", port)
        data, _ = start(remote=True)
        sphere = simple.Sphere(ThetaResolution=60, PhiResolution=40)  # of which each rank makes a part
        check(cells(sphere) > 4000, "the server makes a sphere")
        errors = errors_at_client(simple.TrimOutwardTriangles(Input=sphere))
        check(len(errors) == 1 and "is flat in x,y" in errors[0], "the message to the client: %s" % errors)
        together = simple.AggregateDataset(Input=sphere)
        together.NumberOfTargetProcesses = 1
        surface = simple.GridDelaunay2D(Input=sphere)
        check(cells(surface) > 1000, "triangles of points on two ranks")
        check_equal(cells(surface), cells(simple.GridDelaunay2D(Input=together)), "triangles on two ranks and on one")
        filled = simple.FillElevationHoles(Input=simple.TrimOutwardTriangles(Input=surface))
        check(cells(filled) > 1000, "triangles after the chain of filters")
        gathered = simple.AggregateDataset(Input=filled)
        gathered.NumberOfTargetProcesses = 1
        grids = [simple.ElevationGrid(Input=data, Dimensions=[40, 30]) for data in (filled, gathered)]
        contours = [fetch(simple.Contour(Input=grid, ContourBy=["POINTS", "Elevation"], Isosurfaces=[0.4]))
                    for grid in grids]  # of an image on several ranks the client gets the first part alone
        for grid in grids:
            check_equal(grid.GetDataInformation().GetExtent(), (0, 39, 0, 29, 0, 0), "the grid of a surface on two ranks")
        places = [points(lines)[numpy.isfinite(points(lines)).all(axis=1)] for lines in contours]  # not at hidden nodes
        mine, expected = (numpy.unique(some.round(6), axis=0) for some in places)
        check(len(expected) > 50 and numpy.array_equal(mine, expected), "contour lines of the grid")
        mine, expected = (fetch(simple.ElevationProfile(Input=data)) for data in (filled, gathered))
        check_equal(mine.GetNumberOfPoints(), 1001, "points of a profile of a surface on two ranks")
        mine, expected = (array(data.GetPointData(), "Elevation") for data in (mine, expected))
        check(numpy.isfinite(expected).sum() > 500, "the profile meets the surface")
        check(numpy.allclose(mine, expected, rtol=0, atol=1e-12, equal_nan=True), "elevations of the profile")
        olinda = simple.ElevationPoints(FileName=os.path.join(data, "olinda_land.xyz"))
        check_equal(cells(olinda), 10266, "points of a file that the server reads")
        for make in (simple.ElevationGrid, simple.ElevationProfile):
            errors = errors_at_client(make(Input=olinda))
            check(len(errors) == 1 and "has no triangles" in errors[0], "points alone are an error: %s" % errors)
        whole = simple.ReconstructElevationSurface(Input=olinda)
        check(cells(whole) > 20000, "triangles of the whole chain")
        check("10,266 read" in information(whole, "Report"), "the report is in the client's panel")
        check(fetch(whole, 3).GetNumberOfRows() > 8, "the rows of the report come to the client")
        wrong = simple.ElevationPoints(FileName="/no/such/file.csv")
        errors = errors_at_client(wrong)
        check(len(errors) == 1 and "no such file" in errors[0], "the client gets the error on a wrong file: %s" % errors)
        simple.Disconnect()
    finally:
        stop(server)

print("%d checks failed" % len(FAILURES))
sys.stdout.flush()
os._exit(1 if FAILURES else 0)  # the client would wait for the server that is gone
