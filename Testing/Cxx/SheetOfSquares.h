// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Surfaces for tests: a picture of characters becomes a polydata of unit squares cut in two.
 */
#ifndef SheetOfSquares_h
#define SheetOfSquares_h

#include "vtkCellArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

/**
 * A picture, its last row at y = 0: '#' is a square of two triangles, anything else nothing. Only
 * the corners of squares are points. z = elevation(x, y).
 */
template <typename Elevation>
vtkSmartPointer<vtkPolyData> MakeSheet(
  const std::vector<std::string>& picture, int precision, Elevation&& elevation)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(precision);
  vtkNew<vtkCellArray> triangles;
  std::map<std::pair<int, int>, vtkIdType> ids;
  const auto idOf = [&](int x, int y) {
    const auto found = ids.find({ y, x });
    if (found != ids.end())
    {
      return found->second;
    }
    const vtkIdType id = points->InsertNextPoint(x, y, elevation(x, y));
    ids[{ y, x }] = id;
    return id;
  };
  const int height = static_cast<int>(picture.size());
  for (int y = 0; y < height; ++y)
  {
    const std::string& row = picture[height - 1 - y];
    for (int x = 0; x < static_cast<int>(row.size()); ++x)
    {
      if (row[x] == '#')
      {
        const vtkIdType corners[4] = { idOf(x, y), idOf(x + 1, y), idOf(x + 1, y + 1),
          idOf(x, y + 1) };
        const vtkIdType lower[3] = { corners[0], corners[1], corners[2] };
        const vtkIdType upper[3] = { corners[0], corners[2], corners[3] };
        triangles->InsertNextCell(3, lower);
        triangles->InsertNextCell(3, upper);
      }
    }
  }
  auto sheet = vtkSmartPointer<vtkPolyData>::New();
  sheet->SetPoints(points);
  sheet->SetPolys(triangles);
  return sheet;
}

inline vtkSmartPointer<vtkPolyData> MakeFlatSheet(const std::vector<std::string>& picture)
{
  return MakeSheet(picture, VTK_DOUBLE, [](int, int) { return 0.0; });
}

/** The projected area of all polygons, none counted negative. */
inline double ProjectedArea(vtkPolyData* surface)
{
  double area = 0.0;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < surface->GetPolys()->GetNumberOfCells(); ++cell)
  {
    surface->GetPolys()->GetCellAtId(cell, ids);
    double twice = 0.0, o[3], a[3], b[3];
    surface->GetPoint(ids->GetId(0), o); // from there, for map coordinates
    for (vtkIdType i = 2; i < ids->GetNumberOfIds(); ++i)
    {
      surface->GetPoint(ids->GetId(i - 1), a);
      surface->GetPoint(ids->GetId(i), b);
      twice += (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    }
    area += 0.5 * (twice < 0.0 ? -twice : twice);
  }
  return area;
}

#endif
