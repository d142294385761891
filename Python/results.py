# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a run shows and leaves: progress, files that appear together, errors."""

import json
import os
import sys

from .messages import ElevationSurfaceError, FileError, PictureError
from .paths import partial_path
from .supervisor import hold_stops, note_finished_file, note_partial_file, note_whole_file


class Failure(ElevationSurfaceError):
    """Something the user must know in one line; nothing is written."""


class WrongOption(Failure):
    """A Failure of the command line."""

    code = 2


class NoPicture(Failure):
    """The picture that was asked for is missing; everything else is written."""

    code = 3


class Progress:
    """One line on a terminal that fills from left to right; silent anywhere else."""

    def __init__(self, on):
        self.on = on
        self.shown = None

    def __call__(self, text, fraction):
        state = (text, int(100 * fraction))
        if self.on and state != self.shown:
            self.shown = state
            bar = "#" * int(30 * fraction)
            sys.stderr.write(f"\r{text:<16}[{bar:<30}] {state[1]:3d} %")
            sys.stderr.flush()

    def clear(self):
        if self.on and self.shown:
            sys.stderr.write("\r" + " " * 60 + "\r")
            sys.stderr.flush()
            self.shown = None


class Results:
    """Files that appear together at the end, or not at all.

    Each is written next to its final place and renamed when all are complete.
    """

    def __init__(self):
        self.pending = []

    def add(self, path, write, partial=None):
        """Lets write(partial) write a result, whose folder may have to be made when it appears."""
        partial = partial or partial_path(path)
        self.pending.append((partial, path))
        try:
            note_partial_file(partial)
            return write(partial)
        except PictureError as error:
            self.take_back()
            raise PictureError(path, error.reason) from None
        except (OSError, FileError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            reason = reason.replace(partial, path)
            raise Failure(f"{path}: cannot be written: {reason}") from None

    def take_back(self):
        """Removes what was added last."""
        remove(self.pending.pop()[0])

    def keep_in_a_crash(self):
        """What has been added is complete: it appears, even if a library crashes from here on."""
        for partial, path in self.pending:
            note_whole_file(partial, path)

    def publish(self):
        """Lets all files appear. From here on the run counts as done: nothing stops it any more."""
        hold_stops()
        for partial, path in self.pending:
            try:
                os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
                os.replace(partial, path)
            except OSError as error:
                raise Failure(f"{path}: cannot be written: {error.strerror}") from None
            note_finished_file(path)
        self.pending = []

    def discard(self):
        for partial, _ in self.pending:
            remove(partial)
        self.pending = []


def remove(path):
    try:
        os.remove(path)
    except OSError:
        pass


def write_report(path, report):
    with open(path, "w", encoding="utf-8") as stream:
        json.dump(report, stream, indent=1)
        stream.write("\n")
