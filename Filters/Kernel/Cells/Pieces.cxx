// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces.h"

#include "Kernel/Grow/Grow.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Triangulate/Triangulate.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
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
  if (step % (1 << 16) == 0)
  {
    Report(progress, 1.0);
  }
}

// The passes: Triangulated(); of a cell MarkSettledInCell(), or MarkAllSettled() on a lattice, of
// seams TakeAll(), MarkCovered() and MarkSettled(); SeamOf(), KeepSettled(). After marking, they
// look at the triangles of Near alone, few of a large cell.

/** The mesh of points, with the state of those of its triangles that may not be settled. */
struct SettledMesh
{
  enum State : char
  {
    Open,    // to be settled by a larger cell
    Covered, // lies where triangles have been settled before
    Settled  // by this cell
  };

  PointView Points;
  Triangulation Result;
  IdSet Border;              // the points on the border of the mesh
  std::vector<Index> Near;   // triangles, increasing; all others are settled
  std::vector<State> States; // of each of these
  std::vector<Edge> Seam;    // edges of triangles that have been settled before, sorted

  Index TriangleCount() const { return static_cast<Index>(this->Result.Triangles.size() / 3); }
  const Index* CornersOf(Index t) const { return this->Result.Triangles.data() + 3 * t; }

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

/** Of seams: all triangles may be open; none has been looked at. */
void TakeAll(SettledMesh& mesh)
{
  mesh.Near.resize(static_cast<std::size_t>(mesh.TriangleCount()));
  std::iota(mesh.Near.begin(), mesh.Near.end(), Index(0));
  mesh.States.assign(mesh.Near.size(), SettledMesh::Open);
}

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
 * Triangulates. The border of what is made is the hull.
 * @param[in] isFilled  the points are all those of a cell: mostly a lattice well filled
 */
SettledMesh Triangulated(
  const PointView& points, DelaunayOptions options, const SharedLattice* lattice, bool isFilled)
{
  options.MaximumEdgeLength = 0.0;
  options.UseLattice = LatticeMode::Off;
  Triangulation result =
    lattice ? TriangulateNodes(points, *lattice, options, isFilled) : Triangulate(points, options);
  IdSet border(points.Count);
  for (const Index point : result.HullPoints)
  {
    border.Add(point);
  }
  return { points, std::move(result), std::move(border), {}, {}, {} };
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
  // Any triangle with a corner there is near.
  for (std::size_t i = 0; i < mesh.Near.size(); ++i)
  {
    CheckAbort(progress, i);
    for (Index h = 3 * mesh.Near[i], k = 0; k < 3; ++k)
    {
      const Edge ends = mesh.EndsOf(h + k);
      if (mesh.Border.Has(ends.first) && mesh.Border.Has(ends.second))
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
 * are places of points, increasing.
 */
Piece SeamOf(const SettledMesh& mesh, const Progress& progress)
{
  std::vector<Edge> open;
  for (std::size_t i = 0; i < mesh.Near.size(); ++i)
  {
    for (Index h = 3 * mesh.Near[i], k = 0; mesh.States[i] == SettledMesh::Open && k < 3; ++k)
    {
      open.push_back(mesh.EndsOf(h + k));
    }
  }
  std::sort(open.begin(), open.end());
  const std::vector<Edge> edges = FindSeamEdges(open, mesh, progress);
  Piece seam;
  const auto add = [&seam](Index vertex) {
    // Each corner comes several times, one after another, as edges are sorted.
    if (seam.Ids.empty() || seam.Ids.back() != vertex)
    {
      seam.Ids.push_back(vertex);
    }
  };
  std::for_each(open.begin(), open.end(), [&add](const Edge& edge) { add(edge.first); });
  for (const Edge& edge : edges)
  {
    add(edge.first);
    add(edge.second);
  }
  const std::vector<Index>& unused = mesh.Result.UnusedPoints;
  // On a line, or fewer than three.
  for (Index i = 0; mesh.Result.Triangles.empty() && i < mesh.Points.Count; ++i)
  {
    if (!std::binary_search(unused.begin(), unused.end(), i))
    {
      add(i);
    }
  }
  std::sort(seam.Ids.begin(), seam.Ids.end());
  seam.Ids.erase(std::unique(seam.Ids.begin(), seam.Ids.end()), seam.Ids.end());
  const auto placeOf = [&seam](Index vertex) {
    const auto at = std::lower_bound(seam.Ids.begin(), seam.Ids.end(), GlobalId(vertex));
    return static_cast<Index>(at - seam.Ids.begin());
  };
  for (const Edge& edge : edges)
  {
    seam.Edges.insert(seam.Edges.end(), { placeOf(edge.first), placeOf(edge.second) });
  }
  for (const GlobalId id : seam.Ids)
  {
    const Index vertex = static_cast<Index>(id);
    const Point2 p = mesh.Points.At(vertex);
    seam.Coordinates.insert(seam.Coordinates.end(), { p.X, p.Y, mesh.Points.Elevation(vertex) });
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

/** Marks what is settled, among the triangles of Near. */
void MarkSettled(
  const Cell& cell, const SharedLattice* lattice, const Progress& progress, SettledMesh& mesh)
{
  constexpr std::size_t ahead = 16; // corners are anywhere in memory
  TriangleList list;
  list.Points = mesh.Points;
  for (std::size_t i = 0; i < mesh.Near.size(); ++i)
  {
    CheckAbort(progress, i);
    const Index* const soon = mesh.CornersOf(mesh.Near[std::min(i + ahead, mesh.Near.size() - 1)]);
    std::for_each(soon, soon + 3, [&list](Index corner) { list.PrefetchPoint(corner); });
    if (mesh.States[i] == SettledMesh::Open &&
      HoldsCircleOf(cell, mesh, mesh.CornersOf(mesh.Near[i]), lattice))
    {
      mesh.States[i] = SettledMesh::Settled;
    }
  }
}

/** Looks at all triangles of a cell. Near has those that are open, or at the border. */
void MarkAllSettled(
  const Cell& cell, const SharedLattice* lattice, const Progress& progress, SettledMesh& mesh)
{
  mesh.Near.clear();
  mesh.States.clear();
  for (Index t = 0; t < mesh.TriangleCount(); ++t)
  {
    CheckAbort(progress, static_cast<std::size_t>(t));
    const Index* const corners = mesh.CornersOf(t);
    const bool isHeld = HoldsCircleOf(cell, mesh, corners, lattice);
    if (!isHeld || mesh.Border.HasAny(corners))
    {
      mesh.Near.push_back(t);
      mesh.States.push_back(isHeld ? SettledMesh::Settled : SettledMesh::Open);
    }
  }
}

/**
 * The points on the border of the mesh, or near that of its box: few, if they are spread evenly.
 * The distance is a quarter of the fourth root of their number n, in spacings, so that n^(3/4)
 * points are near.
 */
IdSet FindNear(const SettledMesh& mesh)
{
  IdSet near = mesh.Border;
  Box box;
  for (const Index point : mesh.Result.HullPoints)
  {
    box.Add(mesh.Points.At(point));
  }
  const double count = static_cast<double>(std::max(1, mesh.Points.Count));
  const double distance = 0.25 * std::sqrt(box.Width() * box.Height() / std::sqrt(count));
  const Box inner{ { box.Low.X + distance, box.Low.Y + distance },
    { box.High.X - distance, box.High.Y - distance } };
  for (Index i = 0; i < mesh.Points.Count; ++i)
  {
    if (!inner.Contains(mesh.Points.At(i)))
    {
      near.Add(i);
    }
  }
  return near;
}

/**
 * Finds what MarkAllSettled() does, and looks at few circles: those of triangles that have a corner
 * which is near, as FindNear() says. Where one is found to be open, its other corners count as
 * near, too. All triangles with a near corner are in Near at the end.
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
  constexpr int mostRounds = 8; // then all triangles are looked at; mostly one or two are enough
  IdSet near = FindNear(mesh);
  const Index count = mesh.TriangleCount();
  bool hasSpread = true;
  for (int round = 0; hasSpread && round < mostRounds; ++round)
  {
    mesh.Near.clear();
    for (Index t = 0; t < count; ++t)
    {
      CheckAbort(progress, static_cast<std::size_t>(t));
      if (near.HasAny(mesh.CornersOf(t)))
      {
        mesh.Near.push_back(t);
      }
    }
    // What a round before has looked at is looked at again: few.
    mesh.States.assign(mesh.Near.size(), SettledMesh::Open);
    MarkSettled(cell, nullptr, progress, mesh);
    hasSpread = false;
    for (std::size_t i = 0; i < mesh.Near.size(); ++i)
    {
      const Index* const corners = mesh.CornersOf(mesh.Near[i]);
      if (mesh.States[i] == SettledMesh::Open &&
        !std::all_of(corners, corners + 3, [&near](Index corner) { return near.Has(corner); }))
      {
        hasSpread = true;
        near.AddAll(corners);
      }
    }
  }
  if (hasSpread)
  {
    MarkAllSettled(cell, nullptr, progress, mesh);
  }
}

/** Takes away the triangles that are not settled. */
void KeepSettled(const Progress& progress, SettledMesh& mesh)
{
  Buffer<Index>& triangles = mesh.Result.Triangles;
  Index* to = triangles.data();
  const Index* from = to; // where a stretch of settled triangles begins
  const auto moveUntil = [&](Index t) {
    to = std::copy(from, mesh.CornersOf(t), to);
    Report(progress, 1.0);
  };
  for (std::size_t i = 0; i < mesh.Near.size(); ++i)
  {
    if (mesh.States[i] != SettledMesh::Settled)
    {
      moveUntil(mesh.Near[i]);
      from = mesh.CornersOf(mesh.Near[i] + 1);
    }
  }
  moveUntil(mesh.TriangleCount());
  triangles.Resize(static_cast<std::size_t>(to - triangles.data()));
}
} // namespace

SettledCell SettleCell(const PointView& points, GlobalId first, const Cell& cell,
  const DelaunayOptions& options, const SharedLattice* lattice)
{
  SettledMesh mesh = Triangulated(points, options, lattice, true);
  if (lattice)
  {
    MarkAllSettled(cell, lattice, options.Monitor, mesh);
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
  // Without an edge nothing is settled yet: these are all points of the cell.
  SettledMesh mesh = Triangulated(points, options, lattice, seams.Edges.empty());
  for (std::size_t i = 0; i < seams.Edges.size(); i += 2)
  {
    mesh.Seam.emplace_back(seams.Edges[i], seams.Edges[i + 1]);
  }
  std::sort(mesh.Seam.begin(), mesh.Seam.end());
  TakeAll(mesh);
  MarkCovered(mesh);
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
