# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reading and reconstructing as VTK algorithms, for pipelines and for ParaView.

ElevationPoints reads what read() reads; ReconstructElevationSurface makes of its input what
reconstruct() makes of it. Both tell what they have done as text, and an error in one line.
"""

import warnings

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import (
    vtkDataObject,
    vtkDataObjectTree,
    vtkPolyData,
    vtkTable,
)
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm, vtkStreamingDemandDrivenPipeline

from .accounts import (
    CONTENTS,
    RECOGNISED,
    account_of,
    account_of_error,
    counts_of,
    fill_table,
    in_block,
    joined_errors,
    lines_to_show,
    once,
    recognised,
    report_rows,
    report_text,
)
from .algorithm_base import (
    ReportingAlgorithm,
    drop_elevation,
    set_elevation,
    set_words,
    words_of,
)
from .blocks import is_empty, number_of_points, parts_of, put_parts
from .clouds import ReadOptions, cells_of, keep_points, notes_on, set_crs
from .gathering import gathered
from .inputs import cloud_of, joined, lines_of
from .messages import ElevationSurfaceError, ElevationSurfaceWarning, Reason, counted, of_reason
from .names import argument, option
from .progress import share
from .properties import PROPERTIES, check_together
from .ranks import controller_of, is_to_speak, shared, together
from .reading import read, read_boundary, read_faults
from .reconstruction import reconstruct
from .report import crs_name

NOTHING = "nothing was read"


class ElevationPoints(ReportingAlgorithm):
    """Reads the points of a file, whatever its kind; or the lines of a boundary or of faults.

    Options are those of read(), as text: empty is the default. The output is vtkPolyData with a
    vertex for each point and the point array Elevation. Its field array Recognised tells what the
    file is, which columns were taken, and what was left out; GetRecognised() gives the same text.
    """

    TITLE = "Elevation Points"
    CONTENTS = ("points", "boundary", "faults")

    def __init__(self):
        super().__init__(0, 1)
        self._file = self._columns = self._no_data = self._layer = self._classes = ""
        self._where = ""
        self._keep_nulls = self._depth = self._points_only = False
        self._band = self._contents = 0

    def SetFileName(self, name):
        self.change("_file", name or "")

    def GetFileName(self):
        return self._file

    def SetContents(self, contents):
        """0, 1, 2: points, a boundary, faults."""
        self.change("_contents", int(contents))

    def SetColumns(self, columns):
        """Names, or numbers from 1, of x, y and z with commas between; empty: recognised."""
        self.change("_columns", columns or "")

    def SetNoData(self, value):
        """The elevation that marks missing data, as text; empty: as the file says."""
        self.change("_no_data", "" if value is None else str(value))

    def SetKeepNulls(self, keep):
        self.change("_keep_nulls", bool(keep))

    def SetDepth(self, depth):
        self.change("_depth", bool(depth))

    def SetBand(self, number):
        """The number from 1 of a raster's band of elevations; 0: the first."""
        self.change("_band", int(number))

    def SetLayer(self, name):
        self.change("_layer", name or "")

    def SetClasses(self, numbers):
        """The classes of a LAS file to read, as "2,8"; empty: all."""
        self.change("_classes", numbers or "")

    def SetWhere(self, condition):
        """Which points to read, as COLUMN=VALUE; empty: all."""
        self.change("_where", condition or "")

    def SetPointsOnly(self, points_only):
        """Whether the points of a mesh that is no elevation surface are read."""
        self.change("_points_only", bool(points_only))

    def GetRecognised(self):
        """What was found out about the file, one line each."""
        return self._text

    def options(self):
        """The options of read(). Raises ValueError."""
        options = {"keep_nulls": self._keep_nulls, "depth": self._depth}
        if self._columns.strip():
            options["columns"] = self._columns
        if self._no_data.strip():
            options["no_data"] = no_data_of(self._no_data)
        if self._band:
            options["band"] = self._band
        if self._layer.strip():
            options["layer"] = self._layer.strip()
        if self._classes.strip():
            options["classes"] = self._classes
        if self._where.strip():
            options["where"] = self._where
        if self._points_only:
            options["points_only"] = True
        return options

    def lines(self):
        """The boundary or the faults of the file. Raises ValueError for options of points."""
        options = {name: value for name, value in self.options().items() if value is not False}
        depth = options.pop("depth", False)
        if options:
            names = " and ".join(option(name) for name in options)
            raise ValueError(f"{names}: of points only; lines are read as they are")
        if self.CONTENTS[self._contents] == "faults":
            return read_faults(self._file, depth, self.reading)
        return read_boundary(self._file, self.reading)

    def reading(self, fraction):
        self.progress("Reading", fraction)

    def work(self, inputs, outputs):
        output = vtkPolyData.GetData(outputs)
        try:
            return self.read_into(output, outputs)
        except BaseException:
            output.Initialize()
            set_nothing(output)
            raise

    def stop(self, outputs):
        result = super().stop(outputs)
        set_nothing(vtkPolyData.GetData(outputs))
        return result

    def read_into(self, output, outputs):
        """Returns the lines to show."""
        information = outputs.GetInformationObject(0)
        if information.Get(vtkStreamingDemandDrivenPipeline.UPDATE_PIECE_NUMBER()):
            return []  # one rank has it all
        if not self._file:
            raise ValueError("no file is chosen")
        if self._contents:
            output.ShallowCopy(self.lines())
            count = output.GetNumberOfLines() + output.GetNumberOfPolys()
            told = [f"{self._file}: {counted(count, 'line')} of {self.CONTENTS[self._contents]}"]
        else:
            options = self.options()
            cloud = read(self._file, progress=share(self.reading, 0.0, 0.9), **options)
            finite_points(cloud)
            self.reading(0.95)
            fill_points(output, cloud)
            told = [f"{self._file}: {counted(output.GetNumberOfPoints(), 'point')}"]
            lost = cloud.left_out.items()
            told += [f"{of_reason(count, reason)} left out" for reason, count in lost]
            told += cloud.notes
            if cloud.crs:
                told.append(f"coordinate reference system: {crs_name(cloud.crs)}")
        set_words(output, RECOGNISED, told)
        number = output.GetNumberOfPoints()
        set_words(output, CONTENTS, [self.CONTENTS[self._contents], str(number)])
        self._text = "\n".join(told)
        return told


