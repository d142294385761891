# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points and lines of VTK's data objects, as reconstruct() takes them: of point sets, images,
rectilinear grids and tables, and of composite data sets of these."""


import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray, vtkStringArray
from vtkmodules.vtkCommonDataModel import (
    vtkDataSetAttributes,
    vtkImageData,
    vtkPointSet,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkTable,
)

from .blocks import parts_of
from .clouds import (
    Cloud,
    ReadOptions,
    check_ids,
    coordinates_of,
    crs_of,
    grid_of,
    joined,
    keep_points,
    make_points,
    marked_points,
    turn_over,
)
from .messages import ElevationSurfaceError, Reason
from .ranks import before, together, total
from .reading.columns import Choice
from .reading.layouts import Layout
from .reading.nulls import leave_out, take_out
from .reading.upwards import notes_on_up
from .reading.vtk_files import grid_points

SAMPLE = 3000  # rows by which the columns of a table are recognised


def cloud_of(parts, array="", options=None, ranks=None):
    """The points of data sets of a kind as one Cloud. Raises ElevationSurfaceError.

    array    the point array that holds elevations; of point sets "" is z, of grids the active one
    options  ReadOptions: columns of a table, no_data, keep_nulls and depth
    ranks    the controller of those that have some of the data sets each, or None. Then notes and
             counts are those of all, points that ranks have in common are those of the first of them,
             and nodes of grids have global ids
    Usual null values are taken out of grids and tables, as of files, unless they are kept.
    """
    options = options or ReadOptions()
    kinds = together(ranks, lambda: [kind_of(part) for part in parts])
    if len(set(kinds)) > 1:
        raise ElevationSurfaceError(
            f"different ranks (processes) have different kinds of it: {' and '.join(sorted(set(kinds)))}"
        )
    if kinds[0] == "tables":
        if array:
            raise ElevationSurfaceError("of a table, Columns chooses z, not Elevation Array")
        clouds = table_clouds(parts, options, ranks)
    elif options.columns:
        raise ElevationSurfaceError(
            "Columns is for tables; of points and grids, Elevation Array chooses z"
        )
    elif kinds[0] == "points":
        clouds = [point_set_cloud(part, array, ranks) for part in parts]
    else:
        clouds = grid_clouds(parts, array, ranks)
    cloud = clouds[0] if clouds else Cloud(vtkPolyData())
    if ranks:
        join_clouds(ranks, cloud, clouds)
    if options.no_data is not None:
        leave_out("input", cloud, options.no_data, ranks)
    if kinds[0] != "points":
        take_out(cloud, options, ranks)
    cloud.notes += notes_on_up(cloud, options.depth, ranks=ranks)
    if options.depth:
        turn_over(cloud)
    return cloud


KINDS = (
    (vtkTable, "tables"), (vtkImageData, "images"), (vtkRectilinearGrid, "grids"), (vtkPointSet, "points"),
)


def kind_of(data):
    for kind, name in KINDS:
        if isinstance(data, kind):
            return name
    raise ElevationSurfaceError(f"a {data.GetClassName()} has no points with elevations")


def join_clouds(ranks, cloud, clouds):
    """Makes cloud that of the points of some, with what the clouds of all ranks say together."""
    ids = [one.points.GetPointData().GetGlobalIds() for one in clouds]
    cloud.points = joined([one.points for one in clouds]) if clouds else cloud.points
    if ids and all(ids):
        data = cloud.points.GetPointData()
        data.SetGlobalIds(data.GetArray(ids[0].GetName()))

    def facts():
        lost = [[[*reason.parts, count] for reason, count in one.left_out.items()] for one in clouds]
        return [
            [one.notes, one.z_name, one.is_horizon, one.crs, left_out, one.largest_cell, one.pixels]
            for one, left_out in zip(clouds, lost)
        ]

    every = together(ranks, facts)
    notes, names, are_horizons, systems, lost, cells, pixels = zip(*every)
    cloud.notes = list(dict.fromkeys(sum(notes, [])))
    cloud.z_name, cloud.is_horizon, cloud.largest_cell = names[0], are_horizons[0], max(cells)
    cloud.crs = next((crs for crs in systems if crs), None)
    cloud.left_out = {}
    for *words, count in sum(lost, []):
        reason = Reason(*words)
        cloud.left_out[reason] = cloud.left_out.get(reason, 0) + count
    cloud.grid = grid_of(pixels)


def check_array(attributes, name):
    """Raises ElevationSurfaceError where a point array has no elevations, and names those that may."""
    if attributes.GetAbstractArray(name) is None:
        wrong = f"there is no point array named {name}"
    elif attributes.GetArray(name) is None:
        wrong = f"point array {name} holds words, not numbers"
    elif attributes.GetArray(name).GetNumberOfComponents() != 1:
        wrong = f"point array {name} is not a single number for each point"
    else:
        return
    arrays = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
    names = [a.GetName() or "" for a in arrays if a and a.GetNumberOfComponents() == 1]
    raise ElevationSurfaceError(f"{wrong}; there are: {', '.join(names) or 'none'}")


def grid_clouds(grids, array, ranks):
    """The Cloud of each grid, of which ranks have pieces: a node is in the first that has it."""
    extents = together(ranks, lambda: [list(grid.GetExtent()) for grid in grids])
    clouds = []
    for i, grid in enumerate(grids, before(ranks, len(grids))):
        if array:
            check_array(grid.GetPointData(), array)
            copy = grid.NewInstance()
            copy.ShallowCopy(grid)
            grid = copy
            grid.GetPointData().SetActiveScalars(array)
        clouds.append(grid_points("input", grid, nodes_of(extents, i) if ranks else None))
        clouds[-1].crs = crs_of(grid)
    if ranks and not total(ranks, sum(cloud.points.GetNumberOfPoints() for cloud in clouds)):
        raise ElevationSurfaceError("input: all pixels are without data")
    return clouds


def nodes_of(extents, number):
    """(rows, columns) numbers of the nodes of a piece of a grid, by their places in the whole; -1 for those
    that pieces before it have. extents: of all pieces"""
    low, high = numpy.min(extents, axis=0), numpy.max(extents, axis=0)
    west, east, south, north = extents[number][:4]
    rows, columns = numpy.arange(south, north + 1)[:, None], numpy.arange(west, east + 1)
    nodes = (rows - low[2]) * (high[1] - low[0] + 1) + columns - low[0]
    for west, east, south, north, *_ in extents[:number]:
        is_there = (rows >= south) & (rows <= north) & (columns >= west) & (columns <= east)
        nodes[is_there] = -1
    return nodes


def point_set_cloud(data, array, ranks):
    if data.GetNumberOfPoints() == 0:
        raise ElevationSurfaceError("there are no points")
    if array:
        check_array(data.GetPointData(), array)
    points = vtkPolyData()
    points.SetPoints(data.GetPoints())
    points.GetPointData().ShallowCopy(data.GetPointData())
    points.GetFieldData().ShallowCopy(data.GetFieldData())
    if array:
        xyz = coordinates_of(data).astype("f8")
        xyz[:, 2] = vtk_to_numpy(data.GetPointData().GetArray(array))
        points.SetPoints(make_points(xyz).GetPoints())
    cloud = Cloud(points, crs=crs_of(data))
    cloud.z_name = array
    hidden = marked_points(data, vtkDataSetAttributes.HIDDENPOINT)
    if hidden.any():
        cloud.left_out[Reason("point", "marked as hidden")] = int(numpy.count_nonzero(hidden))
    if ranks:
        hidden |= marked_points(data, vtkDataSetAttributes.DUPLICATEPOINT)
    if hidden.any():
        keep_points(cloud, numpy.flatnonzero(~hidden))
    return cloud


# ---- tables -----------------------------------------------------------------------------------


def columns_of(table):
    """{name: (n,) numbers, or list of words}, an array of several components being several."""
    found = {}
    for i in range(table.GetNumberOfColumns()):
        column = table.GetColumn(i)
        name = column.GetName() or f"column {i + 1}"
        if isinstance(column, vtkDataArray):
            values = vtk_to_numpy(column)
            if values.ndim == 1:
                found[name] = values
            else:
                signs = "xyz" if values.shape[1] <= 3 else range(values.shape[1])
                for sign, part in zip(signs, values.T):
                    found[f"{name} {sign}"] = part
        elif isinstance(column, vtkStringArray):
            found[name] = [column.GetValue(row) for row in range(column.GetNumberOfValues())]
    return found


def table_clouds(tables, options, ranks):
    """x, y and z of each table, found in all of them together as those of text files are; all columns
    become point arrays."""
    every = [columns_of(table) for table in tables]
    counts = [table.GetNumberOfRows() for table in tables]
    titles = together(ranks, lambda: [list(columns) for columns in every])
    names = [name for name in titles[0] if all(name in others for others in titles)]
    count = total(ranks, sum(counts))
    if not count or not names:
        raise ElevationSurfaceError("the table has no rows")
    begins = before(ranks, sum(counts)) + numpy.cumsum([0, *counts])

    def rows_at(places):
        """The rows at some places in all tables, as words."""
        return [
            [str(columns[name][place - begin]) for name in names]
            for columns, begin, end in zip(every, begins, begins[1:])
            for place in places[(places >= begin) & (places < end)].tolist()
        ]

    head = numpy.arange(min(count, SAMPLE))
    some = numpy.unique(numpy.linspace(0, count - 1, min(count, SAMPLE)).astype("i8"))
    rows = together(ranks, lambda: rows_at(head)) + together(ranks, lambda: rows_at(some))
    choice = Choice("input", rows, len(head), Layout(None), names, names, len(names), options.columns, 3, None)
    clouds = []
    for table, columns, begin in zip(tables, every, begins.tolist()):
        chosen = [numbers_of(columns[names[i]], names[i], begin) for i in choice.indices]
        notes = [f"x,y {choice.angles}: project them first"] if choice.angles != "no" else []
        cloud = Cloud(make_points(numpy.column_stack(chosen)), choice.notes + notes, crs=crs_of(table))
        for i in range(table.GetNumberOfColumns()):
            cloud.points.GetPointData().AddArray(table.GetColumn(i))
        cloud.z_name, cloud.is_horizon = choice.z_name, choice.is_horizon
        clouds.append(cloud)
    finite = [numpy.isfinite(coordinates_of(cloud.points)).all(axis=1) for cloud in clouds]
    if total(ranks, sum(numpy.count_nonzero(one) for one in finite)):
        for cloud, is_finite in zip(clouds, finite):
            if not is_finite.all():
                left_out = int(numpy.count_nonzero(~is_finite))
                cloud.left_out[Reason("row", "without numbers")] = left_out
                keep_points(cloud, numpy.flatnonzero(is_finite))
    return clouds


def numbers_of(column, name, first):
    """Doubles of a column, also of one of words that are numbers; first: the number of its first row."""
    if isinstance(column, numpy.ndarray):
        return column.astype("f8")
    values = [Layout(None).number(word) for word in column]
    if None in values:
        row = values.index(None)
        raise ElevationSurfaceError(f"row {first + row} of column {name} is not a number: {column[row]}")
    return numpy.array(values)


# ---- lines ------------------------------------------------------------------------------------


def lines_of(data, what):
    """Lines and polygons of vtkPolyData, or of all blocks of a composite together."""
    parts = [part.data for part in parts_of(data)]
    if not parts or not all(isinstance(part, vtkPolyData) for part in parts):
        raise ElevationSurfaceError(f"{what}: lines or polygons (vtkPolyData) are needed", what)
    for part in parts:
        check_ids(part, what)
    return joined(parts)
