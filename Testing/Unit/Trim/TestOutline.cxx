// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DelaunayMesh.h"
#include "Location.h"
#include "MaskedSurface.h"
#include "PointSets.h"
#include "WorkOf.h"

#include "Kernel/Trim/Rings.h"
#include "Kernel/Trim/Insertion.h"
#include "Kernel/Trim/Outline.h"
#include "Kernel/Base/Predicates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <string>

using namespace elevation;
using namespace testing_surfaces;

namespace
{

/** Twice the area of a ring, by its direction. */
double TwiceArea(const std::vector<Point2>& points, const Rings& rings, Index ring)
{
  double area = 0.0;
  const Index size = rings.Size(ring);
  for (Index i = 0; i < size; ++i)
  {
    const Point2& p = points[rings.Begin(ring)[i]];
    const Point2& q = points[rings.Begin(ring)[(i + 1) % size]];
    area += p.X * q.Y - q.X * p.Y;
  }
  return area;
}

/** Twice the area within rings, each by its direction. */
double TwiceArea(const std::vector<Point2>& points, const Rings& rings)
{
  double area = 0.0;
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    area += TwiceArea(points, rings, ring);
  }
  return area;
}

std::vector<Point2> MaskedLattice(int width, int height, const Mask& mask)
{
  std::vector<Point2> points;
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      if (mask(x, y))
      {
        points.push_back({ static_cast<double>(x), static_cast<double>(y) });
      }
    }
  }
  return points;
}

/** The rule of ExtractBoundary(), step by step and by looking at everything. */
struct RuleByTheLetter
{
  std::vector<char> Keep;
  double Tolerance;
  Index NumberOfDoubtful = 0; ///< by short edges
  Index NumberOfOthers = 0;   ///< of these, those that no small group has
  Index NumberOfSlivers = 0;
  Index NumberInBays = 0;

  RuleByTheLetter(const Mesh& mesh, double tolerance)
    : Tolerance(tolerance)
    , Surface(mesh)
  {
    const Index count = mesh.NumberOfTriangles();
    std::vector<double> sixth, shortEdges, ratios;
    std::vector<char> atBorder(mesh.Points.size(), 0);
    for (Index v = 0; v < mesh.NumberOfPoints(); ++v)
    {
      std::vector<double> all, edges;
      for (Index w = 0; w < mesh.NumberOfPoints(); ++w)
      {
        all.push_back(this->Squared(v, w));
      }
      std::sort(all.begin(), all.end());
      sixth.push_back(0.5 * std::sqrt(all[6]));
      for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
      {
        const bool isBorder = mesh.IsBorder(h);
        if (mesh.Origin(h) == v || (isBorder && mesh.Destination(h) == v))
        {
          edges.push_back(this->Squared(mesh.Origin(h), mesh.Destination(h)));
          atBorder[v] |= isBorder;
        }
      }
      std::sort(edges.begin(), edges.end());
      float sum = 0.0f;
      const int number = static_cast<int>(std::min<std::size_t>(4, edges.size()));
      for (int i = 0; i < number; ++i)
      {
        sum += std::sqrt(static_cast<float>(edges[i]));
      }
      shortEdges.push_back(
        std::min(sum / static_cast<float>(number), 2.0f * std::sqrt(static_cast<float>(edges[1]))));
    }
    for (Index t = 0; t < count; ++t)
    {
      ratios.push_back(this->Longest(t) / this->SpacingOf(sixth, t));
    }
    if (tolerance == 0.0)
    {
      this->Tolerance = 4.5;
    }
    for (Index t = 0; t < count; ++t)
    {
      this->Keep.push_back(
        this->Longest(t) <= 0.52 * this->Tolerance * this->SpacingOf(shortEdges, t));
      this->NumberOfDoubtful += !this->Keep[t];
    }
    const auto shareNorm = [&](const std::vector<double>& spacings, double part) {
      return [this, &spacings, part](Index t) {
        const double side = part * this->Tolerance * this->SpacingOf(spacings, t);
        const Mesh& m = this->Surface;
        const Point2 a = m.PointOf(m.Origin(3 * t)), b = m.PointOf(m.Origin(3 * t + 1)),
                     c = m.PointOf(m.Origin(3 * t + 2));
        return 0.5 * ((b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X)) / (side * side);
      };
    };
    // Groups by corners.
    const auto shareACorner = [&](Index s, Index t) {
      for (Index h = 3 * s; h < 3 * s + 3; ++h)
      {
        for (Index g = 3 * t; g < 3 * t + 3; ++g)
        {
          if (mesh.Origin(h) == mesh.Origin(g))
          {
            return true;
          }
        }
      }
      return false;
    };
    this->CloseGroups(shareACorner, shareNorm(shortEdges, 0.7), [&](Index t) {
      return atBorder[mesh.Origin(3 * t)] || atBorder[mesh.Origin(3 * t + 1)] ||
        atBorder[mesh.Origin(3 * t + 2)];
    });
    for (Index t = 0; t < count; ++t)
    {
      this->NumberOfOthers += !this->Keep[t];
      this->Keep[t] = this->Keep[t] || ratios[t] <= this->Tolerance;
    }
    const std::vector<char> before = this->Keep;
    // Slivers with two corners at the border and their longest edge there, until there are none.
    std::vector<char> isSliver(count, 0), atEdge = atBorder;
    for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
    {
      atEdge[mesh.Origin(h)] |= !before[Mesh::Triangle(h)];
    }
    const auto isFlat = [&](Index t) {
      const double height = std::fabs(testing_surfaces::TwiceArea(mesh, t)) / this->Longest(t);
      return height < 0.1 * this->SpacingOf(shortEdges, t);
    };
    const std::vector<char> atBorderOfAll = atEdge;
    for (Index t = 0; t < count; ++t)
    {
      const Index corners[3] = { mesh.Origin(3 * t), mesh.Origin(3 * t + 1),
        mesh.Origin(3 * t + 2) };
      const bool isAtEdge =
        atBorderOfAll[corners[0]] || atBorderOfAll[corners[1]] || atBorderOfAll[corners[2]];
      for (int k = 0; k < 3 && isAtEdge && isFlat(t); ++k)
      {
        atEdge[corners[k]] = 1;
      }
    }
    for (bool isDone = false; !isDone;)
    {
      isDone = true;
      for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
      {
        const Index t = Mesh::Triangle(h);
        const bool isOpen = mesh.IsBorder(h) || !this->Keep[Mesh::Triangle(mesh.Twin(h))];
        const bool isAtEdge =
          atEdge[mesh.Origin(h)] + atEdge[mesh.Destination(h)] + atEdge[mesh.Apex(h)] >= 2;
        const bool isLongest =
          std::sqrt(this->Squared(mesh.Origin(h), mesh.Destination(h))) == this->Longest(t);
        if (this->Keep[t] && isOpen && isAtEdge && isLongest && isFlat(t))
        {
          this->Keep[t] = 0;
          isSliver[t] = 1;
          ++this->NumberOfSlivers;
          isDone = false;
        }
      }
    }
    // Lakes and bays, by edges.
    const auto shareAnEdge = [&](Index s, Index t) {
      for (Index h = 3 * s; h < 3 * s + 3; ++h)
      {
        if (!mesh.IsBorder(h) && Mesh::Triangle(mesh.Twin(h)) == t)
        {
          return true;
        }
      }
      return false;
    };
    const auto share = shareNorm(sixth, 1.0);
    std::vector<char> isInBay(count);
    for (Index t = 0; t < count; ++t)
    {
      double largest = 0.0;
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        largest = std::max(largest, sixth[mesh.Origin(h)]);
      }
      isInBay[t] = isSliver[t] || this->Longest(t) <= 1.6 * this->Tolerance * largest;
    }
    for (const std::vector<Index>& lake : this->Groups(shareAnEdge, 0))
    {
      double sum = 0.0;
      for (const Index t : lake)
      {
        const bool isAtBorder =
          mesh.IsBorder(3 * t) || mesh.IsBorder(3 * t + 1) || mesh.IsBorder(3 * t + 2);
        sum += isAtBorder ? 4.0 : before[t] ? 0.0 : share(t);
      }
      for (const Index t : lake)
      {
        this->Keep[t] = sum < 1.0;
        isInBay[t] = isInBay[t] && sum >= 4.0;
      }
    }
    for (Index t = 0; t < count; ++t)
    {
      this->Keep[t] = !this->Keep[t] && isInBay[t] ? 2 : this->Keep[t];
    }
    std::vector<Index> closed;
    for (const std::vector<Index>& bay : this->Groups(shareAnEdge, 2))
    {
      double sum = 0.0, open = 0.0;
      for (const Index t : bay)
      {
        sum += before[t] ? 0.0 : share(t);
        for (Index h = 3 * t; h < 3 * t + 3; ++h)
        {
          const char beside = mesh.IsBorder(h) ? char(0) : this->Keep[Mesh::Triangle(mesh.Twin(h))];
          const double length = std::sqrt(this->Squared(mesh.Origin(h), mesh.Destination(h)));
          open += beside == 2 ? 0.0 : beside == 1 ? -length : length;
        }
      }
      if (sum < 1.0 && open <= 0.0)
      {
        closed.insert(closed.end(), bay.begin(), bay.end());
      }
    }
    this->NumberInBays += static_cast<Index>(closed.size());
    std::replace(this->Keep.begin(), this->Keep.end(), char(2), char(0));
    for (const Index t : closed)
    {
      this->Keep[t] = 1;
    }
    // Small pieces.
    for (const std::vector<Index>& piece : this->Groups(shareAnEdge, 1))
    {
      std::set<Index> vertices;
      for (const Index t : piece)
      {
        for (Index h = 3 * t; h < 3 * t + 3; ++h)
        {
          vertices.insert(mesh.Origin(h));
        }
      }
      for (const Index t : piece)
      {
        this->Keep[t] = vertices.size() > 6;
      }
    }
  }

