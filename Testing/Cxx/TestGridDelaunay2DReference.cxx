// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkDelaunay2D as a reference. On random points in general position both filters must give the
// same set of triangles wherever vtkDelaunay2D is right. Where it is not, the test says so: it
// leaves out thin triangles along the convex hull, even with a large Offset, and parts of a lattice
// with a concave outline. Ours must then have all of its triangles, and cover the hull.
#include "Inputs.h"
#include "MeshRules.h"
#include "SheetOfSquares.h"
#include "vtkCellArray.h"
#include "vtkDelaunay2D.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <set>

namespace
{
using Triangle = std::array<vtkIdType, 3>;

std::set<Triangle> TrianglesOf(vtkPolyData* mesh)
{
  std::set<Triangle> triangles;
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfPolys(); ++cell)
  {
    mesh->GetPolys()->GetCellAtId(cell, size, ids);
    Triangle t{ ids[0], ids[1], ids[2] };
    std::sort(t.begin(), t.end());
    triangles.insert(t);
  }
  return triangles;
}
} // namespace

int TestGridDelaunay2DReference(int, char*[])
{
  int failures = 0;
  for (const int count : { 4, 20, 300, 3000 })
  {
    const auto input = RandomCloud(11, count, 1.0, VTK_DOUBLE, [](double, double) { return 0.0; });
    vtkNew<vtkGridDelaunay2D> ours;
    ours->SetLatticeModeToOff(); // the rules are checked by the coordinates
    ours->SetInputData(input);
    ours->Update();
    vtkNew<vtkDelaunay2D> reference;
    reference->SetInputData(input);
    reference->SetTolerance(0.0);
    reference->SetOffset(100.0);
    reference->Update();

    failures += NumberOfFindings(ours->GetOutput(), elevation::ValidateOptions());
    const auto triangles = TrianglesOf(ours->GetOutput());
    const auto expected = TrianglesOf(reference->GetOutput());
    const double area = ProjectedArea(ours->GetOutput());
    const double missing = (area - ProjectedArea(reference->GetOutput())) / area;
    std::cout << count << " random points: " << triangles.size() << " triangles, vtkDelaunay2D has "
              << expected.size() << " and misses " << missing << " of the area\n";
    const bool isReferenceRight = missing < 1e-12;
    if (isReferenceRight
        ? triangles != expected
        : !std::includes(triangles.begin(), triangles.end(), expected.begin(), expected.end()))
    {
      std::cerr << "The sets of triangles of " << count << " random points differ.\n";
      ++failures;
    }
    if (count < 1000 && !isReferenceRight)
    {
      std::cerr << "vtkDelaunay2D was expected to be right on " << count << " random points.\n";
      ++failures;
    }
  }

  // A full lattice with a wavy outline, turned by half a radian into map coordinates: nearly all
  // points on common circles and lines, none of it exact in floating point.
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int v = -50; v <= 50; ++v)
  {
    for (int u = -50; u <= 50; ++u)
    {
      const double angle = std::atan2(v, u);
      const bool isCorner = std::abs(u) == 50 && std::abs(v) == 50;
      if (std::hypot(u, v) < 40.0 + 8.0 * std::sin(7.0 * angle) || isCorner)
      {
        points->InsertNextPoint(612000.0 + 25.0 * (std::cos(0.5) * u - std::sin(0.5) * v),
          6073000.0 + 25.0 * (std::sin(0.5) * u + std::cos(0.5) * v), 0.0);
      }
    }
  }
  vtkNew<vtkPolyData> lattice;
  lattice->SetPoints(points);
  vtkNew<vtkGridDelaunay2D> ours;
  ours->SetLatticeModeToOff(); // the rules are checked by the coordinates
  ours->SetInputData(lattice);
  ours->Update();
  vtkNew<vtkDelaunay2D> reference;
  reference->SetInputData(lattice);
  reference->Update();
  failures += NumberOfFindings(ours->GetOutput(), elevation::ValidateOptions());
  const double hull = 2500.0 * 2500.0;
  const double error = std::fabs(ProjectedArea(ours->GetOutput()) - hull) / hull;
  const double referenceError = std::fabs(ProjectedArea(reference->GetOutput()) - hull) / hull;
  std::cout << "Lattice with a wavy outline: the area differs from the hull's by " << error
            << " of it, vtkDelaunay2D's by " << referenceError << "\n";
  if (error > 1e-9)
  {
    std::cerr << "The convex hull of the lattice is not covered.\n";
    ++failures;
  }
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
