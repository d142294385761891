// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Trim.h lists the passes. Here they are put together, for five callers:
//
//   Trim()             along lines            TrimAlongRings > TrimAlong > WriteSides
//   TrimNear()         the same in parts      TrimAlongRings > TrimAlong > WriteSides
//   SplitAlong()       along any lines                         TrimAlong > WriteSides
//   Trim()             without lines                       TrimExtracted > WriteSides
//   TrimNearOutline()  the same in parts               FindSharedOutline > WriteSides
//
// Only the triangles near the boundary become a mesh. WriteSides() copies the others in long runs.
//
// Three kinds of ids meet. The list has ids of the input's points. A mesh of near triangles numbers
// its own points from 0 on, and Mesh::IdOf() leads back. Rings have numbers of the lines' points
// until InsertRings() makes them vertices of the mesh.
#include "Trim.h"

#include "Outline.h"
#include "OutwardTriangles.h"

#include <algorithm>
#include <cstring>
#include <iomanip>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>

namespace elevation
{

namespace
{

/** The changes to a list of triangles. */
struct Changes
{
  std::vector<char> IsOutward; ///< one flag per triangle, including those added
  std::vector<Index> Changed;  ///< the triangles with new corners; increasing
  std::vector<Index> Corners;  ///< three each: of the changed triangles, then of those added
  std::vector<Index> Parents;  ///< one per triangle added: the one that it is part of
};

/** All triangles as a mesh with Twins that covers nothing twice. @throws Error */
Mesh ProvenMesh(const TriangleList& list, int threads, const Progress& progress)
{
  Stages stages(progress, { 40, 40, 20 });
  Mesh mesh = MeshOf(list, ResolveNumberOfThreads(threads), stages.Next());
  mesh.ConnectTwins(list.FirstCell, stages.Next());
  // Only its proof is wanted: it throws where a place is covered twice.
  FindHoles(mesh, list.FirstCell, stages.Next());
  return mesh;
}

/** Some of the triangles, proven by a sweep, as a mesh with Twins. */
Mesh NearMesh(const TriangleList& list, const std::vector<Index>& near, const Progress& progress)
{
  Stages stages(progress, { 50, 50 });
  Mesh mesh = SubMesh(list, near, stages.Next());
  mesh.ConnectTwins(list.FirstCell, stages.Next());
  return mesh;
}

/** The triangles of a list that a mesh was made of; nothing: all of them. Parts follow them. */
using NearTriangles = std::optional<std::vector<Index>>;

/** Records the triangles of a mesh of near triangles that are others than in the list. */
void PutBack(const TriangleList& list, const NearTriangles& near, const Mesh& mesh,
  const Progress& progress, Changes& changes)
{
  // A cut leaves one part of a triangle at its number and appends the others. So triangles beyond
  // the list's are new, and one of the list has changed if its corners have.
  const Index count = near ? static_cast<Index>(near->size()) : list.Count;
  ForEachNumber(mesh.NumberOfTriangles(), progress, [&](Index i) {
    const Index corners[3] = { mesh.IdOf(mesh.Origin(3 * i)), mesh.IdOf(mesh.Origin(3 * i + 1)),
      mesh.IdOf(mesh.Origin(3 * i + 2)) };
    const Index t = i >= count ? None : near ? (*near)[i] : i;
    if (t != None && std::equal(corners, corners + 3, list.CornersOf(t)))
    {
      return;
    }
    if (t != None)
    {
      changes.Changed.push_back(t);
    }
    // Those that changed come before those that are new, as Changes::Corners has them.
    changes.Corners.insert(changes.Corners.end(), corners, corners + 3);
  });
}

/** Records the flags of a mesh of near triangles, one per triangle of the mesh. */
void PutBackFlags(const NearTriangles& near, std::vector<char>&& isOutward, Changes& changes)
{
  if (!near)
  {
    changes.IsOutward = std::move(isOutward);
    return;
  }
  for (std::size_t i = 0; i < near->size(); ++i)
  {
    changes.IsOutward[(*near)[i]] = isOutward[i];
  }
  changes.IsOutward.insert(
    changes.IsOutward.end(), isOutward.begin() + near->size(), isOutward.end());
}

/** The same for inserted points and the parents of added triangles. */
void PutBackInserted(const NearTriangles& near, const Mesh& mesh, InsertedRings& rings,
  Changes& changes, Trimmed& result)
{
  // The mesh counts its own triangles only.
  for (const Index parent : rings.Parents)
  {
    changes.Parents.push_back(near ? (*near)[parent] : parent);
  }
  result.Inserted = std::move(rings.Inserted);
  for (InsertedVertex& vertex : result.Inserted)
  {
    for (Index& corner : vertex.Corners)
    {
      corner = mesh.IdOf(corner);
    }
  }
}

/** @throws Error when all is outward */
void CheckEnclosed(const TriangleList& list, const std::vector<char>& isOutward,
  const NamedPoints& points, const Rings& rings)
{
  if (std::find(isOutward.begin(), isOutward.end(), char(0)) == isOutward.end())
  {
    throw CodedError(NothingEnclosed(BoxOf(list), points, rings));
  }
}

/** The ids of the ends of marked half-edges; increasing. */
std::vector<Index> VerticesOf(
  const Mesh& mesh, const std::vector<char>& isMarked, const Progress& progress)
{
  std::vector<Index> ids;
  ForEachNumber(mesh.NumberOfHalfEdges(), progress, [&](Index h) {
    if (isMarked[h])
    {
      ids.push_back(mesh.IdOf(mesh.Origin(h)));
      ids.push_back(mesh.IdOf(mesh.Destination(h)));
    }
  });
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

/**
 * Marks the borders that rings have around them where they are outside of the mesh: of each stretch
 * of points outside, the edge on the right of the first. So a ring wholly in a hole marks the hole.
 * @param[in]     firstOutside  the first vertex of rings that no triangle uses
 * @param[in,out] onBoundary    increasing
 */
void MarkBordersAround(const Mesh& mesh, const Rings& rings, Index firstOutside,
  const TriangleList& list, const std::vector<BorderEdge>& border, const Progress& progress,
  std::vector<Index>& onBoundary)
{
  const auto endsOf = [&](std::size_t i) {
    return Ends{ { list.Points.At(border[i].Origin), list.Points.At(border[i].Destination) } };
  };
  // One point of each stretch is enough: the stretch does not cross the border.
  std::vector<Point2> outside;
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    bool wasOutside = false;
    std::for_each(rings.Begin(ring), rings.End(ring), [&](Index vertex) {
      const bool isOutside = vertex >= firstOutside;
      if (isOutside && !wasOutside)
      {
        outside.push_back(mesh.PointOf(vertex));
      }
      wasOutside = isOutside;
    });
  }
  if (outside.empty())
  {
    return;
  }
  // As in RingLocator, a ray along x needs all edges at its height: the grid has one column.
  const auto heightsOf = [&](std::size_t i) {
    const Ends ends = endsOf(i);
    return Ends{ { { 0.0, ends[0].Y }, { 0.0, ends[1].Y } } };
  };
  Stages stages(progress, { 50, 50 });
  const CellGrid byHeight(border.size(), heightsOf, stages.Next());
  WorkReporter work(stages.Next());
  for (std::size_t k = 0; k < outside.size(); ++k)
  {
    work.Step(k, outside.size());
    const Point2& p = outside[k];
    Index nearest = None;
    double nearestX = 0.0;
    byHeight.Visit(Point2{ 0.0, p.Y }, [&](Index i) {
      work.Tick();
      const Ends ends = endsOf(i);
      // The half-open rule counts one of two edges that meet at the height of p.
      if ((ends[0].Y <= p.Y) != (ends[1].Y <= p.Y))
      {
        const double share = (p.Y - ends[0].Y) / (ends[1].Y - ends[0].Y);
        const double x = ends[0].X + share * (ends[1].X - ends[0].X);
        // Of edges that meet there, the same in any order.
        const auto keyOf = [](double at, const Ends& e) {
          return std::make_tuple(at, e[0].X, e[0].Y, e[1].X, e[1].Y);
        };
        if (x > p.X && (nearest == None || keyOf(x, ends) < keyOf(nearestX, endsOf(nearest))))
        {
          nearest = i;
          nearestX = x;
        }
      }
    });
    if (nearest != None)
    {
      onBoundary.insert(onBoundary.end(), { border[nearest].Origin, border[nearest].Destination });
    }
  }
  std::sort(onBoundary.begin(), onBoundary.end());
  onBoundary.erase(std::unique(onBoundary.begin(), onBoundary.end()), onBoundary.end());
}

/** The border of a mesh of all triangles of a list. */
std::vector<BorderEdge> BorderOf(const Mesh& mesh, const Progress& progress)
{
  std::vector<BorderEdge> border;
  ForEachNumber(mesh.NumberOfHalfEdges(), progress, [&](Index h) {
    if (mesh.IsBorder(h))
    {
      border.push_back({ mesh.IdOf(mesh.Origin(h)), mesh.IdOf(mesh.Destination(h)) });
    }
  });
  return border;
}

/** Lines as rings that go there and back; without lines of no length. */
Rings ThereAndBack(const BoundaryLines& lines)
{
  Rings rings;
  for (Index line = 0; line < lines.Lines.Count(); ++line)
  {
    std::vector<Index> vertices(lines.Lines.Begin(line), lines.Lines.End(line));
    if (lines.IsPolygon[line] && !vertices.empty())
    {
      vertices.push_back(vertices.front());
    }
    const auto isSamePlace = [&](Index a, Index b) { return lines.Points[a] == lines.Points[b]; };
    // A line back along itself bounds nothing, but InsertRings() and FindOutward() can treat it as
    // any ring. Consecutive points at one place would be an edge without length.
    vertices.erase(std::unique(vertices.begin(), vertices.end(), isSamePlace), vertices.end());
    if (vertices.size() > 1)
    {
      rings.Vertices.insert(rings.Vertices.end(), vertices.begin(), vertices.end());
      // The way back, without the two ends, which are in the ring once.
      rings.Vertices.insert(rings.Vertices.end(), vertices.rbegin() + 1, vertices.rend() - 1);
      rings.Offsets.push_back(static_cast<Index>(rings.Vertices.size()));
    }
  }
  return rings;
}

/**
 * Finds the triangles near the boundary, the flags of the others, and the border of the mesh.
 * @param[in] known  the border of the mesh, where these are all triangles near the boundary
 * @return nothing: all of them, whose border is that of the mesh
 */
NearTriangles FindNear(const TriangleList& list, const NamedPoints& points, const Rings& boundary,
  const std::vector<BorderEdge>* known, const TrimOptions& options, const Progress& progress,
  std::vector<BorderEdge>& border, Changes& changes)
{
  // Where the sweep gives no answer, near stays without a value, and IsOutward is set later.
  NearTriangles near;
  if (known)
  {
    near = AllTriangles(list);
    border = *known;
  }
  else if (options.Test == OutwardTest::Exact)
  {
    std::optional<SweptAlongRings> swept =
      FindNearTriangles(list, points.Places, boundary, options.NumberOfThreads, progress);
    if (swept)
    {
      near = std::move(swept->Near);
      border = std::move(swept->Border);
      changes.IsOutward = std::move(swept->IsOutward);
    }
  }
  changes.IsOutward.resize(list.Count);
  return near;
}

/**
 * @param[in] lines  a boundary, or with Following::Lines lines along which triangles are split
 * @param[in] known  the border of the mesh, where these are all triangles near the boundary
 */
void TrimAlong(const TriangleList& list, const BoundaryLines& lines,
  const std::vector<BorderEdge>* known, const TrimOptions& options, Following follow,
  const Progress& progress, Changes& changes, Trimmed& result)
{
  // A proven mesh of all triangles is made with the published test, or after a sweep that failed.
  const bool isSwept = options.Test == OutwardTest::Exact;
  Stages stages(
    progress, { isSwept ? 30.0 : 0.0, isSwept ? 20.0 : 50.0, 0, 25, 20, 0.5, 0.5, 1, 3 });
  const int threads = options.NumberOfThreads;
  const bool areLines = follow == Following::Lines;
  result.Boundary = areLines ? ThereAndBack(lines) : JoinLines(lines, &result.Warning);
  std::vector<BorderEdge> border;
  const NearTriangles near =
    FindNear(list, lines.Points, result.Boundary, known, options, stages.Next(), border, changes);
  const Progress making = stages.Next(), tracing = stages.Next();
  Mesh mesh = near ? NearMesh(list, *near, making) : ProvenMesh(list, threads, making);
  mesh.NumberOf = options.NumberOf;
  border = near ? std::move(border) : BorderOf(mesh, tracing);
  const Index before = mesh.NumberOfPoints();
  InsertedRings rings = InsertRings(
    mesh, lines.Points, result.Boundary, options.RecoverBoundary, stages.Next(), follow);
  OutwardTriangles outward =
    FindOutward(mesh, rings.Vertices, options.RecoverBoundary, stages.Next());
  // An edge that follows the surface is counted once, also where a part of it had to be recovered.
  result.NumberOfRecoveredEdges =
    follow != Following::None ? rings.NumberOfFollowedEdges : outward.NumberOfRecoveredEdges;
  // The new vertices come first, then the rings' points outside the mesh, which no triangle has.
  result.Places.assign(
    mesh.Points.begin() + before, mesh.Points.begin() + before + rings.Inserted.size());
  // Ways there and back cancel out, so they enclose nothing and all would be outward. The published
  // test then finds nothing either.
  if (areLines)
  {
    std::fill(outward.IsOutward.begin(), outward.IsOutward.end(), char(0));
    std::fill(changes.IsOutward.begin(), changes.IsOutward.end(), char(0));
  }
  result.OnBoundary = VerticesOf(mesh, outward.IsOnBoundary, stages.Next());
  MarkBordersAround(mesh, rings.Vertices, before + static_cast<Index>(rings.Inserted.size()), list,
    border, stages.Next(), result.OnBoundary);
  const Progress testing = stages.Next();
  if (options.Test == OutwardTest::InwardNormal)
  {
    // Before the published test, which keeps triangles that no boundary touches, and so hides this.
    CheckEnclosed(list, outward.IsOutward, lines.Points, result.Boundary);
    ApplyInwardNormalTest(mesh, outward.IsOnBoundary, outward.IsOutward, testing);
  }
  PutBack(list, near, mesh, stages.Next(), changes);
  PutBackFlags(near, std::move(outward.IsOutward), changes);
  PutBackInserted(near, mesh, rings, changes, result);
  if (!known)
  {
    CheckEnclosed(list, changes.IsOutward, lines.Points, result.Boundary);
  }
  // From here on the rings leave the kernel: ids of the input instead of numbers of lines.Points.
  for (Index& vertex : result.Boundary.Vertices)
  {
    vertex = lines.Points.IdOf(vertex);
  }
}

/** What an extracted boundary leaves out. @param[in] all  if it leaves out all */
Message LossOf(const ExtractedBoundary& found, bool all)
{
  const auto percent = [](double share) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << 100.0 * share;
    return text.str();
  };
  const std::string tolerance = ToText(found.GapTolerance, 4);
  const std::string better = ToText(found.KeepingTolerance, 4);
  if (all)
  {
    return MakeMessage<sentences::BoundaryLeavesOutAll>(tolerance, better);
  }
  const Index points = found.NumberOfPointsLeftOut;
  return MakeMessage<sentences::BoundaryLeavesOut>(points, points == 1 ? "point" : "points",
    percent(found.PointsLeftOut), percent(found.AreaLeftOut), tolerance, better);
}

ExtractOptions ExtractionOf(const TrimOptions& options, const Progress& progress)
{
  ExtractOptions extraction;
  extraction.GapTolerance = options.GapTolerance;
  extraction.Grid = options.Grid;
  extraction.NumberOfThreads = options.NumberOfThreads;
  extraction.Monitor = progress;
  return extraction;
}

std::vector<char> OutwardOf(std::vector<char>&& isSurface)
{
  std::vector<char> isOutward = std::move(isSurface);
  for (char& flag : isOutward)
  {
    flag = !flag;
  }
  return isOutward;
}

/** Moves what is reported of an outline, which has a ring: all but the flags of triangles. */
void TakeOutline(ExtractedBoundary&& found, Trimmed& result)
{
  result.Boundary = std::move(found.Vertices);
  result.GapTolerance = found.GapTolerance;
  result.NumberOfPointsLeftOut = found.NumberOfPointsLeftOut;
  result.Warning = found.LeavesOutMuch() ? LossOf(found, false) : Message();
}

/** Trims along the extracted outline. */
void TrimExtracted(const TriangleList& list, const TrimOptions& options, const Progress& progress,
  Changes& changes, Trimmed& result)
{
  const bool isExact = options.Test == OutwardTest::Exact;
  Stages stages(progress, { isExact ? 60.0 : 0.0, isExact ? 40.0 : 100.0 });
  const Progress measuring = stages.Next(), rest = stages.Next();
  // After a sweep that failed; or from the start, and then the published test follows.
  Stages withMesh = isExact ? Stages(rest, { 25, 50, 25 }) : Stages(rest, { 45, 45, 5, 2, 3 });
  MeasuredTriangles measured;
  ExtractedBoundary found;
  Mesh mesh; // of all triangles, if the sweep fails
  // The sweep proves and measures the triangles in one pass without making half-edges.
  if (isExact && MeasureBySweep(list, options.NumberOfThreads, measuring, measured))
  {
    found = FindOutline(std::move(measured), ExtractionOf(options, rest));
  }
  else
  {
    // The sweep may have filled a part of it.
    measured = MeasuredTriangles();
    mesh = ProvenMesh(list, options.NumberOfThreads, withMesh.Next());
    found = ExtractBoundary(mesh, ExtractionOf(options, withMesh.Next()));
  }
  if (found.Vertices.Count() == 0)
  {
    throw CodedError(LossOf(found, true));
  }
  TakeOutline(std::move(found), result);
  std::vector<char> isOutward = OutwardOf(std::move(found.IsSurface));
  if (!isExact)
  {
    // The outline's own test decided by area; the published one decides by the rings, so a warning
    // about what the outline leaves out would not be of this result.
    result.Warning = Message();
    OutwardTriangles outward =
      FindOutward(mesh, result.Boundary, options.RecoverBoundary, withMesh.Next());
    isOutward = std::move(outward.IsOutward);
    ApplyInwardNormalTest(mesh, outward.IsOnBoundary, isOutward, withMesh.Next());
    result.NumberOfPointsLeftOut = 0;
  }
  if (mesh.NumberOfTriangles() > 0)
  {
    // Triangles may have been reoriented.
    PutBack(list, std::nullopt, mesh, withMesh.Next(), changes);
  }
  changes.IsOutward = std::move(isOutward);
}

/**
 * Copies the corners of triangles [begin, end).
 * @param[in,out] changed  in: the first change from begin on; out: from end on
 */
void CopyCorners(const TriangleList& list, const Changes& changes, Index begin, Index end,
  std::vector<Index>::const_iterator& changed, Index* corners)
{
  const auto copyNew = [&](std::size_t from, Index to) {
    std::copy_n(changes.Corners.begin() + 3 * from, 3, corners + 3 * (to - begin));
  };
  // Triangles of the list are contiguous on both sides: one copy, then the few that changed.
  const Index last = std::min(end, list.Count);
  if (begin < last)
  {
    std::copy(list.CornersOf(begin), list.CornersOf(last), corners);
  }
  // Overwrites what was just copied; @a changed moves on, so a search is made once a range only.
  for (; changed != changes.Changed.end() && *changed < end; ++changed)
  {
    copyNew(changed - changes.Changed.begin(), *changed);
  }
  for (Index t = std::max(begin, list.Count); t < end; ++t)
  {
    copyNew(changes.Changed.size() + t - list.Count, t);
  }
}

/**
 * Writes the triangles of both sides: those of the list as their flags say, with the changes, then
 * those that were added.
 */
void WriteSides(const TriangleList& list, const Changes& changes, const TrimOptions& options,
  const Progress& progress, Trimmed& result)
{
  Stages stages(progress, { 10, 90 });
  const int threads = ResolveNumberOfThreads(options.NumberOfThreads);
  const std::vector<char>& flags = changes.IsOutward;
  const Index all = static_cast<Index>(flags.size());
  // Count, sum, write: with these sums each range of triangles has its own slice of both sides, so
  // the order is that of the input, whatever thread writes it.
  // How many outward triangles come before each range.
  constexpr Index atOnce = 1 << 13;
  const Index ranges = NumberOfRanges(all, atOnce);
  std::vector<Index> outwardBefore(ranges + 1, 0);
  const auto count = [&](Index range, Index begin, Index end) {
    outwardBefore[range + 1] =
      static_cast<Index>(std::count(flags.begin() + begin, flags.begin() + end, char(1)));
  };
  ForEachRange(all, threads, stages.Next(), count, atOnce);
  std::partial_sum(outwardBefore.begin(), outwardBefore.end(), outwardBefore.begin());
  const Index sizes[2] = { all - outwardBefore[ranges], outwardBefore[ranges] };
  result.NumberOfOutwardTriangles = sizes[1];

  TrimmedSide* const sides[2] = { &result.Kept, &result.Outward };
  for (const int side : { 0, 1 })
  {
    // Where nothing changes and one side gets all, the caller has that list already.
    sides[side]->IsWholeList = changes.Corners.empty() && sizes[1 - side] == 0;
    const std::size_t size = sizes[side];
    sides[side]->Corners.Resize(sides[side]->IsWholeList ? 0 : 3 * size);
    sides[side]->Parents.Resize(options.ReturnParents ? size : 0);
  }
  const auto write = [&](Index range, Index t, Index rangeEnd) {
    std::size_t next[2] = { static_cast<std::size_t>(t - outwardBefore[range]),
      static_cast<std::size_t>(outwardBefore[range]) };
    auto changed = std::lower_bound(changes.Changed.begin(), changes.Changed.end(), t);
    while (t < rangeEnd)
    {
      // A run of triangles on the same side.
      // Long where the triangles are ordered by place.
      const char flag = flags[t];
      const char* const first = flags.data() + t;
      const void* other = std::memchr(first, 1 - flag, static_cast<std::size_t>(rangeEnd - t));
      const Index end =
        other ? t + static_cast<Index>(static_cast<const char*>(other) - first) : rangeEnd;
      TrimmedSide& side = *sides[static_cast<int>(flag)];
      std::size_t& place = next[static_cast<int>(flag)];
      if (!side.IsWholeList)
      {
        CopyCorners(list, changes, t, end, changed, side.Corners.data() + 3 * place);
      }
      for (Index i = t; i < end && options.ReturnParents; ++i)
      {
        side.Parents[place + (i - t)] = i < list.Count ? i : changes.Parents[i - list.Count];
      }
      place += end - t;
      t = end;
    }
  };
  ForEachRange(all, threads, stages.Next(), write, atOnce);
}

/** @param[in] find  finds the changes, and the rest of the result */
template <typename Find>
Trimmed TrimBy(const TriangleList& triangles, const TrimOptions& options, const Find& find)
{
  Stages stages(options.Monitor, { 95, 5 });
  Trimmed result;
  Changes changes;
  find(stages.Next(), changes, result);
  WriteSides(triangles, changes, options, stages.Next(), result);
  Report(options.Monitor, 1.0);
  return result;
}

/** @param[in] border  of the mesh that the triangles are a part of; nullptr: they are the mesh */
Trimmed TrimAlongRings(const TriangleList& triangles, const BoundaryLines& boundary,
  const std::vector<BorderEdge>* border, const TrimOptions& options)
{
  // Otherwise FindOutward() recovers edges that are missing, or refuses them.
  const bool isToFollow = options.Test == OutwardTest::Exact && options.RecoverBoundary &&
    options.Edges == BoundaryEdges::FollowSurface;
  return TrimBy(
    triangles, options, [&](const Progress& finding, Changes& changes, Trimmed& result) {
      TrimAlong(triangles, boundary, border, options,
        isToFollow ? Following::Rings : Following::None, finding, changes, result);
    });
}

} // namespace

