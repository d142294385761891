// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The points and the surface of each part: in memory, or in files and read when a step needs them.
 * Private to the module.
 *
 * In: packed rows of points, and what the passes of TriangulateParts.h find. Out: a part as
 * SurfacePart, its own points alone, or whole.
 *
 * In memory a rank has at most one part, which is there all the time. In files nothing of a part is
 * in memory between the steps: what comes for it lies in its boxes (Engine.h), and is put together
 * anew whenever it is asked for. The boxes:
 *
 *   box        what is in it                          written by           read by
 *   OwnPoints  rows of points                         pass 1, lines, in    2, 6, for output
 *                                                     files
 *   Settled    unused points; then corners, as        pass 2, in files     6, for output
 *              indices among the own points
 *   OnSeam     indices of the seam's points, and      pass 2, lines, in    5
 *              their rows: others may ask for these   files
 *   FromSeams  in pass 3, the seam of the other half  the other half       3
 *              of a cell; then triangles, by numbers  pass 4               5, 6, for output
 *   Requests   the part that asks, and indices        pass 5               5, 6
 *   Corners    rows of points of other parts          pass 5               6, for output
 *   Meeting    of the first part: triangles that      lines                lines
 *              meet lines
 *   Changed    what has become of triangles that      lines                5, 6, for output
 *              meet lines
 *   Covered    indices with a triangle elsewhere      pass 6               6
 *
 * Cost: reading is linear; a part that is read takes twice the memory of its rows for a while.
 */
#ifndef PartStore_h
#define PartStore_h

