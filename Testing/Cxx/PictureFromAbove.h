// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Draws surfaces and lines seen from +z, without light, and compares the picture with its baseline.
 */
#ifndef PictureFromAbove_h
#define PictureFromAbove_h

#include "vtkActor.h"
#include "vtkAlgorithmOutput.h"
#include "vtkCamera.h"
#include "vtkLookupTable.h"
#include "vtkNew.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRegressionTestImage.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"

#include <array>
#include <vector>

using Color = std::array<double, 3>;

constexpr Color Yellow = { 1.0, 0.9, 0.2 };
constexpr Color Red = { 0.9, 0.1, 0.1 };
constexpr Color Blue = { 0.2, 0.4, 0.9 };
constexpr Color White = { 1.0, 1.0, 1.0 };
constexpr Color DarkBlue = { 0.1, 0.2, 0.5 };

inline vtkSmartPointer<vtkActor> MakeActor(vtkAlgorithmOutput* data, const Color& color)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(data);
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(color[0], color[1], color[2]);
  actor->GetProperty()->LightingOff();
  return actor;
}

/** Triangles in one colour with black edges. */
inline vtkSmartPointer<vtkActor> MakeSurface(vtkAlgorithmOutput* data, const Color& color)
{
  auto actor = MakeActor(data, color);
  actor->GetProperty()->EdgeVisibilityOn();
  actor->GetProperty()->SetEdgeColor(0.0, 0.0, 0.0);
  return actor;
}

/** Thick lines, lifted in front of surfaces. */
inline vtkSmartPointer<vtkActor> MakeLines(vtkAlgorithmOutput* data, const Color& color)
{
  auto actor = MakeActor(data, color);
  actor->GetProperty()->SetLineWidth(4.0);
  actor->SetPosition(0.0, 0.0, 1.0);
  return actor;
}

/** Colours triangles by their HoleId; the first colour is that of -1, no hole. */
inline void ColorByHole(vtkActor* surface, const std::vector<Color>& colors)
{
  const int count = static_cast<int>(colors.size());
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(count);
  for (int i = 0; i < count; ++i)
  {
    table->SetTableValue(i, colors[i][0], colors[i][1], colors[i][2]);
  }
  table->SetTableRange(-1.5, count - 1.5);
  vtkMapper* mapper = surface->GetMapper();
  mapper->ScalarVisibilityOn();
  mapper->SetScalarModeToUseCellFieldData();
  mapper->SelectColorArray("HoleId");
  mapper->SetLookupTable(table);
  mapper->UseLookupTableScalarRangeOn();
}

/** The outputs of vtkTrimOutwardTriangles: kept yellow, outward blue, the boundary red. */
inline std::vector<vtkSmartPointer<vtkActor>> MakeTrimmed(vtkAlgorithm* trim)
{
  return { MakeSurface(trim->GetOutputPort(0), Yellow), MakeSurface(trim->GetOutputPort(1), Blue),
    MakeLines(trim->GetOutputPort(2), { 0.9, 0.0, 0.0 }) };
}

/** The square that is seen, and the picture made of it. */
struct View
{
  double Middle;    ///< x and y of its middle
  double HalfWidth; ///< in units of the data
  int Pixels;       ///< width and height of the picture
  Color Background;
};

/**
 * Whether the picture of the actors is that of the baseline. With -I on the test's command line it
 * stays on the screen.
 */
inline bool MatchesBaseline(
  int argc, char* argv[], const std::vector<vtkSmartPointer<vtkActor>>& actors, const View& view)
{
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(view.Background[0], view.Background[1], view.Background[2]);
  for (const auto& actor : actors)
  {
    renderer->AddActor(actor);
  }
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  window->SetSize(view.Pixels, view.Pixels);
  window->AddRenderer(renderer);
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(window);
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetPosition(view.Middle, view.Middle, 90.0);
  camera->SetFocalPoint(view.Middle, view.Middle, 0.0);
  camera->SetParallelScale(view.HalfWidth);
  renderer->ResetCameraClippingRange();
  window->Render();
  const int result = vtkRegressionTestImage(window);
  if (result == vtkRegressionTester::DO_INTERACTOR)
  {
    interactor->Start();
  }
  return result != vtkRegressionTester::FAILED;
}

#endif
