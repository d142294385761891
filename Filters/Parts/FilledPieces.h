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
 *   3. The triangles around some holes, a group of one piece, go to a file. These holes are filled,
 *      and their patches go to the file of the piece. Where a hole turns out to need more triangles,
 *      those of a larger box are looked for.
 *   4. Each piece is written with its patches.
 *
 * Memory: what a piece takes, and the border of all pieces. The surrounding of a group takes far
 * less than a piece, unless that of a single hole is larger: a box that reaches 1.5 times its size
 * beyond it, or further if its kernel asks for it.
 */
#ifndef FilledPieces_h
#define FilledPieces_h

#include "FilledPart.h"
#include "SharedHoles.h"
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
  struct PieceOfAll
  {
    Box Place; ///< of its triangles
    double NumberOfTriangles;
    SpoolFile Patches;
  };
  /** Holes of one piece, increasing, that are filled together. */
  struct Group
  {
    int Piece;
    std::vector<Index> Holes;
    SpoolFile Surrounding;
  };

  /** Makes each piece with points; the monitor goes from begin to end. */
  template <typename Visit>
  void ForEachPiece(double begin, double end, const Visit& visit) const;
  template <typename Visit>
  void VisitPiece(int piece, const Progress& progress, const Visit& visit) const;
  void FindHoles();
  double PointsAround(Index hole, int piece) const;
  void GroupHoles();
  void FindLattice();
  void Surround(const std::vector<char>& areWaiting, double begin, double end);
  void AppendSurroundings(
    int piece, const std::vector<std::vector<Box>>& boxes, const Progress& progress);
  SurroundedHoles HolesOf(const Group& group, const Progress& progress) const;
  void FindQuotas();
  void FillAll();
  bool FillHolesOf(Group& group, const Progress& progress);

  const std::string Folder;
  const MakePiece Make;
  const vtkIdType NumberOfPoints;
  std::vector<PieceOfAll> Pieces;
  std::vector<Group> Groups;
  SharedHoles Whole;
  Parts Rims; // points on the border
  vtkIdType NewTriangles = 0;
};

} // namespace elevation

#endif
