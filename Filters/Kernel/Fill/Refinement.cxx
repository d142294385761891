// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Refine(t) for each triangle in a queue: measure it, find its circumcentre, look whether a point
// may be there, insert it, flip until all is Delaunay, and put the triangles around the new point
// into the next queue.
//
//        q              The circumcentre p of triangle q a b is in it or beyond its longest edge.
//       / \             Locate() walks from q through that edge to the triangle that holds p. If it
//      / t \            meets the border, p is not visible from t, and t stays as it is.
//     a-----b
//       \ . p
//        \/
#include "Refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace elevation
{

namespace
{

constexpr double LongestEdge = 1.6; // of interior ones, in spacings

/** Least squared ratio of shortest edge to circumradius: (2 sin 20 degrees)^2. */
constexpr double LeastEdgeToRadius = 0.46791111376204392;

class Refinement
{
public:
  Refinement(const PatchPlan& plan, const Patch& patch, Mesh& mesh)
    : Plan(plan)
    , Surface(mesh)
    , BoundaryVertices(patch.NumberOfBoundaryVertices())
    , Unit(1.0 / plan.Spacing)
  {
    if (plan.Kind != Arrangement::Graded)
    {
      return;
    }
    // The plan has them by edge, in the order of the patch's edges.
    this->Spacings.resize(mesh.NumberOfPoints(), std::numeric_limits<double>::infinity());
    const double* next = plan.Spacings.data();
    const auto set = [&](Index vertex) {
      double& spacing = this->Spacings[vertex];
      // A vertex with several edges gets the least of their spacings.
      spacing = std::min(spacing, *next * this->Unit);
      this->Largest = std::max(this->Largest, *next++ * this->Unit);
    };
    for (const Segment& edge : patch.Edges)
    {
      set(edge.A);
    }
    for (const Segment& edge : patch.InnerEdges)
    {
      set(edge.A);
      set(edge.B);
    }
  }

  void Run(const Progress& progress)
  {
    const double count = static_cast<double>(this->Surface.NumberOfPoints());
    // A fraction of a point is no point.
    const double most = this->BoundaryVertices + std::floor(this->Plan.MostPoints);
    std::vector<Index> queue(this->Surface.NumberOfTriangles());
    std::iota(queue.begin(), queue.end(), 0);
    // Round by round: new triangles wait until all older ones, which are larger, have been cut.
    std::vector<Index> next;
    // With points in rows, most triangles are good, and the first round is nearly all the work.
    const double first = this->Spacings.empty() ? static_cast<double>(queue.size()) : 0.0;
    double steps = 0.0;
    while (!queue.empty())
    {
      for (const Index t : queue)
      {
        CountWork(10);
        if (std::fmod(++steps, 4096.0) == 0.0)
        {
          const double points = static_cast<double>(this->Surface.NumberOfPoints());
          Report(progress,
            first > 0.0 ? std::min(1.0, steps / first) : (points - count) / (most - count));
        }
        // The plan's limit holds whatever the order was; what is left stays as it is.
        if (this->Surface.NumberOfPoints() + 1 > most)
        {
          return;
        }
        // The triangle may have changed since it was queued; it is measured as it is now.
        if (this->Refine(t))
        {
          next.insert(next.end(), this->Star.begin(), this->Star.end());
        }
      }
      queue.swap(next);
      next.clear();
    }
  }

private:
  // Squares of lengths are in units of the plan's spacing, so that no product overflows.
  double Square(const Point2& p, const Point2& q) const
  {
    const double x = (q.X - p.X) * this->Unit;
    const double y = (q.Y - p.Y) * this->Unit;
    return x * x + y * y;
  }

  /** Squares of the lengths of a triangle's edges. */
  struct Lengths
  {
    Index Base = None; ///< the longest edge
    double Longest = -1.0;
    double LongestInside = 0.0; ///< of interior edges
    double Shortest = std::numeric_limits<double>::infinity();
  };

  Lengths Measure(Index t) const
  {
    Lengths lengths;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      const double square = this->Square(this->Surface.PointOf(this->Surface.Origin(h)),
        this->Surface.PointOf(this->Surface.Destination(h)));
      if (square > lengths.Longest)
      {
        lengths.Longest = square;
        lengths.Base = h;
      }
      lengths.Shortest = std::min(lengths.Shortest, square);
      lengths.LongestInside =
        this->Surface.IsBorder(h) ? lengths.LongestInside : std::max(lengths.LongestInside, square);
    }
    return lengths;
  }

  /** Inserts a point at the circumcentre of a triangle, if it needs refinement and allows it. */
  bool Refine(Index t)
  {
    const Mesh& mesh = this->Surface;
    const Lengths lengths = this->Measure(t);
    // From the apex opposite the longest edge: no other edge is between it and the circumcentre.
    const Index corners[3] = { mesh.Apex(lengths.Base), mesh.Origin(lengths.Base),
      mesh.Destination(lengths.Base) };
    const Point2& q = mesh.PointOf(corners[0]);
    const Point2& a = mesh.PointOf(corners[1]);
    const Point2& b = mesh.PointOf(corners[2]);
    const Point2 u{ (a.X - q.X) * this->Unit, (a.Y - q.Y) * this->Unit };
    const Point2 v{ (b.X - q.X) * this->Unit, (b.Y - q.Y) * this->Unit };
    const double uu = u.X * u.X + u.Y * u.Y;
    const double vv = v.X * v.X + v.Y * v.Y;
    const double twice = 2.0 * (u.X * v.Y - u.Y * v.X);
    // The solution of |c|^2 = |c - u|^2 = |c - v|^2, with q as the origin.
    const Point2 center{ (v.Y * uu - u.Y * vv) / twice, (u.X * vv - v.X * uu) / twice };
    const double square = center.X * center.X + center.Y * center.Y;
    if (!(square < std::numeric_limits<double>::infinity()))
    {
      return false; // nearly flat: the circumcentre is far outside
    }
    double spacing = 1.0;
    double mean = 1.0;
    if (!this->Spacings.empty())
    {
      const double s[3] = { this->Spacings[corners[0]], this->Spacings[corners[1]],
        this->Spacings[corners[2]] };
      mean = (s[0] + s[1] + s[2]) / 3.0;
      // At the circumcentre, the spacing grows from the least of the corners by the distance to
      // them, which is the circle's radius.
      spacing = std::min(
        this->Largest, std::min(s[0], std::min(s[1], s[2])) + SpacingGrowth * std::sqrt(square));
    }
    const double clearance = LeastClearance * spacing;
    // Three reasons to leave it: it is good; its circle is smaller than the distance that points
    // keep; or doubles could not keep such points apart.
    if ((lengths.LongestInside <= LongestEdge * LongestEdge * mean * mean &&
          lengths.Shortest >= LeastEdgeToRadius * square) ||
      square < clearance * clearance ||
      spacing * this->Plan.Spacing < LeastStepsPerSpacing * this->Plan.Precision)
    {
      return false;
    }
    const Point2 p = this->Plan.Rounded(
      { q.X + center.X * this->Plan.Spacing, q.Y + center.Y * this->Plan.Spacing });
    const Index place = this->Locate(lengths.Base, p);
    return place != None && !this->IsNearBorder(place, p, clearance * clearance) &&
      this->Insert(place, p, spacing);
  }

  /**
   * The triangle that contains a point, by a straight walk from the apex of a half-edge through
   * this edge; None if a border is crossed, or rounding misleads the walk.
   */
  Index Locate(Index h, const Point2& p) const
  {
    const Mesh& mesh = this->Surface;
    const Point2& from = mesh.PointOf(mesh.Apex(h));
    while (
      Orientation(mesh.PointOf(mesh.Origin(h)), mesh.PointOf(mesh.Destination(h)), p) == Negative)
    {
      if (mesh.IsBorder(h))
      {
        return None;
      }
      // The origin of h is on the right of the walk, its destination on the left.
      const Index twin = mesh.Twin(h);
      h = Orientation(from, p, mesh.PointOf(mesh.Apex(twin))) == Negative ? Mesh::Previous(twin)
                                                                          : Mesh::Next(twin);
    }
    // The walk has ended at an edge with p on its left; only exact tests prove that p is in the
    // triangle.
    const Index t = Mesh::Triangle(h);
    for (Index side = 3 * t; side < 3 * t + 3; ++side)
    {
      if (Orientation(mesh.PointOf(mesh.Origin(side)), mesh.PointOf(mesh.Destination(side)), p) ==
        Negative)
      {
        return None;
      }
    }
    return t;
  }

  /**
   * Whether the square distance from a point in a triangle to a border is below a limit. No vertex
   * is that near, as the point is the centre of a larger empty circle, so each edge that near is
   * reached on one path only. By rounding a vertex might be: mostEdges is a limit for that case.
   */
  bool IsNearBorder(Index t, const Point2& p, double square)
  {
    constexpr int mostEdges = 10000;
    int edges = 0;
    std::vector<Index>& stack = this->Stack;
    // Edges around the point, outwards, as long as they are closer than the limit.
    stack.assign({ 3 * t, 3 * t + 1, 3 * t + 2 });
    while (!stack.empty())
    {
      const Index h = stack.back();
      stack.pop_back();
      if (!(this->SquareToEdge(h, p) < square))
      {
        continue;
      }
      const Index twin = this->Surface.Twin(h);
      if (twin == Mesh::Border || ++edges > mostEdges)
      {
        return true;
      }
      stack.push_back(Mesh::Next(twin));
      stack.push_back(Mesh::Previous(twin));
    }
    return false;
  }

  double SquareToEdge(Index h, const Point2& p) const
  {
    const Point2& a = this->Surface.PointOf(this->Surface.Origin(h));
    const Point2& b = this->Surface.PointOf(this->Surface.Destination(h));
    const Point2 ab{ (b.X - a.X) * this->Unit, (b.Y - a.Y) * this->Unit };
    const Point2 ap{ (p.X - a.X) * this->Unit, (p.Y - a.Y) * this->Unit };
    const double length = ab.X * ab.X + ab.Y * ab.Y;
    const double along =
      std::max(0.0, std::min(1.0, (ab.X * ap.X + ab.Y * ap.Y) / length)); // NaN becomes 1
    const Point2 away{ ap.X - along * ab.X, ap.Y - along * ab.Y };
    return away.X * away.X + away.Y * away.Y;
  }

  /** Inserts a point in a triangle or on an edge of it, and flips edges until all are Delaunay. */
  bool Insert(Index t, const Point2& p, double spacing)
  {
    Mesh& mesh = this->Surface;
    Index on = None;
    int edges = 0;
    // On one edge, both of its triangles are cut; on two, it would be a vertex.
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      if (Orientation(mesh.PointOf(mesh.Origin(h)), mesh.PointOf(mesh.Destination(h)), p) == Zero)
      {
        on = h;
        ++edges;
      }
    }
    if (edges > 1 || (on != None && mesh.IsBorder(on)))
    {
      return false; // by rounding it is on a vertex or the border
    }
    const Index vertex = mesh.NumberOfPoints();
    mesh.Points.push_back(p);
    if (!this->Spacings.empty())
    {
      this->Spacings.push_back(spacing);
    }
    this->Split(t, on, vertex);
    // Lawson's flips: only edges opposite the new vertex can have become illegal, and each flip
    // puts two more of these on the stack.
    while (!this->Stack.empty())
    {
      const Index h = this->Stack.back();
      this->Stack.pop_back();
      if (!mesh.IsBorder(h) && this->IsToFlip(h))
      {
        this->Flip(h);
      }
    }
    // Around the new vertex, which is the third corner of each of its triangles.
    this->Star.clear();
    const Index first = 3 * t + 1;
    Index h = first;
    do
    {
      this->Star.push_back(Mesh::Triangle(h));
      h = Mesh::Previous(mesh.Twin(h));
    } while (h != first);
    return true;
  }

  /**
   * Replaces a triangle, or the two at an edge, by triangles from the vertex to the polygon around.
   * The vertex is their third corner; their first half-edges are those of the polygon.
   */
  //        P2         Triangle i is P_i P_i+1 v, in slot i. Its first half-edge is a side of the
  //       /  \        polygon; the second one, P_i+1 v, and the third one of the next triangle are
  //      / v  \       twins.
  //    P0------P1
  //
  // The polygon is the triangle, or the quadrilateral of the two at an edge.
  void Split(Index t, Index on, Index vertex)
  {
    Mesh& mesh = this->Surface;
    Index polygon[4];
    Index outer[4];
    Index slots[4];
    int count = 0;
    const auto add = [&](Index h, Index slot) {
      polygon[count] = mesh.Origin(h);
      outer[count] = mesh.Twin(h);
      slots[count++] = slot;
    };
    const Index more = mesh.NumberOfTriangles();
    if (on == None)
    {
      add(3 * t, t);
      add(3 * t + 1, more);
      add(3 * t + 2, more + 1);
    }
    else
    {
      const Index twin = mesh.Twin(on);
      add(Mesh::Next(on), t);
      add(Mesh::Previous(on), more);
      add(Mesh::Next(twin), Mesh::Triangle(twin));
      add(Mesh::Previous(twin), more + 1);
    }
    mesh.Triangles.resize(mesh.Triangles.size() + 6);
    mesh.Twins.resize(mesh.Twins.size() + 6);
    this->Stack.clear();
    for (int i = 0; i < count; ++i)
    {
      const Index slot = 3 * slots[i];
      const int next = i + 1 < count ? i + 1 : 0;
      mesh.Triangles[slot] = polygon[i];
      mesh.Triangles[slot + 1] = polygon[next];
      mesh.Triangles[slot + 2] = vertex;
      this->Surface.Join(slot, outer[i]);
      this->Surface.Join(slot + 1, 3 * slots[next] + 2);
      this->Stack.push_back(slot);
    }
  }

  bool IsToFlip(Index h) const
  {
    const Mesh& mesh = this->Surface;
    return ShouldFlip(mesh.PointOf(mesh.Origin(h)), mesh.PointOf(mesh.Destination(h)),
      mesh.PointOf(mesh.Apex(h)), mesh.PointOf(mesh.Apex(mesh.Twin(h))));
  }

  /**
   * Flips edge h of the polygon: the apex behind it becomes a corner of the polygon.
   *
   *         corner                  corner
   *        /      \                /  |   \       h keeps its origin and leads to the corner; the
   *       / other  \              /   |    \      other triangle goes from there to the old
   *   from ---h---> to    ->   from h | other to  destination. Both have the vertex as their third
   *       \        /              \   |    /      corner, as all triangles around it do.
   *        \      /                \  |   /
   *         vertex                  vertex
   */
  void Flip(Index h)
  {
    Mesh& mesh = this->Surface;
    const Index twin = mesh.Twin(h);
    const Index corner = mesh.Apex(twin);
    const Index to = mesh.Destination(h);
    const Index vertex = mesh.Apex(h);
    const Index before = mesh.Twin(Mesh::Next(twin));
    const Index after = mesh.Twin(Mesh::Previous(twin));
    const Index next = mesh.Twin(h + 1);
    const Index other = 3 * Mesh::Triangle(twin);
    mesh.Triangles[h + 1] = corner;
    mesh.Triangles[other] = corner;
    mesh.Triangles[other + 1] = to;
    mesh.Triangles[other + 2] = vertex;
    mesh.Join(h, before);
    mesh.Join(other, after);
    mesh.Join(other + 1, next);
    mesh.Join(h + 1, other + 2);
    this->Stack.push_back(h);
    this->Stack.push_back(other);
  }

  const PatchPlan& Plan;
  Mesh& Surface;
  const Index BoundaryVertices;
  const double Unit;
  std::vector<double> Spacings; ///< at the vertices, in units; empty: 1
  double Largest = 0.0;         ///< of these spacings
  std::vector<Index> Stack;
  std::vector<Index> Star; ///< triangles around the last point that was inserted
};
} // namespace

void Refine(const PatchPlan& plan, const Patch& patch, const Progress& progress, Mesh& mesh)
{
  Refinement(plan, patch, mesh).Run(progress);
}

} // namespace elevation
