// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The pipeline side of vtkFillElevationHoles, by numbers: what comes first and unchanged, what
// arrays get at new points and triangles, the report and the limits.
#include "Check.h"
#include "MeshRules.h"
#include "SheetOfSquares.h"
#include "SheetsWithHoles.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFillElevationHoles.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkStringArray.h"
#include "vtkTestErrorObserver.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>

namespace
{
/**
 * One hole, arrays of every kind, a vertex and a line among the cells, and one clockwise triangle.
 */
vtkSmartPointer<vtkPolyData> MakeRichInput(int precision)
{
  auto input = MakeSheet(OneHole, precision, Tilted);
  const vtkIdType points = input->GetNumberOfPoints();
  vtkNew<vtkCellArray> vertices;
  const vtkIdType vertex[1] = { 3 };
  vertices->InsertNextCell(1, vertex);
  input->SetVerts(vertices);
  vtkNew<vtkCellArray> lines;
  const vtkIdType line[2] = { 0, 1 };
  lines->InsertNextCell(2, line);
  input->SetLines(lines);
  const vtkIdType clockwise[3] = { 0, 2, 1 };
  input->GetPolys()->ReplaceCellAtId(0, 3, clockwise);
  const vtkIdType cells = input->GetNumberOfCells();

  vtkNew<vtkDoubleArray> amplitude;
  amplitude->SetName("Amplitude");
  vtkNew<vtkFloatArray> vectors;
  vectors->SetName("Normals");
  vectors->SetNumberOfComponents(3);
  vtkNew<vtkIntArray> numbers;
  numbers->SetName("Number");
  vtkNew<vtkStringArray> names;
  names->SetName("Name");
  vtkNew<vtkIdTypeArray> globalIds;
  globalIds->SetName("GlobalIds");
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  for (vtkIdType i = 0; i < points; ++i)
  {
    double p[3];
    input->GetPoint(i, p);
    amplitude->InsertNextValue(100.0 + 2.0 * p[2]);
    const double angle = 0.3 * p[0];
    vectors->InsertNextTuple3(std::sin(angle), 0.0, std::cos(angle));
    numbers->InsertNextValue(1000 + i);
    names->InsertNextValue("p" + std::to_string(i));
    globalIds->InsertNextValue(50 + i);
    ghosts->InsertNextValue(1);
  }
  input->GetPointData()->SetScalars(amplitude);
  input->GetPointData()->SetNormals(vectors);
  input->GetPointData()->AddArray(numbers);
  input->GetPointData()->AddArray(names);
  input->GetPointData()->SetGlobalIds(globalIds);
  input->GetPointData()->AddArray(ghosts);

  vtkNew<vtkFloatArray> quality;
  quality->SetName("Quality");
  vtkNew<vtkIntArray> facies;
  facies->SetName("Facies");
  vtkNew<vtkStringArray> labels;
  labels->SetName("Label");
  for (vtkIdType i = 0; i < cells; ++i)
  {
    quality->InsertNextValue(0.5f * i);
    facies->InsertNextValue(7 + i);
    labels->InsertNextValue("c" + std::to_string(i));
  }
  input->GetCellData()->AddArray(quality);
  input->GetCellData()->SetScalars(facies);
  input->GetCellData()->AddArray(labels);
  vtkNew<vtkStringArray> source;
  source->SetName("Source");
  source->InsertNextValue("survey");
  input->GetFieldData()->AddArray(source);
  return input;
}

void TestArrays(int precision)
{
  auto input = MakeRichInput(precision);
  auto before = vtkSmartPointer<vtkPolyData>::New();
  before->DeepCopy(input);
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  fill->Update();
  vtkPolyData* output = fill->GetOutput();
  const vtkIdType points = input->GetNumberOfPoints();
  const vtkIdType cells = input->GetNumberOfCells();
  const vtkIdType newPoints = output->GetNumberOfPoints() - points;
  Check(newPoints >= 4, "a hole of 3 x 3 squares gets points");
  Check(output->GetPoints()->GetDataType() == precision, "the type of points is kept");
  Check(output->GetNumberOfVerts() == 1 && output->GetNumberOfLines() == 1, "other cells pass");
  Check(NumberOfFindings(output, RulesOfConvexSurface()) == 0,
    "the output is a surface, which covers all of the sheet; its triangles are counter-clockwise, "
    "the clockwise one of the input too");

  auto* filled = Named<vtkUnsignedCharArray>(output->GetPointData(), "FilledPoint");
  auto* errors = Named<vtkDoubleArray>(output->GetPointData(), "FilledError");
  auto* amplitude = Named<vtkDoubleArray>(output->GetPointData(), "Amplitude");
  auto* normals = Named<vtkFloatArray>(output->GetPointData(), "Normals");
  auto* numbers = Named<vtkIntArray>(output->GetPointData(), "Number");
  auto* names = Named<vtkStringArray>(output->GetPointData(), "Name");
  auto* ids = Named<vtkIdTypeArray>(output->GetPointData(), "GlobalIds");
  auto* ghosts =
    Named<vtkUnsignedCharArray>(output->GetPointData(), vtkDataSetAttributes::GhostArrayName());
  Check(output->GetPointData()->GetScalars() == amplitude, "scalars stay scalars");
  Check(output->GetPointData()->GetNormals() == normals, "normals stay normals");
  Check(output->GetPointData()->GetGlobalIds() == ids, "global ids stay global ids");
  for (vtkIdType i = 0; i < points + newPoints; ++i)
  {
    double p[3];
    output->GetPoint(i, p);
    Check(filled->GetValue(i) == (i >= points), "FilledPoint marks the new points, which are last");
    if (i < points)
    {
      double q[3];
      before->GetPoint(i, q);
      Check(p[0] == q[0] && p[1] == q[1] && p[2] == q[2], "input points are unchanged and first");
      Check(ghosts->GetValue(i) == 1, "values of input points are unchanged");
      Check(errors->GetValue(i) == 0.0, "points of the input have no error of filling");
      continue;
    }
    const double tolerance = precision == VTK_FLOAT ? 1e-4 : 1e-10;
    Check(std::fabs(amplitude->GetValue(i) - 100.0 - 2.0 * p[2]) < tolerance,
      "floating-point values are found as z is");
    double normal[3];
    normals->GetTuple(i, normal);
    Check(std::fabs(std::hypot(normal[0], normal[2]) - 1.0) < 1e-6, "normals have unit length");
    const vtkIdType nearest = numbers->GetValue(i) - 1000;
    Check(nearest >= 0 && nearest < points, "integers are taken from a point");
    Check(names->GetValue(i) == "p" + std::to_string(nearest), "strings from the same");
    Check(ids->GetValue(i) == 50 + i, "new points have ids after the largest");
    Check(ghosts->GetValue(i) == 0, "new points are no ghosts");
    double q[3];
    output->GetPoint(nearest, q);
    Check(std::hypot(p[0] - q[0], p[1] - q[1]) < 1.6, "from a point of the boundary that is near");
  }

  auto* hole = Named<vtkIdTypeArray>(output->GetCellData(), "HoleId");
  auto* quality = Named<vtkFloatArray>(output->GetCellData(), "Quality");
  auto* facies = Named<vtkIntArray>(output->GetCellData(), "Facies");
  auto* labels = Named<vtkStringArray>(output->GetCellData(), "Label");
  Check(output->GetCellData()->GetScalars() == facies, "cell scalars stay scalars");
  Check(hole->GetNumberOfTuples() == output->GetNumberOfCells(), "one HoleId a cell");
  for (vtkIdType i = 0; i < output->GetNumberOfCells(); ++i)
  {
    const bool isNew = i >= cells;
    Check(hole->GetValue(i) == (isNew ? 0 : -1), "HoleId is -1 for cells of the input");
    Check(isNew ? std::isnan(quality->GetValue(i)) : quality->GetValue(i) == 0.5f * i, "NaN");
    Check(facies->GetValue(i) == (isNew ? 0 : 7 + i), "0 for integers");
    Check(labels->GetValue(i) == (isNew ? "" : "c" + std::to_string(i)), "nothing for strings");
    vtkNew<vtkIdList> corners;
    output->GetCellPoints(i, corners);
    if (!isNew && i != 2)
    {
      vtkNew<vtkIdList> same;
      before->GetCellPoints(i, same);
      bool isSame = corners->GetNumberOfIds() == same->GetNumberOfIds();
      for (vtkIdType k = 0; isSame && k < same->GetNumberOfIds(); ++k)
      {
        isSame = corners->GetId(k) == same->GetId(k);
      }
      Check(isSame, "input cells are unchanged");
    }
  }
  Check(output->GetFieldData()->GetAbstractArray("Source") != nullptr, "field data pass");
  vtkNew<vtkIdList> first;
  input->GetPolys()->GetCellAtId(0, first);
  Check(first->GetId(1) == 2, "the input is not written to");
  Check(!input->GetPointData()->GetAbstractArray("FilledPoint"), "nor are arrays added to it");

  fill->InterpolatePointDataOff();
  fill->Update();
  output = fill->GetOutput();
  amplitude = Named<vtkDoubleArray>(output->GetPointData(), "Amplitude");
  numbers = Named<vtkIntArray>(output->GetPointData(), "Number");
  names = Named<vtkStringArray>(output->GetPointData(), "Name");
  Check(output->GetNumberOfPoints() == points + newPoints, "the same points without interpolation");
  for (vtkIdType i = points; i < points + newPoints; ++i)
  {
    Check(std::isnan(amplitude->GetValue(i)), "off: NaN");
    Check(numbers->GetValue(i) == 0, "off: 0");
    Check(names->GetValue(i).empty(), "off: nothing");
    Check(!std::isnan(output->GetPoint(i)[2]), "z is there all the same");
  }
}

void TestNaNIsLeftOut()
{
  auto input = MakeSheet(OneHole, VTK_DOUBLE, Tilted);
  vtkNew<vtkDoubleArray> values;
  values->SetName("Values");
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    values->InsertNextValue(i % 3 == 0 ? vtkMath::Nan() : 5.0);
  }
  input->GetPointData()->AddArray(values);
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  fill->Update();
  auto* filled = Named<vtkDoubleArray>(fill->GetOutput()->GetPointData(), "Values");
  for (vtkIdType i = input->GetNumberOfPoints(); i < filled->GetNumberOfTuples(); ++i)
  {
    Check(std::fabs(filled->GetValue(i) - 5.0) < 1e-12, "a mean leaves NaN out");
  }
}

