// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LongTriangles.h"

#include "VertexStars.h"
#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <queue>
#include <utility>

namespace elevation
{

namespace
{
/**
 * Of a gap, per distance from the point that has it: ten times SpacingGrowth (Fill/PatchPlan.h).
 */
constexpr double GapDecay = 2.0;

/**
 * One run; the members carry data between its passes, which are in the order of Run():
 * 1. FindRegions() numbers the groups of long triangles.
 * 2. TraceBorders() walks around each, inside.
 * 3. FindRims() lists the walks of each region, the rim first.
 * 4. CollectInnerEdges() keeps points and short edges inside, as those of survey lines.
 * 5. MeasureGaps() estimates for each point how far the next line is.
 */
class RegionFinder
{
public:
  RegionFinder(const Mesh& mesh, double longest, Holes& holes)
    : Surface(mesh)
    , Longest(longest)
    , Limit(longest)
    , Result(holes)
  {
    holes.LongestEdge = longest;
  }

  /** @return whether there are regions */
  bool Run(const Progress& progress)
  {
    Stages stages(progress, { 50, 20, 20, 10 });
    if (!this->FindRegions(stages.Next()))
    {
      return false;
    }
    this->TraceBorders(stages.Next());
    this->FindRims();
    this->CollectInnerEdges(stages.Next());
    this->MeasureGaps(stages.Next());
    return true;
  }

  /**
   * Of a mesh of borders (MakeBorderMesh), with the regions on the right of their edges. In parts,
   * a region may lie in several of them; only its border has been brought together.
   */
  void RunOnBorder(const std::vector<Index>& regionOf, const Progress& progress)
  {
    std::vector<Index>& vertices = this->Result.Walks.Vertices;
    this->FirstRegion = this->Result.Count();
    this->FirstWalk = this->Result.Walks.Count();
    const Rings walks = TraceBorder(this->Surface, progress);
    for (Index walk = 0; walk < walks.Count(); ++walk)
    {
      const std::size_t first = vertices.size();
      std::transform(walks.Begin(walk), walks.End(walk), std::back_inserter(vertices),
        [this](Index h) { return this->Surface.Origin(h); });
      // All edges of a walk are of one region, so its first edge says which.
      this->EndWalk(first, regionOf[Mesh::Triangle(*walks.Begin(walk))]);
    }
    this->NumberOfRegions = 1 + *std::max_element(regionOf.begin(), regionOf.end());
    this->FindRims();
    this->Result.InnerOffsets.resize(static_cast<std::size_t>(this->NumberOfRegions) + 1, 0);
  }

  /** One flag a triangle: 1 if it is not long. */
  std::vector<char> Others() const
  {
    std::vector<char> keep(this->Result.RegionOf.size());
    std::transform(this->Result.RegionOf.begin(), this->Result.RegionOf.end(), keep.begin(),
      [](Index region) { return region == None; });
    return keep;
  }

private:
  /** Numbers the regions from the first triangle on, behind the other holes. @return if any */
  bool FindRegions(const Progress& progress)
  {
    this->FirstRegion = this->Result.Count();
    this->Result.RegionOf = NumberRegions(this->Surface, this->Longest, progress);
    for (Index& region : this->Result.RegionOf)
    {
      this->NumberOfRegions = std::max(this->NumberOfRegions, region == None ? 0 : region + 1);
      region = region == None ? None : this->FirstRegion + region;
    }
    return this->NumberOfRegions > 0;
  }

  /**
   * The region of a half-edge's triangle, as a hole; None if the triangle is not long, or none is
   * there.
   */
  Index RegionAt(Index h) const
  {
    return h == Mesh::Border ? None : this->Result.RegionOf[Mesh::Triangle(h)];
  }
  /** Whether a half-edge has its region on the left, and something else on the right. */
  bool IsBorder(Index h) const
  {
    return this->RegionAt(h) != None && this->RegionAt(this->Surface.Twin(h)) == None;
  }
  /**
   * The border that follows a border around the same region: turning around the destination through
   * triangles of the region, from edge to edge. Where the region touches itself at a vertex, this
   * stays in the fan that it came from.
   */
  Index After(Index h) const
  {
    h = Mesh::Next(h);
    while (!this->IsBorder(h))
    {
      h = Mesh::Next(this->Surface.Twin(h));
    }
    return h;
  }

