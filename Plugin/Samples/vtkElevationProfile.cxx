// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * RequestData():
 * 1. AddCorners(): the corners of the lines, or both ends; on all ranks the same.
 * 2. SampleLines(): places along them, with their distances.
 * 3. SampledSurface: the values there. 4. Pass points, and lines where the surface is.
 */
#include "vtkElevationProfile.h"

#include "SampledSurface.h"

#include "Adapt/ArrayChecks.h"
#include "Adapt/DataArrays.h"
#include "Adapt/HiddenCells.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCharArray.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkElevationProfile);

namespace
{
using elevation::Error;
using elevation::Point2;

constexpr int MostSteps = 10000000;

/**
 * Tuples of x, y, and the number of the line; of lines that are neither hidden nor copies of another
 * rank's. @throws Error where an array or a cell is invalid, or a point is not finite
 */
void AddCorners(vtkPolyData* given, vtkDoubleArray* corners)
{
  elevation::CheckArrays(given, "The line's");
  elevation::CheckCells(given, "The line's");
  const vtkSmartPointer<vtkPolyData> lines = elevation::WithoutHiddenCells(given);
  vtkUnsignedCharArray* const flags = elevation::GhostsOf(lines->GetCellData());
  vtkIdType number = lines->GetNumberOfVerts(); // VTK counts vertices first, then lines, polygons
  vtkNew<vtkIdList> ids;
  double line = 0.0;
  for (vtkCellArray* const cells : { lines->GetLines(), lines->GetPolys() })
  {
    for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell, ++number)
    {
      if (elevation::IsCopy(flags, number))
      {
        continue;
      }
      cells->GetCellAtId(cell, ids);
      if (cells == lines->GetPolys() && ids->GetNumberOfIds() > 0)
      {
        ids->InsertNextId(ids->GetId(0));
      }
      for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
      {
        if (ids->GetId(k) < 0 || ids->GetId(k) >= lines->GetNumberOfPoints())
        {
          throw Error("Point " + std::to_string(ids->GetId(k)) +
            " of the line does not exist; there are " + std::to_string(lines->GetNumberOfPoints()) +
            " points.");
        }
        double p[3];
        lines->GetPoint(ids->GetId(k), p);
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]))
        {
          throw Error("Point " + std::to_string(ids->GetId(k)) + " of the line is not finite.");
        }
        corners->InsertNextTuple3(p[0], p[1], line);
      }
      ++line;
    }
  }
}

/** The samples of all lines. */
struct LineSamples
{
  vtkNew<vtkDoubleArray> Places, Distances;
  std::vector<vtkIdType> Begins; ///< of each line, and the number of all

  void Add(const Point2& p, double distance)
  {
    this->Places->InsertNextTuple2(p.X, p.Y);
    this->Distances->InsertNextValue(distance);
  }
};

/** @throws Error if there is no line of some length */
void SampleLines(vtkDoubleArray* corners, int resolution, LineSamples& samples)
{
  const auto cornerAt = [corners](vtkIdType i) {
    return Point2{ corners->GetComponent(i, 0), corners->GetComponent(i, 1) };
  };
  const auto isEdge = [corners](vtkIdType i) { // from a corner to the next one
    return corners->GetComponent(i, 2) == corners->GetComponent(i + 1, 2);
  };
  double length = 0.0;
  for (vtkIdType i = 0; i + 1 < corners->GetNumberOfTuples(); ++i)
  {
    const Point2 p = cornerAt(i), q = cornerAt(i + 1);
    length += isEdge(i) ? std::hypot(q.X - p.X, q.Y - p.Y) : 0.0;
  }
  if (!(length > 0.0 && std::isfinite(length)))
  {
    throw Error("The line has no length in x and y: move one of its ends, or give lines.");
  }
  const double step = length / resolution;
  double distance = 0.0;
  for (vtkIdType i = 0; i < corners->GetNumberOfTuples(); ++i)
  {
    const bool isFirst = i == 0 || !isEdge(i - 1);
    const bool isLast = i + 1 == corners->GetNumberOfTuples() || !isEdge(i);
    const Point2 p = cornerAt(i);
    distance = isFirst ? 0.0 : distance;
    if (isFirst)
    {
      samples.Begins.push_back(samples.Places->GetNumberOfTuples());
    }
    samples.Add(p, distance);
    if (isLast)
    {
      continue;
    }
    const Point2 q = cornerAt(i + 1);
    const double edge = std::hypot(q.X - p.X, q.Y - p.Y);
    // Rounding must not add a step.
    const int steps = std::max(1, static_cast<int>(std::ceil(edge / step * (1.0 - 1e-12))));
    for (int k = 1; k < steps; ++k)
    {
      const double t = static_cast<double>(k) / steps;
      samples.Add({ p.X + t * (q.X - p.X), p.Y + t * (q.Y - p.Y) }, distance + t * edge);
    }
    distance += edge;
  }
  samples.Begins.push_back(samples.Places->GetNumberOfTuples());
}