void TestReport()
{
  auto input = MakeSheet(ThreeHoles, VTK_DOUBLE, Tilted);
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  fill->SetMaximumHoleEdges(19);
  fill->Update();
  Check(fill->GetNumberOfHoles() == 3 && fill->GetNumberOfFilledHoles() == 2, "getters count");
  for (int port = 0; port < 2; ++port)
  {
    vtkFieldData* field = fill->GetOutput(port)->GetFieldData();
    Check(
      field->GetArray("NumberOfHoles")->GetTuple1(0) == 3, "field data have the number of holes");
    Check(field->GetArray("NumberOfFilledHoles")->GetTuple1(0) == 2, "and of those filled");
  }
  vtkPolyData* report = fill->GetOutput(1);
  vtkCellData* data = report->GetCellData();
  Check(report->GetNumberOfCells() == 3 && report->GetNumberOfLines() == 3, "one line a hole");
  Check(report->GetNumberOfPoints() == 12 + 16 + 4, "with the points of the rims alone");
  for (vtkIdType i = 0; i < 3; ++i)
  {
    vtkNew<vtkIdList> ids;
    report->GetLines()->GetCellAtId(i, ids);
    const vtkIdType count = ids->GetNumberOfIds();
    Check(ids->GetId(0) == ids->GetId(count - 1), "lines are closed");
    double twice = 0.0;
    for (vtkIdType k = 0; k + 1 < count; ++k)
    {
      double a[3];
      double b[3];
      report->GetPoint(ids->GetId(k), a);
      report->GetPoint(ids->GetId(k + 1), b);
      twice += a[0] * b[1] - a[1] * b[0];
      Check(a[2] == Tilted(static_cast<int>(a[0]), static_cast<int>(a[1])), "with their z");
    }
    const double edges = data->GetArray("NumberOfEdges")->GetTuple1(i);
    const double area = data->GetArray("Area")->GetTuple1(i);
    const double status = data->GetArray("Status")->GetTuple1(i);
    Check(0.5 * twice == (edges == 12 ? 9 : edges == 22 ? 15 : 1), "rims run counter-clockwise");
    Check(area == (edges == 12 ? 9 : edges == 22 ? 13 : 1), "Area is without islands");
    Check(data->GetArray("HoleId")->GetTuple1(i) == i, "HoleId is the number of the row");
    Check(status ==
        (edges == 22 ? vtkFillElevationHoles::TOO_MANY_EDGES : vtkFillElevationHoles::FILLED),
      "Status");
    Check(data->GetArray("Perimeter")->GetTuple1(i) == edges, "Perimeter counts islands");
    const double method = data->GetArray("Interpolation")->GetTuple1(i);
    const bool hasPoints = data->GetArray("NumberOfInsertedPoints")->GetTuple1(i) > 0.0;
    Check(hasPoints ? method == vtkFillElevationHoles::MEMBRANE ||
          method == vtkFillElevationHoles::THIN_PLATE ||
          method == vtkFillElevationHoles::CUBIC_SPLINE
                    : method == 0,
      "Interpolation is what Adaptive has chosen");
    vtkIdType inserted = 0;
    vtkIdType triangles = 0;
    auto* hole = Named<vtkIdTypeArray>(fill->GetOutput()->GetCellData(), "HoleId");
    for (vtkIdType cell = 0; cell < hole->GetNumberOfTuples(); ++cell)
    {
      triangles += hole->GetValue(cell) == i;
    }
    inserted = static_cast<vtkIdType>(data->GetArray("NumberOfInsertedPoints")->GetTuple1(i));
    Check(
      triangles == (status == 0 ? edges - 2 + 2 * inserted : 0), "triangles carry their HoleId");
  }

  fill->SetMaximumHoleEdges(0);
  fill->SetMaximumHoleSize(4.3); // 3 x 3 has 4.24, 5 x 3 has 5.83
  fill->Update();
  Check(fill->GetNumberOfFilledHoles() == 2, "MaximumHoleSize is a diagonal");
  data = fill->GetOutput(1)->GetCellData();
  for (vtkIdType i = 0; i < 3; ++i)
  {
    Check((data->GetArray("Status")->GetTuple1(i) == vtkFillElevationHoles::TOO_LARGE) ==
        (data->GetArray("Area")->GetTuple1(i) == 13.0),
      "the large hole is reported");
  }
  fill->SetMaximumHoleSize(0.0);
  fill->Update();
  Check(fill->GetNumberOfFilledHoles() == 3, "0 is no limit");
  Check(NumberOfFindings(fill->GetOutput(), RulesOfConvexSurface()) == 0,
    "everything is filled, and patches overlap nothing");
  const vtkIdType points = fill->GetOutput()->GetNumberOfPoints();
  fill->SetSpacing(0.25);
  fill->Update();
  Check(fill->GetOutput()->GetNumberOfPoints() > points + 250, "Spacing makes patches finer");
  Check(NumberOfFindings(fill->GetOutput(), RulesOfConvexSurface()) == 0, "and fills all as well");
}

