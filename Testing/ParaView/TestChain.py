# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Grid Delaunay, trim and fill on LiDAR ground points between buildings, checked by numbers."""
import os

import numpy
from paraview import simple

from plugin_testing import (array, check, check_close, check_equal, check_rules, fetch, finish,
                            information, lines, border_edge_count, points, screenshot,
                            signed_areas, start, triangles)


def sorted_triangles(surface):
    return numpy.unique(numpy.sort(triangles(surface), axis=1), axis=0)


data_folder, temporary_folder = start()
reader = simple.XMLPolyDataReader(FileName=[os.path.join(data_folder, "b9_ground.vtp")])
cloud = fetch(reader)
count = cloud.GetNumberOfPoints()
check_equal(count, 13299, "points of the file")

# ---- grid Delaunay: all of the hull ------------------------------------------------------------
delaunay = simple.GridDelaunay2D(Input=reader)
full = fetch(delaunay)
check_equal(full.GetNumberOfPoints(), count, "points of the triangulation")
check(numpy.array_equal(points(full), points(cloud)), "the points are the points of the input")
check_rules("the triangulation of all points is Delaunay and covers their hull", full, delaunay=True,
            convex_hull=True, all_points=True)
check_equal(information(delaunay, "NumberOfDuplicatePoints"), 0, "duplicate points")
check_equal(information(delaunay, "NumberOfNonFinitePoints"), 0, "points that are not finite")
check_equal(full.GetFieldData().GetArray("UnusedPointIds").GetNumberOfTuples(), 0, "unused points")

# ---- grid Delaunay: gaps stay open -------------------------------------------------------------
delaunay.MaximumEdgeLength = 2
meshed = fetch(delaunay)
corners = points(meshed)[triangles(meshed)][:, :, :2].astype(float)
edges = corners - numpy.roll(corners, 1, axis=1)
check(numpy.hypot(edges[..., 0], edges[..., 1]).max() <= 2, "no edge is longer than the limit")
of_full = {tuple(t) for t in sorted_triangles(full)}
check({tuple(t) for t in sorted_triangles(meshed)} <= of_full, "a limit makes no new triangle")

# ---- trim --------------------------------------------------------------------------------------
trim = simple.TrimOutwardTriangles(Input=delaunay)
kept, outward, boundary = (fetch(trim, port) for port in range(3))
check(0 < kept.GetNumberOfPolys() <= meshed.GetNumberOfPolys(), "some triangles are kept")
both = numpy.vstack([sorted_triangles(kept), sorted_triangles(outward)])
check(numpy.array_equal(numpy.unique(both, axis=0), sorted_triangles(meshed))
      and len(both) == meshed.GetNumberOfPolys(), "kept and outward triangles are those of the input")
check_equal(information(trim, "NumberOfOutwardTriangles"), outward.GetNumberOfPolys(),
            "number of outward triangles")
check_equal(information(trim, "NumberOfRecoveredEdges"), 0, "recovered edges")
kept_points = numpy.unique(sorted_triangles(kept))
check_equal(information(trim, "NumberOfPointsLeftOut"),
            len(numpy.setdiff1d(sorted_triangles(outward), kept_points)), "points left out")
check(information(trim, "EffectiveGapTolerance") > 0, "the gap tolerance used can be read")
check(boundary.GetNumberOfLines() > 0, "there is a boundary")
check(all(ring[0] == ring[-1] for ring in lines(boundary)), "the boundary is closed")

# ---- fill --------------------------------------------------------------------------------------
fill = simple.FillElevationHoles(Input=trim)
filled, holes = (fetch(fill, port) for port in range(2))
old_points, old_triangles = kept.GetNumberOfPoints(), kept.GetNumberOfPolys()
check(numpy.array_equal(points(filled)[:old_points], points(kept)), "the input's points come first")
check(numpy.array_equal(triangles(filled)[:old_triangles], triangles(kept)),
      "the input's triangles come first")
is_new = array(filled.GetPointData(), "FilledPoint")
check_equal(set(numpy.flatnonzero(is_new)), set(range(old_points, filled.GetNumberOfPoints())),
            "FilledPoint marks the new points")
