// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Trims a mesh in pieces along a given boundary, one piece in memory at a time. Private to the
 * module.
 *
 * It is the work of ranks (DistributedTrim.h) on one machine. All pieces are looked at twice: for
 * the triangles near the boundary, which are then trimmed together, and to be written.
 */
#ifndef TrimmedPieces_h
#define TrimmedPieces_h

#include "Adapt/Adapt.h"
#include "BoundaryZone.h"
#include "Kernel/Trim/Trim.h"
#include "TrimOfPart.h"

#include "vtkSmartPointer.h"

#include <functional>
#include <vector>

class vtkPolyData;

namespace elevation
{

class TrimmedPieces
{
public:
  /** Makes a piece, with global ids of its points; nullptr: it has none. */
  using MakePiece = std::function<vtkSmartPointer<vtkPolyData>(int piece)>;

  /**
   * The first look.
   * @param[in] numberOfTriangles  of all pieces
   * @throws Error, as Trim(), and if it needs the whole mesh; Aborted
   */
  TrimmedPieces(int count, vtkIdType numberOfTriangles, const MakePiece& makePiece,
    vtkPolyData* boundary, const TrimOptions& options);

  /** Makes and trims a piece. */
  void Pass(int piece, const Progress& progress, vtkPolyData* output) const;

  /** Of all pieces. */
  const TrimCounts& Counts() const { return this->OfAll; }
  vtkIdType CountOfTriangles() const { return this->Kept; }
  vtkIdType CountOfRings() const { return this->NumberOfRings; }

private:
  void Sweep(TrimOfPart& part, const Progress& progress) const;

  const MakePiece Make;
  const TrimOptions Options;
  const double NumberOfAll;
  BoundaryLines Lines;
  std::vector<TrimmedPart> Backs; // of each piece
  TrimCounts OfAll;
  vtkIdType Kept = 0, NumberOfRings = 0;
};

} // namespace elevation

#endif
