// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What vtkFillElevationHoles refuses and what it passes on as it is, and what errors and aborts
// leave behind.
#include "Check.h"
#include "FaultyCells.h"
#include "SheetOfSquares.h"
#include "SheetsWithHoles.h"
#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkFillElevationHoles.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkTestErrorObserver.h"

#include <cmath>
#include <cstdlib>
#include <string>

namespace
{
/**
 * The message of the error that the filter gives for an input; checks that its outputs are empty.
 */
std::string Refusal(vtkPolyData* input)
{
  vtkNew<vtkTest::ErrorObserver> observer;
  vtkNew<vtkFillElevationHoles> fill;
  fill->AddObserver(vtkCommand::ErrorEvent, observer);
  fill->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, observer);
  fill->SetInputData(input);
  fill->Update();
  for (int port = 0; port < 2; ++port)
  {
    Check(fill->GetOutput(port)->GetNumberOfPoints() == 0, "an error leaves no points");
    Check(fill->GetOutput(port)->GetNumberOfCells() == 0, "an error leaves no cells");
  }
  Check(fill->GetNumberOfHoles() == 0, "an error leaves no counts");
  return observer->GetErrorMessage();
}

void TestRefusals()
{
  const auto names = [](const std::string& message, const std::string& what) {
    Check(message.find(what) != std::string::npos, "'" + message + "' names " + what);
  };
  // A vertex first: cell ids are not numbers of polygons.
  vtkNew<vtkCellArray> vertices;
  const vtkIdType vertex[1] = { 0 };
  vertices->InsertNextCell(1, vertex);

  auto quad = MakeFlatSheet({ "##" });
  quad->SetVerts(vertices);
  const vtkIdType corners[4] = { 0, 1, 2, 3 };
  quad->GetPolys()->InsertNextCell(4, corners);
  names(Refusal(quad), "Cell 5");

  auto folded = MakeFlatSheet({ "##" });
  folded->SetVerts(vertices);
  const vtkIdType over[3] = { folded->GetPoints()->InsertNextPoint(0.2, 0.3, 1.0),
    folded->GetPoints()->InsertNextPoint(1.2, 0.3, 1.0),
    folded->GetPoints()->InsertNextPoint(1.2, 0.6, 1.0) };
  folded->GetPolys()->InsertNextCell(3, over);
  names(Refusal(folded), "Cell 5");

  auto fan = MakeFlatSheet({ "#" });
  fan->SetVerts(vertices);
  const vtkIdType third[3] = { 0, 2, fan->GetPoints()->InsertNextPoint(0.5, 2.0, 0.0) };
  fan->GetPolys()->InsertNextCell(3, third);
  names(Refusal(fan), "Cell 3");

  auto wall = MakeFlatSheet({ "#" });
  const vtkIdType upright[3] = { 0, 1, wall->GetPoints()->InsertNextPoint(0.5, 0.0, 9.0) };
  wall->GetPolys()->InsertNextCell(3, upright);
  names(Refusal(wall), "Cell 2");

  auto nan = MakeSheet({ "#" }, VTK_DOUBLE, [](int x, int) { return x / 0.0 - x / 0.0; });
  names(Refusal(nan), "finite");

  auto strip = MakeFlatSheet({ "#" });
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell(4, corners);
  strip->SetStrips(strips);
  names(Refusal(strip), "strip");

  for (const int size : { 0, 3, 10000 })
  {
    vtkNew<vtkIntArray> values;
    values->SetName("Picks");
    values->SetNumberOfTuples(size);
    values->Fill(1);
    auto points = MakeFlatSheet(OneHole);
    points->GetPointData()->AddArray(values);
    names(Refusal(points),
      "Point array \"Picks\" has " + std::to_string(size) + " tuples, but there are 38 points.");
    auto cells = MakeFlatSheet(OneHole);
    cells->GetCellData()->AddArray(values);
    names(Refusal(cells),
      "Cell array \"Picks\" has " + std::to_string(size) + " tuples, but there are 42 cells.");
  }

  ForEachFaultyCells([&](const auto& spoil, const std::string& kind, const std::string& fault) {
    auto faulty = MakeFlatSheet(OneHole);
    spoil(faulty);
    names(Refusal(faulty), "The " + kind);
    names(Refusal(faulty), fault);
  });
}

