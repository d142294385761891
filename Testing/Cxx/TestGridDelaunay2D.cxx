// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The pipeline side of vtkGridDelaunay2D, by numbers: what passes, what is counted and listed, what
// errors and aborts leave behind, and that the input is never written.
#include "Check.h"
#include "Inputs.h"
#include "MeshRules.h"
#include "WatchedProgress.h"
#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkGridDelaunay2D.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTestErrorObserver.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

namespace
{
/** A 5 x 4 lattice, one node twice, one point not finite, with arrays of several kinds. */
vtkSmartPointer<vtkPolyData> MakeInput(int precision)
{
  auto input = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(precision);
  for (int i = 0; i < 20; ++i)
  {
    points->InsertNextPoint(i % 5, i / 5, 0.1 * i);
  }
  points->InsertNextPoint(2.0, 1.0, 7.0);
  points->InsertNextPoint(std::nan(""), 1.0, 7.0);
  input->SetPoints(points);

  vtkNew<vtkDoubleArray> numbers;
  numbers->SetName("Amplitude");
  vtkNew<vtkStringArray> names;
  names->SetName("Name");
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    numbers->InsertNextValue(0.5 * i);
    names->InsertNextValue(std::to_string(i));
  }
  input->GetPointData()->SetScalars(numbers);
  input->GetPointData()->AddArray(names);
  vtkNew<vtkIntArray> survey;
  survey->SetName("Survey");
  survey->InsertNextValue(42);
  input->GetFieldData()->AddArray(survey);
  return input;
}

void TestOutput(int precision)
{
  auto input = MakeInput(precision);
  const vtkMTimeType time = input->GetMTime();
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(input);
  delaunay->Update();
  vtkPolyData* output = delaunay->GetOutput();

  Check(input->GetMTime() == time && input->GetNumberOfCells() == 0 &&
      input->GetFieldData()->GetNumberOfArrays() == 1,
    "the input is not written");
  Check(output->GetPoints() == input->GetPoints(), "the points are shared with the input");
  Check(output->GetPointData()->GetScalars() == input->GetPointData()->GetScalars() &&
      output->GetPointData()->GetAbstractArray("Name") != nullptr,
    "point data passes");
  Check(output->GetFieldData()->GetArray("Survey") != nullptr, "field data passes");
  Check(output->GetNumberOfPolys() == 2 * 4 * 3, "every cell of the lattice has two triangles");
  Check(output->GetNumberOfCells() == output->GetNumberOfPolys(), "there are no other cells");

  Check(NumberOfFindings(output, elevation::ValidateOptions()) == 0,
    "triangles are counter-clockwise and Delaunay, cut ties by the rule and cover the hull");

  Check(delaunay->GetNumberOfDuplicatePoints() == 1, "one duplicate is counted");
  Check(delaunay->GetNumberOfNonFinitePoints() == 1, "one point that is not finite is counted");
  auto* unused = vtkIdTypeArray::SafeDownCast(output->GetFieldData()->GetArray("UnusedPointIds"));
  auto* reasons =
    vtkUnsignedCharArray::SafeDownCast(output->GetFieldData()->GetArray("UnusedPointReasons"));
  Check(unused && unused->GetNumberOfTuples() == 2 && unused->GetValue(0) == 20 &&
      unused->GetValue(1) == 21,
    "unused points are listed");
  Check(reasons && reasons->GetNumberOfTuples() == 2 && reasons->GetValue(0) == 1 &&
      reasons->GetValue(1) == 2,
    "with their reasons");
  Check(output->GetFieldData()->GetArray("NumberOfDuplicatePoints")->GetTuple1(0) == 1 &&
      output->GetFieldData()->GetArray("NumberOfNonFinitePoints")->GetTuple1(0) == 1,
    "counts stand in the field data");

  auto* lattice = vtkDoubleArray::SafeDownCast(output->GetFieldData()->GetArray("Lattice"));
  const double expected[6] = { 0.0, 0.0, 1.0, 0.0, 0.0, 1.0 };
  Check(delaunay->GetLatticeFound() && lattice && lattice->GetNumberOfTuples() == 1 &&
      std::equal(expected, expected + 6, lattice->GetPointer(0)),
    "the lattice is reported");
  vtkNew<vtkGridDelaunay2D> again;
  again->SetLatticeModeToOff();
  again->SetInputData(output);
  again->Update();
  Check(!again->GetLatticeFound() && !again->GetOutput()->GetFieldData()->GetArray("Lattice"),
    "no lattice is reported when none was looked for, nor one of the input");

  delaunay->SetDuplicatePolicyToKeepHighest();
  delaunay->Update();
  unused =
    vtkIdTypeArray::SafeDownCast(delaunay->GetOutput()->GetFieldData()->GetArray("UnusedPointIds"));
  Check(unused->GetValue(0) == 7, "the highest of two points at one place is the vertex");
  Check(NumberOfFindings(delaunay->GetOutput(), elevation::ValidateOptions()) == 0,
    "the triangulation with other vertices is as good");

  delaunay->SetMaximumEdgeLength(1.2);
  delaunay->Update();
  Check(delaunay->GetOutput()->GetNumberOfPolys() == 0, "diagonals are longer than the limit");
}

