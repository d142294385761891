// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Brings the parts of a data set from all ranks to one of them. Private to the module.
 *
 * The alternative to Spread in FilterRun, and how lines reach all ranks. It needs memory for the
 * whole data set on one rank.
 */
#ifndef Gathering_h
#define Gathering_h

#include "Adapt/Adapt.h"
#include "Joining.h"
#include "Kernel/Messages/Messages.h"

#include <string>

namespace elevation
{
class Ranks;

/**
 * Gathers and joins the parts of a data set: see Join(). All ranks have to call it.
 *
 * Data are only sent when all ranks have agreed that the parts are valid and that the first of them
 * has the memory, so that none waits for another that has failed.
 *
 * @param[in] parts  those of this rank, all with points; there may be none
 * @param[in] kind   Points: cells are not sent
 * @param[in] home   the rank that gets the result
 * @param[out] warnings of Join(), on that rank
 * @return nullptr on other ranks
 * @throws Error on all ranks, which names the rank with the invalid part
 * @throws Aborted on all ranks
 */
vtkSmartPointer<vtkPolyData> Gather(const std::vector<vtkPointSet*>& parts, PartKind kind, int home,
  const Ranks& ranks, const Progress& progress, std::vector<Message>& warnings);

/** Joins parts that are on this rank; one part is returned itself. @throws Error as Gather() */
vtkSmartPointer<vtkPointSet> JoinHere(
  const std::vector<vtkPointSet*>& parts, PartKind kind, std::vector<Message>& warnings);

/**
 * The lines of all ranks, on all of them; all have to call it.
 * @param[in] own   those of this rank, a composite of them, or nullptr
 * @param[in] name  what messages call them
 * @return nullptr if no rank has any
 * @throws Error on all ranks, as JoinBlocks() and Ranks::Gather()
 */
vtkSmartPointer<vtkPolyData> ShareLines(
  vtkDataObject* own, const std::string& name, const Ranks& ranks);

/** The same data set without points and cells, its arrays without values. */
vtkSmartPointer<vtkPolyData> EmptyCopy(vtkPointSet* input);

} // namespace elevation

#endif
