// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Constrain.h"

#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"
#include "Kernel/Simplify/Simplify.h"
#include "Kernel/Triangulate/Triangulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <unordered_map>
#include <utility>

namespace elevation
{
namespace
{

/** A vertex of the lines. */
struct Vertex
{
  Point2 Position;
  Index Input;  ///< the input point at the same place
  Index Source; ///< the lines' point at the same place
  Index From;   ///< a crossing: it lies between these vertices
  Index To;
};

/** Two pieces that cross, in increasing order. */
using Crossing = std::pair<Index, Index>;

/** The id of vertex k of the lines, checked. */
Index PointOfLine(const ConstraintLines& lines, Index line, Index k)
{
  const PointView& points = lines.Points;
  const Index id = lines.Vertices[k];
  const bool exists = id >= 0 && id < points.Count;
  if (!exists || !std::isfinite(points.At(id).X) || !std::isfinite(points.At(id).Y) ||
    !std::isfinite(points.Elevation(id)))
  {
    const Index cell = lines.Cells[line];
    throw exists ? MakeError<sentences::NonFinitePointOfLine>(id, "constraints'", cell)
                 : MakeError<sentences::NoSuchPointOfLine>(id, "constraints'", cell);
  }
  return id;
}

/** Passes 1 to 3: from lines to pieces that do not cross, and the points that they add. */
class Splitting
{
public:
  Splitting(const PointView& points, const ConstraintLines& lines, DuplicatePolicy duplicates,
    const Progress& progress)
    : Points(points)
    , Lines(lines)
    , Duplicates(duplicates)
  {
    this->Collect(SubProgress(progress, 0.0, 0.1));
    if (!this->Pieces.empty())
    {
      this->Split(SubProgress(progress, 0.1, 0.9));
      this->Match(SubProgress(progress, 0.9, 1.0));
    }
  }

  bool IsEmpty() const { return this->Vertices.empty(); }
  std::int64_t NumberOfCrossings() const { return this->Crossings; }

  /** The added points, and the pieces by final ids. */
  void GetResult(
    std::vector<AddedPoint>& added, std::vector<Segment>& pieces, const Progress& progress) const
  {
    std::vector<Index> ids(this->Vertices.size());
    const auto elevationOf = [&](Index id) {
      return id < this->Points.Count ? this->Points.Elevation(id)
                                     : added[id - this->Points.Count].Elevation;
    };
    for (const std::size_t v : Counted(this->Vertices.size()))
    {
      ReportStep(progress, v, this->Vertices.size());
      const Vertex& vertex = this->Vertices[v];
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
        pieces.push_back({ ids[piece.A], ids[piece.B] });
      }
    }
  }

private:
  static constexpr std::size_t Everything = static_cast<std::size_t>(-1);

  const Point2& At(Index vertex) const { return this->Vertices[vertex].Position; }

  /** Enters the current pieces in a grid. */
  void EnterInGrid(const Progress& progress)
  {
    this->PieceEnds.resize(this->Pieces.size());
    for (std::size_t i = 0; i < this->Pieces.size(); ++i)
    {
      this->PieceEnds[i] = { this->At(this->Pieces[i].A), this->At(this->Pieces[i].B) };
    }
    this->Grid = GridOf(this->PieceEnds, progress);
  }

  /** Pass 1. */
  void Collect(const Progress& progress)
  {
    const std::vector<Index> vertexOf = this->CollectPoints(SubProgress(progress, 0.0, 0.5));
    std::vector<char> hasSegment(this->Vertices.size(), 0);
    for (Index line = 0; line < this->Lines.Count(); ++line)
    {
      const Index begin = this->Lines.Offsets[line], end = this->Lines.Offsets[line + 1];
      for (Index k = begin; k < end; ++k)
      {
        const Index next = k + 1 < end ? k + 1 : (this->Lines.IsClosed[line] ? begin : k);
        Index p = vertexOf[this->Lines.Vertices[k]], q = vertexOf[this->Lines.Vertices[next]];
        if (p != q)
        {
          if (IsLower(this->At(q), this->At(p)))
          {
            std::swap(p, q);
          }
          const Index rank = static_cast<Index>(this->Segments.size());
          this->Pieces.push_back({ p, q, rank, 1, UnitsOf(this->At(p), this->At(q)) });
          this->SegmentLines.push_back(line);
          this->Segments.push_back({ p, q });
          hasSegment[p] = hasSegment[q] = 1;
        }
      }
    }
    this->JoinEqualPieces(SubProgress(progress, 0.6, 1.0));
    for (SegmentPiece& piece : this->Pieces)
    {
      piece.Count = 1; // equal segments of several lines count as one
    }
    for (std::size_t v = 0; v < hasSegment.size(); ++v)
    {
      if (!hasSegment[v])
      {
        this->Pieces.push_back({ static_cast<Index>(v), static_cast<Index>(v), None, 0 });
      }
    }
  }