void TestOtherPointSets()
{
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(MakeInput(VTK_DOUBLE)->GetPoints());
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(grid);
  delaunay->Update();
  Check(delaunay->GetOutput()->GetNumberOfPolys() == 24, "any point set is an input");

  vtkNew<vtkPoints> integers;
  integers->SetDataType(VTK_INT);
  for (int i = 0; i < 9; ++i)
  {
    integers->InsertNextPoint(i % 3, i / 3, 0);
  }
  vtkNew<vtkPolyData> whole;
  whole->SetPoints(integers);
  delaunay->SetInputData(whole);
  delaunay->Update();
  Check(delaunay->GetOutput()->GetNumberOfPolys() == 8, "points of any type are an input");
  Check(NumberOfFindings(delaunay->GetOutput(), elevation::ValidateOptions()) == 0,
    "and make a Delaunay triangulation");
}

void TestTooFewPoints()
{
  for (const int count : { 0, 1, 2, 6 })
  {
    vtkNew<vtkPoints> points;
    for (int i = 0; i < count; ++i)
    {
      points->InsertNextPoint(i, 2.0 * i, 0.0);
    }
    vtkNew<vtkPolyData> input;
    input->SetPoints(points);
    vtkNew<vtkGridDelaunay2D> delaunay;
    vtkNew<vtkTest::ErrorObserver> observer;
    delaunay->AddObserver(vtkCommand::WarningEvent, observer);
    delaunay->AddObserver(vtkCommand::ErrorEvent, observer);
    delaunay->SetInputData(input);
    delaunay->Update();
    Check(observer->GetWarning() == (count > 0) && !observer->GetError(),
      "too few points give a warning, and none are an empty input");
    Check(delaunay->GetOutput()->GetNumberOfPoints() == count &&
        delaunay->GetOutput()->GetNumberOfCells() == 0,
      "points pass, without a triangle");
  }
}

vtkSmartPointer<vtkPolyData> RandomPoints(int count)
{
  return RandomCloud(5, count, 1.0, VTK_FLOAT, [](double, double) { return 0.0; });
}

std::vector<vtkIdType> Corners(vtkPolyData* surface)
{
  std::vector<vtkIdType> corners;
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfPolys(); ++cell)
  {
    surface->GetPolys()->GetCellAtId(cell, size, ids);
    corners.insert(corners.end(), ids, ids + size);
  }
  return corners;
}

