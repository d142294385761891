// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Validate.h"

#include "Holes.h"
#include "Kernel/Base/Base.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace elevation
{
namespace
{

/**
 * Written apart from the code that it checks, as far as possible: predicates, twins and the sweep
 * of Holes.cxx are shared, everything else is stated anew from the rules.
 */
class Checker
{
public:
  Checker(const Mesh& mesh, const ValidateOptions& options)
    : Checked(mesh)
    , Options(options)
  {
  }

  std::vector<Finding> Check()
  {
    this->CheckTriangles();
    if (this->Findings.empty())
    {
      this->CheckManifold();
    }
    // What follows presumes a consistent mesh of counter-clockwise triangles.
    if (!this->Findings.empty())
    {
      return this->Findings;
    }
    if (this->Options.Delaunay)
    {
      this->CheckEmptyCircles();
    }
    if (this->Options.ConvexHull)
    {
      this->CheckHull();
    }
    if (this->Options.AllPoints)
    {
      this->CheckVertices();
    }
    if (this->Options.Overlap)
    {
      this->CheckOverlap();
    }
    return this->Findings;
  }

private:
  /** Adds a finding, unless there are enough: a broken mesh may have one at every edge. */
  void Add(Rule rule, Index where, const std::string& message)
  {
    if (this->Findings.size() < this->Options.MaximumFindings)
    {
      this->Findings.push_back({ rule, where, message });
    }
  }

  /** Ids, then Orientation: no later check may read beyond the points. */
  void CheckTriangles()
  {
    const auto& ids = this->Checked.Triangles;
    if (ids.size() % 3 != 0)
    {
      this->Add(Rule::Ids, None, "the number of triangle corners is not a multiple of three");
      return;
    }
    for (Index t = 0; t < this->Checked.NumberOfTriangles(); ++t)
    {
      const Index a = ids[3 * t], b = ids[3 * t + 1], c = ids[3 * t + 2];
      const Index count = this->Checked.NumberOfPoints();
      if (std::min({ a, b, c }) < 0 || std::max({ a, b, c }) >= count || a == b || b == c || c == a)
      {
        this->Add(Rule::Ids, t,
          "triangle " + std::to_string(t) + " has the corners " + std::to_string(a) + ", " +
            std::to_string(b) + ", " + std::to_string(c) + " of " + std::to_string(count) +
            " points");
        continue;
      }
      const Sign side =
        Orientation(this->Checked.PointOf(a), this->Checked.PointOf(b), this->Checked.PointOf(c));
      if (side != Positive)
      {
        this->Add(Rule::Orientation, t,
          "triangle " + std::to_string(t) + (side == Zero ? " is flat" : " is clockwise"));
      }
    }
  }

  /** By connecting the copy, which throws at an edge that is not manifold. */
  void CheckManifold()
  {
    this->Checked.Twins.clear();
    try
    {
      this->Checked.ConnectTwins();
    }
    catch (const Error& error)
    {
      this->Add(Rule::Manifold, None, error.what());
    }
  }

  std::string EdgeOf(Index h) const
  {
    return "edge " + std::to_string(this->Checked.Origin(h)) + "-" +
      std::to_string(this->Checked.Destination(h));
  }

  void CheckEmptyCircles()
  {
    for (Index h = 0; h < this->Checked.NumberOfHalfEdges(); ++h)
    {
      const Index twin = this->Checked.Twin(h);
      if (twin < h || (this->Options.Constrained && (*this->Options.Constrained)[h]))
      {
        // Constrained edges are exempt from both rules.
        continue; // a border, or seen from the other side
      }
      const Point2& a = this->Checked.PointOf(this->Checked.Origin(h));
      const Point2& b = this->Checked.PointOf(this->Checked.Destination(h));
      const Point2& c = this->Checked.PointOf(this->Checked.Apex(h));
      const Point2& d = this->Checked.PointOf(this->Checked.Apex(twin));
      const Sign side = InCircle(a, b, c, d);
      if (side == Positive)
      {
        this->Add(Rule::EmptyCircle, h,
          "beyond " + this->EdgeOf(h) + " point " + std::to_string(this->Checked.Apex(twin)) +
            " lies inside the circle of triangle " + std::to_string(Mesh::Triangle(h)));
      }
      else if (side == Zero)
      {
        // An edge of the fan of the lowest of the four points has this point as an end.
        const Point2& lowEnd = IsLower(a, b) ? a : b;
        const Point2& lowApex = IsLower(c, d) ? c : d;
        if (!IsLower(lowEnd, lowApex))
        {
          this->Add(Rule::TieRule, h,
            this->EdgeOf(h) + " cuts a co-circular polygon, but not from its lowest vertex");
        }
      }
    }
  }

  /** One loop that never turns inwards, and goes around once. */
  void CheckHull()
  {
    if (this->Checked.NumberOfTriangles() == 0)
    {
      return;
    }
    const Rings border = TraceBorder(this->Checked);
    if (border.Count() != 1)
    {
      this->Add(Rule::Hull, None,
        "the border consists of " + std::to_string(border.Count()) +
          " loops, not of the hull alone");
      return;
    }
    const Index size = border.Size(0);
    const auto vertex = [&](Index i) { return this->Checked.Origin(border.Begin(0)[i % size]); };
    Index lowestVertices = 0;
    for (Index i = 0; i < size; ++i)
    {
      const Point2& before = this->Checked.PointOf(vertex(i));
      const Point2& here = this->Checked.PointOf(vertex(i + 1));
      const Point2& after = this->Checked.PointOf(vertex(i + 2));
      // Straight is right: points on the hull's edges are vertices.
      if (Orientation(before, here, after) == Negative)
      {
        this->Add(Rule::Hull, vertex(i + 1),
          "the border turns inwards at point " + std::to_string(vertex(i + 1)));
      }
      // Left turns alone would allow a loop that winds around twice; such a loop has two lowest
      // points.
      lowestVertices += IsLower(here, before) && IsLower(here, after);
    }
    if (lowestVertices != 1)
    {
      this->Add(Rule::Hull, None, "the border winds around more than once");
    }
  }

  void CheckVertices()
  {
    std::vector<bool> isUsed(this->Checked.Points.size(), false);
    for (Index vertex : this->Checked.Triangles)
    {
      isUsed[vertex] = true;
    }
    const auto* unused = this->Options.UnusedPoints;
    for (Index point = 0; point < this->Checked.NumberOfPoints(); ++point)
    {
      const bool isListed = unused && std::binary_search(unused->begin(), unused->end(), point);
      if (isUsed[point] == isListed)
      {
        this->Add(Rule::Vertices, point,
          "point " + std::to_string(point) +
            (isListed ? " is listed as unused but is a vertex" : " is not a vertex"));
      }
    }
  }

  void CheckOverlap()
  {
    try
    {
      FindHoles(this->Checked);
    }
    catch (const Error& error)
    {
      this->Add(Rule::Overlap, None, error.what());
    }
  }

  Mesh Checked; // a copy, whose Twins are made here
  const ValidateOptions& Options;
  std::vector<Finding> Findings;
};
} // namespace

std::vector<Finding> Validate(const Mesh& mesh, const ValidateOptions& options)
{
  return Checker(mesh, options).Check();
}

namespace
{
// 16 roundoffs cover the operations below.
constexpr long double LongUnit = 16.0L * std::numeric_limits<long double>::epsilon();
// Some needles need more digits than long double has. This takes twenty times as long.
#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Widest;
constexpr Widest WidestUnit = 0x1p-108;
#else
using Widest = long double;
constexpr Widest WidestUnit = LongUnit;
#endif

/** IsWithin() for a point on an edge: its triangles may be too thin for a plane. */
bool IsNearEdge(double most, const PointView& points, Index from, Index to, Index point)
{
  const Point2 a = points.At(from), b = points.At(to), p = points.At(point);
  const long double x = static_cast<long double>(b.X) - a.X,
                    y = static_cast<long double>(b.Y) - a.Y;
  const bool isAlongX = std::fabs(x) > std::fabs(y);
  const long double share = isAlongX ? (static_cast<long double>(p.X) - a.X) / x
                                     : (static_cast<long double>(p.Y) - a.Y) / y;
  const long double down =
    points.Elevation(from) - static_cast<long double>(points.Elevation(point));
  const long double along =
    share * (static_cast<long double>(points.Elevation(to)) - points.Elevation(from));
  return std::fabs(down + along) + LongUnit * (std::fabs(down) + std::fabs(along)) <= most;
}

/**
 * Whether the vertical distance of a point from the plane of a triangle is certainly not above a
 * limit, in a type wider than double: else the largest and smallest coordinates leave its range.
 */
template <typename Real>
bool IsWithin(double most, Real unit, const PointView& points, const Index* corners, Index point)
{
  const auto at = [&points](Index id) {
    const Point2 p = points.At(id);
    return std::array<Real, 3>{ p.X, p.Y, points.Elevation(id) };
  };
  const auto size = [](Real value) { return value < 0.0 ? -value : value; };
  const auto p = at(point);
  std::array<Real, 3> area, areaSize, z;
  for (int k = 0; k < 3; ++k)
  {
    const auto a = at(corners[k]);
    if (a[0] == p[0] && a[1] == p[1])
    {
      return size(a[2] - p[2]) * (1.0 + unit) <= most; // however thin the triangle is
    }
    const auto b = at(corners[(k + 1) % 3]), c = at(corners[(k + 2) % 3]);
    const Real left = (b[0] - p[0]) * (c[1] - p[1]), right = (b[1] - p[1]) * (c[0] - p[0]);
    area[k] = left - right;
    areaSize[k] = size(left) + size(right);
    z[k] = a[2];
  }
  // The distance is the sum of area k times (z of k less z of p), through the sum of areas.
  Real sum = 0.0, sumSize = 0.0, whole = 0.0, wholeSize = 0.0;
  for (int k = 0; k < 3; ++k)
  {
    sum += area[k] * (z[k] - p[2]);
    sumSize += areaSize[k] * size(z[k] - p[2]);
    whole += area[k];
    wholeSize += areaSize[k];
  }
  // At least so large is the area, so the quotient is an upper bound; no bound for a triangle
  // without area.
  const Real least = whole - unit * wholeSize;
  return least > 0.0 && (size(sum) + unit * sumSize) / least <= most;
}
} // namespace

std::vector<Finding> ValidateDistance(const Mesh& mesh, const PointView& points, double most,
  double besideBy, const std::vector<Index>& exempt, std::size_t maximumFindings)
{
  std::vector<Finding> findings;
  const auto cornersOf = [&mesh](Index t) {
    return mesh.Triangles.data() + 3 * static_cast<std::size_t>(t);
  };
  const CellGrid grid(static_cast<std::size_t>(mesh.NumberOfTriangles()), [&](std::size_t t) {
    const Index* const c = cornersOf(static_cast<Index>(t));
    return std::array<Point2, 3>{ mesh.PointOf(c[0]), mesh.PointOf(c[1]), mesh.PointOf(c[2]) };
  });
  /**
   * Whether a point is on the left of an edge, or at most so far to its right. Exact for the
   * triangles that cover a point; a distance only beside the mesh.
   */
  const auto isLeftOf = [&mesh](Index from, Index to, const Point2& p, double by) {
    const Point2 a = mesh.PointOf(from), b = mesh.PointOf(to);
    const long double x = b.X - a.X, y = b.Y - a.Y;
    return by > 0.0 ? x * (p.Y - a.Y) - y * (p.X - a.X) >= -by * std::hypot(x, y)
                    : Orientation(a, b, p) != Negative;
  };
  for (Index point = 0; point < points.Count && findings.size() < maximumFindings; ++point)
  {
    const Point2 p = points.At(point);
    if (!points.IsFinite(point) || std::binary_search(exempt.begin(), exempt.end(), point))
    {
      continue;
    }
    // Whether any triangle covers the point, and whether it is near one of those that do.
    bool isCovered = false, isNear = false;
    const auto look = [&](Index t, double by) {
      const Index* const c = cornersOf(t);
      if (isLeftOf(c[0], c[1], p, by) && isLeftOf(c[1], c[2], p, by) && isLeftOf(c[2], c[0], p, by))
      {
        isCovered = true;
        // Of the triangles that cover the point, also of two at an edge, one that is near is
        // enough.
        isNear = isNear || IsWithin(most, LongUnit, points, c, point) ||
          IsWithin(most, WidestUnit, points, c, point);
        for (int k = 0; k < 3 && !isNear; ++k)
        {
          const Index from = c[k], to = c[(k + 1) % 3];
          isNear = Orientation(mesh.PointOf(from), mesh.PointOf(to), p) == Zero &&
            IsNearEdge(most, points, from, to, point);
        }
      }
    };
    grid.Visit(p, [&](Index t) { look(t, 0.0); });
    const bool isBeside = !isCovered && besideBy > 0.0;
    // Few points are beside the mesh, so all triangles are looked at.
    for (Index t = 0; isBeside && t < mesh.NumberOfTriangles(); ++t)
    {
      look(t, besideBy);
    }
    if (!isNear)
    {
      findings.push_back({ Rule::Distance, point,
        NameOf(point, p) + (isCovered ? " is too far from the mesh." : " is beside the mesh.") });
    }
  }
  return findings;
}

std::string ToString(const std::vector<Finding>& findings)
{
  std::string text;
  for (const Finding& finding : findings)
  {
    text += finding.Message + "\n";
  }
  return text;
}

} // namespace elevation