void TestRange()
{
  auto input =
    MakeSheet(ThreeHoles, VTK_DOUBLE, [](int x, int y) { return std::sin(3.0 * x + 5.0 * y); });
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  fill->SetSpacing(0.1);
  for (const int method : { vtkFillElevationHoles::NEIGHBOR_MEAN, vtkFillElevationHoles::MEMBRANE })
  {
    fill->SetInterpolation(method);
    fill->Update();
    double before[6];
    double after[6];
    input->GetBounds(before);
    fill->GetOutput()->GetBounds(after);
    Check(after[4] >= before[4] && after[5] <= before[5], "z stays within that of the boundary");
  }
}

/** Float points that do not lie x, y, z one after the other in memory, where steps are coarse. */
void TestSeparateCoordinates()
{
  auto input = MakeSheet(OneHole, VTK_FLOAT, Tilted);
  vtkNew<vtkSOADataArrayTemplate<float>> coordinates;
  coordinates->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    double p[3];
    input->GetPoint(i, p);
    coordinates->InsertNextTuple3(500000.0 + p[0], 450000.0 + p[1], p[2]);
  }
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  input->SetPoints(points);

  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  fill->SetSpacing(0.3);
  fill->Update();
  Check(fill->GetNumberOfFilledHoles() == 1, "float points by coordinate are filled");
  Check(fill->GetOutput()->GetPoints()->GetDataType() == VTK_FLOAT, "and stay float");
  bool isUpright = true;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < fill->GetOutput()->GetNumberOfCells(); ++cell)
  {
    double p[3][3];
    fill->GetOutput()->GetCellPoints(cell, corners);
    for (int i = 0; i < 3; ++i)
    {
      fill->GetOutput()->GetPoint(corners->GetId(i), p[i]);
    }
    isUpright = isUpright &&
      (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) > (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
  }
  Check(isUpright, "no triangle is flat or turned over by rounding");

  fill->SetSpacing(0.01);
  vtkNew<vtkTest::ErrorObserver> observer;
  fill->AddObserver(vtkCommand::WarningEvent, observer);
  fill->Update();
  Check(observer->GetWarningMessage().find("precision of the coordinates") != std::string::npos,
    "a spacing below the steps of float is refused");
}

