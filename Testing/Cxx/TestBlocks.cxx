// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Composite inputs: each block is a surface of its own, the outputs have the structure of the
// input, counts are sums, messages name the block, and progress only rises.
#include "Check.h"
#include "Inputs.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCompositeDataSet.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkFillElevationHoles.h"
#include "vtkGridDelaunay2D.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkOutputWindow.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkTestErrorObserver.h"
#include "vtkTrimOutwardTriangles.h"

#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

namespace
{
/** Scattered points in a square at x0, some of them twice; its field data contain x0. */
vtkSmartPointer<vtkPolyData> MakeCloud(double x0, int duplicates)
{
  auto cloud = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 20 * 20; ++i)
  {
    if (std::hypot(i % 20 - 8.0, i / 20 - 9.0) > 2.5)
    {
      points->InsertNextPoint(
        x0 + i % 20 + 0.3 * std::sin(i), i / 20 + 0.3 * std::cos(3.0 * i), 1.0);
    }
  }
  for (int i = 0; i < duplicates; ++i)
  {
    points->InsertNextPoint(points->GetPoint(i));
  }
  cloud->SetPoints(points);
  vtkNew<vtkIdTypeArray> place;
  place->SetName("Place");
  place->InsertNextValue(static_cast<vtkIdType>(x0));
  cloud->GetFieldData()->AddArray(place);
  return cloud;
}

vtkPolyData* BlockOf(vtkAlgorithm* filter, unsigned int i, int port = 0)
{
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(port));
  return blocks ? vtkPolyData::SafeDownCast(blocks->GetBlock(i)) : nullptr;
}

/** Two clouds, nothing in between, the second one with a name. */
vtkSmartPointer<vtkMultiBlockDataSet> MakeBlocks()
{
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  blocks->SetBlock(0, MakeCloud(0.0, 3));
  blocks->SetBlock(1, nullptr);
  blocks->SetBlock(2, MakeCloud(100.0, 2));
  blocks->GetMetaData(2u)->Set(vtkCompositeDataSet::NAME(), "north");
  vtkNew<vtkIdTypeArray> survey;
  survey->SetName("Survey");
  survey->InsertNextValue(7);
  blocks->GetFieldData()->AddArray(survey);
  return blocks;
}

void TestChainOfBlocks()
{
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputDataObject(MakeBlocks());
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputConnection(delaunay->GetOutputPort());
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputConnection(trim->GetOutputPort());
  fill->Update();
  auto* surface = vtkMultiBlockDataSet::SafeDownCast(fill->GetOutputDataObject(0));
  Check(surface && surface->GetNumberOfBlocks() == 3 && !surface->GetBlock(1),
    "the output has the structure of the input");
  Check(surface && surface->HasMetaData(2u) &&
      std::string(surface->GetMetaData(2u)->Get(vtkCompositeDataSet::NAME())) == "north",
    "and its names");
  Check(surface && surface->GetFieldData()->GetArray("Survey"), "and its field data");
  Check(delaunay->GetNumberOfDuplicatePoints() == 5, "counts are sums over the blocks");
  vtkIdType outward = 0, holes = 0;
  for (const unsigned int i : { 0u, 2u })
  {
    vtkNew<vtkGridDelaunay2D> alone;
    alone->SetInputData(MakeCloud(50.0 * i, 3 - static_cast<int>(i / 2)));
    vtkNew<vtkTrimOutwardTriangles> trimAlone;
    trimAlone->SetInputConnection(alone->GetOutputPort());
    vtkNew<vtkFillElevationHoles> fillAlone;
    fillAlone->SetInputConnection(trimAlone->GetOutputPort());
    fillAlone->Update();
    outward += trimAlone->GetNumberOfOutwardTriangles();
    holes += fillAlone->GetNumberOfHoles();
    vtkPolyData* block = BlockOf(fill, i);
    Check(block && block->GetNumberOfPolys() == fillAlone->GetOutput()->GetNumberOfPolys() &&
        block->GetNumberOfPoints() == fillAlone->GetOutput()->GetNumberOfPoints(),
      "each block is the surface that it is alone");
    Check(block && block->GetFieldData()->GetArray("Place")->GetTuple1(0) == 50.0 * i,
      "with the field data of its own");
    Check(BlockOf(delaunay, i)->GetFieldData()->GetArray("NumberOfDuplicatePoints")->GetTuple1(0) ==
        alone->GetNumberOfDuplicatePoints(),
      "and counts of its own");
    Check(BlockOf(trim, i, 2) && BlockOf(trim, i, 2)->GetNumberOfLines() > 0,
      "all outputs are composite");
  }
  Check(trim->GetNumberOfOutwardTriangles() == outward && fill->GetNumberOfHoles() == holes &&
      holes == 2,
    "the other counts are sums, too");
  Check(trim->GetEffectiveGapTolerance() == 4.5, "a tolerance is no sum");
  // A plain input after a composite one gives plain output again.
  delaunay->SetInputDataObject(MakeCloud(0.0, 1));
  fill->Update();
  Check(fill->GetOutput() && fill->GetOutput()->GetNumberOfPolys() > 0 &&
      delaunay->GetNumberOfDuplicatePoints() == 1,
    "a plain input gives plain output");
}

