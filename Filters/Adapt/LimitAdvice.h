// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Explains why a triangulation has no triangle, and advises a MaximumEdgeLength where the given one
 * leaves few. Private to the module.
 */
#ifndef LimitAdvice_h
#define LimitAdvice_h

#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"

#include "vtkType.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace elevation
{

/**
 * What a limit leaves, and how long edges are without it. Lengths in x,y, in the units of the
 * points. Who has found that most vertices are missing measures again without a limit; else the
 * lengths stay 0.
 */
struct LimitEffect
{
  vtkIdType Vertices = 0;
  vtkIdType Missing = 0; ///< of these, without a triangle

  bool AreMostMissing() const { return 2 * this->Missing > this->Vertices; }

  bool HasLengths = false; ///< whether the following are known
  double Shortest = 0.0;
  double Median = 0.0;
  double ForMost = 0.0; ///< the limit that keeps a triangle at 95 % of the points
};

/** The quantiles that ForMost and Median are. */
constexpr double MostShare = 0.95, MedianShare = 0.5;

/**
 * The place of a quantile among some sorted values: 0 is the least, 1 the largest. One formula for
 * one rank, which sorts its values, and for several, which count them.
 */
inline vtkIdType QuantilePlace(double share, vtkIdType count)
{
  return static_cast<vtkIdType>(share * static_cast<double>(count - 1));
}

/** Warns that points, if there are any, have made no triangle. */
void WarnOfNoTriangle(vtkIdType points, vtkIdType hidden, std::vector<Message>& warnings);

/** That most points are without a triangle, and which limit would keep them. */
Message AdviceOnLimit(double limit, const LimitEffect& effect);

/** Of triangles without a limit. */
struct EdgeMeasures
{
  std::vector<double> Edges;  ///< three of each triangle
  std::vector<double> Limits; ///< of each vertex, the least that keeps a triangle; maybe infinite
};

/**
 * Measures triangles. A vertex keeps a triangle if the limit is at least the longest edge of one of
 * its triangles: the least of these is its limit. An edge counts once in each of its triangles.
 * Linear.
 * @param[in] placeOf  the place of a vertex
 */
template <typename PlaceOf>
EdgeMeasures MeasureEdges(const Buffer<Index>& triangles, std::size_t numberOfVertices,
  const PlaceOf& placeOf, const Progress& progress)
{
  EdgeMeasures lengths;
  lengths.Edges.reserve(triangles.size());
  lengths.Limits.assign(numberOfVertices, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    ReportStep(progress, i / 3, triangles.size() / 3, 1 << 16);
    double longest = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      lengths.Edges.push_back(
        Distance(placeOf(triangles[i + k]), placeOf(triangles[i + (k + 1) % 3])));
      longest = std::max(longest, lengths.Edges.back());
    }
    for (int k = 0; k < 3; ++k)
    {
      double& limit = lengths.Limits[triangles[i + k]];
      limit = std::min(limit, longest);
    }
  }
  return lengths;
}

} // namespace elevation

#endif
