// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangles of a patch: where its new points lie in x,y, and how they are joined.
 *
 * In: the boundary of a hole. Out: new points inside, and triangles over boundary and new points.
 *
 * Points are arranged in one of three ways:
 *   Nodes   Where the hole's boundary lies on the surface's lattice, and most nodes are there: the
 *           median of the triangles at the boundary measures less than 1.75 cells. New points are
 *           the nodes inside. (Of a thinned lattice they would be many more points than it has.)
 *   Graded  Where the mean length of eight edges in a row of the boundary is at one place more than
 *           three times that at another: this mean is the spacing at the boundary. It grows
 *           inwards by 0.2 times the way, up to the largest of the boundary.
 *   Even    Else, and always where the user has set a spacing: rows one spacing apart, of which
 *           every second is moved by half a step, so that triangles are nearly equilateral. The
 *           spacing is by default the mean length of the boundary's edges [Nguyen, eq. 1].
 *
 * The passes:
 *   1. Place the points of Nodes and Even, clear of the boundary by 0.6 spacings, or 0.4 steps.
 *   2. Triangulate boundary and new points, make the boundary's edges edges of the triangulation,
 *      and keep what lies inside: a constrained Delaunay triangulation.
 *   3. Refine (not on Nodes): a triangle with an edge of more than 1.6 spacings that is no edge of
 *      the boundary, or with an angle below 20 degrees, gets a point in the centre of its circle
 *      [Chew 1989, Ruppert 1995]. With Graded this places all the points.
 *
 * What the boundary forces: its edges are not split, and no point comes nearer to it than 0.3
 * spacings. So a triangle stays as it is when the centre of its circle lies behind an edge of the
 * boundary or nearer than that to one. All other triangles of Even and Graded have angles of at
 * least 20 degrees, and edges of at most 1.6 spacings but for those of the boundary: an edge inside
 * that is longer has such a forced triangle on both sides. The spacing of Graded is the mean of
 * those at the triangle's corners. Where the boundary's edges are about as long as the spacing,
 * and no corner of it is very sharp, nothing is forced.
 *
 * Guarantees: a patch is constrained Delaunay, lies inside its hole and covers it exactly; its
 * boundary edges are those of the hole. Unlimited by its number of points, refinement ends: a new
 * point keeps 0.3 spacings from all others that it sees. Discs of half of that around new points
 * are disjoint and inside the hole, which bounds their number.
 *
 * Cost: expected linear in the number of points.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 * [Chew 1989] Guaranteed-quality triangular meshes.
 * [Ruppert 1995] A Delaunay refinement algorithm for quality 2-dimensional mesh generation.
 */
#ifndef elevation_Fill_Patch_h
#define elevation_Fill_Patch_h

#include "Membrane.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Lattice/Lattice.h"
#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

/** How far a point may lie from its node of a lattice, along each step, in steps. */
constexpr double LatticeTolerance = 0.01;

/** How new points lie. */
enum class Arrangement : unsigned char
{
  Even,
  Graded,
  Nodes
};

/** What is known of a patch before any work is done for it. */
struct PatchPlan
{
  Arrangement Kind = Arrangement::Even;
  double Spacing = 0.0;         ///< of Even; else the mean length of the boundary's edges
  std::vector<double> Spacings; ///< of Graded: at the origin of each edge, as VisitEdges gives them
  /** No more points than that are inserted; above 0, not a whole number. */
  double MostPoints = 0.0;
  Lattice Steps; ///< of Nodes
  /** Where the coordinates of the hole are largest, neighbouring numbers differ by so much. */
  double Precision = 0.0;
  /** New x,y are rounded to float, before they are triangulated. */
  bool SinglePrecision = false;
  Point2 Rounded(const Point2& p) const
  {
    if (!this->SinglePrecision)
    {
      return p;
    }
    // Volatile, as the vectorizer of gcc 12 leaves out two such conversions side by side.
    const volatile float x = static_cast<float>(p.X);
    const volatile float y = static_cast<float>(p.Y);
    return { x, y };
  }
  /** Threads for one patch. The result does not depend on it. */
  int NumberOfThreads = 1;
};

/**
 * Chooses the arrangement for a hole.
 * @param[in] mesh     the surface
 * @param[in] holes    its holes
 * @param[in] hole     number of the hole
 * @param[in] area     of the hole
 * @param[in] spacing  the one asked for; 0: none
 * @param[in] lattice  of the surface; null: none
 * @return a plan of which Precision and what follows it are still to be set
 */
PatchPlan PlanPatch(const Mesh& mesh, const Holes& holes, Index hole, double area, double spacing,
  const Lattice* lattice);

/** A hole with its vertices numbered from 0: first those of the boundary, then new ones. */
struct PatchMesh
{
  std::vector<Index> BoundaryIds; ///< vertex -> id in the surface; from the lowest point on
  std::vector<double> Points;     ///< x, y and room for z of all vertices
  std::vector<Index> Triangles;   ///< inside the hole
  double Spacing = 0.0;

  // What Neighbours.h finds; one for each new vertex.
  Adjacency Neighbours;
  std::vector<Index> Layers;  ///< edges from the boundary
  std::vector<Index> Outward; ///< a neighbour one layer further out
  std::vector<Index> Nearest; ///< boundary vertex; of equally near ones the lowest
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
};

/** A hole that is being filled. */
struct Patch : PatchMesh
{
  std::vector<Segment> Edges; ///< of the boundary; the hole lies on their right
};

/** Vertices and edges of the boundary. n log n. */
Patch CollectBoundary(const Mesh& mesh, const Holes& holes, Index hole);

/**
 * New points and triangles for a patch that has its boundary.
 * @throws Error, a sentence without the hole's name; Aborted; std::bad_alloc
 */
void MakePatch(const PatchPlan& plan, const Progress& progress, Patch& patch);

} // namespace elevation

#endif
