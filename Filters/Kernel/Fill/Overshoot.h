// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Draws values back that are too far beyond those around them.
 *
 * What continues slopes overshoots where slopes do not go on: a steep coast beside a wide gap, say.
 * A value may be beyond a range by half of a given room as it is; from there on it is compressed,
 * so that it never passes the room, and the surface bends instead of being cut off:
 *
 *   room   - - - - - - - .--------        the value that is given
 *                    .-'
 *   room/2 - - - - /
 *   range        /
 */
#ifndef elevation_Fill_Overshoot_h
#define elevation_Fill_Overshoot_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace elevation
{

/** How many values have been drawn back, and by how much at most. */
struct DrawnBack
{
  Index Count = 0;
  double Most = 0.0;

  void Add(double before, double after)
  {
    // NaN is neither.
    this->Count += after < before || after > before ? 1 : 0;
    this->Most = std::max(this->Most, std::fabs(before - after));
  }
};

/** A value no further than the room beyond a range. */
inline double DrawBack(double value, double low, double high, double room)
{
  const double beyond = value > high ? value - high : value < low ? low - value : 0.0;
  const double free = 0.5 * room;
  if (!(beyond > free))
  {
    return value;
  }
  // Its slope is 1 where it begins.
  const double rest = beyond - free;
  const double kept = free > 0.0 ? free + free * (rest / (rest + free)) : 0.0;
  return value > high ? high + kept : low - kept;
}

/** The elevations of a whole surface; those that are not finite do not count. */
struct ElevationRange
{
  double Low = std::numeric_limits<double>::infinity();
  double High = -std::numeric_limits<double>::infinity();

  bool IsEmpty() const { return this->Low > this->High; }
  void Add(double elevation)
  {
    if (std::isfinite(elevation))
    {
      this->Low = std::min(this->Low, elevation);
      this->High = std::max(this->High, elevation);
    }
  }
  /** A value no further than a twentieth of the range beyond it. */
  double DrawnBackTo(double elevation) const;
  /** Draws new elevations back in this way. */
  DrawnBack DrawBackTo(std::vector<double>& elevations) const;
};

/** That of the points of triangles and holes; of regions, points inside count, too. */
ElevationRange RangeOf(
  const Mesh& mesh, const Holes& holes, const PointView& points, const Progress& progress);

/** The lowest and the highest of values near places: what is continuous between these. */
class RangeNearby
{
public:
  /**
   * @param[in] box    of the places
   * @param[in] count  of places
   * @param[in] reach  near is what is no further away; about
   * @param[in] at     at(i) is a place
   */
  template <typename At>
  RangeNearby(const Box& box, std::size_t count, double reach, const At& at,
    const std::vector<double>& values)
    : Low(box.Low)
  {
    // No more cells than places, about.
    const double most = std::sqrt(static_cast<double>(count)) + 1.0;
    this->Columns = static_cast<Index>(std::min(most, std::floor(box.Width() / reach))) + 1;
    this->Rows = static_cast<Index>(std::min(most, std::floor(box.Height() / reach))) + 1;
    this->Width = box.Width() > 0.0 ? box.Width() / this->Columns : 1.0;
    this->Height = box.Height() > 0.0 ? box.Height() / this->Rows : 1.0;
    std::vector<double> lows(std::size_t(this->Columns) * this->Rows, DBL_MAX);
    std::vector<double> highs(lows.size(), -DBL_MAX);
    for (std::size_t i = 0; i < count; ++i)
    {
      const Point2 p = at(i);
      const std::size_t cell = std::size_t(this->RowOf(p)) * this->Columns + this->ColumnOf(p);
      lows[cell] = std::min(lows[cell], values[i]);
      highs[cell] = std::max(highs[cell], values[i]);
    }
    // Of each cell and those around it.
    this->Lows = lows;
    this->Highs = highs;
    for (Index row = 0; row < this->Rows; ++row)
    {
      for (Index column = 0; column < this->Columns; ++column)
      {
        double& low = this->Lows[std::size_t(row) * this->Columns + column];
        double& high = this->Highs[std::size_t(row) * this->Columns + column];
        for (Index y = std::max(0, row - 1); y <= std::min(this->Rows - 1, row + 1); ++y)
        {
          for (Index x = std::max(0, column - 1); x <= std::min(this->Columns - 1, column + 1); ++x)
          {
            low = std::min(low, lows[std::size_t(y) * this->Columns + x]);
            high = std::max(high, highs[std::size_t(y) * this->Columns + x]);
          }
        }
      }
    }
  }

  /** Near one of the places: linear between the centres of cells. */
  double LowAt(const Point2& place) const { return this->Between(place, this->Lows); }
  double HighAt(const Point2& place) const { return this->Between(place, this->Highs); }

private:
  Index ColumnOf(const Point2& p) const
  {
    return std::min(this->Columns - 1, static_cast<Index>((p.X - this->Low.X) / this->Width));
  }
  Index RowOf(const Point2& p) const
  {
    return std::min(this->Rows - 1, static_cast<Index>((p.Y - this->Low.Y) / this->Height));
  }

  double Between(const Point2& p, const std::vector<double>& values) const
  {
    const double x = std::max(0.0, (p.X - this->Low.X) / this->Width - 0.5);
    const double y = std::max(0.0, (p.Y - this->Low.Y) / this->Height - 0.5);
    const Index column = std::min(this->Columns - 1, static_cast<Index>(x));
    const Index row = std::min(this->Rows - 1, static_cast<Index>(y));
    const Index right = std::min(this->Columns - 1, column + 1);
    const Index above = std::min(this->Rows - 1, row + 1);
    const auto at = [&](Index r, Index c) { return values[std::size_t(r) * this->Columns + c]; };
    const double u = std::min(1.0, x - column), v = std::min(1.0, y - row);
    return (1.0 - v) * ((1.0 - u) * at(row, column) + u * at(row, right)) +
      v * ((1.0 - u) * at(above, column) + u * at(above, right));
  }

  Point2 Low;
  Index Columns, Rows;
  double Width, Height;
  std::vector<double> Lows, Highs;
};

} // namespace elevation

#endif
