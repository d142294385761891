// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Surroundings.h"

#include "Predicates.h"

#include <algorithm>
#include <cmath>

#ifdef ELEVATION_HAS_AVX2
#include <immintrin.h>
#endif

namespace elevation
{
#ifdef ELEVATION_HAS_AVX2

namespace
{
constexpr double PointsInBox = 14.0; // as expected; half of that when it was too much
constexpr float Infinity = std::numeric_limits<float>::infinity();

__attribute__((target("avx2,fma"), always_inline)) inline __m256 EightRelative(
  const double* values, __m256d from)
{
  const __m128 low = _mm256_cvtpd_ps(_mm256_sub_pd(_mm256_loadu_pd(values), from));
  const __m128 high = _mm256_cvtpd_ps(_mm256_sub_pd(_mm256_loadu_pd(values + 4), from));
  return _mm256_set_m128(high, low);
}
} // namespace

bool Surroundings::IsSupported()
{
  static const bool isSupported = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return isSupported;
}

bool Surroundings::Gather(Index origin)
{
  this->Count = 0;
  this->Origin = origin;
  this->Path.clear();
  const BinGrid::Layout& bins = this->Grid.Bins;
  if (bins.HasPlainBins)
  {
    const Index row = bins.Row(this->Grid.Y[origin]), column = bins.Column(this->Grid.X[origin]);
    if (this->GatherBins(column, row, 2, 3) || this->GatherBins(column, row, 1, 2) ||
      this->GatherBins(column, row, 1, 1))
    {
      return true;
    }
  }
  return this->GatherBox();
}

__attribute__((target("avx2,fma"))) bool Surroundings::GatherBins(
  Index column, Index row, Index columnsToEachSide, Index rowsAbove)
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  const double originX = this->Grid.X[this->Origin], originY = this->Grid.Y[this->Origin];
  const Index firstColumn = std::max(column - columnsToEachSide, 0);
  const Index lastColumn = std::min(column + columnsToEachSide, bins.Columns - 1);
  const Index lastRow = std::min(row + rowsAbove, bins.Rows - 1);

  const __m256d x0 = _mm256_set1_pd(originX), y0 = _mm256_set1_pd(originY);
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  int count = 0;
  for (Index r = row; r <= lastRow; ++r)
  {
    const auto slots = this->Grid.Slots(r, firstColumn, lastColumn);
    if (count + (slots.second - slots.first) > Capacity)
    {
      return false;
    }
    // Whole vectors: what is too much is overwritten by the next row, or made not a number below.
    for (Index slot = slots.first; slot < slots.second; slot += 8)
    {
      const int at = count + (slot - slots.first);
      _mm256_storeu_ps(this->X + at, EightRelative(this->Grid.X.data() + slot, x0));
      _mm256_storeu_ps(this->Y + at, EightRelative(this->Grid.Y.data() + slot, y0));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(this->Slots + at),
        _mm256_add_epi32(_mm256_set1_epi32(slot), lanes));
    }
    count += slots.second - slots.first;
  }
  const __m256 nothing = _mm256_set1_ps(std::numeric_limits<float>::quiet_NaN());
  _mm256_storeu_ps(this->X + count, nothing);
  _mm256_storeu_ps(this->Y + count, nothing);
  this->Count = count;

  // The bounds of the bins as BinGrid finds them are those below but for rounding, which
  // BinGrid::Layout::HasPlainBins bounds by a thousandth of a bin.
  const double width = bins.BinWidth, height = bins.BinHeight;
  const double margin = 0.002;
  const double left = originX - (bins.OriginX + (firstColumn + margin) * width);
  const double right = (bins.OriginX + (lastColumn + 1 - margin) * width) - originX;
  const double top = (bins.OriginY + (lastRow + 1 - margin) * height) - originY;
  this->Left = firstColumn == 0 ? Infinity : static_cast<float>(left);
  this->Right = lastColumn == bins.Columns - 1 ? Infinity : static_cast<float>(right);
  this->Top = lastRow == bins.Rows - 1 ? Infinity : static_cast<float>(top);
  const double across = (2 * columnsToEachSide + 1) * width, up = (rowsAbove + 1) * height;
  this->ReachSquared = static_cast<float>(across * across + up * up);
  this->Margin = static_cast<float>(0.01 * std::min(width, height));
  return true;
}

