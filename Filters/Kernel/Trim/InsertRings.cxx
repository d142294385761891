// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// InsertRings.h lists the passes: CheckCrossings() is pass 1, InsertRingPoints() 2 and 3,
// CutAtBorder() 4; FollowSurface() threads what pass 5 inserts into the rings.
//
// During the work a ring is a list of pieces. A piece is the part of one edge of the given rings
// from one vertex to the next. Pieces are cut at stops into more pieces, and remember the edge that
// was given, which messages name. Numbers of vertices:
//
//   0, 1, ...     vertices of the mesh, given and new
//   -3, -4, ...   points of the rings outside the mesh, from FirstOutside down; in the end they are
//                 appended to the mesh's points and get numbers like these
#include "InsertRings.h"

#include "CutAlongRings.h"
#include "InsertRingPoints.h"
#include "Kernel/Base/Base.h"
#include "RingCrossings.h"
#include "Rings.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <unordered_map>

namespace elevation
{

namespace
{

/** The work of InsertRings() on one mesh. Its members are the rings while they are cut. */
class Insertion
{
public:
  Insertion(Mesh& mesh, const NamedPoints& points, const Rings& rings, bool insert,
    Following follow, InsertedRings& result)
    : Surface(mesh)
    , Points(points)
    , Drawn(rings)
    , MayInsert(insert)
    , Follow(insert ? follow : Following::None)
    , Result(result)
    , Cutter(mesh, result.Inserted, result.Parents)
  {
  }

  void Run(const Progress& progress)
  {
    const bool follows = this->Follow != Following::None;
    Stages stages(progress, { 10, 70, follows ? 10.0 : 20.0, 0, follows ? 10.0 : 0.0 });
    const Progress checking = stages.Next();
    // Lines may cross: what comes later cuts what is there already, as it cuts any edge of the
    // mesh.
    if (this->Follow != Following::Lines)
    {
      CheckCrossings(this->Points, this->Drawn, checking);
    }
    this->VertexAt = InsertRingPoints(this->Surface, this->Points, this->Drawn, this->MayInsert,
      follows, this->Cutter, stages.Next());
    // Every point of the rings is now a vertex, or known to be outside.
    this->StartRings();
    // An edge or a border that is cut at a rounded place moves slightly: all are tested again. As
    // the move rarely causes a crossing, one more round is usually enough. The limit turns a search
    // without end, which nothing excludes, into an error.
    constexpr int mostRounds = 100;
    bool isCut = this->CutAtBorder(stages.Next());
    const Progress again = stages.Next(); // no share, as more rounds are rare
    for (int round = 1; isCut; ++round)
    {
      if (round == mostRounds)
      {
        throw Error("The boundary's edge " + this->EdgeName(this->EdgeOfCut) +
          " runs so near the border of the mesh that rounding does not let it be cut there. Let it "
          "pass through points of the mesh.");
      }
      isCut = this->CutAtEachOther(again) || this->CutAtBorder(again);
    }
    if (follows)
    {
      this->FollowPieces(stages.Next());
    }
    // Points outside come last: no vertex may be added after them, or the numbers of vertices would
    // not be those of Result.Inserted.
    this->FinishRings();
  }

private:
  /** A piece of an edge of the rings; it ends where the next piece begins. */
  struct Piece
  {
    Index Vertex;     ///< where it begins
    std::size_t Edge; ///< of the given rings
  };
  /** A vertex that a piece runs through. */
  struct Stop
  {
    std::size_t Piece;
    Index Vertex;
    bool From; ///< whether the piece arrives through a triangle at the vertex
    bool Into; ///< whether it leaves through one
  };

  /** A crossing of a piece with the border between two vertices. */
  struct BorderCrossing
  {
    Index Border; ///< index in BorderEdges
    Point2 Position;
    std::size_t Piece;
    bool IsBeyond; ///< whether it is past the foot of the triangle's apex, along the border
  };

  std::string EdgeName(std::size_t edge) const
  {
    return elevation::EdgeName(this->Points, this->Drawn, edge);
  }

  std::string VertexName(Index vertex) const
  {
    return this->Cutter.IsGiven(vertex)
      ? NameOf(this->Surface, vertex) + " of the mesh"
      : "where the boundary has cut it already " + NameOf(this->Surface.PointOf(vertex));
  }

  Point2 PlaceOf(Index vertex) const
  {
    return vertex >= 0 ? this->Surface.PointOf(vertex) : this->OutsidePoints[FirstOutside - vertex];
  }

