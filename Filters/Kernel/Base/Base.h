// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points, predicates, memory, threads and progress: what every room of the kernel builds on.
 *
 *   Points, Predicates, SnapRounding   ids and places; exact signs; what rounding can move
 *   Duplicates, EdgeLimit              two rules that the user sets, on points and on edges
 *   Work, Progress, Threads            how much is done, who hears of it, who does it
 *   Extent, CellGrid                   the box of a cloud; which items touch a place
 *   IdSet, HashSieve, UnionFind        sets of ids, of hashes, disjoint sets
 *   MarkedCells, Memory                rectangles of marked cells, large arrays
 *
 * All but Predicates.cxx are headers: most of these functions run once for each point.
 */
#ifndef elevation_Base_Base_h
#define elevation_Base_Base_h

#include "CellGrid.h"
#include "Duplicates.h"
#include "EdgeLimit.h"
#include "Extent.h"
#include "HashSieve.h"
#include "IdSet.h"
#include "MarkedCells.h"
#include "Memory.h"
#include "Points.h"
#include "Predicates.h"
#include "Progress.h"
#include "SnapRounding.h"
#include "Threads.h"
#include "UnionFind.h"
#include "Work.h"

#endif
