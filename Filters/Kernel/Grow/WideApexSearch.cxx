// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "WideApexSearch.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Kernel/Grow/WideApexSearch.cxx"
#include "Kernel/Bins/Vectors.h"

#if ELEVATION_IS_VECTOR
HWY_BEFORE_NAMESPACE();
namespace elevation
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using Window = PointWindows::Window;
using Candidates = WideApexSearch::Candidates;
constexpr hn::ScalableTag<float> Floats;
constexpr hn::ScalableTag<std::int32_t> Integers;
using FloatVector = hn::Vec<decltype(Floats)>;
constexpr int InVector = static_cast<int>(hn::MaxLanes(Floats));

// The passes for an edge: Search() guesses the apex and collects those that are not clearly worse;
// IsInWindow() proves that no point outside the window is; Sift() removes candidates with sharper
// bounds and exact predicates; IsDecided() says whether one is left.

/** The lanes of vector i for which a comparison holds, at their place in the window. */
template <typename Tag, typename Mask>
HWY_INLINE std::uint64_t LanesOf(Tag tag, Mask mask, int i)
{
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(tag, mask, bytes);
  std::uint64_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits << (InVector * i);
}

/** The lanes of a slot among the first vectors of a window, as bits. */
template <int Vectors>
HWY_INLINE std::uint64_t LanesOf(const Window& window, Index slot)
{
  std::uint64_t lanes = 0;
  for (int i = 0; i < Vectors; ++i)
  {
    lanes |= LanesOf(Integers,
      hn::Eq(hn::Set(Integers, slot), hn::Load(Integers, window.Slots + InVector * i)), i);
  }
  return lanes;
}

/**
 * The position of the end of an edge from the vertex, in the window's units.
 * @param[in] lanes  of the end in the window, as bits; 0 if it is not there
 * @return false if it is too far away
 */
HWY_INLINE bool PlaceEnd(
  const PointWindows& windows, Index b, std::uint64_t lanes, float& x, float& y)
{
  const Window& window = windows.Current();
  if (lanes != 0)
  {
    const int lane = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(lanes));
    x = window.X[lane];
    y = window.Y[lane];
    if (x == x) // NaN is behind the points
    {
      return true;
    }
  }
  // Beyond R, the error bounds would not hold.
  windows.Place(b, x, y);
  return x * x + y * y <= window.Errors->ReachSquared;
}

/**
 * Whether the disc of a quotient, slightly enlarged, is within the window. Its position s is in
 * edge lengths along the edge's left normal; on the left, a disc of larger s contains those of
 * smaller s.
 */
