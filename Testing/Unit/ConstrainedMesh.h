// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points and pieces of a constrained triangulation, as tests check them.
 */
#ifndef testing_ConstrainedMesh_h
#define testing_ConstrainedMesh_h

#include "PointSets.h"

#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Mesh/RecoverSegments.h"

#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace testing_points
{

/** The input's points and those added. */
inline Cloud AllPoints(const Cloud& cloud, const elevation::ConstrainedTriangulation& constrained)
{
  Cloud all = cloud;
  for (const elevation::AddedPoint& point : constrained.Added)
  {
    all.Add(point.Position.X, point.Position.Y, point.Elevation);
  }
  return all;
}

/**
 * One flag a half-edge: whether a piece runs along it. Does not use the code that recovers.
 * @param[out] failure  names the first piece that is no chain of edges; empty: all are
 */
inline std::vector<char> MarkPieces(const elevation::Mesh& mesh,
  const std::vector<elevation::Segment>& pieces, std::string& failure)
{
  std::vector<char> flags(mesh.Triangles.size(), 0);
  elevation::VertexStars stars(mesh);
  for (const elevation::Segment& piece : pieces)
  {
    for (elevation::Index v = piece.A; v != piece.B;)
    {
      const elevation::SegmentStep step = StepAlong(mesh, stars, v, piece.B);
      if (step.HalfEdge == elevation::None)
      {
        failure = NameOf(mesh, piece.A) + " to " + NameOf(mesh, piece.B) +
          " is no chain of edges at " + NameOf(mesh, v);
        return flags;
      }
      flags[step.HalfEdge] = 1;
      if (!mesh.IsBorder(step.HalfEdge))
      {
        flags[mesh.Twin(step.HalfEdge)] = 1;
      }
      v = step.Vertex;
    }
  }
  return flags;
}

/** The positions of the ends of each piece, the lower one first. */
inline std::multiset<std::array<double, 4>> PiecePositions(
  const Cloud& cloud, const elevation::ConstrainedTriangulation& constrained)
{
  const Cloud all = AllPoints(cloud, constrained);
  std::multiset<std::array<double, 4>> positions;
  for (const elevation::Segment& piece : constrained.Pieces)
  {
    elevation::Point2 a = all.View().At(piece.A), b = all.View().At(piece.B);
    if (IsLower(b, a))
    {
      std::swap(a, b);
    }
    positions.insert({ a.X, a.Y, b.X, b.Y });
  }
  return positions;
}

} // namespace testing_points

#endif
