// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The holes of a surface in parts, on ranks or in pieces. Private to the module.
 */
#ifndef SharedHoles_h
#define SharedHoles_h

#include "BorderOfParts.h"
#include "CommonPoints.h"
#include "HoleNeighborhoods.h"
#include "Kernel/Fill/Fill.h"
#include "LatticeOfRanks.h"

#include "vtkSmartPointer.h"

#include <tuple>
#include <vector>

class vtkPolyData;

namespace elevation
{

/** As it goes to other ranks. */
template <>
struct FieldsOf<HoleReport>
{
  template <typename Report>
  static auto In(Report& report)
  {
    auto& [status, edges, size, perimeter, area, spacing, inserted, method, more, reason] = report;
    return std::tie(status, edges, size, perimeter, area, spacing, inserted, method, more, reason);
  }
};

/** What is known of all holes, wherever they are filled. */
struct SharedHoles
{
  FillOptions Options; ///< without what is of a part
  bool Interpolate = true;
  bool ByIds = false; ///< whether points of parts are one by their global ids, or by x,y,z
  BorderOfAll Border;
  FillResult OfAll; ///< the holes, by points of the border, and reports; no patches
  std::vector<HoleExtent> Extents;
  std::vector<int> Retries; ///< for each hole: how often it needed triangles beyond its box
  LatticeSearch Lattice;
  std::vector<double> Quotas;
  std::vector<vtkIdType> FirstNewPoints; ///< of each hole, and the number of all

  /** Finds and measures the holes of the border. @return false if borders touch */
  bool Find(const Progress& progress);
  /** Whether the limits of size and edges admit a hole. */
  bool IsToBeFilled(std::size_t hole) const
  {
    return this->OfAll.Reports[hole].Status == FillStatus::Filled;
  }
  Box BoxOf(Index hole) const { return BoxAround(this->Extents[hole], this->Retries[hole]); }
  bool NeedLattice() const;
  /** @param[in] points  of all parts, each once */
  void FindLattice(const Ranks& ranks, const PointSlices& points, const Progress& progress);
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
  void Surround(const Parts& parts, bool byIds, const Progress& progress);
  std::vector<HoleNeed> Needs(const SharedHoles& all, const Progress& progress) const;
  /** @return the holes that need triangles beyond their boxes */
  std::vector<Index> Fill(const SharedHoles& all, const Progress& progress);
  /** Keeps only those points of the surrounding that patches have. */
  void KeepCorners();

  Bytes Pack() const;
  SurroundedHoles() = default;
  explicit SurroundedHoles(const Bytes& bytes);
  /** Several groups in one, by the order of their first holes; without triangles around them. */
  explicit SurroundedHoles(std::vector<SurroundedHoles>&& groups);

private:
  Holes Listed(const SharedHoles& all) const;
  FillOptions OptionsFor(const SharedHoles& all, const Progress& progress) const;
  WholeSurface KnownOf(const SharedHoles& all) const;

  Mesh Near; // the triangles
};

} // namespace elevation

#endif
