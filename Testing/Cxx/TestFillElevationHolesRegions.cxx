// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// OpenEdgeLength of vtkFillElevationHoles: regions of long triangles that patches replace, by
// numbers: which cells stay, with their data, what is reported of the regions, limits and errors.
#include "Check.h"
#include "MeshRules.h"
#include "SheetOfSquares.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFillElevationHoles.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkTestErrorObserver.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

namespace
{
/** Columns 4 and 5 are ten wide: between them a line of points whose triangles are all long. */
vtkSmartPointer<vtkPolyData> MakeInput()
{
  auto input = MakeSheet({ "##########", "##########", "# ########", "##########", "##########" },
    VTK_DOUBLE, [](int x, int y) { return 10.0 + x - 0.5 * y; });
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    double p[3];
    input->GetPoints()->GetPoint(i, p);
    p[0] += p[0] > 5.5 ? 18.0 : p[0] > 4.5 ? 9.0 : 0.0;
    input->GetPoints()->SetPoint(i, p);
  }
  vtkNew<vtkCellArray> vertices;
  const vtkIdType vertex[1] = { 3 };
  vertices->InsertNextCell(1, vertex);
  input->SetVerts(vertices);
  const vtkIdType cells = input->GetNumberOfCells();
  vtkNew<vtkIntArray> number;
  number->SetName("Number");
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("Ids");
  for (vtkIdType i = 0; i < cells; ++i)
  {
    number->InsertNextValue(static_cast<int>(100 + i));
    ids->InsertNextValue(7 * i);
  }
  input->GetCellData()->SetScalars(number);
  input->GetCellData()->SetGlobalIds(ids);
  return input;
}

bool IsLong(vtkPolyData* data, vtkIdType polygon, double limit)
{
  vtkNew<vtkIdList> ids;
  data->GetPolys()->GetCellAtId(polygon, ids);
  for (int i = 0; i < 3; ++i)
  {
    double a[3], b[3];
    data->GetPoint(ids->GetId(i), a);
    data->GetPoint(ids->GetId((i + 1) % 3), b);
    if (std::hypot(b[0] - a[0], b[1] - a[1]) > limit)
    {
      return true;
    }
  }
  return false;
}

/** The cells of the input that stay come first, with their data; then those of patches. */
void CheckCells(vtkPolyData* input, vtkPolyData* output, double limit)
{
  auto* const number = vtkIntArray::SafeDownCast(output->GetCellData()->GetScalars());
  auto* const hole = vtkIdTypeArray::SafeDownCast(output->GetCellData()->GetArray("HoleId"));
  Check(number && number->GetNumberOfTuples() == output->GetNumberOfCells(), "data at all cells");
  Check(hole && hole->GetNumberOfTuples() == output->GetNumberOfCells(), "HoleId at all cells");
  Check(number->GetValue(0) == 100 && output->GetNumberOfVerts() == 1, "the vertex stays");
  vtkIdType cell = 1;
  vtkNew<vtkIdList> before;
  vtkNew<vtkIdList> after;
  for (vtkIdType i = 0; i < input->GetNumberOfPolys(); ++i)
  {
    if (IsLong(input, i, limit))
    {
      continue;
    }
    input->GetPolys()->GetCellAtId(i, before);
    output->GetPolys()->GetCellAtId(cell - 1, after);
    Check(before->GetId(0) == after->GetId(0) && before->GetId(1) == after->GetId(1) &&
        before->GetId(2) == after->GetId(2) && number->GetValue(cell) == 101 + i &&
        hole->GetValue(cell) == -1,
      "triangle " + std::to_string(i) + " stays, with its data");
    ++cell;
  }
  for (; cell < output->GetNumberOfCells(); ++cell)
  {
    Check(number->GetValue(cell) == 0 && hole->GetValue(cell) >= 0, "others are of patches");
  }
}

