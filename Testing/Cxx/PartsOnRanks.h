// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Clouds, lines and the parts of their surfaces, and what PartsOnRanks checks.
 */
#ifndef PartsOnRanks_h
#define PartsOnRanks_h

#include "Adapt/Adapt.h"
#include "Parts/Parts.h"

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace parts_on_ranks
{
using namespace elevation;

using Place = std::array<double, 3>;

/** The places of the corners of a triangle, the lowest first. */
using Corners = std::array<double, 6>;

/** A cloud with duplicates and a point that is not finite; on a lattice, or not. */
inline std::vector<Place> Cloud(bool isLattice)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0.0, 100.0);
  std::vector<Place> cloud;
  for (int i = 0; i < 4000; ++i)
  {
    const double row = i / 80, column = i % 80;
    cloud.push_back(isLattice
        ? Place{ 3.0 * column + 0.5 * row, 2.0 * row - 0.25 * column, 1.0 * i }
        : Place{ place(random), place(random), 1.0 * i });
  }
  std::shuffle(cloud.begin(), cloud.end(), random);
  std::copy_n(cloud.begin(), 20, cloud.end() - 20);
  cloud[7][0] = std::numeric_limits<double>::quiet_NaN();
  return cloud;
}

/** Triangles by places, sorted. */
template <typename PlaceOf>
std::vector<Corners> ByPlaces(const Buffer<Index>& triangles, const PlaceOf& placeOf)
{
  std::vector<Corners> found;
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    std::array<std::pair<double, double>, 3> corners;
    for (int k = 0; k < 3; ++k)
    {
      const Point2 p = placeOf(triangles[i + k]);
      corners[k] = { p.X, p.Y };
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    found.push_back({ corners[0].first, corners[0].second, corners[1].first, corners[1].second,
      corners[2].first, corners[2].second });
  }
  std::sort(found.begin(), found.end());
  return found;
}

/** Long lines across the cloud, most of which no edge follows, and a ring; of none, nullptr. */
inline vtkSmartPointer<vtkPolyData> Lines(const std::vector<Place>& cloud, int count)
{
  if (count == 0)
  {
    return nullptr;
  }
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(-3.0, 103.0);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines, rings;
  for (int line = 0; line < count; ++line)
  {
    (line == 0 ? rings : lines)->InsertNextCell(line == 0 ? 6 : 2);
    for (int i = 0; i < (line == 0 ? 6 : 2); ++i)
    {
      const double z = place(random);
      const vtkIdType last = line % 3 == 2
        ? points->InsertNextPoint(cloud[100 * static_cast<std::size_t>(line + i)].data())
        : points->InsertNextPoint(place(random), place(random), z);
      (line == 0 ? rings : lines)->InsertCellPoint(last);
    }
  }
  auto made = vtkSmartPointer<vtkPolyData>::New();
  made->SetPoints(points);
  made->SetLines(lines);
  made->SetPolys(rings);
  return made;
}

/** Where files may be written. */
inline std::string Temporary;

/** An empty folder of this rank, or no name, for parts in memory. */
inline std::string FolderOf(const Ranks& ranks, int partsOfRank)
{
  if (partsOfRank == 0)
  {
    return std::string();
  }
  const std::string folder = Temporary + "/parts-on-rank-" + std::to_string(ranks.OwnRank()) +
    "-of-" + std::to_string(ranks.Count());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

inline vtkSmartPointer<vtkPolyData> PointsOf(
  const std::vector<Place>& cloud, std::size_t begin, std::size_t end)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (std::size_t i = begin; i < end; ++i)
  {
    points->InsertNextPoint(cloud[i].data());
  }
  auto made = vtkSmartPointer<vtkPolyData>::New();
  made->SetPoints(points);
  return made;
}

/** Adds those points of a cloud that are this rank's, in slices for files. */
inline void AddShare(TriangulateParts& parts, const Ranks& ranks, const std::vector<Place>& cloud,
  bool isInSlices, std::vector<vtkSmartPointer<vtkPolyData>>& kept)
{
  const std::size_t slices = isInSlices ? 5 * ranks.Count() : ranks.Count();
  for (std::size_t slice = ranks.OwnRank(); slice < slices; slice += ranks.Count())
  {
    kept.push_back(
      PointsOf(cloud, slice * cloud.size() / slices, (slice + 1) * cloud.size() / slices));
    parts.Add(kept.back(), Progress());
  }
}

// What each of the files checks.
void CheckTriangles(const Ranks& ranks);
void CheckGivenLattice(const Ranks& ranks);
void CheckCuts(const Ranks& ranks);
void CheckFilling(const Ranks& ranks);
void CheckRefusal(const Ranks& ranks);
void CheckFailures(const Ranks& ranks);
void CheckTrimming(const Ranks& ranks);
void CheckFailuresOfTrimming(const Ranks& ranks);
void CheckOutlineOfPart();

} // namespace parts_on_ranks

#endif
