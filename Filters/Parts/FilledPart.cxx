// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Read() looks at the part for pass 1. FindCorners() and Write() are pass 6: the patches come by
 * the points that surround their holes, on whatever rank that was, and their corners are found
 * among the part's own points by their keys. Corners that are not among these are appended as
 * ghosts.
 */
#include "FilledPart.h"

#include "Adapt/Adapt.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVariant.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace elevation
{

// Ghost cells and other cells than triangles have been refused, or are none in files.
void FilledPart::Read(bool byIds, double longest, const Progress& progress)
{
  Stages stages(progress, { 40, 50, 10 });
  ToMesh(this->Input, this->OwnMesh, stages.Next());
  this->OwnMesh.ConnectTwins(0, stages.Next());
  if (longest > 0.0)
  {
    this->RegionOf = NumberRegions(this->OwnMesh, longest, stages.Next());
  }
  this->ListShared(byIds);
}

/** Whether a half-edge is on the border of the triangles, or of long ones, which it belongs to. */
bool FilledPart::IsRim(Index h) const
{
  const Index twin = this->OwnMesh.Twin(h);
  return twin == Mesh::Border ||
    (!this->RegionOf.empty() && this->IsRegionAt(h) && !this->IsRegionAt(twin));
}

void FilledPart::ListShared(bool byIds)
{
  std::vector<char> mayBeShared(static_cast<std::size_t>(this->Input->GetNumberOfPoints()), 1);
  this->AreUsed.assign(mayBeShared.size(), 0);
  for (const Index corner : this->OwnMesh.Triangles)
  {
    // A point with a triangle is shared only if it is on the border, or a corner of a long
    // triangle: inside a part, no other part has triangles with it. A point without a triangle may
    // be a copy of any.
    mayBeShared[corner] = 0;
    this->AreUsed[corner] = 1;
  }
  for (Index h = 0; h < static_cast<Index>(this->OwnMesh.Twins.size()); ++h)
  {
    // A patch may have any corner of the triangles that it replaces.
    if (this->OwnMesh.Twin(h) == Mesh::Border || (!this->RegionOf.empty() && this->IsRegionAt(h)))
    {
      mayBeShared[this->OwnMesh.Origin(h)] = mayBeShared[this->OwnMesh.Destination(h)] = 1;
    }
  }
  vtkUnsignedCharArray* const marks = BoundaryMarksOf(this->Input->GetPointData());
  for (std::size_t i = 0; i < mayBeShared.size(); ++i)
  {
    if (mayBeShared[i])
    {
      this->Shared.Indices.push_back(static_cast<Index>(i));
      this->Shared.OnBoundary.push_back(marks && marks->GetValue(static_cast<vtkIdType>(i)) != 0);
    }
  }
  // In this order: TakeMarks() and Sort() need indices and keys.
  this->Shared.Keys = KeysOf(this->Input, byIds, &this->Shared.Indices);
  this->Shared.TakeMarks(this->Input);
  this->Shared.Sort(this->AreUsed);
}

/** One flag a point: 1 if it is another part's. */
std::vector<char> FilledPart::AreOthers() const
{
  std::vector<char> areOthers(static_cast<std::size_t>(this->Input->GetNumberOfPoints()), 0);
  vtkUnsignedCharArray* const marks = GhostsOf(this->Input->GetPointData());
  for (std::size_t i = 0; i < areOthers.size(); ++i)
  {
    areOthers[i] = IsCopy(marks, static_cast<vtkIdType>(i));
  }
  for (std::size_t i = 0; i < this->Shared.Indices.size(); ++i)
  {
    // For points that may be shared, what ranks have found out together replaces the mark.
    areOthers[this->Shared.Indices[i]] = this->Shared.AreCopies[i];
  }
  return areOthers;
}

/*
 * All points, used by a triangle or not: the lattice is that of all, and the limit of new points
 * too.
 */
vtkIdType FilledPart::OwnCount() const
{
  const std::vector<char> areOthers = this->AreOthers();
  return std::count(areOthers.begin(), areOthers.end(), char(0));
}

PointView FilledPart::OwnPoints(Buffer<double>& kept) const
{
  const DataSetPoints points = ViewPoints(this->Input);
  const std::vector<char> areOthers = this->AreOthers();
  for (Index i = 0; i < points.View.Count; ++i)
  {
    const Point2 p = points.View.At(i);
    for (const double value : { p.X, p.Y, points.View.Elevation(i) })
    {
      if (!areOthers[i])
      {
        kept.Append(value);
      }
    }
  }
  PointView some;
  // In double whatever the input has: rows are put together from those that count.
  some.Double = kept.data();
  some.Count = static_cast<Index>(kept.size() / 3);
  return some;
}

// Of all corners of patches, and of the points nearest to new ones, whose values these get.
void FilledPart::FindCorners()
{
  const Index first = static_cast<Index>(this->Filled.Keys.size());
  const Index own = static_cast<Index>(this->Input->GetNumberOfPoints());
  this->IndexOf.assign(this->Filled.Keys.size(), None);
  this->Added.clear();
  std::map<PointKey, Index> added; // a point may be there several times
  // Beyond the first new point, a corner is one that the patch itself has made.
  const auto setIndex = [&](Index corner) {
    if (corner < first && this->IndexOf[corner] == None)
    {
      const PointKey& key = this->Filled.Keys[corner];
      const Index here = this->Shared.Find(key);
      const Index next = own + static_cast<Index>(this->Added.size());
      const bool isNew = here == None && added.emplace(key, next).second;
      this->IndexOf[corner] = here != None ? here : added[key];
      if (isNew)
      {
        this->Added.push_back(corner);
      }
    }
  };
  const FillResult& patches = this->Filled.Patches;
  std::for_each(patches.Triangles.begin(), patches.Triangles.end(), setIndex);
  std::for_each(
    patches.NearestBoundaryPoints.begin(), patches.NearestBoundaryPoints.end(), setIndex);
}

vtkIdType FilledPart::OtherCount() const
{
  const std::vector<char>& copies = this->Shared.AreCopies;
  return static_cast<vtkIdType>(this->Added.size()) + std::count(copies.begin(), copies.end(), 1);
}

/** The input and the corners of others; of points that parts have in common, one is not a ghost. */
vtkSmartPointer<vtkPolyData> FilledPart::WithCorners(bool areMarked, const Progress& progress) const
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  TrimmedPoints points;
  points.New = this->Filled.Surrounding;
  points.Added.assign(this->Added.begin(), this->Added.end());
  points.AreMarked = areMarked;
  const Index own = static_cast<Index>(this->Input->GetNumberOfPoints());
  for (std::size_t i = 0; i < this->Shared.AreCopies.size(); ++i)
  {
    if (this->Shared.AreCopies[i])
    {
      points.OfOthers.push_back(this->Shared.Indices[i]);
    }
  }
  // Each is another part's, and a ghost here.
  for (std::size_t i = 0; i < this->Added.size(); ++i)
  {
    points.OfOthers.push_back(own + static_cast<Index>(i));
  }
  PassTrimmedPoints(this->Input, points, progress, data);
  data->SetPolys(this->Input->GetPolys());
  data->GetCellData()->PassData(this->Input->GetCellData());
  data->GetFieldData()->PassData(this->Input->GetFieldData());
  return data;
}

