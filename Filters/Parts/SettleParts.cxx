// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SettleParts.h"

#include "Kernel/Base/Base.h"
#include "SharedLatticeSearch.h"

#include <algorithm>
#include <map>
#include <utility>

namespace elevation
{

/** A seam on its way to the part that joins it with its own. */
template <>
struct FieldsOf<Piece>
{
  template <typename Seam>
  static auto In(Seam& seam)
  {
    return std::tie(seam.Coordinates, seam.Ids, seam.Edges);
  }
};

namespace
{
/**
 * A node of the tree of cells (Cuts.h): cells [Begin, End), which have the numbers of their parts.
 * What is done for a node is done by its first part, which has the seam of its lower half already.
 */
struct Node
{
  int Begin, End;

  int Size() const { return this->End - this->Begin; }
  int Middle() const { return Cuts::MiddleOf(this->Begin, this->End); }

  /** That of a cell some levels below the whole plane, or the cell itself. */
  static Node Of(int cell, int level, int count)
  {
    Node node{ 0, count };
    // A cell that is reached before the level has no node there: it stands for itself, with a size
    // of 1.
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

/** The work of one rank; the functions are its steps, in their order. */
class Settling
{
public:
  Settling(PartStore& store, const Cuts& plane, const DelaunayOptions& options)
    : Store(store)
    , Crew(store.Crew)
    , AllRanks(store.Crew.AllRanks())
    , Plane(plane)
    , Options(options)
  {
    Stages stages(options.Monitor, { 7, 77, 16 });
    this->Searching = stages.Next();
    this->InCells = stages.Next();
    this->Joining = stages.Next();
  }

  SettledParts SettleAll();

private:
  DelaunayOptions OptionsWith(const Progress& progress) const
  {
    DelaunayOptions options = this->Options;
    options.Monitor = progress;
    return options;
  }
  void SettleOnGiven();
  bool SettleOn(const SharedLattice* lattice);
  bool IsByChance(const SharedLattice& lattice) const;
  bool IsOffAnywhere(const SharedLattice* lattice) const;
  template <typename Step>
  void WatchLattice(const Step& step);
  void SettlePart(int part, const SharedLattice* lattice, const Progress& progress);
  void SettleNode(
    const Node& node, const Piece& other, const SharedLattice* lattice, const Progress& progress);
  bool JoinSeams(const SharedLattice* lattice);

  PartStore& Store;
  Engine& Crew;
  const Ranks& AllRanks;
  const Cuts& Plane;
  const DelaunayOptions& Options;
  // Of the lattice, of cells, of the seams that ranks join. What is done again reports again.
  Progress Searching, InCells, Joining;
  // Of the nodes that wait for their other half.
  std::map<int, Piece> Seams; // of nodes, by their first parts
  bool IsOffLattice = false;  // a point of this rank is
  SettledParts Found;         // sums of this rank until the end
};

/**
 * All triangles, on the lattice of all points if there is one. A lattice that is found may turn out
 * not to be one, when a point lies beside it or few points fit by chance: then all is done again
 * without it.
 */
SettledParts Settling::SettleAll()
{
  SharedLattice lattice;
  const bool isAsked = this->Options.UseLattice == LatticeMode::Automatic;
  if (isAsked && this->Options.GivenLattice.IsSet())
  {
    this->SettleOnGiven();
  }
  else if (isAsked &&
    FindLatticeOnRanks(
      this->AllRanks, this->Store.Slices(), this->Options, this->Searching, lattice) &&
    this->SettleOn(&lattice) && !this->IsByChance(lattice))
  {
    this->Found.LatticeFound = true;
    this->Found.Steps = FromLowestNode(this->AllRanks, this->Store.Slices(), lattice);
  }
  else
  {
    this->SettleOn(nullptr);
  }
  std::vector<vtkIdType> sums = { this->Found.Duplicates, this->Found.NotFinite,
    this->Found.Hidden, this->Found.Triangles + static_cast<vtkIdType>(this->Found.OfSeams.size()) };
  this->AllRanks.Sum(sums);
  this->Found.Duplicates = sums[0];
  this->Found.NotFinite = sums[1];
  this->Found.Hidden = sums[2];
  this->Found.Triangles = sums[3];
  return std::move(this->Found);
}

/** The same on the lattice that is given. */
void Settling::SettleOnGiven()
{
  SharedLattice lattice;
  const PointSlices points = this->Store.Slices();
  const bool hasPoints = TakeGivenLattice(
    this->AllRanks, points, [this](const auto& visit) { this->Store.ForEachRows(visit); },
    this->Options, this->Searching, lattice);
  if (!this->SettleOn(hasPoints ? &lattice : nullptr))
  {
    throw GivenLatticeUnfit();
  }
  if (hasPoints)
  {
    this->Found.LatticeFound = true;
    this->Found.Steps = FromLowestNode(this->AllRanks, points, lattice);
  }
}

/** Whether so few points may fit a lattice by chance, or are all on one line of it. */
bool Settling::IsByChance(const SharedLattice& lattice) const
{
  // Points that could be vertices, which is known only after the cells were triangulated.
  std::vector<vtkIdType> sums = { this->Store.OwnCount() - this->Found.Duplicates -
      this->Found.NotFinite - this->Found.Hidden,
    this->Found.Triangles + static_cast<vtkIdType>(this->Found.OfSeams.size()) };
  this->AllRanks.Sum(sums);
  return sums[1] == 0 || IsLatticeByChance(static_cast<double>(sums[0]), lattice.Tolerance());
}

/**
 * Settles each cell, and joins the seams up to the whole plane. What an attempt before has left is
 * forgotten.
 * @return false if not all points are on the lattice; the same on all ranks
 */
bool Settling::SettleOn(const SharedLattice* lattice)
{
  // Boxes keep no seam of an attempt: what was sent has been taken, and KeepSettled() replaces the
  // rest.
  this->Seams.clear();
  this->Found = SettledParts();
  this->IsOffLattice = false;
  this->Crew.ForEach(this->InCells, [&](int part, const Progress& progress) {
    this->WatchLattice([&]() { this->SettlePart(part, lattice, progress); });
  });
  // A rank that is off the lattice goes on without work, so that all meet here.
  return !this->IsOffAnywhere(lattice) && this->JoinSeams(lattice);
}

/** Whether all ranks have to begin again; without a lattice, none asks the others. */
bool Settling::IsOffAnywhere(const SharedLattice* lattice) const
{
  return lattice && IsOnAny(this->AllRanks, this->IsOffLattice);
}

/** Does a step, unless a point of this rank is known not to be on the lattice. */
template <typename Step>
void Settling::WatchLattice(const Step& step)
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
 * Settles what the cell of a part can, and then the larger cells that it completes on this rank:
 * those that end with this part, from the smallest.
 */
void Settling::SettlePart(int part, const SharedLattice* lattice, const Progress& progress)
{
  // Reports of reading hear an abort, but do not move; so do those of larger cells.
  Stages stages(progress, { 0, 100, 0 });
  this->Store.WithOwn(part, stages.Next(), [&](const SurfacePart& own) {
    SettledCell settled = SettleCell(ViewOf(own.OwnPoints).View, this->Store.FirstOf(part),
      this->Plane.CellOf(part, part + 1), this->OptionsWith(stages.Next()), lattice);
    // To the kernel they were points that are not finite.
    NameHidden(own.OwnPoints.Marks(), settled.Result);
    this->Found.Triangles += static_cast<vtkIdType>(settled.Result.Triangles.size() / 3);
    this->Found.Duplicates += settled.Result.NumberOfDuplicates;
    this->Found.NotFinite += settled.Result.NumberOfNotFinite;
    this->Found.Hidden += settled.Result.NumberOfHidden;
    this->Found.SeamPoints += settled.Seam.Count();
    this->Store.KeepSettled(part, own, settled);
    this->Seams[part] = std::move(settled.Seam);
  });
  const int count = this->Crew.PartCount();
  const Progress last = stages.Next();
  // From the smallest node that ends with this part; the seam of its lower half is there, as its
  // parts came before.
  for (int level = Node::Levels(count) - 1; level >= 0; --level)
  {
    const Node node = Node::Of(part, level, count);
    if (node.Size() > 1 && node.End == part + 1 && node.IsWithinRank(this->Crew))
    {
      // The seam of the upper half is that of its first part.
      const Piece other = std::move(this->Seams[node.Middle()]);
      this->Seams.erase(node.Middle());
      this->SettleNode(node, other, lattice, last);
    }
  }
}

/** Settles what a larger cell can, of whose halves the seams are known. */
/*
 * What is settled now lies in the larger cell, and in no half of it. The rest is the seam that goes
 * up.
 */
void Settling::SettleNode(
  const Node& node, const Piece& other, const SharedLattice* lattice, const Progress& progress)
{
  Piece& seam = this->Seams[node.Begin];
  const Piece joined = Join(std::move(seam), other);
  seam = SettleSeams(joined, this->Plane.CellOf(node.Begin, node.End), this->OptionsWith(progress),
    this->Found.OfSeams, lattice);
}

/**
 * The same for all cells that several ranks hold, level by level. At each level the seam of the
 * upper half goes to the part that has that of the lower one.
 */
bool Settling::JoinSeams(const SharedLattice* lattice)
{
  const int count = this->Crew.PartCount(), levels = Node::Levels(count);
  for (int level = levels - 1; level >= 0; --level)
  {
    const auto isJoined = [&](const Node& node) {
      return node.Size() > 1 && !node.IsWithinRank(this->Crew);
    };
    this->Crew.ForEach(Progress(), [&](int part, const Progress&) {
      const Node node = Node::Of(part, level, count);
      // The first part of the upper half, which has its seam.
      if (isJoined(node) && part == node.Middle())
      {
        this->Crew.Send(node.Begin, FromSeams, Packed(this->Seams[part]));
        // A seam is in memory at one place only.
        this->Seams.erase(part);
      }
    });
    // On one rank nothing can have been sent.
    if (this->AllRanks.Count() > 1)
    {
      this->Crew.Deliver();
    }
    // Of a level, this rank works on one cell at most: the one that goes on beyond its last part.
    const double step = 1.0 / levels, begin = step * (levels - 1 - level);
    this->Crew.ForEach(
      this->Joining.Between(begin, begin + step), [&](int part, const Progress& progress) {
        const Node node = Node::Of(part, level, count);
        if (isJoined(node) && part == node.Begin)
        {
          // Taken before triangles are sent to the same box in pass 4.
          const Piece other = Unpacked<Piece>(this->Crew.At(part, FromSeams).Take().at(0));
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
} // namespace

SettledParts SettleParts(PartStore& store, const Cuts& plane, const DelaunayOptions& options)
{
  return Settling(store, plane, options).SettleAll();
}

} // namespace elevation
