// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "GridGrowth.h"

#include "ApexSearch.h"
#include "Growth.h"

#include <array>

namespace elevation
{
namespace
{

/**
 * Points and boxes that searches may look at per vertex before growth is given up; for Compactness,
 * which looks at more, ten times as many.
 */
constexpr std::int64_t WorkPerVertex = 600;
/**
 * The rest of the work for a fan, in the same unit: pauses come regularly also where searches find
 * the apex among few points.
 */
constexpr std::int64_t WorkPerFan = 40;
// A pause comes between two searches only; one search ends by MostLooks at the latest
// (ApexSearch.cxx).
constexpr std::int64_t WorkPerPause = 10000;

/** Growth over the points of a grid, numbered by their slots. */
class Growth
{
public:
  Growth(const BinGrid& grid, const DelaunayOptions& options)
    : Limit(options.MaximumEdgeLength * grid.Scale)
    , Grid(grid)
    , Options(options)
  {
  }

  // The interface that GrowAll() needs: strips, and for divide and conquer places and ids.
  class GridStrip;
  std::vector<std::unique_ptr<GridStrip>> MakeStrips(
    const Hull& hull, int threads, const Progress& progress);

  /** The points by increasing (y, x), once growth is given up. */
  Buffer<Point2> Places(const Progress& progress)
  {
    // Growth is over, so its memory goes before divide and conquer allocates.
    this->Pool = Buffer<Ends>();
    const Buffer<Index>& order = this->Grid.Order;
    Buffer<Point2> places;
    places.Resize(order.size());
    for (const std::size_t i : Counted(order.size()))
    {
      ReportStep(progress, i, order.size());
      places[i] = this->Grid.PointAt(order[i]);
    }
    return places;
  }

  /** Changes indices of Places() to ids. @return false if the edge limit leaves the triangle out */
  bool ToIds(Index* triangle) const
  {
    const Buffer<Index>&order = this->Grid.Order, &ids = this->Grid.Ids;
    const Index p = order[triangle[0]], q = order[triangle[1]], r = order[triangle[2]];
    triangle[0] = ids[p];
    triangle[1] = ids[q];
    triangle[2] = ids[r];
    return this->Limit.Admits([this](Index slot) { return this->Grid.PointAt(slot); }, p, q, r);
  }

  const EdgeLimit Limit;
  static constexpr const LatticeMetric* Metric = nullptr;

private:
  /** The other ends of the first and the last edge of a fan; None if not known yet. */
  using Ends = std::array<Index, 2>;

  const BinGrid& Grid;
  const DelaunayOptions& Options;
  Buffer<Ends> Pool; ///< the edge pool: for the fan of each vertex, counter-clockwise
};

/**
 * A strip of points; vertices are slots, in the order of BinGrid::Order. The pool is shared, but
 * each strip writes only the entries of its own vertices.
 */
class Growth::GridStrip : public Strip<GridStrip>
{
public:
  GridStrip(Growth& growth, const Hull& hull, Index begin, Index end)
    : Strip(hull, begin, end,
        WorkBudget(
          WorkPerVertex * (growth.Options.Strategy == SearchStrategy::Compactness ? 10 : 1),
          end - begin, WorkPerPause))
    , Grid(growth.Grid)
    , Order(growth.Grid.Order)
    , Pool(growth.Pool)
    , Limit(growth.Limit)
    , Search(growth.Grid, growth.Options, Budget)
    , Next(begin)
  {
  }

  bool IsDone() const { return this->Next == this->End; }
  double Done() const { return this->Next - this->Begin; }

  /** See Strip. By position: slots of one row are not in the order of y. */
  bool IsBelow(Index slot) const
  {
    return IsLower(this->Grid.PointAt(slot), this->Grid.PointAt(this->Order[this->Begin]));
  }

  // With q the lower end, the edge falls: it is the first edge of q's fan, as the triangle is to
  // the right of that fan. With p the lower end, it is the last one of p's fan. The two cases are
  // one line by indices, as their branch could not be predicted.
  bool RecordEdge(Index p, Index q)
  {
    const Point2 pPoint = this->Grid.PointAt(p), qPoint = this->Grid.PointAt(q);
    const bool isRising = IsLower(pPoint, qPoint);
    const Index ends[2] = { q, p };
    // Only whether it is above the strip is tested. Below there is none: a triangle's lower end is
    // never below the vertex, or border, that it was found from.
    const bool isInStrip = this->End == this->Grid.NumberOfPoints() ||
      IsLower(isRising ? pPoint : qPoint, this->Grid.PointAt(this->Order[this->End]));
    if (isInStrip)
    {
      this->Pool[ends[isRising]][isRising] = ends[!isRising];
    }
    return isInStrip;
  }

  // For lattices, where a walk needs no search between full cells.
  bool PassCells() { return false; }

  Index FindAcross()
  {
    // From High down to Low, with the unknown side on the left.
    const Index apex = this->Search.FindAnywhere(this->High, this->Low);
    if (apex == None)
    {
      // The walk ends at the hull's right side, so there is always a point on that side.
      ThrowOpenFan(this->Grid.Ids[this->Low]);
    }
    return apex;
  }

