// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A cloud with a bay, a lake with an island and a lone point, trimmed along its own outline.
// Kept triangles are yellow, outward ones blue, the boundary is red.
#include "MeshRules.h"
#include "PictureFromAbove.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTrimOutwardTriangles.h"

#include <cstdlib>

int TestTrimOutwardTrianglesExtracted(int argc, char* argv[])
{
  vtkNew<vtkPoints> points;
  for (int y = 0; y <= 32; ++y)
  {
    for (int x = 0; x <= 32; ++x)
    {
      const int lake = (x - 11) * (x - 11) + (y - 17) * (y - 17);
      const bool isLake = lake < 80 && lake > 6;
      const bool isBay = x > 22 && y > 10 && y < 20;
      const bool isOutside = y > 28 - x / 8;
      // Half as dense at the bottom.
      const bool isLeftOut = y < 6 && (x % 2 || y % 2);
      if (!isLake && !isBay && !isOutside && !isLeftOut)
      {
        points->InsertNextPoint(0.5 * x, 0.5 * y, 0.0);
      }
    }
  }
  points->InsertNextPoint(12.0, 16.0, 0.0);
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputConnection(delaunay->GetOutputPort());

  trim->Update();
  const bool isSurface = NumberOfFindings(trim->GetOutput(0), RulesOfDelaunayPart()) == 0 &&
    NumberOfFindings(trim->GetOutput(1), RulesOfDelaunayPart()) == 0;
  const bool isBaseline = MatchesBaseline(argc, argv, MakeTrimmed(trim), { 8.0, 9.0, 300, White });
  return isSurface && isBaseline ? EXIT_SUCCESS : EXIT_FAILURE;
}
