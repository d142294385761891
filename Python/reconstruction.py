# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points in, surface out: the chain of the three filters as one function."""

from __future__ import annotations

import functools
import os
import warnings
from typing import Any, Callable, Optional, Sequence, Union

import numpy
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray,
    vtkDataSet,
    vtkImageData,
    vtkPointSet,
    vtkPolyData,
    vtkRectilinearGrid,
)

from .clouds import Cloud, check_ids, coordinates_of, make_lines, make_points, slices, triangles_of
from .description import KINDS, listing, view_angles
from .given_lines import RINGS, fitted
from .several_heights import check_heights, heights_on_ranks
from .holes import BridgedVoids, hole_counts
from .lost_faults import note_on_lost_faults
from .messages import ElevationSurfaceError, ElevationSurfaceWarning, counted
from .names import argument
from .open_edge_length import length_to_open
from .paths import check_suffix
from .planes import in_plane, turn_back
from .properties import COLOURS, PROPERTIES, check_together, checked, is_simplified
from .ranks import extremes, total
from .reading.arrays import column_cloud, grid_cloud, named_columns
from .reading.facing import find_faces, notes_on_faces
from .spreading import ORIGINAL_IDS, follow_points, last_id, original_ids, used_points, without_unused
from .steps import DensityKeeper, Kept, Step, state_of, triangulate, trim_along, trim_few
from .vtkElevationSurface import vtkFillElevationHoles

# ---- input ------------------------------------------------------------------------------------


def as_cloud(points: Points, x: Any = None, y: Any = None) -> Cloud:
    """Points of any accepted kind as a Cloud; x and y are those of a grid."""
    if x is not None or y is not None:
        return grid_cloud("points", array_of(points, "points", None), x, y)
    if isinstance(points, Cloud):
        return points
    if isinstance(points, vtkPointSet):
        if points.GetNumberOfPoints() == 0:
            raise ElevationSurfaceError("points: there are none")
        return mesh_cloud(points)
    if isinstance(points, (str, os.PathLike)):
        raise TypeError(f"points: a file's name; use reconstruct(read({os.fspath(points)!r}))")
    if isinstance(points, (vtkImageData, vtkRectilinearGrid)) and points.GetNumberOfPoints():
        from .reading.vtk_files import grid_points

        return grid_points("points", points)
    if isinstance(points, vtkDataSet):
        raise TypeError(f"points: {points.GetClassName()} has no elevations; a vtkPointSet has")
    fields = getattr(getattr(points, "dtype", None), "names", None)
    if fields or hasattr(points, "keys"):
        return column_cloud("points", *named_columns("points", points))
    array = array_of(points, "points", None)
    if array.shape[1] != 3:
        raise ValueError(
            f"points: rows of 3 numbers are needed, or x= and y= of a grid; the shape is {shape_of(array)}"
        )
    return Cloud(make_points(array))


def mesh_cloud(points):
    """The points of a vtkPointSet. Raises ElevationSurfaceError where faces are not an elevation surface.
    """
    from .reading.vtk_files import with_hidden_nodes

    faces = find_faces(points)
    try:
        return Cloud(with_hidden_nodes(points), notes_on_faces(faces) if faces else ())
    except ElevationSurfaceError as error:
        raise ElevationSurfaceError(
            f"points: the mesh {error}, or give its points alone, as an array"
        ) from None


def array_of(values, what, widths):
    """(n, width) doubles; widths: those allowed, None: any. Raises TypeError or ValueError that names what it is."""
    try:
        if isinstance(values, numpy.ma.MaskedArray):
            values = values.astype("f8").filled(numpy.nan)
        array = numpy.asarray(values, dtype="f8")
    except (TypeError, ValueError):
        raise TypeError(f"{what}: not an array of numbers, one row for each point") from None
    if array.ndim != 2 or widths and array.shape[1] not in widths or len(array) == 0:
        wide = " or ".join(str(width) for width in widths or (3,))
        raise ValueError(f"{what}: rows of {wide} numbers are needed; the shape is {shape_of(array)}")
    return array


