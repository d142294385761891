// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces.h"

#include "DivideAndConquer.h"
#include "Kernel/Mesh/Mesh.h"
#include "LatticeGrowth.h"
#include "Triangulate.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace elevation
{

bool Cell::HoldsCircle(Point2 a, Point2 b, Point2 c) const
{
  if (this->IsWholePlane())
  {
    return true;
  }
  // The centre from a, and a bound of its error: of each product a few units in the last place.
  constexpr double unit = 32.0 * std::numeric_limits<double>::epsilon();
  // With d above it, the radius is above 1e-101, and what products lose below 1e-308 shifts the centre
  // by less than 1e-122: far less than the rounding that is allowed for.
  constexpr double smallest = 1e-200;
  const double bx = b.X - a.X, by = b.Y - a.Y, cx = c.X - a.X, cy = c.Y - a.Y;
  const double d = 2.0 * (bx * cy - by * cx);
  const double errorOfD = unit * (std::fabs(bx * cy) + std::fabs(by * cx));
  if (!(std::fabs(d) > 4.0 * errorOfD && std::fabs(d) > smallest))
  {
    return false;
  }
  const double b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const double x = (cy * b2 - by * c2) / d, y = (bx * c2 - cx * b2) / d;
  const double relative = 2.0 * errorOfD / std::fabs(d) + unit;
  const double error = relative *
    (std::fabs(cy * b2) + std::fabs(by * c2) + std::fabs(bx * c2) + std::fabs(cx * b2)) /
    std::fabs(d);
  const double radius = std::hypot(x, y) * (1.0 + unit) + 4.0 * error;
  const auto isInside = [radius](double corner, double centre, double low, double high) {
    const double rounding = unit * (std::fabs(corner) + std::fabs(centre) + radius);
    return corner + centre - radius - rounding > low && corner + centre + radius + rounding < high;
  };
  return isInside(a.X, x, this->Low.X, this->High.X) && isInside(a.Y, y, this->Low.Y, this->High.Y);
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

/** The mesh of a piece, with the state of its triangles. */
struct SettledMesh
{
  enum State : char
  {
    Open,    // to be settled by a larger cell
    Covered, // lies where triangles have been settled before
    Settled  // by this cell
  };
  Mesh Surface;
  std::vector<State> States; // of each triangle
  std::vector<Edge> Seam;    // the edges of the piece, sorted
  std::vector<Index> Unused; // places of duplicates and the like, increasing

  bool IsOnSeam(Index halfEdge) const
  {
    return std::binary_search(this->Seam.begin(), this->Seam.end(), this->EndsOf(halfEdge));
  }

  Edge EndsOf(Index halfEdge) const
  {
    const Index next = halfEdge % 3 == 2 ? halfEdge - 2 : halfEdge + 1;
    return { this->Surface.Triangles[halfEdge], this->Surface.Triangles[next] };
  }
};

/** A point by its node, column and row, and its place in a piece. */
struct PlacedNode
{
  LatticeNode Node;
  Index Place;
};

/** @throws NotOnLattice if a point is on no node */
std::vector<PlacedNode> FindNodes(const PointView& points, const SharedLattice& lattice,
  std::vector<Index>& notFinite, const Progress& progress)
{
  std::vector<PlacedNode> placed;
  for (Index id = 0; id < points.Count; ++id)
  {
    ReportStep(progress, id, points.Count);
    const Point2 p = points.At(id);
    if (!std::isfinite(p.X) || !std::isfinite(p.Y) || !std::isfinite(points.Elevation(id)))
    {
      notFinite.push_back(id);
      continue;
    }
    placed.push_back({ lattice.NodeOf(p), id });
  }
  return placed;
}

/**
 * Sorts nodes from the lowest up, and keeps one point on each.
 * @throws NotOnLattice when two points are on a node that are not equal
 */
void KeepOneOnEach(const PointView& points, DuplicatePolicy policy, std::vector<PlacedNode>& placed,
  std::vector<Index>& duplicates, const Progress& progress)
{
  const auto isSame = [](const PlacedNode& p, const PlacedNode& q) {
    return p.Node.I == q.Node.I && p.Node.J == q.Node.J;
  };
  Sort(
    placed.begin(), placed.end(),
    [&](const PlacedNode& p, const PlacedNode& q) {
      return isSame(p, q) ? IsPreferred(points, policy, p.Place, q.Place)
                          : std::tie(p.Node.J, p.Node.I) < std::tie(q.Node.J, q.Node.I);
    },
    progress);
  std::size_t kept = 0;
  for (std::size_t i = 1; i < placed.size(); ++i)
  {
    if (!isSame(placed[kept], placed[i]))
    {
      placed[++kept] = placed[i];
      continue;
    }
    if (points.At(placed[kept].Place) != points.At(placed[i].Place))
    {
      throw NotOnLattice();
    }
    duplicates.push_back(placed[i].Place);
  }
  placed.resize(std::min(placed.size(), kept + 1));
  std::sort(duplicates.begin(), duplicates.end());
}

/** By divide and conquer, which minds no wide gaps between points, as seams have them. */
Triangulation TriangulateNodes(
  const PointView& points, const SharedLattice& lattice, const DelaunayOptions& options)
{
  Triangulation triangulation;
  std::vector<Index> notFinite, duplicates;
  std::vector<PlacedNode> placed =
    FindNodes(points, lattice, notFinite, Part(options.Monitor, 0.0, 0.1));
  KeepOneOnEach(points, options.Duplicates, placed, duplicates, Part(options.Monitor, 0.1, 0.2));
  Buffer<Point2> nodes;
  nodes.Reserve(placed.size());
  std::int64_t firstColumn = placed.empty() ? 0 : placed.front().Node.I;
  for (const PlacedNode& one : placed)
  {
    firstColumn = std::min(firstColumn, one.Node.I);
  }
  for (const PlacedNode& one : placed)
  {
    nodes.Append({ static_cast<double>(one.Node.I - firstColumn),
      static_cast<double>(one.Node.J - placed.front().Node.J) });
  }
  triangulation.Triangles =
    DivideAndConquer(nodes, Part(options.Monitor, 0.2, 1.0), &lattice.Metric());
  for (Index& corner : triangulation.Triangles)
  {
    corner = placed[corner].Place;
  }
  SetUnusedPoints(std::move(duplicates), notFinite, Progress(), triangulation);
  return triangulation;
}

Triangulation TriangulatePoints(const PointView& points, const DelaunayOptions& options,
  const SharedLattice* lattice, bool areAll)
{
  if (!lattice)
  {
    return Triangulate(points, options);
  }
  Triangulation triangulation;
  LatticeSearch search;
  if (areAll)
  {
    // All points of a cell: mostly well filled, so that nodes are found fast.
    static_cast<Extent&>(search) = FindExtent(
      points, ThreadsAtOnce(options.NumberOfThreads), Progress(), [](Index, const Point2&) {});
    search.Found = true;
    search.Steps = lattice->Steps();
  }
  DelaunayOptions onLattice = options;
  onLattice.LatticeTolerance = lattice->Tolerance();
  if (search.Found && TriangulateOnLattice(points, search, onLattice, triangulation))
  {
    return triangulation;
  }
  return TriangulateNodes(points, *lattice, options);
}

SettledMesh Triangulated(
  const Piece& piece, const DelaunayOptions& options, const SharedLattice* lattice)
{
  PointView view;
  view.Double = piece.Coordinates.data();
  view.Count = piece.Count();
  Triangulation triangulation = TriangulatePoints(view, options, lattice, piece.Edges.empty());
  SettledMesh mesh;
  mesh.Unused = std::move(triangulation.UnusedPoints);
  mesh.Surface.Points.reserve(view.Count);
  for (Index i = 0; i < view.Count; ++i)
  {
    mesh.Surface.Points.push_back(view.At(i));
  }
  mesh.Surface.Triangles.assign(triangulation.Triangles.begin(), triangulation.Triangles.end());
  mesh.Surface.ConnectTwins();
  mesh.States.assign(mesh.Surface.Triangles.size() / 3, SettledMesh::Open);
  for (std::size_t i = 0; i < piece.Edges.size(); i += 2)
  {
    mesh.Seam.emplace_back(piece.Edges[i], piece.Edges[i + 1]);
  }
  std::sort(mesh.Seam.begin(), mesh.Seam.end());
  return mesh;
}

/** Marks what lies to the left of edges of the piece, as far as the next such edges. */
void MarkCovered(SettledMesh& mesh)
{
  std::vector<Index> stack;
  std::size_t found = 0;
  const Index count = static_cast<Index>(mesh.Surface.Triangles.size());
  for (Index h = 0; !mesh.Seam.empty() && h < count; ++h)
  {
    if (mesh.IsOnSeam(h))
    {
      ++found;
      stack.push_back(h / 3);
    }
  }
  if (found != mesh.Seam.size())
  {
    throw std::logic_error(
      "An edge of a settled triangle is missing in the triangulation of seams.");
  }
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
      const Index twin = mesh.Surface.Twins[h];
      if (twin != Mesh::Border && !mesh.IsOnSeam(h))
      {
        stack.push_back(twin / 3);
      }
    }
  }
}

