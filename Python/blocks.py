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
    vtkPolyData,
    vtkTable,
)

from .ranks import together


@dataclasses.dataclass(frozen=True)
class Part:
    """A data set of the input.

    place    numbers of the children that lead to it, from 0; () where the input is not a composite
    name     for messages: 'Block 2 ("north")'; "" where the input is not a composite
    surface  the place of its surface: that of the block where it is one of several partitions
    block    the name of that
    """

    data: Any = dataclasses.field(compare=False)  # newer VTKs compare what data sets hold
    place: tuple = ()
    name: str = ""
    surface: tuple = ()
    block: str = ""


@dataclasses.dataclass
class Surface:
    """The input of one surface: a Part, or on ranks all partitions of a block.

    data   the data sets that this rank has of it
    part   the Part whose place its surface takes
    place, name  as those of a Part
    ranks  the controller of those that make it together, or None
    """

    data: list
    part: Part
    place: tuple
    name: str
    ranks: Any = None


def surfaces_of(controller, parts):
    """(parts, Surfaces): those of all ranks that make a surface together, in the order of their places,
    then those that are made on this rank alone. Parts may be new where a rank has none of a surface."""
    full = [part for part in parts if point_count(part.data) > 0]
    known = {}
    if controller:
        own = controller.GetLocalProcessId()
        rows = [[part.surface, part.place, part.block, own] for part in full]
        for surface, place, block, rank in together(controller, lambda: rows):
            known.setdefault(tuple(surface), []).append((tuple(place), block, rank))
    parts, surfaces = list(parts), []
    for place in sorted(known):
        first, block, _ = known[place][0]
        if len({rank for *_, rank in known[place]}) > 1:
            mine = [part for part in full if part.surface == place]
            here = mine + [part for part in parts if part.surface == place]
            if not here:
                here = [Part(vtkPolyData(), first, block, place, block)]
                parts += here
            surfaces.append(Surface([p.data for p in mine], here[0], place, block, controller))
    spread = {surface.place for surface in surfaces}
    alone = [part for part in parts if part.surface not in spread and not is_empty(part.data)]
    return parts, surfaces + [Surface([p.data], p, p.place, p.name) for p in alone]


def parts_of(data):
    """The Parts of a data object."""
    return list(_parts_in(data, (), "")) if isinstance(data, vtkDataObjectTree) else [Part(data)]


def _parts_in(tree, place, name):
    are_partitions = isinstance(tree, vtkPartitionedDataSet)
    count = _child_count(tree)
    for i in range(count):
        child = _child(tree, i)
        if child is None:
            continue
        child_place = (*place, i)
        given = tree.GetMetaData(i).Get(vtkCompositeDataSet.NAME()) if tree.HasMetaData(i) else ""
        given = f' ("{given}")' if given else ""
        words = f"Block {'.'.join(str(number) for number in child_place)}{given}"
        if are_partitions:
            which = f"artition {i}{given}"
            words = f"P{which}" if not name else name if count == 1 else f"{name}, p{which}"
        if isinstance(child, vtkDataObjectTree):
            yield from _parts_in(child, child_place, words)
        elif are_partitions:
            yield Part(child, child_place, words, place, name)
        else:
            yield Part(child, child_place, words, child_place, words)


# The kinds of trees have these under different names.
def _child_count(tree):
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


def point_count(data):
    """How many points or rows a data set has."""
    if isinstance(data, vtkTable):
        return data.GetNumberOfRows()
    return data.GetNumberOfPoints() if isinstance(data, vtkDataSet) else 0


def is_empty(data):
    """Whether it could have points, but has none."""
    return isinstance(data, (vtkDataSet, vtkTable)) and point_count(data) == 0
