// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points sorted into the bins of a uniform grid over their bounding box, for the searches of the
 * triangulation.
 *
 * In: points. Out: the same points in *slots*, row of bins after row of bins, so that the points of
 * neighbouring bins of a row are contiguous; equal points set aside; the rest is a lookup.
 * A bin that holds many points has a grid of its own (a level) over the bounding box of its points,
 * and so on, so that uneven density does not collapse into a few full bins; its points' slots stay
 * within the bin's. The passes: count, prefix sum, fill, subdivide, set duplicates aside.
 *
 * The bin of a coordinate is a monotone function of it, also in floating point: all points with x
 * in [low, high] are in the columns Column(low) to Column(high). Searches lose nothing by rounding.
 *
 * Cost: linear (times the number of levels where density is uneven); 16 + 4 bytes a point, and
 * about 3 for the bins.
 */
#ifndef elevation_BinGrid_h
#define elevation_BinGrid_h

#include "Delaunay.h"
#include "Types.h"

#include <utility>
#include <vector>

namespace elevation
{

class BinGrid
{
public:
  /** One uniform grid: the whole cloud's, or that of one full bin. */
  struct Level
  {
    double OriginX = 0.0, OriginY = 0.0; ///< lower left corner of the points' bounding box
    double PerX = 0.0, PerY = 0.0;       ///< bins a unit of length
    Index Columns = 1, Rows = 1;
    double BinWidth = 0.0, BinHeight = 0.0;
    /** Whether the bins' bounds are where OriginX + k * BinWidth is, to a thousandth of a bin, and
     * single precision holds squares. */
    bool HasPlainBins = false;
    double Spacing = 0.0; ///< about the distance of neighbouring points, were they evenly spread
    std::size_t FirstBin = 0; ///< where its bins begin in Starts; there are Columns * Rows + 1
    std::size_t FirstRow = 0; ///< where its rows begin in RowLow, RowHigh and ChildrenOfRow
    bool HasChildren = false; ///< whether some bins have a level of their own

    Index Column(double x) const { return Cell((x - this->OriginX) * this->PerX, this->Columns); }
    Index Row(double y) const { return Cell((y - this->OriginY) * this->PerY, this->Rows); }

  private:
    static Index Cell(double position, Index count)
    {
      // Written so that "not a number" (an infinite difference times zero) is the first cell.
      return position > 0.0 ? (position < count ? static_cast<Index>(position) : count - 1) : 0;
    }
  };

  /** A bin of a level that has a level of its own. */
  struct Child
  {
    Index Column;
    Index Level;
  };

  /**
   * Bins the finite points and sets duplicates aside.
   * Coordinates are multiplied by a power of two where all of them are extremely large or small, so
   * that squares of distances neither over- nor underflow; this is exact, or not done.
   */
  BinGrid(const PointView& points, DuplicatePolicy policy, const Progress& progress);

  Index NumberOfPoints() const { return static_cast<Index>(this->Ids.size()); }
  Point2 PointAt(Index slot) const { return { this->X[slot], this->Y[slot] }; }

  /** Slots of the bins firstColumn..lastColumn of a row of a level: [first, second). */
  std::pair<Index, Index> Slots(
    const Level& level, Index row, Index firstColumn, Index lastColumn) const
  {
    const Index* starts =
      this->Starts.data() + level.FirstBin + static_cast<std::size_t>(row) * level.Columns;
    return { starts[firstColumn], starts[lastColumn + 1] };
  }

  /** The level whose bin holds the point without further subdivision. */
  const Level& LeafLevel(const Point2& p) const;

  Buffer<double> X, Y;       ///< coordinates by slot; eight more values may be read than there are
  Buffer<Index> Ids;         ///< the input's point id by slot
  double Scale = 1.0;        ///< what the input's coordinates were multiplied by
  std::vector<Level> Levels; ///< the whole cloud's first
  Buffer<Index> Starts;      ///< first slot of each bin, bins row by row, level after level
  std::vector<double> RowLow, RowHigh; ///< range of y of the points in each row of each level
  std::vector<std::vector<Child>> ChildrenOfRow; ///< by increasing column; only rows that have some

  std::vector<Index> Duplicates; ///< input ids set aside because another point has the same x,y
  std::vector<Index> NotFinite;  ///< input ids set aside because a coordinate is not finite

private:
  void Fill(const PointView& points, const Progress& progress);
  void AddLevel(Index begin, Index end, double lowX, double highX, double lowY, double highY);
  void FinishRows(std::size_t level);
  void Subdivide();
  void SetDuplicatesAside(const PointView& points, DuplicatePolicy policy);
};

} // namespace elevation

#endif
