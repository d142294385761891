# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command line: python3 -m vtkelevationsurface FILE, which Utilities/reconstruct runs."""

import argparse
import copy
import dataclasses
import os
import re
import sys
import time

import numpy

from . import reading
from .clouds import (
    ReadOptions,
    class_numbers,
    merged,
    notes_on,
    three_columns,
)
from .gdal_common import name_of, reference_of
from .writing.grids import write_prj
from .messages import ElevationSurfaceError, FileError, PictureError, did_you_mean
from .pieces import MEMORY, SUFFIX as OF_PIECES, Pieces, check_files, check_given, memory_size
from .writing.outputs import OUTPUTS, beside, check_gdal, default_name, write_output
from .paths import check_suffix, check_writable
from .properties import (
    COLOURS,
    PROPERTIES,
    number_above_zero,
    number_at_least_zero,
    view_angles,
)
from .reconstruction import STEPS, check_spacing, run_chain
from .report import picture_subtitle, print_report
from .results import Failure, Progress, Results, WrongOption, write_report
from .supervisor import allow_stops

HELP = os.path.join(os.path.dirname(os.path.abspath(__file__)), "help.txt")
READ_OPTIONS = [field.name for field in dataclasses.fields(ReadOptions)]


def whole_number(text):
    if int(text) < 1:
        raise ValueError
    return int(text)


# What each option with a value takes, for errors. help.txt explains all options.
TAKES = {
    "--columns": "three columns by name or number from 1, as x,y,z or 1,2,3",
    "--no-data": "an elevation",
    "--band": "a whole number from 1",
    "--layer": "a name",
    "--classes": "numbers from 0 to 255, as 2,8",
    "--faults": "a file",
    "--boundary": "a file",
    "--crs": "a coordinate reference system, as EPSG:25832",
    "--output": "a file",
    "--grid": "a number above 0",
    "--grid-output": "a file",
    "--contours": "a number above 0",
    "--contours-output": "a file",
    "--outlines": "a file, or nothing",
    "--picture": "a file, or nothing",
    "--view": "top, or BEARING,HEIGHT in degrees with a height above 0 and at most 90, as 225,35",
    "--exaggeration": PROPERTIES["gap_tolerance"].takes,
    "--colours": "one of " + ", ".join(COLOURS),
    "--report": "a file, or nothing",
    "--pieces": "a whole number from 1",
    "--memory": MEMORY,
}


def option_of(name):
    """maximum_edge_length -> --maximum-edge-length"""
    return "--" + name.replace("_", "-")


def is_switch(name):
    """Whether a property is on or off: --no-NAME turns it off."""
    return PROPERTIES[name].takes == "True or False"


TAKES["--breaklines"] = TAKES["--faults"]
TAKES.update({option_of(name): PROPERTIES[name].takes for name in PROPERTIES if not is_switch(name)})


def in_options(words):
    """A filter's message, with the names of options where it has names of properties."""
    for name, one in PROPERTIES.items():
        if not one.step or words.startswith(STEPS[one.step]):
            words = re.sub(rf"\b{one.setter[3:]}\b", option_of(name), words)
        if "_" in name:
            words = words.replace(name, option_of(name))
    return words


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
        elif message.startswith("unrecognized arguments: "):
            words = message.split(": ", 1)[1]
            known = list(self._option_string_actions)
            message = f"unknown option {words}{did_you_mean(words.split('=')[0].split()[0], known)}"
        self.exit(2, f"reconstruct: error: {message}; see --help\n")


class ShowHelp(argparse.Action):
    def __call__(self, parser, *_):
        with open(HELP, encoding="utf-8") as stream:
            sys.stdout.write(stream.read())
        parser.exit()


def version():
    from . import __version__
    from vtkmodules.vtkCommonCore import vtkVersion

    return f"reconstruct {__version__} (VTK {vtkVersion.GetVTKVersion()})"


def make_parser():
    parser = Parser(prog="reconstruct", allow_abbrev=False, add_help=False)
    add = parser.add_argument
    add("-h", "--help", action=ShowHelp, nargs=0)
    add("--version", action="version", version=version())
    add("files", metavar="FILE", nargs="*")
    add("--each", action="store_true")
    add("--columns", type=three_columns)
    add("--no-data", type=float)
    add("--keep-nulls", action="store_true")
    add("--depth", action="store_true")
    add("--band", type=whole_number)
    add("--layer")
    add("--classes", type=class_numbers)
    add("--faults", "--breaklines", dest="faults")
    add("--boundary")
    for name, one in PROPERTIES.items():
        if is_switch(name):
            add("--no-" + name.replace("_", "-"), dest=name, action="store_false", default=None)
        else:
            add(option_of(name), type=one.convert)
    add("--pieces", type=whole_number)
    add("--memory", type=memory_size)
    add("--no-trim", dest="trim", action="store_false")
    add("--no-fill", dest="fill", action="store_false")
    add("--crs")
    add("-o", "--output")
    for one in ("grid", "contours"):
        add(f"--{one}", type=number_above_zero)
        add(f"--{one}-output")
    add("--outlines", nargs="?", const="")
    add("--picture", nargs="?", const="")
    add("--no-picture", action="store_true")
    add("--view", type=view_angles)
    add("--exaggeration", type=number_at_least_zero, default=0.0)
    add("--colours", choices=COLOURS)
    add("--report", nargs="?", const="")
    add("--strict", action="store_true")
    add("--quiet", action="store_true")
    return parser


