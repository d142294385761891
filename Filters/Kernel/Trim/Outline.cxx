// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Outline.h"

#include "Kernel/Base/Base.h"
#include "PartialMesh.h"
#include "Scales.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace elevation
{

namespace
{

// The constants of the rule (Outline.h), found by trials: lattices, lattices thinned to a tenth,
// random points, points graded tenfold and scan lines eight times denser along than across, all cut
// out by outlines with lakes, a fjord, a neck and islands, wider than the tolerance.
constexpr double DefaultTolerance = 4.5;
constexpr double LargestSpacingInTriangle = 2.0;
// The longest edge in a bay, in tolerances. From 1.5 to 2, outlines are nearest to the true ones.
constexpr double LongestInBay = 1.6;
// The cheaper test: fractions of the tolerance, in short spacings. In the same trials, and with
// clusters and real surveys, spacings alone would leave out at most one triangle in 10,000 more, in
// lattices none. With 0.55 the outlines of scan lines are a little worse; without the limit by the
// second edge, gaps between scan lines are taken for surface.
constexpr double CertainSurface = 0.52;
constexpr double SmallGroup = 0.7;
// A line of points wavers by up to a tenth of a spacing; the narrow triangles between scan lines
// eight times denser along than across are seven times as high.
constexpr double LeastHeight = 0.1;

/** The parts of triangles with equal values of flagOf(t), connected by edges. */
template <typename FlagOf>
Components FindFlagParts(const Mesh& mesh, FlagOf&& flagOf, const Progress& progress)
{
  return FindComponents(mesh, progress, [&](Index h) {
    return flagOf(Mesh::Triangle(h)) == flagOf(Mesh::Triangle(mesh.Twin(h))) ? 0 : -1;
  });
}

/** Flags of triangles while the outline is sought. */
enum Flag : char
{
  Outside = 0,
  Surface = 1,
  Bay = 2 ///< surface if it belongs to a small bay
};

/**
 * In whole numbers, so that a sum does not depend on the order. Shares above 1 count as 1, and
 * those below 0, of needles whose area rounding has turned, as 0.
 */
constexpr std::int64_t Whole = std::int64_t(1) << 30;
std::int64_t ToWhole(double share)
{
  return static_cast<std::int64_t>(std::max(0.0, std::min(1.0, share)) * static_cast<double>(Whole));
}

/** What is known of connected triangles that are not surface. */
struct Opening
{
  std::int64_t Share = 0; ///< the area as a fraction of the least lake's
  std::int64_t Open = 0;  ///< length of the border, less twice that along surface
  double Longest = 0.0;   ///< square of its longest edge
  bool ReachesBorder = false;
};

/** Calls look(t, opening) for each triangle that has a place in an opening. */
template <typename IsOpen, typename Look>
void VisitOpenings(const Components& parts, std::vector<Opening>& openings, IsOpen&& isOpen,
  const Progress& progress, Look&& look)
{
  ForEachStretch(static_cast<Index>(parts.Labels.size()), progress, [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t)
    {
      if (isOpen(t))
      {
        look(t, openings[parts.ComponentOf(t)]);
      }
    }
  });
}

/**
 * Closes openings smaller than the least lake that do not reach the border of the mesh.
 * @param[in] shareOf  shareOf(t): the area of a triangle as a fraction of the least lake's
 */
template <typename ShareOf>
void CloseSmallLakes(
  const Mesh& mesh, ShareOf&& shareOf, std::vector<char>& keep, const Progress& progress)
{
  const Components parts = FindFlagParts(
    mesh, [&](Index t) { return keep[t] == Surface; }, SubProgress(progress, 0.0, 0.6));
  std::vector<Opening> openings(parts.Count());
  const auto isOpen = [&](Index t) { return keep[t] != Surface; };
  VisitOpenings(
    parts, openings, isOpen, SubProgress(progress, 0.6, 0.8), [&](Index t, Opening& opening) {
      opening.Share += ToWhole(shareOf(t));
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        opening.ReachesBorder |= mesh.IsBorder(h);
      }
    });
  VisitOpenings(
    parts, openings, isOpen, SubProgress(progress, 0.8, 1.0), [&](Index t, Opening& opening) {
      if (!opening.ReachesBorder && opening.Share < Whole)
      {
        keep[t] = Surface;
      }
    });
}

/** Closes bays smaller than the least lake, with surface along at least half of their border. */
template <typename ShareOf>
void CloseSmallBays(
  const Mesh& mesh, ShareOf&& shareOf, std::vector<char>& keep, const Progress& progress)
{
  const Components parts = FindFlagParts(
    mesh, [&](Index t) { return keep[t]; }, SubProgress(progress, 0.0, 0.5));
  std::vector<Opening> openings(parts.Count());
  const auto isOpen = [&](Index t) { return keep[t] == Bay; };
  VisitOpenings(
    parts, openings, isOpen, SubProgress(progress, 0.5, 0.7), [&](Index t, Opening& opening) {
      opening.Share += ToWhole(shareOf(t));
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        opening.Longest = std::max(opening.Longest, mesh.SquaredLengthOf(h));
      }
    });
  VisitOpenings(
    parts, openings, isOpen, SubProgress(progress, 0.7, 0.9), [&](Index t, Opening& opening) {
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        const char beside =
          mesh.IsBorder(h) ? static_cast<char>(Outside) : keep[Mesh::Triangle(mesh.Twin(h))];
        const std::int64_t length =
          beside == Bay ? 0 : ToWhole(std::sqrt(mesh.SquaredLengthOf(h) / opening.Longest)) >> 8;
        opening.Open += beside == Surface ? -length : length;
      }
    });
  VisitOpenings(
    parts, openings, isOpen, SubProgress(progress, 0.9, 1.0), [&](Index t, Opening& opening) {
      keep[t] = opening.Share < Whole && opening.Open <= 0 ? Surface : Outside;
    });
}

