// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Numbers and indices of a part's points; the measure of edges of all parts; and the part as the
 * data set that leaves the module.
 */
#include "SurfacePart.h"

#include "Adapt/Adapt.h"

#include "vtkAbstractArray.h"
#include "vtkCellArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace elevation
{

int OwnerOf(GlobalId number, const std::vector<vtkIdType>& bases)
{
  // Of parts that begin with the same number only the last has points, and upper_bound() is beyond
  // it. The first and the last of the list are left out, so the answer is a part whatever the
  // number is.
  const auto next = std::upper_bound(bases.begin() + 1, bases.end() - 1, number);
  return static_cast<int>(next - bases.begin()) - 1;
}

// Most corners are own ones, and need no search.
std::size_t SurfacePart::IndexOf(GlobalId number, GlobalId first) const
{
  const std::size_t ownCount = this->OwnPoints.Count();
  const GlobalId index = number - first;
  if (index >= 0 && index < static_cast<GlobalId>(ownCount))
  {
    return static_cast<std::size_t>(index);
  }
  const std::vector<GlobalId>& others = this->OtherNumbers;
  return ownCount + (std::lower_bound(others.begin(), others.end(), number) - others.begin());
}

Point2 SurfacePart::PointAt(std::size_t index) const
{
  const std::size_t own = this->OwnPoints.Count();
  const double* const p = index < own ? this->OwnPoints.At(index) : this->Others.At(index - own);
  return { p[0], p[1] };
}

namespace
{
constexpr std::size_t MostRuns = 1024; // more are no order

/**
 * Indices by increasing ids; of equal ids, the one that comes first stays so. What each rank has
 * sent is in order, most often: such runs are merged, two and two.
 * @param[in] runs  where they begin, and the end
 */
std::vector<vtkIdType> MergeRuns(const Buffer<vtkIdType>& ids, std::vector<std::size_t> runs)
{
  const auto isBefore = [&ids](vtkIdType a, vtkIdType b) { return ids[a] < ids[b]; };
  std::vector<vtkIdType> indices(ids.size());
  std::iota(indices.begin(), indices.end(), vtkIdType(0));
  if (runs.size() > MostRuns)
  {
    std::stable_sort(indices.begin(), indices.end(), isBefore);
    return indices;
  }
  while (runs.size() > 2)
  {
    std::vector<std::size_t> merged;
    for (std::size_t i = 0; i + 1 < runs.size(); i += 2)
    {
      const auto at = [&](std::size_t run) {
        return indices.begin() + runs[std::min(run, runs.size() - 1)];
      };
      std::inplace_merge(at(i), at(i + 1), at(i + 2), isBefore);
      merged.push_back(runs[i]);
    }
    merged.push_back(runs.back());
    runs = std::move(merged);
  }
  return indices;
}
} // namespace

void SortOwn(SurfacePart& part)
{
  PointTable& own = part.OwnPoints;
  std::vector<std::size_t> runs(1, 0);
  for (std::size_t i = 0; i + 1 < own.Count() && runs.size() < MostRuns; ++i)
  {
    if (own.Ids[i] >= own.Ids[i + 1])
    {
      runs.push_back(i + 1);
    }
  }
  runs.push_back(own.Count());
  // Most often all is in order: from one rank, or sorted in a pass before. Then nothing is copied.
  if (runs.size() == 2)
  {
    return;
  }
  std::vector<vtkIdType> indices = MergeRuns(own.Ids, std::move(runs));
  const auto isSame = [&part, &own](vtkIdType a, vtkIdType b) {
    const double *const p = own.At(a), *const q = own.At(b);
    // Points without a place are in no place that could differ.
    if (own.Ids[a] == own.Ids[b] && own.IsFinite(a) && own.IsFinite(b) &&
      (p[0] != q[0] || p[1] != q[1]))
    {
      throw Error("Two points in different places have the same global id, " +
        std::to_string(own.Ids[a]) + ". Take the array \"" + part.IdsName +
        "\" away, or make global ids anew.");
    }
    return own.Ids[a] == own.Ids[b];
  };
  indices.erase(std::unique(indices.begin(), indices.end(), isSame), indices.end());
  own.Choose(indices);
}

// A corner is listed once, in however many triangles it is.
std::vector<GlobalId> ListOthers(
  const std::vector<GlobalTriangle>& triangles, GlobalId first, GlobalId end)
{
  std::vector<GlobalId> others;
  for (const GlobalTriangle& triangle : triangles)
  {
    std::copy_if(triangle.begin(), triangle.end(), std::back_inserter(others),
      [first, end](GlobalId id) { return id < first || id >= end; });
  }
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  return others;
}

// Each corner takes a search among the others' numbers, unless it is an own point.
void AppendTriangles(const std::vector<GlobalTriangle>& triangles, GlobalId first,
  const Progress& progress, SurfacePart& part)
{
  Buffer<Index>& corners = part.Result.Triangles;
  const std::size_t before = corners.size();
  corners.Resize(before + 3 * triangles.size());
  Index* corner = corners.data() + before;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    ReportStep(progress, t, triangles.size(), 1 << 16);
    for (const GlobalId id : triangles[t])
    {
      *corner++ = static_cast<Index>(part.IndexOf(id, first));
    }
  }
}

