// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "TriangulateNodes.h"

#include "DivideAndConquer.h"
#include "LatticeGrowth.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

namespace elevation
{

namespace
{
/** A point by its node, column and row, and its index in a piece. */
struct PlacedNode
{
  LatticeNode Node;
  Index Point;
};

/** @throws NotOnLattice if a point is on no node */
std::vector<PlacedNode> FindNodes(const PointView& points, const SharedLattice& lattice,
  std::vector<Index>& notFinite, const Progress& progress)
{
  std::vector<PlacedNode> placed;
  for (const Index id : Counted(points.Count))
  {
    ReportStep(progress, id, points.Count);
    if (!points.IsFinite(id))
    {
      notFinite.push_back(id);
      continue;
    }
    placed.push_back({ lattice.NodeOf(points.At(id)), id });
  }
  return placed;
}

/**
 * Sorts nodes from the lowest up, and keeps one point on each.
 * @throws NotOnLattice when two points are on a node that are not equal
 */
void KeepOneOnEach(const PointView& points, DuplicatePolicy policy, std::vector<PlacedNode>& placed,
  std::vector<Index>& duplicates, const Progress& progress)
{
  const auto isSame = [](const PlacedNode& p, const PlacedNode& q) {
    return p.Node.I == q.Node.I && p.Node.J == q.Node.J;
  };
  Sort(
    placed.begin(), placed.end(),
    [&](const PlacedNode& p, const PlacedNode& q) {
      return isSame(p, q) ? IsPreferred(points, policy, p.Point, q.Point)
                          : std::tie(p.Node.J, p.Node.I) < std::tie(q.Node.J, q.Node.I);
    },
    progress);
  std::size_t kept = 0;
  for (std::size_t i = 1; i < placed.size(); ++i)
  {
    // Equal nodes are adjacent, with the one that the policy prefers first.
    if (!isSame(placed[kept], placed[i]))
    {
      placed[++kept] = placed[i];
      continue;
    }
    if (points.At(placed[kept].Point) != points.At(placed[i].Point))
    {
      throw NotOnLattice();
    }
    duplicates.push_back(placed[i].Point);
  }
  placed.resize(std::min(placed.size(), kept + 1));
  std::sort(duplicates.begin(), duplicates.end());
}

/** By divide and conquer, which minds no wide gaps between points. */
Triangulation TriangulateSparse(
  const PointView& points, const SharedLattice& lattice, const DelaunayOptions& options)
{
  Stages stages(options.Monitor, { 10, 10, 80 });
  Triangulation result;
  std::vector<Index> notFinite, duplicates;
  std::vector<PlacedNode> placed = FindNodes(points, lattice, notFinite, stages.Next());
  KeepOneOnEach(points, options.Duplicates, placed, duplicates, stages.Next());
  result.LatticeFound = true;
  result.Steps = lattice.Steps();
  SetUnusedPoints(std::move(duplicates), notFinite, Progress(), result);
  if (placed.empty())
  {
    return result;
  }
  // Relative to the lowest node, offsets are small: nodes of a shared lattice have 64 bits, and
  // doubles hold them exactly only up to 2^53.
  const LatticeNode lowest = placed.front().Node;
  // As of a lattice that growth has placed: its origin is the lowest occupied node.
  result.Steps.Origin =
    result.Steps.Node(static_cast<double>(lowest.I), static_cast<double>(lowest.J));
  Buffer<Point2> nodes;
  nodes.Reserve(placed.size());
  for (const PlacedNode& one : placed)
  {
    nodes.Append(
      { static_cast<double>(one.Node.I - lowest.I), static_cast<double>(one.Node.J - lowest.J) });
  }
  result.Triangles = DivideAndConquer(nodes, stages.Next(), &lattice.Metric());
  // Without a triangle there is no border.
  if (!result.Triangles.empty())
  {
    Buffer<Index> all;
    all.Resize(nodes.size());
    std::iota(all.begin(), all.end(), Index(0));
    const auto turn = [&nodes](Index p, Index q, Index r) {
      return Orientation(nodes[p], nodes[q], nodes[r]);
    };
    SetHullPoints(
      FindHull(all, turn, Progress()), [&placed](Index node) { return placed[node].Point; },
      result);
  }
  for (Index& corner : result.Triangles)
  {
    corner = placed[corner].Point;
  }
  return result;
}

/**
 * A given lattice is an order of the user, so a flat triangle is an error here, whereas a lattice
 * that was found is dropped.
 * @throws NotOnLattice if a triangle is flat or inverted in the coordinates of its points
 */
void CheckTriangles(const PointView& points, const Buffer<Index>& triangles)
{
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    const Index* const corners = triangles.data() + i;
    if (Orientation(points.At(corners[0]), points.At(corners[1]), points.At(corners[2])) !=
      Positive)
    {
      throw NotOnLattice();
    }
  }
}
} // namespace

Triangulation TriangulateNodes(const PointView& points, const SharedLattice& lattice,
  const DelaunayOptions& options, bool isFilled)
{
  // If the bitmap would be too large or the points do not fit it, the sparse way decides.
  if (isFilled)
  {
    LatticeSearch search;
    // Of these points alone: the bitmap need not hold the nodes of other pieces.
    static_cast<Extent&>(search) = FindExtent(
      points, ThreadsAtOnce(options.NumberOfThreads), Progress(), [](Index, const Point2&) {});
    search.Found = true;
    search.Steps = lattice.Steps();
    DelaunayOptions onLattice = options;
    // That of the whole cloud, with which the lattice was found.
    onLattice.LatticeTolerance = lattice.Tolerance();
    Triangulation result;
    if (TriangulateOnLattice(points, search, onLattice, result))
    {
      return result;
    }
  }
  return TriangulateSparse(points, lattice, options);
}

Triangulation TriangulateOnGivenLattice(const PointView& points, const DelaunayOptions& options)
{
  Stages stages(options.Monitor, { 15, 85, 0 });
  const double tolerance = options.ToleranceInSteps();
  const LatticeSearch search = GivenLattice(
    points, options.GivenLattice, tolerance, ThreadsAtOnce(options.NumberOfThreads), stages.Next());
  // The nodes' range is needed first: a lattice with more columns and rows than 32 bits is refused.
  const NodeFinder nodeOf(search.Steps);
  const NodeBox nodes = FindNodeBox(nodeOf, search, search.Steps, [&]() {
    NodeBox box;
    ForEachPoint(points, 0, points.Count, search.NotFinite,
      [&](Index, const Point2& p) { nodeOf.Extend(box, p); });
    return box;
  });
  SharedLattice lattice;
  const bool hasPoints = static_cast<std::size_t>(points.Count) > search.NotFinite.size();
  if (hasPoints && !lattice.Set(search.Steps, search, nodes, tolerance))
  {
    throw GivenLatticeTooLarge();
  }
  DelaunayOptions onLattice = options;
  onLattice.Monitor = stages.Next();
  try
  {
    Triangulation result;
    if (!TriangulateOnLattice(points, search, onLattice, result))
    {
      result = TriangulateSparse(points, lattice, onLattice);
    }
    result.LatticeFound = hasPoints; // a part without points says nothing of those of others
    CheckTriangles(points, result.Triangles);
    // Growth has done it already; divide and conquer does not know the limit.
    LeaveOutLong(points, options.MaximumEdgeLength, result.Triangles, stages.Next());
    Report(options.Monitor, 1.0);
    return result;
  }
  catch (const NotOnLattice&)
  {
    throw GivenLatticeUnfit();
  }
}

} // namespace elevation
