// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "WideApexSearch.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#ifdef ELEVATION_HAS_AVX2
#include <immintrin.h>
#endif

#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 takes its own intrinsics' undefined values for a mistake.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace elevation
{
#ifdef ELEVATION_HAS_AVX2

/** A function for processors with AVX2. */
#define ELEVATION_WIDE __attribute__((target("avx2,fma")))
#define ELEVATION_WIDE_INLINE __attribute__((target("avx2,fma"), always_inline)) inline
/** A function for processors with AVX-512. */
#define ELEVATION_WIDEST __attribute__((target("avx512f,avx2,fma,bmi,bmi2,popcnt")))

namespace
{
constexpr double PointsInBox = 18.0; // as expected; half of that when it was too much
constexpr double MostSides = 4.0;    // from the middle of a leaf to the farthest point around it
constexpr float NotANumber = std::numeric_limits<float>::quiet_NaN();
constexpr double Roundoff = 0x1p-24; // of single precision

/** Columns and rows of the windows of bins, the larger first. */
struct Shape
{
  Index Columns, Rows;
};
constexpr Shape Shapes[WideApexSearch::NumberOfShapes] = { { 6, 4 }, { 3, 3 }, { 3, 2 } };

ELEVATION_WIDE inline __m256i EightUnits(const double* values, __m256d from, __m256d perUnit)
{
  const __m128i low =
    _mm256_cvtpd_epi32(_mm256_mul_pd(_mm256_sub_pd(_mm256_loadu_pd(values), from), perUnit));
  const __m128i high =
    _mm256_cvtpd_epi32(_mm256_mul_pd(_mm256_sub_pd(_mm256_loadu_pd(values + 4), from), perUnit));
  return _mm256_set_m128i(high, low);
}

ELEVATION_WIDE inline std::int32_t Units(double value, double from, double perUnit)
{
  return _mm_cvtsd_si32(_mm_set_sd((value - from) * perUnit)); // to the nearest, as above
}

bool HasAVX512()
{
  static const bool hasIt = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("bmi2");
  return hasIt;
}

/** The least of eight. */
ELEVATION_WIDE inline float Least(__m256 values)
{
  __m128 half = _mm_min_ps(_mm256_castps256_ps128(values), _mm256_extractf128_ps(values, 1));
  half = _mm_min_ps(half, _mm_movehl_ps(half, half));
  half = _mm_min_ss(half, _mm_movehdup_ps(half));
  return _mm_cvtss_f32(half);
}
} // namespace

bool WideApexSearch::IsSupported()
{
  static const bool isSupported = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return isSupported;
}

WideApexSearch::WideApexSearch(const BinGrid& grid)
  : Grid(grid)
  , IsWidest(HasAVX512())
{
  const BinGrid::Layout& bins = grid.Bins;
  // Two coordinates are rounded, then their difference.
  this->OfBox.Set(1.1, (2.0 * MostSides + 1.2) * Roundoff, 0.002);
  if (!IsSupported() || !bins.HasPlainBins)
  {
    return;
  }
  // Products of four coordinates stay within single precision, differences within 32 bits.
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
    // From a vertex in the middle columns or at their border, and in the lowest row.
    const double across = (Shapes[shape].Columns / 2 + 1) * width * perUnit;
    const double up = Shapes[shape].Rows * height * perUnit;
    const double reach = std::sqrt(across * across + up * up);
    // Two coordinates are rounded to whole units, their difference to single precision; bounds of
    // bins are known to a thousandth of a bin.
    this->OfShapes[shape].Set(
      reach, 1.1 + Roundoff * reach, 0.01 * std::max(width, height) * perUnit);
  }
  for (Row& row : this->Rows)
  {
    row.X.resize(RowRoom);
    row.Y.resize(RowRoom);
  }
  // Beyond the grid's border there is nothing.
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

void WideApexSearch::Bounds::Set(double reach, double error, double margin)
{
  const double square = reach * reach;
  const double slack = 1.001; // for the roundings here
  this->ReachSquared = static_cast<float>(square);
  this->CoordinateError = static_cast<float>(slack * error);
  this->CrossError = static_cast<float>(slack * 3.0 * (reach * error + Roundoff * square));
  this->DotError = 2.0f * this->CrossError;
  this->ComparisonError =
    static_cast<float>(slack * square * (24.0 * reach * error + 32.0 * Roundoff * square));
  this->Margin = static_cast<float>(margin);
}

bool WideApexSearch::Gather(Index origin, Index next)
{
  Window* other = this->Windows + (this->Current == this->Windows);
  if (other->Origin == origin)
  {
    std::swap(this->Current, other);
  }
  else
  {
    this->Current->Origin = origin;
    this->GatherInto(*this->Current);
  }
  other->Origin = next;
  if (next != None)
  {
    this->GatherInto(*other);
  }
  return this->Current->Vectors > 0;
}

void WideApexSearch::GatherInto(Window& window)
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
    const Index first = static_cast<Index>((p.X - bins.OriginX) * bins.PerX + 0.5) - 3;
    const Index column = bins.Column(p.X);
    const Index* const own = this->Near[0]->Starts + column;
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

/** Reads the rows of the windows of a row's vertices. */
ELEVATION_WIDE void WideApexSearch::EnterRow(Index number)
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  this->CurrentRow = number;
  this->AreNearRead = true;
  for (Index r = number; r < number + MostRows; ++r)
  {
    Row& row = this->Rows[r % MostRows];
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

ELEVATION_WIDE void WideApexSearch::ReadRow(Row& row)
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  const auto slots = this->Grid.Slots(row.Number, 0, bins.Columns - 1);
  const std::size_t count = slots.second - slots.first;
  row.FirstSlot = slots.first;
  row.Starts = this->Grid.Starts.data() + static_cast<std::size_t>(row.Number) * bins.Columns;
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
ELEVATION_WIDE_INLINE void WideApexSearch::SetBounds(Window& window, int shape, Index firstColumn,
  Index endColumn, std::int32_t originX, std::int32_t originY) const
{
  window.IsBox = false;
  window.Left = static_cast<float>(originX - this->ColumnBounds[firstColumn]);
  window.Right = static_cast<float>(this->ColumnBounds[endColumn] - originX);
  window.Top = static_cast<float>(this->TopBounds[shape] - originY);
  window.Errors = &this->OfShapes[shape];
}

/** At most 32 points, packed into two vectors. */
ELEVATION_WIDEST bool WideApexSearch::GatherWidest(Window& window, Index firstColumn)
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  const Index endColumn = std::min(firstColumn + Shapes[0].Columns, bins.Columns);
  firstColumn = std::max(firstColumn, 0);

  // Each row's points overwrite what the vectors hold beyond the end of the row before.
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
    const __mmask16 low = static_cast<__mmask16>(places);
    const __mmask16 high = static_cast<__mmask16>(places >> 16);
    const int inLow = count < 16 ? 16 - count : 0;
    const std::int32_t* const x = row.X.data() + (first - row.FirstSlot);
    const std::int32_t* const y = row.Y.data() + (first - row.FirstSlot);
    lowX = _mm512_mask_expandloadu_epi32(lowX, low, x);
    highX = _mm512_mask_expandloadu_epi32(highX, high, x + inLow);
    lowY = _mm512_mask_expandloadu_epi32(lowY, low, y);
    highY = _mm512_mask_expandloadu_epi32(highY, high, y + inLow);
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

  window.OriginLane = window.Origin - own.Starts[firstColumn];
  window.Vectors = WidestVectors;
  this->SetBounds(window, 0, firstColumn, endColumn, originX, originY);
  return true;
}

/**
 * The first eight points of each row have a vector of their own; what some rows have beyond
 * eight shares the fifth.
 */
ELEVATION_WIDE bool WideApexSearch::GatherEven(Window& window, Index firstColumn)
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
    // All bits set is not a number.
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
  const __m256 nothing = _mm256_set1_ps(NotANumber);
  _mm256_store_ps(window.X + 32, nothing);
  if (over > 0)
  {
    if (over > 8)
    {
      return false;
    }
    int lane = 32;
    for (int k = 0; k < MostRows; ++k)
    {
      for (Index i = 8; i < counts[k]; ++i, ++lane)
      {
        const Row& row = *this->Near[k];
        const Index slot = row.Starts[firstColumn] + i;
        window.X[lane] = static_cast<float>(row.X[slot - row.FirstSlot] - originX);
        window.Y[lane] = static_cast<float>(row.Y[slot - row.FirstSlot] - originY);
        window.Slots[lane] = slot;
        window.OriginLane = slot == window.Origin ? lane : window.OriginLane;
      }
    }
    const __m256 x = _mm256_load_ps(window.X + 32), y = _mm256_load_ps(window.Y + 32);
    _mm256_store_ps(window.Square + 32, _mm256_fmadd_ps(x, x, _mm256_mul_ps(y, y)));
  }
  window.Vectors = EvenVectors;
  this->SetBounds(window, 0, firstColumn, endColumn, originX, originY);
  return true;
}

