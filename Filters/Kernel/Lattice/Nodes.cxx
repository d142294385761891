// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Nodes.h"

#include <array>
#include <cfloat>
#include <cmath>
#include <numeric>
#include <utility>

namespace elevation
{
namespace
{
/** Points handled at a time, so that their memory can be prefetched. */
constexpr Index Few = 32;

/**
 * Whether the points are too many for a core's cache and come in no order. In rows, in columns and
 * along paths, most points repeat the step of the point before, or take a short one.
 */
bool AreScattered(
  const PointView& points, const std::vector<Index>& notFinite, const NodeFinder& nodeOf)
{
  // Smaller clouds are in the cache in any order. A thousand places are enough of a sample.
  constexpr Index fewest = 1 << 20, samples = 1024, shortStep = 256;
  Index scattered = 0;
  for (Index sample = 0; points.Count >= fewest && sample < samples; ++sample)
  {
    std::array<Index, 3> column{}, row{};
    Index count = 0;
    // Three points in a row of the input, at places spread over it.
    const Index first = sample * (points.Count / samples);
    ForEachPoint(points, first, first + 3, notFinite, [&](Index, const Point2& p) {
      nodeOf(p, column[count], row[count]);
      ++count;
    });
    // Neither a short step nor the same one as before: no pattern that a processor prefetches.
    const auto isNew = [](const std::array<Index, 3>& at) {
      const Index step = at[2] - at[1], before = at[1] - at[0];
      return std::abs(step) > shortStep && std::abs(step - before) > shortStep;
    };
    scattered += count == 3 && (isNew(column) || isNew(row));
  }
  return 2 * scattered > samples;
}
} // namespace

/**
 * One run of Place(); the members carry data between its passes:
 * 1. FindBox() and MakeBitmap() lay out the bitmap.
 * 2. FindNodes() writes each point's node and checks its distance; Occupy() sets the bits.
 * 3. Scattered points are sorted into buckets first, and each bucket is one thread's.
 * 4. CountBefore() adds up the bits before each word.
 * 5. PlaceIds(), or PlaceBucket(), writes each id to its rank.
 * 6. ResolveDuplicate() decides which of several points on a node is kept.
 */
class LatticeNodes::Placement
{
public:
  Placement(LatticeNodes& nodes, const PointView& points, const LatticeSearch& search,
    DuplicatePolicy policy, int threads)
    : Nodes(nodes)
    , Points(points)
    , Search(search)
    , Policy(policy)
    , Threads(threads)
    , NodeOf(search.Steps)
  {
  }

  bool Run(double tolerance, const Progress& progress)
  {
    Stages stages(progress, { 20, 0, 30, 20, 29, 1 });
    const NodeBox box = this->FindBox(stages.Next());
    if (!this->MakeBitmap(box, stages.Next()))
    {
      return false;
    }
    this->IsScattered = AreScattered(this->Points, this->Search.NotFinite, this->NodeOf);
    if (!this->FindNodes(tolerance, stages.Next()))
    {
      return false;
    }
    IdSet duplicates(this->Points.Count);
    Buckets sorted;
    const Progress sorting = stages.Next();
    const bool isSorted = this->IsScattered && this->SortIntoBuckets(sorted, sorting);
    const Progress placing = stages.Next();
    if (!(isSorted ? this->PlaceSorted(sorted, duplicates, placing)
                   : this->PlaceInOrder(duplicates, placing)))
    {
      return false;
    }
    this->Nodes.Duplicates = duplicates.List(stages.Next());
    this->FindOrigin();
    return true;
  }

private:
  /** Points by buckets of consecutive nodes. */
  struct Buckets
  {
    std::vector<Index> Begins; ///< where each begins in Nodes and Ids; then the end of the last
    Buffer<Index> Nodes;       ///< None for points whose node is taken
    Buffer<Index> Ids;         ///< of the points
    Index Count() const { return static_cast<Index>(this->Begins.size()) - 1; }
  };

  /** The box of all nodes, in steps from the search's origin. */
  NodeBox FindBox(const Progress& progress) const
  {
    return FindNodeBox(this->NodeOf, this->Search, this->Search.Steps, [&]() {
      std::vector<NodeBox> boxes(NumberOfRanges(this->Points.Count));
      this->ForEachRange(progress, [&](Index range, Index begin, Index end) {
        NodeBox here;
        ForEachPoint(this->Points, begin, end, this->Search.NotFinite,
          [&](Index, const Point2& p) { this->NodeOf.Extend(here, p); });
        boxes[range] = here;
      });
      NodeBox box;
      for (const NodeBox& one : boxes)
      {
        box.Join(one);
      }
      return box;
    });
  }