/**
 * The patches among those of all holes, by the indices of the input's points. MakeSurface() then
 * does for a part what it does for a surface: holes of other parts just have no points and
 * triangles here.
 */
FillResult FilledPart::PlacedPatches(const SharedHoles& all, vtkPolyData* input) const
{
  const FillResult& from = this->Filled.Patches;
  FillResult to;
  to.Points = from.Points;
  to.StandardErrors = from.StandardErrors;
  to.HalfIntervals = from.HalfIntervals;
  const Index first = static_cast<Index>(this->IndexOf.size());
  const Index firstNew = static_cast<Index>(input->GetNumberOfPoints());
  const auto placed = [&](Index id) {
    return id < first ? this->IndexOf[id] : firstNew + id - first;
  };
  std::transform(
    from.Triangles.begin(), from.Triangles.end(), std::back_inserter(to.Triangles), placed);
  std::transform(from.NearestBoundaryPoints.begin(), from.NearestBoundaryPoints.end(),
    std::back_inserter(to.NearestBoundaryPoints), placed);
  // Offsets for each of all holes; where a hole is not one of this part, they do not rise.
  std::size_t next = 0;
  for (Index hole = 0; hole < static_cast<Index>(all.Result.Reports.size()); ++hole)
  {
    const bool isMine = next < this->Filled.Numbers.size() && this->Filled.Numbers[next] == hole;
    next += isMine ? 1 : 0;
    to.PointOffsets.push_back(isMine ? from.PointOffsets[next] : to.PointOffsets.back());
    to.TriangleOffsets.push_back(isMine ? from.TriangleOffsets[next] : to.TriangleOffsets.back());
  }
  to.Reports = all.Result.Reports;
  to.FirstNumber = all.Result.FirstNumber;
  for (const Index region : this->RegionOf)
  {
    to.Found.RegionOf.push_back(region == None ? None : all.NumberOf(this->Number, region));
  }
  this->PlaceAttributes(input, to);
  return to;
}

