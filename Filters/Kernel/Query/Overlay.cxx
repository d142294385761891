// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Overlay.h"

#include "TileOrder.h"
#include "TriangleTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace elevation
{

namespace
{

// Triangles that a thread works on at a time: some milliseconds.
constexpr Index AtOnce = 1024;

/** A corner of a polygon, seen from the first corner of its triangle. */
struct Corner
{
  Point2 At;
  double Difference; ///< of elevations
  double Value;
};

/**
 * Corners, counter-clockwise: a triangle that has been cut by up to four lines. Rounding may bend a
 * flat one, so that a line cuts off several corners that are not neighbours: of n corners half at
 * most, each of which gives way to two. From 3, four cuts make at most 4, 6, 9, 13.
 */
struct Polygon
{
  Polygon() = default;
  // Many are copied, so only the corners that there are.
  Polygon(const Polygon& other)
    : Count(other.Count)
  {
    std::copy_n(other.Corners.begin(), other.Count, this->Corners.begin());
  }
  Polygon& operator=(const Polygon&) = delete;

  std::array<Corner, 13> Corners;
  int Count = 0;

  void Add(const Corner& corner) { this->Corners[this->Count++] = corner; }
};

double TwiceArea(const Point2& a, const Point2& b, const Point2& c)
{
  return DifferenceOfProducts(b.X - a.X, c.Y - a.Y, b.Y - a.Y, c.X - a.X);
}

/** Cuts off a polygon where a function that is linear in the plane is below 0. */
template <typename Function>
void Cut(Polygon& polygon, const Function& function)
{
  std::array<double, 13> values;
  int below = 0;
  for (int i = 0; i < polygon.Count; ++i)
  {
    values[i] = function(polygon.Corners[i]);
    below += values[i] < 0.0;
  }
  // Of triangles that are near each other, most are cut by no edge, or away by the first.
  if (below == 0 || below == polygon.Count)
  {
    polygon.Count = below == 0 ? polygon.Count : 0;
    return;
  }
  const Polygon whole = polygon;
  polygon.Count = 0;
  for (int i = 0; i < whole.Count; ++i)
  {
    const int next = i + 1 == whole.Count ? 0 : i + 1;
    const Corner& a = whole.Corners[i];
    const Corner& b = whole.Corners[next];
    if (values[i] >= 0.0)
    {
      polygon.Add(a);
    }
    if ((values[i] < 0.0) != (values[next] < 0.0))
    {
      const double share = values[i] / (values[i] - values[next]);
      polygon.Add({ { a.At.X + share * (b.At.X - a.At.X), a.At.Y + share * (b.At.Y - a.At.Y) },
        a.Difference + share * (b.Difference - a.Difference),
        a.Value + share * (b.Value - a.Value) });
    }
  }
}

/** The integral of a linear function over a polygon. */
template <typename Function>
double Integral(const Polygon& polygon, const Function& function)
{
  double sum = 0.0;
  const Corner& first = polygon.Corners[0];
  for (int i = 2; i < polygon.Count; ++i)
  {
    const Corner& a = polygon.Corners[i - 1];
    const Corner& b = polygon.Corners[i];
    // Rounding may leave a triangle without area a little of the wrong sign.
    const double area = std::max(0.0, TwiceArea(first.At, a.At, b.At));
    sum += area * (function(first) + function(a) + function(b)) / 6.0;
  }
  return sum;
}

/** The same where the function is above 0. */
template <typename Function>
double IntegralAbove0(Polygon polygon, const Function& function)
{
  Cut(polygon, function);
  return Integral(polygon, function);
}

/** The corners of a triangle, seen from an origin. */
std::array<Point2, 3> CornersFrom(const Mesh& mesh, Index triangle, const Point2& origin)
{
  std::array<Point2, 3> corners = TriangleCorners(mesh, triangle);
  for (Point2& p : corners)
  {
    p = { p.X - origin.X, p.Y - origin.Y };
  }
  return corners;
}

/** Overlays triangles of the first surface with those of the second. */
class Overlaying
{
public:
  Overlaying(const ElevatedMesh& first, const ElevatedMesh* second, double level,
    const std::vector<double>& values, const TriangleTree* tree)
    : First(first)
    , Second(second)
    , Level(level)
    , Values(values)
    , Tree(tree)
  {
  }

  OverlaidTriangle Overlay(Index triangle, DifferenceMap* map)
  {
    const Mesh& mesh = this->First.Surface;
    const Index* const ids = mesh.Triangles.data() + 3 * static_cast<std::size_t>(triangle);
    this->Origin = mesh.PointOf(ids[0]);
    this->Map = map;
    const std::array<Point2, 3> corners = CornersFrom(mesh, triangle, this->Origin);
    // Elevations are measured from the first corner, as coordinates are.
    this->Base = this->Second ? this->First.Elevations[ids[0]] : this->Level;
    Polygon whole;
    for (int k = 0; k < 3; ++k)
    {
      whole.Add({ corners[k], this->First.Elevations[ids[k]] - this->Base,
        this->Values.empty() ? 0.0 : this->Values[ids[k]] });
    }
    this->Bounds = BoxOf(corners);
    this->Result = OverlaidTriangle();
    this->Result.Area = 0.5 * TwiceArea(corners[0], corners[1], corners[2]);
    if (!this->Second)
    {
      this->Add(whole);
      return this->Result;
    }
    this->Near.clear();
    this->Tree->Visit(
      BoxOf(TriangleCorners(mesh, triangle)), [this](Index other) { this->Near.push_back(other); });
    // The order of sums must not depend on the tree.
    std::sort(this->Near.begin(), this->Near.end());
    for (const Index other : this->Near)
    {
      this->OverlayWith(whole, other);
    }
    return this->Result;
  }

private:
  void OverlayWith(const Polygon& whole, Index other)
  {
    const Mesh& mesh = this->Second->Surface;
    const std::array<Point2, 3> corners = CornersFrom(mesh, other, this->Origin);
    if (!BoxOf(corners).Intersects(this->Bounds))
    {
      return;
    }
    Polygon part = whole;
    for (int k = 0; k < 3 && part.Count > 2; ++k)
    {
      Cut(part, [&](const Corner& corner) {
        return TwiceArea(corners[k], corners[(k + 1) % 3], corner.At);
      });
    }
    if (part.Count < 3)
    {
      return;
    }
    const double whole2 = TwiceArea(corners[0], corners[1], corners[2]);
    if (!(whole2 > 0.0))
    {
      return; // its area is below the smallest number
    }
    const Index* const ids = mesh.Triangles.data() + 3 * static_cast<std::size_t>(other);
    for (int i = 0; i < part.Count; ++i)
    {
      Corner& corner = part.Corners[i];
      // The second surface there, by areas: a mean of its corners, so flat triangles lose nothing.
      double shares[3], elevation = 0.0;
      for (int k = 1; k < 3; ++k)
      {
        const double area = TwiceArea(corners[(k + 1) % 3], corners[(k + 2) % 3], corner.At);
        shares[k] = std::min(std::max(area / whole2, 0.0), 1.0);
      }
      shares[0] = 1.0 - shares[1] - shares[2];
      for (int k = 0; k < 3; ++k)
      {
        elevation += shares[k] * (this->Second->Elevations[ids[k]] - this->Base);
      }
      corner.Difference -= elevation;
    }
    this->Add(part);
  }

  /** A polygon on which the difference is linear. */
  void Add(const Polygon& polygon)
  {
    const auto difference = [](const Corner& corner) { return corner.Difference; };
    const auto minus = [](const Corner& corner) { return -corner.Difference; };
    this->Result.Common += Integral(polygon, [](const Corner&) { return 1.0; });
    this->Result.Above += IntegralAbove0(polygon, difference);
    this->Result.Below += IntegralAbove0(polygon, minus);
    this->Result.Weighted += Integral(polygon, [](const Corner& corner) { return corner.Value; });
    if (this->Map)
    {
      this->Draw(polygon);
    }
  }

  void Draw(const Polygon& polygon)
  {
    const Index first = static_cast<Index>(this->Map->Points.size() / 3);
    for (int i = 0; i < polygon.Count; ++i)
    {
      const Corner& corner = polygon.Corners[i];
      this->Map->Points.insert(this->Map->Points.end(),
        { this->Origin.X + corner.At.X, this->Origin.Y + corner.At.Y, corner.Difference });
    }
    for (Index i = 2; i < polygon.Count; ++i)
    {
      this->Map->Triangles.insert(this->Map->Triangles.end(), { first, first + i - 1, first + i });
    }
  }

  const ElevatedMesh& First;
  const ElevatedMesh* Second;
  const double Level;
  const std::vector<double>& Values;
  const TriangleTree* Tree;
  // Of the triangle that is overlaid: its first corner, its extent from there, what elevations are
  // measured from.
  Point2 Origin{ 0.0, 0.0 };
  Box Bounds;
  double Base = 0.0;
  OverlaidTriangle Result;
  DifferenceMap* Map = nullptr;
  std::vector<Index> Near;
};

/** Puts the maps of all tasks together. */
void JoinMaps(std::vector<DifferenceMap>& maps, const Progress& progress, DifferenceMap& all)
{
  std::size_t points = 0;
  for (const DifferenceMap& map : maps)
  {
    points += map.Points.size() / 3;
  }
  if (points > static_cast<std::size_t>(std::numeric_limits<Index>::max() / 3))
  {
    throw Error("The map of differences would have " + std::to_string(points) +
      " points, which are too many for one mesh.");
  }
  std::size_t done = 0;
  for (DifferenceMap& map : maps)
  {
    ReportStep(progress, done++, maps.size());
    const Index first = static_cast<Index>(all.Points.size() / 3);
    all.Points.insert(all.Points.end(), map.Points.begin(), map.Points.end());
    for (const Index corner : map.Triangles)
    {
      all.Triangles.push_back(first + corner);
    }
    map = DifferenceMap();
  }
}

} // namespace

std::vector<OverlaidTriangle> Overlay(const ElevatedMesh& first, const ElevatedMesh* second,
  double level, const std::vector<double>& values, int threads, const Progress& progress,
  DifferenceMap* map)
{
  Stages stages(progress, { second ? 25.0 : 0.0, 70, map ? 10.0 : 0.0 });
  const Progress indexing = stages.Next();
  std::unique_ptr<TriangleTree> tree;
  if (second)
  {
    tree = std::make_unique<TriangleTree>(second->Surface, threads, indexing);
  }
  const Index count = first.Surface.NumberOfTriangles();
  const Index tasks = (count + AtOnce - 1) / AtOnce;
  std::vector<Point2> corners(count);
  for (Index t = 0; t < count; ++t)
  {
    corners[t] = TriangleCorners(first.Surface, t)[0];
  }
  const std::vector<std::size_t> order = OrderByTiles(corners);
  std::vector<OverlaidTriangle> result(count);
  std::vector<DifferenceMap> maps(map ? tasks : 0);
  ForEachTask(tasks, threads, stages.Next(), [&](Index task) {
    Overlaying overlaying(first, second, level, values, tree.get());
    for (Index i = task * AtOnce; i < std::min(count, (task + 1) * AtOnce); ++i)
    {
      const Index t = static_cast<Index>(order[i]);
      result[t] = overlaying.Overlay(t, map ? &maps[task] : nullptr);
    }
  });
  if (map)
  {
    JoinMaps(maps, stages.Next(), *map);
  }
  return result;
}

} // namespace elevation
