// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FillCutting.h"

#include "Kernel/Mesh/HalfEdgeMesh.h"

#include <cmath>
#include <limits>

namespace benchmark
{

Shape MakeShape(const std::string& name, double points, Random& random, double& reach)
{
  const double angle = 6.283185307179586 * random();
  const double phase = 6.283185307179586 * random();
  const double radius = std::sqrt(points / 3.14159265358979);
  if (name == "strip")
  {
    const double width = std::sqrt(points / 5.0);
    reach = 2.6 * width;
    return [=](double x, double y) {
      const double u = std::cos(angle) * x + std::sin(angle) * y;
      const double v = std::cos(angle) * y - std::sin(angle) * x;
      return std::fabs(u) < 2.5 * width && std::fabs(v) < 0.5 * width;
    };
  }
  if (name == "blob")
  {
    reach = 1.6 * radius;
    return [=](double x, double y) {
      const double a = std::atan2(y, x) + angle;
      return std::hypot(x, y) <
        0.95 * radius * (1.0 + 0.3 * std::sin(2.0 * a + phase) + 0.2 * std::sin(3.0 * a));
    };
  }
  if (name == "island")
  {
    reach = 1.2 * radius;
    return [=](double x, double y) {
      const double r = std::hypot(x, y);
      return r < 1.1 * radius && r > 0.45 * radius;
    };
  }
  reach = radius;
  return [=](double x, double y) { return std::hypot(x, y) < radius; };
}

bool CutHole(
  const Surface& surface, const Point2& middle, const Shape& isLost, double reach, Hole& hole)
{
  const double window = 3.2 * reach + 6.0;
  const Mesh& mesh = surface.Triangles;
  std::vector<Index> place(mesh.NumberOfPoints(), elevation::None);
  hole = Hole();
  for (Index v = 0; v < mesh.NumberOfPoints(); ++v)
  {
    const double x = (mesh.Points[v].X - middle.X) / surface.Spacing;
    const double y = (mesh.Points[v].Y - middle.Y) / surface.Spacing;
    if (std::fabs(x) > window || std::fabs(y) > window)
    {
      continue;
    }
    if (std::hypot(x, y) < reach + 4.0 && surface.OnBorder[v])
    {
      return false;
    }
    const double* p = &surface.Points[3 * std::size_t(v)];
    Coordinates& into = isLost(x, y) ? hole.Lost : hole.Points;
    place[v] = isLost(x, y) ? elevation::None : static_cast<Index>(hole.Points.size() / 3);
    into.insert(into.end(), p, p + 3);
  }
  for (std::size_t i = 0; i < mesh.Triangles.size(); i += 3)
  {
    const Index a = place[mesh.Triangles[i]];
    const Index b = place[mesh.Triangles[i + 1]];
    const Index c = place[mesh.Triangles[i + 2]];
    if (a >= 0 && b >= 0 && c >= 0)
    {
      hole.Triangles.insert(hole.Triangles.end(), { a, b, c });
    }
  }
  return !hole.Lost.empty();
}

void AddCliff(const Surface& surface, Random& random, Hole& hole)
{
  const auto reachOf = [&hole](double angle) {
    double reach = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hole.Lost.size(); i += 3)
    {
      reach = std::max(reach, std::cos(angle) * hole.Lost[i] + std::sin(angle) * hole.Lost[i + 1]);
    }
    return reach;
  };
  constexpr double pi = 3.14159265358979323846;
  double best = 0.0;
  double narrowest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 32; ++k)
  {
    const double width = reachOf(pi * k / 32) + reachOf(pi * k / 32 + pi);
    best = width < narrowest - 1e-9 ? pi * k / 32 : best;
    narrowest = std::min(narrowest, width);
  }
  best += random() < 0.5 ? pi : 0.0;
  const double foot = reachOf(best) + 2.0 * surface.Spacing * random();
  const double height = (random() < 0.5 ? -1.0 : 1.0) * (5.0 + 15.0 * random());
  for (std::size_t i = 0; i < hole.Points.size(); i += 3)
  {
    const double at = std::cos(best) * hole.Points[i] + std::sin(best) * hole.Points[i + 1];
    hole.Points[i + 2] += at > foot ? height : 0.0;
  }
}

} // namespace benchmark
