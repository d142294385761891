// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "TrialErrors.h"

#include "Quantiles.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace elevation
{

namespace
{
/** Those in gaps four times as wide count if there are more. */
constexpr std::size_t LeastWiderErrors = 1000;

/** The weight of errors in gaps as they are, where lines cross; in the mean of logarithms. */
constexpr double ShareOfDirect = 0.4;

/**
 * From wide gaps to those that are filled. Errors in the measure of roughness are drawn to what is
 * typical; what is less rough in narrow gaps has errors that are less by this power of it, and the
 * more so the more the spline bends (BetweenLines.h).
 */
constexpr double TypicalRatio = 1.9;
constexpr double PowerOfRatio = 0.275;
constexpr double PowerOfGrowth = 0.65;
constexpr double PowerOfBendingGrowth = 0.44;
constexpr double LargestGrowth = 4.0;

/** Errors outgrow roughness if from gaps four times as wide they shrank so much less than it. */
constexpr double LeastOutgrowth = 1.5;
constexpr double CreditIfOutgrown = 0.5;

/**
 * The noise of an error, in the measure of noise: the square of the mean root of second
 * differences. For a normal distribution.
 */
constexpr double NoiseOfMiss = 1.5;

/** The quantile that is compared. */
constexpr double CarryQuantile = 0.9;

/** What the size of a standard normal number does not exceed with a probability. */
double NormalQuantile(double share)
{
  double low = 0.0, high = 10.0;
  for (int step = 0; step < 60; ++step)
  {
    const double middle = 0.5 * (low + high);
    (std::erf(middle / std::sqrt(2.0)) < share ? low : high) = middle;
  }
  return low;
}

} // namespace

double ScaledErrors::FactorFor(double share, double noise) const
{
  std::vector<double> ratios;
  for (const Error& error : this->Errors)
  {
    const double square = error.Size * error.Size - noise * noise;
    ratios.push_back(square > 0.0 ? std::sqrt(square) / error.Scale : 0.0);
  }
  return QuantileByRank(std::move(ratios), share);
}

double ScaledErrors::MeanRoughness() const
{
  double sum = 0.0;
  for (const double one : this->Roughness)
  {
    sum += one / static_cast<double>(this->Roughness.size());
  }
  return sum;
}

double TrialErrors::NoiseFor(double share) const
{
  return NormalQuantile(share) * NoiseOfMiss * this->Noise;
}

void TrialErrors::Carry(double roughness, double bending)
{
  const double noise = this->NoiseFor(CarryQuantile);
  const double ratio = this->Wide.FactorFor(CarryQuantile, noise);
  const double growth = this->Wide.MeanRoughness() / roughness;
  if (!(ratio > 0.0) || !std::isfinite(growth))
  {
    return;
  }
  double credit = 1.0;
  if (this->Wider.Errors.size() >= LeastWiderErrors)
  {
    const double outgrowth = ratio / this->Wider.FactorFor(CarryQuantile, noise);
    if (outgrowth > LeastOutgrowth)
    {
      this->Outgrown = outgrowth;
      credit = CreditIfOutgrown;
    }
  }
  const double power = PowerOfGrowth + PowerOfBendingGrowth * bending;
  this->Carried = std::pow(TypicalRatio / ratio, PowerOfRatio) *
    std::pow(std::max(1.0, std::min(LargestGrowth, growth)), 1.0 - credit * power);
}

double TrialErrors::FactorFor(double share) const
{
  const double noise = this->NoiseFor(share);
  const double factor = this->Carried * this->Wide.FactorFor(share, noise);
  if (this->Direct.Errors.size() < LeastErrors)
  {
    return factor;
  }
  return std::pow(factor, 1.0 - ShareOfDirect) *
    std::pow(this->Direct.FactorFor(share, noise), ShareOfDirect);
}

} // namespace elevation
