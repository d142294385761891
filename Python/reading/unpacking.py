# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Standard input and packed files as files that any reader can open."""

import bz2
import contextlib
import gzip
import lzma
import os
import shutil
import sys
import tempfile
import zlib

from ..messages import FileError
from ..paths import check_readable

PACKED = ((b"\x1f\x8b", gzip.open), (b"BZh", bz2.open), (b"\xfd7zXZ\0", lzma.open))
STANDARD_INPUT = "standard input"


def opener_of(path):
    """The function that opens a packed file, or None for another file."""
    with open(path, "rb") as stream:
        head = stream.read(6)
    return next((opener for magic, opener in PACKED if head.startswith(magic)), None)


def is_plain(path):
    """Whether a file can be looked at as it is."""
    return os.path.isfile(path) and os.access(path, os.R_OK) and opener_of(path) is None


def copy(source, target, shown):
    try:
        with open(target, "wb") as stream:
            shutil.copyfileobj(source, stream, 1 << 20)
    except (EOFError, zlib.error, lzma.LZMAError, gzip.BadGzipFile) as error:
        raise FileError(f"{shown}: is cut off or damaged: {error}") from None
    except OSError as error:
        raise FileError(f"{shown}: cannot be unpacked: {error.strerror or error}") from None


@contextlib.contextmanager
def unpacked(path):
    """Gives the path of a plain file with what standard input ("-") or a packed file holds.

    Such a file lies in a folder that goes away. Errors name the file that the user named.
    """
    shown = STANDARD_INPUT if path == "-" else path
    with contextlib.ExitStack() as stack:
        local = path
        if path == "-":
            folder = stack.enter_context(tempfile.TemporaryDirectory())
            local = os.path.join(folder, "input")
            copy(sys.stdin.buffer, local, shown)
        else:
            check_readable(path)
        opener = os.path.getsize(local) and opener_of(local)
        if opener:
            folder = stack.enter_context(tempfile.TemporaryDirectory())
            packed, name = local, os.path.basename(os.path.splitext(local)[0])
            local = os.path.join(folder, name)
            with opener(packed) as source:
                copy(source, local, shown)
        try:
            check_readable(local)
            yield local
        except FileError as error:
            raise type(error)(str(error).replace(local, shown)) from None