void TestUnlimitedSpacing()
{
  auto input = MakeSheet(ThreeHoles, VTK_DOUBLE, Tilted);
  for (double spacing : { 1e-6, 1e-15, 1e-300, 1e300 })
  {
    vtkNew<vtkTest::ErrorObserver> observer;
    vtkNew<vtkFillElevationHoles> fill;
    fill->AddObserver(vtkCommand::WarningEvent, observer);
    fill->AddObserver(vtkCommand::ErrorEvent, observer);
    fill->SetInputData(input);
    fill->SetSpacing(spacing);
    fill->Update();
    // One that leaves the range of numbers fails each hole, whatever it would take.
    const bool isRefused = spacing < 1.0 && spacing > 1e-150;
    Check(observer->GetError() == isRefused, "a spacing that takes too much is refused");
    Check(!isRefused || observer->GetErrorMessage().find("A Spacing of ") != std::string::npos,
      "with one that would do");
    observer->Clear();
    fill->SetMaximumNumberOfInsertedPoints(1000000); // no more than what is refused: holes fail
    fill->Update();
    Check(!observer->GetError(), "with few points to insert, an extreme spacing is no error");
    Check(observer->GetWarning() == (spacing < 1.0), "holes that take too much warn");
    Check(fill->GetNumberOfHoles() == 3, "all holes are listed");
    Check(fill->GetNumberOfFilledHoles() == (spacing < 1.0 ? 0 : 3), "and those possible filled");
    Check(
      fill->GetOutput()->GetNumberOfCells() >= input->GetNumberOfCells(), "the surface is there");
    if (spacing < 1.0)
    {
      Check(
        observer->GetWarningMessage().find("Hole 0") != std::string::npos, "the warning names it");
      Check(fill->GetOutput(1)->GetCellData()->GetArray("Status")->GetTuple1(0) ==
          vtkFillElevationHoles::FAILED,
        "Status says so");
    }
  }
}