def shape_of(array):
    return " x ".join(str(length) for length in array.shape) or "a single number"


def as_lines(lines: Lines, what: str, are_rings: bool) -> vtkPolyData:
    """vtkPolyData with lines or polygons, from such data, an array, or a list of arrays.

    An array holds the points of one line in order, (n, 3) or, without z, (n, 2); a ring is closed or
    not.
    """
    if isinstance(lines, vtkPolyData):
        check_ids(lines, what)
        return lines
    if isinstance(lines, (str, os.PathLike)):
        reader = "read_boundary" if are_rings else "read_faults"
        raise TypeError(f"{what}: a file's name; use {reader}({os.fspath(lines)!r})")
    if isinstance(lines, (list, tuple, numpy.ndarray)) and getattr(lines, "ndim", 1) and len(lines) == 0:
        raise ValueError(f"{what}: is empty; leave it out, or give None, where there is none")
    try:
        is_one = numpy.ndim(lines[0]) == 1
    except (TypeError, IndexError, KeyError, ValueError):
        raise TypeError(f"{what}: vtkPolyData, an array, or a list of arrays is needed") from None
    parts = []
    for line in [lines] if is_one else lines:
        line = array_of(line, what, (2, 3))
        if line.shape[1] == 2:
            line = numpy.column_stack((line, numpy.full(len(line), numpy.nan)))
        if are_rings and (len(line) == 1 or (line[0, :2] != line[-1, :2]).any()):
            line = numpy.vstack((line, line[:1]))
        if are_rings and len(line) < 4:
            raise ValueError(f"{what}: a ring has {counted(len(line) - 1, 'point')}; 3 are needed")
        parts.append(line)
    names = ["the line"] if is_one else [f"line {i} of the list" for i in range(len(parts))]
    return make_lines(parts, names)


# ---- the chain --------------------------------------------------------------------------------

AREA_MODES = {
    "fill_only": vtkFillElevationHoles.FILL_ONLY, "keep_open": vtkFillElevationHoles.KEEP_OPEN,
}
AS_GIVEN = "as given"  # the length of edges above which triangles are opened


