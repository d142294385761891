// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangulation of points cell by cell of the plane, and of the seams between the cells.
 *
 * Where to begin: Pieces.h, why pieces triangulated apart can be joined; then Cuts.h, which pieces.
 */
#ifndef elevation_Cells_Cells_h
#define elevation_Cells_Cells_h

#include "Cuts.h"
#include "Pieces.h"

#endif
