// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointKeys.h"

#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <cstddef>
#include <cstring>

namespace elevation
{

PointKeys::PointKeys(vtkPolyData* data, bool byIds)
  : Data(data)
  , Ids(byIds ? data->GetPointData()->GetGlobalIds() : nullptr)
{
}

PointKey PointKeys::Of(vtkIdType point) const
{
  PointKey key{ { 0, 0, 0 } };
  if (this->Ids)
  {
    key[0] = IdAt(this->Ids, point);
    return key;
  }
  double xyz[3];
  this->Data->GetPoint(point, xyz);
  for (double& value : xyz)
  {
    value += 0.0; // -0 is 0
  }
  std::memcpy(key.data(), xyz, sizeof(xyz));
  return key;
}

// By Fibonacci hashing: the multiplier is 2^64 divided by the golden ratio. One round alone would
// keep a rule in the upper bits, as successive numbers go on by the same step there. Without the
// 1, the hash of 0 would be 0, and point 0 in every sample.
std::uint64_t HashOf(std::uint64_t number)
{
  const std::uint64_t bits = 0x9E3779B97F4A7C15ull * (number + 1);
  return (bits ^ (bits >> 31)) * 0xD6E8FEB86659FD93ull;
}

// In the order of the points, or of those chosen.
std::vector<PointKey> KeysOf(vtkPolyData* data, bool byIds, const std::vector<Index>* chosen)
{
  const PointKeys keys(data, byIds);
  const vtkIdType count =
    chosen ? static_cast<vtkIdType>(chosen->size()) : data->GetNumberOfPoints();
  std::vector<PointKey> result;
  result.reserve(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i)
  {
    result.push_back(keys.Of(chosen ? (*chosen)[i] : i));
  }
  return result;
}

} // namespace elevation
