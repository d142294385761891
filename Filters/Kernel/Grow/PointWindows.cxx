// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointWindows.h"

#include "Packing.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Kernel/Grow/PointWindows.cxx"
#include "Kernel/Bins/Vectors.h"

#if ELEVATION_IS_VECTOR
HWY_BEFORE_NAMESPACE();
namespace elevation
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

// At most eight, as rows have about six points in a window.
constexpr hn::CappedTag<float, 8> Floats;
constexpr hn::CappedTag<std::int32_t, 8> Integers;
constexpr hn::Rebind<std::uint8_t, decltype(Floats)> Bytes;
constexpr int InVector = static_cast<int>(hn::MaxLanes(Floats));

/** The lanes for which a comparison holds, as bits. */
template <typename Tag>
HWY_INLINE unsigned int BitsOf(Tag tag, hn::Mask<Tag> mask)
{
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(tag, mask, bits);
  return bits[0];
}

/** Writes the vectors of a window from a lane on; lanes need not be aligned. */
HWY_INLINE void Write(PointWindows::Window& window, int lane, hn::Vec<decltype(Floats)> x,
  hn::Vec<decltype(Floats)> y, hn::Vec<decltype(Integers)> slots)
{
  hn::StoreU(x, Floats, window.X + lane);
  hn::StoreU(y, Floats, window.Y + lane);
  hn::StoreU(hn::MulAdd(x, x, hn::Mul(y, y)), Floats, window.Square + lane);
  hn::StoreU(slots, Integers, window.Slots + lane);
}

/** Ends a window after so many points. */
HWY_INLINE void Close(PointWindows::Window& window, int count)
{
  window.Lanes = count <= PointWindows::FewLanes ? PointWindows::FewLanes : PointWindows::MostLanes;
  // Without a branch for most windows.
  for (int lane = count; lane < count + 16; lane += InVector)
  {
    hn::StoreU(hn::NaN(Floats), Floats, window.X + lane);
  }
  for (int lane = count + 16; lane < window.Lanes; lane += InVector)
  {
    hn::StoreU(hn::NaN(Floats), Floats, window.X + lane);
  }
}

/**
 * Fills a window with the points of some columns of rows, relative to its vertex.
 * @return false if there are more than most
 */
bool CopyRows(const PointWindows::NearRow* rows, int number, Index firstColumn, Index endColumn,
  int most, PointWindows::Window& window)
{
  const Index place = window.Origin - rows->FirstSlot;
  const auto x0 = hn::Set(Integers, rows->X[place]), y0 = hn::Set(Integers, rows->Y[place]);
  const auto lanes = hn::Iota(Integers, 0);
  window.OriginLane = window.Origin - rows->Starts[firstColumn];
  int count = 0;
  for (int k = 0; k < number; ++k)
  {
    const PointWindows::NearRow& row = rows[k];
    const Index first = row.Starts[firstColumn], size = row.Starts[endColumn] - first;
    if (count + size > most)
    {
      return false;
    }
    const std::int32_t* const x = row.X + (first - row.FirstSlot);
    const std::int32_t* const y = row.Y + (first - row.FirstSlot);
    // Whole vectors: the excess is overwritten by the next row, or by NaN. For most rows, eight are
    // enough: no branch depends on whether they are.
    for (int i = 0; i < 8 || i < size; i += InVector)
    {
      Write(window, count + i, hn::ConvertTo(Floats, hn::Sub(hn::LoadU(Integers, x + i), x0)),
        hn::ConvertTo(Floats, hn::Sub(hn::LoadU(Integers, y + i), y0)),
        hn::Add(hn::Set(Integers, first + i), lanes));
    }
    count += size;
  }
  Close(window, count);
  return true;
}

/**
 * Fills a window with the points of a neighborhood in a box of a size around the vertex, which is
 * at (originX, originY) there.
 * @return false if there are too many
 */
