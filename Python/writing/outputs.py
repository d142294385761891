# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a Reconstruction is written as: one line of a table for each kind of file."""

import dataclasses
import os
import re

import numpy

from ..messages import ElevationSurfaceError, FileError
from ..names import option
from ..writing import WRITE_SUFFIXES, write_surface

GRID_SUFFIXES = (".tif", ".asc", ".dat", ".zmap")
LINE_SUFFIXES = (".gpkg", ".geojson", ".dxf")


def surface(result, path, _step, progress):
    return write_surface(result.surface, path, result.crs, progress)


def grid(result, path, pixels, progress):
    from .grids import grid_of, write_grid

    pixels, method = pixels
    step, like = (None, pixels or None) if isinstance(pixels, str) else (pixels, None)
    made, notes = grid_of(result, step, like, lambda fraction: progress(0.7 * fraction), method)
    return notes + write_grid(made, path, lambda fraction: progress(0.7 + 0.3 * fraction))


def contours(result, path, step, progress):
    from .lines import contours as contour_lines, write_lines

    return write_lines(contour_lines(result.surface, step, progress), path, "contours", result.crs, progress)


def outlines(result, path, _step, progress):
    from .lines import outlines as outline_lines, write_lines

    return write_lines(outline_lines(result), path, "outlines", result.crs, progress)


def heights(result, path, given, progress):
    """A table of the places in a file with the elevations there; nothing stands where there is none."""
    from ..query import Heights, check_over_xy

    check_over_xy(result, "elevation")
    (places, moved), name, method = given  # as in the file, and in the system of the surface
    elevations, errors = Heights(result.surface, method).at(moved, progress)
    columns = [places[:, 0], places[:, 1], elevations] + ([] if errors is None else [errors])
    with open(path, "w", encoding="utf-8", newline="\n") as stream:
        stream.write("x,y,z" + (",error" if errors is not None else "") + "\n")
        for row in zip(*(column.tolist() for column in columns)):
            stream.write(",".join("" if value != value else repr(value) for value in row) + "\n")
    outside = int(numpy.isnan(elevations).sum())
    result.report["elevations_at"] = {"file": name, "places": len(places), "outside": outside}
    return []


def difference(result, path, other, progress):
    """A map of the difference to another surface or a level, whose volumes the report gets."""
    from ..query import volume_between

    volume, surface, _ = volume_between(result, other, map_too=True, progress=progress)
    result.report["volume"] = {
        "over": other.name, "net": volume.net, **dataclasses.asdict(volume), "is_level": other.surface is None
    }
    return write_surface(surface, path, result.crs)


@dataclasses.dataclass(frozen=True)
class Output:
    """A kind of result.

    name      the command line's name of its file, with underscores
    step      the option that asks for it, as by a length; "" where there is none
    ending    of the default name; "" where there is none but the option's
    suffixes  what the file's name may end with
    write     function of a Reconstruction, a path, the length and progress; returns notes
    """

    name: str
    step: str
    ending: str
    suffixes: tuple
    write: object


OUTPUTS = (
    Output("output", "", "_surface.vtp", WRITE_SUFFIXES, surface),
    Output("grid_output", "grid", "_grid.tif", GRID_SUFFIXES, grid),
    Output("at_output", "at", "_at.csv", (".csv",), heights),
    Output("volume_output", "volume", "_difference.vtp", WRITE_SUFFIXES, difference),
    Output("contours_output", "contours", "_contours.gpkg", LINE_SUFFIXES, contours),
    Output("outlines", "", "_outlines.gpkg", LINE_SUFFIXES, outlines),
)


def default_name(output, surface_path):
    """survey_surface.vtp -> survey_grid.tif, next to it"""
    return re.sub("_surface$", "", os.path.splitext(surface_path)[0]) + output.ending


def check_gdal(what):
    """Refuses what cannot be written without GDAL, before any work is done."""
    from ..gdal_common import gdal_module

    try:
        gdal_module()
    except ImportError:
        raise FileError(f"{what}: GDAL is missing; install python3-gdal") from None


def write_output(output, result, path, step, progress):
    """Writes one result. Returns notes. Raises OSError, FileError and ElevationSurfaceError."""
    try:
        return output.write(result, path, step, progress)
    except FileError:
        raise
    except ElevationSurfaceError as error:
        raise ElevationSurfaceError(f"{option(output.step)}: {error}") from None
