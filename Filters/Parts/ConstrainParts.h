// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Lines that become edges of a surface in parts (Engine.h). Private to the module.
 *
 * In: parts with their points, and all lines on all ranks. Out: parts with the points that lines
 * add, and, when all is triangulated, what becomes of triangles that lines cross.
 *
 * The steps, around passes 2 to 5 of TriangulateParts.h:
 *   1. Each part lists its points that are on lines, or nearly so. All ranks get these, and cut the
 *      lines by them, all alike. So all know the points that the lines add, and each part gets
 *      those of its cell.
 *   2. Each part lists the pieces of the lines that are edges of its triangles.
 *   3. The triangles that meet a piece that is not an edge yet go to part 0, which recovers
 *      these pieces together. Parts get the changed triangles back, and whenever they are read use
 *      them in place of the old ones. Other parts can ask for the corners that they now have.
 *
 *     step 1          lines cut at points near them, on each rank alike
 *     passes 2 to 5   triangles of all points, without the lines
 *     steps 2, 3      pieces that are no edges become edges
 *
 * Why the points near lines are enough for step 1: other points are on no piece, and where lines
 * cross, they are joined only at vertices so near, or at a new one (CutLines.h, NearLines.h). Why
 * the triangles that meet missing pieces are enough for step 3: recovery replaces crossed triangles
 * alone, and its result is unique (RecoverSegments.h), so it is that of the whole mesh.
 *
 * Cost: a part in files is read once in step 1, once in step 2, and once more in step 3 if its box
 * meets that of a missing piece. In memory are the lines and their pieces, the points near them,
 * and in step 3 the triangles that missing pieces meet.
 */
#ifndef ConstrainParts_h
#define ConstrainParts_h

#include "Adapt/Adapt.h"
#include "Kernel/Cells/Cells.h"
#include "Kernel/Messages/Messages.h"
#include "PartStore.h"

#include <array>
#include <cstdint>
#include <vector>

namespace elevation
{

/** The lines as all ranks know them. */
struct SharedLines
{
  std::vector<std::array<GlobalId, 2>> Pieces; ///< numbers of their ends, the lower first
  std::vector<Ends> Places;                    ///< of the ends
  std::int64_t NumberOfCrossings = 0;
};

/**
 * Step 1, on all ranks.
 * @param[in] source  the same on all ranks
 * @param[in,out] store  its parts get more points, with ids after the largest. They follow those of
 *                       their part, so all numbers of later parts move up
 * @param[in] plane  says which part owns a place
 * @param[out] warnings  as of CheckLines()
 * @throws Error on all ranks, as on one; Aborted
 */
SharedLines AddLines(PartStore& store, vtkPolyData* source, const Cuts& plane,
  const DelaunayOptions& options, const Progress& progress, std::vector<Message>& warnings);

/**
 * Steps 2 and 3, on all ranks.
 * @return whether triangles have changed; then points of other parts have to be asked for anew
 */
bool RecoverLines(PartStore& store, const SharedLines& lines, const Progress& progress);

} // namespace elevation

#endif
