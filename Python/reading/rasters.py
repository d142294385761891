# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pixels of rasters as points. GDAL reads the files, whatever their format."""

import os

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray

from ..clouds import Cloud, Frame, ReadOptions, node_frame, grid_of, make_points, pixels_of
from .column_names import z_direction
from .formats import HEAD, is_saga_header, count_numbers
from ..gdal_common import GDAL_ERRORS, choose_layer, gdal_module, kind_of, one_line, quiet
from ..messages import FileError, Reason
from ..names import option
from ..paths import suffix_of
from ..progress import share, lines_with_progress

# Text of decimals would else become single precision, plain axes x and y be overlooked.
OPEN_OPTIONS = {
    "AAIGrid": ["DATATYPE=Float64"],
    "GRASSASCIIGrid": ["DATATYPE=Float64"],
    "netCDF": ["IGNORE_XY_AXIS_NAME_CHECKS=YES"],
}
# GDAL takes words for 0 in these, and does not count their numbers.
TEXT_KINDS = ("AAIGrid", "GRASSASCIIGrid", "GSAG")
IN_NUMBERS = b" \t\r\n+-.,*0123456789eEdDnNaAiIfF#"
HINTS = {
    ".flt": "; is its .hdr next to it?",
    ".bil": "; is its .hdr next to it?",
    ".hgt": "; its name must give its place, as N45E006.hgt, and its size must be that of a whole file",
}
# Pixels that are read at once.
AT_ONCE = 1 << 20
WORK_ON_WORDS = 0.5  # of the work: the words of text are looked at first


def saga_data(path):
    """The .sdat next to the header of a SAGA grid; other files as they are."""
    with open(path, "rb") as stream:
        if not is_saga_header(stream.read(HEAD), path):
            return path
    data = os.path.splitext(path)[0] + ".sdat"
    if not os.path.exists(data):
        raise FileError(f"{path}: is the header of a SAGA grid; {data} is missing")
    return data


def open_raster(path, options):
    """(dataset, notes). Of several variables the one that options name, or one of elevations."""
    gdal = gdal_module()
    path = saga_data(path)
    kind = kind_of(path, "raster")
    if kind is None:
        hint = HINTS.get(suffix_of(path), "")
        raise FileError(f"{path}: GDAL knows no raster format that this could be{hint}")
    try:
        flags = gdal.OF_RASTER | gdal.OF_VERBOSE_ERROR
        settings = OPEN_OPTIONS.get(kind, [])
        data, notes = gdal.OpenEx(path, flags, [kind], settings), []
        if data.GetMetadataItem("HAS_SUPERGRIDS") == "TRUE":  # by default GDAL gives its overview alone
            metadata = data.GetMetadata()
            least, most = (float(metadata.get(f"{end}_RESOLUTION_X", "nan")) for end in ("MIN", "MAX"))
            notes = [f"the resolution varies from {least:g} to {most:g}: the nodes of all refined cells are read"]
            data = gdal.OpenEx(path, flags, [kind], settings + ["MODE=RESAMPLED_GRID"])
        variables = {name.rsplit(":", 1)[-1].strip('"/'): name for name, _ in data.GetSubDatasets()}
        if data.RasterCount and not (options.layer and variables):
            if options.layer:
                raise FileError(f"{path}: has no layers, so {option('layer')} {options.layer} means nothing")
            return data, notes
        name = choose_layer(path, options.layer, list(variables), "variables")
        notes = [f"elevation: variable {name} (of {', '.join(variables)})"]
        data = gdal.OpenEx(variables[name], flags, [], settings)
        return data, notes if len(variables) > 1 else []
    except FileError:
        raise
    except GDAL_ERRORS as error:
        raise FileError(f"{path}: cannot be read: {one_line(error)}") from None


def grid_lines(kind, stream):
    """Yields (number, line) of a grid of text, without its header."""
    begun = False
    for number, line in enumerate(stream, 1):
        begun = begun or (number > 5 if kind == "GSAG" else bool(line.strip() and count_numbers(line[:100].split()[0])))
        if begun:
            yield number, line


def check_words(path, kind, nodes, progress):
    """Refuses text that is not a number, and more or fewer numbers than nodes. Returns notes."""
    count, line = 0, b"\n"
    with open(path, "rb") as stream:
        for number, line in grid_lines(kind, lines_with_progress(stream, progress)):
            if line.translate(None, IN_NUMBERS):
                raise FileError(f"{path}, band 1, line {number}: holds a word that is not a number")
            count += len(line.split())
    if count != nodes:
        raise FileError(f"{path}, band 1: {nodes:,} numbers are announced, {count:,} found")
    if not line.endswith(b"\n"):
        return ["the last line has no end, so the last number may be cut off"]
    return []


def choose_band(path, data, options, notes):
    count = data.RasterCount
    number = options.band or 1
    if number > count:
        raise FileError(f"{path}: there is no band {number}; it has {count}")
    if count > 1 and not options.band:
        notes.append(f"the file has {count} bands; the first is taken as elevation (see {option('band')})")
    return data.GetRasterBand(number)