  /** Appends the walks around each region, reversed, so that the region is on their right. */
  void TraceBorders(const Progress& progress)
  {
    const Mesh& mesh = this->Surface;
    std::vector<Index>& vertices = this->Result.Walks.Vertices;
    std::vector<char> seen(mesh.NumberOfHalfEdges(), 0);
    this->OnBorder.assign(mesh.NumberOfPoints(), 0);
    this->FirstWalk = this->Result.Walks.Count();
    for (const Index start : Counted(mesh.NumberOfHalfEdges()))
    {
      ReportStep(progress, start, mesh.NumberOfHalfEdges());
      if (seen[start] || !this->IsBorder(start))
      {
        continue;
      }
      const std::size_t first = vertices.size();
      for (Index h = start; !seen[h]; h = this->After(h))
      {
        seen[h] = 1;
        vertices.push_back(mesh.Origin(h));
        this->OnBorder[mesh.Origin(h)] = 1;
      }
      // As walks around holes run: the empty place, here the region, on their right.
      std::reverse(vertices.begin() + static_cast<std::ptrdiff_t>(first), vertices.end());
      this->EndWalk(first, this->RegionAt(start) - this->FirstRegion);
    }
  }

  /** Of the last walk, which begins at a place in Vertices. @param[in] region  from FirstRegion */
  void EndWalk(std::size_t first, Index region)
  {
    std::vector<Index>& vertices = this->Result.Walks.Vertices;
    StartAtLowest(this->Surface, vertices.begin() + static_cast<std::ptrdiff_t>(first),
      vertices.end(), [](Index vertex) { return vertex; });
    this->Result.Walks.Offsets.push_back(static_cast<Index>(vertices.size()));
    this->WalkRegions.push_back(region);
  }

  /**
   * Lists the walks of each region from the lowest on. The first is the rim: only the rim passes
   * the region's lowest vertex, as below this vertex is the outside, which only the rim meets.
   */
  void FindRims()
  {
    Holes& holes = this->Result;
    std::vector<Index> walks(this->WalkRegions.size());
    std::iota(walks.begin(), walks.end(), 0);
    std::sort(walks.begin(), walks.end(), [&](Index a, Index b) {
      const Index* u = holes.Walks.Begin(this->FirstWalk + a);
      const Index* v = holes.Walks.Begin(this->FirstWalk + b);
      return this->WalkRegions[a] != this->WalkRegions[b]
        ? this->WalkRegions[a] < this->WalkRegions[b]
        : IsLowerEdge(this->Surface, u[0], u[1], v[0], v[1]);
    });
    // Sorted by region, so that one pass over the walks serves all regions.
    std::size_t i = 0;
    for (Index region = 0; region < this->NumberOfRegions; ++region)
    {
      for (; i < walks.size() && this->WalkRegions[walks[i]] == region; ++i)
      {
        holes.Loops.push_back(this->FirstWalk + walks[i]);
      }
      holes.Offsets.push_back(static_cast<Index>(holes.Loops.size()));
      holes.Touched.push_back(0);
    }
  }

  // From the lower vertex to the higher one; the region counts from 0.
  struct InnerEdge
  {
    Index Region;
    Index Low;
    Index High;
  };

  // Half-edges from the lower to the higher end: one of each edge. An edge with an end inside has
  // the same region on both sides.
  void CollectInnerEdges(const Progress& progress)
  {
    Stages stages(progress, { 50, 50 });
    const Mesh& mesh = this->Surface;
    const IsLowerPoint isLower{ mesh };
    std::vector<InnerEdge> edges;
    std::vector<char> isJoined(mesh.NumberOfPoints(), 0);
    const Progress collecting = stages.Next();
    for (const Index h : Counted(mesh.NumberOfHalfEdges()))
    {
      ReportStep(collecting, h, mesh.NumberOfHalfEdges());
      const Index a = mesh.Origin(h);
      const Index b = mesh.Destination(h);
      if (this->RegionAt(h) != None && (!this->OnBorder[a] || !this->OnBorder[b]) &&
        isLower(a, b) && this->Limit.IsShort(mesh.PointOf(a), mesh.PointOf(b)))
      {
        edges.push_back({ this->RegionAt(h) - this->FirstRegion, a, b });
        isJoined[a] = isJoined[b] = 1;
      }
    }
    // Points inside without such an edge: entered as an edge to themselves, so that they are kept.
    for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
    {
      const Index a = mesh.Origin(h);
      if (this->RegionAt(h) != None && !this->OnBorder[a] && !isJoined[a])
      {
        edges.push_back({ this->RegionAt(h) - this->FirstRegion, a, a });
        isJoined[a] = 1;
      }
    }
    Sort(
      edges.begin(), edges.end(),
      [&](const InnerEdge& s, const InnerEdge& t) {
        return s.Region != t.Region ? s.Region < t.Region
                                    : IsLowerEdge(this->Surface, s.Low, s.High, t.Low, t.High);
      },
      stages.Next());
    std::size_t i = 0;
    for (Index region = 0; region < this->NumberOfRegions; ++region)
    {
      for (; i < edges.size() && edges[i].Region == region; ++i)
      {
        this->Result.InnerEnds.push_back(edges[i].Low);
        this->Result.InnerEnds.push_back(edges[i].High);
      }
      this->Result.InnerOffsets.push_back(static_cast<Index>(i));
    }
  }