namespace
{
/** A value of a point for the part that owns it. */
struct ValueForOwner
{
  vtkIdType Position;
  double Value;
};

/**
 * The least values at own points that any part has there. Each part sends what it has at points of
 * others to their owners; then values are those of own points alone, and each point counts once.
 */
void MergeAtOwners(Engine& engine, int box, const SurfacePart& part, std::vector<double>& values)
{
  const std::size_t ownCount = part.OwnPoints.Count();
  engine.ForEach(Progress(), [&](int, const Progress&) {
    ValuesForParts<ValueForOwner> ofOthers;
    for (std::size_t i = 0; i < part.OtherNumbers.size(); ++i)
    {
      const int owner = part.OwnerOf(part.OtherNumbers[i]);
      ofOthers[owner].push_back({ part.OtherNumbers[i] - part.Bases[owner], values[ownCount + i] });
    }
    SendTo(engine, box, ofOthers);
  });
  engine.Deliver();
  engine.ForEach(Progress(), [&](int own, const Progress&) {
    for (const ValueForOwner& value : ValuesIn<ValueForOwner>(engine.At(own, box)))
    {
      values[value.Position] = std::min(values[value.Position], value.Value);
    }
    engine.At(own, box).Clear();
  });
  values.resize(ownCount);
}

/**
 * A quantile of the values of all ranks, sorted on each, none negative. Bisection of the bits of a
 * double: 63 sums of one number at most, where sorting would bring all values to one rank. The
 * result is one of the values, the same as of one sorted list.
 */
double FindQuantile(const Ranks& ranks, const std::vector<double>& values, double share)
{
  std::vector<vtkIdType> count = { static_cast<vtkIdType>(values.size()) };
  ranks.Sum(count);
  const vtkIdType index = QuantilePlace(share, count[0]);
  // As bits, doubles that are not negative have the same order.
  const double largest = std::numeric_limits<double>::max();
  std::uint64_t low = 0, high = 0;
  std::memcpy(&high, &largest, sizeof(high));
  double middle = 0.0;
  while (low < high)
  {
    const std::uint64_t bits = low + (high - low) / 2;
    std::memcpy(&middle, &bits, sizeof(bits));
    // How many values of all ranks are at most the middle. Above the index, the quantile is at most
    // it.
    const auto greater = std::upper_bound(values.begin(), values.end(), middle);
    count[0] = static_cast<vtkIdType>(greater - values.begin());
    ranks.Sum(count);
    (count[0] > index ? high : low) = count[0] > index ? bits : bits + 1;
  }
  std::memcpy(&middle, &low, sizeof(low));
  return middle;
}

} // namespace

void MeasureAll(
  Engine& engine, int box, const Progress& progress, const SurfacePart& part, LimitEffect& effect)
{
  const Ranks& ranks = engine.AllRanks();
  EdgeMeasures lengths;
  ranks.Agree([&]() {
    lengths = MeasureEdges(
      part.Result.Triangles, part.OwnPoints.Count() + part.Others.Count(),
      [&part](Index index) { return part.PointAt(index); }, ranks.Watched(progress));
  });
  MergeAtOwners(engine, box, part, lengths.Limits);
  ranks.Agree([&]() {
    std::sort(lengths.Edges.begin(), lengths.Edges.end());
    std::vector<double>& limits = lengths.Limits;
    std::sort(limits.begin(), limits.end());
    // Points without any triangle: no limit keeps them.
    const double infinity = std::numeric_limits<double>::infinity();
    limits.erase(std::lower_bound(limits.begin(), limits.end(), infinity), limits.end());
  });
  effect.HasLengths = true;
  effect.Shortest = FindQuantile(ranks, lengths.Edges, 0.0);
  effect.Median = FindQuantile(ranks, lengths.Edges, MedianShare);
  effect.ForMost = FindQuantile(ranks, lengths.Limits, MostShare);
}

