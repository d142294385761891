// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause

// A program of another project: the chain of the three filters on a small grid with a hole.

#include <vtkFillElevationHoles.h>
#include <vtkGridDelaunay2D.h>
#include <vtkTrimOutwardTriangles.h>

#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <iostream>

int main()
{
  constexpr int side = 20;
  vtkNew<vtkPoints> points;
  for (int y = 0; y < side; ++y)
  {
    for (int x = 0; x < side; ++x)
    {
      const bool inHole = x > 7 && x < 12 && y > 7 && y < 12;
      if (!inHole)
      {
        points->InsertNextPoint(x, y, 0.1 * x);
      }
    }
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);

  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  delaunay->SetMaximumEdgeLength(2.0);
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputConnection(delaunay->GetOutputPort());
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputConnection(trim->GetOutputPort());
  fill->Update();

  const vtkIdType holes = fill->GetNumberOfFilledHoles();
  const vtkIdType triangles = fill->GetOutput()->GetNumberOfPolys();
  std::cout << triangles << " triangles, " << holes << " hole filled\n";
  // At least as many triangles as the squares outside the hole give, and the one hole.
  const vtkIdType fewest = 2 * ((side - 1) * (side - 1) - 5 * 5);
  return holes == 1 && triangles > fewest ? 0 : 1;
}