/** Whether an edge is the longest of its triangle, or one of them. */
bool IsLongest(const Mesh& mesh, Index h)
{
  const Index t = Mesh::Triangle(h);
  const double squared = mesh.SquaredLengthOf(h);
  return mesh.SquaredLengthOf(3 * t) <= squared && mesh.SquaredLengthOf(3 * t + 1) <= squared &&
    mesh.SquaredLengthOf(3 * t + 2) <= squared;
}

/**
 * Makes slivers parts of bays, from the border inwards, each across its longest edge: so its apex
 * comes to the border, and no vertex is lost. Linear.
 * @param[in] isSliver  isSliver(t): whether the triangle is very flat
 */
template <typename IsSliver>
void DropSlivers(
  const Mesh& mesh, IsSliver&& isSliver, std::vector<char>& keep, const Progress& progress)
{
  std::vector<Index> dropped;
  const auto look = [&](Index h) {
    const Index t = Mesh::Triangle(h);
    if (keep[t] == Surface && IsLongest(mesh, h) && isSliver(t))
    {
      keep[t] = Bay;
      dropped.push_back(t);
    }
  };
  ForEachStretch(mesh.NumberOfHalfEdges(), progress, [&](Index begin, Index end) {
    for (Index h = begin; h < end; ++h)
    {
      if (mesh.IsBorder(h) || keep[Mesh::Triangle(mesh.Twin(h))] != Surface)
      {
        look(h);
      }
      while (!dropped.empty())
      {
        const Index first = 3 * dropped.back();
        dropped.pop_back();
        for (Index side = first; side < first + 3; ++side)
        {
          if (!mesh.IsBorder(side))
          {
            look(mesh.Twin(side));
          }
        }
      }
    }
  });
}

/**
 * Drops pieces with too few vertices for spacings of their own, if others have more.
 * @return vertices of pieces that look small but continue beyond the mesh; if any, nothing is done
 */
std::vector<Index> DropSmallPieces(
  const Mesh& mesh, std::vector<char>& keep, const Progress& progress)
{
  const Components parts = FindFlagParts(
    mesh, [&](Index t) { return keep[t]; }, SubProgress(progress, 0.0, 0.5));
  // More triangles than so few vertices can form.
  constexpr Index many = 3 * SpacingNeighbor + 1;
  std::vector<Index> sizes(parts.Count(), 0);
  std::vector<char> goesOn(parts.Count(), 0);
  const Index count = mesh.NumberOfTriangles();
  ForEachStretch(count, SubProgress(progress, 0.5, 0.7), [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t)
    {
      sizes[parts.ComponentOf(t)] += keep[t];
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        goesOn[parts.ComponentOf(t)] |= mesh.Twin(h) == h;
      }
    }
  });
  std::vector<std::pair<Index, Index>> corners; // (part, vertex)
  bool anyLarge = std::any_of(sizes.begin(), sizes.end(), [](Index size) { return size >= many; });
  ForEachStretch(count, SubProgress(progress, 0.7, 0.9), [&](Index begin, Index end) {
    for (Index h = 3 * begin; h < 3 * end; ++h)
    {
      if (keep[Mesh::Triangle(h)] && sizes[parts.ComponentOf(Mesh::Triangle(h))] < many)
      {
        corners.emplace_back(parts.ComponentOf(Mesh::Triangle(h)), mesh.Origin(h));
      }
    }
  });
  Sort(corners.begin(), corners.end(), std::less<std::pair<Index, Index>>(),
    SubProgress(progress, 0.9, 1.0));
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<char> isSmall(parts.Count(), 0);
  std::vector<Index> unknown;
  for (auto first = corners.begin(); first != corners.end();)
  {
    const auto last = std::find_if(first, corners.end(),
      [&](const std::pair<Index, Index>& corner) { return corner.first != first->first; });
    const bool isFew = last - first <= SpacingNeighbor;
    for (auto corner = first; isFew && goesOn[first->first] && corner != last; ++corner)
    {
      unknown.push_back(corner->second);
    }
    isSmall[first->first] = isFew;
    anyLarge = anyLarge || !isFew;
    first = last;
  }
  for (Index t = 0; anyLarge && unknown.empty() && t < count; ++t)
  {
    keep[t] = keep[t] && !isSmall[parts.ComponentOf(t)];
  }
  return unknown;
}

/**
 * The border of the triangles to keep, as simple rings of vertices, sorted by their positions.
 */
