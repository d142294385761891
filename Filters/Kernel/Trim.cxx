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

/**
 * Sets one flag a half-edge: whether the segments run along its edge an odd number of times.
 */
void MarkEdges(const Mesh& mesh, const Fans& fans, const std::vector<Segment>& segments,
  std::vector<char>& isOdd, const Progress& progress)
{
  isOdd.assign(mesh.Triangles.size(), 0);
  std::size_t done = 0;
  for (const Segment& segment : segments)
  {
    ReportStep(progress, done++, segments.size());
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
}

} // namespace

TrimResult Trim(Mesh& mesh, const Rings& boundary, const TrimOptions& options)
{
  const Index count = mesh.NumberOfTriangles();
  const std::vector<Segment> segments = SegmentsOf(boundary);
  TrimResult result;
  Report(options.Monitor, 0.0);
  Fans fans(mesh, Part(options.Monitor, 0.0, 0.4));
  std::vector<char> flags;
  if (options.RecoverBoundary)
  {
    result.NumberOfRecoveredEdges =
      RecoverSegments(mesh, fans, segments, flags, Part(options.Monitor, 0.4, 0.5));
  }
  MarkEdges(mesh, fans, segments, flags, Part(options.Monitor, 0.5, 0.6));

  const RingLocator locator(mesh.Points, boundary);
  const Parts parts = FindParts(mesh, Part(options.Monitor, 0.6, 0.95),
    [&flags](Index h) { return static_cast<int>(flags[h]); });
  std::vector<char> isOutward; // one a label
  for (const Index t : parts.Lowest)
  {
    const bool isInside = locator.IsInside(mesh.PointOf(mesh.Origin(3 * t)),
      mesh.PointOf(mesh.Origin(3 * t + 1)), mesh.PointOf(mesh.Origin(3 * t + 2)));
    isOutward.push_back(!isInside);
    isOutward.push_back(isInside);
  }
  result.IsOutward.resize(count);
  InStretches(count, Part(options.Monitor, 0.95, 1.0), [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t)
    {
      result.IsOutward[t] = isOutward[parts.Labels[t]];
      result.NumberOfOutwardTriangles += result.IsOutward[t];
    }
  });
  if (count > 0 && result.NumberOfOutwardTriangles == count)
  {
    throw Error("The boundary encloses no triangle of the mesh.");
  }
  Report(options.Monitor, 1.0);
  return result;
}

} // namespace elevation