class Reconstruction:
    """A surface, and how it came about.

    ranks     the controller of those that have a part of it each, or None. Counts and the report are
              those of all
    surface   vtkPolyData with triangles, without points that these do not use: its point array
              OriginalPointIds has the numbers of points in the input (those of an array of this
              name, or else global ids, if it has them), -1 of added ones
    complete  the same with all points, those of the input first; surface itself with
              remove_unused_points=False
    boundary  vtkPolyData, the rings that bound the surface; None without trimming
    holes     vtkPolyData, the outline of each hole, filled or not; None without filling
    delaunay, trim, fill   the filters that have run; None for those left out
    outlined  (delaunay, trim) that have found the outline of all points, where a surface of few of
              them is trimmed; else None
    cloud     the points and what their reader found out
    triangles {"delaunay": count, "trimmed": count, "filled": count} after each step
    several   {"places", "of", "largest"}: how many of all places have several heights, and the
              largest difference; None where none has
    number_of_points   of the input
    points    the output of a filter in which points of the input come first
    reasons   (n,) numbers of these: 0 for points in triangles of the triangulation, or why they are in
              none, as vtkGridDelaunay2D counts reasons; IN_NO_TRIANGLE where it has none
    bridged   which of the holes are voids that triangles bridge, see BridgedVoids
    hole_counts        (found, filled)
    lattice   that of the triangulation, see lattice_of(), or None
    times     {step: seconds}
    notes     the warnings of filters, one line each
    warnings  the same as Messages, as the filters make them
    decided   notes on what the user has decided
    gathered  why a filter has brought all points to one rank, one line each
    """

    def __init__(self, cloud, ranks=None):
        self.cloud, self.ranks = cloud, ranks
        self.times = {}
        self.notes, self.decided, self.warnings, self.gathered = [], [], [], []
        self.delaunay = self.trim = self.fill = self.outlined = None
        self.surface = self.complete = self.boundary = self.holes = None
        self.removes_unused = False
        self.triangles, self.points, self.reasons, self.lattice = {}, None, None, None
        self.number_of_points, self.bridged, self.hole_counts = 0, None, (0, 0)
        self.progress = None  # what run_chain() was given
        self.boundary_name = None  # where a given boundary is from
        self.faults_name = None
        self.open_edge_length, self.why_opened = 0.0, None  # above which triangles are opened
        self.several = None

    @property
    def coordinates(self) -> numpy.ndarray:
        """(n, 3), the points that reasons are of."""
        return coordinates_of(self.points)[: len(self.reasons)]

    @functools.cached_property
    def used(self) -> numpy.ndarray:
        """(m,) of bool: which points of complete are corners of triangles, on any rank."""
        return used_points(self.ranks, self.complete)

    @property
    def crs(self) -> Optional[str]:
        """The coordinate reference system as WKT or AUTHORITY:CODE; None where it is not known."""
        return self.cloud.crs

    @functools.cached_property
    def report(self) -> dict:
        """Everything reconstruct reports about a run, as a dictionary of numbers and words.

        Made when first asked for, by all ranks: measuring the distance of the points takes time.
        """
        from .report import make_report

        return make_report(self)

    def drop_unused(self, frees=False):
        """Makes surface of complete, without the points that it does not use; frees: complete is None then."""
        last = last_id(self.ranks, self.cloud.points)
        self.surface = without_unused(self.ranks, self.complete, self.used, last, frees)
        if frees:
            self.complete = None

    def free_points(self):
        """Frees the points and what the filters hold, which nothing but the report needs."""
        self.cloud.points, self.points = vtkPolyData(), None
        kept = self.surface, self.boundary, self.holes
        for step in filter(None, (self.delaunay, self.trim, self.fill, *(self.outlined or ()))):
            step.SetInputDataObject(0, None)
            for port in range(step.GetNumberOfOutputPorts()):
                if not any(step.GetOutput(port) is one for one in kept):
                    step.GetOutput(port).Initialize()

    def measuring(self, fraction):
        """Progress of the report."""
        if self.progress:
            self.progress("measuring", fraction)

    def to_numpy(self) -> tuple[numpy.ndarray, numpy.ndarray]:
        """(points, triangles): (n, 3) float64, and (m, 3) integers that number the points.

        Points of the input come first, in their order; surface has their numbers in the input.
        """
        return coordinates_of(self.surface).astype("f8"), triangles_of(self.surface).copy()

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

    def to_grid(
        self, step: Optional[float] = None, *, like: Any = None, method: str = "linear"
    ) -> Any:
        """The surface at the centres of pixels.

        step  the width of square pixels, whose edges are multiples of it. None, or that of the raster
              or regular grid that the points are from: on the pixels of that
        like  a Grid, what read() returns of a raster, or the file of one: on its pixels
        method  "linear", in triangles, or "natural-neighbor", as of elevation_at()

        Returns a Grid with z, (rows, columns) and NaN outside; x, (columns,); y, (rows,), falling;
        and error, (rows, columns) or None. Grids of the same pixels can be subtracted, and write()
        writes one. Raises ElevationSurfaceError for a step that is too small or too large, and for
        like where it is not a raster or has another coordinate reference system.
        """
        from .writing.grids import grid_of

        if self.cloud.plane:
            raise ElevationSurfaceError("a surface with plane=best is not a grid over x,y")
        try:
            step = None if step is None else KINDS["step"].convert(step)
        except ValueError:
            raise ValueError(f"step takes a number above 0, not {step}") from None
        if step is not None and like is not None:
            raise ValueError("step or like, not both")
        grid, notes = grid_of(self, step, like, method=method)
        for note in notes:
            warnings.warn(note, ElevationSurfaceWarning, stacklevel=2)
        return grid

    def elevation_at(
        self, xy: Any, method: str = "linear", *, return_errors: bool = False
    ) -> Union[numpy.ndarray, tuple[numpy.ndarray, Optional[numpy.ndarray]]]:
        """The elevations of the surface at places, (n,), NaN outside of it.

        xy      (n, 2) array of x and y; further columns are not used
        method  "linear", in the triangle; or "natural-neighbor", by the weights of Sibson (1981), of the
                points of the surface: smooth but at these points. It does not stop at faults
        return_errors  returns (elevations, errors) instead: the standard errors of what was filled, 0 in
                other triangles, NaN where it is not known; None where nothing was filled

        Takes about 1.4 seconds for a million places. Raises ValueError for arrays of another shape, and
        ElevationSurfaceError for a surface with plane=best.
        """
        from .query import Heights, check_over_xy, places_of

        check_over_xy(self, "elevation")
        elevations, errors = Heights(self.surface, method).at(places_of(xy))
        return (elevations, errors) if return_errors else elevations

    def volume_above(self, other: Any) -> Any:
        """The volume between the surface and another one, or a level, over the area that both cover.

        other  a Reconstruction, vtkPolyData with triangles, the file of a surface, or a level

        Returns a Volume with above and below, the cut and the fill that lead to the other one; net, above - below; area; left_out and other_left_out, the areas that one alone
        covers; and error, the standard error of net that follows from filled elevations. Exact but
        for rounding. Raises ElevationSurfaceError where they do not overlap, and FileError for another
        coordinate reference system.
        """
        from .query import volume_between

        volume, _, notes = volume_between(self, other)
        for note in notes:
            warnings.warn(note, ElevationSurfaceWarning, stacklevel=2)
        return volume

    def difference(self, other: Any) -> vtkPolyData:
        """A map of how far the surface is above another one, or a level: triangles whose z, and point
        array Difference, is that. Arguments and errors are those of volume_above()."""
        from .query import volume_between

        _, difference, notes = volume_between(self, other, map_too=True)
        for note in notes:
            warnings.warn(note, ElevationSurfaceWarning, stacklevel=2)
        return difference

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
            self.cloud.plane,
            view=view,
            exaggeration=exaggeration,
            show_errors=colours == "error",
        )


