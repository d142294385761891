// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeSample.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>

namespace elevation
{
namespace
{

// The search looks at samples only, so that it costs two passes over the coordinates:
// 1. SampleForLattice(): the extent, and a wide sample by hash;
// 2. FullestPlace(): where that sample is densest, cell by cell;
// 3. DistinctPointsIn(): all points there; FullestPart() cuts them down to the 128 that are closest
//    together.
// Some() is a smaller sample of the sample, by a lower limit of the same hash: the lattice is
// fitted to it.
constexpr Index FewestPoints = 6;      // fewer fit some lattice by chance
constexpr std::size_t Neighbors = 128; // points whose differences begin the search
constexpr std::size_t Crowd = 32;      // of the sample, in a place that is cut no further
constexpr double SampleSize = 1024.0;
constexpr int MostCells = 64; // along each side of the first histogram

/**
 * A hash of 32 evenly distributed bits, the same for equal points. A sample by hash is the same for
 * any order of points and any division into parts: a point is in it, or not, by its own
 * coordinates. Multiplication and shifts spread regular coordinates evenly; a grid sampled by rows
 * or columns would look like a line.
 */
std::uint64_t HashOf(const Point2& p)
{
  const double x = p.X + 0.0, y = p.Y + 0.0; // -0 becomes 0
  std::uint64_t a, b;
  std::memcpy(&a, &x, sizeof a);
  std::memcpy(&b, &y, sizeof b);
  a = (a ^ (a >> 32)) * 0x9e3779b97f4a7c15u + b;
  a = (a ^ (a >> 29)) * 0xbf58476d1ce4e5b9u;
  return (a ^ (a >> 32)) & 0xffffffffu;
}

/**
 * In how many points the fullest place is looked for: a share of a small cloud, since the search
 * would take longer than its triangulation. Not fewer than are fitted, which are some of them.
 */
double WideSampleSize(double count)
{
  return std::min(std::max(SampleSize, count / 16.0), 4096.0);
}

/** Points with a hash below this limit are a sample of about @a size, whatever their order. */
std::uint64_t HashLimit(double size, double count)
{
  return static_cast<std::uint64_t>(std::min(size / count, 1.0) * 0x1p32);
}

/** Passed to a sort, this is compiled into it; the function would be called. */
constexpr auto Lower = [](const Point2& p, const Point2& q) { return IsLower(p, q); };

/** A hash set of distinct points. */
class alignas(64) PlaceSet // against false sharing
{
public:
  // Half full at most, so a search ends after few slots.
  void Add(const Point2& p)
  {
    if (2 * this->Count >= this->Slots.size())
    {
      this->Grow();
    }
    this->Count += this->Put(p);
  }

  /** In no particular order. */
  std::vector<Point2> Places() const
  {
    std::vector<Point2> places;
    places.reserve(this->Count);
    std::copy_if(this->Slots.begin(), this->Slots.end(), std::back_inserter(places), IsTaken);
    return places;
  }

private:
  static bool IsTaken(const Point2& slot) { return slot.X == slot.X; } // free ones are NaN

  /** @return whether the place is new */
  bool Put(const Point2& p)
  {
    // Hashes of a sample are small: they differ in the lowest bits.
    std::size_t at = HashOf(p) & (this->Slots.size() - 1);
    while (IsTaken(this->Slots[at]))
    {
      if (this->Slots[at] == p)
      {
        return false;
      }
      at = (at + 1) & (this->Slots.size() - 1);
    }
    this->Slots[at] = p;
    return true;
  }

  /** Doubles the slots, which are a power of two so that a mask chooses one. */
  void Grow()
  {
    const std::vector<Point2> places = this->Places();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    // Twice as many; 64 at first.
    this->Slots.assign(std::max<std::size_t>(64, 4 * this->Count), { nan, nan });
    for (const Point2& p : places)
    {
      this->Put(p);
    }
  }