private:
  double Squared(Index v, Index w) const
  {
    const Point2 p = this->Surface.PointOf(v), q = this->Surface.PointOf(w);
    return (p.X - q.X) * (p.X - q.X) + (p.Y - q.Y) * (p.Y - q.Y);
  }
  double Longest(Index t) const
  {
    double longest = 0.0;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      longest =
        std::max(longest, this->Squared(this->Surface.Origin(h), this->Surface.Destination(h)));
    }
    return std::sqrt(longest);
  }
  double SpacingOf(const std::vector<double>& spacings, Index t) const
  {
    std::vector<double> of;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      of.push_back(spacings[this->Surface.Origin(h)]);
    }
    std::sort(of.begin(), of.end());
    return std::min(of[1], 2.0 * of[0]);
  }

  template <typename Connected>
  std::vector<std::vector<Index>> Groups(Connected&& connected, char kept) const
  {
    std::vector<std::vector<Index>> groups;
    std::vector<Index> left;
    for (Index t = 0; t < this->Surface.NumberOfTriangles(); ++t)
    {
      if (this->Keep[t] == kept)
      {
        left.push_back(t);
      }
    }
    while (!left.empty())
    {
      groups.push_back({ left.back() });
      left.pop_back();
      for (std::size_t i = 0; i < groups.back().size(); ++i)
      {
        const Index t = groups.back()[i];
        const auto others = std::partition(
          left.begin(), left.end(), [&](Index other) { return !connected(t, other); });
        groups.back().insert(groups.back().end(), others, left.end());
        left.erase(others, left.end());
      }
    }
    return groups;
  }

  template <typename Connected, typename Share, typename AtBorder>
  void CloseGroups(Connected&& connected, Share&& share, AtBorder&& isAtBorder)
  {
    for (const std::vector<Index>& group : this->Groups(connected, 0))
    {
      double sum = 0.0;
      for (const Index t : group)
      {
        sum += isAtBorder(t) ? 1.0 : share(t);
      }
      for (const Index t : group)
      {
        this->Keep[t] = sum < 1.0;
      }
    }
  }

  const Mesh& Surface;
};

} // namespace

TEST(ExtractBoundary, OfAFullLatticeIsItsOutline)
{
  const Mesh mesh = Delaunay(MaskedLattice(12, 9, [](double, double) { return true; }));
  const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
  EXPECT_EQ(boundary.Vertices.Count(), 1);
  EXPECT_EQ(boundary.Vertices.Vertices.size(), 2u * (11 + 8));
  EXPECT_EQ(boundary.Vertices.Vertices.front(), 0);
  EXPECT_EQ(TwiceArea(mesh.Points, boundary.Vertices), 2.0 * 11 * 8);
  EXPECT_NEAR(boundary.GapTolerance, 4.5, 1e-12);
}

TEST(ExtractBoundary, TakesTheToleranceOfALargeLatticeFromASample)
{
  const ExtractedBoundary boundary = ExtractBoundary(
    Delaunay(MaskedLattice(120, 90, [](double, double) { return true; })), ExtractOptions());
  EXPECT_EQ(boundary.GapTolerance, 4.5);
  EXPECT_EQ(boundary.Vertices.Vertices.size(), 2u * (119 + 89));
}

