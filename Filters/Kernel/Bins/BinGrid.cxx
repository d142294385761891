// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BinGrid.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numeric>

namespace elevation
{
namespace
{
using Placed = BoxTree::Placed;
using Node = BoxTree::Node;

// The mean: with fewer, searches visit many empty bins; with more, they look at points in vain.
constexpr double PointsPerBin = 1.0;
// The input is read in pieces of this many points, each by one thread.
constexpr Index PiecePoints = 1 << 17;
// A block of rows has about this many points, so that it fits into a core's cache.
constexpr Index BlockPoints = 1 << 14;
// Blocks consist of groups of rows, at most this many in all.
constexpr Index MaximumGroups = 4096;

/** Chooses the numbers of bins along both sides of a box; bins are as square as possible. */
void ChooseBins(BinGrid::Layout& bins, double width, double height, Index count)
{
  const double number = std::max(1.0, count / PointsPerBin);
  // A box without height is a row, one without width a column; the quotient may be 0 or infinite.
  const double proportion = width > 0.0 ? (height > 0.0 ? width / height : DBL_MAX) : 0.0;
  const double columns =
    std::min(std::max(1.0, std::floor(std::sqrt(number * proportion))), number);
  bins.Columns = static_cast<Index>(columns);
  bins.Rows = height > 0.0 ? static_cast<Index>(std::max(1.0, std::floor(number / columns))) : 1;
  bins.PerX = width > 0.0 ? std::min(bins.Columns / width, DBL_MAX) : 0.0;
  bins.PerY = height > 0.0 ? std::min(bins.Rows / height, DBL_MAX) : 0.0;
  bins.BinWidth = width / bins.Columns;
  bins.BinHeight = height / bins.Rows;
  const auto isPlain = [](double bin, double low, double extent) {
    return bin > 1e-12 && bin < 1e12 && bin > 1e-12 * (std::fabs(low) + extent);
  };
  bins.HasPlainBins =
    isPlain(bins.BinWidth, bins.OriginX, width) && isPlain(bins.BinHeight, bins.OriginY, height);
}

/**
 * Sorts the slots of a row by (y, x): a bucket sort over the row's height, finished by insertion in
 * linear time. Full buckets are sorted in the same way, or, below a few levels, by comparison.
 */
class RowSorter
{
public:
  /** @param room  for as many points as the rows hold */
  RowSorter(const BoxTree::Rows& rows, Placed* room, const Progress& progress)
    : Grid(rows)
    , Entries(static_cast<Entry*>(static_cast<void*>(room)))
    , Monitor(progress)
  {
  }

  /**
   * @param[in]  low,high  about the range of y of the row
   * @param[out] order     room for the slots of the row
   */
  void Sort(std::pair<Index, Index> slots, double low, double high, Index* order)
  {
    const double* const y = this->Grid.Y + slots.first;
    const Index count = slots.second - slots.first, first = slots.first;
    static_assert(sizeof(Entry) + sizeof(Index) <= sizeof(Placed), "there is room for both");
    Index* const room = static_cast<Index*>(static_cast<void*>(this->Entries + count));
    this->Sort(
      [=](Index i) {
        return Entry{ y[i], first + i };
      },
      this->Entries, room, count, low, high, 0);
    this->ForEach(0, count, [&](Index i) { order[i] = this->Entries[i].Slot; });
  }

private:
  static constexpr Index Few = 16;
  static constexpr int MaximumDepth = 3;

  struct Entry
  {
    double Y;
    Index Slot;
  };

  /** Not a lambda, which would be a new type, and instantiate Sort() again, at every depth. */
  struct Listed
  {
    const Index* Slots;
    const double* Y;

    Entry operator()(Index i) const { return { this->Y[this->Slots[i]], this->Slots[i] }; }
  };

  bool IsBefore(const Entry& p, const Entry& q) const
  {
    return p.Y < q.Y || (p.Y == q.Y && this->Grid.X[p.Slot] < this->Grid.X[q.Slot]);
  }

