// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What points that trimming inserts, and the parts of triangles that it cuts, get of arrays that
// cannot be interpolated: integers, strings, and ids that name points and cells.
#include "Check.h"
#include "MeshRules.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkTrimOutwardTriangles.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace
{
using Place = std::pair<double, double>;

template <typename Array>
vtkSmartPointer<Array> MakeNumbered(const char* name, int first, int count)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  for (int i = 0; i < count; ++i)
  {
    array->InsertNextValue(first + i);
  }
  return array;
}

/** A square with a side of 8 cut from (8, 0) to (0, 8), behind a vertex and a line, with arrays. */
vtkSmartPointer<vtkPolyData> MakeSquare()
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkStringArray> names;
  names->SetName("Name");
  for (int i = 0; i < 4; ++i)
  {
    points->InsertNextPoint(8 * (i % 2), 8 * (i / 2), i);
    names->InsertNextValue(std::to_string(i));
  }
  auto square = vtkSmartPointer<vtkPolyData>::New();
  square->SetPoints(points);
  vtkNew<vtkCellArray> vertex, line, triangles;
  vertex->InsertNextCell({ 0 });
  line->InsertNextCell({ 0, 1 });
  triangles->InsertNextCell({ 0, 1, 2 });
  triangles->InsertNextCell({ 1, 3, 2 });
  square->SetVerts(vertex);
  square->SetLines(line);
  square->SetPolys(triangles);
  vtkPointData* ofPoints = square->GetPointData();
  ofPoints->AddArray(names);
  ofPoints->SetScalars(MakeNumbered<vtkUnsignedCharArray>("Class", 40, 4));
  ofPoints->AddArray(MakeNumbered<vtkIntArray>("Inline", -20, 4));
  ofPoints->SetPedigreeIds(MakeNumbered<vtkIdTypeArray>("Shot", 7000, 4));
  ofPoints->SetGlobalIds(MakeNumbered<vtkIdTypeArray>("PointIds", 500, 4));
  vtkCellData* ofCells = square->GetCellData();
  ofCells->SetGlobalIds(MakeNumbered<vtkIdTypeArray>("CellIds", 100, 4));
  ofCells->SetPedigreeIds(MakeNumbered<vtkIdTypeArray>("Patch", 900, 4));
  return square;
}

/** Trims a square along rings. */
vtkSmartPointer<vtkTrimOutwardTriangles> Trim(const std::vector<std::vector<Place>>& rings)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> polygons;
  for (const auto& ring : rings)
  {
    polygons->InsertNextCell(static_cast<int>(ring.size()));
    for (const Place& p : ring)
    {
      polygons->InsertCellPoint(points->InsertNextPoint(p.first, p.second, 0.0));
    }
  }
  vtkNew<vtkPolyData> boundary;
  boundary->SetPoints(points);
  boundary->SetPolys(polygons);
  auto trim = vtkSmartPointer<vtkTrimOutwardTriangles>::New();
  trim->SetInputData(MakeSquare());
  trim->SetBoundaryData(boundary);
  trim->SetBoundaryEdgesToStraight();
  trim->Update();
  for (int port = 0; port < 2; ++port)
  {
    Check(
      NumberOfFindings(trim->GetOutput(port), RulesOfSurface()) == 0, "both parts are surfaces");
  }
  return trim;
}

