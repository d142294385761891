// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces.h"

#include "Kernel/Mesh/Mesh.h"
#include "Triangulate.h"
#include "TriangulateNodes.h"

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
  if (this->IsWholePlane())
  {
    return true;
  }
  // The centre from a, and a bound of its error: of each product a few units in the last place.
  constexpr double unit = 32.0 * std::numeric_limits<double>::epsilon();
  // With d above it, the radius is above 1e-101, and what products lose below 1e-308 shifts the centre
  // by less than 1e-122: far less than the rounding that is allowed for.
  constexpr double smallest = 1e-200;
  if (this->HoldsByFar(a, b, c))
  {
    return true;
  }
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

bool Cell::HoldsByFar(Point2 a, Point2 b, Point2 c) const
{
  const double bx = b.X - a.X, by = b.Y - a.Y, cx = c.X - a.X, cy = c.Y - a.Y;
  const double d = 2.0 * (bx * cy - by * cx);
  const double distance = std::min(std::min(a.X - this->Low.X, this->High.X - a.X),
    std::min(a.Y - this->Low.Y, this->High.Y - a.Y));
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

/** In loops after the triangulation, which has told all progress: lets an abort in. */
void CheckAbort(const Progress& progress, std::size_t step)
{
  if (step % 49152 == 0) // also a multiple of three
  {
    Report(progress, 1.0);
  }
}

/** The mesh of a piece, with the state of its triangles. */
struct SettledMesh
{
  enum State : char
  {
    Open,    // to be settled by a larger cell
    Covered, // lies where triangles have been settled before
    Settled  // by this cell
  };
  Buffer<Index> Triangles;
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
    return { this->Triangles[halfEdge], this->Triangles[next] };
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
  mesh.Triangles = std::move(triangulation.Triangles);
  mesh.States.assign(mesh.Triangles.size() / 3, SettledMesh::Open);
  for (std::size_t i = 0; i < piece.Edges.size(); i += 2)
  {
    mesh.Seam.emplace_back(piece.Edges[i], piece.Edges[i + 1]);
  }
  std::sort(mesh.Seam.begin(), mesh.Seam.end());
  return mesh;
}

/** Marks what lies to the left of edges of the piece, as far as the next such edges. */
void MarkCovered(Index numberOfPoints, SettledMesh& mesh)
{
  if (mesh.Seam.empty())
  {
    return;
  }
  Mesh surface;
  surface.Points.resize(static_cast<std::size_t>(numberOfPoints));
  surface.Triangles.assign(mesh.Triangles.begin(), mesh.Triangles.end());
  surface.ConnectTwins();
  std::vector<Index> stack;
  std::size_t found = 0;
  const Index count = static_cast<Index>(mesh.Triangles.size());
  for (Index h = 0; h < count; ++h)
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

bool Has(const std::vector<Edge>& sorted, Index from, Index to)
{
  return std::binary_search(sorted.begin(), sorted.end(), Edge{ from, to });
}

/**
 * The edges of settled or covered triangles that have none of these on their right.
 * @param[in] open  the edges of open triangles, sorted
 */
std::vector<Edge> FindEdgesOfSeam(const std::vector<Edge>& open,
  const std::vector<char>& isOnBorder, const SettledMesh& mesh, const Progress& progress)
{
  std::vector<Edge> across; // edges between vertices of the border: those of the border, and others
  const Index count = static_cast<Index>(mesh.Triangles.size());
  for (Index h = 0; h < count; ++h)
  {
    CheckAbort(progress, h);
    const Edge ends = mesh.EndsOf(h);
    if (isOnBorder[ends.first] && isOnBorder[ends.second])
    {
      across.push_back(ends);
    }
  }
  std::sort(across.begin(), across.end());
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

/** The corners of open triangles, and the edges between settled ones and these or the outside. */
Piece SeamOf(const Piece& piece, const SettledMesh& mesh, const Progress& progress)
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
  const std::vector<char> isOnBorder = FindBorder(piece.Count(), mesh.Triangles, progress);
  for (const Edge& edge : FindEdgesOfSeam(open, isOnBorder, mesh, progress))
  {
    const Index first = place(edge.first);
    seam.Edges.insert(seam.Edges.end(), { first, place(edge.second) });
  }
  for (Index i = 0; mesh.States.empty() && i < piece.Count(); ++i) // on a line, or fewer than three
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
  MarkCovered(piece.Count(), mesh);
  const auto at = [&piece](Index vertex) {
    const double* const xyz = piece.Coordinates.data() + 3 * static_cast<std::size_t>(vertex);
    return Point2{ xyz[0], xyz[1] };
  };
  for (std::size_t t = 0; t < mesh.States.size(); ++t)
  {
    CheckAbort(options.Monitor, t);
    const Index* const c = mesh.Triangles.data() + 3 * t;
    if (mesh.States[t] == SettledMesh::Open &&
      HoldsCircleOf(cell, at(c[0]), at(c[1]), at(c[2]), lattice))
    {
      mesh.States[t] = SettledMesh::Settled;
      settled.push_back({ piece.Ids[c[0]], piece.Ids[c[1]], piece.Ids[c[2]] });
    }
  }
  return SeamOf(piece, mesh, options.Monitor);
}

} // namespace elevation
