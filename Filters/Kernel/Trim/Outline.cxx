// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The rule: one local scale, one tolerance. A triangle is surface if its longest edge is at most
// the tolerance times the spacing of its corners (and their scale, Scales.h). The other constants
// guard against what that alone gets wrong; ExtractBoundary() in Outline.h has the rule to the
// letter.
//
// The trial that fixes them is BenchmarkOutline (Utilities/Benchmarks, Findings.md has its table):
// the area between the outline and the true one, in parts of the area within one spacing of it.
// Figures are as it is -> with another value.
//
//   DefaultTolerance 4.5: below, surface tears; above, channels and lakes close. With 4, random
//     points with channels 0.15 -> 0.51; with 6, scan lines 0.11 -> 0.41, and two of three lakes
//     with a radius of three spacings close.
//   SpacingNeighbor 6 (Spacings.h): with fewer the spacing wavers, with more it reaches too far.
//     With 4 and 12, where density falls 0.21 -> 0.27 and 0.29; one of five, and half of the lakes
//     close.
//   LargestSpacingInTriangle 2 (Spacings.h): two lone points, whose spacing is the distance to all
//     others. Without it, of groups of two to six lone points 0 -> 0.54 are surface; with 1, random
//     points 0.10 -> 0.23. Nothing else depends on it from 1.5 on.
//   LongestInBay 1.6: an outline that follows each point inwards. Without bays, random points 0.10
//     -> 0.18; with 3.2, survey lines 0.07 -> 0.12; without a limit, random points 0.16.
//   The least lake, the tolerance squared (Openings.h): speckle. With half of it random points 0.10
//     -> 0.13; with twice, half of the lakes with a radius of three close.
//   Half of a bay's border along surface (Openings.h): channels that close. If small bays always
//     close, of necks three spacings wide 0.02 -> 0.18 are cut; if surface must be along two
//     thirds, none closes.
//   LakeWithBays 4, in least lakes (Openings.cxx): a small lake half filled by the bays at its
//     shore, as in the picture of TestReconstructionChain. No figure changes by more than 0.01.
//   LeastHeight 0.1 (Slivers.cxx): whiskers. Without it, of a line of 40 points that leads away 2
//     -> 21 are at the outline; twice and half are as good.
//   CertainSurface 0.52: time. Without it extraction from random points takes 13 times as long, and
//     no figure changes by more than 0.01. With 0.6 gaps between lines and a swath may close; with
//     1.04, random points with channels 0.15 -> 0.18.
//   Twice the second shortest edge, for short spacings (MeasuredTriangles.h): gaps between lines.
//     Without it, what is kept of jittered lines steps by 0.14 of the hull, not by less than 0.03,
//     as they grow (TestScales); no figure of the trial changes.
//   SmallGroup 0.7: time. Without it, extraction from random points takes 1.7 times as long, and no
//     figure changes. With 1.4, seven of ten lakes with a radius of three close.
#include "Outline.h"

