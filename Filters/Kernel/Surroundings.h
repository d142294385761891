// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The points around a vertex, gathered once for all the triangles of its fan, in single precision
 * relative to the vertex, so that wide instructions look at eight of them at a time.
 *
 * In: a grid and a vertex. Out: for an edge that leaves the vertex, the few points one of which is
 * the apex, together with the proof that no other point is; or the answer that it cannot tell. The
 * caller compares the few exactly, or looks elsewhere, so single precision decides nothing that
 * matters.
 *
 * The proof. Around the vertex all points of five columns and four rows of bins are gathered: the
 * window. Where these are too many, it is three columns and less rows; in full bins, a box in which
 * the density thereabouts promises about fifteen points. For each point, an interval is computed that holds the quotient by which apexes are
 * compared (see ApexSearch in Delaunay.cxx), with the rounding of single precision bounded by the
 * size of the window. Points whose interval begins above the least upper end are not the apex. The
 * disc that belongs to that end holds the apex's empty circle; if it lies within the window above
 * the vertex, no point outside needs to be looked at.
 *
 * Needs a processor with AVX2 and a compiler that can be told so for one function (GCC, Clang on
 * x86-64); elsewhere IsSupported() is false and nothing else may be called.
 */
#ifndef elevation_Surroundings_h
#define elevation_Surroundings_h

#include "BinGrid.h"

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
/** Defined where functions can be compiled for processors with AVX2 among others that are not. */
#define ELEVATION_HAS_AVX2
#endif

namespace elevation
{

class Surroundings
{
public:
  /** Whether this processor has what it takes; asked once. */
  static bool IsSupported();

  explicit Surroundings(const BinGrid& grid)
    : Grid(grid)
  {
  }

  /**
   * Gathers the window of a vertex.
   * @return false when there is none: too many points in each that was tried
   */
  bool Gather(Index origin);

  struct Candidates
  {
    std::uint64_t Bits = 0; ///< numbers that SlotOf takes
    /** Whether one of them is the apex; otherwise one is the best point of the window, if any. */
    bool IsProved = false;
  };

  /**
   * The points that may be the apex over the edge from the vertex to b. Points all but on the
   * edge's line are told apart exactly.
   * @return none when it cannot tell
   */
  Candidates FindCandidates(Index b) const;

  /** The path through the tree to the vertex, as BinGrid::FindPath() finds it. */
  const std::vector<BinGrid::Step>& PathToOrigin()
  {
    if (this->Path.empty())
    {
      this->FindPath();
    }
    return this->Path;
  }

  Index SlotOf(int candidate) const { return this->Slots[candidate]; }

private:
  static constexpr int Capacity = 56; // and one more vector may be written beyond

  bool GatherBins(Index column, Index row, Index columnsToEachSide, Index rowsAbove);
  void FindPath();
  bool GatherBox();
  bool GatherBox(const BinGrid::Node& top, double lowX, double highX, double highY);

  const BinGrid& Grid;
  alignas(32) float X[Capacity + 8];
  alignas(32) float Y[Capacity + 8];
  Index Slots[Capacity + 8];
  int Count = 0;
  Index Origin = None;
  std::vector<BinGrid::Step> Path; ///< of the origin; empty when it was not needed
  // How far the window certainly reaches from the vertex; infinite at the border of the grid.
  float Left = 0.0f, Right = 0.0f, Top = 0.0f;
  float ReachSquared = 0.0f; ///< squared diagonal of the window
  float Margin = 0.0f;       ///< what a disc must keep from the window's border
};

} // namespace elevation

#endif
