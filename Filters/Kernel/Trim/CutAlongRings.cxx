// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// CutAlongRings.h says what comes out. A segment is walked from vertex to vertex of its chain:
//
// - StepAlong() looks for an edge that lies on the segment.
// - If there is none, Pass() goes from triangle to triangle. An edge between two original triangles
//   is cut where the segment crosses it, and the cut is the next vertex of the chain. An edge
//   within one original triangle, which is flat, is only passed.
// - Link() makes the edge between the two vertices, replacing edges that were passed.
//
// A triangle is "loose" if it is too thin to be cut, or has replaced such a one. Each loose
// triangle counts as an original triangle of its own, so every edge of it is tried for a cut; where
// there is no place for a cut, the edge is passed and replaced.
#include "CutAlongRings.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <unordered_set>
#include <utility>

namespace elevation
{

namespace
{

/** Where an edge crosses a line, within rounding of both. */
Point2 CrossingOf(const Ends& edge, const Ends& line)
{
  // The usual case in double: signed distances of both ends, times the length of the line.
  const double dx = line[1].X - line[0].X, dy = line[1].Y - line[0].Y;
  const auto sideOf = [&](const Point2& p) {
    return DifferenceOfProducts(dx, p.Y - line[0].Y, dy, p.X - line[0].X);
  };
  const double from = sideOf(edge[0]), to = sideOf(edge[1]);
  const double share = from / (from - to);
  const Point2 place{ edge[0].X + share * (edge[1].X - edge[0].X),
    edge[0].Y + share * (edge[1].Y - edge[0].Y) };
  // Else products may have left the range of double.
  constexpr double least = 1e-250, most = 1e250;
  const auto isUsual = [&](
                         double side) { return least < std::fabs(side) && std::fabs(side) < most; };
  return isUsual(from) && isUsual(to) && 0.0 <= share && share <= 1.0
    ? place
    : RoundedCrossing(edge[0], edge[1], line[0], line[1]);
}

class Follower
{
public:
  Follower(Mesh& mesh, MeshCutter& cutter, const Progress& progress)
    : Surface(mesh)
    , Cutter(cutter)
    , Stars(mesh, progress)
    , Fixed(mesh.Triangles.size(), 0)
  {
  }

  void Follow(FollowedSegment& segment, WorkReporter& work)
  {
    const Segment ends = segment.Ends;
    this->Line = { this->Surface.PointOf(ends.A), this->Surface.PointOf(ends.B) };
    // Of the whole segment, not of what is left of it: reach is the same all the way.
    this->Units = UnitsOf(this->Line[0], this->Line[1]);
    Index vertex = ends.A;
    while (vertex != ends.B)
    {
      work.Tick();
      const SegmentStep step = StepAlong(this->Surface, this->Stars, vertex, ends.B);
      Index next = step.Vertex;
      if (step.HalfEdge == None)
      {
        const Index crossed = FirstCrossed(this->Surface, this->Stars, vertex, ends.B);
        if (crossed == None && vertex == ends.A)
        {
          return; // it begins outside
        }
        segment.IsMissing = true;
        next = crossed == None ? this->NextToBorder(vertex, ends)
                               : this->Pass(vertex, crossed, segment, work);
      }
      // Fixed from now on, so a later segment that crosses it cuts it, and does not replace it.
      this->Link(vertex, next);
      vertex = next;
      if (vertex != ends.B)
      {
        segment.Between.push_back(vertex);
      }
    }
  }

  /** Adds the vertices at which segments that came later have cut the edges of a chain. */
  void AddLaterCuts(FollowedSegment& segment) const
  {
    // What is still ahead, the next one last. A cut edge is replaced by its two parts until none is
    // cut; parts may have been cut again.
    std::vector<Index> ahead(1, segment.Ends.B);
    ahead.insert(ahead.end(), segment.Between.rbegin(), segment.Between.rend());
    segment.Between.clear();
    Index at = segment.Ends.A;
    while (!ahead.empty())
    {
      const auto cut = this->CutAt.find(EdgeOf(at, ahead.back()));
      if (cut != this->CutAt.end())
      {
        ahead.push_back(cut->second);
        continue;
      }
      at = ahead.back();
      ahead.pop_back();
      if (!ahead.empty())
      {
        segment.Between.push_back(at);
      }
    }
  }

private:
  // An edge by its ends, whichever half-edge it is seen from.
  static std::pair<Index, Index> EdgeOf(Index a, Index b) { return std::minmax(a, b); }

