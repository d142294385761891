// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A uniform grid over items: points, segments or triangles. A cell lists all items that touch it,
 * and perhaps some that miss it by a millionth of a cell. The only spatial index for items that
 * span many cells: BinGrid, BoxTree and LatticeNodes store points, each in one place.
 *
 *   +-----+-----+-----+-----+   In each row of cells, a segment enters those between its leftmost
 *   |     |     |     |# x #|   and rightmost point in that row (#), not all cells of its bounding
 *   +-----+-----+-----+-x---+   box. Of long oblique ones, the boxes would hold nearly all cells.
 *   |     |#    |#x x |#x   |   A triangle enters those between the leftmost and rightmost points
 *   +-----+---x-+-----+-----+   of all its sides, and so its inside as well.
 *   |# x x|# x  |     |     |
 *   +-----+-----+-----+-----+
 *
 * Begins says where the items of each cell begin in Items, as in a sparse matrix stored by rows.
 * Cost: linear in the items and the cells that they touch. These are on average at most about 30
 * for a segment, and 60 for a triangle where triangles do not overlap.
 */
#ifndef elevation_Base_CellGrid_h
#define elevation_Base_CellGrid_h

#include "Extent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace elevation
{

class CellGrid
{
public:
  /** Enters items 0 to count - 1; cornersOf(i) is an array of one to three points. */
  template <typename CornersOf>
  CellGrid(std::size_t count, CornersOf&& cornersOf, const Progress& progress = Progress())
  {
    this->SetExtent(count, cornersOf);
    // Count, sum, fill.
    // Begins is one longer than the cells, and counts are entered one place further on. So after
    // the sums each entry is where its cell begins, and needs no shift.
    this->Begins.assign(static_cast<std::size_t>(this->Columns) * this->Rows + 1, 0);
    for (const std::size_t i : Counted(count))
    {
      ReportStep(progress, i, 2 * count);
      this->ForEachCell(cornersOf(i), [&](std::size_t cell) { ++this->Begins[cell + 1]; });
    }
    for (std::size_t cell = 1; cell < this->Begins.size(); ++cell)
    {
      this->Begins[cell] += this->Begins[cell - 1];
    }
    this->Items.resize(this->Begins.back());
    std::vector<std::size_t> next(this->Begins.begin(), this->Begins.end() - 1);
    for (const std::size_t i : Counted(count))
    {
      ReportStep(progress, count + i, 2 * count);
      this->ForEachCell(
        cornersOf(i), [&](std::size_t cell) { this->Items[next[cell]++] = static_cast<Index>(i); });
    }
  }

  /** The items of a cell, by increasing number. */
  const Index* Begin(std::size_t cell) const { return this->Items.data() + this->Begins[cell]; }
  const Index* End(std::size_t cell) const { return this->Begin(cell + 1); }

  /** Finds the cell of a point. @return false outside the bounding box of all items */
  bool FindCell(const Point2& p, std::size_t& cell) const
  {
    // A place outside touches no item. Without this test it would be moved into a cell at the
    // border.
    // NaN counts as outside.
    if (!this->Bounds.Contains(p))
    {
      return false;
    }
    const Point2 at = this->InCells(p);
    cell = static_cast<std::size_t>(CellOf(at.Y, this->Rows)) * this->Columns +
      CellOf(at.X, this->Columns);
    return true;
  }

  /** Calls visit for all items that may touch a point, once each. */
  template <typename Visitor>
  void Visit(const Point2& p, Visitor&& visit) const
  {
    std::size_t cell;
    if (this->FindCell(p, cell))
    {
      this->VisitItems(cell, visit);
    }
  }

  /** The same for a segment or triangle; may visit an item repeatedly. */
  template <std::size_t Count, typename Visitor>
  void Visit(const std::array<Point2, Count>& corners, Visitor&& visit) const
  {
    this->ForEachCell(
      corners, [&](std::size_t cell) { this->VisitItems(cell, visit); });
  }

  /** The same for the square around a point: all that is at most so far from it in x and in y. */
  template <typename Visitor>
  void VisitAround(const Point2& p, double reach, Visitor&& visit) const
  {
    const std::array<Point2, 4> square{ { { p.X - reach, p.Y - reach },
      { p.X + reach, p.Y - reach }, { p.X + reach, p.Y + reach }, { p.X - reach, p.Y + reach } } };
    this->Visit(square, visit);
  }

  /** Calls visit(cell) for every cell that an item touches, row by row. */
  template <std::size_t Count, typename Visitor>
  void ForEachCell(const std::array<Point2, Count>& corners, Visitor&& visit) const
  {
    // The grid may be asked for items far outside: these touch nothing. Of others, only what is
    // inside the grid is walked.
    const Box box = BoxOf(corners);
    if (!this->Bounds.Intersects(box))
    {
      return;
    }
    // The same place may be rounded into two cells, once as part of an item and once as a point
    // that is looked up. The margin enters items on both sides of a border between cells.
    constexpr double margin = 1e-6; // of a cell
    constexpr double far = 1e8;     // in cells; within it rounding errors are far below the margin
    const Point2 low = this->InCells(box.Low), high = this->InCells(box.High);
    const int firstRow = CellOf(low.Y - margin, this->Rows);
    const int lastRow = CellOf(high.Y + margin, this->Rows);
    const int firstColumn = CellOf(low.X - margin, this->Columns);
    const int lastColumn = CellOf(high.X + margin, this->Columns);
    // An item in one row or one column has nothing to clip. One with a corner very far away is
    // entered in all cells of its box, because the rounding error of its slope would exceed the
    // margin.
    const bool isClippedToRows = firstRow < lastRow && firstColumn < lastColumn &&
      std::max({ -low.X, -low.Y, high.X, high.Y }) < far;
    std::array<Point2, Count> at = corners;
    for (std::size_t i = 0; i < Count && isClippedToRows; ++i)
    {
      at[i] = this->InCells(corners[i]);
    }
    for (int row = firstRow; row <= lastRow; ++row)
    {
      int begin = firstColumn, end = lastColumn;
      if (isClippedToRows)
      {
        // The wrong way around, so the first side replaces both.
        double left = high.X, right = low.X;
        // A segment is one side, not also its way back; a triangle has three, a square four; a
        // point is a side to itself.
        for (std::size_t i = 0; i + (Count == 2) < Count; ++i)
        {
          Widen(at[i], at[(i + 1) % Count], row - margin, row + 1.0 + margin, left, right);
        }
        begin = CellOf(left - margin, this->Columns);
        end = CellOf(right + margin, this->Columns);
      }
      for (int column = begin; column <= end; ++column)
      {
        visit(static_cast<std::size_t>(row) * this->Columns + column);
      }
    }
  }

private:
  template <typename Visitor>
  void VisitItems(std::size_t cell, Visitor&& visit) const
  {
    CountWork(static_cast<std::size_t>(this->End(cell) - this->Begin(cell)));
    std::for_each(this->Begin(cell), this->End(cell), visit);
  }

  /**
   * Fits columns and rows to the items' extents in x and y: parallel lines share few cells.
   *
   * With s the sum of the items' widths in parts of the whole width, and t that of their heights,
   * items touch about s * columns + t * rows cells. For a given number of cells, that is least
   * where both terms are equal, columns : rows = t : s, and then it is 2 sqrt(cells s t). The
   * number of cells for 30 touched cells an item follows from this.
   */
  template <typename CornersOf>
  void SetExtent(std::size_t count, CornersOf& cornersOf)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      this->Bounds.Join(BoxOf(cornersOf(i)));
    }
    if (count == 0)
    {
      return;
    }
    // Scaled so that differences stay in the range of double.
    const double largest = std::max({ std::fabs(this->Bounds.Low.X), std::fabs(this->Bounds.Low.Y),
      std::fabs(this->Bounds.High.X), std::fabs(this->Bounds.High.Y) });
    this->Scale = largest > 1e150 ? 0x1p-600 : (largest < 1e-150 ? 0x1p600 : 1.0);
    this->Corner = { this->Bounds.Low.X * this->Scale, this->Bounds.Low.Y * this->Scale };
    // A power of two scales without rounding.
    const double width = this->Bounds.High.X * this->Scale - this->Corner.X;
    const double height = this->Bounds.High.Y * this->Scale - this->Corner.Y;

    // The sums of the items' extents, in parts of the whole extent, plus one.
    double alongX = 1.0, alongY = 1.0;
    for (std::size_t i = 0; i < count; ++i)
    {
      const Box box = BoxOf(cornersOf(i));
      alongX += width > 0.0 ? (box.High.X * this->Scale - box.Low.X * this->Scale) / width : 0.0;
      alongY += height > 0.0 ? (box.High.Y * this->Scale - box.Low.Y * this->Scale) / height : 0.0;
    }
    // Two cells an item; fewer where items would touch more than about 30 cells each. The last
    // limit keeps Begins below a gigabyte.
    const double most = 30.0 * static_cast<double>(count);
    const double cells = std::min(
      { 2.0 * static_cast<double>(count), most * most / (4.0 * alongX * alongY), 100000000.0 });
    // Items without width share one column. Others have the ratio t : s, but at least one column,
    // and no more columns than cells.
    const double columns = width > 0.0
      ? std::min(std::max(std::sqrt(cells * alongY / alongX), 1.0), std::max(cells, 1.0))
      : 1.0;
    const double rows = width > 0.0 ? cells / columns : std::min(cells, most / alongY);
    this->Columns = static_cast<int>(columns);
    this->Rows = static_cast<int>(std::max(rows, 1.0));
    // An extent so small that the inverse of a cell's size would overflow is one column or row.
    this->PerX = width > 1e-290 ? this->Columns / width : 0.0;
    this->PerY = height > 1e-290 ? this->Rows / height : 0.0;
  }

  /** A position in cells; subtracting the corner first loses hardly any precision. */
  Point2 InCells(const Point2& p) const
  {
    return { (p.X * this->Scale - this->Corner.X) * this->PerX,
      (p.Y * this->Scale - this->Corner.Y) * this->PerY };
  }
  // Positions beyond the grid count to its nearest cell. The comparisons come before the
  // conversion, because the conversion of a double that no int can hold is undefined.
  static int CellOf(double position, int count)
  {
    return position > 0.0 ? (position < count ? static_cast<int>(position) : count - 1) : 0;
  }

  /** Extends a range of x to the part of a segment between bottom and top. */
  static void Widen(
    const Point2& a, const Point2& b, double bottom, double top, double& left, double& right)
  {
    // From the low end, so that a side has the same range in both directions.
    const Point2 &low = b.Y < a.Y ? b : a, &high = b.Y < a.Y ? a : b;
    if (high.Y < bottom || low.Y > top)
    {
      return;
    }
    double first = std::min(a.X, b.X), last = std::max(a.X, b.X);
    // Infinite or NaN where the segment is horizontal: then the whole range from a to b counts.
    const double slope = (high.X - low.X) / (high.Y - low.Y);
    if (std::isfinite(slope))
    {
      const double x0 = low.X + (bottom - low.Y) * slope, x1 = low.X + (top - low.Y) * slope;
      // Rounding may carry x0 and x1 beyond the ends of the segment.
      first = std::max(first, std::min(x0, x1));
      last = std::min(last, std::max(x0, x1));
    }
    left = std::min(left, first);
    right = std::max(right, last);
  }

  Box Bounds; ///< the bounding box of all items
  double Scale = 1.0;
  Point2 Corner{ 0.0, 0.0 }; ///< the lower left of the box, scaled
  double PerX = 0.0, PerY = 0.0;
  int Columns = 1, Rows = 1;
  std::vector<std::size_t> Begins;
  std::vector<Index> Items;
};

} // namespace elevation

#endif
