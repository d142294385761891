# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The filters in a pipeline: trimmed to a coast line with islands and triangulated with breaklines, which come
as second inputs; what cannot be used gives one error that names it, and empty output."""
import os

from paraview import simple

from plugin_testing import (check, check_close, check_equal, check_rules, fetch, finish, information,
                            lines, messages_of, points, ring_area, signed_areas, start)

data_folder, _ = start()

# A table of soundings.
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

# A horizon with two breaklines across it, which cross each other.
horizon = simple.XMLPolyDataReader(FileName=[os.path.join(data_folder, "horizon_synthetic.vtp")])
one = simple.Line(Point1=[463500, 6218000, -2100], Point2=[465200, 6219900, -2100], Resolution=1)
two = simple.Line(Point1=[465200, 6218000, -2000], Point2=[463600, 6219800, -2000], Resolution=1)
breaklines = simple.ExtractSurface(Input=simple.AppendDatasets(Input=[one, two]))

# Along a lattice's rounded border the triangles of the coordinates and of the nodes differ.
delaunay = simple.GridDelaunay2D(Input=horizon, LatticeMode="Off")
plain = fetch(delaunay)
check_equal(information(delaunay, "NumberOfAddedPoints"), 0, "points added without constraints")

delaunay.Constraints = breaklines
output = fetch(delaunay)
added = output.GetNumberOfPoints() - plain.GetNumberOfPoints()
check(added >= 5, "the ends of both lines and their crossing are added")
check_equal(information(delaunay, "NumberOfAddedPoints"), added, "points added")
check_equal(information(delaunay, "NumberOfConstraintCrossings"), 1, "crossings")
delaunay.LatticeMode = "Automatic"
delaunay.UpdatePipeline()
check_equal(information(delaunay, "LatticeFound"), 0, "no lattice with constraints")
check_close(signed_areas(output).sum(), signed_areas(plain).sum(), "area")

delaunay.Constraints = None
check_equal(fetch(delaunay).GetNumberOfPoints(), plain.GetNumberOfPoints(), "points without it again")

# The cells of a plane are quadrilaterals.
quadrilaterals = simple.Plane(XResolution=3, YResolution=3)
for filter_type, outputs in ((simple.TrimOutwardTriangles, 3), (simple.FillElevationHoles, 2)):
    name = filter_type.__name__
    source = filter_type(Input=quadrilaterals)
    errors = messages_of(source)
    check_equal(len(errors), 1, name + ": number of errors for cells that are not triangles")
    check(errors and "cell 0" in errors[0].lower(),
          "%s: the error does not name the cell: %s" % (name, errors))
    for port in range(outputs):
        check_equal(fetch(source, port).GetNumberOfPoints(), 0, "%s: points of output %d" % (name, port))

# An open line is not a boundary, even if it runs along edges of the surface.
surface = simple.GridDelaunay2D(Input=quadrilaterals)
line = simple.Line(Point1=[-0.5, -0.5, 0], Point2=[0.5, -0.5, 0], Resolution=3)
trimmed = simple.TrimOutwardTriangles(Input=surface, Boundary=line)
errors = messages_of(trimmed)
check_equal(len(errors), 1, "number of errors for a boundary that is not closed")
check(errors and "closed" in errors[0].lower(), "the error does not say why: %s" % errors)
check_equal(fetch(trimmed).GetNumberOfPoints(), 0, "points after an error")

# Taking the cause away is enough to go on.
trimmed.Boundary = None
check_equal(messages_of(trimmed), [], "errors without the line")
check_equal(fetch(trimmed).GetNumberOfPoints(), 16, "points without the line")

finish()
