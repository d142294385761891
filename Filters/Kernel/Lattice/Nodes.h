// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points on the nodes of a lattice, as a bitmap: which nodes are occupied, and by which point. The
 * index for a lattice: a bit a node tells what any other index needs coordinates for.
 * In: points and the lattice they may lie on. Out: one bit a node, row after row; the points' ids
 * in the order of their nodes (by row, then column), which the number of bits before a node tells;
 * or the answer that a point does not fit. One pass over the points sets the bits and keeps the
 * nodes, one over these writes each id to its place; both on several threads. Where many points come
 * scattered, their nodes are sorted into stretches before bits are set: bits and places are then
 * near in memory, and one thread's alone.
 *
 * A node's number is 64 times its word plus its bit. Around each row are words of zeros, and above
 * the last row are rows of zeros, so that neighbours may be looked at without a check.
 *
 * Memory: at most 24 bytes a point for the bitmap (two words and two counts), 4 for the ids, and 4
 * for the nodes, which are left for other use; 4 more while scattered points are placed.
 */
#ifndef elevation_Lattice_Nodes_h
#define elevation_Lattice_Nodes_h

#include "FindLattice.h"

#include <atomic>

namespace elevation
{

class LatticeNodes
{
public:
  /** Columns and rows a search may look beyond the last without a check. */
  static constexpr Index ColumnsBeyond = 64;
  static constexpr Index RowsBeyond = 16;
  /** Most columns, and most rows: products of four coordinates and steps then fit 128 bits. */
  static constexpr Index MaximumSide = 1 << 20;

  /**
   * Puts the points on the nodes.
   * @return false when a point lies farther from its node than the tolerance, two points that are
   * not equal share one, or the lattice takes too much memory for so few points
   */
  bool Place(const PointView& points, const LatticeSearch& search, double tolerance,
    DuplicatePolicy policy, int threads, const Progress& progress);

  Index NumberOfPoints() const { return static_cast<Index>(this->Ids.size()); }
  Index NodeAt(Index row, Index column) const
  {
    return (row * this->WordsPerRow + 1) * 64 + column;
  }
  Index RowOf(Index node) const { return (node >> 6) / this->WordsPerRow; }
  Index ColumnOf(Index node, Index row) const { return node - this->NodeAt(row, 0); }
  std::uint64_t Word(Index word) const { return this->Words[word].load(std::memory_order_relaxed); }
  bool IsOccupied(Index node) const { return (this->Word(node >> 6) >> (node & 63)) & 1; }
  /** The next node that is occupied after or before this one; there must be one. */
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
  /** How many occupied nodes come before this one. */
  Index RankOf(Index node) const
  {
    const std::uint64_t before = (std::uint64_t(1) << (node & 63)) - 1;
    return this->Before[node >> 6] + CountBits(this->Word(node >> 6) & before);
  }

  Index Columns = 0, Rows = 0, WordsPerRow = 0;
  Buffer<Index> Before;          ///< occupied nodes before each word
  Buffer<Index> Ids;             ///< point ids by rank
  Buffer<Index> Room;            ///< as much as there are points; of no use after Place
  double LargestOffset = 0.0;    ///< no point is farther from its node, in steps along each step
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
