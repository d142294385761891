// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "CellByCell.h"

#include "Adapt/Adapt.h"
#include "LatticeOfRanks.h"

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <set>
#include <system_error>
#include <utility>

namespace elevation
{

namespace
{
constexpr const char* NameOfIds = "GlobalPointIds";
constexpr vtkIdType PointsInStretch = 1 << 20; // of the file of all points
constexpr std::size_t MostSampled = 1 << 19;

std::uint64_t HashOf(vtkIdType id)
{
  const std::uint64_t bits = 0x9E3779B97F4A7C15ull * static_cast<std::uint64_t>(id + 1);
  return ((bits ^ (bits >> 31)) * 0xD6E8FEB86659FD93ull) >> 20;
}

bool AreSame(const std::vector<ArrayKind>& kinds, const std::vector<ArrayKind>& others)
{
  return std::equal(kinds.begin(), kinds.end(), others.begin(), others.end(),
    [](const ArrayKind& kind, const ArrayKind& other) {
      return kind.Name == other.Name && kind.Type == other.Type &&
        kind.Components == other.Components;
    });
}
} // namespace

CellByCell::CellByCell(const std::string& folder)
  : Folder(folder)
  , Rows(folder + "/points")
{
  std::error_code problem;
  const bool isEmpty = std::filesystem::is_empty(folder, problem);
  if (problem)
  {
    throw Error("Folder '" + folder + "': " + problem.message() + ".");
  }
  if (!isEmpty || !std::filesystem::is_directory(folder))
  {
    throw Error("Folder '" + folder + "' is not an empty folder, which temporary files need.");
  }
}

void CellByCell::TakeKinds(vtkPointSet* points)
{
  CheckPointArrays(points);
  std::set<std::string> leftOut;
  std::vector<ArrayKind> kinds = CommonArrays(Ranks(), points->GetPointData(), leftOut);
  const auto isOfIds = [](const ArrayKind& kind) {
    return kind.Attribute == vtkDataSetAttributes::GLOBALIDS || kind.Name == NameOfIds;
  };
  if (std::any_of(kinds.begin(), kinds.end(), isOfIds))
  {
    throw Error(std::string("The points have global ids, but are numbered in the order in which "
                            "they come: take the array away."));
  }
  if (!leftOut.empty())
  {
    throw Error("Point array \"" + *leftOut.begin() + "\" cannot be written to a file.");
  }
  if (this->Total.Points > 0 && !AreSame(kinds, this->Kinds))
  {
    throw Error("Points that are added need the same point arrays as those before.");
  }
  this->Kinds = std::move(kinds);
  if (points->GetPoints()->GetDataType() != VTK_FLOAT)
  {
    this->TypeOfPoints = VTK_DOUBLE;
  }
}

void CellByCell::Add(vtkPointSet* points, const Progress& progress)
{
  if (points->GetNumberOfPoints() == 0)
  {
    return;
  }
  this->TakeKinds(points);
  PointRows rows(this->Kinds);
  rows.Read(points, this->Total.Points, Part(progress, 0.0, 0.5));
  const vtkIdType count = static_cast<vtkIdType>(rows.Count());
  for (vtkIdType first = 0; first < count; first += PointsInStretch)
  {
    Report(progress, 0.5 + 0.5 * static_cast<double>(first) / static_cast<double>(count));
    std::vector<vtkIdType> places(std::min(PointsInStretch, count - first));
    std::iota(places.begin(), places.end(), first);
    const Bytes packed = rows.Pack(places);
    this->Rows.Append(packed.data(), packed.size());
    this->SampleStretch(rows, first, first + static_cast<vtkIdType>(places.size()));
  }
  this->Total.Points += count;
}

/** A hash of its id tells whether a point is in the sample; of one too large each other goes. */
void CellByCell::SampleStretch(const PointRows& rows, vtkIdType first, vtkIdType last)
{
  const auto isOut = [this](vtkIdType id) { return (HashOf(id) & this->SampleMask) != 0; };
  for (vtkIdType i = first; i < last; ++i)
  {
    if (!isOut(rows.Ids[i]) && rows.IsFinite(i))
    {
      this->Sample.push_back({ rows.Ids[i], { rows.At(i)[0], rows.At(i)[1] } });
    }
  }
  while (this->Sample.size() > MostSampled)
  {
    this->SampleMask = 2 * this->SampleMask + 1;
    const auto out = std::remove_if(this->Sample.begin(), this->Sample.end(),
      [&isOut](const SampledPoint& point) { return isOut(point.Id); });
    this->Sample.erase(out, this->Sample.end());
  }
}

PointRows CellByCell::Unpacked(Bytes&& packed) const
{
  std::vector<Bytes> stretches;
  stretches.push_back(std::move(packed));
  PointRows rows(this->Kinds);
  rows.Unpack(stretches);
  return rows;
}

PointSlices CellByCell::AllSlices() const
{
  return { static_cast<double>(this->Total.Points), [this](const auto& visit) {
            this->Rows.ForEach(
              [&](Bytes&& packed) { visit(ViewOf(this->Unpacked(std::move(packed)))); });
          } };
}

PointSlices CellByCell::SlicesOfCells() const
{
  return { static_cast<double>(this->Total.Points), [this](const auto& visit) {
            for (const CellFiles& files : this->Cells)
            {
              files.Points.ForEach(
                [&](Bytes&& packed) { visit(ViewOf(this->Unpacked(std::move(packed)))); });
            }
          } };
}

void CellByCell::Triangulate(int cells, const DelaunayOptions& options)
{
  this->Options = options;
  std::vector<Point2> sample(this->Sample.size());
  std::transform(this->Sample.begin(), this->Sample.end(), sample.begin(),
    [](const SampledPoint& point) { return point.At; });
  this->Sample = std::vector<SampledPoint>();
  this->Plane = std::make_unique<Cuts>(std::move(sample), cells);
  SharedLattice lattice;
  const Progress searching = Part(options.Monitor, 0.0, 0.1);
  const bool mayFit = options.UseLattice == LatticeMode::Automatic && this->Total.Points > 0 &&
    FindLatticeOnRanks(Ranks(), this->AllSlices(), options, searching, lattice);
  for (int cell = 0; cell < cells; ++cell)
  {
    const std::string number = std::to_string(cell);
    this->Cells.push_back({ SpoolFile(this->Folder + "/points-" + number),
      SpoolFile(this->Folder + "/triangles-" + number) });
  }
  this->Distribute(Part(options.Monitor, 0.1, 0.2));
  if (mayFit && this->SettleOn(&lattice))
  {
    this->Total.LatticeFound = true;
    this->Total.Steps = FromLowestNode(Ranks(), this->SlicesOfCells(), lattice);
  }
  else
  {
    this->SettleOn(nullptr);
  }
  this->Total.Missing +=
    std::count(this->AreSeamsMissing.begin(), this->AreSeamsMissing.end(), char(1));
}

/** Brings all points to the files of their cells. What is not finite is spread evenly. */
void CellByCell::Distribute(const Progress& progress)
{
  const std::size_t cells = this->Cells.size();
  this->Bases.assign(cells + 1, 0);
  this->Rows.ForEach([&](Bytes&& packed) {
    const PointRows rows = this->Unpacked(std::move(packed));
    Report(progress, static_cast<double>(rows.Ids[0]) / static_cast<double>(this->Total.Points));
    std::vector<std::vector<vtkIdType>> places(cells);
    for (std::size_t i = 0; i < rows.Count(); ++i)
    {
      const double* const p = rows.At(i);
      places[rows.IsFinite(i) ? this->Plane->OwnerOf({ p[0], p[1] }) : rows.Ids[i] % cells]
        .push_back(static_cast<vtkIdType>(i));
    }
    for (std::size_t cell = 0; cell < cells; ++cell)
    {
      if (!places[cell].empty())
      {
        const Bytes ofCell = rows.Pack(places[cell]);
        this->Cells[cell].Points.Append(ofCell.data(), ofCell.size());
        this->Bases[cell + 1] += static_cast<vtkIdType>(places[cell].size());
      }
    }
  });
  std::partial_sum(this->Bases.begin(), this->Bases.end(), this->Bases.begin());
  this->Rows.Remove();
}

/** @return false if not all points are on the lattice, or by chance, or on one line of it */
bool CellByCell::SettleOn(const SharedLattice* lattice)
{
  const int cells = this->CountOfCells();
  Totals none;
  none.Points = this->Total.Points;
  this->Total = none;
  this->SeamRows = PointRows(this->Kinds);
  this->SeamNumbers.clear();
  this->AreSeamsMissing.clear();
  this->OfSeams.assign(cells, {});
  this->CellsDone = 0;
  for (CellFiles& files : this->Cells)
  {
    files.Triangles.Remove();
  }
  try
  {
    this->SettleNode(0, cells, lattice);
  }
  catch (const NotOnLattice&)
  {
    return false;
  }
  const vtkIdType used = this->Total.Points - this->Total.Duplicates - this->Total.NotFinite;
  return this->Total.Settled > 0 &&
    !(lattice && IsLatticeByChance(static_cast<double>(used), lattice->Tolerance()));
}

/** Settles what cells [begin, end) can. @return their seam */
Piece CellByCell::SettleNode(int begin, int end, const SharedLattice* lattice)
{
  if (end - begin == 1)
  {
    return this->SettleLeaf(begin, lattice);
  }
  const int middle = Cuts::MiddleOf(begin, end);
  Piece joined = this->SettleNode(begin, middle, lattice);
  joined = Join(std::move(joined), this->SettleNode(middle, end, lattice));
  std::vector<GlobalTriangle> triangles;
  const Progress progress = Part(this->Options.Monitor, this->PartDone(), this->PartDone());
  Piece seam = SettleSeams(
    joined, this->Plane->CellOf(begin, end), this->OptionsWith(progress), triangles, lattice);
  for (const GlobalTriangle& triangle : triangles)
  {
    this->OfSeams[OwnerOf(triangle[0], this->Bases)].push_back(triangle);
  }
  this->CountShort(triangles);
  this->Total.Settled += static_cast<vtkIdType>(triangles.size());
  return seam;
}

DelaunayOptions CellByCell::OptionsWith(const Progress& progress) const
{
  DelaunayOptions options = this->Options;
  options.Monitor = progress;
  return options;
}

/** Of the whole work, when so many cells have been settled. */
double CellByCell::PartDone() const
{
  return 0.2 + 0.8 * this->CellsDone / this->CountOfCells();
}

SurfacePart CellByCell::OwnPart(int cell) const
{
  SurfacePart part;
  part.Kinds = this->Kinds;
  part.NameOfIds = NameOfIds;
  part.TypeOfPoints = this->TypeOfPoints;
  part.Own = PointRows(this->Kinds);
  std::vector<Bytes> stretches;
  this->Cells[cell].Points.ForEach(
    [&stretches](Bytes&& stretch) { stretches.push_back(std::move(stretch)); });
  part.Own.Unpack(stretches);
  return part;
}

Piece CellByCell::SettleLeaf(int cell, const SharedLattice* lattice)
{
  const GlobalId first = this->Bases[cell], count = this->Bases[cell + 1] - first;
  if (count > MaximumNumberOfPoints)
  {
    throw Error("A piece would have " + std::to_string(count) + " points; at most " +
      std::to_string(MaximumNumberOfPoints) + " can be handled at once. Use more pieces.");
  }
  SurfacePart part = this->OwnPart(cell);
  const double begin = this->PartDone();
  ++this->CellsDone;
  const Progress progress = Part(this->Options.Monitor, begin, this->PartDone());
  SettledCell settled = SettleCell(ViewOf(part.Own), first, this->Plane->CellOf(cell, cell + 1),
    this->OptionsWith(progress), lattice);
  part.Result = std::move(settled.Result);
  const Buffer<Index>& corners = part.Result.Triangles;
  if (!corners.empty())
  {
    this->Cells[cell].Triangles.Append(corners.data(), corners.size() * sizeof(Index));
  }
  this->Total.Settled += static_cast<vtkIdType>(corners.size() / 3);
  this->Total.Duplicates += part.Result.NumberOfDuplicates;
  this->Total.NotFinite += part.Result.NumberOfNotFinite;
  this->KeepSeam(part, first, settled.Seam);
  this->CountShort(part, first);
  return std::move(settled.Seam);
}

/** Counts the triangles of a cell within the limit, and the vertices that have none for good. */
void CellByCell::CountShort(const SurfacePart& part, GlobalId first)
{
  const Buffer<Index>& corners = part.Result.Triangles;
  const EdgeLimit limit(this->Options.MaximumEdgeLength);
  if (!limit.IsSet()) // all are, and no vertex is without one
  {
    this->Total.Triangles += static_cast<vtkIdType>(corners.size() / 3);
    return;
  }
  const auto pointOf = [&part](Index place) { return part.PointAt(place); };
  std::vector<char> areMissing(part.Own.Count(), 1);
  for (std::size_t i = 0; i < corners.size(); i += 3)
  {
    if (limit.Admits(pointOf, corners[i], corners[i + 1], corners[i + 2]))
    {
      ++this->Total.Triangles;
      areMissing[corners[i]] = areMissing[corners[i + 1]] = areMissing[corners[i + 2]] = 0;
    }
  }
  for (const Index unused : part.Result.UnusedPoints)
  {
    areMissing[unused] = 0;
  }
  for (std::size_t i = this->AreSeamsMissing.size(); i < this->SeamNumbers.size(); ++i)
  {
    char& isMissing = areMissing[this->SeamNumbers[i] - first];
    this->AreSeamsMissing.push_back(isMissing);
    isMissing = 0; // it may still get one
  }
  this->Total.Missing += std::count(areMissing.begin(), areMissing.end(), char(1));
}

/** The same for triangles that seams have settled. */
void CellByCell::CountShort(const std::vector<GlobalTriangle>& triangles)
{
  const EdgeLimit limit(this->Options.MaximumEdgeLength);
  if (!limit.IsSet())
  {
    this->Total.Triangles += static_cast<vtkIdType>(triangles.size());
    return;
  }
  const auto pointOf = [this](std::size_t place) {
    const double* const p = this->SeamRows.At(place);
    return Point2{ p[0], p[1] };
  };
  for (const GlobalTriangle& triangle : triangles)
  {
    const std::size_t p = this->PlaceOnSeam(triangle[0]), q = this->PlaceOnSeam(triangle[1]),
                      r = this->PlaceOnSeam(triangle[2]);
    if (limit.Admits(pointOf, static_cast<Index>(p), static_cast<Index>(q), static_cast<Index>(r)))
    {
      ++this->Total.Triangles;
      this->AreSeamsMissing[p] = this->AreSeamsMissing[q] = this->AreSeamsMissing[r] = 0;
    }
  }
}

std::size_t CellByCell::PlaceOnSeam(GlobalId number) const
{
  const auto at = std::lower_bound(this->SeamNumbers.begin(), this->SeamNumbers.end(), number);
  return static_cast<std::size_t>(at - this->SeamNumbers.begin());
}

namespace
{
/** Takes away the triangles with a longer edge. */
void KeepShort(const EdgeLimit& limit, const Progress& progress, SurfacePart& part)
{
  if (!limit.IsSet())
  {
    return;
  }
  const auto pointOf = [&part](Index place) { return part.PointAt(place); };
  Buffer<Index>& corners = part.Result.Triangles;
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
  corners = std::move(kept);
}
} // namespace

void CellByCell::KeepSeam(const SurfacePart& part, GlobalId first, const Piece& seam)
{
  std::vector<vtkIdType> places(seam.Ids.begin(), seam.Ids.end());
  std::sort(places.begin(), places.end());
  this->SeamNumbers.insert(this->SeamNumbers.end(), places.begin(), places.end());
  std::for_each(places.begin(), places.end(), [first](vtkIdType& id) { id -= first; });
  std::vector<Bytes> packed;
  packed.push_back(part.Own.Pack(places));
  this->SeamRows.Unpack(packed);
}

/**
 * Lists the points of a cell that are neither corners nor on its seam, whose numbers are given:
 * those that are not finite, and duplicates.
 */
void CellByCell::ListUnused(
  Numbers seamBegin, Numbers seamEnd, GlobalId first, const Progress& progress, SurfacePart& part)
{
  std::vector<char> areUsed(part.Own.Count(), 0);
  for (const Index corner : part.Result.Triangles)
  {
    areUsed[corner] = 1;
  }
  std::for_each(seamBegin, seamEnd, [&](GlobalId number) { areUsed[number - first] = 1; });
  std::vector<Index> duplicates, notFinite;
  for (std::size_t i = 0; i < areUsed.size(); ++i)
  {
    ReportStep(progress, i, areUsed.size(), 1 << 18);
    if (!areUsed[i])
    {
      (part.Own.IsFinite(i) ? duplicates : notFinite).push_back(static_cast<Index>(i));
    }
  }
  SetUnusedPoints(std::move(duplicates), notFinite, progress, part.Result);
}

SurfacePart CellByCell::PieceAt(int cell, const Progress& progress) const
{
  const GlobalId first = this->Bases[cell];
  SurfacePart part = this->OwnPart(cell);
  Report(progress, 0.3);
  Buffer<Index>& corners = part.Result.Triangles;
  this->Cells[cell].Triangles.ForEach([&corners](Bytes&& bytes) {
    const char* from = bytes.data();
    corners.Resize(bytes.size() / sizeof(Index));
    TakeFrom(from, corners.data(), corners.size());
  });
  const auto numberAt = [this](GlobalId number) {
    return this->SeamNumbers.begin() + static_cast<std::ptrdiff_t>(this->PlaceOnSeam(number));
  };
  ListUnused(numberAt(first), numberAt(this->Bases[cell + 1]), first, progress, part);
  ListOthers(this->OfSeams[cell], first, part);
  std::vector<vtkIdType> others;
  for (const GlobalId number : part.OtherNumbers)
  {
    others.push_back(static_cast<vtkIdType>(this->PlaceOnSeam(number)));
  }
  std::vector<Bytes> packed;
  packed.push_back(this->SeamRows.Pack(others));
  part.Others = PointRows(this->Kinds);
  part.Others.Unpack(packed);
  AppendTriangles(this->OfSeams[cell], first, progress, part);
  KeepShort(EdgeLimit(this->Options.MaximumEdgeLength), progress, part);
  KeepCorners(part);
  part.Result.LatticeFound = this->Total.LatticeFound;
  part.Result.Steps = this->Total.Steps;
  return part;
}

} // namespace elevation
