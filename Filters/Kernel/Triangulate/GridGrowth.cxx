// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "GridGrowth.h"

#include "ApexSearch.h"
#include "DivideAndConquer.h"
#include "EdgeLimit.h"

#include <memory>

namespace elevation
{
namespace
{

/** How many fans of a strip are grown between two reports of progress, and for how long at most. */
constexpr int FansPerRound = 32768;
constexpr std::chrono::milliseconds TimePerRound(50);

/**
 * Points and boxes that searches may look at for each vertex before growing is given up; by
 * compactness, which looks at more, ten times as many.
 */
constexpr std::int64_t WorkPerVertex = 300;
/** After so many looks, the time is looked at. */
constexpr std::int64_t LooksPerClock = 10000;

/**
 * The edge pool: the first and the last edge, counter-clockwise, of the fan of triangles above each
 * vertex, as their other ends. None where it is not known yet.
 */
class EdgePool
{
public:
  EdgePool(Index count, const Hull& hull, int threads, const Progress& progress)
  {
    this->Ends.Resize(2 * static_cast<std::size_t>(count));
    ForEachRange(count, threads, progress, [&](Index, Index begin, Index end) {
      std::fill(this->Ends.begin() + 2 * static_cast<std::size_t>(begin),
        this->Ends.begin() + 2 * static_cast<std::size_t>(end), None);
    });
    for (std::size_t i = 0; i + 1 < hull.RightChain.size(); ++i)
    {
      this->Tell(hull.RightChain[i], 0, hull.RightChain[i + 1]);
    }
    for (std::size_t i = 0; i + 1 < hull.LeftChain.size(); ++i)
    {
      this->Tell(hull.LeftChain[i], 1, hull.LeftChain[i + 1]);
    }
  }

  const Index* At(Index vertex) const { return &this->Ends[2 * static_cast<std::size_t>(vertex)]; }
  Index First(Index vertex) const { return this->Ends[2 * static_cast<std::size_t>(vertex)]; }
  Index Last(Index vertex) const { return this->Ends[2 * static_cast<std::size_t>(vertex) + 1]; }
  void Tell(Index vertex, int isLast, Index end)
  {
    this->Ends[2 * static_cast<std::size_t>(vertex) + isLast] = end;
  }

private:
  Buffer<Index> Ends;
};

/**
 * Grows the triangles whose lowest vertices are in a strip: a stretch of the vertices from the
 * lowest up. It reads and writes the pool for these only, so that strips may be grown at the same
 * time. What triangles of the strips below would have told, and how many they are, it finds out by a
 * walk through the triangles that cross its lower border.
 */
class Strip
{
public:
  Strip(const BinGrid& grid, const DelaunayOptions& options, EdgePool& pool, Index begin, Index end)
    : Grid(grid)
    , Order(grid.Order)
    , Pool(pool)
    , Budget(WorkPerVertex * (options.Strategy == SearchStrategy::Compactness ? 10 : 1),
        end - begin, LooksPerClock)
    , Search(grid, options, Budget)
    , Begin(begin)
    , End(end)
    , Next(begin)
    , Limit(options.MaximumEdgeLength * grid.Scale)
  {
  }

  /** Begins the walk along the border, on the right of the hull. */
  void SetBorder(const Hull& hull)
  {
    const auto firstAbove = [&](const std::vector<Index>& chain) {
      return std::partition_point(
               chain.begin(), chain.end(), [&](Index slot) { return this->IsBelow(slot); }) -
        chain.begin();
    };
    const std::ptrdiff_t right = firstAbove(hull.RightChain), left = firstAbove(hull.LeftChain);
    this->Outline = (hull.RightChain.size() - 1 - right) + (hull.LeftChain.size() - 1 - left);
    this->Lower = hull.RightChain[right - 1];
    this->Upper = hull.RightChain[right];
    this->LastLower = hull.LeftChain[left - 1];
    this->LastUpper = hull.LeftChain[left];
  }