Rings BorderOf(const Mesh& mesh, const std::vector<char>& keep, const Progress& progress)
{
  const Progress cutting = SubProgress(progress, 0.6, 0.8);

  // A walk that returns to a vertex on its path closes a ring.
  const Rings walks = TraceBorder(mesh, SubProgress(progress, 0.0, 0.6), keep);
  Rings rings;
  rings.Vertices.reserve(walks.Vertices.size());
  std::vector<Index> path;
  std::vector<char> isOnPath(mesh.Points.size(), 0);
  for (Index walk = 0; walk < walks.Count(); ++walk)
  {
    auto cutRing = [&](std::size_t first) {
      auto lowest = path.begin() + first;
      for (auto v = lowest + 1; v != path.end(); ++v)
      {
        // Of two vertices at the same place, the next ones decide.
        const auto nextTo = [&](const auto& w) {
          return mesh.PointOf(w + 1 == path.end() ? path[first] : w[1]);
        };
        const Point2& p = mesh.PointOf(*v);
        const Point2& q = mesh.PointOf(*lowest);
        if (IsLower(p, q) || (p == q && IsLower(nextTo(v), nextTo(lowest))))
        {
          lowest = v;
        }
      }
      std::rotate(path.begin() + first, lowest, path.end());
      rings.Vertices.insert(rings.Vertices.end(), path.begin() + first, path.end());
      rings.Offsets.push_back(static_cast<Index>(rings.Vertices.size()));
    };
    for (const Index* h : Counted(walks.Begin(walk), walks.End(walk)))
    {
      ReportStep(cutting, h - walks.Vertices.data(), walks.Vertices.size());
      const Index vertex = mesh.Origin(*h);
      if (isOnPath[vertex])
      {
        std::size_t first = path.size() - 1; // backwards, as most rings are small
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
  const auto isBefore = [&](Index r, Index s) {
    for (Index i = 0; i < std::min(rings.Size(r), rings.Size(s)); ++i)
    {
      const Point2& p = mesh.PointOf(rings.Begin(r)[i]);
      const Point2& q = mesh.PointOf(rings.Begin(s)[i]);
      if (p != q)
      {
        return IsLower(p, q);
      }
    }
    return rings.Size(r) < rings.Size(s);
  };
  std::vector<Index> order(rings.Count());
  std::iota(order.begin(), order.end(), 0);
  Sort(order.begin(), order.end(), isBefore, SubProgress(progress, 0.8, 0.95));
  Rings result;
  result.Vertices.reserve(rings.Vertices.size());
  for (const Index ring : Counted(order))
  {
    ReportStep(progress, 19 * order.size() + result.Count(), 20 * order.size());
    result.Vertices.insert(result.Vertices.end(), rings.Begin(ring), rings.End(ring));
    result.Offsets.push_back(static_cast<Index>(result.Vertices.size()));
  }
  return result;
}

/** The corners of outward triangles that no triangle of the surface has. */
IdSet CornersLeftOut(const TriangleList& list, const std::vector<Index>& outward,
  const std::vector<char>& keep, const Progress& progress)
{
  IdSet leftOut(list.Points.Count);
  for (const Index t : outward)
  {
    leftOut.AddAll(list.CornersOf(t));
  }
  ForEachStretch(list.Count, progress, [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t)
    {
      if (leftOut.HasAny(list.CornersOf(t)) && keep[t])
      {
        leftOut.RemoveAll(list.CornersOf(t));
      }
    }
  });
  return leftOut;
}

/** The area within the border. */
double AreaOf(const TriangleList& list, const std::vector<BorderEdge>& border)
{
  double sum = 0.0;
  for (const BorderEdge& edge : border)
  {
    const Point2 o = list.Points.At(border.front().Origin);
    const Point2 p = list.Points.At(edge.Origin);
    const Point2 q = list.Points.At(edge.Destination);
    sum += 0.5 * ((p.X - o.X) * (q.Y - o.Y) - (p.Y - o.Y) * (q.X - o.X));
  }
  return sum;
}

/**
 * The spacing of a triangle: the median of its corners', which ignores the large spacing of an
 * isolated corner, but not far above the least, in case two corners are isolated.
 */
template <typename Real>
double SpacingOf(const Buffer<Real>& spacings, const Index* corners)
{
  const Real a = spacings[corners[0]];
  const Real b = spacings[corners[1]];
  const Real c = spacings[corners[2]];
  const Real least = std::min({ a, b, c });
  const Real middle = std::max(std::min(a, b), std::min(std::max(a, b), c));
  return std::max<double>(LeastSpacing, std::min<double>(middle, LargestSpacingInTriangle * least));
}

/**
 * Removes triangles that are surface in any case from a list: groups, connected by corners and away
 * from the border, without room for a lake.
 * @param[in]     shareOf  shareOf(t): the area of a triangle as a fraction of the least lake's
 * @param[in,out] keep     set for the triangles removed
 * @return the others
 */
template <typename ShareOf>
std::vector<Index> DropSmallGroups(const TriangleList& list, const IdSet& atBorder,
  const std::vector<Index>& triangles, ShareOf&& shareOf, std::vector<char>& keep,
  const Progress& progress)
{
  Buffer<Index> parents; // of vertices, UnionFind.h
  parents.Resize(list.Points.Count);
  std::iota(parents.begin(), parents.end(), 0);
  Buffer<std::int64_t> sums;
  sums.Resize(list.Points.Count);
  std::fill(sums.begin(), sums.end(), 0);
  const Index count = static_cast<Index>(triangles.size());
  ForEachStretch(count, SubProgress(progress, 0.0, 0.7), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
    {
      const Index* ahead = list.CornersOf(triangles[std::min(i + 16, count - 1)]);
      const Index* corners = list.CornersOf(triangles[i]);
      const bool isAtBorder = atBorder.HasAny(corners);
      const double share = isAtBorder ? 1.0 : shareOf(triangles[i]);
      Index root = RootOf(parents, corners[0]);
      sums[root] += ToWhole(share);
      for (int k = 0; k < 3; ++k)
      {
        list.PrefetchPoint(ahead[k]);
        Prefetch(&parents[ahead[k]]);
        Prefetch(&sums[ahead[k]]);
        const Index other = RootOf(parents, corners[k]);
        if (other != root)
        {
          parents[std::max(root, other)] = std::min(root, other);
          sums[std::min(root, other)] += sums[std::max(root, other)];
          root = std::min(root, other);
        }
      }
    }
  });
  std::vector<Index> others;
  ForEachStretch(count, SubProgress(progress, 0.7, 1.0), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
    {
      const Index t = triangles[i];
      keep[t] = sums[RootOf(parents, list.CornersOf(t)[0])] < Whole;
      if (!keep[t])
      {
        others.push_back(t);
      }
    }
  });
  return others;
}

/** The border of a mesh that the measured triangles are, or are a part of. */
struct BorderOfMesh
{
  std::vector<BorderEdge> Edges; ///< sorted
  IdSet Vertices;
  bool IsPart; ///< whether the triangles are only a part
};

/**
 * The last steps: drops slivers, closes small bays and lakes, drops small pieces, and traces the
 * border of the rest.
 * @param[in]     spacingOf  spacingOf(t): of triangles that are not yet surface
 * @param[in]     near       the corners at the border of the surface found so far
 * @param[in]     dropSmall  whether to drop small pieces
 * @param[in,out] result     in: a Flag for each triangle; out: Outside or Surface, and the rings
 * @return false if the triangles are a part of a mesh, too small to decide which pieces are small
 */
