// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The bounding box and the non-finite points of a cloud, and loops over its points on several
 * threads. Cost: linear.
 */
#ifndef elevation_Base_Extent_h
#define elevation_Base_Extent_h

#include "Threads.h"

#include <algorithm>
#include <cfloat>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

namespace elevation
{

/**
 * An axis-parallel bounding box; empty at first. The empty box has its corners the wrong way
 * around, so it contains and intersects nothing, and joining it changes nothing. Width() and
 * Height() are infinite for a box wider than the largest double.
 */
struct Box
{
  Point2 Low{ DBL_MAX, DBL_MAX }, High{ -DBL_MAX, -DBL_MAX };

  double Width() const { return this->High.X - this->Low.X; }
  double Height() const { return this->High.Y - this->Low.Y; }
  Point2 Center() const
  {
    return { this->Low.X + 0.5 * this->Width(), this->Low.Y + 0.5 * this->Height() };
  }
  /** Whether a point is inside or on the boundary; without branches. */
  bool Contains(const Point2& p) const
  {
    return (p.X >= this->Low.X) & (p.X <= this->High.X) & (p.Y >= this->Low.Y) &
      (p.Y <= this->High.Y);
  }
  bool Intersects(const Box& box) const
  {
    return box.High.X >= this->Low.X && box.Low.X <= this->High.X && box.High.Y >= this->Low.Y &&
      box.Low.Y <= this->High.Y;
  }
  void Add(const Point2& p) { this->Join({ p, p }); }
  void Join(const Box& box)
  {
    this->Low = { std::min(this->Low.X, box.Low.X), std::min(this->Low.Y, box.Low.Y) };
    this->High = { std::max(this->High.X, box.High.X), std::max(this->High.Y, box.High.Y) };
  }
};

/** The bounding box of points. */
template <typename Points>
Box BoxOf(const Points& points)
{
  Box box;
  for (const Point2& p : points)
  {
    box.Add(p);
  }
  return box;
}

/** For messages: "x 1 to 2, y 3 to 4". */
inline std::string NameOf(const Box& box)
{
  std::ostringstream text;
  text << std::setprecision(10) << "x " << box.Low.X << " to " << box.High.X << ", y " << box.Low.Y
       << " to " << box.High.Y;
  return text.str();
}

/** The bounding box of the finite points of a cloud, and a list of the others. */
struct Extent : Box
{
  std::vector<Index> NotFinite; ///< ids of points with a non-finite coordinate, increasing
};

/** The points of one range: a task of one thread. */
constexpr Index PointsPerRange = 1 << 16;

inline Index NumberOfRanges(Index count, Index size = PointsPerRange)
{
  // Not (count + size - 1) / size, which could overflow.
  return count / size + (count % size != 0 ? 1 : 0);
}

/**
 * Cuts [0, count) into ranges of @a size ids and calls work(range, begin, end) for each, on several
 * threads, reporting in between. The ranges depend on count and size alone, so results can be kept
 * by range without locks.
 */
template <typename Work>
void ForEachRange(
  Index count, int threads, const Progress& progress, Work&& work, Index size = PointsPerRange)
{
  ForEachTask(NumberOfRanges(count, size), threads, progress, [&](Index range) {
    const Index begin = range * size, here = std::min(size, count - begin);
    CountWork(static_cast<std::size_t>(here));
    work(range, begin, begin + here);
  });
}

/**
 * Calls visit(id, point) for the points of a range but those in the sorted list @a skip. The inner
 * loops run from one skipped point to the next and test neither for skipped points nor for the
 * type.
 */
template <typename Visit>
void ForEachPoint(
  const PointView& points, Index begin, Index end, const std::vector<Index>& skip, Visit&& visit)
{
  auto next = std::lower_bound(skip.begin(), skip.end(), begin);
  while (begin < end)
  {
    const Index stop = next != skip.end() ? std::min(end, *next) : end;
    if (points.Double)
    {
      const double* p = points.Double + 3 * static_cast<std::size_t>(begin);
      for (; begin < stop; ++begin, p += 3)
      {
        visit(begin, Point2{ p[0], p[1] });
      }
    }
    else
    {
      const float* p = points.Float + 3 * static_cast<std::size_t>(begin);
      for (; begin < stop; ++begin, p += 3)
      {
        visit(begin, Point2{ p[0], p[1] });
      }
    }
    if (next != skip.end() && begin == *next)
    {
      ++begin;
      ++next;
    }
  }
}

/** Adds the points of a range, x, y, z interleaved, to an extent; visits those that are finite. */
template <typename T, typename Visit>
void AddToExtent(const T* points, Index begin, Index end, Extent& extent, Visit&& visit)
{
  Box here; // in registers
  const T* p = points + 3 * static_cast<std::size_t>(begin);
  for (Index id = begin; id < end; ++id, p += 3)
  {
    const double x = p[0], y = p[1], z = p[2];
    // x - x is 0 for finite x, else NaN, which no addition removes: one comparison tests three
    // coordinates. A point with a bad elevation alone is not used either.
    if (!((x - x) + (y - y) + (z - z) == 0.0))
    {
      extent.NotFinite.push_back(id);
      continue;
    }
    here.Add({ x, y });
    visit(Point2{ x, y });
  }
  extent.Join(here);
}

/** The extent of points. Calls visit(range, point) for each finite one, as ForEachRange() would. */
template <typename Visit>
Extent FindExtent(const PointView& points, int threads, const Progress& progress, Visit&& visit)
{
  std::vector<Extent> extents(NumberOfRanges(points.Count));
  ForEachRange(points.Count, threads, progress, [&](Index range, Index begin, Index end) {
    Extent here; // local, against false sharing
    const auto visitHere = [&](const Point2& p) { visit(range, p); };
    if (points.Double)
    {
      AddToExtent(points.Double, begin, end, here, visitHere);
    }
    else
    {
      AddToExtent(points.Float, begin, end, here, visitHere);
    }
    extents[range] = std::move(here);
  });
  // Ranges are joined in their order, so the ids of non-finite points increase without sorting.
  Extent extent;
  std::size_t notFinite = 0;
  for (const Extent& one : extents)
  {
    extent.Join(one);
    notFinite += one.NotFinite.size();
  }
  extent.NotFinite.reserve(notFinite);
  for (const Extent& one : extents)
  {
    if (!one.NotFinite.empty())
    {
      // Such lists are long only where a cloud is full of NaN.
      Report(progress, 1.0);
    }
    extent.NotFinite.insert(extent.NotFinite.end(), one.NotFinite.begin(), one.NotFinite.end());
  }
  return extent;
}

} // namespace elevation

#endif
