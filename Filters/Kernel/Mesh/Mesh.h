// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangle mesh, and queries and operations that do not depend on where it comes from.
 *
 * Where to begin: HalfEdgeMesh.h draws the numbering that all others use. TriangleList.h and
 * TriangleSweep.h work on triangles before there is a mesh, Holes.h and LongTriangles.h find what
 * the surface lacks, VertexStars.h, RecoverSegments.h and Segments.h make lines its edges,
 * Validate.h tests it.
 */
#ifndef elevation_Mesh_Mesh_h
#define elevation_Mesh_Mesh_h

#include "HalfEdgeMesh.h"
#include "Holes.h"
#include "LongTriangles.h"
#include "RecoverSegments.h"
#include "Segments.h"
#include "TriangleList.h"
#include "TriangleSweep.h"
#include "Validate.h"
#include "VertexStars.h"

#endif
