// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points sorted into the bins of a uniform grid over their bounding box: the index for points near
 * a place. A bin is found in one step, and points of neighbouring bins in a row lie side by side.
 *
 * In: points. Out: the same points in *slots*, row of bins after row of bins, so that the points of
 * neighbouring bins of a row are contiguous; duplicates set aside. Where density is even, a bin
 * holds about one point. Where it is not, some bins hold many, and a tree of boxes over the bins
 * leads to few of them (BoxTree.h).
 *
 *   row 2 | 7  | 8 9|    | 10 |    Slots go through the bins row by row, so the points of any
 *   row 1 | 3 4|    | 5  | 6  |    stretch of a row are contiguous: here slots 5 and 6 for the
 *   row 0 |    | 0 1| 2  |    |    last two bins of row 1. Starts has the first slot of each bin;
 *                                  Order has the slots of a row by (y, x), as Growth.h visits them.
 *
 * The passes: find the bounds and lay out the bins; sort the points into blocks of rows that fit
 * into a core's cache; in each block sort the points into bins, build a part of the tree, sort the
 * rows by (y, x), and set duplicates aside, which are neighbours by then; join the blocks. The
 * blocks depend on the points alone, so the result is the same for any number of threads.
 *
 * The bin of a coordinate is a monotone function of it, also in floating point: all points with x
 * in [low, high] are in the columns Column(low) to Column(high). Rounding hides no point.
 *
 * Cost: linear, n log n where density is uneven. Memory: 16 bytes a point for coordinates, 8 for
 * Ids and Order, about 4 for the bins and 3 for the tree (5 in full bins). Construction takes 24
 * more, which stay in Scratch until growth takes them, and a few for full bins.
 */
#ifndef elevation_Bins_BinGrid_h
#define elevation_Bins_BinGrid_h

#include "BoxTree.h"
#include "Options.h"

#include <utility>
#include <vector>

namespace elevation
{

/**
 * Made once, then read by all threads. Some members are moved out by those who need the memory, see
 * PlacedPoints.cxx and GridGrowth.h.
 */
class BinGrid
{
public:
  /**
   * Where the bins are. Functions of a coordinate are total: what lies outside counts for the
   * outermost bin.
   */
  struct Layout
  {
    double OriginX = 0.0, OriginY = 0.0; ///< lower left corner of the points' bounding box
    double PerX = 0.0, PerY = 0.0;       ///< bins per unit of length
    Index Columns = 0, Rows = 0;
    double BinWidth = 0.0, BinHeight = 0.0;
    /** Whether OriginX + k * BinWidth gives the bins' bounds to a thousandth of a bin, and squares
     * are in the range of float. */
    bool HasPlainBins = false;

    Index Column(double x) const { return Cell((x - this->OriginX) * this->PerX, this->Columns); }
    Index Row(double y) const { return Cell((y - this->OriginY) * this->PerY, this->Rows); }

  private:
    static Index Cell(double position, Index count)
    {
      // Written so that "not a number" (an infinite difference times zero) is the first cell.
      return position > 0.0 ? (position < count ? static_cast<Index>(position) : count - 1) : 0;
    }
  };

  /**
   * Bins the finite points and sets duplicates aside.
   * If coordinates are extremely large or small, they are multiplied by a power of two, so that
   * squares of distances neither over- nor underflow; only if that is exact for all of them.
   * @param known  the points' extent, which is moved from; null: not known
   */
  BinGrid(const PointView& points, DuplicatePolicy policy, const Progress& progress,
    int threads = 1, Extent* known = nullptr);

  Index NumberOfPoints() const { return static_cast<Index>(this->Ids.size()); }
  Point2 PointAt(Index slot) const { return { this->X[slot], this->Y[slot] }; }

  /** Slots of the bins firstColumn..lastColumn of a row: [first, second). */
  std::pair<Index, Index> Slots(Index row, Index firstColumn, Index lastColumn) const
  {
    const Index* starts = this->Starts.data() + static_cast<std::size_t>(row) * this->Bins.Columns;
    return { starts[firstColumn], starts[lastColumn + 1] };
  }

  /** The node of the tree above the leaf that holds a slot. */
  BoxTree::Step Lowest(Index slot) const { return this->Tree.Lowest(slot, this->PointAt(slot)); }

  Buffer<double> X, Y; ///< coordinates by slot; eight values beyond the end may be read
  Buffer<Index> Ids;   ///< the input's point id by slot
  double Scale = 1.0;  ///< what the input's coordinates were multiplied by
  Layout Bins;
  Buffer<Index> Order;            ///< all slots by increasing (y, x): row after row
  Buffer<Index> Starts;           ///< first slot of each bin, row by row; last, the number of slots
  // Narrower than the row of bins: the hull's candidates are chosen by it (Hull.cxx).
  Buffer<double> RowLow, RowHigh; ///< range of y of the points in each row
  BoxTree Tree;

  /** Memory left from binning, as much as the triangles need. Reusing it is cheaper than new
     memory, which the system clears. */
  Buffer<Index> Scratch;

  std::vector<Index> Duplicates; ///< input ids set aside because another point has the same x,y
  std::vector<Index> NotFinite;  ///< input ids set aside because a coordinate is not finite
};

} // namespace elevation

#endif
