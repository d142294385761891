# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The methods that void-bench compares, why one is missing, and how they are run and measured."""

import importlib.util
import os
import selectors
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from typing import NamedTuple

import numpy

import VoidPeers
from ProgramRun import with_absolute_paths

HERE = os.path.dirname(os.path.abspath(__file__))
CANDIDATES = ("Membrane", "ThinPlate", "CubicSpline")  # what Adaptive chooses from
START_LIMIT = 120  # seconds until a method is ready


class Method(NamedTuple):
    name: str
    command: tuple
    missing: str  # why it cannot be run; empty where it can
    what: str  # for the report


class Measured(NamedTuple):
    """Of one method: each lost node of all voids, one after another, and each void."""

    errors: numpy.ndarray  # of heights; NaN where none was given
    inside: numpy.ndarray  # 1 where the truth is in the interval, 0 where it is not, NaN without one
    seconds: numpy.ndarray  # of the processor, for each void; NaN where it was not filled
    notes: list  # for each void: "", or why it was not filled


# ---- which there are ----------------------------------------------------------------------------


def ends_well(*command):
    try:
        return subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, check=False, timeout=60).returncode == 0
    except (OSError, subprocess.TimeoutExpired):
        return False


def no_module(name, package):
    try:
        found = importlib.util.find_spec(name)
    except ModuleNotFoundError:
        found = None
    return "" if found else f"{sys.executable} has no module {name} (Debian: {package})"


def no_program(name, package):
    return "" if shutil.which(name) else f"the program {name} was not found (Debian: {package})"


def no_gmt():
    missing = no_program("gmt", "gmt")
    if missing:
        return missing
    usage = subprocess.run(["gmt", "grdfill"], capture_output=True, text=True, check=False)
    has_spline = "spline" in usage.stderr + usage.stdout
    return "" if has_spline else "this version of grdfill has no spline"


def no_gstat():
    missing = no_program("Rscript", "r-base-core")
    if missing:
        return missing
    found = ends_well("Rscript", "--vanilla", "-e", "library(sp); library(gstat)")
    return "" if found else "R has no package gstat (Debian: r-cran-gstat)"


def methods_of(programs):
    """All that void-bench knows, those that are missing, too."""
    peers = (sys.executable, os.path.join(HERE, "VoidPeers.py"))
    package = no_module("vtkelevationsurface", "see Documentation/Installing.md")
    ours = [Method(name, (*peers, "ours", name), package, f"vtkFillElevationHoles, {name}")
            for name in VoidPeers.OURS]
    linear = Method("linear", (*peers, "ours", "linear"), package, "our patch without new points")
    cgal = os.path.join(programs, "FillVoidsCGAL")
    gmt, grass = no_gmt(), no_program("grass", "grass-core")
    session = ("grass", "--tmp-location", "XY", "--exec")
    return [
        *ours, linear,
        Method("CGAL", (cgal,), "" if os.path.exists(cgal) else
               f"{cgal} is not built (needs Debian's libcgal-dev and libeigen3-dev)",
               "triangulate_refine_and_fair_hole"),
        Method("vtkFillHoles", (*peers, "vtk"), no_module("vtkmodules", "python3-vtk9"),
               "vtkFillHolesFilter"),
        Method("GDAL", (*peers, "gdal"), no_module("osgeo", "python3-gdal"),
               "FillNodata with the defaults of gdal_fillnodata"),
        Method("GMT", (*peers, "gmt"), gmt, "gmt grdfill -As: a spline of least curvature"),
        Method("GMT tension", (*peers, "gmt", "0.35"), gmt,
               "gmt grdfill -As0.35: a spline in tension"),
        Method("kriging", ("Rscript", "--vanilla", os.path.join(HERE, "VoidKriging.R")), no_gstat(),
               "R's gstat: ordinary kriging, VoidKriging.R"),
        Method("GRASS", (*session, *peers, "rst"), grass,
               "v.surf.rst as r.fillnulls runs it: regularised spline with tension"),
        Method("r.fillnulls", (*session, *peers, "fillnulls"), grass, "GRASS r.fillnulls itself"),
    ]


# Not among the default ones: three seconds of start-up a void, and the figures are those of GRASS.
ONLY_BY_NAME = ("r.fillnulls",)


# ---- how they are run ---------------------------------------------------------------------------


class Gone(Exception):
    """A method's program has ended, or takes too long."""