TEST(ExtractBoundary, FollowsItsRuleToTheLetter)
{
  Random random(17);
  Index numberOfDoubtful = 0, numberOfOthers = 0, numberOfOutward = 0, numberOfSlivers = 0,
        numberInBays = 0;
  for (int round = 0; round < 4; ++round)
  {
    // Few enough that the typical triangle is found from all of them; dense on one side.
    std::vector<Point2> points;
    while (points.size() < 1000)
    {
      const Point2 p{ random.Unit(), random.Unit() };
      if (Coast(p.X, p.Y) && (round % 2 == 0 || random.Unit() < 0.1 + 0.9 * p.X * p.X))
      {
        points.push_back(p);
      }
    }
    const Mesh mesh = Delaunay(points);
    for (const double tolerance : { 0.0, 2.5, 7.0 })
    {
      const RuleByTheLetter rule(mesh, tolerance);
      numberOfDoubtful += rule.NumberOfDoubtful;
      numberOfOthers += rule.NumberOfOthers;
      numberOfSlivers += rule.NumberOfSlivers;
      numberInBays += rule.NumberInBays;
      numberOfOutward += static_cast<Index>(std::count(rule.Keep.begin(), rule.Keep.end(), 0));
      ExtractOptions options;
      options.GapTolerance = tolerance;
      const ExtractedBoundary boundary = ExtractBoundary(mesh, options);
      EXPECT_EQ(boundary.GapTolerance, rule.Tolerance);
      EXPECT_EQ(boundary.IsSurface, rule.Keep) << round << " " << tolerance;
    }
  }
  // All parts of the rule have had something to say.
  EXPECT_GT(numberOfDoubtful, numberOfOthers + 100);
  EXPECT_GT(numberOfOthers, numberOfOutward + 100);
  EXPECT_GT(numberOfOutward, 100);
  EXPECT_GT(numberOfSlivers, 20);
  EXPECT_GT(numberInBays, 100);
}

namespace
{
/** Which nodes of a masked lattice are missing and joined to its outside by missing ones. */
std::set<std::pair<int, int>> OutsideNodes(int width, int height, const Mask& mask)
{
  std::set<std::pair<int, int>> outside{ { -1, -1 } };
  std::vector<std::pair<int, int>> stack{ { -1, -1 } };
  while (!stack.empty())
  {
    const auto [x, y] = stack.back();
    stack.pop_back();
    for (const auto& [i, j] :
      { std::pair<int, int>{ x - 1, y }, { x + 1, y }, { x, y - 1 }, { x, y + 1 } })
    {
      const bool isFrame = i < 0 || j < 0 || i >= width || j >= height;
      if (i >= -1 && j >= -1 && i <= width && j <= height && (isFrame || !mask(i, j)) &&
        outside.insert({ i, j }).second)
      {
        stack.emplace_back(i, j);
      }
    }
  }
  return outside;
}

/** Whether a triangle, or its border, has a place. */
bool Covers(const Mesh& mesh, Index t, const Point2& place)
{
  return Orientation(mesh.PointOf(mesh.Origin(3 * t)), mesh.PointOf(mesh.Origin(3 * t + 1)),
           place) != Negative &&
    Orientation(mesh.PointOf(mesh.Origin(3 * t + 1)), mesh.PointOf(mesh.Origin(3 * t + 2)),
      place) != Negative &&
    Orientation(mesh.PointOf(mesh.Origin(3 * t + 2)), mesh.PointOf(mesh.Origin(3 * t)), place) !=
    Negative;
}

Lattice Steps(const Point2& u, const Point2& v)
{
  Lattice steps;
  steps.StepU = u;
  steps.StepV = v;
  return steps;
}
} // namespace

TEST(ExtractBoundary, OnAGridLeavesOutWhatIsMissingAtTheOutsideHoweverNarrow)
{
  Random random(17);
  int bays = 0, voids = 0;
  for (int round = 0; round < 40; ++round)
  {
    SCOPED_TRACE(round);
    const int width = 8 + random.Below(30), height = 8 + random.Below(30);
    std::set<std::pair<int, int>> missing;
    for (int i = random.Below(12); i >= 0; --i)
    {
      // A worm of missing nodes, one or more wide.
      int x = random.Below(width), y = random.Below(height);
      for (int k = random.Below(20), wide = 1 + random.Below(2); k >= 0; --k)
      {
        missing.insert({ x, y });
        missing.insert({ x + wide - 1, y });
        (random.Below(2) ? x : y) += random.Below(2) ? 1 : -1;
      }
    }
    const Mask mask = [&](double x, double y) {
      return missing.count({ static_cast<int>(x), static_cast<int>(y) }) == 0;
    };
    const std::set<std::pair<int, int>> outside = OutsideNodes(width, height, mask);
    // Cells may be long, and turned.
    const double along = 1.0 + round % 4;
    const Point2 u = round % 3 == 0 ? Point2{ 5.0, 0.0 } : Point2{ 3.0, 4.0 };
    const Point2 v{ -along * u.Y, along * u.X };
    const auto place = [&](int x, int y) { return Point2{ x * u.X + y * v.X, x * u.Y + y * v.Y }; };
    std::vector<Point2> points;
    std::vector<std::pair<int, int>> nodes;
    for (int y = 0; y < height; ++y)
    {
      for (int x = 0; x < width; ++x)
      {
        if (mask(x, y))
        {
          points.push_back(place(x, y));
          nodes.emplace_back(x, y);
        }
      }
    }
    const Mesh mesh = Delaunay(points);
    ExtractOptions options;
    const ExtractedBoundary without = ExtractBoundary(mesh, options);
    options.Grid = Steps(u, v);
    const ExtractedBoundary found = ExtractBoundary(mesh, options);
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      int low[2] = { width, height }, high[2] = { 0, 0 };
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        const auto& [x, y] = nodes[mesh.Origin(h)];
        low[0] = std::min(low[0], x), high[0] = std::max(high[0], x);
        low[1] = std::min(low[1], y), high[1] = std::max(high[1], y);
      }
      if (high[0] - low[0] <= 1 && high[1] - low[1] <= 1)
      {
        EXPECT_TRUE(found.IsSurface[t]) << "a triangle of a cell";
        continue;
      }
      bool hasOutside = false, hasVoid = false;
      for (int y = low[1]; y <= high[1]; ++y)
      {
        for (int x = low[0]; x <= high[0]; ++x)
        {
          if (!mask(x, y) && Covers(mesh, t, place(x, y)))
          {
            (outside.count({ x, y }) ? hasOutside : hasVoid) = true;
          }
        }
      }
      EXPECT_FALSE(hasOutside && hasVoid);
      bays += hasOutside && without.IsSurface[t];
      voids += hasVoid;
      EXPECT_FALSE(hasOutside && found.IsSurface[t]);
      EXPECT_TRUE(!hasVoid || found.IsSurface[t] || !without.IsSurface[t]);
    }
  }
  EXPECT_GT(bays, 500);
  EXPECT_GT(voids, 500);
}

