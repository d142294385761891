// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Parts on ranks are trimmed like the whole surface, and a failure on one rank is that of all.
#include "Check.h"
#include "PartsOnRanks.h"

#include "Adapt/Adapt.h"
#include "Parts/BoundaryZone.h"
#include "Parts/Parts.h"
#include "Parts/TrimmedPart.h"
#include "vtkGridDelaunay2D.h"

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace parts_on_ranks
{

namespace
{
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

/** On the first rank, to compare with; the others need none. */
std::vector<Corners> TrimmedAtOnce(
  const Ranks& ranks, const std::vector<Place>& cloud, vtkPolyData* boundary)
{
  if (ranks.OwnRank() > 0)
  {
    return {};
  }
  PointView points;
  points.Double = cloud.front().data();
  points.Count = static_cast<Index>(cloud.size());
  const Triangulation whole = Triangulate(points, DelaunayOptions());
  const BoundaryLines lines =
    boundary ? ToBoundaryLines(boundary, Progress(), "boundary") : BoundaryLines();
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
} // namespace

void CheckTrimming(const Ranks& ranks)
{
  const std::vector<Place> cloud = CloudWithGaps();
  const vtkSmartPointer<vtkPolyData> star = Star();
  for (vtkPolyData* const boundary : { star.Get(), static_cast<vtkPolyData*>(nullptr) })
  {
    const std::vector<Corners> expected = TrimmedAtOnce(ranks, cloud, boundary);
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
      Check(ranks.OwnRank() > 0 || triangles == expected, name + "the triangles of one surface");
      Check(trimmed.Parts->KeptCount() == static_cast<vtkIdType>(triangles.size()),
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

/** Along an outline no triangle is cut: a part gets back on which side each of its triangles is. */
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

} // namespace parts_on_ranks
