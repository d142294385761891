// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilledPart.h"

#include "MeshConversion.h"
#include "NearParts.h"
#include "PackedData.h"
#include "PatchedSurface.h"
#include "TrimmedSurface.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkVariant.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace elevation
{

bool FilledPart::HasPoints() const
{
  return this->Input->GetNumberOfPoints() > 0;
}

namespace
{
class FilledWriting
{
public:
  FilledWriting(const Ranks& ranks, const FilledPart& part, bool interpolate, Block& block)
    : All(ranks)
    , Part(part)
    , Interpolate(interpolate)
    , Of(block)
  {
  }

  void WriteSurface();
  void WriteReport(const FillResult& patches);

private:
  Progress Watched(double begin, double end) const
  {
    return this->All.Watched(elevation::Part(this->Of.Progress, begin, end));
  }
  std::vector<Index> PlaceCorners(std::vector<Index>& added) const;
  vtkSmartPointer<vtkPolyData> WithCorners(const std::vector<Index>& added, bool areMarked) const;
  FillResult PlacedPatches(const std::vector<Index>& placeOf, vtkPolyData* input) const;
  void PlaceAttributes(vtkPolyData* input, FillResult& placed) const;
  vtkIdType LargestId() const;
  void NumberNewPoints(vtkIdType largest, vtkPolyData* output) const;

  const Ranks& All;
  const FilledPart& Part;
  const bool Interpolate;
  Block& Of;
};

/**
 * The place of each point of the surroundings that a patch has: among the input's, or after them.
 * @param[out] added  those after them
 */
std::vector<Index> FilledWriting::PlaceCorners(std::vector<Index>& added) const
{
  const Index first = static_cast<Index>(this->Part.Keys.size());
  const Index own = static_cast<Index>(this->Part.Input->GetNumberOfPoints());
  std::vector<Index> placeOf(this->Part.Keys.size(), None);
  const auto place = [&](Index corner) {
    if (corner < first && placeOf[corner] == None)
    {
      const Index here = this->Part.Shared.Find(this->Part.Keys[corner]);
      placeOf[corner] = here != None ? here : own + static_cast<Index>(added.size());
      if (here == None)
      {
        added.push_back(corner);
      }
    }
  };
  const FillResult& patches = this->Part.Patches;
  std::for_each(patches.Triangles.begin(), patches.Triangles.end(), place);
  std::for_each(patches.NearestBoundaryPoints.begin(), patches.NearestBoundaryPoints.end(), place);
  return placeOf;
}

/** The input and the corners of other ranks; of points that ranks have in common, one is no ghost. */
vtkSmartPointer<vtkPolyData> FilledWriting::WithCorners(
  const std::vector<Index>& added, bool areMarked) const
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  TrimmedPoints points;
  points.New = this->Part.Whole;
  points.Added.assign(added.begin(), added.end());
  points.AreMarked = areMarked;
  points.Type = this->Part.Input->GetPoints()->GetDataType();
  const Index own = static_cast<Index>(this->Part.Input->GetNumberOfPoints());
  for (std::size_t i = 0; i < this->Part.Shared.Places.size(); ++i)
  {
    if (this->Part.Shared.AreCopies[i])
    {
      points.OfOthers.push_back(this->Part.Shared.Places[i]);
    }
  }
  for (std::size_t i = 0; i < added.size(); ++i)
  {
    points.OfOthers.push_back(own + static_cast<Index>(i));
  }
  PassTrimmedPoints(this->Part.Input, points, this->Watched(0.82, 0.85), data);
  data->SetPolys(this->Part.Input->GetPolys());
  data->GetCellData()->PassData(this->Part.Input->GetCellData());
  data->GetFieldData()->PassData(this->Part.Input->GetFieldData());
  return data;
}

/** The patches of this rank's holes among all holes, by the places of the input's points. */
FillResult FilledWriting::PlacedPatches(const std::vector<Index>& placeOf, vtkPolyData* input) const
{
  const FillResult& from = this->Part.Patches;
  FillResult to;
  to.Points = from.Points;
  to.StandardErrors = from.StandardErrors;
  const Index first = static_cast<Index>(placeOf.size());
  const Index firstNew = static_cast<Index>(input->GetNumberOfPoints());
  const auto placed = [&](Index id) { return id < first ? placeOf[id] : firstNew + id - first; };
  std::transform(
    from.Triangles.begin(), from.Triangles.end(), std::back_inserter(to.Triangles), placed);
  std::transform(from.NearestBoundaryPoints.begin(), from.NearestBoundaryPoints.end(),
    std::back_inserter(to.NearestBoundaryPoints), placed);
  std::size_t next = 0;
  for (Index hole = 0; hole < static_cast<Index>(this->Part.Reports.size()); ++hole)
  {
    const bool isMine = next < this->Part.Mine.size() && this->Part.Mine[next] == hole;
    next += isMine ? 1 : 0;
    to.PointOffsets.push_back(isMine ? from.PointOffsets[next] : to.PointOffsets.back());
    to.TriangleOffsets.push_back(isMine ? from.TriangleOffsets[next] : to.TriangleOffsets.back());
  }
  to.Reports = this->Part.Reports;
  this->PlaceAttributes(input, to);
  return to;
}

/** Attributes in the order of the input's arrays. */
void FilledWriting::PlaceAttributes(vtkPolyData* input, FillResult& placed) const
{
  vtkPointData* const given = this->Part.Whole ? this->Part.Whole->GetPointData() : nullptr;
  std::map<std::string, std::size_t> firstOf;
  std::size_t count = 0;
  for (int i = 0; given && i < given->GetNumberOfArrays() && this->Interpolate; ++i)
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
      placed.Attributes.push_back(this->Part.Patches.Attributes[firstOf.at(array->GetName()) + c]);
    }
  }
}