  bool HasWalked() const
  {
    return this->Lower == this->LastLower && this->Upper == this->LastUpper;
  }

  /** Goes on for a while through the triangles that cross the border below the strip. */
  void Walk()
  {
    const auto end = std::chrono::steady_clock::now() + TimePerRound;
    for (int steps = 1; !this->HasWalked(); ++steps)
    {
      const Index apex = this->Search.FindAnywhere(this->Lower, this->Upper);
      this->Budget.Check();
      if (apex == None)
      {
        throw std::logic_error("there is no triangle over the edge of points " +
          std::to_string(this->Grid.Ids[this->Lower]) + " and " +
          std::to_string(this->Grid.Ids[this->Upper]) +
          "; this is a fault of the triangulation, please report it");
      }
      if (this->IsBelow(apex))
      {
        this->Lower = apex;
      }
      else
      {
        ++this->Outline;
        this->Tell(this->Upper, apex);
        this->Upper = apex;
      }
      if ((steps % 64 == 0 || this->HasLooked()) && std::chrono::steady_clock::now() > end)
      {
        return;
      }
    }
  }

  /**
   * How many triangles lie wholly above the border, when the walk is done. By Euler's formula, n
   * vertices joined by triangles and edges, with no hole, and an outline of b edges, those seen from
   * both sides counted twice, have 2 n - 2 - b triangles.
   */
  std::size_t TrianglesAbove() const
  {
    return 2 * static_cast<std::size_t>(this->Grid.NumberOfPoints() - this->Begin) - 2 -
      this->Outline;
  }

  /** Where the triangles are to be written, and where the next strip's begin. */
  void SetOutput(Index* begin, Index* end)
  {
    this->Out = this->OutBegin = begin;
    this->OutEnd = end;
  }

  /** What has been written. */
  std::pair<const Index*, const Index*> Triangles() const { return { this->OutBegin, this->Out }; }

  double Done() const { return double(this->Next - this->Begin) / (this->End - this->Begin); }

  /** Goes on for a while. */
  void Grow()
  {
    const auto end = std::chrono::steady_clock::now() + TimePerRound;
    for (int fans = 1; this->Next < this->End; ++fans)
    {
      this->AskForRowsAbove();
      if (!this->GrowFan(this->Order[this->Next], end))
      {
        return;
      }
      ++this->Next;
      if (fans % 256 == 0 && (fans == FansPerRound || std::chrono::steady_clock::now() > end))
      {
        return;
      }
    }
  }

private:
  bool IsBelow(Index slot) const
  {
    return IsLower(this->Grid.PointAt(slot), this->Grid.PointAt(this->Order[this->Begin]));
  }

  /**
   * Slots are in rows as well: so many further on lies what fans soon reach for the first time, in
   * another order.
   */
  void AskForRowsAbove() const
  {
    constexpr Index rows = 5, inLine = 8; // of the widest values
    if (this->Next % inLine == 0)
    {
      const Index ahead =
        std::min(this->Next + rows * this->Grid.Bins.Columns, this->Grid.NumberOfPoints() - 1);
      Prefetch(&this->Grid.X[ahead]);
      Prefetch(&this->Grid.Y[ahead]);
      Prefetch(&this->Grid.Ids[ahead]);
      Prefetch(this->Pool.At(ahead));
    }
  }

