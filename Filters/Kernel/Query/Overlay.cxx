// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Overlay.h"

#include "TileOrder.h"
#include "TriangleTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

// Where a processor may have the instruction for std::fma(), and the compiler must not count on it.
#if defined(__GNUC__) && defined(__x86_64__) && !defined(__FMA__)
#define ELEVATION_CHOOSES_FMA
#define ELEVATION_APART [[gnu::noinline]]
#else
#define ELEVATION_APART
#endif

namespace elevation
{

namespace
{

// Triangles that a thread works on at a time: some milliseconds.
constexpr Index AtOnce = 1024;
// That are near each other, and look for those of the other surface together.
constexpr Index Together = 4;
// Triangles of the other surface that are looked at at a time.
constexpr std::size_t BlockSize = 256;

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
constexpr int MostCorners = 13;
struct Polygon
{
  std::array<Corner, MostCorners> Corners;
  int Count = 0;

  void Add(const Corner& corner) { this->Corners[this->Count++] = corner; }
  int Next(int corner) const { return corner + 1 == this->Count ? 0 : corner + 1; }
  /** Corners as the bits of a number: all. */
  unsigned All() const { return (1u << this->Count) - 1u; }
};

double TwiceArea(const Point2& a, const Point2& b, const Point2& c)
{
  return DifferenceOfProducts(b.X - a.X, c.Y - a.Y, b.Y - a.Y, c.X - a.X);
}

/** TwiceArea() in plain arithmetic, and its error at most: mostly the sign is all that counts. */
struct QuickArea
{
  QuickArea(const Point2& a, const Point2& b, const Point2& c)
  {
    const double left = (b.X - a.X) * (c.Y - a.Y), right = (b.Y - a.Y) * (c.X - a.X);
    this->Twice = left - right;
    // Two products and their difference are off by at most (2 + u) u of the sum, with u = 2^-53,
    // from the area of the rounded differences, whose sign TwiceArea() has; what underflows is far
    // below the second term.
    this->Error = 4.0 * 1.1102230246251565e-16 * (std::fabs(left) + std::fabs(right)) + 1e-290;
  }
  bool IsRight() const { return this->Twice < -this->Error; }
  bool IsUnsure() const { return std::fabs(this->Twice) <= this->Error; }