void TestPartitions()
{
  vtkNew<vtkPartitionedDataSetCollection> collection;
  vtkNew<vtkPartitionedDataSet> pieces;
  pieces->SetPartition(0, MakeCloud(0.0, 1));
  pieces->SetPartition(1, MakeCloud(100.0, 1));
  collection->SetPartitionedDataSet(0, pieces);
  vtkDataObject* const inputs[] = { collection, pieces };
  for (vtkDataObject* input : inputs)
  {
    vtkNew<vtkGridDelaunay2D> delaunay;
    delaunay->SetInputDataObject(input);
    delaunay->Update();
    vtkDataObject* output = delaunay->GetOutputDataObject(0);
    Check(std::string(output->GetClassName()) == input->GetClassName(), "the class is the same");
    auto* parts = vtkPartitionedDataSet::SafeDownCast(output);
    if (auto* all = vtkPartitionedDataSetCollection::SafeDownCast(output))
    {
      parts = all->GetPartitionedDataSet(0);
    }
    Check(parts && parts->GetNumberOfPartitions() == 2 && parts->GetPartition(0) &&
        parts->GetPartition(1) && parts->GetPartition(1)->GetNumberOfCells() > 0 &&
        delaunay->GetNumberOfDuplicatePoints() == 2,
      "each partition is triangulated");
  }
}

void TestSecondInput()
{
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(MakeCloud(0.0, 0));
  vtkNew<vtkMultiBlockDataSet> rings;
  rings->SetBlock(0, RingAround(8.0, 9.0, 9, [](double) { return 7.0; }));
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputConnection(delaunay->GetOutputPort());
  trim->SetInputDataObject(1, rings);
  trim->Update();
  vtkNew<vtkTrimOutwardTriangles> plain;
  plain->SetInputConnection(delaunay->GetOutputPort());
  plain->SetBoundaryData(RingAround(8.0, 9.0, 9, [](double) { return 7.0; }));
  plain->Update();
  Check(trim->GetNumberOfOutwardTriangles() == plain->GetNumberOfOutwardTriangles() &&
      trim->GetOutput(2)->GetNumberOfLines() == 1 && trim->GetOutput()->GetNumberOfPolys() > 0,
    "a block is a boundary");
  rings->SetBlock(2, RingAround(8.0, 9.0, 9, [](double) { return 3.0; }));
  trim->Update();
  Check(trim->GetOutput(2)->GetNumberOfLines() == 2 &&
      trim->GetNumberOfOutwardTriangles() > plain->GetNumberOfOutwardTriangles(),
    "several blocks are one boundary");
  delaunay->SetInputDataObject(1, rings);
  delaunay->Update();
  Check(delaunay->GetNumberOfAddedPoints() == 18, "several blocks are constraints");
  delaunay->SetSourceData(nullptr);

  vtkNew<vtkTest::ErrorObserver> observer;
  trim->AddObserver(vtkCommand::ErrorEvent, observer);
  rings->SetBlock(3, vtkSmartPointer<vtkImageData>::New());
  trim->Update();
  Check(observer->GetErrorMessage().find("vtkImageData") != std::string::npos,
    "a block that is no vtkPolyData is an error; it was: " + observer->GetErrorMessage());
}

