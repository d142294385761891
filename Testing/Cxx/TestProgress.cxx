// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// On many points, the progress of the three filters rises in small steps, and after an abort,
// wherever it comes, at most two reports follow, and nothing is left. How much work is done between
// two reports is counted by the unit tests named Progress, which see the kernel; BenchmarkProgress
// measures how many seconds that takes, and a stop.
#include "Check.h"

#include "Inputs.h"
#include "vtkCallbackCommand.h"
#include "vtkFillElevationHoles.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTrimOutwardTriangles.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <utility>

namespace
{
constexpr double LargestStep = 0.25; // 1.5 times what was found
constexpr int MostAfterAbort = 2; // the report that it is noticed at, and one of the executive

struct Reports
{
  double Last = 0.0, Step = 0.0, StepAt = 0.0, AbortAt = 2.0;
  int Number = 0, AfterAbort = -1; ///< -1: there was none
  bool Falls = false;

  void Add(double progress)
  {
    if (progress - this->Last > this->Step)
    {
      this->Step = progress - this->Last;
      this->StepAt = this->Last;
    }
    this->Falls = this->Falls || progress < this->Last;
    this->Last = progress;
    ++this->Number;
    this->AfterAbort += this->AfterAbort >= 0 ? 1 : 0;
  }
};

/** Updates a filter, and returns what it reported. */
Reports Watch(vtkPolyDataAlgorithm* filter, double abortAt = 2.0)
{
  Reports reports;
  reports.AbortAt = abortAt;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&reports);
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    auto* const seen = static_cast<Reports*>(data);
    auto* const observed = vtkAlgorithm::SafeDownCast(caller);
    // The executive reports 0 before and 1 after the filter.
    if (observed->GetProgress() > 0.0)
    {
      seen->Add(observed->GetProgress());
    }
    if (observed->GetProgress() >= seen->AbortAt && seen->AfterAbort < 0)
    {
      observed->SetAbortExecute(1);
      seen->AfterAbort = 0;
    }
  });
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, command);
  filter->Modified();
  filter->Update();
  filter->RemoveObserver(tag);
  filter->SetAbortExecute(0); // newer VTKs keep it
  return reports;
}

void CheckReports(vtkPolyDataAlgorithm* filter, const std::string& name)
{
  const Reports reports = Watch(filter);
  std::cout << name << ": " << reports.Number << " reports, largest step " << reports.Step << "\n";
  Check(!reports.Falls && reports.Last == 1.0, name + ": progress rises to 1");
  Check(reports.Step <= LargestStep, name + ": a step of " + std::to_string(reports.Step) +
      " at " + std::to_string(reports.StepAt));
}

/** An abort early, midway or late stops at the next report and leaves nothing. */
void CheckAborts(vtkPolyDataAlgorithm* filter, const std::string& name)
{
  for (const double at : { 0.05, 0.3, 0.55, 0.8, 0.97 })
  {
    const Reports reports = Watch(filter, at);
    Check(filter->GetOutput()->GetNumberOfPoints() == 0,
      name + ": an abort at " + std::to_string(at) + " leaves nothing");
    Check(reports.AfterAbort >= 0 && reports.AfterAbort <= MostAfterAbort,
      name + ": " + std::to_string(reports.AfterAbort) + " reports after an abort at " +
        std::to_string(at));
  }
}

vtkSmartPointer<vtkPolyData> MakeCloud(vtkIdType count)
{
  return RandomCloud(19, count, 1000.0, VTK_FLOAT, [](double x, double y) {
    return std::hypot(x - 400.0, y - 600.0) > 30.0 ? std::sin(0.01 * x) : std::nan("");
  });
}

/** A limit that leaves nothing: the advice, for which all is triangulated again, has its share. */
void CheckAdvice()
{
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(MakeCloud(200000));
  delaunay->SetMaximumEdgeLength(0.001);
  delaunay->SetNumberOfThreads(1);
  delaunay->GlobalWarningDisplayOff();
  int before = 0, after = 0; // reports
  const auto counts = std::make_pair(&before, &after);
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(const_cast<std::pair<int*, int*>*>(&counts));
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    const auto* const seen = static_cast<std::pair<int*, int*>*>(data);
    const double progress = vtkAlgorithm::SafeDownCast(caller)->GetProgress();
    *seen->first += progress > 0.915 && progress < 0.99 ? 1 : 0;
    *seen->second += progress == 1.0 ? 1 : 0;
  });
  delaunay->AddObserver(vtkCommand::ProgressEvent, command);
  delaunay->Modified();
  delaunay->Update();
  delaunay->GlobalWarningDisplayOn();
  Check(before >= 8 && after <= 3, "the advice reports " + std::to_string(before) +
      " times while it works, " + std::to_string(after) + " times at the end");
}
} // namespace

int TestProgress(int, char*[])
{
  CheckAdvice();
  const auto ring = RingAround(
    500.0, 500.0, 2000, [](double angle) { return 450.0 + 40.0 * std::sin(9.0 * angle); });
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(MakeCloud(400000));
  delaunay->SetNumberOfThreads(1);
  vtkNew<vtkTrimOutwardTriangles> extracted, given;
  extracted->SetInputConnection(delaunay->GetOutputPort());
  extracted->SetNumberOfThreads(1);
  given->SetInputConnection(delaunay->GetOutputPort());
  given->SetBoundaryData(ring);
  given->SetNumberOfThreads(1);
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputConnection(extracted->GetOutputPort());
  fill->SetNumberOfThreads(1);
  for (const auto& [filter, name] :
    std::initializer_list<std::pair<vtkPolyDataAlgorithm*, const char*>>{
      { delaunay, "vtkGridDelaunay2D" }, { extracted, "vtkTrimOutwardTriangles, extracted" },
      { given, "vtkTrimOutwardTriangles, given" }, { fill, "vtkFillElevationHoles" } })
  {
    CheckAborts(filter, name);
    CheckReports(filter, name); // a whole run: the next filter has its result
  }
  return failures > 0;
}
