// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
//   row   ------[//////]x x x[////]------[///]x x x x x[/////]-----
//
//   [//] blocked: within the clearance of an edge     x  points are set     -  outside
//
// No exact arithmetic is needed: where rounding could decide, an edge is near and blocks.
#include "PointRows.h"

#include "Kernel/Messages/Messages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace elevation
{

namespace
{

/** Least distance of points from the boundary in spacings, and in lattice steps. */
constexpr double Clearance = 0.6;
constexpr double NodeClearance = 0.4;

/** A stretch of a row too near to a boundary edge, and whether the edge crosses the row. */
struct Blocked
{
  Index Row;
  double Begin;
  double End;
  bool Crosses;
};

/** Rows of points: point k of a row is at x = (k + shift) Step, y = row RowHeight. */
struct Rows
{
  double Step;
  double RowHeight;
  double OddRowShift; ///< in steps
  double Clearance;
};

/** The stretch of a row within the clearance of an edge from a up to b, or of a point a = b. */
Blocked BlockRow(const Rows& rows, Index row, const Point2& a, const Point2& b)
{
  const double clearance = rows.Clearance;
  const double length = Distance(a, b);
  const double ux = (b.X - a.X) / length;
  const double uy = (b.Y - a.Y) / length; // >= 0
  const double y = row * rows.RowHeight;
  // Half-open: a vertex on the row belongs to the edge below it or above it, once.
  Blocked stretch{ row, std::numeric_limits<double>::infinity(),
    -std::numeric_limits<double>::infinity(), (a.Y <= y) != (b.Y <= y) };
  const auto include = [&stretch](double begin, double end) {
    stretch.Begin = std::min(stretch.Begin, begin);
    stretch.End = std::max(stretch.End, end);
  };
  // The discs around both ends.
  for (const Point2& p : { a, b })
  {
    // The row at height y cuts a disc in a chord around the disc's centre.
    const double square = clearance * clearance - (y - p.Y) * (y - p.Y);
    if (square >= 0.0)
    {
      include(p.X - std::sqrt(square), p.X + std::sqrt(square));
    }
  }
  // The strip between them: its two sides, where the row cuts them. Of a point they are NaN.
  for (double side : { -clearance, clearance })
  {
    const double ay = a.Y + side * ux;
    const double by = b.Y + side * ux;
    if (ay < by && ay <= y && y <= by)
    {
      const double x = a.X - side * uy + (y - ay) / (by - ay) * (b.X - a.X);
      include(x, x);
    }
  }
  return stretch;
}

/** All blocked stretches, row by row from the left. Inner edges cross no row. */
std::vector<Blocked> BlockRows(
  const Rows& rows, const std::vector<Point2>& points, const Patch& patch, const Progress& progress)
{
  Stages stages(progress, { 70, 30 });
  const Progress blocking = stages.Next();
  std::vector<Blocked> blocked;
  StepCount visited;
  const std::size_t count = patch.Edges.size() + patch.InnerEdges.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    const bool isInner = i >= patch.Edges.size();
    const Segment& edge = isInner ? patch.InnerEdges[i - patch.Edges.size()] : patch.Edges[i];
    const bool isUpwards = points[edge.A].Y <= points[edge.B].Y;
    const Point2& a = points[isUpwards ? edge.A : edge.B];
    const Point2& b = points[isUpwards ? edge.B : edge.A];
    // Only rows that the edge, widened by the clearance, can meet.
    const double from = std::ceil((a.Y - rows.Clearance) / rows.RowHeight);
    const double to = std::floor((b.Y + rows.Clearance) / rows.RowHeight);
    for (Index row = static_cast<Index>(from); row <= static_cast<Index>(to); ++row)
    {
      // With a small spacing, a long edge is near many rows.
      visited.Add();
      if (visited.Count() % 16384 == 0)
      {
        Report(blocking, static_cast<double>(i) / static_cast<double>(count));
      }
      Blocked stretch = BlockRow(rows, row, a, b);
      stretch.Crosses = stretch.Crosses && !isInner;
      if (stretch.Begin <= stretch.End)
      {
        blocked.push_back(stretch);
      }
    }
  }
  Sort(
    blocked.begin(), blocked.end(),
    [](const Blocked& s, const Blocked& t) {
      return s.Row != t.Row ? s.Row < t.Row : s.Begin < t.Begin;
    },
    stages.Next());
  return blocked;
}

/**
 * Visits the points of rows that are inside the boundary, by at least the clearance, which they
 * also keep from inner edges. Each edge blocks the stretches of rows within the clearance. Between
 * blocked stretches a row is entirely inside the hole or outside, by the parity of the crossings
 * of boundary edges on the left.
 * @param[in] inRows  inRows(vertex): the place of a known vertex in the coordinates of the rows
 * @param[in] visit   visit(row, k), row after row
 */
template <typename InRows, typename Visitor>
void VisitRows(
  const Rows& rows, const Patch& patch, const Progress& progress, InRows&& inRows, Visitor&& visit)
{
  Stages stages(progress, { 60, 40 });
  std::vector<Point2> points(patch.NumberOfBoundaryVertices());
  for (Index v = 0; v < patch.NumberOfBoundaryVertices(); ++v)
  {
    points[v] = inRows(v);
  }
  std::vector<Blocked> blocked = BlockRows(rows, points, patch, stages.Next());
  const Progress placing = stages.Next();
  // From the left along each row: inside or not behind the stretches that have been passed.
  bool isInside = false;
  StepCount placed;
  for (std::size_t i = 0; i < blocked.size(); ++i)
  {
    if (i == 0 || blocked[i].Row != blocked[i - 1].Row)
    {
      isInside = false;
    }
    isInside = isInside != blocked[i].Crosses;
    if (i + 1 == blocked.size() || blocked[i + 1].Row != blocked[i].Row)
    {
      continue;
    }
    // A stretch may end within the one before; from here on the end is that of both.
    blocked[i + 1].End = std::max(blocked[i].End, blocked[i + 1].End);
    if (!isInside)
    {
      continue;
    }
    const Index row = blocked[i].Row;
    const double shift = row % 2 == 0 ? 0.0 : rows.OddRowShift;
    const double last = std::floor(blocked[i + 1].Begin / rows.Step - shift);
    for (double k = std::ceil(blocked[i].End / rows.Step - shift); k <= last; ++k)
    {
      placed.Add();
      if (placed.Count() % 16384 == 0)
      {
        Report(placing, static_cast<double>(i) / static_cast<double>(blocked.size()));
      }
      visit(row, k + shift);
    }
  }
}

} // namespace

