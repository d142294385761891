// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Packs the lanes of a wide vector that a mask chooses, by a table. Constant time.
 */
#ifndef elevation_Grow_Packing_h
#define elevation_Grow_Packing_h

#include "Kernel/Bins/Bins.h"

#include <cstdint>

#ifdef ELEVATION_HAS_AVX2
namespace elevation
{

/** For every eight bits, the places of those that are set, then anything. */
struct Packing
{
  alignas(8) std::uint8_t Places[256][8];

  constexpr Packing()
    : Places()
  {
    for (int bits = 0; bits < 256; ++bits)
    {
      for (int place = 0, count = 0; place < 8; ++place)
      {
        if (bits >> place & 1)
        {
          this->Places[bits][count++] = static_cast<std::uint8_t>(place);
        }
      }
    }
  }
};
inline constexpr Packing Packings;

/** The places of the bits that are set. */
ELEVATION_WIDE_INLINE __m256i PlacesOf(int bits)
{
  return _mm256_cvtepu8_epi32(
    _mm_loadl_epi64(reinterpret_cast<const __m128i*>(Packings.Places[bits])));
}

} // namespace elevation
#endif

#endif
