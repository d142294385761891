// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Fills the holes of a surface in parts, as those of the whole surface would be. Private to the
 * module.
 *
 * In: the parts of an engine, in memory or in files (Engine.h), each made when it is worked on
 * (SurfaceParts.h). Out: each part with its patches, and the outlines of all holes with their
 * reports.
 *
 * The passes, each of which all ranks do at the same time:
 *   1. All ranks find the border of the surface from the borders of the parts, and so the same
 *      holes (Holes.h).
 *   2. The lattice of all points is looked for, each counted once.
 *   3. Each hole goes to a group of holes that are filled together. In memory a rank has one group:
 *      the largest hole goes first, to the rank with least work so far. In files a part has some:
 *      of those holes of which it has the first point of the rim.
 *   4. The parts send each group the triangles in a box around each of its holes, with their
 *      points.
 *   5. When it is known what each hole may take of MaximumInsertedPoints, the groups are filled,
 *      and their patches go to their parts. Where a hole turns out to need triangles outside of its
 *      box, 4 and 5 are done again for its group with a larger one, in the end with all triangles.
 *   6. A part is written: its triangles, and the patches of its groups. Their corners that are
 *      other parts' points become its ghosts.
 * Groups are the parts of an engine of their own, as what surrounds them lies in memory or in
 * files, too.
 *
 * Patches are those of one run, to the last bit: their lattice is that of all points, and besides
 * they depend only on what is in the box.
 *
 * Cost: a rank sends the edges on the border of its parts once, and the triangles around holes.
 * Parts in files are made in pass 1, twice in pass 2, in pass 4 if they are near a hole, and
 * in pass 6. Memory for files: what a part takes, and the border of all parts; then what surrounds
 * a group, far less than a part, unless that of a single hole is larger: a box that reaches 1.5
 * times its size beyond it, or further if its kernel asks for it. What surrounds the groups of
 * other ranks is in memory for one part at a time.
 */
#ifndef FillParts_h
#define FillParts_h

#include "Adapt/Adapt.h"
#include "FilledPart.h"
#include "SharedHoles.h"
#include "SurfaceParts.h"

#include <map>
#include <memory>
#include <vector>

namespace elevation
{
struct Block;

/**
 * One use: FindHoles() and Fill() once on all ranks, then Pass() for each part of this rank, as
 * often as wanted from files, and PassRims() on the rank of rimsPart.
 */
class FillParts
{
public:
  /**
   * All ranks make one together, and do its passes together but the last.
   * @param[in] options  Monitor: of all passes but the last
   * @param[in] longest  edge of a triangle that is not opened; 0: none is
   * @param[in] byIds  whether points of parts are one by global ids, as in files; or by x,y,z
   */
  FillParts(const SurfaceParts& surface, const FillOptions& options, bool interpolate,
    double longest, bool byIds = true);

  /**
   * Pass 1.
   * @param[in] rimsPart  its rank gets the outlines
   * @throws Error on all ranks, if the surface cannot be filled in parts: borders touch, or a point
   *         or an edge is there too often; Aborted
   */
  void FindHoles(int rimsPart);

  /** Passes 2 to 5. @throws Error, Aborted on all ranks */
  void Fill();

  /** Pass 6, for a part of this rank. From memory it can be written once. */
  void Pass(int part, const Progress& progress, vtkPolyData* output);

  /** Writes the outlines of all holes, on the rank that got them. */
  void PassRims(const Progress& progress, vtkPolyData* output);

  // Of all parts, on all ranks:
  const FillResult& Result() const { return this->AllHoles.Result; } ///< holes and reports
  vtkIdType NewTriangleCount() const { return this->NewTriangles; }

private:
  /** What all ranks know of a part. */
  struct KnownPart
  {
    Box Extent; ///< of its triangles
    double Triangles = 0.0;
    vtkIdType Points = 0, OwnPoints = 0; ///< with those that other parts count, and without
    vtkIdType LargestId = -1;
    Index NextHole = 0;
    double LargestHeight = 0.0; ///< of a long triangle
    ElevationRange Elevations;  ///< of its triangles
  };
  /** Holes of one part, increasing, that are filled together. */
  struct Group
  {
    int Part;
    std::vector<Index> Holes;
  };

  template <typename Visit>
  void WithPart(int part, const Progress& progress, const Visit& visit);
  // Pass 1:
  void SendRims(Parts&& borders);
  void FindReaches();
  KnownPart Describe(int part, const FilledPart& one);
  // Pass 2:
  void FindLattice(const Progress& progress);
  // Pass 3:
  std::vector<int> HoleParts() const;
  double PointsAround(Index hole, const KnownPart& part) const;
  void GroupHoles();
  // Passes 4 and 5:
  void Surround(const std::vector<char>& areWaiting, const Progress& progress);
  SurroundedHoles& HolesOf(int group, const Progress& progress);
  template <typename Value>
  void ShareHoleValues(std::vector<Value>& values) const;
  void FindQuotas(const Progress& progress);
  bool FillGroup(int group, const Progress& progress, std::vector<vtkIdType>& beyond);
  void FillAll(const Progress& progress);
  // Pass 6:
  void TakePatches(int part, FilledPart& one);

  const SurfaceParts::MakePart Make;
  Engine Crew; // of the parts
  const Ranks& AllRanks;
  Stages Passes; // FindHoles(), and Fill()
  int RimsPart = 0;
  Parts OwnRims;       // if this rank has that part: points of its parts
  FilledPart InMemory; // the part of this rank, in memory
  std::vector<KnownPart> KnownParts;
  double Points = 0.0, RankPoints = 0.0; // of all parts, and of those of this rank
  vtkIdType LargestId = -1;
  SharedHoles AllHoles;
  std::vector<Group> Groups;         // of all ranks, in their order
  std::unique_ptr<Engine> GroupCrew; // whose parts they are
  SurroundedHoles Around;            // of the group that is worked on
  vtkIdType NewTriangles = 0;        // of this rank until all are filled
  std::map<PartRegion, vtkIdType> LongTriangles; // of this rank's parts, in each region
  bool AreMarked = true;             // whether any part has others' points
};

/**
 * Fills a surface of which each rank has one part, in memory; all ranks call it.
 * @param[in,out] block    Input is this rank's part; the report goes to the first rank with Outputs
 * @param[out]    patches  the holes and reports of all ranks
 * @return false on all ranks, with nothing written, if the surface has to be gathered: ranks with
 *         different arrays or types of points, cells that are not triangles or ghosts, borders that
 *         touch, and whatever is an error before any hole is filled
 * @throws Error, Aborted on all ranks
 */
bool FillOnRanks(const Ranks& ranks, const FillOptions& options, bool interpolate, double longest,
  Block& block, FillResult& patches);

} // namespace elevation

#endif
