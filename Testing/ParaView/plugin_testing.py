# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the pvpython tests share: the command line, the plugin, plain arrays, and checks.

A failed check is printed and counted; finish() makes the exit code non-zero if there was one.
"""
import argparse
import math
import os
import sys

from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader
import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "Python"))
from mesh_rules import findings, border_edge_count  # noqa: E402,F401
from outcomes import noted  # noqa: E402

FAILURES = []
KEPT = []  # the data of sources


def start(place=lambda plugin, folder: plugin, remote=False):
    """Reads the command line and loads the plugin.

    place   makes the file to load of the built plugin and the folder for what the test writes
    remote  whether the server loads it, to which the script has connected
    Returns the folder of the data and the folder for what the test writes.
    """
    parser = argparse.ArgumentParser()
    parser.add_argument("--plugin", required=True, help="the built plugin")
    parser.add_argument("-D", dest="data", required=True, help="the folder Data of the repository")
    parser.add_argument("-T", dest="temporary", required=True, help="folder for what the test writes")
    options = parser.parse_args()
    simple._DisableFirstRenderCameraReset()
    os.makedirs(options.temporary, exist_ok=True)
    simple.LoadPlugin(place(options.plugin, options.temporary), remote=remote)
    return os.path.abspath(options.data), options.temporary


def check(condition, claim):
    """Notes a claim that does not hold."""
    if not condition:
        FAILURES.append(claim)
        print("FAILED:", claim)


def check_equal(value, expected, claim):
    check(value == expected, "%s: %r instead of %r" % (claim, value, expected))


def check_close(value, expected, claim, relative=1e-9):
    check(
        math.isclose(value, expected, rel_tol=relative),
        "%s: %.17g instead of %.17g" % (claim, value, expected),
    )


def check_rules(claim, *parts, **rules):
    """Checks the rules of mesh_rules.findings(), and prints those that are broken."""
    broken = findings(*parts, **rules)
    check(not broken, "%s: %s" % (claim, "; ".join(broken[:5])))


def finish():
    """The last call of a script: sets the exit code to 1 if a check failed."""
    print("%d checks failed" % len(FAILURES))
    if FAILURES:
        # sys.exit() would end pvpython 5.11 with views still open, which crashes.
        sys.stdout.flush()
        os._exit(1)


def fetch(source, port=0):
    """The vtkPolyData of an output, updated."""
    source.UpdatePipeline()
    return servermanager.Fetch(source, idx=port)


def messages_of(source, event="ErrorEvent"):
    """Updates a source and returns the errors that it reported, or another event's messages."""
    return [text for kind, text in update(source)[0] if kind == event]


def data_source(data):
    """A source of the pipeline with these data."""
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    KEPT.append(data)
    return source


def update(source):
    """Updates. Returns the messages and outputs of this process."""
    algorithm = source.SMProxy.GetClientSideObject()
    messages = noted(algorithm)
    source.UpdatePipeline()
    return messages, [algorithm.GetOutputDataObject(i) for i in range(algorithm.GetNumberOfOutputPorts())]


def alone(source):
    """Updates on this rank, which asks no other: a piece of 1. Returns the outputs."""
    algorithm = source.SMProxy.GetClientSideObject()
    algorithm.UpdatePiece(0, 1, 0)
    outputs = []
    for i in range(algorithm.GetNumberOfOutputPorts()):
        data = algorithm.GetOutputDataObject(i)
        outputs.append(data.NewInstance())
        outputs[-1].DeepCopy(data)
    return outputs


def information(source, name):
    """The value of a property that holds a result, after the last update."""
    source.SMProxy.UpdatePropertyInformation()
    return source.GetPropertyValue(name)


def points(surface):
    """Coordinates, n x 3."""
    return vtk_to_numpy(surface.GetPoints().GetData()).reshape(-1, 3)


def triangles(surface):
    """Point ids, n x 3. Every polygon has to be a triangle."""
    ids = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    count = surface.GetNumberOfPolys()
    assert len(ids) == 3 * count, "not all polygons are triangles"
    return ids.reshape(count, 3)


def lines(surface):
    """One array of point ids for each line."""
    ids = vtk_to_numpy(surface.GetLines().GetConnectivityArray())
    offsets = vtk_to_numpy(surface.GetLines().GetOffsetsArray())
    return [ids[begin:end] for begin, end in zip(offsets[:-1], offsets[1:])]


def array(attributes, name):
    """A data array of the point, cell or field data by name, as numpy array."""
    found = attributes.GetArray(name)
    assert found is not None, "no array " + name
    return vtk_to_numpy(found)


def signed_areas(surface):
    """Area of each triangle in x,y, positive when counter-clockwise."""
    x, y = points(surface)[:, :2].astype(float).T
    a, b, c = triangles(surface).T
    return 0.5 * ((x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a]))


def ring_area(coordinates):
    """Area in x,y of a closed line (the last point is the first), positive when counter-clockwise."""
    x, y = (coordinates[:, :2] - coordinates[0, :2]).astype(float).T
    return 0.5 * float(numpy.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def check_elevation_colours(pixels, claim):
    """Checks that high and low places are seen in the colours of first_view.py, of pixels of screenshot()."""
    red, green, blue = numpy.moveaxis(pixels.astype(int), -1, 0)
    high, low = (red - blue > 40).mean(), (green - red > 25).mean()
    check(high > 0.01 and low > 0.05, "%s: high and low places are seen (%.3f, %.3f)" % (claim, high, low))


def screenshot(path, view):
    """Saves a picture and returns its pixels, height x width x 3."""
    simple.SaveScreenshot(path, view)
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    width, height = image.GetDimensions()[:2]
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[..., :3]
