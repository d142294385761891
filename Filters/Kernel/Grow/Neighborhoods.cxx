// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Neighborhoods.h"

#include "Packing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 warns of undefined values in its own intrinsics.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace elevation
{
#ifdef ELEVATION_HAS_AVX2
namespace
{
// A compromise: with fewer, more apexes lie beyond; with more, each comparison takes more vectors.
constexpr double PointsInBox = 18.0; // expected; halved if there are too many

/** A box, in vectors of four. */
struct WideBox
{
  __m256d LowX, HighX, LowY, HighY;

  /** Which of four children of a node touch it, as bits. */
  ELEVATION_WIDE_INLINE int Touches(const BoxTree::Node& node, int first) const
  {
    const __m256d isWithinX =
      _mm256_and_pd(_mm256_cmp_pd(_mm256_loadu_pd(node.LowX + first), this->HighX, _CMP_LE_OQ),
        _mm256_cmp_pd(_mm256_loadu_pd(node.HighX + first), this->LowX, _CMP_GE_OQ));
    const __m256d isWithinY =
      _mm256_and_pd(_mm256_cmp_pd(_mm256_loadu_pd(node.LowY + first), this->HighY, _CMP_LE_OQ),
        _mm256_cmp_pd(_mm256_loadu_pd(node.HighY + first), this->LowY, _CMP_GE_OQ));
    return _mm256_movemask_pd(_mm256_and_pd(isWithinX, isWithinY));
  }
  /** Which of four points it contains, as bits. */
  ELEVATION_WIDE_INLINE int Holds(__m256d x, __m256d y) const
  {
    const __m256d isInX = _mm256_and_pd(
      _mm256_cmp_pd(x, this->LowX, _CMP_GE_OQ), _mm256_cmp_pd(x, this->HighX, _CMP_LE_OQ));
    const __m256d isInY = _mm256_and_pd(
      _mm256_cmp_pd(y, this->LowY, _CMP_GE_OQ), _mm256_cmp_pd(y, this->HighY, _CMP_LE_OQ));
    return _mm256_movemask_pd(_mm256_and_pd(isInX, isInY));
  }
};

/** Adds the points of a leaf in the box. @return false if there are too many */
ELEVATION_WIDE_INLINE bool AddLeaf(
  const BinGrid& grid, Index slot, Index end, const WideBox& box, Neighborhood& around)
{
  const __m256d centerX = _mm256_set1_pd(around.CenterX), centerY = _mm256_set1_pd(around.CenterY);
  const __m256d scale = _mm256_set1_pd(around.PerSide);
  for (; slot < end; slot += 8)
  {
    int in = 0;
    __m128 x[2], y[2]; // in sides
    for (int half = 0; half < 2; ++half)
    {
      const __m256d pointX = _mm256_loadu_pd(grid.X.data() + slot + 4 * half);
      const __m256d pointY = _mm256_loadu_pd(grid.Y.data() + slot + 4 * half);
      in |= box.Holds(pointX, pointY) << (4 * half);
      x[half] = _mm256_cvtpd_ps(_mm256_mul_pd(_mm256_sub_pd(pointX, centerX), scale));
      y[half] = _mm256_cvtpd_ps(_mm256_mul_pd(_mm256_sub_pd(pointY, centerY), scale));
    }
    // The last eight of a leaf may run into the next leaf, whose points come with that leaf.
    in &= 255 >> std::max(slot + 8 - end, 0);
    // Points in the box come first, the others are overwritten.
    const __m256i which = PlacesOf(in);
    const int count = around.Count;
    _mm256_storeu_ps(
      around.X + count, _mm256_permutevar8x32_ps(_mm256_set_m128(x[1], x[0]), which));
    _mm256_storeu_ps(
      around.Y + count, _mm256_permutevar8x32_ps(_mm256_set_m128(y[1], y[0]), which));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(around.Slots + count),
      _mm256_add_epi32(_mm256_set1_epi32(slot), which));
    around.Count = count + __builtin_popcount(in);
    if (around.Count > Neighborhood::MostPoints)
    {
      return false;
    }
  }
  return true;
}

/** Adds all points of the box below a node. @return false if there are too many */
ELEVATION_WIDE bool GatherBox(
  const BinGrid& grid, const BoxTree::Node& top, const Box& extent, Neighborhood& around)
{
  const WideBox box{ _mm256_set1_pd(extent.Low.X), _mm256_set1_pd(extent.High.X),
    _mm256_set1_pd(extent.Low.Y), _mm256_set1_pd(extent.High.Y) };
  around.Count = 0;
  // Nodes to look into, from the last found on. Boxes are small, so few nodes touch one; a deeper
  // stack than this counts as too many points.
  const BoxTree::Node* stack[64];
  stack[0] = &top;
  int height = 1;
  while (height > 0)
  {
    const BoxTree::Node& node = *stack[--height];
    for (int half = 0; half < BoxTree::Node::Places; half += 4)
    {
      for (int within = box.Touches(node, half); within; within &= within - 1)
      {
        const int place = half + __builtin_ctz(within);
        const Index first = node.First[place], count = node.Count[place];
        if (count > 0)
        {
          if (!AddLeaf(grid, first, first + count, box, around))
          {
            return false;
          }
          continue;
        }
        if (height == 64)
        {
          return false;
        }
        stack[height++] = &grid.Tree.Nodes[first];
      }
    }
  }
  // Readers take whole vectors: NaN is in no box.
  _mm256_storeu_ps(
    around.X + around.Count, _mm256_set1_ps(std::numeric_limits<float>::quiet_NaN()));
  return true;
}
} // namespace

