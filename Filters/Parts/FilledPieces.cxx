// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilledPieces.h"

#include "Adapt/Adapt.h"
#include "BoundaryZone.h"
#include "PackedData.h"

#include "vtkPolyData.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace elevation
{

namespace
{
constexpr double LeastPointsOfGroup = 1000.0;
constexpr double GroupsOfPiece = 8.0; // so many groups together take the memory of a piece
} // namespace

FilledPieces::FilledPieces(int count, const std::string& folder, vtkIdType numberOfPoints,
  const MakePiece& makePiece, const FillOptions& options, bool interpolate)
  : Folder(folder)
  , Make(makePiece)
  , NumberOfPoints(numberOfPoints)
{
  for (int piece = 0; piece < count; ++piece)
  {
    this->Pieces.push_back({ Box(), 0.0, SpoolFile(folder + "/patches-" + std::to_string(piece)) });
  }
  this->Whole.Options = options;
  this->Whole.Interpolate = interpolate;
  this->Whole.ByIds = true;
  this->FindHoles();
  this->GroupHoles();
  if (this->Whole.NeedLattice())
  {
    this->FindLattice();
  }
  this->FillAll();
  this->Whole.NumberNewPoints();
}

template <typename Visit>
void FilledPieces::VisitPiece(int piece, const Progress& progress, const Visit& visit) const
{
  const vtkSmartPointer<vtkPolyData> made = this->Make(piece, Part(progress, 0.0, 0.5));
  if (made)
  {
    FilledPart part;
    part.Input = made;
    visit(piece, part, Part(progress, 0.5, 1.0));
  }
}

template <typename Visit>
void FilledPieces::ForEachPiece(double begin, double end, const Visit& visit) const
{
  const int count = static_cast<int>(this->Pieces.size());
  const double width = (end - begin) / count;
  for (int piece = 0; piece < count; ++piece)
  {
    const double first = begin + width * piece;
    this->VisitPiece(piece, Part(this->Whole.Options.Monitor, first, first + width), visit);
  }
}

void FilledPieces::FindHoles()
{
  std::vector<EdgeOfPart> edges;
  Parts borders;
  this->ForEachPiece(0.0, 0.2, [&](int piece, FilledPart& part, const Progress& progress) {
    part.Read(progress);
    if (!part.ListShared(true))
    {
      throw Error("Points of a piece have the same global id.");
    }
    AppendBorder(part.Own, part.Shared, piece, edges);
    for (const Index corner : part.Own.Triangles)
    {
      this->Pieces[piece].Place.Add(part.Own.PointOf(corner));
    }
    this->Pieces[piece].NumberOfTriangles = part.Own.NumberOfTriangles();
    std::vector<Index> ends;
    std::copy_if(part.Shared.Places.begin(), part.Shared.Places.end(), std::back_inserter(ends),
      [&part](Index place) { return part.AreUsed[place] != 0; });
    if (!ends.empty())
    {
      borders.push_back(ChosenPoints(part.Input, ends));
    }
  });
  if (!KeepSingleEdges(edges))
  {
    throw Error("An edge has more than two triangles.");
  }
  this->Whole.Border = BorderOfAll(std::move(edges));
  for (const vtkSmartPointer<vtkPolyData>& points : borders)
  {
    const std::vector<PointKey> keys = KeysOf(points, true, nullptr);
    std::vector<Index> chosen;
    for (std::size_t i = 0; i < keys.size(); ++i)
    {
      if (this->Whole.Border.Find(keys[i]) != None)
      {
        chosen.push_back(static_cast<Index>(i));
      }
    }
    this->Rims.push_back(ChosenPoints(points, chosen));
  }
  if (!this->Whole.Find(Progress()))
  {
    throw Error("Borders of the surface touch, so that it cannot be filled in pieces; fill the "
                "surface in memory.");
  }
}

/** About how many points are in the box around a hole. */
double FilledPieces::PointsAround(Index hole, int piece) const
{
  const HoleExtent& extent = this->Whole.Extents[hole];
  const Box box = this->Whole.BoxOf(hole);
  const double area = box.Width() * box.Height();
  const Box& all = this->Pieces[piece].Place;
  return std::max(area / (extent.MeanEdge * extent.MeanEdge),
    0.5 * this->Pieces[piece].NumberOfTriangles * area / (all.Width() * all.Height()));
}

/** Holes belong to the piece that has the first point of the rim. */
void FilledPieces::GroupHoles()
{
  const BorderOfAll& border = this->Whole.Border;
  std::vector<int> pieceOf(border.Keys.size(), 0);
  for (std::size_t i = 0; i < border.Edges.size(); ++i)
  {
    pieceOf[border.Edges[i].Origin] = border.PartOfEdge[i];
  }
  const double pieces = static_cast<double>(this->Pieces.size());
  const double most = std::max(
    LeastPointsOfGroup, static_cast<double>(this->NumberOfPoints) / pieces / GroupsOfPiece);
  std::vector<Index> groupOf(this->Pieces.size(), None); // the last one of each piece
  std::vector<double> points;                            // around the holes of each group
  const Holes& found = this->Whole.OfAll.Found;
  for (Index hole = 0; hole < found.Count(); ++hole)
  {
    if (!this->Whole.IsToBeFilled(hole))
    {
      continue;
    }
    const int piece = pieceOf[*found.Walks.Begin(found.Rim(hole))];
    const double around = this->PointsAround(hole, piece);
    Index& group = groupOf[piece];
    if (group == None || points[group] + around > most)
    {
      group = static_cast<Index>(this->Groups.size());
      this->Groups.push_back(
        { piece, {}, SpoolFile(this->Folder + "/surrounding-" + std::to_string(group)) });
      points.push_back(0.0);
    }
    this->Groups[group].Holes.push_back(hole);
    points[group] += around;
  }
}

void FilledPieces::FindLattice()
{
  const PointSlices points = { static_cast<double>(this->NumberOfPoints),
    [this](const auto& visit) {
      this->ForEachPiece(0.2, 0.2, [&visit](int, FilledPart& part, const Progress&) {
        Buffer<double> kept;
        visit(part.OwnPoints(kept));
      });
    } };
  this->Whole.FindLattice(Ranks(), points, Part(this->Whole.Options.Monitor, 0.2, 0.5));
}

/** Writes the triangles around the holes of groups to their files. */
void FilledPieces::Surround(const std::vector<char>& areWaiting, double begin, double end)
{
  std::vector<std::vector<Box>> boxes(this->Groups.size());
  for (std::size_t group = 0; group < this->Groups.size(); ++group)
  {
    this->Groups[group].Surrounding.Remove(); // of boxes that were too small
    for (const Index hole : this->Groups[group].Holes)
    {
      if (areWaiting[group])
      {
        boxes[group].push_back(this->Whole.BoxOf(hole));
      }
    }
  }
  const double width = (end - begin) / static_cast<double>(this->Pieces.size());
  for (std::size_t piece = 0; piece < this->Pieces.size(); ++piece)
  {
    const double first = begin + width * static_cast<double>(piece);
    this->AppendSurroundings(
      static_cast<int>(piece), boxes, Part(this->Whole.Options.Monitor, first, first + width));
  }
}

/** Writes what a piece has in the boxes of each group, if any. */
void FilledPieces::AppendSurroundings(
  int piece, const std::vector<std::vector<Box>>& boxes, const Progress& progress)
{
  std::vector<std::vector<Box>> here(boxes.size());
  bool isNear = false;
  for (std::size_t of = 0; of < boxes.size(); ++of)
  {
    std::copy_if(boxes[of].begin(), boxes[of].end(), std::back_inserter(here[of]),
      [&](const Box& box) { return box.Intersects(this->Pieces[piece].Place); });
    isNear = isNear || !here[of].empty();
  }
  if (!isNear)
  {
    return;
  }
  this->VisitPiece(piece, progress, [&](int, FilledPart& part, const Progress& ofPiece) {
    ToMesh(part.Input, part.Own, ofPiece);
    for (std::size_t of = 0; of < here.size(); ++of)
    {
      const std::vector<Index> near = TrianglesIn(here[of], part.Own);
      if (!near.empty())
      {
        const Bytes packed = PackData(ChosenTriangles(part.Input, part.Own, near));
        this->Groups[of].Surrounding.Append(packed.data(), packed.size());
      }
    }
  });
}

SurroundedHoles FilledPieces::HolesOf(const Group& group, const Progress& progress) const
{
  SurroundedHoles holes;
  holes.Numbers = group.Holes;
  Parts parts;
  group.Surrounding.ForEach(
    [&parts](Bytes&& bytes) { parts.push_back(UnpackData(bytes.data(), bytes.size())); });
  holes.Surround(parts, true, progress);
  return holes;
}

/** What each hole may take is known where all needs are. */
void FilledPieces::FindQuotas()
{
  std::vector<HoleNeed> needs(this->Whole.Extents.size());
  for (const Group& group : this->Groups)
  {
    Report(this->Whole.Options.Monitor, 0.6);
    const std::vector<HoleNeed> ofGroup =
      this->HolesOf(group, Progress()).Needs(this->Whole, Progress());
    for (std::size_t i = 0; i < ofGroup.size(); ++i)
    {
      needs[group.Holes[i]] = ofGroup[i];
    }
  }
  CheckEffort(needs, static_cast<double>(this->NumberOfPoints), this->Whole.Options);
  this->Whole.Quotas = QuotasFor(needs, this->Whole.Options.MaximumInsertedPoints);
}

void FilledPieces::FillAll()
{
  std::vector<char> areWaiting(this->Groups.size(), 1);
  while (std::count(areWaiting.begin(), areWaiting.end(), 1) > 0)
  {
    // Few holes need more than their first box.
    const bool isFirst = this->Whole.Quotas.empty();
    const double begin = isFirst ? 0.5 : 0.9, end = isFirst ? 0.6 : 0.9;
    this->Surround(areWaiting, begin, end);
    if (isFirst)
    {
      this->FindQuotas();
    }
    const double width = (isFirst ? 0.3 : 0.1) / static_cast<double>(this->Groups.size());
    for (std::size_t group = 0; group < this->Groups.size(); ++group)
    {
      const double first = end + width * static_cast<double>(group);
      const Progress progress =
        Part(this->Whole.Options.Monitor, first, std::min(1.0, first + width));
      areWaiting[group] =
        areWaiting[group] && !this->FillHolesOf(this->Groups[group], progress) ? 1 : 0;
    }
  }
}

/** @return false if they need more of the surface around them */
bool FilledPieces::FillHolesOf(Group& group, const Progress& progress)
{
  SurroundedHoles holes = this->HolesOf(group, Part(progress, 0.0, 0.1));
  const std::vector<Index> beyond = holes.Fill(this->Whole, Part(progress, 0.1, 1.0));
  for (const Index hole : beyond)
  {
    ++this->Whole.Retries[hole];
  }
  if (!beyond.empty())
  {
    return false;
  }
  for (std::size_t i = 0; i < group.Holes.size(); ++i)
  {
    this->Whole.OfAll.Reports[group.Holes[i]] = holes.Patches.Reports[i];
  }
  group.Surrounding.Remove();
  if (holes.Patches.NumberOfTriangles() > 0)
  {
    this->NewTriangles += holes.Patches.NumberOfTriangles();
    holes.KeepCorners();
    const Bytes packed = holes.Pack();
    this->Pieces[group.Piece].Patches.Append(packed.data(), packed.size());
  }
  return true;
}

void FilledPieces::Pass(int piece, const Progress& progress, vtkPolyData* output) const
{
  const vtkSmartPointer<vtkPolyData> made = this->Make(piece, Part(progress, 0.0, 0.4));
  if (!made)
  {
    return;
  }
  FilledPart part;
  part.Input = made;
  part.Read(Part(progress, 0.4, 0.6));
  part.ListShared(true);
  part.Shared.TakeMarks(made);
  std::vector<SurroundedHoles> groups;
  this->Pieces[piece].Patches.ForEach([&groups](Bytes&& bytes) { groups.emplace_back(bytes); });
  part.Filled = SurroundedHoles(std::move(groups));
  part.FindCorners();
  part.Write(this->Whole, true, this->NumberOfPoints - 1, Part(progress, 0.6, 1.0), output);
}

void FilledPieces::PassRims(vtkPolyData* output) const
{
  WriteRims(this->Whole, this->Rims, Progress(), output);
}

} // namespace elevation
