// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "NaturalNeighbors.h"

#include <algorithm>
#include <cmath>

namespace elevation
{

namespace
{

/** Twice the area of the triangle of the origin, a and b; positive if they turn left. */
double Cross(const Point2& a, const Point2& b)
{
  return DifferenceOfProducts(a.X, b.Y, a.Y, b.X);
}

Point2 Difference(const Point2& p, const Point2& origin)
{
  return { p.X - origin.X, p.Y - origin.Y };
}

/** The centre of the circle through the origin, a and b. */
Point2 CircleCenter(const Point2& a, const Point2& b)
{
  const double twice = 2.0 * Cross(a, b);
  const double aa = a.X * a.X + a.Y * a.Y, bb = b.X * b.X + b.Y * b.Y;
  return { DifferenceOfProducts(aa, b.Y, bb, a.Y) / twice,
    DifferenceOfProducts(bb, a.X, aa, b.X) / twice };
}

} // namespace

std::array<VertexWeight, 3> LinearWeights(const Mesh& mesh, Index triangle, const Point2& place)
{
  const Index* const corners = mesh.Triangles.data() + 3 * static_cast<std::size_t>(triangle);
  const Point2 a = Difference(mesh.PointOf(corners[0]), place);
  const Point2 b = Difference(mesh.PointOf(corners[1]), place);
  const Point2 c = Difference(mesh.PointOf(corners[2]), place);
  const double areas[] = { Cross(b, c), Cross(c, a), Cross(a, b) };
  const double sum = areas[0] + areas[1] + areas[2];
  std::array<VertexWeight, 3> weights;
  for (int k = 0; k < 3; ++k)
  {
    weights[k] = { corners[k], sum > 0.0 ? areas[k] / sum : 1.0 / 3.0 };
  }
  return weights;
}

bool NaturalNeighbors::Find(const Point2& place, Index triangle, std::vector<VertexWeight>& weights)
{
  weights.clear();
  this->Place = place;
  this->CollectRegion(triangle);
  // Around the region, from each of its outer edges to the next.
  Index edge = this->OuterEdge;
  double total = 0.0;
  do
  {
    const Index vertex = this->Surface.Destination(edge);
    const Point2 from = Difference(this->Surface.PointOf(this->Surface.Origin(edge)), place);
    const Point2 at = Difference(this->Surface.PointOf(vertex), place);
    if (!(Cross(from, at) > 0.0))
    {
      return false;
    }
    weights.push_back({ vertex, this->AreaLostBy(edge, from, at) });
    total += weights.back().Weight;
  } while (edge != this->OuterEdge);
  for (VertexWeight& each : weights)
  {
    each.Weight /= total;
  }
  return this->KeepPlanes(weights);
}

/**
 * Twice the area that the vertex at the end of an outer edge loses: the polygon of the centres of
 * the circles through this edge and the place, through each triangle of the region at the vertex,
 * and through the next outer edge and the place.
 * @param[in,out] edge  becomes the next one
 * @param[in] from, at  its ends, seen from the place
 */
double NaturalNeighbors::AreaLostBy(Index& edge, const Point2& from, const Point2& at) const
{
  const Point2 before = CircleCenter(from, at);
  Point2 last = before;
  double area = 0.0;
  for (Index h = Mesh::Next(edge), twin = h; twin != None; h = Mesh::Next(twin))
  {
    const Point2 center = this->CenterOf(Mesh::Triangle(h));
    area += Cross(last, center);
    last = center;
    edge = h;
    twin = this->Surface.Twin(h);
    twin = twin != Mesh::Border && this->IsInRegion(Mesh::Triangle(twin)) ? twin : None;
  }
  const Point2 after = CircleCenter(
    at, Difference(this->Surface.PointOf(this->Surface.Destination(edge)), this->Place));
  area += Cross(last, after) + Cross(after, before);
  // It turns right, as the place is beyond the centres. Where it has no area, rounding may leave a
  // little of the other sign.
  return std::max(0.0, -area);
}

/** From a triangle that contains the place, as the region is connected. */
void NaturalNeighbors::CollectRegion(Index triangle)
{
  ++this->Round;
  this->Region.assign(1, triangle);
  this->Visited[triangle] = this->Round;
  for (std::size_t i = 0; i < this->Region.size(); ++i)
  {
    for (Index h = 3 * this->Region[i]; h < 3 * this->Region[i] + 3; ++h)
    {
      const Index twin = this->Surface.Twin(h);
      const Index next = twin == Mesh::Border ? None : Mesh::Triangle(twin);
      if (next == None || (!this->IsInRegion(next) && !this->IsInCircle(next)))
      {
        this->OuterEdge = h;
      }
      else if (!this->IsInRegion(next))
      {
        this->Visited[next] = this->Round;
        this->Region.push_back(next);
      }
    }
  }
  CountWork(this->Region.size());
}

bool NaturalNeighbors::IsInCircle(Index triangle) const
{
  const Index h = 3 * triangle;
  return InCircle(this->Surface.PointOf(this->Surface.Origin(h)),
           this->Surface.PointOf(this->Surface.Destination(h)),
           this->Surface.PointOf(this->Surface.Apex(h)), this->Place) == Positive;
}

/** The centre of a triangle's circle, seen from the place. */
Point2 NaturalNeighbors::CenterOf(Index triangle) const
{
  // From a corner, so that its rounding does not depend on how far the place is.
  const Index h = 3 * triangle;
  const Point2& a = this->Surface.PointOf(this->Surface.Origin(h));
  const Point2 center =
    CircleCenter(Difference(this->Surface.PointOf(this->Surface.Destination(h)), a),
      Difference(this->Surface.PointOf(this->Surface.Apex(h)), a));
  return { center.X + (a.X - this->Place.X), center.Y + (a.Y - this->Place.Y) };
}

/**
 * Changes weights by what rounding has left, so that they reproduce planes: each by a share that is
 * linear in the plane, which leaves their sum as it is.
 * @return whether that is little; else they are not known
 */
bool NaturalNeighbors::KeepPlanes(std::vector<VertexWeight>& weights) const
{
  // The place that the weights stand for, and the moments around it.
  Point2 off{ 0.0, 0.0 };
  for (const VertexWeight& each : weights)
  {
    const Point2 to = Difference(this->Surface.PointOf(each.Vertex), this->Place);
    off.X += each.Weight * to.X;
    off.Y += each.Weight * to.Y;
  }
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const VertexWeight& each : weights)
  {
    const Point2 to = Difference(this->Surface.PointOf(each.Vertex), this->Place);
    const double dx = to.X - off.X, dy = to.Y - off.Y;
    xx += each.Weight * dx * dx;
    xy += each.Weight * dx * dy;
    yy += each.Weight * dy * dy;
  }
  const double determinant = DifferenceOfProducts(xx, yy, xy, xy);
  const double alongX = DifferenceOfProducts(yy, off.X, xy, off.Y) / determinant;
  const double alongY = DifferenceOfProducts(xx, off.Y, xy, off.X) / determinant;
  constexpr double most = 1e-3; // of a weight
  bool isLittle = true;
  for (VertexWeight& each : weights)
  {
    const Point2 to = Difference(this->Surface.PointOf(each.Vertex), this->Place);
    const double share = alongX * (to.X - off.X) + alongY * (to.Y - off.Y);
    // Also where it is not a number.
    isLittle = isLittle && std::fabs(share) < most;
    each.Weight -= share * each.Weight;
  }
  return isLittle;
}

} // namespace elevation
