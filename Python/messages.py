# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Errors of the package, and what VTK reports, as plain words."""

import difflib
import re
import sys

from vtkmodules.vtkCommonCore import VTK_STRING, vtkLogger, vtkOutputWindow


class ElevationSurfaceError(RuntimeError):
    """Why there is no surface, in one line.

    about    what it is about: "points", "boundary" or "faults"
    step     the step of the chain that fails, with which the line begins; "": none
    message  the line without the step
    """

    code = 1  # the program's exit code

    def __init__(self, message, about="points", step=""):
        super().__init__(f"{step}: {message}" if step else message)
        self.message, self.about, self.step = message, about, step


class Aborted(Exception):
    """The user wants no result any more."""


class ElevationSurfaceWarning(UserWarning):
    """A surface that may not be what was meant, in one line."""


class FileError(ElevationSurfaceError):
    """A file that cannot be used. The text is one line and begins with the file's name; below a question
    about columns are the first rows."""


class PictureError(ElevationSurfaceError):
    """Why a picture cannot be drawn."""

    def __init__(self, path, reason):
        super().__init__(f"{path}: cannot be drawn: {reason}")
        self.reason = reason


def did_you_mean(word, words):
    """"; did you mean x?" for the word of a list that is most like the given one, or ""."""
    plain = {known.lstrip("-").lower(): known for known in words}
    near = difflib.get_close_matches(word.lstrip("-").lower(), plain, 1, 0.6)
    return f"; did you mean {plain[near[0]]}?" if near else ""


def counted(count, singular, plural=None):
    """1 hole, 2 holes"""
    return f"{count:,} {singular if count == 1 else plural or singular + 's'}"


class Reason(str):
    """Why some of a file are not points: "rows without data" of Reason("row", "without data")."""

    def __new__(cls, noun, rest=""):
        self = super().__new__(cls, f"{noun}s {rest}".rstrip())
        self.parts = (noun, rest)
        self.singular = f"{noun} {rest}".rstrip()
        return self


def counted_reason(count, reason):
    """"1 row without data" of a Reason of Cloud.left_out."""
    return counted(count, reason.singular, reason)


class Message(str):
    """An error or a warning: the line as VTK shows it, and what our filters make it of.

    code    such as "NoTriangle"; "" where VTK reports it
    text    the line with its values in braces, and {property:Spacing} for names of properties
    values  {name: text}
    step    of the chain, where that is known
    """

    step = ""

    def __new__(cls, text, values, code="", block=""):
        self = super().__new__(cls, "")  # for named()
        self.text, self.values, self.code, self.block = text, values, code, block
        line = super().__new__(cls, self.named(str))
        line.__dict__.update(self.__dict__)
        return line

    def named(self, name_of, words=None):
        """The line with other names of properties, name_of(name), and of values, {text: other}."""
        values = {name: (words or {}).get(value, value) for name, value in self.values.items()}
        line = self.text.format(property=_Names(name_of), **values)
        return f"{self.block}: {line}" if self.block else line


class _Names:
    """Makes {property:Spacing} of a text what name_of("Spacing") returns."""

    def __init__(self, name_of):
        self.name_of = name_of

    def __format__(self, name):
        return self.name_of(name)


def messages_of(algorithm, kind):
    """The Messages of a filter's last run that are of a kind: "error" or "warning"."""
    if not hasattr(algorithm, "GetMessages"):
        return []
    rows = algorithm.GetMessages()
    found = []
    for i in range(0, rows.GetNumberOfValues(), 2):
        name, value = rows.GetValue(i), rows.GetValue(i + 1)
        if name in ("error", "warning"):
            found.append((name, {"code": value, "values": {}}))
        else:
            parts = found[-1][1]
            (parts if name in ("text", "block") else parts["values"])[name] = value
    return [Message(**parts) for each, parts in found if each == kind]


KINDS = {"ErrorEvent": "error", "WarningEvent": "warning"}


class Messages:
    """Collects what VTK reports instead of letting it print.

    Use as a context manager. `errors` and `warnings` are lists of Messages, without the source file,
    the object's address and the follow-up complaints of VTK's executives.

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

        def note(caller, event, text):
            for message in messages_of(caller, KINDS[event]) or [from_vtk(text)]:
                self.take(event, message)

        note.CallDataType = VTK_STRING
        self._tags = [
            (source, source.AddObserver(event, note))
            for source in (window, *self.sources)
            for event in KINDS
        ]
        return self

    def __exit__(self, *_):
        window = vtkOutputWindow.GetInstance()
        for source, tag in self._tags:
            source.RemoveObserver(tag)
        window.SetDisplayMode(self._mode)
        vtkLogger.SetStderrVerbosity(self._verbosity)

    def take(self, event, message):
        if not message or "returned failure for request" in message:  # of VTK's executives
            return
        if message.code == "RankWaits":  # of the moment, and not of the result
            print(message, file=sys.stderr)
            return
        lines = self.errors if event == "ErrorEvent" else self.warnings
        if message not in lines:
            lines.append(message)


def from_vtk(text):
    """The Message that VTK's own text is."""
    return Message("{words}", {"words": plain_message(text)})


def plain_message(text):
    """The words of a VTK message: "ERROR: In f.cxx, line 3\\nvtkX (0x1): words" -> "words"."""
    found = re.search(r"\(0x[0-9a-fA-F]+\):\s*(.*)", text or "", re.DOTALL)
    words = found.group(1) if found else (text or "")
    return " ".join(words.split())
