// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points, predicates, memory, threads and progress: what every room of the kernel builds on.
 */
#ifndef elevation_Base_Base_h
#define elevation_Base_Base_h

#include "CellGrid.h"
#include "Duplicates.h"
#include "EdgeLimit.h"
#include "Extent.h"
#include "IdSet.h"
#include "Memory.h"
#include "Points.h"
#include "Predicates.h"
#include "Progress.h"
#include "SnapRounding.h"
#include "Threads.h"
#include "UnionFind.h"
#include "Work.h"

#endif