  /**
   * Only if there are lines: other regions do not need gaps, and the stars cost memory. The largest
   * of values does not depend on the order of triangles.
   */
  void MeasureGaps(const Progress& progress)
  {
    bool areLines = false;
    for (Index region = 0; region < this->NumberOfRegions; ++region)
    {
      areLines = areLines || this->Result.IsOfLines(this->FirstRegion + region);
    }
    if (!areLines)
    {
      return;
    }
    this->Result.Gaps.assign(this->Surface.NumberOfPoints(), 0.0);
    for (const Index t : Counted(this->Surface.NumberOfTriangles()))
    {
      if (this->Result.RegionOf[t] != None)
      {
        const double height = LargestHeight(this->Surface, t);
        for (Index h = 3 * t; h < 3 * t + 3; ++h)
        {
          double& gap = this->Result.Gaps[this->Surface.Origin(h)];
          gap = std::max(gap, height);
        }
      }
    }
    this->SpreadGaps(progress);
  }

  /**
   * Of a line that wavers, many points have flat triangles only: they take the gap from others,
   * less GapDecay times the way. From the largest gap on, as in Dijkstra's search for shortest
   * ways: each point is final when it is taken from the queue.
   */
  void SpreadGaps(const Progress& progress)
  {
    const Mesh& mesh = this->Surface;
    std::vector<double>& gaps = this->Result.Gaps;
    const VertexStars stars(mesh, progress);
    std::priority_queue<std::pair<double, Index>> queue;
    for (Index v = 0; v < mesh.NumberOfPoints(); ++v)
    {
      if (gaps[v] > 0.0)
      {
        queue.emplace(gaps[v], v);
      }
    }
    StepCount steps;
    while (!queue.empty())
    {
      steps.Add();
      ReportStep(progress, steps.Count(), 8 * gaps.size());
      const auto [gap, v] = queue.top();
      queue.pop();
      // To the neighbours, what is left of the gap after the way there.
      const auto spread = [&, from = gap, p = mesh.PointOf(v)](Index w) {
        const double left = from - GapDecay * Distance(p, mesh.PointOf(w));
        if (left > gaps[w])
        {
          gaps[w] = left;
          queue.emplace(left, w);
        }
      };
      // Otherwise a larger one has arrived since this entry was made.
      if (gap == gaps[v])
      {
        stars.Visit(mesh, v, [&](Index h) {
          // The apex, too: it is the last neighbour of a fan that ends at the border.
          spread(mesh.Destination(h));
          spread(mesh.Apex(h));
          return true;
        });
      }
    }
  }