def parse_arguments(arguments):
    parser = make_parser()
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    end = arguments.index("--") if "--" in arguments else len(arguments)
    options = parser.parse_intermixed_args(arguments[:end])
    options.files += arguments[end + 1 :]
    if not options.files:
        parser.error("no file is given")
    options.command = ["reconstruct", *arguments]
    options.given = {
        name: getattr(options, name) for name in PROPERTIES if getattr(options, name) is not None
    }
    options.in_pieces = options.pieces is not None or options.memory is not None
    if options.in_pieces:
        check_given(options, parser.error)
    of_trim, of_fill = (
        [name for name in options.given if PROPERTIES[name].step == step] for step in ("trim", "fill")
    )
    if not options.trim and (options.boundary or of_trim):
        parser.error("--no-trim leaves nothing for the trimming options to do")
    if not options.fill and of_fill:
        parser.error("--no-fill leaves nothing for the filling options to do")
    if not options.fill and options.colours == "error":
        parser.error("--no-fill leaves no errors to draw: --colours error is for filled holes")
    if options.no_picture and (
        options.picture is not None or options.view or options.exaggeration or options.colours
    ):
        parser.error("--no-picture leaves nothing for the picture options to do")
    for one in OUTPUTS:
        if one.step and getattr(options, one.name) and not getattr(options, one.step):
            parser.error(f"{option_of(one.name)} is for the result of --{one.step}, which is missing")
    if options.outlines is not None and not (options.trim or options.fill):
        parser.error("--no-trim and --no-fill leave no outlines")
    names = [getattr(options, one.name) for one in OUTPUTS]
    if options.each and (any(names) or options.picture or options.report):
        parser.error("--each names the results of each file itself: leave out the names of results")
    return options


def options_of(options, files):
    """The options of one run, with the names of all results, for files that are merged."""
    options = copy.copy(options)
    options.files = files
    options.file = " + ".join(files)
    name = os.path.basename(files[0])
    name = "points" if name == "-" else name[:-3] if name.lower().endswith(".gz") else name
    if options.output is None:
        options.output = os.path.splitext(name)[0] + "_surface.vtp" + "d" * options.in_pieces
    for one in OUTPUTS:
        wanted = getattr(options, one.step) if one.step else getattr(options, one.name) is not None
        if wanted and not getattr(options, one.name):
            setattr(options, one.name, default_name(one, options.output))
    stem = os.path.splitext(options.output)[0]
    options.picture_wanted = options.picture is not None
    if options.no_picture:
        options.picture = None
    elif not options.picture:
        options.picture = stem + ".png"
    if options.report == "":
        options.report = stem + ".json"
    return options


def about(options):
    """The run, for the report: the version, the command, and the options that are not the default."""
    from . import __version__

    plain = vars(make_parser().parse_args(["FILE"]))
    return {
        "version": __version__,
        "command": options.command,
        "options": {
            name: value
            for name, value in vars(options).items()
            if name in plain and name != "files" and value != plain[name]
        },
    }


def read_options(options):
    """The options that concern reading, by name."""
    return {name: value for name, value in vars(options).items() if name in READ_OPTIONS}


def files_of(options):
    """[(path, Output)] of what is asked for, but picture and report."""
    return [(getattr(options, one.name), one) for one in OUTPUTS if getattr(options, one.name)]


def check_options(options):
    """Refuses what could not be read or written, before any work is done."""
    try:
        for path, one in files_of(options):
            suffixes = (OF_PIECES,) if options.in_pieces else one.suffixes
            check_suffix(path, suffixes, "written in pieces" if options.in_pieces else "written")
            if one.name != "output":
                check_gdal(path)
        if options.crs:
            check_gdal("--crs")
            reference_of(options.crs)
        if options.picture is not None:
            check_suffix(options.picture, (".png",), "written as a picture")
        for path in options.files:
            reading.check_options(path, **read_options(options))
        if options.in_pieces:
            check_files(options)
    except FileError as error:
        raise WrongOption(str(error)) from None
    except ValueError as error:
        raise WrongOption(f"--crs: {error}") from None
    wanted = [p for p in (options.picture, options.report) if p]
    for path, _ in files_of(options):
        wanted += [path, *beside(path)]
    inputs = [p for p in (*options.files, options.faults, options.boundary) if p]
    for i, path in enumerate(wanted):
        check_writable(path)
        if os.path.abspath(path) in map(os.path.abspath, wanted[:i]):
            raise WrongOption(f"{path}: two results have this name")
        for other in inputs:
            if os.path.abspath(path) == os.path.abspath(other):
                raise WrongOption(f"{path}: would overwrite {other}")


