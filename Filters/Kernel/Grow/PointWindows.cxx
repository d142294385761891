// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointWindows.h"

#include "Packing.h"

#include <algorithm>
#include <cmath>

#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 warns of undefined values in its own intrinsics.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace elevation
{
#ifdef ELEVATION_HAS_AVX2
namespace
{
constexpr float NotANumber = std::numeric_limits<float>::quiet_NaN();

// The passes: EnterRow() rounds the points of four rows of bins; Gather...() copies those of a
// window relative to its vertex; SetBounds() records how far the window reaches, for the proof.
// Where bins are full, GatherBox() takes the place of all three.

/** Columns and rows of the windows of bins, the larger first. */
struct Shape
{
  Index Columns, Rows;
};
constexpr Shape Shapes[] = { { 6, 4 }, { 3, 3 }, { 3, 2 } };

/** Eight coordinates in whole units from the grid's corner, rounded to the nearest. */
ELEVATION_WIDE inline __m256i EightUnits(const double* values, __m256d from, __m256d perUnit)
{
  const __m128i low =
    _mm256_cvtpd_epi32(_mm256_mul_pd(_mm256_sub_pd(_mm256_loadu_pd(values), from), perUnit));
  const __m128i high =
    _mm256_cvtpd_epi32(_mm256_mul_pd(_mm256_sub_pd(_mm256_loadu_pd(values + 4), from), perUnit));
  return _mm256_set_m128i(high, low);
}

/** The same for one coordinate. */
ELEVATION_WIDE inline std::int32_t Units(double value, double from, double perUnit)
{
  return _mm_cvtsd_si32(_mm_set_sd((value - from) * perUnit)); // to the nearest, as above
}

} // namespace

/**
 * Chooses the unit, as large as the ranges of float and of 32 bits allow; windows of bins are not
 * used where bins are too unequal for one unit.
 */
PointWindows::PointWindows(const BinGrid& grid, bool isWidest)
  : Grid(grid)
  , IsWidest(isWidest)
  , Leaves(grid)
{
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
  return this->InUse->Vectors > 0;
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
    const Index* const own = this->Near[0]->Starts + column;
    // A bin with more points than a window holds would fail in all three shapes.
    if (this->AreNearRead && own[1] - own[0] <= Capacity &&
      ((this->IsWidest ? this->GatherWidest(window, first) : this->GatherEven(window, first)) ||
        this->GatherBins(window, column, 1) || this->GatherBins(window, column, 2)))
    {
      return;
    }
  }
  if (!this->GatherBox(window))
  {
    window.Vectors = 0;
  }
}

/** Reads the rows that windows of a row's vertices need. */
ELEVATION_WIDE void PointWindows::EnterRow(Index number)
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
    this->Near[r - number] = &row;
  }
  for (int shape = 0; shape < NumberOfShapes; ++shape)
  {
    const Index above = std::min(number + Shapes[shape].Rows, bins.Rows);
    this->TopBounds[shape] = above == bins.Rows
      ? std::numeric_limits<std::int32_t>::max()
      : static_cast<std::int32_t>(above * bins.BinHeight * this->PerUnit);
  }
}

/** Rounds the coordinates of a row's points to units, eight at a time. */
ELEVATION_WIDE void PointWindows::ReadRow(Row& row)
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
  const __m256d perUnit = _mm256_set1_pd(this->PerUnit);
  const __m256d fromX = _mm256_set1_pd(bins.OriginX), fromY = _mm256_set1_pd(bins.OriginY);
  for (std::size_t i = 0; i < count; i += 8)
  {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(row.X.data() + i),
      EightUnits(this->Grid.X.data() + slots.first + i, fromX, perUnit));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(row.Y.data() + i),
      EightUnits(this->Grid.Y.data() + slots.first + i, fromY, perUnit));
  }
}

/** How far a window of bins reaches from the vertex. */
ELEVATION_WIDE_INLINE void PointWindows::SetBounds(Window& window, int shape, Index firstColumn,
  Index endColumn, std::int32_t originX, std::int32_t originY) const
{
  window.IsBox = false;
  window.Left = static_cast<float>(originX - this->ColumnBounds[firstColumn]);
  window.Right = static_cast<float>(this->ColumnBounds[endColumn] - originX);
  window.Top = static_cast<float>(this->TopBounds[shape] - originY);
  window.Errors = &this->ShapeBounds[shape];
}

/**
 * Gathers at most 32 points, packed into two vectors. With wide registers, packing is cheap: an
 * expanding load puts a row's points where the row before has ended.
 */
