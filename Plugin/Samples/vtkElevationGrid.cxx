// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkElevationGrid.h"

#include "SampledSurface.h"

#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <string>

vtkStandardNewMacro(vtkElevationGrid);

namespace
{
constexpr vtkIdType MostNodes = 250000000;

/** Hides the nodes outside of the surface, and the cells at them. */
void HideOutside(vtkImageData* grid)
{
  vtkDataArray* const elevations = grid->GetPointData()->GetArray(elevation::ElevationName);
  vtkUnsignedCharArray* const nodes = grid->AllocatePointGhostArray();
  vtkUnsignedCharArray* const cells = grid->AllocateCellGhostArray();
  int size[3];
  grid->GetDimensions(size);
  for (vtkIdType node = 0; node < grid->GetNumberOfPoints(); ++node)
  {
    if (!std::isnan(elevations->GetComponent(node, 0)))
    {
      continue;
    }
    nodes->SetValue(node, vtkDataSetAttributes::HIDDENPOINT);
    const int column = static_cast<int>(node % size[0]), row = static_cast<int>(node / size[0]);
    for (int j = std::max(row - 1, 0); j <= std::min(row, size[1] - 2); ++j)
    {
      for (int i = std::max(column - 1, 0); i <= std::min(column, size[0] - 2); ++i)
      {
        cells->SetValue(
          static_cast<vtkIdType>(j) * (size[0] - 1) + i, vtkDataSetAttributes::HIDDENCELL);
      }
    }
  }
}
} // namespace

vtkElevationGrid::vtkElevationGrid() = default;

int vtkElevationGrid::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

int vtkElevationGrid::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  // Bounds, and so origin and spacing, come with the data.
  const int extent[] = { 0, std::max(this->Dimensions[0], 1) - 1, 0,
    std::max(this->Dimensions[1], 1) - 1, 0, 0 };
  vtkInformation* const info = outputVector->GetInformationObject(0);
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  info->Set(CAN_PRODUCE_SUB_EXTENT(), 1);
  return 1;
}

int vtkElevationGrid::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector**, vtkInformationVector*)
{
  return 1; // the input's piece is that of the output, and has no extent
}

int vtkElevationGrid::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkImageData* const output = vtkImageData::GetData(outputVector);
  output->Initialize();
  const int columns = this->Dimensions[0], rows = this->Dimensions[1];
  vtkInformation* const request = outputVector->GetInformationObject(0);
  elevation::MakeSamples(this, request, output, [&] {
    if (columns < 2 || rows < 2 || static_cast<vtkIdType>(columns) * rows > MostNodes)
    {
      throw elevation::Error("Dimensions are " + std::to_string(columns) + " and " +
        std::to_string(rows) + "; they must be 2 or more each, and " + std::to_string(MostNodes) +
        " nodes at most.");
    }
    const elevation::SampledSurface surface(vtkPolyData::GetData(inputVector[0]), request);
    const elevation::Box& bounds = surface.Bounds();
    const double dx = (bounds.High.X - bounds.Low.X) / (columns - 1);
    const double dy = (bounds.High.Y - bounds.Low.Y) / (rows - 1);
    vtkNew<vtkDoubleArray> places;
    surface.Agree([&] {
      places->SetNumberOfComponents(2);
      places->SetNumberOfTuples(static_cast<vtkIdType>(columns) * rows);
      for (vtkIdType node = 0; node < places->GetNumberOfTuples(); ++node)
      {
        // Rounding must not lead beyond the last node.
        const double place[] = { std::min(bounds.Low.X + (node % columns) * dx, bounds.High.X),
          std::min(bounds.Low.Y + (node / columns) * dy, bounds.High.Y) };
        places->SetTypedTuple(node, place);
      }
    });
    output->SetExtent(0, columns - 1, 0, rows - 1, 0, 0);
    output->SetOrigin(bounds.Low.X, bounds.Low.Y, 0.0);
    output->SetSpacing(dx, dy, 1.0);
    surface.Sample(places, elevation::ProgressOfSampling(this), output->GetPointData());
    surface.Agree([&] {
      HideOutside(output);
      // Of several ranks each has all nodes, and passes on its part.
      output->Crop(request->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT()));
    });
  });
  return 1;
}

void vtkElevationGrid::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Dimensions: " << this->Dimensions[0] << " " << this->Dimensions[1] << "\n";
}
