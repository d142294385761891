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
#ifndef elevation_Mesh_HalfEdgeMesh_h
#define elevation_Mesh_HalfEdgeMesh_h

#include "Kernel/Base/Base.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace elevation
{

/**
 * Points, and the ids by which messages name them; without ids, by their indices. For code that has
 * points but no mesh, such as rings and lines.
 */
struct NamedPoints
{
  NamedPoints(std::vector<Point2> places = {}, std::vector<Index> ids = {})
    : Places(std::move(places))
    , Ids(std::move(ids))
  {
  }

  const Point2& operator[](Index i) const { return this->Places[i]; }
  Index IdOf(Index i) const { return this->Ids.empty() ? i : this->Ids[i]; }

  std::vector<Point2> Places;
  std::vector<Index> Ids;
};

class Mesh;

/** A place as messages name it, "(1.5, 2)"; and a point, "point 7 (1.5, 2)". */
std::string NameOf(const Point2& p);
std::string NameOf(std::int64_t number, const Point2& p);
std::string NameOf(const NamedPoints& points, Index i);
std::string NameOf(const Mesh& mesh, Index vertex);

/**
 * A mesh of triangles. All arrays are public: passes over the whole mesh read and write them
 * directly. A function that changes Triangles must keep Twins right, or leave them to
 * ConnectTwins().
 */
class Mesh
{
public:
  /** The twin of a half-edge with nothing on its right. */
  static constexpr Index Border = None;

  std::vector<Point2> Points;
  std::vector<Index> Triangles; ///< three vertices a triangle, counter-clockwise
  std::vector<Index> Twins;     ///< one a half-edge; filled by ConnectTwins
  /**
   * In a part of a larger mesh, the ids of its points in that mesh, for messages. Points appended
   * here have ids from FirstNewId on.
   */
  std::vector<Index> Ids;
  Index FirstNewId = 0;
  /** How messages number the point of an id, if not by the id. */
  std::function<std::int64_t(Index id)> NumberOf;

  // Queries in constant time. h is a half-edge; those that follow its triangle need no Twins.
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
  /** Makes two half-edges twins; with Border, a half-edge of the border. */
  void Join(Index h, Index twin)
  {
    this->Twins[h] = twin;
    if (twin != Border)
    {
      this->Twins[twin] = h;
    }
  }
  double SquaredLengthOf(Index h) const
  {
    return SquaredLength(this->PointOf(this->Origin(h)), this->PointOf(this->Destination(h)));
  }
  Index IdOf(Index vertex) const
  {
    const Index known = static_cast<Index>(this->Ids.size());
    return known == 0  ? vertex
      : vertex < known ? this->Ids[vertex]
                       : this->FirstNewId + (vertex - known);
  }

  /**
   * Fills Twins from Triangles. Linear in time and memory, except for sorting the borders.
   * @param[in] firstCell  messages name triangle t as cell firstCell + t
   * @throws Error naming the triangle and its edge when an edge has more than two triangles or two
   *         that run the same way (the mesh is not a consistently oriented manifold). Aborted.
   */
  void ConnectTwins(Index firstCell = 0, const Progress& progress = Progress());
};

/** Orders vertices from the lowest on; coincident ones by id. */
struct IsLowerPoint
{
  const Mesh& Surface;

  bool operator()(Index a, Index b) const
  {
    const Point2& p = this->Surface.PointOf(a);
    const Point2& q = this->Surface.PointOf(b);
    return IsLower(p, q) || (a < b && p == q);
  }
};

/** Whether edge ab is lower than edge cd: by origin, then, at pinched vertices, by destination. */
inline bool IsLowerEdge(const Mesh& mesh, Index a, Index b, Index c, Index d)
{
  const IsLowerPoint isLower{ mesh };
  return a == c ? isLower(b, d) : isLower(a, c);
}

/**
 * Turns a closed walk so that its lowest edge is first, whatever the order of triangles.
 * @param[in] originOf  the vertex where the edge of an entry begins
 */
template <typename Place, typename OriginOf>
void StartAtLowest(const Mesh& mesh, Place begin, Place end, const OriginOf& originOf)
{
  const auto next = [&](Place i) { return originOf(i + 1 == end ? *begin : i[1]); };
  Place lowest = begin;
  for (Place i = begin; i != end; ++i)
  {
    lowest = IsLowerEdge(mesh, originOf(*i), next(i), originOf(*lowest), next(lowest)) ? i : lowest;
  }
  std::rotate(begin, lowest, end);
}

/** How many half-edges ahead loops over all of them prefetch the data of origins. */
constexpr std::size_t HalfEdgesAhead = 64;

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
  /** For the place of a vertex in Vertices, that of the next one on its ring. */
  Index After(Index place) const
  {
    // The ring's end is the first offset beyond the place, its begin the one before.
    const auto end = std::upper_bound(this->Offsets.begin(), this->Offsets.end(), place);
    return place + 1 == *end ? end[-1] : place + 1;
  }
};

/**
 * The components of a mesh (with Twins) that are connected by edges. The triangles of a component
 * are on two sides; each edge knows whether it leads to the other side.
 */
struct Components
{
  Buffer<Index> Labels;      ///< one a triangle: 2 component + side
  std::vector<Index> Lowest; ///< one a component: its first triangle, on side 0; increasing