TEST(ExtractBoundary, OnAGridTakesCoordinatesOfAnySize)
{
  // A bay one node wide, three deep.
  const Mask mask = [](double x, double y) { return x != 4.0 || y > 3.0; };
  for (const double scale : { 1.0, 1e20, 1e-20 })
  {
    std::vector<Point2> points = MaskedLattice(10, 10, mask);
    for (Point2& p : points)
    {
      p = { scale * p.X, scale * p.Y };
    }
    ExtractOptions options;
    options.Grid = Steps({ scale, 0.0 }, { 0.0, scale });
    const ExtractedBoundary found = ExtractBoundary(Delaunay(points), options);
    EXPECT_EQ(std::count(found.IsSurface.begin(), found.IsSurface.end(), char(0)), 7) << scale;
  }
}

TEST(ExtractBoundary, IsTheSameForAnyNumberOfThreads)
{
  std::mt19937_64 random(71);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  std::vector<Point2> points;
  for (int i = 0; i < 30000; ++i)
  {
    points.push_back({ place(random), place(random) * place(random) });
  }
  const Mesh mesh = Delaunay(points);
  ExtractOptions options;
  const ExtractedBoundary one = ExtractBoundary(mesh, options);
  for (const int threads : { 2, 4 })
  {
    options.NumberOfThreads = threads;
    const ExtractedBoundary several = ExtractBoundary(mesh, options);
    EXPECT_EQ(several.GapTolerance, one.GapTolerance);
    EXPECT_EQ(several.Vertices.Offsets, one.Vertices.Offsets);
    EXPECT_EQ(several.Vertices.Vertices, one.Vertices.Vertices);
  }
}

TEST(ExtractBoundary, HasLakesAndIslands)
{
  // A block with a lake of 10 x 10 missing nodes and an island of 4 x 4 in it; another block apart.
  const Mesh mesh = Delaunay(MaskedLattice(45, 24, [](double x, double y) {
    const bool isLake = 5 <= x && x <= 18 && 5 <= y && y <= 18;
    const bool isIsland = 10 <= x && x <= 13 && 10 <= y && y <= 13;
    return (x <= 24 || x >= 32) && (!isLake || isIsland);
  }));
  const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
  ASSERT_EQ(boundary.Vertices.Count(), 4);
  std::multiset<double> areas;
  for (Index ring = 0; ring < 4; ++ring)
  {
    areas.insert(TwiceArea(mesh.Points, boundary.Vertices, ring) / 2);
  }
  // In each of the lake's four corners, triangles with edges within the tolerance stay.
  EXPECT_EQ(*areas.rbegin(), 24.0 * 23);
  EXPECT_EQ(areas.count(12.0 * 23), 1u);
  EXPECT_EQ(areas.count(9.0), 1u);
  EXPECT_LE(*areas.begin(), -15.0 * 15 + 4 * 4.5 * 4.5 / 2);
  EXPECT_GE(*areas.begin(), -15.0 * 15);
}

TEST(ExtractBoundary, BridgesWhatTheToleranceSays)
{
  // Two blocks, apart by 1 to 8 steps.
  for (int steps = 1; steps <= 8; ++steps)
  {
    const Mesh mesh = Delaunay(
      MaskedLattice(16 + steps, 8, [&](double x, double) { return x < 8 || x >= 7 + steps; }));
    ExtractOptions options;
    EXPECT_EQ(ExtractBoundary(mesh, options).Vertices.Count(), steps <= 4 ? 1 : 2) << steps;
    options.GapTolerance = 6.2;
    const ExtractedBoundary wider = ExtractBoundary(mesh, options);
    EXPECT_EQ(wider.GapTolerance, 6.2);
    EXPECT_EQ(wider.Vertices.Count(), steps <= 6 ? 1 : 2) << steps;
  }
}

TEST(ExtractBoundary, LeavesOutLonePointsAndSmallGroups)
{
  std::vector<Point2> points = MaskedLattice(20, 20, [](double, double) { return true; });
  points.insert(points.end(),
    { { 40, 3 }, { 45, 30 }, { 45.5, 30 }, { 45, 30.5 }, { 46, 31 }, { -30, 10 }, { -30, 11 } });
  const Mesh mesh = Delaunay(points);
  const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
  EXPECT_EQ(boundary.Vertices.Count(), 1);
  EXPECT_EQ(TwiceArea(mesh.Points, boundary.Vertices), 2.0 * 19 * 19);
  EXPECT_EQ(boundary.NumberOfPointsLeftOut, 7);
  // But a cloud of a few points alone is a surface.
  const Mesh few = Delaunay({ { 0, 0 }, { 1, 0 }, { 0, 1 }, { 1, 1.5 } });
  EXPECT_EQ(ExtractBoundary(few, ExtractOptions()).Vertices.Count(), 1);
}

TEST(ExtractBoundary, LeavesOutWhiskers)
{
  // A line of points that leaves a block, straight or wavering by up to a tenth of their distance,
  // and one that ends in a small group.
  for (const double wavering : { 0.0, 1e-9, 0.01, 0.1 })
  {
    Random random(18);
    std::vector<Point2> points = MaskedLattice(20, 20, [](double, double) { return true; });
    const std::size_t block = points.size();
    for (int i = 1; i <= 40; ++i)
    {
      points.push_back({ 19.0 + i, 10.0 + wavering * (random.Unit() - 0.5) });
      points.push_back({ 10.0 + wavering * (random.Unit() - 0.5), -1.0 * i });
    }
    points.insert(points.end(), { { 9.5, -40.5 }, { 10.5, -40.5 } });
    const Mesh mesh = Delaunay(points);
    const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
    ASSERT_EQ(boundary.Vertices.Count(), 1);
    // At its root a line may have triangles with the block.
    Index outside = 0;
    for (const Index v : boundary.Vertices.Vertices)
    {
      outside += v >= static_cast<Index>(block);
    }
    EXPECT_LE(outside, 8) << wavering;
    EXPECT_NEAR(TwiceArea(mesh.Points, boundary.Vertices), 2.0 * 19 * 19, 80.0) << wavering;
  }
}

