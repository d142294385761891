// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Find() makes of the border what FindHoles() makes of a surface, with points numbered by keys. A
 * group of holes then goes through Surround(), Needs(), Fill() and KeepCorners(), and is packed. The
 * kernel fills them as holes of a small surface; what it has to know beyond that stands in
 * WholeSurface: how far the triangles are complete, the lattice, and what other holes leave of the
 * limit of new points.
 */
#include "SharedHoles.h"

#include "Adapt/Adapt.h"
#include "Joining.h"

#include "vtkPolyData.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>

namespace elevation
{

bool SharedHoles::Find(const Progress& progress)
{
  const PointView points = this->Border.View();
  this->Result = FillResult();
  // Holes of the surface first, then regions of long triangles, as in one run.
  this->Result.Found = FindBorderHoles(this->Border.Edges, points, progress);
  this->FirstRegion = this->Result.Found.Count();
  if (!this->Border.RegionEdges.empty())
  {
    AddBorderRegions(
      this->Border.RegionEdges, this->Border.EdgeRegion, points, this->Result.Found, progress);
  }
  this->Extents = ExtentsOf(this->Result.Found, points);
  this->Retries.assign(this->Extents.size(), 0);
  this->Reach.assign(this->Extents.size(), 0.0);
  this->HaveRoom.assign(this->Extents.size(), 1);
  // MeasureHole() wants a mesh, but looks at its points alone.
  Mesh places;
  for (Index i = 0; i < points.Count; ++i)
  {
    places.Points.push_back(points.At(i));
  }
  FillOptions options = this->Options;
  options.OnBoundary = this->Border.OnBoundary;
  for (Index hole = 0; hole < this->Result.Found.Count(); ++hole)
  {
    this->Result.Reports.push_back(MeasureHole(places, this->Result.Found, hole, options));
  }
  return this->Result.Found.NumberOfContacts == 0;
}

/** As on one rank: only for holes to be filled, without a spacing. */
bool SharedHoles::NeedLattice() const
{
  bool areToBeFilled = false;
  for (std::size_t hole = 0; hole < this->Result.Reports.size(); ++hole)
  {
    areToBeFilled = areToBeFilled || this->IsToBeFilled(hole);
  }
  return areToBeFilled && !(this->Options.Spacing > 0.0);
}

void SharedHoles::FindLattice(
  const Ranks& ranks, const PointSlices& points, const Progress& progress)
{
  LatticeSample sample;
  this->Lattice.Found = FitLatticeOnRanks(ranks, points, LatticeTolerance,
    ThreadsAtOnce(this->Options.NumberOfThreads), progress, sample, this->Lattice.Steps);
}

void SharedHoles::DropRegionsWithoutRoom()
{
  std::vector<HoleReport> reports;
  for (std::size_t hole = 0; hole < this->HaveRoom.size(); ++hole)
  {
    // What was known by old numbers can be asked by these alone.
    this->NewNumbers.push_back(this->HaveRoom[hole] ? static_cast<Index>(reports.size()) : None);
    if (this->HaveRoom[hole])
    {
      reports.push_back(std::move(this->Result.Reports[hole]));
    }
  }
  this->Result.Reports = std::move(reports);
  KeepRegions({ this->HaveRoom.begin(), this->HaveRoom.end() }, this->Result.Found);
}

// From the region of a part to that of all, to its number as a hole, to the number that is left.
Index SharedHoles::NumberOf(int part, Index region) const
{
  return this->NewNumbers[this->FirstRegion + this->Border.Regions.at({ part, region })];
}

void SharedHoles::NumberNewPoints()
{
  this->FirstNewPoints.assign(1, 0);
  for (const HoleReport& report : this->Result.Reports)
  {
    this->FirstNewPoints.push_back(this->FirstNewPoints.back() + report.NumberOfInsertedPoints);
  }
}

/*
 * A surface of its own of what parts have sent: points that are one are joined, and triangles
 * between parts become neighbours again.
 */
void SurroundedHoles::Surround(const Parts& parts, const SharedHoles& all, const Progress& progress)
{
  Stages stages(progress, { 40, 30, 20, 10 });
  std::vector<Message> warnings; // none: all have the same arrays
  this->Near = Mesh();
  this->Surrounding = elevation::Join(parts, PartKind::Mesh, stages.Next(), warnings);
  this->Keys = KeysOf(this->Surrounding, all.ByIds, nullptr);
  ToMesh(this->Surrounding, this->Near, stages.Next());
  this->Near.ConnectTwins(0, stages.Next());
  Mesh rest;
  if (all.LongestEdge > 0.0 &&
    OpenLongTriangles(this->Near, all.LongestEdge, this->Regions, rest, stages.Next()))
  {
    this->Near = std::move(rest);
  }
}

/**
 * Of holes from the first that is a region, by the points of the surrounding: what is inside. All
 * of their triangles are there, so the rim begins with the same edge; other regions may be cut off.
 */
void SurroundedHoles::ListRegions(Index first, Holes& holes) const
{
  // By the first edge of the rim, which no other region has on the same side.
  std::map<std::pair<Index, Index>, Index> regionAt;
  const auto rimOf = [](const Holes& some, Index hole) {
    const Index* const rim = some.Walks.Begin(some.Rim(hole));
    return std::make_pair(rim[0], rim[1]);
  };
  for (Index region = 0; region < this->Regions.Count(); ++region)
  {
    regionAt.emplace(rimOf(this->Regions, region), region);
  }
  for (Index hole = first; hole < holes.Count(); ++hole)
  {
    // It can only be missing if a part has not sent a triangle that meets the rim's box.
    const auto found = regionAt.find(rimOf(holes, hole));
    if (found == regionAt.end())
    {
      throw Error("A triangle of a hole has not come from another part of the surface.");
    }
    this->Regions.VisitInnerEdges(found->second, [&holes](Index a, Index b) {
      holes.InnerEnds.insert(holes.InnerEnds.end(), { a, b });
    });
    // As Holes keeps them: two ends an edge.
    holes.InnerOffsets.push_back(static_cast<Index>(holes.InnerEnds.size() / 2));
  }
  holes.LongestEdge = this->Regions.LongestEdge;
  holes.Gaps = this->Regions.Gaps;
}

/** The holes by the points of the surrounding. */
Holes SurroundedHoles::Listed(const SharedHoles& all) const
{
  // Of the border's points, those around these holes alone have a place here.
  std::vector<Index> placeOf(all.Border.Keys.size(), None);
  for (std::size_t i = 0; i < this->Keys.size(); ++i)
  {
    const Index at = all.Border.Find(this->Keys[i]);
    if (at != None)
    {
      placeOf[at] = static_cast<Index>(i);
    }
  }
  const Holes& found = all.Result.Found;
  Holes holes;
  for (const Index hole : this->Numbers)
  {
    for (Index i = found.Offsets[hole]; i < found.Offsets[hole + 1]; ++i)
    {
      const Index walk = found.Loops[i];
      holes.Loops.push_back(static_cast<Index>(holes.Walks.Count()));
      std::transform(found.Walks.Begin(walk), found.Walks.End(walk),
        std::back_inserter(holes.Walks.Vertices), [&](Index v) { return placeOf[v]; });
      holes.Walks.Offsets.push_back(static_cast<Index>(holes.Walks.Vertices.size()));
    }
    holes.Offsets.push_back(static_cast<Index>(holes.Loops.size()));
    // Where borders touch, FillParts has given up before.
    holes.Touched.push_back(0);
  }
  // A box holds the rim, so each of its points has come with a triangle.
  if (std::count(holes.Walks.Vertices.begin(), holes.Walks.Vertices.end(), None) > 0)
  {
    throw Error("A point of a hole has not come from another part of the surface.");
  }
  // Regions come last, here as among all holes.
  const auto firstRegion =
    std::lower_bound(this->Numbers.begin(), this->Numbers.end(), all.FirstRegion);
  this->ListRegions(static_cast<Index>(firstRegion - this->Numbers.begin()), holes);
  return holes;
}

// What is by the points of the surrounding: their precision and their attributes.
FillOptions SurroundedHoles::OptionsFor(const SharedHoles& all, const Progress& progress) const
{
  FillOptions options = all.Options;
  options.Monitor = progress;
  options.SinglePrecision = HasFloatPoints(this->Surrounding);
  if (all.Interpolate)
  {
    options.Attributes = AttributesOf(this->Surrounding->GetPointData());
  }
  return options;
}

// What one run would know by looking at the whole surface.
WholeSurface SurroundedHoles::KnownOf(const SharedHoles& all) const
{
  WholeSurface whole;
  whole.FoundLattice = &all.Lattice;
  whole.Elevations = all.Elevations;
  for (const Index hole : this->Numbers)
  {
    whole.Surroundings.push_back(all.BoxOf(hole));
    // There are none yet while needs are found, of which quotas are made.
    if (!all.Quotas.empty())
    {
      whole.Quotas.push_back(all.Quotas[hole]);
    }
  }
  return whole;
}

std::vector<HoleNeed> SurroundedHoles::Needs(const SharedHoles& all, const Progress& progress) const
{
  return FindHoleNeeds(this->Near, ViewPoints(this->Surrounding).View, this->Listed(all),
    this->OptionsFor(all, progress), this->KnownOf(all));
}

std::vector<Index> SurroundedHoles::Fill(const SharedHoles& all, const Progress& progress)
{
  this->Patches = FillHoles(this->Near, ViewPoints(this->Surrounding).View, this->Listed(all),
    this->OptionsFor(all, progress), this->KnownOf(all));
  // Numbers become those of the holes that are left, which Patches.Reports are of.
  std::vector<Index> numbers, beyond;
  for (std::size_t i = 0; i < this->Numbers.size(); ++i)
  {
    if (this->Patches.HaveRoom[i])
    {
      numbers.push_back(this->Numbers[i]);
    }
  }
  this->Numbers = std::move(numbers);
  for (std::size_t i = 0; i < this->Numbers.size(); ++i)
  {
    if (this->Patches.Reports[i].NeedsMoreSurroundings)
    {
      beyond.push_back(this->Numbers[i]);
    }
  }
  return beyond;
}

// Ids from the count of points on are those of the patches' new points; they follow the kept ones.
void SurroundedHoles::KeepCorners()
{
  const Index count = static_cast<Index>(this->Keys.size());
  IdSet used(count);
  const auto eachId = [this](const auto& visit) {
    for (std::vector<Index>* ids :
      { &this->Patches.Triangles, &this->Patches.NearestBoundaryPoints })
    {
      std::for_each(ids->begin(), ids->end(), visit);
    }
  };
  eachId([&](Index id) {
    if (id < count)
    {
      used.Add(id);
    }
  });
  const std::vector<Index> kept = used.ListAndRank();
  const Index first = static_cast<Index>(kept.size());
  eachId([&](Index& id) { id = id < count ? used.RankOf(id) : first + id - count; });
  this->Surrounding = ChosenPoints(this->Surrounding, kept);
  std::vector<PointKey> keys;
  for (const Index id : kept)
  {
    keys.push_back(this->Keys[id]);
  }
  // What is packed next is a patch: the triangles around it are no longer needed.
  this->Keys = std::move(keys);
  this->Near = Mesh();
  this->Regions = Holes();
}

namespace
{
/** Appends all lists of a result, whose ids and offsets go on. */
void AppendLists(const FillResult& from, FillResult& to)
{
  const auto append = [](const auto& values, auto& all) {
    all.insert(all.end(), values.begin(), values.end());
  };
  append(from.Points, to.Points);
  append(from.Triangles, to.Triangles);
  append(from.PointOffsets, to.PointOffsets);
  append(from.TriangleOffsets, to.TriangleOffsets);
  append(from.NearestBoundaryPoints, to.NearestBoundaryPoints);
  append(from.StandardErrors, to.StandardErrors);
  append(from.HalfIntervals, to.HalfIntervals);
  for (std::size_t i = 0; i < from.Attributes.size(); ++i)
  {
    append(from.Attributes[i], to.Attributes[i]);
  }
}
} // namespace

/*
 * Points of the groups' surroundings come first, group after group; then the new points of all:
 *
 *     surroundings of 0, 1, 2 | new points of 0, 1, 2
 *     in group 1, id i < count is first + i, and an id beyond is firstNew + (i - count)
 *
 * A point that two groups have is there twice; FilledPart finds both by their key.
 */
SurroundedHoles::SurroundedHoles(std::vector<SurroundedHoles>&& groups)
{
  // A group that was filled again comes after later ones.
  std::sort(groups.begin(), groups.end(),
    [](const SurroundedHoles& a, const SurroundedHoles& b) { return a.Numbers[0] < b.Numbers[0]; });
  Parts surroundings;
  for (const SurroundedHoles& group : groups)
  {
    this->Numbers.insert(this->Numbers.end(), group.Numbers.begin(), group.Numbers.end());
    this->Keys.insert(this->Keys.end(), group.Keys.begin(), group.Keys.end());
    surroundings.push_back(group.Surrounding);
  }
  this->Surrounding = groups.empty() ? nullptr : Append(surroundings);
  Index first = 0, firstNew = static_cast<Index>(this->Keys.size());
  for (SurroundedHoles& group : groups)
  {
    FillResult& patches = group.Patches;
    const Index count = static_cast<Index>(group.Keys.size());
    for (std::vector<Index>* ids : { &patches.Triangles, &patches.NearestBoundaryPoints })
    {
      // New points of all groups follow the surrounding points of all groups.
      std::for_each(ids->begin(), ids->end(),
        [&](Index& id) { id = id < count ? first + id : firstNew + id - count; });
    }
    const Index points = this->Patches.NumberOfPoints();
    const Index triangles = this->Patches.NumberOfTriangles();
    first += count;
    firstNew += patches.NumberOfPoints();
    std::for_each(patches.PointOffsets.begin(), patches.PointOffsets.end(),
      [points](Index& offset) { offset += points; });
    std::for_each(patches.TriangleOffsets.begin(), patches.TriangleOffsets.end(),
      [triangles](Index& offset) { offset += triangles; });
    // The end of the groups so far is the begin of this one, which its own offsets have.
    this->Patches.PointOffsets.pop_back();
    this->Patches.TriangleOffsets.pop_back();
    this->Patches.Attributes.resize(patches.Attributes.size());
    AppendLists(patches, this->Patches);
  }
}

} // namespace elevation
