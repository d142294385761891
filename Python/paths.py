# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks which files can be read and written, before any work is done."""

import os
import re

from .messages import FileError


def suffix_of(path):
    return os.path.splitext(path)[1].lower()


def is_geodatabase(path):
    """Whether a folder is an ESRI file geodatabase, which is one file to users."""
    return suffix_of(path.rstrip("/")) == ".gdb" and os.path.exists(os.path.join(path, "gdb"))


def partial_path(path):
    """Where a result is written until it is complete."""
    folder, name = os.path.split(path)
    stem, suffix = os.path.splitext(name)
    return os.path.join(folder, f".{stem}.{os.getpid()}.partial{suffix}")


def plain_stem(path):
    """a.b of x/a.b.xyz, and of its partial_path()."""
    stem = os.path.splitext(os.path.basename(path))[0]
    return re.sub(r"^\.(.*)\.\d+\.partial$", r"\1", stem)


def check_readable(path):
    """Refuses what cannot be opened, before any reader sees it."""
    if not os.path.exists(path):
        raise FileError(f"{path}: no such file")
    if is_geodatabase(path):
        return
    if os.path.isdir(path):
        raise FileError(f"{path}: is a folder, not a file")
    if not os.path.isfile(path):
        raise FileError(f"{path}: is not a file")
    try:
        with open(path, "rb") as stream:
            first = stream.read(1)
    except OSError as error:
        raise FileError(f"{path}: cannot be read: {error.strerror}") from None
    if not first:
        raise FileError(f"{path}: is empty")


def check_suffix(path, suffixes, verb):
    if suffix_of(path) not in suffixes:
        ending = suffix_of(path) or "no suffix"
        one_of = "one of " if len(suffixes) > 1 else ""
        raise FileError(f"{path}: {ending} cannot be {verb}; use {one_of}{' '.join(suffixes)}")


def check_writable(path):
    """Refuses early what could not be written at the end."""
    folder = os.path.dirname(os.path.abspath(path))
    if os.path.isdir(path):
        raise FileError(f"{path}: is a folder, so it cannot be written as a file")
    if not os.path.isdir(folder):
        raise FileError(f"{path}: cannot be written: there is no folder {folder}")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise FileError(f"{path}: cannot be written: no permission in folder {folder}")