TEST(ExtractBoundary, ClosesSpeckle)
{
  // A lattice thinned to an eighth has openings just above the tolerance, but no lakes.
  Random random(12);
  const Mesh mesh = Delaunay(MaskedLattice(60, 60, [&](double x, double y) {
    return x == 0 || y == 0 || x == 59 || y == 59 || random.Below(100) < 12;
  }));
  const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
  EXPECT_EQ(boundary.Vertices.Count(), 1);
}

namespace
{
using Spacing = std::function<double(double, double)>;

Spacing Even(double spacing)
{
  return [spacing](double, double) { return spacing; };
}

double ErrorOfExtraction(const std::vector<Point2>& points, const Mask& mask,
  const Spacing& spacing, const Placing& placing = Placing())
{
  const Mesh mesh = Delaunay(points);
  const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
  return SampledMask(mask, spacing, placing).Error(mesh.Points, boundary.Vertices);
}

/** The points on land of so many at random in the unit square. */
std::vector<Point2> Scattered(
  Random& random, int count, const Mask& mask, const Placing& placing = Placing())
{
  std::vector<Point2> points;
  for (int i = 0; i < count; ++i)
  {
    const double x = random.Unit(), y = random.Unit();
    if (mask(x, y))
    {
      points.push_back(placing.PlaceOf(x, y));
    }
  }
  return points;
}
} // namespace

// With default properties, at most a quarter of the ring of one spacing, whatever the seed, where
// channels are hardly wider than the tolerance.
TEST(ExtractBoundary, FollowsMaskedLatticesWholeAndThinned)
{
  for (const Mask& mask : { Mask(Coast), Mask(Archipelago) })
  {
    for (int seed = 0; seed <= 3; ++seed)
    {
      Random random(seed);
      const std::vector<Point2> points = MaskedLattice(401, 401, [&](double x, double y) {
        return mask(x / 400, y / 400) && (seed == 0 || random.Below(10) == 0);
      });
      const double spacing = (seed == 0 ? 1.0 : std::sqrt(10.0)) / 400;
      const Placing placing{ [](double x, double y) {
                              return Point2{ 400 * x, 400 * y };
                            },
        Placing().AreaOf };
      EXPECT_LE(ErrorOfExtraction(points, mask, Even(spacing), placing), 0.25) << seed;
    }
  }
}

TEST(ExtractBoundary, FollowsMaskedPointsWhoseSpacingGrowsTenfold)
{
  for (const Mask& mask : { Mask(Coast), Mask(Archipelago) })
  {
    for (int seed = 1; seed <= 2; ++seed)
    {
      for (const Placing& placing : { Placing(), TenfoldGrading() })
      {
        for (const int count : { 9000, 16000 })
        {
          Random random(seed);
          const std::vector<Point2> points = Scattered(random, count, mask, placing);
          const Spacing spacing = Even(1.0 / std::sqrt(count));
          EXPECT_LE(ErrorOfExtraction(points, mask, spacing, placing), 0.25)
            << seed << " " << count;
        }
      }
    }
  }
}

TEST(ExtractBoundary, IsNearTheTrueOutlineOnEvenlyAndGraduallyDenseClouds)
{
  // A tenth of the ring on both sides is a fifth of the length of the outline times the spacing.
  // Means of 20 seeds: 0.09 whole, 0.10 thinned, 0.10 random, 0.12 graded.
  for (int seed = 1; seed <= 3; ++seed)
  {
    Random random(seed);
    const int size = 180 + 7 * seed;
    const Placing placing{ [size](double x, double y) { return Point2{ size * x, size * y }; },
      Placing().AreaOf };
    const std::vector<Point2> whole = MaskedLattice(
      size + 1, size + 1, [size](double x, double y) { return Island(x / size, y / size); });
    const double ofWhole = ErrorOfExtraction(whole, Island, Even(1.0 / size), placing);
    std::vector<Point2> thinned;
    const int fine = 500;
    const Placing finely{ [](double x, double y) { return Point2{ 500 * x, 500 * y }; },
      Placing().AreaOf };
    for (const Point2& p : MaskedLattice(
           fine + 1, fine + 1, [](double x, double y) { return Island(x / 500, y / 500); }))
    {
      if (random.Below(10) == 0)
      {
        thinned.push_back(p);
      }
    }
    const double ofThinned =
      ErrorOfExtraction(thinned, Island, Even(std::sqrt(10.0) / fine), finely);
    const int count = 30000;
    const double ofRandom =
      ErrorOfExtraction(Scattered(random, count, Island), Island, Even(1.0 / std::sqrt(count)));
    const double ofGraded = ErrorOfExtraction(Scattered(random, count, Island, TenfoldGrading()),
      Island, Even(1.0 / std::sqrt(count)), TenfoldGrading());
    EXPECT_LE(ofWhole, 0.13) << seed;
    EXPECT_LE(ofThinned, 0.13) << seed;
    EXPECT_LE(ofRandom, 0.13) << seed;
    EXPECT_LE(ofGraded, 0.16) << seed;
  }
}

TEST(ExtractBoundary, FollowsMaskedScanLines)
{
  // Eight times denser along than across.
  for (int seed = 1; seed <= 3; ++seed)
  {
    Random random(seed);
    std::vector<Point2> points;
    for (int j = 0; j <= 100; ++j)
    {
      for (int i = 0; i <= 800; ++i)
      {
        const double x = i / 800.0 + 2e-4 * random.Unit();
        const double y = j / 100.0 + 5e-4 * random.Unit();
        if (Coast(x, y))
        {
          points.push_back({ x, y });
        }
      }
    }
    EXPECT_LE(ErrorOfExtraction(points, Coast, Even(0.01)), 0.25) << seed;
  }
}

TEST(ExtractBoundary, BridgesWhatIsNarrowerThanTheToleranceWhereItGrows)
{
  // Of density 1 at x = 0 and a hundredth at x = 1, so that the channel is 19 spacings wide at its
  // end and 2.4 at its mouth, where it may be closed: the error is larger than where it may not.
  double worst = 0.0;
  for (int seed = 1; seed <= 5; ++seed)
  {
    Random random(seed);
    const double least = 1.0 / std::sqrt(100000);
    const Spacing spacing = [least](double x, double) { return least * std::pow(10.0, x); };
    std::vector<Point2> points;
    for (const Point2& p : Scattered(random, 100000, Coast))
    {
      if (random.Unit() < std::pow(0.01, p.X))
      {
        points.push_back(p);
      }
    }
    worst = std::max(worst, ErrorOfExtraction(points, Coast, spacing));
  }
  EXPECT_LE(worst, 0.3);
}

