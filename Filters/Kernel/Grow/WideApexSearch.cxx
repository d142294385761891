// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "WideApexSearch.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 warns of undefined values in its own intrinsics.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace elevation
{

WideApexSearch::WideApexSearch(const BinGrid& grid, InstructionSet widest)
  : Grid(grid)
  , Windows(grid, std::min(widest, WidestInstructions()) == InstructionSet::AVX512)
{
}

#ifdef ELEVATION_HAS_AVX2
namespace
{
// The passes for an edge: Search() guesses the apex and collects those that are not clearly worse;
// IsInWindow() proves that no point outside the window is; Sift() removes candidates with sharper
// bounds and exact predicates; IsDecided() says whether one is left.

/** The least of eight values. */
ELEVATION_WIDE inline float Least(__m256 values)
{
  __m128 half = _mm_min_ps(_mm256_castps256_ps128(values), _mm256_extractf128_ps(values, 1));
  half = _mm_min_ps(half, _mm_movehl_ps(half, half));
  half = _mm_min_ss(half, _mm_movehdup_ps(half));
  return _mm_cvtss_f32(half);
}
} // namespace

/**
 * The position of the end of an edge from the vertex, in the window's units.
 * @param[in] lanes  of the end in the window, as bits; 0 if it is not there
 * @return false if it is too far away
 */
ELEVATION_WIDE_INLINE bool WideApexSearch::PlaceEnd(
  Index b, std::uint64_t lanes, float& x, float& y) const
{
  const Window& window = this->Windows.Current();
  if (lanes != 0)
  {
    const int lane = __builtin_ctzll(lanes);
    x = window.X[lane];
    y = window.Y[lane];
    if (x == x) // NaN is beyond the end of a list
    {
      return true;
    }
  }
  // Beyond R, the error bounds would not hold.
  this->Windows.Place(b, x, y);
  return x * x + y * y <= window.Errors->ReachSquared;
}

/**
 * Whether the disc of a quotient, slightly enlarged, is within the window. Its position s is in
 * edge lengths along the edge's left normal; on the left, a disc of larger s contains those of
 * smaller s.
 */
ELEVATION_WIDE_INLINE bool WideApexSearch::IsInWindow(
  float bx, float by, float dot, float cross) const
{
  const Window& window = this->Windows.Current();
  const PointWindows::Bounds& errors = *window.Errors;
  const float above = dot + errors.DotError;
  // Rounded up: dot above its value, cross towards the side that makes the quotient larger.
  const float s = 0.5f * above / (cross - std::copysign(errors.CrossError, above));
  const float radiusSquared = (bx * bx + by * by) * (0.25f + s * s);
  const float centerX = 0.5f * bx - s * by, centerY = 0.5f * by + s * bx;
  const float keep = errors.Margin + 4.0f * errors.CoordinateError * (std::fabs(s) + 1.0f);
  const float room =
    std::min(std::min(window.Left + centerX, window.Right - centerX), window.Top - centerY) - keep;
  // The disc's part below the vertex needs no room: the vertex is the lowest of its triangles.
  return room > 0.0f && radiusSquared * 1.0002f < room * room;
}

/** @param[out] guess  the candidate that is probably the apex */
template <int Vectors>
ELEVATION_WIDE_INLINE WideApexSearch::Candidates WideApexSearch::Search(
  float bx, float by, int& guess) const
{
  const __m256 endX = _mm256_set1_ps(bx), endY = _mm256_set1_ps(by);
  // Only points that are certainly on the left may be the guess; the others can still be
  // candidates.
  const __m256 clear = _mm256_set1_ps(4.0f * this->Windows.Current().Errors->CrossError);
  const __m256 most = _mm256_set1_ps(std::numeric_limits<float>::max());
  const __m256 laneBits = _mm256_castsi256_ps(_mm256_set1_epi32(63));
  const __m256i eight = _mm256_set1_epi32(8);
  __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  __m256 crosses[Vectors], dots[Vectors];
  __m256 least = most;
  for (int i = 0; i < Vectors; ++i)
  {
    const __m256 x = _mm256_load_ps(this->Windows.Current().X + 8 * i),
                 y = _mm256_load_ps(this->Windows.Current().Y + 8 * i);
    const __m256 square = _mm256_load_ps(this->Windows.Current().Square + 8 * i);
    const __m256 cross = _mm256_fmsub_ps(endX, y, _mm256_mul_ps(endY, x));
    const __m256 dot = _mm256_fnmadd_ps(x, endX, _mm256_fnmadd_ps(y, endY, square));
    crosses[i] = cross;
    dots[i] = dot;
    // The lowest bits of a quotient are replaced by its lane, so the least one contains its lane.
    // The quotient needs few bits, as it only makes a guess: the reciprocal has twelve.
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
    // Lane 0 is a point, as the vertex's own row comes first: a harmless guess.
    return {};
  }
  std::uint32_t bits;
  std::memcpy(&bits, &best, sizeof bits);
  // From here on the guess is the point to compare with; its products are computed once more, since
  // a lane of a vector cannot be picked by a variable.
  guess = static_cast<int>(bits & 63u);
  const float x = this->Windows.Current().X[guess], y = this->Windows.Current().Y[guess];
  const float cross = bx * y - by * x;
  const float dot = this->Windows.Current().Square[guess] - (x * bx + y * by);

  Candidates found;
  const __m256 bestCross = _mm256_set1_ps(cross), bestDot = _mm256_set1_ps(dot);
  // NaN fails the comparison: empty lanes are no candidates.
  const __m256 error = _mm256_set1_ps(this->Windows.Current().Errors->ComparisonError);
  for (int i = 0; i < Vectors; ++i)
  {
    const __m256 difference =
      _mm256_fmsub_ps(dots[i], bestCross, _mm256_mul_ps(bestDot, crosses[i]));
    const __m256 isCandidate = _mm256_cmp_ps(difference, error, _CMP_LE_OQ);
    found.Bits |= static_cast<std::uint64_t>(_mm256_movemask_ps(isCandidate)) << (8 * i);
  }
  // At the vertex itself all products are zero, so it would be a candidate always.
  found.Bits &= ~(std::uint64_t(1) << this->Windows.Current().OriginLane);

  found.IsProved = this->IsInWindow(bx, by, dot, cross);
  return found;
}

/**
 * Removes candidates: the end of the edge to b = (bx, by); points excluded by error bounds of their
 * own size, rather than the window's; and points that are, exactly, not on the left of the edge.
 */
ELEVATION_WIDE void WideApexSearch::Sift(
  Index b, float bx, float by, int guess, Candidates& candidates) const
{
  const Window& window = this->Windows.Current();
  const float bestX = window.X[guess], bestY = window.Y[guess];
  const float bestCross = bx * bestY - by * bestX;
  const float bestDot = bestX * (bestX - bx) + bestY * (bestY - by);
  // The bounds of WideApexSearch.h with the sizes of these points in place of R, and factors of two
  // and more over what the proof needs. They decide most cases that the window's bound leaves open:
  // with points close to the vertex, R is far too large.
  const float e = 2.0f * window.Errors->CoordinateError;
  const float u = 8.0f * static_cast<float>(PointWindows::Roundoff);
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
  // Only a few lanes are left here. The lowest bit of left is the candidate.
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

/** Whether sifting leaves only one candidate, which becomes the guess. */
bool WideApexSearch::IsDecided(
  Index b, float bx, float by, int& guess, Candidates& candidates) const
{
  if (!candidates.IsProved)
  {
    candidates.Bits = std::uint64_t(1) << guess; // a first guess for the search elsewhere
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
  const int vectors = this->Windows.Current().Vectors;
  Candidates found = vectors == WidestVectors ? this->Search<WidestVectors>(x, y, guess)
    : vectors == EvenVectors                  ? this->Search<EvenVectors>(x, y, guess)
                                              : this->Search<MostVectors>(x, y, guess);
  this->Sift(b, x, y, guess, found);
  return found;
}

/** Follow() for windows of so many vectors of eight. */
template <int Vectors>
ELEVATION_WIDE_INLINE int WideApexSearch::FollowVectors(
  Index b, Index last, Index* neighbors, Candidates& open) const
{
  int guess;
  float x, y;
  std::uint64_t end = this->Windows.Current().LanesOf<Vectors>(b);
  if (!this->PlaceEnd(b, end, x, y))
  {
    open = Candidates();
    return 0;
  }
  for (int count = 0;;)
  {
    open = this->Search<Vectors>(x, y, guess);
    open.Bits &= ~end;
    // The usual way takes one comparison: the guess is the only candidate, and proved.
    if (!open.IsProved || open.Bits != std::uint64_t(1) << guess)
    {
      if (!this->IsDecided(b, x, y, guess, open))
      {
        return count;
      }
    }
    b = neighbors[count++] = this->Windows.Current().Slots[guess];
    if (b == last || count == Capacity)
    {
      open = Candidates();
      return count;
    }
    // The apex is the end of the next edge: no search for its lanes, no rounding once more.
    end = std::uint64_t(1) << guess;
    x = this->Windows.Current().X[guess];
    y = this->Windows.Current().Y[guess];
  }
}

/** A window of two vectors of sixteen points, with their products for an edge. */
struct WidestWindow
{
  __m512 X0, X1, Y0, Y1, Square0, Square1;
  __m512 Cross0, Cross1, Dot0, Dot1;

  ELEVATION_WIDEST_INLINE explicit WidestWindow(const PointWindows::Window& window)
    : X0(_mm512_load_ps(window.X))
    , X1(_mm512_load_ps(window.X + 16))
    , Y0(_mm512_load_ps(window.Y))
    , Y1(_mm512_load_ps(window.Y + 16))
    , Square0(_mm512_load_ps(window.Square))
    , Square1(_mm512_load_ps(window.Square + 16))
  {
  }

  /**
   * The least quotient of points clearly on the left, in all lanes; its lowest bits are its lane.
   */
  ELEVATION_WIDEST_INLINE __m512 LeastQuotient(__m512 endX, __m512 endY, __m512 clear, __m512 most)
  {
    const __m512i laneBits = _mm512_set1_epi32(63);
    const __m512i lanes0 = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i lanes1 = _mm512_add_epi32(lanes0, _mm512_set1_epi32(16));
    this->Cross0 = _mm512_fmsub_ps(endX, this->Y0, _mm512_mul_ps(endY, this->X0));
    this->Cross1 = _mm512_fmsub_ps(endX, this->Y1, _mm512_mul_ps(endY, this->X1));
    this->Dot0 = _mm512_fnmadd_ps(this->X0, endX, _mm512_fnmadd_ps(this->Y0, endY, this->Square0));
    this->Dot1 = _mm512_fnmadd_ps(this->X1, endX, _mm512_fnmadd_ps(this->Y1, endY, this->Square1));
    const __m512 quotient0 = _mm512_mul_ps(this->Dot0, _mm512_rcp14_ps(this->Cross0));
    const __m512 quotient1 = _mm512_mul_ps(this->Dot1, _mm512_rcp14_ps(this->Cross1));
    // Bit by bit: lane where laneBits is set, quotient elsewhere.
    const __m512 marked0 = _mm512_castsi512_ps(
      _mm512_ternarylogic_epi32(laneBits, lanes0, _mm512_castps_si512(quotient0), 0xca));
    const __m512 marked1 = _mm512_castsi512_ps(
      _mm512_ternarylogic_epi32(laneBits, lanes1, _mm512_castps_si512(quotient1), 0xca));
    __m512 least =
      _mm512_mask_mov_ps(most, _mm512_cmp_ps_mask(this->Cross0, clear, _CMP_GT_OQ), marked0);
    // Four halvings, each with both halves exchanged, leave the minimum in all lanes: it serves as
    // the index of the permutation that fetches its coordinates.
    least = _mm512_mask_min_ps(
      least, _mm512_cmp_ps_mask(this->Cross1, clear, _CMP_GT_OQ), least, marked1);
    least = _mm512_min_ps(least, _mm512_shuffle_f32x4(least, least, 0x4e));
    least = _mm512_min_ps(least, _mm512_shuffle_f32x4(least, least, 0xb1));
    least = _mm512_min_ps(least, _mm512_permute_ps(least, 0x4e));
    return _mm512_min_ps(least, _mm512_permute_ps(least, 0xb1));
  }

  /** Which points are not clearly outside the circle of the edge and a point, as bits. */
  ELEVATION_WIDEST_INLINE std::uint32_t Candidates(float cross, float dot, __m512 error) const
  {
    const __m512 bestCross = _mm512_set1_ps(cross), bestDot = _mm512_set1_ps(dot);
    const __m512 difference0 =
      _mm512_fmsub_ps(this->Dot0, bestCross, _mm512_mul_ps(bestDot, this->Cross0));
    const __m512 difference1 =
      _mm512_fmsub_ps(this->Dot1, bestCross, _mm512_mul_ps(bestDot, this->Cross1));
    const std::uint32_t low = _mm512_cmp_ps_mask(difference0, error, _CMP_LE_OQ);
    const std::uint32_t high = _mm512_cmp_ps_mask(difference1, error, _CMP_LE_OQ);
    return low | high << 16;
  }
};

/** FollowVectors() for windows of two vectors of sixteen. In one, as all of it is in registers. */
ELEVATION_WIDEST int WideApexSearch::FollowWidest(
  Index b, Index last, Index* neighbors, Candidates& open) const
{
  const Window& window = this->Windows.Current();
  WidestWindow points(window);
  const __m512i slot = _mm512_set1_epi32(b);
  const std::uint32_t origin = std::uint32_t(1) << window.OriginLane;
  std::uint32_t end = _mm512_cmpeq_epi32_mask(slot, _mm512_load_si512(window.Slots)) |
    static_cast<std::uint32_t>(_mm512_cmpeq_epi32_mask(slot, _mm512_load_si512(window.Slots + 16)))
      << 16;
  open = Candidates();
  float bx, by;
  if (!this->PlaceEnd(b, end, bx, by))
  {
    return 0;
  }
  const __m512 clear = _mm512_set1_ps(4.0f * window.Errors->CrossError);
  const __m512 error = _mm512_set1_ps(window.Errors->ComparisonError);
  const __m512 most = _mm512_set1_ps(std::numeric_limits<float>::max());
  __m512 endX = _mm512_set1_ps(bx), endY = _mm512_set1_ps(by);
  for (int count = 0;;)
  {
    const __m512 least = points.LeastQuotient(endX, endY, clear, most);
    const __m512i which = _mm512_castps_si512(least);
    // Fetched before it is known whether the guess stands: the processor overlaps both.
    __m512 nextX = _mm512_permutex2var_ps(points.X0, which, points.X1);
    __m512 nextY = _mm512_permutex2var_ps(points.Y0, which, points.Y1);
    const float best = _mm512_cvtss_f32(least);
    if (!(best < std::numeric_limits<float>::max()))
    {
      return count;
    }
    std::uint32_t bits;
    std::memcpy(&bits, &best, sizeof bits);
    int guess = static_cast<int>(bits & 31u);
    float x = _mm512_cvtss_f32(nextX), y = _mm512_cvtss_f32(nextY);
    const float cross = bx * y - by * x;
    const float dot = (x * x + y * y) - (x * bx + y * by);
    const std::uint32_t candidates = points.Candidates(cross, dot, error) & ~(origin | end);
    const bool isProved = this->IsInWindow(bx, by, dot, cross);
    if (!isProved || candidates != std::uint32_t(1) << guess)
    {
      open.Bits = candidates;
      open.IsProved = isProved;
      if (!this->IsDecided(b, bx, by, guess, open))
      {
        return count;
      }
      open = Candidates();
      x = window.X[guess];
      y = window.Y[guess];
      nextX = _mm512_set1_ps(x);
      nextY = _mm512_set1_ps(y);
    }
    b = neighbors[count++] = window.Slots[guess];
    if (b == last || count == Capacity)
    {
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
  return this->Windows.Current().Vectors == WidestVectors
    ? this->FollowWidest(b, last, neighbors, open)
    : this->Windows.Current().Vectors == EvenVectors
    ? this->FollowVectors<EvenVectors>(b, last, neighbors, open)
    : this->FollowVectors<MostVectors>(b, last, neighbors, open);
}

#else

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
