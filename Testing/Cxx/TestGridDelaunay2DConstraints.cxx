// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The second input of vtkGridDelaunay2D, by numbers: what is added, what stays shared, what arrays
// hold at added points, what is counted, and which constraints are refused.
#include "Check.h"
#include "FaultyCells.h"
#include "MeshRules.h"
#include "WatchedProgress.h"
#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkGridDelaunay2D.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTestErrorObserver.h"
#include "vtkTrivialProducer.h"

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

namespace
{
/** A lattice of 9 x 9 nodes with arrays. */
vtkSmartPointer<vtkPolyData> MakeInput(int precision)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(precision);
  vtkNew<vtkFloatArray> amplitude;
  amplitude->SetName("Amplitude");
  vtkNew<vtkIntArray> inlines;
  inlines->SetName("Inline");
  vtkNew<vtkStringArray> names;
  names->SetName("Name");
  vtkNew<vtkDoubleArray> alone;
  alone->SetName("OfTheInputAlone");
  for (int i = 0; i < 81; ++i)
  {
    points->InsertNextPoint(i % 9, i / 9, 0.125 * i);
    amplitude->InsertNextValue(i);
    inlines->InsertNextValue(i);
    names->InsertNextValue(std::to_string(i));
    alone->InsertNextValue(i);
  }
  auto input = vtkSmartPointer<vtkPolyData>::New();
  input->SetPoints(points);
  input->GetPointData()->SetScalars(amplitude);
  input->GetPointData()->AddArray(inlines);
  input->GetPointData()->AddArray(names);
  input->GetPointData()->AddArray(alone);
  return input;
}

/** Lines through points; the last one is a polygon when asked. */
vtkSmartPointer<vtkPolyData> MakeLines(
  const std::vector<std::vector<std::vector<double>>>& lines, bool isLastPolygon = false)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkCellArray> polygons;
  vtkNew<vtkDoubleArray> amplitude;
  amplitude->SetName("Amplitude");
  vtkNew<vtkIntArray> inlines;
  inlines->SetName("Inline");
  vtkNew<vtkStringArray> names;
  names->SetName("Name");
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    vtkCellArray* to = isLastPolygon && i + 1 == lines.size() ? polygons.Get() : cells.Get();
    to->InsertNextCell(static_cast<int>(lines[i].size()));
    for (const auto& p : lines[i])
    {
      to->InsertCellPoint(points->InsertNextPoint(p.data()));
      amplitude->InsertNextValue(1000.0 + p[0]);
      inlines->InsertNextValue(7);
      names->InsertNextValue("line " + std::to_string(i));
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(cells);
  data->SetPolys(polygons);
  data->GetPointData()->AddArray(amplitude);
  data->GetPointData()->AddArray(inlines);
  data->GetPointData()->AddArray(names);
  return data;
}

bool HasEdge(vtkPolyData* surface, vtkIdType from, vtkIdType to)
{
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfPolys(); ++cell)
  {
    surface->GetPolys()->GetCellAtId(cell, size, ids);
    for (int i = 0; i < 3; ++i)
    {
      if ((ids[i] == from && ids[(i + 1) % 3] == to) || (ids[i] == to && ids[(i + 1) % 3] == from))
      {
        return true;
      }
    }
  }
  return false;
}

