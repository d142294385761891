# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The steps of the chain: how its filters run, what they report, triangulating and trimming."""

import time

import numpy
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkRectilinearGrid, vtkTable

from .clouds import bare_lines, cell_names, coordinates_of, joined, marked_points
from .lattice import lattice_of
from .messages import ElevationSurfaceError, Messages, counted
from .names import PANEL, PYTHON, are_for, argument, option
from .open_edge_length import LEAST_STEPS_APART, elongation, measured
from .outline import (
    ON_BORDER,
    ON_OUTLINE,
    along_edges,
    border_of,
    elevated,
    in_use,
    outside_of,
    simplified,
    spacing_of,
    within,
)
from .properties import PROPERTIES, is_simplified, set_properties
from .ranks import all_values, collected, extremes, together, total
from .spreading import (
    OUTSIDE_OUTLINE,
    SAME_PLACE,
    WITHIN_ERROR,
    own_point_count,
    reasons_of,
    show_hidden,
    update,
    with_hidden,
)
from .vtkElevationSurface import vtkGridDelaunay2D, vtkTrimOutwardTriangles

# Of gap tolerances, in spacings: that of survey lines 200 times as far apart as their points.
MOST_GAP_TOLERANCE = 300.0
RAISED = 1.25  # times the tolerance that leaves out some

STEPS = {"delaunay": "triangulating", "trim": "trimming", "fill": "filling holes"}


class Kept:
    """What a run keeps for the next one: results by name, each with the key that it was made for."""

    def __init__(self):
        self._results = {}

    def result(self, name, key, make, ranks=None):
        """The last result of this name where its key was the same on all ranks, else that of make()."""
        old = self._results.get(name)
        if total(ranks, old is None or old[0] != key):
            self.forget(name)
            old = self._results[name] = key, make()
        return old[1]

    def forget(self, name):
        self._results.pop(name, None)

    def forget_steps(self, first):
        """Frees those of the filters from the first of these on: they will run anew."""
        for name in [name for name in self._results if isinstance(name, int) and name >= first]:
            self.forget(name)


def state_of(data):
    """Data sets as part of a key: which they are, and when they were changed last."""
    return [(one, changed_at(one)) for one in data]


def changed_at(data):
    """VTK leaves out the columns of tables and the axes of rectilinear grids."""
    parts = [data]
    if isinstance(data, vtkTable):
        parts.append(data.GetRowData())
    if isinstance(data, vtkRectilinearGrid):
        parts += [data.GetXCoordinates(), data.GetYCoordinates(), data.GetZCoordinates()]
    return max(part.GetMTime() for part in parts)


def settings_of(algorithm):
    """The inputs and the properties of a filter, as a key."""
    inputs = [
        algorithm.GetInputDataObject(port, i)
        for port in range(algorithm.GetNumberOfInputPorts())
        for i in range(algorithm.GetNumberOfInputConnections(port))
    ]
    getters = ["G" + name[1:] for name in vars(type(algorithm)) if name.startswith("Set")]
    values = [getattr(algorithm, name)() for name in getters if hasattr(algorithm, name)]
    return state_of(inputs), repr(values)


