// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Bit counting, and sets of ids as bitmaps. Cost: one bit for each possible id; constant time to
 * add or look up an id.
 */
#ifndef elevation_Base_IdSet_h
#define elevation_Base_IdSet_h

#include "Progress.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#if defined(_MSC_VER)
#include <intrin.h>
#endif

namespace elevation
{

/**
 * Number of bits that are set: sums of pairs of bits, of fours and of bytes side by side in one
 * word, then all bytes in the highest one by a multiplication. (Compiled for any x86-64, a program
 * may not use the instruction for this.)
 */
inline int CountBits(std::uint64_t bits)
{
  bits -= (bits >> 1) & 0x5555555555555555u;
  bits = (bits & 0x3333333333333333u) + ((bits >> 2) & 0x3333333333333333u);
  bits = (bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fu;
  return static_cast<int>((bits * 0x0101010101010101u) >> 56);
}

/** Position of the lowest bit that is set; there must be one. */
inline int LowestBit(std::uint64_t bits)
{
#if defined(__GNUC__) || defined(__clang__)
  return __builtin_ctzll(bits);
#elif defined(_MSC_VER) && (defined(_M_X64) || defined(_M_ARM64))
  unsigned long position;
  _BitScanForward64(&position, bits);
  return static_cast<int>(position);
#else
  // Isolates the lowest bit, and counts the zeros below it.
  return CountBits((bits & (~bits + 1)) - 1);
#endif
}

/** Position of the highest bit that is set; there must be one. */
inline int HighestBit(std::uint64_t bits)
{
#if defined(__GNUC__) || defined(__clang__)
  return 63 - __builtin_clzll(bits);
#else
  // Sets all bits below the highest one.
  for (int shift : { 1, 2, 4, 8, 16, 32 })
  {
    bits |= bits >> shift;
  }
  return CountBits(bits) - 1;
#endif
}

/**
 * A set of ids as a bitmap: small, so that lookups in any order are fast. Threads may look up ids
 * together, but must not add to one set, not even different ids: these may share a word.
 */
class IdSet
{
public:
  /** Empty; for ids below @a limit. */
  explicit IdSet(Index limit)
    : Words(static_cast<std::size_t>(limit) / 64 + 1, 0)
  {
  }

  void Add(Index id) { this->Words[WordOf(id)] |= BitOf(id); }
  // Three ids are those of a triangle's corners.
  void AddAll(const Index* three)
  {
    std::for_each(three, three + 3, [this](Index id) { this->Add(id); });
  }
  void RemoveAll(const Index* three)
  {
    std::for_each(three, three + 3, [this](Index id) { this->Words[WordOf(id)] &= ~BitOf(id); });
  }
  /** Adds the ids of another set; ids that were in both are also added to @a common. */
  void Add(const IdSet& other, IdSet& common)
  {
    for (std::size_t word = 0; word < this->Words.size(); ++word)
    {
      common.Words[word] |= this->Words[word] & other.Words[word];
      this->Words[word] |= other.Words[word];
    }
  }
  bool Has(Index id) const { return (this->Words[WordOf(id)] & BitOf(id)) != 0; }
  /** Whether any of three ids is in the set; without branches. */
  bool HasAny(const Index* three) const
  {
    // Unsigned, so that division and remainder are a shift and a mask.
    const std::uint32_t a = three[0], b = three[1], c = three[2];
    return ((this->Words[a / 64] >> a % 64) | (this->Words[b / 64] >> b % 64) |
             (this->Words[c / 64] >> c % 64)) &
      1;
  }

  Index Count() const
  {
    Index count = 0;
    for (const std::uint64_t word : this->Words)
    {
      count += CountBits(word);
    }
    return count;
  }

  /** The ids, increasing; faster than sorting a long list. Linear in the limit of ids, too. */
  std::vector<Index> List(const Progress& progress = Progress()) const
  {
    std::vector<Index> ids;
    ids.reserve(this->Count());
    for (const std::size_t word : Counted(this->Words.size()))
    {
      ReportStep(progress, word, this->Words.size());
      // left & (left - 1) clears the lowest bit.
      for (std::uint64_t left = this->Words[word]; left != 0; left &= left - 1)
      {
        ids.push_back(static_cast<Index>(64 * word) + LowestBit(left));
      }
    }
    return ids;
  }

  /**
   * Lists the ids, increasing. From then on RankOf() gives the place of an id in the list, until an
   * id is added or removed. So a part of a mesh numbers its points anew without a map.
   */
  std::vector<Index> ListAndRank()
  {
    this->Before.resize(this->Words.size());
    Index count = 0;
    for (std::size_t word = 0; word < this->Words.size(); ++word)
    {
      this->Before[word] = count;
      count += CountBits(this->Words[word]);
    }
    return this->List();
  }
  Index RankOf(Index id) const
  {
    const std::uint64_t lower = this->Words[WordOf(id)] & (BitOf(id) - 1);
    return this->Before[WordOf(id)] + CountBits(lower);
  }

private:
  static std::size_t WordOf(Index id) { return static_cast<std::uint32_t>(id) / 64; }
  static std::uint64_t BitOf(Index id)
  {
    return std::uint64_t(1) << static_cast<std::uint32_t>(id) % 64;
  }

  std::vector<std::uint64_t> Words;
  std::vector<Index> Before; ///< the number of ids before each word
};

} // namespace elevation

#endif