/**
 * Attributes in the order of the input's arrays. The surrounding was joined from parts of several
 * ranks, whose arrays may be in another order; so they are found by their names.
 */
void FilledPart::PlaceAttributes(vtkPolyData* input, FillResult& placed) const
{
  vtkPointData* const given =
    this->Filled.Surrounding ? this->Filled.Surrounding->GetPointData() : nullptr;
  const bool areInterpolated = !this->Filled.Patches.Attributes.empty();
  std::map<std::string, std::size_t> firstOf;
  std::size_t count = 0;
  for (int i = 0; given && i < given->GetNumberOfArrays() && areInterpolated; ++i)
  {
    vtkAbstractArray* const array = given->GetAbstractArray(i);
    firstOf[array->GetName()] = count;
    count += IsInterpolated(given, array) ? array->GetNumberOfComponents() : 0;
  }
  vtkPointData* const data = input->GetPointData();
  for (int i = 0; i < data->GetNumberOfArrays() && count > 0; ++i)
  {
    vtkAbstractArray* const array = data->GetAbstractArray(i);
    for (int c = 0; IsInterpolated(data, array) && c < array->GetNumberOfComponents(); ++c)
    {
      placed.Attributes.push_back(
        this->Filled.Patches.Attributes[firstOf.at(array->GetName()) + c]);
    }
  }
}

/**
 * Global ids after the largest of all parts, in the order of the holes. Where their type has no
 * such numbers they are -1, and the array is no longer one of global ids, on all parts alike.
 */
void FilledPart::NumberNewPoints(
  const SharedHoles& all, vtkIdType largest, vtkPointData* output) const
{
  vtkDataArray* const ids = output->GetGlobalIds();
  const bool canNumber = CanNumber(ids, largest, all.FirstNewPoints.back());
  // New points come last, hole by hole, as Numbers lists the holes.
  vtkIdType next = output->GetNumberOfTuples() - this->Filled.Patches.NumberOfPoints();
  for (const Index hole : this->Filled.Numbers)
  {
    for (vtkIdType i = all.FirstNewPoints[hole]; ids && i < all.FirstNewPoints[hole + 1]; ++i)
    {
      ids->SetVariantValue(next++, vtkVariant(canNumber ? largest + 1 + i : -1));
    }
  }
  if (!canNumber && all.FirstNewPoints.back() > 0)
  {
    output->SetActiveAttribute(-1, vtkDataSetAttributes::GLOBALIDS);
  }
}

// The same two steps as on one rank: points and their data, then the surface with its patches.
void FilledPart::Write(const SharedHoles& all, bool areMarked, vtkIdType largestId,
  const Progress& progress, vtkPolyData* output) const
{
  Stages stages(progress, { 20, 80 });
  const vtkSmartPointer<vtkPolyData> input = this->WithCorners(areMarked, stages.Next());
  MakeSurface(
    input, this->OwnMesh, this->PlacedPatches(all, input), all.Interpolate, stages.Next(), output);
  this->NumberNewPoints(all, largestId, output->GetPointData());
}

vtkSmartPointer<vtkPolyData> FilledPart::PointsOnBorder() const
{
  IdSet ends(static_cast<Index>(this->Input->GetNumberOfPoints()));
  for (Index h = 0; h < static_cast<Index>(this->OwnMesh.Twins.size()); ++h)
  {
    // More than are needed: which are on the border of the surface is not known yet.
    if (this->IsRim(h))
    {
      ends.Add(this->OwnMesh.Origin(h));
      ends.Add(this->OwnMesh.Destination(h));
    }
  }
  const std::vector<Index> chosen = ends.ListAndRank();
  return chosen.empty() ? nullptr : ChosenPoints(this->Input, chosen);
}

// All ranks know the holes; this one also has their points, with data.
void WriteRims(
  const SharedHoles& all, const Parts& points, const Progress& progress, vtkPolyData* output)
{
  if (points.empty()) // no triangle
  {
    MakeReport(vtkNew<vtkPolyData>(), all.Result, progress, output);
    return;
  }
  const vtkSmartPointer<vtkPolyData> joined = Append(points);
  const std::vector<PointKey> keys = KeysOf(joined, all.ByIds, nullptr);
  std::vector<Index> indices(all.Border.Keys.size(), 0);
  for (std::size_t i = keys.size(); i-- > 0;) // of several, the first
  {
    indices[all.Border.Find(keys[i])] = static_cast<Index>(i);
  }
  const vtkSmartPointer<vtkPolyData> rims = ChosenPoints(joined, indices);
  // Each is there once.
  rims->GetPointData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  MakeReport(rims, all.Result, progress, output);
}

} // namespace elevation
