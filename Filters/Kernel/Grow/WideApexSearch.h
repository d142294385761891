// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Searches for the apexes of the triangles around a vertex among the points of its window
 * (PointWindows.h), with vectors of as many as the processor takes at a time.
 *
 * In: a grid and a vertex. Out: for an edge that leaves the vertex, a few candidates for the apex,
 * with the proof that one of them is; or no proof. The caller compares the candidates exactly, or
 * searches elsewhere, so the result is exact in spite of single precision. As long as there is only
 * one candidate, the fan is followed from edge to edge. Constant cost per edge.
 *
 * The proof. Let R be the longest distance from the vertex within the window, e the error of a
 * coordinate relative to the vertex and u = 2^-24. With cross = b x p and dot = p . (p - b) for the
 * edge's end b and a point p, the apex is the point with the least dot / cross among those on the
 * left (ApexSearch.h). Both are sums of products of coordinates of at most R, with errors of up to
 *   cross: 3 R e + 3 u R^2,   dot: 6 R e + 6 u R^2.
 * A first pass guesses the apex by rounded quotients. A second pass compares every point with it:
 *   dot cross' - dot' cross, with an error of at most 24 R^3 e + 32 u R^4,
 * which is not negative for points outside the circle of the edge and the guess, on either side. So
 * points for which it is clearly positive are not the apex. Exact predicates decide which of the
 * others are on the left. The disc of the guess, enlarged by the error of its quotient, contains
 * the apex's empty circle; if it lies within the window above the vertex, no other point can be the
 * apex.
 *
 * The bounds hold with fused operations and without, so they are used where the processor has them.
 *
 * Needs a set of instructions with vectors (Instructions.h). With Scalar, no vertex has a window.
 */
#ifndef elevation_Grow_WideApexSearch_h
#define elevation_Grow_WideApexSearch_h

#include "PointWindows.h"

namespace elevation
{

/** The windows of one strip's vertices, and the search in them. */
class WideApexSearch
{
public:
  static constexpr int Capacity = PointWindows::Capacity;

  /** @param widest  the widest instructions to use */
  WideApexSearch(const BinGrid& grid, InstructionSet widest)
    : Grid(grid)
    , Instructions(std::min(widest, WidestInstructions()))
    , Windows(grid, this->Instructions)
  {
  }

  /** Gathers the window of a vertex, see PointWindows. */
  bool Gather(Index origin, Index next = None) { return this->Windows.Gather(origin, next); }

  // More than one candidate means ties, or points too close for single precision.
  struct Candidates
  {
    std::uint64_t Bits = 0; ///< lanes, numbers that SlotOf() takes
    /** Whether one of them is the apex. */
    bool IsProved = false;
  };

  /**
   * The points that may be the apex over the edge from the vertex to b, all on its left; without a
   * proof, some points near it, on either side, or none.
   */
  Candidates FindCandidates(Index b) const;

  /**
   * Finds the neighbours of the vertex counter-clockwise after b, as far as each apex is proved to
   * be the only candidate, and not beyond the last neighbour.
   * @param[out] neighbors  room for Capacity slots
   * @param[out] open       the candidates over the edge to the neighbour found last, unless it is
   *                        the last one
   * @return how many were found
   */
  int Follow(Index b, Index last, Index* neighbors, Candidates& open) const;

  Index SlotOf(int candidate) const { return this->Windows.Current().Slots[candidate]; }

private:
  const BinGrid& Grid;
  const InstructionSet Instructions;
  PointWindows Windows;
};

} // namespace elevation

#endif