def uneven_axes(path, band):
    """x of the columns and y of the rows of a netCDF variable whose steps differ, else None.

    GDAL takes the last row first where it finds no steps.
    """
    gdal = gdal_module()
    try:
        group = gdal.OpenEx(path, gdal.OF_MULTIDIM_RASTER).GetRootGroup()
        dimensions = group.OpenMDArray(band.GetMetadataItem("NETCDF_VARNAME")).GetDimensions()
        y, x = (d.GetIndexingVariable().ReadAsArray().astype("f8") for d in dimensions[-2:])
    except (AttributeError, TypeError, ValueError, RuntimeError):
        return None
    return x, y[::-1]


def placement(path, data, band, notes):
    """(a function that gives x and y of the pixel centres in a row, the Frame or None)."""
    found, size = data.GetGeoTransform(can_return_null=True), (data.RasterXSize, data.RasterYSize)
    axes = None if found else uneven_axes(path, band)
    if axes:
        notes.append("the steps of x and y differ")
        return lambda row: (axes[0], numpy.full(size[0], axes[1][row])), None
    if not found:
        why = "no georeferencing in the file"
        if data.GetGCPCount():
            why = "placed by ground control points only, which are not applied (see gdalwarp)"
        notes.append(f"{why}: x and y are column and row, from bottom left")
        found = (-0.5, 1.0, 0.0, size[1] - 0.5, 0.0, -1.0)
    frame = Frame(tuple(found), *size)
    return frame.row, frame


def dem_note(path):
    """GDAL moves profiles of a USGS DEM to whole steps of y."""
    with open(path, "rb") as stream:
        head = stream.read(1200).decode("latin-1").replace("D", "E")
    try:
        step, start, is_utm = float(head[828:840]), float(head[1072:1096]), int(head[156:162]) == 1
    except ValueError:
        return []
    away = start % step if is_utm and step > 0 else 0.0
    if away == 0.0:
        return []
    return [f"GDAL moves y to whole steps of {step:g}, by up to {min(away, step - away):g}"]


def alpha_band(data, band):
    """The band of opacity that belongs to a band of elevations, or None."""
    bands = [data.GetRasterBand(i) for i in range(1, data.RasterCount + 1)]
    alpha = gdal_module().GCI_AlphaBand
    others = [other for other in bands if other.GetBand() != band.GetBand()]
    return next((other for other in others if other.GetColorInterpretation() == alpha), None)


def raster_notes(path, data, band, options):
    """What the user must know of how the pixels are taken."""
    gdal = gdal_module()
    kind = data.GetDriver().ShortName
    notes = [f"raster: {data.GetDriver().LongName}, {data.RasterXSize} x {data.RasterYSize} pixels"]
    scale, offset = band.GetScale(), band.GetOffset()
    if (scale or 1.0) != 1.0 or offset:
        notes.append(f"elevation = pixel * {scale or 1.0:g} + {offset or 0.0:g}, as the file says")
    if alpha_band(data, band):
        notes.append("pixels whose alpha is 0 are without data")
    if band.GetNoDataValue() is not None:
        notes.append(f"no-data value {band.GetNoDataValue():g} from the file")
    elif band.GetMaskFlags() & ~gdal.GMF_ALL_VALID:
        notes.append("pixels without data from the file's mask")
    elif options.no_data is None and not alpha_band(data, band):
        notes.append(f"no no-data value in the file: all pixels are used (see {option('no_data')})")
    colour = band.GetColorInterpretation()
    if colour not in (gdal.GCI_Undefined, gdal.GCI_GrayIndex):
        name = gdal.GetColorInterpretationName(colour).lower()
        notes.append(f"the pixels are colours ({name}), taken as elevation all the same")
    if band.GetUnitType():
        notes.append(f"elevation in {band.GetUnitType()}, as the file says")
    if kind in TEXT_KINDS:
        notes += check_words(
            path, kind, data.RasterXSize * data.RasterYSize, share(options.progress, 0.0, WORK_ON_WORDS)
        )
    return notes + (dem_note(path) if kind == "USGSDEM" else [])


