// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The steps of PointInsertion:
//
// 1. MatchCorners: a corner of the mesh with the same x,y is the vertex.
// 2. SnapBorderToPoints: a point within rounding of one border edge becomes a vertex of it.
// 3. LocateOthers: one sweep over the triangles finds which one holds each other point.
// 4. InsertLocated: cuts at these. The points that wait in a triangle move on to its parts.
//
// Two points of the rings at the same position are one: the map of vertices is by position.
#include "InsertRingPoints.h"

#include "CutAlongRings.h"
#include "Rings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>

namespace elevation
{

namespace
{

/** The order of edges by the places of their ends. */
bool IsLowerEdge(const Mesh& mesh, Index h, Index k)
{
  const auto segmentOf = [&](Index half) {
    const Index a = mesh.Origin(half), b = mesh.Destination(half);
    return IsLower(mesh.PointOf(b), mesh.PointOf(a)) ? Segment{ b, a } : Segment{ a, b };
  };
  return IsLower(mesh, segmentOf(h), segmentOf(k));
}

/**
 * Finds or makes the vertex at each point of the rings. Corners of triangles are known by their
 * places; other points are located and inserted.
 */
class PointInsertion
{
public:
  PointInsertion(Mesh& mesh, const NamedPoints& points, const Rings& rings, bool insert,
    bool follows, MeshCutter& cutter)
    : Surface(mesh)
    , Points(points)
    , InsertRingPoints(rings.Vertices)
    , MayInsert(insert)
    , Follows(follows)
    , Cutter(cutter)
  {
  }

  RingVertices Run(const Progress& progress)
  {
    Stages stages(progress, { 57, 36, 7 });
    this->MatchCorners(stages.Next());
    this->LocateOthers(stages.Next());
    this->InsertLocated(stages.Next());
    return std::move(this->VertexAt);
  }

private:
  /**
   * A point that is not a corner, and the triangle that holds it, which changes while others are
   * cut.
   */
  struct LocatedPoint
  {
    Index Triangle;
    Index Point;
  };
  /** Finds the corners of the mesh at points of the rings. */
  void MatchCorners(const Progress& progress)
  {
    Stages stages(progress, { 30, 70 });
    const Mesh& mesh = this->Surface;
    for (const Index point : this->InsertRingPoints)
    {
      this->VertexAt.emplace(this->Points[point], None);
    }
    // Most corners of the mesh are not points of rings, and look-ups in a map are slow.
    HashSieve sieve(128 * this->VertexAt.size());
    for (const auto& entry : this->VertexAt)
    {
      sieve.Add(PointHash()(entry.first));
    }
    std::vector<char> isToMatch(mesh.Points.size());
    ForEachNumber(mesh.NumberOfPoints(), stages.Next(), [&](Index v) {
      const Point2& p = mesh.PointOf(v);
      isToMatch[v] = sieve.MayHave(PointHash()(p)) && this->VertexAt.count(p) > 0;
    });
    const Progress matching = stages.Next();
    // Over half-edges, not points: a point that no triangle uses is not a corner, and two at the
    // same place are no trouble if only one is used.
    for (const Index h : Counted(mesh.NumberOfHalfEdges()))
    {
      ReportStep(matching, h, mesh.Triangles.size());
      const Index vertex = mesh.Origin(h);
      if (!isToMatch[vertex])
      {
        continue;
      }
      // Each vertex is looked at once, not once for each of its triangles.
      isToMatch[vertex] = 0;
      Index& found = this->VertexAt.at(mesh.PointOf(vertex));
      if (found != None)
      {
        throw Error("Points " + std::to_string(mesh.IdOf(std::min(found, vertex))) + " and " +
          std::to_string(mesh.IdOf(std::max(found, vertex))) +
          " of the mesh have the same x,y and both are corners of triangles, so that the "
          "boundary's point there is not one place of the mesh. Merge them, as "
          "vtkStaticCleanPolyData does.");
      }
      found = vertex;
    }
  }

