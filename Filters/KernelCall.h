// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How a filter calls the kernel: progress and abort go in, exceptions come out as one VTK error and
 * empty output. Private to the module.
 */
#ifndef KernelCall_h
#define KernelCall_h

#include "Kernel/Base/Base.h"
#include "VTKVersions.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkSetGet.h"

#include <algorithm>
#include <chrono>
#include <new>

namespace elevation
{

/**
 * The kernel's Progress for a filter: its progress and abort flag. The kernel reports as often as
 * suits its loops; observers, which may be slow, are called at each thousandth of the work, and at
 * least every 50 ms.
 */
inline Progress ProgressOf(vtkAlgorithm* filter)
{
  using Clock = std::chrono::steady_clock;
  return [filter, last = -1.0, next = Clock::time_point()](double fraction) mutable {
    constexpr double step = 0.001;
    constexpr std::chrono::milliseconds silence{ 50 };
    const Clock::time_point now = Clock::now();
    if (fraction >= std::min(1.0, last + step) || now >= next)
    {
      last = fraction;
      next = now + silence;
      filter->UpdateProgress(fraction);
    }
    return !IsAbortRequested(filter);
  };
}

/**
 * Runs the body of a RequestData. When it throws, every output is emptied; anything but an abort is
 * reported as one error of the filter.
 * @return what RequestData returns: always 1, because on 0 the executive adds an error of its own
 *         that tells the user nothing.
 */
template <typename Body>
int CallKernel(vtkAlgorithm* filter, vtkInformationVector* outputs, Body&& body)
{
  std::string message;
  try
  {
    body();
    return 1;
  }
  catch (const Aborted&)
  {
  }
  catch (const std::bad_alloc&)
  {
    message = "There is not enough memory for this input.";
  }
  catch (const std::exception& error)
  {
    message = error.what();
  }
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject::GetData(outputs, port)->Initialize();
  }
  if (!message.empty())
  {
    vtkErrorWithObjectMacro(filter, << message);
  }
  return 1;
}

/** Adds a count to the field data, as an array of one value. */
inline void AddCount(vtkFieldData* fieldData, const char* name, vtkIdType count)
{
  vtkNew<vtkIdTypeArray> array;
  array->SetName(name);
  array->InsertNextValue(count);
  fieldData->AddArray(array);
}

} // namespace elevation

#endif