/*
 * A limit of edges, and what lines have changed, may leave points of others without a triangle.
 * Three passes over the corners of others: which are used; their order; the new indices.
 */
void KeepCorners(SurfacePart& part)
{
  PointTable& others = part.Others;
  const Index ownCount = static_cast<Index>(part.OwnPoints.Count());
  Buffer<Index>& corners = part.Result.Triangles;
  std::vector<Index> indexOf(others.Count(), None);
  std::vector<vtkIdType> order;
  std::vector<std::size_t> ofOthers; // indices among the corners
  for (std::size_t i = part.OwnCorners; i < corners.size(); ++i)
  {
    if (corners[i] < ownCount)
    {
      continue;
    }
    ofOthers.push_back(i);
    Index& index = indexOf[corners[i] - ownCount];
    if (index == None)
    {
      index = 0; // set below
      order.push_back(corners[i] - ownCount);
    }
  }
  // Of equal ids, which points that are not finite may have, the index decides.
  std::sort(order.begin(), order.end(), [&others](vtkIdType a, vtkIdType b) {
    return std::make_pair(others.Ids[a], a) < std::make_pair(others.Ids[b], b);
  });
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    indexOf[order[i]] = ownCount + static_cast<Index>(i);
  }
  for (const std::size_t i : ofOthers)
  {
    corners[i] = indexOf[corners[i] - ownCount];
  }
  others.Choose(order);
  part.OtherNumbers.clear();
}

namespace
{
/**
 * Hands over own values, and then those of others. VTK frees the memory by free(), as a Buffer
 * does.
 */
template <typename Value, typename Array>
void TakeOver(Buffer<Value>& own, const Buffer<Value>& others, Array* array)
{
  const std::size_t ownSize = own.size();
  own.Resize(ownSize + others.size());
  own.Shrink();
  std::copy(others.begin(), others.end(), own.begin() + ownSize);
  const vtkIdType size = static_cast<vtkIdType>(own.size());
  array->SetArray(own.Release(), size, 0, vtkAbstractArray::VTK_DATA_ARRAY_FREE);
}
} // namespace

// Points of others follow the own ones, so indices are the output's ids as they are.
void PassPart(SurfacePart& part, int threads, vtkPolyData* output)
{
  const vtkIdType ownCount = static_cast<vtkIdType>(part.OwnPoints.Count());
  const vtkIdType otherCount = static_cast<vtkIdType>(part.Others.Count());
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName(part.IdsName.c_str());
  TakeOver(part.OwnPoints.Ids, part.Others.Ids, ids.Get());
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetName("Points"); // as vtkPoints does
  coordinates->SetNumberOfComponents(3);
  TakeOver(part.OwnPoints.Coordinates, part.Others.Coordinates, coordinates.Get());
  vtkNew<vtkPoints> points;
  points->SetDataType(part.PointType);
  if (part.PointType == VTK_DOUBLE)
  {
    points->SetData(coordinates);
  }
  else
  {
    points->GetData()->DeepCopy(coordinates);
  }
  output->SetPoints(points);
  vtkPointData* const data = output->GetPointData();
  for (std::size_t i = 0; i < part.Kinds.size(); ++i)
  {
    // Both tables have the same kinds of arrays in the same order.
    part.OwnPoints.Arrays[i]->InsertTuples(ownCount, otherCount, 0, part.Others.Arrays[i]);
  }
  part.OwnPoints.PassArrays(data);
  vtkUnsignedCharArray* ghosts = GhostsOf(data);
  data->SetGlobalIds(ids);
  // All ranks mark points, also one that has none of others: arrays have to be the same on all
  // ranks.
  if (!ghosts)
  {
    vtkNew<vtkUnsignedCharArray> made;
    made->SetName(vtkDataSetAttributes::GhostArrayName());
    made->SetNumberOfValues(ownCount + otherCount);
    made->FillValue(0);
    data->AddArray(made);
    ghosts = made;
  }
  for (vtkIdType i = ownCount; i < ownCount + otherCount; ++i)
  {
    ghosts->SetValue(i, ghosts->GetValue(i) | vtkDataSetAttributes::DUPLICATEPOINT);
  }
  output->SetPolys(ToCellArray(std::move(part.Result.Triangles), threads));
}

} // namespace elevation
