// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace elevation
{

// ---------------------------------------------------------------------------------------- location

namespace
{

template <typename Visitor>
void VisitEdges(const Rings& rings, Visitor&& visit)
{
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    const Index* end = rings.End(ring);
    for (const Index* v = rings.Begin(ring); v != end; ++v)
    {
      visit(*v, v + 1 == end ? *rings.Begin(ring) : v[1]);
    }
  }
}

} // namespace

RingLocator::RingLocator(const std::vector<Point2>& points, const Rings& rings)
  : Points(points)
{
  double top = -std::numeric_limits<double>::infinity();
  this->Bottom = std::numeric_limits<double>::infinity();
  double heights = 0.0;
  VisitEdges(rings, [&](Index a, Index b) {
    if (points[b].Y < points[a].Y)
    {
      std::swap(a, b);
    }
    this->Edges.push_back({ a, b });
    this->Bottom = std::min(this->Bottom, points[a].Y);
    top = std::max(top, points[b].Y);
    heights += points[b].Y - points[a].Y;
  });
  // As many bins as keep the entries of all edges a few times the number of edges.
  const double count = static_cast<double>(this->Edges.size());
  const double share = heights / (top - this->Bottom);
  const double bins = share > 0.0 ? std::min(count, 8.0 * count / share) : 1.0;
  this->BinOffsets.assign(static_cast<std::size_t>(bins) + 2, 0);
  this->BinsPerUnit = bins / (top - this->Bottom);

  for (const bool fill : { false, true })
  {
    for (std::size_t i = 0; i < this->Edges.size(); ++i)
    {
      const Index last = this->BinOf(points[this->Edges[i].High].Y);
      for (Index bin = this->BinOf(points[this->Edges[i].Low].Y); bin <= last; ++bin)
      {
        if (fill)
        {
          this->BinEdges[--this->BinOffsets[bin]] = static_cast<Index>(i);
        }
        else
        {
          ++this->BinOffsets[bin];
        }
      }
    }
    if (!fill)
    {
      for (std::size_t bin = 1; bin < this->BinOffsets.size(); ++bin)
      {
        this->BinOffsets[bin] += this->BinOffsets[bin - 1];
      }
      this->BinEdges.resize(this->BinOffsets.back());
    }
  }
}

Index RingLocator::BinOf(double y) const
{
  // Monotone in y; "not a number" (an infinite range) is bin 0.
  const double position = (y - this->Bottom) * this->BinsPerUnit;
  const Index last = static_cast<Index>(this->BinOffsets.size()) - 2;
  return position > 0.0 ? (position < last ? static_cast<Index>(position) : last) : 0;
}

template <typename Visitor>
void RingLocator::VisitEdgesAt(double y, Visitor&& visit) const
{
  const Index bin = this->BinOf(y);
  for (Index i = this->BinOffsets[bin]; i < this->BinOffsets[bin + 1]; ++i)
  {
    const Edge& edge = this->Edges[this->BinEdges[i]];
    visit(this->Points[edge.Low], this->Points[edge.High]);
  }
}

bool RingLocator::IsInside(const Point2& a, const Point2& b, const Point2& c) const
{
  // p is the lowest corner, q the next one: the inside of the triangle near p is above p and on the
  // left of pq. The question is asked for a place there, closer to p than anything else.
  const bool lowestIsB = IsLower(b, a) && IsLower(b, c);
  const bool lowestIsC = !lowestIsB && IsLower(c, a);
  const Point2& p = lowestIsB ? b : lowestIsC ? c : a;
  const Point2& q = lowestIsB ? c : lowestIsC ? a : b;
  bool isInside = false;
  this->VisitEdgesAt(p.Y, [&](const Point2& low, const Point2& high) {
    if (!(low.Y <= p.Y && p.Y < high.Y))
    {
      return;
    }
    const Sign side = Orientation(low, high, p);
    // An edge that goes up from p passes the triangle on its left or on its
    // right: it does not cut it.
    isInside ^= side == Negative || (side == Zero && Orientation(p, high, q) == Negative);
  });
  return isInside;
}

