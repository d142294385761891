# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pixels of rasters as points.

- .tif: VTK reads the pixels, the georeferencing and the no-data value are read from the file's
  tags here. Tiled and 64-bit files, which VTK 9.1 does not read right, go through GDAL where
  Python has it;
- .dem: vtkDEMReader of VTK 9.1 ignores where a profile starts, fills what is missing with the
  lowest elevation and stops with a division by zero below 100 columns. So the profiles are read
  here.
"""

import os
import re
import struct

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from .clouds import Cloud, make_points
from .messages import FileError, Messages

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


def read_tiff(path, options):
    no_data = options.no_data
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


def read_dem(path, options):
    """A USGS ASCII DEM: profiles from south to north, each with its own start.

    x and y stay in the file's ground units, z is in the file's elevation units.
    """
    with open(path, "rb") as stream:
        text = stream.read().decode("latin-1")
    no_data = options.no_data
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
