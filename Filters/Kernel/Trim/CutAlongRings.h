// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Splits edges of rings where they cross edges of a mesh, so that the rings follow the surface.
 *
 *     o-------o-------o         The segment from A to B crosses edges of the mesh. Each gets a
 *      \     / \     /          vertex (x), and the triangles beside the edge are cut there. The
 *   A---x---x---x---x---B       segment is then the chain A x x x x B, on the surface as it was:
 *        \ /     \ /            no edge that bends the surface is flipped.
 *         o-------o
 *
 * In: a mesh with Twins, and segments between its vertices. Out: the mesh with more vertices, and
 * each segment as a chain of its edges. Each segment is walked from its lower end:
 *   - An edge between two original triangles, or of another chain, is cut where it is crossed, at
 *     the crossing rounded to doubles. Each triangle beside it becomes two.
 *   - Edges within one original triangle, which is flat, need no vertex: the next edge of the chain
 *     is recovered across them (RecoverSegments.h).
 *   - The chain goes through a vertex that the segment runs through or passes within rounding
 *     (SnapRounding.h), such as one where another segment has been cut; along a border that
 *     rounding puts before it.
 *   - Where segments cross, the later one cuts an edge of the earlier one's chain.
 *   - Between triangles too thin to be cut, no edge needs a vertex: they are replaced, too. At the
 *     edge of a thicker one, that one is cut right beside the edge, within rounding; what it leaves
 *     there is thin and replaced with the others.
 *
 * Guarantees: interpolated elevations give the same surface as before, to rounding, but for what
 * has no width but rounding: triangles in which no place within 64 units in the last place of a
 * crossing is a double. One exception is known: a given corner of a segment within such triangles,
 * where it is between surfaces of different heights, may take a thicker triangle beside it along.
 * A chain leaves its segment by rounding alone. The result does not depend on the order and
 * direction of the segments.
 * Cost: log n for each of n segments, plus the edges that they cross, plus those that earlier
 * chains have made in the same triangles.
 */
#ifndef elevation_Trim_CutAlongRings_h
#define elevation_Trim_CutAlongRings_h

#include "Kernel/Mesh/Mesh.h"
#include "MeshCutter.h"

#include <vector>

namespace elevation
{

/** In units in the last place: within it, segments and borders snap to each other's vertices. */
constexpr double SnappingReach = 4.0;

struct FollowedSegment
{
  explicit FollowedSegment(const Segment& ends)
    : Ends(ends)
  {
  }

  Segment Ends;               ///< vertices
  std::vector<Index> Between; ///< the vertices of the chain between the ends, from A to B
  bool IsMissing = false;     ///< whether the segment was not a chain of edges
};

/**
 * @param[in,out] mesh      with Twins
 * @param[in,out] cutter    of the mesh
 * @param[in,out] segments  sorted, each once, the lower end first; one that begins outside of the
 *                          mesh stays as it is
 * @throws Error naming the two points of a segment that leaves the mesh on its way; one where the
 *         mesh would exceed the limit of points. Aborted; std::bad_alloc.
 */
void FollowSurface(
  Mesh& mesh, MeshCutter& cutter, std::vector<FollowedSegment>& segments, const Progress& progress);

/** Whether the segment from a vertex to another begins in a triangle or along an edge. */
bool BeginsInside(const Mesh& mesh, VertexStars& stars, Index from, Index to);

/** The order of segments by the places of their ends, each with its lower end first. */
bool IsLower(const Mesh& mesh, const Segment& s, const Segment& t);

[[noreturn]] void RefuseLeaving(const Mesh& mesh, const Segment& segment);

} // namespace elevation

#endif
