# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points of PCD files, as the Point Cloud Library writes them. What Debian has for Python, python3-pcl, has no
doubles and no fields but x, y, z and colour, and is gone from Debian 13."""

import math
import re
import struct

import numpy

from ..clouds import Cloud, add_array, make_points, rounding_note
from ..messages import FileError, Reason

KEYS = (b"VERSION", b"FIELDS", b"SIZE", b"TYPE", b"COUNT", b"WIDTH", b"HEIGHT", b"VIEWPOINT", b"POINTS", b"DATA")
KINDS = {"I": "i", "U": "u", "F": "f"}


def read_header(path, stream):
    """({key: words}, numpy's type of a point)."""
    words = {}
    for line in stream:
        key, *values = line.split() or [b"#"]
        if key.startswith(b"#"):
            continue
        if key not in KEYS:
            shown = line.decode("latin-1").strip()[:40]
            raise FileError(f"{path}: '{shown}' means nothing in the header of PCD")
        words[key.decode()] = [value.decode("latin-1") for value in values]
        if key == b"DATA":
            break
    try:
        counts = list(map(int, words.get("COUNT", ["1"] * len(words["FIELDS"]))))
        names = [name if name != "_" else f"_{i}" for i, name in enumerate(words["FIELDS"])]
        names = [name.lower() if name in ("X", "Y", "Z") and name.lower() not in names else name for name in names]
        kinds = [f"<{KINDS[kind]}{int(size)}" for kind, size in zip(words["TYPE"], words["SIZE"])]
        shape = [(name, kind, (count,)) for name, kind, count in zip(names, kinds, counts)]
        sizes = [words["POINTS"][0]] if "POINTS" in words else [words["WIDTH"][0], words["HEIGHT"][0]]
        words["POINTS"] = math.prod(map(int, sizes))
        return words, numpy.dtype([field for field in shape if field[2] != (0,)])
    except (KeyError, IndexError, ValueError, TypeError) as error:
        raise FileError(f"{path}: is cut off or damaged within its header: {error}") from None


def unpacked(packed, size):
    """Bytes that were packed by LZF. Raises IndexError or ValueError for damaged ones."""
    out, at = bytearray(), 0
    while at < len(packed):
        control = packed[at]
        at += 1
        if control < 32:
            out += packed[at : at + control + 1]
            at += control + 1
            continue
        length = control >> 5
        if length == 7:
            length += packed[at]
            at += 1
        begin = len(out) - ((control & 31) << 8) - packed[at] - 1
        at += 1
        length += 2
        if begin < 0:
            raise ValueError
        while length:  # what is copied may reach into the copy
            part = out[begin : begin + length]
            out += part
            begin, length = begin + len(part), length - len(part)
    if len(out) != size:
        raise ValueError
    return bytes(out)


def read_rows(path, stream, words, kind, progress):
    """The points as an array of the type."""
    count, way = words["POINTS"], (words.get("DATA") or [""])[0]
    rows = numpy.zeros(0, kind)
    if way == "ascii":
        names = [(f"{name} {i}", kind[name].base) for name in kind.names for i in range(kind[name].shape[0])]
        try:
            plain = numpy.loadtxt(stream, numpy.dtype(names), comments=None, ndmin=1) if count else rows
        except ValueError as error:
            raise FileError(f"{path}: is damaged: {str(error).splitlines()[0]}") from None
        rows = numpy.zeros(len(plain), kind)
        for name in kind.names:
            for i in range(kind[name].shape[0]):
                rows[name][:, i] = plain[f"{name} {i}"]
    elif way == "binary":
        data = stream.read()
        rows = numpy.frombuffer(data[: min(count, len(data) // kind.itemsize) * kind.itemsize], kind)
    elif way == "binary_compressed":
        sizes = stream.read(8)
        try:
            packed, size = struct.unpack("<II", sizes)
            if size != count * kind.itemsize:
                raise ValueError
            data, at = unpacked(stream.read(packed), size), 0
        except (struct.error, IndexError, ValueError):
            raise FileError(f"{path}: is cut off or damaged: its points cannot be unpacked") from None
        rows = numpy.zeros(count, kind)
        for name in kind.names:  # all numbers of a field stand together
            part = kind[name].itemsize * count
            rows[name] = numpy.frombuffer(data[at : at + part], kind[name].base).reshape(count, -1)
            at += part
    else:
        raise FileError(f"{path}: holds DATA {way}; ascii, binary and binary_compressed are read")
    progress(0.9)
    if len(rows) != count:
        raise FileError(f"{path}: is cut off: {count:,} points are announced, {len(rows):,} found")
    return rows


def read_points(path, options):
    """The points; other fields become point arrays. Those of scanners without a return are NaN."""
    with open(path, "rb") as stream:
        words, kind = read_header(path, stream)
        rows = read_rows(path, stream, words, kind, options.progress)
    names = [name for name in kind.names if not re.fullmatch(r"_\d+", name)]
    if not {"x", "y", "z"} <= set(names):
        raise FileError(f"{path}: its fields are {', '.join(names)}, not x, y and z")
    xyz = numpy.column_stack([rows[axis][:, 0].astype("f8") for axis in "xyz"])
    keep = numpy.isfinite(xyz).all(axis=1)
    if not keep.any():
        raise FileError(f"{path}: holds no points")
    cloud = Cloud(make_points(xyz[keep]), [f"PCD {words['DATA'][0]}"])
    if not keep.all():
        cloud.left_out[Reason("point", "without data")] = int(numpy.count_nonzero(~keep))
    for name in names:
        values = rows[name][keep]
        if name in ("rgb", "rgba") and values.dtype.itemsize == 4 and values.shape[1] == 1:
            packed = numpy.ascontiguousarray(values).view("<u4").ravel()
            values = numpy.column_stack([packed >> shift & 255 for shift in (16, 8, 0)]).astype("u1")
            name = "RGB"
        if name not in ("x", "y", "z"):
            add_array(cloud.points, name, values[:, 0] if values.shape[1] == 1 else values)
    if rows["x"].dtype == "<f4":
        note = rounding_note(xyz[keep], "the file is")
        cloud.notes += [note] if note else []
    return cloud
