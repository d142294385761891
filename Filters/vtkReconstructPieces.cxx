// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkReconstructPieces.h"

#include "Adapt/Adapt.h"
#include "FilterOptions.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"
#include "Parts/Parts.h"
#include "vtkFillElevationHoles.h"
#include "vtkGridDelaunay2D.h"
#include "vtkTrimOutwardTriangles.h"

#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <vector>

vtkStandardNewMacro(vtkReconstructPieces);

namespace
{
/** Input 1 of a filter, brought up to date; nullptr: there is none. */
vtkDataObject* UpdatedLines(vtkAlgorithm* filter)
{
  if (filter->GetNumberOfInputConnections(1) == 0)
  {
    return nullptr;
  }
  filter->GetInputAlgorithm(1, 0)->Update();
  return filter->GetInputDataObject(1, 0);
}

elevation::ReconstructParts::Settings SettingsOf(vtkReconstructPieces* pieces)
{
  elevation::ReconstructParts::Settings settings;
  settings.Delaunay = elevation::OptionsOf(pieces->GetDelaunay());
  settings.Trim = elevation::OptionsOf(pieces->GetTrim());
  settings.Fill = elevation::OptionsOf(pieces->GetFill());
  settings.Fill.MemoryOfHole = pieces->GetMemoryOfHole();
  settings.TrimOutward = pieces->GetTrimOutward();
  settings.FillHoles = pieces->GetFillHoles();
  settings.InterpolatePointData = pieces->GetFill()->GetInterpolatePointData() != 0;
  settings.DrapeConstraints = pieces->GetDelaunay()->GetDrapeConstraints() != 0;
  settings.OpenLongTriangles = pieces->GetFill()->GetMaximumEdgeLength() != 0.0;
  settings.Constraints = UpdatedLines(pieces->GetDelaunay());
  settings.Boundary = UpdatedLines(pieces->GetTrim());
  return settings;
}
} // namespace

vtkReconstructPieces::vtkReconstructPieces()
  : Controller(vtkMultiProcessController::GetGlobalController())
  , Parts(std::make_unique<elevation::ReconstructParts>())
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(2);
}

vtkReconstructPieces::~vtkReconstructPieces() = default;

