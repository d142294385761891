// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointKeys.h"

#include "vtkDataArray.h"
#include "vtkIdTypeArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkVariant.h"

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
    // A vtkIdTypeArray is what filters write, and is read without a vtkVariant for each value.
    auto* const plain = vtkIdTypeArray::FastDownCast(this->Ids);
    key[0] = plain ? plain->GetValue(point) : this->Ids->GetVariantValue(point).ToTypeInt64();
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
