// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCutter.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace elevation
{

namespace
{

/**
 * Points relative to one, scaled so that products and sums stay in the range of double. The scale
 * is a power of two, and ratios of results do not depend on it.
 */
template <std::size_t Count>
std::array<Point2, Count> Around(const Point2& from, std::array<Point2, Count> points)
{
  double largest = std::max(std::fabs(from.X), std::fabs(from.Y));
  for (const Point2& p : points)
  {
    largest = std::max({ largest, std::fabs(p.X), std::fabs(p.Y) });
  }
  const double scale = ScaleToOne(largest);
  for (Point2& p : points)
  {
    p = { p.X * scale - from.X * scale, p.Y * scale - from.Y * scale };
  }
  return points;
}

} // namespace

double MeshCutter::TwiceArea(Index t) const
{
  const std::array<Point2, 3> corners = this->CornersOf(t);
  return DifferenceOfProducts(corners[1].X - corners[0].X, corners[2].Y - corners[0].Y,
    corners[1].Y - corners[0].Y, corners[2].X - corners[0].X);
}

bool MeshCutter::Holds(Index t, const Point2& p) const
{
  const std::array<Point2, 3> corners = this->CornersOf(t);
  return Orientation(corners[0], corners[1], p) != Negative &&
    Orientation(corners[1], corners[2], p) != Negative &&
    Orientation(corners[2], corners[0], p) != Negative;
}

bool MeshCutter::CanCut(Index h, const Point2& place) const
{
  const Point2& from = this->Surface.PointOf(this->Surface.Origin(h));
  const Point2& to = this->Surface.PointOf(this->Surface.Destination(h));
  const auto isProper = [&](Index half, const Point2& a, const Point2& b) {
    const Point2& apex = this->Surface.PointOf(this->Surface.Apex(half));
    return Orientation(a, place, apex) == Positive && Orientation(place, b, apex) == Positive;
  };
  return isProper(h, from, to) &&
    (this->Surface.IsBorder(h) || isProper(this->Surface.Twin(h), to, from));
}

bool MeshCutter::MoveToCut(
  Index h, Point2& place, const std::function<bool(const Point2&)>& isUsable) const
{
  return this->MoveNear(h, place, true,
    [&](const Point2& p) { return (!isUsable || isUsable(p)) && this->CanCut(h, p); });
}

bool MeshCutter::MoveInside(
  Index h, Point2& place, const std::function<bool(const Point2&)>& isUsable) const
{
  // All around, so that CutTriangle() makes three proper triangles.
  const std::array<Point2, 3> corners = this->CornersOf(Mesh::Triangle(h));
  return this->MoveNear(h, place, false, [&](const Point2& p) {
    return isUsable(p) && Orientation(corners[0], corners[1], p) == Positive &&
      Orientation(corners[1], corners[2], p) == Positive &&
      Orientation(corners[2], corners[0], p) == Positive;
  });
}

bool MeshCutter::MoveNear(
  Index h, Point2& place, bool outwards, const std::function<bool(const Point2&)>& isPlace) const
{
  const Point2& from = this->Surface.PointOf(this->Surface.Origin(h));
  const Point2 way = Around(
    from, std::array<Point2, 1>{ { this->Surface.PointOf(this->Surface.Destination(h)) } })[0];
  const double length = std::hypot(way.X, way.Y);
  // About a unit in the last place of the larger coordinate.
  const double step =
    std::numeric_limits<double>::epsilon() * std::max(std::fabs(place.X), std::fabs(place.Y));
  const double side = outwards ? step : -step;
  // Across the edge: to its right, where nothing is if it is on the border, or to its left, into
  // the triangle.
  const Point2 away{ side * (way.Y / length), -side * (way.X / length) };
  const Point2 first = place;
  const auto isFound = [&](double dx, double dy) {
    place = { first.X + dx, first.Y + dy };
    return std::isfinite(place.X) && std::isfinite(place.Y) && isPlace(place);
  };
  // First the place itself, then the nearest ones, in squares around it, by half units, as the
  // smaller coordinate has finer ones; then places further away, up to 64 units across the edge.
  for (int ring = 0; ring <= 3; ++ring)
  {
    for (int i = -ring; i <= ring; ++i)
    {
      for (int j = -ring; j <= ring; ++j)
      {
        if (std::max(std::abs(i), std::abs(j)) == ring && isFound(0.5 * i * step, 0.5 * j * step))
        {
          return true;
        }
      }
    }
  }
  for (double steps = 4.0; steps <= 64.0; steps *= 2.0)
  {
    if (isFound(steps * away.X, steps * away.Y))
    {
      return true;
    }
  }
  return false;
}

InsertedVertex MeshCutter::WeightsIn(Index t, const Point2& p) const
{
  // Barycentric coordinates: the share of a corner is the area of the triangle that p makes with
  // the two others.
  const std::array<Point2, 3> corners = this->CornersOf(t), around = Around(p, corners);
  std::array<std::pair<Index, double>, 3> shares;
  for (int i = 0; i < 3; ++i)
  {
    const int next = (i + 1) % 3, last = (i + 2) % 3;
    // On an edge, the opposite corner gets exactly 0, whatever the rounding.
    shares[i] = { this->Surface.Origin(3 * t + i),
      Orientation(corners[next], corners[last], p) == Zero
        ? 0.0
        : std::fabs(around[next].X * around[last].Y - around[next].Y * around[last].X) };
  }
  return this->WeightsOf(shares.data(), shares.size());
}

InsertedVertex MeshCutter::WeightsBetween(Index a, Index b, const Point2& p) const
{
  const std::array<Point2, 2> ends =
    Around(p, Ends{ { this->Surface.PointOf(a), this->Surface.PointOf(b) } });
  // The share of an end is the distance to the other end.
  const std::array<std::pair<Index, double>, 2> shares{ { { a, std::hypot(ends[1].X, ends[1].Y) },
    { b, std::hypot(ends[0].X, ends[0].Y) } } };
  return this->WeightsOf(shares.data(), shares.size());
}

InsertedVertex MeshCutter::WeightsOf(
  const std::pair<Index, double>* shares, std::size_t count) const
{
  InsertedVertex vertex{ { None, None, None }, { 0.0, 0.0, 0.0 } };
  double sum = 0.0;
  const auto add = [&](Index corner, double weight) {
    if (weight > 0.0)
    {
      // The corner's own place, or the first free one. There are never more than three: all shares
      // lie in one original triangle.
      int i = 0;
      while (i < 2 && vertex.Corners[i] != corner && vertex.Corners[i] != None)
      {
        ++i;
      }
      vertex.Corners[i] = corner;
      vertex.Weights[i] += weight;
      sum += weight;
    }
  };
  // If all shares underflow, in a tiny or thin triangle, the second attempt gives all corners the
  // same.
  for (int attempt = 0; attempt < 2 && vertex.Corners[0] == None; ++attempt)
  {
    for (std::size_t k = 0; k < count; ++k)
    {
      const Index corner = shares[k].first;
      const double share = attempt == 0 ? shares[k].second : 1.0;
      // A new vertex stands for the original corners that it was made of.
      if (corner < this->CountBefore)
      {
        add(corner, share);
        continue;
      }
      const InsertedVertex& inserted = this->Inserted[corner - this->CountBefore];
      for (int i = 0; i < 3; ++i)
      {
        add(inserted.Corners[i], share * inserted.Weights[i]);
      }
    }
  }
  // On an edge there are two corners; the third entry repeats one of them, with weight 0.
  for (Index& corner : vertex.Corners)
  {
    corner = corner == None ? vertex.Corners[0] : corner;
  }
  const bool isUsable = sum > 0.0 && sum < std::numeric_limits<double>::infinity();
  for (double& weight : vertex.Weights)
  {
    // A sum of 0 or infinity gives no ratios.
    weight = isUsable ? weight / sum : 1.0 / 3.0;
  }
  return vertex;
}

Index MeshCutter::AddVertex(const Point2& p, const InsertedVertex& inserted)
{
  this->Surface.Points.push_back(p);
  this->Inserted.push_back(inserted);
  return this->Surface.NumberOfPoints() - 1;
}

Index MeshCutter::AddPart(Index t)
{
  Mesh& mesh = this->Surface;
  this->Parents.push_back(this->Parent(t));
  mesh.Triangles.resize(mesh.Triangles.size() + 3, None);
  mesh.Twins.resize(mesh.Twins.size() + 3, Mesh::Border);
  return mesh.NumberOfHalfEdges() - 3;
}

void MeshCutter::SetEdge(Index h, Index origin, Index twin)
{
  this->Surface.Triangles[h] = origin;
  this->Surface.Join(h, twin);
}

void MeshCutter::MoveEdge(Index from, Index to, Index origin)
{
  if (this->Surface.IsBorder(from))
  {
    this->Moved[from] = to;
  }
  this->SetEdge(to, origin, this->Surface.Twin(from));
}

//             c
//            /|\            t      becomes a b v
//           / | \           first  is      b c v
//          /  v  \          second is      c a v
//         / /   \ \         ab, bc and ca
//        //   t   \\        keep their twins.
//       a-----------b
void MeshCutter::CutTriangle(Index t, Index v)
{
  Mesh& mesh = this->Surface;
  const Index b = mesh.Origin(3 * t + 1);
  const Index c = mesh.Origin(3 * t + 2);
  const Index a = mesh.Origin(3 * t);
  const Index first = this->AddPart(t);
  const Index second = this->AddPart(t);
  this->MoveEdge(3 * t + 1, first, b);
  this->MoveEdge(3 * t + 2, second, c);
  this->SetEdge(3 * t + 1, b, first + 2);
  this->SetEdge(3 * t + 2, v, second + 1);
  this->SetEdge(first + 1, c, second + 2);
  this->SetEdge(first + 2, v, 3 * t + 1);
  this->SetEdge(second + 1, a, 3 * t + 2);
  this->SetEdge(second + 2, v, first + 1);
}

Index MeshCutter::CutEdge(Index h, Index v)
{
  Mesh& mesh = this->Surface;
  const Index twin = mesh.Twin(h);
  const Index after = this->Halve(h, v);
  if (twin != Mesh::Border)
  {
    const Index afterTwin = this->Halve(twin, v);
    this->SetEdge(h, mesh.Origin(h), afterTwin);
    this->SetEdge(twin, mesh.Origin(twin), after);
  }
  return after;
}

//         c               c          avc keeps the number and h; part = v b c, with half-edges
//        / \             /|\         part = vb, part + 1 = bc, part + 2 = cv. The half-edge next,
//       /   \    ->     / | \        which was bc, becomes vc.
//      a-----b         a--v--b
//         h             h  part
Index MeshCutter::Halve(Index h, Index v)
{
  Mesh& mesh = this->Surface;
  const Index next = Mesh::Next(h);
  const Index b = mesh.Origin(next);
  const Index c = mesh.Apex(h);
  const Index part = this->AddPart(Mesh::Triangle(h));
  this->SetEdge(part, v, Mesh::Border);
  this->MoveEdge(next, part + 1, b); // its old number becomes that of an inner edge
  this->SetEdge(part + 2, c, next);
  this->Surface.Triangles[next] = v;
  return part;
}

Index MeshCutter::CurrentHalfEdge(Index h) const
{
  // A half-edge may be renumbered by each of several cuts.
  for (auto next = this->Moved.find(h); next != this->Moved.end(); next = this->Moved.find(h))
  {
    h = next->second;
  }
  return h;
}

} // namespace elevation
