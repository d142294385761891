// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The node with the largest vertical distance from a plane.
 *
 * In: heights of a lattice, and rows of some nodes. Out: the worst node. Linear; compiled for each
 * set of instructions, with the same result.
 */
#ifndef elevation_Simplify_WorstNode_h
#define elevation_Simplify_WorstNode_h

#include "Kernel/Bins/Bins.h"

#include <cstddef>
#include <limits>

namespace elevation
{

/** Nodes of a row. */
struct NodeRow
{
  std::size_t First; ///< the number of the first node
  Index Width;       ///< the number of the last node, less that of the first
  double Plane;      ///< the height of the plane at the first node
};

/** A node, and its distance from the plane. */
struct WorstNode
{
  /** Behind the heights there must be so many more numbers, which may be anything. */
  static constexpr std::size_t Beyond = 8;
  static constexpr double None = std::numeric_limits<double>::infinity();

  double Error = 0.0;
  double Node = None; ///< its number; None if the error is 0

  /**
   * Looks for a worse one. Of equal ones that of the lowest number counts.
   * @param[in] heights  by the numbers of nodes; NaN where there is no point
   * @param[in] rows     from the lowest numbers up
   * @param[in] count    of rows
   * @param[in] step     every so many-th node counts, from the first one of a row on
   * @param[in] slope    of the plane, from one number to the next
   * @param[in] widest   set of instructions that may be used; tests try each
   */
  void Search(const double* heights, const NodeRow* rows, int count, Index step, double slope,
    InstructionSet widest = WidestInstructions());
};

} // namespace elevation

#endif