  std::vector<Point2> Slots; ///< a power of two of them, at most half of them taken
  std::size_t Count = 0;
};

/** Distinct points, by range. */
using Picked = std::vector<std::vector<Point2>>;

/** The distinct points of all ranges, in no particular order. */
std::vector<Point2> JoinPicked(Picked sets, const Progress& progress)
{
  if (sets.size() != 1) // a small cloud is one range
  {
    PlaceSet all;
    std::size_t joined = 0;
    for (std::vector<Point2>& set : Counted(sets))
    {
      ReportStep(progress, joined++, sets.size(), 16);
      for (const Point2& p : set)
      {
        all.Add(p);
      }
      set = std::vector<Point2>();
    }
    sets.assign(1, all.Places());
  }
  return std::move(sets[0]);
}

/**
 * Cells over a box, to find where most points are. Of several fullest cells the first is taken, so
 * the choice depends on the points alone.
 */
struct Histogram
{
  Histogram(const Box& box, int cells)
    : Low(box.Low)
    , PerX(box.Width() > 0.0 ? cells / box.Width() : 0.0)
    , PerY(box.Height() > 0.0 ? cells / box.Height() : 0.0)
    , Side(cells)
    , Counts(static_cast<std::size_t>(cells) * cells, 0)
  {
  }
  int CellOf(const Point2& p) const
  {
    const int column = std::min(static_cast<int>((p.X - this->Low.X) * this->PerX), this->Side - 1);
    const int row = std::min(static_cast<int>((p.Y - this->Low.Y) * this->PerY), this->Side - 1);
    return row * this->Side + column;
  }
  /** The lower left (0) or upper right (1) corner of a cell. */
  Point2 CornerOf(int cell, int upper) const
  {
    return { this->Low.X + (cell % this->Side + upper) / this->PerX,
      this->Low.Y + (cell / this->Side + upper) / this->PerY };
  }
  /** Whether the inverse size of the cells is finite, and not 0. */
  bool HasCells() const
  {
    return this->PerX > 0.0 && this->PerX <= DBL_MAX && this->PerY > 0.0 && this->PerY <= DBL_MAX;
  }
  /** Leaves only the points of the cell with the most, and returns the cell. */
  int KeepFullest(std::vector<Point2>& points)
  {
    for (const Point2& p : points)
    {
      ++this->Counts[this->CellOf(p)];
    }
    const int fullest = static_cast<int>(
      std::max_element(this->Counts.begin(), this->Counts.end()) - this->Counts.begin());
    points.erase(std::remove_if(points.begin(), points.end(),
                   [&](const Point2& p) { return this->CellOf(p) != fullest; }),
      points.end());
    return fullest;
  }