ELEVATION_WIDEST bool PointWindows::GatherWidest(Window& window, Index firstColumn)
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  const Index endColumn = std::min(firstColumn + Shapes[0].Columns, bins.Columns);
  firstColumn = std::max(firstColumn, 0);

  // The points of each row overwrite the lanes beyond the previous row. Masked loads put the points
  // of a row behind those of the rows before: "places" has the lanes from count on, low for the
  // first vector, high for the second. What a row writes beyond its points belongs to later rows,
  // or becomes NaN at the end.
  const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  __m512i lowX = lanes, highX = lanes, lowY = lanes, highY = lanes, lowSlot = lanes,
          highSlot = lanes;
  unsigned int count = 0;
  for (int k = 0; k < MostRows; ++k)
  {
    const Row& row = *this->Near[k];
    const Index first = row.Starts[firstColumn];
    const unsigned int size = row.Starts[endColumn] - first;
    if (count + size > 32)
    {
      return false;
    }
    const std::uint32_t places = static_cast<std::uint32_t>(~std::uint64_t(0) << count);
    // Shifts of 64 bits, as count may be 32: then no lane is left.
    const __mmask16 low = static_cast<__mmask16>(places);
    const __mmask16 high = static_cast<__mmask16>(places >> 16);
    // How many of the row's points go to the first vector; the second one continues there.
    const int inLow = count < 16 ? 16 - count : 0;
    const std::int32_t* const x = row.X.data() + (first - row.FirstSlot);
    const std::int32_t* const y = row.Y.data() + (first - row.FirstSlot);
    lowX = _mm512_mask_expandloadu_epi32(lowX, low, x);
    highX = _mm512_mask_expandloadu_epi32(highX, high, x + inLow);
    lowY = _mm512_mask_expandloadu_epi32(lowY, low, y);
    highY = _mm512_mask_expandloadu_epi32(highY, high, y + inLow);
    // Slots of a row are consecutive, so they follow from the lane.
    const __m512i offset = _mm512_set1_epi32(first - static_cast<Index>(count));
    lowSlot = _mm512_mask_add_epi32(lowSlot, low, lanes, offset);
    highSlot =
      _mm512_mask_add_epi32(highSlot, high, lanes, _mm512_add_epi32(offset, _mm512_set1_epi32(16)));
    count += size;
  }
  const Row& own = *this->Near[0];
  const Index place = window.Origin - own.FirstSlot;
  const std::int32_t originX = own.X[place], originY = own.Y[place];
  const __m512i x0 = _mm512_set1_epi32(originX), y0 = _mm512_set1_epi32(originY);
  const std::uint32_t rest = static_cast<std::uint32_t>(~std::uint64_t(0) << count);
  const __m512 nothing = _mm512_set1_ps(NotANumber);
  const __m512 x = _mm512_mask_mov_ps(
    _mm512_cvtepi32_ps(_mm512_sub_epi32(lowX, x0)), static_cast<__mmask16>(rest), nothing);
  const __m512 otherX = _mm512_mask_mov_ps(
    _mm512_cvtepi32_ps(_mm512_sub_epi32(highX, x0)), static_cast<__mmask16>(rest >> 16), nothing);
  const __m512 y = _mm512_cvtepi32_ps(_mm512_sub_epi32(lowY, y0));
  const __m512 otherY = _mm512_cvtepi32_ps(_mm512_sub_epi32(highY, y0));
  _mm512_store_ps(window.X, x);
  _mm512_store_ps(window.X + 16, otherX);
  _mm512_store_ps(window.Y, y);
  _mm512_store_ps(window.Y + 16, otherY);
  _mm512_store_ps(window.Square, _mm512_fmadd_ps(x, x, _mm512_mul_ps(y, y)));
  _mm512_store_ps(
    window.Square + 16, _mm512_fmadd_ps(otherX, otherX, _mm512_mul_ps(otherY, otherY)));
  _mm512_store_si512(window.Slots, lowSlot);
  _mm512_store_si512(window.Slots + 16, highSlot);

  // The vertex is in row 0, whose points come first.
  window.OriginLane = window.Origin - own.Starts[firstColumn];
  window.Vectors = WidestVectors;
  this->SetBounds(window, 0, firstColumn, endColumn, originX, originY);
  return true;
}

/**
 * Gathers the first eight points of each row in a vector of their own; further points of all rows
 * share the fifth vector. Without packing: a row is loaded, shifted to the vertex and stored, with
 * no dependence on the rows before.
 */