  /** Allocates the bitmap for a box of nodes. @return false when it takes too much memory */
  bool MakeBitmap(const NodeBox& box, const Progress& progress)
  {
    // In doubles, as the numbers of a lattice that does not fit may be beyond 64 bits.
    const double count = this->Points.Count - static_cast<double>(this->Search.NotFinite.size());
    if (!box.IsFilledEnough(count) || box.Words() * 64.0 > std::numeric_limits<Index>::max())
    {
      return false;
    }
    this->NodeOf.Start(box);
    this->Nodes.Columns = static_cast<Index>(box.Columns());
    this->Nodes.Rows = static_cast<Index>(box.Rows());
    this->Nodes.WordsPerRow = static_cast<Index>(box.WordsPerRow());
    const double words = box.Words();
    this->Nodes.Memory.Resize(static_cast<std::size_t>(words));
    this->Nodes.Words = reinterpret_cast<AtomicWord*>(this->Nodes.Memory.data());
    elevation::ForEachRange(
      static_cast<Index>(words), this->Threads, progress, [&](Index, Index begin, Index end) {
        // Made in place by the threads that will use it; see the assertion in Nodes.h.
        for (Index word = begin; word < end; ++word)
        {
          new (this->Nodes.Words + word) AtomicWord(0);
        }
      });
    return true;
  }

  /**
   * Writes the node of each point, or None, to Scratch; unless points are scattered, sets the bits.
   * @return false when a point is too far from its node
   */
  bool FindNodes(double tolerance, const Progress& progress)
  {
    this->Nodes.Scratch.Resize(static_cast<std::size_t>(this->Points.Count));
    Index* const nodes = this->Nodes.Scratch.data();
    std::vector<double> offsets(NumberOfRanges(this->Points.Count), 0.0);
    this->Second.resize(offsets.size());
    std::atomic<bool> fits{ true };
    this->ForEachRange(progress, [&](Index range, Index begin, Index end) {
      if (!fits)
      {
        return;
      }
      std::vector<Index> second; // local, against false sharing
      double largest = 0.0;
      for (; begin < end; begin += Few)
      {
        const Index last = std::min(begin + Few, end);
        if (!this->Search.NotFinite.empty())
        {
          // ForEachPoint() passes only finite points, so the others get None before.
          std::fill(nodes + begin, nodes + last, None);
        }
        ForEachPoint(
          this->Points, begin, last, this->Search.NotFinite, [&](Index id, const Point2& p) {
            Index column, row;
            largest = std::max(largest, this->NodeOf(p, column, row));
            nodes[id] = this->Nodes.NodeAt(row, column);
            Prefetch(this->Nodes.Words + (nodes[id] >> 6));
          });
        if (!this->IsScattered)
        {
          this->Occupy(begin, last, second);
        }
      }
      // Also for NaN.
      if (!(largest <= tolerance + NodeRoundoff))
      {
        fits = false;
      }
      offsets[range] = largest;
      this->Second[range] = std::move(second);
    });
    // With rounding: growth proves with it that triangles are not flat.
    this->Nodes.LargestOffset = *std::max_element(offsets.begin(), offsets.end()) +
      std::max(NodeRoundoff, this->NodeOf.Roundoff(this->Search.Low, this->Search.High));
    return fits;
  }

  /** Calls work(range, begin, end) for ranges of the points. */
  template <typename Work>
  void ForEachRange(const Progress& progress, Work&& work) const
  {
    elevation::ForEachRange(this->Points.Count, this->Threads, progress, work);
  }

  /** The way for scattered points: bucket by bucket, so that bitmap and ids are in the cache. */
  bool PlaceSorted(Buckets& sorted, IdSet& duplicates, const Progress& progress)
  {
    Stages stages(progress, { 35, 50, 15 });
    ForEachTask(sorted.Count(), this->Threads, stages.Next(),
      [&](Index bucket) { this->OccupyBucket(sorted, bucket); });
    this->CountBefore();
    ForEachTask(sorted.Count(), this->Threads, stages.Next(),
      [&](Index bucket) { this->PlaceBucket(sorted, bucket); });
    const Progress settling = stages.Next();
    const Index placed = sorted.Begins.back();
    // All points placed: there are no duplicates to look for.
    for (const Index i : Counted(this->Nodes.NumberOfPoints() < placed ? placed : 0))
    {
      ReportStep(settling, static_cast<std::size_t>(i), static_cast<std::size_t>(placed));
      if (sorted.Nodes[i] == None && !this->ResolveDuplicate(sorted.Ids[i], duplicates))
      {
        return false;
      }
    }
    this->Nodes.Scratch = std::move(sorted.Nodes);
    return true;
  }