void CheckReplaced()
{
  const auto input = MakeInput();
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  fill->SetOpenEdgeLength(2.0);
  fill->Update();
  vtkPolyData* const output = fill->GetOutput();
  vtkPolyData* const report = fill->GetOutput(1);
  Check(NumberOfFindings(output, RulesOfConvexSurface()) == 0, "a region is replaced");
  CheckCells(input, output, 2.0);
  Check(output->GetCellData()->GetGlobalIds() != nullptr, "global ids go on");
  Check(std::fabs(ProjectedArea(output) - 28.0 * 5.0) < 1e-9, "all is covered once");
  Check(fill->GetNumberOfHoles() == 2 && fill->GetNumberOfFilledHoles() == 2, "it counts");

  auto* const status = vtkUnsignedCharArray::SafeDownCast(report->GetCellData()->GetArray("Status"));
  Check(status->GetValue(0) == vtkFillElevationHoles::FILLED &&
      status->GetValue(1) == vtkFillElevationHoles::REPLACED,
    "a region has a status of its own, and follows the holes");
  const auto valueOf = [report](const char* name) {
    return report->GetCellData()->GetArray(name)->GetComponent(1, 0);
  };
  Check(valueOf("NumberOfEdges") == 5 + 2 + 5 + 2, "edges of the region's border");
  Check(valueOf("Perimeter") == 50.0 && valueOf("Area") == 100.0, "its size");
  Check(valueOf("NumberOfInsertedPoints") > 20, "it gets points");
  Check(report->GetCell(1)->GetNumberOfPoints() == 15, "its rim is a closed line");

  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    double a[3], b[3];
    input->GetPoint(i, a);
    output->GetPoint(i, b);
    Check(a[0] == b[0] && a[1] == b[1] && a[2] == b[2], "points of the input stay");
  }
  // The line between the wide columns.
  for (int y = 0; y < 5; ++y)
  {
    vtkIdType ends[2] = { -1, -1 };
    for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
    {
      double p[3];
      input->GetPoint(i, p);
      if (p[0] == 14.0 && (p[1] == y || p[1] == y + 1))
      {
        ends[p[1] == y ? 0 : 1] = i;
      }
    }
    output->BuildLinks();
    vtkNew<vtkIdList> cells;
    output->GetCellEdgeNeighbors(-1, ends[0], ends[1], cells);
    Check(cells->GetNumberOfIds() == 2, "edges along the line stay");
  }
}

void CheckLimits()
{
  const auto input = MakeInput();
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  fill->SetOpenEdgeLength(2.0);
  fill->SetMaximumHoleEdges(10);
  fill->Update();
  Check(fill->GetNumberOfHoles() == 2 && fill->GetNumberOfFilledHoles() == 1, "one is too large");
  auto* const status = vtkUnsignedCharArray::SafeDownCast(
    fill->GetOutput(1)->GetCellData()->GetArray("Status"));
  Check(status->GetValue(1) == vtkFillElevationHoles::TOO_MANY_EDGES, "the region");
  CheckCells(input, fill->GetOutput(), 100.0);
  Check(NumberOfFindings(fill->GetOutput(), RulesOfConvexSurface()) == 0, "what is not filled keeps its triangles");

  fill->SetMaximumHoleEdges(0);
  fill->SetOpenEdgeLength(0.0);
  fill->Update();
  Check(fill->GetNumberOfHoles() == 1, "0 is off");
  fill->SetOpenEdgeLength(std::numeric_limits<double>::infinity());
  fill->Update();
  Check(fill->GetNumberOfHoles() == 1, "nothing is longer than infinity");
  fill->SetOpenEdgeLength(1e-300);
  fill->Update();
  Check(fill->GetNumberOfHoles() == 2 && fill->GetNumberOfFilledHoles() >= 1, "all is one region");
}

vtkIdType CountIn(vtkDataObject* data, const char* name)
{
  auto* const count = vtkIdTypeArray::SafeDownCast(data->GetFieldData()->GetArray(name));
  return count ? count->GetValue(0) : -1;
}