bool CopyBox(const Neighborhood& around, float originX, float originY, float size,
  PointWindows::Window& window)
{
  // The box that is copied is larger than what Left, Right and Top promise by 0.0005 sides, more
  // than the rounding of a coordinate; the vertex's own row needs the same below.
  const auto across = hn::Set(Floats, 0.5505f * size), up = hn::Set(Floats, 0.9005f * size);
  const auto down = hn::Set(Floats, -0.0005f);
  const auto x0 = hn::Set(Floats, originX), y0 = hn::Set(Floats, originY);
  const auto origin = hn::Set(Integers, window.Origin);
  std::uint64_t originLanes = 0;
  int count = 0;
  for (int i = 0; i < around.Count; i += InVector)
  {
    const auto x = hn::Sub(hn::LoadU(Floats, around.X + i), x0);
    const auto y = hn::Sub(hn::LoadU(Floats, around.Y + i), y0);
    const auto isIn = hn::And(hn::Le(hn::Abs(x), across), hn::And(hn::Ge(y, down), hn::Le(y, up)));
    const unsigned int in = BitsOf(Floats, isIn);
    // The points in the box move to the front; the next vectors overwrite the rest.
    const auto places = hn::PromoteTo(Integers, hn::LoadU(Bytes, Packings.Places[in]));
    const auto which = hn::IndicesFromVec(Floats, places);
    const auto slots = hn::TableLookupLanes(
      hn::LoadU(Integers, around.Slots + i), hn::IndicesFromVec(Integers, places));
    Write(window, count, hn::TableLookupLanes(x, which), hn::TableLookupLanes(y, which), slots);
    originLanes |= static_cast<std::uint64_t>(BitsOf(Integers, hn::Eq(slots, origin))) << count;
    count += static_cast<int>(hwy::PopCount(in));
    if (count > PointWindows::Capacity)
    {
      return false;
    }
  }
  Close(window, count);
  // Behind the points of a vector, its first one may stand again.
  window.OriginLane = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(originLanes));
  return true;
}
} // namespace HWY_NAMESPACE
} // namespace elevation
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace elevation
{
namespace
{
using RowCopier = bool(const PointWindows::NearRow*, int, Index, Index, int, PointWindows::Window&);
constexpr RowCopier* RowCopiers[NumberOfInstructionSets] = ELEVATION_VERSIONS(CopyRows);
using BoxCopier = bool(const Neighborhood&, float, float, float, PointWindows::Window&);
constexpr BoxCopier* BoxCopiers[NumberOfInstructionSets] = ELEVATION_VERSIONS(CopyBox);

// The passes: EnterRow() rounds the points of four rows of bins; Gather...() copies those of a
// window relative to its vertex; SetBounds() records how far the window reaches, for the proof.
// Where bins are full, GatherBox() takes the place of all three.

/** Columns and rows of the windows of bins, the larger first. */
struct Shape
{
  Index Columns, Rows;
};
constexpr Shape Shapes[] = { { 6, 4 }, { 3, 3 }, { 3, 2 } };

/**
 * A coordinate in whole units from the grid's corner, rounded to the nearest. With this number
 * added, the lowest bits of a double are a whole number: a loop of this is vectorized everywhere.
 */
inline std::int32_t Units(double value, double from, double perUnit)
{
  const double shifted = (value - from) * perUnit + 0x1.8p52;
  std::int64_t bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  return static_cast<std::int32_t>(bits);
}

} // namespace

/**
 * Chooses the unit, as large as the ranges of float and of 32 bits allow; windows of bins are not
 * used where bins are too unequal for one unit.
 */
PointWindows::PointWindows(const BinGrid& grid, InstructionSet instructions)
  : Grid(grid)
  , Instructions(instructions)
  , Leaves(grid, instructions)
{
  if (instructions == InstructionSet::Scalar)
  {
    return;
  }
  const BinGrid::Layout& bins = grid.Bins;
  // Two coordinates are rounded, then their difference. A box reaches 0.9 sides upwards and 0.55 to
  // each side: 1.1 is more than its diagonal.
  this->BoxBounds.Set(1.1, (2.0 * Neighborhoods::MostSides + 1.2) * Roundoff, 0.002);
  if (!bins.HasPlainBins)
  {
    return;
  }
  // Products of four coordinates stay in the range of float, differences within 32 bits. A bin has
  // at most 2^22 units, so coordinates in a window have about as many bits as a float; and at least
  // 2^12, so that rounding to units hides little. The whole grid has at most 2^30 units.
  const double width = bins.BinWidth, height = bins.BinHeight;
  const double extent = std::max(bins.Columns * width, bins.Rows * height);
  const double perUnit = std::min(0x1p30 / extent, 0x1p22 / std::max(width, height));
  if (perUnit * std::min(width, height) < 0x1p12)
  {
    return;
  }
  this->PerUnit = perUnit;
  for (int shape = 0; shape < NumberOfShapes; ++shape)
  {
    // From a vertex in the middle columns, or on their border, and in the lowest row.
    const double across = (Shapes[shape].Columns / 2 + 1) * width * perUnit;
    const double up = Shapes[shape].Rows * height * perUnit;
    const double reach = std::sqrt(across * across + up * up);
    // Two coordinates are rounded to whole units, their difference to single precision; bounds of
    // bins are known to a thousandth of a bin.
    this->ShapeBounds[shape].Set(
      reach, 1.1 + Roundoff * reach, 0.01 * std::max(width, height) * perUnit);
  }
  for (Row& row : this->Rows)
  {
    row.X.resize(RowRoom);
    row.Y.resize(RowRoom);
  }
  // There are no points beyond the grid's border, so a disc may reach as far there as it likes.
  // These bounds leave room for differences with any coordinate in 32 bits.
  constexpr std::int32_t far = (1 << 30) - 1;
  this->ColumnBounds.resize(static_cast<std::size_t>(bins.Columns) + 1);
  for (Index column = 1; column < bins.Columns; ++column)
  {
    this->ColumnBounds[column] = static_cast<std::int32_t>(column * width * perUnit);
  }
  this->ColumnBounds[0] = -far;
  this->ColumnBounds[bins.Columns] = 2 * (far - 1);
  this->Nothing.assign(static_cast<std::size_t>(bins.Columns) + 1, 0);
}

// The errors of WideApexSearch.h, for products of the largest coordinates that a window can have:
// one set serves all windows of a shape. slack rounds the constants up.
void PointWindows::Bounds::Set(double reach, double error, double margin)
{
  const double square = reach * reach;
  const double slack = 1.001; // for rounding below
  this->ReachSquared = static_cast<float>(square);
  this->CoordinateError = static_cast<float>(slack * error);
  this->CrossError = static_cast<float>(slack * 3.0 * (reach * error + Roundoff * square));
  this->DotError = 2.0f * this->CrossError;
  this->ComparisonError =
    static_cast<float>(slack * square * (24.0 * reach * error + 32.0 * Roundoff * square));
  this->Margin = static_cast<float>(margin);
}

bool PointWindows::Gather(Index origin, Index next)
{
  if (this->Instructions == InstructionSet::Scalar)
  {
    return false;
  }
  // Two windows alternate: the one gathered ahead by the last call is nearly always the one asked
  // for now.
  Window* other = this->Windows + (this->InUse == this->Windows);
  if (other->Origin == origin)
  {
    std::swap(this->InUse, other);
  }
  else
  {
    this->InUse->Origin = origin;
    this->GatherInto(*this->InUse);
  }
  other->Origin = next;
  if (next != None)
  {
    this->GatherInto(*other);
  }
  return this->InUse->Lanes > 0;
}

// Tried from the largest window to the smallest; a window that is too small only costs more
// fallbacks.
void PointWindows::GatherInto(Window& window)
{
  if (this->PerUnit > 0.0)
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    const Point2 p = this->Grid.PointAt(window.Origin);
    const Index row = bins.Row(p.Y);
    if (row != this->CurrentRow)
    {
      this->EnterRow(row);
    }
    // The column border that is nearest to the vertex is the middle of the six columns, so a window
    // reaches at least 2.5 columns to each side.
    const Index first = static_cast<Index>((p.X - bins.OriginX) * bins.PerX + 0.5) - 3;
    const Index column = bins.Column(p.X);
    const Index* const own = this->Near[0].Starts + column;
    // A bin with more points than a window holds would fail in all three shapes.
    if (this->AreNearRead && own[1] - own[0] <= Capacity &&
      (this->GatherBins(window, first, 0) || this->GatherBins(window, column - 1, 1) ||
        this->GatherBins(window, column - 1, 2)))
    {
      return;
    }
  }
  if (!this->GatherBox(window))
  {
    window.Lanes = 0;
  }
}

