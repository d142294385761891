// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Segments that must be edges of a mesh, recovered in place: constrained Delaunay triangulation.
 *
 * In: a mesh with Twins, segments between its vertices. Out: the same mesh, in which every segment
 * is an edge, or a chain of edges where it runs exactly through other vertices.
 * For each segment:
 *   1. Walk from its first end through the triangles it crosses, up to the
 *      next vertex exactly on it.
 *   2. Take these triangles out. Every corner of the empty polygon on either side of the segment
 *      sees the segment, so that one scan with a stack fills the polygon with triangles.
 *   3. Flip the edges inside each polygon until they are locally Delaunay [Lawson 1977].
 *   4. Write the triangles back into the slots of those taken out.
 * Only crossed triangles change. When the mesh was (constrained) Delaunay before, it is constrained
 * Delaunay afterwards [Lee & Lin 1986]: all edges but constrained ones are certainly locally
 * Delaunay.
 *
 * Guarantees: exact (Orientation and InCircle decide). If the mesh was constrained Delaunay before,
 * the set of its triangles is unique: the tie of co-circular points is broken by the rule of
 * Triangulate.h, so that it depends on the positions alone, not on the order of points, triangles
 * or segments. Which slots triangles have depends on the order before.
 *
 * Cost: one linear pass to make the stars, unless they are given; then proportional to the
 * triangles around the ends of the segments and the edges crossed, as long as flips stay local, as
 * for points spread over the plane; at worst the square of the edges that a segment crosses.
 *
 * [Lawson 1977] Software for C1 surface interpolation.
 * [Lee & Lin 1986] Generalized Delaunay triangulation for planar graphs.
 */
#ifndef elevation_Mesh_RecoverSegments_h
#define elevation_Mesh_RecoverSegments_h

#include "VertexStars.h"

#include <vector>

namespace elevation
{

/** A straight line from one vertex to another, by their ids. */
struct Segment
{
  Index A;
  Index B;
};

/**
 * Whether the edge from a to b of two triangles with the apexes p and q is not locally Delaunay; of
 * cocircular points, the lowest is on all edges between them. Both this and Validate's TieRule
 * state the tie rule of Triangulate.h for one edge.
 */
inline bool ShouldFlip(const Point2& a, const Point2& b, const Point2& p, const Point2& q)
{
  const Sign side = InCircle(a, b, p, q);
  return side == Positive ||
    (side == Zero && IsLower(IsLower(p, q) ? p : q, IsLower(a, b) ? a : b));
}

/** A step along a segment: a half-edge that is on it, and the vertex it leads to. */
struct SegmentStep
{
  Index HalfEdge = None; ///< from or to the vertex asked for; None when there is no such edge
  Index Vertex = None;
};

/**
 * The edge at vertex @a from that lies on the segment to vertex @a to. Exact. Cost: the triangles
 * around @a from, or a binary search where these are many.
 */
SegmentStep StepAlong(const Mesh& mesh, VertexStars& stars, Index from, Index to);

/**
 * The edge that the segment between two vertices crosses first, as the half-edge from its right to
 * its left; None where the segment does not begin in a triangle. Exact. Cost: as of StepAlong().
 */
Index FirstCrossed(const Mesh& mesh, VertexStars& stars, Index from, Index to);

/**
 * Makes every segment an edge of the mesh, or a chain of edges where it runs exactly through other
 * vertices.
 * @param[in,out] mesh         with Twins; the number of triangles does not change
 * @param[in]     segments     in any order and direction; they may repeat and overlap. A
 *                             segment from a vertex to itself is left out.
 * @param[in,out] constrained  one flag a half-edge: in, edges that must stay (empty: none); out, 1
 *                             for these and for both half-edges of every segment's edges, else 0
 * @return the number of segments that were not edges or chains of edges before
 * @throws Error naming the two points when a segment crosses a constrained edge (so two segments
 *         cross), leaves the mesh (crosses a hole or the outside), or ends in a point that is not
 *         the corner of any triangle. The mesh is then valid, with the earlier segments recovered.
 *         Aborted; std::bad_alloc.
 */
Index RecoverSegments(Mesh& mesh, const std::vector<Segment>& segments,
  std::vector<char>& constrained, const Progress& progress = Progress());

/**
 * The same with the stars of the mesh, which are kept up to date.
 * @param[out] replaced  if not null, the triangles that changed are appended
 */
Index RecoverSegments(Mesh& mesh, VertexStars& stars, const std::vector<Segment>& segments,
  std::vector<char>& constrained, const Progress& progress = Progress(),
  std::vector<Index>* replaced = nullptr);

} // namespace elevation

#endif
