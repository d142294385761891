// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * A leaf is a data set of this rank's input with its outputs (Blocks.h); a block is what all
 * ranks' leaves of one path are together. On one rank each leaf is a block of its own.
 *
 * Failures: what a block throws is kept as an error of the block, and the other blocks go on. What
 * is thrown outside of blocks, as by a second input that cannot be read, ends the run. An abort
 * ends it, too, and empties everything on all ranks, as what there is by then depends on the order
 * of blocks.
 */
#include "FilterRun.h"

#include "Adapt/Adapt.h"
#include "BlocksOnRanks.h"
#include "Gathering.h"
#include "PointKeys.h"
#include "Ranks.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <numeric>
#include <sstream>

namespace elevation
{

namespace
{
/** Whether it can have no points: it is an image, say, and an error. */
bool IsOtherType(const Leaf& leaf)
{
  return !vtkPointSet::SafeDownCast(leaf.Input);
}

/** The type of the first input, in any block: what the filter named first in FillInput(). */
const char* RequiredType(vtkAlgorithm* filter)
{
  return filter->GetInputPortInformation(0)->Get(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), 0);
}

/**
 * Warns that a block has been gathered, if it has cells or there is another reason to warn. A block
 * without cells loses nothing by it.
 */
void WarnOfGathering(Leaf* home, const Message& why)
{
  if (home && (!why.IsEmpty() || home->Input->GetNumberOfElements(vtkDataObject::CELL) > 0))
  {
    home->Warning = MakeMessage<sentences::OnOneRank>(
      why.IsEmpty() ? MakeMessage<sentences::PartsDoNotFit>() : why);
  }
}

/** Whether a filter before this one was stopped: that one reports it, or who stopped it knows. */
bool IsStoppedBefore(vtkAlgorithm* filter, vtkInformationVector** inputs)
{
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      if (IsIncomplete(inputs[port]->GetInformationObject(i)))
      {
        return true;
      }
    }
  }
  return false;
}

void EmptyOutputs(const Leaf& leaf)
{
  for (vtkPolyData* output : leaf.Outputs)
  {
    output->Initialize();
  }
}

/**
 * Removes the points that no cell has. A rank keeps its own that cells of another have, so that
 * each point still belongs to one. All ranks call it, those without an output with nullptr.
 *
 *     rank 0 owns p, and no cell here has it      rank 1 has a ghost of p, in a cell
 *     keeps p, as its key has come            <-- sends the key of p
 *                                                 keeps its ghost, as a cell has it
 */
void KeepUsed(vtkPolyData* surface, const Ranks& ranks, const Progress& progress)
{
  std::vector<char> areUsed;
  // Of points of others that are used here. Without ids, points at one position are known by their
  // order, as in CommonPoints: the last number counts those before.
  using UsedKey = std::array<std::int64_t, 4>;
  std::vector<UsedKey> keys;
  std::map<PointKey, std::int64_t> counts;
  const auto next = [&counts](const PointKey& key) {
    return UsedKey{ { key[0], key[1], key[2], counts[key]++ } };
  };
  const bool hasPoints = surface && surface->GetNumberOfPoints() > 0;
  // Either all ranks go by ids or none does: keys of both kinds would not meet.
  const bool byIds = !IsOnAny(ranks, hasPoints && !surface->GetPointData()->GetGlobalIds());
  // Ghosts or own points, that are used here or not.
  const auto forEach = [&](bool areCopies, bool areUsedHere, const auto& visit) {
    for (std::size_t i = 0; i < areUsed.size(); ++i)
    {
      const vtkIdType point = static_cast<vtkIdType>(i);
      if (bool(areUsed[i]) == areUsedHere &&
        IsCopy(GhostsOf(surface->GetPointData()), point) == areCopies)
      {
        visit(areUsed[i], PointKeys(surface, byIds).Of(point));
      }
    }
  };
  ranks.Agree([&] {
    areUsed = hasPoints ? FlagUsed(surface) : std::vector<char>();
    // One rank alone may have a copy and the own point, as where parts have been appended.
    if (ranks.Count() > 1)
    {
      forEach(true, true, [&](char, const PointKey& key) { keys.push_back(next(key)); });
    }
  });
  keys = ranks.Collect(keys);
  ranks.Agree([&] {
    // Only now is it known which of the own points another rank uses.
    std::sort(keys.begin(), keys.end());
    counts.clear();
    const auto isUsedBy = [&](const PointKey& key) {
      const auto has = [&keys](const UsedKey& used) {
        return std::binary_search(keys.begin(), keys.end(), used);
      };
      return has({ { key[0], key[1], key[2], 0 } }) && has(next(key));
    };
    // A point that is used here may be the one; then no other at its position stays.
    forEach(false, true, [&](char, const PointKey& key) { isUsedBy(key); });
    forEach(false, false, [&](char& isUsed, const PointKey& key) { isUsed = isUsedBy(key); });
    if (hasPoints)
    {
      KeepFlagged(areUsed, 1, progress, surface);
    }
  });
}
} // namespace

