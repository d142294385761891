// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Cuts triangles of a mesh at new vertices, in place. Records the position of each new vertex in
 * the original triangles, and the original triangle of each part. No edge is flipped.
 *
 * Cost: constant per cut. "Original" is the state when the cutter was constructed.
 */
#ifndef elevation_Trim_MeshCutter_h
#define elevation_Trim_MeshCutter_h

#include "Kernel/Mesh/Mesh.h"

#include <array>
#include <cmath>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace elevation
{

/** The position of a new vertex: the weighted sum of the corners of one original triangle. */
struct InsertedVertex
{
  Index Corners[3];
  double Weights[3]; ///< 0 to 1, their sum is 1; on an edge, the opposite corner's is 0
};

/** Appends new vertices and parts to the mesh. */
class MeshCutter
{
public:
  /**
   * @param[in,out] mesh      with Twins
   * @param[out]    inserted  one per new vertex
   * @param[out]    parents   one per new triangle: the original one that it is part of
   */
  MeshCutter(Mesh& mesh, std::vector<InsertedVertex>& inserted, std::vector<Index>& parents)
    : Surface(mesh)
    , Inserted(inserted)
    , Parents(parents)
    , CountBefore(mesh.NumberOfPoints())
    , TrianglesBefore(mesh.NumberOfTriangles())
  {
  }

  /** Whether the vertex is an original one. */
  bool IsGiven(Index vertex) const { return vertex < this->CountBefore; }

  std::array<Point2, 3> CornersOf(Index t) const
  {
    const Index* const corners = &this->Surface.Triangles[3 * t];
    return { { this->Surface.PointOf(corners[0]), this->Surface.PointOf(corners[1]),
      this->Surface.PointOf(corners[2]) } };
  }

  /** The original triangle that a triangle is part of. */
  Index Parent(Index t) const
  {
    return t < this->TrianglesBefore ? t : this->Parents[t - this->TrianglesBefore];
  }

  /** Twice the area of a triangle, with an error of few units in the last place of its edges. */
  double TwiceArea(Index t) const;

  /** Whether the point is in the triangle or on an edge of it. */
  bool Holds(Index t, const Point2& p) const;

  /** The weights of a place in a triangle, whose corners may be new vertices. */
  InsertedVertex WeightsIn(Index t, const Point2& p) const;

  /** The weights of a place on the edge ab, or so near that the edge is moved to it. */
  InsertedVertex WeightsBetween(Index a, Index b, const Point2& p) const;

  /** Appends a vertex that no triangle uses yet. */
  Index AddVertex(const Point2& p, const InsertedVertex& inserted);

  /** Triangle abc becomes abv; bcv and cav are new. */
  void CutTriangle(Index t, Index v);

  /** Cuts the triangles of an edge. @return the half-edge from v to the old destination of h */
  Index CutEdge(Index h, Index v);

  /** Whether cutting the edge of h at the place splits each triangle of it into two proper ones. */
  bool CanCut(Index h, const Point2& place) const;

  /**
   * Moves a place on an edge, within rounding, so that its triangles can be cut there: a rounded
   * place may lie beyond a thin triangle. On the border, there is room outwards at the foot of the
   * apex.
   * @param[in] isUsable  what else is asked of the place; may be empty
   * @return whether such a place was found
   */
  bool MoveToCut(
    Index h, Point2& place, const std::function<bool(const Point2&)>& isUsable = {}) const;

  /**
   * The same for a place inside the triangle of h, which is to be cut there and not at its edge.
   */
  bool MoveInside(Index h, Point2& place, const std::function<bool(const Point2&)>& isUsable) const;

  /** The number, after the cuts, of a border half-edge; if it was cut, of its first part. */
  Index CurrentHalfEdge(Index h) const;

  /** From here on, CurrentHalfEdge() takes the numbers of this moment. */
  void ForgetMoves() { this->Moved.clear(); }

private:
  /**
   * Moves a place on the edge of h, within rounding, to the nearest that will do, or further away
   * to one side of the edge. @return whether one was found
   */
  bool MoveNear(
    Index h, Point2& place, bool outwards, const std::function<bool(const Point2&)>& isPlace) const;

  /** Sums up shares of vertices, perhaps new, that all lie in one original triangle. */
  InsertedVertex WeightsOf(const std::pair<Index, double>* shares, std::size_t count) const;

  /** Appends a part of a triangle. @return its first half-edge */
  Index AddPart(Index t);

  void SetEdge(Index h, Index origin, Index twin);

  /** A half-edge gets another number. */
  void MoveEdge(Index from, Index to, Index origin);

  /** Triangle abc, with h = ab, becomes avc; vbc is new. The caller sets the twins along ab. */
  Index Halve(Index h, Index v);

  Mesh& Surface;
  std::vector<InsertedVertex>& Inserted;
  std::vector<Index>& Parents;
  const Index CountBefore;
  const Index TrianglesBefore;
  std::unordered_map<Index, Index> Moved; ///< border half-edges that a cut renumbered
};

} // namespace elevation

#endif