/** The corners of open triangles, and the edges between settled ones and these or the outside. */
Piece SeamOf(const Piece& piece, const SettledMesh& mesh)
{
  std::vector<Index> placeOf(piece.Ids.size(), None);
  Piece seam;
  const auto place = [&](Index vertex) {
    if (placeOf[vertex] == None)
    {
      placeOf[vertex] = seam.Count();
      const double* const xyz = piece.Coordinates.data() + 3 * static_cast<std::size_t>(vertex);
      seam.Coordinates.insert(seam.Coordinates.end(), xyz, xyz + 3);
      seam.Ids.push_back(piece.Ids[vertex]);
    }
    return placeOf[vertex];
  };
  const auto isOpen = [&](Index t) { return mesh.States[t] == SettledMesh::Open; };
  const Index count = static_cast<Index>(mesh.Surface.Triangles.size());
  for (Index h = 0; h < count; ++h)
  {
    const Edge ends = mesh.EndsOf(h);
    const Index twin = mesh.Surface.Twins[h];
    if (isOpen(h / 3))
    {
      place(ends.first);
    }
    if (!isOpen(h / 3) && (twin == Mesh::Border || isOpen(twin / 3)))
    {
      const Index first = place(ends.first);
      seam.Edges.insert(seam.Edges.end(), { first, place(ends.second) });
    }
  }
  for (Index i = 0; count == 0 && i < piece.Count(); ++i) // on a line, or fewer than three
  {
    if (!std::binary_search(mesh.Unused.begin(), mesh.Unused.end(), i))
    {
      place(i);
    }
  }
  return seam;
}

