# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points in, surface out: the chain of the three filters as one function."""

from __future__ import annotations

import functools
import math
import os
import re
import time
import warnings
from typing import Any, Callable, Optional, Sequence, Union

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSet, vtkPointSet, vtkPolyData

from .clouds import Cloud, make_lines, make_points
from .messages import ElevationSurfaceError, ElevationSurfaceWarning, Messages
from .paths import check_suffix
from .properties import COLOURS, PROPERTIES, checked, number_above_zero, view_angles
from .vtkElevationSurface import (
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)

# ---- input ------------------------------------------------------------------------------------


def as_cloud(points: Points) -> Cloud:
    """Points of any accepted kind as a Cloud."""
    if isinstance(points, Cloud):
        return points
    if isinstance(points, vtkPointSet):
        if points.GetNumberOfPoints() == 0:
            raise ElevationSurfaceError("points: there are none")
        return Cloud(points)
    if isinstance(points, (str, os.PathLike)):
        raise TypeError(f"points: a file's name; use reconstruct(read({os.fspath(points)!r}))")
    if isinstance(points, vtkDataSet):
        raise TypeError(f"points: {points.GetClassName()} has no elevations; a vtkPointSet has")
    return Cloud(make_points(array_of(points, "points", (3,))))


def array_of(values, what, widths):
    """(n, width) doubles. Raises TypeError or ValueError that names what it is."""
    try:
        if isinstance(values, numpy.ma.MaskedArray):
            values = values.astype("f8").filled(numpy.nan)
        array = numpy.asarray(values, dtype="f8")
    except (TypeError, ValueError):
        raise TypeError(f"{what}: not an array of numbers, one row for each point") from None
    if array.ndim != 2 or array.shape[1] not in widths or len(array) == 0:
        wide = " or ".join(str(width) for width in widths)
        shape = " x ".join(str(length) for length in array.shape) or "a single number"
        raise ValueError(f"{what}: rows of {wide} numbers are needed; the shape is {shape}")
    return array


def as_lines(lines: Lines, what: str, are_rings: bool) -> vtkPolyData:
    """vtkPolyData with lines or polygons, from such data, an array, or a list of arrays.

    An array holds the points of one line in order, (n, 3); of a ring also (n, 2), closed or not.
    """
    if isinstance(lines, vtkPolyData):
        return lines
    if isinstance(lines, (str, os.PathLike)):
        reader = "read_boundary" if are_rings else "read_faults"
        raise TypeError(f"{what}: a file's name; use {reader}({os.fspath(lines)!r})")
    try:
        is_one = numpy.ndim(lines[0]) == 1
    except (TypeError, IndexError, KeyError, ValueError):
        raise TypeError(f"{what}: vtkPolyData, an array, or a list of arrays is needed") from None
    parts = []
    for line in [lines] if is_one else lines:
        line = array_of(line, what, (2, 3) if are_rings else (3,))
        if line.shape[1] == 2:
            line = numpy.column_stack((line, numpy.zeros(len(line))))
        if are_rings and (line[0] != line[-1]).any():
            line = numpy.vstack((line, line[:1]))
        if are_rings and len(line) < 4:
            raise ValueError(f"{what}: a ring has {len(line) - 1} points; 3 are needed")
        parts.append(line)
    return make_lines(parts)


# ---- the chain --------------------------------------------------------------------------------

STEPS = {"delaunay": "triangulating", "trim": "trimming", "fill": "filling holes"}