// ------------------------------------------------------------------------------------- given lines

namespace
{

struct HashOfPoint
{
  std::size_t operator()(const Point2& p) const
  {
    // 0.0 and -0.0 are equal, and have the same hash.
    const std::hash<double> hash;
    return hash(p.X) ^ (hash(p.Y) * 0x9E3779B97F4A7C15ull);
  }
};

std::string NameOfLine(const BoundaryLines& lines, Index line)
{
  return (lines.IsPolygon[line] ? "polygon (cell " : "line (cell ") +
    std::to_string(lines.Cells[line]) + ")";
}

/** The mesh vertex at each point of the lines that a line uses. */
std::vector<Index> MatchPoints(
  const Mesh& mesh, const BoundaryLines& lines, const Progress& progress)
{
  std::unordered_map<Point2, Index, HashOfPoint> vertexAt;
  for (Index line = 0; line < lines.Lines.Count(); ++line)
  {
    for (const Index* point = lines.Lines.Begin(line); point != lines.Lines.End(line); ++point)
    {
      const Point2& p = lines.Points[*point];
      if (!std::isfinite(p.X) || !std::isfinite(p.Y))
      {
        throw Error("The boundary's " + NameOf(lines.Points, *point) + " of " +
          NameOfLine(lines, line) + " is not finite.");
      }
      vertexAt.emplace(p, None);
    }
  }
  std::vector<char> seen(mesh.Points.size(), 0);
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    ReportStep(progress, h, mesh.Triangles.size());
    const Index vertex = mesh.Origin(h);
    if (seen[vertex])
    {
      continue;
    }
    seen[vertex] = 1;
    const auto found = vertexAt.find(mesh.PointOf(vertex));
    if (found == vertexAt.end())
    {
      continue;
    }
    if (found->second != None)
    {
      throw Error("Points " + std::to_string(std::min(found->second, vertex)) + " and " +
        std::to_string(std::max(found->second, vertex)) +
        " of the mesh have the same x,y and both are corners of triangles, so that the "
        "boundary's " +
        "point there is not one place of the mesh. Merge them, as vtkStaticCleanPolyData does.");
    }
    found->second = vertex;
  }

  std::vector<Index> vertices(lines.Points.size(), None);
  for (Index line = 0; line < lines.Lines.Count(); ++line)
  {
    for (const Index* point = lines.Lines.Begin(line); point != lines.Lines.End(line); ++point)
    {
      vertices[*point] = vertexAt.at(lines.Points[*point]);
      if (vertices[*point] == None)
      {
        throw Error("The boundary's " + NameOf(lines.Points, *point) + " of " +
          NameOfLine(lines, line) + " is not a corner of the mesh: no triangle has a point with " +
          "exactly the same x,y. Add the boundary's points to the points before triangulating "
          "them.");
      }
    }
  }
  return vertices;
}

/** A line without points that repeat the one before; closed ones do not repeat the first. */
struct Piece
{
  std::vector<Index> Points;
  Index Line;
  bool IsClosed;
};

