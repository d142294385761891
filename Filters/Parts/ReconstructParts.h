// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The surface of points that are added slice by slice, triangulated, trimmed and filled in parts in
 * files, on one rank or several: the work behind vtkReconstructPieces of the Python package, which
 * is a library of its own and so sees this class alone. Private to the project.
 *
 * In: slices of points on each rank. Out: the parts of each rank, and what there is of all.
 *
 * The steps:
 *   1. Each rank opens the work and adds its points. No rank waits for another.
 *   2. All ranks begin together: they check what they are asked for, and share the lines.
 *   3. All ranks together triangulate, trim and fill: each step has the parts of the one before
 *      made again from their files.
 *   4. Each rank passes its parts on, one at a time. No rank waits for another.
 *
 * Errors: those of step 2 are that of all ranks, and nothing is lost. They are thrown again,
 * without a meeting of the ranks, until the properties change: so a rank that asks for its next
 * part does not wait for one that has given up. Any other error loses the points of the rank, in
 * step 3 of all ranks. What all ranks throw is reported by the first one.
 *
 *     AddPoints()  AddPoints() ...   RequestData(piece 0)        RequestData(piece 1) ...
 *     points to files                all steps; part 0           part 1, from the files
 *
 * The steps are made into each other: FillParts asks for parts by MakeTrimmed(), that makes them by
 * MakePart(), and that takes them from TriangulateParts. Nothing but their own files is kept.
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

#include <exception>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace elevation
{

class VTKELEVATIONSURFACE_EXPORT ReconstructParts
{
public:
  struct Settings
  {
    vtkMTimeType Time = 0;                           ///< when they were changed last
    std::string Folder;                              ///< an empty one, for the files of this rank
    vtkMultiProcessController* Controller = nullptr; ///< nullptr: this process works alone
    bool KeepFiles = true;                           ///< of a part that has been passed on
    // What the steps do, the same on all ranks.
    DelaunayOptions Delaunay;
    TrimOptions Trim;
    FillOptions Fill;
    bool TrimOutward = false; ///< also without a boundary
    bool FillHoles = false;
    bool InterpolatePointData = true;
    double LongestEdge = 0.0;      ///< of triangles that filling does not open; 0: of all
    bool DrapeConstraints = false;   ///< for points in memory alone
    bool RemoveUnusedPoints = false; ///< the same
    bool IsPrecisionGiven = false;   ///< the same
    // Their input 1 has lines of this rank, or composites of them, or there is none.
    vtkAlgorithm* ConstraintsFilter = nullptr;
    vtkAlgorithm* BoundaryFilter = nullptr;
    vtkAlgorithm* AreasFilter = nullptr;
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

  /**
   * @param[in] source     has progress, abort, errors and warnings
   * @param[in] settings   makes those of this rank
   * @param[out] messages  of the last error or warning
   */
  ReconstructParts(
    vtkAlgorithm* source, std::function<Settings()> settings, vtkStringArray* messages);
  ~ReconstructParts();

  /**
   * Whether a setting that is taken with the first points can be changed; else there is an error.
   */
  bool CanChange(const char* setting);
  void Close(); ///< forgets all points, and removes the files

  /**
   * Step 1.
   * @return whether it could be done; else there is an error
   */
  bool AddPoints(vtkPointSet* points);

  /**
   * Step 4 for the part that the pipeline asks for, at first steps 2 and 3 for all.
   * @param[out] outputs  the part; of part 0, the outlines of holes with their reports
   * @return what ProcessRequest returns, after an error too
   */
  int RequestData(vtkInformation* request, vtkInformationVector* outputs);

  Counts GetCounts() const;

private:
  // What is known, and checked, before all begin:
  void Open(vtkMultiProcessController* controller);
  bool IsAlone() const { return this->AllRanks->Count() == 1; }
  bool HasPoints() const { return this->Work || this->IsLost; } // or has lost some
  bool IsTrimmed() const { return this->Set.TrimOutward || this->Boundary; }
  void CheckIsComplete() const;
  void CheckPart(int part, int count) const;
  template <typename Step>
  void Do(bool withAll, const Step& step);
  // Step 2:
  void Begin(int count);
  void Prepare();
  void Check() const;
  // Step 3:
  void WorkOnAll(const Progress& progress);
  void Triangulate(const Progress& progress);
  void Trim(const Progress& progress);
  void Fill(const Progress& progress);
  // Step 4, and what the steps of 3 hand to each other:
  vtkSmartPointer<vtkPolyData> MakePart(int part, const Progress& progress);
  vtkSmartPointer<vtkPolyData> MakeTrimmed(int part, const Progress& progress);
  void Pass(int part, const Progress& progress, vtkPolyData* output, vtkPolyData* rims);
  void ReportError(const std::exception& error);
  void ReportWarnings(const std::vector<Message>& warnings);

  vtkAlgorithm* Source;
  std::function<Settings()> MakeSettings;
  vtkStringArray* Messages;
  std::unique_ptr<Ranks> AllRanks;
  int NumberOfParts = 0;
  std::set<int> Gone; // parts
  Settings Set;
  vtkSmartPointer<vtkPolyData> Constraints, Boundary, AreaLines; // of all ranks
  std::unique_ptr<TriangulateParts> Work;
  std::unique_ptr<TrimParts> Trimmed;
  std::unique_ptr<FillParts> Filled;
  bool IsLost = false;                 // whether points are
  bool IsOnAllRanks = false;           // whether all ranks have thrown what was thrown last
  std::unique_ptr<CodedError> Refusal; // to begin
  vtkMTimeType RefusalTime = 0;
  int RefusedParts = 0;
};

} // namespace elevation

#endif
