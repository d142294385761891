// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Finds the lattice of a cloud: an origin and two step vectors such that the points lie on nodes.
 *
 * In: points in any order, on a lattice that may be rotated, sheared, of unequal steps, with most
 * nodes missing, with coordinates rounded to decimals. Out: the lattice, or the answer that there
 * is none. The passes:
 *   1. Bounding box; the fullest place of the cloud (a coarse histogram, refined).
 *   2. The points there, and a sample of the whole cloud, chosen by a hash of the coordinates.
 *   3. The shortest differences of the points there generate the lattice: an algorithm of Euclid on
 *      vectors, which takes a remainder below a few tolerances for none.
 *   4. From there outwards over the sample the steps are fitted by least squares to more and more
 *      points, so that rounding never amounts to a part of a step. A point between the nodes
 * refines the lattice.
 *   5. The steps are reduced [Lagrange], directed along the axes as far as possible, and rounded to
 *      the fewest decimals that move no node noticeably, so that steps that are round stay round.
 * Each step depends on the set of points alone, not on their order. What remains is to check every
 * point (LatticeNodes.h).
 *
 * Cost: three passes over the coordinates, on several threads, and a fraction of a millisecond.
 */
#ifndef elevation_Lattice_h
#define elevation_Lattice_h

#include "Parallel.h"
#include "Types.h"

#include <algorithm>
#include <vector>

namespace elevation
{

/** Node (i, j) is at Origin + i StepU + j StepV. The steps are a reduced basis, counter-clockwise.
 */
struct Lattice
{
  Point2 Origin{ 0.0, 0.0 };
  Point2 StepU{ 0.0, 0.0 };
  Point2 StepV{ 0.0, 0.0 };

  double Area() const { return this->StepU.X * this->StepV.Y - this->StepU.Y * this->StepV.X; }
  Point2 Node(double i, double j) const
  {
    return { this->Origin.X + i * this->StepU.X + j * this->StepV.X,
      this->Origin.Y + i * this->StepU.Y + j * this->StepV.Y };
  }
};

/** A lattice has at most so many nodes a point in the parallelogram of steps around the cloud. */
constexpr double MaximumNodesPerPoint = 64.0;

/** What is known of a cloud after FindLattice. */
struct LatticeSearch
{
  bool Found = false;
  Lattice Steps; ///< where found; Origin is some node
  Point2 Low{ 0.0, 0.0 }, High{ 0.0, 0.0 };
  std::vector<Index> NotFinite; ///< ids of points with a coordinate that is not finite
};

/**
 * Looks for a lattice that the cloud may lie on.
 * @param tolerance  how far a point may lie from its node, along each step, in steps; 0 to 0.25
 * A negative answer comes early; a positive one holds for a sample of the points only.
 */
LatticeSearch FindLattice(
  const PointView& points, double tolerance, int threads, const Progress& progress);

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

} // namespace elevation

#endif
