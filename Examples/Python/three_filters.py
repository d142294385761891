#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The chain of the three filters in its shortest form: points of a .vtp file in, a surface out.

three_filters.py POINTS.vtp SURFACE.vtp [LONGEST_EDGE]

Gaps in the data wider than LONGEST_EDGE become holes, and are filled. vtkelevationsurface.reconstruct()
does the same with more formats, options, a report and a picture.
"""

import sys

from vtkelevationsurface import (
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter


def main(points, surface, longest_edge=0.0):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(points)

    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputConnection(reader.GetOutputPort())
    delaunay.SetMaximumEdgeLength(float(longest_edge))

    trim = vtkTrimOutwardTriangles()
    trim.SetInputConnection(delaunay.GetOutputPort())

    fill = vtkFillElevationHoles()
    fill.SetInputConnection(trim.GetOutputPort())
    fill.MatchDensityOn()
    fill.Update()
    print(f"{trim.GetNumberOfOutwardTriangles()} outward triangles removed")
    print(f"{fill.GetNumberOfFilledHoles()} of {fill.GetNumberOfHoles()} holes filled")

    writer = vtkXMLPolyDataWriter()
    writer.SetInputConnection(fill.GetOutputPort())
    writer.SetFileName(surface)
    return 0 if writer.Write() else 1


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
