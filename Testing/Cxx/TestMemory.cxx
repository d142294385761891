// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where memory ends while a filter looks for advice, its result stays, and the warning too.
#include "Check.h"
#include "FailingMemory.h"

#include "Inputs.h"
#include "vtkCallbackCommand.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkTestErrorObserver.h"

#include <string>

int TestMemory(int, char*[])
{
  const auto cloud = RandomCloud(23, 20000, 100.0, VTK_FLOAT, [](double, double) { return 1.0; });
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  delaunay->SetMaximumEdgeLength(0.5); // leaves some triangles
  vtkNew<vtkTest::ErrorObserver> observer;
  delaunay->AddObserver(vtkCommand::ErrorEvent, observer);
  delaunay->AddObserver(vtkCommand::WarningEvent, observer);
  delaunay->Update();
  const std::string advice = "keeps a triangle at 95 %";
  Check(observer->GetWarningMessage().find(advice) != std::string::npos, "there is advice");
  const vtkIdType triangles = delaunay->GetOutput()->GetNumberOfPolys();
  Check(triangles > 100, "there are triangles");

  observer->Clear();
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    const double progress = vtkAlgorithm::SafeDownCast(caller)->GetProgress();
    const bool isAdvising = progress > 0.9 && progress < 1.0;
    failing_memory::RefuseLarge(isAdvising ? 100000 : 0);
  });
  delaunay->AddObserver(vtkCommand::ProgressEvent, command);
  delaunay->Modified();
  delaunay->Update();
  failing_memory::RefuseLarge(0);
  const std::string warning = observer->GetWarningMessage();
  Check(!observer->GetError() && delaunay->GetOutput()->GetNumberOfPolys() == triangles,
    "without memory for the advice, the result stays");
  Check(warning.find("MaximumEdgeLength is 0.5, and ") != std::string::npos &&
      warning.find(advice) == std::string::npos,
    "the warning comes without the advice; it was: " + warning);
  return failures > 0;
}
