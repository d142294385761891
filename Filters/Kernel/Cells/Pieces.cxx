// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces.h"

#include "Kernel/Grow/Grow.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Triangulate/Triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace elevation
{

bool Cell::HoldsCircle(Point2 a, Point2 b, Point2 c) const
{
  // The last level: everything left is settled.
  if (this->IsWholePlane())
  {
    return true;
  }
  // The centre from a, and a bound of its error: of each product a few units in the last place.
  constexpr double unit = 32.0 * std::numeric_limits<double>::epsilon();
  // With d above it, the radius is above 1e-101, and what products lose below 1e-308 shifts the
  // centre by less than 1e-122: far less than the rounding that is allowed for.
  constexpr double smallest = 1e-200;
  if (this->ClearlyHolds(a, b, c))
  {
    return true;
  }
  const double bx = b.X - a.X, by = b.Y - a.Y, cx = c.X - a.X, cy = c.Y - a.Y;
  const double d = 2.0 * (bx * cy - by * cx);
  const double errorD = unit * (std::fabs(bx * cy) + std::fabs(by * cx));
  // A triangle so thin has a circle that is not known: it is left to the larger cell.
  if (!(std::fabs(d) > 4.0 * errorD && std::fabs(d) > smallest))
  {
    return false;
  }
  const double b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const double x = (cy * b2 - by * c2) / d, y = (bx * c2 - cx * b2) / d;
  const double relative = 2.0 * errorD / std::fabs(d) + unit;
  const double error = relative *
    (std::fabs(cy * b2) + std::fabs(by * c2) + std::fabs(bx * c2) + std::fabs(cx * b2)) /
    std::fabs(d);
  // A bound that is rounded up; the box around the circle is then rounded outwards once more.
  const double radius = std::hypot(x, y) * (1.0 + unit) + 4.0 * error;
  const auto isInside = [radius](double corner, double centre, double low, double high) {
    const double rounding = unit * (std::fabs(corner) + std::fabs(centre) + radius);
    return corner + centre - radius - rounding > low && corner + centre + radius + rounding < high;
  };
  return isInside(a.X, x, this->Low.X, this->High.X) && isInside(a.Y, y, this->Low.Y, this->High.Y);
}

bool Cell::ClearlyHolds(Point2 a, Point2 b, Point2 c) const
{
  const double bx = b.X - a.X, by = b.Y - a.Y, cx = c.X - a.X, cy = c.Y - a.Y;
  const double d = 2.0 * (bx * cy - by * cx);
  const double distance = this->DistanceFromBorder(a);
  // The product of the squared sides is that of radius and d, squared.
  const double sides = (bx * bx + by * by) * (cx * cx + cy * cy) * SquaredLength(b, c);
  // Where nothing cancels or underflows, rounding takes far less than the hundredth that is spared.
  return std::fabs(d) > 1e-6 * (std::fabs(bx * cy) + std::fabs(by * cx)) && sides > 1e-250 &&
    sides < 1e300 && distance > 0.0 && 4.1 * sides < distance * distance * d * d;
}

Piece Join(Piece&& one, const Piece& other)
{
  Piece joined = std::move(one);
  const Index first = joined.Count();
  joined.Coordinates.insert(
    joined.Coordinates.end(), other.Coordinates.begin(), other.Coordinates.end());
  joined.Ids.insert(joined.Ids.end(), other.Ids.begin(), other.Ids.end());
  for (const Index vertex : other.Edges)
  {
    joined.Edges.push_back(first + vertex);
  }
  return joined;
}

namespace
{
using Edge = std::pair<Index, Index>;

/** Lets an abort in, in loops after the triangulation: that has already reported all progress. */
void CheckAbort(const Progress& progress, std::size_t step)
{
  if (step % 49152 == 0) // also a multiple of three
  {
    Report(progress, 1.0);
  }
}

// The passes, in SettleCell() and SettleSeams(): Triangulated() with what is covered,
// MarkSettled(), SeamOf(), KeepSettled().

/** The mesh of points, with the state of its triangles. */
struct SettledMesh
{
  enum State : char
  {
    Inner,   // not looked at, for it is settled if what is nearer to the border is
    Open,    // to be settled by a larger cell
    Covered, // lies where triangles have been settled before
    Settled  // by this cell
  };
  PointView Points;
  Triangulation Result;
  std::vector<State> States;    // of each triangle
  std::vector<Edge> Seam;       // edges of triangles that have been settled before, sorted
  std::vector<char> IsOnBorder; // of each point: whether it is on the border of the mesh

  const Index* CornersOf(std::size_t t) const { return this->Result.Triangles.data() + 3 * t; }

  /** Whether a half-edge has a triangle on its left that a smaller cell has settled. */
  bool IsOnSeam(Index halfEdge) const
  {
    return std::binary_search(this->Seam.begin(), this->Seam.end(), this->EndsOf(halfEdge));
  }

  Edge EndsOf(Index halfEdge) const
  {
    const Index next = halfEdge % 3 == 2 ? halfEdge - 2 : halfEdge + 1;
    return { this->Result.Triangles[halfEdge], this->Result.Triangles[next] };
  }
};

/** Marks what lies to the left of edges of the piece, as far as the next such edges. */
void MarkCovered(SettledMesh& mesh)
{
  if (mesh.Seam.empty())
  {
    return;
  }
  // Only for seams, which are few points: a cell's first triangulation has nothing covered, and no
  // twins.
  Mesh surface;
  surface.Points.resize(static_cast<std::size_t>(mesh.Points.Count));
  surface.Triangles.assign(mesh.Result.Triangles.begin(), mesh.Result.Triangles.end());
  surface.ConnectTwins();
  std::vector<Index> stack;
  std::size_t found = 0;
  const Index count = static_cast<Index>(mesh.Result.Triangles.size());
  for (Index h = 0; h < count; ++h)
  {
    if (mesh.IsOnSeam(h))
    {
      ++found;
      stack.push_back(h / 3);
    }
  }
  // The theory of Pieces.h says that they are all edges of the triangulation: this is a test of the
  // code.
  if (found != mesh.Seam.size())
  {
    throw std::logic_error(
      "An edge of a settled triangle is missing in the triangulation of seams.");
  }
  // A flood: covered triangles are those within closed chains of such edges.
  while (!stack.empty())
  {
    const Index t = stack.back();
    stack.pop_back();
    if (mesh.States[t] == SettledMesh::Covered)
    {
      continue;
    }
    mesh.States[t] = SettledMesh::Covered;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      const Index twin = surface.Twins[h];
      if (twin != Mesh::Border && !mesh.IsOnSeam(h))
      {
        stack.push_back(twin / 3);
      }
    }
  }
}

/**
 * Marks the vertices on the border of the mesh. Around any other vertex, the ends of the edges that
 * leave it are those from which edges come in, so that their sums are equal.
 */
std::vector<char> FindBorder(
  Index numberOfPoints, const Buffer<Index>& triangles, const Progress& progress)
{
  // Around a vertex of the border, the sum is the difference of the two ends of its fan: never 0.
  // Unsigned, as sums may wrap around.
  std::vector<std::uint32_t> sums(static_cast<std::size_t>(numberOfPoints), 0);
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    CheckAbort(progress, i);
    const Index a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
    sums[a] += static_cast<std::uint32_t>(b - c);
    sums[b] += static_cast<std::uint32_t>(c - a);
    sums[c] += static_cast<std::uint32_t>(a - b);
  }
  std::vector<char> isOnBorder(sums.size());
  std::transform(sums.begin(), sums.end(), isOnBorder.begin(),
    [](std::uint32_t sum) { return static_cast<char>(sum != 0); });
  return isOnBorder;
}