ELEVATION_WIDE bool PointWindows::GatherEven(Window& window, Index firstColumn)
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  const Index endColumn = std::min(firstColumn + Shapes[0].Columns, bins.Columns);
  firstColumn = std::max(firstColumn, 0);

  const Row& own = *this->Near[0];
  const Index place = window.Origin - own.FirstSlot;
  const std::int32_t originX = own.X[place], originY = own.Y[place];
  const __m256i x0 = _mm256_set1_epi32(originX), y0 = _mm256_set1_epi32(originY);
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  int over = 0;
  Index counts[MostRows];
  for (int k = 0; k < MostRows; ++k)
  {
    const Row& row = *this->Near[k];
    const Index first = row.Starts[firstColumn];
    const Index count = row.Starts[endColumn] - first;
    counts[k] = count;
    over += count > 8 ? count - 8 : 0;
    const Index at = first - row.FirstSlot;
    const __m256i isBeyond = _mm256_cmpgt_epi32(lanes, _mm256_set1_epi32(count - 1));
    const __m256i unitsX = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(row.X.data() + at));
    const __m256i unitsY = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(row.Y.data() + at));
    // All bits set is NaN.
    const __m256 x =
      _mm256_or_ps(_mm256_castsi256_ps(isBeyond), _mm256_cvtepi32_ps(_mm256_sub_epi32(unitsX, x0)));
    const __m256 y = _mm256_cvtepi32_ps(_mm256_sub_epi32(unitsY, y0));
    _mm256_store_ps(window.X + 8 * k, x);
    _mm256_store_ps(window.Y + 8 * k, y);
    _mm256_store_ps(window.Square + 8 * k, _mm256_fmadd_ps(x, x, _mm256_mul_ps(y, y)));
    _mm256_store_si256(reinterpret_cast<__m256i*>(window.Slots + 8 * k),
      _mm256_add_epi32(_mm256_set1_epi32(first), lanes));
    if (k == 0)
    {
      window.OriginLane = window.Origin - first;
    }
  }
  // X alone empties a lane: cross and dot of NaN fail every comparison.
  const __m256 nothing = _mm256_set1_ps(NotANumber);
  _mm256_store_ps(window.X + 32, nothing);
  if (over > 0)
  {
    if (over > 8)
    {
      return false;
    }
    this->AddBeyondEight(window, firstColumn, counts);
  }
  window.Vectors = EvenVectors;
  this->SetBounds(window, 0, firstColumn, endColumn, originX, originY);
  return true;
}

/**
 * Adds the points of rows beyond the eighth, as one vector. Few points, one by one: rows with more
 * than eight are seldom where density is even.
 */
ELEVATION_WIDE void PointWindows::AddBeyondEight(
  Window& window, Index firstColumn, const Index* counts) const
{
  const Row& own = *this->Near[0];
  const Index place = window.Origin - own.FirstSlot;
  int lane = 32;
  for (int k = 0; k < MostRows; ++k)
  {
    const Row& row = *this->Near[k];
    for (Index i = 8; i < counts[k]; ++i, ++lane)
    {
      const Index slot = row.Starts[firstColumn] + i;
      window.X[lane] = static_cast<float>(row.X[slot - row.FirstSlot] - own.X[place]);
      window.Y[lane] = static_cast<float>(row.Y[slot - row.FirstSlot] - own.Y[place]);
      window.Slots[lane] = slot;
      window.OriginLane = slot == window.Origin ? lane : window.OriginLane;
    }
  }
  const __m256 x = _mm256_load_ps(window.X + 32), y = _mm256_load_ps(window.Y + 32);
  _mm256_store_ps(window.Square + 32, _mm256_fmadd_ps(x, x, _mm256_mul_ps(y, y)));
}

/**
 * Gathers a smaller window, packed. An odd number of columns with the vertex's in the middle, as
 * points are dense here.
 */
ELEVATION_WIDE bool PointWindows::GatherBins(Window& window, Index column, int shape)
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  const Index firstColumn = std::max(column - Shapes[shape].Columns / 2, 0);
  const Index endColumn = std::min(column + Shapes[shape].Columns / 2 + 1, bins.Columns);
  const Row& own = *this->Near[0];
  const Index place = window.Origin - own.FirstSlot;
  const std::int32_t originX = own.X[place], originY = own.Y[place];
  const __m256i x0 = _mm256_set1_epi32(originX), y0 = _mm256_set1_epi32(originY);
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  int count = 0;
  for (int k = 0; k < Shapes[shape].Rows; ++k)
  {
    const Row& row = *this->Near[k];
    const Index first = row.Starts[firstColumn], end = row.Starts[endColumn];
    if (count + (end - first) > Capacity)
    {
      return false;
    }
    for (Index slot = first; slot < end; slot += 8)
    {
      // Whole vectors: the excess is overwritten by the next row, or by NaN.
      // Room has eight lanes to spare for this.
      const int at = count + (slot - first);
      const __m256i unitsX =
        _mm256_loadu_si256(reinterpret_cast<const __m256i*>(row.X.data() + (slot - row.FirstSlot)));
      const __m256i unitsY =
        _mm256_loadu_si256(reinterpret_cast<const __m256i*>(row.Y.data() + (slot - row.FirstSlot)));
      _mm256_storeu_ps(window.X + at, _mm256_cvtepi32_ps(_mm256_sub_epi32(unitsX, x0)));
      _mm256_storeu_ps(window.Y + at, _mm256_cvtepi32_ps(_mm256_sub_epi32(unitsY, y0)));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(window.Slots + at),
        _mm256_add_epi32(_mm256_set1_epi32(slot), lanes));
    }
    if (k == 0)
    {
      window.OriginLane = window.Origin - first;
    }
    count += end - first;
  }
  window.Close(count, this->IsWidest);
  this->SetBounds(window, shape, firstColumn, endColumn, originX, originY);
  return true;
}