class Step:
    """Runs a filter with progress. Its errors are raised, its warnings become notes.

    given  the properties of filters, see checked()
    ranks  the controller of those that run it together, or None
    kept   None, or the Kept of the last run: a filter with the same settings does not run again
    """

    def __init__(self, result, given, progress, strict, ranks, kept=None):
        self.result = result
        self.kept = kept or Kept()
        self.count = 0  # of filters that ran; some run twice
        self.properties = given
        self.progress = progress
        self.strict = strict
        self.ranks = ranks

    def configure(self, step, algorithm):
        """Gives the filter of a step its properties, and returns it."""
        return set_properties(algorithm, step, self.properties)

    def __call__(self, name, algorithm, change=None):
        """Returns the filter, updated, or that of the last run.

        change  called with the Messages; returns whether it has changed properties, so that the filter
                runs again. The messages before do not count then.
        """
        self.count += 1
        algorithm, messages, notes, error = self.kept.result(
            self.count, (name, settings_of(algorithm)),
            lambda: self.run(name, algorithm, change), self.ranks,
        )
        self.result.notes += notes

        def end():
            if error:
                raise error
            return self.report(name, messages, rings_of(algorithm) if name != "delaunay" else None)

        try:
            lines = together(self.ranks, end)
        except BaseException:
            self.kept.forget(self.count)
            raise
        for is_on_one_rank, note in lines:
            notes = self.result.gathered if is_on_one_rank else self.result.notes
            notes += [note] if note not in notes else []
        return algorithm

    def run(self, name, algorithm, change):
        """Returns the filter, its Messages, the notes of change(), and what was raised or None."""
        raised, before = [], len(self.result.notes)
        self.kept.forget_steps(self.count)
        if name != "fill":
            self.kept.forget("open edge length")

        def show(caller, _event):
            # What is raised in an observer does not get through VTK: the filter is aborted first.
            # That holds for Ctrl-C too.
            try:
                if self.progress:
                    self.progress(STEPS[name], caller.GetProgress())
            except BaseException as error:  # pylint: disable=broad-except
                raised.append(error)
            if raised:
                caller.SetAbortExecute(1)

        tag = algorithm.AddObserver("ProgressEvent", show)
        began = time.perf_counter()
        while True:
            with Messages(algorithm, algorithm.GetExecutive()) as messages:
                update(algorithm, self.ranks)
            if change is None or total(self.ranks, len(raised)) or not change(messages):
                break
        times, words = self.result.times, "triangulate" if name == "delaunay" else name
        times[words] = times.get(words, 0.0) + time.perf_counter() - began
        algorithm.RemoveObserver(tag)
        notes = self.result.notes[before:]
        del self.result.notes[before:]
        return algorithm, messages, notes, raised[0] if raised else None

    def report(self, name, messages, rings):
        """Raises the errors of a step. Returns [whether it is OnOneRank, note] of its warnings."""
        warnings = [warning for warning in messages.warnings if warning.code != "OnOneRank"]
        problems = messages.errors or (warnings if self.strict else [])
        if problems:
            about = "points"
            if name == "trim" and self.result.boundary_name:
                about = "boundary"
            elif name == "delaunay" and concerns_constraints(problems[0]):
                about = "faults"
            words = " ".join(in_our_names(one, name, rings) for one in problems)
            raise ElevationSurfaceError(words, about, STEPS[name])
        self.result.warnings += warnings
        return [
            [warning.code == "OnOneRank", f"{STEPS[name]}: {in_our_names(warning, name, rings)}"]
            for warning in messages.warnings
        ]


def concerns_constraints(message):
    """Whether a filter's message is about its constraints, which are our faults."""
    return not CALLED_IN_PANEL.keys().isdisjoint(message.values.values())


CALLED_IN_PANEL = {"constraints": "faults", "constraints'": "faults'"}


def in_our_names(message, step, rings=None):
    """A filter's Message, with the names of options where it has names of properties.

    step   delaunay, trim or fill
    rings  None, or the boundary or areas of the step, whose lines may have names
    """

    def name_of(setter):
        for name, one in PROPERTIES.items():
            if one.setter == f"Set{setter}" and one.step in (step, "") and not are_for(PYTHON):
                return option(name)
        return setter

    words = dict(CALLED_IN_PANEL) if are_for(PANEL) else {}
    if rings is not None:
        words.update((f"the {cell}", name) for cell, name in cell_names(rings).items())
    return message.named(name_of, words)


def rings_of(algorithm):
    """The boundary or the areas that a filter is given, or None."""
    return algorithm.GetInputDataObject(1, 0) if algorithm.GetNumberOfInputConnections(1) else None


def triangulate(run, lines, has_all=False, points=None):
    """The first step, with lines or None as constraints.

    has_all  of all points, whatever is given
    points   instead of those of the cloud
    """
    result, ranks, points = run.result, run.ranks, points or run.result.cloud.points
    delaunay = run.configure("delaunay", vtkGridDelaunay2D())
    if has_all:
        delaunay.SetMaximumElevationError(0.0)
        delaunay.SetMaximumNumberOfPoints(0)
    is_few = not has_all and is_simplified(run.properties)
    # A boundary that is given cuts the surface at all its points.
    delaunay.SetSimplifyConstraints(not result.boundary_name)
    delaunay.SetInputData(points)
    bare = [] if lines is None or is_few else bare_lines(lines)
    # A rank may have lines that others lack.
    delaunay.SetDrapeConstraints(total(ranks, len(bare) > 0 and bare.all()) > 0)
    if lines is not None:
        delaunay.SetSourceData(lines)
    result.delaunay = delaunay = run("delaunay", delaunay)
    surface = delaunay.GetOutput()
    result.triangles["delaunay"] = total(ranks, surface.GetNumberOfPolys())
    result.lattice = lattice_of(ranks, surface)
    own = own_point_count(ranks, surface, points)
    result.points, result.reasons = surface, reasons_of(ranks, surface, own)
    result.number_of_points = total(ranks, own)
    if result.triangles["delaunay"] == 0:
        limit = run.properties.get("maximum_edge_length", 0.0)
        hidden = marked_points(points, vtkDataSetAttributes.HIDDENPOINT)
        why = why_no_triangle(ranks, coordinates_of(points)[~hidden], limit, result.warnings)
        count = total(ranks, numpy.count_nonzero(hidden))
        why += f"; {counted(count, 'point is', 'points are')} marked as hidden" if count else ""
        raise ElevationSurfaceError(together(ranks, lambda: [why])[0])


