// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A block of a BinGrid: rows of bins that one thread fills, with their points in its cache.
 *
 * In: points, sorted into blocks. Out: in the grid's slots of the block, its points by bins and its
 * rows by (y, x); its part of the tree; its duplicates, set aside, which leaves a gap behind it.
 */
#ifndef elevation_Bins_GridBlock_h
#define elevation_Bins_GridBlock_h

#include "BinGrid.h"

#include <algorithm>

namespace elevation
{

// Small enough for the cache, since its points are moved several times: into bins, into the tree's
// order, into rows.
struct GridBlock
{
  /** A block has about this many points, so that it fits into a core's cache. */
  static constexpr Index UsualPoints = 1 << 14;

  Index FirstRow, EndRow;
  Index Begin, Count;      ///< slots
  // A part of the builder's memory, with as much room as the block has slots.
  BoxTree::Placed* Points; ///< first its points, then room for as many
  BoxTree::Child Root;
  Buffer<BoxTree::Node> Nodes; ///< children and slots counted from the block's first
  Buffer<Index> Duplicates;

  /** The number of tasks for work on all bins or points, so that reports come soon enough. */
  Index Tasks(const BinGrid::Layout& layout) const
  {
    // A block has more bins than points where some of its rows are sparse.
    const Index bins = (this->EndRow - this->FirstRow) * layout.Columns; // at most as all points
    return 1 + std::max(this->Count, bins) / (16 * UsualPoints);
  }

  /** Sorts the block's points into its slots of the grid. */
  void Fill(
    const PointView& points, DuplicatePolicy policy, const Progress& progress, BinGrid& grid);
};

} // namespace elevation

#endif