template <typename SpacingOfTriangle>
bool TraceSurface(const MeasuredTriangles& measured, const BorderOfMesh& border,
  SpacingOfTriangle&& spacingOf, IdSet near, bool dropSmall, const Progress& progress,
  ExtractedBoundary& result)
{
  const TriangleList& list = measured.List;
  std::vector<char>& keep = result.IsSurface;
  const auto isFlat = [&](Index t) {
    const double spacing = SpacingOf(measured.ShortSpacings, list.CornersOf(t));
    return 2.0 * list.SquareShare(t, spacing) * spacing <
      LeastHeight * std::sqrt(measured.Longest[t]);
  };
  // Slivers have two corners at the border, or at flat triangles with a corner there. Then the mesh
  // includes all their neighbours.
  IdSet atEdge = near;
  for (const Index t : TrianglesAt(list, near, SubProgress(progress, 0.0, 0.1)))
  {
    if (isFlat(t))
    {
      atEdge.AddAll(list.CornersOf(t));
    }
  }
  near = atEdge;
  double begin = 0.1; // of the round, in the progress
  for (;;)
  {
    // A second round is rare, a third even rarer.
    const double end = 0.5 * (1.0 + begin);
    const Progress round = SubProgress(progress, begin, end);
    begin = end;
    std::vector<Index> triangles = TrianglesAt(list, near, SubProgress(round, 0.0, 0.1));
    if (border.IsPart || static_cast<Index>(triangles.size()) > list.Count / 3 * 2)
    {
      // Take all of them; this is then the last round.
      triangles = AllTriangles(list);
    }
    const PartialMesh mesh(list, border.Edges, border.Vertices, std::move(triangles),
      SubProgress(round, 0.1, 0.3), border.IsPart);
    std::vector<char> keepHere = mesh.FlagsOf(keep);
    // As a fraction of the least lake. Slivers, which were surface before, have hardly any area,
    // and their spacings are not known.
    const auto shareOf = [&](Index i) {
      const Index t = mesh.Triangles[i];
      return keep[t] == Surface ? 0.0 : list.SquareShare(t, spacingOf(t));
    };
    const auto isSliver = [&](Index i) {
      const Index t = mesh.Triangles[i];
      const Index* corners = list.CornersOf(t);
      return atEdge.Has(corners[0]) + atEdge.Has(corners[1]) + atEdge.Has(corners[2]) >= 2 &&
        isFlat(t);
    };
    DropSlivers(mesh.Surface, isSliver, keepHere, SubProgress(round, 0.3, 0.4));
    if (std::find(keepHere.begin(), keepHere.end(), char(Surface)) == keepHere.end() &&
      !border.IsPart && static_cast<Index>(mesh.Triangles.size()) == list.Count)
    {
      keepHere = mesh.FlagsOf(keep); // the surface is nothing but slivers
    }
    CloseSmallLakes(mesh.Surface, shareOf, keepHere, SubProgress(round, 0.4, 0.48));
    CloseSmallBays(mesh.Surface, shareOf, keepHere, SubProgress(round, 0.48, 0.55));
    const std::vector<Index> unknown = dropSmall
      ? DropSmallPieces(mesh.Surface, keepHere, SubProgress(round, 0.55, 0.8))
      : std::vector<Index>();
    if (unknown.empty())
    {
      mesh.PutFlags(keepHere, keep);
      result.Vertices = BorderOf(mesh.Surface, keepHere, SubProgress(round, 0.8, 1.0));
      ToIds(result.Vertices.Vertices, mesh.Surface.Ids.data(), SubProgress(round, 1.0, 1.0));
      return true;
    }
    if (border.IsPart)
    {
      return false;
    }
    // In the next round, include more of these pieces.
    for (const Index vertex : unknown)
    {
      near.Add(mesh.Surface.Ids[vertex]);
    }
  }
}

class OutlineSearch
{
public:
  OutlineSearch(MeasuredTriangles measured, const ExtractOptions& options)
    : Measured(std::move(measured))
    , Threads(ResolveNumberOfThreads(options.NumberOfThreads))
    , IsAutomatic(!(options.GapTolerance > 0.0))
    , Tolerance(this->IsAutomatic ? DefaultTolerance : options.GapTolerance)
    , Grid(options.Grid)
    , Border{ this->Measured.Border, IdSet(this->Measured.List.Points.Count), false }
  {
    this->Result.GapTolerance = this->Tolerance;
  }

  /** For a part of a mesh. @param[in] numbers  of the ids of points, in the measured triangles */
  OutlineSearch(MeasuredTriangles measured, const ExtractOptions& options, OutlineMesh&& mesh,
    const std::vector<Index>& numbers)
    : OutlineSearch(std::move(measured), options)
  {
    this->Border.IsPart = true;
    this->Border.Edges = std::move(mesh.Border);
    for (BorderEdge& edge : this->Border.Edges)
    {
      edge = { numbers[edge.Origin], numbers[edge.Destination] };
    }
    this->States = mesh.States.data();
    this->NumberOfPoints = mesh.NumberOfPoints;
    this->Spacings.Resize(this->Measured.List.Points.Count);
    for (std::size_t id = 0; id < numbers.size(); ++id)
    {
      if (numbers[id] != None)
      {
        this->Spacings[numbers[id]] = mesh.Spacings[id];
      }
    }
  }