  /**
   * Makes an edge between two vertices of a chain, if there is none, and fixes it. What it replaces
   * is within one original triangle, or all of it thin.
   */
  void Link(Index from, Index to)
  {
    std::vector<Index> replaced;
    RecoverSegments(this->Surface, this->Stars, { { from, to } }, this->Fixed, {}, &replaced);
    // Triangles of several original ones were replaced: the new ones belong to none of them.
    if (std::any_of(replaced.begin(), replaced.end(),
          [&](Index t) { return this->OriginalOf(t) != this->OriginalOf(replaced.front()); }))
    {
      this->Loose.insert(replaced.begin(), replaced.end());
    }
  }

  /** The original triangle that a triangle is part of; a number of its own for a loose one. */
  Index OriginalOf(Index t) const { return this->IsLoose(t) ? ~t : this->Cutter.Parent(t); }

  /**
   * Goes from a vertex across edges to the first that has to be cut, which gets a vertex, or to an
   * end of one of them in reach. Edges within one original triangle need no vertex, as it is flat.
   * Where both triangles of an edge are too thin to be cut, goes on to the next one.
   */
  Index Pass(Index from, Index crossed, const FollowedSegment& followed, WorkReporter& work)
  {
    const Segment& segment = followed.Ends;
    const Mesh& mesh = this->Surface;
    // To come back to, where a later edge turns out to be uncuttable.
    const Index first = crossed;
    bool isWithin = false; // whether the edge before is within one original triangle
    for (;; work.Tick())
    {
      // Vertices within rounding of the segment come first: a cut next to one would leave a needle.
      const Index reached =
        this->FirstReached(from, segment, { mesh.Origin(crossed), mesh.Destination(crossed) });
      if (reached != None)
      {
        return reached;
      }
      const Index beyond = mesh.Twin(crossed);
      if (beyond == Mesh::Border)
      {
        RefuseLeaving(mesh, segment);
      }
      const Ends edge{ { mesh.PointOf(mesh.Origin(crossed)),
        mesh.PointOf(mesh.Destination(crossed)) } };
      const Ends rest{ { mesh.PointOf(from), this->Line[1] } };
      if (this->Fixed[crossed] ||
        this->OriginalOf(Mesh::Triangle(crossed)) != this->OriginalOf(Mesh::Triangle(beyond)))
      {
        // By the whole segment, so that rounding does not add up, unless it passes the edge.
        const Ends& line = AreCrossing(this->Line, edge) ? this->Line : rest;
        Point2 place = CrossingOf(edge, line);
        const Index cut =
          this->CutNear(crossed, place, [&](const Point2& p) { return this->IsAhead(from, p); });
        const Index vertex = cut == None ? this->EndAt(crossed, place, followed) : cut;
        if (vertex != None)
        {
          return vertex;
        }
        // The triangle that was entered across the edge before has just become loose, so that edge
        // is not within one original triangle any more.
        if (isWithin && this->IsLoose(Mesh::Triangle(crossed)))
        {
          crossed = first; // the edge before is to be cut after all
          isWithin = false;
          continue;
        }
        isWithin = false;
      }
      else
      {
        isWithin = true;
      }
      // Nothing to cut here: through the side of the triangle beyond that the segment leaves by.
      const Index apex = mesh.Apex(beyond);
      const Sign side = Orientation(rest[0], rest[1], mesh.PointOf(apex));
      if (side == Zero)
      {
        return apex;
      }
      crossed = side == Positive ? Mesh::Next(beyond) : Mesh::Previous(beyond);
    }
  }

  /** Where the rest of a segment leaves the mesh by rounding alone: to the next vertex in reach. */
  Index NextToBorder(Index from, const Segment& segment)
  {
    const Mesh& mesh = this->Surface;
    std::vector<Index> around;
    this->Stars.Visit(mesh, from, [&](Index h) {
      // All neighbours; those behind are not ahead, so FirstReached() leaves them out.
      around.insert(around.end(), { mesh.Destination(h), mesh.Apex(h) });
      return true;
    });
    const Index next = this->FirstReached(from, segment, around);
    if (next == None)
    {
      RefuseLeaving(mesh, segment);
    }
    return next;
  }