class Program:
    """A method's program, in a group of processes and a folder for temporary files of its own."""

    def __init__(self, command, folder):
        environment = {**with_absolute_paths(os.environ), "TMPDIR": folder, "OMP_NUM_THREADS": "1",
                       "PYTHONDONTWRITEBYTECODE": "1"}
        self.rest = b""
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            start_new_session=True, env=environment, cwd=folder)
        self.selector = selectors.DefaultSelector()
        self.selector.register(self.process.stdout, selectors.EVENT_READ)
        try:
            self.answer(("ready",), START_LIMIT)
        except Gone as error:
            self.end()
            raise Gone(f"does not start: {error}") from None

    def answer(self, words, limit):
        """The next line that begins with one of the words; what libraries write does not count."""
        until = time.monotonic() + limit
        while True:
            line, found, rest = self.rest.partition(b"\n")
            if found:
                self.rest = rest
                text = line.decode(errors="replace").strip()
                if text.split(" ")[0] in words:
                    return text
                continue
            if not self.selector.select(max(0.0, until - time.monotonic())):
                raise Gone(f"more than {limit:g} s")
            more = os.read(self.process.stdout.fileno(), 65536)
            if not more:
                raise Gone(f"the program ended with code {self.process.wait()}")
            self.rest += more

    def fill(self, source, target, limit):
        try:
            self.process.stdin.write(f"{source}\t{target}\n".encode())
            self.process.stdin.flush()
        except OSError:
            raise Gone("the program has ended") from None
        return self.answer(("done", "failed"), limit)

    def end(self):
        """It, and whatever it has started."""
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self.process.wait()
        self.selector.close()
        self.process.stdin.close()
        self.process.stdout.close()

    def finish(self):
        """Lets it end by itself, where it does so soon."""
        self.process.stdin.close()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            pass
        self.end()


def judged(void, rasters):
    """(errors, inside) at the lost nodes."""
    truth = void.heights[void.lost]
    errors = rasters[0][void.lost] - truth
    inside = numpy.full(errors.shape, numpy.nan)
    if len(rasters) == 3:
        low, high = rasters[1][void.lost], rasters[2][void.lost]
        known = ~numpy.isnan(low) & ~numpy.isnan(high)
        inside[known] = ((low <= truth) & (truth <= high))[known]
    return errors, inside


def measure(method, voids, limit, progress=lambda done: None):
    """Fills all voids; one that ends the program or takes too long costs that void alone."""
    errors, inside, seconds, notes = [], [], numpy.full(len(voids), numpy.nan), []
    with tempfile.TemporaryDirectory() as folder:
        source, target = os.path.join(folder, "void"), os.path.join(folder, "filled")
        program = None
        for number, void in enumerate(voids):
            VoidPeers.write_void(source, void.damaged(), void.lost, void.steps)
            if os.path.exists(target):
                os.remove(target)
            rasters, note = None, ""
            try:
                program = program or Program(method.command, folder)
                answer = program.fill(source, target, limit)
                if answer.startswith("done"):
                    rasters = VoidPeers.read_filled(target, void.lost.shape)
                    seconds[number] = float(answer.split()[1])
                else:
                    note = answer
            except Gone as error:
                note = f"failed {error}"
                if program is None:
                    raise
                program.end()
                program = None
            except (OSError, ValueError, IndexError, VoidPeers.Failed) as error:
                note, rasters = f"failed {error}", None
            if rasters is None:
                rasters = [numpy.full(void.lost.shape, numpy.nan)]
            of_void = judged(void, rasters)
            errors.append(of_void[0])
            inside.append(of_void[1])
            notes.append(note)
            progress(number + 1)
        if program:
            program.finish()
    return Measured(numpy.concatenate(errors), numpy.concatenate(inside), seconds, notes)


# ---- what is kept -------------------------------------------------------------------------------


def path_of(folder, name):
    return os.path.join(folder, "measured", name.replace(" ", "_") + ".npz")


def store(folder, name, fingerprint, measured):
    path = path_of(folder, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    numpy.savez_compressed(
        path, fingerprint=fingerprint, errors=measured.errors, inside=measured.inside,
        seconds=measured.seconds, notes=numpy.array(measured.notes, dtype=str))


def stored(folder, name, fingerprint):
    """Of the same draw; None where there is none."""
    try:
        with numpy.load(path_of(folder, name)) as file:
            if str(file["fingerprint"]) != fingerprint:
                return None
            return Measured(file["errors"], file["inside"], file["seconds"],
                            [str(note) for note in file["notes"]])
    except (OSError, KeyError, ValueError):
        return None