void PlaceNodes(const PatchPlan& plan, const Progress& progress, Patch& patch)
{
  // Nodes are counted from one on the boundary, so that their numbers are small.
  Point2 first;
  FindNode(plan.Steps, patch.At(0), first);
  const auto inRows = [&](Index vertex) {
    Point2 node;
    FindNode(plan.Steps, patch.At(vertex), node);
    return Point2{ node.X - first.X, node.Y - first.Y };
  };
  // In numbers of nodes: the step and the height of a row are 1, whatever the shape of a cell.
  VisitRows({ 1.0, 1.0, 0.0, NodeClearance }, patch, progress, inRows, [&](Index row, double x) {
    const Point2 node{ first.X + x, first.Y + row };
    const Point2 p = plan.Rounded(plan.Steps.Node(node.X, node.Y));
    Point2 found;
    // Written back in the precision of the points, a node must still be found.
    if (!FindNode(plan.Steps, p, found) || found != node)
    {
      throw MakeError<sentences::SpacingTooSmall>(plan.Spacing);
    }
    patch.AddPoint(p);
  });
}

void PlaceEvenly(const PatchPlan& plan, const Progress& progress, Patch& patch)
{
  const Point2 center = patch.BoundaryBox().Center();
  const auto inRows = [&](Index vertex) {
    return Point2{ patch.At(vertex).X - center.X, patch.At(vertex).Y - center.Y };
  };
  const double d = plan.Spacing;
  VisitRows(
    { d, RowHeight * d, 0.5, Clearance * d }, patch, progress, inRows, [&](Index row, double x) {
      // Here and not before, because a patch without new points is no error.
      if (d < LeastStepsPerSpacing * plan.Precision)
      {
        throw MakeError<sentences::SpacingTooSmall>(d);
      }
      const Point2 p = plan.Rounded({ center.X + x * d, center.Y + row * (RowHeight * d) });
      patch.AddPoint(p);
    });
}

} // namespace elevation