/** Arrays of the input that have the names of arrays of the output, and are active. */
void TestReplacedArrays()
{
  for (const bool hasHole : { true, false })
  {
    auto input = MakeFlatSheet(hasHole ? OneHole : std::vector<std::string>{ "##" });
    vtkNew<vtkDoubleArray> ofPoints;
    ofPoints->SetName("FilledPoint");
    ofPoints->SetNumberOfTuples(input->GetNumberOfPoints());
    ofPoints->Fill(5.0);
    input->GetPointData()->SetScalars(ofPoints);
    vtkNew<vtkDoubleArray> ofCells;
    ofCells->SetName("HoleId");
    ofCells->SetNumberOfComponents(3);
    ofCells->SetNumberOfTuples(input->GetNumberOfCells());
    ofCells->Fill(5.0);
    input->GetCellData()->SetNormals(ofCells);
    vtkNew<vtkFillElevationHoles> fill;
    fill->SetInputData(input);
    fill->Update();
    vtkPointData* pointData = fill->GetOutput()->GetPointData();
    vtkCellData* cellData = fill->GetOutput()->GetCellData();
    Check(Named<vtkUnsignedCharArray>(pointData, "FilledPoint") && !pointData->GetScalars(),
      "a replaced array leaves its role as scalars empty");
    Check(Named<vtkIdTypeArray>(cellData, "HoleId") && !cellData->GetNormals(),
      "a replaced array leaves its role as normals empty");
    Check(input->GetPointData()->GetScalars() == ofPoints &&
        input->GetCellData()->GetNormals() == ofCells,
      "the input keeps its arrays");
  }
}

