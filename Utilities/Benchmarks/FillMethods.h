// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Holes filled by vtkFillElevationHoles and by what else there is.
 */
#ifndef FillMethods_h
#define FillMethods_h

#include "FillCutting.h"
#include "FillErrors.h"

namespace benchmark
{

/** @param interpolation  below 0: the linear patch, without new points */
Filled FillWithUs(const Hole& hole, int interpolation);

/** vtkFillHolesFilter up to a size that leaves the outer border open. */
Filled FillWithVTK(const Hole& hole, double size);

#ifdef ES_BENCHMARK_CGAL
Filled FillByCGAL(const Hole& hole, double left, double right, double low, double high);
#endif

} // namespace benchmark

#endif
