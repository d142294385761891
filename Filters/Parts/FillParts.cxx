// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * The passes in their order. Modes differ in three things: whether a part stays (WithPart), which
 * part a hole goes to (HoleParts), and by what a point is known to be another part's: in files
 * it is marked, in memory ranks find out together (FindCopies).
 */
#include "FillParts.h"

#include "Adapt/Adapt.h"
#include "FilterRun.h"
#include "PackedData.h"

#include "vtkCellData.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace elevation
{

namespace
{
// The boxes of a part, and that of a group; see Engine.h.
constexpr int Patches = 0, Rims = 1, Surrounding = 0;

// Small groups cost more than they save: each has a file, and its surroundings overlap those of
// others.
constexpr double LeastGroupPoints = 1000.0;
constexpr double PartGroups = 8.0; // so many groups together take the memory of a part
} // namespace

FillParts::FillParts(const SurfaceParts& surface, const FillOptions& options, bool interpolate,
  double longest, bool byIds)
  : Make(surface.Make)
  , Crew(surface.Crew.AllRanks(), surface.Crew.EndOwn() - surface.Crew.FirstOwn(),
      { "patches", "rims" }, surface.Crew.Folder())
  , AllRanks(surface.Crew.AllRanks())
  , Passes(options.Monitor, { 20, 80 })
{
  this->AllHoles.Options = options;
  this->AllHoles.Interpolate = interpolate;
  this->AllHoles.LongestEdge = longest;
  this->AllHoles.ByIds = byIds;
}

/**
 * Visits a part with points. In memory it stays, with what is read of it; in files it is made anew,
 * and goes.
 */
template <typename Visit>
void FillParts::WithPart(int part, const Progress& progress, const Visit& visit)
{
  Stages stages(progress, { 50, 50 });
  const Progress making = stages.Next();
  FilledPart made;
  FilledPart& one = this->Crew.IsInFiles() ? made : this->InMemory;
  // In files one is new each time. In memory this is so at the first visit alone, but where Make()
  // returns nothing it is asked again.
  if (!one.Input)
  {
    one.Number = part;
    one.Input = this->Make(part, making);
  }
  if (one.Input)
  {
    visit(one, stages.Next());
  }
}

/** What all ranks will know of a part. Also counts its long triangles. */
FillParts::KnownPart FillParts::Describe(int part, const FilledPart& one)
{
  KnownPart known;
  const DataSetPoints points = ViewPoints(one.Input);
  for (const Index corner : one.OwnMesh.Triangles)
  {
    known.Extent.Add(one.OwnMesh.PointOf(corner));
    known.Elevations.Add(points.View.Elevation(corner));
  }
  known.Triangles = one.OwnMesh.NumberOfTriangles();
  known.Points = one.Input->GetNumberOfPoints();
  known.OwnPoints = one.OwnCount();
  known.LargestId = elevation::LargestId(one.Input->GetPointData()->GetGlobalIds());
  known.NextHole = NextHole(one.Input);
  for (std::size_t t = 0; t < one.RegionOf.size(); ++t)
  {
    if (one.RegionOf[t] != None)
    {
      ++this->LongTriangles[{ part, one.RegionOf[t] }];
      known.LargestHeight =
        std::max(known.LargestHeight, LargestHeight(one.OwnMesh, static_cast<Index>(t)));
    }
  }
  return known;
}

/*
 * A part is looked at once. The points on its border are kept meanwhile, as which of them are on
 * that of the surface is known only when all ranks have sent their edges.
 */
void FillParts::FindHoles(int rimsPart)
{
  Stages stages(this->Passes.Next(), { 90, 10 });
  this->RimsPart = rimsPart;
  std::vector<KnownPart> own(this->Crew.EndOwn() - this->Crew.FirstOwn());
  PartEdges edges;
  Parts borders;
  this->Crew.ForEach(stages.Next(), [&](int part, const Progress& progress) {
    this->WithPart(part, progress, [&](FilledPart& one, const Progress& reading) {
      one.Read(this->AllHoles.ByIds, this->AllHoles.LongestEdge, reading);
      AppendBorder(one.OwnMesh, one.Shared, one.RegionOf, part, edges);
      borders.push_back(one.PointsOnBorder());
      own[part - this->Crew.FirstOwn()] = this->Describe(part, one);
    });
  });
  if (!this->Crew.IsInFiles())
  {
    // All ranks meet here. A rank without points takes part with an empty list.
    FindCopies(this->AllRanks, this->AllHoles.ByIds, this->InMemory.Shared);
    if (this->InMemory.Input)
    {
      own[0].OwnPoints = this->InMemory.OwnCount();
    }
  }
  // Rank after rank, so by the numbers of parts.
  this->KnownParts = this->AllRanks.Collect(own);
  for (int part = 0; part < this->Crew.PartCount(); ++part)
  {
    const double points = static_cast<double>(this->KnownParts[part].OwnPoints);
    this->Points += points;
    this->RankPoints += this->Crew.IsOwn(part) ? points : 0.0;
    this->LargestId = std::max(this->LargestId, this->KnownParts[part].LargestId);
  }
  this->AllHoles.Border = CollectBorder(this->AllRanks, std::move(edges));
  this->SendRims(std::move(borders));
  this->AllRanks.Agree([&]() {
    if (!this->AllHoles.Find(this->AllRanks.Watched(stages.Next())))
    {
      throw Error("Borders of the surface touch, so that it cannot be filled in pieces; fill the "
                  "surface in memory.");
    }
    this->FindReaches();
  });
  for (const KnownPart& known : this->KnownParts)
  {
    // Holes that were filled before keep their numbers (NextHole), wherever they are.
    Index& first = this->AllHoles.Result.FirstNumber;
    first = std::max(first, known.NextHole);
    this->AllHoles.Elevations.Add(known.Elevations.Low);
    this->AllHoles.Elevations.Add(known.Elevations.High);
  }
}

/**
 * Finds from a long triangle how far the next line is from the points of a region, up to half of
 * its height away (Holes::Gaps).
 */
void FillParts::FindReaches()
{
  const Index count = this->AllHoles.Result.Found.Count();
  for (Index hole = this->AllHoles.FirstRegion; hole < count; ++hole)
  {
    const Box& rim = this->AllHoles.Extents[hole].OfRim;
    for (const KnownPart& known : this->KnownParts)
    {
      // A gap falls by twice the way from a long triangle (Holes::Gaps), so that half of the height
      // away nothing is left of it: a part further away has no say in this hole.
      const double reach = 0.5 * known.LargestHeight;
      const Box within{ { rim.Low.X - reach, rim.Low.Y - reach },
        { rim.High.X + reach, rim.High.Y + reach } };
      if (within.Intersects(known.Extent))
      {
        this->AllHoles.Reach[hole] = std::max(this->AllHoles.Reach[hole], reach);
      }
    }
  }
}

/** The points on the border of the surface, of all that are on that of a part. */
void FillParts::SendRims(Parts&& borders)
{
  this->AllRanks.Agree([&]() {
    for (vtkSmartPointer<vtkPolyData>& points : borders)
    {
      const std::vector<PointKey> keys =
        points ? KeysOf(points, this->AllHoles.ByIds, nullptr) : std::vector<PointKey>();
      std::vector<Index> chosen;
      for (std::size_t i = 0; i < keys.size(); ++i)
      {
        // Of points on the border of the part: those on that of the surface alone are needed for
        // outlines.
        if (this->AllHoles.Border.Find(keys[i]) != None)
        {
          chosen.push_back(static_cast<Index>(i));
        }
      }
      points = chosen.empty() ? nullptr : ChosenPoints(points, chosen);
      if (points && this->Crew.IsOwn(this->RimsPart))
      {
        this->OwnRims.push_back(points);
      }
      else if (points)
      {
        this->Crew.Send(this->RimsPart, Rims, PackData(points));
      }
      points = nullptr;
    }
  });
  this->Crew.Deliver();
}

void FillParts::Fill()
{
  Stages stages(this->Passes.Next(), { 38, 62 });
  const Progress finding = stages.Next();
  if (this->AllHoles.NeedLattice())
  {
    this->FindLattice(finding);
  }
  this->GroupHoles();
  this->FillAll(stages.Next());
  // Each rank knows the reports of its own groups alone. From DropRegionsWithoutRoom() on, holes
  // have other numbers; so all that is shared by the old ones is shared before.
  this->ShareHoleValues(this->AllHoles.Result.Reports);
  this->ShareHoleValues(this->AllHoles.HaveRoom);
  this->AllHoles.DropRegionsWithoutRoom();
  this->AllHoles.NumberNewPoints();
  for (const auto& [region, triangles] : this->LongTriangles)
  {
    const Index hole = this->AllHoles.NumberOf(static_cast<int>(region.first), region.second);
    const bool isReplaced =
      hole != None && this->AllHoles.Result.Reports[hole].Status == FillStatus::Replaced;
    // A region's triangles on this rank give way to the patch, wherever that was made.
    this->NewTriangles -= isReplaced ? triangles : 0;
  }
  // Parts in files have marks anyway; those in memory get them if any has a point of another.
  std::vector<vtkIdType> sums = { this->NewTriangles, this->Crew.IsInFiles() ? 1 : 0 };
  if (!this->Crew.IsInFiles())
  {
    this->Crew.ForEach(Progress(), [&](int part, const Progress& progress) {
      this->WithPart(part, progress, [&](FilledPart& one, const Progress&) {
        this->TakePatches(part, one);
        sums[1] += one.OtherCount();
      });
    });
  }
  this->AllRanks.Sum(sums);
  this->NewTriangles = sums[0];
  this->AreMarked = sums[1] > 0;
}

/** That of all points, each counted once. A part is a slice. */
void FillParts::FindLattice(const Progress& progress)
{
  Stages stages(progress, { 0, 100 });
  const Progress making = this->AllRanks.Watched(stages.Next());
  const auto forEach = [&](const auto& visit) {
    for (int part = this->Crew.FirstOwn(); part < this->Crew.EndOwn(); ++part)
    {
      this->WithPart(part, making, [&visit](FilledPart& one, const Progress&) {
        Buffer<double> kept;
        // A view of memory that is here during the visit alone.
        visit(one.OwnPoints(kept));
      });
    }
  };
  this->AllHoles.FindLattice(this->AllRanks, { this->RankPoints, forEach }, stages.Next());
}

/**
 * The part of each hole; in memory, of a rank with points. In files, the part that has the edge at
 * which the rim begins: so a hole's group and its patch are mostly on the rank that surrounds them.
 */
std::vector<int> FillParts::HoleParts() const
{
  std::vector<int> parts;
  if (!this->Crew.IsInFiles())
  {
    std::vector<vtkIdType> have;
    for (const KnownPart& known : this->KnownParts)
    {
      have.push_back(known.Points);
    }
    return BalancedRanks(this->AllHoles.Extents, have);
  }
  const SharedBorder& border = this->AllHoles.Border;
  std::vector<int> partOf(border.Keys.size(), 0);
  for (std::size_t i = 0; i < border.RegionEdges.size(); ++i)
  {
    partOf[border.RegionEdges[i].Origin] = border.RegionEdgePart[i];
  }
  // After those of regions, as a point may be on both.
  for (std::size_t i = 0; i < border.Edges.size(); ++i)
  {
    partOf[border.Edges[i].Origin] = border.EdgePart[i];
  }
  const Holes& found = this->AllHoles.Result.Found;
  for (Index hole = 0; hole < found.Count(); ++hole)
  {
    parts.push_back(partOf[*found.Walks.Begin(found.Rim(hole))]);
  }
  return parts;
}

/**
 * About how many points are in the box around a hole. Two estimates, of which the larger counts: as
 * dense as the rim; or as the part on the average, where a surface has half as many points as
 * triangles.
 */
double FillParts::PointsAround(Index hole, const KnownPart& part) const
{
  const HoleExtent& extent = this->AllHoles.Extents[hole];
  const Box box = this->AllHoles.BoxOf(hole);
  const double area = box.Width() * box.Height();
  const Box& all = part.Extent;
  return std::max(area / (extent.MeanEdge * extent.MeanEdge),
    0.5 * part.Triangles * area / (all.Width() * all.Height()));
}

/** The same groups on all ranks; those of one rank are next to each other, as its parts are. */
void FillParts::GroupHoles()
{
  const std::vector<int> partOf = this->HoleParts();
  std::vector<std::vector<Index>> holesOf(this->KnownParts.size());
  for (std::size_t hole = 0; hole < partOf.size(); ++hole)
  {
    if (this->AllHoles.IsToBeFilled(hole))
    {
      holesOf[partOf[hole]].push_back(static_cast<Index>(hole));
    }
  }
  // What surrounds a group is in memory at once. In files an eighth of what a part has is allowed
  // for it; in memory, a rank has all of its holes in one group.
  const double most = !this->Crew.IsInFiles()
    ? std::numeric_limits<double>::infinity()
    : std::max(
        LeastGroupPoints, this->Points / static_cast<double>(this->KnownParts.size()) / PartGroups);
  int ownCount = 0;
  for (int part = 0; part < this->Crew.PartCount(); ++part)
  {
    double points = 0.0; // around the holes of the group
    for (const Index hole : holesOf[part])
    {
      const double around = this->PointsAround(hole, this->KnownParts[part]);
      // Holes come in the order of their numbers. A hole that is larger than this has a group of
      // its own.
      if (hole == holesOf[part].front() || points + around > most)
      {
        this->Groups.push_back({ part, {} });
        ownCount += this->Crew.IsOwn(part) ? 1 : 0;
        points = 0.0;
      }
      this->Groups.back().Holes.push_back(hole);
      points += around;
    }
  }
  this->GroupCrew = std::make_unique<Engine>(
    this->AllRanks, ownCount, std::vector<std::string>{ "surrounding" }, this->Crew.Folder());
}

/** Sends the groups that wait for them the triangles around their holes. */
void FillParts::Surround(const std::vector<char>& areWaiting, const Progress& progress)
{
  this->Crew.ForEachInTurn(progress, *this->GroupCrew, [&](int part, const Progress& ofPart) {
    // By the boxes of parts, before anything is read: most parts meet few groups.
    std::map<int, std::vector<Box>> boxes; // that meet the part, of each group
    for (std::size_t group = 0; group < this->Groups.size(); ++group)
    {
      for (std::size_t i = 0; i < this->Groups[group].Holes.size() && areWaiting[group]; ++i)
      {
        const Box box = this->AllHoles.BoxOf(this->Groups[group].Holes[i]);
        if (box.Intersects(this->KnownParts[part].Extent))
        {
          boxes[static_cast<int>(group)].push_back(box);
        }
      }
    }
    if (boxes.empty())
    {
      return;
    }
    this->WithPart(part, ofPart, [&](FilledPart& one, const Progress& reading) {
      const bool isInFiles = this->Crew.IsInFiles();
      // In memory the mesh is there since pass 1. Long triangles are sent with the others: they are
      // opened again where they arrive, in the same way.
      if (isInFiles)
      {
        ToMesh(one.Input, one.OwnMesh, reading);
      }
      for (const auto& [group, ofGroup] : boxes)
      {
        const std::vector<Index> near = TrianglesIn(ofGroup, one.OwnMesh);
        if (near.empty())
        {
          continue;
        }
        // Groups of this rank may be many, so what goes to their files is not kept.
        Bytes packed = PackData(ChosenTriangles(one.Input, one.OwnMesh, near));
        const bool isOwnFile = isInFiles && this->GroupCrew->IsOwn(group);
        isOwnFile ? this->GroupCrew->At(group, Surrounding).Append(std::move(packed))
                  : this->GroupCrew->Send(group, Surrounding, std::move(packed));
      }
    });
  });
}

/**
 * The holes of a group, and what surrounds them: in memory read once, in files anew each time. An
 * empty box in memory means that it has been read, when needs were found. In files it is never
 * empty: a hole that is to be filled has triangles around it.
 */
SurroundedHoles& FillParts::HolesOf(int group, const Progress& progress)
{
  Inbox& box = this->GroupCrew->At(group, Surrounding);
  if (!box.IsEmpty())
  {
    this->Around = SurroundedHoles();
    this->Around.Numbers = this->Groups[group].Holes;
    Parts parts;
    box.ForEach(
      [&parts](const Bytes& bytes) { parts.push_back(UnpackData(bytes.data(), bytes.size())); });
    if (!this->Crew.IsInFiles())
    {
      box.Clear();
    }
    this->Around.Surround(parts, this->AllHoles, progress);
  }
  return this->Around;
}

/**
 * Hands to all ranks what each knows of the holes of its groups. Values alone are sent: groups, and
 * holes in them, are in the same order on all ranks.
 */
template <typename Value>
void FillParts::ShareHoleValues(std::vector<Value>& values) const
{
  std::vector<Value> own;
  for (int group = this->GroupCrew->FirstOwn(); group < this->GroupCrew->EndOwn(); ++group)
  {
    for (const Index hole : this->Groups[group].Holes)
    {
      own.push_back(values[hole]);
    }
  }
  const std::vector<Value> all = this->AllRanks.Collect(own);
  auto next = all.begin();
  for (const Group& group : this->Groups)
  {
    for (const Index hole : group.Holes)
    {
      values[hole] = *next++;
    }
  }
}

/** What each hole may take, and whether all take too much, is known where all needs are. */
void FillParts::FindQuotas(const Progress& progress)
{
  // Holes that the limits refuse are in no group, and keep a need that is NaN.
  std::vector<HoleNeed> needs(this->AllHoles.Extents.size());
  this->GroupCrew->ForEach(progress, [&](int group, const Progress& ofGroup) {
    Stages stages(ofGroup, { 50, 50 });
    SurroundedHoles& holes = this->HolesOf(group, stages.Next());
    const std::vector<HoleNeed> found = holes.Needs(this->AllHoles, stages.Next());
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      needs[holes.Numbers[i]] = found[i];
    }
  });
  this->ShareHoleValues(needs);
  this->AllRanks.Agree([&]() { CheckEffort(needs, this->Points, this->AllHoles.Options); });
  this->AllHoles.Quotas = QuotasFor(needs, this->AllHoles.Options.MaximumInsertedPoints);
}

