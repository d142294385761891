# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces larger than memory: points are read slice by slice, and the surface is made and written
piece by piece. Together the pieces have the triangles of a surface that is made at once.

Several processes each read a share of the points, and make and write pieces of their own. The first
reads lines, and lets all results appear.
"""

import contextlib
import math
import os
import re
import shutil
import tempfile

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from . import reading
from .clouds import Cloud, faults_note, heights_of, make_points, set_crs, slices, triangles_of
from .description import DESCRIBED
from .draping import check_given_z
from .given_lines import check_z, in_system
from .holes import BridgedVoids, hole_report
from .lattice import lattice_of
from .mending import mended
from .messages import ElevationSurfaceError, FileError, Messages
from .names import option
from .passes import corner_flags
from .properties import set_properties
from .ranks import agreed, by_first, collected, rank_and_count, together, total
from .reading.formats import recognise
from .reading.slicing import check_sliced, read_files
from .reading.unpacking import is_plain
from .reconstruction import AREA_MODES, AS_GIVEN, least_reach
from .report import MOST_LISTED, OUTSIDE, REASONS, facts_of, fault_report, trimming_report
from .results import Failure, write_report
from .several_heights import PieceHeights
from .spreading import IN_NO_TRIANGLE
from .steps import STEPS, concerns_constraints, in_our_names, rings_of
from .supervisor import note_partial_file, rank_and_size
from .vtkElevationSurfacePieces import vtkReconstructPieces
from .writing.xml_writer import quoteattr, write_vtp

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


def pieces_within(memory, points, fill=False, processes=1):
    """How many pieces take no more memory than that of each process, all of which have as many."""
    needed = (BYTES_TO_FILL if fill else BYTES_A_POINT) * points
    return processes * max(1, math.ceil(needed / (memory - BYTES_BESIDES) / processes))


def check_given(options, error):
    """Calls error(words) where options of the command line do not go with pieces."""
    name, processes = "--pieces" if options.pieces is not None else "--memory", rank_and_size()[1]
    if options.pieces and options.pieces % processes:
        error(
            f"--pieces: {options.pieces} cannot be made by {processes} processes, each as many: take a "
            f"multiple of {processes}, such as {options.pieces + -options.pieces % processes}"
        )
    for other, one in DESCRIBED.items():
        if not one.in_pieces and getattr(options, other) not in (None, False, 0.0):
            words = one.words["pieces"]
            if words == "no":
                words = f"needs the whole surface in memory; it cannot be used with {name}"
            error(f"{option(other)} {words}")
    if options.fill and not options.boundary and options.open_edge_length is None:
        error(
            f"{name} cannot find which triangles bridge gaps: add --open-edge-length, 0 for "
            "none of them, --no-fill or --boundary"
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
def temporary_folder(output, ranks):
    """A folder next to a result, the same for all ranks. It goes away, also where no process is left
    to see to it; until then it has all temporary files. Ranks have to leave it together.
    """
    place, name = os.path.split(os.path.abspath(output))

    def make():
        try:
            folder = tempfile.mkdtemp(".partial", f".{os.path.splitext(name)[0]}.", place)
        except OSError as error:
            raise Failure(f"{output}: cannot be written: {error.strerror}") from None
        note_partial_file(folder)
        return [folder]

    made = by_first(ranks, make, [])
    (folder,), before = together(ranks, lambda: made), tempfile.tempdir
    tempfile.tempdir = folder
    try:
        yield folder
    finally:
        tempfile.tempdir = before
        if made:
            shutil.rmtree(folder, ignore_errors=True)


def rank_folder(folder, rank):
    """A folder in the temporary one, for the files of this rank. Raises Failure."""
    own = os.path.join(folder, str(rank))
    try:
        os.mkdir(own)
    except OSError as error:
        raise Failure(f"{own}: process {rank} cannot make this folder: {error.strerror}") from None
    return own


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

    def others(self, most, ranks):
        """(how many are in that of no rank, the first of these)"""
        count, listed = 0, [numpy.empty(0, "i8")]
        for part in slices(len(self.bits)):
            bits = numpy.bitwise_or.reduce(collected(ranks, self.bits[part], "u1"))
            there = numpy.unpackbits(bits, bitorder="little")
            there = there[: self.count - 8 * part.start]
            listed.append(8 * part.start + numpy.flatnonzero(there == 0)[: max(0, most - count)])
            count += len(there) - numpy.count_nonzero(there)
        return int(count), numpy.concatenate(listed)


def step_of(source):
    """The step that a vtkReconstructPieces is at: delaunay, trim or fill."""
    return {words: step for step, words in STEPS.items()}.get(source.GetProgressText(), "delaunay")


class StepMessages(Messages):
    """Those of a vtkReconstructPieces, each with the step that it is at."""

    def take(self, event, message):
        message.step = step_of(self.sources[0])
        super().take(event, message)


class Pieces:
    """A run in pieces: reads, triangulates, trims, fills and writes. All ranks call it; the first gets
    the report.

    run  the Run of the command line, with its options, results, progress, times and ranks
    """

    def __init__(self, run):
        self.run, self.options, self.ranks = run, run.options, run.ranks
        self.cloud = Cloud(None)
        self.source = vtkReconstructPieces()
        self.source.SetController(self.ranks)
        self.delaunay = self.source.GetDelaunay()
        self.unused = {number: numpy.empty(0, "i8") for number in (1, 2)}  # of REASONS
        self.low, self.high = numpy.full(3, numpy.inf), numpy.full(3, -numpy.inf)
        self.range = None  # of z of the points
        self.lattice = self.reported_points = self.voids = None
        self.outlines = vtkPolyData()  # of the holes, on the first rank
        self.heights, self.several = PieceHeights(self.ranks), None

    def __call__(self):
        with temporary_folder(self.options.output, self.ranks) as folder:
            return agreed(self.ranks, lambda: self.work(folder))

    def work(self, folder):
        options, source, run = self.options, self.source, self.run
        rank, ranks = rank_and_count(self.ranks)
        source.SetFolder(rank_folder(folder, rank))
        source.KeepFilesOff()
        source.SetTrimOutward(options.trim)
        source.SetFillHoles(options.fill)
        for step, algorithm in (
            ("delaunay", self.delaunay),
            ("trim", source.GetTrim()),
            ("fill", source.GetFill()),
        ):
            set_properties(algorithm, step, options.properties)
        if not options.boundary:
            source.GetFill().FillCutOutsOn()  # as in memory
        source.AddObserver(
            "ProgressEvent", lambda caller, _: run.progress(STEPS[step_of(caller)], caller.GetProgress())
        )
        with StepMessages(source, source.GetExecutive()) as self.messages:
            run.timed("read", "reading", self.read)
            points = total(self.ranks, source.GetNumberOfPoints())
            count = options.pieces or pieces_within(options.memory, points, options.fill, ranks)
            if options.memory is not None:
                source.SetHoleMemory(options.memory - BYTES_BESIDES)
            own = range(rank * count // ranks, (rank + 1) * count // ranks)
            run.timed("triangulate", STEPS["delaunay"], lambda: self.begin(own[0], count))
            run.timed("write", "writing", lambda: self.write(own, count))
        self.gather()
        return by_first(self.ranks, self.finish)

    def finish(self):
        """Lets the results of all ranks appear. Returns the report."""
        options, results, final = self.options, self.run.results, folder_of(self.options.output)
        names = [os.path.relpath(path, os.path.dirname(final)) for _, path in results.pending]
        results.add(options.output, lambda path: write_vtpd(names, path))
        report = self.report(len(names))
        if options.report:
            results.add(options.report, lambda path: write_report(path, report))
        results.publish()
        remove_older(final, names)
        return report

    def check(self):
        """Raises what the filter has reported as error, or with --strict as warning."""
        problems = self.messages.errors or (self.messages.warnings if self.options.strict else [])
        if problems:
            file = problems[0].step == "trim" and self.options.boundary or self.options.file
            file = self.options.faults if concerns_constraints(problems[0]) else file
            more = map(self.in_our_names, problems[1:])
            raise Failure(" ".join([f"{file}: {self.with_step(problems[0])}", *more]))

    def in_our_names(self, message):
        of_step = {"trim": self.source.GetTrim(), "fill": self.source.GetFill()}.get(message.step)
        return in_our_names(message, message.step, of_step and rings_of(of_step))

    def with_step(self, message):
        return f"{STEPS[message.step]}: {self.in_our_names(message)}"

    def read(self):
        """Gives the points of this rank to the filter, slice by slice, and lines on the first."""
        options, reach = self.options, numpy.inf
        lines = by_first(self.ranks, self.read_lines)

        def take(points):
            nonlocal reach
            for part in slices(len(points), AT_ONCE):
                given = make_points(points[part], copy=False)
                reach = min(reach, least_reach(given))
                self.source.AddPoints(given)
                self.heights.see(points[part])
                self.see_heights(heights_of(given))
                self.check()

        read_files(options.files, self.cloud, take, self.ranks, **self.run.read_options())
        for pair in together(self.ranks, lambda: [self.range]):
            self.see_heights(pair)
        self.run.check_spacing(min(collected(self.ranks, [reach], "f8"))[0])
        self.heights.take_sample()
        self.run.set_crs(self.cloud)
        by_first(self.ranks, lambda: self.give_lines(*lines))

    def read_lines(self):
        """({name: rings}, notes on them, faults), before points are read."""
        options, rings, faults = self.options, self.run.read_rings(), None
        notes = self.run.notes_on_files(rings)
        check_z(rings, self.run.line_files(), options.properties)
        for name, data in rings.items():
            rings[name], more = mended(data, getattr(options, name), options.strict, name)
            notes = notes + more
        if options.faults:
            faults = self.run.read_faults(self.cloud)
            notes = notes + self.run.notes_on_files({"faults": faults})
            self.check_faults(faults)
        return rings, notes, faults

    def give_lines(self, rings, notes, faults):
        """Gives lines to the filter, in the system of the points."""
        options, cloud = self.options, self.cloud
        cloud.notes += notes
        for name, data in rings.items():
            data, more = in_system(
                data, getattr(options, name), cloud, options.files[0], options.strict
            )
            cloud.notes += more
            if name == "boundary":
                self.source.GetTrim().SetBoundaryData(data)
            else:
                self.source.GetFill().SetAreasData(data)
                self.source.GetFill().SetAreaMode(AREA_MODES[name])
        if faults is not None:
            self.check_faults(faults)
            faults, more = in_system(faults, options.faults, cloud, options.files[0], options.strict)
            note = faults_note(self.range, faults)
            cloud.notes += more + [note] * bool(note)
            self.delaunay.SetSourceData(faults)

    def see_heights(self, heights):
        found = [pair for pair in (self.range, heights) if pair]
        self.range = (min(low for low, _ in found), max(high for _, high in found)) if found else None

    def check_faults(self, faults):
        """Refuses faults without z, also before points are read."""
        check_given_z(faults, self.options.faults, self.options.properties, self.range)

    def update(self, piece, count):
        """The output for a piece of this rank."""
        self.source.UpdatePiece(piece, count, 0)
        self.check()
        return self.source.GetOutput()

    def begin(self, piece, count):
        """Makes the whole surface, which takes until all ranks have asked for their first piece."""

        def first():
            self.update(piece, count)
            if self.source.GetNumberOfTriangles() == 0 and self.run.is_first:
                why = self.messages.warnings[0]
                raise Failure(f"{self.options.file}: no surface: {self.in_our_names(why)}")

        agreed(self.ranks, first)

    def write(self, own, count):
        """Writes all pieces of this rank with points."""
        final = folder_of(self.options.output)
        self.reported_points = Points(self.source.GetNumberOfPoints())
        if self.options.fill:
            self.outlines.ShallowCopy(self.source.GetOutput(1))  # of piece 0
            self.voids = BridgedVoids(self.outlines, self.ranks)
        for piece in own:
            data = self.update(piece, count)
            if data.GetNumberOfPoints():
                self.look_at(data)
                if self.cloud.crs:
                    set_crs(data, self.cloud.crs)
                name = f"{os.path.basename(final)}_{piece}.vtp"
                self.run.results.add(
                    os.path.join(final, name),
                    lambda path: write_vtp(data, path),  # pylint: disable=cell-var-from-loop
                    os.path.join(self.source.GetFolder(), name),
                )
            self.run.progress("writing", (piece + 1 - own[0]) / len(own))

    def gather(self):
        """What has been found in the pieces of all ranks, and the files that are written."""
        ranks, source = self.ranks, self.source
        self.run.results.pending = together(ranks, lambda: self.run.results.pending)
        self.low = numpy.min(collected(ranks, self.low, "f8"), axis=0)
        self.high = numpy.max(collected(ranks, self.high, "f8"), axis=0)
        self.lattice = next(iter(together(ranks, lambda: [self.lattice] if self.lattice else [])), None)
        for number, known in self.unused.items():
            known = numpy.concatenate(collected(ranks, known))
            self.unused[number] = numpy.sort(known)[:MOST_LISTED]
        self.others = self.reported_points.others(MOST_LISTED, ranks)
        self.bridged = self.voids and self.voids.find()
        unused = source.GetNumberOfDuplicatePoints() + source.GetNumberOfNonFinitePoints()
        places, policy = source.GetNumberOfPoints() - unused, self.options.properties.get("duplicates")
        try:
            note, self.several = self.heights.check(places, policy)
        except ElevationSurfaceError as error:
            raise Failure(f"{self.options.file}: {error}") from None
        self.cloud.notes += [note] if note else []

    def look_at(self, data):
        """Takes from a piece what the report needs."""
        points, ids = data.GetPoints(), vtk_to_numpy(data.GetPointData().GetGlobalIds())
        flags = corner_flags(triangles_of(data), len(ids))
        used = vtk_to_numpy(points.GetData())[flags]
        self.reported_points.add(ids[flags])
        if self.voids:
            self.voids.see(data)
        self.low = numpy.minimum(self.low, used.min(axis=0, initial=numpy.inf))
        self.high = numpy.maximum(self.high, used.max(axis=0, initial=-numpy.inf))
        fields = data.GetFieldData()
        self.lattice = lattice_of(None, data)
        gone = ids[vtk_to_numpy(fields.GetArray("UnusedPointIds"))]
        reasons = vtk_to_numpy(fields.GetArray("UnusedPointReasons"))
        self.reported_points.add(gone)
        if (reasons == 1).any():
            self.heights.add(vtk_to_numpy(points.GetData()))
        for number, known in self.unused.items():
            all_known = numpy.concatenate((known, gone[reasons == number]))
            self.unused[number] = numpy.sort(all_known)[:MOST_LISTED]

    def why_in_no_triangle(self):
        """The reason of points that have been left out by trimming, or by the limit of edges."""
        is_limited = self.delaunay.GetMaximumEdgeLength() > 0.0
        if is_limited and self.options.trim:
            return f"{OUTSIDE}, or {REASONS[IN_NO_TRIANGLE]}"
        return REASONS[IN_NO_TRIANGLE] if is_limited else OUTSIDE

    def report(self, pieces):
        """As that of a surface in memory, without what needs all of it at once."""
        source, options = self.source, self.options
        unused = {
            REASONS[1]: (source.GetNumberOfDuplicatePoints(), self.unused[1]),
            REASONS[2]: (source.GetNumberOfNonFinitePoints(), self.unused[2]),
            self.why_in_no_triangle(): self.others,
        }
        notes = [self.with_step(warning) for warning in self.messages.warnings]
        limits = self.low.tolist(), self.high.tolist()
        self.triangles = {"delaunay": source.GetNumberOfTriangles()}
        report = {
            "file": options.file,
            **self.run.about(),
            **facts_of(self, source.GetNumberOfPoints(), notes, limits, unused),
            "pieces": pieces,
            "times": self.run.times,
            "written": [path for path in (options.output, options.report) if path],
        }
        if options.trim:
            rings, outward = source.GetNumberOfBoundaryRings(), source.GetNumberOfOutwardTriangles()
            report["trim"] = trimming_report(outward, source, options.boundary, rings)
            self.triangles["trimmed"] = source.GetNumberOfTrimmedTriangles()
        if options.faults:
            report["faults"] = fault_report(options.faults, source)
        if options.fill:
            self.triangles["filled"] = source.GetNumberOfFilledTriangles()
            why = None if options.open_edge_length is None else AS_GIVEN
            report["holes"] = hole_report(self.outlines, self.bridged, source.GetFill(), why)
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