  Point2 Low;
  double PerX, PerY;
  int Side;
  std::vector<Index> Counts;
};

/**
 * Keeps only the points in the fullest cell of their box, repeatedly, until few are left. Before
 * KeepFullest(), whose halving would need many passes over so many points.
 */
void KeepFullestCells(std::vector<Point2>& points, const Progress& progress)
{
  // Between two reports.
  constexpr std::size_t few = 1 << 16;
  while (points.size() > few)
  {
    Histogram histogram(BoxOf(points), MostCells);
    if (!std::isfinite(histogram.PerX) || !std::isfinite(histogram.PerY))
    {
      return;
    }
    histogram.KeepFullest(points);
    Report(progress, 0.5);
  }
}

/**
 * Keeps the fullest part of a set of distinct points until few are left: the half with more points
 * of the longer side, again and again.
 */
void KeepFullest(std::vector<Point2>& points)
{
  while (points.size() > Neighbors)
  {
    const Box box = BoxOf(points);
    const Point2 &low = box.Low, &high = box.High;
    // Halve the longer side.
    const bool isWide = box.Width() > box.Height();
    // The middle of the box, not the median: the half with more points is the denser one.
    const double middle = isWide ? 0.5 * (low.X + high.X) : 0.5 * (low.Y + high.Y);
    const auto isLow = [&](const Point2& p) { return (isWide ? p.X : p.Y) < middle; };
    const std::size_t lower =
      static_cast<std::size_t>(std::count_if(points.begin(), points.end(), isLow));
    if (lower == 0 || lower == points.size())
    {
      std::sort(points.begin(), points.end(), Lower);
      points.resize(Neighbors); // only rounding errors apart
      return;
    }
    const bool keepLow = 2 * lower >= points.size();
    points.erase(std::remove_if(points.begin(), points.end(),
                   [&](const Point2& p) { return isLow(p) != keepLow; }),
      points.end());
  }
}

} // namespace

bool LatticeSample::MayFitLattice() const
{
  const double width = this->Width(), height = this->Height();
  // There is no lattice where squares and quotients might leave the range of double.
  return this->Count >= FewestPoints && width > 1e-60 && height > 1e-60 && width + height < 1e60;
}

std::vector<Point2> LatticeSample::Some() const
{
  const std::uint64_t limit = HashLimit(SampleSize, this->CloudSize);
  std::vector<Point2> some;
  std::copy_if(this->Points.begin(), this->Points.end(), std::back_inserter(some),
    [limit](const Point2& p) { return HashOf(p) < limit; });
  return some;
}

void LatticeSample::Add(LatticeSample&& part)
{
  this->Join(part);
  this->Count += part.Count;
  // Those of earlier parts are sorted.
  std::sort(part.Points.begin(), part.Points.end(), Lower);
  const auto middle =
    this->Points.insert(this->Points.end(), part.Points.begin(), part.Points.end());
  std::inplace_merge(this->Points.begin(), middle, this->Points.end(), Lower);
  this->Points.erase(std::unique(this->Points.begin(), this->Points.end()), this->Points.end());
}

// Each range of points has its own set; they are joined at the end.
LatticeSample SampleForLattice(const PointView& points, double totalCount, int threads,
  const Progress& progress, std::vector<Index>& notFinite)
{
  Stages stages(progress, { 90, 10 });
  Picked picked(NumberOfRanges(points.Count));
  std::vector<PlaceSet> sets(picked.size());
  const std::uint64_t limit = HashLimit(WideSampleSize(totalCount), totalCount);
  Extent extent = FindExtent(points, threads, stages.Next(), [&](Index range, const Point2& p) {
    if (HashOf(p) < limit)
    {
      sets[range].Add(p);
    }
  });
  std::transform(
    sets.begin(), sets.end(), picked.begin(), [](const PlaceSet& set) { return set.Places(); });
  LatticeSample sample;
  static_cast<Box&>(sample) = extent;
  sample.CloudSize = totalCount;
  sample.Count = static_cast<double>(points.Count) - static_cast<double>(extent.NotFinite.size());
  sample.Points = JoinPicked(std::move(picked), stages.Next());
  notFinite = std::move(extent.NotFinite);
  return sample;
}

// From the sample alone, with the counts of the cloud estimated from it: no further look at the
// points.
Box FullestPlace(const LatticeSample& sample)
{
  Box place = sample;
  std::vector<Point2> crowd = sample.Points;
  // A histogram of the crowd, then of its fullest cell, and so on. Each has so many cells that a
  // mean one holds as many points of the cloud as the search wants.
  for (int depth = 0; depth < 64 && crowd.size() > Crowd; ++depth)
  {
    const double here = sample.Count * (crowd.size() / static_cast<double>(sample.Points.size()));
    const double cells = std::sqrt(here / static_cast<double>(Neighbors));
    Histogram histogram(place, static_cast<int>(std::min(std::max(cells, 1.0), 1.0 * MostCells)));
    if (histogram.Side < 2 || !histogram.HasCells())
    {
      // A cell holds few enough points, or the place cannot be divided in doubles.
      break;
    }
    const int fullest = histogram.KeepFullest(crowd);
    place = BoxOf(crowd); // rounding may have put a point beside its cell
    place.Add(histogram.CornerOf(fullest, 0));
    place.Add(histogram.CornerOf(fullest, 1));
  }
  return place;
}

std::vector<Point2> DistinctPointsIn(const Box& place, const PointView& points,
  const std::vector<Index>& notFinite, int threads, const Progress& progress)
{
  Stages stages(progress, { 80, 20 });
  Picked picked(NumberOfRanges(points.Count));
  ForEachRange(
    points.Count, threads, stages.Next(), [&](Index range, Index begin, Index end) {
      PlaceSet here;
      ForEachPoint(points, begin, end, notFinite, [&](Index, const Point2& p) {
        if (place.Contains(p))
        {
          here.Add(p);
        }
      });
      picked[range] = here.Places();
    });
  return JoinPicked(std::move(picked), stages.Next());
}

std::vector<Point2> FullestPart(std::vector<Point2>&& points, const Progress& progress)
{
  std::vector<Point2> part = std::move(points);
  KeepFullestCells(part, progress);
  KeepFullest(part);
  std::sort(part.begin(), part.end(), Lower); // differences and the middle depend on the order
  return part;
}

} // namespace elevation
