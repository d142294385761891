# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""In ParaView too, what cannot be used gives one error that names it, and empty output."""
from paraview import simple

from plugin_testing import check, check_equal, fetch, finish, messages_of, start

start()

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
