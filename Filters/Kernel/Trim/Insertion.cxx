// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Insertion.h"

#include "Crossings.h"
#include "Rings.h"
#include "Kernel/Base/Base.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <tuple>
#include <unordered_map>

namespace elevation
{

namespace
{

// ---------------------------------------------------------------------------------------- matching

/** A hash of a place that is well mixed in all bits. */
std::uint64_t Mix(const Point2& p)
{
  // 0.0 and -0.0 are equal, and go to the same place.
  const double coordinates[2] = { p.X + 0.0, p.Y + 0.0 };
  std::uint64_t bits[2];
  std::memcpy(bits, coordinates, sizeof(bits));
  const std::uint64_t mixed = (bits[0] * 0x9E3779B97F4A7C15ull) ^ bits[1];
  return (mixed ^ (mixed >> 32)) * 0xD6E8FEB86659FD93ull;
}

/**
 * The points that may be one of those added: all of these, and one in a hundred others. For to look
 * each up in a map is slow.
 */
class PointSieve
{
public:
  explicit PointSieve(std::size_t capacity)
  {
    while (this->Shift > 32 && (std::size_t(1) << (64 - this->Shift)) < 128 * capacity)
    {
      --this->Shift;
    }
    this->Words.resize((std::size_t(1) << (64 - this->Shift)) / 64);
  }
  void Add(const Point2& p)
  {
    const std::uint64_t place = Mix(p) >> this->Shift;
    this->Words[place / 64] |= std::uint64_t(1) << place % 64;
  }
  bool MayHold(const Point2& p) const
  {
    const std::uint64_t place = Mix(p) >> this->Shift;
    return this->Words[place / 64] >> place % 64 & 1;
  }

private:
  int Shift = 58;
  std::vector<std::uint64_t> Words;
};

// --------------------------------------------------------------------------------------- insertion

class Insertion
{
public:
  Insertion(Mesh& mesh, const NamedPoints& points, const Rings& rings, bool insert,
    InsertedRings& result)
    : Surface(mesh)
    , Points(points)
    , Given(rings)
    , MayInsert(insert)
    , Result(result)
    , CountBefore(mesh.NumberOfPoints())
    , TrianglesBefore(mesh.NumberOfTriangles())
  {
  }

  void Run(const Progress& progress)
  {
    CheckCrossings(this->Points, this->Given, Part(progress, 0.0, 0.1));
    this->MatchCorners(Part(progress, 0.1, 0.5));
    this->LocateOthers(Part(progress, 0.5, 0.75));
    this->InsertLocated(Part(progress, 0.75, 0.8));
    this->StartRings();
    // The pieces of an edge, and of a border, that has been cut at a rounded place are not quite
    // where they were: all are looked at again. As rounding rarely leads past anything, one round
    // more is the rule.
    constexpr int mostRounds = 100;
    bool isCut = this->CutAtBorder(Part(progress, 0.8, 1.0));
    for (int round = 1; isCut; ++round)
    {
      if (round == mostRounds)
      {
        throw Error("The boundary's edge " + this->NameOfEdge(this->EdgeOfCut) +
          " runs so near the border of the mesh that rounding does not let it be cut there. Let it "
          "pass through points of the mesh.");
      }
      const Progress again = Part(progress, 1.0, 1.0);
      isCut = this->CutAtEachOther(again) || this->CutAtBorder(again);
    }
    this->FinishRings();
  }

private:
  std::string NameOfEdge(std::size_t edge) const
  {
    return elevation::NameOfEdge(this->Points, this->Given, edge);
  }

  std::string NameOfVertex(Index vertex) const
  {
    const std::string name = NameOf(this->Surface, vertex);
    return vertex < this->CountBefore
      ? name + " of the mesh"
      : "where the boundary has cut it already" + name.substr(name.find(" ("));
  }

  /** Finds the corner of the mesh at each point of the rings. */
  void MatchCorners(const Progress& progress)
  {
    const Mesh& mesh = this->Surface;
    for (const Index point : this->Given.Vertices)
    {
      this->VertexAt.emplace(this->Points[point], None);
    }
    PointSieve sieve(this->VertexAt.size());
    for (const auto& entry : this->VertexAt)
    {
      sieve.Add(entry.first);
    }
    std::vector<char> isToMatch(mesh.Points.size());
    ForEachStretch(mesh.NumberOfPoints(), Part(progress, 0.0, 0.3), [&](Index begin, Index end) {
      for (Index v = begin; v < end; ++v)
      {
        isToMatch[v] = sieve.MayHold(mesh.PointOf(v));
      }
    });
    const Progress matching = Part(progress, 0.3, 1.0);
    for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
    {
      ReportStep(matching, h, mesh.Triangles.size());
      const Index vertex = mesh.Origin(h);
      if (!isToMatch[vertex])
      {
        continue;
      }
      isToMatch[vertex] = 0;
      const auto found = this->VertexAt.find(mesh.PointOf(vertex));
      if (found == this->VertexAt.end())
      {
        continue;
      }
      if (found->second != None)
      {
        throw Error("Points " + std::to_string(mesh.IdOf(std::min(found->second, vertex))) +
          " and " + std::to_string(mesh.IdOf(std::max(found->second, vertex))) +
          " of the mesh have the same x,y and both are corners of triangles, so that the "
          "boundary's point there is not one place of the mesh. Merge them, as "
          "vtkStaticCleanPolyData does.");
      }
      found->second = vertex;
    }
  }