  double Twice, Error;
};

/** The corners of a polygon to the right of a line, and on it, as bits. */
struct Sides
{
  unsigned Right = 0;
  unsigned On = 0;
};

/** By the sign of TwiceArea(a, b, corner); where that is no number, corners are to the left. */
Sides SidesOf(const Polygon& polygon, const Point2& a, const Point2& b)
{
  Sides sides;
  unsigned unsure = 0;
  for (int i = 0; i < polygon.Count; ++i)
  {
    const QuickArea area(a, b, polygon.Corners[i].At);
    sides.Right |= static_cast<unsigned>(area.IsRight()) << i;
    unsure |= static_cast<unsigned>(area.IsUnsure()) << i;
  }
  for (int i = 0; unsure >> i != 0; ++i)
  {
    if ((unsure >> i & 1u) != 0)
    {
      const double area = TwiceArea(a, b, polygon.Corners[i].At);
      sides.Right |= static_cast<unsigned>(area < 0.0) << i;
      sides.On |= static_cast<unsigned>(area == 0.0) << i;
    }
  }
  return sides;
}

/** Whether c is to the left of the line from a to b, or so far away that this is not a number. */
bool IsLeft(const Point2& a, const Point2& b, const Point2& c)
{
  const QuickArea area(a, b, c);
  return !((area.IsUnsure() ? TwiceArea(a, b, c) : area.Twice) <= 0.0);
}

/**
 * Cuts off a polygon where a function that is linear in the plane is below 0.
 * @param[in] below    the corners where it is, as bits: some, but not all
 * @param[in] valueAt  valueAt(corner), asked for at ends of edges that are cut alone
 * @param[out] rest    another polygon
 */
template <typename Function>
void Cut(const Polygon& polygon, unsigned below, const Function& valueAt, Polygon& rest)
{
  const auto addBetween = [&](const Corner& a, const Corner& b) {
    const double value = valueAt(a);
    const double share = value / (value - valueAt(b));
    rest.Add({ { a.At.X + share * (b.At.X - a.At.X), a.At.Y + share * (b.At.Y - a.At.Y) },
      a.Difference + share * (b.Difference - a.Difference),
      a.Value + share * (b.Value - a.Value) });
  };
  rest.Count = 0;
  // The stretches that stay: mostly one.
  const unsigned stay = polygon.All() & ~below;
  const unsigned begins = stay & (below << 1 | below >> (polygon.Count - 1));
  for (int begin = 0; begins >> begin != 0; ++begin)
  {
    if ((begins >> begin & 1u) == 0)
    {
      continue;
    }
    addBetween(polygon.Corners[begin == 0 ? polygon.Count - 1 : begin - 1], polygon.Corners[begin]);
    int last = begin, next = begin;
    do
    {
      rest.Add(polygon.Corners[next]);
      last = next;
      next = polygon.Next(next);
    } while ((stay >> next & 1u) != 0);
    addBetween(polygon.Corners[last], polygon.Corners[next]);
  }
}

/** Of the linear functions on a polygon. */
struct Integrals
{
  double Area, Difference, Value;
};

Integrals Integrate(const Polygon& polygon)
{
  Integrals sum{ 0.0, 0.0, 0.0 };
  const Corner& first = polygon.Corners[0];
  for (int i = 2; i < polygon.Count; ++i)
  {
    const Corner& a = polygon.Corners[i - 1];
    const Corner& b = polygon.Corners[i];
    // Rounding may leave a triangle without area a little of the wrong sign.
    const double area = std::max(0.0, TwiceArea(first.At, a.At, b.At));
    sum.Area += area;
    sum.Difference += area * (first.Difference + a.Difference + b.Difference);
    sum.Value += area * (first.Value + a.Value + b.Value);
  }
  return { sum.Area / 2.0, sum.Difference / 6.0, sum.Value / 6.0 };
}

/** The integral of the difference where that, times a sign, is not below 0. */
double IntegralOf(const Polygon& polygon, double sign)
{
  unsigned below = 0;
  for (int i = 0; i < polygon.Count; ++i)
  {
    below |= static_cast<unsigned>(sign * polygon.Corners[i].Difference < 0.0) << i;
  }
  Polygon rest;
  Cut(
    polygon, below, [](const Corner& corner) { return corner.Difference; }, rest);
  return Integrate(rest).Difference;
}

/** A sum, and what its roundings have lost: parts may be a million times smaller than it. */
class LongSum
{
public:
  void Add(double value)
  {
    const double sum = this->Sum + value, added = sum - this->Sum;
    this->Lost += (this->Sum - (sum - added)) + (value - added);
    this->Sum = sum;
  }
  double Total() const { return std::isfinite(this->Lost) ? this->Sum + this->Lost : this->Sum; }

private:
  double Sum = 0.0, Lost = 0.0;
};

/** A triangle of the first surface while it is overlaid. */
struct Overlaid
{
  Box Bounds;
  Point2 Origin{ 0.0, 0.0 }; ///< its first corner, from which all places are measured
  double Base = 0.0;         ///< what elevations are measured from
  Polygon Whole;
  double Area = 0.0;
  LongSum Common, Above, Below, Weighted;

  OverlaidTriangle Result() const
  {
    return { this->Area, this->Common.Total(), this->Above.Total(), this->Below.Total(),
      this->Weighted.Total() };
  }
  std::array<Point2, 3> FromOrigin(std::array<Point2, 3> places) const
  {
    for (Point2& p : places)
    {
      p = { p.X - this->Origin.X, p.Y - this->Origin.Y };
    }
    return places;
  }
};

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

  /** Triangles of the first surface by their numbers, mostly in groups that are near each other. */
  void OverlayAll(const std::size_t* begin, const std::size_t* end, DifferenceMap* map,
    std::vector<OverlaidTriangle>& results)
  {
    this->Map = map;
    while (begin != end)
    {
      Box box;
      const std::size_t* const last = this->GroupFrom(begin, end, box);
      for (const std::size_t* each = begin; each != last; ++each)
      {
        this->Group[each - begin] = this->Begun(static_cast<Index>(*each));
      }
      if (this->Second)
      {
        this->OverlayGroup(box, static_cast<int>(last - begin));
      }
      for (const std::size_t* each = begin; each != last; ++each)
      {
        Overlaid& own = this->Group[each - begin];
        if (!this->Second)
        {
          this->Add(own, own.Whole);
        }
        results[*each] = own.Result();
      }
      begin = last;
    }
  }

private:
  /** A triangle of the second surface. */
  struct Neighbor
  {
    std::array<Point2, 3> At;
    std::array<double, 3> Elevations;
  };