// The same on real elevation data, in x and y scaled to the unit square.
TEST(ExtractBoundary, FollowsMaskedSurveysWholeThinnedAndGraded)
{
  for (const char* name : { "st_helens_after_usgs", "nankai_channels" })
  {
    const testing_points::Cloud cloud = testing_points::RealCloud(name);
    const PointView view = cloud.View();
    Point2 low = view.At(0), high = low;
    for (Index i = 0; i < view.Count; ++i)
    {
      const Point2 p = view.At(i);
      low = { std::min(low.X, p.X), std::min(low.Y, p.Y) };
      high = { std::max(high.X, p.X), std::max(high.Y, p.Y) };
    }
    const Placing placing{
      [=](double x, double y) {
        return Point2{ low.X + x * (high.X - low.X), low.Y + y * (high.Y - low.Y) };
      },
      Placing().AreaOf
    };
    const double full = 1.0 / std::sqrt(static_cast<double>(view.Count));
    for (int seed = 1; seed <= 2; ++seed)
    {
      Random random(seed);
      for (const bool isCoast : { true, false })
      {
        const Mask mask = isCoast ? Coast : Archipelago;
        std::vector<Point2> whole, thinned, graded;
        for (Index i = 0; i < view.Count; ++i)
        {
          const Point2 p = view.At(i);
          const double x = (p.X - low.X) / (high.X - low.X);
          const double y = (p.Y - low.Y) / (high.Y - low.Y);
          if (mask(x, y))
          {
            whole.push_back(p);
            if (random.Below(10) == 0)
            {
              thinned.push_back(p);
            }
            if (random.Unit() < std::pow(0.01, x))
            {
              graded.push_back(p);
            }
          }
        }
        if (seed == 1)
        {
          EXPECT_LE(ErrorOfExtraction(whole, mask, Even(full), placing), 0.25) << name;
        }
        EXPECT_LE(ErrorOfExtraction(thinned, mask, Even(std::sqrt(10.0) * full), placing), 0.25)
          << name << " " << seed;
        if (!isCoast) // whose channel is too narrow where the spacing is largest
        {
          const Spacing growing = [full](double x, double) { return full * std::pow(10.0, x); };
          EXPECT_LE(ErrorOfExtraction(graded, mask, growing, placing), 0.25) << name << " " << seed;
        }
      }
    }
  }
}

TEST(ExtractBoundary, KeepsLakesAndNecksOfThreeSpacings)
{
  // On a lattice, on one thinned to a ninth at random, and on random points; a spacing is 1.
  Random random(15);
  constexpr int size = 40;
  const auto cloud = [&](int kind, const Mask& isLand) {
    std::vector<Point2> points;
    const auto add = [&](double x, double y) {
      if (isLand(x, y))
      {
        points.push_back({ x, y });
      }
    };
    for (int i = 0; i < (kind == 1 ? 9 : 1) * size * size; ++i)
    {
      const int width = kind == 1 ? 3 * size : size;
      if (kind == 2)
      {
        const double x = size * random.Unit();
        add(x, size * random.Unit());
      }
      else if (kind == 0 || random.Below(9) == 0)
      {
        const double step = static_cast<double>(size) / width;
        add(step * (i % width), step * (i / width));
      }
    }
    return points;
  };
  for (const int kind : { 0, 1, 2 })
  {
    for (int round = 0; round < 20; ++round)
    {
      const double u = 19.0 + random.Unit(), v = 19.0 + random.Unit();
      const auto besideLake = [&](double x, double y) { return std::hypot(x - u, y - v) >= 3.0; };
      const auto alongNeck = [&](double x, double y) {
        return std::fabs(x - 20.0) > 6.0 || std::fabs(y - v) <= 1.5;
      };
      EXPECT_GE(
        ExtractBoundary(Delaunay(cloud(kind, besideLake)), ExtractOptions()).Vertices.Count(), 2)
        << "a lake with a radius of three, " << kind;
      const std::vector<Point2> points = cloud(kind, alongNeck);
      const Rings outline = ExtractBoundary(Delaunay(points), ExtractOptions()).Vertices;
      EXPECT_EQ(outline.Count(), 1) << "a neck three wide, " << kind;
      // Not by taking all for surface.
      EXPECT_LT(TwiceArea(points, outline) / 2, size * size - 0.8 * 12.0 * (size - 3.0)) << kind;
    }
  }
}

TEST(ExtractBoundary, DoesNotDependOnTheOrderOfPoints)
{
  Random random(14);
  std::vector<Point2> points = LatticePoints(random, 50, 50, 700);
  const auto ringsOf = [](const std::vector<Point2>& ordered) {
    const Mesh mesh = Delaunay(ordered);
    const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
    std::vector<std::pair<double, double>> rings{ { boundary.GapTolerance, 0.0 } };
    for (Index ring = 0; ring < boundary.Vertices.Count(); ++ring)
    {
      rings.push_back({ -1.0, -1.0 });
      for (const Index* v = boundary.Vertices.Begin(ring); v != boundary.Vertices.End(ring); ++v)
      {
        rings.push_back({ mesh.PointOf(*v).X, mesh.PointOf(*v).Y });
      }
    }
    return rings;
  };
  // Of the random ones, a sample decides the tolerance.
  std::vector<Point2> scattered;
  while (scattered.size() < 5000)
  {
    const Point2 p{ random.Unit(), random.Unit() };
    if (Coast(p.X, p.Y))
    {
      scattered.push_back(p);
    }
  }
  for (std::vector<Point2>* cloud : { &points, &scattered })
  {
    const auto expected = ringsOf(*cloud);
    EXPECT_GT(expected.size(), 20u);
    for (int round = 0; round < 5; ++round)
    {
      random.Shuffle(*cloud);
      EXPECT_EQ(ringsOf(*cloud), expected);
    }
  }
}

