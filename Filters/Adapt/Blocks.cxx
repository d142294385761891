// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * AddLeaves() goes down the trees of the input and of all outputs at the same time, which have the
 * same structure. VTK's iterators go through one tree, and name no blocks.
 */
#include "Blocks.h"

#include "ArrayChecks.h"
#include "HiddenCells.h"
#include "Kernel/Base/Base.h"
#include "MeshConversion.h"

#include "vtkAlgorithm.h"
#include "vtkCompositeDataIterator.h"
#include "vtkDataObjectTree.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPolyData.h"

namespace elevation
{

int FillInput(int port, const char* typeOfInput0, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? typeOfInput0 : "vtkPolyData");
  // Else the executive would take a composite apart and call the filter for each data set, and
  // ranks with different numbers of them would not meet.
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObjectTree");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int FillOutput(vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject");
  return 1;
}

// The executive has asked for a vtkDataObject (FillOutput), so what it is gets decided here.
int MakeOutputs(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  auto* const tree = vtkDataObjectTree::GetData(inputs[0]);
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* const info = outputs->GetInformationObject(port);
    vtkDataObject* const old = vtkDataObject::GetData(info);
    const char* const wanted = tree ? tree->GetClassName() : "vtkPolyData";
    // An output of the right class stays, as consumers may hold it.
    if (!old || wanted != std::string(old->GetClassName()))
    {
      const auto made = tree ? vtkSmartPointer<vtkDataObject>::Take(tree->NewInstance())
                             : vtkSmartPointer<vtkDataObject>(vtkSmartPointer<vtkPolyData>::New());
      info->Set(vtkDataObject::DATA_OBJECT(), made);
    }
  }
  return 1;
}

namespace
{
/** What the kinds of trees have in common under different names. */
unsigned int NumberOfChildren(vtkDataObjectTree* tree)
{
  if (auto* const blocks = vtkMultiBlockDataSet::SafeDownCast(tree))
  {
    return blocks->GetNumberOfBlocks();
  }
  if (auto* const partitions = vtkPartitionedDataSet::SafeDownCast(tree))
  {
    return partitions->GetNumberOfPartitions();
  }
  auto* const collection = vtkPartitionedDataSetCollection::SafeDownCast(tree);
  // Another kind of tree has no children here: its output is empty.
  return collection ? collection->GetNumberOfPartitionedDataSets() : 0;
}

vtkDataObject* Child(vtkDataObjectTree* tree, unsigned int i)
{
  if (auto* const blocks = vtkMultiBlockDataSet::SafeDownCast(tree))
  {
    return blocks->GetBlock(i);
  }
  if (auto* const partitions = vtkPartitionedDataSet::SafeDownCast(tree))
  {
    return partitions->GetPartitionAsDataObject(i);
  }
  return vtkPartitionedDataSetCollection::SafeDownCast(tree)->GetPartitionedDataSet(i);
}

void SetChild(vtkDataObjectTree* tree, unsigned int i, vtkDataObject* child)
{
  if (auto* const blocks = vtkMultiBlockDataSet::SafeDownCast(tree))
  {
    blocks->SetBlock(i, child);
  }
  else if (auto* const partitions = vtkPartitionedDataSet::SafeDownCast(tree))
  {
    partitions->SetPartition(i, child);
  }
}

/** ' ("name")', or nothing. */
std::string ChildName(vtkDataObjectTree* tree, unsigned int i)
{
  const auto nameIn = [i](auto* parent) -> std::string {
    const char* const name = parent && parent->HasMetaData(i)
      ? parent->GetMetaData(i)->Get(vtkCompositeDataSet::NAME())
      : nullptr;
    return name && *name ? " (\"" + std::string(name) + "\")" : std::string();
  };
  return nameIn(vtkMultiBlockDataSet::SafeDownCast(tree)) +
    nameIn(vtkPartitionedDataSet::SafeDownCast(tree)) +
    nameIn(vtkPartitionedDataSetCollection::SafeDownCast(tree));
}

/**
 * Adds the leaves of a tree, depth first: the order of the input's leaves.
 * @param[in] name,path  those of the tree; empty for the whole input
 */
void AddLeaves(vtkDataObjectTree* input, const std::vector<vtkDataObjectTree*>& outputs,
  const std::string& name, const std::string& path, std::vector<Leaf>& leaves)
{
  const unsigned int count = NumberOfChildren(input);
  const bool arePartitions = vtkPartitionedDataSet::SafeDownCast(input) != nullptr;
  for (unsigned int i = 0; i < count; ++i)
  {
    vtkDataObject* const child = Child(input, i);
    if (!child)
    {
      continue;
    }
    const std::string childPath = (path.empty() ? "" : path + ".") + std::to_string(i);
    std::string childName = "Block " + childPath + ChildName(input, i);
    if (arePartitions)
    {
      // "Partition 1" where it begins the name, ", partition 1" after that of the block.
      const std::string which = "artition " + std::to_string(i) + ChildName(input, i);
      childName = name.empty() ? "P" + which : count == 1 ? name : name + ", p" + which;
    }
    if (auto* const tree = vtkDataObjectTree::SafeDownCast(child))
    {
      std::vector<vtkDataObjectTree*> ofChild;
      for (vtkDataObjectTree* output : outputs)
      {
        ofChild.push_back(vtkDataObjectTree::SafeDownCast(Child(output, i)));
      }
      AddLeaves(tree, ofChild, childName, childPath, leaves);
      continue;
    }
    // Partitions share the path of what they are partitions of.
    Leaf leaf{ child, {}, childName, arePartitions ? path : childPath,
      arePartitions ? name : childName };
    for (vtkDataObjectTree* output : outputs)
    {
      const auto data = vtkSmartPointer<vtkPolyData>::New();
      SetChild(output, i, data);
      leaf.Outputs.push_back(data);
    }
    leaves.push_back(leaf);
  }
}
} // namespace

