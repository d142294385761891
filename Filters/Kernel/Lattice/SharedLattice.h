// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * One lattice for all parts of a cloud: which node each point is on, and how far circles through
 * nodes reach. Constant time.
 */
#ifndef elevation_Lattice_SharedLattice_h
#define elevation_Lattice_SharedLattice_h

#include "Metric.h"
#include "NodeFinder.h"

#include <array>
#include <cstdint>

namespace elevation
{

/**
 * Thrown where points do not fit a lattice after all: they are triangulated by their coordinates.
 */
struct NotOnLattice
{
};

/** Column and row of a node; the lowest is first by row, then by column. */
struct LatticeNode
{
  std::int64_t I, J;
};

/**
 * Whether so few points may fit some lattice by chance, which large tolerances make likely.
 * @param[in] count  of points, without duplicates
 */
bool IsLatticeByChance(double count, double tolerance);

// Cells/Pieces.cxx and the surfaces in parts give it to every piece, so that all pieces have the
// same nodes and circles; each could find another lattice by itself.
class SharedLattice
{
public:
  /**
   * @param[in] cloud      the box of all finite points of the whole cloud
   * @param[in] nodes      that of their nodes, by FindNodeBox()
   * @param[in] tolerance  how far a point may lie from its node along each step, in steps
   * @return false if there are too many rows or columns, or too unequal steps. A lattice that was
   *         found is only one if its nodes are NodeBox::IsFilledEnough(), too.
   */
  bool Set(const Lattice& steps, const Box& cloud, const NodeBox& nodes, double tolerance);

  const Lattice& Steps() const { return this->NodeSteps; }
  const LatticeMetric& Metric() const { return this->StepMetric; }
  double Tolerance() const { return this->ToleranceInSteps; }

  /** @throws NotOnLattice if the point is too far from it */
  LatticeNode NodeOf(const Point2& p) const;

  /**
   * A box that holds all points whose nodes are in or on the circle of three nodes, in the metric;
   * rounding errors make it larger, never smaller.
   */
  Box CircleBox(const LatticeNode& a, const LatticeNode& b, const LatticeNode& c) const;

private:
  Lattice NodeSteps;
  LatticeMetric StepMetric;
  NodeFinder ToNode{ Lattice{ { 0.0, 0.0 }, { 1.0, 0.0 }, { 0.0, 1.0 } } };
  double ToleranceInSteps = 0.0;
  Point2 Reach{ 0.0, 0.0 }; ///< how far a point may lie from its node, along x and y
};

} // namespace elevation

#endif
