// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Errors of trials in which survey lines were left out, and what follows for the gaps between all
 * lines.
 *
 * In: errors with their scales (LineRoughness.h), and the roughness along lines, in gaps twice and
 * four times as wide as those to be filled, and in these where lines cross them. Out: the factor of
 * scales with which a share of errors is within scale and noise. BetweenLines.h has the reasons.
 */
#ifndef elevation_Fill_TrialErrors_h
#define elevation_Fill_TrialErrors_h

#include <cstddef>
#include <vector>

namespace elevation
{

/** Errors in gaps of about one width. */
struct ScaledErrors
{
  struct Error
  {
    double Size;
    double Scale;
  };
  std::vector<Error> Errors;
  std::vector<double> Roughness; ///< along the lines that were left, over the width; one a trial

  /** The factor of scales at which a share of errors is within noise and scale; NaN of none. */
  double FactorFor(double share, double noise) const;

  double MeanRoughness() const;
};

struct TrialErrors
{
  /** Fewer errors of trials do not count, whether in wide gaps or where lines cross. */
  static constexpr std::size_t LeastErrors = 100;

  ScaledErrors Wide;   ///< where lines were left out
  ScaledErrors Wider;  ///< where more were left out
  ScaledErrors Direct; ///< of lines that cross the gaps as they are
  double Noise = 0.0;  ///< square mean of the roots of its second differences

  /** What the size of noise does not exceed with a probability. */
  double NoiseFor(double share) const;

  /**
   * Finds how the factor changes from wide gaps to those between all lines.
   * @param[in] roughness  along all lines, over the width of these
   * @param[in] bending    BetweenLines::Share()
   */
  void Carry(double roughness, double bending);

  /** After Carry(): the factor for the gaps between all lines. */
  double FactorFor(double share) const;

  /** After Carry(): as BetweenLines::Outgrowth(). */
  double Outgrowth() const { return this->Outgrown; }

private:
  double Carried = 1.0;
  double Outgrown = 0.0;
};

} // namespace elevation

#endif
