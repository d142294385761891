// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkReconstructPieces.h"

#include "Adapt/Adapt.h"
#include "FilterOptions.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Lattice/Lattice.h"
#include "Kernel/Messages/Messages.h"
#include "Parts/Parts.h"
#include "vtkFillElevationHoles.h"
#include "vtkGridDelaunay2D.h"
#include "vtkTrimOutwardTriangles.h"

#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkReconstructPieces);

vtkReconstructPieces::vtkReconstructPieces()
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(2);
}

vtkReconstructPieces::~vtkReconstructPieces() = default;

void vtkReconstructPieces::SetFolder(const std::string& folder)
{
  if (this->Work)
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

void vtkReconstructPieces::SetFillHoles(bool fill)
{
  if (this->FillHoles != fill)
  {
    this->FillHoles = fill;
    this->Fill->Modified(); // as its properties: see TimeOfProperties()
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

void vtkReconstructPieces::ReportError(const std::exception& error)
{
  elevation::ReportMessages(this, { elevation::MessageOf(error) }, {}, this->Messages);
}

/** Reports what the work throws. */
bool vtkReconstructPieces::Try(const std::function<void()>& work)
{
  if (this->HasFailed)
  {
    this->ReportError(elevation::Error(
      "The points are not complete after the error before: begin again with Reset()."));
    return false;
  }
  try
  {
    work();
    return true;
  }
  catch (const elevation::Aborted&)
  {
    elevation::ReportMessages(
      this, {}, { elevation::MakeMessage<elevation::sentences::Aborted>() }, this->Messages);
  }
  catch (const std::bad_alloc&)
  {
    this->ReportError(this->FillHoles
        ? elevation::MakeError<elevation::sentences::TooFewPiecesToFill>()
        : elevation::MakeError<elevation::sentences::TooFewPieces>());
  }
  catch (const std::exception& error)
  {
    this->ReportError(error);
  }
  this->HasFailed = true;
  return false;
}

bool vtkReconstructPieces::AddPoints(vtkPointSet* points)
{
  // What can be put right loses no points that are there.
  if (!points || this->Folder.empty())
  {
    this->ReportError(
      elevation::Error(points ? "Folder is not set." : "There is no data set of points."));
    return false;
  }
  if (this->Work && this->Work->CountOfParts() > 0)
  {
    this->ReportError(
      elevation::Error("Points cannot be added after the first piece; that needs Reset()."));
    return false;
  }
  return this->Try([this, points]() {
    if (!this->Work)
    {
      this->Alone = std::make_unique<elevation::Ranks>();
      this->Work = std::make_unique<elevation::TriangulateParts>(*this->Alone, this->Folder);
    }
    this->Work->Add(points, elevation::ProgressOf(this));
    this->Modified();
  });
}

void vtkReconstructPieces::Reset()
{
  this->Filled.reset();
  this->Trimmed.reset();
  this->Work.reset();
  this->Alone.reset();
  this->HasFailed = false;
  this->SetAbortExecute(0); // the executive does so before pieces, not before points are added
  this->Modified();
}

vtkIdType vtkReconstructPieces::GetNumberOfPoints()
{
  return this->Work ? this->Work->CountOfPoints() : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfTriangles()
{
  return this->Work ? this->Work->All().Triangles : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfTrimmedTriangles()
{
  return this->Trimmed ? this->Trimmed->CountOfKept() : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfOutwardTriangles()
{
  return this->Trimmed ? this->Trimmed->All().OutwardTriangles : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfRecoveredEdges()
{
  return this->Trimmed ? this->Trimmed->All().RecoveredEdges : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfInsertedPoints()
{
  return this->Trimmed ? this->Trimmed->All().InsertedPoints : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfBoundaryRings()
{
  return this->Trimmed ? this->Trimmed->CountOfRings() : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfHoles()
{
  return this->Filled ? this->Filled->Result().Found.Count() : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfFilledHoles()
{
  return this->Filled ? elevation::CountOfFilled(this->Filled->Result()) : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfFilledTriangles()
{
  return !this->Filled ? 0
                       : this->Filled->CountOfNewTriangles() +
      (this->Trimmed ? this->Trimmed->CountOfKept() : this->Work->All().Triangles);
}

vtkIdType vtkReconstructPieces::GetNumberOfDuplicatePoints()
{
  return this->Work ? this->Work->All().Duplicates : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfNonFinitePoints()
{
  return this->Work ? this->Work->All().NotFinite : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfConstraintCrossings()
{
  return this->Work ? static_cast<vtkIdType>(this->Work->All().Crossings) : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfAddedPoints()
{
  return this->Work ? this->Work->All().AddedPoints : 0;
}

bool vtkReconstructPieces::GetLatticeFound()
{
  return this->Work && this->Work->All().LatticeFound;
}

/** @throws elevation::Error where the properties are wrong. They can still be put right. */
void vtkReconstructPieces::CheckProperties()
{
  const elevation::DelaunayOptions options = elevation::OptionsOf(this->Delaunay);
  elevation::CheckLimits(options);
  const bool areLines = this->Delaunay->GetNumberOfInputConnections(1) > 0;
  if (options.GivenLattice.IsSet() && options.UseLattice == elevation::LatticeMode::Automatic &&
    !areLines)
  {
    elevation::StepsOfGiven(options.GivenLattice);
  }
  if (options.MaximumElevationError > 0.0)
  {
    throw elevation::MakeError<elevation::sentences::ErrorNotInPieces>();
  }
  if (areLines && this->Delaunay->GetDrapeConstraints())
  {
    throw elevation::MakeError<elevation::sentences::ConstraintsNotInPieces>();
  }
  const bool isTrimmed = this->Trim->GetNumberOfInputConnections(1) > 0;
  if (isTrimmed && elevation::OptionsOf(this->Trim).Test != elevation::OutwardTest::Exact)
  {
    throw elevation::MakeError<elevation::sentences::InwardNormalNotInPieces>();
  }
  if (this->FillHoles)
  {
    elevation::CheckMaximumEdgeLength(this->Fill->GetMaximumEdgeLength());
  }
}

vtkMTimeType vtkReconstructPieces::TimeOfProperties()
{
  return std::max({ this->Delaunay->GetMTime(), this->Trim->GetMTime(), this->Fill->GetMTime() });
}

/** Does all work but writing pieces. */
void vtkReconstructPieces::WorkOnAll(int count, const elevation::Progress& progress)
{
  const bool isTrimmed = this->Trim->GetNumberOfInputConnections(1) > 0;
  const double filling = this->FillHoles ? 0.7 : 1.0; // where it begins
  const double trimming = isTrimmed ? 0.6 * filling : filling;
  elevation::DelaunayOptions options = elevation::OptionsOf(this->Delaunay);
  options.Monitor = elevation::Part(progress, 0.0, trimming);
  this->SetProgressText("triangulating");
  vtkSmartPointer<vtkPolyData> constraints;
  if (this->Delaunay->GetNumberOfInputConnections(1) > 0)
  {
    this->Delaunay->GetInputAlgorithm(1, 0)->Update();
    constraints = elevation::JoinBlocks(this->Delaunay->GetInputDataObject(1, 0), "constraints");
  }
  std::vector<elevation::Message> warnings;
  this->Work->Triangulate(count, constraints, options, warnings);
  this->WarnOfMissing(warnings);
  if (this->Work->All().Triangles == 0)
  {
    return;
  }
  if (isTrimmed)
  {
    this->TrimAll(elevation::Part(progress, trimming, filling));
  }
  if (this->FillHoles)
  {
    this->FillAll(elevation::Part(progress, filling, 1.0));
  }
}

/** Tells what there is to tell, and why there is no triangle, or most points are without one. */
void vtkReconstructPieces::WarnOfMissing(std::vector<elevation::Message>& warnings)
{
  const elevation::TriangulateParts::Totals& all = this->Work->All();
  if (all.Settled == 0)
  {
    warnings.push_back(elevation::MakeMessage<elevation::sentences::NoTriangle>(all.Points));
  }
  else if (all.Effect.AreMostMissing())
  {
    warnings.push_back(
      elevation::AdviceOnLimit(this->Delaunay->GetMaximumEdgeLength(), all.Effect));
  }
  elevation::ReportMessages(this, {}, warnings, this->Messages);
}

void vtkReconstructPieces::TrimAll(const elevation::Progress& progress)
{
  this->SetProgressText("trimming");
  this->Trim->GetInputAlgorithm(1, 0)->Update();
  elevation::TrimOptions options = elevation::OptionsOf(this->Trim);
  options.Monitor = progress;
  const auto make = [this](int piece, const elevation::Progress& ofPiece) {
    return this->MakePiece(piece, ofPiece);
  };
  this->Trimmed =
    std::make_unique<elevation::TrimParts>(elevation::SurfaceParts{ this->Work->Holders(), make },
      this->Work->All().Triangles, this->Trim->GetBoundary(), options);
  this->Trimmed->Trim();
}

void vtkReconstructPieces::FillAll(const elevation::Progress& progress)
{
  this->SetProgressText("filling holes");
  elevation::FillOptions options = elevation::OptionsOf(this->Fill);
  options.MemoryOfHole = this->MemoryOfHole;
  options.Monitor = progress;
  const auto make = [this](int piece, const elevation::Progress& ofPiece) {
    return this->MakeTrimmed(piece, ofPiece);
  };
  auto filled =
    std::make_unique<elevation::FillParts>(elevation::SurfaceParts{ this->Work->Holders(), make },
      options, this->Fill->GetInterpolatePointData() != 0, this->Fill->GetMaximumEdgeLength());
  filled->FindHoles(0);
  filled->Fill();
  this->Filled = std::move(filled);
  const std::vector<elevation::Message> warnings = elevation::WarningsOf(this->Filled->Result());
  if (!warnings.empty())
  {
    elevation::ReportMessages(this, {}, warnings, this->Messages);
  }
}

/** A piece of the triangulation; nullptr: it has no points. */
vtkSmartPointer<vtkPolyData> vtkReconstructPieces::MakePiece(
  int piece, const elevation::Progress& progress)
{
  elevation::SurfacePart part = this->Work->Take(piece, progress);
  if (part.Own.Count() == 0)
  {
    return nullptr;
  }
  auto made = vtkSmartPointer<vtkPolyData>::New();
  elevation::PassPart(
    part, elevation::ResolveNumberOfThreads(this->Delaunay->GetNumberOfThreads()), made);
  elevation::ConstrainedTriangulation counts;
  counts.Added.resize(static_cast<std::size_t>(part.AddedPoints));
  counts.NumberOfCrossings = this->Work->All().Crossings;
  counts.Result = std::move(part.Result);
  elevation::AddReport(counts, progress, made->GetFieldData());
  return made;
}

/** The same, trimmed if there is a boundary. */
vtkSmartPointer<vtkPolyData> vtkReconstructPieces::MakeTrimmed(
  int piece, const elevation::Progress& progress)
{
  if (!this->Trimmed)
  {
    return this->MakePiece(piece, progress);
  }
  auto trimmed = vtkSmartPointer<vtkPolyData>::New();
  this->Trimmed->Write(piece, progress, trimmed, nullptr);
  return trimmed->GetNumberOfPoints() > 0 ? trimmed : nullptr;
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
  if (!this->Work && !this->HasFailed)
  {
    return 1; // no points
  }
  const int cells = this->Work ? this->Work->CountOfParts() : 0;
  if (cells > 0 && cells != count)
  {
    this->ReportError(elevation::Error(
      "There are " + std::to_string(cells) + " pieces; another number of pieces needs Reset()."));
    return 1;
  }
  if (piece < 0 || piece >= count)
  {
    return 1; // empty, as VTK's sources
  }
  try
  {
    if (cells == 0)
    {
      this->CheckProperties();
    }
    else if (this->TimeOfProperties() > this->TimeOfWork)
    {
      throw elevation::Error("Properties were changed after the first piece; that needs Reset().");
    }
  }
  catch (const elevation::Error& error)
  {
    this->ReportError(error);
    return 1;
  }
  const auto work = [this, piece, count, output, rims]() {
    const elevation::Progress progress = elevation::ProgressOf(this);
    if (this->Work->CountOfParts() != count)
    {
      this->TimeOfWork = this->TimeOfProperties();
      this->WorkOnAll(count, elevation::Part(progress, 0.0, 0.9));
    }
    const elevation::Progress last = elevation::Part(progress, 0.9, 1.0);
    if (this->Filled)
    {
      this->Filled->Pass(piece, last, output);
    }
    else if (const vtkSmartPointer<vtkPolyData> made = this->MakeTrimmed(piece, last))
    {
      output->ShallowCopy(made);
    }
    if (this->Filled && piece == 0)
    {
      this->Filled->PassRims(elevation::Progress(), rims);
      elevation::AddHoleCounts(this->Filled->Result(), { rims });
    }
  };
  this->Try(std::ref(work)); // a copy would need memory, which may be at its end
  if (this->HasFailed)
  {
    output->Initialize();
    rims->Initialize();
  }
  return 1;
}

void vtkReconstructPieces::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Folder: " << this->Folder << "\n";
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
  os << indent << "NumberOfInsertedPoints: " << this->GetNumberOfInsertedPoints() << "\n";
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