Trimmed Trim(
  const TriangleList& triangles, const BoundaryLines* boundary, const TrimOptions& options)
{
  if (triangles.Count == 0)
  {
    return Trimmed();
  }
  if (boundary)
  {
    return TrimAlongRings(triangles, *boundary, nullptr, options);
  }
  return TrimBy(
    triangles, options, [&](const Progress& finding, Changes& changes, Trimmed& result) {
      TrimExtracted(triangles, options, finding, changes, result);
    });
}

Box BoxOf(const TriangleList& triangles)
{
  Box box;
  std::for_each(triangles.CornersOf(0), triangles.CornersOf(triangles.Count),
    [&](Index corner) { box.Add(triangles.Points.At(corner)); });
  return box;
}

Message NothingEnclosed(const Box& ofMesh, const NamedPoints& boundary, const Rings& rings)
{
  Box box;
  for (const Index vertex : rings.Vertices)
  {
    box.Add(boundary[vertex]);
  }
  const std::string first = NameOf(boundary[rings.Vertices.front()]);
  // Three causes, three sentences: elsewhere, between nested rings, or in a ring within a hole.
  return MakeMessage<sentences::BoundaryEnclosesNothing>(!box.Intersects(ofMesh)
      ? MakeMessage<sentences::BoundaryElsewhere>(NameOf(box), NameOf(ofMesh))
      : rings.Count() > 1 ? MakeMessage<sentences::NothingBetweenRings>(first)
                          : MakeMessage<sentences::NothingInRing>(first));
}

