# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reading and reconstructing as VTK algorithms, for pipelines and for ParaView.

ElevationPoints reads what read() reads; ReconstructElevationSurface makes of its input what
reconstruct() makes of it. Both report their work as text, and an error in one line.
"""

import dataclasses
import math

import numpy
from vtkmodules.vtkCommonDataModel import (
    vtkDataObject,
    vtkDataObjectTree,
    vtkPolyData,
    vtkTable,
)
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm, vtkStreamingDemandDrivenPipeline

from .block_reports import (
    CONTENTS,
    RECOGNISED,
    counts_of,
    fill_table,
    in_block,
    joined_errors,
    lines_to_show,
    once,
    patch_triangles,
    recognised,
    block_report,
    failed_block_report,
    report_rows,
    report_text,
)
from .algorithm_base import ReportingAlgorithm, drop_elevation, set_elevation
from .blocks import parts_of, put_parts, surfaces_of
from .clouds import ReadOptions, add_words, cells_of, coordinates_of, joined, keep_points, notes_on, set_crs, words_in
from .description import DESCRIBED
from .exaggeration import point_exaggeration, surface_exaggeration
from .inputs import cloud_of, lines_of
from .messages import ElevationSurfaceError, Reason, counted, counted_reason
from .names import argument, option
from .progress import share
from .properties import FEWER, PROPERTIES, checked, is_simplified
from .ranks import agreed, controller_of, shared, together
from .reading import read, read_boundary, read_faults
from .reconstruction import NAMES, reconstruct_cloud
from .report import crs_name
from .spreading import gather_points
from .steps import Kept, state_of

NOTHING = "nothing was read"
FEW_NEED_ALL = (
    "The surface is made on one rank (process), which needs memory for all of it. {} chooses few points "
    "out of all; 0 leaves the surface spread."
)


class ElevationPoints(ReportingAlgorithm):
    """Reads the points of a file, whatever its kind; or the lines of a boundary or of faults.

    Options are those of read(), as text: empty is the default. The output is vtkPolyData with a
    vertex for each point and the point array Elevation. Its field array Recognised says what the
    file is, which columns were taken, and what was left out; GetRecognised() returns the same text.
    Several files are time steps, 0, 1 and so on.
    """

    TITLE = "Elevation Points"

    def __init__(self):
        super().__init__(0, 1)
        self._files, self._file, self._properties = [], "", {}
        self._exaggeration = 1.0

    def SetFileName(self, name):
        self.change("_files", [name] if name else [])

    def AddFileName(self, name):
        self.change("_files", self._files + [name])

    def ClearFileNames(self):
        self.change("_files", [])

    def GetFileName(self):
        """The file of the last time step that was read; of one file, that."""
        return self._file if self._file in self._files else "".join(self._files[:1])

    def GetRecognised(self):
        """What was found out about the file, one line each."""
        return self._text

    def GetVerticalExaggeration(self):
        """The factor for z with which the relief of the points is seen."""
        return self._exaggeration

    def lines(self, contents):
        """The boundary or the faults of the file. Raises ValueError for options of points."""
        options = read_options(self._properties)
        point_options = [name for name in options if contents not in DESCRIBED[name].contents]
        if point_options:
            names = " and ".join(option(name) for name in point_options)
            raise ValueError(f"{names}: of points only; lines are read as they are")
        if contents == "faults":
            return read_faults(self._file, options.get("depth", False), self.reading)
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

    def RequestInformation(self, request, inInfo, outInfo):
        information, keys = outInfo.GetInformationObject(0), vtkStreamingDemandDrivenPipeline
        for key in (keys.TIME_STEPS(), keys.TIME_RANGE()):
            information.Remove(key)
        last = len(self._files) - 1
        if last > 0:
            information.Set(keys.TIME_STEPS(), [float(i) for i in range(last + 1)], last + 1)
            information.Set(keys.TIME_RANGE(), [0.0, float(last)], 2)
        return 1

    def choose_file(self, information, output):
        """Chooses the file of the time that is asked for: the last one that has begun."""
        last, keys = len(self._files) - 1, vtkStreamingDemandDrivenPipeline
        step = 0
        if last > 0 and information.Has(keys.UPDATE_TIME_STEP()):
            step = min(max(math.floor(information.Get(keys.UPDATE_TIME_STEP())), 0), last)
        if last > 0:
            output.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), float(step))
        self._file = self._files[step]

    def read_into(self, output, outputs):
        """Returns the lines to show."""
        information = outputs.GetInformationObject(0)
        if information.Get(vtkStreamingDemandDrivenPipeline.UPDATE_PIECE_NUMBER()):
            return []  # one rank has it all
        if not self._files:
            raise ValueError("no file is chosen")
        self.choose_file(information, output)
        contents = self._properties.get("contents") or "points"
        if contents != "points":
            output.ShallowCopy(self.lines(contents))
            count = output.GetNumberOfLines() + output.GetNumberOfPolys()
            lines = [f"{self._file}: {counted(count, 'line')} of {contents}"]
            lines += words_in(output.GetFieldData(), RECOGNISED)
        else:
            options = read_options(self._properties)
            cloud = read(self._file, progress=share(self.reading, 0.0, 0.9), **options)
            finite_points(cloud)
            self.reading(0.95)
            fill_points(output, cloud)
            self._exaggeration = point_exaggeration(output)
            lines = [f"{self._file}: {counted(output.GetNumberOfPoints(), 'point')}"]
            lost = cloud.left_out.items()
            lines += [f"{counted_reason(count, reason)} left out" for reason, count in lost]
            lines += cloud.notes
            if cloud.crs:
                lines.append(f"coordinate reference system: {crs_name(cloud.crs)}")
        add_words(output.GetFieldData(), RECOGNISED, lines)
        number = output.GetNumberOfPoints()
        add_words(output.GetFieldData(), CONTENTS, [contents, str(number)])
        self._text = "\n".join(lines)
        return lines


def set_nothing(output):
    """Marks a file that ElevationPoints could not read, and has reported why."""
    add_words(output.GetFieldData(), RECOGNISED, [NOTHING])
    add_words(output.GetFieldData(), CONTENTS, [NOTHING])


def read_options(given):
    """The options of read() among the properties that are given. Raises ValueError."""
    names = [field.name for field in dataclasses.fields(ReadOptions) if given.get(field.name)]
    options = {name: given[name] for name in names}
    if "no_data" in options:
        try:
            options["no_data"] = float(options["no_data"])
        except ValueError:
            raise ValueError(f"{option('no_data')} takes a number, not {options['no_data']!r}") from None
    return options


def finite_points(cloud):
    """Leaves out what cannot be shown, where anything is left."""
    finite = numpy.isfinite(coordinates_of(cloud.points)).all(axis=1)
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
    is a surface for itself. Inputs 1 to 4, optional: boundary and faults, lines or polygons; and polygons
    as fill_only or keep_open.
    Outputs: the surface with the point array Elevation; the outlines of holes; the boundary; the
    report as vtkTable. GetReport() gives the report as text.

    Properties are set by Set<Name>(), the name being that of reconstruct() without underscores:
    SetOpenEdgeLength(25.0), SetInterpolation("membrane") or (1).
    """

    TITLE = "Reconstruct Elevation Surface"
    STEPS = {
        "triangulating": (0.0, 0.4),
        "trimming": (0.4, 0.6),
        "filling holes": (0.6, 0.95),
        "measuring": (0.95, 1.0),
    }

    def __init__(self):
        super().__init__(5, 4)
        self._properties, self._exaggeration, self._chosen = {}, 1.0, {}
        self._kept = []  # of each surface

    def GetReport(self):
        """How every point was used and every hole was treated, one line each."""
        return self._text

    def GetEffectiveGapTolerance(self):
        """The gap tolerance that was used, of the first block; 0 with a boundary that is given."""
        return self._chosen.get("GapTolerance", 0.0)

    def GetEffectiveOpenEdgeLength(self):
        """The open edge length that was used, of the first block; 0: none."""
        return self._chosen.get("OpenEdgeLength", 0.0)

    def GetEffectiveSpacing(self):
        """The mean distance of the new points of the first block; 0: there is none."""
        return self._chosen.get("Spacing", 0.0)

    def GetVerticalExaggeration(self):
        """The factor for z with which the relief of the surface is seen; 1 where it is over a plane."""
        return self._exaggeration

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
        controller = controller_of(outputs)
        return agreed(controller, lambda: self.work_on(controller, inputs, outputs))

    def work_on(self, controller, inputs, outputs):
        data = vtkDataObject.GetData(inputs[0])
        lines = {}
        for name, given in zip(("boundary", "faults", "fill_only", "keep_open"), inputs[1:]):
            if given.GetNumberOfInformationObjects():
                given = vtkDataObject.GetData(given)
                lines[name] = joined(shared(controller, lambda: lines_of(given, name)))
        parts, surfaces = surfaces_of(controller, parts_of(data))
        results = {}
        reports = self.reconstruct_surfaces(surfaces, lines, results)
        reports = once(together(controller, lambda: reports))
        seen = [result.surface for result in results.values() if not result.cloud.plane]
        self._exaggeration = surface_exaggeration(seen, controller)
        self.put(data, parts, results, outputs)
        self._text = report_text(reports)
        self._chosen = next((one["chosen"] for one in reports if "chosen" in one), {})
        if controller and controller.GetLocalProcessId() > 0:
            return []  # the first rank reports for all
        return self.report_results(reports, any(has_failed_reader(part.data) for part in parts), outputs)

    def reconstruct_surfaces(self, surfaces, lines, results):
        """Adds the Reconstruction of each Surface to results, by the Part whose place it takes. Returns
        their reports."""
        reports = []
        self._kept = (self._kept + [Kept() for _ in surfaces])[: len(surfaces)]
        for i, (surface, kept) in enumerate(zip(surfaces, self._kept)):
            self._share = (i / len(surfaces), 1.0 / len(surfaces))
            try:
                result, recognised_lines = agreed(
                    surface.ranks, lambda: self.result_of(surface, lines, kept)
                )
                if result:
                    results[surface.part] = result
                    reports.append(block_report(surface, result, recognised_lines))
            except (ElevationSurfaceError, ValueError) as error:
                reports.append(failed_block_report(surface, getattr(error, "message", str(error))))
            except MemoryError:
                reports.append(failed_block_report(surface, "there is not enough memory"))
        return reports

    def result_of(self, surface, lines, kept):
        """(the Reconstruction of a Surface, what its reader has found out). The Reconstruction is None on
        a rank that has none because another makes the whole.

        kept  the Kept of the last time: a changed property runs from the first step that it belongs to
        """
        given, ranks = dict(self._properties), surface.ranks
        properties = {name: given[name] for name in given if name in PROPERTIES}
        properties = checked(properties, argument)
        options = ReadOptions(**read_options(given))
        if any(words_in(data.GetFieldData(), CONTENTS)[:1] == ["boundary"] for data in surface.data):
            raise ElevationSurfaceError(
                "the input is a boundary, which has no elevations; choose it as Boundary, or set "
                "Contents to Points where the file was opened"
            )
        elevation = given.get("elevation_array") or ""

        def make_cloud():
            cloud = cloud_of(surface.data, elevation, options, ranks)
            drop_elevation(cloud.points, ranks)
            return cloud

        key = state_of(surface.data), elevation, options
        cloud = kept.result("cloud", key, make_cloud, ranks).copy()
        found = recognised(cloud.points, ranks)
        cloud.notes += found + notes_on(cloud, lines, ranks)
        gathered = []
        if ranks and is_simplified(properties):
            name = next(name for name in FEWER if properties.get(name))
            gathered.append(FEW_NEED_ALL.format(option(name)))
            cloud.points, ranks = gather_points(ranks, cloud.points), None
            if not cloud.points.GetNumberOfPoints():
                return None, found
        steps = {name: given[name] for name in ("trim", "fill") if name in given}
        result = reconstruct_cloud(
            cloud, lines, NAMES, properties, ranks=ranks, progress=self.step, kept=kept, **steps
        )
        result.gathered += gathered
        result.report  # pylint: disable=pointless-statement  (all ranks make it)
        result.patch_triangles = patch_triangles(result, ranks)
        surface = vtkPolyData()
        surface.ShallowCopy(result.surface)  # which may be an output that is kept
        set_elevation(surface, ranks)
        result.surface = surface
        return result, found

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
            put_parts(vtkDataObject.GetData(outputs, port), data, parts, made)

    def report_results(self, reports, has_failed_input, outputs):
        """Fills the table, and sends warnings and errors. Returns the lines to show."""
        errors = [report for report in reports if "error" in report]
        made = [report for report in reports if "error" not in report]
        for report in made:
            for note in report["warnings"]:
                self.warn(in_block(report, note))
        if errors:
            self.error(joined_errors(errors, len(made)))
        elif not made and has_failed_input:
            self._text = "the input is empty; its reader has reported why"
        elif not made:
            raise ElevationSurfaceError("the input has no points")
        if not made:
            return []
        fill_table(vtkTable.GetData(outputs, 3), report_rows(reports))
        return [f"{self.TITLE}: {', '.join(counts_of(made))}", *lines_to_show(reports)]