vtkIdType FilledWriting::LargestId() const
{
  vtkIdType largest = -1;
  vtkDataArray* const ids = this->Part.Input->GetPointData()->GetGlobalIds();
  for (vtkIdType i = 0; ids && i < ids->GetNumberOfTuples(); ++i)
  {
    largest = std::max<vtkIdType>(largest, ids->GetVariantValue(i).ToTypeInt64());
  }
  return largest;
}

/** Global ids after the largest of all ranks, in the order of the holes. */
void FilledWriting::NumberNewPoints(vtkIdType largest, vtkPolyData* output) const
{
  vtkDataArray* const ids = output->GetPointData()->GetGlobalIds();
  vtkIdType next = output->GetNumberOfPoints() - this->Part.Patches.NumberOfPoints();
  for (const Index hole : this->Part.Mine)
  {
    for (vtkIdType i = this->Part.FirstNewPoints[hole];
         ids && i < this->Part.FirstNewPoints[hole + 1]; ++i)
    {
      ids->SetComponent(next++, 0, static_cast<double>(largest + 1 + i));
    }
  }
}

/** The rims with their points, on the first rank with outputs. */
void FilledWriting::WriteReport(const FillResult& patches)
{
  const std::vector<vtkIdType> have =
    this->All.Collect(std::vector<vtkIdType>{ this->Of.Outputs.empty() ? 0 : 1 });
  const int first = static_cast<int>(std::find(have.begin(), have.end(), 1) - have.begin());
  std::vector<Bytes> packed(this->All.Count());
  this->All.Agree([&]() {
    std::vector<Index> chosen;
    for (std::size_t i = 0; i < this->Part.Shared.Places.size(); ++i)
    {
      const bool isUsed = this->Part.AreUsed[this->Part.Shared.Places[i]];
      if (isUsed && this->Part.Border.Find(this->Part.Shared.Keys[i]) != None)
      {
        chosen.push_back(this->Part.Shared.Places[i]);
      }
    }
    if (!chosen.empty())
    {
      packed[first] = PackData(ChosenPoints(this->Part.Input, chosen));
    }
  });
  packed = this->All.Exchange(std::move(packed));
  this->All.Agree([&]() {
    if (this->All.Own() != first)
    {
      return;
    }
    Parts parts;
    for (const Bytes& bytes : packed)
    {
      if (!bytes.empty())
      {
        parts.push_back(UnpackData(bytes.data(), bytes.size()));
      }
    }
    const vtkSmartPointer<vtkPolyData> joined = Append(parts);
    const std::vector<PointKey> keys = KeysOf(joined, this->Part.ByIds, nullptr);
    std::vector<Index> places(this->Part.Border.Keys.size(), 0);
    for (std::size_t i = keys.size(); i-- > 0;) // of several, the first
    {
      places[this->Part.Border.Find(keys[i])] = static_cast<Index>(i);
    }
    MakeReport(
      ChosenPoints(joined, places), patches, this->Watched(0.97, 1.0), this->Of.Outputs[1]);
  });
}

void FilledWriting::WriteSurface()
{
  std::vector<Index> added;
  std::vector<Index> placeOf;
  this->All.Agree([&]() { placeOf = this->PlaceCorners(added); });
  const std::vector<vtkIdType> largest =
    this->All.Collect(std::vector<vtkIdType>{ this->LargestId() });
  const std::vector<char>& copies = this->Part.Shared.AreCopies;
  std::vector<vtkIdType> sums = { static_cast<vtkIdType>(added.size()) +
    std::count(copies.begin(), copies.end(), 1) };
  this->All.Sum(sums);
  this->All.Agree([&]() {
    if (this->Part.HasPoints())
    {
      const vtkSmartPointer<vtkPolyData> input = this->WithCorners(added, sums[0] > 0);
      MakeSurface(input, this->Part.Own, this->PlacedPatches(placeOf, input), this->Interpolate,
        this->Watched(0.85, 0.97), this->Of.Outputs[0]);
      this->NumberNewPoints(*std::max_element(largest.begin(), largest.end()), this->Of.Outputs[0]);
    }
  });
}
} // namespace

void WriteFilled(const Ranks& ranks, const FilledPart& part, bool interpolate,
  const FillResult& patches, Block& block)
{
  FilledWriting writing(ranks, part, interpolate, block);
  writing.WriteSurface();
  writing.WriteReport(patches);
}

} // namespace elevation
