// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Where survey lines cross, and by how much they disagree there: misties.
 *
 * In: points with the edges that join them along lines, their heights. Out: places where two lines
 * cross, and the difference of their heights there.
 *
 *          b                 Near a crossing edges lead from one line to the other, so a point there
 *          |                 (x) may be of either. From the points around it four arms lead away;
 *   a--a--x-x--a--a          two and two continue each other. The height of a line at the crossing
 *         x-x                is what its arms give on both sides, by linear interpolation.
 *          |
 *          b
 *
 * By how much arms may be wrong: by what a cubic through their slopes changes, and by how far they
 * are off straight lines themselves. Lines disagree where the difference is 0.6 times as large. (Of
 * crossings of lines that agree, on rough terrain and on made surveys, the median difference is 0.1
 * to 0.3 times that, and nine of ten are below 0.9 times that.)
 *
 * Cost: linear.
 */
#ifndef elevation_Fill_Misties_h
#define elevation_Fill_Misties_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <cmath>
#include <vector>

namespace elevation
{

/** The direction from one point to another; 0 where both are the same. */
inline Point2 UnitVector(const Point2& p, const Point2& q)
{
  const double length = Distance(p, q);
  return { length > 0.0 ? (q.X - p.X) / length : 0.0, length > 0.0 ? (q.Y - p.Y) / length : 0.0 };
}

/** Of the angle between two unit vectors. */
inline double Cosine(const Point2& a, const Point2& b)
{
  return a.X * b.X + a.Y * b.Y;
}

/**
 * The vertices of an arm, from the first edge on, up to a number of them, an end or a meeting.
 * @param[in] neighbors  as of FindCrossings()
 */
std::vector<Index> FollowArm(
  const std::vector<std::vector<Index>>& neighbors, Index from, Index to, std::size_t most);

struct Crossing
{
  /** Vertices of both lines, on both sides, from the crossing outwards. */
  std::vector<Index> Arms[2][2];
  std::vector<Index> Middle; ///< those at the crossing, which may be of either line
};

/**
 * Finds crossings of two lines.
 * @param[in] neighbors  for each vertex those that an edge along a line joins it to, increasing
 */
std::vector<Crossing> FindCrossings(
  const Mesh& mesh, const std::vector<std::vector<Index>>& neighbors);

/** How the heights of two lines differ where they cross. */
struct Mistie
{
  double Size = 0.0;
  double Doubt = 0.0; ///< by how much the arms may be wrong

  // Of lines that agree, up to 18 crossings of a hundred are as large; none is beyond doubt.
  bool IsCertain() const { return this->Size > 0.6 * this->Doubt; }
  bool IsBeyondDoubt() const { return this->Size > 2.5 * this->Doubt; }
};

/** @param[in] heights  one a vertex */
Mistie MistieAt(const Mesh& mesh, const Crossing& crossing, const std::vector<double>& heights);

} // namespace elevation

#endif