/** As BinGrid::FindPath(), four boxes at a time. */
__attribute__((target("avx2,fma"))) void Surroundings::FindPath()
{
  const Point2 p = this->Grid.PointAt(this->Origin);
  const __m256d x = _mm256_set1_pd(p.X), y = _mm256_set1_pd(p.Y);
  const double infinity = std::numeric_limits<double>::infinity();
  const BinGrid::Node* node = &this->Grid.Nodes[this->Grid.Nodes.size() - 1];
  this->Path.assign(1, { node, 0, -infinity, infinity, -infinity, infinity });
  for (;;)
  {
    int place = 0;
    for (int half = 0; half < BinGrid::Node::Places; half += 4)
    {
      const __m256d holdsX =
        _mm256_and_pd(_mm256_cmp_pd(_mm256_loadu_pd(node->LowX + half), x, _CMP_LE_OQ),
          _mm256_cmp_pd(_mm256_loadu_pd(node->HighX + half), x, _CMP_GE_OQ));
      const __m256d holdsY =
        _mm256_and_pd(_mm256_cmp_pd(_mm256_loadu_pd(node->LowY + half), y, _CMP_LE_OQ),
          _mm256_cmp_pd(_mm256_loadu_pd(node->HighY + half), y, _CMP_GE_OQ));
      place |= _mm256_movemask_pd(_mm256_and_pd(holdsX, holdsY)) << half;
    }
    place = __builtin_ctz(place);
    if (node->Count[place] > 0)
    {
      return;
    }
    const BinGrid::Node* const child = &this->Grid.Nodes[node->First[place]];
    this->Path.push_back({ child, place, node->LowX[place], node->HighX[place], node->LowY[place],
      node->HighY[place] });
    node = child;
  }
}

bool Surroundings::GatherBox()
{
  const Point2 p = this->Grid.PointAt(this->Origin);
  this->FindPath();
  const BinGrid::Step& last = this->Path.back();
  const double size = last.Node->Size, width = last.HighX - last.LowX,
               height = last.HighY - last.LowY;
  for (double points : { PointsInBox, 0.5 * PointsInBox })
  {
    // The side of a square with so many points; where points lie in a strip narrower than that, the
    // length of it.
    double side = std::sqrt(points / size * width * height);
    if (!(side < std::min(width, height)))
    {
      side = points / size * std::max(width, height);
    }
    if (!(side > 1e-14 && side < 1e14)) // single precision holds squares
    {
      return false;
    }
    const double lowX = p.X - 0.55 * side, highX = p.X + 0.55 * side, highY = p.Y + 0.9 * side;
    const BinGrid::Step* top = &last;
    while (
      !(top->LowX < lowX && highX < top->HighX && highY < top->HighY) && top != this->Path.data())
    {
      --top;
    }
    if (this->GatherBox(*top->Node, lowX, highX, highY))
    {
      this->Left = static_cast<float>(0.999999 * (p.X - lowX));
      this->Right = static_cast<float>(0.999999 * (highX - p.X));
      this->Top = static_cast<float>(0.999999 * (highY - p.Y));
      this->ReachSquared = static_cast<float>(3.0 * side * side);
      this->Margin = static_cast<float>(0.002 * side);
      return true;
    }
  }
  return false;
}

/** All points of the box below a node, not below the origin; false when they are too many. */
__attribute__((target("avx2,fma"))) bool Surroundings::GatherBox(
  const BinGrid::Node& top, double lowX, double highX, double highY)
{
  const Point2 p = this->Grid.PointAt(this->Origin);
  const __m256d boxLowX = _mm256_set1_pd(lowX), boxHighX = _mm256_set1_pd(highX);
  const __m256d boxLowY = _mm256_set1_pd(p.Y), boxHighY = _mm256_set1_pd(highY);
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
        for (Index slot = node.First[place]; slot < end; ++slot)
        {
          // Written wherever it is, and kept when within; there is room for one too many.
          const double x = this->Grid.X[slot], y = this->Grid.Y[slot];
          this->X[count] = static_cast<float>(x - p.X);
          this->Y[count] = static_cast<float>(y - p.Y);
          this->Slots[count] = slot;
          count += (x >= lowX) & (x <= highX) & (y >= p.Y) & (y <= highY);
          if (count > Capacity)
          {
            return false;
          }
        }
      }
    }
  }
  const __m256 nothing = _mm256_set1_ps(std::numeric_limits<float>::quiet_NaN());
  _mm256_storeu_ps(this->X + count, nothing);
  _mm256_storeu_ps(this->Y + count, nothing);
  this->Count = count;
  return true;
}

