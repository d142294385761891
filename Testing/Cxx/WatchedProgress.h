// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The progress that a filter reports, and an abort at a part of it.
 */
#ifndef WatchedProgress_h
#define WatchedProgress_h

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkNew.h"

#include <algorithm>

class WatchedProgress
{
public:
  double Last = 0.0;
  double LargestStep = 0.0;
  bool IsRising = true;

  explicit WatchedProgress(vtkAlgorithm* filter)
    : Filter(filter)
  {
    this->Callback->SetClientData(this);
    this->Callback->SetCallback([](vtkObject*, unsigned long, void* data, void*) {
      static_cast<WatchedProgress*>(data)->See();
    });
    filter->AddObserver(vtkCommand::ProgressEvent, this->Callback);
  }
  WatchedProgress(const WatchedProgress&) = delete;
  void operator=(const WatchedProgress&) = delete;

  /** Runs the filter again, and aborts when so much is done. */
  void AbortAt(double part)
  {
    this->Last = this->LargestStep = 0.0;
    this->IsRising = true;
    this->End = part;
    this->Filter->Modified();
    this->Filter->Update();
  }

private:
  void See()
  {
    const double done = this->Filter->GetProgress();
    this->IsRising = this->IsRising && done >= this->Last;
    this->LargestStep = std::max(this->LargestStep, done - this->Last);
    this->Last = done;
    if (done >= this->End)
    {
      this->Filter->SetAbortExecute(1);
    }
  }

  vtkAlgorithm* const Filter;
  double End = 2.0;
  vtkNew<vtkCallbackCommand> Callback;
};

#endif