std::vector<Leaf> ListLeaves(vtkDataObject* input, vtkInformationVector* outputs)
{
  auto* const tree = vtkDataObjectTree::SafeDownCast(input);
  if (!tree)
  {
    // Not a composite: one leaf without a name, since messages need none.
    Leaf whole{ input, {}, "", "", "" };
    for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
    {
      whole.Outputs.push_back(vtkPolyData::GetData(outputs, port));
    }
    return { whole };
  }
  std::vector<vtkDataObjectTree*> trees;
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    trees.push_back(vtkDataObjectTree::GetData(outputs, port));
    // The structure has the names, and no data sets: these come as leaves are found.
    trees.back()->CopyStructure(tree);
    trees.back()->GetFieldData()->PassData(tree->GetFieldData());
  }
  std::vector<Leaf> leaves;
  AddLeaves(tree, trees, "", "", leaves);
  return leaves;
}

/*
 * Boundary and constraints hold for all blocks of the first input, so their own blocks do not
 * matter.
 */
vtkSmartPointer<vtkPolyData> JoinBlocks(vtkDataObject* input, const std::string& name)
{
  auto* const tree = vtkDataObjectTree::SafeDownCast(input);
  if (!tree)
  {
    auto* const lines = vtkPolyData::SafeDownCast(input);
    return lines ? WithoutHiddenCells(lines) : nullptr;
  }
  std::vector<vtkSmartPointer<vtkPolyData>> parts;
  auto each = vtk::TakeSmartPointer(tree->NewIterator());
  for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem())
  {
    vtkDataObject* const part = each->GetCurrentDataObject();
    // The iterator skips what is empty.
    parts.emplace_back(vtkPolyData::SafeDownCast(part));
    if (!parts.back())
    {
      throw Error("A block of the " + name + " is a " + part->GetClassName() +
        "; lines and polygons are in a vtkPolyData.");
    }
    // Before they are appended, so that the message can name the cell.
    CheckArrays(parts.back(), "The " + Possessive(name));
    parts.back() = WithoutHiddenCells(parts.back());
  }
  return parts.empty() ? vtkSmartPointer<vtkPolyData>::New() : Append(parts);
}

} // namespace elevation
