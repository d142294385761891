// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Joins the parts of a data set that was spread over ranks. Private to the module.
 *
 * Cost: linear, apart from CommonPoints.h; each value is copied once.
 *
 * Gathering joins what has come from all ranks; BoundaryZone and SharedHoles join near parts, whose
 * arrays are the same.
 */
#ifndef Joining_h
#define Joining_h

#include "CommonPoints.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"

#include "vtkSmartPointer.h"

#include <set>
#include <string>
#include <vector>

namespace elevation
{

/**
 * The points, cells, arrays and field data of all parts.
 *
 * Where all parts have global ids, points of the same id are the same, and are in the order of
 * their ids. Else they are in the order of the parts; those of a mesh are the same where x,y,z are,
 * the first at a place in one part with the first in another, and so on. A point that is marked as
 * another rank's (DUPLICATEPOINT) is left out where the other rank's copy is there. Cells marked as
 * another rank's (DUPLICATECELL) are left out.
 *
 * Field data are those of the first part that has them; UnusedPointIds and UnusedPointReasons are
 * of all parts, with the ids of the joined points.
 *
 * @param[in] parts     each has points; their arrays have the right length, their cells points that
 *                      exist; no triangle strips
 * @param[in] points    theirs, by the same kind
 * @param[out] warnings one is added where arrays are left out, because not all parts have them
 */
vtkSmartPointer<vtkPolyData> Join(const Parts& parts, PartKind kind, const CommonPoints& points,
  const Progress& progress, std::vector<Message>& warnings);
/** The same, which finds common points first. */
vtkSmartPointer<vtkPolyData> Join(
  const Parts& parts, PartKind kind, const Progress& progress, std::vector<Message>& warnings);

/** Adds a warning of arrays that are left out, if any. @param[in] kind  "point", say */
void WarnOfLeftOut(
  const std::string& kind, const std::set<std::string>& left, std::vector<Message>& warnings);

} // namespace elevation

#endif
