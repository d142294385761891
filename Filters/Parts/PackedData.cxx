// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PackedData.h"

#include "Kernel/Base/Base.h"

#include "vtkCellData.h"
#include "vtkCharArray.h"
#include "vtkCommunicator.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTypeInt64Array.h"

#include <array>
#include <string>

namespace elevation
{

namespace
{
std::array<vtkFieldData*, 3> FieldsOf(vtkPolyData* data)
{
  return { data->GetPointData(), data->GetCellData(), data->GetFieldData() };
}

/** Puts an array in the place of one with the same name. */
template <typename Array>
void Replace(vtkFieldData* fields, vtkDataArray* array)
{
  vtkNew<Array> other;
  other->DeepCopy(array);
  other->SetName(array->GetName());
  fields->AddArray(other);
}

/** Makes values of type vtkIdType others of 64 bits. @return what RestoreIds() needs to know */
Bytes ReplaceIds(vtkPolyData* data)
{
  Bytes known; // field, attribute, length of the name, name; of each array
  const std::array<vtkFieldData*, 3> all = FieldsOf(data);
  for (int k = 0; k < 3; ++k)
  {
    vtkFieldData* const fields = all[k];
    auto* const attributes = vtkDataSetAttributes::SafeDownCast(fields);
    for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
    {
      auto* const ids = vtkIdTypeArray::SafeDownCast(fields->GetAbstractArray(i));
      if (!ids || !ids->GetName())
      {
        continue;
      }
      const std::string name = ids->GetName();
      const int about[3] = { k, attributes ? attributes->IsArrayAnAttribute(i) : -1,
        static_cast<int>(name.size()) };
      AppendTo(known, about, 3);
      AppendTo(known, name.data(), name.size());
      if (about[1] >= 0)
      {
        attributes->SetActiveAttribute(-1, about[1]);
      }
      Replace<vtkTypeInt64Array>(fields, ids);
    }
  }
  return known;
}

void RestoreIds(const char* known, const char* end, vtkPolyData* data)
{
  while (known != end)
  {
    int about[3];
    TakeFrom(known, about, 3);
    std::string name(static_cast<std::size_t>(about[2]), ' ');
    TakeFrom(known, &name[0], name.size());
    vtkFieldData* const fields = FieldsOf(data)[about[0]];
    vtkDataArray* const wide = fields->GetArray(name.c_str());
    if (!wide)
    {
      throw Error("The array '" + name + "' has not come from another rank (process).");
    }
    Replace<vtkIdTypeArray>(fields, wide);
    if (about[1] >= 0)
    {
      vtkDataSetAttributes::SafeDownCast(fields)->SetActiveAttribute(name.c_str(), about[1]);
    }
  }
}
} // namespace

Bytes PackData(vtkPolyData* data)
{
  vtkNew<vtkPolyData> copy;
  copy->ShallowCopy(data);
  const Bytes known = ReplaceIds(copy);
  vtkNew<vtkCharArray> buffer;
  if (!vtkCommunicator::MarshalDataObject(copy, buffer))
  {
    throw Error("A part of the mesh cannot be sent to another rank (process).");
  }
  Bytes bytes;
  const std::size_t size = known.size();
  AppendTo(bytes, &size, 1);
  AppendTo(bytes, known.data(), size);
  AppendTo(bytes, buffer->GetPointer(0), static_cast<std::size_t>(buffer->GetNumberOfValues()));
  return bytes;
}

vtkSmartPointer<vtkPolyData> UnpackData(const char* from, std::size_t size)
{
  const char* const end = from + size;
  std::size_t sizeOfKnown = 0;
  TakeFrom(from, &sizeOfKnown, 1);
  const char* const known = from;
  from += sizeOfKnown;
  vtkNew<vtkCharArray> buffer;
  buffer->SetArray(
    const_cast<char*>(from), static_cast<vtkIdType>(end - from), 1); // it stays the caller's
  auto data = vtkSmartPointer<vtkPolyData>::New();
  if (!vtkCommunicator::UnMarshalDataObject(buffer, data))
  {
    throw Error("A part of the mesh has not come from another rank (process).");
  }
  RestoreIds(known, from, data);
  return data;
}

} // namespace elevation