  /** The given rings as vertices; points outside the mesh get numbers from FirstOutside down. */
  void StartRings()
  {
    // Points of the rings at one place share a vertex, or one number outside.
    for (const Index point : this->Drawn.Vertices)
    {
      Index& vertex = this->VertexAt.at(this->Points[point]);
      if (vertex == OutsideMesh)
      {
        vertex = FirstOutside - static_cast<Index>(this->OutsidePoints.size());
        this->OutsidePoints.push_back(this->Points[point]);
      }
      this->Pieces.push_back({ vertex, this->Pieces.size() });
    }
    this->Result.Vertices.Offsets = this->Drawn.Offsets;
  }

  /**
   * Cuts the border where pieces of the rings cross it, and the pieces there and at the vertices
   * that they run through. @return whether there was a crossing
   */
  bool CutAtBorder(const Progress& progress)
  {
    Stages stages(progress, { 30, 20, 50 });
    // All pieces are tested against the border as it is now: those of the last round have moved it.
    const std::vector<Ends> pieces = this->PieceEnds();
    this->Stops.clear();
    this->IsCut.clear();
    this->Cutter.ForgetMoves();
    const BorderEdges border = FindBorder(this->Surface, stages.Next());
    std::vector<BorderCrossing> crossings =
      this->FindBorderCrossings(pieces, border, stages.Next());
    if (!crossings.empty() && !this->MayInsert)
    {
      throw Error("The boundary's edge " +
        this->EdgeName(this->Pieces[crossings.front().Piece].Edge) +
        " leaves the mesh where it has no corner. Turn RecoverBoundary on.");
    }
    // In this order: crossings become vertices, then vertices on pieces are found, the new ones
    // among them, then the pieces are cut at all of these.
    this->CutBorder(crossings, pieces, border);
    this->FindStops(pieces, stages.Next());
    this->CutPieces(pieces);
    return !this->IsCut.empty();
  }

  /** Finds where pieces cross the border between vertices. Vertices that they meet become stops. */
  std::vector<BorderCrossing> FindBorderCrossings(
    const std::vector<Ends>& pieces, const BorderEdges& border, const Progress& progress)
  {
    const Mesh& mesh = this->Surface;
    std::vector<BorderCrossing> crossings;
    // The grid shows a border edge once for each cell that it shares with a piece.
    std::vector<std::size_t> lastSeen(border.Segments.size(), pieces.size());
    for (const std::size_t i : Counted(pieces.size()))
    {
      ReportStep(progress, i, pieces.size(), 1024);
      const Ends& edge = pieces[i];
      border.Grid.Visit(edge, [&](Index k) {
        if (lastSeen[k] == i)
        {
          return;
        }
        lastSeen[k] = i;
        const Ends& segment = border.Segments[k];
        const Index h = border.HalfEdges[k];
        if (AreCrossing(edge, segment))
        {
          // Through an end of the border edge instead, if one is in reach.
          const bool isInReach =
            VisitEndsInReach(segment, edge, UnitsOf(edge[0], edge[1]), SnappingReach, [&](int end) {
              this->AddStop(i, edge, h, end == 0 ? mesh.Origin(h) : mesh.Destination(h));
            });
          if (isInReach)
          {
            this->IsCut.push_back(i);
            return;
          }
          const Point2 place = RoundedCrossing(segment[0], segment[1], edge[0], edge[1]);
          // Where along the border the triangle's apex is: on which side of it a place can move
          // outwards. See CutBorder().
          crossings.push_back(
            { k, place, i, IsBefore(segment[0], segment[1], mesh.PointOf(mesh.Apex(h)), place) });
        }
        else if (IsInside(edge, segment[0]))
        {
          // Only the origin: each vertex of the border is the origin of one border edge.
          this->AddStop(i, edge, h, mesh.Origin(h));
        }
        else if (this->MayInsert && IsInside(segment, edge[0]))
        {
          // It would be a vertex of this border, if another one were not in reach.
          this->RefuseDoubleBorder(this->Pieces[i].Edge, edge[0]);
        }
      });
    }
    return crossings;
  }

