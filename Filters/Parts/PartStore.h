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
 * In memory a rank has at most one part, which is there all the time. In files nothing of a part is in
 * memory between the steps: what comes for it lies in its boxes (Engine.h), and is put together anew
 * whenever it is asked for. The boxes:
 *
 *   box        what is in it                          written by           read by
 *   OwnPoints  rows of points                         pass 1               2, 6, for output
 *   Settled    unused points; then corners, as        pass 2, in files     6, for output
 *              places among the own points
 *   OnSeam     places of the seam's points, and       pass 2, in files     5
 *              their rows: others may ask for these
 *   FromSeams  in pass 3, the seam of the other half  the other half       3
 *              of a cell; then triangles, by numbers  pass 4               5, 6, for output
 *   Requests   the part that asks, and places         pass 5               5, 6
 *   Corners    rows of points of other parts          pass 5               6, for output
 *   Covered    places with a triangle elsewhere       pass 6               6
 *
 * Cost: reading is linear; a part that is read takes twice the memory of its rows for a while.
 */
#ifndef PartStore_h
#define PartStore_h

#include "Engine.h"
#include "LatticeOfRanks.h"
#include "SurfacePart.h"

#include <cstddef>
#include <string>
#include <vector>

namespace elevation
{

/** The boxes of a part. */
enum BoxOfPart
{
  OwnPoints,
  Settled,
  OnSeam,
  FromSeams,
  Corners,
  Requests,
  Covered
};

/** Names of their files; those without one are small. */
const std::vector<std::string>& NamesOfBoxes();

class PartStore
{
public:
  explicit PartStore(Engine& engine)
    : Crew(engine)
  {
  }

  Engine& Crew;
  /** In memory, that of this rank, maybe without points; in files, what all parts have in common. */
  SurfacePart Part;

  /**
   * Sets the numbers of the points of all parts: part after part, and within a part in the order of
   * ids. All ranks call it.
   * @param[in] counts  of the points that this rank has sent to each part
   */
  void Number(std::vector<vtkIdType>&& counts, const Progress& progress);

  GlobalId FirstOf(int part) const { return this->Part.Bases[part]; }
  GlobalId EndOf(int part) const { return this->Part.Bases[part + 1]; }
  /** The points that the parts of this rank own. */
  vtkIdType CountOfOwn() const
  {
    return this->Part.Bases[this->Crew.EndOwn()] - this->Part.Bases[this->Crew.FirstOwn()];
  }

  /** No part may have more points than an Index counts. @throws Error */
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

  /** Keeps what the cell of a part settles, and the own points on its seam. */
  void KeepSettled(int part, const SurfacePart& own, SettledCell& settled);

  /** What other parts may ask for; in memory, nothing is read. */
  struct RowsForOthers
  {
    PointRows OnSeam;              ///< from files
    std::vector<vtkIdType> Places; ///< of these, increasing
  };
  RowsForOthers ReadForOthers(int part) const;
  /** Packs own points that another part asks for: in files, points on the seam. */
  Bytes PackForOthers(const RowsForOthers& rows, std::vector<vtkIdType>&& places) const;

  /**
   * A whole part, from files: own points, triangles of its cell and of seams, and the corners that
   * these have in other parts; without a limit of edges.
   */
  SurfacePart ReadWhole(int part, const Progress& progress) const;

  /** The points of this rank, part after part, without holding more than a stretch from files. */
  PointSlices Slices() const;

private:
  SurfacePart ReadOwn(int part, const Progress& progress) const;
};

} // namespace elevation

#endif
