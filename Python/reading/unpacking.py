# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Standard input, packed files and archives as files that any reader can open."""

import bz2
import contextlib
import gzip
import lzma
import os
import sys
import re
import tempfile
import zipfile
import zlib

from ..messages import FileError
from ..paths import check_readable, suffix_of
from ..progress import no_progress

PACKED = ((b"\x1f\x8b", gzip.open), (b"BZh", bz2.open), (b"\xfd7zXZ\0", lzma.open))
STANDARD_INPUT = "standard input"
# ZIP files that are one file to their readers, and tables of spreadsheets, which recognise() names.
NOT_UNPACKED = re.compile(r"\.(npy|kml)$|^(xl/|word/|ppt/|mimetype$|\[Content_Types\])")
# What lies next to a file that is read, and belongs to it or to nobody.
COMPANIONS = (
    ".dbf .shx .prj .qpj .cpg .sbn .sbx .qix .qmd .xml .tfw .wld .aux .ovr .hdr .stx .txt .pdf .md .html .htm .jpg .png "
    ".sdat .gfs .fix .idx .atx .gdbtable .gdbtablx .gdbindexes .spx .freelist"
).split()
WORK_TO_UNPACK = 0.3  # of the whole work


def find_opener(path):
    """The function that opens a packed file, or None for another file."""
    with open(path, "rb") as stream:
        head = stream.read(6)
    return next((opener for magic, opener in PACKED if head.startswith(magic)), None)


def is_plain(path):
    """Whether a file can be looked at as it is."""
    return os.path.isfile(path) and os.access(path, os.R_OK) and find_opener(path) is None and not is_archive(path)


def is_archive(path):
    """Whether a ZIP file holds files that are read, and is not read itself."""
    try:
        with zipfile.ZipFile(path) as archive:
            return not any(NOT_UNPACKED.search(name) for name in archive.namelist())
    except (OSError, zipfile.BadZipFile, ValueError, NotImplementedError):
        with open(path, "rb") as stream:
            return stream.read(4) == b"PK\3\4" and not NOT_UNPACKED.search(path)


def unzipped(path, folder, progress):
    """The path of the one file in an archive that can be read; what lies next to it is unpacked too."""
    try:
        with zipfile.ZipFile(path) as archive:
            members = [one for one in archive.infolist() if not one.is_dir() and "__MACOSX" not in one.filename]
            sizes, done = sum(one.file_size for one in members) or 1, 0
            for one in members:
                archive.extract(one, folder)
                done += one.file_size
                progress(WORK_TO_UNPACK * done / sizes)
    except (zipfile.BadZipFile, EOFError, zlib.error, lzma.LZMAError, NotImplementedError, RuntimeError) as error:
        raise FileError(f"{path}: is cut off or damaged: {error}") from None
    except OSError as error:
        raise FileError(f"{path}: cannot be unpacked: {error.strerror or error}") from None
    names = [one.filename for one in members]
    folders = {found.group(1) for found in (re.match(r"(.*?\.gdb)/", name) for name in names) if found}
    names = [name for name in names if not re.match(r".*?\.gdb/", name)]
    read = sorted(folders) + [name for name in names if suffix_of(name) not in COMPANIONS]
    read = read or [name for name in names if suffix_of(name) == ".txt"]
    if len(read) != 1:
        shown = ", ".join(read[:20]) or ", ".join(names[:20]) or "nothing"
        alike = read[:20] if len(set(map(suffix_of, read))) == 1 else ["FILE"]
        way = f": unzip {path} -d unpacked, and read {' '.join('unpacked/' + name for name in alike)}" if names else ""
        raise FileError(f"{path}: is an archive that holds {shown}{way}")
    return os.path.join(folder, read[0])


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
        opener = os.path.isfile(local) and os.path.getsize(local) and find_opener(local)
        if opener:
            folder = stack.enter_context(tempfile.TemporaryDirectory())
            packed, name = local, os.path.basename(os.path.splitext(local)[0])
            local, begun, size = os.path.join(folder, name), WORK_TO_UNPACK, os.path.getsize(packed)
            with open(packed, "rb") as raw, opener(raw) as source:
                copy(source, local, shown, lambda: progress(WORK_TO_UNPACK * raw.tell() / size))
        elif os.path.isfile(local) and os.path.getsize(local) and is_archive(local):
            folder = stack.enter_context(tempfile.TemporaryDirectory())
            with named(local, shown):
                local, begun = unzipped(local, folder, progress), WORK_TO_UNPACK
        with named(local, shown):
            check_readable(local)
            yield local, begun
