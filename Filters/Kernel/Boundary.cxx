// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary.h"

#include "Parallel.h"

#include <algorithm>
#include <cmath>
#include <cstring>
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

std::string NameOfLine(const BoundaryLines& lines, Index line)
{
  return (lines.IsPolygon[line] ? "polygon (cell " : "line (cell ") +
    std::to_string(lines.Cells[line]) + ")";
}

/** A line without points that repeat the one before; closed ones do not repeat the first. */
struct Piece
{
  std::vector<Index> Points;
  Index Line;
  bool IsClosed;
};

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
        throw Error("The boundary's " + NameOf(lines.Points, *point) + " of " +
          NameOfLine(lines, line) + " is not finite.");
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

void Append(Rings& rings, const std::vector<Index>& points)
{
  rings.Vertices.insert(rings.Vertices.end(), points.begin(), points.end());
  rings.Offsets.push_back(static_cast<Index>(rings.Vertices.size()));
}

} // namespace

Rings JoinLines(const BoundaryLines& lines)
{
  const std::vector<Piece> pieces = MakePieces(lines);
  const auto placeOf = [&lines](Index point) { return lines.Points[point]; };
  if (pieces.empty())
  {
    throw Error("The boundary has no line and no polygon.");
  }

  // The ends of open pieces in a place: the front of piece i is 2 i, its back 2 i + 1.
  const auto placeOfEnd = [&](std::size_t end) {
    const std::vector<Index>& points = pieces[end / 2].Points;
    return placeOf(end % 2 == 0 ? points.front() : points.back());
  };
  const auto nextOfEnd = [&](std::size_t end) {
    const std::vector<Index>& points = pieces[end / 2].Points;
    return placeOf(end % 2 == 0 ? points[1] : points[points.size() - 2]);
  };
  std::unordered_map<Point2, std::vector<std::size_t>, HashOfPoint> endsAt;
  for (std::size_t end = 0; end < 2 * pieces.size(); ++end)
  {
    if (!pieces[end / 2].IsClosed)
    {
      endsAt[placeOfEnd(end)].push_back(end);
    }
  }
  for (std::size_t end = 0; end < 2 * pieces.size(); ++end)
  {
    const auto meeting = endsAt.find(placeOfEnd(end));
    if (!pieces[end / 2].IsClosed && meeting->second.size() % 2 != 0)
    {
      const std::vector<Index>& points = pieces[end / 2].Points;
      throw Error("The boundary is not closed: " + NameOfLine(lines, pieces[end / 2].Line) +
        " ends at " + NameOf(lines.Points, end % 2 == 0 ? points.front() : points.back()) +
        (meeting->second.size() == 1 ? ", where no other line goes on."
                                     : ", where " + std::to_string(meeting->second.size()) +
              " lines end, which cannot be paired."));
    }
  }

  // Where more than two end, each goes on in one beside it, so that no rings cross there; and two
  // that begin alike in each other, as what they have in common cancels out.
  std::vector<std::size_t> partners(2 * pieces.size());
  for (auto& meeting : endsAt)
  {
    const Point2& place = meeting.first;
    std::vector<std::size_t>& ends = meeting.second;
    const auto comesBefore = [&](std::size_t e, std::size_t f) {
      const Point2 p = nextOfEnd(e), q = nextOfEnd(f);
      return IsLower(place, p) != IsLower(place, q) ? IsLower(place, p)
                                                    : Orientation(place, p, q) == Positive;
    };
    std::stable_sort(ends.begin(), ends.end(), comesBefore);
    std::vector<std::size_t> others;
    const auto pairAll = [&](bool areAlike) {
      others.clear();
      for (const std::size_t end : ends)
      {
        if (others.empty() || (areAlike && comesBefore(others.back(), end)))
        {
          others.push_back(end);
          continue;
        }
        partners[end] = others.back();
        partners[others.back()] = end;
        others.pop_back();
      }
      ends = others;
    };
    pairAll(true);
    pairAll(false);
  }
  Rings joined;
  std::vector<char> used(pieces.size(), 0);
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    if (pieces[i].IsClosed)
    {
      Append(joined, pieces[i].Points);
      continue;
    }
    std::vector<Index> ring;
    for (std::size_t end = 2 * i; !used[end / 2]; end = partners[end ^ 1])
    {
      used[end / 2] = 1;
      const std::vector<Index>& points = pieces[end / 2].Points;
      if (end % 2 == 0)
      {
        ring.insert(ring.end(), points.begin(), points.end() - 1);
      }
      else
      {
        ring.insert(ring.end(), points.rbegin(), points.rend() - 1);
      }
    }
    // Two lines along one edge, as of two parcels that share it, cancel out.
    if (ring.size() > 2)
    {
      Append(joined, ring);
    }
  }
  if (joined.Vertices.empty())
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