/**
 * Triangulates, and finds what is covered and the border.
 * @param[in] edges  of a Piece; empty: the points are all those of a cell
 */
SettledMesh Triangulated(const PointView& points, const std::vector<Index>& edges,
  DelaunayOptions options, const SharedLattice* lattice)
{
  options.MaximumEdgeLength = 0.0;
  options.UseLattice = LatticeMode::Off;
  SettledMesh mesh;
  mesh.Points = points;
  // Edges come with seams only.
  const bool areAll = edges.empty(); // points of a cell: mostly a lattice well filled
  mesh.Result =
    lattice ? TriangulateNodes(points, *lattice, options, areAll) : Triangulate(points, options);
  mesh.States.assign(mesh.Result.Triangles.size() / 3, SettledMesh::Inner);
  for (std::size_t i = 0; i < edges.size(); i += 2)
  {
    mesh.Seam.emplace_back(edges[i], edges[i + 1]);
  }
  std::sort(mesh.Seam.begin(), mesh.Seam.end());
  MarkCovered(mesh);
  mesh.IsOnBorder = FindBorder(points.Count, mesh.Result.Triangles, options.Monitor);
  return mesh;
}

/** Whether a sorted list has an edge in this direction. */
bool Has(const std::vector<Edge>& sorted, Index from, Index to)
{
  return std::binary_search(sorted.begin(), sorted.end(), Edge{ from, to });
}

