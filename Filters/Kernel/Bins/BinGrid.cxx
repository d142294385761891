// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BinGrid.h"

#include "GridBlock.h"
#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numeric>

namespace elevation
{
namespace
{
using Node = BoxTree::Node;

// Three divisions of the points meet here, so the words mean here: a range is a stretch of the
// input; a group is eight rows or more; a block is some consecutive groups with about as many
// points as a core's cache holds. Ranges are read in parallel, blocks are filled in parallel.

// The mean: with fewer, searches visit many empty bins; with more, they look at points in vain.
constexpr double PointsPerBin = 1.0;
// The input is read in ranges of this many points, each by one thread.
constexpr Index RangePoints = 1 << 17;
// Blocks consist of groups of rows, at most this many in all.
constexpr Index MaximumGroups = 4096;

/** Chooses the numbers of bins along both sides of a box; bins are as square as possible. */
void ChooseBins(BinGrid::Layout& bins, double width, double height, Index count)
{
  // Bins are wanted per point, whatever the points' distribution: the tree serves uneven ones.
  const double number = std::max(1.0, count / PointsPerBin);
  // A box without height is a row, one without width a column; the quotient may be 0 or infinite.
  const double proportion = width > 0.0 ? (height > 0.0 ? width / height : DBL_MAX) : 0.0;
  const double columns =
    // At most number: a flat box gets one row of bins, of one point each in the mean.
    std::min(std::max(1.0, std::floor(std::sqrt(number * proportion))), number);
  bins.Columns = static_cast<Index>(columns);
  bins.Rows = height > 0.0 ? static_cast<Index>(std::max(1.0, std::floor(number / columns))) : 1;
  bins.PerX = width > 0.0 ? std::min(bins.Columns / width, DBL_MAX) : 0.0;
  bins.PerY = height > 0.0 ? std::min(bins.Rows / height, DBL_MAX) : 0.0;
  bins.BinWidth = width / bins.Columns;
  bins.BinHeight = height / bins.Rows;
  // Rounding errors of a few 1e-16 of the coordinates are then below a thousandth of a bin.
  const auto isPlain = [](double bin, double low, double extent) {
    return bin > 1e-12 && bin < 1e12 && bin > 1e-12 * (std::fabs(low) + extent);
  };
  bins.HasPlainBins =
    isPlain(bins.BinWidth, bins.OriginX, width) && isPlain(bins.BinHeight, bins.OriginY, height);
}

// The passes, in the order of Run(). All depend on the points alone, none on the number of threads.
class GridBuilder
{
public:
  GridBuilder(BinGrid& grid, const PointView& points, DuplicatePolicy policy, int threads)
    : Grid(grid)
    , Points(points)
    , Policy(policy)
    , Threads(threads)
    , Count(points.Count - static_cast<Index>(grid.NotFinite.size()))
  {
  }

  void Run(const Box& extent, const Progress& progress)
  {
    if (this->Count == 0)
    {
      this->Grid.Starts.Append(0);
      return;
    }
    Stages stages(progress, { 9, 17, 61, 0, 13 });
    this->Lay(extent);
    this->CountInGroups(stages.Next());
    // From counts: blocks are known before a point is moved.
    this->MakeBlocks();
    this->SortIntoBlocks(stages.Next());
    this->FillBlocks(stages.Next());
    this->CloseGaps(stages.Next());
    this->Join(stages.Next());
  }

private:
  /** Calls visit(id, x, y), scaled, for the finite points of a range. */
  template <typename Visit>
  void ForEach(Index begin, Index end, Visit&& visit) const
  {
    const double scale = this->Grid.Scale;
    ForEachPoint(this->Points, begin, end, this->Grid.NotFinite,
      [&](Index id, const Point2& p) { visit(id, p.X * scale, p.Y * scale); });
  }

  /** Lays out the bins, and chooses a scale where coordinates are extreme. */
  void Lay(const Box& extent)
  {
    const Point2 &low = extent.Low, &high = extent.High;
    // Squares, and products of four coordinates, stay within doubles from 1e-60 to 1e60.
    const double greatest = std::max(
      std::max(std::fabs(low.X), std::fabs(high.X)), std::max(std::fabs(low.Y), std::fabs(high.Y)));
    if (greatest > 1e60 || (greatest > 0.0 && greatest < 1e-60))
    {
      this->ChooseScale(greatest);
    }
    const double scale = this->Grid.Scale;
    // Everything below is in scaled coordinates; only ids lead back to the input.
    this->Grid.Bins.OriginX = low.X * scale;
    this->Grid.Bins.OriginY = low.Y * scale;
    ChooseBins(
      this->Grid.Bins, high.X * scale - low.X * scale, high.Y * scale - low.Y * scale, this->Count);
  }

