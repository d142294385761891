// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Smooth surfaces through scattered points: a sum of radial functions and a plane.
 *
 *   s(p) = sum_j w_j f(|p - c_j|) + a + b x + c y,   sum w_j = sum w_j x_j = sum w_j y_j = 0
 *
 * through the values at the centres c_j [Duchon]. f(r) = r^2 log r gives the thin plate, the
 * surface that bends the least; f(r) = r^3 a smoother one. Both continue planes exactly, and do not
 * depend on the unit of length or the direction of the axes.
 *
 * The conditions are met by a change of basis (Householder's reflections that make a triangle of
 * 1, x, y), in which the matrix is positive definite. Reflections and Cholesky's factor are Eigen's. The
 * factor is made once,
 * and each set of values then takes n^2 steps.
 *
 * Cost: n^3 / 6 multiplications to set up, n for each value; n^2 numbers.
 *
 * [Duchon] Splines minimizing rotation-invariant semi-norms in Sobolev spaces, 1977.
 */
#ifndef elevation_Fill_Spline_h
#define elevation_Fill_Spline_h

#include "Kernel/Base/Base.h"

#include "vtk_eigen.h"
#include VTK_EIGEN(Dense)

#include <cstddef>
#include <vector>

namespace elevation
{

class Spline
{
public:
  enum class Kernel
  {
    ThinPlate,
    Cubic
  };

  /** The weights of the centres, and behind them a, b and c of the plane. */
  using Weights = std::vector<double>;

  /**
   * @param[in] centres  coordinates of size about 1 around the origin, apart from each other
   * @return false when they do not determine a surface: fewer than three, or nearly in a line
   */
  bool Prepare(const std::vector<Point2>& centres, Kernel kernel);

  /** @param[in] values  one for each centre */
  Weights Interpolate(const std::vector<double>& values) const;

  /** Adds the surface's values at @a count points to @a values. */
  void Add(const Weights& weights, const Point2* points, std::size_t count, double* values) const;

  Index NumberOfCentres() const { return static_cast<Index>(this->X.size()); }

private:
  using Matrix = Eigen::MatrixXd;

  Kernel F = Kernel::ThinPlate;
  std::vector<double> X;
  std::vector<double> Y;
  Eigen::HouseholderQR<Matrix> Plane; ///< of the columns 1, x, y
  /** Below the diagonal: of the reflected matrix three columns, of the rest Cholesky's factor. */
  Matrix Factor;
};

} // namespace elevation

#endif