  template <typename Work>
  void ForEach(Index begin, Index end, Work&& work) const
  {
    ForEachReporting(
      begin, end, [this](double) { Report(this->Monitor, 0.0); }, work);
  }

  void Insert(Entry* entries, Index count) const
  {
    this->ForEach(1, count, [&](Index i) {
      const Entry entry = entries[i];
      Index at = i;
      for (; at > 0 && this->IsBefore(entry, entries[at - 1]); --at)
      {
        entries[at] = entries[at - 1];
      }
      entries[at] = entry;
    });
  }

  /**
   * Sorts the entries that get(0) to get(count - 1) return.
   * @param[out] sorted  room for them; get() must not read it
   * @param[in]  room    for as many slots; get() may read it
   */
  template <typename Get>
  void Sort(
    const Get& get, Entry* sorted, Index* room, Index count, double low, double high, int depth)
  {
    const double last = count - 1;
    const double perHeight = last / (high - low);
    if (count <= Few || depth > MaximumDepth || !(perHeight > 0.0 && perHeight <= DBL_MAX))
    {
      this->ForEach(0, count, [&](Index i) { sorted[i] = get(i); });
      if (count <= Few)
      {
        return this->Insert(sorted, count);
      }
      return elevation::Sort(
        sorted, sorted + count,
        [this](const Entry& p, const Entry& q) { return this->IsBefore(p, q); }, this->Monitor);
    }
    const auto bucketOf = [=](const Entry& p) {
      return static_cast<Index>(std::max(0.0, std::min(last, (p.Y - low) * perHeight)));
    };
    Buffer<Index>& ends = this->Ends[depth];
    ends.Resize(static_cast<std::size_t>(count) + 1);
    this->ForEach(0, count + 1, [&](Index i) { ends[i] = 0; });
    this->ForEach(0, count, [&](Index i) { ++ends[bucketOf(get(i)) + 1]; });
    Index fullest = 0;
    this->ForEach(0, count, [&](Index bucket) {
      fullest = std::max(fullest, ends[bucket + 1]);
      ends[bucket + 1] += ends[bucket];
    });
    this->ForEach(0, count, [&](Index i) {
      const Entry entry = get(i);
      sorted[ends[bucketOf(entry)]++] = entry;
    });
    Index reported = 0;
    for (Index begin = 0, bucket = 0; fullest > Few && begin < count; begin = ends[bucket++])
    {
      if (begin - reported > 65536)
      {
        Report(this->Monitor, 0.0);
        reported = begin;
      }
      const Index size = ends[bucket] - begin;
      if (size > Few)
      {
        double lowest = DBL_MAX, highest = -DBL_MAX;
        this->ForEach(begin, begin + size, [&](Index i) {
          const double y = sorted[i].Y;
          lowest = y < lowest ? y : lowest;
          highest = y > highest ? y : highest;
        });
        Index* const from = room + begin;
        this->ForEach(0, size, [&](Index i) { from[i] = sorted[begin + i].Slot; });
        this->Sort(
          Listed{ from, this->Grid.Y }, sorted + begin, from, size, lowest, highest, depth + 1);
      }
    }
    this->Insert(sorted, count);
  }

  const BoxTree::Rows& Grid;
  Entry* const Entries;
  const Progress& Monitor;
  Buffer<Index> Ends[MaximumDepth + 1];
};

/** Rows of bins that one thread fills, with their points in its cache. */
struct Block
{
  Index FirstRow, EndRow;
  Index Begin, Count; ///< slots
  Placed* Points;     ///< first its points, then room for as many
  BoxTree::Child Root;
  Buffer<Node> Nodes; ///< children and slots counted from the block's first
  Buffer<Index> Duplicates;