def set_nothing(output):
    """Marks what ElevationPoints could not read, and has said why."""
    set_words(output, RECOGNISED, [NOTHING])
    set_words(output, CONTENTS, [NOTHING])


def no_data_of(words):
    """The number that a panel's field says. Raises ValueError."""
    try:
        return float(words)
    except ValueError:
        raise ValueError(f"{option('no_data')} takes a number, not {words!r}") from None


def finite_points(cloud):
    """Leaves out what cannot be shown, where anything is left."""
    finite = numpy.isfinite(vtk_to_numpy(cloud.points.GetPoints().GetData())).all(axis=1)
    if finite.any() and not finite.all():
        cloud.left_out[Reason("point", "with NaN or infinity")] = int(numpy.count_nonzero(~finite))
        keep_points(cloud, numpy.flatnonzero(finite))


def fill_points(output, cloud):
    """The points of a Cloud with their data and a vertex for each, so that they can be seen."""
    output.SetPoints(cloud.points.GetPoints())
    output.GetPointData().ShallowCopy(cloud.points.GetPointData())
    output.GetFieldData().ShallowCopy(cloud.points.GetFieldData())
    output.SetVerts(cells_of(numpy.arange(output.GetNumberOfPoints())[:, None]))
    set_elevation(output)
    if cloud.crs:
        set_crs(output, cloud.crs)