void TestNothingIsAdded()
{
  auto input = MakeInput(VTK_FLOAT);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(input);
  Check(delaunay->GetSource() == nullptr, "there are no constraints at first");
  delaunay->Update();
  vtkNew<vtkPolyData> plain;
  plain->DeepCopy(delaunay->GetOutput());

  auto lines = MakeLines({ { { 1, 1, -50 }, { 3, 2, -50 } } });
  delaunay->SetSourceData(lines);
  Check(delaunay->GetSource() == lines, "GetSource() returns the constraints");
  delaunay->Update();
  vtkPolyData* output = delaunay->GetOutput();
  Check(output->GetPoints()->GetDataType() == VTK_DOUBLE &&
      output->GetNumberOfPoints() == input->GetNumberOfPoints() &&
      output->GetPointData()->GetScalars() == input->GetPointData()->GetScalars(),
    "points are double, and arrays stay shared when nothing is added");
  Check(HasEdge(output, 10, 21) && !HasEdge(plain, 10, 21), "the line is an edge");
  Check(!delaunay->GetLatticeFound() && !output->GetFieldData()->GetArray("Lattice"),
    "no lattice with constraints");
  Check(NumberOfFindings(output, RulesOfConstrained()) == 0, "the whole hull is covered");

  vtkNew<vtkTrivialProducer> producer;
  producer->SetOutput(lines);
  delaunay->SetSourceConnection(producer->GetOutputPort());
  delaunay->Update();
  Check(HasEdge(delaunay->GetOutput(), 10, 21), "constraints may come through a connection");
  delaunay->SetSourceConnection(nullptr);
  delaunay->Update();
  Check(delaunay->GetSource() == nullptr && delaunay->GetLatticeFound(), "and can be taken away");
}

void TestPointsAreAdded()
{
  auto input = MakeInput(VTK_FLOAT);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(input);
  // 81, 82 and, of a polygon, 83 and 84; two crossings with the polygon, 85 and 86.
  delaunay->SetSourceData(MakeLines({ { { 0.5, 4.5, 40.0 }, { 7.5, 4.5, 54.0 } },
                                      { { 3.0, 3.0, 0.0 }, { 4.5, 6.5, 2.5 }, { 2.5, 6.5, 3.5 } } },
    true));
  delaunay->Update();
  vtkPolyData* output = delaunay->GetOutput();
  Check(output->GetNumberOfPoints() == 87 && delaunay->GetNumberOfAddedPoints() == 6,
    "points are added behind the input's");
  Check(delaunay->GetNumberOfConstraintCrossings() == 2 &&
      output->GetFieldData()->GetArray("NumberOfConstraintCrossings")->GetTuple1(0) == 2 &&
      output->GetFieldData()->GetArray("NumberOfAddedPoints")->GetTuple1(0) == 6,
    "crossings and added points are counted");
  Check(input->GetNumberOfPoints() == 81 &&
      input->GetPointData()->GetScalars()->GetNumberOfTuples() == 81 &&
      input->GetPoints() != output->GetPoints(),
    "the input is not written");
  Check(output->GetPoints()->GetDataType() == VTK_DOUBLE, "a third is no float");
  double p[3];
  output->GetPoint(82, p);
  Check(p[0] == 7.5 && p[1] == 4.5 && p[2] == 54.0, "an added point has its own z");
  output->GetPoint(80, p);
  Check(p[0] == 8.0 && p[1] == 8.0 && p[2] == 10.0, "the others stay");
  vtkDataArray* amplitude = output->GetPointData()->GetScalars();
  Check(amplitude && amplitude->GetDataType() == VTK_FLOAT &&
      std::string(amplitude->GetName()) == "Amplitude" && amplitude->GetTuple1(80) == 80.0 &&
      amplitude->GetTuple1(82) == 1007.5,
    "arrays have the constraints' values at their points");
  for (vtkIdType id = 85; id < 87; ++id)
  {
    output->GetPoint(id, p);
    Check(std::fabs(p[2] - (40.0 + 2.0 * (p[0] - 0.5))) < 1e-12 && p[1] == 4.5,
      "z of a crossing is that of the first line");
    Check(std::fabs(amplitude->GetTuple1(id) - (1000.0 + p[0])) < 1e-3, "and so are numbers");
  }
  Check(output->GetPointData()->GetArray("Inline")->GetTuple1(82) == 7 &&
      output->GetPointData()->GetArray("Inline")->GetTuple1(85) == 0,
    "integers are the constraints', or 0");
  auto* names = vtkStringArray::SafeDownCast(output->GetPointData()->GetAbstractArray("Name"));
  Check(names && names->GetValue(80) == "80" && names->GetValue(81) == "line 0" &&
      names->GetValue(84) == "line 1" && names->GetValue(85).empty(),
    "strings are the constraints', or empty");
  Check(std::isnan(output->GetPointData()->GetArray("OfTheInputAlone")->GetTuple1(82)),
    "what the constraints do not have is not a number");
  Check(HasEdge(output, 84, 85) && HasEdge(output, 85, 30), "polygons are closed");

  delaunay->SetSourceData(MakeLines({ { { 0.5, 4.5, 40.0 }, { 7.5, 4.5, 54.0 } } }));
  delaunay->Update();
  Check(delaunay->GetOutput()->GetPoints()->GetDataType() == VTK_DOUBLE &&
      delaunay->GetOutput()->GetNumberOfPoints() == 83,
    "points are double also where the added ones are exact in float");

  delaunay->SetMaximumEdgeLength(1.5);
  delaunay->SetSourceData(MakeLines({ { { 0, 0, 0 }, { 8, 7, 0 } } }));
  delaunay->Update();
  Check(delaunay->GetOutput()->GetNumberOfPolys() > 80 && !HasEdge(delaunay->GetOutput(), 0, 71),
    "the edge limit applies to edges of lines");
}

