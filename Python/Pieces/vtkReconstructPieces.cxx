// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkReconstructPieces.h"

#include "Adapt/Adapt.h"
#include "FilterOptions.h"
#include "Parts/Parts.h"
#include "vtkFillElevationHoles.h"
#include "vtkGridDelaunay2D.h"
#include "vtkTrimOutwardTriangles.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkStringArray.h"

#include <algorithm>

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkReconstructPieces);

vtkReconstructPieces::vtkReconstructPieces()
  : Controller(vtkMultiProcessController::GetGlobalController())
{
  const auto settings = [this]() {
    elevation::ReconstructParts::Settings made;
    made.Time = this->TimeOfProperties();
    made.Folder = this->Folder;
    made.Controller = this->Controller;
    made.KeepFiles = this->KeepFiles;
    made.Delaunay = elevation::OptionsOf(this->Delaunay);
    made.Trim = elevation::OptionsOf(this->Trim);
    made.Fill = elevation::OptionsOf(this->Fill);
    made.Fill.HoleMemory = this->HoleMemory;
    made.TrimOutward = this->TrimOutward;
    made.FillHoles = this->FillHoles;
    made.InterpolatePointData = this->Fill->GetInterpolatePointData() != 0;
    made.DrapeConstraints = this->Delaunay->GetDrapeConstraints() != 0;
    made.RemoveUnusedPoints = this->Delaunay->GetRemoveUnusedPoints() ||
      (this->TrimOutward && this->Trim->GetRemoveUnusedPoints()) ||
      (this->FillHoles && this->Fill->GetRemoveUnusedPoints());
    for (const int precision : { this->Delaunay->GetOutputPointsPrecision(),
           this->Trim->GetOutputPointsPrecision(), this->Fill->GetOutputPointsPrecision() })
    {
      made.IsPrecisionGiven |= precision != vtkAlgorithm::DEFAULT_PRECISION;
    }
    made.LongestEdge = this->Fill->GetOpenEdgeLength();
    made.ConstraintsFilter = this->Delaunay;
    made.BoundaryFilter = this->Trim;
    made.AreasFilter = this->Fill;
    return made;
  };
  this->Parts = std::make_unique<elevation::ReconstructParts>(this, settings, this->Messages);
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(2);
}

vtkReconstructPieces::~vtkReconstructPieces() = default;

void vtkReconstructPieces::SetController(vtkMultiProcessController* controller)
{
  if (this->Parts->CanChange("Controller") && this->Controller != controller)
  {
    this->Parts->Close();
    this->Controller = controller;
    this->Modified();
  }
}

vtkMultiProcessController* vtkReconstructPieces::GetController()
{
  return this->Controller;
}

void vtkReconstructPieces::SetFolder(const std::string& folder)
{
  if (this->Parts->CanChange("Folder") && this->Folder != folder)
  {
    this->Folder = folder;
    this->Modified();
  }
}

vtkMTimeType vtkReconstructPieces::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->TimeOfProperties());
}

vtkGridDelaunay2D* vtkReconstructPieces::GetDelaunay()
{
  return this->Delaunay;
}

vtkTrimOutwardTriangles* vtkReconstructPieces::GetTrim()
{
  return this->Trim;
}

vtkFillElevationHoles* vtkReconstructPieces::GetFill()
{
  return this->Fill;
}

void vtkReconstructPieces::SetTrimOutward(bool trim)
{
  if (this->TrimOutward != trim)
  {
    this->TrimOutward = trim;
    this->Trim->Modified(); // as its properties: see TimeOfProperties()
  }
}

void vtkReconstructPieces::SetFillHoles(bool fill)
{
  if (this->FillHoles != fill)
  {
    this->FillHoles = fill;
    this->Fill->Modified(); // the same
  }
}

void vtkReconstructPieces::SetHoleMemory(double bytes)
{
  bytes = bytes > 0.0 ? bytes : 0.0;
  if (this->HoleMemory != bytes)
  {
    this->HoleMemory = bytes;
    this->Fill->Modified(); // the same
  }
}

bool vtkReconstructPieces::AddPoints(vtkPointSet* points)
{
  const bool areAdded = this->Parts->AddPoints(points);
  if (areAdded)
  {
    this->Modified();
  }
  return areAdded;
}

void vtkReconstructPieces::Reset()
{
  this->Parts->Close();
  elevation::ForgetAbort(this); // no executive does so before points are added
  this->Modified();
}

// Counts of all pieces.
#define vtkGetCountMacro(type, name, count)                                                        \
  type vtkReconstructPieces::Get##name()                                                           \
  {                                                                                                \
    return this->Parts->GetCounts().count;                                                         \
  }
vtkGetCountMacro(vtkIdType, NumberOfPoints, Points);
vtkGetCountMacro(vtkIdType, NumberOfTriangles, Triangles);
vtkGetCountMacro(vtkIdType, NumberOfTrimmedTriangles, TrimmedTriangles);
vtkGetCountMacro(vtkIdType, NumberOfOutwardTriangles, Trim.OutwardTriangles);
vtkGetCountMacro(vtkIdType, NumberOfRecoveredEdges, Trim.RecoveredEdges);
vtkGetCountMacro(vtkIdType, NumberOfPointsLeftOut, Trim.PointsLeftOut);
vtkGetCountMacro(vtkIdType, NumberOfInsertedPoints, Trim.InsertedPoints);
vtkGetCountMacro(double, EffectiveGapTolerance, Trim.GapTolerance);
vtkGetCountMacro(vtkIdType, NumberOfBoundaryRings, BoundaryRings);
vtkGetCountMacro(vtkIdType, NumberOfHoles, Holes);
vtkGetCountMacro(vtkIdType, NumberOfFilledHoles, FilledHoles);
vtkGetCountMacro(vtkIdType, NumberOfFilledTriangles, FilledTriangles);
vtkGetCountMacro(vtkIdType, NumberOfDuplicatePoints, Duplicates);
vtkGetCountMacro(vtkIdType, NumberOfNonFinitePoints, NotFinite);
vtkGetCountMacro(vtkIdType, NumberOfConstraintCrossings, Crossings);
vtkGetCountMacro(vtkIdType, NumberOfAddedPoints, AddedPoints);
vtkGetCountMacro(bool, LatticeFound, LatticeFound);

vtkMTimeType vtkReconstructPieces::TimeOfProperties()
{
  return std::max({ this->Delaunay->GetMTime(), this->Trim->GetMTime(), this->Fill->GetMTime() });
}

int vtkReconstructPieces::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  for (int port = 0; port < 2; ++port)
  {
    outputVector->GetInformationObject(port)->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  }
  return 1;
}

int vtkReconstructPieces::RequestData(
  vtkInformation* request, vtkInformationVector**, vtkInformationVector* outputVector)
{
  return this->Parts->RequestData(request, outputVector);
}

void vtkReconstructPieces::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Folder: " << this->Folder << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
  os << indent << "KeepFiles: " << (this->KeepFiles ? "On" : "Off") << "\n";
  os << indent << "TrimOutward: " << (this->TrimOutward ? "On" : "Off") << "\n";
  os << indent << "FillHoles: " << (this->FillHoles ? "On" : "Off") << "\n";
  os << indent << "HoleMemory: " << this->HoleMemory << "\n";
  os << indent << "Delaunay:\n";
  this->Delaunay->PrintSelf(os, indent.GetNextIndent());
  os << indent << "Trim:\n";
  this->Trim->PrintSelf(os, indent.GetNextIndent());
  os << indent << "Fill:\n";
  this->Fill->PrintSelf(os, indent.GetNextIndent());
}
VTK_ABI_NAMESPACE_END
