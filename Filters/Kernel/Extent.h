// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Passes over all points, on several threads, and what the first of them tells.
 */
#ifndef elevation_Extent_h
#define elevation_Extent_h

#include "Parallel.h"
#include "Types.h"

#include <algorithm>
#include <cfloat>
#include <vector>

namespace elevation
{

/** What one look at all points tells. */
struct Extent
{
  Point2 Low{ DBL_MAX, DBL_MAX }, High{ -DBL_MAX, -DBL_MAX }; ///< of the finite points
  std::vector<Index> NotFinite; ///< ids of points with a coordinate that is not finite, increasing

  double Width() const { return this->High.X - this->Low.X; }
  double Height() const { return this->High.Y - this->Low.Y; }
  void Add(const Point2& p) { this->Add(p, p); }
  void Add(const Point2& low, const Point2& high)
  {
    this->Low = { low.X < this->Low.X ? low.X : this->Low.X,
      low.Y < this->Low.Y ? low.Y : this->Low.Y };
    this->High = { high.X > this->High.X ? high.X : this->High.X,
      high.Y > this->High.Y ? high.Y : this->High.Y };
  }
};

/** Into how many parts ForEachRange divides points, for so many threads. */
inline Index NumberOfParts(int threads)
{
  return threads > 1 ? 4 * threads : 1;
}

/**
 * Calls work(part, begin, end) for ranges of ids that make up [0, count), on several threads, and
 * reports between them. A part gets the same ranges each time, by increasing id, and is never with
 * two threads at once, so what it gathers may be kept by part without locks.
 */
template <typename Work>
void ForEachRange(Index count, int threads, const Progress& progress, Work&& work)
{
  constexpr Index least = 1 << 14, most = 1 << 18;
  const Index parts = NumberOfParts(threads);
  const Index length = std::min(std::max(count / parts + 1, least), most);
  for (std::int64_t done = 0; done < count; done += std::int64_t(parts) * length)
  {
    Report(progress, double(done) / count);
    const Index ranges =
      static_cast<Index>(std::min<std::int64_t>(parts, (count - done + length - 1) / length));
    ForEachPiece(ranges, threads, [&](Index part) {
      const Index begin = static_cast<Index>(done) + part * length;
      work(part, begin, begin + std::min(length, count - begin));
    });
  }
}

/** Visits (id, Point2) of the points of a range but those listed, by increasing id. */
template <typename Visit>
void ForEachPoint(
  const PointView& points, Index begin, Index end, const std::vector<Index>& but, Visit&& visit)
{
  auto next = std::lower_bound(but.begin(), but.end(), begin);
  while (begin < end)
  {
    const Index stop = next != but.end() ? std::min(end, *next) : end;
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
    if (next != but.end() && begin == *next)
    {
      ++begin;
      ++next;
    }
  }
}

/**
 * The extent of points, which are visited on the way: visit(part, point) for each that is finite,
 * with the part as of ForEachRange().
 */
template <typename Visit>
Extent FindExtent(const PointView& points, int threads, const Progress& progress, Visit&& visit)
{
  std::vector<Extent> parts(NumberOfParts(threads));
  ForEachRange(points.Count, threads, progress, [&](Index part, Index begin, Index end) {
    Extent here; // not in memory that other threads write next to
    ForEachPoint(points, begin, end, {}, [&](Index id, const Point2& p) {
      // The difference of a finite number with itself is 0, of any other not a number.
      if (!((p.X - p.X) + (p.Y - p.Y) + (points.Elevation(id) - points.Elevation(id)) == 0.0))
      {
        parts[part].NotFinite.push_back(id);
        return;
      }
      here.Add(p);
      visit(part, p);
    });
    parts[part].Add(here.Low, here.High);
  });
  Extent extent;
  for (const Extent& part : parts)
  {
    extent.Add(part.Low, part.High);
    extent.NotFinite.insert(extent.NotFinite.end(), part.NotFinite.begin(), part.NotFinite.end());
  }
  std::sort(extent.NotFinite.begin(), extent.NotFinite.end());
  return extent;
}

} // namespace elevation

#endif
