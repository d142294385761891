// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Cuts triangles of a mesh at new vertices, in place, and keeps where in the triangles before each
 * vertex lies, and which of them each part is of. No edge is flipped.
 */
#ifndef elevation_Trim_MeshCutter_h
#define elevation_Trim_MeshCutter_h

#include "Kernel/Mesh/Mesh.h"

#include <array>
#include <unordered_map>
#include <utility>
#include <vector>

namespace elevation
{

/** Where a new vertex lies: the sum of its weights, each times a corner of one triangle before. */
struct InsertedVertex
{
  Index Corners[3];
  double Weights[3]; ///< 0 to 1, 1 together; 0 for what is not on the edge that the vertex is on
};

/** Cuts one mesh again and again; constant time each. Vertices and parts come last. */
class MeshCutter
{
public:
  /**
   * @param[in,out] mesh      with Twins
   * @param[out]    inserted  one a vertex after those before
   * @param[out]    parents   one a triangle after those before: whose part it is
   */
  MeshCutter(Mesh& mesh, std::vector<InsertedVertex>& inserted, std::vector<Index>& parents)
    : Surface(mesh)
    , Inserted(inserted)
    , Parents(parents)
    , CountBefore(mesh.NumberOfPoints())
    , TrianglesBefore(mesh.NumberOfTriangles())
  {
  }

  /** Whether the vertex was there before. */
  bool IsGiven(Index vertex) const { return vertex < this->CountBefore; }

  std::array<Point2, 3> CornersOf(Index t) const;

  /** Whether the point is in the triangle or on an edge of it. */
  bool Holds(Index t, const Point2& p) const;

  /** The weights of a place in a triangle, of which corners may be new vertices themselves. */
  InsertedVertex WeightsIn(Index t, const Point2& p) const;

  /** The weights of a place on an edge, or so near that it is made one of it. */
  InsertedVertex WeightsBetween(Index a, Index b, const Point2& p) const;

  /** Of no triangle as yet. */
  Index AddVertex(const Point2& p, const InsertedVertex& inserted);

  /** Triangle abc becomes abv, and bcv and cav are new. */
  void CutTriangle(Index t, Index v);

  /** Cuts the triangles beside an edge. @return the half-edge from v to where h led */
  Index CutEdge(Index h, Index v);

  /** Whether the triangle of h leaves two triangles when its edge is led through the place. */
  bool CanCut(Index h, const Point2& place) const;

  /**
   * Moves a place on the border, within rounding, to where the triangle of h can be cut: rounded,
   * it may be beyond a thin triangle. Outwards is room where the apex is beside the place.
   * @return whether one was found
   */
  bool MoveToCut(Index h, Point2& place) const;

  /** The number that a half-edge of the border has after cuts; of its first part. */
  Index NowOf(Index h) const;

  /** From here on half-edges are numbered as they are. */
  void ForgetMoves() { this->Moved.clear(); }

private:
  /** Of vertices that may be new themselves, all on one triangle before, which has three corners. */
  InsertedVertex WeightsOf(const std::pair<Index, double>* shares, std::size_t count) const;

  /** Room for a part of a triangle. @return its first half-edge */
  Index AddPart(Index t);

  void SetEdge(Index h, Index origin, Index twin);

  /** Triangle abc with h from a to b becomes avc, and vbc is new; not connected along h. */
  Index Halve(Index h, Index v);

  Mesh& Surface;
  std::vector<InsertedVertex>& Inserted;
  std::vector<Index>& Parents;
  const Index CountBefore;
  const Index TrianglesBefore;
  std::unordered_map<Index, Index> Moved; ///< half-edges of the border that a cut renumbered
};

} // namespace elevation

#endif