void TestMessages()
{
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputDataObject(MakeBlocks());
  delaunay->Update();
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->CopyStructure(vtkMultiBlockDataSet::SafeDownCast(delaunay->GetOutputDataObject(0)));
  blocks->SetBlock(0, BlockOf(delaunay, 0));
  blocks->SetBlock(1, MakeCloud(50.0, 0));
  blocks->SetBlock(2, RingAround(8.0, 9.0, 9, [](double) { return 3.0; })); // of nine points
  vtkNew<vtkTest::ErrorObserver> observer;
  vtkNew<vtkFillElevationHoles> fill;
  fill->AddObserver(vtkCommand::ErrorEvent, observer);
  fill->AddObserver(vtkCommand::WarningEvent, observer);
  fill->SetInputDataObject(blocks);
  fill->Update();
  const std::string error = observer->GetErrorMessage();
  Check(error.find("Block 2 (\"north\"): Cell 0") != std::string::npos &&
      error.find("ERROR:") == error.rfind("ERROR:"),
    "one error names the block; it was: " + error);
  const std::string warning = observer->GetWarningMessage();
  Check(warning.find("Block 1: The input has no triangles") != std::string::npos,
    "and so does the warning; it was: " + warning);
  // For programs, a row of two components for the code, the block and each value.
  vtkStringArray* const rows = fill->GetMessages();
  std::vector<std::string> data;
  for (vtkIdType i = 0; i < rows->GetNumberOfTuples(); ++i)
  {
    if (rows->GetValue(2 * i) != "text")
    {
      data.push_back(rows->GetValue(2 * i) + "=" + rows->GetValue(2 * i + 1));
    }
  }
  Check(data.size() == 5 && data[0] == "error=Words" && data[1] == "block=Block 2 (\"north\")" &&
      data[3] == "warning=NothingToFill" && data[4] == "block=Block 1",
    "a message is data too");
  Check(BlockOf(fill, 0)->GetNumberOfPolys() > 0 && BlockOf(fill, 2)->GetNumberOfPoints() == 0,
    "a block with an error is empty, the others are filled");
}

/** The messages of the three filters in a row. */
std::vector<std::string> MessagesOfChain(vtkDataObject* input, double maximumEdgeLength = 0.0)
{
  std::vector<std::string> messages;
  vtkNew<vtkCallbackCommand> note;
  note->SetClientData(&messages);
  note->SetCallback([](vtkObject*, unsigned long, void* data, void* text) {
    static_cast<std::vector<std::string>*>(data)->emplace_back(static_cast<char*>(text));
  });
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputDataObject(input);
  delaunay->SetMaximumEdgeLength(maximumEdgeLength);
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputConnection(delaunay->GetOutputPort());
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputConnection(trim->GetOutputPort());
  for (vtkAlgorithm* filter : std::initializer_list<vtkAlgorithm*>{ delaunay, trim, fill })
  {
    filter->AddObserver(vtkCommand::ErrorEvent, note);
    filter->AddObserver(vtkCommand::WarningEvent, note);
  }
  fill->Update();
  return messages;
}

void TestChainReportsOnce()
{
  vtkNew<vtkPolyData> two;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0.0, 0.0, 0.0);
  points->InsertNextPoint(1.0, 0.0, 0.0);
  two->SetPoints(points);
  const auto wrong = MakeCloud(0.0, 0);
  vtkNew<vtkIdTypeArray> tooShort;
  tooShort->SetName("TooShort");
  tooShort->InsertNextValue(1);
  wrong->GetPointData()->AddArray(tooShort);
  const auto right = MakeCloud(0.0, 0);
  vtkNew<vtkPolyData> pointless;
  vtkNew<vtkMultiBlockDataSet> nothing, empty;
  nothing->SetNumberOfBlocks(2);
  empty->SetBlock(1, pointless);
  const auto check = [](const std::vector<std::string>& messages, const std::string& part) {
    Check(messages.size() == 1 && messages.front().find(part) != std::string::npos,
      "one message with '" + part + "'; they were " + std::to_string(messages.size()) + ": " +
        (messages.empty() ? "" : messages.front()));
  };
  check(MessagesOfChain(two), "the 2 input points");
  check(MessagesOfChain(wrong), "TooShort");
  check(MessagesOfChain(MakeCloud(0.0, 0), 0.01), "MaximumEdgeLength");
  for (vtkDataObject* input :
    std::initializer_list<vtkDataObject*>{ right, pointless, nothing, empty })
  {
    Check(MessagesOfChain(input).empty(), "a cloud, and an empty input, pass in silence");
  }
}