/** @return false if holes, which are added to those beyond, need more of the surface around them */
// Fills a group. What is done leaves memory, and the box, when the next one is worked on.
bool FillParts::FillGroup(int group, const Progress& progress, std::vector<vtkIdType>& beyond)
{
  Stages stages(progress, { 10, 90 });
  SurroundedHoles& holes = this->HolesOf(group, stages.Next());
  const std::vector<Index> found = holes.Fill(this->AllHoles, stages.Next());
  beyond.insert(beyond.end(), found.begin(), found.end());
  for (const Index hole : this->Groups[group].Holes)
  {
    // Fill() has taken regions without room out of the numbers.
    this->AllHoles.HaveRoom[hole] =
      std::binary_search(holes.Numbers.begin(), holes.Numbers.end(), hole) ? 1 : 0;
  }
  for (std::size_t i = 0; i < holes.Numbers.size(); ++i)
  {
    this->AllHoles.Result.Reports[holes.Numbers[i]] = holes.Patches.Reports[i];
  }
  // If one hole needs more, the whole group is done again: its patches are one list.
  if (found.empty() && holes.Patches.NumberOfTriangles() > 0)
  {
    this->NewTriangles += holes.Patches.NumberOfTriangles();
    holes.KeepCorners();
    // Without a message: a group is on the rank of its part (GroupHoles).
    this->Crew.At(this->Groups[group].Part, Patches).Append(Packed(holes));
  }
  this->GroupCrew->At(group, Surrounding).Clear();
  holes = SurroundedHoles();
  return found.empty();
}

