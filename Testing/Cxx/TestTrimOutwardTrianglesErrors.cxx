// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What vtkTrimOutwardTriangles refuses, and what errors and aborts leave behind.
#include "Check.h"
#include "FaultyCells.h"
#include "MeshAndRings.h"
#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTestErrorObserver.h"
#include "vtkTrimOutwardTriangles.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

namespace
{
vtkIdType At(int x, int y)
{
  return x + Size * y;
}

void ExpectError(vtkPolyData* mesh, vtkPolyData* boundary, bool recover, const std::string& part)
{
  vtkNew<vtkTest::ErrorObserver> observer;
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->AddObserver(vtkCommand::ErrorEvent, observer);
  vtkNew<vtkTest::ErrorObserver> ofExecutive; // which adds that the request failed
  trim->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, ofExecutive);
  trim->SetInputData(mesh);
  trim->SetBoundaryData(boundary);
  trim->SetRecoverBoundary(recover);
  trim->Update();
  const std::string message = observer->GetErrorMessage();
  Check(
    message.find(part) != std::string::npos && message.find("ERROR:") == message.rfind("ERROR:"),
    "one error with \"" + part + "\"; it was: " + message);
  for (int port = 0; port < 3; ++port)
  {
    Check(trim->GetOutput(port)->GetNumberOfPoints() == 0 &&
        trim->GetOutput(port)->GetNumberOfCells() == 0,
      "an error leaves empty outputs");
  }
}