  /** The end of a group, whose triangles fill their common box. */
  const std::size_t* GroupFrom(const std::size_t* begin, const std::size_t* end, Box& box) const
  {
    double sizes = 0.0;
    const std::size_t* each = begin;
    for (; each != end && each - begin < Together; ++each)
    {
      const Box own = BoxOf(TriangleCorners(this->First.Surface, static_cast<Index>(*each)));
      Box joint = box;
      joint.Join(own);
      sizes += own.Width() + own.Height();
      if (each != begin && !(joint.Width() + joint.Height() <= 2.0 * sizes))
      {
        break;
      }
      box = joint;
    }
    return each;
  }

  Overlaid Begun(Index triangle) const
  {
    const Mesh& mesh = this->First.Surface;
    const Index* const ids = mesh.Triangles.data() + 3 * static_cast<std::size_t>(triangle);
    const std::array<Point2, 3> places = TriangleCorners(mesh, triangle);
    Overlaid own;
    own.Bounds = BoxOf(places);
    own.Origin = places[0];
    own.Base = this->Second ? this->First.Elevations[ids[0]] : this->Level;
    const std::array<Point2, 3> corners = own.FromOrigin(places);
    for (int k = 0; k < 3; ++k)
    {
      own.Whole.Add({ corners[k], this->First.Elevations[ids[k]] - own.Base,
        this->Values.empty() ? 0.0 : this->Values[ids[k]] });
    }
    own.Area = 0.5 * TwiceArea(corners[0], corners[1], corners[2]);
    return own;
  }

  /** Overlays the first so many triangles of the group, which lie in a box, with all near them. */
  void OverlayGroup(const Box& box, int count)
  {
    this->Near.clear();
    this->Tree->Visit(box, [this](Index other) { this->Near.push_back(other); });
    // The order of sums must not depend on the tree.
    std::sort(this->Near.begin(), this->Near.end());
    CountWork(this->Near.size());
    const Mesh& mesh = this->Second->Surface;
    const std::vector<double>& z = this->Second->Elevations;
    for (std::size_t begin = 0; begin < this->Near.size(); begin += BlockSize)
    {
      // All corners are read before any is compared, so that no read waits for another.
      const std::size_t size = std::min(this->Near.size() - begin, BlockSize);
      for (std::size_t i = 0; i < size; ++i)
      {
        const Index other = this->Near[begin + i];
        const Index* const ids = mesh.Triangles.data() + 3 * static_cast<std::size_t>(other);
        this->Block[i] = { TriangleCorners(mesh, other), { { z[ids[0]], z[ids[1]], z[ids[2]] } } };
      }
      for (std::size_t i = 0; i < size; ++i)
      {
        this->Boxes[i] = BoxOf(this->Block[i].At);
      }
      for (int i = 0; i < count; ++i)
      {
        this->OverlayWithBlock(this->Group[i], size);
      }
    }
  }

  void OverlayWithBlock(Overlaid& own, std::size_t size)
  {
    // Without branches, as few are hit.
    const Box box = own.Bounds;
    std::size_t hits = 0;
    for (std::size_t i = 0; i < size; ++i)
    {
      const Box& other = this->Boxes[i];
      this->Hits[hits] = i;
      hits += static_cast<std::size_t>((other.High.X >= box.Low.X) & (other.Low.X <= box.High.X) &
        (other.High.Y >= box.Low.Y) & (other.Low.Y <= box.High.Y));
    }
#ifdef ELEVATION_CHOOSES_FMA
    static const bool hasFMA = __builtin_cpu_supports("fma") != 0;
    if (hasFMA)
    {
      this->OverlayByFMA(own, hits);
      return;
    }
#endif
    this->OverlayWithHits(own, hits);
  }

#ifdef ELEVATION_CHOOSES_FMA
  /** The same as OverlayWithHits(), faster: std::fma() is an instruction, not a call. */
  [[gnu::target("fma"), gnu::flatten]] void OverlayByFMA(Overlaid& own, std::size_t hits)
  {
    this->OverlayWithHits(own, hits);
  }
#endif

  void OverlayWithHits(Overlaid& own, std::size_t hits)
  {
    const std::array<Point2, 3> corners{ { own.Whole.Corners[0].At, own.Whole.Corners[1].At,
      own.Whole.Corners[2].At } };
    for (std::size_t i = 0; i < hits; ++i)
    {
      const Neighbor& other = this->Block[this->Hits[i]];
      const std::array<Point2, 3> at = own.FromOrigin(other.At);
      if (!IsApart(corners, at))
      {
        this->OverlayWith(own, at, other.Elevations);
      }
    }
  }

