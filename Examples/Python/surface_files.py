# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads point clouds, rasters, boundaries and breaklines for reconstruct.py, and writes surfaces.

VTK reads whatever it has a good reader for. Three things it leaves to us:

- text: separator, header, comments and columns are found out here, so that an error can name
  the line;
- .tif: VTK reads the pixels, the georeferencing and the no-data value are read from the file's
  tags here. Tiled and 64-bit files, which VTK 9.1 does not read right, go through GDAL where
  Python has it;
- .dem: vtkDEMReader of VTK 9.1 ignores where a profile starts, fills what is missing with the
  lowest elevation and stops with a division by zero below 100 columns. So the profiles are read
  here.

Every reader returns a Cloud. Every problem is a FileError whose text is one line for the user.
"""

import array
import csv
import math
import os
import re
import struct

import numpy
import surface_checks
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import (
    VTK_STRING,
    vtkIdList,
    vtkLogger,
    vtkOutputWindow,
    vtkPoints,
)
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray,
    vtkImageData,
    vtkPointSet,
    vtkPolyData,
    vtkRectilinearGrid,
)


class FileError(Exception):
    """A file that cannot be used. The text is one line and begins with the file's name."""


class Messages:
    """Collects what VTK reports instead of letting it print.

    Use as a context manager. `errors` and `warnings` are lists of plain lines, without the
    source file, the object's address and the follow-up complaints of VTK's executives.
    """

    def __init__(self):
        self.errors = []
        self.warnings = []

    def __enter__(self):
        window = vtkOutputWindow.GetInstance()
        self._mode = window.GetDisplayMode()
        self._verbosity = vtkLogger.GetCurrentVerbosityCutoff()
        window.SetDisplayModeToNever()
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)

        def note(_caller, event, text):
            self.take(event, text)

        note.CallDataType = VTK_STRING
        self._tags = [window.AddObserver(event, note) for event in ("ErrorEvent", "WarningEvent")]
        return self

    def __exit__(self, *_):
        window = vtkOutputWindow.GetInstance()
        for tag in self._tags:
            window.RemoveObserver(tag)
        window.SetDisplayMode(self._mode)
        vtkLogger.SetStderrVerbosity(self._verbosity)

    def take(self, event, text):
        line = plain_message(text)
        if not line or "returned failure for request" in line:
            return
        lines = self.errors if event == "ErrorEvent" else self.warnings
        if line not in lines:
            lines.append(line)


def plain_message(text):
    """The words of a VTK message: "ERROR: In f.cxx, line 3\\nvtkX (0x1): words" -> "words"."""
    found = re.search(r"\(0x[0-9a-fA-F]+\):\s*(.*)", text or "", re.DOTALL)
    words = found.group(1) if found else (text or "")
    return " ".join(words.split())


class Cloud:
    """The points that were read.

    points   vtkPointSet with point data
    notes    what was found out or assumed, one line each, for the user
    left_out {reason: count} of what the file holds but is no point, as pixels without data
    lines    for text files, the line of each point in the file, else None
    """

    def __init__(self, points, notes=(), left_out=None, lines=None):
        self.points = points
        self.notes = list(notes)
        self.left_out = dict(left_out or {})
        self.lines = lines


# ---- what is there ----------------------------------------------------------------------------

TEXT_SUFFIXES = (".csv", ".xyz", ".txt")
RASTER_SUFFIXES = (".tif", ".tiff", ".dem", ".vti")
VTK_SUFFIXES = (".vtp", ".vtu", ".vts", ".vtr", ".vtk", ".ply", ".stl", ".obj")
READ_SUFFIXES = VTK_SUFFIXES + TEXT_SUFFIXES + RASTER_SUFFIXES
WRITE_SUFFIXES = (".vtp", ".ply", ".stl", ".obj")


def suffix_of(path):
    return os.path.splitext(path)[1].lower()


def check_readable(path):
    """Refuses what cannot be opened, before any reader sees it."""
    if not os.path.exists(path):
        raise FileError(f"{path}: no such file")
    if os.path.isdir(path):
        raise FileError(f"{path}: is a folder, not a file")
    if not os.path.isfile(path):
        raise FileError(f"{path}: is not a file")
    try:
        with open(path, "rb") as stream:
            first = stream.read(1)
    except OSError as error:
        raise FileError(f"{path}: cannot be read: {error.strerror}") from None
    if not first:
        raise FileError(f"{path}: is empty")


def check_suffix(path, suffixes, verb):
    if suffix_of(path) not in suffixes:
        ending = suffix_of(path) or "no suffix"
        raise FileError(f"{path}: {ending} cannot be {verb}; use one of {' '.join(suffixes)}")


