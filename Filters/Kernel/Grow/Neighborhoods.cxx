// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Neighborhoods.h"

#include "Packing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Kernel/Grow/Neighborhoods.cxx"
#include "Kernel/Bins/Vectors.h"

#if ELEVATION_IS_VECTOR
HWY_BEFORE_NAMESPACE();
namespace elevation
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

// At most eight numbers, as there are places in a node, and as may be read behind the points.
constexpr hn::CappedTag<float, 8> Floats;
constexpr hn::CappedTag<std::int32_t, 8> Integers;
constexpr hn::Rebind<std::uint8_t, decltype(Floats)> Bytes;
constexpr hn::CappedTag<double, 8> Doubles;
constexpr hn::Rebind<float, decltype(Doubles)> Half; ///< of the floats, or all of them
constexpr int InVector = static_cast<int>(hn::MaxLanes(Doubles));
constexpr int InFloats = static_cast<int>(hn::MaxLanes(Floats)); ///< one or two vectors of doubles

HWY_INLINE unsigned int BitsOf(hn::Mask<decltype(Doubles)> mask)
{
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(Doubles, mask, bits);
  return bits[0];
}

/** A box, in vectors. */
struct WideBox
{
  hn::Vec<decltype(Doubles)> LowX, HighX, LowY, HighY;

  /** Which children of a node from one on touch it. */
  HWY_INLINE hn::Mask<decltype(Doubles)> Touches(const BoxTree::Node& node, int first) const
  {
    return hn::And(hn::And(hn::Le(hn::LoadU(Doubles, node.LowX + first), this->HighX),
                     hn::Ge(hn::LoadU(Doubles, node.HighX + first), this->LowX)),
      hn::And(hn::Le(hn::LoadU(Doubles, node.LowY + first), this->HighY),
        hn::Ge(hn::LoadU(Doubles, node.HighY + first), this->LowY)));
  }
  /** Which points it contains. */
  HWY_INLINE hn::Mask<decltype(Doubles)> Holds(
    hn::Vec<decltype(Doubles)> x, hn::Vec<decltype(Doubles)> y) const
  {
    return hn::And(hn::And(hn::Ge(x, this->LowX), hn::Le(x, this->HighX)),
      hn::And(hn::Ge(y, this->LowY), hn::Le(y, this->HighY)));
  }
};

/** Adds the points of a leaf in the box. @return false if there are too many */
HWY_INLINE bool AddLeaf(
  const BinGrid& grid, Index slot, Index end, const WideBox& box, Neighborhood& around)
{
  const auto centerX = hn::Set(Doubles, around.CenterX), centerY = hn::Set(Doubles, around.CenterY);
  const auto scale = hn::Set(Doubles, around.PerSide);
  for (; slot < end; slot += InFloats)
  {
    unsigned int in = 0;
    alignas(32) float sidesX[8], sidesY[8];
    for (int i = 0; i < InFloats; i += InVector)
    {
      const auto x = hn::LoadU(Doubles, grid.X.data() + slot + i);
      const auto y = hn::LoadU(Doubles, grid.Y.data() + slot + i);
      in |= BitsOf(box.Holds(x, y)) << i;
      hn::Store(hn::DemoteTo(Half, hn::Mul(hn::Sub(x, centerX), scale)), Half, sidesX + i);
      hn::Store(hn::DemoteTo(Half, hn::Mul(hn::Sub(y, centerY), scale)), Half, sidesY + i);
    }
    // The last of a leaf may run into the next leaf, whose points come with that leaf.
    in &= 255u >> std::max(slot + 8 - end, 0);
    // Points in the box come first, the others are overwritten.
    const auto places = hn::PromoteTo(Integers, hn::LoadU(Bytes, Packings.Places[in]));
    const auto which = hn::IndicesFromVec(Floats, places);
    const int count = around.Count;
    hn::StoreU(hn::TableLookupLanes(hn::Load(Floats, sidesX), which), Floats, around.X + count);
    hn::StoreU(hn::TableLookupLanes(hn::Load(Floats, sidesY), which), Floats, around.Y + count);
    hn::StoreU(hn::Add(hn::Set(Integers, slot), places), Integers, around.Slots + count);
    around.Count = count + static_cast<int>(hwy::PopCount(in));
    if (around.Count > Neighborhood::MostPoints)
    {
      return false;
    }
  }
  return true;
}

/** Adds all points of the box below a node. @return false if there are too many */
bool GatherBox(
  const BinGrid& grid, const BoxTree::Node& top, const Box& extent, Neighborhood& around)
{
  const WideBox box{ hn::Set(Doubles, extent.Low.X), hn::Set(Doubles, extent.High.X),
    hn::Set(Doubles, extent.Low.Y), hn::Set(Doubles, extent.High.Y) };
  around.Count = 0;
  // Nodes to look into, from the last found on. Boxes are small, so few nodes touch one; a deeper
  // stack than this counts as too many points.
  const BoxTree::Node* stack[64];
  stack[0] = &top;
  int height = 1;
  while (height > 0)
  {
    const BoxTree::Node& node = *stack[--height];
    for (int part = 0; part < BoxTree::Node::Places; part += InVector)
    {
      for (unsigned int within = BitsOf(box.Touches(node, part)); within; within &= within - 1)
      {
        const int place = part + static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(within));
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
  std::fill_n(around.X + around.Count, 16, std::numeric_limits<float>::quiet_NaN());
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
// A compromise: with fewer, more apexes lie beyond; with more, each comparison takes more vectors.
constexpr double PointsInBox = 18.0; // expected; halved if there are too many

using BoxGatherer = bool(const BinGrid&, const BoxTree::Node&, const Box&, Neighborhood&);
constexpr BoxGatherer* BoxGatherers[NumberOfInstructionSets] = ELEVATION_VERSIONS(GatherBox);
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
    if (BoxGatherers[static_cast<int>(this->Instructions)](this->Grid, *top.Node, box, around))
    {
      return;
    }
  }
  around.Count = 0;
}

} // namespace elevation
#endif