class Run:
    """One reconstruction of the command line, with its progress and its times."""

    def __init__(self, options, results):
        self.options = options
        self.results = results
        self.progress = Progress(sys.stderr.isatty() and not options.quiet)
        self.times = {}

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

    def read(self):
        options, wanted = self.options, self.read_options()
        cloud = self.timed(
            "read",
            "reading",
            lambda: merged(
                options.files, [reading.read(path, **wanted) for path in options.files]
            ),
        )
        try:
            check_spacing(cloud.points, options.given.get("spacing", 0.0))
        except ValueError as error:
            raise WrongOption(f"{options.file}: --{error}") from None
        self.set_crs(cloud)
        lines = {}
        if options.boundary:
            lines["boundary"] = reading.read_boundary(options.boundary)
        if options.faults:
            lines["faults"] = reading.read_faults(options.faults, options.depth)
            if options.depth:
                cloud.notes.append("z of the faults is turned over too, as --depth says")
        names = {"points": options.files[0], "boundary": options.boundary, "faults": options.faults}
        cloud.notes += notes_on(cloud, lines, names)
        return cloud, lines.get("boundary"), lines.get("faults")

    def set_crs(self, cloud):
        """What --crs says counts, and is told where the file says something else."""
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

    def write(self, result, path, output):
        """Writes one result. Returns notes."""
        words = "writing" if output.name == "output" else f"writing {output.step or output.name}"
        step = getattr(self.options, output.step) if output.step else None

        def write(partial):
            return write_output(
                output, result, partial, step, lambda fraction: self.progress(words, fraction)
            )

        done = "write" if output.name == "output" else output.step or output.name
        notes = self.timed(done, words, lambda: self.results.add(path, write))
        for other in beside(path) if result.crs else []:
            self.results.add(other, lambda partial: write_prj(partial, result.crs))
        return notes

    def reconstruct(self, cloud, boundary, faults):
        options = self.options
        try:
            result = run_chain(
                cloud,
                boundary,
                faults,
                options.given,
                trim=options.trim,
                fill=options.fill,
                progress=self.progress,
                strict=options.strict,
            )
        except ElevationSurfaceError as error:
            path = {"boundary": options.boundary, "faults": options.faults}.get(error.about)
            raise Failure(f"{path or options.file}: {in_options(str(error))}") from None
        result.notes = [in_options(note) for note in result.notes]
        result.boundary_name, result.faults_name = options.boundary, options.faults
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
                    os.path.basename(options.file),
                    picture_subtitle(result),
                    result.holes,
                    view=options.view,
                    exaggeration=options.exaggeration,
                    show_errors=options.colours == "error",
                    progress=lambda fraction: self.progress("drawing", fraction),
                ),
            ),
        )

    def __call__(self):
        """Everything between the options and the report, which it returns."""
        options = self.options
        if options.picture_wanted:
            # Before any work is done.
            from .picture import screen_for

            with screen_for(options.picture):
                pass
        result = self.reconstruct(*self.read())
        self.progress("measuring", 0.0)
        report = {"file": options.file, **about(options), **result.report}
        result.report = report
        for path, output in files_of(options):
            report["notes"] += self.write(result, path, output)
        if options.picture is not None:
            try:
                self.draw(result)
            except PictureError as error:
                if options.picture_wanted:
                    raise
                report["notes"].append(f"no picture: {error.reason}")
        report["times"] = self.times
        report["written"] = [path for _, path in self.results.pending]
        if options.report:
            report["written"].append(options.report)
            self.results.add(options.report, lambda path: write_report(path, report))
        self.results.publish()
        return report


def run_one(options):
    """The exit code of one run. Says why, where it fails."""
    allow_stops()  # those that were held back while results of the run before appeared
    results = Results()
    run = Run(options, results)
    try:
        check_options(options)
        report = Pieces(run)() if options.in_pieces else run()
        run.progress.clear()
        if not options.quiet:
            print_report(report)
        sys.stdout.flush()
        return 0
    except ElevationSurfaceError as error:
        reason, code = str(error), 2 if isinstance(error, WrongOption) else 1
    except MemoryError:
        reason, code = f"{options.file}: there is not enough memory", 1
    finally:
        results.discard()
    run.progress.clear()
    print(f"reconstruct: error: {reason}", file=sys.stderr)
    return code


def main(arguments=None):
    """The exit code: 0, 1 where a file or its points cannot be used, 2 for a wrong option."""
    options = parse_arguments(arguments)
    # Numbers near the end of their range make infinities; what these mean is told where it matters.
    numpy.seterr(all="ignore")
    together = [[path] for path in options.files] if options.each else [options.files]
    runs = [options_of(options, files) for files in together]
    outputs = [os.path.abspath(one.output) for one in runs]
    for one, output in zip(runs, outputs):
        if outputs.count(output) > 1:
            make_parser().error(f"--each would write {one.output} twice; {one.file} is one of the files")
    try:
        return max(run_one(one) for one in runs)
    except BrokenPipeError:
        # Nobody reads the report any more. What was asked for is done; Python must not try again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