void TestNumberOfInsertedPoints()
{
  vtkNew<vtkFillElevationHoles> fill;
  Check(fill->GetMaximumNumberOfInsertedPoints() == 100000000, "100 million is the default");
  fill->SetInputData(MakeSheet(ThreeHoles, VTK_DOUBLE, Tilted));
  fill->SetSpacing(0.25);
  vtkNew<vtkTest::ErrorObserver> observer;
  fill->AddObserver(vtkCommand::WarningEvent, observer);
  fill->Update();
  const vtkIdType all = fill->GetOutput()->GetNumberOfPoints();
  Check(fill->GetNumberOfFilledHoles() == 3 && !observer->GetWarning(), "all fit into the default");
  for (const int threads : { 1, 3 })
  {
    observer->Clear();
    fill->SetNumberOfThreads(threads);
    fill->SetMaximumNumberOfInsertedPoints(220); // the largest alone takes more
    fill->Update();
    vtkDataArray* status = fill->GetOutput(1)->GetCellData()->GetArray("Status");
    vtkDataArray* area = fill->GetOutput(1)->GetCellData()->GetArray("Area");
    vtkDataArray* inserted = fill->GetOutput(1)->GetCellData()->GetArray("NumberOfInsertedPoints");
    double sum = 0.0;
    for (vtkIdType i = 0; i < 3; ++i)
    {
      Check((status->GetTuple1(i) == vtkFillElevationHoles::FAILED) == (area->GetTuple1(i) == 13.0),
        "the hole that may take more points than are left fails, and later ones do not");
      sum += inserted->GetTuple1(i);
    }
    Check(sum > 100.0 && sum <= 220.0, "the limit is kept");
    Check(observer->GetWarning() && !observer->GetError(), "with a warning");
    Check(observer->GetWarningMessage().find("MaximumNumberOfInsertedPoints, 220") !=
        std::string::npos,
      "that names the limit");
  }
  observer->Clear();
  fill->SetMaximumNumberOfInsertedPoints(0);
  fill->Update();
  Check(fill->GetOutput()->GetNumberOfPoints() == all && !observer->GetWarning(), "0 is no limit");
}

void TestPrint()
{
  vtkNew<vtkFillElevationHoles> fill;
  Check(fill->GetInterpolation() == vtkFillElevationHoles::ADAPTIVE, "Adaptive is the default");
  fill->SetInterpolation(-1);
  Check(fill->GetInterpolation() == vtkFillElevationHoles::NEIGHBOR_MEAN, "numbers are clamped");
  fill->SetInterpolationToAdaptive();
  std::ostringstream text;
  fill->Print(text);
  for (const char* name :
    { "MaximumHoleSize", "MaximumHoleEdges", "MaximumNumberOfInsertedPoints: 100000000",
      "Spacing: 0", "Interpolation: Adaptive", "ConfidenceLevel: 0.9", "InterpolatePointData: On",
      "NumberOfHoles", "NumberOfFilledHoles" })
  {
    Check(text.str().find(name) != std::string::npos, std::string("Print shows ") + name);
  }
}
} // namespace

int TestFillElevationHoles(int, char*[])
{
  TestArrays(VTK_DOUBLE);
  TestArrays(VTK_FLOAT);
  TestNaNIsLeftOut();
  TestReport();
  TestRange();
  TestSeparateCoordinates();
  TestUnlimitedSpacing();
  TestReplacedArrays();
  TestNumberOfInsertedPoints();
  TestPrint();
  return failures ? EXIT_FAILURE : EXIT_SUCCESS;
}