/** A smaller window, packed. */
ELEVATION_WIDE bool WideApexSearch::GatherBins(Window& window, Index column, int shape)
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
      // Whole vectors: what is too much is overwritten by the next row, or made not a number.
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

/** Ends the lists of the window's points. */
ELEVATION_WIDE void WideApexSearch::Window::Close(int count, bool isWidest)
{
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

/** The places of a slot in the lists, as bits. */
template <int Count>
ELEVATION_WIDE_INLINE std::uint64_t WideApexSearch::Window::LanesOf(Index slot) const
{
  std::uint64_t lanes = 0;
  for (int i = 0; i < Count; ++i)
  {
    const __m256i isSlot = _mm256_cmpeq_epi32(_mm256_set1_epi32(slot),
      _mm256_load_si256(reinterpret_cast<const __m256i*>(this->Slots + 8 * i)));
    lanes |= static_cast<std::uint64_t>(_mm256_movemask_ps(_mm256_castsi256_ps(isSlot))) << (8 * i);
  }
  return lanes;
}

/** The points around the leaf that holds a slot. */
const WideApexSearch::Neighborhood& WideApexSearch::Around(Index slot)
{
  if (this->Neighborhoods.empty())
  {
    // A line of equal y runs through about as many leaves as the root of their number: vertices of
    // these come in turn.
    const double leaves = this->Grid.NumberOfPoints() / 16.0;
    this->Neighborhoods.resize(static_cast<std::size_t>(16.0 + 2.0 * std::sqrt(leaves)));
    // So many places that leaves whose vertices come in turn seldom share one.
    std::size_t places = 1024;
    while (places < this->Neighborhoods.size() * 64)
    {
      places *= 2;
    }
    this->Known.assign(places, 0);
  }
  const std::size_t mask = this->Known.size() - 1;
  const std::size_t eight = static_cast<std::size_t>(slot) / 8;
  for (const std::size_t at : { eight, eight - 1, eight + 1 })
  {
    const Neighborhood& known = this->Neighborhoods[this->Known[at & mask]];
    if (known.First <= slot && slot < known.End)
    {
      return known;
    }
  }
  const std::size_t oldest = this->Oldest;
  this->Oldest = (oldest + 1) % this->Neighborhoods.size();
  Neighborhood& made = this->Neighborhoods[oldest];
  this->GatherNeighborhood(made, slot);
  for (Index at = made.First / 8; at < (made.End + 7) / 8; ++at)
  {
    this->Known[static_cast<std::size_t>(at) & mask] = static_cast<Index>(oldest);
  }
  return made;
}

void WideApexSearch::GatherNeighborhood(Neighborhood& around, Index slot)
{
  const BinGrid::Step last = this->Grid.Lowest(slot);
  const BinGrid::Node& node = *last.Node;
  int place = 0;
  while (slot < node.First[place] || slot >= node.First[place] + node.Count[place])
  {
    ++place;
  }
  around.First = node.First[place];
  around.End = around.First + node.Count[place];
  const double size = node.Size, width = last.HighX - last.LowX, height = last.HighY - last.LowY;
  const double leafLowX = node.LowX[place], leafHighX = node.HighX[place];
  const double leafLowY = node.LowY[place], leafHighY = node.HighY[place];
  for (double points : { PointsInBox, 0.5 * PointsInBox })
  {
    // The side of a square with so many points; where points lie in a strip narrower than that, the
    // length of it.
    double side = std::sqrt(points / size * width * height);
    if (!(side < std::min(width, height)))
    {
      side = points / size * std::max(width, height);
    }
    const double lowX = leafLowX - 0.551 * side, highX = leafHighX + 0.551 * side;
    const double highY = leafHighY + 0.901 * side;
    const double greatest = std::max(
      std::max(std::fabs(lowX), std::fabs(highX)), std::max(std::fabs(leafLowY), std::fabs(highY)));
    around.PerSide = 1.0 / side;
    around.CenterX = 0.5 * leafLowX + 0.5 * leafHighX;
    around.CenterY = 0.5 * leafLowY + 0.5 * leafHighY;
    // Of a box of a few roundoffs of the coordinates, rounding makes another one.
    if (!(around.PerSide > 1e-150 && around.PerSide < 1e150 && greatest < 1e10 * side &&
          highX - around.CenterX < MostSides * side && highY - around.CenterY < MostSides * side))
    {
      break;
    }
    BinGrid::Step top = last;
    while (!(top.LowX < lowX && highX < top.HighX && highY < top.HighY) && !top.IsRoot())
    {
      top = this->Grid.Above(top);
    }
    if (this->GatherBox(around, *top.Node, lowX, highX, leafLowY, highY))
    {
      return;
    }
  }
  around.Count = 0;
}

/** For the bits of eight places, which of them are set; then any. */
struct Packing
{
  alignas(8) std::uint8_t Places[256][8];

  constexpr Packing()
    : Places()
  {
    for (int bits = 0; bits < 256; ++bits)
    {
      for (int place = 0, count = 0; place < 8; ++place)
      {
        if (bits >> place & 1)
        {
          this->Places[bits][count++] = static_cast<std::uint8_t>(place);
        }
      }
    }
  }
};
constexpr Packing Packings;

/** The places that are set. */
ELEVATION_WIDE_INLINE __m256i PlacesOf(int bits)
{
  return _mm256_cvtepu8_epi32(
    _mm_loadl_epi64(reinterpret_cast<const __m128i*>(Packings.Places[bits])));
}

/** All points of the box below a node; false when they are too many. */
ELEVATION_WIDE bool WideApexSearch::GatherBox(Neighborhood& around, const BinGrid::Node& top,
  double lowX, double highX, double lowY, double highY)
{
  const __m256d centerX = _mm256_set1_pd(around.CenterX), centerY = _mm256_set1_pd(around.CenterY);
  const __m256d scale = _mm256_set1_pd(around.PerSide);
  const __m256d boxLowX = _mm256_set1_pd(lowX), boxHighX = _mm256_set1_pd(highX);
  const __m256d boxLowY = _mm256_set1_pd(lowY), boxHighY = _mm256_set1_pd(highY);
  const BinGrid::Node* stack[64];
  stack[0] = &top;
  int height = 1;
  int count = 0;
  while (height > 0)
  {
    const BinGrid::Node& node = *stack[--height];
    for (int half = 0; half < BinGrid::Node::Places; half += 4)
    {
      const __m256d isWithinX =
        _mm256_and_pd(_mm256_cmp_pd(_mm256_loadu_pd(node.LowX + half), boxHighX, _CMP_LE_OQ),
          _mm256_cmp_pd(_mm256_loadu_pd(node.HighX + half), boxLowX, _CMP_GE_OQ));
      const __m256d isWithinY =
        _mm256_and_pd(_mm256_cmp_pd(_mm256_loadu_pd(node.LowY + half), boxHighY, _CMP_LE_OQ),
          _mm256_cmp_pd(_mm256_loadu_pd(node.HighY + half), boxLowY, _CMP_GE_OQ));
      for (int within = _mm256_movemask_pd(_mm256_and_pd(isWithinX, isWithinY)); within;
           within &= within - 1)
      {
        const int place = half + __builtin_ctz(within);
        if (node.Count[place] == 0)
        {
          if (height == 64)
          {
            return false;
          }
          stack[height++] = &this->Grid.Nodes[node.First[place]];
          continue;
        }
        const Index end = node.First[place] + node.Count[place];
        for (Index slot = node.First[place]; slot < end; slot += 8)
        {
          int in = 0;
          __m128 x[2], y[2]; // in sides
          for (int half = 0; half < 2; ++half)
          {
            const __m256d pointX = _mm256_loadu_pd(this->Grid.X.data() + slot + 4 * half);
            const __m256d pointY = _mm256_loadu_pd(this->Grid.Y.data() + slot + 4 * half);
            const __m256d isInX = _mm256_and_pd(_mm256_cmp_pd(pointX, boxLowX, _CMP_GE_OQ),
              _mm256_cmp_pd(pointX, boxHighX, _CMP_LE_OQ));
            const __m256d isInY = _mm256_and_pd(_mm256_cmp_pd(pointY, boxLowY, _CMP_GE_OQ),
              _mm256_cmp_pd(pointY, boxHighY, _CMP_LE_OQ));
            in |= _mm256_movemask_pd(_mm256_and_pd(isInX, isInY)) << (4 * half);
            x[half] = _mm256_cvtpd_ps(_mm256_mul_pd(_mm256_sub_pd(pointX, centerX), scale));
            y[half] = _mm256_cvtpd_ps(_mm256_mul_pd(_mm256_sub_pd(pointY, centerY), scale));
          }
          in &= 255 >> std::max(slot + 8 - end, 0);
          // Those within come first, the others are overwritten.
          const __m256i which = PlacesOf(in);
          _mm256_storeu_ps(
            around.X + count, _mm256_permutevar8x32_ps(_mm256_set_m128(x[1], x[0]), which));
          _mm256_storeu_ps(
            around.Y + count, _mm256_permutevar8x32_ps(_mm256_set_m128(y[1], y[0]), which));
          _mm256_storeu_si256(reinterpret_cast<__m256i*>(around.Slots + count),
            _mm256_add_epi32(_mm256_set1_epi32(slot), which));
          count += __builtin_popcount(in);
          if (count > MostAround)
          {
            return false;
          }
        }
      }
    }
  }
  around.Count = count;
  _mm256_storeu_ps(around.X + count, _mm256_set1_ps(NotANumber));
  return true;
}

/** The points of a box around the vertex, from those around its leaf. */
ELEVATION_WIDE bool WideApexSearch::GatherBox(Window& window)
{
  const Neighborhood& around = this->Around(window.Origin);
  if (around.Count == 0)
  {
    return false;
  }
  const Point2 p = this->Grid.PointAt(window.Origin);
  const __m256 originX =
    _mm256_set1_ps(static_cast<float>((p.X - around.CenterX) * around.PerSide));
  const __m256 originY =
    _mm256_set1_ps(static_cast<float>((p.Y - around.CenterY) * around.PerSide));
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
      window.Errors = &this->OfBox;
      return true;
    }
  }
  return false;
}

