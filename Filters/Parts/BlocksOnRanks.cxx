// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlocksOnRanks.h"

#include "Adapt/Adapt.h"
#include "Bytes.h"
#include "Ranks.h"

#include "vtkDataObject.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <tuple>

namespace elevation
{

namespace
{
/** How much of a block a rank has. */
struct BlockShare
{
  std::string Path;
  int Rank = 0;
  vtkIdType Size = 0; // points and cells
};
} // namespace

template <>
struct FieldsOf<BlockShare>
{
  template <typename Share>
  static auto In(Share& share)
  {
    return std::tie(share.Path, share.Rank, share.Size);
  }
};

bool HasPoints(const Leaf& leaf)
{
  auto* const points = vtkPointSet::SafeDownCast(leaf.Input);
  return points && points->GetNumberOfPoints() > 0;
}

/*
 * One meeting: each rank says how much it has of which block. The size decides where a block is
 * gathered, so that least is sent.
 */
std::map<std::string, int> FindSpread(
  const std::vector<Leaf>& leaves, const Ranks& ranks, std::set<std::string>& occupied)
{
  std::map<std::string, vtkIdType> own; // sizes
  for (const Leaf& leaf : leaves)
  {
    // An empty leaf does not make a block spread.
    if (HasPoints(leaf))
    {
      own[leaf.Path] += leaf.Input->GetNumberOfElements(vtkDataObject::POINT) +
        leaf.Input->GetNumberOfElements(vtkDataObject::CELL);
    }
  }
  std::vector<BlockShare> shares;
  for (const auto& block : own)
  {
    shares.push_back({ block.first, ranks.OwnRank(), block.second });
  }
  occupied.clear();
  std::map<std::string, int> spread;
  std::map<std::string, BlockShare> largest; // of each block
  // All ranks go through the same list in the same order, and find the same.
  for (const BlockShare& share : ranks.Collect(shares))
  {
    BlockShare& most = largest.emplace(share.Path, share).first->second;
    // A first share of a block makes it occupied; a second, of another rank, makes it spread.
    if (!occupied.insert(share.Path).second)
    {
      // Of ranks with as much, the first.
      most = share.Size > most.Size ? share : most;
      spread[share.Path] = most.Rank;
    }
  }
  return spread;
}

std::vector<vtkPointSet*> PartsOf(const std::vector<Leaf*>& leaves)
{
  std::vector<vtkPointSet*> parts;
  for (const Leaf* leaf : leaves)
  {
    if (HasPoints(*leaf))
    {
      parts.push_back(vtkPointSet::SafeDownCast(leaf->Input));
    }
  }
  return parts;
}

Leaf* FirstWithPoints(const std::vector<Leaf*>& leaves)
{
  const auto first =
    std::find_if(leaves.begin(), leaves.end(), [](const Leaf* leaf) { return HasPoints(*leaf); });
  return first == leaves.end() ? nullptr : *first;
}

// The input stays the caller's: a leaf gets another data set.
void Empty(const std::vector<Leaf*>& leaves)
{
  for (Leaf* leaf : leaves)
  {
    if (HasPoints(*leaf))
    {
      leaf->Made = EmptyCopy(vtkPointSet::SafeDownCast(leaf->Input));
      leaf->Input = leaf->Made;
    }
  }
}

void GatherBlock(const std::vector<Leaf*>& leaves, int home, PartKind kind, const Ranks& ranks,
  const Progress& progress, std::vector<Message>& warnings)
{
  const vtkSmartPointer<vtkPolyData> whole =
    Gather(PartsOf(leaves), kind, home, ranks, progress, warnings);
  Leaf* const first = FirstWithPoints(leaves);
  // On the home rank, which has points of the block, as it has most of it.
  if (whole)
  {
    CopyMark(first->Input, whole);
  }
  Empty(leaves);
  if (whole)
  {
    first->Made = whole;
    first->Input = whole;
    // It is no longer one partition that messages are about.
    first->Name = first->BlockName;
  }
}

} // namespace elevation
