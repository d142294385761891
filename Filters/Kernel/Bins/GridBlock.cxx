// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "GridBlock.h"

#include "Kernel/Base/Base.h"
#include "RowSorter.h"

#include <cfloat>
#include <utility>
#include <vector>

namespace elevation
{
namespace
{
using Node = BoxTree::Node;

// The passes, in the order of Run(): a counting sort into bins; the tree, which orders the slots of
// full bins; a sort of each row by (y, x); duplicates, which that sort has made neighbours.
class BlockFiller
{
public:
  BlockFiller(BinGrid& grid, GridBlock& block)
    : Grid(grid)
    , Filled(block)
    , Rows(block.EndRow - block.FirstRow)
    , Bins(static_cast<std::size_t>(this->Rows) * grid.Bins.Columns)
    , Order(grid.Order.data() + block.Begin)
    , Local{ grid.X.data() + block.Begin, grid.Y.data() + block.Begin,
      grid.Ids.data() + block.Begin, Buffer<Index>(), grid.Bins.Columns }
  {
  }

  void Run(const PointView& points, DuplicatePolicy policy, const Progress& progress)
  {
    Stages stages(progress, { 10, 50, 30, 5, 5, 0 });
    this->SortIntoBins(stages.Next());
    if (this->Filled.Tasks(this->Grid.Bins) > 1)
    {
      // Room for a node for each 48 points; if there are more, the buffer grows.
      this->Filled.Nodes.Reserve(this->Filled.Count / 48); // growing it takes long
    }
    this->Filled.Root = BoxTree::Build(
      this->Local, this->Rows, this->Filled.Points, this->Filled.Nodes, stages.Next());
    this->SortRows(stages.Next());
    this->SetDuplicatesAside(points, policy, stages.Next());
    const Progress closing = stages.Next();
    if (!this->Filled.Duplicates.empty())
    {
      this->CloseGaps(closing);
    }
    const Index* const starts = this->Local.Starts.data();
    Index* const to = this->Grid.Starts.data() +
      static_cast<std::size_t>(this->Filled.FirstRow) * this->Grid.Bins.Columns;
    this->ForEach(this->Bins, stages.Next(), [&](Index bin) { to[bin] = starts[bin]; });
  }

private:
  /** Calls visit(0) to visit(count - 1), with reports. */
  template <typename Visit>
  void ForEach(std::size_t count, const Progress& progress, Visit&& visit) const
  {
    const auto report = [&](double fraction) { Report(progress, fraction); };
    report(0.0);
    ForEachReporting(0, static_cast<Index>(count), report, visit);
  }

  /**
   * Counting sort. While filling, starts[b + 1] runs from the first slot of bin b to its end, which
   * is the first slot of the next bin.
   */
  void SortIntoBins(const Progress& progress)
  {
    Stages stages(progress, { 0, 50, 0, 50 });
    const BoxTree::Placed* const placed = this->Filled.Points;
    const Index begin = this->Filled.Begin, count = this->Filled.Count;
    this->Local.Starts.Resize(this->Bins + 1);
    Index* const starts = this->Local.Starts.data();
    this->ForEach(this->Bins + 1, stages.Next(), [&](Index bin) { starts[bin] = 0; });
    this->ForEach(count, stages.Next(), [&](Index i) { ++starts[placed[i].Bin + 1]; });
    Index sum = 0;
    const Progress between = stages.Next();
    this->ForEach(
      this->Bins, between, [&](Index bin) { sum += std::exchange(starts[bin + 1], sum); });
    // The writes below jump from bin to bin; see TouchPages().
    TouchPages(this->Grid.X, begin, begin + count, between);
    TouchPages(this->Grid.Y, begin, begin + count, between);
    TouchPages(this->Grid.Ids, begin, begin + count, between);
    this->ForEach(count, stages.Next(), [&](Index i) {
      const Index slot = starts[placed[i].Bin + 1]++;
      this->Local.X[slot] = placed[i].X;
      this->Local.Y[slot] = placed[i].Y;
      this->Local.Ids[slot] = placed[i].Id;
    });
  }