def check_columns_wanted(path):
    if suffix_of(path) not in TEXT_SUFFIXES:
        raise FileError(f"{path}: --columns is for text files ({' '.join(TEXT_SUFFIXES)})")


def read_points(path, columns=None, no_data=None):
    """Reads the points of a file, whatever its kind.

    columns  None, or three names or numbers (from 1) of the x, y and z columns of a text file
    no_data  None, or the elevation that marks missing values; such rows and pixels are left out
    Raises FileError. Takes about a second for a million rows of text, less for other kinds.
    """
    if not os.path.isdir(path):
        check_suffix(path, READ_SUFFIXES, "read")
    check_readable(path)
    suffix = suffix_of(path)
    if columns:
        check_columns_wanted(path)
    if suffix in TEXT_SUFFIXES:
        return read_text(path, columns, no_data)
    if suffix in (".tif", ".tiff"):
        return read_tiff(path, no_data)
    if suffix == ".dem":
        return read_dem(path, no_data)
    return read_with_vtk(path, no_data)


def make_points(coordinates):
    """(n, 3) float64 coordinates -> vtkPolyData with points only."""
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(coordinates, dtype="f8"), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    return data


# ---- formats VTK reads ------------------------------------------------------------------------


def vtk_reader(suffix):
    """A fresh VTK reader for the suffix. Imported late: each of these modules takes time."""
    if suffix == ".vtk":
        from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader as reader
    elif suffix == ".ply":
        from vtkmodules.vtkIOPLY import vtkPLYReader as reader
    elif suffix == ".stl":
        from vtkmodules.vtkIOGeometry import vtkSTLReader as reader
    elif suffix == ".obj":
        from vtkmodules.vtkIOGeometry import vtkOBJReader as reader
    else:
        from vtkmodules import vtkIOXML

        reader = {
            ".vtp": vtkIOXML.vtkXMLPolyDataReader,
            ".vtu": vtkIOXML.vtkXMLUnstructuredGridReader,
            ".vts": vtkIOXML.vtkXMLStructuredGridReader,
            ".vtr": vtkIOXML.vtkXMLRectilinearGridReader,
            ".vti": vtkIOXML.vtkXMLImageDataReader,
        }[suffix]
    return reader()


def run_vtk_reader(path):
    """The data object of a file in one of VTK's formats."""
    reason = surface_checks.why_damaged(path)
    if reason:
        raise FileError(f"{path}: {reason}")
    reader = vtk_reader(suffix_of(path))
    with Messages() as messages:
        reader.SetFileName(path)
        reader.Update()
    # What VTK's legacy readers could not read, they leave as it was, with a warning only.
    short = [words for words in messages.warnings if words.startswith("Error reading")]
    if messages.errors or short:
        raise FileError(f"{path}: cannot be read: {(messages.errors + short)[0]}")
    data = reader.GetOutputDataObject(0)
    if data is None or messages.warnings and data.GetNumberOfElements(0) == 0:
        reason = messages.warnings[0] if messages.warnings else "VTK found no data in it"
        raise FileError(f"{path}: cannot be read: {reason}")
    if isinstance(data, vtkPolyData):
        check_point_ids(path, data)
    return data


def check_point_ids(path, data):
    """Refuses cells with corners that are not there: filters trust these numbers."""
    for cells in (data.GetVerts(), data.GetLines(), data.GetPolys(), data.GetStrips()):
        ids = vtk_to_numpy(cells.GetConnectivityArray())
        if len(ids) and not (0 <= ids.min() and ids.max() < data.GetNumberOfPoints()):
            bad = ids.max() if ids.min() >= 0 else ids.min()
            raise FileError(
                f"{path}: is damaged: a cell has the corner {bad}, "
                f"but there are {data.GetNumberOfPoints():,} points"
            )


def read_with_vtk(path, no_data):
    data = run_vtk_reader(path)
    if isinstance(data, (vtkImageData, vtkRectilinearGrid)):
        return points_of_grid(path, data, no_data)
    if not isinstance(data, vtkPointSet):
        raise FileError(f"{path}: holds a {data.GetClassName()}, which has no points")
    if data.GetNumberOfPoints() == 0:
        raise FileError(f"{path}: holds no points")
    cloud = Cloud(data)
    vertices = data.GetNumberOfVerts() if isinstance(data, vtkPolyData) else 0
    if data.GetNumberOfCells() > vertices:
        cloud.notes.append("only the points are used, not the file's cells")
    if suffix_of(path) == ".vtk" and surface_checks.may_lack_digits(path):
        cloud.notes.append("the last line has no end, so the last number may be cut off")
    if suffix_of(path) in (".ply", ".stl", ".obj"):
        note = rounding_note(vtk_to_numpy(data.GetPoints().GetData()))
        if note:
            cloud.notes.append(note)
    if no_data is not None:
        z = vtk_to_numpy(data.GetPoints().GetData())[:, 2]
        keep = numpy.flatnonzero(z != no_data)
        if len(keep) < len(z):
            cloud.left_out["no data"] = len(z) - len(keep)
            cloud.points = some_points(data, keep)
    return cloud


