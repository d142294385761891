// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "NearTriangles.h"

#include "Rings.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace elevation
{

namespace
{

/**
 * A raster over the box of the rings and a margin. A cell that no ring touches is entirely inside
 * or outside. Everything beyond the raster is outside, as the cells at its rim are.
 *
 *   o o o o o o o o o     # touched by a ring: triangles here are near
 *   o o # # # # o o o     o outside, i inside: what the cell before or below is, if no ring touches
 *   o # # i i # # o o       that one, else by a location
 *   o # i i i i # o o
 *   o # # # # # # o o     A triangle of few cells is settled by one look at KindsAround, a larger
 *   o o o o o o o o o     one by whether a touched cell is in its box.
 */
class RingRaster
{
public:
  enum Kind : char
  {
    Inside = 0,
    Outward = 1,
    Near = 2 ///< perhaps touched by a ring
  };

  RingRaster(const std::vector<Point2>& points, const Rings& rings, double numberOfTriangles)
  {
    Box box;
    for (const Index id : rings.Vertices)
    {
      box.Add(points[id]);
    }
    const Point2 low = box.Low, high = box.High;
    const double size = std::max({ -low.X, -low.Y, high.X, high.Y });
    const double width = box.Width(), height = box.Height();
    // A few triangles per cell. At most 512 x 512 cells, whose kinds and sums take 1.5 MB: caches
    // hold them.
    const double cells = std::min(262144.0, std::max(64.0, numberOfTriangles / 8.0));
    const double columns = std::sqrt(cells * (width / height));
    // Cells must be so large that the rounding of coordinates does not matter, and not too many. Of
    // a flat box, the width or height may be 0: the larger of the other limits applies.
    this->Side = std::max(
      { width / std::min(512.0, std::max(1.0, columns)), height / 4096.0, 1e-9 * size, 1e-100 });
    this->Usable = size < 1e100;
    if (!this->Usable)
    {
      return;
    }
    this->Low = { low.X - Margin * this->Side, low.Y - Margin * this->Side };
    this->Columns = static_cast<Index>(std::ceil(width / this->Side)) + 2 * Margin;
    this->Rows = static_cast<Index>(std::ceil(height / this->Side)) + 2 * Margin;
    this->CellsPerUnit = 1.0 / this->Side;
    this->Kinds.assign(static_cast<std::size_t>(this->Columns) * this->Rows, Outward);
    this->Draw(points, rings);
    this->FindInside(points, rings);
    this->FindTouched();
  }

  bool IsUsable() const { return this->Usable; }

  /** The kind of everything within Reach() of p along x and along y. */
  Kind KindAround(Point2 p) const
  {
    return static_cast<Kind>(
      this->KindsAround[this->CellAt(this->ColumnOf(p.X), this->RowOf(p.Y))]);
  }
  // A little less than two cells, so that rounding in ColumnOf() does not matter.
  double Reach() const { return 0.999 * Around * this->Side; }

  /** The kind of everything in a box: Near if it touches a cell that a ring touches. */
  Kind KindOf(Point2 low, Point2 high) const
  {
    const Index left = this->ColumnOf(low.X), right = this->ColumnOf(high.X);
    const Index bottom = this->RowOf(low.Y), top = this->RowOf(high.Y);
    // No ring passes between the cells of the box, so all are of one kind.
    return this->Touched.AreAny(left, bottom, right, top)
      ? Near
      : static_cast<Kind>(this->Kinds[this->CellAt(left, bottom)]);
  }

private:
  static constexpr Index Around = 2; ///< how many cells KindAround() looks in each direction
  // Cells around the box of the rings. The cells at the rim stand for everything beyond, so no ring
  // may be within their reach; one cell more, as rings are drawn slightly thick.
  static constexpr Index Margin = Around + 2;

  // Monotone: a point between two others is in a cell between theirs.
  Index ColumnOf(double x) const
  {
    return CellOf((x - this->Low.X) * this->CellsPerUnit, this->Columns);
  }
  Index RowOf(double y) const { return CellOf((y - this->Low.Y) * this->CellsPerUnit, this->Rows); }
  static Index CellOf(double position, Index count)
  {
    return static_cast<Index>(std::min(std::max(0.0, position), count - 1.0));
  }
  std::size_t CellAt(Index column, Index row) const
  {
    return static_cast<std::size_t>(row) * this->Columns + column;
  }
  /** Marks the cells that an edge touches, or passes within a fraction of a cell. */
  void Draw(const std::vector<Point2>& points, const Rings& rings)
  {
    // A thousandth of a cell, and a cell is at least 1e-9 of the largest coordinate: so this is far
    // above the rounding errors of positions.
    const double near = 1e-3 * this->Side;
    for (auto [a, b] : EdgesOf(points, rings))
    {
      if (b.Y < a.Y)
      {
        std::swap(a, b);
      }
      // Where the edge, from its low to its high end, is at a height; beyond its ends, at the
      // nearest end.
      const auto at = [low = a, high = b](double y) {
        const double share = (y - low.Y) / (high.Y - low.Y);
        return low.X + std::max(0.0, std::min(1.0, share)) * (high.X - low.X);
      };
      const bool isLevel = !(b.Y > a.Y);
      const Index last = this->RowOf(b.Y + near);
      for (Index row = this->RowOf(a.Y - near); row <= last; ++row)
      {
        const double from = isLevel ? a.X : at(this->Low.Y + row * this->Side - near);
        const double to = isLevel ? b.X : at(this->Low.Y + (row + 1) * this->Side + near);
        const Index end = this->ColumnOf(std::max(from, to) + near);
        for (Index column = this->ColumnOf(std::min(from, to) - near); column <= end; ++column)
        {
          this->Kinds[this->CellAt(column, row)] = Near;
        }
      }
    }
  }

  /** Finds the kind of each other cell: that of the cell before or below, or by a location. */
  void FindInside(const std::vector<Point2>& points, const Rings& rings)
  {
    const RingLocator locator(points, rings);
    // Row and column 0 are at the rim and stay Outward.
    for (Index row = 1; row < this->Rows; ++row)
    {
      for (Index column = 1; column < this->Columns; ++column)
      {
        char& kind = this->Kinds[this->CellAt(column, row)];
        const char before = this->Kinds[this->CellAt(column - 1, row)];
        const char below = this->Kinds[this->CellAt(column, row - 1)];
        if (kind == Near)
        {
          continue;
        }
        // Two neighbours that no ring touches have no ring between them.
        if (before != Near || below != Near)
        {
          kind = before != Near ? before : below;
          continue;
        }
        // Rare: behind rings. The locator wants a triangle that no ring cuts; this one is inside
        // the cell.
        const double offset = 0.25 * this->Side;
        const Point2 p{ this->Low.X + (column + 0.5) * this->Side,
          this->Low.Y + (row + 0.5) * this->Side };
        kind = locator.IsInside(p, { p.X + offset, p.Y }, { p.X, p.Y + offset }) ? Inside : Outward;
      }
    }
  }

  /** Finds in which rectangles, and around which cells, there is a touched one. */
  void FindTouched()
  {
    this->Touched = MarkedCells(this->Columns, this->Rows);
    for (Index row = 0; row < this->Rows; ++row)
    {
      for (Index column = 0; column < this->Columns; ++column)
      {
        if (this->Kinds[this->CellAt(column, row)] == Near)
        {
          this->Touched.Mark(column, row, column, row);
        }
      }
    }
    this->Touched.Finish();
    this->KindsAround = this->Kinds;
    for (Index row = 0; row < this->Rows; ++row)
    {
      const Index bottom = std::max(row - Around, 0);
      const Index top = std::min(row + Around, this->Rows - 1);
      for (Index column = 0; column < this->Columns; ++column)
      {
        if (this->Touched.AreAny(std::max(column - Around, 0), bottom,
              std::min(column + Around, this->Columns - 1), top))
        {
          this->KindsAround[this->CellAt(column, row)] = Near;
        }
      }
    }
  }

  bool Usable = false;
  Point2 Low{ 0.0, 0.0 };
  double Side = 0.0;
  double CellsPerUnit = 0.0;
  Index Columns = 0;
  Index Rows = 0;
  std::vector<char> Kinds;
  std::vector<char> KindsAround;
  MarkedCells Touched{ 0, 0 };
};

/**
 * Classifies the triangles that no ring touches, and lists the others. The sweep visits the fan of
 * each vertex in turn, so the cells around that vertex are looked up once for its whole fan.
 */
struct Classifier
{
  const RingRaster& Raster;
  char* Flags;
  std::vector<Index> Near;
  const double Reach;
  double LastReach = 0.0;
  char Around = RingRaster::Near;

  static double ReachOf(Point2 p, Point2 q)
  {
    return std::max(std::fabs(q.X - p.X), std::fabs(q.Y - p.Y));
  }

  void Begin(const SweptVertex& p, const SweptVertex& a)
  {
    this->Around = this->Raster.KindAround(p.Position);
    this->LastReach = ReachOf(p.Position, a.Position);
  }

  void Visit(Index t, const SweptVertex& first, const SweptVertex& second, const SweptVertex& third)
  {
    // The triangles of a fan share sides: the third corner of one is the second of the next, so its
    // reach is known.
    const Point2 p = first.Position, a = second.Position, b = third.Position;
    const double reach = ReachOf(p, b);
    // All corners near the first one: the whole triangle is.
    const bool isShort = (reach <= this->Reach) & (this->LastReach <= this->Reach);
    this->LastReach = reach;
    if (isShort & (this->Around != RingRaster::Near))
    {
      this->Flags[t] = this->Around;
      return;
    }
    const char kind =
      this->Raster.KindOf({ std::min({ p.X, a.X, b.X }), std::min({ p.Y, a.Y, b.Y }) },
        { std::max({ p.X, a.X, b.X }), std::max({ p.Y, a.Y, b.Y }) });
    this->Flags[t] = kind;
    if (kind == RingRaster::Near)
    {
      this->Near.push_back(t);
    }
  }
};

} // namespace

std::optional<SweptAlongRings> SweepAlongRings(const TriangleList& list,
  const std::vector<Point2>& points, const Rings& rings, double numberOfTriangles, int threads,
  const Progress& progress)
{
  Stages stages(progress, { 90, 10 });
  // The raster depends on the rings and the number of all triangles alone: parts of a mesh have the
  // same.
  const RingRaster raster(points, rings, numberOfTriangles);
  if (!raster.IsUsable())
  {
    return std::nullopt;
  }
  SweptAlongRings swept;
  if (list.Count == 0)
  {
    return swept;
  }
  swept.IsOutward.resize(list.Count);
  TriangleSweep<Classifier> sweep(list, threads);
  const Classifier classifier{ raster, swept.IsOutward.data(), {}, raster.Reach(), 0.0,
    RingRaster::Near };
  if (!sweep.Run(classifier, stages.Next()))
  {
    return std::nullopt;
  }
  swept.Border = sweep.Border(stages.Next());
  // Each thread has listed its own.
  for (const Classifier* visitor : sweep.Visitors())
  {
    swept.Near.insert(swept.Near.end(), visitor->Near.begin(), visitor->Near.end());
  }
  // Which thread found a triangle no longer shows.
  std::sort(swept.Near.begin(), swept.Near.end());
  return swept;
}

std::optional<SweptAlongRings> FindNearTriangles(const TriangleList& list,
  const std::vector<Point2>& points, const Rings& rings, int threads, const Progress& progress)
{
  Stages stages(progress, { 90, 10 });
  std::optional<SweptAlongRings> swept =
    SweepAlongRings(list, points, rings, list.Count, threads, stages.Next());
  return swept && CoversOnce(swept->Border, list.Points, stages.Next()) ? std::move(swept)
                                                                        : std::nullopt;
}

} // namespace elevation
