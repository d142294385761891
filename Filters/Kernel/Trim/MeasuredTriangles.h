// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Measures what the outline of a surface is found from: the shortest edges at each vertex, and the
 * border.
 *
 * In: a mesh, or a list of triangles. Cost: linear, one pass over the triangles.
 */
#ifndef elevation_Trim_MeasuredTriangles_h
#define elevation_Trim_MeasuredTriangles_h

#include "Kernel/Mesh/Mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace elevation
{

/** The four shortest edges at a vertex, and how many it has. */
struct EdgesAtVertex
{
  /** Call once per edge, in any order. */
  void Add(double squaredLength)
  {
    ++this->Degree;
    // One step of an insertion sort, in which each slot takes the smaller of what it has and what
    // its lower neighbour passes on. Without branches, which would be unpredictable.
    const float squared = static_cast<float>(squaredLength);
    for (int i = Shortest - 1; i > 0; --i)
    {
      this->Squared[i] = std::min(this->Squared[i], std::max(this->Squared[i - 1], squared));
    }
    this->Squared[0] = std::min(this->Squared[0], squared);
  }

  /** The mean length of the four (or all, if fewer), but at most twice that of the second. */
  float ShortSpacing() const
  {
    float lengths[Shortest];
    for (int i = 0; i < Shortest; ++i)
    {
      lengths[i] = std::sqrt(this->Squared[i]);
    }
    float sum = lengths[0] + lengths[1];
    for (int i = 2; i < Shortest; ++i)
    {
      sum += static_cast<std::uint32_t>(i) < this->Degree ? lengths[i] : 0.0f;
    }
    const float number = static_cast<float>(std::min<std::uint32_t>(this->Degree, Shortest));
    return std::min(sum / number, 2.0f * lengths[1]);
  }

  static constexpr int Shortest = 4;
  std::uint32_t Degree = 0;
  float Squared[Shortest] = { std::numeric_limits<float>::infinity(),
    std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
    std::numeric_limits<float>::infinity() }; ///< increasing
};

/** Triangles and their measures. Vertices may be renumbered; see Ids. */
struct MeasuredTriangles
{
  void SetNumberOfVertices(Index count)
  {
    this->Degrees.Resize(count);
    this->ShortSpacings.Resize(count);
  }

  /** Call once all edges of the vertex are known. */
  void Set(Index vertex, const EdgesAtVertex& edges)
  {
    this->Degrees[vertex] = edges.Degree;
    this->ShortSpacings[vertex] = edges.ShortSpacing();
  }

  /** The square of a triangle's longest edge. */
  double SquaredLongest(Index t) const
  {
    const Index* const corners = this->List.CornersOf(t);
    const Point2 a = this->List.Points.At(corners[0]);
    const Point2 b = this->List.Points.At(corners[1]);
    const Point2 c = this->List.Points.At(corners[2]);
    return std::max({ SquaredLength(a, b), SquaredLength(b, c), SquaredLength(c, a) });
  }

  /** The vertices with edges, whatever numbers a sweep on several threads has left out. */
  Index NumberOfCorners() const
  {
    return static_cast<Index>(std::count_if(this->Degrees.begin(), this->Degrees.end(),
      [](std::uint32_t degree) { return degree > 0; }));
  }

  TriangleList List;
  double Scale = 1.0;            ///< of its coordinates, in those of the input
  Buffer<Index> Corners;         ///< owns List's corners, if renumbered
  Buffer<double> Coordinates;    ///< owns List's points
  Buffer<Index> Ids;             ///< one per vertex: its id in the input; empty if not renumbered
  Buffer<std::uint32_t> Degrees; ///< one per vertex: its number of edges, perhaps none
  Buffer<float> ShortSpacings;   ///< one per vertex
  std::vector<BorderEdge> Border;
};

/** Measures the triangles of a mesh (with Twins), at least one. @throws Aborted, std::bad_alloc */
MeasuredTriangles Measure(const Mesh& mesh, const Progress& progress = Progress());

/**
 * Measures triangles by one sweep (TriangleSweep.h), which proves that they are a mesh that covers
 * nothing twice.
 * @return whether it does, and no scaling is needed; if not, the result is unusable
 * @throws Aborted, std::bad_alloc
 */
bool MeasureBySweep(
  const TriangleList& list, int threads, const Progress& progress, MeasuredTriangles& measured);

} // namespace elevation

#endif
