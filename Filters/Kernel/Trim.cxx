// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Trim.h"

#include "Constraints.h"

#include <algorithm>
#include <string>

namespace elevation
{

namespace
{

std::vector<Segment> SegmentsOf(const Rings& rings)
{
  std::vector<Segment> segments;
  segments.reserve(rings.Vertices.size());
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    const Index size = rings.Size(ring);
    const Index* vertices = rings.Begin(ring);
    for (Index i = 0; i < size; ++i)
    {
      segments.push_back({ vertices[i], vertices[i + 1 == size ? 0 : i + 1] });
    }
  }
  return segments;
}

/** One flag a half-edge: whether the segments run along its edge an odd number of times. */
std::vector<char> MarkEdges(
  const Mesh& mesh, const std::vector<Segment>& segments, const Progress& progress)
{
  const Fans fans(mesh, Part(progress, 0.0, 0.5));
  const Progress marking = Part(progress, 0.5, 1.0);
  std::vector<char> isOdd(mesh.Triangles.size(), 0);
  std::size_t done = 0;
  for (const Segment& segment : segments)
  {
    ReportStep(marking, done++, segments.size());
    Index vertex = segment.A;
    while (vertex != segment.B)
    {
      const SegmentStep step = StepAlong(mesh, fans, vertex, segment.B);
      if (step.HalfEdge == None)
      {
        throw Error("The boundary's edge from " + NameOf(mesh.Points, segment.A) + " to " +
          NameOf(mesh.Points, segment.B) +
          " is not an edge of the mesh. Turn RecoverBoundary on, or triangulate with it.");
      }
      isOdd[step.HalfEdge] ^= 1;
      if (!mesh.IsBorder(step.HalfEdge))
      {
        isOdd[mesh.Twin(step.HalfEdge)] ^= 1;
      }
      vertex = step.Vertex;
    }
  }
  return isOdd;
}

} // namespace

TrimResult Trim(Mesh& mesh, const Rings& boundary, const TrimOptions& options)
{
  const Index count = mesh.NumberOfTriangles();
  const std::vector<Segment> segments = SegmentsOf(boundary);
  TrimResult result;
  Report(options.Monitor, 0.0);
  if (options.RecoverBoundary)
  {
    std::vector<char> constrained;
    result.NumberOfRecoveredEdges =
      RecoverSegments(mesh, segments, constrained, Part(options.Monitor, 0.0, 0.4));
  }
  const std::vector<char> isOdd = MarkEdges(mesh, segments, Part(options.Monitor, 0.4, 0.6));

  const RingLocator locator(mesh.Points, boundary);
  constexpr char unknown = 2;
  result.IsOutward.assign(count, unknown);
  const Progress walking = Part(options.Monitor, 0.6, 1.0);
  std::vector<Index> next;
  Index done = 0;
  for (Index seed = 0; seed < count; ++seed)
  {
    if (result.IsOutward[seed] != unknown)
    {
      continue;
    }
    const bool isInside = locator.IsInside(mesh.PointOf(mesh.Origin(3 * seed)),
      mesh.PointOf(mesh.Origin(3 * seed + 1)), mesh.PointOf(mesh.Origin(3 * seed + 2)));
    result.IsOutward[seed] = !isInside;
    next.assign(1, seed);
    while (!next.empty())
    {
      const Index t = next.back();
      next.pop_back();
      result.NumberOfOutwardTriangles += result.IsOutward[t];
      ReportStep(walking, ++done, count);
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        const Index other = mesh.IsBorder(h) ? None : Mesh::Triangle(mesh.Twin(h));
        if (other != None && result.IsOutward[other] == unknown)
        {
          result.IsOutward[other] = result.IsOutward[t] ^ isOdd[h];
          next.push_back(other);
        }
      }
    }
  }
  if (count > 0 && result.NumberOfOutwardTriangles == count)
  {
    throw Error("The boundary encloses no triangle of the mesh.");
  }
  Report(options.Monitor, 1.0);
  return result;
}

} // namespace elevation
