// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests.h"

#include "ReportMessages.h"
#include "VTKVersions.h"

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkDataObject.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

#include <algorithm>

namespace elevation
{

/*
 * VTK's progress must not fall; an abort is asked for at each report, the observer is called as
 * ReportPace admits.
 */
Progress ProgressOf(vtkAlgorithm* filter)
{
  return [filter, last = 0.0, pace = ReportPace()](double fraction) mutable {
    last = std::max(fraction, last); // where work begins anew, as ranks gather after all
    if (pace.Admits(last, ReportPace::Clock::now()))
    {
      filter->UpdateProgress(last);
    }
    return !IsAbortRequested(filter);
  };
}

void EndWithError(vtkAlgorithm* filter, vtkInformationVector* outputs,
  const std::exception& failure, vtkStringArray* messages)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* const output = vtkDataObject::GetData(outputs, port))
    {
      output->Initialize();
    }
  }
  ReportMessages(filter, { MessageOf(failure) }, {}, messages);
}

namespace
{
vtkInformationIntegerKey* IsReportedKey()
{
  // Made once and never freed: VTK keeps keys until the program ends.
  static auto* const key = vtkInformationIntegerKey::MakeKey("IS_REPORTED", "ElevationSurface");
  return key;
}
} // namespace

// The line is "Algorithm ... returned failure for request", with all of the request.
int AfterError(vtkAlgorithm* filter)
{
  vtkExecutive* const executive = filter->GetExecutive();
  if (executive->IsA("vtkPVCompositeDataPipeline"))
  {
    return 1;
  }
  // Where there is an observer, VTK leaves the output window alone. Without GlobalWarningDisplay
  // there is no line, and the observer would stay.
  if (vtkObject::GetGlobalWarningDisplay())
  {
    vtkNew<vtkCallbackCommand> once;
    // The observer goes with the one line that it has kept from the window.
    once->SetCallback([](vtkObject* caller, unsigned long, void* self, void*) {
      caller->RemoveObserver(static_cast<vtkCommand*>(self));
    });
    once->SetClientData(once.Get());
    executive->AddObserver(vtkCommand::ErrorEvent, once);
  }
  return 0;
}

void MarkAsReported(vtkDataObject* output)
{
  output->GetInformation()->Set(IsReportedKey(), 1);
}

void CopyMark(vtkDataObject* original, vtkDataObject* copy)
{
  copy->GetInformation()->CopyEntry(original->GetInformation(), IsReportedKey());
}

/*
 * Points without triangles are most often those of a file that was meant to go through
 * vtkGridDelaunay2D first.
 */
bool NeedsWarning(vtkPolyData* meshWithoutTriangles)
{
  return meshWithoutTriangles->GetNumberOfPoints() > 0 &&
    !meshWithoutTriangles->GetInformation()->Has(IsReportedKey());
}

void CheckThreads(int threads)
{
  constexpr int most = 1024;
  if (threads < 0 || threads > most)
  {
    throw MakeError<sentences::InvalidThreads>(threads, most);
  }
}

// An array of this name that came with the input is replaced.
void AddCount(vtkFieldData* fieldData, const char* name, vtkIdType count)
{
  vtkNew<vtkIdTypeArray> array;
  array->SetName(name);
  array->InsertNextValue(count);
  fieldData->AddArray(array);
}

void AddTuple(vtkFieldData* fieldData, const char* name,
  const std::vector<std::pair<const char*, vtkIdType>>& counts)
{
  vtkNew<vtkIdTypeArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(static_cast<int>(counts.size()));
  for (const auto& [component, count] : counts)
  {
    // The number of values so far is the component that comes next.
    array->SetComponentName(array->GetNumberOfValues(), component);
    array->InsertNextValue(count);
  }
  fieldData->AddArray(array);
}

} // namespace elevation