/**
 * The end of an edge from the vertex, in the window's units.
 * @param[in] lanes  where it is in the lists, as bits, if it is there
 * @return false when it is too far away
 */
ELEVATION_WIDE_INLINE bool WideApexSearch::PlaceEnd(
  Index b, std::uint64_t lanes, float& x, float& y) const
{
  if (lanes != 0)
  {
    const int lane = __builtin_ctzll(lanes);
    x = this->Current->X[lane];
    y = this->Current->Y[lane];
    if (x == x) // else it is beyond the end of a list
    {
      return true;
    }
  }
  const Point2 a = this->Grid.PointAt(this->Current->Origin), end = this->Grid.PointAt(b);
  if (this->Current->IsBox)
  {
    x = static_cast<float>((end.X - a.X) * this->Current->PerSide);
    y = static_cast<float>((end.Y - a.Y) * this->Current->PerSide);
  }
  else
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    const double perUnit = this->PerUnit;
    x = static_cast<float>(Units(end.X, bins.OriginX, perUnit) - Units(a.X, bins.OriginX, perUnit));
    y = static_cast<float>(Units(end.Y, bins.OriginY, perUnit) - Units(a.Y, bins.OriginY, perUnit));
  }
  return x * x + y * y <= this->Current->Errors->ReachSquared;
}