  /** Scales by the greatest magnitude, unless a small coordinate would lose bits. */
  void ChooseScale(double greatest)
  {
    double least = DBL_MAX; // least magnitude above zero
    this->ForEach(0, this->Points.Count, [&](Index, double x, double y) {
      for (double magnitude : { std::fabs(x), std::fabs(y) })
      {
        least = magnitude > 0.0 ? std::min(least, magnitude) : least;
      }
    });
    // A power of two: the product is exact, unless it becomes subnormal and loses bits.
    int exponent;
    std::frexp(greatest, &exponent);
    // The factor itself must not overflow.
    const double scale = exponent < -1000 ? std::ldexp(1.0, 1000) : std::ldexp(1.0, -exponent);
    if (least * scale > DBL_MIN / DBL_EPSILON)
    {
      this->Grid.Scale = scale;
    }
  }

  /** Counts the points of each range of the input in each group of rows. */
  void CountInGroups(const Progress& progress)
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    this->Shift = 3; // the tree's lowest nodes are of eight rows
    // So that the table of counts, range by group, stays small.
    while (bins.Rows >> this->Shift > MaximumGroups)
    {
      ++this->Shift;
    }
    const int shift = this->Shift;
    this->Groups = ((bins.Rows - 1) >> shift) + 1;
    this->Ranges = NumberOfRanges(this->Points.Count, RangePoints);
    this->InGroup.assign(this->Ranges * this->Groups, 0);
    // A little more, which no page is used for: room for triangles that a piece gets from others,
    // as this memory will be that of the triangles.
    this->Memory.Reserve(static_cast<std::size_t>(this->Count) + this->Count / 64);
    this->Memory.Resize(this->Count);
    ForEachRange(
      this->Points.Count, this->Threads, progress,
      [&](Index range, Index begin, Index end) {
        Index* const counts = this->InGroup.data() + static_cast<std::size_t>(range) * this->Groups;
        // Only rows matter here: blocks are of whole rows.
        this->ForEach(begin, end, [&](Index, double, double y) { ++counts[bins.Row(y) >> shift]; });
        TouchPages(this->Memory, begin, end);
      },
      RangePoints);
  }

  /** Joins groups to blocks of about equal numbers of points. */
  void MakeBlocks()
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    this->BlockOf.resize(this->Groups);
    Index sum = 0;
    for (Index group = 0; group < this->Groups; ++group)
    {
      // The first row of the group.
      const Index row = group << this->Shift;
      // A block ends when it has enough points, or enough bins: its bins must fit into the cache,
      // too.
      if (this->Blocks.empty() || this->Blocks.back().Count >= GridBlock::UsualPoints ||
        (row - this->Blocks.back().FirstRow) * static_cast<double>(bins.Columns) >=
          GridBlock::UsualPoints)
      {
        this->Blocks.emplace_back();
        this->Blocks.back().FirstRow = row;
        this->Blocks.back().Begin = sum;
        this->Blocks.back().Count = 0;
        this->Blocks.back().Points = this->Memory.data() + sum;
      }
      GridBlock& block = this->Blocks.back();
      block.EndRow = std::min((group + 1) << this->Shift, bins.Rows);
      for (std::size_t range = 0; range < this->Ranges; ++range)
      {
        block.Count += this->InGroup[range * this->Groups + group];
      }
      sum = block.Begin + block.Count;
      this->BlockOf[group] = static_cast<Index>(this->Blocks.size()) - 1;
    }
  }

