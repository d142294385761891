// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FillMethods.h"

#ifdef ES_BENCHMARK_CGAL
#include "CGALFill.h"
#endif

#include "Kernel/Mesh/HalfEdgeMesh.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFillElevationHoles.h"
#include "vtkFillHolesFilter.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

namespace benchmark
{

namespace
{
vtkSmartPointer<vtkPolyData> ToPolyData(const Hole& hole)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (std::size_t i = 0; i < hole.Points.size(); i += 3)
  {
    points->InsertNextPoint(&hole.Points[i]);
  }
  vtkNew<vtkCellArray> cells;
  for (std::size_t i = 0; i < hole.Triangles.size(); i += 3)
  {
    const vtkIdType ids[3] = { hole.Triangles[i], hole.Triangles[i + 1], hole.Triangles[i + 2] };
    cells->InsertNextCell(3, ids);
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(cells);
  return mesh;
}

Coordinates PointsOf(vtkPolyData* mesh)
{
  Coordinates points(3 * static_cast<std::size_t>(mesh->GetNumberOfPoints()));
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    mesh->GetPoint(i, &points[3 * std::size_t(i)]);
  }
  return points;
}

/** The triangles of a mesh from one on. */
std::vector<Index> TrianglesOf(vtkPolyData* mesh, vtkIdType first)
{
  std::vector<Index> triangles;
  vtkDataArray* ids = mesh->GetPolys()->GetConnectivityArray();
  for (vtkIdType i = 3 * first; i < ids->GetNumberOfTuples(); ++i)
  {
    triangles.push_back(static_cast<Index>(ids->GetComponent(i, 0)));
  }
  return triangles;
}
} // namespace

Filled FillWithUs(const Hole& hole, int interpolation)
{
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(ToPolyData(hole));
  if (interpolation < 0)
  {
    fill->SetSpacing(1e300);
  }
  else
  {
    fill->SetInterpolation(interpolation);
  }
  fill->Update();
  vtkPolyData* mesh = fill->GetOutput();
  Filled filled;
  filled.Points = PointsOf(mesh);
  filled.Patch = TrianglesOf(mesh, static_cast<vtkIdType>(hole.Triangles.size() / 3));
  vtkDataArray* errors = mesh->GetPointData()->GetArray("FilledError");
  for (vtkIdType i = 0; i < errors->GetNumberOfTuples(); ++i)
  {
    filled.StandardErrors.push_back(errors->GetComponent(i, 0));
  }
  vtkCellData* report = vtkPolyData::SafeDownCast(fill->GetOutputDataObject(1))->GetCellData();
  double most = -1.0;
  for (vtkIdType i = 0; i < fill->GetNumberOfHoles(); ++i)
  {
    const double points = report->GetArray("NumberOfInsertedPoints")->GetComponent(i, 0);
    if (points > most)
    {
      most = points;
      filled.Used = static_cast<int>(report->GetArray("Interpolation")->GetComponent(i, 0));
    }
  }
  return filled;
}

Filled FillWithVTK(const Hole& hole, double size)
{
  vtkNew<vtkFillHolesFilter> fill;
  fill->SetInputData(ToPolyData(hole));
  fill->SetHoleSize(size);
  fill->Update();
  Filled filled;
  filled.Points = PointsOf(fill->GetOutput());
  filled.Patch = TrianglesOf(fill->GetOutput(), static_cast<vtkIdType>(hole.Triangles.size() / 3));
  return filled;
}

#ifdef ES_BENCHMARK_CGAL
Filled FillByCGAL(const Hole& hole, double left, double right, double low, double high)
{
  Mesh mesh;
  for (std::size_t i = 0; i < hole.Points.size(); i += 3)
  {
    mesh.Points.push_back({ hole.Points[i], hole.Points[i + 1] });
  }
  mesh.Triangles = hole.Triangles;
  mesh.ConnectTwins();
  Filled filled;
  filled.Points = hole.Points;
  // A vertex that two triangles' fans share cannot be in CGAL's mesh; such holes count as failed.
  const elevation::Rings walks = elevation::TraceBorder(mesh);
  for (Index walk = 0; walk < walks.Count(); ++walk)
  {
    bool isAround = true;
    for (const Index* h = walks.Begin(walk); h != walks.End(walk); ++h)
    {
      const Point2& p = mesh.PointOf(mesh.Origin(*h));
      isAround = isAround && p.X > left && p.X < right && p.Y > low && p.Y < high;
    }
    if (isAround)
    {
      const Index h = *walks.Begin(walk);
      const std::vector<Index> patch =
        FillWithCGAL(filled.Points, hole.Triangles, mesh.Origin(h), mesh.Destination(h));
      filled.Patch.insert(filled.Patch.end(), patch.begin(), patch.end());
    }
  }
  return filled;
}
#endif

} // namespace benchmark
