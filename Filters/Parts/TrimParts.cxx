// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * The passes in their order. Pass 1 is tried with a small margin around the borders of parts, and
 * for an outline, if that does not decide it, again with a large one; each time with pass 2. A part
 * is known between passes as TrimmedPart, in memory; in files it is made and swept again when it is
 * written, so nothing of it is kept meanwhile but what has come back.
 */
#include "TrimParts.h"

#include "BoundaryZone.h"
#include "PackedData.h"

#include "vtkPointData.h"

#include <algorithm>
#include <utility>

namespace elevation
{

namespace
{
/** The boxes of a part. */
enum BoxOfTrim
{
  NearTriangles, // of all parts, at the part with most; it takes them at once
  Back           // a part's own triangles, trimmed
};
} // namespace

TrimParts::TrimParts(const SurfaceParts& surface, vtkIdType triangles, vtkPolyData* boundary,
  const TrimOptions& options)
  : Surface(surface)
  , Crew(surface.Crew.AllRanks(), surface.Crew.EndOwn() - surface.Crew.FirstOwn(),
      { "", "trimmed" }, surface.Crew.Folder())
  , BoundaryData(boundary)
  , Options(options)
  // Where pass 1 ends: in files it makes each part, too, and takes most of the time.
  , NumberOfAll(triangles)
{
}

// Parts in memory can be gathered, those in files cannot. Steps throw on all ranks or on none.
bool TrimParts::Trim()
{
  try
  {
    this->TrimAll();
    return true;
  }
  catch (const Error& error)
  {
    // Gathering takes more memory than this did.
    const bool isMemory = MessageOf(error).GetCode() == sentences::NotEnoughMemory.Code;
    if (this->Crew.IsInFiles() || isMemory)
    {
      throw;
    }
    return false;
  }
}

// All of it but the last pass. What it throws, it throws on all ranks.
void TrimParts::TrimAll()
{
  CheckOptions(this->Options);
  if (this->Options.Test != OutwardTest::Exact)
  {
    throw MakeError<sentences::InwardNormalNotInPieces>();
  }
  const double ofSweep = this->Crew.IsInFiles() ? 78.0 : 38.0;
  Stages stages(this->Options.Monitor, { 2, ofSweep, 95.0 - ofSweep, 3 });
  this->Read(stages.Next());
  const Progress finding = stages.Next(), trimming = stages.Next();
  const auto isTrimmedWith = [&](int margin) {
    this->FindNear(margin, finding);
    return this->TrimNear(trimming);
  };
  // A boundary needs no margin, and most outlines a small one.
  // In edges. The 6th nearest vertex is seldom more than four edges away, and at the end of a line
  // of points up to seven (FindOutlinePart).
  constexpr int small = 4, large = 10;
  if (!isTrimmedWith(small) && (this->BoundaryData || !isTrimmedWith(large)))
  {
    throw this->Refusal();
  }
  this->AddUp(stages.Next());
}

CodedError TrimParts::Refusal() const
{
  return this->BoundaryData ? MakeError<sentences::BoundaryNotInPieces>()
                            : MakeError<sentences::OutlineNotInPieces>();
}

/**
 * The part, whose triangles are read. In memory the step finds it as it was left by the last one. A
 * part without points is left out.
 */
template <typename Step>
void TrimParts::WithPart(int part, const Progress& progress, const Step& step)
{
  std::unique_ptr<TrimmedPart> anew;
  std::unique_ptr<TrimmedPart>& found = this->Crew.IsInFiles() ? anew : this->InMemory;
  if (!found)
  {
    vtkSmartPointer<vtkPolyData> made = this->Surface.Make(part, progress);
    if (!made)
    {
      return;
    }
    found = std::make_unique<TrimmedPart>(std::move(made));
    found->Read();
  }
  step(*found);
}

void TrimParts::Sweep(TrimmedPart& part, const Progress& progress)
{
  // Once on each rank: rings do not depend on the part.
  if (this->BoundaryData && this->Joined.Count() == 0)
  {
    this->Joined = JoinLines(this->Lines);
  }
  const bool isSwept = this->BoundaryData
    ? part.Sweep(this->Lines.Points.Places, this->Joined, static_cast<double>(this->NumberOfAll),
        this->Options.NumberOfThreads, progress)
    : part.SweepForOutline(this->Margin, this->Options, progress);
  if (!isSwept)
  {
    throw this->Refusal();
  }
}

/** The boundary, and how many triangles there are. */
void TrimParts::Read(const Progress& progress)
{
  const bool isInFiles = this->Crew.IsInFiles();
  this->Crew.ForEach(progress, [&](int part, const Progress& ofPart) {
    Report(ofPart, 0.0);
    // The same on all ranks; so is its error.
    if (this->BoundaryData && part == this->Crew.FirstOwn())
    {
      CheckArrays(this->BoundaryData, "The boundary's");
      this->Lines = ToBoundaryLines(this->BoundaryData, ofPart, "boundary", NeedsZ(this->Options));
    }
    if (!isInFiles)
    {
      this->WithPart(
        part, ofPart, [this](TrimmedPart& own) { this->Triangles = own.TriangleCount(); });
    }
  });
  if (!isInFiles)
  {
    std::vector<vtkIdType> count = { this->Triangles };
    this->Crew.AllRanks().Sum(count);
    this->NumberOfAll = count[0];
  }
  if (this->NumberOfAll == 0)
  {
    throw MakeError<sentences::NothingToTrim>();
  }
}

/**
 * Pass 1, with a margin of an outline. The near triangles wait here until all ranks know which part
 * has most of them.
 */
void TrimParts::FindNear(int margin, const Progress& progress)
{
  this->Margin = margin;
  this->RankCounts = TrimCounts();
  this->Near = 0;
  this->NearParts.clear();
  std::vector<vtkIdType> near, sums(2, 0);
  Box extent;
  this->Crew.ForEach(progress, [&](int part, const Progress& ofPart) {
    Stages stages(ofPart, { 50, 50 });
    // Until the part has been found to have points: SendBack() skips those without.
    near.push_back(-1);
    this->NearParts.emplace_back();
    this->WithPart(part, stages.Next(), [&](TrimmedPart& own) {
      this->Sweep(own, stages.Next());
      // The 1 prefers a part with triangles as the home, even if none is near.
      near.back() = own.NearCount() + (own.TriangleCount() > 0 ? 1 : 0);
      // Packed at once, as the part in files goes; near triangles and borders of all own parts are
      // kept.
      this->NearParts.back() = PackData(own.NearPart());
      this->Near += own.NearCount();
      this->RankCounts.OutwardTriangles += own.SideCount(1);
      sums[0] += own.SideCount(0);
      // The box is for the error that nothing is kept; as soon as something is, it is not needed.
      if (sums[0] == 0)
      {
        extent.Join(own.Extent());
      }
      sums[1] += static_cast<vtkIdType>(own.InnerPointCount());
    });
  });
  this->NearCounts = this->Crew.AllRanks().Collect(near);
  this->Home = static_cast<int>(
    // Of equal counts the first: the same part on all ranks.
    std::max_element(this->NearCounts.begin(), this->NearCounts.end()) - this->NearCounts.begin());
  this->Crew.AllRanks().Sum(sums);
  this->Kept = sums[0];
  this->Extent = JoinBoxes(this->Crew.AllRanks(), extent);
  this->InnerPoints = sums[1];
}

/** Pass 2. @return false on all ranks if the near triangles do not decide what to keep */
bool TrimParts::TrimNear(const Progress& progress)
{
  Stages stages(progress, { 0, 95, 5, 0 });
  const Ranks& all = this->Crew.AllRanks();
  for (Bytes& bytes : this->NearParts)
  {
    this->Crew.Send(this->Home, NearTriangles, std::move(bytes));
  }
  this->Crew.Deliver(stages.Next());
  const Progress trimming = stages.Next(), sending = stages.Next();
  bool isTrimmed = false;
  // Other ranks wait at the end of the step, or stop with it.
  all.Agree([&]() {
    if (!this->Crew.IsOwn(this->Home))
    {
      return;
    }
    elevation::Parts parts;
    for (Bytes& bytes : this->Crew.At(this->Home, NearTriangles).Take())
    {
      parts.push_back(UnpackData(bytes.data(), bytes.size()));
      bytes = Bytes();
    }
    TrimOptions options = this->Options;
    options.Monitor = all.Watched(trimming);
    BoundaryZone zone(std::move(parts));
    isTrimmed = this->BoundaryData
      ? zone.Trim(this->Lines, options)
      : zone.TrimOutline(this->InnerPoints, this->NumberOfAll, options);
    if (isTrimmed)
    {
      this->SendBack(zone, all.Watched(sending));
    }
  });
  this->Crew.Deliver(stages.Next());
  return IsOnAny(all, isTrimmed);
}

// Pass 3, the half of the rank that has trimmed. The other half is Write(), at the part's own time.
void TrimParts::SendBack(const BoundaryZone& zone, const Progress& progress)
{
  const Trimmed& result = zone.Result();
  if (this->BoundaryData && this->Kept == 0 && result.Kept.Parents.empty())
  {
    throw CodedError(NothingEnclosed(this->Extent, this->Lines.Points, JoinLines(this->Lines)));
  }
  std::vector<TrimmedZone> backs = zone.Split(progress);
  // Parts without points have sent none, and get none.
  auto back = backs.begin();
  for (int part = 0; part < this->Crew.PartCount(); ++part)
  {
    if (this->NearCounts[part] >= 0)
    {
      const TrimmedZone taken = std::move(*back++);
      this->Crew.Send(part, Back, Packed(taken));
    }
  }
  this->RankCounts.RecoveredEdges = result.NumberOfRecoveredEdges;
  this->RankCounts.PointsLeftOut = result.NumberOfPointsLeftOut;
  this->RankCounts.GapTolerance = result.GapTolerance;
  // Warning, boundary and counts of edges are on this rank alone.
  this->CommonWarning = result.Warning;
  this->Outline->GetPointData()->CopyAllOn();
  PassRings(result.Boundary, this->BoundaryData ? this->BoundaryData : zone.Joined(), progress,
    this->Outline);
}

/** What there is of all parts. */
void TrimParts::AddUp(const Progress& progress)
{
  const Ranks& all = this->Crew.AllRanks();
  vtkIdType kept = 0, marked = 0;
  this->Crew.ForEach(progress, [&](int part, const Progress& ofPart) {
    Report(ofPart, 0.0);
    this->Crew.At(part, Back).ForEach([&](const Bytes& bytes) {
      // Unpacked for its counts alone; Write() takes it.
      const TrimmedZone back = Unpacked<TrimmedZone>(bytes);
      const vtkIdType owned = std::count(back.IsOwned.begin(), back.IsOwned.end(), char(1));
      kept += static_cast<vtkIdType>(back.Parents[0].size());
      // Points of others among those it had, and new ones that it does not own.
      marked += static_cast<vtkIdType>(back.OfOthers.size() + back.IsOwned.size()) - owned;
      this->RankCounts.OutwardTriangles += static_cast<vtkIdType>(back.Parents[1].size());
      this->RankCounts.InsertedPoints += owned;
    });
  });
  std::vector<vtkIdType> sums = { this->RankCounts.OutwardTriangles,
    this->RankCounts.RecoveredEdges, this->RankCounts.PointsLeftOut,
    this->RankCounts.InsertedPoints, kept, marked, this->Outline->GetNumberOfLines() };
  // The rank that has trimmed knows it; on the others it is 0.
  std::vector<double> tolerance = { this->RankCounts.GapTolerance };
  all.Sum(sums);
  all.Maximum(tolerance);
  this->RankCounts.GapTolerance = this->TotalCounts.GapTolerance = tolerance[0];
  this->TotalCounts.OutwardTriangles = sums[0];
  this->TotalCounts.RecoveredEdges = sums[1];
  this->TotalCounts.PointsLeftOut = sums[2];
  this->TotalCounts.InsertedPoints = sums[3];
  this->Kept += sums[4];
  this->AreMarked = sums[5] > 0;
  this->Rings = sums[6];
}

void TrimParts::Write(int part, const Progress& progress, vtkPolyData* kept, vtkPolyData* outward)
{
  Stages stages(progress, { 30, 20, 10, 40 });
  this->WithPart(part, stages.Next(), [&](TrimmedPart& own) {
    const Progress sweeping = stages.Next(), taking = stages.Next();
    if (this->Crew.IsInFiles())
    {
      this->Sweep(own, sweeping);
      own.ListNearPoints();
    }
    this->Crew.At(part, Back).ForEach([&](const Bytes& bytes) {
      own.Take(Unpacked<TrimmedZone>(bytes), taking);
    });
    own.Write(this->TotalCounts.InsertedPoints > 0, this->AreMarked,
      this->BoundaryData ? &this->Lines : nullptr, this->Options, stages.Next(), kept, outward);
  });
}

} // namespace elevation
