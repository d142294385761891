// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Points of all parts have numbers, part after part. The passes:
 * 1. A key for each point, if any two may be one.
 * 2. Sort the points by key. Of one key, the owner's comes first, then the order of the parts
 *    counts.
 * 3. In each run of one key, decide which are the same: First[i] is the one that i stands for.
 * 4. Number those that stand for themselves: by their ids, or else in the order of the points.
 */
#include "CommonPoints.h"

#include "Adapt/Adapt.h"

#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace elevation
{

CommonPoints::CommonPoints(const Parts& parts, PartKind kind, const Progress& progress)
  : Offsets(1, 0)
{
  for (const auto& part : parts)
  {
    this->Offsets.push_back(this->Offsets.back() + part->GetNumberOfPoints());
  }
  const std::size_t count = static_cast<std::size_t>(this->Offsets.back());
  this->First.resize(count);
  std::iota(this->First.begin(), this->First.end(), 0);
  this->Joined.resize(count);
  this->ReadMarks(parts);
  const bool haveIds = std::all_of(parts.begin(), parts.end(),
    [](const auto& part) { return part->GetPointData()->GetGlobalIds() != nullptr; });
  if (haveIds || kind == PartKind::Mesh || !this->IsMarked.empty())
  {
    this->ReadKeys(parts, haveIds);
  }
  std::vector<vtkIdType> order = this->Keys.empty() ? this->First : this->Sorted(progress);
  for (std::size_t begin = 0, end = 0; begin < count && !this->Keys.empty(); begin = end)
  {
    while (end < count && this->Keys[order[begin]] == this->Keys[order[end]])
    {
      ++end;
    }
    this->Match(order.data() + begin, order.data() + end, kind, haveIds);
  }
  // Sorted by key so far, which for ids is the order wanted.
  if (!haveIds)
  {
    std::sort(order.begin(), order.end());
  }
  for (const vtkIdType i : order)
  {
    if (this->First[i] == i)
    {
      this->Joined[i] = this->NumberOfJoined++;
    }
  }
  // One step leads to the end: First of a First is itself.
  for (std::size_t i = 0; i < count; ++i)
  {
    this->Joined[i] = this->Joined[this->First[i]];
  }
}

void CommonPoints::ReadMarks(const Parts& parts)
{
  for (std::size_t part = 0; part < parts.size(); ++part)
  {
    vtkUnsignedCharArray* const ghosts = GhostsOf(parts[part]->GetPointData());
    for (vtkIdType i = 0; ghosts && i < ghosts->GetNumberOfTuples(); ++i)
    {
      if (IsCopy(ghosts, i))
      {
        // Only now: without any mark the list stays empty.
        this->IsMarked.resize(this->First.size(), 0);
        this->IsMarked[this->Offsets[part] + i] = 1;
      }
    }
  }
}

// In the order of the numbers of points.
void CommonPoints::ReadKeys(const Parts& parts, bool byIds)
{
  this->Keys.reserve(this->First.size());
  for (const auto& part : parts)
  {
    const PointKeys keys(part, byIds);
    for (vtkIdType i = 0; i < part->GetNumberOfPoints(); ++i)
    {
      this->Keys.push_back(keys.Of(i));
    }
  }
}

std::vector<vtkIdType> CommonPoints::Sorted(const Progress& progress) const
{
  const auto isMarked = [this](
                          vtkIdType i) { return !this->IsMarked.empty() && this->IsMarked[i]; };
  // All numbers: so far each point stands for itself.
  std::vector<vtkIdType> order = this->First;
  elevation::Sort(
    order.begin(), order.end(),
    [&](vtkIdType a, vtkIdType b) {
      return std::make_tuple(this->Keys[a], isMarked(a), a) <
        std::make_tuple(this->Keys[b], isMarked(b), b);
    },
    progress);
  return order;
}

// In the order of Sorted(), so that the first of a run is an owner's, if any is.
void CommonPoints::Match(const vtkIdType* begin, const vtkIdType* end, PartKind kind, bool haveIds)
{
  if (haveIds || kind == PartKind::Points)
  {
    for (const vtkIdType* i = begin + 1; i < end; ++i)
    {
      if (haveIds || this->IsMarked[*i])
      {
        this->First[*i] = *begin;
      }
    }
    return;
  }
  // A part may have several points at one place: duplicates, which have no triangle, or those of
  // two sheets. The first of one part is the first of any other, the second the second, and so on:
  //
  //     part 0: p q    part 1: r s t    joined: p = r, q = s, t
  std::vector<vtkIdType> different;
  std::map<std::ptrdiff_t, std::size_t> found; // so far, in each part
  for (const vtkIdType* i = begin; i < end && end - begin > 1; ++i)
  {
    const auto after = std::upper_bound(this->Offsets.begin(), this->Offsets.end(), *i);
    const std::size_t which = found[after - this->Offsets.begin()]++;
    if (which == different.size())
    {
      different.push_back(*i);
    }
    this->First[*i] = different[which];
  }
}

// Of points that are one, the values of the first count: those of the owner, or of the first part.
std::vector<JoinedRows> CommonPoints::Sources() const
{
  std::vector<JoinedRows> sources(this->Offsets.size() - 1);
  for (std::size_t part = 0; part < sources.size(); ++part)
  {
    for (vtkIdType i = this->Offsets[part]; i < this->Offsets[part + 1]; ++i)
    {
      if (this->First[i] == i)
      {
        sources[part].Add(i - this->Offsets[part], this->Joined[i]);
      }
    }
  }
  return sources;
}

} // namespace elevation