/** Inside a triangle, on the edge of two, and on the border. */
void TestNearestCorner()
{
  const auto trim = Trim({ { { 1, 1 }, { 6, 1 }, { 1, 6 } },
    { { 7, 1 }, { 9, 1 }, { 9, 2.5 }, { 6, 2 } }, { { 2, 6 }, { 7, 7 }, { 3, 9 } } });
  const struct
  {
    Place At;
    int Corner; // with the largest weight in the triangle that the point is in
  } expected[] = { { { 1, 1 }, 0 }, { { 6, 1 }, 1 }, { { 1, 6 }, 2 }, { { 7, 1 }, 1 },
    { { 8, 1 }, 1 }, { { 6, 2 }, 1 }, { { 2, 6 }, 2 }, { { 7, 7 }, 3 } };
  vtkPolyData* output = trim->GetOutput(0);
  vtkPointData* data = output->GetPointData();
  auto* names = vtkStringArray::SafeDownCast(data->GetAbstractArray("Name"));
  std::size_t found = 0;
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    const double* p = output->GetPoint(i);
    const int corner = std::stoi(names->GetValue(i));
    Check(data->GetArray("Class")->GetTuple1(i) == 40 + corner &&
        data->GetArray("Inline")->GetTuple1(i) == -20 + corner &&
        data->GetArray("Shot")->GetTuple1(i) == 7000 + corner,
      "all values are of one corner");
    Check(data->GetArray("PointIds")->GetTuple1(i) == 500 + i, "inserted points have new ids");
    for (const auto& one : expected)
    {
      if (i >= 4 && one.At == Place(p[0], p[1]))
      {
        ++found;
        Check(corner == one.Corner,
          "the value at (" + std::to_string(p[0]) + ", " + std::to_string(p[1]) +
            ") is that of the nearest corner, " + std::to_string(one.Corner) + "; it was of " +
            std::to_string(corner));
      }
    }
  }
  Check(found == std::size(expected), "these points are inserted");
  Check(data->GetScalars() == data->GetArray("Class") &&
      data->GetPedigreeIds() == data->GetArray("Shot"),
    "scalars and pedigree ids stay what they are");
  Check(data->GetGlobalIds() == data->GetArray("PointIds") &&
      trim->GetOutput(1)->GetPointData()->GetGlobalIds() == data->GetGlobalIds(),
    "global ids stay global ids");
}

/**
 * Checks that triangles, which come behind other cells, have the data of those they are part of.
 */
void CheckCells(vtkPolyData* output, vtkIdType others)
{
  vtkCellData* data = output->GetCellData();
  for (vtkIdType i = 0; i < output->GetNumberOfCells(); ++i)
  {
    double x = 0.0, y = 0.0;
    vtkNew<vtkIdList> ids;
    output->GetCellPoints(i, ids);
    for (const vtkIdType id : *ids)
    {
      x += output->GetPoint(id)[0] / 3.0;
      y += output->GetPoint(id)[1] / 3.0;
    }
    const vtkIdType cell = i < others ? i : x + y < 8.0 ? 2 : 3;
    Check(data->GetArray("CellIds")->GetTuple1(i) == 100 + cell &&
        data->GetArray("Patch")->GetTuple1(i) == 900 + cell,
      "a part has the values of its triangle");
  }
}

void TestIdsOfCells()
{
  const auto cut = Trim({ { { 7, 7 }, { 2, 7 }, { 7, 2 } } });
  Check(cut->GetNumberOfInsertedPoints() == 3, "one triangle is cut");
  for (int port = 0; port < 2; ++port)
  {
    vtkPolyData* output = cut->GetOutput(port);
    CheckCells(output, port == 0 ? 2 : 0);
    Check(!output->GetCellData()->GetGlobalIds(), "ids that parts share are no global ids");
    Check(output->GetCellData()->GetPedigreeIds() == output->GetCellData()->GetArray("Patch"),
      "pedigree ids show where parts come from");
  }

  // Nothing is cut: around everything; and along the other diagonal, which is recovered.
  const std::vector<Place> around = { { -1, -1 }, { 9, -1 }, { 9, 9 }, { -1, 9 } };
  for (const auto& ring : { around, std::vector<Place>{ { 0, 0 }, { 8, 0 }, { 8, 8 } } })
  {
    const auto whole = Trim({ ring });
    vtkPolyData* kept = whole->GetOutput(0);
    Check(whole->GetNumberOfInsertedPoints() == 0 &&
        whole->GetNumberOfRecoveredEdges() == (ring.size() == 3 ? 1 : 0),
      "no triangle is cut");
    std::vector<double> ids;
    for (int port = 0; port < 2; ++port)
    {
      vtkCellData* data = whole->GetOutput(port)->GetCellData();
      Check(data->GetGlobalIds() == data->GetArray("CellIds"), "ids of triangles stay global ids");
      for (vtkIdType i = 0; i < data->GetNumberOfTuples(); ++i)
      {
        ids.push_back(data->GetGlobalIds()->GetTuple1(i));
      }
    }
    std::sort(ids.begin(), ids.end());
    Check(ids == std::vector<double>({ 100, 101, 102, 103 }), "each comes once");
    Check(kept->GetPointData()->GetGlobalIds() != nullptr, "so do ids of points");
  }
}
} // namespace

int TestTrimOutwardTrianglesAttributes(int, char*[])
{
  TestNearestCorner();
  TestIdsOfCells();
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