  const Mesh& Surface;
  const double Longest;
  const EdgeLimit Limit;
  Holes& Result;
  Index FirstRegion = 0; ///< its number as a hole
  Index NumberOfRegions = 0;
  Index FirstWalk = 0;
  std::vector<Index> WalkRegions;  ///< one a walk from FirstWalk on, counted from FirstRegion
  std::vector<char> OnBorder;      ///< one a vertex: 1 on the border of a region
};
} // namespace

std::vector<Index> NumberRegions(const Mesh& mesh, double longest, const Progress& progress)
{
  Stages stages(progress, { 50, 50 });
  const EdgeLimit limit(longest);
  const Index count = mesh.NumberOfTriangles();
  std::vector<char> isLong(count);
  ForEachNumber(count, stages.Next(), [&](Index t) {
    isLong[t] = !limit.Admits([&](Index v) -> const Point2& { return mesh.PointOf(v); },
      mesh.Origin(3 * t), mesh.Origin(3 * t + 1), mesh.Origin(3 * t + 2));
  });
  std::vector<Index> regionOf;
  if (std::find(isLong.begin(), isLong.end(), 1) == isLong.end())
  {
    return regionOf;
  }
  const Components components = FindComponents(mesh, stages.Next(), [&](Index h) {
    return isLong[Mesh::Triangle(h)] && isLong[Mesh::Triangle(mesh.Twin(h))] ? 0 : -1;
  });
  std::vector<Index> numbers(components.Count(), None);
  Index number = 0;
  for (Index component = 0; component < components.Count(); ++component)
  {
    numbers[component] = isLong[components.Lowest[component]] ? number++ : None;
  }
  regionOf.resize(count);
  for (Index t = 0; t < count; ++t)
  {
    regionOf[t] = numbers[components.ComponentOf(t)];
  }
  return regionOf;
}

double LargestHeight(const Mesh& mesh, Index triangle)
{
  double height = 0.0;
  for (Index h = 3 * triangle; h < 3 * triangle + 3; ++h)
  {
    const Point2& a = mesh.PointOf(mesh.Origin(h));
    const Point2& b = mesh.PointOf(mesh.Destination(h));
    const Point2& c = mesh.PointOf(mesh.Apex(h));
    const double length = Distance(a, b);
    // Divided by the length first, so that large coordinates do not overflow.
    height =
      std::max(height, (b.X - a.X) / length * (c.Y - a.Y) - (b.Y - a.Y) / length * (c.X - a.X));
  }
  return height;
}

void AddBorderRegions(const std::vector<BorderEdge>& border, const std::vector<Index>& regionOf,
  const PointView& points, Holes& holes, const Progress& progress)
{
  Stages stages(progress, { 30, 70 });
  // The functions for borders expect the surface on the left, and so the region on the right.
  std::vector<BorderEdge> reversed;
  for (const BorderEdge& edge : border)
  {
    reversed.push_back({ edge.Destination, edge.Origin });
  }
  std::vector<Index> ids;
  const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(holes.Walks.Vertices.size());
  const Mesh mesh = MakeBorderMesh(reversed, points, stages.Next(), ids);
  RegionFinder(mesh, holes.LongestEdge, holes).RunOnBorder(regionOf, stages.Next());
  std::for_each(holes.Walks.Vertices.begin() + first, holes.Walks.Vertices.end(),
    [&ids](Index& vertex) { vertex = ids[vertex]; });
}

bool OpenLongTriangles(
  const Mesh& mesh, double longest, Holes& holes, Mesh& rest, const Progress& progress)
{
  Stages stages(progress, { 90, 10 });
  RegionFinder finder(mesh, longest, holes);
  if (!finder.Run(stages.Next()))
  {
    return false;
  }
  rest = mesh;
  KeepTriangles(finder.Others(), rest);
  Report(stages.Next(), 1.0);
  return true;
}

namespace
{
/**
 * Of groups, entries offsets[i] to offsets[i+1] - 1 of some values each, keeps those flagged. For
 * both kinds of lists in Holes: walks of a hole, inner edges of a region (two values each).
 */
void KeepGroups(const std::vector<char>& keep, std::ptrdiff_t valuesPerEntry,
  std::vector<Index>& offsets, std::vector<Index>& values)
{
  std::vector<Index> keptOffsets{ 0 };
  std::vector<Index> kept;
  for (std::size_t i = 0; i < keep.size(); ++i)
  {
    if (keep[i])
    {
      kept.insert(kept.end(), values.begin() + valuesPerEntry * offsets[i],
        values.begin() + valuesPerEntry * offsets[i + 1]);
      keptOffsets.push_back(keptOffsets.back() + offsets[i + 1] - offsets[i]);
    }
  }
  offsets = std::move(keptOffsets);
  values = std::move(kept);
}
} // namespace

void KeepRegions(const std::vector<char>& keep, Holes& holes)
{
  std::vector<Index> numbers;
  Index count = 0;
  for (const char isKept : keep)
  {
    numbers.push_back(isKept ? count++ : None);
  }
  for (Index& region : holes.RegionOf)
  {
    region = region == None ? None : numbers[region];
  }
  const std::ptrdiff_t first = holes.Count() - holes.NumberOfRegions();
  KeepGroups({ keep.begin() + first, keep.end() }, 2, holes.InnerOffsets, holes.InnerEnds);
  KeepGroups(keep, 1, holes.Offsets, holes.Loops);
  holes.Touched.resize(count); // those of regions are 0
}

} // namespace elevation
