# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Arrays of numpy: rows of x, y, z; columns by name; grids of elevations, with x and y or without.
Of files, .npy and .npz, and as reconstruct() takes them."""

import numpy

from ..clouds import Cloud, add_array, make_points, slices
from .column_names import meaning
from .columns import MOST_COLUMNS, are_heights, as_grid
from ..messages import FileError
from .rasters import raster_cloud


def loaded(path):
    """What a file holds: an array, or a dictionary of arrays."""
    try:
        found = numpy.load(path, mmap_mode="r", allow_pickle=False)
        return dict(found) if hasattr(found, "files") else found
    except Exception as error:  # damage shows itself in many ways, of numpy, tokenize, zipfile and zlib
        raise FileError(f"{path}: cannot be read: {' '.join(str(error).split())}") from None


def are_rows(array):
    """Whether an array has a row of x, y, z, and maybe more, for each point."""
    return array.ndim == 2 and 3 <= array.shape[1] <= MOST_COLUMNS and array.dtype.kind in "fiu"


def without_mask(values):
    """Any column as an array; NaN where it is masked."""
    is_masked = isinstance(values, numpy.ma.MaskedArray)
    return values.astype("f8").filled(numpy.nan) if is_masked else numpy.asarray(values)


def named_columns(path, array):
    """({name: column}, notes) of an array of rows, or with fields, or of a dictionary of arrays."""
    notes = []
    if hasattr(array, "keys"):
        columns = {str(name): without_mask(array[name]) for name in array.keys()}
    elif array.dtype.names:
        columns = {name: array[name].ravel() for name in array.dtype.names}
    else:
        names = ["x", "y", "z"] + [f"column {i}" for i in range(4, array.shape[1] + 1)]
        columns = {name: array[:, i] for i, name in enumerate(names)}
        if len(columns) > 3:
            shape = " x ".join(map(str, array.shape))
            notes = [f"the array is {shape}: its first three columns are taken as x, y, z"]
    columns = {name: values for name, values in columns.items() if values.dtype.kind in "fiu"}
    return by_axis(path, columns), notes


def by_axis(path, columns):
    """The same columns with those of coordinates named x, y and z. Raises FileError where z lacks, or is
    doubtful."""
    if len(columns) == 1 and next(iter(columns.values())).ndim == 2:
        return {"z": next(iter(columns.values()))}
    found = {}
    for axis in "xyz":
        names = [name for name in columns if name.lower() == axis]
        names = names or [name for name in columns if meaning(name).axis == axis]
        if len(names) > 1:
            raise FileError(f"{path}: {' and '.join(names)} could be {axis}; rename the one that is meant to {axis}")
        found.update({axis: names[0]} if names else {})
    is_grid = "z" in found and columns[found["z"]].ndim == 2
    if "z" not in found or not is_grid and len(found) < 3:
        raise FileError(f"{path}: has no columns x, y and z, but {', '.join(columns) or 'none of numbers'}")
    axis_of = {name: axis for axis, name in found.items()}
    return {axis_of.get(name, name): values for name, values in columns.items()}


def column_cloud(path, columns, notes=()):
    """A Cloud of columns: points, or the nodes of a grid where z is two-dimensional."""
    z = columns["z"]
    if z.ndim == 2:
        return grid_cloud(path, z, columns.get("x"), columns.get("y"))
    wrong = [name for name, values in columns.items() if values.shape != z.shape and name in "xy"]
    if wrong or z.ndim != 1:
        shapes = ", ".join(f"{name} {' x '.join(map(str, columns[name].shape))}" for name in "xyz")
        raise FileError(f"{path}: the shapes of its columns do not fit: {shapes}")
    if not len(z):
        raise FileError(f"{path}: holds no points")
    cloud = Cloud(make_points(numpy.column_stack([columns[axis].astype("f8") for axis in "xyz"]), copy=False), notes)
    for name, values in columns.items():
        if name not in "xyz" and values.shape == z.shape:
            add_array(cloud.points, name, values.astype(values.dtype.newbyteorder("=")))
    return cloud


def grid_cloud(path, z, x=None, y=None):
    """The nodes of a grid, z of (rows, columns), as a Cloud. NaN is not a node.

    x, y  vectors, for the columns and the rows, or arrays like z; None: numbers from 0
    """
    rows, columns = z.shape
    notes = [f"a grid of {columns} x {rows} nodes"]
    if x is None and y is None:
        notes.append("it has no x and y: they are numbers of column and row, from 0")
    x = numpy.arange(columns) if x is None else numpy.asarray(x)
    y = numpy.arange(rows) if y is None else numpy.asarray(y)
    if x.shape == (columns,) and y.shape == (rows,):
        x, y = numpy.meshgrid(x, y)
    if x.shape != z.shape or y.shape != z.shape:
        shapes = ", ".join(f"{name} {' x '.join(map(str, v.shape))}" for name, v in zip("xyz", (x, y, z)))
        needed = f"x needs {columns} values and y {rows}, or each as many as z"
        raise FileError(f"{path}: {needed}; the shapes are {shapes}")
    cloud = raster_cloud(path, *(v.astype("f8") for v in (x, y, z)))
    cloud.notes += notes
    return cloud


def check_certain(path, array):
    """Refuses an array of two axes that is neither rows of points for sure nor a grid."""
    rows, columns = array.shape
    load = f"numpy.load('{path}')"
    points = "python3 -c \"import numpy; numpy.save('points.npy', {})\" and then points.npy"
    shape, way = f"{path}: holds {rows} x {columns} numbers", points.format(load + "[:, :3]")
    if columns == 2 or rows == 2 and columns > MOST_COLUMNS:
        raise FileError(f"{shape}, as x and y without z; if it is a grid of elevations, {as_grid(path, load)}")
    if rows == 3 and columns > MOST_COLUMNS:
        way = points.format(load + ".T")
    elif not are_rows(array) or not are_heights(array):
        return
    raise FileError(f"{shape}, points or a grid of elevations; if points, {way}; if a grid, {as_grid(path, load)}")


def read_array(path, options):
    """The points or the grid of a file of numpy."""
    array = loaded(path)
    options.progress(0.5)
    if hasattr(array, "keys") and len(array) == 1 and "z" not in array:
        array = next(iter(array.values()))
    is_plain = not hasattr(array, "keys") and not array.dtype.names
    if is_plain and array.ndim == 2 and array.dtype.kind in "fiu":
        check_certain(path, array)
    if is_plain and not are_rows(array):
        shape = " x ".join(map(str, array.shape)) or "one"
        if array.ndim != 2 or array.dtype.kind not in "fiu" or min(array.shape) < 2:
            raise FileError(f"{path}: holds {shape} of {array.dtype}; rows of x, y and z, or a grid, are needed")
        return grid_cloud(path, array)
    return column_cloud(path, *named_columns(path, array))


def row_columns(path):
    """({name: column}, notes) of an array of rows, or with fields, which is not read yet."""
    array = loaded(path)
    if hasattr(array, "keys") or not array.dtype.names and not are_rows(array):
        raise FileError(f"{path}: is not an array of rows of x, y and z, so it is not read in pieces")
    return named_columns(path, array)


class ArraySlices:
    """A part of an array of numpy: iterate to get (x y z, the other columns), slice by slice."""

    def __init__(self, path, options, part):
        self.path, self.progress = path, options.progress
        columns, self.notes = row_columns(path)
        self.part = part.rows(len(columns["x"]))
        self.others = [name for name in columns if name not in "xyz"]

    def __iter__(self):
        begin, end = self.part.start, self.part.stop
        for part in slices(end, first=begin):
            # Opened anew, as what has been read through a mapped file counts as memory in use.
            columns = row_columns(self.path)[0]
            points = numpy.column_stack([columns[axis][part].astype("f8") for axis in "xyz"])
            yield points, {name: columns[name][part] for name in self.others}
            self.progress((part.stop - begin) / (end - begin))

    def facts(self):
        return {}

    def finish(self, _, cloud):
        """Adds to a Cloud what is reported once all points are read."""
        cloud.notes += self.notes
        if self.others:
            cloud.notes.append(f"left out: {', '.join(self.others)}")
