// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FollowSurface.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace elevation
{

namespace
{

/** ab - cd, with an error of few units in the last place also where most digits cancel [Kahan]. */
double DifferenceOfProducts(double a, double b, double c, double d)
{
  const double cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

/** Where an edge crosses a line, within rounding of both. */
Point2 CrossingOf(const Ends& edge, const Ends& line)
{
  const double dx = line[1].X - line[0].X, dy = line[1].Y - line[0].Y;
  const auto sideOf = [&](const Point2& p) {
    return DifferenceOfProducts(dx, p.Y - line[0].Y, dy, p.X - line[0].X);
  };
  const double from = sideOf(edge[0]), to = sideOf(edge[1]);
  const double part = from / (from - to);
  const Point2 place{ edge[0].X + part * (edge[1].X - edge[0].X),
    edge[0].Y + part * (edge[1].Y - edge[0].Y) };
  // Else products may have left the range of double.
  constexpr double least = 1e-250, most = 1e250;
  const auto isUsual = [&](
                         double side) { return least < std::fabs(side) && std::fabs(side) < most; };
  return isUsual(from) && isUsual(to) && 0.0 <= part && part <= 1.0
    ? place
    : RoundedCrossing(edge[0], edge[1], line[0], line[1]);
}

class Following
{
public:
  Following(Mesh& mesh, MeshCutter& cutter, const Progress& progress)
    : Surface(mesh)
    , Cutter(cutter)
    , Stars(mesh, Part(progress, 0.0, 0.3))
  {
  }

  void Follow(FollowedSegment& segment, WorkReporter& work)
  {
    const Segment ends = segment.Ends;
    this->Line = { this->Surface.PointOf(ends.A), this->Surface.PointOf(ends.B) };
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
        next = this->Pass(vertex, crossed, ends, work);
      }
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
  static std::pair<Index, Index> EdgeOf(Index a, Index b) { return std::minmax(a, b); }

  /**
   * Goes from a vertex across an edge: to a new vertex on it, or to an end of it in reach. Where the
   * triangles of the edge are too thin to be cut, goes on to the next one; what is between the two
   * vertices is then recovered as one edge.
   */
  Index Pass(Index from, Index crossed, const Segment& segment, WorkReporter& work)
  {
    const Mesh& mesh = this->Surface;
    for (;; work.Tick())
    {
      if (crossed == None)
      {
        RefuseLeaving(mesh, segment);
      }
      const Index reached = this->FirstReached(from, crossed);
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
      // By the whole segment, so that rounding does not add up, unless it passes the edge.
      const Ends& line = Cross(this->Line, edge) ? this->Line : rest;
      Point2 place = CrossingOf(edge, line);
      if (this->IsAhead(from, place) && this->Cutter.MoveToCut(crossed, place))
      {
        return this->Cut(crossed, place);
      }
      const Index apex = mesh.Apex(beyond);
      const Sign side = Orientation(rest[0], rest[1], mesh.PointOf(apex));
      if (side == Zero)
      {
        return apex;
      }
      crossed = side == Positive ? Mesh::Next(beyond) : Mesh::Previous(beyond);
    }
  }

  Index Cut(Index crossed, const Point2& place)
  {
    Mesh& mesh = this->Surface;
    if (static_cast<std::size_t>(mesh.IdOf(mesh.NumberOfPoints())) >= MaximumNumberOfPoints)
    {
      throw Error(
        "The mesh has no room for the points where the boundary crosses its edges: at most " +
        std::to_string(MaximumNumberOfPoints) +
        " points can be handled at once. Cut it into parts.");
    }
    const Index twin = mesh.Twin(crossed);
    const Index vertex = this->Cutter.AddVertex(
      place, this->Cutter.WeightsBetween(mesh.Origin(crossed), mesh.Destination(crossed), place));
    this->CutAt.emplace(EdgeOf(mesh.Origin(crossed), mesh.Destination(crossed)), vertex);
    const Index after = this->Cutter.CutEdge(crossed, vertex);
    this->Stars.ReplaceCut(mesh, after, Mesh::Next(crossed));
    this->Stars.ReplaceCut(mesh, mesh.Twin(crossed), Mesh::Next(twin));
    return vertex;
  }

  /** Whether a place is before another one on the way, and the other before the end. */
  bool IsAhead(Index from, const Point2& place) const
  {
    return IsBefore(this->Line[0], this->Line[1], this->Surface.PointOf(from), place) &&
      IsBefore(this->Line[0], this->Line[1], place, this->Line[1]);
  }

  /** The first on the way of the ends of an edge that are in reach and ahead; or None. */
  Index FirstReached(Index from, Index edge) const
  {
    const Mesh& mesh = this->Surface;
    Index first = None;
    for (const Index vertex : { mesh.Origin(edge), mesh.Destination(edge) })
    {
      const Point2& place = mesh.PointOf(vertex);
      if (IsInReach(this->Line[0], this->Line[1], this->Units, Reach, place) &&
        this->IsAhead(from, place) &&
        (first == None || IsBefore(this->Line[0], this->Line[1], place, mesh.PointOf(first))))
      {
        first = vertex;
      }
    }
    return first;
  }

  static constexpr double Reach = 4.0; ///< as in Insertion.cxx

  Mesh& Surface;
  MeshCutter& Cutter;
  VertexStars Stars;
  std::map<std::pair<Index, Index>, Index> CutAt; ///< edges that are no more, and their vertex
  Ends Line;                                      ///< the segment that is followed
  RoundingUnits Units;
};

} // namespace

void FollowSurface(
  Mesh& mesh, MeshCutter& cutter, std::vector<FollowedSegment>& segments, const Progress& progress)
{
  Following following(mesh, cutter, progress);
  const Progress walking = Part(progress, 0.3, 1.0);
  WorkReporter work(walking);
  for (std::size_t i = 0; i < segments.size(); ++i)
  {
    work.Step(i, segments.size());
    following.Follow(segments[i], work);
  }
  for (FollowedSegment& segment : segments)
  {
    following.AddLaterCuts(segment);
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
