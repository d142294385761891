# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Formats of horizons that neither GDAL nor VTK reads, or reads wrongly: CPS-3, ZMAP+, EarthVision, Petrel's
points with attributes, and lines in segments as GMT has them."""

import re
import warnings

import numpy

from ..clouds import Cloud, add_array, make_lines, make_points
from .column_names import meaning
from .formats import HEAD, is_tekal
from .layouts import Layout, notes_on_units
from ..messages import FileError, Reason, counted
from ..progress import no_progress, lines_with_progress
from .rasters import raster_cloud

AT_ONCE = 1 << 22  # bytes
BLANK = re.compile(rb"\s")
SEPARATORS = (b">", b"->")
CPS3_HEAD = re.compile(rb"(\s*(FS|!|->)[^\n]*\n)*")
ZMAP_HEAD = re.compile(rb"\s*@[^\n]*\n([^@]*)\n\s*@[^\n]*\n")
MOST_ROUGHNESS = 4  # times that of the numbers in another order
END_OF_LINE = re.compile(rb"\s*999(\.0*)?(\s+999(\.0*)?){2}\s*")


def read_bytes(path):
    with open(path, "rb") as stream:
        return stream.read()


def numbers(text, progress=no_progress):
    """The numbers that a text of bytes begins with."""
    found, begin = [numpy.empty(0)], 0
    while begin < len(text):
        blank = BLANK.search(text, begin + AT_ONCE)
        end = blank.end() if blank else len(text)
        part, begin = text[begin:end], end
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)
            try:
                found.append(numpy.fromstring(part, sep=" ") if part.strip() else numpy.empty(0))
            except (ValueError, DeprecationWarning):  # numpy takes no text that goes on with words
                found.append(numpy.array(list(floats(part.split()))))
                break
        progress(end / len(text))
    return numpy.concatenate(found)


def floats(words):
    """The words as numbers, up to the first that is none."""
    for word in words:
        try:
            yield float(word)
        except ValueError:
            return


def check_count(path, found, count):
    if found != count or not found:
        raise FileError(f"{path}: {count:,} values are announced, {found:,} found")


def grid_cloud(path, x, y, z, note):
    """Nodes of a grid as points. x, y, z: arrays of one shape; NaN is not data."""
    cloud = raster_cloud(path, x, y, z)
    cloud.is_horizon = True
    cloud.notes.append(f"{note}, {z.shape[1]} x {z.shape[0]} nodes")
    return cloud


def roughness(z):
    """How much neighbours in a column of an array differ; 0 where there are too few to say so."""
    steps = numpy.abs(numpy.diff(z, axis=0))
    return float(numpy.nanmean(steps)) if min(z.shape) > 9 and not numpy.isnan(steps).all() else 0.0


def columnwise_cloud(path, x, y, values, is_null, name):
    """A grid whose columns go from west to east, each from north to south, as a Cloud. Its points are in the
    order of y."""
    values = numpy.where(is_null(values), numpy.nan, values)
    as_given, swapped = (roughness(values.reshape(shape)) for shape in ((len(x), len(y)), (len(y), len(x))))
    if as_given > MOST_ROUGHNESS * swapped:
        raise FileError(
            f"{path}: is not a valid {name}: neighbours in a row differ by {as_given:.4g}, and by {swapped:.4g} "
            "if the numbers go row by row; its program mixed up rows and columns: write it in another format, as .asc"
        )
    z = values.reshape(len(x), len(y)).T
    z = z[::-1] if y[0] < y[-1] else z
    return grid_cloud(path, *numpy.meshgrid(x, y), z, f"{name}, columns from north to south")


def read_cps3_grid(path, options):
    """CPS-3 grid."""
    text, words = read_bytes(path), {}
    head = CPS3_HEAD.match(text)
    for line in head.group().splitlines():
        key, *words[key] = line.split() or [b""]
    try:
        x_min, x_max, y_min, y_max = map(float, words[b"FSLIMI"][:4])
        rows, columns = (int(float(word)) for word in words[b"FSNROW"][:2])
        steps = (x_max - x_min) / max(columns - 1, 1), (y_max - y_min) / max(rows - 1, 1)
        dx, dy = map(float, words.get(b"FSXINC", steps)[:2])
    except (KeyError, OverflowError, ValueError):
        raise FileError(f"{path}: is damaged: its FSLIMI, FSNROW or FSXINC is missing") from None
    values = numbers(text[head.end() :], options.progress)
    check_count(path, len(values), max(rows, 0) * columns)
    given = (number for word in words[b"FSASCI"] for number in floats([word]) if number >= 1e20)
    null = 0.999 * min(given, default=1e30)
    x, y = x_min + dx * numpy.arange(columns), y_min + dy * numpy.arange(rows)
    return columnwise_cloud(path, x, y, values, lambda z: z >= null, "CPS-3 grid")


def read_zmap(path, options):
    """ZMAP+ grid. GDAL multiplies whole numbers by a power of ten, and refuses rows that go on behind the end
    of a column."""
    text = read_bytes(path)
    by_gdal = b"Created by GDAL" in text[:HEAD]
    text = re.sub(rb"(?m)^[ \t]*(!|\+[ \t]*[A-Za-z]).*(\n|$)", b"", text)
    head = ZMAP_HEAD.match(text)
    try:
        form, places = ([word.strip() for word in line.split(b",")] for line in head.group(1).splitlines()[:2])
        width, start, null = int(form[0]), int(form[4]), float(form[1] or form[2])
        (rows, columns), end = map(int, places[:2]), head.end()
        x_min, x_max, y_min, y_max = map(float, places[2:6])
    except (AttributeError, IndexError, ValueError):
        raise FileError(f"{path}: is damaged: its header does not give rows, columns and limits") from None
    body = text[end:]
    values = numbers(body, options.progress)
    if len(values) != rows * columns:  # numbers of fixed width may touch
        lines = [line[start - 1 :].rstrip() for line in body.splitlines()]
        fields = (line[i : i + width] for line in lines for i in range(0, len(line), max(width, 1)))
        values = numpy.array(list(floats(fields)))
    check_count(path, len(values), max(rows, 0) * columns)
    x, y = numpy.linspace(x_min, x_max, columns), numpy.linspace(y_max, y_min, rows)
    cloud = columnwise_cloud(path, x, y, values, lambda z: numpy.isclose(z, null, 1e-6, 0.0), "ZMAP+ grid")
    if b"." not in body and form[3].strip(b"0"):
        cloud.notes.append(
            f"none of its numbers has a decimal sign, though the header says {form[3].decode()} decimals: they are read as "
            "they stand"
        )
    if by_gdal:
        cloud.notes.append(
            "x and y of the header are taken for the outermost nodes; gdal_translate writes the "
            "outer edges of pixels there, so the points may be half a step away"
        )
    return cloud


def read_table(path, names, first, progress, null=None):
    """Rows of numbers below line number `first`, in columns of these names, as a Cloud."""
    axes = {}
    for i, name in enumerate(names):
        axes.setdefault(name.lower() if name.lower() in "xyz" else meaning(name).axis, i)
    if not {"x", "y", "z"} <= set(axes):
        raise FileError(f"{path}: its header does not name x, y and z, but {', '.join(names)}")
    number = 0

    def lines(stream):
        nonlocal number
        for number, line in enumerate(lines_with_progress(stream, progress), 1):
            if number > first and line.strip() and not line.startswith((b"#", b"!")):
                yield line

    def load(columns):
        with open(path, "rb") as stream:
            return numpy.loadtxt(lines(stream), comments=None, ndmin=2, usecols=columns)

    places = [axes[axis] for axis in "xyz"]
    others = [i for i in range(len(names)) if i not in places]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # that there is nothing
        try:
            rows = load(places + others)
        except (ValueError, IndexError):
            others = []
            try:
                rows = load(places)
            except (ValueError, IndexError):
                raise FileError(f"{path}, line {number}: is not a row of {', '.join(names)}") from None
    if not rows.size:
        raise FileError(f"{path}: holds no points")
    keep = numpy.isfinite(rows[:, 2]) & (rows[:, 2] != null if null is not None else True)
    cloud = Cloud(make_points(rows[keep, :3]), [f"columns by the header: {', '.join(names)}"])
    cloud.z_name, cloud.is_horizon = names[places[2]], True
    if not keep.all():
        cloud.left_out[Reason("row", "without data")] = int(numpy.count_nonzero(~keep))
    for i, place in enumerate(others, 3):
        add_array(cloud.points, names[place], rows[keep, i])
    return cloud


def read_earthvision(path, options):
    """EarthVision grid or scattered data: each row has its own x and y."""
    names, null, first = [], 1e20, 0
    with open(path, encoding="latin-1") as stream:
        for number, line in enumerate(stream, 1):
            if not line.startswith("#"):
                break
            first = number
            key, _, value = line[1:].partition(":")
            words = value.split()
            if key.strip() == "Field" and len(words) > 1:
                names.append(words[1])
            elif key.strip() == "Null_value" and words:
                null = float(words[0])
    return read_table(path, names or ["x", "y", "z"], first, options.progress, null)


def read_zmap_points(path, options):
    """ZMAP+ points or lines: a line of the header for each column, then rows."""
    columns, marks = [], 0
    with open(path, encoding="latin-1") as stream:
        for number, line in enumerate(stream, 1):
            words = [word.strip() for word in line.split(",")]
            if line.startswith("@"):
                marks += 1
            elif marks == 1 and not line.startswith("!"):
                columns.append(words)
            if marks == 2:
                nulls = list(floats(words[7] for words in columns if len(words) > 7 and words[7]))
                return read_table(path, [words[0] for words in columns], number, options.progress, *nulls[:1])
    raise FileError(f"{path}: is cut off within its header")


def read_petrel_points(path, options):
    """Petrel's points with attributes: names of columns in a header, then rows."""
    names, head, inside = [], [], False
    with open(path, encoding="latin-1") as stream:
        for number, line in enumerate(stream, 1):
            word = line.strip()
            if word.upper() == "END HEADER":
                cloud = read_table(path, names, number, options.progress)
                cloud.notes += notes_on_units(Layout(None), head, None, (0, 1, 2))
                return cloud
            head.append(word)
            if inside and word:
                names.append(word.split(",")[-1])
            inside = inside or word.upper() == "BEGIN HEADER"
    raise FileError(f"{path}: is cut off: its END HEADER is missing")