HWY_INLINE bool IsInWindow(const Window& window, float bx, float by, float dot, float cross)
{
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
HWY_INLINE Candidates Search(const Window& window, float bx, float by, int& guess)
{
  const auto endX = hn::Set(Floats, bx), endY = hn::Set(Floats, by);
  // Only points that are certainly on the left may be the guess; the others can still be
  // candidates.
  const auto clear = hn::Set(Floats, 4.0f * window.Errors->CrossError);
  const auto most = hn::Set(Floats, std::numeric_limits<float>::max());
  const auto laneBits = hn::BitCast(Floats, hn::Set(Integers, 63));
  FloatVector crosses[Vectors], dots[Vectors];
  auto least = most;
  for (int i = 0; i < Vectors; ++i)
  {
    const auto x = hn::Load(Floats, window.X + InVector * i);
    const auto y = hn::Load(Floats, window.Y + InVector * i);
    const auto square = hn::Load(Floats, window.Square + InVector * i);
    const auto cross = hn::MulSub(endX, y, hn::Mul(endY, x));
    const auto dot = hn::NegMulAdd(x, endX, hn::NegMulAdd(y, endY, square));
    crosses[i] = cross;
    dots[i] = dot;
    // The lowest bits of a quotient are replaced by its lane, so the least one contains its lane.
    // An approximate reciprocal does, as the quotient only makes a guess.
    const auto quotient =
      hn::Or(hn::AndNot(laneBits, hn::Mul(dot, hn::ApproximateReciprocal(cross))),
        hn::BitCast(Floats, hn::Iota(Integers, InVector * i)));
    least = hn::Min(least, hn::IfThenElse(hn::Gt(cross, clear), quotient, most));
  }
  const float best = hn::GetLane(hn::MinOfLanes(Floats, least));
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
  const float x = window.X[guess], y = window.Y[guess];
  const float cross = bx * y - by * x;
  const float dot = window.Square[guess] - (x * bx + y * by);

  Candidates found;
  const auto bestCross = hn::Set(Floats, cross), bestDot = hn::Set(Floats, dot);
  // NaN fails the comparison: empty lanes are no candidates.
  const auto error = hn::Set(Floats, window.Errors->ComparisonError);
  for (int i = 0; i < Vectors; ++i)
  {
    const auto difference = hn::MulSub(dots[i], bestCross, hn::Mul(bestDot, crosses[i]));
    found.Bits |= LanesOf(Floats, hn::Le(difference, error), i);
  }
  // At the vertex itself all products are zero, so it would be a candidate always.
  found.Bits &= ~(std::uint64_t(1) << window.OriginLane);

  found.IsProved = IsInWindow(window, bx, by, dot, cross);
  return found;
}

/**
 * Removes candidates: the end of the edge to b = (bx, by); points excluded by error bounds of their
 * own size, rather than the window's; and points that are, exactly, not on the left of the edge.
 */
void Sift(const Window& window, const BinGrid& grid, Index b, float bx, float by, int guess,
  Candidates& candidates)
{
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

  const auto endX = hn::Set(Floats, bx), endY = hn::Set(Floats, by);
  const auto lengths = hn::Set(Floats, length), es = hn::Set(Floats, e), us = hn::Set(Floats, u);
  std::uint64_t isWorse = 0, isLeft = 0;
  for (int i = 0; InVector * i < window.Lanes; ++i)
  {
    const auto x = hn::Load(Floats, window.X + InVector * i);
    const auto y = hn::Load(Floats, window.Y + InVector * i);
    const auto cross = hn::MulSub(endX, y, hn::Mul(endY, x));
    const auto dot = hn::MulAdd(x, hn::Sub(x, endX), hn::Mul(y, hn::Sub(y, endY)));
    const auto size = hn::Add(hn::Abs(x), hn::Abs(y));
    const auto ofSize = hn::MulAdd(us, size, es);
    const auto crossError = hn::MulAdd(ofSize, lengths, hn::Mul(es, size));
    const auto dotError = hn::Mul(ofSize, hn::Add(hn::Add(size, size), lengths));
    auto error = hn::Mul(hn::Abs(dot), hn::Set(Floats, 2.0f * bestCrossError));
    error = hn::MulAdd(hn::Set(Floats, 2.0f * std::fabs(bestCross)), dotError, error);
    error =
      hn::MulAdd(hn::Set(Floats, 2.0f * bestDotError), hn::Add(hn::Abs(cross), crossError), error);
    error = hn::MulAdd(hn::Set(Floats, 2.0f * std::fabs(bestDot)), crossError, error);
    const auto difference =
      hn::MulSub(dot, hn::Set(Floats, bestCross), hn::Mul(hn::Set(Floats, bestDot), cross));
    isWorse |= LanesOf(Floats, hn::Gt(difference, error), i);
    isLeft |= LanesOf(Floats, hn::Gt(cross, crossError), i);
  }
  candidates.Bits &= ~isWorse;
  // Only a few lanes are left here. The lowest bit of left is the candidate.
  for (std::uint64_t left = candidates.Bits & ~isLeft; left; left &= left - 1)
  {
    const Index slot = window.Slots[hwy::Num0BitsBelowLS1Bit_Nonzero64(left)];
    if (slot == b ||
      Orientation(grid.PointAt(window.Origin), grid.PointAt(b), grid.PointAt(slot)) != Positive)
    {
      candidates.Bits &= ~(left & (~left + 1));
    }
  }
  candidates.IsProved = candidates.IsProved && candidates.Bits != 0;
}

/** Whether sifting leaves only one candidate, which becomes the guess. */
bool IsDecided(const Window& window, const BinGrid& grid, Index b, float bx, float by, int& guess,
  Candidates& candidates)
{
  if (!candidates.IsProved)
  {
    candidates.Bits = std::uint64_t(1) << guess; // a first guess for the search elsewhere
    return false;
  }
  Sift(window, grid, b, bx, by, guess, candidates);
  if (!candidates.IsProved || (candidates.Bits & (candidates.Bits - 1)) != 0)
  {
    return false;
  }
  guess = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(candidates.Bits));
  return true;
}

