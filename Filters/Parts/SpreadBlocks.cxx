// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SpreadBlocks.h"

#include "Adapt/Adapt.h"
#include "Ranks.h"

#include "vtkDataObject.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"

#include <algorithm>

namespace elevation
{

vtkIdType IdOf(const std::string& path)
{
  // Not negative as a signed number.
  return static_cast<vtkIdType>(std::hash<std::string>()(path) >> 2);
}

bool HasPoints(const Place& place)
{
  auto* const points = vtkPointSet::SafeDownCast(place.Input);
  return points && points->GetNumberOfPoints() > 0;
}

/*
 * One meeting: each rank says how much it has of which block. The size decides where a block is
 * gathered, so that least is sent.
 */
std::map<vtkIdType, int> FindSpread(
  const std::vector<Place>& places, const Ranks& ranks, std::vector<vtkIdType>& occupied)
{
  std::map<vtkIdType, vtkIdType> own; // points and cells of each block
  for (const Place& place : places)
  {
    // An empty place does not make a block spread.
    if (HasPoints(place))
    {
      own[IdOf(place.Path)] += place.Input->GetNumberOfElements(vtkDataObject::POINT) +
        place.Input->GetNumberOfElements(vtkDataObject::CELL);
    }
  }
  std::vector<vtkIdType> rows; // block, rank, size
  for (const auto& block : own)
  {
    rows.insert(rows.end(), { block.first, ranks.OwnRank(), block.second });
  }
  // All ranks go through the same list in the same order, and find the same.
  rows = ranks.Collect(rows);
  occupied.clear();
  std::map<vtkIdType, int> spread;
  std::map<vtkIdType, std::size_t> largest; // row of each block
  for (std::size_t i = 0; i < rows.size(); i += 3)
  {
    // A first row of a block makes it occupied; a second, of another rank, makes it spread.
    const auto found = largest.emplace(rows[i], i);
    if (found.second)
    {
      occupied.push_back(rows[i]);
      continue;
    }
    std::size_t& row = found.first->second;
    // Of ranks with as much, the first.
    row = rows[i + 2] > rows[row + 2] ? i : row;
    spread[rows[i]] = static_cast<int>(rows[row + 1]);
  }
  std::sort(occupied.begin(), occupied.end());
  return spread;
}

std::vector<vtkPointSet*> PartsOf(const std::vector<Place*>& places)
{
  std::vector<vtkPointSet*> parts;
  for (const Place* place : places)
  {
    if (HasPoints(*place))
    {
      parts.push_back(vtkPointSet::SafeDownCast(place->Input));
    }
  }
  return parts;
}

Place* FirstWithPoints(const std::vector<Place*>& places)
{
  const auto first = std::find_if(
    places.begin(), places.end(), [](const Place* place) { return HasPoints(*place); });
  return first == places.end() ? nullptr : *first;
}

// The input stays the caller's: a place gets another data set.
void Empty(const std::vector<Place*>& places)
{
  for (Place* place : places)
  {
    if (HasPoints(*place))
    {
      place->Made = EmptyCopy(vtkPointSet::SafeDownCast(place->Input));
      place->Input = place->Made;
    }
  }
}

void GatherBlock(const std::vector<Place*>& places, int home, PartKind kind, const Ranks& ranks,
  const Progress& progress, std::vector<Message>& warnings)
{
  const vtkSmartPointer<vtkPolyData> whole =
    Gather(PartsOf(places), kind, home, ranks, progress, warnings);
  Place* const first = FirstWithPoints(places);
  // On the home rank, which has points of the block, as it has most of it.
  if (whole)
  {
    CopyMark(first->Input, whole);
  }
  Empty(places);
  if (whole)
  {
    first->Made = whole;
    first->Input = whole;
    // It is no longer one partition that messages are about.
    first->Name = first->BlockName;
  }
}

} // namespace elevation
