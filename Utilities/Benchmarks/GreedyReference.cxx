// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "GreedyReference.h"

#include "Kernel/Base/Predicates.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <queue>
#include <utility>

namespace benchmark
{
namespace
{
using elevation::InCircle;
using elevation::None;
using elevation::Orientation;
using elevation::Point2;

struct Triangle
{
  Index Corners[3];   // counter-clockwise
  Index Neighbors[3]; // over the edge from corner k to the next
  Index First = None; // of the list of its points
  Index Worst = None;
  double Error = 0.0;
  bool IsInCavity = false;

  int EdgeFrom(Index corner) const
  {
    return this->Corners[0] == corner ? 0 : this->Corners[1] == corner ? 1 : 2;
  }
};

class Insertion
{
public:
  Insertion(const Coordinates& points, bool isDelaunay);

  bool IsLine() const { return this->Triangles.empty(); }
  Index NumberOfVertices() const { return this->Vertices; }
  /** Inserts the worst point. @return false when none is above the error */
  bool InsertWorst(double error);

private:
  struct RimEdge
  {
    Index From, To, Beyond;
  };

  Point2 At(Index point) const
  {
    return { this->Points[3 * std::size_t(point)], this->Points[3 * std::size_t(point) + 1] };
  }
  double ElevationOf(Index point) const { return this->Points[3 * std::size_t(point) + 2]; }
  int SideOf(Index from, Index to, Index point) const
  {
    return Orientation(this->At(from), this->At(to), this->At(point));
  }
  bool IsInCircle(const Triangle& triangle, Index point) const
  {
    return InCircle(this->At(triangle.Corners[0]), this->At(triangle.Corners[1]),
             this->At(triangle.Corners[2]), this->At(point)) > 0;
  }
  std::vector<Index> FindHull(const std::vector<Index>& sorted) const;
  void TriangulateHull(const std::vector<Index>& hull);
  void Flip(Index triangle, int edge);
  double ErrorAt(const Index* corners, Index point) const;
  void Enter(Index triangle, Index point);
  void FlipByData();
  double ShapeOf(Index a, Index b, Index c) const;
  bool IsBetterFlipped(Index triangle) const;
  void FindCavity(Index point, Index start);
  void Insert(Index point, Index start);

