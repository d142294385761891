// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * The life of a part: Read() and Sweep() find what is near; NearPart() is what travels; Take() gets
 * what has become of it; Write() puts the sides together. Triangles of a side come in the order of
 * the input, near ones, which may be cut, after all others.
 */
#include "TrimmedPart.h"

#include "Kernel/Mesh/Mesh.h"
#include "PointKeys.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace elevation
{

namespace
{
constexpr char IsNear = 2; // neither kept nor outward until it comes back
}

void TrimmedPart::Read()
{
  CheckArrays(this->Input);
  this->Triangles = ViewTriangles(this->Input);
  this->LeaveOutCopies();
}

/**
 * Leaves out triangles that are marked as another part's. Then the list is a copy, and Sources has
 * the number of each triangle in the input, for its cell data.
 */
void TrimmedPart::LeaveOutCopies()
{
  this->List = this->Triangles.View;
  vtkUnsignedCharArray* const marks = GhostsOf(this->Input->GetCellData());
  const vtkIdType first = FirstPolygon(this->Input);
  for (Index t = 0; marks && t < this->List.Count; ++t)
  {
    if (!IsCopy(marks, first + t))
    {
      this->Sources.push_back(t);
    }
  }
  if (!marks || this->Sources.size() == static_cast<std::size_t>(this->List.Count))
  {
    this->Sources.clear();
    return;
  }
  Buffer<Index> corners;
  // The copy is made of the list, and only then takes its place: the list may view what it
  // replaces.
  corners.Reserve(3 * this->Sources.size());
  for (const Index t : this->Sources)
  {
    std::for_each(this->List.CornersOf(t), this->List.CornersOf(t + 1),
      [&corners](Index corner) { corners.Append(corner); });
  }
  this->Triangles.Converted = std::move(corners);
  this->List.Corners = this->Triangles.Converted.data();
  this->List.Count = static_cast<Index>(this->Sources.size());
}

// The sweep's flags have no meaning for near triangles; they get the mark that says so.
bool TrimmedPart::Sweep(const std::vector<Point2>& points, const Rings& rings, double numberOfAll,
  int threads, const Progress& progress)
{
  std::optional<SweptAlongRings> swept =
    SweepAlongRings(this->List, points, rings, numberOfAll, threads, progress);
  if (swept)
  {
    this->Swept = std::move(*swept);
    for (const Index t : this->Swept.Near)
    {
      this->Swept.IsOutward[t] = IsNear;
    }
  }
  return swept.has_value();
}

bool TrimmedPart::SweepForOutline(int margin, const TrimOptions& options, const Progress& progress)
{
  ExtractOptions extraction;
  extraction.GapTolerance = options.GapTolerance;
  extraction.Grid = options.Grid;
  extraction.NumberOfThreads = options.NumberOfThreads;
  extraction.Monitor = progress;
  const bool isProven = FindOutlinePart(this->List, margin, extraction, this->Outline);
  // From here on both kinds of boundary are alike. States and spacings stay in Outline, to be sent.
  this->Swept.Near = std::move(this->Outline.Triangles);
  this->Swept.Border = std::move(this->Outline.Border);
  this->Swept.IsOutward.assign(static_cast<std::size_t>(this->List.Count), 0);
  for (const Index t : this->Swept.Near)
  {
    this->Swept.IsOutward[t] = IsNear;
  }
  return isProven;
}

IdSet TrimmedPart::ListNearPoints()
{
  IdSet used(static_cast<Index>(this->Input->GetNumberOfPoints()));
  for (const Index t : this->Swept.Near)
  {
    used.AddAll(this->List.CornersOf(t));
  }
  for (const BorderEdge& edge : this->Swept.Border)
  {
    used.Add(edge.Origin);
    used.Add(edge.Destination);
  }
  // The zone looks for the largest id, which those of inserted points follow, among what it gets.
  const vtkIdType largest = IndexOfLargest(this->Input->GetPointData()->GetGlobalIds());
  if (largest >= 0)
  {
    used.Add(static_cast<Index>(largest));
  }
  // Increasing, so duplicates keep their order.
  this->NearPoints = used.ListAndRank();
  return used;
}

/** Of the near triangles and the border; its points are NearPoints. */
vtkSmartPointer<vtkPolyData> TrimmedPart::NearPart()
{
  const IdSet used = this->ListNearPoints();
  const vtkSmartPointer<vtkPolyData> part = ChosenPoints(this->Input, this->NearPoints);
  vtkNew<vtkCellArray> border, near;
  for (const BorderEdge& edge : this->Swept.Border)
  {
    const vtkIdType ends[] = { used.RankOf(edge.Origin), used.RankOf(edge.Destination) };
    border->InsertNextCell(2, ends);
  }
  for (const Index t : this->Swept.Near)
  {
    const Index* const c = this->List.CornersOf(t);
    const vtkIdType corners[] = { used.RankOf(c[0]), used.RankOf(c[1]), used.RankOf(c[2]) };
    near->InsertNextCell(3, corners);
  }
  part->SetLines(border);
  part->SetPolys(near);
  // Of an outline; States are one for each near triangle already.
  if (!this->Outline.Spacings.empty())
  {
    std::vector<double> spacings;
    for (const Index point : this->NearPoints)
    {
      spacings.push_back(this->Outline.Spacings[point]);
    }
    BoundaryZone::AddKnown(this->Outline.States, spacings, part);
  }
  return part;
}

void TrimmedPart::Take(TrimmedZone&& back, const Progress& progress)
{
  this->Back = std::move(back);
  this->FindOwn(progress);
}

// By the flags: after a sweep, without what comes back.
vtkIdType TrimmedPart::SideCount(int side) const
{
  const std::vector<char>& flags = this->Swept.IsOutward;
  return static_cast<vtkIdType>(std::count(flags.begin(), flags.end(), static_cast<char>(side)));
}

/**
 * Finds which of the new points this part has, if not in its near part, and adds the others; and
 * which of the far points on the boundary.
 */
void TrimmedPart::FindOwn(const Progress& progress)
{
  const std::size_t count = this->Back.IsInserted.size();
  for (const Index point : this->Back.OfOthers)
  {
    this->Points.OfOthers.push_back(this->NearPoints[point]);
  }
  this->Points.New = this->Back.NewPoints;
  this->Points.AreNumbered = this->Back.AreNumbered;
  this->Indices.assign(count, None);
  // All parts have ids or none has: their arrays are the same.
  const bool byIds = this->Input->GetPointData()->GetGlobalIds() != nullptr;
  // Points that this part did not send, and that are no new ones. It may have them all the same,
  // away from its near triangles: then it gets no second copy.
  std::map<PointKey, std::size_t> ofOthers;
  for (std::size_t i = 0; i < count; ++i)
  {
    if (!this->Back.IsInserted[i])
    {
      ofOthers.emplace(PointKeys(this->Back.NewPoints, byIds).Of(static_cast<vtkIdType>(i)), i);
    }
  }
  std::set<PointKey> far(this->Back.FarOnBoundary.begin(), this->Back.FarOnBoundary.end());
  const vtkIdType own = this->Input->GetNumberOfPoints();
  const PointKeys ofOwn(this->Input, byIds);
  // A look at all points, if any is asked for; it ends with the last one found.
  for (vtkIdType i = 0; i < own && !(ofOthers.empty() && far.empty()); ++i)
  {
    ReportStep(progress, static_cast<std::size_t>(i), static_cast<std::size_t>(own));
    const PointKey key = ofOwn.Of(i);
    const auto found = ofOthers.find(key);
    if (found != ofOthers.end())
    {
      this->Indices[found->second] = static_cast<Index>(i);
      ofOthers.erase(found);
    }
    if (far.erase(key) > 0)
    {
      this->FarOnBoundary.push_back(static_cast<Index>(i));
    }
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    // What it does not have, inserted or another part's, comes after its own points.
    if (this->Indices[i] == None)
    {
      this->Indices[i] = static_cast<Index>(own) + static_cast<Index>(this->Points.Added.size());
      this->Points.Added.push_back(static_cast<vtkIdType>(i));
      if (!this->Back.IsOwned[i])
      {
        this->Points.OfOthers.push_back(this->Indices[i]);
      }
    }
  }
}

TrimmedSide TrimmedPart::SideOf(int side, const Progress& progress) const
{
  TrimmedSide written;
  // Corners by points of the output; parents by triangles of the input, copies of others included.
  const auto add = [this, &written](const auto& cornerOf, Index triangle) {
    for (int k = 0; k < 3; ++k)
    {
      written.Corners.Append(cornerOf(k));
    }
    written.Parents.Append(this->Sources.empty() ? triangle : this->Sources[triangle]);
  };
  for (Index t = 0; t < this->List.Count; ++t)
  {
    ReportStep(progress, t, this->List.Count);
    if (this->Swept.IsOutward[t] == side)
    {
      add([&](int k) { return this->List.CornersOf(t)[k]; }, t);
    }
  }
  // What has come back: pieces of near triangles, or, from an outline, these as they were.
  const std::vector<Index>& parents = this->Back.Parents[side];
  const Index sent = static_cast<Index>(this->NearPoints.size());
  for (std::size_t i = 0; i < parents.size(); ++i)
  {
    const Index triangle = this->Swept.Near[parents[i]];
    // An outline cuts no triangle, so none but their numbers came back.
    if (this->Back.Corners[side].empty())
    {
      add([&](int k) { return this->List.CornersOf(triangle)[k]; }, triangle);
      continue;
    }
    const Index* const corners = this->Back.Corners[side].data() + 3 * i;
    add(
      [&](int k) {
        return corners[k] < sent ? this->NearPoints[corners[k]] : this->Indices[corners[k] - sent];
      },
      triangle);
  }
  return written;
}

void TrimmedPart::Write(bool areInserted, bool areMarked, const BoundaryLines* boundary,
  const TrimOptions& options, const Progress& progress, vtkPolyData* kept, vtkPolyData* outward)
{
  Stages stages(progress, { 20, 40, 40 });
  this->Points.AreMarked = areMarked;
  PassTrimmedPoints(this->Input, this->Points, stages.Next(), kept);
  // The owner's points that only ghosts elsewhere have shown to be on the boundary, then all
  // others.
  std::vector<Index> onBoundary = this->FarOnBoundary;
  if (boundary)
  {
    const Index sent = static_cast<Index>(this->NearPoints.size());
    for (const Index point : this->Back.OnBoundary)
    {
      onBoundary.push_back(point < sent ? this->NearPoints[point] : this->Indices[point - sent]);
    }
    PassMarks(onBoundary, kept);
  }
  // As on one rank, other cells go to the kept side alone.
  kept->SetVerts(this->Input->GetVerts());
  kept->SetLines(this->Input->GetLines());
  if (outward)
  {
    outward->SetPoints(kept->GetPoints());
    outward->GetPointData()->PassData(kept->GetPointData());
  }
  // Vertices and lines come first in the numbers of cells, but on the kept side alone.
  for (const int side : { 0, 1 })
  {
    if (vtkPolyData* const output = side == 0 ? kept : outward)
    {
      Stages ofSide(stages.Next(), { 50, 50 });
      TrimmedSide written = this->SideOf(side, ofSide.Next());
      PassCellData(this->Input, side == 0 ? FirstPolygon(this->Input) : 0, written, areInserted,
        ofSide.Next(), output);
      output->SetPolys(
        ToCellArray(std::move(written.Corners), ResolveNumberOfThreads(options.NumberOfThreads)));
      output->GetFieldData()->PassData(this->Input->GetFieldData());
    }
  }
  if (boundary && NeedsZ(options))
  {
    PassElevations(*boundary, onBoundary, kept, outward);
  }
}

} // namespace elevation
