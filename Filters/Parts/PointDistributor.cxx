// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Points come in two ways, which differ until they are sent. At once: the arrays stay VTK's until
 * rows of them are packed, and ranks may have different arrays, of which those are kept that all
 * have. In slices: rows are packed into files, which go as they are sent; as no rank can look at
 * its points again, all slices need the same arrays.
 *
 * The samples differ too. At once, the number of points is known, and one point of each stretch of
 * some is taken: about 1,000 for each part, or more where parts are few. All ranks get them. In
 * slices, a hash of the index decides, and the sample is thinned whenever it is too large; it is
 * the same however the slices are cut.
 */
#include "PointDistributor.h"

#include "Adapt/Adapt.h"
#include "PointKeys.h"

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
constexpr const char* IdsName = "GlobalPointIds";
// A stretch takes 32 MB and the values of its arrays, and is what a rank has in memory in pass 4.
// The largest sample of slices takes 12 MB on a rank. A thousand points for each part balance the
// cells to within a tenth (Cuts.h).
constexpr vtkIdType PointsInStretch = 1 << 20; // of slices, and in a file
constexpr std::size_t MostSampled = 1 << 19;   // of slices
constexpr vtkIdType SamplePerPart = 1000;      // of points that come at once
// Among few parts, what one has more than another is most of what ranks wait for: a larger sample.
constexpr vtkIdType SampleOfFewParts = 1 << 14, PointsPerSample = 64;

/** An index of the stretch [0, size) by such a rule. */
vtkIdType IndexInStretch(vtkIdType stretch, vtkIdType size)
{
  return static_cast<vtkIdType>((HashOf(stretch) >> 16) % static_cast<std::uint64_t>(size));
}

/**
 * Whether slices have the same arrays; names of components and attributes are those of the last.
 */
bool AreSame(const std::vector<ArrayKind>& kinds, const std::vector<ArrayKind>& others)
{
  return std::equal(kinds.begin(), kinds.end(), others.begin(), others.end(),
    [](const ArrayKind& kind, const ArrayKind& other) {
      // Whether ids are given may not change either: indices would meet given ids.
      constexpr int ids = vtkDataSetAttributes::GLOBALIDS;
      return kind.Name == other.Name && kind.Type == other.Type &&
        kind.Components == other.Components && (kind.Attribute == ids) == (other.Attribute == ids);
    });
}

/** For slices of one rank, and for those of all of them. */
Error DifferentArrays()
{
  return Error("Points that are added need the same point arrays as those before.");
}

/** Takes global ids out of the kinds of arrays, or finds a name for them. @return whether given */
bool TakeIdKind(std::vector<ArrayKind>& kinds, std::string& name)
{
  // Ids of any kind of integer; else the array is one of values, and stays among the arrays.
  const auto ids = std::find_if(kinds.begin(), kinds.end(), [](const ArrayKind& kind) {
    return kind.Attribute == vtkDataSetAttributes::GLOBALIDS && kind.Components == 1 &&
      kind.Type != VTK_FLOAT && kind.Type != VTK_DOUBLE && kind.Type != VTK_STRING &&
      kind.Type != VTK_BIT;
  });
  if (ids != kinds.end())
  {
    name = ids->Name;
    kinds.erase(ids);
    return true;
  }
  name = IdsName;
  const auto isTaken = [&name](const ArrayKind& kind) { return kind.Name == name; };
  // The array of the output must not replace one of the user.
  while (std::any_of(kinds.begin(), kinds.end(), isTaken))
  {
    name += "_";
  }
  return false;
}
} // namespace

PointDistributor::PointDistributor(const Ranks& ranks, const std::string& folder)
  : AllRanks(ranks)
{
  if (folder.empty())
  {
    return;
  }
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
  this->Folder = folder;
}

PointDistributor::~PointDistributor() = default;

/**
 * The arrays of a slice; the others need the same. This rank alone decides, as others may have
 * added none yet.
 */
void PointDistributor::TakeKinds(vtkPointSet* points)
{
  CheckPointArrays(points);
  std::set<std::string> leftOut;
  // As if this rank were alone: no rank waits for another in Add().
  std::vector<ArrayKind> kinds = CommonArrays(Ranks(), points->GetPointData(), leftOut);
  if (!leftOut.empty())
  {
    throw Error("Point array \"" + *leftOut.begin() + "\" cannot be written to a file.");
  }
  if (this->OwnCount > 0 && !AreSame(kinds, this->Kinds))
  {
    throw DifferentArrays();
  }
  this->Kinds = std::move(kinds);
  // Without values, for CommonArrays() on all ranks
  this->Arrays->CopyAllOn();
  this->Arrays->CopyAllocate(points->GetPointData(), 1);
  if (points->GetPoints()->GetDataType() != VTK_FLOAT)
  {
    this->PointType = VTK_DOUBLE;
  }
}

