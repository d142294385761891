# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command line: python3 -m vtkelevationsurface FILE, which Utilities/reconstruct runs."""

import contextlib
import copy
import os
import sys
import time

import numpy
from vtkmodules.vtkCommonCore import vtkSMPTools
from vtkmodules.vtkCommonDataModel import vtkPolyData

from . import reading
from .clouds import Cloud, ReadOptions, bare_lines, coordinates_of, crs_of, merged, notes_on, set_crs, take_notes
from .gdal_common import check_system, name_of, reference_of
from .given_lines import RINGS, fitted
from .several_heights import check_heights
from .messages import ElevationSurfaceError, PictureError, counted
from .options import (
    about,
    check_options,
    files_of,
    make_parser,
    options_of,
    parse_arguments,
    read_options,
)
from .names import PROGRAM, written_for
from .pieces import Pieces
from .planes import in_plane
from .properties import is_simplified
from .projecting import MOST_ANGLES, no_angles, project
from .ranks import agreed, by_first, together, total
from .reconstruction import check_spacing, least_reach, run_chain
from .report import picture_subtitle, print_report
from .results import Failure, NoPicture, Progress, Results, WrongOption, write_report
from .selecting import NothingChosen, columns_in, none_chosen, values_to_make
from .spreading import can_be_scattered, gather_surface, scatter
from .supervisor import allow_stops
from .writing.grids import side_files, write_prj
from .writing.outputs import write_output


