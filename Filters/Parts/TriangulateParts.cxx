// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * The passes in their order; 2 and 3 are those of SettleParts.h. What they leave for each other
 * lies in the boxes of parts (PartStore.h), whether these are files or in memory.
 *
 *     pass        1         2, 3           4             5              6
 *     boxes    OwnPoints   Settled,    FromSeams     Requests,    Changed, Meeting (lines),
 *                          OnSeam                    Corners      Covered (limit of edges)
 */
#include "TriangulateParts.h"

#include "ConstrainParts.h"
#include "SettleParts.h"

#include <algorithm>
#include <map>
#include <utility>

namespace elevation
{

TriangulateParts::TriangulateParts(const Ranks& ranks, const std::string& folder)
  : AllRanks(ranks)
  , Folder(folder)
  , Distributor(ranks, folder)
{
}

TriangulateParts::~TriangulateParts() = default;

// Points stay with their source until the plane is cut.
void TriangulateParts::Add(vtkPointSet* points, const Progress& progress)
{
  this->Distributor.Add(points, progress);
}

void TriangulateParts::Triangulate(int ownParts, vtkPolyData* constraints,
  const DelaunayOptions& options, std::vector<Message>& warnings)
{
  this->Options = options;
  Stages stages(options.Monitor, { 10, 4, 1, 75, 0, 5, 5 });
  // Pass 1
  this->Crew = std::make_unique<Engine>(this->AllRanks, ownParts, BoxNames(), this->Folder);
  this->Store = std::make_unique<PartStore>(*this->Crew);
  std::vector<vtkIdType> counts;
  this->Plane = std::make_unique<Cuts>(
    this->Distributor.Distribute(*this->Crew, OwnPoints, stages.Next(), this->Store->Part, counts));
  this->Store->Number(std::move(counts), this->Distributor.AreIdsGiven(), stages.Next());
  // Before anything is triangulated: a part with too many points is an error that more parts would
  // cure.
  this->Store->CheckCounts();
  this->Total.Points = this->Store->Part.Bases.back();
  // Lines keep to no lattice.
  SharedLines lines;
  const Progress adding = stages.Next();
  if (constraints)
  {
    WarnOfLattice(this->Options, warnings);
    lines = AddLines(*this->Store, constraints, *this->Plane, this->Options, adding, warnings);
    this->Options.UseLattice = LatticeMode::Off;
    this->Total.Crossings = lines.NumberOfCrossings;
    this->Total.AddedPoints = this->Store->Part.Bases.back() - this->Total.Points;
    this->Store->CheckCounts();
  }
  // Passes 2 to 5
  this->SendTriangles(this->Settle(stages.Next()));
  const Progress fetching = stages.Next(), recovering = stages.Next();
  this->FetchOthers(fetching);
  // Pass 6
  // Without a triangle there is no mesh in which lines could be recovered.
  if (constraints && this->Total.Settled > 0 && RecoverLines(*this->Store, lines, recovering))
  {
    this->FetchOthers(fetching);
  }
  if (this->Options.MaximumEdgeLength > 0.0)
  {
    this->LimitEdges(stages.Next());
  }
  // The last chance of an abort: after it, all ranks have the result.
  this->AllRanks.Agree([&]() { Report(this->AllRanks.Watched(this->Options.Monitor), 1.0); });
}

/** Passes 2 and 3. @return the triangles that this rank has settled for several parts */
std::vector<GlobalTriangle> TriangulateParts::Settle(const Progress& progress)
{
  DelaunayOptions options = this->Options;
  options.Monitor = progress;
  SettledParts settled = SettleParts(*this->Store, *this->Plane, options);
  this->Total.Duplicates = settled.Duplicates;
  this->Total.NotFinite = settled.NotFinite;
  this->Total.Hidden = settled.Hidden;
  this->Total.Settled = this->Total.Triangles = settled.Triangles;
  this->Total.LatticeFound = settled.LatticeFound;
  this->Total.Steps = settled.Steps;
  this->Work.Points = static_cast<Index>(this->Store->OwnCount());
  this->Work.SeamPoints = settled.SeamPoints;
  return std::move(settled.OfSeams);
}

/**
 * A triangle that seams have settled belongs to the part of its lowest corner, which comes first in
 * it. So its part has a corner of its own in each of its triangles, and the rule needs no message.
 */
void TriangulateParts::SendTriangles(std::vector<GlobalTriangle>&& ofSeams)
{
  this->AllRanks.Agree([&]() {
    ValuesForParts<GlobalTriangle> triangles;
    for (const GlobalTriangle& triangle : ofSeams)
    {
      triangles[this->Store->Part.OwnerOf(triangle[0])].push_back(triangle);
    }
    ofSeams = std::vector<GlobalTriangle>();
    SendTo(*this->Crew, FromSeams, triangles);
  });
  this->Crew->Deliver();
}

/**
 * Corners that are points of other parts come with their values: each part asks those that own them
 * by indices, and gets rows in the order of numbers, as parts answer in their order.
 */
void TriangulateParts::FetchOthers(const Progress& progress)
{
  // Each part asks.
  this->Crew->ForEach(Progress(), [this](int part, const Progress&) {
    this->Store->ForgetOthers(part);
    ValuesForParts<vtkIdType> indices;
    for (const GlobalId number : this->Store->ListOthersOf(part))
    {
      const int owner = this->Store->Part.OwnerOf(number);
      std::vector<vtkIdType>& ofOwner = indices[owner];
      // The first value of a message is not an index, but the part that asks.
      if (ofOwner.empty())
      {
        ofOwner.push_back(part);
      }
      ofOwner.push_back(number - this->Store->Part.Bases[owner]);
    }
    SendTo(*this->Crew, Requests, indices);
  });
  this->Crew->Deliver();
  // Each is answered by rows. What has been asked stays known, for the limit of edges.
  this->Crew->ForEach(progress, [this](int part, const Progress& ofPart) {
    Report(ofPart, 0.0);
    const Inbox& requests = this->Crew->At(part, Requests);
    if (requests.IsEmpty())
    {
      return;
    }
    const PartStore::RowsForOthers rows = this->Store->ReadForOthers(part);
    requests.ForEach([&](const Bytes& bytes) {
      const char* from = bytes.data();
      vtkIdType asking = 0;
      std::vector<vtkIdType> indices;
      TakeFrom(from, &asking, 1);
      TakeFrom(from, bytes.size() / sizeof(vtkIdType) - 1, indices);
      this->Crew->Send(
        static_cast<int>(asking), Corners, this->Store->PackForOthers(rows, std::move(indices)));
    });
  });
  this->Crew->Deliver();
}

/** The indices among its own points of those that other parts have asked a part for. */
std::vector<vtkIdType> TriangulateParts::RequestedIndices(int part) const
{
  std::vector<vtkIdType> all;
  this->Crew->At(part, Requests).ForEach([&](const Bytes& bytes) {
    const char* from = bytes.data() + sizeof(vtkIdType); // beyond the part that asks
    TakeFrom(from, bytes.size() / sizeof(vtkIdType) - 1, all);
  });
  return all;
}

/**
 * Leaves out triangles with a longer edge, and counts the vertices without one. Whether a point
 * that another part has asked for is such a vertex is known when all parts have said where they
 * have triangles.
 */
void TriangulateParts::LimitEdges(const Progress& progress)
{
  std::map<int, std::vector<vtkIdType>> open; // indices without a triangle yet, of each part
  std::vector<vtkIdType> sums(2, 0);          // triangles, and vertices without one
  this->Crew->ForEach(progress, [&](int part, const Progress& ofPart) {
    Stages stages(ofPart, { 50, 50 });
    this->Store->WithWhole(part, stages.Next(), [&](const SurfacePart& whole) {
      Buffer<Index> kept;
      kept.Resize(whole.Result.Triangles.size());
      std::copy(whole.Result.Triangles.begin(), whole.Result.Triangles.end(), kept.begin());
      LeaveOutLong([&whole](Index index) { return whole.PointAt(index); },
        this->Options.MaximumEdgeLength, kept, stages.Next());
      const std::size_t ownCount = whole.OwnPoints.Count();
      // Unused points are no vertices, and so are not missing.
      std::vector<char> areMissing(ownCount + whole.Others.Count(), 1);
      for (const Index corner : kept)
      {
        areMissing[corner] = 0;
      }
      for (const Index unused : whole.Result.UnusedPoints)
      {
        areMissing[unused] = 0;
      }
      // Other parts' points with a triangle here
      ValuesForParts<vtkIdType> covered;
      for (std::size_t i = 0; i < whole.OtherNumbers.size(); ++i)
      {
        if (!areMissing[ownCount + i])
        {
          const int owner = whole.OwnerOf(whole.OtherNumbers[i]);
          covered[owner].push_back(whole.OtherNumbers[i] - whole.Bases[owner]);
        }
      }
      SendTo(*this->Crew, Covered, covered);
      for (const vtkIdType index : this->RequestedIndices(part))
      {
        // An own point that may still have one elsewhere
        if (std::exchange(areMissing[index], 0))
        {
          open[part].push_back(index);
        }
      }
      sums[0] += static_cast<vtkIdType>(kept.size() / 3);
      sums[1] += std::count(areMissing.begin(), areMissing.begin() + ownCount, char(1));
    });
  });
  this->Crew->Deliver();
  this->Crew->ForEach(Progress(), [&](int part, const Progress&) {
    std::vector<vtkIdType> covered = ValuesIn<vtkIdType>(this->Crew->At(part, Covered));
    this->Crew->At(part, Covered).Clear();
    std::sort(covered.begin(), covered.end());
    // Asked for, but nowhere a corner of a triangle within the limit.
    sums[1] += std::count_if(open[part].begin(), open[part].end(),
      [&](vtkIdType index) { return !std::binary_search(covered.begin(), covered.end(), index); });
  });
  this->AllRanks.Sum(sums);
  LimitEffect& effect = this->Total.Effect;
  this->Total.Triangles = sums[0];
  effect.Vertices = this->Store->Part.Bases.back() - this->Total.Duplicates -
    this->Total.NotFinite - this->Total.Hidden;
  effect.Missing = sums[1];
  // The box is empty again. In files, the lengths of all edges would not fit into memory.
  if (!this->Crew->IsInFiles() && effect.AreMostMissing())
  {
    MeasureAll(*this->Crew, Covered, progress, this->Store->Part, effect);
  }
}

void TriangulateParts::WarnOfMissing(std::vector<Message>& warnings) const
{
  if (this->Total.Settled == 0)
  {
    WarnOfNoTriangle(this->Total.Points, this->Total.Hidden, warnings);
  }
  else if (this->Total.Effect.AreMostMissing())
  {
    warnings.push_back(AdviceOnLimit(this->Options.MaximumEdgeLength, this->Total.Effect));
  }
}

// The limit of edges is applied again, which is faster than writing what it leaves. Corners of
// others that only long triangles had go with these (KeepCorners).
SurfacePart TriangulateParts::Take(int part, const Progress& progress)
{
  Stages stages(progress, { 70, 30 });
  SurfacePart taken = this->Store->TakeWhole(part, stages.Next());
  if (this->Options.MaximumEdgeLength > 0.0)
  {
    LeaveOutLong([&taken](Index index) { return taken.PointAt(index); },
      this->Options.MaximumEdgeLength, taken.Result.Triangles, stages.Next());
    taken.OwnCorners = 0;
  }
  KeepCorners(taken);
  taken.Result.LatticeFound = this->Total.LatticeFound;
  taken.Result.Steps = this->Total.Steps;
  return taken;
}

void AddWork(
  const Ranks::Traffic& traffic, const TriangulateParts::Effort& effort, vtkFieldData* fieldData)
{
  AddTuple(fieldData, "WorkOfRank",
    { { "OwnPoints", effort.Points }, { "SeamPoints", effort.SeamPoints },
      { "BytesSent", traffic.BytesSent }, { "Exchanges", traffic.Rounds } });
}

} // namespace elevation
