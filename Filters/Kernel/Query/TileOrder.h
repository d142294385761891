// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * An order in which places that follow each other are mostly near each other: row by row of tiles with
 * some places each. Then the boxes of the tree and the triangles at a place are in the cache, which
 * halves the time of places in random order.
 *
 *   | 1 2 . | 4 . . | 6 . . |   Tiles are as wide as they would be if places were spread evenly; it is
 *   | . . 3 | . 5 . | . . 7 |   the order of work alone, so a poor one costs time and nothing else.
 */
#ifndef elevation_Query_TileOrder_h
#define elevation_Query_TileOrder_h

#include "Kernel/Base/Base.h"

#include <cmath>
#include <numeric>
#include <vector>

namespace elevation
{

/** The numbers of places, tile by tile. */
inline std::vector<std::size_t> OrderByTiles(const std::vector<Point2>& places)
{
  constexpr double placesInTile = 8.0;
  const Box box = BoxOf(places);
  const double side = std::sqrt(static_cast<double>(places.size()) / placesInTile);
  const std::size_t width = static_cast<std::size_t>(side) + 1;
  const auto tile = [side](double value, double low, double high) {
    const double part = (value - low) / (high - low);
    return part >= 0.0 && part <= 1.0 ? static_cast<std::size_t>(part * side) : 0; // NaN as well
  };
  std::vector<std::size_t> tiles(places.size()), ends(width * width + 1, 0), order(places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const Point2& at = places[i];
    tiles[i] = tile(at.Y, box.Low.Y, box.High.Y) * width + tile(at.X, box.Low.X, box.High.X);
    ++ends[tiles[i] + 1];
  }
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    order[ends[tiles[i]]++] = i;
  }
  return order;
}

} // namespace elevation

#endif