constexpr int FewVectors = PointWindows::FewLanes / InVector;
constexpr int MostVectors = (PointWindows::Capacity + InVector - 1) / InVector;

/** See WideApexSearch::FindCandidates(). */
Candidates FindCandidates(const PointWindows& windows, const BinGrid& grid, Index b)
{
  int guess;
  float x, y;
  if (!PlaceEnd(windows, b, 0, x, y))
  {
    return {};
  }
  const Window& window = windows.Current();
  Candidates found = window.Lanes == PointWindows::FewLanes
    ? Search<FewVectors>(window, x, y, guess)
    : Search<MostVectors>(window, x, y, guess);
  Sift(window, grid, b, x, y, guess, found);
  return found;
}

template <int Vectors>
HWY_INLINE int FollowVectors(const PointWindows& windows, const BinGrid& grid, Index b, Index last,
  Index* neighbors, Candidates& open)
{
  int guess;
  float x, y;
  const Window& window = windows.Current();
  std::uint64_t end = LanesOf<Vectors>(window, b);
  if (!PlaceEnd(windows, b, end, x, y))
  {
    open = Candidates();
    return 0;
  }
  for (int count = 0;;)
  {
    open = Search<Vectors>(window, x, y, guess);
    open.Bits &= ~end;
    // The usual way takes one comparison: the guess is the only candidate, and proved.
    if (!open.IsProved || open.Bits != std::uint64_t(1) << guess)
    {
      if (!IsDecided(window, grid, b, x, y, guess, open))
      {
        return count;
      }
    }
    b = neighbors[count++] = window.Slots[guess];
    if (b == last || count == PointWindows::Capacity)
    {
      open = Candidates();
      return count;
    }
    // The apex is the end of the next edge: no search for its lanes, no rounding once more.
    end = std::uint64_t(1) << guess;
    x = window.X[guess];
    y = window.Y[guess];
  }
}

/** See WideApexSearch::Follow(). */
int Follow(const PointWindows& windows, const BinGrid& grid, Index b, Index last, Index* neighbors,
  Candidates& open)
{
  return windows.Current().Lanes == PointWindows::FewLanes
    ? FollowVectors<FewVectors>(windows, grid, b, last, neighbors, open)
    : FollowVectors<MostVectors>(windows, grid, b, last, neighbors, open);
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
using Finder = WideApexSearch::Candidates(const PointWindows&, const BinGrid&, Index);
constexpr Finder* Finders[NumberOfInstructionSets] = ELEVATION_VERSIONS(FindCandidates);
using Follower = int(
  const PointWindows&, const BinGrid&, Index, Index, Index*, WideApexSearch::Candidates&);
constexpr Follower* Followers[NumberOfInstructionSets] = ELEVATION_VERSIONS(Follow);
} // namespace

WideApexSearch::Candidates WideApexSearch::FindCandidates(Index b) const
{
  return Finders[static_cast<int>(this->Instructions)](this->Windows, this->Grid, b);
}

int WideApexSearch::Follow(Index b, Index last, Index* neighbors, Candidates& open) const
{
  return Followers[static_cast<int>(this->Instructions)](
    this->Windows, this->Grid, b, last, neighbors, open);
}

} // namespace elevation
#endif
