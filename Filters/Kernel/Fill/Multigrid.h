// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Solves systems of equations of a graph: symmetric, positive definite, no entry off the diagonal
 * above zero.
 *
 * Two ways, by the size:
 *   - small systems by a sparse Cholesky factorisation, which is Eigen's;
 *   - large ones by conjugate gradients with a multigrid cycle before each step. The coarser systems
 *     are made of the matrix itself: an unknown and its neighbours become one [Vanek, Mandel,
 *     Brezina; the aggregates, not smoothed here]. The coarsest is factorised.
 *
 * The cycle is our own, because neither VTK nor Eigen has one. A factorisation of a million unknowns
 * takes minutes without a report and hundreds of bytes each; conjugate gradients with an incomplete
 * factorisation take hundreds of steps.
 *
 * Cost: linear in the unknowns, at most some hundred bytes each. One thread; the same bits each
 * time.
 *
 * [Vanek, Mandel, Brezina] Algebraic multigrid by smoothed aggregation for second and fourth order
 * elliptic problems, 1996.
 */
#ifndef elevation_Fill_Multigrid_h
#define elevation_Fill_Multigrid_h

#include "Kernel/Base/Base.h"

#include "vtk_eigen.h"
#include VTK_EIGEN(SparseCholesky)

#include <vector>

namespace elevation
{

class Multigrid
{
public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor, Index>; ///< all of it, rows sorted
  using Vector = Eigen::VectorXd;

  /** @throws Aborted, std::bad_alloc */
  Multigrid(Matrix matrix, const Progress& progress);

  /**
   * @param[in] right     the right-hand side
   * @param[in] accuracy  relative to the solution; only large systems are solved the faster the
   *                      less accurate
   */
  Vector Solve(Vector right, double accuracy, const Progress& progress) const;

  /** Whether the system is not factorised itself, and a solution takes a while. */
  bool IsLarge() const { return this->Levels.size() > 1; }

private:
  /** A matrix, and into which row of the next coarser one each of its rows goes. */
  struct Level
  {
    Matrix A;
    std::vector<Index> Coarse;
  };

  Vector Cycle(std::size_t level, const Vector& right, const Progress& progress) const;

  std::vector<Level> Levels; ///< from fine to coarse
  Eigen::SimplicialLLT<Matrix> Coarsest;
};

} // namespace elevation

#endif
