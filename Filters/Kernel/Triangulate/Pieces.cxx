// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces.h"

#include "Kernel/Mesh/Mesh.h"
#include "Triangulate.h"
#include "TriangulateNodes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
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

SettledMesh Triangulated(
  const Piece& piece, const DelaunayOptions& options, const SharedLattice* lattice)
{
  PointView view;
  view.Double = piece.Coordinates.data();
  view.Count = piece.Count();
  const bool areAll = piece.Edges.empty(); // points of a cell: mostly a lattice well filled
  Triangulation triangulation =
    lattice ? TriangulateNodes(view, *lattice, options, areAll) : Triangulate(view, options);
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
