// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Rings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

namespace elevation
{

// ---------------------------------------------------------------------------------------- location

std::vector<Ends> EdgesOf(const std::vector<Point2>& points, const Rings& rings)
{
  std::vector<Ends> edges;
  for (Index i = 0; i < static_cast<Index>(rings.Vertices.size()); ++i)
  {
    edges.push_back({ points[rings.Vertices[i]], points[rings.Vertices[rings.After(i)]] });
  }
  return edges;
}

RingLocator::RingLocator(const std::vector<Point2>& points, const Rings& rings)
  : Edges(EdgesOf(points, rings))
  , ByHeight(this->Edges.size(), [this](std::size_t i) {
    return Ends{ { { 0.0, this->Edges[i][0].Y }, { 0.0, this->Edges[i][1].Y } } };
  })
{
}

std::vector<Index> RingLocator::EdgesMet(const Point2& a, const Point2& b, const Point2& c) const
{
  // p is the lowest corner, q the next one: near p, the triangle is above p and on the left of pq.
  // The point tested lies there, closer to p than anything else.
  const bool lowestIsB = IsLower(b, a) && IsLower(b, c);
  const bool lowestIsC = !lowestIsB && IsLower(c, a);
  const Point2& p = lowestIsB ? b : lowestIsC ? c : a;
  const Point2& q = lowestIsB ? c : lowestIsC ? a : b;
  //      high   r
  //      /     /   q     The point tested is above p by as little as you like, between pq and pr.
  //     /     / /        A ray from it to the left meets the edges that span the height of p (with
  //  <-/-----p           their low end, without their high end) and pass p on the left. An edge
  //   low                through p goes up on one side of the triangle, which it does
  //                      not cut; q is on the same side, or on the edge.
  std::vector<Index> met;
  this->ByHeight.Visit(Point2{ 0.0, p.Y }, [&](Index i) {
    const bool isDown = this->Edges[i][1].Y < this->Edges[i][0].Y;
    const Point2 &low = this->Edges[i][isDown], &high = this->Edges[i][!isDown];
    if (!(low.Y <= p.Y && p.Y < high.Y))
    {
      return;
    }
    const Sign side = Orientation(low, high, p);
    // An edge that goes up from p passes the triangle on the left or right, as it does not cut it.
    if (side == Negative || (side == Zero && Orientation(p, high, q) == Negative))
    {
      met.push_back(i);
    }
  });
  return met;
}

bool RingLocator::IsInside(const Point2& a, const Point2& b, const Point2& c) const
{
  return this->EdgesMet(a, b, c).size() % 2 != 0;
}

// ------------------------------------------------------------------------------------- given lines

namespace
{

// By place, not by id: lines may have points of their own at the same places.
bool IsBefore(const Ends& one, const Ends& other)
{
  return one[0] != other[0] ? IsLower(one[0], other[0]) : IsLower(one[1], other[1]);
}

/** A line without consecutive duplicate points; a closed one does not repeat its first point. */
struct Piece
{
  std::vector<Index> Points;
  Index Line;
  bool IsClosed;
  std::vector<Index> Repeats; ///< lines that are the same ring
};

/** The lines as pieces, without those that have no point. @throws Error as JoinLines() */
std::vector<Piece> MakePieces(const BoundaryLines& lines)
{
  std::vector<Piece> pieces;
  for (Index line = 0; line < lines.Lines.Count(); ++line)
  {
    Piece piece;
    piece.Line = line;
    for (const Index* point = lines.Lines.Begin(line); point != lines.Lines.End(line); ++point)
    {
      const Point2& p = lines.Points[*point];
      if (!std::isfinite(p.X) || !std::isfinite(p.Y))
      {
        throw Error("The " + lines.Name + "'s " + NameOf(lines.Points, *point) + " of " +
          NameOf(lines, line) + " is not finite.");
      }
      if (piece.Points.empty() || lines.Points[piece.Points.back()] != p)
      {
        piece.Points.push_back(*point);
      }
    }
    if (piece.Points.empty())
    {
      continue;
    }
    const bool returns = lines.Points[piece.Points.front()] == lines.Points[piece.Points.back()];
    piece.IsClosed = lines.IsPolygon[line] || returns;
    if (piece.Points.size() > 1 && returns)
    {
      piece.Points.pop_back();
    }
    // A closed piece of two points would be an edge there and back.
    if (piece.IsClosed && piece.Points.size() < 3)
    {
      throw Error("The " + lines.Name + "'s " + NameOf(lines, line) + " has only " +
        std::to_string(piece.Points.size()) + " different point" +
        (piece.Points.size() == 1 ? "" : "s") + "; a ring has at least three.");
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

/** The edges of a closed piece, whatever its first point and direction. */
std::vector<Ends> SortedEdges(const BoundaryLines& lines, const Piece& piece)
{
  std::vector<Ends> edges;
  for (std::size_t i = 0, before = piece.Points.size() - 1; i < piece.Points.size(); before = i++)
  {
    const Point2 p = lines.Points[piece.Points[before]], q = lines.Points[piece.Points[i]];
    edges.push_back(IsLower(p, q) ? Ends{ p, q } : Ends{ q, p });
  }
  std::sort(edges.begin(), edges.end(), IsBefore);
  return edges;
}

/**
 * Leaves out closed pieces with the same edges as one before, as they would cancel out.
 * @return the first line of these, and how many there are; none: an empty message
 */
Message DropRepeated(const BoundaryLines& lines, std::vector<Piece>& pieces)
{
  // Two closed lines are the same ring if they have the same edges; sorting them makes that visible
  // without trying all first points and both directions.
  const auto comesBefore = [](const std::vector<Ends>& one, const std::vector<Ends>& other) {
    return std::lexicographical_compare(
      one.begin(), one.end(), other.begin(), other.end(), IsBefore);
  };
  // Rings, and where they are among the kept ones.
  std::map<std::vector<Ends>, std::size_t, decltype(comesBefore)> known(comesBefore);
  std::vector<Piece> kept;
  Index firstLine = None;
  for (Piece& piece : pieces)
  {
    const auto ring =
      piece.IsClosed ? known.emplace(SortedEdges(lines, piece), kept.size()).first : known.end();
    if (ring == known.end() || ring->second == kept.size())
    {
      kept.push_back(std::move(piece));
      continue;
    }
    kept[ring->second].Repeats.push_back(piece.Line);
    firstLine = firstLine == None ? piece.Line : firstLine;
  }
  const std::size_t count = pieces.size() - kept.size();
  pieces = std::move(kept);
  return count == 0
    ? Message()
    : MakeMessage<sentences::RingsRepeated>(lines.Name, count, "the " + NameOf(lines, firstLine));
}

/**
 * Chains open pieces at their ends: the front of piece i is end 2 i, its back is end 2 i + 1. Each
 * end gets a partner, the end of the piece with which the ring goes on there.
 */
class Chains
{
public:
  Chains(const BoundaryLines& lines, const std::vector<Piece>& pieces)
    : Lines(lines)
    , Pieces(pieces)
    , Partners(2 * pieces.size())
  {
    for (std::size_t end = 0; end < 2 * pieces.size(); ++end)
    {
      if (!pieces[end / 2].IsClosed)
      {
        this->EndsAt[this->PlaceAt(end, 0)].push_back(end);
      }
    }
    this->CheckEnds();
    for (auto& meeting : this->EndsAt)
    {
      this->Pair(meeting.first, meeting.second);
    }
  }

  /**
   * The ring of a piece.
   * @param[in,out] used     one flag per piece: whether it is in a ring
   * @param[in,out] members  get the lines of the ring
   */
  std::vector<Index> RingFrom(
    std::size_t piece, std::vector<char>& used, std::vector<Index>& members) const
  {
    std::vector<Index> ring;
    // From an end through the piece to its other end (end ^ 1), and on with that one's partner. The
    // last point of a piece is the first of the next one.
    for (std::size_t end = 2 * piece; !used[end / 2]; end = this->Partners[end ^ 1])
    {
      used[end / 2] = 1;
      members.push_back(this->Pieces[end / 2].Line);
      for (std::size_t i = 0; i + 1 < this->Pieces[end / 2].Points.size(); ++i)
      {
        ring.push_back(this->PointAt(end, i));
      }
    }
    return ring;
  }

private:
  /** Point i of a piece, counted from an end of it. */
  Index PointAt(std::size_t end, std::size_t i) const
  {
    const std::vector<Index>& points = this->Pieces[end / 2].Points;
    return points[end % 2 == 0 ? i : points.size() - 1 - i];
  }
  const Point2& PlaceAt(std::size_t end, std::size_t i) const
  {
    return this->Lines.Points[this->PointAt(end, i)];
  }

  /** @throws Error naming the first end at a place with an odd number of them */
  void CheckEnds() const
  {
    for (std::size_t end = 0; end < 2 * this->Pieces.size(); ++end)
    {
      const Piece& piece = this->Pieces[end / 2];
      const std::size_t count = piece.IsClosed ? 0 : this->EndsAt.at(this->PlaceAt(end, 0)).size();
      if (count % 2 != 0)
      {
        throw Error("The " + this->Lines.Name +
          " is not closed: " + NameOf(this->Lines, piece.Line) + " ends at " +
          NameOf(this->Lines.Points, this->PointAt(end, 0)) +
          (count == 1
              ? ", where no other line goes on."
              : ", where " + std::to_string(count) + " lines end, which cannot be paired."));
      }
    }
  }

  /**
   * Pairs neighbours by angle, so that no rings cross there. First, ends that leave in the same
   * direction are paired with each other, as what they share cancels out.
   */
  void Pair(const Point2& place, std::vector<std::size_t>& ends)
  {
    const auto comesBefore = [&](std::size_t e, std::size_t f) {
      return OrderAround(place, this->PlaceAt(e, 1), this->PlaceAt(f, 1)) == Positive;
    };
    // Stable, so that ends in the same direction are paired in the order of the lines.
    std::stable_sort(ends.begin(), ends.end(), comesBefore);
    std::vector<std::size_t> others;
    // First pass: an end joins the one before it if both leave in the same direction. Second pass:
    // of what is left, neighbours join, like brackets; their arcs around the place do not cross.
    for (const bool areAlike : { true, false })
    {
      others.clear();
      for (const std::size_t end : ends)
      {
        if (others.empty() || (areAlike && comesBefore(others.back(), end)))
        {
          others.push_back(end);
          continue;
        }
        this->Partners[end] = others.back();
        this->Partners[others.back()] = end;
        others.pop_back();
      }
      ends = others;
    }
  }

  const BoundaryLines& Lines;
  const std::vector<Piece>& Pieces;
  std::vector<std::size_t> Partners; ///< one per end
  std::unordered_map<Point2, std::vector<std::size_t>, PointHash> EndsAt;
};

} // namespace

void TakePoints(const PointView& points, BoundaryLines& lines)
{
  // One bit for each point of the cloud costs less than a map of the few that lines use.
  IdSet used(points.Count);
  for (const Index id : lines.Lines.Vertices)
  {
    used.Add(id);
  }
  lines.Points.Ids = used.ListAndRank();
  for (const Index id : lines.Points.Ids)
  {
    lines.Points.Places.push_back(points.At(id));
    lines.Elevations.push_back(points.Elevation(id));
  }
  for (Index& vertex : lines.Lines.Vertices)
  {
    vertex = used.RankOf(vertex);
  }
}

std::string NameOf(const BoundaryLines& lines, Index line)
{
  return (lines.IsPolygon[line] ? "polygon (cell " : "line (cell ") +
    std::to_string(lines.Cells[line]) + ")";
}

Rings JoinLines(
  const BoundaryLines& lines, Message* repeated, std::vector<std::vector<Index>>* members)
{
  std::vector<Piece> pieces = MakePieces(lines);
  const Message ofRepeated = DropRepeated(lines, pieces);
  if (repeated)
  {
    *repeated = ofRepeated;
  }
  if (pieces.empty())
  {
    throw Error("The " + lines.Name + " has no line and no polygon.");
  }
  const Chains chains(lines, pieces);
  Rings joined;
  std::vector<char> used(pieces.size(), 0);
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    // A piece that is in a ring already gives an empty one.
    std::vector<Index> ofRing = pieces[i].Repeats;
    ofRing.insert(ofRing.begin(), pieces[i].IsClosed ? 1 : 0, pieces[i].Line);
    const std::vector<Index> ring =
      pieces[i].IsClosed ? pieces[i].Points : chains.RingFrom(i, used, ofRing);
    // A ring of two points is two lines along one edge, as of adjacent parcels: they cancel out.
    if (ring.size() > 2)
    {
      joined.Vertices.insert(joined.Vertices.end(), ring.begin(), ring.end());
      joined.Offsets.push_back(static_cast<Index>(joined.Vertices.size()));
      if (members)
      {
        members->push_back(std::move(ofRing));
      }
    }
  }
  if (joined.Vertices.empty())
  {
    throw Error("The " + lines.Name + "'s " + NameOf(lines, pieces.front().Line) +
      " makes a ring of only two points, and so do all others; a ring has at least three.");
  }
  return joined;
}

} // namespace elevation
