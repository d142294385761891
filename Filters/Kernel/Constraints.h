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
 * Delaunay afterwards [Lee & Lin 1986]: only edges that are not constrained are locally Delaunay.
 *
 * Guarantees: exact (Orientation and InCircle decide), and unique: the tie of co-circular points is
 * broken by the rule of Delaunay.h, so that the result depends on the positions alone, not on
 * the order of points, triangles or segments.
 *
 * Cost: one linear pass over the mesh for each call; then proportional to the triangles around the
 * ends of the segments and the edges crossed, as long as flips stay local, which they do for data
 * that are spread in the plane (no more than the square of the edges crossed by one segment).
 *
 * [Lawson 1977] Software for C1 surface interpolation.
 * [Lee & Lin 1986] Generalized Delaunay triangulation for planar graphs.
 */
#ifndef elevation_Constraints_h
#define elevation_Constraints_h

#include "Mesh.h"

#include <unordered_map>
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
 * The half-edges around the vertices of a mesh with Twins, also where several fans of triangles
 * meet in one vertex (pinched) and at the border. Linear in time and memory to set up.
 */
class Fans
{
public:
  explicit Fans(const Mesh& mesh, const Progress& progress = Progress());

  /** Whether the vertex is a corner of a triangle. */
  bool IsUsed(Index vertex) const { return this->First[vertex] != None; }

  /**
   * Calls visit(h) for every half-edge that leaves the vertex, fan by fan, counter-clockwise within
   * a fan, until visit returns false. (An edge whose only half-edge arrives at the vertex is the
   * last of its fan: it is Previous of the last h, and a border.)
   */
  template <typename Visitor>
  void Visit(const Mesh& mesh, Index vertex, Visitor&& visit) const
  {
    const Index first = this->First[vertex];
    if (first == None || !VisitFan(mesh, first, visit) || this->Others.empty())
    {
      return;
    }
    const auto others = this->Others.find(vertex);
    if (others == this->Others.end())
    {
      return;
    }
    for (const Index h : others->second)
    {
      if (!VisitFan(mesh, h, visit))
      {
        return;
      }
    }
  }

  /**
   * The same for a visitor that waits for the half-edge along which, or in the triangle of which,
   * the straight way from the vertex to another one begins: where there are many it is searched by
   * direction, unless fans are pinched. Some may be visited twice.
   */
  template <typename Visitor>
  void VisitToward(const Mesh& mesh, Index vertex, Index to, Visitor&& visit)
  {
    Index left = Few;
    bool goesOn = true;
    this->Visit(mesh, vertex, [&](Index h) {
      goesOn = visit(h);
      return goesOn && --left > 0;
    });
    if (!goesOn || left > 0)
    {
      return;
    }
    const Index h = this->Toward(mesh, vertex, to);
    if (h != None)
    {
      visit(h);
      return;
    }
    this->Visit(mesh, vertex, visit);
  }

  /** Tells that half-edge h now leaves its origin, in place of a half-edge that may have gone. */
  void Replace(const Mesh& mesh, Index h)
  {
    Index& first = this->First[mesh.Origin(h)];
    if (!this->OnBorder[mesh.Origin(h)])
    {
      first = h;
    }
  }

  /** Tells that the border that leaves the vertex and had the id @a before now has @a after. */
  void ReplaceBorder(Index vertex, Index before, Index after);

private:
  static constexpr Index Few = 32;

  /** What VisitToward() waits for; None: not found. */
  Index Toward(const Mesh& mesh, Index from, Index to);

  template <typename Visitor>
  static bool VisitFan(const Mesh& mesh, Index first, Visitor& visit)
  {
    Index h = first;
    do
    {
      if (!visit(h))
      {
        return false;
      }
      h = mesh.Twin(Mesh::Previous(h));
    } while (h != Mesh::Border && h != first);
    return true;
  }

  /** An edge of a vertex as it once was: the half-edge may have gone. */
  struct Spoke
  {
    Index Vertex; ///< at its other end
    Index HalfEdge;
  };

  // A half-edge that leaves the vertex; for a vertex at the border the one that is a border, from
  // which the whole fan is reached counter-clockwise.
  std::vector<Index> First;
  std::vector<char> OnBorder;
  // The further fans of pinched vertices, each by its outgoing border.
  std::unordered_map<Index, std::vector<Index>> Others;
  // Of vertices with many triangles, the edges by direction: from the right, counter-clockwise.
  std::unordered_map<Index, std::vector<Spoke>> Hubs;
};

/** An edge on the way along a segment: a half-edge that is on it, and the vertex it leads to. */
struct SegmentStep
{
  Index HalfEdge = None; ///< from or to the vertex asked for; None when there is no such edge
  Index Vertex = None;
};

/**
 * The edge at vertex @a from that lies on the straight way to vertex @a to and does not go beyond
 * it. Exact. Cost: the triangles around @a from, or a search where these are many.
 */
SegmentStep StepAlong(const Mesh& mesh, Fans& fans, Index from, Index to);

/**
 * Makes every segment an edge of the mesh, or a chain of edges where it runs exactly through other
 * vertices.
 * @param[in,out] mesh         with Twins; the number of triangles is conserved,
 *                             their slots are reused
 * @param[in]     segments     in any order and direction; the same one may come twice, they may
 *                             overlap. A segment from a vertex to itself is left out.
 * @param[in,out] constrained  one flag a half-edge: in, edges that must stay (empty: none); out, 1
 *                             for these and for both half-edges of every segment's edges, else 0
 * @param[in]     progress     may be empty
 * @return the number of segments that were not edges or chains of edges before
 * @throws Error naming the two points when a segment crosses a constrained edge (so two segments
 *         cross), leaves the mesh (crosses a hole or the outside), or ends in a point that is not
 *         the corner of any triangle. The mesh then is valid, with the segments before recovered.
 *         Aborted; std::bad_alloc.
 */
Index RecoverSegments(Mesh& mesh, const std::vector<Segment>& segments,
  std::vector<char>& constrained, const Progress& progress = Progress());

/** The same with the fans of the mesh, which afterwards are those of the mesh as it has become. */
Index RecoverSegments(Mesh& mesh, Fans& fans, const std::vector<Segment>& segments,
  std::vector<char>& constrained, const Progress& progress = Progress());

} // namespace elevation

#endif