  /** @return nothing only if the triangles are a part of a mesh, too small to find the outline */
  std::optional<ExtractedBoundary> Run(const Progress& progress)
  {
    const TriangleList& list = this->Measured.List;
    this->SortBorder(SubProgress(progress, 0.0, 0.02));
    const Neighbors neighbors(this->Measured, SubProgress(progress, 0.02, 0.15));
    if (!this->Border.IsPart)
    {
      this->Spacings.Resize(list.Points.Count);
    }
    this->KeepCertainTriangles(SubProgress(progress, 0.15, 0.2));
    std::vector<Index> doubtful = this->FindDoubtful(SubProgress(progress, 0.2, 0.32));
    Report(progress, 0.32);
    // How long the next steps take depends on how many are doubtful. Where these are few, no step
    // has so large a share that progress jumps.
    const double share =
      std::clamp(20.0 * static_cast<double>(doubtful.size()) / list.Count, 0.6, 1.0);
    const double scaled = 0.32 + (this->IsAutomatic ? 0.25 * share : 0.0);
    const double decided = scaled + 0.25 * share + 0.03;
    if (this->IsAutomatic && this->Border.IsPart)
    {
      const IdSet lonely = this->LonelyWithin(neighbors, this->CornersNear(doubtful));
      if (!AreFew(neighbors, lonely, list.Points.Count, this->NumberOfPoints))
      {
        return std::nullopt;
      }
    }
    else if (this->IsAutomatic)
    {
      this->Scales =
        FindScales(this->Measured, neighbors, this->Border.Vertices, this->CornersNear(doubtful),
          this->Threads, SubProgress(progress, 0.32, scaled), this->Spacings.data());
      this->Result.GapTolerance *= this->TypicalScale();
    }
    const std::vector<Index> outside =
      this->FindOutsideOfGrid(SubProgress(progress, scaled, scaled));
    const auto middle = doubtful.insert(doubtful.end(), outside.begin(), outside.end());
    std::inplace_merge(doubtful.begin(), middle, doubtful.end());
    doubtful.erase(std::unique(doubtful.begin(), doubtful.end()), doubtful.end());
    if (!this->FindCornerSpacings(
          doubtful, neighbors, SubProgress(progress, scaled, decided - 0.03)))
    {
      return std::nullopt;
    }
    this->Decide(doubtful, SubProgress(progress, decided - 0.03, decided));
    for (const Index t : outside)
    {
      this->Result.IsSurface[t] = Outside;
    }
    if (!TraceSurface(
          this->Measured, this->Border, [&](Index t) { return this->ToleranceOf(t); },
          this->CornersNear(doubtful), !this->Grid.IsSet(), SubProgress(progress, decided, 0.97),
          this->Result))
    {
      return std::nullopt;
    }
    if (!this->MeasureLoss(neighbors, SubProgress(progress, 0.97, 1.0)))
    {
      return std::nullopt;
    }
    if (this->Measured.Ids.size() > 0)
    {
      ToIds(
        this->Result.Vertices.Vertices, this->Measured.Ids.data(), SubProgress(progress, 1.0, 1.0));
    }
    Report(progress, 1.0);
    return std::move(this->Result);
  }

  /** FindOutlinePart() */
  OutlinePart FindPart(int margin, const Progress& progress)
  {
    const TriangleList& list = this->Measured.List;
    const IdSet& border = this->Border.Vertices;
    this->SortBorder(SubProgress(progress, 0.0, 0.02));
    const Neighbors neighbors(this->Measured, SubProgress(progress, 0.02, 0.15));
    this->Spacings.Resize(list.Points.Count);
    this->KeepCertainTriangles(SubProgress(progress, 0.15, 0.2));
    for (const Index t : TrianglesAt(list, border, SubProgress(progress, 0.2, 0.25)))
    {
      this->Result.IsSurface[t] = Outside; // not all edges are known there
    }
    const std::vector<Index> doubtful = this->FindDoubtful(SubProgress(progress, 0.25, 0.4));
    const IdSet lonely = this->IsAutomatic
      ? LonelyVertices(neighbors, this->CornersNear(doubtful), list.Points.Count)
      : IdSet(0);
    IdSet near(list.Points.Count);
    for (const Index v : lonely.List())
    {
      near.Add(v);
    }
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    std::fill(this->Spacings.begin(), this->Spacings.end(), unknown);
    FindSpacings(list, neighbors, CornersOf(list, doubtful, SubProgress(progress, 0.4, 0.45)),
      this->Threads, SubProgress(progress, 0.45, 0.6), this->Spacings.data(), &border);
    // Of groups that reach the border, other parts may have more.
    std::vector<char> isInside(list.Count, 0);
    const auto nothing = [](Index) { return 0.0; };
    DropSmallGroups(list, border, doubtful, nothing, isInside, SubProgress(progress, 0.6, 0.65));
    std::vector<Known> states(list.Count, Known::Surface);
    for (const Index t : doubtful)
    {
      states[t] = !isInside[t]        ? Known::Nothing
        : this->IsSurfaceBySpacing(t) ? Known::SurfaceBySpacing
                                      : Known::Doubtful;
      // What is at the border is taken in any case.
      if (states[t] > Known::SurfaceBySpacing && !border.HasAny(list.CornersOf(t)))
      {
        near.AddAll(list.CornersOf(t));
      }
    }
    for (const Index t : this->FindBridges(SubProgress(progress, 0.65, 0.65)))
    {
      near.AddAll(list.CornersOf(t)); // the border of the mesh may be in another part
    }
    return this->PartNear(near, margin, states, SubProgress(progress, 0.65, 1.0));
  }

private:
  void SortBorder(const Progress& progress)
  {
    std::vector<BorderEdge>& border = this->Border.Edges;
    Sort(border.begin(), border.end(), std::less<BorderEdge>(), progress);
    for (const BorderEdge& edge : border)
    {
      this->Border.Vertices.Add(edge.Origin);
      this->Border.Vertices.Add(edge.Destination);
    }
    if (!this->Border.IsPart)
    {
      this->Measured.Border = border;
      return;
    }
    this->Ends = IdSet(this->Measured.List.Points.Count);
    for (const BorderEdge& edge : this->Measured.Border)
    {
      if (!std::binary_search(border.begin(), border.end(), edge))
      {
        this->Ends.Add(edge.Origin);
        this->Ends.Add(edge.Destination);
      }
    }
  }

