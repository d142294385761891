// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The segments of lines, in pieces between vertices: pass 1 of CutLines.h, and the grid in which
 * the later passes look for vertices and crossings.
 *
 * In: lines. Out: their distinct points as vertices, and the distinct segments between them, from
 * the lower end to the upper one. Cost: n log n in the points of the lines.
 */
#ifndef elevation_Constrain_SegmentNetwork_h
#define elevation_Constrain_SegmentNetwork_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

/** Lines that must be edges: line i runs through Vertices[Offsets[i]] ... [Offsets[i + 1] - 1]. */
struct ConstraintLines
{
  PointView Points;
  std::vector<Index> Offsets{ 0 };
  std::vector<Index> Vertices; ///< ids of Points
  std::vector<char> IsClosed;  ///< one per line: whether its last point is joined to its first
  std::vector<Index> Cells;    ///< one per line; the number that messages use

  Index Count() const { return static_cast<Index>(this->Offsets.size()) - 1; }

  /**
   * Calls visit(line, k, next) for each segment, from Vertices[k] to Vertices[next]; at the end of
   * a line that is not closed both are its last one.
   */
  template <typename Visitor>
  void VisitSegments(Visitor&& visit) const
  {
    for (Index line = 0; line < this->Count(); ++line)
    {
      const Index begin = this->Offsets[line], end = this->Offsets[line + 1];
      for (Index k = begin; k < end; ++k)
      {
        visit(line, k, k + 1 < end ? k + 1 : (this->IsClosed[line] ? begin : k));
      }
    }
  }
};

/** The id of vertex k of the lines. @throws Error if it does not exist or is not finite */
Index LinePoint(const ConstraintLines& lines, Index line, Index k);

/**
 * A vertex of the lines. Vertices of lines come first, in the order of their ids; then input points
 * on lines; then crossings.
 */
struct LineVertex
{
  Point2 Position;
  Index Input;  ///< the input point at the same place
  Index Source; ///< the lines' point at the same place
  Index From;   ///< a crossing: it lies between these vertices
  Index To;
};

/**
 * Vertices, and the pieces of segments between them. Plain data: CutLines.cxx and
 * ConstraintCrossings.cxx both work on it, in turn.
 */
struct SegmentNetwork
{
  std::vector<LineVertex> Vertices;
  std::vector<SegmentPiece> Pieces; ///< each from its lower end to its upper one
  // Only as current as the last EnterInGrid(): a round finds all cuts before it makes them.
  std::vector<Ends> PieceEnds;      ///< as entered in the grid
  CellGrid Grid{ GridOf({}) };
  std::vector<Segment> Segments;   ///< by rank, which is the order of the lines
  std::vector<Index> SegmentLines; ///< by rank

  const Point2& At(Index vertex) const { return this->Vertices[vertex].Position; }
  /** Adds a vertex that is no point of a line. */
  Index AddVertex(const Point2& p)
  {
    this->Vertices.push_back({ p, None, None, None, None });
    return static_cast<Index>(this->Vertices.size()) - 1;
  }
  /** Makes the points and segments of lines its vertices and pieces. */
  void Collect(const ConstraintLines& lines, const Progress& progress);
  /** Makes equal pieces one, which counts as many segments as they did. */
  void JoinEqualPieces(const Progress& progress);
  /** Enters the current pieces in the grid. */
  void EnterInGrid(const Progress& progress);
};

} // namespace elevation

#endif