  /**
   * Grows the fan of the next vertex, or goes on with it.
   * @return false when it is not complete at the given time
   */
  bool GrowFan(Index lowest, std::chrono::steady_clock::time_point until)
  {
    if (lowest == this->Order[this->Grid.NumberOfPoints() - 1])
    {
      return true;
    }
    const Index first = this->Pool.First(lowest), end = this->Pool.Last(lowest);
    if (first == end && first != None)
    {
      return true;
    }
    if (this->Fan.empty())
    {
      this->Fan.Append(first);
      this->Search.SetOrigin(
        lowest, this->Next + 1 < this->End ? this->Order[this->Next + 1] : None);
    }
    Index current = this->Fan[this->Fan.size() - 1];
    while (current != end || current == None)
    {
      const std::size_t count = this->Fan.size();
      if (current != None)
      {
        this->Search.Follow(this->Fan, end);
        if (this->Fan.size() == count)
        {
          this->Fan.Append(this->Search.Find(current, end));
          this->Budget.Check();
        }
        current = this->Fan[this->Fan.size() - 1];
      }
      if (current == None || this->Fan.size() > static_cast<std::size_t>(this->Order.size()))
      {
        throw std::logic_error("the fan of point " + std::to_string(this->Grid.Ids[lowest]) +
          " does not close; this is a fault of the triangulation, please report it");
      }
      if (current != end && this->HasLooked() && std::chrono::steady_clock::now() > until)
      {
        return false;
      }
    }
    this->Emit(lowest);
    this->Fan.Resize(0);
    return true;
  }

  /** Whether searches have looked at many points since it was so the last time. */
  bool HasLooked()
  {
    const bool hasLooked = this->Budget.IsPaused();
    if (hasLooked)
    {
      this->Budget.Resume();
    }
    return hasLooked;
  }

  /** Writes the triangles of a fan and tells their upper vertices. */
  void Emit(Index lowest)
  {
    const std::size_t triangles = this->Fan.size() - 1;
    if (static_cast<std::size_t>(this->OutEnd - this->Out) < 3 * triangles)
    {
      throw std::logic_error("the triangles above point " + std::to_string(this->Grid.Ids[lowest]) +
        " are too many; this is a fault of the triangulation, please report it");
    }
    const Index lowestId = this->Grid.Ids[lowest];
    const auto pointOf = [this](Index slot) { return this->Grid.PointAt(slot); };
    Index current = this->Fan[0];
    for (std::size_t i = 1; i <= triangles; ++i)
    {
      const Index apex = this->Fan[i];
      this->Out[0] = lowestId;
      this->Out[1] = this->Grid.Ids[current];
      this->Out[2] = this->Grid.Ids[apex];
      this->Out += this->Limit.Admits(pointOf, lowest, current, apex) ? 3 : 0;
      this->Tell(current, apex);
      current = apex;
    }
  }

  /** Tells the lower end of a triangle's upper edge, counter-clockwise from p to q, of the other. */
  void Tell(Index p, Index q)
  {
    const Point2 pPoint = this->Grid.PointAt(p), qPoint = this->Grid.PointAt(q);
    const bool isRising = IsLower(pPoint, qPoint);
    const Index ends[2] = { q, p };
    if (this->End == this->Grid.NumberOfPoints() ||
      IsLower(isRising ? pPoint : qPoint, this->Grid.PointAt(this->Order[this->End])))
    {
      this->Pool.Tell(ends[isRising], isRising, ends[!isRising]);
    }
  }