TEST(ExtractBoundary, DoesNotDependOnTheOrderOfAnyMesh)
{
  // Not Delaunay, with holes, with several vertices at one place: ties of all kinds.
  Random random(15);
  std::size_t numberOfRings = 0;
  for (int round = 0; round < 60; ++round)
  {
    std::vector<Point2> points = LatticePoints(random, 25, 25, 450);
    for (Point2& p : points)
    {
      p = { 0.1 * p.X, 0.1 * p.Y };
    }
    Mesh mesh = Delaunay(points);
    const bool isApart = round % 3 == 0;
    mesh = Without(mesh, [&](Index) { return random.Unit() < (isApart ? 0.7 : 0.05); });
    for (int flip = 0; flip < 60; ++flip)
    {
      const Index h = random.Below(mesh.NumberOfHalfEdges());
      const Index twin = mesh.Twin(h);
      if (twin == Mesh::Border)
      {
        continue;
      }
      const Index a = mesh.Origin(h), b = mesh.Destination(h), c = mesh.Apex(h),
                  d = mesh.Apex(twin);
      if (Orientation(mesh.PointOf(a), mesh.PointOf(d), mesh.PointOf(c)) == Positive &&
        Orientation(mesh.PointOf(d), mesh.PointOf(b), mesh.PointOf(c)) == Positive)
      {
        const Index ofOne[] = { a, d, c }, ofOther[] = { d, b, c };
        std::copy_n(ofOne, 3, &mesh.Triangles[h / 3 * 3]);
        std::copy_n(ofOther, 3, &mesh.Triangles[twin / 3 * 3]);
        mesh.ConnectTwins();
      }
    }
    for (Index& corner : mesh.Triangles)
    {
      if (isApart) // each corner is a vertex of its own
      {
        mesh.Points.push_back(mesh.PointOf(corner));
        corner = mesh.NumberOfPoints() - 1;
      }
    }
    const double tolerance = isApart ? 1e9 : round % 3 == 1 ? 4.0 : 2.25;
    std::vector<std::vector<double>> expected;
    for (int order = 0; order < 4; ++order)
    {
      std::vector<Index> ids(mesh.Points.size());
      std::iota(ids.begin(), ids.end(), 0);
      std::vector<Index> triangles(mesh.NumberOfTriangles());
      std::iota(triangles.begin(), triangles.end(), 0);
      if (order > 0)
      {
        random.Shuffle(ids);
        random.Shuffle(triangles);
      }
      Mesh shuffled;
      shuffled.Points.resize(mesh.Points.size());
      for (std::size_t i = 0; i < ids.size(); ++i)
      {
        shuffled.Points[ids[i]] = mesh.Points[i];
      }
      for (const Index t : triangles)
      {
        for (Index i = 0; i < 3; ++i)
        {
          shuffled.Triangles.push_back(ids[mesh.Origin(3 * t + (i + order) % 3)]);
        }
      }
      shuffled.ConnectTwins();
      ExtractOptions options;
      options.GapTolerance = tolerance;
      const ExtractedBoundary boundary = ExtractBoundary(shuffled, options);
      std::vector<std::vector<double>> rings;
      for (Index ring = 0; ring < boundary.Vertices.Count(); ++ring)
      {
        rings.emplace_back();
        for (const Index* v = boundary.Vertices.Begin(ring); v != boundary.Vertices.End(ring); ++v)
        {
          rings.back().push_back(shuffled.PointOf(*v).X);
          rings.back().push_back(shuffled.PointOf(*v).Y);
        }
      }
      expected = order == 0 ? rings : expected;
      EXPECT_EQ(rings, expected) << round << " " << order;
      numberOfRings += rings.size();
    }
  }
  EXPECT_GT(numberOfRings, 1000u);
}

TEST(ExtractBoundary, RingsBeginAtOneOfTwoVerticesAtTheLowestPlaceByTheNextOnes)
{
  // A triangle in a triangle, and the land between them slit open from corner to corner: vertices
  // 0 and 7 are at the lowest place. From 7 the ring goes on inwards, to the lower of the next
  // ones.
  const std::vector<Point2> points{ { 0, -4 }, { 4, 4 }, { -4, 4 }, { 0, -1 }, { 1, 1 }, { -1, 1 },
    { 0, -1 }, { 0, -4 } };
  const std::vector<Index> triangles{ 0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 2, 7, 6, 2, 6, 5 };
  const std::vector<Index> expected{ 7, 6, 5, 4, 3, 0, 1, 2 };
  Random random(18);
  std::vector<Index> ids(points.size()), order(triangles.size() / 3);
  std::iota(ids.begin(), ids.end(), 0);
  std::iota(order.begin(), order.end(), 0);
  for (int round = 0; round < 20; ++round)
  {
    Mesh mesh;
    mesh.Points.resize(points.size());
    for (std::size_t v = 0; v < points.size(); ++v)
    {
      mesh.Points[ids[v]] = points[v];
    }
    for (const Index t : order)
    {
      for (Index i = 0; i < 3; ++i)
      {
        mesh.Triangles.push_back(ids[triangles[3 * t + (i + round) % 3]]);
      }
    }
    mesh.ConnectTwins();
    ExtractOptions options;
    options.GapTolerance = 1e9;
    std::vector<Index> ring;
    for (const Index v : ExtractBoundary(mesh, options).Vertices.Vertices)
    {
      ring.push_back(static_cast<Index>(std::find(ids.begin(), ids.end(), v) - ids.begin()));
    }
    EXPECT_EQ(ring, expected) << round;
    random.Shuffle(ids);
    random.Shuffle(order);
  }
}

TEST(ExtractBoundary, AHubDoesNotChangeTheTolerance)
{
  // A lattice, and a fan of very many triangles, thousands of spacings long. Wherever its middle
  // is: whether a vertex is in the sample depends on that.
  Mesh mesh;
  for (Index y = 0; y < 150; ++y)
  {
    for (Index x = 0; x < 150; ++x)
    {
      const Index v = mesh.NumberOfPoints();
      mesh.Points.push_back({ static_cast<double>(x), static_cast<double>(y) });
      if (x > 0 && y > 0)
      {
        mesh.Triangles.insert(mesh.Triangles.end(), { v - 151, v - 150, v, v - 151, v, v - 1 });
      }
    }
  }
  const Index hub = mesh.NumberOfPoints();
  constexpr Index count = 30000;
  mesh.Points.push_back({ 0, 0 });
  for (Index i = 0; i < count; ++i)
  {
    const double angle = 6.283185307179586 * i / count;
    mesh.Points.push_back({ 5000 + 1000 * std::cos(angle), 1000 * std::sin(angle) });
    mesh.Triangles.insert(mesh.Triangles.end(), { hub, hub + 1 + i, hub + 1 + (i + 1) % count });
  }
  mesh.ConnectTwins();
  for (int place = 0; place < 25; ++place)
  {
    mesh.Points[hub] = { 5000 + 0.004 * place, 0 };
    EXPECT_EQ(ExtractBoundary(mesh, ExtractOptions()).GapTolerance, 4.5) << place;
  }
}