FilterRun::FilterRun(vtkAlgorithm* filter, vtkMultiProcessController* controller,
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs,
  vtkStringArray* messages)
  : Filter(filter)
  , Controller(controller)
  , Request(request)
  , Inputs(inputs)
  , Outputs(outputs)
  , Messages(messages)
{
}

int FilterRun::Run(const std::function<void(Block&)>& body)
{
  // An error here is that of a request for too many pieces, on all ranks; it leaves Run().
  const Ranks ranks(this->Controller, this->Request, this->Outputs, [this](const Message& waiting) {
    ReportMessages(this->Filter, {}, { waiting }, this->Messages);
  });
  for (vtkIdType* sum : this->Sums)
  {
    *sum = 0;
  }
  for (double* maximum : this->Maxima)
  {
    *maximum = 0.0;
  }
  try
  {
    std::vector<Leaf> leaves;
    ranks.Agree(
      [&] { leaves = ListLeaves(vtkDataObject::GetData(this->Inputs[0]), this->Outputs); });
    const vtkSmartPointer<vtkPolyData> second = this->ShareSecond(ranks);
    this->RunLeaves(leaves, ranks, second, body);
  }
  catch (const std::exception& error)
  {
    this->EmptyOutputs();
    // On all ranks the same, as it was thrown by Agree().
    this->Errors = { MessageOf(error) };
    this->Warnings.clear();
  }
  this->Report(ranks);
  return IsOnAny(ranks, !this->Errors.empty()) ? 0 : 1;
}

/** Whether the run before was aborted, too, and has said so. */
bool FilterRun::IsAbortReported() const
{
  return this->Messages->GetNumberOfValues() > 1 &&
    this->Messages->GetValue(1) == sentences::Stopped.Code;
}

void FilterRun::Report(const Ranks& ranks) const
{
  const std::vector<Message> errors = OnFirst(this->Errors, ranks);
  const std::vector<Message> warnings = OnFirst(this->Warnings, ranks);
  if (!this->IsAborted || !this->IsAbortReported())
  {
    ReportMessages(this->Filter, errors, warnings, this->Messages);
  }
}

void FilterRun::EmptyOutputs()
{
  for (int port = 0; port < this->Outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject::GetData(this->Outputs, port)->Initialize();
  }
}

vtkSmartPointer<vtkPolyData> FilterRun::ShareSecond(const Ranks& ranks) const
{
  if (this->Filter->GetNumberOfInputPorts() < 2)
  {
    return nullptr;
  }
  vtkSmartPointer<vtkPolyData> second =
    ShareLines(vtkDataObject::GetData(this->Inputs[1]), this->Second, ranks);
  ranks.Agree([&second] {
    second = second ? vtkPolyData::SafeDownCast(WithPointsFor(true, second)) : nullptr;
  });
  return second;
}

bool FilterRun::ShouldReport(const Leaf& leaf, const Ranks& ranks) const
{
  // A block that is empty on all ranks is reported on by rank 0, so that somebody is.
  return HasPoints(leaf) || IsOtherType(leaf) ||
    (ranks.OwnRank() == 0 && this->Occupied.count(leaf.Path) == 0);
}