  /**
   * Cuts an edge at a place, within rounding. Where a triangle of it is too thin for that, cuts the
   * other one beside the edge, if the edge may still be replaced. Triangles that are too thin
   * become loose. @return the new vertex; None if there is no place for it
   */
  Index CutNear(Index h, Point2 place, const std::function<bool(const Point2&)>& isUsable)
  {
    const Index twin = this->Surface.Twin(h);
    // Between two loose triangles an edge has no original surface on either side: it is replaced.
    if (!this->Fixed[h] && this->IsLoose(Mesh::Triangle(h)) && this->IsLoose(Mesh::Triangle(twin)))
    {
      return None;
    }
    const Point2 rounded = place;
    if (this->Cutter.MoveToCut(h, place, isUsable))
    {
      return this->Cut(h, place);
    }
    // An edge of another chain must stay where it is.
    if (this->Fixed[h])
    {
      return None;
    }
    // Of both sides, the one with more room comes last, so that @a inside is then a place in it.
    const double area = this->Cutter.TwiceArea(Mesh::Triangle(h));
    const Index thicker = area > this->Cutter.TwiceArea(Mesh::Triangle(twin)) ? h : twin;
    Point2 inside = rounded;
    for (const Index side : { h == thicker ? twin : h, thicker })
    {
      inside = rounded;
      // Not even one double within 64 units lies inside: the triangle has no width but rounding.
      if (!this->Cutter.MoveInside(side, inside, [](const Point2&) { return true; }))
      {
        this->Loose.insert(Mesh::Triangle(side));
      }
    }
    if (this->IsLoose(Mesh::Triangle(thicker)))
    {
      return None;
    }
    place = rounded;
    // A place ahead on the way if there is one, else any inside.
    return this->CutBeside(
      thicker, this->Cutter.MoveInside(thicker, place, isUsable) ? place : inside);
  }

  /**
   * Where an edge cannot be cut: an end of it that only rounding separates from the place, unless
   * the chain has been there; or None.
   */
  Index EndAt(Index h, const Point2& place, const FollowedSegment& followed) const
  {
    // As far as MoveToCut() looks for a place.
    const double near = 64.0 * std::numeric_limits<double>::epsilon() *
      std::max(std::fabs(place.X), std::fabs(place.Y));
    const std::vector<Index>& chain = followed.Between;
    for (const Index end : { this->Surface.Origin(h), this->Surface.Destination(h) })
    {
      const Point2& p = this->Surface.PointOf(end);
      // Coming back to a vertex of the chain would make it a loop, and the walk without end.
      if (std::fabs(p.X - place.X) <= near && std::fabs(p.Y - place.Y) <= near &&
        end != followed.Ends.A && std::find(chain.begin(), chain.end(), end) == chain.end())
      {
        return end;
      }
    }
    return None;
  }

  bool IsLoose(Index t) const { return !this->Loose.empty() && this->Loose.count(t) > 0; }

  Index AddVertex(Index crossed, const Point2& place)
  {
    const Mesh& mesh = this->Surface;
    if (static_cast<std::size_t>(mesh.IdOf(mesh.NumberOfPoints())) >= MaximumNumberOfPoints)
    {
      throw Error(
        "The mesh has no room for the points where the boundary crosses its edges: at most " +
        std::to_string(MaximumNumberOfPoints) +
        " points can be handled at once. Cut it into parts.");
    }
    return this->Cutter.AddVertex(
      place, this->Cutter.WeightsBetween(mesh.Origin(crossed), mesh.Destination(crossed), place));
  }

  Index Cut(Index crossed, const Point2& place)
  {
    const Mesh& mesh = this->Surface;
    const Index twin = mesh.Twin(crossed);
    const Index vertex = this->AddVertex(crossed, place);
    // The chain of an earlier segment may contain this edge; AddLaterCuts() finds the vertex by it.
    this->CutAt.emplace(EdgeOf(mesh.Origin(crossed), mesh.Destination(crossed)), vertex);
    const Index after = this->Cutter.CutEdge(crossed, vertex);
    // New triangles have been appended: the flags grow with them.
    this->Fixed.resize(mesh.Triangles.size(), 0);
    this->KeepUp(crossed, after);
    this->KeepUp(twin, mesh.Twin(crossed));
    return vertex;
  }

