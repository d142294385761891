// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The surface of points that are added slice by slice, triangulated, trimmed and filled in parts in
 * files, on one rank or several: the work behind vtkReconstructPieces. Private to the module.
 *
 * In: slices of points on each rank. Out: the parts of each rank, and what there is of all.
 *
 * The steps:
 *   1. Each rank opens the work and adds its points. No rank waits for another.
 *   2. All ranks begin together: they check what they are asked for, and share the lines.
 *   3. All ranks together triangulate, trim and fill: each step has the parts of the one before made
 *      again from their files.
 *   4. Each rank passes its parts on, one at a time. No rank waits for another.
 *
 * Errors: those of step 2 are that of all ranks, and nothing is lost. They are thrown again, without a
 * meeting of the ranks, until the properties change: so a rank that asks for its next part does not
 * wait for one that has given up. Any other error loses the points of the rank, in step 3 of all ranks.
 * What all ranks throw is for the first one to report.
 */
#ifndef ReconstructParts_h
#define ReconstructParts_h

#include "Adapt/Adapt.h"
#include "FillParts.h"
#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Fill/Fill.h"
#include "Kernel/Messages/Messages.h"
#include "Kernel/Trim/Trim.h"
#include "Ranks.h"
#include "TriangulateParts.h"
#include "TrimParts.h"

#include "vtkElevationSurfaceModule.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

class vtkDataObject;
class vtkMultiProcessController;
class vtkPointSet;
class vtkPolyData;

namespace elevation
{

class VTKELEVATIONSURFACE_EXPORT ReconstructParts
{
public:
  /** What the steps do, the same on all ranks but for the lines. */
  struct Settings
  {
    DelaunayOptions Delaunay;
    TrimOptions Trim;
    FillOptions Fill;
    bool TrimOutward = false; ///< also without a boundary
    bool FillHoles = false;
    bool InterpolatePointData = true;
    // For points in memory alone:
    bool DrapeConstraints = false;
    bool OpenLongTriangles = false;
    // Lines of this rank, or composites of them; nullptr: none.
    vtkDataObject* Constraints = nullptr;
    vtkDataObject* Boundary = nullptr;
  };

  /** Of all parts, the same on all ranks after each step; what a step has not found yet is 0. */
  struct Counts
  {
    vtkIdType Points = 0; ///< before the first step, those that this rank has added
    vtkIdType Triangles = 0, Duplicates = 0, NotFinite = 0, Crossings = 0, AddedPoints = 0;
    bool LatticeFound = false;
    TrimCounts Trim;
    vtkIdType TrimmedTriangles = 0, BoundaryRings = 0;
    vtkIdType Holes = 0, FilledHoles = 0, FilledTriangles = 0;
  };

  ReconstructParts();
  ~ReconstructParts();

  /** @param[in] controller  of the processes that work together; nullptr: this one alone */
  void Open(vtkMultiProcessController* controller);
  void Close(); ///< forgets all points, and removes the files
  bool IsOpen() const { return this->Everybody != nullptr; }
  bool IsAlone() const { return this->Everybody->Count() == 1; }

  /**
   * Step 1.
   * @param[in] folder  an empty one, for the files of this rank
   */
  void Add(vtkPointSet* points, const std::string& folder, const Progress& progress);
  bool HasPoints() const { return this->Work || this->IsLost; } ///< or has lost some

  int CountOfParts() const { return this->NumberOfParts; } ///< 0: before step 2
  /** @throws Error if this rank has no such part, or it has gone */
  void CheckPart(int part, int count) const;

  /**
   * Step 2.
   * @param[in] settings  makes those of this rank
   * @param[in] time      when they were changed last
   * @throws Error on all ranks if any of them cannot begin
   */
  void Begin(int count, const std::string& folder, const std::function<Settings()>& settings,
    vtkMTimeType time);

  // Step 3. What there is to warn of is returned on the first rank.
  std::vector<Message> Triangulate(const Progress& progress);
  bool IsTrimmed() const { return this->Set.TrimOutward || this->Boundary; } ///< after step 2
  std::vector<Message> Trim(const Progress& progress);
  std::vector<Message> Fill(const Progress& progress);

  /**
   * Step 4, for a part of this rank.
   * @param[out] rims  of part 0, the outlines of holes with their reports
   */
  void Pass(int part, const Progress& progress, vtkPolyData* output, vtkPolyData* rims);
  void Forget(int part); ///< removes its files; it cannot be passed on again

  /** Whether this rank has to report what was thrown last. */
  bool IsReporting() const { return !this->IsOfAll || this->Everybody->Own() == 0; }

  Counts All() const;

private:
  void CheckIsComplete() const;
  template <typename Step>
  void Do(bool withAll, const Step& step);
  void Prepare(const std::string& folder, const std::function<Settings()>& settings);
  void Check() const;
  vtkSmartPointer<vtkPolyData> MakePart(int part, const Progress& progress);
  vtkSmartPointer<vtkPolyData> MakeTrimmed(int part, const Progress& progress);

  std::unique_ptr<Ranks> Everybody;
  int NumberOfParts = 0;
  std::set<int> Gone; // parts
  Settings Set;
  vtkSmartPointer<vtkPolyData> Constraints, Boundary; // of all ranks
  std::unique_ptr<TriangulateParts> Work;
  std::unique_ptr<TrimParts> Trimmed;
  std::unique_ptr<FillParts> Filled;
  bool IsLost = false;                 // whether points are
  bool IsOfAll = false;                // whether all ranks have thrown what was thrown last
  std::unique_ptr<CodedError> Refusal; // to begin
  vtkMTimeType TimeOfRefusal = 0;
  int RefusedParts = 0;
};

} // namespace elevation

#endif
