// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Clouds and rings for tests and benchmarks, the same on every machine.
 */
#ifndef Inputs_h
#define Inputs_h

#include "vtkCellArray.h"
#include "vtkMinimalStandardRandomSequence.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <cmath>

/**
 * Points at random in the square from 0 to a side.
 * @param elevation  elevation(x, y): z; no point is where it is not finite
 */
template <typename Elevation>
vtkSmartPointer<vtkPolyData> RandomCloud(
  int seed, vtkIdType count, double side, int precision, Elevation&& elevation)
{
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(seed);
  const auto next = [&]() {
    random->Next();
    return random->GetRangeValue(0.0, side);
  };
  vtkNew<vtkPoints> points;
  points->SetDataType(precision);
  while (points->GetNumberOfPoints() < count)
  {
    const double x = next(), y = next(), z = elevation(x, y);
    if (std::isfinite(z))
    {
      points->InsertNextPoint(x, y, z);
    }
  }
  auto cloud = vtkSmartPointer<vtkPolyData>::New();
  cloud->SetPoints(points);
  return cloud;
}

/** A polygon around a place. @param radius  radius(angle) */
template <typename Radius>
vtkSmartPointer<vtkPolyData> RingAround(double x, double y, int count, Radius&& radius)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell(count);
  for (int i = 0; i < count; ++i)
  {
    const double angle = 2.0 * 3.14159265358979 * i / count;
    polygons->InsertCellPoint(points->InsertNextPoint(
      x + radius(angle) * std::cos(angle), y + radius(angle) * std::sin(angle), 0.0));
  }
  auto ring = vtkSmartPointer<vtkPolyData>::New();
  ring->SetPoints(points);
  ring->SetPolys(polygons);
  return ring;
}

#endif
