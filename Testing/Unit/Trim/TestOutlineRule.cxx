// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The rule of ExtractBoundary() once more, without anything that makes it quick.
#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "MaskedSurface.h"

#include "Kernel/Trim/Outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
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
      const double height = std::fabs(TwiceArea(mesh, t)) / this->Longest(t);
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
