// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FillSurfaces.h"

#include "Arguments.h"

#include "Kernel/Mesh/HalfEdgeMesh.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <cmath>
#include <functional>

namespace benchmark
{

namespace
{
/** A grid of 160 x 160 points with the elevation of a function. */
Coordinates MakeGrid(const std::function<double(double, double)>& elevation)
{
  Coordinates points;
  for (int y = 0; y < 160; ++y)
  {
    for (int x = 0; x < 160; ++x)
    {
      points.insert(points.end(), { double(x), double(y), elevation(x, y) });
    }
  }
  return points;
}

double Normal(Random& random)
{
  const double radius = std::sqrt(-2.0 * std::log(1.0 - random()));
  return radius * std::cos(6.283185307179586 * random());
}

double Hills(double x, double y)
{
  return 3.0 * std::sin(0.08 * x + 0.03 * y) + 2.0 * std::cos(0.07 * y - 0.05 * x);
}

/** Level ground with white noise of 0.05, and a share of points that are 0.5 to 3 too high. */
Coordinates MakeLevel(double outliers)
{
  Random random(11);
  return MakeGrid([&](double, double) {
    const double z = 0.05 * Normal(random);
    return random() < outliers ? z + 0.5 + 2.5 * random() : z;
  });
}
} // namespace

std::vector<TestSurface> MadeSurfaces()
{
  const auto level = [](double, double) { return 0.0; };
  return {
    { { "dome",
        [] {
          return MakeGrid([](double x, double y) {
            const double square = (x - 80.0) * (x - 80.0) + (y - 80.0) * (y - 80.0);
            return 40.0 * std::exp(-square / 5000.0);
          });
        } },
      nullptr },
    { { "ridges",
        [] {
          return MakeGrid([](double x, double y) {
            return 3.0 * std::sin(0.2 * x + 0.05 * y) + 2.0 * std::cos(0.11 * y - 0.07 * x);
          });
        } },
      nullptr },
    { { "noise",
        [] {
          Random random(7);
          return MakeGrid([&random](double x, double y) {
            return 0.02 * x + 0.01 * y + random() + random() + random() + random() - 2.0;
          });
        } },
      nullptr },
    { { "level_noise", [] { return MakeLevel(0.0); } }, level },
    { { "level_outliers", [] { return MakeLevel(0.01); } }, level },
    { { "cliff",
        [] {
          Random random(13);
          return MakeGrid(
            [&random](double x, double y) { return Hills(x, y) + 0.02 * Normal(random); });
        } },
      Hills, true },
  };
}

Surface MakeSurface(Coordinates points)
{
  Surface surface;
  surface.Points = std::move(points);
  vtkNew<vtkPoints> vtkpoints;
  vtkpoints->SetDataTypeToDouble();
  for (std::size_t i = 0; i < surface.Points.size(); i += 3)
  {
    vtkpoints->InsertNextPoint(&surface.Points[i]);
    surface.Triangles.Points.push_back({ surface.Points[i], surface.Points[i + 1] });
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(vtkpoints);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  delaunay->Update();
  vtkDataArray* ids = delaunay->GetOutput()->GetPolys()->GetConnectivityArray();
  const auto lengthOf = [&](vtkIdType i) {
    const vtkIdType next = i % 3 == 2 ? i - 2 : i + 1;
    const Point2& a = surface.Triangles.Points[vtkIdType(ids->GetComponent(i, 0))];
    const Point2& b = surface.Triangles.Points[vtkIdType(ids->GetComponent(next, 0))];
    return std::hypot(b.X - a.X, b.Y - a.Y);
  };
  std::vector<double> lengths;
  for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
  {
    lengths.push_back(lengthOf(i));
  }
  const double longest = 3.0 * Median(lengths);
  double area = 0.0;
  for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); i += 3)
  {
    if (lengths[i] > longest || lengths[i + 1] > longest || lengths[i + 2] > longest)
    {
      continue;
    }
    Point2 p[3];
    for (int k = 0; k < 3; ++k)
    {
      surface.Triangles.Triangles.push_back(static_cast<Index>(ids->GetComponent(i + k, 0)));
      p[k] = surface.Triangles.Points[surface.Triangles.Triangles.back()];
    }
    area += 0.5 * ((p[1].X - p[0].X) * (p[2].Y - p[0].Y) - (p[1].Y - p[0].Y) * (p[2].X - p[0].X));
  }
  surface.Triangles.ConnectTwins();
  surface.Spacing = std::sqrt(area / (0.5 * surface.Triangles.NumberOfTriangles()));
  surface.Steps[0].X = surface.Steps[1].Y = surface.Spacing;
  surface.Origin = surface.Triangles.Points.front();
  if (vtkDataArray* lattice = delaunay->GetOutput()->GetFieldData()->GetArray("Lattice"))
  {
    surface.HasLattice = true;
    surface.Origin = { lattice->GetComponent(0, 0), lattice->GetComponent(0, 1) };
    surface.Steps[0] = { lattice->GetComponent(0, 2), lattice->GetComponent(0, 3) };
    surface.Steps[1] = { lattice->GetComponent(0, 4), lattice->GetComponent(0, 5) };
  }
  surface.OnBorder.assign(surface.Triangles.NumberOfPoints(), 1);
  for (const Index v : surface.Triangles.Triangles)
  {
    surface.OnBorder[v] = 0;
  }
  for (Index h = 0; h < surface.Triangles.NumberOfHalfEdges(); ++h)
  {
    if (surface.Triangles.IsBorder(h))
    {
      surface.OnBorder[surface.Triangles.Origin(h)] = 1;
      surface.OnBorder[surface.Triangles.Destination(h)] = 1;
    }
  }
  return surface;
}

} // namespace benchmark
