// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedDelaunay.h"

#include "ConstraintsOfRanks.h"
#include "Kernel/Base/Base.h"
#include "LatticeOfRanks.h"
#include "PointOwners.h"

#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace elevation
{

namespace
{
/** Cells [Begin, End) of the cuts. */
struct Node
{
  int Begin, End;

  int Size() const { return this->End - this->Begin; }
  int Middle() const { return Cuts::MiddleOf(this->Begin, this->End); }
};

/** The node of a cell that is some levels below the whole plane, or the cell itself. */
Node NodeOf(int cell, int level, int count)
{
  Node node{ 0, count };
  for (; level > 0 && node.Size() > 1; --level)
  {
    const int middle = node.Middle();
    (cell < middle ? node.End : node.Begin) = middle;
  }
  return node;
}

Bytes PackPiece(const Piece& piece)
{
  Bytes bytes;
  AppendTo(bytes, std::vector<std::size_t>{ piece.Ids.size(), piece.Edges.size() });
  AppendTo(bytes, piece.Coordinates);
  AppendTo(bytes, piece.Ids);
  AppendTo(bytes, piece.Edges);
  return bytes;
}

Piece UnpackPiece(const Bytes& bytes)
{
  const char* from = bytes.data();
  std::vector<std::size_t> sizes;
  TakeFrom(from, 2, sizes);
  Piece piece;
  TakeFrom(from, 3 * sizes[0], piece.Coordinates);
  TakeFrom(from, sizes[0], piece.Ids);
  TakeFrom(from, sizes[1], piece.Edges);
  return piece;
}

Error TooMany(std::size_t count)
{
  return Error("A rank would have " + std::to_string(count) + " points; at most " +
    std::to_string(MaximumNumberOfPoints) + " can be handled at once. Use more ranks.");
}

/** The work of one rank; the functions are its steps, in their order. */
class Work
{
public:
  Work(const Ranks& ranks, const DelaunayOptions& options, PointOwners&& owners, SurfacePart& part)
    : All(ranks)
    , Options(options)
    , Owners(std::move(owners))
    , Cell(this->Owners.CellOfRank(ranks.Own()))
    , Part(part)
    , First(part.Bases[ranks.Own()])
  {
  }

  void Settle();
  void SendTriangles();
  void FetchOthers();
  void Recover(const LinesOfRanks& lines);
  void PlaceCorners();

  Index NumberOfSeamPoints = 0;

private:
  Progress Watched(double begin, double end) const
  {
    return this->All.Watched(elevation::Part(this->Options.Monitor, begin, end));
  }
  void SettleOnGiven(const Progress& progress);
  bool SettleOn(const SharedLattice* lattice);
  bool IsByChance(const SharedLattice& lattice) const;
  void SettleOwn(const SharedLattice* lattice);
  bool JoinSeams(const SharedLattice* lattice);
  template <typename Step>
  void WatchLattice(const Step& step);
  DelaunayOptions OptionsWith(const Progress& progress) const;
  bool IsOffAnywhere(const SharedLattice* lattice) const;
  Point2 PlaceOf(GlobalId number) const;
  std::size_t CountOfCell() const { return this->Part.Result.Triangles.size() / 3; }
  GlobalTriangle CornersOf(std::size_t triangle) const;
  int RankOf(int cell) const { return this->Owners.RankOfCell[cell]; }

  const Ranks& All;
  const DelaunayOptions& Options;
  const PointOwners Owners;
  const int Cell; // that this rank owns, or -1
  SurfacePart& Part;
  const GlobalId First; // number of own points
  Piece Seam;
  bool IsOffLattice = false; // this rank's points are
  // This rank's triangles are those of its cell, in the result, where they are places, then these.
  std::vector<GlobalTriangle> Triangles;
  std::vector<ChangedTriangle> Changed; // of its cell
  std::vector<GlobalTriangle> OfSeams;  // settled by this rank for all
};

/** All triangles, on the lattice of all points if there is one. */
void Work::Settle()
{
  this->All.Agree([&]() {
    if (this->Part.Own.Count() > static_cast<std::size_t>(MaximumNumberOfPoints))
    {
      throw TooMany(this->Part.Own.Count());
    }
  });
  SharedLattice lattice;
  const Progress searching = elevation::Part(this->Options.Monitor, 0.15, 0.2);
  const bool isAsked = this->Options.UseLattice == LatticeMode::Automatic;
  if (isAsked && this->Options.GivenLattice.IsSet())
  {
    this->SettleOnGiven(searching);
  }
  else if (isAsked &&
    FindLatticeOnRanks(
      this->All, InOneSlice(ViewOf(this->Part.Own)), this->Options, searching, lattice) &&
    this->SettleOn(&lattice) && !this->IsByChance(lattice))
  {
    this->Part.Result.LatticeFound = true;
    this->Part.Result.Steps =
      FromLowestNode(this->All, InOneSlice(ViewOf(this->Part.Own)), lattice);
  }
  else
  {
    this->SettleOn(nullptr);
  }
}

/** The same on the lattice that is given. */
void Work::SettleOnGiven(const Progress& progress)
{
  SharedLattice lattice;
  const bool hasPoints = TakeGivenLattice(
    this->All, ViewOf(this->Part.Own), this->Part.Own.Ids, this->Options, progress, lattice);
  if (!this->SettleOn(hasPoints ? &lattice : nullptr))
  {
    throw GivenLatticeUnfit();
  }
  this->Part.Result.LatticeFound = true;
  this->Part.Result.Steps = hasPoints
    ? FromLowestNode(this->All, InOneSlice(ViewOf(this->Part.Own)), lattice)
    : lattice.Steps();
}

/** Whether so few points may fit a lattice by chance, or are all on one line of it. */
bool Work::IsByChance(const SharedLattice& lattice) const
{
  const std::size_t used = this->Part.Own.Count() - this->Part.Result.UnusedPoints.size();
  std::vector<vtkIdType> sums = { static_cast<vtkIdType>(used),
    static_cast<vtkIdType>(this->CountOfCell() + this->OfSeams.size()) };
  this->All.Sum(sums);
  return sums[1] == 0 || IsLatticeByChance(static_cast<double>(sums[0]), lattice.Tolerance());
}

/** @return false if not all points are on the lattice */
bool Work::SettleOn(const SharedLattice* lattice)
{
  this->Seam = Piece();
  this->IsOffLattice = false;
  this->OfSeams.clear();
  this->Part.Result = Triangulation();
  this->SettleOwn(lattice);
  return !this->IsOffAnywhere(lattice) && this->JoinSeams(lattice);
}

bool Work::IsOffAnywhere(const SharedLattice* lattice) const
{
  std::vector<vtkIdType> off = { this->IsOffLattice ? 1 : 0 };
  if (lattice)
  {
    this->All.Sum(off);
  }
  return off[0] > 0;
}

/** Does a step that ends where points are not on the lattice. */
template <typename Step>
void Work::WatchLattice(const Step& step)
{
  try
  {
    step();
  }
  catch (const NotOnLattice&)
  {
    this->IsOffLattice = true;
    this->Seam = Piece();
  }
}

DelaunayOptions Work::OptionsWith(const Progress& progress) const
{
  DelaunayOptions options = this->Options;
  options.Monitor = progress;
  return options;
}

void Work::SettleOwn(const SharedLattice* lattice)
{
  this->All.Agree([&]() {
    if (this->Cell < 0)
    {
      return;
    }
    this->WatchLattice([&]() {
      SettledCell settled = SettleCell(ViewOf(this->Part.Own), this->First,
        this->Owners.Plane.CellOf(this->Cell, this->Cell + 1),
        this->OptionsWith(this->Watched(0.2, 0.78)), lattice);
      this->Seam = std::move(settled.Seam);
      this->Part.Result = std::move(settled.Result);
    });
    this->NumberOfSeamPoints = this->Seam.Count();
  });
}

bool Work::JoinSeams(const SharedLattice* lattice)
{
  const int count = this->Owners.Plane.Count();
  int levels = 0;
  while ((1 << levels) < count)
  {
    ++levels;
  }
  for (int level = levels - 1; level >= 0; --level)
  {
    const Node node = NodeOf(std::max(0, this->Cell), level, count);
    const bool isCut = node.Size() > 1;
    std::vector<Bytes> packed(this->All.Count());
    this->All.Agree([&]() {
      if (isCut && this->Cell == node.Middle())
      {
        packed[this->RankOf(node.Begin)] = PackPiece(this->Seam);
        this->Seam = Piece();
      }
    });
    packed = this->All.Exchange(std::move(packed));
    this->All.Agree([&]() {
      if (isCut && this->Cell == node.Begin)
      {
        const double step = 0.12 / levels, begin = 0.78 + step * (levels - 1 - level);
        const Progress progress = this->Watched(begin, begin + step);
        const Piece joined =
          Join(std::move(this->Seam), UnpackPiece(packed[this->RankOf(node.Middle())]));
        this->WatchLattice([&]() {
          this->Seam = SettleSeams(joined, this->Owners.Plane.CellOf(node.Begin, node.End),
            this->OptionsWith(progress), this->OfSeams, lattice);
        });
      }
    });
    if (this->IsOffAnywhere(lattice))
    {
      return false;
    }
  }
  return true;
}

void Work::SendTriangles()
{
  std::vector<Bytes> packed(this->All.Count());
  this->All.Agree([&]() {
    std::vector<std::vector<GlobalTriangle>> ofRanks(packed.size());
    for (const GlobalTriangle& triangle : this->OfSeams)
    {
      ofRanks[this->Part.OwnerOf(triangle[0])].push_back(triangle);
    }
    std::transform(ofRanks.begin(), ofRanks.end(), packed.begin(), [](const auto& triangles) {
      Bytes bytes;
      AppendTo(bytes, triangles);
      return bytes;
    });
  });
  packed = this->All.Exchange(std::move(packed));
  this->All.Agree([&]() {
    std::vector<GlobalTriangle> triangles;
    for (const Bytes& bytes : packed)
    {
      const char* from = bytes.data();
      TakeFrom(from, bytes.size() / sizeof(GlobalTriangle), triangles);
      this->Triangles.insert(this->Triangles.end(), triangles.begin(), triangles.end());
    }
    ListOthers(this->Triangles, this->First, this->Part);
  });
}

/** The place of a corner of this rank's triangles. */
Point2 Work::PlaceOf(GlobalId number) const
{
  return this->Part.PointAt(this->Part.PlaceOf(number, this->First));
}

/** The numbers of the corners of one of this rank's triangles. */
GlobalTriangle Work::CornersOf(std::size_t triangle) const
{
  const std::size_t ofCell = this->CountOfCell();
  if (triangle >= ofCell)
  {
    return this->Triangles[triangle - ofCell];
  }
  const Index* const c = this->Part.Result.Triangles.data() + 3 * triangle;
  return { this->First + c[0], this->First + c[1], this->First + c[2] };
}

/** Makes the pieces of lines edges. */
void Work::Recover(const LinesOfRanks& lines)
{
  const TrianglesOfRank own = { this->CountOfCell() + this->Triangles.size(),
    [this](std::size_t triangle) { return this->CornersOf(triangle); },
    [this](GlobalId number) { return this->PlaceOf(number); } };
  const std::vector<ChangedTriangle> changed = RecoverLines(
    this->All, lines, this->RankOf(0), own, elevation::Part(this->Options.Monitor, 0.9, 0.92));
  this->All.Agree([&]() {
    std::vector<GlobalTriangle> mayHaveOthers;
    for (const ChangedTriangle& triangle : changed)
    {
      if (triangle.Place < this->CountOfCell())
      {
        this->Changed.push_back(triangle);
        mayHaveOthers.push_back(triangle.Corners);
        continue;
      }
      this->Triangles[triangle.Place - this->CountOfCell()] = triangle.Corners;
    }
    mayHaveOthers.insert(mayHaveOthers.end(), this->Triangles.begin(), this->Triangles.end());
    ListOthers(mayHaveOthers, this->First, this->Part);
    this->Part.Others = PointRows(this->Part.Kinds);
  });
  this->FetchOthers();
}

void Work::FetchOthers()
{
  std::vector<Bytes> packed(this->All.Count());
  this->All.Agree([&]() {
    std::vector<std::vector<vtkIdType>> places(packed.size());
    for (const GlobalId id : this->Part.OtherNumbers)
    {
      const int owner = this->Part.OwnerOf(id);
      places[owner].push_back(id - this->Part.Bases[owner]);
    }
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      AppendTo(packed[i], places[i]);
    }
  });
  packed = this->All.Exchange(std::move(packed));
  this->All.Agree([&]() {
    std::vector<vtkIdType> places;
    for (Bytes& bytes : packed)
    {
      const char* from = bytes.data();
      TakeFrom(from, bytes.size() / sizeof(vtkIdType), places);
      bytes = places.empty() ? Bytes() : this->Part.Own.Pack(places);
    }
  });
  packed = this->All.Exchange(std::move(packed));
  this->All.Agree([&]() {
    this->Part.Others.Unpack(packed);
    const std::size_t count = this->Part.Own.Count() + this->Part.Others.Count();
    if (count > static_cast<std::size_t>(MaximumNumberOfPoints))
    {
      throw TooMany(count);
    }
  });
}

/** The corners of the triangles as places of the rank's points. */
void Work::PlaceCorners()
{
  this->All.Agree([&]() {
    for (const ChangedTriangle& changed : this->Changed)
    {
      std::transform(changed.Corners.begin(), changed.Corners.end(),
        this->Part.Result.Triangles.data() + 3 * changed.Place, [this](GlobalId number) {
          return static_cast<Index>(this->Part.PlaceOf(number, this->First));
        });
    }
    AppendTriangles(this->Triangles, this->First, this->Watched(0.92, 0.95), this->Part);
    this->Triangles = std::vector<GlobalTriangle>();
  });
}
} // namespace

