// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Fills the holes of a surface in pieces, one piece in memory at a time. Private to the module.
 *
 * It is the work of ranks (DistributedFill.h) on one machine. A hole belongs to the piece that has
 * the first point of its rim. The passes over all pieces:
 *   1. What is on their borders tells the holes.
 *   2. Their points tell the lattice, in two more passes.
 *   3. The triangles around the holes of each piece go to a file. These holes are filled, and their
 *      patches go to another file. Where a hole turns out to need more triangles, those of a larger
 *      box are looked for.
 *   4. Each piece is written with its patches.
 *
 * Memory: what a piece takes, and the surrounding of its holes; that of a hole is a box that
 * reaches 1.5 times its size beyond it, or further if its kernel asks for it. The border of all
 * pieces.
 */
#ifndef FilledPieces_h
#define FilledPieces_h

#include "FilledPart.h"
#include "HolesOfParts.h"
#include "SpoolFile.h"

#include "vtkSmartPointer.h"

#include <functional>
#include <string>
#include <vector>

class vtkPolyData;

namespace elevation
{

class FilledPieces
{
public:
  /** Makes a piece, with global ids of its points; nullptr: it has none. */
  using MakePiece = std::function<vtkSmartPointer<vtkPolyData>(int piece, const Progress&)>;

  /**
   * All passes but the last.
   * @param[in] folder          of the files
   * @param[in] numberOfPoints  of all pieces; their global ids are lower
   * @throws Error, Aborted
   */
  FilledPieces(int count, const std::string& folder, vtkIdType numberOfPoints,
    const MakePiece& makePiece, const FillOptions& options, bool interpolate);

  /** Makes a piece with its patches. */
  void Pass(int piece, const Progress& progress, vtkPolyData* output) const;

  /** Writes the rims of all holes. */
  void PassRims(vtkPolyData* output) const;

  /** The holes of all pieces, and their reports. */
  const FillResult& Result() const { return this->Whole.OfAll; }
  vtkIdType CountOfNewTriangles() const { return this->NewTriangles; }

private:
  struct PieceFiles
  {
    Box Place; ///< of its triangles
    std::vector<Index> Holes;
    SpoolFile Surrounding, Patches;
  };

  /** Makes each piece with points; the monitor goes from begin to end. */
  template <typename Visit>
  void ForEachPiece(double begin, double end, const Visit& visit) const;
  template <typename Visit>
  void VisitPiece(int piece, const Progress& progress, const Visit& visit) const;
  void FindHoles();
  void AssignHoles();
  void FindLattice();
  void Surround(const std::vector<char>& areWaiting, double begin, double end);
  void AppendSurroundings(
    int piece, const std::vector<std::vector<Box>>& boxes, const Progress& progress);
  SurroundedHoles HolesOf(int piece, const Progress& progress) const;
  void FindRooms();
  void FillAll();
  bool FillHolesOf(int piece, const Progress& progress);

  const MakePiece Make;
  const vtkIdType NumberOfPoints;
  std::vector<PieceFiles> Pieces;
  HolesOfParts Whole;
  Parts Rims; // points on the border
  vtkIdType NewTriangles = 0;
};

} // namespace elevation

#endif
