// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Parts of a surface on ranks, in memory and in files: whoever holds them, their triangles are
// those of all points at once, also trimmed and where holes are filled, and a failure on one rank
// is that of all. All ranks run this program: PartsOnRanks FOLDER [--ranks].
#include "PartsOnRanks.h"
#include "Check.h"

#include "Adapt/Adapt.h"
#include "Parts/PackedData.h"
#include "Parts/Parts.h"
#include "vtkGridDelaunay2D.h"

#include "vtkCommand.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"

#if VTK_MODULE_ENABLE_VTK_ParallelMPI
#include "vtkMPIController.h"
#endif

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace parts_on_ranks
{

namespace
{
struct Observer : public vtkCommand
{
  static Observer* New() { return new Observer; }
  void Execute(vtkObject*, unsigned long, void*) override { this->Call(); }
  std::function<void()> Call;
};

/** What is sent lies in the order of ranks, and then of sending; also what a rank sends itself. */
void CheckOrder(const Ranks& ranks)
{
  for (const std::string& folder : { std::string(), FolderOf(ranks, 2) })
  {
    Engine engine(ranks, ranks.OwnRank() % 2 == 0 ? 2 : 0, { "some" }, folder);
    engine.ForEach(Progress(), [&](int part, const Progress&) {
      for (int to = 0; to < engine.PartCount(); ++to)
      {
        SendTo(engine, 0, std::map<int, std::vector<int>>{ { to, { part, to } } });
      }
    });
    engine.Deliver();
    std::vector<int> expected;
    for (int part = 0; part < engine.PartCount(); ++part)
    {
      expected.insert(expected.end(), { part, -1 });
    }
    engine.ForEach(Progress(), [&](int part, const Progress&) {
      for (std::size_t i = 1; i < expected.size(); i += 2)
      {
        expected[i] = part;
      }
      Check(ValuesIn<int>(engine.At(part, 0)) == expected, "messages are in order");
      Check(engine.RankOf(part) == ranks.OwnRank(), "ranks know their parts");
    });
  }
}

void CheckArraysWithoutValues()
{
  const vtkSmartPointer<vtkPolyData> local = PointsOf(Cloud(false), 0, 10);
  vtkNew<vtkIdTypeArray> none, some;
  none->SetName("None");
  some->SetName("Some");
  some->InsertNextValue(vtkIdType(7) << 40);
  local->GetFieldData()->AddArray(none);
  local->GetFieldData()->AddArray(some);
  const Bytes bytes = PackData(local);
  const vtkSmartPointer<vtkPolyData> arrived = UnpackData(bytes.data(), bytes.size());
  vtkFieldData* const data = arrived->GetFieldData();
  auto* const noneToo = vtkIdTypeArray::SafeDownCast(data->GetArray("None"));
  auto* const someToo = vtkIdTypeArray::SafeDownCast(data->GetArray("Some"));
  Check(noneToo && noneToo->GetNumberOfTuples() == 0, "an array without values arrives");
  Check(someToo && someToo->GetNumberOfTuples() == 1 && someToo->GetValue(0) == some->GetValue(0),
    "and keeps no other from coming");
}

/** An array of field data is that of the first part that has it. */
void CheckJoinedFieldData()
{
  Parts parts;
  for (const vtkIdType part : { 0, 1 })
  {
    parts.push_back(PointsOf(Cloud(false), 10 * part, 10 * part + 10));
    for (const char* const name : { "Of both", part == 0 ? "Of the first" : "Of the second" })
    {
      vtkNew<vtkIdTypeArray> array;
      array->SetName(name);
      array->InsertNextValue(7 + part);
      parts.back()->GetFieldData()->AddArray(array);
    }
  }
  std::vector<Message> warnings;
  const vtkSmartPointer<vtkPolyData> joined = Join(parts, PartKind::Points, Progress(), warnings);
  vtkFieldData* const data = joined->GetFieldData();
  const auto valueOf = [data](const char* name) {
    vtkDataArray* const array = data->GetArray(name);
    return array ? array->GetComponent(0, 0) : 0.0;
  };
  Check(data->GetNumberOfArrays() == 3 && warnings.empty(), "there are three arrays");
  Check(
    valueOf("Of both") == 7.0 && valueOf("Of the first") == 7.0 && valueOf("Of the second") == 8.0,
    "each is that of the first part that has it");
}

/** Word from rank to rank, so that each comes when the one before waits for it. */
class Chain
{
public:
  explicit Chain(const Ranks& ranks)
    : AllRanks(ranks)
    , IsLast(ranks.OwnRank() + 1 == ranks.Count())
  {
  }
  void Await() const
  {
    int word = 0;
    if (this->AllRanks.OwnRank() > 0)
    {
      this->AllRanks.Receive(&word, sizeof(word), this->AllRanks.OwnRank() - 1);
    }
  }
  void CallNext() const
  {
    const int word = 1;
    if (!this->IsLast)
    {
      this->AllRanks.Send(&word, sizeof(word), this->AllRanks.OwnRank() + 1);
    }
  }

private:
  const Ranks& AllRanks;
  const bool IsLast;
};

/** "1, 2": the ranks after this one. */
std::string RanksAfter(const Ranks& ranks)
{
  std::string names;
  for (int rank = ranks.OwnRank() + 1; rank < ranks.Count(); ++rank)
  {
    names += (names.empty() ? "" : ", ") + std::to_string(rank);
  }
  return names;
}

// No rank comes before the ones below have reported that they wait for it, however long that takes.
void CheckWaiting(const Ranks& ranks, vtkInformationVector* outputs)
{
  const Chain chain(ranks);
  const auto minute = std::exchange(Ranks::Patience, std::chrono::milliseconds(20));
  std::vector<Message> messages;
  const Ranks waiting(vtkMultiProcessController::GetGlobalController(), nullptr, outputs,
    [&](const Message& message) {
      messages.push_back(message);
      chain.CallNext();
    });
  const bool isLast = ranks.OwnRank() + 1 == ranks.Count();
  for (int wait = 1; wait <= 2; ++wait)
  {
    chain.Await();
    std::vector<vtkIdType> sum = { 1 };
    waiting.Sum(sum);
    Check(messages.size() == (isLast ? 0u : wait), "a rank reports once for each time it waits");
  }
  for (const Message& message : messages)
  {
    const std::vector<Message::Value>& values = message.GetValues();
    Check(message.GetCode() == "RankWaits" && values.size() == 3 &&
        values[0] == Message::Value("rank", std::to_string(ranks.OwnRank())) &&
        values[2] == Message::Value("others", RanksAfter(ranks)),
      "the message names who waits for whom");
  }

  // A filter reports it as all its warnings, while it waits.
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(PointsOf(Cloud(false), 0, 100));
  bool isReported = false;
  const auto report = [&]() {
    vtkStringArray* const rows = delaunay->GetMessages();
    if (!isReported)
    {
      isReported = true;
      Check(rows->GetNumberOfTuples() >= 4 && rows->GetValue(1) == "RankWaits",
        "the filter's messages have it");
      chain.CallNext();
    }
  };
  vtkNew<Observer> observer;
  observer->Call = report;
  delaunay->AddObserver(vtkCommand::WarningEvent, observer);
  chain.Await();
  delaunay->UpdatePiece(ranks.OwnRank(), ranks.Count(), 0);
  Check(isReported || isLast, "a filter that waits reports it");
  Ranks::Patience = minute;
}
} // namespace

int Run(int argc, char** argv)
{
  if (argc < 2)
  {
    return 1;
  }
  Temporary = argv[1];
  int count = 1;
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
  vtkNew<vtkMPIController> controller;
  if (argc > 2 && std::string(argv[2]) == "--ranks")
  {
    controller->Initialize(&argc, &argv);
    count = controller->GetNumberOfProcesses();
    vtkMultiProcessController::SetGlobalController(controller);
  }
#endif
  {
    vtkNew<vtkInformationVector> outputs;
    vtkNew<vtkInformation> output;
    output->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES(), count);
    outputs->Append(output);
    const Ranks ranks(
      vtkMultiProcessController::GetGlobalController(), nullptr, outputs, [](const Message&) {});
    CheckOrder(ranks);
    CheckTriangles(ranks);
    CheckGivenLattice(ranks);
    CheckFilling(ranks);
    CheckRefusal(ranks);
    CheckFailures(ranks);
    CheckTrimming(ranks);
    CheckFailuresOfTrimming(ranks);
    CheckOutlineOfPart();
    CheckArraysWithoutValues();
    CheckJoinedFieldData();
    CheckCuts(ranks);
    CheckWaiting(ranks, outputs);
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
  if (count > 1)
  {
    controller->Finalize();
  }
#endif
  return failures == 0 ? 0 : 1;
}

} // namespace parts_on_ranks

int main(int argc, char** argv)
{
  return parts_on_ranks::Run(argc, argv);
}
