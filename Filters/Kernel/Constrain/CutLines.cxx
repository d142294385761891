// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "CutLines.h"

#include "ConstraintCrossings.h"
#include "Kernel/Messages/Messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace elevation
{
namespace
{

// The passes: Collect() of SegmentNetwork; CutAtPoints(), then Settle() with its rounds; Match().
// Result() gives final ids.
class LineCutting : private SegmentNetwork
{
public:
  LineCutting(const PointView& points, const ConstraintLines& lines, DuplicatePolicy duplicates,
    const Progress& progress)
    : Points(points)
    , Lines(lines)
    , Duplicates(duplicates)
  {
    Stages stages(progress, { 10, 80, 10 });
    this->Collect(lines, stages.Next());
    if (!this->Pieces.empty())
    {
      this->Split(stages.Next());
      this->Match(stages.Next());
    }
  }

  /** The added points, and the pieces by final ids. */
  LinePieces Result(const Progress& progress) const
  {
    LinePieces result;
    result.AreNone = this->Vertices.empty();
    result.NumberOfCrossings = this->NumberOfCrossings;
    std::vector<AddedPoint>& added = result.Added;
    // In the order of vertices, crossings come after the vertices that they lie between, so these
    // have their ids and elevations by then.
    std::vector<Index> ids(this->Vertices.size());
    const auto elevationOf = [&](Index id) {
      return id < this->Points.Count ? this->Points.Elevation(id)
                                     : added[id - this->Points.Count].Elevation;
    };
    for (const std::size_t v : Counted(this->Vertices.size()))
    {
      ReportStep(progress, v, this->Vertices.size());
      const LineVertex& vertex = this->Vertices[v];
      if (vertex.Input != None)
      {
        ids[v] = vertex.Input;
        continue;
      }
      if (added.size() >= static_cast<std::size_t>(MaximumNumberOfPoints - this->Points.Count))
      {
        throw Error("With the points that lines add there are more than " +
          std::to_string(MaximumNumberOfPoints) + " points.");
      }
      ids[v] = this->Points.Count + static_cast<Index>(added.size());
      AddedPoint point{ vertex.Position, 0.0, vertex.Source, None, None, 0.0 };
      if (vertex.Source != None)
      {
        point.Elevation = this->Lines.Points.Elevation(vertex.Source);
      }
      else
      {
        point.From = ids[vertex.From];
        point.To = ids[vertex.To];
        point.Fraction = this->FractionOf(vertex);
        const double from = elevationOf(point.From), to = elevationOf(point.To);
        point.Elevation = from + point.Fraction * (to - from);
        // The difference of the elevations has overflowed.
        if (!std::isfinite(point.Elevation))
        {
          point.Elevation = (1.0 - point.Fraction) * from + point.Fraction * to;
        }
      }
      added.push_back(point);
    }
    for (const SegmentPiece& piece : this->Pieces)
    {
      if (piece.A != piece.B)
      {
        result.Pieces.push_back({ ids[piece.A], ids[piece.B] });
      }
    }
    return result;
  }

private:
  static constexpr std::size_t Everything = static_cast<std::size_t>(-1);

  /** Pass 2. */
  void Split(const Progress& progress)
  {
    Stages stages(progress, { 50, 40, 10 });
    // Exact cuts first: they move no piece, and input points on lines must not be missed because of
    // pieces that rounding has moved.
    this->CutAtPoints(stages.Next());
    // Up to here, pieces follow the lines exactly; the next steps move them by rounding.
    const std::vector<SegmentPiece> pieces = this->Pieces;
    const std::size_t count = this->Vertices.size();
    // Two units cover the rounding of an end and of a crossing. A reach of 0 is for lines no longer
    // than a few units: the doubles between them are finite in number, so that it ends. This
    // second try begins from the exact pieces again.
    if (this->Settle(2.0, true, stages.Next()))
    {
      return;
    }
    this->Pieces = pieces;
    this->Vertices.resize(count);
    if (!this->Settle(0.0, false, stages.Next()))
    {
      const Segment &one = this->Segments[this->Unsettled[0]],
                    &other = this->Segments[this->Unsettled[1]];
      const auto point = [this](Index vertex) { return this->Vertices[vertex].Source; };
      const auto cell = [this](Index rank) { return this->Lines.Cells[this->SegmentLines[rank]]; };
      throw MakeError<sentences::LinesNotSettled>(point(one.A), point(one.B), "constraints'",
        cell(this->Unsettled[0]), point(other.A), point(other.B), cell(this->Unsettled[1]));
    }
  }

  /**
   * Cuts until no pieces cross and none runs through a vertex.
   * @param reach  as of CutAtCrossings()
   * @return whether it succeeded
   */
  bool Settle(double reach, bool isToCount, const Progress& progress)
  {
    constexpr int mostRounds = 64; // two or three are usual
    bool haveCounted = !isToCount;
    // First vertices on pieces; crossings only where there are none. A crossing at a vertex is then
    // a common end.
    for (int round = 0; round < mostRounds; ++round)
    {
      // Each round gets half of the remaining progress.
      const Progress ofRound =
        progress.Between(1.0 - std::ldexp(1.0, -round), 1.0 - std::ldexp(1.0, -round - 1));
      Stages stages(ofRound, { 20, 20, 30, 20, 10 });
      this->EnterInGrid(stages.Next());
      std::vector<PieceCut> cuts;
      this->CutAtVertices(cuts, Everything, stages.Next());
      const Progress finding = stages.Next(), cutting = stages.Next();
      if (cuts.empty())
      {
        const std::vector<Crossing> crossings = FindCrossings(*this, finding);
        if (crossings.empty())
        {
          return true;
        }
        if (!haveCounted)
        {
          this->CountCrossings(crossings);
          haveCounted = true;
        }
        CutAtCrossings(*this, crossings, reach, cuts, cutting);
        // For the message, if this round does not help either.
        const auto [p, q] = crossings[0];
        this->Unsettled = { this->Pieces[p].Rank, this->Pieces[q].Rank };
      }
      this->Apply(cuts, stages.Next());
    }
    return false;
  }

  /** Cuts at vertices and input points that lie exactly on the lines. */
  void CutAtPoints(const Progress& progress)
  {
    Stages stages(progress, { 20, 10, 15, 45, 4, 6 });
    this->EnterInGrid(stages.Next());
    std::vector<PieceCut> cuts;
    std::vector<Passage> passages;
    // With so many, lines overlap or run along each other.
    const std::size_t many = 64 * (this->Vertices.size() + this->Pieces.size());
    const bool areAllFound = this->CutAtVertices(cuts, many, stages.Next());
    Stages again(stages.Next(), { 33, 33, 34 });
    if (!areAllFound)
    {
      std::vector<Point2> places(this->Vertices.size());
      // Long overlaps have many vertices on many pieces: joined first, each stretch is one piece.
      for (std::size_t v = 0; v < places.size(); ++v)
      {
        places[v] = this->Vertices[v].Position;
      }
      passages = JoinOverlaps(this->Pieces, places, again.Next());
      this->EnterInGrid(again.Next());
      cuts.clear();
      this->CutAtVertices(cuts, Everything, again.Next());
    }
    // A pass over all points, so it comes once; input points enter as vertices, and later rounds
    // know them.
    this->CutAtInputPoints(cuts, stages.Next());
    for (const PieceCut& cut : cuts)
    {
      const SegmentPiece& piece = this->Pieces[cut.Piece];
      passages.push_back({ cut.Vertex, piece.B, piece.Count });
    }
    this->CountCrossingsAtVertices(passages, stages.Next());
    this->Apply(cuts, stages.Next());
  }

  /**
   * Finds the input points that are vertices of the lines. Those on segments become vertices, where
   * the segments are cut.
   */
  void CutAtInputPoints(std::vector<PieceCut>& cuts, const Progress& progress)
  {
    Stages stages(progress, { 80, 20 });
    std::vector<PieceCut> found; // with input points for vertices
    ForEachNumber(this->Points.Count, stages.Next(), [&](Index id) {
      const Point2 p = this->Points.At(id);
      std::size_t cell;
      // Most points are in no cell with a piece.
      if (!this->Grid.FindCell(p, cell) || !std::isfinite(this->Points.Elevation(id)))
      {
        return;
      }
      const std::size_t before = found.size();
      for (const Index* i = this->Grid.Begin(cell); i < this->Grid.End(cell); ++i)
      {
        const Ends& ends = this->PieceEnds[*i];
        const Index vertex = ends[0] == p ? this->Pieces[*i].A
          : ends[1] == p                  ? this->Pieces[*i].B
                                          : None;
        if (vertex != None)
        {
          this->SetInput(vertex, id);
          found.resize(before); // there is a vertex already
          break;
        }
        if (IsInside(ends, p))
        {
          found.push_back({ *i, id });
        }
      }
    });
    // By position, so that input points with the same x,y become one vertex.
    Sort(
      found.begin(), found.end(),
      [&](const PieceCut& p, const PieceCut& q) {
        const Point2 at = this->Points.At(p.Vertex), other = this->Points.At(q.Vertex);
        return at != other ? IsLower(at, other) : p.Piece < q.Piece;
      },
      stages.Next());
    const std::size_t first = this->Vertices.size(), firstCut = cuts.size();
    for (const PieceCut& cut : found)
    {
      const Point2 p = this->Points.At(cut.Vertex);
      if (this->Vertices.size() == first || this->Vertices.back().Position != p)
      {
        this->AddVertex(p);
      }
      const Index vertex = static_cast<Index>(this->Vertices.size()) - 1;
      this->SetInput(vertex, cut.Vertex);
      // Duplicates cut only once.
      if (cuts.size() == firstCut || cuts.back().Vertex != vertex || cuts.back().Piece != cut.Piece)
      {
        cuts.push_back({ cut.Piece, vertex });
      }
    }
  }

  /** Enters an input point at a vertex; of several, the one that the policy prefers. */
  void SetInput(Index vertex, Index id)
  {
    Index& input = this->Vertices[vertex].Input;
    if (input == None || IsPreferred(this->Points, this->Duplicates, id, input))
    {
      input = id;
    }
  }

  /**
   * Cuts pieces at the vertices on them.
   * @return false if there is more than most to look at; the cuts are then incomplete
   */
  bool CutAtVertices(std::vector<PieceCut>& cuts, std::size_t most, const Progress& progress)
  {
    WorkReporter work(progress);
    for (std::size_t v = 0; v < this->Vertices.size() && work.Count() <= most; ++v)
    {
      work.Step(v, this->Vertices.size());
      const Point2& p = this->Vertices[v].Position;
      this->Grid.Visit(p, [&](Index piece) {
        work.Tick();
        if (IsInside(this->PieceEnds[piece], p))
        {
          cuts.push_back({ piece, static_cast<Index>(v) });
        }
      });
    }
    return work.Count() <= most;
  }

  /**
   * Counts the pairs of segments that cross at a vertex: both run through it, not on one line.
   * Around one vertex, each segment crosses all that are not on its line; sorted by direction,
   * those on one line are adjacent.
   */
  void CountCrossingsAtVertices(std::vector<Passage>& passages, const Progress& progress)
  {
    Stages stages(progress, { 80, 20 });
    Sort(
      passages.begin(), passages.end(),
      [&](const Passage& p, const Passage& q) {
        // Around a vertex, by their direction upwards: these span half a turn.
        return p.Vertex != q.Vertex
          ? p.Vertex < q.Vertex
          : Orientation(this->At(p.Vertex), this->At(p.Toward), this->At(q.Toward)) == Positive;
      },
      stages.Next());
    const Progress counting = stages.Next();
    std::int64_t around = 0, alike = 0; // earlier segments at this vertex; in this direction
    for (const std::size_t i : Counted(std::size_t(1), passages.size()))
    {
      ReportStep(counting, i, passages.size());
      const Passage &before = passages[i - 1], &passage = passages[i];
      const bool isSameVertex = passage.Vertex == before.Vertex;
      const bool isSameLine = isSameVertex &&
        Orientation(this->At(passage.Vertex), this->At(before.Toward), this->At(passage.Toward)) ==
          Zero;
      around = isSameVertex ? around + before.Count : 0;
      alike = isSameLine ? alike + before.Count : 0;
      this->NumberOfCrossings += passage.Count * (around - alike);
    }
  }

  /** Crossings of pieces: each of the segments in one with each in the other. */
  void CountCrossings(const std::vector<Crossing>& crossings)
  {
    for (const auto& [p, q] : Counted(crossings))
    {
      this->NumberOfCrossings += std::int64_t(this->Pieces[p].Count) * this->Pieces[q].Count;
    }
  }

  /** Replaces pieces by their parts from cut to cut. */
  void Apply(std::vector<PieceCut>& cuts, const Progress& progress)
  {
    Stages stages(progress, { 50, 20, 30 });
    SortAlong(
      cuts, [&](Index piece) -> const Ends& { return this->PieceEnds[piece]; },
      [&](Index vertex) { return this->At(vertex); }, stages.Next());
    std::vector<SegmentPiece> pieces;
    WorkReporter work(stages.Next());
    auto cut = cuts.begin();
    for (std::size_t i = 0; i < this->Pieces.size(); ++i)
    {
      work.Step(i, this->Pieces.size());
      // Each part keeps the rank, count and units of the whole.
      SegmentPiece piece = this->Pieces[i];
      Index from = piece.A;
      const Index end = piece.B;
      const auto append = [&](Index to) {
        if (from != to)
        {
          const bool isUp = IsLower(this->At(from), this->At(to));
          piece.A = isUp ? from : to;
          piece.B = isUp ? to : from;
          pieces.push_back(piece);
          from = to;
        }
      };
      for (; cut != cuts.end() && cut->Piece == static_cast<Index>(i); ++cut)
      {
        work.Tick();
        append(cut->Vertex);
      }
      // A point that no segment ends in: it has no parts.
      if (piece.Rank == None)
      {
        pieces.push_back(piece);
      }
      append(end);
    }
    this->Pieces = std::move(pieces);
    // Bent pieces may have become equal.
    this->JoinEqualPieces(stages.Next());
  }

  /** Pass 3: the input points at crossings. All others have been found when cutting. */
  void Match(const Progress& progress)
  {
    Stages stages(progress, { 10, 90 });
    // Few, compared with points: they are in the grid, and one pass looks up all points.
    std::vector<Index> crossings;
    for (std::size_t v = 0; v < this->Vertices.size(); ++v)
    {
      if (this->Vertices[v].From != None)
      {
        crossings.push_back(static_cast<Index>(v));
      }
    }
    if (crossings.empty())
    {
      return;
    }
    const CellGrid grid(
      crossings.size(),
      [&](std::size_t i) { return std::array<Point2, 1>{ { this->At(crossings[i]) } }; },
      stages.Next());
    ForEachNumber(this->Points.Count, stages.Next(), [&](Index id) {
      const Point2 p = this->Points.At(id);
      grid.Visit(p, [&](Index i) {
        if (this->At(crossings[i]) == p && std::isfinite(this->Points.Elevation(id)))
        {
          this->SetInput(crossings[i], id);
        }
      });
    });
  }

  /** The fraction of the distance from From to To, by the longer of x and y. */
  double FractionOf(const LineVertex& vertex) const
  {
    const Point2 &p = vertex.Position, &a = this->At(vertex.From), &b = this->At(vertex.To);
    const double largest =
      std::max({ std::fabs(a.X), std::fabs(a.Y), std::fabs(b.X), std::fabs(b.Y) });
    // Scaled by 1/4, so that no difference overflows; or up, so that none underflows.
    const double scale = largest < 1e-150 ? 0x1p600 : 0.25;
    const double dx = scale * b.X - scale * a.X, dy = scale * b.Y - scale * a.Y;
    return std::fabs(dx) > std::fabs(dy) ? (scale * p.X - scale * a.X) / dx
                                         : (scale * p.Y - scale * a.Y) / dy;
  }

  const PointView& Points;
  const ConstraintLines& Lines;
  const DuplicatePolicy Duplicates;
  std::int64_t NumberOfCrossings = 0;
  std::array<Index, 2> Unsettled{ { None, None } }; ///< two segments that still cross
};
} // namespace

LinePieces CutLines(const PointView& points, const ConstraintLines& lines,
  DuplicatePolicy duplicates, const Progress& progress)
{
  Stages stages(progress, { 90, 10 });
  const LineCutting cutting(points, lines, duplicates, stages.Next());
  return cutting.Result(stages.Next());
}

} // namespace elevation