class Run:
    """One reconstruction of the command line, with its progress and its times.

    ranks  the controller of the processes that mpirun has started, or None. All run the filters; but
           for runs in pieces, the first of them reads and writes
    """

    def __init__(self, options, results, ranks):
        self.options = options
        self.results = results
        self.ranks = ranks
        self.is_first = ranks is None or ranks.GetLocalProcessId() == 0
        self.progress = Progress(self.is_first and sys.stderr.isatty() and not options.quiet)
        self.times = {}
        self.places = self.other = None  # what --at and --volume ask for
        self.no_picture = None  # why the picture that was asked for is missing
        self.end = lambda: None  # ends what was started for a picture, if it is not drawn
        if ranks and hasattr(os, "sched_getaffinity"):
            # mpirun may give each of them a core.
            options.properties.setdefault("threads", len(os.sched_getaffinity(0)))
        # The filters take so many; passes of the package as many as VTK has.
        if 0 < options.properties.get("threads", 0) < vtkSMPTools.GetEstimatedNumberOfThreads():
            vtkSMPTools.Initialize(options.properties["threads"])

    def timed(self, name, text, work):
        self.progress(text, 0.0)
        began = time.perf_counter()
        result = work()
        self.times[name] = time.perf_counter() - began
        return result

    def read_options(self):
        """The options that concern reading, with progress, by name."""
        wanted = read_options(self.options)
        wanted["progress"] = lambda fraction: self.progress("reading", fraction)
        return wanted

    def about(self):
        return about(self.options)

    def read_whole(self):
        """The Clouds of the files as reading.read_whole() gives them."""
        wanted = ReadOptions(**self.read_options())
        if self.options.each_value:
            wanted.where = [*(wanted.where or ()), (self.options.each_value, "")]  # is read, too
        return [reading.read_whole(path, wanted) for path in self.options.files]

    def values(self):
        """The name of the column of --each-value and its values, on all ranks. What is read is
        kept."""
        options = self.options

        def find():
            self.check()
            options.clouds = self.read_whole()
            columns = columns_in(merged(options.files, options.clouds))
            name, missing, values = values_to_make(options.file, options.each_value, columns)
            return [name, missing, *values]

        found = by_first(self.ranks, find) or []
        name, missing, *values = together(self.ranks, lambda: found)
        if missing:
            options.without_value = missing
        return name, values

    def read_clouds(self):
        """The Cloud of the files."""
        wanted, files = ReadOptions(**self.read_options()), self.options.files
        names, made, unused = [], [], []
        for path, cloud in zip(files, self.options.clouds or self.read_whole()):
            try:
                made.append(reading.finished(path, cloud.copy(), wanted))
                names.append(path)
            except NothingChosen as error:
                unused.append((path, error))
        if not made:
            raise unused[0][1]
        cloud = merged(names, made)
        cloud.notes += [f"{path}: {none_chosen()}" for path, _ in unused]
        if self.options.without_value:
            words = counted(self.options.without_value, "point has", "points have")
            cloud.notes.append(f"{words} no {self.options.each_value}: of no surface")
        return cloud

    def read(self):
        options = self.options
        cloud = self.timed("read", "reading", self.read_clouds)
        self.check_spacing(least_reach(cloud.points))
        self.set_crs(cloud)
        crs = project(options.file, cloud) if options.project else cloud.crs
        self.read_questions(cloud, crs)
        lines = self.read_rings()
        if options.faults:
            lines["faults"] = self.read_faults(cloud)
        cloud.notes += self.notes_on_files(lines)
        for data in lines.values() if options.project else ():
            set_crs(data, crs_of(data) or crs)  # lines without one are in that of the points
        names = {"points": options.files[0], **self.line_files()}
        cloud, lines = in_plane(cloud, lines, options.properties)
        lines, notes = fitted(cloud, lines, names, options.properties, options.strict)
        cloud.notes += notes + notes_on(cloud, lines)
        return cloud, lines

    def line_files(self):
        """{name: file} of the lines that are given."""
        files = {name: getattr(self.options, name) for name in (*RINGS, "faults")}
        return {name: path for name, path in files.items() if path}

    def notes_on_files(self, lines):
        """What was noted when the files of lines were read, which are {name: vtkPolyData}."""
        files = self.line_files()
        return [f"{files[name]}: {note}" for name, data in lines.items() for note in take_notes(data)]

    def read_rings(self):
        """{name: vtkPolyData} of those of them that are closed lines."""
        return {
            name: reading.read_boundary(path) for name, path in self.line_files().items() if name in RINGS
        }

    def check_spacing(self, reach):
        try:
            check_spacing(reach, self.options.properties.get("spacing", 0.0))
        except ValueError as error:
            raise WrongOption(f"{self.options.file}: {error}") from None

    def read_questions(self, cloud, crs):
        """What is asked about the surface, which is refused before any work is done.

        crs  of places whose file names none: of the points, before they are projected
        """
        options = self.options
        if options.at:
            from .query import places_in, read_places

            places, own, recognised = read_places(options.at)
            own = own or (crs or "EPSG:4326" if options.project else None)
            moved, notes = places_in(cloud.crs, places, own, options.at, options.file, options.strict)
            self.places = places, moved
            cloud.notes += [*recognised, *notes]
        if options.volume is not None:
            from .query import other_of

            self.other = other_of(options.volume)
            cloud.notes += check_system(self.other.name, self.other.crs, options.file, cloud.crs)

    def read_faults(self, cloud):
        options = self.options
        faults = reading.read_faults(options.faults, options.depth)
        if options.depth and not bare_lines(faults).all():
            cloud.notes.append("z of the faults is turned over too, as --depth says")
        return faults

    def set_crs(self, cloud):
        """--crs counts; a note says so where the file names another system."""
        crs = self.options.crs
        try:
            found = reference_of(cloud.crs)
        except ImportError:
            found = None  # nothing that needs GDAL is asked for
        except ValueError as error:
            cloud.notes.append(f"the file's {error}; see --crs")
            cloud.crs = found = None
        if crs and found and not reference_of(crs).IsSame(found):
            cloud.notes.append(f"--crs {crs} is taken, not {name_of(cloud.crs)} of the file")
        cloud.crs = crs or cloud.crs
        if crs and cloud.points is not None and reference_of(crs).IsGeographic():
            if where := no_angles(coordinates_of(cloud.points).astype("f8"), MOST_ANGLES):
                file = self.options.file
                raise WrongOption(f"--crs: {where} in {file} is not longitude and latitude, as {crs} has them")

    def write(self, result, path, output):
        """Writes one result. Returns notes."""
        words = "writing" if output.name == "output" else f"writing {output.step or output.name}"
        options = self.options
        step = getattr(options, output.step) if output.step else None
        if output.step in ("grid", "at"):
            places = () if output.step == "grid" else (self.places,)
            step = (*places, step, options.method or "linear")
        elif output.step == "volume":
            step = self.other

        def write(partial):
            return write_output(
                output, result, partial, step, lambda fraction: self.progress(words, fraction)
            )

        done = "write" if output.name == "output" else output.step or output.name
        notes = self.timed(done, words, lambda: self.results.add(path, write))
        for other in side_files(path) if result.crs else []:
            self.results.add(other, lambda partial: write_prj(partial, result.crs))
        return notes

    def reconstruct(self, cloud, lines):
        options = self.options
        ranks = self.ranks if total(self.ranks, not can_be_scattered(cloud.points)) == 0 else None
        if is_simplified(options.properties):
            ranks = None  # points are chosen on one rank
        if not self.is_first and not ranks:
            return None  # the first does it alone
        part = cloud.copy()
        try:
            heights = agreed(ranks, lambda: check_heights(cloud, options.properties.get("duplicates")))
            self.start_screen()
            part.points = scatter(ranks, cloud.points)
            result = run_chain(
                part,
                lines,
                options.properties,
                trim=options.trim,
                fill=options.fill,
                progress=self.progress,
                strict=options.strict,
                ranks=ranks,
                heights=heights,
                keep_steps=False,
            )
        except ElevationSurfaceError as error:
            path = self.line_files().get(error.about)
            raise Failure(f"{path or options.file}: {error}") from None
        result.boundary_name, result.faults_name = options.boundary, options.faults
        self.progress("measuring", 0.0)
        result.report  # pylint: disable=pointless-statement  (all ranks make it)
        if result.removes_unused and not ranks:
            result.drop_unused(frees=True)
        if not ranks:
            cloud.points = vtkPolyData()
            result.free_points()
        gather_surface(ranks, result)
        self.times.update(result.times)
        result.times = self.times
        return result

    def draw(self, result):
        from . import picture

        options = self.options
        result.report["picture"] = self.timed(
            "draw",
            "drawing",
            lambda: self.results.add(
                options.picture,
                lambda path: picture.draw(
                    result.surface,
                    path,
                    options.title,
                    picture_subtitle(result),
                    result.holes,
                    result.cloud.plane,
                    view=options.view,
                    exaggeration=options.exaggeration,
                    show_errors=options.colours == "error",
                    progress=lambda fraction: self.progress("drawing", fraction),
                ),
            ),
        )

    def start_screen(self):
        """Starts what a picture needs, which is there then when it is drawn."""
        if self.is_first and self.options.picture is not None:
            with contextlib.suppress(ImportError):  # draw() has the same
                from .picture.display import cancel_screen, start_screen

                start_screen()
                self.end = cancel_screen

    def check(self):
        """Refuses what could not be read, written or drawn, before any work is done."""
        check_options(self.options)
        if self.options.picture_wanted:
            from .picture import check_screen

            check_screen(self.options.picture)

    def nothing(self):
        """What a rank that reads nothing has: no points, and no lines where others have some."""
        return Cloud(vtkPolyData()), {name: vtkPolyData() for name in self.line_files()}

    def write_all(self, result):
        """Writes the results, which do not appear yet. Returns the report."""
        options = self.options
        report = {"file": options.file, **about(options), **result.report}
        result.report = report
        for path, output in files_of(options):
            report["notes"] += self.write(result, path, output)
        if options.picture is not None:
            self.results.keep_in_a_crash()
            try:
                self.draw(result)
            except PictureError as error:
                report["notes"].append(f"no picture: {error.reason}")
                self.no_picture = str(error) if options.picture_wanted else None
            except (Failure, MemoryError) as error:
                self.results.take_back()
                self.no_picture = str(error) or f"{options.picture}: there is not enough memory"
        report["times"] = self.times
        report["written"] = [path for _, path in self.results.pending]
        if options.report:
            report["written"].append(options.report)
            self.results.add(options.report, lambda path: write_report(path, report))
        return report

    def __call__(self):
        """All of a run. Returns the report, on the first rank."""
        by_first(self.ranks, self.check)
        if self.options.in_pieces:
            return Pieces(self)()
        given = by_first(self.ranks, self.read) or self.nothing()
        result = self.reconstruct(*given)
        report = by_first(self.ranks, lambda: self.write_all(result))
        self.results.publish()
        return report

    def check_picture(self):
        """Raises NoPicture, on all ranks, once everything else is written and reported."""
        if total(self.ranks, self.no_picture is not None):
            raise NoPicture(f"{self.no_picture or 'no picture'}; everything else is written")


