// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Harmonic values on a graph: every unknown is the weighted mean of its neighbours, the known ones
 * keep their values. This is the state that eq. 2 of [Nguyen] tends to when it is repeated, a
 * stretched membrane. Values stay between the least and the greatest known one.
 *
 * Two ways, by the work that the first would take:
 *   - a Cholesky factorisation in the order of a breadth-first search, in which the entries
 *     of a row lie close to the diagonal [Cuthill & McKee];
 *   - conjugate gradients with a multigrid cycle before each step. The coarser graphs are made of
 *     the graph itself: a vertex and its neighbours become one vertex [Vanek, Mandel, Brezina].
 *
 * Cost: a fraction of a microsecond an unknown and right-hand side for small graphs, a few
 * microseconds for large ones; some 300 bytes an unknown. One thread; the same bits each time.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 * [Cuthill & McKee] Reducing the bandwidth of sparse symmetric matrices, 1969.
 * [Vanek, Mandel, Brezina] Algebraic multigrid by smoothed aggregation for second and fourth order
 * elliptic problems, 1996 (the aggregates; not smoothed here).
 */
#ifndef elevation_Fill_Membrane_h
#define elevation_Fill_Membrane_h

#include "Kernel/Base/Base.h"

#include <cstddef>
#include <vector>

namespace elevation
{

/** The neighbours of unknown i of a graph: Neighbours[Offsets[i]] to Neighbours[Offsets[i+1] - 1].
 */
struct Adjacency
{
  std::vector<std::size_t> Offsets{ 0 };
  /** Below NumberOfKnown: a vertex with a known value; else this number plus the unknown's. */
  std::vector<Index> Neighbours;
  std::vector<double> Weights; ///< one a neighbour, positive; symmetric among unknowns
  Index NumberOfKnown = 0;

  Index NumberOfUnknowns() const { return static_cast<Index>(this->Offsets.size()) - 1; }
};

class Membrane
{
public:
  /**
   * Prepares to solve. @a graph must stay; it is symmetric among unknowns, and from every unknown
   * there is a way to a known vertex.
   * @throws Aborted, std::bad_alloc
   */
  explicit Membrane(const Adjacency& graph, const Progress& progress = Progress());

  /**
   * The values of the unknowns.
   * @param[in] known     one value for each known vertex, finite, at most about 1e150
   * @param[in] accuracy  of the solution, relative to the known values; only large graphs
   *                      are solved the faster the less accurate
   */
  std::vector<double> Solve(const std::vector<double>& known, double accuracy = 1e-10,
    const Progress& progress = Progress()) const;

  /** Whether the graph is so large that it is not factorised, and a solution takes a while. */
  bool IsLarge() const { return this->Levels.size() > 1; }

private:
  /** A symmetric matrix: the diagonal, and the other entries row by row. */
  struct Matrix
  {
    std::vector<double> Diagonal;
    std::vector<std::size_t> Offsets{ 0 };
    std::vector<Index> Columns;
    std::vector<double> Values;

    Index Size() const { return static_cast<Index>(this->Diagonal.size()); }
  };

  /** The Cholesky factor of a matrix whose rows are reordered, from the first entry of each row. */
  struct Factor
  {
    std::vector<Index> Order; ///< place -> row of the matrix
    std::vector<Index> First; ///< column of the first entry of the row at a place
    std::vector<std::size_t> Offsets{ 0 };
    std::vector<double> Values;
  };

  /** A matrix, and into which row of the next coarser one each of its rows goes. */
  struct Level
  {
    Matrix A;
    std::vector<Index> Coarse;
  };

  static void Arrange(const Matrix& matrix, Factor& factor, const Progress& progress);
  static double WorkOf(const Factor& factor);
  static void Factorize(const Matrix& matrix, Factor& factor, const Progress& progress);
  static void SolveFactor(
    const Factor& factor, const std::vector<double>& right, std::vector<double>& x);
  static bool Coarsen(Level& fine, Matrix& coarse, const Progress& progress);
  void Cycle(std::size_t level, const std::vector<double>& right, std::vector<double>& x,
    const Progress& progress) const;

  const Adjacency& Graph;
  std::vector<Level> Levels; ///< from fine to coarse; of the last one there is the factor
  Factor Coarsest;
};

} // namespace elevation

#endif
