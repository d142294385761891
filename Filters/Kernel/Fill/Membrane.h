// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Harmonic values on a graph: every unknown is the weighted mean of its neighbours, the known ones
 * keep their values. This is the state that eq. 2 of [Nguyen] tends to when it is repeated, a
 * stretched membrane. Values stay between the least and the greatest known one.
 *
 * The systems of equations are solved by Multigrid.h.
 *
 * Cost: linear in the unknowns, but for a small factor that grows with them, and a few hundred bytes
 * each. One thread; the same bits each time.
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
  ~Membrane();

  /**
   * The values of the unknowns.
   * @param[in] known     one value for each known vertex, finite, at most about 1e150
   * @param[in] accuracy  of the solution, relative to the known values; only large graphs
   *                      are solved the faster the less accurate
   */
  std::vector<double> Solve(const std::vector<double>& known, double accuracy = 1e-10,
    const Progress& progress = Progress()) const;

  /** Whether the graph is so large that it is not factorised, and a solution takes a while. */
  bool IsLarge() const;

private:
  const Adjacency& Graph;
  std::unique_ptr<Multigrid> Equations;
};

} // namespace elevation

#endif