/** Reads the rows that windows of a row's vertices need. */
void PointWindows::EnterRow(Index number)
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  this->CurrentRow = number;
  this->AreNearRead = true;
  // Vertices come from the lowest up. So mostly three of the four rows are known, and the new one
  // replaces the one that is left behind.
  for (Index r = number; r < number + MostRows; ++r)
  {
    Row& row = this->Rows[r % MostRows];
    // A row beyond the last one looks like a row of empty bins.
    if (r >= bins.Rows)
    {
      row.Starts = this->Nothing.data();
      row.FirstSlot = 0;
      row.Number = None;
    }
    else if (row.Number != r)
    {
      row.Number = r;
      this->ReadRow(row);
    }
    this->AreNearRead = this->AreNearRead && (row.Number == None || row.IsRead);
    this->Near[r - number] = { row.X.data(), row.Y.data(), row.Starts, row.FirstSlot };
  }
  for (int shape = 0; shape < NumberOfShapes; ++shape)
  {
    const Index above = std::min(number + Shapes[shape].Rows, bins.Rows);
    this->TopBounds[shape] = above == bins.Rows
      ? std::numeric_limits<std::int32_t>::max()
      : static_cast<std::int32_t>(above * bins.BinHeight * this->PerUnit);
  }
}

/** Rounds the coordinates of a row's points to units. */
void PointWindows::ReadRow(Row& row)
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  const auto slots = this->Grid.Slots(row.Number, 0, bins.Columns - 1);
  const std::size_t count = slots.second - slots.first;
  row.FirstSlot = slots.first;
  row.Starts = this->Grid.Starts.data() + static_cast<std::size_t>(row.Number) * bins.Columns;
  // In rows with more points, most bins are full, and boxes serve better than rounding all of them.
  row.IsRead = count <= MostPerBin * static_cast<std::size_t>(bins.Columns);
  if (!row.IsRead)
  {
    return;
  }
  if (row.X.size() < count + RowRoom)
  {
    row.X.resize(count + count / 4 + RowRoom);
    row.Y.resize(count + count / 4 + RowRoom);
  }
  const double* const x = this->Grid.X.data() + slots.first;
  const double* const y = this->Grid.Y.data() + slots.first;
  for (std::size_t i = 0; i < count; ++i)
  {
    row.X[i] = Units(x[i], bins.OriginX, this->PerUnit);
    row.Y[i] = Units(y[i], bins.OriginY, this->PerUnit);
  }
}