  /** Finds the triangle that contains each point that is not a corner. */
  void LocateOthers(const Progress& progress)
  {
    Stages stages(progress, { 20, 80 });
    const Mesh& mesh = this->Surface;
    const Progress snapping = stages.Next();
    std::vector<Index> open; // ids of Points
    for (const Index point : this->InsertRingPoints)
    {
      Index& vertex = this->VertexAt.at(this->Points[point]);
      if (vertex == None)
      {
        vertex = OutsideMesh;
        open.push_back(point);
      }
    }
    if (!open.empty() && this->MayInsert)
    {
      this->SnapBorderToPoints(open, snapping);
    }
    if (open.empty())
    {
      return;
    }
    const Index count = static_cast<Index>(open.size());
    const auto pointOf = [&](Index i) { return this->Points[open[i]]; };
    // The grid is over the points, and the triangles pass through it: it is as small as the rings.
    const CellGrid grid(open.size(),
      [&](std::size_t i) { return std::array<Point2, 1>{ { this->Points[open[i]] } }; });
    std::vector<Index> triangles(open.size(), None);
    ForEachNumber(mesh.NumberOfTriangles(), stages.Next(), [&](Index t) {
      // The points of successive triangles may be far apart in memory.
      const std::size_t ahead = 3 * static_cast<std::size_t>(t) + HalfEdgesAhead;
      if (ahead + 2 < mesh.Triangles.size())
      {
        Prefetch(&mesh.Points[mesh.Triangles[ahead]]);
        Prefetch(&mesh.Points[mesh.Triangles[ahead + 1]]);
        Prefetch(&mesh.Points[mesh.Triangles[ahead + 2]]);
      }
      const std::array<Point2, 3> corners = this->Cutter.CornersOf(t);
      grid.Visit(corners, [&](Index i) {
        if (triangles[i] == None && this->Cutter.Holds(t, pointOf(i)))
        {
          // A point on an edge is in two triangles; either will do, as the edge is cut in both.
          triangles[i] = t;
        }
      });
    });
    for (Index i = 0; i < count; ++i)
    {
      if (triangles[i] != None)
      {
        this->Located.push_back({ triangles[i], open[i] });
      }
    }
    if (!this->Located.empty() && !this->MayInsert)
    {
      throw Error("The boundary's " + NameOf(this->Points, this->Located.front().Point) +
        " is not a corner of the mesh: no triangle has a point with exactly the same x,y. Turn "
        "RecoverBoundary on, or add the boundary's points to the points before triangulating "
        "them.");
    }
    // The map has at least as many places as points that may have to be appended outside the mesh.
    ReserveVertices(this->Surface, this->VertexAt.size(), this->Located.size());
  }

  /**
   * Makes the rings' points within rounding of the border vertices of it. The border moves to the
   * points; else a ring would cross it right beside them.
   */
  void SnapBorderToPoints(std::vector<Index>& open, const Progress& progress)
  {
    const BorderEdges border = FindBorder(this->Surface, progress);
    // A point in reach of an edge is at most this far from it, so it is enough to look up the cells
    // around the point.
    double reach = 0.0; // the largest of any border edge
    for (const Ends& segment : border.Segments)
    {
      const RoundingUnits units = UnitsOf(segment[0], segment[1]);
      reach = std::max({ reach, 2.0 * SnappingReach * units.X, 2.0 * SnappingReach * units.Y });
    }
    std::vector<PieceCut> taken; // pieces are border edges
    std::vector<Index> others;
    for (const Index point : open)
    {
      const Point2 p = this->Points[point];
      Index nearest = None;
      bool isAlone = true; // of two borders in reach, one would move into the other
      border.Grid.VisitAround(p, reach, [&](Index i) {
        const Ends& segment = border.Segments[i];
        // The grid may visit an edge twice.
        if (i != nearest &&
          IsInReach(segment[0], segment[1], UnitsOf(segment[0], segment[1]), SnappingReach, p))
        {
          isAlone = isAlone && nearest == None;
          nearest = i;
        }
      });
      if (nearest != None && isAlone)
      {
        taken.push_back({ nearest, point });
      }
      else
      {
        others.push_back(point);
      }
    }
    ReserveVertices(this->Surface, this->VertexAt.size(), taken.size());
    // Several points may be on one border edge: it is cut from its origin on, point after point.
    SortAlong(
      taken, [&](Index piece) { return border.Segments[piece]; },
      [&](Index point) { return this->Points[point]; }, Progress());
    const Mesh& mesh = this->Surface;
    Index h = None;
    for (std::size_t i = 0; i < taken.size(); ++i)
    {
      if (i == 0 || taken[i - 1].Piece != taken[i].Piece)
      {
        // Cuts of other edges may have renumbered this one.
        h = this->Cutter.CurrentHalfEdge(border.HalfEdges[taken[i].Piece]);
      }
      const Point2 p = this->Points[taken[i].Vertex];
      // Beside a triangle with no width but rounding there is no place: the point is located as
      // others are.
      if (!this->Cutter.CanCut(h, p))
      {
        others.push_back(taken[i].Vertex);
        continue;
      }
      const Index vertex = this->Cutter.AddVertex(
        p, this->Cutter.WeightsBetween(mesh.Origin(h), mesh.Destination(h), p));
      this->VertexAt.at(p) = vertex;
      h = this->Cutter.CutEdge(h, vertex);
    }
    open = std::move(others);
  }