def run_chain(
    cloud, lines, given, *, trim=True, fill=True, progress=None, strict=False, ranks=None,
    heights=None, keep_steps=True, kept=None,
):
    """reconstruct() on what has been checked: a Cloud, lines as fitted() returns them, and checked().

    ranks  the controller of those that run it together, or None. Each has some of the points; lines
           may be on one or on all, but all have the same names. Each gets its part
    heights  what check_heights() has given where one rank had all points
    keep_steps  False frees the triangles of a filter's output once the next has run, and leaves
           drop_unused() to the caller, unless there are ranks
    kept  None, or the Kept of the last run on the same cloud
    """
    result = Reconstruction(cloud, ranks)
    boundary, faults = lines.get("boundary"), lines.get("faults")
    result.progress = progress
    result.boundary_name = "given" if boundary is not None else None
    result.faults_name = "given" if faults is not None else None
    policy = given.get("duplicates")
    run = Step(result, given, progress, strict, ranks, kept)
    if is_simplified(given) and trim:
        trim_few(run, boundary, faults)
    else:
        triangulate(run, faults)
        if trim:
            trim_along(run, boundary)
            result.boundary = result.trim.GetOutput(2)
            if not keep_steps:
                free_triangles(result.delaunay)
    note, result.several = heights or heights_on_ranks(ranks, result, policy)
    if note:
        (result.decided if "duplicates" in given else result.notes).insert(0, note)
    last = result.trim or result.delaunay
    if fill:
        filling = run.configure("fill", vtkFillElevationHoles())
        filling.SetInputData(last.GetOutput())
        if boundary is None:
            filling.FillCutOutsOn()  # an outline of few points does not count as a given boundary
        for name, mode in AREA_MODES.items():
            if name in lines:
                filling.SetAreasData(lines[name])
                filling.SetAreaMode(mode)
        if "open_edge_length" in given:
            result.open_edge_length, result.why_opened = given["open_edge_length"], AS_GIVEN
        elif not is_simplified(given):  # else long edges are not voids
            length, result.why_opened = run.kept.result(
                "open edge length", (state_of([last.GetOutput()]), result.boundary_name),
                lambda: length_to_open(ranks, last.GetOutput(), result), ranks,
            )
            filling.SetOpenEdgeLength(length)
            result.open_edge_length = length
        result.fill = last = filling = run("fill", filling, DensityKeeper(run, filling))
        result.triangles["filled"] = total(ranks, last.GetOutput().GetNumberOfPolys())
        result.holes = filling.GetOutput(1)
        voids = BridgedVoids(result.holes, ranks)
        voids.see(last.GetOutput())
        result.bridged = voids.find()
        if not keep_steps:
            free_triangles(result.trim or result.delaunay)
        result.hole_counts = hole_counts(ranks, result)
    if faults is not None and boundary is None and not is_simplified(given):
        lost = note_on_lost_faults(ranks, last.GetOutput(), faults, cloud.plane is not None)
        if lost and strict:
            raise ElevationSurfaceError(lost[0], "faults")
        result.notes += lost
    run.kept.forget_steps(run.count + 1)
    result.surface = result.complete = last.GetOutput()
    result.points, result.reasons = follow_points(
        ranks, result.points, result.reasons, result.complete, cloud.points
    )
    result.removes_unused = given.get("remove_unused_points", True)
    if result.removes_unused:
        replaced = replaced_ids(cloud.points)
        if strict and replaced:
            raise ElevationSurfaceError(replaced[0])
        result.notes += replaced
        if keep_steps or ranks:
            result.drop_unused()
    if cloud.plane:
        turn_back(result)
    return result