  /** Of a triangle of a part; false if a corner's spacing depends on other parts. */
  bool IsSurfaceBySpacing(Index t) const
  {
    const Index* const corners = this->Measured.List.CornersOf(t);
    const auto isKnown = [this](Index v) { return !std::isnan(this->Spacings[v]); };
    return std::all_of(corners, corners + 3, isKnown) && !this->Border.Vertices.HasAny(corners) &&
      std::sqrt(this->Measured.Longest[t]) <= this->ToleranceOf(t);
  }

  /** Adds the vertices that are up to some edges away. */
  void Widen(int edges, const Progress& progress, IdSet& vertices) const
  {
    const TriangleList& list = this->Measured.List;
    for (int step = 0; step < edges; ++step)
    {
      for (const Index t : TrianglesAt(list, vertices, progress))
      {
        vertices.AddAll(list.CornersOf(t));
      }
    }
  }

  /** What is around the border and some vertices, for FindPart(). */
  OutlinePart PartNear(
    const IdSet& vertices, int margin, const std::vector<Known>& states, const Progress& progress)
  {
    const TriangleList& list = this->Measured.List;
    constexpr int around = 3;
    IdSet near = this->Border.Vertices, both(list.Points.Count);
    this->Widen(margin - around, Progress(), near);
    Report(progress, 0.4);
    near.Add(vertices, both);
    this->Widen(around, Progress(), near);
    OutlinePart part;
    part.Triangles = TrianglesAt(list, near, SubProgress(progress, 0.7, 0.9));
    for (const Index t : part.Triangles)
    {
      part.States.push_back(states[t]);
    }
    part.NumberOfInnerPoints = this->Measured.NumberOfCorners() - this->Border.Vertices.Count();
    part.Border = std::move(this->Border.Edges);
    const Buffer<Index>& ids = this->Measured.Ids;
    for (BorderEdge& edge : part.Border)
    {
      edge = { ids[edge.Origin], ids[edge.Destination] };
    }
    part.Spacings.assign(ids.size(), std::numeric_limits<double>::quiet_NaN());
    for (Index v = 0; v < list.Points.Count; ++v)
    {
      if (ids[v] != None)
      {
        part.Spacings[ids[v]] = this->Spacings[v];
      }
    }
    return part;
  }

  /** The lonely vertices of a mesh; not where the triangles taken of it end. */
  IdSet LonelyWithin(const Neighbors& neighbors, IdSet near) const
  {
    const TriangleList& list = this->Measured.List;
    for (Index t = 0; t < list.Count; ++t)
    {
      if (this->States[t] == Known::SurfaceBySpacing)
      {
        near.AddAll(list.CornersOf(t));
      }
    }
    IdSet within(list.Points.Count);
    for (const Index v : LonelyVertices(neighbors, near, list.Points.Count).List())
    {
      if (!this->Ends.Has(v))
      {
        within.Add(v);
      }
    }
    return within;
  }

  /**
   * Finds the spacings at the corners of triangles.
   * @return false if the triangles are a part of a mesh, too small to find one
   */
  bool FindCornerSpacings(
    const std::vector<Index>& triangles, const Neighbors& neighbors, const Progress& progress)
  {
    Report(progress, 0.0);
    const TriangleList& list = this->Measured.List;
    std::vector<Index> corners = CornersOf(list, triangles, SubProgress(progress, 0.0, 0.1));
    const auto isKnown = [this](Index v) { return !std::isnan(this->Spacings[v]); };
    if (this->Border.IsPart)
    {
      corners.erase(std::remove_if(corners.begin(), corners.end(), isKnown), corners.end());
    }
    FindSpacings(list, neighbors, corners, this->Threads, SubProgress(progress, 0.1, 1.0),
      this->Spacings.data(), this->Border.IsPart ? &this->Ends : nullptr);
    Report(progress, 1.0);
    return !this->Border.IsPart || std::all_of(corners.begin(), corners.end(), isKnown);
  }

  /** The scale of the median vertex. */
  double TypicalScale() const
  {
    std::vector<float> scales = this->Scales;
    const auto median = scales.begin() + static_cast<std::ptrdiff_t>(scales.size() / 2);
    std::nth_element(scales.begin(), median, scales.end());
    return median == scales.end() ? 1.0 : *median;
  }

  double ScaleAt(Index vertex) const { return this->Scales.empty() ? 1.0 : this->Scales[vertex]; }

  /** The longest edge that a triangle may have. */
  double ToleranceOf(Index t) const
  {
    const Index* const corners = this->Measured.List.CornersOf(t);
    double spacing = SpacingOf(this->Spacings, corners);
    for (int k = 0; k < 3; ++k)
    {
      // Not at once, as the largest spacing replaces the median.
      const double scale = this->ScaleAt(corners[k]);
      spacing = std::max(spacing, std::min(1.0, scale - 1.0) * scale * this->Spacings[corners[k]]);
    }
    return this->Tolerance * spacing;
  }