  /**
   * Where the points of each (range, block) begin, block by block for each range. As of a counting
   * sort with the ranges as threads: within a block, the points of earlier ranges come first, so
   * they stay in the order of ids.
   */
  std::vector<Index> BeginsInBlocks() const
  {
    const std::size_t blocks = this->Blocks.size();
    std::vector<Index> begins(this->Ranges * blocks, 0);
    for (std::size_t range = 0; range < this->Ranges; ++range)
    {
      for (Index group = 0; group < this->Groups; ++group)
      {
        begins[range * blocks + this->BlockOf[group]] +=
          this->InGroup[range * this->Groups + group];
      }
    }
    for (std::size_t i = 0; i < blocks; ++i)
    {
      Index at = this->Blocks[i].Begin;
      for (std::size_t k = i; k < begins.size(); k += blocks)
      {
        at += std::exchange(begins[k], at);
      }
    }
    return begins;
  }

  /** Copies each point to the memory of its block, with its bin there. */
  void SortIntoBlocks(const Progress& progress)
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    const std::vector<GridBlock>& blocks = this->Blocks;
    std::vector<Index> next = this->BeginsInBlocks();
    ForEachRange(
      this->Points.Count, this->Threads, progress,
      [&](Index range, Index begin, Index end) {
        Index* const to = next.data() + static_cast<std::size_t>(range) * blocks.size();
        this->ForEach(begin, end, [&](Index id, double x, double y) {
          const Index row = bins.Row(y);
          // Each range of the input writes its own stretch of each block, so threads need no locks.
          const Index block = this->BlockOf[row >> this->Shift];
          const Index bin = (row - blocks[block].FirstRow) * bins.Columns + bins.Column(x);
          // With the bin, so that it is not computed again.
          this->Memory[to[block]++] = { x, y, id, bin };
        });
      },
      RangePoints);
  }

  /** Fills the blocks in parallel, each into its slots of the grid. */
  void FillBlocks(const Progress& progress)
  {
    const std::size_t count = this->Count;
    const BinGrid::Layout& bins = this->Grid.Bins;
    // Wide instructions read up to eight values beyond the last slot.
    this->Grid.X.Reserve(count + 8);
    this->Grid.Y.Reserve(count + 8);
    this->Resize(this->Count);
    this->Grid.Starts.Resize(static_cast<std::size_t>(bins.Columns) * bins.Rows + 1);
    this->Grid.RowLow.Resize(bins.Rows);
    this->Grid.RowHigh.Resize(bins.Rows);

    // The few large blocks come last, and report their own progress. Where density is uneven, a
    // block may hold most of the points: one row cannot be divided.
    const auto isLarge = [&bins](const GridBlock& block) { return block.Tasks(bins) > 1; };
    const double large = std::accumulate(this->Blocks.begin(), this->Blocks.end(), 0.0,
      [&](double points, const GridBlock& block) { return points + isLarge(block) * block.Count; });
    double done = 1.0 - large / count;
    const auto fill = [&](GridBlock& block, const Progress& inBlock) {
      block.Fill(this->Points, this->Policy, inBlock, this->Grid);
    };
    ForEachTask(static_cast<Index>(this->Blocks.size()), this->Threads, progress.Between(0.0, done),
      [&](Index i) {
        if (!isLarge(this->Blocks[i]))
        {
          fill(this->Blocks[i], Progress());
        }
      });
    for (GridBlock& block : this->Blocks)
    {
      if (isLarge(block))
      {
        const double begin = done;
        done = std::min(1.0, done + static_cast<double>(block.Count) / count);
        fill(block, progress.Between(begin, done));
      }
    }
    // Growth writes its triangles there.
    this->Grid.Scratch.Recycle(std::move(this->Memory));
  }

  void Resize(Index slots)
  {
    this->Grid.X.Resize(slots);
    this->Grid.Y.Resize(slots);
    this->Grid.Ids.Resize(slots);
    this->Grid.Order.Resize(slots);
  }

  /** Moves the blocks' slots together, and lists the duplicates. */
  void CloseGaps(const Progress& progress)
  {
    IdSet duplicates(this->Points.Count);
    std::size_t listed = 0;
    Index slots = 0;
    for (GridBlock& block : this->Blocks)
    {
      // Downwards only, so each block may be moved before the next one is read.
      const auto move = [&](auto& values) {
        CountWork(static_cast<std::size_t>(block.Count));
        std::copy_n(values.begin() + block.Begin, block.Count, values.begin() + slots);
        Report(progress, 0.0);
      };
      if (block.Begin != slots)
      {
        move(this->Grid.X);
        move(this->Grid.Y);
        move(this->Grid.Ids);
        move(this->Grid.Order);
      }
      block.Begin = slots;
      slots += block.Count;
      for (const Index id : Counted(block.Duplicates))
      {
        ReportStep(progress, listed++, 1);
        duplicates.Add(id);
      }
    }
    this->Grid.Duplicates = duplicates.List(progress);
    this->Resize(slots);
    this->Grid.Starts[this->Grid.Starts.size() - 1] = slots;
  }

  /** Joins the starts, order and trees of the blocks to those of the grid. */
  void Join(const Progress& progress)
  {
    std::vector<Index> firstNodes, tasks(1, 0); // a large block has several tasks
    std::vector<BoxTree::Child> roots;
    Index nodes = 0;
    for (const GridBlock& block : this->Blocks)
    {
      if (block.Count > 0)
      {
        // A block's root is a leaf, a slot of the block, or a node, one of the block's.
        roots.push_back(block.Root);
        roots.back().First += block.Root.Count > 0 ? block.Begin : nodes;
      }
      firstNodes.push_back(nodes);
      nodes += static_cast<Index>(block.Nodes.size());
      tasks.push_back(tasks.back() + block.Tasks(this->Grid.Bins));
    }
    this->Grid.Tree.Nodes.Reserve(nodes + this->Blocks.size());
    this->Grid.Tree.Nodes.Resize(nodes);
    ForEachTask(tasks.back(), this->Threads, progress, [&](Index task) {
      const std::size_t i = std::upper_bound(tasks.begin(), tasks.end(), task) - tasks.begin() - 1;
      this->JoinTask(this->Blocks[i], firstNodes[i], task - tasks[i], tasks[i + 1] - tasks[i]);
    });
    this->Grid.Tree.Join(std::move(roots), this->Grid.NumberOfPoints(), progress);
  }

  /**
   * One of several tasks for a block's bins, slots and nodes: only large blocks have more than one.
   */
  void JoinTask(GridBlock& block, Index firstNode, std::size_t task, std::size_t tasks)
  {
    const auto forEach = [&](std::size_t count, auto&& work) {
      const std::size_t end = count * (task + 1) / tasks;
      std::size_t k = count * task / tasks;
      CountWork(end - k);
      for (; k < end; ++k)
      {
        work(k);
      }
    };
    const std::size_t columns = this->Grid.Bins.Columns;
    const Index begin = block.Begin;
    // What blocks count from their own first bin, slot and node becomes a number in the grid.
    Index* const starts = this->Grid.Starts.data() + block.FirstRow * columns;
    forEach(
      (block.EndRow - block.FirstRow) * columns, [&](std::size_t bin) { starts[bin] += begin; });
    Index* const order = this->Grid.Order.data() + begin;
    forEach(block.Count, [&](std::size_t slot) { order[slot] += begin; });
    forEach(block.Nodes.size(), [&](std::size_t k) {
      Node& node = this->Grid.Tree.Nodes[firstNode + k] = block.Nodes[k];
      for (int place = 0; place < Node::Places; ++place)
      {
        if (node.First[place] != None)
        {
          node.First[place] += node.Count[place] > 0 ? begin : firstNode;
        }
      }
    });
    if (tasks == 1)
    {
      block.Nodes = Buffer<Node>();
    }
  }

  BinGrid& Grid;
  const PointView& Points;
  const DuplicatePolicy Policy;
  const int Threads;
  const Index Count; ///< of the finite points
  int Shift = 0;     ///< a group is 1 << Shift rows
  Index Groups = 0;
  std::size_t Ranges = 0;     ///< of the input
  std::vector<Index> InGroup; ///< range by range, the number of points in each group
  std::vector<Index> BlockOf; ///< one per group
  Buffer<BoxTree::Placed> Memory; ///< the points, block by block
  std::vector<GridBlock> Blocks;
};
} // namespace

BinGrid::BinGrid(const PointView& points, DuplicatePolicy policy, const Progress& progress,
  int threads, Extent* known)
{
  Stages stages(progress, { 20, 80 });
  const Progress looking = stages.Next();
  // A search for a lattice has found the extent already.
  const auto look = [&]() {
    return FindExtent(points, threads, looking, [](Index, const Point2&) {});
  };
  Extent extent = known ? std::move(*known) : look();
  this->NotFinite = std::move(extent.NotFinite);
  GridBuilder(*this, points, policy, threads).Run(extent, stages.Next());
}

} // namespace elevation
