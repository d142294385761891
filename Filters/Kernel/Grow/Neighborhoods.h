// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The points around the leaves of the tree, for windows of points in full bins (PointWindows.h).
 *
 * In: a slot. Out: the neighborhood of its leaf, in single precision. It is gathered once for all
 * vertices of the leaf, and kept while the sweep passes it. Cost: constant per leaf; memory
 * proportional to the square root of the number of points.
 */
#ifndef elevation_Grow_Neighborhoods_h
#define elevation_Grow_Neighborhoods_h

#include "Kernel/Bins/Bins.h"

#include <vector>

namespace elevation
{

/**
 * The points around a leaf of the tree: those in the boxes of all its points, relative to its
 * middle. Vertices of a full bin come in the order of y, so several leaves alternate. A plain
 * struct of fixed size: recent ones are reused in place, without memory to allocate.
 */
struct Neighborhood
{
  static constexpr int MostPoints = 120;
  static constexpr int Room = MostPoints + 16; ///< as whole vectors are written

  Index First = 0, End = 0;         ///< slots of the leaf
  int Count = 0;                    ///< 0 if they are too many
  double CenterX, CenterY, PerSide; ///< box sides per unit of the grid
  float X[Room], Y[Room];
  Index Slots[Room];
};

/**
 * The neighborhoods of recent slots. Each strip has its own, so nothing is shared between threads.
 */
class Neighborhoods
{
public:
  /** From the middle of a leaf to the farthest point around it, in sides of a box. */
  static constexpr double MostSides = 4.0;

  /** @param instructions  a set with vectors that the processor has */
  Neighborhoods(const BinGrid& grid, InstructionSet instructions)
    : Grid(grid)
    , Instructions(instructions)
  {
  }

  /** The neighborhood of the leaf of a slot. */
  const Neighborhood& Around(Index slot);

private:
  /** Fills a neighborhood for the leaf of a slot; its Count is 0 if there are too many points. */
  void Gather(Index slot, Neighborhood& around) const;

  const BinGrid& Grid;
  const InstructionSet Instructions;
  std::vector<Neighborhood> Recent;
  /** A cache: for slot / 8, modulo the size, the index of a neighborhood. */
  std::vector<Index> Places;
  std::size_t Oldest = 0;
};

} // namespace elevation

#endif
