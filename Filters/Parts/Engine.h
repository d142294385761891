// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Work on a surface that is cut into parts, and what the parts send each other. Private to the
 * module.
 *
 * A program for parts is a sequence of ForEach() and Deliver(). In a step, ForEach(), each part is
 * worked on by itself, with what others have sent it, and says what to send to which part. That
 * waits in memory until all ranks call Deliver(), and then lies in the boxes. A step itself must
 * not communicate. Parts have numbers, and the program knows nothing else of where they are:
 *   - one for each rank, in memory;
 *   - many for one process, in files, one of them in memory at a time;
 *   - many for each of several ranks, in files.
 * A rank holds parts with successive numbers, maybe none.
 *
 *     rank 0                    rank 1
 *     part 0   part 1           part 2   part 3   part 4
 *     ForEach: step(0), step(1) | step(2), step(3), step(4)      no rank waits
 *         |  Send()                 |  Send()
 *         v                         v
 *     ======================= Deliver(): all ranks meet ===================
 *     box of 0   box of 1       box of 2   box of 3   box of 4
 *
 * So a pass of a program looks like this:
 *
 *     engine.ForEach(progress, [&](int part, const Progress&) {
 *       engine.Send(OtherPart(part), Box, Pack(part));
 *     });
 *     engine.Deliver();
 *     engine.ForEach(progress, [&](int part, const Progress&) {
 *       Use(part, engine.At(part, Box).Take());
 *     });
 *
 * What is sent to a part lies in one of its boxes until it is taken. Boxes are numbered, as the
 * program wants; those that have a name are files where parts are in files, the others are small
 * and always in memory. In a box, what ranks have sent is in their order, and what one rank has
 * sent is in the order of sending. So the same is found there whoever holds the parts, but for its
 * order: a program whose result depends on that sorts it.
 *
 * An error or an abort in a step on any rank ends it on all of them, as Ranks::Agree() says. Files
 * go with their box.
 *
 * Cost: what parts of the same rank send each other is moved, not copied, or appended to a file.
 * For other ranks there is one message for each thing that is sent, and a list of them. What a step
 * sends is in memory at once, also of parts in files; ForEachInTurn() limits that.
 *
 * It is the model of DIY [Morozov & Peterka 2016]; Design.md says why it is not DIY.
 *
 * [Morozov & Peterka 2016] Block-parallel data analysis with DIY2.
 */
#ifndef Engine_h
#define Engine_h

#include "Bytes.h"
#include "Ranks.h"
#include "SpoolFile.h"

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace elevation
{

/** What has been sent to a part, stretch by stretch, in memory or in a file. */
class Inbox
{
public:
  Inbox() = default; ///< in memory
  /** In a file of this name. */
  explicit Inbox(const std::string& path);

  /** An empty stretch is nothing. @throws Error, as where the disk is full */
  void Append(Bytes&& stretch);
  /** The same for values whose memory stays the caller's; for files there is no copy. */
  void Append(const void* stretch, std::size_t size);

  bool IsEmpty() const;
  /** Visits the stretches in their order; from a file, one of them is in memory at a time. */
  void ForEach(const std::function<void(const Bytes&)>& visit) const;

  /**
   * All stretches; with Take() they leave the box. In memory Copy() copies them and Take() does
   * not. From a file both read all of them at once.
   */
  std::vector<Bytes> Copy(const Progress& progress = Progress()) const;
  std::vector<Bytes> Take();

  void Clear();

private:
  std::vector<Bytes> InMemory;
  std::unique_ptr<SpoolFile> File; // nullptr: in memory
};

/**
 * Who holds which part, and the post between parts. The constructor, ForEach(), ForEachInTurn() and
 * Deliver() are meetings of all ranks; Send() and At() are not. Several engines may stand over the
 * same ranks, each with parts and boxes of its own, as FillParts has one of parts and one of groups
 * of holes.
 */
class Engine
{
public:
  /**
   * All ranks make one together.
   * @param[in] ownParts  how many this rank holds
   * @param[in] boxes  the names of the boxes of a part; empty: always in memory
   * @param[in] folder  of the files; empty: all is in memory
   */
  Engine(const Ranks& ranks, int ownParts, const std::vector<std::string>& boxes,
    const std::string& folder);

  const Ranks& AllRanks() const { return this->Crew; }
  bool IsInFiles() const { return !this->FileFolder.empty(); }
  const std::string& Folder() const { return this->FileFolder; } ///< of the files; empty: in memory

  int PartCount() const { return this->Firsts.back(); }
  /** The rank that holds a part. */
  int RankOf(int part) const;
  /** Those of this rank are [FirstOwn(), EndOwn()). */
  int FirstOwn() const { return this->Firsts[this->Crew.OwnRank()]; }
  int EndOwn() const { return this->Firsts[this->Crew.OwnRank() + 1]; }
  bool IsOwn(int part) const { return part >= this->FirstOwn() && part < this->EndOwn(); }

  /**
   * A step on all ranks: for each part of this rank, one after another.
   * @throws Error, Aborted on all ranks when any of them fails, too little memory included; where
   * there is one rank in all, what the step throws
   */
  void ForEach(const Progress& progress,
    const std::function<void(int part, const Progress& ofPart)>& step) const;

  /**
   * The same in turns: after one part of each rank, what has been sent to the parts of another
   * engine is delivered, so that no more of it is in memory.
   */
  void ForEachInTurn(const Progress& progress, Engine& receiving,
    const std::function<void(int part, const Progress& ofPart)>& step) const;

  /** Sends to any part. It is there after Deliver(), which all ranks call. */
  void Send(int part, int box, Bytes&& stretch);
  void Deliver(const Progress& progress = Progress());

  /**
   * A box of a part of this rank. Boxes are numbered as their names are in the constructor; a part
   * of another rank has none here.
   */
  Inbox& At(int part, int box);

private:
  /** Of what is sent. */
  struct Label
  {
    std::size_t Part, Box, Size;
  };

  const Ranks& Crew;
  const std::string FileFolder;
  const std::size_t PartBoxes;
  std::vector<int> Firsts;                // part of each rank, and the end
  std::vector<Inbox> Boxes;               // of the parts of this rank
  std::vector<std::vector<Bytes>> Outbox; // of each rank
  std::vector<std::vector<Label>> Labels;
};

/**
 * All values in a box, to which they have been sent as lists of them (SendTo()). Plain values
 * alone: a stretch is as many of them as fit into its bytes.
 */
template <typename Value>
std::vector<Value> ValuesIn(const Inbox& box)
{
  std::vector<Value> values;
  box.ForEach([&values](const Bytes& bytes) { TakeAll(bytes, values); });
  return values;
}

/** Values for parts, in the order of their numbers. */
template <typename Value>
using ValuesForParts = std::map<int, std::vector<Value>>;

template <typename Value>
void SendTo(Engine& engine, int box, const ValuesForParts<Value>& values)
{
  for (const auto& ofPart : values)
  {
    Bytes bytes;
    AppendTo(bytes, ofPart.second);
    engine.Send(ofPart.first, box, std::move(bytes));
  }
}

} // namespace elevation

#endif