const Neighborhood& Neighborhoods::Around(Index slot)
{
  if (this->Recent.empty())
  {
    // A line of equal y runs through about as many leaves as the root of their number; the vertices
    // of these leaves alternate.
    const double leaves = this->Grid.NumberOfPoints() / 16.0;
    this->Recent.resize(static_cast<std::size_t>(16.0 + 2.0 * std::sqrt(leaves)));
    // Enough places that leaves whose vertices alternate rarely share one.
    std::size_t places = 1024;
    while (places < this->Recent.size() * 64)
    {
      places *= 2;
    }
    // 0 names the first neighborhood, which has no slots yet, so nothing is found by mistake.
    this->Places.assign(places, 0);
  }
  const std::size_t mask = this->Places.size() - 1;
  const std::size_t eight = static_cast<std::size_t>(slot) / 8;
  // Eight slots may belong to several leaves, of which the one gathered last is entered. The others
  // are found by the eight before or after, if they reach there; else they are gathered once more.
  for (const std::size_t at : { eight, eight - 1, eight + 1 })
  {
    const Neighborhood& known = this->Recent[this->Places[at & mask]];
    if (known.First <= slot && slot < known.End)
    {
      return known;
    }
  }
  // A ring of neighborhoods: the one that was made first goes, as the sweep has left it behind.
  const std::size_t oldest = this->Oldest;
  this->Oldest = (oldest + 1) % this->Recent.size();
  Neighborhood& made = this->Recent[oldest];
  this->Gather(slot, made);
  // What is forgotten needs no removal: an entry counts only if its neighborhood has the slot.
  for (Index at = made.First / 8; at < (made.End + 7) / 8; ++at)
  {
    this->Places[static_cast<std::size_t>(at) & mask] = static_cast<Index>(oldest);
  }
  return made;
}

void Neighborhoods::Gather(Index slot, Neighborhood& around) const
{
  const BoxTree::Step last = this->Grid.Lowest(slot);
  const BoxTree::Node& node = *last.Node;
  int place = 0;
  while (slot < node.First[place] || slot >= node.First[place] + node.Count[place])
  {
    ++place;
  }
  around.First = node.First[place];
  around.End = around.First + node.Count[place];
  const double size = node.Size, width = last.HighX - last.LowX, height = last.HighY - last.LowY;
  const Box leaf{ { node.LowX[place], node.LowY[place] },
    { node.HighX[place], node.HighY[place] } };
  for (double points : { PointsInBox, 0.5 * PointsInBox })
  {
    // The side of a square with this many points; if they lie in a narrower strip, the length of a
    // part with this many.
    double side = std::sqrt(points / size * width * height);
    if (!(side < std::min(width, height)))
    {
      side = points / size * std::max(width, height);
    }
    // Of every vertex of the leaf: 0.55 sides to the left and right, 0.9 upwards, as GatherBox() of
    // PointWindows.cxx cuts them out, plus the excess that it copies. Nothing below a vertex is
    // needed.
    const Box box{ { leaf.Low.X - 0.551 * side, leaf.Low.Y },
      { leaf.High.X + 0.551 * side, leaf.High.Y + 0.901 * side } };
    const double greatest = std::max(std::max(std::fabs(box.Low.X), std::fabs(box.High.X)),
      std::max(std::fabs(box.Low.Y), std::fabs(box.High.Y)));
    around.PerSide = 1.0 / side;
    around.CenterX = 0.5 * leaf.Low.X + 0.5 * leaf.High.X;
    around.CenterY = 0.5 * leaf.Low.Y + 0.5 * leaf.High.Y;
    // A box of only a few roundoffs of the coordinates would be changed by rounding.
    if (!(around.PerSide > 1e-150 && around.PerSide < 1e150 && greatest < 1e10 * side &&
          box.High.X - around.CenterX < MostSides * side &&
          box.High.Y - around.CenterY < MostSides * side))
    {
      break;
    }
    // All points within a step's box are below its node, so none of the box is missed.
    BoxTree::Step top = last;
    while (
      !(top.LowX < box.Low.X && box.High.X < top.HighX && box.High.Y < top.HighY) && !top.IsRoot())
    {
      top = this->Grid.Tree.Above(top);
    }
    if (GatherBox(this->Grid, *top.Node, box, around))
    {
      return;
    }
  }
  around.Count = 0;
}
#endif

} // namespace elevation
