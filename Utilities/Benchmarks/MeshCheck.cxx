// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCheck.h"

#include "Kernel/Base/Predicates.h"
#include "Kernel/Mesh/Validate.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace
{
using benchmark::Index;
using elevation::Point2;

/** Twice the area of a triangle, signed; the differences keep map coordinates from drowning it. */
double TwiceArea(const Point2& a, const Point2& b, const Point2& c)
{
  return (b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X);
}

/** One of an edge's triangles, seen from the edge. */
struct Side
{
  std::uint64_t Edge; ///< lesser id, greater id
  Index Apex;
};

std::uint64_t EdgeOf(Index a, Index b)
{
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 |
    static_cast<std::uint64_t>(std::max(a, b));
}
} // namespace

namespace benchmark
{

PointFacts::PointFacts(const Coordinates& coordinates)
{
  const Index count = static_cast<Index>(coordinates.size() / 3);
  this->Points.resize(count);
  for (Index i = 0; i < count; ++i)
  {
    const std::size_t k = 3 * static_cast<std::size_t>(i);
    this->Points[i] = { coordinates[k], coordinates[k + 1] };
  }
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [this](Index a, Index b) {
    const Point2& p = this->Points[a];
    const Point2& q = this->Points[b];
    return p == q ? a < b : elevation::IsLower(p, q);
  });
  this->First.resize(count);
  for (Index i = 0; i < count; ++i)
  {
    const bool isNew = i == 0 || this->Points[order[i]] != this->Points[order[i - 1]];
    this->First[order[i]] = isNew ? order[i] : this->First[order[i - 1]];
  }
  order.erase(
    std::remove_if(order.begin(), order.end(), [this](Index i) { return this->First[i] != i; }),
    order.end());
  this->NumberOfDistinct = static_cast<Index>(order.size());

  // The hull in two chains, up the right and down the left; points on its edges are kept.
  std::vector<Index> hull;
  for (int way = 0; way < 2; ++way)
  {
    const std::size_t start = hull.size();
    for (Index i : order)
    {
      while (hull.size() >= start + 2 &&
        elevation::Orientation(this->Points[hull[hull.size() - 2]], this->Points[hull.back()],
          this->Points[i]) == elevation::Negative)
      {
        hull.pop_back();
      }
      hull.push_back(i);
    }
    hull.pop_back(); // the next chain begins with it
    std::reverse(order.begin(), order.end());
  }
  this->NumberOnHull = static_cast<Index>(hull.size());
  for (std::size_t i = 1; i + 1 < hull.size(); ++i)
  {
    this->HullArea +=
      0.5 * TwiceArea(this->Points[hull[0]], this->Points[hull[i]], this->Points[hull[i + 1]]);
  }
}

MeshFacts Examine(const PointFacts& points, const std::vector<Index>& triangles)
{
  MeshFacts facts;
  facts.Triangles = triangles.size() / 3;
  std::vector<Side> sides;
  sides.reserve(triangles.size());
  std::vector<char> isVertex(points.Points.size(), 0);
  double twiceArea = 0.0;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    Index corner[3];
    for (int i = 0; i < 3; ++i)
    {
      if (triangles[t + i] < 0 || static_cast<std::size_t>(triangles[t + i]) >= points.First.size())
      {
        throw elevation::Error("a triangle names a point that does not exist");
      }
      corner[i] = points.First[triangles[t + i]];
      isVertex[corner[i]] = 1;
    }
    const Point2& a = points.Points[corner[0]];
    const Point2& b = points.Points[corner[1]];
    const Point2& c = points.Points[corner[2]];
    twiceArea += std::fabs(TwiceArea(a, b, c));
    facts.FlatTriangles += elevation::Orientation(a, b, c) == elevation::Zero;
    for (int i = 0; i < 3; ++i)
    {
      sides.push_back({ EdgeOf(corner[i], corner[(i + 1) % 3]), corner[(i + 2) % 3] });
    }
  }
  facts.Coverage = 0.5 * twiceArea / points.HullArea;
  facts.MissingPoints = points.NumberOfDistinct -
    static_cast<Index>(std::count(isVertex.begin(), isVertex.end(), char(1)));

  std::sort(
    sides.begin(), sides.end(), [](const Side& s, const Side& t) { return s.Edge < t.Edge; });
  facts.Edges.reserve(sides.size() / 2);
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end)
  {
    end = begin + 1;
    while (end < sides.size() && sides[end].Edge == sides[begin].Edge)
    {
      ++end;
    }
    const std::uint64_t edge = sides[begin].Edge;
    if (end - begin == 2)
    {
      const Point2& a = points.Points[edge >> 32];
      const Point2& b = points.Points[edge & 0xffffffffu];
      const Point2& c = points.Points[sides[begin].Apex];
      const Point2& d = points.Points[sides[begin + 1].Apex];
      // Whether it is zero does not depend on the orientation of a, b, c.
      if (elevation::InCircle(a, b, c, d) == elevation::Zero)
      {
        ++facts.Ties;
        continue;
      }
    }
    facts.Edges.push_back(edge);
  }
  return facts;
}

std::size_t Differences(const MeshFacts& a, const MeshFacts& b)
{
  std::vector<std::uint64_t> different;
  std::set_symmetric_difference(
    a.Edges.begin(), a.Edges.end(), b.Edges.begin(), b.Edges.end(), std::back_inserter(different));
  return different.size();
}

std::string FirstFinding(const PointFacts& points, const std::vector<Index>& triangles,
  const std::vector<Index>& unusedPoints)
{
  elevation::Mesh mesh;
  mesh.Points = points.Points;
  mesh.Triangles = triangles;
  elevation::ValidateOptions options;
  options.UnusedPoints = &unusedPoints;
  options.MaximumFindings = 1;
  const std::vector<elevation::Finding> findings = elevation::Validate(mesh, options);
  return findings.empty() ? std::string() : findings.front().Message;
}

} // namespace benchmark
