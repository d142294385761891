// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The holes of an elevation surface, told apart from its outer boundaries, and the proof that it is
 * an elevation surface.
 *
 * In: a mesh with counter-clockwise triangles and Twins. Out: its border walks (Mesh.h), and which
 * of them bound which hole. The passes:
 *   1. Trace the border. Each walk has one empty region of the plane on its right.
 *   2. Turn: at the lowest vertex of a walk the empty wedge opens downwards (the walk
 *      is the outside of a component) or not (it is the rim of a hole). A pinched walk
 *      has several wedges there.
 *   3. Sweep the plane upwards over all border edges, kept from left to right. Seen from the left,
 *      edges must enter the surface and leave it in turn, and must not cross. The edge left of an
 *      outside's lowest vertex tells which empty region that component lies in: none, or a hole, of
 *      which it is an island.
 *
 * Why this proves that nothing is covered twice, inside neither: triangles are positive, so how
 * often a point is covered is the winding number of the border around it, and pass 3 shows it to be
 * 0 or 1.
 *
 * Borders that touch without sharing a vertex (a vertex inside another border edge, or two points
 * with the same x,y) overlap nothing, but a hole with such a contact has no patch that fits to both
 * sides. It is marked; other holes are not concerned.
 *
 * All decisions are exact. Cost: linear for the tracing, e log e for e border edges.
 */
#ifndef elevation_Mesh_Holes_h
#define elevation_Mesh_Holes_h

#include "HalfEdgeMesh.h"
#include "TriangleList.h"

#include <vector>

namespace elevation
{

struct Holes
{
  /**
   * All walks of the border, as TraceBorder gives them: half-edges, the surface on their left. Each
   * begins with its lowest half-edge.
   */
  Rings Walks;
  /**
   * Hole i is bounded by the walks Loops[Offsets[i]] (its rim, clockwise) to Loops[Offsets[i+1] -
   * 1] (the outsides of its islands, counter-clockwise, from the lowest on). Holes are in the order
   * of their rims.
   */
  std::vector<Index> Offsets{ 0 };
  std::vector<Index> Loops;
  /** One a hole: 1 when borders touch in it without sharing a vertex. */
  std::vector<char> Touched;

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
  /** Calls visit(h) for the half-edges of rim and islands of a hole, which lies on their right. */
  template <typename Visitor>
  void VisitEdges(Index hole, Visitor&& visit) const
  {
    for (Index i = this->Offsets[hole]; i < this->Offsets[hole + 1]; ++i)
    {
      const Index walk = this->Loops[i];
      for (const Index* h = this->Walks.Begin(walk); h != this->Walks.End(walk); ++h)
      {
        visit(*h);
      }
    }
  }
};

/**
 * Finds the holes.
 * @param[in] mesh       triangles counter-clockwise and not flat, Twins filled
 * @param[in] firstCell  what messages add to the id of a triangle to name it as the user's cell
 * @throws Error naming the cell that lies over another one, when the mesh is no elevation surface;
 *         Aborted; std::bad_alloc
 */
Holes FindHoles(const Mesh& mesh, Index firstCell = 0, const Progress& progress = Progress());

/**
 * Whether the border alone proves that nothing is covered twice, for triangles that are
 * counter-clockwise. Where not, FindHoles() names the cell.
 * @throws Aborted; std::bad_alloc
 */
bool CoversOnce(
  const std::vector<BorderEdge>& border, const PointView& points, const Progress& progress);

} // namespace elevation

#endif
