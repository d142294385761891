# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The options of the command line, and what is refused before any work is done."""

import argparse
import copy
import dataclasses
import os
import re
import sys

from . import reading
from .clouds import ReadOptions, class_numbers, three_columns
from .gdal_common import reference_of
from .messages import FileError, did_you_mean
from .paths import check_suffix, check_writable
from .pieces import MEMORY, SUFFIX as OF_PIECES, check_files, check_given, memory_size
from .properties import (
    COLOURS,
    PROPERTIES,
    check_together,
    number_above_zero,
    number_at_least_zero,
    option_of,
    view_angles,
)
from .results import WrongOption
from .selecting import as_option, condition
from .writing.outputs import OUTPUTS, beside, check_gdal, default_name

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
    "--where": "COLUMN=VALUE, as horizon=Top",
    "--each-value": "a column",
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


def is_switch(name):
    """Whether a property is on or off."""
    return PROPERTIES[name].takes == "True or False"


TAKES["--breaklines"] = TAKES["--faults"]
TAKES.update({option_of(name): PROPERTIES[name].takes for name in PROPERTIES if not is_switch(name)})


class Parser(argparse.ArgumentParser):
    """Errors are one line that names the option and what it takes."""

    def error(self, message):
        found = re.match(r"argument ([^:]+): (.*)", message)
        if found:
            option = found.group(1).split("/--no-")[0].split("/")[-1]
            given = re.search(r"(?:value|choice): ('.*?')(?: \(choose.*)?$", found.group(2))
            message = f"{option}: {found.group(2)}"
            if option in TAKES:
                given = f", not {given.group(1)}" if given else ""
                message = f"{option} takes {TAKES[option]}{given}"
            elif found.group(2).startswith("ignored explicit argument"):
                message = f"{option} takes no value"
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
    add("--where", type=condition, action="append")
    add("--each-value")
    add("--points-only", action="store_true")
    add("--faults", "--breaklines", dest="faults")
    add("--boundary")
    for name, one in PROPERTIES.items():
        if is_switch(name):
            add(option_of(name), action=argparse.BooleanOptionalAction)
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
    options.clouds = None  # those of the files, where they are read already
    options.without_value = 0  # how many points have none in the column of --each-value
    options.given = {
        name: getattr(options, name) for name in PROPERTIES if getattr(options, name) is not None
    }
    try:
        check_together(options.given, option_of)
    except ValueError as error:
        parser.error(str(error))
    options.in_pieces = options.pieces is not None or options.memory is not None
    if options.in_pieces:
        check_given(options, parser.error)
    of_trim, of_fill = (
        [name for name in options.given if PROPERTIES[name].step == step] for step in ("trim", "fill")
    )
    if "faults_z" in options.given and not options.faults:
        parser.error("--faults-z is for the lines of --faults, which is missing")
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
    for each, of in (("each", "file"), ("each_value", "value")):
        if getattr(options, each) and (any(names) or options.picture or options.report):
            parser.error(
                f"{option_of(each)} names the results of each {of} itself: "
                "leave out the names of results"
            )
    if options.each_value and options.in_pieces:
        one = as_option("COLUMN", "VALUE")
        parser.error(f"--each-value needs all points in memory: in pieces, {one} takes one value")
    return options


def options_of(options, files, value=None):
    """The options of one run, with the names of all results, for files that are merged.

    value  of --each-value, the one of this run, which the names of results hold
    """
    options, parsed = copy.copy(options), options
    options.parsed = parsed
    options.files = files
    options.file = " + ".join(files)
    options.title = os.path.basename(options.file)
    name = os.path.basename(files[0])
    name = "points" if name == "-" else name[:-3] if name.lower().endswith(".gz") else name
    stem = os.path.splitext(name)[0]
    if value is not None:
        column = options.each_value
        options.where = [*(options.where or ()), (column, value)]
        options.file += f", {column} = {value}"
        options.title += f", {column} = {value}"
        stem += "_" + (re.sub(r"[^\w.+-]+", "_", value).strip("_.") or "value")
    if options.output is None:
        options.output = stem + "_surface.vtp" + "d" * options.in_pieces
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