  /** Cuts the mesh at the located points, one after another. */
  void InsertLocated(const Progress& progress)
  {
    // In an order that depends only on the places, not on the numbers of triangles, and is random:
    // each cut then divides the points that wait in a triangle about evenly.
    std::sort(this->Located.begin(), this->Located.end(),
      [&](const LocatedPoint& a, const LocatedPoint& b) {
        const Point2& p = this->Points[a.Point];
        const Point2& q = this->Points[b.Point];
        const std::uint64_t mixedP = PointHash()(p);
        const std::uint64_t mixedQ = PointHash()(q);
        return std::tie(mixedP, p.X, p.Y) < std::tie(mixedQ, q.X, q.Y);
      });
    // Weights in the triangles before they are cut.
    std::vector<InsertedVertex> weights;
    for (const LocatedPoint& located : this->Located)
    {
      weights.push_back(this->Cutter.WeightsIn(located.Triangle, this->Points[located.Point]));
      this->Waiting[located.Triangle].push_back(static_cast<Index>(weights.size()) - 1);
    }
    for (std::size_t i = 0; i < this->Located.size(); ++i)
    {
      ReportStep(progress, i, this->Located.size(), 1024);
      const Point2& p = this->Points[this->Located[i].Point];
      const Index t = this->Located[i].Triangle;
      const Index on = this->EdgeAt(t, p);
      const Index vertex =
        this->Cutter.AddVertex(p, this->IsThin(t, on) ? this->WeightsOn(on, p) : weights[i]);
      this->VertexAt.at(p) = vertex;
      this->Redistribute(static_cast<Index>(i), this->CutAt(t, on, vertex));
    }
  }

  /** The edge of a triangle that a point in it is on, or close enough to for a cut; or None. */
  Index EdgeAt(Index t, const Point2& p) const
  {
    const Mesh& mesh = this->Surface;
    Index on = None;
    Index inReach = None;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      const Point2 &a = mesh.PointOf(mesh.Origin(h)), &b = mesh.PointOf(mesh.Destination(h));
      on = Orientation(a, b, p) == Zero ? h : on;
      // What follows the surface could not be split in the needle between the point and an edge in
      // reach. Of several such edges the lowest counts, whatever the numbers of triangles are.
      if (this->Follows && !mesh.IsBorder(h) && IsInReach(a, b, UnitsOf(a, b), SnappingReach, p) &&
        this->Cutter.CanCut(h, p) && (inReach == None || IsLowerEdge(mesh, h, inReach)))
      {
        inReach = h;
      }
    }
    return on == None ? inReach : on;
  }

  /**
   * Whether a triangle is so thin that within reach of an edge its elevations differ from those of
   * the edge by more than rounding. A point that the edge is moved to then takes those of the edge.
   */
  bool IsThin(Index t, Index on) const
  {
    constexpr double reach = 0x1p20 * SnappingReach;
    const Mesh& mesh = this->Surface;
    if (on == None)
    {
      return false;
    }
    // The height of the triangle over the edge is its doubled area over the edge's length.
    const RoundingUnits units =
      UnitsOf(mesh.PointOf(mesh.Origin(on)), mesh.PointOf(mesh.Destination(on)));
    return this->Cutter.TwiceArea(t) <
      reach * std::max(units.X, units.Y) * std::sqrt(mesh.SquaredLengthOf(on));
  }

