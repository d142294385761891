// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Stands in for VTK's header of this name, as VTK configures it with VTK_ABI_NAMESPACE_NAME.
 */
#ifndef vtkABINamespace_h
#define vtkABINamespace_h

#define VTK_ABI_NAMESPACE_BEGIN inline namespace es_test_namespace {
#define VTK_ABI_NAMESPACE_END }

#endif
