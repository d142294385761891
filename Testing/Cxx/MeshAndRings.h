// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A mesh of a lattice to trim, and the rings to trim it along, for tests.
 */
#ifndef MeshAndRings_h
#define MeshAndRings_h

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkGridDelaunay2D.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <initializer_list>
#include <vector>

constexpr int Size = 9;

/**
 * The Delaunay triangulation of a lattice of unit squares, every second triangle clockwise, with a
 * vertex and a line before the triangles, and arrays.
 */
inline vtkSmartPointer<vtkPolyData> MakeMesh()
{
  vtkNew<vtkPolyData> cloud;
  vtkNew<vtkPoints> points;
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("Id");
  for (vtkIdType i = 0; i < Size * Size; ++i)
  {
    points->InsertNextPoint(i % Size, i / Size, 100.0 + i);
    ids->InsertNextValue(i);
  }
  cloud->SetPoints(points);
  cloud->GetPointData()->AddArray(ids);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  delaunay->Update();

  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->ShallowCopy(delaunay->GetOutput());
  vtkNew<vtkCellArray> vertex;
  vertex->InsertNextCell({ 0 });
  vtkNew<vtkCellArray> line;
  line->InsertNextCell({ 0, 1, 2 });
  vtkNew<vtkCellArray> triangles;
  vtkNew<vtkIdTypeArray> cellIds;
  cellIds->SetName("Cell");
  cellIds->InsertNextValue(0);
  cellIds->InsertNextValue(1);
  for (vtkIdType i = 0; i < mesh->GetNumberOfPolys(); ++i)
  {
    vtkIdType size = 0;
    const vtkIdType* t = nullptr;
    mesh->GetPolys()->GetCellAtId(i, size, t);
    triangles->InsertNextCell({ t[0], t[1 + i % 2], t[2 - i % 2] });
    cellIds->InsertNextValue(2 + i);
  }
  mesh->SetVerts(vertex);
  mesh->SetLines(line);
  mesh->SetPolys(triangles);
  mesh->GetCellData()->AddArray(cellIds);
  return mesh;
}

/** Closed lines through nodes of the lattice, at elevation 7. */
inline vtkSmartPointer<vtkPolyData> MakeRings(
  std::initializer_list<std::initializer_list<std::pair<double, double>>> rings)
{
  auto boundary = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  for (const auto& ring : rings)
  {
    const vtkIdType first = points->GetNumberOfPoints();
    lines->InsertNextCell(static_cast<int>(ring.size()) + 1);
    for (const auto& p : ring)
    {
      lines->InsertCellPoint(points->InsertNextPoint(p.first, p.second, 7.0));
    }
    lines->InsertCellPoint(first);
  }
  boundary->SetPoints(points);
  boundary->SetLines(lines);
  return boundary;
}

#endif
