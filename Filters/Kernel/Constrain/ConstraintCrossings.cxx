// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ConstraintCrossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <unordered_map>

namespace elevation
{
namespace
{

/**
 * Finds the cuts of one round: for each crossing an end in reach, a vertex near it, or a new one.
 * Crossings are taken by position, so that the result does not depend on the order of pieces.
 */
class CrossingCuts
{
public:
  CrossingCuts(SegmentNetwork& network, double reach, std::vector<PieceCut>& cuts)
    : Network(network)
    , Reach(reach)
    , Cuts(cuts)
  {
  }

  void Run(const std::vector<Crossing>& crossings, const Progress& progress)
  {
    Stages stages(progress, { 50, 20, 30 });
    const Progress placing = stages.Next();
    // First all crossings with an end in reach, which need no point of their own; the others are
    // sorted by position.
    std::vector<CrossingPoint> points;
    for (const std::size_t i : Counted(crossings.size()))
    {
      ReportStep(placing, i, crossings.size(), 1024);
      // An end so near the other piece would leave a stub of some units: the other is bent to it.
      if (!this->CutAtEnds(crossings[i]))
      {
        const Ends &s = this->Network.PieceEnds[crossings[i].first],
                   &t = this->Network.PieceEnds[crossings[i].second];
        points.push_back({ RoundedCrossing(s[0], s[1], t[0], t[1]), crossings[i], None });
      }
    }
    Sort(
      points.begin(), points.end(),
      [](
        const CrossingPoint& p, const CrossingPoint& q) { return IsLower(p.Position, q.Position); },
      stages.Next());

    const Progress naming = stages.Next();
    StepCount steps;
    // Crossings that round to one place are cut at one vertex.
    for (std::size_t i = 0, end = 0; i < points.size(); i = end)
    {
      steps.Add();
      ReportStep(naming, i, points.size());
      for (; end < points.size() && points[end].Position == points[i].Position; ++end)
      {
        points[end].Vertex = this->FindVertexInReach(points[i].Position, points[end].Pieces);
      }
      this->CutAtPoint(&points[i], &points[0] + end);
    }
  }

private:
  /** Where two pieces cross, and the vertex at which they are cut. */
  struct CrossingPoint
  {
    Point2 Position;
    Crossing Pieces;
    Index Vertex;
  };

  // Between the ends along the longer axis: the bent piece then does not turn back.
  bool CanPassThrough(const SegmentPiece& piece, Index vertex) const
  {
    return piece.A == vertex || piece.B == vertex ||
      IsBetween(this->Network.At(piece.A), this->Network.At(piece.B), this->Network.At(vertex));
  }

  /** Cuts at ends of either piece in reach of the other one. @return whether there are any */
  bool CutAtEnds(const Crossing& crossing)
  {
    const std::size_t before = this->Cuts.size();
    for (const auto& [piece, other] : { crossing, Crossing(crossing.second, crossing.first) })
    {
      // The piece whose own units say how far rounding moves it is the one to be bent.
      const SegmentPiece& to = this->Network.Pieces[other];
      VisitEndsInReach(this->Network.PieceEnds[other], this->Network.PieceEnds[piece],
        this->Network.Pieces[piece].Unit, this->Reach, [this, &to, bent = piece](int end) {
          this->Cuts.push_back({ bent, end == 0 ? to.A : to.B });
        });
    }
    return this->Cuts.size() > before;
  }

  /** Cuts pieces that cross at one place: at a vertex in reach, otherwise at a new one. */
  void CutAtPoint(const CrossingPoint* begin, const CrossingPoint* end)
  {
    Index vertex = None, first = None; // the new vertex, and the first piece through it
    for (const CrossingPoint* point = begin; point < end; ++point)
    {
      if (point->Vertex == None && vertex == None)
      {
        vertex = this->Network.AddVertex(point->Position);
        std::size_t cell = 0;
        // Succeeds: it is in the box of two pieces.
        this->Network.Grid.FindCell(point->Position, cell);
        this->NewVertices[cell].push_back(vertex);
      }
      for (const Index piece : { point->Pieces.first, point->Pieces.second })
      {
        this->Cuts.push_back({ piece, point->Vertex == None ? vertex : point->Vertex });
        // The first segment in the order of lines: it gives the crossing its elevation.
        if (point->Vertex == None &&
          (first == None || this->Network.Pieces[piece].Rank < this->Network.Pieces[first].Rank))
        {
          first = piece;
        }
      }
    }
    if (vertex != None)
    {
      this->Network.Vertices[vertex].From = this->Network.Pieces[first].A;
      this->Network.Vertices[vertex].To = this->Network.Pieces[first].B;
    }
  }

