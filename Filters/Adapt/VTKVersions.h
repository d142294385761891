// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What differs between the versions of VTK: every version check of the library is here. Private to
 * the module. Where a call exists in all versions from 9.1 on, that call is used instead.
 */
#ifndef VTKVersions_h
#define VTKVersions_h

#include "vtkAbstractArray.h"
#include "vtkAlgorithm.h"
#include "vtkInformation.h"
#include "vtkVersionMacros.h"

namespace elevation
{

/**
 * Whether a filter is to stop. Since VTK 9.3 (and ParaView 5.11) also when a filter before it in
 * the pipeline has been asked to, and the executive learns that the output is not complete.
 */
inline bool IsAbortRequested(vtkAlgorithm* filter)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20230111)
  return filter->CheckAbort();
#else
  return filter->GetAbortExecute() != 0;
#endif
}

/**
 * Forgets that a filter was asked to stop, before work that no executive begins: an executive does
 * so itself. Since VTK 9.3 a filter also remembers that its last output is not complete.
 */
inline void ForgetAbort(vtkAlgorithm* filter)
{
  filter->SetAbortExecute(0);
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20230111)
  filter->SetAbortOutput(false);
#endif
}

/**
 * Makes the executive take the outputs of this execution for incomplete, although nobody may have
 * asked this filter itself to stop: a filter before it or on another rank was. Since VTK 9.3 that
 * is said without AbortExecute, which nobody but who has set it would ever take back.
 */
inline void MarkIncomplete(vtkAlgorithm* filter)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20230111)
  filter->SetAbortOutput(true);
#else
  filter->SetAbortExecute(1);
#endif
}

/** Whether what comes by this connection is incomplete: a filter before was stopped. */
inline bool IsIncomplete(vtkInformation* input)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20230111)
  return input->Get(vtkAlgorithm::ABORTED()) != 0;
#else
  static_cast<void>(input); // empty, and nothing more is known
  return false;
#endif
}

/** Makes room for tuples, more than there are, and keeps the values. */
inline void ReserveTuples(vtkAbstractArray* array, vtkIdType count)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 7, 0)
  array->ReserveTuples(count);
#else
  array->Resize(count);
#endif
}

} // namespace elevation

#endif