/** How far a window of bins reaches from the vertex. */
void PointWindows::SetBounds(Window& window, int shape, Index firstColumn, Index endColumn,
  std::int32_t originX, std::int32_t originY) const
{
  window.IsBox = false;
  window.Left = static_cast<float>(originX - this->ColumnBounds[firstColumn]);
  window.Right = static_cast<float>(this->ColumnBounds[endColumn] - originX);
  window.Top = static_cast<float>(this->TopBounds[shape] - originY);
  window.Errors = &this->ShapeBounds[shape];
}

/**
 * Gathers the points of bins. An odd number of columns has the vertex's in the middle.
 * @return false if there are too many
 */
bool PointWindows::GatherBins(Window& window, Index firstColumn, int shape)
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  const Index endColumn = std::min(firstColumn + Shapes[shape].Columns, bins.Columns);
  firstColumn = std::max(firstColumn, 0);
  // With more in the largest window, each search would take twice as long.
  if (!RowCopiers[static_cast<int>(this->Instructions)](this->Near, Shapes[shape].Rows, firstColumn,
        endColumn, shape == 0 ? FewLanes : Capacity, window))
  {
    return false;
  }
  const Index place = window.Origin - this->Near[0].FirstSlot;
  this->SetBounds(
    window, shape, firstColumn, endColumn, this->Near[0].X[place], this->Near[0].Y[place]);
  return true;
}

/** Gathers the points of a box around the vertex, from the neighborhood of its leaf. */
bool PointWindows::GatherBox(Window& window)
{
  const Neighborhood& around = this->Leaves.Around(window.Origin);
  if (around.Count == 0)
  {
    return false;
  }
  const Point2 p = this->Grid.PointAt(window.Origin);
  const float originX = static_cast<float>((p.X - around.CenterX) * around.PerSide);
  const float originY = static_cast<float>((p.Y - around.CenterY) * around.PerSide);
  for (float size : { 1.0f, 0.7f })
  {
    if (BoxCopiers[static_cast<int>(this->Instructions)](around, originX, originY, size, window))
    {
      window.PerSide = around.PerSide;
      window.Left = window.Right = 0.55f * size;
      window.Top = 0.9f * size;
      window.IsBox = true;
      window.Errors = &this->BoxBounds;
      return true;
    }
  }
  return false;
}

// For ends of edges outside the window. Rounded as the window's points are, so that the same error
// bounds hold.
void PointWindows::Place(Index slot, float& x, float& y) const
{
  const Point2 a = this->Grid.PointAt(this->InUse->Origin), p = this->Grid.PointAt(slot);
  if (this->InUse->IsBox)
  {
    x = static_cast<float>((p.X - a.X) * this->InUse->PerSide);
    y = static_cast<float>((p.Y - a.Y) * this->InUse->PerSide);
    return;
  }
  const BinGrid::Layout& bins = this->Grid.Bins;
  const double perUnit = this->PerUnit;
  x = static_cast<float>(Units(p.X, bins.OriginX, perUnit) - Units(a.X, bins.OriginX, perUnit));
  y = static_cast<float>(Units(p.Y, bins.OriginY, perUnit) - Units(a.Y, bins.OriginY, perUnit));
}

} // namespace elevation
#endif
