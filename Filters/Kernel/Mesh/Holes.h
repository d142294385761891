// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Finds the holes of an elevation surface, as distinct from its outer boundaries, and proves that
 * it is an elevation surface.
 *
 * In: a mesh with counter-clockwise triangles and Twins. Out: its border walks (HalfEdgeMesh.h),
 * and which of them bound which hole. The passes:
 *   1. Trace the border. Each walk has one empty region of the plane on its right.
 *   2. Classify each walk. Where the empty wedge at its lowest vertex opens downwards, the walk is
 *      the outside of a component, else the rim of a hole. A pinched walk has several wedges there.
 *   3. Sweep a line upwards over all border edges, sorted from left to right. From the left, edges
 *      must enter the surface and leave it in turn, and must not cross. The edge left of a
 *      component's lowest vertex bounds the empty region around the component: the outside, or a
 *      hole, in which the component is an island.
 *
 *     ..............           A line through a surface with one hole. From the left, its border
 *    :   ........   :          edges lead in (a), out (b), in (c), out (d). Edges that lead in run
 *   -a--b--------c--d-  line   down, those that lead out run up, as the surface is on their left.
 *    :   ''''''''   :          Two of one kind in turn: some place is covered twice.
 *     ''''''''''''''
 *
 * This proves that no place is covered twice, in the interior either: triangles are
 * counter-clockwise, so the number of triangles over a point is the winding number of the border
 * around it, which pass 3 shows to be 0 or 1.
 *
 * Borders that touch without sharing a vertex (a vertex inside another border edge, or two points
 * with the same x,y) do not overlap, but no patch of a hole with such a contact fits both sides.
 * The hole is marked; other holes are not affected.
 *
 * All decisions are exact. Cost: linear in the triangles, and e log e for e border edges.
 */
#ifndef elevation_Mesh_Holes_h
#define elevation_Mesh_Holes_h

#include "HalfEdgeMesh.h"
#include "TriangleList.h"

#include <vector>

namespace elevation
{

// Lists with offsets instead of a list of lists: there may be very many holes.
struct Holes
{
  /**
   * All walks of the border, as TraceBorder gives them, as rings of vertices: the surface is on
   * their left. Each begins with its lowest edge. Then those of regions (below).
   */
  Rings Walks;
  /**
   * Hole i is bounded by the walks Loops[Offsets[i]] (its rim, clockwise) to Loops[Offsets[i+1] -
   * 1] (the outsides of its islands, counter-clockwise, from the lowest on). Holes are in the order
   * of their rims; regions follow.
   */
  std::vector<Index> Offsets{ 0 };
  std::vector<Index> Loops;
  /** One a hole: 1 when borders touch in it without sharing a vertex; regions: 0. */
  std::vector<char> Touched;

  /**
   * The last holes are regions of triangles with long edges, see LongTriangles.h. Region r has the
   * inner edges InnerEnds[2 InnerOffsets[r]] to InnerEnds[2 InnerOffsets[r+1] - 1], two ends each.
   */
  std::vector<Index> InnerOffsets{ 0 };
  std::vector<Index> InnerEnds;
  std::vector<Index> RegionOf; ///< one a triangle: its region's number as a hole, or None
  double LongestEdge = 0.0;    ///< the length above which edges are long
  /**
   * One a vertex, if a region is of lines, else empty: how far the next line is, by the largest
   * height of the long triangles there, over their shortest edges, less twice the way from there.
   */
  std::vector<double> Gaps;

  Index NumberOfContacts = 0;         ///< vertices that touch a border without sharing a vertex
  std::vector<Index> ContactVertices; ///< the first few of them

  Index Count() const { return static_cast<Index>(this->Offsets.size()) - 1; }
  Index Rim(Index hole) const { return this->Loops[this->Offsets[hole]]; }
  Index NumberOfEdges(Index hole) const
  {
    Index edges = 0;
    for (Index i = this->Offsets[hole]; i < this->Offsets[hole + 1]; ++i)
    {
      edges += this->Walks.Size(this->Loops[i]);
    }
    return edges;
  }
  /** Calls visit(a, b) for the edges of rim and islands of a hole, which lies on their right. */
  template <typename Visitor>
  void VisitEdges(Index hole, Visitor&& visit) const
  {
    for (Index i = this->Offsets[hole]; i < this->Offsets[hole + 1]; ++i)
    {
      const Index* const begin = this->Walks.Begin(this->Loops[i]);
      const Index* const end = this->Walks.End(this->Loops[i]);
      for (const Index* v = begin; v != end; ++v)
      {
        visit(*v, v + 1 == end ? *begin : v[1]);
      }
    }
  }

  Index NumberOfRegions() const { return static_cast<Index>(this->InnerOffsets.size()) - 1; }
  bool IsRegion(Index hole) const { return hole >= this->Count() - this->NumberOfRegions(); }
  /** Whether a hole is a region with more inner edges than edges of its border, as of lines. */
  bool IsOfLines(Index hole) const
  {
    const Index region = hole - (this->Count() - this->NumberOfRegions());
    return region >= 0 &&
      this->InnerOffsets[region + 1] - this->InnerOffsets[region] > this->NumberOfEdges(hole);
  }
  /** Calls visit(a, b) for the inner edges of a hole that is a region, else not at all. */
  template <typename Visitor>
  void VisitInnerEdges(Index hole, Visitor&& visit) const
  {
    const Index region = hole - (this->Count() - this->NumberOfRegions());
    for (Index i = region < 0 ? 0 : this->InnerOffsets[region];
         region >= 0 && i < this->InnerOffsets[region + 1]; ++i)
    {
      visit(this->InnerEnds[2 * std::size_t(i)], this->InnerEnds[2 * std::size_t(i) + 1]);
    }
  }
};

/**
 * Finds the holes.
 * @param[in] mesh       triangles counter-clockwise and not flat, Twins filled
 * @param[in] firstCell  messages name triangle t as cell firstCell + t
 * @throws Error naming the cell that lies over another one, when the mesh is not an elevation
 *         surface; Aborted; std::bad_alloc
 */
Holes FindHoles(const Mesh& mesh, Index firstCell = 0, const Progress& progress = Progress());

/**
 * The same by the border alone, which may be that of parts: edges in the order of their triangles.
 * Contacts do not name vertices.
 * @throws Error if the border does not prove that no place is covered twice; Aborted;
 *         std::bad_alloc
 */
Holes FindBorderHoles(
  const std::vector<BorderEdge>& border, const PointView& points, const Progress& progress);

/**
 * A mesh in which half-edge 3i is border edge i, and nothing else is meaningful.
 * @param[out] ids  of its points
 */
Mesh MakeBorderMesh(const std::vector<BorderEdge>& border, const PointView& points,
  const Progress& progress, std::vector<Index>& ids);

/**
 * Whether the border proves that counter-clockwise triangles cover no place twice. If not,
 * FindHoles() names the cell.
 * @throws Aborted; std::bad_alloc
 */
bool CoversOnce(
  const std::vector<BorderEdge>& border, const PointView& points, const Progress& progress);

} // namespace elevation

#endif