  /** The same for triangles in bays. */
  double ToleranceOfBay(Index t) const
  {
    const Index* const corners = this->Measured.List.CornersOf(t);
    double spacing = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      spacing = std::max(spacing, this->ScaleAt(corners[k]) * this->Spacings[corners[k]]);
    }
    return LongestInBay * this->Tolerance * spacing;
  }

  /** The cheaper test, by short spacings. */
  void KeepCertainTriangles(const Progress& progress)
  {
    const TriangleList& list = this->Measured.List;
    const Buffer<float>& shortSpacings = this->Measured.ShortSpacings;
    const Buffer<double>& longest = this->Measured.Longest;
    std::vector<char>& keep = this->Result.IsSurface;
    keep.resize(list.Count);
    const double limit = CertainSurface * this->Tolerance;
    const auto isWithin = [&](Index, Index begin, Index end) {
      for (Index t = begin; t < end; ++t)
      {
        const Index* ahead = list.CornersOf(std::min(t + 40, end - 1));
        Prefetch(&shortSpacings[ahead[1]]);
        Prefetch(&shortSpacings[ahead[2]]);
        const double length = limit * SpacingOf(shortSpacings, list.CornersOf(t));
        keep[t] = longest[t] <= length * length ||
          (this->States && this->States[t] <= Known::SurfaceBySpacing);
      }
    };
    constexpr Index atOnce = 1 << 13;
    ForEachRange(list.Count, this->Threads, progress, isWithin, atOnce);
  }

  /** The triangles that are not kept yet, without those of groups too small for a lake. */
  std::vector<Index> FindDoubtful(const Progress& progress)
  {
    const TriangleList& list = this->Measured.List;
    std::vector<char>& keep = this->Result.IsSurface;
    std::vector<Index> doubtful, inGroups; // the groups of the others are known
    ForEachStretch(list.Count, SubProgress(progress, 0.0, 0.2), [&](Index begin, Index end) {
      for (Index t = begin; t < end; ++t)
      {
        if (!keep[t])
        {
          const bool isKnown = this->States && this->States[t] == Known::Doubtful;
          (isKnown ? doubtful : inGroups).push_back(t);
        }
      }
    });
    const auto shareOf = [&](Index t) {
      const double spacing = SpacingOf(this->Measured.ShortSpacings, list.CornersOf(t));
      return list.SquareShare(t, SmallGroup * this->Tolerance * spacing);
    };
    const std::vector<Index> others = DropSmallGroups(
      list, this->Border.Vertices, inGroups, shareOf, keep, SubProgress(progress, 0.2, 1.0));
    const auto middle = doubtful.insert(doubtful.end(), others.begin(), others.end());
    std::inplace_merge(doubtful.begin(), middle, doubtful.end());
    return doubtful;
  }

  /** Whether an edge goes more than one step along either axis of the grid. */
  bool BridgesNodes(const Point2& p, const Point2& q) const
  {
    const Point2& u = this->Grid.StepU;
    const Point2& v = this->Grid.StepV;
    const double x = (q.X - p.X) / this->Measured.Scale, y = (q.Y - p.Y) / this->Measured.Scale;
    constexpr double most = 1.5; // the next is two steps
    const double cell = std::fabs(this->Grid.Area());
    return std::fabs(x * v.Y - y * v.X) > most * cell || std::fabs(u.X * y - u.Y * x) > most * cell;
  }

  /** The triangles with an edge that bridges missing nodes of the grid; increasing. */
  std::vector<Index> FindBridges(const Progress& progress) const
  {
    const TriangleList& list = this->Measured.List;
    std::vector<Index> bridges;
    ForEachStretch(this->Grid.IsSet() ? list.Count : 0, progress, [&](Index begin, Index end) {
      for (Index t = begin; t < end; ++t)
      {
        const Index* const corners = list.CornersOf(t);
        const Point2 p = list.Points.At(corners[0]), q = list.Points.At(corners[1]),
                     r = list.Points.At(corners[2]);
        if (this->BridgesNodes(p, q) || this->BridgesNodes(q, r) || this->BridgesNodes(r, p))
        {
          bridges.push_back(t);
        }
      }
    });
    return bridges;
  }

  /** The triangles that are reached from the border of the mesh across such edges; increasing. */
  std::vector<Index> FindOutsideOfGrid(const Progress& progress) const
  {
    std::vector<Index> bridges = this->FindBridges(progress);
    if (bridges.empty())
    {
      return bridges;
    }
    const PartialMesh mesh(this->Measured.List, this->Border.Edges, this->Border.Vertices,
      std::move(bridges), progress, this->Border.IsPart);
    const Mesh& surface = mesh.Surface;
    std::vector<char> isOutside(surface.NumberOfTriangles(), 0);
    std::vector<Index> stack;
    const auto enter = [&](Index h, Index t) {
      if (!isOutside[t] &&
        this->BridgesNodes(
          surface.PointOf(surface.Origin(h)), surface.PointOf(surface.Destination(h))))
      {
        isOutside[t] = 1;
        stack.push_back(t);
      }
    };
    for (const Index h : Counted(surface.NumberOfHalfEdges()))
    {
      if (surface.IsBorder(h))
      {
        enter(h, Mesh::Triangle(h));
      }
    }
    while (!stack.empty())
    {
      CountWork(1);
      const Index t = stack.back();
      stack.pop_back();
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        // A neighbour that is left out is behind a short edge.
        if (!surface.IsBorder(h) && surface.Twin(h) != h)
        {
          enter(h, Mesh::Triangle(surface.Twin(h)));
        }
      }
    }
    std::vector<Index> outside;
    for (Index t = 0; t < surface.NumberOfTriangles(); ++t)
    {
      if (isOutside[t])
      {
        outside.push_back(mesh.Triangles[t]);
      }
    }
    return outside;
  }

  /** The corners of triangles that are not surface, and those at the border. */
  IdSet CornersNear(const std::vector<Index>& triangles) const
  {
    IdSet near = this->Border.Vertices;
    for (const Index t : triangles)
    {
      if (this->Result.IsSurface[t] != Surface)
      {
        near.AddAll(this->Measured.List.CornersOf(t));
      }
    }
    return near;
  }

  /** Tests the doubtful triangles by spacings. */
  void Decide(const std::vector<Index>& doubtful, const Progress& progress)
  {
    ForEachStretch(static_cast<Index>(doubtful.size()), progress, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i)
      {
        const Index t = doubtful[i];
        const double longest = std::sqrt(this->Measured.Longest[t]);
        this->Result.IsSurface[t] = longest <= this->ToleranceOf(t) ? Surface
          : longest <= this->ToleranceOfBay(t)                      ? Bay
                                                                    : Outside;
      }
    });
  }

  /**
   * Finds what is left out, and if it is much, the tolerance that would keep it.
   * @return false as FindCornerSpacings()
   */
  bool MeasureLoss(const Neighbors& neighbors, const Progress& progress)
  {
    const TriangleList& list = this->Measured.List;
    const std::vector<char>& keep = this->Result.IsSurface;
    std::vector<Index> outward;
    double area = 0.0;
    for (auto t = keep.begin(); (t = std::find(t, keep.end(), char(Outside))) != keep.end(); ++t)
    {
      outward.push_back(static_cast<Index>(t - keep.begin()));
      area += list.SquareShare(outward.back(), 1.0);
    }
    const IdSet leftOut = CornersLeftOut(list, outward, keep, SubProgress(progress, 0.0, 0.6));
    this->Result.NumberOfPointsLeftOut = leftOut.Count();
    const double all = AreaOf(list, this->Border.Edges);
    this->Result.AreaLeftOut = all > 0.0 ? std::min(1.0, area / all) : 0.0;
    const double points =
      static_cast<double>(this->Border.IsPart ? this->NumberOfPoints : this->Measured.NumberOfCorners());
    this->Result.PointsLeftOut = this->Result.NumberOfPointsLeftOut / points;
    if (!this->Result.LeavesOutMuch())
    {
      return true;
    }
    if (!this->FindCornerSpacings(outward, neighbors, SubProgress(progress, 0.6, 1.0)))
    {
      return false;
    }
    this->Result.KeepingTolerance = this->ToleranceToKeep(outward, leftOut, all);
    return true;
  }

  /** The tolerance at which all points belong to triangles within it, and half of the area does. */
  double ToleranceToKeep(const std::vector<Index>& outward, const IdSet& leftOut, double all) const
  {
    const TriangleList& list = this->Measured.List;
    std::vector<std::pair<double, Index>> ratios;
    for (const Index t : outward)
    {
      ratios.emplace_back(
        std::sqrt(this->Measured.Longest[t]) / SpacingOf(this->Spacings, list.CornersOf(t)), t);
    }
    std::sort(ratios.begin(), ratios.end());
    IdSet missing = leftOut;
    double needed = 0.0;
    double area = this->Result.AreaLeftOut * all;
    for (const auto& [ratio, t] : ratios)
    {
      if (missing.HasAny(list.CornersOf(t)) || area > 0.5 * all)
      {
        needed = ratio;
      }
      missing.RemoveAll(list.CornersOf(t));
      area -= list.SquareShare(t, 1.0);
    }
    // A little more, for what is rounded on the way to the user and back.
    return 1.01 * needed;
  }

  MeasuredTriangles Measured;
  const int Threads;
  const bool IsAutomatic;
  const double Tolerance; ///< at scale 1
  const Lattice Grid;
  BorderOfMesh Border;
  const Known* States = nullptr;   ///< one per triangle, if they are a part of a mesh
  std::int64_t NumberOfPoints = 0; ///< of that mesh
  IdSet Ends{ 0 };                 ///< vertices that have more triangles in it
  Buffer<double> Spacings;         ///< one per vertex, set where it was needed
  std::vector<float> Scales;       ///< one per vertex, or none
  ExtractedBoundary Result;
};

} // namespace

