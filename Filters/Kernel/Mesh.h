// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A triangle mesh over the x,y plane: the triangle array and the twin array, nothing else.
 *
 *          2                 Half-edge 3t+i leaves vertex i of triangle t:
 *         / \                  3t   goes from vertex 0 to vertex 1,
 *   3t+2 /   \ 3t+1            3t+1 from 1 to 2, 3t+2 from 2 to 0.
 *       /  t  \              The triangle lies on its left (triangles are counter-clockwise).
 *      0-------1             Its twin is the half-edge of the neighbour that runs the other way,
 *         3t                 or Mesh::Border where there is no neighbour.
 *
 * This numbering is used everywhere in the kernel and drawn nowhere else. The triangle array is the
 * connectivity of a vtkCellArray as it stands.
 */
#ifndef elevation_Mesh_h
#define elevation_Mesh_h

#include "Types.h"

#include <string>
#include <vector>

namespace elevation
{

/** A point as messages name it: "point 7 (1.5, 2)". */
std::string NameOf(const std::vector<Point2>& points, Index id);

class Mesh
{
public:
  /** The twin of a half-edge with nothing on its right. */
  static constexpr Index Border = None;

  std::vector<Point2> Points;
  std::vector<Index> Triangles; ///< three vertices a triangle, counter-clockwise
  std::vector<Index> Twins;     ///< one a half-edge; filled by ConnectTwins

  Index NumberOfPoints() const { return static_cast<Index>(this->Points.size()); }
  Index NumberOfTriangles() const { return static_cast<Index>(this->Triangles.size() / 3); }
  Index NumberOfHalfEdges() const { return static_cast<Index>(this->Triangles.size()); }

  static Index Next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index Previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  static Index Triangle(Index h) { return h / 3; }

  Index Origin(Index h) const { return this->Triangles[h]; }
  Index Destination(Index h) const { return this->Triangles[Next(h)]; }
  /** The vertex of h's triangle that is not on h. */
  Index Apex(Index h) const { return this->Triangles[Previous(h)]; }
  Index Twin(Index h) const { return this->Twins[h]; }
  bool IsBorder(Index h) const { return this->Twins[h] == Border; }
  const Point2& PointOf(Index vertex) const { return this->Points[vertex]; }

  /**
   * Fills Twins from Triangles. Linear in time and memory.
   * @param[in] firstCell  what messages add to the id of a triangle to name it as the user's cell
   * @throws Error naming the triangle and its edge when an edge has more than two triangles or two
   *         that run the same way (the mesh is not a consistently oriented manifold). Aborted.
   */
  void ConnectTwins(Index firstCell = 0, const Progress& progress = Progress());
};

/**
 * Rings of vertices: ring r is Vertices[Offsets[r]] ... Vertices[Offsets[r + 1] - 1], and closes
 * from its last vertex to its first, which is not repeated.
 */
struct Rings
{
  std::vector<Index> Offsets{ 0 };
  std::vector<Index> Vertices;

  Index Count() const { return static_cast<Index>(this->Offsets.size()) - 1; }
  Index Size(Index ring) const { return this->Offsets[ring + 1] - this->Offsets[ring]; }
  const Index* Begin(Index ring) const { return this->Vertices.data() + this->Offsets[ring]; }
  const Index* End(Index ring) const { return this->Vertices.data() + this->Offsets[ring + 1]; }
};

/**
 * The border of a mesh (with Twins) as closed walks of half-edges, in the half-edges' own
 * direction, so that the mesh lies on the left: counter-clockwise around the outside of a
 * component, clockwise around a hole. At a vertex where several borders meet, a walk stays with the
 * empty wedge it runs along, so each walk bounds one empty region of the plane. Every border
 * half-edge is in exactly one walk; a walk starts at its lowest half-edge id, and walks are in the
 * order of their first. The result's Vertices are half-edge ids; their origins are the vertices of
 * the walk. Linear, but for sorting the borders at shared vertices.
 * @throws Aborted
 */
Rings TraceBorder(const Mesh& mesh, const Progress& progress = Progress());

} // namespace elevation

#endif
