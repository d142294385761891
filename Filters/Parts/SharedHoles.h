// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The holes of a surface in parts, on ranks or in pieces. Private to the module.
 *
 * SharedHoles is what all ranks know: the holes, by points of the border. SurroundedHoles is what
 * one rank has to fill some of them: the triangles around them, joined from all parts, and holes by
 * points of these. Keys lead from the one to the other.
 *
 *     SharedHoles: border points 0 ... b - 1    -- keys -->    SurroundedHoles: points 0 ... s - 1
 *     SurroundedHoles                           -- keys -->    FilledPart: points of a part
 */
#ifndef SharedHoles_h
#define SharedHoles_h

#include "CommonPoints.h"
#include "HoleNeighborhoods.h"
#include "Kernel/Fill/Fill.h"
#include "SharedBorder.h"
#include "SharedLatticeSearch.h"

#include "vtkSmartPointer.h"

#include <tuple>
#include <vector>

namespace elevation
{

/**
 * As it goes to other ranks. The structured binding names all members: with one more in the report,
 * this does not compile until it is sent, too.
 */
template <>
struct FieldsOf<HoleReport>
{
  template <typename Report>
  static auto In(Report& report)
  {
    auto& [status, edges, size, perimeter, area, spacing, inserted, method, outgrowth, drawn, water,
      misties, more, reason] = report;
    return std::tie(status, edges, size, perimeter, area, spacing, inserted, method, outgrowth,
      drawn.Count, drawn.Most, water.Height, water.RimAbove, water.RimBelow, water.Given.Height,
      water.Given.Without, misties, more, reason);
  }
};

/**
 * What is known of all holes, wherever they are filled: the same on all ranks, apart from reports
 * and room of holes while they are being filled, which FillParts shares afterwards.
 */
struct SharedHoles
{
  FillOptions Options; ///< without what is of a part
  bool Interpolate = true;
  bool ByIds = false; ///< whether points of parts are one by their global ids, or by x,y,z
  double LongestEdge = 0.0; ///< of triangles that are not long; 0: none is long
  SharedBorder Border;
  FillResult Result; ///< the holes, by points of the border, and reports; no patches
  std::vector<HoleExtent> Extents;
  std::vector<int> Retries;        ///< for each hole: how often it needed triangles beyond its box
  std::vector<double> Reach;       ///< how far beyond its rim it needs all triangles at least
  std::vector<vtkIdType> HaveRoom; ///< 0 for regions without; see DropRegionsWithoutRoom()
  Index FirstRegion = 0;           ///< its number as a hole
  LatticeSearch Lattice;
  std::vector<double> Quotas;
  ElevationRange Elevations;             ///< of all triangles
  std::vector<vtkIdType> FirstNewPoints; ///< of each hole, and the number of all

  /** Finds and measures the holes of the border. @return false if borders touch */
  bool Find(const Progress& progress);
  /** Whether the limits of size and edges admit a hole. */
  bool IsToBeFilled(std::size_t hole) const
  {
    return this->Result.Reports[hole].Status == FillStatus::Filled;
  }
  Box BoxOf(Index hole) const
  {
    return BoxAround(this->Extents[hole], this->Retries[hole], this->Reach[hole]);
  }
  /**
   * Whether anybody asks for the lattice of the surface's points. It takes two readings of all
   * parts.
   */
  bool NeedLattice() const;
  /** @param[in] points  of all parts, each once */
  void FindLattice(const Ranks& ranks, const PointSlices& points, const Progress& progress);
  /** When all is filled: these are not holes any more, and later ones get lower numbers. */
  void DropRegionsWithoutRoom();
  std::vector<Index> NewNumbers;                ///< then, of the holes before, or None
  Index NumberOf(int part, Index region) const; ///< then, of a region of a part
  /** Sets FirstNewPoints by the reports: global ids of new points follow the order of the holes. */
  void NumberNewPoints();
};

/** Some of the holes, increasing, and the triangles of all parts around them. */
struct SurroundedHoles
{
  std::vector<Index> Numbers;
  vtkSmartPointer<vtkPolyData> Surrounding; ///< nullptr: none
  std::vector<PointKey> Keys;               ///< of its points
  FillResult Patches;                       ///< by its points

  /** Joins what parts have around the holes. */
  void Surround(const Parts& parts, const SharedHoles& all, const Progress& progress);
  /** What the holes may take of MaximumInsertedPoints, in the order of Numbers. */
  std::vector<HoleNeed> Needs(const SharedHoles& all, const Progress& progress) const;
  /**
   * Takes regions without room out of Numbers. @return the holes that need more than their boxes
   */
  std::vector<Index> Fill(const SharedHoles& all, const Progress& progress);
  /** Keeps only those points of the surrounding that patches have. */
  void KeepCorners();

  SurroundedHoles() = default;
  /** Several groups in one, by the order of their first holes; without triangles around them. */
  explicit SurroundedHoles(std::vector<SurroundedHoles>&& groups);

private:
  void ListRegions(Index first, Holes& holes) const;
  Holes Listed(const SharedHoles& all) const;
  FillOptions OptionsFor(const SharedHoles& all, const Progress& progress) const;
  WholeSurface KnownOf(const SharedHoles& all) const;

  Mesh Near;     // the triangles, without long ones
  Holes Regions; // of these
};

/** As it goes to a part: of patches, without holes and reports. */
template <>
struct FieldsOf<SurroundedHoles>
{
  template <typename Some>
  static auto In(Some& holes)
  {
    auto& patches = holes.Patches;
    return std::tie(holes.Numbers, holes.Keys, patches.Points, patches.Triangles,
      patches.PointOffsets, patches.TriangleOffsets, patches.NearestBoundaryPoints,
      patches.StandardErrors, patches.HalfIntervals, patches.Attributes, holes.Surrounding);
  }
};

} // namespace elevation

#endif
