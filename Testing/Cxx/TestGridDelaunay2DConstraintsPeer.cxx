// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Constraints with which vtkDelaunay2D fails, and what vtkGridDelaunay2D makes of them: an outline
// with two holes, and lines that run through points that they do not name. The length of all edges
// that lie on the lines, as a part of that of the lines, shows who is right: 1 is right; with less,
// edges are missing; with more, edges lie on each other. And no triangle of ours may cover what
// another one covers.
#include "Check.h"
#include "MeshRules.h"
#include "vtkCellArray.h"
#include "vtkDelaunay2D.h"
#include "vtkGridDelaunay2D.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <set>
#include <utility>
#include <vector>

namespace
{
/**
 * A lattice of size x size; some points moved off their nodes, so that no two circles are equal.
 */
vtkSmartPointer<vtkPolyData> MakeInput(int size, double shift)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < size * size; ++i)
  {
    const double turn = 2.399963 * i;
    points->InsertNextPoint(
      i % size + shift * std::cos(turn), i / size + shift * std::sin(turn), 0.0);
  }
  auto input = vtkSmartPointer<vtkPolyData>::New();
  input->SetPoints(points);
  return input;
}

using Ids = std::vector<vtkIdType>;

/** vtkDelaunay2D wants lines by the ids of the input's points; ours takes them as well. */
vtkSmartPointer<vtkPolyData> MakeLines(
  vtkPolyData* input, const std::vector<Ids>& lines, bool arePolygons)
{
  vtkNew<vtkCellArray> cells;
  for (const Ids& ids : lines)
  {
    cells->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(input->GetPoints());
  if (arePolygons)
  {
    data->SetPolys(cells);
  }
  else
  {
    data->SetLines(cells);
  }
  return data;
}

/** The length of all edges on the lines, as a part of the lines'. */
double CoveredPart(vtkPolyData* surface, const std::vector<Ids>& lines, bool areClosed)
{
  std::set<std::pair<vtkIdType, vtkIdType>> edges;
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfPolys(); ++cell)
  {
    surface->GetPolys()->GetCellAtId(cell, size, ids);
    for (int i = 0; i < 3; ++i)
    {
      edges.insert(std::minmax(ids[i], ids[(i + 1) % 3]));
    }
  }
  double whole = 0.0, covered = 0.0;
  for (const Ids& line : lines)
  {
    for (std::size_t k = 0; k + 1 < line.size() + (areClosed ? 1 : 0); ++k)
    {
      double a[3], b[3], p[3], q[3];
      surface->GetPoint(line[k], a);
      surface->GetPoint(line[(k + 1) % line.size()], b);
      const double length = std::sqrt(vtkMath::Distance2BetweenPoints(a, b));
      whole += length;
      const auto isOn = [&](const double* r) {
        const double along = (r[0] - a[0]) * (b[0] - a[0]) + (r[1] - a[1]) * (b[1] - a[1]);
        const double aside = (r[0] - a[0]) * (b[1] - a[1]) - (r[1] - a[1]) * (b[0] - a[0]);
        return std::fabs(aside) < 1e-9 && along > -1e-9 && along < length * length + 1e-9;
      };
      for (const auto& edge : edges)
      {
        surface->GetPoint(edge.first, p);
        surface->GetPoint(edge.second, q);
        covered += isOn(p) && isOn(q) ? std::sqrt(vtkMath::Distance2BetweenPoints(p, q)) : 0.0;
      }
    }
  }
  return covered / whole;
}

void Compare(const char* name, vtkPolyData* input, const std::vector<Ids>& lines, bool arePolygons)
{
  auto constraints = MakeLines(input, lines, arePolygons);
  vtkNew<vtkGridDelaunay2D> ours;
  ours->SetInputData(input);
  ours->SetSourceData(constraints);
  ours->Update();
  Check(
    NumberOfFindings(ours->GetOutput(), RulesOfConstrained()) == 0, "ours covers the hull once");
  const double part = CoveredPart(ours->GetOutput(), lines, arePolygons);
  Check(std::fabs(part - 1.0) < 1e-12, "in ours all lines are edges");

  vtkNew<vtkDelaunay2D> peer;
  peer->GlobalWarningDisplayOff();
  peer->SetInputData(input);
  peer->SetSourceData(constraints);
  peer->Update();
  peer->GlobalWarningDisplayOn();
  std::cout << name << ": edges on the lines, as a part of them: ours " << part
            << ", vtkDelaunay2D " << CoveredPart(peer->GetOutput(), lines, arePolygons) << "\n";
}
} // namespace

int TestGridDelaunay2DConstraintsPeer(int, char*[])
{
  constexpr int size = 20;
  const auto id = [](int x, int y) { return static_cast<vtkIdType>(y * size + x); };
  const std::vector<Ids> outline = {
    { id(1, 1), id(18, 2), id(17, 18), id(10, 13), id(2, 17) },
    { id(4, 4), id(5, 11), id(8, 9), id(9, 3) }, // holes run the other way
    { id(12, 5), id(11, 10), id(16, 14), id(15, 4) },
  };
  Compare("Two holes", MakeInput(size, 0.2), outline, true);
  Compare("Two holes on a lattice", MakeInput(size, 0.0), outline, true);
  const std::vector<Ids> through = {
    { id(0, 0), id(19, 19) },
    { id(2, 1), id(18, 9) },
    { id(1, 16), id(13, 4) },
    { id(5, 0), id(5, 19) },
  };
  Compare("Through points", MakeInput(size, 0.0), through, false);
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