  /**
   * Cuts the triangle of half-edge h at a place inside it and within rounding of h. What is left
   * between h and the vertex is too thin to be cut, and may be replaced like the triangle beyond h.
   */
  Index CutBeside(Index h, const Point2& place)
  {
    const Index t = Mesh::Triangle(h), added = this->Surface.NumberOfTriangles();
    const Index vertex = this->AddVertex(h, place);
    this->Cutter.CutTriangle(t, vertex);
    this->Fixed.resize(this->Surface.Triangles.size(), 0);
    // CutTriangle() moved two sides of the triangle into the new parts: their stars and flags
    // follow.
    for (const Index k : { 0, 1 })
    {
      const Index before = 3 * t + 1 + k, moved = 3 * (added + k);
      this->Stars.ReplaceCut(this->Surface, Mesh::Previous(moved), before);
      this->Fixed[moved] = std::exchange(this->Fixed[before], char(0));
    }
    this->Loose.insert(h == 3 * t ? t : added + (h - 3 * t - 1));
    return vertex;
  }

  /** After half-edge h was cut, with its second half in a new triangle. */
  void KeepUp(Index h, Index after)
  {
    // The half-edge after h moved into the new triangle, see MeshCutter::Halve().
    const Index before = Mesh::Next(h);
    if (this->IsLoose(Mesh::Triangle(h)))
    {
      this->Loose.insert(Mesh::Triangle(after));
    }
    this->Stars.ReplaceCut(this->Surface, after, before);
    this->Fixed[after] = this->Fixed[h];
    this->Fixed[Mesh::Next(after)] = std::exchange(this->Fixed[before], char(0));
  }

  /** Whether a place is before another one on the way, and the other before the end. */
  bool IsAhead(Index from, const Point2& place) const
  {
    // Strictly ahead, and strictly before the end, so that the walk ends.
    return IsBefore(this->Line[0], this->Line[1], this->Surface.PointOf(from), place) &&
      IsBefore(this->Line[0], this->Line[1], place, this->Line[1]);
  }

  /** The first on the way of those vertices that are in reach and ahead, or the end; or None. */
  Index FirstReached(Index from, const Segment& segment, const std::vector<Index>& vertices) const
  {
    Index first = None;
    for (const Index vertex : vertices)
    {
      const Point2& place = this->Surface.PointOf(vertex);
      // The end counts also where rounding puts it behind.
      const bool isReached = vertex == segment.B ||
        (IsInReach(this->Line[0], this->Line[1], this->Units, SnappingReach, place) &&
          this->IsAhead(from, place));
      if (isReached &&
        (first == None ||
          IsBefore(this->Line[0], this->Line[1], place, this->Surface.PointOf(first))))
      {
        first = vertex;
      }
    }
    return first;
  }

  Mesh& Surface;
  MeshCutter& Cutter;
  VertexStars Stars;
  std::vector<char> Fixed;         ///< one a half-edge: whether it is an edge of a chain
  std::unordered_set<Index> Loose; ///< triangles too thin to be cut, and what has replaced them
  std::map<std::pair<Index, Index>, Index> CutAt; ///< edges that are no more, and their vertex
  Ends Line;                                      ///< the segment that is followed
  RoundingUnits Units;
};

} // namespace

void FollowSurface(
  Mesh& mesh, MeshCutter& cutter, std::vector<FollowedSegment>& segments, const Progress& progress)
{
  Stages stages(progress, { 30, 70 });
  Follower follower(mesh, cutter, stages.Next());
  WorkReporter work(stages.Next());
  for (std::size_t i = 0; i < segments.size(); ++i)
  {
    work.Step(i, segments.size());
    follower.Follow(segments[i], work);
  }
  // Only now: segments that came later have cut the chains of earlier ones.
  for (FollowedSegment& segment : segments)
  {
    follower.AddLaterCuts(segment);
  }
}

bool BeginsInside(const Mesh& mesh, VertexStars& stars, Index from, Index to)
{
  return StepAlong(mesh, stars, from, to).HalfEdge != None ||
    FirstCrossed(mesh, stars, from, to) != None;
}

bool IsLower(const Mesh& mesh, const Segment& s, const Segment& t)
{
  const Point2& a = mesh.PointOf(s.A);
  const Point2& b = mesh.PointOf(t.A);
  return IsLower(a, b) || (a == b && IsLower(mesh.PointOf(s.B), mesh.PointOf(t.B)));
}

void RefuseLeaving(const Mesh& mesh, const Segment& segment)
{
  throw Error("The boundary's edge from " + NameOf(mesh, segment.A) + " to " +
    NameOf(mesh, segment.B) +
    " leaves the mesh on its way, where it crosses a hole or the outside. Let the boundary "
    "pass through points of the mesh there; or merge points of the mesh, as "
    "vtkStaticCleanPolyData does, if borders of it lie on each other there.");
}

} // namespace elevation
