# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What filters have made, in one part or several, as plain arrays; and how two of these differ."""

import re
import zlib

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkPointSet
from vtkmodules.vtkCommonExecutionModel import vtkPolyDataAlgorithm

import meshes


def noted(*algorithms):
    """The list that gets the messages of filters, without their addresses."""
    messages = []

    def note(_caller, event, text):
        messages.append((event, re.split(r"\((?:0x)?[0-9A-Fa-f]+\): ", text, maxsplit=1)[-1].strip()))

    note.CallDataType = "string0"
    for algorithm in algorithms:
        algorithm.AddObserver("ErrorEvent", note)
        algorithm.AddObserver("WarningEvent", note)
    return messages


def numbers_of(array):
    """(n, k) numbers of an array: of words, sums of their letters."""
    if isinstance(array, vtkStringArray):
        words = [array.GetValue(i) for i in range(array.GetNumberOfValues())]
        return numpy.array([float(zlib.crc32(word.encode())) for word in words]).reshape(-1, 1)
    values = vtk_to_numpy(array)
    return numpy.nan_to_num(values.reshape(len(values), -1).astype("f8"), nan=-1e99, posinf=1e98, neginf=-1e98)


def columns_of(attributes, count, without=()):
    """{name: (type, numbers)} of all arrays but marks, and the numbers that filters give points."""
    found = {}
    for i in range(attributes.GetNumberOfArrays()):
        array = attributes.GetAbstractArray(i)
        if array.GetName() not in (meshes.GHOSTS, "GlobalPointIds", *without):
            words = numbers_of(array) if count else numpy.zeros((0, array.GetNumberOfComponents()))
            found[array.GetName()] = (array.GetDataTypeAsString(), words)
    return found


def row_of(columns, first):
    return numpy.column_stack([first, *(columns[name][1] for name in sorted(columns))])


def part_made(data, ids=None, without=()):
    """What a part of an output has, as plain arrays.

    ids      of the points, to be compared with their values
    without  point arrays with these names
    """
    count = data.GetNumberOfPoints()
    kinds, made = {}, {"triangles": numpy.zeros((0, 0)), "holes": numpy.zeros(0), "count": data.GetNumberOfPolys()}
    columns = columns_of(data.GetPointData(), count, without)
    if ids is not None:
        columns["ids"] = ("ids", numpy.asarray(ids, float).reshape(-1, 1))
    rows = row_of(columns, numbers_of(data.GetPoints().GetData()) if count else numpy.zeros((0, 3)))
    made["points"] = rows[~meshes.ghosts_of(data)]
    cells = columns_of(data.GetCellData(), data.GetNumberOfCells(), ("HoleId",))
    if count:
        kinds = {"points": data.GetPoints().GetDataType()}
        kinds.update({"point " + name: kind for name, (kind, _) in columns.items()})
        kinds.update({"cell " + name: kind for name, (kind, _) in cells.items()} if data.GetNumberOfPolys() else {})
    made["kinds"] = kinds
    if data.GetNumberOfPolys():
        first = data.GetNumberOfVerts() + data.GetNumberOfLines()
        corners = meshes.turned(meshes.triangles_of(data), rows[:, :3])
        values = row_of(cells, numpy.zeros((data.GetNumberOfCells(), 0)))[first:]
        made["triangles"] = numpy.column_stack((rows[corners].reshape(len(corners), -1), values))
        holes = data.GetCellData().GetArray("HoleId")
        made["holes"] = vtk_to_numpy(holes)[first:].astype(int) if holes else numpy.full(len(corners), -1)
    fields = data.GetFieldData()
    unused = [fields.GetArray("UnusedPoint" + name) for name in ("Ids", "Reasons")]
    made["unused"] = numpy.zeros((0, 0))
    # Outlines have field data of the surface, whose points these are.
    if count and not data.GetNumberOfLines() and all(unused) and unused[0].GetNumberOfTuples():
        which, reasons = (vtk_to_numpy(array) for array in unused)
        # Without them, numbers are those of the input.
        which = which[:, None] if "OriginalPointIds" in columns else rows[which]
        made["unused"] = numpy.column_stack((which, reasons))
    found = fields.GetArray("Lattice")
    made["lattice"] = [found.GetTuple(0)] if found else []
    made["report"] = report_of(data)
    return made


REPORTED = ("Status", "NumberOfEdges", "Perimeter", "Area", "NumberOfInsertedPoints", "Interpolation")


def report_of(data):
    """[(number of the hole, what is reported about it, its rim's points in one order)], or of rings the last."""
    cells, found = data.GetCellData(), []
    rows = numbers_of(data.GetPoints().GetData()) if data.GetNumberOfPoints() else None
    ids = cells.GetArray("HoleId")
    for i in range(data.GetNumberOfLines()):
        values = [cells.GetArray(name).GetValue(i) for name in REPORTED] if ids else []
        corners = data.GetCell(data.GetNumberOfVerts() + i).GetPointIds()
        rim = [tuple(rows[corners.GetId(k)]) for k in range(corners.GetNumberOfIds() - 1)]
        found.append((ids.GetValue(i) if ids else i, (*values, *sorted(rim))))
    return found


def leaves(output):
    """The data sets of an output, in order."""
    if isinstance(output, vtkPointSet):
        return [output]
    each, found = output.NewIterator(), []
    each.InitTraversal()
    while not each.IsDoneWithTraversal():
        found.append(each.GetCurrentDataObject())
        each.GoToNextItem()
    return found


