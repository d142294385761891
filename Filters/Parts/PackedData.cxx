// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * vtkCommunicator writes VTK's legacy file format into memory. In that, active attributes stand
 * apart from the other arrays, and a vtkIdType has 32 bits. Hence the two steps: MarkArrays()
 * brings a shallow copy into a form that survives, and notes what it was; RestoreArrays() makes
 * that of it again.
 */
#include "PackedData.h"

#include "Kernel/Base/Base.h"

#include "vtkAbstractArray.h"
#include "vtkCellData.h"
#include "vtkCharArray.h"
#include "vtkCommunicator.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkType.h"

#include <array>
#include <string>

namespace elevation
{

namespace
{
std::array<vtkFieldData*, 3> ArraysOf(vtkPolyData* data)
{
  return { data->GetPointData(), data->GetCellData(), data->GetFieldData() };
}

/**
 * Puts an array in the place of one with the same name, which has another type or is missing: then
 * it has no values. @return its index
 */
int Replace(vtkFieldData* fields, const std::string& name, int type, int components)
{
  const auto other = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(type));
  other->SetNumberOfComponents(components);
  // The values are converted one by one where types differ.
  if (vtkAbstractArray* const array = fields->GetAbstractArray(name.c_str()))
  {
    other->DeepCopy(array);
  }
  other->SetName(name.c_str());
  return fields->AddArray(other);
}

/** What VTK's communicators do not keep of each array. */
struct ArrayMark
{
  int Field; // of ArraysOf()
  int Type;
  int Components;
  int Attributes; // a bit for each
};

/**
 * Makes the arrays of a data set such that VTK's communicators keep all values and their order: of
 * no attribute; where vtkIdType, which would be cut to 32 bits, of 64 bits; and none without
 * values, at which they stop reading field data.
 * @return for each array its mark and its name
 */
Bytes MarkArrays(vtkPolyData* data)
{
  Bytes marks;
  const std::array<vtkFieldData*, 3> all = ArraysOf(data);
  for (int k = 0; k < 3; ++k)
  {
    auto* const attributes = vtkDataSetAttributes::SafeDownCast(all[k]);
    for (int i = 0; i < all[k]->GetNumberOfArrays(); ++i)
    {
      vtkAbstractArray* const array = all[k]->GetAbstractArray(i);
      if (!array->GetName())
      {
        continue;
      }
      ArrayMark mark = { k, array->GetDataType(), array->GetNumberOfComponents(), 0 };
      for (int type = 0; attributes && type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
      {
        mark.Attributes |= attributes->GetAbstractAttribute(type) == array ? 1 << type : 0;
      }
      AppendTo(marks, &mark, 1);
      AppendList(marks, std::string(array->GetName()));
      if (mark.Type == VTK_ID_TYPE)
      {
        Replace(all[k], array->GetName(), VTK_TYPE_INT64, mark.Components);
      }
    }
    // From the last, as removing one moves those after it.
    for (int i = all[k]->GetNumberOfArrays() - 1; i >= 0; --i)
    {
      if (all[k]->GetAbstractArray(i)->GetNumberOfTuples() == 0)
      {
        all[k]->RemoveArray(i);
      }
    }
    for (int type = 0; attributes && type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
    {
      attributes->SetActiveAttribute(-1, type);
    }
  }
  return marks;
}

// Marks come in the order of the arrays. An array that had no values is missing, and is made.
void RestoreArrays(const char* marks, const char* end, vtkPolyData* data)
{
  while (marks != end)
  {
    ArrayMark mark;
    std::string name;
    TakeFrom(marks, &mark, 1);
    TakeList(marks, name);
    vtkFieldData* const fields = ArraysOf(data)[mark.Field];
    int index = -1;
    vtkAbstractArray* const array = fields->GetAbstractArray(name.c_str(), index);
    if (!array || array->GetDataType() != mark.Type)
    {
      index = Replace(fields, name, mark.Type, mark.Components);
    }
    for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
    {
      if (mark.Attributes & (1 << type))
      {
        vtkDataSetAttributes::SafeDownCast(fields)->SetActiveAttribute(index, type);
      }
    }
  }
}
} // namespace

Bytes PackData(vtkPolyData* data)
{
  // The arrays stay the caller's; only the lists of them are changed.
  vtkNew<vtkPolyData> copy;
  copy->ShallowCopy(data);
  const Bytes marks = MarkArrays(copy);
  vtkNew<vtkCharArray> buffer;
  if (!vtkCommunicator::MarshalDataObject(copy, buffer))
  {
    throw Error("A part of the mesh cannot be sent to another rank (process).");
  }
  Bytes bytes;
  AppendList(bytes, marks);
  AppendTo(bytes, buffer->GetPointer(0), static_cast<std::size_t>(buffer->GetNumberOfValues()));
  return bytes;
}

vtkSmartPointer<vtkPolyData> UnpackData(const char* from, std::size_t size)
{
  const char* const end = from + size;
  std::size_t marksSize = 0;
  TakeFrom(from, &marksSize, 1);
  // The bytes stay the caller's; neither the marks nor VTK's buffer is copied.
  const char* const marks = from;
  from += marksSize;
  vtkNew<vtkCharArray> buffer;
  buffer->SetArray(
    const_cast<char*>(from), static_cast<vtkIdType>(end - from), 1); // it stays the caller's
  auto data = vtkSmartPointer<vtkPolyData>::New();
  if (!vtkCommunicator::UnMarshalDataObject(buffer, data))
  {
    throw Error("A part of the mesh has not come from another rank (process).");
  }
  RestoreArrays(marks, from, data);
  return data;
}

void AnyValue::Append(Bytes& bytes, const vtkSmartPointer<vtkPolyData>& data)
{
  AppendList(bytes, data ? PackData(data) : Bytes());
}

void AnyValue::Take(const char*& from, vtkSmartPointer<vtkPolyData>& data)
{
  std::size_t size = 0;
  TakeFrom(from, &size, 1);
  data = size > 0 ? UnpackData(from, size) : nullptr;
  from += size;
}

} // namespace elevation
