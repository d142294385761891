// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A set of hashes by a bit for each, small enough for caches. It may seem to have others, too: of
 * many places, it leaves few that have to be looked up in a real set. Cost: constant time.
 */
#ifndef elevation_Base_HashSieve_h
#define elevation_Base_HashSieve_h

#include "Memory.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace elevation
{

class HashSieve
{
public:
  /** With 128 bits for each hash added, less than one in a hundred others seems to be there. */
  explicit HashSieve(std::size_t leastBits)
  {
    std::size_t words = 1;
    while (64 * words < leastBits)
    {
      words *= 2;
    }
    this->Words.resize(words, 0);
    this->Mask = words - 1;
  }

  void Prefetch(std::size_t hash) const { elevation::Prefetch(&this->Words[this->WordOf(hash)]); }
  bool MayHave(std::size_t hash) const
  {
    return this->Words[this->WordOf(hash)] >> (hash & 63) & 1;
  }
  void Add(std::size_t hash) { this->Words[this->WordOf(hash)] |= std::uint64_t(1) << (hash & 63); }

private:
  std::size_t WordOf(std::size_t hash) const { return hash >> 6 & this->Mask; }

  std::vector<std::uint64_t> Words;
  std::size_t Mask = 0;
};

} // namespace elevation

#endif