/** A flat triangle beside the sheet, the first of all, has no room for a point. */
void CheckWithoutRoom()
{
  const auto input = MakeInput();
  const vtkIdType first = input->GetNumberOfPoints();
  for (const double x : { 0.0, 4.0, 2.0 })
  {
    input->GetPoints()->InsertNextPoint(x, x == 2.0 ? -4.8 : -5.0, 7.0);
  }
  const vtkIdType corners[3] = { first, first + 1, first + 2 };
  vtkNew<vtkCellArray> flat;
  flat->InsertNextCell(3, corners);
  vtkNew<vtkCellArray> polygons;
  polygons->DeepCopy(flat);
  polygons->Append(input->GetPolys());
  input->SetPolys(polygons);
  vtkIntArray::SafeDownCast(input->GetCellData()->GetScalars())->InsertNextValue(-5);
  vtkIdTypeArray::SafeDownCast(input->GetCellData()->GetGlobalIds())->InsertNextValue(-5);

  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  fill->SetOpenEdgeLength(2.0);
  fill->Update();
  Check(fill->GetNumberOfHoles() == 2 && fill->GetNumberOfFilledHoles() == 2 &&
      CountIn(fill->GetOutput(), "NumberOfHoles") == 2 &&
      CountIn(fill->GetOutput(1), "NumberOfHoles") == 2 &&
      CountIn(fill->GetOutput(1), "NumberOfFilledHoles") == 2,
    "a region without room is not counted");
  vtkCellData* const report = fill->GetOutput(1)->GetCellData();
  auto* const status = vtkUnsignedCharArray::SafeDownCast(report->GetArray("Status"));
  Check(fill->GetOutput(1)->GetNumberOfLines() == 2 && status->GetNumberOfTuples() == 2 &&
      status->GetValue(0) == vtkFillElevationHoles::FILLED &&
      status->GetValue(1) == vtkFillElevationHoles::REPLACED &&
      report->GetArray("NumberOfInsertedPoints")->GetComponent(1, 0) > 20,
    "nor listed: the other region follows the holes");
  vtkNew<vtkIdList> ids;
  fill->GetOutput()->GetPolys()->GetCellAtId(0, ids);
  auto* const holeId = fill->GetOutput()->GetCellData()->GetArray("HoleId");
  Check(ids->GetId(0) == first && ids->GetId(2) == first + 2 && holeId->GetComponent(1, 0) == -1,
    "it keeps its triangle");
  double range[2];
  holeId->GetRange(range);
  Check(range[0] == -1.0 && range[1] == 1.0, "ids of holes are those of the report");
  Check(NumberOfFindings(fill->GetOutput(), RulesOfSurface()) == 0, "the surface is whole");

  // Alone, it leaves everything as it is.
  input->SetPolys(flat);
  input->GetCellData()->GetScalars()->SetNumberOfTuples(2);
  input->GetCellData()->GetGlobalIds()->SetNumberOfTuples(2);
  input->Modified();
  fill->Update();
  Check(fill->GetNumberOfHoles() == 0 && fill->GetNumberOfFilledHoles() == 0 &&
      CountIn(fill->GetOutput(1), "NumberOfHoles") == 0 &&
      fill->GetOutput(1)->GetNumberOfCells() == 0,
    "there is no hole");
  Check(fill->GetOutput()->GetNumberOfPolys() == 1 &&
      fill->GetOutput()->GetNumberOfPoints() == input->GetNumberOfPoints() &&
      fill->GetOutput()->GetCellData()->GetGlobalIds() != nullptr,
    "all cells stay, with their ids");
}

void CheckErrors()
{
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(MakeInput());
  vtkNew<vtkTest::ErrorObserver> observer;
  fill->AddObserver(vtkCommand::ErrorEvent, observer);
  for (const double length : { -1.0, vtkMath::Nan(), -std::numeric_limits<double>::infinity() })
  {
    fill->SetOpenEdgeLength(length);
    fill->Modified();
    fill->Update();
    Check(observer->GetError() &&
        observer->GetErrorMessage().find("OpenEdgeLength is ") != std::string::npos,
      "an error names OpenEdgeLength");
    Check(fill->GetOutput()->GetNumberOfCells() == 0 && fill->GetNumberOfHoles() == 0, "no output");
    observer->Clear();
  }
}
} // namespace

int TestFillElevationHolesRegions(int, char*[])
{
  CheckReplaced();
  CheckLimits();
  CheckWithoutRoom();
  CheckErrors();
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