error = array(filled.GetPointData(), "FilledError")
check((error[is_new == 0] == 0).all(), "points of the input have no error")
check(numpy.isnan(error[is_new == 1]).any() or (error[is_new == 1] > 0).all(),
      "new points have an error, or none that can be given")
check((error[is_new == 1] > 0).mean() > 0.9, "most errors of new points can be given")
hole_id = array(filled.GetCellData(), "HoleId")
check((hole_id[:old_triangles] == -1).all() and (hole_id[old_triangles:] >= 0).all(),
      "HoleId marks the new triangles")

hole_count = information(fill, "NumberOfHoles")
check(hole_count > 0, "the buildings are holes")
check_equal(holes.GetNumberOfLines(), hole_count, "outlines of holes")
status = array(holes.GetCellData(), "Status")
check_equal((status == 0).sum(), hole_count, "holes with the status filled")
check_equal(information(fill, "NumberOfFilledHoles"), hole_count, "filled holes")
check_equal(array(holes.GetCellData(), "NumberOfInsertedPoints").sum(), is_new.sum(),
            "inserted points of all holes")
check_close(signed_areas(filled).sum(),
            signed_areas(kept).sum() + array(holes.GetCellData(), "Area").sum(),
            "area of the surface, with its holes")
check_rules("the filled surface covers nothing twice", filled)
check_equal(border_edge_count(kept) - border_edge_count(filled),
            array(holes.GetCellData(), "NumberOfEdges").sum(), "rim edges that were closed")


def beyond(surface):
    """How far new points lie above or below all old ones, in parts of the old ones' range."""
    z = points(surface)[:, 2]
    old, new = z[is_new == 0], z[is_new == 1]
    return max(old.min() - new.min(), new.max() - old.max(), 0.0) / (old.max() - old.min())


# The largest building is as wide as the ground around it: slopes at its walls go on below it.
check(beyond(filled) < 0.5, "new points lie near the elevations of the old ones")
fill.Interpolation = "Membrane"
check_equal(beyond(fetch(fill, 0)), 0.0, "new points of a membrane beyond the old ones")
fill.Interpolation = "Adaptive"

# A limit leaves the large holes open, and says so.
fill.MaximumHoleSize = 10
limited = fetch(fill, 1)
status = array(limited.GetCellData(), "Status")
check_equal(limited.GetNumberOfLines(), hole_count, "outlines of holes with a limit")
check(0 < (status == 1).sum() < hole_count, "some holes are too large")
check_equal(information(fill, "NumberOfFilledHoles"), (status == 0).sum(), "filled holes with a limit")
fill.MaximumHoleSize = 0

# ---- a picture ---------------------------------------------------------------------------------
view = simple.CreateRenderView(ViewSize=[900, 900], Background=[1, 1, 1],
                               UseColorPaletteForBackground=0, OrientationAxesVisibility=0)
shown = simple.Show(fill, view)
simple.ColorBy(shown, ("CELLS", "HoleId"))
shown.LookupTable = simple.CreateLookupTable(
    RGBPoints=[-1, 0.62, 0.74, 0.62, -0.5, 0.62, 0.74, 0.62, 0, 0.85, 0.45, 0.2,
               hole_count, 0.95, 0.75, 0.3], ColorSpace="RGB")
shown.SetRepresentationType("Surface With Edges")
shown.EdgeColor = [0.25, 0.3, 0.25]
shown.LineWidth = 0.5
shown.Ambient, shown.Diffuse = 1, 0
outline = simple.Show(simple.OutputPort(fill, 1), view)
outline.ColorArrayName = [None, ""]
outline.AmbientColor = outline.DiffuseColor = [0.6, 0, 0]
outline.LineWidth = 2
view.CameraParallelProjection = 1
simple.ResetCamera(view)  # from +z
simple.GetActiveCamera().Zoom(1.2)
pixels = screenshot(os.path.join(temporary_folder, "ParaViewChain.png"), view).astype(int)
background = (pixels.min(axis=2) > 250).mean()
orange = (pixels[..., 0] - pixels[..., 2] > 80).mean()
check(0.05 < background < 0.8, "surface and background are seen (%.2f)" % background)
check(0.02 < orange < 0.6, "filled holes are seen in their colour (%.2f)" % orange)

finish()