  /** The number of pieces for work on all bins or points, so that reports come soon enough. */
  Index Pieces(const BinGrid::Layout& layout) const
  {
    const Index bins = (this->EndRow - this->FirstRow) * layout.Columns; // at most as all points
    return 1 + std::max(this->Count, bins) / (16 * BlockPoints);
  }
};

/** Fills the slots of a block. */
class BlockFiller
{
public:
  BlockFiller(BinGrid& grid, Block& block, const Progress& progress)
    : Grid(grid)
    , Own(block)
    , Monitor(progress)
    , Rows(block.EndRow - block.FirstRow)
    , Bins(static_cast<std::size_t>(this->Rows) * grid.Bins.Columns)
    , Order(grid.Order.data() + block.Begin)
    , Local{ grid.X.data() + block.Begin, grid.Y.data() + block.Begin,
      grid.Ids.data() + block.Begin, Buffer<Index>(), grid.Bins.Columns }
  {
  }

  void Run(const PointView& points, DuplicatePolicy policy)
  {
    this->SortIntoBins();
    if (this->Own.Pieces(this->Grid.Bins) > 1)
    {
      this->Own.Nodes.Reserve(
        this->Own.Count / 48); // growing it takes long
    }
    this->Own.Root = BoxTree::Build(this->Local, this->Rows, this->Own.Points, this->Own.Nodes,
      SubProgress(this->Monitor, 0.1, 0.6));
    this->SortRows();
    this->SetDuplicatesAside(points, policy);
    if (!this->Own.Duplicates.empty())
    {
      this->CloseGaps();
    }
    const Index* const starts = this->Local.Starts.data();
    Index* const to = this->Grid.Starts.data() +
      static_cast<std::size_t>(this->Own.FirstRow) * this->Grid.Bins.Columns;
    this->ForEach(this->Bins, 1.0, 1.0, [&](Index bin) { to[bin] = starts[bin]; });
  }

private:
  /** Calls visit(0) to visit(count - 1), and reports fractions between from and to. */
  template <typename Visit>
  void ForEach(std::size_t count, double from, double to, Visit&& visit) const
  {
    const auto report = [&](double fraction) {
      Report(this->Monitor, from + fraction * (to - from));
    };
    report(0.0);
    ForEachReporting(0, static_cast<Index>(count), report, visit);
  }

  /**
   * Counting sort. While filling, starts[b + 1] runs from the first slot of bin b to its end, which
   * is the first slot of the next bin.
   */
  void SortIntoBins()
  {
    const Placed* const placed = this->Own.Points;
    const Index begin = this->Own.Begin, count = this->Own.Count;
    this->Local.Starts.Resize(this->Bins + 1);
    Index* const starts = this->Local.Starts.data();
    this->ForEach(this->Bins + 1, 0.0, 0.0, [&](Index bin) { starts[bin] = 0; });
    this->ForEach(count, 0.0, 0.05, [&](Index i) { ++starts[placed[i].Bin + 1]; });
    Index sum = 0;
    this->ForEach(
      this->Bins, 0.05, 0.05, [&](Index bin) { sum += std::exchange(starts[bin + 1], sum); });
    const Progress here = SubProgress(this->Monitor, 0.05, 0.05);
    TouchPages(this->Grid.X, begin, begin + count, here);
    TouchPages(this->Grid.Y, begin, begin + count, here);
    TouchPages(this->Grid.Ids, begin, begin + count, here);
    this->ForEach(count, 0.05, 0.1, [&](Index i) {
      const Index slot = starts[placed[i].Bin + 1]++;
      this->Local.X[slot] = placed[i].X;
      this->Local.Y[slot] = placed[i].Y;
      this->Local.Ids[slot] = placed[i].Id;
    });
  }