/**
 * The edges of settled or covered triangles that have none of these on their right. An edge of a
 * seam separates what is settled from an open triangle or from the outside. From open triangles,
 * edges are known by their twins; those at the outside are found among edges between border points.
 * @param[in] open  the edges of open triangles, sorted
 */
std::vector<Edge> FindSeamEdges(
  const std::vector<Edge>& open, const SettledMesh& mesh, const Progress& progress)
{
  std::vector<Edge> across; // edges between vertices of the border: those of the border, and others
  const char* const isOnBorder = mesh.IsOnBorder.data();
  for (std::size_t t = 0; t < mesh.States.size(); ++t)
  {
    CheckAbort(progress, t);
    const Index* const c = mesh.CornersOf(t);
    if (mesh.States[t] == SettledMesh::Inner ||
      isOnBorder[c[0]] + isOnBorder[c[1]] + isOnBorder[c[2]] < 2)
    {
      continue;
    }
    for (int k = 0; k < 3; ++k)
    {
      const Edge ends{ c[k], c[(k + 1) % 3] };
      if (isOnBorder[ends.first] && isOnBorder[ends.second])
      {
        across.push_back(ends);
      }
    }
  }
  std::sort(across.begin(), across.end());
  // An edge of the border occurs in one direction only.
  const auto isBorder = [&across](const Edge& edge) {
    return Has(across, edge.first, edge.second) && !Has(across, edge.second, edge.first);
  };
  std::vector<Edge> edges;
  for (const Edge& edge : open)
  {
    if (!Has(open, edge.second, edge.first) && !isBorder(edge))
    {
      edges.emplace_back(edge.second, edge.first);
    }
  }
  std::copy_if(across.begin(), across.end(), std::back_inserter(edges),
    [&](const Edge& edge) { return isBorder(edge) && !Has(open, edge.first, edge.second); });
  return edges;
}

/**
 * The corners of open triangles, and the edges between settled ones and these or the outside. Ids
 * are places of points.
 */
Piece SeamOf(const SettledMesh& mesh, const Progress& progress)
{
  std::vector<Index> placeOf(static_cast<std::size_t>(mesh.Points.Count), None);
  Piece seam;
  const auto place = [&](Index vertex) {
    if (placeOf[vertex] == None)
    {
      // A vertex enters the seam when it is first asked for.
      placeOf[vertex] = seam.Count();
      const Point2 p = mesh.Points.At(vertex);
      seam.Coordinates.insert(seam.Coordinates.end(), { p.X, p.Y, mesh.Points.Elevation(vertex) });
      seam.Ids.push_back(vertex);
    }
    return placeOf[vertex];
  };
  // Sorted, so that places in the seam depend on the points, not on the order of triangles.
  std::vector<Edge> open;
  for (std::size_t t = 0; t < mesh.States.size(); ++t)
  {
    for (Index h = 3 * static_cast<Index>(t), k = 0; mesh.States[t] == SettledMesh::Open && k < 3;
         ++k)
    {
      open.push_back(mesh.EndsOf(h + k));
    }
  }
  std::sort(open.begin(), open.end());
  std::for_each(open.begin(), open.end(), [&](const Edge& edge) { place(edge.first); });
  for (const Edge& edge : FindSeamEdges(open, mesh, progress))
  {
    const Index first = place(edge.first);
    seam.Edges.insert(seam.Edges.end(), { first, place(edge.second) });
  }
  const std::vector<Index>& unused = mesh.Result.UnusedPoints;
  // On a line, or fewer than three.
  for (Index i = 0; mesh.States.empty() && i < mesh.Points.Count; ++i)
  {
    if (!std::binary_search(unused.begin(), unused.end(), i))
    {
      place(i);
    }
  }
  return seam;
}