  void GrowFans()
  {
    while (this->Next < this->End && !this->Budget.IsPaused())
    {
      this->PrefetchRowsAbove();
      if (this->GrowFan(this->Order[this->Next]))
      {
        ++this->Next;
      }
      this->Budget.Spend(WorkPerFan);
    }
  }

private:
  /**
   * Prefetches points some rows above: slots are sorted by rows too, so fans reach these points
   * soon, in a different order.
   */
  void PrefetchRowsAbove() const
  {
    constexpr Index rows = 5, inLine = 8; // of the widest values
    if (this->Next % inLine == 0)
    {
      const Index ahead =
        std::min(this->Next + rows * this->Grid.Bins.Columns, this->Grid.NumberOfPoints() - 1);
      Prefetch(&this->Grid.X[ahead]);
      Prefetch(&this->Grid.Y[ahead]);
      Prefetch(&this->Grid.Ids[ahead]);
      Prefetch(&this->Pool[ahead]);
    }
  }

  /**
   * Grows the fan of the next vertex, or continues with it.
   * @return false if the budget pauses before it is complete
   */
  bool GrowFan(Index lowest)
  {
    // The highest point has no fan, and no edges recorded.
    if (lowest == this->Order[this->Grid.NumberOfPoints() - 1])
    {
      return true;
    }
    // Both ends of the fan are known: every triangle below this vertex has been written, in this
    // strip or by a walk.
    const Index first = this->Pool[lowest][0], end = this->Pool[lowest][1];
    // The triangles below meet above this vertex: it has no triangle of its own.
    if (first == end && first != None)
    {
      return true;
    }
    // Not empty where a pause has interrupted the fan: then it goes on from its last neighbour.
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
        // The wide search has stopped at an edge that needs exact predicates or a wider look.
        if (this->Fan.size() == count)
        {
          this->Fan.Append(this->Search.Find(current, end));
          this->Budget.Check();
        }
        current = this->Fan[this->Fan.size() - 1];
      }
      // None or too many neighbours: the fan runs past its last edge, which must not happen.
      if (current == None || this->Fan.size() > static_cast<std::size_t>(this->Order.size()))
      {
        ThrowOpenFan(this->Grid.Ids[lowest]);
      }
      // Also within a fan: one vertex may have most points of the cloud as neighbours.
      if (current != end && this->Budget.IsPaused())
      {
        return false;
      }
    }
    this->Emit(lowest);
    this->Fan.Resize(0);
    return true;
  }

  /** Writes the triangles of a fan and records their upper edges. */
  void Emit(Index lowest)
  {
    const std::size_t triangles = this->Fan.size() - 1;
    const Index lowestId = this->Grid.Ids[lowest];
    // Once per fan, so that Write() needs no check.
    this->NeedRoom(triangles, lowestId);
    const auto pointOf = [this](Index slot) { return this->Grid.PointAt(slot); };
    Index current = this->Fan[0];
    for (std::size_t i = 1; i <= triangles; ++i)
    {
      const Index apex = this->Fan[i];
      this->Write(lowestId, this->Grid.Ids[current], this->Grid.Ids[apex],
        this->Limit.Admits(pointOf, lowest, current, apex));
      this->RecordEdge(current, apex);
      current = apex;
    }
  }

  const BinGrid& Grid;
  const Buffer<Index>& Order;
  Buffer<Ends>& Pool;
  const EdgeLimit Limit;
  ApexSearch Search;
  Index Next;
  Buffer<Index> Fan; ///< the upper neighbours of the current vertex so far, counter-clockwise
};

/** One strip per thread. */
std::vector<std::unique_ptr<Growth::GridStrip>> Growth::MakeStrips(
  const Hull& hull, int threads, const Progress& progress)
{
  // A walk passes about as many triangles as a row of the strip has points, and more; with fewer
  // points per strip, walks would cost a noticeable share of the growth.
  constexpr Index fewestPerStrip = 5000;
  const Index count = this->Grid.NumberOfPoints(), perStrip = this->Options.PointsPerStrip;
  const Index number = perStrip > 0 ? (count - 1) / perStrip + 1
                                    : std::max(std::min(threads, count / fewestPerStrip), 1);
  const auto at = [&](Index k) {
    return static_cast<Index>(static_cast<std::int64_t>(count) * k / number);
  };
  this->Pool.Resize(count);
  ForEachRange(count, threads, progress, [this](Index, Index begin, Index end) {
    std::fill(this->Pool.begin() + begin, this->Pool.begin() + end, Ends{ None, None });
  });
  std::vector<std::unique_ptr<GridStrip>> strips;
  for (Index i = 0; i < number; ++i)
  {
    strips.push_back(std::make_unique<GridStrip>(*this, hull, at(i), at(i + 1)));
  }
  return strips;
}
} // namespace

Buffer<Index> GrowOverGrid(
  BinGrid& grid, const Hull& hull, const DelaunayOptions& options, int threads)
{
  Growth growth(grid, options);
  return GrowAll(growth, hull, grid.NumberOfPoints(), options, threads, options.Monitor,
    std::move(grid.Scratch));
}

} // namespace elevation
