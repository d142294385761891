// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A bitmap of the nodes of a lattice: which are occupied, and by which points. The index for points
 * on a lattice: one bit a node replaces the coordinates that any other index needs.
 *
 * In: points and the lattice they may lie on. Out: one bit a node, row after row; the points' ids
 * in the order of their nodes (by row, then column), where the number of bits before a node is the
 * place of its id; or the answer that a point does not fit. One pass over the points finds their
 * nodes and sets the bits, another writes each id to its place; both on several threads. Many
 * points in random order are first sorted into buckets of nodes, each of one thread and near in
 * memory.
 *
 *   word  0 | 1 .. W-1 | W | W+1 .. 2W-1 | 2W | ...    W is WordsPerRow. The word of zeros
 *         0 |  row 0   | 0 |    row 1    | 0  | ...    before a row ends the row before it.
 *
 * A node's number is 64 times its word plus its bit. Around each row are words of zeros, and above
 * the last row are rows of zeros, so that neighbours need no bounds check.
 *
 * Cost: linear. Memory: at most 24 bytes a point for the bitmap (two words and two counts), 4 for
 * the ids, and 4 for the nodes, which are then left for other use; 4 more to sort into buckets.
 */
#ifndef elevation_Lattice_Nodes_h
#define elevation_Lattice_Nodes_h

#include "NodeFinder.h"

#include <atomic>

namespace elevation
{

/**
 * See above. Once made it does not change, so all threads read it; functions of a node take
 * constant time, but for Following() and Previous() across empty words.
 */
class LatticeNodes
{
public:
  /**
   * Assigns the points to nodes.
   * @return false when a point lies farther from its node than the tolerance, two points that are
   * not equal share one, or the bitmap takes too much memory for so few points
   */
  bool Place(const PointView& points, const LatticeSearch& search, double tolerance,
    DuplicatePolicy policy, int threads, const Progress& progress);

  Index NumberOfPoints() const { return static_cast<Index>(this->Ids.size()); }
  // Between row and column, node number, and rank: three ways to name a node.
  Index NodeAt(Index row, Index column) const
  {
    return (row * this->WordsPerRow + 1) * 64 + column;
  }
  Index RowOf(Index node) const { return (node >> 6) / this->WordsPerRow; }
  Index ColumnOf(Index node, Index row) const { return node - this->NodeAt(row, 0); }
  std::uint64_t Word(Index word) const { return this->Words[word].load(std::memory_order_relaxed); }
  bool IsOccupied(Index node) const { return (this->Word(node >> 6) >> (node & 63)) & 1; }
  /** The nearest occupied node after or before this one; there must be one. */
  Index Following(Index node) const
  {
    Index word = ++node >> 6;
    std::uint64_t bits = this->Word(word) >> (node & 63) << (node & 63);
    while (!bits)
    {
      bits = this->Word(++word);
    }
    return 64 * word + LowestBit(bits);
  }
  Index Previous(Index node) const
  {
    Index word = --node >> 6;
    std::uint64_t bits = this->Word(word) << (63 - (node & 63)) >> (63 - (node & 63));
    while (!bits)
    {
      bits = this->Word(--word);
    }
    return 64 * word + HighestBit(bits);
  }
  /** Calls visit(column) for the occupied nodes of a row, by increasing column. */
  template <typename Visit>
  void VisitRow(Index row, Visit&& visit) const
  {
    const Index first = this->NodeAt(row, 0) / 64, words = (this->Columns + 63) / 64;
    for (const Index word : Counted(words))
    {
      // Each turn takes the lowest bit off.
      for (std::uint64_t bits = this->Word(first + word); bits; bits &= bits - 1)
      {
        visit(64 * word + LowestBit(bits));
      }
    }
  }
  /** How many occupied nodes come before this one. */
  Index RankOf(Index node) const
  {
    const std::uint64_t before = (std::uint64_t(1) << (node & 63)) - 1;
    return this->Before[node >> 6] + CountBits(this->Word(node >> 6) & before);
  }

  Index Columns = 0, Rows = 0, WordsPerRow = 0;
  // A bit of Words says whether a node is occupied, Before and the bits below it say which rank it
  // has, and Ids which point that is.
  Buffer<Index> Before;          ///< occupied nodes before each word
  Buffer<Index> Ids;             ///< point ids by rank
  Buffer<Index> Scratch;         ///< an Index a point; free for other use after Place()
  double LargestOffset = 0.0;    ///< bound on a point's distance from its node, along each step
  Lattice Steps;                 ///< Origin is the lowest occupied node
  std::vector<Index> Duplicates; ///< ids, increasing

private:
  class Placement;

  using AtomicWord = std::atomic<std::uint64_t>; // several threads set bits
  static_assert(sizeof(AtomicWord) == sizeof(std::uint64_t) &&
      std::is_trivially_destructible<AtomicWord>::value,
    "made in the memory of plain words");
  Buffer<std::uint64_t> Memory;
  AtomicWord* Words = nullptr;
};

} // namespace elevation

#endif
