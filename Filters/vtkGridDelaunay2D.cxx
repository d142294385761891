// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGridDelaunay2D.h"

#include "Kernel/Delaunay.h"
#include "KernelCall.h"
#include "MeshConversion.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

vtkStandardNewMacro(vtkGridDelaunay2D);

namespace
{
void AddUnusedPoints(const elevation::Triangulation& triangulation, vtkFieldData* fieldData)
{
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("UnusedPointIds");
  vtkNew<vtkUnsignedCharArray> reasons;
  reasons->SetName("UnusedPointReasons");
  for (std::size_t i = 0; i < triangulation.UnusedPoints.size(); ++i)
  {
    ids->InsertNextValue(triangulation.UnusedPoints[i]);
    reasons->InsertNextValue(static_cast<unsigned char>(triangulation.UnusedReasons[i]));
  }
  fieldData->AddArray(ids);
  fieldData->AddArray(reasons);
  elevation::AddCount(fieldData, "NumberOfDuplicatePoints", triangulation.NumberOfDuplicates);
  elevation::AddCount(fieldData, "NumberOfNonFinitePoints", triangulation.NumberOfNotFinite);
}

void AddLattice(const elevation::Lattice& lattice, vtkFieldData* fieldData)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName("Lattice");
  array->SetNumberOfComponents(6);
  const double values[] = { lattice.Origin.X, lattice.Origin.Y, lattice.StepU.X, lattice.StepU.Y,
    lattice.StepV.X, lattice.StepV.Y };
  array->InsertNextTuple(values);
  fieldData->AddArray(array);
}
} // namespace

vtkGridDelaunay2D::vtkGridDelaunay2D() = default;

vtkGridDelaunay2D::~vtkGridDelaunay2D() = default;

int vtkGridDelaunay2D::FillInputPortInformation(int vtkNotUsed(port), vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
  return 1;
}

int vtkGridDelaunay2D::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPointSet* input = vtkPointSet::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  this->NumberOfDuplicatePoints = 0;
  this->NumberOfNonFinitePoints = 0;
  this->LatticeFound = false;

  return elevation::CallKernel(this, outputVector, [&]() {
    elevation::DelaunayOptions options;
    options.Strategy = static_cast<elevation::SearchStrategy>(this->SearchStrategy);
    options.MaximumEdgeLength = this->MaximumEdgeLength;
    options.Duplicates = static_cast<elevation::DuplicatePolicy>(this->DuplicatePolicy);
    options.UseLattice = static_cast<elevation::LatticeMode>(this->LatticeMode);
    options.LatticeTolerance = this->LatticeTolerance;
    options.NumberOfThreads = this->NumberOfThreads;
    options.Monitor = elevation::ProgressOf(this);
    elevation::Report(options.Monitor, 0.0);
    elevation::CheckPointArrays(input);
    const elevation::PointsOfDataSet points = elevation::ViewPoints(input);
    elevation::Triangulation triangulation = elevation::Triangulate(points.View, options);

    if (triangulation.NumberOfHullPoints == 0)
    {
      vtkWarningMacro(
        << "No triangle was made: the " << points.View.Count
        << " input points are fewer than three distinct finite points, or all on one line.");
    }
    output->SetPoints(input->GetPoints());
    output->GetPointData()->PassData(input->GetPointData());
    output->GetFieldData()->PassData(input->GetFieldData());
    AddUnusedPoints(triangulation, output->GetFieldData());
    output->GetFieldData()->RemoveArray("Lattice"); // an input's, of other points
    if (triangulation.LatticeFound)
    {
      AddLattice(triangulation.Steps, output->GetFieldData());
    }
    output->SetPolys(elevation::ToCellArray(std::move(triangulation.Triangles)));
    // Only now, as an abort or an error leaves no counts.
    this->NumberOfDuplicatePoints = triangulation.NumberOfDuplicates;
    this->NumberOfNonFinitePoints = triangulation.NumberOfNotFinite;
    this->LatticeFound = triangulation.LatticeFound;
  });
}

const char* vtkGridDelaunay2D::GetSearchStrategyAsString() const
{
  return this->SearchStrategy == COMPACTNESS ? "Compactness" : "VoxelTraversal";
}

const char* vtkGridDelaunay2D::GetDuplicatePolicyAsString() const
{
  static const char* const names[] = { "KeepFirst", "KeepLast", "KeepLowest", "KeepHighest" };
  return names[this->DuplicatePolicy];
}

const char* vtkGridDelaunay2D::GetLatticeModeAsString() const
{
  return this->LatticeMode == OFF ? "Off" : "Automatic";
}

void vtkGridDelaunay2D::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SearchStrategy: " << this->GetSearchStrategyAsString() << "\n";
  os << indent << "MaximumEdgeLength: " << this->MaximumEdgeLength << "\n";
  os << indent << "DuplicatePolicy: " << this->GetDuplicatePolicyAsString() << "\n";
  os << indent << "LatticeMode: " << this->GetLatticeModeAsString() << "\n";
  os << indent << "LatticeTolerance: " << this->LatticeTolerance << "\n";
  os << indent << "LatticeFound: " << this->LatticeFound << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "NumberOfDuplicatePoints: " << this->NumberOfDuplicatePoints << "\n";
  os << indent << "NumberOfNonFinitePoints: " << this->NumberOfNonFinitePoints << "\n";
}