/** @throws NotOnLattice if the triangle is flat or inverted in the coordinates of its points */
bool HoldsCircleOf(const Cell& cell, Point2 a, Point2 b, Point2 c, const SharedLattice* lattice)
{
  if (!lattice)
  {
    return cell.HoldsCircle(a, b, c);
  }
  const bool isHeld = cell.IsWholePlane() ||
    cell.Holds(lattice->BoxOfCircle(lattice->NodeOf(a), lattice->NodeOf(b), lattice->NodeOf(c)));
  if (isHeld && Orientation(a, b, c) != Positive)
  {
    throw NotOnLattice();
  }
  return isHeld;
}
} // namespace

Piece Settle(const Piece& piece, const Cell& cell, const DelaunayOptions& options,
  std::vector<GlobalTriangle>& settled, const SharedLattice* lattice)
{
  SettledMesh mesh = Triangulated(piece, options, lattice);
  MarkCovered(mesh);
  for (std::size_t t = 0; t < mesh.States.size(); ++t)
  {
    const Index* const corners = mesh.Surface.Triangles.data() + 3 * t;
    const Point2 a = mesh.Surface.Points[corners[0]];
    const Point2 b = mesh.Surface.Points[corners[1]];
    const Point2 c = mesh.Surface.Points[corners[2]];
    if (mesh.States[t] == SettledMesh::Open && HoldsCircleOf(cell, a, b, c, lattice))
    {
      mesh.States[t] = SettledMesh::Settled;
      settled.push_back({ piece.Ids[corners[0]], piece.Ids[corners[1]], piece.Ids[corners[2]] });
    }
  }
  return SeamOf(piece, mesh);
}

} // namespace elevation
