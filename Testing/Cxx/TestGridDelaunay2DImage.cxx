// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A picture of vtkGridDelaunay2D: a lattice with a round void, in the left half every node, in the
// right half every other; with a limit on the edge length that leaves the void open. On the lattice
// all squares are cut the same way, from their lowest corner.
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

int TestGridDelaunay2DImage(int argc, char* argv[])
{
  vtkNew<vtkPoints> points;
  for (int y = 0; y <= 16; ++y)
  {
    for (int x = 0; x <= 16; ++x)
    {
      const bool isCoarse = x > 8 && (x % 2 || y % 2);
      const bool isVoid = (x - 5) * (x - 5) + (y - 8) * (y - 8) < 9;
      if (!isCoarse && !isVoid)
      {
        points->InsertNextPoint(x, y, 0.0);
      }
    }
  }
  vtkNew<vtkPolyData> input;
  input->SetPoints(points);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(input);
  delaunay->SetMaximumEdgeLength(3.0);

  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(delaunay->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(1.0, 0.9, 0.2);
  actor->GetProperty()->SetEdgeVisibility(true);
  actor->GetProperty()->SetEdgeColor(0.0, 0.0, 0.0);
  actor->GetProperty()->SetLineWidth(2.0);
  actor->GetProperty()->LightingOff();

  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  renderer->SetBackground(0.1, 0.2, 0.5);
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