class Reconstruction:
    """A surface, and all that is known of how it came about.

    surface   vtkPolyData with triangles
    boundary  vtkPolyData, the rings that bound the surface; None without trimming
    holes     vtkPolyData, the outline of each hole, filled or not; None without filling
    delaunay, trim, fill   the filters that have run; None for those left out
    cloud     the points and what their reader found out
    times     {step: seconds}
    notes     what filters warned of, one line each
    """

    def __init__(self, cloud):
        self.cloud = cloud
        self.times = {}
        self.notes = []
        self.delaunay = self.trim = self.fill = None
        self.progress = None  # what run_chain() was given
        self.boundary_name = None  # where a given boundary is from
        self.faults_name = None
        self.why_opened = None

    @property
    def surface(self) -> vtkPolyData:
        return (self.fill or self.trim or self.delaunay).GetOutput()

    @property
    def crs(self) -> Optional[str]:
        """The coordinate reference system as WKT or AUTHORITY:CODE; None where it is not known."""
        return self.cloud.crs

    @property
    def boundary(self) -> Optional[vtkPolyData]:
        return self.trim.GetOutput(2) if self.trim else None

    @property
    def holes(self) -> Optional[vtkPolyData]:
        return self.fill.GetOutput(1) if self.fill else None

    @functools.cached_property
    def report(self) -> dict:
        """All that reconstruct tells of a run, as a dictionary of numbers and words.

        Made when first asked for: measuring the distance of the points takes time.
        """
        from .report import make_report

        return make_report(self)

    def measuring(self, fraction):
        """Progress of the report."""
        if self.progress:
            self.progress("measuring", fraction)

    def to_numpy(self) -> tuple[numpy.ndarray, numpy.ndarray]:
        """(points, triangles): (n, 3) float64, and (m, 3) integers that number the points.

        The input's points come first, in their order, also those that no triangle uses.
        """
        points = vtk_to_numpy(self.surface.GetPoints().GetData()).astype("f8")
        ids = vtk_to_numpy(self.surface.GetPolys().GetConnectivityArray())
        return points, ids.reshape(-1, 3).copy()

    def write(self, path: Union[str, os.PathLike]) -> list[str]:
        """Writes the surface in the format of the suffix: .vtp .vtu .ply .stl .obj .glb .ts.

        Returns notes, one line each. Raises FileError for another suffix.
        """
        from .writing import WRITE_SUFFIXES, write_surface

        path = os.fspath(path)
        check_suffix(path, WRITE_SUFFIXES, "written")
        return write_surface(self.surface, path, self.crs)

    def __repr__(self):
        return (
            f"<Reconstruction: {self.cloud.points.GetNumberOfPoints():,} points, "
            f"{self.surface.GetNumberOfPolys():,} triangles>"
        )

    def to_grid(self, step: float) -> Any:
        """The surface at the centres of square pixels, interpolated in its triangles.

        Returns a Grid with z, (rows, columns) and NaN outside; x, (columns,); y, (rows,), falling;
        and error, (rows, columns) or None. The edges of pixels are multiples of step. Raises
        ElevationSurfaceError for a step that is too small or too large.
        """
        from .writing.grids import grid_of

        try:
            step = number_above_zero(step)
        except ValueError:
            raise ValueError(f"step takes a number above 0, not {step}") from None
        return grid_of(self.surface, step)

    def plot(
        self,
        path: Union[str, os.PathLike],
        title: str = "",
        *,
        view: Union[tuple[float, float], str, None] = None,
        exaggeration: Optional[float] = None,
        colours: str = "elevation",
    ) -> dict[str, float]:
        """Draws the surface into a PNG file.

        view          (bearing, height) of the eye in degrees, or "top"; None: chosen
        exaggeration  the factor for z; None: chosen
        colours       "elevation", or "error" for the standard error of filled elevations

        Returns what was chosen. Needs no screen where Xvfb is installed. Raises ElevationSurfaceError
        where nothing can be drawn.
        """
        from .picture import draw
        from .report import picture_subtitle

        path = os.fspath(path)
        check_suffix(path, (".png",), "written as a picture")
        if colours not in COLOURS:
            raise ValueError(f"colours takes elevation or error, not {colours!r}")
        if view is not None:
            view = view_angles(view)
        return draw(
            self.surface,
            path,
            title,
            picture_subtitle(self),
            self.holes,
            view=view,
            exaggeration=exaggeration,
            show_errors=colours == "error",
        )


class _Step:
    """Runs a filter with progress. Its errors are raised, its warnings become notes."""

    def __init__(self, result, progress, strict):
        self.result = result
        self.progress = progress
        self.strict = strict

    def __call__(self, name, algorithm):
        raised = []

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
        with Messages(algorithm, algorithm.GetExecutive()) as messages:
            algorithm.Update()
        self.result.times["triangulate" if name == "delaunay" else name] = (
            time.perf_counter() - began
        )
        algorithm.RemoveObserver(tag)
        if raised:
            raise raised[0]
        problems = messages.errors + (messages.warnings if self.strict else [])
        if problems:
            about = "points"
            if name == "trim" and self.result.boundary_name:
                about = "boundary"
            elif name == "delaunay" and "constraints" in problems[0]:
                about = "faults"
            raise ElevationSurfaceError(f"{STEPS[name]}: {problems[0]}", about)
        for warning in messages.warnings:
            # A filter may tell of several holes in one message.
            for sentence in re.sub(r"\. (?=Hole \d)", ".\n", warning).split("\n"):
                self.result.notes.append(f"{STEPS[name]}: {sentence}")
        return algorithm