def free_triangles(step):
    """Frees the memory of triangles that nobody reads any more, some 30 bytes each."""
    step.GetOutput().SetPolys(vtkCellArray())


def replaced_ids(points):
    """A note on an array that gives way to that of original ids, or none."""
    if not points.GetPointData().HasArray(ORIGINAL_IDS) or original_ids(points) is not None:
        return []
    return [
        f"the point array {ORIGINAL_IDS} is not one signed integer for each point, so it is replaced "
        "by their global ids or numbers; rename it to keep it"
    ]


def reconstruct_cloud(
    cloud, lines, names, given, *, strict=False, ranks=None, kept=None, **options
):
    """run_chain() on points and lines as they come.

    lines, names  as fitted() takes them
    """
    kept = kept or Kept()

    def once(name, make, *key):  # for this cloud
        return kept.result(name, (state_of([cloud.points]), *key), make, ranks)

    given_names = {**dict.fromkeys(lines, True), "level_attribute": given.get("level_attribute")}
    check_together(given_names, argument, NAMES)
    reach = once("reach", lambda: least_reach(cloud.points, ranks))
    check_spacing(reach, given.get("spacing", 0.0))
    cloud, lines = in_plane(cloud, lines, given, ranks)
    # Lines that are draped lie on a surface of the points.
    others = {name: given[name] for name in given if PROPERTIES[name].step not in ("trim", "fill")}
    lines, notes = once(
        "lines", lambda: fitted(cloud, lines, names, given, strict, ranks),
        state_of(lines.values()), list(lines), names, strict, others,
    )
    if not ranks:
        policy = given.get("duplicates")
        options["heights"] = once("heights", lambda: check_heights(cloud, policy), policy)
    result = run_chain(cloud, lines, given, strict=strict, ranks=ranks, kept=kept, **options)
    result.notes[:0] = notes
    return result


