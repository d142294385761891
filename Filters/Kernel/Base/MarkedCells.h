// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The marked cells of a raster, by a summed-area table [Crow 1984]: whether a rectangle has any
 * takes four look-ups, however large it is. Cost: linear in the cells.
 *
 *     Sums(i, j) is the number of marked cells left of column i and below row j.
 *
 *          a----b          Marked cells in the rectangle:
 *          |    |          Sums(b) - Sums(a) - Sums(d) + Sums(c).
 *          c----d
 *
 * The same way round, a rectangle is marked by four differences, whose double sum is 1 inside it:
 * so rectangles may be many, and large, too.
 *
 * [Crow 1984] Summed-area tables for texture mapping.
 */
#ifndef elevation_Base_MarkedCells_h
#define elevation_Base_MarkedCells_h

#include "Points.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace elevation
{

/** Ends of rectangles, which all are cells of the raster, belong to them. */
class MarkedCells
{
public:
  // One row and column more than there are cells: a difference may stand just beyond the last.
  MarkedCells(Index columns, Index rows)
    : Width(static_cast<std::size_t>(columns) + 2)
    , Sums(this->Width * (static_cast<std::size_t>(rows) + 2), 0)
  {
  }

  /** Before Finish(). Each cell counts once, however many rectangles it is in. */
  void Mark(Index left, Index bottom, Index right, Index top)
  {
    ++this->Sums[this->At(left + 1, bottom + 1)];
    --this->Sums[this->At(right + 2, bottom + 1)];
    --this->Sums[this->At(left + 1, top + 2)];
    ++this->Sums[this->At(right + 2, top + 2)];
  }

  void Finish()
  {
    this->AddUp(); // the number of rectangles over each cell
    for (Index& sum : this->Sums)
    {
      sum = sum > 0 ? 1 : 0;
    }
    this->AddUp();
  }

  bool AreAny(Index left, Index bottom, Index right, Index top) const
  {
    const Index* const sums = this->Sums.data();
    return sums[this->At(right + 1, top + 1)] - sums[this->At(left, top + 1)] -
      sums[this->At(right + 1, bottom)] + sums[this->At(left, bottom)] >
      0;
  }

private:
  std::size_t At(Index column, Index row) const
  {
    return static_cast<std::size_t>(row) * this->Width + static_cast<std::size_t>(column);
  }

  /** Each becomes the sum of all to the left and below, itself included. */
  void AddUp()
  {
    for (std::size_t begin = 0; begin < this->Sums.size(); begin += this->Width)
    {
      Index ofRow = 0;
      for (std::size_t i = begin; i < begin + this->Width; ++i)
      {
        ofRow += this->Sums[i];
        this->Sums[i] = ofRow + (begin == 0 ? 0 : this->Sums[i - this->Width]);
      }
    }
  }

  std::size_t Width;
  std::vector<Index> Sums;
};

} // namespace elevation

#endif
