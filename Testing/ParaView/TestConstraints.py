# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A horizon with two breaklines across it, which come as a second input and cross each other."""
import os

from paraview import simple

from plugin_testing import check, check_close, check_equal, fetch, finish, information, signed_areas, start

data_folder, _ = start()
horizon = simple.XMLPolyDataReader(FileName=[os.path.join(data_folder, "horizon_synthetic.vtp")])
one = simple.Line(Point1=[463500, 6218000, -2100], Point2=[465200, 6219900, -2100], Resolution=1)
two = simple.Line(Point1=[465200, 6218000, -2000], Point2=[463600, 6219800, -2000], Resolution=1)
lines = simple.AppendDatasets(Input=[one, two])
lines = simple.ExtractSurface(Input=lines)

# Along a lattice's rounded border the triangles of the coordinates and of the nodes differ.
delaunay = simple.GridDelaunay2D(Input=horizon, LatticeMode="Off")
plain = fetch(delaunay)
check_equal(information(delaunay, "NumberOfAddedPoints"), 0, "points added without constraints")

delaunay.Constraints = lines
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

finish()