/**
 * The mesh's vertices that are corners, numbered as the triangles name them, so that neighbours lie
 * near in memory. Coordinates are at a scale where their squares do not leave the range of double.
 */
struct LocalMesh
{
  Buffer<Index> Corners; ///< three a triangle
  Buffer<Point2> Points;

  LocalMesh(const Mesh& mesh, const Progress& progress)
  {
    this->Corners.Resize(mesh.Triangles.size());
    this->Points.Reserve(mesh.Points.size());
    Buffer<Index> numbers;
    numbers.Resize(mesh.Points.size());
    std::fill(numbers.begin(), numbers.end(), None);
    double largest = 0.0;
    const std::size_t last = mesh.Triangles.size() - 1;
    InStretches(mesh.NumberOfTriangles(), progress, [&](Index begin, Index end) {
      for (Index h = 3 * begin; h < 3 * end; ++h)
      {
        Prefetch(&numbers[mesh.Triangles[std::min(h + HalfEdgesAhead, last)]]);
        Prefetch(&mesh.Points[mesh.Triangles[std::min(h + HalfEdgesAhead, last)]]);
        Index& number = numbers[mesh.Origin(h)];
        if (number == None)
        {
          const Point2& p = mesh.PointOf(mesh.Origin(h));
          largest = std::max({ largest, std::fabs(p.X), std::fabs(p.Y) });
          number = static_cast<Index>(this->Points.size());
          this->Points.Append(p);
        }
        this->Corners[h] = number;
      }
    });
    if (largest > 1e100 || largest < 1e-100)
    {
      const double scale = std::ldexp(1.0, -std::max(-1000, std::min(1000, std::ilogb(largest))));
      for (Point2& p : this->Points)
      {
        p = { p.X * scale, p.Y * scale };
      }
    }
  }

  double SquaredDistance(Index v, Index w) const
  {
    const double x = this->Points[v].X - this->Points[w].X;
    const double y = this->Points[v].Y - this->Points[w].Y;
    return x * x + y * y;
  }
  double TwiceArea(Index u, Index v, Index w) const
  {
    const Point2& p = this->Points[u];
    return (this->Points[v].X - p.X) * (this->Points[w].Y - p.Y) -
      (this->Points[v].Y - p.Y) * (this->Points[w].X - p.X);
  }
};

/** The neighbours of each vertex. */
struct Neighbors
{
  Buffer<std::uint32_t> Offsets;
  /** Of each vertex a multiple of Group, filled up with the vertex itself. */
  Buffer<Index> Ids;
  static constexpr std::uint32_t Group =
    4; ///< at a time, for an end of loops that can be predicted

  Neighbors(const Mesh& mesh, const LocalMesh& local, const Progress& progress)
  {
    const Index count = static_cast<Index>(local.Points.size());
    this->Offsets.Resize(static_cast<std::size_t>(count) + 1);
    std::fill(this->Offsets.begin(), this->Offsets.end(), 0);
    // At the border, an edge is known to both its ends by one half-edge.
    const auto forEach = [&](Index begin, Index end, auto&& visit) {
      for (Index h = 3 * begin; h < 3 * end; h += 3)
      {
        for (Index i = 0; i < 3; ++i)
        {
          const Index a = local.Corners[h + i];
          const Index b = local.Corners[h + (i == 2 ? 0 : i + 1)];
          visit(a, b);
          if (mesh.IsBorder(h + i))
          {
            visit(b, a);
          }
        }
      }
    };
    const Index triangles = mesh.NumberOfTriangles();
    InStretches(triangles, Part(progress, 0.0, 0.4), [&](Index begin, Index end) {
      forEach(begin, end, [&](Index a, Index) { ++this->Offsets[a]; });
    });
    std::uint32_t sum = 0; // stays below 9 for each point
    for (std::uint32_t& offset : this->Offsets)
    {
      const std::uint32_t size = offset;
      offset += sum;
      sum += (size + Group - 1) / Group * Group;
    }
    this->Ids.Resize(sum);
    for (Index v = 0; v < count; ++v)
    {
      // Where the next one's begin is not known yet: they are filled in from their end.
      for (std::uint32_t i = this->Offsets[v]; i % Group != 0; ++i)
      {
        this->Ids[i] = v;
      }
    }
    InStretches(triangles, Part(progress, 0.4, 1.0), [&](Index begin, Index end) {
      forEach(begin, end, [&](Index a, Index b) { this->Ids[--this->Offsets[a]] = b; });
    });
  }
};

