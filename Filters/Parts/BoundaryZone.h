// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangles of all parts of a surface near a boundary, trimmed together. Private to the module.
 *
 *     part 0: near triangles, border --\                       /--> TrimmedZone of part 0
 *     part 1: near triangles, border ----> joined, trimmed ---+---> TrimmedZone of part 1
 *     part 2: ...                    --/                       \--> ...
 *
 * All of this happens on one rank. A point has three numbers here: its place in a near part, that
 * in the joined parts (CommonPoints::JoinedPoint), and, if trimming has inserted it, one after all
 * joined ones.
 *
 * Cost: n log n in the near triangles and the borders of all parts, which are in memory at once.
 */
#ifndef BoundaryZone_h
#define BoundaryZone_h

#include "Adapt/Adapt.h"
#include "Bytes.h"
#include "CommonPoints.h"
#include "Kernel/Trim/Trim.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace elevation
{

/**
 * What of the near triangles goes back to the part that had them. Triangles and points have their
 * numbers in the near part; what a part keeps inside or outside without asking is not here.
 */
struct TrimmedZone
{
  /** The sides, kept and outward: near triangles of the rank (by number) that they are parts of. */
  std::vector<Index> Parents[2];
  /**
   * Three a triangle: points of the rank's near part, followed by the new points. None where a mesh
   * is trimmed along its outline: triangles stay as they are.
   */
  std::vector<Index> Corners[2];
  std::vector<char> IsInserted; ///< one a new point; else it is another rank's
  std::vector<char> IsOwned;    ///< one a new point
  std::vector<Index> OfOthers;  ///< points of the rank's near part that another rank owns
  bool AreNumbered = true;      ///< new points of all parts, if points have global ids
  /** Points on a boundary that was given: of the near part, followed by the new points. */
  std::vector<Index> OnBoundary;
  /** The same of points whose triangles are all other parts': the part that owns one finds it. */
  std::vector<PointKey> FarOnBoundary;
  vtkSmartPointer<vtkPolyData> NewPoints; ///< nullptr: there is none
};

/** As it goes back. */
template <>
struct FieldsOf<TrimmedZone>
{
  template <typename Zone>
  static auto In(Zone& zone)
  {
    return std::tie(zone.Parents[0], zone.Corners[0], zone.Parents[1], zone.Corners[1],
      zone.IsInserted, zone.IsOwned, zone.OfOthers, zone.AreNumbered, zone.OnBoundary,
      zone.FarOnBoundary, zone.NewPoints);
  }
};

/**
 * The near parts of ranks, in their order. Each has points, near triangles as polygons, and the
 * border of all triangles of the rank as lines.
 */
class BoundaryZone
{
public:
  explicit BoundaryZone(Parts&& parts)
    : GivenParts(std::move(parts))
  {
  }

  /**
   * Joins and trims the parts.
   * @return false if the parts are not proven to be those of one mesh that covers nothing twice
   * @throws Error, Aborted
   */
  bool Trim(const BoundaryLines& boundary, const TrimOptions& options);

  /**
   * The same along the outline, for the triangles of FindOutlinePart(). Their states and the
   * spacings at the points are in the field data of each part: see AddKnown().
   * @param[in] innerPoints  the sum of all parts
   * @param[in] triangles    of the mesh
   */
  bool TrimOutline(std::int64_t innerPoints, std::int64_t triangles, const TrimOptions& options);
  static void AddKnown(const std::vector<TriangleState>& states,
    const std::vector<double>& spacings, vtkPolyData* part);

  /** What goes back to each part, in the order of the parts given. */
  std::vector<TrimmedZone> Split(const Progress& progress) const;

  const Trimmed& Result() const { return this->Sides; }
  vtkPolyData* Joined() const { return this->JoinedParts; }

private:
  /**
   * Whether the near triangles may be trimmed as parts of one mesh; then Border is that of the
   * mesh.
   */
  bool IsProven(const TriangleList& list, const BoundaryLines& boundary, const Progress& progress);
  void JoinAll(const Progress& progress);
  /** Whether each point is where the joined one is, which has one place for all parts. */
  bool AreSamePlaces() const;
  std::optional<std::vector<BorderEdge>> ProvenBorder(
    const PointView& points, const Progress& progress) const;
  /** The border edges of all parts, by joined points. */
  std::vector<BorderEdge> PartBorders() const;
  std::vector<Index> FindOwners(std::vector<TrimmedZone>& splits) const;
  void PlaceCorners(std::size_t part, std::vector<Index>& places, std::vector<char>& areOwned,
    TrimmedZone& split) const;

  const Parts GivenParts;
  std::vector<Index> FirstTriangles; // of each part, and the number of all
  std::unique_ptr<CommonPoints> Common;
  vtkSmartPointer<vtkPolyData> JoinedParts;
  DataSetTriangles Triangles;     // of the whole
  vtkNew<vtkPolyData> Points;     // of the whole, and those inserted
  std::vector<BorderEdge> Border; // of the mesh, if a boundary is given
  Trimmed Sides;
  bool IsOutline = false;
};

} // namespace elevation

#endif
