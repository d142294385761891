// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How a filter calls the kernel: for each block of the input; progress and abort go in, warnings
 * and exceptions come out as one message of the filter. Private to the module.
 *
 * The way of a run; all ranks are together at the steps with a star, of several ranks:
 *
 *     * list the leaves of the input in the outputs (Blocks.h); share the second input
 *     * for each block with points on several ranks: Spread, or gather it to one of them
 *       for each leaf of this rank: prepare the input, call the body, finish the outputs
 *     * add up the results, and whether any rank was aborted
 *     * report: rank 0 for all
 *
 * Preparing leaves out hidden cells, sets the precision of points and adds original ids; finishing
 * removes unused points and rounds. So a body sees none of this.
 */
#ifndef FilterRun_h
#define FilterRun_h

#include "Adapt/Adapt.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <exception>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace elevation
{
class Ranks;
enum class PartKind;
struct Leaf;

/** What is worked on at a time: the input, or one block of it. */
struct Block
{
  vtkPointSet* Input;                ///< of the first type that port 0 requires
  vtkPolyData* Second;               ///< input 1, joined; nullptr if there is none
  std::vector<vtkPolyData*> Outputs; ///< of each port
  elevation::Progress Progress;
  std::vector<Message> Warnings; ///< to be reported
  /**
   * Why FilterRun::Spread wants it to be gathered, a {reason} of OnOneRank; none: it cannot say.
   */
  Message WhyGathered = Message();
};

/**
 * Runs the body of a RequestData for each block of the input.
 *
 * Progress rises by the number of points of the blocks. When the body throws, the outputs of the
 * block are emptied. What it throws, and the warnings, are reported as one error and one warning of
 * the filter; these name the blocks of a composite. After an abort all outputs are empty, on all
 * ranks, and one warning says so.
 *
 * Where several ranks take part (Ranks), all of them meet here, whatever blocks each has: before
 * the blocks, to hand the second input to all, and to bring blocks that are spread over ranks to
 * one of them, the one with most of it (or the filter works on them in its own way: Spread); and
 * after them, to add up the results. Rank 0 reports for all.
 */
class FilterRun
{
public:
  /**
   * @param[in] controller  of the processes that may take part; nullptr: this one alone
   * @param[out] messages   what GetMessages() of the filter returns
   */
  FilterRun(vtkAlgorithm* filter, vtkMultiProcessController* controller, vtkInformation* request,
    vtkInformationVector** inputs, vtkInformationVector* outputs, vtkStringArray* messages);

  std::string Second; ///< what messages call input 1
  bool SecondGivesPoints = true; ///< whether input 1, which is double, may add points to outputs
  /**
   * Of how many first outputs points that no cell has are removed. Then points have original ids
   * (UsedPoints.h): on several ranks global ids or indices in the input, rank after rank.
   */
  int CleanedOutputs = 0;
  int Precision = 2;        ///< OutputPointsPrecision
  bool ListsUnused = false; ///< whether the filter lists unused points in field data
  /**
   * Results of the filter: set to 0, and added up (the largest taken) over blocks and ranks. What
   * a block that fails has added is taken back.
   */
  std::vector<vtkIdType*> Sums;
  std::vector<double*> Maxima;
  /**
   * The filter's own way to work on a block that is spread over ranks, instead of gathering it and
   * running the body there; may be empty. All ranks call it for the same blocks in the same order.
   * Input is this rank's part, maybe without points; Outputs are none where the block has no leaf
   * on this rank.
   * It throws on all ranks or on none, with the same message (Ranks::Agree).
   * @return on all ranks, false to have the block gathered, with a warning
   */
  std::function<bool(Block&, const Ranks&)> Spread;

  /**
   * @return what RequestData returns: on all ranks 0 after an error in any block
   */
  int Run(const std::function<void(Block&)>& body);

private:
  void EmptyOutputs();
  /**
   * The second input in one, of all ranks, in double precision; nullptr: none. All ranks call it.
   */
  vtkSmartPointer<vtkPolyData> ShareSecond(const Ranks& ranks) const;
  /** Whether this rank gives the messages of a leaf: of one block, one rank does. */
  bool ShouldReport(const Leaf& leaf, const Ranks& ranks) const;
  /** Works on the blocks that are spread over ranks. @return the progress that has been made */
  double GatherSpreadBlocks(
    std::vector<Leaf>& leaves, const Ranks& ranks, vtkPolyData* second, const Progress& progress);
  /** What the filter works on. @param[in] first  index of the first point in the block */
  vtkSmartPointer<vtkPointSet> Prepared(
    vtkPointSet* input, vtkPolyData* second, vtkIdType first, std::vector<Message>& warnings) const;
  void PrepareParts(const std::vector<Leaf*>& leaves, const Ranks& ranks, vtkPolyData* second);
  void CountIfDone(const std::function<void()>& work) const;
  /** After a body: removes unused points, and rounds. All ranks that have the block call it. */
  void FinishOutputs(Block& block, const Ranks& ranks) const;
  /** Works on a block by Spread. @return false on all ranks if it has to be gathered */
  bool RunSpread(const std::vector<Leaf*>& leaves, const Ranks& ranks, vtkPolyData* second,
    const Progress& progress, Message& whyGathered);
  /** Adds messages of this rank about a block that is spread, with the name of the block. */
  void AddMessages(const std::vector<Leaf*>& leaves, const std::vector<Message>& messages,
    std::vector<Message>& all) const;
  /** Whether the first input is a mesh, or points whose cells do not count. */
  PartKind InputKind() const;
  void RunLeaves(std::vector<Leaf>& leaves, const Ranks& ranks, vtkPolyData* second,
    const std::function<void(Block&)>& body);
  /**
   * Calls the body for a leaf. @return the error, if any; outputs are empty then. @throws Aborted
   */
  Message RunLeaf(const Leaf& leaf, Block& block, const std::function<void(Block&)>& body);
  /** Adds up results and aborts of all ranks; after an abort anywhere, all outputs become empty. */
  void ShareResults(const Ranks& ranks);
  bool IsAbortReported() const;
  void Report(const Ranks& ranks) const;

  vtkAlgorithm* Filter;
  vtkMultiProcessController* Controller;
  vtkInformation* Request;
  vtkInformationVector** Inputs;
  vtkInformationVector* Outputs;
  vtkStringArray* Messages;
  std::vector<Message> Errors, Warnings;
  bool IsAborted = false;
  std::set<std::string> Occupied; ///< paths of the blocks with points, on any rank
};

} // namespace elevation

#endif