std::vector<Piece> MakePieces(const BoundaryLines& lines, const std::vector<Index>& vertexOf)
{
  std::vector<Piece> pieces;
  for (Index line = 0; line < lines.Lines.Count(); ++line)
  {
    Piece piece;
    piece.Line = line;
    for (const Index* point = lines.Lines.Begin(line); point != lines.Lines.End(line); ++point)
    {
      if (piece.Points.empty() || vertexOf[piece.Points.back()] != vertexOf[*point])
      {
        piece.Points.push_back(*point);
      }
    }
    if (piece.Points.empty())
    {
      continue;
    }
    const bool returns = vertexOf[piece.Points.front()] == vertexOf[piece.Points.back()];
    piece.IsClosed = lines.IsPolygon[line] || returns;
    if (piece.Points.size() > 1 && returns)
    {
      piece.Points.pop_back();
    }
    if (piece.IsClosed && piece.Points.size() < 3)
    {
      throw Error("The boundary's " + NameOfLine(lines, line) + " has only " +
        std::to_string(piece.Points.size()) + " different point" +
        (piece.Points.size() == 1 ? "" : "s") + "; a ring has at least three.");
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

void Append(
  JoinedBoundary& joined, const std::vector<Index>& points, const std::vector<Index>& vertexOf)
{
  for (const Index point : points)
  {
    joined.Vertices.Vertices.push_back(vertexOf[point]);
    joined.Points.push_back(point);
  }
  joined.Vertices.Offsets.push_back(static_cast<Index>(joined.Points.size()));
}

} // namespace

JoinedBoundary JoinLines(const Mesh& mesh, const BoundaryLines& lines, const Progress& progress)
{
  const std::vector<Index> vertexOf = MatchPoints(mesh, lines, progress);
  const std::vector<Piece> pieces = MakePieces(lines, vertexOf);
  if (pieces.empty())
  {
    throw Error("The boundary has no line and no polygon.");
  }

  // The open pieces that end in a vertex, in their order.
  std::unordered_map<Index, std::vector<std::size_t>> endsAt;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    if (!pieces[i].IsClosed)
    {
      endsAt[vertexOf[pieces[i].Points.front()]].push_back(i);
      endsAt[vertexOf[pieces[i].Points.back()]].push_back(i);
    }
  }
  for (const Piece& piece : pieces)
  {
    for (const Index end : { piece.Points.front(), piece.Points.back() })
    {
      const auto meeting = endsAt.find(vertexOf[end]);
      if (!piece.IsClosed && meeting->second.size() % 2 != 0)
      {
        throw Error("The boundary is not closed: " + NameOfLine(lines, piece.Line) + " ends at " +
          NameOf(lines.Points, end) +
          (meeting->second.size() == 1 ? ", where no other line goes on."
                                       : ", where " + std::to_string(meeting->second.size()) +
                " lines end, which cannot be paired."));
      }
    }
  }

  // An even number of lines ends everywhere, so a walk along lines not yet used comes back.
  JoinedBoundary joined;
  std::vector<char> used(pieces.size(), 0);
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    if (used[i])
    {
      continue;
    }
    used[i] = 1;
    if (pieces[i].IsClosed)
    {
      Append(joined, pieces[i].Points, vertexOf);
      continue;
    }
    std::vector<Index> ring = pieces[i].Points;
    while (vertexOf[ring.back()] != vertexOf[ring.front()])
    {
      const std::vector<std::size_t>& meeting = endsAt[vertexOf[ring.back()]];
      const std::size_t next =
        *std::find_if(meeting.begin(), meeting.end(), [&](std::size_t j) { return !used[j]; });
      used[next] = 1;
      const std::vector<Index>& points = pieces[next].Points;
      if (vertexOf[points.front()] == vertexOf[ring.back()])
      {
        ring.insert(ring.end(), points.begin() + 1, points.end());
      }
      else
      {
        ring.insert(ring.end(), points.rbegin() + 1, points.rend());
      }
    }
    ring.pop_back();
    // Two lines along one edge, as of two parcels that share it, cancel out. Whether they meet here
    // or in two larger rings depends on the order of the lines alone.
    if (ring.size() > 2)
    {
      Append(joined, ring, vertexOf);
    }
  }
  if (joined.Points.empty())
  {
    throw Error("The boundary's " + NameOfLine(lines, pieces.front().Line) +
      " makes a ring of only two points, and so do all others; a ring has at least three.");
  }
  return joined;
}

// -------------------------------------------------------------------------------------- extraction