/** What FilledError holds by each method. */
void TestErrors()
{
  std::vector<std::string> sheet(21, std::string(21, '#'));
  for (int row = 9; row < 12; ++row)
  {
    sheet[row].replace(9, 3, "...");
  }
  auto input = MakeFlatSheet(sheet);
  vtkPoints* points = input->GetPoints();
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double p[3];
    points->GetPoint(i, p);
    points->SetPoint(i, p[0], p[1], std::sin(p[0]) * std::cos(p[1]));
  }
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  for (int method = 0; method < 5; ++method)
  {
    fill->SetInterpolation(method);
    fill->Update();
    auto* errors = Named<vtkDoubleArray>(fill->GetOutput()->GetPointData(), "FilledError");
    Check(errors->GetNumberOfTuples() > points->GetNumberOfPoints(), "there are new points");
    for (vtkIdType i = points->GetNumberOfPoints(); i < errors->GetNumberOfTuples(); ++i)
    {
      const double error = errors->GetValue(i);
      Check(method > 0 ? error > 0.0 && error < 2.0 : std::isnan(error),
        "new points have an error by every method but the mean of neighbours");
    }
  }
}

void TestSurfacesThatPass()
{
  vtkNew<vtkTest::ErrorObserver> observer;
  vtkNew<vtkFillElevationHoles> fill;
  fill->AddObserver(vtkCommand::WarningEvent, observer);
  fill->AddObserver(vtkCommand::ErrorEvent, observer);
  auto closed = MakeFlatSheet({ "##", "##" });
  fill->SetInputData(closed);
  fill->Update();
  Check(
    !observer->GetWarning() && !observer->GetError(), "a surface without holes passes in silence");
  Check(fill->GetOutput()->GetPoints() == closed->GetPoints(), "with its own points");
  Check(fill->GetOutput()->GetNumberOfCells() == 8, "and all cells");
  Check(fill->GetOutput(1)->GetNumberOfCells() == 0, "and an empty report");

  vtkNew<vtkPolyData> empty;
  fill->SetInputData(empty);
  fill->Update();
  Check(!observer->GetWarning() && !observer->GetError(),
    "another filter has warned of an empty input");
  Check(fill->GetOutput()->GetNumberOfPoints() == 0, "and empty output");
  observer->Clear();

  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(closed->GetPoints());
  fill->SetInputData(cloud);
  fill->Update();
  Check(observer->GetWarning() && !observer->GetError(), "points alone get a warning");
  Check(fill->GetOutput()->GetNumberOfPoints() == 9, "and pass");
  observer->Clear();

  // Two squares that lie side by side, each with points of its own.
  auto soup = MakeFlatSheet({ "#" });
  const vtkIdType a = soup->GetPoints()->InsertNextPoint(1, 0, 0);
  const vtkIdType b = soup->GetPoints()->InsertNextPoint(2, 0, 0);
  const vtkIdType c = soup->GetPoints()->InsertNextPoint(1, 1, 0);
  const vtkIdType triangle[3] = { a, b, c };
  soup->GetPolys()->InsertNextCell(3, triangle);
  fill->SetInputData(soup);
  fill->Update();
  Check(
    observer->GetWarning() && !observer->GetError(), "points that should be merged get a warning");
  Check(observer->GetWarningMessage().find("vtkCleanPolyData") != std::string::npos, "which helps");
}

void TestAbort()
{
  auto input = MakeSheet(ThreeHoles, VTK_DOUBLE, Tilted);
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  fill->SetSpacing(0.01);
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    auto* filter = static_cast<vtkFillElevationHoles*>(caller);
    if (filter->GetProgress() > 0.3)
    {
      filter->AbortExecuteOn();
    }
  });
  fill->AddObserver(vtkCommand::ProgressEvent, stop);
  fill->Update();
  Check(fill->GetOutput(0)->GetNumberOfPoints() == 0, "an abort leaves an empty surface");
  Check(fill->GetOutput(1)->GetNumberOfPoints() == 0, "an abort leaves an empty report");
}

void TestLateAbort()
{
  for (const double at : { 0.0, 0.9, 1.0 })
  {
    vtkNew<vtkFillElevationHoles> fill;
    fill->SetInputData(MakeSheet(ThreeHoles, VTK_DOUBLE, Tilted));
    double limit = at;
    vtkNew<vtkCallbackCommand> stop;
    stop->SetClientData(&limit);
    stop->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
      auto* filter = static_cast<vtkFillElevationHoles*>(caller);
      if (filter->GetProgress() >= *static_cast<double*>(data))
      {
        filter->AbortExecuteOn();
      }
    });
    fill->AddObserver(vtkCommand::ProgressEvent, stop);
    fill->Update();
    Check(fill->GetOutput(0)->GetNumberOfPoints() == 0 && fill->GetNumberOfHoles() == 0 &&
        fill->GetNumberOfFilledHoles() == 0,
      "an abort at the last report leaves neither a surface nor counts");
  }
}
} // namespace

int TestFillElevationHolesErrors(int, char*[])
{
  TestRefusals();
  TestSurfacesThatPass();
  TestErrors();
  TestAbort();
  TestLateAbort();
  return failures ? EXIT_FAILURE : EXIT_SUCCESS;
}