void vtkReconstructPieces::SetController(vtkMultiProcessController* controller)
{
  if (this->Parts->HasPoints())
  {
    this->ReportError(
      elevation::Error("Controller cannot be changed after the first points; that needs Reset()."));
  }
  else if (this->Controller != controller)
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
  if (this->Parts->HasPoints())
  {
    this->ReportError(
      elevation::Error("Folder cannot be changed after the first points; that needs Reset()."));
  }
  else if (this->Folder != folder)
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

void vtkReconstructPieces::SetMemoryOfHole(double bytes)
{
  bytes = bytes > 0.0 ? bytes : 0.0;
  if (this->MemoryOfHole != bytes)
  {
    this->MemoryOfHole = bytes;
    this->Fill->Modified(); // the same
  }
}

/** An abort is a warning. More pieces may help where memory ends. */
void vtkReconstructPieces::ReportError(const std::exception& error)
{
  if (dynamic_cast<const elevation::Aborted*>(&error))
  {
    this->ReportWarnings({ elevation::MakeMessage<elevation::sentences::Aborted>() });
    return;
  }
  elevation::Message message = elevation::MessageOf(error);
  if (message.GetCode() == elevation::sentences::NotEnoughMemory.Code)
  {
    message = this->FillHoles ? elevation::MakeMessage<elevation::sentences::TooFewPiecesToFill>()
                              : elevation::MakeMessage<elevation::sentences::TooFewPieces>();
  }
  elevation::ReportMessages(this, { message }, {}, this->Messages);
}

void vtkReconstructPieces::ReportWarnings(const std::vector<elevation::Message>& warnings)
{
  if (!warnings.empty())
  {
    elevation::ReportMessages(this, {}, warnings, this->Messages);
  }
}

bool vtkReconstructPieces::AddPoints(vtkPointSet* points)
{
  try
  {
    // What can be put right loses no points that are there.
    if (!points || this->Folder.empty())
    {
      throw elevation::Error(points ? "Folder is not set." : "There is no data set of points.");
    }
    if (this->Parts->CountOfParts() > 0)
    {
      throw elevation::Error("Points cannot be added after the first piece; that needs Reset().");
    }
    this->Parts->Open(this->Controller);
    this->Parts->Add(points, this->Folder, elevation::ProgressOf(this));
    this->Modified();
    return true;
  }
  catch (const std::exception& error)
  {
    this->ReportError(error);
  }
  return false;
}

void vtkReconstructPieces::Reset()
{
  this->Parts->Close();
  this->SetAbortExecute(0); // the executive does so before pieces, not before points are added
  this->Modified();
}

vtkIdType vtkReconstructPieces::GetNumberOfPoints()
{
  return this->Parts->All().Points;
}

vtkIdType vtkReconstructPieces::GetNumberOfTriangles()
{
  return this->Parts->All().Triangles;
}

vtkIdType vtkReconstructPieces::GetNumberOfTrimmedTriangles()
{
  return this->Parts->All().TrimmedTriangles;
}

vtkIdType vtkReconstructPieces::GetNumberOfOutwardTriangles()
{
  return this->Parts->All().Trim.OutwardTriangles;
}

vtkIdType vtkReconstructPieces::GetNumberOfRecoveredEdges()
{
  return this->Parts->All().Trim.RecoveredEdges;
}

vtkIdType vtkReconstructPieces::GetNumberOfPointsLeftOut()
{
  return this->Parts->All().Trim.PointsLeftOut;
}

vtkIdType vtkReconstructPieces::GetNumberOfInsertedPoints()
{
  return this->Parts->All().Trim.InsertedPoints;
}

double vtkReconstructPieces::GetEffectiveGapTolerance()
{
  return this->Parts->All().Trim.GapTolerance;
}

vtkIdType vtkReconstructPieces::GetNumberOfBoundaryRings()
{
  return this->Parts->All().BoundaryRings;
}

vtkIdType vtkReconstructPieces::GetNumberOfHoles()
{
  return this->Parts->All().Holes;
}

vtkIdType vtkReconstructPieces::GetNumberOfFilledHoles()
{
  return this->Parts->All().FilledHoles;
}

vtkIdType vtkReconstructPieces::GetNumberOfFilledTriangles()
{
  return this->Parts->All().FilledTriangles;
}

vtkIdType vtkReconstructPieces::GetNumberOfDuplicatePoints()
{
  return this->Parts->All().Duplicates;
}

vtkIdType vtkReconstructPieces::GetNumberOfNonFinitePoints()
{
  return this->Parts->All().NotFinite;
}

vtkIdType vtkReconstructPieces::GetNumberOfConstraintCrossings()
{
  return this->Parts->All().Crossings;
}

vtkIdType vtkReconstructPieces::GetNumberOfAddedPoints()
{
  return this->Parts->All().AddedPoints;
}

bool vtkReconstructPieces::GetLatticeFound()
{
  return this->Parts->All().LatticeFound;
}

vtkMTimeType vtkReconstructPieces::TimeOfProperties()
{
  return std::max({ this->Delaunay->GetMTime(), this->Trim->GetMTime(), this->Fill->GetMTime() });
}

/** Does all work but writing pieces, on all ranks together. */
void vtkReconstructPieces::WorkOnAll(int count, const elevation::Progress& progress)
{
  elevation::ReconstructParts& parts = *this->Parts;
  parts.Begin(
    count, this->Folder, [this]() { return SettingsOf(this); }, this->GetMTime());
  this->TimeOfWork = this->TimeOfProperties();
  const double filling = this->FillHoles ? 0.7 : 1.0; // where it begins
  const double trimming = parts.IsTrimmed() ? 0.6 * filling : filling;
  this->SetProgressText("triangulating");
  this->ReportWarnings(parts.Triangulate(elevation::Part(progress, 0.0, trimming)));
  if (parts.IsTrimmed())
  {
    this->SetProgressText("trimming");
    this->ReportWarnings(parts.Trim(elevation::Part(progress, trimming, filling)));
  }
  if (this->FillHoles)
  {
    this->SetProgressText("filling holes");
    this->ReportWarnings(parts.Fill(elevation::Part(progress, filling, 1.0)));
  }
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
  const int port = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  vtkInformation* const info = outputVector->GetInformationObject(port);
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const auto get = [info](
                     vtkInformationIntegerKey* key) { return info->Has(key) ? info->Get(key) : 0; };
  const int piece = get(Pipeline::UPDATE_PIECE_NUMBER());
  const int count = std::max(1, get(Pipeline::UPDATE_NUMBER_OF_PIECES()));
  vtkPolyData* const output = vtkPolyData::GetData(outputVector, 0);
  vtkPolyData* const rims = vtkPolyData::GetData(outputVector, 1);
  elevation::ReconstructParts& parts = *this->Parts;
  bool isReporting = true;
  try
  {
    parts.Open(this->Controller);
    if ((parts.IsAlone() && !parts.HasPoints()) || piece < 0 || piece >= count)
    {
      return 1; // empty, as VTK's sources
    }
    parts.CheckPart(piece, count);
    const bool isFirst = parts.CountOfParts() == 0;
    if (!isFirst && this->TimeOfProperties() > this->TimeOfWork)
    {
      throw elevation::Error("Properties were changed after the first piece; that needs Reset().");
    }
    const elevation::Progress progress = elevation::ProgressOf(this);
    isReporting = false; // unless the parts say so
    if (isFirst)
    {
      this->WorkOnAll(count, elevation::Part(progress, 0.0, 0.9));
    }
    parts.Pass(piece, elevation::Part(progress, 0.9, 1.0), output, rims);
    if (!this->KeepFiles)
    {
      parts.Forget(piece);
    }
  }
  catch (const std::exception& error)
  {
    output->Initialize();
    rims->Initialize();
    if (isReporting || parts.IsReporting())
    {
      this->ReportError(error);
    }
  }
  return 1;
}

void vtkReconstructPieces::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Folder: " << this->Folder << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
  os << indent << "KeepFiles: " << (this->KeepFiles ? "On" : "Off") << "\n";
  os << indent << "TrimOutward: " << (this->TrimOutward ? "On" : "Off") << "\n";
  os << indent << "NumberOfPoints: " << this->GetNumberOfPoints() << "\n";
  os << indent << "NumberOfTriangles: " << this->GetNumberOfTriangles() << "\n";
  os << indent << "NumberOfDuplicatePoints: " << this->GetNumberOfDuplicatePoints() << "\n";
  os << indent << "NumberOfNonFinitePoints: " << this->GetNumberOfNonFinitePoints() << "\n";
  os << indent << "NumberOfConstraintCrossings: " << this->GetNumberOfConstraintCrossings() << "\n";
  os << indent << "NumberOfAddedPoints: " << this->GetNumberOfAddedPoints() << "\n";
  os << indent << "LatticeFound: " << this->GetLatticeFound() << "\n";
  os << indent << "NumberOfTrimmedTriangles: " << this->GetNumberOfTrimmedTriangles() << "\n";
  os << indent << "NumberOfOutwardTriangles: " << this->GetNumberOfOutwardTriangles() << "\n";
  os << indent << "NumberOfRecoveredEdges: " << this->GetNumberOfRecoveredEdges() << "\n";
  os << indent << "NumberOfPointsLeftOut: " << this->GetNumberOfPointsLeftOut() << "\n";
  os << indent << "NumberOfInsertedPoints: " << this->GetNumberOfInsertedPoints() << "\n";
  os << indent << "EffectiveGapTolerance: " << this->GetEffectiveGapTolerance() << "\n";
  os << indent << "NumberOfBoundaryRings: " << this->GetNumberOfBoundaryRings() << "\n";
  os << indent << "FillHoles: " << (this->FillHoles ? "On" : "Off") << "\n";
  os << indent << "MemoryOfHole: " << this->MemoryOfHole << "\n";
  os << indent << "NumberOfHoles: " << this->GetNumberOfHoles() << "\n";
  os << indent << "NumberOfFilledHoles: " << this->GetNumberOfFilledHoles() << "\n";
  os << indent << "NumberOfFilledTriangles: " << this->GetNumberOfFilledTriangles() << "\n";
  os << indent << "Delaunay:\n";
  this->Delaunay->PrintSelf(os, indent.GetNextIndent());
  os << indent << "Trim:\n";
  this->Trim->PrintSelf(os, indent.GetNextIndent());
  os << indent << "Fill:\n";
  this->Fill->PrintSelf(os, indent.GetNextIndent());
}