namespace
{

// The figures of the rule (see Boundary.h), found by trials: lattices, lattices thinned to a tenth,
// random points, points graded tenfold and scan lines eight times denser along than across, all cut
// out by one outline with lakes, a fjord and an island. The area between truth and outline was 0.08
// to 0.22 of the area within one spacing of the true outline; with 2 or 2.5 typical triangles 0.24
// at worst.
constexpr int NeighborOfSpacing = 6;
constexpr double SpacingPerNeighborDistance = 0.5;
constexpr double ToleranceOfTypicalTriangle = 2.25;
constexpr double LargestSpacingInTriangle = 2.0;
constexpr std::size_t NeighborsOfHub = 64;
// Smaller ones, whose squares leave the range of double, are taken as this, so that no spacing is 0.
constexpr double LeastSpacing = 1e-150;

/** Squared distances at a scale where they do not leave the range of double. */
class Distances
{
public:
  explicit Distances(const Mesh& mesh)
    : Points(mesh.Points)
  {
    double largest = 0.0;
    for (const Index vertex : mesh.Triangles)
    {
      largest =
        std::max({ largest, std::fabs(this->Points[vertex].X), std::fabs(this->Points[vertex].Y) });
    }
    this->Scale = largest > 1e100 || largest < 1e-100
      ? std::ldexp(1.0, -std::max(-1000, std::min(1000, std::ilogb(largest))))
      : 1.0;
  }
  double Squared(const Point2& p, const Point2& q) const
  {
    const double x = p.X * this->Scale - q.X * this->Scale;
    const double y = p.Y * this->Scale - q.Y * this->Scale;
    return x * x + y * y;
  }
  double Squared(Index v, Index w) const { return this->Squared(this->Points[v], this->Points[w]); }
  double TwiceArea(Index u, Index v, Index w) const
  {
    const double ux = this->Points[u].X * this->Scale;
    const double uy = this->Points[u].Y * this->Scale;
    return (this->Points[v].X * this->Scale - ux) * (this->Points[w].Y * this->Scale - uy) -
      (this->Points[v].Y * this->Scale - uy) * (this->Points[w].X * this->Scale - ux);
  }

private:
  const std::vector<Point2>& Points;
  double Scale;
};

/**
 * The spacing at each vertex: half the distance of its 6th nearest vertex.
 * In a Delaunay triangulation the next nearest vertex is always a neighbour of the vertex or of one
 * nearer, so that a search over neighbours finds the right one. It does not pass through vertices
 * with very many neighbours, which would make it quadratic.
 */
std::vector<double> FindSpacings(
  const Mesh& mesh, const Distances& distances, const Progress& progress)
{
  // Vertices are renumbered as the triangles name them: neighbours come to lie near in memory.
  std::vector<Index> rank(mesh.Points.size(), None);
  std::vector<Index> vertices;
  const Index halfEdges = mesh.NumberOfHalfEdges();
  const Progress ranking = Part(progress, 0.0, 0.1);
  for (Index h = 0; h < halfEdges; ++h)
  {
    ReportStep(ranking, h, halfEdges);
    const Index vertex = mesh.Origin(h);
    if (rank[vertex] == None)
    {
      rank[vertex] = static_cast<Index>(vertices.size());
      vertices.push_back(vertex);
    }
  }
  const std::size_t count = vertices.size();
  std::vector<Point2> points(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    points[i] = mesh.PointOf(vertices[i]);
  }
  const auto origin = [&](Index h) { return rank[mesh.Origin(h)]; };
  const auto destination = [&](Index h) { return rank[mesh.Destination(h)]; };

  std::vector<Index> offsets(count + 1, 0);
  const Progress counting = Part(progress, 0.1, 0.2);
  for (Index h = 0; h < halfEdges; ++h)
  {
    ReportStep(counting, h, halfEdges);
    ++offsets[origin(h)];
    if (mesh.IsBorder(h))
    {
      ++offsets[destination(h)];
    }
  }
  Index sum = 0;
  for (Index& offset : offsets)
  {
    offset = sum += offset;
  }
  std::vector<Index> neighbors(sum);
  const Progress gathering = Part(progress, 0.2, 0.3);
  for (Index h = 0; h < halfEdges; ++h)
  {
    ReportStep(gathering, h, halfEdges);
    neighbors[--offsets[origin(h)]] = destination(h);
    if (mesh.IsBorder(h))
    {
      neighbors[--offsets[destination(h)]] = origin(h);
    }
  }

  struct Candidate
  {
    double Squared;
    Index Vertex;
  };
  std::vector<double> spacings(mesh.Points.size(), 0.0);
  std::vector<Index> seenFrom(count, None);
  std::vector<Candidate> candidates;
  const Progress searching = Part(progress, 0.3, 1.0);
  for (Index v = 0; v < static_cast<Index>(count); ++v)
  {
    ReportStep(searching, v, count);
    candidates.clear();
    seenFrom[v] = v;
    Index pass = v;
    double squared = 0.0;
    for (int k = 1; k <= NeighborOfSpacing; ++k)
    {
      if (pass == v ||
        static_cast<std::size_t>(offsets[pass + 1] - offsets[pass]) <= NeighborsOfHub)
      {
        for (Index i = offsets[pass]; i < offsets[pass + 1]; ++i)
        {
          const Index w = neighbors[i];
          if (seenFrom[w] != v)
          {
            seenFrom[w] = v;
            candidates.push_back({ distances.Squared(points[v], points[w]), w });
          }
        }
      }
      if (candidates.empty())
      {
        break;
      }
      // Which of two equally near vertices is passed first does not matter in the end: the search
      // also finds what lies behind the other one before anything farther.
      const auto nearest = std::min_element(candidates.begin(), candidates.end(),
        [](const Candidate& p, const Candidate& q) { return p.Squared < q.Squared; });
      squared = nearest->Squared;
      pass = nearest->Vertex;
      *nearest = candidates.back();
      candidates.pop_back();
    }
    spacings[vertices[v]] = SpacingPerNeighborDistance * std::sqrt(squared);
  }
  return spacings;
}

/** The parts of triangles with the same flag that are connected by edges. */
struct Parts
{
  std::vector<Index> PartOf; ///< one a triangle
  std::vector<Index> Offsets{ 0 };
  std::vector<Index> Triangles; ///< part after part