def trim_along(run, boundary, edges=None):
    """The second step, along a boundary, or None; edges: how its edges are added, unless given."""
    result = run.result
    trim = run.configure("trim", vtkTrimOutwardTriangles())
    if edges is not None and "boundary_edges" not in run.properties:
        trim.SetBoundaryEdges(edges)
    trim.SetInputData(0, result.delaunay.GetOutput())
    if boundary is not None:
        trim.SetBoundaryData(boundary)
    elif not run.properties.get("gap_tolerance"):
        # Of a raster, missing pixels that touch the outside are outside.
        grid = result.cloud.grid
        steps = together(run.ranks, lambda: list(grid.steps) if grid else [])
        trim.SetGridSteps((steps or [0.0] * 4)[:4])
    result.trim = trim = run("trim", trim, LineKeeper(run, trim))
    result.triangles["trimmed"] = total(run.ranks, trim.GetOutput().GetNumberOfPolys())
    if result.triangles["trimmed"] == 0:
        raise ElevationSurfaceError(
            "no triangle lies inside the boundary; are boundary and points in the same "
            "coordinates?",
            "boundary" if result.boundary_name else "points",
        )


class LineKeeper:
    """Raises the gap tolerance until all points are kept, where the outline would leave out most of them
    although they lie along lines. Called after each run, with its messages: whether there is another one,
    the same on all ranks."""

    def __init__(self, run, trim):
        self.run, self.trim = run, trim
        self.before = None  # the tolerance that was chosen first, and the share that it leaves out

    def __call__(self, messages):
        if self.before is None:
            return self.is_first_raised(messages)
        tolerance = RAISED * self.trim.GetGapTolerance()
        if self.trim.GetNumberOfPointsLeftOut() and tolerance <= MOST_GAP_TOLERANCE:
            self.trim.SetGapTolerance(tolerance)
            return True
        left_out = counted(self.trim.GetNumberOfPointsLeftOut(), "point")
        self.run.result.notes.append(
            "the points lie along lines: a gap tolerance of {:.4g} spacings leaves out {}, where one of {:.4g} "
            "leaves out {:g} %; {} decides otherwise".format(
                self.trim.GetGapTolerance(), left_out, *self.before, argument("gap_tolerance")))
        return False

    def is_first_raised(self, messages):
        def advice():
            for message in messages.errors + messages.warnings:
                if message.code in ("BoundaryLeavesOut", "BoundaryLeavesOutAll"):
                    names = ("tolerance", "part", "better")
                    return [float(message.values.get(name, 100.0)) for name in names]
            return []

        found = together(self.run.ranks, advice)
        if not found or self.trim.GetGapTolerance():
            return False
        tolerance, percent, better = found
        if percent <= 50.0 or better > MOST_GAP_TOLERANCE:
            return False
        triangles = measured(self.run.ranks, self.run.result.delaunay.GetOutput())
        if elongation(*triangles) < LEAST_STEPS_APART:
            return False
        self.before = tolerance, percent
        self.trim.SetGapTolerance(better)
        return True


class DensityKeeper:
    """Fills without the density of the surface around holes where that takes more points than are inserted by
    default. Called after each run, with its messages, as LineKeeper is."""

    def __init__(self, run, filling):
        self.run, self.filling = run, filling

    def __call__(self, messages):
        def expected():
            return [
                message.values["points"] for message in messages.errors
                if message.code == "TooManyPointsByDefault" and message.values["matching"]
            ]

        found = together(self.run.ranks, expected)
        if not found or not self.filling.GetMatchDensity():
            return False
        self.filling.SetMatchDensity(False)
        self.run.result.notes.append(
            f"new points are as far apart as the edges of their holes, not as dense as the surface around: about "
            f"{int(found[0]):,} would be needed; {argument('maximum_expected_points')} or {argument('spacing')} decides"
        )
        return True


