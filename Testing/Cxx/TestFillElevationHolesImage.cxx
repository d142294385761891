// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A picture of vtkFillElevationHoles: a sheet with a notched outline and six holes: a large
// one with an island, one that a corner of the surface pinches, two that share a vertex, a
// channel, and one above the limit on edges, which stays open. New triangles are coloured
// by hole, rims are drawn.
#include "SheetOfSquares.h"
#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkFillElevationHoles.h"
#include "vtkLookupTable.h"
#include "vtkNew.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRegressionTestImage.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"

int TestFillElevationHolesImage(int argc, char* argv[])
{
  auto sheet = MakeFlatSheet({
    "####  ##############",
    "####  ##############",
    "#     #####  #######",
    "#######   #  ###   #",
    "##    #   ######   #",
    "##    ###  ####   ##",
    "## ## ###  ####   ##",
    "##    ##########   #",
    "##    ##############",
    "########           #",
    "#       ########## #",
    "# ##### ##       # #",
    "# ##### ########## #",
    "# #   # #        # #",
    "# # ### # ######## #",
    "# #   # #          #",
    "# ##### ############",
    "#       ######  ####",
    "##############  ####",
    "###########     ####",
  });
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(sheet);
  fill->SetMaximumHoleEdges(70);

  vtkNew<vtkLookupTable> colors;
  const double palette[10][3] = { { 0.95, 0.95, 0.9 }, { 0.9, 0.1, 0.1 }, { 0.1, 0.6, 0.1 },
    { 0.2, 0.3, 0.9 }, { 0.9, 0.6, 0.0 }, { 0.6, 0.1, 0.7 }, { 0.0, 0.7, 0.7 }, { 0.5, 0.4, 0.2 },
    { 0.9, 0.4, 0.7 }, { 0.4, 0.8, 0.2 } };
  colors->SetNumberOfTableValues(10);
  for (int i = 0; i < 10; ++i)
  {
    colors->SetTableValue(i, palette[i][0], palette[i][1], palette[i][2]);
  }
  colors->SetTableRange(-1.5, 8.5);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(fill->GetOutputPort());
  mapper->SetScalarModeToUseCellFieldData();
  mapper->SelectColorArray("HoleId");
  mapper->SetLookupTable(colors);
  mapper->UseLookupTableScalarRangeOn();
  vtkNew<vtkActor> surface;
  surface->SetMapper(mapper);
  surface->GetProperty()->EdgeVisibilityOn();
  surface->GetProperty()->SetEdgeColor(0.0, 0.0, 0.0);
  surface->GetProperty()->LightingOff();

  vtkNew<vtkPolyDataMapper> lineMapper;
  lineMapper->SetInputConnection(fill->GetOutputPort(1));
  lineMapper->ScalarVisibilityOff();
  vtkNew<vtkActor> rims;
  rims->SetMapper(lineMapper);
  rims->GetProperty()->SetColor(1.0, 1.0, 0.0);
  rims->GetProperty()->SetLineWidth(4.0);
  rims->GetProperty()->LightingOff();
  rims->SetPosition(0.0, 0.0, 0.1);

  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(surface);
  renderer->AddActor(rims);
  renderer->SetBackground(0.1, 0.2, 0.5);
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  window->SetSize(500, 500);
  window->AddRenderer(renderer);
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(window);
  renderer->GetActiveCamera()->ParallelProjectionOn();
  renderer->GetActiveCamera()->SetPosition(10.0, 10.0, 50.0);
  renderer->GetActiveCamera()->SetFocalPoint(10.0, 10.0, 0.0);
  renderer->GetActiveCamera()->SetParallelScale(10.5);
  renderer->ResetCameraClippingRange();
  window->Render();
  const int result = vtkRegressionTestImage(window);
  if (result == vtkRegressionTester::DO_INTERACTOR)
  {
    interactor->Start();
  }
  return !result;
}
