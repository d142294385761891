// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Options and result of a triangulation, the points in bins, and their convex hull.
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
