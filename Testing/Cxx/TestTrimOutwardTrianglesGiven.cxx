// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A lattice trimmed along given rings, nested three deep, whose edges mostly are not in the
// lattice. Kept triangles are yellow, outward ones blue, the boundary is red.
#include "MeshRules.h"
#include "PictureFromAbove.h"
#include "vtkCellArray.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTrimOutwardTriangles.h"

#include <cstdlib>

int TestTrimOutwardTrianglesGiven(int argc, char* argv[])
{
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 17 * 17; ++i)
  {
    points->InsertNextPoint(i % 17, i / 17, 0.0);
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);

  vtkNew<vtkCellArray> rings;
  const auto at = [](vtkIdType x, vtkIdType y) { return x + 17 * y; };
  rings->InsertNextCell({ at(1, 2), at(14, 1), at(16, 13), at(8, 10), at(3, 16) });
  rings->InsertNextCell({ at(4, 4), at(5, 9), at(13, 9), at(12, 3) });
  rings->InsertNextCell({ at(6, 5), at(11, 5), at(7, 8) });
  vtkNew<vtkPolyData> boundary;
  boundary->SetPoints(points);
  boundary->SetPolys(rings);
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputConnection(delaunay->GetOutputPort());
  trim->SetBoundaryData(boundary);

  trim->Update();
  const bool isSurface = NumberOfFindings(trim->GetOutput(0), RulesOfSurface()) == 0 &&
    NumberOfFindings(trim->GetOutput(1), RulesOfSurface()) == 0;
  const bool isBaseline = MatchesBaseline(argc, argv, MakeTrimmed(trim), { 8.0, 9.0, 300, White });
  return isSurface && isBaseline ? EXIT_SUCCESS : EXIT_FAILURE;
}