NAMES = {
    "points": "the points", "boundary": "the boundary", "faults": "the faults",
    "fill_only": "fill_only", "keep_open": "keep_open",
}
Points = Union[Cloud, vtkPointSet, numpy.ndarray, Sequence]
Lines = Union[vtkPolyData, numpy.ndarray, Sequence, None]


@listing(PROPERTIES)
def reconstruct(
    points: Points,
    *,
    x: Any = None,
    y: Any = None,
    boundary: Lines = None,
    faults: Lines = None,
    fill_only: Lines = None,
    keep_open: Lines = None,
    trim: bool = True,
    fill: bool = True,
    progress: Optional[Callable[[str, float], None]] = None,
    strict: bool = False,
    **properties: Any,
) -> Reconstruction:
    """Reconstructs an elevation surface z = f(x, y) from points.

    points    (n, 3) array of x, y, z, whose values are taken as they are; columns by name: a dictionary,
              a table of pandas or an array with fields; a (rows, columns) array of elevations, with x
              and y; a vtkPointSet or PyVista mesh, whose points and point data are used; a flat
              vtkImageData or vtkRectilinearGrid, whose active point scalars are elevations, NaN where
              there is none; or what read() returns
    x, y      of a grid: of its columns and rows, or of each of its nodes
    boundary  closed lines that bound the surface: vtkPolyData, an (n, 2) or (n, 3) array, or a list
              of such arrays; None: found from the points. Gaps of up to 1 % of a ring's length are
              closed, and rings that cross themselves made valid (that needs python3-gdal)
    faults    lines that become edges: vtkPolyData, an (n, 3) array, or a list of such arrays; those
              of (n, 2), and others without z, follow the surface of the points (see faults_z)
    fill_only, keep_open  polygons, as boundary: only holes that touch one are filled, or they stay
              open; one of both. A ring inside another one is no area
    trim      False keeps all triangles, also those outside the boundary
    fill      False leaves all holes open
    progress  None, or a function that is called with a step's name and its fraction done; what it
              raises stops the filter
    strict    True: mends of boundary and faults, and warnings of the filters, are errors
    properties  of the filters, named as the options of the command line, with underscores:
              {properties}.
              Lengths are in the units of x and y. The program's --help describes each, with
              its default.

    Returns a Reconstruction. Raises ElevationSurfaceError with the filter's message where no surface
    can be made; where places have the heights of several surfaces, unless duplicates says which to
    take; and where the faces of a mesh are not an elevation surface. Raises TypeError for
    unknown properties, ValueError for values that a property does not take. A filter's warning
    is an ElevationSurfaceWarning and in the notes. Takes about a second for a million points.
    """
    given = checked(properties)
    cloud = as_cloud(points, x, y)
    lines = {"boundary": boundary, "faults": faults, "fill_only": fill_only, "keep_open": keep_open}
    lines = {
        name: as_lines(data, name, name in RINGS) for name, data in lines.items() if data is not None
    }
    result = reconstruct_cloud(
        cloud, lines, NAMES, given, strict=strict, trim=trim, fill=fill, progress=progress
    )
    for note in result.notes:
        warnings.warn(note, ElevationSurfaceWarning, stacklevel=2)
    return result


def least_reach(points, ranks=None):
    """The larger of |x| and |y| of the point where that is least; infinity without points."""
    xyz, least = coordinates_of(points), [numpy.inf]
    for rows in slices(len(xyz)):
        reach = numpy.maximum(*numpy.abs(xyz[rows, :2].T))  # NaN where one is
        least.append(extremes(None, reach[numpy.isfinite(reach)])[0])
    return extremes(ranks, numpy.array(least))[0]


def check_spacing(reach, spacing):
    """Refuses a spacing that no hole could be filled at, before any work is done.

    reach  least_reach() of all points
    """
    if spacing and reach < numpy.inf:
        # The filter needs four steps between points that differ.
        step = float(numpy.spacing(reach))
        if spacing < 4 * step:
            raise ValueError(
                f"{argument('spacing')}: {spacing:g} is too small: x and y of the points are in steps of "
                f"{step:.3g}"
            )
