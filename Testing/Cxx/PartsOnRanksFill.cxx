// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Parts on ranks are filled like the whole surface, and a failure on one rank is that of all.
#include "Check.h"
#include "PartsOnRanks.h"

#include "Adapt/Adapt.h"
#include "Parts/BoundaryZone.h"
#include "Parts/Parts.h"
#include "Parts/TrimmedPart.h"
#include "vtkFillElevationHoles.h"
#include "vtkGridDelaunay2D.h"

#include "vtkCellArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace parts_on_ranks
{

namespace
{
/**
 * A surface with lakes: points at some places are taken away. Triangles across these are too long.
 */
std::vector<Place> CloudWithLakes(bool isLattice)
{
  std::vector<Place> cloud = Cloud(isLattice);
  Box all;
  for (Place& p : cloud)
  {
    all.Add(std::isnan(p[0]) ? all.Low : Point2{ p[0], p[1] });
  }
  const double size = all.Height();
  const auto isInLake = [&](const Place& p) {
    constexpr double lakes[][3] = { { 0.5, 0.5, 0.2 }, { 0.2, 0.3, 0.07 }, { 0.8, 0.4, 0.05 },
      { 0.3, 0.8, 0.1 }, { 0.75, 0.75, 0.06 } };
    return std::any_of(std::begin(lakes), std::end(lakes), [&](const auto& lake) {
      return std::hypot(p[0] - all.Low.X - lake[0] * all.Width(),
               p[1] - all.Low.Y - lake[1] * all.Height()) < lake[2] * size;
    });
  };
  cloud.erase(std::remove_if(cloud.begin(), cloud.end(), isInLake), cloud.end());
  for (Place& p : cloud)
  {
    p[2] = std::sin(p[0] / 20.0) * std::cos(p[1] / 30.0) + 0.01 * p[0];
  }
  return cloud;
}

/** The corners of a triangle, x, y and z of each, the lowest first. */
using Corners3 = std::array<double, 9>;

std::vector<Corners3> TrianglesOf(vtkPolyData* surface)
{
  std::vector<Corners3> triangles;
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < surface->GetNumberOfPolys(); ++i)
  {
    surface->GetPolys()->GetCellAtId(i, ids);
    std::array<Place, 3> corners;
    for (vtkIdType k = 0; k < 3; ++k)
    {
      surface->GetPoint(ids->GetId(k), corners[k].data());
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    Corners3 triangle;
    for (std::size_t k = 0; k < triangle.size(); ++k)
    {
      triangle[k] = corners[k / 3][k % 3];
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

/**
 * What is known of holes in words, in an order that no part decides; no spacing of one that is
 * refused.
 */
std::vector<std::string> InWords(const std::vector<HoleReport>& reports)
{
  std::vector<std::string> words;
  for (const HoleReport& report : reports)
  {
    const bool isRefused = report.Status == FillStatus::TooLarge;
    words.push_back(std::to_string(static_cast<int>(report.Status)) + " of " +
      std::to_string(report.NumberOfEdges) + " edges, " + ToText(report.Area, 15) + " " +
      ToText(report.Perimeter, 15) + " " + ToText(report.Size, 15) + " " +
      ToText(isRefused ? 0.0 : report.Spacing, 15) + " " +
      std::to_string(report.NumberOfInsertedPoints) + " " +
      std::to_string(static_cast<int>(report.Method)) + report.Reason.Words());
  }
  std::sort(words.begin(), words.end());
  return words;
}

/** A surface of all ranks whose holes are filled. */
struct FilledSurface
{
  std::vector<Corners3> Triangles;
  std::vector<std::string> Reports;
  vtkIdType Rims = 0; // of holes, with their points
  vtkIdType OwnPoints = 0;

  bool operator==(const FilledSurface& other) const
  {
    return this->Triangles == other.Triangles && this->Reports == other.Reports &&
      this->Rims == other.Rims && this->OwnPoints == other.OwnPoints;
  }
};

/** By the filters, on the first rank, to compare with; the others need none. */
FilledSurface FilledAtOnce(const Ranks& ranks, const std::vector<Place>& cloud, double limit,
  double longest, const FillOptions& options)
{
  if (ranks.OwnRank() > 0)
  {
    return {};
  }
  vtkNew<vtkGridDelaunay2D> whole;
  whole->SetController(nullptr);
  whole->SetInputData(PointsOf(cloud, 0, cloud.size()));
  whole->SetMaximumEdgeLength(limit);
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetController(nullptr);
  fill->SetInputConnection(whole->GetOutputPort());
  fill->SetOpenEdgeLength(longest);
  fill->SetMaximumHoleSize(options.MaximumHoleSize);
  fill->SetMaximumNumberOfInsertedPoints(options.MaximumInsertedPoints);
  fill->Update();
  vtkPolyData* const made = whole->GetOutput();
  // The reports of one run in memory: a part that has all.
  Mesh mesh;
  ToMesh(made, mesh, Progress());
  mesh.ConnectTwins(0, Progress());
  Holes found = FindHoles(mesh, 0, Progress());
  Mesh rest;
  const bool isOpened = longest > 0.0 && OpenLongTriangles(mesh, longest, found, rest);
  const FillResult patches =
    FillHoles(isOpened ? rest : mesh, ViewPoints(made).View, std::move(found), options);
  FilledSurface filled{ TrianglesOf(fill->GetOutput()), InWords(patches.Reports),
    fill->GetOutput(1)->GetNumberOfPoints(), fill->GetOutput()->GetNumberOfPoints() };
  std::sort(filled.Triangles.begin(), filled.Triangles.end());
  return filled;
}

/** Ids that are those of all points, each counted once. */
bool AreIdsComplete(std::vector<vtkIdType>&& ids)
{
  std::sort(ids.begin(), ids.end());
  std::vector<vtkIdType> all(ids.size());
  std::iota(all.begin(), all.end(), 0);
  return ids == all;
}

/** Makes the parts of a surface for filling; all of them are what TriangulateParts has found. */
SurfaceParts PartsOf(TriangulateParts& parts)
{
  return { parts.Holders(), [&parts](int part, const Progress& progress) {
            SurfacePart taken = parts.Take(part, progress);
            auto made = vtkSmartPointer<vtkPolyData>::New();
            PassPart(taken, 1, made);
            return made->GetNumberOfPoints() > 0 ? made : nullptr;
          } };
}

FilledSurface FilledInParts(const Ranks& ranks, int partsOfRank, const std::vector<Place>& cloud,
  double limit, double longest, const FillOptions& options)
{
  std::vector<vtkSmartPointer<vtkPolyData>> kept;
  TriangulateParts parts(ranks, FolderOf(ranks, partsOfRank));
  AddShare(parts, ranks, cloud, partsOfRank > 0, kept);
  std::vector<Message> warnings;
  DelaunayOptions triangulating;
  triangulating.MaximumEdgeLength = limit;
  parts.Triangulate(std::max(1, partsOfRank), nullptr, triangulating, warnings);
  FillParts fill(PartsOf(parts), options, true, longest);
  const int rimsPart = parts.PartCount() - 1;
  fill.FindHoles(rimsPart);
  fill.Fill();
  FilledSurface filled;
  std::vector<vtkIdType> ids;
  for (int i = 0; i < std::max(1, partsOfRank); ++i)
  {
    vtkNew<vtkPolyData> part;
    fill.Pass(parts.FirstOwn() + i, Progress(), part);
    const std::vector<Corners3> found = TrianglesOf(part);
    filled.Triangles.insert(filled.Triangles.end(), found.begin(), found.end());
    auto* const numbers = vtkIdTypeArray::SafeDownCast(part->GetPointData()->GetGlobalIds());
    vtkUnsignedCharArray* const ghosts = GhostsOf(part->GetPointData());
    for (vtkIdType at = 0; at < part->GetNumberOfPoints(); ++at)
    {
      if (!ghosts || !(ghosts->GetValue(at) & vtkDataSetAttributes::DUPLICATEPOINT))
      {
        ids.push_back(numbers->GetValue(at));
      }
    }
  }
  vtkNew<vtkPolyData> rims;
  if (parts.Holders().IsOwn(rimsPart))
  {
    fill.PassRims(Progress(), rims);
  }
  std::vector<vtkIdType> sums = { rims->GetNumberOfPoints() };
  ranks.Sum(sums);
  filled.Rims = sums[0];
  filled.Triangles = ranks.Collect(filled.Triangles);
  std::sort(filled.Triangles.begin(), filled.Triangles.end());
  filled.Reports = InWords(fill.Result().Reports);
  ids = ranks.Collect(ids);
  filled.OwnPoints = static_cast<vtkIdType>(ids.size());
  Check(AreIdsComplete(std::move(ids)), "each point is one part's own, new ones after the others");
  Check(fill.NewTriangleCount() + parts.GetTotals().Triangles ==
      static_cast<vtkIdType>(filled.Triangles.size()),
    "triangles of patches are counted");
  return filled;
}

/** Lines that waver, whose distances differ; all between them is long. */
std::vector<Place> SurveyLines()
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.3, 0.3);
  std::vector<Place> cloud;
  for (int line = 0; line < 10; ++line)
  {
    for (int i = 0; i < 120; ++i)
    {
      const double x = i + noise(random), y = 0.9 * line * line + 5.0 * line + noise(random);
      cloud.push_back({ x, y, 0.01 * x * y });
    }
  }
  std::shuffle(cloud.begin(), cloud.end(), random);
  return cloud;
}

/**
 * Triangles longer than the limit are not made; longer ones than the longest are opened, if above
 * 0.
 */
void CheckFillingOf(const Ranks& ranks, const std::vector<Place>& cloud, double limit,
  double longest, const FillOptions& options, const std::string& name)
{
  const FilledSurface expected = FilledAtOnce(ranks, cloud, limit, longest, options);
  Check(ranks.OwnRank() > 0 || expected.Reports.size() > 0, name + ": there are holes");
  for (const int partsOfRank : { 0, 1, 3 })
  {
    const FilledSurface found = FilledInParts(ranks, partsOfRank, cloud, limit, longest, options);
    Check(ranks.OwnRank() > 0 || found == expected,
      name + ", " + std::to_string(partsOfRank) + " parts of a rank, at most " +
        std::to_string(options.MaximumInsertedPoints) + " new points: as at once");
  }
}
} // namespace

void CheckFilling(const Ranks& ranks)
{
  for (const bool isLattice : { false, true })
  {
    const std::vector<Place> cloud = CloudWithLakes(isLattice);
    const double limit = isLattice ? 3.5 : 6.0;
    for (const Index most : { MaximumNumberOfPoints, Index(200) })
    {
      FillOptions options;
      options.MaximumInsertedPoints = most;
      CheckFillingOf(ranks, cloud, limit, 0.0, options, isLattice ? "lattice" : "random");
    }
    FillOptions options;
    CheckFillingOf(ranks, cloud, 0.0, limit, options, "opened");
    CheckFillingOf(ranks, cloud, 2.0 * limit, 0.4 * limit, options, "opened, and holes");
    options.MaximumHoleSize = 30.0;
    CheckFillingOf(ranks, SurveyLines(), 0.0, 3.0, options, "no line opened");
    CheckFillingOf(ranks, SurveyLines(), 0.0, 3.0, FillOptions(), "lines");
  }
}

namespace
{
/** A progress in which the last rank fails at a report. */
Progress FailingAt(const Ranks& ranks, int report, bool isAbort)
{
  auto reports = std::make_shared<int>(0);
  return [&ranks, report, isAbort, reports](double) {
    if (ranks.OwnRank() + 1 < ranks.Count() || (*reports)++ < report)
    {
      return true;
    }
    return isAbort ? false : throw Error("a fault");
  };
}

/** What a step throws on this rank, when it fails at a report of the last one. */
std::string FailureAt(const Ranks& ranks, int partsOfRank, bool isFilling, const Progress& failing)
{
  std::vector<vtkSmartPointer<vtkPolyData>> kept;
  const std::vector<Place> cloud = isFilling ? CloudWithLakes(false) : Cloud(false);
  const std::string folder = FolderOf(ranks, partsOfRank);
  std::string thrown = "nothing";
  {
    TriangulateParts parts(ranks, folder);
    AddShare(parts, ranks, cloud, partsOfRank > 0, kept);
    DelaunayOptions options;
    options.MaximumEdgeLength = isFilling ? 6.0 : 0.0;
    options.Monitor = isFilling ? Progress() : failing;
    std::vector<Message> warnings;
    const vtkSmartPointer<vtkPolyData> lines = Lines(cloud, isFilling ? 0 : 12);
    try
    {
      parts.Triangulate(std::max(1, partsOfRank), lines, options, warnings);
      if (isFilling)
      {
        FillOptions filling;
        filling.Monitor = failing;
        FillParts fill(PartsOf(parts), filling, true, 0.0);
        fill.FindHoles(0);
        fill.Fill();
      }
    }
    catch (const Aborted&)
    {
      thrown = "aborted";
    }
    catch (const Error& error)
    {
      thrown = error.what();
    }
  }
  Check(folder.empty() || std::filesystem::is_empty(folder), "no file is left");
  return thrown;
}
} // namespace

void CheckFailures(const Ranks& ranks)
{
  std::mt19937 random(3);
  for (const int partsOfRank : { 0, 1, 3 })
  {
    for (int i = 0; i < 20; ++i)
    {
      const bool isFilling = i >= 10, isAbort = i % 2 == 0;
      const int report = static_cast<int>(random() % 30);
      const std::string thrown =
        FailureAt(ranks, partsOfRank, isFilling, FailingAt(ranks, report, isAbort));
      const std::vector<std::string> all = ranks.Collect(std::vector<std::string>{ thrown });
      Check(std::count(all.begin(), all.end(), all.front()) == ranks.Count(),
        "a failure at report " + std::to_string(report) + " is that of all ranks");
      Check(all.front() == (isAbort ? "aborted" : "a fault"),
        "it is " + all.front() + (isFilling ? ", filling" : ", triangulating"));
    }
  }
}

/** What would take too much is refused on all ranks alike, before any hole is filled. */
void CheckRefusal(const Ranks& ranks)
{
  std::set<std::string> refusals;
  for (const int partsOfRank : { 0, 3 })
  {
    FillOptions options;
    options.Spacing = 1e-4;
    try
    {
      FilledInParts(ranks, partsOfRank, CloudWithLakes(false), 6.0, 0.0, options);
    }
    catch (const Error& error)
    {
      refusals.insert(error.what());
    }
  }
  const std::vector<std::string> all =
    ranks.Collect(std::vector<std::string>(refusals.begin(), refusals.end()));
  Check(all.size() == static_cast<std::size_t>(ranks.Count()) && all.front() == all.back(),
    "too many points are one error");
}

} // namespace parts_on_ranks
