#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reconstructs an elevation surface from a file of points: read, triangulate on the grid, trim
outward triangles, fill holes, measure, write, draw.

Needs the module on PYTHONPATH, and a display or Xvfb for the picture. Utilities/reconstruct cares
for both.
The chain itself is in reconstruct(); everything around it is files, options and the report.
"""

import argparse
import json
import math
import os
import re
import signal
import sys
import time

from virtual_display import VirtualDisplay

# What is missing is told by main(), in words; --help works without.
MISSING = None
try:
    import numpy
    import surface_files as files
    from vtkelevationsurface import (
        vtkFillElevationHoles,
        vtkGridDelaunay2D,
        vtkTrimOutwardTriangles,
    )
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkDoubleArray
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance
except ImportError as error:
    MISSING = error.name

HELP = os.path.join(os.path.dirname(os.path.abspath(__file__)), "reconstruct_help.txt")


class Failure(Exception):
    """Something the user must know in one line; nothing is written."""


class WrongOption(Failure):
    """A Failure of the command line: the exit code is 2."""


SEARCH_STRATEGIES = ("voxel-traversal", "compactness")
INTERPOLATIONS = ("neighbor-mean", "membrane", "thin-plate", "adaptive", "cubic-spline")
COLOURS = ("elevation", "error")
OUTWARD_TESTS = ("exact", "inward-normal")
LATTICE_MODES = ("automatic", "off")
DUPLICATES = ("keep-first", "keep-last", "keep-lowest", "keep-highest")


def number_at_least_zero(text):
    value = float(text)
    if not (value >= 0 and math.isfinite(value)):
        raise ValueError
    return value


def number_up_to_a_quarter(text):
    value = float(text)
    if not 0 <= value <= 0.25:
        raise ValueError
    return value


def count_at_least_zero(text):
    value = int(text)
    if value < 0:
        raise ValueError
    return value


def three_columns(text):
    names = [name.strip() for name in text.split(",")]
    if len(names) != 3 or not all(names):
        raise ValueError
    return names


def view_angles(text):
    if text == "top":
        return (180.0, 90.0)
    bearing, height = (float(word) for word in text.split(","))
    if not 0 < height <= 90 or not math.isfinite(bearing):
        raise ValueError
    return (bearing % 360.0, height)


NUMBER = "a number of 0 or more"
# What each option with a value takes, for errors. reconstruct_help.txt explains all options.
TAKES = {
    "--columns": "three columns by name or number from 1, as x,y,z or 1,2,3",
    "--no-data": "an elevation",
    "--maximum-edge-length": NUMBER,
    "--duplicates": "one of " + ", ".join(DUPLICATES),
    "--search-strategy": "one of " + ", ".join(SEARCH_STRATEGIES),
    "--lattice-mode": "one of " + ", ".join(LATTICE_MODES),
    "--lattice-tolerance": "a number from 0 to 0.25",
    "--threads": "a whole number of 0 or more",
    "--breaklines": "a file",
    "--boundary": "a file",
    "--outward-test": "one of " + ", ".join(OUTWARD_TESTS),
    "--gap-tolerance": NUMBER,
    "--open-edge-length": NUMBER,
    "--maximum-hole-size": NUMBER,
    "--maximum-hole-edges": "a whole number of 0 or more",
    "--spacing": NUMBER,
    "--interpolation": "one of " + ", ".join(INTERPOLATIONS),
    "--output": "a file",
    "--picture": "a file, or nothing",
    "--view": "top, or BEARING,HEIGHT in degrees with a height above 0 and at most 90, as 225,35",
    "--exaggeration": NUMBER,
    "--colours": "one of " + ", ".join(COLOURS),
    "--report": "a file",
}


class Parser(argparse.ArgumentParser):
    """Errors are one line that names the option and what it takes."""

    def error(self, message):
        found = re.match(r"argument ([^:]+): (.*)", message)
        if found:
            option = found.group(1).split("/")[-1]
            given = re.search(r"(?:value|choice): ('.*?')(?: \(choose.*)?$", found.group(2))
            message = f"{option}: {found.group(2)}"
            if option in TAKES:
                given = f", not {given.group(1)}" if given else ""
                message = f"{option} takes {TAKES[option]}{given}"
        elif "required: FILE" in message:
            message = "no file is given"
        elif message.startswith("unrecognized arguments: "):
            words = message.split(": ", 1)[1]
            message = f"unknown option or a second file: {words}"
        self.exit(2, f"reconstruct: error: {message}; see --help\n")


class ShowHelp(argparse.Action):
    def __call__(self, parser, *_):
        with open(HELP, encoding="utf-8") as stream:
            sys.stdout.write(stream.read())
        parser.exit()


def make_parser():
    parser = Parser(prog="reconstruct", allow_abbrev=False, add_help=False)
    add = parser.add_argument
    add("-h", "--help", action=ShowHelp, nargs=0)
    add("file", metavar="FILE")
    add("--columns", type=three_columns)
    add("--no-data", type=float)
    add("--maximum-edge-length", type=number_at_least_zero, default=0.0)
    add("--duplicates", choices=DUPLICATES, default=DUPLICATES[0])
    add("--search-strategy", choices=SEARCH_STRATEGIES, default=SEARCH_STRATEGIES[0])
    add("--lattice-mode", choices=LATTICE_MODES, default=LATTICE_MODES[0])
    add("--lattice-tolerance", type=number_up_to_a_quarter, default=0.01)
    add("--threads", type=count_at_least_zero, default=0)
    add("--breaklines")
    add("--boundary")
    add("--outward-test", choices=OUTWARD_TESTS, default=OUTWARD_TESTS[0])
    add("--gap-tolerance", type=number_at_least_zero, default=0.0)
    add("--no-recover-boundary", action="store_true")
    add("--no-trim", action="store_true")
    add("--open-edge-length", type=number_at_least_zero)
    add("--maximum-hole-size", type=number_at_least_zero, default=0.0)
    add("--maximum-hole-edges", type=count_at_least_zero, default=0)
    add("--spacing", type=number_at_least_zero, default=0.0)
    add("--interpolation", choices=INTERPOLATIONS)
    add("--no-interpolate-point-data", action="store_true")
    add("--no-fill", action="store_true")
    add("-o", "--output")
    add("--picture", nargs="?", const="")
    add("--no-picture", action="store_true")
    add("--view", type=view_angles)
    add("--exaggeration", type=number_at_least_zero, default=0.0)
    add("--colours", choices=COLOURS)
    add("--report")
    add("--strict", action="store_true")
    add("--quiet", action="store_true")
    return parser


def parse_arguments(arguments):
    parser = make_parser()
    options = parser.parse_args(arguments)

    if options.no_trim and (
        options.boundary
        or options.gap_tolerance
        or options.no_recover_boundary
        or options.outward_test != OUTWARD_TESTS[0]
    ):
        parser.error("--no-trim leaves nothing for the trimming options to do")
    if options.no_fill and (
        options.open_edge_length is not None
        or options.maximum_hole_size
        or options.maximum_hole_edges
        or options.spacing
        or options.interpolation
        or options.no_interpolate_point_data
    ):
        parser.error("--no-fill leaves nothing for the filling options to do")
    if options.no_fill and options.colours == "error":
        parser.error("--no-fill leaves no errors to draw: --colours error is for filled holes")
    if options.no_picture and (
        options.picture is not None or options.view or options.exaggeration or options.colours
    ):
        parser.error("--no-picture leaves nothing for the picture options to do")
    stem = os.path.splitext(os.path.basename(options.file))[0]
    if options.output is None:
        options.output = f"{stem}_surface.vtp"
    options.picture_wanted = options.picture is not None
    if options.no_picture:
        options.picture = None
    elif not options.picture:
        options.picture = os.path.splitext(options.output)[0] + ".png"
    return options


class Progress:
    """One line on a terminal that fills from left to right; silent anywhere else."""

    def __init__(self, on):
        self.on = on
        self.shown = None
        self.text = ""

    def start(self, text):
        self.text = text
        self(0.0)

    def __call__(self, fraction):
        state = (self.text, int(100 * fraction))
        if self.on and state != self.shown:
            self.shown = state
            bar = "#" * int(30 * fraction)
            sys.stderr.write(f"\r{self.text:<16}[{bar:<30}] {state[1]:3d} %")
            sys.stderr.flush()

    def clear(self):
        if self.on and self.shown:
            sys.stderr.write("\r" + " " * 60 + "\r")
            sys.stderr.flush()
            self.shown = None


class Run:
    """One reconstruction: what the user asked for, and what is known of it so far."""

    def __init__(self, options):
        self.options = options
        self.progress = Progress(sys.stderr.isatty() and not options.quiet)
        self.times = {}
        self.notes = []
        self.why_opened = None
        self.updating = False
        self.stopped = False
        self.display = VirtualDisplay()
        for number in ("SIGINT", "SIGTERM", "SIGHUP"):
            if hasattr(signal, number):
                signal.signal(getattr(signal, number), self.stop)

    def stop(self, _number, _frame):
        """A running filter is asked to abort: an exception would not get through VTK.

        Asked twice, the program ends at once; while filters run, nothing is being written.
        """
        if self.updating and self.stopped:
            self.display.close()
            os._exit(130)
        self.stopped = True
        if not self.updating:
            raise KeyboardInterrupt

    def timed(self, name, text, work):
        self.progress.start(text)
        began = time.perf_counter()
        result = work()
        self.times[name] = time.perf_counter() - began
        return result

    def update(self, name, text, algorithm):
        """Runs a filter with progress. What VTK reports as an error becomes a Failure."""

        def show(caller, _event):
            self.progress(caller.GetProgress())
            if self.stopped:
                caller.SetAbortExecute(1)

        tag = algorithm.AddObserver("ProgressEvent", show)
        self.updating = True
        with files.Messages() as messages:
            self.timed(name, text, algorithm.Update)
        self.updating = False
        algorithm.RemoveObserver(tag)
        if self.stopped:
            raise KeyboardInterrupt
        if messages.errors:
            # With a boundary of the user's, what trimming refuses is that boundary.
            culprit = self.options.boundary if name == "trim" else None
            if name == "triangulate" and "constraints" in messages.errors[0]:
                culprit = self.options.breaklines
            raise Failure(f"{culprit or self.options.file}: {text}: {messages.errors[0]}")
        if messages.warnings and self.options.strict:
            raise Failure(f"{self.options.file}: {text}: {messages.warnings[0]}")
        for warning in messages.warnings:
            # A filter may tell of several holes in one message.
            for sentence in re.sub(r"\. (?=Hole \d)", ".\n", warning).split("\n"):
                self.notes.append(f"{text}: {sentence}")
        return algorithm


def reconstruct(run, cloud, breaklines, boundary):
    """The chain. Returns the three filters, None for those that are switched off."""
    options = run.options
    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputData(cloud.points)
    if breaklines is not None:
        delaunay.SetSourceData(breaklines)
    delaunay.SetMaximumEdgeLength(options.maximum_edge_length)
    delaunay.SetDuplicatePolicy(DUPLICATES.index(options.duplicates))
    delaunay.SetSearchStrategy(SEARCH_STRATEGIES.index(options.search_strategy))
    delaunay.SetLatticeMode(LATTICE_MODES.index(options.lattice_mode))
    delaunay.SetLatticeTolerance(options.lattice_tolerance)
    delaunay.SetNumberOfThreads(options.threads)
    run.update("triangulate", "triangulating", delaunay)
    if delaunay.GetOutput().GetNumberOfPolys() == 0:
        raise Failure(f"{options.file}: {why_no_triangle(cloud.points, options)}")

    trim, fill, last = None, None, delaunay
    if not options.no_trim:
        trim = vtkTrimOutwardTriangles()
        trim.SetInputData(0, last.GetOutput())
        if boundary is not None:
            trim.SetBoundaryData(boundary)
        trim.SetOutwardTest(OUTWARD_TESTS.index(options.outward_test))
        trim.SetGapTolerance(options.gap_tolerance)
        trim.SetNumberOfThreads(options.threads)
        trim.SetRecoverBoundary(not options.no_recover_boundary)
        run.update("trim", "trimming", trim)
        if trim.GetOutput().GetNumberOfPolys() == 0:
            raise Failure(
                f"{options.boundary or options.file}: no triangle lies inside the boundary; "
                "are boundary and points in the same coordinates?"
            )
        last = trim
    if not options.no_fill:
        fill = vtkFillElevationHoles()
        fill.SetInputData(last.GetOutput())
        length, run.why_opened = length_to_open(last.GetOutput(), options)
        fill.SetMaximumEdgeLength(length)
        fill.SetMaximumHoleSize(options.maximum_hole_size)
        fill.SetMaximumHoleEdges(options.maximum_hole_edges)
        fill.SetSpacing(options.spacing)
        if options.interpolation:
            fill.SetInterpolation(INTERPOLATIONS.index(options.interpolation))
        fill.SetInterpolatePointData(not options.no_interpolate_point_data)
        fill.SetNumberOfThreads(options.threads)
        run.update("fill", "filling holes", fill)
    return delaunay, trim, fill


# Above this multiple, edges bridge missing nodes of a grid, or the space between survey lines.
CELL_DIAGONALS = 1.5
SPACINGS_ALONG = 2.0
# Triangles of lines: the longest edge is this multiple of the shortest. They cover more than half of
# a survey of lines at least 10 spacings apart, also with jitter of half a spacing, and at most a
# tenth of anything else.
LEAST_RATIO_OF_LINES = 3.0
# A full grid has triangles of half a cell; a thinned one, whose nodes are not missing, larger ones.
MOST_CELLS_OF_FULL_GRID = 0.75


def length_to_open(surface, options):
    """The length above which edges are opened, to be filled like holes, and why; (0, None): none."""
    if options.open_edge_length is not None:
        return options.open_edge_length, "as given"
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    if options.boundary or len(triangles) == 0:
        # The edges of a boundary may be long where nothing is missing.
        return 0.0, None
    xy = vtk_to_numpy(surface.GetPoints().GetData())[:, :2].astype("f8")
    a, b, c = (xy[triangles[:, i]] for i in range(3))
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


def check_spacing(points, options):
    """Refuses a spacing that no hole could be filled at, before any work is done."""
    xy = vtk_to_numpy(points.GetPoints().GetData())[:, :2]
    xy = xy[numpy.isfinite(xy).all(axis=1)]
    if options.spacing and len(xy):
        # The filter needs four steps between points that can be told apart.
        step = float(numpy.spacing(numpy.abs(xy).max(axis=1).min()))
        if options.spacing < 4 * step:
            raise WrongOption(
                f"--spacing: {options.spacing:g} is less than x and y of {options.file} can tell "
                f"apart, which are in steps of {step:.3g}"
            )


def why_no_triangle(points, options):
    """The reason in words when the triangulation is empty."""
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
    if offset < 1e-12 or not options.maximum_edge_length:
        a, b = distinct[0], distinct[-1]
        return (
            f"no surface: all {len(finite):,} finite points lie on one line in x,y, from "
            f"({a[0]:.10g}, {a[1]:.10g}) to ({b[0]:.10g}, {b[1]:.10g})"
        )
    return (
        f"no surface: no triangle has edges of at most {options.maximum_edge_length:g}; "
        "use a larger --maximum-edge-length"
    )


# ---- report -----------------------------------------------------------------------------------

REASONS = {1: "same x,y as another point", 2: "not finite"}
LONELY = "in no triangle below the edge limit"
OUTSIDE = "outside the boundary"
STATUS = {0: "filled", 1: "too large", 2: "too many edges", 3: "failed", 4: "replaced"}


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


def make_report(run, cloud, delaunay, trim, fill):
    """Everything the user may want to know, as plain numbers and words."""
    options = run.options
    coordinates = vtk_to_numpy(cloud.points.GetPoints().GetData())
    fields = delaunay.GetOutput().GetFieldData()
    ids = vtk_to_numpy(fields.GetArray("UnusedPointIds"))
    reasons = [REASONS[int(r)] for r in vtk_to_numpy(fields.GetArray("UnusedPointReasons"))]
    surface = (fill or trim or delaunay).GetOutput()

    def in_triangles(mesh):
        found = numpy.zeros(mesh.GetNumberOfPoints(), dtype=bool)
        found[vtk_to_numpy(mesh.GetPolys().GetConnectivityArray())] = True
        return found[: len(coordinates)]

    lonely = ~in_triangles(delaunay.GetOutput())
    lonely[ids] = False
    outside = ~in_triangles(surface) & ~lonely
    outside[ids] = False
    unused = list(zip(ids.tolist(), reasons))
    unused += [(i, LONELY) for i in numpy.flatnonzero(lonely).tolist()]
    unused += [(i, OUTSIDE) for i in numpy.flatnonzero(outside).tolist()]
    unused.sort()
    listed = []
    for point, why in unused:
        entry = {"point": point, "reason": why}
        if cloud.lines is not None:
            entry["line"] = int(cloud.lines[point])
        listed.append(entry)
    counts = {}
    for _, why in unused:
        counts[why] = counts.get(why, 0) + 1

    report = {
        "file": options.file,
        "notes": cloud.notes + run.notes,
        "left_out": cloud.left_out,
        "points": len(coordinates),
        "points_unused": len(unused),
        "unused_reasons": counts,
        "unused": listed,
        "lattice": lattice_of(fields),
        "triangles": {"delaunay": delaunay.GetOutput().GetNumberOfPolys()},
    }
    if options.breaklines:
        report["breaklines"] = {
            "file": options.breaklines,
            "added_points": delaunay.GetNumberOfAddedPoints(),
            "crossings": delaunay.GetNumberOfConstraintCrossings(),
        }
    if trim:
        report["trim"] = {
            "outward_triangles": trim.GetNumberOfOutwardTriangles(),
            "recovered_edges": trim.GetNumberOfRecoveredEdges(),
            "inserted_points": trim.GetNumberOfInsertedPoints(),
            "boundary": options.boundary or "found from the points",
            "boundary_rings": trim.GetOutput(2).GetNumberOfLines(),
        }
        if not options.boundary:
            report["trim"]["effective_gap_tolerance"] = trim.GetEffectiveGapTolerance()
            report["trim"]["points_left_out"] = trim.GetNumberOfPointsLeftOut()
        report["triangles"]["trimmed"] = trim.GetOutput().GetNumberOfPolys()
    if fill:
        cells = fill.GetOutput(1).GetCellData()
        names = ("HoleId", "Status", "NumberOfEdges", "Perimeter", "Area", "NumberOfInsertedPoints",
                 "Interpolation")
        columns = [vtk_to_numpy(cells.GetArray(name)).tolist() for name in names]
        columns.append(hole_sizes(fill.GetOutput(1)))
        holes = [
            {
                "hole": hole,
                "status": STATUS[status],
                "edges": edges,
                "perimeter": perimeter,
                "area": area,
                "size": size,
                "inserted_points": inserted,
                "interpolation": INTERPOLATIONS[method] if inserted else None,
            }
            for hole, status, edges, perimeter, area, inserted, method, size in zip(*columns)
        ]
        by_status = {}
        for hole in holes:
            by_status[hole["status"]] = by_status.get(hole["status"], 0) + 1
        report["holes"] = {
            "open_edge_length": fill.GetMaximumEdgeLength(),
            "open_edge_length_is": run.why_opened,
            "found": fill.GetNumberOfHoles(),
            "filled": fill.GetNumberOfFilledHoles(),
            "by_status": by_status,
            "inserted_points": sum(hole["inserted_points"] for hole in holes),
            "list": holes,
        }
        report["triangles"]["filled"] = surface.GetNumberOfPolys()

    # All points that the user wants in the surface, used or not.
    measured = numpy.isfinite(coordinates).all(axis=1)
    if options.boundary:
        measured &= ~outside
    report["distance"] = run.timed(
        "measure", "measuring", lambda: distance_to(surface, coordinates, measured)
    )
    return report


def hole_sizes(lines):
    """The diagonal of each line's box in x,y: what --maximum-hole-size is compared with."""
    if lines.GetNumberOfLines() == 0:
        return []
    cells = lines.GetLines()
    xy = vtk_to_numpy(lines.GetPoints().GetData())[:, :2]
    xy = xy[vtk_to_numpy(cells.GetConnectivityArray())]
    starts = vtk_to_numpy(cells.GetOffsetsArray())[:-1]
    low = numpy.minimum.reduceat(xy, starts, axis=0)
    high = numpy.maximum.reduceat(xy, starts, axis=0)
    return numpy.hypot(*(high - low).T).tolist()


