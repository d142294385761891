// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The blocks of a composite input and the outputs that belong to each. Private to the module.
 *
 *     input                                         Path   Name in messages
 *     [0] "north"  vtkPartitionedDataSet  [0]       0      Block 0 ("north"), partition 0
 *                                         [1]       0      Block 0 ("north"), partition 1
 *     [1] vtkPartitionedDataSet, one partition      1      Block 1
 *     [2] vtkMultiBlockDataSet            [0]       2.0    Block 2.0
 *
 * Numbers are positions in the tree, empty ones included: so a block has the same path on all ranks.
 */
#ifndef Blocks_h
#define Blocks_h

#include "Kernel/Messages/Messages.h"
#include "VTKClasses.h"

#include "vtkDataObject.h"
#include "vtkSmartPointer.h"

#include <string>
#include <vector>

namespace elevation
{

/** A data set of the input, and the output of each port that belongs to it. */
struct Leaf
{
  vtkDataObject* Input;
  std::vector<vtkPolyData*> Outputs;
  std::string Name; ///< for messages: 'Block 2 ("north")'; empty where the input is not a composite
  /**
   * Of the block; the partitions of a vtkPartitionedDataSet have the same. On one rank each of them
   * is a surface of its own; on several, they are the parts of one.
   */
  std::string Path;
  std::string BlockName; ///< without the partition; empty for the whole input
  vtkSmartPointer<vtkDataObject> Made = nullptr; ///< what Input points to, if it was made here
  bool IsDone = false;                          ///< has its outputs
  Message Warning = Message();                  ///< on how its input has come here, if any
};

/** For FillInputPortInformation: a type, or a composite. Input 1 is an optional vtkPolyData. */
int FillInput(int port, const char* typeOfInput0, vtkInformation* info);

/** For FillOutputPortInformation: what MakeOutputs() makes. */
int FillOutput(vtkInformation* info);

/**
 * For REQUEST_DATA_OBJECT: makes each output a composite of the class of the input, if that is one,
 * else a vtkPolyData.
 */
int MakeOutputs(vtkInformationVector** inputs, vtkInformationVector* outputs);

/**
 * Gives composite outputs the structure of the input, its names and field data, with an empty
 * vtkPolyData for each data set, and lists these. Empty leaves of the tree stay empty.
 */
std::vector<Leaf> ListLeaves(vtkDataObject* input, vtkInformationVector* outputs);

/**
 * A second input: itself, or the data sets of a composite in one.
 * @param[in] name  what messages call it: "boundary"
 * @return nullptr if there is none
 * @throws Error when a data set is not a vtkPolyData
 */
vtkSmartPointer<vtkPolyData> JoinBlocks(vtkDataObject* input, const std::string& name);

} // namespace elevation

#endif