  /** Cuts the border at crossings, which become stops of their pieces. */
  void CutBorder(std::vector<BorderCrossing>& crossings, const std::vector<Ends>& pieces,
    const BorderEdges& border)
  {
    //              apex
    //            _/    \         Crossings a and b are before the apex's foot (:), c and d
    //         _/        \        beyond it. The order is a b d c. A cut makes two triangles;
    //      _/            \       h is the border edge of the one with the foot, where the
    //     +--a--b--:--c---d-+    next cut comes. The others may be needles.
    ReserveVertices(this->Surface, this->VertexAt.size(), crossings.size());
    // Along each border edge from both ends towards the foot of the apex. The part that is cut next
    // is then at the foot, where a place can move outwards however thin the triangle is.
    std::sort(
      crossings.begin(), crossings.end(), [&](const BorderCrossing& a, const BorderCrossing& b) {
        const Ends& ends = border.Segments[a.Border];
        return a.Border != b.Border  ? a.Border < b.Border
          : a.IsBeyond != b.IsBeyond ? b.IsBeyond
          : a.Position != b.Position
          ? IsBefore(ends[0], ends[1], a.Position, b.Position) != a.IsBeyond
          : a.Piece < b.Piece;
      });
    const Mesh& mesh = this->Surface;
    Index h = None;
    Index last = None; // the vertex of the previous crossing
    for (std::size_t i = 0; i < crossings.size(); ++i)
    {
      const BorderCrossing& crossing = crossings[i];
      if (i == 0 || crossings[i - 1].Border != crossing.Border)
      {
        h = this->Cutter.CurrentHalfEdge(border.HalfEdges[crossing.Border]);
        last = None;
      }
      // Two pieces may cross the border at one rounded place: one vertex serves both.
      const bool isSamePosition = last != None && crossings[i - 1].Position == crossing.Position;
      const Index from = mesh.Origin(h), to = mesh.Destination(h);
      Index vertex = isSamePosition               ? last
        : crossing.Position == mesh.PointOf(from) ? from
        : crossing.Position == mesh.PointOf(to)   ? to
                                                  : None;
      Point2 place = crossing.Position;
      if (vertex == None && !this->Cutter.MoveToCut(h, place))
      {
        throw Error("The boundary's edge " + this->EdgeName(this->Pieces[crossing.Piece].Edge) +
          " leaves the mesh across a triangle too thin to be cut there, between " +
          this->VertexName(from) + " and " + this->VertexName(to) +
          ". Let the boundary pass through one of them.");
      }
      if (vertex == None)
      {
        vertex = this->Cutter.AddVertex(place, this->Cutter.WeightsBetween(from, to, place));
        const Index after = this->Cutter.CutEdge(h, vertex);
        // Before the foot the rest lies ahead of the new vertex; beyond it, behind.
        h = crossing.IsBeyond ? h : after;
      }
      last = vertex;
      this->AddStop(crossing.Piece, pieces[crossing.Piece], h, vertex);
      this->IsCut.push_back(crossing.Piece);
    }
  }

  /**
   * Pieces that moved may cross others that run along them within rounding: cuts them at an end of
   * these. @return whether any did
   */
  bool CutAtEachOther(const Progress& progress)
  {
    const std::vector<Ends> pieces = this->PieceEnds();
    this->Stops.clear();
    // Each of two pieces that cross is cut at an end of the other, where this is in reach.
    const auto cut = [&](std::size_t i, std::size_t j) {
      const RoundingUnits units = UnitsOf(pieces[i][0], pieces[i][1]);
      VisitEndsInReach(pieces[j], pieces[i], units, SnappingReach, [&](int end) {
        const Index at =
          end == 0 ? static_cast<Index>(j) : this->Result.Vertices.After(static_cast<Index>(j));
        // In the open plane or in the mesh alike, so both flags are set.
        this->Stops.push_back({ i, this->Pieces[at].Vertex, true, true });
      });
    };
    VisitCrossings(pieces, GridOf(pieces), progress, [&](std::size_t i, std::size_t j) {
      cut(i, j);
      cut(j, i);
    });
    this->CutPieces(pieces);
    return !this->Stops.empty();
  }

  /** @param[in] ends  of the piece @param[in] vertex  an end of h, on the piece */
  void AddStop(std::size_t piece, const Ends& ends, Index h, Index vertex)
  {
    // Of an end of h, the half-edge that leaves it, from which its fan can be visited.
    h = this->Surface.Origin(h) == vertex ? h : Mesh::Next(h);
    this->Stops.push_back({ piece, vertex, this->IsInFan(h, ends[0]), this->IsInFan(h, ends[1]) });
  }

  /** Whether the segment from the origin of h to a point begins in a triangle at the origin. */
  bool IsInFan(Index h, const Point2& p) const
  {
    const Mesh& mesh = this->Surface;
    const Point2& from = mesh.PointOf(mesh.Origin(h));
    // Turns clockwise to the border, so that one visit sees the whole fan. Around a vertex where
    // borders touch, that is the fan of h alone.
    Index first = h; // of the fan; h if it is a full circle
    do
    {
      first = mesh.IsBorder(first) ? first : Mesh::Next(mesh.Twin(first));
    } while (first != h && !mesh.IsBorder(first));
    // The direction is in a triangle unless it is on the right of its first side or on the left of
    // its last one.
    return !VertexStars::VisitFan(mesh, first, [&](Index k) {
      return Orientation(from, mesh.PointOf(mesh.Destination(k)), p) == Negative ||
        Orientation(from, p, mesh.PointOf(mesh.Apex(k))) == Negative;
    });
  }

