// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointOwners.h"

#include "Adapt/Adapt.h"

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdTypeArray.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

namespace elevation
{

int PointOwners::CellOfRank(int rank) const
{
  const auto at = std::lower_bound(this->RankOfCell.begin(), this->RankOfCell.end(), rank);
  return at != this->RankOfCell.end() && *at == rank
    ? static_cast<int>(at - this->RankOfCell.begin())
    : -1;
}

namespace
{
/** Points of the sample for each cell. */
constexpr vtkIdType SamplePerCell = 1000;

/** A place of the stretch [0, size) with no rule that rows of a grid could keep step with. */
vtkIdType PlaceInStretch(vtkIdType stretch, vtkIdType size)
{
  std::uint64_t bits = 0x9E3779B97F4A7C15ull * static_cast<std::uint64_t>(stretch + 1);
  bits = (bits ^ (bits >> 31)) * 0xD6E8FEB86659FD93ull;
  return static_cast<vtkIdType>((bits >> 16) % static_cast<std::uint64_t>(size));
}

/** The work of one rank; the functions are its steps, in their order. */
class Redistribution
{
public:
  Redistribution(
    const Ranks& ranks, const PointsOfRank& points, const Progress& progress, SurfacePart& part)
    : All(ranks)
    , Input(points.Input && points.Input->GetNumberOfPoints() > 0 ? points.Input : nullptr)
    , Monitor(progress)
    , Part(part)
  {
    const std::vector<vtkIdType> canOwn = ranks.Collect(std::vector<vtkIdType>{ points.CanOwn });
    for (int rank = 0; rank < ranks.Count(); ++rank)
    {
      if (canOwn[rank])
      {
        this->RankOfCell.push_back(rank);
      }
    }
  }

  void NumberPoints();
  PointOwners CutPlane();
  void Send(const PointOwners& owners);

private:
  Progress Watched(double begin, double end) const
  {
    return this->All.Watched(elevation::Part(this->Monitor, begin, end));
  }
  bool TakeKindOfIds();
  void ReadPoints(bool areIdsGiven, vtkIdType first);
  std::vector<std::vector<vtkIdType>> SharedOut(
    const PointOwners& owners, const Progress& progress) const;
  void SortOwn();