void TestArraysFakeNoReport()
{
  const auto cloud = MakeCloud(0.0, 0);
  vtkNew<vtkIdTypeArray> fake;
  fake->SetName("UnusedPointIds");
  cloud->GetFieldData()->AddArray(fake);
  vtkNew<vtkTest::ErrorObserver> observer;
  vtkNew<vtkTrimOutwardTriangles> trim;
  vtkNew<vtkFillElevationHoles> fill;
  trim->SetInputData(cloud);
  fill->SetInputData(cloud);
  for (vtkAlgorithm* filter : std::initializer_list<vtkAlgorithm*>{ trim, fill })
  {
    filter->AddObserver(vtkCommand::WarningEvent, observer);
    filter->Update();
    Check(observer->GetWarningMessage().find("The input has no triangles") != std::string::npos,
      "an array of the user's hides no warning");
    observer->Clear();
  }
}

void TestErrorsFailTheRequest()
{
  const auto good = MakeCloud(0.0, 0);
  const auto wrong = MakeCloud(0.0, 0);
  vtkNew<vtkIdTypeArray> tooShort;
  tooShort->SetName("TooShort");
  tooShort->InsertNextValue(1);
  wrong->GetPointData()->AddArray(tooShort);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, good);
  blocks->SetBlock(1, wrong);
  vtkNew<vtkGridDelaunay2D> triangulated;
  triangulated->SetInputData(good);
  triangulated->Update();
  vtkNew<vtkMultiBlockDataSet> meshes;
  meshes->SetBlock(0, triangulated->GetOutput());
  meshes->SetBlock(1, RingAround(8.0, 9.0, 9, [](double) { return 3.0; }));
  vtkNew<vtkGridDelaunay2D> delaunay;
  vtkNew<vtkTrimOutwardTriangles> trim;
  vtkNew<vtkFillElevationHoles> fill;
  const struct
  {
    vtkAlgorithm* Filter;
    vtkDataObject *Good, *Wrong, *Mixed;
  } cases[] = { { delaunay, good, wrong, blocks },
    { trim, triangulated->GetOutput(), meshes->GetBlock(1), meshes },
    { fill, triangulated->GetOutput(), meshes->GetBlock(1), meshes } };
  vtkNew<vtkTest::ErrorObserver> ofFilter, ofWindow;
  vtkOutputWindow::GetInstance()->AddObserver(vtkCommand::ErrorEvent, ofWindow);
  for (const auto& tried : cases)
  {
    tried.Filter->AddObserver(vtkCommand::ErrorEvent, ofFilter);
    const auto update = [&](vtkDataObject* input) {
      tried.Filter->SetInputDataObject(input);
      return tried.Filter->GetExecutive()->Update() != 0;
    };
    const std::string name = tried.Filter->GetClassName();
    for (vtkDataObject* input : { tried.Wrong, tried.Mixed })
    {
      ofFilter->Clear();
      Check(!update(input) && tried.Filter->GetErrorCode() != vtkErrorCode::NoError &&
          ofFilter->GetError() && !ofWindow->GetError(),
        name + ": an error fails the request, and is reported once");
      Check(update(tried.Good) && tried.Filter->GetErrorCode() == vtkErrorCode::NoError,
        name + ": a good update takes the error away");
    }
  }
}

void TestProgressAndAbort()
{
  struct State
  {
    double Last = 0.0, AbortAt = 2.0;
    bool Falls = false;
  } state;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&state);
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    auto* seen = static_cast<State*>(data);
    auto* filter = vtkAlgorithm::SafeDownCast(caller);
    const double now = filter->GetProgress();
    seen->Falls = seen->Falls || (now > 0.0 && now < seen->Last);
    seen->Last = filter->GetProgress();
    if (seen->Last >= seen->AbortAt)
    {
      filter->SetAbortExecute(1);
    }
  });
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->AddObserver(vtkCommand::ProgressEvent, command);
  delaunay->SetInputDataObject(MakeBlocks());
  delaunay->Update();
  Check(!state.Falls && state.Last == 1.0, "progress rises over all blocks");
  state.AbortAt = 0.7;
  state.Last = 0.0;
  delaunay->Modified();
  delaunay->Update();
  Check(delaunay->GetNumberOfDuplicatePoints() == 0 &&
      (!BlockOf(delaunay, 0) || BlockOf(delaunay, 0)->GetNumberOfPoints() == 0),
    "an abort in the second block leaves nothing of the first");
}
} // namespace

int TestBlocks(int, char*[])
{
  TestChainOfBlocks();
  TestPartitions();
  TestSecondInput();
  TestMessages();
  TestChainReportsOnce();
  TestArraysFakeNoReport();
  TestErrorsFailTheRequest();
  TestProgressAndAbort();
  return failures > 0;
}
