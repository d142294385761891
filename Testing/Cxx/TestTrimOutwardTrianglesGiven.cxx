// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A lattice trimmed along given rings, nested three deep, whose edges mostly are not in the
// lattice. Kept triangles are yellow, outward ones blue, the boundary is red.
#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
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

int TestTrimOutwardTrianglesGiven(int argc, char* argv[])
{
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 17 * 17; ++i)
  {
    points->InsertNextPoint(i % 17, i / 17, 0.0);
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);

  vtkNew<vtkCellArray> rings;
  const auto at = [](vtkIdType x, vtkIdType y) { return x + 17 * y; };
  rings->InsertNextCell({ at(1, 2), at(14, 1), at(16, 13), at(8, 10), at(3, 16) });
  rings->InsertNextCell({ at(4, 4), at(5, 9), at(13, 9), at(12, 3) });
  rings->InsertNextCell({ at(6, 5), at(11, 5), at(7, 8) });
  vtkNew<vtkPolyData> boundary;
  boundary->SetPoints(points);
  boundary->SetPolys(rings);
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputConnection(delaunay->GetOutputPort());
  trim->SetBoundaryData(boundary);

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
