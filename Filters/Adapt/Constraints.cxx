// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * A point that lines add gets its values in one of two ways. A point of the constraints has values
 * of its own, where these have an array of the same name that fits. A crossing is interpolated
 * between two points of the output that come before it: AddedPoint::From and To.
 */
#include "Constraints.h"

#include "DataArrays.h"

#include "vtkAbstractArray.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>

namespace elevation
{

ConstraintLines ToConstraintLines(
  vtkPolyData* source, const DataSetPoints& points, const Progress& progress)
{
  ConstraintLines lines;
  lines.Points = points.View;
  ForEachLine(source, "constraints", progress, [&](const DataSetLine& line) {
    lines.Vertices.insert(lines.Vertices.end(), line.Ids, line.Ids + line.Size);
    lines.Offsets.push_back(static_cast<Index>(lines.Vertices.size()));
    lines.IsClosed.push_back(line.IsPolygon);
    lines.Cells.push_back(static_cast<Index>(line.Cell));
  });
  return lines;
}

void WarnOfLattice(const DelaunayOptions& options, std::vector<Message>& warnings)
{
  if (options.GivenLattice.IsSet() && options.UseLattice == LatticeMode::Automatic)
  {
    warnings.push_back(MakeMessage<sentences::LatticeNotUsed>());
  }
}

// Lines that lie elsewhere are found by boxes alone; by points only how many are far out.
void CheckLines(const ConstraintLines& lines, const Box& box, std::vector<Message>& warnings)
{
  if (lines.Vertices.empty())
  {
    throw MakeError<sentences::NoLines>("constraints");
  }
  // The user may have meant to cut the surface along them.
  const auto polygons = std::count(lines.IsClosed.begin(), lines.IsClosed.end(), true);
  if (polygons > 0)
  {
    warnings.push_back(MakeMessage<sentences::PolygonsAreLines>(polygons));
  }
  // Outlines may lie a little outside.
  const double dx = 0.1 * box.Width(), dy = 0.1 * box.Height();
  const Box wide{ { box.Low.X - dx, box.Low.Y - dy }, { box.High.X + dx, box.High.Y + dy } };
  Box ofLines;
  std::size_t outside = 0;
  for (const Index vertex : lines.Vertices)
  {
    const Point2 p = lines.Points.At(vertex);
    if (!std::isfinite(p.X) || !std::isfinite(p.Y) || box.Low.X > box.High.X)
    {
      return; // an error of its own, or there is no point
    }
    ofLines.Add(p);
    outside += wide.Contains(p) ? 0 : 1;
  }
  // Most often another coordinate system: an error, as the surface would be one of lines alone.
  if (!ofLines.Intersects(box))
  {
    throw MakeError<sentences::LinesElsewhere>("constraints", NameOf(ofLines), NameOf(box));
  }
  if (2 * outside > lines.Vertices.size())
  {
    warnings.push_back(MakeMessage<sentences::LinesFarOutside>(
      outside, lines.Vertices.size(), "constraints'", "constraints", NameOf(ofLines), NameOf(box)));
  }
}

namespace
{
/** The array of the constraints that matches one of the input, or nullptr. */
vtkAbstractArray* FindGiven(vtkPointData* source, vtkAbstractArray* array)
{
  vtkAbstractArray* given = array->GetName() ? source->GetAbstractArray(array->GetName()) : nullptr;
  if (!given || given->GetNumberOfComponents() != array->GetNumberOfComponents())
  {
    return nullptr;
  }
  // Floating-point values of any precision go into each other; ids and classes must not be rounded.
  const bool canConvert = IsFloatingPoint(array) && vtkArrayDownCast<vtkDataArray>(given);
  return given->GetDataType() == array->GetDataType() || canConvert ? given : nullptr;
}

/** Copies the values of points of the constraints. @return the number of these points */
vtkIdType CopyGiven(vtkAbstractArray* given, const std::vector<AddedPoint>& added,
  const Progress& progress, vtkAbstractArray* values)
{
  const vtkIdType count = static_cast<vtkIdType>(added.size());
  const vtkIdType first = values->GetNumberOfTuples() - count;
  const bool isSameType = given && given->GetDataType() == values->GetDataType();
  auto* const from = isSameType ? nullptr : vtkArrayDownCast<vtkDataArray>(given);
  auto* const to = vtkArrayDownCast<vtkDataArray>(values);
  vtkIdType i = 0; // points of the constraints come first, then crossings
  for (; i < count && added[i].Source != None; ++i)
  {
    ReportStep(progress, static_cast<std::size_t>(i), added.size());
    if (isSameType)
    {
      values->SetTuple(first + i, added[i].Source, given);
    }
    for (int c = 0; from && c < from->GetNumberOfComponents(); ++c)
    {
      to->SetComponent(first + i, c, from->GetComponent(added[i].Source, c));
    }
  }
  return i;
}
} // namespace

void PassPoints(vtkPointSet* input, vtkPolyData* source, const std::vector<AddedPoint>& added,
  const Progress& progress, vtkPolyData* output)
{
  Stages stages(progress, { 40, 60 });
  const vtkIdType count = static_cast<vtkIdType>(added.size());
  output->SetPoints(
    AppendPoints(input->GetPoints(), count, stages.Next(), [&](vtkIdType i, double* xyz) {
      xyz[0] = added[i].Position.X;
      xyz[1] = added[i].Position.Y;
      xyz[2] = added[i].Elevation;
    }));
  PassExtended(input->GetPointData(), count, output->GetPointData(), stages.Next(),
    [&](vtkAbstractArray* before, vtkAbstractArray* after, const Progress& ofArray) {
      NewValues values;
      // Points of the constraints are done with then, also those without a value, which is NaN or
      // 0.
      values.First = CopyGiven(FindGiven(source->GetPointData(), before), added, ofArray, after);
      values.Interpolated = [&added, numbers = vtkArrayDownCast<vtkDataArray>(after)](
                              vtkIdType i, int c) {
        // From the output: the ends may be points that lines have added themselves.
        const double from = numbers->GetComponent(added[i].From, c);
        const double to = numbers->GetComponent(added[i].To, c);
        return from + added[i].Fraction * (to - from);
      };
      return values;
    });
}

} // namespace elevation
