// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedFill.h"

#include "BorderOfRanks.h"
#include "FilledPart.h"
#include "Joining.h"
#include "LatticeOfRanks.h"
#include "MeshConversion.h"
#include "NearParts.h"
#include "PackedData.h"
#include "PatchedSurface.h"
#include "PointRows.h"
#include "SurroundingBoxes.h"

#include "vtkCellData.h"
#include "vtkIdList.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace elevation
{

namespace
{
/** The work of one rank; the functions are its steps, in their order. */
class Work
{
public:
  Work(const Ranks& ranks, const FillOptions& options, bool interpolate, Block& block)
    : All(ranks)
    , Options(options)
    , Interpolate(interpolate)
    , Of(block)
  {
    this->Part.Input = vtkPolyData::SafeDownCast(block.Input);
  }

  bool Read();
  bool FindBorder();
  bool FindHoles();
  void FindLattice();
  void AssignHoles();
  bool FillAll();
  void ShareReports();
  void Write(FillResult& patches);

private:
  Progress Watched(double begin, double end) const
  {
    return this->All.Watched(elevation::Part(this->Of.Progress, begin, end));
  }
  bool IsPlain() const;
  bool HavePoints() const { return this->Part.HasPoints(); }
  void ListShared();
  bool Surround(int round, const std::vector<char>& areWaiting);
  bool TakeSurroundings(std::vector<Bytes>&& packed);
  Holes OwnHoles() const;
  FillOptions OwnOptions(int round) const;
  void ShareRooms();

  const Ranks& All;
  const FillOptions& Options;
  const bool Interpolate;
  Block& Of;
  FilledPart Part;
  Holes Found; // of all, by points of the border
  LatticeSearch Lattice;
  std::vector<HoleExtent> Extents; // of each hole
  std::vector<int> RankOfHole;
  std::vector<double> Rooms;
  Mesh Near; // the triangles around the holes of this rank
};

/** Whether the part has nothing but triangles of its own. */
bool Work::IsPlain() const
{
  return this->Part.Input->GetNumberOfVerts() == 0 && this->Part.Input->GetNumberOfLines() == 0 &&
    this->Part.Input->GetNumberOfStrips() == 0 && !GhostsOf(this->Part.Input->GetCellData());
}

bool Work::Read()
{
  vtkPoints* const points = this->HavePoints() ? this->Part.Input->GetPoints() : nullptr;
  const int type = points ? points->GetDataType() : VTK_VOID;
  std::vector<vtkIdType> sums(4, 0);
  if (!CanAll(this->All, [&]() {
        Report(this->Watched(0.0, 1.0), 0.0);
        CheckArrays(this->Part.Input);
        ToMesh(this->Part.Input, this->Part.Own, this->Watched(0.0, 0.08));
        this->Part.Own.ConnectTwins(0, this->Watched(0.08, 0.2));
        sums = { this->Part.Own.NumberOfTriangles(), type == VTK_FLOAT ? 1 : 0,
          type == VTK_DOUBLE ? 1 : 0,
          points && !this->Part.Input->GetPointData()->GetGlobalIds() ? 1 : 0 };
        return this->IsPlain() && (!points || type == VTK_FLOAT || type == VTK_DOUBLE);
      }))
  {
    return false;
  }
  this->All.Sum(sums);
  this->Part.ByIds = sums[3] == 0;
  return sums[0] > 0 && (sums[1] == 0 || sums[2] == 0);
}

/** The points on the border of the part, and those without a triangle. */
void Work::ListShared()
{
  std::vector<char> mayBeShared(static_cast<std::size_t>(this->Part.Input->GetNumberOfPoints()), 1);
  this->Part.AreUsed.assign(mayBeShared.size(), 0);
  for (const Index corner : this->Part.Own.Triangles)
  {
    mayBeShared[corner] = 0;
    this->Part.AreUsed[corner] = 1;
  }
  for (Index h = 0; h < static_cast<Index>(this->Part.Own.Twins.size()); ++h)
  {
    if (this->Part.Own.Twin(h) == Mesh::Border)
    {
      mayBeShared[this->Part.Own.Origin(h)] = mayBeShared[this->Part.Own.Destination(h)] = 1;
    }
  }
  for (std::size_t i = 0; i < mayBeShared.size(); ++i)
  {
    if (mayBeShared[i])
    {
      this->Part.Shared.Places.push_back(static_cast<Index>(i));
    }
  }
  this->Part.Shared.Keys = KeysOf(this->Part.Input, this->Part.ByIds, &this->Part.Shared.Places);
}

bool Work::FindBorder()
{
  if (!CanAll(this->All, [this]() {
        this->ListShared();
        return this->Part.Shared.Sort(this->Part.AreUsed);
      }))
  {
    return false;
  }
  FindCopies(this->All, this->Part.Input, this->Part.ByIds, this->Part.Shared);
  return CollectBorder(this->All, this->Part.Own, this->Part.Shared, this->Part.Border);
}

bool Work::FindHoles()
{
  return CanAll(this->All, [this]() {
    this->Found =
      FindHolesOfBorder(this->Part.Border.Edges, this->Part.Border.View(), this->Watched(0.2, 0.3));
    this->Extents = ExtentsOf(this->Found, this->Part.Border.View());
    return this->Found.NumberOfContacts == 0;
  });
}

/** That of all points, each counted once. */
void Work::FindLattice()
{
  if (this->Found.Count() == 0 || this->Options.Spacing > 0.0)
  {
    return; // as on one rank
  }
  Buffer<double> kept;
  PointSlices points{ 0.0, [](const auto&) {} };
  PointsOfDataSet view;
  this->All.Agree([&]() {
    if (!this->HavePoints())
    {
      return;
    }
    view = ViewPoints(this->Part.Input);
    std::vector<char> areCopies(static_cast<std::size_t>(view.View.Count), 0);
    for (std::size_t i = 0; i < this->Part.Shared.Places.size(); ++i)
    {
      areCopies[this->Part.Shared.Places[i]] = this->Part.Shared.AreCopies[i];
    }
    for (Index i = 0; i < view.View.Count; ++i)
    {
      const Point2 p = view.View.At(i);
      for (const double value : { p.X, p.Y, view.View.Elevation(i) })
      {
        if (!areCopies[i])
        {
          kept.Append(value);
        }
      }
    }
    PointView some;
    some.Double = kept.data();
    some.Count = static_cast<Index>(kept.size() / 3);
    points = InOneSlice(some);
  });
  LatticeSample sample;
  this->Lattice.Found = FitLatticeOnRanks(this->All, points, LatticeTolerance,
    ThreadsAtOnce(this->Options.NumberOfThreads), elevation::Part(this->Of.Progress, 0.3, 0.32),
    sample, this->Lattice.Steps);
}

/** To the ranks that have points. */
void Work::AssignHoles()
{
  const std::vector<vtkIdType> have =
    this->All.Collect(std::vector<vtkIdType>{ this->HavePoints() ? 1 : 0 });
  this->RankOfHole = BalancedRanks(this->Extents, have);
  for (std::size_t hole = 0; hole < this->RankOfHole.size(); ++hole)
  {
    if (this->RankOfHole[hole] == this->All.Own())
    {
      this->Part.Mine.push_back(static_cast<Index>(hole));
    }
  }
}

/** Sends the ranks that wait for them the triangles around their holes. */
bool Work::Surround(int round, const std::vector<char>& areWaiting)
{
  std::vector<Bytes> packed(this->All.Count());
  if (!CanAll(this->All, [&]() {
        for (int rank = 0; rank < this->All.Count() && this->HavePoints(); ++rank)
        {
          std::vector<Box> boxes;
          for (std::size_t hole = 0; hole < this->Extents.size() && areWaiting[rank]; ++hole)
          {
            if (this->RankOfHole[hole] == rank)
            {
              boxes.push_back(BoxAround(this->Extents[hole], round));
            }
          }
          const std::vector<Index> near = TrianglesIn(boxes, this->Part.Own);
          if (!near.empty())
          {
            packed[rank] = PackData(ChosenTriangles(this->Part.Input, this->Part.Own, near));
          }
        }
        return true;
      }))
  {
    return false;
  }
  packed = this->All.Exchange(std::move(packed));
  return CanAll(this->All,
    [&]() { return !areWaiting[this->All.Own()] || this->TakeSurroundings(std::move(packed)); });
}

bool Work::TakeSurroundings(std::vector<Bytes>&& packed)
{
  Parts parts;
  for (Bytes& bytes : packed)
  {
    if (!bytes.empty())
    {
      parts.push_back(UnpackData(bytes.data(), bytes.size()));
      bytes = Bytes();
    }
  }
  std::vector<std::string> warnings; // none: all have the same arrays
  this->Near = Mesh();
  this->Part.Whole = Join(parts, PartKind::Mesh, this->Watched(0.35, 0.36), warnings);
  this->Part.Keys = KeysOf(this->Part.Whole, this->Part.ByIds, nullptr);
  ToMesh(this->Part.Whole, this->Near, this->Watched(0.36, 0.37));
  this->Near.ConnectTwins(0, this->Watched(0.37, 0.38));
  return true;
}

/** By the points of the surroundings. */
Holes Work::OwnHoles() const
{
  std::vector<Index> placeOf(this->Part.Border.Keys.size(), None);
  for (std::size_t i = 0; i < this->Part.Keys.size(); ++i)
  {
    const Index at = this->Part.Border.Find(this->Part.Keys[i]);
    if (at != None)
    {
      placeOf[at] = static_cast<Index>(i);
    }
  }
  Holes holes;
  for (const Index hole : this->Part.Mine)
  {
    for (Index i = this->Found.Offsets[hole]; i < this->Found.Offsets[hole + 1]; ++i)
    {
      const Index walk = this->Found.Loops[i];
      holes.Loops.push_back(static_cast<Index>(holes.Walks.Count()));
      std::transform(this->Found.Walks.Begin(walk), this->Found.Walks.End(walk),
        std::back_inserter(holes.Walks.Vertices), [&](Index v) { return placeOf[v]; });
      holes.Walks.Offsets.push_back(static_cast<Index>(holes.Walks.Vertices.size()));
    }
    holes.Offsets.push_back(static_cast<Index>(holes.Loops.size()));
    holes.Touched.push_back(0);
  }
  if (std::count(holes.Walks.Vertices.begin(), holes.Walks.Vertices.end(), None) > 0)
  {
    throw Error("A point of a hole has not come from another rank (process).");
  }
  return holes;
}

FillOptions Work::OwnOptions(int round) const
{
  FillOptions options = this->Options;
  options.SinglePrecision = HasFloatPoints(this->Part.Whole);
  options.KnownLattice = &this->Lattice;
  options.Monitor = this->Watched(0.4, 0.8);
  if (this->Interpolate)
  {
    options.Attributes = AttributesOf(this->Part.Whole->GetPointData());
  }
  for (const Index hole : this->Part.Mine)
  {
    options.Known.push_back(BoxAround(this->Extents[hole], round));
    if (!this->Rooms.empty())
    {
      options.Rooms.push_back(this->Rooms[hole]);
    }
  }
  return options;
}

/** What each hole may take is known where all needs are. */
void Work::ShareRooms()
{
  std::vector<double> rows; // hole, need
  this->All.Agree([&]() {
    if (this->Part.Mine.empty())
    {
      return;
    }
    FillOptions options = this->OwnOptions(0);
    options.Monitor = this->Watched(0.38, 0.4);
    const std::vector<double> needs =
      NeedsOfHoles(this->Near, ViewPoints(this->Part.Whole).View, this->OwnHoles(), options);
    for (std::size_t i = 0; i < this->Part.Mine.size(); ++i)
    {
      rows.insert(rows.end(), { static_cast<double>(this->Part.Mine[i]), needs[i] });
    }
  });
  rows = this->All.CollectReals(rows);
  std::vector<double> needs(this->Extents.size());
  for (std::size_t i = 0; i < rows.size(); i += 2)
  {
    needs[static_cast<std::size_t>(rows[i])] = rows[i + 1];
  }
  this->Rooms = RoomsOfNeeds(needs, this->Options.MaximumInsertedPoints);
}

bool Work::FillAll()
{
  std::vector<char> areWaiting(this->All.Count(), 0);
  for (const int rank : this->RankOfHole)
  {
    areWaiting[rank] = 1;
  }
  for (int round = 0; std::count(areWaiting.begin(), areWaiting.end(), 1) > 0; ++round)
  {
    if (!this->Surround(round, areWaiting))
    {
      return false;
    }
    if (round == 0)
    {
      this->ShareRooms();
    }
    vtkIdType isWaiting = 0;
    this->All.Agree([&]() {
      if (!areWaiting[this->All.Own()])
      {
        return;
      }
      this->Part.Patches = FillHoles(
        this->Near, ViewPoints(this->Part.Whole).View, this->OwnHoles(), this->OwnOptions(round));
      const std::vector<HoleReport>& reports = this->Part.Patches.Reports;
      isWaiting = std::any_of(reports.begin(), reports.end(),
        [](const HoleReport& report) { return report.IsBeyondKnown; });
    });
    const std::vector<vtkIdType> all = this->All.Collect(std::vector<vtkIdType>{ isWaiting });
    std::copy(all.begin(), all.end(), areWaiting.begin());
  }
  return true;
}

void Work::ShareReports()
{
  constexpr std::size_t width = 8;
  std::vector<double> rows;
  std::vector<std::string> reasons; // of each hole that has failed: its number, a space, the text
  for (std::size_t i = 0; i < this->Part.Mine.size(); ++i)
  {
    const HoleReport& one = this->Part.Patches.Reports[i];
    rows.insert(rows.end(),
      { static_cast<double>(this->Part.Mine[i]), static_cast<double>(one.Status),
        static_cast<double>(one.NumberOfEdges), one.Perimeter, one.Area, one.Size,
        static_cast<double>(one.NumberOfInsertedPoints), static_cast<double>(one.Method) });
    if (!one.Reason.empty())
    {
      reasons.push_back(std::to_string(this->Part.Mine[i]) + " " + one.Reason);
    }
  }
  rows = this->All.CollectReals(rows);
  reasons = this->All.Collect(reasons);
  this->Part.Reports.resize(this->Extents.size());
  for (std::size_t i = 0; i < rows.size(); i += width)
  {
    const double* const row = rows.data() + i;
    HoleReport& one = this->Part.Reports[static_cast<std::size_t>(row[0])];
    one.Status = static_cast<FillStatus>(static_cast<int>(row[1]));
    one.NumberOfEdges = static_cast<Index>(row[2]);
    one.Perimeter = row[3];
    one.Area = row[4];
    one.Size = row[5];
    one.NumberOfInsertedPoints = static_cast<Index>(row[6]);
    one.Method = static_cast<Interpolation>(static_cast<int>(row[7]));
  }
  for (const std::string& reason : reasons)
  {
    this->Part.Reports[std::stoul(reason)].Reason = reason.substr(reason.find(' ') + 1);
  }
  this->Part.FirstNewPoints.assign(1, 0);
  for (const HoleReport& one : this->Part.Reports)
  {
    this->Part.FirstNewPoints.push_back(
      this->Part.FirstNewPoints.back() + one.NumberOfInsertedPoints);
  }
}

void Work::Write(FillResult& patches)
{
  patches.Found = std::move(this->Found);
  patches.Reports = this->Part.Reports;
  WriteFilled(this->All, this->Part, this->Interpolate, patches, this->Of);
}
} // namespace

bool FillOnRanks(const Ranks& ranks, const FillOptions& options, bool interpolate, Block& block,
  FillResult& patches)
{
  Work work(ranks, options, interpolate, block);
  if (!work.Read() || !HaveSameArrays(ranks, block.Input) || !work.FindBorder() ||
    !work.FindHoles())
  {
    return false;
  }
  work.FindLattice();
  work.AssignHoles();
  if (!work.FillAll())
  {
    return false;
  }
  work.ShareReports();
  work.Write(patches);
  return true;
}

} // namespace elevation