/**
 * Whether the disc of a quotient, or a little more, is within the window. Its position s is in edge
 * lengths along the edge's left normal; on the left, a disc of larger s contains those of smaller.
 */
ELEVATION_WIDE_INLINE bool WideApexSearch::IsInWindow(
  float bx, float by, float dot, float cross) const
{
  const Window& window = *this->Current;
  const Bounds& errors = *window.Errors;
  const float above = dot + errors.DotError;
  const float s = 0.5f * above / (cross - std::copysign(errors.CrossError, above));
  const float radiusSquared = (bx * bx + by * by) * (0.25f + s * s);
  const float centerX = 0.5f * bx - s * by, centerY = 0.5f * by + s * bx;
  const float keep = errors.Margin + 4.0f * errors.CoordinateError * (std::fabs(s) + 1.0f);
  const float room =
    std::min(std::min(window.Left + centerX, window.Right - centerX), window.Top - centerY) - keep;
  return room > 0.0f && radiusSquared * 1.0002f < room * room;
}

/** @param[out] guess  the candidate that is probably the apex */
template <int Vectors>
ELEVATION_WIDE_INLINE WideApexSearch::Candidates WideApexSearch::Search(
  float bx, float by, int& guess) const
{
  const __m256 endX = _mm256_set1_ps(bx), endY = _mm256_set1_ps(by);
  const __m256 clear = _mm256_set1_ps(4.0f * this->Current->Errors->CrossError);
  const __m256 most = _mm256_set1_ps(std::numeric_limits<float>::max());
  const __m256 laneBits = _mm256_castsi256_ps(_mm256_set1_epi32(63));
  const __m256i eight = _mm256_set1_epi32(8);
  __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  __m256 crosses[Vectors], dots[Vectors];
  __m256 least = most;
  for (int i = 0; i < Vectors; ++i)
  {
    const __m256 x = _mm256_load_ps(this->Current->X + 8 * i),
                 y = _mm256_load_ps(this->Current->Y + 8 * i);
    const __m256 square = _mm256_load_ps(this->Current->Square + 8 * i);
    const __m256 cross = _mm256_fmsub_ps(endX, y, _mm256_mul_ps(endY, x));
    const __m256 dot = _mm256_fnmadd_ps(x, endX, _mm256_fnmadd_ps(y, endY, square));
    crosses[i] = cross;
    dots[i] = dot;
    // The lowest bits of a quotient tell whose it is: so the least of all tells where it is.
    const __m256 quotient =
      _mm256_or_ps(_mm256_andnot_ps(laneBits, _mm256_mul_ps(dot, _mm256_rcp_ps(cross))),
        _mm256_castsi256_ps(lanes));
    lanes = _mm256_add_epi32(lanes, eight);
    const __m256 isLeft = _mm256_cmp_ps(cross, clear, _CMP_GT_OQ);
    least = _mm256_min_ps(least, _mm256_blendv_ps(most, quotient, isLeft));
  }
  const float best = Least(least);
  if (!(best < std::numeric_limits<float>::max()))
  {
    guess = 0;
    return {};
  }
  std::uint32_t bits;
  std::memcpy(&bits, &best, sizeof bits);
  guess = static_cast<int>(bits & 63u);
  const float x = this->Current->X[guess], y = this->Current->Y[guess];
  const float cross = bx * y - by * x;
  const float dot = this->Current->Square[guess] - (x * bx + y * by);

  Candidates found;
  const __m256 bestCross = _mm256_set1_ps(cross), bestDot = _mm256_set1_ps(dot);
  const __m256 error = _mm256_set1_ps(this->Current->Errors->ComparisonError);
  for (int i = 0; i < Vectors; ++i)
  {
    const __m256 difference =
      _mm256_fmsub_ps(dots[i], bestCross, _mm256_mul_ps(bestDot, crosses[i]));
    const __m256 isCandidate = _mm256_cmp_ps(difference, error, _CMP_LE_OQ);
    found.Bits |= static_cast<std::uint64_t>(_mm256_movemask_ps(isCandidate)) << (8 * i);
  }
  found.Bits &= ~(std::uint64_t(1) << this->Current->OriginLane);

  found.IsProved = this->IsInWindow(bx, by, dot, cross);
  return found;
}