void TestNormalsAtCrossings()
{
  // From one column of the lattice to the next they turn from one axis to another.
  const auto withNormals = [](vtkPolyData* data) {
    vtkNew<vtkFloatArray> normals;
    normals->SetName("Normals");
    normals->SetNumberOfComponents(3);
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    {
      const int column = static_cast<int>(data->GetPoint(i)[0]) % 2;
      normals->InsertNextTuple3(column, 0.0, 1 - column);
    }
    data->GetPointData()->AddArray(normals);
    return normals->GetName();
  };
  auto input = MakeInput(VTK_DOUBLE);
  auto lines =
    MakeLines({ { { 1.5, 1.5, 0 }, { 3.5, 3.5, 0 } }, { { 1.5, 3.5, 0 }, { 3.5, 2.0, 0 } } });
  withNormals(lines);
  const char* name = withNormals(input);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(input);
  delaunay->SetSourceData(lines);
  for (const bool areActive : { false, true })
  {
    input->GetPointData()->SetActiveAttribute(
      areActive ? name : nullptr, vtkDataSetAttributes::NORMALS);
    input->Modified();
    delaunay->Update();
    vtkPolyData* output = delaunay->GetOutput();
    const vtkIdType last = output->GetNumberOfPoints() - 1;
    double normal[3];
    output->GetPointData()->GetArray(name)->GetTuple(last, normal);
    const double length = std::hypot(normal[0], normal[2]);
    Check(delaunay->GetNumberOfConstraintCrossings() == 1 && normal[0] > 0 && normal[2] > 0,
      "normals are interpolated at crossings");
    Check(areActive == (std::fabs(length - 1.0) < 1e-6),
      "those that are active normals have unit length, other arrays are left as they are");
  }
}

/** Ids name input points; those of the constraints are theirs, and crossings have none. */
void TestIds()
{
  auto input = MakeInput(VTK_DOUBLE);
  input->GetPointData()->SetPedigreeIds(input->GetPointData()->GetArray("Inline"));
  vtkNew<vtkIdTypeArray> own;
  own->SetName("Own");
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    own->InsertNextValue(i);
  }
  input->GetPointData()->SetGlobalIds(own);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(input);
  delaunay->SetSourceData(
    MakeLines({ { { 1.5, 1.5, 0 }, { 3.5, 3.5, 0 } }, { { 1.5, 3.5, 0 }, { 3.5, 2.0, 0 } } }));
  delaunay->Update();
  vtkPointData* data = delaunay->GetOutput()->GetPointData();
  const vtkIdType last = delaunay->GetOutput()->GetNumberOfPoints() - 1;
  Check(delaunay->GetNumberOfConstraintCrossings() == 1 && data->GetPedigreeIds() &&
      data->GetPedigreeIds() == data->GetArray("Inline") &&
      data->GetArray("Inline")->GetTuple1(80) == 80 &&
      data->GetArray("Inline")->GetTuple1(81) == 7 &&
      data->GetArray("Inline")->GetTuple1(last) == -1,
    "a crossing has no pedigree id");
  Check(data->GetGlobalIds() && data->GetGlobalIds() == data->GetArray("Own") &&
      data->GetArray("Own")->GetTuple1(80) == 80 && data->GetArray("Own")->GetTuple1(81) == 81 &&
      data->GetArray("Own")->GetTuple1(last) == static_cast<double>(last),
    "added points have global ids after the largest");
}