/** A warning names a limit that leaves most points without a triangle, and one that does not. */
void TestLimitTooSmall()
{
  for (const double step : { 3e-7, 25.0, 4e9 })
  {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (int i = 0; i < 30 * 30; ++i)
    {
      points->InsertNextPoint(
        step * (i % 30 + 0.2 * std::sin(i)), step * (i / 30 + 0.2 * std::cos(7.0 * i)), 0.0);
    }
    vtkNew<vtkPolyData> cloud;
    cloud->SetPoints(points);
    vtkNew<vtkGridDelaunay2D> delaunay;
    vtkNew<vtkTest::ErrorObserver> observer;
    delaunay->AddObserver(vtkCommand::WarningEvent, observer);
    delaunay->SetInputData(cloud);
    delaunay->SetMaximumEdgeLength(0.5 * step);
    delaunay->Update();
    const std::string text = observer->GetWarningMessage();
    Check(text.find("900 of 900 points are left without a triangle") != std::string::npos &&
        delaunay->GetOutput()->GetNumberOfPoints() == 900,
      "an empty result says why; it was: " + text);
    const std::string before = "A MaximumEdgeLength of ";
    const double limit = std::atof(text.c_str() + text.find(before) + before.size());
    Check(limit > step && limit < 3.0 * step, "the limit fits the points: " + text);
    observer->Clear();
    delaunay->SetMaximumEdgeLength(limit);
    delaunay->Update();
    std::vector<char> has(900, 0);
    vtkNew<vtkIdList> ids;
    for (vtkIdType i = 0; i < delaunay->GetOutput()->GetNumberOfPolys(); ++i)
    {
      delaunay->GetOutput()->GetCellPoints(i, ids);
      for (int k = 0; k < 3; ++k)
      {
        has[ids->GetId(k)] = 1;
      }
    }
    Check(std::count(has.begin(), has.end(), 1) >= 0.95 * 900 &&
        std::count(has.begin(), has.end(), 1) < 900 && !observer->GetWarning(),
      "the limit that is advised keeps triangles at 95 % of the points");
  }
}

void TestSearchStrategy()
{
  vtkNew<vtkGridDelaunay2D> delaunay;
  Check(delaunay->GetSearchStrategy() == vtkGridDelaunay2D::VOXEL_TRAVERSAL &&
      std::string(delaunay->GetSearchStrategyAsString()) == "VoxelTraversal",
    "voxel traversal is the default");
  const vtkMTimeType time = delaunay->GetMTime();
  delaunay->SetSearchStrategyToCompactness();
  Check(delaunay->GetMTime() > time, "another strategy modifies the filter");
  Check(std::string(delaunay->GetSearchStrategyAsString()) == "Compactness", "it has a name");
  delaunay->SetSearchStrategy(-3);
  Check(delaunay->GetSearchStrategy() == vtkGridDelaunay2D::VOXEL_TRAVERSAL, "clamped from below");
  delaunay->SetSearchStrategy(3);
  Check(delaunay->GetSearchStrategy() == vtkGridDelaunay2D::COMPACTNESS, "clamped from above");

  for (const bool isLattice : { false, true })
  {
    for (const double limit : { 0.0, isLattice ? 1.2 : 0.02 })
    {
      delaunay->SetInputData(isLattice ? MakeInput(VTK_DOUBLE) : RandomPoints(5000));
      delaunay->SetMaximumEdgeLength(limit);
      delaunay->SetSearchStrategyToVoxelTraversal();
      delaunay->Update();
      const std::vector<vtkIdType> corners = Corners(delaunay->GetOutput());
      delaunay->SetSearchStrategyToCompactness();
      delaunay->Update();
      Check(delaunay->GetLatticeFound() == isLattice, "only the nodes are a lattice");
      Check(Corners(delaunay->GetOutput()) == corners, "both searches give the same triangles");
      Check(corners.empty() == (isLattice && limit > 0.0), "there are triangles");
    }
  }
}

void TestProgressAndAbort()
{
  vtkSmartPointer<vtkPolyData> input = RandomPoints(100000);
  vtkPoints* points = input->GetPoints();
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(input);

  WatchedProgress progress(delaunay);
  delaunay->Update();
  Check(progress.IsRising && progress.Last == 1.0, "progress rises to 1");
  Check(delaunay->GetOutput()->GetNumberOfPolys() > 199000, "all triangles are there");
  Check(NumberOfFindings(delaunay->GetOutput(), elevation::ValidateOptions()) == 0,
    "the triangulation of random points is Delaunay");
  delaunay->SetMaximumEdgeLength(0.005);
  delaunay->Update();
  Check(delaunay->GetOutput()->GetNumberOfPolys() > 100000 &&
      NumberOfFindings(delaunay->GetOutput(), RulesOfDelaunayPart()) == 0,
    "what a limit on edges leaves of it is part of it");
  delaunay->SetMaximumEdgeLength(0.0);

  progress.AbortAt(0.4);
  Check(delaunay->GetOutput()->GetNumberOfCells() == 0 &&
      delaunay->GetOutput()->GetNumberOfPoints() == 0,
    "an abort leaves empty output");

  points->SetPoint(0, points->GetPoint(1)); // a duplicate, to be counted
  progress.AbortAt(1.0);
  Check(
    delaunay->GetOutput()->GetNumberOfCells() == 0 && delaunay->GetNumberOfDuplicatePoints() == 0,
    "an abort at the last report leaves no counts");
}