  Parts(const Mesh& mesh, const std::vector<char>& flags, const Progress& progress)
    : PartOf(flags.size(), None)
  {
    this->Triangles.reserve(flags.size());
    for (std::size_t seed = 0; seed < flags.size(); ++seed)
    {
      if (this->PartOf[seed] != None)
      {
        continue;
      }
      const Index part = this->Count();
      std::size_t next = this->Triangles.size();
      this->PartOf[seed] = part;
      this->Triangles.push_back(static_cast<Index>(seed));
      for (; next < this->Triangles.size(); ++next)
      {
        ReportStep(progress, next, flags.size());
        const Index t = this->Triangles[next];
        for (Index h = 3 * t; h < 3 * t + 3; ++h)
        {
          const Index other = mesh.IsBorder(h) ? None : Mesh::Triangle(mesh.Twin(h));
          if (other != None && this->PartOf[other] == None && flags[other] == flags[t])
          {
            this->PartOf[other] = part;
            this->Triangles.push_back(other);
          }
        }
      }
      this->Offsets.push_back(static_cast<Index>(this->Triangles.size()));
    }
  }
  Index Count() const { return static_cast<Index>(this->Offsets.size()) - 1; }
  const Index* Begin(Index part) const { return this->Triangles.data() + this->Offsets[part]; }
  const Index* End(Index part) const { return this->Triangles.data() + this->Offsets[part + 1]; }
};

/** Closes the openings that are smaller than what the tolerance bridges. */
void CloseSmallOpenings(const Mesh& mesh, const std::vector<double>& shares,
  std::vector<char>& keep, const Progress& progress)
{
  const Parts parts(mesh, keep, Part(progress, 0.0, 0.5));
  const Progress closing = Part(progress, 0.5, 1.0);
  std::vector<double> ofPart;
  for (Index part = 0; part < parts.Count(); ++part)
  {
    const Index* begin = parts.Begin(part);
    const Index* end = parts.End(part);
    ReportStep(closing, part, parts.Count(), 256);
    const bool reachesBorder = std::any_of(begin, end, [&](Index t) {
      return mesh.IsBorder(3 * t) || mesh.IsBorder(3 * t + 1) || mesh.IsBorder(3 * t + 2);
    });
    if (keep[*begin] || reachesBorder)
    {
      continue;
    }
    // In the order of size, so that the sum does not depend on the order of the triangles.
    ofPart.clear();
    std::for_each(begin, end, [&](Index t) { ofPart.push_back(shares[t]); });
    std::sort(ofPart.begin(), ofPart.end());
    double sum = 0.0;
    for (const double share : ofPart)
    {
      sum += share;
    }
    if (sum < 1.0)
    {
      std::for_each(begin, end, [&](Index t) { keep[t] = 1; });
    }
  }
}

/** Takes out pieces with too few vertices to have a spacing of their own, if others have more. */
void DropSmallPieces(const Mesh& mesh, std::vector<char>& keep, const Progress& progress)
{
  const Parts parts(mesh, keep, Part(progress, 0.0, 0.5));
  const Progress dropping = Part(progress, 0.5, 1.0);
  std::vector<char> isSmall(parts.Count(), 0);
  bool anyLarge = false;
  std::vector<Index> corners;
  for (Index part = 0; part < parts.Count(); ++part)
  {
    const Index* begin = parts.Begin(part);
    const Index* end = parts.End(part);
    ReportStep(dropping, part, parts.Count());
    if (!keep[*begin])
    {
      continue;
    }
    bool large =
      end - begin > 3 * NeighborOfSpacing; // more triangles than so few vertices can have
    if (!large)
    {
      corners.clear();
      std::for_each(begin, end, [&](Index t) {
        corners.insert(corners.end(), &mesh.Triangles[3 * t], &mesh.Triangles[3 * t] + 3);
      });
      std::sort(corners.begin(), corners.end());
      large = std::unique(corners.begin(), corners.end()) - corners.begin() > NeighborOfSpacing;
    }
    isSmall[part] = !large;
    anyLarge = anyLarge || large;
  }
  for (std::size_t t = 0; anyLarge && t < keep.size(); ++t)
  {
    keep[t] = keep[t] && !isSmall[parts.PartOf[t]];
  }
}

/**
 * The border of the triangles to keep, as simple rings of vertices in an order of their positions.
 */
Rings BorderOf(const Mesh& mesh, const std::vector<char>& keep, const Progress& progress)
{
  const Progress choosing = Part(progress, 0.0, 0.2);
  const Progress linking = Part(progress, 0.2, 0.4);
  const Progress tracing = Part(progress, 0.4, 0.8);
  const Progress cutting = Part(progress, 0.8, 1.0);
  Mesh kept;
  kept.Points = mesh.Points;
  std::vector<Index> before; // the half-edge of each kept one
  std::vector<Index> after(mesh.Triangles.size(), Mesh::Border);
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    ReportStep(choosing, h, after.size());
    if (keep[Mesh::Triangle(h)])
    {
      after[h] = static_cast<Index>(before.size());
      before.push_back(h);
      kept.Triangles.push_back(mesh.Origin(h));
    }
  }
  for (const Index h : before)
  {
    ReportStep(linking, kept.Twins.size(), before.size());
    kept.Twins.push_back(mesh.IsBorder(h) ? Mesh::Border : after[mesh.Twin(h)]);
  }

