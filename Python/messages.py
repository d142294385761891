# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Errors of the package, and what VTK reports, as plain words."""

import difflib
import re

from vtkmodules.vtkCommonCore import VTK_STRING, vtkLogger, vtkOutputWindow


class ElevationSurfaceError(RuntimeError):
    """Why there is no surface, in one line.

    about tells what it is about: "points", "boundary" or "faults".
    """

    code = 1  # the program's exit code

    def __init__(self, message, about="points"):
        super().__init__(message)
        self.about = about


class Aborted(Exception):
    """The user wants no result any more."""


class ElevationSurfaceWarning(UserWarning):
    """A surface that may not be what was meant, in one line."""


class FileError(ElevationSurfaceError):
    """A file that cannot be used. The text is one line and begins with the file's name."""


class PictureError(ElevationSurfaceError):
    """Why a picture cannot be drawn."""

    def __init__(self, path, reason):
        super().__init__(f"{path}: cannot be drawn: {reason}")
        self.reason = reason


def did_you_mean(word, words):
    """"; did you mean x?" for the word of a list that is most like the given one, or ""."""
    plain = {known.lstrip("-"): known for known in words}
    near = difflib.get_close_matches(word.lstrip("-"), plain, 1, 0.6)
    return f"; did you mean {plain[near[0]]}?" if near else ""


def counted(count, singular, plural=None):
    """1 hole, 2 holes"""
    return f"{count:,} {singular if count == 1 else plural or singular + 's'}"


def of_reason(count, reason):
    """"1 row without data" of a reason of Cloud.left_out, "rows without data"."""
    return counted(count, re.sub(r"s\b", "", reason, count=1), reason)


class Messages:
    """Collects what VTK reports instead of letting it print.

    Use as a context manager. `errors` and `warnings` are lists of plain lines, without the
    source file, the object's address and the follow-up complaints of VTK's executives.

    sources  objects whose messages are taken before they come to the output window: programs as
             ParaView have one of their own, which shows what comes to it
    """

    def __init__(self, *sources):
        self.sources = sources
        self.errors = []
        self.warnings = []

    def __enter__(self):
        window = vtkOutputWindow.GetInstance()
        self._mode = window.GetDisplayMode()
        self._verbosity = vtkLogger.GetCurrentVerbosityCutoff()
        window.SetDisplayModeToNever()
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)

        def note(_caller, event, text):
            self.take(event, text)

        note.CallDataType = VTK_STRING
        self._tags = [
            (source, source.AddObserver(event, note))
            for source in (window, *self.sources)
            for event in ("ErrorEvent", "WarningEvent")
        ]
        return self

    def __exit__(self, *_):
        window = vtkOutputWindow.GetInstance()
        for source, tag in self._tags:
            source.RemoveObserver(tag)
        window.SetDisplayMode(self._mode)
        vtkLogger.SetStderrVerbosity(self._verbosity)

    def take(self, event, text):
        line = plain_message(text)
        if not line or "returned failure for request" in line:
            return
        lines = self.errors if event == "ErrorEvent" else self.warnings
        if line not in lines:
            lines.append(line)


def plain_message(text):
    """The words of a VTK message: "ERROR: In f.cxx, line 3\\nvtkX (0x1): words" -> "words"."""
    found = re.search(r"\(0x[0-9a-fA-F]+\):\s*(.*)", text or "", re.DOTALL)
    words = found.group(1) if found else (text or "")
    return " ".join(words.split())
