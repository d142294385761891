# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A table of soundings, trimmed to a coast line with islands that comes as a second input."""
import os

from paraview import simple

from plugin_testing import (check, check_close, check_equal, check_rules, fetch, finish, information,
                            lines, points, ring_area, signed_areas, start)

data_folder, _ = start()
table = simple.CSVReader(FileName=[os.path.join(data_folder, "aegean_sea.csv")])
soundings = simple.TableToPoints(Input=table, XColumn="x", YColumn="y", ZColumn="z")
coast = simple.XMLPolyDataReader(FileName=[os.path.join(data_folder, "aegean_sea_boundary.vtp")])
rings = fetch(coast)
ring_areas = [ring_area(points(rings)[ids]) for ids in lines(rings)]
# The surface lies to the left of each ring: rings around pieces count plus, rings of islands minus.
sea_area = sum(ring_areas)
check(min(ring_areas) < 0 < sea_area, "the coast has islands")

delaunay = simple.GridDelaunay2D(Input=soundings)
trim = simple.TrimOutwardTriangles(Input=delaunay, Boundary=coast)
kept, outward, boundary = (fetch(trim, port) for port in range(3))
check_equal(fetch(delaunay).GetNumberOfPoints(), 4650, "points")
check_close(signed_areas(kept).sum(), sea_area, "area of the surface and of the sea")
check_rules("kept and outward triangles cover the hull", kept, outward, convex_hull=True)
check_equal(information(trim, "NumberOfOutwardTriangles"), outward.GetNumberOfPolys(),
            "number of outward triangles")
check_equal(information(trim, "NumberOfRecoveredEdges"), 0, "recovered edges")
check_equal(boundary.GetNumberOfLines(), len(ring_areas), "rings of the boundary used")

# Without the second input the boundary is found from the points, and the result is another one.
trim.Boundary = None
found = fetch(trim)
check(found.GetNumberOfPolys() > 0, "there is a surface without a given boundary")
check(found.GetNumberOfPolys() != kept.GetNumberOfPolys(), "the boundary makes a difference")

finish()
