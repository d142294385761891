// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkReconstructPieces.h"

#include "CellByCell.h"
#include "DelaunayReport.h"
#include "Kernel/Base/Base.h"
#include "KernelCall.h"
#include "LimitAdvice.h"
#include "Ranks.h"
#include "TrimmedPieces.h"
#include "vtkGridDelaunay2D.h"
#include "vtkTrimOutwardTriangles.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkReconstructPieces);

vtkReconstructPieces::vtkReconstructPieces()
{
  this->SetNumberOfInputPorts(0);
}

vtkReconstructPieces::~vtkReconstructPieces() = default;

void vtkReconstructPieces::SetFolder(const std::string& folder)
{
  if (this->Work)
  {
    vtkErrorMacro("Folder cannot be changed after the first points; that needs Reset().");
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

/** Reports what the work throws. */
bool vtkReconstructPieces::Try(const std::function<void()>& work)
{
  if (this->HasFailed)
  {
    vtkErrorMacro("The points are not complete after the error before: begin again with Reset().");
    return false;
  }
  try
  {
    work();
    return true;
  }
  catch (const elevation::Aborted&)
  {
    vtkWarningMacro("Aborted; the output is empty.");
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro(<< elevation::NotEnoughMemory << " More pieces take less.");
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
  this->HasFailed = true;
  return false;
}

bool vtkReconstructPieces::AddPoints(vtkPointSet* points)
{
  // What can be put right loses no points that are there.
  if (!points || this->Folder.empty())
  {
    vtkErrorMacro(<< (points ? "Folder is not set." : "There is no data set of points."));
    return false;
  }
  if (this->Work && this->Work->CountOfCells() > 0)
  {
    vtkErrorMacro("Points cannot be added after the first piece; that needs Reset().");
    return false;
  }
  return this->Try([this, points]() {
    if (!this->Work)
    {
      this->Work = std::make_unique<elevation::CellByCell>(this->Folder);
    }
    this->Work->Add(points, elevation::ProgressOf(this));
    this->Modified();
  });
}

void vtkReconstructPieces::Reset()
{
  this->Trimmed.reset();
  this->Work.reset();
  this->HasFailed = false;
  this->Modified();
}

vtkIdType vtkReconstructPieces::GetNumberOfPoints()
{
  return this->Work ? this->Work->All().Points : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfTriangles()
{
  return this->Work ? this->Work->All().Triangles : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfTrimmedTriangles()
{
  return this->Trimmed ? this->Trimmed->CountOfTriangles() : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfOutwardTriangles()
{
  return this->Trimmed ? this->Trimmed->Counts().OutwardTriangles : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfRecoveredEdges()
{
  return this->Trimmed ? this->Trimmed->Counts().RecoveredEdges : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfInsertedPoints()
{
  return this->Trimmed ? this->Trimmed->Counts().InsertedPoints : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfBoundaryRings()
{
  return this->Trimmed ? this->Trimmed->CountOfRings() : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfDuplicatePoints()
{
  return this->Work ? this->Work->All().Duplicates : 0;
}

vtkIdType vtkReconstructPieces::GetNumberOfNonFinitePoints()
{
  return this->Work ? this->Work->All().NotFinite : 0;
}

bool vtkReconstructPieces::GetLatticeFound()
{
  return this->Work && this->Work->All().LatticeFound;
}

/** What is wrong with the properties; empty: nothing. They can still be put right. */
std::string vtkReconstructPieces::WrongProperty()
{
  try
  {
    elevation::CheckMaximumEdgeLength(this->Delaunay->GetMaximumEdgeLength());
  }
  catch (const elevation::Error& error)
  {
    return error.what();
  }
  const elevation::DelaunayOptions options = elevation::OptionsOf(this->Delaunay);
  if (options.MaximumEdgeLength > 0.0 || options.GivenLattice.IsSet())
  {
    return "MaximumEdgeLength and a given Lattice are for points in memory, not for pieces.";
  }
  if (this->Delaunay->GetNumberOfInputConnections(1) > 0)
  {
    return "Constraints are for points in memory, not for pieces.";
  }
  return std::string();
}

vtkMTimeType vtkReconstructPieces::TimeOfProperties()
{
  return std::max(this->Delaunay->GetMTime(), this->Trim->GetMTime());
}

/** Triangulates all points, and trims what is near a boundary. */
void vtkReconstructPieces::WorkOnAll(int count, const elevation::Progress& progress)
{
  const bool isTrimmed = this->Trim->GetNumberOfInputConnections(1) > 0;
  elevation::DelaunayOptions options = elevation::OptionsOf(this->Delaunay);
  options.Monitor = elevation::Part(progress, 0.0, isTrimmed ? 0.6 : 1.0);
  this->Work->Triangulate(count, options);
  if (this->Work->All().Triangles == 0)
  {
    vtkWarningMacro(<< elevation::TextOfNoTriangle(this->Work->All().Points));
  }
  else if (isTrimmed)
  {
    this->Trim->GetInputAlgorithm(1, 0)->Update();
    elevation::TrimOptions trimming = elevation::OptionsOf(this->Trim);
    trimming.Monitor = elevation::Part(progress, 0.6, 1.0);
    const auto make = [this](int piece) { return this->MakePiece(piece, elevation::Progress()); };
    this->Trimmed = std::make_unique<elevation::TrimmedPieces>(
      count, this->Work->All().Triangles, make, this->Trim->GetBoundary(), trimming);
  }
}

/** A piece of the triangulation; nullptr: it has no points. */
vtkSmartPointer<vtkPolyData> vtkReconstructPieces::MakePiece(
  int piece, const elevation::Progress& progress)
{
  elevation::SurfacePart part = this->Work->PieceAt(piece, progress);
  if (part.Own.Count() == 0)
  {
    return nullptr;
  }
  auto made = vtkSmartPointer<vtkPolyData>::New();
  elevation::PassPart(
    part, elevation::ResolveNumberOfThreads(this->Delaunay->GetNumberOfThreads()), made);
  elevation::ConstrainedTriangulation counts;
  counts.Result = std::move(part.Result);
  elevation::AddReport(counts, progress, made->GetFieldData());
  return made;
}

int vtkReconstructPieces::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  outputVector->GetInformationObject(0)->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  return 1;
}

int vtkReconstructPieces::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkInformation* const info = outputVector->GetInformationObject(0);
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const auto get = [info](
                     vtkInformationIntegerKey* key) { return info->Has(key) ? info->Get(key) : 0; };
  const int piece = get(Pipeline::UPDATE_PIECE_NUMBER());
  const int count = std::max(1, get(Pipeline::UPDATE_NUMBER_OF_PIECES()));
  vtkPolyData* const output = vtkPolyData::GetData(outputVector);
  if (!this->Work && !this->HasFailed)
  {
    return 1; // no points
  }
  const int cells = this->Work ? this->Work->CountOfCells() : 0;
  if (cells > 0 && cells != count)
  {
    vtkErrorMacro("There are " << cells << " pieces; another number of pieces needs Reset().");
    return 1;
  }
  if (piece < 0 || piece >= count)
  {
    return 1; // empty, as VTK's sources
  }
  const std::string wrong = this->WrongProperty();
  if (cells == 0 && !wrong.empty())
  {
    vtkErrorMacro(<< wrong);
    return 1;
  }
  if (cells > 0 && this->TimeOfProperties() > this->TimeOfWork)
  {
    vtkErrorMacro("Properties were changed after the first piece; that needs Reset().");
    return 1;
  }
  this->Try([this, piece, count, output]() {
    const elevation::Progress progress = elevation::ProgressOf(this);
    if (this->Work->CountOfCells() != count)
    {
      this->TimeOfWork = this->TimeOfProperties();
      this->WorkOnAll(count, elevation::Part(progress, 0.0, 0.9));
    }
    const elevation::Progress last = elevation::Part(progress, 0.9, 1.0);
    if (this->Trimmed)
    {
      this->Trimmed->Pass(piece, last, output);
    }
    else if (const vtkSmartPointer<vtkPolyData> made = this->MakePiece(piece, last))
    {
      output->ShallowCopy(made);
    }
  });
  if (this->HasFailed)
  {
    output->Initialize();
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
  os << indent << "LatticeFound: " << this->GetLatticeFound() << "\n";
  os << indent << "NumberOfTrimmedTriangles: " << this->GetNumberOfTrimmedTriangles() << "\n";
  os << indent << "NumberOfOutwardTriangles: " << this->GetNumberOfOutwardTriangles() << "\n";
  os << indent << "NumberOfRecoveredEdges: " << this->GetNumberOfRecoveredEdges() << "\n";
  os << indent << "NumberOfInsertedPoints: " << this->GetNumberOfInsertedPoints() << "\n";
  os << indent << "NumberOfBoundaryRings: " << this->GetNumberOfBoundaryRings() << "\n";
  os << indent << "Delaunay:\n";
  this->Delaunay->PrintSelf(os, indent.GetNextIndent());
  os << indent << "Trim:\n";
  this->Trim->PrintSelf(os, indent.GetNextIndent());
}
