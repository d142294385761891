// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A cloud with a bay, a lake with an island and a lone point, trimmed along its own outline.
// Kept triangles are yellow, outward ones blue, the boundary is red.
#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRegressionTestImage.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkTrimOutwardTriangles.h"

int TestTrimOutwardTrianglesExtracted(int argc, char* argv[])
{
  vtkNew<vtkPoints> points;
  for (int y = 0; y <= 32; ++y)
  {
    for (int x = 0; x <= 32; ++x)
    {
      const int lake = (x - 11) * (x - 11) + (y - 17) * (y - 17);
      const bool isLake = lake < 80 && lake > 6;
      const bool isBay = x > 22 && y > 10 && y < 20;
      const bool isOutside = y > 28 - x / 8;
      // Half as dense at the bottom.
      const bool isLeftOut = y < 6 && (x % 2 || y % 2);
      if (!isLake && !isBay && !isOutside && !isLeftOut)
      {
        points->InsertNextPoint(0.5 * x, 0.5 * y, 0.0);
      }
    }
  }
  points->InsertNextPoint(12.0, 16.0, 0.0);
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputConnection(delaunay->GetOutputPort());

  const double colors[3][3] = { { 1.0, 0.9, 0.2 }, { 0.2, 0.4, 0.9 }, { 0.9, 0.0, 0.0 } };
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1.0, 1.0, 1.0);
  for (int port = 0; port < 3; ++port)
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(trim->GetOutputPort(port));
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(colors[port][0], colors[port][1], colors[port][2]);
    actor->GetProperty()->SetEdgeVisibility(port < 2);
    actor->GetProperty()->SetEdgeColor(0.0, 0.0, 0.0);
    actor->GetProperty()->SetLineWidth(port < 2 ? 1.0 : 4.0);
    actor->GetProperty()->LightingOff();
    actor->SetPosition(0.0, 0.0, port == 2 ? 1.0 : 0.0); // the boundary in front
    renderer->AddActor(actor);
  }
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  window->SetSize(300, 300);
  window->AddRenderer(renderer);
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(window);
  renderer->GetActiveCamera()->ParallelProjectionOn();
  renderer->GetActiveCamera()->SetPosition(8.0, 8.0, 50.0);
  renderer->GetActiveCamera()->SetFocalPoint(8.0, 8.0, 0.0);
  renderer->GetActiveCamera()->SetParallelScale(9.0);
  renderer->ResetCameraClippingRange();
  window->Render();
  const int result = vtkRegressionTestImage(window);
  if (result == vtkRegressionTester::DO_INTERACTOR)
  {
    interactor->Start();
  }
  return !result;
}
