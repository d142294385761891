// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The filters take every storage that a vtkCellArray may have, and make the same of it: ids of 32
// and 64 bits; from VTK 9.6 on also cells of a fixed size, and ids of any other type.
#include "Check.h"
#include "SameMesh.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkFillElevationHoles.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTestErrorObserver.h"
#include "vtkTrimOutwardTriangles.h"
#include "vtkVersionMacros.h"

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace
{
/** A way to store cells: changes those of a cell array, which have @a size ids each. */
struct Storage
{
  std::string Name;
  std::function<void(vtkCellArray* cells, int size)> Use;
};

#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
/** An array of another type with the same values. */
vtkSmartPointer<vtkDataArray> Converted(vtkDataArray* values, int type)
{
  auto converted = vtk::TakeSmartPointer(vtkDataArray::CreateDataArray(type));
  converted->DeepCopy(values);
  return converted;
}
#endif

std::vector<Storage> Storages()
{
  std::vector<Storage> storages = {
    { "32 bits", [](vtkCellArray* cells, int) { cells->ConvertTo32BitStorage(); } },
    { "64 bits", [](vtkCellArray* cells, int) { cells->ConvertTo64BitStorage(); } },
  };
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  storages.push_back({ "fixed size, 32 bits",
    [](vtkCellArray* cells, int) { cells->ConvertToFixedSize32BitStorage(); } });
  storages.push_back({ "fixed size, 64 bits",
    [](vtkCellArray* cells, int) { cells->ConvertToFixedSize64BitStorage(); } });
  for (const int type : { VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_UNSIGNED_INT, VTK_DOUBLE })
  {
    storages.push_back({ vtkImageScalarTypeNameMacro(type), [type](vtkCellArray* cells, int) {
                          cells->SetData(Converted(cells->GetOffsetsArray(), VTK_LONG_LONG),
                            Converted(cells->GetConnectivityArray(), type));
                        } });
    storages.push_back({ std::string("offsets too: ") + vtkImageScalarTypeNameMacro(type),
      [type](vtkCellArray* cells, int) {
        cells->SetData(Converted(cells->GetOffsetsArray(), type),
          Converted(cells->GetConnectivityArray(), type));
      } });
  }
  storages.push_back({ "size and short ids", [](vtkCellArray* cells, int size) {
                        cells->SetData(size, Converted(cells->GetConnectivityArray(), VTK_SHORT));
                      } });
#endif
  return storages;
}

/** The same points; lines and polygons in another storage. */
vtkSmartPointer<vtkPolyData> Stored(vtkPolyData* data, const Storage& storage)
{
  auto stored = vtkSmartPointer<vtkPolyData>::New();
  stored->SetPoints(data->GetPoints());
  if (data->GetNumberOfLines() > 0)
  {
    vtkNew<vtkCellArray> lines;
    lines->DeepCopy(data->GetLines());
    storage.Use(lines, 2);
    stored->SetLines(lines);
  }
  if (data->GetNumberOfPolys() > 0)
  {
    vtkNew<vtkCellArray> polygons;
    polygons->DeepCopy(data->GetPolys());
    storage.Use(polygons, 3);
    stored->SetPolys(polygons);
  }
  return stored;
}

/** Points with a hole around a place. */
vtkSmartPointer<vtkPolyData> MakeCloud()
{
  auto cloud = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 30 * 30; ++i)
  {
    if (std::hypot(i % 30 - 17.0, i / 30 - 12.0) > 4.0)
    {
      points->InsertNextPoint(i % 30 + 0.3 * std::sin(i), i / 30 + 0.3 * std::cos(3.0 * i), 1.0);
    }
  }
  cloud->SetPoints(points);
  return cloud;
}

/** A closed ring of segments, each a line of two points. */
vtkSmartPointer<vtkPolyData> MakeRing()
{
  auto ring = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  constexpr int count = 7;
  for (int i = 0; i < count; ++i)
  {
    const double angle = 2.0 * 3.14159265358979 * i / count;
    points->InsertNextPoint(15.0 + 11.0 * std::cos(angle), 14.0 + 11.0 * std::sin(angle), 1.0);
    const vtkIdType ids[] = { i, (i + 1) % count };
    lines->InsertNextCell(2, ids);
  }
  ring->SetPoints(points);
  ring->SetLines(lines);
  return ring;
}

/** The outputs of the three filters. */
std::vector<vtkSmartPointer<vtkPolyData>> OutputsOf(
  vtkPolyData* cloud, vtkPolyData* mesh, vtkPolyData* ring)
{
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  delaunay->SetSourceData(ring);
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputData(mesh);
  trim->SetBoundaryData(ring);
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(mesh);
  fill->SetOpenEdgeLength(3.0); // opens the hole
  std::vector<vtkSmartPointer<vtkPolyData>> outputs;
  for (vtkPolyDataAlgorithm* filter :
    std::initializer_list<vtkPolyDataAlgorithm*>{ delaunay, trim, fill })
  {
    filter->Update();
    for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
    {
      outputs.emplace_back(filter->GetOutput(port));
    }
  }
  return outputs;
}

/** A corner that is no point is an error that names the cell, in every storage. */
void ExpectMissingPoint(vtkPolyData* mesh, const Storage& storage)
{
  vtkNew<vtkPolyData> wrong;
  wrong->SetPoints(mesh->GetPoints());
  vtkNew<vtkCellArray> cells;
  cells->DeepCopy(mesh->GetPolys());
  const vtkIdType ids[] = { 0, 1, 30000 };
  cells->ReplaceCellAtId(5, 3, ids);
  wrong->SetPolys(cells);
  vtkNew<vtkTest::ErrorObserver> observer;
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->AddObserver(vtkCommand::ErrorEvent, observer);
  trim->SetInputData(Stored(wrong, storage));
  trim->Update();
  const std::string message = observer->GetErrorMessage();
  Check(message.find("ell 5") != std::string::npos && message.find("30000") != std::string::npos,
    storage.Name + ": the error names cell and point; it was: " + message);
}
} // namespace

int TestCellStorages(int, char*[])
{
  const auto cloud = MakeCloud();
  const auto ring = MakeRing();
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  delaunay->Update();
  vtkPolyData* const mesh = delaunay->GetOutput();
  const std::vector<Storage> storages = Storages();
  const auto expected =
    OutputsOf(cloud, Stored(mesh, storages.front()), Stored(ring, storages.front()));
  for (const auto& output : expected)
  {
    Check(output->GetNumberOfCells() > 0, "there is an output to compare");
  }
  for (const Storage& storage : storages)
  {
    const auto outputs = OutputsOf(cloud, Stored(mesh, storage), Stored(ring, storage));
    for (std::size_t i = 0; i < outputs.size(); ++i)
    {
      Check(AreSame(outputs[i], expected[i]),
        storage.Name + ": output " + std::to_string(i) + " is as with 32 bits");
    }
    ExpectMissingPoint(mesh, storage);
  }
  return failures > 0;
}
