// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * A part is put together from what lies in its boxes, in memory once and in files at each use:
 *
 *     rows of OwnPoints   -- sorted by ids -->   OwnPoints
 *     corners of Settled  (indices)      ----->  triangles of the cell    \
 *     FromSeams  (numbers)  -- IndexOf -->       appended to them          > Result
 *     Changed    (numbers)  -- IndexOf -->       written over some         /
 *     rows of Corners                    ----->  Others, in the order of OtherNumbers
 *
 * In memory the first two are in Part already, since a cell's result is moved there as it is made.
 *
 * The rows of Corners need no numbers of their own. A part asks each owner for indices in increasing
 * order; the answers lie in the box in the order of the ranks that sent them, and a rank's parts
 * answer in their order. So the rows come in the order of OtherNumbers, which ListOthersOf() makes
 * again from the triangles.
 *
 * Two boxes have more than rows or plain lists:
 *
 *     Settled   | duplicates, not finite, unused points, reasons |   the first stretch
 *               | corners ...                                    |   none without a triangle
 *     OnSeam    | indices, increasing |
 *               | their rows         |
 */
#include "PartStore.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace elevation
{

// In the order of BoxOfPart. The last three lists are short, whatever the size of a part.
const std::vector<std::string>& BoxNames()
{
  static const std::vector<std::string> names = { "points", "triangles", "seam-points", "seams",
    "corners", "changed", "", "", "" };
  return names;
}

// Points that came twice go; so counts are known only when all are there. Where ids are indices,
// none comes twice, and all are in order, rank after rank.
void PartStore::Number(std::vector<vtkIdType>&& counts, bool areIdsGiven, const Progress& progress)
{
  this->Part.Others = PointTable(this->Part.Kinds);
  if (areIdsGiven)
  {
    std::fill(counts.begin(), counts.end(), 0);
    this->Crew.ForEach(progress, [&](int part, const Progress& ofPart) {
      Report(ofPart, 0.0);
      if (this->Crew.IsInFiles())
      {
        // Written back sorted and without repeated points: later reads find all in order.
        const PointTable own = this->ReadOwn(part, ofPart).OwnPoints;
        counts[part] = static_cast<vtkIdType>(own.Count());
        std::vector<vtkIdType> indices(own.Count());
        std::iota(indices.begin(), indices.end(), vtkIdType(0));
        this->Crew.At(part, OwnPoints).Clear();
        this->AddOwn(part, own.Pack(indices));
        return;
      }
      // A step of memory alone: the one part of this rank.
      SortOwn(this->Part);
      counts[part] = static_cast<vtkIdType>(this->Part.OwnPoints.Count());
    });
  }
  this->Crew.AllRanks().Sum(counts);
  this->Part.Bases.assign(1, 0);
  std::partial_sum(counts.begin(), counts.end(), std::back_inserter(this->Part.Bases));
}

void PartStore::AddOwn(int part, Bytes&& rows)
{
  if (this->Crew.IsInFiles())
  {
    this->Crew.At(part, OwnPoints).Append(std::move(rows));
    return;
  }
  this->Part.OwnPoints.Unpack(&rows, 1);
}

// In a step, so that all ranks throw where one part has too many.
void PartStore::CheckCounts() const
{
  this->Crew.ForEach(Progress(), [this](int part, const Progress&) {
    this->CheckCount(static_cast<std::size_t>(this->EndOf(part) - this->FirstOf(part)));
  });
}

void PartStore::CheckCount(std::size_t count) const
{
  if (count > static_cast<std::size_t>(MaximumNumberOfPoints))
  {
    const bool isPiece = this->Crew.IsInFiles();
    throw Error(std::string(isPiece ? "A piece" : "A rank") + " would have " +
      std::to_string(count) + " points; at most " + std::to_string(MaximumNumberOfPoints) +
      " can be handled at once. Use more " + (isPiece ? "pieces." : "ranks."));
  }
}

/**
 * The points that a part owns, from its files. With several ranks these are in the order in which
 * slices came; numbers are indices in the order of ids, so that is made again.
 */
SurfacePart PartStore::ReadOwn(int part, const Progress& progress) const
{
  SurfacePart read;
  read.Kinds = this->Part.Kinds;
  read.IdsName = this->Part.IdsName;
  read.PointType = this->Part.PointType;
  read.Bases = this->Part.Bases;
  read.OwnPoints = PointTable(read.Kinds);
  read.Others = PointTable(read.Kinds);
  read.OwnPoints.Unpack(this->Crew.At(part, OwnPoints).Copy(progress));
  SortOwn(read);
  return read;
}

// Corners are written as they are, without a copy.
void PartStore::KeepSettled(int part, const SurfacePart& own, SettledCell& settled)
{
  Triangulation& result = settled.Result;
  if (!this->Crew.IsInFiles())
  {
    this->Part.Result = std::move(result);
    return;
  }
  Bytes unused;
  // Hidden points have been counted by Settling, so their number is not kept.
  const Index counts[] = { result.NumberOfDuplicates, result.NumberOfNotFinite };
  AppendTo(unused, counts, 2);
  AppendList(unused, result.UnusedPoints);
  AppendList(unused, result.UnusedReasons);
  Inbox& box = this->Crew.At(part, Settled);
  box.Clear(); // of an attempt before
  box.Append(std::move(unused));
  box.Append(result.Triangles.data(), result.Triangles.size() * sizeof(Index));
  // A corner of another part's triangle is on the seam of its own (Pieces.h).
  std::vector<vtkIdType> indices(settled.Seam.Ids.begin(), settled.Seam.Ids.end());
  const GlobalId first = this->FirstOf(part);
  std::for_each(indices.begin(), indices.end(), [first](vtkIdType& number) { number -= first; });
  this->Crew.At(part, OnSeam).Clear();
  this->KeepForOthers(part, own, std::move(indices));
}

void PartStore::KeepForOthers(int part, const SurfacePart& own, std::vector<vtkIdType>&& indices)
{
  if (!this->Crew.IsInFiles())
  {
    return;
  }
  // Lines may add points to those of the seam. Rows are packed again, in the order of all indices.
  const std::vector<vtkIdType> before = this->ReadForOthers(part).Indices;
  indices.insert(indices.end(), before.begin(), before.end());
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  Inbox& onSeam = this->Crew.At(part, OnSeam);
  onSeam.Clear();
  Bytes list;
  AppendList(list, indices);
  onSeam.Append(std::move(list));
  onSeam.Append(own.OwnPoints.Pack(indices));
}

// The box has two stretches, as written above, or none.
PartStore::RowsForOthers PartStore::ReadForOthers(int part) const
{
  RowsForOthers read;
  if (this->Crew.IsInFiles() && !this->Crew.At(part, OnSeam).IsEmpty())
  {
    const std::vector<Bytes> stretches = this->Crew.At(part, OnSeam).Copy();
    const char* from = stretches.at(0).data();
    TakeList(from, read.Indices);
    read.OnSeam = PointTable(this->Part.Kinds);
    read.OnSeam.Unpack(stretches.data() + 1, stretches.size() - 1);
  }
  return read;
}

Bytes PartStore::PackForOthers(const RowsForOthers& rows, std::vector<vtkIdType>&& indices) const
{
  if (!this->Crew.IsInFiles())
  {
    return this->Part.OwnPoints.Pack(indices);
  }
  for (vtkIdType& index : indices)
  {
    // The table has rows of the seam alone. Each index asked for is one of them: see KeepSettled().
    index =
      std::lower_bound(rows.Indices.begin(), rows.Indices.end(), index) - rows.Indices.begin();
  }
  return rows.OnSeam.Pack(indices);
}

SurfacePart PartStore::ReadWhole(int part, const Progress& progress) const
{
  Stages stages(progress, { 30, 30, 40 });
  SurfacePart read = this->ReadOwn(part, stages.Next());
  Report(stages.Next(), 0.0);
  bool isFirst = true;
  this->Crew.At(part, Settled).ForEach([&](const Bytes& bytes) {
    const char* from = bytes.data();
    Triangulation& result = read.Result;
    // The second stretch, if there is one. Without triangles the cell's corners stay an empty list.
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
  this->PutTogether(part, stages.Next(), read);
  return read;
}

std::vector<GlobalId> PartStore::ListOthersOf(int part) const
{
  auto triangles = ValuesIn<GlobalTriangle>(this->Crew.At(part, FromSeams));
  for (const ChangedTriangle& changed : ValuesIn<ChangedTriangle>(this->Crew.At(part, Changed)))
  {
    triangles.push_back(changed.Corners);
  }
  return ListOthers(triangles, this->FirstOf(part), this->EndOf(part));
}

void PartStore::ForgetOthers(int part)
{
  this->Crew.At(part, Requests).Clear();
  this->Crew.At(part, Corners).Clear();
  // Triangles of the cell that lines have changed stay so: PutTogether() writes them once more.
  if (std::exchange(this->IsWhole, false))
  {
    this->Part.Result.Triangles.Resize(this->CellCorners);
  }
}

/** Adds to own points and the triangles of the cell what a whole part has besides. */
void PartStore::PutTogether(int part, const Progress& progress, SurfacePart& whole) const
{
  const GlobalId first = this->FirstOf(part);
  const auto allChanged = ValuesIn<ChangedTriangle>(this->Crew.At(part, Changed));
  whole.OwnCorners = allChanged.empty() ? whole.Result.Triangles.size() : 0;
  whole.OtherNumbers = this->ListOthersOf(part);
  whole.Others = PointTable(whole.Kinds);
  whole.Others.Unpack(this->Crew.At(part, Corners).Copy());
  this->CheckCount(whole.OwnPoints.Count() + whole.Others.Count());
  AppendTriangles(ValuesIn<GlobalTriangle>(this->Crew.At(part, FromSeams)), first, progress, whole);
  // After the seams' triangles: an index counts them too. Lines change corners, never the number.
  for (const ChangedTriangle& changed : allChanged)
  {
    std::transform(changed.Corners.begin(), changed.Corners.end(),
      whole.Result.Triangles.data() + 3 * changed.Triangle,
      [&](GlobalId number) { return static_cast<Index>(whole.IndexOf(number, first)); });
  }
}

/** In memory, once. */
void PartStore::MakeWhole(int part, const Progress& progress)
{
  if (!std::exchange(this->IsWhole, true))
  {
    this->CellCorners = this->Part.Result.Triangles.size();
    this->PutTogether(part, progress, this->Part);
  }
}

void PartStore::Forget(int part)
{
  for (std::size_t box = 0; box < BoxNames().size(); ++box)
  {
    this->Crew.At(part, static_cast<int>(box)).Clear();
  }
}

// In memory the part leaves the store, which has none then.
SurfacePart PartStore::TakeWhole(int part, const Progress& progress)
{
  if (!this->Crew.IsInFiles())
  {
    this->MakeWhole(part, progress);
  }
  SurfacePart taken =
    this->Crew.IsInFiles() ? this->ReadWhole(part, progress) : std::move(this->Part);
  // No other id is as high: FirstLineId is above the largest of all that were given.
  taken.AddedPoints = static_cast<Index>(std::count_if(taken.OwnPoints.Ids.begin(),
    taken.OwnPoints.Ids.end(), [this](vtkIdType id) { return id >= this->FirstLineId; }));
  return taken;
}

// From files without sorting: stretches as they came, each in the order of ids.
void PartStore::ForEachRows(const std::function<void(const PointTable&)>& visit) const
{
  for (int part = this->Crew.FirstOwn(); part < this->Crew.EndOwn(); ++part)
  {
    if (!this->Crew.IsInFiles())
    {
      visit(this->Part.OwnPoints);
      continue;
    }
    this->Crew.At(part, OwnPoints).ForEach([&](const Bytes& bytes) {
      PointTable rows(this->Part.Kinds);
      rows.Unpack(&bytes, 1);
      visit(rows);
    });
  }
}

// For the search for a lattice, which looks at x,y,z alone; but rows are read with their arrays.
PointSlices PartStore::Slices() const
{
  return { static_cast<double>(this->OwnCount()), [this](const auto& visit) {
            this->ForEachRows([&visit](const PointTable& rows) { visit(ViewOf(rows).View); });
          } };
}

} // namespace elevation
