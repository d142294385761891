// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The apexes of the triangles around a vertex, looked for with wide instructions among the points of
 * its window, eight or sixteen at a time.
 *
 * In: a grid and a vertex. Out: for an edge that leaves the vertex, the few points one of which is
 * the apex, together with the proof that no other point is; or the answer that it cannot tell. The
 * caller compares the few exactly, or looks elsewhere, so single precision decides nothing that
 * matters. As long as there is but one such point, the whole fan is followed at once.
 *
 * The proof. Let R be the longest distance from the vertex within the window, e the error of a
 * coordinate relative to the vertex and u = 2^-24. With cross = b x p and dot = p . (p - b) for the
 * edge's end b and a point p, the apex is the point with the least dot / cross among those on the
 * left (ApexSearch.h). Both are sums of products of coordinates of at most R, and
 * are wrong by
 *   cross: 3 R e + 3 u R^2,   dot: 6 R e + 6 u R^2.
 * A first pass guesses the apex with rounded quotients. The second compares every point with it, by
 *   dot cross' - dot' cross, which is wrong by 24 R^3 e + 32 u R^4 at most
 * and not negative for points outside the circle of the edge and the guess, on whichever side. So
 * points for which it is clearly positive are not the apex. Of others, the exact predicates tell
 * which are on the left. The disc of the guess, made larger by what its quotient may be wrong, holds
 * the apex's empty circle; if it lies within the window above the vertex, no point outside needs to
 * be looked at.
 *
 * Where the processor has AVX-512, windows of at most 32 points are looked at in two vectors.
 *
 * Needs a processor with AVX2 and a compiler that can be told so for one function (GCC, Clang on
 * x86-64). Elsewhere WidestInstructions() is Scalar, and nothing but the constructor may be called.
 */
#ifndef elevation_Triangulate_WideApexSearch_h
#define elevation_Triangulate_WideApexSearch_h

#include "PointWindows.h"

namespace elevation
{

class WideApexSearch
{
public:
  static constexpr int Capacity = PointWindows::Capacity;

  /** @param widest  use no wider instructions, though the processor has them; at least AVX2 */
  WideApexSearch(const BinGrid& grid, InstructionSet widest);

  /** Gathers the window of a vertex, see PointWindows. */
  bool Gather(Index origin, Index next = None) { return this->Windows.Gather(origin, next); }

  struct Candidates
  {
    std::uint64_t Bits = 0; ///< numbers that SlotOf takes
    /** Whether one of them is the apex. */
    bool IsProved = false;
  };

  /**
   * The points that may be the apex over the edge from the vertex to b, all on its left; or, when
   * that is not proved, a point that is near it, on whichever side.
   * @return none when it cannot tell
   */
  Candidates FindCandidates(Index b) const;

  /**
   * The neighbours of the vertex counter-clockwise after b, apex after apex, as far as each is
   * proved to be the only candidate, and not beyond the last.
   * @param[out] neighbors  room for Capacity slots
   * @param[out] open  the candidates over the edge to the last neighbour that was found, unless that
   * is the last
   * @return how many were found
   */
  int Follow(Index b, Index last, Index* neighbors, Candidates& open) const;

  Index SlotOf(int candidate) const { return this->Windows.Current().Slots[candidate]; }

private:
  using Window = PointWindows::Window;
  static constexpr int WidestVectors = PointWindows::WidestVectors,
                       EvenVectors = PointWindows::EvenVectors,
                       MostVectors = PointWindows::MostVectors;

  bool PlaceEnd(Index b, std::uint64_t lanes, float& x, float& y) const;
  template <int Vectors>
  Candidates Search(float bx, float by, int& guess) const;
  template <int Vectors>
  int FollowVectors(Index b, Index last, Index* neighbors, Candidates& open) const;
  int FollowWidest(Index b, Index last, Index* neighbors, Candidates& open) const;
  bool IsInWindow(float bx, float by, float dot, float cross) const;
  void Sift(Index b, float bx, float by, int guess, Candidates& candidates) const;
  bool IsDecided(Index b, float bx, float by, int& guess, Candidates& candidates) const;

  const BinGrid& Grid;
  PointWindows Windows;
};

} // namespace elevation

#endif