  InsertedVertex WeightsOn(Index h, const Point2& p) const
  {
    return this->Cutter.WeightsBetween(this->Surface.Origin(h), this->Surface.Destination(h), p);
  }

  /** Cuts a triangle at a vertex inside, or on an edge, with its neighbour. @return the parts */
  std::vector<Index> CutAt(Index t, Index on, Index vertex)
  {
    const Mesh& mesh = this->Surface;
    std::vector<Index> parts{ t };
    Index next = mesh.NumberOfTriangles();
    if (on == None)
    {
      this->Cutter.CutTriangle(t, vertex);
    }
    else
    {
      if (!mesh.IsBorder(on))
      {
        parts.push_back(Mesh::Triangle(mesh.Twin(on)));
      }
      this->Cutter.CutEdge(on, vertex);
    }
    for (; next < mesh.NumberOfTriangles(); ++next)
    {
      parts.push_back(next);
    }
    return parts;
  }

  /**
   * After a cut at a located point, hands the points that wait in the parts to those that hold
   * them.
   */
  void Redistribute(Index done, const std::vector<Index>& parts)
  {
    std::vector<Index> moving;
    for (const Index part : parts)
    {
      std::vector<Index>& waiting = this->Waiting[part];
      moving.insert(moving.end(), waiting.begin(), waiting.end());
      waiting.clear();
    }
    CountWork(1 + moving.size());
    for (const Index i : moving)
    {
      if (i != done)
      {
        LocatedPoint& located = this->Located[i];
        // There is always one: the parts cover what they were cut from, also where an edge was
        // moved to the point, as the two triangles of the edge make the same quadrilateral as
        // before.
        located.Triangle = *std::find_if(parts.begin(), parts.end(),
          [&](Index part) { return this->Cutter.Holds(part, this->Points[located.Point]); });
        this->Waiting[located.Triangle].push_back(i);
      }
    }
  }

  Mesh& Surface;
  const NamedPoints& Points;
  const std::vector<Index>& InsertRingPoints;
  const bool MayInsert;
  const bool Follows;
  MeshCutter& Cutter;
  RingVertices VertexAt;
  std::vector<LocatedPoint> Located;
  std::unordered_map<Index, std::vector<Index>> Waiting; ///< by triangle: indices in Located
};

} // namespace

RingVertices InsertRingPoints(Mesh& mesh, const NamedPoints& points, const Rings& rings,
  bool insert, bool follows, MeshCutter& cutter, const Progress& progress)
{
  return PointInsertion(mesh, points, rings, insert, follows, cutter).Run(progress);
}

BorderEdges FindBorder(const Mesh& mesh, const Progress& progress)
{
  std::vector<Index> halfEdges;
  std::vector<Ends> segments;
  ForEachNumber(mesh.NumberOfHalfEdges(), progress, [&](Index h) {
    if (mesh.IsBorder(h))
    {
      halfEdges.push_back(h);
      segments.push_back({ mesh.PointOf(mesh.Origin(h)), mesh.PointOf(mesh.Destination(h)) });
    }
  });
  CellGrid grid = GridOf(segments);
  return { std::move(halfEdges), std::move(segments), std::move(grid) };
}

void ReserveVertices(Mesh& mesh, std::size_t others, std::size_t vertices)
{
  // The ids that are in use, in the mesh that this one may be a part of.
  constexpr std::size_t most = MaximumNumberOfPoints;
  const std::size_t before = mesh.IdOf(mesh.NumberOfPoints());
  if (before + others + vertices > most || mesh.Triangles.size() / 3 + 2 * vertices > 2 * most)
  {
    throw Error("The mesh has no room for " + std::to_string(vertices) +
      " points of the boundary: at most " + std::to_string(most) +
      " points can be handled at once. Cut it into parts.");
  }
  if (vertices > 0)
  {
    // Each vertex adds two triangles, six half-edges. Exactly as much as needed: growth would take
    // more.
    mesh.Points.reserve(mesh.Points.size() + others + vertices);
    mesh.Triangles.reserve(mesh.Triangles.size() + 6 * vertices);
    mesh.Twins.reserve(mesh.Twins.size() + 6 * vertices);
  }
}

} // namespace elevation
