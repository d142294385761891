// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How rough survey lines are, and how large errors between them are expected to be for that.
 *
 * In: the points of lines with their heights, and the triangles of some of these points. Out: at
 * places between lines the scale of errors: what one error is to another, up to a factor that
 * trials find (BetweenLines.h).
 *
 * Cost: linear in the points for each length of stretches.
 */
#ifndef elevation_Fill_LineRoughness_h
#define elevation_Fill_LineRoughness_h

#include "KnownPoints.h"
#include "Patch.h"
#include "Tracks.h"

#include <limits>
#include <vector>

namespace elevation
{

class LineRoughness
{
public:
  /** References to what lives longer. @param[in] elevations  of known points */
  LineRoughness(const PatchMesh& patch, const Tracks& lines, const std::vector<double>& elevations)
    : Patch(patch)
    , Lines(lines)
    , Elevations(elevations)
    , Count(elevations.size())
  {
  }

  /** Of each known point the roughness along its line, over stretches of a length; or NaN. */
  std::vector<double> Along(const KnownPoints& known, double length) const;

  /** The square of the mean root, which single large values do not determine; without NaN. */
  static double MeanOf(const std::vector<double>& values);

  /** What of the roughness is noise, which is there near lines, too. */
  double NoiseAlong(const KnownPoints& known) const;

  /**
   * The scales of spots, for a median gap.
   * @param[in] missed  errors at known points where lines were left out, or NaN
   * @param[in] noise   of all lines, by NoiseAlong()
   */
  std::vector<double> ScalesAt(const std::vector<Spot>& spots, const KnownPoints& known, double gap,
    const std::vector<double>& missed, double noise) const;

private:
  /** How a height at a place of a line differs from what the line between two others gives. */
  struct Stretch
  {
    double Miss = std::numeric_limits<double>::quiet_NaN();
    double Before = 0.0; ///< distances
    double Behind = 0.0;
  };
  /** Means of the roots of values near each known point on its line, and in a neighbourhood. */
  struct Means
  {
    std::vector<double> Near;
    std::vector<double> Wide;
  };
  Stretch StretchAt(Index track, Index place, double before, double behind) const;
  bool IsThere(const KnownPoints& known, Index track) const;
  Means MeansOf(const KnownPoints& known, const std::vector<double>& values, double gap) const;
  std::vector<double> MeansInCells(
    const KnownPoints& known, const std::vector<double>& values, double side) const;
  void AddShare(double share, const std::vector<Spot>& spots, const std::vector<double>& roots,
    std::vector<double>& sums) const;
  double ShapePower(const KnownPoints& known, double length, double noise) const;

  const PatchMesh& Patch;
  const Tracks& Lines;
  const std::vector<double>& Elevations;
  const std::size_t Count;
};

} // namespace elevation

#endif
