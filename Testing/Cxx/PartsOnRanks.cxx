// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Parts of a surface on ranks, in memory and in files: whoever holds them, their triangles are those of
 * all points at once, also where holes are filled, and a failure on one rank is that of all. All ranks run
 * this program.
 */
#include "Check.h"

#include "Kernel/Triangulate/Triangulate.h"
#include "Parts/Parts.h"
#include "vtkFillElevationHoles.h"
#include "vtkGridDelaunay2D.h"

#include "vtkCellArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
#include "vtkMPIController.h"
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace
{
using namespace elevation;

using Place = std::array<double, 3>;
/** The places of the corners of a triangle, the lowest first. */
using Corners = std::array<double, 6>;

/** A cloud with duplicates and a point that is not finite; on a lattice, or not. */
std::vector<Place> Cloud(bool isLattice)
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

std::vector<Corners> AllAtOnce(const std::vector<Place>& cloud, const DelaunayOptions& options)
{
  PointView points;
  points.Double = cloud.front().data();
  points.Count = static_cast<Index>(cloud.size());
  const Triangulation all = Triangulate(points, options);
  return ByPlaces(all.Triangles, [&](Index i) { return points.At(i); });
}

/** An empty folder of this rank, or no name, for parts in memory. */
std::string FolderOf(const Ranks& ranks, int partsOfRank)
{
  if (partsOfRank == 0)
  {
    return std::string();
  }
  const std::string folder = "parts-on-rank-" + std::to_string(ranks.Own());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directory(folder);
  return folder;
}

vtkSmartPointer<vtkPolyData> PointsOf(
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
void AddShare(TriangulateParts& parts, const Ranks& ranks, const std::vector<Place>& cloud,
  bool isInSlices, std::vector<vtkSmartPointer<vtkPolyData>>& kept)
{
  const std::size_t slices = isInSlices ? 5 * ranks.Count() : ranks.Count();
  for (std::size_t slice = ranks.Own(); slice < slices; slice += ranks.Count())
  {
    kept.push_back(
      PointsOf(cloud, slice * cloud.size() / slices, (slice + 1) * cloud.size() / slices));
    parts.Add(kept.back(), Progress());
  }
}

/** The triangles of all ranks, on each; 0 parts of a rank: one, in memory. */
std::vector<Corners> InParts(const Ranks& ranks, int partsOfRank, const std::vector<Place>& cloud,
  const DelaunayOptions& options)
{
  std::vector<vtkSmartPointer<vtkPolyData>> kept;
  TriangulateParts parts(ranks, FolderOf(ranks, partsOfRank));
  AddShare(parts, ranks, cloud, partsOfRank > 0, kept);
  std::vector<Message> warnings;
  parts.Triangulate(std::max(1, partsOfRank), nullptr, options, warnings);
  std::vector<Corners> own;
  for (int i = 0; i < std::max(1, partsOfRank); ++i)
  {
    const SurfacePart part = parts.Take(parts.FirstOwn() + i, Progress());
    const std::vector<Corners> found =
      ByPlaces(part.Result.Triangles, [&](Index at) { return part.PointAt(at); });
    own.insert(own.end(), found.begin(), found.end());
  }
  std::vector<Corners> triangles = ranks.Collect(own);
  std::sort(triangles.begin(), triangles.end());
  Check(parts.All().Triangles == static_cast<vtkIdType>(triangles.size()), "triangles are counted");
  Check(parts.All().NotFinite == 1 && parts.All().Duplicates > 0, "unused points are counted");
  return triangles;
}

void CheckTriangles(const Ranks& ranks)
{
  for (const bool isLattice : { false, true })
  {
    const std::vector<Place> cloud = Cloud(isLattice);
    for (const double limit : { 0.0, isLattice ? 2.5 : 2.0 })
    {
      DelaunayOptions options;
      options.MaximumEdgeLength = limit;
      const std::vector<Corners> expected = AllAtOnce(cloud, options);
      for (const int partsOfRank : { 0, 1, 3 })
      {
        Check(InParts(ranks, partsOfRank, cloud, options) == expected,
          std::string(isLattice ? "lattice, " : "random, ") + std::to_string(partsOfRank) +
            " parts of a rank, limit " + std::to_string(limit) + ": the triangles of all at once");
      }
    }
  }
}

/** A surface with lakes: points at some places are taken away. Triangles across these are too long. */
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

/** What is known of holes in words, in an order that no part decides. */
std::vector<std::string> InWords(const std::vector<HoleReport>& reports)
{
  std::vector<std::string> words;
  for (const HoleReport& report : reports)
  {
    words.push_back(std::to_string(static_cast<int>(report.Status)) + " of " +
      std::to_string(report.NumberOfEdges) + " edges, " + ToText(report.Area, 15) + " " +
      ToText(report.Perimeter, 15) + " " + ToText(report.Size, 15) + " " +
      ToText(report.Spacing, 15) + " " + std::to_string(report.NumberOfInsertedPoints) + " " +
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

/** By the filters, on one rank. */
FilledSurface FilledAtOnce(
  const std::vector<Place>& cloud, double limit, const FillOptions& options)
{
  vtkNew<vtkGridDelaunay2D> whole;
  whole->SetController(nullptr);
  whole->SetInputData(PointsOf(cloud, 0, cloud.size()));
  whole->SetMaximumEdgeLength(limit);
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetController(nullptr);
  fill->SetInputConnection(whole->GetOutputPort());
  fill->SetMaximumNumberOfInsertedPoints(options.MaximumInsertedPoints);
  fill->Update();
  vtkPolyData* const made = whole->GetOutput();
  // The reports of one run in memory: a part that has all.
  Mesh mesh;
  ToMesh(made, mesh, Progress());
  mesh.ConnectTwins(0, Progress());
  const FillResult patches =
    FillHoles(mesh, ViewPoints(made).View, FindHoles(mesh, 0, Progress()), options);
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
  double limit, const FillOptions& options)
{
  std::vector<vtkSmartPointer<vtkPolyData>> kept;
  TriangulateParts parts(ranks, FolderOf(ranks, partsOfRank));
  AddShare(parts, ranks, cloud, partsOfRank > 0, kept);
  std::vector<Message> warnings;
  DelaunayOptions triangulating;
  triangulating.MaximumEdgeLength = limit;
  parts.Triangulate(std::max(1, partsOfRank), nullptr, triangulating, warnings);
  FillParts fill(PartsOf(parts), options, true);
  const int partOfRims = parts.CountOfParts() - 1;
  fill.FindHoles(partOfRims);
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
  if (parts.Holders().IsOwn(partOfRims))
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
  Check(fill.CountOfNewTriangles() + parts.All().Triangles ==
      static_cast<vtkIdType>(filled.Triangles.size()),
    "triangles of patches are counted");
  return filled;
}

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
      const FilledSurface expected = FilledAtOnce(cloud, limit, options);
      for (const int partsOfRank : { 0, 1, 3 })
      {
        Check(FilledInParts(ranks, partsOfRank, cloud, limit, options) == expected,
          std::string(isLattice ? "lattice, " : "random, ") + std::to_string(partsOfRank) +
            " parts of a rank, at most " + std::to_string(most) + " new points: as at once");
      }
    }
  }
}

/** A progress in which the last rank fails at a report. */
Progress FailingAt(const Ranks& ranks, int report, bool isAbort)
{
  auto reports = std::make_shared<int>(0);
  return [&ranks, report, isAbort, reports](double) {
    if (ranks.Own() + 1 < ranks.Count() || (*reports)++ < report)
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
    try
    {
      parts.Triangulate(std::max(1, partsOfRank), nullptr, options, warnings);
      if (isFilling)
      {
        FillOptions filling;
        filling.Monitor = failing;
        FillParts fill(PartsOf(parts), filling, true);
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
      FilledInParts(ranks, partsOfRank, CloudWithLakes(false), 6.0, options);
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

/** What is sent lies in the order of ranks, and then of sending; also what a rank sends itself. */
void CheckOrder(const Ranks& ranks)
{
  for (const std::string& folder : { std::string(), FolderOf(ranks, 2) })
  {
    Engine engine(ranks, ranks.Own() % 2 == 0 ? 2 : 0, { "some" }, folder);
    engine.ForEach(Progress(), [&](int part, const Progress&) {
      for (int to = 0; to < engine.CountOfParts(); ++to)
      {
        SendTo(engine, 0, std::map<int, std::vector<int>>{ { to, { part, to } } });
      }
    });
    engine.Deliver();
    std::vector<int> expected;
    for (int part = 0; part < engine.CountOfParts(); ++part)
    {
      expected.insert(expected.end(), { part, -1 });
    }
    engine.ForEach(Progress(), [&](int part, const Progress&) {
      for (std::size_t i = 1; i < expected.size(); i += 2)
      {
        expected[i] = part;
      }
      Check(ValuesIn<int>(engine.At(part, 0)) == expected, "messages are in order");
      Check(engine.RankOf(part) == ranks.Own(), "ranks know their parts");
    });
  }
}
} // namespace

int main(int argc, char** argv)
{
  int count = 1;
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
  vtkNew<vtkMPIController> controller;
  if (argc > 1 && std::string(argv[1]) == "--ranks")
  {
    controller->Initialize(&argc, &argv);
    count = controller->GetNumberOfProcesses();
    vtkMultiProcessController::SetGlobalController(controller);
  }
#else
  static_cast<void>(argc);
  static_cast<void>(argv);
#endif
  {
    vtkNew<vtkInformationVector> outputs;
    vtkNew<vtkInformation> output;
    output->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES(), count);
    outputs->Append(output);
    const Ranks ranks(vtkMultiProcessController::GetGlobalController(), nullptr, outputs);
    CheckOrder(ranks);
    CheckTriangles(ranks);
    CheckFilling(ranks);
    CheckRefusal(ranks);
    CheckFailures(ranks);
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
  if (count > 1)
  {
    controller->Finalize();
  }
#endif
  return failures == 0 ? 0 : 1;
}