#include "Kernel/Base/Base.h"
#include "MissingNodes.h"
#include "Openings.h"
#include "PartialMesh.h"
#include "Scales.h"
#include "TraceOutline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elevation
{

namespace
{

constexpr double DefaultTolerance = 4.5;
constexpr double LongestInBay = 1.6;    // tolerances
constexpr double LeastAdvice = 1.25;    // the same, of a larger one to be tried
constexpr double CertainSurface = 0.52; // tolerances, by short spacings
constexpr double SmallGroup = 0.7;      // the same, the side of a square

/**
 * The area within the border, by the shoelace formula; around one of its vertices, as the products
 * of map coordinates would leave no digits to their difference.
 */
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

class OutlineSearch
{
public:
  OutlineSearch(MeasuredTriangles measured, const ExtractOptions& options)
    : Measured(std::move(measured))
    , Threads(ResolveNumberOfThreads(options.NumberOfThreads))
    , IsAutomatic(!(options.GapTolerance > 0.0))
    , Tolerance(this->IsAutomatic ? DefaultTolerance : options.GapTolerance)
    , Grid{ options.Grid, this->Measured.Scale }
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

  /**
   * The steps: certain triangles by short spacings, groups too small for a lake, scales, missing
   * nodes, spacings at the corners of what is still in doubt, the decision, slivers and openings,
   * the loss.
   * @return nothing only if the triangles are a part of a mesh, too small to find the outline
   */
  std::optional<ExtractedBoundary> Run(const Progress& progress)
  {
    Stages stages(progress, { 2, 5, 12, 13, 68 });
    const TriangleList& list = this->Measured.List;
    this->SortBorder(stages.Next());
    this->KeepCertainTriangles(stages.Next());
    std::vector<Index> doubtful = this->FindDoubtful(stages.Next());
    // Not before, as the groups of doubtful triangles need memory, too.
    const Neighbors neighbors(this->Measured, stages.Next());
    if (!this->Border.IsPart)
    {
      this->ForgetSpacings();
    }
    const Progress rest = stages.Next();
    Report(rest, 0.0);
    // How long the next steps take depends on how many are doubtful. Where these are few, no step
    // has so large a share that progress jumps.
    const double each =
      25.0 * std::clamp(20.0 * static_cast<double>(doubtful.size()) / list.Count, 0.6, 1.0);
    const double ofScales = this->IsAutomatic ? each : 0.0;
    Stages later(rest, { ofScales, 0, each, 3, 62.0 - ofScales - each, 3, 0 });
    const Progress scaling = later.Next();
    if (this->IsAutomatic && !this->FindAllScales(neighbors, doubtful, scaling))
    {
      return std::nullopt;
    }
    const std::vector<Index> outside =
      FindOutsideBridges(list, this->Grid, this->Border, later.Next());
    // These are in doubt even if they were certain: openings are measured in spacings, too.
    const auto middle = doubtful.insert(doubtful.end(), outside.begin(), outside.end());
    std::inplace_merge(doubtful.begin(), middle, doubtful.end());
    doubtful.erase(std::unique(doubtful.begin(), doubtful.end()), doubtful.end());
    if (!this->FindCornerSpacings(doubtful, neighbors, later.Next()))
    {
      return std::nullopt;
    }
    this->Decide(doubtful, later.Next());
    for (const Index t : outside)
    {
      this->Result.IsSurface[t] = Outside;
    }
    // With a grid, components that missing nodes separate stay, however small.
    const SurfaceOptions tracing{ [this](Index t) { return this->ToleranceOf(t); },
      !this->Grid.Steps.IsSet() };
    if (!TraceOutline(this->Measured, this->Border, this->CornersNear(doubtful), tracing,
          later.Next(), this->Result.IsSurface, this->Result.Vertices) ||
      !this->MeasureLoss(neighbors, later.Next()))
    {
      return std::nullopt;
    }
    if (this->Measured.Ids.size() > 0)
    {
      ToIds(this->Result.Vertices.Vertices, this->Measured.Ids.data(), later.Next());
    }
    Report(progress, 1.0);
    return std::move(this->Result);
  }

  /** FindOutlinePart(): the first steps of Run(), as far as this part alone can decide them. */
  OutlinePart FindPart(int margin, const Progress& progress)
  {
    Stages stages(progress, { 2, 13, 5, 5, 15, 5, 15, 5, 0, 35 });
    const TriangleList& list = this->Measured.List;
    const IdSet& border = this->Border.Vertices;
    this->SortBorder(stages.Next());
    const Neighbors neighbors(this->Measured, stages.Next());
    this->ForgetSpacings();
    this->KeepCertainTriangles(stages.Next());
    for (const Index t : TrianglesAt(list, border, stages.Next()))
    {
      this->Result.IsSurface[t] = Outside; // not all edges are known there
    }
    const std::vector<Index> doubtful = this->FindDoubtful(stages.Next());
    // A tolerance that the user gives has no scale, so lonely vertices do not matter.
    IdSet near = this->IsAutomatic
      ? LonelyVertices(neighbors, this->CornersNear(doubtful), list.Points.Count)
      : IdSet(list.Points.Count);
    // A spacing for which a vertex at the border had to be expanded stays unknown, too.
    const Progress listing = stages.Next();
    FindSpacings(list, neighbors, CornersOf(list, doubtful, listing), this->Threads, stages.Next(),
      this->Spacings.data(), &border);
    // Of groups that reach the border, other parts may have more.
    std::vector<char> isInside(list.Count, 0);
    // Groups away from the border are known whole, and all such groups count as small here: what is
    // asked is only which ones are.
    const auto nothing = [](Index) { return 0.0; };
    DropSmallGroups(list, border, doubtful, nothing, isInside, stages.Next());
    std::vector<TriangleState> states(list.Count, TriangleState::Surface);
    for (const Index t : doubtful)
    {
      states[t] = !isInside[t]        ? TriangleState::Nothing
        : this->IsSurfaceBySpacing(t) ? TriangleState::SurfaceBySpacing
                                      : TriangleState::Doubtful;
      // What is at the border is taken in any case.
      if (states[t] > TriangleState::SurfaceBySpacing && !border.HasAny(list.CornersOf(t)))
      {
        near.AddAll(list.CornersOf(t));
      }
    }
    for (const Index t : FindBridges(list, this->Grid, stages.Next()))
    {
      near.AddAll(list.CornersOf(t)); // the border of the mesh may be in another part
    }
    return this->PartNear(near, margin, states, stages.Next());
  }

private:
  /** Sorts the border of the mesh for searches, and finds its vertices. */
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
      return;
    }
    // A border of the triangles at hand that is none of the mesh: there are more triangles behind
    // it.
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

  void ForgetSpacings()
  {
    this->Spacings.Resize(this->Measured.List.Points.Count);
    std::fill(
      this->Spacings.begin(), this->Spacings.end(), std::numeric_limits<double>::quiet_NaN());
  }

  bool IsKnown(Index vertex) const { return !std::isnan(this->Spacings[vertex]); }

  /** Of a triangle of a part; false if a corner's spacing depends on other parts. */
  bool IsSurfaceBySpacing(Index t) const
  {
    const Index* const corners = this->Measured.List.CornersOf(t);
    const auto isKnown = [this](Index v) { return this->IsKnown(v); };
    return std::all_of(corners, corners + 3, isKnown) && !this->Border.Vertices.HasAny(corners) &&
      std::sqrt(this->Measured.SquaredLongest(t)) <= this->ToleranceOf(t);
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
  OutlinePart PartNear(const IdSet& vertices, int margin, const std::vector<TriangleState>& states,
    const Progress& progress)
  {
    const TriangleList& list = this->Measured.List;
    constexpr int around = 3;
    // The border is widened by @a margin edges, the vertices by three: the border goes ahead, and
    // the last three steps are for both.
    IdSet near = this->Border.Vertices, both(list.Points.Count);
    this->Widen(margin - around, Progress(), near);
    Report(progress, 0.4);
    near.Add(vertices, both);
    this->Widen(around, Progress(), near);
    OutlinePart part;
    part.Triangles = TrianglesAt(list, near, progress.Between(0.7, 0.9));
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

  /**
   * Finds the scales; those of a part of a mesh are all 1.
   * @return false if the triangles are a part of a mesh, and others may have another scale
   */
  bool FindAllScales(
    const Neighbors& neighbors, const std::vector<Index>& doubtful, const Progress& progress)
  {
    const IdSet near = this->CornersNear(doubtful);
    if (this->Border.IsPart)
    {
      return AreFew(neighbors, this->LonelyWithin(neighbors, near),
        this->Measured.List.Points.Count, this->NumberOfPoints);
    }
    this->Scales = FindScales(this->Measured, neighbors, this->Border, near, this->Threads,
      progress, this->Spacings.data());
    this->Result.GapTolerance *= this->TypicalScale();
    return true;
  }

  /** The lonely vertices of a mesh; not where the triangles taken of it end. */
  IdSet LonelyWithin(const Neighbors& neighbors, IdSet near) const
  {
    const TriangleList& list = this->Measured.List;
    // Surface that a spacing has decided was in doubt at first, so its corners are near in the
    // whole mesh, too.
    for (Index t = 0; t < list.Count; ++t)
    {
      if (this->States[t] == TriangleState::SurfaceBySpacing)
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
    Stages stages(progress, { 10, 90 });
    Report(progress, 0.0);
    const TriangleList& list = this->Measured.List;
    std::vector<Index> corners = CornersOf(list, triangles, stages.Next());
    const auto isKnown = [this](Index v) { return this->IsKnown(v); };
    corners.erase(std::remove_if(corners.begin(), corners.end(), isKnown), corners.end());
    FindSpacings(list, neighbors, corners, this->Threads, stages.Next(), this->Spacings.data(),
      this->Border.IsPart ? &this->Ends : nullptr);
    Report(progress, 1.0);
    return std::all_of(corners.begin(), corners.end(), isKnown);
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
  double BayTolerance(Index t) const
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
    std::vector<char>& keep = this->Result.IsSurface;
    keep.resize(list.Count);
    const double limit = CertainSurface * this->Tolerance;
    const auto isWithin = [&](Index, Index begin, Index end) {
      for (Index t = begin; t < end; ++t)
      {
        // Triangles come in fans, so the first corner is mostly that of the triangle before.
        const Index* ahead = list.CornersOf(std::min(t + 40, end - 1));
        Prefetch(&shortSpacings[ahead[1]]);
        Prefetch(&shortSpacings[ahead[2]]);
        list.PrefetchPoint(ahead[1]);
        list.PrefetchPoint(ahead[2]);
        const double length = limit * SpacingOf(shortSpacings, list.CornersOf(t));
        keep[t] = this->Measured.SquaredLongest(t) <= length * length ||
          (this->States && this->States[t] <= TriangleState::SurfaceBySpacing);
      }
    };
    constexpr Index atOnce = 1 << 13;
    ForEachRange(list.Count, this->Threads, progress, isWithin, atOnce);
  }

  /** The triangles that are not kept yet, without those of groups too small for a lake. */
  std::vector<Index> FindDoubtful(const Progress& progress)
  {
    Stages stages(progress, { 20, 80 });
    const TriangleList& list = this->Measured.List;
    // Both lists increase, and so does what is returned.
    std::vector<char>& keep = this->Result.IsSurface;
    std::vector<Index> doubtful, inGroups; // the groups of the others are known
    ForEachStretch(list.Count, stages.Next(), [&](Index begin, Index end) {
      for (Index t = begin; t < end; ++t)
      {
        if (!keep[t])
        {
          const bool isKnown = this->States && this->States[t] == TriangleState::Doubtful;
          (isKnown ? doubtful : inGroups).push_back(t);
        }
      }
    });
    const auto shareOf = [&](Index t) {
      const double spacing = SpacingOf(this->Measured.ShortSpacings, list.CornersOf(t));
      return list.SquareShare(t, SmallGroup * this->Tolerance * spacing);
    };
    const std::vector<Index> others =
      DropSmallGroups(list, this->Border.Vertices, inGroups, shareOf, keep, stages.Next());
    const auto middle = doubtful.insert(doubtful.end(), others.begin(), others.end());
    std::inplace_merge(doubtful.begin(), middle, doubtful.end());
    return doubtful;
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
        const double longest = std::sqrt(this->Measured.SquaredLongest(t));
        // What is too long for surface may still be surface as a part of a small bay.
        this->Result.IsSurface[t] = longest <= this->ToleranceOf(t) ? Surface
          : longest <= this->BayTolerance(t)                        ? Bay
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
    Stages stages(progress, { 60, 40 });
    const Progress counting = stages.Next();
    Report(counting, 0.0);
    const TriangleList& list = this->Measured.List;
    const std::vector<char>& keep = this->Result.IsSurface;
    const double points = static_cast<double>(
      this->Border.IsPart ? this->NumberOfPoints : this->Measured.NumberOfCorners());
    // A vertex has as many triangles as edges, but for border edges that end there. Nobody needs the
    // degrees after this, so they are counted down where they are.
    Buffer<std::uint32_t>& left = this->Measured.Degrees; // triangles that are surface
    for (const BorderEdge& edge : this->Measured.Border)
    {
      --left[edge.Destination];
    }
    std::vector<Index> outward;
    IdSet leftOut(list.Points.Count); // the corners that no triangle of the surface has
    double area = 0.0;
    for (auto t = keep.begin(); (t = std::find(t, keep.end(), char(Outside))) != keep.end(); ++t)
    {
      ReportStep(counting, outward.size(), keep.size());
      outward.push_back(static_cast<Index>(t - keep.begin()));
      area += list.SquareShare(outward.back(), 1.0);
      std::for_each(
        list.CornersOf(outward.back()), list.CornersOf(outward.back() + 1), [&](Index corner) {
          if (--left[corner] == 0)
          {
            leftOut.Add(corner);
          }
        });
    }
    this->Result.NumberOfPointsLeftOut = leftOut.Count();
    const double all = AreaOf(list, this->Border.Edges);
    this->Result.AreaLeftOut = all > 0.0 ? std::min(1.0, area / all) : 0.0;
    this->Result.PointsLeftOut = this->Result.NumberOfPointsLeftOut / points;
    if (!this->Result.LeavesOutMuch())
    {
      return true;
    }
    if (!this->FindCornerSpacings(outward, neighbors, stages.Next()))
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
      // Without the scale: a tolerance that the user gives has none.
      ratios.emplace_back(
        std::sqrt(this->Measured.SquaredLongest(t)) / SpacingOf(this->Spacings, list.CornersOf(t)),
        t);
    }
    std::sort(ratios.begin(), ratios.end());
    IdSet missing = leftOut;
    double needed = 0.0;
    double area = this->Result.AreaLeftOut * all;
    // From the smallest ratio on, as if the tolerance grew: the last triangle that is needed
    // decides.
    for (const auto& [ratio, t] : ratios)
    {
      if (missing.HasAny(list.CornersOf(t)) || area > 0.5 * all)
      {
        needed = ratio;
      }
      missing.RemoveAll(list.CornersOf(t));
      area -= list.SquareShare(t, 1.0);
    }
    // A little more, for what is rounded on the way to the user and back. What slivers and openings
    // take is not known here: a tolerance that is clearly larger takes less.
    return std::max(1.01 * needed, LeastAdvice * this->Result.GapTolerance);
  }

  MeasuredTriangles Measured;
  const int Threads;
  const bool IsAutomatic;
  const double Tolerance; ///< at scale 1
  const GridSteps Grid;
  MeshBorder Border;
  const TriangleState* States = nullptr; ///< one per triangle, if they are a part of a mesh
  std::int64_t NumberOfPoints = 0;       ///< of that mesh
  IdSet Ends{ 0 };                       ///< vertices that have more triangles in it
  Buffer<double> Spacings;               ///< one per vertex, NaN where it was not needed
  std::vector<float> Scales;             ///< one per vertex, or none
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
  Stages stages(options.Monitor, { 50, 50 });
  part = OutlinePart();
  part.Spacings.assign(list.Points.Count, std::numeric_limits<double>::quiet_NaN());
  MeasuredTriangles measured;
  if (list.Count == 0)
  {
    return true;
  }
  if (!MeasureBySweep(list, options.NumberOfThreads, stages.Next(), measured))
  {
    return false;
  }
  part = OutlineSearch(std::move(measured), options).FindPart(margin, stages.Next());
  part.Spacings.resize(list.Points.Count); // there are more of the measured ids than of points
  return true;
}

std::optional<ExtractedBoundary> FindSharedOutline(
  const TriangleList& list, OutlineMesh&& mesh, const ExtractOptions& options)
{
  Stages stages(options.Monitor, { 30, 70 });
  MeasuredTriangles measured;
  if (list.Count == 0 || !MeasureBySweep(list, options.NumberOfThreads, stages.Next(), measured))
  {
    return std::nullopt;
  }
  const Progress finding = stages.Next();
  // All triangles of the mesh have been taken: it is not a part.
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
  Stages stages(options.Monitor, { 40, 60 });
  if (mesh.NumberOfTriangles() == 0)
  {
    ExtractedBoundary nothing;
    nothing.GapTolerance = options.GapTolerance;
    return nothing;
  }
  MeasuredTriangles measured = Measure(mesh, stages.Next());
  ExtractOptions rest = options;
  const Progress finding = stages.Next();
  rest.Monitor = finding;
  return FindOutline(std::move(measured), rest);
}

} // namespace elevation