def some_points(data, keep):
    """The points of a data set with the given ids, with their point data, as vtkPolyData."""
    result = make_points(vtk_to_numpy(data.GetPoints().GetData())[keep])
    ids = vtkIdList()
    ids.SetNumberOfIds(len(keep))
    new_ids = vtkIdList()
    new_ids.SetNumberOfIds(len(keep))
    for new, old in enumerate(keep.tolist()):
        ids.SetId(new, old)
        new_ids.SetId(new, new)
    result.GetPointData().CopyAllocate(data.GetPointData(), len(keep))
    result.GetPointData().CopyData(data.GetPointData(), ids, new_ids)
    return result


def rounding_note(coordinates):
    """A line for the user when 32-bit coordinates are coarse beside the spacing, else None."""
    xy = coordinates[:, :2]
    xy = xy[numpy.isfinite(xy).all(axis=1)]
    if len(xy) < 2:
        return None
    step = float(numpy.spacing(numpy.float32(numpy.abs(xy).max())))
    extent = numpy.ptp(xy.astype("f8"), axis=0)
    spacing = math.sqrt(max(extent[0] * extent[1], 0.0) / len(xy))
    if step <= 0.01 * spacing:
        return None
    return (
        f"VTK reads this format in single precision: x and y are rounded to steps of {step:g}; "
        "use .vtp or text for large map coordinates"
    )


def points_of_grid(path, grid, no_data):
    """A flat grid with one elevation for each node -> its nodes as points."""
    scalars = grid.GetPointData().GetScalars()
    if scalars is None:
        for i in range(grid.GetPointData().GetNumberOfArrays()):
            candidate = grid.GetPointData().GetArray(i)
            if candidate is not None and candidate.GetNumberOfComponents() == 1:
                scalars = candidate
                break
    if scalars is None or scalars.GetNumberOfComponents() != 1:
        raise FileError(f"{path}: holds no point array with one elevation for each node")
    columns, rows, layers = grid.GetDimensions()
    if layers != 1:
        raise FileError(f"{path}: is a grid of {layers} layers; one in the x,y plane is needed")
    if isinstance(grid, vtkImageData):
        first = grid.GetPoint(0)
        x = first[0] + grid.GetSpacing()[0] * numpy.arange(columns)
        y = first[1] + grid.GetSpacing()[1] * numpy.arange(rows)
    else:
        x = vtk_to_numpy(grid.GetXCoordinates()).astype("f8")
        y = vtk_to_numpy(grid.GetYCoordinates()).astype("f8")
    z = vtk_to_numpy(scalars).reshape(rows, columns)
    x, y = numpy.meshgrid(x, y)
    cloud = points_of_raster(path, x, y, z, [] if no_data is None else [no_data])
    cloud.notes.insert(0, f"elevation: point array {scalars.GetName() or '(unnamed)'}")
    return cloud


# ---- rasters ----------------------------------------------------------------------------------


def points_of_raster(path, x, y, z, missing):
    """Three (rows, columns) arrays -> the points of the pixels that hold an elevation.

    missing lists the elevations that mark pixels without data; NaN does too.
    """
    z = numpy.asarray(z, dtype="f8")
    valid = numpy.isfinite(z)
    for value in missing:
        valid &= z != value
    count = int(valid.size - numpy.count_nonzero(valid))
    if count == valid.size:
        raise FileError(f"{path}: all {valid.size:,} pixels are without data")
    cloud = Cloud(make_points(numpy.column_stack((x[valid], y[valid], z[valid]))))
    if count:
        cloud.left_out["pixels without data"] = count
    return cloud


