# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points as they come from a reader, and arrays of points and triangles."""

import dataclasses
import math

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkBitArray, vtkDataArray, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSetAttributes, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData

from .messages import ElevationSurfaceError, counted
from .names import argument, option
from .progress import no_progress
from .ranks import extremes, finite_extremes
from .selecting import Words, conditions_of, joined_words

RECOGNISED = "Recognised"  # the field array in which readers report what a file is, and how it was read
AT_ONCE = 2_000_000  # rows worked on at a time: what bounds the memory taken


class Cloud:
    """The points that were read.

    points   vtkPointSet with point data
    notes    what was found out or assumed, one line each, for the user
    left_out {reason: count} of what is not taken as a point, such as pixels without data
    lines    for text files, the line of each point in the file, an array or a range; else None
    crs      the coordinate reference system as WKT or AUTHORITY:CODE, or None where it is not known
    largest_cell  of points from a grid of unequal steps: the diagonal of its largest cell, else 0
    z_name   what z is called where it is from, with its unit, or ""
    is_horizon  whether it is of a kind of file or table in which horizons are
    angles   "" or that x and y are degrees by their names or units, as "are angles"; "no" where they are not
    words    {name: Words} of columns of text
    files    of merged files, Words with the file of each point, else None
    grid     the PixelGrid of points from a raster, or None
    frame    the Frame of that raster, where its steps are even, or None
    plane    the Plane that its points have been turned out of, or None
    pixels   pixels_of() its pixels, where ranks may have others of the same raster
    """

    def __init__(self, points, notes=(), left_out=None, lines=None, crs=None):
        self.points = points
        self.notes = list(notes)
        self.left_out = dict(left_out or {})
        self.lines = lines
        self.crs = crs
        self.largest_cell = 0.0
        self.z_name, self.is_horizon, self.angles = "", False, ""
        self.words, self.files = {}, None
        self.grid = self.pixels = self.frame = self.plane = None

    def copy(self):
        """One that can be changed; the points themselves are shared, as nothing changes them."""
        copied = Cloud(self.points, self.notes, self.left_out, self.lines, self.crs)
        copied.grid, copied.frame, copied.plane = self.grid, self.frame, self.plane
        copied.largest_cell, copied.files = self.largest_cell, self.files
        copied.z_name, copied.is_horizon, copied.angles = self.z_name, self.is_horizon, self.angles
        copied.words = dict(self.words)
        return copied


@dataclasses.dataclass
class PixelGrid:
    """Where the pixels of a raster are."""

    origin: object  # x and y of one; None where steps differ
    steps: tuple  # x and y of one step, then of another; the largest where they differ

    def continues(self, other):
        """Whether the pixels of both rasters are on one grid."""
        if self.origin is None or other.origin is None:
            return False
        steps = numpy.reshape(other.steps, (2, 2))
        between = numpy.linalg.solve(steps.T, numpy.subtract(self.origin, other.origin))
        return bool(
            numpy.allclose(self.steps, other.steps, atol=1e-6 * abs(steps).max())
            and (abs(between - numpy.round(between)) < 0.01).all()
        )


EVEN = 1e-3  # of a step: how far nodes may lie from places of even steps


@dataclasses.dataclass(frozen=True)
class Frame:
    """The pixels of a raster, each with its place.

    transform  GDAL's six numbers: x of the first corner, the steps of x by column and by row; then y
    """

    transform: tuple
    columns: int
    rows: int

    def first(self):
        """x and y of the first centre."""
        x, a, b, y, d, e = self.transform
        return x + 0.5 * (a + b), y + 0.5 * (d + e)

    def is_turned(self):
        return self.transform[2] != 0.0 or self.transform[4] != 0.0

    def row(self, number):
        """x and y of the centres of a row."""
        (x, y), (_, a, b, _, d, e) = self.first(), self.transform
        column = numpy.arange(self.columns, dtype="f8")
        return x + a * column + b * number, y + d * column + e * number

    def centres(self):
        """x, (columns,), and y, (rows,), of the centres; of a turned raster (rows, columns) each."""
        column, row = numpy.arange(self.columns, dtype="f8"), numpy.arange(self.rows, dtype="f8")
        if self.is_turned():
            return self.at(*numpy.meshgrid(column, row))
        return self.at(column, 0.0)[0], self.at(0.0, row)[1]

    def at(self, column, row):
        """x and y of places, of which columns and rows are given."""
        (x, y), (_, a, b, _, d, e) = self.first(), self.transform
        return x + a * column + b * row, y + d * column + e * row

    def places(self, xy):
        """(n, 2) columns and rows of places; those of centres are whole numbers."""
        _, a, b, _, d, e = self.transform
        x, y = (xy - self.first()).T
        return numpy.column_stack((e * x - b * y, a * y - d * x)) / (a * e - b * d)

    def part(self, low, high):
        """The Frame of the same steps whose pixels go from (column, row) low to before high."""
        x, a, b, y, d, e = self.transform
        (i, j), (columns, rows) = low, numpy.subtract(high, low)
        corner = (x + a * i + b * j, a, b, y + d * i + e * j, d, e)
        return Frame(tuple(map(float, corner)), int(columns), int(rows))

    def is_same(self, other):
        """Whether the pixels of both are the same, but for rounding."""
        if other is None or (self.columns, self.rows) != (other.columns, other.rows):
            return False
        ends = [(-0.5, -0.5), (self.columns, -0.5), (-0.5, self.rows)]
        corners = [other.part(end, end).first() for end in ends]
        return bool(numpy.allclose(self.places(numpy.array(corners)), ends, rtol=0, atol=EVEN))


