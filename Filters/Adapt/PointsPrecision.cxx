// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Rounding comes last, so a triangle may turn over by it that was right: that is checked for each,
 * by the exact predicate on the coordinates before and after.
 */
#include "PointsPrecision.h"

#include "DataArrays.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"
#include "MeshConversion.h"

#include "vtkAlgorithm.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace elevation
{

namespace
{
// SetTuples() throws where memory ends; after it, DeepCopy() has room and converts.
vtkSmartPointer<vtkPoints> Converted(vtkPoints* points, int type)
{
  auto converted = vtkSmartPointer<vtkPoints>::New();
  converted->SetDataType(type);
  SetTuples(points->GetNumberOfPoints(), converted->GetData());
  converted->GetData()->DeepCopy(points->GetData());
  return converted;
}

/** Checks that each triangle turns as it did, and that its corners are finite. */
void CheckTurns(vtkPolyData* rounded, const PointView& before)
{
  const DataSetTriangles triangles = ViewTriangles(rounded);
  const PointView& after = triangles.View.Points;
  const auto isFinite = [&after](Index corner) {
    const Point2 p = after.At(corner);
    return std::isfinite(p.X) && std::isfinite(p.Y) && std::isfinite(after.Elevation(corner));
  };
  const auto turnIn = [](const PointView& points, const Index* corners) {
    // A triangle that was flat before may stay so: what it is must not change.
    return Orientation(points.At(corners[0]), points.At(corners[1]), points.At(corners[2]));
  };
  for (Index t = 0; t < triangles.View.Count; ++t)
  {
    const Index* const corners = triangles.View.Corners + 3 * std::ptrdiff_t(t);
    if (!std::all_of(corners, corners + 3, isFinite) ||
      turnIn(after, corners) != turnIn(before, corners))
    {
      throw MakeError<sentences::FoldsInSingle>(FirstPolygon(rounded) + t);
    }
  }
}
} // namespace

void CheckPrecision(int precision)
{
  if (precision < vtkAlgorithm::SINGLE_PRECISION || precision > vtkAlgorithm::DEFAULT_PRECISION)
  {
    throw MakeError<sentences::InvalidPrecision>(precision);
  }
}

bool NeedsDouble(int precision, bool hasLines)
{
  return precision == vtkAlgorithm::DOUBLE_PRECISION || hasLines;
}

vtkSmartPointer<vtkPointSet> WithPointsFor(bool needsDouble, vtkPointSet* input)
{
  // Lines may add points where there are none: these have a type, too.
  const int type = input->GetPoints() ? input->GetPoints()->GetDataType() : VTK_DOUBLE;
  // Integers become double, too: float would not hold them all.
  if (type == VTK_DOUBLE || (type == VTK_FLOAT && !needsDouble))
  {
    return input;
  }
  auto converted = vtk::TakeSmartPointer(input->NewInstance());
  converted->ShallowCopy(input);
  converted->SetPoints(Converted(input->GetPoints(), VTK_DOUBLE));
  return converted;
}

void RoundPoints(const std::vector<vtkPolyData*>& outputs)
{
  // By the points before; outputs 0 and 1 of trimming share theirs.
  std::map<vtkPoints*, vtkSmartPointer<vtkPoints>> rounded;
  for (vtkPolyData* const output : outputs)
  {
    const vtkSmartPointer<vtkPoints> before = output->GetPoints();
    if (!before || before->GetDataType() == VTK_FLOAT)
    {
      continue;
    }
    const DataSetPoints view = ViewPoints(output);
    vtkSmartPointer<vtkPoints>& after = rounded[before];
    after = after ? after : Converted(before, VTK_FLOAT);
    output->SetPoints(after);
    CheckTurns(output, view.View);
  }
}

} // namespace elevation
