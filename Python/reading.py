# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads point clouds, boundaries and faults, whatever the kind of file.

Every reader returns a Cloud or vtkPolyData. Every problem is a FileError whose text is one line for
the user.
"""

import os

import numpy
from vtkmodules.vtkCommonDataModel import vtkCellArray

from .clouds import ReadOptions, make_points, turn_over
from .messages import FileError
from .nulls import take_out
from .paths import check_readable, check_suffix, suffix_of
from .rasters import read_dem, read_tiff
from .text import read_table, read_text
from .vtk_files import read_lines_with_vtk, read_with_vtk

TEXT_SUFFIXES = (".csv", ".xyz", ".txt")
RASTER_SUFFIXES = (".tif", ".tiff", ".dem", ".vti")
VTK_SUFFIXES = (".vtp", ".vtu", ".vts", ".vtr", ".vtk", ".ply", ".stl", ".obj")
READ_SUFFIXES = VTK_SUFFIXES + TEXT_SUFFIXES + RASTER_SUFFIXES


def check_columns_wanted(path):
    if suffix_of(path) not in TEXT_SUFFIXES:
        raise FileError(f"{path}: --columns is for text files ({' '.join(TEXT_SUFFIXES)})")


def read(path, **options):
    """Reads the points of a file, whatever its kind.

    options  those of ReadOptions
    Returns a Cloud. Raises FileError. Takes about a second for a million rows of text, less for
    other kinds.
    """
    options = ReadOptions(**options)
    cloud = take_out(read_any(os.fspath(path), options), options)
    if options.depth:
        turn_over(cloud)
    return cloud


def read_any(path, options):
    """The Cloud of a file as its reader gives it, with its nulls."""
    if not os.path.isdir(path):
        check_suffix(path, READ_SUFFIXES, "read")
    check_readable(path)
    suffix = suffix_of(path)
    if options.columns:
        check_columns_wanted(path)
    if suffix in TEXT_SUFFIXES:
        return read_text(path, options)
    if suffix in (".tif", ".tiff"):
        return read_tiff(path, options)
    if suffix == ".dem":
        return read_dem(path, options)
    return read_with_vtk(path, options)


LINE_SUFFIXES = (".vtp", ".vtk", ".ply", ".stl", ".obj") + TEXT_SUFFIXES


def read_faults(path):
    """The faults or breaklines of a file as vtkPolyData with lines or polygons.

    A text file holds one line after the other, x, y and z in the first columns, a blank line
    between them. Raises FileError.
    """
    check_suffix(path, LINE_SUFFIXES, "read as faults")
    check_readable(path)
    if suffix_of(path) not in TEXT_SUFFIXES:
        return read_lines_with_vtk(path, "a fault")
    rows, lines, starts, _ = read_table(path, needed=3)
    bad = numpy.flatnonzero(~numpy.isfinite(rows).all(axis=1))
    if len(bad):
        raise FileError(f"{path}, line {lines[bad[0]]}: a point of a fault is not finite")
    cells = vtkCellArray()
    for start, end in zip(starts, starts[1:] + [len(rows)]):
        cells.InsertNextCell(end - start, list(range(start, end)))
    data = make_points(rows)
    data.SetLines(cells)
    return data


def read_boundary(path):
    """The boundary rings of a file as vtkPolyData.

    VTK's formats hold them as lines or polygons. A text file holds one ring after the other,
    x and y in the first columns, a blank line between rings, and each ring's first point again
    at its end. Raises FileError, also for a text ring that is not closed.
    """
    check_suffix(path, LINE_SUFFIXES, "read as a boundary")
    check_readable(path)
    if suffix_of(path) not in TEXT_SUFFIXES:
        return read_lines_with_vtk(path, "a boundary")
    rows, lines, starts, _ = read_table(path, needed=2)
    bad = numpy.flatnonzero(~numpy.isfinite(rows).all(axis=1))
    if len(bad):
        raise FileError(f"{path}, line {lines[bad[0]]}: a boundary point is not finite")
    ends = starts[1:] + [len(rows)]
    coordinates, cells = [], vtkCellArray()
    total = 0
    for start, end in zip(starts, ends):
        ring = rows[start:end]
        if len(ring) < 4 or not numpy.array_equal(ring[0], ring[-1]):
            raise FileError(
                f"{path}: the boundary from line {lines[start]} to line {lines[end - 1]} is not "
                "closed; its last point must repeat its first, after three or more others"
            )
        count = len(ring) - 1
        ids = list(range(total, total + count)) + [total]
        cells.InsertNextCell(len(ids), ids)
        coordinates.append(numpy.column_stack((ring[:-1], numpy.zeros(count))))
        total += count
    data = make_points(numpy.concatenate(coordinates))
    data.SetLines(cells)
    return data