def run_chain(
    cloud, boundary, faults, given, *, trim=True, fill=True, progress=None, strict=False
):
    """reconstruct() on what has been checked: a Cloud, vtkPolyData or None, and checked()."""
    result = Reconstruction(cloud)
    result.progress = progress
    result.boundary_name = "given" if boundary is not None else None
    result.faults_name = "given" if faults is not None else None
    run = _Step(result, progress, strict)

    def made(step, algorithm):
        for name, value in given.items():
            if PROPERTIES[name].step in (step, ""):
                getattr(algorithm, PROPERTIES[name].setter)(value)
        return algorithm

    delaunay = made("delaunay", vtkGridDelaunay2D())
    delaunay.SetInputData(cloud.points)
    if faults is not None:
        delaunay.SetSourceData(faults)
    result.delaunay = last = run("delaunay", delaunay)
    if delaunay.GetOutput().GetNumberOfPolys() == 0:
        limit = given.get("maximum_edge_length", 0.0)
        raise ElevationSurfaceError(why_no_triangle(cloud.points, limit, result.notes))
    if trim:
        trimming = made("trim", vtkTrimOutwardTriangles())
        trimming.SetInputData(0, last.GetOutput())
        if boundary is not None:
            trimming.SetBoundaryData(boundary)
        result.trim = last = run("trim", trimming)
        if trimming.GetOutput().GetNumberOfPolys() == 0:
            raise ElevationSurfaceError(
                "no triangle lies inside the boundary; are boundary and points in the same "
                "coordinates?",
                "boundary" if boundary is not None else "points",
            )
    if fill:
        filling = made("fill", vtkFillElevationHoles())
        filling.SetInputData(last.GetOutput())
        if "open_edge_length" in given:
            result.why_opened = "as given"
        else:
            length, result.why_opened = length_to_open(last.GetOutput(), boundary is not None)
            of_cell = CELL_DIAGONALS * cloud.largest_cell
            if 0 < length < of_cell:
                length = of_cell
                result.why_opened = f"{CELL_DIAGONALS:g} diagonals of the grid's largest cell"
            filling.SetMaximumEdgeLength(length)
        result.fill = run("fill", filling)
    return result


Points = Union[Cloud, vtkPointSet, numpy.ndarray, Sequence]
Lines = Union[vtkPolyData, numpy.ndarray, Sequence, None]


def reconstruct(
    points: Points,
    *,
    boundary: Lines = None,
    faults: Lines = None,
    trim: bool = True,
    fill: bool = True,
    progress: Optional[Callable[[str, float], None]] = None,
    **properties: Any,
) -> Reconstruction:
    """Reconstructs an elevation surface z = f(x, y) from points.

    points    (n, 3) array of x, y, z, whose values are taken as they are; a vtkPointSet or PyVista mesh, whose points and point data are
              used; or what read() returns
    boundary  closed lines that bound the surface: vtkPolyData, an (n, 2) or (n, 3) array, or a list
              of such arrays; None: found from the points
    faults    lines that become edges: vtkPolyData, an (n, 3) array, or a list of such arrays
    trim      False keeps all triangles, also those outside the boundary
    fill      False leaves all holes open
    progress  None, or a function that is called with a step's name and its fraction done; what it
              raises stops the filter
    properties  of the filters, named as the options of the command line, with underscores:
              maximum_edge_length, duplicates, lattice_mode, lattice_tolerance, search_strategy,
              outward_test, gap_tolerance, recover_boundary, open_edge_length, maximum_hole_size,
              maximum_hole_edges, spacing, interpolation, interpolate_point_data, threads. Lengths
              are in the units of x and y. The program's --help tells what each does, and its default.

    Returns a Reconstruction. Raises ElevationSurfaceError with the filter's message where no surface
    can be made, TypeError for unknown properties, ValueError for values that a property does not
    take. What a filter warns of is an ElevationSurfaceWarning and in the notes. Takes about a second
    for a million points.
    """
    given = checked(properties)
    cloud = as_cloud(points)
    if boundary is not None:
        boundary = as_lines(boundary, "boundary", True)
    if faults is not None:
        faults = as_lines(faults, "faults", False)
    check_spacing(cloud.points, given.get("spacing", 0.0))
    result = run_chain(cloud, boundary, faults, given, trim=trim, fill=fill, progress=progress)
    for note in result.notes:
        warnings.warn(note, ElevationSurfaceWarning, stacklevel=2)
    return result


# Above this multiple, edges bridge missing nodes of a grid, or the space between survey lines.
CELL_DIAGONALS = 1.5
SPACINGS_ALONG = 2.0
# Triangles of lines: the longest edge is this multiple of the shortest. They cover more than half of
# a survey of lines at least 10 spacings apart, also with jitter of half a spacing, and at most a
# tenth of anything else.
LEAST_RATIO_OF_LINES = 3.0
# A full grid has triangles of half a cell; a thinned one, whose nodes are not missing, larger ones.
MOST_CELLS_OF_FULL_GRID = 0.75
MOST_SAMPLES = 1_000_000  # triangles: of more, every k-th stands for k