// A slice is written in stretches, which go one at a time in the last pass.
void PointDistributor::Add(vtkPointSet* points, const Progress& progress)
{
  if (!points || points->GetNumberOfPoints() == 0)
  {
    return;
  }
  if (!this->IsInFile())
  {
    this->Input = points;
    this->OwnCount = points->GetNumberOfPoints();
    return;
  }
  this->TakeKinds(points);
  std::vector<ArrayKind> kinds = this->Kinds;
  std::string idsName;
  this->AreGiven = TakeIdKind(kinds, idsName);
  this->Rows = PointTable(kinds);
  this->Read(points, idsName, this->OwnCount);
  const vtkIdType count = static_cast<vtkIdType>(this->Rows.Count());
  for (vtkIdType first = 0; first < count; first += PointsInStretch)
  {
    Report(progress, static_cast<double>(first) / static_cast<double>(count));
    std::vector<vtkIdType> indices;
    for (vtkIdType at = first; at < std::min(first + PointsInStretch, count); ++at)
    {
      if (!IsCopy(this->Rows.Marks(), at))
      {
        indices.push_back(at);
      }
    }
    const Bytes packed = this->Rows.Pack(indices);
    // Short slices share a file until it has as much as a stretch: not a file for each slice.
    if (this->InLastStretch + static_cast<vtkIdType>(indices.size()) > PointsInStretch ||
      this->Stretches.empty())
    {
      this->Stretches.emplace_back(
        this->Folder + "/added-points-" + std::to_string(this->Stretches.size()));
      this->InLastStretch = 0;
    }
    this->Stretches.back().Append(packed.data(), packed.size());
    this->InLastStretch += static_cast<vtkIdType>(indices.size());
    this->SampleStretch(indices);
  }
  // Also points of other ranks, so that an index stays that in the input.
  this->OwnCount += count;
  this->Rows = PointTable();
}

/**
 * A hash of its index decides whether a point is in the sample; of one too large each other goes,
 * as the mask gets another bit: what remains is what the longer mask would have chosen from the
 * start.
 */
void PointDistributor::SampleStretch(const std::vector<vtkIdType>& indices)
{
  for (const vtkIdType at : indices)
  {
    const vtkIdType index = this->OwnCount + at;
    if (((HashOf(index) >> 20) & this->SampleMask) == 0 && this->Rows.IsFinite(at))
    {
      this->Sample.push_back({ index, { this->Rows.At(at)[0], this->Rows.At(at)[1] } });
    }
  }
  while (this->Sample.size() > MostSampled)
  {
    this->SampleMask = 2 * this->SampleMask + 1;
    this->KeepSample();
  }
}

/** Keeps what the mask admits; the order stays. */
void PointDistributor::KeepSample()
{
  const auto out =
    std::remove_if(this->Sample.begin(), this->Sample.end(), [this](const SampledPoint& point) {
      return ((HashOf(point.Position) >> 20) & this->SampleMask) != 0;
    });
  this->Sample.erase(out, this->Sample.end());
}

/**
 * All ranks agree on the arrays, whether coordinates are float, and the number of each rank's first
 * point. Errors in the arrays name the rank.
 */
void PointDistributor::NumberPoints(SurfacePart& common)
{
  this->AllRanks.Agree([&]() {
    this->AllRanks.NameErrors([&]() {
      if (this->Input)
      {
        CheckPointArrays(this->Input);
        const bool areDouble = ViewPoints(this->Input).View.Double != nullptr;
        this->PointType = areDouble ? VTK_DOUBLE : VTK_FLOAT;
      }
    });
  });
  vtkPointData* const arrays = this->Input ? this->Input->GetPointData() : this->Arrays.Get();
  common.Kinds =
    CommonArrays(this->AllRanks, this->OwnCount > 0 ? arrays : nullptr, common.LeftOut);
  const bool areGiven = TakeIdKind(common.Kinds, common.IdsName);
  // In files each slice was read by what its rank knew: ids cannot become indices now.
  const bool areOthers = this->OwnCount > 0 && this->AreGiven != areGiven;
  if (this->IsInFile() && (!common.LeftOut.empty() || IsOnAny(this->AllRanks, areOthers)))
  {
    throw DifferentArrays(); // on all ranks
  }
  this->AreGiven = areGiven;
  // Numbers without ids go on from rank to rank, as if all points came from one.
  const std::vector<vtkIdType> counts =
    this->AllRanks.Collect(std::vector<vtkIdType>{ this->OwnCount });
  common.PointType =
    IsOnAny(this->AllRanks, this->PointType == VTK_DOUBLE) ? VTK_DOUBLE : VTK_FLOAT;
  this->First =
    std::accumulate(counts.begin(), counts.begin() + this->AllRanks.OwnRank(), vtkIdType(0));
  this->Rows = PointTable(common.Kinds);
  this->AllRanks.Agree([&]() {
    if (this->Input)
    {
      this->Read(this->Input, common.IdsName, this->First);
    }
  });
}