def node_frame(x, y):
    """The Frame of a raster with these nodes, (rows, columns) each; None where steps are not even."""
    if min(x.shape) < 2:
        return None
    if y[0, 0] < y[-1, 0]:  # rows go from north to south
        x, y = x[::-1], y[::-1]
    rows, columns = x.shape
    a, d = ((v[0, -1] - v[0, 0]) / (columns - 1) for v in (x, y))
    b, e = ((v[-1, 0] - v[0, 0]) / (rows - 1) for v in (x, y))
    if a * e == b * d:
        return None
    corner = x[0, 0] - 0.5 * (a + b), y[0, 0] - 0.5 * (d + e)
    frame = Frame(tuple(map(float, (corner[0], a, b, corner[1], d, e))), columns, rows)
    across, down = frame.centres() if frame.is_turned() else numpy.meshgrid(*frame.centres())
    away = max(abs(across - x).max(), abs(down - y).max())
    return frame if away <= EVEN * min(math.hypot(a, d), math.hypot(b, e)) else None


def common_frame(frames):
    """The Frame of rasters side by side, on whose pixels they all are; None where one has none."""
    if not all(frames):
        return None
    ends = [one.part(at, at).first() for one in frames for at in ((0, 0), (one.columns - 1, one.rows - 1))]
    ends = numpy.rint(frames[0].places(numpy.array(ends)))
    return frames[0].part(ends.min(axis=0), ends.max(axis=0) + 1)


def pixels_of(valid, row, column):
    """What grid_of() needs to know about the pixels of a raster, or of a rectangle of them, as plain values:
    [triangles of half a cell, pixels, x and y of one, [longest step, its length, shortest length] along
    a row, the same along a column, or None].

    valid        (rows, columns) of bool
    row, column  (n, 2) x and y of the pixels of the first row and column
    """
    by_row = valid[1:].astype("u1") + valid[:-1]
    corners = by_row[:, 1:] + by_row[:, :-1]
    halves = 2 * int((corners == 4).sum()) + int((corners == 3).sum())
    lines = []
    for line in (row, column):
        away = numpy.diff(line, axis=0)
        lengths = numpy.hypot(*away.T)
        longest = away[lengths.argmax()].tolist() if len(away) else None
        lines.append(longest and [longest, float(lengths.max()), float(lengths.min())])
    return [halves, int(valid.sum()), [float(one) for one in row[0]], *lines]


def grid_of(parts):
    """The PixelGrid of a raster, of pixels_of() its parts; None where most pixels lack neighbours, as of a
    thinned one."""
    parts = [part for part in parts if part]
    # Of about two triangles a pixel, those of half a cell are at least half.
    if not parts or sum(part[0] for part in parts) < sum(part[1] for part in parts):
        return None
    steps, even = [], True
    for lines in ([part[axis] for part in parts if part[axis]] for axis in (3, 4)):
        if not lines:
            return None
        step, longest, _ = max(lines, key=lambda line: line[1])
        steps += step
        even = even and longest - min(line[2] for line in lines) <= 1e-6 * longest
    return PixelGrid(tuple(parts[0][2]) if even else None, tuple(steps))