Trimmed TrimNear(const TriangleList& triangles, const BoundaryLines& boundary,
  const std::vector<BorderEdge>& border, const TrimOptions& options)
{
  return TrimAlongRings(triangles, boundary, &border, options);
}

Trimmed SplitAlong(
  const TriangleList& triangles, const BoundaryLines& lines, const TrimOptions& options)
{
  return TrimBy(
    triangles, options, [&](const Progress& finding, Changes& changes, Trimmed& result) {
      // Lines without length meet no triangle, and bound nothing to search along.
      if (triangles.Count > 0 && !ThereAndBack(lines).Vertices.empty())
      {
        TrimAlong(triangles, lines, nullptr, options, Following::Lines, finding, changes, result);
      }
    });
}

std::optional<Trimmed> TrimNearOutline(
  const TriangleList& triangles, OutlineMesh&& mesh, const TrimOptions& options)
{
  std::optional<ExtractedBoundary> found = FindSharedOutline(
    triangles, std::move(mesh), ExtractionOf(options, options.Monitor.Between(0.0, 0.95)));
  if (!found || found->Vertices.Count() == 0)
  {
    return std::nullopt;
  }
  return TrimBy(triangles, options, [&](const Progress&, Changes& changes, Trimmed& result) {
    TakeOutline(std::move(*found), result);
    changes.IsOutward = OutwardOf(std::move(found->IsSurface));
  });
}

} // namespace elevation
