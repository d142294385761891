// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Passes over all points, on several threads, and what the first of them tells.
 */
#ifndef elevation_Base_Extent_h
#define elevation_Base_Extent_h

#include "Threads.h"

#include <algorithm>
#include <cfloat>
#include <vector>

namespace elevation
{

/** The smallest box around points, with its sides along the axes; no points at first. */
struct Box
{
  Point2 Low{ DBL_MAX, DBL_MAX }, High{ -DBL_MAX, -DBL_MAX };

  double Width() const { return this->High.X - this->Low.X; }
  double Height() const { return this->High.Y - this->Low.Y; }
  /** Whether a point is inside or on the border; without branches. */
  bool Holds(const Point2& p) const
  {
    return (p.X >= this->Low.X) & (p.X <= this->High.X) & (p.Y >= this->Low.Y) &
      (p.Y <= this->High.Y);
  }
  bool Touches(const Box& box) const
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

/** What one look at all points tells: the box of those that are finite, and the others. */
struct Extent : Box
{
  std::vector<Index> NotFinite; ///< ids of points with a coordinate that is not finite, increasing
};

/** How many points are passed over at once: a piece of work for one thread. */
constexpr Index PointsPerRange = 1 << 16;

inline Index NumberOfRanges(Index count, Index size = PointsPerRange)
{
  return count / size + (count % size != 0 ? 1 : 0);
}

/**
 * Calls work(piece, begin, end) for the ranges of so many ids that make up [0, count), on several
 * threads, and reports between them. A piece is the same range each time, so what it gathers may be
 * kept by piece without locks.
 */
template <typename Work>
void ForEachRange(
  Index count, int threads, const Progress& progress, Work&& work, Index size = PointsPerRange)
{
  ForEachPiece(NumberOfRanges(count, size), threads, progress, [&](Index piece) {
    const Index begin = piece * size;
    work(piece, begin, begin + std::min(size, count - begin));
  });
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

/** Adds the points of a range, x, y, z interleaved, to an extent; visits those that are finite. */
template <typename T, typename Visit>
void AddToExtent(const T* points, Index begin, Index end, Extent& extent, Visit&& visit)
{
  Box here; // in registers
  const T* p = points + 3 * static_cast<std::size_t>(begin);
  for (Index id = begin; id < end; ++id, p += 3)
  {
    const double x = p[0], y = p[1], z = p[2];
    // The difference of a finite number with itself is 0, of any other not a number.
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

/**
 * The extent of points, which are visited on the way: visit(piece, point) for each that is finite,
 * with the piece as of ForEachRange().
 */
template <typename Visit>
Extent FindExtent(const PointView& points, int threads, const Progress& progress, Visit&& visit)
{
  std::vector<Extent> pieces(NumberOfRanges(points.Count));
  ForEachRange(points.Count, threads, progress, [&](Index piece, Index begin, Index end) {
    Extent here; // not in memory that other threads write next to
    const auto visitHere = [&](const Point2& p) { visit(piece, p); };
    if (points.Double)
    {
      AddToExtent(points.Double, begin, end, here, visitHere);
    }
    else
    {
      AddToExtent(points.Float, begin, end, here, visitHere);
    }
    pieces[piece] = std::move(here);
  });
  Extent extent;
  std::size_t notFinite = 0;
  for (const Extent& piece : pieces)
  {
    extent.Join(piece);
    notFinite += piece.NotFinite.size();
  }
  extent.NotFinite.reserve(notFinite);
  for (const Extent& piece : pieces)
  {
    if (!piece.NotFinite.empty())
    {
      Report(progress, 1.0);
    }
    extent.NotFinite.insert(extent.NotFinite.end(), piece.NotFinite.begin(), piece.NotFinite.end());
  }
  return extent;
}

} // namespace elevation

#endif
