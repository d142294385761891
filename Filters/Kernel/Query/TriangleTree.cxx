// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleTree.h"

#include <algorithm>

namespace elevation
{

namespace
{
// Halved by one thread, so many times; the rest by all.
constexpr int FirstHalves = 5;
} // namespace

TriangleTree::TriangleTree(const Mesh& mesh, int threads, const Progress& progress)
{
  Stages stages(progress, { 10, 25, 65 });
  const Index count = mesh.NumberOfTriangles();
  std::vector<Item> items(count);
  ForEachNumber(count, stages.Next(), [&](Index t) {
    const Box box = BoxOf(TriangleCorners(mesh, t));
    // Halves first, as a sum may overflow.
    items[t] = { { 0.5 * box.Low.X + 0.5 * box.High.X, 0.5 * box.Low.Y + 0.5 * box.High.Y }, t };
  });
  std::size_t nodes = 1;
  for (std::size_t most = items.size(); most > MostInLeaf; most = (most + 1) / 2)
  {
    nodes = 2 * nodes + 1;
  }
  this->Boxes.resize(nodes);
  this->Order.resize(items.size());
  const Progress halving = stages.Next();
  std::vector<Range> ranges{ { 0, 0, items.size() } };
  for (int i = 0; i < FirstHalves && ranges.back().End - ranges.back().Begin > MostInLeaf; ++i)
  {
    ReportStep(halving, static_cast<std::size_t>(i), FirstHalves);
    std::vector<Range> halves;
    for (const Range& range : ranges)
    {
      const std::size_t middle = this->Halve(items, range);
      halves.push_back({ 2 * range.Node + 1, range.Begin, middle });
      halves.push_back({ 2 * range.Node + 2, middle, range.End });
    }
    ranges = halves;
  }
  ForEachTask(static_cast<Index>(ranges.size()), threads, stages.Next(),
    [&](Index i) { this->Build(mesh, items, ranges[i]); });
  for (std::size_t node = ranges.front().Node; node-- > 0;)
  {
    this->Boxes[node] = this->Boxes[2 * node + 1];
    this->Boxes[node].Join(this->Boxes[2 * node + 2]);
  }
}

/** Puts the lower half of a range's triangles, across its longer side, first. @return its end */
std::size_t TriangleTree::Halve(std::vector<Item>& items, const Range& range) const
{
  const auto begin = items.begin() + range.Begin, end = items.begin() + range.End;
  Box middles;
  std::for_each(begin, end, [&](const Item& item) { middles.Add(item.Middle); });
  const bool isWide = middles.High.X - middles.Low.X > middles.High.Y - middles.Low.Y;
  const std::size_t middle = range.Begin + (range.End - range.Begin) / 2;
  std::nth_element(begin, items.begin() + middle, end, [isWide](const Item& a, const Item& b) {
    return isWide ? a.Middle.X < b.Middle.X : a.Middle.Y < b.Middle.Y;
  });
  CountWork(range.End - range.Begin);
  return middle;
}

void TriangleTree::Build(const Mesh& mesh, std::vector<Item>& items, const Range& range)
{
  Box& box = this->Boxes[range.Node];
  if (range.End - range.Begin <= MostInLeaf)
  {
    for (std::size_t i = range.Begin; i < range.End; ++i)
    {
      this->Order[i] = items[i].Triangle;
      box.Join(BoxOf(TriangleCorners(mesh, items[i].Triangle)));
    }
    return;
  }
  const std::size_t middle = this->Halve(items, range);
  const std::size_t low = 2 * range.Node + 1, high = low + 1;
  this->Build(mesh, items, { low, range.Begin, middle });
  this->Build(mesh, items, { high, middle, range.End });
  box = this->Boxes[low];
  box.Join(this->Boxes[high]);
}

} // namespace elevation
