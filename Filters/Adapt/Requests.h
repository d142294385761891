// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A filter's answer to a request of the pipeline: its progress, abort and errors, and counts in the
 * field data. Private to the module.
 */
#ifndef Requests_h
#define Requests_h

#include "Kernel/Base/Base.h"
#include "VTKClasses.h"

#include "vtkDemandDrivenPipeline.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkType.h"

#include <exception>
#include <utility>
#include <vector>

namespace elevation
{

/** Reports a failure of a request as ReportMessages() does, and empties the outputs. */
void EndWithError(vtkAlgorithm* filter, vtkInformationVector* outputs,
  const std::exception& failure, vtkStringArray* messages);

/**
 * What ProcessRequest returns after an error that has been reported: 0. The executive then adds a
 * line that does not help the user; it is kept from the output window, but observers of the
 * executive get it. In ParaView it is 1: after a request that has failed, ParaView 5.11 never
 * updates the picture of this output again.
 */
int AfterError(vtkAlgorithm* filter);

/**
 * Answers a request of the pipeline. An exception that would leave the filter, as when there is no
 * memory even for what surrounds FilterRun::Run(), becomes an error: after an exception VTK takes
 * the filter to be at work for ever, and runs it no more.
 * @param[out] errorCode  the filter's; that of the last request for data
 * @param[in] answer  returns 0 after an error that has been reported
 */
template <typename Answer>
int Guarded(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector* outputs,
  vtkStringArray* messages, unsigned long& errorCode, Answer&& answer)
{
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
  {
    errorCode = vtkErrorCode::NoError;
  }
  try
  {
    if (const int result = answer())
    {
      return result;
    }
  }
  catch (const std::exception& error)
  {
    EndWithError(filter, outputs, error, messages);
  }
  errorCode = vtkErrorCode::UnknownError;
  return AfterError(filter);
}

/**
 * The kernel's Progress for a filter: its progress and abort flag. The kernel reports as often as
 * suits its loops; observers, which may be slow, are called at each thousandth of the work, and at
 * least every 50 ms.
 */
Progress ProgressOf(vtkAlgorithm* filter);

/**
 * Marks a data set as the output of a filter of this module, which has reported why there are no
 * triangles, if there are none. The mark is in the object's information, which no array can fake.
 */
void MarkAsReported(vtkDataObject* output);
/** Marks a copy if the original is marked. */
void CopyMark(vtkDataObject* original, vtkDataObject* copy);
/** Whether a mesh without triangles needs a warning: it has points, and no mark. */
bool NeedsWarning(vtkPolyData* meshWithoutTriangles);

/** @throws Error if it is no NumberOfThreads of a filter */
void CheckThreads(int threads);

/** Adds a count to the field data, as an array of one value. */
void AddCount(vtkFieldData* fieldData, const char* name, vtkIdType count);
/** Adds counts with names, as an array of one tuple. */
void AddTuple(vtkFieldData* fieldData, const char* name,
  const std::vector<std::pair<const char*, vtkIdType>>& counts);

} // namespace elevation

#endif