def distance_to(surface, coordinates, chosen):
    """Distance of input points from a surface: max, mean and root mean square, as Metro tells them.

    coordinates  (n, 3), the input points; those that are points of the surface come first there too
    chosen       (n,) of bool: which of them are measured

    A point that is a corner of a triangle, with all three coordinates the same, has distance 0. For
    all others vtkImplicitPolyDataDistance finds the closest place of the surface, in one call; that
    takes some 10 to 40 microseconds a point.
    """
    corners = vtk_to_numpy(surface.GetPoints().GetData()).astype("f8")
    is_corner = numpy.zeros(len(corners), dtype=bool)
    is_corner[vtk_to_numpy(surface.GetPolys().GetConnectivityArray())] = True
    here = is_corner[: len(coordinates)]
    here &= (corners[: len(coordinates)] == coordinates).all(axis=1)
    away = coordinates[chosen & ~here]
    distance = numpy.zeros(len(away))
    unit = 1.0
    if len(away):
        # Only what the search needs, near the origin, where doubles are finest.
        middle = 0.5 * corners[is_corner].min(axis=0) + 0.5 * corners[is_corner].max(axis=0)
        size = max(float(numpy.abs(corners[is_corner]).max()), float(numpy.abs(away).max()))
        if size > 1e100:
            # Squares would be infinite.
            unit = 2.0 ** math.floor(math.log2(size))
            corners, away, middle = corners / unit, away / unit, middle / unit
        corners = numpy.where(is_corner[:, None], corners - middle, 0.0)
        bare = vtkPolyData()
        bare.SetPoints(files.make_points(corners).GetPoints())
        bare.SetPolys(surface.GetPolys())
        search = vtkImplicitPolyDataDistance()
        search.SetInput(bare)
        result = vtkDoubleArray()
        search.EvaluateFunction(files.make_points(away - middle).GetPoints().GetData(), result)
        distance = numpy.abs(vtk_to_numpy(result))
    count = int(numpy.count_nonzero(chosen))
    return {
        "points": count,
        "points_not_corners": len(away),
        "maximum": unit * float(distance.max(initial=0.0)),
        "mean": unit * float(distance.sum() / count),
        "rms": unit * float(math.sqrt((distance**2).sum() / count)),
    }