DistributedSurface TriangulateOnRanks(const Ranks& ranks, const PointsOfRank& points,
  vtkPolyData* constraints, DelaunayOptions options, std::vector<Message>& warnings)
{
  DistributedSurface surface;
  SurfacePart& part = surface.Part;
  const Progress first = Part(options.Monitor, 0.0, 0.15), last = Part(options.Monitor, 0.95, 1.0);
  PointOwners owners = BringToOwners(ranks, points, first, part);
  LinesOfRanks lines;
  if (constraints)
  {
    const Progress cutting = Part(options.Monitor, 0.14, 0.15);
    lines = AddLines(ranks, constraints, owners, options, cutting, part, warnings);
    options.UseLattice = LatticeMode::Off;
    surface.NumberOfCrossings = lines.NumberOfCrossings;
    surface.NumberOfAddedPoints = lines.NumberOfOwnPoints;
  }
  Work work(ranks, options, std::move(owners), part);
  work.Settle();
  surface.NumberOfOwnPoints = static_cast<Index>(part.Own.Count());
  surface.NumberOfSeamPoints = work.NumberOfSeamPoints;
  work.SendTriangles();
  work.FetchOthers();
  if (constraints)
  {
    work.Recover(lines);
  }
  work.PlaceCorners();
  std::vector<vtkIdType> sums = { static_cast<vtkIdType>(part.Own.Count()) -
      surface.NumberOfAddedPoints,
    static_cast<vtkIdType>(part.Result.Triangles.size() / 3) };
  ranks.Sum(sums);
  surface.NumberOfPoints = sums[0];
  surface.NumberOfTriangles = sums[1];
  if (options.MaximumEdgeLength > 0.0)
  {
    surface.Effect = LimitEdges(ranks, options.MaximumEdgeLength, last, part);
  }
  ranks.Agree([&]() {
    KeepCorners(part);
    Report(ranks.Watched(options.Monitor), 1.0);
  });
  return surface;
}

void AddWork(
  const Ranks::Traffic& traffic, const DistributedSurface& surface, vtkFieldData* fieldData)
{
  vtkNew<vtkIdTypeArray> work;
  work->SetName("WorkOfRank");
  work->SetNumberOfComponents(4);
  const char* const names[] = { "OwnPoints", "SeamPoints", "BytesSent", "Exchanges" };
  const vtkIdType values[] = { surface.NumberOfOwnPoints, surface.NumberOfSeamPoints,
    traffic.BytesSent, traffic.Rounds };
  for (int i = 0; i < 4; ++i)
  {
    work->SetComponentName(i, names[i]);
    work->InsertNextValue(values[i]);
  }
  fieldData->AddArray(work);
}

} // namespace elevation