  // A walk that comes back to a vertex it has passed has closed a ring.
  const Rings walks = TraceBorder(kept, tracing);
  std::vector<std::vector<Index>> rings;
  std::vector<Index> path;
  std::vector<char> isOnPath(mesh.Points.size(), 0);
  for (Index walk = 0; walk < walks.Count(); ++walk)
  {
    auto cutRing = [&](std::size_t first) {
      auto lowest = std::min_element(path.begin() + first, path.end(),
        [&](Index v, Index w) { return IsLower(mesh.PointOf(v), mesh.PointOf(w)); });
      std::rotate(path.begin() + first, lowest, path.end());
      rings.emplace_back(path.begin() + first, path.end());
    };
    for (const Index* h = walks.Begin(walk); h != walks.End(walk); ++h)
    {
      ReportStep(cutting, h - walks.Vertices.data(), walks.Vertices.size());
      const Index vertex = kept.Origin(*h);
      if (isOnPath[vertex])
      {
        const std::size_t first = std::find(path.begin(), path.end(), vertex) - path.begin();
        for (std::size_t i = first; i < path.size(); ++i)
        {
          isOnPath[path[i]] = 0;
        }
        cutRing(first);
        path.resize(first);
      }
      isOnPath[vertex] = 1;
      path.push_back(vertex);
    }
    for (const Index vertex : path)
    {
      isOnPath[vertex] = 0;
    }
    cutRing(0);
    path.clear();
  }
  std::sort(
    rings.begin(), rings.end(), [&](const std::vector<Index>& r, const std::vector<Index>& s) {
      for (std::size_t i = 0; i < std::min(r.size(), s.size()); ++i)
      {
        if (r[i] != s[i])
        {
          return IsLower(mesh.PointOf(r[i]), mesh.PointOf(s[i]));
        }
      }
      return r.size() < s.size();
    });
  Rings result;
  for (const std::vector<Index>& ring : rings)
  {
    result.Vertices.insert(result.Vertices.end(), ring.begin(), ring.end());
    result.Offsets.push_back(static_cast<Index>(result.Vertices.size()));
  }
  return result;
}

} // namespace

