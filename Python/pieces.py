# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces larger than memory: points are read slice by slice, and the surface is made and written
piece by piece. Together the pieces have the triangles of a surface that is made at once."""

import contextlib
import math
import os
import re
import shutil
import tempfile
from xml.sax.saxutils import quoteattr

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from . import reading
from .clouds import Cloud, corner_flags, faults_note, heights_of, make_points, set_crs, slices
from .description import DESCRIBED
from .draping import check_given_z
from .given_lines import in_system
from .heights import HeightsOfPieces
from .holes import report_of_holes
from .mending import mended
from .messages import ElevationSurfaceError, FileError, Messages
from .opening import lattice_of
from .properties import LATTICE_MODES, option_of, set_properties
from .reading.formats import recognise
from .reading.slicing import check_sliced, read_files
from .reading.unpacking import is_plain
from .reconstruction import AS_GIVEN, check_spacing, least_reach
from .report import MOST_LISTED, OUTSIDE, REASONS
from .results import Failure, WrongOption, write_report
from .spreading import IN_NO_TRIANGLE
from .steps import STEPS, in_our_names, is_of_constraints
from .supervisor import note_partial_file
from .vtkElevationSurfacePieces import vtkReconstructPieces
from .writing.xml_writer import write_vtp

AT_ONCE = 1_000_000  # points given to the filter at a time
SUFFIX = ".vtpd"
BYTES_A_POINT = 250  # of memory, where a piece is triangulated
BYTES_TO_FILL = 350  # where its holes are filled
BYTES_BESIDES = 300_000_000  # of memory: programs, and a slice of the file
UNITS = {"": 1, "K": 1e3, "M": 1e6, "G": 1e9, "T": 1e12}


def memory_size(text):
    """2G, 1.5G, 800M -> bytes"""
    found = re.fullmatch(r"([0-9]*\.?[0-9]+)([KMGT]?)(I?B)?", text.strip().upper())
    size = float(found.group(1)) * UNITS[found.group(2)] if found else 0.0
    if not 1.5 * BYTES_BESIDES <= size < math.inf:
        raise ValueError
    return size


MEMORY = f"a size of at least {1.5 * BYTES_BESIDES / 1e6:g}M, such as 2G"


def pieces_within(memory, points, fill=False):
    """How many pieces take no more memory than that."""
    needed = (BYTES_TO_FILL if fill else BYTES_A_POINT) * points
    return max(1, math.ceil(needed / (memory - BYTES_BESIDES)))


def check_given(options, error):
    """Calls error(words) where options of the command line do not go with pieces."""
    name = "--pieces" if options.pieces is not None else "--memory"
    for other, one in DESCRIBED.items():
        if not one.in_pieces and getattr(options, other) not in (None, False, 0.0):
            words = one.words["pieces"]
            if words == "no":
                words = f"needs the whole surface in memory; it cannot be used with {name}"
            error(f"{option_of(other)} {words}")
    if options.trim and not options.boundary:
        error(f"{name} can only trim along a boundary that is given: add --boundary or --no-trim")
    if options.fill and not options.boundary and options.open_edge_length is None:
        error(
            f"{name} cannot tell which triangles bridge what is missing: add --open-edge-length 0 "
            "for none of them, --no-fill or --boundary"
        )
    options.no_picture = True


def check_files(options):
    """Refuses files that cannot be read or written in pieces, before any work is done."""
    for path in options.files:
        if is_plain(path):
            check_sliced(path, recognise(path)[0])
    folder = folder_of(options.output)
    if os.path.exists(folder) and not os.path.isdir(folder):
        raise FileError(f"{folder}: is a file, but the folder of the pieces has this name")


def folder_of(output):
    """Where the pieces are: survey_surface of survey_surface.vtpd."""
    return os.path.splitext(output)[0]


def remove_older(folder, names):
    """Removes the pieces of an earlier run with this output, which may have had more of them."""
    base = os.path.basename(folder)
    for name in os.listdir(folder):
        if re.fullmatch(re.escape(base) + r"_[0-9]+\.vtp", name) and f"{base}/{name}" not in names:
            os.remove(os.path.join(folder, name))


@contextlib.contextmanager
def temporary_folder(output):
    """A folder beside a result, which goes away, also where this process cannot see to it."""
    place, name = os.path.split(os.path.abspath(output))
    try:
        folder = tempfile.mkdtemp(".partial", f".{os.path.splitext(name)[0]}.", place)
    except OSError as error:
        raise Failure(f"{output}: cannot be written: {error.strerror}") from None
    note_partial_file(folder)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


class Points:
    """A set of numbers of points, with a bit for each that there is."""

    def __init__(self, count):
        self.count = count
        self.bits = numpy.zeros((count + 7) // 8, dtype="u1")

    def add(self, ids):
        """Adds those numbers that there are; others are of inserted points."""
        ids = numpy.unique(ids[ids < self.count])
        if len(ids):
            byte, bit = ids >> 3, numpy.left_shift(1, ids & 7).astype("u1")
            first = numpy.flatnonzero(numpy.diff(byte, prepend=-1))
            self.bits[byte[first]] |= numpy.bitwise_or.reduceat(bit, first)

    def others(self, most):
        """(how many are not in it, the first of these)"""
        count, listed = 0, [numpy.empty(0, "i8")]
        for part in slices(len(self.bits)):
            there = numpy.unpackbits(self.bits[part], bitorder="little")
            there = there[: self.count - 8 * part.start]
            listed.append(8 * part.start + numpy.flatnonzero(there == 0)[: max(0, most - count)])
            count += len(there) - numpy.count_nonzero(there)
        return int(count), numpy.concatenate(listed)


def step_of(source):
    """The step that a vtkReconstructPieces is at: delaunay, trim or fill."""
    return {words: step for step, words in STEPS.items()}.get(source.GetProgressText(), "delaunay")


class MessagesOfSteps(Messages):
    """Those of a vtkReconstructPieces, each with the step that it is at."""

    def take(self, event, message):
        message.step = step_of(self.sources[0])
        super().take(event, message)


def with_step(message):
    return f"{STEPS[message.step]}: {in_our_names(message, message.step)}"


class Pieces:
    """A run in pieces: reads, triangulates, trims, fills and writes. Call it to get the report.

    run  the Run of the command line, with its options, results, progress and times
    """

    def __init__(self, run):
        self.run, self.options = run, run.options
        self.cloud = Cloud(None)
        self.source = vtkReconstructPieces()
        self.source.SetController(None)
        self.unused = {number: numpy.empty(0, "i8") for number in (1, 2)}  # of REASONS
        self.low, self.high = numpy.full(3, numpy.inf), numpy.full(3, -numpy.inf)
        self.range = None  # of z of the points
        self.lattice = self.told_of = self.holes = None
        self.heights, self.several = HeightsOfPieces(), None

    def __call__(self):
        options, source, run = self.options, self.source, self.run
        source.SetFillHoles(options.fill)
        for step, algorithm in (
            ("delaunay", source.GetDelaunay()),
            ("trim", source.GetTrim()),
            ("fill", source.GetFill()),
        ):
            set_properties(algorithm, step, options.given)
        source.AddObserver(
            "ProgressEvent", lambda caller, _: run.progress(STEPS[step_of(caller)], caller.GetProgress())
        )
        with temporary_folder(options.output) as folder:
            source.SetFolder(folder)
            with MessagesOfSteps(source, source.GetExecutive()) as self.messages:
                run.timed("read", "reading", self.read)
                count = options.pieces or pieces_within(
                    options.memory, source.GetNumberOfPoints(), options.fill
                )
                if options.memory is not None:
                    source.SetMemoryOfHole(options.memory - BYTES_BESIDES)
                run.timed("triangulate", STEPS["delaunay"], lambda: self.update(0, count))
                names = run.timed("write", "writing", lambda: self.write(folder, count))
            run.results.add(options.output, lambda path: write_vtpd(names, path))
            report = self.report(len(names))
            if options.report:
                run.results.add(options.report, lambda path: write_report(path, report))
            run.results.publish()
            remove_older(folder_of(options.output), names)
        return report

    def check(self):
        """Raises what the filter has reported as error, or with --strict as warning."""
        problems = self.messages.errors or (self.messages.warnings if self.options.strict else [])
        if problems:
            file = self.options.boundary if problems[0].step == "trim" else self.options.file
            file = self.options.faults if is_of_constraints(problems[0]) else file
            more = (in_our_names(one, one.step) for one in problems[1:])
            raise Failure(" ".join([f"{file}: {with_step(problems[0])}", *more]))

    def read(self):
        """Gives all points to the filter, slice by slice."""
        options, reach = self.options, numpy.inf
        path = options.boundary
        if path:
            boundary, notes = mended(reading.read_boundary(path), path, options.strict)
        if options.faults:
            faults = self.run.read_faults(self.cloud)
            self.check_faults(faults)

        def take(points):
            nonlocal reach
            for part in slices(len(points), AT_ONCE):
                given = make_points(points[part], copy=False)
                reach = min(reach, least_reach(given))
                self.source.AddPoints(given)
                self.heights.see(points[part])
                self.see_heights(given)
                self.check()

        read_files(options.files, self.cloud, take, **self.run.read_options())
        try:
            check_spacing(reach, options.given.get("spacing", 0.0))
        except ValueError as error:
            raise WrongOption(f"{options.file}: {error}") from None
        self.run.set_crs(self.cloud)
        if path:
            boundary, told = in_system(
                boundary, path, self.cloud, options.files[0], options.strict
            )
            self.cloud.notes += notes + told
            self.source.GetTrim().SetBoundaryData(boundary)
        if options.faults:
            self.check_faults(faults)
            faults, told = in_system(
                faults, options.faults, self.cloud, options.files[0], options.strict
            )
            note = faults_note(self.range, faults)
            self.cloud.notes += told + [note] * bool(note)
            self.source.GetDelaunay().SetSourceData(faults)

    def see_heights(self, points):
        found = [pair for pair in (self.range, heights_of(points)) if pair]
        self.range = (min(low for low, _ in found), max(high for _, high in found)) if found else None

    def check_faults(self, faults):
        """Refuses faults without z, also before points are read."""
        try:
            check_given_z(faults, self.options.faults, self.options.given, self.range)
        except ElevationSurfaceError as error:
            raise Failure(str(error)) from None

    def update(self, piece, count):
        """The output for a piece. The first one takes the time of the triangulation."""
        self.source.UpdatePiece(piece, count, 0)
        self.check()
        if self.source.GetNumberOfTriangles() == 0:
            why = self.messages.warnings[0]
            raise Failure(f"{self.options.file}: no surface: {in_our_names(why, why.step)}")
        return self.source.GetOutput()

    def write(self, folder, count):
        """Writes all pieces with points. Returns their names beside the output."""
        names, final = [], folder_of(self.options.output)
        self.told_of = Points(self.source.GetNumberOfPoints())
        for piece in range(count):
            data = self.update(piece, count)
            if piece == 0 and self.options.fill:
                self.holes = self.holes_of(self.source.GetOutput(1))
            if data.GetNumberOfPoints():
                self.look_at(data)
                if self.cloud.crs:
                    set_crs(data, self.cloud.crs)
                name = f"{os.path.basename(final)}_{piece}.vtp"
                self.run.results.add(
                    os.path.join(final, name),
                    lambda path: write_vtp(data, path),  # pylint: disable=cell-var-from-loop
                    os.path.join(folder, name),
                )
                names.append(f"{os.path.basename(final)}/{name}")
            self.run.progress("writing", (piece + 1) / count)
        self.check_heights()
        return names

    def check_heights(self):
        source, options = self.source, self.options
        unused = source.GetNumberOfDuplicatePoints() + source.GetNumberOfNonFinitePoints()
        places, policy = source.GetNumberOfPoints() - unused, options.given.get("duplicates")
        try:
            note, self.several = self.heights.check(places, policy)
        except ElevationSurfaceError as error:
            raise Failure(f"{options.file}: {error}") from None
        self.cloud.notes += [note] if note else []

    def look_at(self, data):
        """Takes from a piece what the report tells."""
        points, ids = data.GetPoints(), vtk_to_numpy(data.GetPointData().GetGlobalIds())
        corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
        flags = corner_flags(corners, len(ids))
        used = vtk_to_numpy(points.GetData())[flags]
        self.told_of.add(ids[flags])
        self.low = numpy.minimum(self.low, used.min(axis=0, initial=numpy.inf))
        self.high = numpy.maximum(self.high, used.max(axis=0, initial=-numpy.inf))
        fields = data.GetFieldData()
        self.lattice = lattice_of(None, data)
        gone = ids[vtk_to_numpy(fields.GetArray("UnusedPointIds"))]
        reasons = vtk_to_numpy(fields.GetArray("UnusedPointReasons"))
        self.told_of.add(gone)
        if (reasons == 1).any():
            self.heights.add(vtk_to_numpy(points.GetData()))
        for number, known in self.unused.items():
            all_known = numpy.concatenate((known, gone[reasons == number]))
            self.unused[number] = numpy.sort(all_known)[:MOST_LISTED]

    def holes_of(self, outlines):
        """What became of the holes. No triangles of pieces bridge any."""
        bridged = numpy.zeros(outlines.GetNumberOfLines(), dtype=bool)
        is_given = self.options.open_edge_length is not None
        why = AS_GIVEN if is_given else None
        return report_of_holes(outlines, bridged, self.source.GetFill(), why)

    def notes(self):
        """What the filter warns of."""
        return [with_step(warning) for warning in self.messages.warnings]

    def why_in_no_triangle(self):
        """The reason of points that have been left out by trimming, or by the limit of edges."""
        is_limited = self.source.GetDelaunay().GetMaximumEdgeLength() > 0.0
        if is_limited and self.options.trim:
            return f"{OUTSIDE}, or {REASONS[IN_NO_TRIANGLE]}"
        return REASONS[IN_NO_TRIANGLE] if is_limited else OUTSIDE

    def report(self, pieces):
        """As that of a surface in memory, without what needs all of it at once."""
        source, options = self.source, self.options
        counts = {1: source.GetNumberOfDuplicatePoints(), 2: source.GetNumberOfNonFinitePoints()}
        counts[4], self.unused[4] = self.told_of.others(MOST_LISTED)
        reasons = {**REASONS, 4: self.why_in_no_triangle()}
        listed = [
            {"point": point, "reason": reasons[number]}
            for number, points in self.unused.items()
            for point in points.tolist()
        ]
        limits = zip("xyz", self.low.tolist(), self.high.tolist())
        report = {
            "file": options.file,
            **self.run.about(),
            "notes": self.cloud.notes + self.notes(),
            "left_out": self.cloud.left_out,
            "bounds": {axis: pair for axis, *pair in limits},
            "crs": self.cloud.crs,
            "points": source.GetNumberOfPoints(),
            "points_unused": sum(counts.values()),
            "unused_reasons": {reasons[number]: n for number, n in counts.items() if n},
            "unused": sorted(listed, key=lambda one: one["point"]),
            "unused_listed": len(listed),
            "lattice": self.lattice,
            "lattice_mode": LATTICE_MODES[source.GetDelaunay().GetLatticeMode()],
            "triangles": {"delaunay": source.GetNumberOfTriangles()},
            "pieces": pieces,
            "times": self.run.times,
            "written": [path for path in (options.output, options.report) if path],
        }
        if options.trim:
            report["trim"] = {
                "outward_triangles": source.GetNumberOfOutwardTriangles(),
                "recovered_edges": source.GetNumberOfRecoveredEdges(),
                "inserted_points": source.GetNumberOfInsertedPoints(),
                "boundary": options.boundary,
                "boundary_rings": source.GetNumberOfBoundaryRings(),
            }
            report["triangles"]["trimmed"] = source.GetNumberOfTrimmedTriangles()
        if options.faults:
            report["faults"] = {
                "file": options.faults,
                "added_points": source.GetNumberOfAddedPoints(),
                "crossings": source.GetNumberOfConstraintCrossings(),
            }
        if self.several:
            report["several_heights"] = self.several
        if options.fill:
            report["triangles"]["filled"] = source.GetNumberOfFilledTriangles()
            report["holes"] = self.holes
        return report


def write_vtpd(names, path):
    """Writes the file that names the pieces: a vtkPartitionedDataSet. Raises OSError."""
    with open(path, "w", encoding="utf-8") as stream:
        stream.write('<?xml version="1.0"?>\n')
        stream.write('<VTKFile type="vtkPartitionedDataSet" version="1.0">\n')
        stream.write("<vtkPartitionedDataSet>\n")
        for i, name in enumerate(names):
            stream.write(f"<DataSet index=\"{i}\" file={quoteattr(name)}/>\n")
        stream.write("</vtkPartitionedDataSet>\n</VTKFile>\n")