TEST(ExtractBoundary, ReportsRiseWhenMoreOfASmallPieceMustBeSeen)
{
  // An opening of one triangle in a piece of six vertices, far from the border of another piece:
  // seen from the opening, the piece goes on.
  Random random(16);
  int numberOfReports = 0;
  for (int round = 0; round < 4000; ++round)
  {
    std::vector<Point2> points = LatticePoints(random, 12, 12, 6 + round % 3);
    const Mesh mesh = Delaunay(points);
    ASSERT_FALSE(mesh.Triangles.empty());
    ExtractOptions options;
    options.GapTolerance = 1.0 + round % 10;
    double last = 0.0;
    options.Monitor = [&](double fraction) {
      EXPECT_GE(fraction, last) << round;
      last = fraction;
      ++numberOfReports;
      return true;
    };
    ExtractBoundary(mesh, options);
  }
  EXPECT_GT(numberOfReports, 4000);
}

TEST(ExtractBoundary, TakesWorkInProportionToAHubsNeighbors)
{
  // Every other triangle of a fan: borders meet at its middle 100,000 times. And all of them.
  for (const Index step : { 1, 2 })
  {
    Mesh mesh;
    constexpr Index count = 200000;
    mesh.Points.push_back({ 0, 0 });
    for (Index i = 0; i < count; ++i)
    {
      const double angle = 6.283185307179586 * i / count;
      mesh.Points.push_back({ std::cos(angle), std::sin(angle) });
      if (i % step == 0)
      {
        mesh.Triangles.insert(mesh.Triangles.end(), { 0, 1 + i, 1 + (i + 1) % count });
      }
    }
    ExtractOptions options;
    options.GapTolerance = 1e9;
    ExtractedBoundary boundary;
    const std::size_t work = testing_work::WorkOf([&]() {
      mesh.ConnectTwins();
      boundary = ExtractBoundary(mesh, options);
    });
    EXPECT_LT(work, 380u * count);
    ASSERT_EQ(boundary.Vertices.Count(), step == 1 ? 1 : count / 2);
    for (Index ring = 0; ring < boundary.Vertices.Count(); ++ring)
    {
      EXPECT_EQ(boundary.Vertices.Size(ring), step == 1 ? count : 3);
    }
  }
}

TEST(ExtractBoundary, TakesWorkInProportionToSliversThatLeanOnEachOther)
{
  // A fan of slivers over the flat arc below a triangle. All are at the border, and each leans with
  // its longest edge on the next; the last one, on the triangle, is dropped first, or last.
  for (const bool isLastFirst : { true, false })
  {
    Mesh mesh;
    constexpr Index count = 50000;
    const double across = static_cast<double>(count);
    for (Index i = 0; i <= count; ++i)
    {
      mesh.Points.push_back({ double(i), 0.01 * (i / across) * (i / across - 1.0) });
    }
    mesh.Points.push_back({ 0.5 * across, across });
    mesh.Triangles = { 0, count, count + 1 };
    for (Index i = 1; i < count; ++i)
    {
      const Index k = isLastFirst ? count - i : i;
      mesh.Triangles.insert(mesh.Triangles.end(), { 0, k, k + 1 });
    }
    mesh.ConnectTwins();
    ExtractOptions options;
    options.GapTolerance = 1e9;
    ExtractedBoundary boundary;
    const std::size_t work =
      testing_work::WorkOf([&]() { boundary = ExtractBoundary(mesh, options); });
    EXPECT_LT(work, 160u * count);
    EXPECT_EQ(std::count(boundary.IsSurface.begin(), boundary.IsSurface.end(), 1), count);
    EXPECT_EQ(boundary.NumberOfPointsLeftOut, 0);
    ASSERT_EQ(boundary.Vertices.Count(), 1);
    EXPECT_EQ(boundary.Vertices.Size(0), count + 2);
  }
}

TEST(ExtractBoundary, HasSimpleRings)
{
  // A random lattice, thin enough for pinched vertices: no ring passes a vertex twice.
  Random random(15);
  for (int round = 0; round < 30; ++round)
  {
    const Mesh mesh = Delaunay(LatticePoints(random, 60, 60, 500));
    ExtractOptions options;
    options.GapTolerance = 2.5;
    const ExtractedBoundary boundary = ExtractBoundary(mesh, options);
    for (Index ring = 0; ring < boundary.Vertices.Count(); ++ring)
    {
      const Index* begin = boundary.Vertices.Begin(ring);
      const Index* end = boundary.Vertices.End(ring);
      ASSERT_EQ(std::set<Index>(begin, end).size(), static_cast<std::size_t>(end - begin));
    }
  }
}

TEST(ExtractBoundary, TakesCoordinatesOfAnySize)
{
  Random random(16);
  const std::vector<Point2> points = LatticePoints(random, 30, 30, 600);
  const auto countOf = [&](double scale) {
    std::vector<Point2> scaled = points;
    for (Point2& p : scaled)
    {
      p = { p.X * scale, p.Y * scale };
    }
    return ExtractBoundary(Delaunay(scaled), ExtractOptions()).Vertices.Vertices;
  };
  const std::vector<Index> expected = countOf(1.0);
  EXPECT_EQ(countOf(std::ldexp(1.0, 900)), expected);
  EXPECT_EQ(countOf(std::ldexp(1.0, -900)), expected);
}

TEST(ExtractBoundary, TakesDistancesBelowTheRangeOfSquares)
{
  // Most of the points are so near to each other that their spacing does not differ from 0.
  std::vector<Point2> points;
  for (int i = 0; i < 100; ++i)
  {
    points.push_back({ std::ldexp(i % 10, -700), std::ldexp(i / 10, -700) });
    points.push_back({ 1.0 + i % 10, 1.0 + i / 10 });
  }
  const Mesh mesh = Delaunay(points);
  for (const double tolerance : { 0.0, 1e-300, 1.0, 1e300 })
  {
    ExtractOptions options;
    options.GapTolerance = tolerance;
    EXPECT_TRUE(std::isfinite(ExtractBoundary(mesh, options).GapTolerance));
  }
}

TEST(ExtractBoundary, StopsWhenAskedAndTakesAnEmptyMesh)
{
  EXPECT_EQ(ExtractBoundary(Mesh(), ExtractOptions()).Vertices.Count(), 0);
  ExtractOptions options;
  options.Monitor = [](double) { return false; };
  EXPECT_THROW(
    ExtractBoundary(Delaunay(MaskedLattice(4, 4, [](double, double) { return true; })), options),
    Aborted);
}