class TiffTags:
    """The tags of the first picture of a .tif that say how its pixels become points."""

    FORMATS = {1: "B", 2: "s", 3: "H", 4: "I", 6: "b", 7: "s", 8: "h", 9: "i", 11: "f", 12: "d"}
    SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 6: 1, 7: 1, 8: 2, 9: 4, 10: 8, 11: 4, 12: 8}

    def __init__(self, path):
        with open(path, "rb") as stream:
            head = stream.read(8)
            self.order = {b"II": "<", b"MM": ">"}.get(head[:2])
            magic = struct.unpack(self.order + "H", head[2:4])[0] if self.order else 0
            if magic == 43:
                self.tags = None  # BigTIFF: for GDAL
                return
            if magic != 42 or len(head) < 8:
                raise FileError(f"{path}: is not a TIFF file")
            try:
                self.tags = self.read_tags(stream, struct.unpack(self.order + "I", head[4:])[0])
            except struct.error:
                raise FileError(f"{path}: is cut off within its list of tags") from None

    def read_tags(self, stream, offset):
        stream.seek(offset)
        (count,) = struct.unpack(self.order + "H", stream.read(2))
        entries = stream.read(12 * count)
        tags = {}
        for i in range(count):
            tag, kind, number, value = struct.unpack(
                self.order + "HHI4s", entries[12 * i : 12 * i + 12]
            )
            form = self.FORMATS.get(kind)
            if form is None or number == 0:
                continue
            size = self.SIZES[kind] * number
            if size > 4:
                stream.seek(struct.unpack(self.order + "I", value)[0])
                value = stream.read(size)
            tags[tag] = struct.unpack(f"{self.order}{number}{form}", value[:size])
        return tags

    def one(self, tag, default):
        return self.tags.get(tag, (default,))[0]

    def why_not_vtk(self):
        """Why vtkTIFFReader cannot read the pixels right, or None when it can."""
        if self.tags is None:
            return "is a BigTIFF"
        bits = self.one(258, 1)
        if 322 in self.tags:
            return "is tiled"
        if bits not in (8, 16, 32):
            return f"has {bits} bits for each pixel"
        if bits == 8 and self.one(339, 1) == 2:
            return "has signed 8-bit pixels"
        if self.one(284, 1) != 1 and self.one(277, 1) > 1:
            return "has its bands one after the other"
        if self.one(262, 1) not in (1, 2):
            return "has a colour table or another coding of its pixels"
        if self.one(274, 1) != 1:
            return f"has orientation {self.one(274, 1)}"
        return None

    def no_data(self):
        text = self.one(42113, b"").split(b"\0")[0].decode("ascii", "replace").strip()
        try:
            return float(text)
        except ValueError:
            return None

    def transform(self):
        """(x0, dx/dcolumn, dx/drow, y0, dy/dcolumn, dy/drow) of pixel centres, or None."""
        keys = self.tags.get(34735, ())
        is_point = any(keys[i] == 1025 and keys[i + 3] == 2 for i in range(4, len(keys) - 3, 4))
        half = 0.0 if is_point else 0.5
        if 34264 in self.tags and len(self.tags[34264]) >= 8:
            m = self.tags[34264]
            a, b, x, d, e, y = m[0], m[1], m[3], m[4], m[5], m[7]
        elif 33550 in self.tags and 33922 in self.tags:
            scale, tie = self.tags[33550], self.tags[33922]
            a, b, d, e = scale[0], 0.0, 0.0, -scale[1]
            x, y = tie[3] - tie[0] * a, tie[4] - tie[1] * e
        else:
            return None
        return (x + half * (a + b), a, b, y + half * (d + e), d, e)


def world_file(path):
    """The transform of pixel centres from a world file (.tfw) beside a picture, or None."""
    stem = os.path.splitext(path)[0]
    for name in (stem + ".tfw", stem + ".TFW", path + "w"):
        try:
            with open(name, encoding="ascii") as stream:
                a, d, b, e, x, y = [float(word) for word in stream.read().split()[:6]]
            return (x, a, b, y, d, e)
        except (OSError, ValueError):
            continue
    return None


def read_tiff_with_vtk(path):
    """The pixels as (rows, columns, bands), or None and why VTK cannot read them."""
    from vtkmodules.vtkIOImage import vtkTIFFReader

    reader = vtkTIFFReader()
    with Messages() as messages:
        reader.SetFileName(path)
        reader.Update()
    image = reader.GetOutput()
    scalars = image.GetPointData().GetScalars()
    if messages.errors or scalars is None:
        words = messages.errors[0] if messages.errors else "no pixels found"
        return None, f"is refused by VTK's reader ({words})"
    columns, rows, _ = image.GetDimensions()
    return vtk_to_numpy(scalars).reshape(rows, columns, scalars.GetNumberOfComponents()), None


