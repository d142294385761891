// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The type of coordinates: OutputPointsPrecision of the filters. Private to the module.
 *
 * It follows from the inputs' types and the properties, never from the values. Work that adds
 * points on given lines is done in double precision, as rounding would move them off the lines; so
 * the inputs are converted before it, and outputs in single precision are rounded after it.
 */
#ifndef PointsPrecision_h
#define PointsPrecision_h

#include "VTKClasses.h"

#include "vtkSmartPointer.h"

#include <vector>

namespace elevation
{

/** @throws Error if it is not a vtkAlgorithm::DesiredOutputPrecision */
void CheckPrecision(int precision);

/**
 * Whether the work is done in double precision whatever the type of the points: where it is asked
 * for, or there are lines.
 */
bool NeedsDouble(int precision, bool hasLines);

/**
 * A data set whose points are double; itself where they are so already, or where they are float
 * and may stay so.
 */
vtkSmartPointer<vtkPointSet> WithPointsFor(bool needsDouble, vtkPointSet* input);

/**
 * Rounds the points of the outputs to float; those that share points go on sharing them.
 * @throws Error naming the first triangle that would turn over or lose its area in x,y
 */
void RoundPoints(const std::vector<vtkPolyData*>& outputs);

} // namespace elevation

#endif