  /** Sets the order of each row by (y, x), and the range of its y. */
  void SortRows(const Progress& progress)
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    Progress inSort;
    RowSorter sorter(this->Local, this->Filled.Points, inSort);
    for (Index row = 0; row < this->Rows; ++row)
    {
      const auto slots = this->Local.Slots(row, 0, bins.Columns - 1);
      double& lowest = this->Grid.RowLow[this->Filled.FirstRow + row] = DBL_MAX;
      double& highest = this->Grid.RowHigh[this->Filled.FirstRow + row] = -DBL_MAX;
      if (slots.first < slots.second)
      {
        const double done = static_cast<double>(row) / this->Rows;
        inSort = progress.Between(done, done);
        // About the row's range: a point rounded into the row from beyond is only sorted more
        // slowly.
        const double low = bins.OriginY + (this->Filled.FirstRow + row) * bins.BinHeight;
        sorter.Sort(slots, low, low + bins.BinHeight, this->Order + slots.first);
        lowest = this->Local.Y[this->Order[slots.first]];
        highest = this->Local.Y[this->Order[slots.second - 1]];
      }
    }
  }

  /**
   * In the order of rows, equal points are adjacent. The slot that stays is the first one; the id
   * that the policy prefers moves there.
   */
  void SetDuplicatesAside(const PointView& points, DuplicatePolicy policy, const Progress& progress)
  {
    const BoxTree::Rows& local = this->Local;
    Index kept = 0;
    this->ForEach(this->Filled.Count, progress, [&](Index i) {
      // Compared with the last one that is kept, so any number of equal points become one.
      const Index first = this->Order[kept], slot = this->Order[i];
      if (local.Y[first] != local.Y[slot] || local.X[first] != local.X[slot])
      {
        kept = i;
      }
      else if (i > kept)
      {
        if (IsPreferred(points, policy, local.Ids[slot], local.Ids[first]))
        {
          std::swap(local.Ids[slot], local.Ids[first]);
        }
        // Allocated with the first duplicate: most clouds have none.
        this->IsAside.resize(this->Filled.Count, false);
        this->IsAside[slot] = true;
        this->Filled.Duplicates.Append(local.Ids[slot]);
      }
    });
  }

  /**
   * Moves slots together where duplicates have been set aside, and changes all that names slots.
   */
  void CloseGaps(const Progress& progress)
  {
    Stages stages(progress, { 40, 60, 0 });
    // Slots move down by the number of gaps before them; so do starts, order and leaves, which name
    // slots.
    Buffer<Index> moved; // the number of slots kept before each
    moved.Resize(static_cast<std::size_t>(this->Filled.Count) + 1);
    Index kept = 0;
    this->ForEach(this->Filled.Count, stages.Next(), [&](Index slot) {
      moved[slot] = kept;
      if (!this->IsAside[slot])
      {
        this->Local.X[kept] = this->Local.X[slot];
        this->Local.Y[kept] = this->Local.Y[slot];
        this->Local.Ids[kept] = this->Local.Ids[slot];
        ++kept;
      }
    });
    moved[this->Filled.Count] = kept;
    Index ordered = 0;
    this->ForEach(this->Filled.Count, stages.Next(), [&](Index i) {
      if (!this->IsAside[this->Order[i]])
      {
        this->Order[ordered++] = moved[this->Order[i]];
      }
    });
    Index* const starts = this->Local.Starts.data();
    this->ForEach(
      this->Bins + 1, stages.Next(), [&](Index bin) { starts[bin] = moved[starts[bin]]; });
    const auto move = [&](Index& first, Index& count) {
      if (count > 0)
      {
        // Not 0, which would make a node of it: equal points share a leaf, and one of them stays.
        count = moved[first + count] - moved[first];
        first = moved[first];
      }
    };
    for (Node& node : this->Filled.Nodes)
    {
      for (int place = 0; place < Node::Places; ++place)
      {
        move(node.First[place], node.Count[place]);
      }
    }
    move(this->Filled.Root.First, this->Filled.Root.Count);
    this->Filled.Count = kept;
  }

  BinGrid& Grid;
  GridBlock& Filled;
  const Index Rows;
  const std::size_t Bins;
  Index* const Order;
  BoxTree::Rows Local;
  std::vector<bool> IsAside; ///< by slot; empty while there are no duplicates
};
} // namespace

void GridBlock::Fill(
  const PointView& points, DuplicatePolicy policy, const Progress& progress, BinGrid& grid)
{
  BlockFiller(grid, *this).Run(points, policy, progress);
}

} // namespace elevation