  const Ranks& All;
  vtkPointSet* const Input; // nullptr: no points
  const Progress& Monitor;
  SurfacePart& Part;
  std::vector<int> RankOfCell;
  PointRows Rows;              // of the input
  std::vector<vtkIdType> Kept; // places of those that count
};

bool Redistribution::TakeKindOfIds()
{
  std::vector<ArrayKind>& kinds = this->Part.Kinds;
  const auto ids = std::find_if(kinds.begin(), kinds.end(), [](const ArrayKind& kind) {
    return kind.Attribute == vtkDataSetAttributes::GLOBALIDS && kind.Components == 1 &&
      kind.Type != VTK_FLOAT && kind.Type != VTK_DOUBLE && kind.Type != VTK_STRING &&
      kind.Type != VTK_BIT;
  });
  if (ids != kinds.end())
  {
    this->Part.NameOfIds = ids->Name;
    kinds.erase(ids);
    return true;
  }
  std::string& name = this->Part.NameOfIds;
  name = "GlobalPointIds";
  const auto isTaken = [&name](const ArrayKind& kind) { return kind.Name == name; };
  while (std::any_of(kinds.begin(), kinds.end(), isTaken))
  {
    name += "_";
  }
  return false;
}

void Redistribution::NumberPoints()
{
  PointsOfDataSet points;
  this->All.Agree([&]() {
    try
    {
      if (this->Input)
      {
        CheckPointArrays(this->Input);
        points = ViewPoints(this->Input);
      }
    }
    catch (const Error& error)
    {
      throw Error("On rank " + std::to_string(this->All.Own()) + ": " + error.what());
    }
  });
  this->Part.Kinds = CommonArrays(
    this->All, this->Input ? this->Input->GetPointData() : nullptr, this->Part.LeftOut);
  const bool areIdsGiven = this->TakeKindOfIds();
  const vtkIdType count = points.View.Count;
  const std::vector<vtkIdType> counts = this->All.Collect(std::vector<vtkIdType>{ count });
  std::vector<vtkIdType> doubles = { count > 0 && points.View.Double ? 1 : 0 };
  this->All.Sum(doubles);
  this->Part.TypeOfPoints = doubles[0] > 0 ? VTK_DOUBLE : VTK_FLOAT;
  const vtkIdType first =
    std::accumulate(counts.begin(), counts.begin() + this->All.Own(), vtkIdType(0));
  this->All.Agree([&]() { this->ReadPoints(areIdsGiven, first); });
}

void Redistribution::ReadPoints(bool areIdsGiven, vtkIdType first)
{
  this->Rows = PointRows(this->Part.Kinds);
  this->Part.Own = PointRows(this->Part.Kinds);
  this->Part.Others = PointRows(this->Part.Kinds);
  if (!this->Input)
  {
    return;
  }
  this->Rows.Read(this->Input, first, this->Watched(0.0, 0.3));
  vtkPointData* const data = this->Input->GetPointData();
  vtkDataArray* const ids = areIdsGiven ? data->GetArray(this->Part.NameOfIds.c_str()) : nullptr;
  auto* const plainIds = vtkIdTypeArray::FastDownCast(ids);
  auto* const ghosts =
    vtkUnsignedCharArray::SafeDownCast(data->GetArray(vtkDataSetAttributes::GhostArrayName()));
  this->Kept.reserve(this->Rows.Count());
  for (vtkIdType at = 0; at < static_cast<vtkIdType>(this->Rows.Count()); ++at)
  {
    if (ids)
    {
      this->Rows.Ids[at] = plainIds
        ? plainIds->GetValue(at)
        : static_cast<vtkIdType>(ids->GetVariantValue(at).ToTypeInt64());
    }
    if (!ghosts || !(ghosts->GetValue(at) & vtkDataSetAttributes::DUPLICATEPOINT))
    {
      this->Kept.push_back(at);
    }
  }
}

PointOwners Redistribution::CutPlane()
{
  std::vector<vtkIdType> all = { static_cast<vtkIdType>(this->Kept.size()) };
  this->All.Sum(all);
  const vtkIdType cells = static_cast<vtkIdType>(this->RankOfCell.size());
  const vtkIdType stretch = std::max<vtkIdType>(1, all[0] / (SamplePerCell * cells));
  std::vector<double> coordinates;
  this->All.Agree([&]() {
    const vtkIdType count = static_cast<vtkIdType>(this->Kept.size());
    for (vtkIdType i = 0; i * stretch < count; ++i)
    {
      const vtkIdType at = i * stretch + PlaceInStretch(i, std::min(stretch, count - i * stretch));
      const double* const p = this->Rows.At(this->Kept[at]);
      if (this->Rows.IsFinite(this->Kept[at]))
      {
        coordinates.insert(coordinates.end(), p, p + 2);
      }
    }
  });
  coordinates = this->All.CollectReals(coordinates);
  std::unique_ptr<Cuts> plane;
  this->All.Agree([&]() {
    std::vector<Point2> sample(coordinates.size() / 2);
    for (std::size_t i = 0; i < sample.size(); ++i)
    {
      sample[i] = { coordinates[2 * i], coordinates[2 * i + 1] };
    }
    plane = std::make_unique<Cuts>(std::move(sample), static_cast<int>(cells));
  });
  return { std::move(*plane), std::move(this->RankOfCell) };
}

/** The places of the points that go to each rank. */
std::vector<std::vector<vtkIdType>> Redistribution::SharedOut(
  const PointOwners& owners, const Progress& progress) const
{
  std::vector<int> ownerOf(this->Kept.size());
  std::vector<std::size_t> counts(this->All.Count(), 0);
  for (std::size_t i = 0; i < this->Kept.size(); ++i)
  {
    ReportStep(progress, i, this->Kept.size(), 1 << 16);
    const double* const p = this->Rows.At(this->Kept[i]);
    // What is not finite has no place in the plane, and stays here.
    ownerOf[i] = this->Rows.IsFinite(this->Kept[i])
      ? owners.RankOfCell[owners.Plane.OwnerOf({ p[0], p[1] })]
      : this->All.Own();
    ++counts[ownerOf[i]];
  }
  std::vector<std::vector<vtkIdType>> places(this->All.Count());
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    places[i].reserve(counts[i]);
  }
  for (std::size_t i = 0; i < this->Kept.size(); ++i)
  {
    places[ownerOf[i]].push_back(this->Kept[i]);
  }
  return places;
}

void Redistribution::Send(const PointOwners& owners)
{
  std::vector<Bytes> packed(this->All.Count());
  this->All.Agree([&]() {
    const Progress progress = this->Watched(0.3, 0.7);
    std::vector<std::vector<vtkIdType>> places = this->SharedOut(owners, progress);
    this->Kept = std::vector<vtkIdType>();
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      Report(progress, 1.0);
      packed[i] = places[i].empty() ? Bytes() : this->Rows.Pack(places[i]);
      places[i] = std::vector<vtkIdType>();
    }
    this->Rows = PointRows();
  });
  packed = this->All.Exchange(std::move(packed));
  this->All.Agree([&]() {
    const Progress progress = this->Watched(0.7, 1.0);
    Report(progress, 0.0);
    this->Part.Own.Unpack(packed);
    packed.clear();
    Report(progress, 0.5);
    this->SortOwn();
  });
  this->Part.Bases =
    this->All.Collect(std::vector<vtkIdType>{ static_cast<vtkIdType>(this->Part.Own.Count()) });
  this->Part.Bases.insert(this->Part.Bases.begin(), 0);
  std::partial_sum(this->Part.Bases.begin(), this->Part.Bases.end(), this->Part.Bases.begin());
}