void TestRefusals()
{
  const auto messageOf = [](vtkPolyData* source) {
    vtkNew<vtkGridDelaunay2D> delaunay;
    vtkNew<vtkTest::ErrorObserver> observer;
    delaunay->AddObserver(vtkCommand::ErrorEvent, observer);
    delaunay->SetInputData(MakeInput(VTK_DOUBLE));
    delaunay->SetSourceData(source);
    delaunay->Update();
    Check(delaunay->GetOutput()->GetNumberOfPoints() == 0 &&
        delaunay->GetNumberOfConstraintCrossings() == 0 && delaunay->GetNumberOfAddedPoints() == 0,
      "an error leaves empty output");
    return observer->GetErrorMessage();
  };
  const auto expect = [&](vtkPolyData* source, const std::string& words) {
    const std::string message = messageOf(source);
    Check(message.find(words) != std::string::npos, words + "; but it was: " + message);
  };
  expect(MakeLines({ { { 0, 0, 0 }, { 1, 1, 0 } }, { { 2, 2, 0 }, { NAN, 1, 0 } } }),
    "Point 3 of the constraints' cell 1 has a coordinate that is not finite.");

  // Cells are numbered as vtkPolyData does: vertices, lines, polygons.
  auto mixed =
    MakeLines({ { { 0, 0, 0 }, { 1, 1, 0 } }, { { 2, 2, 0 }, { NAN, 1, 0 }, { 3, 3, 0 } } }, true);
  vtkNew<vtkCellArray> vertices;
  vertices->InsertNextCell({ 0 });
  vertices->InsertNextCell({ 1, 2 });
  mixed->SetVerts(vertices);
  expect(mixed, "Point 3 of the constraints' cell 3 has a coordinate that is not finite.");

  auto missing = MakeLines({ { { 0, 0, 0 }, { 1, 1, 0 } } });
  const vtkIdType ids[2] = { 1, 4294967296 };
  missing->GetLines()->InsertNextCell(2, ids);
  expect(missing, "Point 4294967296 of the constraints' cell 1 does not exist.");

  auto strips = MakeLines({ { { 0, 0, 0 }, { 1, 1, 0 }, { 1, 2, 0 } } });
  vtkNew<vtkCellArray> strip;
  const vtkIdType corners[3] = { 0, 1, 2 };
  strip->InsertNextCell(3, corners);
  strips->SetStrips(strip);
  expect(strips, "There are triangle strips in the constraints");

  // Vertex cells and points in no cell are no constraints.
  auto pointsOnly = MakeLines({ { { 1, 1, 0 }, { 3, 2, 0 } } });
  pointsOnly->SetVerts(pointsOnly->GetLines());
  pointsOnly->SetLines(nullptr);
  expect(pointsOnly, "The constraints have no line and no polygon.");
  expect(vtkSmartPointer<vtkPolyData>::New(), "The constraints have no line and no polygon.");

  expect(MakeLines({ { { 100, 200, 0 }, { 101, 205, 0 } } }),
    "The constraints are at x 100 to 101, y 200 to 205, the points at x 0 to 8, y 0 to 8: are both "
    "in the same coordinates?");

  auto arrays = MakeLines({ { { 0, 0, 0 }, { 1, 1, 0 } } });
  arrays->GetPointData()->GetArray("Inline")->InsertNextTuple1(3);
  expect(arrays, "The constraints' point array \"Inline\" has 3 tuples, but there are 2 points.");

  ForEachFaultyCells([&](const auto& spoil, const std::string& kind, const std::string& fault) {
    auto faulty = MakeLines({ { { 0, 0, 0 }, { 1, 1, 0 }, { 2, 0, 0 } } });
    spoil(faulty);
    expect(faulty, "The constraints' " + kind);
    expect(faulty, fault);
  });
}

