# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points of LAS files 1.0 to 1.4 (ASPRS), and of LAZ files where laspy can decode them: it is a package of Debian 13."""

import os
import struct

import numpy

from ..clouds import WHOLE, Cloud, add_array, make_points, slices
from ..messages import FileError, Reason
from ..names import option

# Bytes of a record, GPS time and colours in it, by point format.
SIZES = (20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67)
TIMES = {1: 20, 3: 20, 4: 20, 5: 20, 6: 22, 7: 22, 8: 22, 9: 22, 10: 22}
COLOURS = {2: 20, 3: 28, 5: 28, 7: 30, 8: 30, 10: 30}
CLASSES = {
    0: "never classified", 1: "unclassified", 2: "ground", 3: "low vegetation",
    4: "medium vegetation", 5: "high vegetation", 6: "building", 7: "noise", 8: "key points",
    9: "water", 10: "rail", 11: "road", 12: "overlap", 17: "bridge", 18: "high noise",
}  # fmt: skip
AT_ONCE = 1 << 20


class Header:
    """The contents of the header and of the records behind it. Raises FileError."""

    def __init__(self, path):
        self.path = path
        self.size = os.path.getsize(path)
        with open(path, "rb") as stream:
            head = stream.read(375)
            if head[:4] != b"LASF" or len(head) < 227:
                raise FileError(f"{path}: is cut off within its header, or no LAS file")
            self.version = head[24:26]
            size, self.start, records, kind, self.length = struct.unpack_from("<HIIBH", head, 94)
            self.count = struct.unpack_from("<I", head, 107)[0]
            self.scale = numpy.array(struct.unpack_from("<3d", head, 131))
            self.offset = numpy.array(struct.unpack_from("<3d", head, 155))
            extended = (0, 0)
            if self.version >= b"\1\4" and size >= 375 and len(head) == 375:
                extended = struct.unpack_from("<QI", head, 235)
                self.count = struct.unpack_from("<Q", head, 247)[0] or self.count
            self.is_packed = bool(kind & 0xC0)
            self.kind = kind & 0x3F
            self.check()
            self.crs = read_crs(stream, size, records, *extended)

    def check(self):
        name = f"{self.path}: LAS {self.version[0]}.{self.version[1]}"
        if self.kind >= len(SIZES):
            raise FileError(f"{name} with point format {self.kind}; 0 to 10 are known")
        if self.length < SIZES[self.kind]:
            raise FileError(
                f"{name}: is damaged: {self.length} bytes for a point of format {self.kind}, "
                f"which needs {SIZES[self.kind]}"
            )
        if not (numpy.isfinite(self.scale).all() and self.scale.all()):
            raise FileError(f"{name}: is damaged: its scale is {self.scale.tolist()}")
        found = max(self.size - self.start, 0) // self.length
        if self.count == 0:
            raise FileError(f"{name}: holds no points")
        if not self.is_packed and found < self.count:
            raise FileError(
                f"{name}: is cut off: {self.count:,} points are announced, {found:,} are there"
            )

    def record(self):
        """The fields of a point that are read, as numpy type."""
        is_new = self.kind >= 6
        fields = {"XYZ": ("(3,)<i4", 0), "Intensity": ("<u2", 12), "returns": ("u1", 14)}
        fields["flags"] = ("u1", 15)
        fields["Classification"] = ("u1", 16 if is_new else 15)
        if self.kind in TIMES:
            fields["GpsTime"] = ("<f8", TIMES[self.kind])
        if self.kind in COLOURS:
            fields["RGB"] = ("(3,)<u2", COLOURS[self.kind])
        formats, offsets = zip(*fields.values())
        return numpy.dtype(
            {
                "names": list(fields),
                "formats": formats,
                "offsets": offsets,
                "itemsize": self.length,
            }
        )


