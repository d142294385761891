// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceQuery.h"

#include "MeshConversion.h"

#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <limits>

namespace elevation
{

SurfaceQuery::SurfaceQuery(vtkPolyData* surface)
{
  const DataSetTriangles triangles = ViewTriangles(surface);
  this->Surface = MeshOf(triangles.View, AvailableThreads());
  const PointView& points = triangles.View.Points;
  this->Elevations.resize(points.Count);
  for (Index i = 0; i < points.Count; ++i)
  {
    this->Elevations[i] = points.Elevation(i);
  }
}

std::vector<std::vector<double>> SurfaceQuery::Interpolate(vtkDataArray* places, bool areNatural,
  const std::vector<vtkDataArray*>& arrays, const Progress& progress)
{
  for (vtkDataArray* const array : arrays)
  {
    this->CheckCount(array);
  }
  if (places->GetNumberOfComponents() != 2)
  {
    throw Error("Places need x and y, two components; the array has " +
      std::to_string(places->GetNumberOfComponents()) + ".");
  }
  Stages stages(progress, { this->Finder ? 0.0 : 30.0, 70 });
  const Progress indexing = stages.Next();
  if (areNatural && this->Surface.Twins.empty())
  {
    this->Surface.ConnectTwins();
  }
  if (!this->Finder)
  {
    this->Finder = std::make_unique<PlaceFinder>(this->Surface, AvailableThreads(), indexing);
  }
  std::vector<Point2> positions(places->GetNumberOfTuples());
  for (std::size_t i = 0; i < positions.size(); ++i)
  {
    const vtkIdType tuple = static_cast<vtkIdType>(i);
    positions[i] = { places->GetComponent(tuple, 0), places->GetComponent(tuple, 1) };
  }
  const PlaceWeights found =
    this->Finder->Find(positions, areNatural, AvailableThreads(), stages.Next());
  std::vector<std::vector<double>> lists;
  lists.push_back(ValuesAt(found, [this](Index point) { return this->Elevations[point]; }));
  for (vtkDataArray* const array : arrays)
  {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    lists.push_back(ValuesAt(found,
      [array, unknown](Index point) { return array ? array->GetComponent(point, 0) : unknown; }));
  }
  return lists;
}

void SurfaceQuery::CheckCount(vtkDataArray* values) const
{
  const vtkIdType count = static_cast<vtkIdType>(this->Elevations.size());
  if (values && values->GetNumberOfTuples() != count)
  {
    throw Error("Values are needed for each of the " + std::to_string(count) +
      " points; the array has " + std::to_string(values->GetNumberOfTuples()) + ".");
  }
}

void SurfaceQuery::CompareWith(const SurfaceQuery* other, double level, vtkDataArray* values,
  const Progress& progress, vtkDoubleArray* result, vtkPolyData* map) const
{
  this->CheckCount(values);
  std::vector<double> own;
  for (vtkIdType i = 0; values && i < values->GetNumberOfTuples(); ++i)
  {
    own.push_back(values->GetComponent(i, 0));
  }
  const ElevatedMesh first{ this->Surface, this->Elevations };
  std::unique_ptr<ElevatedMesh> second;
  if (other)
  {
    second.reset(new ElevatedMesh{ other->Surface, other->Elevations });
  }
  DifferenceMap polygons;
  const std::vector<OverlaidTriangle> found = Overlay(
    first, second.get(), level, own, AvailableThreads(), progress, map ? &polygons : nullptr);
  result->SetNumberOfComponents(5);
  result->SetNumberOfTuples(static_cast<vtkIdType>(found.size()));
  for (std::size_t t = 0; t < found.size(); ++t)
  {
    const OverlaidTriangle& one = found[t];
    const double tuple[] = { one.Area, one.Common, one.Above, one.Below, one.Weighted };
    result->SetTypedTuple(static_cast<vtkIdType>(t), tuple);
  }
  if (map)
  {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(static_cast<vtkIdType>(polygons.Points.size() / 3));
    std::copy(polygons.Points.begin(), polygons.Points.end(),
      vtkDoubleArray::FastDownCast(points->GetData())->GetPointer(0));
    Buffer<Index> corners;
    corners.Resize(polygons.Triangles.size());
    std::copy(polygons.Triangles.begin(), polygons.Triangles.end(), corners.data());
    map->SetPoints(points);
    map->SetPolys(ToCellArray(std::move(corners), AvailableThreads()));
  }
}

} // namespace elevation
