// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A tree of boxes over the triangles of a mesh: which of them touch a box.
 *
 * The triangles are halved by the middles of their boxes, across the longer side, until few are
 * left. So it does not matter how unevenly they are spread: a cell grid would have most of a dense
 * survey in one cell if a single point is far away.
 *
 *              [0, n)                Node k has the children 2k + 1 and 2k + 2; each halves the
 *          [0, n/2) [n/2, n)         range of its triangles in Order.
 *
 * Cost: n log n to build; about log n to find the triangles at a place.
 */
#ifndef elevation_Query_TriangleTree_h
#define elevation_Query_TriangleTree_h

#include "Kernel/Mesh/Mesh.h"

#include <array>
#include <vector>

namespace elevation
{

/** The corners of a triangle. */
inline std::array<Point2, 3> TriangleCorners(const Mesh& mesh, Index triangle)
{
  const Index* const ids = mesh.Triangles.data() + 3 * static_cast<std::size_t>(triangle);
  return { { mesh.PointOf(ids[0]), mesh.PointOf(ids[1]), mesh.PointOf(ids[2]) } };
}

class TriangleTree
{
public:
  explicit TriangleTree(const Mesh& mesh, int threads = 1, const Progress& progress = Progress());

  /** Calls visit(triangle), once each, for those in leaves that touch a box, in any order. */
  template <typename Visitor>
  void Visit(const Box& box, Visitor&& visit) const
  {
    this->Visit(0, 0, this->Order.size(), box, visit);
  }

private:
  struct Item
  {
    Point2 Middle;
    Index Triangle;
  };
  static constexpr std::size_t MostInLeaf = 6;

  struct Range
  {
    std::size_t Node, Begin, End;
  };

  std::size_t Halve(std::vector<Item>& items, const Range& range) const;
  void Build(const Mesh& mesh, std::vector<Item>& items, const Range& range);

  template <typename Visitor>
  void Visit(
    std::size_t node, std::size_t begin, std::size_t end, const Box& box, Visitor& visit) const
  {
    if (begin == end || !this->Boxes[node].Intersects(box))
    {
      return;
    }
    if (end - begin <= MostInLeaf)
    {
      CountWork(end - begin);
      std::for_each(this->Order.begin() + begin, this->Order.begin() + end, visit);
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    this->Visit(2 * node + 1, begin, middle, box, visit);
    this->Visit(2 * node + 2, middle, end, box, visit);
  }

  std::vector<Index> Order; ///< triangles, by leaves
  std::vector<Box> Boxes;   ///< one a node
};

} // namespace elevation

#endif