/** Observers hear of the work; the unit tests named Progress check how often at most. */
void TestReportsAreMany()
{
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_DOUBLE);
  constexpr int count = 50000;
  for (int i = 0; i < count; ++i)
  {
    const double x = static_cast<double>(i) / count;
    points->InsertNextPoint(x, x * x, 0.0); // divided and conquered
  }
  vtkNew<vtkPolyData> input;
  input->SetPoints(points);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(input);
  int reports = 0;
  vtkNew<vtkCallbackCommand> callback;
  callback->SetClientData(&reports);
  callback->SetCallback(
    [](vtkObject*, unsigned long, void* data, void*) { ++*static_cast<int*>(data); });
  delaunay->AddObserver(vtkCommand::ProgressEvent, callback);
  delaunay->Update();
  Check(delaunay->GetOutput()->GetNumberOfPolys() == count - 2, "a parabola is triangulated");
  Check(reports > 100, "few reports");
}

void TestArraysThatDoNotFit()
{
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  points->InsertNextPoint(1, 0, 0);
  points->InsertNextPoint(0, 1, 0);
  vtkNew<vtkPolyData> input;
  input->SetPoints(points);
  vtkNew<vtkDoubleArray> values;
  values->SetName("Picks");
  values->InsertNextValue(1.0);
  input->GetPointData()->AddArray(values);
  vtkNew<vtkGridDelaunay2D> delaunay;
  vtkNew<vtkTest::ErrorObserver> observer;
  delaunay->AddObserver(vtkCommand::ErrorEvent, observer);
  delaunay->SetInputData(input);
  delaunay->Update();
  Check(observer->GetErrorMessage().find(
          "Point array \"Picks\" has 1 tuples, but there are 3 points.") != std::string::npos,
    "an array that does not fit the points is refused by name");
  Check(delaunay->GetOutput()->GetNumberOfPoints() == 0, "and leaves empty output");
}

void TestLimitIsALength()
{
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  points->InsertNextPoint(1, 0, 0);
  points->InsertNextPoint(0, 1, 0);
  vtkNew<vtkPolyData> input;
  input->SetPoints(points);
  vtkNew<vtkGridDelaunay2D> delaunay;
  vtkNew<vtkTest::ErrorObserver> observer;
  delaunay->AddObserver(vtkCommand::ErrorEvent, observer);
  delaunay->SetInputData(input);
  for (const double length : { -1.0, std::nan("") })
  {
    delaunay->SetMaximumEdgeLength(length);
    delaunay->Modified();
    delaunay->Update();
    Check(observer->GetErrorMessage().find("MaximumEdgeLength is ") != std::string::npos &&
        delaunay->GetOutput()->GetNumberOfPoints() == 0,
      "a limit that is no length is an error");
    observer->Clear();
  }
  delaunay->SetMaximumEdgeLength(HUGE_VAL);
  delaunay->Update();
  Check(!observer->GetError() && delaunay->GetOutput()->GetNumberOfPolys() == 1,
    "an infinite limit is none");
}
} // namespace

int TestGridDelaunay2D(int, char*[])
{
  TestOutput(VTK_FLOAT);
  TestOutput(VTK_DOUBLE);
  TestOtherPointSets();
  TestTooFewPoints();
  TestLimitTooSmall();
  TestSearchStrategy();
  TestProgressAndAbort();
  TestReportsAreMany();
  TestArraysThatDoNotFit();
  TestLimitIsALength();
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