def three_columns(columns):
    """Three names or numbers from 1, of text with commas between or of a list. Raises ValueError."""
    columns = columns.split(",") if isinstance(columns, str) else columns
    columns = [str(column).strip() for column in columns]
    if len(columns) != 3 or not all(columns):
        raise ValueError(f"{argument('columns')} takes three names, or numbers from 1, of x, y and z")
    return columns


def class_numbers(classes):
    """Numbers from 0 to 255, of text with commas between or of a list. Raises ValueError."""
    classes = classes.split(",") if isinstance(classes, str) else classes
    try:
        classes = [int(number) for number in classes]
    except ValueError:
        classes = [-1]
    if not all(0 <= number <= 255 for number in classes):
        raise ValueError(f"{argument('classes')} takes numbers from 0 to 255, as 2,8")
    return classes


@dataclasses.dataclass
class ReadOptions:
    """How a file is to be read; see --help."""

    columns: object = None  # None, or three names or numbers (from 1) of the x, y and z columns
    no_data: object = None  # None, or the elevation that marks missing values
    skip_bad_lines: bool = False  # lines of a text that are not rows are left out
    keep_nulls: bool = False  # usual null values are kept, though they stand apart
    depth: bool = False  # z counts downwards; it is turned over
    progress: object = no_progress  # is called with the fraction read; what it raises ends it
    band: object = None  # None, or the number from 1 of a raster's band of elevations
    layer: object = None  # None, or the name of a layer or variable, of files that hold several
    classes: object = None  # None, or the numbers of the classes of a LAS file to read
    where: object = None  # None, or what conditions_of() takes: which points to read, by columns
    project: bool = False  # degrees become metres, of a UTM zone
    points_only: bool = False  # points of a mesh are wanted, whatever its triangles are

    def __post_init__(self):
        if self.columns is not None:
            self.columns = three_columns(self.columns)
        if self.classes is not None:
            self.classes = class_numbers(self.classes)
        if self.band is not None and self.band < 1:
            raise ValueError(f"{argument('band')} takes a number from 1, not {self.band}")
        if self.where is not None:
            self.where = conditions_of(self.where)


def coordinates_of(data):
    """(n, 3) coordinates of the points of a data set."""
    points = data.GetPoints()
    return vtk_to_numpy(points.GetData()) if points else numpy.zeros((0, 3))


def triangles_of(data):
    """(n, 3) ids of the points of the polygons of vtkPolyData, which are triangles."""
    return vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def id_lists(cells):
    """[(n,) ids of the points of each of the cells]."""
    ids, ends = (vtk_to_numpy(a) for a in (cells.GetConnectivityArray(), cells.GetOffsetsArray()))
    return [ids[begin:end] for begin, end in zip(ends[:-1], ends[1:])]


def moved(data, coordinates):
    """The same data set with its points in other places."""
    result = data.NewInstance()
    result.ShallowCopy(data)
    if len(coordinates):
        result.SetPoints(make_points(coordinates).GetPoints())
    return result


def make_points(coordinates, copy=True):
    """(n, 3) float64 coordinates -> vtkPolyData with points only. Without copy it uses the array."""
    return points_of(numpy_to_vtk(numpy.ascontiguousarray(coordinates, dtype="f8"), deep=copy))


def points_of(array):
    """An array of VTK of x, y and z -> vtkPolyData with points only."""
    points, data = vtkPoints(), vtkPolyData()
    points.SetData(array)
    data.SetPoints(points)
    return data


def cells_of(rows):
    """An (n, k) index array -> vtkCellArray."""
    kind = "i4" if rows.size < 2**31 and rows.max(initial=0) < 2**31 else "i8"
    offsets = numpy.arange(0, rows.size + 1, rows.shape[1], dtype=kind)
    rows = numpy.ascontiguousarray(rows, dtype=kind).ravel()
    cells = vtkCellArray()
    cells.SetData(*(numpy_to_vtk(ids, deep=True) for ids in (offsets, rows)))
    return cells


LINE_NAMES, WITHOUT_Z = "LineNames", "WithoutZ"  # cell arrays of lines