def run_one(options, ranks):
    """The exit code of one run, the same on all ranks. The first says why, where it fails."""

    def work(run):
        report = run()
        run.progress.clear()
        if report and not options.quiet:
            print_report(report)
        sys.stdout.flush()
        run.check_picture()

    return attempt(options, ranks, work)


def run_each_value(options, ranks):
    """The exit code of a run for each value of a column, as that of run_one()."""
    runs = []

    def work(run):
        parsed = copy.copy(options.parsed)
        parsed.each_value, values = run.values()
        parsed.clouds, parsed.without_value = options.clouds, options.without_value
        runs.extend(options_of(parsed, options.files, value) for value in values)
        outputs = [one.output for one in runs]
        for value, output in zip(values, outputs):
            if outputs.count(output) > 1:
                raise WrongOption(
                    f"{options.file}: --each-value would write {output} twice; '{value}' is one of "
                    "the values: take them one by one, by --where, with names by --output"
                )

    return attempt(options, ranks, work) or max(run_one(one, ranks) for one in runs)


def attempt(options, ranks, work):
    """Calls work(a Run). The exit code, the same on all ranks; the first says why it fails."""
    allow_stops()  # those that were held back while results of the run before appeared
    results = Results()
    run = Run(options, results, ranks)
    try:
        agreed(ranks, lambda: work(run))
        return 0
    except ElevationSurfaceError as error:
        reason, code = str(error), error.code
    except MemoryError:
        reason, code = f"{options.file}: there is not enough memory", 1
    finally:
        run.end()
        results.discard()
    run.progress.clear()
    if run.is_first or code != NoPicture.code:
        print(f"reconstruct: error: {reason}", file=sys.stderr)
    return code


def main(arguments=None, ranks=None):
    """The exit code: 0, 1 where a file or its points cannot be used, 2 for a wrong option, 3 where
    all but the picture is written."""
    options = parse_arguments(arguments)
    # Numbers near the end of their range make infinities; what these mean is reported where it matters.
    numpy.seterr(all="ignore")
    together = [[path] for path in options.files] if options.each else [options.files]
    runs = [options_of(options, files) for files in together]
    outputs = [os.path.abspath(one.output) for one in runs]
    for one, output in zip(runs, outputs):
        if outputs.count(output) > 1:
            make_parser().error(f"--each would write {one.output} twice; {one.file} is one of the files")
    try:
        run = run_each_value if options.each_value else run_one
        with written_for(PROGRAM):
            return max(run(one, ranks) for one in runs)
    except BrokenPipeError:
        # Nobody reads the report any more. What was asked for is done; Python must not try again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
