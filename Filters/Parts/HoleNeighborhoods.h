// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Which triangles of a surface a hole needs to be filled, and on which rank. Private to the module.
 *
 * SharedHoles asks for extents and boxes, FillParts for ranks and triangles. All of it is by the
 * holes and the mesh alone: no rank is asked here.
 */
#ifndef HoleNeighborhoods_h
#define HoleNeighborhoods_h

#include "Adapt/Adapt.h"
#include "Kernel/Mesh/Mesh.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <vector>

namespace elevation
{

/** How large a hole is: what is known of it on all ranks, before anybody has its surroundings. */
struct HoleExtent
{
  Box OfRim;
  double MeanEdge; ///< length, of rim and islands
  Index NumberOfEdges;
};

std::vector<HoleExtent> ExtentsOf(const Holes& holes, const PointView& points);

/**
 * The rank of each hole: the largest first, to the one with least work. So no rank has more than a
 * third above the best that is possible [Graham 1969], as far as the work is known. The same on all
 * ranks.
 * @param[in] can  one a rank; 0: it gets no hole
 *
 * [Graham 1969] Bounds on multiprocessing timing anomalies.
 */
std::vector<int> BalancedRanks(
  const std::vector<HoleExtent>& holes, const std::vector<vtkIdType>& can);

/**
 * Where a hole knows all triangles: those that its trials beside it need nearly always. Each time
 * that they were too few the box is wider by four times, and in the end everywhere.
 * @param[in] reach  how far beyond the rim it reaches at least
 */
Box BoxAround(const HoleExtent& hole, int retries, double reach);

/** The triangles, increasing, that meet one of the boxes, and some nearby. Linear. */
std::vector<Index> TrianglesIn(const std::vector<Box>& boxes, const Mesh& mesh);

/** The chosen triangles with their points and the data of these. */
vtkSmartPointer<vtkPolyData> ChosenTriangles(
  vtkPolyData* source, const Mesh& mesh, const std::vector<Index>& chosen);

} // namespace elevation

#endif
