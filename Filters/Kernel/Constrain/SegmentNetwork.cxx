// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SegmentNetwork.h"

#include "Kernel/Messages/Messages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace elevation
{
namespace
{

/**
 * Makes one vertex of each place of the lines' points. A sort instead of a hash table: the lowest
 * id of equal points is then known at once.
 * @return the vertex of each point
 */
std::vector<Index> CollectPoints(
  const ConstraintLines& lines, const Progress& progress, std::vector<LineVertex>& vertices)
{
  Stages stages(progress, { 50, 50 });
  const PointView& own = lines.Points;
  const Progress listing = stages.Next();
  std::vector<Index> used;
  for (Index line = 0; line < lines.Count(); ++line)
  {
    for (const Index k : Counted(lines.Offsets[line], lines.Offsets[line + 1]))
    {
      ReportStep(listing, k, lines.Vertices.size());
      used.push_back(LinePoint(lines, line, k));
    }
  }
  // By position, so that equal points are adjacent; the lowest id is the source of the vertex.
  Sort(
    used.begin(), used.end(),
    [&](Index p, Index q) {
      const Point2 at = own.At(p), other = own.At(q);
      return at != other ? IsLower(at, other) : p < q;
    },
    stages.Next());
  std::vector<Index> vertexOf(own.Count, None); // at first, the source
  for (std::size_t i = 0, first = 0; i < used.size(); ++i)
  {
    first = i > 0 && own.At(used[i]) == own.At(used[first]) ? first : i;
    vertexOf[used[i]] = used[first];
  }
  // A source has the lowest id of its vertex, so it comes before the others.
  for (Index id = 0; id < own.Count; ++id)
  {
    if (vertexOf[id] == id)
    {
      vertexOf[id] = static_cast<Index>(vertices.size());
      vertices.push_back({ own.At(id), None, id, None, None });
    }
    else if (vertexOf[id] != None)
    {
      vertexOf[id] = vertexOf[vertexOf[id]];
    }
  }
  return vertexOf;
}
} // namespace

Index LinePoint(const ConstraintLines& lines, Index line, Index k)
{
  const PointView& points = lines.Points;
  const Index id = lines.Vertices[k];
  const bool exists = id >= 0 && id < points.Count;
  if (!exists || !points.IsFinite(id))
  {
    // Messages name the line by the cell of the input, not by its place in the list.
    const Index cell = lines.Cells[line];
    throw exists ? MakeError<sentences::NonFinitePointOfLine>(id, "constraints'", cell)
                 : MakeError<sentences::NoSuchPointOfLine>(id, "constraints'", cell);
  }
  return id;
}

void SegmentNetwork::Collect(const ConstraintLines& lines, const Progress& progress)
{
  Stages stages(progress, { 50, 10, 40 });
  const std::vector<Index> vertexOf = CollectPoints(lines, stages.Next(), this->Vertices);
  Report(stages.Next(), 0.0);
  std::vector<char> hasSegment(this->Vertices.size(), 0);
  // From the lower end up, so that segments in both directions are the same.
  lines.VisitSegments([&](Index line, Index k, Index next) {
    Index p = vertexOf[lines.Vertices[k]], q = vertexOf[lines.Vertices[next]];
    if (p != q)
    {
      if (IsLower(this->At(q), this->At(p)))
      {
        std::swap(p, q);
      }
      // Ranks are in the order of lines, for which elevations at crossings are taken.
      const Index rank = static_cast<Index>(this->Segments.size());
      this->Pieces.push_back({ p, q, rank, 1, UnitsOf(this->At(p), this->At(q)) });
      this->SegmentLines.push_back(line);
      this->Segments.push_back({ p, q });
      hasSegment[p] = hasSegment[q] = 1;
    }
  });
  this->JoinEqualPieces(stages.Next());
  for (SegmentPiece& piece : this->Pieces)
  {
    piece.Count = 1; // equal segments of several lines count as one
  }
  for (std::size_t v = 0; v < hasSegment.size(); ++v)
  {
    if (!hasSegment[v])
    {
      // A line of one point: a piece of no length keeps its vertex in the grid, so that an input
      // point at the same place is found.
      this->Pieces.push_back({ static_cast<Index>(v), static_cast<Index>(v), None, 0 });
    }
  }
}

// The one of the lowest rank stays, as it comes first.
void SegmentNetwork::JoinEqualPieces(const Progress& progress)
{
  Stages stages(progress, { 90, 10 });
  Sort(
    this->Pieces.begin(), this->Pieces.end(),
    [](const SegmentPiece& p, const SegmentPiece& q) {
      return p.A != q.A ? p.A < q.A : (p.B != q.B ? p.B < q.B : p.Rank < q.Rank);
    },
    stages.Next());
  const Progress joining = stages.Next();
  std::size_t kept = 0, done = 0;
  for (const SegmentPiece& piece : Counted(this->Pieces))
  {
    ReportStep(joining, done++, this->Pieces.size());
    if (kept > 0 && this->Pieces[kept - 1].A == piece.A && this->Pieces[kept - 1].B == piece.B)
    {
      SegmentPiece& same = this->Pieces[kept - 1];
      // Where pieces run to and fro, each round may double it. Crossings are counted in the first
      // round, in which it is not above the number of segments.
      same.Count += std::min(piece.Count, std::numeric_limits<Index>::max() - same.Count);
      same.Unit = { std::max(same.Unit.X, piece.Unit.X), std::max(same.Unit.Y, piece.Unit.Y) };
    }
    else
    {
      this->Pieces[kept++] = piece;
    }
  }
  this->Pieces.resize(kept);
}

void SegmentNetwork::EnterInGrid(const Progress& progress)
{
  this->PieceEnds.resize(this->Pieces.size());
  for (std::size_t i = 0; i < this->Pieces.size(); ++i)
  {
    this->PieceEnds[i] = { this->At(this->Pieces[i].A), this->At(this->Pieces[i].B) };
  }
  this->Grid = GridOf(this->PieceEnds, progress);
}

} // namespace elevation
