// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * What is sent goes three ways. A message to a part of this rank is moved from the outbox into the
 * box. One to another rank is sent as it is. Where the box is a file, it is then appended to that
 * and leaves memory. All three pass through Deliver(), which therefore alone decides the order.
 *
 * Who holds which part is one list of first parts, made once:
 *
 *     ranks 0 to 3 with 3, 0, 2 and 1 parts:  Firsts = { 0, 3, 3, 5, 6 }
 *
 * so that a rank's parts, the rank of a part and the number of all follow without a message.
 */
#include "Engine.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace elevation
{

Inbox::Inbox(const std::string& path)
  : File(std::make_unique<SpoolFile>(path))
{
}

// A file holds stretches with their sizes, and an empty one would look like its end.
void Inbox::Append(Bytes&& stretch)
{
  if (stretch.empty())
  {
    return;
  }
  if (this->File)
  {
    this->File->Append(stretch.data(), stretch.size());
    stretch = Bytes();
    return;
  }
  this->InMemory.push_back(std::move(stretch));
}

void Inbox::Append(const void* stretch, std::size_t size)
{
  if (this->File && size > 0)
  {
    this->File->Append(stretch, size);
    return;
  }
  Bytes copy;
  AppendTo(copy, static_cast<const char*>(stretch), size);
  this->Append(std::move(copy));
}

void Inbox::ForEach(const std::function<void(const Bytes&)>& visit) const
{
  if (this->File)
  {
    this->File->ForEach([&visit](Bytes&& stretch) { visit(stretch); });
    return;
  }
  std::for_each(this->InMemory.begin(), this->InMemory.end(), visit);
}

bool Inbox::IsEmpty() const
{
  return this->File ? this->File->IsEmpty() : this->InMemory.empty();
}

std::vector<Bytes> Inbox::Copy(const Progress& progress) const
{
  std::vector<Bytes> copies;
  if (this->File)
  {
    this->File->ForEach([&](Bytes&& stretch) {
      // How far this is nobody knows; but an abort is heard.
      Report(progress, 0.0);
      copies.push_back(std::move(stretch));
    });
    return copies;
  }
  for (const Bytes& stretch : this->InMemory)
  {
    copies.emplace_back();
    AppendTo(copies.back(), stretch.data(), stretch.size());
  }
  return copies;
}

// A file is removed when it has been read.
std::vector<Bytes> Inbox::Take()
{
  std::vector<Bytes> taken = this->File ? this->Copy() : std::move(this->InMemory);
  this->Clear();
  return taken;
}

void Inbox::Clear()
{
  this->InMemory.clear();
  if (this->File)
  {
    this->File->Remove();
  }
}

/*
 * Each part of this rank gets its boxes, one after another; files are named after box and part, so
 * that ranks may share a folder. No file is made before something is written.
 */
Engine::Engine(const Ranks& ranks, int ownParts, const std::vector<std::string>& boxes,
  const std::string& folder)
  : Crew(ranks)
  , FileFolder(folder)
  , PartBoxes(boxes.size())
  , Firsts{ 0 }
  , Outbox(ranks.Count())
  , Labels(ranks.Count())
{
  for (const vtkIdType count : ranks.Collect(std::vector<vtkIdType>{ ownParts }))
  {
    this->Firsts.push_back(this->Firsts.back() + static_cast<int>(count));
  }
  for (int part = this->FirstOwn(); part < this->EndOwn(); ++part)
  {
    for (const std::string& name : boxes)
    {
      this->Boxes.push_back(this->IsInFiles() && !name.empty()
          ? Inbox(folder + "/" + name + "-" + std::to_string(part))
          : Inbox());
    }
  }
}

/*
 * Firsts has the first part of each rank and does not fall; a rank without parts has that of the
 * next one. So of those that begin with the part, the last one has it.
 */
int Engine::RankOf(int part) const
{
  const auto next = std::upper_bound(this->Firsts.begin(), this->Firsts.end(), part);
  return static_cast<int>(next - this->Firsts.begin()) - 1;
}

/*
 * Parts share the progress evenly: cuts give all of them about as many points. An error ends the
 * loop, on other ranks where a step next reports progress.
 */
void Engine::ForEach(
  const Progress& progress, const std::function<void(int, const Progress&)>& step) const
{
  this->Crew.Agree([&]() {
    const Progress watched = this->Crew.Watched(progress);
    const int first = this->FirstOwn();
    // A rank without parts takes part in Agree(), and divides by 1.
    const double width = 1.0 / std::max(1, this->EndOwn() - first);
    for (int part = first; part < this->EndOwn(); ++part)
    {
      step(part, watched.Between(width * (part - first), width * (part + 1 - first)));
    }
  });
}

// As many turns as the rank with most parts needs; others have none left in the last ones.
void Engine::ForEachInTurn(const Progress& progress, Engine& receiving,
  const std::function<void(int, const Progress&)>& step) const
{
  int turns = 0;
  for (std::size_t rank = 0; rank + 1 < this->Firsts.size(); ++rank)
  {
    turns = std::max(turns, this->Firsts[rank + 1] - this->Firsts[rank]);
  }
  for (int turn = 0; turn < turns; ++turn)
  {
    const double begin = turn, end = turn + 1;
    const Progress ofTurn = progress.Between(begin / turns, end / turns);
    // Not an own one where this rank has fewer parts than there are turns.
    const int part = this->FirstOwn() + turn;
    this->Crew.Agree([&]() {
      if (this->IsOwn(part))
      {
        step(part, this->Crew.Watched(ofTurn));
      }
    });
    receiving.Deliver(ofTurn.Between(1.0, 1.0));
  }
}

// Nothing is sent before Deliver(): a step that fails has sent nothing.
void Engine::Send(int part, int box, Bytes&& stretch)
{
  if (stretch.empty())
  {
    return;
  }
  const int rank = this->RankOf(part);
  this->Labels[rank].push_back(
    { static_cast<std::size_t>(part), static_cast<std::size_t>(box), stretch.size() });
  this->Outbox[rank].push_back(std::move(stretch));
}

/*
 * What goes to a rank is a list: first the labels, part, box and size of each message, then the
 * messages. Own ones go the same way, so that ranks come in their order; ExchangeLists() moves
 * them.
 */
void Engine::Deliver(const Progress& progress)
{
  std::vector<std::vector<Bytes>> toEach(this->Outbox.size());
  this->Crew.Agree([&]() {
    for (std::size_t rank = 0; rank < toEach.size(); ++rank)
    {
      // An empty list: no labels and no bytes, so a rank that sends nothing costs a length of 0.
      if (this->Labels[rank].empty())
      {
        continue;
      }
      toEach[rank].emplace_back();
      AppendTo(toEach[rank].front(), this->Labels[rank]);
      std::move(
        this->Outbox[rank].begin(), this->Outbox[rank].end(), std::back_inserter(toEach[rank]));
      this->Outbox[rank].clear();
      this->Labels[rank].clear();
    }
  });
  std::vector<std::vector<Bytes>> fromEach = this->Crew.ExchangeLists(std::move(toEach));
  // Writing to files takes long enough to hear of a failure elsewhere.
  this->Crew.Agree([&]() {
    const Progress watched = this->Crew.Watched(progress);
    for (std::vector<Bytes>& list : fromEach)
    {
      // Element 0 of a list has the labels, element i + 1 message i.
      std::vector<Label> labels;
      if (!list.empty())
      {
        TakeAll(list.front(), labels);
      }
      for (std::size_t i = 0; i < labels.size(); ++i)
      {
        Report(watched, 1.0);
        this->At(static_cast<int>(labels[i].Part), static_cast<int>(labels[i].Box))
          .Append(std::move(list[i + 1]));
      }
    }
  });
}

// Boxes lie part after part, and within a part in the order of their names.
Inbox& Engine::At(int part, int box)
{
  return this->Boxes[static_cast<std::size_t>(part - this->FirstOwn()) * this->PartBoxes + box];
}

} // namespace elevation
