// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * VTK's data as the kernel reads and writes them, in one process. Private to the module.
 *
 * In: VTK's data sets and the properties of a filter. Out: arrays that the kernel reads in place
 * where it can (ViewPoints, ViewTriangles), and data sets made of its results. By filter:
 *
 *     vtkGridDelaunay2D         Constraints, SoftLines, DelaunayReport, LimitAdvice, PointsOnWall
 *     vtkTrimOutwardTriangles   TrimmedSurface, which also drapes constraints
 *     vtkFillElevationHoles     PatchedSurface
 *     the Python package        SurfaceQuery
 *     all filters               the rest
 */
#ifndef Adapt_h
#define Adapt_h

#include "ArrayChecks.h"
#include "Blocks.h"
#include "Constraints.h"
#include "DataArrays.h"
#include "DelaunayReport.h"
#include "HiddenCells.h"
#include "LimitAdvice.h"
#include "MeshConversion.h"
#include "PatchedSurface.h"
#include "PointsOnWall.h"
#include "PointsPrecision.h"
#include "ReportMessages.h"
#include "Requests.h"
#include "SoftLines.h"
#include "SurfaceQuery.h"
#include "TrimmedSurface.h"
#include "UsedPoints.h"
#include "VTKVersions.h"

#endif