void TestErrors()
{
  auto mesh = MakeMesh();
  auto open = MakeRings({ { { 1, 1 }, { 7, 2 }, { 6, 7 } } });
  vtkNew<vtkCellArray> line;
  line->InsertNextCell({ 0, 1, 2 });
  open->SetLines(line);
  ExpectError(mesh, open, true, "line (cell 0) ends at point 0 (1, 1)");
  ExpectError(mesh, MakeRings({ { { 0, 0 }, { 7, 6 }, { 7, 0 }, { 0, 5 } } }), true, "crosses");
  ExpectError(mesh, MakeRings({ { { 0, 0 }, { 7.5, 6 }, { 7, 0 } } }), false, "point 1 (7.5, 6)");
  ExpectError(mesh, MakeRings({ { { 0, 0 }, { 9.5, 6 }, { 7, 0 } } }), false,
    "edge from point 0 (0, 0) to point 1 (9.5, 6) leaves the mesh");
  ExpectError(mesh, MakeRings({ { { 10, 10 }, { 19, 10 }, { 10, 20 } } }), true,
    "The boundary encloses no triangle of the mesh. It is at x 10 to 19, y 10 to 20, the mesh at "
    "x 0 to 8, y 0 to 8: are both in the same coordinates?");
  ExpectError(mesh,
    MakeRings({ { { 1, 1 }, { 4, 1 }, { 1, 5 } }, { { 1, 1 }, { 2.5, 1 }, { 4, 1 }, { 1, 5 } } }),
    true,
    "Its first ring begins at (1, 1); of rings in each other, what lies between two is enclosed.");
  ExpectError(mesh,
    MakeRings({ { { 0.5, 0.5 }, { 5, 1 }, { 4, 5 } }, { { 3, 0.5 }, { 7, 3 }, { 2, 4 } } }), true,
    "crosses its edge from");
  ExpectError(mesh, MakeRings({ { { 0, 0 }, { std::nan(""), 6 }, { 7, 0 } } }), true, "not finite");
  ExpectError(mesh, MakeRings({ { { 0, 0 }, { 7, 2 }, { 7, 0 } } }), false, "not an edge");
  ExpectError(mesh, MakeRings({ { { 0, 0 }, { 7, 2 } } }), true, "at least three");
  ExpectError(mesh, MakeRings({ { { 0, 0 }, { 4, 4 }, { 2, 2 } } }), true, "encloses no triangle");
  vtkNew<vtkPolyData> nothing;
  ExpectError(mesh, nothing, true, "no line and no polygon");

  // Cells are numbered as vtkPolyData does: vertices, lines, polygons.
  auto mixed = MakeRings({ { { 0, 0 }, { 7, 2 }, { 7, 0 } }, { { 1, 4 }, { 3, 5 }, { 2, 7 } } });
  vtkNew<vtkCellArray> vertices;
  vertices->InsertNextCell({ 0 });
  vertices->InsertNextCell({ 1, 2 });
  mixed->SetVerts(vertices);
  const double infinite = std::numeric_limits<double>::infinity();
  mixed->GetPoints()->SetPoint(4, 3, 5, infinite);
  ExpectError(mesh, mixed, true, "Point 4 of the boundary's cell 3 is not finite");
  vtkNew<vtkCellArray> polygon;
  polygon->InsertNextCell({ 3, 81, 5 });
  mixed->SetPolys(polygon);
  mixed->GetPoints()->SetPoint(4, 3, 5, 7);
  ExpectError(mesh, mixed, true, "Point 81 of the boundary's cell 4 does not exist");
  mixed->SetPolys(nullptr);
  vtkNew<vtkCellArray> notClosed;
  notClosed->InsertNextCell({ 0, 1, 2, 0 });
  notClosed->InsertNextCell({ 3, 4, 5 });
  mixed->SetLines(notClosed);
  ExpectError(mesh, mixed, true, "line (cell 3) ends at point 3 (1, 4)");
  auto heights = MakeRings({ { { 0, 0 }, { 7, 2 }, { 7, 0 } } });
  heights->GetPoints()->SetPoint(1, 7, infinite, 1.0);
  ExpectError(mesh, heights, true, "Point 1 of the boundary's cell 0 is not finite");

  // Data that do not fit: of the mesh, of its cells, of the boundary.
  vtkNew<vtkDoubleArray> three;
  three->SetName("Picks");
  three->SetNumberOfTuples(3);
  three->Fill(1.0);
  auto rings = MakeRings({ { { 0, 0 }, { 7, 2 }, { 7, 7 }, { 0, 5 } } });
  rings->GetPointData()->AddArray(three);
  ExpectError(mesh, rings, true,
    "The boundary's point array \"Picks\" has 3 tuples, but there are 4 points.");
  auto unfit = MakeMesh();
  unfit->GetPointData()->AddArray(three);
  ExpectError(unfit, nullptr, true, "Point array \"Picks\" has 3 tuples, but there are 81 points.");
  unfit = MakeMesh();
  unfit->GetCellData()->AddArray(three);
  ExpectError(unfit, nullptr, true, "Cell array \"Picks\" has 3 tuples, but there are 130 cells.");

  vtkNew<vtkPolyData> quad;
  quad->SetPoints(mesh->GetPoints());
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({ At(0, 0), At(1, 0), At(1, 1), At(0, 1) });
  quad->SetPolys(cells);
  ExpectError(quad, nullptr, true, "Cell 0 has 4 points");
  quad->SetVerts(vertices);
  quad->SetLines(notClosed);
  ExpectError(quad, nullptr, true, "Cell 4 has 4 points");
  vtkNew<vtkPolyData> folded;
  folded->SetPoints(mesh->GetPoints());
  vtkNew<vtkCellArray> two;
  two->InsertNextCell({ At(0, 0), At(5, 0), At(0, 5) });
  two->InsertNextCell({ At(1, 1), At(6, 1), At(1, 6) });
  folded->SetPolys(two);
  ExpectError(folded, nullptr, true, "Cell 1 lies over");
  folded->SetVerts(vertices);
  folded->SetLines(notClosed);
  ExpectError(folded, nullptr, true, "Cell 5 lies over");
}

