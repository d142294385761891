// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A part of a surface whose holes are filled (FillParts.h): what is read of it, and how it is
 * written. Private to the module.
 *
 * A point is known by three numbers: its index in the input; its index in the surrounding of the
 * holes whose patches the part gets, with Filled.Keys; and the index in the output that IndexOf
 * gives it:
 *
 *     input's points | Added: corners of others | new points of patches     the output's points
 */
#ifndef FilledPart_h
#define FilledPart_h

#include "Adapt/Adapt.h"
#include "Kernel/Mesh/Mesh.h"
#include "SharedHoles.h"

#include "vtkSmartPointer.h"

#include <vector>

namespace elevation
{

/**
 * One part from Read() to Write(). In memory it stays in between; in files it is read again for
 * Write(), and is the same then, as all of Read() depends on the input alone.
 */
struct FilledPart
{
  int Number = 0;
  vtkSmartPointer<vtkPolyData> Input; ///< nullptr: it has no points
  Mesh OwnMesh;                       ///< of the input
  std::vector<Index> RegionOf;        ///< of its triangles, from NumberRegions()
  std::vector<char> AreUsed;          ///< points that a triangle has
  SharedPoints Shared;
  SurroundedHoles Filled; ///< holes whose patches this part gets

  /**
   * Reads the triangles, finds regions of long ones, and lists the points that other parts may
   * have.
   * @param[in] longest  edge of a triangle that is not long; 0: none is
   * @throws Error, as SharedPoints::Sort(); Aborted
   */
  void Read(bool byIds, double longest, const Progress& progress);

  /** The points that no other part counts. @param[out] kept  holds them */
  PointView OwnPoints(Buffer<double>& kept) const;
  vtkIdType OwnCount() const; ///< of these

  /** Corners of the patches that the part does not have; then IndexOf is known. */
  void FindCorners();
  std::vector<Index> Added;   ///< corners, points of the surrounding of the holes
  std::vector<Index> IndexOf; ///< of points of the surrounding, after the input's points
  /** How many points are other parts' in the output, as far as it is not marked in the input. */
  vtkIdType OtherCount() const;

  /**
   * Writes the triangles and the patches.
   * @param[in] areMarked  whether any part has others' points
   * @param[in] largestId  of all parts; ids of new points follow it
   */
  void Write(const SharedHoles& all, bool areMarked, vtkIdType largestId, const Progress& progress,
    vtkPolyData* output) const;

  /** The points on the border of the triangles, and of regions, with their data; nullptr: none. */
  vtkSmartPointer<vtkPolyData> PointsOnBorder() const;

private:
  bool IsRegionAt(Index h) const { return this->RegionOf[Mesh::Triangle(h)] != None; }
  bool IsRim(Index h) const;
  void ListShared(bool byIds);
  std::vector<char> AreOthers() const;
  vtkSmartPointer<vtkPolyData> WithCorners(bool areMarked, const Progress& progress) const;
  FillResult PlacedPatches(const SharedHoles& all, vtkPolyData* input) const;
  void PlaceAttributes(vtkPolyData* input, FillResult& placed) const;
  void NumberNewPoints(const SharedHoles& all, vtkIdType largest, vtkPointData* output) const;
};

/** Output 1 of the filter. @param[in] points  of the border of all parts; a point may come again */
void WriteRims(
  const SharedHoles& all, const Parts& points, const Progress& progress, vtkPolyData* output);

} // namespace elevation

#endif
