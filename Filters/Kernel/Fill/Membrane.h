// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Harmonic values on a graph: every unknown is the weighted mean of its neighbours, known values
 * stay. Repeating eq. 2 of [Nguyen] converges to these values, those of a stretched membrane. They
 * lie between the least and the greatest known one.
 *
 * In: a graph, and the known values. Out: the unknown ones, solved for by Multigrid.h.
 * Cost: linear in the unknowns, times a small factor that grows with them; a few hundred bytes per
 * unknown. One thread; the result is the same each time, to the bit.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 */
#ifndef elevation_Fill_Membrane_h
#define elevation_Fill_Membrane_h

#include "Kernel/Base/Base.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace elevation
{

class Multigrid;

/** The neighbours of unknown i: Neighbors[Offsets[i]] to Neighbors[Offsets[i+1] - 1]. */
struct Adjacency
{
  std::vector<std::size_t> Offsets{ 0 };
  /** Below NumberOfKnown: a known vertex; otherwise NumberOfKnown plus the number of an unknown. */
  std::vector<Index> Neighbors;
  std::vector<double> Weights; ///< one per neighbour, positive; symmetric among unknowns
  Index NumberOfKnown = 0;

  Index NumberOfUnknowns() const { return static_cast<Index>(this->Offsets.size()) - 1; }
};

class Membrane
{
public:
  /**
   * Prepares to solve. Keeps a reference to the graph, which is symmetric among unknowns and has a
   * path from every unknown to a known vertex.
   * @throws Aborted, std::bad_alloc
   */
  explicit Membrane(const Adjacency& graph, const Progress& progress = Progress());
  ~Membrane();

  /**
   * The values of the unknowns.
   * @param[in] known     one value for each known vertex, finite, at most about 1e150; or several
   *                      for each, one after another: so many problems, of which each costs less
   * @param[in] accuracy  relative to the known values; low accuracy is faster on large graphs only
   * @return as many for each unknown, in its order
   */
  std::vector<double> Solve(const std::vector<double>& known, double accuracy = 1e-10,
    const Progress& progress = Progress()) const;

  /** Whether the graph is too large to be factorised, so that a solution takes a while. */
  bool IsLarge() const;

private:
  const Adjacency& Graph;
  std::unique_ptr<Multigrid> Equations;
};

} // namespace elevation

#endif
