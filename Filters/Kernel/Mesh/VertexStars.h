// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The star of a vertex: the triangles around it, and the half-edges that leave it.
 *
 * In: a mesh with Twins. At the border a star is a fan of triangles from one border edge to the
 * other; at a pinched vertex it is several fans.
 */
#ifndef elevation_Mesh_VertexStars_h
#define elevation_Mesh_VertexStars_h

#include "HalfEdgeMesh.h"

#include <unordered_map>
#include <vector>

namespace elevation
{

/**
 * The stars of the vertices: for each, the half-edges that leave it. Linear in time and memory to set
 * up.
 */
class VertexStars
{
public:
  explicit VertexStars(const Mesh& mesh, const Progress& progress = Progress());

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

} // namespace elevation

#endif
