// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The namespace of VTK's binary interface, VTK_ABI_NAMESPACE_BEGIN and _END, which VTK 9.1 does not
 * have.
 */
#ifndef vtkElevationSurfaceABI_h
#define vtkElevationSurfaceABI_h

#include "vtkType.h"

#ifndef VTK_ABI_NAMESPACE_BEGIN
#define VTK_ABI_NAMESPACE_BEGIN
#define VTK_ABI_NAMESPACE_END
#endif

#endif