def lattice_of(fields):
    """The lattice that was found, or None: a node, two steps, their lengths and their directions.

    Directions are in degrees from x to y.
    """
    array = fields.GetArray("Lattice")
    if array is None:
        return None
    origin, *steps = numpy.reshape(array.GetTuple(0), (3, 2)).tolist()
    return {
        "origin": origin,
        "steps": steps,
        "lengths": [math.hypot(*step) for step in steps],
        "directions": [math.degrees(math.atan2(step[1], step[0])) for step in steps],
    }


def length_to_open(surface, has_boundary):
    """The length above which edges are opened, to be filled like holes, and why; (0, None): none."""
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    if has_boundary or len(triangles) == 0:
        # The edges of a boundary may be long where nothing is missing.
        return 0.0, None
    triangles = triangles[:: 1 + len(triangles) // MOST_SAMPLES]
    xy = vtk_to_numpy(surface.GetPoints().GetData())[:, :2]
    a, b, c = (xy[triangles[:, i]].astype("f8") for i in range(3))
    area = 0.5 * numpy.abs(
        (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    )
    lattice = lattice_of(surface.GetFieldData())
    if lattice:
        u, v = (numpy.array(step) for step in lattice["steps"])
        cell = abs(u[0] * v[1] - u[1] * v[0])
        if numpy.median(area) <= MOST_CELLS_OF_FULL_GRID * cell:
            diagonal = float(max(numpy.hypot(*(u + v)), numpy.hypot(*(u - v))))
            return CELL_DIAGONALS * diagonal, f"{CELL_DIAGONALS:g} diagonals of the grid's cells"
    lengths = numpy.sort(
        numpy.column_stack([numpy.hypot(*(q - p).T) for p, q in ((a, b), (b, c), (c, a))]), axis=1
    )
    is_between = lengths[:, 2] > LEAST_RATIO_OF_LINES * lengths[:, 0]
    if area[is_between].sum() > 0.5 * area.sum():
        along = float(numpy.median(lengths[:, 0]))
        return SPACINGS_ALONG * along, f"{SPACINGS_ALONG:g} spacings of {along:.4g} along lines"
    return 0.0, None


def check_spacing(points, spacing):
    """Refuses a spacing that no hole could be filled at, before any work is done."""
    xy = vtk_to_numpy(points.GetPoints().GetData())[:, :2]
    xy = xy[numpy.isfinite(xy).all(axis=1)]
    if spacing and len(xy):
        # The filter needs four steps between points that can be told apart.
        step = float(numpy.spacing(numpy.abs(xy).max(axis=1).min()))
        if spacing < 4 * step:
            raise ValueError(
                f"spacing: {spacing:g} is less than x and y of the points can tell apart, which are in "
                f"steps of {step:.3g}"
            )


def why_no_triangle(points, limit, notes):
    """The reason in words when the triangulation is empty; notes: what the filter warned of."""
    xyz = vtk_to_numpy(points.GetPoints().GetData())
    count = len(xyz)
    finite = xyz[numpy.isfinite(xyz).all(axis=1)]
    distinct = numpy.unique(finite[:, :2], axis=0)
    total = "the only point" if count == 1 else f"all {count:,} points"
    if len(finite) == 0:
        return f"no surface: {total} {'is' if count == 1 else 'are'} not finite (NaN or infinite)"
    if count == 1:
        return "no surface: there is only one point; three not on a line are needed"
    if len(distinct) == 1:
        x, y = distinct[0]
        where = f"({x:.10g}, {y:.10g})"
        return f"no surface: all {len(finite):,} finite points have the same x,y {where}"
    if len(distinct) == 2:
        return "no surface: only two points differ in x,y; three not on a line are needed"
    away = distinct - distinct[0]
    far = away[numpy.argmax((away**2).sum(axis=1))]
    offset = numpy.abs(away[:, 0] * far[1] - away[:, 1] * far[0]).max() / (far @ far)
    if offset < 1e-12 or not limit:
        a, b = distinct[0], distinct[-1]
        return (
            f"no surface: all {len(finite):,} finite points lie on one line in x,y, from "
            f"({a[0]:.10g}, {a[1]:.10g}) to ({b[0]:.10g}, {b[1]:.10g})"
        )
    advice = re.search(r"Between neighbours.*", " ".join(notes))
    advice = advice.group().replace("MaximumEdgeLength", "maximum_edge_length") if advice else ""
    return (
        f"no surface: no triangle has edges of at most {limit:g}; "
        f"use a larger maximum_edge_length. {advice}".rstrip()
    )