def read_tiff(path, no_data):
    tags = TiffTags(path)
    notes = []
    reason = tags.why_not_vtk()
    if reason is None:
        pixels, reason = read_tiff_with_vtk(path)
    if reason is None:
        bands = pixels.shape[2]
        z = pixels[:, :, 0]
        transform = tags.transform()
        stored = tags.no_data()
    else:
        z, bands, transform, stored = read_with_gdal(path, reason)
        notes.append(f"read through GDAL, since it {reason}")
    rows, columns = z.shape
    if bands > 1:
        notes.append(f"the file has {bands} bands; the first is taken as elevation")
    if transform is None:
        transform = world_file(path)
        if transform:
            notes.append("georeferencing taken from the world file")
    if transform is None:
        transform = (0.0, 1.0, 0.0, rows - 1.0, 0.0, -1.0)
        notes.append("no georeferencing in the file: x and y are column and row, from bottom left")
    missing = [value for value in (stored, no_data) if value is not None]
    if stored is not None:
        notes.append(f"no-data value {stored:g} from the file")
    elif no_data is None:
        notes.append("no no-data value in the file: all pixels are used (see --no-data)")
    if z.dtype == numpy.float32:
        missing = [float(numpy.float32(value)) for value in missing]
    x0, a, b, y0, d, e = transform
    column, row = numpy.meshgrid(numpy.arange(columns, dtype="f8"), numpy.arange(rows, dtype="f8"))
    x, y = x0 + a * column + b * row, y0 + d * column + e * row
    cloud = points_of_raster(path, x, y, z, missing)
    cloud.notes += notes
    return cloud


def read_with_gdal(path, reason):
    try:
        from osgeo import gdal
    except ImportError:
        raise FileError(
            f"{path}: {reason}; install python3-gdal to read it, or save it as a .tif in strips "
            "with one band of 16 or 32 bits for each pixel"
        ) from None
    gdal.UseExceptions()
    try:
        data = gdal.Open(path)
        band = data.GetRasterBand(1)
        z = band.ReadAsArray()
    except RuntimeError as error:
        raise FileError(f"{path}: cannot be read: {' '.join(str(error).split())}") from None
    transform = data.GetGeoTransform(can_return_null=True)
    if transform:
        x, a, b, y, d, e = transform
        transform = (x + 0.5 * (a + b), a, b, y + 0.5 * (d + e), d, e)
    return z, data.RasterCount, transform, band.GetNoDataValue()


DEM_VOIDS = (-32767, -32766)


def read_dem(path, no_data):
    """A USGS ASCII DEM: profiles from south to north, each with its own start.

    x and y stay in the file's ground units, z is in the file's elevation units.
    """
    with open(path, "rb") as stream:
        text = stream.read().decode("latin-1")
    bad = FileError(f"{path}: is not a USGS ASCII DEM")

    def number(start, width, record=text):
        return float(record[start : start + width].upper().replace("D", "E"))

    try:
        pattern = int(text[150:156])
        plane_unit, elevation_unit = int(text[528:534]), int(text[534:540])
        dx, dy, dz = (number(816 + 12 * i, 12) for i in range(3))
        profiles = int(text[858:864])
    except ValueError:
        raise bad from None
    if pattern != 1 or profiles < 1 or not (dx > 0 and dy > 0 and dz > 0):
        raise bad
    integer = re.compile(r"\s*([-+]?\d{1,6})")
    position = 1024
    parts, voids = [], 0
    # Blanks between elevations may fall away, since each has six places: 12-32767 are two.
    for profile in range(profiles):
        where = f"{path}: profile {profile + 1} of {profiles}"
        head = re.compile(r"\s*(\d+)\s+(\d+)\s+(\d+)\s+(\d+)").match(text, position)
        if not head:
            raise FileError(f"{where}: is missing or damaged")
        position = head.end()
        count = int(head.group(3)) * int(head.group(4))
        try:
            x, y, datum = (number(position + 24 * i, 24) for i in range(3))
        except ValueError:
            raise FileError(f"{where}: its start cannot be read") from None
        position += 120
        values = []
        for _ in range(count):
            found = integer.match(text, position)
            if not found:
                raise FileError(f"{where}: {len(values)} of {count} elevations found")
            values.append(int(found.group(1)))
            position = found.end()
        z = numpy.array(values, dtype="f8")
        valid = ~numpy.isin(z, DEM_VOIDS)
        z = datum + z * dz
        if no_data is not None:
            valid &= z != no_data
        voids += count - int(numpy.count_nonzero(valid))
        ys = y + dy * numpy.arange(count)
        parts.append(numpy.column_stack((numpy.full(count, x), ys, z))[valid])
    points = numpy.concatenate(parts)
    if not len(points):
        raise FileError(f"{path}: holds no elevation, only voids")
    units = {0: "radians", 1: "feet", 2: "metres", 3: "arc-seconds"}
    cloud = Cloud(make_points(points))
    cloud.notes.append(
        f"x,y in {units.get(plane_unit, 'unknown units')}, "
        f"elevation in {units.get(elevation_unit, 'unknown units')}, as in the file"
    )
    if plane_unit in (0, 3) and elevation_unit in (1, 2):
        cloud.notes.append("x,y are angles: project them first to give triangles their true shape")
    if voids:
        cloud.left_out["pixels without data"] = voids
    return cloud


# ---- text -------------------------------------------------------------------------------------

