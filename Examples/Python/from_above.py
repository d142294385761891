#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the boundary or the filled holes of a cloud of points, as a map.

from_above.py outline CLOUD PICTURE.png [options]   the boundary that is found, and points outside it
from_above.py voids CLOUD PICTURE.png [options]     the surface before and after its holes are filled

  --maximum-edge-length L   gaps wider than this become holes; default 0: no limit
  --interpolation METHOD    neighbor-mean, membrane, thin-plate, cubic-spline; default adaptive
  --window X0,X1,Y0,Y1      draw this part alone; default: all
  --title TEXT              default: the file's name

CLOUD is any file that reconstruct reads, or .f64: little-endian doubles x, y, z of one point after
another. Land is shaded as if lit from the north-west; what has no surface is white.
Needs the module on PYTHONPATH, and a display or Xvfb.
"""

import os
import sys

import numpy
from vtkelevationsurface import (
    picture as look,
    read,
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)
from vtkelevationsurface.clouds import id_lists
from vtkelevationsurface.picture import signs
from vtkelevationsurface.reconstruction import as_cloud
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkRenderingCore import vtkLight, vtkRenderer

HEAD, FOOT, EDGE, GAP = 76, 70, 24, 24
MOST_WIDTH, MOST_HEIGHT = 1560, 1040
METHODS = ("neighbor-mean", "membrane", "thin-plate", "adaptive", "cubic-spline")
DEFAULTS = {"--maximum-edge-length": "0", "--interpolation": "adaptive", "--window": "", "--title": ""}
LEFT_OUT = (0.90, 0.10, 0.05)
RIM = (0.72, 0.07, 0.30)


class Chain:
    """The three filters on a cloud, run; with what a picture needs to know of all its panels."""

    def __init__(self, cloud, longest_edge, interpolation, region):
        self.delaunay = vtkGridDelaunay2D()
        self.delaunay.SetInputData(cloud)
        self.delaunay.SetMaximumEdgeLength(longest_edge)
        self.trim = vtkTrimOutwardTriangles()
        self.trim.SetInputConnection(self.delaunay.GetOutputPort())
        self.fill = vtkFillElevationHoles()
        self.fill.SetInputConnection(self.trim.GetOutputPort())
        self.fill.SetInterpolation(METHODS.index(interpolation))
        self.fill.Update()

        points = vtk_to_numpy(cloud.GetPoints().GetData()).astype("f8")
        if not region:
            low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
            margin = 0.02 * (high - low).max()
            low, high = low - margin, high + margin
        else:
            low, high = numpy.array(region[0::2]), numpy.array(region[1::2])
        self.middle, self.size = 0.5 * (low + high), high - low
        seen = ((points[:, :2] > low) & (points[:, :2] < high)).all(axis=1)
        if not seen.any():
            sys.exit("the window holds no point")
        self.points = points[seen]
        bottom, top, _ = look.common_range(self.points[:, 2])
        self.colours = look.colour_map(bottom, top)
        self.exaggeration = 1.0
        corners = vtk_to_numpy(self.trim.GetOutput().GetPolys().GetConnectivityArray())
        self.frame = look.Frame(
            self.middle, bottom, 1.0, (-numpy.inf, numpy.inf), numpy.array([1.0, 0.0]), 1.0)
        inside = seen[corners.reshape(-1, 3)].all(axis=1) if len(corners) else []
        if numpy.any(inside):
            self.exaggeration = 2.0 * look.choose_exaggeration(
                self.frame(points), corners.reshape(-1, 3)[inside])
        self.frame.scale[2] = self.exaggeration


def surface_actor(chain, surface):
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype("f8")
    normals = vtkPolyDataNormals()
    normals.SetInputData(signs.poly_data(chain.frame(points), polys=surface.GetPolys()))
    normals.SplittingOff()
    normals.ConsistencyOff()
    normals.Update()
    shaded = normals.GetOutput()
    shaded.GetPointData().SetScalars(numpy_to_vtk(numpy.ascontiguousarray(points[:, 2]), deep=True))
    actor = look.actor_of(shaded)
    actor.GetMapper().SetLookupTable(chain.colours)
    actor.GetMapper().SetScalarRange(*chain.colours.GetRange())
    actor.GetMapper().InterpolateScalarsBeforeMappingOn()
    actor.GetProperty().SetInterpolationToPhong()
    actor.GetProperty().SetAmbient(0.25)
    return actor


def above(chain, data):
    """The points of lines, lifted over the surface."""
    points = chain.frame.points_in(data)
    points[:, 2] = 2.0 * chain.exaggeration * max(1e-300, numpy.ptp(chain.points[:, 2]))
    return points


def rims_actor(chain, lines, rgb, width):
    pairs = look.segments(id_lists(lines.GetLines()))
    return look.lines_actor(above(chain, lines), pairs, rgb, width) if len(pairs) else None


def dots_actor(chain, places):
    """Small crosses, of the same size in every picture."""
    arm = 0.004 * chain.size.max()
    points = chain.frame(places)
    points[:, 2] = 2.0 * chain.exaggeration * max(1e-300, numpy.ptp(chain.points[:, 2]))
    ends = [points + numpy.array(step) * arm for step in ((1, 1, 0), (-1, -1, 0), (1, -1, 0), (-1, 1, 0))]
    count = len(points)
    ids = numpy.arange(count)
    pairs = numpy.concatenate([
        numpy.column_stack([ids, ids + count]), numpy.column_stack([ids + 2 * count, ids + 3 * count])])
    return look.lines_actor(numpy.concatenate(ends), pairs, LEFT_OUT, 2.0)


def panel(window, viewport, chain, actors):
    renderer = vtkRenderer()
    renderer.SetViewport(*viewport)
    renderer.SetBackground(1.0, 1.0, 1.0)
    for actor in actors:
        if actor is not None:
            renderer.AddActor(actor)
    renderer.RemoveAllLights()
    renderer.AutomaticLightCreationOff()
    for place, strength in (((-1.0, 1.0, 1.1), 0.78), ((1.0, 0.4, 1.4), 0.18)):
        light = vtkLight()
        light.SetLightTypeToSceneLight()
        light.SetPositional(False)
        light.SetFocalPoint(0.0, 0.0, 0.0)
        light.SetPosition(*place)
        light.SetIntensity(strength)
        renderer.AddLight(light)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(0.0, 0.0, 0.0)
    camera.SetPosition(0.0, 0.0, 1.0)
    camera.SetViewUp(0.0, 1.0, 0.0)
    camera.SetParallelScale(0.5 * chain.size[1])
    window.AddRenderer(renderer)
    depth = 4.0 * chain.exaggeration * max(1e-300, numpy.ptp(chain.points[:, 2])) + chain.size.max()
    camera.SetClippingRange(1.0 - depth, 1.0 + depth)


def draw(path, chain, title, panels, legend):
    """panels: lists of (words, actors), drawn side by side."""
    count = len(panels)
    room = (MOST_WIDTH - 2 * EDGE - (count - 1) * GAP) / count
    pixels = min(room / chain.size[0], MOST_HEIGHT / chain.size[1])
    wide, tall = (int(numpy.ceil(pixels * s)) for s in chain.size)
    window = look.open_window()
    width = max(2 * EDGE + count * wide + (count - 1) * GAP, 900)
    height = tall + HEAD + FOOT
    window.SetSize(width, height)
    frame = vtkRenderer()
    frame.SetBackground(1.0, 1.0, 1.0)
    window.AddRenderer(frame)
    signs.add_text(frame, title, EDGE, height - 40, 26, bold=True)
    for i, (words, actors) in enumerate(panels):
        left = EDGE + i * (wide + GAP)
        panel(window, (left / width, FOOT / height, (left + wide) / width, (FOOT + tall) / height),
              chain, actors)
        signs.add_text(frame, words, left, height - 68, 20, rgb=(0.35, 0.37, 0.40))
        signs.add_strokes(frame, [[
            (left - 1, FOOT - 1), (left + wide, FOOT - 1), (left + wide, FOOT + tall),
            (left - 1, FOOT + tall), (left - 1, FOOT - 1)]], (0.7, 0.7, 0.7), 1.0)
    x = EDGE
    for name, rgb in legend:
        signs.add_strokes(frame, [[(x, 34), (x + 36, 34)]], rgb, 4.0)
        label = signs.add_text(frame, name, x + 46, 27, 19)
        box = [0.0] * 4
        label.GetBoundingBox(frame, box)
        x += 46 + box[1] - box[0] + 36
    length = signs.nice_number(0.14 * width / pixels, (1.0, 2.0, 5.0))
    right = EDGE + count * wide + (count - 1) * GAP
    bar = [(right - length * pixels, 42), (right - length * pixels, 30), (right, 30), (right, 42)]
    signs.add_strokes(frame, [bar])
    signs.add_text(frame, signs.round_text(length), right - 0.5 * length * pixels, 40, 19, "centre")

    look.save(window, path)


def outline(chain, path, title):
    """One panel: what was kept, the boundary, and the points that no kept triangle has."""
    trimmed = chain.trim.GetOutput()
    used = numpy.zeros(trimmed.GetNumberOfPoints(), dtype=bool)
    used[vtk_to_numpy(trimmed.GetPolys().GetConnectivityArray())] = True
    lone = vtk_to_numpy(trimmed.GetPoints().GetData())[~used].astype("f8")
    boundary = chain.trim.GetOutput(2)
    rings = boundary.GetNumberOfLines()
    words = (f"{rings} ring{'s' if rings != 1 else ''} at a gap tolerance of "
             f"{chain.trim.GetEffectiveGapTolerance():.1f} spacings, {len(lone)} points outside")
    print(words)
    actors = [surface_actor(chain, trimmed), rims_actor(chain, boundary, signs.INK, 2.0)]
    legend = [("boundary", signs.INK)]
    if len(lone):
        actors.append(dots_actor(chain, lone))
        legend.append(("points outside", LEFT_OUT))
    draw(path, chain, title, [(words, actors)], legend)


def voids(chain, path, title):
    """Two panels: before and after."""
    holes = chain.fill.GetOutput(1)
    words = f"after: {chain.fill.GetNumberOfFilledHoles()} of {chain.fill.GetNumberOfHoles()} holes filled"
    print(words)
    draw(path, chain, title, [
        ("before", [surface_actor(chain, chain.trim.GetOutput())]),
        (words, [surface_actor(chain, chain.fill.GetOutput()), rims_actor(chain, holes, RIM, 1.6)])],
        [("rims of holes", RIM)])


def main(what, cloud, path, *options):
    values = dict(DEFAULTS, **dict(zip(options[0::2], options[1::2])))
    region = values["--window"] and [float(x) for x in values["--window"].split(",")]
    if cloud.lower().endswith(".f64"):
        points = as_cloud(numpy.fromfile(cloud, "<f8").reshape(-1, 3)).points
    else:
        points = read(cloud).points
    chain = Chain(points, float(values["--maximum-edge-length"]), values["--interpolation"], region)
    draw_it = outline if what == "outline" else voids
    with look.screen_for(path):
        draw_it(chain, path, values["--title"] or os.path.basename(cloud))


if __name__ == "__main__":
    if (len(sys.argv) < 4 or len(sys.argv) % 2 or sys.argv[1] not in ("outline", "voids")
            or not set(sys.argv[4::2]) <= set(DEFAULTS)):
        sys.exit(__doc__)
    main(*sys.argv[1:])