  /** The ends of each piece. */
  std::vector<Ends> PieceEnds() const
  {
    std::vector<Ends> ends;
    ends.reserve(this->Pieces.size());
    for (Index i = 0; i < static_cast<Index>(this->Pieces.size()); ++i)
    {
      ends.push_back({ this->PlaceOf(this->Pieces[i].Vertex),
        this->PlaceOf(this->Pieces[this->Result.Vertices.After(i)].Vertex) });
    }
    return ends;
  }

  /**
   * Finds the vertices that pieces which cross the border run through exactly. Cut at a rounded
   * crossing alone, the pieces would miss these vertices.
   */
  void FindStops(const std::vector<Ends>& pieces, const Progress& progress)
  {
    if (this->IsCut.empty())
    {
      return;
    }
    Stages stages(progress, { 50, 50 });
    const Mesh& mesh = this->Surface;
    // Pieces that cross no border stay as they are: passes that follow step through the vertices on
    // them.
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
    ForEachNumber(mesh.NumberOfPoints(), stages.Next(), [&](Index v) {
      const Point2& p = mesh.PointOf(v);
      grid.Visit(p, [&](Index i) {
        if (IsInside(segments[i], p))
        {
          isOn[v] = 1;
          segmentsThrough[v].push_back(i);
        }
      });
    });
    if (segmentsThrough.empty())
    {
      return;
    }
    // Only vertices that a triangle uses become stops.
    ForEachNumber(mesh.NumberOfHalfEdges(), stages.Next(), [&](Index h) {
      const Index v = mesh.Origin(h);
      if (isOn[v])
      {
        // Once, whatever the number of its triangles.
        isOn[v] = 0;
        for (const Index i : segmentsThrough.at(v))
        {
          this->AddStop(this->IsCut[i], segments[i], h, v);
        }
      }
    });
  }