/**
 * Rows of points, with the ids given, if any. Points of other ranks have rows, as indices are those
 * of the input, but go nowhere: their owner sends them.
 */
void PointDistributor::Read(vtkPointSet* points, const std::string& idsName, vtkIdType first)
{
  this->Rows.Read(points, first);
  vtkDataArray* const ids =
    this->AreGiven ? points->GetPointData()->GetArray(idsName.c_str()) : nullptr;
  this->Rows.Ids.Resize(ids ? this->Rows.Count() : 0);
  for (vtkIdType at = 0; ids && at < ids->GetNumberOfTuples(); ++at)
  {
    this->Rows.Ids[at] = IdAt(ids, at);
  }
}

/**
 * A sample of points that come at once: one of each stretch of some, at an index that follows no
 * rule, as rows of a grid may be as long as a stretch.
 */
std::vector<Point2> PointDistributor::SampleAtOnce(vtkIdType parts) const
{
  const vtkIdType count = static_cast<vtkIdType>(this->Rows.Count());
  std::vector<vtkIdType> all = { count };
  // The same stretch on all ranks: each point of all has the same chance, whatever rank it is on.
  this->AllRanks.Sum(all);
  const vtkIdType sample =
    std::max(SamplePerPart * parts, std::min(SampleOfFewParts, all[0] / PointsPerSample));
  const vtkIdType stretch = std::max<vtkIdType>(1, all[0] / sample);
  std::vector<Point2> sampled;
  this->AllRanks.Agree([&]() {
    for (vtkIdType i = 0; i * stretch < count; ++i)
    {
      const vtkIdType at = i * stretch + IndexInStretch(i, std::min(stretch, count - i * stretch));
      const double* const p = this->Rows.At(at);
      if (this->Rows.IsFinite(at) && !IsCopy(this->Rows.Marks(), at))
      {
        sampled.push_back({ p[0], p[1] });
      }
    }
  });
  return sampled;
}

/** Cuts the plane by the samples of all ranks, on each of them alike. */
Cuts PointDistributor::CutPlane(int parts)
{
  std::vector<Point2> sampled;
  if (this->IsInFile())
  {
    // All ranks choose by the same mask, that of the one with most points: each point of all ranks
    // is in the sample as likely as any other.
    std::vector<double> mask = { static_cast<double>(this->SampleMask) };
    this->AllRanks.Maximum(mask);
    this->SampleMask = static_cast<std::uint64_t>(mask[0]);
    this->KeepSample();
    for (const SampledPoint& point : this->Sample)
    {
      sampled.push_back(point.At);
    }
    this->Sample = std::vector<SampledPoint>();
  }
  else
  {
    sampled = this->SampleAtOnce(parts);
  }
  // Rank after rank: the same list on all of them, from which each cuts in the same way.
  sampled = this->AllRanks.Collect(sampled);
  std::unique_ptr<Cuts> plane;
  this->AllRanks.Agree([&]() { plane = std::make_unique<Cuts>(std::move(sampled), parts); });
  return std::move(*plane);
}

/**
 * Sends own points, in their order. Memory is given back as rows are packed, part by part. Where
 * parts are in memory, what goes to that of this rank is not packed: an empty list stands for it.
 */