/** @throws NotOnLattice if the triangle is flat or inverted in the coordinates of its points */
bool HoldsCircleOf(
  const Cell& cell, const SettledMesh& mesh, const Index* corners, const SharedLattice* lattice)
{
  const Point2 a = mesh.Points.At(corners[0]), b = mesh.Points.At(corners[1]),
               c = mesh.Points.At(corners[2]);
  if (!lattice)
  {
    return cell.HoldsCircle(a, b, c);
  }
  const bool isHeld = cell.IsWholePlane() ||
    cell.Holds(lattice->CircleBox(lattice->NodeOf(a), lattice->NodeOf(b), lattice->NodeOf(c)));
  if (isHeld && Orientation(a, b, c) != Positive)
  {
    throw NotOnLattice();
  }
  return isHeld;
}

/** Marks what is settled. */
void MarkSettled(
  const Cell& cell, const SharedLattice* lattice, const Progress& progress, SettledMesh& mesh)
{
  for (std::size_t t = 0; t < mesh.States.size(); ++t)
  {
    CheckAbort(progress, t);
    if (mesh.States[t] == SettledMesh::Inner)
    {
      const bool isHeld = HoldsCircleOf(cell, mesh, mesh.CornersOf(t), lattice);
      mesh.States[t] = isHeld ? SettledMesh::Settled : SettledMesh::Open;
    }
  }
}

/**
 * The points on the border of the mesh, or near that of its box: few, if they are spread evenly.
 * The distance is half the fourth root of their number n, in spacings, so that some n^(3/4) points
 * are near.
 */
std::vector<char> FindNear(const SettledMesh& mesh)
{
  std::vector<char> isNear = mesh.IsOnBorder;
  Box box;
  for (Index i = 0; i < mesh.Points.Count; ++i)
  {
    if (mesh.IsOnBorder[i])
    {
      box.Add(mesh.Points.At(i));
    }
  }
  const double count = static_cast<double>(std::max(1, mesh.Points.Count));
  const double distance = 0.5 * std::sqrt(box.Width() * box.Height() / std::sqrt(count));
  const Box inner{ { box.Low.X + distance, box.Low.Y + distance },
    { box.High.X - distance, box.High.Y - distance } };
  for (Index i = 0; i < mesh.Points.Count; ++i)
  {
    isNear[i] |= inner.Contains(mesh.Points.At(i)) ? 0 : 1;
  }
  return isNear;
}

/**
 * Does the same to the mesh of all points of a cell, none of it covered, and looks at few circles:
 * those of triangles that have a corner which is near, as FindNear() says. Where one is found to be
 * open, its other corners count as near, too.
 *
 * The others are settled. For let the circle of a triangle, with its rim, reach a place that is not
 * inside the cell. As the cell is convex and has all points, that place is not inside the mesh
 * either, at most on its border. Walk straight to it from some place inside the triangle, so that
 * no vertex is on the way. Lifted to the paraboloid, the mesh is convex: each edge on the way is
 * crossed to a triangle whose plane is at least as high over that place, so that its circle reaches
 * it as well. Hence all triangles on the way are open. The last of them has an edge on the border
 * of the mesh, whose ends are near; and what shares an edge with an open triangle has two near
 * corners. So all are looked at. It does not matter where rounding alone refuses a circle: what is
 * open without need makes more triangles near, never fewer.
 *
 * It holds for coordinates alone: on a lattice, nodes are triangulated, which are elsewhere.
 */
