// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangulation of points in parts, which is that of all points at once. Private to the module.
 *
 * In: the points of all ranks, at once or in slices (PointDistributor.h), and lines that become edges.
 * Out: the part of the surface in each cell of the plane, with the corners that its triangles have
 * in other parts.
 *
 * Parts are those of an engine (Engine.h): one for each rank in memory, or some of each rank in
 * files, one of them in memory at a time. The passes, each of which all ranks do at the same time:
 *   1. The plane is cut into a cell for each part, and each point goes to the part of its cell.
 *      Lines add points (ConstrainParts.h); without lines, the lattice of all points is looked for.
 *   2. Each part is triangulated, and what its cell settles stays there (Pieces.h). Where a rank
 *      holds both halves of a larger cell, it then settles what that can.
 *   3. The seams of the others go to the first part of the two halves, level by level up to the
 *      whole plane.
 *   4. The triangles that seams have settled go to the parts of their lowest corners.
 *   5. These ask the parts of the other corners for the points, with the values of their arrays.
 *   6. Lines are recovered as edges, of which pass 5 is done again, and long edges left out.
 * Should not all points be on the lattice, passes 2 and 3 are done again without it.
 *
 * Why the result is that of one rank: Pieces.h proves it for passes 2 and 3, RecoverSegments.h for
 * lines. What depends on the order of points (duplicates, fans of co-circular points) depends on
 * ids and positions here, which do not change with the parts.
 *
 * Cost: a rank sends 32 bytes for a point, and the values of arrays, once, and the same for the
 * points of some multiple of sqrt(m) of the m points of a part: those of seams, and those at which
 * its triangles meet those of other parts. There are log2(ranks) rounds of seams. Memory for files:
 * what the fullest part takes, and the seams. Files: 32 bytes a point and the values of its arrays,
 * twice in pass 1, and 24 for its triangles. They are read up to four times while a lattice is
 * looked for, once in pass 2, up to three times more with lines and once with a limit of edges, and
 * again whenever a part is asked for.
 */
#ifndef TriangulateParts_h
#define TriangulateParts_h

#include "Adapt/Adapt.h"
#include "Engine.h"
#include "Kernel/Cells/Cells.h"
#include "Kernel/Messages/Messages.h"
#include "PartStore.h"
#include "PointDistributor.h"
#include "SurfacePart.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace elevation
{

/**
 * One use: Add(), then Triangulate() once on all ranks, then Take() for each part of this rank, as
 * often as wanted from files. The engine and its boxes live as long as this object; later steps
 * (SurfaceParts.h) refer to them.
 */
class TriangulateParts
{
public:
  /** @param[in] folder  an empty one, for parts in files; or no name: parts in memory */
  explicit TriangulateParts(const Ranks& ranks, const std::string& folder = std::string());
  ~TriangulateParts();

  void UseDoublePoints() { this->Distributor.UseDoublePoints(); }
  /** As PointDistributor::Add(). */
  void Add(vtkPointSet* points, const Progress& progress);

  /**
   * Does all passes, on all ranks.
   * @param[in] ownParts  of this rank; in memory at most one. A rank without parts has no points.
   * @param[in] constraints  lines, the same on all ranks; or nullptr
   * @param[out] warnings  on the constraints
   * @throws Error, Aborted on all ranks when any of them fails; std::bad_alloc on one rank alone:
   *         with more parts it may succeed
   */
  void Triangulate(int ownParts, vtkPolyData* constraints, const DelaunayOptions& options,
    std::vector<Message>& warnings);

  Engine& Holders() const { return *this->Crew; } ///< of the parts, after it
  int PartCount() const { return this->Crew ? this->Crew->PartCount() : 0; } ///< 0: before it
  int FirstOwn() const { return this->Crew->FirstOwn(); }                    ///< part of this rank
  vtkIdType PointCount() const { return this->Distributor.Count(); } ///< that this rank has added

  /** Of all parts, on all ranks after Triangulate(). Each point and triangle counts once. */
  struct Totals
  {
    vtkIdType Points = 0; ///< without those that constraints add
    vtkIdType AddedPoints = 0;
    vtkIdType Duplicates = 0, NotFinite = 0, Hidden = 0;
    vtkIdType Settled = 0;   ///< triangles, also those with an edge above MaximumEdgeLength
    vtkIdType Triangles = 0; ///< without these
    LimitEffect Effect; ///< if there is a limit; the lengths of edges for parts in memory alone
    std::int64_t Crossings = 0; ///< of the constraints
    bool LatticeFound = false;
    Lattice Steps; ///< if found
  };
  const Totals& GetTotals() const { return this->Total; }
  /** Warns of points that have made no triangle, or of a limit that leaves few. */
  void WarnOfMissing(std::vector<Message>& warnings) const;

  /** Of this rank. */
  struct Effort
  {
    Index Points = 0;     ///< that its parts own
    Index SeamPoints = 0; ///< of the cells of its parts
  };
  const Effort& GetEffort() const { return this->Work; }

  const std::set<std::string>& LeftOut() const
  {
    return this->Store->Part.LeftOut;
  } ///< as of SurfacePart

  /** Whether the points of all parts are float. */
  bool AreFloat() const { return this->Store->Part.PointType == VTK_FLOAT; }

  /** A part of this rank, with its unused points. From memory it can be taken once. */
  SurfacePart Take(int part, const Progress& progress);

  /** Removes the files of a part that is not needed again. */
  void Forget(int part) { this->Store->Forget(part); }

private:
  std::vector<GlobalTriangle> Settle(const Progress& progress);
  void SendTriangles(std::vector<GlobalTriangle>&& ofSeams);
  /** Pass 5. It may be done again, and then asks for all points anew. */
  void FetchOthers(const Progress& progress);
  std::vector<vtkIdType> RequestedIndices(int part) const;
  /**
   * The end of pass 6: counts what MaximumEdgeLength leaves. Nothing is written; Take() applies it.
   */
  void LimitEdges(const Progress& progress);

  const Ranks& AllRanks;
  const std::string Folder;
  PointDistributor Distributor;
  DelaunayOptions Options;
  std::unique_ptr<Engine> Crew;
  std::unique_ptr<PartStore> Store;
  std::unique_ptr<Cuts> Plane;
  Totals Total;
  Effort Work;
};

/** Adds what the work of this rank on points of all ranks took. */
void AddWork(
  const Ranks::Traffic& traffic, const TriangulateParts::Effort& effort, vtkFieldData* fieldData);

} // namespace elevation

#endif