/**
 * The spacing at each vertex: half the distance of its 6th nearest vertex.
 * In a Delaunay triangulation the next nearest vertex is always a neighbour of the vertex or of one
 * nearer, so that a search over neighbours finds the right one. It does not pass through vertices
 * with very many neighbours, which would make it quadratic.
 */
Buffer<double> FindSpacings(
  const Mesh& mesh, const LocalMesh& local, int threads, const Progress& progress)
{
  const Neighbors neighbors(mesh, local, Part(progress, 0.0, 0.2));
  const Index count = static_cast<Index>(local.Points.size());
  const Point2* points = local.Points.data();
  Buffer<double> spacings;
  spacings.Resize(count);

  struct Candidate
  {
    double Squared;
    Index Vertex;
  };
  const Index* ids = neighbors.Ids.data();
  constexpr int last = NeighborOfSpacing - 1;
  constexpr Candidate nothing{ std::numeric_limits<double>::infinity(), None };
  const auto find = [&](Index begin, Index end) {
    std::vector<Index> found;
    // Vertices that the one at hand has had among its nearest. One may have taken the place of
    // another, which then is compared once more with the nearest themselves.
    constexpr std::uint32_t places = 1024;
    std::vector<std::uint64_t> known(places, ~std::uint64_t(0));
    for (Index v = begin; v < end; ++v)
    {
      const auto keyOf = [v](Index w) { return std::uint64_t(v) << 32 | std::uint32_t(w); };
      // What lies ahead is soon reached, but not in order.
      const Index ahead = v < count - 1 - 2048 ? v + 2048 : count - 1;
      Prefetch(points + ahead);
      Prefetch(ids + neighbors.Offsets[ahead]);

      // The nearest vertices found: those passed in the order in which they were, then the next
      // ones by distance. No more are needed than will be passed.
      Candidate nearest[NeighborOfSpacing];
      std::fill_n(nearest, NeighborOfSpacing, nothing);
      const Point2 p = points[v];
      const auto squaredTo = [&](Index w) {
        const double x = p.X - points[w].X;
        const double y = p.Y - points[w].Y;
        return x * x + y * y;
      };
      known[static_cast<std::uint32_t>(v) % places] = keyOf(v);
      Index passed = v;
      for (int k = 0;; ++k)
      {
        const std::uint32_t first = neighbors.Offsets[passed];
        const std::uint32_t size = neighbors.Offsets[passed + 1] - first;
        if (k == 0 || size <= NeighborsOfHub)
        {
          if (found.size() < size)
          {
            found.resize(size);
          }
          // Those that are near enough, without branches, for which they are cannot be predicted.
          const double limit = nearest[last].Squared;
          Index* next = found.data();
          const Index* groupsEnd = ids + first + size;
          for (const Index* group = ids + first; group != groupsEnd; group += Neighbors::Group)
          {
            for (std::uint32_t j = 0; j < Neighbors::Group; ++j)
            {
              const Index w = group[j];
              *next = w;
              next += (squaredTo(w) < limit) &
                (known[static_cast<std::uint32_t>(w) % places] != keyOf(w));
            }
          }
          const std::size_t numberFound = next - found.data();
          for (std::size_t i = 0; i < numberFound; ++i)
          {
            const Candidate candidate{ squaredTo(found[i]), found[i] };
            bool isKnown = candidate.Vertex == v;
            for (const Candidate& other : nearest)
            {
              isKnown |= other.Vertex == candidate.Vertex;
            }
            if (isKnown || !(candidate.Squared < nearest[last].Squared))
            {
              continue;
            }
            known[static_cast<std::uint32_t>(candidate.Vertex) % places] = keyOf(candidate.Vertex);
            int place = last;
            for (; place > k && candidate.Squared < nearest[place - 1].Squared; --place)
            {
              nearest[place] = nearest[place - 1];
            }
            nearest[place] = candidate;
          }
        }
        if (k == last || nearest[k].Vertex == None)
        {
          break;
        }
        passed = nearest[k].Vertex;
      }
      int k = last;
      while (k > 0 && nearest[k].Vertex == None)
      {
        --k; // there are no more
      }
      spacings[v] = SpacingPerNeighborDistance * std::sqrt(nearest[k].Squared);
    }
  };
  constexpr Index pieceVertices = 1 << 11;
  ForEachPiece((count + pieceVertices - 1) / pieceVertices, threads, Part(progress, 0.2, 1.0),
    [&](Index piece) {
      const Index begin = piece * pieceVertices;
      find(begin, begin + std::min(pieceVertices, count - begin));
    });
  return spacings;
}