/** Makes points and lines of samples whose elevations are known. */
void PassLines(const LineSamples& samples, vtkPolyData* output)
{
  vtkPointData* const values = output->GetPointData();
  vtkDataArray* const elevations = values->GetArray(elevation::ElevationName);
  const vtkIdType count = samples.Places->GetNumberOfTuples();
  vtkNew<vtkCharArray> mask;
  mask->SetName("vtkValidPointMask");
  mask->SetNumberOfValues(count);
  double lowest = std::numeric_limits<double>::infinity();
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double z = elevations->GetComponent(i, 0);
    mask->SetValue(i, std::isnan(z) ? 0 : 1);
    lowest = z < lowest ? z : lowest;
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double z = mask->GetValue(i) ? elevations->GetComponent(i, 0)
      : std::isfinite(lowest)          ? lowest
                                       : 0.0;
    points->SetPoint(i, samples.Places->GetComponent(i, 0), samples.Places->GetComponent(i, 1), z);
  }
  vtkNew<vtkCellArray> lines;
  for (std::size_t line = 0; line + 1 < samples.Begins.size(); ++line)
  {
    std::vector<vtkIdType> stretch;
    for (vtkIdType i = samples.Begins[line]; i <= samples.Begins[line + 1]; ++i)
    {
      if (i < samples.Begins[line + 1] && mask->GetValue(i))
      {
        stretch.push_back(i);
        continue;
      }
      if (stretch.size() > 1)
      {
        lines->InsertNextCell(static_cast<vtkIdType>(stretch.size()), stretch.data());
      }
      stretch.clear();
    }
  }
  samples.Distances->SetName("arc_length");
  output->SetPoints(points);
  output->SetLines(lines);
  values->AddArray(samples.Distances);
  values->AddArray(mask);
}
} // namespace

vtkElevationProfile::vtkElevationProfile()
{
  this->SetNumberOfInputPorts(2);
}

int vtkElevationProfile::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), port == 1 ? 1 : 0);
  return 1;
}

int vtkElevationProfile::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* const output = vtkPolyData::GetData(outputVector);
  vtkInformation* const request = outputVector->GetInformationObject(0);
  elevation::MakeSamples(this, request, output, [&] {
    if (this->Resolution < 1 || this->Resolution > MostSteps)
    {
      throw Error("Resolution is " + std::to_string(this->Resolution) + "; it must be 1 to " +
        std::to_string(MostSteps) + ".");
    }
    const elevation::SampledSurface surface(vtkPolyData::GetData(inputVector[0]), request);
    const elevation::Box& bounds = surface.Bounds();
    vtkNew<vtkDoubleArray> corners;
    corners->SetNumberOfComponents(3);
    LineSamples samples;
    samples.Places->SetNumberOfComponents(2);
    vtkPolyData* const lines = vtkPolyData::GetData(inputVector[1]);
    surface.Agree([&] {
      if (lines)
      {
        AddCorners(lines, corners);
      }
      else
      {
        corners->InsertNextTuple3(this->Point1[0], this->Point1[1], 0.0);
        corners->InsertNextTuple3(this->Point2[0], this->Point2[1], 0.0);
      }
    });
    surface.JoinLines(corners);
    surface.Agree([&] { SampleLines(corners, this->Resolution, samples); });
    const vtkIdType found =
      surface.Sample(samples.Places, elevation::ProgressOfSampling(this), output->GetPointData());
    if (!elevation::IsFirstRank(request))
    {
      output->Initialize(); // the first rank has it
      return;
    }
    PassLines(samples, output);
    if (found == 0)
    {
      const double* const b = output->GetBounds();
      vtkWarningMacro(<< "The line does not meet the surface: it is at x " << b[0] << " to " << b[1]
                      << ", y " << b[2] << " to " << b[3] << ", the surface at x " << bounds.Low.X
                      << " to " << bounds.High.X << ", y " << bounds.Low.Y << " to "
                      << bounds.High.Y << ".");
    }
  });
  return 1;
}

void vtkElevationProfile::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Point1: " << this->Point1[0] << " " << this->Point1[1] << " " << this->Point1[2]
     << "\n";
  os << indent << "Point2: " << this->Point2[0] << " " << this->Point2[1] << " " << this->Point2[2]
     << "\n";
  os << indent << "Resolution: " << this->Resolution << "\n";
}