void TestFaultyCells()
{
  ForEachFaultyCells([](const auto& spoil, const std::string& kind, const std::string& fault) {
    auto mesh = MakeMesh();
    mesh->GetCellData()->Initialize(); // or it is of too many cells
    auto rings = MakeRings({ { { 0, 0 }, { 7, 2 }, { 7, 7 }, { 0, 5 } } });
    spoil(rings);
    ExpectError(mesh, rings, true, "The boundary's " + kind);
    ExpectError(mesh, rings, true, fault);
    spoil(mesh);
    for (vtkPolyData* boundary : { rings.Get(), static_cast<vtkPolyData*>(nullptr) })
    {
      ExpectError(mesh, boundary, true, "The " + kind);
      ExpectError(mesh, boundary, true, fault);
    }
  });

  // Behind a vertex and a line; and strips, though they are refused anyway.
  auto mesh = MakeMesh();
  vtkNew<vtkCellArray> cells;
  SetFaultyCells<vtkTypeInt32Array>(cells, { 0, 3, 0 }, 3, 1);
  mesh->GetCellData()->Initialize();
  mesh->SetPolys(cells);
  ExpectError(mesh, nullptr, true,
    "The polygons: cell 3 begins at 3 and ends at 0, but offsets must begin with 0, never fall, "
    "and end with the number of point ids, 3.");
  mesh = MakeMesh();
  mesh->SetStrips(cells);
  ExpectError(mesh, nullptr, true, "The triangle strips: cell 131 begins at 3");
}

void TestEmptyMeshAndAbort()
{
  vtkNew<vtkPolyData> empty;
  vtkNew<vtkTest::ErrorObserver> observer;
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->AddObserver(vtkCommand::WarningEvent, observer);
  trim->SetInputData(empty);
  trim->Update();
  Check(!observer->GetWarning() && trim->GetOutput()->GetNumberOfCells() == 0,
    "an empty mesh passes: the filter that made it has said why");
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(MakeMesh()->GetPoints());
  trim->SetInputData(cloud);
  trim->Update();
  Check(observer->GetWarning() && trim->GetOutput()->GetNumberOfCells() == 0,
    "points alone pass with a warning");

  vtkNew<vtkTrimOutwardTriangles> aborted;
  aborted->SetInputData(MakeMesh());
  double last = 0.0;
  vtkNew<vtkCallbackCommand> progress;
  progress->SetClientData(&last);
  progress->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    auto* filter = static_cast<vtkTrimOutwardTriangles*>(caller);
    auto* before = static_cast<double*>(data);
    Check(filter->GetProgress() >= *before && filter->GetProgress() <= 1.0, "progress rises");
    *before = filter->GetProgress();
  });
  aborted->AddObserver(vtkCommand::ProgressEvent, progress);
  aborted->Update();
  Check(last == 1.0, "progress ends at 1");
  Check(aborted->GetOutput(0)->GetNumberOfPolys() == 128, "a full lattice is all surface");
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    static_cast<vtkTrimOutwardTriangles*>(caller)->SetAbortExecute(1);
  });
  aborted->RemoveObservers(vtkCommand::ProgressEvent);
  aborted->AddObserver(vtkCommand::ProgressEvent, stop);
  aborted->Modified();
  aborted->Update();
  for (int port = 0; port < 3; ++port)
  {
    Check(aborted->GetOutput(port)->GetNumberOfCells() == 0, "an abort leaves empty outputs");
  }

  vtkNew<vtkCallbackCommand> stopLate;
  stopLate->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    auto* filter = static_cast<vtkTrimOutwardTriangles*>(caller);
    if (filter->GetProgress() == 1.0)
    {
      filter->SetAbortExecute(1);
    }
  });
  aborted->RemoveObservers(vtkCommand::ProgressEvent);
  aborted->AddObserver(vtkCommand::ProgressEvent, stopLate);
  aborted->SetBoundaryData(MakeRings({ { { 0, 0 }, { 7, 2 }, { 0, 5 } } }));
  aborted->Update();
  Check(aborted->GetOutput(0)->GetNumberOfCells() == 0 &&
      aborted->GetNumberOfOutwardTriangles() == 0 && aborted->GetNumberOfRecoveredEdges() == 0 &&
      aborted->GetEffectiveGapTolerance() == 0.0,
    "an abort at the last report leaves no counts");
}
} // namespace

int TestTrimOutwardTrianglesErrors(int, char*[])
{
  TestErrors();
  TestFaultyCells();
  TestEmptyMeshAndAbort();
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
