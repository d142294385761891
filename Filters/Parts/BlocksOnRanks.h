// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The blocks of the input that have points on several ranks. Private to the module.
 *
 * A block is known on all ranks by its path in the composite (Leaf::Path). Ranks may have
 * different trees; those that lack a block just have no leaf for it.
 */
#ifndef BlocksOnRanks_h
#define BlocksOnRanks_h

#include "Gathering.h"
#include "Kernel/Messages/Messages.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace elevation
{
struct Leaf;

bool HasPoints(const Leaf& leaf);

/**
 * All ranks have to call it.
 * @param[out] occupied  the paths of the blocks that have points, on any rank
 * @return the blocks that have points on several ranks, and the rank with most of each
 */
std::map<std::string, int> FindSpread(
  const std::vector<Leaf>& leaves, const Ranks& ranks, std::set<std::string>& occupied);

/** Of the leaves of a block on this rank: the parts with points. */
std::vector<vtkPointSet*> PartsOf(const std::vector<Leaf*>& leaves);

/** The first leaf with points; nullptr if none has. */
Leaf* FirstWithPoints(const std::vector<Leaf*>& leaves);

/** Takes all points out of the leaves. */
void Empty(const std::vector<Leaf*>& leaves);

/**
 * Gathers a block: the first leaf with points on the rank @a home has it then, all others have no
 * points. All ranks have to call it. @throws as Gather()
 */
void GatherBlock(const std::vector<Leaf*>& leaves, int home, PartKind kind, const Ranks& ranks,
  const Progress& progress, std::vector<Message>& warnings);

} // namespace elevation

#endif
