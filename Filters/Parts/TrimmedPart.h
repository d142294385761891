// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Trims one part of a mesh along a boundary or its outline, whose near triangles are trimmed with
 * those of all parts: see TrimParts.h. Private to the module.
 *
 *     Swept.IsOutward, one a triangle:   0 kept, 1 outward, 2 near (until it comes back)
 *     Back.Parents[side][i]:             index in Swept.Near
 *     Back.Corners[side]:                below the number of NearPoints: one of these; else
 *                                        Indices[corner - that number], a point of the output
 */
#ifndef TrimmedPart_h
#define TrimmedPart_h

#include "Adapt/Adapt.h"
#include "BoundaryZone.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Trim/Trim.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace elevation
{

/** The functions are steps, in their order. */
class TrimmedPart
{
public:
  explicit TrimmedPart(vtkSmartPointer<vtkPolyData> part)
    : Input(std::move(part))
  {
  }

  /** Looks at the triangles but those that are marked as another part's. @throws Error */
  void Read();
  Index TriangleCount() const { return this->List.Count; }

  /**
   * Finds the near triangles, and the sides of the others.
   * @param[in] points       of the rings
   * @param[in] numberOfAll  triangles of all parts
   * @return false if the sweep cannot
   */
  bool Sweep(const std::vector<Point2>& points, const Rings& rings, double numberOfAll, int threads,
    const Progress& progress);
  /** The same without a boundary: the near triangles decide the outline. See FindOutlinePart() */
  bool SweepForOutline(int margin, const TrimOptions& options, const Progress& progress);
  std::int64_t InnerPointCount() const { return this->Outline.NumberOfInnerPoints; }
  vtkIdType NearCount() const { return static_cast<vtkIdType>(this->Swept.Near.size()); }
  vtkIdType SideCount(int side) const; ///< triangles that are not near: 0 kept, 1 outward
  Box Extent() const { return BoxOf(this->List); }

  /** The points of NearPart(), by which what comes back counts. */
  IdSet ListNearPoints();
  /** The near triangles and, as lines, the border of all: for BoundaryZone. */
  vtkSmartPointer<vtkPolyData> NearPart();

  /** Takes what has become of the near triangles. */
  void Take(TrimmedZone&& back, const Progress& progress);

  /**
   * Writes the sides to outputs 0 and 1; nullptr: not wanted.
   * @param[in] areInserted, areMarked  whether any part has inserted points, or another part's
   * @param[in] boundary  nullptr: none was given
   */
  void Write(bool areInserted, bool areMarked, const BoundaryLines* boundary,
    const TrimOptions& options, const Progress& progress, vtkPolyData* kept, vtkPolyData* outward);

private:
  void LeaveOutCopies();
  /** Of Take(): the indices of the points that have come. */
  void FindOwn(const Progress& progress);
  /** All triangles of a side: 0 kept, 1 outward. */
  TrimmedSide SideOf(int side, const Progress& progress) const;

  const vtkSmartPointer<vtkPolyData> Input;
  DataSetTriangles Triangles;
  std::vector<Index> Sources; // of the triangles, if some were left out
  TriangleList List;
  SweptAlongRings Swept;
  OutlinePart Outline;     // without a boundary; its triangles and border are those of Swept
  std::vector<Index> NearPoints; // of the near part, by their indices in the input
  TrimmedZone Back;
  std::vector<Index> Indices;       // of the new points, among those of the output
  std::vector<Index> FarOnBoundary; // own points
  TrimmedPoints Points;
};

} // namespace elevation

#endif
