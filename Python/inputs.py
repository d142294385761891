# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points and lines of VTK's data objects, as reconstruct() takes them: of point sets, images,
rectilinear grids and tables, and of composite data sets of these."""

import math

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray, vtkStringArray
from vtkmodules.vtkCommonDataModel import (
    vtkImageData,
    vtkPointSet,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkTable,
)
from vtkmodules.vtkFiltersCore import vtkAppendPolyData

from .blocks import parts_of
from .clouds import Cloud, ReadOptions, crs_of, keep_points, make_points, turn_over
from .messages import ElevationSurfaceError, Reason
from .reading import leave_out
from .reading.columns import choose_columns
from .reading.layouts import MISSING
from .reading.nulls import take_out
from .reading.upwards import notes_on_up
from .reading.vtk_files import hidden_points, points_of_grid

SAMPLE = 3000  # rows of a table that tell its columns


def cloud_of(data, array="", options=None):
    """The points of a data set as Cloud. Raises ElevationSurfaceError.

    array    the point array that holds elevations; of point sets "" is z, of grids the active one
    options  ReadOptions: columns of a table, no_data, keep_nulls and depth
    Usual null values are taken out of grids and tables, as of files, unless they are kept.
    """
    options = options or ReadOptions()
    cloud = given_cloud(data, array, options)
    if options.no_data is not None:
        leave_out("input", cloud, options.no_data)
    if not isinstance(data, vtkPointSet):
        take_out(cloud, options)
    cloud.notes += notes_on_up(cloud, options.depth)
    if options.depth:
        turn_over(cloud)
    return cloud


def given_cloud(data, array, options):
    """The points of a data set with all their nulls."""
    if isinstance(data, vtkTable):
        if array:
            raise ElevationSurfaceError("of a table, Columns chooses z, not Elevation Array")
        return cloud_of_table(data, options)
    if options.columns:
        raise ElevationSurfaceError(
            "Columns is for tables; of points and grids, Elevation Array chooses z"
        )
    if not isinstance(data, (vtkImageData, vtkRectilinearGrid, vtkPointSet)):
        raise ElevationSurfaceError(f"a {data.GetClassName()} has no points with elevations")
    if array:
        check_array(data.GetPointData(), array)
    if isinstance(data, (vtkImageData, vtkRectilinearGrid)):
        grid = data.NewInstance()
        grid.ShallowCopy(data)
        if array:
            grid.GetPointData().SetActiveScalars(array)
        cloud = points_of_grid("input", grid)
        cloud.crs = crs_of(data)
        return cloud
    return cloud_of_points(data, array)


def check_array(attributes, name):
    """Raises ElevationSurfaceError where a point array has no elevations, and tells which may."""
    if attributes.GetAbstractArray(name) is None:
        wrong = f"there is no point array named {name}"
    elif attributes.GetArray(name) is None:
        wrong = f"point array {name} holds words, not numbers"
    elif attributes.GetArray(name).GetNumberOfComponents() != 1:
        wrong = f"point array {name} is no single number for each point"
    else:
        return
    arrays = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
    names = [a.GetName() or "" for a in arrays if a and a.GetNumberOfComponents() == 1]
    raise ElevationSurfaceError(f"{wrong}; there are: {', '.join(names) or 'none'}")


def cloud_of_points(data, array):
    if data.GetNumberOfPoints() == 0:
        raise ElevationSurfaceError("there are no points")
    points = vtkPolyData()
    points.SetPoints(data.GetPoints())
    points.GetPointData().ShallowCopy(data.GetPointData())
    points.GetFieldData().ShallowCopy(data.GetFieldData())
    if array:
        xyz = vtk_to_numpy(data.GetPoints().GetData()).astype("f8")
        xyz[:, 2] = vtk_to_numpy(data.GetPointData().GetArray(array))
        points.SetPoints(make_points(xyz).GetPoints())
    cloud = Cloud(points, crs=crs_of(data))
    cloud.z_name = array
    hidden = hidden_points(data)
    if hidden.any():
        cloud.left_out[Reason("point", "marked as hidden")] = int(numpy.count_nonzero(hidden))
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


def number(word):
    """The number that a word is; NaN where it says that there is none, None for other words."""
    try:
        return math.nan if word.strip().lower() in MISSING else float(word)
    except ValueError:
        return None


def cloud_of_table(table, options):
    """x, y and z of a table, found as those of text files are; all columns become point arrays."""
    count = table.GetNumberOfRows()
    columns = columns_of(table)
    if not count or not columns:
        raise ElevationSurfaceError("the table has no rows")
    some = numpy.unique(numpy.linspace(0, count - 1, min(count, SAMPLE)).astype("i8"))
    head = numpy.arange(min(count, SAMPLE))
    rows = [[str(column[i]) for column in columns.values()] for i in [*head, *some]]
    choice = choose_columns(
        "input",
        rows,
        len(head),
        number,
        list(columns),
        len(columns),
        options.columns,
        3,
        None,
    )
    parts = list(columns.values())
    xyz = numpy.column_stack([numbers_of(parts[i], list(columns)[i]) for i in choice.indices])
    cloud = Cloud(make_points(xyz), choice.notes, crs=crs_of(table))
    for i in range(table.GetNumberOfColumns()):
        cloud.points.GetPointData().AddArray(table.GetColumn(i))
    cloud.z_name, cloud.is_horizon = choice.z_name, choice.is_horizon
    finite = numpy.isfinite(xyz).all(axis=1)
    if finite.any() and not finite.all():
        cloud.left_out[Reason("row", "without numbers")] = int(numpy.count_nonzero(~finite))
        keep_points(cloud, numpy.flatnonzero(finite))
    return cloud


def numbers_of(column, name):
    """Doubles of a column, also of one of words that are numbers."""
    if isinstance(column, numpy.ndarray):
        return column.astype("f8")
    values = [number(word) for word in column]
    if None in values:
        row = values.index(None)
        raise ElevationSurfaceError(f"row {row} of column {name} is no number: {column[row]}")
    return numpy.array(values)


# ---- lines ------------------------------------------------------------------------------------


def lines_of(data, what):
    """Lines and polygons of vtkPolyData, or of all blocks of a composite together."""
    parts = [part.data for part in parts_of(data)]
    if not parts or not all(isinstance(part, vtkPolyData) for part in parts):
        raise ElevationSurfaceError(f"{what}: lines or polygons (vtkPolyData) are needed", what)
    return joined(parts)


def joined(parts):
    """Several vtkPolyData as one."""
    if len(parts) == 1:
        return parts[0]
    append = vtkAppendPolyData()
    append.SetOutputPointsPrecision(append.DOUBLE_PRECISION)
    for part in parts:
        append.AddInputData(part)
    append.Update()
    return append.GetOutput()