class ReconstructElevationSurface(ReportingAlgorithm):
    """Makes an elevation surface of points: reconstruct() as an algorithm.

    Input 0: a point set, image, rectilinear grid or table, or a composite of these: each block then
    is a surface for itself. Inputs 1 and 2, optional: boundary and faults, lines or polygons.
    Outputs: the surface with the point array Elevation; the outlines of holes; the boundary; the
    report as vtkTable. GetReport() gives the report as text.

    Properties of the filters are set by Set<Name>(), the name being that of reconstruct() without
    underscores: SetMaximumEdgeLength(25.0), SetInterpolation("membrane") or (1).
    """

    TITLE = "Reconstruct Elevation Surface"
    STEPS = {
        "triangulating": (0.0, 0.4),
        "trimming": (0.4, 0.6),
        "filling holes": (0.6, 0.95),
        "measuring": (0.95, 1.0),
    }

    def __init__(self):
        super().__init__(3, 4)
        self._properties = {}
        self._elevation_array = self._columns = self._no_data = ""
        self._keep_nulls = self._depth = False
        self._trim = self._fill = True

    def SetElevationArray(self, name):
        """The point array that holds elevations; empty: z, of a grid its only or active array."""
        self.change("_elevation_array", name or "")

    def SetColumns(self, columns):
        """Of a table: names, or numbers from 1, of x, y and z with commas between."""
        self.change("_columns", columns or "")

    def SetNoData(self, value):
        """The elevation that marks missing data, as text; empty: none."""
        self.change("_no_data", "" if value is None else str(value))

    def SetKeepNulls(self, keep):
        self.change("_keep_nulls", bool(keep))

    def SetDepth(self, depth):
        """Whether z of the points counts downwards; faults stay as they are."""
        self.change("_depth", bool(depth))

    def SetTrim(self, trim):
        self.change("_trim", bool(trim))

    def SetFillHoles(self, fill):
        self.change("_fill", bool(fill))

    def GetReport(self):
        """What became of every point and hole, one line each."""
        return self._text

    # -- the pipeline

    def FillInputPortInformation(self, port, info):
        info.Set(vtkAlgorithm.INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject")
        if port:
            info.Set(vtkAlgorithm.INPUT_IS_OPTIONAL(), 1)
        return 1

    def FillOutputPortInformation(self, port, info):
        info.Set(vtkDataObject.DATA_TYPE_NAME(), "vtkTable" if port == 3 else "vtkDataObject")
        return 1

    def RequestDataObject(self, request, inInfo, outInfo):
        """Of a composite input, surface and lines are composites of the same class."""
        data = vtkDataObject.GetData(inInfo[0])
        wanted = data if isinstance(data, vtkDataObjectTree) else vtkPolyData()
        for port in range(3):
            old = vtkDataObject.GetData(outInfo, port)
            if old is None or old.GetClassName() != wanted.GetClassName():
                information = outInfo.GetInformationObject(port)
                information.Set(vtkDataObject.DATA_OBJECT(), wanted.NewInstance())
        if vtkTable.GetData(outInfo, 3) is None:
            outInfo.GetInformationObject(3).Set(vtkDataObject.DATA_OBJECT(), vtkTable())
        return 1

    def work(self, inputs, outputs):
        data = vtkDataObject.GetData(inputs[0])
        controller = controller_of(outputs)
        parts, is_here = parts_of(data), True
        if controller:
            parts = gathered(controller, parts, self.warn)
            is_here = is_to_speak(controller, [p for p in parts if number_of_points(p.data) > 0])
        lines = {}
        for name, given in (("boundary", inputs[1]), ("faults", inputs[2])):
            if given.GetNumberOfInformationObjects():
                given = vtkDataObject.GetData(given)
                lines[name] = shared(controller, lambda: lines_of(given, name))
        results = {}
        accounts = together(
            controller, lambda: self.reconstruct_parts(parts, lines, results) if is_here else []
        )
        self.put(data, parts, results, outputs)
        if controller:
            accounts = once(accounts)
        self._text = report_text(accounts)
        if controller and controller.GetLocalProcessId() > 0:
            return []  # the first rank tells of all
        return self.tell(accounts, any(has_failed_reader(part.data) for part in parts), outputs)

    def reconstruct_parts(self, parts, lines, results):
        """Adds the Reconstruction of each part to results. Returns their accounts."""
        lines = {name: joined(given) for name, given in lines.items()}
        accounts = []
        parts = [part for part in parts if not is_empty(part.data)]
        for i, part in enumerate(parts):
            self._share = (i / len(parts), 1.0 / len(parts))
            try:
                results[part] = self.result_of(part.data, lines)
                accounts.append(account_of(part, results[part]))
            except (ElevationSurfaceError, ValueError) as error:
                accounts.append(account_of_error(part, getattr(error, "message", str(error))))
            except MemoryError:
                accounts.append(account_of_error(part, "there is not enough memory"))
        return accounts

    def result_of(self, part, lines):
        """The Reconstruction of one data set, with notes on what looks wrong."""
        if words_of(part, CONTENTS)[:1] == ["boundary"]:
            raise ElevationSurfaceError(
                "the input is a boundary, which has no elevations; choose it as Boundary, or set "
                "Contents to Points where the file was opened"
            )
        self.check_properties()
        options = ReadOptions(
            columns=self._columns or None,
            no_data=no_data_of(self._no_data) if self._no_data.strip() else None,
            keep_nulls=self._keep_nulls,
            depth=self._depth,
        )
        cloud = cloud_of(part, self._elevation_array, options)
        drop_elevation(cloud.points)
        cloud.notes += recognised(cloud.points)
        cloud.notes += notes_on(cloud, lines)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ElevationSurfaceWarning)  # told by warn()
            result = reconstruct(
                cloud,
                trim=self._trim,
                fill=self._fill,
                progress=self.step,
                **lines,
                **self._properties,
            )
        result.report  # pylint: disable=pointless-statement
        return result

    def check_properties(self):
        """Refuses what reconstruct() would, with the names that a panel has."""
        for name, value in self._properties.items():
            one = PROPERTIES[name]
            try:
                value is None or one.convert(value)
            except (TypeError, ValueError, OverflowError):
                raise ValueError(f"{argument(name)} takes {one.takes}, not {value!r}") from None
        check_together(self._properties, argument)

    def step(self, words, fraction):
        first, last = self.STEPS[words]
        begin, share = self._share
        self.progress(words.capitalize(), begin + share * (first + fraction * (last - first)))

    def put(self, data, parts, results, outputs):
        """Fills the first three outputs with the results, {part: Reconstruction}."""
        for port, name in enumerate(("surface", "holes", "boundary")):
            made = [vtkPolyData() for _ in parts]
            for part, one in zip(parts, made):
                if part in results:
                    one.ShallowCopy(getattr(results[part], name) or vtkPolyData())
                    if port == 0:
                        set_elevation(one)
            put_parts(vtkDataObject.GetData(outputs, port), data, parts, made)

    def tell(self, accounts, reader_has_told, outputs):
        """Fills the table, and sends warnings and errors. Returns the lines to show."""
        errors = [account for account in accounts if "error" in account]
        made = [account for account in accounts if "error" not in account]
        for account in made:
            for note in account["notes"]:
                self.warn(in_block(account, note))
        if errors:
            self.error(joined_errors(errors, len(made)))
        elif not made and reader_has_told:
            self._text = "the input is empty; its reader has told why"
        elif not made:
            raise ElevationSurfaceError("the input has no points")
        if not made:
            return []
        fill_table(vtkTable.GetData(outputs, 3), report_rows(accounts))
        return [f"{self.TITLE}: {', '.join(counts_of(made))}", *lines_to_show(accounts)]


def has_failed_reader(data):
    """Whether ElevationPoints has left this empty, and reported why."""
    return words_of(data, CONTENTS) == [NOTHING]


def add_setters():
    """Gives ReconstructElevationSurface a Set<Name>() for each property of the filters."""

    def setter(name, taken):
        def set_property(self, value):
            if name in CHOSEN_BELOW_ZERO and float(value) < 0:
                value = None
            elif isinstance(value, int) and taken.startswith("one of "):
                value = taken[len("one of "):].split(", ")[value]
            if self._properties.get(name) != value:
                self._properties[name] = value
                self.Modified()

        set_property.__doc__ = f"{name}: {taken}"
        return set_property

    for name, one in PROPERTIES.items():
        words = {"threads": "number_of_threads"}.get(name, name)
        method = "Set" + words.title().replace("_", "")
        setattr(ReconstructElevationSurface, method, setter(name, one.takes))


# Below 0 a panel says what None says in Python; 0 is a value of its own.
CHOSEN_BELOW_ZERO = ("open_edge_length",)
add_setters()