def trim_few(run, boundary, faults):
    """The first two steps for few points: the outline is that of all, and what is outside of it does not
    count."""
    result, error = run.result, run.properties.get("maximum_elevation_error", 0.0)
    if run.properties.get("maximum_number_of_points"):
        error = numpy.inf  # of the points of the outline, those come back that are worth their number
    triangulate(run, faults, has_all=True)
    # Edges that follow the surface would have many points, each of which becomes a vertex.
    trim_along(run, boundary, vtkTrimOutwardTriangles.STRAIGHT)
    result.outlined, lattice, reasons = (result.delaunay, result.trim), result.lattice, result.reasons
    if boundary is not None:
        # It has no elevations, and may leave the points: its edges in the surface of all points do.
        outline = border_of(result.trim.GetOutput())
        reach = ON_BORDER * outline.GetLength()
    else:
        outline = result.trim.GetOutput(2)
        spacing = spacing_of(outline, lattice)
        outline, reach = simplified(outline, spacing, error), ON_OUTLINE * spacing
    if boundary is None and result.trim.GetNumberOfOutwardTriangles() == 0:
        outline = None  # the convex hull, which stays without constraints
    xyz = coordinates_of(result.cloud.points)
    outside = numpy.zeros(len(reasons), dtype=bool)
    if outline is not None:
        is_vertex = numpy.isin(reasons, (0, SAME_PLACE))
        outside[is_vertex] = outside_of(outline, xyz[is_vertex], reach)
    triangulate_inside(run, faults, outline, outside)
    if outline is None:
        outline = border_of(result.delaunay.GetOutput())
    elif boundary is None:
        outline = in_use(outline, result.delaunay.GetOutput())
    if faults is not None:
        outline = along_edges(outline, result.delaunay.GetOutput())
    trim_along(run, outline)
    result.lattice = lattice
    result.boundary = (result.trim if boundary is None else result.outlined[1]).GetOutput(2)
    left = numpy.flatnonzero(result.reasons == WITHIN_ERROR)
    result.reasons[left[outside_of(outline, xyz[left], reach)]] = OUTSIDE_OUTLINE


def triangulate_inside(run, faults, outline, outside):
    """Triangulates few points, along faults and an outline, of which there may be none, as if points that are
    outside, (n,) of bool, and faults there did not exist: else they would be some of the few."""
    result, of_all = run.result, run.result.delaunay.GetOutput()
    reasons, points = result.reasons, result.cloud.points
    lines = [] if outline is None else [outline]
    if faults is not None and outline is not None:
        faults = within(elevated(faults, of_all), outline, ON_BORDER * outline.GetLength())
    if faults is not None:
        lines.insert(0, faults)
    triangulate(run, joined(lines) if lines else None, points=with_hidden(points, outside))
    surface = result.delaunay.GetOutput()
    show_hidden(surface, outside, reasons, points)
    surface.GetFieldData().AddArray(of_all.GetFieldData().GetArray("NumberOfDuplicatePoints"))
    result.reasons[outside] = numpy.where(reasons == 0, OUTSIDE_OUTLINE, reasons)[outside]


def why_no_triangle(ranks, xyz, limit, warnings):
    """The reason in words when the triangulation is empty.

    xyz       (n, 3) points of this rank that are shown
    warnings  those of the filter, which the first rank has
    """
    finite = xyz[numpy.isfinite(xyz).all(axis=1)]
    distinct = numpy.unique(finite[:, :2].astype("f8"), axis=0)
    count, finite_count = total(ranks, len(xyz)), total(ranks, len(finite))
    ends = numpy.vstack((distinct[:3], distinct[-1:]))  # of each rank
    ends = numpy.unique(all_values(ranks, ends.ravel(), "f8").reshape(-1, 2), axis=0)
    words = "the only point" if count == 1 else f"all {count:,} points"
    if count == 0:
        return "no surface: there is no point to use"
    if finite_count == 0:
        return f"no surface: {words} {'is' if count == 1 else 'are'} not finite (NaN or infinite)"
    if count == 1:
        return "no surface: there is only one point; three not on a line are needed"
    if len(ends) == 1:
        x, y = ends[0]
        where = f"({x:.10g}, {y:.10g})"
        return f"no surface: all {finite_count:,} finite points have the same x,y {where}"
    if len(ends) == 2:
        return "no surface: only two points differ in x,y; three not on a line are needed"
    a, b = ends[0], ends[-1]
    away = distinct - a
    far = away[numpy.argmax((away**2).sum(axis=1))] if len(away) else numpy.zeros(2)
    far = max(collected(ranks, far, "f8"), key=lambda one: one @ one)
    offset = extremes(ranks, numpy.abs(away[:, 0] * far[1] - away[:, 1] * far[0]))[1] / (far @ far)
    if offset < 1e-12 or not limit:
        return (
            f"no surface: all {finite_count:,} finite points lie on one line in x,y, from "
            f"({a[0]:.10g}, {a[1]:.10g}) to ({b[0]:.10g}, {b[1]:.10g})"
            + (f"; if they are a wall, {argument('plane')} best makes its surface"
               if any(one.code == "PointsOnWall" for one in warnings) else "")
        )
    name = argument("maximum_edge_length")
    words = f"no surface: no triangle has edges of at most {limit:g}; use a larger {name}"
    for one in warnings:
        if one.code == "FewTrianglesAdvice":
            words += (
                f". Between neighbours, the shortest edge is {one.values['shortest']} long, the median "
                f"{one.values['median']}. A {name} of {one.values['better']} keeps a triangle at 95 % of "
                "the points"
            )
    return words
