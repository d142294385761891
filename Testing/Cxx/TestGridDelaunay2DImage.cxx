// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A picture of vtkGridDelaunay2D: a lattice with a round void, in the left half every node, in the
// right half every other; with a limit on the edge length that leaves the void open. On the lattice
// all squares are cut the same way, from their lowest corner.
#include "PictureFromAbove.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <cstdlib>

int TestGridDelaunay2DImage(int argc, char* argv[])
{
  vtkNew<vtkPoints> points;
  for (int y = 0; y <= 16; ++y)
  {
    for (int x = 0; x <= 16; ++x)
    {
      const bool isCoarse = x > 8 && (x % 2 || y % 2);
      const bool isVoid = (x - 5) * (x - 5) + (y - 8) * (y - 8) < 9;
      if (!isCoarse && !isVoid)
      {
        points->InsertNextPoint(x, y, 0.0);
      }
    }
  }
  vtkNew<vtkPolyData> input;
  input->SetPoints(points);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(input);
  delaunay->SetMaximumEdgeLength(3.0);

  auto surface = MakeSurface(delaunay->GetOutputPort(), Yellow);
  surface->GetProperty()->SetLineWidth(2.0);
  return MatchesBaseline(argc, argv, { surface }, { 8.0, 9.0, 300, DarkBlue }) ? EXIT_SUCCESS
                                                                               : EXIT_FAILURE;
}