  /** Makes one vertex of each place of the lines' points. @return the vertex of each point */
  std::vector<Index> CollectPoints(const Progress& progress)
  {
    const PointView& own = this->Lines.Points;
    std::vector<Index> used;
    for (Index line = 0; line < this->Lines.Count(); ++line)
    {
      for (const Index k : Counted(this->Lines.Offsets[line], this->Lines.Offsets[line + 1]))
      {
        ReportStep(progress, k, 2 * this->Lines.Vertices.size());
        used.push_back(PointOfLine(this->Lines, line, k));
      }
    }
    // By position, so that equal points are adjacent; the lowest id is the source of the vertex.
    Sort(
      used.begin(), used.end(),
      [&](Index p, Index q) {
        const Point2 at = own.At(p), other = own.At(q);
        return at != other ? IsLower(at, other) : p < q;
      },
      SubProgress(progress, 0.5, 1.0));
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
        vertexOf[id] = static_cast<Index>(this->Vertices.size());
        this->Vertices.push_back({ own.At(id), None, id, None, None });
      }
      else if (vertexOf[id] != None)
      {
        vertexOf[id] = vertexOf[vertexOf[id]];
      }
    }
    return vertexOf;
  }

  void JoinEqualPieces(const Progress& progress)
  {
    Sort(
      this->Pieces.begin(), this->Pieces.end(),
      [](const SegmentPiece& p, const SegmentPiece& q) {
        return p.A != q.A ? p.A < q.A : (p.B != q.B ? p.B < q.B : p.Rank < q.Rank);
      },
      SubProgress(progress, 0.0, 0.9));
    const Progress joining = SubProgress(progress, 0.9, 1.0);
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

  /** Pass 2. */
  void Split(const Progress& progress)
  {
    this->CutAtPoints(SubProgress(progress, 0.0, 0.5));
    // Up to here, pieces follow the lines exactly; the next steps move them by rounding.
    const std::vector<SegmentPiece> pieces = this->Pieces;
    const std::size_t count = this->Vertices.size();
    // Two units cover the rounding of an end and of a crossing. A reach of 0 is for lines no longer
    // than a few units: the doubles between them are finite in number, so that it ends.
    if (this->Settle(2.0, true, SubProgress(progress, 0.5, 0.9)))
    {
      return;
    }
    this->Pieces = pieces;
    this->Vertices.resize(count);
    if (!this->Settle(0.0, false, SubProgress(progress, 0.9, 1.0)))
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
   * @param reach  in units in the last place. Two pieces that cross are cut at an end of one within
   *               this reach of the other, or at a vertex within twice the reach of the crossing;
   *               otherwise at a new vertex.
   * @return whether it succeeded
   */
  bool Settle(double reach, bool isToCount, const Progress& progress)
  {
    constexpr int mostRounds = 64; // two or three are usual
    this->Reach = reach;
    bool haveCounted = !isToCount;
    for (int round = 0; round < mostRounds; ++round)
    {
      // Each round gets half of the remaining progress.
      const Progress ofRound =
        SubProgress(progress, 1.0 - std::ldexp(1.0, -round), 1.0 - std::ldexp(1.0, -round - 1));
      this->EnterInGrid(SubProgress(ofRound, 0.0, 0.2));
      std::vector<PieceCut> cuts;
      this->CutAtVertices(cuts, Everything, SubProgress(ofRound, 0.2, 0.4));
      std::vector<Crossing> crossings;
      if (cuts.empty())
      {
        this->FindCrossings(crossings, SubProgress(ofRound, 0.4, 0.7));
        if (crossings.empty())
        {
          return true;
        }
        this->CutAtCrossings(crossings, !haveCounted, cuts, SubProgress(ofRound, 0.7, 0.9));
        haveCounted = true;
        const auto [p, q] = crossings[0];
        this->Unsettled = { this->Pieces[p].Rank, this->Pieces[q].Rank };
      }
      this->Apply(cuts, SubProgress(ofRound, 0.9, 1.0));
    }
    return false;
  }

  /** Cuts at vertices and input points that lie exactly on the lines. */
  void CutAtPoints(const Progress& progress)
  {
    this->EnterInGrid(SubProgress(progress, 0.0, 0.2));
    std::vector<PieceCut> cuts;
    std::vector<Passage> passages;
    // With so many, lines overlap or run along each other.
    const std::size_t many = 64 * (this->Vertices.size() + this->Pieces.size());
    if (!this->CutAtVertices(cuts, many, SubProgress(progress, 0.2, 0.3)))
    {
      std::vector<Point2> places(this->Vertices.size());
      for (std::size_t v = 0; v < places.size(); ++v)
      {
        places[v] = this->Vertices[v].Position;
      }
      passages = JoinOverlaps(this->Pieces, places, SubProgress(progress, 0.3, 0.35));
      this->EnterInGrid(SubProgress(progress, 0.35, 0.4));
      cuts.clear();
      this->CutAtVertices(cuts, Everything, SubProgress(progress, 0.4, 0.45));
    }
    this->CutAtInputPoints(cuts, SubProgress(progress, 0.45, 0.9));
    for (const PieceCut& cut : cuts)
    {
      const SegmentPiece& piece = this->Pieces[cut.Piece];
      passages.push_back({ cut.Vertex, piece.B, piece.Count });
    }
    this->CountCrossingsAtVertices(passages, SubProgress(progress, 0.9, 0.94));
    this->Apply(cuts, SubProgress(progress, 0.94, 1.0));
  }

  /**
   * Finds the input points that are vertices of the lines. Those on segments become vertices, where
   * the segments are cut.
   */
  void CutAtInputPoints(std::vector<PieceCut>& cuts, const Progress& progress)
  {
    std::vector<PieceCut> found; // with input points for vertices
    ForEachStretch(
      this->Points.Count, SubProgress(progress, 0.0, 0.8), [&](Index begin, Index end) {
        for (Index id = begin; id < end; ++id)
        {
          const Point2 p = this->Points.At(id);
          std::size_t cell;
          if (!this->Grid.FindCell(p, cell) || !std::isfinite(this->Points.Elevation(id)))
          {
            continue;
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
        }
      });
    Sort(
      found.begin(), found.end(),
      [&](const PieceCut& p, const PieceCut& q) {
        const Point2 at = this->Points.At(p.Vertex), other = this->Points.At(q.Vertex);
        return at != other ? IsLower(at, other) : p.Piece < q.Piece;
      },
      SubProgress(progress, 0.8, 1.0));
    const std::size_t first = this->Vertices.size(), firstCut = cuts.size();
    for (const PieceCut& cut : found)
    {
      const Point2 p = this->Points.At(cut.Vertex);
      if (this->Vertices.size() == first || this->Vertices.back().Position != p)
      {
        this->Vertices.push_back({ p, None, None, None, None });
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

  /** Counts the pairs of segments that cross at a vertex: both run through it, not on one line. */
  void CountCrossingsAtVertices(std::vector<Passage>& passages, const Progress& progress)
  {
    Sort(
      passages.begin(), passages.end(),
      [&](const Passage& p, const Passage& q) {
        // Around a vertex, by their direction upwards: these span half a turn.
        return p.Vertex != q.Vertex
          ? p.Vertex < q.Vertex
          : Orientation(this->At(p.Vertex), this->At(p.Toward), this->At(q.Toward)) == Positive;
      },
      SubProgress(progress, 0.0, 0.8));
    const Progress counting = SubProgress(progress, 0.8, 1.0);
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
      this->Crossings += passage.Count * (around - alike);
    }
  }

  void FindCrossings(std::vector<Crossing>& crossings, const Progress& progress) const
  {
    VisitCrossings(this->PieceEnds, this->Grid, SubProgress(progress, 0.0, 0.8),
      [&](std::size_t i, std::size_t j) {
        crossings.push_back({ static_cast<Index>(i), static_cast<Index>(j) });
      });
    // A pair may be found in every cell that both are in.
    Sort(
      crossings.begin(), crossings.end(), std::less<Crossing>(), SubProgress(progress, 0.8, 1.0));
    crossings.erase(std::unique(crossings.begin(), crossings.end()), crossings.end());
  }

  bool CanPassThrough(const SegmentPiece& piece, Index vertex) const
  {
    return piece.A == vertex || piece.B == vertex ||
      IsBetween(this->At(piece.A), this->At(piece.B), this->At(vertex));
  }

  /** Cuts at ends of either piece in reach of the other one. @return whether there are any */
  bool CutAtEnds(const Crossing& crossing, std::vector<PieceCut>& cuts) const
  {
    const std::size_t before = cuts.size();
    for (const auto& [piece, other] : { crossing, Crossing(crossing.second, crossing.first) })
    {
      VisitEndsInReach(this->PieceEnds[other], this->PieceEnds[piece], this->Pieces[piece].Unit,
        this->Reach, [&, bent = piece, to = other](int end) {
          cuts.push_back({ bent, end == 0 ? this->Pieces[to].A : this->Pieces[to].B });
        });
    }
    return cuts.size() > before;
  }

  /** Where two pieces cross, and the vertex at which they are cut. */
  struct Place
  {
    Point2 Position;
    Crossing Of;
    Index Vertex;
  };
  /** The vertices added in a round, by cells of the grid, from the lowest up. */
  using NewVertices = std::unordered_map<std::size_t, std::vector<Index>>;

  void CutAtCrossings(const std::vector<Crossing>& crossings, bool areToCount,
    std::vector<PieceCut>& cuts, const Progress& progress)
  {
    std::vector<Place> places;
    for (const std::size_t i : Counted(crossings.size()))
    {
      ReportStep(progress, i, 2 * crossings.size(), 1024);
      const auto [p, q] = crossings[i];
      const std::int64_t segments = this->Pieces[p].Count;
      this->Crossings += areToCount ? segments * this->Pieces[q].Count : 0;
      if (!this->CutAtEnds(crossings[i], cuts))
      {
        const Ends &s = this->PieceEnds[p], &t = this->PieceEnds[q];
        places.push_back({ RoundedCrossing(s[0], s[1], t[0], t[1]), crossings[i], None });
      }
    }
    Sort(
      places.begin(), places.end(),
      [](const Place& p, const Place& q) { return IsLower(p.Position, q.Position); },
      SubProgress(progress, 0.5, 0.7));

    NewVertices added;
    const Progress naming = SubProgress(progress, 0.7, 1.0);
    StepCount steps;
    for (std::size_t i = 0, end = 0; i < places.size(); i = end)
    {
      steps.Add();
      ReportStep(naming, i, places.size());
      for (; end < places.size() && places[end].Position == places[i].Position; ++end)
      {
        places[end].Vertex = this->FindVertexInReach(added, places[i].Position, places[end].Of);
      }
      this->CutAtPlace(&places[i], &places[0] + end, added, cuts);
    }
  }

  /** Cuts pieces that cross at one place: at a vertex in reach, otherwise at a new one. */
  void CutAtPlace(
    const Place* begin, const Place* end, NewVertices& added, std::vector<PieceCut>& cuts)
  {
    Index vertex = None, first = None; // the new vertex, and the first piece through it
    for (const Place* place = begin; place < end; ++place)
    {
      if (place->Vertex == None && vertex == None)
      {
        vertex = static_cast<Index>(this->Vertices.size());
        this->Vertices.push_back({ place->Position, None, None, None, None });
        std::size_t cell = 0;
        this->Grid.FindCell(place->Position, cell); // succeeds: it is in the box of two pieces
        added[cell].push_back(vertex);
      }
      for (const Index piece : { place->Of.first, place->Of.second })
      {
        cuts.push_back({ piece, place->Vertex == None ? vertex : place->Vertex });
        if (place->Vertex == None &&
          (first == None || this->Pieces[piece].Rank < this->Pieces[first].Rank))
        {
          first = piece;
        }
      }
    }
    if (vertex != None)
    {
      this->Vertices[vertex].From = this->Pieces[first].A;
      this->Vertices[vertex].To = this->Pieces[first].B;
    }
  }

  /** The nearest vertex in reach of a crossing that both pieces can pass through, or None. */
  Index FindVertexInReach(const NewVertices& added, const Point2& p, const Crossing& crossing) const
  {
    const SegmentPiece& one = this->Pieces[crossing.first];
    const SegmentPiece& other = this->Pieces[crossing.second];
    const double unitX = std::max(one.Unit.X, other.Unit.X);
    const double unitY = std::max(one.Unit.Y, other.Unit.Y);
    const double reach = 2.0 * this->Reach, reachX = reach * unitX, reachY = reach * unitY;
    Index nearest = None;
    double shortest = 0.0;
    const auto inUnits = [](double difference, double unit) {
      return difference == 0.0 ? 0.0 : unit > 0.0 ? std::fabs(difference) / unit : HUGE_VAL;
    };
    const auto look = [&](Index v) {
      const double distance =
        std::max(inUnits(this->At(v).X - p.X, unitX), inUnits(this->At(v).Y - p.Y, unitY));
      if (distance <= reach &&
        (this->At(v) == p || (this->CanPassThrough(one, v) && this->CanPassThrough(other, v))) &&
        (nearest == None || distance < shortest ||
          (distance == shortest && IsLower(this->At(v), this->At(nearest)))))
      {
        nearest = v;
        shortest = distance;
      }
    };
    std::size_t last = static_cast<std::size_t>(-1);
    for (const double y : { -reachY, reachY })
    {
      for (const double x : { -reachX, reachX })
      {
        std::size_t cell;
        if (!this->Grid.FindCell(Point2{ p.X + x, p.Y + y }, cell) || cell == last)
        {
          continue;
        }
        last = cell;
        for (const Index* i = this->Grid.Begin(cell); i < this->Grid.End(cell); ++i)
        {
          look(this->Pieces[*i].A);
          look(this->Pieces[*i].B);
        }
        const auto found = added.find(cell);
        for (std::size_t k = found == added.end() ? 0 : found->second.size();
             k > 0 && this->At(found->second[k - 1]).Y >= p.Y - reachY; --k)
        {
          look(found->second[k - 1]);
        }
      }
    }
    return nearest;
  }

  /** Replaces pieces by their parts from cut to cut. */
  void Apply(std::vector<PieceCut>& cuts, const Progress& progress)
  {
    SortAlong(
      cuts, [&](Index piece) -> const Ends& { return this->PieceEnds[piece]; },
      [&](Index vertex) { return this->At(vertex); }, SubProgress(progress, 0.0, 0.5));
    std::vector<SegmentPiece> pieces;
    const Progress cutting = SubProgress(progress, 0.5, 0.7);
    WorkReporter work(cutting);
    auto cut = cuts.begin();
    for (std::size_t i = 0; i < this->Pieces.size(); ++i)
    {
      work.Step(i, this->Pieces.size());
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
      if (piece.Rank == None)
      {
        pieces.push_back(piece);
      }
      append(end);
    }
    this->Pieces = std::move(pieces);
    this->JoinEqualPieces(SubProgress(progress, 0.7, 1.0));
  }

  /** Pass 3: the input points at crossings. All others have been found when cutting. */
  void Match(const Progress& progress)
  {
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
      SubProgress(progress, 0.0, 0.1));
    ForEachStretch(
      this->Points.Count, SubProgress(progress, 0.1, 1.0), [&](Index begin, Index end) {
        for (Index id = begin; id < end; ++id)
        {
          const Point2 p = this->Points.At(id);
          grid.Visit(p, [&](Index i) {
            if (this->At(crossings[i]) == p && std::isfinite(this->Points.Elevation(id)))
            {
              this->SetInput(crossings[i], id);
            }
          });
        }
      });
  }

  /** The fraction of the distance from From to To, by the longer of x and y. */
  double FractionOf(const Vertex& vertex) const
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
  std::vector<Vertex> Vertices;
  std::vector<SegmentPiece> Pieces; ///< each from its lower end to its upper one
  std::vector<Ends> PieceEnds;      ///< as entered in the grid
  CellGrid Grid{ GridOf({}) };
  std::vector<Segment> Segments;   ///< by rank, which is the order of the lines
  std::vector<Index> SegmentLines; ///< by rank
  std::int64_t Crossings = 0;
  double Reach = 0.0;                               ///< see Settle()
  std::array<Index, 2> Unsettled{ { None, None } }; ///< two segments that still cross
};

/** Input points and added ones in one array; empty if nothing is added. */
Buffer<double> JoinPoints(
  const PointView& points, const std::vector<AddedPoint>& added, const Progress& progress)
{
  Buffer<double> joined;
  if (added.empty())
  {
    return joined;
  }
  joined.Resize(3 * (static_cast<std::size_t>(points.Count) + added.size()));
  double* out = joined.data();
  const auto append = [&](const Point2& p, double elevation) {
    for (const double value : { p.X, p.Y, elevation })
    {
      *out++ = value;
    }
  };
  ForEachStretch(points.Count, progress, [&](Index begin, Index end) {
    for (Index id = begin; id < end; ++id)
    {
      append(points.At(id), points.Elevation(id));
    }
  });
  for (const AddedPoint& point : added)
  {
    append(point.Position, point.Elevation);
  }
  return joined;
}

/** A triangle, its lowest vertex first. */
using Corners = std::array<Index, 3>;

/** The order of Triangulate.h: by lowest vertex, then counter-clockwise around it. */
bool ComesBefore(const std::vector<Point2>& points, const Corners& p, const Corners& q)
{
  return p[0] != q[0] ? IsLower(points[p[0]], points[q[0]])
                      : Orientation(points[p[0]], points[p[1]], points[q[1]]) == Positive;
}

/** Replaces triangles by those of the mesh, of which few are others, in the same order. */
void SortInChanged(const Mesh& mesh, Buffer<Index>& triangles, const Progress& progress)
{
  Corners* const all = reinterpret_cast<Corners*>(triangles.data());
  Corners* kept = all; // the end of those that have not changed
  std::vector<Corners> changed;
  const Index count = mesh.NumberOfTriangles();
  ForEachStretch(count, SubProgress(progress, 0.0, 0.3), [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t)
    {
      Corners corners{ mesh.Triangles[3 * t], mesh.Triangles[3 * t + 1],
        mesh.Triangles[3 * t + 2] };
      if (corners == all[t])
      {
        *kept++ = corners;
        continue;
      }
      std::rotate(corners.begin(),
        std::min_element(corners.begin(), corners.end(),
          [&](Index v, Index w) { return IsLower(mesh.PointOf(v), mesh.PointOf(w)); }),
        corners.end());
      changed.push_back(corners);
    }
  });
  const auto comesBefore = [&](const Corners& p, const Corners& q) {
    return ComesBefore(mesh.Points, p, q);
  };
  Sort(changed.begin(), changed.end(), comesBefore, SubProgress(progress, 0.3, 0.6));
  std::copy(changed.begin(), changed.end(), kept);
  const Progress merging = SubProgress(progress, 0.6, 1.0);
  WorkReporter work(merging);
  std::inplace_merge(all, kept, all + count, [&](const Corners& p, const Corners& q) {
    work.Tick();
    return comesBefore(p, q);
  });
}

/** Whether a point is at most so far from a segment, or little more. */
bool IsWithin(const Ends& segment, const Point2& p, double distance)
{
  const Point2 &a = segment[0], &b = segment[1];
  const double far = 2.0 * distance;
  if (p.X < std::min(a.X, b.X) - far || p.X > std::max(a.X, b.X) + far ||
    p.Y < std::min(a.Y, b.Y) - far || p.Y > std::max(a.Y, b.Y) + far)
  {
    return false;
  }
  const double length = std::hypot(b.X - a.X, b.Y - a.Y);
  const double across = (b.X - a.X) * (p.Y - a.Y) - (b.Y - a.Y) * (p.X - a.X);
  return !(std::fabs(across) > far * length); // also where products over- or underflow
}

void LeaveOutLong(const std::vector<Point2>& points, const EdgeLimit& limit,
  Buffer<Index>& triangles, const Progress& progress)
{
  Corners* const all = reinterpret_cast<Corners*>(triangles.data());
  WorkReporter work(progress);
  const auto isLong = [&](const Corners& corners) {
    work.Tick();
    const auto pointOf = [&](Index v) { return points[v]; };
    return !limit.Admits(pointOf, corners[0], corners[1], corners[2]);
  };
  triangles.Resize(3 * (std::remove_if(all, all + triangles.size() / 3, isLong) - all));
}

} // namespace

LinePieces CutLines(const PointView& points, const ConstraintLines& lines,
  DuplicatePolicy duplicates, const Progress& progress)
{
  const Splitting splitting(points, lines, duplicates, SubProgress(progress, 0.0, 0.9));
  LinePieces pieces;
  pieces.AreNone = splitting.IsEmpty();
  pieces.NumberOfCrossings = splitting.NumberOfCrossings();
  splitting.GetResult(pieces.Added, pieces.Pieces, SubProgress(progress, 0.9, 1.0));
  return pieces;
}

std::vector<Index> ListNearLines(
  const PointView& points, const ConstraintLines& lines, const Progress& progress)
{
  // Pieces and crossings stay within some hundred units in the last place of their lines.
  constexpr double reach = 1e-9;
  std::vector<Ends> segments;
  for (Index line = 0; line < lines.Count(); ++line)
  {
    const Index begin = lines.Offsets[line], end = lines.Offsets[line + 1];
    for (Index k = begin; k < end; ++k)
    {
      const Index next = k + 1 < end ? k + 1 : (lines.IsClosed[line] ? begin : k);
      segments.push_back({ lines.Points.At(PointOfLine(lines, line, k)),
        lines.Points.At(PointOfLine(lines, line, next)) });
    }
  }
  double largest = 0.0; // of the coordinates
  for (const Ends& ends : segments)
  {
    for (const Point2& p : ends)
    {
      largest = std::max({ largest, std::fabs(p.X), std::fabs(p.Y) });
    }
  }
  const CellGrid grid = GridOf(segments, SubProgress(progress, 0.0, 0.2));
  const Progress looking = SubProgress(progress, 0.2, 1.0);
  std::vector<Index> near;
  for (const Index id : Counted(points.Count))
  {
    ReportStep(looking, id, points.Count);
    const Point2 p = points.At(id);
    if (!std::isfinite(p.X) || !std::isfinite(p.Y) || !std::isfinite(points.Elevation(id)))
    {
      continue;
    }
    const double size = reach * std::max({ largest, std::fabs(p.X), std::fabs(p.Y) });
    const std::array<Point2, 3> around{ { { p.X - 2.0 * size, p.Y - size },
      { p.X + 2.0 * size, p.Y - size }, { p.X, p.Y + 3.0 * size } } };
    bool isNear = false;
    grid.Visit(around, [&](Index i) { isNear = isNear || IsWithin(segments[i], p, size); });
    if (isNear)
    {
      near.push_back(id);
    }
  }
  return near;
}

ConstrainedTriangulation TriangulateConstrained(
  const PointView& points, const ConstraintLines& lines, const DelaunayOptions& asked)
{
  ConstrainedTriangulation constrained;
  Triangulation& result = constrained.Result;
  const Progress& progress = asked.Monitor;
  static_cast<LinePieces&>(constrained) =
    CutLines(points, lines, asked.Duplicates, SubProgress(progress, 0.0, 0.17));
  if (constrained.AreNone)
  {
    result = Triangulate(points, asked);
    return constrained;
  }
  const Buffer<double> joined =
    JoinPoints(points, constrained.Added, SubProgress(progress, 0.17, 0.2));
  PointView all = points;
  if (!joined.empty())
  {
    all.Float = nullptr;
    all.Double = joined.data();
    all.Count += static_cast<Index>(constrained.Added.size());
  }

  DelaunayOptions options = asked;
  options.Monitor = SubProgress(progress, 0.2, 0.6);
  options.UseLattice = LatticeMode::Off;
  options.MaximumEdgeLength = 0.0; // recovery needs all triangles
  if (options.MaximumElevationError > 0.0)
  {
    options.Monitor = SubProgress(progress, 0.2, 1.0);
    result = TriangulateFew(all, options, constrained.Pieces);
    return constrained;
  }
  result = Triangulate(all, options);
  if (result.Triangles.empty())
  {
    return constrained;
  }
  Mesh mesh;
  mesh.Points.resize(all.Count);
  ForEachStretch(all.Count, SubProgress(progress, 0.6, 0.62), [&](Index begin, Index end) {
    for (Index id = begin; id < end; ++id)
    {
      mesh.Points[id] = all.At(id);
    }
  });
  mesh.Triangles.assign(result.Triangles.begin(), result.Triangles.end());
  mesh.ConnectTwins(0, SubProgress(progress, 0.62, 0.8));
  std::vector<char> flags;
  const Index missing =
    RecoverSegments(mesh, constrained.Pieces, flags, SubProgress(progress, 0.8, 0.95));
  if (missing > 0)
  {
    SortInChanged(mesh, result.Triangles, SubProgress(progress, 0.95, 0.99));
  }
  const EdgeLimit limit(asked.MaximumEdgeLength);
  if (limit.IsSet())
  {
    LeaveOutLong(mesh.Points, limit, result.Triangles, SubProgress(progress, 0.99, 1.0));
  }
  Report(progress, 1.0);
  return constrained;
}

} // namespace elevation
