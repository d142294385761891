// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Brings points, as they come, to the parts of the plane in which they lie. Private to the module.
 *
 * In: points of this rank with their arrays, all at once, or slice by slice where they do not fit
 * into memory. Out: cuts of the plane (Cuts.h), with a cell for each part, and the points of each
 * cell with its part.
 *
 * The passes:
 *   1. Slices are written to a file as they come; points that come at once stay where they are. A
 *      sample is kept.
 *   2. All ranks agree on the arrays and the numbers of their points.
 *   3. The samples of all ranks decide where to cut the plane.
 *   4. Slice by slice, each point goes to the part of its cell. What is not finite has no place in
 *      the plane and stays on its rank, spread evenly over the parts there. Points that are marked
 *      as another rank's (vtkDataSetAttributes::DUPLICATEPOINT) go nowhere.
 *
 * Cost: linear. 32 bytes a point, and the values of its arrays, are sent once, and written twice
 * where points come in slices.
 */
#ifndef PointDistributor_h
#define PointDistributor_h

#include "Adapt/Adapt.h"
#include "Engine.h"
#include "Kernel/Cells/Cells.h"
#include "PointTable.h"
#include "SurfacePart.h"

#include "vtkNew.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace elevation
{

/**
 * One use: Add() as often as there are slices, each on its own rank alone; then Distribute() once,
 * on all ranks together.
 */
class PointDistributor
{
public:
  /** @param[in] folder  an empty one, for files; or no name: Add() is called at most once, with points
      that stay until Distribute() */
  PointDistributor(const Ranks& ranks, const std::string& folder);
  ~PointDistributor();

  /** Whatever the type of the points is. */
  void UseDoublePoints() { this->PointType = VTK_DOUBLE; }

  /**
   * Adds points of this rank, numbered on.
   * @throws Error if their arrays are not as those before; Aborted
   */
  void Add(vtkPointSet* points, const Progress& progress);

  /**
   * Whether the points bring global ids, known after Distribute(); or these are indices: the points
   * of all ranks counted, rank after rank, in the order of Add().
   */
  bool AreIdsGiven() const { return this->AreGiven; }
  vtkIdType Count() const { return this->OwnCount; } ///< of this rank, marked ones included

  /**
   * Passes 2 to 4, on all ranks. The points are no longer here.
   * @param[in] box  of each part in files, for its points
   * @param[out] common  gets what parts have in common: kinds of arrays and so on; in memory, also
   *             the points, rank after rank
   * @param[out] counts  of the points that this rank has sent to each part
   * @throws Error, Aborted on all ranks when any of them fails
   */
  Cuts Distribute(Engine& engine, int box, const Progress& progress, SurfacePart& common,
    std::vector<vtkIdType>& counts);

private:
  struct SampledPoint
  {
    vtkIdType Position; // among those of this rank
    Point2 At;
  };

  bool IsInFile() const { return !this->Folder.empty(); }
  /** The arrays of the next slice. @throws Error if they differ from those before */
  void TakeKinds(vtkPointSet* points);
  /** Pass 1, for points in slices. */
  void SampleStretch(const std::vector<vtkIdType>& indices);
  void KeepSample();
  /** Pass 2. */
  void NumberPoints(SurfacePart& common);
  void Read(vtkPointSet* points, const std::string& idsName, vtkIdType first);
  /** Pass 3. */
  std::vector<Point2> SampleAtOnce(vtkIdType parts) const;
  Cuts CutPlane(int parts);
  /** Pass 4. */
  void SendSlice(const Cuts& plane, Engine& engine, int box, const Progress& progress,
    std::vector<vtkIdType>& counts);
  void JoinOwn(Engine& engine, int box, PointTable& own);

  const Ranks& AllRanks;
  vtkIdType OwnCount = 0, First = 0; // the number of the first
  int PointType = VTK_FLOAT;         // where all are float
  bool AreGiven = false;             // their global ids
  // Points that come at once:
  vtkPointSet* Input = nullptr; // nullptr: no points
  // Those that come in slices:
  std::string Folder;           // empty: they come at once
  std::vector<Inbox> Stretches; // each in a file of its own
  vtkIdType InLastStretch = 0;  // points
  vtkNew<vtkPointData> Arrays;  // those of the slices, without values
  std::vector<ArrayKind> Kinds;
  std::vector<SampledPoint> Sample;
  std::uint64_t SampleMask = 0;
  // What is written or sent next:
  PointTable Rows;
  std::vector<vtkIdType> Staying; // of these, in memory: those that go to no other rank
};

} // namespace elevation

#endif
