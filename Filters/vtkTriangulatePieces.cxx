// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTriangulatePieces.h"

#include "CellByCell.h"
#include "DelaunayReport.h"
#include "Kernel/Base/Base.h"
#include "KernelCall.h"
#include "LimitAdvice.h"
#include "Ranks.h"
#include "vtkGridDelaunay2D.h"

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

vtkStandardNewMacro(vtkTriangulatePieces);

vtkTriangulatePieces::vtkTriangulatePieces()
{
  this->SetNumberOfInputPorts(0);
}

vtkTriangulatePieces::~vtkTriangulatePieces() = default;

void vtkTriangulatePieces::SetFolder(const std::string& folder)
{
  if (this->Folder != folder)
  {
    this->Folder = folder;
    this->Modified();
  }
}

vtkGridDelaunay2D* vtkTriangulatePieces::GetDelaunay()
{
  return this->Delaunay;
}

/** Reports what the work throws. */
bool vtkTriangulatePieces::Try(const std::function<void()>& work)
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

bool vtkTriangulatePieces::AddPoints(vtkPointSet* points)
{
  return this->Try([this, points]() {
    if (!points || this->Folder.empty())
    {
      throw elevation::Error(points ? "Folder is not set." : "There is no data set of points.");
    }
    if (!this->Work)
    {
      this->Work = std::make_unique<elevation::CellByCell>(this->Folder);
    }
    if (this->Work->CountOfCells() > 0)
    {
      throw elevation::Error("Points cannot be added after the first piece; Reset() begins again.");
    }
    this->Work->Add(points, elevation::ProgressOf(this));
    this->Modified();
  });
}

void vtkTriangulatePieces::Reset()
{
  this->Work.reset();
  this->HasFailed = false;
  this->Modified();
}

vtkIdType vtkTriangulatePieces::GetNumberOfPoints()
{
  return this->Work ? this->Work->All().Points : 0;
}

vtkIdType vtkTriangulatePieces::GetNumberOfTriangles()
{
  return this->Work ? this->Work->All().Triangles : 0;
}

vtkIdType vtkTriangulatePieces::GetNumberOfDuplicatePoints()
{
  return this->Work ? this->Work->All().Duplicates : 0;
}

vtkIdType vtkTriangulatePieces::GetNumberOfNonFinitePoints()
{
  return this->Work ? this->Work->All().NotFinite : 0;
}

bool vtkTriangulatePieces::GetLatticeFound()
{
  return this->Work && this->Work->All().LatticeFound;
}

int vtkTriangulatePieces::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  outputVector->GetInformationObject(0)->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  return 1;
}

int vtkTriangulatePieces::RequestData(
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
  this->Try([this, piece, count, output]() {
    const elevation::Progress progress = elevation::ProgressOf(this);
    elevation::DelaunayOptions options = elevation::OptionsOf(this->Delaunay);
    options.Monitor = elevation::Part(progress, 0.0, 0.9);
    if (this->Work->CountOfCells() != count)
    {
      this->Work->Triangulate(count, options);
      if (this->Work->All().Triangles == 0)
      {
        vtkWarningMacro(<< elevation::TextOfNoTriangle(this->Work->All().Points));
      }
    }
    elevation::SurfacePart part = this->Work->PieceAt(piece, elevation::Part(progress, 0.9, 1.0));
    elevation::PassPart(part, elevation::ResolveNumberOfThreads(options.NumberOfThreads), output);
    elevation::ConstrainedTriangulation counts;
    counts.Result = std::move(part.Result);
    elevation::AddReport(counts, elevation::Part(progress, 1.0, 1.0), output->GetFieldData());
  });
  if (this->HasFailed)
  {
    output->Initialize();
  }
  return 1;
}

void vtkTriangulatePieces::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Folder: " << this->Folder << "\n";
  os << indent << "NumberOfPoints: " << this->GetNumberOfPoints() << "\n";
  os << indent << "NumberOfTriangles: " << this->GetNumberOfTriangles() << "\n";
  os << indent << "NumberOfDuplicatePoints: " << this->GetNumberOfDuplicatePoints() << "\n";
  os << indent << "NumberOfNonFinitePoints: " << this->GetNumberOfNonFinitePoints() << "\n";
  os << indent << "LatticeFound: " << this->GetLatticeFound() << "\n";
  os << indent << "Delaunay:\n";
  this->Delaunay->PrintSelf(os, indent.GetNextIndent());
}