  /** Cuts the pieces at their stops. */
  void CutPieces(const std::vector<Ends>& pieces)
  {
    const Mesh& mesh = this->Surface;
    std::sort(this->Stops.begin(), this->Stops.end(), [&](const Stop& a, const Stop& b) {
      if (a.Piece != b.Piece)
      {
        return a.Piece < b.Piece;
      }
      const Ends& piece = pieces[a.Piece];
      const Point2 p = this->PlaceOf(a.Vertex), q = this->PlaceOf(b.Vertex);
      // Compares along the way; at one place, the piece leaves one part of the mesh before it
      // enters another: a stop with From alone comes before one with Into alone.
      return IsBefore(piece[0], piece[1], p, q) ||
        (p == q &&
          std::make_tuple(a.Into - a.From, a.Vertex) < std::make_tuple(b.Into - b.From, b.Vertex));
    });
    this->EdgeOfCut = this->Stops.empty() ? 0 : this->Pieces[this->Stops.back().Piece].Edge;
    std::vector<Piece> cut;
    cut.reserve(this->Pieces.size() + this->Stops.size());
    auto stop = this->Stops.begin();
    std::vector<Index> offsets{ 0 };
    const std::vector<Index>& before = this->Result.Vertices.Offsets;
    for (std::size_t ring = 0; ring + 1 < before.size(); ++ring)
    {
      const Stop* last = nullptr; // the stop added last; null for a vertex of the uncut ring
      // Appends a vertex of the ring. Stops repeat: found as a crossing and as a vertex, or equal
      // to an end of their piece.
      const auto add = [&](const Piece& piece, const Stop* at) {
        if (cut.size() > static_cast<std::size_t>(offsets.back()))
        {
          const Index vertex = cut.back().Vertex;
          if (vertex == piece.Vertex)
          {
            cut.pop_back(); // it has no length
          }
          else if ((last || at) && vertex >= 0 && piece.Vertex >= 0 &&
            mesh.PointOf(vertex) == mesh.PointOf(piece.Vertex) &&
            (!last || !at || last->Into || at->From))
          {
            // Two different vertices at the same place: the ring steps from one border to another
            // that lies on it. That is in order between parts of the mesh, when it leaves one and
            // enters the other.
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
        for (; stop != this->Stops.end() && stop->Piece == static_cast<std::size_t>(i); ++stop)
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

  /** Splits the pieces within the mesh where they cross its edges. */
  void FollowPieces(const Progress& progress)
  {
    Stages stages(progress, { 10, 85, 5 }); // the last one reports nothing
    const Mesh& mesh = this->Surface;
    const auto segmentOf = [&](Index i) {
      const Index a = this->Pieces[i].Vertex;
      const Index b = this->Pieces[this->Result.Vertices.After(i)].Vertex;
      // Upwards, as FollowSurface() wants them; a piece in the other direction reads its chain
      // backwards.
      return IsLower(this->PlaceOf(b), this->PlaceOf(a)) ? Segment{ b, a } : Segment{ a, b };
    };
    // By place, then by number, so that the result does not depend on the order of points.
    const auto isBefore = [&](const FollowedSegment& s, const FollowedSegment& t) {
      return IsLower(mesh, s.Ends, t.Ends) ||
        (!IsLower(mesh, t.Ends, s.Ends) &&
          std::tie(s.Ends.A, s.Ends.B) < std::tie(t.Ends.A, t.Ends.B));
    };
    const Index count = static_cast<Index>(this->Pieces.size());
    std::vector<FollowedSegment> segments;
    for (Index i = 0; i < count; ++i)
    {
      const Segment segment = segmentOf(i);
      // A piece with an end outside is outside as a whole: it has been cut at the border.
      if (segment.A >= 0 && segment.B >= 0)
      {
        segments.emplace_back(segment);
      }
    }
    Sort(segments.begin(), segments.end(), isBefore, stages.Next());
    // An edge that several rings share is followed once.
    segments.erase(std::unique(segments.begin(), segments.end(),
                     [](const FollowedSegment& s, const FollowedSegment& t) {
                       return s.Ends.A == t.Ends.A && s.Ends.B == t.Ends.B;
                     }),
      segments.end());
    FollowSurface(this->Surface, this->Cutter, segments, stages.Next());
    std::vector<Piece> followed;
    std::vector<Index> offsets{ 0 };
    for (Index i = 0; i < count; ++i)
    {
      const Piece& piece = this->Pieces[i];
      followed.push_back(piece);
      const Segment segment = segmentOf(i);
      if (segment.A >= 0 && segment.B >= 0)
      {
        // Its place in the sorted list, instead of a map.
        const std::vector<Index>& between =
          std::lower_bound(segments.begin(), segments.end(), FollowedSegment(segment), isBefore)
            ->Between;
        const auto add = [&](Index vertex) { followed.push_back({ vertex, piece.Edge }); };
        if (segment.A == piece.Vertex)
        {
          std::for_each(between.begin(), between.end(), add);
        }
        else
        {
          std::for_each(between.rbegin(), between.rend(), add);
        }
      }
      if (i + 1 == this->Result.Vertices.Offsets[offsets.size()])
      {
        offsets.push_back(static_cast<Index>(followed.size()));
      }
    }
    this->Pieces = std::move(followed);
    this->Result.Vertices.Offsets = std::move(offsets);
    this->Result.NumberOfFollowedEdges = static_cast<Index>(std::count_if(segments.begin(),
      segments.end(), [](const FollowedSegment& segment) { return segment.IsMissing; }));
  }

  [[noreturn]] void RefuseDoubleBorder(std::size_t edge, const Point2& p) const
  {
    throw Error("The boundary's edge " + this->EdgeName(edge) + " passes " + NameOf(p) +
      ", where borders of the mesh lie on each other without points in common. Merge the points, "
      "as vtkStaticCleanPolyData does.");
  }

  /** Appends the points outside the mesh to its points. */
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

  static constexpr Index FirstOutside = OutsideMesh - 1; ///< the first number of points outside

  Mesh& Surface;
  const NamedPoints& Points;
  const Rings& Drawn;
  const bool MayInsert;
  const Following Follow;
  InsertedRings& Result;
  MeshCutter Cutter;
  RingVertices VertexAt;
  std::vector<Point2> OutsidePoints;
  std::vector<Piece> Pieces; ///< along each ring
  std::vector<Stop> Stops;
  std::vector<std::size_t> IsCut; ///< pieces that cross the border
  std::size_t EdgeOfCut = 0;      ///< an edge that has been cut last
};

} // namespace

InsertedRings InsertRings(Mesh& mesh, const NamedPoints& points, const Rings& rings, bool insert,
  const Progress& progress, Following follow)
{
  InsertedRings result;
  Insertion(mesh, points, rings, insert, follow, result).Run(progress);
  return result;
}

} // namespace elevation
