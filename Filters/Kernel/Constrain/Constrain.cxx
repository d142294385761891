// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Constrain.h"

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Simplify/Simplify.h"
#include "Kernel/Triangulate/Triangulate.h"

#include <algorithm>
#include <array>
#include <vector>

namespace elevation
{
namespace
{

/**
 * Input points and added ones in one array; empty if nothing is added. Ids of input points stay, so
 * triangles need no translation.
 */
Buffer<double> JoinPoints(
  const PointView& points, const std::vector<AddedPoint>& added, const Progress& progress)
{
  Buffer<double> joined;
  if (added.empty())
  {
    return joined;
  }
  joined.Resize(3 * (static_cast<std::size_t>(points.Count) + added.size()));
  double* out = joined.data();
  const auto append = [&](const Point2& p, double elevation) {
    for (const double value : { p.X, p.Y, elevation })
    {
      *out++ = value;
    }
  };
  ForEachNumber(
    points.Count, progress, [&](Index id) { append(points.At(id), points.Elevation(id)); });
  for (const AddedPoint& point : added)
  {
    append(point.Position, point.Elevation);
  }
  return joined;
}

/**
 * A triangle, its lowest vertex first. Also as a view of three ids in a list of triangles.
 */
using Corners = std::array<Index, 3>;

/** The order of Triangulate.h: by lowest vertex, then counter-clockwise around it. */
bool ComesBefore(const std::vector<Point2>& points, const Corners& p, const Corners& q)
{
  return p[0] != q[0] ? IsLower(points[p[0]], points[q[0]])
                      : Orientation(points[p[0]], points[p[1]], points[q[1]]) == Positive;
}

/**
 * Replaces triangles by those of the mesh, of which few are others, in the same order: those that
 * have not changed keep their order and close up, the changed ones are sorted behind them, and both
 * are merged. So the cost is that of the changed ones, and a pass.
 */
void SortInChanged(const Mesh& mesh, Buffer<Index>& triangles, const Progress& progress)
{
  Stages stages(progress, { 30, 30, 40 });
  Corners* const all = reinterpret_cast<Corners*>(triangles.data());
  Corners* kept = all; // the end of those that have not changed
  std::vector<Corners> changed;
  const Index count = mesh.NumberOfTriangles();
  ForEachNumber(count, stages.Next(), [&](Index t) {
    Corners corners{ mesh.Triangles[3 * t], mesh.Triangles[3 * t + 1], mesh.Triangles[3 * t + 2] };
    // Recovery writes into the slots of triangles that it has taken out, so others are at their
    // places.
    if (corners == all[t])
    {
      *kept++ = corners;
      return;
    }
    std::rotate(corners.begin(),
      std::min_element(corners.begin(), corners.end(),
        [&](Index v, Index w) { return IsLower(mesh.PointOf(v), mesh.PointOf(w)); }),
      corners.end());
    changed.push_back(corners);
  });
  const auto comesBefore = [&](const Corners& p, const Corners& q) {
    return ComesBefore(mesh.Points, p, q);
  };
  Sort(changed.begin(), changed.end(), comesBefore, stages.Next());
  std::copy(changed.begin(), changed.end(), kept);
  WorkReporter work(stages.Next());
  std::inplace_merge(all, kept, all + count, [&](const Corners& p, const Corners& q) {
    work.Tick();
    return comesBefore(p, q);
  });
}

} // namespace

ConstrainedTriangulation TriangulateConstrained(
  const PointView& points, const ConstraintLines& lines, const DelaunayOptions& asked)
{
  ConstrainedTriangulation constrained;
  Triangulation& result = constrained.Result;
  const Progress& progress = asked.Monitor;
  Stages stages(progress, { 17, 3, 80 });
  // By the input points; the vertices that lines add get ids behind theirs.
  static_cast<LinePieces&>(constrained) = CutLines(points, lines, asked.Duplicates, stages.Next());
  if (constrained.AreNone)
  {
    result = Triangulate(points, asked);
    return constrained;
  }
  // Doubles, also where the input is float: crossings are rounded to doubles.
  const Buffer<double> joined = JoinPoints(points, constrained.Added, stages.Next());
  PointView all = points;
  if (!joined.empty())
  {
    all.Float = nullptr;
    all.Double = joined.data();
    all.Count += static_cast<Index>(constrained.Added.size());
  }

  DelaunayOptions options = asked;
  options.Monitor = stages.Next();
  // The points of lines are on no nodes.
  options.UseLattice = LatticeMode::Off;
  options.MaximumEdgeLength = 0.0; // recovery needs all triangles
  if (options.IsSimplified())
  {
    // Which makes the edges itself, as it chooses the points. A limit on edges is not set then.
    result = TriangulateFew(all, options, constrained.Pieces);
    return constrained;
  }
  Stages later(options.Monitor, { 50, 2, 23, 19, 5, 1 });
  options.Monitor = later.Next();
  result = Triangulate(all, options);
  if (result.Triangles.empty())
  {
    return constrained;
  }
  Mesh mesh;
  mesh.Points.resize(all.Count);
  ForEachNumber(all.Count, later.Next(), [&](Index id) { mesh.Points[id] = all.At(id); });
  mesh.Triangles.assign(result.Triangles.begin(), result.Triangles.end());
  mesh.ConnectTwins(0, later.Next());
  std::vector<char> flags;
  // Most pieces are edges already, where lines follow the points.
  const Index missing = RecoverSegments(mesh, constrained.Pieces, flags, later.Next());
  const Progress sorting = later.Next();
  if (missing > 0)
  {
    SortInChanged(mesh, result.Triangles, sorting);
  }
  LeaveOutLong(all, asked.MaximumEdgeLength, result.Triangles, later.Next());
  Report(progress, 1.0);
  return constrained;
}

} // namespace elevation