/** Until no hole needs more of the surface around it; of a group, all holes are filled again. */
void FillParts::FillAll(const Progress& progress)
{
  // Few holes need more than their first box: so the first round takes nearly all of the progress.
  Stages stages(progress, { 16, 4, 60, 0, 20 });
  Progress surrounding = stages.Next();
  const Progress counting = stages.Next();
  Progress filling = stages.Next();
  const Progress surroundingMore = stages.Next(), fillingMore = stages.Next();
  std::vector<char> areWaiting(this->Groups.size(), 1);
  while (std::count(areWaiting.begin(), areWaiting.end(), 1) > 0)
  {
    this->Surround(areWaiting, surrounding);
    // Once, in the first round.
    if (this->AllHoles.Quotas.empty())
    {
      this->FindQuotas(counting);
    }
    // Numbers as vtkIdType, so that one kind of Collect() is enough.
    std::vector<vtkIdType> beyond, waiting; // holes, and their groups
    this->GroupCrew->ForEach(filling, [&](int group, const Progress& ofGroup) {
      if (areWaiting[group] && !this->FillGroup(group, ofGroup, beyond))
      {
        waiting.push_back(group);
      }
    });
    surrounding = surroundingMore;
    filling = fillingMore;
    // On all ranks, as each of them sends by BoxOf(), which is larger then.
    for (const vtkIdType hole : this->AllRanks.Collect(beyond))
    {
      ++this->AllHoles.Retries[hole];
    }
    std::fill(areWaiting.begin(), areWaiting.end(), char(0));
    for (const vtkIdType group : this->AllRanks.Collect(waiting))
    {
      areWaiting[group] = 1;
    }
  }
}

