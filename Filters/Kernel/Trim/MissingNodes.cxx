// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MissingNodes.h"

#include "Kernel/Base/Base.h"

#include <cmath>
#include <utility>

namespace elevation
{

bool GridSteps::IsBridge(const Point2& p, const Point2& q) const
{
  const Point2& u = this->Steps.StepU;
  const Point2& v = this->Steps.StepV;
  const double x = (q.X - p.X) / this->Scale, y = (q.Y - p.Y) / this->Scale;
  constexpr double most = 1.5; // the next is two steps
  const double cell = std::fabs(this->Steps.Area());
  // By Cramer's rule, these products over the cell's area are the steps along u and v.
  return std::fabs(x * v.Y - y * v.X) > most * cell || std::fabs(u.X * y - u.Y * x) > most * cell;
}

std::vector<Index> FindBridges(
  const TriangleList& list, const GridSteps& grid, const Progress& progress)
{
  std::vector<Index> bridges;
  ForEachNumber(grid.Steps.IsSet() ? list.Count : 0, progress, [&](Index t) {
    const Index* const corners = list.CornersOf(t);
    const Point2 p = list.Points.At(corners[0]), q = list.Points.At(corners[1]),
                 r = list.Points.At(corners[2]);
    if (grid.IsBridge(p, q) || grid.IsBridge(q, r) || grid.IsBridge(r, p))
    {
      bridges.push_back(t);
    }
  });
  return bridges;
}

std::vector<Index> FindOutsideBridges(const TriangleList& list, const GridSteps& grid,
  const MeshBorder& border, const Progress& progress)
{
  std::vector<Index> bridges = FindBridges(list, grid, progress);
  if (bridges.empty())
  {
    return bridges;
  }
  // Only the bridges, with their twins among themselves.
  const PartialMesh partial(list, border, std::move(bridges), progress);
  const Mesh& mesh = partial.Surface;
  std::vector<char> isOutside(mesh.NumberOfTriangles(), 0);
  std::vector<Index> stack;
  // A flood from the border of the mesh that passes long edges only. A lake of missing nodes inside
  // is not reached.
  const auto enter = [&](Index h, Index t) {
    if (!isOutside[t] &&
      grid.IsBridge(mesh.PointOf(mesh.Origin(h)), mesh.PointOf(mesh.Destination(h))))
    {
      isOutside[t] = 1;
      stack.push_back(t);
    }
  };
  for (const Index h : Counted(mesh.NumberOfHalfEdges()))
  {
    if (mesh.IsBorder(h))
    {
      enter(h, Mesh::Triangle(h));
    }
  }
  while (!stack.empty())
  {
    CountWork(1);
    const Index t = stack.back();
    stack.pop_back();
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      // A neighbour that is left out is behind a short edge.
      if (!mesh.IsBorder(h) && mesh.Twin(h) != h)
      {
        enter(h, Mesh::Triangle(mesh.Twin(h)));
      }
    }
  }
  std::vector<Index> outside;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    if (isOutside[t])
    {
      outside.push_back(partial.Triangles[t]);
    }
  }
  return outside;
}

} // namespace elevation
