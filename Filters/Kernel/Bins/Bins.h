// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Options and result of a triangulation, the points in bins, and their convex hull.
 *
 * Where to begin: BinGrid.h, whose slots all of growth counts in; then BoxTree.h, the tree over
 * them. GridBlock.h and RowSorter.h fill both. Options.h has what a triangulation is asked for, and
 * its result; Hull.h, WorkBudget.h and Instructions.h serve growth. Vectors.h is included by
 * the source files that use it.
 */
#ifndef elevation_Bins_Bins_h
#define elevation_Bins_Bins_h

#include "BinGrid.h"
#include "BoxTree.h"
#include "Hull.h"
#include "Instructions.h"
#include "Options.h"
#include "WorkBudget.h"

#endif
