// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Parts on ranks have the triangles of all points at once.
#include "Check.h"
#include "PartsOnRanks.h"

#include "Adapt/Adapt.h"
#include "Kernel/Constrain/Constrain.h"
#include "Parts/BoundaryZone.h"
#include "Parts/Parts.h"
#include "Parts/TrimmedPart.h"

#include "vtkPolyData.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace parts_on_ranks
{

namespace
{
/** On the first rank, to compare with; the others need none. */
std::vector<Corners> AllAtOnce(const Ranks& ranks, const std::vector<Place>& cloud,
  vtkPolyData* source, const DelaunayOptions& options)
{
  if (ranks.OwnRank() > 0)
  {
    return {};
  }
  PointView points;
  points.Double = cloud.front().data();
  points.Count = static_cast<Index>(cloud.size());
  const DataSetPoints own = source ? ViewPoints(source) : DataSetPoints();
  const ConstrainedTriangulation all = TriangulateConstrained(
    points, source ? ToConstraintLines(source, own, Progress()) : ConstraintLines(), options);
  return ByPlaces(all.Result.Triangles, [&](Index i) {
    return i < points.Count ? points.At(i) : all.Added[i - points.Count].Position;
  });
}

/** The triangles of all ranks, on each; 0 parts of a rank: one, in memory. */
std::vector<Corners> InParts(const Ranks& ranks, int partsOfRank, const std::vector<Place>& cloud,
  vtkPolyData* lines, const DelaunayOptions& options)
{
  std::vector<vtkSmartPointer<vtkPolyData>> kept;
  TriangulateParts parts(ranks, FolderOf(ranks, partsOfRank));
  AddShare(parts, ranks, cloud, partsOfRank > 0, kept);
  std::vector<Message> warnings;
  parts.Triangulate(std::max(1, partsOfRank), lines, options, warnings);
  std::vector<Corners> own;
  std::vector<vtkIdType> added = { 0 };
  for (int i = 0; i < std::max(1, partsOfRank); ++i)
  {
    const SurfacePart part = parts.Take(parts.FirstOwn() + i, Progress());
    const std::vector<Corners> found =
      ByPlaces(part.Result.Triangles, [&](Index at) { return part.PointAt(at); });
    own.insert(own.end(), found.begin(), found.end());
    added[0] += part.AddedPoints;
  }
  ranks.Sum(added);
  Check(parts.GetTotals().AddedPoints == added[0], "points that lines add are counted");
  Check((added[0] > 0) == (lines != nullptr), "lines add points");
  std::vector<Corners> triangles = ranks.Collect(own);
  std::sort(triangles.begin(), triangles.end());
  Check(parts.GetTotals().Triangles == static_cast<vtkIdType>(triangles.size()),
    "triangles are counted");
  Check(parts.GetTotals().NotFinite == 1 && parts.GetTotals().Duplicates > 0,
    "unused points are counted");
  return triangles;
}
} // namespace

void CheckTriangles(const Ranks& ranks)
{
  for (const bool isLattice : { false, true })
  {
    const std::vector<Place> cloud = Cloud(isLattice);
    for (const int count : { 0, 12 })
    {
      const vtkSmartPointer<vtkPolyData> lines = Lines(cloud, count);
      for (const double limit : { 0.0, isLattice ? 2.5 : 2.0 })
      {
        DelaunayOptions options;
        options.UseLattice = LatticeMode::Automatic;
        options.MaximumEdgeLength = limit;
        const std::vector<Corners> expected = AllAtOnce(ranks, cloud, lines, options);
        for (const int partsOfRank : { 0, 1, 3 })
        {
          const std::vector<Corners> found = InParts(ranks, partsOfRank, cloud, lines, options);
          Check(ranks.OwnRank() > 0 || found == expected,
            std::string(isLattice ? "lattice, " : "random, ") + std::to_string(partsOfRank) +
              " parts of a rank, " + std::to_string(count) + " lines, limit " +
              std::to_string(limit) + ": the triangles of all at once");
        }
      }
    }
  }
}

/** A lattice that is given is that of all parts; one that does not fit names the first point. */
void CheckGivenLattice(const Ranks& ranks)
{
  std::vector<Place> cloud = Cloud(true);
  DelaunayOptions options;
  options.UseLattice = LatticeMode::Automatic;
  options.GivenLattice = { { 0.0, 0.0 }, { 3.0, -0.25 }, { 0.5, 2.0 } };
  const std::vector<Corners> expected = AllAtOnce(ranks, cloud, nullptr, options);
  for (const int partsOfRank : { 0, 1, 3 })
  {
    const std::vector<Corners> found = InParts(ranks, partsOfRank, cloud, nullptr, options);
    Check(ranks.OwnRank() > 0 || found == expected,
      std::to_string(partsOfRank) + " parts of a rank on a lattice: the triangles of all at once");
  }
  for (const std::size_t i : { 3000, 1234, 2000 })
  {
    cloud[i][1] += 0.5;
  }
  for (const int partsOfRank : { 0, 1, 3 })
  {
    std::string thrown = "nothing";
    try
    {
      InParts(ranks, partsOfRank, cloud, nullptr, options);
    }
    catch (const Error& error)
    {
      thrown = error.what();
    }
    // In slices, points of a rank have numbers one after another.
    const bool isInOrder = partsOfRank == 0 || ranks.Count() == 1;
    Check(thrown.rfind(isInOrder ? "Point 1234 at" : "Point ", 0) == 0, "it is " + thrown);
    Check(thrown.find("away from the nearest node") != std::string::npos, "it is " + thrown);
  }
}

/** Where ranks cut the plane depends on the points alone: the sample that decides has no chance. */
void CheckCuts(const Ranks& ranks)
{
  constexpr long long count = 10007; // a prime number
  std::vector<Place> cloud;
  for (long long i = 0; i < count; ++i)
  {
    cloud.push_back({ static_cast<double>(i), static_cast<double>(7919 * i * i % count), 0.0 });
  }
  std::vector<vtkSmartPointer<vtkPolyData>> kept;
  TriangulateParts parts(ranks);
  AddShare(parts, ranks, cloud, false, kept);
  std::vector<Message> warnings;
  parts.Triangulate(1, nullptr, DelaunayOptions(), warnings);
  const std::vector<vtkIdType> points =
    ranks.Collect(std::vector<vtkIdType>{ static_cast<vtkIdType>(parts.GetEffort().Points) });
  const std::map<int, std::vector<vtkIdType>> expected = { { 2, { 5005, 5002 } },
    { 3, { 3337, 3358, 3312 } } };
  const auto ofRanks = expected.find(ranks.Count());
  Check(ofRanks == expected.end() || points == ofRanks->second,
    "rank 0 has " + std::to_string(points[0]) + " points");
}

} // namespace parts_on_ranks