def read_points(path, options):
    """The centres of the pixels that hold an elevation, row by row.

    Takes 24 bytes for each point, 3 for each pixel, and about 100 MB.
    """
    with quiet():
        data, notes = open_raster(path, options)
        band = choose_band(path, data, options, notes)
        notes += raster_notes(path, data, band, options)
        place, frame = placement(path, data, band, notes)
        begun = WORK_ON_WORDS if data.GetDriver().ShortName in TEXT_KINDS else 0.0
        progress = share(options.progress, begun, 1.0)
        points, count = numpy.empty((data.RasterYSize * data.RasterXSize, 3)), 0
        mask = numpy.empty((data.RasterYSize, data.RasterXSize), dtype=bool)
        column = numpy.empty((data.RasterYSize, 2))
        for first, z, valid in blocks(path, data, band, options.no_data):
            for row, (values, keep) in enumerate(zip(z, valid), first):
                here = points[count : count + int(numpy.count_nonzero(keep))]
                x, y = place(row)
                here[:, 0], here[:, 1] = x[keep], y[keep]
                here[:, 2] = values[keep]
                count += len(here)
                mask[row], column[row] = keep, (x[0], y[0])
            progress((first + len(z)) / len(points) * data.RasterXSize)
        reference = data.GetSpatialRef()
        grid = grid_of([pixels_of(mask, numpy.column_stack(place(0)), column)])
    if count == 0:
        raise FileError(f"{path}: all {len(points):,} pixels are without data")
    lost = len(points) - count
    points = points[:count]
    cloud = Cloud(make_points(points, copy=False), notes)
    cloud.z_name = z_name_in(band)
    if lost:
        cloud.left_out[Reason("pixel", "without data")] = lost
    cloud.crs = reference.ExportToWkt() if reference else None
    cloud.grid, cloud.frame, cloud.angles = grid, frame, "are angles" if is_in_degrees(data) else ""
    return cloud


def raster_frame(path):
    """(the Frame of a raster or None, its coordinate reference system or None)."""
    with quiet():
        options = ReadOptions()
        data, _ = open_raster(path, options)
        _, frame = placement(path, data, choose_band(path, data, options, []), [])
        reference = data.GetSpatialRef()
        return frame, reference.ExportToWkt() if reference else None


def is_in_degrees(data):
    """Whether the axes of netCDF have degrees as their unit."""
    units = [words for name, words in data.GetMetadata().items() if name.endswith("#units")]
    return sum(words.lower().startswith("degree") for words in units) > 1


def z_name_in(band):
    """The name of a band's values, with their unit."""
    metadata = band.GetMetadata()
    names = [metadata.get(key, "") for key in ("NETCDF_VARNAME", "standard_name", "long_name")]
    names = [f"{name} ({band.GetUnitType()})" for name in [*names, band.GetDescription()] if name]
    if metadata.get("positive", "").lower() == "down":
        names.insert(0, "depth")
    return next((name for name in names if z_direction(name)), "")


def blocks(path, data, band, no_data):
    """Yields (first row, elevations, where they are valid) for some rows after the other."""
    gdal = gdal_module()
    scale, offset = band.GetScale() or 1.0, band.GetOffset() or 0.0
    deep = band.GetBlockSize()[1]
    step = max(deep, AT_ONCE // band.XSize // deep * deep)
    alpha = alpha_band(data, band)
    all_valid = band.GetMaskFlags() & gdal.GMF_ALL_VALID
    for first in range(0, band.YSize, step):
        window = (0, first, band.XSize, min(step, band.YSize - first))
        try:
            pixels = band.ReadAsArray(*window)
            mask = None if all_valid else band.GetMaskBand().ReadAsArray(*window)
            opaque = alpha.ReadAsArray(*window) if alpha else None
        except GDAL_ERRORS as error:
            where = f"{path}, band {band.GetBand()}, rows from {first + 1}"
            raise FileError(f"{where}: cannot be read: {one_line(error)}") from None
        if numpy.iscomplexobj(pixels):
            raise FileError(f"{path}, band {band.GetBand()}: holds complex numbers, no elevations")
        z = pixels.astype("f8")
        if (scale, offset) != (1.0, 0.0):
            z = z * scale + offset
        elif no_data is not None and pixels.dtype == numpy.float32:
            no_data = float(numpy.float32(no_data))
        valid = numpy.isfinite(z)
        if mask is not None:
            valid &= mask != 0
        if opaque is not None:
            valid &= opaque != 0
        if no_data is not None:
            valid &= z != no_data
        yield first, z, valid


def raster_cloud(path, x, y, z, ids=None):
    """Three (rows, columns) arrays -> Cloud of the nodes that hold an elevation.

    ids  (rows, columns) global ids where ranks have rectangles of the raster each; -1 for nodes that are
         another one's
    """
    valid = numpy.isfinite(z)
    row, column = (numpy.column_stack(ends) for ends in ((x[0], y[0]), (x[:, 0], y[:, 0])))
    pixels = pixels_of(valid, row, column)
    if ids is None and not valid.any():
        raise FileError(f"{path}: all {valid.size:,} pixels are without data")
    is_own = numpy.ones(valid.shape, dtype=bool) if ids is None else ids >= 0
    lost = int(numpy.count_nonzero(is_own & ~valid))
    valid &= is_own
    cloud = Cloud(make_points(numpy.column_stack((x[valid], y[valid], z[valid]))))
    if lost:
        cloud.left_out[Reason("pixel", "without data")] = lost
    if ids is not None:
        array = numpy_to_vtkIdTypeArray(ids[valid], deep=True)
        array.SetName("GlobalNodeIds")
        cloud.points.GetPointData().SetGlobalIds(array)
    cloud.pixels, cloud.grid = pixels, grid_of([pixels])
    cloud.frame = node_frame(x, y) if ids is None else None
    return cloud
