// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Values between survey lines, and how wrong they may be.
 *
 * In: a patch over a region of long triangles with points inside, the length above which edges are
 * long, the elevations of the points. Out: one value for each new point, for elevations and all
 * other attributes; the standard errors of elevations, and intervals.
 *
 * Values. The known points alone, triangulated, give linear values T: never far off, but with
 * creases, and flat where a summit lies between lines. A thin plate S (Spline.h) through up to 1000
 * of the points bends as the surface does. The value is T + w (S - T[S]), where T[S] are the
 * spline's values at the known points, interpolated linearly: S - T[S] is how the spline bends. So
 * known points keep their values, however few are centres. w, between 0 and 1, is the one that
 * predicts best when lines are left out. Values that leave the range of the known ones within about
 * a gap are compressed, so that they leave it by at most a quarter of that range; so are those that
 * leave the range of all, by at most 5 % of it (Overshoot.h). In trials, this changes no error.
 *
 * Misties. Through two lines that cross and disagree (Misties.h) a plate would be steep, and go on
 * so. There heights count as inexact: their variance is half of the median square of the line's
 * misties. The spline gets it, over the square of its roughness, as nuggets (Spline.h), and runs
 * between the lines.
 *
 * Trials. Lines (Tracks.h) are coloured so that neighbours differ. Those of one colour are left
 * out, one colour after the other, and predicted from the rest: between parallel lines the gap is
 * then twice as wide. From what is left lines are left out once more, for the roughness of these
 * trials, and for hindsight. Lines that cross the others have a colour of their own; they show the
 * error in the gaps as they are.
 *
 * Scale. The errors are measured in a scale which says where they are large. For a place at
 * distance d from the nearest known point, in a gap of width g, it is
 *
 *   (u (2 - u))^p (g / G)^h R,   u = 2 d / g, at most 1,
 *
 * with G the median gap. R is the roughness: the mean of the second feature, times L^0.8, where L
 * is a mean, with fixed shares, of a constant and of four features at the corners of the place's
 * triangle, each in parts of its mean: by how much a point on a line differs from the line between
 * points before and behind it, on stretches of length G / 2 near the place, and of length G in a
 * wide neighbourhood; the errors of lines that were left out, near and wide. On the lines
 * themselves is measured how such differences grow: with the distance from the ends of a stretch
 * (p, at most 1.2), and with its length (h, at most 0.9). Weights that are fitted to the trials
 * predict worse than fixed ones: lines are few.
 *
 * Carrying. The gaps of trials are twice as wide as those to be filled. Both are measured in their
 * own scale: with G as it is, and twice as wide. The ratio r of errors to roughness in wide gaps is
 * drawn to what it is on other surveys, r^0.725 1.9^0.275: of one survey it is known from a few
 * gaps. Roughness that grows from G to twice that by a factor f lets errors grow by f^(0.65 + 0.44
 * w), more where the spline bends them. These powers are from surveys that were made of nine grids
 * (Documentation/FillAccuracy.md); without those of any one grid they differ by at most 0.14.
 * Crossing lines give errors in the gaps as they are: from 100 of these on, the factor that follows
 * from them counts 0.4, in logarithms.
 *
 * Hindsight. Gaps four times as wide show how errors shrink to those twice as wide. If the ratio of
 * errors to roughness is over 1.5 times that in gaps four times as wide, half the growth counts,
 * and Outgrowth() reports it: stripes along lines do this, which the roughness along lines does not
 * show.
 *
 * Noise. What is left of the roughness as stretches become short is noise. It is as large near
 * lines, and in narrow gaps: an error is taken for the hypotenuse of noise, which is normal, and of
 * the rest, which is in scale. (Truth is what would be measured, with its noise.)
 *
 * The standard error is the factor of the scale with which 68 % of these errors are within scale
 * and noise, half an interval that with which the asked share is: quantiles by rank among the
 * errors and one more (as in conformal prediction). But for noise, no normal distribution is
 * assumed.
 *
 * Guarantees: planes are continued, up to rounding. The result depends on the positions of the
 * known points, their values and the patch, not on the order of points or triangles.
 *
 * Cost, for n new points, k known ones, c centres: n log n; more triangulations of some 3 k points
 * for parallel lines, and of up to 8 k where many cross; c^3 + c (n + k).
 *
 * [Vovk, Gammerman, Shafer] Algorithmic Learning in a Random World, 2005.
 */
#ifndef elevation_Fill_BetweenLines_h
#define elevation_Fill_BetweenLines_h

#include "Kernel/Base/Base.h"
#include "Overshoot.h"
#include "Patch.h"
#include "Walk.h"

#include <memory>
#include <vector>

namespace elevation
{

class BetweenLines
{
public:
  /**
   * Looks for lines, and tries. Keeps a reference to the patch.
   * @param[in] longest  the length of the longest edge that is not long
   * @param[in] values   the elevations, by ids
   * @throws Aborted, std::bad_alloc
   */
  BetweenLines(const PatchMesh& patch, double longest, const Values& values,
    const Progress& progress = Progress());
  ~BetweenLines();

  /** Whether there are lines, enough of them for trials. Else there is nothing more to ask for. */
  bool AreFound() const;

  /** The part of the spline's bending that is added; 0 to 1. */
  double Share() const;

  /**
   * By what factor errors shrank less than roughness, from wider gaps to wide ones, where that is
   * much; else 0.
   */
  double Outgrowth() const;

  /** The sizes of differences where lines cross and disagree. */
  const std::vector<double>& Misties() const;

  /**
   * One value for each new vertex; none if values at known points are not finite.
   * @param[out] drawnBack  may be null; values that would be too far beyond those of lines
   */
  std::vector<double> Apply(const Values& values, const Progress& progress = Progress(),
    DrawnBack* drawnBack = nullptr) const;

  /** The standard error of the elevation at each new vertex. */
  std::vector<double> StandardErrors() const;

  /** Half the width of intervals that hold the elevation with a probability. */
  std::vector<double> HalfIntervals(double probability) const;

private:
  class Trials;
  std::unique_ptr<Trials> Tried;
};

} // namespace elevation

#endif
