// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Smooth surfaces through scattered points: a sum of radial functions and a plane.
 *
 *   s(p) = sum_j w_j f(|p - c_j|) + a + b x + c y,   sum w_j = sum w_j x_j = sum w_j y_j = 0
 *
 * through the values at the centres c_j [Duchon]. f(r) = r^2 log r gives the thin plate, which
 * bends least; f(r) = r^3 gives a smoother surface. Both reproduce planes exactly, and do not
 * depend on the unit of length or the direction of the axes.
 *
 * The side conditions are met by a change of basis, the Householder reflections of the QR
 * factorisation of the columns 1, x, y. In this basis the matrix is positive definite.
 * QR and Cholesky factorisation are Eigen's.
 *
 * With a nugget l_j at a centre, the spline only comes near the value there: of all surfaces it has
 * the least bending plus squares of what it misses, over l_j [Wahba].
 *
 * Cost, for n centres: n^3 / 6 multiplications to set up, n^2 for each set of values, n for each
 * point; n^2 numbers in memory.
 *
 * [Duchon] Splines minimizing rotation-invariant semi-norms in Sobolev spaces, 1977.
 * [Wahba] Spline Models for Observational Data, 1990.
 */
#ifndef elevation_Fill_Spline_h
#define elevation_Fill_Spline_h

#include "Kernel/Base/Base.h"
#include "Kernel/Bins/Bins.h"

#include "vtk_eigen.h"
#include VTK_EIGEN(Dense)

#include <algorithm>
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

  /** @param[in] widest  of the sets of instructions; all give the same, to the bit */
  explicit Spline(InstructionSet widest = WidestInstructions())
    : Instructions(std::min(widest, WidestInstructions()))
  {
  }

  /**
   * The weights of the centres, then a, b and c of the plane. Of several sets of values, the
   * weights of all sets are together for each of these, as are the values for each centre and point.
   */
  using Weights = std::vector<double>;

  /**
   * @param[in] centers  distinct, around the origin, with coordinates of size about 1
   * @param[in] nuggets  one a centre, or none: the spline goes through the values
   * @return false if they do not determine a surface: fewer than three, or nearly in a line
   */
  bool Prepare(const std::vector<Point2>& centers, Kernel kernel,
    const std::vector<double>& nuggets = std::vector<double>());

  /**
   * How rough values are, in squares of them: for values that are drawn at random such that this
   * spline predicts them best, the expected variance of a weight 1.
   */
  double Roughness(const std::vector<double>& values) const;

  /** @param[in] values  one per centre; or several for each, of which each set costs less */
  Weights Interpolate(const std::vector<double>& values) const;

  /** Adds the spline's values at count points to values: as many for each as there are sets. */
  void Add(const Weights& weights, const Point2* points, std::size_t count, double* values) const;

private:
  using Matrix = Eigen::MatrixXd;
  /** A column for each set; rows are together in memory. */
  using Sets = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  void AddSets(
    const Weights& weights, const Point2* points, std::size_t count, double* values) const;

  InstructionSet Instructions;
  Kernel F = Kernel::ThinPlate;
  std::vector<double> X;
  std::vector<double> Y;
  Eigen::HouseholderQR<Matrix> Plane; ///< of the columns 1, x, y
  /** Lower triangle: three columns of the transformed matrix, then the rest's Cholesky factor. */
  Matrix Factor;
};

/**
 * Takes centres: again and again the point that is farthest from all that are taken.
 * @param[in] candidates   so many first points
 * @param[in] most         so many are taken in all
 * @param[in] leastSquare  ends where no distance has a larger square
 * @param[in,out] squares  of distances from what is taken, one a point; at first infinite, or below
 *                         any limit where a point is not to be taken
 */
void TakeFarthest(const std::vector<Point2>& points, std::size_t candidates, std::size_t most,
  double leastSquare, const Progress& progress, std::vector<double>& squares,
  std::vector<Index>& taken);

} // namespace elevation

#endif