def counted(count, singular, plural=None):
    """1 hole, 2 holes"""
    return f"{count:,} {singular if count == 1 else plural or singular + 's'}"


def print_report(report, options):
    """The report for people. Long lists are cut here, never in the JSON."""

    def line(name, text):
        print(f"  {name:<10} {text}")

    print(report["file"])
    for note in report["notes"]:
        line("note", note)
    text = f"{report['points']:,} read"
    for name, count in report["left_out"].items():
        text += f"; {count:,} {name} left out"
    line("points", text)
    if report["points_unused"] == 0:
        line("unused", "none")
    for reason, count in report["unused_reasons"].items():
        some = [u for u in report["unused"] if u["reason"] == reason][:5]
        if "line" in some[0]:
            where = "line " + ", ".join(str(u["line"]) for u in some)
        else:
            where = "point " + ", ".join(str(u["point"]) for u in some)
        line("unused", f"{count:,} {reason}: {where}{', ...' if count > len(some) else ''}")
    if report["lattice"]:
        steps = [
            f"{length:.7g} towards {direction + 0.0:.4g} degrees"
            for length, direction in zip(
                report["lattice"]["lengths"], report["lattice"]["directions"]
            )
        ]
        line("lattice", f"steps of {' and '.join(steps)}")
    elif "breaklines" in report:
        line("lattice", "not looked for, because of the breaklines")
    elif options.lattice_mode == "automatic":
        line("lattice", "none: the points are not on the nodes of a grid")
    line("triangles", f"{report['triangles']['delaunay']:,} in the triangulation")
    if "breaklines" in report:
        lines = report["breaklines"]
        line(
            "breaklines",
            f"{lines['file']}: {counted(lines['added_points'], 'point')} added, "
            f"{counted(lines['crossings'], 'crossing')}",
        )
    if "trim" in report:
        trim = report["trim"]
        rings = trim["boundary_rings"]
        line(
            "trimmed",
            f"{counted(trim['outward_triangles'], 'outward triangle')}; "
            f"boundary {trim['boundary']}, {counted(rings, 'ring')}",
        )
        if "effective_gap_tolerance" in trim:
            line("", f"gap tolerance {trim['effective_gap_tolerance']:.4g} spacings")
        if trim.get("points_left_out"):
            line("", f"{counted(trim['points_left_out'], 'point')} outside the boundary")
        if trim["recovered_edges"]:
            line("", f"{counted(trim['recovered_edges'], 'boundary edge')} recovered")
        if trim["inserted_points"]:
            line("", f"{counted(trim['inserted_points'], 'boundary point')} inserted")
    if "holes" in report:
        holes = report["holes"]
        line(
            "holes",
            f"{holes['found']:,} found, {holes['filled']:,} filled with "
            f"{counted(holes['inserted_points'], 'point')}",
        )
        if holes["open_edge_length"]:
            count = holes["by_status"].get("replaced", 0)
            line("", f"{count:,} of them were bridged by triangles")
            line(
                "",
                f"an edge is a bridge above {holes['open_edge_length']:.4g} "
                f"({holes['open_edge_length_is']}); see --open-edge-length",
            )
        for status, count in holes["by_status"].items():
            if status not in ("filled", "replaced"):
                some = [h for h in holes["list"] if h["status"] == status][:5]
                more = ", ..." if count > len(some) else ""
                if status == "too many edges":
                    some = [f"{h['hole']} ({counted(h['edges'], 'edge')})" for h in some]
                else:
                    some = [f"{h['hole']} (size {h['size']:.4g})" for h in some]
                line("", f"{count:,} not filled, {status}: hole {', '.join(some)}{more}")
    line("surface", counted(list(report["triangles"].values())[-1], "triangle"))
    d = report["distance"]
    beyond = ""
    if report["unused_reasons"].get(OUTSIDE):
        beyond = ", those outside left out" if options.boundary else ", those outside too"
    line(
        "distance",
        f"of {counted(d['points'], 'point')}{beyond} from the surface: max {d['maximum']:.3g}, "
        f"mean {d['mean']:.3g}, RMS {d['rms']:.3g}",
    )
    line("time", ", ".join(f"{name} {seconds:.2f} s" for name, seconds in report["times"].items()))
    for path in report["written"]:
        line("written", path)