  /** The way for points in some order: range by range, prefetching. */
  bool PlaceInOrder(IdSet& duplicates, const Progress& progress)
  {
    Stages stages(progress, { 35, 50, 15 });
    const Progress occupying = stages.Next();
    if (this->IsScattered)
    {
      this->ForEachRange(occupying, [&](Index range, Index begin, Index end) {
        std::vector<Index> second;
        this->Occupy(begin, end, second);
        this->Second[range] = std::move(second);
      });
    }
    this->CountBefore();
    this->ForEachRange(
      stages.Next(), [&](Index, Index begin, Index end) { this->PlaceIds(begin, end); });
    const Progress settling = stages.Next();
    // One after another, by id: which of several is kept does not depend on threads.
    std::size_t steps = 0;
    for (const std::vector<Index>& second : this->Second)
    {
      for (const Index id : Counted(second))
      {
        ReportStep(settling, steps++, static_cast<std::size_t>(this->Points.Count));
        if (!this->ResolveDuplicate(id, duplicates))
        {
          return false;
        }
      }
    }
    return true;
  }

  /** Keeps one of two points on a node. @return false when they are not at the same place */
  bool ResolveDuplicate(Index id, IdSet& duplicates)
  {
    Index column, row;
    this->NodeOf(this->Points.At(id), column, row);
    // Some point of the node, whichever thread came first; the policy decides between the two.
    Index& kept = this->Nodes.Ids[this->Nodes.RankOf(this->Nodes.NodeAt(row, column))];
    const bool isSamePlace = this->Points.At(kept) == this->Points.At(id);
    if (isSamePlace && IsPreferred(this->Points, this->Policy, id, kept))
    {
      std::swap(id, kept);
    }
    duplicates.Add(id);
    return isSamePlace;
  }

  /** Moves the origin to the lowest occupied node. */
  void FindOrigin()
  {
    // There is a point, so there is a bit.
    Index word = 0;
    while (this->Nodes.Word(word) == 0)
    {
      ++word;
    }
    const Index lowest = 64 * word + LowestBit(this->Nodes.Word(word));
    const Index row = this->Nodes.RowOf(lowest);
    this->Nodes.Steps = this->Search.Steps;
    this->Nodes.Steps.Origin = this->Search.Steps.Node(
      this->NodeOf.FirstI + this->Nodes.ColumnOf(lowest, row), this->NodeOf.FirstJ + row);
  }

  bool SortIntoBuckets(Buckets& sorted, const Progress& progress);
  void OccupyBucket(Buckets& buckets, Index bucket);
  void PlaceBucket(const Buckets& buckets, Index bucket);
  std::uint64_t SetBits(Index word, std::uint64_t bits, bool isShared);
  void Occupy(Index begin, Index end, std::vector<Index>& second);
  void CountBefore();
  void PlaceIds(Index begin, Index end);