void MarkSettledInCell(const Cell& cell, const Progress& progress, SettledMesh& mesh)
{
  constexpr int mostRounds = 8; // then all triangles are looked at; mostly two are enough
  std::vector<char> isNear = FindNear(mesh);
  char* const near = isNear.data();
  const Index* const corners = mesh.CornersOf(0);
  const std::size_t count = mesh.States.size();
  bool hasSpread = true;
  for (int round = 0; hasSpread; ++round)
  {
    if (round == mostRounds)
    {
      std::fill(isNear.begin(), isNear.end(), char(1));
    }
    hasSpread = false;
    for (std::size_t t = 0; t < count; ++t)
    {
      CheckAbort(progress, t);
      const Index* const c = corners + 3 * t;
      // By bytes and bits, without branches: nearly all triangles of a large cell are passed over
      // here.
      const char isAny = near[c[0]] | near[c[1]] | near[c[2]];
      if (!isAny || mesh.States[t] != SettledMesh::Inner)
      {
        continue;
      }
      const bool isHeld = HoldsCircleOf(cell, mesh, c, nullptr);
      mesh.States[t] = isHeld ? SettledMesh::Settled : SettledMesh::Open;
      if (!isHeld && !(near[c[0]] & near[c[1]] & near[c[2]]))
      {
        hasSpread = true;
        near[c[0]] = near[c[1]] = near[c[2]] = 1;
      }
    }
  }
}

/** Takes away the triangles that are not settled. */
void KeepSettled(const Progress& progress, SettledMesh& mesh)
{
  Buffer<Index>& triangles = mesh.Result.Triangles;
  Index* to = triangles.data();
  for (std::size_t t = 0; t < mesh.States.size(); ++t)
  {
    CheckAbort(progress, t);
    if (mesh.States[t] == SettledMesh::Settled || mesh.States[t] == SettledMesh::Inner)
    {
      to = std::copy_n(mesh.CornersOf(t), 3, to);
    }
  }
  triangles.Resize(static_cast<std::size_t>(to - triangles.data()));
}
} // namespace

SettledCell SettleCell(const PointView& points, GlobalId first, const Cell& cell,
  const DelaunayOptions& options, const SharedLattice* lattice)
{
  SettledMesh mesh = Triangulated(points, {}, options, lattice);
  if (lattice)
  {
    MarkSettled(cell, lattice, options.Monitor, mesh);
  }
  else
  {
    MarkSettledInCell(cell, options.Monitor, mesh);
  }
  Piece seam = SeamOf(mesh, options.Monitor);
  std::for_each(seam.Ids.begin(), seam.Ids.end(), [first](GlobalId& id) { id += first; });
  KeepSettled(options.Monitor, mesh);
  return { std::move(mesh.Result), std::move(seam) };
}

Piece SettleSeams(const Piece& seams, const Cell& cell, const DelaunayOptions& options,
  std::vector<GlobalTriangle>& settled, const SharedLattice* lattice)
{
  PointView points;
  points.Double = seams.Coordinates.data();
  points.Count = seams.Count();
  SettledMesh mesh = Triangulated(points, seams.Edges, options, lattice);
  MarkSettled(cell, lattice, options.Monitor, mesh);
  Piece seam = SeamOf(mesh, options.Monitor);
  const auto idOf = [&seams](GlobalId place) { return seams.Ids[place]; };
  std::transform(seam.Ids.begin(), seam.Ids.end(), seam.Ids.begin(), idOf);
  KeepSettled(options.Monitor, mesh);
  for (std::size_t i = 0; i < mesh.Result.Triangles.size(); i += 3)
  {
    const Index* const c = mesh.Result.Triangles.data() + i;
    settled.push_back({ idOf(c[0]), idOf(c[1]), idOf(c[2]) });
  }
  return seam;
}

} // namespace elevation
