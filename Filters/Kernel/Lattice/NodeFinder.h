// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The node of a lattice that a point lies on. Constant time.
 */
#ifndef elevation_Lattice_NodeFinder_h
#define elevation_Lattice_NodeFinder_h

#include "FindLattice.h"

#include <cfloat>
#include <cmath>

namespace elevation
{

/** How far beyond the tolerance a point may be from its node, in steps, because of rounding. */
constexpr double NodeRoundoff = 1e-8;

/** A box around the nodes of points, in steps; and the bitmap that holds it (Nodes.h). */
struct NodeBox : Box
{
  /** Columns and rows of the bitmap beyond the last that may be read without a bounds check. */
  static constexpr Index ColumnsBeyond = 64;
  static constexpr Index RowsBeyond = 16;
  /** The most columns or rows: products of four coordinates and steps then fit into 128 bits. */
  static constexpr Index MaximumSide = 1 << 20;

  // Points lie at most a quarter of a step from their nodes, the largest tolerance, so the first
  // node is at most that far above the lowest point, and the last one that far below the highest.
  double FirstI() const { return std::floor(this->Low.X + 0.25); }
  double FirstJ() const { return std::floor(this->Low.Y + 0.25); }
  double Columns() const { return std::ceil(this->High.X - 0.25) - this->FirstI() + 1.0; }
  double Rows() const { return std::ceil(this->High.Y - 0.25) - this->FirstJ() + 1.0; }
  // And one word of zeros behind each row; one more before the first row and one at the end.
  double WordsPerRow() const { return std::floor((this->Columns() + 63.0) / 64.0) + 1.0; }
  double Words() const { return this->WordsPerRow() * (this->Rows() + RowsBeyond) + 2.0; }

  /** In floating point, as a box may have more columns than any integer holds. */
  bool IsSmallEnough() const
  {
    return this->Columns() <= MaximumSide && this->Rows() <= MaximumSide;
  }

  /** Whether points are many enough to be on a lattice with so many nodes. */
  bool IsFilledEnough(double points) const
  {
    return this->IsSmallEnough() &&
      this->Columns() * this->Rows() <= MaximumNodesPerPoint * points &&
      this->Words() <= 2.0 * points + 256.0;
  }
};

/**
 * The node of a point, relative to the lower left one: the inverse of Lattice::Node() by four
 * factors, so that a point costs four multiplications.
 */
class NodeFinder
{
public:
  NodeFinder(const Lattice& lattice)
    : Origin(lattice.Origin)
    , IX(lattice.StepV.Y / lattice.Area())
    , IY(-lattice.StepV.X / lattice.Area())
    , JX(-lattice.StepU.Y / lattice.Area())
    , JY(lattice.StepU.X / lattice.Area())
  {
  }

  void Extend(NodeBox& box, const Point2& p) const { box.Add({ this->I(p), this->J(p) }); }

  /** From here on, columns and rows are counted from the box's first. */
  void Start(const NodeBox& box)
  {
    this->FirstI = box.FirstI();
    this->FirstJ = box.FirstJ();
  }

  // Positions along both steps, in steps from the origin; whole numbers at nodes.
  double I(const Point2& p) const
  {
    return (p.X - this->Origin.X) * this->IX + (p.Y - this->Origin.Y) * this->IY;
  }
  double J(const Point2& p) const
  {
    return (p.X - this->Origin.X) * this->JX + (p.Y - this->Origin.Y) * this->JY;
  }

  /**
   * @return how far the point lies from the node, along the step where it is more; the same
   *         whichever node is the first
   */
  double operator()(const Point2& p, Index& column, Index& row) const
  {
    const double i = this->I(p), j = this->J(p);
    // Rounds to the nearest: what is cast is never below 0 for a point of the box.
    column = static_cast<Index>(i - this->FirstI + 0.5);
    row = static_cast<Index>(j - this->FirstJ + 0.5);
    return std::max(std::fabs(i - (this->FirstI + column)), std::fabs(j - (this->FirstJ + row)));
  }

  /**
   * A bound on the rounding error of that distance: where steps are very unequal, i is a small
   * difference of large numbers. The factors count as exact, as they define the lattice.
   */
  double Roundoff(const Point2& low, const Point2& high) const
  {
    const double x =
      std::max(std::fabs(low.X - this->Origin.X), std::fabs(high.X - this->Origin.X));
    const double y =
      std::max(std::fabs(low.Y - this->Origin.Y), std::fabs(high.Y - this->Origin.Y));
    const double i = x * std::fabs(this->IX) + y * std::fabs(this->IY);
    const double j = x * std::fabs(this->JX) + y * std::fabs(this->JY);
    return 6.0 * DBL_EPSILON * std::max(i, j);
  }

  double FirstI = 0.0, FirstJ = 0.0;

private:
  Point2 Origin;
  double IX, IY, JX, JY;
};

/**
 * The box of a cloud's nodes: that of its bounding box, on a lattice along the axes; on one askew
 * to them, that of the points, which is smaller.
 * @param[in] ofPoints  called for the latter
 */
template <typename OfPoints>
NodeBox FindNodeBox(
  const NodeFinder& nodeOf, const Box& cloud, const Lattice& steps, OfPoints&& ofPoints)
{
  NodeBox box;
  // The corners' positions bound those of all points, as these are linear.
  for (const Point2& p : { cloud.Low, Point2{ cloud.High.X, cloud.Low.Y },
         Point2{ cloud.Low.X, cloud.High.Y }, cloud.High })
  {
    nodeOf.Extend(box, p);
  }
  const double nodesInCloud = cloud.Width() * cloud.Height() / steps.Area();
  // Along the axes, both boxes have about as many nodes as the bounding box has cells. If there are
  // more, the lattice is askew, and a pass over the points pays.
  return box.Columns() * box.Rows() <= 1.05 * nodesInCloud + 64.0 ? box : ofPoints();
}

} // namespace elevation

#endif