  const Coordinates& Points;
  const bool IsDelaunay;
  std::vector<Triangle> Triangles;
  std::vector<Index> Next; // in the list of a triangle
  std::priority_queue<std::pair<double, Index>> Queue;
  Index Vertices = 0;
  std::vector<Index> Cavity, Moved, Star;
  std::vector<RimEdge> Rim; // counter-clockwise
};

Insertion::Insertion(const Coordinates& points, bool isDelaunay)
  : Points(points)
  , IsDelaunay(isDelaunay)
  , Next(points.size() / 3, None)
{
  std::vector<Index> sorted(this->Next.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  std::sort(sorted.begin(), sorted.end(), [this](Index a, Index b) {
    const Point2 p = this->At(a), q = this->At(b);
    return p.X != q.X ? p.X < q.X : p.Y != q.Y ? p.Y < q.Y : a < b;
  });
  sorted.erase(std::unique(sorted.begin(), sorted.end(),
                 [this](Index a, Index b) { return this->At(a) == this->At(b); }),
    sorted.end());
  std::vector<Index> hull = this->FindHull(sorted);
  if (hull.size() < 3)
  {
    return;
  }
  this->TriangulateHull(hull);
  std::sort(hull.begin(), hull.end());
  Index at = 0;
  for (const Index point : sorted)
  {
    if (!std::binary_search(hull.begin(), hull.end(), point))
    {
      // The next of the order is near: walk.
      for (int k = 0; k < 3; ++k)
      {
        const Triangle& here = this->Triangles[at];
        if (this->SideOf(here.Corners[k], here.Corners[(k + 1) % 3], point) < 0)
        {
          at = here.Neighbors[k];
          k = -1;
        }
      }
      this->Enter(at, point);
    }
  }
  for (std::size_t i = 0; i < this->Triangles.size(); ++i)
  {
    this->Queue.push({ this->Triangles[i].Error, static_cast<Index>(i) });
  }
}

/** The corners of the convex hull, counter-clockwise [Andrew 1979]. */
std::vector<Index> Insertion::FindHull(const std::vector<Index>& sorted) const
{
  std::vector<Index> hull;
  const auto add = [&](Index point, std::size_t least) {
    while (hull.size() > least && this->SideOf(hull[hull.size() - 2], hull.back(), point) <= 0)
    {
      hull.pop_back();
    }
    hull.push_back(point);
  };
  std::for_each(sorted.begin(), sorted.end(), [&](Index point) { add(point, 1); });
  const std::size_t half = hull.size();
  for (auto point = sorted.rbegin() + 1; half > 1 && point != sorted.rend(); ++point)
  {
    add(*point, half);
  }
  if (hull.size() > 1)
  {
    hull.pop_back();
  }
  return hull;
}

/** A fan, with edges flipped until it is Delaunay [Lawson 1977]. */
void Insertion::TriangulateHull(const std::vector<Index>& hull)
{
  const Index count = static_cast<Index>(hull.size()) - 2;
  this->Vertices = static_cast<Index>(hull.size());
  std::vector<std::pair<Index, Index>> edges; // a triangle and the corner where it begins
  for (Index i = 0; i < count; ++i)
  {
    this->Triangles.push_back(
      { { hull[0], hull[i + 1], hull[i + 2] }, { i - 1, None, i + 1 < count ? i + 1 : None } });
    edges.push_back({ i, hull[0] });
  }
  while (!edges.empty())
  {
    const auto edge = edges.back();
    edges.pop_back();
    const Triangle& left = this->Triangles[edge.first];
    const int k = left.EdgeFrom(edge.second);
    if (left.Corners[k] != edge.second || left.Neighbors[k] == None)
    {
      continue;
    }
    const Index beyond = left.Neighbors[k];
    const Triangle& right = this->Triangles[beyond];
    const int j = right.EdgeFrom(left.Corners[(k + 1) % 3]);
    if (this->IsInCircle(left, right.Corners[(j + 2) % 3]))
    {
      this->Flip(edge.first, k);
      for (const Index triangle : { edge.first, beyond })
      {
        for (const Index corner : this->Triangles[triangle].Corners)
        {
          edges.push_back({ triangle, corner });
        }
      }
    }
  }
}

void Insertion::Flip(Index triangle, int edge)
{
  Triangle& left = this->Triangles[triangle];
  const Index other = left.Neighbors[edge];
  Triangle& right = this->Triangles[other];
  const Index a = left.Corners[edge], b = left.Corners[(edge + 1) % 3];
  const Index c = left.Corners[(edge + 2) % 3];
  const int j = right.EdgeFrom(b);
  const Index d = right.Corners[(j + 2) % 3];
  const Index overBC = left.Neighbors[(edge + 1) % 3], overCA = left.Neighbors[(edge + 2) % 3];
  const Index overAD = right.Neighbors[(j + 1) % 3], overDB = right.Neighbors[(j + 2) % 3];
  left = { { a, d, c }, { overAD, other, overCA } };
  right = { { d, b, c }, { overDB, overBC, triangle } };
  const auto relink = [this](Index outside, Index from, Index to) {
    if (outside != None)
    {
      this->Triangles[outside].Neighbors[this->Triangles[outside].EdgeFrom(from)] = to;
    }
  };
  relink(overAD, d, triangle);
  relink(overBC, c, other);
}

/** The vertical distance of a point from the triangle that it lies in. */
double Insertion::ErrorAt(const Index* corners, Index point) const
{
  const Point2 p = this->At(point);
  double weights = 0.0, sum = 0.0;
  for (int k = 0; k < 3; ++k)
  {
    const Point2 a = this->At(corners[(k + 1) % 3]), b = this->At(corners[(k + 2) % 3]);
    const double weight =
      std::max(0.0, (a.X - p.X) * (b.Y - p.Y) - (a.Y - p.Y) * (b.X - p.X)); // rounding
    weights += weight;
    sum += weight * (this->ElevationOf(corners[k]) - this->ElevationOf(point));
  }
  return weights > 0.0 ? std::fabs(sum / weights) : 0.0;
}

/** Puts a point into the list of the triangle that it lies in. */
void Insertion::Enter(Index triangle, Index point)
{
  Triangle& here = this->Triangles[triangle];
  const double error = this->ErrorAt(here.Corners, point);
  this->Next[point] = here.First;
  here.First = point;
  if (here.Worst == None || error > here.Error)
  {
    here.Worst = point;
    here.Error = error;
  }
}

/** The triangles whose circles a point is in, and the edges around them from some edge on. */
void Insertion::FindCavity(Index point, Index start)
{
  this->Cavity.assign(1, start);
  this->Rim.clear();
  this->Triangles[start].IsInCavity = true;
  std::vector<std::pair<Index, int>> open{ { start, 2 }, { start, 1 }, { start, 0 } };
  while (!open.empty())
  {
    const Triangle& inner = this->Triangles[open.back().first];
    const int k = open.back().second;
    open.pop_back();
    const Index from = inner.Corners[k], to = inner.Corners[(k + 1) % 3];
    const Index beyond = inner.Neighbors[k];
    if (beyond != None && !this->Triangles[beyond].IsInCavity &&
      (this->IsDelaunay ? this->IsInCircle(this->Triangles[beyond], point)
                        : this->SideOf(from, to, point) == 0))
    {
      const int j = this->Triangles[beyond].EdgeFrom(to);
      this->Triangles[beyond].IsInCavity = true;
      this->Cavity.push_back(beyond);
      open.push_back({ beyond, (j + 2) % 3 });
      open.push_back({ beyond, (j + 1) % 3 });
      continue;
    }
    this->Rim.push_back({ from, to, beyond });
  }
}

void Insertion::Insert(Index point, Index start)
{
  this->FindCavity(point, start);
  this->Moved.clear();
  for (const Index triangle : this->Cavity)
  {
    for (Index i = this->Triangles[triangle].First; i != None; i = this->Next[i])
    {
      this->Moved.push_back(i);
    }
  }
  // An edge of the hull that the point lies on gets no triangle; the others begin behind it.
  const auto gap = std::find_if(this->Rim.begin(), this->Rim.end(), [&](const RimEdge& edge) {
    return edge.Beyond == None && this->SideOf(edge.From, edge.To, point) == 0;
  });
  const bool isClosed = gap == this->Rim.end();
  if (!isClosed)
  {
    std::rotate(this->Rim.begin(), gap + 1, this->Rim.end());
    this->Rim.pop_back();
  }
  const std::size_t count = this->Rim.size();
  this->Star = this->Cavity;
  while (this->Star.size() < count)
  {
    this->Star.push_back(static_cast<Index>(this->Triangles.size()));
    this->Triangles.emplace_back();
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    const RimEdge& edge = this->Rim[i];
    const Index after = i + 1 < count ? this->Star[i + 1] : isClosed ? this->Star[0] : None;
    const Index before = i > 0 ? this->Star[i - 1] : isClosed ? this->Star[count - 1] : None;
    this->Triangles[this->Star[i]] = { { edge.From, edge.To, point },
      { edge.Beyond, after, before } };
    if (edge.Beyond != None)
    {
      Triangle& outside = this->Triangles[edge.Beyond];
      outside.Neighbors[outside.EdgeFrom(edge.To)] = this->Star[i];
    }
  }
  std::size_t sector = 0;
  for (const Index moved : this->Moved)
  {
    if (moved != point)
    {
      while (this->SideOf(point, this->Rim[sector].From, moved) < 0 ||
        this->SideOf(point, this->Rim[sector].To, moved) > 0)
      {
        sector = (sector + 1) % count;
      }
      this->Enter(this->Star[sector], moved);
    }
  }
  ++this->Vertices;
  if (!this->IsDelaunay)
  {
    this->FlipByData();
  }
}

/** How far a triangle is from a sliver: its area in parts of the squares of its edges. */
double Insertion::ShapeOf(Index a, Index b, Index c) const
{
  const Point2 p = this->At(a), q = this->At(b), r = this->At(c);
  const auto square = [](const Point2& u, const Point2& v) {
    return (v.X - u.X) * (v.X - u.X) + (v.Y - u.Y) * (v.Y - u.Y);
  };
  return ((q.X - p.X) * (r.Y - p.Y) - (q.Y - p.Y) * (r.X - p.X)) /
    (square(p, q) + square(q, r) + square(r, p));
}

/** Whether a triangle, whose last corner is new, and that over its first edge had better be flipped. */
bool Insertion::IsBetterFlipped(Index triangle) const
{
  const Triangle& here = this->Triangles[triangle];
  const Triangle& beyond = this->Triangles[here.Neighbors[0]];
  const Index from = here.Corners[0], to = here.Corners[1], point = here.Corners[2];
  const Index across = beyond.Corners[(beyond.EdgeFrom(to) + 2) % 3];
  if (this->SideOf(point, from, across) <= 0 || this->SideOf(point, across, to) <= 0)
  {
    return false;
  }
  constexpr double least = 0.5;
  const double shape = std::min(this->ShapeOf(from, to, point), this->ShapeOf(to, from, across));
  const double flipped =
    std::min(this->ShapeOf(point, from, across), this->ShapeOf(point, across, to));
  if (flipped < least * shape || shape < least * flipped)
  {
    return flipped > shape;
  }
  const Index first[] = { point, from, across }, second[] = { point, across, to };
  double sum = 0.0;
  for (const Triangle* one : { &here, &beyond })
  {
    for (Index i = one->First; i != None; i = this->Next[i])
    {
      const double before = this->ErrorAt(one->Corners, i);
      const double after = this->ErrorAt(this->SideOf(point, across, i) < 0 ? first : second, i);
      sum += after * after - before * before;
    }
  }
  return sum < 0.0;
}

/** Flips edges around the triangles of a new point, which are in the star, and those that become so. */
void Insertion::FlipByData()
{
  std::vector<Index> open = this->Star;
  while (!open.empty())
  {
    const Index triangle = open.back();
    open.pop_back();
    const Index other = this->Triangles[triangle].Neighbors[0];
    if (other == None || !this->IsBetterFlipped(triangle))
    {
      continue;
    }
    this->Moved.clear();
    for (const Index one : { triangle, other })
    {
      for (Index i = this->Triangles[one].First; i != None; i = this->Next[i])
      {
        this->Moved.push_back(i);
      }
    }
    this->Flip(triangle, 0); // to (from, across, point) and (across, to, point)
    const Index* const corners = this->Triangles[triangle].Corners;
    for (const Index moved : this->Moved)
    {
      this->Enter(this->SideOf(corners[2], corners[1], moved) < 0 ? triangle : other, moved);
    }
    this->Star.push_back(other);
    open.insert(open.end(), { triangle, other });
  }
}

bool Insertion::InsertWorst(double error)
{
  while (!this->Queue.empty())
  {
    const auto worst = this->Queue.top();
    const Triangle& triangle = this->Triangles[worst.second];
    if (triangle.Error != worst.first || triangle.Worst == None)
    {
      this->Queue.pop(); // has changed since
      continue;
    }
    if (triangle.Error <= error)
    {
      return false;
    }
    this->Queue.pop();
    this->Insert(triangle.Worst, worst.second);
    for (const Index made : this->Star)
    {
      this->Queue.push({ this->Triangles[made].Error, made });
    }
    return true;
  }
  return false;
}
} // namespace

std::vector<GreedyCount> InsertGreedily(
  const Coordinates& points, const std::vector<double>& errors, bool isDelaunay)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  std::vector<GreedyCount> counts;
  Insertion insertion(points, isDelaunay);
  for (std::size_t i = 0; i < errors.size() && !insertion.IsLine(); ++i)
  {
    while (insertion.InsertWorst(errors[i]))
    {
    }
    counts.push_back({ insertion.NumberOfVertices(),
      std::chrono::duration<double>(Clock::now() - start).count() });
  }
  return counts;
}

} // namespace benchmark