  const BinGrid& Grid;
  const Buffer<Index>& Order;
  EdgePool& Pool;
  WorkBudget Budget;
  ApexSearch Search;
  const Index Begin, End;
  Index Next;
  const EdgeLimit Limit;
  Buffer<Index> Fan; ///< of the vertex at hand: its upper neighbours so far, counter-clockwise
  // The edge that the walk has come to, and the last one; edges of the outline above.
  Index Lower = None, Upper = None, LastLower = None, LastUpper = None;
  std::size_t Outline = 0;
  Index *OutBegin = nullptr, *Out = nullptr, *OutEnd = nullptr;
};

/**
 * Grows all triangles, in a strip for each thread; in rounds, with a report between. A strip's
 * triangles do not depend on where strips begin, and each writes them where they belong: so they are
 * the same, byte for byte, for any number of strips.
 */
void Grow(const BinGrid& grid, const Hull& hull, const DelaunayOptions& options, int threads,
  Buffer<Index>& triangles)
{
  const Index count = grid.NumberOfPoints();
  EdgePool pool(count, hull, threads, Part(options.Monitor, 0.2, 0.2));

  constexpr Index fewestPerStrip = 5000;
  const Index number = options.PointsPerStrip > 0
    ? (count - 1) / options.PointsPerStrip + 1
    : std::max(std::min(threads, count / fewestPerStrip), 1);
  std::vector<std::unique_ptr<Strip>> strips;
  for (Index i = 0; i < number; ++i)
  {
    const auto at = [&](Index k) {
      return static_cast<Index>(static_cast<std::int64_t>(count) * k / number);
    };
    strips.emplace_back(new Strip(grid, options, pool, at(i), at(i + 1)));
  }

  const Progress progress = Part(options.Monitor, 0.2, 1.0);
  std::vector<std::size_t> above(number + 1, 0); // triangles from each strip upwards
  above[0] =
    2 * static_cast<std::size_t>(count) - 2 - (hull.RightChain.size() + hull.LeftChain.size() - 2);
  bool haveWalked = false;
  for (Index i = 1; i < number; ++i)
  {
    strips[i]->SetBorder(hull);
  }
  while (!haveWalked)
  {
    Report(progress, 0.0);
    ForEachPiece(number - 1, threads, [&](Index i) { strips[i + 1]->Walk(); });
    haveWalked = true;
    for (Index i = 1; i < number; ++i)
    {
      haveWalked = haveWalked && strips[i]->HasWalked();
      above[i] = strips[i]->TrianglesAbove();
    }
  }
  triangles.Resize(3 * above[0]);
  Index* const end = triangles.end();
  for (Index i = 0; i < number; ++i)
  {
    strips[i]->SetOutput(end - 3 * above[i], end - 3 * above[i + 1]);
  }
  for (double done = 0.0; done < 1.0;)
  {
    ForEachPiece(number, threads, [&](Index i) { strips[i]->Grow(); });
    done = 1.0;
    for (const auto& strip : strips)
    {
      done = std::min(done, strip->Done());
    }
    Report(progress, done);
  }
  // Without what the edge limit left out.
  Index* written = triangles.begin();
  for (const auto& strip : strips)
  {
    const auto part = strip->Triangles();
    written = part.first == written ? written + (part.second - part.first)
                                    : std::copy(part.first, part.second, written);
  }
  triangles.Resize(written - triangles.begin());
  triangles.Shrink();
}

/** The same triangles in the same order, in n log n whatever the points. */
Buffer<Index> Divide(const BinGrid& grid, const DelaunayOptions& options)
{
  const Buffer<Index>& order = grid.Order;
  const Progress progress = Part(options.Monitor, 0.2, 1.0);
  Buffer<Index> triangles;
  {
    const Progress begun = Part(progress, 0.0, 0.0);
    Buffer<Point2> points;
    points.Resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      ReportStep(begun, i, order.size());
      points[i] = grid.PointAt(order[i]);
    }
    triangles = DivideAndConquer(points, Part(progress, 0.0, 0.95));
  }
  const Progress naming = Part(progress, 0.95, 1.0);
  const EdgeLimit limit(options.MaximumEdgeLength * grid.Scale);
  const auto pointOf = [&grid](Index slot) { return grid.PointAt(slot); };
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    ReportStep(naming, t, triangles.size(), 49152);
    const Index p = order[triangles[t]], q = order[triangles[t + 1]], r = order[triangles[t + 2]];
    if (limit.Admits(pointOf, p, q, r))
    {
      triangles[kept++] = grid.Ids[p];
      triangles[kept++] = grid.Ids[q];
      triangles[kept++] = grid.Ids[r];
    }
  }
  triangles.Resize(kept);
  return triangles;
}
} // namespace

Buffer<Index> GrowOverGrid(
  BinGrid& grid, const Hull& hull, const DelaunayOptions& options, int threads)
{
  if (!options.DivideAtOnce)
  {
    try
    {
      Buffer<Index> triangles;
      triangles.Recycle(std::move(grid.Room));
      Grow(grid, hull, options, threads, triangles);
      return triangles;
    }
    catch (const CannotGrow&)
    {
    }
  }
  return Divide(grid, options);
}

} // namespace elevation