  LatticeNodes& Nodes;
  const PointView& Points;
  const LatticeSearch& Search;
  const DuplicatePolicy Policy;
  const int Threads;
  NodeFinder NodeOf;
  bool IsScattered = false;               ///< the points come in no order, and are many
  std::vector<std::vector<Index>> Second; ///< by range: the points whose node was taken
};

bool LatticeNodes::Place(const PointView& points, const LatticeSearch& search, double tolerance,
  DuplicatePolicy policy, int threads, const Progress& progress)
{
  return Placement(*this, points, search, policy, threads).Run(tolerance, progress);
}

/**
 * Sorts the nodes in Scratch, whose memory becomes that of Ids, into buckets.
 * @return false when points are not spread over the buckets; then nothing changes
 */
bool LatticeNodes::Placement::SortIntoBuckets(Buckets& sorted, const Progress& progress)
{
  Stages stages(progress, { 50, 50 });
  // A bucket should fit into a core's cache, and so should the ends of all buckets.
  constexpr Index pointsPerBucket = 1 << 14, mostBuckets = 512;
  // Shift so many bits of the node number that buckets are few, and about as large as wanted.
  const Index count = static_cast<Index>(this->Nodes.Scratch.size());
  const Index last = static_cast<Index>(this->Nodes.Memory.size() * 64 - 1); // node
  int shift = 6;                                                             // words stay whole
  while (last >> shift >= std::min(mostBuckets, count / pointsPerBucket + 1))
  {
    ++shift;
  }
  const Index buckets = (last >> shift) + 1;
  const Index ranges = NumberOfRanges(count);
  // Counts for each range of points and bucket, then places: each range writes its own without a
  // lock, and a bucket's points stay in the order of ids.
  std::vector<Index> numbers(static_cast<std::size_t>(ranges) * buckets, 0);
  const auto forEachNode = [&](Index range, Index begin, Index end, auto&& visit) {
    Index* const here = numbers.data() + static_cast<std::size_t>(range) * buckets;
    for (Index id = begin; id < end; ++id)
    {
      if (this->Nodes.Scratch[id] != None)
      {
        visit(here[this->Nodes.Scratch[id] >> shift]++, id);
      }
    }
  };
  sorted.Nodes.Resize(static_cast<std::size_t>(count));
  sorted.Ids.Resize(static_cast<std::size_t>(count));
  this->ForEachRange(stages.Next(), [&](Index range, Index begin, Index end) {
    // The writes below come in no order; see TouchPages().
    TouchPages(sorted.Nodes, begin, end);
    TouchPages(sorted.Ids, begin, end);
    forEachNode(range, begin, end, [](Index, Index) {});
  });
  Index sum = 0, largest = 0;
  for (Index bucket = 0; bucket < buckets; ++bucket)
  {
    sorted.Begins.push_back(sum);
    for (Index range = 0; range < ranges; ++range)
    {
      // The count is replaced by the sum of all before it.
      sum += std::exchange(numbers[static_cast<std::size_t>(range) * buckets + bucket], sum);
    }
    largest = std::max(largest, sum - sorted.Begins.back());
  }
  sorted.Begins.push_back(sum);
  // A larger bucket would keep one thread busy too long without a report.
  if (largest / 16 > std::max(pointsPerBucket, count / buckets))
  {
    sorted = Buckets(); // gives its memory back
    return false;
  }
  this->ForEachRange(stages.Next(), [&](Index range, Index begin, Index end) {
    forEachNode(range, begin, end, [&](Index place, Index id) {
      sorted.Nodes[place] = this->Nodes.Scratch[id];
      sorted.Ids[place] = id;
    });
  });
  this->Nodes.Ids = std::move(this->Nodes.Scratch);
  return true;
}

/** As Occupy(), for one bucket. */
void LatticeNodes::Placement::OccupyBucket(Buckets& buckets, Index bucket)
{
  CountWork(static_cast<std::size_t>(buckets.Begins[bucket + 1] - buckets.Begins[bucket]));
  for (Index i = buckets.Begins[bucket]; i < buckets.Begins[bucket + 1]; ++i)
  {
    Index& node = buckets.Nodes[i];
    const std::uint64_t bit = std::uint64_t(1) << (node & 63);
    // Not shared: words of a bucket belong to one thread.
    if (this->SetBits(node >> 6, bit, false) & bit)
    {
      node = None;
    }
  }
}

/** Writes the ids of a bucket to their places. */
void LatticeNodes::Placement::PlaceBucket(const Buckets& buckets, Index bucket)
{
  CountWork(static_cast<std::size_t>(buckets.Begins[bucket + 1] - buckets.Begins[bucket]));
  for (Index i = buckets.Begins[bucket]; i < buckets.Begins[bucket + 1]; ++i)
  {
    if (buckets.Nodes[i] != None)
    {
      this->Nodes.Ids[this->Nodes.RankOf(buckets.Nodes[i])] = buckets.Ids[i];
    }
  }
}

/** Sets bits of a word. @return what was set before */
std::uint64_t LatticeNodes::Placement::SetBits(Index word, std::uint64_t bits, bool isShared)
{
  AtomicWord& there = this->Nodes.Words[word];
  if (isShared)
  {
    // Relaxed: threads meet before anyone reads.
    return there.fetch_or(bits, std::memory_order_relaxed);
  }
  // An atomic exchange would lock the word, which only several threads need.
  const std::uint64_t before = there.load(std::memory_order_relaxed);
  there.store(before | bits, std::memory_order_relaxed);
  return before;
}

/** Sets the bits of points' nodes; points whose node is taken get None, and are listed. */
void LatticeNodes::Placement::Occupy(Index begin, Index end, std::vector<Index>& second)
{
  Index* const nodes = this->Nodes.Scratch.data();
  const bool isShared = this->Threads > 1;
  while (begin < end)
  {
    if (nodes[begin] == None)
    {
      ++begin;
      continue;
    }
    // Points in the order of their nodes fill a word at a time.
    const Index word = nodes[begin] >> 6;
    std::uint64_t bits = 0;
    Index next = begin;
    do
    {
      bits |= std::uint64_t(1) << (nodes[next] & 63);
      ++next;
    } while (next < end && nodes[next] >> 6 == word);
    std::uint64_t taken = this->SetBits(word, bits, isShared);
    // Seldom: a node taken before, or twice within this word.
    if ((taken & bits) || (next - begin > 1 && CountBits(bits) != next - begin))
    {
      for (Index id = begin; id < next; ++id)
      {
        const std::uint64_t bit = std::uint64_t(1) << (nodes[id] & 63);
        if (taken & bit)
        {
          second.push_back(id);
          nodes[id] = None;
        }
        taken |= bit;
      }
    }
    begin = next;
  }
}

/** Sets Before, and makes room for as many ids as there are occupied nodes. */
void LatticeNodes::Placement::CountBefore()
{
  const Index words = static_cast<Index>(this->Nodes.Memory.size());
  this->Nodes.Before.Resize(this->Nodes.Memory.size());
  // Two passes, as the sums of all earlier ranges are needed before ranks can be written.
  constexpr Index fewestWords = 1 << 14; // to start a thread takes longer
  const Index ranges = std::max(1, std::min(this->Threads, words / fewestWords));
  const auto beginOf = [&](Index range) {
    return static_cast<Index>(std::int64_t(words) * range / ranges);
  };
  std::vector<Index> sums(ranges, 0);
  ForEachTask(ranges - 1, this->Threads, [&](Index range) {
    Index sum = 0;
    CountWork(static_cast<std::size_t>(beginOf(range + 1) - beginOf(range)));
    for (Index word = beginOf(range); word < beginOf(range + 1); ++word)
    {
      sum += CountBits(this->Nodes.Word(word));
    }
    sums[range + 1] = sum;
  });
  std::partial_sum(sums.begin(), sums.end(), sums.begin());
  ForEachTask(ranges, this->Threads, [&](Index range) {
    Index rank = sums[range];
    CountWork(static_cast<std::size_t>(beginOf(range + 1) - beginOf(range)));
    for (Index word = beginOf(range); word < beginOf(range + 1); ++word)
    {
      this->Nodes.Before[word] = rank;
      rank += CountBits(this->Nodes.Word(word));
    }
    sums[range] = rank;
  });
  this->Nodes.Ids.Resize(sums.back());
}

/** Writes the ids of some points to their places. */
void LatticeNodes::Placement::PlaceIds(Index begin, Index end)
{
  const Index* const nodes = this->Nodes.Scratch.data();
  Index* const ids = this->Nodes.Ids.data();
  std::array<Index, Few> ranks;
  for (; begin < end; begin += Few)
  {
    // Three loops, so that each asks for the memory that the next one needs.
    const Index size = std::min(Few, end - begin);
    const Index* const here = nodes + begin;
    for (Index i = 0; i < size; ++i)
    {
      // A None asks for the first word.
      const Index word = std::max(here[i], 0) >> 6;
      Prefetch(this->Nodes.Words + word);
      Prefetch(this->Nodes.Before.data() + word);
    }
    for (Index i = 0; i < size; ++i)
    {
      // Points in the order of nodes: the next rank, without counting bits.
      const bool isNext = i > 0 && ranks[i - 1] != None && here[i] == here[i - 1] + 1;
      ranks[i] = isNext ? ranks[i - 1] + 1 : here[i] != None ? this->Nodes.RankOf(here[i]) : None;
      Prefetch(ids + std::max(ranks[i], 0));
    }
    for (Index i = 0; i < size; ++i)
    {
      if (ranks[i] != None)
      {
        ids[ranks[i]] = begin + i;
      }
    }
  }
}

} // namespace elevation