COMMENT_MARKS = ("#", "%", "//", "!", "*")
MISSING = {"", "na", "n/a", "null", "none", "nodata", "-"}
NAMES = {
    "x": {"x", "easting", "east", "e", "lon", "long", "longitude", "xcoord", "utmx", "xutm", "px"},
    "y": {"y", "northing", "north", "n", "lat", "latitude", "ycoord", "utmy", "yutm", "py"},
    "z": {"z", "elevation", "elev", "height", "altitude", "alt", "depth", "twt", "h", "pz"},
}


def plain_name(name):
    """Column names are compared without case, units in brackets and signs: "X (m)" -> "x"."""
    name = re.sub(r"[(\[{].*", "", name.lower())
    return re.sub(r"[^a-z0-9]", "", name)


class Layout:
    """How a line of text becomes words: the separator (None: blanks) and the decimal sign."""

    NAMES = {";": "semicolons", "\t": "tabs", ",": "commas", None: "blanks"}

    def __init__(self, separator, decimal_comma=False):
        self.separator = separator
        self.decimal_comma = decimal_comma

    def __str__(self):
        text = self.NAMES[self.separator]
        return text + ", decimal comma" if self.decimal_comma else text

    def words(self, line):
        if self.separator is None:
            return line.split()
        if '"' in line:
            return [word.strip() for word in next(csv.reader([line], delimiter=self.separator))]
        return [word.strip() for word in line.split(self.separator)]

    def number(self, word):
        """The word's value; NaN where a value is missing; None for text."""
        try:
            return float(word.replace(",", ".") if self.decimal_comma else word)
        except ValueError:
            return math.nan if word.lower() in MISSING else None

    def numbers(self, line):
        """How many words of the line are written as numbers."""
        return sum(
            1 for w in self.words(line) if w.lower() not in MISSING and self.number(w) is not None
        )


LAYOUTS = (
    Layout(";"),
    Layout("\t"),
    Layout(","),
    Layout(None),
    Layout(";", True),
    Layout("\t", True),
    Layout(None, True),
)


def read_lines(path):
    """The lines of a text file; UTF-8, UTF-16 with its mark, or Latin-1."""
    with open(path, "rb") as stream:
        data = stream.read()
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        text = data.decode("utf-16", "replace")
    elif b"\0" in data[:4096]:
        raise FileError(f"{path}: is not a text file")
    else:
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("latin-1")
    return text.splitlines()


def is_comment(line):
    return line.lstrip().startswith(COMMENT_MARKS)


def find_layout(path, lines, needed):
    """The layout under which most of the first lines hold the needed number of numbers."""
    sample = [line for line in lines if line.strip() and not is_comment(line)][:400]
    best, best_score, most = None, 0, 0
    for layout in LAYOUTS:
        counts = [layout.numbers(line) for line in sample]
        score = sum(1 for count in counts if count >= needed)
        most = max(most, max(counts, default=0))
        if score > best_score:
            best, best_score = layout, score
    if best:
        return best
    if not sample:
        raise FileError(f"{path}: holds no data, only blank or comment lines")
    if most == 0:
        raise FileError(f"{path}: holds text, but no numbers")
    raise FileError(
        f"{path}: no line holds {needed} numbers; the most is {most}. "
        f"{'x, y and z' if needed == 3 else 'x and y'} are needed in columns of their own"
    )


def find_columns(path, columns, header, width, needed):
    """Indices of the x, y, z columns, and a note when they were guessed."""
    axes = "xyz"[:needed]
    names = [plain_name(word) for word in header] if header else []
    if columns:
        indices = []
        for axis, column in zip(axes, columns):
            if re.fullmatch(r"\d+", column):
                index = int(column) - 1
                if not 0 <= index < width:
                    raise FileError(
                        f"{path}: there is no column {column} for {axis}; lines have {width}"
                    )
            elif column in (header or []):
                index = header.index(column)
            elif plain_name(column) in names:
                index = names.index(plain_name(column))
            else:
                known = ", ".join(header) if header else "none: the file has no header line"
                raise FileError(f"{path}: there is no column named {column}; names: {known}")
            indices.append(index)
        return indices, None
    found = []
    for axis in axes:
        matches = [i for i, name in enumerate(names) if name in NAMES[axis]]
        found.append(matches[0] if matches else None)
    if None not in found:
        if found == list(range(width)):
            return found, None
        text = ", ".join(f"{axis} = {header[i]}" for axis, i in zip(axes, found))
        return found, f"columns by their names: {text}"
    if width > needed:
        note = f"the first {needed} of {width} columns are taken as {', '.join(axes)}"
        return list(range(needed)), note + " (see --columns)"
    return list(range(needed)), None


