// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Two pictures of one ridge with a hole across it, coloured by bands of elevation. Below, the
// membrane sags between the two ends of the ridge; above, the thin plate carries it on. Rims are
// drawn.
#include "PictureFromAbove.h"
#include "SheetOfSquares.h"
#include "vtkElevationFilter.h"
#include "vtkFillElevationHoles.h"
#include "vtkNew.h"

#include <cmath>
#include <cstdlib>

namespace
{
/** A sheet of 40 x 19 squares, a disc of 7 lost in its middle; a ridge 3 high along its middle. */
vtkSmartPointer<vtkPolyData> MakeRidge()
{
  std::vector<std::string> picture(19, std::string(40, '#'));
  for (int y = 0; y < 19; ++y)
  {
    for (int x = 0; x < 40; ++x)
    {
      picture[y][x] = std::hypot(x - 19.5, y - 9.0) < 7.0 ? ' ' : '#';
    }
  }
  return MakeSheet(picture, VTK_DOUBLE,
    [](double, double y) { return 3.0 * std::exp(-0.02 * (y - 9.5) * (y - 9.5)); });
}
} // namespace

int TestFillElevationHolesRidge(int argc, char* argv[])
{
  vtkNew<vtkLookupTable> bands;
  bands->SetNumberOfTableValues(12);
  for (int i = 0; i < 12; ++i)
  {
    const double share = i / 11.0;
    const double tone = i % 2 ? 1.0 : 0.6;
    bands->SetTableValue(
      i, tone * (0.2 + 0.8 * share), tone * (0.5 + 0.3 * share), tone * (0.9 - 0.8 * share));
  }
  std::vector<vtkSmartPointer<vtkActor>> actors;
  const int methods[] = { vtkFillElevationHoles::MEMBRANE, vtkFillElevationHoles::THIN_PLATE };
  vtkNew<vtkFillElevationHoles> fills[2];
  vtkNew<vtkElevationFilter> elevations[2];
  for (int i = 0; i < 2; ++i)
  {
    fills[i]->SetInputData(MakeRidge());
    fills[i]->SetInterpolation(methods[i]);
    elevations[i]->SetInputConnection(fills[i]->GetOutputPort());
    elevations[i]->SetLowPoint(0.0, 0.0, 0.0);
    elevations[i]->SetHighPoint(0.0, 0.0, 3.3);
    auto surface = MakeActor(elevations[i]->GetOutputPort(), White);
    surface->GetMapper()->ScalarVisibilityOn();
    surface->GetMapper()->SetLookupTable(bands);
    surface->GetMapper()->InterpolateScalarsBeforeMappingOn();
    auto rim = MakeLines(fills[i]->GetOutputPort(1), { 0.8, 0.0, 0.0 });
    surface->AddPosition(0.0, 21.0 * i, 0.0);
    rim->AddPosition(0.0, 21.0 * i, 3.0);
    actors.push_back(surface);
    actors.push_back(rim);
  }
  return MatchesBaseline(argc, argv, actors, { 20.0, 21.0, 420, DarkBlue }) ? EXIT_SUCCESS
                                                                            : EXIT_FAILURE;
}
