// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The border of a mesh that is spread over ranks: which edges have one triangle on all of them.
 * Private to the module.
 */
#ifndef BorderOfRanks_h
#define BorderOfRanks_h

#include "Kernel/Mesh/Mesh.h"
#include "Ranks.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

class vtkPolyData;

namespace elevation
{

/** What two points of different ranks have in common if they are one: the global id, or x,y,z. */
using PointKey = std::array<std::int64_t, 3>;

/** The keys of chosen points, or of all (nullptr). */
std::vector<PointKey> KeysOf(vtkPolyData* data, bool byIds, const std::vector<Index>* chosen);

/** The points of a rank that others may have, too. */
struct SharedPoints
{
  std::vector<Index> Places;   ///< increasing: on the border of its triangles, or without any
  std::vector<PointKey> Keys;  ///< of them
  std::vector<char> AreCopies; ///< one each: another rank's counts

  /** The place of the point with a key, or None. */
  Index Find(const PointKey& key) const;
  /** Sorts the keys for Find(). @return false if two points with a triangle have one key */
  bool Sort(const std::vector<char>& areUsed);

private:
  std::vector<std::pair<PointKey, Index>> Sorted;
};

/** Finds the copies, at a rank for each key. All ranks call it. */
void FindCopies(const Ranks& ranks, vtkPolyData* own, bool byIds, SharedPoints& points);

/** The border of all ranks, the same on all of them. */
struct BorderOfAll
{
  std::vector<BorderEdge> Edges;   ///< by rank and triangle
  std::vector<PointKey> Keys;      ///< of its points, increasing
  std::vector<double> Coordinates; ///< x, y and 0 of each

  Index Find(const PointKey& key) const;
  PointView View() const;
};

/**
 * @param[in] mesh  of this rank, with Twins
 * @return false on all ranks if an edge has more than two triangles, or two on one side
 */
bool CollectBorder(
  const Ranks& ranks, const Mesh& mesh, const SharedPoints& points, BorderOfAll& border);

} // namespace elevation

#endif