def without_names(path, lines):
    """The lines of a Tekal file with a mark in place of each block's name and counts, as of lines in segments."""
    left, is_named = 0, False
    for line in lines:
        if left:
            left -= 1
            yield line
        elif is_named:
            left, is_named = int((re.match(rb"\s*(\d+)\s+\d+\s*$", line) or [0, 0])[1]), False
            if not left:
                raise FileError(f"{path}: is damaged: '{line[:40].decode('latin-1').strip()}' does not count the points of a line")
            yield b""
        else:
            is_named = line.strip() != b"" and not line.startswith(b"*")
            yield b">" if is_named else b""


def segments(path, progress):
    """Arrays of (n, 3) points, one for each line of a file of lines; z NaN where there is none."""
    parts, rows, z = [], [], numpy.nan

    def close():
        if rows:
            parts.append(numpy.array(rows, dtype="f8"))
            rows.clear()

    with open(path, "rb") as stream:
        lines = lines_with_progress(stream, progress)
        if is_tekal(stream.read(HEAD), path):
            lines = without_names(path, lines)
        stream.seek(0)
        for number, line in enumerate(lines, 1):
            if line.startswith(SEPARATORS) or END_OF_LINE.fullmatch(line):
                close()
                found = re.search(rb"-Z\s*([-+.\deE]+)", line)
                z = float(found.group(1)) if found else numpy.nan
            elif line.strip() and not line.startswith((b"#", b"FF")):
                try:
                    words = [float(word) for word in line.replace(b",", b" ").split()[:3]]
                    rows.append(words if len(words) == 3 else [words[0], words[1], z])
                except (ValueError, IndexError):
                    raise FileError(f"{path}, line {number}: is not a point of a line") from None
    close()
    if not parts:
        raise FileError(f"{path}: holds no points")
    return parts


def read_segments(path, options):
    """The points of lines in segments."""
    parts = segments(path, options.progress)
    points = numpy.concatenate(parts)
    if numpy.isnan(points[:, 2]).all():
        raise FileError(f"{path}: its lines have no z")
    return Cloud(make_points(points), [f"the points of {counted(len(parts), 'line')}"])


def read_lines(path, singular, progress):
    """Lines in segments as vtkPolyData. Those of a boundary are closed, as GMT closes polygons."""
    parts = segments(path, progress)
    if singular == "a boundary":
        parts = [
            part if (part[0, :2] == part[-1, :2]).all() else numpy.concatenate((part, part[:1]))
            for part in parts
        ]
        if any(len(part) < 4 for part in parts):
            raise FileError(f"{path}: holds a ring of fewer than three points")
    names = [f"line {i} of the file" for i in range(1, len(parts) + 1)]
    for part in parts:
        flat = numpy.isnan(part[:, 2])
        if flat.any() and singular == "a boundary":
            part[:, 2] = numpy.nan
    return make_lines(parts, names)