  Index Count() const { return static_cast<Index>(this->Lowest.size()); }
  Index ComponentOf(Index triangle) const { return this->Labels[triangle] / 2; }
};

/** Union-find with parity: labels, as in Components, that turn out to be of one component. */
class LabelSets
{
public:
  /** A new component. @return its label on side 0 */
  Index Add()
  {
    this->JoinedTo.push_back(static_cast<Index>(2 * this->JoinedTo.size()));
    return this->JoinedTo.back();
  }
  /** @return the label that both become */
  Index Join(Index label, Index other)
  {
    label = this->Find(label);
    const Index root = this->Find(other);
    const Index low = std::min(label, root);
    const Index high = std::max(label, root);
    // The same component already. If the sides differ, the relation contradicts itself, as around
    // the end of a line within the mesh: the label then stays as it is.
    if (low / 2 == high / 2)
    {
      return label;
    }
    // The higher component becomes part of the lower one; if its root's side 1 is what is joined,
    // its sides are exchanged.
    this->JoinedTo[high / 2] = low ^ (high & 1);
    return low;
  }
  /** Numbers the labels that were not joined to others, in order; drops the rest of @a lowest. */
  void Renumber(std::vector<Index>& lowest)
  {
    Index remaining = 0;
    for (std::size_t i = 0; i < this->JoinedTo.size(); ++i)
    {
      const Index root = this->JoinedTo[i];
      if (root == static_cast<Index>(2 * i))
      {
        lowest[remaining] = lowest[i];
        this->JoinedTo[i] = 2 * remaining++;
      }
      else
      {
        this->JoinedTo[i] = this->JoinedTo[root / 2] ^ (root & 1);
      }
    }
    lowest.resize(remaining);
  }
  /** The label that a label was joined to. */
  Index operator()(Index label) const { return this->JoinedTo[label / 2] ^ (label & 1); }

private:
  /**
   * The label that a label stands for now. Halves the paths that it follows, so that later calls
   * are short.
   */
  Index Find(Index label)
  {
    while (this->JoinedTo[label / 2] != (label & ~1))
    {
      const Index next = this->JoinedTo[label / 2];
      this->JoinedTo[label / 2] = this->JoinedTo[next / 2] ^ (next & 1); // path halving
      label = (*this)(label);
    }
    return label;
  }

  std::vector<Index> JoinedTo; ///< one a component: itself until it is joined
};

/**
 * Finds the components in one pass, in which each triangle joins the components of its earlier
 * neighbours. Linear, up to a logarithm of the components joined; fast where neighbours are near in
 * memory.
 * @param[in] relation  relation(h), for a half-edge h that is not a border: 0 when the triangles
 *                      at h are on the same side, 1 when they are not, below 0 when h does not
 *                      connect them. Called for one half-edge of each edge.
 * @throws Aborted, std::bad_alloc
 */
template <typename Relation>
Components FindComponents(const Mesh& mesh, const Progress& progress, Relation&& relation)
{
  Stages stages(progress, { 80, 20 });
  const Index count = mesh.NumberOfTriangles();
  Components components;
  components.Labels.Resize(count);
  LabelSets joined;
  ForEachNumber(count, stages.Next(), [&](Index t) {
    Index label = None;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      // Border, which is below 0, is large as an unsigned number.
      const Index twin = mesh.Twins[h];
      const bool isBefore = static_cast<std::uint32_t>(twin) < static_cast<std::uint32_t>(3 * t);
      const int step = isBefore ? relation(h) : -1;
      if (step >= 0)
      {
        const Index other = components.Labels[Mesh::Triangle(twin)] ^ step;
        // All earlier neighbours of a triangle are of one component from now on.
        label = label == None || label == other ? other : joined.Join(label, other);
      }
    }
    if (label == None)
    {
      label = joined.Add();
      components.Lowest.push_back(t);
    }
    components.Labels[t] = label;
  });
  joined.Renumber(components.Lowest);
  ForEachNumber(
    count, stages.Next(), [&](Index t) { components.Labels[t] = joined(components.Labels[t]); });
  return components;
}

/**
 * The border of a mesh (with Twins) as closed walks of half-edges, in the half-edges' own
 * direction, so that the mesh lies on the left: counter-clockwise around the outside of a
 * component, clockwise around a hole. At a vertex where several borders meet, a walk stays with the
 * empty wedge it runs along, so each walk bounds one empty region of the plane. Every border
 * half-edge is in exactly one walk; a walk starts at its lowest half-edge id, and walks are in the
 * order of their first. The result's Vertices are half-edge ids; their origins are the vertices of
 * the walk. Linear, except for sorting the borders at shared vertices.
 * @param[in] keep  one flag a triangle: traces the border of flagged triangles; empty: of all
 * @throws Aborted
 */
Rings TraceBorder(const Mesh& mesh, const Progress& progress = Progress(),
  const std::vector<char>& keep = std::vector<char>());

/**
 * Removes triangles from a mesh with Twins; the others move up, points stay. Linear.
 * @param[in] keep  one flag a triangle
 */
void KeepTriangles(const std::vector<char>& keep, Mesh& mesh);

} // namespace elevation

#endif