/** The parts of triangles with the same flag that are connected by edges. */
Parts PartsOfFlags(const Mesh& mesh, const std::vector<char>& flags, const Progress& progress)
{
  return FindParts(mesh, progress, [&](Index h) {
    return flags[Mesh::Triangle(h)] == flags[Mesh::Triangle(mesh.Twin(h))] ? 0 : -1;
  });
}

/**
 * Closes the openings that are smaller than what the tolerance bridges.
 * @param[in] shareOf  shareOf(t): the area of a triangle in parts of what the tolerance bridges
 */
template <typename ShareOf>
void CloseSmallOpenings(
  const Mesh& mesh, ShareOf&& shareOf, std::vector<char>& keep, const Progress& progress)
{
  const Parts parts = PartsOfFlags(mesh, keep, Part(progress, 0.0, 0.5));
  struct Piece
  {
    Index Part;
    double Share;
    Index Triangle;
  };
  std::vector<Piece> pieces;
  std::vector<char> reachesBorder(parts.Count(), 0);
  InStretches(mesh.NumberOfTriangles(), Part(progress, 0.5, 0.7), [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t)
    {
      if (!keep[t])
      {
        const bool isAtBorder =
          mesh.IsBorder(3 * t) || mesh.IsBorder(3 * t + 1) || mesh.IsBorder(3 * t + 2);
        pieces.push_back({ parts.PartOf(t), 0.0, t });
        reachesBorder[parts.PartOf(t)] |= isAtBorder;
      }
    }
  });
  pieces.erase(std::remove_if(pieces.begin(), pieces.end(),
                 [&](const Piece& piece) { return reachesBorder[piece.Part] != 0; }),
    pieces.end());
  for (Piece& piece : pieces)
  {
    piece.Share = shareOf(piece.Triangle);
  }
  // In the order of size, so that the sum does not depend on the order of the triangles.
  Sort(
    pieces.begin(), pieces.end(),
    [](const Piece& p, const Piece& q) {
      return p.Part != q.Part ? p.Part < q.Part : p.Share < q.Share;
    },
    Part(progress, 0.7, 1.0));
  for (auto first = pieces.begin(); first != pieces.end();)
  {
    double sum = 0.0;
    auto last = first;
    for (; last != pieces.end() && last->Part == first->Part; ++last)
    {
      sum += last->Share;
    }
    for (; first != last; ++first)
    {
      keep[first->Triangle] = sum < 1.0;
    }
  }
}

/** Takes out pieces with too few vertices to have a spacing of their own, if others have more. */
void DropSmallPieces(const Mesh& mesh, std::vector<char>& keep, const Progress& progress)
{
  const Parts parts = PartsOfFlags(mesh, keep, Part(progress, 0.0, 0.5));
  // More triangles than so few vertices can have.
  constexpr Index many = 3 * NeighborOfSpacing + 1;
  std::vector<Index> sizes(parts.Count(), 0);
  const Index count = mesh.NumberOfTriangles();
  InStretches(count, Part(progress, 0.5, 0.7), [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t)
    {
      sizes[parts.PartOf(t)] += keep[t];
    }
  });
  std::vector<std::pair<Index, Index>> corners; // (part, vertex)
  bool anyLarge = std::any_of(sizes.begin(), sizes.end(), [](Index size) { return size >= many; });
  InStretches(count, Part(progress, 0.7, 0.9), [&](Index begin, Index end) {
    for (Index h = 3 * begin; h < 3 * end; ++h)
    {
      if (keep[Mesh::Triangle(h)] && sizes[parts.PartOf(Mesh::Triangle(h))] < many)
      {
        corners.emplace_back(parts.PartOf(Mesh::Triangle(h)), mesh.Origin(h));
      }
    }
  });
  Sort(
    corners.begin(), corners.end(), std::less<std::pair<Index, Index>>(), Part(progress, 0.9, 1.0));
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<char> isSmall(parts.Count(), 0);
  for (auto first = corners.begin(); first != corners.end();)
  {
    const auto last = std::find_if(first, corners.end(),
      [&](const std::pair<Index, Index>& corner) { return corner.first != first->first; });
    isSmall[first->first] = last - first <= NeighborOfSpacing;
    anyLarge = anyLarge || last - first > NeighborOfSpacing;
    first = last;
  }
  for (Index t = 0; anyLarge && t < count; ++t)
  {
    keep[t] = keep[t] && !isSmall[parts.PartOf(t)];
  }
}

