// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The filters use the threads that vtkSMPTools has, and leave its settings as they are, also while
// several pipelines are at work.
#include "Check.h"

#include "Kernel/Base/Base.h"

#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"

#include <atomic>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

namespace
{
void TestThreadsAreThoseOfVTK()
{
  Check(vtkSMPTools::SetBackend("Sequential") && elevation::ResolveNumberOfThreads(0) == 1 &&
      elevation::ThreadsAtOnce(4) == 1,
    "Sequential is one thread, whatever is asked for");
  Check(vtkSMPTools::SetBackend("STDThread"), "there are threads");
  vtkSMPTools::Initialize(3);
  Check(elevation::ResolveNumberOfThreads(0) == 3 && elevation::ThreadsAtOnce(2) == 2 &&
      elevation::ThreadsAtOnce(100) == 3,
    "no more threads than Initialize() has set");
}

/** Runs two pipelines at once, and looks at the settings meanwhile. */
void TestSettingsStay(const std::string& backend, int threads)
{
  vtkSMPTools::SetBackend(backend.c_str());
  vtkSMPTools::Initialize(threads);
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 20000; ++i)
  {
    points->InsertNextPoint(std::cos(17.0 * i), std::sin(23.0 * i), 0.0);
  }
  constexpr int runs = 10;
  std::atomic<int> running{ 2 };
  std::vector<vtkIdType> triangles[2];
  const auto work = [&](int pipeline) {
    for (int run = 0; run < runs; ++run)
    {
      vtkNew<vtkPolyData> cloud;
      cloud->SetPoints(points);
      vtkNew<vtkGridDelaunay2D> delaunay;
      delaunay->SetInputData(cloud);
      delaunay->SetNumberOfThreads(1 + (run + pipeline) % 4);
      delaunay->Update();
      triangles[pipeline].push_back(delaunay->GetOutput()->GetNumberOfPolys());
    }
    --running;
  };
  std::thread first(work, 0), second(work, 1);
  bool isSame = true;
  while (running > 0)
  {
    isSame = isSame && vtkSMPTools::GetBackend() == backend &&
      (backend == "Sequential" || vtkSMPTools::GetEstimatedNumberOfThreads() == threads);
  }
  first.join();
  second.join();
  Check(isSame && vtkSMPTools::GetBackend() == backend, "settings stay: " + backend);
  Check(
    triangles[0] == triangles[1] && triangles[0] == std::vector<vtkIdType>(runs, triangles[0][0]),
    "and so do the triangles");
}
} // namespace

int TestThreads(int, char*[])
{
  TestThreadsAreThoseOfVTK();
  TestSettingsStay("Sequential", 0);
  TestSettingsStay("STDThread", 3);
  return failures > 0;
}
