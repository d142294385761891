// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The part that a rank has of a surface whose holes are filled. Private to the module.
 */
#ifndef FilledPart_h
#define FilledPart_h

#include "BorderOfRanks.h"
#include "Kernel/Fill/Fill.h"
#include "Kernel/Mesh/Mesh.h"
#include "KernelCall.h"
#include "Ranks.h"

#include "vtkSmartPointer.h"

#include <vector>

class vtkPolyData;

namespace elevation
{

struct FilledPart
{
  vtkPolyData* Input = nullptr;
  bool ByIds = false;        ///< whether points of ranks are one by their global ids, or by x,y,z
  Mesh Own;                  ///< of the input
  std::vector<char> AreUsed; ///< points that a triangle has
  SharedPoints Shared;
  BorderOfAll Border;

  std::vector<Index> Mine;            ///< holes that this rank fills, increasing
  vtkSmartPointer<vtkPolyData> Whole; ///< the triangles of all ranks around these
  std::vector<PointKey> Keys;         ///< of its points
  FillResult Patches;                 ///< of these holes, by the points of Whole

  std::vector<HoleReport> Reports;       ///< of all holes
  std::vector<vtkIdType> FirstNewPoints; ///< of each hole, and the number of all

  bool HasPoints() const;
};

/**
 * Writes the triangles of each rank with its patches, and the report of all on the first rank that
 * has outputs.
 * @param[in] patches  holes and reports of all ranks
 */
void WriteFilled(const Ranks& ranks, const FilledPart& part, bool interpolate,
  const FillResult& patches, Block& block);

} // namespace elevation

#endif