/**
 * The border of the triangles to keep, as simple rings of vertices in an order of their positions.
 */
Rings BorderOf(const Mesh& mesh, const std::vector<char>& keep, const Progress& progress)
{
  const Progress cutting = Part(progress, 0.95, 1.0);

  // A walk that comes back to a vertex it has passed has closed a ring.
  const Rings walks = TraceBorder(mesh, Part(progress, 0.0, 0.95), keep);
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
      const Index vertex = mesh.Origin(*h);
      if (isOnPath[vertex])
      {
        std::size_t first = path.size() - 1; // most rings are small: back from the end
        while (path[first] != vertex)
        {
          --first;
        }
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

/** The middle one of values not below 0, the higher of two. */
double MedianOf(const Buffer<double>& values)
{
  // Such values have the order of their bits, so that those with the leading bits of the median are
  // found by counting.
  const auto leading = [](double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    return static_cast<std::size_t>(bits >> 47);
  };
  std::vector<Index> counts(std::size_t(1) << 17, 0);
  for (const double value : values)
  {
    ++counts[leading(value)];
  }
  std::size_t before = 0;
  const std::size_t half = values.size() / 2;
  std::size_t place = 0;
  while (before + counts[place] <= half)
  {
    before += counts[place++];
  }
  std::vector<double> near;
  for (const double value : values)
  {
    if (leading(value) == place)
    {
      near.push_back(value);
    }
  }
  const auto median = near.begin() + (half - before);
  std::nth_element(near.begin(), median, near.end());
  return *median;
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
  const LocalMesh local(mesh, Part(options.Monitor, 0.0, 0.1));
  const Index* corners = local.Corners.data();
  const int threads = ResolveNumberOfThreads(options.NumberOfThreads);
  const Buffer<double> spacings =
    FindSpacings(mesh, local, threads, Part(options.Monitor, 0.1, 0.6));

  // The spacing of a triangle: the middle one of its corners' three, which the spacing of a point
  // that lies alone is not, nor of two that lie alone.
  const auto spacingOf = [&](Index t) {
    const double a = spacings[corners[3 * t]];
    const double b = spacings[corners[3 * t + 1]];
    const double c = spacings[corners[3 * t + 2]];
    const double least = std::min({ a, b, c });
    const double middle = std::max(std::min(a, b), std::min(std::max(a, b), c));
    return std::max(LeastSpacing, std::min(middle, LargestSpacingInTriangle * least));
  };
  // The longest edge of each triangle in spacings.
  Buffer<double> ratios;
  ratios.Resize(count);
  constexpr Index pieceTriangles = 1 << 13;
  const Index pieces = (count + pieceTriangles - 1) / pieceTriangles;
  ForEachPiece(pieces, threads, Part(options.Monitor, 0.6, 0.7), [&](Index piece) {
    const Index begin = piece * pieceTriangles;
    const Index end = begin + std::min(pieceTriangles, count - begin);
    for (Index t = begin; t < end; ++t)
    {
      const Index a = corners[3 * t];
      const Index b = corners[3 * t + 1];
      const Index c = corners[3 * t + 2];
      ratios[t] = std::sqrt(std::max({ local.SquaredDistance(a, b), local.SquaredDistance(b, c),
                    local.SquaredDistance(c, a) })) /
        spacingOf(t);
    }
  });
  if (!(result.GapTolerance > 0.0))
  {
    result.GapTolerance = ToleranceOfTypicalTriangle * MedianOf(ratios);
  }

  std::vector<char> keep(count);
  InStretches(count, Part(options.Monitor, 0.7, 0.75), [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t)
    {
      keep[t] = ratios[t] <= result.GapTolerance;
    }
  });
  // In parts of a square of the size that the tolerance bridges.
  const auto shareOf = [&](Index t) {
    const double side = result.GapTolerance * spacingOf(t);
    const double square = side * side;
    const double area =
      0.5 * local.TwiceArea(corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]);
    return square > 0.0 ? area / square : std::numeric_limits<double>::infinity();
  };
  CloseSmallOpenings(mesh, shareOf, keep, Part(options.Monitor, 0.75, 0.82));
  DropSmallPieces(mesh, keep, Part(options.Monitor, 0.82, 0.89));
  result.Vertices = BorderOf(mesh, keep, Part(options.Monitor, 0.89, 1.0));
  Report(options.Monitor, 1.0);
  return result;
}

} // namespace elevation
