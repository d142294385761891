// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangulation of more points than memory holds, cell by cell of the plane, which is that of
 * all points at once. Private to the module.
 *
 * It is the work of ranks (DistributedDelaunay.h) on one machine, one cell after another. What is
 * not worked on is in files. The passes:
 *   1. All points are written to a file as they come. A sample is kept.
 *   2. The sample tells where to cut the plane (Cuts.h). The lattice is looked for. Each point
 *      goes to the file of its cell.
 *   3. Cell by cell is triangulated, and what it settles is written to another file of the cell;
 *      the seams go up the tree of cells (Pieces.h).
 *   4. A cell's piece of the surface is made of its two files. Triangles that are settled by seams
 *      belong to the cell of their lowest corner.
 *
 * Cost: linear in the points. Memory: what the fullest cell takes, and the seams, some multiple of
 * sqrt(m) points for each cell with m points. Files: 32 bytes a point and the values of its arrays,
 * twice in pass 2, and 24 for its triangles.
 */
#ifndef CellByCell_h
#define CellByCell_h

#include "Kernel/Cells/Cells.h"
#include "PointRows.h"
#include "SpoolFile.h"
#include "SurfacePart.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

class vtkPointSet;

namespace elevation
{
struct PointSlices;

class CellByCell
{
public:
  /** @param[in] folder  of the files, in which nothing else is */
  explicit CellByCell(const std::string& folder);

  /** Adds points, numbered on. @throws Error if their arrays are not as those before; Aborted */
  void Add(vtkPointSet* points, const Progress& progress);

  /** Passes 2 and 3. @throws Error, Aborted; std::bad_alloc: in more cells it may succeed */
  void Triangulate(int cells, const DelaunayOptions& options);

  int CountOfCells() const { return static_cast<int>(this->Cells.size()); } ///< 0: not yet cut
  vtkIdType CountOfPoints() const { return this->Total.Points; }

  /** Sums over the whole cloud. */
  struct Totals
  {
    vtkIdType Points = 0, Duplicates = 0, NotFinite = 0;
    vtkIdType Settled = 0;   ///< triangles, also those with an edge above MaximumEdgeLength
    vtkIdType Triangles = 0; ///< without these
    vtkIdType Missing = 0;   ///< vertices without a triangle; known after Triangulate()
    bool LatticeFound = false;
    Lattice Steps; ///< if found
  };
  const Totals& All() const { return this->Total; }

  /** The piece of a cell, with unused points; global ids tell the order of Add(). */
  SurfacePart PieceAt(int cell, const Progress& progress) const;

private:
  struct SampledPoint
  {
    vtkIdType Id;
    Point2 At;
  };
  /** What is known of a cell between its turns. */
  struct CellFiles
  {
    SpoolFile Points, Triangles;
  };

  void TakeKinds(vtkPointSet* points);
  void SampleStretch(const PointRows& rows, vtkIdType first, vtkIdType last);
  PointRows Unpacked(Bytes&& packed) const;
  PointSlices AllSlices() const;
  PointSlices SlicesOfCells() const;
  void Distribute(const Progress& progress);
  bool SettleOn(const SharedLattice* lattice);
  Piece SettleNode(int begin, int end, const SharedLattice* lattice);
  Piece SettleLeaf(int cell, const SharedLattice* lattice);
  SurfacePart OwnPart(int cell) const;
  void KeepSeam(const SurfacePart& part, GlobalId first, const Piece& seam);
  void CountShort(const SurfacePart& part, GlobalId first);
  void CountShort(const std::vector<GlobalTriangle>& triangles);
  std::size_t PlaceOnSeam(GlobalId number) const;
  using Numbers = std::vector<GlobalId>::const_iterator;
  static void ListUnused(Numbers seamBegin, Numbers seamEnd, GlobalId first,
    const Progress& progress, SurfacePart& part);
  DelaunayOptions OptionsWith(const Progress& progress) const;
  double PartDone() const;

  const std::string Folder;
  std::vector<ArrayKind> Kinds;
  int TypeOfPoints = VTK_FLOAT; // where all are float
  SpoolFile Rows;               // of all points, until they are in the files of cells
  std::vector<SampledPoint> Sample;
  std::uint64_t SampleMask = 0;
  DelaunayOptions Options;
  std::unique_ptr<Cuts> Plane;
  std::vector<CellFiles> Cells;
  std::vector<vtkIdType> Bases;                     // cell c has numbers [Bases[c], Bases[c + 1])
  PointRows SeamRows;                               // the points of the seams of cells
  std::vector<GlobalId> SeamNumbers;                // of these, increasing
  std::vector<char> AreSeamsMissing;                // one each: without a triangle within the limit
  std::vector<std::vector<GlobalTriangle>> OfSeams; // of the cells that own them
  int CellsDone = 0;
  Totals Total;
};

} // namespace elevation

#endif
