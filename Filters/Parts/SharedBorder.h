// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The border of a mesh in parts, on ranks or in pieces: which edges have one triangle in all of
 * them. Private to the module.
 *
 * An edge is on the border if one part has a triangle beside it and no part has one on the other
 * side. No rank can see that alone. So each edge of a part's own border goes to a rank that its two
 * points decide by a hash: there meets whoever has the edge, and what is left alone is on the
 * border of all.
 *
 *     rank 0:  a-b  b-c  c-a        rank 1:  b-a  b-d  d-b ...
 *               |                             |
 *               +------ both at rank 1 -------+      a-b and b-a cancel: an edge between two parts
 *
 * Cost: each rank sends its border edges once, to one rank each; what is left goes to all ranks,
 * and is in memory on each of them.
 */
#ifndef SharedBorder_h
#define SharedBorder_h

#include "Adapt/Adapt.h"
#include "Kernel/Mesh/Mesh.h"
#include "PointKeys.h"
#include "Ranks.h"

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace elevation
{

/**
 * The points of a part that others may have, too. The lists have one entry each, in the same order.
 */
struct SharedPoints
{
  /** Increasing: on the border of its triangles, of long ones, or without any triangle. */
  std::vector<Index> Indices;
  std::vector<PointKey> Keys;   ///< of them
  std::vector<char> AreCopies;  ///< one each: another part's counts; before FindCopies() as marked
  std::vector<char> OnBoundary; ///< one each: marked as of BoundaryMarksOf()

  /** The index of the point with a key, or None. */
  Index Find(const PointKey& key) const;
  /**
   * Takes for copies what is marked so, as DUPLICATEPOINT. For parts in files this is all: what
   * made them has marked all but one copy of each point.
   */
  void TakeMarks(vtkPolyData* data);
  /** Sorts the keys for Find(). @throws Error if two points with a triangle have one key */
  void Sort(const std::vector<char>& areUsed);

private:
  std::vector<std::pair<PointKey, Index>> Sorted;
};

/**
 * Finds the copies of parts in memory, at a rank for each key. All ranks call it. Of the points
 * that are one, the first that is not marked stays, else the first: so each is counted once, even
 * where the user's marks are wrong or missing.
 */
void FindCopies(const Ranks& ranks, bool byIds, SharedPoints& points);

/**
 * An edge of a part's triangles, as it is sent: a plain value. Its direction is that of the
 * half-edge, with the triangle on its left.
 */
struct PartEdge
{
  PointKey Ends[2];
  double Places[4]; ///< x,y of both
  vtkIdType OnBoundary[2];
  vtkIdType Part, HalfEdge;
  vtkIdType Region; ///< of the triangle: one of long triangles (LongTriangles.h), or None
};

/** A region of long triangles of a part: the part, and the number of the region there. */
using PartRegion = std::pair<vtkIdType, vtkIdType>;

/** The edges of parts that others have to know. */
struct PartEdges
{
  std::vector<PartEdge> OnBorder;
  std::vector<PartEdge> OfRegions; ///< between a long triangle, on the left, and another
  std::vector<std::array<vtkIdType, 4>> Joined; ///< regions of two parts that are one
};

/** The border of all parts. */
struct SharedBorder
{
  std::vector<BorderEdge> Edges;   ///< by part and triangle
  std::vector<int> EdgePart;       ///< one each
  std::vector<PointKey> Keys;      ///< of its points, increasing
  std::vector<double> Coordinates; ///< x, y and 0 of each
  std::vector<char> OnBoundary;    ///< one each, as in SharedPoints
  // Regions of long triangles: edges around them, their parts and regions
  std::vector<BorderEdge> RegionEdges;
  std::vector<int> RegionEdgePart;
  std::vector<Index> EdgeRegion;
  std::map<PartRegion, Index> Regions; ///< those of the parts, as of all

  SharedBorder() = default;
  explicit SharedBorder(PartEdges&& edges);
  Index Find(const PointKey& key) const;
  PointView View() const;

private:
  /** Gives regions of parts that are one the same number, in Regions and for each edge. */
  void NumberRegions(const PartEdges& edges);
};

/**
 * Appends the border of a part, and the edges around its regions. All their ends have to be among
 * the shared points, whose keys they get. log(points) steps for each.
 * @param[in] mesh      with Twins
 * @param[in] regionOf  from NumberRegions()
 */
void AppendBorder(const Mesh& mesh, const SharedPoints& points, const std::vector<Index>& regionOf,
  int part, PartEdges& edges);

/**
 * The border of the parts of all ranks, the same on all of them: without the edges that two parts
 * have in common. Pairs within a rank go before anything is sent.
 * @param[in] edges  of the parts of this rank
 * @throws Error on all ranks if an edge has more than two triangles, or two on one side
 */
SharedBorder CollectBorder(const Ranks& ranks, PartEdges&& edges);

} // namespace elevation

#endif