double FilterRun::GatherSpreadBlocks(
  std::vector<Leaf>& leaves, const Ranks& ranks, vtkPolyData* second, const Progress& progress)
{
  const std::map<std::string, int> spread = FindSpread(leaves, ranks, this->Occupied);
  // Gathering alone is short; the filter's own way on ranks is nearly all of the work.
  const double share = this->Spread ? 0.9 : 0.1;
  double done = 0.0;
  // In the order of their paths, the same on all ranks: each block is a series of meetings.
  for (const auto& block : spread)
  {
    const double next = done + share / static_cast<double>(spread.size());
    const Progress ofBlock = progress.Between(done, next);
    done = next;
    std::vector<Leaf*> own;
    for (Leaf& leaf : leaves)
    {
      // A rank may have several leaves of a block: partitions. An image among them is an error
      // later.
      if (leaf.Path == block.first && !IsOtherType(leaf))
      {
        own.push_back(&leaf);
      }
    }
    try
    {
      Message why;
      this->PrepareParts(own, ranks, second);
      if (!this->RunSpread(own, ranks, second, ofBlock, why))
      {
        std::vector<Message> warnings;
        GatherBlock(own, block.second, this->InputKind(), ranks, ofBlock, warnings);
        this->AddMessages(own, warnings, this->Warnings);
        WarnOfGathering(FirstWithPoints(own), why);
      }
    }
    catch (const Aborted&) // on all ranks
    {
      this->IsAborted = true;
      return done;
    }
    // The block is done with on all ranks; the next one is worked on.
    catch (const std::exception& error) // on all ranks
    {
      this->AddMessages(own, { MessageOf(error) }, this->Errors);
      for (Leaf* leaf : own)
      {
        elevation::EmptyOutputs(*leaf);
        leaf->IsDone = true;
      }
    }
  }
  return done;
}

void FilterRun::AddMessages(const std::vector<Leaf*>& leaves, const std::vector<Message>& messages,
  std::vector<Message>& all) const
{
  for (std::size_t i = 0; i < messages.size() && !leaves.empty(); ++i)
  {
    all.push_back(messages[i]);
    // Ranks without a leaf say nothing: OnFirst() would keep the same message twice, with and
    // without the name.
    all.back().SetBlock(leaves.front()->BlockName);
  }
}

/**
 * What the filter works on: without hidden cells, with original ids where they are wanted, and with
 * points in the precision that is needed.
 */
vtkSmartPointer<vtkPointSet> FilterRun::Prepared(
  vtkPointSet* input, vtkPolyData* second, vtkIdType first, std::vector<Message>& warnings) const
{
  CheckPrecision(this->Precision);
  vtkSmartPointer<vtkPointSet> shown =
    WithPointsFor(NeedsDouble(this->Precision, second && this->SecondGivesPoints), input);
  if (this->InputKind() == PartKind::Mesh)
  {
    shown = WithoutHiddenCells(vtkPolyData::SafeDownCast(shown));
  }
  if (this->CleanedOutputs > 0)
  {
    shown = WithOriginalIds(shown, first, warnings);
  }
  // What was made anew has no mark, and a missing mark makes a warning of its own.
  CopyMark(input, shown);
  return shown;
}

/** Makes the parts of a block what the filter works on. */
void FilterRun::PrepareParts(
  const std::vector<Leaf*>& leaves, const Ranks& ranks, vtkPolyData* second)
{
  std::vector<Message> warnings;
  std::vector<vtkIdType> counts(1, 0);
  for (vtkPointSet* part : PartsOf(leaves))
  {
    counts[0] += part->GetNumberOfPoints();
  }
  counts = ranks.Collect(counts);
  // The index of a point in the block is counted over ranks, and over partitions within a rank.
  vtkIdType first = std::accumulate(counts.begin(), counts.begin() + ranks.OwnRank(), vtkIdType(0));
  ranks.Agree([&] {
    for (Leaf* leaf : leaves)
    {
      if (HasPoints(*leaf))
      {
        auto* const points = vtkPointSet::SafeDownCast(leaf->Input);
        leaf->Made = this->Prepared(points, second, first, warnings);
        first += points->GetNumberOfPoints();
        leaf->Input = leaf->Made;
      }
    }
  });
  this->AddMessages(leaves, warnings, this->Warnings);
}

/**
 * Does work. If that fails, the results of the filter are those before: a body adds to them as it
 * goes.
 */