def read_crs(stream, start, count, extended_start, extended_count):
    """The reference system of the variable length records as WKT or EPSG code, or None."""
    wkt = code = None
    extended = (extended_start, extended_count, "<2x16sHQ32x")
    for at, number, head in ((start, count, "<2x16sHH32x"), extended):
        for _ in range(min(number, 1000)):
            stream.seek(at)
            record = stream.read(struct.calcsize(head))
            if len(record) < struct.calcsize(head):
                break
            user, key, length = struct.unpack(head, record)
            at += len(record) + length
            if not user.startswith(b"LASF_Projection"):
                continue
            content = stream.read(min(length, 1 << 20))
            if key == 2112:
                wkt = content.split(b"\0")[0].decode("utf-8", "replace").strip() or wkt
            elif key == 34735:
                keys = numpy.frombuffer(content[: len(content) // 8 * 8], "<u2").reshape(-1, 4)
                found = {int(row[0]): int(row[3]) for row in keys[1:] if row[1] == 0}
                code = found.get(3072) or found.get(2048)
    return wkt or (f"EPSG:{code}" if code and code != 32767 else None)


def records(path, header, part):
    """Yields the points of a slice as arrays of header.record(), about a million at a time."""
    kind = header.record()
    if not header.is_packed:
        for part in slices(part.stop, AT_ONCE, part.start):
            # Opened anew, as what has been read through a mapped file counts as memory in use.
            start = header.start + part.start * header.length
            yield numpy.memmap(path, kind, "r", start, (part.stop - part.start,))
        return
    try:
        import laspy
    except ImportError:
        raise FileError(
            f"{path}: is compressed (LAZ), which laspy reads: apt-get install python3-laspy python3-laszip (Debian 13), or "
            "pip install laspy lazrs in a virtual environment that sees the packages of the system; or unpack it: pdal "
            f"translate {path} {os.path.splitext(path)[0]}.las"
        ) from None
    try:
        with laspy.open(path) as reader:
            at = 0
            for chunk in reader.chunk_iterator(AT_ONCE):
                rows = numpy.frombuffer(chunk.array.tobytes(), kind)
                yield rows[max(part.start - at, 0) : max(part.stop - at, 0)]
                at += len(rows)
                if at >= part.stop:
                    break
    except Exception as error:  # laspy and its decoders have errors of many kinds
        raise FileError(f"{path}: laspy cannot read it: {' '.join(str(error).split())}") from None


class Chosen:
    """The points of a part of a file that are not withheld, and of the classes that options name:
    iterate to get (rows, their classes, x y z), some at a time."""

    def __init__(self, path, options, part=WHOLE):
        self.path, self.options, self.header = path, options, Header(path)
        self.part = part.rows(self.header.count)
        self.total = self.count = self.withheld = 0
        self.of_class = numpy.zeros(256, "i8")

    def __iter__(self):
        header = self.header
        for rows in records(self.path, header, self.part):
            classes, gone = rows["Classification"], rows["flags"] & 4 > 0
            if header.kind < 6:
                classes, gone = classes & 31, classes & 128 > 0
            keep = ~gone
            self.withheld += int(numpy.count_nonzero(gone))
            self.of_class += numpy.bincount(classes[keep], minlength=256)
            if self.options.classes:
                keep &= numpy.isin(classes, self.options.classes)
            rows = rows[keep]
            self.count, self.total = self.count + len(rows), self.total + len(keep)
            yield rows, classes[keep], rows["XYZ"] * header.scale + header.offset
            self.options.progress(self.total / (self.part.stop - self.part.start))

    def check(self):
        """Raises FileError where points of the file lack, or none is chosen."""
        if self.total < self.header.count:
            raise FileError(
                f"{self.path}: is cut off: {self.header.count:,} points are announced, "
                f"{self.total:,} are there"
            )
        if self.count == 0:
            wanted = ", ".join(map(str, self.options.classes or ()))
            raise FileError(
                f"{self.path}: holds no point of class {wanted}; classes: {self.shown() or 'none'}"
            )

    def returns(self, rows):
        """The number of the return of each point."""
        return rows["returns"] & (15 if self.header.kind >= 6 else 7)

    def shown(self):
        """The classes and how many points each has, in words."""
        return ", ".join(
            f"{number} {CLASSES.get(number, '')}".strip() + f": {self.of_class[number]:,}"
            for number in numpy.flatnonzero(self.of_class)
        )

    def report(self, cloud):
        """Adds to a Cloud what is reported once all points are read."""
        header = self.header
        several = numpy.count_nonzero(self.of_class) > 1 and not self.options.classes
        cloud.crs = header.crs
        cloud.notes.append(
            f"LAS {header.version[0]}.{header.version[1]}, point format {header.kind}; classes "
            + self.shown() + f" (see {option('classes')})" * bool(several)
        )
        if self.withheld:
            cloud.left_out[Reason("point", "marked as withheld")] = self.withheld
        if header.count - self.withheld > self.count:
            others = header.count - self.withheld - self.count
            cloud.left_out[Reason("point", "of other classes")] = others


class LasSlices(Chosen):
    """The same, but iterate to get (x y z, the other columns)."""

    def __iter__(self):
        for rows, classes, points in super().__iter__():
            names = [name for name in ("Intensity", "GpsTime") if name in rows.dtype.names]
            columns = {name: rows[name] for name in names}
            columns.update(Classification=classes, ReturnNumber=self.returns(rows))
            yield points, columns

    def facts(self):
        """What was found, as plain values that can be added to those of other parts."""
        return {
            "total": self.total,
            "count": self.count,
            "withheld": self.withheld,
            "classes": {str(i): int(self.of_class[i]) for i in numpy.flatnonzero(self.of_class)},
        }

    def finish(self, facts, cloud):
        """Takes the facts about the whole file, and adds to a Cloud what is reported then."""
        self.total, self.count, self.withheld = facts["total"], facts["count"], facts["withheld"]
        for number, count in facts["classes"].items():
            self.of_class[int(number)] = count
        self.check()
        self.report(cloud)
        cloud.notes.append("left out: point arrays, as intensity")


def read_points(path, options):
    """All points that are not withheld, or those of the classes that options name.

    Intensity, Classification, ReturnNumber, GpsTime and RGB become point arrays where they are not
    0 everywhere. Takes 24 bytes a point, and those of its arrays.
    """
    chosen = Chosen(path, options)
    header = chosen.header
    names = header.record().names
    points = numpy.empty((header.count, 3))
    arrays = {
        "Intensity": numpy.empty(header.count, "u2"),
        "Classification": numpy.empty(header.count, "u1"),
        "ReturnNumber": numpy.empty(header.count, "u1"),
    }
    if "GpsTime" in names:
        arrays["GpsTime"] = numpy.empty(header.count)
    if "RGB" in names:
        arrays["RGB"] = numpy.empty((header.count, 3), "u2")
    for rows, classes, xyz in chosen:
        here = slice(chosen.count - len(rows), chosen.count)
        points[here] = xyz
        arrays["ReturnNumber"][here] = chosen.returns(rows)
        arrays["Classification"][here] = classes
        for name in ("Intensity", "GpsTime", "RGB"):
            if name in arrays:
                arrays[name][here] = rows[name]
    chosen.check()
    cloud = Cloud(make_points(points[: chosen.count], copy=False))
    chosen.report(cloud)
    for name, values in arrays.items():
        values = values[: chosen.count]
        if name == "RGB":
            # Colours of 16 bits, or as many programs write them, of 8.
            values = (values >> (8 if values.max() > 255 else 0)).astype("u1")
        if values.any():
            add_array(cloud.points, name, values)
    return cloud