def make_lines(parts, names=None):
    """(n, 3) arrays of the points of lines in order -> vtkPolyData. Closed ones share their ends.

    parts  lines whose z are NaN become lines of z 0, which bare_lines() knows
    names  None, or how messages call each line, as "lines 3 to 17"
    """
    cells, total, coordinates = vtkCellArray(), 0, []
    bare = [bool(len(points) and numpy.isnan(points[:, 2]).all()) for points in parts]
    for points, is_bare in zip(parts, bare):
        if is_bare:
            points = points * (1.0, 1.0, 0.0)
            points[:, 2] = 0.0
        ids = list(range(total, total + len(points)))
        if len(points) > 3 and numpy.array_equal(points[0], points[-1]):
            points, ids = points[:-1], ids[:-1] + [total]
        cells.InsertNextCell(len(ids), ids)
        coordinates.append(points)
        total += len(points)
    data = make_points(numpy.concatenate(coordinates))
    data.SetLines(cells)
    if names is not None:
        add_words(data.GetCellData(), LINE_NAMES, names)
    if any(bare):
        mark_bare(data, bare)
    return data


def add_words(attributes, name, values):
    """Adds an array of words to cell or field data."""
    words = vtkStringArray()
    words.SetName(name)
    for value in values:
        words.InsertNextValue(value)
    attributes.AddArray(words)


def words_in(attributes, name):
    """The words in an array of field or cell data; none without such an array of words."""
    words = attributes.GetAbstractArray(name)
    if not isinstance(words, vtkStringArray):
        return []
    return [words.GetValue(i) for i in range(words.GetNumberOfValues())]


def take_notes(data):
    """The notes of a reader on the lines of a file; takes them away from the lines."""
    notes = words_in(data.GetFieldData(), RECOGNISED)
    data.GetFieldData().RemoveArray(RECOGNISED)
    return notes


def mark_bare(data, bare=None):
    """Marks lines, or all, as having no z of their own, for bare_lines()."""
    flags = numpy.ones(data.GetNumberOfCells()) if bare is None else numpy.array(bare)
    flags = numpy_to_vtk(flags.astype("u1"), deep=True)
    flags.SetName(WITHOUT_Z)
    data.GetCellData().AddArray(flags)


def line_parts(data):
    """(names, parts) of the lines and polygons of vtkPolyData, as make_lines() takes them."""
    if data.GetPoints() is None:
        return [], []
    xyz, named = coordinates_of(data).astype("f8"), cell_names(data)
    first, names, parts = data.GetNumberOfVerts(), [], []
    for cells, kind in ((data.GetLines(), "line"), (data.GetPolys(), "polygon")):
        for ids in id_lists(cells):
            part = xyz[ids]
            if len(part):
                cell = f"{kind} (cell {first})"
                names.append(named.get(cell, cell))
                parts.append(numpy.vstack((part, part[:1])) if kind == "polygon" else part)
            first += 1
    return names, parts


def check_ids(data, name):
    """Raises ElevationSurfaceError for a line or polygon of vtkPolyData with a point that there is not.

    name  of the property
    """
    first, count = data.GetNumberOfVerts(), data.GetNumberOfPoints()
    for cells, kind in ((data.GetLines(), "line"), (data.GetPolys(), "polygon")):
        ids, ends = (vtk_to_numpy(a) for a in (cells.GetConnectivityArray(), cells.GetOffsetsArray()))
        wrong = numpy.flatnonzero((ids < 0) | (ids >= count))
        if len(wrong):
            cell = first + int(numpy.searchsorted(ends, wrong[0], "right")) - 1
            raise ElevationSurfaceError(
                f"{argument(name)}: point {ids[wrong[0]]} of {kind} (cell {cell}) does not exist; there are "
                f"{counted(count, 'point')}",
                name,
            )
        first += cells.GetNumberOfCells()


def line_cells(data):
    """(n,) numbers of the cells that the lines of line_parts() are."""
    sizes = [numpy.diff(vtk_to_numpy(c.GetOffsetsArray())) for c in (data.GetLines(), data.GetPolys())]
    return data.GetNumberOfVerts() + numpy.flatnonzero(numpy.concatenate(sizes))


def cell_names(data):
    """{how the filters call a line or polygon: its name}; empty where make_lines() was given no names."""
    words = data.GetCellData().GetAbstractArray(LINE_NAMES)
    if not isinstance(words, vtkStringArray) or words.GetNumberOfValues() != data.GetNumberOfCells():
        return {}
    first, polygon = data.GetNumberOfVerts(), data.GetNumberOfVerts() + data.GetNumberOfLines()
    return {
        f"{'line' if cell < polygon else 'polygon'} (cell {cell})": words.GetValue(cell)
        for cell in range(first, words.GetNumberOfValues())
    }