/**
 * Leaves out the end of the edge to b = (bx, by); what is not a candidate by the errors that its own
 * size allows, rather than the window's; and, told exactly, what is not on the edge's left.
 */
ELEVATION_WIDE void WideApexSearch::Sift(
  Index b, float bx, float by, int guess, Candidates& candidates) const
{
  const Window& window = *this->Current;
  const float bestX = window.X[guess], bestY = window.Y[guess];
  const float bestCross = bx * bestY - by * bestX;
  const float bestDot = bestX * (bestX - bx) + bestY * (bestY - by);
  const float e = 2.0f * window.Errors->CoordinateError;
  const float u = 8.0f * static_cast<float>(Roundoff);
  const float length = std::fabs(bx) + std::fabs(by);
  const float bestSize = std::fabs(bestX) + std::fabs(bestY);
  const float bestCrossError = e * (length + bestSize) + u * length * bestSize;
  const float bestDotError = (e + u * bestSize) * (2.0f * bestSize + length);

  const __m256 signBit = _mm256_set1_ps(-0.0f);
  const __m256 endX = _mm256_set1_ps(bx), endY = _mm256_set1_ps(by);
  const __m256 lengths = _mm256_set1_ps(length), es = _mm256_set1_ps(e), us = _mm256_set1_ps(u);
  std::uint64_t isWorse = 0, isLeft = 0;
  for (int i = 0; i < window.Vectors; ++i)
  {
    const __m256 x = _mm256_load_ps(window.X + 8 * i), y = _mm256_load_ps(window.Y + 8 * i);
    const __m256 cross = _mm256_fmsub_ps(endX, y, _mm256_mul_ps(endY, x));
    const __m256 dot =
      _mm256_fmadd_ps(x, _mm256_sub_ps(x, endX), _mm256_mul_ps(y, _mm256_sub_ps(y, endY)));
    const __m256 size = _mm256_add_ps(_mm256_andnot_ps(signBit, x), _mm256_andnot_ps(signBit, y));
    const __m256 ofSize = _mm256_fmadd_ps(us, size, es);
    const __m256 crossError = _mm256_fmadd_ps(ofSize, lengths, _mm256_mul_ps(es, size));
    const __m256 dotError =
      _mm256_mul_ps(ofSize, _mm256_add_ps(_mm256_add_ps(size, size), lengths));
    const __m256 absoluteCross = _mm256_andnot_ps(signBit, cross);
    __m256 error =
      _mm256_mul_ps(_mm256_andnot_ps(signBit, dot), _mm256_set1_ps(2.0f * bestCrossError));
    error = _mm256_fmadd_ps(_mm256_set1_ps(2.0f * std::fabs(bestCross)), dotError, error);
    error = _mm256_fmadd_ps(
      _mm256_set1_ps(2.0f * bestDotError), _mm256_add_ps(absoluteCross, crossError), error);
    error = _mm256_fmadd_ps(_mm256_set1_ps(2.0f * std::fabs(bestDot)), crossError, error);
    const __m256 difference = _mm256_fmsub_ps(
      dot, _mm256_set1_ps(bestCross), _mm256_mul_ps(_mm256_set1_ps(bestDot), cross));
    const int worse = _mm256_movemask_ps(_mm256_cmp_ps(difference, error, _CMP_GT_OQ));
    const int left = _mm256_movemask_ps(_mm256_cmp_ps(cross, crossError, _CMP_GT_OQ));
    isWorse |= static_cast<std::uint64_t>(worse) << (8 * i);
    isLeft |= static_cast<std::uint64_t>(left) << (8 * i);
  }
  candidates.Bits &= ~isWorse;
  for (std::uint64_t left = candidates.Bits & ~isLeft; left; left &= left - 1)
  {
    const Index slot = window.Slots[__builtin_ctzll(left)];
    if (slot == b ||
      Orientation(this->Grid.PointAt(window.Origin), this->Grid.PointAt(b),
        this->Grid.PointAt(slot)) != Positive)
    {
      candidates.Bits &= ~(left & (~left + 1));
    }
  }
  candidates.IsProved = candidates.IsProved && candidates.Bits != 0;
}

