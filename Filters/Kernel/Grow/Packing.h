// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The lanes of up to eight that a mask chooses, by a table: to pack them. Constant time. (Highway's
 * Compress() looks its tables up in a way that took six times the instructions where GCC 12 compiled it.)
 */
#ifndef elevation_Grow_Packing_h
#define elevation_Grow_Packing_h

#include <cstdint>

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

} // namespace elevation

#endif
