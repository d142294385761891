# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Standard input and packed files as files that any reader can open."""

import bz2
import contextlib
import gzip
import lzma
import os
import sys
import tempfile
import zlib

from ..messages import FileError
from ..paths import check_readable
from ..progress import no_progress

PACKED = ((b"\x1f\x8b", gzip.open), (b"BZh", bz2.open), (b"\xfd7zXZ\0", lzma.open))
STANDARD_INPUT = "standard input"
UNPACKING = 0.3  # of the whole work


def opener_of(path):
    """The function that opens a packed file, or None for another file."""
    with open(path, "rb") as stream:
        head = stream.read(6)
    return next((opener for magic, opener in PACKED if head.startswith(magic)), None)


def is_plain(path):
    """Whether a file can be looked at as it is."""
    return os.path.isfile(path) and os.access(path, os.R_OK) and opener_of(path) is None


def copy(source, target, shown, report):
    """Copies a stream to a file, and calls report() after each part."""
    try:
        with open(target, "wb") as stream:
            while part := source.read(1 << 20):
                stream.write(part)
                report()
    except (EOFError, zlib.error, lzma.LZMAError, gzip.BadGzipFile) as error:
        raise FileError(f"{shown}: is cut off or damaged: {error}") from None
    except OSError as error:
        raise FileError(f"{shown}: cannot be unpacked: {error.strerror or error}") from None


@contextlib.contextmanager
def named(local, shown):
    """Lets errors on a local file name the file that the user named."""
    try:
        yield
    except FileError as error:
        raise type(error)(str(error).replace(local, shown)) from None


@contextlib.contextmanager
def unpacked(path, progress=no_progress):
    """Gives the path of a plain file with what standard input ("-") or a packed file holds, and the
    fraction of the work that is done then.

    Such a file lies in a folder that goes away. Errors name the file that the user named.
    """
    shown = STANDARD_INPUT if path == "-" else path
    with contextlib.ExitStack() as stack:
        local, begun = path, 0.0
        if path == "-":
            folder = stack.enter_context(tempfile.TemporaryDirectory())
            local = os.path.join(folder, "input")
            copy(sys.stdin.buffer, local, shown, lambda: progress(0.0))
        else:
            check_readable(path)
        opener = os.path.getsize(local) and opener_of(local)
        if opener:
            folder = stack.enter_context(tempfile.TemporaryDirectory())
            packed, name = local, os.path.basename(os.path.splitext(local)[0])
            local, begun, size = os.path.join(folder, name), UNPACKING, os.path.getsize(packed)
            with open(packed, "rb") as raw, opener(raw) as source:
                copy(source, local, shown, lambda: progress(UNPACKING * raw.tell() / size))
        with named(local, shown):
            check_readable(local)
            yield local, begun