/** Looks closer: whether there is but one candidate, the guess, after all. */
bool WideApexSearch::IsDecided(Index b, float bx, float by, int& guess, Candidates& candidates) const
{
  if (!candidates.IsProved)
  {
    candidates.Bits = std::uint64_t(1) << guess; // a start for the search elsewhere
    return false;
  }
  this->Sift(b, bx, by, guess, candidates);
  if (!candidates.IsProved || (candidates.Bits & (candidates.Bits - 1)) != 0)
  {
    return false;
  }
  guess = __builtin_ctzll(candidates.Bits);
  return true;
}

ELEVATION_WIDE WideApexSearch::Candidates WideApexSearch::FindCandidates(Index b) const
{
  int guess;
  float x, y;
  if (!this->PlaceEnd(b, 0, x, y))
  {
    return {};
  }
  const int vectors = this->Current->Vectors;
  Candidates found = vectors == WidestVectors ? this->Search<WidestVectors>(x, y, guess)
    : vectors == EvenVectors                  ? this->Search<EvenVectors>(x, y, guess)
                                              : this->Search<MostVectors>(x, y, guess);
  this->Sift(b, x, y, guess, found);
  return found;
}

template <int Vectors>
ELEVATION_WIDE_INLINE int WideApexSearch::FollowVectors(
  Index b, Index last, Index* neighbors, Candidates& open) const
{
  int guess;
  float x, y;
  std::uint64_t end = this->Current->LanesOf<Vectors>(b);
  if (!this->PlaceEnd(b, end, x, y))
  {
    open = Candidates();
    return 0;
  }
  for (int count = 0;;)
  {
    open = this->Search<Vectors>(x, y, guess);
    open.Bits &= ~end;
    if (!open.IsProved || open.Bits != std::uint64_t(1) << guess)
    {
      if (!this->IsDecided(b, x, y, guess, open))
      {
        return count;
      }
    }
    b = neighbors[count++] = this->Current->Slots[guess];
    if (b == last || count == Capacity)
    {
      open = Candidates();
      return count;
    }
    end = std::uint64_t(1) << guess;
    x = this->Current->X[guess];
    y = this->Current->Y[guess];
  }
}

