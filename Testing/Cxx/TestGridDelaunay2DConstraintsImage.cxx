// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A picture of vtkGridDelaunay2D with constraints: a horizon on a lattice, dropped in the east of a
// fault with a gap, whose two sides have depths of their own and meet at the tips; and a thin fault
// that crosses the first. Colours are depths: they change at the faults, and triangles keep to
// them.
#include "PictureFromAbove.h"
#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTrivialProducer.h"

#include <cmath>
#include <cstdlib>

namespace
{
/** Adds a point with its depth, which is in an array too. */
vtkIdType Insert(vtkPolyData* data, double x, double y, double depth)
{
  data->GetPointData()->GetArray("Depth")->InsertNextTuple1(depth);
  return data->GetPoints()->InsertNextPoint(x, y, 0.0);
}

vtkSmartPointer<vtkPolyData> MakeData()
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  data->SetPoints(points);
  vtkNew<vtkDoubleArray> depth;
  depth->SetName("Depth");
  data->GetPointData()->SetScalars(depth);
  return data;
}
} // namespace

int TestGridDelaunay2DConstraintsImage(int argc, char* argv[])
{
  // The sides of the fault at a y, and how far the east has dropped there.
  const auto west = [](double y) { return 7.3 + 0.02 * (y - 3.0) * (13.0 - y) * (y / 16.0 - 1.0); };
  const auto east = [](double y) { return 7.3 + 0.05 * (y - 3.0) * (13.0 - y) * (y / 40.0 + 0.5); };
  const auto throwAt = [](double y) { return std::max(0.0, 0.25 * (y - 3.0) * (13.0 - y)); };
  const auto depthAt = [&](double x, double y) {
    return x > 7.3 ? throwAt(y) * std::exp(-0.15 * (x - 7.3)) : 0.0;
  };

  auto input = MakeData();
  for (int y = 0; y <= 16; ++y)
  {
    for (int x = 0; x <= 16; ++x)
    {
      const bool isGap = throwAt(y) > 0.0 && x > west(y) && x < east(y);
      if (!isGap)
      {
        Insert(input, x, y, depthAt(x, y));
      }
    }
  }
  auto faults = MakeData();
  vtkNew<vtkCellArray> lines;
  for (const bool isEast : { false, true })
  {
    lines->InsertNextCell(11);
    for (int y = 3; y <= 13; ++y)
    {
      lines->InsertCellPoint(
        Insert(faults, isEast ? east(y) : west(y), y, isEast ? throwAt(y) : 0.0));
    }
  }
  lines->InsertNextCell(2);
  lines->InsertCellPoint(Insert(faults, 1.6, 10.4, depthAt(1.6, 10.4)));
  lines->InsertCellPoint(Insert(faults, 14.4, 5.7, depthAt(14.4, 5.7)));
  faults->SetLines(lines);

  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(input);
  delaunay->SetSourceData(faults);
  auto surface = MakeSurface(delaunay->GetOutputPort(), Yellow);
  vtkNew<vtkLookupTable> table;
  table->SetHueRange(0.15, 0.6);
  table->SetSaturationRange(0.7, 0.7);
  table->SetTableRange(0.0, 6.25);
  surface->GetMapper()->ScalarVisibilityOn();
  surface->GetMapper()->SetLookupTable(table);
  surface->GetMapper()->UseLookupTableScalarRangeOn();
  surface->GetMapper()->InterpolateScalarsBeforeMappingOn();
  vtkNew<vtkTrivialProducer> producer;
  producer->SetOutput(faults);
  auto drawn = MakeLines(producer->GetOutputPort(), Red);
  drawn->GetProperty()->SetLineWidth(2.0);
  return MatchesBaseline(argc, argv, { surface, drawn }, { 8.0, 8.5, 400, DarkBlue })
    ? EXIT_SUCCESS
    : EXIT_FAILURE;
}