#include "Engine.h"
#include "SharedLatticeSearch.h"
#include "SurfacePart.h"

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace elevation
{

/** The boxes of a part, as the table above lists them. Their order is that of BoxNames(). */
enum BoxOfPart
{
  OwnPoints,
  Settled,
  OnSeam,
  FromSeams,
  Corners,
  Changed,
  Requests,
  Meeting,
  Covered
};

/** What has become of a triangle of a part. */
struct ChangedTriangle
{
  std::size_t Triangle; ///< among those of the cell, followed by those from seams
  GlobalTriangle Corners;
};

/** Names of their files; those without one are small. */
const std::vector<std::string>& BoxNames();

/**
 * What there is of the parts of this rank between the passes of TriangulateParts.h. The calls, in
 * their order:
 *
 *     Number()                                     after pass 1 has filled OwnPoints, the box or,
 *                                                  in memory, those of Part
 *     AddOwn()                                     with lines, which Bases then count
 *     WithOwn(), KeepSettled()                     each part, pass 2; again without a lattice
 *     ForgetOthers(), ListOthersOf(),              pass 5, and once more when lines have changed
 *     ReadForOthers(), PackForOthers()             triangles
 *     WithWhole()                                  lines, pass 6
 *     TakeWhole(), Forget()                        for the output, in any order of parts
 */
class PartStore
{
public:
  explicit PartStore(Engine& engine)
    : Crew(engine)
  {
  }

  Engine& Crew;
  /**
   * In memory, that of this rank, maybe without points; in files, what all parts have in common.
   * The triangles in memory are those of the cell, or all of them after WithWhole().
   */
  SurfacePart Part;

  /**
   * Sets the numbers of the points of all parts: part after part, and within a part in the order of
   * ids. All ranks call it.
   *
   *     part        0         1      2
   *     points      4         0      3
   *     numbers     0 1 2 3          4 5 6
   *     Bases     { 0,        4,     4,     7 }
   *
   * @param[in] counts  of the points that this rank has sent to each part
   * @param[in] areIdsGiven  so that one may have come twice; such a point counts once
   */
  void Number(std::vector<vtkIdType>&& counts, bool areIdsGiven, const Progress& progress);

  /**
   * Adds packed points of lines, with ids from FirstLineId on; Part.Bases has to count them. As
   * these ids are above all others, the points follow those of the part in its order, and nobody's
   * number within the part changes.
   */
  void AddOwn(int part, Bytes&& rows);
  vtkIdType FirstLineId = std::numeric_limits<vtkIdType>::max(); ///< above all others

  GlobalId FirstOf(int part) const { return this->Part.Bases[part]; }
  GlobalId EndOf(int part) const { return this->Part.Bases[part + 1]; }
  /** The points that the parts of this rank own. */
  vtkIdType OwnCount() const
  {
    return this->Part.Bases[this->Crew.EndOwn()] - this->Part.Bases[this->Crew.FirstOwn()];
  }

  /**
   * No part may have more points than an Index counts. CheckCounts() looks at all parts, on all
   * ranks.
   * @throws Error naming more parts as the way out
   */
  void CheckCount(std::size_t count) const;
  void CheckCounts() const;

  /** Does a step with the points that a part owns. What the step changes stays only in memory. */
  template <typename Step>
  void WithOwn(int part, const Progress& progress, const Step& step)
  {
    if (!this->Crew.IsInFiles())
    {
      step(this->Part);
      return;
    }
    SurfacePart read = this->ReadOwn(part, progress);
    step(read);
  }

  /**
   * Keeps what the cell of a part settles, and the own points on its seam. Called again, it
   * replaces what an attempt on a lattice has left. @a settled loses its triangles in memory, and
   * keeps its seam.
   */
  void KeepSettled(int part, const SurfacePart& own, SettledCell& settled);

  /**
   * Keeps further own points for which other parts may ask. In memory it does nothing, as there any
   * own point can be asked for.
   */
  void KeepForOthers(int part, const SurfacePart& own, std::vector<vtkIdType>&& indices);

  /** What other parts may ask for; in memory, nothing is read. */
  struct RowsForOthers
  {
    PointTable OnSeam;             ///< from files
    std::vector<vtkIdType> Indices; ///< of these, increasing
  };
  RowsForOthers ReadForOthers(int part) const;
  /** Packs own points that another part asks for: in files, points on the seam. */
  Bytes PackForOthers(const RowsForOthers& rows, std::vector<vtkIdType>&& indices) const;

  /** The numbers of other parts' points that are corners of triangles from seams, or changed. */
  std::vector<GlobalId> ListOthersOf(int part) const;
  /**
   * Before they are asked for anew: a part is whole again when they are there. In memory this takes
   * back what WithWhole() has appended to the triangles; own rows and those of the cell stay.
   */
  void ForgetOthers(int part);

  /**
   * Does a step with a whole part: own points, triangles of its cell and of seams as lines have
   * changed them, and the corners that these have in other parts; without a limit of edges.
   */
  template <typename Step>
  void WithWhole(int part, const Progress& progress, const Step& step)
  {
    if (!this->Crew.IsInFiles())
    {
      this->MakeWhole(part, progress);
      step(static_cast<const SurfacePart&>(this->Part));
      return;
    }
    const SurfacePart read = this->ReadWhole(part, progress);
    step(read);
  }
  /** Removes what there is of a part. */
  void Forget(int part);
  /** The same part; from memory it can be taken once. */
  SurfacePart TakeWhole(int part, const Progress& progress);

  /**
   * Visits the points of this rank, part after part; from files, stretch after stretch. Each visit
   * of all of them is in the same order, on which the search for a lattice relies.
   */
  void ForEachRows(const std::function<void(const PointTable&)>& visit) const;
  PointSlices Slices() const;

private:
  /** The points of a part from its files, and what all parts have in common; no triangle. */
  SurfacePart ReadOwn(int part, const Progress& progress) const;
  /** The same with all triangles and points of others, each time from the files. */
  SurfacePart ReadWhole(int part, const Progress& progress) const;
  void MakeWhole(int part, const Progress& progress);
  void PutTogether(int part, const Progress& progress, SurfacePart& whole) const;

  std::size_t CellCorners = 0; // in memory, while IsWhole
  bool IsWhole = false;
};

} // namespace elevation

#endif
