// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "TrimmedPieces.h"

#include "vtkPolyData.h"

#include <utility>

namespace elevation
{

TrimmedPieces::TrimmedPieces(int count, vtkIdType numberOfTriangles, const MakePiece& makePiece,
  vtkPolyData* boundary, const TrimOptions& options)
  : Make(makePiece)
  , Options(options)
  , NumberOfAll(static_cast<double>(numberOfTriangles))
  , Backs(static_cast<std::size_t>(count))
{
  CheckArrays(boundary, "The boundary's");
  this->Lines = ToLines(boundary, Progress());
  Parts near;
  std::vector<int> ofNear;
  for (int i = 0; i < count; ++i)
  {
    const Progress progress = Part(options.Monitor, 0.8 * i / count, 0.8 * (i + 1) / count);
    if (const vtkSmartPointer<vtkPolyData> piece = this->Make(i))
    {
      TrimOfPart part(piece);
      this->Sweep(part, progress);
      this->Kept += part.CountOfSide(0);
      this->OfAll.OutwardTriangles += part.CountOfSide(1);
      near.push_back(part.NearPart());
      ofNear.push_back(i);
    }
  }
  BoundaryZone gathered(std::move(near));
  TrimOptions together = options;
  together.Monitor = Part(options.Monitor, 0.8, 1.0);
  if (!gathered.Trim(this->Lines, together))
  {
    throw Error("The pieces cannot be trimmed along this boundary; trim the surface in memory.");
  }
  std::vector<TrimmedPart> backs = gathered.Split(Progress());
  for (std::size_t i = 0; i < backs.size(); ++i)
  {
    this->Kept += static_cast<vtkIdType>(backs[i].Parents[0].size());
    this->OfAll.OutwardTriangles += static_cast<vtkIdType>(backs[i].Parents[1].size());
    this->Backs[ofNear[i]] = std::move(backs[i]);
  }
  this->OfAll.RecoveredEdges = gathered.Result().NumberOfRecoveredEdges;
  this->OfAll.InsertedPoints = static_cast<vtkIdType>(gathered.Result().Inserted.size());
  this->NumberOfRings = static_cast<vtkIdType>(gathered.Result().Boundary.Count());
  if (this->Kept == 0)
  {
    throw Error("The boundary encloses no triangle of the mesh.");
  }
}

/** Reads the triangles of a piece, and finds those near the boundary. */
void TrimmedPieces::Sweep(TrimOfPart& part, const Progress& progress) const
{
  part.Read();
  if (!part.Sweep(this->Lines, this->NumberOfAll, this->Options.NumberOfThreads, progress))
  {
    throw Error("The boundary is too small or too large for pieces; trim the surface in memory.");
  }
}

void TrimmedPieces::Pass(int piece, const Progress& progress, vtkPolyData* output) const
{
  const vtkSmartPointer<vtkPolyData> made = this->Make(piece);
  if (!made)
  {
    return;
  }
  TrimOfPart part(made);
  this->Sweep(part, Part(progress, 0.0, 0.4));
  part.NearPart();
  part.Take(TrimmedPart(this->Backs[piece]), Part(progress, 0.4, 0.5));
  part.Write(this->OfAll.InsertedPoints > 0, true, &this->Lines, this->Options,
    Part(progress, 0.5, 1.0), output, nullptr);
}

} // namespace elevation