  void SortRows()
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    Progress inSort;
    RowSorter sorter(this->Local, this->Own.Points, inSort);
    for (Index row = 0; row < this->Rows; ++row)
    {
      const auto slots = this->Local.Slots(row, 0, bins.Columns - 1);
      double& lowest = this->Grid.RowLow[this->Own.FirstRow + row] = DBL_MAX;
      double& highest = this->Grid.RowHigh[this->Own.FirstRow + row] = -DBL_MAX;
      if (slots.first < slots.second)
      {
        const double done = 0.6 + 0.3 * row / this->Rows;
        inSort = SubProgress(this->Monitor, done, done);
        const double low = bins.OriginY + (this->Own.FirstRow + row) * bins.BinHeight;
        sorter.Sort(slots, low, low + bins.BinHeight, this->Order + slots.first);
        lowest = this->Local.Y[this->Order[slots.first]];
        highest = this->Local.Y[this->Order[slots.second - 1]];
      }
    }
  }

  /** In the order of rows, equal points are adjacent. */
  void SetDuplicatesAside(const PointView& points, DuplicatePolicy policy)
  {
    const BoxTree::Rows& local = this->Local;
    Index kept = 0;
    this->ForEach(this->Own.Count, 0.9, 0.95, [&](Index i) {
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
        this->IsAside.resize(this->Own.Count, false);
        this->IsAside[slot] = true;
        this->Own.Duplicates.Append(local.Ids[slot]);
      }
    });
  }

  void CloseGaps()
  {
    Buffer<Index> moved; // the number of slots kept before each
    moved.Resize(static_cast<std::size_t>(this->Own.Count) + 1);
    Index kept = 0;
    this->ForEach(this->Own.Count, 0.95, 0.97, [&](Index slot) {
      moved[slot] = kept;
      if (!this->IsAside[slot])
      {
        this->Local.X[kept] = this->Local.X[slot];
        this->Local.Y[kept] = this->Local.Y[slot];
        this->Local.Ids[kept] = this->Local.Ids[slot];
        ++kept;
      }
    });
    moved[this->Own.Count] = kept;
    Index ordered = 0;
    this->ForEach(this->Own.Count, 0.97, 1.0, [&](Index i) {
      if (!this->IsAside[this->Order[i]])
      {
        this->Order[ordered++] = moved[this->Order[i]];
      }
    });
    Index* const starts = this->Local.Starts.data();
    this->ForEach(this->Bins + 1, 1.0, 1.0, [&](Index bin) { starts[bin] = moved[starts[bin]]; });
    const auto move = [&](Index& first, Index& count) {
      if (count > 0)
      {
        count = moved[first + count] - moved[first];
        first = moved[first];
      }
    };
    for (Node& node : this->Own.Nodes)
    {
      for (int place = 0; place < Node::Places; ++place)
      {
        move(node.First[place], node.Count[place]);
      }
    }
    move(this->Own.Root.First, this->Own.Root.Count);
    this->Own.Count = kept;
  }