ExtractedBoundary FindOutline(MeasuredTriangles measured, const ExtractOptions& options)
{
  return *OutlineSearch(std::move(measured), options).Run(options.Monitor);
}

bool FindOutlinePart(
  const TriangleList& list, int margin, const ExtractOptions& options, OutlinePart& part)
{
  part = OutlinePart();
  part.Spacings.assign(list.Points.Count, std::numeric_limits<double>::quiet_NaN());
  MeasuredTriangles measured;
  if (list.Count == 0)
  {
    return true;
  }
  if (!MeasureBySweep(
        list, options.NumberOfThreads, SubProgress(options.Monitor, 0.0, 0.5), measured))
  {
    return false;
  }
  part = OutlineSearch(std::move(measured), options)
           .FindPart(margin, SubProgress(options.Monitor, 0.5, 1.0));
  part.Spacings.resize(list.Points.Count); // there are more of the measured ids than of points
  return true;
}

std::optional<ExtractedBoundary> FindSharedOutline(
  const TriangleList& list, OutlineMesh&& mesh, const ExtractOptions& options)
{
  MeasuredTriangles measured;
  if (list.Count == 0 ||
    !MeasureBySweep(
      list, options.NumberOfThreads, SubProgress(options.Monitor, 0.0, 0.3), measured))
  {
    return std::nullopt;
  }
  const Progress finding = SubProgress(options.Monitor, 0.3, 1.0);
  if (list.Count == mesh.NumberOfTriangles)
  {
    return OutlineSearch(std::move(measured), options).Run(finding);
  }
  std::vector<Index> numbers(list.Points.Count, None);
  for (std::size_t i = 0; i < measured.Ids.size(); ++i)
  {
    if (static_cast<Index>(i) < measured.List.Points.Count && measured.Ids[i] != None)
    {
      numbers[measured.Ids[i]] = static_cast<Index>(i);
    }
  }
  return OutlineSearch(std::move(measured), options, std::move(mesh), numbers).Run(finding);
}

ExtractedBoundary ExtractBoundary(const Mesh& mesh, const ExtractOptions& options)
{
  if (mesh.NumberOfTriangles() == 0)
  {
    ExtractedBoundary nothing;
    nothing.GapTolerance = options.GapTolerance;
    return nothing;
  }
  MeasuredTriangles measured = Measure(mesh, SubProgress(options.Monitor, 0.0, 0.4));
  ExtractOptions rest = options;
  const Progress finding = SubProgress(options.Monitor, 0.4, 1.0);
  rest.Monitor = finding;
  return FindOutline(std::move(measured), rest);
}

} // namespace elevation
