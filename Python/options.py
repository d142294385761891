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
from .description import DESCRIBED
from .gdal_common import reference_of
from .help import help_text
from .messages import FileError, did_you_mean
from .names import option
from .paths import check_suffix, check_writable
from .pieces import MEMORY, SUFFIX as PIECES_SUFFIX, check_files, check_given, memory_size
from .properties import COLOURS, METHODS, PROPERTIES, check_together
from .results import WrongOption
from .selecting import condition
from .writing.grids import side_files
from .writing.outputs import OUTPUTS, check_gdal, default_name

READ_OPTIONS = [field.name for field in dataclasses.fields(ReadOptions)]


# What text becomes that properties.ini does not know how to convert.
CONVERT = {
    "columns": three_columns,
    "classes": class_numbers,
    "where": condition,
    "memory": memory_size,
    "colours": lambda text: COLOURS[DESCRIBED["colours"].convert(text)],
    "method": lambda text: METHODS[DESCRIBED["method"].convert(text)],
}
ACTIONS = {"flag": "store_true", "switch": argparse.BooleanOptionalAction, "where": "append"}
OPTIONS = {name: one for name, one in DESCRIBED.items() if "program" in one.places}
# What each option with a value takes, for errors.
TAKES = {
    which: one.takes for one in OPTIONS.values() if one.kind.metavar for which in one.options
}
TAKES["--memory"] = MEMORY


class Parser(argparse.ArgumentParser):
    """Errors are one line that names the option and what it takes."""

    def error(self, message):
        found = re.match(r"argument ([^:]+): (.*)", message)
        if found:
            which = found.group(1).split("/--no-")[0].split("/")[-1]
            given = re.search(r"(?:value|choice): ('.*?')(?: \(choose.*)?$", found.group(2))
            message = f"{which}: {found.group(2)}"
            if which in TAKES:
                given = f", not {given.group(1)}" if given else ""
                message = f"{which} takes {TAKES[which]}{given}"
            elif found.group(2).startswith("ignored explicit argument"):
                message = f"{which} takes no value"
        elif message.startswith("unrecognized arguments: "):
            words = message.split(": ", 1)[1]
            known = list(self._option_string_actions)
            message = f"unknown option {words}{did_you_mean(words.split('=')[0].split()[0], known)}"
        self.exit(2, f"reconstruct: error: {message}; see --help\n")


class ShowHelp(argparse.Action):
    def __call__(self, parser, *_):
        sys.stdout.write(help_text())
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
    for name, one in OPTIONS.items():
        how = {"dest": name, "action": ACTIONS.get(one.words["takes"], "store")}
        if "off" in one.words:
            how["action"] = "store_false"
        if one.kind.metavar:
            how["type"] = CONVERT.get(name, one.convert)
        if one.kind.metavar.startswith("["):
            how.update(nargs="?", const="")
        add(*one.options, **how)
    return parser


def parse_arguments(arguments):
    parser = make_parser()
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    if ["--grid", "like"] in [arguments[i : i + 2] for i in range(len(arguments) - 2)]:
        at = arguments.index("--grid") + 1
        arguments[at : at + 2] = [" ".join(arguments[at : at + 2])]
    end = arguments.index("--") if "--" in arguments else len(arguments)
    options = parser.parse_intermixed_args(arguments[:end])
    options.files += arguments[end + 1 :]
    if not options.files:
        parser.error("no file given")
    options.command = ["reconstruct", *arguments]
    options.clouds = None  # those of the files, where they are read already
    options.without_value = 0  # how many points have none in the column of --each-value
    options.properties = {
        name: getattr(options, name) for name in PROPERTIES if getattr(options, name) is not None
    }
    try:
        check_together({name: getattr(options, name) for name in OPTIONS}, option, OPTIONS)
    except ValueError as error:
        parser.error(str(error))
    options.in_pieces = options.pieces is not None or options.memory is not None
    if options.in_pieces:
        check_given(options, parser.error)
    for step, words in (("trim", "trimming"), ("fill", "filling"), ("picture", "picture")):
        off = f"--no-{step}"
        step_options = [n for n, one in OPTIONS.items() if one.step == step and off not in one.options]
        is_off = options.no_picture if step == "picture" else not getattr(options, step)
        if is_off and any(getattr(options, one) != parser.get_default(one) for one in step_options):
            parser.error(f"{words} options have no effect with {off}")
    if not options.fill and options.colours == "error":
        parser.error("--colours error is for filled holes: it has no effect with --no-fill")
    if options.outlines is not None and not (options.trim or options.fill):
        parser.error("there are no outlines with --no-trim and --no-fill")
    if options.method and options.grid is None and options.at is None:
        parser.error("--method is for --grid and --at: it has no effect without them")
    names = [getattr(options, one.name) for one in OUTPUTS]
    for each, of in (("each", "file"), ("each_value", "value")):
        if getattr(options, each) and (any(names) or options.picture or options.report):
            parser.error(
                f"{option(each)} names the results of each {of} itself: "
                "leave out the names of results"
            )
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
        wanted = getattr(options, one.step or one.name) is not None
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
    like = options.grid if isinstance(options.grid, str) else None
    try:
        for path, one in files_of(options):
            suffixes = (PIECES_SUFFIX,) if options.in_pieces else one.suffixes
            check_suffix(path, suffixes, "written in pieces" if options.in_pieces else "written")
            if one.name != "output":
                check_gdal(path)
        if options.crs:
            check_gdal("--crs")
            reference_of(options.crs)
        if options.picture is not None:
            check_suffix(options.picture, (".png",), "written as a picture")
        if like:
            reading.raster_frame(like)
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
        wanted += [path, *side_files(path)]
    other = options.volume if isinstance(options.volume, str) else None
    lines = [getattr(options, name) for name, one in OPTIONS.items() if one.words["takes"] == "lines"]
    given = (*options.files, *lines, like, options.at, other)
    inputs = [path for path in given if path]
    for i, path in enumerate(wanted):
        check_writable(path)
        if os.path.abspath(path) in map(os.path.abspath, wanted[:i]):
            raise WrongOption(f"{path}: two results have this name")
        for other in inputs:
            if os.path.abspath(path) == os.path.abspath(other):
                raise WrongOption(f"{path}: would overwrite {other}")