void PointDistributor::SendSlice(const Cuts& plane, Engine& engine, int box,
  const Progress& progress, std::vector<vtkIdType>& counts)
{
  // First the parts alone, so that the indices of each take no more memory than they need.
  const int firstOwn = engine.FirstOwn();
  const std::uint64_t ownCount = static_cast<std::uint64_t>(engine.EndOwn() - firstOwn);
  Buffer<int> partOf;
  partOf.Resize(this->Rows.Count());
  std::vector<std::size_t> sizes(counts.size(), 0);
  vtkUnsignedCharArray* const marks = this->Rows.Marks();
  for (std::size_t at = 0; at < partOf.size(); ++at)
  {
    ReportStep(progress, at, partOf.size(), 1 << 16);
    if (IsCopy(marks, static_cast<vtkIdType>(at)))
    {
      partOf[at] = None;
      continue;
    }
    const double* const p = this->Rows.At(at);
    // A rank with points holds at least one part (TriangulateParts.h), so it never divides by 0. By
    // the id, not by the index: where a point goes must not depend on how slices were cut.
    partOf[at] = this->Rows.IsFinite(at)
      ? plane.OwnerOf({ p[0], p[1] })
      : firstOwn + static_cast<int>(static_cast<std::uint64_t>(this->Rows.IdOf(at)) % ownCount);
    ++sizes[partOf[at]];
  }
  std::vector<std::vector<vtkIdType>> indices(counts.size());
  for (std::size_t part = 0; part < indices.size(); ++part)
  {
    indices[part].reserve(sizes[part]);
    counts[part] += static_cast<vtkIdType>(sizes[part]);
  }
  for (std::size_t at = 0; at < partOf.size(); ++at)
  {
    if (partOf[at] != None)
    {
      indices[partOf[at]].push_back(static_cast<vtkIdType>(at));
    }
  }
  for (std::size_t part = 0; part < indices.size(); ++part)
  {
    Report(progress, 1.0);
    if (!this->IsInFile() && engine.IsOwn(static_cast<int>(part)))
    {
      this->Staying = std::exchange(indices[part], {});
      engine.Send(static_cast<int>(part), box, this->Rows.Pack({}));
    }
    else if (!indices[part].empty())
    {
      engine.Send(static_cast<int>(part), box, this->Rows.Pack(indices[part]));
      indices[part] = std::vector<vtkIdType>();
    }
  }
}

/** Where parts are in memory: the points of that of this rank, from all ranks in their order. */
void PointDistributor::JoinOwn(Engine& engine, int box, PointTable& own)
{
  for (int part = engine.FirstOwn(); part < engine.EndOwn(); ++part)
  {
    std::vector<Bytes> fromRanks = engine.At(part, box).Take();
    const auto add = [](std::size_t sum, const Bytes& rows) {
      return sum + PointTable::CountIn(rows);
    };
    own.Resize(std::accumulate(fromRanks.begin(), fromRanks.end(), this->Staying.size(), add));
    std::size_t next = 0;
    for (Bytes& rows : fromRanks)
    {
      next = PointTable::CountIn(rows) == 0 ? own.Copy(this->Rows, this->Staying, next)
                                            : own.Unpack(rows, next);
      rows = Bytes();
    }
    this->Staying = std::vector<vtkIdType>();
  }
}

/*
 * Slice by slice, all ranks send and deliver together until none has a slice left. So no more than
 * a slice of each rank is in memory. Points that come at once are one slice.
 */
Cuts PointDistributor::Distribute(Engine& engine, int box, const Progress& progress,
  SurfacePart& common, std::vector<vtkIdType>& counts)
{
  this->NumberPoints(common);
  Cuts plane = this->CutPlane(engine.PartCount());
  counts.assign(engine.PartCount(), 0);
  double done = 0.0; // points
  auto next = this->Stretches.begin();
  bool isMore = true;
  while (isMore)
  {
    // Packing may fail, so it stands in a step; then all deliver together.
    this->AllRanks.Agree([&]() {
      Progress ofSlice = this->AllRanks.Watched(progress);
      double begin = 0.0, end = 1.0;
      // A rank whose slices are all sent sends nothing, but delivers.
      if (next != this->Stretches.end())
      {
        this->Rows = PointTable(common.Kinds);
        this->Rows.Unpack((next++)->Take());
        const double all = static_cast<double>(this->OwnCount);
        begin = done / all;
        end = (done += static_cast<double>(this->Rows.Count())) / all;
        // In files, ids that are not given are indices among the points of this rank.
        for (vtkIdType& id : this->Rows.Ids)
        {
          id += this->AreGiven ? 0 : this->First;
        }
      }
      this->SendSlice(plane, engine, box, ofSlice.Between(begin, end), counts);
    });
    engine.Deliver();
    this->AllRanks.Agree([&]() {
      if (!this->IsInFile())
      {
        common.OwnPoints = PointTable(common.Kinds);
        this->JoinOwn(engine, box, common.OwnPoints);
      }
      this->Rows = PointTable();
    });
    // At once, there is no stretch: one round.
    isMore = IsOnAny(this->AllRanks, next != this->Stretches.end());
  }
  return plane;
}

} // namespace elevation