def bare_lines(data):
    """(n,) of bool: which of the lines of line_parts() have no z of their own: they are marked, or their
    points have none."""
    flags = data.GetCellData().GetArray(WITHOUT_Z)
    without = numpy.array([numpy.isnan(part[:, 2]).all() for part in line_parts(data)[1]], dtype=bool)
    return without | (vtk_to_numpy(flags)[line_cells(data)] != 0) if flags else without


def crs_of(data):
    """The words of the field array CRS, or None: the coordinate reference system."""
    words = data.GetFieldData().GetAbstractArray("CRS")
    has_words = isinstance(words, vtkStringArray) and words.GetNumberOfValues() == 1
    return words.GetValue(0) if has_words else None


def set_crs(data, crs):
    """Writes the field array CRS that crs_of() reads."""
    words = vtkStringArray()
    words.SetName("CRS")
    words.InsertNextValue(crs)
    data.GetFieldData().AddArray(words)


def add_array(data, name, values, kind="Point"):
    """Adds numbers, one or some for each point, or with "Cell" for each cell, as array."""
    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName(name)
    getattr(data, f"Get{kind}Data")().AddArray(array)


def some_points(data, keep):
    """The points of a data set with the given ids, with their point data, as vtkPolyData."""
    result = make_points(coordinates_of(data)[keep])
    old, new = data.GetPointData(), result.GetPointData()
    for i in range(old.GetNumberOfArrays()):
        array = old.GetAbstractArray(i)
        if isinstance(array, vtkDataArray) and not isinstance(array, vtkBitArray):
            some = numpy_to_vtk(
                numpy.ascontiguousarray(vtk_to_numpy(array)[keep]),
                deep=True,
                array_type=array.GetDataType(),
            )
        else:
            some = array.NewInstance()
            some.SetNumberOfComponents(array.GetNumberOfComponents())
            some.SetNumberOfTuples(len(keep))
            for place, point in enumerate(keep.tolist()):
                some.SetTuple(place, point, array)
        some.SetName(array.GetName())
        new.AddArray(some)
        kind = old.IsArrayAnAttribute(i)
        if kind >= 0:
            new.SetActiveAttribute(i, kind)
    return result


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


def merged(names, clouds):
    """The points of several clouds as one Cloud. Point arrays that not all of them have are left out.

    Line numbers of text files are kept only where there is one file. Raises FileError where coordinate
    reference systems differ.
    """
    if len(clouds) == 1:
        return clouds[0]
    crs, notes = system_of(names, clouds)
    append = vtkAppendPolyData()
    for cloud in clouds:
        data = make_points(coordinates_of(cloud.points))
        data.GetPointData().ShallowCopy(cloud.points.GetPointData())
        append.AddInputData(data)
    append.SetOutputPointsPrecision(append.DOUBLE_PRECISION)
    append.Update()
    result = Cloud(append.GetOutput(), notes, crs=crs)
    first = clouds[0].grid
    if first and all(cloud.grid and cloud.grid.continues(first) for cloud in clouds):
        result.grid, result.frame = first, common_frame([cloud.frame for cloud in clouds])
    kept = result.points.GetPointData().GetNumberOfArrays()
    if any(cloud.points.GetPointData().GetNumberOfArrays() > kept for cloud in clouds):
        result.notes.append("point arrays that not all files have are left out")
    for title in clouds[0].words:
        if all(title in cloud.words for cloud in clouds):
            result.words[title] = joined_words([cloud.words[title] for cloud in clouds])
    counts = [cloud.points.GetNumberOfPoints() for cloud in clouds]
    result.files = Words(numpy.repeat(numpy.arange(len(clouds), dtype="i4"), counts), list(names))
    for name, cloud in zip(names, clouds):
        count = cloud.points.GetNumberOfPoints()
        result.notes.append(f"{name}: {counted(count, 'point')}")
        result.notes += [f"{name}: {note}" for note in cloud.notes]
        for reason, number in cloud.left_out.items():
            result.left_out[reason] = result.left_out.get(reason, 0) + number
    return result


def system_of(names, clouds):
    """(crs, notes) of several clouds. Raises FileError where they differ."""
    known = [(name, cloud.crs) for name, cloud in zip(names, clouds) if cloud.crs]
    if not known:
        return None, []
    first, crs = known[0]
    return crs, [note for name, other in known for note in check_system(name, other, first, crs)]


