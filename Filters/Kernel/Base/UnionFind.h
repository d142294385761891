// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Disjoint sets of ids, as trees of parents. Each id begins as its own parent: std::iota. Two sets
 * are joined by making the root of one the parent of the other; with the lower root as parent, the
 * root of a set is its lowest id. With that rule the roots do not depend on the order in which sets
 * are joined.
 */
#ifndef elevation_Base_UnionFind_h
#define elevation_Base_UnionFind_h

#include "Points.h"

namespace elevation
{

/**
 * The root of the set that an id belongs to. Halves the path to it, so that n calls and joins cost
 * at most n log n.
 * @param[in,out] parents  one an id; a root is its own parent
 */
template <typename Ids>
Index RootOf(Ids& parents, Index id)
{
  while (parents[id] != id)
  {
    id = parents[id] = parents[parents[id]];
  }
  return id;
}

} // namespace elevation

#endif