/** As FollowVectors(), for windows of two vectors of sixteen. */
ELEVATION_WIDEST int WideApexSearch::FollowWidest(
  Index b, Index last, Index* neighbors, Candidates& open) const
{
  const Window& window = *this->Current;
  const __m512 x0 = _mm512_load_ps(window.X), x1 = _mm512_load_ps(window.X + 16);
  const __m512 y0 = _mm512_load_ps(window.Y), y1 = _mm512_load_ps(window.Y + 16);
  const __m512 square0 = _mm512_load_ps(window.Square);
  const __m512 square1 = _mm512_load_ps(window.Square + 16);
  const __m512i slot = _mm512_set1_epi32(b);
  std::uint32_t ends = std::uint32_t(1) << window.OriginLane;
  std::uint32_t end = _mm512_cmpeq_epi32_mask(slot, _mm512_load_si512(window.Slots)) |
    static_cast<std::uint32_t>(_mm512_cmpeq_epi32_mask(slot, _mm512_load_si512(window.Slots + 16)))
      << 16;
  float bx, by;
  if (!this->PlaceEnd(b, end, bx, by))
  {
    open = Candidates();
    return 0;
  }

  const __m512 clear = _mm512_set1_ps(4.0f * window.Errors->CrossError);
  const __m512 error = _mm512_set1_ps(window.Errors->ComparisonError);
  const __m512 most = _mm512_set1_ps(std::numeric_limits<float>::max());
  const __m512i laneBits = _mm512_set1_epi32(63);
  const __m512i lanes0 = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m512i lanes1 = _mm512_add_epi32(lanes0, _mm512_set1_epi32(16));
  __m512 endX = _mm512_set1_ps(bx), endY = _mm512_set1_ps(by);
  for (int count = 0;;)
  {
    const __m512 cross0 = _mm512_fmsub_ps(endX, y0, _mm512_mul_ps(endY, x0));
    const __m512 cross1 = _mm512_fmsub_ps(endX, y1, _mm512_mul_ps(endY, x1));
    const __m512 dot0 = _mm512_fnmadd_ps(x0, endX, _mm512_fnmadd_ps(y0, endY, square0));
    const __m512 dot1 = _mm512_fnmadd_ps(x1, endX, _mm512_fnmadd_ps(y1, endY, square1));
    const __m512 quotient0 = _mm512_mul_ps(dot0, _mm512_rcp14_ps(cross0));
    const __m512 quotient1 = _mm512_mul_ps(dot1, _mm512_rcp14_ps(cross1));
    // Bit by bit: lane where laneBits is set, quotient elsewhere.
    const __m512 marked0 = _mm512_castsi512_ps(
      _mm512_ternarylogic_epi32(laneBits, lanes0, _mm512_castps_si512(quotient0), 0xca));
    const __m512 marked1 = _mm512_castsi512_ps(
      _mm512_ternarylogic_epi32(laneBits, lanes1, _mm512_castps_si512(quotient1), 0xca));
    __m512 least = _mm512_mask_mov_ps(most, _mm512_cmp_ps_mask(cross0, clear, _CMP_GT_OQ), marked0);
    least =
      _mm512_mask_min_ps(least, _mm512_cmp_ps_mask(cross1, clear, _CMP_GT_OQ), least, marked1);
    // The least in all places.
    least = _mm512_min_ps(least, _mm512_shuffle_f32x4(least, least, 0x4e));
    least = _mm512_min_ps(least, _mm512_shuffle_f32x4(least, least, 0xb1));
    least = _mm512_min_ps(least, _mm512_permute_ps(least, 0x4e));
    least = _mm512_min_ps(least, _mm512_permute_ps(least, 0xb1));
    const __m512i which = _mm512_castps_si512(least);
    __m512 nextX = _mm512_permutex2var_ps(x0, which, x1);
    __m512 nextY = _mm512_permutex2var_ps(y0, which, y1);
    const float best = _mm512_cvtss_f32(least);
    if (!(best < std::numeric_limits<float>::max()))
    {
      open = Candidates();
      return count;
    }
    std::uint32_t bits;
    std::memcpy(&bits, &best, sizeof bits);
    int guess = static_cast<int>(bits & 31u);
    float x = _mm512_cvtss_f32(nextX), y = _mm512_cvtss_f32(nextY);
    const float cross = bx * y - by * x;
    const float dot = (x * x + y * y) - (x * bx + y * by);
    const __m512 bestCross = _mm512_set1_ps(cross), bestDot = _mm512_set1_ps(dot);
    const __m512 difference0 = _mm512_fmsub_ps(dot0, bestCross, _mm512_mul_ps(bestDot, cross0));
    const __m512 difference1 = _mm512_fmsub_ps(dot1, bestCross, _mm512_mul_ps(bestDot, cross1));
    const std::uint32_t low = _mm512_cmp_ps_mask(difference0, error, _CMP_LE_OQ);
    const std::uint32_t high = _mm512_cmp_ps_mask(difference1, error, _CMP_LE_OQ);
    const std::uint32_t candidates = (low | high << 16) & ~(ends | end);
    const bool isProved = this->IsInWindow(bx, by, dot, cross);
    if (!isProved || candidates != std::uint32_t(1) << guess)
    {
      open.Bits = candidates;
      open.IsProved = isProved;
      if (!this->IsDecided(b, bx, by, guess, open))
      {
        return count;
      }
      x = window.X[guess];
      y = window.Y[guess];
      nextX = _mm512_set1_ps(x);
      nextY = _mm512_set1_ps(y);
    }
    b = neighbors[count++] = window.Slots[guess];
    if (b == last || count == Capacity)
    {
      open = Candidates();
      return count;
    }
    end = std::uint32_t(1) << guess;
    bx = x;
    by = y;
    endX = nextX;
    endY = nextY;
  }
}

ELEVATION_WIDE int WideApexSearch::Follow(
  Index b, Index last, Index* neighbors, Candidates& open) const
{
  return this->Current->Vectors == WidestVectors ? this->FollowWidest(b, last, neighbors, open)
    : this->Current->Vectors == EvenVectors
    ? this->FollowVectors<EvenVectors>(b, last, neighbors, open)
    : this->FollowVectors<MostVectors>(b, last, neighbors, open);
}

#else

bool WideApexSearch::IsSupported()
{
  return false;
}

WideApexSearch::WideApexSearch(const BinGrid& grid)
  : Grid(grid)
  , IsWidest(false)
{
}

bool WideApexSearch::Gather(Index, Index)
{
  return false;
}

WideApexSearch::Candidates WideApexSearch::FindCandidates(Index) const
{
  return {};
}

int WideApexSearch::Follow(Index, Index, Index*, Candidates&) const
{
  return 0;
}

#endif

} // namespace elevation
