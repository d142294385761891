// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Data sets on their way to another rank. Private to the module.
 */
#ifndef PackedData_h
#define PackedData_h

#include "Adapt/Adapt.h"
#include "Bytes.h"

#include "vtkSmartPointer.h"

#include <cstddef>

namespace elevation
{

/**
 * A data set as bytes, and back, by VTK's communicator. What that changes stays: the order of
 * arrays with names, their types, all their attributes, and the 64 bits of a vtkIdType. Arrays
 * without values come last, and arrays without a name go as VTK takes them.
 *
 *     | size of the marks | marks of the arrays | what VTK makes of points, cells and arrays |
 *
 * Also for files: parts near a hole, and patches, wait in boxes like this.
 * @throws Error
 */
Bytes PackData(vtkPolyData* data);
vtkSmartPointer<vtkPolyData> UnpackData(const char* from, std::size_t size);

} // namespace elevation

#endif
