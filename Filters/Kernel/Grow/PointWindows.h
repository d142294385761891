// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Windows of points: the points around a vertex, in single precision relative to it, so that wide
 * instructions handle eight or sixteen at a time. Bins and tree would be searched for the same
 * points again for each triangle around the vertex.
 *
 * In: a grid and a vertex. Out: the points of six columns and four rows of bins around the vertex;
 * if these are too many, of three columns and fewer rows; in full bins, of a box that is expected
 * to contain about eighteen points by the local density. For windows of bins, the coordinates of
 * the four rows are rounded to multiples of a unit that is small compared with the bins, so that
 * differences are exact. Boxes are taken from the points around a leaf (Neighborhoods.h).
 *
 *   +--+--+--+--+--+--+ -- Top     The window of v: six columns, of which v lies in one of the two
 *   |  |  |  |  |  |  |            in the middle; its row, and three rows above it. Nothing below
 *   |  |  |  |  |  |  |            is needed, as v is the lowest vertex of its triangles. An apex
 *   |  |  |  |  |  |  |            is proved if its disc, above v, keeps within Left, Right and
 *   |  |  |v |  |  |  |            Top, less a margin.
 *   +--+--+--+--+--+--+
 *  Left             Right
 *
 * Cost: constant per vertex; memory proportional to a row of bins and to the square root of the
 * number of points.
 */
#ifndef elevation_Grow_PointWindows_h
#define elevation_Grow_PointWindows_h

#include "Neighborhoods.h"

namespace elevation
{

/**
 * The windows of one strip's vertices, one after another. Points are packed from the first lane on,
 * and take FewLanes or MostLanes, in as many vectors as the processor needs for them. For each of
 * the two numbers there is one instance of the search (WideApexSearch.cxx), whose loops over
 * vectors the compiler unrolls.
 */
class PointWindows
{
public:
  // A lane is a bit of a 64-bit mask, and its number fits the six lowest bits of a float.
  static constexpr int FewLanes = 32, MostLanes = 64;
  static constexpr int Capacity = 56;         ///< points of a window
  static constexpr int Room = MostLanes + 16; ///< as whole vectors are written
  static constexpr double Roundoff = 0x1p-24; ///< of single precision

  /** Error bounds for a size of windows; lengths in the window's unit. See WideApexSearch.h. */
  struct Bounds
  {
    float ReachSquared = 0.0f;    ///< R^2
    float CoordinateError = 0.0f; ///< e
    float CrossError = 0.0f, DotError = 0.0f, ComparisonError = 0.0f;
    float Margin = 0.0f; ///< what a disc must keep from the window's border

    void Set(double reach, double error, double margin);
  };

  /**
   * The points around a vertex, relative to it. In the lanes behind them X is NaN, which fails
   * every comparison; the rest is anything there, so a slot counts only where X is not NaN.
   */
  struct Window
  {
    alignas(64) float X[Room];
    alignas(64) float Y[Room];
    alignas(64) float Square[Room]; ///< x^2 + y^2
    alignas(64) Index Slots[Room];
    Index Origin = None;
    int Lanes = 0; ///< how many are in use: FewLanes, MostLanes, or 0 if there is no window
    int OriginLane = 0;
    // How far the window certainly reaches from the vertex, up to the margin.
    float Left = 0.0f, Right = 0.0f, Top = 0.0f;
    const Bounds* Errors = nullptr;
    bool IsBox = false;
    double PerSide = 0.0; ///< units of the box per unit of the grid
  };

  /** @param instructions  a set with vectors that the processor has; otherwise there is no window */
  PointWindows(const BinGrid& grid, InstructionSet instructions);

  /**
   * Gathers the window of a vertex. Cheapest when vertices come row by row.
   * @param[in] next  the vertex of the next call, or None. Its window is gathered as well, while
   *                  the processor waits for results that the first one's fan depends on.
   * @return false if there are too many points in each window that was tried
   */
  bool Gather(Index origin, Index next);

  const Window& Current() const { return *this->InUse; }

  /** The position of a grid point relative to the window's vertex, in the window's units. */
  void Place(Index slot, float& x, float& y) const;

  /** A row of bins from the current one upwards. */
  struct NearRow
  {
    const std::int32_t *X, *Y; ///< of its points, in units from the grid's corner
    const Index* Starts;       ///< the first slot of each bin, and the end of the last
    Index FirstSlot;
  };

private:
  static constexpr int NumberOfShapes = 3; ///< of windows of bins
  static constexpr Index MostRows = 4;
  static constexpr int RowRoom = 40;            // as whole vectors are read
  static constexpr std::size_t MostPerBin = 32; // mean in rows for which windows are made

  /**
   * The points of a row of bins in units from the grid's corner. Rounded once per row, not once per
   * window: each point is in the windows of some twenty vertices.
   */
  struct Row
  {
    Index Number = None;
    Index FirstSlot = 0;
    const Index* Starts = nullptr;  ///< the first slot of each bin, and the end of the last
    std::vector<std::int32_t> X, Y; ///< with RowRoom to spare
    bool IsRead = false;            ///< false if there are too many points: most bins are full
  };

  void EnterRow(Index number);
  void ReadRow(Row& row);
  /** Fills the window of window.Origin by the first of the ways that succeeds. */
  void GatherInto(Window& window);
  void SetBounds(Window& window, int shape, Index firstColumn, Index endColumn,
    std::int32_t originX, std::int32_t originY) const;
  bool GatherBins(Window& window, Index firstColumn, int shape);
  bool GatherBox(Window& window);

  const BinGrid& Grid;
  const InstructionSet Instructions;
  Window Windows[2];
  Window* InUse = Windows; ///< the other one is for the next vertex

  // Windows of bins; none when PerUnit is 0.
  double PerUnit = 0.0; ///< units of windows per unit of the grid
  Bounds ShapeBounds[NumberOfShapes];
  // One more than columns: the last one is the right border of the last column.
  std::vector<std::int32_t> ColumnBounds; ///< left bounds of the columns
  std::vector<Index> Nothing;             ///< the starts of a row beyond the last
  Row Rows[MostRows];                     ///< by their number modulo MostRows
  NearRow Near[MostRows];                 ///< from the current row upwards
  Index CurrentRow = None;
  bool AreNearRead = false;
  std::int32_t TopBounds[NumberOfShapes]; ///< of windows of vertices in the current row
  Bounds BoxBounds;                       ///< of all boxes; their unit is their side
  Neighborhoods Leaves;
};

} // namespace elevation

#endif