  /** The nearest vertex in reach of a crossing that both pieces can pass through, or None. */
  Index FindVertexInReach(const Point2& p, const Crossing& crossing) const
  {
    const SegmentPiece& one = this->Network.Pieces[crossing.first];
    const SegmentPiece& other = this->Network.Pieces[crossing.second];
    const double unitX = std::max(one.Unit.X, other.Unit.X);
    const double unitY = std::max(one.Unit.Y, other.Unit.Y);
    const double reach = 2.0 * this->Reach, reachX = reach * unitX, reachY = reach * unitY;
    Index nearest = None;
    double shortest = 0.0;
    // Units are 0 for short segments: then only the very place is near.
    const auto inUnits = [](double difference, double unit) {
      return difference == 0.0 ? 0.0 : unit > 0.0 ? std::fabs(difference) / unit : HUGE_VAL;
    };
    const auto look = [&](Index v) {
      const Point2& q = this->Network.At(v);
      const double distance = std::max(inUnits(q.X - p.X, unitX), inUnits(q.Y - p.Y, unitY));
      if (distance <= reach &&
        (q == p || (this->CanPassThrough(one, v) && this->CanPassThrough(other, v))) &&
        (nearest == None || distance < shortest ||
          (distance == shortest && IsLower(q, this->Network.At(nearest)))))
      {
        nearest = v;
        shortest = distance;
      }
    };
    // All around the crossing.
    const Point2 low{ p.X - reachX, p.Y - reachY }, high{ p.X + reachX, p.Y + reachY };
    const std::array<Point2, 4> around{ { low, { high.X, low.Y }, high, { low.X, high.Y } } };
    const CellGrid& grid = this->Network.Grid;
    grid.ForEachCell(around, [&](std::size_t cell) {
      for (const Index* i = grid.Begin(cell); i < grid.End(cell); ++i)
      {
        look(this->Network.Pieces[*i].A);
        look(this->Network.Pieces[*i].B);
      }
      // New vertices of this round are in no piece yet. They come by increasing y, so the last
      // ones are the near ones.
      const auto found = this->NewVertices.find(cell);
      for (std::size_t k = found == this->NewVertices.end() ? 0 : found->second.size();
           k > 0 && this->Network.At(found->second[k - 1]).Y >= p.Y - reachY; --k)
      {
        look(found->second[k - 1]);
      }
    });
    return nearest;
  }

  SegmentNetwork& Network;
  const double Reach;
  std::vector<PieceCut>& Cuts;
  /** By cells of the grid, from the lowest up. */
  std::unordered_map<std::size_t, std::vector<Index>> NewVertices;
};
} // namespace

std::vector<Crossing> FindCrossings(const SegmentNetwork& network, const Progress& progress)
{
  Stages stages(progress, { 80, 20 });
  std::vector<Crossing> crossings;
  VisitCrossings(network.PieceEnds, network.Grid, stages.Next(), [&](std::size_t i, std::size_t j) {
    crossings.push_back({ static_cast<Index>(i), static_cast<Index>(j) });
  });
  // A pair may be found in every cell that both are in.
  Sort(crossings.begin(), crossings.end(), std::less<Crossing>(), stages.Next());
  crossings.erase(std::unique(crossings.begin(), crossings.end()), crossings.end());
  return crossings;
}

void CutAtCrossings(SegmentNetwork& network, const std::vector<Crossing>& crossings, double reach,
  std::vector<PieceCut>& cuts, const Progress& progress)
{
  CrossingCuts(network, reach, cuts).Run(crossings, progress);
}

} // namespace elevation
