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
 * matters. As long as there is but one such point, the whole fan is followed at once.
 *
 * Around the vertex all points of six columns and four rows of bins are gathered: the window. Where
 * these are too many, it is three columns and less rows; in full bins, a box in which the density
 * thereabouts promises about eighteen points. For bins, the coordinates of the four rows are kept as
 * whole multiples of a unit that is small against the bins, so that differences are exact.
 * Boxes are taken from the points around a leaf of the tree, its neighborhood, which are gathered
 * once for all vertices of the leaf and kept while the sweep over the vertices passes through it.
 *
 * The proof. Let R be the longest distance from the vertex within the window, e the error of a
 * coordinate relative to the vertex and u = 2^-24. With cross = b x p and dot = p . (p - b) for the
 * edge's end b and a point p, the apex is the point with the least dot / cross among those on the
 * left (see ApexSearch in Delaunay.cxx). Both are sums of products of coordinates of at most R, and
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
 * x86-64); elsewhere IsSupported() is false and nothing else may be called.
 */
#ifndef elevation_Triangulate_WideApexSearch_h
#define elevation_Triangulate_WideApexSearch_h

#include "BinGrid.h"

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
/** Defined where functions can be compiled for processors with AVX2 among others that are not. */
#define ELEVATION_HAS_AVX2
#endif

namespace elevation
{

class WideApexSearch
{
public:
  /** Whether this processor has what it takes; asked once. */
  static bool IsSupported();

  explicit WideApexSearch(const BinGrid& grid);

  /**
   * Gathers the window of a vertex. Cheapest when vertices come row by row.
   * @param[in] next  the vertex of the next call, or None. What is needed for it is begun, while the
   *                  processor waits for results that the first one's fan depends on.
   * @return false when there is none: too many points in each that was tried
   */
  bool Gather(Index origin, Index next = None);

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

  static constexpr int Capacity = 56;
  static constexpr int NumberOfShapes = 3; ///< of windows of bins

  /**
   * The neighbours of the vertex counter-clockwise after b, apex after apex, as far as each is
   * proved to be the only candidate, and not beyond the last.
   * @param[out] neighbors  room for Capacity slots
   * @param[out] open  the candidates over the edge to the last neighbour that was found, unless that
   * is the last
   * @return how many were found
   */
  int Follow(Index b, Index last, Index* neighbors, Candidates& open) const;

  Index SlotOf(int candidate) const { return this->Current->Slots[candidate]; }

private:
  static constexpr int WidestVectors = 4, EvenVectors = 5, MostVectors = Capacity / 8;
  static constexpr int Room = Capacity + 8; // whole vectors are written
  static constexpr int MostAround = 120;    // a leaf
  static constexpr Index MostRows = 4;
  static constexpr int RowRoom = 40;            // whole vectors are read
  static constexpr std::size_t MostPerBin = 32; // points in a row of which windows are made

  /** The points of a row of bins in units from the grid's corner. */
  struct Row
  {
    Index Number = None;
    Index FirstSlot = 0;
    const Index* Starts = nullptr;  ///< the first slot of each bin, and one more
    std::vector<std::int32_t> X, Y; ///< and RowRoom more
    bool IsRead = false;            ///< else there are too many points: most bins are full
  };

  /** What the size of a window tells of rounding; lengths in the window's unit. */
  struct Bounds
  {
    float ReachSquared = 0.0f;    ///< R^2
    float CoordinateError = 0.0f; ///< e
    float CrossError = 0.0f, DotError = 0.0f, ComparisonError = 0.0f;
    float Margin = 0.0f; ///< what a disc must keep from the window's border

    void Set(double reach, double error, double margin);
  };

  /** The points around a vertex, relative to it; what is not a number is none. */
  struct Window
  {
    alignas(64) float X[Room];
    alignas(64) float Y[Room];
    alignas(64) float Square[Room]; ///< x^2 + y^2
    alignas(64) Index Slots[Room];
    Index Origin = None;
    int Vectors = 0; ///< of the lists that are in use; 0 where there is no window
    int OriginLane = 0;
    // How far the window certainly reaches from the vertex, but for the margin.
    float Left = 0.0f, Right = 0.0f, Top = 0.0f;
    const Bounds* Errors = nullptr;
    bool IsBox = false;
    double PerSide = 0.0; ///< units of the box a unit of the grid

    void Close(int count, bool isWidest);
    template <int Count>
    std::uint64_t LanesOf(Index slot) const;
  };

  /**
   * The points around a leaf of the tree: those of the boxes of all its points, relative to its
   * middle. Vertices of a full bin come by their y, from everywhere in it, but only those of some
   * leaves at a time.
   */
  struct Neighborhood
  {
    Index First = 0, End = 0;         ///< slots of the leaf
    int Count = 0;                    ///< 0 where they are too many
    double CenterX, CenterY, PerSide; ///< sides of the boxes a unit of the grid
    float X[MostAround + 8], Y[MostAround + 8];
    Index Slots[MostAround + 8];
  };

  void EnterRow(Index number);
  void ReadRow(Row& row);
  void GatherInto(Window& window);
  void SetBounds(Window& window, int shape, Index firstColumn, Index endColumn,
    std::int32_t originX, std::int32_t originY) const;
  bool GatherWidest(Window& window, Index firstColumn);
  bool GatherEven(Window& window, Index firstColumn);
  bool GatherBins(Window& window, Index column, int shape);
  bool GatherBox(Window& window);
  const Neighborhood& Around(Index slot);
  void GatherNeighborhood(Neighborhood& around, Index slot);
  bool GatherBox(Neighborhood& around, const BinGrid::Node& top, double lowX, double highX,
    double lowY, double highY);
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
  const bool IsWidest; ///< sixteen points at a time
  Window Windows[2];
  Window* Current = Windows; ///< and the other one is for the next vertex

  // Windows of bins; none when PerUnit is 0.
  double PerUnit = 0.0; ///< units a unit of the grid
  Bounds OfShapes[NumberOfShapes];
  std::vector<std::int32_t> ColumnBounds; ///< left bounds of the columns
  std::vector<Index> Nothing;             ///< the starts of a row beyond the last
  Row Rows[MostRows];                     ///< by their number modulo MostRows
  Row* Near[MostRows];                    ///< from the current row upwards
  Index CurrentRow = None;
  bool AreNearRead = false;
  std::int32_t TopBounds[NumberOfShapes]; ///< of the windows of the current row's vertices
  Bounds OfBox;                           ///< of all boxes, whose unit is their side
  std::vector<Neighborhood> Neighborhoods;
  /** For eight slots, by their number modulo the size, where their leaf's neighborhood was. */
  std::vector<Index> Known;
  std::size_t Oldest = 0;
};

} // namespace elevation

#endif
