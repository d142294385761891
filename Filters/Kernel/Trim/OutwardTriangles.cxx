// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutwardTriangles.h"

#include "CutAlongRings.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "Rings.h"

namespace elevation
{

namespace
{

/**
 * The edges of rings inside the mesh, in an order that depends on their positions alone: where the
 * mesh is not Delaunay, the result depends on the order of recovery.
 */
std::vector<Segment> SegmentsOf(
  const Mesh& mesh, VertexStars& stars, const Rings& rings, const Progress& progress)
{
  Stages stages(progress, { 50, 50 });
  const Progress listing = stages.Next();
  std::vector<Segment> segments;
  segments.reserve(rings.Vertices.size());
  for (const std::size_t i : Counted(rings.Vertices.size()))
  {
    ReportStep(listing, i, rings.Vertices.size(), 256);
    // After InsertRings() an edge is inside at both ends or at none. Without recovery an edge may
    // leave the mesh on its way, or end at a hole, which is refused here.
    const Segment segment{ rings.Vertices[i], rings.Vertices[rings.After(static_cast<Index>(i))] };
    const bool isInside = BeginsInside(mesh, stars, segment.A, segment.B);
    if (isInside != BeginsInside(mesh, stars, segment.B, segment.A))
    {
      RefuseLeaving(mesh, segment);
    }
    if (isInside)
    {
      // Upwards, whichever way a ring runs, so that two rings along one edge give the same segment.
      const bool isUp = IsLower(mesh.PointOf(segment.A), mesh.PointOf(segment.B));
      segments.push_back(isUp ? segment : Segment{ segment.B, segment.A });
    }
  }
  Sort(
    segments.begin(), segments.end(),
    [&mesh](const Segment& s, const Segment& t) { return IsLower(mesh, s, t); }, stages.Next());
  return segments;
}

/**
 * Sets one flag per half-edge: whether the segments run along its edge an odd number of times.
 */
void MarkEdges(const Mesh& mesh, VertexStars& stars, const std::vector<Segment>& segments,
  std::vector<char>& isOdd, const Progress& progress)
{
  isOdd.assign(mesh.Triangles.size(), 0);
  std::size_t done = 0;
  for (const Segment& segment : Counted(segments))
  {
    // Along a segment that was cut there are several edges, one after the other.
    ReportStep(progress, done++, segments.size(), 256);
    Index vertex = segment.A;
    while (vertex != segment.B)
    {
      const SegmentStep step = StepAlong(mesh, stars, vertex, segment.B);
      if (step.HalfEdge == None)
      {
        throw Error("The boundary's edge from " + NameOf(mesh, segment.A) + " to " +
          NameOf(mesh, segment.B) +
          " is not an edge of the mesh. Turn RecoverBoundary on, or triangulate with it.");
      }
      // Both half-edges, so that the labels below change whichever side they come from. An edge
      // that two rings share is even again.
      isOdd[step.HalfEdge] ^= 1;
      if (!mesh.IsBorder(step.HalfEdge))
      {
        isOdd[mesh.Twin(step.HalfEdge)] ^= 1;
      }
      vertex = step.Vertex;
    }
  }
}

} // namespace

OutwardTriangles FindOutward(
  Mesh& mesh, const Rings& boundary, bool recover, const Progress& progress)
{
  Stages stages(progress, { 35, 5, 10, 10, 30, 10 });
  OutwardTriangles result;
  Report(progress, 0.0);
  VertexStars stars(mesh, stages.Next());
  const std::vector<Segment> segments = SegmentsOf(mesh, stars, boundary, stages.Next());
  const Progress recovering = stages.Next();
  std::vector<char>& isOnBoundary = result.IsOnBoundary;
  if (recover)
  {
    result.NumberOfRecoveredEdges =
      RecoverSegments(mesh, stars, segments, isOnBoundary, recovering);
  }
  // Recovery has marked each edge of the rings once. What counts is how often: an edge of two is
  // none.
  MarkEdges(mesh, stars, segments, isOnBoundary, stages.Next());

  // Within a component, crossing an odd edge changes sides; so two labels for each component, and a
  // location of one of its triangles, give the side of all. Where the mesh has several components
  // that rings separate, each has its own location.
  const RingLocator locator(mesh.Points, boundary);
  const Components components = FindComponents(
    mesh, stages.Next(), [&isOnBoundary](Index h) { return static_cast<int>(isOnBoundary[h]); });
  std::vector<char> isOutward; // one per label
  for (const Index t : components.Lowest)
  {
    const bool isInside = locator.IsInside(mesh.PointOf(mesh.Origin(3 * t)),
      mesh.PointOf(mesh.Origin(3 * t + 1)), mesh.PointOf(mesh.Origin(3 * t + 2)));
    isOutward.push_back(!isInside);
    isOutward.push_back(isInside);
  }
  const Index count = mesh.NumberOfTriangles();
  result.IsOutward.resize(count);
  ForEachNumber(
    count, stages.Next(), [&](Index t) { result.IsOutward[t] = isOutward[components.Labels[t]]; });
  Report(progress, 1.0);
  return result;
}

//        p3                The walk comes along p1 p2 and goes on along p2 p3, surface on the
//       .  ^               right. Triangle p1 p2 p3 is on the left of both edges. When it is taken,
//     .   t  \             p1 p3 replaces the two, and the triangle beyond p1 p3 has one edge more
//   p1 ----> p2            on the walk.
void ApplyInwardNormalTest(const Mesh& mesh, const std::vector<char>& isOnBoundary,
  std::vector<char>& isOutward, const Progress& progress)
{
  Stages stages(progress, { 50, 50 });
  // A walk with the surface on the right has outward triangles on its left. Two edges of such a
  // triangle are consecutive on the walk if and only if the triangle is on the left of both, as
  // nothing else fits into its corner. So instead of the walk, it is enough to count how many edges
  // of each triangle are on it.
  // Above 2, so that the count never becomes 2 again.
  constexpr char isTaken = 4;
  std::vector<char> edges(isOutward.size(), 0);
  std::vector<Index> taken;
  const auto walkAlong = [&](Index h) {
    const Index t = Mesh::Triangle(h);
    if (isOutward[t] && ++edges[t] == 2)
    {
      taken.push_back(t);
    }
  };
  ForEachNumber(mesh.NumberOfHalfEdges(), stages.Next(), [&](Index h) {
    if (isOnBoundary[h])
    {
      walkAlong(h);
    }
  });
  const Progress walking = stages.Next();
  StepCount done;
  while (!taken.empty())
  {
    ReportStep(walking, done.Count(), isOutward.size());
    done.Add();
    const Index t = taken.back();
    taken.pop_back();
    edges[t] = isTaken;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      // The walk continues along the third edge, with the triangle beyond it on the left. That one
      // is outward unless the edge is on the boundary.
      const Index twin = mesh.Twin(h);
      // Beyond the two edges that it was taken for, triangles are inside or taken already.
      if (twin != Mesh::Border && edges[Mesh::Triangle(twin)] < 2)
      {
        walkAlong(twin);
      }
    }
  }
  for (std::size_t t = 0; t < isOutward.size(); ++t)
  {
    isOutward[t] = edges[t] >= 2;
  }
}

} // namespace elevation
