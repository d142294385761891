// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The star of a vertex: the triangles around it, and the half-edges that leave it.
 *
 * In: a mesh with Twins. At the border a star is a fan of triangles from one border edge to the
 * other; at a pinched vertex it is several fans. The only index of connectivity: the others know
 * where points and triangles are, not which triangles meet at a vertex.
 *
 * Cost: linear in time and memory to set up; then one half-edge after another around the vertex.
 */
#ifndef elevation_Mesh_VertexStars_h
#define elevation_Mesh_VertexStars_h

#include "HalfEdgeMesh.h"

#include <unordered_map>
#include <vector>

namespace elevation
{

/**
 * The stars of all vertices of a mesh: one half-edge for each vertex, from which the mesh leads on.
 * Functions take the mesh as an argument, since Recovery and Trim change it while the stars follow.
 */
class VertexStars
{
public:
  explicit VertexStars(const Mesh& mesh, const Progress& progress = Progress());

  /** Whether the vertex is a corner of a triangle. */
  bool IsUsed(Index vertex) const { return this->First[vertex] != None; }

  /**
   * Calls visit(h) for every half-edge that leaves the vertex, fan by fan, counter-clockwise within
   * a fan, until visit returns false. (An edge whose only half-edge leads to the vertex is the
   * last of its fan: Previous of the last h, a border.)
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
   * The same for a visitor that looks for the half-edge along which, or in whose triangle, the
   * segment to another vertex begins. In a large star, a binary search by direction finds it,
   * unless the vertex is pinched. Some half-edges may be visited twice.
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
    CountWork(static_cast<std::size_t>(Few - left));
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
    StepCount steps;
    this->Visit(mesh, vertex, [&](Index leaving) {
      steps.Add();
      return visit(leaving);
    });
  }

  /**
   * Enters half-edge h at its origin, in place of one that may no longer exist. Recovery calls this
   * for every half-edge of the triangles that it has written.
   */
  void Replace(const Mesh& mesh, Index h)
  {
    Index& first = this->First[mesh.Origin(h)];
    if (!this->OnBorder[mesh.Origin(h)])
    {
      first = h;
    }
  }

  /**
   * Keeps up with an edge that was cut at a new vertex.
   * @param[in] after   the half-edge from the new vertex to the old destination of a half-edge
   * @param[in] before  the next one of that half-edge, whose place has changed
   */
  void ReplaceCut(const Mesh& mesh, Index after, Index before);

  /** Changes the id of a border that leaves the vertex from @a before to @a after. */
  void ReplaceBorder(Index vertex, Index before, Index after);

  /**
   * Visits one fan, from its first half-edge on or once around.
   *
   *    w   u      h is v-u. The half-edge before it in its triangle is w-v, whose twin v-w is
   *     \ /       the next one that leaves v, counter-clockwise. Where it has none, v-w is the
   *      v        border that ends the fan.
   *
   * @return whether all of it
   */
  template <typename Visitor>
  static bool VisitFan(const Mesh& mesh, Index first, Visitor&& visit)
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

private:
  static constexpr Index Few = 32;

  /** The half-edge that VisitToward() looks for; None if not found. */
  Index Toward(const Mesh& mesh, Index from, Index to);

  /**
   * An edge of a vertex when its star was sorted; the half-edge may no longer exist. The vertex is
   * kept, as its position gives the direction in which the star was sorted, whatever the half-edge
   * has become since.
   */
  struct Spoke
  {
    Index Vertex; ///< at its other end
    Index HalfEdge;
  };

  // A half-edge that leaves the vertex; at the border the one that is a border, from which the
  // whole fan is reached counter-clockwise.
  std::vector<Index> First;
  std::vector<char> OnBorder;
  // The further fans of pinched vertices, each by its outgoing border.
  std::unordered_map<Index, std::vector<Index>> Others;
  // The edges of vertices with large stars, by direction: counter-clockwise from +x.
  std::unordered_map<Index, std::vector<Spoke>> Hubs;
};

} // namespace elevation

#endif