__attribute__((target("avx2,fma"))) Surroundings::Candidates Surroundings::FindCandidates(
  Index b) const
{
  const Point2 a = this->Grid.PointAt(this->Origin);
  const Point2 end = this->Grid.PointAt(b);
  const float bx = static_cast<float>(end.X - a.X), by = static_cast<float>(end.Y - a.Y);
  const float lengthSquared = bx * bx + by * by;
  if (!(lengthSquared <= this->ReachSquared))
  {
    return {};
  }
  // Points and edge are shorter than the reach D. With u = 2^-24, cross is then wrong by at most
  // 4 u D^2, and dot by at most 12 u D^2.
  const float error = 24.0f * 0x1p-24f * this->ReachSquared;
  const __m256 edgeX = _mm256_set1_ps(bx), edgeY = _mm256_set1_ps(by);
  const __m256 errors = _mm256_set1_ps(error), one = _mm256_set1_ps(1.0f);
  const __m256 clear = _mm256_set1_ps(16.0f * error), minusError = _mm256_set1_ps(-error);
  const __m256 infinity = _mm256_set1_ps(Infinity);
  const __m256 signBit = _mm256_set1_ps(-0.0f);

  __m256 lower[(Capacity + 8) / 8];
  __m256 least = infinity;
  const int vectors = (this->Count + 7) / 8;
  for (int i = 0; i < vectors; ++i)
  {
    const __m256 x = _mm256_load_ps(this->X + 8 * i), y = _mm256_load_ps(this->Y + 8 * i);
    const __m256 cross = _mm256_fmsub_ps(edgeX, y, _mm256_mul_ps(edgeY, x));
    const __m256 dot =
      _mm256_fmadd_ps(x, _mm256_sub_ps(x, edgeX), _mm256_mul_ps(y, _mm256_sub_ps(y, edgeY)));
    const __m256 isLeft = _mm256_cmp_ps(cross, clear, _CMP_GT_OQ);
    // Near the edge's line: neither clearly left nor clearly right. Not the ends themselves.
    const __m256 isNear = _mm256_andnot_ps(isLeft, _mm256_cmp_ps(cross, minusError, _CMP_GE_OQ));
    for (int near = _mm256_movemask_ps(isNear); near; near &= near - 1)
    {
      const Index slot = this->Slots[8 * i + __builtin_ctz(near)];
      if (slot != b && slot != this->Origin &&
        Orientation(a, end, this->Grid.PointAt(slot)) == Positive)
      {
        return {};
      }
    }
    // quotient +- error / cross (1 + |quotient|): cross is wrong by less than a sixteenth here,
    // which the bounds' being twice as wide as needed covers.
    const __m256 perCross = _mm256_div_ps(one, cross);
    const __m256 quotient = _mm256_mul_ps(dot, perCross);
    const __m256 spread = _mm256_mul_ps(
      _mm256_mul_ps(errors, perCross), _mm256_add_ps(one, _mm256_andnot_ps(signBit, quotient)));
    lower[i] = _mm256_blendv_ps(infinity, _mm256_sub_ps(quotient, spread), isLeft);
    least =
      _mm256_min_ps(least, _mm256_blendv_ps(infinity, _mm256_add_ps(quotient, spread), isLeft));
  }
  __m128 half = _mm_min_ps(_mm256_castps256_ps128(least), _mm256_extractf128_ps(least, 1));
  half = _mm_min_ps(half, _mm_movehl_ps(half, half));
  half = _mm_min_ss(half, _mm_shuffle_ps(half, half, 1));
  const float upper = _mm_cvtss_f32(half);
  if (!(upper < Infinity))
  {
    return {};
  }

  // The disc of that quotient, within the window?
  const float s = 0.5f * upper;
  const float radius = std::sqrt(lengthSquared * (0.25f + s * s)) * 1.0001f + this->Margin;
  const float centerX = 0.5f * bx - s * by, centerY = 0.5f * by + s * bx;
  Candidates found;
  found.IsProved = centerX - radius > -this->Left && centerX + radius < this->Right &&
    centerY + radius < this->Top;
  const __m256 uppers = _mm256_set1_ps(upper);
  for (int i = 0; i < vectors; ++i)
  {
    const int within = _mm256_movemask_ps(_mm256_cmp_ps(lower[i], uppers, _CMP_LE_OQ));
    found.Bits |= static_cast<std::uint64_t>(within) << (8 * i);
  }
  return found;
}

#else

bool Surroundings::IsSupported()
{
  return false;
}

bool Surroundings::Gather(Index)
{
  return false;
}

void Surroundings::FindPath() {}

Surroundings::Candidates Surroundings::FindCandidates(Index) const
{
  return {};
}

#endif

} // namespace elevation
