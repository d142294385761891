// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangles of a patch: places new points in x,y and triangulates them.
 *
 * In: the boundary of a hole, and points and edges that it has inside (regions of long triangles,
 * LongTriangles.h). Out: new points inside, and triangles of known and new points.
 *
 * The passes:
 *   1. Nodes and Even (PatchPlan.h): place the points in rows (PointRows.h).
 *   2. Triangulate boundary and new points, recover the boundary's edges, and keep what lies
 *      inside: a constrained Delaunay triangulation.
 *   3. Even and Graded: refine (Refinement.h). This places all the points of Graded.
 *
 * Guarantees: a patch is constrained Delaunay, lies inside its hole and covers it exactly; its
 * boundary edges are those of the hole, and inner edges are edges of it.
 *
 * Cost: expected linear in the number of points.
 */
#ifndef elevation_Fill_Patch_h
#define elevation_Fill_Patch_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Messages/Messages.h"
#include "Membrane.h"
#include "PatchPlan.h"

#include <vector>

namespace elevation
{

/**
 * A hole with vertices numbered from 0: first those of the boundary, then new ones. Points of the
 * surface inside a region are known, and count as boundary vertices.
 */
struct PatchMesh
{
  std::vector<Index> BoundaryIds; ///< vertex -> id in the surface; from the lowest point on
  std::vector<double> Points;     ///< x, y and room for z of all vertices
  std::vector<Index> Triangles;   ///< inside the hole
  Index NumberOfPointsInside = 0; ///< of them those inside a region
  double Spacing = 0.0;
  /** All triangles that meet it are there; others may be missing where the surface is a part. */
  Box Surroundings{ { -DBL_MAX, -DBL_MAX }, { DBL_MAX, DBL_MAX } };

  // Found by Neighbours.h, one for each new vertex.
  Adjacency Neighbors;
  std::vector<Index> Layers;  ///< edges from the boundary
  std::vector<Index> Outward; ///< a neighbour one layer further out
  std::vector<Index> Nearest; ///< boundary vertex; the lowest of equally near ones
  std::vector<Index> Order;   ///< new vertices, from the boundary inwards

  Index NumberOfBoundaryVertices() const { return static_cast<Index>(this->BoundaryIds.size()); }
  Index NumberOfVertices() const { return static_cast<Index>(this->Points.size() / 3); }
  Index NumberOfNewVertices() const
  {
    return this->NumberOfVertices() - this->NumberOfBoundaryVertices();
  }
  Point2 At(Index vertex) const
  {
    return { this->Points[3 * std::size_t(vertex)], this->Points[3 * std::size_t(vertex) + 1] };
  }
  /** Of a new vertex from Nearest. */
  double DistanceFromBoundary(Index newVertex) const
  {
    return Distance(
      this->At(this->NumberOfBoundaryVertices() + newVertex), this->At(this->Nearest[newVertex]));
  }
  /** Adds a vertex, whose z is not used here; a NaN would keep it from being triangulated. */
  void AddPoint(const Point2& p) { this->Points.insert(this->Points.end(), { p.X, p.Y, 0.0 }); }
  Box BoundaryBox() const
  {
    Box box;
    for (Index v = 0; v < this->NumberOfBoundaryVertices(); ++v)
    {
      box.Add(this->At(v));
    }
    return box;
  }
};

/** A hole that is being filled. */
struct Patch : PatchMesh
{
  std::vector<Segment> Edges;      ///< of the boundary; the hole lies on their right
  std::vector<Segment> InnerEdges; ///< as of VisitInnerEdges()
};

/** The error of a hole in which borders touch without sharing a vertex. */
CodedError BordersTouch();

/** Makes a patch with its known vertices, and the edges between them that stay. n log n. */
Patch CollectBoundary(const Mesh& mesh, const Holes& holes, Index hole);

/**
 * Adds new points and triangles to a patch that has its boundary.
 * @throws Error, a sentence without the hole's name; Aborted; std::bad_alloc
 */
void MakePatch(const PatchPlan& plan, const Progress& progress, Patch& patch);

} // namespace elevation

#endif