def notes_on(cloud, lines, ranks=None):
    """What looks wrong with points and the lines given with them, one line each.

    lines   {"boundary": vtkPolyData, "faults": vtkPolyData}, of these what there is
    ranks   the controller of those that have a Cloud of some of the points each, or None
    """
    notes = [antimeridian_note(cloud.points, ranks)]
    if "faults" in lines:
        notes.append(faults_note(heights_of(cloud.points, ranks), lines["faults"]))
    return [note for note in notes if note]


def check_system(*pair):
    """That of gdal_common, which imports this module."""
    from .gdal_common import check_system as check

    return check(*pair)


def marked_points(data, mark):
    """(n,) of bool: the points with a mark of vtkDataSetAttributes in vtkGhostType."""
    ghosts = data.GetPointData().GetArray(vtkDataSetAttributes.GhostArrayName())
    if ghosts is None:
        return numpy.zeros(data.GetNumberOfPoints(), dtype=bool)
    return vtk_to_numpy(ghosts) & mark != 0


def heights_of(data, ranks=None):
    """(lowest, highest) finite z, or None."""
    z = coordinates_of(data)[:, 2]
    low, high = finite_extremes(ranks, z)
    return (low, high) if low <= high else None


def faults_note(heights, faults):
    """A line for the user when z of faults is far from that of the points, see heights_of(); else None."""
    fault_heights = heights_of(faults)
    if not heights or not fault_heights:
        return None
    (low, high), (first, last) = heights, fault_heights
    allowed = 0.0 if first == last == 0.0 else high - low  # lines without z have 0
    if max(low - last, first - high) <= allowed:
        return None
    where = f"is {first:g}" if first == last else f"is from {first:g} to {last:g}"
    return (
        f"z of the faults {where}, far from z of the points, {low:g} to {high:g}: the surface goes "
        "through faults, so they need elevations"
    )


def antimeridian_note(points, ranks=None):
    """A line for the user when longitudes lie on both sides of 180 degrees, else None."""
    x, y = coordinates_of(points)[:, :2].T
    (west, east), (south, north) = (finite_extremes(ranks, axis) for axis in (x, y))
    if not (-180 <= west <= east <= 180 and -90 <= south <= north <= 90):
        return None
    x = x[numpy.isfinite(x)]
    (first, west), (east, last) = (extremes(ranks, some) for some in (x[x < 0], x[x >= 0]))
    if not first <= west or not east <= last or east - west < 180:
        return None
    return (
        "x looks like degrees on both sides of the antimeridian, so the surface runs around the "
        "earth: add 360 to negative longitudes"
    )


def keep_points(cloud, keep):
    """Leaves only the points with the given ids (a numpy array) in a Cloud."""
    cloud.points = some_points(cloud.points, keep)
    if cloud.lines is not None:
        cloud.lines = lines_at(cloud.lines, keep)
    cloud.words = {name: column.some(keep) for name, column in cloud.words.items()}
    cloud.files = cloud.files and cloud.files.some(keep)


def lines_at(lines, ids):
    """The lines of the points with some ids (a numpy array), of those of a Cloud."""
    return lines.start + ids if isinstance(lines, range) else numpy.asarray(lines)[ids]


def turn_over(cloud):
    """Turns the sign of z: depths become elevations."""
    coordinates = coordinates_of(cloud.points).astype("f8")
    coordinates[:, 2] *= -1.0
    cloud.points = moved(cloud.points, coordinates)
    cloud.notes.append(f"z is turned over, as {option('depth')} says")


def slices(count, at_once=None, first=0):
    """Slices that cover the rows from first up to count."""
    at_once = at_once or AT_ONCE
    return [slice(i, min(i + at_once, count)) for i in range(first, count, at_once)]


@dataclasses.dataclass(frozen=True)
class Part:
    """A part of a file: from first on, up to last, where the whole file goes from 0 to total."""

    first: int = 0
    last: int = 1
    total: int = 1

    def rows(self, count):
        """The slice of so many rows or blocks that is in this part. Parts side by side share none."""
        return slice(self.first * count // self.total, self.last * count // self.total)

    def is_whole(self):
        return self.last - self.first == self.total


WHOLE = Part()


def rounding_note(coordinates, why="VTK reads this format"):
    """A line for the user when 32-bit coordinates are coarse for the spacing, else None."""
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
        f"{why} in single precision: x and y are rounded to steps of {step:g}; "
        "use .vtp or text for large map coordinates"
    )
