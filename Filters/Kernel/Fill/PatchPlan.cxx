// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PatchPlan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace elevation
{

namespace
{

/** The spacing at the boundary is the mean length of this many edges. */
constexpr Index EdgesAround = 8;

/** If spacings at the boundary differ more than this, points are graded. */
constexpr double LargestSpacingRatio = 3.0;

/**
 * For the surface's density, an edge counts as no shorter than this part of itself, so a hole gets
 * at most some 36 times as many points. One dense place beside it would else take hundreds of
 * thousands. Where a void is bridged up to the gap tolerance of trim, the edges of its rim are four
 * to five times as long as those of the surface: with a quarter, such a void gets little more than
 * half of the points that it lost, with a sixth nine in ten. In trials, a quarter raises errors by
 * 0.3 %, and no limit does not lower them further.
 */
constexpr double LeastPartOfEdge = 1.0 / 6.0;

/** A line needs no closer points than this part of the gap beside it. */
constexpr double LeastSpacingInGap = 0.1;

/**
 * Largest median triangle, in cells, for which the nodes are used. It is half a cell where the
 * surface has all nodes, and one and a half where it has a quarter of them.
 */
constexpr double LargestCellsPerTriangle = 1.75;

/**
 * The median area of the surface's triangles at the vertices of a hole's boundary; infinite where
 * there are none. At a region those without an edge on the border: a line that jumps from row to row
 * has small triangles, too, one beside the other, but no surface.
 */
double MedianTriangleArea(
  const Mesh& mesh, const VertexStars& stars, const Holes& holes, Index hole)
{
  std::vector<double> areas;
  const bool isRegion = holes.IsRegion(hole);
  holes.VisitEdges(hole, [&](Index origin, Index) {
    const Point2& p = mesh.PointOf(origin);
    stars.Visit(mesh, origin, [&](Index h) {
      const bool isOnBorder = mesh.Twin(h) == Mesh::Border ||
        mesh.Twin(Mesh::Next(h)) == Mesh::Border || mesh.Twin(Mesh::Previous(h)) == Mesh::Border;
      if (isRegion && isOnBorder)
      {
        return true;
      }
      const Point2& a = mesh.PointOf(mesh.Destination(h));
      const Point2& b = mesh.PointOf(mesh.Apex(h));
      areas.push_back(0.5 * ((a.X - p.X) * (b.Y - p.Y) - (a.Y - p.Y) * (b.X - p.X)));
      return true;
    });
  });
  if (areas.empty())
  {
    return std::numeric_limits<double>::infinity();
  }
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return *middle;
}

/** At the origin of each edge, the mean length of the edges before and after it on its walk. */
std::vector<double> SpacingsAlong(
  const Holes& holes, Index hole, const std::vector<double>& lengths)
{
  std::vector<double> spacings;
  spacings.reserve(lengths.size());
  // The boundary's lengths come walk by walk, as the spacings are to be.
  const double* length = lengths.data();
  for (Index loop = holes.Offsets[hole]; loop < holes.Offsets[hole + 1]; ++loop)
  {
    const Index count = holes.Walks.Size(holes.Loops[loop]);
    const Index around = std::min(count, EdgesAround);
    for (Index i = 0; i < count; ++i)
    {
      double sum = 0.0;
      for (Index k = 0; k < around; ++k)
      {
        // Half of the edges before the vertex and half after it, around the end of the walk.
        sum += length[(i + k + count - around / 2) % count];
      }
      spacings.push_back(sum / around);
    }
    length += count;
  }
  return spacings;
}

/**
 * Appends the spacings at both ends of each inner edge: the mean length of the inner edges there,
 * or the mean spacing where there are none.
 */
void AddInnerSpacings(const Holes& holes, Index hole, const std::vector<double>& lengths,
  double mean, std::vector<double>& spacings)
{
  // Two passes over the same edges: a vertex has several, and all of them count.
  std::unordered_map<Index, std::pair<double, double>> sums; // of lengths, and their number
  const double* length = lengths.data();
  holes.VisitInnerEdges(hole, [&](Index a, Index b) {
    for (const Index end : { a, b })
    {
      sums[end].first += *length;
      sums[end].second += 1.0;
    }
    ++length;
  });
  holes.VisitInnerEdges(hole, [&](Index a, Index b) {
    for (const Index end : { a, b })
    {
      const auto& [sum, number] = sums[end];
      // a == b stands for a lone point inside, which has no edge.
      spacings.push_back(a == b ? mean : sum / number);
    }
  });
}

/** The lengths of a hole's edges, then those of its inner edges. */
struct EdgeLengths
{
  std::vector<double> Boundary;
  std::vector<double> Inner;
};

/** The mean spacing of those edges that are not longer than a limit; the limit if all are. */
double MeanWithin(double limit, const EdgeLengths& lengths, const EdgeLengths& spacings)
{
  double sum = 0.0;
  double number = 0.0;
  const auto add = [&](const std::vector<double>& ofEdges, const std::vector<double>& values) {
    for (std::size_t i = 0; i < ofEdges.size(); ++i)
    {
      if (ofEdges[i] > 0.0 && ofEdges[i] <= limit)
      {
        sum += values[i];
        number += 1.0;
      }
    }
  };
  add(lengths.Boundary, spacings.Boundary);
  add(lengths.Inner, spacings.Inner);
  return number > 0.0 ? sum / number : limit;
}

EdgeLengths MeasureEdges(const Mesh& mesh, const Holes& holes, Index hole)
{
  EdgeLengths lengths;
  const auto lengthOf = [&](
                          Index a, Index b) { return Distance(mesh.PointOf(a), mesh.PointOf(b)); };
  lengths.Boundary.reserve(holes.NumberOfEdges(hole));
  holes.VisitEdges(hole, [&](Index a, Index b) { lengths.Boundary.push_back(lengthOf(a, b)); });
  holes.VisitInnerEdges(hole, [&](Index a, Index b) { lengths.Inner.push_back(lengthOf(a, b)); });
  return lengths;
}

/**
 * The spacing that each edge asks for: its length. In a region of lines, whose points are mostly
 * inside, it follows the gaps beside them, where these are wide; but not wider than the region is.
 */
EdgeLengths EdgeSpacings(
  const Holes& holes, Index hole, const EdgeLengths& lengths, double regionWidth)
{
  EdgeLengths spacings = lengths;
  if (!holes.IsOfLines(hole))
  {
    return spacings;
  }
  double* next = spacings.Boundary.data();
  const auto raise = [&](Index a, Index b) {
    // Long edges stay as they are: MeanWithin() leaves them out.
    if (*next > 0.0 && *next <= holes.LongestEdge)
    {
      const double gap = std::min({ holes.Gaps[a], holes.Gaps[b], regionWidth });
      *next = std::max(*next, LeastSpacingInGap * gap);
    }
    ++next;
  };
  holes.VisitEdges(hole, raise);
  next = spacings.Inner.data();
  holes.VisitInnerEdges(hole, raise);
  return spacings;
}

/**
 * Whether a hole may have room for a new point if its edges count as short as they may: for a disc
 * whose radius is the distance that points keep from the boundary.
 */
bool HasRoomIfDense(const Holes& holes, Index hole, const std::vector<double>& lengths, double area)
{
  const std::vector<double> spacings = SpacingsAlong(holes, hole, lengths);
  const double radius =
    LeastClearance * LeastPartOfEdge * *std::min_element(spacings.begin(), spacings.end());
  return area > 3.0 * radius * radius;
}

/**
 * Where the surface nearby has shorter edges than the boundary, these are asked for.
 * @return whether that is so anywhere
 */
bool MatchDensity(LengthsOfSurface& surface, const Holes& holes, Index hole,
  const Progress& progress, EdgeLengths& spacings)
{
  const bool isRegion = holes.IsRegion(hole);
  const std::vector<double> around = LengthsAround(surface, holes, hole, progress);
  bool isDenser = false;
  for (std::size_t i = 0; i < around.size(); ++i)
  {
    double& spacing = spacings.Boundary[i];
    // Long edges stay as they are: MeanWithin() leaves them out, and makes Graded sparser there.
    if (around[i] < spacing && !(isRegion && spacing > holes.LongestEdge))
    {
      spacing = std::max(around[i], LeastPartOfEdge * spacing);
      isDenser = true;
    }
  }
  return isDenser;
}

/** The spacing of a hole, if the user sets none. */
double MeanSpacing(
  const Holes& holes, Index hole, const EdgeLengths& lengths, const EdgeLengths& spacings)
{
  if (holes.IsRegion(hole))
  {
    return MeanWithin(holes.LongestEdge, lengths, spacings);
  }
  return std::accumulate(spacings.Boundary.begin(), spacings.Boundary.end(), 0.0) /
    static_cast<double>(spacings.Boundary.size());
}

/**
 * How many new points, one spacing apart, can be beside each edge of the boundary: one where it
 * asks for its length. Else the spacing grows along it from both ends, where it is s, as it does
 * into the hole: the integral of dx / (s + g x) up to the middle of a length L, with g =
 * SpacingGrowth, is log(1 + g L / 2 s) / g.
 * @param[in] along  at the origin of each edge, as SpacingsAlong()
 */
std::vector<double> PlacesAlong(const Holes& holes, Index hole, const EdgeLengths& lengths,
  const EdgeLengths& spacings, const std::vector<double>& along)
{
  std::vector<double> places;
  places.reserve(lengths.Boundary.size());
  std::size_t begin = 0;
  for (Index loop = holes.Offsets[hole]; loop < holes.Offsets[hole + 1]; ++loop)
  {
    const std::size_t end = begin + holes.Walks.Size(holes.Loops[loop]);
    for (std::size_t i = begin; i < end; ++i)
    {
      const double length = lengths.Boundary[i];
      const auto upToMiddle = [&](double spacing) {
        return std::log1p(SpacingGrowth * 0.5 * length / spacing) / SpacingGrowth;
      };
      const double next = along[i + 1 < end ? i + 1 : begin];
      places.push_back(spacings.Boundary[i] < length
          ? std::max(1.0, upToMiddle(along[i]) + upToMiddle(next))
          : length / spacings.Boundary[i]);
    }
    begin = end;
  }
  return places;
}

/**
 * About how many graded points there will be, which does not grow with the distance of lines. As
 * the spacing grows with the distance from an edge, there are 1 / SpacingGrowth points at each of
 * its sides for each place along it; and around a lone point as many as the integral over rings
 * gives. Far from all of these, the spacing is the largest.
 */
double GradedPoints(const EdgeLengths& lengths, const EdgeLengths& spacings,
  const std::vector<double>& places, double area, double mean, double largest)
{
  constexpr double perSide = 1.0 / SpacingGrowth;
  // Around a point the spacing at distance r is m + g r, with g = SpacingGrowth, and a ring of
  // width dr has 2 pi r dr / (m + g r)^2 points; up to the size of the hole, this is about 2 pi /
  // g^2 times the logarithm of 1 + g r / m. Beside an edge the integral of dr / (m + g r)^2 over r
  // is 1 / (g m).
  const double reach = SpacingGrowth * std::sqrt(area) / mean;
  const double perPoint = 6.3 / (SpacingGrowth * SpacingGrowth) * std::log1p(reach);
  double points = area / largest / largest / RowHeight;
  points += perSide * std::accumulate(places.begin(), places.end(), 0.0);
  for (std::size_t i = 0; i < lengths.Inner.size(); ++i)
  {
    const double length = lengths.Inner[i];
    points += length > 0.0 ? 2.0 * perSide * (length / spacings.Inner[i]) : perPoint;
  }
  return points;
}

/** Whether all known points of a hole are nodes, and the ends of its edges are different ones. */
bool IsOnLattice(const Mesh& mesh, const Holes& holes, Index hole, const Lattice& lattice)
{
  bool isOnLattice = true;
  const auto check = [&](Index a, Index b) {
    Point2 i, j;
    isOnLattice = isOnLattice && FindNode(lattice, mesh.PointOf(a), i) &&
      FindNode(lattice, mesh.PointOf(b), j) && (i != j || a == b);
  };
  holes.VisitEdges(hole, check);
  holes.VisitInnerEdges(hole, check);
  return isOnLattice;
}
} // namespace

PatchPlan PlanPatch(const Mesh& mesh, const VertexStars* stars, const Holes& holes, Index hole,
  double area, double spacing, const Lattice* lattice, LengthsOfSurface* surface,
  const Progress& progress)
{
  PatchPlan plan;
  const EdgeLengths lengths = MeasureEdges(mesh, holes, hole);
  const double perimeter = std::accumulate(lengths.Boundary.begin(), lengths.Boundary.end(), 0.0);
  const double length = std::accumulate(lengths.Inner.begin(), lengths.Inner.end(), perimeter);
  const double edges = static_cast<double>(lengths.Boundary.size() + lengths.Inner.size());
  // Twice the area over the perimeter: the width of a long strip.
  EdgeLengths spacings = EdgeSpacings(holes, hole, lengths, 2.0 * area / perimeter);
  const auto setSpacing = [&](double value) {
    plan.Spacing = value;
    plan.MostRows = length / value - edges;
    // One point for each cell of a spacing times the height of a row.
    plan.ExpectedPoints = plan.MostPoints = area / value / value / RowHeight;
  };
  if (spacing > 0.0)
  {
    setSpacing(spacing);
    return plan;
  }
  setSpacing(MeanSpacing(holes, hole, lengths, spacings));
  if (lattice && IsOnLattice(mesh, holes, hole, *lattice) &&
    MedianTriangleArea(mesh, *stars, holes, hole) <= LargestCellsPerTriangle * lattice->Area())
  {
    plan.Kind = Arrangement::Nodes;
    plan.Steps = *lattice;
    plan.ExpectedPoints = plan.MostPoints = area / lattice->Area();
    return plan;
  }
  // Along lines the surface is denser than between them, where the gaps decide.
  if (surface && !holes.IsOfLines(hole) &&
    (holes.IsRegion(hole) || HasRoomIfDense(holes, hole, lengths.Boundary, area)))
  {
    plan.IsDenser = MatchDensity(*surface, holes, hole, progress, spacings);
    setSpacing(MeanSpacing(holes, hole, lengths, spacings));
  }
  // Holes for only a few points may need one more for refinement.
  constexpr double morePerEdge = 0.125;
  // An edge that is longer than its spacing has several points beside it.
  plan.MostPoints += morePerEdge *
    std::inner_product(lengths.Boundary.begin(), lengths.Boundary.end(), spacings.Boundary.begin(),
      static_cast<double>(lengths.Inner.size()), std::plus<double>(),
      [](double ofEdge, double wanted) { return std::max(1.0, ofEdge / wanted); });

  // Graded, if spacings differ enough.
  plan.Spacings = SpacingsAlong(holes, hole, spacings.Boundary);
  AddInnerSpacings(holes, hole, spacings.Inner, plan.Spacing, plan.Spacings);
  const auto range = std::minmax_element(plan.Spacings.begin(), plan.Spacings.end());
  if (*range.second > LargestSpacingRatio * *range.first)
  {
    // More points are near parts of the boundary that are finer than average.
    constexpr double morePerEdgeWhenGraded = 8.0;
    plan.Kind = Arrangement::Graded;
    const std::vector<double> places = PlacesAlong(holes, hole, lengths, spacings, plan.Spacings);
    plan.MostPoints += morePerEdgeWhenGraded *
      std::accumulate(places.begin(), places.end(), static_cast<double>(lengths.Inner.size()),
        [](double sum, double ofEdge) { return sum + std::max(1.0, ofEdge); });
    const double points =
      GradedPoints(lengths, spacings, places, area, plan.Spacing, *range.second);
    if (holes.IsRegion(hole))
    {
      plan.MostPoints = std::min(plan.MostPoints, 2.0 * points); // to be safe
    }
    plan.ExpectedPoints = std::min(plan.MostPoints, points);
  }
  else
  {
    plan.Spacings = std::vector<double>();
  }
  return plan;
}

double PointSpacing(double area, double points)
{
  return std::sqrt(area / RowHeight / points);
}

bool FindNode(const Lattice& lattice, const Point2& p, Point2& node)
{
  const auto [i, j] = lattice.InSteps(p);
  node = { std::round(i), std::round(j) };
  constexpr double largest = 1e9; // rows are counted by Index
  return std::fabs(i - node.X) <= LatticeTolerance && std::fabs(j - node.Y) <= LatticeTolerance &&
    std::fabs(node.X) < largest && std::fabs(node.Y) < largest;
}

} // namespace elevation