def read_table(path, columns=None, needed=3):
    """Rows of numbers of a text file.

    Returns (rows, line numbers, blank-line starts, notes): rows is an array of n * needed doubles,
    a start is the index of a row that follows a blank line.
    """
    lines = read_lines(path)
    layout = find_layout(path, lines, needed)
    preamble, comments, indices, names = [], [], None, None
    values, numbers, starts = array.array("d"), array.array("l"), []
    notes, after_blank, width = [], False, 0
    skipped = 0
    for number, line in enumerate(lines, 1):
        if not line.strip():
            after_blank = True
            continue
        if is_comment(line):
            skipped += 1
            if indices is None:
                comments.append(layout.words(line.lstrip().lstrip("#%/!* ")))
            continue
        if indices is not None and '"' not in line:
            words = line.split(layout.separator)
        else:
            words = layout.words(line)
        if indices is None:
            if layout.numbers(line) < needed:
                preamble.append((number, words))
                continue
            width = len(words)
            headers = [w for _, w in preamble] + comments
            names = next((w for w in reversed(headers) if len(w) == width), None)
            if names is None and layout.separator is None:
                # "x (m)  y (m)": blanks within names; good enough when single letters are left
                for words_of_line in reversed(headers):
                    short = [w for w in words_of_line if plain_name(w)]
                    if len(short) == width:
                        names = short
                        break
            indices, note = find_columns(path, columns, names, width, needed)
            if note:
                notes.append(note)
            check_preamble(path, layout, preamble, indices, width)
        try:
            row = [float(words[i]) for i in indices]
        except (ValueError, IndexError):
            row = careful_row(f"{path}, line {number}", layout, words, indices)
        if after_blank or not numbers:
            starts.append(len(numbers))
            after_blank = False
        values.extend(row)
        numbers.append(number)
    heads = len(preamble)
    seen = [f"separated by {layout}"]
    if heads:
        seen.append(f"{heads} header line{'s' * (heads > 1)}")
    if skipped:
        seen.append(f"{skipped} comment line{'s' * (skipped > 1)}")
    notes.insert(0, "text: " + ", ".join(seen))
    rows = numpy.frombuffer(values, dtype="f8").reshape(-1, needed)
    return rows, numbers, starts, notes


def careful_row(where, layout, words, indices):
    """A row that is not plain numbers: decimal commas, missing values, or an error."""
    row = []
    for axis, index in zip("xyz", indices):
        if index >= len(words):
            raise FileError(
                f"{where}: {len(words)} column{'s' * (len(words) != 1)} found, "
                f"but {axis} is column {index + 1}"
            )
        word = words[index].strip()
        value = layout.number(word)
        if value is None:
            raise FileError(
                f"{where}: '{word[:40]}' in column {index + 1} ({axis}) is not a number; "
                "--columns chooses other columns"
            )
        row.append(value)
    return row


def check_preamble(path, layout, preamble, indices, width):
    """A line before the data that looks like data but for one word is an error, not a header."""
    for number, words in preamble:
        values = [layout.number(word) for word in words]
        if len(words) >= 2 and len(words) < width and None not in values:
            raise FileError(
                f"{path}, line {number}: {len(words)} columns found where other lines have {width} "
                "(mark it with # if it is no row of data)"
            )
        if len(words) != width:
            continue
        values = [values[i] for i in indices]
        good = sum(v is not None and not math.isnan(v) for v in values)
        if None in values and good >= len(values) - 1:
            axis = values.index(None)
            column = indices[axis]
            raise FileError(
                f"{path}, line {number}: '{words[column][:40]}' in column {column + 1} "
                f"({'xyz'[axis]}) is not a number; --columns chooses other columns"
            )


def read_text(path, columns, no_data):
    rows, lines, _, notes = read_table(path, columns)
    cloud = Cloud(None, notes, lines=lines)
    if no_data is not None:
        keep = rows[:, 2] != no_data
        if not keep.all():
            cloud.left_out["rows without data"] = int(len(keep) - numpy.count_nonzero(keep))
            cloud.lines = array.array("l", numpy.asarray(lines)[keep].tolist())
            rows = rows[keep]
        if not len(rows):
            raise FileError(f"{path}: all rows are without data")
    cloud.points = make_points(rows)
    return cloud


# ---- boundary and breaklines ------------------------------------------------------------------

LINE_SUFFIXES = (".vtp", ".vtk", ".ply", ".stl", ".obj") + TEXT_SUFFIXES


def read_lines_with_vtk(path, singular):
    """The vtkPolyData of a file in one of VTK's formats, which must hold lines or polygons."""
    data = run_vtk_reader(path)
    if not isinstance(data, vtkPolyData):
        raise FileError(f"{path}: holds a {data.GetClassName()}; {singular} is vtkPolyData")
    if data.GetNumberOfLines() + data.GetNumberOfPolys() == 0:
        raise FileError(f"{path}: holds no line and no polygon that could be {singular}")
    return data