def has_failed_reader(data):
    """Whether ElevationPoints has left this empty, and reported why."""
    return words_in(data.GetFieldData(), CONTENTS) == [NOTHING]


def python_value(one, value, place):
    """The value in Python for what a panel gives: None for what counts as not given."""
    if one.choices and isinstance(value, int):
        return one.choices[value]
    if one.kind.value_type == "bool" and value in (0, 1):
        return bool(value)
    if one.kind.value_type == "string":
        return None if value is None or not str(value).strip() else str(value)
    if one.default_in(place) == "-1" and value is not None and float(value) < 0:
        return None  # chosen; 0 is a value of its own
    return value


def add_setters(algorithm, place):
    """Gives an algorithm a Set<Name>() for each property that is described for it."""

    def setter(one):
        def set_property(self, value):
            value = python_value(one, value, place)
            if self._properties.get(one.name) != value:
                self._properties[one.name] = value
                self.Modified()

        set_property.__doc__ = f"{one.name}: {one.takes}. {one.line[:1].upper() + one.line[1:]}."
        return set_property

    for one in DESCRIBED.values():
        if place in one.places and one.words["takes"] != "lines":
            setattr(algorithm, "Set" + one.name_in(place), setter(one))


add_setters(ElevationPoints, "reader")
add_setters(ReconstructElevationSurface, "chain")
