// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Parts of a surface on ranks, in memory and in files: whoever holds them, their triangles are
 * those of all points at once, also trimmed and where holes are filled, and a failure on one rank
 * is that of all. All ranks run this program: PartsOnRanks FOLDER [--ranks].
 */
#include "Check.h"

#include "Adapt/Adapt.h"
#include "Kernel/Constrain/Constrain.h"
#include "Parts/BoundaryZone.h"
#include "Parts/PackedData.h"
#include "Parts/Parts.h"
#include "Parts/TrimmedPart.h"
#include "vtkFillElevationHoles.h"
#include "vtkGridDelaunay2D.h"

#include "vtkCellArray.h"
#include "vtkCommand.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
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
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
#include "vtkMPIController.h"
#endif

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
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

struct Observer : public vtkCommand
{
  static Observer* New() { return new Observer; }
  void Execute(vtkObject*, unsigned long, void*) override { this->Call(); }
  std::function<void()> Call;
};
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

/** Long lines across the cloud, most of which no edge follows, and a ring; of none, nullptr. */
vtkSmartPointer<vtkPolyData> Lines(const std::vector<Place>& cloud, int count)
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

std::vector<Corners> AllAtOnce(
  const std::vector<Place>& cloud, vtkPolyData* source, const DelaunayOptions& options)
{
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

/** Where files may be written. */
std::string Temporary;

/** An empty folder of this rank, or no name, for parts in memory. */
std::string FolderOf(const Ranks& ranks, int partsOfRank)
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
  for (std::size_t slice = ranks.OwnRank(); slice < slices; slice += ranks.Count())
  {
    kept.push_back(
      PointsOf(cloud, slice * cloud.size() / slices, (slice + 1) * cloud.size() / slices));
    parts.Add(kept.back(), Progress());
  }
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
        const std::vector<Corners> expected = AllAtOnce(cloud, lines, options);
        for (const int partsOfRank : { 0, 1, 3 })
        {
          Check(InParts(ranks, partsOfRank, cloud, lines, options) == expected,
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
  const std::vector<Corners> expected = AllAtOnce(cloud, nullptr, options);
  for (const int partsOfRank : { 0, 1, 3 })
  {
    Check(InParts(ranks, partsOfRank, cloud, nullptr, options) == expected,
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

/** By the filters, on one rank. */
FilledSurface FilledAtOnce(
  const std::vector<Place>& cloud, double limit, double longest, const FillOptions& options)
{
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
  const FilledSurface expected = FilledAtOnce(cloud, limit, longest, options);
  Check(expected.Reports.size() > 0, name + ": there are holes");
  for (const int partsOfRank : { 0, 1, 3 })
  {
    Check(FilledInParts(ranks, partsOfRank, cloud, limit, longest, options) == expected,
      name + ", " + std::to_string(partsOfRank) + " parts of a rank, at most " +
        std::to_string(options.MaximumInsertedPoints) + " new points: as at once");
  }
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

/** Points on rings around a lake and in a bay are missing, and a few lie far off. */
std::vector<Place> CloudWithGaps()
{
  std::vector<Place> cloud;
  for (const Place& p : Cloud(false))
  {
    if (!(std::hypot(p[0] - 60.0, p[1] - 50.0) < 15.0 || std::hypot(p[0], p[1] - 40.0) < 20.0))
    {
      cloud.push_back(p);
    }
  }
  cloud.insert(cloud.end(), { { 300.0, 0.0, 0.0 }, { 301.0, 1.0, 0.0 }, { 300.0, 2.0, 0.0 } });
  return cloud;
}

/** A star around the middle of the cloud. */
vtkSmartPointer<vtkPolyData> Star()
{
  constexpr int corners = 40;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> ring;
  ring->InsertNextCell(corners);
  for (int i = 0; i < corners; ++i)
  {
    const double turn = 2.0 * 3.14159265358979 * i / corners, reach = 35.0 + 5.0 * (i % 2);
    points->InsertNextPoint(50.0 + reach * std::cos(turn), 50.0 + reach * std::sin(turn), 0.0);
    ring->InsertCellPoint(i);
  }
  auto star = vtkSmartPointer<vtkPolyData>::New();
  star->SetPoints(points);
  star->SetPolys(ring);
  return star;
}

std::vector<Corners> TrimmedAtOnce(const std::vector<Place>& cloud, vtkPolyData* boundary)
{
  PointView points;
  points.Double = cloud.front().data();
  points.Count = static_cast<Index>(cloud.size());
  const Triangulation whole = Triangulate(points, DelaunayOptions());
  const BoundaryLines lines = boundary ? ToBoundaryLines(boundary, Progress()) : BoundaryLines();
  TriangleList list;
  list.Points = points;
  list.Corners = whole.Triangles.data();
  list.Count = static_cast<Index>(whole.Triangles.size() / 3);
  const Trimmed trimmed = Trim(list, boundary ? &lines : nullptr, TrimOptions());
  return ByPlaces(trimmed.Kept.Corners,
    [&](Index i) { return i < points.Count ? points.At(i) : trimmed.Places[i - points.Count]; });
}

/** A surface in parts that is ready to be trimmed. */
struct TrimmedInParts
{
  TrimmedInParts(const Ranks& ranks, int partsOfRank, const std::vector<Place>& cloud,
    vtkPolyData* boundary, const Progress& monitor)
    : Folder(FolderOf(ranks, partsOfRank))
    , Surface(ranks, this->Folder)
  {
    AddShare(this->Surface, ranks, cloud, partsOfRank > 0, this->Kept);
    std::vector<Message> warnings;
    this->Surface.Triangulate(std::max(1, partsOfRank), nullptr, DelaunayOptions(), warnings);
    TrimOptions options;
    options.Monitor = monitor;
    const auto make = [this](int part, const Progress&) {
      if (!this->Made || !this->Folder.empty())
      {
        SurfacePart found = this->Surface.Take(part, Progress());
        this->Made = vtkSmartPointer<vtkPolyData>::New();
        PassPart(found, 1, this->Made);
      }
      return this->Made;
    };
    this->Parts = std::make_unique<TrimParts>(SurfaceParts{ this->Surface.Holders(), make },
      this->Surface.GetTotals().Triangles, boundary, options);
  }

  const std::string Folder;
  std::vector<vtkSmartPointer<vtkPolyData>> Kept; // points
  TriangulateParts Surface;
  vtkSmartPointer<vtkPolyData> Made;
  std::unique_ptr<TrimParts> Parts;
};

void CheckTrimming(const Ranks& ranks)
{
  const std::vector<Place> cloud = CloudWithGaps();
  const vtkSmartPointer<vtkPolyData> star = Star();
  for (vtkPolyData* const boundary : { star.Get(), static_cast<vtkPolyData*>(nullptr) })
  {
    const std::vector<Corners> expected = TrimmedAtOnce(cloud, boundary);
    for (const int partsOfRank : { 0, 1, 3 })
    {
      const std::string name = std::string(boundary ? "given, " : "found, ") +
        std::to_string(partsOfRank) + " parts of a rank: ";
      TrimmedInParts trimmed(ranks, partsOfRank, cloud, boundary, Progress());
      Check(trimmed.Parts->Trim(), name + "it can be trimmed");
      std::vector<Corners> own;
      const Engine& holders = trimmed.Surface.Holders();
      for (int part = holders.EndOwn() - 1; part >= holders.FirstOwn(); --part)
      {
        vtkNew<vtkPolyData> kept;
        trimmed.Parts->Write(part, Progress(), kept, nullptr);
        DataSetTriangles ofPart = ViewTriangles(kept);
        Buffer<Index> corners;
        std::for_each(ofPart.View.Corners, ofPart.View.CornersOf(ofPart.View.Count),
          [&corners](Index corner) { corners.Append(corner); });
        const std::vector<Corners> found =
          ByPlaces(corners, [&](Index i) { return ofPart.View.Points.At(i); });
        own.insert(own.end(), found.begin(), found.end());
      }
      std::vector<Corners> triangles = ranks.Collect(own);
      std::sort(triangles.begin(), triangles.end());
      Check(triangles == expected, name + "the triangles of one surface");
      Check(trimmed.Parts->KeptCount() == static_cast<vtkIdType>(expected.size()),
        name + "triangles are counted");
      std::vector<vtkIdType> rings = { trimmed.Parts->Boundary()->GetNumberOfLines() };
      ranks.Sum(rings);
      Check(rings[0] == trimmed.Parts->RingCount() && rings[0] > (boundary ? 0 : 1),
        name + "one rank has the boundary");
    }
  }
}

/** A failure of the last rank while it trims is that of all, and a boundary elsewhere an error. */
void CheckFailuresOfTrimming(const Ranks& ranks)
{
  std::mt19937 random(4);
  const std::vector<Place> cloud = CloudWithGaps();
  const vtkSmartPointer<vtkPolyData> star = Star();
  for (int i = 0; i < 12; ++i)
  {
    const bool isAbort = i % 2 == 0;
    const int partsOfRank = isAbort ? i % 3 : 1 + i % 2, last = static_cast<int>(random() % 6);
    int reports = 0;
    TrimmedInParts trimmed(
      ranks, partsOfRank, cloud, i % 4 < 2 ? star.Get() : nullptr, [&](double) {
        if (ranks.OwnRank() + 1 < ranks.Count() || reports++ < last)
        {
          return true;
        }
        return isAbort ? false : throw Error("a fault");
      });
    std::string thrown = "nothing";
    try
    {
      trimmed.Parts->Trim();
    }
    catch (const Aborted&)
    {
      thrown = "aborted";
    }
    catch (const Error& error)
    {
      thrown = error.what();
    }
    const std::vector<std::string> all = ranks.Collect(std::vector<std::string>{ thrown });
    Check(std::count(all.begin(), all.end(), isAbort ? "aborted" : "a fault") == ranks.Count(),
      "after " + std::to_string(last) + " reports of trimming all have failed: " + all.front());
  }
  for (vtkIdType i = 0; i < star->GetNumberOfPoints(); ++i)
  {
    star->GetPoints()->SetPoint(i, 1e3 + i * i, -i, 0.0);
  }
  for (const int partsOfRank : { 0, 2 })
  {
    TrimmedInParts trimmed(ranks, partsOfRank, cloud, star, Progress());
    std::string thrown = "nothing";
    try
    {
      Check(!trimmed.Parts->Trim(), "what is an error has to be gathered");
    }
    catch (const Error& error)
    {
      thrown = error.what();
    }
    const bool isAsExpected = partsOfRank == 0
      ? thrown == "nothing"
      : thrown.find("encloses no triangle of the mesh. It is at x 1000 to 2521") != thrown.npos;
    Check(isAsExpected, std::to_string(partsOfRank) + " parts: a boundary elsewhere: " + thrown);
  }
}

/** Along an outline no triangle is cut: of a part's triangles it gets back which side they are on. */
void CheckOutlineOfPart()
{
  vtkNew<vtkGridDelaunay2D> whole;
  whole->SetController(nullptr);
  const std::vector<Place> cloud = CloudWithGaps();
  whole->SetInputData(PointsOf(cloud, 0, cloud.size()));
  whole->Update();
  TrimmedPart part(whole->GetOutput());
  part.Read();
  Check(part.SweepForOutline(4, TrimOptions(), Progress()), "the part covers nothing twice");
  BoundaryZone zone({ part.NearPart() });
  Check(zone.TrimOutline(part.InnerPointCount(), part.TriangleCount(), TrimOptions()),
    "the near triangles decide");
  const std::vector<TrimmedZone> back = zone.Split(Progress());
  Check(back.size() == 1 && !back[0].Parents[0].empty() && !back[0].Parents[1].empty(),
    "there are triangles on both sides");
  Check(back[0].Corners[0].empty() && back[0].Corners[1].empty(), "no corner is sent back");
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

/** What is sent lies in the order of ranks, and then of sending; also what a rank sends itself. */
void CheckOrder(const Ranks& ranks)
{
  for (const std::string& folder : { std::string(), FolderOf(ranks, 2) })
  {
    Engine engine(ranks, ranks.OwnRank() % 2 == 0 ? 2 : 0, { "some" }, folder);
    engine.ForEach(Progress(), [&](int part, const Progress&) {
      for (int to = 0; to < engine.PartCount(); ++to)
      {
        SendTo(engine, 0, std::map<int, std::vector<int>>{ { to, { part, to } } });
      }
    });
    engine.Deliver();
    std::vector<int> expected;
    for (int part = 0; part < engine.PartCount(); ++part)
    {
      expected.insert(expected.end(), { part, -1 });
    }
    engine.ForEach(Progress(), [&](int part, const Progress&) {
      for (std::size_t i = 1; i < expected.size(); i += 2)
      {
        expected[i] = part;
      }
      Check(ValuesIn<int>(engine.At(part, 0)) == expected, "messages are in order");
      Check(engine.RankOf(part) == ranks.OwnRank(), "ranks know their parts");
    });
  }
}

void CheckArraysWithoutValues()
{
  const vtkSmartPointer<vtkPolyData> local = PointsOf(Cloud(false), 0, 10);
  vtkNew<vtkIdTypeArray> none, some;
  none->SetName("None");
  some->SetName("Some");
  some->InsertNextValue(vtkIdType(7) << 40);
  local->GetFieldData()->AddArray(none);
  local->GetFieldData()->AddArray(some);
  const Bytes bytes = PackData(local);
  const vtkSmartPointer<vtkPolyData> arrived = UnpackData(bytes.data(), bytes.size());
  vtkFieldData* const data = arrived->GetFieldData();
  auto* const noneToo = vtkIdTypeArray::SafeDownCast(data->GetArray("None"));
  auto* const someToo = vtkIdTypeArray::SafeDownCast(data->GetArray("Some"));
  Check(noneToo && noneToo->GetNumberOfTuples() == 0, "an array without values arrives");
  Check(someToo && someToo->GetNumberOfTuples() == 1 && someToo->GetValue(0) == some->GetValue(0),
    "and keeps no other from coming");
}

/** An array of field data is that of the first part that has it. */
void CheckJoinedFieldData()
{
  Parts parts;
  for (const vtkIdType part : { 0, 1 })
  {
    parts.push_back(PointsOf(Cloud(false), 10 * part, 10 * part + 10));
    for (const char* const name : { "Of both", part == 0 ? "Of the first" : "Of the second" })
    {
      vtkNew<vtkIdTypeArray> array;
      array->SetName(name);
      array->InsertNextValue(7 + part);
      parts.back()->GetFieldData()->AddArray(array);
    }
  }
  std::vector<Message> warnings;
  const vtkSmartPointer<vtkPolyData> joined = Join(parts, PartKind::Points, Progress(), warnings);
  vtkFieldData* const data = joined->GetFieldData();
  const auto valueOf = [data](const char* name) {
    vtkDataArray* const array = data->GetArray(name);
    return array ? array->GetComponent(0, 0) : 0.0;
  };
  Check(data->GetNumberOfArrays() == 3 && warnings.empty(), "there are three arrays");
  Check(
    valueOf("Of both") == 7.0 && valueOf("Of the first") == 7.0 && valueOf("Of the second") == 8.0,
    "each is that of the first part that has it");
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

/** Word from rank to rank, so that each comes when the one before waits for it. */
class Chain
{
public:
  explicit Chain(const Ranks& ranks)
    : AllRanks(ranks)
    , IsLast(ranks.OwnRank() + 1 == ranks.Count())
  {
  }
  void Await() const
  {
    int word = 0;
    if (this->AllRanks.OwnRank() > 0)
    {
      this->AllRanks.Receive(&word, sizeof(word), this->AllRanks.OwnRank() - 1);
    }
  }
  void CallNext() const
  {
    const int word = 1;
    if (!this->IsLast)
    {
      this->AllRanks.Send(&word, sizeof(word), this->AllRanks.OwnRank() + 1);
    }
  }

private:
  const Ranks& AllRanks;
  const bool IsLast;
};

/** "1, 2": the ranks after this one. */
std::string RanksAfter(const Ranks& ranks)
{
  std::string names;
  for (int rank = ranks.OwnRank() + 1; rank < ranks.Count(); ++rank)
  {
    names += (names.empty() ? "" : ", ") + std::to_string(rank);
  }
  return names;
}

// No rank comes before the ones below have reported that they wait for it, however long that takes.
void CheckWaiting(const Ranks& ranks, vtkInformationVector* outputs)
{
  const Chain chain(ranks);
  const auto minute = std::exchange(Ranks::Patience, std::chrono::milliseconds(20));
  std::vector<Message> messages;
  const Ranks waiting(vtkMultiProcessController::GetGlobalController(), nullptr, outputs,
    [&](const Message& message) {
      messages.push_back(message);
      chain.CallNext();
    });
  const bool isLast = ranks.OwnRank() + 1 == ranks.Count();
  for (int wait = 1; wait <= 2; ++wait)
  {
    chain.Await();
    std::vector<vtkIdType> sum = { 1 };
    waiting.Sum(sum);
    Check(messages.size() == (isLast ? 0u : wait), "a rank reports once for each time it waits");
  }
  for (const Message& message : messages)
  {
    const std::vector<Message::Value>& values = message.GetValues();
    Check(message.GetCode() == "RankWaits" && values.size() == 3 &&
        values[0] == Message::Value("rank", std::to_string(ranks.OwnRank())) &&
        values[2] == Message::Value("others", RanksAfter(ranks)),
      "the message names who waits for whom");
  }

  // A filter reports it as all its warnings, while it waits.
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(PointsOf(Cloud(false), 0, 100));
  bool isReported = false;
  const auto report = [&]() {
    vtkStringArray* const rows = delaunay->GetMessages();
    if (!isReported)
    {
      isReported = true;
      Check(rows->GetNumberOfTuples() >= 4 && rows->GetValue(1) == "RankWaits",
        "the filter's messages have it");
      chain.CallNext();
    }
  };
  vtkNew<Observer> observer;
  observer->Call = report;
  delaunay->AddObserver(vtkCommand::WarningEvent, observer);
  chain.Await();
  delaunay->UpdatePiece(ranks.OwnRank(), ranks.Count(), 0);
  Check(isReported || isLast, "a filter that waits reports it");
  Ranks::Patience = minute;
}
} // namespace

int main(int argc, char** argv)
{
  if (argc < 2)
  {
    return 1;
  }
  Temporary = argv[1];
  int count = 1;
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
  vtkNew<vtkMPIController> controller;
  if (argc > 2 && std::string(argv[2]) == "--ranks")
  {
    controller->Initialize(&argc, &argv);
    count = controller->GetNumberOfProcesses();
    vtkMultiProcessController::SetGlobalController(controller);
  }
#endif
  {
    vtkNew<vtkInformationVector> outputs;
    vtkNew<vtkInformation> output;
    output->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES(), count);
    outputs->Append(output);
    const Ranks ranks(
      vtkMultiProcessController::GetGlobalController(), nullptr, outputs, [](const Message&) {});
    CheckOrder(ranks);
    CheckTriangles(ranks);
    CheckGivenLattice(ranks);
    CheckFilling(ranks);
    CheckRefusal(ranks);
    CheckFailures(ranks);
    CheckTrimming(ranks);
    CheckFailuresOfTrimming(ranks);
    CheckOutlineOfPart();
    CheckArraysWithoutValues();
    CheckJoinedFieldData();
    CheckCuts(ranks);
    CheckWaiting(ranks, outputs);
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
