// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DecimationPeers.h"

#include "Kernel/Base/CellGrid.h"

#include "vtkCellArray.h"
#include "vtkDecimatePro.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkQuadricDecimation.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace benchmark
{
namespace
{
std::vector<std::array<vtkIdType, 3>> TrianglesOf(vtkPolyData* mesh)
{
  std::vector<std::array<vtkIdType, 3>> triangles;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < mesh->GetPolys()->GetNumberOfCells(); ++cell)
  {
    mesh->GetPolys()->GetCellAtId(cell, ids);
    triangles.push_back({ ids->GetId(0), ids->GetId(1), ids->GetId(2) });
  }
  return triangles;
}

void Measure(vtkPolyData* mesh, const Coordinates& points, Decimated& decimated)
{
  using elevation::Point2;
  const auto triangles = TrianglesOf(mesh);
  std::vector<std::array<double, 3>> vertices(static_cast<std::size_t>(mesh->GetNumberOfPoints()));
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    mesh->GetPoint(static_cast<vtkIdType>(i), vertices[i].data());
  }
  const auto vertexOf = [&](std::size_t t, int k) -> const std::array<double, 3>& {
    return vertices[static_cast<std::size_t>(triangles[t][static_cast<std::size_t>(k)])];
  };
  const elevation::CellGrid grid(triangles.size(), [&](std::size_t t) {
    std::array<Point2, 3> corners;
    for (int k = 0; k < 3; ++k)
    {
      corners[static_cast<std::size_t>(k)] = { vertexOf(t, k)[0], vertexOf(t, k)[1] };
    }
    return corners;
  });
  for (std::size_t i = 0; i < points.size(); i += 3)
  {
    const double x = points[i], y = points[i + 1];
    double least = -1.0; // where triangles cover each other, the nearest counts
    grid.Visit(Point2{ x, y }, [&](Index triangle) {
      const std::size_t t = static_cast<std::size_t>(triangle);
      double weights[3], sum = 0.0;
      for (int k = 0; k < 3; ++k)
      {
        const auto &a = vertexOf(t, (k + 1) % 3), &b = vertexOf(t, (k + 2) % 3);
        weights[k] = (a[0] - x) * (b[1] - y) - (a[1] - y) * (b[0] - x);
        sum += weights[k];
      }
      double z = 0.0;
      for (int k = 0; k < 3; ++k)
      {
        if (sum == 0.0 || weights[k] / sum < -1e-9)
        {
          return;
        }
        z += weights[k] / sum * vertexOf(t, k)[2];
      }
      const double distance = std::fabs(points[i + 2] - z);
      least = least < 0.0 ? distance : std::min(least, distance);
    });
    decimated.Outside += least < 0.0;
    decimated.Largest = std::max(decimated.Largest, least);
  }
}

/**
 * Decimates to a number of vertices. Peers count triangles, and what share of vertices is on the
 * border is not known before: so twice if need be, of which the last is timed and measured.
 */
template <typename Filter>
Decimated Decimate(Filter* filter, vtkPolyData* mesh, Index vertices, const Coordinates& points)
{
  Decimated decimated;
  const double all = static_cast<double>(mesh->GetNumberOfPolys());
  double wanted = 2.0 * vertices;
  for (int i = 0; i < 2 && std::abs(decimated.Vertices - vertices) > vertices / 50; ++i)
  {
    filter->SetInputData(mesh);
    filter->Modified();
    filter->SetTargetReduction(std::min(1.0, std::max(0.0, 1.0 - wanted / all)));
    const auto start = std::chrono::steady_clock::now();
    filter->Update();
    decimated.Seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    decimated.Vertices = VerticesOf(filter->GetOutput());
    wanted += 2.0 * (vertices - decimated.Vertices);
  }
  Measure(filter->GetOutput(), points, decimated);
  return decimated;
}
} // namespace

Index VerticesOf(vtkPolyData* mesh)
{
  std::vector<char> isVertex(static_cast<std::size_t>(mesh->GetNumberOfPoints()), 0);
  for (const std::array<vtkIdType, 3>& triangle : TrianglesOf(mesh))
  {
    for (const vtkIdType vertex : triangle)
    {
      isVertex[static_cast<std::size_t>(vertex)] = 1;
    }
  }
  return static_cast<Index>(std::count(isVertex.begin(), isVertex.end(), 1));
}

Decimated DecimateByPro(vtkPolyData* mesh, Index vertices, const Coordinates& points)
{
  vtkNew<vtkDecimatePro> filter;
  filter->PreserveTopologyOn();
  return Decimate(filter.Get(), mesh, vertices, points);
}

Decimated DecimateByQuadric(vtkPolyData* mesh, Index vertices, const Coordinates& points)
{
  vtkNew<vtkQuadricDecimation> filter;
  return Decimate(filter.Get(), mesh, vertices, points);
}

} // namespace benchmark
