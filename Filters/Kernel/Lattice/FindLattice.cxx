// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FindLattice.h"

#include "LatticeBasis.h"
#include "OutwardFit.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace elevation
{
namespace
{

// Enough of them that they generate the lattice also where most nodes have no point.
constexpr std::size_t Vectors = 128; // the shortest differences of points
// A remainder below so many steps counts as zero; tried in turn. A small value suits exact
// coordinates at large multiples of the steps; rounded coordinates need a large one.
constexpr std::array<double, 3> ZeroTolerances{ 0.02, 0.06, 0.15 };

struct Difference
{
  double Squared;
  Point2 Vector;
};

/** By length; of equal ones by vector, so that no choice depends on the order of points. */
constexpr auto IsShorter = [](const Difference& p, const Difference& q) {
  return p.Squared != q.Squared ? p.Squared < q.Squared : IsLower(p.Vector, q.Vector);
};

/**
 * The shortest differences of the points, by increasing length. Of at most 128 points
 * (FullestPart), so of some 8,000 pairs: most are longer than the 128th so far, and go at once.
 */
std::vector<Point2> ShortestDifferences(const std::vector<Point2>& points)
{
  std::vector<Difference> shortest;
  shortest.reserve(2 * Vectors);
  Difference bound{ std::numeric_limits<double>::infinity(), {} };
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    for (std::size_t j = i + 1; j < points.size(); ++j)
    {
      const Point2 d = Minus(points[j], points[i]);
      const Difference difference{ Dot(d, d), d };
      if (difference.Squared > bound.Squared || !IsShorter(difference, bound))
      {
        continue;
      }
      shortest.push_back(difference);
      if (shortest.size() == 2 * Vectors)
      {
        const auto last = shortest.begin() + Vectors - 1;
        std::nth_element(shortest.begin(), last, shortest.end(), IsShorter);
        bound = *last;
        shortest.resize(Vectors);
      }
    }
  }
  std::sort(shortest.begin(), shortest.end(), IsShorter);
  shortest.resize(std::min(shortest.size(), Vectors));
  std::vector<Point2> vectors;
  for (const Difference& difference : shortest)
  {
    vectors.push_back(difference.Vector);
  }
  return vectors;
}

/** The points that the lattice is fitted to, relative to the middle, by their distance from it. */
std::vector<Point2> SortedOutwards(
  const LatticeSample& sample, const std::vector<Point2>& around, const Point2& middle)
{
  // The sample reaches far, the points around are dense: the fit needs both.
  std::vector<Point2> points = sample.Some();
  points.insert(points.end(), around.begin(), around.end());
  std::vector<Difference> differences;
  for (const Point2& p : points)
  {
    const Point2 d = Minus(p, middle);
    differences.push_back({ Dot(d, d), d });
  }
  std::sort(differences.begin(), differences.end(), IsShorter);
  points.clear();
  for (const Difference& difference : differences)
  {
    if (points.empty() || points.back() != difference.Vector) // some are in both
    {
      points.push_back(difference.Vector);
    }
  }
  return points;
}

} // namespace

// Tried with each tolerance in turn, from the strictest on: the first lattice that fits is taken.
bool FitLattice(const LatticeSample& sample, std::vector<Point2>&& inFullestPlace, double tolerance,
  const Progress& progress, Lattice& lattice)
{
  // Coordinates relative to a point in the middle lose fewer digits; the origin is moved back at
  // the end.
  const std::vector<Point2> around = FullestPart(std::move(inFullestPlace), progress);
  const Point2 middle = around[around.size() / 2];
  const double width = sample.Width(), height = sample.Height(), extent = width + height;
  // The mean area a point in the fullest part, at least a thousandth of that of all points.
  const Box part = BoxOf(around);
  const double area =
    std::max(part.Width() * part.Height() / around.size(), 1e-3 * (width * height / sample.Count));
  // A finer lattice has more nodes than the bitmap would hold: steps that rounding errors have
  // made.
  const double leastArea = 0.5 * area / MaximumNodesPerPoint;
  // A lattice of the whole cloud is one of its fullest part, where differences are shortest and
  // rounding errors smallest.
  const std::vector<Point2> differences = ShortestDifferences(around);
  std::vector<Point2> points; // not sorted before they are needed: mostly they are not
  const auto isLattice = [&](double zeroTolerance) {
    Generators generators(leastArea, 1e-9 * extent / sample.Count, zeroTolerance);
    if (!std::all_of(differences.begin(), differences.end(),
          [&](const Point2& vector) { return generators.Insert(vector); }))
    {
      return false;
    }
    if (points.empty())
    {
      points = SortedOutwards(sample, around, middle);
    }
    return FitOutwards(
      points, generators, tolerance, extent, MaximumNodesPerPoint * sample.Count, lattice);
  };
  const bool isFound = std::any_of(ZeroTolerances.begin(), ZeroTolerances.end(), isLattice);
  // Of no meaning where none is found.
  lattice.Origin.X += middle.X;
  lattice.Origin.Y += middle.Y;
  return isFound;
}

LatticeSearch FindLattice(
  const PointView& points, double tolerance, int threads, const Progress& progress)
{
  Stages stages(progress, { 55, 40, 5 });
  LatticeSearch search;
  const LatticeSample sample =
    SampleForLattice(points, points.Count, threads, stages.Next(), search.NotFinite);
  static_cast<Box&>(search) = sample;
  // The second pass over all points, only where there is a prospect.
  if (sample.MayFitLattice())
  {
    std::vector<Point2> around =
      DistinctPointsIn(FullestPlace(sample), points, search.NotFinite, threads, stages.Next());
    search.Found = FitLattice(sample, std::move(around), tolerance, stages.Next(), search.Steps);
  }
  return search;
}

} // namespace elevation
