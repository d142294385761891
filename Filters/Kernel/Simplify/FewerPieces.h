// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Lines with fewer points, for a surface that needs fewer points.
 *
 * In: pieces of lines that neither cross nor run through a point. Out: such pieces again; some
 * points where two of them met are no longer ends.
 *
 * A chain runs from one point that stays to the next. Along it, points are left out as long as one
 * straight piece passes all of them: above or below within an elevation error, beside within a
 * thousandth of the shorter piece at each. The range of its slopes is narrowed point by point [Imai
 * & Iri 1988], so this takes linear time. Between straight pieces and the lines that they replace
 * lies no point, else the line stays as it was. So they do not cross either: a piece that crosses
 * another one's replacement, but not its line, has an end between the two.
 *
 *        :b   :          A piece from a must pass b, c and d within a reach of each (the dots):
 *   a----+----+--:---    each narrows the range of its slopes. The stretch ends before a point
 *        :    :c :d      whose own slope is not in the range that those before it leave.
 *
 * Guarantees: the result depends on the positions of points and pieces alone. No point other than
 * those left out changes its side of a line. Two lines with the same ends may become one piece,
 * given twice.
 *
 * So little beside, because a point that has been left out may be needed later after all, and is
 * then inserted beside the piece.
 *
 * Cost: n log n for n pieces; and one pass over all points, unless all lines are exactly straight
 * where points are left out.
 *
 * [Imai & Iri 1988] Polygonal Approximations of a Curve: Formulations and Algorithms, in:
 * Computational Morphology, 71-86.
 */
#ifndef elevation_Simplify_FewerPieces_h
#define elevation_Simplify_FewerPieces_h

#include "PlacedPoints.h"

#include <vector>

namespace elevation
{

/**
 * Leaves out points of lines. A point stays where one piece ends, or more than two meet; of a
 * closed line, the lowest; and corners of the convex hull.
 * @param[in] pieces  by places, each once; not of no length
 * @param[in] error   the largest elevation error
 */
std::vector<Segment> FewerPieces(const PlacedPoints& placed, const std::vector<Segment>& pieces,
  double error, const Progress& progress);

} // namespace elevation

#endif
