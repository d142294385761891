// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilledPieces.h"

#include "MeshConversion.h"
#include "NearParts.h"
#include "PackedData.h"

#include "vtkPolyData.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace elevation
{

FilledPieces::FilledPieces(int count, const std::string& folder, vtkIdType numberOfPoints,
  const MakePiece& makePiece, const FillOptions& options, bool interpolate)
  : Make(makePiece)
  , NumberOfPoints(numberOfPoints)
{
  for (int piece = 0; piece < count; ++piece)
  {
    const std::string number = std::to_string(piece);
    this->Pieces.push_back({ Box(), {}, SpoolFile(folder + "/surrounding-" + number),
      SpoolFile(folder + "/patches-" + number) });
  }
  this->Whole.Options = options;
  this->Whole.Interpolate = interpolate;
  this->Whole.ByIds = true;
  this->FindHoles();
  this->AssignHoles();
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

/** To the piece that has the first point of the rim. */
void FilledPieces::AssignHoles()
{
  const BorderOfAll& border = this->Whole.Border;
  std::vector<int> pieceOf(border.Keys.size(), 0);
  for (std::size_t i = 0; i < border.Edges.size(); ++i)
  {
    pieceOf[border.Edges[i].Origin] = border.PartOfEdge[i];
  }
  const Holes& found = this->Whole.OfAll.Found;
  for (Index hole = 0; hole < found.Count(); ++hole)
  {
    if (this->Whole.IsToBeFilled(hole))
    {
      this->Pieces[pieceOf[*found.Walks.Begin(found.Rim(hole))]].Holes.push_back(hole);
    }
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

/** Writes the triangles around the holes of pieces to their files. */
void FilledPieces::Surround(const std::vector<char>& areWaiting, double begin, double end)
{
  std::vector<std::vector<Box>> boxes(this->Pieces.size()); // around the holes of each piece
  for (std::size_t piece = 0; piece < this->Pieces.size(); ++piece)
  {
    this->Pieces[piece].Surrounding.Remove(); // of boxes that were too small
    for (const Index hole : this->Pieces[piece].Holes)
    {
      if (areWaiting[piece])
      {
        boxes[piece].push_back(this->Whole.BoxOf(hole));
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

/** Writes what a piece has in the boxes of each, if any. */
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
        this->Pieces[of].Surrounding.Append(packed.data(), packed.size());
      }
    }
  });
}

SurroundedHoles FilledPieces::HolesOf(int piece, const Progress& progress) const
{
  SurroundedHoles holes;
  holes.Numbers = this->Pieces[piece].Holes;
  Parts parts;
  this->Pieces[piece].Surrounding.ForEach(
    [&parts](Bytes&& bytes) { parts.push_back(UnpackData(bytes.data(), bytes.size())); });
  holes.Surround(parts, true, progress);
  return holes;
}

/** What each hole may take is known where all needs are. */
void FilledPieces::FindRooms()
{
  std::vector<double> needs(this->Whole.Extents.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t piece = 0; piece < this->Pieces.size(); ++piece)
  {
    const std::vector<Index>& holes = this->Pieces[piece].Holes;
    if (!holes.empty())
    {
      Report(this->Whole.Options.Monitor, 0.6);
      const std::vector<double> ofPiece =
        this->HolesOf(static_cast<int>(piece), Progress()).Needs(this->Whole, Progress());
      for (std::size_t i = 0; i < holes.size(); ++i)
      {
        needs[holes[i]] = ofPiece[i];
      }
    }
  }
  this->Whole.Rooms = RoomsOfNeeds(needs, this->Whole.Options.MaximumInsertedPoints);
}

void FilledPieces::FillAll()
{
  const int count = static_cast<int>(this->Pieces.size());
  std::vector<char> areWaiting(this->Pieces.size(), 0);
  std::transform(this->Pieces.begin(), this->Pieces.end(), areWaiting.begin(),
    [](const PieceFiles& files) { return files.Holes.empty() ? 0 : 1; });
  while (std::count(areWaiting.begin(), areWaiting.end(), 1) > 0)
  {
    // Few holes need more than their first box.
    const bool isFirst = this->Whole.Rooms.empty();
    const double begin = isFirst ? 0.5 : 0.9, end = isFirst ? 0.6 : 0.9;
    this->Surround(areWaiting, begin, end);
    if (isFirst)
    {
      this->FindRooms();
    }
    const double width = (isFirst ? 0.3 : 0.1) / count;
    for (int piece = 0; piece < count; ++piece)
    {
      const double first = end + width * piece;
      const Progress progress =
        Part(this->Whole.Options.Monitor, first, std::min(1.0, first + width));
      areWaiting[piece] = areWaiting[piece] && !this->FillHolesOf(piece, progress) ? 1 : 0;
    }
  }
}

/** @return false if they need more of the surface around them */
bool FilledPieces::FillHolesOf(int piece, const Progress& progress)
{
  PieceFiles& files = this->Pieces[piece];
  SurroundedHoles holes = this->HolesOf(piece, Part(progress, 0.0, 0.1));
  const std::vector<Index> beyond = holes.Fill(this->Whole, Part(progress, 0.1, 1.0));
  for (const Index hole : beyond)
  {
    ++this->Whole.TimesTooFew[hole];
  }
  if (!beyond.empty())
  {
    return false;
  }
  for (std::size_t i = 0; i < files.Holes.size(); ++i)
  {
    this->Whole.OfAll.Reports[files.Holes[i]] = holes.Patches.Reports[i];
  }
  files.Surrounding.Remove();
  if (holes.Patches.NumberOfTriangles() > 0)
  {
    this->NewTriangles += holes.Patches.NumberOfTriangles();
    holes.KeepCorners();
    const Bytes packed = holes.Pack();
    files.Patches.Append(packed.data(), packed.size());
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
  this->Pieces[piece].Patches.ForEach(
    [&part](Bytes&& bytes) { part.Filled = SurroundedHoles(bytes); });
  part.FindCorners();
  part.Write(this->Whole, true, this->NumberOfPoints - 1, Part(progress, 0.6, 1.0), output);
}

void FilledPieces::PassRims(vtkPolyData* output) const
{
  WriteRims(this->Whole, this->Rims, Progress(), output);
}

} // namespace elevation