ExtractedBoundary ExtractBoundary(const Mesh& mesh, const ExtractOptions& options)
{
  ExtractedBoundary result;
  result.GapTolerance = options.GapTolerance;
  const Index count = mesh.NumberOfTriangles();
  if (count == 0)
  {
    return result;
  }
  const Distances distances(mesh);
  const std::vector<double> spacings =
    FindSpacings(mesh, distances, Part(options.Monitor, 0.0, 0.6));

  // The longest edge of each triangle and its spacing: the middle one of its corners' three, which
  // the spacing of a point that lies alone is not, nor of two that lie alone.
  const Progress measuring = Part(options.Monitor, 0.6, 0.7);
  std::vector<double> ratios(count);
  std::vector<double> local(count);
  for (Index t = 0; t < count; ++t)
  {
    ReportStep(measuring, t, count);
    const Index a = mesh.Origin(3 * t);
    const Index b = mesh.Origin(3 * t + 1);
    const Index c = mesh.Origin(3 * t + 2);
    double s[3] = { spacings[a], spacings[b], spacings[c] };
    std::sort(s, s + 3);
    local[t] = std::max(LeastSpacing, std::min(s[1], LargestSpacingInTriangle * s[0]));
    ratios[t] = std::sqrt(std::max(
                  { distances.Squared(a, b), distances.Squared(b, c), distances.Squared(c, a) })) /
      local[t];
  }
  if (!(result.GapTolerance > 0.0))
  {
    std::vector<double> sorted = ratios;
    const auto median = sorted.begin() + count / 2;
    std::nth_element(sorted.begin(), median, sorted.end());
    result.GapTolerance = ToleranceOfTypicalTriangle * *median;
  }

  const Progress deciding = Part(options.Monitor, 0.7, 0.75);
  std::vector<char> keep(count);
  for (Index t = 0; t < count; ++t)
  {
    ReportStep(deciding, t, count);
    keep[t] = ratios[t] <= result.GapTolerance;
    // From here on the share of a square of the size that the tolerance bridges.
    const double side = result.GapTolerance * local[t];
    const double square = side * side;
    const double area =
      0.5 * distances.TwiceArea(mesh.Origin(3 * t), mesh.Origin(3 * t + 1), mesh.Origin(3 * t + 2));
    ratios[t] = square > 0.0 ? area / square : std::numeric_limits<double>::infinity();
  }
  CloseSmallOpenings(mesh, ratios, keep, Part(options.Monitor, 0.75, 0.82));
  DropSmallPieces(mesh, keep, Part(options.Monitor, 0.82, 0.89));
  result.Vertices = BorderOf(mesh, keep, Part(options.Monitor, 0.89, 1.0));
  Report(options.Monitor, 1.0);
  return result;
}

} // namespace elevation