# ---- results ----------------------------------------------------------------------------------


class Results:
    """Files that appear together at the end, or not at all.

    Each is written beside its final place and renamed when all are whole.
    """

    def __init__(self):
        self.pending = []

    def add(self, path, write):
        folder, name = os.path.split(path)
        stem, suffix = os.path.splitext(name)
        partial = os.path.join(folder, f".{stem}.{os.getpid()}.partial{suffix}")
        self.pending.append((partial, path))
        try:
            return write(partial)
        except (OSError, files.FileError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            reason = reason.replace(partial, path)
            raise Failure(f"{path}: cannot be written: {reason}") from None

    def publish(self):
        for partial, path in self.pending:
            try:
                os.replace(partial, path)
            except OSError as error:
                raise Failure(f"{path}: cannot be written: {error.strerror}") from None
        self.pending = []

    def discard(self):
        for partial, _ in self.pending:
            try:
                os.remove(partial)
            except OSError:
                pass
        self.pending = []


def picture_subtitle(report):
    parts = [
        counted(report["points"], "point"),
        counted(list(report["triangles"].values())[-1], "triangle"),
    ]
    if "holes" in report and report["holes"]["found"]:
        holes = report["holes"]
        if holes["filled"] < holes["found"]:
            parts.append(f"{holes['filled']:,} of {holes['found']:,} holes filled")
        else:
            parts.append(f"{holes['found']:,} hole{'s' * (holes['found'] > 1)} filled")
    return "   \u00b7   ".join(parts)


def write_report(path, report):
    with open(path, "w", encoding="utf-8") as stream:
        json.dump(report, stream, indent=1)
        stream.write("\n")


def work(options, results):
    """Everything between the options and the exit code."""
    try:
        files.check_suffix(options.output, files.WRITE_SUFFIXES, "written")
        if options.picture is not None:
            files.check_suffix(options.picture, (".png",), "written as a picture")
        if options.columns:
            files.check_columns_wanted(options.file)
    except files.FileError as error:
        raise WrongOption(str(error)) from None
    wanted = [p for p in (options.output, options.picture, options.report) if p]
    inputs = [p for p in (options.file, options.breaklines, options.boundary) if p]
    for i, path in enumerate(wanted):
        files.check_writable(path)
        for other in inputs + wanted[:i]:
            if os.path.abspath(path) == os.path.abspath(other):
                raise WrongOption(f"{path}: would overwrite {other}")

    run = Run(options)
    try:
        picture = None
        if options.picture is not None:
            import surface_picture as picture

            reason = None if os.environ.get("DISPLAY") else run.display.open()
            reason = reason or picture.why_no_picture()
            if reason:
                advice = "use Utilities/reconstruct, which sets everything up"
                if options.picture_wanted:
                    raise Failure(f"{options.picture}: cannot be drawn: {reason}; {advice}")
                run.notes.append(f"no picture: {reason}; {advice}")
                picture = None
        cloud = run.timed(
            "read",
            "reading",
            lambda: files.read_points(options.file, options.columns, options.no_data),
        )
        check_spacing(cloud.points, options)
        breaklines = files.read_breaklines(options.breaklines) if options.breaklines else None
        boundary = files.read_boundary(options.boundary) if options.boundary else None
        delaunay, trim, fill = reconstruct(run, cloud, breaklines, boundary)
        report = make_report(run, cloud, delaunay, trim, fill)
        surface = (fill or trim or delaunay).GetOutput()

        suffix = files.suffix_of(options.output)
        report["notes"] += run.timed(
            "write",
            "writing",
            lambda: results.add(
                options.output, lambda path: files.write_surface(surface, path, suffix)
            ),
        )
        if picture:
            reason = picture.why_not_drawn(surface)
            if reason and options.picture_wanted:
                raise Failure(f"{options.picture}: cannot be drawn: {reason}")
            if reason:
                report["notes"].append(f"no picture: {reason}")
                picture = None
        if picture:
            report["picture"] = run.timed(
                "draw",
                "drawing",
                lambda: results.add(
                    options.picture,
                    lambda path: picture.draw(
                        surface,
                        path,
                        os.path.basename(options.file),
                        picture_subtitle(report),
                        fill.GetOutput(1) if fill else None,
                        options.view,
                        options.exaggeration,
                        options.colours == "error",
                    ),
                ),
            )
        report["times"] = run.times
        report["written"] = [
            p for p in (options.output, picture and options.picture, options.report) if p
        ]
        if options.report:
            results.add(options.report, lambda path: write_report(path, report))
        results.publish()
    finally:
        run.progress.clear()
        run.display.close()
    if not options.quiet:
        print_report(report, options)


def main(arguments=None):
    options = parse_arguments(arguments)
    name = "reconstruct"
    if MISSING:
        print(
            f"{name}: error: Python finds no {MISSING}; Utilities/reconstruct sets everything up, "
            "or put the module's folder on PYTHONPATH",
            file=sys.stderr,
        )
        return 1

    # Numbers near the end of their range make infinities; what these mean is told where it matters.
    numpy.seterr(all="ignore")
    results = Results()
    try:
        work(options, results)
        sys.stdout.flush()
        return 0
    except (files.FileError, Failure) as error:
        print(f"{name}: error: {error}", file=sys.stderr)
        return 2 if isinstance(error, WrongOption) else 1
    except MemoryError:
        print(f"{name}: error: {options.file}: there is not enough memory", file=sys.stderr)
        return 1
    except BrokenPipeError:
        # Nobody reads the report any more. What was asked for is done; Python must not try again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except KeyboardInterrupt:
        print(f"{name}: stopped; nothing is written", file=sys.stderr)
        return 130
    finally:
        results.discard()


if __name__ == "__main__":
    sys.exit(main())