  /** Finds the triangle at each point that is no corner. */
  void LocateOthers(const Progress& progress)
  {
    const Mesh& mesh = this->Surface;
    std::vector<Index> open; // ids of Points
    for (const Index point : this->Given.Vertices)
    {
      Index& vertex = this->VertexAt.at(this->Points[point]);
      if (vertex == None)
      {
        vertex = Outside;
        open.push_back(point);
      }
    }
    if (!open.empty() && this->MayInsert)
    {
      this->TakeInBorder(open, Part(progress, 0.0, 0.2));
    }
    if (open.empty())
    {
      return;
    }
    const Index count = static_cast<Index>(open.size());
    const auto pointOf = [&](Index i) { return this->Points[open[i]]; };
    const CellGrid grid(open.size(),
      [&](std::size_t i) { return std::array<Point2, 1>{ { this->Points[open[i]] } }; });
    std::vector<Index> triangles(open.size(), None);
    const Progress looking = Part(progress, 0.2, 1.0);
    ForEachStretch(mesh.NumberOfTriangles(), looking, [&](Index begin, Index end) {
      for (Index t = begin; t < end; ++t)
      {
        const std::size_t ahead = 3 * static_cast<std::size_t>(t) + HalfEdgesAhead;
        if (ahead + 2 < mesh.Triangles.size())
        {
          Prefetch(&mesh.Points[mesh.Triangles[ahead]]);
          Prefetch(&mesh.Points[mesh.Triangles[ahead + 1]]);
          Prefetch(&mesh.Points[mesh.Triangles[ahead + 2]]);
        }
        const std::array<Point2, 3> corners = this->CornersOf(t);
        grid.Visit(corners, [&](Index i) {
          if (triangles[i] == None && this->Holds(t, pointOf(i)))
          {
            triangles[i] = t;
          }
        });
      }
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
    this->Reserve(this->Located.size());
  }

  /** Room for so many more vertices. @throws Error when these are too many */
  void Reserve(std::size_t vertices)
  {
    constexpr std::size_t most = MaximumNumberOfPoints;
    const std::size_t before = this->Surface.IdOf(this->Surface.NumberOfPoints());
    if (before + this->VertexAt.size() + vertices > most ||
      this->Surface.Triangles.size() / 3 + 2 * vertices > 2 * most)
    {
      throw Error("The mesh has no room for " + std::to_string(vertices) +
        " points of the boundary: at most " + std::to_string(most) +
        " points can be handled at once. Cut it into parts.");
    }
    if (vertices > 0)
    {
      // Not more than that, as growing by halves would; the points outside come last.
      this->Surface.Points.reserve(this->Surface.Points.size() + this->VertexAt.size() + vertices);
      this->Surface.Triangles.reserve(this->Surface.Triangles.size() + 6 * vertices);
      this->Surface.Twins.reserve(this->Surface.Twins.size() + 6 * vertices);
    }
  }

  void InsertLocated(const Progress& progress)
  {
    // In an order that depends on nothing but the places, and has no order as seen in a triangle:
    // then lists of many points are halved or so by each.
    std::sort(this->Located.begin(), this->Located.end(), [&](const Place& a, const Place& b) {
      const Point2& p = this->Points[a.Point];
      const Point2& q = this->Points[b.Point];
      const std::uint64_t mixedP = Mix(p);
      const std::uint64_t mixedQ = Mix(q);
      return std::tie(a.Triangle, mixedP, p.X, p.Y) < std::tie(b.Triangle, mixedQ, q.X, q.Y);
    });
    // Weights in the triangles as they are now.
    std::unordered_map<Index, InsertedVertex> weights;
    std::vector<Index> work;
    for (const Place& place : this->Located)
    {
      weights[place.Point] = this->WeightsIn(place.Triangle, this->Points[place.Point]);
      std::vector<Index>& waiting = this->Waiting[place.Triangle];
      if (waiting.empty())
      {
        work.push_back(place.Triangle);
      }
      waiting.push_back(place.Point);
    }
    std::reverse(work.begin(), work.end());
    std::size_t done = 0;
    while (!work.empty())
    {
      const Index t = work.back();
      const auto found = this->Waiting.find(t);
      if (found == this->Waiting.end() || found->second.empty())
      {
        work.pop_back();
        continue;
      }
      ReportStep(progress, done++, this->Located.size(), 1024);
      const Index point = found->second.front();
      const Point2 p = this->Points[point];
      const Index vertex = this->AddVertex(p, weights.at(point));
      this->VertexAt.at(p) = vertex;
      Index on = None; // the edge that the point is on
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        if (Orientation(this->Surface.PointOf(this->Surface.Origin(h)),
              this->Surface.PointOf(this->Surface.Destination(h)), p) == Zero)
        {
          on = h;
        }
      }
      // The parts: this triangle, perhaps the one beyond the edge, and new ones.
      std::vector<Index> before{ t };
      if (on != None && !this->Surface.IsBorder(on))
      {
        before.push_back(Mesh::Triangle(this->Surface.Twin(on)));
      }
      std::vector<Index> parts = before;
      const Index firstNew = this->Surface.NumberOfTriangles();
      if (on == None)
      {
        this->CutTriangle(t, vertex);
      }
      else
      {
        this->CutEdge(on, vertex);
      }
      for (Index part = firstNew; part < this->Surface.NumberOfTriangles(); ++part)
      {
        parts.push_back(part);
      }
      std::vector<Index> moving;
      for (const Index part : before)
      {
        std::vector<Index>& waiting = this->Waiting[part];
        moving.insert(moving.end(), waiting.begin(), waiting.end());
        waiting.clear();
      }
      for (const Index other : moving)
      {
        if (other == point)
        {
          continue;
        }
        const Index part = *std::find_if(parts.begin(), parts.end(),
          [&](Index candidate) { return this->Holds(candidate, this->Points[other]); });
        this->Waiting[part].push_back(other);
      }
      for (const Index part : parts)
      {
        work.push_back(part);
      }
    }
  }

  Point2 PlaceOf(Index vertex) const
  {
    return vertex >= 0 ? this->Surface.PointOf(vertex) : this->OutsidePoints[FirstOutside - vertex];
  }

  /** The rings as given, by vertices; points outside the mesh have numbers below. */
  void StartRings()
  {
    for (const Index point : this->Given.Vertices)
    {
      Index& vertex = this->VertexAt.at(this->Points[point]);
      if (vertex == Outside)
      {
        vertex = FirstOutside - static_cast<Index>(this->OutsidePoints.size());
        this->OutsidePoints.push_back(this->Points[point]);
      }
      this->Pieces.push_back({ vertex, this->Pieces.size() });
    }
    this->Result.Vertices.Offsets = this->Given.Offsets;
  }

  /** The half-edges of the border, and their ends. */
  std::vector<Ends> FindBorder(std::vector<Index>& borders, const Progress& progress) const
  {
    const Mesh& mesh = this->Surface;
    std::vector<Ends> segments;
    ForEachStretch(mesh.NumberOfHalfEdges(), progress, [&](Index begin, Index end) {
      for (Index h = begin; h < end; ++h)
      {
        if (mesh.IsBorder(h))
        {
          borders.push_back(h);
          segments.push_back({ mesh.PointOf(mesh.Origin(h)), mesh.PointOf(mesh.Destination(h)) });
        }
      }
    });
    return segments;
  }

  /** The number that a half-edge of the border has after cuts; of its first part. */
  Index NowOf(Index h) const
  {
    for (auto next = this->Moved.find(h); next != this->Moved.end(); next = this->Moved.find(h))
    {
      h = next->second;
    }
    return h;
  }

  /**
   * Makes points of the rings that the border passes within rounding vertices of the border, where
   * they are: the border moves, by as little, rather than that a ring crosses it beside the point.
   */
  void TakeInBorder(std::vector<Index>& open, const Progress& progress)
  {
    Mesh& mesh = this->Surface;
    std::vector<Index> borders;
    const std::vector<Ends> segments = this->FindBorder(borders, progress);
    if (segments.empty())
    {
      return;
    }
    const CellGrid grid = GridOf(segments);
    double reach = 0.0; // of the longest coordinates
    for (const Ends& segment : segments)
    {
      const RoundingUnits units = UnitsOf(segment[0], segment[1]);
      reach = std::max({ reach, 2.0 * Reach * units.X, 2.0 * Reach * units.Y });
    }
    struct Taken
    {
      Index Border; // of borders
      Index Point;
    };
    std::vector<Taken> taken;
    std::vector<Index> others;
    for (const Index point : open)
    {
      const Point2 p = this->Points[point];
      Index border = None;
      bool isAlone = true; // where two run along each other, one would move into the other
      grid.Visit(
        Ends{ { { p.X - reach, p.Y - reach }, { p.X + reach, p.Y + reach } } }, [&](Index i) {
          const Ends& segment = segments[i];
          if (i != border &&
            IsInReach(segment[0], segment[1], UnitsOf(segment[0], segment[1]), Reach, p))
          {
            isAlone = isAlone && border == None;
            border = i;
          }
        });
      if (border != None && isAlone)
      {
        taken.push_back({ border, point });
      }
      else
      {
        others.push_back(point);
      }
    }
    this->Reserve(taken.size());
    // Along each border from its first end, as in CutAtBorder.
    std::sort(taken.begin(), taken.end(), [&](const Taken& a, const Taken& b) {
      const Ends& border = segments[a.Border];
      return a.Border != b.Border
        ? a.Border < b.Border
        : IsBefore(border[0], border[1], this->Points[a.Point], this->Points[b.Point]);
    });
    Index h = None;
    for (std::size_t i = 0; i < taken.size(); ++i)
    {
      if (i == 0 || taken[i - 1].Border != taken[i].Border)
      {
        h = this->NowOf(borders[taken[i].Border]);
      }
      const Point2 p = this->Points[taken[i].Point];
      const Index from = mesh.Origin(h), to = mesh.Destination(h);
      if (!this->CanCut(h, p))
      {
        others.push_back(taken[i].Point);
        continue;
      }
      const Index vertex = this->AddVertex(p, this->WeightsBetween(from, to, p));
      this->VertexAt.at(p) = vertex;
      h = this->CutEdge(h, vertex);
    }
    open = std::move(others);
  }

  /**
   * Gives vertices to the border where pieces of the rings cross it, and to the rings where they
   * run through the border's vertices. @return whether there was a crossing
   */
  bool CutAtBorder(const Progress& progress)
  {
    Mesh& mesh = this->Surface;
    const std::vector<Ends> pieces = this->EndsOfPieces();
    this->OnTheWay.clear();
    this->IsCut.clear();
    this->Moved.clear();
    std::vector<Index> borders;
    const std::vector<Ends> segments = this->FindBorder(borders, Part(progress, 0.0, 0.3));
    const CellGrid grid = GridOf(segments);
    struct Crossing
    {
      Index Border; // of borders
      Point2 Place;
      std::size_t Piece;
      bool IsBeyond; // the apex of the border's triangle
    };
    std::vector<Crossing> crossings;
    std::vector<std::size_t> lastSeen(segments.size(), pieces.size());
    const Progress looking = Part(progress, 0.3, 0.5);
    for (std::size_t i = 0; i < pieces.size(); ++i)
    {
      ReportStep(looking, i, pieces.size(), 1024);
      const Ends& edge = pieces[i];
      grid.Visit(edge, [&](Index border) {
        if (lastSeen[border] == i)
        {
          return;
        }
        lastSeen[border] = i;
        const Ends& segment = segments[border];
        if (Cross(edge, segment))
        {
          if (!this->PassEnds(i, edge, segment, borders[border]))
          {
            const Point2 place = RoundedCrossing(segment[0], segment[1], edge[0], edge[1]);
            const Point2& apex = mesh.PointOf(mesh.Apex(borders[border]));
            crossings.push_back(
              { border, place, i, IsBefore(segment[0], segment[1], apex, place) });
          }
        }
        else if (IsInside(edge, segment[0]))
        {
          this->AddStop(i, edge, borders[border], mesh.Origin(borders[border]));
        }
        else if (this->MayInsert && IsInside(segment, edge[0]))
        {
          // Otherwise it would have become a vertex of this border.
          this->RefuseDoubleBorder(this->Pieces[i].Edge, edge[0]);
        }
      });
    }
    if (!crossings.empty() && !this->MayInsert)
    {
      throw Error("The boundary's edge " +
        this->NameOfEdge(this->Pieces[crossings.front().Piece].Edge) +
        " leaves the mesh where it has no corner. Turn RecoverBoundary on.");
    }
    this->Reserve(crossings.size());

    // Along each border from both its ends to the apex: then the part to cut next is the one that
    // is beside the apex, and however thin its triangle is, outwards is room.
    std::sort(crossings.begin(), crossings.end(), [&](const Crossing& a, const Crossing& b) {
      const Ends& border = segments[a.Border];
      return a.Border != b.Border  ? a.Border < b.Border
        : a.IsBeyond != b.IsBeyond ? b.IsBeyond
        : a.Place != b.Place       ? IsBefore(border[0], border[1], a.Place, b.Place) != a.IsBeyond
                                   : a.Piece < b.Piece;
    });
    Index h = None, last = None; // and the vertex of the crossing before
    for (std::size_t i = 0; i < crossings.size(); ++i)
    {
      const Crossing& crossing = crossings[i];
      if (i == 0 || crossings[i - 1].Border != crossing.Border)
      {
        h = this->NowOf(borders[crossing.Border]);
        last = None;
      }
      const bool isSamePlace = last != None && crossings[i - 1].Place == crossing.Place;
      const Index from = mesh.Origin(h), to = mesh.Destination(h);
      Index vertex = isSamePlace               ? last
        : crossing.Place == mesh.PointOf(from) ? from
        : crossing.Place == mesh.PointOf(to)   ? to
                                               : None;
      Point2 place = crossing.Place;
      if (vertex == None && !this->MoveToCut(h, place))
      {
        throw Error("The boundary's edge " + this->NameOfEdge(this->Pieces[crossing.Piece].Edge) +
          " leaves the mesh across a triangle too thin to be cut there, between " +
          this->NameOfVertex(from) + " and " + this->NameOfVertex(to) +
          ". Let the boundary pass through one of them.");
      }
      if (vertex == None)
      {
        vertex = this->AddVertex(place, this->WeightsBetween(from, to, place));
        const Index after = this->CutEdge(h, vertex);
        h = crossing.IsBeyond ? h : after;
      }
      last = vertex;
      this->AddStop(crossing.Piece, pieces[crossing.Piece], h, vertex);
      this->IsCut.push_back(crossing.Piece);
      this->EdgeOfCut = this->Pieces[crossing.Piece].Edge;
    }
    this->FindOnTheWay(pieces, Part(progress, 0.5, 1.0));
    this->CutPieces(pieces);
    return !this->IsCut.empty();
  }

  /**
   * Pieces that moved may cross others that run along them within rounding: leads them through an
   * end of these. @return whether there were such
   */
  bool CutAtEachOther(const Progress& progress)
  {
    const std::vector<Ends> pieces = this->EndsOfPieces();
    const CellGrid grid = GridOf(pieces);
    this->OnTheWay.clear();
    std::size_t last = 0; // piece that is cut
    const auto cut = [&](std::size_t i, std::size_t j) {
      const RoundingUnits units = UnitsOf(pieces[i][0], pieces[i][1]);
      for (const int end : { 0, 1 })
      {
        if (IsInReach(pieces[i][0], pieces[i][1], units, Reach, pieces[j][end]))
        {
          const Index at = end == 0 ? static_cast<Index>(j) : this->NextOf(static_cast<Index>(j));
          this->OnTheWay.push_back({ i, this->Pieces[at].Vertex, true, true });
          last = std::max(last, i);
        }
      }
    };
    VisitCrossings(pieces, grid, progress, [&](std::size_t i, std::size_t j) {
      cut(i, j);
      cut(j, i);
    });
    if (!this->OnTheWay.empty())
    {
      this->EdgeOfCut = this->Pieces[last].Edge;
    }
    this->CutPieces(pieces);
    return !this->OnTheWay.empty();
  }

  /**
   * Leads a piece that crosses the border through an end of the border's edge that is in reach.
   * @return whether there is one
   */
  bool PassEnds(std::size_t piece, const Ends& edge, const Ends& segment, Index h)
  {
    const RoundingUnits units = UnitsOf(edge[0], edge[1]);
    bool isInReach = false;
    for (const int end : { 0, 1 })
    {
      if (IsInReach(edge[0], edge[1], units, Reach, segment[end]))
      {
        this->AddStop(
          piece, edge, h, end == 0 ? this->Surface.Origin(h) : this->Surface.Destination(h));
        isInReach = true;
      }
    }
    if (isInReach)
    {
      this->IsCut.push_back(piece);
      this->EdgeOfCut = this->Pieces[piece].Edge;
    }
    return isInReach;
  }

  /** A vertex on the way of a piece that has these ends; it is an end of h. */
  void AddStop(std::size_t piece, const Ends& ends, Index h, Index vertex)
  {
    h = this->Surface.Origin(h) == vertex ? h : Mesh::Next(h);
    this->OnTheWay.push_back(
      { piece, vertex, this->IsInFan(h, ends[0]), this->IsInFan(h, ends[1]) });
  }

  /** Whether the way from the origin of h to a point begins in a triangle of the fan around it. */
  bool IsInFan(Index h, const Point2& p) const
  {
    const Mesh& mesh = this->Surface;
    const Point2& from = mesh.PointOf(mesh.Origin(h));
    const auto isIn = [&](Index k) {
      return Orientation(from, mesh.PointOf(mesh.Destination(k)), p) != Negative &&
        Orientation(from, p, mesh.PointOf(mesh.Apex(k))) != Negative;
    };
    Index k = h;
    do
    {
      if (isIn(k))
      {
        return true;
      }
      k = mesh.Twin(Mesh::Next(Mesh::Next(k)));
    } while (k != Mesh::Border && k != h);
    // The rest, the other way.
    while (k == Mesh::Border && !mesh.IsBorder(h))
    {
      h = Mesh::Next(mesh.Twin(h));
      if (isIn(h))
      {
        return true;
      }
    }
    return false;
  }

  /** The piece after a piece on its ring. */
  Index NextOf(Index piece) const
  {
    const std::vector<Index>& offsets = this->Result.Vertices.Offsets;
    const auto end = std::upper_bound(offsets.begin(), offsets.end(), piece);
    return piece + 1 == *end ? *(end - 1) : piece + 1;
  }

  /** From each of the rings' vertices to the next. */
  std::vector<Ends> EndsOfPieces() const
  {
    std::vector<Ends> ends;
    ends.reserve(this->Pieces.size());
    for (Index i = 0; i < static_cast<Index>(this->Pieces.size()); ++i)
    {
      ends.push_back({ this->PlaceOf(this->Pieces[i].Vertex),
        this->PlaceOf(this->Pieces[this->NextOf(i)].Vertex) });
    }
    return ends;
  }

  /**
   * Of pieces that cross the border, finds the vertices they run through exactly: the part up to a
   * crossing, whose place is rounded, would pass beside them.
   */
  void FindOnTheWay(const std::vector<Ends>& pieces, const Progress& progress)
  {
    if (this->IsCut.empty())
    {
      return;
    }
    const Mesh& mesh = this->Surface;
    std::sort(this->IsCut.begin(), this->IsCut.end());
    this->IsCut.erase(std::unique(this->IsCut.begin(), this->IsCut.end()), this->IsCut.end());
    std::vector<Ends> segments;
    for (const std::size_t piece : this->IsCut)
    {
      segments.push_back(pieces[piece]);
    }
    const CellGrid grid = GridOf(segments);
    std::unordered_map<Index, std::vector<Index>> segmentsThrough;
    std::vector<char> isOn(mesh.Points.size(), 0);
    ForEachStretch(mesh.NumberOfPoints(), Part(progress, 0.0, 0.5), [&](Index begin, Index end) {
      for (Index v = begin; v < end; ++v)
      {
        const Point2& p = mesh.PointOf(v);
        grid.Visit(p, [&](Index i) {
          if (IsInside(segments[i], p))
          {
            isOn[v] = 1;
            segmentsThrough[v].push_back(i);
          }
        });
      }
    });
    if (segmentsThrough.empty())
    {
      return;
    }
    // Points that no triangle uses do not count.
    ForEachStretch(mesh.NumberOfHalfEdges(), Part(progress, 0.5, 1.0), [&](Index begin, Index end) {
      for (Index h = begin; h < end; ++h)
      {
        const Index v = mesh.Origin(h);
        if (isOn[v])
        {
          isOn[v] = 0;
          for (const Index i : segmentsThrough.at(v))
          {
            this->AddStop(this->IsCut[i], segments[i], h, v);
          }
        }
      }
    });
  }

  /** Cuts the pieces where vertices are on their way. */
  void CutPieces(const std::vector<Ends>& pieces)
  {
    const Mesh& mesh = this->Surface;
    std::sort(this->OnTheWay.begin(), this->OnTheWay.end(), [&](const Stop& a, const Stop& b) {
      if (a.Piece != b.Piece)
      {
        return a.Piece < b.Piece;
      }
      const Ends& piece = pieces[a.Piece];
      const Point2 p = this->PlaceOf(a.Vertex), q = this->PlaceOf(b.Vertex);
      // At one place a part of the mesh is left before another one is entered.
      return IsBefore(piece[0], piece[1], p, q) ||
        (p == q &&
          std::make_tuple(a.Into - a.From, a.Vertex) < std::make_tuple(b.Into - b.From, b.Vertex));
    });
    std::vector<Piece> cut;
    cut.reserve(this->Pieces.size() + this->OnTheWay.size());
    auto stop = this->OnTheWay.begin();
    std::vector<Index> offsets{ 0 };
    const std::vector<Index>& before = this->Result.Vertices.Offsets;
    for (std::size_t ring = 0; ring + 1 < before.size(); ++ring)
    {
      const Stop* last = nullptr; // none: a vertex of the ring before
      const auto add = [&](const Piece& piece, const Stop* at) {
        if (cut.size() > static_cast<std::size_t>(offsets.back()))
        {
          const Index vertex = cut.back().Vertex;
          if (vertex == piece.Vertex)
          {
            cut.pop_back(); // it leads nowhere
          }
          else if ((last || at) && vertex >= 0 && piece.Vertex >= 0 &&
            mesh.PointOf(vertex) == mesh.PointOf(piece.Vertex) &&
            (!last || !at || last->Into || at->From))
          {
            this->RefuseDoubleBorder(piece.Edge, mesh.PointOf(vertex));
          }
        }
        cut.push_back(piece);
        last = at;
      };
      for (Index i = before[ring]; i < before[ring + 1]; ++i)
      {
        Piece piece = this->Pieces[i];
        add(piece, nullptr);
        for (; stop != this->OnTheWay.end() && stop->Piece == static_cast<std::size_t>(i); ++stop)
        {
          piece.Vertex = stop->Vertex;
          add(piece, &*stop);
        }
      }
      offsets.push_back(static_cast<Index>(cut.size()));
    }
    this->Pieces = std::move(cut);
    this->Result.Vertices.Offsets = std::move(offsets);
  }

  [[noreturn]] void RefuseDoubleBorder(std::size_t edge, const Point2& p) const
  {
    const std::string name = NameOf(None, p);
    throw Error("The boundary's edge " + this->NameOfEdge(edge) + " passes" +
      name.substr(name.find(" (")) +
      ", where borders of the mesh lie on each other without points in common. Merge the points, "
      "as "
      "vtkStaticCleanPolyData does.");
  }

  /** The points outside the mesh become its last ones. */
  void FinishRings()
  {
    Mesh& mesh = this->Surface;
    const Index first = mesh.NumberOfPoints();
    mesh.Points.insert(mesh.Points.end(), this->OutsidePoints.begin(), this->OutsidePoints.end());
    for (const Piece& piece : this->Pieces)
    {
      this->Result.Vertices.Vertices.push_back(
        piece.Vertex >= 0 ? piece.Vertex : first + (FirstOutside - piece.Vertex));
    }
  }

  // --------------------------------------------------------------------------------------- cutting

  std::array<Point2, 3> CornersOf(Index t) const
  {
    const Mesh& mesh = this->Surface;
    return { { mesh.PointOf(mesh.Origin(3 * t)), mesh.PointOf(mesh.Origin(3 * t + 1)),
      mesh.PointOf(mesh.Origin(3 * t + 2)) } };
  }

  /** Whether the point is in the triangle or on an edge of it. */
  bool Holds(Index t, const Point2& p) const
  {
    const std::array<Point2, 3> corners = this->CornersOf(t);
    return Orientation(corners[0], corners[1], p) != Negative &&
      Orientation(corners[1], corners[2], p) != Negative &&
      Orientation(corners[2], corners[0], p) != Negative;
  }

  /** Whether the triangle of h leaves two triangles when its edge is led through the place. */
  bool CanCut(Index h, const Point2& place) const
  {
    const Point2& apex = this->Surface.PointOf(this->Surface.Apex(h));
    return Orientation(this->Surface.PointOf(this->Surface.Origin(h)), place, apex) == Positive &&
      Orientation(place, this->Surface.PointOf(this->Surface.Destination(h)), apex) == Positive;
  }

  /**
   * Moves a place on the border, within rounding, to where the triangle of h can be cut: rounded,
   * it may be beyond a thin triangle. Outwards is room where the apex is beside the place.
   * @return whether one was found
   */
  bool MoveToCut(Index h, Point2& place) const
  {
    const Point2& from = this->Surface.PointOf(this->Surface.Origin(h));
    const Point2 way = Around(
      from, std::array<Point2, 1>{ { this->Surface.PointOf(this->Surface.Destination(h)) } })[0];
    const double length = std::hypot(way.X, way.Y);
    const double step =
      std::numeric_limits<double>::epsilon() * std::max(std::fabs(place.X), std::fabs(place.Y));
    const Point2 outwards{ step * (way.Y / length), -step * (way.X / length) };
    const Point2 first = place;
    const auto isFound = [&](double dx, double dy) {
      place = { first.X + dx, first.Y + dy };
      return std::isfinite(place.X) && std::isfinite(place.Y) && this->CanCut(h, place);
    };
    // The nearest ones, from the middle out, then further outwards.
    for (int ring = 0; ring <= 3; ++ring)
    {
      for (int i = -ring; i <= ring; ++i)
      {
        for (int j = -ring; j <= ring; ++j)
        {
          if (std::max(std::abs(i), std::abs(j)) == ring && isFound(0.5 * i * step, 0.5 * j * step))
          {
            return true;
          }
        }
      }
    }
    for (double steps = 4.0; steps <= 64.0; steps *= 2.0)
    {
      if (isFound(steps * outwards.X, steps * outwards.Y))
      {
        return true;
      }
    }
    return false;
  }

  /** Points as seen from one, at a scale where products and sums stay in the range of double. */
  template <std::size_t Count>
  static std::array<Point2, Count> Around(const Point2& from, std::array<Point2, Count> points)
  {
    double largest = std::max(std::fabs(from.X), std::fabs(from.Y));
    for (const Point2& p : points)
    {
      largest = std::max({ largest, std::fabs(p.X), std::fabs(p.Y) });
    }
    const double scale = ScaleToOne(largest);
    for (Point2& p : points)
    {
      p = { p.X * scale - from.X * scale, p.Y * scale - from.Y * scale };
    }
    return points;
  }

  /** The weights of a place in a triangle, of which corners may be new vertices themselves. */
  InsertedVertex WeightsIn(Index t, const Point2& p) const
  {
    const std::array<Point2, 3> corners = this->CornersOf(t), around = Around(p, corners);
    std::array<std::pair<Index, double>, 3> shares;
    for (int i = 0; i < 3; ++i)
    {
      const int next = (i + 1) % 3, last = (i + 2) % 3;
      // On an edge, rounding must not bring in the corner beyond.
      shares[i] = { this->Surface.Origin(3 * t + i),
        Orientation(corners[next], corners[last], p) == Zero
          ? 0.0
          : std::fabs(around[next].X * around[last].Y - around[next].Y * around[last].X) };
    }
    return this->WeightsOf(shares.data(), shares.size());
  }

  /** The weights of a place on an edge, or so near that it is made one of it. */
  InsertedVertex WeightsBetween(Index a, Index b, const Point2& p) const
  {
    const std::array<Point2, 2> ends =
      Around(p, Ends{ { this->Surface.PointOf(a), this->Surface.PointOf(b) } });
    const std::array<std::pair<Index, double>, 2> shares{ { { a, std::hypot(ends[1].X, ends[1].Y) },
      { b, std::hypot(ends[0].X, ends[0].Y) } } };
    return this->WeightsOf(shares.data(), shares.size());
  }

  /** Of vertices that may be new themselves, all on one triangle before, which has three corners. */
  InsertedVertex WeightsOf(const std::pair<Index, double>* shares, std::size_t count) const
  {
    InsertedVertex vertex{ { None, None, None }, { 0.0, 0.0, 0.0 } };
    double sum = 0.0;
    const auto add = [&](Index corner, double weight) {
      if (weight > 0.0)
      {
        int i = 0;
        while (i < 2 && vertex.Corners[i] != corner && vertex.Corners[i] != None)
        {
          ++i;
        }
        vertex.Corners[i] = corner;
        vertex.Weights[i] += weight;
        sum += weight;
      }
    };
    // Where a triangle is so small or thin that all shares vanish, its corners count alike.
    for (int attempt = 0; attempt < 2 && vertex.Corners[0] == None; ++attempt)
    {
      for (std::size_t k = 0; k < count; ++k)
      {
        const Index corner = shares[k].first;
        const double share = attempt == 0 ? shares[k].second : 1.0;
        if (corner < this->CountBefore)
        {
          add(corner, share);
          continue;
        }
        const InsertedVertex& inserted = this->Result.Inserted[corner - this->CountBefore];
        for (int i = 0; i < 3; ++i)
        {
          add(inserted.Corners[i], share * inserted.Weights[i]);
        }
      }
    }
    for (Index& corner : vertex.Corners)
    {
      corner = corner == None ? vertex.Corners[0] : corner;
    }
    return Normalized(vertex, sum);
  }

  static InsertedVertex Normalized(InsertedVertex vertex, double sum)
  {
    const bool isUsable = sum > 0.0 && sum < std::numeric_limits<double>::infinity();
    for (double& weight : vertex.Weights)
    {
      // A triangle too thin for the range of double has no ratios.
      weight = isUsable ? weight / sum : 1.0 / 3.0;
    }
    return vertex;
  }

  Index AddVertex(const Point2& p, const InsertedVertex& inserted)
  {
    this->Surface.Points.push_back(p);
    this->Result.Inserted.push_back(inserted);
    return this->Surface.NumberOfPoints() - 1;
  }

  /** Room for a part of a triangle. @return its first half-edge */
  Index AddPart(Index t)
  {
    Mesh& mesh = this->Surface;
    this->Result.Parents.push_back(
      t < this->TrianglesBefore ? t : this->Result.Parents[t - this->TrianglesBefore]);
    mesh.Triangles.resize(mesh.Triangles.size() + 3, None);
    mesh.Twins.resize(mesh.Twins.size() + 3, Mesh::Border);
    return mesh.NumberOfHalfEdges() - 3;
  }

  void SetEdge(Index h, Index origin, Index twin)
  {
    this->Surface.Triangles[h] = origin;
    this->Surface.Twins[h] = twin;
    if (twin != Mesh::Border)
    {
      this->Surface.Twins[twin] = h;
    }
  }

  /** Triangle abc becomes abv, and bcv and cav are new. */
  void CutTriangle(Index t, Index v)
  {
    Mesh& mesh = this->Surface;
    const Index b = mesh.Origin(3 * t + 1);
    const Index c = mesh.Origin(3 * t + 2);
    const Index a = mesh.Origin(3 * t);
    const Index first = this->AddPart(t);
    const Index second = this->AddPart(t);
    this->SetEdge(first, b, mesh.Twin(3 * t + 1));
    this->SetEdge(second, c, mesh.Twin(3 * t + 2));
    this->SetEdge(3 * t + 1, b, first + 2);
    this->SetEdge(3 * t + 2, v, second + 1);
    this->SetEdge(first + 1, c, second + 2);
    this->SetEdge(first + 2, v, 3 * t + 1);
    this->SetEdge(second + 1, a, 3 * t + 2);
    this->SetEdge(second + 2, v, first + 1);
  }

  /** Cuts the triangles beside an edge. @return the half-edge from v to where h led */
  Index CutEdge(Index h, Index v)
  {
    Mesh& mesh = this->Surface;
    const Index twin = mesh.Twin(h);
    const Index after = this->Halve(h, v);
    if (twin != Mesh::Border)
    {
      const Index afterTwin = this->Halve(twin, v);
      this->SetEdge(h, mesh.Origin(h), afterTwin);
      this->SetEdge(twin, mesh.Origin(twin), after);
    }
    return after;
  }

  /** Triangle abc with h from a to b becomes avc, and vbc is new; not connected along h. */
  Index Halve(Index h, Index v)
  {
    Mesh& mesh = this->Surface;
    const Index next = Mesh::Next(h);
    const Index b = mesh.Origin(next);
    const Index c = mesh.Apex(h);
    const Index part = this->AddPart(Mesh::Triangle(h));
    if (mesh.IsBorder(next))
    {
      this->Moved[next] = part + 1;
    }
    this->SetEdge(part, v, Mesh::Border);
    this->SetEdge(part + 1, b, mesh.Twin(next));
    this->SetEdge(part + 2, c, next);
    this->Surface.Triangles[next] = v;
    return part;
  }

  /** In units in the last place: how near the border and a ring take on each other's vertices. */
  static constexpr double Reach = 4.0;

  /** In place of a vertex: of a point outside the mesh, at first, and the first of such. */
  static constexpr Index Outside = -2;
  static constexpr Index FirstOutside = -3;

  struct Place
  {
    Index Triangle;
    Index Point;
  };
  /** A piece of an edge of the rings, up to the next piece. */
  struct Piece
  {
    Index Vertex;     ///< where it begins
    std::size_t Edge; ///< of the given ones
  };
  /** A vertex that a piece runs through. */
  struct Stop
  {
    std::size_t Piece;
    Index Vertex;
    bool From; ///< whether it comes to the vertex in triangles of it,
    bool Into; ///< and goes on in such
  };

  Mesh& Surface;
  const NamedPoints& Points;
  const Rings& Given;
  const bool MayInsert;
  InsertedRings& Result;
  const Index CountBefore;
  const Index TrianglesBefore;
  std::unordered_map<Point2, Index, HashOfPoint> VertexAt;
  std::vector<Place> Located;
  std::unordered_map<Index, std::vector<Index>> Waiting; ///< by triangle: points to be inserted
  std::unordered_map<Index, Index> Moved; ///< half-edges of the border that a cut renumbered
  std::vector<Point2> OutsidePoints;
  std::vector<Piece> Pieces; ///< one after another along each ring
  std::vector<Stop> OnTheWay;
  std::vector<std::size_t> IsCut; ///< pieces that cross the border
  std::size_t EdgeOfCut = 0;      ///< the edge of one of them
};

} // namespace

InsertedRings InsertRings(Mesh& mesh, const NamedPoints& points, const Rings& rings, bool insert,
  const Progress& progress)
{
  InsertedRings result;
  Insertion(mesh, points, rings, insert, result).Run(progress);
  return result;
}

} // namespace elevation
