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
 * Answers a request of the pipeline. An exception that would leave the filter, as when there is no
 * memory even for what surrounds FilterRun::Run(), becomes an error: after an exception VTK takes
 * the filter to be at work for ever, and runs it no more.
 * @param[in] answer  returns what ProcessRequest returns; after an error that is 1, as Run() says
 */
template <typename Answer>
int Guarded(
  vtkAlgorithm* filter, vtkInformationVector* outputs, vtkStringArray* messages, Answer&& answer)
{
  try
  {
    return answer();
  }
  catch (const std::exception& error)
  {
    EndWithError(filter, outputs, error, messages);
  }
  return 1;
}

/**
 * The kernel's Progress for a filter: its progress and abort flag. The kernel reports as often as
 * suits its loops; observers, which may be slow, are called at each thousandth of the work, and at
 * least every 50 ms.
 */
Progress ProgressOf(vtkAlgorithm* filter);

/**
 * Whether a mesh without triangles needs a warning. It needs none where the filter before has told
 * why: a mesh without points comes of an error, and vtkGridDelaunay2D leaves its counts.
 */
bool NeedsWarning(vtkPolyData* meshWithoutTriangles);

/** @throws Error if the limit is no length */
void CheckMaximumEdgeLength(double length);

/** Adds a count to the field data, as an array of one value. */
void AddCount(vtkFieldData* fieldData, const char* name, vtkIdType count);
/** Adds counts with names, as an array of one tuple. */
void AddTuple(vtkFieldData* fieldData, const char* name,
  const std::vector<std::pair<const char*, vtkIdType>>& counts);

} // namespace elevation

#endif
