// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Surfaces in parts, on ranks or in files. Private to the module.
 *
 * What stands on what, from above:
 *
 *     the three filters                                  vtkReconstructPieces (files)
 *       FilterRun: the blocks of an input                  ReconstructParts: slices in, parts out
 *         BlocksOnRanks, Gathering: to one rank
 *         Spread: or where they are
 *
 *     TriangulateParts          TrimParts                FillParts
 *       PointDistributor               TrimmedPart              FilledPart
 *       SettleParts               BoundaryZone             SharedHoles, HoleNeighborhoods
 *       ConstrainParts                                     SharedBorder
 *       PartStore, SurfacePart
 *
 *     SurfaceParts: how a step gets the parts of the step before
 *     SharedLatticeSearch: one lattice for all parts
 *     Joining, CommonPoints, PointKeys: which points of parts are one
 *     Engine: a program for parts;  SpoolFile: its boxes in files
 *     Ranks: what all ranks do together;  RankSignals: what one says to the others meanwhile
 *     PointTable, PackedData, Bytes: what is sent
 *
 * FilterRun and ReconstructParts decide where a surface is worked on; the programs for parts below
 * them do not know whether ranks or files hold the parts.
 */
#ifndef Parts_h
#define Parts_h

#include "FillParts.h"
#include "FilterRun.h"
#include "Joining.h"
#include "PointTable.h"
#include "Ranks.h"
#include "ReconstructParts.h"
#include "TriangulateParts.h"
#include "TrimParts.h"

#endif
