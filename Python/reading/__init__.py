# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads point clouds, boundaries and faults, whatever the kind of file.

Every reader returns a Cloud or vtkPolyData. Every problem is a FileError whose text is one line for
the user.
"""

import contextlib
import os
from typing import Any, Union

import numpy

from ..clouds import RECOGNISED, Cloud, ReadOptions, add_words, make_lines, turn_over
from ..description import DESCRIBED, listing
from .formats import recognise
from ..messages import FileError, Reason, did_you_mean
from ..names import option
from ..progress import no_progress, share
from ..projecting import notes_on_degrees, project
from ..selecting import columns_in, layer_condition, select
from .nulls import blank_attributes, leave_out, take_out
from .text import read_line_table, read_table
from .unpacking import STANDARD_INPUT, is_plain, unpacked
from .upwards import notes_on_up

# Options that mean something for some readers only: {name: their modules}
MEANS_SOMETHING = {name: one.readers for name, one in DESCRIBED.items() if one.readers}
MAY_HAVE_Y_UP = ("a PLY file", "an STL file", "an OBJ file")
NAMES = {
    "text": "text files", "vectors": "vector files", "las": "LAS files", "gocad": "GOCAD files",
    "iesx": "IESX files", "landxml": "LandXML files", "ugrid": "UGRID meshes",
}
NAMES_IN_COLUMNS = ("text.read_text", "gocad", "iesx")  # modules of formats without layers of their own


def check_options(path, **options):
    """Refuses an option that the kind of file has no use for."""
    if any(options.get(name) not in (None, False) for name in MEANS_SOMETHING) and is_plain(path):
        check_use(path, recognise(path)[0], ReadOptions(**options))


def check_use(path, kind, options):
    for name, modules in MEANS_SOMETHING.items():
        if getattr(options, name) not in (None, False) and kind.module.split(".")[0] not in modules:
            fits = " and ".join(NAMES.get(module, module) for module in modules)
            raise FileError(f"{path}: {option(name)} is for {fits}; this is {kind.name}")


@listing(ReadOptions.__dataclass_fields__)
def read(path: Union[str, os.PathLike], **options: Any) -> Cloud:
    """Reads the points of a file of any kind, which is recognised by the content, not the name.

    path     "-" is standard input; a file packed by gzip, bzip2 or xz is unpacked
    progress  a function that is called with the fraction read; what it raises ends the reading
    options  those of the program, whose --help describes each:
             {properties}.
             columns may be a list, and where {"horizon": "Top", "line": [3, 4]}.
             A misspelt one is a TypeError.

    Returns a Cloud. Raises FileError. Takes about a second for a million rows of text, less for
    other kinds.
    """
    for name in options:
        if name not in ReadOptions.__dataclass_fields__:
            known = did_you_mean(name, ReadOptions.__dataclass_fields__)
            raise TypeError(f"read() has no option {name}{known}")
    options = ReadOptions(**options)
    cloud = finished(path, read_whole(path, options), options)
    if options.project:
        project(os.fspath(path), cloud)
    return cloud


def read_whole(path, options):
    """The Cloud of all points of a file, with its nulls. Options are ReadOptions."""
    whole = options.progress
    with unpacked(os.fspath(path), whole) as (local, begun):
        options.progress = share(whole, begun, 0.7)
        cloud = read_by_format(local, options)
    options.progress = whole
    return cloud


def raster_frame(path):
    """(the Frame of the raster in a file, its coordinate reference system or None). Raises FileError
    where it holds none."""
    with unpacked(os.fspath(path)) as (local, _):
        kind, _ = recognise(local)
        if kind.module == "rasters":
            from .rasters import raster_frame as read_frame

            frame, crs = read_frame(local)
        else:
            cloud = read_by_format(local, ReadOptions(points_only=True))
            frame, crs = cloud.frame, cloud.crs
        if frame is None:
            raise FileError(f"{local}: is not a raster with even steps, so there are no pixels like its own")
    return frame, crs


def finished(path, cloud, options):
    """What read() makes of the Cloud of read_whole(), which it changes: points that are chosen,
    without nulls, and turned over."""
    name = STANDARD_INPUT if path == "-" else os.fspath(path)
    if options.where:
        select(name, cloud, options.where)
    whole, options.progress = options.progress, share(options.progress, 0.7, 1.0)
    cloud = take_out(cloud, options)
    if not options.keep_nulls:
        cloud.notes += blank_attributes(cloud.points)
    cloud.notes += notes_on_up(cloud, options.depth, name)
    if not options.project:
        cloud.notes += notes_on_degrees(cloud)
    options.progress = whole
    if options.depth:
        turn_over(cloud)
    return cloud


def read_by_format(path, options):
    """The Cloud of a file as its reader gives it, with its nulls."""
    kind, notes = recognise(path)
    check_use(path, kind, options)
    cloud = kind.reader()(path, options)
    if options.layer and kind.module in NAMES_IN_COLUMNS:
        named = layer_condition(path, options.layer, columns_in(cloud))
        select(path, cloud, [named], Reason("point", "of other layers"))
    if options.no_data is not None and kind.module not in ("text.read_text", "rasters"):
        leave_out(path, cloud, options.no_data)
    if kind.name in MAY_HAVE_Y_UP:
        notes = notes + upright_note(cloud.points)
    cloud.notes[:0] = notes
    return cloud


def upright_note(points):
    """Notes where a mesh is flat in y, as where y is the height; in z, a surface is."""
    low_x, high_x, low_y, high_y, low_z, high_z = points.GetBounds()
    x, y, z = high_x - low_x, high_y - low_y, high_z - low_z
    if 3 * y > min(x, z) or max(x, z) > 10 * min(x, z):
        return []
    return [
        f"x, y and z extend over {x:.4g}, {y:.4g} and {z:.4g}: if y is the height, as in many "
        "programs for 3D models, export the file with z upwards"
    ]


def read_faults(path, depth=False, progress=no_progress):
    """The faults or breaklines of a file as vtkPolyData with lines or polygons.

    depth    True: their z counts downwards, and is turned over
    progress a function that is called with the fraction read; what it raises ends the reading

    A text file holds one line after the other, x, y and z in the first columns, a blank line
    between them. Lines without z have z 0 and are marked by the cell array WithoutZ; reconstruct()
    drapes them. The field array Recognised holds notes on how they were read. Raises FileError.
    """
    faults = Cloud(read_lines(os.fspath(path), "a fault", "faults", text_faults, progress))
    if depth:
        turn_over(faults)
    return faults.points


def read_boundary(path, progress=no_progress):
    """The boundary rings of a file as vtkPolyData with lines or polygons. Progress as of faults.

    A text file holds one ring after the other, x and y in the first columns, a blank line between
    rings, and each ring's first point again at its end. Rings that are not closed are read;
    reconstruct() closes small gaps. The field array Recognised holds notes on how they were read.
    Raises FileError.
    """
    return read_lines(os.fspath(path), "a boundary", "a boundary", text_boundary, progress)


def read_lines(path, singular, what, read_text_lines, progress):
    with unpacked(path, progress) as (local, begun):
        progress = share(progress, begun, 1.0)
        kind, notes = recognise(local)
        if kind.module == "text.read_text":
            lines, more = read_text_lines(local, progress)
            notes = notes + more
        elif kind.lines:
            lines = kind.line_reader()(local, singular, progress)
        else:
            raise FileError(f"{local}: {kind.name} cannot be read as {what}")
        add_words(lines.GetFieldData(), RECOGNISED, notes)
        return lines


def text_lines(path, table, what):
    """(the lines of a text file as vtkPolyData, notes): table is what read_table() gives of it."""
    rows, numbers, starts, notes = table
    is_usable = numpy.isfinite(rows)
    is_usable[:, 2:3] |= numpy.isnan(rows[:, 2:3])  # such a z is missing: it comes from the surface
    bad = numpy.flatnonzero(~is_usable.all(axis=1))
    if len(bad):
        raise FileError(f"{path}, line {numbers[bad[0]]}: {what} is not finite")
    if rows.shape[1] == 2:
        rows = numpy.column_stack((rows, numpy.full(len(rows), numpy.nan)))
    ends = [*starts[1:], len(rows)]
    names = [f"the part from line {numbers[a]} to {numbers[b - 1]}" for a, b in zip(starts, ends)]
    return make_lines([rows[a:b] for a, b in zip(starts, ends)], names), notes


def text_faults(path, progress):
    return text_lines(path, read_line_table(path, progress), "a point of a fault")


def text_boundary(path, progress):
    """x and y; and z, where three columns are read as the same x and y with a z."""
    table = read_table(path, 2, progress)
    with contextlib.suppress(FileError):
        with_z = read_table(path, 3)
        if numpy.array_equal(with_z[0][:, :2], table[0], equal_nan=True):
            table = with_z
    return text_lines(path, table, "a boundary point")
