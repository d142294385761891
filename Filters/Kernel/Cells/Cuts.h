// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The cells of a plane that is cut for several ranks, each with about as many points.
 *
 * The plane is halved, each half again, and so on, always across the longer side of what the points
 * take up there [Bentley 1975]. A node of this tree is a range of cells, [begin, end), and is cut
 * in the middle of the range, where a sample of the points says that the points divide in the same
 * ratio.
 *
 *   +-----+-----+      Four cells, 0 to 3. The first cut, x = a, is that of the range [0, 4), and
 *   |  1  |     |      belongs to cell 2, the middle; [0, 2) and [2, 4) have their own. So Lines
 *   |-----|  3  |      has one cut a cell, from the second cell on, and no pointers.
 *   |  0  |-----|
 *   |     |  2  |
 *   +-----+-----+
 *         a
 *
 * A cell has the points on its low sides and not those on its high sides. So each point has one
 * owner, and points with the same x,y have the same one.
 *
 * [Bentley 1975] Multidimensional binary search trees used for associative searching.
 */
#ifndef elevation_Cells_Cuts_h
#define elevation_Cells_Cuts_h

#include "Kernel/Base/Base.h"
#include "Pieces.h"

#include <vector>

namespace elevation
{

/** The same on all ranks, which have the same sample. */
class Cuts
{
public:
  /**
   * @param[in] sample  finite points; some hundred a cell balance the loads to within a tenth
   * @param[in] count  of cells, at least 1
   */
  Cuts(std::vector<Point2> sample, int count);

  int Count() const { return static_cast<int>(this->Lines.size()); }

  /** The cell that a finite point lies in. Takes log(count) steps. */
  int OwnerOf(Point2 p) const
  {
    int begin = 0, end = this->Count();
    while (end - begin > 1)
    {
      const int middle = MiddleOf(begin, end);
      const Line& line = this->Lines[middle];
      // Products instead of a branch, which nothing could predict for points in no order.
      const int isLower = (line.IsY ? p.Y : p.X) < line.Value ? 1 : 0;
      begin += (1 - isLower) * (middle - begin);
      end -= isLower * (end - middle);
    }
    return begin;
  }

  /** The part of the plane that cells [begin, end) cover; the range must be a node of the tree. */
  Cell CellOf(int begin, int end) const;

  /** Where a node of two or more cells is cut: into [begin, middle) and [middle, end). */
  static int MiddleOf(int begin, int end) { return begin + (end - begin) / 2; }

private:
  struct Line
  {
    bool IsY = false;   // x or y of the points is compared
    double Value = 0.0; // what is less goes to the lower half
  };
  using Iterator = std::vector<Point2>::iterator;

  void Cut(Iterator first, Iterator last, int begin, int end);

  std::vector<Line> Lines; // of the node that is cut at this cell; the first is not used
};

} // namespace elevation

#endif