ELEVATION_WIDE void PointWindows::Window::Close(int count, bool isWidest)
{
  // Only numbers of vectors for which the search has an instance.
  this->Vectors = isWidest && count <= 8 * WidestVectors ? WidestVectors
    : count <= 8 * EvenVectors                           ? EvenVectors
                                                         : MostVectors;
  const __m256 nothing = _mm256_set1_ps(NotANumber);
  for (int at = count; at < 8 * this->Vectors; at += 8)
  {
    _mm256_storeu_ps(this->X + at, nothing);
    _mm256_storeu_ps(this->Y + at, nothing);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(this->Slots + at), _mm256_set1_epi32(None));
  }
  for (int i = 0; i < this->Vectors; ++i)
  {
    const __m256 x = _mm256_load_ps(this->X + 8 * i), y = _mm256_load_ps(this->Y + 8 * i);
    _mm256_store_ps(this->Square + 8 * i, _mm256_fmadd_ps(x, x, _mm256_mul_ps(y, y)));
  }
}

/** Gathers the points of a box around the vertex, from the neighborhood of its leaf. */
ELEVATION_WIDE bool PointWindows::GatherBox(Window& window)
{
  const Neighborhood& around = this->Leaves.Around(window.Origin);
  if (around.Count == 0)
  {
    return false;
  }
  const Point2 p = this->Grid.PointAt(window.Origin);
  const __m256 originX =
    _mm256_set1_ps(static_cast<float>((p.X - around.CenterX) * around.PerSide));
  const __m256 originY =
    _mm256_set1_ps(static_cast<float>((p.Y - around.CenterY) * around.PerSide));
  // The box that is copied is larger than what Left, Right and Top promise by 0.0005 sides, more
  // than the rounding of a coordinate; the vertex's own row needs the same below.
  const __m256 signBit = _mm256_set1_ps(-0.0f), down = _mm256_set1_ps(-0.0005f);
  for (float size : { 1.0f, 0.7f })
  {
    const __m256 across = _mm256_set1_ps(0.5505f * size), up = _mm256_set1_ps(0.9005f * size);
    int count = 0;
    for (int i = 0; i < around.Count && count <= Capacity; i += 8)
    {
      const __m256 x = _mm256_sub_ps(_mm256_loadu_ps(around.X + i), originX);
      const __m256 y = _mm256_sub_ps(_mm256_loadu_ps(around.Y + i), originY);
      const __m256i slots = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(around.Slots + i));
      const int in = _mm256_movemask_ps(
        _mm256_and_ps(_mm256_cmp_ps(_mm256_andnot_ps(signBit, x), across, _CMP_LE_OQ),
          _mm256_and_ps(_mm256_cmp_ps(y, down, _CMP_GE_OQ), _mm256_cmp_ps(y, up, _CMP_LE_OQ))));
      // The lanes in the box move to the front; the next store overwrites the rest.
      const __m256i which = PlacesOf(in);
      _mm256_storeu_ps(window.X + count, _mm256_permutevar8x32_ps(x, which));
      _mm256_storeu_ps(window.Y + count, _mm256_permutevar8x32_ps(y, which));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(window.Slots + count),
        _mm256_permutevar8x32_epi32(slots, which));
      count += __builtin_popcount(in);
    }
    if (count <= Capacity)
    {
      window.Close(count, this->IsWidest);
      window.OriginLane = __builtin_ctzll(window.LanesOf<MostVectors>(window.Origin));
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
ELEVATION_WIDE void PointWindows::Place(Index slot, float& x, float& y) const
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

#else

PointWindows::PointWindows(const BinGrid& grid, bool)
  : Grid(grid)
  , IsWidest(false)
  , Leaves(grid)
{
}

bool PointWindows::Gather(Index, Index)
{
  return false;
}

#endif

} // namespace elevation