/** Reads the patches of a part. */
void FillParts::TakePatches(int part, FilledPart& one)
{
  std::vector<SurroundedHoles> groups;
  Inbox& box = this->Crew.At(part, Patches);
  box.ForEach(
    [&groups](const Bytes& bytes) { groups.push_back(Unpacked<SurroundedHoles>(bytes)); });
  if (!this->Crew.IsInFiles())
  {
    box.Clear();
  }
  one.Filled = SurroundedHoles(std::move(groups));
  for (Index& hole : one.Filled.Numbers)
  {
    // Packed before regions without room were dropped.
    hole = this->AllHoles.NewNumbers[hole];
  }
  one.FindCorners();
}

// A part from files is read again, as it was in pass 1.
void FillParts::Pass(int part, const Progress& progress, vtkPolyData* output)
{
  this->WithPart(part, progress, [&](FilledPart& one, const Progress& ofPart) {
    Stages stages(ofPart, { 30, 70 });
    const Progress reading = stages.Next();
    if (this->Crew.IsInFiles())
    {
      one.Read(this->AllHoles.ByIds, this->AllHoles.LongestEdge, reading);
      this->TakePatches(part, one);
    }
    one.Write(this->AllHoles, this->AreMarked, this->LargestId, stages.Next(), output);
  });
}