def read_breaklines(path):
    """The breaklines of a file as vtkPolyData with lines or polygons.

    A text file holds one line after the other, x, y and z in the first columns, a blank line
    between them. Raises FileError.
    """
    check_suffix(path, LINE_SUFFIXES, "read as breaklines")
    check_readable(path)
    if suffix_of(path) not in TEXT_SUFFIXES:
        return read_lines_with_vtk(path, "a breakline")
    rows, lines, starts, _ = read_table(path, needed=3)
    bad = numpy.flatnonzero(~numpy.isfinite(rows).all(axis=1))
    if len(bad):
        raise FileError(f"{path}, line {lines[bad[0]]}: a breakline point is not finite")
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


# ---- writing ----------------------------------------------------------------------------------


def check_writable(path):
    """Refuses early what could not be written at the end."""
    folder = os.path.dirname(os.path.abspath(path))
    if os.path.isdir(path):
        raise FileError(f"{path}: is a folder, so it cannot be written as a file")
    if not os.path.isdir(folder):
        raise FileError(f"{path}: cannot be written: there is no folder {folder}")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise FileError(f"{path}: cannot be written: no permission in folder {folder}")


def write_surface(data, path, suffix):
    """Writes vtkPolyData in the format of the suffix. Returns notes for the user."""
    from vtkmodules.vtkIOGeometry import vtkOBJWriter, vtkSTLWriter
    from vtkmodules.vtkIOPLY import vtkPLYWriter
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    notes = []
    coordinates = vtk_to_numpy(data.GetPoints().GetData())
    coarse = rounding_note(coordinates) is not None
    if suffix == ".vtp":
        writer = vtkXMLPolyDataWriter()
        # Not appended: ParaView 5.11 cannot read appended data with a newer libexpat. In memory first:
        # the writer crashes on a full disk.
        writer.SetDataModeToBinary()
        writer.WriteToOutputStringOn()
    elif suffix == ".ply":
        writer = vtkPLYWriter()
        if coarse:
            # The format's usual floats have 24 bits. A whole-number shift keeps the shape.
            origin = numpy.floor(numpy.nanmin(coordinates, axis=0))
            origin[2] = 0.0
            shifted = vtkPolyData()
            shifted.ShallowCopy(data)
            points = make_points(coordinates - origin).GetPoints()
            shifted.SetPoints(points)
            data = shifted
            text = f"{origin[0]:.0f} {origin[1]:.0f}"
            writer.AddComment(f"add to x y: {text}")
            notes.append(
                f".ply holds single precision: x,y are written less {text}, see its header"
            )
    elif suffix == ".stl":
        writer = vtkSTLWriter()
        # ASCII keeps every digit; binary STL has 24 bits.
        if coarse:
            writer.SetFileTypeToASCII()
            notes.append(".stl is written as text to keep large coordinates exact")
        else:
            writer.SetFileTypeToBinary()
    else:
        writer = vtkOBJWriter()
    with Messages() as messages:
        writer.SetFileName(path)
        writer.SetInputData(data)
        done = writer.Write()
    if suffix == ".vtp" and done and not messages.errors:
        with open(path, "w", encoding="ascii", newline="") as stream:
            stream.write(writer.GetOutputString())
    if messages.errors or not done:
        raise FileError(messages.errors[0] if messages.errors else "VTK's writer gave no reason")
    if not is_whole(path, suffix, data):
        raise FileError("the file is cut off; is the disk full?")
    return notes


def is_whole(path, suffix, data):
    """Whether all of the surface is in the file. VTK's writers do not notice a full disk."""
    try:
        size = os.path.getsize(path)
        with open(path, "rb") as stream:
            if suffix == ".obj":
                lines = stream.read().split(b"\n")
                kinds = [line[:2] for line in lines]
                return (
                    lines[-1] == b""
                    and kinds.count(b"v ") == data.GetNumberOfPoints()
                    and kinds.count(b"f ") == data.GetNumberOfPolys()
                )
            head = stream.read(2000)
            stream.seek(max(0, size - 100))
            tail = stream.read().rstrip()
    except OSError:
        return False
    if suffix == ".vtp":
        return tail.endswith(b"</VTKFile>")
    if suffix == ".ply":
        start = head.find(b"end_header\n")
        body = 12 * data.GetNumberOfPoints() + 13 * data.GetNumberOfPolys()
        return start > 0 and size == start + len(b"end_header\n") + body
    if head.startswith(b"solid") and tail.endswith(b"endsolid"):
        return True
    return size == 84 + 50 * data.GetNumberOfPolys()
