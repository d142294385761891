// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * How the passes of TriangulateParts.h use the boxes of a part (Engine.h):
 *
 *   box        what is in it                          written by           read by
 *   OwnPoints  rows of points                         pass 1               2, 5, 6 and Take()
 *   Settled    unused points; then corners, as        pass 2, in files     6 and Take()
 *              places among the own points
 *   FromSeams  in pass 3, the seam of the other half  the other half       3
 *              of a cell; then triangles, by numbers  pass 4               5, 6 and Take()
 *   Requests   the part that asks, and places         pass 5               5, 6
 *   Corners    rows of points of other parts          pass 5               Take()
 *   Covered    places with a triangle elsewhere       pass 6               6
 *
 * In memory a rank has one part, and its state is not packed: OwnPoints and Corners are unpacked when
 * they come, what is settled stays where it has been made, and triangles from seams are listed once.
 * In files nothing of a part is in memory between the steps.
 */
#include "TriangulateParts.h"

#include "ConstraintsOfRanks.h"
#include "Kernel/Base/Base.h"
#include "LatticeOfRanks.h"

#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace elevation
{

namespace
{
/** The boxes of a part, and the names of their files; what is not named is small. */
enum BoxOfPart
{
  OwnPoints,
  Settled,
  FromSeams,
  Corners,
  Requests,
  Covered
};
const std::vector<std::string> NamesOfBoxes = { "points", "triangles", "seams", "corners", "", "" };

/** A seam on its way to the part that joins it with its own. */
Bytes PackPiece(const Piece& piece)
{
  Bytes bytes;
  AppendList(bytes, piece.Coordinates);
  AppendList(bytes, piece.Ids);
  AppendList(bytes, piece.Edges);
  return bytes;
}

Piece UnpackPiece(const Bytes& bytes)
{
  const char* from = bytes.data();
  Piece piece;
  TakeList(from, piece.Coordinates);
  TakeList(from, piece.Ids);
  TakeList(from, piece.Edges);
  return piece;
}

/** All values that have been sent, one after another. */
template <typename Value>
std::vector<Value> ValuesIn(const Inbox& box)
{
  std::vector<Value> values;
  box.ForEach([&values](const Bytes& bytes) {
    const char* from = bytes.data();
    const std::size_t before = values.size(), count = bytes.size() / sizeof(Value);
    values.resize(before + count);
    TakeFrom(from, values.data() + before, count);
  });
  return values;
}

/** What goes to each part; parts in their order. */
template <typename Value>
using ValuesForParts = std::map<int, std::vector<Value>>;

template <typename Value>
void SendAll(Engine& engine, int box, const ValuesForParts<Value>& values)
{
  for (const auto& ofPart : values)
  {
    Bytes bytes;
    AppendTo(bytes, ofPart.second);
    engine.Send(ofPart.first, box, std::move(bytes));
  }
}

/** The corners of the triangles without an edge longer than a limit, in their order. */
Buffer<Index> WithinLimit(double length, const SurfacePart& part, const Progress& progress)
{
  const EdgeLimit limit(length);
  const auto pointOf = [&part](Index place) { return part.PointAt(place); };
  const Buffer<Index>& corners = part.Result.Triangles;
  Buffer<Index> kept;
  for (std::size_t i = 0; i < corners.size(); i += 3)
  {
    ReportStep(progress, i / 3, corners.size() / 3, 1 << 16);
    if (limit.Admits(pointOf, corners[i], corners[i + 1], corners[i + 2]))
    {
      std::for_each(
        corners.data() + i, corners.data() + i + 3, [&kept](Index corner) { kept.Append(corner); });
    }
  }
  return kept;
}
} // namespace

/**
 * A node of the tree of cells (Cuts.h): cells [Begin, End), which have the numbers of their parts. What
 * is done for a node is done by its first part, which has the seam of its lower half already.
 */
struct TriangulateParts::Node
{
  int Begin, End;

  int Size() const { return this->End - this->Begin; }
  int Middle() const { return Cuts::MiddleOf(this->Begin, this->End); }

  /** That of a cell some levels below the whole plane, or the cell itself. */
  static Node Of(int cell, int level, int count)
  {
    Node node{ 0, count };
    for (; level > 0 && node.Size() > 1; --level)
    {
      const int middle = node.Middle();
      (cell < middle ? node.End : node.Begin) = middle;
    }
    return node;
  }

  /** How often the plane is cut, at most, until there are so many cells. */
  static int Levels(int count)
  {
    int levels = 0;
    while ((1 << levels) < count)
    {
      ++levels;
    }
    return levels;
  }

  /** Whether its seams are joined without a message. */
  bool IsWithinRank(const Engine& engine) const
  {
    return engine.RankOf(this->Begin) == engine.RankOf(this->End - 1);
  }
};

TriangulateParts::TriangulateParts(const Ranks& ranks, const std::string& folder)
  : Everybody(ranks)
  , Folder(folder)
  , Source(ranks, folder)
{
}

TriangulateParts::~TriangulateParts() = default;

void TriangulateParts::Add(vtkPointSet* points, const Progress& progress)
{
  this->Source.Add(points, progress);
}

void TriangulateParts::Triangulate(int ownParts, vtkPolyData* constraints,
  const DelaunayOptions& options, std::vector<std::string>& warnings)
{
  this->Options = options;
  this->Crew = std::make_unique<Engine>(this->Everybody, ownParts, NamesOfBoxes, this->Folder);
  std::vector<vtkIdType> counts;
  this->Plane = std::make_unique<Cuts>(
    this->Source.Distribute(*this->Crew, OwnPoints, this->Fraction(0.0, 0.1), this->Part, counts));
  this->NumberParts(std::move(counts), this->Fraction(0.1, 0.15));
  LinesOfRanks lines;
  if (constraints)
  {
    lines = AddLines(*this->Crew, constraints, *this->Plane, this->Options,
      this->Fraction(0.14, 0.15), this->Part, warnings);
    this->Options.UseLattice = LatticeMode::Off;
    this->Total.Crossings = lines.NumberOfCrossings;
    this->Work.AddedPoints = lines.NumberOfOwnPoints;
  }
  this->CheckCounts();
  this->SettleOnAnyLattice();
  this->SendTriangles();
  this->FetchOthers();
  if (constraints)
  {
    this->Recover(lines);
  }
  if (!this->Crew->IsInFiles())
  {
    this->PlaceCorners();
  }
  if (this->Options.MaximumEdgeLength > 0.0)
  {
    this->LimitEdges(this->Fraction(0.95, 1.0));
  }
  this->Everybody.Agree([&]() {
    KeepCorners(this->Part);
    Report(this->Everybody.Watched(this->Options.Monitor), 1.0);
  });
}

// Parts in memory and in files

/**
 * Sets the numbers of the points of all parts: part after part, and within a part in the order of ids.
 * @param[in] counts  of the points that this rank has sent to each part
 */
void TriangulateParts::NumberParts(std::vector<vtkIdType>&& counts, const Progress& progress)
{
  this->Part.Own = PointRows(this->Part.Kinds);
  this->Part.Others = PointRows(this->Part.Kinds);
  if (!this->Crew->IsInFiles())
  {
    // Points that came twice count once.
    std::fill(counts.begin(), counts.end(), 0);
    this->Crew->ForEach(progress, [&](int part, const Progress& ofPart) {
      Report(ofPart, 0.0);
      this->Part.Own.Unpack(this->Crew->At(part, OwnPoints).Take());
      Report(ofPart, 0.5);
      SortOwn(this->Part);
      counts[part] = static_cast<vtkIdType>(this->Part.Own.Count());
    });
  }
  this->Everybody.Sum(counts);
  this->Part.Bases.assign(1, 0);
  std::partial_sum(counts.begin(), counts.end(), std::back_inserter(this->Part.Bases));
}

/** No part may have more points than an Index counts. */
void TriangulateParts::CheckCounts() const
{
  this->Crew->ForEach(Progress(), [this](int part, const Progress&) {
    this->CheckCount(static_cast<std::size_t>(this->CountOf(part)));
  });
}

void TriangulateParts::CheckCount(std::size_t count) const
{
  if (count > static_cast<std::size_t>(MaximumNumberOfPoints))
  {
    const bool isPiece = this->Crew->IsInFiles();
    throw Error(std::string(isPiece ? "A piece" : "A rank") + " would have " +
      std::to_string(count) + " points; at most " + std::to_string(MaximumNumberOfPoints) +
      " can be handled at once. Use more " + (isPiece ? "pieces." : "ranks."));
  }
}

/**
 * The points that a part owns, from its files. With several ranks these are in the order in which
 * slices came; numbers are places in the order of ids, so that is made again.
 */
SurfacePart TriangulateParts::ReadOwn(int part, const Progress& progress) const
{
  SurfacePart read;
  read.Kinds = this->Part.Kinds;
  read.NameOfIds = this->Part.NameOfIds;
  read.TypeOfPoints = this->Part.TypeOfPoints;
  read.Bases = this->Part.Bases;
  read.Own = PointRows(read.Kinds);
  read.Others = PointRows(read.Kinds);
  read.Own.Unpack(this->Crew->At(part, OwnPoints).Copy(progress));
  SortOwn(read);
  return read;
}

/** Does a step with the points that a part owns. What the step changes stays only in memory. */
template <typename Step>
void TriangulateParts::WithOwn(int part, const Progress& progress, const Step& step)
{
  if (!this->Crew->IsInFiles())
  {
    step(this->Part);
    return;
  }
  SurfacePart read = this->ReadOwn(part, progress);
  step(read);
}

/** Writes what the cell of a part settles, in files; corners as they are, without a copy. */
void TriangulateParts::KeepSettled(int part, const Triangulation& settled)
{
  if (this->Crew->IsInFiles())
  {
    Bytes unused;
    const Index counts[] = { settled.NumberOfDuplicates, settled.NumberOfNotFinite };
    AppendTo(unused, counts, 2);
    AppendList(unused, settled.UnusedPoints);
    AppendList(unused, settled.UnusedReasons);
    Inbox& box = this->Crew->At(part, Settled);
    box.Append(std::move(unused));
    box.Append(settled.Triangles.data(), settled.Triangles.size() * sizeof(Index));
  }
}

/**
 * A whole part, from its files: own points, triangles of its cell and of seams, and the corners that
 * these have in other parts; without a limit of edges.
 */
SurfacePart TriangulateParts::ReadWhole(int part, const Progress& progress) const
{
  SurfacePart read = this->ReadOwn(part, elevation::Part(progress, 0.0, 0.3));
  Report(progress, 0.3);
  bool isFirst = true;
  this->Crew->At(part, Settled).ForEach([&](const Bytes& bytes) {
    const char* from = bytes.data();
    Triangulation& result = read.Result;
    if (!std::exchange(isFirst, false))
    {
      result.Triangles.Resize(bytes.size() / sizeof(Index));
      TakeFrom(from, result.Triangles.data(), result.Triangles.size());
      return;
    }
    TakeFrom(from, &result.NumberOfDuplicates, 1);
    TakeFrom(from, &result.NumberOfNotFinite, 1);
    TakeList(from, result.UnusedPoints);
    TakeList(from, result.UnusedReasons);
  });
  const auto fromSeams = ValuesIn<GlobalTriangle>(this->Crew->At(part, FromSeams));
  const GlobalId first = read.Bases[part];
  read.OtherNumbers = ListOthers(fromSeams, first, read.Bases[part + 1]);
  read.Others.Unpack(this->Crew->At(part, Corners).Copy());
  this->CheckCount(read.Own.Count() + read.Others.Count());
  AppendTriangles(fromSeams, first, elevation::Part(progress, 0.6, 1.0), read);
  return read;
}

SurfacePart TriangulateParts::Take(int part, const Progress& progress)
{
  SurfacePart taken;
  if (!this->Crew->IsInFiles())
  {
    taken = std::move(this->Part);
  }
  else
  {
    taken = this->ReadWhole(part, elevation::Part(progress, 0.0, 0.7));
    if (this->Options.MaximumEdgeLength > 0.0)
    {
      taken.Result.Triangles =
        WithinLimit(this->Options.MaximumEdgeLength, taken, elevation::Part(progress, 0.7, 1.0));
    }
    KeepCorners(taken);
  }
  taken.Result.LatticeFound = this->Total.LatticeFound;
  taken.Result.Steps = this->Total.Steps;
  return taken;
}

/** The points of this rank, part after part, without holding more than a stretch from files. */
PointSlices TriangulateParts::Slices() const
{
  const int first = this->Crew->FirstOwn(), end = this->Crew->EndOwn();
  const double count = static_cast<double>(this->Part.Bases[end] - this->Part.Bases[first]);
  return { count, [this, first, end](const auto& visit) {
            for (int part = first; part < end; ++part)
            {
              if (!this->Crew->IsInFiles())
              {
                visit(ViewOf(this->Part.Own));
                continue;
              }
              this->Crew->At(part, OwnPoints).ForEach([&](const Bytes& bytes) {
                PointRows rows(this->Part.Kinds);
                rows.Unpack(&bytes, 1);
                visit(ViewOf(rows));
              });
            }
          } };
}

DelaunayOptions TriangulateParts::OptionsWith(const Progress& progress) const
{
  DelaunayOptions options = this->Options;
  options.Monitor = progress;
  return options;
}

// Passes 2 and 3

/**
 * All triangles, on the lattice of all points if there is one. A lattice that is found may turn out
 * not to be one, when a point lies beside it or few points fit by chance: then all is done again
 * without it.
 */
void TriangulateParts::SettleOnAnyLattice()
{
  SharedLattice lattice;
  const Progress searching = this->Fraction(0.15, 0.2);
  const bool isAsked = this->Options.UseLattice == LatticeMode::Automatic;
  if (isAsked && this->Options.GivenLattice.IsSet())
  {
    this->SettleOnGiven(searching);
  }
  else if (isAsked &&
    FindLatticeOnRanks(this->Everybody, this->Slices(), this->Options, searching, lattice) &&
    this->SettleOn(&lattice) && !this->IsByChance(lattice))
  {
    this->Total.LatticeFound = true;
    this->Total.Steps = FromLowestNode(this->Everybody, this->Slices(), lattice);
  }
  else
  {
    this->SettleOn(nullptr);
  }
  std::vector<vtkIdType> sums = { this->Total.Duplicates, this->Total.NotFinite,
    this->Total.Settled + static_cast<vtkIdType>(this->OfSeams.size()), this->Work.AddedPoints };
  this->Everybody.Sum(sums);
  this->Total.Points = this->Part.Bases.back() - sums[3];
  this->Total.Duplicates = sums[0];
  this->Total.NotFinite = sums[1];
  this->Total.Settled = this->Total.Triangles = sums[2];
  const int first = this->Crew->FirstOwn(), end = this->Crew->EndOwn();
  this->Work.Points = static_cast<Index>(this->Part.Bases[end] - this->Part.Bases[first]);
}

/** The same on the lattice that is given, for parts in memory. */
void TriangulateParts::SettleOnGiven(const Progress& progress)
{
  SharedLattice lattice;
  const bool hasPoints = TakeGivenLattice(
    this->Everybody, ViewOf(this->Part.Own), this->Part.Own.Ids, this->Options, progress, lattice);
  if (!this->SettleOn(hasPoints ? &lattice : nullptr))
  {
    throw GivenLatticeUnfit();
  }
  this->Total.LatticeFound = true;
  this->Total.Steps =
    hasPoints ? FromLowestNode(this->Everybody, this->Slices(), lattice) : lattice.Steps();
}

/** Whether so few points may fit a lattice by chance, or are all on one line of it. */
bool TriangulateParts::IsByChance(const SharedLattice& lattice) const
{
  const int first = this->Crew->FirstOwn(), end = this->Crew->EndOwn();
  std::vector<vtkIdType> sums = { this->Part.Bases[end] - this->Part.Bases[first] -
      this->Total.Duplicates - this->Total.NotFinite,
    this->Total.Settled + static_cast<vtkIdType>(this->OfSeams.size()) };
  this->Everybody.Sum(sums);
  return sums[1] == 0 || IsLatticeByChance(static_cast<double>(sums[0]), lattice.Tolerance());
}

/**
 * Settles each cell, and joins the seams up to the whole plane. What an attempt before has left is
 * forgotten.
 * @return false if not all points are on the lattice; the same on all ranks
 */
bool TriangulateParts::SettleOn(const SharedLattice* lattice)
{
  this->Seams.clear();
  this->OfSeams.clear();
  this->Part.Result = Triangulation();
  this->Total = Totals{ 0, 0, 0, 0, 0, {}, this->Total.Crossings, false, {} };
  this->Work.SeamPoints = 0;
  this->IsOffLattice = false;
  this->Crew->ForEach(this->Fraction(0.2, 0.78), [&](int part, const Progress& progress) {
    this->Crew->At(part, Settled).Clear();
    this->WatchLattice([&]() { this->SettlePart(part, lattice, progress); });
  });
  return !this->IsOffAnywhere(lattice) && this->JoinSeams(lattice);
}

bool TriangulateParts::IsOffAnywhere(const SharedLattice* lattice) const
{
  return lattice && IsOnAny(this->Everybody, this->IsOffLattice);
}

/** Does a step, unless a point of this rank is known not to be on the lattice. */
template <typename Step>
void TriangulateParts::WatchLattice(const Step& step)
{
  try
  {
    if (!this->IsOffLattice)
    {
      step();
    }
  }
  catch (const NotOnLattice&)
  {
    this->IsOffLattice = true;
  }
}

/**
 * Settles what the cell of a part can, and then the larger cells that it completes on this rank: those
 * that end with this part, from the smallest. So parts in their order go through the tree depth first,
 * and this rank has no more seams at a time than the tree has levels.
 */
void TriangulateParts::SettlePart(int part, const SharedLattice* lattice, const Progress& progress)
{
  const Progress reading = elevation::Part(progress, 0.0, 0.0);
  this->WithOwn(part, reading, [&](SurfacePart& own) {
    SettledCell settled = SettleCell(ViewOf(own.Own), this->Part.Bases[part],
      this->Plane->CellOf(part, part + 1), this->OptionsWith(progress), lattice);
    own.Result = std::move(settled.Result);
    this->KeepSettled(part, own.Result);
    this->Total.Settled += static_cast<vtkIdType>(own.Result.Triangles.size() / 3);
    this->Total.Duplicates += own.Result.NumberOfDuplicates;
    this->Total.NotFinite += own.Result.NumberOfNotFinite;
    this->Work.SeamPoints += settled.Seam.Count();
    this->Seams[part] = std::move(settled.Seam);
  });
  const int count = this->Crew->CountOfParts();
  const Progress last = elevation::Part(progress, 1.0, 1.0);
  for (int level = Node::Levels(count) - 1; level >= 0; --level)
  {
    const Node node = Node::Of(part, level, count);
    if (node.Size() > 1 && node.End == part + 1 && node.IsWithinRank(*this->Crew))
    {
      const Piece other = std::move(this->Seams[node.Middle()]);
      this->Seams.erase(node.Middle());
      this->SettleNode(node, other, lattice, last);
    }
  }
}

/** Settles what a larger cell can, of whose halves the seams are known. */
void TriangulateParts::SettleNode(
  const Node& node, const Piece& other, const SharedLattice* lattice, const Progress& progress)
{
  Piece& seam = this->Seams[node.Begin];
  const Piece joined = Join(std::move(seam), other);
  seam = SettleSeams(joined, this->Plane->CellOf(node.Begin, node.End), this->OptionsWith(progress),
    this->OfSeams, lattice);
}

/**
 * The same for all cells that several ranks hold, level by level. At each level the seam of the upper
 * half goes to the part that has that of the lower one.
 */
bool TriangulateParts::JoinSeams(const SharedLattice* lattice)
{
  const int count = this->Crew->CountOfParts(), levels = Node::Levels(count);
  for (int level = levels - 1; level >= 0; --level)
  {
    const auto isJoined = [&](const Node& node) {
      return node.Size() > 1 && !node.IsWithinRank(*this->Crew);
    };
    this->Crew->ForEach(Progress(), [&](int part, const Progress&) {
      const Node node = Node::Of(part, level, count);
      if (isJoined(node) && part == node.Middle())
      {
        this->Crew->Send(node.Begin, FromSeams, PackPiece(this->Seams[part]));
        this->Seams.erase(part);
      }
    });
    if (this->Everybody.Count() > 1)
    {
      this->Crew->Deliver();
    }
    const double step = 0.12 / levels, begin = 0.78 + step * (levels - 1 - level);
    this->Crew->ForEach(
      this->Fraction(begin, begin + step), [&](int part, const Progress& progress) {
        const Node node = Node::Of(part, level, count);
        if (isJoined(node) && part == node.Begin)
        {
          const Piece other = UnpackPiece(this->Crew->At(part, FromSeams).Take().at(0));
          this->WatchLattice([&]() { this->SettleNode(node, other, lattice, progress); });
        }
      });
    if (this->IsOffAnywhere(lattice))
    {
      return false;
    }
  }
  this->Seams.clear();
  return true;
}

// Passes 4 and 5

/** A triangle that seams have settled belongs to the part of its lowest corner. */
void TriangulateParts::SendTriangles()
{
  this->Everybody.Agree([&]() {
    ValuesForParts<GlobalTriangle> triangles;
    for (const GlobalTriangle& triangle : this->OfSeams)
    {
      triangles[this->Part.OwnerOf(triangle[0])].push_back(triangle);
    }
    this->OfSeams = std::vector<GlobalTriangle>();
    SendAll(*this->Crew, FromSeams, triangles);
  });
  this->Crew->Deliver();
  if (!this->Crew->IsInFiles())
  {
    this->Crew->ForEach(Progress(), [this](int part, const Progress&) {
      this->Triangles = ValuesIn<GlobalTriangle>(this->Crew->At(part, FromSeams));
      this->Crew->At(part, FromSeams).Clear();
      this->Part.OtherNumbers =
        ListOthers(this->Triangles, this->Part.Bases[part], this->Part.Bases[part + 1]);
    });
  }
}

/**
 * Corners that are points of other parts come with their values: each part asks those that own them
 * by places, and gets rows in the order of numbers, as parts answer in their order. A part in files is
 * read for this once, if any other asks it.
 */
void TriangulateParts::FetchOthers()
{
  this->Crew->ForEach(Progress(), [this](int part, const Progress&) {
    this->Crew->At(part, Requests).Clear();
    const std::vector<GlobalId> numbers = !this->Crew->IsInFiles()
      ? this->Part.OtherNumbers
      : ListOthers(ValuesIn<GlobalTriangle>(this->Crew->At(part, FromSeams)),
          this->Part.Bases[part], this->Part.Bases[part + 1]);
    ValuesForParts<vtkIdType> places;
    for (const GlobalId number : numbers)
    {
      const int owner = this->Part.OwnerOf(number);
      std::vector<vtkIdType>& ofOwner = places[owner];
      if (ofOwner.empty())
      {
        ofOwner.push_back(part);
      }
      ofOwner.push_back(number - this->Part.Bases[owner]);
    }
    SendAll(*this->Crew, Requests, places);
  });
  this->Crew->Deliver();
  this->Crew->ForEach(this->Fraction(0.9, 0.9), [this](int part, const Progress& progress) {
    const Inbox& requests = this->Crew->At(part, Requests);
    if (requests.IsEmpty())
    {
      return;
    }
    this->WithOwn(part, progress, [&](const SurfacePart& own) {
      requests.ForEach([&](const Bytes& bytes) {
        const char* from = bytes.data();
        vtkIdType asking = 0;
        std::vector<vtkIdType> places;
        TakeFrom(from, &asking, 1);
        TakeFrom(from, bytes.size() / sizeof(vtkIdType) - 1, places);
        this->Crew->Send(static_cast<int>(asking), Corners, own.Own.Pack(places));
      });
    });
  });
  this->Crew->Deliver();
  if (!this->Crew->IsInFiles())
  {
    this->Crew->ForEach(Progress(), [this](int part, const Progress&) {
      this->Part.Others.Unpack(this->Crew->At(part, Corners).Take());
      this->CheckCount(this->Part.Own.Count() + this->Part.Others.Count());
    });
  }
}

// Pass 6

/** The numbers of the corners of a triangle of the part in memory: those of its cell come first. */
GlobalTriangle TriangulateParts::CornersOf(std::size_t triangle) const
{
  const std::size_t ofCell = this->Part.Result.Triangles.size() / 3;
  if (triangle >= ofCell)
  {
    return this->Triangles[triangle - ofCell];
  }
  const GlobalId first = this->Part.Bases[this->Crew->FirstOwn()];
  const Index* const c = this->Part.Result.Triangles.data() + 3 * triangle;
  return { first + c[0], first + c[1], first + c[2] };
}

/**
 * Makes the pieces of lines edges, in memory. The triangles that change may get corners that this part
 * has not had, so all others are fetched again.
 */
void TriangulateParts::Recover(const LinesOfRanks& lines)
{
  const int first = this->Crew->FirstOwn(), end = this->Crew->EndOwn();
  const std::vector<vtkIdType>& bases = this->Part.Bases;
  const std::size_t ofCell = this->Part.Result.Triangles.size() / 3;
  const TrianglesOfRank own = { ofCell + this->Triangles.size(),
    [this](std::size_t triangle) { return this->CornersOf(triangle); },
    [&](GlobalId number) { return this->Part.PointAt(this->Part.PlaceOf(number, bases[first])); } };
  const std::vector<ChangedTriangle> changed =
    RecoverLines(this->Everybody, lines, this->Crew->RankOf(0), own, this->Fraction(0.9, 0.92));
  this->Everybody.Agree([&]() {
    std::vector<GlobalTriangle> mayHaveOthers;
    for (const ChangedTriangle& triangle : changed)
    {
      if (triangle.Place < ofCell)
      {
        this->Changed.push_back(triangle);
        mayHaveOthers.push_back(triangle.Corners);
        continue;
      }
      this->Triangles[triangle.Place - ofCell] = triangle.Corners;
    }
    mayHaveOthers.insert(mayHaveOthers.end(), this->Triangles.begin(), this->Triangles.end());
    this->Part.OtherNumbers = ListOthers(mayHaveOthers, bases[first], bases[end]);
    this->Part.Others = PointRows(this->Part.Kinds);
  });
  this->FetchOthers();
}

/** The corners of all triangles of the part in memory as places of its points, own ones first. */
void TriangulateParts::PlaceCorners()
{
  this->Everybody.Agree([&]() {
    const GlobalId first = this->Part.Bases[this->Crew->FirstOwn()];
    for (const ChangedTriangle& changed : this->Changed)
    {
      std::transform(changed.Corners.begin(), changed.Corners.end(),
        this->Part.Result.Triangles.data() + 3 * changed.Place,
        [&](GlobalId number) { return static_cast<Index>(this->Part.PlaceOf(number, first)); });
    }
    AppendTriangles(
      this->Triangles, first, this->Everybody.Watched(this->Fraction(0.92, 0.95)), this->Part);
    this->Triangles = std::vector<GlobalTriangle>();
  });
}

/**
 * Leaves out triangles with a longer edge, and counts the vertices without one. Whether a point that
 * another part has asked for is such a vertex is known when all parts have said where they have
 * triangles.
 */
void TriangulateParts::LimitEdges(const Progress& progress)
{
  Buffer<Index> kept;                         // of the part in memory
  std::map<int, std::vector<vtkIdType>> open; // places without a triangle yet, of each part
  std::vector<vtkIdType> sums(2, 0);          // triangles, and vertices without one
  this->Crew->ForEach(progress, [&](int part, const Progress& ofPart) {
    const auto measure = [&](const SurfacePart& whole) {
      kept = WithinLimit(this->Options.MaximumEdgeLength, whole, elevation::Part(ofPart, 0.5, 1.0));
      const std::size_t ownCount = whole.Own.Count();
      std::vector<char> areMissing(ownCount + whole.Others.Count(), 1);
      for (const Index corner : kept)
      {
        areMissing[corner] = 0;
      }
      for (const Index unused : whole.Result.UnusedPoints)
      {
        areMissing[unused] = 0;
      }
      ValuesForParts<vtkIdType> covered;
      for (std::size_t i = 0; i < whole.OtherNumbers.size(); ++i)
      {
        if (!areMissing[ownCount + i])
        {
          const int owner = whole.OwnerOf(whole.OtherNumbers[i]);
          covered[owner].push_back(whole.OtherNumbers[i] - whole.Bases[owner]);
        }
      }
      SendAll(*this->Crew, Covered, covered);
      this->Crew->At(part, Requests).ForEach([&](const Bytes& bytes) {
        const char* from = bytes.data() + sizeof(vtkIdType); // beyond the part that asks
        std::vector<vtkIdType> places;
        TakeFrom(from, bytes.size() / sizeof(vtkIdType) - 1, places);
        for (const vtkIdType place : places)
        {
          if (std::exchange(areMissing[place], 0))
          {
            open[part].push_back(place);
          }
        }
      });
      sums[0] += static_cast<vtkIdType>(kept.size() / 3);
      sums[1] += std::count(areMissing.begin(), areMissing.begin() + ownCount, char(1));
    };
    this->Crew->IsInFiles() ? measure(this->ReadWhole(part, elevation::Part(ofPart, 0.0, 0.5)))
                            : measure(this->Part);
  });
  this->Crew->Deliver();
  this->Crew->ForEach(Progress(), [&](int part, const Progress&) {
    std::vector<vtkIdType> covered = ValuesIn<vtkIdType>(this->Crew->At(part, Covered));
    this->Crew->At(part, Covered).Clear();
    std::sort(covered.begin(), covered.end());
    sums[1] += std::count_if(open[part].begin(), open[part].end(),
      [&](vtkIdType place) { return !std::binary_search(covered.begin(), covered.end(), place); });
  });
  this->Everybody.Sum(sums);
  EffectOfLimit& effect = this->Total.Effect;
  this->Total.Triangles = sums[0];
  effect.Vertices = this->Part.Bases.back() - this->Total.Duplicates - this->Total.NotFinite;
  effect.Missing = sums[1];
  if (!this->Crew->IsInFiles())
  {
    if (effect.AreMostMissing())
    {
      MeasureAll(*this->Crew, Covered, progress, this->Part, effect);
    }
    this->Part.Result.Triangles = std::move(kept);
  }
}

void AddWork(
  const Ranks::Traffic& traffic, const TriangulateParts::Effort& effort, vtkFieldData* fieldData)
{
  vtkNew<vtkIdTypeArray> work;
  work->SetName("WorkOfRank");
  work->SetNumberOfComponents(4);
  const char* const names[] = { "OwnPoints", "SeamPoints", "BytesSent", "Exchanges" };
  const vtkIdType values[] = { effort.Points, effort.SeamPoints, traffic.BytesSent,
    traffic.Rounds };
  for (int i = 0; i < 4; ++i)
  {
    work->SetComponentName(i, names[i]);
    work->InsertNextValue(values[i]);
  }
  fieldData->AddArray(work);
}

} // namespace elevation
