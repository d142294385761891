// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Sorts the slots of a row of bins by (y, x).
 *
 * A bucket sort over the row's height, finished by insertion. Full buckets are sorted in the same
 * way, or, below a few levels, by comparison. Cost: linear, n log n in full buckets.
 */
#ifndef elevation_Bins_RowSorter_h
#define elevation_Bins_RowSorter_h

#include "BoxTree.h"

#include <algorithm>
#include <cfloat>
#include <utility>

namespace elevation
{

// By y only: x decides where y is equal, in the comparison. Most rows have many points spread
// evenly over their height, so buckets take less time than comparisons.
class RowSorter
{
public:
  /** @param room  for as many points as the rows hold */
  RowSorter(const BoxTree::Rows& rows, BoxTree::Placed* room, const Progress& progress)
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
    // The memory of the block's points, which are in their slots by now: entries in its front part,
    // slots for deeper levels behind.
    const double* const y = this->Grid.Y + slots.first;
    const Index count = slots.second - slots.first, first = slots.first;
    static_assert(
      sizeof(Entry) + sizeof(Index) <= sizeof(BoxTree::Placed), "there is room for both");
    Index* const room = static_cast<Index*>(static_cast<void*>(this->Entries + count));
    this->Sort(
      [=](Index i) {
        return Entry{ y[i], first + i };
      },
      this->Entries, room, count, low, high, 0);
    this->ForEach(0, count, [&](Index i) { order[i] = this->Entries[i].Slot; });
  }

private:
  // So few entries are sorted by insertion.
  static constexpr Index Few = 16;
  static constexpr int MaximumDepth = 3;

  // With its y, since slots of a row are not in that order in memory.
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
    // As many buckets as entries: one in each, if y is even.
    const double last = count - 1;
    const double perHeight = last / (high - low);
    // Also where all y are equal, or so near that buckets cannot divide them.
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
    // One list for each depth, used again by every bucket there.
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
    // After the counting pass, ends[b] is the begin of bucket b; writing has moved it to the end.
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
        // Only slots are copied, as get() must not read where the deeper level writes.
        Index* const from = room + begin;
        this->ForEach(0, size, [&](Index i) { from[i] = sorted[begin + i].Slot; });
        this->Sort(
          Listed{ from, this->Grid.Y }, sorted + begin, from, size, lowest, highest, depth + 1);
      }
    }
    // Buckets are in order, and each has few entries or is sorted, so this is linear.
    this->Insert(sorted, count);
  }

  const BoxTree::Rows& Grid;
  Entry* const Entries;
  const Progress& Monitor;
  Buffer<Index> Ends[MaximumDepth + 1];
};

} // namespace elevation

#endif
