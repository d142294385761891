// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The three filters in a row, from points to a surface: grid Delaunay, trim, fill. The cloud
// has a bay in its outline and three voids. The triangulation spans them as far as the limit on
// the length of edges lets it, trimming opens them again, filling closes the voids. Numbers
// first, then a picture.
#include "Check.h"
#include "MeshRules.h"
#include "PictureFromAbove.h"
#include "SheetOfSquares.h"
#include "vtkCellData.h"
#include "vtkFillElevationHoles.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkTrimOutwardTriangles.h"

#include <cmath>
#include <cstdlib>
#include <iostream>

namespace
{
bool IsData(double x, double y)
{
  const auto isIn = [&](double cx, double cy, double rx, double ry) {
    return (x - cx) * (x - cx) / (rx * rx) + (y - cy) * (y - cy) / (ry * ry) < 1.0;
  };
  const bool isSheet = isIn(20.0, 20.0, 20.0, 20.0) && !isIn(17.0, 38.0, 4.0, 16.0);
  return isSheet && !isIn(9.0, 15.0, 3.5, 5.0) && !isIn(26.0, 9.0, 7.0, 3.0) &&
    !isIn(30.0, 26.0, 3.0, 3.0);
}

/** Points about one unit apart, no two columns alike. */
vtkSmartPointer<vtkPolyData> MakeCloud()
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int j = 0; j <= 40; ++j)
  {
    for (int i = 0; i <= 40; ++i)
    {
      const double x = i + 0.3 * std::sin(7.0 * i + 3.0 * j);
      const double y = j + 0.3 * std::cos(5.0 * i - 2.0 * j);
      if (IsData(x, y))
      {
        points->InsertNextPoint(x, y, 3.0 * std::sin(0.2 * x) * std::cos(0.15 * y));
      }
    }
  }
  auto cloud = vtkSmartPointer<vtkPolyData>::New();
  cloud->SetPoints(points);
  return cloud;
}

} // namespace

int TestReconstructionChain(int argc, char* argv[])
{
  auto cloud = MakeCloud();
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  delaunay->SetMaximumEdgeLength(8.0);
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputConnection(delaunay->GetOutputPort());
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputConnection(trim->GetOutputPort());
  fill->SetSpacing(1.0);
  fill->Update();

  vtkPolyData* surface = fill->GetOutput();
  vtkPolyData* report = fill->GetOutput(1);
  Check(trim->GetNumberOfOutwardTriangles() > 20, "the bay is trimmed");
  Check(fill->GetNumberOfHoles() == 3, "the three voids are holes, the bay is none");
  Check(fill->GetNumberOfFilledHoles() == 3, "all are filled");
  Check(NumberOfFindings(delaunay->GetOutput(), RulesOfDelaunayPart()) == 0 &&
      NumberOfFindings(trim->GetOutput(), RulesOfDelaunayPart()) == 0 &&
      NumberOfFindings(surface, RulesOfSurface()) == 0,
    "every step makes a surface, the first two a Delaunay triangulation");
  double holes = 0.0;
  for (vtkIdType hole = 0; hole < report->GetNumberOfCells(); ++hole)
  {
    holes += report->GetCellData()->GetArray("Area")->GetTuple1(hole);
  }
  Check(std::fabs(ProjectedArea(surface) - ProjectedArea(trim->GetOutput()) - holes) < 1e-9,
    "patches have the area of the holes");
  Check(surface->GetNumberOfPoints() > cloud->GetNumberOfPoints() + 80, "voids get points");
  bool isSame = true;
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    double p[3];
    double q[3];
    cloud->GetPoint(i, p);
    surface->GetPoint(i, q);
    isSame = isSame && p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
  }
  Check(isSame, "the points of the cloud come first and unchanged");
  const double center[2] = { 17.0, 36.0 };
  bool isOpen = true;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double p[3];
    surface->GetPoint(i, p);
    isOpen = isOpen && std::hypot(p[0] - center[0], p[1] - center[1]) > 3.0;
  }
  Check(isOpen, "no point is put into the bay");

  auto patched = MakeSurface(fill->GetOutputPort(), Yellow);
  ColorByHole(patched, { Yellow, Red, Red, Red });
  auto outward = MakeSurface(trim->GetOutputPort(1), { 0.1, 0.6, 0.9 });
  outward->SetPosition(0.0, 0.0, -20.0); // patches lie over the triangles trimmed off in voids
  Check(MatchesBaseline(argc, argv, { patched, outward }, { 20.0, 21.0, 500, DarkBlue }),
    "the picture is that of the baseline");
  return failures ? EXIT_FAILURE : EXIT_SUCCESS;
}
