# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The data sets of a composite input, named as the three filters name them, and their places in
composite outputs."""

import dataclasses
from typing import Any

from vtkmodules.vtkCommonDataModel import (
    vtkCompositeDataSet,
    vtkDataObjectTree,
    vtkDataSet,
    vtkMultiBlockDataSet,
    vtkPartitionedDataSet,
    vtkTable,
)


@dataclasses.dataclass(frozen=True)
class Part:
    """A data set of the input.

    place    numbers of the children that lead to it, from 0; () where the input is no composite
    name     for messages: 'Block 2 ("north")'; "" where the input is no composite
    surface  the place of its surface: that of the block where it is one of several partitions
    block    the name of that
    """

    data: Any = dataclasses.field(compare=False)  # newer VTKs compare what data sets hold
    place: tuple = ()
    name: str = ""
    surface: tuple = ()
    block: str = ""


def parts_of(data):
    """The Parts of a data object."""
    return list(_parts_in(data, (), "")) if isinstance(data, vtkDataObjectTree) else [Part(data)]


def _parts_in(tree, place, name):
    are_partitions = isinstance(tree, vtkPartitionedDataSet)
    count = _number_of_children(tree)
    for i in range(count):
        child = _child(tree, i)
        if child is None:
            continue
        of_child = (*place, i)
        given = tree.GetMetaData(i).Get(vtkCompositeDataSet.NAME()) if tree.HasMetaData(i) else ""
        given = f' ("{given}")' if given else ""
        words = f"Block {'.'.join(str(number) for number in of_child)}{given}"
        if are_partitions:
            which = f"artition {i}{given}"
            words = f"P{which}" if not name else name if count == 1 else f"{name}, p{which}"
        if isinstance(child, vtkDataObjectTree):
            yield from _parts_in(child, of_child, words)
        elif are_partitions:
            yield Part(child, of_child, words, place, name)
        else:
            yield Part(child, of_child, words, of_child, words)


# The kinds of trees have these under different names.
def _number_of_children(tree):
    if isinstance(tree, vtkMultiBlockDataSet):
        return tree.GetNumberOfBlocks()
    if isinstance(tree, vtkPartitionedDataSet):
        return tree.GetNumberOfPartitions()
    return tree.GetNumberOfPartitionedDataSets()


def _child(tree, i):
    if isinstance(tree, vtkMultiBlockDataSet):
        return tree.GetBlock(i)
    if isinstance(tree, vtkPartitionedDataSet):
        return tree.GetPartitionAsDataObject(i)
    return tree.GetPartitionedDataSet(i)


def put_parts(output, data, parts, made):
    """Gives output the structure of data, with the vtkPolyData made[i] for parts[i]."""
    if not isinstance(data, vtkDataObjectTree):
        output.ShallowCopy(made[0])
        return
    output.CopyStructure(data)
    output.GetFieldData().PassData(data.GetFieldData())
    for part, surface in zip(parts, made):
        tree = output
        for i in part.place[:-1]:
            tree = _child(tree, i)
        if isinstance(tree, vtkMultiBlockDataSet):
            tree.SetBlock(part.place[-1], surface)
        else:
            tree.SetPartition(part.place[-1], surface)


def number_of_points(data):
    """How many points or rows a data set has."""
    if isinstance(data, vtkTable):
        return data.GetNumberOfRows()
    return data.GetNumberOfPoints() if isinstance(data, vtkDataSet) else 0


def is_empty(data):
    """Whether it could have points, but has none."""
    return isinstance(data, (vtkDataSet, vtkTable)) and number_of_points(data) == 0
