// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangles of a patch: places new points in x,y and triangulates them.
 *
 * In: the boundary of a hole, and points and edges that it has inside (regions of long triangles,
 * LongTriangles.h). Out: new points inside, and triangles of known and new points.
 *
 * There are three arrangements of points:
 *   Nodes   If the hole's boundary lies on the surface's lattice, and the lattice is not thinned:
 *           the median area of the triangles at the boundary is at most 1.75 cells. The new points
 *           are the nodes inside. (A thinned lattice has many more nodes than points.)
 *   Graded  If the mean length of eight consecutive boundary edges is, at one place, more than
 *           three times that at another. This mean is the spacing at the boundary; inwards the
 *           spacing grows by 0.2 times the distance, up to the largest one at the boundary.
 *   Even    Otherwise, and always if the user sets a spacing: rows one spacing apart, every other
 *           one shifted by half a step, so that triangles are nearly equilateral. The default
 *           spacing is the mean length of the boundary's edges [Nguyen, eq. 1].
 * In a region, the mean is that of all edges, of the boundary and inside, that are not long: those
 * along the surface's own border may be. (It is the limit where all are.) In a region of lines,
 * which has more inner edges than boundary edges, an edge counts as at least a tenth of the gap
 * beside it (Holes::Gaps; no more than the region's mean width): the spacing follows the gap, not
 * the distance of points along lines. Long edges count in Graded, which so makes points sparser
 * towards a long border, and away from lines; the spacing at a point inside is the mean length of
 * the inner edges there. With Nodes, inner edges are not kept as such: those between neighbouring
 * nodes come by themselves, longer ones get a node inside.
 *
 * The passes:
 *   1. Nodes and Even: place the points, at least 0.6 spacings, or 0.4 lattice steps, from the
 *      boundary.
 *   2. Triangulate boundary and new points, recover the boundary's edges, and keep what lies
 *      inside: a constrained Delaunay triangulation.
 *   3. Even and Graded: refine. A triangle with an angle below 20 degrees, or an interior edge
 *      longer than 1.6 spacings, gets a point at its circumcentre [Chew 1989, Ruppert 1995]. This
 *      places all the points of Graded.
 *
 * Limits of refinement: boundary edges and inner edges are not split, and no point comes closer to
 * them than 0.3 spacings. So a triangle is not refined if its circumcentre is behind a boundary
 * edge or that close to one. All other triangles of Even and Graded have angles of at least 20
 * degrees and interior edges of at most 1.6 spacings: a longer interior edge has such an exception
 * on both sides. With Graded, the spacing of a triangle is the mean of those at its corners. If the
 * boundary's edges are about as long as the spacing, and it has no very sharp corner, there are no
 * exceptions.
 *
 * Guarantees: a patch is constrained Delaunay, lies inside its hole and covers it exactly; its
 * boundary edges are those of the hole, and inner edges are edges of it. Refinement ends even
 * without a limit on points: a new point keeps 0.3 spacings from all others that it sees, so discs
 * of half that radius around new points are disjoint and inside the hole, which bounds their
 * number.
 *
 * Cost: expected linear in the number of points.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 * [Chew 1989] Guaranteed-quality triangular meshes.
 * [Ruppert 1995] A Delaunay refinement algorithm for quality 2-dimensional mesh generation.
 */
#ifndef elevation_Fill_Patch_h
#define elevation_Fill_Patch_h

#include "Kernel/Base/Base.h"
#include "Kernel/Lattice/Lattice.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Messages/Messages.h"
#include "Membrane.h"

#include <vector>

namespace elevation
{

/** How far a point may lie from its lattice node, along each step, in steps. */
constexpr double LatticeTolerance = 0.01;

enum class Arrangement : unsigned char
{
  Even,
  Graded,
  Nodes
};

/** The arrangement and limits of a patch, known before it is made. */
struct PatchPlan
{
  Arrangement Kind = Arrangement::Even;
  double Spacing = 0.0; ///< for Even; else the mean length of the edges
  /** For Graded: at the origin of each edge, as of VisitEdges(); at both ends of inner edges. */
  std::vector<double> Spacings;
  /** An upper bound of the number of new points; above 0, not a whole number. */
  double MostPoints = 0.0;
  double ExpectedPoints = 0.0; ///< about how many there will be
  double MostRows = 0.0;       ///< how many more rows than edges the edges can meet
  Lattice Steps;               ///< for Nodes
  /** The distance between neighbouring numbers at the largest coordinate of the hole. */
  double Precision = 0.0;
  /** Round new x,y to float before they are triangulated. */
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
 * @param[in] mesh     the surface, without long triangles
 * @param[in] stars    its stars; may be null if lattice is
 * @param[in] holes    its holes
 * @param[in] hole     number of the hole
 * @param[in] area     of the hole
 * @param[in] spacing  the user's; 0: none
 * @param[in] lattice  of the surface; null: none
 * @return a plan; the caller sets Precision and the members after it
 */
PatchPlan PlanPatch(const Mesh& mesh, const VertexStars* stars, const Holes& holes, Index hole,
  double area, double spacing, const Lattice* lattice);

/** The spacing at which so many points, in rows, fill an area. */
double SpacingOfPoints(double area, double points);

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
  Box BoxOfBoundary() const
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