void FilterRun::CountIfDone(const std::function<void()>& work) const
{
  std::vector<vtkIdType> sums;
  std::vector<double> maxima;
  std::transform(this->Sums.begin(), this->Sums.end(), std::back_inserter(sums),
    [](const vtkIdType* sum) { return *sum; });
  std::transform(this->Maxima.begin(), this->Maxima.end(), std::back_inserter(maxima),
    [](const double* maximum) { return *maximum; });
  try
  {
    work();
  }
  catch (...)
  {
    for (std::size_t i = 0; i < sums.size(); ++i)
    {
      *this->Sums[i] = sums[i];
    }
    for (std::size_t i = 0; i < maxima.size(); ++i)
    {
      *this->Maxima[i] = maxima[i];
    }
    throw;
  }
}

/**
 * Leaves points that cells have in the surfaces of a block, and rounds them where that is asked
 * for; of several ranks, all call it.
 */
void FilterRun::FinishOutputs(Block& block, const Ranks& ranks) const
{
  for (std::size_t port = 0; port < static_cast<std::size_t>(this->CleanedOutputs); ++port)
  {
    vtkPolyData* const surface = block.Outputs.empty() ? nullptr : block.Outputs[port];
    // Before points are removed, while the list still names points that are there.
    if (surface && this->ListsUnused)
    {
      NameUnusedByOriginalIds(surface);
    }
    KeepUsed(surface, ranks, block.Progress.Between(1.0, 1.0));
  }
  if (this->Precision == vtkAlgorithm::SINGLE_PRECISION)
  {
    ranks.Agree([&block] { RoundPoints(block.Outputs); });
  }
}

/*
 * The result goes to the outputs of the first leaf with points, or of any; the other leaves of the
 * block on this rank, partitions, become empty: they are the parts of one surface.
 */
bool FilterRun::RunSpread(const std::vector<Leaf*>& leaves, const Ranks& ranks, vtkPolyData* second,
  const Progress& progress, Message& whyGathered)
{
  if (!this->Spread)
  {
    return false;
  }
  // The parts of a block on this rank in one, even if it has none: all ranks take part.
  Block block{ nullptr, second, {}, progress, {} };
  // Kept alive here: a block only points to its input.
  vtkSmartPointer<vtkPointSet> own;
  ranks.Agree([&] { own = JoinHere(PartsOf(leaves), this->InputKind(), block.Warnings); });
  block.Input = own;
  // A rank without points of the block may get some, if it has a leaf for them.
  Leaf* home = FirstWithPoints(leaves);
  home = home || leaves.empty() ? home : leaves.front();
  if (home)
  {
    block.Outputs = home->Outputs;
  }
  bool isDone = false;
  // Finishing counts nothing, but may throw: then the block failed, and nothing of it counts.
  this->CountIfDone([&] {
    isDone = this->Spread(block, ranks);
    if (isDone)
    {
      this->FinishOutputs(block, ranks);
    }
  });
  if (!isDone)
  {
    whyGathered = block.WhyGathered;
    return false;
  }
  this->AddMessages(leaves, block.Warnings, this->Warnings);
  // The other leaves of the block have nothing to work on any more.
  Empty(leaves);
  if (home)
  {
    home->IsDone = true;
  }
  return true;
}

PartKind FilterRun::InputKind() const
{
  return std::string(RequiredType(this->Filter)) == "vtkPolyData" ? PartKind::Mesh
                                                                  : PartKind::Points;
}