def own_names(algorithm, verb):
    """Of the methods that a filter's own class has, those of a verb, without it."""
    return {name[len(verb) :] for name in dir(algorithm)
            if name.startswith(verb) and not hasattr(vtkPolyDataAlgorithm, name)}


GETTERS = ("NumberOf", "LargestElevationError", "EffectiveGapTolerance", "LatticeFound")


def counts_of(*algorithms):
    """{name: value} of what filters count."""
    return {name: getattr(algorithm, "Get" + name)() for algorithm in algorithms
            for name in sorted(own_names(algorithm, "Get"))
            if name.startswith(GETTERS) and not name.startswith("NumberOfThreads")}


def made_by(algorithms, messages, ids=None, without=()):
    """What the last filter of a chain has made on this rank; see part_made()."""
    last = algorithms[-1]
    ports = [[part_made(data, ids if port == 0 else None, without) for data in leaves(last.GetOutputDataObject(port))]
             for port in range(last.GetNumberOfOutputPorts())]
    return {"ports": ports, "counts": counts_of(*algorithms), "messages": messages}


def take_gathering(messages):
    """Takes the lines away that report a surface on one rank, and returns them."""
    lines = [(event, line) for event, text in messages for line in text.splitlines()]
    gathering = [line for line in lines if "is made on one rank" in line[1]]
    if gathering:
        messages[:] = [line for line in lines if line not in gathering]
    return gathering


def joined(parts, are_in_order=False, have_holes_numbers=False, digits=None):
    """The parts of one surface together. All report the same counts.

    are_in_order        whether the order of points and triangles counts, too
    have_holes_numbers  whether the numbers of holes do, which follow the order of triangles
    digits              so many of z and values count behind the point
    """
    whole = {"counts": parts[0]["counts"], "messages": [message for part in parts for message in part["messages"]],
             "alike": all(part["counts"] == parts[0]["counts"] for part in parts), "ports": []}
    whole["shares"] = [sum(block["count"] for block in part["ports"][0]) for part in parts]
    for port in range(min(len(part["ports"]) for part in parts)):
        blocks = []
        for index in range(max(len(part["ports"][port]) for part in parts)):
            each = [part["ports"][port][index] for part in parts if index < len(part["ports"][port])]
            block = {}
            for name in ("points", "triangles", "unused"):
                rows = [one[name] for one in each if len(one[name])]
                widths = {one.shape[1] for one in rows}
                block[name] = numpy.vstack(rows) if len(widths) == 1 else numpy.zeros((len(rows), 0))
            block["holes"] = numpy.concatenate([one["holes"] for one in each])
            block["report"] = [row for one in each for row in one["report"]]
            block["lattice"] = sorted({found for one in each for found in one["lattice"] if port == 0})
            block["kinds"] = {}
            for one in each:
                for name, kind in one["kinds"].items():
                    block["kinds"].setdefault(name, set()).add(kind)
            blocks.append(block)
        whole["ports"].append(blocks)
    # Holes have numbers by the order of triangles; here, by what is reported about them.
    for block, outlines in zip(whole["ports"][0], whole["ports"][1] if len(whole["ports"]) == 2 else []):
        order = sorted(outlines["report"], key=lambda one: one[0] if have_holes_numbers else one[1])
        place = {number: i for i, (number, _) in enumerate(order)}
        outlines["report"] = order
        block["holes"] = numpy.array([place.get(number, -1) for number in block["holes"].tolist()], float)
        if len(block["triangles"]):
            block["triangles"] = numpy.column_stack((block["triangles"], block["holes"]))
    for blocks in whole["ports"]:
        for block in blocks:
            block["report"] = [row for _, row in block["report"]]
            del block["holes"]
            if digits is not None:
                round_heights(block, digits)
            for name in ("points", "triangles", "unused") if not are_in_order else ():
                block[name] = meshes.sorted_rows(block[name])
    return whole


def rounded(row, digits):
    return tuple(rounded(one, digits) if isinstance(one, tuple) else round(one, digits) for one in row)


def round_heights(block, digits):
    """Rounds all of points and triangles but x and y, and the reports on holes and rings."""
    block["report"] = [rounded(row, digits) for row in block["report"]]
    width = block["points"].shape[1] if len(block["points"]) else 0
    for name in ("points", "triangles"):
        rows = block[name]
        for i in range(rows.shape[1] if len(rows) and width else 0):
            if i >= 3 * width or i % width > 1:
                rows[:, i] = numpy.round(rows[:, i], digits) + 0.0


def difference(found, expected):
    """What differs first, in words, or ""."""
    if found["messages"] != expected["messages"]:
        return "messages %s, not %s" % (found["messages"], expected["messages"])
    if not found["alike"]:
        return "counts differ by part"
    for name, value in found["counts"].items():
        if expected["counts"].get(name, value) != value:
            return "%s: %s, not %s" % (name, value, expected["counts"][name])
    for port, (blocks, wanted) in enumerate(zip(found["ports"], expected["ports"])):
        if len(blocks) != len(wanted):
            return "%d blocks, not %d" % (len(blocks), len(wanted))
        for block, right in zip(blocks, wanted):
            for name, value in right.items():
                mine = block[name]
                if isinstance(value, numpy.ndarray):
                    if mine.shape != value.shape and (len(mine) or len(value)):
                        return "output %d: %s %s, not %s" % (port, name, mine.shape, value.shape)
                    if len(mine) and not numpy.array_equal(mine, value):
                        return "output %d: %s differ by %g" % (port, name, numpy.nanmax(abs(mine - value)))
                elif mine != value:
                    return "output %d: %s %s, not %s" % (port, name, str(mine)[:300], str(value)[:300])
    return ""