/** Lines that lie mostly far outside the points add them with a warning. */
void TestLinesOutside()
{
  const auto warningOf = [](vtkPolyData* source, vtkIdType added) {
    vtkNew<vtkGridDelaunay2D> delaunay;
    vtkNew<vtkTest::ErrorObserver> observer;
    delaunay->AddObserver(vtkCommand::WarningEvent, observer);
    delaunay->SetInputData(MakeInput(VTK_DOUBLE));
    delaunay->SetSourceData(source);
    delaunay->Update();
    Check(delaunay->GetNumberOfAddedPoints() == added, "points of lines outside are added");
    return observer->GetWarningMessage();
  };
  const std::string far = warningOf(MakeLines({ { { 4, 4, 0 }, { 30, 5, 0 }, { 40, 9, 0 } } }), 2);
  Check(far.find("2 of the 3 points along the constraints' lines lie far outside the points") !=
        std::string::npos &&
      far.find("x 4 to 40, y 4 to 9, the points at x 0 to 8, y 0 to 8") != std::string::npos,
    "a warning gives both places; it was: " + far);
  Check(warningOf(MakeLines({ { { 4, 4, 0 }, { 3, 5, 0 }, { 40, 9, 0 } } }), 1).empty(),
    "one point of three is no reason");
  Check(warningOf(MakeLines({ { { 4, 4, 0 }, { 3, 5, 0 }, { 5, 5, 0 }, { 30, 5, 0 },
                      { 40, 9, 0 } } }), 2).empty(),
    "nor are two of five");
  Check(warningOf(MakeLines({ { { -0.5, -0.5, 0 }, { 8.5, -0.5, 0 }, { 8.5, 8.5, 0 },
                    { -0.5, 8.5, 0 }, { -0.5, -0.5, 0 } } }),
          4)
          .empty(),
    "nor is an outline around the points");
}

void TestProgressAndAbort()
{
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 60000; ++i)
  {
    points->InsertNextPoint(std::fmod(i * 0.618033988749895, 1.0), i / 60000.0, 0.0);
  }
  vtkNew<vtkPolyData> input;
  input->SetPoints(points);
  std::vector<std::vector<std::vector<double>>> lines;
  for (int i = 1; i < 20; ++i)
  {
    lines.push_back({ { 0.05 * i, 0.1, 0 }, { 1 - 0.05 * i, 0.9, 0 } });
  }
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(input);
  delaunay->SetSourceData(MakeLines(lines));
  WatchedProgress progress(delaunay);
  delaunay->Update();
  Check(progress.IsRising && progress.Last == 1.0, "progress rises to 1");
  Check(progress.LargestStep < 0.3, "and is not silent for long");
  Check(delaunay->GetNumberOfConstraintCrossings() == 19 * 18 / 2, "all lines cross each other");
  for (const double at : { 0.05, 0.5, 0.9, 0.99 })
  {
    progress.AbortAt(at);
    Check(
      delaunay->GetOutput()->GetNumberOfPoints() == 0 && delaunay->GetNumberOfAddedPoints() == 0,
      "an abort leaves empty output");
  }
}
} // namespace

int TestGridDelaunay2DConstraints(int, char*[])
{
  TestNothingIsAdded();
  TestPointsAreAdded();
  TestNormalsAtCrossings();
  TestIds();
  TestRefusals();
  TestLinesOutside();
  TestProgressAndAbort();
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