  BinGrid& Grid;
  Block& Own;
  const Progress& Monitor;
  const Index Rows;
  const std::size_t Bins;
  Index* const Order;
  BoxTree::Rows Local;
  std::vector<bool> IsAside; ///< by slot; empty while there are no duplicates
};

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
    this->Lay(extent);
    const Progress filling = SubProgress(progress, 0.0, 0.875);
    this->CountInGroups(SubProgress(filling, 0.0, 0.1));
    this->MakeBlocks();
    this->SortIntoBlocks(SubProgress(filling, 0.1, 0.3));
    this->FillBlocks(SubProgress(filling, 0.3, 1.0));
    const Progress joining = SubProgress(progress, 0.875, 1.0);
    this->CloseGaps(SubProgress(joining, 0.0, 0.0));
    this->Join(joining);
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

  void Lay(const Box& extent)
  {
    const Point2 &low = extent.Low, &high = extent.High;
    const double greatest = std::max(
      std::max(std::fabs(low.X), std::fabs(high.X)), std::max(std::fabs(low.Y), std::fabs(high.Y)));
    if (greatest > 1e60 || (greatest > 0.0 && greatest < 1e-60))
    {
      this->ChooseScale(greatest);
    }
    const double scale = this->Grid.Scale;
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
    int exponent;
    std::frexp(greatest, &exponent);
    // The factor itself must not overflow.
    const double scale = exponent < -1000 ? std::ldexp(1.0, 1000) : std::ldexp(1.0, -exponent);
    if (least * scale > DBL_MIN / DBL_EPSILON)
    {
      this->Grid.Scale = scale;
    }
  }

  /** Counts the points of each piece of the input in each group of rows. */
  void CountInGroups(const Progress& progress)
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    this->Shift = 3; // the tree's lowest nodes are of eight rows
    while (bins.Rows >> this->Shift > MaximumGroups)
    {
      ++this->Shift;
    }
    const int shift = this->Shift;
    this->Groups = ((bins.Rows - 1) >> shift) + 1;
    this->Pieces = NumberOfRanges(this->Points.Count, PiecePoints);
    this->InGroup.assign(this->Pieces * this->Groups, 0);
    this->Memory.Resize(this->Count);
    ForEachRange(
      this->Points.Count, this->Threads, progress,
      [&](Index piece, Index begin, Index end) {
        Index* const counts = this->InGroup.data() + static_cast<std::size_t>(piece) * this->Groups;
        this->ForEach(begin, end, [&](Index, double, double y) { ++counts[bins.Row(y) >> shift]; });
        TouchPages(this->Memory, begin, end);
      },
      PiecePoints);
  }

  /** Joins groups to blocks of about equal numbers of points. */
  void MakeBlocks()
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    this->BlockOf.resize(this->Groups);
    Index sum = 0;
    for (Index group = 0; group < this->Groups; ++group)
    {
      const Index row = group << this->Shift;
      if (this->Blocks.empty() || this->Blocks.back().Count >= BlockPoints ||
        (row - this->Blocks.back().FirstRow) * static_cast<double>(bins.Columns) >= BlockPoints)
      {
        this->Blocks.emplace_back();
        this->Blocks.back().FirstRow = row;
        this->Blocks.back().Begin = sum;
        this->Blocks.back().Count = 0;
        this->Blocks.back().Points = this->Memory.data() + sum;
      }
      Block& block = this->Blocks.back();
      block.EndRow = std::min((group + 1) << this->Shift, bins.Rows);
      for (std::size_t piece = 0; piece < this->Pieces; ++piece)
      {
        block.Count += this->InGroup[piece * this->Groups + group];
      }
      sum = block.Begin + block.Count;
      this->BlockOf[group] = static_cast<Index>(this->Blocks.size()) - 1;
    }
  }

  /** Where the points of each (piece, block) begin, block by block for each piece. */
  std::vector<Index> BeginsInBlocks() const
  {
    const std::size_t blocks = this->Blocks.size();
    std::vector<Index> begins(this->Pieces * blocks, 0);
    for (std::size_t piece = 0; piece < this->Pieces; ++piece)
    {
      for (Index group = 0; group < this->Groups; ++group)
      {
        begins[piece * blocks + this->BlockOf[group]] +=
          this->InGroup[piece * this->Groups + group];
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

  void SortIntoBlocks(const Progress& progress)
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    const std::vector<Block>& blocks = this->Blocks;
    std::vector<Index> next = this->BeginsInBlocks();
    ForEachRange(
      this->Points.Count, this->Threads, progress,
      [&](Index piece, Index begin, Index end) {
        Index* const to = next.data() + static_cast<std::size_t>(piece) * blocks.size();
        this->ForEach(begin, end, [&](Index id, double x, double y) {
          const Index row = bins.Row(y);
          const Index block = this->BlockOf[row >> this->Shift];
          const Index bin = (row - blocks[block].FirstRow) * bins.Columns + bins.Column(x);
          this->Memory[to[block]++] = { x, y, id, bin };
        });
      },
      PiecePoints);
  }

  void FillBlocks(const Progress& progress)
  {
    const std::size_t count = this->Count;
    const BinGrid::Layout& bins = this->Grid.Bins;
    this->Grid.X.Reserve(count + 8);
    this->Grid.Y.Reserve(count + 8);
    this->Resize(this->Count);
    this->Grid.Starts.Resize(static_cast<std::size_t>(bins.Columns) * bins.Rows + 1);
    this->Grid.RowLow.Resize(bins.Rows);
    this->Grid.RowHigh.Resize(bins.Rows);

    // The few large blocks come last, and report their own progress.
    const auto isLarge = [&bins](const Block& block) { return block.Pieces(bins) > 1; };
    const double large = std::accumulate(this->Blocks.begin(), this->Blocks.end(), 0.0,
      [&](double points, const Block& block) { return points + isLarge(block) * block.Count; });
    double done = 1.0 - large / count;
    const auto fill = [&](Block& block, const Progress& inBlock) {
      BlockFiller(this->Grid, block, inBlock).Run(this->Points, this->Policy);
    };
    ForEachPiece(static_cast<Index>(this->Blocks.size()), this->Threads,
      SubProgress(progress, 0.0, done), [&](Index i) {
        if (!isLarge(this->Blocks[i]))
        {
          fill(this->Blocks[i], Progress());
        }
      });
    for (Block& block : this->Blocks)
    {
      if (isLarge(block))
      {
        const double begin = done;
        done = std::min(1.0, done + static_cast<double>(block.Count) / count);
        fill(block, SubProgress(progress, begin, done));
      }
    }
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
    for (Block& block : this->Blocks)
    {
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
    std::vector<Index> firstNodes, pieces(1, 0); // a large block has several pieces
    std::vector<BoxTree::Child> roots;
    Index nodes = 0;
    for (const Block& block : this->Blocks)
    {
      if (block.Count > 0)
      {
        roots.push_back(block.Root);
        roots.back().First += block.Root.Count > 0 ? block.Begin : nodes;
      }
      firstNodes.push_back(nodes);
      nodes += static_cast<Index>(block.Nodes.size());
      pieces.push_back(pieces.back() + block.Pieces(this->Grid.Bins));
    }
    this->Grid.Tree.Nodes.Reserve(nodes + this->Blocks.size());
    this->Grid.Tree.Nodes.Resize(nodes);
    ForEachPiece(pieces.back(), this->Threads, progress, [&](Index piece) {
      const std::size_t i =
        std::upper_bound(pieces.begin(), pieces.end(), piece) - pieces.begin() - 1;
      this->JoinPiece(this->Blocks[i], firstNodes[i], piece - pieces[i], pieces[i + 1] - pieces[i]);
    });
    this->Grid.Tree.Join(std::move(roots), this->Grid.NumberOfPoints(), progress);
  }

  void JoinPiece(Block& block, Index firstNode, std::size_t part, std::size_t parts)
  {
    const auto forEach = [&](std::size_t count, auto&& work) {
      const std::size_t end = count * (part + 1) / parts;
      std::size_t k = count * part / parts;
      CountWork(end - k);
      for (; k < end; ++k)
      {
        work(k);
      }
    };
    const std::size_t columns = this->Grid.Bins.Columns;
    const Index begin = block.Begin;
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
    if (parts == 1)
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
  std::size_t Pieces = 0;     ///< of the input
  std::vector<Index> InGroup; ///< piece by piece, the number of points in each group
  std::vector<Index> BlockOf; ///< one per group
  Buffer<Placed> Memory;      ///< the points, block by block
  std::vector<Block> Blocks;
};
} // namespace

BinGrid::BinGrid(const PointView& points, DuplicatePolicy policy, const Progress& progress,
  int threads, Extent* known)
{
  const auto look = [&]() {
    return FindExtent(
      points, threads, SubProgress(progress, 0.0, 0.2), [](Index, const Point2&) {});
  };
  Extent extent = known ? std::move(*known) : look();
  this->NotFinite = std::move(extent.NotFinite);
  GridBuilder(*this, points, policy, threads).Run(extent, SubProgress(progress, 0.2, 1.0));
}

} // namespace elevation