  /** Whether an edge of a triangle has no corner of another one on its left. */
  static bool IsApart(const std::array<Point2, 3>& own, const std::array<Point2, 3>& other)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Point2 &a = own[k], &b = own[k == 2 ? 0 : k + 1];
      if (!IsLeft(a, b, other[0]) && !IsLeft(a, b, other[1]) && !IsLeft(a, b, other[2]))
      {
        return true;
      }
    }
    return false;
  }

  void OverlayWith(
    Overlaid& own, const std::array<Point2, 3>& corners, const std::array<double, 3>& elevations)
  {
    Polygon parts[4];
    Polygon* last = &parts[3];
    for (int k = 0; k < 3; ++k)
    {
      last->Add(own.Whole.Corners[k]);
    }
    for (int k = 0; k < 3; ++k)
    {
      const Point2 &a = corners[k], &b = corners[k == 2 ? 0 : k + 1];
      const Sides sides = SidesOf(*last, a, b);
      if ((sides.Right | sides.On) == last->All())
      {
        return;
      }
      if (sides.Right != 0)
      {
        Cut(
          *last, sides.Right, [&](const Corner& corner) { return TwiceArea(a, b, corner.At); },
          parts[k]);
        last = &parts[k];
      }
    }
    const double whole2 = TwiceArea(corners[0], corners[1], corners[2]);
    if (!(whole2 > 0.0))
    {
      return; // its area is below the smallest number
    }
    for (int i = 0; i < last->Count; ++i)
    {
      Corner& corner = last->Corners[i];
      // The second surface there, by areas: a mean of its corners, so flat triangles lose nothing.
      double shares[3], elevation = 0.0;
      for (int k = 1; k < 3; ++k)
      {
        const double area = TwiceArea(corners[k == 2 ? 0 : 2], corners[k == 2 ? 1 : 0], corner.At);
        shares[k] = std::min(std::max(area / whole2, 0.0), 1.0);
      }
      shares[0] = 1.0 - shares[1] - shares[2];
      for (int k = 0; k < 3; ++k)
      {
        elevation += shares[k] * (elevations[k] - own.Base);
      }
      corner.Difference -= elevation;
    }
    this->Add(own, *last);
  }

  /** A polygon on which the difference is linear. */
  void Add(Overlaid& own, const Polygon& polygon)
  {
    const Integrals whole = Integrate(polygon);
    own.Common.Add(whole.Area);
    own.Weighted.Add(whole.Value);
    bool isAbove = false, isBelow = false;
    for (int i = 0; i < polygon.Count; ++i)
    {
      isAbove |= polygon.Corners[i].Difference > 0.0;
      isBelow |= polygon.Corners[i].Difference < 0.0;
    }
    if (isAbove && isBelow)
    {
      own.Above.Add(IntegralOf(polygon, 1.0));
      own.Below.Add(-IntegralOf(polygon, -1.0));
    }
    else
    {
      (isBelow ? own.Below : own.Above).Add(std::fabs(whole.Difference));
    }
    if (this->Map)
    {
      this->Draw(own.Origin, polygon);
    }
  }

  ELEVATION_APART void Draw(const Point2& origin, const Polygon& polygon)
  {
    const Index first = static_cast<Index>(this->Map->Points.size() / 3);
    for (int i = 0; i < polygon.Count; ++i)
    {
      const Corner& corner = polygon.Corners[i];
      this->Map->Points.insert(this->Map->Points.end(),
        { origin.X + corner.At.X, origin.Y + corner.At.Y, corner.Difference });
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
  DifferenceMap* Map = nullptr;
  std::array<Overlaid, Together> Group;
  std::vector<Index> Near; ///< triangles of the second surface near the group
  // Some of them, their boxes, and those near one of the group.
  std::array<Neighbor, BlockSize> Block;
  std::array<Box, BlockSize> Boxes;
  std::array<std::size_t, BlockSize> Hits;
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
    const Index last = std::min(count, (task + 1) * AtOnce);
    overlaying.OverlayAll(
      order.data() + task * AtOnce, order.data() + last, map ? &maps[task] : nullptr, result);
  });
  if (map)
  {
    JoinMaps(maps, stages.Next(), *map);
  }
  return result;
}

} // namespace elevation
