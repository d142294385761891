// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How far filled holes are from what was cut out, and from what FilledError says.
 */
#ifndef FillErrors_h
#define FillErrors_h

#include "PointSets.h"

#include "vtkType.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace benchmark
{

/** Of the vertical distances at lost points. */
struct Errors
{
  double Squares = 0.0;
  double Greatest = 0.0;
  std::size_t Count = 0;
  std::size_t Uncovered = 0;

  void Add(const Errors& other)
  {
    this->Squares += other.Squares;
    this->Greatest = std::max(this->Greatest, other.Greatest);
    this->Count += other.Count;
    this->Uncovered += other.Uncovered;
  }
  double RootMeanSquare() const
  {
    return this->Count > 0 ? std::sqrt(this->Squares / static_cast<double>(this->Count)) : 0.0;
  }
};

/** Of the triangles that lie over lost points. */
Errors Compare(
  const Coordinates& points, const std::vector<Index>& triangles, const Coordinates& lost);

/** A hole as a method filled it. */
struct Filled
{
  Coordinates Points;
  std::vector<Index> Patch;
  std::vector<double> StandardErrors; ///< FilledError
  int Used = -1;                      ///< Interpolation of the largest hole
};

/** How many errors lie within multiples of FilledError, by thirds of the distance from the rim. */
struct Reliability
{
  static constexpr int Steps = 12; ///< of a quarter; one more class holds what is beyond
  std::size_t Counts[3][Steps + 1] = {};
  std::size_t Unknown = 0;

  void Add(const Reliability& other)
  {
    for (int third = 0; third < 3; ++third)
    {
      for (int step = 0; step <= Steps; ++step)
      {
        this->Counts[third][step] += other.Counts[third][step];
      }
    }
    this->Unknown += other.Unknown;
  }
  /** The share of errors within a number of quarters; of one third, or of all if below 0. */
  double Share(int quarters, int third = -1) const
  {
    double within = 0.0;
    double all = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      for (int step = 0; step <= Steps && (third < 0 || third == k); ++step)
      {
        within += step < quarters ? static_cast<double>(this->Counts[k][step]) : 0.0;
        all += static_cast<double>(this->Counts[k][step]);
      }
    }
    return within / std::max(1.0, all);
  }
};

Reliability CompareErrors(const Filled& filled, const Coordinates& lost, vtkIdType known);

} // namespace benchmark

#endif