/**
 * Brings the points into the order of their ids, which decides among duplicates. Points of the same id
 * are the same.
 */
void Redistribution::SortOwn()
{
  PointRows& own = this->Part.Own;
  const auto isIncreasing = [&own](std::size_t i) { return own.Ids[i] < own.Ids[i + 1]; };
  std::size_t i = 0;
  while (i + 1 < own.Count() && isIncreasing(i))
  {
    ++i;
  }
  if (i + 1 >= own.Count())
  {
    return;
  }
  std::vector<vtkIdType> places(own.Count());
  std::iota(places.begin(), places.end(), vtkIdType(0));
  std::stable_sort(places.begin(), places.end(),
    [&own](vtkIdType a, vtkIdType b) { return own.Ids[a] < own.Ids[b]; });
  const auto isSame = [this, &own](vtkIdType a, vtkIdType b) {
    const double *const p = own.At(a), *const q = own.At(b);
    if (own.Ids[a] == own.Ids[b] && own.IsFinite(a) && own.IsFinite(b) &&
      (p[0] != q[0] || p[1] != q[1]))
    {
      throw Error("Two points in different places have the same global id, " +
        std::to_string(own.Ids[a]) + ". Take the array \"" + this->Part.NameOfIds +
        "\" away, or make global ids anew.");
    }
    return own.Ids[a] == own.Ids[b];
  };
  places.erase(std::unique(places.begin(), places.end(), isSame), places.end());
  own.Choose(places);
}
} // namespace

PointOwners BringToOwners(
  const Ranks& ranks, const PointsOfRank& points, const Progress& progress, SurfacePart& part)
{
  Redistribution work(ranks, points, progress, part);
  work.NumberPoints();
  PointOwners owners = work.CutPlane();
  work.Send(owners);
  return owners;
}

} // namespace elevation
