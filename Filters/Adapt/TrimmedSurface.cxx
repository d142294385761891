// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Points of outputs 0 and 1 are the same: those of the input, then inserted ones, whose elevation
 * and data come from the triangle they lie in, by the weights of its corners. On one rank
 * PassPoints() makes them; on several, PassTrimmedPoints() adds to a part's points those that came
 * back from the rank that has trimmed (Parts/TrimmedPart.h), with all values.
 */
#include "TrimmedSurface.h"

#include "DataArrays.h"
#include "MeshConversion.h"
#include "Requests.h"
#include "SoftLines.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>

namespace elevation
{

void CheckOptions(const TrimOptions& options)
{
  CheckThreads(options.NumberOfThreads);
  if (!(options.GapTolerance >= 0.0))
  {
    throw MakeError<sentences::InvalidGapTolerance>(std::to_string(options.GapTolerance));
  }
  // Steps that are parallel or infinite make no grid.
  const double cell = std::fabs(options.Grid.Area());
  if (options.Grid.IsSet() && !(cell > 0.0 && cell < std::numeric_limits<double>::infinity()))
  {
    throw MakeError<sentences::InvalidGridSteps>();
  }
}

/*
 * Lines by ids of the data set first; TakePoints() then copies the points that they use, so that a
 * boundary inside of a large data set does not keep all of it.
 */
BoundaryLines ToBoundaryLines(
  vtkPolyData* boundary, const Progress& progress, const std::string& name, bool needsZ)
{
  const DataSetPoints points = ViewPoints(boundary);
  BoundaryLines lines;
  lines.Name = name;
  ForEachLine(boundary, name, progress, [&](const DataSetLine& line) {
    for (vtkIdType i = 0; i < line.Size; ++i)
    {
      const Index id = static_cast<Index>(line.Ids[i]);
      // Only points that lines use: others of the data set may be what they like.
      const Point2 p = points.View.At(id);
      const double z = points.View.Elevation(id);
      if (!std::isfinite(p.X) || !std::isfinite(p.Y) || std::isinf(z))
      {
        throw Error("Point " + std::to_string(id) + " of the " + Possessive(name) + " cell " +
          std::to_string(line.Cell) + " is not finite.");
      }
      if (needsZ && std::isnan(z))
      {
        throw MakeError<sentences::NoZOfBoundary>(id, Possessive(name), line.Cell);
      }
      lines.Lines.Vertices.push_back(id);
    }
    lines.Lines.Offsets.push_back(static_cast<Index>(lines.Lines.Vertices.size()));
    lines.IsPolygon.push_back(line.IsPolygon);
    lines.Cells.push_back(static_cast<Index>(line.Cell));
  });
  TakePoints(points.View, lines);
  return lines;
}

/*
 * Splitting looks at the surface as it was, and writes into the same data set: hence the shallow
 * copy.
 */
vtkIdType SplitSurface(
  vtkPolyData* surface, vtkPolyData* constraints, int threads, const Progress& progress)
{
  Stages stages(progress, { 5, 85, 10 });
  vtkNew<vtkPolyData> before;
  before->ShallowCopy(surface);
  const DataSetTriangles triangles = ViewTriangles(before);
  const BoundaryLines lines = ToBoundaryLines(constraints, stages.Next(), "constraints");
  TrimOptions options;
  options.ReturnParents = false;
  options.NumberOfThreads = threads;
  options.Monitor = stages.Next();
  Trimmed split = SplitAlong(triangles.View, lines, options);
  // Else no line meets a triangle, and the surface stays as it is.
  if (!split.Kept.IsWholeList)
  {
    surface->SetPolys(ToCellArray(std::move(split.Kept.Corners), ResolveNumberOfThreads(threads)));
    // PassPoints() adds arrays to those that are there, of the old points.
    surface->GetPointData()->Initialize();
    PassPoints(before, split, stages.Next(), surface);
  }
  return static_cast<vtkIdType>(split.Inserted.size());
}

void PassPoints(
  vtkPolyData* input, const Trimmed& trimmed, const Progress& progress, vtkPolyData* output)
{
  Stages stages(progress, { 40, 60 });
  const std::vector<InsertedVertex>& inserted = trimmed.Inserted;
  const vtkIdType count = static_cast<vtkIdType>(inserted.size());
  output->SetPoints(
    AppendPoints(input->GetPoints(), count, stages.Next(), [&](vtkIdType i, double* xyz) {
      xyz[0] = trimmed.Places[i].X;
      xyz[1] = trimmed.Places[i].Y;
      xyz[2] = 0.0;
      for (int k = 0; k < 3; ++k)
      {
        xyz[2] += inserted[i].Weights[k] * input->GetPoint(inserted[i].Corners[k])[2];
      }
    }));
  PassExtended(input->GetPointData(), count, output->GetPointData(), stages.Next(),
    [&](vtkAbstractArray* array, vtkAbstractArray*, const Progress&) {
      NewValues values;
      values.Interpolated = [&inserted, numbers = vtkArrayDownCast<vtkDataArray>(array)](
                              vtkIdType i, int c) {
        double value = 0.0;
        for (int k = 0; k < 3; ++k)
        {
          // For a point on an edge, the value at the opposite corner may be NaN.
          const double weight = inserted[i].Weights[k];
          value += weight > 0.0 ? weight * numbers->GetComponent(inserted[i].Corners[k], c) : 0.0;
        }
        return value;
      };
      values.Nearest = [&inserted](vtkIdType i) {
        const InsertedVertex& vertex = inserted[i];
        int best = 0;
        for (int k = 1; k < 3; ++k) // of equally near ones, the first point
        {
          const double ahead = vertex.Weights[k] - vertex.Weights[best];
          const bool isFirst = vertex.Corners[k] < vertex.Corners[best];
          best = ahead > 0.0 || (ahead == 0.0 && isFirst) ? k : best;
        }
        return vertex.Corners[best];
      };
      return values;
    });
}

namespace
{
/** An array followed by the values of added points. */
vtkSmartPointer<vtkAbstractArray> Extended(vtkAbstractArray* array, const TrimmedPoints& points)
{
  const vtkIdType own = array->GetNumberOfTuples();
  const vtkIdType added = static_cast<vtkIdType>(points.Added.size());
  const vtkSmartPointer<vtkAbstractArray> extended = NewLike(array);
  SetTuples(own + added, extended);
  extended->InsertTuples(0, own, 0, array);
  // All ranks have the same arrays, so New has one of this name.
  vtkNew<vtkIdList> from, to;
  for (vtkIdType i = 0; i < added; ++i)
  {
    from->InsertNextId(points.Added[i]);
    to->InsertNextId(own + i);
  }
  extended->InsertTuples(to, from, points.New->GetPointData()->GetAbstractArray(array->GetName()));
  return extended;
}

/** The flags of ghosts of the input, and of the points that another rank owns. */
// Flags of the input stay; those of added points are known by OfOthers alone.
vtkSmartPointer<vtkUnsignedCharArray> MarksOf(vtkPolyData* input, const TrimmedPoints& points)
{
  const vtkIdType own = input->GetNumberOfPoints();
  auto marks = vtkSmartPointer<vtkUnsignedCharArray>::New();
  marks->SetName(vtkDataSetAttributes::GhostArrayName());
  SetTuples(own + static_cast<vtkIdType>(points.Added.size()), marks);
  marks->FillValue(0);
  if (vtkUnsignedCharArray* const before = GhostsOf(input->GetPointData()))
  {
    marks->InsertTuples(0, own, 0, before);
  }
  for (const Index i : points.OfOthers)
  {
    marks->SetValue(i, marks->GetValue(i) | vtkDataSetAttributes::DUPLICATEPOINT);
  }
  return marks;
}
} // namespace

void PassMarks(const std::vector<Index>& onBoundary, vtkPolyData* output)
{
  const vtkIdType count = output->GetNumberOfPoints();
  vtkNew<vtkUnsignedCharArray> marks;
  marks->SetName(BoundaryMarksName);
  SetTuples(count, marks);
  marks->FillValue(0);
  vtkPointData* const data = output->GetPointData();
  // A surface may be trimmed along one boundary after another; holes look at the marks of all.
  if (vtkUnsignedCharArray* const before = BoundaryMarksOf(data))
  {
    std::copy_n(before->GetPointer(0), count, marks->GetPointer(0));
  }
  for (const Index point : onBoundary)
  {
    marks->SetValue(point, 1);
  }
  data->AddArray(marks);
}

// Not only points on edges: where the boundary is outside of the mesh, it may still meet a corner.
// Other points at its places, as duplicates, stay as they are.
void PassElevations(const BoundaryLines& lines, const std::vector<Index>& onBoundary,
  vtkPolyData* kept, vtkPolyData* outward)
{
  // By x,y to the last bit: where the boundary's point was no vertex, trimming has inserted it
  // there.
  std::unordered_map<Point2, double, PointHash> elevations;
  for (std::size_t i = 0; i < lines.Elevations.size(); ++i)
  {
    // Of line points at one place, the first counts.
    elevations.emplace(lines.Points.Places[i], lines.Elevations[i]);
  }
  vtkNew<vtkPoints> moved;
  moved->SetDataType(kept->GetPoints()->GetDataType());
  // The points may be the input's own.
  moved->DeepCopy(kept->GetPoints());
  std::vector<char> areMet(static_cast<std::size_t>(moved->GetNumberOfPoints()), 0);
  const auto meet = [&](Index point) {
    if (areMet[point])
    {
      return;
    }
    areMet[point] = 1;
    double p[3];
    moved->GetPoint(point, p);
    const auto own = elevations.find({ p[0], p[1] });
    if (own != elevations.end())
    {
      moved->SetPoint(point, p[0], p[1], own->second);
    }
  };
  // On several ranks also points whose triangles are elsewhere.
  std::for_each(onBoundary.begin(), onBoundary.end(), meet);
  for (vtkPolyData* const side : { kept, outward })
  {
    if (side)
    {
      const DataSetTriangles triangles = ViewTriangles(side);
      std::for_each(
        triangles.View.Corners, triangles.View.Corners + 3 * triangles.View.Count, meet);
      side->SetPoints(moved);
    }
  }
}

vtkUnsignedCharArray* BoundaryMarksOf(vtkPointData* data)
{
  auto* const marks = vtkUnsignedCharArray::SafeDownCast(data->GetAbstractArray(BoundaryMarksName));
  return marks && marks->GetNumberOfComponents() == 1 ? marks : nullptr;
}

// Values of added points were found where they were made; nothing is interpolated here.
void PassTrimmedPoints(
  vtkPolyData* input, const TrimmedPoints& points, const Progress& progress, vtkPolyData* output)
{
  const vtkIdType added = static_cast<vtkIdType>(points.Added.size());
  output->SetPoints(AppendPoints(input->GetPoints(), added, progress,
    [&points](vtkIdType i, double* xyz) { points.New->GetPoint(points.Added[i], xyz); }));
  vtkPointData* const before = input->GetPointData();
  vtkPointData* const after = output->GetPointData();
  // Attributes are set by this; arrays of the same names then take the places of the input's.
  after->PassData(before);
  for (int i = 0; i < before->GetNumberOfArrays() && added > 0; ++i)
  {
    vtkAbstractArray* const array = before->GetAbstractArray(i);
    if (!IsGhostArray(array))
    {
      after->AddArray(Extended(array, points)); // in place of the input's
    }
  }
  if (!points.AreNumbered)
  {
    after->SetActiveAttribute(-1, vtkDataSetAttributes::GLOBALIDS);
  }
  if (points.AreMarked || (added > 0 && GhostsOf(before)))
  {
    after->AddArray(MarksOf(input, points));
  }
}

// Vertices and lines go with the kept side (firstCells), what is cut of a triangle with its values.
void PassCellData(vtkPolyData* input, vtkIdType firstCells, const TrimmedSide& side, bool areCut,
  const Progress& progress, vtkPolyData* output)
{
  const vtkIdType count = firstCells + static_cast<vtkIdType>(side.Parents.size());
  const vtkIdType firstTriangle = FirstPolygon(input);
  const auto sourceOf = [&](vtkIdType cell) -> vtkIdType {
    return cell < firstCells ? cell : firstTriangle + side.Parents[cell - firstCells];
  };
  CopyTuples(input->GetCellData(), count, sourceOf, progress, output->GetCellData());
  if (areCut)
  {
    // Parts of a triangle have its values, which are no longer global ids then.
    output->GetCellData()->SetActiveAttribute(-1, vtkDataSetAttributes::GLOBALIDS);
  }
}

TrimCounts::TrimCounts(const Trimmed& trimmed)
  : OutwardTriangles(trimmed.NumberOfOutwardTriangles)
  , RecoveredEdges(trimmed.NumberOfRecoveredEdges)
  , PointsLeftOut(trimmed.NumberOfPointsLeftOut)
  , InsertedPoints(static_cast<vtkIdType>(trimmed.Inserted.size()))
  , GapTolerance(trimmed.GapTolerance)
{
}

// On several ranks each output has the counts of its rank; their sums are the filter's.
void AddCounts(const TrimCounts& counts, const std::vector<vtkPolyData*>& outputs)
{
  for (vtkPolyData* output : outputs)
  {
    vtkFieldData* fieldData = output->GetFieldData();
    AddCount(fieldData, "NumberOfOutwardTriangles", counts.OutwardTriangles);
    AddCount(fieldData, "NumberOfRecoveredEdges", counts.RecoveredEdges);
    AddCount(fieldData, "NumberOfPointsLeftOut", counts.PointsLeftOut);
    AddCount(fieldData, "NumberOfInsertedPoints", counts.InsertedPoints);
    vtkNew<vtkDoubleArray> tolerance;
    tolerance->SetName("EffectiveGapTolerance");
    tolerance->InsertNextValue(counts.GapTolerance);
    fieldData->AddArray(tolerance);
  }
}

} // namespace elevation