void FilterRun::RunLeaves(std::vector<Leaf>& leaves, const Ranks& ranks, vtkPolyData* second,
  const std::function<void(Block&)>& body)
{
  const Progress ofAll = ProgressOf(this->Filter);
  const Progress progress =
    ofAll.Between(this->GatherSpreadBlocks(leaves, ranks, second, ofAll), 1.0);
  // The 1 is for blocks without points: the sum must not be 0.
  const auto workOf = [](const Leaf& leaf) {
    auto* const points = vtkPointSet::SafeDownCast(leaf.Input);
    return 1.0 + (points ? points->GetNumberOfPoints() : 0);
  };
  double all = 0.0, done = 0.0;
  for (const Leaf& leaf : leaves)
  {
    all += workOf(leaf);
  }
  for (const Leaf& leaf : leaves)
  {
    if (this->IsAborted)
    {
      break;
    }
    // Also where nothing is made: a filter after this one must not warn of it again.
    std::for_each(leaf.Outputs.begin(), leaf.Outputs.end(), MarkAsReported);
    // A rank without points has the rest of the outputs, and leaves the messages to the others.
    const bool isReported = this->ShouldReport(leaf, ranks);
    const double next = done + workOf(leaf);
    Block block{ nullptr, isReported ? second : nullptr, leaf.Outputs,
      progress.Between(done / all, next / all), {} };
    done = next;
    Message error;
    try
    {
      error = leaf.IsDone ? Message() : this->RunLeaf(leaf, block, body);
    }
    catch (const Aborted&)
    {
      this->IsAborted = true;
      break;
    }
    if (!isReported)
    {
      continue;
    }
    // On how the data came here: before what the filter says of them.
    if (!leaf.Warning.IsEmpty())
    {
      block.Warnings.insert(block.Warnings.begin(), leaf.Warning);
    }
    // What was warned of before an error is about a result that is not there.
    if (!error.IsEmpty())
    {
      block.Warnings = { error };
    }
    std::vector<Message>& all = error.IsEmpty() ? this->Warnings : this->Errors;
    for (Message& message : block.Warnings)
    {
      message.SetBlock(leaf.Name);
      all.push_back(message);
    }
  }
  this->ShareResults(ranks);
}

Message FilterRun::RunLeaf(const Leaf& leaf, Block& block, const std::function<void(Block&)>& body)
{
  Message message;
  try
  {
    const char* const required = RequiredType(this->Filter);
    // The executive checks the type of the whole input alone, and a composite may have anything.
    if (!leaf.Input->IsA(required))
    {
      throw Error(std::string("It is a ") + leaf.Input->GetClassName() + ", but a " + required +
        " is needed.");
    }
    std::vector<Message> warnings;
    const vtkSmartPointer<vtkPointSet> input =
      this->Prepared(vtkPointSet::SafeDownCast(leaf.Input), block.Second, 0, warnings);
    block.Input = input;
    this->CountIfDone([&] {
      body(block);
      // This block is on one rank; others may be at work on theirs, so nobody is waited for.
      this->FinishOutputs(block, Ranks());
    });
    // Those of preparing come first, as preparing does.
    block.Warnings.insert(block.Warnings.begin(), warnings.begin(), warnings.end());
    return message;
  }
  catch (const Aborted&)
  {
    throw;
  }
  catch (const std::exception& error)
  {
    message = MessageOf(error);
  }
  elevation::EmptyOutputs(leaf);
  return message;
}

void FilterRun::ShareResults(const Ranks& ranks)
{
  // The first meeting after ranks were on their own: here each learns of an abort elsewhere.
  std::vector<vtkIdType> sums = { this->IsAborted || IsAbortRequested(this->Filter) ? 1 : 0 };
  for (vtkIdType* sum : this->Sums)
  {
    sums.push_back(*sum);
  }
  std::vector<double> maxima;
  for (double* maximum : this->Maxima)
  {
    maxima.push_back(*maximum);
  }
  ranks.Sum(sums);
  ranks.Maximum(maxima);
  this->IsAborted = sums[0] > 0; // on any rank
  for (std::size_t i = 0; i < this->Sums.size(); ++i)
  {
    *this->Sums[i] = this->IsAborted ? 0 : sums[i + 1];
  }
  for (std::size_t i = 0; i < maxima.size(); ++i)
  {
    *this->Maxima[i] = this->IsAborted ? 0.0 : maxima[i];
  }
  if (this->IsAborted)
  {
    // Those of composites with their blocks, so that all ranks have the same: nothing.
    this->EmptyOutputs();
    this->Errors.clear();
    this->Warnings.clear();
    // The executive runs an aborted filter again for each output: on all ranks, or on none.
    MarkIncomplete(this->Filter);
    if (!IsStoppedBefore(this->Filter, this->Inputs))
    {
      this->Warnings.push_back(MakeMessage<sentences::Stopped>());
    }
  }
}

} // namespace elevation
