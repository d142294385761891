// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleTree.h"

#include <algorithm>

namespace elevation
{

TriangleTree::TriangleTree(const Mesh& mesh, const Progress& progress)
{
  const Index count = mesh.NumberOfTriangles();
  std::vector<Item> items(count);
  for (Index t = 0; t < count; ++t)
  {
    const Box box = BoxOf(TriangleCorners(mesh, t));
    // Halves first, as a sum may overflow.
    items[t] = { { 0.5 * box.Low.X + 0.5 * box.High.X, 0.5 * box.Low.Y + 0.5 * box.High.Y }, t };
  }
  std::size_t nodes = 1;
  for (std::size_t most = items.size(); most > MostInLeaf; most = (most + 1) / 2)
  {
    nodes = 2 * nodes + 1;
  }
  this->Boxes.resize(nodes);
  this->Order.reserve(items.size());
  this->Build(mesh, 0, items.data(), items.data() + items.size(), progress);
}

void TriangleTree::Build(
  const Mesh& mesh, std::size_t node, Item* begin, Item* end, const Progress& progress)
{
  const std::size_t count = static_cast<std::size_t>(end - begin);
  Box middles;
  std::for_each(begin, end, [&](const Item& item) { middles.Add(item.Middle); });
  CountWork(count);
  if (count <= MostInLeaf)
  {
    ReportStep(progress, this->Order.size(), this->Order.capacity());
    for (const Item* item = begin; item != end; ++item)
    {
      this->Order.push_back(item->Triangle);
      this->Boxes[node].Join(BoxOf(TriangleCorners(mesh, item->Triangle)));
    }
    return;
  }
  const bool isWide = middles.High.X - middles.Low.X > middles.High.Y - middles.Low.Y;
  Item* const middle = begin + count / 2;
  std::nth_element(begin, middle, end, [isWide](const Item& a, const Item& b) {
    return isWide ? a.Middle.X < b.Middle.X : a.Middle.Y < b.Middle.Y;
  });
  this->Build(mesh, 2 * node + 1, begin, middle, progress);
  this->Build(mesh, 2 * node + 2, middle, end, progress);
  this->Boxes[node] = this->Boxes[2 * node + 1];
  this->Boxes[node].Join(this->Boxes[2 * node + 2]);
}

} // namespace elevation