void FillParts::PassRims(const Progress& progress, vtkPolyData* output)
{
  // Own ones were kept without packing them. A point on the border of several parts comes several
  // times.
  Parts points = this->OwnRims;
  this->Crew.At(this->RimsPart, Rims).ForEach([&points](const Bytes& bytes) {
    points.push_back(UnpackData(bytes.data(), bytes.size()));
  });
  WriteRims(this->AllHoles, points, progress, output);
}

namespace
{
/** Whether a part has nothing but triangles of its own, or polygons at least. */
bool IsPlain(vtkPolyData* part)
{
  return part->GetNumberOfVerts() == 0 && part->GetNumberOfLines() == 0 &&
    part->GetNumberOfStrips() == 0 && !GhostsOf(part->GetCellData());
}
} // namespace

/*
 * What can be wrong with the parts of a user is looked for first; parts in files, which the steps
 * before have made, are as they should be. Here alone it is decided that an error means gathering:
 * with the whole surface on one rank it can be filled, or the error is that of one rank.
 */
bool FillOnRanks(const Ranks& ranks, const FillOptions& options, bool interpolate, double longest,
  Block& block, FillResult& patches)
{
  int type = VTK_VOID;
  bool hasIds = true;
  const auto isFit = [&](vtkPolyData* part) {
    CheckOptions(options, longest);
    if (part->GetNumberOfPoints() > 0)
    {
      type = part->GetPoints()->GetDataType();
      hasIds = part->GetPointData()->GetGlobalIds() != nullptr;
    }
    return IsPlain(part) && (type == VTK_VOID || type == VTK_FLOAT || type == VTK_DOUBLE);
  };
  return WorkOnParts(block, ranks, isFit, [&](const SurfaceParts& surface) {
    // Sums make the decision the same on all ranks: float and double points, and whether all have
    // ids.
    std::vector<vtkIdType> sums = { block.Input->GetNumberOfCells(), type == VTK_FLOAT,
      type == VTK_DOUBLE, !hasIds };
    ranks.Sum(sums);
    if (sums[0] == 0 || (sums[1] > 0 && sums[2] > 0))
    {
      return false;
    }
    Stages stages(block.Progress, { 82, 18 });
    FillOptions filling = options;
    filling.Monitor = stages.Next();
    FillParts fill(surface, filling, interpolate, longest, sums[3] == 0);
    // The part that gets the outlines: that of the first rank with outputs.
    constexpr int first = 0;
    try
    {
      fill.FindHoles(first);
    }
    catch (const Error& error) // on all ranks
    {
      // Gathering would take more memory still.
      if (MessageOf(error).GetCode() == sentences::NotEnoughMemory.Code)
      {
        throw;
      }
      return false;
    }
    fill.Fill();
    surface.Crew.ForEach(stages.Next(), [&](int part, const Progress& progress) {
      Stages ofPart(progress, { 83, 17 });
      fill.Pass(part, ofPart.Next(), block.Outputs[0]);
      if (part == first)
      {
        fill.PassRims(ofPart.Next(), block.Outputs[1]);
      }
    });
    patches = fill.Result();
    return true;
  });
}

} // namespace elevation
