// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Solves the linear systems of graphs: symmetric, positive definite, no positive entry off the
 * diagonal. In: the matrix and a right-hand side. Out: the solution.
 *
 * Two methods, by size:
 *   - small systems: Eigen's sparse Cholesky factorisation;
 *   - large systems: conjugate gradients, preconditioned by an algebraic multigrid cycle. An
 *     unknown and its neighbours become one unknown of the coarser system [Vanek, Mandel, Brezina;
 *     the aggregates, not smoothed here]. The coarsest system is factorised.
 *
 * The cycle is our own, because neither VTK nor Eigen has one. A factorisation of large systems
 * takes long without a report and hundreds of bytes per unknown; conjugate gradients with an
 * incomplete factorisation take hundreds of steps.
 *
 * Cost: linear in the unknowns, a few hundred bytes each at most. One thread; the result is the
 * same each time, to the bit.
 *
 * [Vanek, Mandel, Brezina] Algebraic multigrid by smoothed aggregation for second and fourth order
 * elliptic problems, 1996.
 */
#ifndef elevation_Fill_Multigrid_h
#define elevation_Fill_Multigrid_h

#include "Kernel/Base/Base.h"

#include "vtk_eigen.h"
#include VTK_EIGEN(SparseCholesky)

#include <deque>
#include <vector>

namespace elevation
{

class Multigrid
{
public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor, Index>; ///< all of it, rows sorted
  using Vector = Eigen::VectorXd;
  /** A column for each system; rows are together in memory. */
  using Vectors = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /** @throws Aborted, std::bad_alloc */
  Multigrid(Matrix matrix, const Progress& progress);

  /**
   * @param[in] right     the right-hand side
   * @param[in] accuracy  relative to the solution; low accuracy is faster for large systems only
   */
  Vector Solve(Vector right, double accuracy, const Progress& progress) const;

  /** The same for several right-hand sides: small systems take little longer than for a few. */
  Vectors Solve(Vectors right, double accuracy, const Progress& progress) const;

  /** Whether the system is too large to be factorised, so that a solution takes a while. */
  bool IsLarge() const { return this->Levels.size() > 1; }

private:
  /** A matrix, and for each of its rows the row of the next coarser one. */
  struct Level
  {
    Matrix A;
    std::vector<Index> Coarse;
  };

  Vector Cycle(std::size_t level, const Vector& right, const Progress& progress) const;

  std::deque<Level> Levels; ///< from fine to coarse; never copied, as Eigen would
  Eigen::SimplicialLLT<Matrix> Coarsest;
};

} // namespace elevation

#endif
