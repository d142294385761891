// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Arrays of a data set to which points or cells are added. Private to the module.
 */
#ifndef ExtendedArrays_h
#define ExtendedArrays_h

#include "Kernel/Types.h"

#include "vtkAbstractArray.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkMath.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cstring>
#include <new>

namespace elevation
{

inline bool IsFloatingPoint(vtkAbstractArray* array)
{
  return array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
}

inline bool IsGhostArray(vtkAbstractArray* array)
{
  return array->GetName() && !std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName());
}

/** The tuples of @a input, and behind them as many as are missing: NaN, 0 or nothing. */
inline vtkSmartPointer<vtkAbstractArray> Extend(
  vtkAbstractArray* input, vtkIdType more, const Progress& progress)
{
  const vtkIdType count = input->GetNumberOfTuples();
  auto output = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(input->GetDataType()));
  output->SetName(input->GetName());
  output->SetNumberOfComponents(input->GetNumberOfComponents());
  output->CopyComponentNames(input);
  output->CopyInformation(input->GetInformation(), /*deep=*/1);
  if (vtkDataArray* numbers = vtkArrayDownCast<vtkDataArray>(output.Get()))
  {
    numbers->SetLookupTable(vtkArrayDownCast<vtkDataArray>(input)->GetLookupTable());
  }
  output->SetNumberOfTuples(count + more);
  if (output->GetNumberOfTuples() != count + more)
  {
    throw std::bad_alloc();
  }
  const std::size_t all = static_cast<std::size_t>(count + more);
  constexpr vtkIdType block = 65536; // at a time, to report between
  for (vtkIdType i = 0; i < count; i += block)
  {
    ReportStep(progress, static_cast<std::size_t>(i), all);
    output->InsertTuples(i, std::min(block, count - i), i, input);
  }
  if (vtkDataArray* numbers = vtkArrayDownCast<vtkDataArray>(output.Get()))
  {
    const double value = IsFloatingPoint(output) ? vtkMath::Nan() : 0.0;
    for (vtkIdType i = count; i < count + more; ++i)
    {
      ReportStep(progress, static_cast<std::size_t>(i), all);
      for (int c = 0; c < output->GetNumberOfComponents(); ++c)
      {
        numbers->SetComponent(i, c, value);
      }
    }
  }
  return output;
}

/**
 * All arrays of the input, extended by @a more tuples, which fill(input array, output array,
 * progress) sets.
 */
template <typename Fill>
void PassExtended(vtkDataSetAttributes* input, vtkIdType more, vtkDataSetAttributes* output,
  const Progress& progress, Fill&& fill)
{
  if (more == 0)
  {
    output->PassData(input);
    return;
  }
  for (int i = 0; i < input->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* before = input->GetAbstractArray(i);
    const double count = input->GetNumberOfArrays();
    const Progress ofArray = Part(progress, i / count, (i + 1) / count);
    const vtkSmartPointer<vtkAbstractArray> after = Extend(before, more, Part(ofArray, 0.0, 0.5));
    fill(before, after, Part(ofArray, 0.5, 1.0));
    const int index = output->AddArray(after);
    for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
    {
      // Values repeat from here on, so they are no global ids any more.
      if (type != vtkDataSetAttributes::GLOBALIDS && input->GetAbstractAttribute(type) == before)
      {
        output->SetActiveAttribute(index, type);
      }
    }
  }
}

} // namespace elevation

#endif
